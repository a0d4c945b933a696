//! Response spectra: the largest response of linear oscillators to a record.

use std::f64::consts::PI;

use crate::error::RecordError;
use crate::record::Record;

/// Least number of steps per period: longer steps of the record are subdivided. More would only
/// cost time.
const STEPS_PER_PERIOD: f64 = 16.0;

/// Shortest period as a fraction of the record's step. Stiffer oscillators follow the ground.
const SHORTEST_PERIOD: f64 = 1e-3;

/// The peak response of an oscillator ü + 2ζω u̇ + ω² u = −a, starting at rest, over the duration
/// of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Natural period T = 2π/ω, s.
    pub period: f64,
    /// Largest displacement relative to the ground, m (Sd).
    pub displacement: f64,
    /// Largest velocity relative to the ground, m/s.
    pub velocity: f64,
    /// Largest absolute acceleration |ü + a| = |2ζω u̇ + ω² u|, m/s².
    pub acceleration: f64,
}

impl Response {
    /// Pseudo-velocity ω Sd, m/s.
    #[must_use]
    pub fn pseudo_velocity(&self) -> f64 {
        2.0 * PI / self.period * self.displacement
    }

    /// Pseudo-acceleration ω² Sd, m/s².
    #[must_use]
    pub fn pseudo_acceleration(&self) -> f64 {
        (2.0 * PI / self.period).powi(2) * self.displacement
    }
}

impl Record {
    /// The response spectrum at the given natural periods (s), for a damping ratio ζ in [0, 1).
    ///
    /// Between values the response to the linear acceleration is exact (N. C. Nigam, P. C.
    /// Jennings, "Calculation of response spectra from strong-motion earthquake records", Bull.
    /// Seism. Soc. Am. 59 (1969) 909–922). Unlike there, steps over 1/16 of the period are
    /// subdivided and extremes between the values are located, so that a record's step doesn't cut
    /// off the peaks of short periods. The response after the record's last value isn't included.
    ///
    /// # Errors
    /// If ζ isn't in [0, 1), or a period isn't finite and at least 1/1000 of the record's step.
    pub fn spectrum(&self, damping_ratio: f64, periods: &[f64]) -> Result<Vec<Response>, RecordError> {
        if !(0.0..1.0).contains(&damping_ratio) {
            let range = "in [0, 1)";
            return Err(RecordError::Parameter { what: "the damping ratio", value: damping_ratio, range });
        }
        let shortest = SHORTEST_PERIOD * self.dt();
        if let Some(&value) = periods.iter().find(|period| !(**period >= shortest && period.is_finite())) {
            let range = "finite and at least 1/1000 of the record's step";
            return Err(RecordError::Parameter { what: "the period", value, range });
        }
        Ok(periods.iter().map(|period| self.response(damping_ratio, *period)).collect())
    }

    fn response(&self, zeta: f64, period: f64) -> Response {
        let parts = (STEPS_PER_PERIOD * self.dt() / period).ceil().max(1.0);
        let h = self.dt() / parts;
        let oscillator = Oscillator::new(zeta, 2.0 * PI / period);
        let step = StepMatrix::new(&oscillator, h);
        let mut most = PeakResponse::default();
        let mut state = [0.0, 0.0];
        for a in self.accelerations().windows(2) {
            let slope = (a[1] - a[0]) / self.dt();
            for part in 0..parts as usize {
                let begin = a[0] + slope * (part as f64 * h);
                let next = step.apply(state, begin, begin + slope * h);
                most.include(&oscillator, h, state, next, [begin, slope]);
                state = next;
            }
        }
        let [displacement, velocity, acceleration] = most.0;
        Response { period, displacement, velocity, acceleration }
    }
}

/// Terms of the motion's power series. With a step of at most 1/16 of a period, ωτ ≤ 0.4, and the
/// first omitted term is below 0.4¹⁶/16! = 2e-20 of the motion.
const TERMS: usize = 16;

/// The oscillator with its exact motion.
struct Oscillator {
    zeta: f64,
    omega: f64,
}

impl Oscillator {
    fn new(zeta: f64, omega: f64) -> Self {
        Self { zeta, omega }
    }

