//! Where a condition becomes true.

/// The first number after which `passed` holds, given that it doesn't at `low`, does at `high`, and changes once between:
/// halves the interval until no double lies within.
pub(crate) fn boundary(mut low: f64, mut high: f64, mut passed: impl FnMut(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        // Also where a bound is no number: neither comparison holds.
        if !(low.min(high) < middle && middle < low.max(high)) {
            return high;
        }
        if passed(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::boundary;

    #[test]
    fn the_boundary_is_found_to_the_last_digit() {
        assert_eq!(boundary(0.0, 4.0, |x| x * x >= 2.0), std::f64::consts::SQRT_2);
        assert_eq!(boundary(4.0, 0.0, |x| x <= 1.5), 1.5);
        assert!(boundary(0.0, f64::NAN, |_| true).is_nan());
    }
}
