//! When a contact that presses comes to the end of its surface within a step, or to where its curvature jumps.

use super::MoreauJeanLocated;
use super::locate::is_time;
use crate::{Mismatch, Model, State, StepError, StepSpan, Workspace};
use teeter_contact::Outcome;
use teeter_detect::ContactId;

/// Attempts up to where a surface ends: two or three do, as each falls short by what its forces differ from those of the one before.
const ATTEMPTS: usize = 10;

/// Times are located to this part of the step.
const AT_ONCE: f64 = 1e-12;

/// After this many attempts a time is located well enough to this larger part of the step. Frames are taken where the motion without
/// impulses goes, which may be past the end; attempts then end before it and past it in turn, closer than this to each other.
const STRICT_ATTEMPTS: usize = 5;
const NEARLY_AT_ONCE: f64 = 1e-6;

/// Halvings of a time, from a step to rounding.
const HALVINGS: usize = 60;

impl<const D: usize> MoreauJeanLocated<D> {
    /// Looks for contacts that pressed in the part of a step that was attempted, with this outcome, and are past the end of their surface
    /// after it, as the corner of a block that glides off another one's side, or that were closed before it and are on another piece, as a
    /// disc that rolls from a side over its corner: the force changes there at once. Where there are any, attempts the part up to just past the
    /// end that is reached first, and returns the outcome of that and its length, s. What touches there instead has another normal, so
    /// that it may strike; or nothing does.
    pub(super) fn find_end(
        &mut self,
        model: &Model<D>,
        from: &State,
        part: &StepSpan,
        outcome: Option<Outcome>,
        work: &mut Workspace<D>,
    ) -> Result<(Option<Outcome>, Option<f64>), StepError> {
        self.find_what_leaves(model, part.h, work)?;
        self.find_pieces(model, from);
        let mut is_past = !self.leaving.is_empty() || self.changes_piece(model);
        if !is_past {
            return Ok((outcome, None));
        }
        let (mut attempted, mut outcome_of_it) = (part.h, outcome);
        for attempt in 0..ATTEMPTS {
            let at_once = if attempt < STRICT_ATTEMPTS { AT_ONCE } else { NEARLY_AT_ONCE };
            // One that falls short is taken further.
            let between = if is_past { [0.0, attempted] } else { [attempted, part.h] };
            let tau = self.passes_end(model, from, attempted, between, work)?;
            if is_past && attempted - tau <= at_once * part.h {
                // What leaves at the very end does so between two parts.
                return Ok((outcome_of_it, (attempted < part.h).then_some(attempted)));
            }
            if !is_time(tau, part.start) {
                break;
            }
            outcome_of_it = self.attempt_up_to(model, from, part, tau, work)?;
            if outcome_of_it.is_some_and(|outcome| !outcome.converged()) {
                break;
            }
            attempted = tau;
            self.keep_those_past(model, work)?;
            is_past = !self.leaving.is_empty() || self.changes_piece(model);
        }
        let outcome = self.attempt_up_to(model, from, part, part.h, work)?;
        self.find_what_leaves(model, part.h, work)?;
        Ok((outcome, None))
    }

    /// Finds on which pieces of their surfaces the contacts are at the start of the attempt that were closed before it. Those without an
    /// impulse, too: where the piece changes in the first half, the frame in the middle is that of the other piece, and along its normal a
    /// disc that flies on from an edge has parted all through the attempt.
    fn find_pieces(&mut self, model: &Model<D>, from: &State) {
        let Self { step, persisting, pieces, .. } = self;
        persisting.clear();
        let contacts = step.stage.contacts().iter();
        persisting.extend(contacts.filter(|contact| contact.persisting).map(|contact| contact.id));
        pieces[0].clear();
        if !persisting.is_empty() {
            model.detector().pieces(&model.placed_at(&from.q), persisting, &mut pieces[0]);
        }
    }

    /// Whether one of these is on another piece at the end of the attempt.
    fn changes_piece(&mut self, model: &Model<D>) -> bool {
        let Self { step, persisting, pieces: [first, now], .. } = self;
        is_elsewhere(model, &step.step.q_at, persisting, first, now)
    }

    /// Finds the contacts that press and are past the end of their surface at the end of the attempt, which lasted `h` (s).
    pub(super) fn find_what_leaves(
        &mut self,
        model: &Model<D>,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        let Self { ids, step, .. } = self;
        ids.clear();
        let contacts = step.stage.contacts().iter().enumerate();
        let pressing = contacts.filter(|(i, contact)| contact.p[0] > 0.0 && step.may_leave(*i, h));
        ids.extend(pressing.map(|(_, contact)| contact.id));
        ids.sort_unstable();
        self.keep_those_past(model, work)
    }

    /// Finds those of `ids` that are past the end of their surface at the end of the attempt.
    fn keep_those_past(&mut self, model: &Model<D>, work: &mut Workspace<D>) -> Result<(), Mismatch> {
        let Self { ids, near, rooms, leaving, step, .. } = self;
        leaving.clear();
        if ids.is_empty() {
            return Ok(());
        }
        work.locate_past_ends(model, &step.step.q_at, ids, near, rooms)?;
        leaving.extend(near.iter().zip(rooms).filter(|(_, room)| **room < 0.0).map(|(candidate, _)| candidate.id));
        Ok(())
    }

    /// When the first of `ids` is past its end, or one that was closed is on another piece, s, between these times, along
    /// the motion of an attempt that lasted so long.
    fn passes_end(
        &mut self,
        model: &Model<D>,
        from: &State,
        lasted: f64,
        [mut inside, mut past]: [f64; 2],
        work: &mut Workspace<D>,
    ) -> Result<f64, Mismatch> {
        for _ in 0..HALVINGS {
            let tau = 0.5 * (inside + past);
            self.place_at(model, from, lasted, tau);
            work.locate_past_ends(model, &self.place, &self.ids, &mut self.near, &mut self.rooms)?;
            let Self { place, persisting, pieces: [first, now], .. } = self;
            let all_over =
                self.rooms.iter().all(|room| *room >= 0.0) && !is_elsewhere(model, place, persisting, first, now);
            *(if all_over { &mut inside } else { &mut past }) = tau;
            if past - inside <= f64::EPSILON * past {
                break;
            }
        }
        Ok(past)
    }
}

/// Whether one of the contacts is on another piece of its surface at `q` than `first`; `now` is memory.
fn is_elsewhere<const D: usize>(
    model: &Model<D>,
    q: &[f64],
    contacts: &[ContactId],
    first: &[u32],
    now: &mut Vec<u32>,
) -> bool {
    if first.is_empty() {
        return false;
    }
    model.detector().pieces(&model.placed_at(q), contacts, now);
    first != now.as_slice()
}
