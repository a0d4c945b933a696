//! Files of columns of numbers: the tables of signals, time and value, and the shapes of beams.

use std::ops::RangeInclusive;

use teeter_integrator::{SignalError, Table};

/// Largest file that is read, bytes.
pub const LARGEST_RECORD: usize = 64_000_000;

/// Most rows: a signal takes 32 bytes for each.
pub const MOST_ROWS: usize = 2_000_000;

/// A table read: its columns, and the line of each row.
pub(crate) struct Columns {
    pub(crate) columns: Vec<Vec<f64>>,
    pub(crate) lines: Vec<u64>,
}

/// Reads a table of two columns, t in s and value, its times moved by `start`.
///
/// # Errors
/// What is wrong, and in which line.
pub(crate) fn read(bytes: &[u8], start: f64) -> Result<Table, String> {
    let Columns { columns, lines } = columns(bytes, 2..=2, "two, t and value")?;
    let [mut times, values] = <[Vec<f64>; 2]>::try_from(columns).unwrap_or_default();
    times.iter_mut().for_each(|t| *t += start);
    Table::new(times, values).map_err(|error| match error {
        SignalError::Row { row, what } => {
            let line = row.checked_sub(1).and_then(|row| lines.get(row)).copied().unwrap_or_default();
            format!("line {line}: {what}")
        }
        SignalError::Rows(rows) => {
            format!("it has {rows} row{} of numbers, but a table needs two or more", if rows == 1 { "" } else { "s" })
        }
        error => error.to_string(),
    })
}

/// Reads a table of numbers: separated by commas, as many columns in each row, a first row of words is a heading, lines that
/// start with `#` are comments. `names` are the columns in words, for messages.
///
/// # Errors
/// What is wrong, and in which line.
pub(crate) fn columns(bytes: &[u8], count_of: RangeInclusive<usize>, names: &str) -> Result<Columns, String> {
    if bytes.len() > LARGEST_RECORD {
        return Err(format!("larger than {} MB, the limit of a table", LARGEST_RECORD / 1_000_000));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .comment(Some(b'#'))
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(bytes);
    // No memory is taken before there is a row for it.
    let (mut columns, mut lines): (Vec<Vec<f64>>, Vec<u64>) = (Vec::new(), Vec::new());
    let mut count = Count { bytes, at: 0, line: 1 };
    let mut row = csv::ByteRecord::new();
    let mut first = true;
    loop {
        match reader.read_byte_record(&mut row) {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) => return Err(format!("can't be read: {error}")),
        }
        let line = count.line_of(row.position().map_or(0, csv::Position::byte));
        let heading = std::mem::take(&mut first) && row.iter().all(|cell| number(cell).is_none());
        if heading {
            continue;
        }
        let as_before = columns.is_empty() || row.len() == columns.len();
        if !count_of.contains(&row.len()) || !as_before {
            return Err(format!(
                "line {line}: {} column{}, but a table has {names}, separated by a comma",
                row.len(),
                if row.len() == 1 { "" } else { "s" }
            ));
        }
        columns.resize_with(row.len(), Vec::new);
        if lines.len() == MOST_ROWS {
            return Err(format!("line {line}: more than {MOST_ROWS} rows, the limit of a table"));
        }
        for (cell, column) in row.iter().zip(&mut columns) {
            match number(cell) {
                Some(value) => column.push(value),
                None => {
                    let text = crate::diagnostic::printable(&String::from_utf8_lossy(cell));
                    return Err(format!("line {line}: `{text}` is no number"));
                }
            }
        }
        lines.push(line);
    }
    Ok(Columns { columns, lines })
}

/// Counts lines. (The reader's own count stands at the end of the row before: ahead of blank lines and comments.)
struct Count<'a> {
    bytes: &'a [u8],
    /// Up to here the lines are counted.
    at: usize,
    line: u64,
}

impl Count<'_> {
    /// The line of the row that the reader found from a byte on, which is not before that of the last call.
    fn line_of(&mut self, byte: u64) -> u64 {
        let byte = usize::try_from(byte).unwrap_or(usize::MAX);
        let mut in_comment = false;
        while let Some(c) = self.bytes.get(self.at) {
            match c {
                b'\n' => {
                    self.line += 1;
                    in_comment = false;
                }
                b'#' => in_comment = true,
                b'\r' => {}
                _ if self.at >= byte && !in_comment => break,
                _ => {}
            }
            self.at += 1;
        }
        self.line
    }
}

/// NaN and infinities are numbers here, so that they are named as what they are.
fn number(cell: &[u8]) -> Option<f64> {
    std::str::from_utf8(cell).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_integrator::Signal;

    #[test]
    fn headings_comments_blanks_and_windows_lines_are_read_over() {
        let text = "\u{feff}# from a shake table\r\nt, a\r\n\r\n0, 1 \r\n# later\r\n0.5,\t-2e0\r\n";
        let table = read(text.as_bytes(), 1.0).unwrap();
        assert_eq!(table.ends(), [(1.0, 1.0), (1.5, -2.0)]);
        assert_eq!(table.value(1.25), -0.5);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let told = |text: &str| read(text.as_bytes(), 0.0).unwrap_err();
        assert_eq!(told("t,a\n0,1\n1,nan\n"), "line 3: the value is NaN, but must be finite");
        assert_eq!(
            told("# c\r\n0,1\r\n1,2\r\n\r\n# 9\r\n0.5,2\r\n"),
            "line 6: the time 0.5 s is not later than 1 s of the row before"
        );
        assert_eq!(told("t,a\n0,1\n"), "it has 1 row of numbers, but a table needs two or more");
        assert_eq!(told(""), "it has 0 rows of numbers, but a table needs two or more");
        assert!(told("t;a\n0;1\n").starts_with("line 2: 1 column, but a table has two"));
        assert_eq!(told("0,1\n1,2,3\n"), "line 2: 3 columns, but a table has two, t and value, separated by a comma");
        assert_eq!(told("0,1\n1,high\n"), "line 2: `high` is no number");
        assert!(told(&"0,1\n".repeat(MOST_ROWS + 1)).starts_with("line 2000001: more than 2000000 rows"));
        assert!(read(&vec![b'1'; LARGEST_RECORD + 1], 0.0).unwrap_err().contains("64 MB"));
    }
}
