//! The methods that `auto` goes through, cheap ones first, until the judge is satisfied.
//!
//! 1. **Gauss–Seidel** ([`Pgs`]): some sweeps, and more as long as the rate at which the residual
//!    falls says that it arrives before Newton would.
//! 2. **Pairs** (`pairs.rs`): where that left little, but contacts hold a body twice, sweeps over
//!    pairs of them.
//! 3. **Alternating directions** ([`Admm`](crate::Admm), feature `sparse`) where rows of H are
//!    long: factors fill in there, and this takes one or two where Newton takes ten.
//! 4. **Semi-smooth Newton** ([`Newton`]): a round of steps from there; where they fail, more
//!    sweeps for about the same work, and another round, a few times.
//! 5. **Pivots** ([`Lemke`](crate::Lemke)), in the plane and up to some hundred contacts: where
//!    blocks lean on each other, contacts that press against each other without end leave all that
//!    goes by the residual at about 1e-10; pivots are exact.
//! 6. **The central path** ([`Smoothing`]): for what is degenerate.
//! 7. **The proximal point** ([`Prox`]), Newton with more sweeps between its steps, and sweeps
//!    until the iterations run out.
//!
//! What decides is counted work (blocks, block products), never time: the same problem takes the
//! same way on every machine.
//!
//! A problem of a few contacts is solved further than asked, towards 1e-14: it costs little there,
//! and the motion of a few blocks is then as exact as an enumerated one.

#[cfg(feature = "sparse")]
use crate::Admm;
use crate::ending::ended;
use crate::memory::reserve;
use crate::pairs::{Pairs, Small};
use crate::{Newton, Pgs, Prox, Smoothing};
use teeter_contact::{ContactProblem, ContactSolver, Outcome, Status, Stop, Vector, judge};

/// Up to so many contacts a solution is polished, to this residual.
const SMALL: usize = 12;
const POLISHED: f64 = 1e-14;
/// More of them are polished to this part of the tolerance where the factors of H have no more than
/// so many times its blocks, as along a stack: what rests then starts every step from a solution,
/// and what the tolerance leaves doesn't add up over the steps.
const PART: f64 = 1e-3;
const FILL: usize = 4;
/// Sweeps of the first two batches; the rate comes from the second.
const FIRST: u32 = 12;
/// Rounds of Newton steps, each after a batch of sweeps; and for each, the work in Newton steps
/// within which Gauss–Seidel must be expected to arrive to go on instead. After the last round
/// comes the central path, which takes tens of steps.
const WORTH: [f64; 4] = [4.0, 8.0, 16.0, 40.0];
/// Impulses that are right to this residual after the first sweeps may want sweeps over pairs.
const NEARLY: f64 = 1e-4;
/// Work of a Newton step and of a sweep in one measure (times a block product): per block of the
/// factors and per contact. Measured on the published problems; a factor of two either way changes
/// no choice among them that matters.
const STEP_BLOCK: f64 = 1.3;
const STEP_CONTACT: f64 = 16.0;
const SWEEP_BLOCK: f64 = 0.4;
const SWEEP_CONTACT: f64 = 5.0;

/// Up to so many contacts Lemke's tableau is no more work than what it spares.
const PIVOTED: usize = 200;

/// Lemke's method, in the plane.
pub(crate) type Pivots<'a, const D: usize> = Option<&'a mut dyn ContactSolver<D>>;

/// From so many contacts with so many blocks a row on, alternating directions come before Newton;
/// and their iterations.
#[cfg(feature = "sparse")]
const MANY: usize = 64;
#[cfg(feature = "sparse")]
const LONG_ROW: usize = 16;
#[cfg(feature = "sparse")]
const DIRECTIONS: u32 = 300;

#[derive(Debug, Default)]
pub(crate) struct Chain<const D: usize> {
    pgs: Pgs<D>,
    pairs: Pairs<D>,
    #[cfg(feature = "sparse")]
    admm: Admm<D>,
    newton: Newton<D>,
    smoothing: Smoothing<D>,
    prox: Prox<D>,
    best: Vec<Vector<D>>,
}

/// The outcome so far: of the best impulses, with the iterations of all.
struct Progress {
    best: Outcome,
    iterations: u32,
}

impl Progress {
    /// Counts a stage's iterations and takes its outcome if it is better.
    fn add(&mut self, outcome: Outcome) {
        self.iterations = self.iterations.saturating_add(outcome.iterations);
        if outcome.residual.global < self.best.residual.global || outcome.converged() {
            self.best = outcome;
        }
    }

    /// The outcome of the whole, for the impulses that are left: how a stage ended within its own
    /// limits is not how the solve ended.
    fn end<const D: usize>(&self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &[Vector<D>]) -> Outcome {
        if self.best.converged() {
            return Outcome::new(Status::Converged, self.best.used, self.iterations, self.best.residual);
        }
        let residual = judge(problem, p);
        let status = ended(stop, self.iterations, &residual);
        Outcome::new(status, self.best.used, self.iterations, residual)
    }

    fn left(&self, stop: &Stop<'_>) -> u32 {
        stop.max_iterations.saturating_sub(self.iterations)
    }

    fn over(&self, stop: &Stop<'_>) -> bool {
        self.best.converged() || self.left(stop) == 0 || stop.cancelled()
    }
}

