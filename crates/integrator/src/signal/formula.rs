//! Signals by formula, and their integrals in closed form.

use super::window::{self, Moments, Pieces, sinc};
use super::{Signal, SignalError, from_zero};
use std::f64::consts::{PI, TAU};

/// A time history by formula; its peak is 1 (also that of a Ricker wavelet), and before its start
/// it is 0.
///
/// With τ the time since the start:
///
/// | | |
/// |---|---|
/// | [constant](Self::constant) | 1 |
/// | [ramp](Self::ramp) | τ/d up to the duration d, then 1 |
/// | [harmonic](Self::harmonic) | sin(2πf τ + ψ) |
/// | [one sine](Self::one_sine) | sin(2πf τ + ψ) until the argument is 2π, then 0 |
/// | [half sine](Self::half_sine) | sin(πτ/d) up to the duration d, then 0 |
/// | [Ricker](Self::ricker) | (1 − 2a) exp(−a), a = (πf τ)², with τ the time since the peak: before the peak too |
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formula {
    start: f64,
    shape: Shape,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Constant,
    Ramp {
        duration: f64,
    },
    /// sin(omega τ + phase) for τ in [0, end].
    Sine {
        omega: f64,
        phase: f64,
        end: f64,
    },
    /// (1 − 2a) exp(−a), a = (rate τ)².
    Ricker {
        rate: f64,
    },
}

impl Formula {
    /// 1 from `start` (s) on.
    ///
    /// # Errors
    /// If a number is not finite, as for all formulas.
    pub fn constant(start: f64) -> Result<Self, SignalError> {
        Self::new(start, Shape::Constant)
    }

    /// Linear from 0 at `start` (s) to 1 after `duration` (s), and 1 from then on.
    ///
    /// # Errors
    /// If the duration is not positive.
    pub fn ramp(start: f64, duration: f64) -> Result<Self, SignalError> {
        Self::new(start, Shape::Ramp { duration: positive("the duration", duration)? })
    }

    /// A sine of `frequency` (Hz) from `start` (s) on, which starts at `phase` (rad).
    ///
    /// # Errors
    /// If the frequency is not positive.
    pub fn harmonic(start: f64, frequency: f64, phase: f64) -> Result<Self, SignalError> {
        let omega = TAU * positive("the frequency", frequency)?;
        Self::new(start, Shape::Sine { omega, phase: finite("the phase", phase)?, end: f64::INFINITY })
    }

    /// One sine of `frequency` (Hz) from `start` (s) on: it starts at `phase` (rad) and ends where
    /// its argument is 2π.
    ///
    /// # Errors
    /// If the frequency is not positive, or the phase not in [0, 2π).
    pub fn one_sine(start: f64, frequency: f64, phase: f64) -> Result<Self, SignalError> {
        let omega = TAU * positive("the frequency", frequency)?;
        if !(0.0..TAU).contains(&phase) {
            return Err(SignalError::Value { what: "the phase", value: phase, rule: "in [0, 2π)" });
        }
        Self::new(start, Shape::Sine { omega, phase, end: (TAU - phase) / omega })
    }

    /// Half a sine over `duration` (s).
    ///
    /// # Errors
    /// If the duration is not positive.
    pub fn half_sine(start: f64, duration: f64) -> Result<Self, SignalError> {
        let end = positive("the duration", duration)?;
        Self::new(start, Shape::Sine { omega: PI / end, phase: 0.0, end })
    }

    /// Ricker's wavelet (Ricker 1953, doi 10.1190/1.1437843) with the peak of its spectrum at
    /// `frequency` (Hz), and its own peak at `peak` (s).
    ///
    /// # Errors
    /// If the frequency is not positive.
    pub fn ricker(peak: f64, frequency: f64) -> Result<Self, SignalError> {
        Self::new(peak, Shape::Ricker { rate: PI * positive("the frequency", frequency)? })
    }

