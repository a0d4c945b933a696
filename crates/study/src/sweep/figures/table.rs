//! The table of a study, read back.

use super::super::Sweep;
use std::collections::{BTreeMap, HashMap};
use std::io::Read;

/// Of `results.csv` the columns from which figures are made, for the cases that ran to their end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudyTable {
    rows: usize,
    complete: usize,
    warned: usize,
    numbers: BTreeMap<String, Vec<f64>>,
    words: BTreeMap<String, Words>,
}

/// Cells as texts, each of the different ones once.
#[derive(Clone, Debug, Default, PartialEq)]
struct Words {
    different: Vec<String>,
    /// By rows: which of them.
    of: Vec<u32>,
}

/// Why a text is no table of results.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// Not a table.
    #[error("the table can't be read: {0}")]
    Csv(#[from] csv::Error),
    /// Another table.
    #[error("the table has no column `status`: it is not the result of a sweep")]
    NoStatus,
    /// The columns of another version of the program.
    #[error(
        "its columns are not those that this program writes: run the study again, in another folder or with --force"
    )]
    OtherColumns,
    /// A line that is no row.
    #[error("line {0} is no row of the study: `--resume` of that study removes it, and runs its case again")]
    NotARow(u64),
}

impl StudyTable {
    /// Reads `results.csv`, one row at a time: what the figures of the sweep need of it.
    ///
    /// # Errors
    /// If it is none.
    pub fn read(text: impl Read, sweep: &Sweep) -> Result<Self, TableError> {
        let mut reader = csv::Reader::from_reader(text);
        let header = reader.headers()?.clone();
        let place = |column: &str| header.iter().position(|name| name == column);
        let Some(status) = place("status") else { return Err(TableError::NoStatus) };
        let warnings = place("warnings");
        let placed = |columns: Vec<String>| -> Vec<(String, Option<usize>)> {
            columns.into_iter().map(|name| (name.clone(), place(&name))).collect()
        };
        let (of_numbers, of_words) = sweep.wanted().columns(sweep);
        let (of_numbers, of_words) = (placed(of_numbers), placed(of_words));
        let mut numbers: Vec<Vec<f64>> = vec![Vec::new(); of_numbers.len()];
        let mut words: Vec<(Words, HashMap<String, u32>)> = vec![Default::default(); of_words.len()];
        let mut table = Self::default();
        let mut row = csv::StringRecord::new();
        while reader.read_record(&mut row)? {
            let cell = |place: Option<usize>| place.and_then(|place| row.get(place)).unwrap_or_default();
            table.rows += 1;
            table.warned += usize::from(!cell(warnings).is_empty());
            if !matches!(cell(Some(status)), "complete" | "stopped") {
                continue;
            }
            table.complete += 1;
            for (values, (_, place)) in numbers.iter_mut().zip(&of_numbers) {
                values.push(cell(*place).parse().unwrap_or(f64::NAN));
            }
            for ((words, known), (_, place)) in words.iter_mut().zip(&of_words) {
                words.push(cell(*place), known);
            }
        }
        let names = |columns: Vec<(String, Option<usize>)>| columns.into_iter().map(|(name, _)| name);
        table.numbers = names(of_numbers).zip(numbers).collect();
        table.words = names(of_words).zip(words.into_iter().map(|(words, _)| words)).collect();
        Ok(table)
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows
    }

    /// Whether it has no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// The cells of a column for all cases that ran to their end; empty ones for a column that isn't
    /// there.
    pub(crate) fn completed(&self, column: &str) -> Vec<&str> {
        match self.words.get(column) {
            Some(words) => words.cells().collect(),
            None => vec![""; self.complete],
        }
    }

    /// The numbers of a column for all cases that ran to their end; NaN where there is none.
    pub(crate) fn numbers(&self, column: &str) -> Vec<f64> {
        self.numbers.get(column).cloned().unwrap_or_else(|| vec![f64::NAN; self.complete])
    }

    /// Number of cases with warnings.
    #[must_use]
    pub fn warned(&self) -> usize {
        self.warned
    }

    /// Number of cases that didn't run to their end.
    #[must_use]
    pub fn incomplete(&self) -> usize {
        self.rows - self.complete
    }
}

impl Words {
    /// Adds a cell; `known` are the places of the different ones.
    fn push(&mut self, cell: &str, known: &mut HashMap<String, u32>) {
        let place = known.get(cell).copied().unwrap_or_else(|| {
            let place = u32::try_from(self.different.len()).unwrap_or(u32::MAX);
            self.different.push(cell.to_owned());
            known.insert(cell.to_owned(), place);
            place
        });
        self.of.push(place);
    }

    fn cells(&self) -> impl Iterator<Item = &str> {
        self.of.iter().map(|place| self.different.get(*place as usize).map_or("", String::as_str))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_of_the_cases_that_ended() {
        let sweep = "scene = \"s.toml\"\n[grid]\ng = [1]\n[outputs]\nk = \"t\"\nm = \"t\"\n[distribution]\nof = \"m\"\nby = \"k\"\n";
        let sweep = Sweep::read(sweep, "f", &|_, _| Err(String::new())).unwrap();
        let text = "case,k,m,status,warnings,error\n0,\"a, b\",x,complete,w,\n1,2.5,1,diverged,,why\n2,3,3,stopped,,\n3,3,4,complete,,\n";
        let table = StudyTable::read(text.as_bytes(), &sweep).unwrap();
        assert_eq!((table.len(), table.incomplete(), table.warned()), (4, 1, 1));
        assert_eq!(table.completed("k"), ["a, b", "3", "3"]);
        assert!(table.numbers("m")[0].is_nan() && table.numbers("m")[1..] == [3.0, 4.0]);
        assert_eq!((table.completed("none"), table.numbers("status").len()), (vec!["", "", ""], 3));
        assert!(matches!(StudyTable::read(&b"t,x\n1,2\n"[..], &sweep), Err(TableError::NoStatus)));
    }
}
