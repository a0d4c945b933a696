//! The bodies of the cases, and runs of them.

use crate::case::Result;
use nalgebra::Vector2;
use std::ops::ControlFlow;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Damping, Section, Support};
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::{
    BeamBody, BeamSurface, Block, Blocks, Ended, Model, ModelBuilder, MoreauJean, MoreauJeanSettings, Observer,
    ObserverError, PairLaw, Plan, SolverSettings, State, StepReport, Subsystem, Workspace, run,
};
use teeter_rigid::{MassProperties, Rectangle};

/// Standard of the cases, m/s².
pub(crate) const GRAVITY: f64 = 9.81;

/// A rectangular block, m and kg/m³.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockSpec {
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) depth: f64,
    pub(crate) density: f64,
}

/// The slender block of the source paper (`docs/theory.md` §8).
pub(crate) const PAPER_BLOCK: BlockSpec = BlockSpec { width: 0.03, height: 0.135, depth: 0.03, density: 2700.0 };

/// A block that slides rather than tips.
pub(crate) const FLAT_BLOCK: BlockSpec = BlockSpec { width: 0.1, height: 0.05, depth: 0.1, density: 2700.0 };

impl BlockSpec {
    /// kg.
    pub(crate) fn mass(&self) -> f64 {
        self.density * self.width * self.height * self.depth
    }

    /// The coordinates of the block turned by `tilt` about its bottom left corner, which is at `corner`.
    pub(crate) fn on_left_corner(&self, corner: Vector2<f64>, tilt: f64) -> [f64; 3] {
        let (sin, cos) = tilt.sin_cos();
        let (x, y) = (0.5 * self.width, 0.5 * self.height);
        [corner.x + cos * x - sin * y, corner.y + sin * x + cos * y, tilt]
    }
}

/// A block above a surface.
pub(crate) fn block_over(
    spec: &BlockSpec,
    gravity: Vector2<f64>,
    law: PairLaw,
    surface: Box<dyn Subsystem<2>>,
) -> Result<Model<2>> {
    let shape = Rectangle::new(spec.width, spec.height)?;
    let mass = MassProperties::rectangle(&shape, spec.depth, spec.density)?;
    let mut parts = ModelBuilder::new();
    let body = parts.add(Box::new(Blocks::new(vec![Block::new(mass, &shape)], gravity)));
    let surface = parts.add(surface);
    let pair = parts.pair(law);
    let points = shape.corners().to_vec();
    let kinematics = Kinematics::Deformed;
    Ok(parts.build(Box::new(PointDetector::new(vec![PointPair { pair, points, body, surface, kinematics }])))?)
}

/// The beam of the source paper (`docs/theory.md` §8) with this damping ratio of its first mode.
pub(crate) fn paper_beam(elements: usize, ratio: f64) -> Result<Arc<Beam>> {
    let mut spec = BeamSpec {
        span: 0.36,
        elements,
        section: Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?,
        supports: [Support::Pinned, Support::Pinned],
        damping: Damping::default(),
    };
    spec.damping.viscous = spec.viscous_for_ratio(1, ratio)?;
    Ok(Arc::new(Beam::new(spec)?))
}

/// A beam with its left end at the origin, contact on its axis.
pub(crate) fn beam_body(beam: &Arc<Beam>) -> BeamBody {
    BeamBody::new(Arc::clone(beam), Vector2::zeros(), BeamSurface::Axis)
}

/// Where a run starts and how it steps.
#[derive(Clone, Debug)]
pub(crate) struct Start {
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) dt: f64,
    pub(crate) theta: f64,
}

struct EachStep<F>(F);

impl<F: FnMut(&State) -> ControlFlow<()>> Observer<2> for EachStep<F> {
    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> std::result::Result<ControlFlow<()>, ObserverError> {
        Ok((self.0)(state))
    }
}

/// Takes up to `steps` steps of Moreau–Jean, shows the state after each, and returns the last. An unsolved contact
/// problem or a failed step is an error: no case is meant to meet one.
pub(crate) fn simulate(
    model: &Model<2>,
    start: &Start,
    steps: u64,
    each: impl FnMut(&State) -> ControlFlow<()>,
) -> Result<State> {
    let mut state = State::new(model, &start.q, &start.v, start.dt)?;
    let mut work = Workspace::new(model, Box::new(teeter_solvers::Auto::new()), SolverSettings::default());
    let mut scheme = MoreauJean::new(MoreauJeanSettings { theta: start.theta, ..MoreauJeanSettings::default() })?;
    let plan = Plan { steps, require_convergence: true };
    match run(model, &mut scheme, &mut state, &mut work, &plan, &mut [&mut EachStep(each)])? {
        Ended::Complete | Ended::Interrupted => Ok(state),
        other => Err(format!("the run ended at t = {} s: {other:?}", state.t).into()),
    }
}
