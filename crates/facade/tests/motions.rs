//! Motions with known answers, and the same motion built by hand.

use std::sync::Arc;
use teeter_sim::detect::{PointDetector, PointPair};
use teeter_sim::integrator::{Block, Blocks, ModelBuilder, Workspace, run};
use teeter_sim::prelude::*;

type Tested = Result<(), Box<dyn std::error::Error>>;

const GRAVITY: f64 = 9.81;

fn rocker() -> Result<(Rectangle, MassProperties), teeter_sim::rigid::RigidError> {
    let shape = Rectangle::new(0.03, 0.135)?;
    Ok((shape, MassProperties::rectangle(&shape, 0.03, 2700.0)?))
}

/// The ruler of the front page, its first mode damped by this ratio.
fn ruler(ratio: f64) -> Result<Beam, teeter_sim::beam::BeamError> {
    let mut spec = BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?);
    spec.damping.viscous = spec.viscous_for_ratio(1, ratio)?;
    Beam::new(spec)
}

#[test]
fn a_dropped_block_comes_to_rest_at_its_height_in_the_step_that_the_scheme_says() -> Tested {
    let (shape, mass) = rocker()?;
    let (h, falling) = (1e-3, 50_u32);
    // After n steps of θ = ½ the gap is d − ½g(nh)², and the step that lands ends at the place which was predicted, γ = ½ of a step ahead: at a
    // gap of exactly 0 for this d.
    let steps = f64::from(falling);
    let height = 0.5 * GRAVITY * h * h * steps * (steps + 1.0);

    let mut world = World::new(Vector2::new(0.0, -GRAVITY));
    let ground = world.ground(Ground::flat(0.2));
    let block = world.block(&shape, mass, At::standing(0.1, 0.2 + height));
    world.contact(block, ground, PairLaw::new(0.5, 0.0));
    let mut run = world.simulate(h)?;
    run.steps(u64::from(falling))?;
    assert!((run.velocity(block)?.y + GRAVITY * h * steps).abs() < 1e-14, "free fall");
    run.steps(1)?;
    assert!(run.velocity(block)?.norm() < 1e-14, "landed in one step");
    run.until(1.0)?;
    assert_eq!(run.state().step, 1000);
    // Rounding of 50 steps of free fall.
    assert!((run.position(block)? - Vector3::new(0.1, 0.2 + 0.0675, 0.0)).norm() < 1e-14);
    assert!(
        (run.ledger().sum.contact + mass.mass * GRAVITY * height).abs() < 1e-13,
        "the impact took what the fall gave"
    );
    Ok(())
}

#[test]
fn a_block_at_rest_on_a_beam_deflects_it_by_the_static_answer() -> Tested {
    let (shape, mass) = rocker()?;
    let beam = Arc::new(ruler(1.0)?);
    let mut statics = vec![0.0; beam.dofs()];
    for foot in [0.165, 0.195] {
        beam.add_point_load(foot, -0.5 * mass.mass * GRAVITY, &mut statics)?;
    }
    beam.solve_static(&mut statics)?;

    let mut world = World::new(Vector2::new(0.0, -GRAVITY));
    let table = world.beam(Arc::clone(&beam), Vector2::new(0.0, 0.5));
    let block = world.block(&shape, mass, At::standing(0.18, 0.5));
    world.contact(block, table, PairLaw::new(0.0, 0.0));
    // θ = 1 rests where any θ does, and is soon there: it damps the high modes, which θ = ½ leaves to the viscous damping.
    world.use_scheme(Box::new(MoreauJean::new(MoreauJeanSettings { theta: 1.0, ..MoreauJeanSettings::default() })?));
    let mut run = world.simulate(1e-3)?;
    run.until(5.0)?;

    assert!(run.velocity(block)?.norm() < 1e-12, "at rest");
    for x in [0.09, 0.165, 0.18, 0.195, 0.3] {
        let expected = beam.deflection_at(&statics, x).ok_or("off the beam")?.w;
        let found = run.deflection(table, x)?.ok_or("off the beam")?.w;
        // Without friction each foot carries half the weight, whatever the slope, and five seconds are some fifty decay times: nothing but
        // rounding is left.
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} at {x}, not {expected}");
    }
    let feet = beam.deflection_at(&statics, 0.165).ok_or("off the beam")?.w;
    assert!((run.position(block)?.y - (0.5 + 0.0675 + feet)).abs() < 1e-13, "its base is on the beam");
    assert_eq!(run.deflection(table, 0.37)?, None);
    Ok(())
}

