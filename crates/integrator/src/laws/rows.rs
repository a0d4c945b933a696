//! The standard problems to which the laws are reduced, and the iteration of springs on their force
//! law.

use super::{Laws, unsolved, with_iterations};
use crate::Vector;
use crate::contact::tangential;
use crate::spring::SpringStep;
use crate::stage::{Problem, Rule};
use teeter_contact::{ContactProblem, ContactSolver, Delassus, Outcome, ProblemError, Stop};

/// A contact of an intermediate problem.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<const D: usize> {
    /// The contact of the set.
    pub(super) contact: usize,
    pub(super) kind: Kind,
    /// Its velocity without the impulses of the problem, including the shift, m/s.
    pub(super) u: Vector<D>,
    /// Its impulse, N·s.
    pub(super) p: Vector<D>,
    /// Scale of its normal direction in the problem.
    pub(super) scale: f64,
    /// H_nn in the problem.
    pub(super) normal: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Standard,
    /// The friction of an imposed normal impulse.
    Friction(f64),
    /// A spring, linearised at this velocity.
    Spring(SpringStep, f64),
}

/// Most linearisations of the springs in a solve.
const TANGENTS: u32 = 100;

/// Springs count as solved if their impulses are off their law by at most this fraction of the
/// largest impulse. Stiff springs can't get that close because of rounding: once the error no
/// longer falls, [`ROUNDED`] is enough.
const ON_LAW: f64 = 1e-13;

/// See [`ON_LAW`].
const ROUNDED: f64 = 1e-9;

/// Rounding errors of a spring's velocity, in units in the last place.
const ROUNDING: f64 = 8.0;

/// A spring that isn't in contact is taken as softer than its contact by this factor.
const UNTOUCHED: f64 = 1e8;

impl<const D: usize> Laws<D> {
    /// The row of contact `i`, on top of the base impulses.
    pub(super) fn row(&self, set: &Problem<D>, i: usize, expansion: bool) -> Row<D> {
        let n = set.len();
        let blocks = &set.blocks[i * n..(i + 1) * n];
        let mut u = blocks.iter().zip(&self.base).fold(set.u_free(i), |u, (block, p)| u + block * p);
        u += set.shift(i);
        if let (Rule::Poisson { tangential: e, .. }, true) = (set.rule(i), expansion) {
            u += tangential(&set.u_before(i)) * e;
        }
        let kind = match set.rule(i) {
            Rule::Spring(step) => Kind::Spring(step, u[0].min(set.u_free(i)[0])),
            _ => Kind::Standard,
        };
        Row { contact: i, kind, u, p: set.p[i], scale: 1.0, normal: blocks[i][(0, 0)] }
    }

    /// Solves the problem of the rows, with springs on their force law.
    pub(super) fn settle(
        &mut self,
        set: &Problem<D>,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let mut sum: Option<Outcome> = None;
        let mut last = f64::INFINITY;
        for tangent in 1..=TANGENTS {
            let outcome = self.solve_rows(set, solver, stop)?;
            let outcome = sum.map_or(outcome, |sum| with_iterations(outcome, sum.iterations + outcome.iterations));
            sum = Some(outcome);
            let (off, noise) = self.retouch(set);
            let settled = off <= ON_LAW || (tangent > 3 && off >= last && off <= noise.max(ROUNDED));
            if settled || !outcome.solved_its_own_law() {
                return Ok(outcome);
            }
            last = off;
        }
        // Every problem was solved, but the springs didn't converge.
        match sum {
            Some(outcome) => Ok(unsolved(outcome)),
            None => self.solve_rows(set, solver, stop).map(unsolved),
        }
    }

    /// Linearises the springs anew at the last solution. Returns the error of their impulses by the
    /// force law, and the error that rounding can cause, both relative to the largest impulse.
    fn retouch(&mut self, set: &Problem<D>) -> (f64, f64) {
        let (mut off, mut noise, mut largest) = (0.0_f64, 0.0_f64, f64::MIN_POSITIVE);
        for r in 0..self.rows.len() {
            largest = largest.max(self.rows[r].p[0]);
            let Kind::Spring(step, _) = self.rows[r].kind else { continue };
            let u = self.normal_velocity(set, r);
            let (impulse, slope) = step.impulse(u);
            // A stiff spring magnifies the rounding of its velocity.
            let rounding = ROUNDING * f64::EPSILON * slope.abs() * self.size_of_velocity(set, r);
            off = off.max((self.rows[r].p[0] - impulse).abs());
            noise = noise.max(rounding);
            self.rows[r].kind = Kind::Spring(step, u);
        }
        (off / largest, noise / largest)
    }

