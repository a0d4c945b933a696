//! Scenes run in memory: the numbers of an independent implementation, and what every scenario must
//! keep.

use serde_json::Value;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::load;
use teeter_scenario::simulation::Simulation;

pub(crate) fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Reads a scenario's companion, a file that it names.
pub(crate) fn companion(file: &str) -> Result<Vec<u8>, String> {
    std::fs::read(workspace().join("scenarios").join(file)).map_err(|error| error.to_string())
}

fn scenario(name: &str, sets: &[(&str, &str)]) -> Simulation {
    let file = workspace().join("scenarios").join(format!("{name}.toml"));
    let text = std::fs::read(&file).unwrap();
    // The scheme of the independent implementation, where no other is asked for.
    let sets: Vec<_> =
        [("time.scheme", "moreau-jean")].iter().chain(sets).map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    let resolved = load(&text, name, name, &sets).unwrap_or_else(|errors| panic!("{errors}"));
    Simulation::new(&resolved.scene).unwrap()
}

/// Compares the columns of `trajectory.csv` with samples at stated times.
struct Comparer {
    rows: Vec<Vec<f64>>,
    tolerance: Vec<Vec<Option<f64>>>,
    middle: Option<(teeter_scenario::simulation::BeamPlace, f64)>,
    next: usize,
    worst: f64,
}

impl Observer<2> for Comparer {
    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        let Some(row) = self.rows.get(self.next) else { return Ok(ControlFlow::Break(())) };
        if (row[0] - state.t).abs() > 0.5 * state.dt {
            return Ok(ControlFlow::Continue(()));
        }
        let mut found = vec![state.t];
        found.extend(&state.q[..3]);
        found.extend(&state.v[..3]);
        if let Some((place, x)) = &self.middle {
            found.push(place.beam.deflection_at(&state.q[place.range.clone()], *x).unwrap().w);
        }
        for (k, (found, expected)) in found.iter().zip(row).enumerate() {
            if let Some(tolerance) = self.tolerance[self.next][k] {
                let error = (found - expected).abs();
                self.worst = self.worst.max(error / tolerance);
                assert!(error <= tolerance, "column {k} at {}: {found:e}, not {expected:e} (off by {error:e})", row[0]);
            }
        }
        self.next += 1;
        Ok(ControlFlow::Continue(()))
    }
}

impl Comparer {
    fn new(simulation: &Simulation, rows: Vec<Vec<f64>>, tolerance: Vec<Vec<Option<f64>>>) -> Self {
        let middle = simulation.layout.beams.first().map(|place| (place.clone(), 0.5 * place.beam.spec().span));
        Self { rows, tolerance, middle, next: 0, worst: 0.0 }
    }

    fn compare(mut self, mut simulation: Simulation) -> f64 {
        let ended = simulation.run(&mut [&mut self]).unwrap();
        assert!(
            matches!(ended, teeter_integrator::Ended::Complete | teeter_integrator::Ended::Interrupted),
            "{ended:?}"
        );
        assert_eq!(self.next, self.rows.len(), "the run ended before the last sample");
        self.worst
    }
}

/// Runs a scenario with overrides against a case of `../shared/reference`.
fn reference(case: &str, name: &str, sets: &[(&str, &str)]) {
    let path = workspace().join("../shared/reference").join(format!("{case}.json"));
    let Ok(text) = std::fs::read_to_string(&path) else {
        eprintln!("skipped: there is no {}", path.display());
        return;
    };
    let case: Value = serde_json::from_str(&text).unwrap();
    let table = |value: &Value| -> Vec<Vec<Option<f64>>> {
        let row = |row: &Value| row.as_array().unwrap().iter().map(Value::as_f64).collect();
        value.as_array().unwrap().iter().map(row).collect()
    };
    let rows: Vec<Vec<f64>> =
        table(&case["samples"]["rows"]).into_iter().map(|row| row.into_iter().flatten().collect()).collect();
    let mut tolerance = table(&case["tolerance"]["same_scheme"]);
    // null for a whole row: beyond the motion's horizon.
    tolerance.iter_mut().zip(&rows).for_each(|(t, row)| t.resize(row.len(), None));
    let simulation = scenario(name, sets);
    let worst = Comparer::new(&simulation, rows, tolerance).compare(simulation);
    eprintln!("{name} {sets:?}: worst {worst:.3} of the tolerance");
}

