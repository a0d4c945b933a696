//! The beam cases F1 to F5 of the independent implementation, where that folder is at hand. Its README explains the
//! tolerances; `same_scheme` is for a program with the same conventions.

use serde_json::Value;
use teeter_beam::{Beam, BeamSpec, Load, MovingLoad, Section, Support};

#[cfg(feature = "faer")]
use crate::frequencies::circular_frequencies;
use crate::stepping::Stepper;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/reference");

/// The case, or `None` (with a word) where the folder is missing. A file missing from a folder that is there is an error.
fn case(name: &str) -> Option<Value> {
    if !std::path::Path::new(FOLDER).is_dir() {
        eprintln!("skipped {name}: no folder {FOLDER}");
        return None;
    }
    let text = std::fs::read_to_string(format!("{FOLDER}/{name}.json")).unwrap();
    Some(serde_json::from_str(&text).unwrap())
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn spec(case: &Value, elements: usize, supports: [Support; 2]) -> BeamSpec {
    let b = &case["params"]["beam"];
    let section =
        Section::rectangle(number(&b["width"]), number(&b["thickness"]), number(&b["E"]), number(&b["rho"])).unwrap();
    BeamSpec::new(number(&b["L"]), elements, section).supported(supports)
}

fn supports(name: &str) -> [Support; 2] {
    match name {
        "pinned-pinned" => [Support::Pinned; 2],
        "clamped-clamped" => [Support::Clamped; 2],
        "cantilever" => [Support::Clamped, Support::Free],
        other => panic!("unknown supports {other}"),
    }
}

#[cfg(feature = "faer")]
#[test]
fn f1_frequencies() {
    let Some(case) = case("F1_frequencies") else {
        return;
    };
    for (name, results) in case["results"].as_object().unwrap() {
        for (n, listed) in results["fem_rad_s"].as_object().unwrap() {
            let beam = Beam::new(spec(&case, n.parse().unwrap(), supports(name))).unwrap();
            let found = circular_frequencies(&beam);
            let tolerance = number(&case["tolerance"]["rel"][n]);
            for (mode, listed) in listed.as_array().unwrap().iter().enumerate() {
                let error = (found[mode] / number(listed) - 1.0).abs();
                assert!(error < tolerance, "{name} n {n} mode {}: {error:e}", mode + 1);
                let exact = beam.circular_frequency(mode + 1).unwrap();
                assert!((exact / number(&results["exact_rad_s"][mode]) - 1.0).abs() < 2e-15, "{name} {}", mode + 1);
            }
        }
    }
}

#[test]
fn f2_static_deflections() {
    let Some(case) = case("F2_static") else {
        return;
    };
    for (name, listed) in case["results"]["fem"].as_object().unwrap() {
        let (pair, n) = name.split_once(" n").unwrap();
        let beam = Beam::new(spec(&case, n.parse().unwrap(), supports(pair))).unwrap();
        for (x, key) in [(number(&listed["load_x"]), "w_at_load"), (0.165, "w_at_0165_for_load_at_0165")] {
            let mut q = vec![0.0; beam.dofs()];
            beam.add_point_load(x, -1.0, &mut q).unwrap();
            beam.solve_static(&mut q).unwrap();
            let error = (beam.deflection_at(&q, x).unwrap().w / number(&listed[key]) - 1.0).abs();
            assert!(error < number(&case["tolerance"]["rel"]), "{name} {key}: {error:e}");
        }
    }
}

fn nodes(list: &Value) -> Vec<[f64; 2]> {
    list.as_array().unwrap().iter().map(|pair| [number(&pair[0]), number(&pair[1])]).collect()
}

/// Runs a case and compares midspan deflection and velocity at its sample times.
fn run(case: &Value, load: Option<&dyn Load>) {
    let elements = case["params"]["beam"]["n_el"].as_u64().unwrap() as usize;
    let mut spec = spec(case, elements, supports(case["params"]["beam"]["bc"].as_str().unwrap()));
    spec.damping.viscous = case["params"]["c"].as_f64().unwrap_or(0.0);
    let beam = Beam::new(spec).unwrap();
    let q = beam.from_nodes(&nodes(&case["initial"]["beam_q_nodes"])).unwrap();
    let v = beam.from_nodes(&nodes(&case["initial"]["beam_v_nodes"])).unwrap();
    let (h, theta) = (number(&case["scheme"]["h"]), number(&case["scheme"]["theta"]));
    let mut run = Stepper::new(&beam, h, theta, q, v, load);
    let rows = case["samples"]["rows"].as_array().unwrap();
    let tolerances = case["tolerance"]["same_scheme"].as_array().unwrap();
    for (row, tolerance) in rows.iter().zip(tolerances) {
        let t = number(&row[0]);
        while f64::from(run.step) < (t / h).round() {
            run.advance();
        }
        let middle = |x: &[f64]| beam.deflection_at(x, 0.5 * beam.spec().span).unwrap().w;
        for (column, found) in [(1, middle(&run.q)), (2, middle(&run.v))] {
            let error = (found - number(&row[column])).abs();
            assert!(error <= number(&tolerance[column]), "t {t} column {column}: {error:e}");
        }
    }
    let last = number(&case["results"]["energy"]["final"]);
    assert!((run.energy() / last - 1.0).abs() < 1e-8, "{} {last}", run.energy());
}

#[test]
fn f3_damped_free_vibration() {
    let Some(case) = case("F3_damped_free_theta0.5_h1e-4") else {
        return;
    };
    run(&case, None);
}

#[test]
fn f4_moving_force() {
    let Some(case) = case("F4_moving_force_h1e-4") else {
        return;
    };
    let load = MovingLoad::new(number(&case["params"]["force"]), number(&case["params"]["speed"]), 0.0).unwrap();
    run(&case, Some(&load));
}

#[test]
fn f5_undamped_vibration() {
    let Some(case) = case("F5_undamped_theta0.5_h1e-3") else {
        return;
    };
    run(&case, None);
}

/// Numbers of the F cases that need no folder: midspan of F5 at t = 0.1, of F4 at 0.03.
#[test]
fn two_samples_carried_over_from_the_reference() {
    let beam = super::beam(20, [Support::Pinned; 2]);
    let zero = vec![0.0; beam.dofs()];
    let v = crate::stepping::sines(&beam, &[(1.0, 1.0), (3.0, 0.5)]);
    let mut run = Stepper::new(&beam, 1e-3, 0.5, zero.clone(), v, None);
    while run.step < 100 {
        run.advance();
    }
    assert!((beam.deflection_at(&run.q, 0.18).unwrap().w + 0.004813336708264411).abs() < 1e-11);
    let load = MovingLoad::new(-10.0, 2.0, 0.0).unwrap();
    let mut run = Stepper::new(&beam, 1e-4, 0.5, zero.clone(), zero, Some(&load));
    while run.step < 300 {
        run.advance();
    }
    assert!((beam.deflection_at(&run.q, 0.18).unwrap().w + 0.009805604015037623).abs() < 1e-11);
}
