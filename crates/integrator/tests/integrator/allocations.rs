//! A step after the set-up allocates nothing: proved by a counting allocator, on ground and on a beam.

use crate::scenes::{PAPER_BLOCK, all_schemes, beam_body, model, workspace};
use nalgebra::Vector2;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;
use teeter_beam::{Axial, Beam, BeamSpec, Damping, ModalBasis, Section};
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

/// Allocations in steps up to 0.06 s, which hold impacts, flight and phases with two contacts.
fn allocations(surface: Box<dyn Subsystem<2>>, dofs: usize, theta: f64) -> u64 {
    let scheme = MoreauJean::new(MoreauJeanSettings { theta, ..MoreauJeanSettings::default() }).unwrap();
    count(surface, dofs, Box::new(scheme), PairLaw::new(0.5, 0.2))
}

fn count(surface: Box<dyn Subsystem<2>>, dofs: usize, mut scheme: Box<dyn Scheme<2>>, law: PairLaw) -> u64 {
    let model = model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, surface);
    // Its left corner is 20 µm above the surface at 0.165 m: it lands within 3 ms, and the tilt of 3 mrad brings the other
    // corner down soon after.
    let (half_width, half_height, tilt, fall) = (0.015, 0.0675, 0.003_f64, 20e-6);
    let (sin, cos) = tilt.sin_cos();
    let mut q = vec![0.165 + half_width * cos - half_height * sin, half_width * sin + half_height * cos + fall, tilt];
    q.resize(3 + dofs, 0.0);
    let mut state = State::new(&model, &q, &vec![0.0; 3 + dofs], 1e-4).unwrap();
    let mut work = workspace(&model);
    match scheme.start(&model, &mut state, &mut work) {
        // Of a model that it refuses there are no steps.
        Err(StepError::Unsupported { .. }) => return 0,
        started => started.unwrap(),
    }
    let before = ALLOCATIONS.with(Cell::get);
    let (mut fewest, mut most) = (usize::MAX, 0);
    for _ in 0..600 {
        let step = match scheme.advance(&model, &mut state, f64::INFINITY, &mut work) {
            // Nor with a law that it refuses.
            Err(StepError::Unsupported { .. }) => return 0,
            step => step.unwrap(),
        };
        for phase in step.phases() {
            (fewest, most) = (fewest.min(phase.contacts.len()), most.max(phase.contacts.len()));
        }
    }
    assert_eq!((fewest, most), (0, 2), "the run is meant to meet flight and two contacts");
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

/// A small motion that does not disturb the contacts.
fn tremor() -> Motion {
    Motion::still().with(Given::Velocity, 1e-3, Arc::new(Formula::harmonic(0.0, 20.0, 0.0).unwrap()))
}

#[test]
fn a_step_on_moving_ground_allocates_nothing() {
    assert_eq!(allocations(Box::new(Ground::moving(0.0, [tremor(), tremor(), Motion::still()])), 3, 0.5), 0);
}

#[test]
fn a_step_with_closed_contacts_or_another_law_allocates_nothing() {
    let laws = [
        ImpactLaw::Newton,
        ImpactLaw::Poisson,
        ImpactLaw::Energetic,
        ImpactLaw::KelvinVoigt { stiffness: 1e6, damping: 10.0 },
        ImpactLaw::HuntCrossley { stiffness: 1e8, damping: 0.3, exponent: 1.5 },
    ];
    let beam = beam();
    for impact in laws {
        let law = PairLaw::new(0.5, 0.2).with_impact(impact).with_tangential_restitution(0.1);
        for scheme in all_schemes(&[]) {
            assert_eq!(count(Box::new(Ground::flat(0.0)), 0, scheme, law), 0, "{impact:?} on ground");
        }
        for scheme in all_schemes(&[]) {
            assert_eq!(count(Box::new(beam_body(&beam)), beam.dofs(), scheme, law), 0, "{impact:?} on a beam");
        }
    }
}

fn beam() -> Arc<Beam> {
    Arc::new(
        Beam::new(
            BeamSpec::new(0.36, 20, Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap())
                .damped(Damping::none().with_viscous(0.4).with_rayleigh_mass(0.1).with_rayleigh_stiffness(1e-6)),
        )
        .unwrap(),
    )
}

