//! Recorded accelerations as motions, from the scene file to the motion.

use crate::running::companion;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_record::{ReadSettings, Record, STANDARD_GRAVITY};
use teeter_scenario::diagnostic::Diagnostics;
use teeter_scenario::load_with;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;

const BLOCK: &str = "
[material.m]
density = '1000 kg/m^3'
youngs_modulus = '69 GPa'
[block.b]
material = 'm'
width = '10 cm'
height = '10 cm'
depth = '10 cm'
position = ['0 m', '1 m']
";

/// A scene of 3 s with this ground motion, or whatever else stands in `more`; `file` is the content
/// of every file that it names.
fn loaded(more: &str, file: &[u8]) -> Result<Resolved, Diagnostics> {
    let text = format!("[time]\nend = '3 s'\nstep = '10 ms'\n[world]\ngravity = '0 m/s^2'\n{BLOCK}{more}\n");
    load_with(text.as_bytes(), "scene.toml", "scene", &[], &mut |_| Ok(file.to_vec()))
}

fn ground(keys: &str, file: impl AsRef<[u8]>) -> Result<Resolved, Diagnostics> {
    loaded(&format!("[ground]\nmotion.x = {{ record = 'quake.at2', {keys} }}"), file.as_ref())
}

/// The record that moves the ground.
fn shaken(keys: &str, file: impl AsRef<[u8]>) -> Record {
    let resolved = ground(keys, file).unwrap_or_else(|errors| panic!("{errors}"));
    resolved.scene.records().next().unwrap().record.clone()
}

const TABLE: &str = "t,a\n0,0.5\n0.5,-2\n1,3\n1.5,1\n2,0.25\n";

#[test]
fn velocity_and_displacement_are_the_exact_integrals_of_the_lines_between_values() {
    let resolved = ground("", TABLE).unwrap();
    let motion = &resolved.scene.ground.as_ref().unwrap().motion.motions()[0];
    let record = &resolved.scene.records().next().unwrap().record;
    let (velocities, displacements) = record.motion();
    for (k, (v, d)) in velocities.iter().zip(&displacements).enumerate() {
        let t = record.time(k);
        assert!((motion.velocity(t) - v).abs() < 1e-15 && (motion.displacement(t) - d).abs() < 1e-15, "{t}");
    }
    // From 0.5 to -2 in half a second: a = 0.5 - 5 t.
    let t = 0.3;
    assert!((motion.velocity(t) - (0.5 * t - 2.5 * t * t)).abs() < 1e-15);
    assert!((motion.displacement(t) - (0.25 * t * t - 5.0 * t * t * t / 6.0)).abs() < 1e-15);
    // After the last value the acceleration falls to 0 within a step; then the velocity stays.
    let end = velocities[4] + 0.5 * 0.5 * 0.25;
    assert!((motion.velocity(2.5) - end).abs() < 1e-15 && (motion.velocity(9.0) - end).abs() < 1e-14);
    assert_eq!((motion.acceleration(2.25), motion.acceleration(2.6)), (0.125, 0.0));
}

#[test]
fn a_block_and_the_supports_of_a_beam_move_as_the_record_says() {
    // A pulse that leaves 0.5 m/s, by lines of which the steps of 10 ms divide each.
    let pulse = "t,a\n0,0\n0.5,1\n1,0\n";
    let more = "motion = { x = { record = 'pulse.csv' }, angular_velocity = '0.25 rad/s' }\n";
    let resolved = loaded(more, pulse.as_bytes()).unwrap();
    let mut run = Simulation::new(&resolved.scene).unwrap();
    assert_eq!(run.run(&mut []).unwrap(), Ended::Complete);
    // Exact but for the mean over half a step at the start, of a third power: a/6 (h/2)³ = 4e-8.
    let exact = 0.5 * (3.0 - 0.5);
    assert!((run.state.q[0] - exact).abs() < 5e-8, "{:e}", run.state.q[0] - exact);
    assert!((run.state.v[0] - 0.5).abs() < 1e-15);
    assert_eq!(run.state.q[1], 1.0, "y stays free");
    assert!((run.state.q[2] - 0.75).abs() < 1e-14);

    let beam = "[beam.t]\nmaterial = 'm'\nspan = '1 m'\nwidth = '5 cm'\nthickness = '1 cm'\nelements = 4\n\
                motion.y = { record = 'pulse.csv', scale = -2 }\n";
    let resolved = loaded(beam, pulse.as_bytes()).unwrap();
    let mut run = Simulation::new(&resolved.scene).unwrap();
    assert_eq!(run.run(&mut []).unwrap(), Ended::Complete);
    let supports = run.layout.beams[0].supports.clone().unwrap();
    let [x, y] = [run.state.q[supports.start], run.state.q[supports.start + 1]];
    assert!(x == 0.0 && (y + 2.0 * exact).abs() < 1e-7, "{x} {y}");
}

