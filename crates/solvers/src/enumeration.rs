//! Exact enumeration of contact states, for up to five plane contacts.
//!
//! Each contact is open, sticks, or slides to the right or left. Each of the 4ⁿ combinations is a
//! linear system (n ≤ 5: at most 10 × 10) whose solution is checked against the inequalities of the
//! law. There is no iteration and no tolerance except for rounding.
//!
//! For up to three contacts the combinations are the leaves of a tree. On the way down each contact
//! is eliminated in one of its states, so that a leaf is the 2 × 2 problem of the last contact. All
//! leaves share the work above them, and most fail a sign check.
//!
//! Before the tree is searched, likely states are tried (`likely.rs`). If they are valid with a
//! margin, the solve is complete. The tree handles the rest: boundaries between states, and
//! problems with strongly coupled states.
//!
//! Four and five contacts have 256 and 1024 combinations, which are tried one by one, each with a
//! completely pivoted solve. This takes tenths of a millisecond and some milliseconds;
//! [`Auto`](crate::Auto) uses it when all else has failed.
//!
//! Hyperstatic contacts (two sticking corners of one body) make the system of a state singular;
//! then its least-norm solution is taken. The least-norm point of all impulses that satisfy the law
//! lies on a face of the cones, and each face is a state, so the valid state with the least norm
//! gives this point.
//!
//! The enumeration of states is as old as the linear complementarity form of plane friction
//! (Klarbring 1990, doi 10.1007/BF00534316); the choice by the norm and trying likely states first
//! are additions here.

use crate::least_norm::{MAX, System};
use crate::{likely, one_contact};
use nalgebra::{Matrix2, Vector2};
use teeter_contact::{
    ContactProblem, ContactSolver, Delassus, Law, Outcome, Residual, Status, Stop, judge, judge_velocities,
};

/// Up to this number of contacts the states are searched as a tree: 4³ = 64 leaves.
pub(crate) const TREE_CONTACTS: usize = 3;
/// Largest number of contacts: 4⁵ = 1024 states.
pub(crate) const MAX_CONTACTS: usize = 5;
/// Tolerance of an inequality, relative to the terms summed on its left side: the rounding of a 10
/// × 10 solve.
pub(crate) const ROUNDING: f64 = 1e-13;
/// The same for a well-conditioned solve: some units in the last digit.
const SHARP_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The exact 2D solver for up to five contacts; see the [crate's table](crate).
///
/// `iterations` counts the states tried. With more than five contacts, or if no state is valid, the
/// status is [`Status::Breakdown`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Enumeration;

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum ContactState {
    Open,
    Stick,
    /// Sliding, with the sign of u_T.
    Slide(f64),
}

impl Enumeration {
    /// The name by which users choose it.
    pub const NAME: &'static str = "enumeration";

    /// Largest number of contacts.
    pub const MAX_CONTACTS: usize = MAX_CONTACTS;

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl ContactSolver<2> for Enumeration {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, _contacts: usize, _blocks: usize) {}

    #[inline(always)] // Of a single contact, so that `Auto` has no calls on the way to it.
    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
        if problem.contacts() != 1 {
            return solve_several(problem, stop, p);
        }
        let solution = one_contact::solve_near(&problem.diagonal(0), &problem.q()[0], problem.mu()[0], &p[0]);
        p[0] = solution.unwrap_or(p[0]);
        judged(solution.is_some(), 1, judge(problem, p), stop)
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(*self)
    }
}

/// The outcome of a search that tried so many states.
#[inline]
fn judged(found: bool, tried: u32, residual: Residual, stop: &Stop<'_>) -> Outcome {
    // The comparison is false for a NaN.
    let status = if found && residual.global <= stop.tolerance { Status::Converged } else { Status::Breakdown };
    Outcome::new(status, Enumeration::NAME, tried, residual)
}

