//! The prescribed motion of one coordinate.

use super::Signal;
use std::sync::Arc;

/// Which quantity a signal gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// Displacement, m or rad.
    Displacement,
    /// Velocity, m/s or rad/s; the displacement starts at 0.
    Velocity,
    /// Acceleration, m/s² or rad/s²; velocity and displacement start at 0.
    Acceleration,
}

/// The prescribed motion of one coordinate: a sum of signals with their amplitudes; with none, it
/// stands still.
///
/// ```
/// use std::sync::Arc;
/// use teeter_integrator::{Formula, Given, Motion};
///
/// let shake = Motion::still().with(Given::Acceleration, 3.0, Arc::new(Formula::constant(0.0)?));
/// assert_eq!((shake.velocity(2.0), shake.displacement(2.0)), (6.0, 6.0));
/// # Ok::<(), teeter_integrator::SignalError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Motion {
    terms: Vec<Term>,
}

#[derive(Clone, Debug)]
struct Term {
    given: Given,
    amplitude: f64,
    signal: Arc<dyn Signal>,
}

impl Motion {
    /// None.
    #[must_use]
    pub fn still() -> Self {
        Self::default()
    }

    /// Adds a term: `amplitude` (in the unit of the given quantity) times a signal.
    #[must_use]
    pub fn with(mut self, given: Given, amplitude: f64, signal: Arc<dyn Signal>) -> Self {
        self.terms.push(Term { given, amplitude, signal });
        self
    }

    /// Displacement at time `t` (s), m or rad: as given, otherwise integrated from 0.
    #[must_use]
    pub fn displacement(&self, t: f64) -> f64 {
        self.sum(|given, signal| match given {
            Given::Displacement => signal.value(t),
            Given::Velocity => signal.integral(t),
            Given::Acceleration => signal.double_integral(t),
        })
    }

    /// Velocity at time `t` (s), m/s or rad/s.
    #[must_use]
    pub fn velocity(&self, t: f64) -> f64 {
        self.sum(|given, signal| match given {
            Given::Displacement => signal.rate(t),
            Given::Velocity => signal.value(t),
            Given::Acceleration => signal.integral(t),
        })
    }

    /// Acceleration at time `t` (s), m/s² or rad/s²; from the right where the velocity has a kink.
    #[must_use]
    pub fn acceleration(&self, t: f64) -> f64 {
        self.sum(|given, signal| match given {
            Given::Displacement => signal.second_rate(t),
            Given::Velocity => signal.rate(t),
            Given::Acceleration => signal.value(t),
        })
    }

    /// The first time after `t` at which it isn't smooth, s; infinity for none.
    #[must_use]
    pub fn next_break(&self, t: f64) -> f64 {
        self.terms.iter().map(|term| term.signal.next_break(t)).fold(f64::INFINITY, f64::min)
    }

    /// The mean of the velocity over the time from `from` to the later `to` (s), m/s or rad/s.
    #[must_use]
    pub fn mean_velocity(&self, from: f64, to: f64) -> f64 {
        self.sum(|given, signal| match given {
            Given::Displacement => signal.mean_rate(from, to),
            Given::Velocity => signal.mean(from, to),
            Given::Acceleration => signal.mean_integral(from, to),
        })
    }

    fn sum(&self, of: impl Fn(Given, &dyn Signal) -> f64) -> f64 {
        self.terms.iter().map(|term| term.amplitude * of(term.given, term.signal.as_ref())).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Formula;

    #[test]
    fn whichever_is_given_velocity_and_displacement_belong_together() {
        let sine: Arc<dyn Signal> = Arc::new(Formula::harmonic(-0.3, 1.2, 0.2).unwrap());
        for given in [Given::Displacement, Given::Velocity, Given::Acceleration] {
            let motion = Motion::still().with(given, 0.7, Arc::clone(&sine)).with(given, -0.2, Arc::clone(&sine));
            for t in [0.1, 0.9] {
                let h = 1e-5;
                let rate = (motion.displacement(t + h) - motion.displacement(t - h)) / (2.0 * h);
                assert!((rate - motion.velocity(t)).abs() < 1e-8, "{given:?}");
                let rate = (motion.velocity(t + h) - motion.velocity(t - h)) / (2.0 * h);
                assert!((rate - motion.acceleration(t)).abs() < 1e-7, "{given:?}");
            }
            let starts = [motion.displacement(0.0) == 0.0, motion.velocity(0.0) == 0.0];
            let expected = [given != Given::Displacement, given == Given::Acceleration];
            assert_eq!(starts, expected);
        }
    }
}
