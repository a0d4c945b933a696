//! Sums of signals.

use super::{Moments, Signal};
use std::sync::Arc;

/// A sum of signals, each times a factor. Everything about it is linear in its terms, so it is as
/// exact as they are.
///
/// ```
/// use std::sync::Arc;
/// use teeter_integrator::{Formula, Signal, Sum};
///
/// let (slow, fast) = (Formula::harmonic(0.0, 1.0, 0.0)?, Formula::harmonic(0.0, 7.0, 0.0)?);
/// let both = Sum::new(vec![(1.0, Arc::new(slow)), (0.2, Arc::new(fast))]);
/// assert_eq!(both.value(0.1), slow.value(0.1) + 0.2 * fast.value(0.1));
/// # Ok::<(), teeter_integrator::SignalError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Sum {
    terms: Vec<(f64, Arc<dyn Signal>)>,
}

impl Sum {
    /// The sum of these signals times their factors; 0 without any.
    #[must_use]
    pub fn new(terms: Vec<(f64, Arc<dyn Signal>)>) -> Self {
        Self { terms }
    }

    fn of(&self, part: impl Fn(&dyn Signal) -> f64) -> f64 {
        self.terms.iter().map(|(factor, signal)| factor * part(signal.as_ref())).sum()
    }
}

impl Signal for Sum {
    fn value(&self, t: f64) -> f64 {
        self.of(|signal| signal.value(t))
    }

    fn rate(&self, t: f64) -> f64 {
        self.of(|signal| signal.rate(t))
    }

    fn second_rate(&self, t: f64) -> f64 {
        self.of(|signal| signal.second_rate(t))
    }

    fn integral(&self, t: f64) -> f64 {
        self.of(|signal| signal.integral(t))
    }

    fn double_integral(&self, t: f64) -> f64 {
        self.of(|signal| signal.double_integral(t))
    }

    fn mean(&self, from: f64, to: f64) -> f64 {
        self.of(|signal| signal.mean(from, to))
    }

    fn mean_rate(&self, from: f64, to: f64) -> f64 {
        self.of(|signal| signal.mean_rate(from, to))
    }

    fn mean_integral(&self, from: f64, to: f64) -> f64 {
        self.of(|signal| signal.mean_integral(from, to))
    }

    fn moments(&self, from: f64, to: f64) -> Moments {
        let mut sum = [0.0; 4];
        for (factor, signal) in &self.terms {
            sum.iter_mut().zip(signal.moments(from, to)).for_each(|(sum, moment)| *sum += factor * moment);
        }
        sum
    }

    fn jump(&self) -> Option<f64> {
        let jumps = self.terms.iter().filter(|(factor, _)| *factor != 0.0).filter_map(|(_, signal)| signal.jump());
        jumps.min_by(f64::total_cmp)
    }

    fn shortest_period(&self) -> f64 {
        self.terms.iter().map(|(_, signal)| signal.shortest_period()).fold(f64::INFINITY, f64::min)
    }

    fn next_break(&self, t: f64) -> f64 {
        self.terms.iter().map(|(_, signal)| signal.next_break(t)).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::check;
    use super::super::{Chirp, Formula, Growth, Table};
    use super::*;

    #[test]
    fn integrals_and_rates_are_those_of_the_value() {
        let signal = |signal: Result<Formula, _>| -> Arc<dyn Signal> { Arc::new(signal.unwrap()) };
        let table = Table::new(vec![0.2, 0.7, 1.3], vec![0.0, 2.0, -1.0]).unwrap();
        let chirp = Chirp::new(0.5, 1.0, [1.0, 5.0], 0.4, Growth::Linear).unwrap();
        let sum = Sum::new(vec![
            (2.5, signal(Formula::harmonic(0.1, 1.3, 0.4))),
            (-1.0, signal(Formula::ramp(0.3, 0.6))),
            (0.5, Arc::new(table)),
            (-0.7, Arc::new(chirp)),
        ]);
        check(&sum, &[0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.3, 1.5], 2.0);
        assert_eq!(sum.jump(), Some(0.1));
    }

    #[test]
    fn opposite_terms_leave_nothing() {
        let sine: Arc<dyn Signal> = Arc::new(Formula::harmonic(0.1, 1.3, 0.4).unwrap());
        let none = Sum::new(vec![(2.0, Arc::clone(&sine)), (-2.0, sine)]);
        let means = [none.mean(0.2, 0.3), none.mean_rate(0.2, 0.3), none.mean_integral(0.2, 0.3)];
        assert_eq!((none.moments(0.0, 0.7), means), ([0.0; 4], [0.0; 3]));
        assert_eq!([none.value(0.5), none.rate(0.5), none.integral(0.5), none.double_integral(0.5)], [0.0; 4]);
    }
}
