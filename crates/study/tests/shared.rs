//! What the cases of a study share changes no bit of them, and isn't made again.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::{Arc, Mutex};
use teeter_report::{EndedWord, Recorder, Summary};
use teeter_scenario::simulation::Simulation;
use teeter_study::sweep::{Sweep, run_cases};
use teeter_study::{Setting, StudyScene};

/// A scene of a folder of the repository, with the files that it reads.
fn source(file: &str, settings: &[Setting]) -> StudyScene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(file);
    let folder = path.parent().unwrap().to_owned();
    let mut read = |path: &str| std::fs::read(folder.join(path)).map_err(|error| error.to_string());
    StudyScene::with_files_of(std::fs::read(&path).unwrap(), file, file, settings.iter().cloned(), &mut read)
}

fn setting(pairs: &[(&str, &str)]) -> Setting {
    pairs.iter().fold(Setting::none(), |setting, (key, value)| setting.set(*key, *value))
}

/// The bits of all coordinates and velocities over the first steps, and of the energy; or why the scene can't be run.
fn trajectory(simulation: Result<Simulation, impl ToString>) -> Result<Vec<u64>, String> {
    let mut simulation = simulation.map_err(|error| error.to_string())?;
    let mut bits = Vec::new();
    for _ in 0..30 {
        simulation.step().map_err(|error| error.to_string())?;
        let state = &simulation.state;
        bits.extend(state.q.iter().chain(&state.v).map(|x| x.to_bits()));
        bits.push(state.ledger.current.total().to_bits());
    }
    Ok(bits)
}

/// Each case with what earlier ones left, and alone.
fn assert_same(file: &str, cases: &[Vec<(&str, &str)>]) -> StudyScene {
    let settings: Vec<Setting> = cases.iter().map(|pairs| setting(pairs)).collect();
    let source = source(file, &settings);
    for (setting, pairs) in settings.iter().zip(cases) {
        let scene = source.scene(setting).map_err(|found| found.to_string());
        let shared = scene.and_then(|scene| trajectory(source.simulation(&scene)));
        let resolved = source.load(setting).map_err(|found| found.to_string());
        let alone = resolved.and_then(|resolved| trajectory(Simulation::new(&resolved.scene)));
        assert!(shared == alone, "{file} {pairs:?}: {:?} {:?}", shared.err(), alone.err());
    }
    source
}

#[test]
fn cases_with_what_they_share_and_without_are_the_same_to_the_last_bit() {
    let mut cases = Vec::new();
    for friction in ["0.5", "0", "0.3", "0.5"] {
        for (thickness, at) in [("0.15 cm", "18 cm"), ("0.2 cm", "15 cm"), ("0.15 cm", "50 cm"), ("0.15 cm", "-0 cm")] {
            cases.push(vec![
                ("contact.feet.friction", friction),
                ("beam.table.thickness", thickness),
                ("block.rocker.at", at),
            ]);
        }
    }
    assert_same("sweeps/block-on-beam.toml", &cases);
    let schemes = ["moreau-jean", "moreau-jean-closed", "generalized-alpha", "moreau-jean", "moreau-jean-located"];
    let mut cases = Vec::new();
    for scheme in schemes {
        for model in ["full", "modes"] {
            for step in ["500 us", "250 us"] {
                cases.push(vec![("time.scheme", scheme), ("beam.table.model", model), ("time.step", step)]);
            }
        }
    }
    assert_same("sweeps/block-on-beam.toml", &cases);
    // Whose factors follow the coordinates; and tilted blocks, held at their foot while the beam settles.
    let tilts = ["5 deg", "1 deg", "5 deg"].map(|tilt| vec![("block.rocker.tilt", tilt), ("time.step", "500 us")]);
    assert_same("scenarios/held-beam.toml", &tilts);
    assert_same("scenarios/two-blocks-on-beam.toml", &tilts);
}

#[test]
fn the_second_case_makes_no_beam_factor_equilibrium_or_table_again() {
    let peaks = ["0.2 gn", "0.3 gn", "0.4 gn"].map(|peak| vec![("beam.table.motion.x.peak", peak)]);
    let first = assert_same("sweeps/block-on-beam.toml", &peaks[..1]).counts();
    assert!((first.beams, first.equilibria) == (1, 1) && first.factors > 1, "{first:?}");
    let all = assert_same("sweeps/block-on-beam.toml", &peaks).counts();
    assert_eq!(all, first);
    // The equilibrium of a flat block depends on the friction; beam and factors don't.
    let frictions = ["0.5", "0.4", "0.5"].map(|friction| vec![("contact.feet.friction", friction)]);
    let counts = assert_same("sweeps/block-on-beam.toml", &frictions).counts();
    assert_eq!((counts.beams, counts.equilibria, counts.factors), (1, 2, first.factors));
    // A tilted block is held at its foot, whatever the friction there.
    for (file, key) in [
        ("sweeps/block-on-beam.toml", "contact.feet.friction"),
        ("scenarios/two-blocks-on-beam.toml", "contact.joint.friction"),
    ] {
        let cases = ["0.5", "0.4", "0.6"].map(|friction| vec![("block.rocker.tilt", "2 deg"), (key, friction)]);
        assert_eq!(assert_same(file, &cases).counts().equilibria, 1, "{file}");
    }
    // Nothing strikes in it.
    let restitutions = ["0", "0.3"].map(|restitution| vec![("contact.feet.restitution", restitution)]);
    assert_eq!(assert_same("sweeps/block-on-beam.toml", &restitutions).counts().equilibria, 1);
}

