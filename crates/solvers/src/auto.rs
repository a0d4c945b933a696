//! Automatic choice of the method.
//!
//! Contacts that aren't coupled (separate blocks on the ground) are independent problems, so a
//! problem is split into its [`Islands`] along the zero blocks of H, stored or not. Islands of up
//! to three plane contacts are solved by enumeration, larger ones by a chain of methods
//! (`chain.rs`) until one converges. If none does, islands of four and five plane contacts are
//! enumerated too: this takes milliseconds, but finds a solution if one exists.
//!
//! For a block-sparse problem of many small islands, time and memory grow linearly with the number
//! of contacts. A matrix-free operator isn't split, as its blocks are unknown.

use crate::chain::{Chain, Pivots};
use crate::crossover::Crossover;
use crate::ending::ended;
use crate::enumeration::{MAX_CONTACTS, TREE_CONTACTS};
use crate::memory::reserve;
use crate::pairs::Small;
use crate::{Enumeration, Lemke};
use teeter_contact::{
    ContactProblem, ContactSolver, Delassus, Islands, Law, Outcome, OwnedProblem, Stop, Vector, judge,
};

/// The exact methods of a dimension: for islands of a few contacts, and for islands that the chain
/// doesn't solve.
#[derive(Clone, Copy)]
struct Exact<const D: usize> {
    first: Small<D>,
    last: Small<D>,
}

/// The solver with automatic choice; see the [crate's table](crate). The outcome's `used` names the
/// method that gave the result. `iterations` counts those of all methods tried, for a problem with
/// several islands the largest count of one island.
///
/// ```
/// use teeter_contact::nalgebra::Vector2;
/// use teeter_contact::{ContactSolver, InverseMass, Jacobian, OwnedProblem, Stop};
/// use teeter_solvers::Auto;
///
/// // A thousand separate blocks of 1 kg and 0.5 kg m² fall on two corners each: islands of two contacts.
/// let mut jacobian = Jacobian::new();
/// for block in 0..1000 {
///     for x in [-0.4, 0.4] {
///         let [along, up, turn] = [3 * block, 3 * block + 1, 3 * block + 2];
///         jacobian.push([(along, Vector2::new(0.0, 1.0)), (up, Vector2::new(1.0, 0.0)), (turn, Vector2::new(x, 1.0))]);
///     }
/// }
/// let inverse_mass = [1.0, 1.0, 2.0].repeat(1000);
/// let velocity = [0.1, -1.0, 0.0].repeat(1000);
/// let mass = InverseMass::Diagonal(&inverse_mass);
/// let owned = OwnedProblem::from_jacobian(&jacobian, mass, &velocity, vec![0.5; 2000])?;
/// let mut p = vec![Vector2::zeros(); 2000];
/// let outcome = Auto::new().solve(&owned.problem(), &Stop::default(), &mut p);
/// assert!(outcome.converged() && outcome.used == "enumeration");
/// # Ok::<(), teeter_contact::ProblemError>(())
/// ```
#[derive(Debug, Default)]
pub struct Auto<const D: usize> {
    chain: Chain<D>,
    islands: Islands,
    /// The current island as a separate problem, and its impulses.
    own: OwnedProblem<D>,
    p: Vec<Vector<D>>,
    /// The initial impulses of all contacts.
    start: Vec<Vector<D>>,
    /// Lemke's method, in the plane.
    lemke: Lemke,
    /// Pivots from a near-solution, in the plane.
    crossover: Crossover,
}

