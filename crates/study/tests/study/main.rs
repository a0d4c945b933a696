//! The study as a whole, on scenes that are short or have an exact answer.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use teeter_study::{
    Advice, ConfirmedErrors, Failure, Quantity, Row, Setting, SettingWarning, StudyScene, TARGETS, Tradeoff, runner,
    write,
};

fn study(scenario: &str, sets: &[(&str, &str)]) -> Tradeoff {
    with(scenario, sets, &Arc::default()).expect("a study")
}

/// A study of a scene in a text.
fn of_text(text: &str) -> Tradeoff {
    let mut read = |_: &str| Err("no other file".to_owned());
    let (source, resolved) = StudyScene::new(text.as_bytes().to_vec(), "s.toml", "s", &[], &mut read).expect("a scene");
    Tradeoff::of(&source, &resolved, 2, &Arc::default(), &mut |_, _, _| {}).expect("a study")
}

fn with(scenario: &str, sets: &[(&str, &str)], cancel: &Arc<AtomicBool>) -> Result<Tradeoff, Failure> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(format!("{scenario}.toml"));
    let sets: Vec<_> = sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let bytes = std::fs::read(path).unwrap();
    let mut read = |_: &str| Err("no other file".to_owned());
    let (source, resolved) = StudyScene::new(bytes, scenario, scenario, &sets, &mut read).expect("a scene");
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
                let of_scene =
                    |warned: &SettingWarning| first.reference.warned.iter().any(|own| own.kind == warned.kind);
                assert!(first.rows[*row].warned().iter().all(of_scene), "{:?}", first.rows[*row]);
            }
            Advice::NotMeasurable => assert!(bar >= *target),
            Advice::NotReached => assert!(bar < *target),
            Advice::Warned(row) => assert!(!first.rows[*row].warned().is_empty()),
            Advice::BeforeImpact => assert!(!first.reference.has_first_impacts()),
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
    assert!(
        write::findings(&study).iter().any(|line| line.starts_with("not present") && line.contains("contact forces"))
    );
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
    assert_eq!(columns, 3 + Quantity::ALL.len() + 12);
}

#[test]
fn an_interrupted_study_says_so() {
    let cancel = Arc::new(AtomicBool::new(true));
    assert_eq!(with("sliding", &[], &cancel), Err(Failure::Interrupted));
    assert!(cancel.load(Ordering::Relaxed));
}

/// A steel block falls 2 mm onto a timber beam of two spans whose midspan is a support, and the
/// wave in the beam is most of the motion.
const TWO_SPANS: &str = "[time]\nend = '60 ms'\nstep = '1 ms'\n[material.timber]\ndensity = '450 kg/m^3'\nyoungs_modulus = '11 GPa'\n\
    [material.steel]\ndensity = '7850 kg/m^3'\n[beam.joist]\nmaterial = 'timber'\nspan = '4 m'\nwidth = '8 cm'\nthickness = '16 cm'\n\
    elements = 8\nsurface = 'top'\nsupports = ['pinned', 'pinned']\ndamping_ratio = { mode = 1, ratio = 0.02 }\nprobes = ['3 m']\n\
    [beam.joist.support.mid]\nat = '2 m'\nkind = 'pinned'\n[block.cube]\nmaterial = 'steel'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\n\
    position = ['1 m', '13.2 cm']\nangle = '2 deg'\n[contact.feet]\nbetween = ['cube', 'joist']\nfriction = 0.4\n";

#[test]
fn deflection_counts_where_there_is_a_block_too() {
    let study = of_text(TWO_SPANS);
    let done = |row: &Row| row.result.clone().ok();
    let largest = |errors: &teeter_study::Errors| {
        let parts = [Quantity::Angle, Quantity::Position, Quantity::Deflection];
        parts.into_iter().filter_map(|quantity| errors.of(quantity)).fold(0.0, f64::max)
    };
    let mut by_deflection = 0;
    for row in study.rows.iter().filter_map(done) {
        let accuracy = row.errors.of(Quantity::Accuracy).unwrap();
        assert_eq!(accuracy, largest(&row.errors));
        by_deflection += usize::from(row.errors.of(Quantity::Deflection) > row.errors.of(Quantity::Position));
    }
    assert!(
        by_deflection > 0,
        "in no row is the beam further off than the place of the block: the scene tests nothing"
    );
    assert!(study.reference.motion.deflections.iter().any(|w| w.abs() > 1e-6), "the middle of a span is watched");
}

