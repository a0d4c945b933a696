//! Ten thousand contacts in five thousand islands: what a step needs grows with their number, not with its square.

#![allow(clippy::unwrap_used)] // a test that cannot be set up has failed

use nalgebra::Vector2;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use teeter_detect::{
    Anchor, BodyId, Candidate, Candidates, ContactDetector, ContactId, DetectorMemory, Geometry, Kinematics, LawId,
    PointDetector, PointPair, plane_frame,
};
use teeter_integrator::*;
use teeter_rigid::{MassProperties, Rectangle};
use teeter_solvers::Auto;

/// Counts all bytes that were ever asked for.
struct Counting;

thread_local! {
    /// By thread, as tests run beside each other.
    static BYTES: Cell<usize> = const { Cell::new(0) };
}

fn bytes_so_far() -> usize {
    BYTES.with(Cell::get)
}

// SAFETY: it hands everything to the system's allocator, and counts beside it.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        BYTES.with(|bytes| bytes.set(bytes.get() + layout.size()));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        BYTES.with(|bytes| bytes.set(bytes.get() + size));
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// So many blocks beside each other on the ground, at rest or moved as prescribed, each sliding flat on two corners.
fn row(blocks: usize, law: PairLaw, ground: Ground) -> (Model<2>, State) {
    let shape = Rectangle::new(0.1, 0.05).unwrap();
    let mass = MassProperties::rectangle(&shape, 0.1, 2700.0).unwrap();
    let mut parts = ModelBuilder::new();
    let all = parts.add(Blocks::new(vec![Block::new(mass, &shape); blocks], Vector2::new(0.0, -9.81)));
    let place = parts.add(ground);
    let (ground, law) = (place.body(), parts.law(law));
    let pairs = (0..blocks as u32).map(|k| PointPair {
        pair: k,
        law,
        points: shape.corners().to_vec(),
        body: all.nth_body(k),
        surface: ground,
        kinematics: Kinematics::Deformed,
    });
    let model = parts.build(Box::new(PointDetector::new(pairs.collect()))).unwrap();
    let mut q: Vec<f64> = (0..blocks).flat_map(|k| [0.2 * k as f64, 0.025, 0.0]).collect();
    let mut v: Vec<f64> = (0..blocks).flat_map(|k| [0.5 + 1e-3 * k as f64, 0.0, 0.0]).collect();
    q.resize(place.q.end, 0.0);
    v.resize(place.v.end, 0.0);
    let state = State::new(&model, &q, &v, 1e-4).unwrap();
    (model, state)
}

/// The bytes that workspace, scheme and the first steps ask for; the contacts of the last.
fn bytes_of(blocks: usize, law: PairLaw, ground: Ground, mut scheme: Box<dyn Scheme<2>>) -> (usize, usize) {
    let (model, mut state) = row(blocks, law, ground);
    let before = bytes_so_far();
    let mut work = Workspace::new(&model, Box::new(Auto::new()), SolverSettings::default());
    scheme.start(&model, &mut state, &mut work).unwrap();
    for _ in 0..3 {
        let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
        assert!(step.outcome().is_none_or(|outcome| outcome.converged()));
    }
    let asked = bytes_so_far() - before;
    // Warm, a step asks for nothing.
    let warm = bytes_so_far();
    let contacts = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap().contacts().count();
    assert_eq!(bytes_so_far() - warm, 0, "{blocks} blocks");
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
            let (half, _) = bytes_of(2500, law, Ground::flat(0.0), entry.make().unwrap());
            let (all, contacts) = bytes_of(5000, law, Ground::flat(0.0), entry.make().unwrap());
            assert_eq!(contacts, 10_000, "{}", entry.name);
            // What is reserved whatever the number aside: twice as many contacts take at most twice as much, where a dense operator
            // alone would go from 0.8 to 3.2 GB.
            assert!(all < 22 * half / 10, "{}, {law:?}: {half} and {all} bytes", entry.name);
            assert!(all - half < 32_000_000, "{}, {law:?}: {half} and {all} bytes", entry.name);
        }
    }
}

/// No block feels another through ground that is moved as prescribed: here slowly, along the way that they slide.
#[test]
fn blocks_on_ground_that_moves_stand_apart() {
    let ground = || {
        let creep = Motion::still().with(Given::Velocity, 1e-12, std::sync::Arc::new(Formula::constant(0.0).unwrap()));
        Ground::moving(0.0, [creep, Motion::still(), Motion::still()])
    };
    for entry in schemes() {
        let (half, _) = bytes_of(1000, PairLaw::new(0.3, 0.0), ground(), entry.make().unwrap());
        let (all, contacts) = bytes_of(2000, PairLaw::new(0.3, 0.0), ground(), entry.make().unwrap());
        assert_eq!(contacts, 4000, "{}", entry.name);
        // The dense operator of all would take 0.5 GB.
        assert!(all < 22 * half / 10 && all - half < 30_000_000, "{}: {half} and {all} bytes", entry.name);
    }
}

/// Bodies in a row along x that touch.
struct Chain(u32);

impl ContactDetector<2> for Chain {
    fn detect(&self, _: &dyn Geometry<2>, _: f64, _: &mut DetectorMemory, out: &mut Candidates<2>) {
        out.clear();
        for k in 0..self.0 - 1 {
            let sides =
                [(k + 1, -0.05), (k, 0.05)].map(|(body, x)| Anchor { body: BodyId(body), point: Vector2::new(x, 0.0) });
            let (id, frame) = (ContactId::new(k, 0), plane_frame(&Vector2::x()));
            out.push(Candidate { id, law: LawId(0), sides, frame, gap: 0.0 });
        }
    }

    fn capacity(&self) -> usize {
        self.0 as usize - 1
    }
}

/// One island in which each contact feels two others: a blow on the first of many bodies that touch moves all of them alike.
#[test]
fn a_long_chain_is_coupled_by_neighbours() {
    let bytes = |bodies: u32| {
        let shape = Rectangle::new(0.1, 0.1).unwrap();
        let mass = MassProperties::rectangle(&shape, 0.1, 1000.0).unwrap();
        let mut parts = ModelBuilder::new();
        parts.add(Blocks::new(vec![Block::new(mass, &shape); bodies as usize], Vector2::zeros()));
        parts.law(PairLaw::new(0.0, 0.0));
        let model = parts.build(Box::new(Chain(bodies))).unwrap();
        let (mut q, mut v) = (vec![0.0; 3 * bodies as usize], vec![0.0; 3 * bodies as usize]);
        (0..bodies as usize).for_each(|k| q[3 * k] = 0.1 * k as f64);
        v[0] = 1.0;
        let mut state = State::new(&model, &q, &v, 1e-4).unwrap();
        let before = bytes_so_far();
        let mut work = Workspace::new(&model, Box::new(Auto::new()), SolverSettings::default());
        let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).unwrap();
        scheme.start(&model, &mut state, &mut work).unwrap();
        let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
        assert!(step.outcome().unwrap().converged(), "{:?}", step.outcome());
        for k in 0..bodies as usize {
            let shared = 1.0 / f64::from(bodies);
            assert!((state.v[3 * k] - shared).abs() < 1e-6 * shared.sqrt(), "body {k}: {} {shared}", state.v[3 * k]);
        }
        bytes_so_far() - before
    };
    let (short, long) = (bytes(400), bytes(800));
    // H of 799 contacts alone would take 20 MB dense, four times that of 399.
    assert!(long - short < 4_000_000, "{short} and {long} bytes");
}
