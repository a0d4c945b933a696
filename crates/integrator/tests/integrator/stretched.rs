//! Beams held along their axis, and beams with axial dofs: energy, order, and the exact large vibration.

use nalgebra::Vector2;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;
use teeter_beam::{Axial, Beam, BeamSpec, Damping, Section};
use teeter_detect::PointDetector;
use teeter_integrator::*;

fn beam(elements: usize, axial: Axial, damping: Damping) -> Arc<Beam> {
    let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap();
    Arc::new(Beam::new(BeamSpec::new(0.36, elements, section).axial(axial).damped(damping)).unwrap())
}

fn alone(beam: &Arc<Beam>) -> Model<2> {
    let mut parts = ModelBuilder::new();
    parts.add(BeamBody::new(Arc::clone(beam), Vector2::zeros(), BeamSurface::Axis));
    parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap()
}

fn advance(model: &Model<2>, state: &mut State, steps: u64) {
    let mut work = crate::scenes::workspace(model);
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).unwrap();
    let plan = Plan::steps(steps).when_unsolved(Unsolved::End);
    assert_eq!(run(model, &mut scheme, state, &mut work, &plan, &mut []).unwrap(), Ended::Complete);
}

fn sine(beam: &Beam, amplitude: f64) -> Vec<f64> {
    let k = PI / beam.spec().span;
    let nodes: Vec<[f64; 2]> =
        beam.node_positions().iter().map(|x| [amplitude * (k * x).sin(), amplitude * k * (k * x).cos()]).collect();
    beam.from_nodes(&nodes).unwrap()
}

