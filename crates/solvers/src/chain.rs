//! The sequence of methods that `auto` tries, cheap ones first, until one converges.
//!
//! 1. **Gauss–Seidel** ([`Pgs`]): some sweeps, and more as long as their convergence rate predicts
//!    less work than Newton's method; many for a crowd of plane contacts and a loose tolerance.
//! 2. **Accelerated gradients** ([`Apgd`]) for hundreds of plane contacts and a loose tolerance.
//! 3. **Pairs** (`pairs.rs`): if the residual is small but some bodies are constrained twice
//!    (hyperstatic), sweeps over pairs of contacts.
//! 4. **Alternating directions** ([`Admm`](crate::Admm), feature `sparse`) if H has long rows, so
//!    that factors fill in: this needs one or two factorisations where Newton needs ten.
//! 5. **Semi-smooth Newton** ([`Newton`]): a round of steps; if they fail, more sweeps of about the
//!    same work and another round, a few times.
//! 6. **Pivots from a near-solution** (`crossover.rs`), if there are many contacts in the plane: a
//!    crowd. If they fail, **a short central path, alternating directions** with Newton steps from
//!    where they end, **and a longer path**, with pivots again from where one of these has come nearer.
//!    A large crowd with a loose tolerance has pivots last only; one with a small tolerance ends here.
//! 7. **Pivots** ([`Lemke`](crate::Lemke)), in the plane for up to some hundred contacts. If blocks
//!    lean on each other, the contact forces may be nearly undetermined, and methods that follow
//!    the residual stop at about 1e-10; pivoting is exact.
//! 8. **The central path** ([`Smoothing`]): for degenerate problems.
//! 9. **The proximal point** ([`Prox`]), Newton with more sweeps between its steps, and sweeps
//!    until the iterations are used up.
//!
//! Decisions depend on counted work (blocks, block products), never on time, so the same problem
//! takes the same path on every machine.
//!
//! A problem of a few contacts is solved beyond the tolerance, towards 1e-14: this costs little,
//! and the motion of a few blocks is then as exact as with enumeration.

#[cfg(feature = "sparse")]
use crate::Admm;
use crate::ending::ended;
use crate::memory::reserve;
use crate::pairs::{Pairs, Small};
use crate::{Apgd, Newton, Pgs, Prox, Smoothing};
use teeter_contact::{ContactProblem, ContactSolver, Outcome, Status, Stop, Vector, judge};