    /// The period of its oscillation, and between which times it oscillates, s; for a half sine
    /// twice its duration, for a Ricker wavelet the inverse of its frequency. `None` if it doesn't
    /// oscillate.
    #[must_use]
    pub fn swings(&self) -> Option<(f64, [f64; 2])> {
        match self.shape {
            Shape::Constant | Shape::Ramp { .. } => None,
            Shape::Sine { omega, end, .. } => Some((TAU / omega, [self.start, self.start + end])),
            Shape::Ricker { rate } => Some((PI / rate, [self.start - BELL / rate, self.start + BELL / rate])),
        }
    }

    /// How long it rises from 0 to 1, s: the duration of a ramp; `None` for all others.
    #[must_use]
    pub fn rises_in(&self) -> Option<f64> {
        match self.shape {
            Shape::Ramp { duration } => Some(duration),
            Shape::Constant | Shape::Sine { .. } | Shape::Ricker { .. } => None,
        }
    }

    /// Whether it is 0 from time 0 to `end` (s).
    #[must_use]
    pub fn is_silent_until(&self, end: f64) -> bool {
        self.swings().map_or(self.start >= end, |(_, [from, until])| from >= end || until <= 0.0)
    }

    /// From which time on it no longer changes, s: infinite for a harmonic.
    #[must_use]
    pub fn settles_at(&self) -> f64 {
        match self.shape {
            Shape::Constant => self.start,
            Shape::Ramp { duration } => self.start + duration,
            Shape::Sine { end, .. } => self.start + end,
            Shape::Ricker { rate } => self.start + BELL / rate,
        }
    }

    fn new(start: f64, shape: Shape) -> Result<Self, SignalError> {
        Ok(Self { start: finite("the start", start)?, shape })
    }

    /// Calls `each` for the smooth pieces of [a, b] (times since the start) in which it isn't 0,
    /// with their moments.
    fn pieces(&self, a: f64, b: f64, mut each: impl FnMut(f64, f64, Moments)) {
        let mut piece = |from: f64, to: f64, of: &dyn Fn(f64, f64) -> Moments| {
            let (from, to) = (a.max(from), b.min(to));
            if from < to {
                each(from, to, of(from, to));
            }
        };
        match self.shape {
            Shape::Constant => piece(0.0, f64::INFINITY, &|_, _| [1.0, 0.0, 0.0, 0.0]),
            Shape::Ramp { duration } => {
                piece(0.0, duration, &|from, to| window::of_line(from / duration, to / duration));
                piece(duration, f64::INFINITY, &|_, _| [1.0, 0.0, 0.0, 0.0]);
            }
            Shape::Sine { omega, phase, end } => piece(0.0, end, &|from, to| {
                window::of_sine(0.5 * omega * (from + to) + phase, 0.5 * omega * (to - from))
            }),
            Shape::Ricker { rate } => {
                // Outside it is 0 to rounding; inside take short pieces for the quadrature, and the
                // mean in closed form.
                let (from, to) = (a.max(-BELL / rate), b.min(BELL / rate));
                let parts = (4.0 * rate * (to - from)).max(1.0).ceil();
                for k in 0..parts as u32 {
                    let at = |k: u32| from + (to - from) * (f64::from(k) / parts);
                    piece(at(k), at(k + 1), &|from, to| {
                        let mut moments = window::by_points(from, to, |tau| wavelet(rate * tau));
                        moments[0] = wavelet_mean(rate, from, to);
                        moments
                    });
                }
            }
        }
    }

    /// An antiderivative of the value.
    fn once(&self, t: f64) -> f64 {
        let tau = t - self.start;
        match self.shape {
            Shape::Sine { omega, phase, end } if tau > 0.0 => {
                // cos ψ − cos(x + ψ) as a product: no digits lost at the start.
                let half = 0.5 * omega * tau.min(end);
                2.0 * half.sin() * (half + phase).sin() / omega
            }
            _ => self.antiderivatives(t).0,
        }
    }

