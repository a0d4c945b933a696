//! Trying likely contact states before enumerating all.
//!
//! The states of the initial impulses (if these are zero, the states of the contacts in isolation)
//! define a linear system. Contacts whose inequality its solution violates all change state at
//! once, and the system is solved again, a few times. A solution that satisfies every inequality
//! with a margin is returned.
//!
//! This gives the same result as the enumeration: with a margin, nearby impulses with the same
//! velocities belong to the same states, and all impulses that satisfy the law with these
//! velocities form a convex set. So the impulses of least norm within the states have the least
//! norm of the whole set. Contacts change state together, so their order doesn't matter. (If
//! several *velocities* satisfy the law, as may happen with large friction, those near the initial
//! impulses are found.)

use crate::enumeration::{BlockTable, ContactState, Impulses, ROUNDING, TREE_CONTACTS};
use crate::least_norm::{MAX, RANK_TOLERANCE};
use crate::one_contact::{AT_LIMIT, sticking};
use nalgebra::Vector2;

/// Largest number of combinations of states that are tried.
const TRIES: u32 = 6;

/// Required margin of an inequality, relative to the terms summed on its left side: far above
/// rounding, so that no neighbouring state is valid as well.
const MARGIN: f64 = 1e-9;

/// A contact that would pull to part more slowly than this, in parts of the largest velocity, opens only when the others are in
/// their states.
const SLIGHT: f64 = 1e-6;

/// Rounding of a pivot, relative to its magnitude, times the smallest pivot before it.
const PIVOT_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Impulses and velocities that satisfy the law in likely states, if found, and the number of
/// combinations tried.
pub(crate) fn find(table: &BlockTable, start: &[Vector2<f64>]) -> (Option<(Impulses, Impulses)>, u32) {
    let n = table.n;
    let from_rest = start.iter().all(|p| p[0] == 0.0 && p[1] == 0.0);
    let mut states = [ContactState::Open; TREE_CONTACTS];
    for i in 0..n {
        states[i] = if from_rest { alone(table, i) } else { of_impulse(&start[i], table.mu[i]) };
    }
    for tried in 1..=TRIES {
        let Some(p) = impulses(table, &states) else { return (None, tried) };
        match check(table, &mut states, &p) {
            LikelyCheck::Obeys(u) => return (Some((p, u)), tried),
            LikelyCheck::Other => {}
            LikelyCheck::Tight => return (None, tried),
        }
    }
    (None, TRIES)
}

fn slide_against(impulse: f64) -> ContactState {
    ContactState::Slide(if impulse > 0.0 { -1.0 } else { 1.0 })
}

fn of_impulse(p: &Vector2<f64>, mu: f64) -> ContactState {
    if !(p[0] > 0.0) {
        ContactState::Open
    } else if mu == 0.0 {
        ContactState::Slide(1.0)
    } else if p[1].abs() < mu * p[0] * AT_LIMIT {
        ContactState::Stick
    } else {
        slide_against(p[1])
    }
}

/// The state of contact `i` without the others.
fn alone(table: &BlockTable, i: usize) -> ContactState {
    let (h, q, mu) = (&table.h[i][i], &table.q[i], table.mu[i]);
    if q[0] >= 0.0 {
        return ContactState::Open;
    }
    if mu == 0.0 {
        return ContactState::Slide(1.0);
    }
    let p = sticking(h, q);
    if p[1].abs() <= mu * p[0] { ContactState::Stick } else { slide_against(p[1]) }
}

enum LikelyCheck {
    /// All inequalities hold with a margin; the velocities.
    Obeys(Impulses),
    /// Some inequality is violated; the states were changed.
    Other,
    /// Too close to a boundary, or not a solution of the states' system.
    Tight,
}

