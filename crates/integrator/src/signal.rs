//! Time histories of loads and of prescribed motion (`docs/signals.md`).
//!
//! A [`Signal`] is a number without unit that depends on time, with its rate and its first two
//! integrals, each in closed form (those of a [`Chirp`] or a [`Product`] by quadrature to rounding):
//! whichever of
//! displacement, velocity and acceleration is given, a [`Motion`] has the others without summing over
//! steps.

mod chirp;
mod compensated;
mod formula;
mod motion;
mod product;
mod sum;
mod table;
pub(crate) mod window;

pub use chirp::{Chirp, Growth};
pub use formula::Formula;
pub use motion::{Given, Motion};
pub use product::Product;
pub use sum::Sum;
pub use table::Table;
use window::Moments;

/// A time history without unit; the amplitude by which it is multiplied has one.
///
/// At a jump it has the value after the jump; the jump doesn't enter the rate.
///
/// ```
/// use teeter_integrator::{Formula, Signal};
///
/// let pulse = Formula::half_sine(1.0, 0.5)?; // from 1 s to 1.5 s
/// assert_eq!((pulse.value(1.25), pulse.value(1.6)), (1.0, 0.0));
/// let area = pulse.integral(2.0);
/// assert!((area - 2.0 * 0.5 / std::f64::consts::PI).abs() < 1e-15);
/// # Ok::<(), teeter_integrator::SignalError>(())
/// ```
pub trait Signal: std::fmt::Debug + Send + Sync {
    /// Its value at time `t` (s).
    fn value(&self, t: f64) -> f64;

    /// Its derivative at `t`, 1/s; from the right at a kink.
    fn rate(&self, t: f64) -> f64;

    /// Its integral from 0 to `t`, s.
    fn integral(&self, t: f64) -> f64;

    /// The integral of [`Signal::integral`] from 0 to `t`, s².
    fn double_integral(&self, t: f64) -> f64;

    /// Its exact mean over the time from `from` to the later `to` (s): what a load contributes to a
    /// step.
    fn mean(&self, from: f64, to: f64) -> f64 {
        (self.integral(to) - self.integral(from)) / (to - from)
    }

    /// The mean of [`Signal::rate`] over the time from `from` to the later `to` (s), 1/s.
    fn mean_rate(&self, from: f64, to: f64) -> f64 {
        (self.value(to) - self.value(from)) / (to - from)
    }

    /// The mean of [`Signal::integral`] over the time from `from` to the later `to` (s), s.
    fn mean_integral(&self, from: f64, to: f64) -> f64 {
        (self.double_integral(to) - self.double_integral(from)) / (to - from)
    }

    /// The means of the signal times P₀ … P₃, Legendre's polynomials of a variable that goes from
    /// −1 to 1 over the time from `from` to the later `to` (s). The mean of a load that moves along
    /// a beam is computed from them.
    ///
    /// The default takes the first from [`Signal::mean`], the others by eight Gauss points;
    /// override it for a signal with kinks, or one that varies fast over such times.
    fn moments(&self, from: f64, to: f64) -> [f64; 4] {
        let mut moments = window::by_points(from, to, |t| self.value(t));
        moments[0] = self.mean(from, to);
        moments
    }

    /// The first time after 0 at which it jumps, s; such a signal can't be prescribed as a
    /// displacement.
    fn jump(&self) -> Option<f64> {
        None
    }

    /// The first time after `t` at which it isn't smooth, s: where it or any of its derivatives
    /// jumps; infinity, the default, for none. A scheme of high order ends a step there.
    fn next_break(&self, t: f64) -> f64 {
        let _ = t;
        f64::INFINITY
    }

    /// The period of its fastest oscillation, s; infinity, the default, if between its breaks it is
    /// a polynomial. A [`Product`] integrates over quarters of it: override it for a signal that
    /// oscillates.
    fn shortest_period(&self) -> f64 {
        f64::INFINITY
    }

    /// Its second derivative at `t`, 1/s²; from the right where it jumps. The default takes
    /// differences of [`Signal::rate`] over a ten-thousandth of a second, right to some ten digits
    /// for a signal that varies within a second: override it.
    fn second_rate(&self, t: f64) -> f64 {
        let (h, rate) = (1e-4, |k: f64| self.rate(t + 1e-4 * k));
        (8.0 * (rate(1.0) - rate(-1.0)) - (rate(2.0) - rate(-2.0))) / (12.0 * h)
    }
}

