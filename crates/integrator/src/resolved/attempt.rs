//! A part of a step: motion without contacts, the contacts that take part, passes until their gaps are closed.

use super::Resolved;
use crate::closed_step::{Guard, THETA, find, leaves};
use crate::theta_step::weights;
use crate::{Keep, Model, Over, PhaseEnd, PhaseKind, Responses, State, StepError, StepSpan, Weights, Workspace};
use teeter_contact::Outcome;
use teeter_detect::Candidate;

/// Passes in which places and gaps at the end of a step are brought together.
const PASSES: usize = 6;

/// Places at the end that change by less than this part of the largest coordinate stand still.
const SETTLED: f64 = 4.0 * f64::EPSILON;

/// Where a contact is in the surface already, it closes when it sinks by this part of the gap tolerance.
const SINKING: f64 = 1e-3;

impl<const D: usize> Resolved<D> {
    /// Attempts a part of a step from `from`: leaves q¹, v¹ and the solved contacts.
    pub(super) fn attempt(
        &mut self,
        model: &Model<D>,
        from: &State,
        part: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, StepError> {
        let keep = if part.h == from.dt * self.of_step { Keep::Pinned } else { Keep::Once };
        work.factors(model, weights(part.h, THETA), &from.q, keep)?;
        if self.elastic.len() != from.v.len() {
            self.find_what_is_elastic(model, part.h, work);
        }
        self.step.free_velocity(model, from, work, THETA, part);
        self.v_free.copy_from_slice(&self.step.v_end);
        self.step.close(model, from, part.h, THETA)?;
        self.ids.clear();
        self.ids.extend_from_slice(from.memory.active());
        work.detect(model, &self.step.q_at, 0.0)?;
        self.close_what_sinks(model, from, work)?;
        loop {
            let outcome = self.solve(model, from, part, work)?;
            work.detect(model, &self.step.q_at, 0.0)?;
            if !self.close_what_sinks(model, from, work)? {
                return Ok(outcome);
            }
            work.counts.refused_attempts += 1;
        }
    }

    /// Solves the contacts that take part, with rows at the middle of the motion and gaps at its end, until these stand still.
    fn solve(
        &mut self,
        model: &Model<D>,
        from: &State,
        part: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, StepError> {
        self.posed.clear();
        self.stage.clear();
        if self.ids.is_empty() {
            return Ok(None);
        }
        work.locate(model, &from.q, &self.ids, &mut self.start)?;
        self.ids.retain(|id| find(&self.start, *id).is_some());
        let (over, responses) = (Over::Step { h: part.h, weight: THETA }, Responses::Over(part.h));
        let problem = |source| StepError::Problem { t: from.t, source };
        let mut outcome = None;
        let mut last = None;
        self.holds.clear();
        for pass in 0..PASSES {
            self.pose(model, from, part, work, pass)?;
            self.q_end.copy_from_slice(&self.step.q_at);
            self.step.v_end.copy_from_slice(&self.v_free);
            self.guarded.restart(self.stage.len());
            let (guarded, v_free) = (&mut self.guarded, &self.v_free);
            outcome = self
                .stage
                .solve_guarded(model, work, &responses, over, |stage, problem, laws, members| {
                    let guard = Guard { model, stage, laws, members, v_before: &from.v, v_free };
                    Ok(guard.apply(problem, guarded)?)
                })
                .map_err(problem)?;
            self.stage.respond(model, work, &responses, &mut self.step.v_end).map_err(problem)?;
            self.stage.complete(&self.step.v_end)?;
            self.step.close(model, from, part.h, THETA)?;
            let largest = self.q_end.iter().fold(0.0_f64, |largest, q| largest.max(q.abs()));
            let moved = self.q_end.iter().zip(&self.step.q_at).fold(0.0_f64, |moved, (a, b)| moved.max((a - b).abs()));
            // The next pass would move them less by the factor by which this one did.
            let next = last.map_or(moved, |last: f64| moved * (moved / last).min(1.0));
            if !self.posed.iter().any(|posed| posed.held) || next <= SETTLED * largest {
                break;
            }
            last = Some(moved);
        }
        Ok(outcome)
    }

    /// Takes the open contacts in that the attempt ends with in their surface (they are the workspace's candidates), deeper than they
    /// began; whether there are any.
    fn close_what_sinks(&mut self, model: &Model<D>, from: &State, work: &mut Workspace<D>) -> Result<bool, StepError> {
        let before = self.ids.len();
        for k in 0..work.candidates.len() {
            let Candidate { id, gap, .. } = work.candidates[k];
            if gap >= -self.settings.gap_tolerance || self.ids[..before].binary_search(&id).is_ok() {
                continue;
            }
            work.locate(model, &from.q, &[id], &mut self.start)?;
            // What comes in from beside its surface has no way that it could have sunk, in this part of the step.
            let Some(start) = self.start.first() else { continue };
            let level = start.gap.min(0.0);
            if gap < level - SINKING * self.settings.gap_tolerance {
                self.ids.push(id);
            }
        }
        let found = self.ids.len() > before;
        self.ids.sort_unstable();
        Ok(found)
    }

    /// Finds which contacts press on in the next part of the step.
    pub(super) fn find_what_stays(&mut self) {
        self.stays.clear();
        for (i, (contact, posed)) in self.stage.contacts().iter().zip(&self.posed).enumerate() {
            let shift = posed.resting_shift - self.stage.problem.shift(i)[0];
            let still = || self.stage.speed(i, &self.step.v_end).max(self.stage.speed(i, &self.v_free));
            let stays = match contact.gap_after {
                Some(gap) => gap < 0.0,
                None => contact.p[0] > 0.0 && (posed.held || !leaves(shift, still)),
            };
            self.stays.push(stays);
        }
    }

    /// Ends the phase that was attempted.
    pub(super) fn end_phase(
        &mut self,
        model: &Model<D>,
        from: &State,
        part: &StepSpan,
        outcome: Option<Outcome>,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        let mut energy = self.step.work_of_forces(model, from, work, &self.stage, part.h, THETA);
        self.q_mid.iter_mut().zip(&from.q).zip(&self.step.q_at).for_each(|((mid, q0), q1)| *mid = 0.5 * (q0 + q1));
        for (index, own) in model.parts().iter().enumerate() {
            if let Some(motion) = work.factors.propagator(index) {
                let v = &mut self.step.v_end[own.v.clone()];
                v.copy_from_slice(&from.v[own.v.clone()]);
                let mean = &mut self.q_mid[own.q.clone()];
                mean.copy_from_slice(&from.q[own.q.clone()]);
                let lost = motion.end(&self.stage.rows.of_part(index), &self.stage.problem.p, v, mean);
                energy.viscous -= lost.viscous;
                energy.numerical -= lost.filtered;
            }
        }
        let phase = PhaseEnd::new(PhaseKind::Step, part.end, &self.step.q_at, &self.step.v_end)
            .lasting(part.h)
            .with_energy(energy)
            .with_mean(&self.q_mid)
            .with_outcome(outcome);
        work.phase(model, &phase, Some(&mut self.stage))
    }

    /// Leaves M Δq/h of the motion to `q_at`.
    pub(super) fn find_momentum(&mut self, model: &Model<D>, from: &State) {
        self.momentum.fill(0.0);
        for part in model.parts().iter().filter(|part| !part.v.is_empty()) {
            let v = part.v.clone();
            for (mean, (v1, v0)) in
                self.mean[v.clone()].iter_mut().zip(self.step.v_end[v.clone()].iter().zip(&from.v[v.clone()]))
            {
                *mean = 0.5 * (v0 + v1);
            }
            part.system.apply(Weights::MASS, &from.q[part.q.clone()], &self.mean[v.clone()], &mut self.momentum[v]);
        }
    }
}
