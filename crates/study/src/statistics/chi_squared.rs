//! The χ² distribution.

use std::f64::consts::PI;

/// The probability that χ² with so many degrees of freedom is larger than `x`: finite sums of h = x/2, which begin with e^(−h) or
/// erfc(√h) (M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 26.4.4 and 26.4.5).
pub(super) fn chi_squared_tail(x: f64, degrees: usize) -> f64 {
    let h = 0.5 * x.max(0.0);
    let (mut tail, mut term, first) = match degrees % 2 {
        0 => (0.0, (-h).exp(), 1.0),
        _ => (libm::erfc(h.sqrt()), 2.0 * (h / PI).sqrt() * (-h).exp(), 1.5),
    };
    for k in 0..degrees / 2 {
        tail += term;
        term *= h / (first + k as f64);
    }
    tail
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_are_those_of_the_tables() {
        // scipy.stats.chi2.sf.
        let all = [
            (3.0, 1, 0.083_264_516_663_550_42),
            (12.5, 4, 0.013_995_792_487_650_894),
            (12.5, 5, 0.028_543_123_326_167_485),
            (40.0, 9, 7.598_525_229_464_264e-6),
        ];
        for (x, degrees, tail) in all {
            assert!((chi_squared_tail(x, degrees) / tail - 1.0).abs() < 1e-12, "{x} {degrees}");
        }
        assert_eq!([1, 2, 5].map(|degrees| chi_squared_tail(0.0, degrees)), [1.0; 3]);
    }
}