#[test]
fn a_table_of_a_signal_is_read_once_for_all_cases() {
    let text = "[time]\nend = '0.1 s'\nstep = '1 ms'\n[ground]\nmotion = { acceleration = ['1 m/s^2', '0 m/s^2'], signal = 's' }\n\
        [signal.s]\nshape = 'table'\nfile = 's.csv'\n[material.m]\ndensity = '1 kg/m^3'\n[block.b]\nmaterial = 'm'\n\
        width = '3 cm'\nheight = '12 cm'\ndepth = '1 cm'\non = 'ground'\nat = '0 cm'\n[contact.c]\nbetween = ['b', 'ground']\nfriction = 0.5\n";
    let mut read = |_: &str| Ok(b"0,0\n0.05,4\n0.1,0\n".to_vec());
    let settings = ["1", "2", "3"].map(|scale| setting(&[("signal.s.scale", scale)]));
    let source =
        StudyScene::with_files_of(text.as_bytes().to_vec(), "s.toml", "s", settings.iter().cloned(), &mut read);
    for setting in &settings {
        let shared = trajectory(source.simulation(&source.scene(setting).unwrap())).unwrap();
        let alone = trajectory(Simulation::new(&source.load(setting).unwrap().scene)).unwrap();
        assert!(shared == alone);
    }
    assert_eq!(source.counts().tables, 1);
    let from_another_start = setting(&[("signal.s.start", "10 ms")]);
    source.scene(&from_another_start).unwrap();
    assert_eq!(source.counts().tables, 2);
}

#[test]
fn rows_are_the_same_on_any_number_of_threads_and_stances_are_searched_for_once() {
    let text = "scene = 'block-on-beam.toml'\n[grid]\ntime.end = ['20 ms']\ncontact.feet.friction = [0.3, 0.5, -1]\n\
        beam.table.thickness = ['0.15 cm', '0.2 cm']\nblock.rocker.at = ['18 cm', '15 cm', '90 cm']\n\
        [outputs]\nlargest = 'max_phi_over_alpha'\nlost = 'energy.lost'\nhead = 'headline'\nmoves = { max_abs = 'rocker.x' }\n";
    let sweep = Sweep::read(text, "s", &|_, _| Err("no files vary".to_owned())).unwrap();
    let rows = |threads| {
        let settings: Vec<Setting> = sweep.settings_with_files().collect();
        let source = source("sweeps/block-on-beam.toml", &settings);
        let lines = Mutex::new(Vec::new());
        run_cases(&sweep, &source, 0..sweep.cases(), threads, &Arc::default(), |row| {
            lines.lock().unwrap().push((row.number, row.line(&sweep)));
            ControlFlow::Continue(())
        });
        let mut lines = lines.into_inner().unwrap();
        lines.sort();
        (lines, source.stances().searched())
    };
    let (alone, searched) = rows(1);
    assert_eq!((alone.len(), searched), (18, 1));
    assert_eq!(alone.iter().filter(|(_, line)| line.contains("complete")).count(), 8);
    for _ in 0..3 {
        assert_eq!(rows(4).0, alone);
    }
}

#[test]
fn values_of_a_summary_taken_one_by_one_are_those_of_its_json() {
    for file in ["sweeps/block-on-beam.toml", "scenarios/two-span-beam.toml"] {
        let setting = setting(&[("time.end", "20 ms")]);
        let scene = source(file, std::slice::from_ref(&setting)).scene(&setting).unwrap();
        let mut simulation = Simulation::new(&scene).unwrap();
        let layout = simulation.layout.clone();
        let mut tell = |_: &str| {};
        let mut recorder = Recorder::watching(&scene, &layout, &mut tell).unwrap();
        assert_eq!(simulation.run(&mut [&mut recorder]).unwrap(), teeter_integrator::Ended::Complete);
        let record = recorder.into_record();
        let summary = Summary::new(&scene, &layout, &simulation.state, &record, EndedWord::Complete, 0.0);
        let whole = serde_json::to_value(&summary).unwrap();
        let whole = whole.as_object().unwrap();
        assert!(whole.len() > 20);
        for (key, value) in whole {
            assert_eq!(summary.value(key).as_ref(), Some(value), "{file} {key}");
            assert!(Summary::KEYS.contains(&key.as_str()), "{file} {key}");
        }
        for key in Summary::KEYS.into_iter().chain(["none"]) {
            assert_eq!(summary.value(key).as_ref(), whole.get(key), "{file} {key}");
        }
    }
}