    /// The true normal velocity of a row's contact after the problem.
    pub(super) fn normal_velocity(&self, set: &Problem<D>, r: usize) -> f64 {
        let n = set.len();
        let row = &self.rows[r];
        let others = self.rows.iter().map(|other| {
            let mut p = other.p;
            if matches!(other.kind, Kind::Friction(_)) {
                p[0] = 0.0; // it is in the base
            }
            (set.blocks[row.contact * n + other.contact] * p)[0]
        });
        row.u[0] + others.sum::<f64>()
    }

    /// The sum of the magnitudes of the terms of [`Laws::normal_velocity`], m/s.
    fn size_of_velocity(&self, set: &Problem<D>, r: usize) -> f64 {
        let n = set.len();
        let row = &self.rows[r];
        let others = self.rows.iter().map(|other| {
            let h = &set.blocks[row.contact * n + other.contact];
            (0..D).map(|d| (h[(0, d)] * other.p[d]).abs()).sum::<f64>()
        });
        row.u[0].abs() + others.sum::<f64>()
    }

    /// Poses and solves the standard problem of the rows.
    fn solve_rows(
        &mut self,
        set: &Problem<D>,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let n = set.len();
        self.q.clear();
        self.mu.clear();
        self.p.clear();
        for row in &mut self.rows {
            let own = &set.blocks[row.contact * n + row.contact];
            let (mut q, mut mu) = (row.u, set.mu[row.contact]);
            match row.kind {
                Kind::Standard => {}
                Kind::Friction(normal) => {
                    // Any positive number will do; one of the size of the others keeps the
                    // problem's scale.
                    (row.scale, row.normal) = (0.0, own.trace());
                    q[0] = -row.normal * normal;
                }
                Kind::Spring(step, at) => {
                    let (impulse, slope) = step.impulse(at);
                    // Not in contact: almost no force, but some, so that it is noticed if others
                    // push it in.
                    let (softness, impulse, at) = if slope < 0.0 {
                        (-slope.recip(), impulse, at)
                    } else {
                        (UNTOUCHED * own[(0, 0)], 0.0, at.min(step.touching()))
                    };
                    row.scale = (own[(0, 0)] / (own[(0, 0)] + softness)).sqrt();
                    row.normal = own[(0, 0)];
                    q[0] = row.scale * (row.u[0] - at - softness * impulse);
                    mu *= row.scale;
                }
            }
            let mut p = row.p;
            if row.scale > 0.0 {
                p[0] /= row.scale;
            }
            self.q.push(q);
            self.mu.push(mu);
            self.p.push(p);
        }
        self.blocks.clear();
        for (r, row) in self.rows.iter().enumerate() {
            for (c, column) in self.rows.iter().enumerate() {
                let mut block = set.blocks[row.contact * n + column.contact];
                block.row_mut(0).scale_mut(row.scale);
                block.column_mut(0).scale_mut(column.scale);
                if r == c {
                    block[(0, 0)] = row.normal;
                }
                self.blocks.push(block);
            }
        }
        let problem = ContactProblem::new(Delassus::Dense(&self.blocks), &self.q, &self.mu)?;
        let outcome = solver.solve(&problem, stop, &mut self.p);
        for (row, p) in self.rows.iter_mut().zip(&self.p) {
            row.p = *p;
            if row.scale > 0.0 {
                row.p[0] *= row.scale;
            }
        }
        Ok(outcome)
    }

    /// Adds base and rows to the impulses of the set.
    pub(super) fn take(&mut self, set: &mut Problem<D>) {
        set.p.copy_from_slice(&self.base);
        for row in &self.rows {
            let mut p = row.p;
            if matches!(row.kind, Kind::Friction(_)) {
                p[0] = 0.0;
            }
            set.p[row.contact] += p;
        }
    }
}
