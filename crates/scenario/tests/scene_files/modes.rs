//! Beams in modes, beside the same beams in full.

use std::ops::ControlFlow;
use teeter_integrator::{Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::load;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;

use crate::ROCKING;

fn resolved(sets: &[(&str, &str)]) -> Resolved {
    let sets: Vec<_> = sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    load(ROCKING.as_bytes(), "scene", "scene", &sets).unwrap_or_else(|errors| panic!("{errors}"))
}

fn simulation(model: &[(&str, &str)], sets: &[(&str, &str)]) -> Simulation {
    Simulation::new(&resolved(&[model, sets].concat()).scene).unwrap()
}

const MODES: (&str, &str) = ("beam.table.model", "modes");

/// φ and the deflection at midspan, step by step.
struct Watcher {
    place: teeter_scenario::simulation::BeamPlace,
    seen: Vec<[f64; 2]>,
}

impl Observer<2> for Watcher {
    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        let w = self.place.deflection_at(&state.q[self.place.range.clone()], 0.18).unwrap().w;
        self.seen.push([state.q[2], w]);
        Ok(ControlFlow::Continue(()))
    }
}

/// A run in full and the same in modes; the largest differences relative to the largest values.
fn apart(model: &[(&str, &str)], sets: &[(&str, &str)]) -> [f64; 2] {
    let run = |model: &[(&str, &str)]| {
        let mut simulation = simulation(model, sets);
        let mut watcher = Watcher { place: simulation.layout.beams[0].clone(), seen: Vec::new() };
        assert_eq!(simulation.run(&mut [&mut watcher]).unwrap(), teeter_integrator::Ended::Complete);
        let relative = simulation.state.ledger.relative_residual();
        assert!(relative <= 1e-12, "{model:?}: the identity of energy to {relative:e}");
        watcher.seen
    };
    let (full, modes) = (run(&[]), run(model));
    assert_eq!(full.len(), modes.len());
    let largest =
        |of: &dyn Fn(&[f64; 2], &[f64; 2]) -> f64| full.iter().zip(&modes).map(|(a, b)| of(a, b)).fold(0.0, f64::max);
    [0, 1].map(|k| largest(&|a, b| (a[k] - b[k]).abs()) / largest(&|a, _| a[k].abs()))
}

#[test]
fn the_papers_scene_in_modes_moves_as_in_full_up_to_its_first_impact() {
    let before = [("time.end", "0.1 s")];
    let place = &simulation(&[MODES], &before).layout.beams[0];
    let basis = place.basis.as_ref().unwrap();
    assert_eq!((place.range.len(), place.free_dofs()), (basis.len(), basis.len()));
    assert!(basis.len() <= 20 && basis.len() > basis.modes(), "{} {}", basis.len(), basis.modes());
    let [angle, middle] = apart(&[MODES], &before);
    eprintln!("over the span: {} shapes, {angle:e} {middle:e}", basis.len());
    assert!(angle <= 1e-4, "{angle:e}");
    // Where the contact is, fewer do.
    let region = [MODES, ("beam.table.modes", "{ tolerance = 1e-4, from = '15 cm', to = '21 cm' }")];
    let few = simulation(&region, &before).layout.beams[0].range.len();
    let [angle, middle] = apart(&region, &before);
    eprintln!("over the region: {few} shapes, {angle:e} {middle:e}");
    assert!(few < basis.len() && angle <= 1e-4, "{few} {angle:e}");
    // With all its modes it is the beam in full.
    let [angle, middle] = apart(&[MODES, ("beam.table.modes", "{ count = 40 }")], &[("time.end", "0.2 s")]);
    eprintln!("in all modes, through an impact: {angle:e} {middle:e}");
    assert!(angle <= 1e-6 && middle <= 1e-6, "{angle:e} {middle:e}");
}

#[test]
fn shaken_loaded_and_under_its_weight_it_is_that_of_the_elements() {
    let text = "beam.table.motion";
    let sets = [
        ("block.rocker.tilt", "0 deg"),
        ("beam.table.self_weight", "true"),
        ("beam.table.surface", "top"),
        ("signal.shake.shape", "harmonic"),
        ("signal.shake.frequency", "4 Hz"),
        (text, "{ displacement = ['1 mm', '1 mm'], signal = 'shake' }"),
        ("load.push.on", "table"),
        ("load.push.at", "9 cm"),
        ("load.push.force", "-0.5 N"),
        ("load.push.signal", "shake"),
        ("time.end", "0.1 s"),
    ];
    let [_, middle] = apart(&[MODES, ("beam.table.modes", "{ tolerance = 1e-6 }")], &sets);
    eprintln!("shaken: {middle:e}");
    assert!(middle <= 1e-3, "{middle:e}");
}

