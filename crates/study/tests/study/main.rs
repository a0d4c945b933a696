//! The study as a whole, on scenes that are short or have an exact answer.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use teeter_study::{Advice, Failure, Quantity, Row, Source, TARGETS, Tradeoff, write};

fn study(scenario: &str, sets: &[(&str, &str)]) -> Tradeoff {
    with(scenario, sets, &AtomicBool::new(false)).expect("a study")
}

fn with(scenario: &str, sets: &[(&str, &str)], cancel: &AtomicBool) -> Result<Tradeoff, Failure> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(format!("{scenario}.toml"));
    let sets: Vec<_> = sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let bytes = std::fs::read(path).unwrap();
    let mut read = |_: &str| Err("no other file".to_owned());
    let (source, resolved) = Source::new(bytes, scenario, scenario, &sets, &mut read).expect("a scene");
    Tradeoff::of(&source, &resolved, 2, cancel, &mut |_, _, _| {})
}

/// What must be the same in every run: all but the times.
fn counted(study: &Tradeoff) -> Vec<Row> {
    study.rows.iter().map(|row| Row { cpu: None, ..row.clone() }).collect()
}

#[test]
fn the_error_bar_covers_the_true_error_of_housners_block() {
    // Impacts and peaks up to 0.4 s (docs/theory.md §9), without slip: exact.
    let study = study("free-rocking-on-ground", &[("time.end", "0.4 s"), ("time.step", "1 ms")]);
    let reference = &study.reference;
    assert!(reference.whole, "nothing parts in 0.4 s");
    let (times, mean) = ([0.106_510_25, 0.292_488_38], 0.292_488_38 / 2.0);
    let crossings = &reference.motion.crossings[0];
    assert_eq!(crossings.len(), times.len());
    let off = crossings.iter().zip(times).map(|(t, exact)| (t - exact).abs() / mean).fold(0.0, f64::max);
    let bar = reference.bar_of(Quantity::ImpactTimes);
    assert!(off <= bar, "the first two impacts are {off:.1e} off, the error bar is {bar:.1e}");
    let peak = 4.143_61_f64.to_radians();
    let off = (reference.motion.peaks[0][0].1.abs() / peak - 1.0).abs();
    let bar = reference.bar_of(Quantity::Peaks);
    // The exact peak is known to five digits.
    assert!(off <= bar + 2e-6, "the peak is {off:.1e} off, the error bar is {bar:.1e}");
    assert!(bar < 1e-3, "and says something: {bar:.1e}");
}

#[test]
fn a_study_says_the_same_again_and_advises_what_it_measured() {
    let sets = [("time.end", "0.12 s"), ("time.step", "2 ms"), ("beam.table.elements", "8")];
    let (first, second) = (study("free-rocking-on-beam", &sets), study("free-rocking-on-beam", &sets));
    assert_eq!(counted(&first), counted(&second));
    assert_eq!(first.front, second.front);
    assert_eq!(first.reference, second.reference);
    let bar = first.bar();
    let mut taken = 0;
    for (target, advice) in TARGETS.iter().zip(&first.advice) {
        match advice {
            Advice::Take { row, .. } => {
                taken += 1;
                assert!(first.rows[*row].accuracy().unwrap() + bar <= *target);
            }
            Advice::NotMeasurable => assert!(bar >= *target),
            Advice::NotReached => assert!(bar < *target),
        }
    }
    assert!(taken > 0, "10 % can be had");
    // Every axis of a beam was tried, and the rows are all different.
    for key in ["time.scheme", "time.step", "time.theta", "beam.table.elements", "beam.table.modes", "solver.method"] {
        assert!(first.rows.iter().any(|row| row.setting.get(key).is_some()), "{key}");
    }
    assert!(first.rows.iter().enumerate().all(|(k, row)| first.rows[..k].iter().all(|o| o.setting != row.setting)));
    // θ is no axis of a scheme that knows one.
    let closed = |row: &&Row| row.setting.get("time.scheme") == Some("moreau-jean-closed");
    assert!(first.rows.iter().filter(closed).all(|row| row.setting.get("time.theta").is_none()));
}

#[test]
fn a_scene_of_a_beam_alone_is_compared_by_its_deflection() {
    let study = study("two-span-beam", &[("time.end", "0.1 s"), ("time.step", "5 ms"), ("beam.bridge.elements", "8")]);
    let own = study.own().unwrap().result.as_ref().unwrap();
    assert_eq!(own.errors.of(Quantity::Accuracy), own.errors.of(Quantity::Deflection));
    assert!(own.errors.of(Quantity::Deflection).unwrap() > 0.0);
    for absent in [Quantity::Angle, Quantity::Position, Quantity::Forces, Quantity::ImpactTimes, Quantity::Penetration]
    {
        assert_eq!(own.errors.of(absent), None, "{absent:?}");
    }
    assert!(write::findings(&study).iter().any(|line| line.starts_with("left out") && line.contains("contact forces")));
}

#[test]
fn a_refused_candidate_is_a_row_with_its_reason() {
    let sets = [("time.end", "20 ms"), ("time.step", "1 ms"), ("beam.table.elements", "4")];
    let study = study("free-rocking-on-beam", &sets);
    let refused = study.rows.iter().find(|row| row.result.is_err()).expect("16 modes of a beam of 4 elements");
    let text = write::csv(&study);
    let line = text.lines().find(|line| line.contains("refused")).expect("a row");
    assert!(line.contains("count = 16"), "{line}\n{refused:?}");
    let columns = text.lines().next().unwrap().split(',').count();
    assert_eq!(columns, 3 + Quantity::ALL.len() + 11);
}

#[test]
fn an_interrupted_study_says_so() {
    let cancel = AtomicBool::new(true);
    assert_eq!(with("sliding", &[], &cancel), Err(Failure::Interrupted));
    assert!(cancel.load(Ordering::Relaxed));
}
