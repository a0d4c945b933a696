//! Values and rates of sampled data by local parabolas.

use std::ops::Range;

/// Least number of rows of a window: a parabola needs three.
pub const LEAST_WINDOW: usize = 3;

/// Smoothed values and their rates, at the times of the samples.
#[derive(Clone, Debug, PartialEq)]
pub struct LocalFit {
    /// The values; NaN where there is no sample.
    pub value: Vec<f64>,
    /// Their rates, per second.
    pub rate: Vec<f64>,
    /// Standard deviation of the samples about their parabolas, corrected for the three unknowns:
    /// their noise, if the motion is smooth over a window; without the windows in which all values are
    /// equal. 0 if a window has three rows.
    pub noise: f64,
    /// The rows of the window; 1 if nothing was smoothed.
    pub window: usize,
    /// The samples from the first to the last with a complete window around them. At the ends, where the
    /// window reaches to one side only, a rate has several times the error of the others.
    pub complete: Range<usize>,
}

/// Fits a parabola by least squares through `window` samples around each sample (Savitzky and Golay
/// 1964, doi 10.1021/ac60214a047, for times that may be uneven). NaN in `y` is a missing sample. At
/// both ends the window is that of the nearest complete one.
#[must_use]
pub fn local_fit(t: &[f64], y: &[f64], window: usize) -> LocalFit {
    let present: Vec<usize> = (0..t.len()).filter(|&k| y[k].is_finite()).collect();
    let window = window.max(LEAST_WINDOW).min(present.len());
    let unknown = vec![f64::NAN; t.len()];
    let mut fit = LocalFit { value: unknown.clone(), rate: unknown, noise: 0.0, window, complete: 0..0 };
    if window < LEAST_WINDOW {
        return fit;
    }
    fit.complete = present[window / 2]..present[present.len() - window.div_ceil(2)] + 1;
    let mut squares = Vec::new();
    for (place, &k) in present.iter().enumerate() {
        let first = place.saturating_sub(window / 2).min(present.len() - window);
        let rows = &present[first..first + window];
        let Some([a, b, c]) = parabola(rows.iter().map(|&row| (t[row] - t[k], y[row]))) else { continue };
        (fit.value[k], fit.rate[k]) = (a, b);
        let off = |row: &usize| {
            let s = t[*row] - t[k];
            y[*row] - (a + s * (b + s * c))
        };
        // Where no value differs from the next, the motion is at rest and its noise below the rounding of
        // the table: that says nothing of the noise elsewhere.
        let rests = rows.iter().all(|&row| y[row] == y[rows[0]]);
        if window > LEAST_WINDOW && !rests {
            let sum: f64 = rows.iter().map(|row| off(row).powi(2)).sum();
            squares.push(sum / (window - LEAST_WINDOW) as f64);
        }
    }
    // The median, as windows across an impact are off by more than noise; corrected to the mean for a
    // χ² of so many degrees of freedom (Wilson and Hilferty).
    squares.sort_by(f64::total_cmp);
    if let Some(median) = squares.get(squares.len() / 2) {
        let degrees = (window - LEAST_WINDOW) as f64;
        fit.noise = (median / (1.0 - 2.0 / (9.0 * degrees)).powi(3)).sqrt();
    }
    fit
}

/// The least-squares parabola a + b s + c s² through points (s, y).
pub(crate) fn parabola(points: impl Iterator<Item = (f64, f64)> + Clone) -> Option<[f64; 3]> {
    let scale = points.clone().map(|(s, _)| s.abs()).fold(0.0, f64::max);
    if !(scale > 0.0) {
        return None;
    }
    let mut a = [[0.0; 4]; 3];
    for (s, y) in points {
        let powers = [1.0, s / scale, (s / scale).powi(2)];
        for i in 0..3 {
            for j in 0..3 {
                a[i][j] += powers[i] * powers[j];
            }
            a[i][3] += powers[i] * y;
        }
    }
    // Elimination without pivots: the matrix is positive definite for three different times.
    for i in 0..3 {
        if !(a[i][i].abs() > 1e-12) {
            return None;
        }
        for j in i + 1..3 {
            let factor = a[j][i] / a[i][i];
            for k in i..4 {
                a[j][k] -= factor * a[i][k];
            }
        }
    }
    let c = a[2][3] / a[2][2];
    let b = (a[1][3] - a[1][2] * c) / a[1][1];
    let value = (a[0][3] - a[0][1] * b - a[0][2] * c) / a[0][0];
    Some([value, b / scale, c / (scale * scale)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_fitted_exactly_at_uneven_times_and_across_gaps() {
        let t: Vec<f64> = (0..40).map(|k| 0.006 * f64::from(k) + 0.002 * f64::from(k % 3)).collect();
        let mut y: Vec<f64> = t.iter().map(|t| 1.0 - 3.0 * t + 5.0 * t * t).collect();
        y[7] = f64::NAN;
        for window in [3, 5, 9] {
            let fit = local_fit(&t, &y, window);
            for k in (0..40).filter(|&k| k != 7) {
                assert!((fit.value[k] - y[k]).abs() < 1e-12 && (fit.rate[k] - (10.0 * t[k] - 3.0)).abs() < 1e-9);
            }
            assert!(fit.value[7].is_nan() && fit.noise < 1e-12);
        }
    }

    #[test]
    fn noise_is_estimated() {
        // A sum of twelve uniform numbers is nearly normal.
        let mut seed = 1_u64;
        let mut uniform = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let t: Vec<f64> = (0..4000).map(|k| f64::from(k) / 165.0).collect();
        let y: Vec<f64> = t.iter().map(|t| t.sin() + 0.01 * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0)).collect();
        for window in [5, 7, 11] {
            let noise = local_fit(&t, &y, window).noise;
            assert!((noise / 0.01 - 1.0).abs() < 0.08, "window {window}: {noise}");
        }
    }
}