#[inline]
fn check(table: &BlockTable, states: &mut [ContactState; TREE_CONTACTS], p: &Impulses) -> LikelyCheck {
    let n = table.n;
    let mut velocities = [Vector2::zeros(); TREE_CONTACTS];
    let (mut changed, mut tight) = (false, false);
    for i in 0..n {
        // In the order of `ContactProblem::velocity`, so that the judge's velocities are identical
        // to the last bit.
        let mut u = Vector2::zeros();
        let mut size = table.q[i].abs();
        for j in 0..n {
            let (h, p) = (&table.h[i][j], &p[j]);
            for a in 0..2 {
                let (x, y) = (h[(a, 0)] * p[0], h[(a, 1)] * p[1]);
                u[a] += x + y;
                size[a] += x.abs() + y.abs();
            }
        }
        u += table.q[i];
        velocities[i] = u;
        let (mu, state) = (table.mu[i], states[i]);
        if state == ContactState::Open {
            changed |= u[0] < 0.0;
            tight |= u[0] < MARGIN * size[0];
            if u[0] < 0.0 {
                states[i] = if mu == 0.0 { ContactState::Slide(1.0) } else { ContactState::Stick };
            }
            continue;
        }
        let size_p = size[0] / table.h[i][i][(0, 0)];
        tight |= u[0].abs() > ROUNDING * size[0] || p[i][0] < MARGIN * size_p;
        if p[i][0] < 0.0 {
            let speed = table.q[..n].iter().map(Vector2::amax).fold(0.0, f64::max);
            if p[i][0] < -SLIGHT * speed / table.h[i][i][(0, 0)] {
                (states[i], changed) = (ContactState::Open, true);
            }
            continue;
        }
        match state {
            // It is held by another contact of the same body and slides only by rounding.
            ContactState::Slide(sigma) if mu > 0.0 && sigma * u[1] < MARGIN * (size[0] + size[1]) => {
                (states[i], changed) = (ContactState::Stick, true);
            }
            ContactState::Stick => {
                let room = mu * p[i][0] - p[i][1].abs();
                tight |= room < MARGIN * size_p || u[1].abs() > ROUNDING * (size[0] + size[1]);
                if room < 0.0 {
                    (states[i], changed) = (slide_against(p[i][1]), true);
                }
            }
            _ => {}
        }
    }
    // What is at rest beside a blow pulls by rounding: first see what the blow does to it.
    if !changed {
        for i in 0..n {
            if states[i] != ContactState::Open && p[i][0] < 0.0 {
                (states[i], changed) = (ContactState::Open, true);
            }
        }
    }
    if changed {
        LikelyCheck::Other
    } else if tight {
        LikelyCheck::Tight
    } else {
        LikelyCheck::Obeys(velocities)
    }
}

/// The impulses of a combination of states, with the least norm if they aren't unique.
#[inline]
fn impulses(table: &BlockTable, states: &[ContactState; TREE_CONTACTS]) -> Option<Impulses> {
    // Unknowns and equations as in `BlockTable::pivoted`.
    let mut rows = [(0, 0); MAX];
    let mut tangent = [0.0; MAX];
    let mut m = 0;
    for i in 0..table.n {
        match states[i] {
            ContactState::Open => {}
            ContactState::Slide(sigma) => {
                rows[m] = (i, 0);
                tangent[m] = -sigma * table.mu[i];
                m += 1;
            }
            ContactState::Stick => {
                rows[m] = (i, 0);
                rows[m + 1] = (i, 1);
                m += 2;
            }
        }
    }
    let x = match m {
        0 => return Some([Vector2::zeros(); TREE_CONTACTS]),
        1 => solve::<1>(table, &rows, &tangent),
        2 => solve::<2>(table, &rows, &tangent),
        3 => solve::<3>(table, &rows, &tangent),
        4 => solve::<4>(table, &rows, &tangent),
        5 => solve::<5>(table, &rows, &tangent),
        _ => solve::<6>(table, &rows, &tangent),
    }?;
    let mut p = [Vector2::zeros(); TREE_CONTACTS];
    for (k, &(i, a)) in rows[..m].iter().enumerate() {
        p[i][a] += x[k];
        p[i][1] += tangent[k] * x[k];
    }
    Some(p)
}