impl<const D: usize> Chain<D> {
    pub(crate) fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.pgs.reserve(contacts, blocks);
        self.pairs.reserve(contacts);
        #[cfg(feature = "sparse")]
        self.admm.reserve(contacts, blocks);
        self.newton.reserve(contacts, blocks);
        self.smoothing.reserve(contacts, blocks);
        self.prox.reserve(contacts, blocks);
        reserve(&mut self.best, contacts);
    }

    /// `small` solves a few contacts exactly.
    pub(crate) fn solve(
        &mut self,
        problem: &ContactProblem<'_, D>,
        small: Small<D>,
        pivots: Pivots<'_, D>,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
    ) -> Outcome {
        let mut outcome = self.approach(problem, small, pivots, stop, p);
        let few = p.len() <= SMALL;
        let goal = if few { POLISHED } else { POLISHED.max(PART * stop.tolerance) };
        if outcome.converged() && outcome.residual.global > goal {
            let work = self.newton.prepare(problem);
            if !few && work.filled > FILL * work.blocks {
                return outcome;
            }
            self.best.clear();
            self.best.extend_from_slice(p);
            let left = stop.max_iterations.saturating_sub(outcome.iterations);
            let polish = stop.with_tolerance(goal).with_max_iterations(left);
            let polished = self.newton.round(problem, &polish, p);
            outcome.iterations = outcome.iterations.saturating_add(polished.iterations);
            if polished.residual.global < outcome.residual.global {
                (outcome.residual, outcome.used) = (polished.residual, polished.used);
            } else {
                p.copy_from_slice(&self.best);
            }
        }
        outcome
    }

    fn approach(
        &mut self,
        problem: &ContactProblem<'_, D>,
        small: Small<D>,
        pivots: Pivots<'_, D>,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
    ) -> Outcome {
        let within = |left: u32, most: u32| stop.with_max_iterations(left.min(most));
        let first = self.pgs.solve(problem, &within(stop.max_iterations, FIRST), p);
        let mut progress = Progress { best: first, iterations: first.iterations };
        if !progress.over(stop)
            && first.residual.global < NEARLY
            && let Some(outcome) = self.pairs.solve(problem, small, &within(progress.left(stop), u32::MAX), p)
        {
            progress.add(outcome);
        }
        #[cfg(feature = "sparse")]
        if !progress.over(stop) && has_long_rows(problem) {
            let outcome = self.admm.solve(problem, &within(progress.left(stop), DIRECTIONS), p);
            progress.add(outcome);
        }
        if !progress.over(stop) {
            self.sweeps_and_steps(problem, stop, p, &mut progress);
        }
        if !progress.over(stop)
            && p.len() <= PIVOTED
            && let Some(pivots) = pivots
        {
            self.best.clear();
            self.best.extend_from_slice(p);
            let outcome = pivots.solve(problem, &within(progress.left(stop), u32::MAX), p);
            if !(outcome.residual.global < progress.best.residual.global) {
                p.copy_from_slice(&self.best);
            }
            progress.add(outcome);
        }
        if !progress.over(stop) {
            let outcome = self.smoothing.solve(problem, &within(progress.left(stop), u32::MAX), p);
            progress.add(outcome);
        }
        if !progress.over(stop) {
            let outcome = self.prox.solve(problem, &within(progress.left(stop), u32::MAX), p);
            progress.add(outcome);
        }
        if !progress.over(stop) {
            let outcome = self.newton.solve(problem, &within(progress.left(stop), u32::MAX), p);
            progress.add(outcome);
        }
        if !progress.over(stop) {
            let outcome = self.pgs.solve(problem, &within(progress.left(stop), u32::MAX), p);
            progress.add(outcome);
        }
        progress.end(problem, stop, p)
    }

    fn sweeps_and_steps(
        &mut self,
        problem: &ContactProblem<'_, D>,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
        progress: &mut Progress,
    ) {
        let within = |left: u32, most: u32| stop.with_max_iterations(left.min(most));
        // Sweeps that cost as much as a Newton step.
        let mut ratio = None;
        let mut batch = FIRST;
        for (round, worth) in WORTH.into_iter().enumerate() {
            let before = progress.best.residual.global;
            let outcome = self.pgs.solve(problem, &within(progress.left(stop), batch), p);
            let swept = outcome.iterations.max(1);
            progress.add(outcome);
            if progress.over(stop) {
                return;
            }
            let work = *ratio.get_or_insert_with(|| {
                let (n, work) = (problem.contacts() as f64, self.newton.prepare(problem));
                let step = work.products as f64 + STEP_BLOCK * work.filled as f64 + STEP_CONTACT * n;
                (step / (SWEEP_BLOCK * work.blocks as f64 + SWEEP_CONTACT * n)).max(1.0)
            });
            let after = progress.best.residual.global;
            let rate = (after / before).ln() / f64::from(swept);
            let expected = (stop.tolerance / after).ln() / rate;
            // Written so that a rate that is no number doesn't count.
            if rate < 0.0 && expected < worth * work {
                let most = ((1.5 * expected) as u32).saturating_add(FIRST);
                progress.add(self.pgs.solve(problem, &within(progress.left(stop), most), p));
                if progress.over(stop) {
                    return;
                }
            }
            progress.add(self.newton.round(problem, &within(progress.left(stop), u32::MAX), p));
            if progress.over(stop) {
                return;
            }
            batch = ((2.0 * work) as u32).saturating_mul(1 << round).saturating_add(FIRST);
        }
    }
}

/// Whether the rows of H hold so many blocks that factors of it would fill in.
#[cfg(feature = "sparse")]
fn has_long_rows<const D: usize>(problem: &ContactProblem<'_, D>) -> bool {
    let n = problem.contacts();
    let blocks = problem.nonzero_blocks().unwrap_or(0);
    n >= MANY && blocks >= LONG_ROW * n
}
