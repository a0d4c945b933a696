//! How often the 95 % intervals of a fit hold the values with which a motion was made.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use teeter_study::compare::{AlignmentSettings, MotionTrace};
use teeter_study::fit::{Fit, FitKey, FitSettings};
use teeter_study::measured::{ColumnLayout, Measured};
use teeter_study::{Setting, StudyScene, runner};

/// Fits, each to other noise.
const FITS: u64 = 50;
/// With intervals that hold the value in 95 % of all cases, fewer than this come in 1 of 300 studies of one value.
const FEWEST: u64 = 43;
/// Standard deviation of the noise, degrees.
const NOISE: f64 = 0.03;
/// What the camera shows of an upright block, degrees, and its time at the release, s.
const OFFSET: f64 = 0.3;
const RELEASE: f64 = 3.0;

/// Normal noise by Box and Muller's method.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// The motion of the block with the scene's own values, as `trajectory.csv` has it.
fn motion(source: &StudyScene) -> MotionTrace {
    let scene = source.scene(&Setting::none().set("time.step", "0.2 ms")).unwrap();
    let mut simulation = source.simulation(&scene).unwrap();
    let mut table = "t,rocker.x,rocker.y,rocker.phi,rocker.vx,rocker.vy,rocker.omega\n".to_owned();
    loop {
        let state = &simulation.state;
        let row: Vec<String> =
            std::iter::once(&state.t).chain(&state.q[..3]).chain(&state.v[..3]).map(|x| format!("{x:?}")).collect();
        writeln!(table, "{}", row.join(",")).unwrap();
        if state.t >= scene.time.end * (1.0 - 1e-9) {
            return MotionTrace::read(&table, None).unwrap().1;
        }
        simulation.step().unwrap();
    }
}

/// The numbers stand in docs/fit.md.
#[test]
#[ignore = "50 fits take a minute or two"]
fn intervals_of_95_percent_hold_the_true_values_so_often() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-ground.toml");
    let sets = [("time.scheme", "event-driven"), ("time.step", "3 ms"), ("time.end", "0.45 s")];
    let sets: Vec<(String, String)> = sets.map(|(key, value)| (key.to_owned(), value.to_owned())).into();
    let mut read = |_: &str| Err("no other file".to_owned());
    let (source, resolved) = StudyScene::new(std::fs::read(path).unwrap(), "s.toml", "s", &sets, &mut read).unwrap();
    let trace = motion(&source);
    let keys = ["block.rocker.tilt=4.5 deg..5.5 deg", "block.rocker.height=13 cm..14 cm"];
    let keys = keys.map(|key| FitKey::read(key).unwrap());
    let truth: BTreeMap<&str, f64> = BTreeMap::from([
        ("block.rocker.tilt", 5.0),
        ("block.rocker.height", 13.5),
        ("time shift", -RELEASE),
        ("zero of the angle", OFFSET.to_radians()),
    ]);
    let mut held: BTreeMap<&str, u64> = truth.keys().map(|name| (*name, 0)).collect();
    for seed in 0..FITS {
        let mut noise = Noise(seed);
        // 165 frames a second, from 0.1 s before the release on.
        let frames = (0..).map(|k| f64::from(k) / 165.0 - 0.0973).take_while(|t| *t <= trace.end());
        let rows: String = frames
            .map(|t| {
                let phi = trace.at(t).unwrap().q[2].to_degrees() + OFFSET + NOISE * noise.next();
                format!("{:.6},{phi:.4}\n", t + RELEASE)
            })
            .collect();
        let table = format!("t [s],phi [deg]\n{rows}");
        let measured = Measured::read(table.as_bytes(), &ColumnLayout::default(), "rocker").unwrap();
        let settings = FitSettings {
            alignment: AlignmentSettings::default(),
            offset: None,
            window: 5,
            samples: Some(4),
            seed: 1,
            threads: runner::cores(),
        };
        let fit =
            Fit::of(&source, &resolved, 0, &measured, &keys, &settings, &Arc::default(), &mut |_, _, _| {}).unwrap();
        assert_eq!(fit.estimates.len(), truth.len());
        for found in &fit.estimates {
            let ((low, high), value) = (found.interval(), truth[found.name.as_str()]);
            *held.get_mut(found.name.as_str()).unwrap() += u64::from(low <= value && value <= high);
        }
    }
    assert!(held.values().all(|&count| count >= FEWEST), "of {FITS}: {held:?}");
    eprintln!("of {FITS} intervals, the true value is in {held:?}");
}
