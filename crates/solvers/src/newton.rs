//! The semi-smooth Newton method.
//!
//! **What it solves**: exact Signorini–Coulomb in the plane and in space; H may be asymmetric or
//! singular.
//!
//! **How**: Alart and Curnier's formulation (1991, doi 10.1016/0045-7825(91)90022-X) in the
//! variables (p, u): each contact is open, sticks or slides at the iterate, and gives D linear
//! equations of that state; a Newton step solves them for all active contacts. Sliding is
//! linearised including its direction. For hyperstatic bodies the equations of sticking contacts
//! are singular, so H + εI replaces H, which gives nearly the smallest of all corrections. A step
//! is shortened until the residual decreases.
//!
//! **When to use it**: for high accuracy where Gauss–Seidel is slow. If the initial impulses have
//! mostly correct states, it takes three to ten steps to rounding.
//!
//! **Cost**: one sparse LU of the active contacts' blocks per step (`block_lu.rs`); its analysis is
//! kept while the pattern is the same.
//!
//! **How it fails**: contacts on the boundary between states can make it cycle, or the residual
//! increase along every step. Then a batch of Gauss–Seidel sweeps follows, each time twice as many;
//! after some of these rounds it ends as `stalled`. With many degenerate contacts, use
//! [`Smoothing`](crate::Smoothing).
//!
//! Departures from the paper:
//! - The unknowns are (p, u), not (displacement, p) of a mesh.
//! - Open contacts are removed from the linear system.
//! - Globalisation, which the paper doesn't have: the regularisation is raised when steps fail and
//!   lowered when they succeed (as in Levenberg–Marquardt), with backtracking on the residual and
//!   Gauss–Seidel sweeps ([`Pgs`]) before and between rounds.

use crate::Pgs;
use crate::block_lu::BlockLu;
use crate::ending::ended;
use crate::linearised::{Row, linearise};
use crate::memory::{refill, reserve};
use crate::scaled::{Scaled, make_finite};
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Stop, Vector, judge};

/// Gauss–Seidel sweeps before the first round; their number doubles with each round.
const SWEEPS: u32 = 20;
/// Rounds of sweeps and steps after which the iteration counts as stalled.
const ROUNDS: u32 = 8;
/// Largest number of steps of a round.
const STEPS: u32 = 12;
/// Failed steps in a row that end a round.
const FAILURES: u32 = 3;
/// The regularisation ε at the start of a round and its bounds, relative to the mean of H's
/// diagonal, and the factors of its change.
const EPSILON: f64 = 1e-7;
const LEAST_EPSILON: f64 = 1e-12;
const MOST_EPSILON: f64 = 1e-1;
const RAISED: f64 = 100.0;
const LOWERED: f64 = 0.1;
/// Target residual as a fraction of the tolerance, as the judge sums in a different order.
const AIM: f64 = 0.9;
/// A step that leaves more than this fraction of the residual has failed.
const PROGRESS: f64 = 0.7;
/// Number of step lengths tried: 1, ½, ¼, ⅛.
const HALVINGS: u32 = 4;

/// The semi-smooth Newton solver; see the [crate's table](crate). `iterations` counts Newton steps
/// and the sweeps between them.
#[derive(Clone, Debug, Default)]
pub struct Newton<const D: usize> {
    scaled: Scaled<D>,
    steps: Steps<D>,
    pgs: Pgs<D>,
    best: Vec<Vector<D>>,
}

impl<const D: usize> Newton<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "newton";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Loads a problem for [`Self::round`], and returns the work of one step with all contacts
    /// active.
    pub(crate) fn prepare(&mut self, problem: &ContactProblem<'_, D>) -> StepWork {
        self.scaled.load(problem);
        self.steps.lu.analyse(&self.scaled.h);
        StepWork {
            blocks: self.scaled.h.blocks().len(),
            filled: self.steps.lu.filled_blocks(),
            products: self.steps.lu.block_products(),
        }
    }

    /// A round of Newton steps on the problem prepared last, for solvers with their own
    /// globalisation. Leaves the last impulses in `p`; each step has reduced the residual, up to
    /// rounding.
    pub(crate) fn round(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &mut [Vector<D>]) -> Outcome {
        let most = stop.max_iterations.min(STEPS);
        let end = self.steps.round(&self.scaled, None, AIM * stop.tolerance, most, stop, p);
        let residual = judge(problem, p);
        Outcome::new(ended(stop, end.steps, &residual), Self::NAME, end.steps, residual)
    }
}