/// Whose tension takes several rounds a step.
#[test]
fn a_step_on_a_held_beam_allocates_nothing() {
    let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap();
    let damping = Damping::none().with_viscous(0.4).with_rayleigh_stiffness(1e-6);
    let spec = BeamSpec::new(0.36, 20, section).axial(Axial::Held).damped(damping);
    let beam = Arc::new(Beam::new(spec).unwrap());
    for scheme in all_schemes(&[0.75]) {
        let name = scheme.name();
        assert_eq!(count(Box::new(beam_body(&beam)), beam.dofs(), scheme, PairLaw::new(0.5, 0.2)), 0, "{name}");
    }
}

#[test]
fn a_step_on_a_beam_allocates_nothing() {
    let beam = beam();
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
    let signal: Arc<dyn Signal> = Arc::new(Table::new(vec![0.0, 0.1, 0.2], vec![0.0, 1.0, 0.0]).unwrap());
    let moving = beam_body(&beam)
        .with_motion([tremor(), tremor()])
        .with_load(Box::new(SignalLoad::new(vec![1e-3; beam.dofs()], signal)));
    assert_eq!(allocations(Box::new(moving), beam.dofs() + 2, 0.5), 0);
}

#[test]
fn the_section_forces_of_a_step_allocate_nothing() {
    let beam = beam();
    let law = PairLaw::new(0.5, 0.2);
    let surface = Box::new(beam_body(&beam));
    let model = model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, surface);
    let mut q = vec![0.17405990783590924, 0.0685504782624077, 0.08726646259971647];
    q.resize(3 + beam.dofs(), 0.0);
    let mut state = State::new(&model, &q, &vec![0.0; q.len()], 1e-4).unwrap();
    let mut work = workspace(&model);
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).unwrap();
    let mut forces = BeamForces::new(&beam, teeter_detect::BodyId(1), 3..q.len());
    scheme.start(&model, &mut state, &mut work).unwrap();
    forces.start(&state, None).unwrap();
    let before = ALLOCATIONS.with(Cell::get);
    let mut most = 0.0_f64;
    for _ in 0..3000 {
        let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
        let phase = step.phases().next().unwrap();
        most = most.max(forces.enter(&phase).unwrap().unwrap().largest_stress(&beam).unwrap().stress);
    }
    assert_eq!(ALLOCATIONS.with(Cell::get) - before, 0);
    assert!(most > 1e6, "it bends: {most}");
}

#[test]
fn a_step_on_a_beam_in_modes_allocates_nothing() {
    let beam = beam();
    let body = || {
        let basis = ModalBasis::new(&beam, 8, &[0.165, 0.195]).unwrap();
        ModalBeam::new(Arc::clone(&beam), basis, Vector2::zeros(), BeamSurface::Axis).unwrap()
    };
    assert_eq!(allocations(Box::new(body()), 10, 0.5), 0);
    let signal: Arc<dyn Signal> = Arc::new(Table::new(vec![0.0, 0.1, 0.2], vec![0.0, 1.0, 0.0]).unwrap());
    let moving = body()
        .with_motion([tremor(), tremor()])
        .with_load(Box::new(SignalLoad::new(vec![1e-3; beam.dofs()], Arc::clone(&signal))))
        .with_signal_load(SignalLoad::new(vec![1e-3; beam.dofs()], signal));
    assert_eq!(allocations(Box::new(moving), 12, 0.5), 0);
}

#[test]
fn a_copy_of_the_state_allocates_where_there_are_more_contacts_than_ever_before() {
    let ground = Box::new(Ground::flat(0.0));
    let law = PairLaw::new(0.5, 0.2);
    let model = model(&PAPER_BLOCK, Vector2::new(0.0, -9.81), law, Kinematics::Deformed, ground);
    let q = [0.17405990783590924, 0.0685504782624077, 0.08726646259971647];
    let mut state = State::new(&model, &q, &[0.0; 3], 1e-4).unwrap();
    let mut work = workspace(&model);
    let mut scheme = MoreauJean::new(MoreauJeanSettings::default()).unwrap();
    Scheme::<2>::start(&mut scheme, &model, &mut state, &mut work).unwrap();
    let mut copy = state.clone();
    let (mut before, mut most) = (ALLOCATIONS.with(Cell::get), 0);
    for _ in 0..3000 {
        let contacts = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap().contacts().count();
        copy.copy_from(&state);
        if contacts > most {
            most = contacts;
            before = ALLOCATIONS.with(Cell::get);
        }
        assert_eq!(ALLOCATIONS.with(Cell::get), before, "in step {}", state.step);
    }
    assert_eq!(most, 2);
    assert_eq!(copy, state);
}
