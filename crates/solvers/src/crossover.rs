//! Pivots from a near-solution of a large plane problem.
//!
//! **What it solves**: exact Signorini–Coulomb in the plane, for hundreds of contacts, from impulses
//! that nearly solve the problem; H may be singular.
//!
//! **When to use it**: for jammed piles. In tens of directions their impulses can change without a
//! change of the velocities, as H is singular, and in some more with hardly any (1e-5 to
//! 1e-11). Methods that follow the residual stop at 1e-6 to 1e-10 there, with some contacts in
//! a wrong state, and none of their steps leads on: often the nearest solution of a slightly
//! different problem is on a branch that ends before this problem is reached.
//!
//! **How**:
//!
//! 1. *Crossover*, as from an interior solution of a linear program to a vertex (Megiddo 1991, doi
//!    10.1287/ijoc.3.1.63). The impulses give each contact its cell (`cells.rs`). While the columns of
//!    the basis depend on each other, impulses are moved along a null vector until one of them is
//!    zero and its contact changes its cell.
//! 2. Impulses and velocities so found satisfy the law exactly, and H p − u + q + d = 0 with a d of
//!    about the residual. Values at or near their bounds are lifted off them first, each by another
//!    small amount, so that no two bounds are met at once.
//! 3. *Parametric pivots* (`parametric.rs`) follow the solution along q + z d from z = 1 to 0. They
//!    do so in the direction of the curve, where z falls. If it starts or turns to the other one, z
//!    would grow without limit as a rule; then the contacts are pushed apart until the solution comes back
//!    to the same q in the good direction. The first of these
//!    two parts is finite (`parametric.rs`); a closed curve in the second is found and left.
//!
//! **Cost**: a sparse factorisation for each part of the way and for each fifty pivots, and a
//! solve with it for each pivot, 0.05 to 0.1 ms in all with 500 contacts. From a residual of 1e-6 or
//! less, most problems of a jammed pile of 300 stones take 5 to 300 pivots, where
//! [`Lemke`](crate::Lemke) takes thousands from scratch. `iterations` counts pivots.
//!
//! **How it fails**: far from a solution the way is long. It gives up after a number of pivots and
//! returns the start; another method then has to come nearer first. Rounding can lead it round in a
//! circle; it then tries again with larger lifts. A large friction coefficient takes its digits from a
//! and b, as they differ by p_T/μ.
//!
//! Departures: in the crossover only impulses are kept within their bounds. Velocities follow from
//! the new impulses up to d.

use crate::cells::Cell;
use crate::ending::ended;
use crate::memory::{refill, reserve};
use crate::parametric::{End, Tracker};
use crate::scaled::{Scaled, make_finite};
use nalgebra::Vector2;
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Stop, de_saxce, judge, project};

/// Least values of impulses and distances from the friction cone that are inside of it, with the
/// largest |q| scaled to 1.
const PRESSES: f64 = 1e-14;
const STICKS: f64 = 1e-12;
/// Values nearer to their bounds than this part of |d|, in each try, are lifted off them; |d| is taken as
/// at least `LEAST`. The larger it is, the further the start is from the solution, and the clearer the
/// pivots are: after small ones near-null directions may lead round in a circle, by rounding.
const LIFTS: [f64; 3] = [0.1, 10.0, 100.0];
const LEAST: f64 = 1e-14;
/// The factors of the lifts are others in each try.
const TURN: usize = 1013;
/// Contacts are pushed apart where z has grown by this factor, and at most `LEGS` times.
const GROWN: f64 = 10.0;
const LEGS: u32 = 20;
/// Pivots after which a try is given up.
const MOST: u32 = 1000;

/// The solver. Memory grows with the problems.
#[derive(Debug, Default)]
pub(crate) struct Crossover {
    scaled: Scaled<2>,
    tracker: Tracker,
    /// d.
    distance: Vec<f64>,
    /// q, scaled.
    q: Vec<f64>,
    found: Vec<Vector2<f64>>,
    unpolished: Vec<Vector2<f64>>,
    best: Vec<Vector2<f64>>,
    u: Vec<Vector2<f64>>,
    /// Tries done.
    tries: usize,
}

