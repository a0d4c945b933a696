//! The harness for schemes: it checks the contract that the documentation of [`Scheme`] states.
//!
//! Its scenes are a block over rigid ground, and a mass on a spring. Properties that fail are
//! returned as a list, with numbers.

use crate::{
    Block, Blocks, Bodies, Compliance, Dynamics, Energy, FactorError, Ground, ImpactLaw, Model, ModelBuilder, PairLaw,
    Rows, Scheme, Size, SolverSettings, State, StepError, Vector, Weights, Workspace,
};
use nalgebra::Vector2;
use std::error::Error;
use teeter_contact::ContactSolver;
use teeter_detect::{Frame, Kinematics, PointDetector, PointPair};
use teeter_rigid::{MassProperties, Rectangle};

/// What must hold for a scheme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SchemeProperty {
    /// Errors of a smooth motion fall with the step, at least at first order.
    Order,
    /// The energy account explains every change of energy.
    EnergyIdentity,
    /// Momentum changes by weight and the reported impulses, phase by phase.
    Momentum,
    /// Phases follow each other from the step's start to its end.
    Phases,
    /// No step goes past the time that it must not go past, and that time is reached.
    Until,
    /// After an error the state is as before.
    Errors,
    /// Every law gives the right rebound, or is refused.
    Laws,
    /// A run that continues from a state with a new scheme ends in the same bytes.
    Resume,
    /// Without the warm start a run ends in the same motion.
    WarmStart,
}

/// A property that doesn't hold.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{property:?}: {what}")]
pub struct SchemeFailure {
    /// Which.
    pub property: SchemeProperty,
    /// How, with numbers.
    pub what: String,
}

/// Makes the scheme to be checked, and a contact solver for it.
pub trait Made {
    /// A new scheme.
    fn scheme(&self) -> Box<dyn Scheme<2>>;
    /// A solver.
    fn solver(&self) -> Box<dyn ContactSolver<2>>;
}

impl<S: Fn() -> Box<dyn Scheme<2>>, C: Fn() -> Box<dyn ContactSolver<2>>> Made for (S, C) {
    fn scheme(&self) -> Box<dyn Scheme<2>> {
        self.0()
    }

    fn solver(&self) -> Box<dyn ContactSolver<2>> {
        self.1()
    }
}

/// Checks all [properties](SchemeProperty) of a scheme, and returns those that fail.
///
/// # Errors
/// If a scene of the harness can't be made, which is a fault of this crate.
pub fn check_scheme(made: &impl Made) -> Result<Vec<SchemeFailure>, Box<dyn Error>> {
    let mut check = Check { made, failures: Vec::new() };
    check.order()?;
    check.rocking()?;
    check.until()?;
    check.errors()?;
    check.laws()?;
    check.resume()?;
    Ok(check.failures)
}

const GRAVITY: f64 = 9.81;
const DENSITY: f64 = 2700.0;
/// Width, height and depth of the block, m.
const SIDES: [f64; 3] = [0.03, 0.135, 0.03];

struct Check<'a, M> {
    made: &'a M,
    failures: Vec<SchemeFailure>,
}

/// A block over level ground, with this law.
fn block_over_ground(law: PairLaw) -> Result<Model<2>, Box<dyn Error>> {
    let shape = Rectangle::new(SIDES[0], SIDES[1])?;
    let mass = MassProperties::rectangle(&shape, SIDES[2], DENSITY)?;
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -GRAVITY))).body();
    let surface = parts.add(Ground::flat(0.0)).body();
    let law = parts.law(law);
    let points = shape.corners().to_vec();
    let pair = PointPair { pair: 0, law, points, body, surface, kinematics: Kinematics::Deformed };
    Ok(parts.build(Box::new(PointDetector::new(vec![pair])))?)
}

