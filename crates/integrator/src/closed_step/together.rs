//! Contacts that land together.

use super::{ClosedStep, leaves};
use crate::step_motion::StepMotion;
use crate::{Mismatch, Model, Part, Vector, Workspace};
use teeter_detect::{BodyId, Candidate};

/// Drift is made up for by so many steps at most.
const STEPS: f64 = 10.0;

/// A contact that closes, of two bodies, and what else of them would land within a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landing {
    bodies: [BodyId; 2],
    /// s.
    time: f64,
}

impl<const D: usize, M: StepMotion<D>> ClosedStep<D, M> {
    /// Closes the open contacts that would land together with those that have just been closed, had closed contacts of the same bodies not
    /// sunk in.
    ///
    /// Points on one line under a base, such as the corners of flush parts or of the bricks below, land together. Where the base turns
    /// about a corner that has sunk in by δ, the points near to this seem to land first, by the time δ/|U_n|; a step before the others, they
    /// would take part of the blow, and the base would lose too little energy.
    pub(super) fn close_what_lands_too(
        &mut self,
        model: &Model<D>,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        let Some(longest) = self.find_landings(model, h, work)? else { return Ok(()) };
        // Two bodies may approach each other.
        let reach = 2.0 * longest * self.fastest(model);
        work.detect(model, self.step.q_end(), reach)?;
        self.new.clear();
        for candidate in work.candidates.iter().filter(|candidate| candidate.gap > -self.gap_tolerance) {
            let shares = |landing: &&Landing| share(model, &landing.bodies, candidate);
            let time = self.landings.iter().filter(shares).map(|landing| landing.time).fold(0.0, f64::max);
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
        let knows = |part: &Part<D>| part.system.fastest(&rest[part.v.clone()]).is_finite();
        self.rigid.clear();
        self.rigid.extend(model.parts().iter().map(knows));
    }

    /// A speed that no point of a rigid body exceeds at the end of the attempt, m/s, but for ground that turns: what stands on that moves with it.
    fn fastest(&self, model: &Model<D>) -> f64 {
        let rigid = model.parts().iter().zip(&self.rigid).filter(|(_, rigid)| **rigid);
        let speeds = rigid.map(|(part, _)| part.system.fastest(&self.step.v_end()[part.v.clone()]));
        speeds.filter(|speed| speed.is_finite()).fold(0.0, f64::max)
    }

    /// Whether both bodies of a contact are rigid.
    fn is_rigid(&self, model: &Model<D>, contact: &Candidate<D>) -> bool {
        let is_rigid = |(index, _, _): (usize, _, _)| self.rigid[index];
        contact.sides.iter().all(|side| model.owner(side.body).is_none_or(is_rigid))
    }

    /// Lists the contacts that have just been closed and are less deep than closed ones of the same bodies; returns the longest time, s.
    fn find_landings(&mut self, model: &Model<D>, h: f64, work: &Workspace<D>) -> Result<Option<f64>, Mismatch> {
        self.landings.clear();
        let mut longest = None;
        for candidate in &work.candidates {
            if self.new.binary_search(&candidate.id).is_err() || !self.is_rigid(model, candidate) {
                continue;
            }
            let bodies = candidate.sides.map(|side| side.body);
            // What was closed before has been looked at.
            let sunk = work.candidates.iter().filter(|other| self.looked.binary_search(&other.id).is_ok());
            let deeper = sunk.filter(|other| other.gap < candidate.gap && share(model, &bodies, other));
            let deepest = deeper.map(|other| other.gap).fold(candidate.gap, f64::min);
            if deepest == candidate.gap {
                continue;
            }
            self.row.clear();
            self.row.push(model, self.step.q_end(), candidate)?;
            let rate: Vector<D> = self.row.velocity(0, self.step.v_end());
            let time = (candidate.gap - deepest) / -rate[0];
            if leaves(-rate[0], || self.row.speed(0, self.step.v_end())) && time <= STEPS * h {
                self.landings.push(Landing { bodies, time });
                longest = Some(time.max(longest.unwrap_or(0.0)));
            }
        }
        Ok(longest)
    }
}

/// Whether a contact is of one of these bodies, and that moves.
fn share<const D: usize>(model: &Model<D>, bodies: &[BodyId; 2], contact: &Candidate<D>) -> bool {
    contact.sides.iter().any(|side| bodies.contains(&side.body) && model.moves(side.body))
}
