//! Corrections, each of which returns a new record.

use std::f64::consts::PI;

use crate::error::RecordError;
use crate::measures::IntensityMeasure;
use crate::record::Record;

/// Highest degree of a baseline.
const HIGHEST_DEGREE: usize = 5;

impl Record {
    /// Multiplies all accelerations by a factor, which may be negative or 0.
    ///
    /// # Errors
    /// If the factor isn't finite, or an acceleration becomes larger than
    /// [`LARGEST_ACCELERATION`](crate::LARGEST_ACCELERATION).
    pub fn scaled(&self, factor: f64) -> Result<Self, RecordError> {
        if !factor.is_finite() {
            return Err(RecordError::Parameter { what: "the factor", value: factor, range: "finite" });
        }
        self.with(self.accelerations().iter().map(|a| factor * a).collect())
    }

    /// Scales to a peak acceleration, m/s², keeping the signs.
    ///
    /// # Errors
    /// If the peak isn't positive and finite, or if the record is 0 throughout.
    pub fn scaled_to_peak(&self, peak: f64) -> Result<Self, RecordError> {
        if !(peak > 0.0 && peak.is_finite()) {
            let range = "positive and finite";
            return Err(RecordError::Parameter { what: "the peak acceleration", value: peak, range });
        }
        let most = self.peak_acceleration();
        if most == 0.0 {
            return Err(RecordError::Still);
        }
        // Dividing first makes the largest value exactly the peak.
        self.with(self.accelerations().iter().map(|a| a / most * peak).collect())
    }

    /// The record times the positive factor that gives an intensity measure this value: m/s² for
    /// accelerations, m/s for the peak velocity and the Arias intensity. Of the record as it is, so
    /// after other corrections.
    ///
    /// # Errors
    /// If the value isn't positive and finite, the acceleration is 0 throughout, or the period of a
    /// spectral acceleration is out of the range of [`Record::spectrum`].
    pub fn scaled_to(&self, measure: IntensityMeasure, value: f64) -> Result<Self, RecordError> {
        if !(value > 0.0 && value.is_finite()) {
            let range = "positive and finite";
            return Err(RecordError::Parameter { what: measure.name(), value, range });
        }
        if let IntensityMeasure::PeakAcceleration = measure {
            return self.scaled_to_peak(value);
        }
        if self.peak_acceleration() == 0.0 {
            return Err(RecordError::Still);
        }
        let own = self.intensity(measure)?;
        // Arias' grows with the square of the acceleration.
        let factor = if let IntensityMeasure::Arias = measure { (value / own).sqrt() } else { value / own };
        self.scaled(factor)
    }

    /// The values with times in [`from`, `to`], s; the new record starts at time 0. The ends have a
    /// tolerance of a millionth of the step.
    ///
    /// # Errors
    /// If fewer than two values are left, or a time is NaN (an infinite time means no cut).
    pub fn cut(&self, from: f64, to: f64) -> Result<Self, RecordError> {
        let nothing = || RecordError::Cut { from, to, duration: self.duration() };
        let (first, last) = ((from / self.dt() - 1e-6).ceil().max(0.0), (to / self.dt() + 1e-6).floor());
        let last = last.min((self.len() - 1) as f64);
        if !(first < last) || from.is_nan() || to.is_nan() {
            return Err(nothing());
        }
        let kept = self.accelerations().get(first as usize..=last as usize).ok_or_else(nothing)?;
        self.with(kept.to_vec())
    }

    /// Tapers both ends by half a cosine (a Tukey window): at the time τ < `fraction`·T from either
    /// end, T being the duration, the acceleration is multiplied by (1 − cos(π τ/(fraction·T)))/2.
    /// With a `fraction` of 0 the record is unchanged, with 0.5 the tapers meet.
    ///
    /// # Errors
    /// If the fraction isn't in [0, 0.5].
    pub fn tapered(&self, fraction: f64) -> Result<Self, RecordError> {
        if !(0.0..=0.5).contains(&fraction) {
            let range = "in [0, 0.5] (as a fraction of the duration, at each end)";
            return Err(RecordError::Parameter { what: "the taper", value: fraction, range });
        }
        let (last, fade) = (self.len() - 1, fraction * self.duration());
        let window = |k: usize| {
            let tau = self.time(k.min(last - k));
            if tau < fade { 0.5 * (1.0 - (PI * tau / fade).cos()) } else { 1.0 }
        };
        self.with(self.accelerations().iter().enumerate().map(|(k, a)| a * window(k)).collect())
    }

