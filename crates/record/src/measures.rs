//! Intensity measures of a record: peaks, Arias intensity, significant duration. All are exact for
//! an acceleration linear between its values, with the motion starting at rest.

use crate::STANDARD_GRAVITY;
use crate::error::RecordError;
use crate::record::Record;

/// A largest magnitude and the time when it is first reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// The magnitude, never negative.
    pub size: f64,
    /// The time, s.
    pub time: f64,
}

impl Peak {
    const NONE: Self = Self { size: 0.0, time: 0.0 };

    fn include(&mut self, value: f64, time: f64) {
        if value.abs() > self.size {
            *self = Self { size: value.abs(), time };
        }
    }
}

/// One step of the motion: the acceleration a + s τ, with velocity and displacement at its
/// beginning.
#[derive(Clone, Copy)]
struct LinearSegment {
    begin: f64,
    h: f64,
    a: f64,
    slope: f64,
    v: f64,
    d: f64,
}

impl LinearSegment {
    fn velocity(&self, tau: f64) -> f64 {
        self.v + tau * (self.a + 0.5 * self.slope * tau)
    }

    fn displacement(&self, tau: f64) -> f64 {
        self.d + tau * (self.v + tau * (0.5 * self.a + self.slope * tau / 6.0))
    }

    /// ∫ a² from the beginning to τ.
    fn squares(&self, tau: f64) -> f64 {
        tau * (self.a * self.a + tau * self.slope * (self.a + self.slope * tau / 3.0))
    }

    /// The zeros of the velocity within the step: up to two roots of a quadratic.
    fn stops(&self) -> [Option<f64>; 2] {
        let within = |tau: f64| (tau > 0.0 && tau < self.h).then_some(tau);
        let discriminant = self.a * self.a - 2.0 * self.slope * self.v;
        if !(discriminant >= 0.0) {
            return [None, None];
        }
        // The form without cancellation: roots 2c/q and q/slope.
        let q = -(self.a + discriminant.sqrt().copysign(self.a));
        [within(2.0 * self.v / q), within(q / self.slope)]
    }
}

/// A number that says how strong a record is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum IntensityMeasure {
    /// The peak ground acceleration, m/s².
    PeakAcceleration,
    /// The peak ground velocity, m/s.
    PeakVelocity,
    /// The Arias intensity, m/s.
    Arias,
    /// The pseudo-acceleration of the response spectrum for 5 % damping, m/s².
    SpectralAcceleration {
        /// The natural period, s.
        period: f64,
    },
}

/// Damping ratio of a spectral acceleration.
const DAMPING_RATIO: f64 = 0.05;

impl IntensityMeasure {
    /// Its name in messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::PeakAcceleration => "the peak acceleration",
            Self::PeakVelocity => "the peak velocity",
            Self::Arias => "the Arias intensity",
            Self::SpectralAcceleration { .. } => "the spectral acceleration",
        }
    }
}

impl Record {
    /// Peak ground acceleration, m/s².
    #[must_use]
    pub fn peak_acceleration(&self) -> f64 {
        self.accelerations().iter().fold(0.0, |most: f64, a| most.max(a.abs()))
    }

    /// Peak ground acceleration, m/s², with its time.
    #[must_use]
    pub fn acceleration_peak(&self) -> Peak {
        let mut peak = Peak::NONE;
        self.accelerations().iter().enumerate().for_each(|(k, a)| peak.include(*a, self.time(k)));
        peak
    }

    /// Peak ground velocity, m/s: the largest magnitude of the integral of the acceleration from
    /// rest, between the values too.
    #[must_use]
    pub fn velocity_peak(&self) -> Peak {
        let mut peak = Peak::NONE;
        for segment in self.segments() {
            let turn = -segment.a / segment.slope;
            for tau in [turn, segment.h].into_iter().filter(|tau| *tau > 0.0 && *tau <= segment.h) {
                peak.include(segment.velocity(tau), segment.begin + tau);
            }
        }
        peak
    }

