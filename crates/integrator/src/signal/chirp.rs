//! Sines of a frequency that grows or falls, as in sweep tests. Their integrals have no closed form
//! in general (a linear chirp has Fresnel's, a logarithmic one sine integrals): they are computed by
//! Gauss' eight points over panels of at most a quarter of the shortest period, where the rule is
//! exact to rounding, and summed once, when the chirp is made. So value, rate and integrals are
//! those of the same function, whatever the step.

use super::compensated::Compensated;
use super::formula::{finite, positive};
use super::window::{self, Moments, Pieces, sinc};
use super::{Signal, SignalError, from_zero};
use std::f64::consts::TAU;
use std::sync::Arc;

/// How the frequency of a [`Chirp`] grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Growth {
    /// By equal differences in equal times.
    Linear,
    /// By equal ratios in equal times: as many octaves per second at all times.
    Logarithmic,
}

/// A sine whose frequency goes from one value to another: sin(φ(τ) + ψ) with τ the time since the
/// start, and 0 before and after. The derivative of φ is 2π times the frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Chirp {
    start: f64,
    duration: f64,
    frequencies: [f64; 2],
    phase: f64,
    growth: Growth,
    /// At the ends of panels: the integral since the start, and the integral of that. Copies share
    /// them.
    ends: Arc<[[f64; 2]]>,
}

/// Panels per shortest period: the argument of the sine advances by at most π/2 in one, and the
/// error of eight points, (π/4)¹⁶ 2¹⁷ 8!⁴/(17 · 16!³) of the panel, is 5e-20.
const PER_PERIOD: f64 = 4.0;

/// Least number of panels: the frequency changes little within one.
const LEAST: f64 = 256.0;

/// Most panels, of 16 bytes each.
const MOST: f64 = 4e6;

/// Over this many panels a mean is a difference of integrals, which loses no digits there.
const MANY: f64 = 16.0;

impl Chirp {
    /// A sine from `start` (s) on, for `duration` (s), whose frequency goes from the first to the
    /// second of `frequencies` (Hz); it starts at `phase` (rad).
    ///
    /// # Errors
    /// If a number is not finite, the duration or a frequency is not positive, or there are more
    /// than a million periods of the higher frequency in the duration.
    pub fn new(
        start: f64,
        duration: f64,
        frequencies: [f64; 2],
        phase: f64,
        growth: Growth,
    ) -> Result<Self, SignalError> {
        let duration = positive("the duration", duration)?;
        let [from, to] = frequencies;
        let highest = positive("the first frequency", from)?.max(positive("the last frequency", to)?);
        let panels = (PER_PERIOD * highest * duration).ceil().max(LEAST);
        if !(panels <= MOST) {
            let (what, rule) = ("the duration times the higher frequency", "at most 1000000 periods");
            return Err(SignalError::Value { what, value: duration * highest, rule });
        }
        let (start, phase) = (finite("the start", start)?, finite("the phase", phase)?);
        let mut chirp = Self { start, duration, frequencies, phase, growth, ends: Arc::new([]) };
        let mut ends = vec![[0.0; 2]];
        let (mut once, mut twice) = (Compensated::default(), Compensated::default());
        for k in 0..panels as u32 {
            let [from, to] = [k, k + 1].map(|k| duration * (f64::from(k) / panels));
            let [first, second] = chirp.within(from, to);
            twice.add((to - from) * once.total());
            twice.add(second);
            once.add(first);
            ends.push([once.total(), twice.total()]);
        }
        chirp.ends = ends.into();
        Ok(chirp)
    }

    /// The shortest period, and between which times it oscillates, s.
    #[must_use]
    pub fn swings(&self) -> (f64, [f64; 2]) {
        let [from, to] = self.frequencies;
        (from.max(to).recip(), [self.start, self.start + self.duration])
    }

    /// From which time on it is 0, s.
    #[must_use]
    pub fn settles_at(&self) -> f64 {
        self.start + self.duration
    }

    fn growth_rate(&self) -> f64 {
        let [from, to] = self.frequencies;
        match self.growth {
            Growth::Linear => (to - from) / self.duration,
            Growth::Logarithmic => (to / from).ln() / self.duration,
        }
    }

    /// The frequency at τ, Hz.
    fn frequency(&self, tau: f64) -> f64 {
        match self.growth {
            Growth::Linear => self.frequencies[0] + self.growth_rate() * tau,
            Growth::Logarithmic => self.frequencies[0] * (self.growth_rate() * tau).exp(),
        }
    }

    /// By how much the argument of the sine advances from `a` to `b`.
    fn advance(&self, a: f64, b: f64) -> f64 {
        let periods = match self.growth {
            Growth::Linear => self.frequency(0.5 * (a + b)),
            Growth::Logarithmic => {
                let x = self.growth_rate() * (b - a);
                let ratio = if x == 0.0 { 1.0 } else { x.exp_m1() / x };
                self.frequency(a) * ratio
            }
        };
        TAU * periods * (b - a)
    }

