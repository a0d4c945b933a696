//! Exact enumeration of contact states, for up to three plane contacts.
//!
//! Each contact is open, sticks, or slides to the right or left; each of the 4ⁿ combinations is a small linear system
//! (n ≤ 3: at most 6 × 6) whose solution is checked against the inequalities of the law. There is no iteration and no
//! tolerance of its own beyond rounding.
//!
//! Hyperstatic contacts (two sticking corners of one body) make the system of a state singular: its solution of least
//! norm is taken. The least-norm point of all impulses that obey the law lies on a face of the cones, and a face is a
//! state; so of the states that fit, the one of smallest norm is that point.
//!
//! The enumeration of states is as old as the linear complementarity form of plane friction (Klarbring 1990,
//! doi 10.1007/BF00534316); choosing by the norm is ours.

use crate::one_contact;
use nalgebra::Vector2;
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Status, Stop, judge};

/// Most contacts that are enumerated: 4³ = 64 states.
const MAX_CONTACTS: usize = 3;
/// Most unknowns: a normal and a tangential impulse a contact.
const MAX: usize = 2 * MAX_CONTACTS;

/// A pivot below this, relative to the compliances of its row and column, is taken for zero: hyperstatic contacts leave
/// pivots of some 1e-16, while two corners on a beam that slopes by w' leave w'² and more.
const RANK_TOLERANCE: f64 = 1e-12;

/// How far an inequality may be missed, relative to the terms that its left side is the sum of: rounding of a 6 × 6 solve.
const ROUNDING: f64 = 1e-13;

/// The exact 2D solver for up to three contacts; see the [crate's table](crate).
///
/// `iterations` counts the states tried. With more than three contacts, or where no state fits, the status is
/// [`Status::Breakdown`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Enumeration;

#[derive(Clone, Copy, PartialEq)]
enum State {
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

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
        let n = problem.contacts();
        let (found, tried) = match n {
            0 => (true, 0),
            1 => match one_contact::solve(&problem.diagonal(0), &problem.q()[0], problem.mu()[0]) {
                Some(solution) => {
                    p[0] = solution;
                    (true, 1)
                }
                None => (false, 1),
            },
            2..=MAX_CONTACTS => Table::new(problem).enumerate(p),
            _ => (false, 0),
        };
        let residual = judge(problem, p);
        // Written so that a NaN counts as not solved.
        let status = if found && residual.global <= stop.tolerance { Status::Converged } else { Status::Breakdown };
        Outcome::new(status, Self::NAME, tried, residual)
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(*self)
    }
}

/// The problem as plain arrays: row 2i is the normal, row 2i + 1 the tangent of contact i.
struct Table {
    n: usize,
    h: [[f64; MAX]; MAX],
    q: [f64; MAX],
    mu: [f64; MAX_CONTACTS],
}

impl Table {
    fn new(problem: &ContactProblem<'_, 2>) -> Self {
        let n = problem.contacts();
        let mut table = Self { n, h: [[0.0; MAX]; MAX], q: [0.0; MAX], mu: [0.0; MAX_CONTACTS] };
        let mut unit = [Vector2::zeros(); MAX_CONTACTS];
        table.mu[..n].copy_from_slice(problem.mu());
        for i in 0..n {
            table.q[2 * i] = problem.q()[i][0];
            table.q[2 * i + 1] = problem.q()[i][1];
        }
        if let teeter_contact::Delassus::Dense(blocks) = problem.delassus() {
            for i in 0..n {
                for j in 0..n {
                    let block = &blocks[i * n + j];
                    for r in 0..2 {
                        for c in 0..2 {
                            table.h[2 * i + r][2 * j + c] = block[(r, c)];
                        }
                    }
                }
            }
        } else {
            // Any other shape, column by column: H e_k = (velocity of e_k) − q.
            for k in 0..2 * n {
                unit[k / 2][k % 2] = 1.0;
                for i in 0..n {
                    let u = problem.velocity(i, &unit[..n]) - problem.q()[i];
                    table.h[2 * i][k] = u[0];
                    table.h[2 * i + 1][k] = u[1];
                }
                unit[k / 2][k % 2] = 0.0;
            }
        }
        table
    }

