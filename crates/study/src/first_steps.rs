//! What a run costs, from the time of its first steps.
//!
//! Of a scene of many contacts no formula tells the time: a step of a tower of 1000 blocks takes 2 ms
//! where its first one has taken 2.7 s, and one of a wall of 500 bricks takes 5 or 110 ms by the
//! tolerance. So some steps are taken, as the run would take them.

use cpu_time::ThreadTime;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;
use teeter_scenario::simulation::Simulation;

/// CPU time of the steps after the first that is spent on measuring, s.
const BUDGET: f64 = 0.3;

/// Time after which all is abandoned, a step within its contact problems too, s: often the first
/// step is by far the longest.
const MOST: f64 = 10.0;

/// The first steps of a run, measured.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FirstSteps {
    /// How many were taken; 0 if the first one takes longer than is spent on measuring.
    pub steps: u64,
    /// CPU time of the first one, s.
    pub first: f64,
    /// CPU time of each of the others: the mean of their second half, s.
    pub each: f64,
    /// Contacts in the last of them.
    pub contacts: usize,
    /// Steps of the whole run.
    of: u64,
    /// CPU time of all that were taken, s.
    taken: f64,
}

impl FirstSteps {
    /// Takes the first steps of a simulation, as many as some tenths of a second allow.
    #[must_use]
    pub fn measured(simulation: &mut Simulation) -> Self {
        let cancel = Arc::new(AtomicBool::new(false));
        simulation.cancelled_by(Arc::clone(&cancel));
        let (done, over) = mpsc::channel::<()>();
        std::thread::scope(|scope| {
            let cancel = &cancel;
            scope.spawn(move || {
                if over.recv_timeout(Duration::from_secs_f64(MOST)) == Err(RecvTimeoutError::Timeout) {
                    cancel.store(true, Ordering::Relaxed);
                }
            });
            let measured = Self::take(simulation);
            drop(done);
            measured
        })
    }

    fn take(simulation: &mut Simulation) -> Self {
        let of = simulation.plan.steps_from(&simulation.state);
        let clock = ThreadTime::now();
        let (mut ends, mut contacts) = (Vec::new(), 0);
        while (ends.len() as u64) < of {
            // A step that was abandoned, or one that can't be taken, which the run will tell.
            let Ok(step) = simulation.step() else { break };
            contacts = step.contacts().count();
            let end = clock.elapsed().as_secs_f64();
            ends.push(end);
            if end - ends[0] > BUDGET {
                break;
            }
        }
        Self::of(&ends, contacts, of)
    }

    /// From the times at which steps ended, s.
    fn of(ends: &[f64], contacts: usize, of: u64) -> Self {
        let first = ends.first().copied().unwrap_or_default();
        let taken = ends.last().copied().unwrap_or_default();
        let later = ends.len().saturating_sub(1);
        // The steps soon after the first are not yet like the rest.
        let half = later.div_ceil(2);
        let each = if half > 0 { (taken - ends[later - half]) / half as f64 } else { first };
        Self { steps: ends.len() as u64, first, each, contacts, of, taken }
    }

    /// Whether these are all steps of the run.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.steps == self.of
    }

    /// CPU time of the whole run if its other steps are like these, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.taken + (self.of - self.steps) as f64 * self.each
    }

    /// The same if the other steps take so long instead (s), but no less than these.
    #[must_use]
    pub fn seconds_with(&self, each: f64) -> f64 {
        self.taken + (self.of - self.steps) as f64 * each.max(self.each)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_step_counts_once_and_the_others_as_those_measured_last() {
        let steps = FirstSteps::of(&[2.0, 2.5, 2.75, 3.0, 3.25], 7, 105);
        assert_eq!((steps.steps, steps.first, steps.each, steps.contacts), (5, 2.0, 0.25, 7));
        assert_eq!((steps.seconds(), steps.seconds_with(1.0), steps.seconds_with(0.1)), (28.25, 103.25, 28.25));
        let whole = FirstSteps::of(&[2.0, 2.5], 7, 2);
        assert!(whole.is_whole() && !steps.is_whole());
        assert_eq!((whole.seconds(), whole.seconds_with(9.0)), (2.5, 2.5));
        let one = FirstSteps::of(&[2.0], 7, 10);
        assert_eq!((one.each, one.seconds()), (2.0, 20.0));
        assert_eq!(FirstSteps::of(&[], 0, 10).steps, 0);
    }
}
