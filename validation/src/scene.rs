//! The bodies of the cases, and runs of them.

use crate::case::{Check, Result};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Damping, Section};
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::{
    BeamBody, BeamSurface, Block, Blocks, Ended, EventDriven, EventDrivenSettings, Model, ModelBuilder, MoreauJean,
    MoreauJeanClosed, MoreauJeanClosedSettings, MoreauJeanLocated, MoreauJeanLocatedSettings, MoreauJeanSettings,
    Observer, ObserverError, PairLaw, Plan, Scheme, SolverSettings, State, StepReport, Subsystem, Unsolved, Workspace,
    run,
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
    points_over(spec, shape.corners().to_vec(), gravity, law, surface)
}

/// The same with these points of the block in place of its corners, m from its centre.
pub(crate) fn points_over(
    spec: &BlockSpec,
    points: Vec<Vector2<f64>>,
    gravity: Vector2<f64>,
    law: PairLaw,
    surface: Box<dyn Subsystem<2>>,
) -> Result<Model<2>> {
    let shape = Rectangle::new(spec.width, spec.height)?;
    let mass = MassProperties::rectangle(&shape, spec.depth, spec.density)?;
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], gravity)).body();
    let surface = parts.add_boxed(surface).body();
    let law = parts.law(law);
    let kinematics = Kinematics::Deformed;
    Ok(parts.build(Box::new(PointDetector::new(vec![PointPair {
        pair: 0,
        law,
        points,
        body,
        surface,
        kinematics,
    }])))?)
}

/// The beam of the source paper (`docs/theory.md` §8) with this damping ratio of its first mode.
pub(crate) fn paper_beam(elements: usize, ratio: f64) -> Result<Arc<Beam>> {
    damped_paper_beam(elements, ratio, 0.0)
}

/// The same with Rayleigh's a₁ (s) besides, which damps the high modes.
pub(crate) fn damped_paper_beam(elements: usize, ratio: f64, rayleigh_stiffness: f64) -> Result<Arc<Beam>> {
    let mut spec = BeamSpec::new(0.36, elements, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?)
        .damped(Damping::none().with_rayleigh_stiffness(rayleigh_stiffness));
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

/// Which scheme takes the steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stepping {
    MoreauJean,
    MoreauJeanClosed,
    MoreauJeanLocated,
    EventDriven,
}

impl Stepping {
    /// Those of a fixed step, the one of `docs/theory.md` first.
    pub(crate) const ALL: [Self; 2] = [Self::MoreauJean, Self::MoreauJeanClosed];

    /// The name by which users choose it.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::MoreauJean => MoreauJean::<2>::NAME,
            Self::MoreauJeanClosed => MoreauJeanClosed::<2>::NAME,
            Self::MoreauJeanLocated => MoreauJeanLocated::<2>::NAME,
            Self::EventDriven => EventDriven::NAME,
        }
    }

    fn scheme(self, theta: f64) -> Result<Box<dyn Scheme<2>>> {
        Ok(match self {
            Self::MoreauJean => {
                Box::new(MoreauJean::new(MoreauJeanSettings { theta, ..MoreauJeanSettings::default() })?)
            }
            Self::MoreauJeanClosed if theta == 0.5 => {
                Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default())?)
            }
            Self::MoreauJeanLocated if theta == 0.5 => {
                Box::new(MoreauJeanLocated::new(MoreauJeanLocatedSettings::default())?)
            }
            Self::EventDriven => Box::new(EventDriven::new(EventDrivenSettings::default())?),
            Self::MoreauJeanClosed | Self::MoreauJeanLocated => {
                return Err(format!("{} knows no θ but 1/2", self.name()).into());
            }
        })
    }
}

/// Runs of one scheme, and what their energy accounts have in common.
#[derive(Clone, Debug)]
pub(crate) struct Runner {
    stepping: Stepping,
    /// Largest residual of a step, relative to the energy scale of its run.
    residual: f64,
    /// Largest gain of a step, Δ(T+V) without the work of loads and drives, relative to the same.
    gain: f64,
}

/// Largest residual of a step's energy account, relative to the energy scale.
const RESIDUAL: f64 = 1e-12;

/// What a step may gain by rounding, relative to the energy scale: the energies of start and end differ by some 1e-16 of it.
pub(crate) const GAIN: f64 = 1e-13;

impl Runner {
    /// No runs yet.
    pub(crate) fn new(stepping: Stepping) -> Self {
        Self { stepping, residual: 0.0, gain: 0.0 }
    }

    /// The scheme.
    pub(crate) fn stepping(&self) -> Stepping {
        self.stepping
    }

    /// The scheme's name.
    pub(crate) fn name(&self) -> &'static str {
        self.stepping.name()
    }

    /// The largest gain of energy in a step, relative to the energy scale of its run.
    pub(crate) fn gain(&self) -> f64 {
        self.gain
    }

    /// Takes up to `steps` steps, shows each with the state after it, and returns the last state. An unsolved contact problem
    /// or a failed step is an error: no case is meant to meet one.
    pub(crate) fn run(
        &mut self,
        model: &Model<2>,
        start: &Start,
        steps: u64,
        each: impl FnMut(&StepReport<'_, 2>, &State) -> ControlFlow<()>,
    ) -> Result<State> {
        let mut state = State::new(model, &start.q, &start.v, start.dt)?;
        let mut work = Workspace::new(model, Box::new(teeter_solvers::Auto::new()), SolverSettings::default());
        let mut scheme = self.stepping.scheme(start.theta)?;
        let plan = Plan::steps(steps).when_unsolved(Unsolved::End);
        let mut observer = EachStep { each, gain: 0.0 };
        let ended = run(model, scheme.as_mut(), &mut state, &mut work, &plan, &mut [&mut observer])?;
        // Without an energy scale nothing moves.
        let scale = state.ledger.scale.max(f64::MIN_POSITIVE);
        self.residual = self.residual.max(state.ledger.relative_residual());
        self.gain = self.gain.max(observer.gain / scale);
        match ended {
            Ended::Complete | Ended::Interrupted => Ok(state),
            other => Err(format!("{}: the run ended at t = {} s: {other:?}", self.name(), state.t).into()),
        }
    }

    /// The rows that every run of a scheme owes: its energy account closes, and, where the scheme promises it, no step gains.
    pub(crate) fn account(&self) -> Vec<Check> {
        let mut rows = self.account_of_drives();
        if let (Stepping::MoreauJeanClosed, Some(gain)) = (self.stepping, rows.last_mut()) {
            *gain = Check::worst(gain.quantity.clone(), self.gain, GAIN);
        }
        rows
    }

    /// The same where bodies are driven: work on a contact with them is relative to their motion, and no scheme promises its sign.
    pub(crate) fn account_of_drives(&self) -> Vec<Check> {
        let name = self.name();
        let residual = format!("{name}: largest residual of a step's energy, relative");
        let gain = format!("{name}: largest gain of energy in a step, relative");
        vec![Check::worst(residual, self.residual, RESIDUAL), Check::reported(gain, self.gain)]
    }
}

struct EachStep<F> {
    each: F,
    gain: f64,
}

impl<F: FnMut(&StepReport<'_, 2>, &State) -> ControlFlow<()>> Observer<2> for EachStep<F> {
    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> std::result::Result<ControlFlow<()>, ObserverError> {
        let e = &step.energy();
        self.gain = self.gain.max(e.contact + e.friction + e.viscous + e.numerical + e.residual);
        Ok((self.each)(step, state))
    }
}