    /// Peak ground displacement, m: the largest magnitude of the second integral of the
    /// acceleration from rest, between the values too.
    #[must_use]
    pub fn displacement_peak(&self) -> Peak {
        let mut peak = Peak::NONE;
        for segment in self.segments() {
            for tau in segment.stops().into_iter().flatten().chain([segment.h]) {
                peak.include(segment.displacement(tau), segment.begin + tau);
            }
        }
        peak
    }

    /// Velocity (m/s) and displacement (m) at the times of the values, from rest.
    #[must_use]
    pub fn motion(&self) -> (Vec<f64>, Vec<f64>) {
        let ends = self.segments().map(|segment| (segment.velocity(segment.h), segment.displacement(segment.h)));
        std::iter::once((0.0, 0.0)).chain(ends).unzip()
    }

    /// Velocity (m/s) and displacement (m) at the time of the last value, from rest.
    #[must_use]
    pub fn at_the_end(&self) -> [f64; 2] {
        self.segments().last().map_or([0.0; 2], |last| [last.velocity(last.h), last.displacement(last.h)])
    }

    /// Arias intensity π/(2g) ∫ a² dt, m/s, g being [`STANDARD_GRAVITY`] (A. Arias, "A measure of
    /// earthquake intensity", in Seismic Design for Nuclear Power Plants, MIT Press 1970). The
    /// integral is exact for the linear segments, h (a₀² + a₀a₁ + a₁²)/3 each.
    #[must_use]
    pub fn arias_intensity(&self) -> f64 {
        self.segments().map(|segment| segment.squares(segment.h)).sum::<f64>() * std::f64::consts::PI
            / (2.0 * STANDARD_GRAVITY)
    }

    /// The Arias intensity by the plain sum π/(2g) Δt Σ a² over all values, m/s, as many tables of
    /// records have it. It counts jumps between values in full, where the lines between them reach
    /// the same height for an instant only: [`Record::arias_intensity`] is at most this.
    #[must_use]
    pub fn arias_sum(&self) -> f64 {
        let squares: f64 = self.accelerations().iter().map(|a| a * a).sum();
        std::f64::consts::PI / (2.0 * STANDARD_GRAVITY) * self.dt() * squares
    }

    /// An intensity measure of the record, m/s² or m/s.
    ///
    /// # Errors
    /// As [`Record::spectrum`], for a spectral acceleration.
    pub fn intensity(&self, measure: IntensityMeasure) -> Result<f64, RecordError> {
        Ok(match measure {
            IntensityMeasure::PeakAcceleration => self.peak_acceleration(),
            IntensityMeasure::PeakVelocity => self.velocity_peak().size,
            IntensityMeasure::Arias => self.arias_intensity(),
            IntensityMeasure::SpectralAcceleration { period } => {
                let responses = self.spectrum(DAMPING_RATIO, &[period])?;
                responses.first().map_or(0.0, crate::Response::pseudo_acceleration)
            }
        })
    }

    /// The times when the Arias intensity reaches two fractions of its total, s: `[0.05, 0.95]` are
    /// the ends of the significant duration (M. D. Trifunac, A. G. Brady 1975). Within a step the
    /// intensity is a cubic, which is solved.
    ///
    /// # Errors
    /// If the fractions don't ascend within [0, 1], or the record is 0 throughout.
    pub fn husid_times(&self, parts: [f64; 2]) -> Result<[f64; 2], RecordError> {
        let [first, second] = parts;
        if !(first >= 0.0 && first < second && second <= 1.0) {
            let range = "in [0, 1] and below the second fraction";
            return Err(RecordError::Parameter { what: "the fraction of the intensity", value: first, range });
        }
        let whole: f64 = self.segments().map(|segment| segment.squares(segment.h)).sum();
        if whole == 0.0 {
            return Err(RecordError::Still);
        }
        Ok(parts.map(|part| self.time_of(part * whole)))
    }

    /// Significant duration from 5 % to 95 % of the Arias intensity, s; 0 for a record that is 0
    /// throughout.
    #[must_use]
    pub fn significant_duration(&self) -> f64 {
        self.husid_times([0.05, 0.95]).map_or(0.0, |[begin, end]| end - begin)
    }