/// Any number of contacts but one.
fn solve_several(problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
    let n = problem.contacts();
    let (found, tried, residual) = match n {
        2..=TREE_CONTACTS => {
            let table = BlockTable::<TREE_CONTACTS>::new(problem);
            let (likely, tried) = likely::find(&table, p);
            if let Some((impulses, velocities)) = likely {
                let residual = judge_velocities(problem, &impulses[..n], &velocities[..n]);
                if residual.global <= stop.tolerance {
                    p.copy_from_slice(&impulses[..n]);
                    return Outcome::new(Status::Converged, Enumeration::NAME, tried, residual);
                }
            }
            let (found, searched, residual) = search_with_retry(problem, stop, table, p, |table, p| table.search(p));
            (found, tried + searched, residual)
        }
        4 => search_with_retry(problem, stop, BlockTable::<4>::new(problem), p, |table, p| table.try_all::<8>(p)),
        MAX_CONTACTS => search_with_retry(problem, stop, BlockTable::<MAX_CONTACTS>::new(problem), p, |table, p| {
            table.try_all::<{ 2 * MAX_CONTACTS }>(p)
        }),
        _ => (n == 0, 0, judge(problem, p)),
    };
    judged(found, tried, residual, stop)
}

/// Searches the states for impulses that satisfy the law to rounding; if these miss the tolerance,
/// searches again with the sharper limit. (If two corners of one body can't quite both stick, some
/// states satisfy the law only to rounding.) Returns whether a state is valid, how many were tried,
/// and the residual.
fn search_with_retry<const N: usize>(
    problem: &ContactProblem<'_, 2>,
    stop: &Stop<'_>,
    mut table: BlockTable<N>,
    p: &mut [Vector2<f64>],
    search: impl Fn(&BlockTable<N>, &mut [Vector2<f64>]) -> (bool, u32),
) -> (bool, u32, Residual) {
    let (found, tried) = search(&table, p);
    let mut residual = judge(problem, p);
    if !found || residual.global <= stop.tolerance {
        return (found, tried, residual);
    }
    table.slack = SHARP_ROUNDING;
    let mut sharp = [Vector2::zeros(); N];
    let sharp = &mut sharp[..problem.contacts()];
    let (found, more) = search(&table, sharp);
    let judged = judge(problem, sharp);
    if found && judged.global < residual.global {
        p.copy_from_slice(sharp);
        residual = judged;
    }
    (true, tried + more, residual)
}

/// The blocks of the problem in a dense table.
pub(crate) struct BlockTable<const N: usize = TREE_CONTACTS> {
    pub(crate) n: usize,
    pub(crate) h: [[Matrix2<f64>; N]; N],
    pub(crate) q: [Vector2<f64>; N],
    pub(crate) mu: [f64; N],
    /// Tolerance of an inequality, relative to the terms summed on its left side.
    slack: f64,
}

/// Impulses, or velocities, of all contacts.
pub(crate) type Impulses<const N: usize = TREE_CONTACTS> = [Vector2<f64>; N];

impl<const N: usize> BlockTable<N> {
    fn new(problem: &ContactProblem<'_, 2>) -> Self {
        let n = problem.contacts();
        let mut table =
            Self { n, h: [[Matrix2::zeros(); N]; N], q: [Vector2::zeros(); N], mu: [0.0; N], slack: ROUNDING };
        table.mu[..n].copy_from_slice(problem.mu());
        table.q[..n].copy_from_slice(problem.q());
        match problem.delassus() {
            Delassus::Dense(blocks) => {
                for i in 0..n {
                    table.h[i][..n].copy_from_slice(&blocks[i * n..(i + 1) * n]);
                }
            }
            Delassus::Operator(h) => {
                // Column by column, by products with unit vectors.
                let mut unit = [Vector2::zeros(); N];
                for j in 0..n {
                    for c in 0..2 {
                        unit[j][c] = 1.0;
                        for i in 0..n {
                            table.h[i][j].set_column(c, &h.row_product(i, &unit[..n]));
                        }
                        unit[j][c] = 0.0;
                    }
                }
            }
            _ => {
                for i in 0..n {
                    for (j, block) in problem.row(i).into_iter().flatten() {
                        table.h[i][j] = *block;
                    }
                }
            }
        }
        table
    }

