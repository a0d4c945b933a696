//! Static equilibria against small computations that share nothing with the search but the beam's own statics.

use crate::scenes::{FLAT_BLOCK, PAPER_BLOCK};
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Section, Support};
use teeter_detect::{ContactId, Kinematics, PointDetector, PointPair};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

const G: f64 = 9.81;
const WEIGHT: f64 = 2700.0 * 0.03 * 0.135 * 0.03 * G;
/// Width and height of the paper's block, m.
const B: f64 = 0.03;
const H: f64 = 0.135;
const REACH: [f64; 1] = [0.1 * B];

fn beam(supports: [Support; 2]) -> Arc<Beam> {
    let spec = BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap()).supported(supports);
    Arc::new(Beam::new(spec).unwrap())
}

fn pinned() -> Arc<Beam> {
    beam([Support::Pinned, Support::Pinned])
}

/// The paper's block over a surface, its coordinates `held` held.
fn over(surface: Box<dyn Subsystem<2>>, friction: f64, kinematics: Kinematics, held: &[BlockCoordinate]) -> Model<2> {
    let shape = Rectangle::new(B, H).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.03, 2700.0).unwrap();
    let blocks = Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -G));
    let blocks = held.iter().fold(blocks, |blocks, &k| blocks.with_motion(0, k, Motion::still()).unwrap());
    let mut parts = ModelBuilder::new();
    let body = parts.add(blocks).body();
    let surface = parts.add_boxed(surface).body();
    let law = parts.law(PairLaw::new(friction, 0.0));
    let points = shape.corners().to_vec();
    parts
        .build(Box::new(PointDetector::new(vec![PointPair { pair: 0, law, points, body, surface, kinematics }])))
        .unwrap()
}

fn search(model: &Model<2>, q: &[f64]) -> Result<Equilibrium<2>, EquilibriumError> {
    let settings = SolverSettings { tolerance: 1e-13, max_iterations: 10_000 };
    let mut work = Workspace::new(model, Box::new(teeter_solvers::Auto::new()), settings);
    settle(model, 0.0, q, &SettlingLimits { reach: &REACH, margin: 0.01, tau: SettlingLimits::FIRST_TAU }, &mut work)
}

/// The block flat at x on the straight beam, settled.
fn flat(model: &Model<2>, x: f64, surface: f64) -> Result<Equilibrium<2>, EquilibriumError> {
    let mut q = vec![0.0; model.size().q];
    (q[0], q[1]) = (x, surface + 0.5 * H);
    search(model, &q)
}

fn force(found: &Equilibrium<2>, corner: u32) -> Vector2<f64> {
    let own = found.forces.iter().find(|(id, _)| *id == ContactId::new(0, corner));
    own.map_or_else(Vector2::zeros, |(_, force)| *force)
}

/// The beam under upward forces, and couples, at places.
fn deflected(beam: &Beam, loads: &[(f64, f64, f64)]) -> Vec<f64> {
    let mut q = vec![0.0; beam.dofs()];
    for &(x, force, couple) in loads {
        beam.add_point_load(x, force, &mut q).unwrap();
        beam.add_point_couple(x, couple, &mut q).unwrap();
    }
    beam.solve_static(&mut q).unwrap();
    q
}

/// Worst difference of beams at their nodes, relative to the largest deflection.
fn off(beam: &Beam, found: &[f64], exact: &[f64]) -> f64 {
    let (found, exact) = (beam.to_nodes(found), beam.to_nodes(exact));
    let largest = exact.iter().fold(0.0_f64, |most, [w, _]| most.max(w.abs()));
    found.iter().zip(&exact).fold(0.0_f64, |most, (a, b)| most.max((a[0] - b[0]).abs())) / largest
}

#[test]
fn a_tilted_block_bends_the_beam_by_its_weight_under_its_foot() {
    for (supports, kinematics) in [
        ([Support::Pinned, Support::Pinned], Kinematics::Deformed),
        ([Support::Clamped, Support::Pinned], Kinematics::Linear),
        ([Support::Clamped, Support::Clamped], Kinematics::Deformed),
    ] {
        let beam = beam(supports);
        let model = over(Box::new(crate::scenes::beam_body(&beam)), 1e3, kinematics, &[BlockCoordinate::Turn]);
        let tilt = 5.0_f64.to_radians();
        let mut q = vec![0.0; model.size().q];
        let foot = 0.165;
        q[0] = foot + 0.5 * B * tilt.cos() - 0.5 * H * tilt.sin();
        q[1] = 0.5 * B * tilt.sin() + 0.5 * H * tilt.cos();
        q[2] = tilt;
        let found = search(&model, &q).unwrap();
        let exact = deflected(&beam, &[(foot, -WEIGHT, 0.0)]);
        let error = off(&beam, &found.q[3..], &exact);
        assert!(error <= 1e-12, "{supports:?}: {error:e}");
        assert!(found.q[2] == tilt && (found.q[0] - q[0]).abs() < 1e-15 && found.penetration < 1e-15);
        eprintln!("{supports:?}: {} rounds, nodes to {error:.1e}", found.rounds);
    }
}

