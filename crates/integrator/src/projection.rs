//! The projection of coordinates onto what contacts allow, at the end of a step: velocities stay
//! as they are (Acary 2013, doi 10.1016/j.cma.2012.12.012).

use crate::mismatch::Mismatch;
use crate::{ContactError, ContactStage, Memory, Model, Over, Responses, Rule, State, Vector, WarmStart, Workspace};
use teeter_contact::Outcome;
use teeter_detect::{Candidate, Candidates, ContactId};

/// A gap is known to so much of the lengths that it is the difference of.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Newton's steps at the most: two or three to gaps of 0, and as many to the last digit of d.
const MOST_ROUNDS: usize = 20;

/// The unilateral problem on gaps, by Newton's method:
///
/// ```text
/// 0 ≤ g(q) ⊥ ν ≥ 0,   q = q̃ ⊕ d,   d = W Jᵀ ν
/// 0 ≤ g(q_k) + J(q_k) (d − d_k) ⊥ ν ≥ 0        round k + 1
/// ```
///
/// It ends where no gap is below 0, and none that is pushed above it, by more than rounding, and
/// where d has settled to as much: 16 ε of Σ|J q| and of where a contact's points are on their
/// bodies, which are lengths whatever the units. Contacts with duration are left alone, and so are those between what moves as
/// prescribed. Contacts that a round closes are added before the next.
///
/// Only what the step has made is taken back: a contact that began in its surface is kept at its gap
/// there, and one that began beside its surface, such as a corner that comes in under a beam's end, at
/// the gap with which it came in. To push these out would throw the body up by as much.
#[derive(Debug)]
pub(crate) struct Projection<const D: usize> {
    stage: ContactStage<D>,
    /// Rows of one contact.
    one: ContactStage<D>,
    /// Contacts whose gaps are kept at 0 or more, in order of identity.
    ids: Vec<ContactId>,
    /// The gaps at which contacts are kept that aren't kept at 0, m.
    levels: Vec<(ContactId, f64)>,
    at_start: Candidates<D>,
    /// Those of them that were pushed.
    pushed: Vec<ContactId>,
    near: Candidates<D>,
    /// The projected coordinates.
    q: Vec<f64>,
    /// d.
    moved: Vec<f64>,
    /// d of a round; then what the round has changed of it.
    trial: Vec<f64>,
    /// Contacts of a projection have neither a start for the solver nor a past.
    warm: WarmStart,
    memory: Memory,
}

impl<const D: usize> Projection<D> {
    pub(crate) fn new() -> Self {
        Self {
            stage: ContactStage::new(),
            one: ContactStage::new(),
            ids: Vec::new(),
            levels: Vec::new(),
            at_start: Vec::new(),
            pushed: Vec::new(),
            near: Vec::new(),
            q: Vec::new(),
            moved: Vec::new(),
            trial: Vec::new(),
            warm: WarmStart::default(),
            memory: Memory::default(),
        }
    }

    /// Makes room for what a step of the model can need.
    pub(crate) fn reserve(&mut self, model: &Model<D>) {
        let contacts = model.contacts_to_expect();
        self.stage.reserve(model);
        self.one.reserve(model);
        self.near.reserve(contacts);
        self.ids.reserve(contacts);
        self.pushed.reserve(contacts);
        self.levels.reserve(contacts);
        self.at_start.reserve(contacts);
        self.q.reserve(model.size().q);
        self.moved.reserve(model.size().v);
        self.trial.reserve(model.size().v);
    }

    /// The projected coordinates.
    pub(crate) fn q(&self) -> &[f64] {
        &self.q
    }

    /// The contacts that were pushed apart, in order of identity.
    pub(crate) fn pushed(&self) -> &[ContactId] {
        &self.pushed
    }

    /// Projects coordinates, in the metric whose inverse is in `responses`. The workspace's
    /// candidates have to be those at them with a gap of at most 0; they are so at the projected
    /// ones afterwards. `None` where nothing had to be moved. What can't be solved is left where it
    /// was, and said by the outcome.
    pub(crate) fn project(
        &mut self,
        model: &Model<D>,
        state: &State,
        q_start: &[f64],
        responses: &Responses<'_>,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, ContactError> {
        self.q.clear();
        self.q.extend_from_slice(q_start);
        self.ids.clear();
        self.pushed.clear();
        self.levels.clear();
        self.moved.clear();
        self.moved.resize(model.size().v, 0.0);
        let mut last = None;
        for _ in 0..MOST_ROUNDS {
            let found = self.take_in_what_is_inside(model, state, work)?;
            if self.ids.is_empty() || !found && self.is_settled(model, work)? {
                break;
            }
            work.locate(model, &self.q, &self.ids, &mut self.near)?;
            self.pose(model)?;
            let over = Over::Step { h: state.dt, weight: 0.5 };
            let Some(outcome) = self.stage.solve(model, work, responses, over)? else { break };
            self.trial.clear();
            self.trial.resize(model.size().v, 0.0);
            self.stage.respond(model, work, responses, &mut self.trial)?;
            if !(outcome.converged() && self.trial.iter().all(|d| d.is_finite())) {
                last = Some(outcome);
                break;
            }
            for (d, last) in self.trial.iter_mut().zip(&mut self.moved) {
                (*d, *last) = (*d - *last, *d);
            }
            model.move_along(q_start, &self.moved, 1.0, &mut self.q);
            self.pushed.clear();
            for (i, contact) in self.stage.contacts().iter().enumerate() {
                if self.stage.impulse(i).is_some_and(|nu| nu[0] > 0.0) {
                    self.pushed.push(contact.id);
                }
            }
            last = Some(outcome);
            work.detect(model, &self.q, 0.0)?;
        }
        Ok(last)
    }

