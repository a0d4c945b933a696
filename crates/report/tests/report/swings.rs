//! Beams that swing are told of where steps are too long for that, whether a block is there or not.

use crate::impacts::summary;

/// A beam with a first frequency of 6.11 Hz, let go in its first mode.
const SCENE: &str = "time = { end = \"1.5 s\", step = \"1 ms\" }\n\
    beam.t = { section = \"direct\", bending_stiffness = \"1 N m^2\", mass_per_length = \"0.0660 kg/m\", span = \"1 m\", elements = 8, \
    start = { mode = 1, amplitude = \"1 mm\" } }\n";

/// The part of its largest deflection that a run says to be off, if it says so.
fn off(name: &str, sets: &[(&str, &str)]) -> Option<f64> {
    let found = summary(name, SCENE, sets);
    let warning = found.warnings.iter().find(|warning| warning.code == "under-resolved-swings")?;
    let (_, rest) = warning.text.split_once("by as much as ").unwrap();
    Some(0.01 * rest.split_once(" %").unwrap().0.parse::<f64>().unwrap())
}

#[test]
fn swings_that_come_late_or_die_out_are_told_with_how_much_is_lost() {
    // ω = π² √(EI/ρA)/L² = 38.42 rad/s to some 1e-4; by t the phase is late by ω t (ωh)²/12.
    let omega = std::f64::consts::PI.powi(2) * (1.0_f64 / 0.066).sqrt();
    let late = |h: f64, t: f64| {
        let x: f64 = omega * h;
        2.0 * (0.5 * (t / h) * (x - 2.0 * (0.5 * x).atan())).sin()
    };
    assert_eq!(off("swings-fine", &[]), None);
    let found = off("swings-late", &[("time.step", "6 ms")]).unwrap();
    assert!((found - late(6e-3, 1.5)).abs() < 0.02, "{found} {}", late(6e-3, 1.5));
    // Backward Euler: (1 + (ωh)²)^(−n/2) is left of it.
    let found = off("swings-damped", &[("time.theta", "1")]).unwrap();
    let left = (1.0 + (omega * 1e-3).powi(2)).powf(-0.5 * 1500.0);
    assert!((found - (1.0 - left)).abs() < 0.03, "{found} {}", 1.0 - left);
    // The closed scheme has no other θ.
    assert_eq!(off("swings-closed", &[("time.scheme", "moreau-jean-closed")]), None);
}

#[test]
fn what_a_load_bends_slowly_takes_no_harm() {
    // A force that rises in a hundred periods, in few steps a period.
    let scene = format!(
        "{}load.f = {{ on = \"t\", at = \"0.5 m\", force = \"-1 N\", signal = \"s\" }}\nsignal.s = {{ shape = \"ramp\", duration = \"15 s\" }}\n",
        SCENE
            .replace("start = { mode = 1, amplitude = \"1 mm\" }", "start = \"undeformed\"")
            .replace("1.5 s", "15 s")
            .replace("1 ms", "10 ms")
    );
    let found = summary("swings-slow", &scene, &[]);
    assert!(found.warnings.iter().all(|warning| warning.code != "under-resolved-swings"), "{:?}", found.warnings);
}

#[test]
fn a_swing_in_a_higher_mode_is_watched_at_its_own_frequency() {
    // Midspan is a node of the second mode, and its frequency four times the first.
    let second = SCENE.replace("mode = 1", "mode = 2");
    let told = |name: &str, step: &str| {
        let found = summary(name, &second, &[("time.step", step), ("time.end", "1 s")]);
        found
            .warnings
            .iter()
            .find(|warning| warning.code == "under-resolved-swings")
            .map(|warning| warning.text.clone())
    };
    let coarse = told("second-mode", "1.5 ms").unwrap();
    assert!(coarse.contains(" 24.4"), "{coarse}");
    assert_eq!(told("second-mode-fine", "200 us"), None);
}

#[test]
fn a_blow_late_in_a_long_run_is_not_off_by_what_was_before_it() {
    // Some 60 periods at rest, then a blow; θ = 0.6 would have damped a swing all that time.
    let scene = format!(
        "{}load.f = {{ on = \"t\", at = \"0.5 m\", force = \"-1 N\", signal = \"s\" }}\nsignal.s = {{ shape = \"half-sine\", start = \"9.8 s\", duration = \"50 ms\" }}\n",
        SCENE
            .replace("start = { mode = 1, amplitude = \"1 mm\" }", "start = \"undeformed\"")
            .replace("1.5 s", "10 s")
            .replace("1 ms", "500 us")
    );
    let found = summary("late-blow", &scene, &[("time.theta", "0.6")]);
    assert!(found.warnings.iter().all(|warning| warning.code != "under-resolved-swings"), "{:?}", found.warnings);
}

#[test]
fn flights_with_another_theta_than_a_half_are_told_of() {
    let scene = "time = { end = \"1 s\", step = \"2 ms\" }\nmaterial.s = { density = \"7850 kg/m^3\" }\n\
        block.b = { material = \"s\", width = \"3 cm\", height = \"6 cm\", depth = \"3 cm\", position = [\"0 m\", \"10 m\"] }\n";
    let told = |name: &str, sets: &[(&str, &str)]| {
        let found = summary(name, scene, sets);
        found
            .warnings
            .iter()
            .find(|warning| warning.code == "under-resolved-flight")
            .map(|warning| warning.text.clone())
    };
    // (θ − ½) g h t = 9.8 mm, a sixth of its height.
    assert!(told("flight", &[("time.theta", "1")]).unwrap().contains("9.8 mm"));
    assert_eq!(told("flight-half", &[]), None);
    assert_eq!(told("flight-fine", &[("time.theta", "1"), ("time.step", "200 us")]), None);
}
