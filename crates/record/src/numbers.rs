//! Parsing numbers as Fortran programs write them.

use crate::error::{RecordError, shown};

/// Hint for two numbers without a separator.
const RUN_TOGETHER: &str = "; numbers must be separated or begin with a sign";

/// Calls `each` with the text and the value of every number of a line. Numbers are separated by blanks or commas, or adjoin
/// where a sign starts the next one or where a point follows an exponent (of two digits then).
///
/// # Errors
/// If a text isn't a number, or the error of `each`.
pub(crate) fn free(
    line: usize,
    text: &str,
    mut each: impl FnMut(&str, f64) -> Result<(), RecordError>,
) -> Result<(), RecordError> {
    let mut rest = text;
    loop {
        rest = rest.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
        if rest.is_empty() {
            return Ok(());
        }
        let length = length(rest.as_bytes());
        let bad = || {
            let word = rest.split(|c: char| c.is_whitespace() || c == ',').next().unwrap_or_default();
            RecordError::Number { line, text: shown(word), hint: if length == 0 { "" } else { RUN_TOGETHER } }
        };
        let (number, after) = rest.split_at_checked(length).ok_or_else(bad)?;
        let next = after.chars().next();
        let ends = next.is_none_or(|c| c.is_whitespace() || matches!(c, ',' | '+' | '-'));
        let exponent = number.contains(['e', 'E', 'd', 'D']);
        let begins = exponent && next.is_some_and(|c| c == '.' || c.is_ascii_digit());
        let value = if ends || begins { one(number) } else { None };
        each(number, value.ok_or_else(bad)?)?;
        rest = after;
    }
}

/// Length in bytes of the number at the beginning of a text; 0 if there is none.
fn length(text: &[u8]) -> usize {
    let digits = |from: usize| text.iter().skip(from).take_while(|c| c.is_ascii_digit()).count();
    let is = |at: usize, what: &[u8]| text.get(at).is_some_and(|c| what.contains(c));
    let mut end = usize::from(is(0, b"+-"));
    let whole = digits(end);
    end += whole;
    let mut part = 0;
    if is(end, b".") {
        part = digits(end + 1);
        end += 1 + part;
    }
    if whole + part == 0 {
        return 0;
    }
    if is(end, b"eEdD") {
        let begin = end + 1 + usize::from(is(end + 1, b"+-"));
        let power = digits(begin);
        if power > 0 {
            // A point directly after an exponent belongs to the next number, and so do digits
            // beyond the second.
            end = begin + if is(begin + power, b".") { power.min(2) } else { power };
        }
    }
    end
}

/// Parses a single number: with or without zeros around the point, with E or D before the
/// exponent.
pub(crate) fn one(text: &str) -> Option<f64> {
    let text = text.trim();
    if length(text.as_bytes()) != text.len() || text.is_empty() {
        return None;
    }
    if text.contains(['d', 'D']) { text.replace(['d', 'D'], "e").parse().ok() } else { text.parse().ok() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<f64>, String> {
        let mut values = Vec::new();
        free(7, text, |_, value| {
            values.push(value);
            Ok(())
        })
        .map_err(|error| error.to_string())?;
        Ok(values)
    }

    #[test]
    fn adjoining_fortran_numbers_are_separated() {
        assert_eq!(read("  .5 -.25E+01,1.D-2  3 ").unwrap(), [0.5, -2.5, 0.01, 3.0]);
        assert_eq!(read("-.1234567E-01-.2345678E-02").unwrap(), [-0.01234567, -0.002345678]);
        assert_eq!(read("0.1234567E-010.2345678E-02").unwrap(), [0.01234567, 0.002345678]);
        assert_eq!(read(".1E-02.2E-02").unwrap(), [0.001, 0.002]);
        assert_eq!(read("1.5e-003 -2").unwrap(), [0.0015, -2.0]);
        assert_eq!(read("1.5-2.5+.5").unwrap(), [1.5, -2.5, 0.5]);
        assert_eq!(read("").unwrap(), []);
    }

    #[test]
    fn non_numbers_are_reported() {
        assert_eq!(read("1 high").unwrap_err(), "line 7: `high` is not a number");
        assert_eq!(read("nan").unwrap_err(), "line 7: `nan` is not a number");
        assert_eq!(
            read("1.25.5").unwrap_err(),
            "line 7: `1.25.5` is not a number; numbers must be separated or begin with a sign"
        );
        assert!(read("1.5E").unwrap_err().starts_with("line 7: `1.5E` is not a number"));
        assert!(read("-").unwrap_err().starts_with("line 7: `-` is not a number"));
        assert!(read("é").unwrap_err().starts_with("line 7: `é` is not a number"));
    }
}
