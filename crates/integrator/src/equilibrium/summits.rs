//! Where an elastic surface has come out under a base: its summits, humps in the words of a scene.

use super::between;
use crate::{Contact, Model, Vector};
use teeter_detect::{BodyId, Candidate, ContactId, Frame, Geometry};

/// A summit within this part of the base's length of an earlier one is that one. Of two that are nearer to each other than rounds tell them apart,
/// either could bear all, and the solver would look in vain for how much each does.
const SAME: f64 = 1e-6;

/// A summit that is found further inside its base than this part of the base's length is more than rounding.
const DEEP: f64 = 1e-12;

/// A summit that hasn't pressed for so many rounds is forgotten: it would be found again. Where hundreds were kept, most of them
/// a hair's breadth apart, the solver would take seconds.
const FORGOTTEN: u32 = 8;

/// A summit that was found in some round.
#[derive(Clone, Copy, Debug)]
struct Summit<const D: usize> {
    /// Where it was last, with an identity of its own.
    candidate: Candidate<D>,
    /// Its frame in the coordinates of the base.
    local_frame: Frame<D>,
    /// Its identity among the candidates of this round, if it is one of them.
    now: Option<ContactId>,
    /// For how many rounds it hasn't pressed.
    idle: u32,
    /// The identity of the first one of its base.
    first: ContactId,
}

impl<const D: usize> Summit<D> {
    fn found(model: &Model<D>, q: &[f64], candidate: &Candidate<D>, [id, first]: [ContactId; 2]) -> Self {
        let local_frame = candidate.frame * rotation(model, q, candidate.sides[0].body);
        Self { candidate: Candidate { id, ..*candidate }, local_frame, now: Some(candidate.id), idle: 0, first }
    }

    /// Takes its place at `q`: the same point of the surface, and what of the base is over it by now.
    fn follow(&mut self, model: &Model<D>, q: &[f64]) {
        let candidate = &mut self.candidate;
        candidate.frame = self.local_frame * rotation(model, q, candidate.sides[0].body).transpose();
        let mut apart: Vector<D> = candidate.frame * between(model, q, &candidate.sides);
        candidate.gap = apart[0];
        apart[0] = 0.0;
        candidate.sides[0].point -= self.local_frame.transpose() * apart;
    }
}

/// The rotation of a body, from its coordinates to the world's.
fn rotation<const D: usize>(model: &Model<D>, q: &[f64], body: BodyId) -> Frame<D> {
    let placed = model.placed_at(q);
    let place = |point: Vector<D>| {
        let mut place = [Vector::zeros()];
        placed.place(body, &[point], &mut place);
        place[0]
    };
    let origin = place(Vector::zeros());
    Frame::<D>::from_fn(|row, column| {
        let axis = Vector::from_fn(|k, _| f64::from(k == column));
        (place(axis) - origin)[row]
    })
}

/// All summits that were found so far.
///
/// A surface that is held down where it came out comes out elsewhere: the summits of one round say nothing of those of the round before, and
/// each round would let go of what that one held. So they are kept, at their places, as long as they press, and the contacts hold at all of them (the
/// exchange method of semi-infinite programming).
#[derive(Debug, Default)]
pub(super) struct Summits<const D: usize> {
    known: Vec<Summit<D>>,
    /// The first one of each base: its pair, its body, its identity.
    firsts: Vec<(u32, BodyId, ContactId)>,
    /// How many were ever found, and how many of these deep inside their base.
    count: u32,
    deep: u32,
}

impl<const D: usize> Summits<D> {
    /// How many were found deep inside their base so far: where the number grows, what bears isn't held yet.
    pub(super) fn deep(&self) -> u32 {
        self.deep
    }

    /// Forgets those that haven't pressed for long, by the contacts of a round.
    pub(super) fn forget(&mut self, contacts: &[Contact<D>]) {
        self.known.retain_mut(|summit| {
            let presses = contacts.iter().any(|contact| contact.id == summit.candidate.id && contact.p[0] > 0.0);
            summit.idle = if presses { 0 } else { summit.idle + 1 };
            summit.idle < FORGOTTEN
        });
    }

    /// Takes the summits out of the candidates at `q`, and puts all that are known in their place, up to a gap of `margin` (m).
    pub(super) fn exchange(&mut self, model: &Model<D>, q: &[f64], margin: f64, candidates: &mut Vec<Candidate<D>>) {
        let is_summit = |candidate: &Candidate<D>| model.detector().is_summit(candidate.id);
        self.known.iter_mut().for_each(|summit| summit.now = None);
        for candidate in candidates.iter().filter(|candidate| is_summit(candidate)) {
            let apart = |other: &Candidate<D>| (other.sides[0].point - candidate.sides[0].point).norm();
            // Corners are of another pair.
            let of_base = |other: &&Candidate<D>| other.sides[0].body == candidate.sides[0].body;
            let beside = candidates.iter().filter(of_base).map(apart).fold(0.0, f64::max);
            // Its corners may be further away than candidates are looked for.
            let length = if beside > 0.0 { beside } else { candidate.sides[0].point.norm() };
            let is_same = |summit: &&mut Summit<D>| {
                let known = &summit.candidate;
                let of_pair = known.id.pair() == candidate.id.pair() && of_base(&known);
                of_pair && summit.now.is_none() && apart(known) <= SAME * length
            };
            if let Some(summit) = self.known.iter_mut().find(is_same) {
                *summit = Summit::found(model, q, candidate, [summit.candidate.id, summit.first]);
            } else {
                let id = ContactId::new(candidate.id.pair(), u32::MAX - self.count);
                self.count += 1;
                self.deep += u32::from(candidate.gap < -DEEP * length);
                let (pair, body) = (candidate.id.pair(), candidate.sides[0].body);
                let known = self.firsts.iter().find(|(of, base, _)| (*of, *base) == (pair, body));
                let first = known.map_or(id, |(_, _, first)| *first);
                if first == id {
                    self.firsts.push((pair, body, id));
                }
                self.known.push(Summit::found(model, q, candidate, [id, first]));
            }
        }
        candidates.retain(|candidate| !is_summit(candidate));
        for summit in &mut self.known {
            if summit.now.is_none() {
                summit.follow(model, q);
            }
            if summit.candidate.gap <= margin {
                candidates.push(summit.candidate);
            }
        }
        candidates.sort_unstable_by_key(|candidate| candidate.id);
    }

    /// The first summit that was found of the same base as this one; `None` for another contact. Slip counts from where that one was: all are one
    /// place of a rigid base, and were each to hold it where it was when it was found, they would pull against each other.
    pub(super) fn first(&self, id: ContactId) -> Option<ContactId> {
        self.known.iter().find(|summit| summit.candidate.id == id).map(|summit| summit.first)
    }

    /// The identity of a contact among the detector's candidates: of a summit that isn't one of them now, that of the nearest one of its base. Those
    /// that bear come to lie on both sides of it, as near as rounds have brought them. `None` where the base has none.
    pub(super) fn identity(&self, id: ContactId) -> Option<ContactId> {
        let Some(bears) = self.known.iter().find(|summit| summit.candidate.id == id) else { return Some(id) };
        let sides = |summit: &Summit<D>| (summit.candidate.id.pair(), summit.candidate.sides[0].body);
        let apart = |summit: &&Summit<D>| (summit.candidate.sides[0].point - bears.candidate.sides[0].point).norm();
        let there = self.known.iter().filter(|summit| summit.now.is_some() && sides(summit) == sides(bears));
        there.min_by(|a, b| apart(a).total_cmp(&apart(b)))?.now
    }
}
