//! Whether two samples come from one distribution.

/// The two-sample test of Kolmogorov and Smirnov.
///
/// The p-value is exact for samples without ties, by counting the ways in which they can interleave
/// (recurrence of J. Durbin, "Distribution theory for tests based on the sample distribution
/// function", SIAM 1973, doi 10.1137/1.9781611970586), and the limit for large samples where that
/// would take too long. With ties, such as values that are cut at a limit, it is on the safe side:
/// the true one is smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KolmogorovSmirnov {
    /// The largest distance between both distribution functions.
    pub distance: f64,
    /// The probability of so large a distance, or a larger one, for samples of one distribution.
    pub p_value: f64,
}

/// Products of sizes up to which the p-value is exact.
const MOST_PATHS: usize = 25_000_000;

impl KolmogorovSmirnov {
    /// Compares two samples of finite numbers; `None` if one is empty.
    ///
    /// ```
    /// use teeter_study::statistics::KolmogorovSmirnov;
    ///
    /// let test = KolmogorovSmirnov::of(&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0]).unwrap();
    /// assert_eq!(test.distance, 1.0);
    /// assert!((test.p_value - 0.1).abs() < 1e-15); // 2 of 20 ways to interleave
    /// ```
    #[must_use]
    pub fn of(a: &[f64], b: &[f64]) -> Option<Self> {
        if a.is_empty() || b.is_empty() {
            return None;
        }
        let sorted = |sample: &[f64]| {
            let mut sample = sample.to_vec();
            sample.sort_by(f64::total_cmp);
            sample
        };
        let (a, b) = (sorted(a), sorted(b));
        let apart = |x: &f64| (share_at_most(&a, *x) - share_at_most(&b, *x)).abs();
        let distance = a.iter().chain(&b).map(apart).fold(0.0, f64::max);
        let p_value = if a.len().saturating_mul(b.len()) <= MOST_PATHS {
            exact(distance, a.len(), b.len())
        } else {
            asymptotic(distance, a.len() as f64, b.len() as f64)
        };
        Some(Self { distance, p_value })
    }
}

/// The share of an ascending sample that is at most `x`: its distribution function.
#[must_use]
pub fn share_at_most(sorted: &[f64], x: f64) -> f64 {
    sorted.partition_point(|value| *value <= x) as f64 / sorted.len() as f64
}

/// The share of ways to interleave m and n values in which the distance reaches `distance`.
fn exact(distance: f64, m: usize, n: usize) -> f64 {
    let (rows, columns) = (m as f64, n as f64);
    // Distances are multiples of 1/(m n): half a multiple off, so that rounding doesn't decide.
    let limit = ((distance * rows * columns - 1e-7).floor() + 0.5) / (rows * columns);
    // Of the ways that lead to i values of one sample and j of the other, the share that has been
    // beyond the limit; the last value is of the one sample with probability i/(i + j). A sum of
    // positive terms: small shares keep their digits.
    let mut beyond = vec![0.0; n + 1];
    for i in 0..=m {
        for j in 0..=n {
            beyond[j] = match (i, j) {
                _ if (i as f64 / rows - j as f64 / columns).abs() > limit => 1.0,
                (0, 0) => 0.0,
                (0, _) => beyond[j - 1],
                (_, 0) => beyond[0],
                _ => (i as f64 * beyond[j] + j as f64 * beyond[j - 1]) / (i + j) as f64,
            };
        }
    }
    beyond[n]
}

/// Kolmogorov's limit 2 Σ (−1)^(k−1) exp(−2 k² λ²).
fn asymptotic(distance: f64, m: f64, n: f64) -> f64 {
    let lambda = distance * (m * n / (m + n)).sqrt();
    if lambda < 0.2 {
        return 1.0; // to 1e-12
    }
    let term = |k: i32| {
        let sign = if k % 2 == 1 { 1.0 } else { -1.0 };
        2.0 * sign * (-2.0 * f64::from(k * k) * lambda * lambda).exp()
    };
    (1..=100).map(term).sum::<f64>().clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_that_of_scipy() {
        // scipy.stats.ks_2samp(a, b, method = "exact")
        let a: Vec<f64> = (0..40).map(|k| (f64::from(k) * 0.7).sin() + 0.02 * f64::from(k)).collect();
        let b: Vec<f64> = (0..35).map(|k| (f64::from(k) * 1.3).cos() * 1.1 + 0.3).collect();
        let test = KolmogorovSmirnov::of(&a, &b).unwrap();
        assert!((test.distance - SCIPY[0]).abs() < 1e-14, "{test:?}");
        assert!((test.p_value - SCIPY[1]).abs() < 1e-12, "{test:?}");
    }

    #[test]
    fn the_limit_is_that_of_large_samples() {
        // scipy.special.kolmogorov(1.2)
        assert!((asymptotic(1.2, 2.0, 2.0) - 0.112_249_666_670_726_3).abs() < 1e-14);
        assert_eq!(asymptotic(0.1, 2.0, 2.0), 1.0);
        // For 2000 each the exact value is near.
        let (d, n) = (0.04, 2000);
        assert!((exact(d, n, n) - asymptotic(d, 2e3, 2e3)).abs() < 2e-3);
    }

    #[test]
    fn equal_samples_are_not_apart_and_empty_ones_are_no_samples() {
        let one = [1.0, 1.0, 2.0];
        assert_eq!(KolmogorovSmirnov::of(&one, &one), Some(KolmogorovSmirnov { distance: 0.0, p_value: 1.0 }));
        assert_eq!(KolmogorovSmirnov::of(&one, &[]), None);
    }

    const SCIPY: [f64; 2] = [0.185_714_285_714_285_72, 0.477_197_569_234_676_77];
}
