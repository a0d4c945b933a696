//! An impact: places stand still, velocities jump.

use super::drift::{Drift, Flight, contacts_of};
use super::{MASSES, MoreauJeanLocated, may_fly, rate_at};
use crate::closed_step::{leaves, restitute};
use crate::laws::is_impact;
use crate::{
    ContactError, Keep, Mismatch, Model, Over, PhaseEnd, PhaseKind, Responses, Rule, State, StepError, Vector,
    Workspace,
};
use std::ops::Add;
use teeter_detect::{Anchor, Candidate};

/// Contacts with a gap of up to so many tolerances touch.
const TOUCHING: f64 = 10.0;

/// The time of an impact is uncertain by no more than this part of the scheme's step: a larger gap of a closed contact is not drift.
const HIDDEN: f64 = 0.01;

/// A body that turns in a flight by less than this part of the tilt that it had drifted to counts as not turning.
const NO_TURN: f64 = 1e-3;

/// A contact that strikes, and by how much its time is uncertain: by what closed contacts of its bodies have drifted from their surfaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strike<const D: usize> {
    sides: [Anchor<D>; 2],
    /// Its normal velocity, m/s: below 0.
    rate: f64,
    drift: Drift,
    /// The flights of its bodies.
    flights: [Option<Flight>; 2],
}

impl<const D: usize> Strike<D> {
    /// By how much the time (s) is uncertain at which another contact with these sides and this normal velocity (m/s) strikes, in comparison,
    /// at time `t`, s.
    fn uncertainty(&self, model: &Model<D>, sides: &[Anchor<D>; 2], rate: f64, t: f64) -> f64 {
        let lever = |side: &Anchor<D>| {
            let own = self.sides.iter().find(|own| own.body == side.body)?;
            Some((side.point - own.point).norm())
        };
        let lever = sides.iter().filter(|side| model.moves(side.body)).filter_map(lever).fold(0.0, f64::max);
        // What turns in flight is tilted by that, and no more by what had drifted before.
        let turned = |flight: &Flight| (rate - self.rate).abs() * (t - flight.since);
        let flights = self.flights.iter().flatten().filter(|flight| turned(flight) <= NO_TURN * flight.turn * lever);
        let turn = self.drift.turn + flights.map(|flight| flight.turn).fold(0.0, f64::max);
        (self.drift.shift + turn * lever) / -self.rate
    }
}

/// Keeps the candidates for which this holds.
fn keep_candidates<const D: usize>(
    work: &mut Workspace<D>,
    mut is_kept: impl FnMut(&Candidate<D>) -> Result<bool, Mismatch>,
) -> Result<(), Mismatch> {
    let mut kept = 0;
    for k in 0..work.candidates.len() {
        let candidate = work.candidates[k];
        if is_kept(&candidate)? {
            work.candidates[kept] = candidate;
            kept += 1;
        }
    }
    work.candidates.truncate(kept);
    Ok(())
}

impl<const D: usize> MoreauJeanLocated<D> {
    /// Lets the contacts that touch at `from` strike, at time `end` (s): its velocities and what is
    /// closed change. Whether any do.
    pub(super) fn strike(
        &mut self,
        model: &Model<D>,
        from: &mut State,
        end: f64,
        work: &mut Workspace<D>,
    ) -> Result<bool, StepError> {
        self.find_what_touches(model, from, work)?;
        if self.impact.is_empty() {
            return Ok(false);
        }
        let t = from.t;
        let problem = |source| StepError::Problem { t, source };
        self.pose(model, from).map_err(problem)?;
        let (over, responses) = (Over::Instant, Responses::Of(MASSES));
        work.factors(model, MASSES, &from.q, Keep::Pinned)?;
        self.v.copy_from_slice(&from.v);
        let outcome = self.impact.solve(model, work, &responses, over).map_err(problem)?;
        self.impact.respond(model, work, &responses, &mut self.v).map_err(problem)?;
        self.impact.complete(&self.v)?;
        self.stays.clear();
        from.memory.forget_rigid();
        for (i, contact) in self.impact.contacts().iter().enumerate() {
            // What rests beside has no velocity left to tell its rounding by, but what weight would give it.
            let speeds = || [&self.v, &from.v, &self.by_forces].map(|v| self.impact.speed(i, v));
            let speed = || speeds().into_iter().fold(0.0, f64::max);
            let stays = (contact.p[0] > 0.0 || contact.persisting) && !leaves(contact.u_after[0], speed);
            self.stays.push(stays);
            if stays {
                from.memory.insert(contact);
            }
        }
        let Self { impact, stays, flights, near, elastic, .. } = self;
        flights.land(model, impact.contacts(), stays, |body| may_fly(model, elastic, body));
        if flights.any_takes_off(impact.contacts()) {
            flights.take_off(model, near, end);
        }
        let energy = self.step.step.work_of_impact(model, from, work, &self.impact, &self.v)?;
        let phase = PhaseEnd::new(PhaseKind::Impact, end, &from.q, &self.v).with_energy(energy).with_outcome(outcome);
        work.phase(model, &phase, Some(&mut self.impact))?;
        from.v.copy_from_slice(&self.v);
        from.t = end;
        Ok(true)
    }

