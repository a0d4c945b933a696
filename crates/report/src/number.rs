//! Rows of numbers as CSV text.

use std::fmt::Write;

/// Appends a number in the shortest form that reads back to the same double.
pub(crate) fn push(line: &mut String, x: f64) {
    // Writing to a String can't fail.
    let _ = write!(line, "{x:?}");
}

/// Appends a comma and a number.
pub(crate) fn push_next(line: &mut String, x: f64) {
    line.push(',');
    push(line, x);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_to_the_same_double() {
        for x in [0.1, -0.0, 1e-5, 1.0 / 3.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, 1e16, 123_456_789.123] {
            let mut line = String::new();
            push(&mut line, x);
            assert_eq!(line.parse::<f64>().unwrap().to_bits(), x.to_bits(), "{line}");
        }
    }
}
