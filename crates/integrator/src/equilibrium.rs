//! Static equilibrium of a model with contacts: where it can start and stay (`docs/theory.md` §9).
//!
//! Coordinates q and contact forces λ are sought with
//!
//! ```text
//! F(q) + P(t) + Jᵀλ = 0,     0 ≤ g(q) ⊥ λ_n ≥ 0,     ‖λ_t‖ ≤ μ λ_n, against the slip s(q) where it slips
//! ```
//!
//! Signorini's condition holds for gaps and not for velocities, Coulomb's law for the slip from the place where the foot of the
//! contact was when it was put there: the friction is that of the way as a whole, whatever came on it. Velocities that
//! are [driven](crate::Subsystem::driven) are held at zero by whatever force that takes.
//!
//! It is found by proximal points. A round is an implicit step of length τ from rest,
//!
//! ```text
//! v = (M + τ²K)⁻¹ (τ (F(q) + P) + Jᵀp),     q ← q ⊕ τ v,     p = τ λ
//! ```
//!
//! whose law holds for u + (g, s)/τ, so for the gap and the slip at its end. Mass stands in for the stiffness that a rigid block
//! doesn't have: τ grows until it hardly matters, then a round is one of Newton's. Forces are those at q in each round; K only
//! leads there, and may be approximate.

use crate::contacts::tangential;
use crate::{FactorError, Model, Vector, WarmStart, Weights, Workspace};
use teeter_contact::ProblemError;
use teeter_detect::{Anchor, Candidate, ContactId, Geometry};

/// What limits the search.
#[derive(Clone, Copy, Debug)]
pub struct SettlingLimits<'a> {
    /// By pair: how far (m) a point that touched at first may get from where it touched. Farther it is on its way, and what
    /// it belongs to has no equilibrium there. Pairs beyond the slice have no limit.
    pub reach: &'a [f64],
    /// Candidates with a gap up to this are looked at, m: what may touch in the end.
    pub margin: f64,
}

/// Where a model rests.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Equilibrium<const D: usize> {
    /// The coordinates.
    pub q: Vec<f64>,
    /// The contacts that press, in order of identity, with their forces on side 0, N, normal first.
    pub forces: Vec<(ContactId, Vector<D>)>,
    /// Rounds taken.
    pub rounds: u32,
    /// Size of the last round's step, in the norm of energy, relative to the scene: what is left to rounding.
    pub change: f64,
    /// Deepest penetration, m.
    pub penetration: f64,
}

/// Why no equilibrium was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EquilibriumError {
    /// A contact leaves its place.
    #[error("a contact moved {moved:e} m from its place in round {round}: there is no equilibrium there")]
    Leaves {
        /// The contact that went farthest beyond its reach.
        contact: ContactId,
        /// How far it got, m.
        moved: f64,
        /// The round in which it did.
        round: u32,
        /// The velocities of that round, m/s and rad/s: which way it goes.
        v: Vec<f64>,
    },
    /// The rounds ran out.
    #[error(
        "no equilibrium after {rounds} rounds: the last one still moved by {change:e} (relative, in the norm of energy)"
    )]
    Unsettled {
        /// Rounds taken.
        rounds: u32,
        /// Size of the last step, in the norm of energy, relative to the scene.
        change: f64,
        /// The velocities of the last round, m/s and rad/s.
        v: Vec<f64>,
    },
    /// The stiffness can't be factorised.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// The contacts don't make a problem.
    #[error("round {round}: {source}")]
    Problem {
        /// The round.
        round: u32,
        /// Why not.
        source: ProblemError,
    },
}

/// The first τ, s: shorter than the period of what is worth simulating.
const FIRST: f64 = 1e-5;

/// τ grows by this factor as long as mass takes part in a round by more than [`INERT`].
const GROWTH: f64 = 8.0;

/// Part of a step's energy norm that may come from M before τ grows: the error falls by about as much each round.
const INERT: f64 = 0.03;

/// Most rounds; ten to twenty is usual.
const ROUNDS: u32 = 200;

/// A step of this size, relative to the scene in the norm of energy, ends the search if the next is not much smaller.
const SETTLED: f64 = 1e-10;

/// Such a step ends it in any case.
const ROUNDING: f64 = 1e-16;