    /// Whether impulses satisfy the law in these states, up to rounding.
    fn obeys(&self, states: &[ContactState; N], p: &Impulses<N>) -> bool {
        for i in 0..self.n {
            let mut u = self.q[i];
            let mut size = u.abs();
            for j in 0..self.n {
                u += self.h[i][j] * p[j];
                size += self.h[i][j].abs() * p[j].abs();
            }
            let (slack_n, slack_t) = (self.slack * size[0], self.slack * (size[0] + size[1]));
            let slack_p = slack_n / self.h[i][i][(0, 0)];
            let presses = p[i][0] >= -slack_p && u[0].abs() <= slack_n;
            let fits = match states[i] {
                ContactState::Open => u[0] >= -slack_n,
                ContactState::Slide(sigma) => presses && (sigma * u[1] >= -slack_t || self.mu[i] == 0.0),
                ContactState::Stick => {
                    presses && p[i][1].abs() <= self.mu[i] * p[i][0] + slack_p && u[1].abs() <= slack_t
                }
            };
            if !fits {
                return false;
            }
        }
        true
    }

    /// The impulses of a combination of states by a pivoted solve, with the least norm if they
    /// aren't unique.
    fn pivoted<const M: usize>(&self, states: &[ContactState; N]) -> Option<Impulses<N>> {
        // Unknown k is the magnitude of an impulse along (1, −σμ) at a sliding contact, or a
        // component at a sticking one; its equation is a row of u = 0.
        let mut rows = [(0, 0); M];
        let mut tangent = [0.0; M];
        let mut m = 0;
        for i in 0..self.n {
            if states[i] == ContactState::Open {
                continue;
            }
            rows[m] = (i, 0);
            m += 1;
            match states[i] {
                ContactState::Slide(sigma) => tangent[m - 1] = -sigma * self.mu[i],
                _ => {
                    rows[m] = (i, 1);
                    m += 1;
                }
            }
        }
        let mut system = System::<M>::new(m);
        for (r, &(i, a)) in rows[..m].iter().enumerate() {
            for (c, &(j, b)) in rows[..m].iter().enumerate() {
                let h = &self.h[i][j];
                system.a[r][c] = h[(a, b)] + if tangent[c] == 0.0 { 0.0 } else { h[(a, 1)] * tangent[c] };
            }
            system.b[r] = -self.q[i][a];
            system.scale[r] = self.h[i][i][(a, a)].max(f64::MIN_POSITIVE).sqrt();
            system.length[r] = tangent[r].hypot(1.0);
        }
        let x = system.solve()?;
        let mut p = [Vector2::zeros(); N];
        for (k, &(i, a)) in rows[..m].iter().enumerate() {
            p[i][a] += x[k];
            p[i][1] += tangent[k] * x[k];
        }
        Some(p)
    }

    /// Tries the combinations of states one by one, with `M` = 2 `N`, and leaves the smallest valid
    /// impulses in `p`. Returns whether a combination is valid, and how many were tried.
    fn try_all<const M: usize>(&self, p: &mut [Vector2<f64>]) -> (bool, u32) {
        let mut best: Option<(f64, Impulses<N>)> = None;
        let mut tried = 0;
        // The base-4 digits of the combination's number are the states.
        'combinations: for number in 0..1_u32 << (2 * self.n) {
            let mut states = [ContactState::Open; N];
            for (i, state) in states[..self.n].iter_mut().enumerate() {
                let digit = (number >> (2 * i) & 3) as usize;
                // Without friction there is no sticking, and sliding left is the same as sliding
                // right.
                if self.mu[i] == 0.0 && digit > 1 {
                    continue 'combinations;
                }
                *state = STATES[digit];
            }
            tried += 1;
            let Some(found) = self.pivoted::<M>(&states) else { continue };
            let norm: f64 = found.iter().map(Vector2::norm_squared).sum();
            if best.is_none_or(|(best, _)| norm < best) && self.obeys(&states, &found) {
                best = Some((norm, found));
            }
        }
        if let Some((_, best)) = best {
            p.copy_from_slice(&best[..self.n]);
        }
        (best.is_some(), tried)
    }
}

impl BlockTable {
    /// Tries the states and leaves the smallest valid impulses in `p`. Returns whether a state is
    /// valid, and how many were tried.
    fn search(&self, p: &mut [Vector2<f64>]) -> (bool, u32) {
        let mut search = TreeSearch {
            table: self,
            states: [ContactState::Open; TREE_CONTACTS],
            gains: [Matrix2::zeros(); TREE_CONTACTS],
            speed: self.q.iter().map(Vector2::amax).fold(0.0, f64::max),
            best: None,
            tried: 0,
        };
        search.descend(0, &self.h, &self.q);
        if let Some((_, best)) = search.best {
            p.copy_from_slice(&best[..self.n]);
        }
        (search.best.is_some(), search.tried)
    }
}

