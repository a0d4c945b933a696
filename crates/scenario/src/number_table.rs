//! Files with columns of numbers: tables of signals (time and value), and shapes of beams.

use std::ops::RangeInclusive;

use crate::diagnostic::printable;
use crate::dimension::Dimension;
use crate::keys::Range;
use crate::quantity;
use crate::separators::with_commas;

/// Largest file accepted, bytes.
pub const LARGEST_RECORD: usize = 64_000_000;

/// Most rows: a signal takes 32 bytes for each.
pub const MOST_ROWS: usize = 2_000_000;

/// The columns of a table, and the line of each row.
pub(crate) struct NumberColumns {
    pub(crate) columns: Vec<Vec<f64>>,
    pub(crate) lines: Vec<u64>,
}

/// Reads a table of numbers: separated by commas, semicolons, tabs or blanks (with any but the first,
/// a comma may be the decimal point), with the same number of columns in each row; a first row of words is a heading, lines that start with `#` are comments. `names` describes the
/// columns in messages; `dimensions` are theirs, in SI units unless the heading gives another unit,
/// as `t [ms]`. Numbers must be within the limits of keys.
///
/// # Errors
/// What is wrong, with the line.
pub(crate) fn columns(
    bytes: &[u8],
    count_of: RangeInclusive<usize>,
    names: &str,
    dimensions: &[Dimension],
) -> Result<NumberColumns, String> {
    if bytes.len() > LARGEST_RECORD {
        return Err(format!("larger than {} MB, the limit of a table", LARGEST_RECORD / 1_000_000));
    }
    let bytes = with_commas(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))?;
    let bytes = bytes.as_ref();
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .comment(Some(b'#'))
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(bytes);
    // Memory is allocated only as rows are found.
    let (mut columns, mut lines): (Vec<Vec<f64>>, Vec<u64>) = (Vec::new(), Vec::new());
    let mut count = LineCounter { bytes, at: 0, line: 1 };
    let mut row = csv::ByteRecord::new();
    let mut first = true;
    let mut units: Vec<Option<String>> = Vec::new();
    loop {
        match reader.read_byte_record(&mut row) {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) => return Err(format!("can't be read: {error}")),
        }
        let line = count.line_of(row.position().map_or(0, csv::Position::byte));
        let heading = std::mem::take(&mut first) && row.iter().all(is_word);
        if heading {
            units = heading_units(&row, dimensions).map_err(|why| format!("line {line}: {why}"))?;
            continue;
        }
        let as_before = columns.is_empty() || row.len() == columns.len();
        if !count_of.contains(&row.len()) || !as_before {
            return Err(format!(
                "line {line}: {} column{}, but a table has {names}{}",
                row.len(),
                if row.len() == 1 { "" } else { "s" },
                other_separator(&row).map_or_else(String::new, |other| format!(
                    ", separated by a comma; these are separated by {other}"
                ))
            ));
        }
        columns.resize_with(row.len(), Vec::new);
        if lines.len() == MOST_ROWS {
            return Err(format!("line {line}: more than {MOST_ROWS} rows, the limit of a table"));
        }
        for (k, (cell, column)) in row.iter().zip(&mut columns).enumerate() {
            let read = match (units.get(k).and_then(Option::as_deref), dimensions.get(k)) {
                (Some(unit), Some(dimension)) => number_in(cell, unit, *dimension),
                _ => number(cell),
            };
            let value = read.ok_or_else(|| format!("line {line}: {}", not_a_number(cell, &row)))?;
            if let Some(beyond) = beyond_limits(value) {
                let column = k + 1;
                return Err(format!(
                    "line {line}, column {column}: {value:e} is {beyond} in absolute value, the limit of numbers"
                ));
            }
            column.push(value);
        }
        lines.push(line);
    }
    Ok(NumberColumns { columns, lines })
}

