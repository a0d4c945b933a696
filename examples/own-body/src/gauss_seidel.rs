//! Projected Gauss–Seidel in the plane, a contact solver of one's own.
//!
//! Contact by contact, each with the newest impulses of the others: first the normal impulse is
//! set, then the tangential one,
//!
//! ```text
//! p_N ← max(p_N − u_N/H_NN, 0),      p_T ← the number nearest to p_T − u_T/H_TT in [−μ p_N, μ p_N]
//! ```
//!
//! An impulse that no longer changes obeys the exact law (Jourdan, Alart and Jean 1998, Comput.
//! Methods Appl. Mech. Eng. 155, solve the two components of a contact together; this takes one
//! after the other, which is less to write and takes more sweeps). Nothing promises that it gets
//! there; so the judge is asked after every sweep, and what it says is what is returned.

use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Status, Stop, Vector, judge};

/// The solver. It needs no memory.
#[derive(Debug, Default)]
pub struct GaussSeidel;

impl ContactSolver<2> for GaussSeidel {
    fn name(&self) -> &'static str {
        "gauss-seidel"
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, _contacts: usize, _blocks: usize) {}

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector<2>]) -> Outcome {
        let mut sweeps = 0;
        loop {
            let residual = judge(problem, p);
            // A residual that is no number is no success: the first comparison is false for it.
            let status = if residual.global <= stop.tolerance {
                Status::Converged
            } else if stop.cancelled() {
                Status::Cancelled
            } else if !residual.global.is_finite() {
                Status::Breakdown
            } else if sweeps >= stop.max_iterations {
                Status::MaxIterations
            } else {
                sweep(problem, p);
                sweeps += 1;
                continue;
            };
            return Outcome::new(status, self.name(), sweeps, residual);
        }
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(Self)
    }
}

/// Every contact once.
fn sweep(problem: &ContactProblem<'_, 2>, p: &mut [Vector<2>]) {
    for i in 0..p.len() {
        let h = problem.diagonal(i);
        let normal = (p[i][0] - problem.velocity(i, p)[0] / h[(0, 0)]).max(0.0);
        p[i][0] = normal;
        let limit = problem.mu()[i] * normal;
        // A contact that can't move along its tangent takes no friction.
        let step = if h[(1, 1)] > 0.0 { problem.velocity(i, p)[1] / h[(1, 1)] } else { p[i][1] };
        p[i][1] = (p[i][1] - step).clamp(-limit, limit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;
    use teeter_contact::conformance::{plane_cases, run};

    #[test]
    fn conforms() {
        run(&mut GaussSeidel, &plane_cases(), 1e-10).unwrap();
    }

    #[test]
    fn says_how_it_ended_when_it_was_not_done() {
        let cases = plane_cases();
        let case = cases.iter().find(|case| case.name == "two feet, slide").unwrap();
        let solve = |stop: &Stop<'_>| {
            let mut p = vec![Vector::<2>::zeros(); case.q.len()];
            let outcome = GaussSeidel.solve(&case.problem().unwrap(), stop, &mut p);
            assert_eq!(outcome.residual, judge(&case.problem().unwrap(), &p));
            (outcome.status, outcome.iterations)
        };
        assert_eq!(solve(&Stop::default().with_max_iterations(1)), (Status::MaxIterations, 1));
        let flag = AtomicBool::new(true);
        assert_eq!(solve(&Stop::default().with_cancel(&flag)), (Status::Cancelled, 0));
    }
}
