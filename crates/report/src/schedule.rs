//! Which steps become rows.

use serde::{Deserialize, Serialize};

/// The rows of a run: t = 0, then the first step at or past each multiple of the interval, and the last step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Schedule {
    every: Option<f64>,
    stride: u64,
    steps: u64,
    dt: f64,
    /// Number of the next multiple to be reached.
    next: u64,
}

/// Rows of a run without an interval: every step up to here, thinned evenly past that.
const ROWS: u64 = 10_000;

/// A time this part of a step before a multiple counts as at it: k·dt and j·every are rounded differently.
const ROUNDING: f64 = 1e-6;

impl Schedule {
    /// Rows `every` seconds of a run of `steps` steps of `dt`; without an interval, some 10 000 rows.
    #[must_use]
    pub fn new(every: Option<f64>, steps: u64, dt: f64) -> Self {
        Self { every, stride: steps.div_ceil(ROWS).max(1), steps, dt, next: 1 }
    }

    /// The same for a run whose first state is that after `step` steps.
    #[must_use]
    pub fn starting_at(mut self, step: u64) -> Self {
        self.stride = self.steps.saturating_sub(step).div_ceil(ROWS).max(1);
        if let Some(every) = self.every {
            self.next = self.reached(step as f64 * self.dt, every) as u64 + 1;
        }
        self
    }

    /// Multiples of the interval up to a time.
    fn reached(&self, t: f64, every: f64) -> f64 {
        ((t + ROUNDING * self.dt) / every).floor()
    }

    /// Whether the end of a step is a row; to be asked once for every step, in order.
    pub fn takes(&mut self, step: u64, t: f64) -> bool {
        let due = match self.every {
            None => step.is_multiple_of(self.stride),
            Some(every) => {
                let reached = self.reached(t, every);
                let due = reached >= self.next as f64;
                if due {
                    self.next = reached as u64 + 1;
                }
                due
            }
        };
        due || step == self.steps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(every: Option<f64>, steps: u64, dt: f64) -> Vec<u64> {
        let mut schedule = Schedule::new(every, steps, dt);
        (1..=steps).filter(|&k| schedule.takes(k, k as f64 * dt)).collect()
    }

    #[test]
    fn a_multiple_of_the_step_gives_even_rows() {
        let rows = rows(Some(1e-3), 5000, 1e-4);
        assert_eq!(rows.len(), 500);
        assert!(rows.iter().all(|k| k % 10 == 0));
    }

    #[test]
    fn an_odd_interval_takes_the_first_step_at_or_past_each_multiple() {
        assert_eq!(rows(Some(0.25), 10, 0.1), [3, 5, 8, 10]);
        assert_eq!(rows(Some(0.05), 4, 0.1), [1, 2, 3, 4]);
        assert_eq!(rows(Some(100.0), 4, 0.1), [4], "the last always");
    }

    #[test]
    fn a_run_that_starts_later_has_the_rows_of_one_from_the_beginning() {
        for start in 0..10 {
            let mut schedule = Schedule::new(Some(0.25), 10, 0.1).starting_at(start);
            let later: Vec<u64> = (start + 1..=10).filter(|&k| schedule.takes(k, k as f64 * 0.1)).collect();
            let all = rows(Some(0.25), 10, 0.1);
            assert_eq!(later, all.into_iter().filter(|k| *k > start).collect::<Vec<_>>(), "from {start}");
        }
    }

    #[test]
    fn without_an_interval_long_runs_are_thinned_evenly() {
        assert_eq!(rows(None, 10_000, 0.1).len(), 10_000);
        let thinned = rows(None, 10_001, 0.1);
        assert_eq!((thinned[0], thinned[1], thinned.len()), (2, 4, 5001));
        assert_eq!(*thinned.last().unwrap(), 10_001);
    }
}