impl Crossover {
    /// The name in outcomes.
    pub(crate) const NAME: &'static str = "crossover";

    /// Cells and coordinates from the impulses in `best`.
    fn enter(&mut self, unit: f64) {
        self.scaled.velocities(&self.best, &mut self.u);
        for (i, &mu) in self.scaled.mu.iter().enumerate() {
            self.found[i] = project(&(self.best[i] - de_saxce(&self.u[i], mu)), mu);
        }
        self.scaled.velocities(&self.found, &mut self.u);
        self.tracker.cells.clear();
        self.tracker.values.clear();
        for (i, &mu) in self.scaled.mu.iter().enumerate() {
            let (p, u) = (self.found[i] / unit, self.u[i] / unit);
            let (cell, values) = if p[0] <= PRESSES {
                (Cell::Open, [0.0, 0.0, u[0].max(0.0), u[1]])
            } else if mu == 0.0 {
                (Cell::Forward, [p[0], 0.0, 0.0, u[1]])
            } else if mu * p[0] - p[1].abs() > STICKS * (1.0 + p[0]) {
                (Cell::Stick, [0.5 * (p[0] - p[1] / mu), 0.5 * (p[0] + p[1] / mu), 0.0, 0.0])
            } else if p[1] < 0.0 {
                (Cell::Forward, [p[0], 0.0, 0.0, u[1].max(0.0)])
            } else {
                (Cell::Backward, [0.0, p[0], 0.0, u[1].min(0.0)])
            };
            self.tracker.cells.push(cell);
            self.tracker.values.push(values);
        }
    }

    /// d for the tracker's values; returns its largest number.
    fn measure(&mut self) -> f64 {
        let n = self.found.len();
        let mut largest = 0.0_f64;
        for i in 0..n {
            self.found[i] = self.tracker.impulse(i);
        }
        for i in 0..n {
            let [.., normal, tangential] = self.tracker.values[i];
            let product = self.scaled.h.row_product(i, &self.found);
            for (k, u) in [normal, tangential].into_iter().enumerate() {
                let distance = u - product[k] - self.q[2 * i + k];
                self.distance[2 * i + k] = distance;
                largest = largest.max(distance.abs());
            }
        }
        largest
    }

    /// Lifts values off their bounds.
    fn lift(&mut self, lift: f64) {
        for (i, cell) in self.tracker.cells.iter().enumerate() {
            for coordinate in cell.coordinates() {
                let sign = cell.sign(coordinate, self.scaled.mu[i] > 0.0);
                let value = &mut self.tracker.values[i][coordinate as usize];
                let least = lift * varied(4 * i + coordinate as usize + TURN * self.tries);
                if sign != 0.0 && sign * *value < least {
                    *value = sign * least;
                }
            }
        }
    }

    /// Follows the solution of q + d to that of q.
    fn track(&mut self, size: f64, most: u32, stop: &Stop<'_>) -> bool {
        let n = self.found.len();
        let most = self.tracker.pivots.saturating_add(most);
        let mut scale = 1.0;
        let mut grown = GROWN;
        for _ in 0..LEGS {
            // Apart and back at q + scale d, unless z falls there already.
            for r in 0..2 * n {
                self.tracker.base[r] = self.q[r] + scale * self.distance[r];
                self.tracker.shift[r] = if r % 2 == 0 { size * varied(r / 2 + TURN * self.tries) } else { 0.0 };
            }
            if self.tracker.follow(0.0, f64::INFINITY, most, stop) != End::Arrived {
                return false;
            }
            self.tracker.base.copy_from_slice(&self.q);
            self.tracker.shift.copy_from_slice(&self.distance);
            let mut end = self.tracker.follow(scale, grown * scale, most, stop);
            if end == End::Looped {
                // The curve is left where z first comes back to `scale`, and so are later ones.
                grown = 1.0;
                end = self.tracker.follow(scale, scale, most, stop);
            }
            match end {
                End::Arrived => return true,
                End::Escaped => scale *= grown,
                End::Looped | End::Lost => return false,
            }
        }
        false
    }

