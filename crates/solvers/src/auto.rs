//! The choice for those who don't want to choose.
//!
//! Contacts that don't feel each other (blocks that stand apart on the ground) are problems of their own: the problem is
//! split along the zero blocks of H, each part of up to three contacts is enumerated, a larger one goes to Gauss–Seidel.
//! A part that is still small gets some more sweeps than the tolerance asks for: they cost little there, and the motion of
//! a few blocks is then as exact as an enumerated one.

use crate::{Enumeration, Pgs};
use nalgebra::{Matrix2, Vector2};
use teeter_contact::{ContactProblem, ContactSolver, Delassus, Law, Outcome, Status, Stop, judge};

/// A part of up to so many contacts is polished.
const SMALL: usize = 12;

/// Sweeps of the polish, and the residual at which it is good enough: some tens of roundings.
const POLISH: Stop<'static> = Stop { tolerance: 1e-14, max_iterations: 200, cancel: None };

/// The solver that chooses; see the [crate's table](crate). `iterations` are those of the part that took most.
#[derive(Clone, Debug, Default)]
pub struct Auto {
    /// The part that each contact belongs to.
    part: Vec<usize>,
    /// The contacts of the part at hand, and its problem.
    members: Vec<usize>,
    h: Vec<Matrix2<f64>>,
    q: Vec<Vector2<f64>>,
    mu: Vec<f64>,
    p: Vec<Vector2<f64>>,
    best: Vec<Vector2<f64>>,
    pgs: Pgs<2>,
}

impl Auto {
    /// The name by which users choose it.
    pub const NAME: &'static str = "auto";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Numbers the parts of a dense problem: contacts coupled by a non-zero block, either way, belong together. Returns
    /// how many there are.
    fn split(&mut self, blocks: &[Matrix2<f64>], n: usize) -> usize {
        const NONE: usize = usize::MAX;
        self.part.clear();
        self.part.resize(n, NONE);
        let mut parts = 0;
        for seed in 0..n {
            if self.part[seed] != NONE {
                continue;
            }
            self.part[seed] = parts;
            self.members.clear();
            self.members.push(seed);
            while let Some(i) = self.members.pop() {
                for j in 0..n {
                    let coupled = blocks[i * n + j] != Matrix2::zeros() || blocks[j * n + i] != Matrix2::zeros();
                    if self.part[j] == NONE && coupled {
                        self.part[j] = parts;
                        self.members.push(j);
                    }
                }
            }
            parts += 1;
        }
        parts
    }

    /// Solves one part on its own, from and into the impulses of all.
    fn solve_part(
        &mut self,
        problem: &ContactProblem<'_, 2>,
        blocks: &[Matrix2<f64>],
        part: usize,
        stop: &Stop<'_>,
        all: &mut [Vector2<f64>],
    ) -> Option<Outcome> {
        let n = all.len();
        self.members.clear();
        self.members.extend((0..n).filter(|&i| self.part[i] == part));
        self.h.clear();
        self.q.clear();
        self.mu.clear();
        self.p.clear();
        for &i in &self.members {
            self.h.extend(self.members.iter().map(|&j| blocks[i * n + j]));
            self.q.push(problem.q()[i]);
            self.mu.push(problem.mu()[i]);
            self.p.push(all[i]);
        }
        let own = ContactProblem::new(Delassus::Dense(&self.h), &self.q, &self.mu).ok()?;
        let outcome = solve_connected(&own, stop, &mut self.p, &mut self.best, &mut self.pgs);
        for (&i, p) in self.members.iter().zip(&self.p) {
            all[i] = *p;
        }
        Some(outcome)
    }
}

/// Solves a problem whose contacts all feel each other.
fn solve_connected(
    problem: &ContactProblem<'_, 2>,
    stop: &Stop<'_>,
    p: &mut [Vector2<f64>],
    best: &mut Vec<Vector2<f64>>,
    pgs: &mut Pgs<2>,
) -> Outcome {
    if p.len() <= Enumeration::MAX_CONTACTS {
        let outcome = Enumeration.solve(problem, stop, p);
        if outcome.converged() {
            return outcome;
        }
    }
    let mut outcome = pgs.solve(problem, stop, p);
    if outcome.converged() && p.len() <= SMALL {
        best.clear();
        best.extend_from_slice(p);
        let polished = pgs.solve(problem, &POLISH, p);
        outcome.iterations += polished.iterations;
        if polished.residual.global <= outcome.residual.global {
            outcome.residual = polished.residual;
        } else {
            p.copy_from_slice(best);
        }
    }
    outcome
}

