//! The contact states that are likely, before all states are enumerated.
//!
//! The states of the start's impulses (or, from none, those that the contacts would have alone) are
//! one linear system. Where its solution misses an inequality, all contacts that miss theirs change
//! state at once, and again a few times. A solution that obeys every inequality with room to spare
//! is returned.
//!
//! Why that is as good as the enumeration's: with room to spare, the impulses near it that give the
//! same velocities are those of the same states, and all impulses that obey the law with these
//! velocities form a convex set. The point of least norm among the states' impulses is then that of
//! the whole set. Contacts change state together, so their order doesn't matter. (Where several
//! *velocities* obey the law, as with much friction, it is the ones next to the start.)

use crate::enumeration::{FEW, Impulses, ROUNDING, State, Table};
use crate::least_norm::{MAX, RANK_TOLERANCE};
use nalgebra::Vector2;

/// Most combinations of states that are tried.
const TRIES: u32 = 6;

/// How much room an inequality must leave, relative to the terms that its left side is the sum of:
/// far above rounding, so that no neighbouring state fits as well.
const ROOM: f64 = 1e-9;

/// Rounding of a pivot, relative to its size, times the smallest pivot before it.
const MAGNIFIED: f64 = 64.0 * f64::EPSILON;

/// A friction impulse this near its limit is at it: the start's impulses are known to rounding.
const AT_LIMIT: f64 = 1.0 - 1e-9;

/// Impulses and velocities that obey the law in likely states, if some are found; and how many were
/// tried.
pub(crate) fn find(table: &Table, start: &[Vector2<f64>]) -> (Option<(Impulses, Impulses)>, u32) {
    let n = table.n;
    let from_rest = start.iter().all(|p| p[0] == 0.0 && p[1] == 0.0);
    let mut states = [State::Open; FEW];
    for i in 0..n {
        states[i] = if from_rest { alone(table, i) } else { of_impulse(&start[i], table.mu[i]) };
    }
    for tried in 1..=TRIES {
        let Some(p) = impulses(table, &states) else { return (None, tried) };
        match check(table, &mut states, &p) {
            Check::Obeys(u) => return (Some((p, u)), tried),
            Check::Other => {}
            Check::Tight => return (None, tried),
        }
    }
    (None, TRIES)
}

fn slide_against(impulse: f64) -> State {
    State::Slide(if impulse > 0.0 { -1.0 } else { 1.0 })
}

fn of_impulse(p: &Vector2<f64>, mu: f64) -> State {
    if !(p[0] > 0.0) {
        State::Open
    } else if mu == 0.0 {
        State::Slide(1.0)
    } else if p[1].abs() < mu * p[0] * AT_LIMIT {
        State::Stick
    } else {
        slide_against(p[1])
    }
}

/// The state of contact `i` if there were no other.
fn alone(table: &Table, i: usize) -> State {
    let (h, q, mu) = (&table.h[i][i], &table.q[i], table.mu[i]);
    if q[0] >= 0.0 {
        return State::Open;
    }
    if mu == 0.0 {
        return State::Slide(1.0);
    }
    // The sticking impulse, times the determinant.
    let p_n = h[(0, 1)] * q[1] - h[(1, 1)] * q[0];
    let p_t = h[(1, 0)] * q[0] - h[(0, 0)] * q[1];
    if p_t.abs() <= mu * p_n { State::Stick } else { slide_against(p_t) }
}

enum Check {
    /// With room to spare; the velocities.
    Obeys(Impulses),
    /// No; the states were changed to ones that may.
    Other,
    /// Too near a border, or not a solution of the states' system.
    Tight,
}