    /// Adds the candidates with a gap below that at which they are kept; whether there were any.
    fn take_in_what_is_inside(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &mut Workspace<D>,
    ) -> Result<bool, Mismatch> {
        let before = self.ids.len();
        for k in 0..work.candidates.len() {
            let candidate = &work.candidates[k];
            // The rows are looked at only where they may matter.
            if candidate.gap >= -ROUNDING * reach(candidate)
                || model.law(candidate.law)?.impact.spring().is_some()
                || self.ids[..before].binary_search(&candidate.id).is_ok()
            {
                continue;
            }
            self.one.clear();
            if !self.one.add(model, &self.q, candidate, &self.warm, &self.memory)? {
                continue;
            }
            let rounding = rounding(&self.one, 0, candidate, &self.q, model);
            if candidate.gap >= -rounding {
                continue;
            }
            let (id, gap) = (candidate.id, candidate.gap);
            if !self.levels.iter().any(|(known, _)| *known == id) {
                work.locate(model, &state.q, &[id], &mut self.at_start)?;
                let level = self.at_start.first().map_or(gap, |candidate| candidate.gap);
                // Rounding is taken back, or it would add up.
                let level = if level < -2.0 * rounding { level } else { 0.0 };
                self.levels.push((id, level));
            }
            if gap < self.level(id) - rounding {
                self.ids.push(id);
            }
        }
        self.ids.sort_unstable();
        Ok(self.ids.len() > before)
    }

    /// The gap at which a contact is kept, m.
    fn level(&self, id: ContactId) -> f64 {
        self.levels.iter().find(|(known, _)| *known == id).map_or(0.0, |(_, level)| *level)
    }

    /// Whether no gap is below that at which it is kept, and none of a contact that was pushed above it; and whether the last
    /// round moved nothing any more: gaps settle before the directions in which they were closed.
    fn is_settled(&mut self, model: &Model<D>, work: &mut Workspace<D>) -> Result<bool, Mismatch> {
        work.locate(model, &self.q, &self.ids, &mut self.near)?;
        Ok(self.near.iter().all(|candidate| {
            let (gap, id) = (candidate.gap - self.level(candidate.id), candidate.id);
            let Ok(i) = self.stage.contacts().binary_search_by_key(&id, |contact| contact.id) else { return true };
            let rounding = rounding(&self.stage, i, candidate, &self.q, model);
            let moves = self.stage.speed(i, &self.trial) > rounding;
            !moves && gap >= -rounding && (gap <= rounding || self.pushed.binary_search(&id).is_err())
        }))
    }

    /// Poses the contacts with their gaps at `q`, as they are without ν.
    fn pose(&mut self, model: &Model<D>) -> Result<(), Mismatch> {
        self.stage.clear();
        for candidate in &self.near {
            if !self.stage.add(model, &self.q, candidate, &self.warm, &self.memory)? {
                continue;
            }
            let i = self.stage.len() - 1;
            let mut gap = -self.stage.velocity(i, &self.moved)?;
            gap[0] += candidate.gap - self.level(candidate.id);
            self.stage.set(i, Vector::zeros(), gap, Vector::zeros(), Rule::Frictionless)?;
        }
        Ok(())
    }
}

/// How far the points of a contact are from the origins of their bodies, m.
fn reach<const D: usize>(candidate: &Candidate<D>) -> f64 {
    candidate.sides.iter().map(|side| side.point.amax()).fold(0.0, f64::max)
}

/// What may be rounding of the gap of contact `i` of a stage, m.
fn rounding<const D: usize>(
    stage: &ContactStage<D>,
    i: usize,
    candidate: &Candidate<D>,
    q: &[f64],
    model: &Model<D>,
) -> f64 {
    // Coordinates that aren't as many as velocities are no lengths along these.
    let along = if q.len() == model.size().v { stage.speed(i, q) } else { 0.0 };
    ROUNDING * (reach(candidate) + along)
}
