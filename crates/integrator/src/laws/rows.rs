//! The standard problems that the laws come down to, and how springs find their place on their law.

use super::{Laws, unsolved, with_iterations};
use crate::Vector;
use crate::contact::tangential;
use crate::spring::SpringStep;
use crate::stage::{Problem, Rule};
use teeter_contact::{ContactProblem, ContactSolver, Delassus, Outcome, ProblemError, Stop};

/// A contact of a problem to be solved on the way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<const D: usize> {
    /// The contact of the set.
    pub(super) contact: usize,
    pub(super) kind: Kind,
    /// Its velocity without the impulses of the problem, and shifted, m/s.
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
    /// A spring, at the velocity of its tangent.
    Spring(SpringStep, f64),
}

/// Most tangents of the springs in a solve.
const TANGENTS: u32 = 100;

/// Springs whose impulses are this part of the largest off their law count as solved; rounding allows less where they are
/// stiff, so where it no longer falls [`ROUNDED`] is enough.
const ON_LAW: f64 = 1e-13;

/// See [`ON_LAW`].
const ROUNDED: f64 = 1e-9;

/// Units in the last place that a spring's velocity may be off.
const ROUNDING: f64 = 8.0;

/// A spring that isn't touched is softer than its contact by this factor.
const UNTOUCHED: f64 = 1e8;

impl<const D: usize> Laws<D> {
    /// The contact of the problem for contact `i` on top of the base impulses.
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

    /// Solves the problem of the rows, springs on their law.
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
        // Every problem was solved, but the springs didn't come to rest.
        match sum {
            Some(outcome) => Ok(unsolved(outcome)),
            None => self.solve_rows(set, solver, stop).map(unsolved),
        }
    }

    /// Moves the springs' tangents to where the last problem ended. Returns how far their impulses are off the law, and how
    /// far rounding can put them, both relative to the largest impulse.
    fn retouch(&mut self, set: &Problem<D>) -> (f64, f64) {
        let (mut off, mut noise, mut largest) = (0.0_f64, 0.0_f64, f64::MIN_POSITIVE);
        for r in 0..self.rows.len() {
            largest = largest.max(self.rows[r].p[0]);
            let Kind::Spring(step, _) = self.rows[r].kind else { continue };
            let u = self.normal_velocity(set, r);
            let (impulse, slope) = step.impulse(u);
            // A stiff spring makes much of the last digits of its velocity.
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

    /// The sum of the sizes of what [`Laws::normal_velocity`] adds up, m/s.
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
                    // Any positive number does; one of the size of the others keeps the problem's scale.
                    (row.scale, row.normal) = (0.0, own.trace());
                    q[0] = -row.normal * normal;
                }
                Kind::Spring(step, at) => {
                    let (impulse, slope) = step.impulse(at);
                    // Where it doesn't touch, hardly anything: as soft as it takes to be found if others push it in.
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

    /// Brings base and rows together as the impulses of the set.
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
