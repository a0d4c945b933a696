//! The numbers of an independent implementation (`../shared/reference`), case by case, at equal conventions.
//!
//! The initial state is the one in the file, so that what is tested is the step alone.

use crate::scenes::{BlockSpec, beam_body, model, workspace};
use nalgebra::Vector2;
use serde_json::Value;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Damping, Section};
use teeter_detect::Kinematics;
use teeter_integrator::*;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

/// Compares the state with the samples as the steps pass them.
struct Comparer<'a> {
    case: &'a Value,
    beam: Option<Arc<Beam>>,
    next: usize,
    worst: f64,
}

impl Observer<2> for Comparer<'_> {
    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        let rows = self.case["samples"]["rows"].as_array().unwrap();
        let Some(row) = rows.get(self.next) else { return Ok(ControlFlow::Continue(())) };
        let row = numbers(row);
        if (row[0] - state.t).abs() > 0.5 * state.dt {
            return Ok(ControlFlow::Continue(()));
        }
        let mut found = vec![state.t];
        found.extend(&state.q[..3]);
        found.extend(&state.v[..3]);
        if let Some(beam) = &self.beam {
            found.push(beam.deflection_at(&state.q[3..], 0.5 * beam.spec().span).unwrap().w);
        }
        let tolerance = &self.case["tolerance"]["same_scheme"][self.next];
        for (k, (found, expected)) in found.iter().zip(&row).enumerate() {
            // null: beyond the motion's horizon
            if let Some(tolerance) = tolerance.get(k).and_then(Value::as_f64) {
                let error = (found - expected).abs();
                self.worst = self.worst.max(error / tolerance);
                let column = &self.case["samples"]["columns"][k];
                assert!(error <= tolerance, "{column} at {}: {found:e}, not {expected:e} (off by {error:e})", row[0]);
            }
        }
        self.next += 1;
        Ok(ControlFlow::Continue(()))
    }
}

fn compare(name: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/reference").join(format!("{name}.json"));
    let Ok(text) = std::fs::read_to_string(&path) else {
        eprintln!("skipped: there is no {}", path.display());
        return;
    };
    let case: Value = serde_json::from_str(&text).unwrap();
    let (params, scheme) = (&case["params"], &case["scheme"]);
    let number = |value: &Value| value.as_f64().unwrap();
    let spec = BlockSpec {
        width: number(&params["block"]["b"]),
        height: number(&params["block"]["H"]),
        depth: number(&params["block"]["depth"]),
        density: number(&params["block"]["rho"]),
    };
    let law = PairLaw::new(number(&params["contact"]["mu"]), number(&params["contact"]["e"]));
    let gravity = Vector2::from_vec(numbers(&params["gravity"]));
    let mut q = numbers(&case["initial"]["block_q"]);
    let mut v = numbers(&case["initial"]["block_v"]);
    let beam = params["beam"].as_object().map(|b| {
        let section =
            Section::rectangle(number(&b["width"]), number(&b["thickness"]), number(&b["E"]), number(&b["rho"]))
                .unwrap();
        Arc::new(
            Beam::new(
                BeamSpec::new(number(&b["L"]), b["n_el"].as_u64().unwrap() as usize, section)
                    .damped(Damping::none().with_viscous(number(&b["c"]))),
            )
            .unwrap(),
        )
    });
    let surface: Box<dyn Subsystem<2>> = match &beam {
        Some(beam) => {
            match case["initial"]["beam_nodes"].as_array() {
                Some(nodes) => {
                    let nodes: Vec<[f64; 2]> = nodes.iter().map(|n| [number(&n[0]), number(&n[1])]).collect();
                    q.extend(beam.from_nodes(&nodes).unwrap());
                }
                None => q.resize(3 + beam.dofs(), 0.0),
            }
            v.resize(3 + beam.dofs(), 0.0);
            Box::new(beam_body(beam))
        }
        None => Box::new(Ground::flat(0.0)),
    };
    let kinematics = if scheme["kinematics"] == "linear" { Kinematics::Linear } else { Kinematics::Deformed };
    let model = model(&spec, gravity, law, kinematics, surface);
    let mut state = State::new(&model, &q, &v, number(&scheme["h"])).unwrap();
    let mut work = workspace(&model);
    let mut integrator = MoreauJean::new(MoreauJeanSettings {
        theta: number(&scheme["theta"]),
        activation_gamma: number(&scheme["gamma"]),
        gap_tolerance: number(&scheme["gap_tol"]),
    })
    .unwrap();
    let mut comparer = Comparer { case: &case, beam, next: 0, worst: 0.0 };
    let steps = (number(&scheme["T"]) / state.dt).round() as u64;
    let plan = Plan::steps(steps).when_unsolved(Unsolved::End);
    let ended = run(&model, &mut integrator, &mut state, &mut work, &plan, &mut [&mut comparer]).unwrap();
    assert_eq!(ended, Ended::Complete);
    assert_eq!(comparer.next, case["samples"]["rows"].as_array().unwrap().len());

    let results = &case["results"];
    let energy = &results["energy"];
    eprintln!(
        "{name}: worst {:.3} of the tolerance, penetration {:e} (theirs {}), identity {:e} of the scale",
        comparer.worst,
        state.tally.max_penetration,
        results["max_penetration"],
        state.ledger.relative_residual()
    );
    assert!(state.ledger.relative_residual() <= 1e-12);
    assert!((state.tally.max_penetration - number(&results["max_penetration"]).max(0.0)).abs() <= 1e-11);
    assert!(state.tally.max_residual <= 1e-14, "{:e}", state.tally.max_residual);
    assert!(state.ledger.largest_tangential_work <= 1e-15 * state.ledger.scale);
    // The file's contact work is that of the mean velocity ½(U⁰ + U¹), the identity's that of U_θ: the same for θ = ½.
    if number(&scheme["theta"]) == 0.5 {
        let contact_work = state.ledger.sum.contact + state.ledger.sum.friction;
        assert!((contact_work - number(&energy["contact_work"])).abs() <= 1e-9 * state.ledger.scale);
    }
    assert!((state.ledger.sum.viscous + number(&energy["viscous_loss"])).abs() <= 1e-9 * state.ledger.scale);
}

macro_rules! cases {
    ($($test:ident: $file:literal;)*) => {
        $(#[test]
        fn $test() {
            compare($file);
        })*
    };
}

cases! {
    r1_housner_block: "R1_h1e-4";
    r1_theta_three_quarters: "R1_theta0.75_h1e-4";
    r2_restitution: "R2_e0.3_h1e-4";
    r3_slides: "R3_mu0.1_h1e-4";
    r4_flat_drop: "R4_drop_h1e-4";
    s1_slides_on_a_floor: "S1_slide_floor_h1e-3";
    s3_slides_down_an_incline: "S3_incline_slide_h1e-3";
    s4_bounces: "S4_bounce_e0.8_h1e-4";
    b_static_start: "B_base_static_h1e-4";
    b_static_start_2_degrees: "B_2deg_static_h1e-4";
    b_static_start_3_mm: "B_3mm_static_h1e-5";
    b_static_start_restitution: "B_e0.3_static_h1e-4";
    b_undeformed_start: "B_base_undef_h1e-4";
    b_undeformed_start_10_elements: "B_n10_undef_h1e-4";
    b_undeformed_start_linear: "B_linear_undef_h1e-4";
}