    /// Corrects the baseline: subtracts from the acceleration its least-squares polynomial p of a
    /// degree up to `degree` (0 to 5), which minimises Σₖ (aₖ − p(tₖ))² with equal weights.
    /// Velocity and displacement aren't fitted, and nothing is forced to zero at the ends. The fit
    /// uses Legendre polynomials of x = 2t/T − 1, T being the duration, so that it is as accurate
    /// as the values.
    ///
    /// # Errors
    /// If the degree is over 5, or the record has at most `degree` + 1 values.
    pub fn baseline_corrected(&self, degree: usize) -> Result<Self, RecordError> {
        if degree > HIGHEST_DEGREE {
            let (value, range) = (degree as f64, "a whole number from 0 to 5");
            return Err(RecordError::Parameter { what: "the degree of the baseline", value, range });
        }
        if self.len() <= degree + 1 {
            let (value, range) = (degree as f64, "less than the number of values minus 1");
            return Err(RecordError::Parameter { what: "the degree of the baseline", value, range });
        }
        let mut accelerations = self.accelerations().to_vec();
        // The second pass removes what rounding leaves of a large baseline.
        for _ in 0..2 {
            subtract_fit(&mut accelerations, degree);
        }
        self.with(accelerations)
    }
}

/// Subtracts the least-squares polynomial.
fn subtract_fit(values: &mut [f64], degree: usize) {
    let last = (values.len() - 1) as f64;
    let basis = |k: usize| legendre(2.0 * (k as f64 / last) - 1.0);
    let mut matrix = [[0.0; HIGHEST_DEGREE + 1]; HIGHEST_DEGREE + 1];
    let mut side = [0.0; HIGHEST_DEGREE + 1];
    for (k, value) in values.iter().enumerate() {
        let p = basis(k);
        for i in 0..=degree {
            side[i] += p[i] * value;
            for j in 0..=i {
                matrix[i][j] += p[i] * p[j];
            }
        }
    }
    solve(&mut matrix, &mut side, degree + 1);
    for (k, value) in values.iter_mut().enumerate() {
        *value -= basis(k).iter().zip(side).take(degree + 1).map(|(p, c)| p * c).sum::<f64>();
    }
}

/// P₀(x) to P₅(x), by Bonnet's recursion.
fn legendre(x: f64) -> [f64; HIGHEST_DEGREE + 1] {
    let mut p = [1.0; HIGHEST_DEGREE + 1];
    p[1] = x;
    for n in 1..HIGHEST_DEGREE {
        let m = n as f64;
        p[n + 1] = ((2.0 * m + 1.0) * x * p[n] - m * p[n - 1]) / (m + 1.0);
    }
    p
}

