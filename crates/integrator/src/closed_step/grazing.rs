//! Contacts that only a sunk body makes.

use super::ClosedStep;
use super::together::moving;
use crate::step_motion::StepMotion;
use crate::{Mismatch, Model, Vector, Workspace};
use teeter_detect::{BodyId, Candidate, Candidates, ContactId};

/// Faces cross where |n·n′| is less than this.
const CROSSING: f64 = 0.95;

/// Up to this part of the depth to which a body has sunk, two bodies that overlap do so for that reason: the depth is that of other corners.
const OF_DEPTH: f64 = 1.1;

impl<const D: usize, M: StepMotion<D>> ClosedStep<D, M> {
    /// Leaves out of the new contacts those that graze. A block that has sunk into its brick by δ would strike the end of the next flush one
    /// when it slides on: that is no deeper beside it than δ.
    pub(super) fn leave_out_what_grazes(&mut self, model: &Model<D>, work: &mut Workspace<D>) -> Result<(), Mismatch> {
        self.find_depths(model, &work.candidates, |_| true);
        // Such a contact is at the end of a side, as few are; and blocks that lie on each other have no faces that cross.
        work.locate_past_ends(model, self.step.q_end(), &self.new, &mut self.found, &mut self.found_rooms)?;
        for (contact, room) in self.found.iter().zip(&self.found_rooms) {
            let deepest = moving(model, contact).map(|body| self.depths[body]).fold(0.0, f64::max);
            if *room * least_sine() <= OF_DEPTH * deepest && self.grazes(model, contact, *room, &work.candidates) {
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
        let crosses = |other: &&Candidate<D>| {
            let cosine = contact.frame.row(0).dot(&other.frame.row(0));
            cosine.abs() < CROSSING && room * (1.0 - cosine * cosine).sqrt() <= OF_DEPTH * -other.gap
        };
        candidates.iter().filter(|other| other.gap < -self.gap_tolerance).filter(crosses).any(|other| {
            (0..2).filter(|side| model.moves(bodies[*side])).any(|side| {
                let Some(out) = out_of(other, bodies[side]) else { return false };
                let direction = if side == 0 { out } else { -out };
                let beyond = model.detector().beyond(&at, contact.id, &direction);
                beyond.is_some_and(|beyond| beyond >= OF_DEPTH * other.gap)
            })
        })
    }

    /// Finds how deep each body is in others by those contacts that `count`, m.
    pub(super) fn find_depths(
        &mut self,
        model: &Model<D>,
        candidates: &Candidates<D>,
        count: impl Fn(ContactId) -> bool,
    ) {
        self.depths.clear();
        self.depths.resize(model.body_count(), 0.0);
        for sunk in candidates.iter().filter(|candidate| count(candidate.id)) {
            for body in moving(model, sunk) {
                self.depths[body] = self.depths[body].max(-sunk.gap);
            }
        }
    }
}

/// The least sine of the angle of faces that cross.
fn least_sine() -> f64 {
    (1.0 - CROSSING * CROSSING).sqrt()
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
