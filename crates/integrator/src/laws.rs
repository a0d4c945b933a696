//! Contact laws beyond the standard one, each reduced to standard problems, 0 ≤ u_n ⊥ p_n ≥ 0 with
//! Coulomb's friction, so that any contact solver can be used (`docs/laws.md`).
//!
//! - **Poisson**: a problem of compression, then one of expansion, in which a contact separates
//!   under the normal impulse e p_C, or stays closed under a larger one. Friction under an imposed
//!   normal impulse N is a standard contact too: its normal part is decoupled and made to equal N,
//!   its tangential part is the real one.
//! - **Restitution that creates no energy** (`scaling.rs`): in the energetic law and in Poisson's,
//!   restitution is scaled by the largest f ∈ [0, 1] for which the work Ū·p of the coupled contacts
//!   is not positive, with one f for all of them, found by bisection.
//! - **Springs**: Newton's method on the force law p = φ(U¹). Its tangent, U¹ + R p = U_k + R p_k
//!   with R = −1/φ', is a standard contact whose H_nn is larger by R; scaling its normal direction
//!   keeps the size of the problem. Its friction never adds energy.

mod expansion;
mod rows;
mod scaling;

use crate::Vector;
use crate::contact::tangential;
use crate::stage::{Problem, Rule};
use rows::Row;
use scaling::WORKLESS;
use teeter_contact::{Block, ContactSolver, Outcome, ProblemError, Status, Stop};

/// Whether a contact's approach is an impact, rather than the approach that its free acceleration
/// causes within a step: e times the approach must exceed that. This ends bouncing, so that a
/// resting contact doesn't hop.
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
    /// Least normal impulses of expansion.
    given: Vec<f64>,
    /// Which contacts separate in the expansion being tried.
    parts: Vec<bool>,
    /// For each contact, the first contact of those coupled with it, directly or through others.
    island: Vec<usize>,
    /// Of each island, by its first contact: an interval that contains the largest f.
    range: Vec<[f64; 2]>,
    /// The f of each contact's island: the fraction of Poisson's expansion that takes place.
    part: Vec<f64>,
    /// The work of each contact without restitution; 0 where it wasn't computed.
    unreturned: Vec<f64>,
    /// Springs whose friction has been changed so that it can't add energy.
    guarded: Vec<bool>,
    /// Work of each island for f = 0, if positive.
    floor: Vec<f64>,
    /// The shifts as the scheme set them.
    shift: Vec<Vector<D>>,
}

impl<const D: usize> Laws<D> {
    /// Makes room for so many contacts.
    pub(crate) fn reserve(&mut self, contacts: usize) {
        // An expansion can have two rows for each.
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
        self.part.reserve(contacts);
        self.unreturned.reserve(contacts);
        self.floor.reserve(contacts);
        self.guarded.reserve(contacts);
        self.shift.reserve(contacts);
    }

    /// Solves the problem of the set's contacts by their rules; θ is the weight of the step's mean
    /// velocity. The impulses are left in the set.
    pub(crate) fn solve(
        &mut self,
        set: &mut Problem<D>,
        theta: f64,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        // Springs alone don't need them.
        if set.rules().any(|rule| matches!(rule, Rule::Poisson { .. } | Rule::Energetic)) {
            self.find_islands(set);
        }
        self.part.clear();
        self.part.resize(set.len(), 1.0);
        self.unreturned.clear();
        self.unreturned.resize(set.len(), 0.0);
        let outcome = self.guarded_pass(set, theta, solver, stop)?;
        if !self.find_gains(set) {
            return Ok(outcome);
        }
        Ok(join(outcome, self.scale_restitution(set, theta, solver, stop)?))
    }

    /// A pass in which friction of springs adds no energy: where U_θ,t·p_t > 0, Coulomb's law is
    /// imposed on U_θ,t instead.
    fn guarded_pass(
        &mut self,
        set: &mut Problem<D>,
        theta: f64,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let mut outcome = self.pass(set, solver, stop)?;
        let n = set.len();
        self.guarded.clear();
        self.guarded.resize(n, false);
        // Each round changes at least one more contact, so this ends.
        loop {
            let mut found = false;
            for i in 0..n {
                let Rule::Spring(step) = set.rule(i) else { continue };
                let (before, after) = (tangential(&set.u_before(i)), tangential(&set.velocity_by_impulses(i)));
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

/// The later of two outcomes, or the earlier if that is unsolved, with the iterations of both.
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
