//! Exact enumeration of contact states, for up to five plane contacts.
//!
//! Each contact is open, sticks, or slides to the right or left; each of the 4ⁿ combinations is a small linear system
//! (n ≤ 5: at most 10 × 10) whose solution is checked against the inequalities of the law. There is no iteration and no
//! tolerance of its own beyond rounding.
//!
//! Up to three contacts the combinations are the leaves of a tree. On the way down each contact is eliminated in one of its states, so that a
//! leaf is left with the 2 × 2 problem of the last contact: all leaves share the work above them, and most fail a
//! sign there.
//!
//! Before the walk through the tree the likely states are tried, one by one (`likely.rs`): that is the whole solve wherever they
//! fit with room to spare. The tree is for the rest: borders between states, and problems where a contact can't choose alone.
//!
//! Four and five contacts have 256 and 1024 combinations. They are gone through one by one, each by a solve with complete pivoting: some
//! tenths of a millisecond and some milliseconds, which [`Auto`](crate::Auto) spends where all else has failed.
//!
//! Hyperstatic contacts (two sticking corners of one body) make the system of a state singular: its solution of least
//! norm is taken. The least-norm point of all impulses that obey the law lies on a face of the cones, and a face is a
//! state; so of the states that fit, the one of smallest norm is that point.
//!
//! The enumeration of states is as old as the linear complementarity form of plane friction (Klarbring 1990,
//! doi 10.1007/BF00534316); choosing by the norm is ours, and so is trying the likely states first.

use crate::least_norm::{MAX, System};
use crate::{likely, one_contact};
use nalgebra::{Matrix2, Vector2};
use teeter_contact::{
    ContactProblem, ContactSolver, Delassus, Law, Outcome, Residual, Status, Stop, judge, judge_velocities,
};

/// Up to so many contacts the states are a tree: 4³ = 64 leaves.
pub(crate) const FEW: usize = 3;
/// Most contacts that are enumerated: 4⁵ = 1024 states.
pub(crate) const MAX_CONTACTS: usize = 5;
/// How far an inequality may be missed, relative to the terms that its left side is the sum of: rounding of a 10 × 10 solve.
pub(crate) const ROUNDING: f64 = 1e-13;
/// The same of a good solve: some units of the last digit.
const SHARP: f64 = 16.0 * f64::EPSILON;

/// The exact 2D solver for up to five contacts; see the [crate's table](crate).
///
/// `iterations` counts the states tried. With more than five contacts, or where no state fits, the status is
/// [`Status::Breakdown`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Enumeration;

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum State {
    Open,
    Stick,
    /// Slides; the sign of u_T.
    Slide(f64),
}

impl Enumeration {
    /// The name by which users choose it.
    pub const NAME: &'static str = "enumeration";

    /// Most contacts that it takes.
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
        let solution = one_contact::solve(&problem.diagonal(0), &problem.q()[0], problem.mu()[0]);
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
    // Written so that a NaN counts as not solved.
    let status = if found && residual.global <= stop.tolerance { Status::Converged } else { Status::Breakdown };
    Outcome::new(status, Enumeration::NAME, tried, residual)
}

/// Any number of contacts but one.
fn solve_several(problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
    let n = problem.contacts();
    let (found, tried, residual) = match n {
        2..=FEW => {
            let table = Table::<FEW>::new(problem);
            let (likely, tried) = likely::find(&table, p);
            if let Some((impulses, velocities)) = likely {
                let residual = judge_velocities(problem, &impulses[..n], &velocities[..n]);
                if residual.global <= stop.tolerance {
                    p.copy_from_slice(&impulses[..n]);
                    return Outcome::new(Status::Converged, Enumeration::NAME, tried, residual);
                }
            }
            let (found, searched, residual) = sharply(problem, stop, table, p, |table, p| table.search(p));
            (found, tried + searched, residual)
        }
        4 => sharply(problem, stop, Table::<4>::new(problem), p, |table, p| table.try_all::<8>(p)),
        MAX_CONTACTS => sharply(problem, stop, Table::<MAX_CONTACTS>::new(problem), p, |table, p| {
            table.try_all::<{ 2 * MAX_CONTACTS }>(p)
        }),
        _ => (n == 0, 0, judge(problem, p)),
    };
    judged(found, tried, residual, stop)
}