/// Reads two columns of a table: the only two, or those named by their headings, or by their numbers
/// from 1. `described` describes both in messages. `unit` is a unit for those of the first `of`
/// columns whose heading has none, and how many of it make an SI unit.
///
/// # Errors
/// What is wrong, with the line.
pub(crate) fn two_columns(
    bytes: &[u8],
    names: Option<[&str; 2]>,
    (described, dimensions): (&str, &[Dimension]),
    unit: Option<(&str, f64)>,
    of: usize,
) -> Result<NumberColumns, String> {
    if bytes.len() > LARGEST_RECORD {
        return Err(format!("larger than {} MB, the limit of a table", LARGEST_RECORD / 1_000_000));
    }
    let bytes = with_commas(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))?;
    let bytes = bytes.as_ref();
    let text = String::from_utf8_lossy(bytes);
    let heading = text.lines().enumerate().find(|(_, line)| is_row(line));
    let heading = heading.map(|(index, line)| (index + 1, line.split(',').collect::<Vec<_>>()));
    let heading = heading.filter(|(_, cells)| cells.iter().all(|cell| is_word(cell.trim().as_bytes())));
    let cells = heading.as_ref().map(|(_, cells)| cells.as_slice()).unwrap_or_default();
    let chosen = match names {
        None => [0, 1],
        Some([x, y]) => [column_named(x, cells)?, column_named(y, cells)?],
    };
    if let (Some((line, _)), Some((unit, _))) = (&heading, unit)
        && let Some(own) = chosen.iter().take(of).find_map(|k| unit_of(cells.get(*k)?.trim()))
    {
        let own = printable(own);
        return Err(format!("line {line}: the heading has the unit `{own}`, so `{unit}` must be left out"));
    }
    let mut found = match names {
        None => columns(bytes, 2..=2, described, dimensions)?,
        Some(_) => columns(chosen_columns(&text, chosen)?.as_bytes(), 2..=2, described, dimensions)?,
    };
    if let Some((_, per_si_unit)) = unit {
        found.columns.iter_mut().take(of).flatten().for_each(|x| *x /= per_si_unit);
    }
    Ok(found)
}

/// Reads the points of a line from two columns, x and y in m, as [`two_columns`] does; `unit` is one of
/// both.
///
/// # Errors
/// What is wrong, with the line.
pub(crate) fn points(
    bytes: &[u8],
    names: Option<[&str; 2]>,
    unit: Option<(&str, f64)>,
) -> Result<NumberColumns, String> {
    two_columns(bytes, names, ("two, x and y", &[Dimension::LENGTH, Dimension::LENGTH]), unit, 2)
}

/// Whether a line holds cells.
fn is_row(line: &str) -> bool {
    !line.trim().is_empty() && !line.starts_with('#')
}

/// The number of a column, from 0, by its heading or by its number from 1.
fn column_named(name: &str, heading: &[&str]) -> Result<usize, String> {
    let title = |cell: &str| {
        let title = cell.split(['[', '(']).next().unwrap_or_default();
        title.trim().trim_matches('"').trim().to_lowercase()
    };
    let by_name = heading.iter().position(|cell| title(cell) == name.to_lowercase());
    let by_number = || name.parse::<usize>().ok()?.checked_sub(1);
    by_name.or_else(by_number).ok_or_else(|| match heading {
        [] => format!("there is no heading that names a column `{}`: give its number", printable(name)),
        cells => {
            let known: Vec<String> = cells.iter().map(|cell| printable(&title(cell))).collect();
            format!("there is no column `{}`: the heading has {}", printable(name), known.join(", "))
        }
    })
}

/// The text with two of its columns only, in the same lines.
fn chosen_columns(text: &str, chosen: [usize; 2]) -> Result<String, String> {
    let mut only = String::with_capacity(text.len());
    for (index, line) in text.lines().enumerate() {
        if is_row(line) {
            let cells: Vec<&str> = line.split(',').collect();
            let cell = |k: usize| {
                let (line, count) = (index + 1, cells.len());
                let plural = if count == 1 { "" } else { "s" };
                cells
                    .get(k)
                    .ok_or_else(|| format!("line {line}: {count} column{plural}, but column {} is asked for", k + 1))
            };
            only.push_str(cell(chosen[0])?);
            only.push(',');
            only.push_str(cell(chosen[1])?);
        }
        only.push('\n');
    }
    Ok(only)
}

/// Why a cell of a row can't be read.
fn not_a_number(cell: &[u8], row: &csv::ByteRecord) -> String {
    let text = printable(&String::from_utf8_lossy(cell));
    let other = other_separator(row).map_or_else(String::new, |other| format!("; these are separated by {other}"));
    format!("`{text}` is not a number{other}")
}

/// The limit that a number exceeds, in words. Numbers that aren't finite have their own message.
fn beyond_limits(value: f64) -> Option<String> {
    let limits = Range::ANY;
    match value.abs() {
        size if size > limits.largest && size.is_finite() => Some(format!("over {:e}", limits.largest)),
        size if size > 0.0 && size < limits.smallest => Some(format!("below {:.1e}", limits.smallest)),
        _ => None,
    }
}