#[test]
fn a_record_of_one_component_leaves_the_other_still_and_two_files_are_both_read() {
    let resolved = loaded(
        "[ground.motion]\nx = { record = 'east.csv' }\ny = { record = 'up.csv', scale = 0.5 }\nangle = '1 deg'\n",
        TABLE.as_bytes(),
    )
    .unwrap();
    let motion = resolved.scene.ground.as_ref().unwrap().motion.motions();
    assert_eq!(motion[1].acceleration(0.5), 0.5 * motion[0].acceleration(0.5));
    assert!(motion[2].displacement(1.0) > 0.0);
    let files: Vec<&str> = resolved.files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(files, ["east.csv", "up.csv"]);
    let still = ground("", TABLE).unwrap().scene.ground.unwrap().motion;
    assert!(still.0[1].is_none() && still.motions()[1].displacement(2.0) == 0.0);
}

#[test]
fn corrections_are_applied_in_their_order() {
    let file = Record::read(TABLE, "quake.at2").unwrap();
    assert_eq!(shaken("", TABLE), file);
    assert_eq!(shaken("scale = -0.5", TABLE), file.scaled(-0.5).unwrap());
    assert_eq!(shaken("peak = '0.4 gn'", TABLE).peak_acceleration(), 0.4 * STANDARD_GRAVITY);
    let all = "from = '0.5 s', to = '2 s', baseline = 'linear', taper = 0.4, peak = '2 m/s^2'";
    let chain = file.cut(0.5, 2.0).unwrap().baseline_corrected(1).unwrap();
    assert_eq!(shaken(all, TABLE), chain.tapered(0.4).unwrap().scaled_to_peak(2.0).unwrap());
    for (degree, word) in ["mean", "linear", "quadratic", "cubic"].into_iter().enumerate() {
        let corrected = shaken(&format!("baseline = '{word}'"), TABLE);
        assert_eq!(corrected, file.baseline_corrected(degree).unwrap(), "{word}");
    }
    assert_eq!(shaken("to = '1 s'", TABLE).duration(), 1.0);
    assert_eq!(shaken("from = '1 s'", TABLE).accelerations(), [3.0, 1.0, 0.25]);
}

#[test]
fn the_format_is_told_by_the_content_and_what_it_lacks_is_given() {
    let values = [0.5, -2.0, 3.0, 1.0];
    let peer = "PEER STRONG MOTION DATABASE RECORD\nSomewhere\nACCELERATION TIME HISTORY IN UNITS OF G\n\
                NPTS= 4, DT= .5 SEC\n .5 -2. 3. 1.\n";
    let esm = "EVENT_NAME: Somewhere\nSAMPLING_INTERVAL_S: 0.5\nNDATA: 4\nDATA_TYPE: ACCELERATION\nUNITS: cm/s^2\n\
               USER1:\n50\n-200\n300\n100\n";
    let near = |record: &Record, factor: f64| {
        assert_eq!(record.dt(), 0.5);
        for (a, b) in record.accelerations().iter().zip(values) {
            assert!((a - factor * b).abs() < 1e-15 * factor.max(1.0) * 4.0, "{a} {b}");
        }
    };
    near(&shaken("", peer), STANDARD_GRAVITY);
    near(&shaken("", esm), 1.0);
    near(&shaken("step = '0.5 s', unit = 'gn'", "0.5\n-2\n3\n1\n"), STANDARD_GRAVITY);
    near(&shaken("unit = 'gal'", "t;a\n0;50\n0,5;-200\n1;300\n1,5;100\n"), 1.0);
    near(&shaken("component = 'ns'", "t [ms],EW,NS\n0,9,.5\n500,9,-2\n1000,9,3\n1500,9,1\n"), 1.0);
    let settings = ReadSettings { component: Some("2"), step: Some(0.5), unit: None };
    let table = "9 .5\n9 -2\n9 3\n9 1\n";
    assert_eq!(
        shaken("component = '2', step = '0.5 s'", table),
        Record::read_with(table, "quake.at2", &settings).unwrap()
    );
}

