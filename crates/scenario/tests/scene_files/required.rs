//! What a model does without: a run with it gives the same numbers, and each bound holds against scenes that try to break it.

use super::sets;
use std::ops::ControlFlow;
use std::path::Path;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Simulation;
use teeter_scenario::{Extent, Required, load};

/// All numbers of all steps in one, and whether the limits held.
#[derive(Clone, Debug, Default, PartialEq)]
struct Seen {
    hash: u64,
    steps: u64,
    /// Largest |φ| of each block, rad.
    tilts: Vec<f64>,

    broken: bool,
    required: Required,
}

impl Seen {
    fn mix(&mut self, x: f64) {
        self.hash = (self.hash ^ x.to_bits()).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(17);
    }
}

impl Observer<2> for Seen {
    fn observe(
        &mut self,
        _: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        self.steps += 1;
        let energy = state.ledger.current;
        let account = [energy.kinetic, energy.elastic, energy.gravity, step.energy.contact, step.penetration];
        state.q.iter().chain(&state.v).chain(&account).for_each(|x| self.mix(*x));
        for contact in step.contacts {
            contact.p.iter().chain(contact.u_after.iter()).for_each(|x| self.mix(*x));
            self.mix(contact.id.pair() as f64 + 0.1 * contact.id.point() as f64);
        }
        for (tilt, q) in self.tilts.iter_mut().zip(state.q.chunks_exact(3)) {
            *tilt = tilt.max(q[2].abs());
        }
        self.broken |= self.required.limits.is_some_and(|limits| !limits.hold(state));
        Ok(ControlFlow::Continue(()))
    }
}

fn scene(text: &str, pairs: &[(&str, &str)]) -> Scene {
    load(text.as_bytes(), "scene", "scene", &sets(pairs)).unwrap_or_else(|errors| panic!("{errors}")).scene
}

fn simulation(scene: &Scene, extent: Extent) -> Simulation {
    Simulation::with_extent(scene, extent, |solver| solver).unwrap_or_else(|error| panic!("{error}"))
}

fn run(scene: &Scene, extent: Extent) -> (Seen, State) {
    let mut simulation = simulation(scene, extent);
    let required = simulation.layout.required.clone();
    let mut seen = Seen { tilts: vec![0.0; scene.blocks.len()], required, ..Seen::default() };
    let ended = simulation.run(&mut [&mut seen]).unwrap();
    assert_eq!(ended, Ended::Complete);
    (seen, simulation.state)
}

/// Runs both; the numbers must be the same to the last bit.
fn same(scene: &Scene) -> Seen {
    let (full, required) = (run(scene, Extent::Full).0, run(scene, Extent::Required).0);
    assert!(full.required.removed.is_empty(), "the full model has all");
    assert!(required.steps > 0);
    assert_eq!((full.hash, full.steps), (required.hash, required.steps), "{:#?}", required.required.removed);
    required
}

fn scenarios() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let name = |path: &Path| path.file_stem().unwrap().to_string_lossy().into_owned();
    files.iter().map(|path| (name(path), std::fs::read_to_string(path).unwrap())).collect()
}

#[test]
fn every_scenario_has_the_same_numbers_in_the_full_model() {
    for (name, text) in scenarios() {
        for scheme in ["moreau-jean", "moreau-jean-closed"] {
            let seen = same(&scene(&text, &[("time.scheme", scheme)]));
            assert!(!seen.broken, "{name} {scheme}: {:?}", seen.required.limits);
        }
    }
}
