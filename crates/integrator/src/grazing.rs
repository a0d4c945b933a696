//! Contacts that are there only because a body has sunk into another one.

use crate::closed_step::{find, moving};
use crate::stage::RESERVED_CONTACTS;
use crate::{Mismatch, Model, Vector, Workspace};
use teeter_detect::{BodyId, Candidate, Candidates, ContactId};

/// Faces cross where |n·n′| is less than this.
const CROSSING: f64 = 0.95;

/// Two bodies that overlap by up to this times the depth to which one of them has sunk do so for that reason: the depth is measured at other
/// corners.
const OF_DEPTH: f64 = 1.1;

/// Tells contacts that graze from others: those at which the bodies overlap by no more, along the normal of another contact that one of them
/// has sunk into, than by how deep it has. A block that has sunk into its brick by δ would strike the end of the next flush one when it
/// slides on: that is no deeper beside it than δ.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grazing<const D: usize> {
    suspects: Vec<ContactId>,
    located: Candidates<D>,
    /// Of each of these, how far it is to the end of its surface, m.
    rooms: Vec<f64>,
}

impl<const D: usize> Grazing<D> {
    /// Makes room for so many contacts; of many, few are crossed by others.
    pub(crate) fn reserve(&mut self, contacts: usize) {
        let contacts = contacts.min(RESERVED_CONTACTS);
        self.suspects.reserve(contacts);
        self.located.reserve(contacts);
        self.rooms.reserve(contacts);
    }

    /// Leaves out of `ids` those that graze at `q`, where the workspace's candidates are; what is no deeper than a tolerance (m) has not sunk.
    pub(crate) fn leave_out(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        tolerance: f64,
        ids: &mut Vec<ContactId>,
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        // Blocks that lie on each other have no faces that cross, and then nothing is looked for.
        let Self { suspects, located, rooms } = self;
        suspects.clear();
        suspects.extend(ids.iter().copied().filter(|id| is_crossed(model, *id, &work.candidates, tolerance)));
        if suspects.is_empty() {
            return Ok(());
        }
        work.locate_past_ends(model, q, suspects, located, rooms)?;
        for (contact, room) in located.iter().zip(rooms) {
            if grazes(model, q, (contact, *room), &work.candidates, tolerance) {
                ids.retain(|id| *id != contact.id);
            }
        }
        Ok(())
    }

    /// Whether one of `candidates`, those at `q`, is deeper than a tolerance (m), and doesn't graze.
    pub(crate) fn is_inside(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        (id, tolerance): (ContactId, f64),
        candidates: &Candidates<D>,
        work: &mut Workspace<D>,
    ) -> Result<bool, Mismatch> {
        if find(candidates, id).is_none_or(|candidate| candidate.gap >= -tolerance) {
            return Ok(false);
        }
        if !is_crossed(model, id, candidates, tolerance) {
            return Ok(true);
        }
        work.locate_past_ends(model, q, &[id], &mut self.located, &mut self.rooms)?;
        let mut located = self.located.iter().zip(&self.rooms);
        Ok(!located.any(|(contact, room)| grazes(model, q, (contact, *room), candidates, tolerance)))
    }
}

/// Whether another contact is deep in its surface by a face that crosses that of this one.
fn is_crossed<const D: usize>(model: &Model<D>, id: ContactId, candidates: &Candidates<D>, tolerance: f64) -> bool {
    let contact = find(candidates, id);
    contact.is_some_and(|contact| candidates.iter().any(|other| crosses(model, contact, other, tolerance)))
}

/// Whether a contact that has so much room to the end of its surface (m) grazes.
fn grazes<const D: usize>(
    model: &Model<D>,
    q: &[f64],
    (contact, room): (&Candidate<D>, f64),
    candidates: &Candidates<D>,
    tolerance: f64,
) -> bool {
    let at = model.placed_at(q);
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
    let mut crossing = candidates.iter().filter(|other| crosses(model, contact, other, tolerance) && at_end(other));
    crossing.any(|other| is_parted(other, 0) || is_parted(other, 1))
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