impl ContactSolver<2> for Auto {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, contacts: usize, _blocks: usize) {
        self.part.reserve(contacts);
        self.members.reserve(contacts);
        self.h.reserve(contacts * contacts);
        self.q.reserve(contacts);
        self.mu.reserve(contacts);
        self.p.reserve(contacts);
        self.best.reserve(contacts);
        self.pgs.reserve(contacts, contacts * contacts);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
        let n = problem.contacts();
        let Delassus::Dense(blocks) = problem.delassus() else {
            return solve_connected(problem, stop, p, &mut self.best, &mut self.pgs);
        };
        if n <= Enumeration::MAX_CONTACTS {
            return solve_connected(problem, stop, p, &mut self.best, &mut self.pgs);
        }
        let parts = self.split(blocks, n);
        if parts == 1 {
            return solve_connected(problem, stop, p, &mut self.best, &mut self.pgs);
        }
        let (mut used, mut iterations) = (Enumeration::NAME, 0);
        for part in 0..parts {
            let Some(outcome) = self.solve_part(problem, blocks, part, stop, p) else { continue };
            iterations = iterations.max(outcome.iterations);
            if outcome.used != Enumeration::NAME {
                used = outcome.used;
            }
        }
        // Each part is judged in its own scale; what counts is the whole.
        let residual = judge(problem, p);
        if residual.global <= stop.tolerance {
            return Outcome::new(Status::Converged, used, iterations, residual);
        }
        solve_connected(problem, stop, p, &mut self.best, &mut self.pgs)
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(Self::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::{Case, body_on_floor, plane_cases, run};

    #[test]
    fn conforms() {
        run(&mut Auto::new(), &plane_cases(), 1e-12).unwrap();
    }

    fn outcome(case: &Case<2>) -> (Outcome, Vec<Vector2<f64>>) {
        let mut p = vec![Vector2::zeros(); case.q.len()];
        let outcome = Auto::new().solve(&case.problem().unwrap(), &Stop::default(), &mut p);
        (outcome, p)
    }

    #[test]
    fn says_which_method_gave_the_result() {
        let of = |points: &[(f64, f64)]| outcome(&body_on_floor("feet", 0.3, points, [0.3, -1.0, 0.2], 0.5)).0.used;
        assert_eq!(of(&[(-0.5, -1.0), (0.5, -1.0)]), "enumeration");
        assert_eq!(of(&[(-0.5, -1.0), (-0.1, -1.0), (0.2, -1.0), (0.5, -1.0)]), "pgs");
    }

    #[test]
    fn bodies_that_stand_apart_are_enumerated_one_by_one() {
        let feet = [(-0.5, -1.0), (0.5, -1.0)];
        let bodies = [
            body_on_floor("slides", 0.3, &feet, [2.0, -1.0, 0.0], 0.2),
            body_on_floor("falls", 0.2, &feet, [0.0, -1.0, 0.1], 0.5),
            body_on_floor("leaves", 0.2, &feet, [0.0, 1.0, 0.1], 0.5),
        ];
        let n = 6;
        let mut whole = Case { name: "apart", h: vec![Matrix2::zeros(); n * n], q: vec![], mu: vec![] };
        for (b, body) in bodies.iter().enumerate() {
            for (k, block) in body.h.iter().enumerate() {
                whole.h[(2 * b + k / 2) * n + 2 * b + k % 2] = *block;
            }
            whole.q.extend(&body.q);
            whole.mu.extend(&body.mu);
        }
        let (together, p) = outcome(&whole);
        assert!(together.converged() && together.used == "enumeration" && together.residual.global < 1e-15);
        for (b, body) in bodies.iter().enumerate() {
            assert_eq!(p[2 * b..2 * b + 2], outcome(body).1[..], "{}", body.name);
        }
    }

    #[test]
    fn a_few_coupled_contacts_are_solved_further_than_asked() {
        let points = [(-0.5, -1.0), (-0.1, -1.0), (0.2, -1.0), (0.5, -1.0)];
        let (outcome, _) = outcome(&body_on_floor("feet", 0.3, &points, [0.3, -1.0, 0.2], 0.5));
        assert!(outcome.residual.global < 1e-13, "{outcome:?}");
    }
}