impl<const D: usize> Auto<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "auto";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Solves one island, reading and writing the impulses of all contacts.
    fn solve_island(
        &mut self,
        problem: &ContactProblem<'_, D>,
        island: usize,
        exact: Exact<D>,
        pivots: Option<Pivots<'_, D>>,
        stop: &Stop<'_>,
        all: &mut [Vector<D>],
    ) -> Option<Outcome> {
        if !self.own.take_island(problem, &self.islands, island) {
            return None;
        }
        let members = self.islands.members(island);
        self.p.clear();
        self.p.extend(members.iter().map(|&i| all[i]));
        let own = self.own.problem();
        let outcome = match (exact.first)(&own, stop, &mut self.p) {
            Some(outcome) => outcome,
            None => along(&mut self.chain, exact, pivots, &own, stop, &mut self.p),
        };
        for (&i, p) in members.iter().zip(&self.p) {
            all[i] = *p;
        }
        Some(outcome)
    }

    /// Solves what enumeration hasn't solved: island by island, or by the chain.
    fn solve_beyond(
        &mut self,
        problem: &ContactProblem<'_, D>,
        exact: Exact<D>,
        mut pivots: Option<Pivots<'_, D>>,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
    ) -> Outcome {
        self.islands.find(problem);
        if self.islands.len() <= 1 {
            return along(&mut self.chain, exact, pivots, problem, stop, p);
        }
        self.start.clear();
        self.start.extend_from_slice(p);
        let (mut used, mut iterations) = (Enumeration::NAME, 0);
        for island in 0..self.islands.len() {
            let pivots = pivots.as_mut().map(Pivots::borrow);
            let Some(outcome) = self.solve_island(problem, island, exact, pivots, stop, p) else { continue };
            iterations = iterations.max(outcome.iterations);
            if outcome.used != Enumeration::NAME {
                used = outcome.used;
            }
        }
        // Each island was judged in its own scale; the residual of the whole problem counts.
        let residual = judge(problem, p);
        let by_islands = Outcome::new(ended(stop, iterations, &residual), used, iterations, residual);
        if by_islands.converged() { by_islands } else { self.solve_whole(problem, exact, pivots, stop, by_islands, p) }
    }

    /// Solves the whole problem by the chain after its islands, solved separately with the outcome
    /// `by_islands`, haven't converged. A dense problem continues from their result. A block-sparse
    /// problem is solved as if it hadn't been split, and the better result is kept: for hard
    /// problems (the published RockPile) the whole problem may converge where its parts don't,
    /// depending on the initial impulses.
    fn solve_whole(
        &mut self,
        problem: &ContactProblem<'_, D>,
        exact: Exact<D>,
        pivots: Option<Pivots<'_, D>>,
        stop: &Stop<'_>,
        by_islands: Outcome,
        p: &mut [Vector<D>],
    ) -> Outcome {
        let anew = matches!(problem.delassus(), Delassus::Blocks(_));
        if anew {
            p.swap_with_slice(&mut self.start);
        }
        let rest = stop.with_max_iterations(stop.max_iterations.saturating_sub(by_islands.iterations));
        let mut outcome = self.chain.solve(problem, exact.first, pivots, &rest, p);
        outcome.iterations = outcome.iterations.saturating_add(by_islands.iterations);
        if anew && !(outcome.residual.global <= by_islands.residual.global) {
            p.copy_from_slice(&self.start);
            return Outcome::new(outcome.status, by_islands.used, outcome.iterations, by_islands.residual);
        }
        outcome
    }

    fn reserve_all(&mut self, contacts: usize, blocks: usize) {
        self.chain.reserve(contacts, blocks);
        // The largest island is at most as large as the problem.
        self.islands.reserve(contacts);
        self.own.reserve(contacts, blocks);
        reserve(&mut self.p, contacts);
        reserve(&mut self.start, contacts);
    }
}

/// Solves by the chain and, if it fails, by the exact method.
fn along<const D: usize>(
    chain: &mut Chain<D>,
    exact: Exact<D>,
    pivots: Option<Pivots<'_, D>>,
    problem: &ContactProblem<'_, D>,
    stop: &Stop<'_>,
    p: &mut [Vector<D>],
) -> Outcome {
    let outcome = chain.solve(problem, exact.first, pivots, stop, p);
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

/// Enumerates `p.len()` contacts if their number is in the range; leaves `p` unchanged if this
/// doesn't converge.
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
        // Nearly every step of a few bodies ends here, without islands and chain.
        if p.len() <= TREE_CONTACTS {
            let outcome = Enumeration.solve(problem, stop, p);
            if outcome.converged() {
                return outcome;
            }
        }
        let first: Small<2> = |problem, stop, p| {
            (p.len() <= TREE_CONTACTS).then(|| Enumeration.solve(problem, stop, p)).filter(Outcome::converged)
        };
        let last: Small<2> = |problem, stop, p| enumerate(TREE_CONTACTS + 1..=MAX_CONTACTS, problem, stop, p);
        let (mut lemke, mut crossover) = (std::mem::take(&mut self.lemke), std::mem::take(&mut self.crossover));
        let pivots = Pivots { lemke: &mut lemke, crossover: &mut crossover };
        let outcome = self.solve_beyond(problem, Exact { first, last }, Some(pivots), stop, p);
        (self.lemke, self.crossover) = (lemke, crossover);
        outcome
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
        self.solve_beyond(problem, Exact { first: |_, _, _| None, last: |_, _, _| None }, None, stop, p)
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
    fn the_outcome_names_the_method() {
        let of = |points: &[(f64, f64)]| outcome(&body_on_floor("feet", 0.3, points, [0.3, -1.0, 0.2], 0.5)).0.used;
        assert_eq!(of(&[(-0.5, -1.0), (0.5, -1.0)]), "enumeration");
        assert_eq!(of(&[(-0.5, -1.0), (-0.1, -1.0), (0.2, -1.0), (0.5, -1.0)]), "newton");
    }

    #[test]
    fn separate_bodies_are_enumerated_one_by_one() {
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
    fn a_few_coupled_contacts_are_solved_beyond_the_tolerance() {
        let points = [(-0.5, -1.0), (-0.1, -1.0), (0.2, -1.0), (0.5, -1.0)];
        let (outcome, _) = outcome(&body_on_floor("feet", 0.3, &points, [0.3, -1.0, 0.2], 0.5));
        assert!(outcome.residual.global < 1e-13, "{outcome:?}");
    }
}