    /// Antiderivatives: of the value, and of that.
    fn antiderivatives(&self, t: f64) -> (f64, f64) {
        let tau = t - self.start;
        if tau <= 0.0 && !matches!(self.shape, Shape::Ricker { .. }) {
            return (0.0, 0.0);
        }
        match self.shape {
            Shape::Constant => (tau, 0.5 * tau * tau),
            Shape::Ramp { duration: d } if tau < d => (0.5 * tau * tau / d, tau * tau * tau / (6.0 * d)),
            Shape::Ramp { duration: d } => (tau - 0.5 * d, d * d / 6.0 + 0.5 * tau * (tau - d)),
            Shape::Sine { omega, phase, end } => {
                // After its end the first integral is constant, and the second linear.
                let (inside, after) = if tau < end { (tau, 0.0) } else { (end, tau - end) };
                let half = 0.5 * omega * inside;
                // cos ψ − cos(x + ψ) and sin(x + ψ) − sin ψ as products: no digits lost at the
                // start.
                let once = 2.0 * half.sin() * (half + phase).sin() / omega;
                let rise = 2.0 * half.sin() * (half + phase).cos() / omega;
                (once, (inside * phase.cos() - rise) / omega + after * once)
            }
            Shape::Ricker { rate } => {
                let bell = (-(rate * tau) * (rate * tau)).exp();
                (tau * bell, -0.5 * bell / (rate * rate))
            }
        }
    }
}

impl Signal for Formula {
    fn value(&self, t: f64) -> f64 {
        let tau = t - self.start;
        match self.shape {
            Shape::Ricker { rate } => wavelet(rate * tau),
            _ if tau < 0.0 => 0.0,
            Shape::Constant => 1.0,
            Shape::Ramp { duration } => (tau / duration).min(1.0),
            Shape::Sine { omega, phase, end } if tau < end => (omega * tau + phase).sin(),
            Shape::Sine { .. } => 0.0,
        }
    }

    fn rate(&self, t: f64) -> f64 {
        let tau = t - self.start;
        match self.shape {
            Shape::Ricker { rate } => {
                let a = (rate * tau) * (rate * tau);
                2.0 * rate * rate * tau * (2.0 * a - 3.0) * (-a).exp()
            }
            _ if tau < 0.0 => 0.0,
            Shape::Ramp { duration } if tau < duration => duration.recip(),
            Shape::Sine { omega, phase, end } if tau < end => omega * (omega * tau + phase).cos(),
            _ => 0.0,
        }
    }

    fn integral(&self, t: f64) -> f64 {
        self.once(t) - self.once(0.0)
    }

    fn double_integral(&self, t: f64) -> f64 {
        from_zero(t, |t| self.antiderivatives(t)).1
    }

    fn mean(&self, from: f64, to: f64) -> f64 {
        let (a, b) = (from - self.start, to - self.start);
        match self.shape {
            Shape::Ricker { rate } => wavelet_mean(rate, a, b),
            _ if b <= 0.0 => 0.0,
            Shape::Constant => b.min(b - a) / (b - a),
            Shape::Ramp { duration } if a >= duration => 1.0,
            Shape::Ramp { duration } => {
                let (rising, full) = (b.min(duration), (b - duration).max(0.0));
                let first = a.max(0.0);
                (0.5 * (first + rising) / duration * (rising - first) + full) / (b - a)
            }
            Shape::Sine { omega, phase, end } => {
                let (first, last) = (a.max(0.0), b.min(end));
                if first >= last {
                    return 0.0;
                }
                let mean = (0.5 * omega * (first + last) + phase).sin() * sinc(0.5 * omega * (last - first));
                mean * ((last - first) / (b - a))
            }
        }
    }

    fn mean_rate(&self, from: f64, to: f64) -> f64 {
        let (a, b) = (from - self.start, to - self.start);
        match self.shape {
            Shape::Sine { omega, phase, end } if a >= 0.0 && b <= end => {
                omega * (0.5 * omega * (a + b) + phase).cos() * sinc(0.5 * omega * (b - a))
            }
            _ => (self.value(to) - self.value(from)) / (to - from),
        }
    }