/// Counts lines. (The reader's own count is the end of the row before, ahead of blank lines and
/// comments.)
struct LineCounter<'a> {
    bytes: &'a [u8],
    /// Lines are counted up to this byte.
    at: usize,
    line: u64,
}

impl LineCounter<'_> {
    /// The line of the row that the reader found at or after a byte; the byte must not decrease
    /// between calls.
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

/// Whether a cell of the first row is a word of a heading, that is, doesn't begin like a number.
fn is_word(cell: &[u8]) -> bool {
    let unsigned = cell.strip_prefix(b"-").or_else(|| cell.strip_prefix(b"+")).unwrap_or(cell);
    let unsigned = unsigned.strip_prefix(b".").unwrap_or(unsigned);
    number(cell).is_none() && !unsigned.first().is_some_and(u8::is_ascii_digit)
}

/// The separator of a row with the wrong number of columns, if it isn't a comma, in words.
fn other_separator(row: &csv::ByteRecord) -> Option<&'static str> {
    let whole = row.iter().map(String::from_utf8_lossy).collect::<Vec<_>>().join(",");
    if whole.contains(';') {
        return Some("a semicolon");
    }
    let parts: Vec<&str> = whole.split_whitespace().collect();
    let numbers = parts.len() > 1 && parts.iter().all(|part| part.replace(',', ".").parse::<f64>().is_ok());
    numbers.then_some(if whole.contains('\t') { "a tab" } else { "blanks" })
}

/// The units in a heading, by column: `t [ms]`, `t (ms)`; `None` for the SI unit itself.
fn heading_units(heading: &csv::ByteRecord, dimensions: &[Dimension]) -> Result<Vec<Option<String>>, String> {
    let is_time = |cell: &[u8]| {
        let cell = String::from_utf8_lossy(cell).to_lowercase();
        let name = cell.split(['[', '(']).next().unwrap_or_default().trim().trim_matches('"').to_owned();
        name == "t" || name == "time"
    };
    let mut cells = heading.iter();
    if dimensions.first() == Some(&Dimension::TIME)
        && cells.next().is_some_and(|cell| !is_time(cell))
        && cells.any(is_time)
    {
        return Err("the heading has the time in another column: it must be in the first".to_owned());
    }
    let mut units = Vec::new();
    for (cell, dimension) in heading.iter().zip(dimensions) {
        let cell = String::from_utf8_lossy(cell);
        units.push(match unit_of(&cell) {
            None => None,
            Some(unit) => {
                heading_unit(unit, *dimension).map_err(|why| format!("heading `{}`: {why}", printable(&cell)))?
            }
        });
    }
    Ok(units)
}

/// The text in brackets at the end of a heading.
fn unit_of(cell: &str) -> Option<&str> {
    let (open, inner) = match cell.trim_matches('"').trim_end() {
        text if text.ends_with(']') => ('[', text.strip_suffix(']')?),
        text if text.ends_with(')') => ('(', text.strip_suffix(')')?),
        _ => return None,
    };
    Some(inner.rsplit_once(open)?.1.trim())
}

/// The unit of a column, if its numbers must be converted to SI.
fn heading_unit(unit: &str, dimension: Dimension) -> Result<Option<String>, String> {
    let none = dimension == Dimension::NONE;
    let bare = matches!(unit, "" | "-" | "1");
    if bare && (none || dimension == Dimension::ANGLE) {
        return Ok(None);
    }
    if none {
        return Err(format!(
            "the values of a signal have no unit, got `{}`: give the unit with the amplitude that the signal multiplies, and leave \
             it out here",
            printable(unit)
        ));
    }
    match quantity::parse(&format!("1 {unit}"), dimension) {
        Ok(1.0) => Ok(None),
        Ok(_) => Ok(Some(unit.to_owned())),
        Err(error) => Err(format!("{error}; write the unit in brackets, such as [{}]", dimension.unit())),
    }
}

/// A number in a unit other than SI's, as if it had been written in a scene.
fn number_in(cell: &[u8], unit: &str, dimension: Dimension) -> Option<f64> {
    let value = number(cell)?;
    // Zeros, and numbers that aren't finite, are the same in all units.
    if value == 0.0 || !value.is_finite() {
        return Some(value);
    }
    quantity::parse(&format!("{} {unit}", std::str::from_utf8(cell).ok()?), dimension).ok()
}

