//! The bootstrap: confidence from resampled groups of cases.

use crate::sweep::mixed;

/// Draws `groups` of `groups` with replacement, so many times: the draws follow from the seed alone,
/// so that studies with the same groups are resampled together.
pub(crate) fn resamples(groups: usize, times: u64, seed: u64) -> impl Iterator<Item = Vec<usize>> {
    (0..times).map(move |time| {
        let draw = |k: usize| (mixed(seed, time, k as u64) % groups.max(1) as u64) as usize;
        (0..groups).map(draw).collect()
    })
}

/// The ends of the middle `confidence` of a sample, by linear interpolation between its values;
/// `None` without values.
pub(crate) fn interval(mut sample: Vec<f64>, confidence: f64) -> Option<[f64; 2]> {
    sample.sort_by(f64::total_cmp);
    let quantile = |share: f64| {
        let place = share * (sample.len().checked_sub(1)?) as f64;
        let (below, part) = (place.floor() as usize, place.fract());
        let (low, high) = (*sample.get(below)?, *sample.get(below + 1).or(sample.get(below))?);
        Some(low + part * (high - low))
    };
    Some([quantile(0.5 * (1.0 - confidence))?, quantile(0.5 * (1.0 + confidence))?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_holds_the_middle_of_a_sample() {
        let sample: Vec<f64> = (0..=100).rev().map(f64::from).collect();
        let [low, high] = interval(sample, 0.9).unwrap();
        assert!((low - 5.0).abs() < 1e-12 && (high - 95.0).abs() < 1e-12, "0.05 rounds: {low} {high}");
        assert_eq!(interval(vec![3.0], 0.95), Some([3.0, 3.0]));
        assert_eq!(interval(Vec::new(), 0.95), None);
    }

    #[test]
    fn draws_have_the_variance_of_drawing_with_replacement() {
        // The mean of n draws from 0 … n−1 has the variance (n² − 1)/(12 n).
        let (n, times) = (50, 4000);
        let means: Vec<f64> = resamples(n, times, 3).map(|draw| draw.iter().sum::<usize>() as f64 / n as f64).collect();
        let mean = means.iter().sum::<f64>() / times as f64;
        let variance = means.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / times as f64;
        let expected = ((n * n - 1) as f64) / (12.0 * n as f64);
        // Five standard errors.
        assert!((mean - 24.5).abs() < 5.0 * (expected / times as f64).sqrt(), "{mean}");
        assert!((variance / expected - 1.0).abs() < 5.0 * (2.0 / times as f64).sqrt(), "{variance}");
    }
}
