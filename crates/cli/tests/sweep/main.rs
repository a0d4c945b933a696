//! `teeter sweep`: its table, its shards, and what is left after a kill.

#![allow(clippy::unwrap_used)] // a test

mod cases;
mod refusing;
#[path = "../running/mod.rs"]
mod running;
mod studies;

use std::path::{Path, PathBuf};

/// A folder with Housner's block and a sweep file.
fn study(name: &str, sweep: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("sweep-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-ground.toml");
    let scene = std::fs::read_to_string(scene).unwrap().replace("end  = \"1 s\"", "end = \"0.2 s\"");
    std::fs::write(folder.join("rocking.toml"), scene).unwrap();
    std::fs::write(folder.join("sweep.toml"), sweep).unwrap();
    folder
}

/// The rows of a table, each as its cells; the first is the header.
fn table(path: &Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

const SWEEP: &str = "scene = \"rocking.toml\"\n\
    [grid]\ncontact.feet.friction = [0.4, 0.6]\nblock.rocker.tilt = { from = \"2 deg\", to = \"6 deg\", count = 3 }\n\
    [random]\ncount = 2\nseed = 5\nmethod = \"latin-hypercube\"\nblock.rocker.height = { uniform = [\"12 cm\", \"15 cm\"] }\n\
    [outputs]\nlargest = { max_abs = \"rocker.phi\" }\nlast = { final = \"rocker.omega\" }\n\
    early = { at = \"50 ms\", of = \"rocker.phi\" }\nimpacts = \"impact_count\"\n";