/// Gaussian elimination along the diagonal, which is stable for positive semidefinite systems;
/// `None` for other systems. The result is checked by its velocities.
#[inline]
fn solve<const M: usize>(table: &BlockTable, rows: &[(usize, usize); MAX], tangent: &[f64; MAX]) -> Option<[f64; MAX]> {
    let mut a = [[0.0; M]; M];
    let mut b = [0.0; M];
    let mut size = [0.0; M];
    for r in 0..M {
        let (i, row) = rows[r];
        for c in 0..M {
            let (j, column) = rows[c];
            let h = &table.h[i][j];
            a[r][c] = h[(row, column)] + tangent[c] * h[(row, 1)];
        }
        b[r] = -table.q[i][row];
        size[r] = table.h[i][i][(row, row)];
    }
    let mut inverse = [0.0; M];
    let mut smallest = 1.0_f64;
    for k in 0..M {
        let pivot = a[k][k];
        let part = pivot.abs() / size[k];
        // A small pivot amplifies rounding, and a zero pivot after it can't be detected.
        if part > RANK_TOLERANCE && part * smallest <= PIVOT_ROUNDING {
            return None;
        }
        if !(pivot.abs() > RANK_TOLERANCE * size[k]) {
            // A free unknown, if it isn't coupled to the remaining ones.
            for c in k + 1..M {
                let negligible = RANK_TOLERANCE * RANK_TOLERANCE * size[k] * size[c];
                if !(a[k][c] * a[k][c] <= negligible && a[c][k] * a[c][k] <= negligible) {
                    return None;
                }
            }
            continue;
        }
        inverse[k] = pivot.recip();
        smallest = smallest.min(part);
        for r in k + 1..M {
            let factor = a[r][k] * inverse[k];
            for c in k + 1..M {
                a[r][c] -= factor * a[k][c];
            }
            b[r] -= factor * b[k];
        }
    }
    let free = inverse.iter().filter(|&&inverse| inverse == 0.0).count();
    let x = match free {
        0 => {
            let mut x = [0.0; M];
            for k in (0..M).rev() {
                let sum = (k + 1..M).fold(b[k], |sum, c| sum - a[k][c] * x[c]);
                x[k] = sum * inverse[k];
            }
            x
        }
        1 => nearest_to_zero::<M, 2>(&a, &b, &inverse, tangent),
        2 => nearest_to_zero::<M, 3>(&a, &b, &inverse, tangent),
        3 => nearest_to_zero::<M, 4>(&a, &b, &inverse, tangent),
        _ => return None,
    };
    let mut solution = [0.0; MAX];
    solution[..M].copy_from_slice(&x);
    x.iter().all(|x| x.is_finite()).then_some(solution)
}

/// The least-norm solution of a triangular system with `L` − 1 free unknowns (those without an
/// inverse pivot).
#[inline]
fn nearest_to_zero<const M: usize, const L: usize>(
    a: &[[f64; M]; M],
    b: &[f64; M],
    inverse: &[f64; M],
    tangent: &[f64; MAX],
) -> [f64; M] {
    // The columns are the solution with the free unknowns at zero and, for each of them, a vector
    // of the null space.
    let mut x = [[0.0; L]; M];
    let mut lane = L - 1;
    for k in (0..M).rev() {
        if inverse[k] == 0.0 {
            x[k][lane] = 1.0;
            lane = lane.saturating_sub(1);
            continue;
        }
        let mut sum = [0.0; L];
        sum[0] = b[k];
        for c in k + 1..M {
            for l in 0..L {
                sum[l] -= a[k][c] * x[c][l];
            }
        }
        x[k] = sum.map(|sum| sum * inverse[k]);
    }
    // The normal equations of the least norm, with each x weighted by the length of its direction
    // (1, −σμ).
    let mut g = [[0.0; L]; L];
    for k in 0..M {
        let weight = 1.0 + tangent[k] * tangent[k];
        for r in 1..L {
            for c in 0..L {
                g[r][c] += weight * x[k][r] * x[k][c];
            }
        }
    }
    let mut reciprocal = [0.0; L];
    for k in 1..L {
        reciprocal[k] = g[k][k].recip();
        for r in k + 1..L {
            let factor = g[r][k] * reciprocal[k];
            for c in 0..L {
                g[r][c] -= factor * g[k][c];
            }
        }
    }
    let mut along = [0.0; L];
    along[0] = 1.0;
    for k in (1..L).rev() {
        let sum = (k + 1..L).fold(g[k][0], |sum, c| sum + g[k][c] * along[c]);
        along[k] = -sum * reciprocal[k];
    }
    std::array::from_fn(|k| (0..L).fold(0.0, |sum, l| sum + along[l] * x[k][l]))
}
