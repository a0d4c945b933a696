//! Where an elastic surface has come out under a base.

use super::between;
use crate::{Model, Vector};
use teeter_detect::{Anchor, Candidate, ContactId, Frame, Geometry};

/// A summit within this part of the base's reach of an earlier one is that one.
const SAME: f64 = 1e-3;

/// A summit that was found in some round.
#[derive(Clone, Copy, Debug)]
struct Summit<const D: usize> {
    /// Where it was last, with an identity of its own.
    candidate: Candidate<D>,
    /// Its frame in the coordinates of the base.
    on_base: Frame<D>,
    /// Its identity among the candidates of this round, if it is one of them.
    now: Option<ContactId>,
}

impl<const D: usize> Summit<D> {
    fn found(model: &Model<D>, q: &[f64], candidate: &Candidate<D>, id: ContactId) -> Self {
        let on_base = candidate.frame * turn(model, q, &candidate.sides[0]);
        Self { candidate: Candidate { id, ..*candidate }, on_base, now: Some(candidate.id) }
    }

    /// Takes its place at `q`: the same point of the surface, and what of the base is over it by now.
    fn follow(&mut self, model: &Model<D>, q: &[f64]) {
        let candidate = &mut self.candidate;
        candidate.frame = self.on_base * turn(model, q, &candidate.sides[0]).transpose();
        let mut apart: Vector<D> = candidate.frame * between(model, q, &candidate.sides);
        candidate.gap = apart[0];
        apart[0] = 0.0;
        candidate.sides[0].point -= self.on_base.transpose() * apart;
    }
}

/// The rotation of a body, from its coordinates to the world's.
fn turn<const D: usize>(model: &Model<D>, q: &[f64], at: &Anchor<D>) -> Frame<D> {
    let placed = model.placed_at(q);
    let place = |point: Vector<D>| {
        let mut place = [Vector::zeros()];
        placed.place(at.body, &[point], &mut place);
        place[0]
    };
    let origin = place(Vector::zeros());
    let mut turn = Frame::<D>::zeros();
    for k in 0..D {
        let mut axis = Vector::<D>::zeros();
        axis[k] = 1.0;
        turn.set_column(k, &(place(axis) - origin));
    }
    turn
}

/// All summits that were found so far.
///
/// A surface that is held down where it came out comes out elsewhere: the summits of one round say nothing of those of the round before, and
/// each round would let go of what that one held. So all are kept, at their places, and the contacts hold at all of them (the exchange
/// method of semi-infinite programming).
#[derive(Debug, Default)]
pub(super) struct Summits<const D: usize> {
    known: Vec<Summit<D>>,
}

impl<const D: usize> Summits<D> {
    /// Takes the summits out of the candidates at `q`, and puts all that are known in their place, up to a gap of `margin` (m).
    pub(super) fn exchange(&mut self, model: &Model<D>, q: &[f64], margin: f64, candidates: &mut Vec<Candidate<D>>) {
        let is_summit = |candidate: &Candidate<D>| model.detector().is_summit(candidate.id);
        self.known.iter_mut().for_each(|summit| summit.now = None);
        for candidate in candidates.iter().filter(|candidate| is_summit(candidate)) {
            let reach = candidates.iter().filter(|other| other.id.pair() == candidate.id.pair());
            let on_base = |of: &Candidate<D>| of.sides[0].point;
            let length = reach.map(|other| (on_base(other) - on_base(candidate)).norm()).fold(0.0, f64::max);
            let near = |summit: &&mut Summit<D>| {
                let same = summit.candidate.id.pair() == candidate.id.pair()
                    && summit.candidate.sides[0].body == candidate.sides[0].body;
                same && summit.now.is_none()
                    && (on_base(&summit.candidate) - on_base(candidate)).norm() <= SAME * length
            };
            let number = self.known.len() as u32;
            if let Some(summit) = self.known.iter_mut().find(near) {
                *summit = Summit::found(model, q, candidate, summit.candidate.id);
            } else {
                let id = ContactId::new(candidate.id.pair(), u32::MAX - number);
                self.known.push(Summit::found(model, q, candidate, id));
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

    /// The identity of a contact among the detector's candidates; `None` of a summit that isn't one of them now.
    pub(super) fn identity(&self, id: ContactId) -> Option<ContactId> {
        match self.known.iter().find(|summit| summit.candidate.id == id) {
            Some(summit) => summit.now,
            None => Some(id),
        }
    }
}
