//! Static equilibrium of a model with contacts, from which it can start at rest (`docs/theory.md`
//! §8).
//!
//! Coordinates q and contact forces λ are sought with
//!
//! ```text
//! F(q) + P(t) + Jᵀλ = 0,     0 ≤ g(q) ⊥ λ_n ≥ 0,     ‖λ_t‖ ≤ μ λ_n, against the slip s(q) where it slips
//! ```
//!
//! Here Signorini's condition is imposed on gaps, not on velocities, and Coulomb's law on the slip
//! from where the foot of the contact was at first: friction depends on the total slip, not on its
//! path. [Driven](crate::Traits) velocities are held at zero by whatever force that takes.
//!
//! It is found by a proximal-point iteration. A round is an implicit step of length τ from rest,
//!
//! ```text
//! v = (M + τ²K)⁻¹ (τ (F(q) + P) + Jᵀp),     q ← q ⊕ τ v,     p = τ λ
//! ```
//!
//! whose law holds for u + (g, s)/τ, and so for the gap and the slip at its end. Mass stands in for
//! the stiffness that a rigid block lacks: τ grows until mass hardly matters, and a round is then a
//! step of Newton's method. Each round takes the forces at q; K only guides the iteration, and may
//! be approximate.

mod summits;

use crate::contact::tangential;
use crate::mismatch::length;
use crate::{
    Contact, ContactError, ContactStage, FactorError, Keep, Memory, Mismatch, Model, Over, Responses, Rule, Vector,
    WarmStart, Weights, Workspace,
};
use summits::Summits;
use teeter_detect::{Anchor, Candidate, ContactId, Frame, Geometry};

/// Limits of the search.
#[derive(Clone, Copy, Debug)]
pub struct SettlingLimits<'a> {
    /// By pair: how far (m) a point that touched at first may move from where it touched. If it
    /// moves farther, its body has no equilibrium there. Pairs beyond the slice have no limit.
    pub reach: &'a [f64],
    /// Candidates with a gap up to this take part, m: those that may touch in the end.
    pub margin: f64,
    /// τ of the first round, s: [`FIRST_TAU`](Self::FIRST_TAU), or the last τ of an earlier search
    /// that this one continues.
    pub tau: f64,
}

impl SettlingLimits<'_> {
    /// Shorter than any period worth simulating, s.
    pub const FIRST_TAU: f64 = 1e-5;
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
    /// Size of the last round's step relative to the scene, or of its imbalance of impulses
    /// relative to the contacts' impulses, whichever is larger; both in the energy norm.
    pub change: f64,
    /// τ of the last round, s.
    pub tau: f64,
    /// Deepest penetration, m.
    pub penetration: f64,
}

/// Why no equilibrium was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EquilibriumError {
    /// A contact leaves its place.
    #[error(
        "a contact lifted by {lifted:.2e} m and slid by {slid:.2e} m by round {round}: there is no equilibrium where it was put"
    )]
    Leaves {
        /// The contact that went farthest beyond its reach.
        contact: ContactId,
        /// Largest distance of a contact of its pair along its original normal, m.
        lifted: f64,
        /// Largest distance across that normal, m.
        slid: f64,
        /// The round that found it.
        round: u32,
    },
    /// The limit of rounds was reached.
    #[error(
        "no equilibrium after {rounds} rounds: the last one still moved by {change:e} (relative, in the norm of energy)"
    )]
    Unsettled {
        /// Rounds taken.
        rounds: u32,
        /// As in [`Equilibrium`].
        change: f64,
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
        source: ContactError,
    },
    /// The coordinates or the workspace are of another model.
    #[error(transparent)]
    Mismatch(#[from] Mismatch),
}

/// τ grows by this factor as long as the share of mass in a round is more than [`INERT`].
const GROWTH: f64 = 4.0;

/// Share of a step's energy norm that may come from M without τ growing: the error falls by about
/// this factor each round. With a larger τ, gaps lose digits, ε g τ².
const INERT: f64 = 0.1;

/// While the contacts' impulses alone would change less than this fraction of the scene's energy in
/// a round, τ grows in any case.
const SHORT: f64 = 1e-2;

/// Most rounds; twenty is usual.
const ROUNDS: u32 = 200;