const ON_GROUND: (&str, &str) = ("block.rocker.at", "1.5 cm");

macro_rules! cases {
    ($($test:ident: $case:literal, $scenario:literal, $sets:expr;)*) => {
        $(#[test]
        fn $test() {
            reference($case, $scenario, $sets);
        })*
    };
}

cases! {
    r1_housner_block: "R1_h1e-4", "free-rocking-on-ground", &[ON_GROUND];
    r1_theta_three_quarters: "R1_theta0.75_h1e-4", "free-rocking-on-ground", &[ON_GROUND, ("time.theta", "0.75")];
    r2_restitution: "R2_e0.3_h1e-4", "free-rocking-on-ground", &[ON_GROUND, ("contact.feet.restitution", "0.3")];
    r3_slides: "R3_mu0.1_h1e-4", "free-rocking-on-ground", &[ON_GROUND, ("contact.feet.friction", "0.1")];
    r4_flat_drop: "R4_drop_h1e-4", "drop", &[
        ("time.end", "0.2 s"),
        ("block.cube.width", "3 cm"),
        ("block.cube.height", "13.5 cm"),
        ("block.cube.depth", "3 cm"),
        ("block.cube.position", "['0 m', '7.75 cm']"),
        ("contact.base.friction", "0.5"),
        ("contact.base.restitution", "0"),
    ];
    s1_slides_on_a_floor: "S1_slide_floor_h1e-3", "sliding", &[];
    s3_slides_down_an_incline: "S3_incline_slide_h1e-3", "sliding", &[
        ("time.end", "1 s"),
        ("block.slider.velocity", "['0 m/s', '0 m/s']"),
        // 9.81 m/s² turned by 20 degrees
        ("world.gravity", "['3.3552176060248105 m/s^2', '-9.218384609909762 m/s^2']"),
    ];
    s4_bounces: "S4_bounce_e0.8_h1e-4", "drop", &[];
    b_static_start: "B_base_static_h1e-4", "free-rocking-on-beam", &[];
    b_static_start_2_degrees: "B_2deg_static_h1e-4", "free-rocking-on-beam", &[("block.rocker.tilt", "2 deg")];
    b_static_start_3_mm: "B_3mm_static_h1e-5", "free-rocking-on-beam", &[
        ("beam.table.thickness", "3 mm"),
        ("time.step", "10 us"),
    ];
    b_static_start_restitution: "B_e0.3_static_h1e-4", "free-rocking-on-beam", &[("contact.feet.restitution", "0.3")];
    b_undeformed_start: "B_base_undef_h1e-4", "free-rocking-on-beam-undeformed-start", &[];
    b_undeformed_start_10_elements: "B_n10_undef_h1e-4", "free-rocking-on-beam-undeformed-start", &[
        ("beam.table.elements", "10"),
    ];
    b_undeformed_start_linear: "B_linear_undef_h1e-4", "free-rocking-on-beam-undeformed-start", &[
        ("contact.feet.kinematics", "linear"),
    ];
}

