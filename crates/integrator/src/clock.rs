//! Time as a count of steps, not a sum, as long as the step size stays the same.

/// The steps of one size so far: t = base + (step − from) · dt. So a fixed step from 0 gives t_k =
/// k·dt exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Clock {
    /// Time of the first of these steps, s.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    base: f64,
    /// Its number.
    from: u64,
    /// Their size, s.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    dt: f64,
}

impl Clock {
    /// The clock of steps of size `dt` (s) from t = 0.
    pub(crate) fn new(dt: f64) -> Self {
        Self { base: 0.0, from: 0, dt }
    }

    /// The time after `step` steps, s.
    pub(crate) fn at(&self, step: u64) -> f64 {
        self.base + (step - self.from) as f64 * self.dt
    }

    /// The clock for a step that begins at `t` (s) as step number `step` and takes `dt`: this one
    /// as long as it agrees with these, otherwise one that begins there. So time is right even if a
    /// caller has changed them.
    #[must_use]
    pub(crate) fn going_on(self, step: u64, t: f64, dt: f64) -> Self {
        if step >= self.from && dt == self.dt && self.at(step) == t { self } else { Self { base: t, from: step, dt } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fixed_step_is_counted_and_not_summed() {
        let (h, mut t) = (1e-4, 0.0);
        let mut clock = Clock::new(h);
        for step in 0..100_000 {
            clock = clock.going_on(step, t, h);
            t = clock.at(step + 1);
            assert_eq!(t, (step + 1) as f64 * h);
        }
    }

    #[test]
    fn another_step_size_goes_on_from_the_time_that_it_is() {
        let clock = Clock::new(1e-3).going_on(100, 0.1, 2e-5);
        assert_eq!((clock.at(100), clock.at(101), clock.at(110)), (0.1, 0.1 + 2e-5, 0.1 + 10.0 * 2e-5));
        // And back.
        let back = clock.going_on(110, clock.at(110), 1e-3);
        assert_eq!(back.at(111), clock.at(110) + 1e-3);
    }

    #[test]
    fn a_time_or_a_number_that_was_changed_is_taken_as_it_is() {
        let clock = Clock::new(1e-3);
        assert_eq!(clock.going_on(3, 7.0, 1e-3).at(4), 7.0 + 1e-3);
        let later = clock.going_on(10, 7.0, 1e-3);
        assert_eq!(later.going_on(2, 7.0, 1e-3).at(3), 7.0 + 1e-3, "a number before the clock's own");
    }
}