    /// Takes the contacts that touch into the stage: those that were closed up to here, and those
    /// that are near.
    fn find_what_touches(&mut self, model: &Model<D>, from: &State, work: &mut Workspace<D>) -> Result<(), Mismatch> {
        let touching = TOUCHING * self.tolerance(&from.q);
        work.locate(model, &from.q, &self.step.closed, &mut self.near)?;
        work.detect(model, &from.q, touching)?;
        self.find_strikes(model, from, work)?;
        if !self.strikes.is_empty() {
            // Two bodies may approach each other, each be off its place; a beam is not faster than what rocks on it.
            let reach = 4.0 * HIDDEN * from.dt * self.fastest(model, &from.v);
            work.detect(model, &from.q, touching.max(reach))?;
            keep_candidates(work, |candidate| {
                Ok(candidate.gap <= touching || self.strikes_along(model, from, candidate)?)
            })?;
        }
        self.leave_out_what_parts(model, from, work)?;
        let Self { impact, near, .. } = self;
        impact.clear();
        let mut add = |candidate: &Candidate<D>| -> Result<(), Mismatch> {
            if model.spring(candidate.law).is_none() {
                impact.add(model, &from.q, candidate, &from.warm, &from.memory)?;
            }
            Ok(())
        };
        let mut closed = near.iter().peekable();
        for candidate in &work.candidates {
            while let Some(other) = closed.next_if(|other| other.id < candidate.id) {
                add(other)?;
            }
            closed.next_if(|other| other.id == candidate.id);
            add(candidate)?;
        }
        closed.try_for_each(add)
    }

    /// Leaves out the candidates that a blow has sent off just before: they are open, however small their gap, and take no part in the next
    /// blow, but may strike after it. Bounces between two contacts of a body that accumulate would end in a blow of both, too early.
    fn leave_out_what_parts(
        &mut self,
        model: &Model<D>,
        from: &State,
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        keep_candidates(work, |candidate| {
            if self.step.closed.binary_search(&candidate.id).is_ok()
                || self.is_with_elastic(model, &candidate.sides.map(|side| side.body))
            {
                return Ok(true);
            }
            let rate = rate_at(&mut self.one, model, &from.q, candidate, &from.v)?;
            Ok(!leaves(rate, || self.one.speed(0, &from.v)))
        })
    }

