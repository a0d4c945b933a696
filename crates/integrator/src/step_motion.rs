//! What the closed step asks of the motion beside its contacts.

use crate::closed_step::THETA;
use crate::theta_step::{ThetaStep, weights};
use crate::{
    ContactError, ContactStage, Keep, Memory, Model, Responses, State, StepEnergy, StepError, StepSpan, Workspace,
};
use teeter_contact::Outcome;

/// The motion of a step beside its contacts, and what impulses do to it; it holds the end of the
/// step that is tried. Impulses do their work with the mean of the velocities at both ends.
pub(crate) trait StepMotion<const D: usize>: std::fmt::Debug {
    /// Starts to serve a model.
    fn start_motion(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError>;

    /// Refuses what doesn't belong together.
    fn check_motion(&mut self, model: &Model<D>) -> Result<(), StepError>;

    /// Makes the factors of steps of `h` (s).
    fn make_factors(
        &mut self,
        model: &Model<D>,
        from: &State,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError>;

    /// Leaves the velocities at the end without impulses of contacts.
    fn move_without_impulses(&mut self, model: &Model<D>, from: &State, span: &StepSpan, work: &mut Workspace<D>);

    /// What impulses do to the velocities at the end of a step of `h` (s).
    fn responses(&self, h: f64) -> Responses<'static>;

    /// The inverse of the metric in which coordinates are projected: stiff, so that a beam's highest
    /// modes don't take the correction and keep its energy.
    fn projection_responses(&self, h: f64) -> Responses<'static>;

    /// Adds what the impulses of `stage` do to the velocities without them.
    fn respond(
        &mut self,
        model: &Model<D>,
        stage: &ContactStage<D>,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), ContactError>;

    /// Whether the velocities that were tried ask for other ones without impulses, which are then in
    /// their place: the step is to be solved again. It ends by itself.
    fn takes_another_round(&mut self, model: &Model<D>, from: &State, h: f64, work: &mut Workspace<D>) -> bool {
        let _ = (model, from, h, work);
        false
    }

    /// The outcome of the step, which is unsolved where these rounds have not found their end to
    /// `tolerance`.
    fn judge(&self, outcome: Option<Outcome>, tolerance: f64) -> Option<Outcome> {
        let _ = tolerance;
        outcome
    }

    /// Leaves the coordinates at the end of the step.
    fn end(&mut self, model: &Model<D>, from: &State, h: f64) -> Result<(), StepError>;

    /// Begins anew with the velocities at the end without impulses of contacts.
    fn restart(&mut self, v_free: &[f64]) {
        self.v_end_mut().copy_from_slice(v_free);
    }

    /// Takes the end that was tried as that of the step: asked for once, before its work and its
    /// means.
    fn settle(&mut self, model: &Model<D>, from: &State) {
        let _ = (model, from);
    }

    /// Leaves in a state's memory what the next step needs.
    fn remember(&self, memory: &mut Memory) {
        let _ = memory;
    }

    /// Coordinates at the end.
    fn q_end(&self) -> &[f64];

    /// Velocities at the end.
    fn v_end(&self) -> &[f64];

    /// The same, for someone who takes their place.
    fn v_end_mut(&mut self) -> &mut [f64];

    /// The terms of the energy identity that aren't contact.
    fn work(
        &mut self,
        model: &Model<D>,
        from: &State,
        span: &StepSpan,
        stage: &ContactStage<D>,
        work: &mut Workspace<D>,
    ) -> StepEnergy;

    /// Whether it balances by other means than those of its ends.
    fn has_own_means(&self) -> bool;

    /// Leaves the means of coordinates and velocities by which it balances in these.
    fn take_means(&self, from: &State, q: &mut [f64], v: &mut [f64]);
}

impl<const D: usize> StepMotion<D> for ThetaStep {
    fn start_motion(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError> {
        self.start(model, state, work)
    }

    #[inline]
    fn check_motion(&mut self, model: &Model<D>) -> Result<(), StepError> {
        Ok(self.check(model)?)
    }

    #[inline]
    fn make_factors(
        &mut self,
        model: &Model<D>,
        from: &State,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        let keep = if h == from.dt { Keep::Pinned } else { Keep::Once };
        work.factors(model, weights(h, THETA), &from.q, keep)
    }

    #[inline]
    fn move_without_impulses(&mut self, model: &Model<D>, from: &State, span: &StepSpan, work: &mut Workspace<D>) {
        self.free_velocity(model, from, work, THETA, span);
    }

    #[inline]
    fn responses(&self, h: f64) -> Responses<'static> {
        Responses::Of(weights(h, THETA))
    }

    #[inline]
    fn projection_responses(&self, h: f64) -> Responses<'static> {
        Responses::Of(weights(h, THETA))
    }

    #[inline]
    fn respond(
        &mut self,
        model: &Model<D>,
        stage: &ContactStage<D>,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), ContactError> {
        stage.respond(model, work, &Responses::Of(weights(h, THETA)), &mut self.v_end)
    }

    #[inline]
    fn takes_another_round(&mut self, model: &Model<D>, from: &State, h: f64, work: &mut Workspace<D>) -> bool {
        Self::takes_another_round(self, model, from, work, THETA, h)
    }

    #[inline]
    fn judge(&self, outcome: Option<Outcome>, tolerance: f64) -> Option<Outcome> {
        Self::judge(self, outcome, tolerance)
    }

    #[inline]
    fn end(&mut self, model: &Model<D>, from: &State, h: f64) -> Result<(), StepError> {
        self.close(model, from, h, THETA)
    }

    #[inline]
    fn q_end(&self) -> &[f64] {
        &self.q_at
    }

    #[inline]
    fn v_end(&self) -> &[f64] {
        &self.v_end
    }

    #[inline]
    fn v_end_mut(&mut self) -> &mut [f64] {
        &mut self.v_end
    }

    fn work(
        &mut self,
        model: &Model<D>,
        from: &State,
        span: &StepSpan,
        stage: &ContactStage<D>,
        work: &mut Workspace<D>,
    ) -> StepEnergy {
        self.work_of_forces(model, from, work, stage, span.h, THETA)
    }

    fn has_own_means(&self) -> bool {
        false
    }

    fn take_means(&self, from: &State, q: &mut [f64], v: &mut [f64]) {
        for (mean, x0, x1) in [(q, &from.q, &self.q_at), (v, &from.v, &self.v_end)] {
            mean.iter_mut().zip(x0.iter().zip(x1)).for_each(|(mean, (x0, x1))| *mean = 0.5 * (x0 + x1));
        }
    }
}
