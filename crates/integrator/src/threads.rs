//! Islands of contacts solved on several threads.
//!
//! An island is a problem of its own, and a solver's answer depends on nothing but the problem and its start: whichever thread
//! solves it, the impulses are the same to the last bit, with any number of threads. Coupling the contacts, contact laws with
//! phases and what the laws' guards solve again stay on the calling thread.

use crate::stage::Problem;
use crate::{ContactError, WorkCounts, Workspace};
use std::cmp::Reverse;
use std::sync::{Mutex, PoisonError};
use teeter_contact::{ContactSolver, Outcome, Stop};

/// From so many contacts to solve on, threads are started: to start one takes as long as to solve a few contacts.
const WORTH: usize = 128;

/// An island to be solved.
#[derive(Debug, Default)]
pub(crate) struct Job<const D: usize> {
    pub(crate) island: usize,
    pub(crate) problem: Problem<D>,
    outcome: Option<Result<Outcome, ContactError>>,
}

impl<const D: usize> Job<D> {
    /// How it ended.
    ///
    /// # Errors
    /// If its contacts don't make a problem, or the step was abandoned.
    pub(crate) fn take_outcome(&mut self) -> Result<Outcome, ContactError> {
        // It has one unless the step was abandoned before its turn.
        self.outcome.take().unwrap_or(Err(ContactError::Cancelled))
    }

    fn solve(&mut self, solver: &mut dyn ContactSolver<D>, stop: &Stop<'_>, counts: &mut WorkCounts) {
        self.outcome = Some(counts.solve_standard(&mut self.problem, solver, stop));
    }
}

/// The islands of a stage that are solved together, the largest first: what is left at the end is small, and no thread waits
/// long for another.
#[derive(Debug, Default)]
pub(crate) struct Batch<const D: usize> {
    order: Vec<usize>,
    jobs: Vec<Job<D>>,
}

impl<const D: usize> Batch<D> {
    /// Begins a batch of these islands, with their numbers of contacts; the caller fills in the problems.
    pub(crate) fn begin(
        &mut self,
        islands: impl Iterator<Item = usize>,
        size: impl Fn(usize) -> usize,
    ) -> impl Iterator<Item = &mut Job<D>> {
        self.order.clear();
        self.order.extend(islands);
        self.order.sort_unstable_by_key(|island| (Reverse(size(*island)), *island));
        if self.jobs.len() < self.order.len() {
            self.jobs.resize_with(self.order.len(), Job::default);
        }
        for (job, island) in self.jobs.iter_mut().zip(&self.order) {
            (job.island, job.outcome) = (*island, None);
        }
        self.jobs()
    }

    pub(crate) fn jobs(&mut self) -> impl Iterator<Item = &mut Job<D>> {
        self.jobs[..self.order.len()].iter_mut()
    }
}

impl<const D: usize> Workspace<D> {
    /// Lets steps solve islands of contacts on so many threads, at least one, which is the default. The motion is the same to the
    /// last bit. The other threads have [forks](ContactSolver::fork) of [`Workspace::solver`] as it is now, and are started in
    /// each step with enough contacts in more than one island; that allocates.
    pub fn set_threads(&mut self, threads: usize) {
        self.forks.clear();
        self.forks.extend((1..threads).map(|_| self.solver.fork()));
    }

    pub(crate) fn solves_on_threads(&self) -> bool {
        !self.forks.is_empty()
    }

    /// Solves the problems of a batch; `weight` is as in [`Workspace::solve_problem`].
    pub(crate) fn solve_batch(&mut self, batch: &mut Batch<D>, weight: f64) {
        let is_standard = |job: &&mut Job<D>| job.problem.is_standard();
        for job in batch.jobs().filter(|job| !is_standard(job)) {
            job.outcome = Some(self.solve_problem(&mut job.problem, weight));
        }
        let contacts: usize = batch.jobs().filter(is_standard).map(|job| job.problem.len()).sum();
        let cancel = self.cancel.clone();
        let stop = self.settings.stop(cancel.as_deref());
        let queue = Mutex::new(batch.jobs().filter(is_standard));
        let work_off = |solver: &mut dyn ContactSolver<D>, counts: &mut WorkCounts| loop {
            // Nothing can panic while it is locked.
            let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
            match next.filter(|_| !stop.cancelled()) {
                Some(job) => job.solve(solver, &stop, counts),
                None => return,
            }
        };
        let forks = if contacts < WORTH { &mut [][..] } else { &mut self.forks[..] };
        let (own, counts) = (self.solver.as_mut(), &mut self.counts);
        std::thread::scope(|scope| {
            let others: Vec<_> = forks
                .iter_mut()
                .map(|solver| {
                    scope.spawn(|| {
                        let mut counts = WorkCounts::default();
                        work_off(solver.as_mut(), &mut counts);
                        counts
                    })
                })
                .collect();
            work_off(own, counts);
            for other in others {
                match other.join() {
                    Ok(more) => counts.add_solves(&more),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
        });
    }
}