/// A search through the tree of states.
struct TreeSearch<'a> {
    table: &'a BlockTable,
    states: [ContactState; TREE_CONTACTS],
    /// p_k = −gain · (velocity of contact k without its own impulse), for the contacts eliminated
    /// so far.
    gains: [Matrix2<f64>; TREE_CONTACTS],
    /// The largest component of q, the scale of velocities.
    speed: f64,
    best: Option<(f64, Impulses)>,
    tried: u32,
}

const STATES: [ContactState; 4] =
    [ContactState::Open, ContactState::Slide(1.0), ContactState::Slide(-1.0), ContactState::Stick];

impl TreeSearch<'_> {
    /// The distinct states of contact `k`: without friction there is no sticking, and sliding left
    /// is the same as sliding right.
    fn states_of(&self, k: usize) -> &'static [ContactState] {
        if self.table.mu[k] == 0.0 { &STATES[..2] } else { &STATES }
    }

    /// Whether the smallest possible impulses were found.
    fn done(&self) -> bool {
        self.best.is_some_and(|(norm, _)| norm == 0.0)
    }

    /// Eliminates contact `k` in each of its states from the problem (h, q) of the contacts from
    /// `k` on.
    fn descend(&mut self, k: usize, h: &[[Matrix2<f64>; TREE_CONTACTS]; TREE_CONTACTS], q: &Impulses) {
        let n = self.table.n;
        for &state in self.states_of(k) {
            if self.done() {
                return;
            }
            self.states[k] = state;
            let Some(gain) = gain(state, &h[k][k], self.table.mu[k], &self.table.h[k][k]) else {
                self.all_pivoted(k + 1);
                continue;
            };
            self.gains[k] = gain;
            if k + 1 == n {
                self.tried += 1;
                let p = -(gain * q[k]);
                let slack = SIGN_TOLERANCE * self.speed;
                if plausible(state, &(q[k] + h[k][k] * p), slack, &p, slack * gain.amax(), self.table.mu[k]) {
                    self.leaf(&p);
                }
                continue;
            }
            let (mut reduced, mut rest) = (*h, *q);
            if state != ContactState::Open {
                for i in k + 1..n {
                    let back = h[i][k] * gain;
                    rest[i] -= back * q[k];
                    for j in k + 1..n {
                        reduced[i][j] -= back * h[k][j];
                    }
                }
            }
            self.descend(k + 1, &reduced, &rest);
        }
    }

    /// Computes all impulses from the last contact's, and offers them.
    fn leaf(&mut self, last: &Vector2<f64>) {
        let table = self.table;
        let mut p = [Vector2::zeros(); TREE_CONTACTS];
        p[table.n - 1] = *last;
        // Contact k was eliminated before the later contacts, with the velocities left by the
        // earlier ones.
        for k in (0..table.n - 1).rev() {
            p[k] = self.eliminated(k, &p);
        }
        if !self.offer(&p) {
            // Small pivots in the elimination lose digits that the pivoted solve keeps.
            self.offer_pivoted();
        }
    }

    /// The impulse of contact `k` given the later ones, with the earlier ones eliminated.
    fn eliminated(&self, k: usize, p: &Impulses) -> Vector2<f64> {
        let table = self.table;
        let velocity = |i: usize| (k + 1..table.n).fold(table.q[i], |u, j| u + table.h[i][j] * p[j]);
        match k {
            0 => -(self.gains[0] * velocity(0)),
            // Contact 1 of three: contact 0, already eliminated, responds to it and to contact 2.
            _ => {
                let give = table.h[1][0] * self.gains[0];
                let u = velocity(1) - give * velocity(0);
                -(self.gains[1] * u)
            }
        }
    }

    /// Offers the pivoted solutions of all combinations of states from contact `k` on, with the
    /// earlier states fixed.
    fn all_pivoted(&mut self, k: usize) {
        if k < self.table.n {
            for &state in self.states_of(k) {
                self.states[k] = state;
                self.all_pivoted(k + 1);
            }
            return;
        }
        self.tried += 1;
        self.offer_pivoted();
    }

    fn offer_pivoted(&mut self) {
        if let Some(p) = self.table.pivoted::<MAX>(&self.states) {
            self.offer(&p);
        }
    }

    /// Keeps impulses that satisfy the law if they are the smallest so far; false if they don't
    /// satisfy it.
    fn offer(&mut self, p: &Impulses) -> bool {
        let norm: f64 = p.iter().map(Vector2::norm_squared).sum();
        if self.best.is_some_and(|(best, _)| norm >= best) {
            return true;
        }
        let obeys = self.table.obeys(&self.states, p);
        if obeys {
            self.best = Some((norm, *p));
        }
        obeys
    }
}

