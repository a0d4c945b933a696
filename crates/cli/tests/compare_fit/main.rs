//! `teeter compare` and `teeter fit`, with measured motion made from runs of our own: sampled at 165
//! frames per second, with noise, in another time, frame and sign.

#![allow(clippy::unwrap_used)] // a test

mod comparing;
mod fitting;
#[path = "../running/mod.rs"]
mod running;

use running::teeter;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("compare-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = teeter(folder, arguments);
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{arguments:?}: {told}");
    String::from_utf8(output.stdout).unwrap()
}

fn read(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// Nearly normal noise of unit deviation, the same in every run.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let mut uniform = || {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }
}

/// Frames of a run: time in the run, x, y, φ, from 0.1 s before its start on.
fn frames(run: &Path, block: &str) -> Vec<[f64; 4]> {
    let text = std::fs::read_to_string(run.join("trajectory.csv")).unwrap();
    let mut lines = text.lines();
    let heading: Vec<&str> = lines.next().unwrap().split(',').collect();
    let place = |name: &str| heading.iter().position(|cell| *cell == format!("{block}.{name}")).unwrap();
    let places = [0, place("x"), place("y"), place("phi")];
    let rows: Vec<[f64; 4]> = lines
        .map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            places.map(|place| cells[place])
        })
        .collect();
    let end = rows.last().unwrap()[0];
    let frames = (0..).map(|k| f64::from(k) / 165.0 - 0.1).take_while(|t| *t <= end);
    // Rows are 0.1 ms apart: what lies between is a line to 1e-6 of the motion.
    let at = |t: f64| {
        let after = rows.partition_point(|row| row[0] <= t).clamp(1, rows.len() - 1);
        let (a, b) = (rows[after - 1], rows[after]);
        let s = ((t - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0);
        [t, a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2]), a[3] + s * (b[3] - a[3])]
    };
    frames.map(at).collect()
}

fn scenario(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(name);
    path.to_str().unwrap().to_owned()
}