/// What is wrong with a signal.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SignalError {
    /// A number out of its range.
    #[error("{what} is {value}, but must be {rule}")]
    Value {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The range.
        rule: &'static str,
    },
    /// Too few rows.
    #[error("{0} rows, but a table needs two or more")]
    Rows(usize),
    /// Different numbers of times and values.
    #[error("{times} times, but {values} values")]
    Lengths {
        /// Times.
        times: usize,
        /// Values.
        values: usize,
    },
    /// A row with a number that is not finite, or a time that is not later than the one before.
    #[error("row {row}: {what}")]
    Row {
        /// Which row, from 1.
        row: usize,
        /// What is wrong with it.
        what: String,
    },
}

/// The integrals of f from 0, from antiderivatives F₁ of f and F₂ of F₁.
///
/// `at(t)` returns (F₁, F₂).
fn from_zero(t: f64, at: impl Fn(f64) -> (f64, f64)) -> (f64, f64) {
    let ((f1, f2), (f1_0, f2_0)) = (at(t), at(0.0));
    (f1 - f1_0, f2 - f2_0 - t * f1_0)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Five-point Gauss–Legendre over `pieces` equal parts of [a, b].
    pub(crate) fn quadrature(f: impl Fn(f64) -> f64, a: f64, b: f64, pieces: usize) -> f64 {
        let (p, q) = (0.906_179_845_938_664, 0.538_469_310_105_683_1);
        let (wp, wq, w0) = (0.236_926_885_056_189_08, 0.478_628_670_499_366_47, 0.568_888_888_888_888_9);
        let half = 0.5 * (b - a) / pieces as f64;
        let piece = |i: usize| {
            let middle = a + (2 * i + 1) as f64 * half;
            [(-p, wp), (-q, wq), (0.0, w0), (q, wq), (p, wp)]
                .iter()
                .map(|(s, w)| half * w * f(middle + s * half))
                .sum::<f64>()
        };
        (0..pieces).map(piece).sum()
    }

    /// Compares a signal with quadrature and differences, between and across its kinks.
    pub(crate) fn check(signal: &dyn Signal, kinks: &[f64], until: f64) {
        let mut ends = vec![0.0];
        ends.extend(kinks.iter().copied().filter(|k| *k > 0.0 && *k < until));
        ends.push(until);
        let (mut once, mut twice) = (0.0, 0.0);
        for piece in ends.windows(2) {
            let (a, b) = (piece[0], piece[1]);
            let inner = |t: f64| once + quadrature(|s| signal.value(s), a, t, 200);
            for t in [a + 0.3 * (b - a), b] {
                let (first, second) = (inner(t), twice + quadrature(inner, a, t, 200));
                let (i, d) = (signal.integral(t), signal.double_integral(t));
                assert!((i - first).abs() < 1e-12 * (1.0 + first.abs()), "{signal:?} integral to {t}: {i} {first}");
                assert!((d - second).abs() < 1e-12 * (1.0 + second.abs()), "{signal:?} double to {t}: {d} {second}");
            }
            let (t, h) = (0.5 * (a + b), 1e-4 * (b - a));
            // Fourth order: the error is some 1e-16 of the fifth derivative, and rounding over h.
            let f = |k: f64| signal.value(t + k * h);
            let rate = (8.0 * (f(1.0) - f(-1.0)) - (f(2.0) - f(-2.0))) / (12.0 * h);
            assert!((signal.rate(t) - rate).abs() < 1e-9 * (1.0 + rate.abs()), "{signal:?} rate at {t}");
            let f = |k: f64| signal.rate(t + k * h);
            let second = (8.0 * (f(1.0) - f(-1.0)) - (f(2.0) - f(-2.0))) / (12.0 * h);
            let own = signal.second_rate(t);
            assert!(
                (own - second).abs() < 1e-8 * (1.0 + second.abs()),
                "{signal:?} second rate at {t}: {own} {second}"
            );
            let next = signal.next_break(a);
            assert!(kinks.is_empty() || next >= b || (next - b).abs() < 1e-12, "{signal:?} after {a}: {next}");
            (once, twice) = (inner(b), twice + quadrature(inner, a, b, 200));
        }
        assert_eq!((signal.integral(0.0), signal.double_integral(0.0)), (0.0, 0.0));
    }
}
