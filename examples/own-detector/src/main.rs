//! A detector of one's own: discs of different friction roll, slide and bounce down a slope.

mod discs;

use discs::{Disc, Discs};
use nalgebra::{Rotation2, Vector2};
use std::error::Error;
use teeter_integrator::{
    Block, Blocks, Ended, Ground, Model, ModelBuilder, MoreauJean, MoreauJeanSettings, PairLaw, Plan, SolverSettings,
    State, Unsolved, Workspace, run,
};
use teeter_rigid::{MassProperties, Rectangle};
use teeter_solvers::Auto;

type Done<T> = Result<T, Box<dyn Error + Send + Sync>>;

const GRAVITY: f64 = 9.81;
/// rad.
const SLOPE: f64 = 0.3;
/// m and kg.
const RADIUS: f64 = 0.05;
const MASS: f64 = 0.4;
/// m R²/2, of a solid disc.
const INERTIA: f64 = 0.5 * MASS * RADIUS * RADIUS;

/// A disc beside another on the slope, both with this law.
fn model(law: PairLaw) -> Done<Model<2>> {
    let mut parts = ModelBuilder::new();
    let block = || -> Done<Block> {
        Ok(Block::new(MassProperties::new(MASS, INERTIA)?, &Rectangle::new(2.0 * RADIUS, 2.0 * RADIUS)?))
    };
    let blocks = parts.add(Blocks::new(vec![block()?, block()?], Vector2::new(0.0, -GRAVITY)));
    let surface = parts.add(Ground::inclined(SLOPE)).body();
    let law = parts.law(law);
    let disc = |k| Disc { body: blocks.nth_body(k), centre: Vector2::zeros(), radius: RADIUS };
    Ok(parts.build(Box::new(Discs { discs: vec![disc(0), disc(1)], surface, law }))?)
}

/// A vector along the slope and out of it, in the world.
fn from_slope(along: f64, out: f64) -> Vector2<f64> {
    Rotation2::new(SLOPE) * Vector2::new(along, out)
}

/// The other way.
fn to_slope(x: f64, y: f64) -> Vector2<f64> {
    Rotation2::new(-SLOPE) * Vector2::new(x, y)
}

/// Both let go at rest at a height above the slope (m), after `end` (s) in steps of `dt` (s).
fn roll(law: PairLaw, heights: [f64; 2], dt: f64, end: f64) -> Done<State> {
    let model = model(law)?;
    let [a, b] = [0, 1].map(|k| from_slope(k as f64, RADIUS + heights[k]));
    let mut state = State::new(&model, &[a.x, a.y, 0.0, b.x, b.y, 0.7], &[0.0; 6], dt)?;
    let settings = SolverSettings { tolerance: 1e-13, ..SolverSettings::default() };
    let mut work = Workspace::new(&model, Box::new(Auto::<2>::new()), settings);
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default())?;
    let plan = Plan::time(end).when_unsolved(Unsolved::End);
    match run(&model, &mut scheme, &mut state, &mut work, &plan, &mut [])? {
        Ended::Complete => Ok(state),
        ended => Err(format!("the run ended at {} s: {ended:?}", state.t).into()),
    }
}

fn main() -> Done<()> {
    println!("{:>8} {:>12} {:>12} {:>12}", "friction", "rolled, m", "exact, m", "turned, rad");
    for friction in [0.02, 0.05, 0.1, 0.5] {
        let state = roll(PairLaw::new(friction, 0.0), [0.0; 2], 1e-3, 1.0)?;
        let along = to_slope(state.q[0], state.q[1]).x;
        println!("{friction:>8} {along:>12.6} {:>12.6} {:>12.6}", 0.5 * acceleration(friction)[0], state.q[2]);
    }
    Ok(())
}

/// Of a disc on the slope: along it (m/s²), and of its turning (rad/s²). It rolls without sliding from μ = tan α/3 on.
fn acceleration(friction: f64) -> [f64; 2] {
    let (sin, cos) = SLOPE.sin_cos();
    let push = (friction * cos).min(sin / 3.0);
    [-GRAVITY * (sin - push), MASS * GRAVITY * push * RADIUS / INERTIA]
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_detect::{Geometry, conformance::check};

    #[test]
    fn it_conforms() {
        let model = model(PairLaw::new(0.3, 0.2)).unwrap();
        let q = |heights: [f64; 2], angle: f64| {
            let [a, b] = [0, 1].map(|k| from_slope(k as f64, RADIUS + heights[k]));
            [a.x, a.y, angle, b.x, b.y, -2.0 * angle]
        };
        let poses = [q([0.3, 0.2], 0.0), q([0.1, 0.2], 1.0), q([-0.01, 0.1], 2.0), q([-0.02, -1e-3], 3.0)];
        let placed = poses.each_ref().map(|q| model.placed(q).unwrap());
        assert_eq!(check(model.detector(), &placed.each_ref().map(|placed| placed as &dyn Geometry<2>)), []);
    }

    /// Everything is accelerated evenly, which the trapezoidal rule follows exactly.
    #[test]
    fn discs_roll_and_slide_as_the_formulas_say() {
        for friction in [0.0, 0.02, 0.09, 0.11, 0.5, 2.0] {
            let state = roll(PairLaw::new(friction, 0.0), [0.0; 2], 1e-3, 1.0).unwrap();
            let [along, turn] = acceleration(friction);
            for (k, q) in state.q.chunks(3).enumerate() {
                let place = to_slope(q[0], q[1]) - Vector2::new(k as f64, RADIUS);
                // A thousand steps, each right to 1e-13 of its impulse.
                assert!((place.x - 0.5 * along).abs() < 1e-11 && place.y.abs() < 1e-11, "{friction}: {place}");
                assert!((q[2] - 0.7 * k as f64 - 0.5 * turn).abs() < 1e-9, "{friction}: {}", q[2]);
            }
            if friction > SLOPE.tan() / 3.0 {
                assert!((along + turn * RADIUS).abs() < 1e-14, "it rolls");
            }
            assert!(state.ledger.relative_residual() < 1e-13, "{:?}", state.ledger);
        }
    }

    /// A disc that falls from 2 cm onto the slope bounces off it with e times the normal speed, and takes up spin; the other
    /// rolls on meanwhile.
    #[test]
    fn a_disc_bounces_with_spin() {
        let (e, dt, height) = (0.5, 1e-5, 0.02);
        let (sin, cos) = SLOPE.sin_cos();
        let arrival = (2.0 * height / (GRAVITY * cos)).sqrt();
        let end = arrival + 0.01;
        let state = roll(PairLaw::new(0.5, e), [height, 0.0], dt, end).unwrap();
        let v = to_slope(state.v[0], state.v[1]);
        // The impulse that stops the sliding is m/3 of its speed, within the cone; it turns the disc.
        let slide = GRAVITY * sin * arrival;
        let exact = [-(slide * 2.0 / 3.0 + GRAVITY * sin * 0.01), GRAVITY * cos * (e * arrival - 0.01)];
        let spin = slide / 3.0 * MASS * RADIUS / INERTIA;
        // To the speed that weight makes in two steps: one for the time of the impact, one for the impulse of its step.
        let slack = 2.0 * GRAVITY * dt;
        assert!((v.x - exact[0]).abs() < slack && (v.y - exact[1]).abs() < slack, "{v}, not {exact:?}");
        assert!((state.v[2] - spin).abs() < slack / RADIUS, "{}, not {spin}", state.v[2]);
    }
}