impl<M: Made> Check<'_, M> {
    fn hold(&mut self, property: SchemeProperty, good: bool, what: impl FnOnce() -> String) {
        if !good {
            self.failures.push(SchemeFailure { property, what: what() });
        }
    }

    fn workspace(&self, model: &Model<2>) -> Workspace<2> {
        Workspace::new(model, self.made.solver(), SolverSettings::default())
    }

    /// Steps until a time; the state there.
    fn run(&self, model: &Model<2>, mut state: State, until: f64) -> Result<State, StepError> {
        let (mut scheme, mut work) = (self.made.scheme(), self.workspace(model));
        scheme.start(model, &mut state, &mut work)?;
        while !state.has_reached(until) {
            scheme.advance(model, &mut state, until, &mut work)?;
        }
        Ok(state)
    }

    fn order(&mut self) -> Result<(), Box<dyn Error>> {
        let mut parts = ModelBuilder::new();
        parts.add(Oscillator);
        let model = parts.build(Box::new(PointDetector::new(Vec::new())))?;
        let error = |dt: f64| -> Result<f64, Box<dyn Error>> {
            let end = self.run(&model, State::new(&model, &[1.0], &[0.0], dt)?, 1.0)?;
            Ok((end.q[0] - 1.0_f64.cos()).abs())
        };
        let (coarse, fine) = (error(1e-2)?, error(5e-3)?);
        let order = (coarse / fine).log2();
        let good = order > 0.9 || fine < 1e-12;
        self.hold(SchemeProperty::Order, good, || {
            format!("errors {coarse:e} and {fine:e} in steps h and h/2: order {order:.2}")
        });
        Ok(())
    }

    /// A tilted block that rocks and slides: energy, momentum, phases, step by step.
    fn rocking(&mut self) -> Result<(), Box<dyn Error>> {
        let model = block_over_ground(PairLaw::new(0.2, 0.3))?;
        let mut state = State::new(&model, &[0.0, 0.075, 0.1], &[0.4, 0.0, 0.0], 1e-4)?;
        let mass = SIDES.iter().product::<f64>() * DENSITY;
        let (mut scheme, mut work) = (self.made.scheme(), self.workspace(&model));
        scheme.start(&model, &mut state, &mut work)?;
        let (mut off, mut gap, mut touched) = (0.0_f64, 0.0_f64, false);
        while !state.has_reached(0.3) {
            let before = state.t;
            let step = scheme.advance(&model, &mut state, 0.3, &mut work)?;
            let mut at = before;
            for phase in step.phases() {
                gap = gap.max((phase.start - at).abs());
                at = phase.end;
                let push = phase.contacts.iter().fold(Vector2::zeros(), |sum, contact| {
                    let side = if contact.sides[0].body.0 == 0 { 1.0 } else { -1.0 };
                    sum + contact.frame.transpose() * contact.p * side
                });
                let gain = Vector2::new(phase.v[1][0] - phase.v[0][0], phase.v[1][1] - phase.v[0][1]) * mass;
                let weight = Vector2::new(0.0, -GRAVITY * mass * phase.duration);
                touched |= push.y > 0.0;
                off = off.max((gain - weight - push).norm());
            }
            gap = gap.max((step.t_end - at).abs()).max((step.t_start - before).abs());
            let end = step.t_end;
            gap = gap.max((end - state.t).abs());
        }
        self.hold(SchemeProperty::Phases, gap == 0.0 && touched, || {
            format!("times {gap:e} s apart; touched: {touched}")
        });
        self.hold(SchemeProperty::Momentum, off < 1e-11 * mass, || format!("{off:e} N·s more or less than pushed"));
        let residual = state.ledger.relative_residual();
        self.hold(SchemeProperty::EnergyIdentity, residual < 1e-10, || {
            format!("{residual:e} of the scene's energy unexplained")
        });
        Ok(())
    }

    fn until(&mut self) -> Result<(), Box<dyn Error>> {
        let model = block_over_ground(PairLaw::new(0.2, 0.0))?;
        let mut state = State::new(&model, &[0.0, 0.07, 0.0], &[0.0; 3], 1e-3)?;
        let (mut scheme, mut work) = (self.made.scheme(), self.workspace(&model));
        scheme.start(&model, &mut state, &mut work)?;
        for until in [0.0104, 0.0110004, 0.02, 0.034_567_89] {
            let mut steps = 0;
            while !state.has_reached(until) && steps < 1000 {
                let step = scheme.advance(&model, &mut state, until, &mut work)?;
                let (end, h) = (step.t_end, step.h);
                steps += 1;
                self.hold(SchemeProperty::Until, end <= until + 1e-9 * h, || {
                    format!("a step went to {end} s, past {until} s")
                });
            }
            let t = state.t;
            self.hold(SchemeProperty::Until, (t - until).abs() <= 1e-12, || {
                format!("{until} s was not reached in {steps} steps: {t} s")
            });
        }
        Ok(())
    }

    fn errors(&mut self) -> Result<(), Box<dyn Error>> {
        let model = block_over_ground(PairLaw::new(0.2, 0.0))?;
        let good = State::new(&model, &[0.0, 0.07, 0.0], &[0.0; 3], 1e-3)?;
        let mut fast = good.clone();
        (fast.v[1], fast.dt) = (1e308, 1e10);
        let mut short = good.clone();
        short.q.pop();
        for (what, bad) in [("a motion that diverges", fast), ("a state that is too short", short)] {
            let (mut scheme, mut work) = (self.made.scheme(), self.workspace(&model));
            scheme.start(&model, &mut good.clone(), &mut work)?;
            let mut state = bad.clone();
            let failed = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).is_err();
            self.hold(SchemeProperty::Errors, failed, || format!("{what} is no error"));
            self.hold(SchemeProperty::Errors, state == bad, || format!("{what} changes the state"));
        }
        Ok(())
    }

    /// A block falls flat from a height of 1 mm.
    fn laws(&mut self) -> Result<(), Box<dyn Error>> {
        let arrival = (2.0 * GRAVITY * 1e-3_f64).sqrt();
        let contact = 1.0 / GRAVITY * arrival;
        let standard = |e| PairLaw::new(0.0, e);
        for (law, back) in [
            (standard(0.0), [0.0, 0.0]),
            (standard(0.6), [0.6, 0.6]),
            (standard(0.6).with_impact(ImpactLaw::Poisson), [0.6, 0.6]),
            (standard(0.6).with_impact(ImpactLaw::Energetic), [0.6, 0.6]),
            (standard(0.0).with_impact(ImpactLaw::KelvinVoigt { stiffness: 1e8, damping: 0.0 }), [0.8, 1.0]),
            (
                standard(0.0).with_impact(ImpactLaw::HuntCrossley { stiffness: 1e8, damping: 0.0, exponent: 1.0 }),
                [0.8, 1.0],
            ),
        ] {
            let model = block_over_ground(law)?;
            let start = State::new(&model, &[0.0, 0.0685, 0.0], &[0.0; 3], 1e-5)?;
            let t = contact + 1e-3;
            let v = match self.run(&model, start, t) {
                Ok(end) => end.v[1],
                Err(StepError::Problem { .. } | StepError::Unsupported { .. }) => continue,
                Err(error) => return Err(error.into()),
            };
            let [least, most] = back.map(|e| if e > 0.0 { e * arrival - GRAVITY * 1e-3 } else { 0.0 });
            let good = v >= least - 0.01 * arrival && v <= most + 0.01 * arrival;
            self.hold(SchemeProperty::Laws, good, || {
                format!("{law:?}: {v} m/s after the impact, {least} to {most} expected")
            });
        }
        Ok(())
    }

    fn resume(&mut self) -> Result<(), Box<dyn Error>> {
        let model = block_over_ground(PairLaw::new(0.4, 0.2))?;
        let start = State::new(&model, &[0.0, 0.07, 0.05], &[0.1, 0.0, 0.0], 1e-4)?;
        let (mut scheme, mut work) = (self.made.scheme(), self.workspace(&model));
        let mut state = start;
        scheme.start(&model, &mut state, &mut work)?;
        let mut middle = None;
        for step in 0..4000 {
            if step == 2000 {
                middle = Some(state.clone());
            }
            scheme.advance(&model, &mut state, f64::INFINITY, &mut work)?;
        }
        let Some(middle) = middle else { return Ok(()) };
        let mut cold = middle.clone();
        cold.warm.clear();
        let mut ends = Vec::new();
        for mut from in [middle, cold] {
            let (mut scheme, mut work) = (self.made.scheme(), self.workspace(&model));
            scheme.start(&model, &mut from, &mut work)?;
            while from.step < state.step {
                scheme.advance(&model, &mut from, f64::INFINITY, &mut work)?;
            }
            ends.push(from);
        }
        self.hold(SchemeProperty::Resume, ends[0] == state, || {
            format!("from the middle: {:?}, in one go: {:?}", ends[0].q, state.q)
        });
        let off = ends[1].q.iter().zip(&state.q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        self.hold(SchemeProperty::WarmStart, off < 1e-6, || format!("places {off:e} apart without the warm start"));
        Ok(())
    }
}

