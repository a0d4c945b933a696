//! Discs that slide, roll and collide, in all schemes, against closed forms.

use crate::scenes::{all_schemes, workspace};
use nalgebra::Vector2;
use teeter_detect::{Disc, Kinematics, Profile, ProfilePair, Shape, ShapeDetector, ShapePair, SurfacePair};
use teeter_integrator::*;
use teeter_rigid::MassProperties;

const RADIUS: f64 = 0.05;

fn disc() -> (Block, Shape) {
    let (mass, _) = MassProperties::rounded(&[Vector2::zeros()], RADIUS, 0.02, 2000.0).unwrap();
    (Block::within(mass, RADIUS), Disc::new(Vector2::zeros(), RADIUS).unwrap().into())
}

/// So many discs on an incline (rad) about the origin, which touch it and each other.
fn discs(count: u32, incline: f64, friction: f64, restitution: f64) -> Model<2> {
    let (body, shape) = disc();
    let mut parts = ModelBuilder::new();
    let discs = parts.add(Blocks::new(vec![body; count as usize], Vector2::new(0.0, -9.81)));
    let ground = parts.add(Ground::inclined(incline)).body();
    let on_ground = parts.law(PairLaw::new(friction, 0.0));
    let each_other = parts.law(PairLaw::new(0.0, restitution));
    let shapes = (0..count).map(|k| (discs.nth_body(k), shape.clone())).collect();
    let pair = |k: u32| ShapePair { pair: k, law: each_other, bodies: [discs.nth_body(k + 1), discs.nth_body(k)] };
    let on = |k: u32| SurfacePair {
        pair: 100 + k,
        law: on_ground,
        body: discs.nth_body(k),
        surface: ground,
        kinematics: Kinematics::Deformed,
    };
    let detector = ShapeDetector::new(shapes, (0..count - 1).map(pair).collect()).unwrap();
    parts.build(Box::new(detector.with_surfaces((0..count).map(on).collect()).unwrap())).unwrap()
}

fn run_to(model: &Model<2>, scheme: &mut dyn Scheme<2>, state: &mut State, time: f64) {
    let mut work = workspace(model);
    let plan = Plan::time(time).when_unsolved(Unsolved::End);
    assert_eq!(run(model, scheme, state, &mut work, &plan, &mut []).unwrap(), Ended::Complete, "{}", scheme.name());
    assert!(state.ledger.relative_residual() < 1e-13, "{} {:e}", scheme.name(), state.ledger.relative_residual());
}

/// Schemes that take rigid scenes.
fn schemes_for_rigid() -> impl Iterator<Item = Box<dyn Scheme<2>>> {
    all_schemes(&[]).into_iter().filter(|scheme| scheme.name() != Resolved::<2>::NAME)
}

/// Thrown without spin it slides until it rolls, at two thirds of its speed: friction has no moment
/// about the ground.
#[test]
fn a_disc_thrown_without_spin_rolls_from_two_thirds_of_its_speed_on() {
    let model = discs(1, 0.0, 0.2, 0.0);
    let (v0, g) = (1.5, 9.81);
    for mut scheme in schemes_for_rigid() {
        let mut state = State::new(&model, &[0.0, RADIUS, 0.0], &[v0, 0.0, 0.0], 1e-3).unwrap();
        run_to(&model, scheme.as_mut(), &mut state, 1.0);
        let name = scheme.name();
        assert!((state.v[0] - 2.0 / 3.0 * v0).abs() < 1e-12, "{name}: {}", state.v[0]);
        assert!((state.v[2] + state.v[0] / RADIUS).abs() < 1e-10, "{name}: it rolls: {:?}", state.v);
        // It slides for v₀/(3μg), and loses a third of its energy.
        let sliding = v0 / (3.0 * 0.2 * g);
        let way = v0 * sliding - 0.5 * 0.2 * g * sliding * sliding + 2.0 / 3.0 * v0 * (1.0 - sliding);
        // Schemes of fixed steps end the slide in the step in which it ends.
        assert!((state.q[0] - way).abs() < 0.1 * 1e-3 * v0, "{name}: {} {way}", state.q[0]);
        assert!((state.q[1] - RADIUS).abs() < 1e-12 && state.v[1].abs() < 1e-12, "{name}: on the ground");
        let energy = state.ledger.current.kinetic / state.ledger.initial.kinetic;
        assert!((energy - 2.0 / 3.0).abs() < 1e-12, "{name}: {energy}");
    }
}

