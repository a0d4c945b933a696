//! When a maximum is first reached: values within rounding of it count as equal, so that a constant has the time of its start. The maximum itself is the
//! largest of all values.

/// Values that differ by less than this part of themselves are the same.
const ROUNDING: f64 = 1e-9;

/// Whether a value, not negative, is larger than the largest so far by more than rounding.
pub(crate) fn exceeds(value: f64, largest: f64) -> bool {
    value > largest * (1.0 + ROUNDING)
}

/// Takes a value, not negative, into the `largest` so far, and returns whether the time that is told of that is now: it is, if the value is larger by
/// more than rounding than the one at the time told so far, `first`.
pub(crate) fn enter(value: f64, largest: &mut f64, first: &mut f64) -> bool {
    *largest = largest.max(value);
    let is_now = exceeds(value, *first);
    if is_now {
        *first = value;
    }
    is_now
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
    fn the_largest_is_none_that_is_less_by_rounding_and_has_the_time_of_the_first_of_these() {
        let (mut largest, mut first) = (0.0, 0.0);
        let times = |values: &[f64], largest: &mut f64, first: &mut f64| -> Vec<bool> {
            values.iter().map(|value| enter(*value, largest, first)).collect()
        };
        assert_eq!(times(&[0.0, 0.9, 0.9 + 5e-10, 0.5], &mut largest, &mut first), [false, true, false, false]);
        assert_eq!(largest, 0.9 + 5e-10);
        // What creeps on is followed: the time told is of a value within rounding of the largest.
        assert_eq!(times(&[0.9 + 8e-10, 0.9 + 11e-10], &mut largest, &mut first), [false, true]);
        assert_eq!((largest, first), (0.9 + 11e-10, 0.9 + 11e-10));
    }

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