/// The matrix `gain` of a contact in a state, p = −gain u. `h` is its block with other contacts
/// eliminated, `original` the original block. `None` if the impulse is (nearly) undetermined.
fn gain(state: ContactState, h: &Matrix2<f64>, mu: f64, original: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    match state {
        ContactState::Open => Some(Matrix2::zeros()),
        ContactState::Slide(sigma) => {
            let compliance = h[(0, 0)] - sigma * mu * h[(0, 1)];
            let size = original[(0, 0)] + mu * original[(0, 1)].abs();
            (compliance.abs() > LEAST_PIVOT * size)
                .then(|| Matrix2::new(1.0 / compliance, 0.0, -sigma * mu / compliance, 0.0))
        }
        ContactState::Stick => {
            let determinant = h[(0, 0)] * h[(1, 1)] - h[(0, 1)] * h[(1, 0)];
            let size = original[(0, 0)] * original[(1, 1)];
            (determinant.abs() > LEAST_PIVOT * size)
                .then(|| Matrix2::new(h[(1, 1)], -h[(0, 1)], -h[(1, 0)], h[(0, 0)]) / determinant)
        }
    }
}

/// A pivot below this fraction of its block is left to the pivoted solve. A small pivot amplifies
/// the rounding of the next one, and a zero pivot couldn't be detected. Two steps with this limit
/// stay far above rounding.
const LEAST_PIVOT: f64 = 1e-4;

/// Tolerance of the sign checks at the last contact, relative to the speeds of the problem, before
/// the exact check is made: far above the rounding of the elimination.
const SIGN_TOLERANCE: f64 = 1e-9;