/// Down an incline it rolls with two thirds of g sin β, to rounding: all is linear in time.
#[test]
fn a_disc_rolls_down_an_incline() {
    let beta = 0.2_f64;
    let model = discs(1, -beta, 0.5, 0.0);
    for mut scheme in schemes_for_rigid() {
        let start = [RADIUS * beta.sin(), RADIUS * beta.cos(), 0.0];
        let mut state = State::new(&model, &start, &[0.0; 3], 1e-3).unwrap();
        run_to(&model, scheme.as_mut(), &mut state, 0.5);
        let (a, name) = (2.0 / 3.0 * 9.81 * beta.sin(), scheme.name());
        let along = 0.5 * a * 0.25;
        let [x, y] = [start[0] + along * beta.cos(), start[1] - along * beta.sin()];
        assert!((state.q[0] - x).abs() < 1e-12 && (state.q[1] - y).abs() < 1e-12, "{name}: {:?}", state.q);
        assert!((state.q[2] + along / RADIUS).abs() < 1e-10, "{name}: {:?}", state.q);
    }
}

/// A row of discs, one of which strikes the others: with e = 1 and gaps each hands its speed on, as
/// it strikes the next alone; the friction of the ground, of which there is none here, would have
/// no part in it.
#[test]
fn a_row_with_gaps_hands_the_speed_on() {
    let n = 5;
    let model = discs(n, 0.0, 0.0, 1.0);
    for mut scheme in schemes_for_rigid() {
        let gap = 1e-2;
        let q: Vec<f64> = (0..n).flat_map(|k| [f64::from(k) * (2.0 * RADIUS + gap), RADIUS, 0.0]).collect();
        let mut v = vec![0.0; 3 * n as usize];
        v[0] = 1.0;
        let mut state = State::new(&model, &q, &v, 1e-3).unwrap();
        run_to(&model, scheme.as_mut(), &mut state, 0.1);
        let name = scheme.name();
        let speeds: Vec<f64> = state.v.iter().step_by(3).copied().collect();
        let last = speeds.len() - 1;
        assert!((speeds[last] - 1.0).abs() < 1e-12, "{name}: {speeds:?}");
        assert!(speeds[..last].iter().all(|v| v.abs() < 1e-12), "{name}: {speeds:?}");
        if [MoreauJeanLocated::<2>::NAME, EventDriven::NAME].contains(&name) {
            // Four gaps at unit speed, then free.
            let x = q[3 * last] + 0.1 - 4.0 * gap;
            assert!((state.q[3 * last] - x).abs() < 1e-12, "{name}: {} {x}", state.q[3 * last]);
        }
    }
}

/// In a valley of a profile a disc that drops comes to rest on both sides; over a crest it rolls
/// on.
#[test]
fn a_disc_on_a_profile_settles_in_a_valley() {
    let (body, shape) = disc();
    let mut parts = ModelBuilder::new();
    let block = parts.add(Blocks::new(vec![body], Vector2::new(0.0, -9.81))).body();
    let ground = parts.add(Ground::flat(0.0)).body();
    let law = parts.law(PairLaw::new(0.4, 0.0));
    let profile = [[-1.0, 0.5], [0.0, 0.0], [0.5, 0.3], [1.0, 0.0]].map(Vector2::from).to_vec();
    let detector = ShapeDetector::new(vec![(block, shape)], Vec::new()).unwrap();
    let pair = ProfilePair { pair: 0, law, body: block, ground };
    let detector = detector.with_profile(Profile::new(profile).unwrap(), vec![pair]).unwrap();
    let model = parts.build(Box::new(detector)).unwrap();
    for mut scheme in schemes_for_rigid() {
        let mut state = State::new(&model, &[-0.4, 0.3, 0.0], &[0.0; 3], 1e-3).unwrap();
        run_to(&model, scheme.as_mut(), &mut state, 20.0);
        let name = scheme.name();
        // It touches both sides: its distance from both lines is the radius.
        let lines = [(-1.0_f64, 0.5_f64), (0.5, 0.3)]
            .map(|(x, y)| (state.q[0] * -y / x.signum() + state.q[1] * x.abs()) / x.hypot(y));
        assert!(state.v.iter().all(|v| v.abs() < 1e-6), "{name}: {:?}", state.v);
        assert!(lines.iter().all(|d| (d - RADIUS).abs() < 1e-4), "{name}: {lines:?}");
    }
    // Rolling down from the crest to the right, at the end of which the ground is level.
    let slope = 0.6_f64.atan();
    let at = Vector2::new(0.5, 0.3)
        + 0.01 * Vector2::new(slope.cos(), -slope.sin())
        + RADIUS * Vector2::new(slope.sin(), slope.cos());
    let mut state = State::new(&model, &[at.x, at.y, 0.0], &[0.0; 3], 1e-3).unwrap();
    let mut scheme = EventDriven::new(EventDrivenSettings::default()).unwrap();
    run_to(&model, &mut scheme, &mut state, 1.0);
    assert!(state.q[0] > 1.0 && (state.q[1] - RADIUS).abs() < 1e-9, "{:?}", state.q);
    assert!((state.v[2] + state.v[0] / RADIUS).abs() < 1e-6, "it rolls: {:?}", state.v);
}
