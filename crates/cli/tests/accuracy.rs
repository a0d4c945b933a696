//! `step = "auto"`: the step that reaches an accuracy, and what is said where there is none.

#![allow(clippy::unwrap_used)] // a test

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn scenario(stem: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenarios/{stem}.toml"))
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("accuracy-{name}"))
}

fn run(scene: &Path, out: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_teeter"));
    command.arg("run").arg(scene).arg("--out").arg(out).arg("--force").args(arguments);
    command.output().unwrap()
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn last_row(folder: &Path) -> Vec<f64> {
    let text = std::fs::read_to_string(folder.join("trajectory.csv")).unwrap();
    text.lines().last().unwrap().split(',').map(|x| x.parse().unwrap()).collect()
}

#[test]
fn a_step_is_found_that_reaches_the_accuracy() {
    let scene = scenario("free-rocking-on-ground");
    let fine = folder("fine");
    let sets = ["--set", "time.step=2 us", "--set", "output.every=0.1 s"];
    assert!(run(&scene, &fine, &sets).status.success());
    let exact = last_row(&fine);
    let mut steps = Vec::new();
    for accuracy in ["1e-2", "1e-4"] {
        let out = folder(accuracy);
        let sets = ["--set", "time.step=auto", "--accuracy", accuracy, "--set", "output.every=0.1 s"];
        let output = run(&scene, &out, &sets);
        assert!(output.status.success(), "{}", told(&output));
        assert!(told(&output).contains("found by"), "{}", told(&output));
        let summary: serde_json::Value =
            serde_json::from_slice(&std::fs::read(out.join("summary.json")).unwrap()).unwrap();
        assert_eq!(summary["horizon"].as_f64(), Some(1.0), "compared to the end");
        steps.push(summary["dt"].as_f64().unwrap());
        let off = (last_row(&out)[3] - exact[3]).abs() / 5_f64.to_radians();
        assert!(off <= accuracy.parse().unwrap(), "{accuracy}: {off:e}");
        // Its scene has the step, and runs again to the same bytes.
        let again = folder(&format!("{accuracy}-again"));
        assert!(run(&out.join("scene.toml"), &again, &[]).status.success());
        let bytes = |folder: &Path| std::fs::read(folder.join("trajectory.csv")).unwrap();
        assert_eq!(bytes(&out), bytes(&again));
    }
    assert!(steps[0] > 2.0 * steps[1], "{steps:?}: no finer than it must be");
}

#[test]
fn what_asks_for_no_step_or_for_two_is_refused() {
    let scene = scenario("free-rocking-on-ground");
    let out = folder("refused");
    for (arguments, wanted) in [
        (&["--accuracy", "1e-3"][..], "a step is given too"),
        (&["--set", "time.step=auto"], "auto needs an accuracy"),
        (&["--set", "time.step=auto", "--accuracy", "0"], "time.accuracy"),
        (&["--set", "time.step=auto", "--accuracy", "nan"], "time.accuracy"),
        (&["--set", "time.step=auto", "--accuracy", "1e-20"], "which no step reaches"),
        (&["--set", "time.step=auto", "--accuracy", "2"], "time.accuracy"),
        (&["--set", "time.step=often", "--accuracy", "1e-3"], "time.step"),
    ] {
        let output = run(&scene, &out, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", told(&output));
        assert!(told(&output).contains(wanted), "{arguments:?}: {}", told(&output));
        assert!(!out.exists());
    }
    let mut study = Command::new(env!("CARGO_BIN_EXE_teeter"));
    study.arg("tradeoff").arg(&scene).args(["--set", "time.step=auto", "--set", "time.accuracy=1e-3"]);
    let output = study.output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", told(&output));
    assert!(told(&output).contains("give a step instead"), "{}", told(&output));
}