/// Steps up to this size, relative to the scene in the energy norm, end the search once they no
/// longer shrink. Rounding of the coordinates alone leaves ε n² for a beam of n elements: 1e-13 for
/// 20, 1e-9 for 3000, all of it in deformations of single elements.
const SETTLED: f64 = 1e-8;

/// A step of this size ends the search in any case.
const ROUNDING: f64 = 1e-16;

/// Steps shrink if they are smaller than the smallest so far by this factor.
const SHRINKS: f64 = 0.9;

/// Rounds without shrinking that end the search, once steps are small.
const STALLED: u32 = 2;

/// If a step is larger than the last one with the same τ by this factor, and nothing is falling,
/// the tangent is too soft for τ.
const GROWS: f64 = 1.1;

/// After this many rounds without shrinking the steps are taken to go in a circle, because the
/// tangent is too soft.
const CIRCLES: u32 = 8;

/// Finds the static equilibrium near coordinates `q`, from which slip is counted, under the loads
/// at time `t` (s). Don't use `work` for a scheme afterwards: make a new one. Its solver should
/// have a tight tolerance, as that limits the accuracy of the forces.
///
/// With friction there can be many equilibria, or none: this is the one reached from `q` in a
/// single load step. If contacts are hyperstatic (both feet of a rigid block stick), λ_t is one of
/// many, but q is unique.
///
/// # Errors
/// If something slides, tips or falls, or the iteration doesn't converge; or if there are too few
/// or too many coordinates, or the workspace is of another model.
pub fn settle<const D: usize>(
    model: &Model<D>,
    t: f64,
    q: &[f64],
    limits: &SettlingLimits<'_>,
    work: &mut Workspace<D>,
) -> Result<Equilibrium<D>, EquilibriumError> {
    work.check(model)?;
    length("the coordinates", q, model.size().q)?;
    let n = model.size().v;
    let mut search = Search {
        q: q.to_vec(),
        other: q.to_vec(),
        v: vec![0.0; n],
        impulse: vec![0.0; n],
        places: Vec::new(),
        summits: Summits::default(),
        warm: WarmStart::default(),
        nothing: Memory::default(),
        stage: ContactStage::new(),
    };
    let (mut tau, mut longest) = (limits.tau, f64::INFINITY);
    let (mut least, mut stalled) = (f64::INFINITY, 0);
    // Whether the round is the first with its τ: only later ones can be compared to see
    // convergence.
    let mut first = true;
    let mut size_before = f64::INFINITY;
    // How many summits had been found deep inside their bases in the two rounds before.
    let mut deep_before = [0; 2];
    for round in 1..=ROUNDS {
        search.round(model, t, tau, limits, work, round)?;
        let Step { size, change, inertia, short } = search.step(model);
        search.summits.forget(search.stage.contacts());
        let deep = search.summits.deep();
        let none_new = deep_before == [deep; 2];
        deep_before = [deep, deep_before[0]];
        // A summit that was found in this round or the last one moves what bears: steps grow with any tangent, and are mostly inertia.
        if !first && none_new && size > (GROWS * size_before).max(SETTLED) && inertia < 0.5 {
            // The tangent was too soft: go back, and take a shorter τ.
            search.go_back();
            tau *= 0.25;
            (longest, first) = (tau, true);
            search.warm.clear();
            continue;
        }
        search.check_reach(model, limits, round)?;
        let pressing = || search.stage.contacts().iter().filter(|contact| contact.p[0] > 0.0);
        if first || change < SHRINKS * least {
            (least, stalled) = (change, 0);
        } else {
            stalled += 1;
        }
        let last = stalled >= STALLED || round == ROUNDS;
        // A summit that was just found isn't held yet.
        if none_new && (change <= ROUNDING || (last && change <= SETTLED)) {
            let named = |contact: &Contact<D>| Some((search.summits.identity(contact.id)?, contact.p / tau));
            let mut forces: Vec<_> = pressing().filter_map(named).collect();
            forces.sort_by_key(|(id, _)| *id);
            // Summits on both sides of one that is there now.
            forces.dedup_by(|(id, force), (first, sum)| {
                let same = id == first;
                if same {
                    *sum += *force;
                }
                same
            });
            search.go_on(model, tau);
            let penetration = work.penetration(model, &search.q)?;
            return Ok(Equilibrium { q: search.q, forces, rounds: round, change, tau, penetration });
        }
        if !change.is_finite() || round == ROUNDS {
            return Err(EquilibriumError::Unsettled { rounds: round, change });
        }
        search.go_on(model, tau);
        if stalled >= CIRCLES {
            longest = 0.25 * tau;
        }
        let grows = !first && (short || (none_new && inertia > INERT && change > SETTLED));
        let next = if grows { GROWTH * tau } else { tau }.min(longest);
        search.warm.clear();
        for contact in search.stage.contacts() {
            search.warm.push(contact.id, &(contact.p * (next / tau)));
        }
        first = next != tau;
        (tau, size_before) = (next, size);
    }
    Err(EquilibriumError::Unsettled { rounds: ROUNDS, change: least })
}