/// The work of a Newton step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepWork {
    /// Blocks of H.
    pub(crate) blocks: usize,
    /// Blocks of its factors.
    pub(crate) filled: usize,
    /// Block products of one factorisation.
    pub(crate) products: usize,
}

impl<const D: usize> ContactSolver<D> for Newton<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.scaled.reserve(contacts, blocks);
        self.pgs.reserve(contacts, blocks);
        self.steps.reserve(contacts, blocks);
        reserve(&mut self.best, contacts);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &mut [Vector<D>]) -> Outcome {
        make_finite(p);
        self.scaled.load(problem);
        let goal = AIM * stop.tolerance;
        self.best.clear();
        self.best.extend_from_slice(p);
        let mut best = f64::INFINITY;
        let mut iterations = 0;
        let mut used = Self::NAME;
        for round in 0..ROUNDS {
            let left = stop.max_iterations - iterations;
            let swept = self.pgs.solve(problem, &stop.with_max_iterations(left.min(SWEEPS << round)), p);
            iterations += swept.iterations;
            if swept.residual.global < best {
                best = swept.residual.global;
                self.best.copy_from_slice(p);
                used = swept.used;
            }
            if best <= stop.tolerance {
                break;
            }
            let most = (stop.max_iterations - iterations).min(STEPS);
            let end = self.steps.round(&self.scaled, None, AIM * stop.tolerance, most, stop, p);
            iterations += end.steps;
            if end.residual < best {
                best = end.residual;
                self.best.copy_from_slice(p);
                used = Self::NAME;
            }
            if best <= goal {
                break;
            }
            if stop.cancelled() || iterations >= stop.max_iterations {
                break;
            }
        }
        p.copy_from_slice(&self.best);
        let residual = judge(problem, p);
        Outcome::new(ended(stop, iterations, &residual), used, iterations, residual)
    }

    fn fork(&self) -> Box<dyn ContactSolver<D>> {
        Box::new(Self::new())
    }
}

/// The shift of a proximal problem: `α (p − center)` is added to the velocities.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Proximal<'a, const D: usize> {
    pub(crate) alpha: f64,
    pub(crate) center: &'a [Vector<D>],
}

/// The end of a round.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RoundEnd {
    pub(crate) steps: u32,
    /// The residual of the (shifted) problem.
    pub(crate) residual: f64,
}

/// Newton steps on a scaled problem, with their memory.
#[derive(Clone, Debug, Default)]
pub(crate) struct Steps<const D: usize> {
    lu: BlockLu<D>,
    rows: Vec<Row<D>>,
    u: Vec<Vector<D>>,
    change: Vec<Vector<D>>,
    change_u: Vec<Vector<D>>,
    right: Vec<Vector<D>>,
}

