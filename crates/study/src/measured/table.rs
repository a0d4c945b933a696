//! Tables as text: separators, headings, cells.

use super::read::MeasuredError;
use csv::{ByteRecord, ReaderBuilder, Trim};

/// Most rows of a table.
const MOST_ROWS: usize = 2_000_000;

/// The cells of a table, by rows.
pub(super) struct TextTable {
    /// The cells of the heading with its line; none if the table begins with numbers.
    pub(super) heading: Option<(usize, Vec<String>)>,
    /// The rows, with their lines.
    pub(super) rows: Vec<(usize, Vec<String>)>,
    /// Whether a comma in a number is its decimal point.
    pub(super) decimal_comma: bool,
}

impl TextTable {
    /// Splits a text, after so many lines that are skipped.
    pub(super) fn split(text: &str, separator: Option<char>, skip: usize) -> Result<Self, MeasuredError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let kept = |line: &str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
        let mut lines =
            text.lines().enumerate().skip(skip).filter(|(_, line)| kept(line)).map(|(k, line)| (k + 1, line));
        let first: Vec<&str> = lines.clone().take(2).map(|(_, line)| line).collect();
        // The heading may have blanks in its names, so the row below it decides.
        let Some(sample) = first.last() else {
            let lines = text.lines().count();
            return Err(if skip >= lines && lines > 0 {
                MeasuredError::AllSkipped { lines }
            } else {
                MeasuredError::Empty
            });
        };
        let separator = separator.unwrap_or_else(|| found_separator(sample));
        let mut rows = Vec::new();
        let mut heading = None;
        let mut columns = 0;
        for (number, line) in &mut lines {
            let cells = cells(line, separator);
            if heading.is_none() && rows.is_empty() && !cells.iter().all(|cell| looks_numeric(cell, separator != ',')) {
                heading = Some((number, cells));
                continue;
            }
            if rows.is_empty() {
                columns = cells.len();
            }
            if cells.len() != columns {
                return Err(MeasuredError::line(
                    number,
                    format!(
                        "{} column{}, but the rows before have {columns}",
                        cells.len(),
                        if cells.len() == 1 { "" } else { "s" }
                    ),
                ));
            }
            if rows.len() == MOST_ROWS {
                return Err(MeasuredError::line(number, format!("more than {MOST_ROWS} rows, the limit of a table")));
            }
            rows.push((number, cells));
        }
        if rows.is_empty() {
            return Err(MeasuredError::NoRows);
        }
        if separator == ' ' {
            heading = heading.map(|(line, cells)| (line, with_units(cells, columns)));
        }
        Ok(Self { heading, rows, decimal_comma: separator != ',' })
    }
}

/// The separator of a row: the strongest that is there.
fn found_separator(row: &str) -> char {
    [';', '\t', ','].into_iter().find(|&c| row.contains(c)).unwrap_or(' ')
}

/// The cells of a heading that was split at blanks, with each unit in brackets in the cell of its
/// name; of a table of one column, one cell.
fn with_units(cells: Vec<String>, columns: usize) -> Vec<String> {
    if columns == 1 {
        return vec![cells.join(" ")];
    }
    let is_unit = |cell: &str| {
        [('[', ']'), ('(', ')')].iter().any(|(open, close)| cell.starts_with(*open) && cell.ends_with(*close))
    };
    let mut joined: Vec<String> = Vec::new();
    for cell in cells {
        match joined.last_mut().filter(|_| is_unit(&cell)) {
            Some(name) => *name = format!("{name} {cell}"),
            None => joined.push(cell),
        }
    }
    joined
}

fn cells(line: &str, separator: char) -> Vec<String> {
    let plain = || match separator {
        ' ' => line.split_whitespace().map(str::to_owned).collect(),
        other => line.split(other).map(|cell| cell.trim().to_owned()).collect(),
    };
    if separator == ' ' || !line.contains('"') {
        return plain();
    }
    // A separator in quotes belongs to the cell.
    let delimiter = u8::try_from(separator).unwrap_or(b',');
    let mut reader =
        ReaderBuilder::new().has_headers(false).delimiter(delimiter).trim(Trim::All).from_reader(line.as_bytes());
    let mut record = ByteRecord::new();
    match reader.read_byte_record(&mut record) {
        Ok(true) => record.iter().map(|cell| String::from_utf8_lossy(cell).trim().to_owned()).collect(),
        _ => plain(),
    }
}

/// Whether a cell is a number, or empty, as that of a lost frame.
fn looks_numeric(cell: &str, decimal_comma: bool) -> bool {
    cell.is_empty() || number(cell, decimal_comma).is_some() || is_not_a_number(cell)
}

/// Whether a cell holds the word for no number.
pub(super) fn is_not_a_number(cell: &str) -> bool {
    let word = cell.trim_start_matches(['+', '-']).to_ascii_lowercase();
    matches!(word.as_str(), "nan" | "inf" | "infinity")
}

/// The number in a cell.
pub(super) fn number(cell: &str, decimal_comma: bool) -> Option<f64> {
    let begins =
        cell.trim_start_matches(['+', '-']).starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | ','));
    if !begins {
        return None;
    }
    if decimal_comma && cell.contains(',') { cell.replacen(',', ".", 1).parse().ok() } else { cell.parse().ok() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separators_are_found_and_quotes_kept_together() {
        let table = |text: &str| TextTable::split(text, None, 0).unwrap();
        for text in [
            "t;phi\n0;1,5\n1;2,5\n",
            "t phi\n0 1.5\n1\t2.5\n",
            "t,phi\n0,1.5\n\n# c\n1,2.5\n",
            "\"t\"\t\"phi\"\n0\t1,5\n1\t2.5\n",
        ] {
            let found = table(text);
            assert_eq!(found.heading.as_ref().unwrap().1, ["t", "phi"], "{text}");
            let value = |cell: &str| number(cell, found.decimal_comma).unwrap();
            let values: Vec<f64> = found.rows.iter().map(|(_, cells)| value(&cells[1])).collect();
            assert_eq!(values, [1.5, 2.5], "{text}");
        }
        assert_eq!(table("t [ms] phi (deg) x\n0 1.5 2\n").heading.unwrap().1, ["t [ms]", "phi (deg)", "x"]);
        assert_eq!(table("phi of block [deg]\n1.5\n").heading.unwrap().1, ["phi of block [deg]"]);
        assert_eq!(table("t,\"angle, left\"\n0,1\n").heading.unwrap().1, ["t", "angle, left"]);
        assert_eq!(TextTable::split("made by us\nt,phi\n0,1\n", None, 1).unwrap().rows.len(), 1);
    }
}