    fn mean_integral(&self, from: f64, to: f64) -> f64 {
        let (a, b) = (from - self.start, to - self.start);
        let middle = 0.5 * (from + to);
        match self.shape {
            Shape::Constant if a >= 0.0 => self.integral(middle),
            Shape::Sine { omega, phase, end } if a >= 0.0 && b <= end => {
                let swing = (0.5 * omega * (a + b) + phase).cos() / omega;
                self.integral(middle) + swing * (1.0 - sinc(0.5 * omega * (b - a)))
            }
            _ => {
                let moments = self.moments(from, to);
                self.integral(from) + 0.5 * (to - from) * (moments[0] - moments[1])
            }
        }
    }

    fn moments(&self, from: f64, to: f64) -> Moments {
        let (a, b) = (from - self.start, to - self.start);
        let mut pieces = Pieces::over(a, b);
        self.pieces(a, b, |from, to, moments| pieces.add(from, to, &moments));
        pieces.moments()
    }

    fn next_break(&self, t: f64) -> f64 {
        let never = f64::INFINITY;
        let breaks = match self.shape {
            Shape::Constant => [0.0, never, never],
            Shape::Ramp { duration } => [0.0, duration, never],
            Shape::Sine { end, .. } => [0.0, end, never],
            // It is smooth, but nothing before and after: a long step could pass it by.
            Shape::Ricker { rate } => [-BELL / rate, 0.0, BELL / rate],
        };
        breaks.into_iter().map(|after| self.start + after).find(|at| *at > t).unwrap_or(never)
    }

    fn shortest_period(&self) -> f64 {
        match self.shape {
            Shape::Constant | Shape::Ramp { .. } => f64::INFINITY,
            Shape::Sine { omega, .. } => TAU / omega,
            // A quarter of it is short enough for the quadrature of [`Self::pieces`].
            Shape::Ricker { rate } => rate.recip(),
        }
    }

    fn second_rate(&self, t: f64) -> f64 {
        let tau = t - self.start;
        match self.shape {
            Shape::Ricker { rate } => {
                let a = (rate * tau) * (rate * tau);
                2.0 * rate * rate * (-a).exp() * ((12.0 - 4.0 * a) * a - 3.0)
            }
            Shape::Sine { omega, phase, end } if tau >= 0.0 && tau < end => {
                -omega * omega * (omega * tau + phase).sin()
            }
            _ => 0.0,
        }
    }

    fn jump(&self) -> Option<f64> {
        let jumps = match self.shape {
            Shape::Constant => true,
            // π is not a double, so its sine is not zero.
            Shape::Sine { phase, .. } => phase.sin().abs() > 1e-12,
            Shape::Ramp { .. } | Shape::Ricker { .. } => false,
        };
        (jumps && self.start > 0.0).then_some(self.start)
    }
}

/// Where a Ricker wavelet has vanished, in its own time: (1 − 2·7²) exp(−7²) is 5e-20.
const BELL: f64 = 7.0;

/// (1 − 2x²) exp(−x²).
fn wavelet(x: f64) -> f64 {
    (1.0 - 2.0 * x * x) * (-x * x).exp()
}

/// The mean of a wavelet over [a, b], times since its peak: that of (τ exp(−(rate τ)²))', computed
/// without the cancellation that the difference suffers for short intervals.
fn wavelet_mean(rate: f64, a: f64, b: f64) -> f64 {
    let [x, y] = [a, b].map(|tau| (rate * tau) * (rate * tau));
    let apart = 0.5 * rate * rate * (b - a) * (b + a);
    if apart.abs() > 0.5 {
        return (b * (-y).exp() - a * (-x).exp()) / (b - a);
    }
    // b e^(−y) − a e^(−x) = (b − a) e^(−y) + a (e^(−y) − e^(−x)), and y − x = 2·apart.
    (-y).exp() - 2.0 * a * (-0.5 * (x + y)).exp() * apart.sinh() / (b - a)
}