#[test]
fn errors_name_the_key_and_the_line_of_the_record() {
    let refused = |keys: &str, file: &str, path: &str, says: &[&str]| {
        let text = ground(keys, file).expect_err(keys).to_string();
        for says in says.iter().chain(&[path]) {
            assert!(text.contains(says), "«{says}» in {text}");
        }
    };
    let key = |key: &str| format!("ground.motion.x.{key}");
    refused("", "t,a\n0,1\n1,high\n", &key("record"), &["line 3", "`high` is not a number"]);
    refused("", "1\n2\n", &key("record"), &["the step must be given", "step = \"10 ms\""]);
    refused("", "t,a,b\n0,1,2\n1,2,3\n", &key("record"), &["line 2: 3 columns", "component = \"NAME\""]);
    refused("", "t,v [m/s]\n0,1\n1,1\n", &key("record"), &["line 1", "not a known unit of acceleration"]);
    refused("", "nothing of it\nat all\n", &key("record"), &["doesn't begin a known record format"]);
    refused("step = '1 ms'", TABLE, &key("step"), &["has its own step, 0.5 s", "leave this key out"]);
    refused("unit = 'gn'", "t,a [gal]\n0,1\n1,2\n", &key("unit"), &["line 1: the unit is `gal`"]);
    refused(
        "component = 'up'",
        "t,EW,NS\n0,1,2\n1,2,3\n",
        &key("component"),
        &["no component `up`: the file has ew (column 2), ns (column 3)"],
    );
    refused("from = '1.8 s'", TABLE, &key("from"), &["fewer than two values", "0 s to 2 s"]);
    refused("from = '1 s', to = '0.2 s'", TABLE, &key("to"), &["fewer than two values"]);
    refused("baseline = 'quintic'", TABLE, &key("baseline"), &["less than the number of values minus 1"]);
    refused("baseline = 'straight'", TABLE, &key("baseline"), &["none", "quintic"]);
    refused("scale = 2, peak = '1 gn'", TABLE, &key("peak"), &["scale and peak both scale the record"]);
    refused("peak = '1 gn'", "t,a\n0,0\n1,0\n", &key("peak"), &["0 throughout"]);
    refused("arias = '1 m/s'", "t,a\n0,0\n1,0\n", &key("arias"), &["0 throughout"]);
    refused("arias = '1 m/s', peak_velocity = '1 m/s'", TABLE, &key("arias"), &["peak_velocity and arias both scale"]);
    refused("spectral_acceleration = '1 gn'", TABLE, &key("spectral_acceleration"), &["of which natural period?"]);
    refused("period = '1 s'", TABLE, &key("period"), &["no spectral_acceleration is given"]);
    refused(
        "spectral_acceleration = '1 gn', period = '1 ns'",
        TABLE,
        &key("period"),
        &["at least 1/1000 of the record's step"],
    );
    refused("peak = '0.4 g'", TABLE, &key("peak"), &["an acceleration", "gn"]);
    refused("taper = 0.6", TABLE, &key("taper"), &["[0, 0.5]"]);
    refused("sacle = 2", TABLE, &key("sacle"), &["unknown key", "scale"]);

    let both = |more: &str, says: &[&str]| {
        let text = loaded(more, TABLE.as_bytes()).expect_err(more).to_string();
        for says in says {
            assert!(text.contains(says), "«{says}» in {text}");
        }
    };
    both(
        "[ground.motion]\nx = { record = 'a' }\nvelocity = ['1 m/s', '0 m/s']\n",
        &["ground.motion.velocity", "x and velocity prescribe the same motion"],
    );
    both(
        "[ground.motion]\nx = { record = 'a' }\nsignal = 's'\n[signal.s]\nshape = 'constant'\n",
        &["ground.motion.signal", "no signal multiplies a record"],
    );
    both("[ground.motion]\nx = { scale = 1 }\n", &["ground.motion.x.record", "missing"]);
    both("[ground.motion]\nx = 'quake.at2'\n", &["ground.motion.x", "a table is expected"]);
}

#[test]
fn a_record_is_scaled_to_any_intensity_measure() {
    let near = |got: f64, wanted: f64| assert!((got / wanted - 1.0).abs() < 1e-13, "{got} {wanted}");
    near(shaken("peak_velocity = '0.4 m/s'", TABLE).velocity_peak().size, 0.4);
    near(shaken("arias = '0.7 m/s', baseline = 'mean'", TABLE).arias_intensity(), 0.7);
    let spectral = shaken("spectral_acceleration = '0.5 gn', period = '2 s'", TABLE);
    near(spectral.spectrum(0.05, &[2.0]).unwrap()[0].pseudo_acceleration(), 0.5 * STANDARD_GRAVITY);
}

