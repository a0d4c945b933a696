//! A step on a beam's hump allocates nothing, once as many contacts were there: proved by an allocator that counts.

use super::sides::{OVER_A_SUPPORT, scene, simulation};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ops::ControlFlow;
use teeter_detect::ContactId;
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::simulation::PairPlace;

thread_local! {
    // Per thread, so that tests beside this one don't count; const, so that the counter itself allocates nothing.
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: hands everything to the system's allocator; counting touches no memory of its.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // While a thread ends its counter may be gone.
        let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What happened from a time on, which steps before it have made room for.
struct Watch {
    pair: PairPlace,
    from: f64,
    before: u64,
    steps: u32,
    on_hump: u32,
    touching: usize,
    changes: u32,
    allocations: u64,
}

impl Observer<2> for Watch {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        let now = ALLOCATIONS.with(Cell::get);
        if step.t_start >= self.from {
            self.steps += 1;
            self.allocations += now - self.before;
            let pressing = || step.contacts().filter(|contact| contact.p[0] > 0.0);
            let is_hump = |contact: ContactId| self.pair.points[self.pair.point(contact).unwrap()].name == "hump-1";
            self.on_hump += u32::from(pressing().any(|contact| is_hump(contact.id)));
            self.changes += u32::from(pressing().count() != self.touching);
            self.touching = pressing().count();
        }
        self.before = now;
        Ok(ControlFlow::Continue(()))
    }
}

#[test]
fn a_step_on_a_hump_allocates_nothing() {
    for scheme in ["moreau-jean-closed", "moreau-jean-located", "moreau-jean-projected"] {
        // It falls onto the hump beside its centre, and rocks between it and a corner.
        let sets = [
            ("time.scheme", scheme),
            ("block.base.position", "['61 cm', '4 cm']"),
            ("block.base.angle", "-6 deg"),
            ("beam.plank.viscous_damping", "5 N s/m^2"),
        ];
        let mut simulation = simulation(&scene("1 s", OVER_A_SUPPORT), &sets);
        let pair = simulation.layout.pairs[0].clone();
        let mut watch =
            Watch { pair, from: 0.2, before: 0, steps: 0, on_hump: 0, touching: 0, changes: 0, allocations: 0 };
        assert!(ALLOCATIONS.with(Cell::get) > 100, "the counter counts");
        assert_eq!(simulation.run(&mut [&mut watch]).unwrap(), Ended::Complete);
        let Watch { steps, on_hump, changes, allocations, .. } = watch;
        assert!(on_hump > 100 && changes > 10, "{scheme}: {on_hump} of {steps} steps on the hump, {changes} changes");
        assert_eq!(allocations, 0, "{scheme}: in {steps} steps");
    }
}