pub(super) fn finite(what: &'static str, value: f64) -> Result<f64, SignalError> {
    if value.is_finite() { Ok(value) } else { Err(SignalError::Value { what, value, rule: "finite" }) }
}

pub(super) fn positive(what: &'static str, value: f64) -> Result<f64, SignalError> {
    // Written so that NaN fails too.
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(SignalError::Value { what, value, rule: "greater than 0 and finite" })
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::check;
    use super::*;

    #[test]
    fn integrals_and_rates_are_those_of_the_value_wherever_the_formula_starts() {
        for start in [-0.7, -0.2, 0.0, 0.35] {
            let at = |ends: &[f64]| -> Vec<f64> { ends.iter().map(|end| start + end).collect() };
            check(&Formula::constant(start).unwrap(), &at(&[0.0]), 2.0);
            check(&Formula::ramp(start, 0.6).unwrap(), &at(&[0.0, 0.6]), 2.0);
            for phase in [0.0, 0.4, 2.0] {
                check(&Formula::harmonic(start, 1.5, phase).unwrap(), &at(&[0.0]), 2.0);
                check(&Formula::one_sine(start, 1.5, phase).unwrap(), &at(&[0.0, (TAU - phase) / (3.0 * PI)]), 2.0);
            }
            check(&Formula::half_sine(start, 0.5).unwrap(), &at(&[0.0, 0.5]), 2.0);
            check(&Formula::ricker(start, 2.0).unwrap(), &[], 2.0);
        }
    }

    #[test]
    fn a_wavelet_leaves_no_velocity_and_one_sine_its_own_displacement() {
        let wavelet = Formula::ricker(1.0, 3.0).unwrap();
        assert!(wavelet.integral(2.0).abs() < 1e-15 && wavelet.double_integral(2.0).abs() < 1e-15);
        let sine = Formula::one_sine(0.0, 2.0, 0.0).unwrap();
        assert!(sine.integral(3.0).abs() < 1e-16);
        assert!((sine.double_integral(3.0) - 0.5 / (4.0 * PI)).abs() < 1e-16, "T/ω");
    }

    #[test]
    fn early_in_a_sine_no_digits_of_the_velocity_are_lost() {
        let sine = Formula::harmonic(0.0, 1.0, 0.0).unwrap();
        let (t, omega): (f64, f64) = (1e-7, TAU);
        let exact = 0.5 * omega * t * t * (1.0 - (omega * t).powi(2) / 12.0);
        assert!((sine.integral(t) / exact - 1.0).abs() < 1e-15);
    }

    #[test]
    fn jumps_are_known() {
        assert_eq!(Formula::constant(0.2).unwrap().jump(), Some(0.2));
        assert_eq!(Formula::constant(0.0).unwrap().jump(), None);
        assert_eq!(Formula::one_sine(0.2, 1.0, 0.5).unwrap().jump(), Some(0.2));
        assert_eq!(Formula::one_sine(0.2, 1.0, 0.0).unwrap().jump(), None);
        assert_eq!(Formula::harmonic(0.2, 1.0, std::f64::consts::PI).unwrap().jump(), None);
        assert_eq!(Formula::ramp(0.2, 1.0).unwrap().jump(), None);
    }

    #[test]
    fn bad_numbers_are_named() {
        let text = |made: Result<Formula, SignalError>| made.unwrap_err().to_string();
        assert_eq!(text(Formula::ramp(0.0, 0.0)), "the duration is 0, but must be greater than 0 and finite");
        assert!(text(Formula::harmonic(0.0, f64::NAN, 0.0)).contains("the frequency is NaN"));
        assert!(text(Formula::one_sine(0.0, 1.0, 7.0)).contains("[0, 2π)"));
        assert!(text(Formula::constant(f64::INFINITY)).contains("the start"));
    }
}
