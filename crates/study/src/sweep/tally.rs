//! What is to be said of the rows of a study once it has ended, whichever session ran them.

use super::{JournalError, RESULTS, Sweep, TableError};
use std::collections::BTreeMap;
use std::path::Path;

/// Counts over the rows of a table of results.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Tally {
    /// Number of rows.
    pub cases: u64,
    /// Cases that didn't come to their end.
    pub incomplete: u64,
    /// Cases with steps whose contact problem was not solved to tolerance.
    pub unsolved: u64,
    /// Cases in which a search saw several limits.
    pub several_limits: u64,
    /// The outputs that have no value in any case.
    pub empty: Vec<String>,
    /// Cases with warnings.
    pub warned: u64,
    /// The codes of these, each with the number of cases, the most frequent first.
    pub warnings: Vec<(String, u64)>,
    /// What the first case that didn't come to its end says.
    pub first_error: String,
}

impl Tally {
    /// Counts the rows of `results.csv` in a folder, one at a time.
    ///
    /// # Errors
    /// If there is no such table.
    pub fn of(folder: &Path, sweep: &Sweep) -> Result<Self, JournalError> {
        let path = folder.join(RESULTS);
        let wrong = |source: csv::Error| JournalError::Table { path: path.clone(), source: TableError::Csv(source) };
        let mut reader = csv::Reader::from_path(&path).map_err(wrong)?;
        let header = reader.headers().map_err(wrong)?.clone();
        let place = |name: &str| header.iter().position(|column| column == name);
        let [status, unsolved, changes] = ["status", "unsolved_steps", "find.changes"].map(place);
        let [error, warnings] = ["error", "warnings"].map(place);
        let mut codes: BTreeMap<String, u64> = BTreeMap::new();
        let mut outputs: Vec<(&str, Option<usize>)> =
            sweep.outputs().iter().map(|output| (output.name(), place(output.name()))).collect();
        let mut tally = Self::default();
        let mut row = csv::StringRecord::new();
        while reader.read_record(&mut row).map_err(wrong)? {
            let cell = |place: Option<usize>| place.and_then(|place| row.get(place)).unwrap_or_default();
            let count = |place: Option<usize>| cell(place).parse::<u64>().unwrap_or(0);
            tally.cases += 1;
            if !matches!(cell(status), "complete" | "stopped") {
                tally.incomplete += 1;
                if tally.incomplete == 1 {
                    cell(error).clone_into(&mut tally.first_error);
                }
            }
            tally.unsolved += u64::from(count(unsolved) > 0);
            tally.several_limits += u64::from(count(changes) > 1);
            tally.warned += u64::from(!cell(warnings).is_empty());
            for code in cell(warnings).split_whitespace() {
                *codes.entry(code.to_owned()).or_default() += 1;
            }
            outputs.retain(|(_, place)| cell(*place).is_empty());
        }
        tally.warnings = codes.into_iter().collect();
        // Stable: codes of the same number stay in the order of their names.
        tally.warnings.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        tally.empty = outputs.into_iter().map(|(name, _)| name.to_owned()).collect();
        Ok(tally)
    }
}

/// A number of cases in words: `1 case`, `12 cases`.
#[must_use]
pub fn counted(cases: u64) -> String {
    if cases == 1 { "1 case".to_owned() } else { format!("{cases} cases") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_rows_count() {
        let folder = std::env::temp_dir().join(format!("teeter-tally-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let text = "case,k,find.changes,a,b,status,unsolved_steps,warnings,error\n0,1,3,,,complete,0,a b,\n1,2,1,0.5,,diverged,7,b,\"x, y\"\n2,3,,,,stopped,0,,\n";
        std::fs::write(folder.join(RESULTS), text).unwrap();
        let sweep = "scene = \"s.toml\"\n[grid]\nk = [1, 2, 3]\n[outputs]\na = \"t\"\nb = \"t\"\n";
        let sweep = Sweep::read(sweep, "f", &|_, _| Err(String::new())).unwrap();
        let found = Tally::of(&folder, &sweep).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        let (empty, first_error) = (vec!["b".to_owned()], "x, y".to_owned());
        let warnings = vec![("b".to_owned(), 2), ("a".to_owned(), 1)];
        let expected =
            Tally { cases: 3, incomplete: 1, unsolved: 1, several_limits: 1, empty, warned: 2, warnings, first_error };
        assert_eq!(found, expected);
    }
}
