//! Response spectra: the largest response of linear oscillators to a record.

use std::f64::consts::PI;

use crate::error::RecordError;
use crate::record::Record;

/// Least number of steps per period: longer steps of the record are subdivided. More would only
/// cost time.
const STEPS_PER_PERIOD: f64 = 16.0;

/// Shortest period as a fraction of the record's step. Stiffer oscillators follow the ground.
const SHORTEST_PERIOD: f64 = 1e-3;

/// The peak response of an oscillator ü + 2ζω u̇ + ω² u = −a, starting at rest, during a record and in
/// the free vibration after it.
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
    /// off the peaks of short periods. After the record's last value the ground moves evenly: of the free vibration that
    /// follows, which has the peaks of periods longer than a pulse, the largest extreme is taken in closed form.
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
        most.include_free(&oscillator, state);
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

    /// Includes the free vibration from a state on. Each quantity is R e^(−ζωt) cos(ω_d t − θ), and its first extreme, within half a
    /// period, its largest: there the cosine is √(1 − ζ²).
    fn include_free(&mut self, oscillator: &Oscillator, state: [f64; 2]) {
        let Oscillator { zeta, omega } = *oscillator;
        let root = (1.0 - zeta * zeta).sqrt();
        for (most, [value, rate]) in self.0.iter_mut().zip(oscillator.quantities(state, 0.0)) {
            // In units of the value.
            let rate = rate / omega;
            let amplitude = value.hypot((rate + zeta * value) / root);
            let phase = (rate * root).atan2(value + zeta * rate).rem_euclid(PI);
            *most = most.max(root * amplitude * (-zeta / root * phase).exp());
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
                // The step back to zero at the end of the record may excite more than the one at its begin.
                let end = dt * ((4.0 / dt).trunc() - 1.0);
                let step = |t: f64| (-zeta * omega * t).exp() * (root * omega * t).sin();
                let after = (0..=20_000).map(|k| end + t * f64::from(k) / 20_000.0);
                let free = after.map(|t| a / (omega * root) * (step(t) - step(t - end)).abs()).fold(0.0, f64::max);
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
                if free > sv * (1.0 - 1e-6) {
                    // Of a sample of the free vibration.
                    assert!(off(got.velocity, free.max(sv)) < 1e-7, "{zeta} {dt}: {:e}", off(got.velocity, free));
                } else {
                    assert!(off(got.velocity, sv) < allowed, "{zeta} {dt}: {:e}", off(got.velocity, sv));
                }
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
    fn a_pulse_shorter_than_half_a_period_has_its_peak_in_the_free_vibration() {
        // A. K. Chopra, Dynamics of Structures, §4.8: after a half-sine of duration d < T/2 and amplitude A, undamped,
        // Sa/A = (T/d) cos(π d/T) / ((T/2d)² − 1); after a rectangle 2 sin(π d/T).
        let d = 0.1;
        let half_sine = (0..=1000).map(|k| 3.0 * (PI * f64::from(k) / 1000.0).sin()).collect();
        let half_sine = Record::new("half-sine", d / 1000.0, half_sine).unwrap();
        let rectangle = Record::new("rectangle", d, vec![3.0, 3.0]).unwrap();
        for period in [0.21, 0.5, 1.0, 4.0, 30.0] {
            let [sine, flat] = [&half_sine, &rectangle].map(|record| record.spectrum(0.0, &[period]).unwrap()[0]);
            let exact = 3.0 * period / d * (PI * d / period).cos() / ((0.5 * period / d).powi(2) - 1.0);
            // The record is linear between its values, which takes (π/1000)²/12 of a sine.
            assert!((sine.acceleration / exact - 1.0).abs() < 1e-6, "{period}: {}", sine.acceleration / exact - 1.0);
            let exact = 6.0 * (PI * d / period).sin();
            assert!((flat.acceleration / exact - 1.0).abs() < 1e-13, "{period}: {}", flat.acceleration / exact - 1.0);
            assert!((flat.pseudo_acceleration() / exact - 1.0).abs() < 1e-13);
            assert!((flat.pseudo_velocity() / flat.velocity - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn damped_free_vibration_is_that_of_a_record_followed_by_rest() {
        let mut values: Vec<f64> = (0..60).map(|k| (0.3 * f64::from(k)).sin() + 0.4).collect();
        values.push(0.0);
        let short = Record::new("R", 0.01, values.clone()).unwrap();
        values.extend([0.0; 3000]);
        let long = Record::new("R", 0.01, values).unwrap();
        for zeta in [0.0, 0.05, 0.3, 0.9] {
            for period in [0.05, 0.4, 1.3, 5.0, 20.0] {
                let [a, b] = [&short, &long].map(|record| record.spectrum(zeta, &[period]).unwrap()[0]);
                for (a, b) in
                    [(a.displacement, b.displacement), (a.velocity, b.velocity), (a.acceleration, b.acceleration)]
                {
                    assert!((a / b - 1.0).abs() < 1e-11, "{zeta} {period}: {a} {b}");
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
        let mut one = Record::new("R", 0.01, values).unwrap().baseline_corrected(1).unwrap();
        // Brought to rest within 10 ms: ground that moved on would take soft oscillators further than it did itself.
        let left: f64 = one.accelerations().windows(2).map(|a| 0.005 * (a[0] + a[1])).sum();
        let mut values = one.accelerations().to_vec();
        let last = values[values.len() - 1];
        values.extend([-left / 0.01 - 0.5 * last, 0.0]);
        one = Record::new("R", 0.01, values).unwrap();
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