/// A step that isn't smaller than the last by this factor no longer shrinks.
const SHRINKS: f64 = 0.9;

/// Finds the static equilibrium near coordinates `q`, where the contacts were put, under the loads of time `t` (s). `work` may be
/// fresh, and must be made fresh before it serves a scheme; its solver should solve tightly, as the forces are no more
/// exact than its tolerance.
///
/// With friction there can be many equilibria, or none: this is the one reached in one go from `q`. Where contacts are
/// hyperstatic (both feet of a rigid block stick), λ_t is one of many, q is not.
///
/// # Errors
/// If something slides, tips, or falls, or the rounds don't come to rest.
pub fn settle<const D: usize>(
    model: &Model<D>,
    t: f64,
    q: &[f64],
    limits: &SettlingLimits<'_>,
    work: &mut Workspace<D>,
) -> Result<Equilibrium<D>, EquilibriumError> {
    let n = model.size().v;
    let mut search = Search {
        q: q.to_vec(),
        next: q.to_vec(),
        v: vec![0.0; n],
        impulse: vec![0.0; n],
        places: Vec::new(),
        warm: WarmStart::default(),
    };
    let (mut tau, mut longest, mut last) = (FIRST, f64::INFINITY, f64::INFINITY);
    let mut grown = true;
    for round in 1..=ROUNDS {
        search.round(model, t, tau, limits, work, round)?;
        let (size, inertia) = search.size(model);
        let change = size.sqrt();
        if !grown && change > last {
            // What a linear tangent promised was too much.
            longest = 0.25 * tau;
        }
        search.check_reach(model, limits, round)?;
        let settled = change <= ROUNDING || (!grown && change <= SETTLED && change > SHRINKS * last);
        if settled {
            return Ok(search.ended(model, round, change, work));
        }
        if !(change < f64::INFINITY) || round == ROUNDS {
            return Err(EquilibriumError::Unsettled { rounds: round, change, v: search.v });
        }
        let wanted = if inertia > INERT && change > SETTLED { GROWTH * tau } else { tau };
        let next = wanted.min(longest);
        grown = next != tau;
        search.remember(next / tau, work);
        (tau, last) = (next, change);
    }
    Err(EquilibriumError::Unsettled { rounds: ROUNDS, change: last, v: search.v })
}

/// Where a contact was put.
#[derive(Clone, Copy, Debug)]
struct Place<const D: usize> {
    id: ContactId,
    /// The point of side 0, and the point of side 1 that was its foot.
    sides: [Anchor<D>; 2],
    /// Whether it touched there.
    touched: bool,
}

/// A candidate with a gap up to this touches at the start, m.
const TOUCHES: f64 = 1e-9;

struct Search<const D: usize> {
    q: Vec<f64>,
    next: Vec<f64>,
    v: Vec<f64>,
    /// All impulses of a round, (M + τ²K) v but for what holds driven velocities.
    impulse: Vec<f64>,
    places: Vec<Place<D>>,
    warm: WarmStart,
}

impl<const D: usize> Search<D> {
    /// An implicit step of length τ from rest: leaves its velocities in `v`, and moves `q`.
    fn round(
        &mut self,
        model: &Model<D>,
        t: f64,
        tau: f64,
        limits: &SettlingLimits<'_>,
        work: &mut Workspace<D>,
        round: u32,
    ) -> Result<(), EquilibriumError> {
        let w = Weights { mass: 1.0, damping: 0.0, stiffness: tau * tau };
        let fresh = work.factors.is_empty();
        if fresh {
            work.factorise(model, w, &self.q)?;
        }
        self.v.fill(0.0);
        self.impulse.fill(0.0);
        for (part, factor) in model.parts().iter().zip(&mut work.factors) {
            let q = &self.q[part.q.clone()];
            let f = &mut self.impulse[part.v.clone()];
            if f.is_empty() {
                continue;
            }
            if !fresh {
                // The tangent of a part that is not linear is that of q.
                factor.refactor(w, q)?;
            }
            let v = &mut self.v[part.v.clone()];
            part.system.internal_force(q, v, f);
            part.system.load(t, f);
            f.iter_mut().for_each(|f| *f *= tau);
            v.copy_from_slice(f);
            factor.solve(v);
        }
        work.detect(model, &self.q, limits.margin);
        work.contacts.clear();
        for candidate in &work.candidates {
            let i = work.contacts.contacts().len();
            work.contacts.activate(model, &self.q, candidate, &self.warm);
            if work.contacts.withdraw_if_prescribed(model) {
                continue;
            }
            let place = place_of(&mut self.places, candidate);
            let mut shift = tangential(&(candidate.frame * between(model, &self.q, &place.sides))) / tau;
            shift[0] = candidate.gap / tau;
            let u_free = work.contacts.velocity(model, i, &self.v);
            work.contacts.pose(i, Vector::zeros(), u_free, shift);
        }
        if !work.contacts.contacts().is_empty() {
            work.solve_contacts(model, 1.0, &mut self.v)
                .map_err(|source| EquilibriumError::Problem { round, source })?;
            for (index, part) in model.parts().iter().enumerate() {
                work.contacts.add_generalised_impulse(index, &mut self.impulse[part.v.clone()]);
            }
        }
        let step: Vec<f64> = self.v.iter().map(|v| tau * v).collect();
        model.retract(&self.q, &step, 1.0, &mut self.next);
        std::mem::swap(&mut self.q, &mut self.next);
        Ok(())
    }

