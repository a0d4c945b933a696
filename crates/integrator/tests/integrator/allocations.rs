//! A step after the set-up allocates nothing: proved by a counting allocator, on ground and on a beam.

use crate::scenes::{PAPER_BLOCK, beam_body, model, workspace};
use nalgebra::Vector2;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;
use teeter_beam::{Beam, BeamSpec, Damping, Section, Support};
use teeter_detect::Kinematics;
use teeter_integrator::*;

thread_local! {
    // Per thread, so that tests beside this one don't count; const, so that the counter itself allocates nothing.
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: hands everything to the system's allocator; counting touches no memory of its.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations in steps up to 0.3 s, which hold impacts, flight and phases with two contacts.
fn allocations(surface: Box<dyn Subsystem<2>>, dofs: usize, theta: f64) -> u64 {
    let law = PairLaw::new(0.5, 0.2);
    let model = model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, surface);
    let mut q = vec![0.17405990783590924, 0.0685504782624077, 0.08726646259971647];
    q.resize(3 + dofs, 0.0);
    let mut state = State::new(&model, &q, &vec![0.0; 3 + dofs], 1e-4).unwrap();
    let mut work = workspace(&model);
    let mut scheme = MoreauJean::new(MoreauJeanSettings { theta, ..MoreauJeanSettings::default() }).unwrap();
    Scheme::<2>::start(&mut scheme, &model, &mut state, &mut work).unwrap();
    let before = ALLOCATIONS.with(Cell::get);
    let mut most = 0;
    for _ in 0..3000 {
        most = most.max(scheme.advance(&model, &mut state, &mut work).unwrap().contacts.len());
    }
    assert_eq!(most, 2, "the run is meant to meet two contacts");
    ALLOCATIONS.with(Cell::get) - before
}

#[test]
fn the_counter_counts() {
    let before = ALLOCATIONS.with(Cell::get);
    drop(std::hint::black_box(Box::new(1)));
    assert_eq!(ALLOCATIONS.with(Cell::get), before + 1);
}

#[test]
fn a_step_on_rigid_ground_allocates_nothing() {
    assert_eq!(allocations(Box::new(Ground::flat(0.0)), 0, 0.5), 0);
    assert_eq!(allocations(Box::new(Ground::flat(0.0)), 0, 1.0), 0);
}

#[test]
fn a_step_on_a_beam_allocates_nothing() {
    let beam = Arc::new(
        Beam::new(BeamSpec {
            span: 0.36,
            elements: 20,
            section: Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap(),
            supports: [Support::Pinned, Support::Pinned],
            damping: Damping { viscous: 0.4, rayleigh_mass: 0.1, rayleigh_stiffness: 1e-6 },
        })
        .unwrap(),
    );
    let surface = |offset: Option<f64>| -> Box<dyn Subsystem<2>> {
        match offset {
            None => Box::new(beam_body(&beam)),
            Some(offset) => {
                Box::new(BeamBody::new(Arc::clone(&beam), Vector2::new(0.0, -offset), BeamSurface::Top { offset }))
            }
        }
    };
    assert_eq!(allocations(surface(None), beam.dofs(), 0.5), 0);
    assert_eq!(allocations(surface(None), beam.dofs(), 0.75), 0);
    assert_eq!(allocations(surface(Some(0.00075)), beam.dofs(), 0.5), 0);
}
