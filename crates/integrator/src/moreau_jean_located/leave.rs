//! When a contact that presses comes to the end of its surface within a step.

use super::MoreauJeanLocated;
use super::locate::is_time;
use crate::{Mismatch, Model, State, StepError, StepSpan, Workspace};
use teeter_contact::Outcome;

/// Attempts up to where a surface ends: two or three do, as each falls short by what its forces differ from those of the one before.
const ATTEMPTS: usize = 10;

/// Times are located to this part of the step.
const AT_ONCE: f64 = 1e-12;

/// Halvings of a time, from a step to rounding.
const HALVINGS: usize = 60;

impl<const D: usize> MoreauJeanLocated<D> {
    /// Looks for contacts that pressed in the part of a step that was attempted, with this outcome, and are past the end of their surface
    /// after it, as the corner of a block that glides off another one's side. Where there are any, attempts the part up to just past the
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
        if self.leaving.is_empty() {
            return Ok((outcome, None));
        }
        let (mut attempted, mut outcome_of_it) = (part.h, outcome);
        for _ in 0..ATTEMPTS {
            let past = self.leaving.len();
            // One that falls short is taken further.
            let between = if past > 0 { [0.0, attempted] } else { [attempted, part.h] };
            let tau = self.passes_end(model, from, attempted, between, work)?;
            if past > 0 && attempted - tau <= AT_ONCE * part.h {
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
        }
        let outcome = self.attempt_up_to(model, from, part, part.h, work)?;
        self.find_what_leaves(model, part.h, work)?;
        Ok((outcome, None))
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

    /// When the first of `ids` is past its end, s, between these times, along the motion of an attempt that lasted so long.
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
            let all_over = self.rooms.iter().all(|room| *room >= 0.0);
            *(if all_over { &mut inside } else { &mut past }) = tau;
            if past - inside <= f64::EPSILON * past {
                break;
            }
        }
        Ok(past)
    }
}
