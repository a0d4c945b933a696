//! Contact laws beyond the standard one, each brought to standard problems, 0 ≤ u_n ⊥ p_n ≥ 0 with Coulomb's friction, so
//! that any contact solver serves (`docs/laws.md`).
//!
//! - **Poisson**: a problem of compression; then one of expansion, in which a contact parts under the normal impulse e p_C,
//!   or stays under a larger one. Friction of an imposed normal impulse N is a standard contact too: its normal part touches
//!   nothing and is made to be N, its tangential part is the real one.
//! - **Energetic**: Newton's law with e scaled, for contacts that feel each other alike, by the largest f ∈ [0, 1] with
//!   which their work Ū·p is not positive: bisection.
//! - **Springs**: Newton's method on the force law p = φ(U¹). Its tangent, U¹ + R p = U_k + R p_k with R = −1/φ', is a standard
//!   contact whose H_nn is larger by R; scaling its normal direction keeps the problem's size what it was. Its friction never
//!   gives energy.

mod phases;
mod rows;

use crate::Vector;
use crate::contacts::{ContactSet, Rule, tangential};
use rows::Row;
use teeter_contact::{Block, ContactSolver, Outcome, ProblemError, Status, Stop};

/// Whether a contact's approach is an impact that e sends back, not the approach that its free acceleration makes within a
/// step: what ends a bounce, so that a resting contact doesn't hop.
pub(crate) fn is_impact<const D: usize>(e: f64, u_before: &Vector<D>, u_free: &Vector<D>) -> bool {
    let by_acceleration = (u_before[0] - u_free[0]).max(0.0);
    -e * u_before[0] > by_acceleration
}

/// Memory for these laws.
#[derive(Debug, Default)]
pub(crate) struct Laws<const D: usize> {
    rows: Vec<Row<D>>,
    blocks: Vec<Block<D>>,
    q: Vec<Vector<D>>,
    mu: Vec<f64>,
    p: Vec<Vector<D>>,
    base: Vec<Vector<D>>,
    /// Impulses of compression.
    compression: Vec<Vector<D>>,
    /// Normal impulses that expansion gives back at the least.
    given: Vec<f64>,
    /// Which contacts part in the expansion tried.
    parts: Vec<bool>,
    /// For each contact the first contact that it feels, through others or directly.
    island: Vec<usize>,
    /// Of each island, by its first contact: a range that holds the largest f.
    range: Vec<[f64; 2]>,
    /// Which springs' friction can't give energy.
    guarded: Vec<bool>,
    /// Work of each island with f = 0, if positive.
    floor: Vec<f64>,
    /// The shifts that the scheme asked for.
    shift: Vec<Vector<D>>,
}

/// Halvings of the range of f.
const HALVINGS: u32 = 40;

/// Work below this part of Σ‖U‖‖p‖ is rounding.
const WORKLESS: f64 = 1e-14;

impl<const D: usize> Laws<D> {
    /// Makes room for so many contacts.
    pub(crate) fn reserve(&mut self, contacts: usize) {
        // An expansion can hold two of each.
        self.rows.reserve(2 * contacts);
        self.blocks.reserve(4 * contacts * contacts);
        self.q.reserve(2 * contacts);
        self.mu.reserve(2 * contacts);
        self.p.reserve(2 * contacts);
        self.base.reserve(contacts);
        self.compression.reserve(contacts);
        self.given.reserve(contacts);
        self.parts.reserve(contacts);
        self.island.reserve(contacts);
        self.range.reserve(contacts);
        self.floor.reserve(contacts);
        self.guarded.reserve(contacts);
        self.shift.reserve(contacts);
    }

    /// Solves the problem of the set's contacts by their rules, θ that of the step's mean velocity. The impulses stay in the
    /// set.
    pub(crate) fn solve(
        &mut self,
        set: &mut ContactSet<D>,
        theta: f64,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        // Springs alone have no use for them.
        if set.rules.iter().any(|rule| matches!(rule, Rule::Poisson { .. } | Rule::Energetic)) {
            self.find_islands(set);
        }
        let outcome = self.guarded_pass(set, theta, solver, stop)?;
        let n = set.rules.len();
        self.range.clear();
        self.range.resize(n, [1.0, 1.0]);
        for i in (0..n).filter(|&i| matches!(set.rules[i], Rule::Energetic) && set.shift[i][0] != 0.0) {
            let first = self.island[i];
            let (work, rounding) = self.work(set, first);
            if work > rounding {
                self.range[first] = [0.0, 1.0];
            }
        }
        if self.range.iter().all(|range| range[0] == 1.0) {
            return Ok(outcome);
        }
        self.shift.clear();
        self.shift.extend_from_slice(&set.shift);
        Ok(join(outcome, self.scale_restitution(set, theta, solver, stop)?))
    }