/// Whether the last contact's velocity `u` and impulse `p` fit its state up to `slack_u` and
/// `slack_p`.
fn plausible(state: ContactState, u: &Vector2<f64>, slack_u: f64, p: &Vector2<f64>, slack_p: f64, mu: f64) -> bool {
    match state {
        ContactState::Open => u[0] >= -slack_u,
        ContactState::Slide(sigma) => p[0] >= -slack_p && (sigma * u[1] >= -slack_u || mu == 0.0),
        ContactState::Stick => p[1].abs() <= mu * p[0] + slack_p * (1.0 + mu),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::{body_on_floor, plane_cases, run};

    #[test]
    fn conforms_to_rounding() {
        run(&mut Enumeration::new(), &plane_cases(), 1e-14).unwrap();
    }

    fn solve(case: &teeter_contact::conformance::Case<2>) -> Vec<Vector2<f64>> {
        let mut p = vec![Vector2::zeros(); case.q.len()];
        let outcome =
            Enumeration::new().solve(&case.problem().unwrap(), &Stop::default().with_tolerance(1e-14), &mut p);
        assert!(outcome.converged(), "{outcome:?}");
        p
    }

    #[test]
    fn two_sticking_feet_share_the_tangential_impulse_evenly() {
        let feet = [(-0.5, -1.0), (0.5, -1.0)];
        let p = solve(&body_on_floor("stick", 0.3, &feet, [0.01, -1.0, 0.0], 0.5));
        assert!((p[0][1] - p[1][1]).abs() < 1e-15, "least norm: {p:?}");
        assert!((p[0][1] + p[1][1] + 0.01).abs() < 1e-15, "the sum stops the body");
    }

    #[test]
    fn uneven_shares_are_taken_if_even_ones_violate_a_cone() {
        // The body tips forward, so the rear foot has a small normal impulse and half of the
        // tangential impulse would violate its cone.
        let feet = [(-0.5, -1.0), (0.5, -1.0)];
        let p = solve(&body_on_floor("tips", 0.3, &feet, [0.4, -1.0, 0.0], 0.5));
        let (rear, front) = if p[0][0] < p[1][0] { (p[0], p[1]) } else { (p[1], p[0]) };
        assert!(rear[1].abs() <= 0.5 * rear[0] + 1e-15 && (rear[1].abs() - 0.5 * rear[0]).abs() < 1e-14);
        assert!(front[1].abs() < 0.5 * front[0]);
        assert!((p[0][1] + p[1][1] + 0.4).abs() < 1e-14);
    }

    #[test]
    fn four_and_five_contacts_are_solved_to_rounding() {
        for n in [4, 5] {
            let feet: Vec<_> = (0..n).map(|k| (f64::from(k) * 0.3 - 0.5, -1.0)).collect();
            for push in [[0.01, -1.0, 0.0], [0.9, -1.0, 0.2], [0.4, -1.0, -0.6], [0.1, 1.0, 0.3]] {
                let p = solve(&body_on_floor("feet", 0.3, &feet, push, 0.5));
                assert!(p.iter().all(|p| p[0] >= 0.0));
            }
        }
    }

    /// A body that stands on rough ground is struck: the ground keeps it, or its friction there lifts it. Both satisfy the law.
    #[test]
    fn what_stood_before_a_blow_stands_on_whatever_rounding_its_velocity_has() {
        let block = |a, b, c, d| Matrix2::new(a, b, c, d);
        let h = [
            block(0.05718, -0.01036, -0.01036, 0.18947),
            block(-0.00734, -0.02742, -0.02195, 0.02975),
            block(-0.00734, -0.02195, -0.02742, 0.02975),
            block(0.05085, -0.02569, -0.02569, 0.05089),
        ];
        for rounding in [-1e-8, 0.0, 1e-8] {
            let q = [Vector2::new(-2.83275, 6.31221), Vector2::new(rounding, 10.0 * rounding)];
            let problem = ContactProblem::new(Delassus::Dense(&h), &q, &[5.0, 5.0]).unwrap();
            let stood = [Vector2::zeros(), Vector2::new(2e-3, 9e-4)];
            for (start, presses) in [(stood, true), ([Vector2::new(1.0, -0.7), Vector2::zeros()], false)] {
                let mut p = start;
                let outcome = Enumeration::new().solve(&problem, &Stop::default(), &mut p);
                assert!(outcome.converged(), "{outcome:?}");
                assert_eq!(p[1][0] > 40.0, presses, "{rounding}: {p:?}");
                assert!(presses || p[1] == Vector2::zeros());
            }
        }
    }

    #[test]
    fn more_than_five_contacts_give_a_breakdown() {
        let feet = [(-0.5, -1.0), (-0.2, -1.0), (-0.1, -1.0), (0.2, -1.0), (0.4, -1.0), (0.5, -1.0)];
        let case = body_on_floor("six", 0.3, &feet, [0.0, -1.0, 0.0], 0.5);
        let mut p = vec![Vector2::zeros(); 6];
        let outcome = Enumeration::new().solve(&case.problem().unwrap(), &Stop::default(), &mut p);
        assert_eq!(outcome.status, Status::Breakdown);
    }

    #[test]
    fn contacts_of_very_different_mass_are_not_hyperstatic() {
        let mut case = body_on_floor("light", 0.3, &[(-0.5, -1.0)], [0.0, -1.0, 0.0], 0.5);
        let heavy = body_on_floor("heavy", 0.3, &[(-0.5, -1.0)], [1.0, -1.0, 0.0], 0.5);
        case.h = vec![
            case.h[0],
            teeter_contact::Block::<2>::zeros(),
            teeter_contact::Block::<2>::zeros(),
            heavy.h[0] * 1e-9,
        ];
        case.q.push(heavy.q[0]);
        case.mu.push(0.5);
        let p = solve(&case);
        assert!(p[1][0] > 1e8);
    }
}
