//! A world in motion: its model, state, workspace and scheme, kept together.

use crate::handles::WorldId;
use crate::{BeamHandle, BlockHandle, SimError, SurfaceHandle};
use nalgebra::Vector3;
use std::sync::Arc;
use teeter_beam::{Beam, Deflection};
use teeter_integrator::{
    Ended, Ledger, Model, Observer, PartPlace, Plan, RunError, Scheme, State, StepReport, Unsolved, Workspace, run,
};

/// A surface's place in the state, and its beam if it is one.
pub(crate) struct SurfacePlace {
    pub(crate) place: PartPlace,
    pub(crate) beam: Option<Arc<Beam>>,
}

/// A [`World`](crate::World) in motion.
///
/// Every part of it can be reached, so that whatever the integrator offers can be done with it: its model and state are those that
/// [`teeter_integrator::run`] takes.
pub struct Simulation {
    world: WorldId,
    model: Model<2>,
    state: State,
    work: Workspace<2>,
    scheme: Box<dyn Scheme<2>>,
    blocks: PartPlace,
    surfaces: Vec<SurfacePlace>,
}

impl std::fmt::Debug for Simulation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Simulation")
            .field("scheme", &self.scheme.name())
            .field("model", &self.model)
            .field("step", &self.state.step)
            .field("t", &self.state.t)
            .finish_non_exhaustive()
    }
}

impl Simulation {
    pub(crate) fn start(
        world: WorldId,
        model: Model<2>,
        mut state: State,
        mut work: Workspace<2>,
        mut scheme: Box<dyn Scheme<2>>,
        blocks: PartPlace,
        surfaces: Vec<SurfacePlace>,
    ) -> Result<Self, SimError> {
        scheme.start(&model, &mut state, &mut work)?;
        Ok(Self { world, model, state, work, scheme, blocks, surfaces })
    }

    /// Takes one step and says what happened in it. Whether its contact problem was solved, its
    /// [outcome](StepReport::outcome) tells.
    ///
    /// # Errors
    /// If the step can't be taken; then all is as it was before.
    pub fn step(&mut self) -> Result<StepReport<'_, 2>, SimError> {
        Ok(self.scheme.advance(&self.model, &mut self.state, f64::INFINITY, &mut self.work)?)
    }

    /// Takes so many steps.
    ///
    /// # Errors
    /// If a step can't be taken, or a contact problem is not solved to tolerance.
    pub fn steps(&mut self, number: u64) -> Result<(), SimError> {
        self.complete(Plan::steps(self.state.step.saturating_add(number)))
    }

    /// Goes on to time `t` (s); the last step is cut short where it would go past. A time that is over takes no step.
    ///
    /// # Errors
    /// As [`Simulation::steps`].
    pub fn until(&mut self, t: f64) -> Result<(), SimError> {
        self.complete(Plan::time(t))
    }

    fn complete(&mut self, plan: Plan) -> Result<(), SimError> {
        match self.watch(&plan.when_unsolved(Unsolved::End), &mut [])? {
            Ended::Failed(error) => Err(error.into()),
            Ended::Unconverged => Err(SimError::Unsolved { t: self.state.t }),
            // Nobody watches who could interrupt.
            _ => Ok(()),
        }
    }

    /// Goes on as planned and shows every step to the observers. What ended it is returned, a step that can't be taken included: see [`Ended`].
    ///
    /// # Errors
    /// If an observer fails.
    pub fn watch(&mut self, plan: &Plan, observers: &mut [&mut dyn Observer<2>]) -> Result<Ended, SimError> {
        let ended = run(&self.model, self.scheme.as_mut(), &mut self.state, &mut self.work, plan, observers);
        ended.map_err(|error| match error {
            RunError::Observer(error) => SimError::Observer(error),
            other => SimError::Observer(Box::new(other)),
        })
    }

    /// The time, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.state.t
    }

    /// Coordinates (X, Y, φ) of a block: mass centre in m, angle in rad, counter-clockwise positive.
    ///
    /// # Errors
    /// For a block of another world.
    pub fn position(&self, block: BlockHandle) -> Result<Vector3<f64>, SimError> {
        self.triple(block, &self.state.q[self.blocks.q.clone()])
    }

    /// Velocities (Ẋ, Ẏ, φ̇) of a block, m/s and rad/s.
    ///
    /// # Errors
    /// For a block of another world.
    pub fn velocity(&self, block: BlockHandle) -> Result<Vector3<f64>, SimError> {
        self.triple(block, &self.state.v[self.blocks.v.clone()])
    }

    fn triple(&self, block: BlockHandle, x: &[f64]) -> Result<Vector3<f64>, SimError> {
        let first = 3 * block.of(self.world)?;
        Ok(Vector3::new(x[first], x[first + 1], x[first + 2]))
    }

    /// Deflection (m, upwards) and slope of a beam at `x` (m) from its left end, relative to its supports; `None` beyond its ends.
    ///
    /// # Errors
    /// For a beam of another world.
    pub fn deflection(&self, beam: BeamHandle, x: f64) -> Result<Option<Deflection>, SimError> {
        let SurfacePlace { place, beam } = &self.surfaces[beam.0.of(self.world)?];
        let q = &self.state.q[place.q.clone()];
        Ok(beam.as_ref().and_then(|beam| beam.deflection_at(&q[..beam.dofs()], x)))
    }

    /// Where a surface's bodies, coordinates and velocities are in model and state.
    ///
    /// # Errors
    /// For a surface of another world.
    pub fn place(&self, surface: impl Into<SurfaceHandle>) -> Result<&PartPlace, SimError> {
        Ok(&self.surfaces[surface.into().of(self.world)?].place)
    }

    /// The energy account: where each joule went, and what is not explained.
    #[must_use]
    pub fn ledger(&self) -> &Ledger {
        &self.state.ledger
    }

    /// The state: all that decides the next step.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Goes on from another state of this model, such as the clone of an earlier one.
    ///
    /// # Errors
    /// If it is not one of this model, or can't be stepped from; then the state is as it was.
    pub fn set_state(&mut self, mut state: State) -> Result<(), SimError> {
        state.check(&self.model)?;
        self.scheme.start(&self.model, &mut state, &mut self.work)?;
        self.state = state;
        Ok(())
    }

    /// Takes steps of size `dt` (s) from now on.
    ///
    /// # Errors
    /// If it is not positive and finite, or the matrices for it can't be factorised; then the state is as it was.
    pub fn set_step_size(&mut self, dt: f64) -> Result<(), SimError> {
        let mut state = self.state.clone();
        state.dt = dt;
        self.set_state(state)
    }

    /// The model.
    #[must_use]
    pub fn model(&self) -> &Model<2> {
        &self.model
    }

    /// The workspace: counts of work, the solver and its settings.
    #[must_use]
    pub fn workspace(&self) -> &Workspace<2> {
        &self.work
    }
}
