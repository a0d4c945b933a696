//! Both schemes by the harness, and against exact answers.

use super::*;
use teeter_contact::ContactSolver;
use teeter_integrator::conformance::check_scheme;
use teeter_integrator::{ContactError, ImpactLaw, Motion, PhaseKind};

fn solver() -> Box<dyn ContactSolver<2>> {
    Box::new(Auto::<2>::new())
}

#[test]
fn both_conform() {
    let landing = || -> Box<dyn Scheme<2>> { Box::<Landing>::default() };
    assert_eq!(check_scheme(&(landing, solver)).unwrap(), []);
    let two_phases = || -> Box<dyn Scheme<2>> { Box::<TwoPhases>::default() };
    assert_eq!(check_scheme(&(two_phases, solver)).unwrap(), []);
}

/// Falls flat by 1 cm and bounces with e = 0.5: the height of its bottom at 80 ms, before the second impact.
#[test]
fn landing_bounces_as_exactly_as_its_impact_is_short() {
    let (e, drop, end, dt) = (0.5, 0.01, 0.08, 1e-3);
    let arrival = (2.0 * drop / GRAVITY).sqrt();
    let (speed, since) = (GRAVITY * arrival, end - arrival);
    let exact = e * speed * since - 0.5 * GRAVITY * since * since;
    let error = |scheme: &mut dyn Scheme<2>| {
        let (state, count) = fall(scheme, PairLaw::new(0.0, e), [0.5 * SIDES[1] + drop, 0.0], dt, end).unwrap();
        assert!(state.ledger.relative_residual() < 1e-14, "{:?}", state.ledger);
        (state.q[1] - 0.5 * SIDES[1] - exact, count.steps)
    };
    // Free motion is exact. Over the impact, a thousandth of a step, the scheme moves at the mean velocity (e − 1) V/2 in place of
    // e V, and gains no −g: both are behind by
    let short = 1e-3 * dt;
    let expected = short * (GRAVITY * since - 0.5 * (1.0 + e) * speed);
    let (found, steps) = error(&mut Landing::default());
    assert!((found - expected).abs() < GRAVITY * short * short + 1e-13, "{found:e}, not {expected:e}");
    // One step is cut where it lands, one is the impact, and one at the end meets the time.
    assert_eq!(steps, 82);
    for mut scheme in schemes().unwrap().into_iter().skip(1) {
        let (other, steps) = error(scheme.as_mut());
        assert!(other.abs() > 100.0 * found.abs() && steps == 80, "{}: {other:e}", scheme.name());
    }
}

/// In drift and kick, weight acts on places a step late: n steps fall by g h² n (n − 1)/2.
#[test]
fn two_phases_falls_as_its_formula_says() {
    let (law, dt) = (PairLaw::new(0.0, 0.0), 1e-3);
    let (state, count) = fall(&mut TwoPhases::default(), law, [0.2, 0.0], dt, 0.1).unwrap();
    let exact = 0.2 - GRAVITY * dt * dt * 100.0 * 99.0 / 2.0;
    assert!((state.q[1] - exact).abs() < 1e-14 && (state.v[1] + GRAVITY * 0.1).abs() < 1e-13, "{state:?}");
    assert_eq!((count.steps, count.phases), (100, 100), "nothing was touched");
}

#[test]
fn two_phases_moves_in_the_one_and_strikes_in_the_other() {
    let model = model(Ground::flat(0.0), PairLaw::new(0.0, 0.5)).unwrap();
    let mut state = State::new(&model, &[0.0, 0.5 * SIDES[1], 0.0], &[0.0, -1.0, 0.0], 1e-3).unwrap();
    let mut scheme = TwoPhases::default();
    let mut work = workspace(&model);
    scheme.start(&model, &mut state, &mut work).unwrap();
    let step = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
    let [smooth, impact] = step.phases().collect::<Vec<_>>().try_into().unwrap();
    assert_eq!((smooth.kind, smooth.end, smooth.contacts.len()), (PhaseKind::Smooth, 1e-3, 0));
    assert_eq!((impact.kind, impact.duration, impact.contacts.len()), (PhaseKind::Impact, 0.0, 2));
    assert_eq!(impact.q[0], impact.q[1]);
    let back = 0.5 * (1.0 + GRAVITY * 1e-3);
    assert!((impact.v[0][1] + 2.0 * back).abs() < 1e-14 && (impact.v[1][1] - back).abs() < 1e-12, "{impact:?}");
}

#[test]
fn what_they_cannot_do_is_refused() {
    let bumper = PairLaw::new(0.0, 0.0).with_impact(ImpactLaw::KelvinVoigt { stiffness: 1e8, damping: 0.0 });
    let error = fall(&mut TwoPhases::default(), bumper, [0.0675, 0.0], 1e-4, 0.01).err().unwrap();
    let law = ContactError::Law { pair: 0, law: "a law with duration", over: "in an instant" };
    assert!(error.to_string().contains(&format!("{law:?}")), "{error}");

    let still = || Motion::still();
    let moving = model(Ground::moving(0.0, [still(), still(), still()]), PairLaw::new(0.0, 0.0)).unwrap();
    let mut state = State::new(&moving, &[0.0, 0.07, 0.0, 0.0, 0.0, 0.0], &[0.0; 6], 1e-3).unwrap();
    for mut scheme in schemes().unwrap().into_iter().take(2) {
        let error = scheme.start(&moving, &mut state, &mut workspace(&moving)).unwrap_err();
        assert!(matches!(error, StepError::Unsupported { .. }), "{error}");
    }
}

/// After a fall on a corner, the impact of the other one and some rocking.
#[test]
fn the_three_converge_to_one_motion() {
    let ends = |dt: f64| {
        schemes().unwrap().map(|mut scheme| {
            let (state, _) = fall(scheme.as_mut(), PairLaw::new(0.4, 0.0), [0.09, 0.05], dt, 0.4).unwrap();
            (state.q[2], state.tally.max_penetration)
        })
    };
    let (coarse, fine, finest) = (ends(2e-4), ends(1e-4), ends(2e-5));
    // The scheme that lands is there first, to a thousandth of the tilt. The others are late for each impact by up to a step.
    let (limit, _) = finest[0];
    assert!((fine[0].0 - limit).abs() < 1e-3 * limit, "{fine:?} {limit}");
    for late in [1, 2] {
        let error = |ends: &[(f64, f64); 3]| (ends[late].0 - limit).abs();
        assert!(error(&fine) < 0.2 * error(&coarse) && error(&finest) < 0.02 * limit, "{coarse:?} {fine:?} {finest:?}");
        assert!(coarse[0].1 < 0.01 * coarse[late].1, "penetrations, {coarse:?}");
    }
}