#[inline]
fn check(table: &Table, states: &mut [State; FEW], p: &Impulses) -> Check {
    let n = table.n;
    let mut velocities = [Vector2::zeros(); FEW];
    let (mut changed, mut tight) = (false, false);
    for i in 0..n {
        // In the order of `ContactProblem::velocity`, so that the judge finds the same to the last
        // bit.
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
        if state == State::Open {
            changed |= u[0] < 0.0;
            tight |= u[0] < ROOM * size[0];
            if u[0] < 0.0 {
                states[i] = if mu == 0.0 { State::Slide(1.0) } else { State::Stick };
            }
            continue;
        }
        let size_p = size[0] / table.h[i][i][(0, 0)];
        tight |= u[0].abs() > ROUNDING * size[0] || p[i][0] < ROOM * size_p;
        if p[i][0] < 0.0 {
            (states[i], changed) = (State::Open, true);
            continue;
        }
        match state {
            // Held by another contact of the same body, it doesn't slide, but for rounding.
            State::Slide(sigma) if mu > 0.0 && sigma * u[1] < ROOM * (size[0] + size[1]) => {
                (states[i], changed) = (State::Stick, true);
            }
            State::Stick => {
                let room = mu * p[i][0] - p[i][1].abs();
                tight |= room < ROOM * size_p || u[1].abs() > ROUNDING * (size[0] + size[1]);
                if room < 0.0 {
                    (states[i], changed) = (slide_against(p[i][1]), true);
                }
            }
            _ => {}
        }
    }
    if changed {
        Check::Other
    } else if tight {
        Check::Tight
    } else {
        Check::Obeys(velocities)
    }
}

/// The impulses of a combination of states, of least norm where it leaves a choice.
#[inline]
fn impulses(table: &Table, states: &[State; FEW]) -> Option<Impulses> {
    // Unknowns and equations as in `Table::pivoted`.
    let mut rows = [(0, 0); MAX];
    let mut tangent = [0.0; MAX];
    let mut m = 0;
    for i in 0..table.n {
        match states[i] {
            State::Open => {}
            State::Slide(sigma) => {
                rows[m] = (i, 0);
                tangent[m] = -sigma * table.mu[i];
                m += 1;
            }
            State::Stick => {
                rows[m] = (i, 0);
                rows[m + 1] = (i, 1);
                m += 2;
            }
        }
    }
    let x = match m {
        0 => return Some([Vector2::zeros(); FEW]),
        1 => solve::<1>(table, &rows, &tangent),
        2 => solve::<2>(table, &rows, &tangent),
        3 => solve::<3>(table, &rows, &tangent),
        4 => solve::<4>(table, &rows, &tangent),
        5 => solve::<5>(table, &rows, &tangent),
        _ => solve::<6>(table, &rows, &tangent),
    }?;
    let mut p = [Vector2::zeros(); FEW];
    for (k, &(i, a)) in rows[..m].iter().enumerate() {
        p[i][a] += x[k];
        p[i][1] += tangent[k] * x[k];
    }
    Some(p)
}

/// Gaussian elimination down the diagonal, which is stable for the positive semidefinite systems
/// that this is for; `None` for what isn't one of them. The result is checked by the velocities
/// that it gives.
#[inline]
fn solve<const M: usize>(table: &Table, rows: &[(usize, usize); MAX], tangent: &[f64; MAX]) -> Option<[f64; MAX]> {
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
        // A small pivot magnifies rounding, and a vanishing one after it can't be told from that.
        if part > RANK_TOLERANCE && part * smallest <= MAGNIFIED {
            return None;
        }
        if !(pivot.abs() > RANK_TOLERANCE * size[k]) {
            // A free unknown, if it answers to none of those to come.
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

/// The solution of least norm of a triangular system with `L` − 1 free unknowns (those without an
/// inverse of their pivot).
#[inline]
fn nearest_to_zero<const M: usize, const L: usize>(
    a: &[[f64; M]; M],
    b: &[f64; M],
    inverse: &[f64; M],
    tangent: &[f64; MAX],
) -> [f64; M] {
    // Side by side the solution with the free unknowns at zero, and for each of them a vector of
    // the null space.
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
    // The normal equations of the least norm, where x counts as long as what it stands for: (1,
    // −σμ) has its length.
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