/// Up to `SMALL` contacts a solution is refined to the residual `REFINED`.
const SMALL: usize = 12;
const REFINED: f64 = 1e-14;
/// Larger problems are refined to this part of the tolerance if the factors of H have at most
/// `FILL` times its blocks, as for a stack. A structure at rest then starts every step from a
/// solution, and errors within the tolerance don't accumulate.
const REFINED_PART: f64 = 1e-3;
const FILL: usize = 4;
/// Sweeps in each of the first two batches; the rate is measured in the second.
const FIRST_SWEEPS: u32 = 12;
/// For each round of Newton steps: Gauss–Seidel continues instead if its predicted work is below
/// this number of Newton steps. After the last round comes the central path, which takes tens of
/// steps.
const WORTHWHILE_WORK: [f64; 4] = [4.0, 8.0, 16.0, 40.0];
const ALL_ROUNDS: usize = WORTHWHILE_WORK.len();
/// More plane contacts than `CROWD` in one island are a crowd. After `CROWD_ROUNDS` such rounds, a
/// central path of `SHORT_PATH` steps, `CROWD_DIRECTIONS` iterations of alternating directions, and a
/// path of `LONG_PATH` steps come before pivots, whose work grows with the cube of the contacts; and
/// there are no last sweeps where there are pivots. Found on the collisions of a pile of polygons (`benches/pile`), where
/// more than half of the problems that the first rounds leave went to the pivots, at ten times the
/// time (`benches/results/2026-11-25-many-bodies.md`).
const CROWD: usize = 40;
const CROWD_ROUNDS: usize = 2;
const SHORT_PATH: u32 = 100;
#[cfg(feature = "sparse")]
const CROWD_DIRECTIONS: u32 = 200;
const LONG_PATH: u32 = 400;
/// From a residual of `NEAR` on, a crowd is given to pivots from there (`crossover.rs`),
/// and again when the residual is `NEARER` times that.
const NEAR: f64 = 1e-4;
const NEARER: f64 = 0.1;
/// Most pivots of these tries, and of the last one. From the hardest problems of a pile of 300 stones,
/// 1500 solve as many as 3000 do.
const TRIED: u32 = 400;
const LAST_TRIED: u32 = 1500;
/// At a tolerance of `LOOSE` or more, plane islands of more than `LARGE` contacts are given to
/// `GRADIENTS` accelerated gradients first: in a wall of 500 bricks that is shaken they reach 1e-6
/// four times sooner than Newton's method. Towards 1e-10 they converge too slowly.
const LARGE: usize = 200;
const LOOSE: f64 = 1e-8;
const GRADIENTS: u32 = 400;
/// At a tolerance of `ROUGH` or more a crowd is given to `ROUGH_SWEEPS` sweeps first. Of 1953 problems of
/// more than 40 contacts of a pile of 300 stones they solve all to 1e-4, in a third to a half of the time
/// that other methods take, and 95 of 100 to 1e-5, as quickly as these.
const ROUGH: f64 = 1e-5;
const ROUGH_SWEEPS: u32 = 3000;
/// A crowd that the last step's impulses nearly solve, as at rest, is given `SWEEPS_AT_REST` more sweeps
/// towards `AT_REST` times the tolerance. Each step starts where the one before ended, so that the residual of
/// a heap of stones falls to that within some steps, and the stones lie still: what the
/// tolerance leaves to each step would shake them for ever, and open and close contacts.
const AT_REST: f64 = 1e-8;
const SWEEPS_AT_REST: u32 = 20;
/// Sweeps over pairs are tried if the first sweeps reach this residual.
const NEARLY: f64 = 1e-4;
/// StepWork of a Newton step and of a sweep in units of a block product: per block and per contact.
/// Measured on the published problems; a factor of two either way changes no important choice.
const STEP_BLOCK: f64 = 1.3;
const STEP_CONTACT: f64 = 16.0;
const SWEEP_BLOCK: f64 = 0.4;
const SWEEP_CONTACT: f64 = 5.0;

/// Largest number of contacts for which Lemke's tableau is worth its work.
const MOST_PIVOTED: usize = 200;

/// The pivoting methods, which are for the plane.
pub(crate) struct Pivots<'a, const D: usize> {
    pub(crate) lemke: &'a mut dyn ContactSolver<D>,
    pub(crate) crossover: &'a mut dyn ContactSolver<D>,
}

impl<const D: usize> Pivots<'_, D> {
    /// A shorter borrow.
    pub(crate) fn borrow(&mut self) -> Pivots<'_, D> {
        Pivots { lemke: self.lemke, crossover: self.crossover }
    }
}

/// From `MANY` contacts with `LONG_ROW` blocks per row on, alternating directions come before
/// Newton, with `DIRECTIONS` iterations.
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
    apgd: Apgd<D>,
    best: Vec<Vector<D>>,
}

/// The outcome so far: that of the best impulses, with the iterations of all methods.
struct Progress {
    best: Outcome,
    iterations: u32,
}

impl Progress {
    /// Adds the iterations of a stage and takes its outcome if it is better.
    fn add(&mut self, outcome: Outcome) {
        self.iterations = self.iterations.saturating_add(outcome.iterations);
        if outcome.residual.global < self.best.residual.global || outcome.converged() {
            self.best = outcome;
        }
    }