/// Searches the states for impulses that obey the law to rounding; where those aren't good enough for the tolerance, for such that obey it to the
/// last digits. Corners of one body that can't quite both stick have states that fit to rounding and others that fit. Returns whether there are any, how
/// many states were tried, and the residual.
fn sharply<const N: usize>(
    problem: &ContactProblem<'_, 2>,
    stop: &Stop<'_>,
    mut table: Table<N>,
    p: &mut [Vector2<f64>],
    search: impl Fn(&Table<N>, &mut [Vector2<f64>]) -> (bool, u32),
) -> (bool, u32, Residual) {
    let (found, tried) = search(&table, p);
    let mut residual = judge(problem, p);
    if !found || residual.global <= stop.tolerance {
        return (found, tried, residual);
    }
    table.slack = SHARP;
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

/// The problem with its blocks at hand.
pub(crate) struct Table<const N: usize = FEW> {
    pub(crate) n: usize,
    pub(crate) h: [[Matrix2<f64>; N]; N],
    pub(crate) q: [Vector2<f64>; N],
    pub(crate) mu: [f64; N],
    /// How far an inequality may be missed, relative to the terms that its left side is the sum of.
    slack: f64,
}

/// Impulses, or velocities, of all contacts.
pub(crate) type Impulses<const N: usize = FEW> = [Vector2<f64>; N];

impl<const N: usize> Table<N> {
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

    /// Whether impulses obey the law in these states, up to rounding.
    fn obeys(&self, states: &[State; N], p: &Impulses<N>) -> bool {
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
                State::Open => u[0] >= -slack_n,
                State::Slide(sigma) => presses && (sigma * u[1] >= -slack_t || self.mu[i] == 0.0),
                State::Stick => presses && p[i][1].abs() <= self.mu[i] * p[i][0] + slack_p && u[1].abs() <= slack_t,
            };
            if !fits {
                return false;
            }
        }
        true
    }

    /// The impulses of a combination of states by a pivoted solve, of least norm where it leaves a choice.
    fn pivoted<const M: usize>(&self, states: &[State; N]) -> Option<Impulses<N>> {
        // Unknown k is the size of an impulse along (1, −σμ) at a contact, or a component of a sticking one's; its
        // equation is a row of u = 0.
        let mut rows = [(0, 0); M];
        let mut tangent = [0.0; M];
        let mut m = 0;
        for i in 0..self.n {
            if states[i] == State::Open {
                continue;
            }
            rows[m] = (i, 0);
            m += 1;
            match states[i] {
                State::Slide(sigma) => tangent[m - 1] = -sigma * self.mu[i],
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

    /// Tries the combinations of states one by one, `M` = 2 `N`; leaves the smallest impulses that fit in `p`. Returns
    /// whether one fits, and how many were tried.
    fn try_all<const M: usize>(&self, p: &mut [Vector2<f64>]) -> (bool, u32) {
        let mut best: Option<(f64, Impulses<N>)> = None;
        let mut tried = 0;
        // The combination's number, its digits to the base of four the states.
        'combinations: for number in 0..1_u32 << (2 * self.n) {
            let mut states = [State::Open; N];
            for (i, state) in states[..self.n].iter_mut().enumerate() {
                let digit = (number >> (2 * i) & 3) as usize;
                // Without friction there is nothing to stick, and sliding to the left is sliding to the right.
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

impl Table {
    /// Tries the states; leaves the smallest impulses that fit in `p`. Returns whether one fits, and how many were tried.
    fn search(&self, p: &mut [Vector2<f64>]) -> (bool, u32) {
        let mut search = Search {
            table: self,
            states: [State::Open; FEW],
            gains: [Matrix2::zeros(); FEW],
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

/// A walk through the tree of states.
struct Search<'a> {
    table: &'a Table,
    states: [State; FEW],
    /// p_k = −gain (velocity of contact k without its own impulse), for the contacts eliminated so far.
    gains: [Matrix2<f64>; FEW],
    /// The largest component of q: what velocities are small against.
    speed: f64,
    best: Option<(f64, Impulses)>,
    tried: u32,
}

const STATES: [State; 4] = [State::Open, State::Slide(1.0), State::Slide(-1.0), State::Stick];

impl Search<'_> {
    /// The states of contact `k` that differ: without friction there is nothing to stick, and sliding to the left is
    /// sliding to the right.
    fn states_of(&self, k: usize) -> &'static [State] {
        if self.table.mu[k] == 0.0 { &STATES[..2] } else { &STATES }
    }

    /// Whether impulses as small as can be were found.
    fn done(&self) -> bool {
        self.best.is_some_and(|(norm, _)| norm == 0.0)
    }

    /// Eliminates contact `k` in each of its states from the problem (h, q) of the contacts from `k` on.
    fn descend(&mut self, k: usize, h: &[[Matrix2<f64>; FEW]; FEW], q: &Impulses) {
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
                let slack = ROUGHLY * self.speed;
                if plausible(state, &(q[k] + h[k][k] * p), slack, &p, slack * gain.amax(), self.table.mu[k]) {
                    self.leaf(&p);
                }
                continue;
            }
            let (mut reduced, mut rest) = (*h, *q);
            if state != State::Open {
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

    /// Goes back up from the last contact's impulse, and offers the impulses of all.
    fn leaf(&mut self, last: &Vector2<f64>) {
        let table = self.table;
        let mut p = [Vector2::zeros(); FEW];
        p[table.n - 1] = *last;
        // Contact k was eliminated before those after it, in the velocities that those before it had left.
        for k in (0..table.n - 1).rev() {
            p[k] = self.eliminated(k, &p);
        }
        if !self.offer(&p) {
            // Small pivots on the way down cost digits that the pivoted solve keeps.
            self.offer_pivoted();
        }
    }

    /// The impulse of contact `k` given those after it, with those before it eliminated.
    fn eliminated(&self, k: usize, p: &Impulses) -> Vector2<f64> {
        let table = self.table;
        let velocity = |i: usize| (k + 1..table.n).fold(table.q[i], |u, j| u + table.h[i][j] * p[j]);
        match k {
            0 => -(self.gains[0] * velocity(0)),
            // Contact 1 of three: contact 0 gives way to it and to contact 2.
            _ => {
                let give = table.h[1][0] * self.gains[0];
                let u = velocity(1) - give * velocity(0);
                -(self.gains[1] * u)
            }
        }
    }

    /// Offers the pivoted solutions of all combinations of states from contact `k` on, those before it as they are.
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

    /// Keeps impulses that obey the law if none smaller are known; false for impulses that don't obey it.
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

/// How the impulse of a contact in a state answers its velocity: p = −gain u. `h` is its block with other contacts
/// eliminated, `original` the block itself. `None` where the state leaves the impulse undetermined, or nearly.
fn gain(state: State, h: &Matrix2<f64>, mu: f64, original: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    match state {
        State::Open => Some(Matrix2::zeros()),
        State::Slide(sigma) => {
            let compliance = h[(0, 0)] - sigma * mu * h[(0, 1)];
            let size = original[(0, 0)] + mu * original[(0, 1)].abs();
            (compliance.abs() > DOUBTFUL * size)
                .then(|| Matrix2::new(1.0 / compliance, 0.0, -sigma * mu / compliance, 0.0))
        }
        State::Stick => {
            let determinant = h[(0, 0)] * h[(1, 1)] - h[(0, 1)] * h[(1, 0)];
            let size = original[(0, 0)] * original[(1, 1)];
            (determinant.abs() > DOUBTFUL * size)
                .then(|| Matrix2::new(h[(1, 1)], -h[(0, 1)], -h[(1, 0)], h[(0, 0)]) / determinant)
        }
    }
}

/// A pivot below this part of its block is left to the pivoted solve: the one after it would hold the rounding that this one
/// magnifies, and a vanishing one couldn't be told from that. Two such steps in a row stay far above rounding.
const DOUBTFUL: f64 = 1e-4;

/// What a sign of the last contact may be missed by, relative to the speeds of the problem, before the exact test is not
/// worth its cost: far above rounding on the way down.
const ROUGHLY: f64 = 1e-9;

/// Whether the last contact's velocity `u` and impulse `p` may belong to its state, up to `slack_u` and `slack_p`.
fn plausible(state: State, u: &Vector2<f64>, slack_u: f64, p: &Vector2<f64>, slack_p: f64, mu: f64) -> bool {
    match state {
        State::Open => u[0] >= -slack_u,
        State::Slide(sigma) => p[0] >= -slack_p && (sigma * u[1] >= -slack_u || mu == 0.0),
        State::Stick => p[1].abs() <= mu * p[0] + slack_p * (1.0 + mu),
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
    fn where_even_shares_would_leave_a_cone_the_nearest_point_inside_is_taken() {
        // The body tips forward: the rear foot is light, and half of the tangential impulse would be beyond its cone.
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

    #[test]
    fn more_than_five_contacts_are_a_breakdown_not_a_panic() {
        let feet = [(-0.5, -1.0), (-0.2, -1.0), (-0.1, -1.0), (0.2, -1.0), (0.4, -1.0), (0.5, -1.0)];
        let case = body_on_floor("six", 0.3, &feet, [0.0, -1.0, 0.0], 0.5);
        let mut p = vec![Vector2::zeros(); 6];
        let outcome = Enumeration::new().solve(&case.problem().unwrap(), &Stop::default(), &mut p);
        assert_eq!(outcome.status, Status::Breakdown);
    }

    #[test]
    fn contacts_of_very_different_mass_are_not_mistaken_for_hyperstatic_ones() {
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
