//! Contacts that are there only because a body has sunk into another one.

use super::together::moving;
use super::{ClosedStep, find};
use crate::step_motion::StepMotion;
use crate::{Mismatch, Model, Vector, Workspace};
use teeter_detect::{BodyId, Candidate, Candidates, ContactId};

/// Faces cross where |n·n′| is less than this.
const CROSSING: f64 = 0.95;

/// Two bodies that overlap by up to this times the depth to which one of them has sunk do so for that reason: the depth is measured at other
/// corners.
const OF_DEPTH: f64 = 1.1;

impl<const D: usize, M: StepMotion<D>> ClosedStep<D, M> {
    /// Leaves out of the new contacts those that graze. A block that has sunk into its brick by δ would strike the end of the next flush one
    /// when it slides on: that is no deeper beside it than δ.
    pub(super) fn leave_out_what_grazes(&mut self, model: &Model<D>, work: &mut Workspace<D>) -> Result<(), Mismatch> {
        // Blocks that lie on each other have no faces that cross, and then nothing is looked for.
        let tolerance = self.gap_tolerance;
        let crossed = |id: &ContactId| {
            let contact = find(&work.candidates, *id);
            contact.is_some_and(|contact| work.candidates.iter().any(|other| crosses(model, contact, other, tolerance)))
        };
        self.suspects.clear();
        self.suspects.extend(self.new.iter().copied().filter(crossed));
        if self.suspects.is_empty() {
            return Ok(());
        }
        work.locate_past_ends(model, self.step.q_end(), &self.suspects, &mut self.found, &mut self.found_rooms)?;
        for (contact, room) in self.found.iter().zip(&self.found_rooms) {
            if self.grazes(model, contact, *room, &work.candidates) {
                self.new.retain(|id| *id != contact.id);
            }
        }
        Ok(())
    }

    /// Whether the bodies of a contact overlap by no more, along the normal of another one that one of them has sunk into, than by how deep
    /// it has.
    fn grazes(&self, model: &Model<D>, contact: &Candidate<D>, room: f64, candidates: &Candidates<D>) -> bool {
        let at = model.placed_at(self.step.q_end());
        let bodies = contact.sides.map(|side| side.body);
        // Within the surface of the other one is no more of a side than its depth over the sine of their angle.
        let at_end = |other: &Candidate<D>| {
            let cosine = cosine(contact, other);
            room * (1.0 - cosine * cosine).sqrt() <= OF_DEPTH * -other.gap
        };
        let is_parted = |other: &Candidate<D>, side: usize| {
            let out = out_of(other, bodies[side]).filter(|_| model.moves(bodies[side]));
            let beyond = out.and_then(|out| {
                let direction = if side == 0 { out } else { -out };
                model.detector().beyond(&at, contact.id, &direction)
            });
            beyond.is_some_and(|beyond| beyond >= OF_DEPTH * other.gap)
        };
        let mut crossing =
            candidates.iter().filter(|other| crosses(model, contact, other, self.gap_tolerance) && at_end(other));
        crossing.any(|other| is_parted(other, 0) || is_parted(other, 1))
    }
}

/// Whether another contact is deeper in its surface than a tolerance (m), by a face that crosses that of the first, and both are of a body
/// that moves.
fn crosses<const D: usize>(model: &Model<D>, contact: &Candidate<D>, other: &Candidate<D>, tolerance: f64) -> bool {
    other.gap < -tolerance
        && cosine(contact, other).abs() < CROSSING
        && moving(model, contact).any(|body| moving(model, other).any(|of| of == body))
}

/// The cosine of the angle between the normals of two contacts.
fn cosine<const D: usize>(a: &Candidate<D>, b: &Candidate<D>) -> f64 {
    a.frame.row(0).dot(&b.frame.row(0))
}

/// The normal of a contact that points into one of its bodies, away from the other; `None` where it isn't of that body.
fn out_of<const D: usize>(contact: &Candidate<D>, body: BodyId) -> Option<Vector<D>> {
    let normal: Vector<D> = contact.frame.row(0).transpose();
    match contact.sides.map(|side| side.body == body) {
        [true, _] => Some(normal),
        [_, true] => Some(-normal),
        _ => None,
    }
}
