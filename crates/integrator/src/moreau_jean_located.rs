//! The Moreau–Jean step with located impacts: `moreau-jean-located` (`docs/schemes.md`).

mod drift;
mod impact;
mod jump;
mod leave;
mod locate;
mod missed;
mod turn;

use crate::closed_step::{ClosedStep, THETA};
use crate::factors::Factors;
use crate::moreau_jean_closed::deepest;
use crate::owed::Owed;
use crate::theta_step::weights;
use crate::{
    Contact, ContactStage, Keep, Model, MoreauJeanClosedSettings, Part, STEP_ROUNDING, Scheme, SettingError, State,
    StepError, StepReport, StepSpan, Weights, Workspace,
};
use drift::Flights;
use impact::Strike;
use jump::Rises;
use locate::Hit;
pub(crate) use locate::rate_at;
use teeter_contact::Outcome;
use teeter_detect::{BodyId, Candidates, ContactId};
use turn::Slide;

/// The settings of [`MoreauJeanLocated`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoreauJeanLocatedSettings {
    /// Impacts are located to a gap of this, m, or to rounding where that is more.
    pub gap_tolerance: f64,
}

impl Default for MoreauJeanLocatedSettings {
    fn default() -> Self {
        Self { gap_tolerance: 1e-12 }
    }
}

/// What it can't step.
const FOLLOWERS: &str = "matrices that follow their coordinates: what energy they keep depends on the size of the step";

/// A step is divided at so many jumps and ends of steep rises of loads at most.
const MOST_JUMPS: usize = 4;

/// Steps for which a contact with something elastic pressed lately.
const LATELY: f64 = 50.0;

/// Whether a subsystem yields to a push in more than its whole motion: a beam, not a block or the
/// ground.
pub(crate) fn is_elastic<const D: usize>(part: &Part<D>, index: usize, w: Weights, factors: &mut Factors<D>) -> bool {
    part.row > 0 && !part.is_prescribed() && factors.of(index, w).is_some_and(|factor| !factor.is_diagonal())
}

/// Whether a body can be in flight: it moves, and is no beam; what takes off from one has no place that is known so well.
fn may_fly<const D: usize>(model: &Model<D>, elastic: &[bool], body: BodyId) -> bool {
    model.moves(body) && model.owner(body).is_some_and(|(index, _, _)| elastic.get(index) == Some(&false))
}

/// W at an instant: M⁻¹.
const MASSES: Weights = Weights { mass: 1.0, damping: 0.0, stiffness: 0.0 };

/// The step of [`MoreauJeanClosed`](crate::MoreauJeanClosed), divided where a contact closes and where a
/// slide stops: of second order through both.
///
/// A step in which no open contact would end in its surface is that of the closed scheme. Otherwise
/// the time at which the first one touches is located; the step up to there is a step of its own,
/// with matrices of its own; then places stand still while velocities jump,
///
/// ```text
/// v⁺ = v⁻ + M⁻¹ Jᵀ p,   0 ≤ U_n⁺ + s_n ⊥ p_n ≥ 0,   s_n = e U_n⁻,   Coulomb on U_t⁺,   H = J M⁻¹ Jᵀ
/// ```
///
/// with all contacts that touch; and the rest of the step follows in the same way. e counts for a
/// contact that was open, where e |U_n⁻| > a h with a its free normal acceleration: this ends the
/// bounces of a contact that comes to rest. Restitution by Newton's law is made smaller where it
/// would make energy; then no impact does.
///
/// Contacts with duration have no impact: only the time at which they close is located. Subsystems
/// whose matrices follow their coordinates are refused, as what energy they keep depends on the size
/// of the step; but not those that [stretch](crate::Dynamics::stretching), such as beams held along
/// their axis.
#[derive(Debug)]
pub struct MoreauJeanLocated<const D: usize> {
    settings: MoreauJeanLocatedSettings,
    step: ClosedStep<D>,
    /// The state at the start of the part of the step that is taken.
    from: Option<Box<State>>,
    /// The contacts that touch at an impact.
    impact: ContactStage<D>,
    /// Open contacts that the step would end inside of.
    hits: Vec<Hit>,
    /// Slides that stop within the attempt.
    slides: Vec<Slide<D>>,
    /// Contacts that strike, with what their bodies may be off their place.
    strikes: Vec<Strike<D>>,
    ids: Vec<ContactId>,
    near: Candidates<D>,
    /// What is inside at a time within an attempt.
    on_the_way: Candidates<D>,
    /// Of these how far it is to the end of their surface, m.
    rooms: Vec<f64>,
    /// Contacts that are past it at the end of the attempt.
    leaving: Vec<ContactId>,
    /// Contacts that were closed before the attempt, in the order of `pieces`.
    persisting: Vec<ContactId>,
    /// Of these, on which pieces of their surfaces they are at the start of the attempt, and at another time.
    pieces: [Vec<u32>; 2],
    /// Coordinates on the way of an attempt.
    place: Vec<f64>,
    /// Rows of one contact.
    one: ContactStage<D>,
    /// What forces do to the velocities in a whole step.
    by_forces: Vec<f64>,
    /// Of contacts, in order of identity, how much their normal velocity may change without an impact, m/s, where that is
    /// known better.
    in_lowest_bounce: Vec<(ContactId, f64)>,
    /// v⁺.
    v: Vec<f64>,
    /// Which contacts of the last phase are closed after it.
    stays: Vec<bool>,
    /// Contacts with something elastic that pressed lately: pair, point, and the last step in which
    /// they did, as the state's memory holds them.
    lately: Vec<f64>,
    flights: Flights,
    rises: Rises,
    /// Which subsystems are elastic, and whether any is.
    elastic: Vec<bool>,
    has_elastic: bool,
    /// Whether any contact may be without something elastic.
    has_rigid_pairs: bool,
    /// Whether more contacts struck in the step than are located, or one wasn't found where it was located.
    unlocated: bool,
}