#[test]
fn a_block_in_the_middle_presses_with_half_its_weight_on_either_foot() {
    let beam = pinned();
    for (friction, kinematics) in [(0.0, Kinematics::Deformed), (0.0, Kinematics::Linear), (0.5, Kinematics::Deformed)]
    {
        let model = over(Box::new(crate::scenes::beam_body(&beam)), friction, kinematics, &[]);
        let found = flat(&model, 0.18, 0.0).unwrap();
        let exact = deflected(&beam, &[(0.165, -0.5 * WEIGHT, 0.0), (0.195, -0.5 * WEIGHT, 0.0)]);
        let error = off(&beam, &found.q[3..], &exact);
        assert!(error <= 1e-12, "{friction} {kinematics:?}: {error:e}");
        let slope =
            if kinematics == Kinematics::Linear { 0.0 } else { beam.deflection_at(&exact, 0.165).unwrap().slope };
        // Without friction the inclined normals carry it, and their horizontal parts cancel; with it the force is upright.
        let cos = (1.0 + slope * slope).sqrt().recip();
        let normal = 0.5 * WEIGHT * if friction == 0.0 { cos.recip() } else { cos };
        for corner in [0, 1] {
            let pressed = force(&found, corner)[0];
            assert!((pressed / normal - 1.0).abs() <= 1e-12, "{friction} {kinematics:?}: {pressed} {normal}");
        }
        assert!(found.q[2].abs() < 1e-12, "{}", found.q[2]);
    }
}

#[test]
fn off_the_middle_without_friction_two_forces_follow_from_the_statics_of_the_tilted_block() {
    let beam = pinned();
    for x in [0.05, 0.14, 0.2, 0.3] {
        let model = over(Box::new(crate::scenes::beam_body(&beam)), 0.0, Kinematics::Linear, &[]);
        let found = flat(&model, x, 0.0).unwrap();
        // Nothing holds it sideways, and nothing pushes it but rounding.
        assert!((found.q[0] - x).abs() < 1e-13, "{}", found.q[0]);
        let x = found.q[0];
        let (mut angle, mut forces, mut q) = (0.0_f64, [0.0; 2], Vec::new());
        for _ in 0..200 {
            let feet = [-1.0, 1.0].map(|side| x + 0.5 * side * B * angle.cos() + 0.5 * H * angle.sin());
            let right = WEIGHT * (x - feet[0]) / (feet[1] - feet[0]);
            forces = [WEIGHT - right, right];
            q = deflected(&beam, &[(feet[0], -forces[0], 0.0), (feet[1], -forces[1], 0.0)]);
            let w = feet.map(|x| beam.deflection_at(&q, x).unwrap().w);
            angle = ((w[1] - w[0]) / B).asin();
        }
        assert!((found.q[2] - angle).abs() < 1e-13, "{} {angle}", found.q[2]);
        assert!(off(&beam, &found.q[3..], &q) < 1e-12);
        for corner in [0, 1] {
            let pressed = force(&found, corner)[0];
            assert!((pressed / forces[corner as usize] - 1.0).abs() < 1e-12, "{pressed} {forces:?}");
        }
    }
}

