//! Two time schemes of one's own beside `moreau-jean`: a block that falls on a corner, rocks and comes to rest.

mod landing;
mod two_phases;

use landing::Landing;
use nalgebra::Vector2;
use std::error::Error;
use std::fmt::Write;
use std::ops::ControlFlow;
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::{
    Block, Blocks, Ended, Ground, Model, ModelBuilder, MoreauJean, MoreauJeanSettings, Observer, ObserverError,
    PairLaw, Plan, Scheme, SolverSettings, State, StepError, StepReport, Unsolved, Workspace, run,
};
use teeter_rigid::{MassProperties, Rectangle};
use teeter_solvers::Auto;
use two_phases::TwoPhases;

/// Width and height, m.
const SIDES: [f64; 2] = [0.03, 0.135];
const GRAVITY: f64 = 9.81;

/// The model, if nothing but weight and elasticity moves its bodies: loads, dampers and drives are left out of both schemes'
/// energy accounts, to keep them short, and so they are refused.
fn unforced(model: &Model<2>) -> Result<&Model<2>, StepError> {
    let forced = |traits: &teeter_integrator::Traits| traits.loaded || traits.damped || !traits.driven.is_empty();
    if model.parts().iter().any(|part| forced(part.traits())) {
        return Err(StepError::Unsupported { what: "loads, damping or prescribed velocities" });
    }
    Ok(model)
}

/// What a run took.
#[derive(Default)]
struct Count {
    steps: u64,
    phases: usize,
}

impl Observer<2> for Count {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        self.steps += 1;
        self.phases += step.phases().count();
        Ok(ControlFlow::Continue(()))
    }
}

/// A block above level ground.
fn model(ground: Ground, law: PairLaw) -> Result<Model<2>, Box<dyn Error + Send + Sync>> {
    let shape = Rectangle::new(SIDES[0], SIDES[1])?;
    let mass = MassProperties::rectangle(&shape, 0.03, 2700.0)?;
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -GRAVITY))).body();
    let surface = parts.add(ground).body();
    let law = parts.law(law);
    let points = shape.corners().to_vec();
    let pair = PointPair { pair: 0, law, points, body, surface, kinematics: Kinematics::Deformed };
    Ok(parts.build(Box::new(PointDetector::new(vec![pair])))?)
}

/// The block let go at rest with its centre at height `y` (m), tilted by `tilt` (rad), after `end` (s) in steps of `dt` (s).
fn fall(
    scheme: &mut dyn Scheme<2>,
    law: PairLaw,
    [y, tilt]: [f64; 2],
    dt: f64,
    end: f64,
) -> Result<(State, Count), Box<dyn Error + Send + Sync>> {
    let model = model(Ground::flat(0.0), law)?;
    let mut state = State::new(&model, &[0.0, y, tilt], &[0.0; 3], dt)?;
    let mut work = workspace(&model);
    let mut count = Count::default();
    let plan = Plan::time(end).when_unsolved(Unsolved::End);
    match run(&model, scheme, &mut state, &mut work, &plan, &mut [&mut count])? {
        Ended::Complete => Ok((state, count)),
        ended => Err(format!("the run ended at {} s: {ended:?}", state.t).into()),
    }
}

fn workspace(model: &Model<2>) -> Workspace<2> {
    Workspace::new(model, Box::new(Auto::<2>::new()), SolverSettings::default())
}

fn schemes() -> Result<[Box<dyn Scheme<2>>; 3], Box<dyn Error + Send + Sync>> {
    let moreau_jean = MoreauJean::new(MoreauJeanSettings::default())?;
    Ok([Box::<Landing>::default(), Box::<TwoPhases>::default(), Box::new(moreau_jean)])
}

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let mut text = String::new();
    writeln!(
        text,
        "{:<12} {:>6} {:>7} {:>9} {:>9} {:>9} {:>10} {:>10}",
        "scheme", "steps", "phases", "x, mm", "y, mm", "tilt, °", "residual", "deepest, m"
    )?;
    for mut scheme in schemes()? {
        let (state, count) = fall(scheme.as_mut(), PairLaw::new(0.4, 0.3), [0.09, 0.05], 1e-4, 1.0)?;
        writeln!(
            text,
            "{:<12} {:>6} {:>7} {:>9.3} {:>9.3} {:>9.3} {:>10.1e} {:>10.1e}",
            scheme.name(),
            count.steps,
            count.phases,
            1e3 * state.q[0],
            1e3 * state.q[1],
            state.q[2].to_degrees(),
            state.ledger.relative_residual(),
            state.tally.max_penetration,
        )?;
    }
    print!("{text}");
    Ok(())
}

#[cfg(test)]
mod tests;
