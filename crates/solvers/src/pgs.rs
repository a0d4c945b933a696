//! Projected (non-smooth) Gauss–Seidel over contacts with an exact local solve.
//!
//! Jean and Moreau's NSGS (Jean 1999, doi 10.1016/S0045-7825(98)00383-1): each contact in turn is solved exactly with
//! the others held, so a sweep costs one product with H. Departures: the stop is by the judge's residual, not by the
//! increment (a slowly converging iteration has small increments far from the solution); the residual, which costs a
//! sweep itself, is computed after each of the first sweeps and then after every eighth.

use crate::one_contact;
use nalgebra::Vector2;
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Status, Stop, de_saxce, judge, project};

/// The residual is computed after each sweep up to this one, then after every `CHECK`-th.
const CHECK: u32 = 8;

/// Sweeps without any better residual after which the iteration counts as stalled.
const STALL: u32 = 1000;

/// The Gauss–Seidel solver; see the [crate's table](crate). `iterations` counts sweeps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pgs;

impl Pgs {
    /// The name by which users choose it.
    pub const NAME: &'static str = "pgs";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl ContactSolver<2> for Pgs {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, _contacts: usize, _blocks: usize) {}

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
        let mut residual = judge(problem, p);
        let (mut best, mut best_at) = (residual.global, 0);
        let mut sweep = 0;
        let ended = |status, sweep, residual| Outcome::new(status, Self::NAME, sweep, residual);
        loop {
            // `<=` is false for NaN, which then runs into the limits below.
            if residual.global <= stop.tolerance {
                return ended(Status::Converged, sweep, residual);
            }
            if sweep >= stop.max_iterations {
                return ended(Status::MaxIterations, sweep, residual);
            }
            if sweep - best_at >= STALL {
                return ended(Status::Stalled, sweep, residual);
            }
            if stop.cancelled() {
                return ended(Status::Cancelled, sweep, residual);
            }
            let until = if sweep < CHECK { sweep + 1 } else { (sweep + CHECK).min(stop.max_iterations) };
            while sweep < until {
                for i in 0..p.len() {
                    p[i] = relaxed(problem, i, p);
                }
                sweep += 1;
            }
            residual = judge(problem, p);
            if residual.global < best {
                (best, best_at) = (residual.global, sweep);
            }
        }
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(*self)
    }
}

/// The impulse that solves contact `i` with all the others held.
fn relaxed(problem: &ContactProblem<'_, 2>, i: usize, p: &[Vector2<f64>]) -> Vector2<f64> {
    let (h, mu) = (problem.diagonal(i), problem.mu()[i]);
    let u = problem.velocity(i, p);
    match one_contact::solve(&h, &(u - h * p[i]), mu) {
        Some(solution) => solution,
        // No state fits this contact alone: a step of the natural map instead, which has the same fixed points.
        None => project(&(p[i] - de_saxce(&u, mu) * (2.0 / h.trace())), mu),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::{body_on_floor, plane_cases, run};

    #[test]
    fn conforms_to_its_tolerance() {
        run(&mut Pgs::new(), &plane_cases(), 1e-12).unwrap();
    }

    #[test]
    fn ends_honestly_when_iterations_run_out() {
        let feet = [(-0.5, -1.0), (-0.1, -1.0), (0.2, -1.0), (0.5, -1.0)];
        let case = body_on_floor("four", 0.3, &feet, [0.3, -1.0, 0.2], 0.5);
        let mut p = vec![Vector2::zeros(); 4];
        let stop = Stop { tolerance: 1e-14, max_iterations: 2, ..Stop::default() };
        let outcome = Pgs::new().solve(&case.problem().unwrap(), &stop, &mut p);
        assert_eq!((outcome.status, outcome.iterations), (Status::MaxIterations, 2));
        assert!(outcome.residual.global > 1e-14);
        let outcome = Pgs::new().solve(&case.problem().unwrap(), &Stop { tolerance: 1e-12, ..stop }, &mut p);
        assert_eq!(outcome.status, Status::MaxIterations);
        let outcome = Pgs::new().solve(&case.problem().unwrap(), &Stop { tolerance: 1e-12, ..Stop::default() }, &mut p);
        assert_eq!(outcome.status, Status::Converged);
    }

    #[test]
    fn a_cancelled_solve_says_so() {
        let case = body_on_floor("two", 0.3, &[(-0.5, -1.0), (0.5, -1.0)], [0.3, -1.0, 0.2], 0.5);
        let flag = std::sync::atomic::AtomicBool::new(true);
        let mut p = vec![Vector2::zeros(); 2];
        let stop = Stop { cancel: Some(&flag), ..Stop::default() };
        assert_eq!(Pgs::new().solve(&case.problem().unwrap(), &stop, &mut p).status, Status::Cancelled);
    }
}