#[test]
fn the_motion_is_that_of_the_model_built_by_hand_to_the_last_bit() -> Tested {
    let (shape, mass) = rocker()?;
    let gravity = Vector2::new(0.0, -GRAVITY);
    let beam = Arc::new(ruler(0.01)?);
    let starts =
        [At::standing(0.18, 0.0).tilted(0.05), At::centre(-0.2, 0.1).tilted(0.3).moving(Vector3::new(1.0, 0.0, 2.0))];
    let laws = [PairLaw::new(0.5, 0.0), PairLaw::new(0.3, 0.6).with_impact(ImpactLaw::Poisson)];

    let mut world = World::new(gravity);
    let rocking = world.block(&shape, mass, starts[0]);
    let table = world.beam(Arc::clone(&beam), Vector2::zeros());
    let thrown = world.block(&shape, mass, starts[1]);
    let floor = world.ground(Ground::inclined(-0.1));
    world.contact(rocking, table, laws[0]);
    world.contact(thrown, floor, laws[1]);
    let mut sim = world.simulate(1e-4)?;
    sim.until(0.3)?;

    let mut parts = ModelBuilder::new();
    let blocks = parts.add(Blocks::new(vec![Block::new(mass, &shape); 2], gravity));
    let surfaces = [
        parts.add(BeamBody::new(Arc::clone(&beam), Vector2::zeros(), BeamSurface::Axis)).body(),
        parts.add(Ground::inclined(-0.1)).body(),
    ];
    let pairs = [0, 1].map(|pair| PointPair {
        pair,
        law: parts.law(laws[pair as usize]),
        points: shape.corners().to_vec(),
        body: blocks.nth_body(pair),
        surface: surfaces[pair as usize],
        kinematics: Kinematics::Deformed,
    });
    let model = parts.build(Box::new(PointDetector::new(pairs.to_vec())))?;
    let mut q = vec![0.0; model.size().q];
    let mut v = vec![0.0; model.size().v];
    for (k, start) in starts.iter().enumerate() {
        q[3 * k..3 * k + 3].copy_from_slice(start.coordinates(&shape).as_slice());
        v[3 * k..3 * k + 3].copy_from_slice(start.velocity().as_slice());
    }
    let mut state = State::new(&model, &q, &v, 1e-4)?;
    let mut work = Workspace::new(&model, Box::new(Auto::new()), SolverSettings::default());
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default())?;
    assert_eq!(run(&model, &mut scheme, &mut state, &mut work, &Plan::time(0.3), &mut [])?, Ended::Complete);

    assert!(state.tally.contact_steps > 1000, "both blocks did touch");
    assert_eq!(sim.state(), &state);
    let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!((bits(&sim.state().q), bits(&sim.state().v)), (bits(&state.q), bits(&state.v)));
    Ok(())
}

#[test]
fn a_loaded_block_is_pushed_and_a_driven_coordinate_moves_as_prescribed() -> Tested {
    let (shape, mass) = rocker()?;
    let constant: Arc<dyn Signal> = Arc::new(Formula::constant(0.0)?);
    let mut world = World::new(Vector2::zeros());
    let pushed = world.block(&shape, mass, At::centre(0.0, 0.0));
    let driven = world.block(&shape, mass, At::centre(1.0, 0.0));
    world.load(pushed, Vector2::new(3.0, 0.0), 0.01, Arc::clone(&constant));
    world.drive(driven, BlockCoordinate::Y, Motion::still().with(Given::Velocity, 0.5, constant));
    let mut run = world.simulate(1e-2)?;
    run.until(2.0)?;
    let expected = Vector3::new(3.0 * 2.0 / mass.mass, 0.0, 0.01 * 2.0 / mass.inertia);
    assert!((run.velocity(pushed)? - expected).norm() < 1e-11 * expected.norm());
    assert!((run.position(driven)? - Vector3::new(1.0, 1.0, 0.0)).norm() < 1e-14);
    Ok(())
}