/// Where a contact was at first.
#[derive(Clone, Copy, Debug)]
struct Place<const D: usize> {
    id: ContactId,
    /// The point of side 0, and the point of side 1 that was its foot.
    sides: [Anchor<D>; 2],
    frame: Frame<D>,
    /// The vector between the two, m: a gap, and the difference between the model's surface and its
    /// points.
    apart: Vector<D>,
    /// Whether it touched there.
    touched: bool,
}

impl<const D: usize> Place<D> {
    /// How far side 0 has moved from it relative to side 1, m.
    fn way(&self, model: &Model<D>, q: &[f64]) -> Vector<D> {
        between(model, q, &self.sides) - self.apart
    }
}

/// A candidate with a gap up to this touches at the start, m.
const TOUCHES: f64 = 1e-9;

/// How large a round's step is.
struct Step {
    /// In the norm of energy, relative to the scene.
    size: f64,
    /// As [`Equilibrium::change`].
    change: f64,
    /// The part of M in it.
    inertia: f64,
    /// Whether τ is so short that gaps are lost in rounding.
    short: bool,
}

struct Search<const D: usize> {
    q: Vec<f64>,
    /// The coordinates before the last step.
    other: Vec<f64>,
    v: Vec<f64>,
    /// All impulses of a round: (M + τ²K) v, except those that hold driven velocities.
    impulse: Vec<f64>,
    places: Vec<Place<D>>,
    summits: Summits<D>,
    warm: WarmStart,
    nothing: Memory,
    stage: ContactStage<D>,
}