    /// Tries the states; leaves the smallest impulses that fit in `p`. Returns whether one fits, and how many were tried.
    fn enumerate(&self, p: &mut [Vector2<f64>]) -> (bool, u32) {
        let mut best: Option<(f64, [f64; MAX])> = None;
        let mut tried = 0;
        let mut states = [State::Open; MAX_CONTACTS];
        for code in 0..4_u32.pow(self.n as u32) {
            if !self.decode(code, &mut states) {
                continue;
            }
            tried += 1;
            let Some(x) = self.fit(&states) else { continue };
            let norm = x.iter().map(|c| c * c).sum::<f64>();
            if best.is_none_or(|(b, _)| norm < b) {
                best = Some((norm, x));
            }
            if norm == 0.0 {
                break; // nothing is smaller
            }
        }
        if let Some((_, x)) = best {
            for (i, p_i) in p.iter_mut().enumerate() {
                *p_i = Vector2::new(x[2 * i], x[2 * i + 1]);
            }
        }
        (best.is_some(), tried)
    }

    /// The states of a code in base 4. False for a code that only repeats another one: without friction there is
    /// nothing to stick, and sliding to the left is sliding to the right.
    fn decode(&self, code: u32, states: &mut [State; MAX_CONTACTS]) -> bool {
        for (i, state) in states.iter_mut().enumerate().take(self.n) {
            let digit = (code >> (2 * i)) & 3;
            if self.mu[i] == 0.0 && digit > 1 {
                return false;
            }
            *state = match digit {
                0 => State::Open,
                1 => State::Slide(1.0),
                2 => State::Slide(-1.0),
                _ => State::Stick,
            };
        }
        true
    }

    /// The impulses of a combination of states, if they obey the law.
    fn fit(&self, states: &[State; MAX_CONTACTS]) -> Option<[f64; MAX]> {
        // Unknown k acts along direction d_k = (1, −σμ) at a contact (or (0, 1) for the tangent of a sticking one) and
        // its equation is a row of u = 0.
        let mut rows = [0; MAX];
        let mut tangent = [0.0; MAX];
        let mut m = 0;
        for i in 0..self.n {
            match states[i] {
                State::Open => {}
                State::Slide(sigma) => {
                    rows[m] = 2 * i;
                    tangent[m] = -sigma * self.mu[i];
                    m += 1;
                }
                State::Stick => {
                    rows[m] = 2 * i;
                    rows[m + 1] = 2 * i + 1;
                    m += 2;
                }
            }
        }
        let mut system = System { m, a: [[0.0; MAX]; MAX], x: [0.0; MAX] };
        for r in 0..m {
            let row = &self.h[rows[r]];
            for c in 0..m {
                let mut a = row[rows[c]];
                if tangent[c] != 0.0 {
                    a += row[rows[c] + 1] * tangent[c];
                }
                system.a[r][c] = a;
            }
            system.x[r] = -self.q[rows[r]];
        }
        let mut scale = [0.0; MAX];
        for k in 0..m {
            scale[k] = self.h[rows[k]][rows[k]].max(f64::MIN_POSITIVE).sqrt();
        }
        let x = system.solve(&scale)?;
        let mut p = [0.0; MAX];
        for k in 0..m {
            p[rows[k]] += x[k];
            if tangent[k] != 0.0 {
                p[rows[k] + 1] += tangent[k] * x[k];
            }
        }
        self.obeys(states, &p).then_some(p)
    }

    /// Whether impulses with the equations of `states` also keep its inequalities, up to rounding.
    fn obeys(&self, states: &[State; MAX_CONTACTS], p: &[f64; MAX]) -> bool {
        for i in 0..self.n {
            let (n, t) = (2 * i, 2 * i + 1);
            let (mut u_n, mut u_t) = (self.q[n], self.q[t]);
            let (mut size_n, mut size_t) = (u_n.abs(), u_t.abs());
            for k in 0..2 * self.n {
                let (a, b) = (self.h[n][k] * p[k], self.h[t][k] * p[k]);
                u_n += a;
                u_t += b;
                size_n += a.abs();
                size_t += b.abs();
            }
            let (slack_n, slack_t) = (ROUNDING * size_n, ROUNDING * (size_t + size_n));
            let slack_p = slack_n / self.h[n][n];
            let fits = match states[i] {
                State::Open => u_n >= -slack_n,
                State::Slide(sigma) => {
                    p[n] >= -slack_p && u_n.abs() <= slack_n && (sigma * u_t >= -slack_t || self.mu[i] == 0.0)
                }
                State::Stick => {
                    p[t].abs() <= self.mu[i] * p[n] + slack_p
                        && p[n] >= -slack_p
                        && u_n.abs() <= slack_n
                        && u_t.abs() <= slack_t
                }
            };
            if !fits {
                return false;
            }
        }
        true
    }
}