    /// Finds the largest part f of restitution that makes no energy, for each island whose range says that f = 1 does.
    ///
    /// Beside an impact there can be contacts that give energy by themselves, as one that has sunk in and is on its way out; that
    /// is not restitution's to pay for, so what there is with f = 0 is allowed.
    fn scale_restitution(
        &mut self,
        set: &mut ContactSet<D>,
        theta: f64,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let n = set.rules.len();
        self.scale_shifts(set, |_| 0.0);
        let mut outcome = self.guarded_pass(set, theta, solver, stop)?;
        self.floor.clear();
        for first in 0..n {
            let own = if self.island[first] == first { self.work(set, first).0 } else { 0.0 };
            self.floor.push(own.max(0.0));
        }
        for halving in 0..=HALVINGS {
            // At last the largest f that is known to make none.
            let at = move |[low, high]: [f64; 2]| if halving < HALVINGS { 0.5 * (low + high) } else { low };
            self.scale_shifts(set, at);
            outcome = join(outcome, self.guarded_pass(set, theta, solver, stop)?);
            for first in (0..n).filter(|&i| self.island[i] == i) {
                let [low, high] = self.range[first];
                if low < 1.0 {
                    let f = at(self.range[first]);
                    let (work, rounding) = self.work(set, first);
                    self.range[first] = if work > self.floor[first] + rounding { [low, f] } else { [f, high] };
                }
            }
        }
        Ok(outcome)
    }

    /// Scales the normal shifts of energetic contacts by f of their island's range; f = 1 where the range is one point.
    fn scale_shifts(&self, set: &mut ContactSet<D>, f: impl Fn([f64; 2]) -> f64) {
        for i in 0..set.rules.len() {
            let range = self.range[self.island[i]];
            if matches!(set.rules[i], Rule::Energetic) && range[0] < 1.0 {
                let mut shift = self.shift[i];
                shift[0] *= f(range);
                set.reshift(i, shift);
            }
        }
    }

    /// Contacts that feel each other through H, directly or by others.
    fn find_islands(&mut self, set: &ContactSet<D>) {
        let n = set.rules.len();
        self.island.clear();
        self.island.extend(0..n);
        let mut changed = true;
        while changed {
            changed = false;
            for i in 0..n {
                for j in 0..n {
                    let first = self.island[i].min(self.island[j]);
                    let couples = set.blocks[i * n + j] != Block::<D>::zeros();
                    if couples && (self.island[i] != first || self.island[j] != first) {
                        (self.island[i], self.island[j]) = (first, first);
                        changed = true;
                    }
                }
            }
        }
    }

    /// The work Ū·p of an island's contacts, Ū the mean of U⁰ and U¹ whatever θ is: that is what an impact changes of the kinetic
    /// energy. And how much of it is rounding. Both in J.
    fn work(&self, set: &ContactSet<D>, first: usize) -> (f64, f64) {
        let (mut work, mut size) = (0.0, 0.0);
        for i in (0..set.rules.len()).filter(|&i| self.island[i] == first) {
            let (before, after) = (set.contacts()[i].u_before, set.velocity_by_impulses(i));
            work += ((after + before) * 0.5).dot(&set.p[i]);
            size += (after.norm() + before.norm()) * set.p[i].norm();
            if let Rule::Spring(spring) = set.rules[i] {
                work += spring.spring.potential(spring.gap_after(after[0])) - spring.spring.potential(spring.gap);
            }
        }
        (work, WORKLESS * size)
    }

    /// A pass in which friction of springs doesn't give energy: where U_θ,t·p_t > 0, Coulomb's law is made to hold for U_θ,t.
    fn guarded_pass(
        &mut self,
        set: &mut ContactSet<D>,
        theta: f64,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let mut outcome = self.pass(set, solver, stop)?;
        let n = set.rules.len();
        self.guarded.clear();
        self.guarded.resize(n, false);
        // Each round guards one contact more at least.
        loop {
            let mut found = false;
            for i in 0..n {
                let Rule::Spring(step) = set.rules[i] else { continue };
                let (before, after) =
                    (tangential(&set.contacts()[i].u_before), tangential(&set.velocity_by_impulses(i)));
                let p = tangential(&set.p[i]);
                let gain = (after * theta + before * (1.0 - theta)).dot(&p);
                if !self.guarded[i] && gain > WORKLESS * (after.norm() + before.norm()) * p.norm() {
                    set.reshift(i, before * ((1.0 - step.theta) / step.theta));
                    self.guarded[i] = true;
                    found = true;
                }
            }
            if !found {
                return Ok(outcome);
            }
            outcome = join(outcome, self.pass(set, solver, stop)?);
        }
    }
}

/// The later of two outcomes with the iterations of both; an unsolved one is not forgotten.
pub(crate) fn join(first: Outcome, second: Outcome) -> Outcome {
    let iterations = first.iterations + second.iterations;
    let kept = if first.converged() { second } else { first };
    with_iterations(kept, iterations)
}

fn unsolved(mut outcome: Outcome) -> Outcome {
    outcome.status = Status::MaxIterations;
    outcome
}

fn with_iterations(mut outcome: Outcome, iterations: u32) -> Outcome {
    outcome.iterations = iterations;
    outcome
}