/// NaN and infinities are numbers here, so that they get their own message.
fn number(cell: &[u8]) -> Option<f64> {
    std::str::from_utf8(cell).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_integrator::Table;

    fn read(bytes: &[u8], start: f64) -> Result<Table, String> {
        crate::signal_table::of_columns(bytes, start, None, None)
    }
    use teeter_integrator::Signal;

    #[test]
    fn headings_comments_blanks_and_windows_lines_are_read_over() {
        let text = "\u{feff}# from a shake table\r\nt, a\r\n\r\n0, 1 \r\n# later\r\n0.5,\t-2e0\r\n";
        let table = read(text.as_bytes(), 1.0).unwrap();
        assert_eq!(table.ends(), [(1.0, 1.0), (1.5, -2.0)]);
        assert_eq!(table.value(1.25), -0.5);
    }

    #[test]
    fn a_table_by_any_separator_is_read() {
        for text in ["t [ms];a\n0;1,5\n500;-2\n", "t [ms]\ta\n0\t1.5\n500\t-2\n", "# c\n0 1.5\n0.5  -2\n"] {
            assert_eq!(read(text.as_bytes(), 1.0).unwrap().ends(), [(1.0, 1.5), (1.5, -2.0)], "{text}");
        }
        let found = points(b"x [mm];y [mm]\n0;1,5\n10;2\n", Some(["x", "y"]), None).unwrap();
        assert_eq!(found.columns, [vec![0.0, 0.01], vec![0.0015, 0.002]]);
    }

    #[test]
    fn units_of_a_heading_are_honoured_or_refused() {
        for heading in ["t [ms], a", "t (ms), a [-]", "\"time [ms]\",\"a\""] {
            let table = read(format!("{heading}\n0, 1\n0.3, 2\n1e1, -2\n").as_bytes(), 1.0).unwrap();
            assert_eq!(table.ends(), [(1.0, 1.0), (1.01, -2.0)], "{heading}");
            assert_eq!(table.value(1.0 + 0.3e-3), 2.0, "as if written in seconds");
        }
        assert_eq!(read(b"t [s], a (1)\n0,1\n2,3\n", 0.0).unwrap().ends(), [(0.0, 1.0), (2.0, 3.0)]);
        let told = |text: &str| read(text.as_bytes(), 0.0).unwrap_err();
        assert_eq!(
            told("t [m],a\n0,1\n1,2\n"),
            "line 1: heading `t [m]`: a time (s) is expected, got a length (m); write the unit in brackets, such as [s]"
        );
        assert!(told("t [fortnights],a\n0,1\n1,2\n").contains("unknown unit `fortnights`"));
        assert!(told("t,a [m/s^2]\n0,1\n1,2\n").contains("the values of a signal have no unit, got `m/s^2`"));
        assert_eq!(told("t [ms],a\n0,1\n1,nan\n"), "line 3: the value is NaN, but must be finite");
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
        // The first rows decide; others are told.
        assert_eq!(
            told("t,a\n0,1\n1;2\n"),
            "line 3: 1 column, but a table has two, t and value, separated by a comma; these are separated by a semicolon"
        );
        assert!(told("0,1\n1,1\n2\t1\n").ends_with("these are separated by a tab"));
        assert!(told("0,1\n1,1\n2 1\n").ends_with("these are separated by blanks"));
        assert_eq!(told("t;a\n0;1,5\n1;high\n"), "line 3: `high` is not a number");
        assert_eq!(told("0 1\n1 nan\n"), "line 2: the value is NaN, but must be finite");
        assert!(told("1e400x,2\n0,1\n1,2\n").starts_with("line 1: `1e400x` is not a number"));
        assert_eq!(told("0,1\n1,2,3\n"), "line 2: 3 columns, but a table has two, t and value");
        assert_eq!(told("0 1\n1 2\n2\n3 0\n"), "line 3: 1 column, but a table has two, t and value");
        assert_eq!(told("0 1\n1\n2 3\n"), "line 2: 1 column, but a table has two, t and value");
        assert_eq!(told("0,1\n1,high\n"), "line 2: `high` is not a number");
        assert!(told(&"0,1\n".repeat(MOST_ROWS + 1)).starts_with("line 2000001: more than 2000000 rows"));
        assert_eq!(
            told("0,1\n1,1e308\n"),
            "line 2, column 2: 1e308 is over 1e12 in absolute value, the limit of numbers"
        );
        assert!(told("0,1\n1e-320,2\n").ends_with("is below 2.2e-308 in absolute value, the limit of numbers"));
        assert!(told("0,1\n1e-20,2\n").starts_with("line 2: 1e-20 s after the row before, below 1e-15 s"));
        assert!(read(&vec![b'1'; LARGEST_RECORD + 1], 0.0).unwrap_err().contains("64 MB"));
    }
}