/// Mass 1 on a spring of stiffness 1.
struct Oscillator;

struct OscillatorCompliance(Weights);

impl Dynamics<2> for Oscillator {
    fn size(&self) -> Size {
        Size { q: 1, v: 1, bodies: 0, row: 0 }
    }

    fn internal_force(&self, q: &[f64], _v: &[f64], f: &mut [f64]) {
        f[0] -= q[0];
    }

    fn apply(&self, w: Weights, _q: &[f64], x: &[f64], y: &mut [f64]) {
        y[0] += (w.mass + w.stiffness) * x[0];
    }

    fn energy(&self, q: &[f64], v: &[f64]) -> Energy {
        Energy { kinetic: 0.5 * v[0] * v[0], elastic: 0.5 * q[0] * q[0], gravity: 0.0 }
    }

    fn factor(&self, w: Weights, _q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        Ok(Box::new(OscillatorCompliance(w)))
    }
}

impl Bodies<2> for Oscillator {
    fn place(&self, _: u32, _: &[f64], local: &[Vector<2>], out: &mut [Vector<2>]) {
        out.copy_from_slice(local);
    }

    fn rows(&self, _: u32, _: &[f64], _: &Vector<2>, _: &Frame<2>, _: &mut Rows<'_, 2>) -> usize {
        0
    }
}

impl Compliance<2> for OscillatorCompliance {
    fn weights(&self) -> Weights {
        self.0
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        self.0 = w;
        Ok(())
    }

    fn solve(&mut self, f: &mut [f64]) {
        f[0] /= self.0.mass + self.0.stiffness;
    }
}
