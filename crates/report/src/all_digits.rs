//! Numbers that were measured, for people: with the zeros at their ends that are digits. 1.0501 s is 1.050 s, and 1.05 s is exactly that.

use crate::{shortest, with_digits};

/// Digits with which a number that is short is taken for exact: more are rounding.
const EXACT: usize = 9;

/// As [`with_digits`], but with the zeros at its end where `x` was rounded.
pub(crate) fn with_all_digits(x: f64, unit: &str, digits: usize) -> String {
    let shown = with_digits(x, unit, digits);
    if shown == with_digits(x, unit, EXACT) {
        return shown;
    }
    match shown.split_once(' ') {
        Some((number, unit)) => format!("{} {unit}", padded(number, digits)),
        None => shown,
    }
}

/// As [`with_digits`], but with all zeros at its end, also of what is exact: numbers of one kind beside each other, as energies, have as many digits.
pub(crate) fn with_zeros(x: f64, unit: &str, digits: usize) -> String {
    let shown = with_digits(x, unit, digits);
    match shown.split_once(' ') {
        Some((number, unit)) if x != 0.0 => format!("{} {unit}", padded(number, digits)),
        _ => shown,
    }
}

/// As [`shortest`], but with the zeros at its end where `x` was rounded.
pub(crate) fn all_digits(x: f64, digits: usize) -> String {
    let shown = shortest(x, digits);
    if shown == shortest(x, EXACT) { shown } else { padded(&shown, digits) }
}

/// A number with zeros up to so many significant digits.
fn padded(number: &str, digits: usize) -> String {
    let own = number.chars().filter(char::is_ascii_digit).skip_while(|digit| *digit == '0').count();
    if number.contains('e') || own == 0 || own >= digits {
        return number.to_owned();
    }
    let point = if number.contains('.') { "" } else { "." };
    format!("{number}{point}{}", "0".repeat(digits - own))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_rounded_keeps_its_zeros() {
        assert_eq!(
            [1.0501, 1.05, 0.26996, 1e-3].map(|t| with_all_digits(t, "s", 4)),
            ["1.050 s", "1.05 s", "270.0 ms", "1 ms"]
        );
        assert_eq!(
            [1.798, 1.8, 0.05004, -1.699, 20.0].map(|x| all_digits(x, 3)),
            ["1.80", "1.8", "0.0500", "-1.70", "20"]
        );
        assert_eq!(
            (with_all_digits(1.0049e-3, "J", 3), with_all_digits(0.0, "J", 3)),
            ("1.00 mJ".into(), "0 J".into())
        );
        assert_eq!(
            [1.0, 1.0049, 0.0, -0.02].map(|energy| with_zeros(energy, "J", 3)),
            ["1.00 J", "1.00 J", "0 J", "-20.0 mJ"]
        );
        assert_eq!(
            (all_digits(1e-9 * 1.001, 3), with_all_digits(0.12 + 1e-14, "s", 4)),
            ("1e-9".into(), "120 ms".into())
        );
    }
}
