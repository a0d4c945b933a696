//! A closed step whose end is projected onto what contacts allow: what `moreau-jean-projected` and
//! `generalized-alpha` share.

use crate::closed_step::ClosedStep;
use crate::moreau_jean_closed::deepest;
use crate::projection::Projection;
use crate::step_motion::StepMotion;
use crate::{Account, Model, PhaseEnd, PhaseKind, State, StepError, StepReport, StepSpan, Workspace};
use teeter_contact::Outcome;

/// The step, its projection, and the memory for both.
#[derive(Debug)]
pub(crate) struct ProjectedStep<const D: usize, M> {
    pub(crate) step: ClosedStep<D, M>,
    projection: Projection<D>,
    /// By which means the step balances.
    q_mean: Vec<f64>,
    v_mean: Vec<f64>,
}

impl<const D: usize, M: StepMotion<D>> ProjectedStep<D, M> {
    pub(crate) fn new(gap_tolerance: f64, motion: M) -> Self {
        Self {
            step: ClosedStep::with_motion(gap_tolerance, motion),
            projection: Projection::new(),
            q_mean: Vec::new(),
            v_mean: Vec::new(),
        }
    }

    /// Starts to serve a model.
    pub(crate) fn start(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        self.step.start(model, state, work)?;
        self.projection.reserve(model);
        work.reserve_mean_velocity(model);
        self.resize(model);
        Ok(())
    }

    fn resize(&mut self, model: &Model<D>) {
        self.q_mean.resize(model.size().q, 0.0);
        self.v_mean.resize(model.size().v, 0.0);
    }

    /// Takes a step, never past `until` (s).
    ///
    /// Step and projection settle together: a contact that the projection pushes apart takes part in
    /// the step, which is then taken again.
    pub(crate) fn advance<'w>(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        until: f64,
        work: &'w mut Workspace<D>,
    ) -> Result<StepReport<'w, D>, StepError> {
        let span = state.next_step(until);
        work.begin(model, state, span)?;
        self.step.check(model)?;
        self.resize(model);
        self.step.begin(model, state, &span, work)?;
        let responses = self.step.step.projection_responses(span.h);
        let (outcome, projected) = loop {
            let outcome = self.step.settle(model, state, &span, work)?;
            let projected = self
                .projection
                .project(model, state, self.step.step.q_end(), &responses, work)
                .map_err(|source| StepError::Problem { t: state.t, source })?;
            // Each round closes one contact more at least, so it ends.
            if !self.step.close_too(self.projection.pushed()) {
                break (outcome, projected);
            }
            work.counts.refused_attempts += 1;
        };
        let penetration = deepest(work);
        self.step.find_what_stays();
        self.end_phase(model, state, &span, outcome, projected, work)?;
        let ClosedStep { stays, step, .. } = &self.step;
        let report = work.finish(model, state, Some(penetration), |i, _| stays[i])?;
        step.remember(&mut state.memory);
        Ok(report)
    }

    fn end_phase(
        &mut self,
        model: &Model<D>,
        from: &State,
        span: &StepSpan,
        outcome: Option<Outcome>,
        projected: Option<Outcome>,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        self.step.step.settle(model, from);
        let mut energy = self.step.step.work(model, from, span, &self.step.stage, work);
        let ClosedStep { step, stage, .. } = &mut self.step;
        let q = self.projection.q();
        if projected.is_some() && work.account == Account::Kept {
            energy.projection = work_of_projection(model, step.q_end(), q, step.v_end());
        }
        step.take_means(from, &mut self.q_mean, &mut self.v_mean);
        let outcome = match projected {
            Some(projected) if !projected.converged() && outcome.is_none_or(|own| own.converged()) => Some(projected),
            _ => outcome,
        };
        let mut phase = PhaseEnd::new(PhaseKind::Step, span.end, q, step.v_end())
            .lasting(span.h)
            .with_energy(energy)
            .with_outcome(outcome);
        if projected.is_some() || step.has_own_means() {
            phase = phase.with_mean(&self.q_mean).with_mean_velocity(&self.v_mean);
        }
        work.phase(model, &phase, Some(stage))
    }
}

/// What the projection does to the energy, J.
fn work_of_projection<const D: usize>(model: &Model<D>, before: &[f64], after: &[f64], v: &[f64]) -> f64 {
    let (before, after) = (model.energy_at(before, v), model.energy_at(after, v));
    (after.kinetic - before.kinetic) + (after.elastic - before.elastic) + (after.gravity - before.gravity)
}