impl<const D: usize> Steps<D> {
    pub(crate) fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.lu.reserve(contacts, blocks);
        reserve(&mut self.rows, contacts);
        for x in [&mut self.u, &mut self.change, &mut self.change_u, &mut self.right] {
            reserve(x, contacts);
        }
    }

    /// Takes steps until the residual is within `goal`, `most` are done, or the steps fail.
    pub(crate) fn round(
        &mut self,
        scaled: &Scaled<D>,
        shift: Option<Proximal<'_, D>>,
        goal: f64,
        most: u32,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
    ) -> RoundEnd {
        let n = scaled.contacts();
        for x in [&mut self.u, &mut self.change, &mut self.change_u, &mut self.right] {
            refill(x, n, Vector::zeros());
        }
        refill(&mut self.rows, n, Row::default());
        self.lu.analyse(&scaled.h);
        let alpha = shift.map_or(0.0, |s| s.alpha);
        self.shifted_velocities(scaled, shift, p);
        let mut residual = scaled.residual(p, &self.u);
        let (mut epsilon, mut failures, mut steps) = (EPSILON, 0, 0);
        while !(residual <= goal) && steps < most && failures < FAILURES && !stop.cancelled() {
            steps += 1;
            for i in 0..n {
                self.rows[i] = linearise(&p[i], &self.u[i], scaled.mu[i], scaled.h.diagonal(i));
            }
            if !self.direction(scaled, alpha, alpha + epsilon, p) {
                failures += 1;
                epsilon = (epsilon * RAISED).min(MOST_EPSILON);
                continue;
            }
            let (mut step, mut chosen, mut lowest) = (1.0, 1.0, f64::INFINITY);
            for _ in 0..HALVINGS {
                let after = scaled.residual_after(p, &self.u, step, &self.change, &self.change_u);
                if after < lowest {
                    (lowest, chosen) = (after, step);
                }
                if after < 0.5 * residual {
                    break;
                }
                step *= 0.5;
            }
            if lowest < PROGRESS * residual {
                failures = 0;
                if chosen == 1.0 {
                    epsilon = (epsilon * LOWERED).max(LEAST_EPSILON);
                }
            } else {
                failures += 1;
                epsilon = (epsilon * RAISED).min(MOST_EPSILON);
            }
            if lowest < residual {
                for i in 0..n {
                    p[i] += self.change[i] * chosen;
                }
                self.shifted_velocities(scaled, shift, p);
                residual = scaled.residual(p, &self.u);
            }
        }
        RoundEnd { steps, residual }
    }

    fn shifted_velocities(&mut self, scaled: &Scaled<D>, shift: Option<Proximal<'_, D>>, p: &[Vector<D>]) {
        scaled.velocities(p, &mut self.u);
        if let Some(Proximal { alpha, center }) = shift {
            for i in 0..p.len() {
                self.u[i] += (p[i] - center[i]) * alpha;
            }
        }
    }

    /// The Newton direction and its change of the velocities; `diagonal` is added to H. `false` if
    /// the factorisation fails.
    fn direction(&mut self, scaled: &Scaled<D>, alpha: f64, diagonal: f64, p: &[Vector<D>]) -> bool {
        let (rows, h) = (&self.rows, &scaled.h);
        // Open contacts go to zero at once, which changes the velocities of the others.
        let mut opening = false;
        for i in 0..p.len() {
            self.change[i] = if rows[i].open { -p[i] } else { Vector::zeros() };
            opening |= rows[i].open && p[i].iter().any(|&c| c != 0.0);
        }
        for i in 0..p.len() {
            self.right[i] = rows[i].right;
            if opening && !rows[i].open {
                self.right[i] -= rows[i].of_u * h.row_product(i, &self.change);
            }
        }
        let block = |i: usize, t: usize| {
            let block = rows[i].of_u * h.blocks()[t];
            if h.columns()[t] == i { block + rows[i].of_u * diagonal + rows[i].of_p } else { block }
        };
        if !self.lu.factorise(h, |i| !rows[i].open, block) {
            return false;
        }
        self.lu.solve(&mut self.right);
        for i in 0..p.len() {
            if !rows[i].open {
                self.change[i] = self.right[i];
            }
        }
        if !self.change.iter().all(|x| x.iter().all(|c| c.is_finite())) {
            return false;
        }
        scaled.product(&self.change, &mut self.change_u);
        if alpha != 0.0 {
            for i in 0..p.len() {
                self.change_u[i] += self.change[i] * alpha;
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::{plane_cases, run, space_cases};

    #[test]
    fn conforms() {
        run(&mut Newton::<2>::new(), &plane_cases(), 1e-11).unwrap();
        run(&mut Newton::<3>::new(), &space_cases(), 1e-11).unwrap();
    }
}
