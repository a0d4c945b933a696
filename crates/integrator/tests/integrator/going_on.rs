//! States that are taken over from another run, by what is known of their moment: they go on as that run does.

use crate::scenes::{FLAT_BLOCK, PAPER_BLOCK, model, workspace};
use nalgebra::Vector2;
use std::sync::Arc;
use teeter_detect::Kinematics;
use teeter_integrator::*;

fn gravity() -> Vector2<f64> {
    Vector2::new(0.0, -9.81)
}

/// Takes so many steps by a new scheme.
fn steps(model: &Model<2>, scheme: &SchemeEntry, state: &mut State, number: u64) {
    let (mut scheme, mut work) = (scheme.make().unwrap(), workspace(model));
    scheme.start(model, state, &mut work).unwrap();
    for _ in 0..number {
        scheme.advance(model, state, f64::INFINITY, &mut work).unwrap();
    }
}

/// The moment of a state: what another run can know of it.
fn taken_over(model: &Model<2>, scheme: &SchemeEntry, state: &State) -> State {
    let mut other = State::at(model, state.step, &state.q, &state.v, state.dt).unwrap();
    if let Some(theta) = scheme.make().unwrap().drives_about() {
        other.drive_about(model, theta).unwrap();
    }
    other.take_contacts(model, &state.memory, &state.warm);
    other
}

#[test]
fn what_springs_hold_is_energy_of_the_start() {
    let law = PairLaw::new(0.5, 0.0).with_impact(ImpactLaw::KelvinVoigt { stiffness: 1e6, damping: 0.0 });
    let model = model(&PAPER_BLOCK, gravity(), law, Kinematics::Deformed, Box::new(Ground::flat(0.0)));
    for scheme in schemes() {
        // It refuses contacts with duration.
        if scheme.name == EventDriven::NAME {
            continue;
        }
        let mut whole = State::new(&model, &[0.0, 0.0685, 0.0], &[0.0, -0.5, 0.0], 1e-5).unwrap();
        // Into the ground, until the springs hold most of the energy.
        steps(&model, scheme, &mut whole, 220);
        assert!(whole.ledger.stored > 1e-3, "{}: {} J", scheme.name, whole.ledger.stored);
        let mut part = taken_over(&model, scheme, &whole);
        assert!((part.ledger.stored - whole.ledger.stored).abs() < 1e-12 * whole.ledger.stored, "{}", scheme.name);
        assert!((part.ledger.initial.total() - whole.ledger.current.total()).abs() < 1e-12, "{}", scheme.name);
        steps(&model, scheme, &mut whole, 300);
        steps(&model, scheme, &mut part, 300);
        assert_eq!((&part.q, &part.v), (&whole.q, &whole.v), "{}", scheme.name);
        // A spring without damping gives back what it held, and no more.
        assert!(part.ledger.sum.contact.abs() < 1e-9, "{}: {} J", scheme.name, part.ledger.sum.contact);
    }
}

#[test]
fn prescribed_velocities_go_on_as_means_about_the_time() {
    let shake = Motion::still().with(Given::Acceleration, 3.0, Arc::new(Formula::harmonic(0.0, 40.0, 0.3).unwrap()));
    let ground = Ground::moving(0.0, [shake, Motion::still(), Motion::still()]);
    let model = model(&FLAT_BLOCK, gravity(), PairLaw::new(0.2, 0.0), Kinematics::Deformed, Box::new(ground));
    for scheme in schemes() {
        let mut whole = State::new(&model, &[0.0, 0.025, 0.0, 0.0, 0.0, 0.0], &[0.0; 6], 1e-3).unwrap();
        steps(&model, scheme, &mut whole, 37);
        let mut part = taken_over(&model, scheme, &whole);
        assert_eq!(part.v, whole.v, "{}", scheme.name);
        steps(&model, scheme, &mut whole, 100);
        steps(&model, scheme, &mut part, 100);
        assert_eq!((&part.q, &part.v), (&whole.q, &whole.v), "{}", scheme.name);
    }
    let mut short = State::new(&model, &[0.0, 0.025, 0.0, 0.0, 0.0, 0.0], &[0.0; 6], 1e-3).unwrap();
    short.v.pop();
    assert!(matches!(short.drive_about(&model, 0.5), Err(StateError::Length { found: 5, expected: 6, .. })));
}

/// Where a step is divided, prescribed velocities at its end are more than these means; so they are in a run that goes on from there.
#[test]
fn what_divided_steps_owe_is_not_forgotten() {
    let shake = Motion::still().with(Given::Acceleration, 8.0, Arc::new(Formula::harmonic(0.0, 11.0, 0.3).unwrap()));
    let ground = Ground::moving(0.0, [shake, Motion::still(), Motion::still()]);
    let model = model(&FLAT_BLOCK, gravity(), PairLaw::new(0.2, 0.0), Kinematics::Deformed, Box::new(ground));
    let located = schemes().iter().find(|scheme| scheme.name == MoreauJeanLocated::<2>::NAME).unwrap();
    let mut whole = State::new(&model, &[0.0, 0.025, 0.0, 0.0, 0.0, 0.0], &[0.0; 6], 1e-3).unwrap();
    let mut owing = 0;
    for _ in 0..150 {
        steps(&model, located, &mut whole, 1);
        let mut part = taken_over(&model, located, &whole);
        owing += u32::from(part.v != whole.v);
        let mut whole = whole.clone();
        steps(&model, located, &mut whole, 3);
        steps(&model, located, &mut part, 3);
        assert_eq!((&part.q, &part.v), (&whole.q, &whole.v), "from {} s on", whole.t);
    }
    assert!(owing > 0, "no slide stops within a step");
}

