//! The proximal point method, with Newton's method for the inner problems.
//!
//! **What it solves**: exact Signorini–Coulomb in the plane and in space; H may be asymmetric or
//! singular.
//!
//! **How**: the outer iteration (Rockafellar 1976, doi 10.1137/0314056; for contact Acary, Brémond,
//! Huber 2018, doi 10.1007/978-3-319-75972-2_10) solves the problem with H + αI and q − αc, c being
//! the last impulses, which is better conditioned and has the original solution as its fixed point.
//! Each of these is solved by semi-smooth Newton steps ([`Newton`](crate::Newton)) to a hundredth
//! of the current residual.
//!
//! **When to use it**: for hyperstatic problems of moderate size, where Newton's method alone fails
//! because H is singular.
//!
//! **Cost**: 5 to 50 outer steps, each of some Newton steps with a sparse LU.
//!
//! **How it fails**: α must be raised until the inner problem can be solved; with a large α the
//! outer iteration is slow and ends as `stalled`.
//!
//! Departures from the paper: α is reduced tenfold after a success and raised tenfold after a
//! failure, followed by a few Gauss–Seidel sweeps for a new start; the iteration stops by the
//! residual, not the increment.

use crate::Pgs;
use crate::ending::ended;
use crate::memory::{refill, reserve};
use crate::newton::{Proximal, Steps};
use crate::scaled::{Scaled, make_finite};
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Stop, Vector, judge};

/// The initial proximal parameter α and its bounds, relative to the mean of H's diagonal.
const ALPHA: f64 = 1e-3;
const LEAST_ALPHA: f64 = 1e-12;
const MOST_ALPHA: f64 = 10.0;
/// An inner problem is solved to this fraction of the residual.
const INNER: f64 = 0.01;
/// Largest number of Newton steps for an inner problem.
const STEPS: u32 = 15;
/// Gauss–Seidel sweeps at the start and after a failure.
const SWEEPS: u32 = 20;
/// Outer steps without a better residual after which the iteration counts as stalled.
const PATIENCE: u32 = 40;

/// The proximal point solver; see the [crate's table](crate). `iterations` counts Newton steps and
/// sweeps.
#[derive(Clone, Debug, Default)]
pub struct Prox<const D: usize> {
    scaled: Scaled<D>,
    steps: Steps<D>,
    pgs: Pgs<D>,
    center: Vec<Vector<D>>,
    best: Vec<Vector<D>>,
    u: Vec<Vector<D>>,
}

impl<const D: usize> Prox<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "prox";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
}

impl<const D: usize> ContactSolver<D> for Prox<D> {
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
        for x in [&mut self.center, &mut self.best, &mut self.u] {
            reserve(x, contacts);
        }
    }

    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &mut [Vector<D>]) -> Outcome {
        let n = p.len();
        make_finite(p);
        self.scaled.load(problem);
        for x in [&mut self.center, &mut self.best, &mut self.u] {
            refill(x, n, Vector::zeros());
        }
        self.best.copy_from_slice(p);
        let sweeps = |left: u32| stop.with_max_iterations(left.min(SWEEPS));
        let swept = self.pgs.solve(problem, &sweeps(stop.max_iterations), p);
        let mut iterations = swept.iterations;
        let (mut residual, mut best, mut alpha) = (swept.residual.global, f64::INFINITY, ALPHA);
        let mut since_best = 0;
        while since_best < PATIENCE {
            if residual < best {
                (best, since_best) = (residual, 0);
                self.best.copy_from_slice(p);
            } else {
                since_best += 1;
            }
            if best <= stop.tolerance || stop.cancelled() || iterations >= stop.max_iterations {
                break;
            }
            self.center.copy_from_slice(p);
            let goal = (INNER * residual).max(0.1 * stop.tolerance);
            let most = (stop.max_iterations - iterations).min(STEPS);
            let shift = Proximal { alpha, center: &self.center };
            let end = self.steps.round(&self.scaled, Some(shift), goal, most, stop, p);
            iterations += end.steps;
            self.scaled.velocities(p, &mut self.u);
            let after = self.scaled.residual(p, &self.u);
            if end.residual <= goal || after < 0.5 * residual {
                alpha = (0.1 * alpha).max(LEAST_ALPHA);
                residual = after;
            } else {
                alpha = (10.0 * alpha).min(MOST_ALPHA);
                if !(after < residual) {
                    p.copy_from_slice(&self.center);
                }
                let swept = self.pgs.solve(problem, &sweeps(stop.max_iterations - iterations), p);
                iterations += swept.iterations;
                residual = swept.residual.global;
            }
        }
        p.copy_from_slice(&self.best);
        let residual = judge(problem, p);
        Outcome::new(ended(stop, iterations, &residual), Self::NAME, iterations, residual)
    }

    fn fork(&self) -> Box<dyn ContactSolver<D>> {
        Box::new(Self::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::{plane_cases, run, space_cases};

    #[test]
    fn conforms() {
        run(&mut Prox::<2>::new(), &plane_cases(), 1e-11).unwrap();
        run(&mut Prox::<3>::new(), &space_cases(), 1e-11).unwrap();
    }
}
