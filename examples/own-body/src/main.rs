//! A body, an observer and a contact solver of one's own, none of which the crates know: a block
//! slides over the floor against a hanging rod ([`pendulum`]), [`gauss_seidel`] solves the
//! contacts, [`impacts`] writes down each hit.
//!
//! Contact is of the block's corners with the rod's faces; that the rod's tip could meet a side of
//! the block isn't modelled.
//!
//! Before that the shortest body that there is: a [`platform`] on a spring, on which the block is
//! put down.

mod gauss_seidel;
mod impacts;
mod pendulum;
mod platform;

use gauss_seidel::GaussSeidel;
use impacts::Impacts;
use nalgebra::Vector2;
use pendulum::Pendulum;
use platform::Platform;
use std::error::Error;
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::{
    Block, Blocks, ConstantMatrices, Ended, Ground, Model, ModelBuilder, MoreauJean, MoreauJeanSettings, Observer,
    PairLaw, Plan, SolverSettings, State, Unsolved, Workspace, run,
};
use teeter_rigid::{MassProperties, Rectangle, RigidError};

type Done<T> = Result<T, Box<dyn Error + Send + Sync>>;

/// Sides of the block, m, and its distance from the rod at the start.
const SIDES: [f64; 2] = [0.1, 0.06];
const DISTANCE: f64 = 0.1;
const DENSITY: f64 = 700.0;

/// The rod hangs to just below the block's upper corners, so that those are what it meets.
const ROD: Pendulum =
    Pendulum { pivot: Vector2::new(0.0, 0.35), length: 0.3, half_thickness: 0.003, mass: 0.5, gravity: 9.81 };

/// Mass of the platform, kg.
const PLATFORM: f64 = 2.0;

/// The second pair of the model, the block's corners against the rod; the first is those against
/// the floor.
const HIT: u32 = 1;

struct Scene {
    model: Model<2>,
    state: State,
}

fn block() -> Result<(Rectangle, MassProperties), RigidError> {
    let shape = Rectangle::new(SIDES[0], SIDES[1])?;
    Ok((shape, MassProperties::rectangle(&shape, 0.1, DENSITY)?))
}

/// Coordinates: the block's (X, Y, φ), then the rod's θ.
fn scene(rod: &Pendulum, laws: [PairLaw; 2], speed: f64, step: f64) -> Done<Scene> {
    let (shape, mass) = block()?;
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -rod.gravity))).body();
    let hanging = parts.add(rod.clone()).body();
    let ground = parts.add(Ground::flat(0.0)).body();
    let mut pairs = Vec::new();
    for ((pair, law), surface) in (0..).zip(laws).zip([ground, hanging]) {
        let law = parts.law(law);
        pairs.push(PointPair {
            pair,
            law,
            points: shape.corners().to_vec(),
            body,
            surface,
            kinematics: Kinematics::Deformed,
        });
    }
    let model = parts.build(Box::new(PointDetector::new(pairs)))?;
    let start = [rod.pivot.x - rod.half_thickness - DISTANCE - 0.5 * SIDES[0], 0.5 * SIDES[1], 0.0, 0.0];
    let state = State::new(&model, &start, &[speed, 0.0, 0.0, 0.0], step)?;
    Ok(Scene { model, state })
}

/// Runs to the step number `steps`.
fn simulate(scene: &mut Scene, steps: u64, observer: &mut dyn Observer<2>) -> Done<()> {
    let Scene { model, state } = scene;
    let settings = SolverSettings { tolerance: 1e-12, ..SolverSettings::default() };
    let mut work = Workspace::new(model, Box::new(GaussSeidel), settings);
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default())?;
    let plan = Plan::steps(steps).when_unsolved(Unsolved::End);
    match run(model, &mut scheme, state, &mut work, &plan, &mut [observer])? {
        Ended::Complete | Ended::Interrupted => Ok(()),
        ended => Err(format!("the run ended after {} steps: {ended:?}", state.step).into()),
    }
}

/// What the program shows: the block hits the rod and stops under it; the rod comes back, and ends
/// leaning on the block.
fn hit() -> Done<(Scene, Impacts)> {
    let mut scene = scene(&ROD, [PairLaw::new(0.3, 0.0), PairLaw::new(0.1, 0.2)], 1.0, 1e-4)?;
    let mut impacts = Impacts::of(HIT);
    simulate(&mut scene, 30_000, &mut impacts)?;
    Ok((scene, impacts))
}

/// A block at rest on a platform at rest, whose spring is slack. Coordinates: the block's (X, Y,
/// φ), then the platform's height.
fn put_down(stiffness: f64, step: f64) -> Done<Scene> {
    let (shape, mass) = block()?;
    let gravity = 9.81;
    let platform = Platform {
        matrices: ConstantMatrices::mass([[PLATFORM]]).with_stiffness([[stiffness]]),
        weight: PLATFORM * gravity,
    };
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -gravity))).body();
    let surface = parts.add(platform).body();
    let law = parts.law(PairLaw::new(0.5, 0.0));
    let points = shape.corners().to_vec();
    let pair = PointPair { pair: 0, law, points, body, surface, kinematics: Kinematics::Deformed };
    let model = parts.build(Box::new(PointDetector::new(vec![pair])))?;
    let state = State::new(&model, &[0.0, 0.5 * SIDES[1], 0.0, 0.0], &[0.0; 4], step)?;
    Ok(Scene { model, state })
}

fn main() -> Done<()> {
    let mut scene = put_down(800.0, 1e-4)?;
    simulate(&mut scene, 1000, &mut Impacts::of(HIT))?;
    println!("put down on a platform on a spring, the block sinks by {:.2} mm in 0.1 s\n", -1e3 * scene.state.q[3]);

    let (scene, impacts) = hit()?;
    print!("{}", impacts.csv()?);

    let State { t, q, ledger, tally, .. } = &scene.state;
    println!("\nafter {t} s: block at x = {:.4} m, rod at {:.2} deg", q[0], q[3].to_degrees());
    println!("contact problems: {}, at most {} sweeps", tally.contact_steps, tally.max_iterations);
    println!(
        "energy: {:.4} J at the start, {:.4} J now; contact {:+.4} J, friction {:+.4} J; unexplained {:+.1e} J (largest of a step {:.1e} J)",
        ledger.initial.total(),
        ledger.current.total(),
        ledger.sum.contact,
        ledger.sum.friction,
        ledger.sum.residual,
        ledger.largest_residual,
    );
    Ok(())
}

#[cfg(test)]
mod tests;