impl<const D: usize> MoreauJeanLocated<D> {
    /// Impacts and ends of slides that are located in a step. What comes after them in the same step is taken as a
    /// fixed step takes it: an open contact closes where the rest of the step would end in its
    /// surface.
    pub const MOST_IMPACTS: usize = 64;

    /// The same where anything is elastic: contacts chatter there, and the order of their closures depends on rounding.
    pub const MOST_ELASTIC_IMPACTS: usize = 8;

    /// The name by which users choose it.
    pub const NAME: &'static str = "moreau-jean-located";

    /// A scheme with these settings.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(settings: MoreauJeanLocatedSettings) -> Result<Self, SettingError> {
        let gap_tolerance = settings.gap_tolerance;
        MoreauJeanClosedSettings { gap_tolerance }.check()?;
        Ok(Self {
            settings,
            step: ClosedStep::new(gap_tolerance).past_ends(),
            from: None,
            impact: ContactStage::new(),
            hits: Vec::new(),
            slides: Vec::new(),
            strikes: Vec::new(),
            ids: Vec::new(),
            near: Vec::new(),
            on_the_way: Vec::new(),
            rooms: Vec::new(),
            leaving: Vec::new(),
            persisting: Vec::new(),
            pieces: [Vec::new(), Vec::new()],
            place: Vec::new(),
            one: ContactStage::new(),
            by_forces: Vec::new(),
            in_lowest_bounce: Vec::new(),
            v: Vec::new(),
            stays: Vec::new(),
            lately: Vec::new(),
            flights: Flights::default(),
            rises: Rises::default(),
            elastic: Vec::new(),
            has_elastic: true,
            has_rigid_pairs: true,
            unlocated: false,
        })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &MoreauJeanLocatedSettings {
        &self.settings
    }
}

