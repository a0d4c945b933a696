//! A run holds as much memory after a million steps as after a hundred thousand: proved by an allocator that counts.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ops::ControlFlow;
use std::path::Path;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_report::{ExportWhen, Exporter, Former, Identity, Origin, Results, RunRecorder, Watch};
use teeter_scenario::simulation::Simulation;

thread_local! {
    // Per thread, so that tests beside this one don't count; const, so that the counter itself allocates nothing.
    static HELD: Cell<i64> = const { Cell::new(0) };
}

struct Counting;

fn add(bytes: i64) {
    // While a thread ends its counter may be gone.
    let _ = HELD.try_with(|held| held.set(held.get() + bytes));
}

// SAFETY: hands everything to the system's allocator; counting touches no memory of its.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        add(layout.size() as i64);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        add(-(layout.size() as i64));
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Bytes held after each `every` steps.
struct Watcher {
    every: u64,
    held: Vec<i64>,
}

impl Observer<2> for Watcher {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        if step.step.is_multiple_of(self.every) {
            self.held.push(HELD.with(Cell::get));
        }
        Ok(ControlFlow::Continue(()))
    }
}

/// A cube that rests on the ground and one that bounces on it without end (over 1000 impacts a second, so that their list is full), its contact problems watched, a row a
/// thousand steps, a checkpoint every ten thousand.
const SCENE: &str = r#"
time = { end = "10 s", step = "10 us" }
ground = {}
output.every = "10 ms"
material.wood.density = "600 kg/m^3"
block.cube = { material = "wood", width = "10 cm", height = "10 cm", depth = "10 cm", on = "ground", at = "0 m" }
block.ball = { material = "wood", width = "1 cm", height = "1 cm", depth = "1 cm", position = ["1 m", "5.002 mm"] }
contact.floor = { between = ["cube", "ground"], friction = 0.4 }
contact.wall = { between = ["ball", "ground"], friction = 0.4, restitution = 1.0 }
"#;

#[test]
fn memory_does_not_grow_with_the_steps() {
    let resolved = teeter_scenario::load(SCENE.as_bytes(), "cubes.toml", "cubes", &[]).unwrap();
    let scene = &resolved.scene;
    assert_eq!(scene.time.steps(), 1_000_000);
    let watch = Watch::default();
    let mut simulation = Simulation::with_solver(scene, |solver| watch.around(solver)).unwrap();
    let layout = simulation.layout.clone();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("memory");
    let results = Results::create(&folder, true).unwrap();
    let problems = folder.join("problems");
    let exporter =
        Exporter::create(&watch, &problems, "cubes", "", 1_000_000, ExportWhen::Hard, 1e-10, Former::Remove).unwrap();
    let identity = Identity::new([0; 32], &resolved.document.to_toml(), &[], "");
    let origin = Origin { identity: &identity, scheme: simulation.scheme() };
    let mut tell = |_: &str| {};
    let mut recorder = RunRecorder::new(&results, scene, &layout, Some(exporter), None, &mut tell)
        .unwrap()
        .with_checkpoints(&results, origin, 0.1);
    let mut watcher = Watcher { every: 100_000, held: Vec::with_capacity(10) };
    assert_eq!(simulation.run(&mut [&mut recorder, &mut watcher]).unwrap(), Ended::Complete);
    let (record, ..) = recorder.into_parts();
    assert!(record.impact_count > 1000, "{} impacts: more than are listed", record.impact_count);
    let first = watcher.held[0];
    assert!(first > 100_000, "the counter counts");
    assert!(watcher.held.iter().all(|held| *held <= first), "{:?}", watcher.held);
}