    /// The outcome of the solve for the final impulses. A stage has its own limits, so its status
    /// isn't that of the solve.
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
        self.apgd.reserve(contacts, blocks);
        reserve(&mut self.best, contacts);
    }

    /// Solves a problem; `small` solves a few contacts exactly.
    pub(crate) fn solve(
        &mut self,
        problem: &ContactProblem<'_, D>,
        small: Small<D>,
        pivots: Option<Pivots<'_, D>>,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
    ) -> Outcome {
        let mut outcome = self.approach(problem, small, pivots, stop, p);
        if is_rough(problem, stop) {
            if outcome.converged() && outcome.iterations <= FIRST_SWEEPS {
                let left = stop.max_iterations.saturating_sub(outcome.iterations).min(SWEEPS_AT_REST);
                let further = stop.with_tolerance(AT_REST * stop.tolerance).with_max_iterations(left);
                // It returns the best impulses that it meets, the start among them.
                let refined = self.pgs.solve(problem, &further, p);
                outcome.iterations = outcome.iterations.saturating_add(refined.iterations);
                outcome.residual = refined.residual;
            }
            return outcome;
        }
        let few = p.len() <= SMALL;
        let goal = if few { REFINED } else { REFINED.max(REFINED_PART * stop.tolerance) };
        // There a refinement pays only at rest, where the last step's impulses nearly solve the problem.
        let moves = suits_gradients(problem, stop) && outcome.iterations > FIRST_SWEEPS;
        if outcome.converged() && outcome.residual.global > goal && !moves {
            let work = self.newton.prepare(problem);
            if !few && work.filled > FILL * work.blocks {
                return outcome;
            }
            self.best.clear();
            self.best.extend_from_slice(p);
            let left = stop.max_iterations.saturating_sub(outcome.iterations);
            let refinement = stop.with_tolerance(goal).with_max_iterations(left);
            let refined = self.newton.round(problem, &refinement, p);
            outcome.iterations = outcome.iterations.saturating_add(refined.iterations);
            if refined.residual.global < outcome.residual.global {
                (outcome.residual, outcome.used) = (refined.residual, refined.used);
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
        mut pivots: Option<Pivots<'_, D>>,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
    ) -> Outcome {
        let within = |left: u32, most: u32| stop.with_max_iterations(left.min(most));
        let sweeps = if is_rough(problem, stop) { ROUGH_SWEEPS } else { FIRST_SWEEPS };
        let first = self.pgs.solve(problem, &within(stop.max_iterations, sweeps), p);
        let mut progress = Progress { best: first, iterations: first.iterations };
        if !progress.over(stop) && suits_gradients(problem, stop) {
            progress.add(self.apgd.solve(problem, &within(progress.left(stop), GRADIENTS), p));
        }
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
        let mut crowd = pivots.as_mut().map(Pivots::borrow).filter(|_| p.len() > CROWD);
        if !progress.over(stop) {
            let rounds = if crowd.is_some() { CROWD_ROUNDS } else { ALL_ROUNDS };
            self.sweeps_and_steps(problem, rounds, stop, p, &mut progress);
        }
        let crowded = crowd.is_some();
        if let Some(pivots) = &mut crowd {
            self.crowd(problem, pivots.crossover, stop, p, &mut progress);
        }
        if !progress.over(stop)
            && p.len() <= MOST_PIVOTED
            && let Some(pivots) = pivots
        {
            self.best.clear();
            self.best.extend_from_slice(p);
            let outcome = pivots.lemke.solve(problem, &within(progress.left(stop), u32::MAX), p);
            if !(outcome.residual.global < progress.best.residual.global) {
                p.copy_from_slice(&self.best);
            }
            progress.add(outcome);
        }
        // The path of a crowd has been followed.
        if !progress.over(stop) && !crowded {
            let outcome = self.smoothing.solve(problem, &within(progress.left(stop), u32::MAX), p);
            progress.add(outcome);
        }
        // Pivots that haven't reached a small tolerance from nearby are followed by nothing that does.
        let near = progress.best.residual.global < NEAR;
        if crowded && near && p.len() > MOST_PIVOTED && stop.tolerance < LOOSE {
            return progress.end(problem, stop, p);
        }
        if !progress.over(stop) {
            let outcome = self.prox.solve(problem, &within(progress.left(stop), u32::MAX), p);
            progress.add(outcome);
        }
        if !progress.over(stop) {
            let outcome = self.newton.solve(problem, &within(progress.left(stop), u32::MAX), p);
            progress.add(outcome);
        }
        // A crowd had pivots instead.
        if !progress.over(stop) && !crowded {
            let outcome = self.pgs.solve(problem, &within(progress.left(stop), u32::MAX), p);
            progress.add(outcome);
        }
        progress.end(problem, stop, p)
    }

    /// A short central path; alternating directions, with Newton steps from where they end, as they
    /// find which contacts slide and open; and a longer path, with other regularisations. In between, pivots
    /// from the best point so far.
    fn crowd(
        &mut self,
        problem: &ContactProblem<'_, D>,
        crossover: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
        progress: &mut Progress,
    ) {
        let within = |left: u32, most: u32| stop.with_max_iterations(left.min(most));
        // The residual from which pivots are worth a try.
        let mut near = NEAR;
        // The work of a pivot grows with the contacts faster than that of a step of the path, which is all that a
        // loose tolerance needs: of a wall of 500 bricks three tries took as long as all else of 1000 steps.
        let late = suits_gradients(problem, stop);
        let mut cross = |p: &mut [Vector<D>], progress: &mut Progress| {
            if !late && !progress.over(stop) && progress.best.residual.global < near {
                near = NEARER * progress.best.residual.global;
                progress.add(crossover.solve(problem, &within(progress.left(stop), TRIED), p));
            }
        };
        cross(p, progress);
        // All return the best point that they meet, the start among them.
        if !progress.over(stop) {
            progress.add(self.smoothing.solve(problem, &within(progress.left(stop), SHORT_PATH), p));
            cross(p, progress);
        }
        #[cfg(feature = "sparse")]
        if !progress.over(stop) {
            progress.add(self.admm.solve(problem, &within(progress.left(stop), CROWD_DIRECTIONS), p));
            if progress.over(stop) {
                return;
            }
            self.newton.prepare(problem);
            progress.add(self.newton.round(problem, &within(progress.left(stop), u32::MAX), p));
            cross(p, progress);
        }
        if !progress.over(stop) {
            progress.add(self.smoothing.solve(problem, &within(progress.left(stop), LONG_PATH), p));
        }
        if !progress.over(stop) && progress.best.residual.global < NEAR {
            progress.add(crossover.solve(problem, &within(progress.left(stop), LAST_TRIED), p));
        }
    }

    fn sweeps_and_steps(
        &mut self,
        problem: &ContactProblem<'_, D>,
        rounds: usize,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
        progress: &mut Progress,
    ) {
        let within = |left: u32, most: u32| stop.with_max_iterations(left.min(most));
        // Number of sweeps with the cost of a Newton step.
        let mut ratio = None;
        let mut batch = FIRST_SWEEPS;
        for (round, worth) in WORTHWHILE_WORK.into_iter().take(rounds).enumerate() {
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
            // The comparison is false if the rate is NaN.
            if rate < 0.0 && expected < worth * work {
                let most = ((1.5 * expected) as u32).saturating_add(FIRST_SWEEPS);
                progress.add(self.pgs.solve(problem, &within(progress.left(stop), most), p));
                if progress.over(stop) {
                    return;
                }
            }
            progress.add(self.newton.round(problem, &within(progress.left(stop), u32::MAX), p));
            if progress.over(stop) {
                return;
            }
            batch = ((2.0 * work) as u32).saturating_mul(1 << round).saturating_add(FIRST_SWEEPS);
        }
    }
}

/// Whether accelerated gradients are worth trying: see [`LARGE`].
fn suits_gradients<const D: usize>(problem: &ContactProblem<'_, D>, stop: &Stop<'_>) -> bool {
    D == 2 && problem.contacts() > LARGE && stop.tolerance >= LOOSE
}

/// Whether a crowd is to be solved roughly: see [`ROUGH`].
fn is_rough<const D: usize>(problem: &ContactProblem<'_, D>, stop: &Stop<'_>) -> bool {
    D == 2 && problem.contacts() > CROWD && stop.tolerance >= ROUGH
}

/// Whether the rows of H have so many blocks that its factors would fill in.
#[cfg(feature = "sparse")]
fn has_long_rows<const D: usize>(problem: &ContactProblem<'_, D>) -> bool {
    let n = problem.contacts();
    let blocks = problem.nonzero_blocks().unwrap_or(0);
    n >= MANY && blocks >= LONG_ROW * n
}
