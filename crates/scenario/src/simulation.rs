//! Builds the model and initial state of a resolved scene, ready to run in memory.

mod assembly;
mod error;

use crate::driven;
use crate::ground_profile;
use crate::overlap::{Outline, Overlap, PlacedOutline, deepest_overlap};
use crate::required::{Extent, Required};
use crate::resolve::SharedParts;
use crate::scene::{Scene, SchemeName, Time};
use crate::static_start::{InitialConfiguration, StaticStart};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_contact::ContactSolver;
use teeter_detect::OnSide;
use teeter_integrator::{
    Account, BeamFace, Ended, EventDriven, EventDrivenSettings, GeneralizedAlpha, GeneralizedAlphaSettings, Model,
    MoreauJean, MoreauJeanClosed, MoreauJeanClosedSettings, MoreauJeanLocated, MoreauJeanLocatedSettings,
    MoreauJeanProjected, MoreauJeanProjectedSettings, MoreauJeanSettings, Observer, Plan, Resolved, ResolvedSettings,
    RunError, Scheme, SettingError, SolverSettings, State, StepError, StepReport, Unsolved, WorkCounts, Workspace, run,
};

pub(crate) use assembly::{BlockBody, Pairs, detector};
use assembly::{assemble, beam_models, block_bodies, lay_out, possible_contacts};
pub use error::BuildError;
pub(crate) use error::{beyond, touching};

pub use crate::layout::{BeamPlace, BlockPlace, ContactNames, ContactPoint, CrowdPlace, Layout, PairPlace, PointName};

/// A scene ready to run.
pub struct Simulation {
    /// The model.
    pub model: Model<2>,
    /// The state, at t = 0 at first.
    pub state: State,
    /// Who is where.
    pub layout: Layout,
    /// When it ends.
    pub plan: Plan,
    /// The result for beams with a static start; `None` without any.
    pub static_start: Option<StaticStart>,
    scheme: Box<dyn Scheme<2>>,
    work: Workspace<2>,
    /// Whether the scheme has been started.
    started: bool,
}

impl std::fmt::Debug for Simulation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Simulation").field("layout", &self.layout).field("plan", &self.plan).finish_non_exhaustive()
    }
}

impl Simulation {
    /// Builds the model of a scene and its initial state. What can't affect the motion from there
    /// on is left out of the model (`docs/required.md`); to start from another state, use
    /// [`Simulation::with_extent`] and the full model.
    ///
    /// # Errors
    /// If a value is invalid, a beam has no equilibrium, or a corner starts inside a surface or a
    /// block inside another.
    pub fn new(scene: &Scene) -> Result<Self, BuildError> {
        Self::with_solver(scene, |solver| solver)
    }