impl<const D: usize> Scheme<D> for MoreauJeanLocated<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn drives_about(&self) -> Option<f64> {
        Some(THETA)
    }

    fn start(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError> {
        // Their modified energy depends on the size of the step: each change of it would take or
        // give some.
        let refused = |part: &Part<D>| part.traits.follows_coordinates && part.stretching().is_none();
        if model.parts().iter().any(refused) {
            return Err(StepError::Unsupported { what: FOLLOWERS });
        }
        let contacts = model.contacts_to_expect();
        self.step.start(model, state, work)?;
        self.step.step.owed.restore(model, state);
        self.impact.reserve(model);
        self.one.reserve(model);
        self.hits.reserve(contacts);
        self.slides.reserve(contacts);
        self.ids.reserve(contacts);
        self.near.reserve(contacts);
        // Few of many contacts are inside on the way, or strike at once.
        self.on_the_way.reserve(contacts.min(crate::stage::RESERVED_CONTACTS));
        self.strikes.reserve(contacts.min(crate::stage::RESERVED_CONTACTS));
        self.rooms.reserve(contacts);
        self.leaving.reserve(contacts);
        self.persisting.reserve(contacts);
        self.pieces.iter_mut().for_each(|pieces| pieces.reserve(contacts));
        self.stays.reserve(contacts);
        // Few bodies fly that have stood still before.
        let flights = model.body_count().min(crate::stage::RESERVED_CONTACTS);
        let numbers = 3 * contacts + Flights::NUMBERS * flights + Owed::most_numbers(model);
        self.lately.reserve(numbers);
        self.flights.reserve(flights, model.body_count());
        self.rises.start(model);
        self.by_forces.resize(model.size().v, 0.0);
        self.in_lowest_bounce.reserve(contacts.min(crate::stage::RESERVED_CONTACTS));
        self.v.resize(model.size().v, 0.0);
        self.place.resize(model.size().q, 0.0);
        state.memory.reserve_numbers(numbers);
        let mut from = state.clone();
        from.memory.reserve_numbers(numbers);
        from.warm.reserve(contacts, D);
        from.memory.reserve(contacts);
        self.from = Some(Box::new(from));
        let jumps = if model.parts().iter().any(|part| part.traits.loaded) { MOST_JUMPS } else { 0 };
        // More of them, where bounces accumulate, are rare.
        work.reserve_phases(model, 2 * Self::MOST_ELASTIC_IMPACTS + jumps + 1);
        // A part of a step will need a factor of its own, and an impact that of the masses.
        work.factors(model, MASSES, &state.q, Keep::Pinned)?;
        work.factors(model, weights(0.5 * state.dt, THETA), &state.q, Keep::Once)?;
        let w = weights(state.dt, THETA);
        work.factors(model, w, &state.q, Keep::Pinned)?;
        let parts = model.parts().iter().enumerate();
        self.elastic.clear();
        self.elastic.extend(parts.map(|(index, part)| is_elastic(part, index, w, &mut work.factors)));
        self.has_elastic = self.elastic.contains(&true);
        let wiring = model.detector().wiring();
        // Without a list anything may touch anything.
        self.has_rigid_pairs =
            wiring.is_empty() || wiring.iter().any(|wiring| !self.is_with_elastic(model, &wiring.bodies));
        Ok(())
    }

    fn advance<'w>(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        until: f64,
        work: &'w mut Workspace<D>,
    ) -> Result<StepReport<'w, D>, StepError> {
        let span = state.next_step(until);
        work.begin(model, state, span)?;
        self.check(model)?;
        let mut from = self.from.take().unwrap_or_else(|| Box::new(state.clone()));
        from.copy_motion(state);
        self.lately.clear();
        self.flights.clear();
        for held in state.memory.all_numbers().chunks_exact(3) {
            if held[0] == Owed::MARK {
                continue;
            }
            match held[0] < 0.0 {
                true => self.flights.push(held),
                false => self.lately.extend_from_slice(held),
            }
        }
        let penetration = self.take_parts(model, &mut from, &span, work);
        self.from = Some(from);
        let (penetration, stays) = (penetration?, &self.stays);
        let report = work.finish(model, state, Some(penetration), |i, _| stays[i])?;
        self.lately.extend(self.flights.numbers());
        self.lately.extend(self.step.step.owed.numbers(state.dt));
        state.memory.set_numbers(&self.lately);
        state.tally.unlocated_steps += u64::from(self.unlocated);
        Ok(report)
    }
}

impl<const D: usize> MoreauJeanLocated<D> {
    /// Refuses another model than the scheme's, and takes the sizes of the model.
    pub(crate) fn check(&mut self, model: &Model<D>) -> Result<(), StepError> {
        self.step.check(model)?;
        self.by_forces.resize(model.size().v, 0.0);
        self.v.resize(model.size().v, 0.0);
        self.place.resize(model.size().q, 0.0);
        Ok(())
    }

    /// Lets the contacts that touch at `from` strike; `closed`, which rise, were closed up to here. An approach
    /// that `by_forces` make is no impact, nor one by the change of normal velocity (m/s) with which `in_lowest_bounce`
    /// lists a contact; that rises, too.
    pub(crate) fn strike_by(
        &mut self,
        model: &Model<D>,
        from: &mut State,
        closed: &[ContactId],
        by_forces: impl Iterator<Item = f64>,
        in_lowest_bounce: &[(ContactId, f64)],
        work: &mut Workspace<D>,
    ) -> Result<bool, StepError> {
        self.step.closed.clear();
        self.step.closed.extend_from_slice(closed);
        self.by_forces.clear();
        self.by_forces.extend(by_forces);
        self.in_lowest_bounce.clear();
        self.in_lowest_bounce.extend_from_slice(in_lowest_bounce);
        self.flights.clear();
        let end = from.t;
        let struck = self.strike(model, from, end, work);
        self.in_lowest_bounce.clear();
        struck
    }