/// A square system `a x = b` of order m ≤ 6, with `b` given in `x`.
struct System {
    m: usize,
    a: [[f64; MAX]; MAX],
    x: [f64; MAX],
}

impl System {
    /// The solution of least norm, by Gaussian elimination with complete pivoting relative to `scale`; `None` where a
    /// number overflows. Whether a singular system was consistent, the caller sees from the velocities.
    fn solve(mut self, scale: &[f64; MAX]) -> Option<[f64; MAX]> {
        let m = self.m;
        let mut column = [0, 1, 2, 3, 4, 5];
        let mut row_scale = *scale;
        let mut rank = m;
        for k in 0..m {
            let (mut best, mut at) = (0.0, (k, k));
            for r in k..m {
                for c in k..m {
                    let size = self.a[r][column[c]].abs() / (row_scale[r] * scale[column[c]]);
                    if size > best {
                        (best, at) = (size, (r, c));
                    }
                }
            }
            if best <= RANK_TOLERANCE {
                rank = k;
                break;
            }
            self.a.swap(k, at.0);
            self.x.swap(k, at.0);
            row_scale.swap(k, at.0);
            column.swap(k, at.1);
            let pivot = self.a[k];
            for r in k + 1..m {
                let factor = self.a[r][column[k]] / pivot[column[k]];
                if factor != 0.0 {
                    for c in k + 1..m {
                        self.a[r][column[c]] -= factor * pivot[column[c]];
                    }
                    self.x[r] -= factor * self.x[k];
                }
            }
        }
        // Back substitution with the free unknowns at zero …
        let mut solution = [0.0; MAX];
        let b = self.x;
        self.back_substitute(rank, &column, &b, &mut solution);
        // … then out of it what lies in the null space, so that the norm is least.
        let mut basis = [[0.0; MAX]; MAX_CONTACTS];
        for free in rank..m.min(rank + MAX_CONTACTS) {
            let mut null = [0.0; MAX];
            let mut b = [0.0; MAX];
            for r in 0..rank {
                b[r] = -self.a[r][column[free]];
            }
            self.back_substitute(rank, &column, &b, &mut null);
            null[column[free]] = 1.0;
            for earlier in &basis[..free - rank] {
                subtract_projection(&mut null, earlier);
            }
            let norm = null.iter().map(|c| c * c).sum::<f64>().sqrt();
            null.iter_mut().for_each(|c| *c /= norm);
            subtract_projection(&mut solution, &null);
            basis[free - rank] = null;
        }
        solution.iter().all(|c| c.is_finite()).then_some(solution)
    }

    fn back_substitute(&self, rank: usize, column: &[usize; MAX], b: &[f64; MAX], x: &mut [f64; MAX]) {
        for r in (0..rank).rev() {
            let mut sum = b[r];
            for c in r + 1..rank {
                sum -= self.a[r][column[c]] * x[column[c]];
            }
            x[column[r]] = sum / self.a[r][column[r]];
        }
    }
}

/// Removes from `x` its part along the unit vector `e`.
fn subtract_projection(x: &mut [f64; MAX], e: &[f64; MAX]) {
    let along: f64 = x.iter().zip(e).map(|(a, b)| a * b).sum();
    for (a, b) in x.iter_mut().zip(e) {
        *a -= along * b;
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
            Enumeration::new().solve(&case.problem().unwrap(), &Stop { tolerance: 1e-14, ..Stop::default() }, &mut p);
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
    fn more_than_three_contacts_are_a_breakdown_not_a_panic() {
        let feet = [(-0.5, -1.0), (-0.2, -1.0), (0.2, -1.0), (0.5, -1.0)];
        let case = body_on_floor("four", 0.3, &feet, [0.0, -1.0, 0.0], 0.5);
        let mut p = vec![Vector2::zeros(); 4];
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