    /// As [`Simulation::new`]; what of beams earlier scenes with the same `shared` had in common with this one is taken from there:
    /// matrices, modes, factors, equilibria. The motion is the same to the last bit.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn with_shared(scene: &Scene, shared: &SharedParts) -> Result<Self, BuildError> {
        Self::build(scene, Extent::Required, |solver| solver, Some(shared))
    }

    /// As [`Simulation::new`]; `wrap` may wrap the scene's contact solver, for example to observe
    /// it.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn with_solver(
        scene: &Scene,
        wrap: impl FnOnce(Box<dyn ContactSolver<2>>) -> Box<dyn ContactSolver<2>>,
    ) -> Result<Self, BuildError> {
        Self::with_extent(scene, Extent::Required, wrap)
    }

    /// As [`Simulation::with_solver`], with the given extent of the model.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn with_extent(
        scene: &Scene,
        extent: Extent,
        wrap: impl FnOnce(Box<dyn ContactSolver<2>>) -> Box<dyn ContactSolver<2>>,
    ) -> Result<Self, BuildError> {
        Self::build(scene, extent, wrap, None)
    }

    fn build(
        scene: &Scene,
        extent: Extent,
        wrap: impl FnOnce(Box<dyn ContactSolver<2>>) -> Box<dyn ContactSolver<2>>,
        shared: Option<&SharedParts>,
    ) -> Result<Self, BuildError> {
        let blocks = block_bodies(scene)?;
        let beams = beam_models(scene, shared)?;
        let ground_start = scene.ground.as_ref().map(|of| driven::ground(of).coordinates(0.0)).unwrap_or_default();
        let required = Required::all(scene);
        let assembled = assemble(scene, &blocks, &beams, &required)?;
        let mut layout = lay_out(scene, &beams, &assembled, required);

        let mut start = InitialConfiguration::placed(scene, &blocks, &beams, &ground_start)?;
        let static_start = start.settle(scene, shared)?;
        let (q, v) = start.coordinates(scene, assembled.model.size().q);
        for (k, pressed) in start.pressed {
            layout.beams[k].pressed = Some(pressed);
        }
        check_start(scene, &assembled.model, &layout, &q)?;
        check_apart(scene, &q)?;

        let mut model = assembled.model;
        if extent == Extent::Required {
            layout.required = Required::of(scene, &layout, &model, &q, &v);
            if !layout.required.removed.is_empty() {
                // The layout of the state stays the same.
                model = assemble(scene, &blocks, &beams, &layout.required)?.model;
            }
        }

        layout.possible_contacts = possible_contacts(&model, &layout);
        let state = State::new(&model, &q, &v, scene.time.step)?;
        let method = &scene.solver.method;
        let solver = match shared {
            Some(shared) => shared.solver(method),
            None => teeter_solvers::plane_solver(method),
        };
        let solver = solver.ok_or_else(|| BuildError::Solver(method.clone()))?;
        let settings =
            SolverSettings { tolerance: scene.solver.tolerance, max_iterations: scene.solver.max_iterations };
        let work = Workspace::new(&model, wrap(solver), settings);
        let scheme = scheme(&scene.time)?;
        let plan = Plan::steps(scene.time.steps()).when_unsolved(if scene.solver.require_convergence {
            Unsolved::End
        } else {
            Unsolved::GoOn
        });
        Ok(Self { model, state, layout, plan, static_start, scheme, work, started: false })
    }

    /// The name of the time scheme.
    #[must_use]
    pub fn scheme(&self) -> &'static str {
        self.scheme.name()
    }

    /// Work counts of its steps so far.
    #[must_use]
    pub fn work_counts(&self) -> WorkCounts {
        self.work.counts
    }

    /// Lets steps solve contacts of bodies that stand apart on so many threads, at least one, which is the default. The motion is
    /// the same to the last bit.
    #[cfg(feature = "parallel")]
    pub fn set_threads(&mut self, threads: usize) {
        self.work.set_threads(threads);
    }

    /// Number of free velocities of the model, without those of held dofs and of beams at rest,
    /// which are only stored in the state.
    #[must_use]
    pub fn dofs(&self) -> usize {
        let held = |k: usize, place: &BeamPlace| match self.layout.required.rests(k) {
            Some(_) => place.range.len(),
            None => place.range.len() - place.free_dofs(),
        };
        self.model.size().v - self.layout.beams.iter().enumerate().map(|(k, place)| held(k, place)).sum::<usize>()
    }

    /// Runs to the plan's end, passing every step to the observers. The state is that after the
    /// last step taken.
    ///
    /// # Errors
    /// If an observer fails.
    pub fn run(&mut self, observers: &mut [&mut dyn Observer<2>]) -> Result<Ended, RunError> {
        let plan = self.plan;
        self.run_by(&plan, observers)
    }

    /// As [`Simulation::run`], but to time `t` (s) instead of the plan's end: the last step is
    /// shortened if necessary.
    ///
    /// # Errors
    /// If an observer fails.
    pub fn run_until(&mut self, t: f64, observers: &mut [&mut dyn Observer<2>]) -> Result<Ended, RunError> {
        self.run_by(&Plan::time(t).when_unsolved(self.plan.unsolved), observers)
    }

    fn run_by(&mut self, plan: &Plan, observers: &mut [&mut dyn Observer<2>]) -> Result<Ended, RunError> {
        self.started = true;
        run(&self.model, self.scheme.as_mut(), &mut self.state, &mut self.work, plan, observers)
    }

    /// Takes one step, independent of the plan, and returns its report.
    ///
    /// ```
    /// # use teeter_scenario::simulation::Simulation;
    /// # let text = r#"
    /// #     [time]
    /// #     end = "0.1 s"
    /// #     step = "1 ms"
    /// #     [ground]
    /// #     [material.wood]
    /// #     density = "600 kg/m^3"
    /// #     [block.cube]
    /// #     material = "wood"
    /// #     width = "10 cm"
    /// #     height = "10 cm"
    /// #     depth = "10 cm"
    /// #     position = ["0 m", "6 cm"]
    /// #     [contact.floor]
    /// #     between = ["cube", "ground"]
    /// #     friction = 0.4
    /// # "#;
    /// # let resolved = teeter_scenario::load(text.as_bytes(), "cube.toml", "cube", &[])?;
    /// let mut simulation = Simulation::new(&resolved.scene)?;
    /// while simulation.step()?.contacts().next().is_none() {}
    /// let fall = (2.0_f64 * 0.01 / 9.81).sqrt();
    /// assert!((simulation.state.t - fall).abs() < 2e-3, "it touches after {fall} s");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the step can't be taken; the state is then unchanged.
    pub fn step(&mut self) -> Result<StepReport<'_, 2>, StepError> {
        let Self { model, state, scheme, work, started, .. } = self;
        if !*started {
            scheme.start(model, state, work)?;
            *started = true;
        }
        scheme.advance(model, state, f64::INFINITY, work)
    }

    /// Abandons the step being taken when `flag` is set, even within the iterations of the contact
    /// solver: a run then ends as [`Ended::Interrupted`] with the state of the last whole step, and
    /// [`Simulation::step`] fails. Cleared, the flag lets it go on to the same bytes.
    pub fn cancelled_by(&mut self, flag: Arc<AtomicBool>) {
        self.work.cancel = Some(flag);
    }

    /// Sets whether steps keep the energy account (default: yes). Without it they are faster, and
    /// `state.ledger` and the penetration in `state.tally` are not updated.
    pub fn keep_account(&mut self, account: Account) {
        self.work.account = account;
    }
}

