//! Frames in the middle of the motion itself, where an elastic surface comes out under a base.

use super::{ClosedStep, SINKING};
use crate::step_motion::StepMotion;
use crate::{Contact, Mismatch, Model, State, Workspace};

/// Most rounds of a step; usually two to six are enough.
const MOST_ROUNDS: usize = 20;

/// The frames of each round must change a gap by less than this part of what those of the round before did; otherwise rounds lead nowhere.
const SHRINKS: f64 = 0.5;

/// So many rounds are exempt from that: the relaxation is learned from two, and takes effect in the third.
const LEARNING: usize = 3;

/// A relaxation beyond this comes from two rounds that agree to rounding.
const MOST_RELAXATION: f64 = 8.0;

/// How the frames of summits are found in one attempt.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounds {
    count: usize,
    /// What the last frames changed of a gap over the step, m.
    change: f64,
    /// How far the next guess goes towards the motion that was found, as a part.
    relaxation: f64,
}

impl Default for Rounds {
    fn default() -> Self {
        Self { count: 0, change: f64::INFINITY, relaxation: 1.0 }
    }
}

impl<const D: usize, M: StepMotion<D>> ClosedStep<D, M> {
    /// Whether the first frames of a step are those of a motion with the velocities of its start: where a summit is closed. Without impulses a base may
    /// sink in so far beside it that it isn't one any more.
    pub(super) fn follows_summits(&self, model: &Model<D>) -> bool {
        let mut closed = self.closed.iter();
        !self.summits_lost && self.rigid.contains(&false) && closed.any(|id| model.detector().is_summit(*id))
    }

    pub(super) fn move_to_guess(&mut self, model: &Model<D>, from: &State, h: f64) {
        model.move_along(&from.q, &self.guessed, h, &mut self.q_ahead);
        model.move_along(&from.q, &self.guessed, 0.5 * h, &mut self.q_mid);
    }

    /// Takes frames and gaps of all closed contacts from a motion nearer to the one that was found, where the frame of a summit that presses
    /// differs there so much that its gap changes over the step by more than rounding; where such rounds lead nowhere, from the motion without
    /// impulses, for the last time. Whether it took any: the step is then to be solved again.
    ///
    /// Were all those of the motion without impulses: where a load presses, a summit is elsewhere there, always to the same side, and as
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
        if !self.follows_summits(model) {
            return Ok(false);
        }
        self.summits.clear();
        // One that is struck in this step is left out.
        let goes_on = |contact: &&Contact<D>| contact.p[0] > 0.0 && (contact.persisting || contact.u_before[0] >= 0.0);
        let pressing = self.stage.contacts().iter().filter(goes_on).map(|contact| contact.id);
        self.summits.extend(pressing.filter(|id| model.detector().is_summit(*id)));
        let change = if self.summits.is_empty() { None } else { self.change_of_frames(model, from, h, work)? };
        let goes_on = match change {
            // The first frames are a guess, and what each step left of its error would accumulate.
            Some(0.0) => return Ok(false),
            Some(change) if rounds.count > 0 && change <= SINKING * self.gap_tolerance => return Ok(false),
            // As good as rounding allows.
            Some(change) if change <= self.gap_tolerance && change > SHRINKS * rounds.change => return Ok(false),
            Some(change) if rounds.count < LEARNING || change <= SHRINKS * rounds.change => {
                rounds.change = change;
                rounds.count < MOST_ROUNDS
            }
            _ => false,
        };
        if goes_on && self.guess_anew(rounds) {
            self.move_to_guess(model, from, h);
            self.locate_closed(model, work)?;
        } else {
            self.summits_lost = true;
            self.looked.clear();
            self.look_ahead(model, from, h, work)?;
        }
        self.stage.keep_islands_anew();
        Ok(true)
    }

    /// Makes the next guess, relaxed as by Irons and Tuck (1969, doi 10.1002/nme.1620010306), with the sum of squares over all
    /// velocities; whether there is one. Over a surface that is nearly flat a summit moves by far more than what made it move:
    /// taken as it was found, each guess would be further off than the one before, to the other side.
    fn guess_anew(&mut self, rounds: &mut Rounds) -> bool {
        let Self { mean, guessed, residual, .. } = self;
        if rounds.count > 0 {
            let (mut along, mut square) = (0.0, 0.0);
            for ((mean, guessed), before) in mean.iter().zip(&*guessed).zip(&*residual) {
                let change = mean - guessed - before;
                along += before * change;
                square += change * change;
            }
            if square > 0.0 {
                rounds.relaxation *= -along / square;
            }
        }
        // Written so that NaN fails too.
        if !(rounds.relaxation.abs() <= MOST_RELAXATION) {
            return false;
        }
        rounds.count += 1;
        for ((mean, guessed), residual) in mean.iter().zip(guessed).zip(residual) {
            *residual = mean - *guessed;
            *guessed += rounds.relaxation * *residual;
        }
        true
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