/// Forces are no impulses, and a phase doesn't take them for such.
#[test]
fn a_stage_that_holds_forces_is_not_handed_in() {
    let model =
        model(&FLAT_BLOCK, gravity(), PairLaw::new(0.2, 0.0), Kinematics::Deformed, Box::new(Ground::flat(0.0)));
    let state = State::new(&model, &[0.0, 0.025, 0.0], &[0.0; 3], 1e-3).unwrap();
    let (mut work, mut stage) = (workspace(&model), ContactStage::new());
    let masses = Weights { mass: 1.0, ..Weights::default() };
    work.factors(&model, masses, &state.q, Keep::Pinned).unwrap();
    stage.find(&model, &state, &Look::new(&state.q, 1e-9), &mut work).unwrap();
    let mut a = [0.0, -9.81, 0.0];
    stage.resolve(&model, &state, &mut a, Over::Acceleration, &Responses::Of(masses), &mut work).unwrap();
    work.begin(&model, &state, state.next_step(f64::INFINITY)).unwrap();
    let phase = PhaseEnd::new(PhaseKind::Smooth, 1e-3, &state.q, &state.v);
    let error = work.phase(&model, &phase, Some(&mut stage)).unwrap_err();
    assert!(matches!(error, StepError::Problem { source: ContactError::Forces, .. }), "{error}");
}

/// Contacts with duration take no part in an impact that ends a step, but go on holding what they hold.
#[test]
fn springs_are_remembered_over_an_impact_that_ends_a_step() {
    let law = PairLaw::new(0.5, 0.0).with_impact(ImpactLaw::KelvinVoigt { stiffness: 1e6, damping: 0.0 });
    let model = model(&PAPER_BLOCK, gravity(), law, Kinematics::Deformed, Box::new(Ground::flat(0.0)));
    let mut state = State::new(&model, &[0.0, 0.0674, 0.0], &[0.0, -0.1, 0.0], 1e-5).unwrap();
    steps(&model, &schemes()[0], &mut state, 20);
    let (stored, gaps) = (state.ledger.stored, state.memory.clone());
    assert!(stored > 0.0 && gaps.active().len() == 2);
    let (mut work, span) = (workspace(&model), state.next_step(f64::INFINITY));
    let (q, v) = (state.q.clone(), state.v.clone());
    let mut stage = ContactStage::new();
    let weights = Weights { mass: 1.0, damping: 0.5 * span.h, stiffness: 0.25 * span.h * span.h };
    work.factors(&model, weights, &q, Keep::Pinned).unwrap();
    work.begin(&model, &state, span).unwrap();
    stage.find(&model, &state, &Look::new(&q, 1e-9), &mut work).unwrap();
    let mut after = v.clone();
    let over = Over::Step { h: span.h, weight: 0.5 };
    let outcome = stage.resolve(&model, &state, &mut after, over, &Responses::Of(weights), &mut work).unwrap();
    let step = PhaseEnd::new(PhaseKind::Step, span.end, &q, &after).with_outcome(outcome);
    work.phase(&model, &step, Some(&mut stage)).unwrap();
    work.phase(&model, &PhaseEnd::new(PhaseKind::Impact, span.end, &q, &after), None).unwrap();
    let report = work.finish(&model, &mut state, None, |_, _| true).unwrap();
    let energies: Vec<f64> = report.phases().map(|phase| phase.energy.contact).collect();
    assert_eq!(energies[1], 0.0, "nothing happened at the instant: {energies:?}");
    assert_eq!(state.memory.active(), gaps.active());
    assert!(state.memory.active().iter().all(|id| state.memory.spring_gap(*id).unwrap() < 0.0));
    assert!(state.ledger.stored > 0.0);
}

/// Another scheme's contacts may press above their surface, as where the located one gives up on many bounces: event-driven lets
/// them fall from there. It pulled them down at once, and took their energy with that.
#[test]
fn what_presses_above_its_surface_falls_from_there() {
    let law = PairLaw::new(0.5, 1.0);
    let model = model(&FLAT_BLOCK, gravity(), law, Kinematics::Deformed, Box::new(Ground::flat(0.0)));
    let height = 2e-3;
    let mut pressing = State::new(&model, &[0.0, 0.025, 0.0], &[0.0; 3], 1e-3).unwrap();
    steps(&model, &schemes()[0], &mut pressing, 1);
    assert_eq!(pressing.memory.active().len(), 2);
    let entry = schemes().iter().find(|entry| entry.name == EventDriven::NAME).unwrap();
    let mut state = State::at(&model, 0, &[0.0, 0.025 + height, 0.0], &[0.0; 3], 1e-3).unwrap();
    state.take_contacts(&model, &pressing.memory, &pressing.warm);
    steps(&model, entry, &mut state, 10);
    assert!((state.q[1] - 0.025 - height + 0.5 * 9.81 * 1e-4).abs() < 1e-14, "{}", state.q[1]);
    // Down and up again: the impacts are elastic.
    let fall = (2.0 * height / 9.81_f64).sqrt();
    steps(&model, entry, &mut state, 90);
    let ball = |t: f64| {
        let since = (t + fall).rem_euclid(2.0 * fall) - fall;
        height - 0.5 * 9.81 * since * since
    };
    assert!((state.q[1] - 0.025 - ball(state.t)).abs() < 1e-10, "{} {}", state.q[1] - 0.025, ball(state.t));
    assert!(state.ledger.sum.projection.abs() < 1e-15 && state.ledger.relative_residual() < 1e-13);
}
