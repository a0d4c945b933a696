//! The calls of a time step allocate nothing.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::hint::black_box;

use teeter_beam::{Load, MatrixWeights, MovingLoad, Support};

struct Counting;

thread_local! {
    /// Per thread, so that tests that run beside this one do not count.
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: every call is passed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations(work: impl FnOnce()) -> u64 {
    let before = ALLOCATIONS.get();
    work();
    ALLOCATIONS.get() - before
}

#[test]
fn the_counter_counts() {
    assert!(allocations(|| drop(black_box(vec![1.0; 100]))) > 0);
}

#[test]
fn the_calls_of_a_step_allocate_nothing() {
    for supports in [[Support::Pinned; 2], [Support::Clamped, Support::Free]] {
        let mut spec = super::spec(20, supports);
        spec.damping.viscous = 0.4;
        spec.damping.rayleigh_stiffness = 1e-5;
        let beam = teeter_beam::Beam::new(spec).unwrap();
        let mut weights = MatrixWeights { mass: 1.0, damping: 5e-5, stiffness: 2.5e-9 };
        let mut factor = beam.factor(weights).unwrap();
        let load = MovingLoad::new(-10.0, 2.0, 0.0).unwrap();
        let x = vec![1e-3; beam.dofs()];
        let mut y = vec![0.0; beam.dofs()];
        let count = allocations(|| {
            beam.add_mass_product(1.0, &x, &mut y);
            beam.add_damping_product(1.0, &x, &mut y);
            beam.add_stiffness_product(1.0, &x, &mut y);
            black_box(beam.kinetic_energy(&x) + beam.elastic_energy(&x));
            black_box((beam.shape_at(0.1), beam.shape_clamped(2.0), beam.deflection_at(&x, 0.2)));
            load.add(&beam, 0.1, &mut y);
            factor.solve(&mut y);
            weights.stiffness *= 0.25;
            beam.refactor(weights, &mut factor).unwrap();
            factor.solve(&mut y);
        });
        assert_eq!(count, 0, "{supports:?}");
    }
}
