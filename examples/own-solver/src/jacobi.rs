//! Damped projected Jacobi, a contact solver of one's own.
//!
//! Every contact takes, at once and from the same impulses, a step against its velocity and is projected onto the law:
//!
//! ```text
//! p_N ← max(p_N − τ_i u_N, 0),      p_T ← the nearest point to p_T − τ_i u_T of the disk of radius μ p_N
//! ```
//!
//! Its fixed points are the solutions of the exact law (Alart and Curnier 1991, doi 10.1016/0045-7825(91)90022-X). With
//! `1/τ_i = Σ_j ‖H_ij‖`, Gershgorin's bound, the step is damped enough for the contacts not to overshoot together. It is a plain method: dozens
//! to thousands of iterations where the solvers of `teeter-solvers` take a few. What matters is how it meets the trait: it starts
//! from `p`, lets the judge decide, says how it ended, and keeps its memory from call to call.

use teeter_contact::{ContactProblem, ContactSolver, Delassus, Law, Outcome, Status, Stop, Vector, judge_velocities};

/// The solver; its memory is all that it keeps.
#[derive(Debug, Default)]
pub struct Jacobi {
    /// Velocities at the contacts, and the step of each.
    u: Vec<Vector<2>>,
    step: Vec<f64>,
}

impl ContactSolver<2> for Jacobi {
    fn name(&self) -> &'static str {
        "jacobi"
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, contacts: usize, _blocks: usize) {
        self.u.reserve(contacts.saturating_sub(self.u.len()));
        self.step.reserve(contacts.saturating_sub(self.step.len()));
    }

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector<2>]) -> Outcome {
        self.step.clear();
        self.step.extend((0..p.len()).map(|i| step(problem, i)));
        let mut iterations = 0;
        loop {
            self.u.clear();
            self.u.extend((0..p.len()).map(|i| problem.velocity(i, p)));
            let residual = judge_velocities(problem, p, &self.u);
            // A residual that is no number is no success: the comparison is false for it.
            let status = if residual.global <= stop.tolerance {
                Status::Converged
            } else if stop.cancelled() {
                Status::Cancelled
            } else if !residual.global.is_finite() {
                Status::Breakdown
            } else if iterations >= stop.max_iterations {
                Status::MaxIterations
            } else {
                for (i, p) in p.iter_mut().enumerate() {
                    let normal = (p[0] - self.step[i] * self.u[i][0]).max(0.0);
                    let limit = problem.mu()[i] * normal;
                    *p = Vector::<2>::new(normal, (p[1] - self.step[i] * self.u[i][1]).clamp(-limit, limit));
                }
                iterations += 1;
                continue;
            };
            return Outcome::new(status, self.name(), iterations, residual);
        }
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(Self::default())
    }
}

/// The step of a contact: one over the norms of its row of blocks.
fn step(problem: &ContactProblem<'_, 2>, i: usize) -> f64 {
    let n = problem.contacts();
    let row: f64 = match problem.delassus() {
        Delassus::Dense(blocks) => blocks[i * n..(i + 1) * n].iter().map(|block| block.norm()).sum(),
        // Of other shapes this solver looks at the diagonal only, and is careful.
        _ => problem.diagonal(i).norm() * n as f64,
    };
    row.recip()
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::{plane_cases, run};

    #[test]
    fn conforms() {
        run(&mut Jacobi::default(), &plane_cases(), 1e-10).unwrap();
    }

    #[test]
    fn says_when_it_ran_out_of_iterations() {
        for case in plane_cases().iter().filter(|case| case.name.starts_with("two feet, slide")) {
            let mut p = vec![Vector::<2>::zeros(); case.q.len()];
            let stop = Stop::default().with_max_iterations(1);
            let outcome = Jacobi::default().solve(&case.problem().unwrap(), &stop, &mut p);
            assert_eq!((outcome.status, outcome.iterations), (Status::MaxIterations, 1));
        }
    }
}