#[test]
fn feet_on_a_slope_stick_where_they_press_more_and_slide_where_they_press_less() {
    // A level base shrinks to b cos φ between feet that the axis doesn't move sideways: the foot that carries less slides,
    // outwards is its friction, at its limit; the other stays where it was put.
    let (beam, mu) = (pinned(), 0.5);
    for x in [0.06, 0.14] {
        let model = over(Box::new(crate::scenes::beam_body(&beam)), mu, Kinematics::Deformed, &[]);
        let found = flat(&model, x, 0.0).unwrap();
        let stuck = x + 0.5 * B;
        let (mut angle, mut w, mut slope) = (0.0_f64, [0.0; 2], [0.0; 2]);
        let (mut place, mut pressed, mut q) = ([0.0; 2], [Vector2::zeros(); 2], Vec::new());
        for _ in 0..300 {
            let (sin, cos) = angle.sin_cos();
            let centre = stuck - 0.5 * B * cos - 0.5 * H * sin;
            let slid = stuck - B * cos;
            let normal = |slope: f64| Vector2::new(-slope, 1.0).normalize();
            let along = |n: Vector2<f64>| Vector2::new(n.y, -n.x);
            // Moments about the foot that sticks.
            let n = normal(slope[0]);
            let ray = n - along(n) * mu;
            let left = ray * ((centre - stuck) * WEIGHT / ((slid - stuck) * ray.y - (w[0] - w[1]) * ray.x));
            let right = Vector2::new(0.0, WEIGHT) - left;
            q = deflected(&beam, &[(slid, -left.y, 0.0), (stuck, -right.y, 0.0)]);
            let d = [slid, stuck].map(|x| beam.deflection_at(&q, x).unwrap());
            (w, slope) = (d.map(|d| d.w), d.map(|d| d.slope));
            angle = ((w[1] - w[0]) / B).asin();
            place = [centre, w[1] - 0.5 * B * angle.sin() + 0.5 * H * angle.cos()];
            let split =
                |force: Vector2<f64>, slope| Vector2::new(force.dot(&normal(slope)), force.dot(&along(normal(slope))));
            pressed = [split(left, slope[0]), split(right, slope[1])];
        }
        assert!(pressed[1][1].abs() < mu * pressed[1][0], "the other sticks: {pressed:?}");
        assert!(
            (found.q[0] - place[0]).abs() < 1e-14 && (found.q[1] - place[1]).abs() < 1e-14,
            "{:?} {place:?}",
            found.q
        );
        assert!((found.q[2] - angle).abs() < 1e-13 && off(&beam, &found.q[3..], &q) < 1e-12);
        for corner in [0, 1] {
            let error = (force(&found, corner) - pressed[corner as usize]).norm() / WEIGHT;
            assert!(error < 1e-12, "foot {corner} at {x}: {:?} {pressed:?}", force(&found, corner));
        }
    }
}

#[test]
fn feet_on_a_top_fibre_hold_it_together_as_far_as_friction_goes() {
    // A deep, soft beam: its sections turn under the feet, and the top fibre would move them together by 2 offset ψ.
    let spec = BeamSpec::new(0.36, 24, Section::new(0.6, 0.12).unwrap()).supported([Support::Pinned; 2]);
    let beam = Arc::new(Beam::new(spec).unwrap());
    let (offset, feet) = (0.03, [0.165, 0.195]);
    let slope = |loads: &[(f64, f64, f64)]| beam.deflection_at(&deflected(&beam, loads), feet[0]).unwrap().slope;
    let weight = [(feet[0], -0.5 * WEIGHT, 0.0), (feet[1], -0.5 * WEIGHT, 0.0)];
    let couples = |t: f64| [(feet[0], 0.0, offset * t), (feet[1], 0.0, -offset * t)];
    // The friction T that keeps the sections under the feet upright.
    let sticking = -slope(&weight) / slope(&couples(1.0));
    for mu in [0.1, 10.0] {
        let body = BeamBody::new(Arc::clone(&beam), Vector2::zeros(), BeamSurface::Top { offset });
        let found = flat(&over(Box::new(body), mu, Kinematics::Linear, &[]), 0.18, offset).unwrap();
        let sticks = sticking < mu * 0.5 * WEIGHT;
        assert_eq!(sticks, mu == 10.0, "{sticking}");
        let friction = if sticks { sticking } else { mu * 0.5 * WEIGHT };
        for (corner, sign) in [(0, 1.0), (1, -1.0)] {
            let error = (force(&found, corner) - Vector2::new(0.5 * WEIGHT, sign * friction)).norm() / WEIGHT;
            assert!(error < 1e-11, "mu {mu}: {:?}, {friction}", force(&found, corner));
        }
        let loads: Vec<_> = weight.into_iter().chain(couples(friction)).collect();
        let error = off(&beam, &found.q[3..], &deflected(&beam, &loads));
        assert!(error < 1e-11, "mu {mu}: {error:e}");
    }
}

#[test]
fn a_block_held_level_on_a_slope_stands_on_one_foot_and_the_other_is_clear() {
    let beam = pinned();
    let model = over(Box::new(crate::scenes::beam_body(&beam)), 0.5, Kinematics::Deformed, &[BlockCoordinate::Turn]);
    let found = flat(&model, 0.1, 0.0).unwrap();
    // The beam falls to the right there, so the left foot is the one.
    let exact = deflected(&beam, &[(0.085, -WEIGHT, 0.0)]);
    assert!(off(&beam, &found.q[3..], &exact) < 1e-12 && found.q[2] == 0.0);
    assert_eq!(found.forces.len(), 1);
    let mut candidates = Vec::new();
    model.candidates(&found.q, 0.05, &mut candidates).unwrap();
    let gap = |corner| candidates.iter().find(|c| c.id == ContactId::new(0, corner)).unwrap().gap;
    let w = |x| beam.deflection_at(&exact, x).unwrap();
    let clear = (w(0.085).w - w(0.115).w) / (1.0 + w(0.115).slope.powi(2)).sqrt();
    assert!(clear > 1e-4 && (gap(1) - clear).abs() < 1e-14, "{} {clear}", gap(1));
    assert!(gap(0).abs() < 1e-15 && (force(&found, 0).norm() / WEIGHT - 1.0).abs() < 1e-12);
}