    /// Finds the contacts that strike, if any closed contact has drifted from its surface, so that others may seem to come later.
    fn find_strikes(&mut self, model: &Model<D>, from: &State, work: &Workspace<D>) -> Result<(), Mismatch> {
        self.strikes.clear();
        let is_off = |closed: &Candidate<D>| closed.gap != 0.0 && model.spring(closed.law).is_none();
        if self.flights.is_empty() && !self.near.iter().any(is_off) {
            return Ok(());
        }
        let touching = TOUCHING * self.tolerance(&from.q);
        for candidate in &work.candidates {
            // A beam takes each blow by itself.
            if self.step.closed.binary_search(&candidate.id).is_ok()
                || self.is_with_elastic(model, &candidate.sides.map(|side| side.body))
            {
                continue;
            }
            let rate = rate_at(&mut self.one, model, &from.q, candidate, &from.v)?;
            if leaves(-rate, || self.one.speed(0, &from.v)) {
                let moving = candidate.sides.iter().filter(|side| model.moves(side.body));
                let mut drift = moving
                    .map(|side| Drift::with_neighbours(model, side.body, &self.near))
                    .fold(Drift::default(), Drift::add);
                if drift.shift > 0.0 {
                    drift.shift = drift.shift.max(touching);
                }
                let flights = candidate.sides.map(|side| self.flights.of(side.body));
                self.strikes.push(Strike { sides: candidate.sides, rate, drift, flights });
            }
        }
        Ok(())
    }

    /// Whether a contact that doesn't touch takes part in the impact: what its bodies have drifted may be all of its gap, or it would touch
    /// within the time by which the impact is uncertain.
    ///
    /// Points on one line under a base land together, and so do the corners of a side that meets a wall flush. But where the pivot has sunk
    /// in by some nanometres, the points nearer to it would strike first, and take part of the blow; where a block has come to rest on one
    /// corner deeper than on the other, one corner of its side would be first, and one that lies against a wall would not.
    fn strikes_along(&mut self, model: &Model<D>, from: &State, candidate: &Candidate<D>) -> Result<bool, Mismatch> {
        if self.is_with_elastic(model, &candidate.sides.map(|side| side.body)) {
            return Ok(false);
        }
        // More is not drift.
        let longest = HIDDEN * from.dt;
        let fastest = self.strikes.iter().map(|strike| -strike.rate).fold(0.0, f64::max);
        let rate = rate_at(&mut self.one, model, &from.q, candidate, &from.v)?;
        let times = self.strikes.iter().map(|strike| strike.uncertainty(model, &candidate.sides, rate, from.t));
        let time = times.filter(|time| *time <= longest).fold(0.0, f64::max);
        let own = self.off_by(model, candidate);
        let own = if own <= longest * fastest { own } else { 0.0 };
        Ok(candidate.gap <= own + (-rate).max(0.0) * time)
    }

    /// How much of the gap of a contact may be what its bodies have drifted, m.
    fn off_by(&self, model: &Model<D>, contact: &Candidate<D>) -> f64 {
        let of_side = |side: &Anchor<D>| {
            let levers = contacts_of(model, side.body, &self.near).map(|(_, of)| (side.point - of.point).norm());
            let drift = Drift::with_neighbours(model, side.body, &self.near);
            drift.shift + drift.turn * levers.fold(0.0, f64::max)
        };
        contact.sides.iter().filter(|side| model.moves(side.body)).map(of_side).sum()
    }

    /// Gives each contact its law.
    fn pose(&mut self, model: &Model<D>, from: &State) -> Result<(), ContactError> {
        let mut strikes = false;
        for i in 0..self.impact.len() {
            let contact = self.impact.contacts()[i];
            let law = model.law(contact.law)?;
            let u = self.impact.velocity(i, &from.v)?;
            let mut u_free = u + self.impact.velocity(i, &self.by_forces)?;
            if let Ok(at) = self.in_lowest_bounce.binary_search_by_key(&contact.id, |(id, _)| *id) {
                u_free[0] = u[0] + self.in_lowest_bounce[at].1;
            }
            let mut shift = Vector::zeros();
            let rule = restitute(contact.persisting, &law, &u, &u_free, &mut shift);
            strikes |= !contact.persisting && is_impact(1.0, &u, &u_free);
            self.impact.set(i, u, u, shift, rule)?;
        }
        // Poisson's law gives back of any blow: where nothing strikes, there is none.
        for i in (0..self.impact.len()).filter(|_| !strikes) {
            if let Rule::Poisson { .. } = self.impact.problem.rule(i) {
                let u = self.impact.velocity(i, &from.v)?;
                self.impact.set(i, u, u, Vector::zeros(), Rule::Shifted)?;
            }
        }
        Ok(())
    }
}
