//! What is read off a record: peaks, Arias intensity, significant duration. All of it holds for the
//! acceleration that is linear between its values, from rest at the first one.

use crate::STANDARD_GRAVITY;
use crate::error::RecordError;
use crate::record::Record;

/// A largest size, and when it is reached first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// The size, never negative.
    pub size: f64,
    /// When, s.
    pub time: f64,
}

impl Peak {
    const NONE: Self = Self { size: 0.0, time: 0.0 };

    fn see(&mut self, value: f64, time: f64) {
        if value.abs() > self.size {
            *self = Self { size: value.abs(), time };
        }
    }
}

/// One step of the motion: the acceleration a + s τ, with velocity and displacement where it
/// begins.
#[derive(Clone, Copy)]
struct Piece {
    begin: f64,
    h: f64,
    a: f64,
    slope: f64,
    v: f64,
    d: f64,
}

impl Piece {
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

    /// Where the velocity is 0 within the step: the roots of a quadratic, up to two.
    fn stops(&self) -> [Option<f64>; 2] {
        let within = |tau: f64| (tau > 0.0 && tau < self.h).then_some(tau);
        let discriminant = self.a * self.a - 2.0 * self.slope * self.v;
        if !(discriminant >= 0.0) {
            return [None, None];
        }
        // The form without cancellation: q, then 2c/q and q/slope.
        let q = -(self.a + discriminant.sqrt().copysign(self.a));
        [within(2.0 * self.v / q), within(q / self.slope)]
    }
}

impl Record {
    /// Peak ground acceleration, m/s².
    #[must_use]
    pub fn peak_acceleration(&self) -> f64 {
        self.accelerations().iter().fold(0.0, |most: f64, a| most.max(a.abs()))
    }

    /// Peak ground acceleration, m/s², and when it is reached.
    #[must_use]
    pub fn acceleration_peak(&self) -> Peak {
        let mut peak = Peak::NONE;
        self.accelerations().iter().enumerate().for_each(|(k, a)| peak.see(*a, self.time(k)));
        peak
    }

    /// Peak ground velocity, m/s: the largest size of the integral of the acceleration from rest,
    /// between the values too.
    #[must_use]
    pub fn velocity_peak(&self) -> Peak {
        let mut peak = Peak::NONE;
        for piece in self.pieces() {
            let turn = -piece.a / piece.slope;
            for tau in [turn, piece.h].into_iter().filter(|tau| *tau > 0.0 && *tau <= piece.h) {
                peak.see(piece.velocity(tau), piece.begin + tau);
            }
        }
        peak
    }

    /// Peak ground displacement, m: the largest size of the second integral of the acceleration
    /// from rest, between the values too.
    #[must_use]
    pub fn displacement_peak(&self) -> Peak {
        let mut peak = Peak::NONE;
        for piece in self.pieces() {
            for tau in piece.stops().into_iter().flatten().chain([piece.h]) {
                peak.see(piece.displacement(tau), piece.begin + tau);
            }
        }
        peak
    }

    /// Velocity (m/s) and displacement (m) at each value's time, from rest.
    #[must_use]
    pub fn motion(&self) -> (Vec<f64>, Vec<f64>) {
        let ends = self.pieces().map(|piece| (piece.velocity(piece.h), piece.displacement(piece.h)));
        std::iter::once((0.0, 0.0)).chain(ends).unzip()
    }

    /// Arias intensity π/(2g) ∫ a² dt, m/s, g being [`STANDARD_GRAVITY`] (A. Arias, "A measure of
    /// earthquake intensity", in Seismic Design for Nuclear Power Plants, MIT Press 1970). The
    /// integral is that of the linear pieces, h (a₀² + a₀a₁ + a₁²)/3 each, not the sum of the
    /// values' squares.
    #[must_use]
    pub fn arias_intensity(&self) -> f64 {
        self.pieces().map(|piece| piece.squares(piece.h)).sum::<f64>() * std::f64::consts::PI / (2.0 * STANDARD_GRAVITY)
    }

    /// When the Arias intensity reaches two parts of the whole, s: `[0.05, 0.95]` are the ends of
    /// the significant duration (M. D. Trifunac, A. G. Brady 1975). Within a step the cubic that
    /// the intensity is there is solved.
    ///
    /// # Errors
    /// If the parts don't rise within [0, 1], or the record is 0 throughout.
    pub fn husid_times(&self, parts: [f64; 2]) -> Result<[f64; 2], RecordError> {
        let [first, second] = parts;
        if !(first >= 0.0 && first < second && second <= 1.0) {
            let range = "in [0, 1], the first part below the second";
            return Err(RecordError::Parameter { what: "the part of the intensity", value: first, range });
        }
        let whole: f64 = self.pieces().map(|piece| piece.squares(piece.h)).sum();
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

    /// When ∫ a² reaches a value.
    fn time_of(&self, squares: f64) -> f64 {
        let mut sum = 0.0;
        for piece in self.pieces() {
            let whole = piece.squares(piece.h);
            if sum + whole >= squares {
                let (mut low, mut high) = (0.0, piece.h);
                // Bisection: the integral of a square doesn't fall. 53 halvings reach the last bit.
                for _ in 0..53 {
                    let middle = 0.5 * (low + high);
                    if sum + piece.squares(middle) < squares { low = middle } else { high = middle }
                }
                return piece.begin + high;
            }
            sum += whole;
        }
        self.duration()
    }

    fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        let h = self.dt();
        let (mut v, mut d) = (0.0, 0.0);
        self.accelerations().windows(2).enumerate().map(move |(k, a)| {
            let piece = Piece { begin: self.time(k), h, a: a[0], slope: (a[1] - a[0]) / h, v, d };
            (v, d) = (v + 0.5 * h * (a[0] + a[1]), d + h * (v + h * (2.0 * a[0] + a[1]) / 6.0));
            piece
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_constant_acceleration_has_its_closed_form() {
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
        // Without a slope, and with none of an acceleration: nothing to divide by.
        let flat = Record::new("R", 1.0, vec![0.0, 0.0, 1.0, 1.0, 0.0]).unwrap();
        assert_eq!(flat.velocity_peak(), Peak { size: 2.0, time: 4.0 });
    }

    #[test]
    fn the_intensity_of_a_ramp_is_that_of_a_cube() {
        // a = t on [0, 1]: ∫a² = t³/3, so a part p is reached at its cube root, whatever the step.
        for n in [2_usize, 11] {
            let dt = 1.0 / (n - 1) as f64;
            let one = Record::new("R", dt, (0..n).map(|k| k as f64 * dt).collect()).unwrap();
            assert!((one.arias_intensity() - PI / (6.0 * STANDARD_GRAVITY)).abs() < 1e-15);
            let [begin, end] = one.husid_times([0.05, 0.95]).unwrap();
            assert!((begin - 0.05_f64.cbrt()).abs() < 1e-14 && (end - 0.95_f64.cbrt()).abs() < 1e-14);
        }
        let still = Record::new("R", 1.0, vec![0.0; 3]).unwrap();
        assert_eq!((still.arias_intensity(), still.significant_duration()), (0.0, 0.0));
        assert!(still.husid_times([0.9, 0.1]).unwrap_err().to_string().contains("the first part below the second"));
    }
}