#[test]
fn nothing_is_advised_before_the_first_impact_has_been_compared() {
    // A horizon that ends just after the first impact: made by hand, as no scenario of ours has
    // one.
    let mut study = study("free-rocking-on-ground", &[("time.end", "0.4 s"), ("time.step", "1 ms")]);
    let impact = study.reference.first_impact.expect("the block rocks over at 0.1065 s");
    assert!((impact.t - 0.1065).abs() < 1e-4 && impact.until > 1.4 * impact.t, "{impact:?}");
    assert!(study.reference.has_first_impacts());
    let samples = (0.11 / study.sampling.every) as usize;
    study.reference.norms = study.reference.norms.clone().up_to(samples);
    study.reference.whole = false;
    assert!(!study.reference.has_first_impacts(), "3 ms after the impact show nothing of it");
    study.advise_all();
    assert!(study.advice.iter().all(|advice| *advice == Advice::BeforeImpact));
    let sentences = write::advice(&study);
    assert!(
        sentences.iter().all(|sentence| sentence.contains("nothing is advised") && sentence.contains("0.11 s")),
        "{sentences:?}"
    );
    assert!(sentences.iter().all(|sentence| !sentence.contains(" use ")), "{sentences:?}");
}

#[test]
fn what_is_said_names_the_horizon_and_how_far_off_with_the_bar() {
    let study = study("free-rocking-on-ground", &[("time.end", "0.2 s"), ("time.step", "1 ms")]);
    let sentences = write::advice(&study);
    for (advice, sentence) in study.advice.iter().zip(&sentences) {
        let Advice::Take { row, .. } = advice else { continue };
        let at_most = study.rows[*row].accuracy().unwrap() + study.bar();
        let said = sentence.split("off by at most ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
        let said: f64 = said.parse().unwrap();
        assert!((said / (100.0 * at_most) - 1.0).abs() < 0.06, "{sentence}: {at_most}");
        assert!(sentence.contains("over the whole 0.2 s"), "{sentence}");
    }
    assert!(sentences[0].starts_with("to be within 10 %"), "{sentences:?}");
}

#[test]
fn what_run_and_check_would_warn_of_is_marked_and_not_advised() {
    // Steps of 5 and 10 ms are coarser than a tenth of the rocking time: `check` warns of them.
    let study = study("free-rocking-on-ground", &[("time.end", "0.2 s"), ("time.step", "1 ms")]);
    let coarse = study.rows.iter().find(|row| row.setting.get("time.step") == Some("10 ms")).expect("a coarse step");
    assert!(coarse.warned().iter().any(|warned| warned.kind.starts_with("time.step")), "{coarse:?}");
    assert!(study.reference.warned.is_empty(), "{:?}", study.reference.warned);
    for advice in &study.advice {
        if let Advice::Take { row, .. } = advice {
            assert_eq!(study.rows[*row].warned(), &[]);
        }
    }
    let text = write::csv(&study);
    let line = text.lines().find(|line| line.contains("time.step=\"\"10 ms\"\"")).expect("its row");
    assert!(line.contains("longer than a tenth"), "{line}");
}

#[test]
fn the_warnings_of_a_setting_are_those_of_its_run() {
    // One sweep of pgs doesn't solve two contacts: `run` warns of it.
    let sets = [("time.end", "20 ms"), ("time.step", "1 ms"), ("solver.method", "pgs"), ("solver.max_iterations", "1")];
    let study = study("sliding", &sets);
    let own = study.own().unwrap();
    let unsolved = own.result.as_ref().unwrap().unconverged > 0;
    assert!(unsolved, "{own:?}");
    assert!(own.warned().iter().any(|warned| warned.kind == "unconverged"), "{own:?}");
}

#[test]
fn what_is_advised_costs_hardly_more_than_the_cheapest_of_the_whole_grid() {
    let sets = [("time.end", "0.12 s"), ("time.step", "2 ms"), ("beam.table.elements", "8")];
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-beam.toml");
    let sets: Vec<_> = sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let mut read = |_: &str| Err("no other file".to_owned());
    let (source, resolved) =
        StudyScene::new(std::fs::read(path).unwrap(), "s.toml", "s", &sets, &mut read).expect("a scene");
    let cancel = Arc::new(AtomicBool::new(false));
    let study = Tradeoff::of(&source, &resolved, runner::cores(), &cancel, &mut |_, _, _| {}).expect("a study");
    // The coarser half of the ladder, as what is finer is dearer than what is advised here; and two
    // more, which show what was luck.
    let ladder = |one| study.axes.ladder(one).into_iter().take(study.axes.step.options.len() / 2 + 2);
    let grid: Vec<_> = study.axes.combinations().iter().flat_map(ladder).collect();
    let rows = study.beside(grid, &source, runner::cores(), &cancel).expect("rows");
    let held = ConfirmedErrors::of(&rows, &study.axes);
    let mut compared = 0;
    for (target, advice) in TARGETS.iter().zip(&study.advice) {
        let Advice::Take { row, .. } = advice else { continue };
        let clean = held.meeting(*target, study.bar()).filter(|&row| rows[row].warned().is_empty());
        let Some(least) = clean.filter_map(|row| rows[row].modelled()).reduce(f64::min) else { continue };
        compared += 1;
        let advised = study.rows[*row].modelled().unwrap();
        assert!(advised <= 1.3 * least, "{target}: {advised} s against {least} s");
    }
    assert!(compared > 0, "nothing was compared");
}

/// The scene in which a study once advised 5 ms and θ = 0.6 "for 1 %" by 6 ms of motion after its
/// first impact, the beam left out, where it is 45 % off.
#[test]
#[ignore = "some minutes without optimisation"]
fn a_steel_block_on_a_beam_of_two_spans_is_advised_by_its_impacts_and_its_beam() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes/timber-two-span.toml");
    let Ok(text) = std::fs::read_to_string(&path) else {
        return println!("skipped: {} is not there", path.display());
    };
    let study = of_text(&text);
    for line in write::advice(&study).iter().chain(&write::findings(&study)).chain(&write::pruning(&study)) {
        println!("{line}");
    }
    let horizon = study.reference.norms.horizon();
    for (target, advice) in TARGETS.iter().zip(&study.advice) {
        match advice {
            Advice::Take { row, .. } => {
                assert!(horizon > 0.25, "{horizon} s: the first impact is at 0.194 s");
                let row = &study.rows[*row];
                let errors = &row.result.as_ref().unwrap().errors;
                assert!(errors.of(Quantity::Deflection).unwrap() + study.bar() <= *target, "{row:?}");
                assert_ne!(row.setting.get("time.step"), Some("5 ms"), "`run` warns of it");
            }
            Advice::BeforeImpact => assert!(!study.reference.has_first_impacts()),
            _ => {}
        }
    }
}