#[test]
fn a_static_start_is_an_equilibrium_of_the_modes() {
    let sets = [("block.rocker.tilt", "0 deg"), ("beam.table.self_weight", "true"), ("time.end", "0.05 s")];
    let mut run = simulation(&[MODES], &sets);
    let start = run.state.q.clone();
    assert_eq!(run.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
    let moved = start.iter().zip(&run.state.q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let fastest = run.state.v.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    assert!(moved <= 1e-12 && fastest <= 1e-10, "{moved:e} {fastest:e}");
    // And it sags as the beam of the elements does, up to the tolerance.
    let sag = |run: &Simulation| {
        let place = &run.layout.beams[0];
        place.deflection_at(&run.state.q[place.range.clone()], 0.18).unwrap().w
    };
    let full = sag(&simulation(&[], &sets));
    assert!((sag(&run) / full - 1.0).abs() <= 1e-4, "{} {full}", sag(&run));
}

#[test]
fn a_shape_of_a_file_or_mode_starts_in_the_shapes_that_there_are() {
    let sets =
        [("beam.table.start", "{ mode = 1, amplitude = '1 mm' }"), ("block.rocker.position", "['18 cm', '1 m']")];
    let text = ROCKING.replace("on       = \"table\"\nat       = \"18 cm\"\ntilt     = \"5 deg\"\n", "");
    let all = sets.iter().chain([&MODES, &("beam.table.modes", "{ count = 3 }")]);
    let all: Vec<_> = all.map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    let scene = load(text.as_bytes(), "scene", "scene", &all).unwrap_or_else(|errors| panic!("{errors}")).scene;
    let run = Simulation::new(&scene).unwrap();
    let place = &run.layout.beams[0];
    let eta = &run.state.q[place.range.clone()];
    assert!((place.deflection_at(eta, 0.18).unwrap().w - 1e-3).abs() <= 1e-14);
    assert!(eta[1..].iter().all(|eta| eta.abs() <= 1e-12), "{eta:?}");
    assert_eq!(place.dofs(eta).len(), place.beam.dofs());
}

/// F − F_Φ is the square of the error in the norm of energy, so that moments have the root of the
/// tolerance in the mean.
#[test]
fn moments_of_modes_are_those_of_the_elements_to_the_root_of_the_tolerance() {
    let moments = |model: &[(&str, &str)]| {
        let scene = resolved(&[model, &[("block.rocker.tilt", "0 deg")]].concat()).scene;
        let run = Simulation::new(&scene).unwrap();
        let mut forces = run.layout.beam_forces(&scene, 0);
        forces.start(&run.state, run.layout.beams[0].pressed.as_deref()).unwrap();
        let at = |k: u32| forces.forces().at(forces.beam(), 0.36 * f64::from(k) / 200.0).unwrap().moment;
        let carried: f64 = forces.forces().reactions().iter().map(|reaction| reaction.force).sum();
        ((0..=200).map(at).collect::<Vec<_>>(), carried)
    };
    let (full, weight) = moments(&[]);
    let norm = |of: &dyn Fn(usize) -> f64| (0..full.len()).map(|k| of(k).powi(2)).sum::<f64>().sqrt();
    for (shapes, bound) in [("{ tolerance = 1e-4 }", 1e-2), ("{ tolerance = 1e-6 }", 1e-3), ("{ count = 40 }", 1e-9)] {
        let (moments, carried) = moments(&[MODES, ("beam.table.modes", shapes)]);
        let error = norm(&|k| moments[k] - full[k]) / norm(&|k| full[k]);
        let missing = (carried / weight - 1.0).abs();
        eprintln!("{shapes}: moments off by {error:e}, reactions by {missing:e}");
        assert!(error <= bound && missing <= bound, "{shapes}: {error:e} {missing:e}");
    }
}

#[test]
fn what_is_asked_of_modes_is_written_out_and_read_back() {
    let scene = resolved(&[MODES, ("beam.table.modes", "{ to = '26 cm' }")]);
    let written = scene.document.to_toml();
    assert!(written.contains("modes = { tolerance = 0.0001, from = \"0 m\", to = \"0.26 m\" }"), "{written}");
    let again = load(written.as_bytes(), "scene", "scene", &[]).unwrap();
    assert_eq!((again.scene, again.document.to_toml()), (scene.scene, written));
}