impl<const D: usize> Search<D> {
    /// An implicit step of length τ from rest: leaves its velocities in `v`.
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
        work.factors.make(model, w, &self.q, Keep::Once)?;
        self.v.fill(0.0);
        self.impulse.fill(0.0);
        for (index, part) in model.parts().iter().enumerate() {
            let q = &self.q[part.q.clone()];
            let f = &mut self.impulse[part.v.clone()];
            let Some(factor) = work.factors.of(index, w).filter(|_| !f.is_empty()) else { continue };
            if part.traits.follows_coordinates {
                // A non-linear part has its tangent at q.
                factor.refactor(w, q)?;
                factor.take_tangent(q)?;
            }
            let v = &mut self.v[part.v.clone()];
            part.system.internal_force(q, v, f);
            part.system.load(t, f);
            f.iter_mut().for_each(|f| *f *= tau);
            v.copy_from_slice(f);
            factor.solve(v);
        }
        work.detect(model, &self.q, limits.margin)?;
        self.summits.exchange(model, &self.q, limits.margin, &mut work.candidates);
        self.stage.clear();
        for candidate in &work.candidates {
            let i = self.stage.len();
            if !self.stage.add(model, &self.q, candidate, &self.warm, &self.nothing)? {
                continue;
            }
            let first = self.summits.first(candidate.id);
            let known = Candidate { id: first.unwrap_or(candidate.id), ..*candidate };
            let place = place_of(model, &self.q, &mut self.places, &known);
            let frame = if first.is_some() { place.frame } else { candidate.frame };
            let mut shift = tangential(&(frame * place.way(model, &self.q))) / tau;
            shift[0] = candidate.gap / tau;
            let u_free = self.stage.velocity(i, &self.v)?;
            // At rest all laws are Signorini's and Coulomb's.
            self.stage.set(i, Vector::zeros(), u_free, shift, Rule::Shifted)?;
        }
        let problem = |source| EquilibriumError::Problem { round, source };
        let (over, responses) = (Over::Step { h: tau, weight: 1.0 }, Responses::Of(w));
        self.stage.solve(model, work, &responses, over).map_err(problem)?;
        self.stage.respond(model, work, &responses, &mut self.v).map_err(problem)?;
        self.stage.complete(&self.v)?;
        for (index, part) in model.parts().iter().enumerate() {
            self.stage.add_generalised_impulse(index, &mut self.impulse[part.v.clone()]);
        }
        Ok(())
    }

    /// Takes the step.
    fn go_on(&mut self, model: &Model<D>, tau: f64) {
        model.move_along(&self.q, &self.v, tau, &mut self.other);
        std::mem::swap(&mut self.q, &mut self.other);
    }

    /// Undoes the last step taken.
    fn go_back(&mut self) {
        self.q.clone_from(&self.other);
    }

    /// Measures the round's step.
    fn step(&self, model: &Model<D>) -> Step {
        // ½ vᵀ(M + τ²K) v = ½ Δqᵀ(M/τ² + K) Δq: how much the round lowers the potential.
        let step = 0.5 * self.v.iter().zip(&self.impulse).map(|(v, p)| v * p).sum::<f64>().abs();
        let now = model.energy_at(&self.q, &self.v);
        let scene = model.energy_scale() + now.elastic;
        // The same for the contacts' impulses alone. It is small if τ is so short that gaps are
        // lost in rounding.
        let pressed = self.stage.contacts().iter().zip(&self.stage.problem.posed);
        let pressed =
            0.5 * pressed.map(|(contact, posed)| (contact.u_after - posed.u_free).dot(&contact.p)).sum::<f64>();
        let short = pressed > 0.0 && pressed < SHORT * scene;
        // When the first load bends a straight beam, there is nothing to compare with yet: count
        // all of it.
        let over = |scale: f64| if scale > 0.0 { (step / scale).sqrt() } else { 1.0 };
        if step == 0.0 {
            return Step { size: 0.0, change: 0.0, inertia: 0.0, short };
        }
        let change = over(if short { pressed } else { scene });
        Step { size: over(scene), change, inertia: now.kinetic / step, short }
    }

    /// Returns an error if a contact has left its place.
    fn check_reach(&self, model: &Model<D>, limits: &SettlingLimits<'_>, round: u32) -> Result<(), EquilibriumError> {
        let mut farthest: Option<(f64, f64, ContactId)> = None;
        for place in self.places.iter().filter(|place| place.touched) {
            let Some(reach) = limits.reach.get(place.id.pair() as usize) else { continue };
            let moved = place.frame * place.way(model, &self.q);
            let excess = moved.norm() / reach;
            // Written so that NaN counts as having left.
            if !(excess <= 1.0) && !farthest.is_some_and(|(most, ..)| most >= excess) {
                farthest = Some((excess, tangential(&moved).norm(), place.id));
            }
        }
        let Some((_, slid, contact)) = farthest else { return Ok(()) };
        // A tipping body also lifts another foot.
        let same = self.places.iter().filter(|place| place.touched && place.id.pair() == contact.pair());
        let lifted = same.map(|place| (place.frame * place.way(model, &self.q))[0].abs()).fold(0.0, f64::max);
        Err(EquilibriumError::Leaves { contact, lifted, slid, round })
    }
}

/// The place of a candidate: where it was first seen.
fn place_of<const D: usize>(
    model: &Model<D>,
    q: &[f64],
    places: &mut Vec<Place<D>>,
    candidate: &Candidate<D>,
) -> Place<D> {
    let Candidate { id, sides, frame, gap, .. } = *candidate;
    if let Some(place) = places.iter().find(|place| place.id == id) {
        return *place;
    }
    let place = Place { id, sides, frame, apart: between(model, q, &sides), touched: gap <= TOUCHES };
    places.push(place);
    place
}

/// The vector from the point of side 1 to that of side 0, m.
fn between<const D: usize>(model: &Model<D>, q: &[f64], sides: &[Anchor<D>; 2]) -> Vector<D> {
    let placed = model.placed_at(q);
    let at = |anchor: &Anchor<D>| {
        let mut place = [Vector::zeros()];
        placed.place(anchor.body, &[anchor.point], &mut place);
        place[0]
    };
    at(&sides[0]) - at(&sides[1])
}