    /// ½ Δqᵀ(M/τ² + K)Δq of the last round over the scene's energy, and the part of M in it.
    fn size(&self, model: &Model<D>) -> (f64, f64) {
        let work = 0.5 * self.v.iter().zip(&self.impulse).map(|(v, p)| v * p).sum::<f64>().abs();
        if work == 0.0 {
            return (0.0, 0.0);
        }
        let now = model.energy(&self.q, &self.v);
        (work / (model.energy_scale() + now.elastic), now.kinetic / work)
    }

    /// Refuses contacts that have left their place.
    fn check_reach(&self, model: &Model<D>, limits: &SettlingLimits<'_>, round: u32) -> Result<(), EquilibriumError> {
        let mut farthest: Option<(f64, f64, ContactId)> = None;
        for place in self.places.iter().filter(|place| place.touched) {
            let Some(reach) = limits.reach.get(place.id.pair() as usize) else { continue };
            let moved = between(model, &self.q, &place.sides).norm();
            // Written so that NaN has left, too.
            if !(moved <= *reach) && !farthest.is_some_and(|(excess, ..)| excess >= moved / reach) {
                farthest = Some((moved / reach, moved, place.id));
            }
        }
        match farthest {
            Some((_, moved, contact)) => Err(EquilibriumError::Leaves { contact, moved, round, v: self.v.clone() }),
            None => Ok(()),
        }
    }

    /// Keeps the impulses for the next round, whose τ is larger by `factor`.
    fn remember(&mut self, factor: f64, work: &Workspace<D>) {
        self.warm.clear();
        for contact in work.contacts.contacts() {
            self.warm.push(contact.id, &(contact.p * factor));
        }
    }

    fn ended(self, model: &Model<D>, rounds: u32, change: f64, work: &mut Workspace<D>) -> Equilibrium<D> {
        let tau = work.factors.first().map_or(1.0, |factor| factor.weights().stiffness.sqrt());
        let pressing = work.contacts.contacts().iter().filter(|contact| contact.p[0] > 0.0);
        let forces = pressing.map(|contact| (contact.id, contact.p / tau)).collect();
        let penetration = work.penetration(model, &self.q);
        Equilibrium { q: self.q, forces, rounds, change, penetration }
    }
}

/// The place of a candidate: where it was first seen.
fn place_of<const D: usize>(places: &mut Vec<Place<D>>, candidate: &Candidate<D>) -> Place<D> {
    if let Some(place) = places.iter().find(|place| place.id == candidate.id) {
        return *place;
    }
    let place = Place { id: candidate.id, sides: candidate.sides, touched: candidate.gap <= TOUCHES };
    places.push(place);
    place
}

/// The way from the point of side 1 to that of side 0, m.
fn between<const D: usize>(model: &Model<D>, q: &[f64], sides: &[Anchor<D>; 2]) -> Vector<D> {
    let placed = model.placed(q);
    let at = |anchor: &Anchor<D>| {
        let mut place = [Vector::zeros()];
        placed.place(anchor.body, &[anchor.point], &mut place);
        place[0]
    };
    at(&sides[0]) - at(&sides[1])
}
