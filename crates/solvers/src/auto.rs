//! The choice for those who don't want to choose.
//!
//! Contacts that don't feel each other (blocks that stand apart on the ground) are problems of their own: a dense problem is
//! split along the zero blocks of H. Up to three plane contacts are enumerated; the rest goes along a chain (`chain.rs`)
//! of methods until the judge is satisfied. If it never is, four and five plane contacts are enumerated too: that takes
//! milliseconds, but it has the solution if there is one.

use crate::Enumeration;
use crate::chain::Chain;
use crate::enumeration::{FEW, MAX_CONTACTS};
use crate::memory::reserve;
use crate::pairs::Small;
use teeter_contact::{Block, ContactProblem, ContactSolver, Delassus, Law, Outcome, Status, Stop, Vector, judge};

/// The exact methods of a dimension: for parts of a few contacts, and for those that the chain doesn't solve.
#[derive(Clone, Copy)]
struct Exact<const D: usize> {
    first: Small<D>,
    last: Small<D>,
}

/// The solver that chooses; see the [crate's table](crate). `used` of the outcome says which method gave the result;
/// `iterations` are those of all methods tried; of a
/// problem in parts, those of the part that took most.
#[derive(Debug, Default)]
pub struct Auto<const D: usize> {
    chain: Chain<D>,
    /// The part that each contact belongs to.
    part: Vec<usize>,
    /// The contacts of the part at hand, and its problem.
    members: Vec<usize>,
    h: Vec<Block<D>>,
    q: Vec<Vector<D>>,
    mu: Vec<f64>,
    p: Vec<Vector<D>>,
}

impl<const D: usize> Auto<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "auto";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Numbers the parts of a dense problem: contacts coupled by a non-zero block, either way, belong together. Returns
    /// how many there are.
    fn split(&mut self, blocks: &[Block<D>], n: usize) -> usize {
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
                    let zero = Block::<D>::zeros();
                    let coupled = blocks[i * n + j] != zero || blocks[j * n + i] != zero;
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
        problem: &ContactProblem<'_, D>,
        blocks: &[Block<D>],
        part: usize,
        exact: Exact<D>,
        stop: &Stop<'_>,
        all: &mut [Vector<D>],
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
        let outcome = match (exact.first)(&own, stop, &mut self.p) {
            Some(outcome) => outcome,
            None => along(&mut self.chain, exact, &own, stop, &mut self.p),
        };
        for (&i, p) in self.members.iter().zip(&self.p) {
            all[i] = *p;
        }
        Some(outcome)
    }

    fn solve_with(
        &mut self,
        problem: &ContactProblem<'_, D>,
        exact: Exact<D>,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
    ) -> Outcome {
        if let Some(outcome) = (exact.first)(problem, stop, p) {
            return outcome;
        }
        let n = problem.contacts();
        let Delassus::Dense(blocks) = problem.delassus() else {
            return along(&mut self.chain, exact, problem, stop, p);
        };
        let parts = self.split(blocks, n);
        if parts <= 1 {
            return along(&mut self.chain, exact, problem, stop, p);
        }
        let (mut used, mut iterations) = (Enumeration::NAME, 0);
        for part in 0..parts {
            let Some(outcome) = self.solve_part(problem, blocks, part, exact, stop, p) else { continue };
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
        let rest = Stop { max_iterations: stop.max_iterations.saturating_sub(iterations), ..*stop };
        let mut outcome = self.chain.solve(problem, exact.first, &rest, p);
        outcome.iterations = outcome.iterations.saturating_add(iterations);
        outcome
    }

    fn reserve_all(&mut self, contacts: usize, blocks: usize) {
        self.chain.reserve(contacts, blocks);
        // Parts are copied out of dense problems only, and the largest is no larger than what is there.
        let dense = contacts.saturating_mul(contacts).min(blocks);
        reserve(&mut self.part, contacts);
        reserve(&mut self.members, contacts);
        reserve(&mut self.h, dense);
        reserve(&mut self.q, contacts);
        reserve(&mut self.mu, contacts);
        reserve(&mut self.p, contacts);
    }
}

/// The chain, and if it fails the exact method.
fn along<const D: usize>(
    chain: &mut Chain<D>,
    exact: Exact<D>,
    problem: &ContactProblem<'_, D>,
    stop: &Stop<'_>,
    p: &mut [Vector<D>],
) -> Outcome {
    let outcome = chain.solve(problem, exact.first, stop, p);
    if outcome.converged() || stop.cancelled() {
        return outcome;
    }
    match (exact.last)(problem, stop, p) {
        Some(mut found) => {
            found.iterations = found.iterations.saturating_add(outcome.iterations);
            found
        }
        None => outcome,
    }
}

/// Enumerates `p.len()` contacts, if they are in the range; leaves `p` as it is if the judge isn't satisfied.
fn enumerate(
    range: std::ops::RangeInclusive<usize>,
    problem: &ContactProblem<'_, 2>,
    stop: &Stop<'_>,
    p: &mut [Vector<2>],
) -> Option<Outcome> {
    if !range.contains(&p.len()) {
        return None;
    }
    let mut found = [Vector::<2>::zeros(); MAX_CONTACTS];
    let found = found.get_mut(..p.len())?;
    found.copy_from_slice(p);
    let outcome = Some(Enumeration.solve(problem, stop, found)).filter(Outcome::converged)?;
    p.copy_from_slice(found);
    Some(outcome)
}

impl ContactSolver<2> for Auto<2> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.reserve_all(contacts, blocks);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector<2>]) -> Outcome {
        let first: Small<2> =
            |problem, stop, p| (p.len() <= FEW).then(|| Enumeration.solve(problem, stop, p)).filter(Outcome::converged);
        let last: Small<2> = |problem, stop, p| enumerate(FEW + 1..=MAX_CONTACTS, problem, stop, p);
        self.solve_with(problem, Exact { first, last }, stop, p)
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(Self::new())
    }
}

impl ContactSolver<3> for Auto<3> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.reserve_all(contacts, blocks);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, 3>, stop: &Stop<'_>, p: &mut [Vector<3>]) -> Outcome {
        self.solve_with(problem, Exact { first: |_, _, _| None, last: |_, _, _| None }, stop, p)
    }

    fn fork(&self) -> Box<dyn ContactSolver<3>> {
        Box::new(Self::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Vector2};
    use teeter_contact::conformance::{Case, body_on_floor, plane_cases, run, space_cases};

    #[test]
    fn conforms() {
        run(&mut Auto::<2>::new(), &plane_cases(), 1e-12).unwrap();
        run(&mut Auto::<3>::new(), &space_cases(), 1e-12).unwrap();
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
        assert_eq!(of(&[(-0.5, -1.0), (-0.1, -1.0), (0.2, -1.0), (0.5, -1.0)]), "newton");
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
