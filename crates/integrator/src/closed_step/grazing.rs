//! Contacts that only a sunk body makes.

use super::ClosedStep;
use super::together::moving;
use crate::step_motion::StepMotion;
use crate::{Mismatch, Model, Workspace};
use teeter_detect::{Candidate, Candidates, ContactId};

/// Contacts are at one corner of a body where n·n′ is more than this: by the side that ends there, or by both.
const SAME_CORNER: f64 = 0.5;

/// Faces cross where |n·n′| is less than this.
const CROSSING: f64 = 0.95;

/// Bodies that share no more of a side than this times the depth to which one of them has sunk share it for that reason: the depth is that
/// of other corners.
const OF_DEPTH: f64 = 1.1;

impl<const D: usize, M: StepMotion<D>> ClosedStep<D, M> {
    /// Leaves out of the new contacts those that graze. A block that has sunk into its brick by δ would strike the end of the next flush one
    /// when it slides on, with no more of the two beside each other than δ.
    pub(super) fn leave_out_what_grazes(&mut self, model: &Model<D>, work: &mut Workspace<D>) -> Result<(), Mismatch> {
        self.find_depths(model, &work.candidates, |_| true);
        // Such a contact is at the end of a side; most are not, and those of blocks that lie on each other cross none.
        work.locate_past_ends(model, self.step.q_end(), &self.new, &mut self.found, &mut self.found_rooms)?;
        self.grazing.clear();
        for (contact, room) in self.found.iter().zip(&self.found_rooms) {
            let deepest = moving(model, contact).map(|body| self.depths[body]).fold(0.0, f64::max);
            if *room > OF_DEPTH * deepest {
                continue;
            }
            let depth = OF_DEPTH * depth_across(model, contact, &work.candidates);
            if depth > self.gap_tolerance && *room <= depth {
                self.grazing.push((contact.id, depth));
            }
        }
        let Some(margin) = self.grazing.iter().map(|(_, depth)| *depth).reduce(f64::max) else { return Ok(()) };
        // What ends in the surface stays the workspace's.
        std::mem::swap(&mut work.candidates, &mut self.found);
        let detected = work.detect(model, self.step.q_end(), margin);
        std::mem::swap(&mut work.candidates, &mut self.found);
        detected?;
        self.grazing.retain(|(id, depth)| shares_little(&self.found, *id, *depth));
        self.new.retain(|id| self.grazing.binary_search_by_key(id, |(grazing, _)| *grazing).is_err());
        Ok(())
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

/// How deep the bodies of a contact are in others, by faces that cross its own, m.
fn depth_across<const D: usize>(model: &Model<D>, contact: &Candidate<D>, candidates: &Candidates<D>) -> f64 {
    let touches = |other: &&Candidate<D>| moving(model, contact).any(|body| moving(model, other).any(|of| of == body));
    let crosses = |other: &&Candidate<D>| contact.frame.row(0).dot(&other.frame.row(0)).abs() < CROSSING;
    candidates.iter().filter(crosses).filter(touches).map(|other| -other.gap).fold(0.0, f64::max)
}

/// Whether the bodies of a contact touch from the same side at another point, too, that is no further away than `length`, m.
fn shares_little<const D: usize>(near: &Candidates<D>, id: ContactId, length: f64) -> bool {
    let Ok(at) = near.binary_search_by_key(&id, |candidate| candidate.id) else { return false };
    let contact = &near[at];
    let of_pair = |other: &&Candidate<D>| other.id.pair() == id.pair();
    let pair = near[..at].iter().rev().take_while(of_pair).chain(near[at + 1..].iter().take_while(of_pair));
    pair.filter(|other| other.sides.map(|side| side.body) == contact.sides.map(|side| side.body))
        .filter(|other| contact.frame.row(0).dot(&other.frame.row(0)) > SAME_CORNER)
        .any(|other| (contact.sides[0].point - other.sides[0].point).norm() <= length)
}
