//! Ten thousand contacts in five thousand islands: what a step needs grows with their number, not with its square.

use nalgebra::Vector2;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};
use teeter_detect::{Kinematics, PointDetector, PointPair};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};
use teeter_solvers::Auto;

/// Counts all bytes that were ever asked for.
struct Counting;

static BYTES: AtomicUsize = AtomicUsize::new(0);

// SAFETY: it hands everything to the system's allocator, and counts beside it.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        BYTES.fetch_add(layout.size(), Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        BYTES.fetch_add(size, Ordering::Relaxed);
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// So many blocks beside each other on the ground, each sliding flat on two corners.
fn row(blocks: usize, law: PairLaw) -> (Model<2>, State) {
    let shape = Rectangle::new(0.1, 0.05).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.1, 2700.0).unwrap();
    let mut parts = ModelBuilder::new();
    let all = parts.add(Blocks::new(vec![Block::new(mass, &shape); blocks], Vector2::new(0.0, -9.81)));
    let ground = parts.add(Ground::flat(0.0)).body();
    let law = parts.law(law);
    let pairs = (0..blocks as u32).map(|k| PointPair {
        pair: k,
        law,
        points: shape.corners().to_vec(),
        body: all.nth_body(k),
        surface: ground,
        kinematics: Kinematics::Deformed,
    });
    let model = parts.build(Box::new(PointDetector::new(pairs.collect()))).unwrap();
    let q: Vec<f64> = (0..blocks).flat_map(|k| [0.2 * k as f64, 0.025, 0.0]).collect();
    let v: Vec<f64> = (0..blocks).flat_map(|k| [0.5 + 1e-3 * k as f64, 0.0, 0.0]).collect();
    let state = State::new(&model, &q, &v, 1e-4).unwrap();
    (model, state)
}

/// The bytes that workspace, scheme and the first steps ask for; the contacts of the last.
fn bytes_of(blocks: usize, law: PairLaw, mut scheme: Box<dyn Scheme<2>>) -> (usize, usize) {
    let (model, mut state) = row(blocks, law);
    let before = BYTES.load(Ordering::Relaxed);
    let mut work = Workspace::new(&model, Box::new(Auto::new()), SolverSettings::default());
    scheme.start(&model, &mut state, &mut work).unwrap();
    for _ in 0..3 {
        let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
        assert!(step.outcome().is_none_or(|outcome| outcome.converged()));
    }
    let asked = BYTES.load(Ordering::Relaxed) - before;
    // Warm, a step asks for nothing.
    let warm = BYTES.load(Ordering::Relaxed);
    let contacts = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap().contacts().count();
    assert_eq!(BYTES.load(Ordering::Relaxed) - warm, 0, "{blocks} blocks");
    // Each slides on by itself, slowed by friction: v = v⁰ − μ g t.
    for k in 0..blocks {
        let expected = 0.5 + 1e-3 * k as f64 - 0.3 * 9.81 * state.t;
        assert!((state.v[3 * k] - expected).abs() < 1e-9, "block {k}: {} {expected}", state.v[3 * k]);
    }
    (asked, contacts)
}

#[test]
fn memory_grows_with_the_contacts_whatever_their_law() {
    for law in [PairLaw::new(0.3, 0.0), PairLaw::new(0.3, 0.5).with_impact(ImpactLaw::Poisson)] {
        for entry in schemes() {
            let (half, _) = bytes_of(2500, law, entry.make().unwrap());
            let (all, contacts) = bytes_of(5000, law, entry.make().unwrap());
            assert_eq!(contacts, 10_000, "{}", entry.name);
            // What is reserved whatever the number aside: twice as many contacts take at most twice as much, where a dense operator
            // alone would go from 0.8 to 3.2 GB.
            assert!(all < 22 * half / 10, "{}, {law:?}: {half} and {all} bytes", entry.name);
            assert!(all - half < 30_000_000, "{}, {law:?}: {half} and {all} bytes", entry.name);
        }
    }
}