/// Some of the reference's numbers, so that they are tested without its files too: t, X, Y, φ.
#[test]
fn carried_numbers_of_the_independent_implementation() {
    /// A scenario, its overrides, and rows of t, X, Y, φ.
    type Case = (&'static str, &'static [(&'static str, &'static str)], &'static [[f64; 4]]);
    let cases: [Case; 4] = [
        (
            "free-rocking-on-beam",
            &[],
            &[
                [0.1, 0.17926683705463634, 0.06259178228062427, 0.010849536089382616],
                [0.3, 0.17913693382833515, 0.06134372819474678, 0.012767090552912974],
            ],
        ),
        (
            "free-rocking-on-beam-undeformed-start",
            &[],
            &[
                [0.1, 0.17841819969678183, 0.06015609181643787, 0.02337617168824336],
                [0.3, 0.1991989972622166, 0.06768469616560796, -0.2794368542166344],
            ],
        ),
        (
            "free-rocking-on-ground",
            &[ON_GROUND],
            &[
                [0.1, 0.014241386339184621, 0.06766410824022032, 0.011225683503156565],
                [0.2, 0.01991416887763927, 0.06840515297386479, -0.07228492161423923],
            ],
        ),
        ("sliding", &[], &[[0.3, 0.16756499999999916, 0.025, 0.0], [0.5, 0.16989490999999904, 0.025, 0.0]]),
    ];
    for (name, sets, rows) in cases {
        let simulation = scenario(name, sets);
        let tolerance = vec![vec![Some(1e-11); 4]; rows.len()];
        Comparer::new(&simulation, rows.iter().map(|row| row.to_vec()).collect(), tolerance).compare(simulation);
    }
}

const SCENARIOS: [&str; 5] =
    ["free-rocking-on-beam", "free-rocking-on-beam-undeformed-start", "free-rocking-on-ground", "sliding", "drop"];

#[test]
fn every_scenario_closes_its_energy_account_for_every_theta() {
    for name in SCENARIOS {
        for theta in ["0.5", "0.75", "1"] {
            let mut simulation = scenario(name, &[("time.theta", theta)]);
            assert_eq!(simulation.run(&mut []).unwrap(), Ended::Complete);
            let ledger = &simulation.state.ledger;
            let relative = ledger.relative_residual();
            eprintln!(
                "{name}, theta {theta}: identity to {relative:.1e}, contact gains in {} steps, {:.2e} J in all",
                ledger.positive_contact_work.steps, ledger.positive_contact_work.sum
            );
            assert!(relative <= 1e-12, "{name}, theta {theta}: {relative:e}");
            assert!(ledger.largest_tangential_work <= 1e-15 * ledger.scale, "{name}, theta {theta}: {ledger:?}");
            assert!(ledger.sum.numerical <= 0.0);
            assert_eq!(simulation.state.tally.unconverged_steps, 0);
        }
    }
}

#[test]
fn the_undeformed_start_overturns_between_02_and_03_seconds_and_the_static_one_does_not() {
    struct Overturning(Option<f64>);
    impl Observer<2> for Overturning {
        fn observe(
            &mut self,
            _: &Model<2>,
            _: &StepReport<'_, 2>,
            state: &State,
        ) -> Result<ControlFlow<()>, ObserverError> {
            let alpha = 0.03_f64.atan2(0.135);
            if state.q[2].abs() > alpha && self.0.is_none() {
                self.0 = Some(state.t);
            }
            Ok(ControlFlow::Continue(()))
        }
    }
    let mut seen = Overturning(None);
    assert_eq!(
        scenario("free-rocking-on-beam-undeformed-start", &[]).run(&mut [&mut seen]).unwrap(),
        teeter_integrator::Ended::Complete
    );
    assert!(seen.0.is_some_and(|t| (0.2..0.3).contains(&t)), "{:?}", seen.0);
    let mut seen = Overturning(None);
    assert_eq!(
        scenario("free-rocking-on-beam", &[]).run(&mut [&mut seen]).unwrap(),
        teeter_integrator::Ended::Complete
    );
    assert_eq!(seen.0, None);
}

#[test]
fn gauss_seidel_gives_the_motion_of_the_exact_solver() {
    for name in SCENARIOS {
        let end = |method| {
            let mut simulation = scenario(name, &[("solver.method", method), ("solver.tolerance", "1e-13")]);
            assert_eq!(simulation.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
            assert_eq!(simulation.state.tally.unconverged_steps, 0, "{name} {method}");
            simulation.state.q
        };
        let (exact, iterated) = (end("enumeration"), end("pgs"));
        for (a, b) in exact.iter().zip(&iterated) {
            assert!((a - b).abs() < 1e-8, "{name}: {a} {b}");
        }
    }
}

#[test]
fn a_static_start_stays_in_equilibrium_while_the_block_is_upright() {
    // Off the middle, so that the two feet share the weight unevenly; held upright by the couple of
    // the two feet themselves as long as both carry. A step then changes nothing but by the tilt
    // that the sag would bring.
    for (surface, kinematics) in [("axis", "deformed"), ("axis", "linear"), ("top", "deformed"), ("top", "linear")] {
        let simulation = scenario(
            "free-rocking-on-beam",
            &[("block.rocker.tilt", "0 deg"), ("beam.table.surface", surface), ("contact.feet.kinematics", kinematics)],
        );
        let mut candidates = Vec::new();
        simulation.model.candidates(&simulation.state.q, 1e-12, &mut candidates).unwrap();
        assert_eq!(candidates.len(), 2, "both feet touch ({surface}, {kinematics})");
        assert!(candidates.iter().all(|c| c.gap.abs() < 1e-14), "{candidates:?}");
        // Symmetric: half the weight under each foot, and the beam's strain energy is half the work
        // of the weight.
        let place = &simulation.layout.beams[0];
        let q = &simulation.state.q[place.range.clone()];
        let sag = -place.beam.deflection_at(q, 0.165).unwrap().w;
        let work = 0.5 * 0.32805 * 9.81 * sag;
        let strain = place.beam.elastic_energy(q);
        assert!((strain / work - 1.0).abs() < if surface == "axis" { 1e-10 } else { 1e-2 }, "{strain} {work}");
    }
}

#[test]
fn a_tilted_block_on_the_top_fibre_starts_in_touch_and_moves_like_one_on_the_axis_of_a_thin_beam() {
    let run = |surface| {
        let mut simulation =
            scenario("free-rocking-on-beam", &[("beam.table.surface", surface), ("time.end", "0.05 s")]);
        assert_eq!(simulation.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
        assert!(simulation.state.ledger.relative_residual() <= 1e-12);
        simulation.state.q[2]
    };
    let (axis, top) = (run("axis"), run("top"));
    assert!((axis - top).abs() < 0.01 * axis.abs() && axis != top, "{axis} {top}");
}

#[test]
fn a_mirrored_scene_gives_the_mirrored_motion() {
    for name in ["free-rocking-on-beam", "free-rocking-on-ground"] {
        let end = |tilt| {
            let mut simulation = scenario(name, &[("block.rocker.tilt", tilt), ("time.end", "0.15 s")]);
            assert_eq!(simulation.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
            simulation.state.q
        };
        let (left, right) = (end("5 deg"), end("-5 deg"));
        assert!((left[2] + right[2]).abs() < 1e-9, "{} {}", left[2], right[2]);
        assert!((left[1] - right[1]).abs() < 1e-9);
    }
}

#[test]
fn order_and_position_of_bodies_do_not_matter() {
    // The whole scene moved by 1 m along x, and the names of the contact turned round.
    let text = std::fs::read_to_string(workspace().join("scenarios/free-rocking-on-beam.toml")).unwrap();
    let moved = text
        .replace("at       = \"18 cm\"", "at = \"118 cm\"")
        .replace("start         =", "position = [\"1 m\", \"0.5 m\"]\nstart =")
        .replace("[\"rocker\", \"table\"]", "[\"table\", \"rocker\"]");
    let end = |text: &str| {
        let resolved = load(text.as_bytes(), "scene", "scene", &[("time.end".to_owned(), "0.1 s".to_owned())]).unwrap();
        let mut simulation = Simulation::new(&resolved.scene).unwrap();
        assert_eq!(simulation.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
        simulation.state.q
    };
    let (here, there) = (end(&text), end(&moved));
    assert!((there[0] - here[0] - 1.0).abs() < 1e-9 && (there[1] - here[1] - 0.5).abs() < 1e-9);
    assert!((there[2] - here[2]).abs() < 1e-9);
}