/// Solves a symmetric positive definite system, given by its lower triangle, by Cholesky
/// factorisation.
fn solve(a: &mut [[f64; HIGHEST_DEGREE + 1]; HIGHEST_DEGREE + 1], b: &mut [f64; HIGHEST_DEGREE + 1], n: usize) {
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = a[i][j] - (0..j).map(|k| a[i][k] * a[j][k]).sum::<f64>();
            a[i][j] = if i == j { sum.sqrt() } else { sum / a[j][j] };
        }
        b[i] = (b[i] - (0..i).map(|k| a[i][k] * b[k]).sum::<f64>()) / a[i][i];
    }
    for i in (0..n).rev() {
        b[i] = (b[i] - (i + 1..n).map(|k| a[k][i] * b[k]).sum::<f64>()) / a[i][i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(values: impl IntoIterator<Item = f64>) -> Record {
        Record::new("R", 0.01, values.into_iter().collect()).unwrap()
    }

    #[test]
    fn scaling_reaches_the_peak_exactly() {
        let one = record([0.1, -0.7, 0.3]);
        assert_eq!(one.scaled(-2.0).unwrap().accelerations(), [-0.2, 1.4, -0.6]);
        let to = one.scaled_to_peak(3.0).unwrap();
        assert_eq!((to.peak_acceleration(), to.accelerations()[1]), (3.0, -3.0));
        let message = |error: RecordError| error.to_string();
        assert_eq!(message(one.scaled(f64::NAN).unwrap_err()), "the factor is NaN, but must be finite");
        assert_eq!(
            message(one.scaled_to_peak(-1.0).unwrap_err()),
            "the peak acceleration is -1, but must be positive and finite"
        );
        assert_eq!(
            message(record([0.0, 0.0]).scaled_to_peak(1.0).unwrap_err()),
            "the acceleration is 0 throughout: it can't be scaled to a peak"
        );
        assert!(message(one.scaled(1e300).unwrap_err()).contains("at most 1e12 m/s^2"));
    }

    #[test]
    fn scaling_reaches_every_intensity_measure() {
        let one = record((0..800).map(|k| (0.11 * f64::from(k)).sin() * (-0.004 * f64::from(k)).exp()));
        let spectral = IntensityMeasure::SpectralAcceleration { period: 0.5 };
        use IntensityMeasure::{Arias, PeakAcceleration, PeakVelocity};
        for (measure, value) in [(PeakAcceleration, 3.0), (PeakVelocity, 0.4), (Arias, 1.5), (spectral, 7.0)] {
            let scaled = one.scaled_to(measure, value).unwrap();
            let got = scaled.intensity(measure).unwrap();
            // The factor rounds, and so does the sum of 800 squares.
            assert!((got / value - 1.0).abs() < 1e-13, "{measure:?}: {got}");
            assert!(scaled.accelerations()[5] > 0.0, "signs are kept");
            assert_eq!(record([0.0, 0.0]).scaled_to(measure, 1.0), Err(RecordError::Still));
            assert!(one.scaled_to(measure, 0.0).is_err() && one.scaled_to(measure, f64::NAN).is_err());
        }
        assert!(one.scaled_to(IntensityMeasure::SpectralAcceleration { period: 0.0 }, 1.0).is_err());
    }

    #[test]
    fn a_cut_includes_both_ends() {
        let whole = record((0..=100).map(f64::from));
        let part = whole.cut(0.07, 0.57).unwrap();
        assert_eq!((part.len(), part.accelerations()[0], part.accelerations()[50]), (51, 7.0, 57.0));
        assert_eq!(whole.cut(-1.0, 9.0).unwrap(), whole);
        assert_eq!(whole.cut(f64::NEG_INFINITY, f64::INFINITY).unwrap(), whole);
        assert_eq!(
            whole.cut(0.5, 0.505).unwrap_err().to_string(),
            "from 0.5 s to 0.505 s there are fewer than two values; the record covers 0 s to 1 s"
        );
        for (from, to) in [(0.6, 0.5), (2.0, 3.0), (f64::NAN, 1.0), (0.0, f64::NAN), (-2.0, -1.0)] {
            assert!(whole.cut(from, to).is_err(), "{from} {to}");
        }
    }

    #[test]
    fn a_taper_is_half_a_cosine_at_each_end() {
        let one = record([1.0; 101]);
        let faded = one.tapered(0.2).unwrap();
        let a = faded.accelerations();
        assert_eq!((a[0], a[20], a[50], a[80], a[100]), (0.0, 1.0, 1.0, 1.0, 0.0));
        assert!((a[10] - 0.5).abs() < 1e-15 && (a[5] - 0.5 * (1.0 - (PI / 4.0).cos())).abs() < 1e-15);
        assert!((0..=50).all(|k| a[k] == a[100 - k]));
        assert_eq!(one.tapered(0.0).unwrap(), one);
        assert_eq!(
            one.tapered(0.6).unwrap_err().to_string(),
            "the taper is 0.6, but must be in [0, 0.5] (as a fraction of the duration, at each end)"
        );
    }

    #[test]
    fn a_polynomial_is_removed_completely() {
        let polynomial = |x: f64| 3.0 + x * (-2.0 + x * (0.5 + x * (4.0 + x * (-6.0 + x * 5.0))));
        let one = record((0..=2000).map(|k| polynomial(f64::from(k) / 2000.0)));
        let left = one.baseline_corrected(5).unwrap().peak_acceleration();
        // Of values up to 4.5 m/s², 2000 of them.
        assert!(left < 1e-12, "{left:e}");
        assert!(one.baseline_corrected(4).unwrap().peak_acceleration() > 1e-3);
    }

    #[test]
    fn the_residual_is_orthogonal_to_polynomials() {
        // Noise of a linear congruential generator on a parabola.
        let mut seed = 1_u32;
        let mut noise = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed) / f64::from(u32::MAX) - 0.5
        };
        let one = record((0..501).map(|k| noise() + 1e-5 * f64::from(k * k)));
        for degree in 0..=5_usize {
            let left = one.baseline_corrected(degree).unwrap();
            for power in 0..=degree {
                let moment = |(k, a): (usize, &f64)| (k as f64 / 500.0).powi(power as i32) * a;
                let sum: f64 = left.accelerations().iter().enumerate().map(moment).sum();
                assert!(sum.abs() < 1e-12, "degree {degree}, power {power}: {sum:e}");
            }
        }
        assert_eq!(
            one.baseline_corrected(6).unwrap_err().to_string(),
            "the degree of the baseline is 6, but must be a whole number from 0 to 5"
        );
        assert!(
            record([1.0, 2.0])
                .baseline_corrected(1)
                .unwrap_err()
                .to_string()
                .contains("less than the number of values")
        );
        assert!(record([1.0, 2.0]).baseline_corrected(0).is_ok());
    }
}
