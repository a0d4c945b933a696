//! Tables whose columns are separated by semicolons, tabs or blanks, with decimal points or commas.

use std::borrow::Cow;
use teeter_record::RecordError;

/// The same table with commas between its columns and points in its numbers, in the same lines. A table
/// that is separated by commas, or has one column, stays as it is.
///
/// # Errors
/// If the file isn't text, or a heading separated by blanks can't be told into columns.
pub(crate) fn with_commas(bytes: &[u8]) -> Result<Cow<'_, [u8]>, String> {
    // Of what is no text, numbers would be told as bytes.
    if let Some((at, byte)) = teeter_record::binary_byte(bytes) {
        return Err(RecordError::NotText { at, byte }.to_string());
    }
    // What isn't in UTF-8 has its own message.
    let Ok(text) = std::str::from_utf8(bytes) else { return Ok(Cow::Borrowed(bytes)) };
    // The heading may have blanks in its names, so the row below it decides.
    let mut rows = text.lines().filter(|line| is_row(line)).take(2);
    let above = rows.next().unwrap_or_default();
    let sample = rows.next().unwrap_or(above);
    // In a table both have it; otherwise what is wrong is told of the text as it is. Of two rows of numbers the second may be short.
    let is_short = || {
        let of_numbers = [above, sample].iter().all(|row| row.trim_start().starts_with(begins_number));
        separator_of(above).filter(|_| of_numbers && separator_of(sample).is_none())
    };
    let separator = separator_of(sample).filter(|separator| cells(above, *separator).len() > 1).or_else(is_short);
    let Some(separator) = separator else { return Ok(Cow::Borrowed(bytes)) };
    let columns = cells(sample, separator).len();
    let mut written = String::with_capacity(text.len() + 16);
    let mut first = true;
    for (index, line) in text.split('\n').enumerate() {
        if index > 0 {
            written.push('\n');
        }
        if !is_row(line) {
            // Comments, and blank lines, which count.
            written.push_str(line);
            continue;
        }
        let cells = cells(line, separator);
        let units = line.contains(['[', '(']);
        if std::mem::take(&mut first) && separator == ' ' && units && cells.len() != columns {
            let (found, line) = (cells.len(), index + 1);
            return Err(format!(
                "line {line}: the heading has {found} columns, but the row below has {columns}: separate them by commas or \
                 semicolons"
            ));
        }
        for (place, cell) in cells.iter().enumerate() {
            if place > 0 {
                written.push(',');
            }
            written.push_str(&with_point(cell));
        }
    }
    Ok(Cow::Owned(written.into_bytes()))
}

fn begins_number(c: char) -> bool {
    c.is_ascii_digit() || matches!(c, '+' | '-' | '.')
}

fn is_row(line: &str) -> bool {
    !line.trim().is_empty() && !line.starts_with('#')
}

/// The separator of a row, if it isn't a comma: the strongest that is there.
fn separator_of(row: &str) -> Option<char> {
    match [';', '\t', ','].into_iter().find(|&separator| row.trim().contains(separator)) {
        // A tab or a blank after a comma is none.
        Some('\t') if row.contains(',') && row.split('\t').any(|cell| cell.trim_end().ends_with(',')) => None,
        Some(',') => None,
        Some(separator) => Some(separator),
        None => row.trim().contains(char::is_whitespace).then_some(' '),
    }
}

/// The cells of a row; a unit in brackets after a blank belongs to the heading before it.
fn cells(line: &str, separator: char) -> Vec<Cow<'_, str>> {
    if separator != ' ' {
        return line.split(separator).map(|cell| Cow::Borrowed(cell.trim())).collect();
    }
    let mut cells: Vec<Cow<'_, str>> = Vec::new();
    for word in line.split_whitespace() {
        match cells.last_mut() {
            Some(last) if word.starts_with(['[', '(']) => {
                let joined = format!("{last} {word}");
                *last = Cow::Owned(joined);
            }
            _ => cells.push(Cow::Borrowed(word)),
        }
    }
    cells
}

/// A cell with its decimal comma as a point; any other cell with a comma in quotes.
fn with_point(cell: &str) -> Cow<'_, str> {
    if !cell.contains(',') || cell.contains('"') {
        return Cow::Borrowed(cell);
    }
    let point = cell.replacen(',', ".", 1);
    if point.parse::<f64>().is_ok() { Cow::Owned(point) } else { Cow::Owned(format!("\"{cell}\"")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(text: &str) -> String {
        String::from_utf8(with_commas(text.as_bytes()).unwrap().into_owned()).unwrap()
    }

    #[test]
    fn tables_by_any_separator_are_tables_by_commas() {
        for text in [
            "t [ms],a\n0,1.5\n1,-2e0\n",
            "t [ms];a\n0;1,5\n1;-2e0\n",
            "t [ms];a\n0;1.5\n1;-2e0\n",
            "t [ms]\ta\n0\t1,5\n1\t-2e0\n",
            "t [ms] a\n0 1.5\n1 -2e0\n",
            "t[ms]   a\n  0  1.5\n1 \t-2e0\n",
        ] {
            assert_eq!(written(text).replace("t[", "t ["), "t [ms],a\n0,1.5\n1,-2e0\n", "{text:?}");
        }
    }

    #[test]
    fn what_is_separated_by_commas_stays_byte_by_byte() {
        for text in [
            "",
            "1\n2\n",
            "t, a\n0, 1\n",
            "\"a;b\",c\n0,1\n",
            "t,\ta\n0,\t1\n",
            "0,1\n1,2;3\n",
            "t,a\n0;1\n",
            "a b\n1\n2\n",
            "1\n2 3\n",
            "0,1\n1\n",
        ] {
            assert!(matches!(with_commas(text.as_bytes()).unwrap(), Cow::Borrowed(_)), "{text:?}");
        }
        assert!(matches!(with_commas(&[0xff, b';', b'1']).unwrap(), Cow::Borrowed(_)), "no text");
    }

    #[test]
    fn lines_stay_where_they_are() {
        assert_eq!(written("# a;b\r\n\r\n0;1\r\n# c\r\n1;x,y\r\n"), "# a;b\r\n\r\n0,1\n# c\r\n1,\"x,y\"\n");
        assert_eq!(written("0 1\n1\n2 3\n"), "0,1\n1\n2,3\n", "a second row that is short");
        assert_eq!(with_commas(b"\x7fELF\x02\0\0\n\0").unwrap_err(), "not a text file: byte 4 is 0x02");
        let told = with_commas(b"time of day [s] a\n0 1\n1 2\n").unwrap_err();
        assert!(told.starts_with("line 1: the heading has 4 columns, but the row below has 2"), "{told}");
    }
}