    /// Takes the rest of a step that another scheme began.
    pub(crate) fn take_rest(
        &mut self,
        model: &Model<D>,
        from: &mut State,
        rest: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        self.lately.clear();
        self.flights.clear();
        self.take_parts(model, from, rest, work).map(|_| ())
    }

    /// Takes the step from impact to impact, each part of it from `from`, which moves on; returns
    /// the penetration at its end, m.
    fn take_parts(
        &mut self,
        model: &Model<D>,
        from: &mut State,
        span: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<f64, StepError> {
        let (mut left, mut impacts, mut jumps, mut struck) = (span.h, 0, 0, true);
        self.unlocated = false;
        self.step.step.owed.begin(model);
        loop {
            let rest = StepSpan { start: from.t, end: span.end, h: left };
            self.step.step.owed.go_on(rest);
            self.step.begin(model, from, &rest, work)?;
            self.step.of_step = left / span.h;
            if impacts == 0 {
                let whole = span.h / left;
                for ((by_forces, free), v0) in self.by_forces.iter_mut().zip(&self.step.v_free).zip(&from.v) {
                    *by_forces = (free - v0) * whole;
                }
            }
            // Not one that rounding leaves at an end of what is left.
            let margin = STEP_ROUNDING * span.h;
            let jump = if jumps < MOST_JUMPS { self.find_jump(model, &rest, from.dt, margin) } else { None };
            let rest = jump.map_or(rest, |end| StepSpan { end, h: end - from.t, ..rest });
            if jump.is_some() {
                self.step.begin(model, from, &rest, work)?;
                self.step.of_step = rest.h / span.h;
            }
            let too_many = impacts == if self.has_elastic { Self::MOST_ELASTIC_IMPACTS } else { Self::MOST_IMPACTS };
            self.unlocated |= too_many || !struck;
            let (outcome, found) = if too_many || !struck {
                (self.step.settle(model, from, &rest, work)?, None)
            } else {
                self.locate(model, from, &rest, work)?
            };
            // Up to the end, or to the next impact, a slide may stop.
            let reached = found.map_or(rest, |tau| StepSpan { end: from.t + tau, h: tau, ..rest });
            // Nothing stops or ends before what strikes at once.
            let at_once = found == Some(0.0);
            let (outcome, stops) = match too_many || at_once {
                true => (outcome, None),
                false => self.find_stop(model, from, &reached, outcome, work)?,
            };
            // A contact may come to the end of its surface before.
            let attempted = stops.map_or(reached, |tau| StepSpan { end: from.t + tau, h: tau, ..rest });
            let (outcome, leaves) = if too_many {
                self.find_what_leaves(model, rest.h, work)?;
                (outcome, None)
            } else if at_once {
                self.leaving.clear();
                (outcome, None)
            } else {
                self.find_end(model, from, &attempted, outcome, work)?
            };
            let stops = leaves.or(stops);
            if let Some(tau) = stops {
                let part = StepSpan { end: from.t + tau, h: tau, ..rest };
                self.take_part(model, from, &part, outcome, work)?;
                self.remember_lately(model, from, work);
                (left, impacts, struck) = (left - tau, impacts + 1, true);
                continue;
            }
            let Some(tau) = found else {
                let penetration = deepest(work);
                self.take_part(model, from, &rest, outcome, work)?;
                self.remember_lately(model, from, work);
                if jump.is_some() {
                    (left, jumps, struck) = (left - rest.h, jumps + 1, true);
                    continue;
                }
                return Ok(penetration);
            };
            // What rounding leaves of a step is nothing.
            let last = left - tau <= STEP_ROUNDING * span.h;
            let end = if last { span.end } else { from.t + tau };
            if tau > 0.0 {
                self.take_part(model, from, &StepSpan { start: from.t, end, h: tau }, outcome, work)?;
            }
            struck = self.strike(model, from, end, work)? || tau > 0.0;
            self.remember_lately(model, from, work);
            (left, impacts) = (left - tau, impacts + 1);
            if last {
                work.detect(model, &from.q, 0.0)?;
                return Ok(deepest(work));
            }
        }
    }

    /// Whether a contact with something elastic pressed lately. Such a contact chatters: it is lost
    /// and closes again some thirty times, and where each of these closures is located, their order
    /// depends on rounding.
    fn pressed_lately(&self, id: ContactId) -> bool {
        self.lately.chunks_exact(3).any(|held| held[0] == f64::from(id.pair()) && held[1] == f64::from(id.point()))
    }

    /// Enters the contacts with something elastic that pressed or struck so far in the step from
    /// `from`, and forgets those that have not for long.
    fn remember_lately(&mut self, model: &Model<D>, from: &State, work: &mut Workspace<D>) {
        if !self.has_elastic {
            return;
        }
        let (now, w) = (from.step.saturating_add(1) as f64, weights(from.dt, THETA));
        let (contacts, factors) = work.contacts_and_factors();
        for contact in contacts.filter(|contact| contact.p[0] > 0.0) {
            let (pair, point) = (f64::from(contact.id.pair()), f64::from(contact.id.point()));
            if let Some(held) = self.lately.chunks_exact_mut(3).find(|held| held[0] == pair && held[1] == point) {
                held[2] = now;
            } else if contact
                .sides
                .iter()
                .any(|side| model.owner(side.body).is_some_and(|(index, part, _)| is_elastic(part, index, w, factors)))
            {
                self.lately.extend_from_slice(&[pair, point, now]);
            }
        }
        let mut kept = 0;
        for at in (0..self.lately.len()).step_by(3) {
            if now - self.lately[at + 2] <= LATELY {
                self.lately.copy_within(at..at + 3, kept);
                kept += 3;
            }
        }
        self.lately.truncate(kept);
    }

    /// Remembers what bodies have drifted that take off in the part of the step from `from`, and forgets it of those that have landed.
    fn follow_flights(&mut self, model: &Model<D>, from: &State, work: &mut Workspace<D>) -> Result<(), StepError> {
        let Self { step, stays, flights, near, elastic, ids, .. } = self;
        let contacts = step.stage.contacts();
        flights.land(model, contacts, stays, |body| may_fly(model, elastic, body));
        if flights.any_takes_off(contacts) {
            ids.clear();
            ids.extend(from.memory.active());
            work.locate(model, &from.q, ids, near)?;
            flights.take_off(model, near, from.t);
        }
        Ok(())
    }

    /// Forgets the closed contacts that have opened by the end of the part: what strikes there doesn't press them. On a beam they chatter, and go
    /// on counting as closed, as they do from step to step.
    fn forget_what_opened(&mut self, model: &Model<D>) {
        for i in 0..self.step.stage.len() {
            let Contact { id, sides, .. } = self.step.stage.contacts()[i];
            if self.step.has_opened(i)
                && !self.is_with_elastic(model, &sides.map(|side| side.body))
                && let Ok(at) = self.step.closed.binary_search(&id)
            {
                self.step.closed.remove(at);
            }
        }
    }

    /// Ends the part of the step that was attempted, and moves on to its end.
    fn take_part(
        &mut self,
        model: &Model<D>,
        from: &mut State,
        part: &StepSpan,
        outcome: Option<Outcome>,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        self.step.find_what_stays();
        self.forget_what_opened(model);
        self.stays.clear();
        let contacts = self.step.stage.contacts().iter().zip(&self.step.stays);
        // A pressed spring is kept for the contact that takes it over.
        let leaves = |contact: &Contact<D>| contact.gap_after.is_none() && self.leaving.contains(&contact.id);
        self.stays.extend(contacts.map(|(contact, stays)| *stays && !leaves(contact)));
        self.follow_flights(model, from, work)?;
        from.warm.clear();
        from.memory.forget_contacts();
        for (contact, stays) in self.step.stage.contacts().iter().zip(&self.stays) {
            if *stays {
                from.warm.push(contact.id, &contact.p);
                from.memory.remember(contact);
            }
        }
        self.step.end_phase(model, from, part, outcome, work)?;
        let motion = &mut self.step.step;
        motion.owed.take_part(model, from, part.h, &motion.v_end);
        from.q.copy_from_slice(&motion.q_at);
        from.v.copy_from_slice(&motion.v_end);
        from.t = part.end;
        Ok(())
    }
}