    fn argument(&self, tau: f64) -> f64 {
        self.advance(0.0, tau) + self.phase
    }

    fn panels(&self) -> f64 {
        (self.ends.len() - 1) as f64
    }

    fn is_within(&self, tau: f64) -> bool {
        (0.0..self.duration).contains(&tau)
    }

    /// The integral over a part of a panel, and the integral of that.
    fn within(&self, from: f64, to: f64) -> [f64; 2] {
        let [first, second, ..] = self.by_points(from, to);
        // The mean of (to − τ) f, with to − τ = ½(to − from)(1 − s).
        [(to - from) * first, 0.5 * (to - from) * (to - from) * (first - second)]
    }

    fn by_points(&self, from: f64, to: f64) -> Moments {
        window::by_points(from, to, |tau| self.argument(tau).sin())
    }

    /// Antiderivatives: of the value, and of that.
    fn antiderivatives(&self, t: f64) -> (f64, f64) {
        let tau = t - self.start;
        if tau <= 0.0 {
            return (0.0, 0.0);
        }
        let panels = self.panels();
        if tau >= self.duration {
            let [once, twice] = self.ends[self.ends.len() - 1];
            return (once, twice + (tau - self.duration) * once);
        }
        let k = (tau / self.duration * panels).floor().min(panels - 1.0);
        let from = self.duration * (k / panels);
        let [once, twice] = self.ends[k as usize];
        let [first, second] = self.within(from, tau);
        (once + first, twice + (tau - from) * once + second)
    }

    /// The part of [from, to] (times) in which it isn't 0, in times since the start.
    fn part(&self, from: f64, to: f64) -> (f64, f64) {
        ((from - self.start).max(0.0), (to - self.start).min(self.duration))
    }
}

impl Signal for Chirp {
    fn value(&self, t: f64) -> f64 {
        let tau = t - self.start;
        if self.is_within(tau) { self.argument(tau).sin() } else { 0.0 }
    }

    fn rate(&self, t: f64) -> f64 {
        let tau = t - self.start;
        if self.is_within(tau) { TAU * self.frequency(tau) * self.argument(tau).cos() } else { 0.0 }
    }

    fn second_rate(&self, t: f64) -> f64 {
        let tau = t - self.start;
        if !self.is_within(tau) {
            return 0.0;
        }
        let frequency = self.frequency(tau);
        let growth = match self.growth {
            Growth::Linear => self.growth_rate(),
            Growth::Logarithmic => self.growth_rate() * frequency,
        };
        let (sin, cos) = self.argument(tau).sin_cos();
        TAU * growth * cos - (TAU * frequency) * (TAU * frequency) * sin
    }

    fn integral(&self, t: f64) -> f64 {
        from_zero(t, |t| self.antiderivatives(t)).0
    }

    fn double_integral(&self, t: f64) -> f64 {
        from_zero(t, |t| self.antiderivatives(t)).1
    }

    fn mean(&self, from: f64, to: f64) -> f64 {
        let (a, b) = self.part(from, to);
        if (b - a) * self.panels() > MANY * self.duration {
            return (self.integral(to) - self.integral(from)) / (to - from);
        }
        self.moments(from, to)[0]
    }

    fn mean_rate(&self, from: f64, to: f64) -> f64 {
        let (a, b) = (from - self.start, to - self.start);
        if a >= 0.0 && b < self.duration {
            // A difference of sines as a product: no digits lost over short times.
            let half = 0.5 * self.advance(a, b);
            return (self.argument(a) + half).cos() * sinc(half.abs()) * 2.0 * half / (to - from);
        }
        (self.value(to) - self.value(from)) / (to - from)
    }

    fn mean_integral(&self, from: f64, to: f64) -> f64 {
        let (a, b) = self.part(from, to);
        if (b - a) * self.panels() > MANY * self.duration {
            return (self.double_integral(to) - self.double_integral(from)) / (to - from);
        }
        let moments = self.moments(from, to);
        self.integral(from) + 0.5 * (to - from) * (moments[0] - moments[1])
    }

    fn moments(&self, from: f64, to: f64) -> Moments {
        let (a, b) = self.part(from, to);
        let mut pieces = Pieces::over(from - self.start, to - self.start);
        if a < b {
            let parts = ((b - a) / self.duration * self.panels()).ceil().max(1.0);
            for k in 0..parts as u32 {
                // The ends themselves, so that pieces know that they fill the stretch.
                let at = |k: u32| if f64::from(k) == parts { b } else { a + (b - a) * (f64::from(k) / parts) };
                pieces.add(at(k), at(k + 1), &self.by_points(at(k), at(k + 1)));
            }
        }
        pieces.moments()
    }

    fn jump(&self) -> Option<f64> {
        let ends = [(self.start, self.phase), (self.settles_at(), self.argument(self.duration))];
        // The argument at the end has the rounding of all its periods.
        let rounding = |argument: f64| 1e-12 * (1.0 + argument.abs());
        ends.into_iter().find(|(t, argument)| *t > 0.0 && argument.sin().abs() > rounding(*argument)).map(|(t, _)| t)
    }