#[test]
fn an_incline_holds_a_block_up_to_its_friction_and_its_base() {
    let on = |spec: &crate::scenes::BlockSpec, degrees: f64, friction: f64| {
        let slope = degrees.to_radians();
        let ground = Box::new(Ground::inclined(slope));
        let law = PairLaw::new(friction, 0.0);
        let model = crate::scenes::model(spec, Vector2::new(0.0, -G), law, Kinematics::Deformed, ground);
        let half = 0.5 * spec.height;
        search(&model, &[-half * slope.sin(), half * slope.cos(), slope])
    };
    let found = on(&FLAT_BLOCK, 20.0, 0.5).unwrap();
    let weight = 2700.0 * 0.1 * 0.05 * 0.1 * G;
    let (sin, cos) = 20.0_f64.to_radians().sin_cos();
    let sum = force(&found, 0) + force(&found, 1);
    assert!((sum - Vector2::new(weight * cos, weight * sin)).norm() < 1e-11 * weight, "{sum:?}");
    // The weight passes between the feet at H/2 tan β uphill of the middle's foot: levers by moments.
    let right = weight * (0.5 * cos - 0.5 * 0.05 / 0.1 * sin);
    assert!((force(&found, 1)[0] / right - 1.0).abs() < 1e-11, "{} {right}", force(&found, 1)[0]);
    for (spec, degrees, friction, turns) in [(&FLAT_BLOCK, 20.0, 0.36, false), (&PAPER_BLOCK, 13.0, 0.5, true)] {
        let Err(EquilibriumError::Leaves { contact, lifted, slid, .. }) = on(spec, degrees, friction) else {
            panic!("it can't rest at {degrees} degrees with {friction}");
        };
        assert!(contact.pair() == 0 && lifted.hypot(slid) > REACH[0]);
        assert_eq!(lifted > slid, turns, "{lifted} {slid}");
    }
    // To either side of its friction angle, and of its base.
    assert!(on(&FLAT_BLOCK, 20.0, 0.365).is_ok() && on(&PAPER_BLOCK, 12.0, 0.5).is_ok());
}

#[test]
fn loads_count_as_they_are_at_the_time_and_a_beam_may_carry_nothing_else() {
    let beam = pinned();
    let mut pattern = vec![0.0; beam.dofs()];
    beam.add_point_load(0.1, -3.0, &mut pattern).unwrap();
    let ramp = Arc::new(Table::new(vec![0.0, 1.0], vec![0.0, 2.0]).unwrap());
    let mut parts = ModelBuilder::new();
    parts.add(crate::scenes::beam_body(&beam).with_load(Box::new(SignalLoad::new(pattern, ramp))));
    let model = parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap();
    for (t, force) in [(0.0, 0.0), (0.5, -3.0)] {
        let mut work = crate::scenes::workspace(&model);
        let limits = SettlingLimits { reach: &[], margin: 0.0, tau: SettlingLimits::FIRST_TAU };
        let found = settle(&model, t, &vec![0.0; beam.dofs()], &limits, &mut work).unwrap();
        let exact = deflected(&beam, &[(0.1, force, 0.0)]);
        let error = found.q.iter().zip(&exact).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(error <= 1e-15, "{error:e}");
    }
}

#[test]
fn a_stiffening_part_settles_with_the_tangent_of_its_start() {
    // k q + c q³ = −mg, stiffer at the end than its tangent by far.
    let (stiffness, cubic) = (50.0, 1e6);
    let plate = crate::own_parts::Plate { mass: 0.1, stiffness, cubic };
    let model = over(Box::new(plate), 0.5, Kinematics::Deformed, &[]);
    let found = flat(&model, 0.0, 0.0).unwrap();
    let q = found.q[3];
    let lacks = stiffness * q + cubic * q * q * q + WEIGHT;
    eprintln!("{} rounds, tangent {} times that of the start", found.rounds, 1.0 + 3.0 * cubic * q * q / stiffness);
    assert!(lacks.abs() < 1e-9 * WEIGHT && q < 0.0, "{lacks}");
    assert!((found.q[1] - q - 0.5 * H).abs() < 1e-14);
}

#[test]
fn the_same_search_gives_the_same_bits() {
    let beam = pinned();
    let model = over(Box::new(crate::scenes::beam_body(&beam)), 0.5, Kinematics::Deformed, &[]);
    assert_eq!(flat(&model, 0.14, 0.0).unwrap(), flat(&model, 0.14, 0.0).unwrap());
}