/// In its first mode a pinned beam of uniform axial force is Duffing's oscillator, exactly: w = A(t) sin(πx/L) with
/// Ä + ω²A + (EA π⁴/(4 ρA L⁴)) A³ = 0. A quarter of its period is ∫dθ/√(ω² + ½γA²(1 + sin²θ)) over a quarter turn.
fn quarter_period(beam: &Beam, amplitude: f64) -> f64 {
    let s = &beam.spec().section;
    let k2 = (PI / beam.spec().span).powi(2);
    let omega2 = k2 * k2 * s.bending_stiffness / s.mass_per_length;
    let gamma = k2 * k2 * s.axial_stiffness.unwrap() / (4.0 * s.mass_per_length);
    let n = 4000;
    let rate = |theta: f64| (omega2 + 0.5 * gamma * amplitude * amplitude * (1.0 + theta.sin().powi(2))).sqrt().recip();
    // The midpoint rule over a period of an analytic function converges faster than any power.
    (0..n).map(|i| rate(FRAC_PI_2 * (f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() * FRAC_PI_2 / f64::from(n)
}

#[test]
fn the_large_vibration_of_a_held_beam_is_duffing_s_and_the_step_of_second_order() {
    // Twenty times as stiff by stretching as by bending.
    let amplitude = 0.004;
    let beam = beam(20, Axial::Held, Damping::default());
    let model = alone(&beam);
    let quarter = quarter_period(&beam, amplitude);
    let linear = FRAC_PI_2 / beam.circular_frequency(1).unwrap();
    assert!(quarter < 0.4 * linear, "{quarter} {linear}");
    let error = |steps: u64| {
        let h = quarter / steps as f64;
        let mut state = State::new(&model, &sine(&beam, amplitude), &vec![0.0; beam.dofs()], h).unwrap();
        advance(&model, &mut state, steps);
        beam.deflection_at(&state.q, 0.18).unwrap().w / amplitude
    };
    // At a quarter of the period it passes through zero.
    let errors = [200, 400, 800].map(error);
    assert!(errors[2].abs() < 3e-6, "{errors:?}");
    // What is left as h → 0 is the mesh's.
    let order = ((errors[0] - errors[1]) / (errors[1] - errors[2])).log2();
    assert!((order - 2.0).abs() < 0.1, "{order} {errors:?}");
}

#[test]
fn the_account_of_a_stretched_beam_closes_to_rounding_and_its_energy_stays() {
    for damping in [Damping::default(), Damping::none().with_viscous(0.4).with_rayleigh_stiffness(1e-6)] {
        let damped = damping != Damping::default();
        let beam = beam(20, Axial::Held, damping);
        let model = alone(&beam);
        // Rough: every mode is in it, most of them not resolved by the step.
        let mut v: Vec<f64> = (0..beam.dofs()).map(|k| 3.0 * (1.7 * k as f64).sin()).collect();
        v.iter_mut().enumerate().filter(|(k, _)| beam.is_held(*k)).for_each(|(_, v)| *v = 0.0);
        let mut state = State::new(&model, &sine(&beam, 0.01), &v, 1e-4).unwrap();
        let start = model.energy(&state.q, &state.v).unwrap().total();
        advance(&model, &mut state, 20_000);
        assert!(state.ledger.relative_residual() < 1e-14, "{:e}", state.ledger.relative_residual());
        let end = model.energy(&state.q, &state.v).unwrap().total();
        // What is left of the tension where its rounds end.
        let numerical = state.ledger.sum.numerical.abs() / state.ledger.scale;
        assert!(numerical < 1e-11, "{numerical:e} in 20 000 steps");
        if damped {
            assert!(end < 0.5 * start, "{end} {start}");
        } else {
            assert!((end / start - 1.0).abs() < 1e-11, "{:e}", end / start - 1.0);
        }
    }
}

/// A bar struck along its axis: u = v sin(ωt) sin(πx/2L)/ω of its first mode, clamped and free.
#[test]
fn axial_dofs_vibrate_as_a_bar_and_leave_bending_alone() {
    let n = 40;
    let beam = beam(n, Axial::elastic([true, false]), Damping::default());
    let model = alone(&beam);
    let (span, section) = (beam.spec().span, beam.spec().section);
    let omega = FRAC_PI_2 / span * (section.axial_stiffness.unwrap() / section.mass_per_length).sqrt();
    let first = 2 * beam.nodes();
    let mut v = sine(&beam, 1.0);
    let bend = v.clone();
    for (k, x) in beam.node_positions().iter().enumerate() {
        v[first + k] = (FRAC_PI_2 * x / span).sin();
    }
    let (steps, turns) = (400, 0.7);
    let h = turns / omega / f64::from(steps);
    let mut state = State::new(&model, &vec![0.0; beam.dofs()], &v, h).unwrap();
    advance(&model, &mut state, u64::from(steps as u32));
    let end = state.q[first + n] * omega;
    assert!((end - turns.sin()).abs() < 1e-4, "{end}");
    let mut without = State::new(&model, &vec![0.0; beam.dofs()], &bend, h).unwrap();
    advance(&model, &mut without, u64::from(steps as u32));
    assert_eq!(state.q[..first], without.q[..first]);
    assert!(state.ledger.relative_residual() < 1e-14);
}

/// A thin beam that stretches a hundred times stiffer than it bends settles where the beam's own statics says.
#[test]
fn a_held_beam_settles_where_its_statics_says() {
    for thickness in [0.0003, 0.001, 0.02] {
        let section = Section::rectangle(0.05, thickness, 210e9, 7850.0).unwrap();
        let beam = Arc::new(Beam::new(BeamSpec::new(2.0, 20, section).axial(Axial::Held)).unwrap());
        for force in [-0.1, -2.0, -10.0] {
            let mut exact = vec![0.0; beam.dofs()];
            beam.add_point_load(0.7, force, &mut exact).unwrap();
            let pattern = exact.clone();
            beam.solve_static(&mut exact).unwrap();
            let signal: Arc<dyn Signal> = Arc::new(Formula::constant(0.0).unwrap());
            let load = SignalLoad::new(pattern, signal);
            let body = BeamBody::new(Arc::clone(&beam), Vector2::zeros(), BeamSurface::Axis).with_load(Box::new(load));
            let mut parts = ModelBuilder::new();
            parts.add(body);
            let model = parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap();
            let limits = SettlingLimits { reach: &[], margin: 0.0, tau: SettlingLimits::FIRST_TAU };
            let found =
                settle(&model, 0.0, &vec![0.0; beam.dofs()], &limits, &mut crate::scenes::workspace(&model)).unwrap();
            let middle = |q: &[f64]| beam.deflection_at(q, 1.0).unwrap().w;
            let error = middle(&found.q) / middle(&exact) - 1.0;
            assert!(error.abs() < 1e-9, "{thickness} {force}: {error:e} after {} rounds", found.rounds);
        }
    }
}

/// The weight acts whatever the damping: a beam let go from its equilibrium under it stays there.
#[test]
fn a_beam_at_rest_under_its_weight_stays_at_rest_however_it_is_damped() {
    let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap();
    for damping in [
        Damping::default(),
        Damping::none().with_viscous(0.4),
        Damping::none().with_rayleigh_mass(3.0),
        Damping::none().with_rayleigh_stiffness(1e-5),
        Damping::none().with_modal(vec![0.01]),
    ] {
        let beam = Arc::new(Beam::new(BeamSpec::new(0.36, 20, section).damped(damping.clone())).unwrap());
        let mut q = vec![0.0; beam.dofs()];
        beam.add_self_weight(-9.81, &mut q).unwrap();
        beam.solve_static(&mut q).unwrap();
        let body = BeamBody::new(Arc::clone(&beam), Vector2::zeros(), BeamSurface::Axis);
        let mut parts = ModelBuilder::new();
        parts.add(body.with_weight(Vector2::new(0.0, -9.81)));
        let model = parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap();
        let mut state = State::new(&model, &q, &vec![0.0; beam.dofs()], 1e-3).unwrap();
        advance(&model, &mut state, 200);
        let middle = |q: &[f64]| beam.deflection_at(q, 0.18).unwrap().w;
        assert!((middle(&state.q) / middle(&q) - 1.0).abs() < 1e-10, "{damping:?}");
        assert!(state.ledger.relative_residual() < 1e-12);
    }
}