    /// One try; its residual, with the impulses in `found`.
    fn attempt(&mut self, unit: f64, most: u32, stop: &Stop<'_>) -> Option<f64> {
        self.enter(unit);
        if !self.tracker.cross() {
            return None;
        }
        let size = self.measure().max(LEAST);
        self.lift(LIFTS[self.tries] * size);
        let size = self.measure().max(LEAST);
        if !self.track(size, most, stop) {
            return None;
        }
        let residual = self.read(unit);
        self.unpolished.copy_from_slice(&self.found);
        let polished = if self.tracker.polish() { self.read(unit) } else { f64::NAN };
        // The values that pivots have led to are better if the last basis is nearly singular.
        if polished < residual {
            return Some(polished);
        }
        self.found.copy_from_slice(&self.unpolished);
        Some(residual)
    }

    /// Impulses in `found` from the tracker; returns their residual.
    fn read(&mut self, unit: f64) -> f64 {
        for (i, p) in self.found.iter_mut().enumerate() {
            *p = self.tracker.impulse(i) * unit;
        }
        self.scaled.velocities(&self.found, &mut self.u);
        self.scaled.residual(&self.found, &self.u)
    }
}

impl ContactSolver<2> for Crossover {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.scaled.reserve(contacts, blocks);
        self.tracker.reserve(contacts, blocks);
        for x in [&mut self.distance, &mut self.q] {
            reserve(x, 2 * contacts);
        }
        for x in [&mut self.found, &mut self.unpolished, &mut self.best, &mut self.u] {
            reserve(x, contacts);
        }
    }

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
        make_finite(p);
        let n = p.len();
        self.scaled.load(problem);
        self.tracker.load(&self.scaled);
        let unit = self.scaled.q.iter().map(Vector2::amax).fold(f64::MIN_POSITIVE, f64::max);
        self.q.clear();
        self.q.extend(self.scaled.q.iter().flat_map(|q| [q[0] / unit, q[1] / unit]));
        refill(&mut self.distance, 2 * n, 0.0);
        for x in [&mut self.found, &mut self.unpolished, &mut self.u] {
            refill(x, n, Vector2::zeros());
        }
        self.best.clear();
        self.best.extend_from_slice(p);
        self.scaled.velocities(p, &mut self.u);
        let mut best = self.scaled.residual(p, &self.u);
        for tries in 0..LIFTS.len() {
            self.tries = tries;
            let left = stop.max_iterations.saturating_sub(self.tracker.pivots);
            if best <= stop.tolerance || left == 0 || stop.cancelled() {
                break;
            }
            if let Some(residual) = self.attempt(unit, left.min(MOST), stop)
                && residual < best
            {
                best = residual;
                self.best.copy_from_slice(&self.found);
            }
        }
        p.copy_from_slice(&self.best);
        let residual = judge(problem, p);
        Outcome::new(ended(stop, self.tracker.pivots, &residual), Self::NAME, self.tracker.pivots, residual)
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(Self::default())
    }
}

/// A factor between 0.5 and 1.5, another for each index.
fn varied(index: usize) -> f64 {
    0.5 + ((index + 1) as f64 * 0.618_033_988_749_894_9).fract()
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::conformance::{plane_cases, run};

    #[test]
    fn conforms() {
        // With a large friction coefficient a and b are known to the digits of μ p_N only.
        let cases: Vec<_> = plane_cases().into_iter().filter(|case| case.mu.iter().all(|mu| *mu < 1e3)).collect();
        assert!(cases.len() + 2 >= plane_cases().len());
        run(&mut Crossover::default(), &cases, 1e-11).unwrap();
    }
}
