//! When a maximum is first reached: values within rounding of it count as equal, so that a constant has the time of its start.

/// Values that differ by less than this part of themselves are the same.
const ROUNDING: f64 = 1e-9;

/// Whether a value, not negative, is larger than the largest so far by more than rounding.
pub(crate) fn exceeds(value: f64, largest: f64) -> bool {
    value > largest * (1.0 + ROUNDING)
}

/// The number of the first of the largest of these, not negative; none without any.
pub(crate) fn first_of_largest(values: &[f64]) -> Option<usize> {
    let most = values.iter().copied().reduce(f64::max)?;
    values.iter().position(|value| !exceeds(most, *value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_values_that_differ_by_rounding_the_first_is_the_largest() {
        let again = 0.3_f64 * 3.0;
        assert!(again > 0.9 - 1e-15 && again != 0.9);
        assert_eq!(first_of_largest(&[0.1, again.min(0.9), 0.2, again.max(0.9)]), Some(1));
        assert_eq!(first_of_largest(&[0.1, 0.9, 0.91]), Some(2));
        assert_eq!(first_of_largest(&[0.0, 0.0]), Some(0));
        assert_eq!(first_of_largest(&[]), None);
    }
}