    /// The time when ∫ a² reaches a value.
    fn time_of(&self, squares: f64) -> f64 {
        let mut sum = 0.0;
        for segment in self.segments() {
            let whole = segment.squares(segment.h);
            if sum + whole >= squares {
                let (mut low, mut high) = (0.0, segment.h);
                // Bisection, as ∫ a² doesn't decrease. 53 halvings reach the last bit.
                for _ in 0..53 {
                    let middle = 0.5 * (low + high);
                    if sum + segment.squares(middle) < squares { low = middle } else { high = middle }
                }
                return segment.begin + high;
            }
            sum += whole;
        }
        self.duration()
    }

    fn segments(&self) -> impl Iterator<Item = LinearSegment> + '_ {
        let h = self.dt();
        let (mut v, mut d) = (0.0, 0.0);
        self.accelerations().windows(2).enumerate().map(move |(k, a)| {
            let segment = LinearSegment { begin: self.time(k), h, a: a[0], slope: (a[1] - a[0]) / h, v, d };
            (v, d) = (v + 0.5 * h * (a[0] + a[1]), d + h * (v + h * (2.0 * a[0] + a[1]) / 6.0));
            segment
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn constant_acceleration_matches_closed_form() {
        let (a, dt, n) = (2.0, 0.01, 301_u32);
        let one = Record::new("R", dt, vec![a; n as usize]).unwrap();
        let t = dt * f64::from(n - 1);
        let near = |x: f64, y: f64| (x - y).abs() <= 1e-13 * y;
        assert!(near(one.arias_intensity(), PI / (2.0 * STANDARD_GRAVITY) * a * a * t));
        assert!(near(one.velocity_peak().size, a * t) && near(one.displacement_peak().size, 0.5 * a * t * t));
        assert!(near(one.significant_duration(), 0.9 * t));
        assert_eq!(one.acceleration_peak(), Peak { size: 2.0, time: 0.0 });
    }

    #[test]
    fn peaks_between_the_values_are_found() {
        // a = 1 - t over [0, 3]: v = t - t²/2 is largest at 1, 0 at 2; d = t²/2 - t³/6 at 2 is 2/3,
        // at 3 it is 0.
        let one = Record::new("R", 3.0, vec![1.0, -2.0]).unwrap();
        let (v, d) = (one.velocity_peak(), one.displacement_peak());
        assert!((v.size - 1.5).abs() < 1e-15 && v.time == 3.0, "{v:?}");
        assert!((d.size - 2.0 / 3.0).abs() < 1e-15 && (d.time - 2.0).abs() < 1e-15, "{d:?}");
        let (v, d) = (one.cut(0.0, 3.0).unwrap().scaled(-1.0).unwrap().motion().0, one.motion().1);
        assert!(v[1] == 1.5 && d[1].abs() < 1e-15);
        // Segments without slope and without acceleration: no division by zero.
        let flat = Record::new("R", 1.0, vec![0.0, 0.0, 1.0, 1.0, 0.0]).unwrap();
        assert_eq!(flat.velocity_peak(), Peak { size: 2.0, time: 4.0 });
    }

    #[test]
    fn intensity_of_a_ramp_matches_closed_form() {
        // a = t on [0, 1]: ∫a² = t³/3, so the fraction p is reached at its cube root, for any step.
        for n in [2_usize, 11] {
            let dt = 1.0 / (n - 1) as f64;
            let one = Record::new("R", dt, (0..n).map(|k| k as f64 * dt).collect()).unwrap();
            assert!((one.arias_intensity() - PI / (6.0 * STANDARD_GRAVITY)).abs() < 1e-15);
            let [begin, end] = one.husid_times([0.05, 0.95]).unwrap();
            assert!((begin - 0.05_f64.cbrt()).abs() < 1e-14 && (end - 0.95_f64.cbrt()).abs() < 1e-14);
        }
        let still = Record::new("R", 1.0, vec![0.0; 3]).unwrap();
        assert_eq!((still.arias_intensity(), still.significant_duration()), (0.0, 0.0));
        assert!(still.husid_times([0.9, 0.1]).unwrap_err().to_string().contains("below the second fraction"));
    }
}