#[test]
fn a_scene_made_of_what_earlier_ones_have_in_common_is_the_same() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sweeps");
    let mut read = |path: &str| std::fs::read(folder.join(path)).map_err(|error| error.to_string());
    let bytes = std::fs::read(folder.join("block-on-ground.toml")).unwrap();
    let (source, _) = StudyScene::new(bytes, "s.toml", "s", &[], &mut read).expect("a scene");
    let record = "ground.motion.x";
    let cases: &[&[(&str, &str)]] = &[
        &[("contact.feet.friction", "0.3")],
        &[("contact.feet.friction", "0.4")],
        &[("contact.feet.friction", "0.3")],
        &[("contact.feet.friction", "-0.4")],
        &[("contact.feet.friction", "much")],
        &[("block.rocker.height", "12 cm"), ("record.scale", "2")],
        &[("block.rocker.height", "14 cm"), ("record.scale", "2")],
        &[("block.rocker.height", "14 cm"), ("record.peak", "3 m/s^2")],
        &[("block.rocker.height", "14 cm"), ("record.peak", "4 m/s^2")],
        &[("block.rocker.height", "14 cm"), ("record.peak", "-4 m/s^2")],
        &[("record.baseline", "mean"), ("record.to", "5 s")],
        &[("record.baseline", "mean"), ("record.to", "6 s")],
        &[("record.baseline", "mean"), ("record.to", "-6 s")],
        &[("record.record", "none.csv"), ("record.to", "6 s")],
        &[("time.step", "1 ms"), ("time.scheme", "event-driven")],
        &[("time.step", "2 ms"), ("time.scheme", "moreau-jean")],
        &[("block.rocker.on", "table"), ("time.step", "2 ms")],
    ];
    let mut refused = 0;
    for case in cases {
        let key = |key: &str| key.strip_prefix("record.").map_or(key.to_owned(), |key| format!("{record}.{key}"));
        let setting = case.iter().fold(Setting::none(), |setting, (name, value)| setting.set(key(name), *value));
        let loaded = source.load(&setting).map(|resolved| resolved.scene).map_err(|found| found.to_string());
        refused += usize::from(loaded.is_err());
        assert_eq!(source.scene(&setting).map_err(|found| found.to_string()), loaded, "{case:?}");
    }
    assert_eq!(refused, 6);
}
