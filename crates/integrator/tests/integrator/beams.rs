//! Beams without blocks, stepped by the scheme: the reference's cases F3 to F5, and the work of loads in the account.

use nalgebra::Vector2;
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Damping, DistributedLoad, MovingLoad, Section};
use teeter_detect::PointDetector;
use teeter_integrator::*;

/// The paper's beam alone, under loads.
fn model(damping: Damping, loads: Vec<Box<dyn teeter_beam::Load>>) -> (Arc<Beam>, Model<2>) {
    let spec = BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap()).damped(damping);
    let beam = Arc::new(Beam::new(spec).unwrap());
    let body = loads
        .into_iter()
        .fold(BeamBody::new(Arc::clone(&beam), Vector2::zeros(), BeamSurface::Axis), BeamBody::with_load);
    let mut parts = ModelBuilder::new();
    parts.add(body);
    (beam, parts.build(Box::new(PointDetector::new(Vec::new()))).unwrap())
}

fn step(model: &Model<2>, state: &mut State, theta: f64, steps: u64) {
    let mut work = crate::scenes::workspace(model);
    let mut scheme = MoreauJean::new(MoreauJeanSettings { theta, ..MoreauJeanSettings::default() }).unwrap();
    let plan = Plan::steps(steps).when_unsolved(Unsolved::End);
    assert_eq!(run(model, &mut scheme, state, &mut work, &plan, &mut []).unwrap(), Ended::Complete);
}

/// Compares with a reference case by one of its tolerances.
fn reference(name: &str, tolerances: &str, damping: Damping, loads: Vec<Box<dyn teeter_beam::Load>>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/reference").join(format!("{name}.json"));
    let Ok(text) = std::fs::read_to_string(&path) else {
        eprintln!("skipped: there is no {}", path.display());
        return;
    };
    let case: Value = serde_json::from_str(&text).unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    let (beam, model) = model(damping, loads);
    let nodes = |key: &str| -> Vec<f64> {
        let nodes = case["initial"][key].as_array().unwrap();
        let nodes: Vec<[f64; 2]> = nodes.iter().map(|n| [number(&n[0]), number(&n[1])]).collect();
        beam.from_nodes(&nodes).unwrap()
    };
    let h = number(&case["scheme"]["h"]);
    let mut state = State::new(&model, &nodes("beam_q_nodes"), &nodes("beam_v_nodes"), h).unwrap();
    let rows = case["samples"]["rows"].as_array().unwrap();
    for (row, tolerance) in rows.iter().zip(case["tolerance"][tolerances].as_array().unwrap()) {
        step(&model, &mut state, number(&case["scheme"]["theta"]), (number(&row[0]) / h).round() as u64);
        let found =
            [state.t, beam.deflection_at(&state.q, 0.18).unwrap().w, beam.deflection_at(&state.v, 0.18).unwrap().w];
        for k in 0..3 {
            let error = (found[k] - number(&row[k])).abs();
            assert!(error <= number(&tolerance[k]), "column {k} at t = {}: off by {error:e}", state.t);
        }
    }
    assert!(state.ledger.relative_residual() <= 1e-12, "{:e}", state.ledger.relative_residual());
}

#[test]
fn f3_damped_free_vibration() {
    let c = 0.4050832789976532;
    reference("F3_damped_free_theta0.5_h1e-4", "same_scheme", Damping::none().with_viscous(c), Vec::new());
}

#[test]
fn f4_moving_force() {
    let load = MovingLoad::new(-10.0, 2.0, 0.0).unwrap();
    // The reference takes the force at both ends of a step, this scheme its mean over the step.
    reference("F4_moving_force_h1e-4", "other_scheme", Damping::default(), vec![Box::new(load)]);
}

#[test]
fn f5_undamped_vibration() {
    reference("F5_undamped_theta0.5_h1e-3", "same_scheme", Damping::default(), Vec::new());
}

#[test]
fn the_work_of_loads_is_in_the_account_for_every_theta() {
    for theta in [0.5, 0.75, 1.0] {
        let damping = Damping::none().with_viscous(0.4).with_rayleigh_mass(0.5).with_rayleigh_stiffness(1e-6);
        let loads: Vec<Box<dyn teeter_beam::Load>> = vec![
            Box::new(MovingLoad::new(-10.0, 2.0, 0.0).unwrap()),
            Box::new(DistributedLoad::new(|t: f64| 5.0 * (300.0 * t).sin())),
        ];
        let (beam, model) = model(damping, loads);
        let rest = vec![0.0; beam.dofs()];
        let mut state = State::new(&model, &rest, &rest, 1e-4).unwrap();
        step(&model, &mut state, theta, 2000);
        let (ledger, sum) = (&state.ledger, &state.ledger.sum);
        assert!(ledger.relative_residual() <= 1e-12, "theta {theta}: {:e}", ledger.relative_residual());
        assert!(sum.external > 0.0 && sum.viscous < 0.0 && (sum.numerical < 0.0) == (theta > 0.5), "{sum:?}");
        let total = sum.external + sum.viscous + sum.numerical;
        assert!((ledger.current.total() - total).abs() <= 1e-12 * ledger.scale, "it all came from the loads");
    }
}
