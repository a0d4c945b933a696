//! The normal distribution.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// The probability that a standard normal number is at most `z`.
#[must_use]
pub fn normal_probability(z: f64) -> f64 {
    0.5 * libm::erfc(-z * FRAC_1_SQRT_2)
}

/// Below this, erfc underflows soon, and the asymptotic series of Mills' ratio is exact to rounding
/// after a few terms.
const FAR: f64 = -30.0;

/// Φ(z)|z|/φ(z) = 1 − 1/z² + 3/z⁴ − 15/z⁶ + …, far below 0; the first term left out is below 2e-14.
fn far_series(z: f64) -> f64 {
    let x = 1.0 / (z * z);
    1.0 - x * (1.0 - 3.0 * x * (1.0 - 5.0 * x * (1.0 - 7.0 * x * (1.0 - 9.0 * x))))
}

/// φ(z)/Φ(z), the derivative of ln Φ.
pub(super) fn hazard(z: f64) -> f64 {
    if z < FAR {
        return -z / far_series(z);
    }
    (-0.5 * z * z).exp() / (2.0 * PI).sqrt() / normal_probability(z)
}

/// ln Φ(z).
pub(super) fn log_probability(z: f64) -> f64 {
    if z < FAR {
        return -0.5 * z * z - (-z * (2.0 * PI).sqrt()).ln() + far_series(z).ln();
    }
    normal_probability(z).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_are_those_of_the_tables() {
        // scipy.stats.norm.cdf and logcdf.
        for (z, p) in [(0.0, 0.5), (1.0, 0.841_344_746_068_542_9), (-5.0, 2.866_515_718_791_933e-7)] {
            assert!((normal_probability(z) / p - 1.0).abs() < 1e-14, "{z}");
        }
        for (z, log) in
            [(-2.0, -3.783_184_333_682_032), (-40.0, -804.608_442_013_753_9), (-29.0, -424.787_419_909_730_26)]
        {
            assert!((log_probability(z) / log - 1.0).abs() < 1e-12, "{z}: {}", log_probability(z));
        }
    }

    #[test]
    fn both_branches_meet() {
        let (near, far) = (FAR + 1e-9, FAR - 1e-9);
        assert!((hazard(near) / hazard(far) - 1.0).abs() < 1e-7);
        assert!((log_probability(near) / log_probability(far) - 1.0).abs() < 1e-7);
    }
}
