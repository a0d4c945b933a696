//! What bodies have drifted from their surfaces: how far off their place they may be.

use crate::{Contact, Model};
use std::ops::Add;
use teeter_detect::{Anchor, BodyId, Candidate};

/// Gaps that would tilt a body by more (rad) are of contacts at one place, as in a corner between floor and wall, and tell no tilt.
const MOST_TURN: f64 = 1e-3;

/// A bound on the error of a body's position, by the gaps that its closed contacts have drifted to.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Drift {
    /// m.
    pub(super) shift: f64,
    /// By what angle, rad.
    pub(super) turn: f64,
}

impl Drift {
    /// What a body's closed contacts have drifted from their surfaces: their largest gap, and the spread of their gaps over that of their
    /// points.
    pub(super) fn at<const D: usize>(model: &Model<D>, body: BodyId, closed: &[Candidate<D>]) -> Self {
        let of_body = || contacts_of(model, body, closed);
        let Some((_, first)) = of_body().next() else { return Self::default() };
        let distance = |from: &Anchor<D>, to: &Anchor<D>| (to.point - from.point).norm();
        let far = of_body().map(|(_, side)| side).max_by(|a, b| distance(first, a).total_cmp(&distance(first, b)));
        let spread = of_body().map(|(_, side)| distance(far.unwrap_or(first), side)).fold(0.0, f64::max);
        let gaps = || of_body().map(|(of, _)| of.gap);
        let (least, most) = (gaps().fold(f64::INFINITY, f64::min), gaps().fold(f64::NEG_INFINITY, f64::max));
        let turn = (most - least) / spread;
        let turn = if turn <= MOST_TURN { turn } else { 0.0 };
        Self { shift: least.abs().max(most.abs()), turn }
    }

    pub(super) fn max(self, other: Self) -> Self {
        Self { shift: self.shift.max(other.shift), turn: self.turn.max(other.turn) }
    }
}

impl Add for Drift {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { shift: self.shift + other.shift, turn: self.turn + other.turn }
    }
}

/// The closed contacts of a body, with its side of each; not those with springs, whose gaps are no drift.
pub(super) fn contacts_of<'a, const D: usize>(
    model: &'a Model<D>,
    body: BodyId,
    closed: &'a [Candidate<D>],
) -> impl Iterator<Item = (&'a Candidate<D>, &'a Anchor<D>)> {
    let rigid = closed.iter().filter(|of| model.spring(of.law).is_none());
    rigid.filter_map(move |of| of.sides.iter().find(|side| side.body == body).map(|side| (of, side)))
}

/// What a body had drifted when it left its last closed contact, and has taken along into flight.
#[derive(Clone, Copy, Debug)]
struct Flight {
    body: BodyId,
    drift: Drift,
}

/// What bodies in flight have drifted: one that has taken off without turning is tilted by that when it lands.
#[derive(Debug, Default)]
pub(super) struct Flights {
    /// In order of the bodies.
    held: Vec<Flight>,
    /// Which bodies have a closed contact; memory.
    stand: Vec<bool>,
}

impl Flights {
    /// Numbers by which a scheme's memory holds a flight; the first of them is negative.
    pub(super) const NUMBERS: usize = 3;

    pub(super) fn reserve(&mut self, flights: usize, bodies: usize) {
        self.held.reserve(flights);
        self.stand.reserve(bodies);
    }

    pub(super) fn clear(&mut self) {
        self.held.clear();
    }

    pub(super) fn is_empty(&self) -> bool {
        self.held.is_empty()
    }

    /// Takes one up from its numbers. Add them in the order in which they were given out.
    pub(super) fn push(&mut self, numbers: &[f64]) {
        if let [body, shift, turn] = *numbers {
            self.held.push(Flight { body: BodyId(((-body) as u32).saturating_sub(1)), drift: Drift { shift, turn } });
        }
    }

    /// Gives out the numbers of all.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> {
        self.held.iter().flat_map(|Flight { body, drift }| [-f64::from(body.0) - 1.0, drift.shift, drift.turn])
    }

    /// What a body has taken along; nothing where it isn't in flight.
    pub(super) fn drift_of(&self, body: BodyId) -> Drift {
        let found = self.held.binary_search_by_key(&body, |flight| flight.body);
        found.map_or(Drift::default(), |at| self.held[at].drift)
    }

    /// Forgets the flights of bodies that have landed: those with a contact that `stays` closed. Whether a body leaves its last closed
    /// contact instead, so that [`Flights::take_off`] is due.
    pub(super) fn land<const D: usize>(
        &mut self,
        model: &Model<D>,
        contacts: &[Contact<D>],
        stays: &[bool],
        is_rigid: impl Fn(&Contact<D>) -> bool,
    ) -> bool {
        let Self { held, stand } = self;
        stand.clear();
        stand.resize(model.body_count(), false);
        let staying = contacts.iter().zip(stays).filter(|(_, stays)| **stays);
        for side in staying.flat_map(|(contact, _)| &contact.sides) {
            if let Some(stands) = stand.get_mut(side.body.0 as usize) {
                *stands = true;
            }
        }
        held.retain(|flight| stand.get(flight.body.0 as usize).is_some_and(|stands| !stands));
        let leaves = |(contact, stays): (&Contact<D>, &bool)| {
            let moves_off = |side: &Anchor<D>| model.moves(side.body) && !stand[side.body.0 as usize];
            contact.persisting && !stays && contact.sides.iter().any(moves_off) && is_rigid(contact)
        };
        contacts.iter().zip(stays).any(leaves)
    }

    /// Remembers what bodies have drifted that leave the last of these `closed` contacts, after [`Flights::land`].
    pub(super) fn take_off<const D: usize>(&mut self, model: &Model<D>, closed: &[Candidate<D>]) {
        for body in closed.iter().flat_map(|of| of.sides.map(|side| side.body)).filter(|body| model.moves(*body)) {
            if self.stand[body.0 as usize] {
                continue;
            }
            if let Err(at) = self.held.binary_search_by_key(&body, |flight| flight.body) {
                let drift = Drift::at(model, body, closed);
                if drift.turn > 0.0 {
                    self.held.insert(at, Flight { body, drift });
                }
            }
        }
    }
}
