//! Modes of a block and the beam that it stands on, against a lumped mass and against small vibrations in time.

use nalgebra::Vector2;
use std::f64::consts::PI;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Section};
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};

const G: f64 = 9.81;
/// Ten times as thick as the paper's: it sags by micrometres.
const SPAN: f64 = 0.36;

fn spec() -> BeamSpec {
    BeamSpec::new(SPAN, 20, Section::rectangle(0.03, 0.01, 69e9, 2700.0).unwrap())
}

/// A block of these sides in the middle of the beam, settled.
fn standing(width: f64, height: f64, friction: f64) -> (Model<2>, Equilibrium<2>, f64) {
    let shape = Rectangle::new(width, height).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.03, 2700.0).unwrap();
    let mut parts = ModelBuilder::new();
    let body = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -G))).body();
    let beam = Arc::new(Beam::new(spec()).unwrap());
    let surface = parts.add(BeamBody::new(beam, Vector2::zeros(), BeamSurface::Axis)).body();
    let law = parts.law(PairLaw::new(friction, 0.0));
    let points = shape.corners().to_vec();
    let pairs = vec![PointPair { pair: 0, law, points, body, surface, kinematics: Kinematics::Deformed }];
    let model = parts.build(Box::new(PointDetector::new(pairs))).unwrap();
    let mut q = vec![0.0; model.size().q];
    (q[0], q[1]) = (0.5 * SPAN, 0.5 * height);
    let settings = SolverSettings { tolerance: 1e-13, max_iterations: 10_000 };
    let mut work = Workspace::new(&model, Box::new(teeter_solvers::Auto::new()), settings);
    let limits = SettlingLimits { reach: &[0.1], margin: 0.01, tau: SettlingLimits::FIRST_TAU };
    let equilibrium = settle(&model, 0.0, &q, &limits, &mut work).unwrap();
    (model, equilibrium, 2700.0 * width * height * 0.03)
}

/// In symmetric modes a narrow block is a mass in the middle.
#[test]
fn a_narrow_block_is_a_lumped_mass() {
    let (model, equilibrium, mass) = standing(0.001, 0.3, 0.5);
    let found = coupled_modes(&model, &equilibrium.q, &equilibrium.forces, 8).unwrap();
    let lumped = Beam::new(spec().lump(0.5 * SPAN, mass, 0.0)).unwrap().modes(5).unwrap();
    // A mass in the middle without inertia: modes 1, 3, 5 are symmetric.
    for mode in [0, 2] {
        let expected = lumped.circular_frequencies()[mode];
        let nearest = found.circular_frequencies().map(|f| (f / expected - 1.0).abs()).fold(f64::INFINITY, f64::min);
        assert!(nearest < 2e-5, "mode {}: off by {nearest:e}", mode + 1);
    }
}

/// The tall narrow block is a pendulum upside down: about the foot I_o ω² = k_θ − m g H/2, and the beam's k_θ is small enough here that the
/// weight counts.
#[test]
fn the_weight_of_a_tall_block_softens_its_rocking() {
    let (model, equilibrium, _) = standing(0.02, 1.0, 0.5);
    let with = coupled_modes(&model, &equilibrium.q, &equilibrium.forces, 1).unwrap().eigenvalues[0];
    let mut weightless = equilibrium.clone();
    weightless.forces.iter_mut().for_each(|(_, force)| *force *= 1e-9);
    let without = coupled_modes(&model, &weightless.q, &weightless.forces, 1).unwrap().eigenvalues[0];
    // Both in one: ω² = (k_θ − m g H/2)/(I + m H²/4 …), with the block's own angle for 1.
    let (mass, height) = (2700.0 * 0.02 * 1.0 * 0.03, 1.0);
    let inertia = mass * (0.02_f64.powi(2) + height * height) / 12.0 + mass * height * height / 4.0;
    let softer = mass * G * 0.5 * height / inertia;
    assert!((without - with - softer).abs() < 0.01 * softer, "{without} {with} {softer}");
}

/// Started along a mode with a small amplitude the whole swings back and forth at its frequency.
#[test]
fn a_small_vibration_in_time_has_the_frequency_of_its_mode() {
    let (model, equilibrium, _) = standing(0.03, 0.135, 0.5);
    let modes = coupled_modes(&model, &equilibrium.q, &equilibrium.forces, 2).unwrap();
    for (shape, squared) in modes.shapes.iter().zip(&modes.eigenvalues) {
        let omega = squared.sqrt();
        let largest = shape.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        // So small that contacts stay closed.
        let v: Vec<f64> = shape.iter().map(|x| 1e-6 * x / largest).collect();
        let (steps, periods) = (20_000, 10.0);
        let h = periods * 2.0 * PI / omega / f64::from(steps);
        let mut state = State::new(&model, &equilibrium.q, &v, h).unwrap();
        let mut work = Workspace::new(&model, Box::new(teeter_solvers::Auto::new()), SolverSettings::default());
        let mut scheme = MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap();
        let plan = Plan::steps(steps as u64).when_unsolved(Unsolved::End);
        assert_eq!(run(&model, &mut scheme, &mut state, &mut work, &plan, &mut []).unwrap(), Ended::Complete);
        // After whole periods it moves as at the start.
        let momentum = |v: &[f64]| v.iter().zip(shape).map(|(v, x)| v * x).sum::<f64>();
        let ratio = momentum(&state.v) / momentum(&v);
        assert!((ratio - 1.0).abs() < 1e-3, "ω {omega}: {ratio}");
    }
}

/// Of a beam held along its axis the tangent about the sagging shape is stiffer: K + N G + EA/L (Gq)(Gq)ᵀ, here against Beam's own
/// static solve under a little more load.
#[test]
fn the_stretching_of_a_held_beam_is_in_its_tangent() {
    let axial = teeter_beam::Axial::Held;
    let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap();
    let beam = Arc::new(Beam::new(BeamSpec::new(SPAN, 20, section).axial(axial)).unwrap());
    let mut parts = ModelBuilder::new();
    parts.add(BeamBody::new(Arc::clone(&beam), Vector2::zeros(), BeamSurface::Axis));
    let model = parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap();
    let under = |force: f64| {
        let mut q = vec![0.0; beam.dofs()];
        beam.add_point_load(0.5 * SPAN, force, &mut q).unwrap();
        beam.solve_static(&mut q).unwrap();
        q
    };
    let q = under(-3.0);
    let modes = coupled_modes(&model, &q, &[], beam.free_dofs()).unwrap();
    // The flexibility Σ φφᵀ/ω² of all modes is the inverse of the tangent.
    let middle = |q: &[f64]| beam.deflection_at(q, 0.5 * SPAN).unwrap().w;
    let flexibility: f64 = modes.shapes.iter().zip(&modes.eigenvalues).map(|(x, l)| middle(x).powi(2) / l).sum();
    let difference = (middle(&under(-2.999)) - middle(&under(-3.001))) / 0.002;
    assert!((flexibility / difference - 1.0).abs() < 1e-5, "{flexibility} {difference}");
    let linear = Beam::new(beam.spec().clone().axial(teeter_beam::Axial::Free)).unwrap();
    assert!(modes.eigenvalues[0].sqrt() > 2.0 * linear.circular_frequency(1).unwrap());
}
