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
    fn at<const D: usize>(model: &Model<D>, body: BodyId, closed: &[Candidate<D>]) -> Self {
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

    /// The same with that of the body that has drifted most among those that it stands on, or that stand on it.
    pub(super) fn with_neighbours<const D: usize>(model: &Model<D>, body: BodyId, closed: &[Candidate<D>]) -> Self {
        let neighbours = contacts_of(model, body, closed).flat_map(|(of, _)| of.sides.map(|side| side.body));
        let moving = neighbours.filter(|other| *other != body && model.moves(*other));
        let most = moving.map(|other| Self::at(model, other, closed)).fold(Self::default(), Self::max);
        Self::at(model, body, closed) + most
    }

    fn max(self, other: Self) -> Self {
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

/// What tilt a body had drifted to when it lost its support, and has taken along into flight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight {
    body: BodyId,
    /// By what angle, rad.
    pub(super) turn: f64,
    /// When it took off, s.
    pub(super) since: f64,
}

/// What bodies in flight have drifted: one that has taken off without turning is tilted by that when it lands. A body flies while no
/// closed contacts join it to ground or a beam, directly or by other bodies: two that fly together may touch each other.
#[derive(Debug, Default)]
pub(super) struct Flights {
    /// In order of the bodies.
    held: Vec<Flight>,
    /// Which bodies are held up; memory.
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
        if let [body, turn, since] = *numbers {
            self.held.push(Flight { body: BodyId(((-body) as u32).saturating_sub(1)), turn, since });
        }
    }

    /// Gives out the numbers of all.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> {
        self.held.iter().flat_map(|Flight { body, turn, since }| [-f64::from(body.0) - 1.0, *turn, *since])
    }

    /// The flight of a body.
    pub(super) fn of(&self, body: BodyId) -> Option<Flight> {
        self.held.binary_search_by_key(&body, |flight| flight.body).ok().map(|at| self.held[at])
    }

    /// Forgets the flights of bodies that are held up after a part of a step or an impact, by contacts that stay closed.
    pub(super) fn land<const D: usize>(
        &mut self,
        model: &Model<D>,
        contacts: &[Contact<D>],
        stays: &[bool],
        may_fly: impl Fn(BodyId) -> bool,
    ) {
        if self.held.is_empty() && contacts.iter().zip(stays).all(|(contact, stays)| *stays || !contact.persisting) {
            // As before.
            self.stand.clear();
            return;
        }
        let Self { held, stand } = self;
        stand.clear();
        stand.extend((0..model.body_count() as u32).map(|body| !may_fly(BodyId(body))));
        // Forwards and back, so that a tower is done in two rounds, whichever way it is listed.
        let staying = || contacts.iter().zip(stays).filter(|(_, stays)| **stays).map(|(contact, _)| contact);
        while hold_up(stand, staying()) && hold_up(stand, staying().rev()) {}
        held.retain(|flight| stand.get(flight.body.0 as usize).is_some_and(|stands| !stands));
    }

    /// Whether one of these contacts, which were closed, was of a body that flies now and didn't before: [`Flights::take_off`] is due.
    pub(super) fn any_takes_off<const D: usize>(&self, contacts: &[Contact<D>]) -> bool {
        let persisting = contacts.iter().filter(|contact| contact.persisting);
        persisting.flat_map(|contact| &contact.sides).any(|side| self.takes_off(side.body))
    }

    /// After [`Flights::land`].
    fn takes_off(&self, body: BodyId) -> bool {
        self.stand.get(body.0 as usize).is_some_and(|stands| !stands) && self.of(body).is_none()
    }

    /// Remembers what bodies have drifted that lose their support at time `t` (s); `closed` is what was closed before.
    pub(super) fn take_off<const D: usize>(&mut self, model: &Model<D>, closed: &[Candidate<D>], t: f64) {
        for body in closed.iter().flat_map(|of| of.sides.map(|side| side.body)) {
            if self.takes_off(body) {
                // The part in which it takes off may have added to it.
                let turn = 2.0 * Drift::with_neighbours(model, body, closed).turn;
                let at = self.held.partition_point(|flight| flight.body < body);
                self.held.insert(at, Flight { body, turn, since: t });
            }
        }
    }
}

/// Lets what stands hold up what touches it, in the order of these contacts. Whether any more bodies stand.
fn hold_up<'a, const D: usize>(stand: &mut [bool], contacts: impl Iterator<Item = &'a Contact<D>>) -> bool {
    let mut any = false;
    for contact in contacts {
        let [a, b] = [0, 1].map(|side| contact.sides[side].body.0 as usize);
        let stands = |body: usize| stand.get(body).copied().unwrap_or(true);
        if stands(a) != stands(b) {
            (stand[a], stand[b]) = (true, true);
            any = true;
        }
    }
    any
}
