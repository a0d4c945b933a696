//! The choice for those who don't want to choose.

use crate::{Enumeration, Pgs};
use nalgebra::Vector2;
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Stop};

/// Enumeration up to its number of contacts; Gauss–Seidel above, and where enumeration doesn't satisfy the judge.
#[derive(Clone, Copy, Debug, Default)]
pub struct Auto;

impl Auto {
    /// The name by which users choose it.
    pub const NAME: &'static str = "auto";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl ContactSolver<2> for Auto {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, _contacts: usize, _blocks: usize) {}

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
        if problem.contacts() <= Enumeration::MAX_CONTACTS {
            let outcome = Enumeration.solve(problem, stop, p);
            if outcome.converged() {
                return outcome;
            }
        }
        Pgs.solve(problem, stop, p)
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(*self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::{body_on_floor, plane_cases, run};

    #[test]
    fn conforms() {
        run(&mut Auto::new(), &plane_cases(), 1e-12).unwrap();
    }

    #[test]
    fn says_which_method_gave_the_result() {
        let of = |points: &[(f64, f64)]| {
            let case = body_on_floor("feet", 0.3, points, [0.3, -1.0, 0.2], 0.5);
            let mut p = vec![Vector2::zeros(); points.len()];
            Auto::new().solve(&case.problem().unwrap(), &Stop::default(), &mut p).used
        };
        assert_eq!(of(&[(-0.5, -1.0), (0.5, -1.0)]), "enumeration");
        assert_eq!(of(&[(-0.5, -1.0), (-0.1, -1.0), (0.2, -1.0), (0.5, -1.0)]), "pgs");
    }
}