fn scheme(time: &Time) -> Result<Box<dyn Scheme<2>>, SettingError> {
    let Time { theta, activation_gamma, gap_tolerance, spectral_radius, .. } = *time;
    Ok(match time.scheme {
        SchemeName::MoreauJean => {
            Box::new(MoreauJean::new(MoreauJeanSettings { theta, activation_gamma, gap_tolerance })?)
        }
        SchemeName::MoreauJeanClosed => Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings { gap_tolerance })?),
        SchemeName::Resolved => {
            Box::new(Resolved::new(ResolvedSettings { gap_tolerance, ..ResolvedSettings::default() })?)
        }
        SchemeName::MoreauJeanProjected => {
            Box::new(MoreauJeanProjected::new(MoreauJeanProjectedSettings { gap_tolerance })?)
        }
        SchemeName::GeneralizedAlpha => {
            Box::new(GeneralizedAlpha::new(GeneralizedAlphaSettings { spectral_radius, gap_tolerance })?)
        }
        SchemeName::EventDriven => Box::new(EventDriven::new(EventDrivenSettings::default())?),
        SchemeName::MoreauJeanLocated => Box::new(MoreauJeanLocated::new(MoreauJeanLocatedSettings { gap_tolerance })?),
    })
}

/// Refuses a start with blocks inside each other.
fn check_apart(scene: &Scene, q: &[f64]) -> Result<(), BuildError> {
    let boxes: Vec<PlacedOutline> = scene
        .blocks
        .iter()
        .zip(q.chunks_exact(3))
        .map(|(block, q)| PlacedOutline::new([q[0], q[1]], q[2], &Outline::of(block)))
        .collect();
    match deepest_overlap(&boxes, START_TOLERANCE) {
        None => Ok(()),
        Some(Overlap { first, second, depth }) => Err(BuildError::Overlap {
            first: scene.blocks[first].name.clone(),
            second: scene.blocks[second].name.clone(),
            depth,
        }),
    }
}

/// A corner may start below its surface by this fraction of its block's larger side, because of the
/// rounding of decimal positions.
const START_TOLERANCE: f64 = 1e-9;

/// Refuses a start with a corner inside a surface.
fn check_start(scene: &Scene, model: &Model<2>, layout: &Layout, q: &[f64]) -> Result<(), BuildError> {
    let mut candidates = Vec::new();
    model.candidates(q, 0.0, &mut candidates)?;
    for candidate in &candidates {
        let pair = candidate.id.pair() as usize;
        // Blocks are compared as a whole, and so are those of a crowd.
        let Some(contact) = scene.contacts.get(pair).filter(|contact| contact.other_block().is_none()) else {
            continue;
        };
        let block = &scene.blocks[contact.block];
        let tolerance = START_TOLERANCE * block.width.max(block.height);
        if -candidate.gap > tolerance {
            let between = &layout.pairs[pair].between;
            let surface = if between[0] == block.name { &between[1] } else { &between[0] };
            return Err(BuildError::Penetration {
                block: block.name.clone(),
                corner: match layout.pairs[pair].point(candidate.id) {
                    Some(point) => layout.pairs[pair].points[point].name.clone(),
                    None => candidate.id.point().to_string(),
                },
                on_side: contact.sides && OnSide::from_number(candidate.id.point()).is_some(),
                lower: contact.face == BeamFace::Lower,
                surface: surface.clone(),
                depth: -candidate.gap,
                tolerance,
            });
        }
    }
    match ground_profile::crest_inside(scene, layout, q) {
        Some((block, crest)) => Err(BuildError::CrestInside { block: scene.blocks[block].name.clone(), crest }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sweeps share models among threads, and front ends simulations.
    #[test]
    fn a_simulation_can_be_sent_and_shared() {
        fn shared<T: Send + Sync>() {}
        shared::<Simulation>();
        shared::<Model<2>>();
        shared::<State>();
    }
}
