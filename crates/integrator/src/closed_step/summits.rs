//! Frames in the middle of the motion itself, where an elastic surface comes out under a base.

use super::ClosedStep;
use crate::step_motion::StepMotion;
use crate::{Contact, Mismatch, Model, State, Workspace};

/// Rounds of a step after which its frames are taken as they are. Where steps resolve the motion of a surface, one to three are enough.
pub(super) const MOST_ROUNDS: usize = 8;

impl<const D: usize, M: StepMotion<D>> ClosedStep<D, M> {
    /// Whether a summit that presses has another frame in the middle of the motion that was tried, so that its gap changes over the step by
    /// more than the gap tolerance. If so, frames and gaps of all closed contacts are those of that motion now, and the step is to be solved
    /// again.
    ///
    /// q̃_m is the middle of the motion without impulses. Where a load presses, a summit is elsewhere there, always to the same side, and as
    /// its frame turns with its place, each tremor of the surface lets the base sink in. That sets free energy, which keeps the tremor alive,
    /// and with it the sinking. With a frame in the middle of the motion itself, what the gap is off by has no sign, and what trembles dies down.
    pub(super) fn summits_have_moved(
        &mut self,
        model: &Model<D>,
        from: &State,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<bool, Mismatch> {
        if !self.rigid.contains(&false) {
            return Ok(false);
        }
        self.summits.clear();
        // Of a blow the step knows no better than that it comes.
        let goes_on = |contact: &&Contact<D>| contact.p[0] > 0.0 && (contact.persisting || contact.u_before[0] >= 0.0);
        let pressing = self.stage.contacts().iter().filter(goes_on).map(|contact| contact.id);
        self.summits.extend(pressing.filter(|id| model.detector().is_summit(*id)));
        if self.summits.is_empty() {
            return Ok(false);
        }
        let Self { step, mean, q_turned, .. } = self;
        mean.iter_mut().zip(step.v_end()).zip(&from.v).for_each(|((mean, v1), v0)| *mean = 0.5 * (v1 + v0));
        model.move_along(&from.q, mean, 0.5 * h, q_turned);
        work.locate(model, q_turned, &self.summits, &mut self.found)?;
        // One that is none there would be lost.
        if self.found.len() < self.summits.len() || !self.any_has_another_frame(model, h)? {
            return Ok(false);
        }
        std::mem::swap(&mut self.q_mid, &mut self.q_turned);
        work.locate_past_ends(model, &self.q_mid, &self.closed, &mut self.middle, &mut self.rooms[0])?;
        model.move_along(&from.q, &self.mean, h, &mut self.q_ahead);
        work.locate_past_ends(model, &self.q_ahead, &self.closed, &mut self.ahead, &mut self.rooms[1])?;
        self.stage.keep_islands_anew();
        Ok(true)
    }

    /// Whether the frame of any contact that was found differs by so much from that which the step took.
    fn any_has_another_frame(&mut self, model: &Model<D>, h: f64) -> Result<bool, Mismatch> {
        for contact in self.stage.contacts() {
            let Some(candidate) = super::find(&self.found, contact.id) else { continue };
            self.row.clear();
            self.row.push(model, &self.q_turned, candidate)?;
            let taken = 0.5 * (contact.u_before[0] + contact.u_after[0]);
            if h * (self.row.velocity(0, &self.mean)[0] - taken).abs() > self.gap_tolerance {
                return Ok(true);
            }
        }
        Ok(false)
    }
}
