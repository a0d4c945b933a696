//! A contact solver that is watched: its work is counted, and what it says of its result is checked.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Stop, Vector, judge};

/// What was seen of all solves.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Solved {
    /// Largest residual of a solve that says it converged.
    pub(crate) largest: f64,
    /// Solves whose residual isn't the judge's, or that say they converged and did not.
    pub(crate) dishonest: u64,
    step_solves: u64,
    step_iterations: u64,
}

/// The record that solver and observer share.
#[derive(Clone, Debug, Default)]
pub(crate) struct Watch(Arc<Mutex<Solved>>);

impl Watch {
    fn record(&self) -> MutexGuard<'_, Solved> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// All of it.
    pub(crate) fn total(&self) -> Solved {
        *self.record()
    }

    /// Solves and iterations since it was last asked.
    pub(crate) fn take_step(&self) -> (u64, u64) {
        let mut record = self.record();
        (std::mem::take(&mut record.step_solves), std::mem::take(&mut record.step_iterations))
    }
}

/// The solver with its watch.
pub(crate) struct Watched {
    inner: Box<dyn ContactSolver<2>>,
    watch: Watch,
}

impl Watched {
    pub(crate) fn around(inner: Box<dyn ContactSolver<2>>, watch: &Watch) -> Box<dyn ContactSolver<2>> {
        Box::new(Self { inner, watch: watch.clone() })
    }
}

/// What the judge and a solver may differ by: the rounding of the velocities that it is computed from.
const ROUNDING: f64 = 1e-14;

impl ContactSolver<2> for Watched {
    fn name(&self) -> &'static str {
        self.inner.name()
    }

    fn law(&self) -> Law {
        self.inner.law()
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.inner.reserve(contacts, blocks);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector<2>]) -> Outcome {
        let outcome = self.inner.solve(problem, stop, p);
        let judged = judge(problem, p).global;
        let claimed = outcome.residual.global;
        // Written so that NaN is dishonest.
        let same = (judged - claimed).abs() <= 0.01 * claimed + ROUNDING;
        let kept = !outcome.converged() || judged <= stop.tolerance + ROUNDING;
        let mut record = self.watch.record();
        record.step_solves += 1;
        record.step_iterations += u64::from(outcome.iterations);
        record.dishonest += u64::from(!(same && kept));
        if outcome.converged() {
            record.largest = record.largest.max(judged);
        }
        drop(record);
        outcome
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Self::around(self.inner.fork(), &self.watch)
    }
}
