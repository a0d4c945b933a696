//! Contacts that land together.

use super::{ClosedStep, leaves};
use crate::step_motion::StepMotion;
use crate::{Mismatch, Model, Workspace};
use teeter_detect::Candidate;

/// A contact is closed early by at most so many steps.
const STEPS: f64 = 10.0;

impl<const D: usize, M: StepMotion<D>> ClosedStep<D, M> {
    /// Closes the open contacts that would land together with those that have just been closed, if closed contacts of the same bodies had
    /// not sunk in.
    ///
    /// Points on one line under a base, such as the corners of flush parts or of the bricks below, land together. But where the base turns
    /// about a corner that has sunk in by δ, the points near to this corner land first, earlier by δ/|U_n|. If that is a step before the
    /// others, they take part of the blow, and the base loses too little energy.
    pub(super) fn close_what_lands_too(
        &mut self,
        model: &Model<D>,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        let longest = self.find_landings(model, h, work)?;
        if longest == 0.0 {
            return Ok(());
        }
        // Two bodies may approach each other.
        let reach = 2.0 * longest * self.fastest(model);
        work.detect(model, self.step.q_end(), reach)?;
        self.new.clear();
        for candidate in work.candidates.iter().filter(|candidate| candidate.gap > -self.gap_tolerance) {
            let time = moving(model, candidate).map(|body| self.landings[body]).fold(0.0, f64::max);
            if time == 0.0 || self.closed.binary_search(&candidate.id).is_ok() || !self.is_rigid(model, candidate) {
                continue;
            }
            self.row.clear();
            self.row.push(model, self.step.q_end(), candidate)?;
            if -self.row.velocity(0, self.step.v_end())[0] * time >= candidate.gap {
                self.new.push(candidate.id);
            }
        }
        self.closed.extend_from_slice(&self.new);
        self.closed.sort_unstable();
        Ok(())
    }

    /// Finds which parts are rigid, for which all this holds: a beam takes each blow by itself.
    pub(super) fn find_what_is_rigid(&mut self, model: &Model<D>) {
        let rest = vec![0.0; model.size().v];
        self.rigid.clear();
        self.rigid.extend(model.speeds(&rest).map(f64::is_finite));
    }

    /// A speed that no point of a rigid body exceeds at the end of the attempt, m/s. Ground that turns is left out: what stands on it moves
    /// with it.
    fn fastest(&self, model: &Model<D>) -> f64 {
        let speeds =
            model.speeds(self.step.v_end()).zip(&self.rigid).filter(|(speed, rigid)| **rigid && speed.is_finite());
        speeds.map(|(speed, _)| speed).fold(0.0, f64::max)
    }

    /// Whether both bodies of a contact are rigid.
    fn is_rigid(&self, model: &Model<D>, contact: &Candidate<D>) -> bool {
        let is_rigid = |(index, _, _): (usize, _, _)| self.rigid[index];
        contact.sides.iter().all(|side| model.owner(side.body).is_none_or(is_rigid))
    }

    /// Finds which of the contacts that have just been closed are less deep than contacts of the same bodies that were closed before, and
    /// within what time others would land together with them; returns the longest time, s, 0 if there are none.
    fn find_landings(&mut self, model: &Model<D>, h: f64, work: &Workspace<D>) -> Result<f64, Mismatch> {
        self.landings.clear();
        self.landings.resize(model.body_count(), 0.0);
        self.depths.clear();
        self.depths.resize(model.body_count(), 0.0);
        // What was closed before has been looked at.
        for sunk in work.candidates.iter().filter(|candidate| self.looked.binary_search(&candidate.id).is_ok()) {
            for body in moving(model, sunk) {
                self.depths[body] = self.depths[body].max(-sunk.gap);
            }
        }
        let mut longest = 0.0_f64;
        for candidate in &work.candidates {
            if self.new.binary_search(&candidate.id).is_err() || !self.is_rigid(model, candidate) {
                continue;
            }
            let depth = moving(model, candidate).map(|body| self.depths[body]).fold(-candidate.gap, f64::max);
            if depth == -candidate.gap {
                continue;
            }
            self.row.clear();
            self.row.push(model, self.step.q_end(), candidate)?;
            let rate = self.row.velocity(0, self.step.v_end())[0];
            let time = (candidate.gap + depth) / -rate;
            if leaves(-rate, || self.row.speed(0, self.step.v_end())) && time <= STEPS * h {
                for body in moving(model, candidate) {
                    self.landings[body] = self.landings[body].max(time);
                }
                longest = longest.max(time);
            }
        }
        Ok(longest)
    }
}

/// The numbers of the bodies of a contact that move, and not only as prescribed.
pub(crate) fn moving<const D: usize>(model: &Model<D>, contact: &Candidate<D>) -> impl Iterator<Item = usize> {
    let bodies = contact.sides.map(|side| side.body).into_iter();
    bodies.filter(|body| model.moves(*body)).map(|body| body.0 as usize)
}
