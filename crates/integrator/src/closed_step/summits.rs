//! Frames in the middle of the motion itself, where an elastic surface comes out under a base.

use super::{ClosedStep, SINKING};
use crate::step_motion::StepMotion;
use crate::{Contact, Mismatch, Model, State, Workspace};

/// Most rounds of a step. Where steps resolve the motion of a surface, two to four are enough.
const MOST_ROUNDS: usize = 8;

/// What the frames of a round change of a gap, in parts of what those of the round before did, has to be below this: over a surface that is
/// nearly flat a summit jumps about, and rounds lead nowhere.
const SHRINKS: f64 = 0.5;

/// Where frames in the middle of the first motion change a gap by more than so many times the gap tolerance, the surface moves too fast for a frame to
/// hold over the step: all are those of the motion without impulses.
const QUIET: f64 = 1e5;

/// How the frames of summits are found in one attempt.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounds {
    count: usize,
    /// What the last frames changed of a gap over the step, m.
    change: f64,
    given_up: bool,
}

impl Default for Rounds {
    fn default() -> Self {
        Self { count: 0, change: f64::INFINITY, given_up: false }
    }
}

impl<const D: usize, M: StepMotion<D>> ClosedStep<D, M> {
    /// Takes frames and gaps of all closed contacts from the motion that was tried, where the frame of a summit that presses differs there so
    /// much that its gap changes over the step by more than rounding; where such rounds lead nowhere, from the motion without impulses again,
    /// for the last time. Whether it took any: the step is then to be solved again.
    ///
    /// q̃_m is the middle of the motion without impulses. Where a load presses, a summit is elsewhere there, always to the same side, and as
    /// its frame turns with its place, each tremor of the surface lets the base sink in. That sets free energy, which keeps the tremor alive,
    /// and with it the sinking. With a frame in the middle of the motion itself, what the gap is off by has no sign, and what trembles dies down.
    pub(super) fn takes_frames_of_summits(
        &mut self,
        model: &Model<D>,
        from: &State,
        h: f64,
        rounds: &mut Rounds,
        work: &mut Workspace<D>,
    ) -> Result<bool, Mismatch> {
        if rounds.given_up || !self.rigid.contains(&false) {
            return Ok(false);
        }
        self.summits.clear();
        // Of a blow the step knows no better than that it comes.
        let goes_on = |contact: &&Contact<D>| contact.p[0] > 0.0 && (contact.persisting || contact.u_before[0] >= 0.0);
        let pressing = self.stage.contacts().iter().filter(goes_on).map(|contact| contact.id);
        self.summits.extend(pressing.filter(|id| model.detector().is_summit(*id)));
        let change = match self.summits.is_empty() {
            true if rounds.count == 0 => return Ok(false),
            true => None,
            false => self.change_of_frames(model, from, h, work)?,
        };
        match change {
            Some(change) if change <= SINKING * self.gap_tolerance => Ok(false),
            Some(change) if rounds.count == 0 && change > QUIET * self.gap_tolerance => Ok(false),
            // As good as rounding allows.
            Some(change) if change <= self.gap_tolerance && change > SHRINKS * rounds.change => Ok(false),
            Some(change) if change <= SHRINKS * rounds.change && rounds.count < MOST_ROUNDS => {
                (rounds.count, rounds.change) = (rounds.count + 1, change);
                std::mem::swap(&mut self.q_mid, &mut self.q_tried);
                model.move_along(&from.q, &self.mean, h, &mut self.q_ahead);
                self.locate_closed(model, work)?;
                self.stage.keep_islands_anew();
                Ok(true)
            }
            _ if rounds.count == 0 => Ok(false),
            _ => {
                rounds.given_up = true;
                self.looked.clear();
                self.look_ahead(model, from, h, work)?;
                self.stage.keep_islands_anew();
                Ok(true)
            }
        }
    }

    /// The most by which frames in the middle of the motion that was tried change the gap of a summit over the step, m; `None` where one is no
    /// summit there. Leaves that middle in `q_tried`.
    fn change_of_frames(
        &mut self,
        model: &Model<D>,
        from: &State,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<Option<f64>, Mismatch> {
        let Self { step, mean, q_tried, .. } = self;
        mean.iter_mut().zip(step.v_end()).zip(&from.v).for_each(|((mean, v1), v0)| *mean = 0.5 * (v1 + v0));
        model.move_along(&from.q, mean, 0.5 * h, q_tried);
        work.locate(model, q_tried, &self.summits, &mut self.found)?;
        if self.found.len() < self.summits.len() {
            return Ok(None);
        }
        let mut most = 0.0_f64;
        for contact in self.stage.contacts() {
            let Some(candidate) = super::find(&self.found, contact.id) else { continue };
            self.row.clear();
            self.row.push(model, &self.q_tried, candidate)?;
            let taken = 0.5 * (contact.u_before[0] + contact.u_after[0]);
            most = most.max(h * (self.row.velocity(0, &self.mean)[0] - taken).abs());
        }
        Ok(Some(most))
    }
}
