//! An impact: places stand still, velocities jump.

use super::{MASSES, MoreauJeanLocated, rate_at};
use crate::closed_step::{leaves, restitute};
use crate::laws::is_impact;
use crate::{
    ContactError, Keep, Mismatch, Model, Over, PhaseEnd, PhaseKind, Responses, Rule, State, StepError, Vector,
    Workspace,
};
use teeter_detect::Candidate;

/// Contacts with a gap of up to so many tolerances touch.
const TOUCHING: f64 = 10.0;

/// The time of an impact is uncertain by no more than this part of the scheme's step: a larger gap of a closed contact is not drift.
const HIDDEN: f64 = 0.01;

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
        let hidden = self.hidden_time(model, from, work)?;
        if hidden > 0.0 {
            // Two bodies may approach each other; a beam is not faster than what rocks on it.
            let reach = 2.0 * hidden * self.fastest(model, &from.v);
            work.detect(model, &from.q, touching.max(reach))?;
            let (mut candidates, mut kept) = (std::mem::take(&mut work.candidates), 0);
            for k in 0..candidates.len() {
                let candidate = candidates[k];
                let is_near = candidate.gap <= touching;
                if is_near || -rate_at(&mut self.one, model, &from.q, &candidate, &from.v)? * hidden >= candidate.gap {
                    candidates[kept] = candidate;
                    kept += 1;
                }
            }
            candidates.truncate(kept);
            work.candidates = candidates;
        }
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

    /// By how much the time of the impact is uncertain, s: the distance that closed contacts of the striking bodies have drifted from their
    /// surfaces, over the velocity of approach; 0 without closed contacts.
    ///
    /// What touches within that time strikes in the same impact. Points on one line under a base land together; but where the pivot has
    /// sunk in by some nanometres, the points nearer to it would strike first, and take part of the blow.
    fn hidden_time(&mut self, model: &Model<D>, from: &State, work: &Workspace<D>) -> Result<f64, Mismatch> {
        let touching = TOUCHING * self.tolerance(&from.q);
        let mut hidden = 0.0_f64;
        for candidate in &work.candidates {
            let shares = |closed: &&Candidate<D>| {
                let mut bodies = candidate.sides.iter().map(|side| side.body).filter(|body| model.moves(*body));
                bodies.any(|body| closed.sides.iter().any(|side| side.body == body))
            };
            let drift = self.near.iter().filter(shares).map(|closed| closed.gap.abs()).fold(0.0, f64::max);
            let is_known = drift == 0.0 || self.step.closed.binary_search(&candidate.id).is_ok();
            // A beam takes each blow by itself.
            if is_known || self.is_with_elastic(model, &candidate.sides.map(|side| side.body)) {
                continue;
            }
            let rate = rate_at(&mut self.one, model, &from.q, candidate, &from.v)?;
            if leaves(-rate, || self.one.speed(0, &from.v)) {
                hidden = hidden.max(drift.max(touching) / -rate);
            }
        }
        // More is not drift.
        Ok(if hidden <= HIDDEN * from.dt { hidden } else { 0.0 })
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