    fn shortest_period(&self) -> f64 {
        // Over a few panels its frequency must not change much either.
        self.swings().0.min(PER_PERIOD / LEAST * self.duration)
    }

    fn next_break(&self, t: f64) -> f64 {
        [self.start, self.settles_at()].into_iter().find(|at| *at > t).unwrap_or(f64::INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{check, quadrature};
    use super::*;

    const BOTH: [Growth; 2] = [Growth::Linear, Growth::Logarithmic];

    #[test]
    fn integrals_and_rates_are_those_of_the_value() {
        for growth in BOTH {
            for (start, frequencies) in [(0.0, [1.0, 9.0]), (0.3, [6.0, 0.5]), (-0.4, [2.0, 2.0])] {
                let chirp = Chirp::new(start, 1.2, frequencies, 0.6, growth).unwrap();
                check(&chirp, &[start, start + 1.2], 2.0);
            }
        }
    }

    #[test]
    fn a_chirp_of_one_frequency_is_a_harmonic() {
        let sine = crate::Formula::harmonic(0.2, 3.0, 0.4).unwrap();
        for growth in BOTH {
            let chirp = Chirp::new(0.2, 50.0, [3.0; 2], 0.4, growth).unwrap();
            for k in 0..500 {
                let t = 0.1 * f64::from(k);
                let each = |signal: &dyn Signal| {
                    let [m0, m1, m2, m3] = signal.moments(t, t + 0.13);
                    [signal.value(t), signal.integral(t), signal.double_integral(t), m0, m1, m2, m3]
                };
                let means = |signal: &dyn Signal| {
                    [signal.mean(t, t + 1e-3), signal.mean_rate(t, t + 1e-3), signal.mean_integral(t, t + 1e-3)]
                };
                for (found, known) in each(&chirp).into_iter().zip(each(&sine)) {
                    assert!((found - known).abs() < 1e-12, "{growth:?} at {t}: {found} {known}");
                }
                for (found, known) in means(&chirp).into_iter().zip(means(&sine)) {
                    assert!((found - known).abs() < 1e-11, "{growth:?} at {t}: {found} {known}");
                }
            }
        }
    }

    #[test]
    fn long_chirps_are_integrated_to_rounding() {
        // Some 1500 and 560 periods, against a quadrature of 40 panels or more per shortest period.
        for (growth, frequencies) in [(Growth::Linear, [0.1, 100.0]), (Growth::Logarithmic, [100.0, 0.5])] {
            let chirp = Chirp::new(0.0, 30.0, frequencies, 0.0, growth).unwrap();
            let value = |t: f64| chirp.value(t);
            for until in [7.77, 29.999] {
                let once = quadrature(value, 0.0, until, 120_000);
                let twice = quadrature(|t| (until - t) * value(t), 0.0, until, 120_000);
                assert!((chirp.integral(until) - once).abs() < 1e-13, "{growth:?}: {}", chirp.integral(until) - once);
                assert!((chirp.double_integral(until) - twice).abs() < 2e-12 * twice.abs().max(1.0), "{growth:?}");
            }
            let sum: f64 = (0..30_000).map(|k| 1e-3 * chirp.mean(1e-3 * f64::from(k), 1e-3 * f64::from(k + 1))).sum();
            assert!((sum - chirp.integral(30.0)).abs() < 1e-13, "{growth:?}");
        }
    }

    #[test]
    fn its_phase_passes_as_many_periods_as_the_frequency_says() {
        let linear = Chirp::new(0.0, 10.0, [1.0, 9.0], 0.0, Growth::Linear).unwrap();
        assert_eq!(linear.argument(10.0), TAU * 50.0);
        let logarithmic = Chirp::new(0.0, 10.0, [1.0, 8.0], 0.0, Growth::Logarithmic).unwrap();
        assert!((logarithmic.argument(10.0) / (TAU * 70.0 / 8.0_f64.ln()) - 1.0).abs() < 1e-15);
        // Three octaves in 10 s: each takes a third of the time.
        assert!((logarithmic.frequency(10.0 / 3.0) - 2.0).abs() < 1e-14);
        // It ends after whole periods, the other doesn't.
        assert_eq!((linear.jump(), logarithmic.jump()), (None, Some(10.0)));
    }

    #[test]
    fn bad_numbers_are_named() {
        let text = |duration: f64, frequencies: [f64; 2]| {
            Chirp::new(0.0, duration, frequencies, 0.0, Growth::Linear).unwrap_err().to_string()
        };
        assert_eq!(text(0.0, [1.0; 2]), "the duration is 0, but must be greater than 0 and finite");
        assert_eq!(text(1.0, [1.0, -2.0]), "the last frequency is -2, but must be greater than 0 and finite");
        let message = text(1e4, [1.0, 1e3]);
        assert_eq!(message, "the duration times the higher frequency is 10000000, but must be at most 1000000 periods");
    }
}