    /// Displacement and velocity at τ from those at 0, under the ground acceleration a + s τ.
    ///
    /// Uses the power series in τ, with coefficients from the recurrence of the equation of motion.
    /// The closed form subtracts terms of order a/ω² and s/ω³ and would lose all digits for long
    /// periods.
    fn at(&self, tau: f64, [u, v]: [f64; 2], [a, slope]: [f64; 2]) -> [f64; 2] {
        let (friction, stiffness) = (2.0 * self.zeta * self.omega, self.omega * self.omega);
        // u = Σ cₙ, v = Σ dₙ with cₙ = kₙ τⁿ and dₙ = (n + 1) kₙ₊₁ τⁿ.
        let (mut c, mut d) = (u, v);
        let mut sum = [c, d];
        let mut ground = [a, slope * tau].into_iter();
        for n in 0..TERMS {
            let n = n as f64;
            let rate = -ground.next().unwrap_or(0.0) - friction * d - stiffness * c;
            (c, d) = (d * tau / (n + 1.0), rate * tau / (n + 1.0));
            sum = [sum[0] + c, sum[1] + d];
        }
        sum
    }

    /// Displacement, velocity and absolute acceleration, each with its time derivative.
    fn quantities(&self, [u, v]: [f64; 2], a: f64) -> [[f64; 2]; 3] {
        let absolute = |u: f64, v: f64| -2.0 * self.zeta * self.omega * v - self.omega * self.omega * u;
        let relative = absolute(u, v) - a;
        [[u, v], [v, relative], [absolute(u, v), absolute(v, relative)]]
    }
}

/// A time step as a matrix: the motion is linear in the initial displacement and velocity and in
/// the accelerations at both ends.
struct StepMatrix([[f64; 4]; 2]);

impl StepMatrix {
    fn new(oscillator: &Oscillator, h: f64) -> Self {
        let unit = [
            oscillator.at(h, [1.0, 0.0], [0.0, 0.0]),
            oscillator.at(h, [0.0, 1.0], [0.0, 0.0]),
            oscillator.at(h, [0.0, 0.0], [1.0, -1.0 / h]),
            oscillator.at(h, [0.0, 0.0], [0.0, 1.0 / h]),
        ];
        Self([0, 1].map(|row| unit.map(|column| column[row])))
    }

    fn apply(&self, [u, v]: [f64; 2], begin: f64, end: f64) -> [f64; 2] {
        self.0.map(|row| row[0] * u + row[1] * v + row[2] * begin + row[3] * end)
    }
}

/// The largest magnitudes so far of displacement, velocity and absolute acceleration.
#[derive(Default)]
struct PeakResponse([f64; 3]);