#[test]
fn what_a_record_leaves_or_lacks_gets_a_warning() {
    let warned = |keys: &str, file: &str| {
        let resolved = ground(keys, file).unwrap();
        let about = resolved.warnings.iter().filter(|found| found.path.starts_with("ground.motion"));
        about.map(|found| found.rule.clone()).collect::<Vec<_>>().join("; ")
    };
    let drifts = warned("", "t,a\n0,0\n0.5,1\n1,0\n");
    assert!(drifts.contains("ends at 1.0000 s with a velocity of 500 mm/s, 100 %"), "{drifts}");
    assert_eq!(warned("", "t,a\n0,0\n0.5,1\n1,0\n1.5,-1\n2,0\n"), "");
    assert!(warned("", "t,a\n0,0\n1,0\n").contains("0 throughout"));
    let long: String =
        (0..=100).map(|k| format!("{},{}\n", 0.1 * f64::from(k), [0, 1, 0, -1][k as usize % 4])).collect();
    assert!(warned("", &long).contains("before 95 % of the record's Arias intensity, at 9.5"), "{}", warned("", &long));
    // Rows every 2 ms, and steps of 10 ms.
    let fine: String =
        (0..=1500).map(|k| format!("{:.3},{}\n", 2e-3 * f64::from(k), [0, 1, 0, -1][k as usize % 4])).collect();
    assert!(warned("", &fine).contains("closer than the step"), "{}", warned("", &fine));
}

#[test]
fn the_scene_as_run_reads_back_with_its_records() {
    let keys = "scale = 0.5, unit = 'gn', baseline = 'mean', from = '0.5 s'";
    let first = ground(keys, TABLE).unwrap();
    let written = first.document.to_toml();
    let x = "motion = { x = { record = \"quake.at2\", unit = \"gn\", from = \"0.5 s\", baseline = \"mean\", taper = 0.0, scale = 0.5 } }";
    assert!(written.contains(x), "{written}");
    let again = load_with(written.as_bytes(), "scene.toml", "scene", &[], &mut |_| Ok(TABLE.into())).unwrap();
    assert_eq!((again.document.to_toml(), again.scene), (written, first.scene));
    let moved = first.document.to_toml_elsewhere(|file| format!("../{file}"));
    assert!(moved.contains("record = \"../quake.at2\""), "{moved}");
}

#[test]
fn the_block_of_the_scenario_rocks_and_stays() {
    let bytes = companion("rocking-under-earthquake.toml").unwrap();
    let resolved = load_with(&bytes, "scene", "scene", &[], &mut companion).unwrap_or_else(|errors| panic!("{errors}"));
    assert!(resolved.warnings.is_empty(), "{:?}", resolved.warnings);
    let mut run = Simulation::new(&resolved.scene).unwrap();
    let mut monitor = Largest::default();
    assert_eq!(run.run(&mut [&mut monitor]).unwrap(), Ended::Complete);
    let critical = 0.2_f64.atan();
    assert!(monitor.0 > 0.2 * critical && monitor.0 < 0.4 * critical, "largest angle {}", monitor.0);
    assert!(run.state.q[2].abs() < 1e-4, "at the end it stands: {}", run.state.q[2]);
    assert!(run.state.ledger.relative_residual() < 1e-12);
}

/// The largest angle of the first block.
#[derive(Default)]
struct Largest(f64);

impl Observer<2> for Largest {
    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        self.0 = self.0.max(state.q[2].abs());
        Ok(ControlFlow::Continue(()))
    }
}

/// The folder of recorded earthquakes beside the working copy; none elsewhere.
fn folder() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/records");
    let found = folder.join("records.csv").is_file();
    if !found {
        eprintln!("skipped: there is no {}", folder.display());
    }
    found.then_some(folder)
}

#[test]
fn all_recorded_earthquakes_shake_the_ground() {
    let Some(folder) = folder() else { return };
    let table = std::fs::read_to_string(folder.join("records.csv")).unwrap();
    let mut count = 0;
    for line in table.lines().skip(1) {
        let file = line.split(',').next().unwrap();
        let pga: f64 = line.rsplit(',').nth(1).unwrap().parse().unwrap();
        let bytes = std::fs::read(folder.join(file)).unwrap();
        let resolved = ground("", &bytes).unwrap_or_else(|errors| panic!("{file}: {errors}"));
        let record = resolved.scene.records().next().unwrap();
        // The table has seven digits.
        assert!((record.record.peak_acceleration() / STANDARD_GRAVITY / pga - 1.0).abs() < 1e-6, "{file}");
        let motion = &resolved.scene.ground.as_ref().unwrap().motion.motions()[0];
        let (velocities, displacements) = record.record.motion();
        let v = velocities.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        // Both sums round in every step, and what the velocity is off by is integrated.
        let rounding = f64::EPSILON * record.record.len() as f64;
        for k in (0..record.record.len()).step_by(97) {
            let t = record.record.time(k);
            assert!((motion.velocity(t) - velocities[k]).abs() < rounding * v, "{file} {t}");
            assert!(
                (motion.displacement(t) - displacements[k]).abs() < rounding * v * record.record.duration(),
                "{file} {t}"
            );
        }
        count += 1;
    }
    assert_eq!(count, 40);
}