impl PeakResponse {
    /// Includes a step: its ends, and the points in between where a derivative changes sign.
    fn include(&mut self, oscillator: &Oscillator, h: f64, begin: [f64; 2], end: [f64; 2], ground: [f64; 2]) {
        let [a, slope] = ground;
        let (first, second) = (oscillator.quantities(begin, a), oscillator.quantities(end, a + slope * h));
        for k in 0..3 {
            let ([value, rate], [next, last]) = (first[k], second[k]);
            self.0[k] = self.0[k].max(next.abs());
            let reach = value.abs().max(next.abs()) + h * rate.abs().max(last.abs());
            if (rate > 0.0) == (last > 0.0) || reach <= self.0[k] {
                continue;
            }
            let (mut low, mut high) = (0.0, h);
            let mut top = next;
            // At an extreme the derivative is zero: a position to 2⁻²⁷ of the step gives its value
            // to rounding.
            for _ in 0..27 {
                let middle = 0.5 * (low + high);
                let state = oscillator.at(middle, begin, ground);
                let [here, slope_here] = oscillator.quantities(state, a + slope * middle)[k];
                top = here;
                if (slope_here > 0.0) == (rate > 0.0) { low = middle } else { high = middle }
            }
            self.0[k] = self.0[k].max(top.abs());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn step_response_overshoot_matches_closed_form() {
        let (a, t) = (3.0, 0.7);
        // Short and long steps relative to the period give the same motion.
        for dt in [0.001, 0.05, 0.35, 2.0] {
            let one = Record::new("R", dt, vec![a; (4.0 / dt) as usize]).unwrap();
            for zeta in [0.0_f64, 0.02, 0.05, 0.3, 0.7] {
                let omega = 2.0 * PI / t;
                let root = (1.0 - zeta * zeta).sqrt();
                let sd = a / (omega * omega) * (1.0 + (-zeta * PI / root).exp());
                // The velocity a/ω_d e^(-ζωt) sin ω_d t is largest where its derivative is 0: tan
                // ω_d t =
                // ω_d/(ζω).
                let phase = root.atan2(zeta);
                let sv = a / omega * (-zeta / root * phase).exp();
                let got = one.spectrum(zeta, &[t]).unwrap()[0];
                // Each step rounds by a few units in the last place of a/ω², which an undamped
                // vibration
                // keeps.
                let allowed = 4.0 * f64::EPSILON * (4.0 / dt).max(100.0);
                let off = |got: f64, exact: f64| (got / exact - 1.0).abs();
                assert!(off(got.displacement, sd) < allowed, "{zeta} {dt}: {:e}", off(got.displacement, sd));
                assert!(off(got.velocity, sv) < allowed, "{zeta} {dt}: {:e}", off(got.velocity, sv));
                let sa = got.pseudo_acceleration();
                assert!(off(sa, omega * omega * sd) < allowed);
                assert!((got.pseudo_velocity() * omega / sa - 1.0).abs() < 1e-14);
                if zeta == 0.0 {
                    assert!(off(got.acceleration, sa) < allowed, "no damping: ω² u is all of it");
                }
            }
        }
    }

    #[test]
    fn sine_response_converges_with_order_two() {
        // From rest, undamped, a = A sin Ωt: u = -A/(ω² - Ω²) (sin Ωt - Ω/ω sin ωt).
        let (amplitude, big, small) = (2.0, 2.0 * PI, 2.0 * PI / 0.4);
        let exact =
            |t: f64| -amplitude / (small * small - big * big) * ((big * t).sin() - big / small * (small * t).sin());
        let most = (0..=4_000_000).map(|k| exact(4.0 * f64::from(k) / 4e6).abs()).fold(0.0, f64::max);
        let off = |n: u32| {
            let dt = 4.0 / f64::from(n);
            let values = (0..=n).map(|k| amplitude * (big * dt * f64::from(k)).sin()).collect();
            let one = Record::new("R", dt, values).unwrap();
            (one.spectrum(0.0, &[0.4]).unwrap()[0].displacement / most - 1.0).abs()
        };
        let (coarse, fine) = (off(400), off(800));
        assert!(coarse < 1e-3 && fine < 2.5e-4, "{coarse:e} {fine:e}");
        assert!((coarse / fine - 4.0).abs() < 0.1, "{}", coarse / fine);
    }

    #[test]
    fn limits_of_short_and_long_periods() {
        let values: Vec<f64> = (0..500).map(|k| (0.13 * f64::from(k)).sin() * (-0.01 * f64::from(k)).exp()).collect();
        let one = Record::new("R", 0.01, values).unwrap().baseline_corrected(1).unwrap();
        let [short, long] = <[Response; 2]>::try_from(one.spectrum(0.05, &[0.002, 1e4]).unwrap()).unwrap();
        // A stiff oscillator follows the ground up to (ω_ground/ω)² and the sudden start of the
        // record.
        assert!(short.acceleration >= one.peak_acceleration() * 0.999);
        assert!((long.displacement / one.displacement_peak().size - 1.0).abs() < 1e-3);
        assert!((long.velocity / one.velocity_peak().size - 1.0).abs() < 1e-3);
    }

    #[test]
    fn invalid_parameters_are_refused() {
        let one = Record::new("R", 0.01, vec![1.0, 2.0]).unwrap();
        let message = |zeta: f64, period: f64| one.spectrum(zeta, &[period]).unwrap_err().to_string();
        assert_eq!(message(1.0, 1.0), "the damping ratio is 1, but must be in [0, 1)");
        assert!(message(f64::NAN, 1.0).contains("must be in [0, 1)"));
        for period in [0.0, -1.0, 1e-6, f64::INFINITY, f64::NAN] {
            assert!(message(0.05, period).ends_with("finite and at least 1/1000 of the record's step"));
        }
        assert_eq!(one.spectrum(0.05, &[]).unwrap(), []);
    }
}
