//! Contacts with duration: a block dropped flat against a fine integration, and stiffness without end.

use crate::scenes::{PAPER_BLOCK, model, workspace};
use nalgebra::Vector2;
use teeter_detect::Kinematics;
use teeter_integrator::*;

const MASS: f64 = 2700.0 * 0.03 * 0.135 * 0.03;
const GRAVITY: f64 = 9.81;

fn scheme(closed: bool) -> Box<dyn Scheme<2>> {
    if closed {
        Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap())
    } else {
        Box::new(MoreauJean::new(MoreauJeanSettings::default()).unwrap())
    }
}

fn dropped(impact: ImpactLaw, height: f64, phi: f64, v: f64, h: f64) -> (Model<2>, State, Workspace<2>) {
    let law = PairLaw::new(0.5, 0.0).with_impact(impact);
    let gravity = Vector2::new(0.0, -GRAVITY);
    let model = model(&PAPER_BLOCK, gravity, law, Kinematics::Deformed, Box::new(Ground::flat(0.0)));
    let low = 0.0675 * phi.cos() + 0.015 * phi.sin().abs();
    let state = State::new(&model, &[0.0, low + height, phi], &[0.0, v, 0.0], h).unwrap();
    let work = workspace(&model);
    (model, state, work)
}

/// Duration and velocity of rebound of a flat drop, from first touch to the end of the force; linear within a step.
fn drop(impact: ImpactLaw, v: f64, h: f64, closed: bool) -> (f64, f64) {
    // Off the grid of steps, so that touch falls within one.
    let height = 0.37 * v * h;
    let start = -(v * v - 2.0 * GRAVITY * height).sqrt();
    let (model, mut state, mut work) = dropped(impact, height, 0.0, start, h);
    let mut scheme = scheme(closed);
    scheme.start(&model, &mut state, &mut work).unwrap();
    let (mut touch, mut last) = (None, state.q[1] - 0.0675);
    loop {
        let t = state.t;
        scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
        let gap = state.q[1] - 0.0675;
        let zero = t + h * last / (last - gap);
        if touch.is_none() && gap < 0.0 {
            touch = Some(zero);
        }
        if let (Some(touch), true) = (touch, gap >= 0.0) {
            // Back from the end of the step to the crossing.
            return (zero - touch, state.v[1] + GRAVITY * (state.t - zero));
        }
        last = gap;
    }
}

/// The same by Runge and Kutta's method in small steps, ended by Newton's at the zero of the penetration.
fn exact(stiffness: f64, damping: f64, exponent: f64, v: f64) -> (f64, f64) {
    // Two corners share the load.
    let acceleration = |depth: f64, rate: f64| {
        let force = 2.0 * stiffness * depth.max(0.0).powf(exponent) * (1.0 + damping * rate);
        GRAVITY - force.max(0.0) / MASS
    };
    let guess = (MASS / (stiffness * v.powf(exponent - 1.0))).powf(1.0 / (exponent + 1.0));
    let dt = guess / 20_000.0;
    let (mut t, mut x, mut u) = (0.0, 0.0, v);
    loop {
        let (x0, u0) = (x, u);
        let (k1, l1) = (u0, acceleration(x0, u0));
        let (k2, l2) = (u0 + 0.5 * dt * l1, acceleration(x0 + 0.5 * dt * k1, u0 + 0.5 * dt * l1));
        let (k3, l3) = (u0 + 0.5 * dt * l2, acceleration(x0 + 0.5 * dt * k2, u0 + 0.5 * dt * l2));
        let (k4, l4) = (u0 + dt * l3, acceleration(x0 + dt * k3, u0 + dt * l3));
        x = x0 + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        u = u0 + dt / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
        t += dt;
        if x <= 0.0 {
            let over = x / u;
            return (t - over, -(u - GRAVITY * over));
        }
    }
}

#[test]
fn a_flat_drop_lasts_and_rebounds_as_it_must() {
    for exponent in [1.0, 1.5] {
        for (stiffness, damping) in [(1e6, 0.0), (1e6, 0.4), (1e9, 0.4)] {
            let impact = ImpactLaw::HuntCrossley { stiffness, damping, exponent };
            let (duration, rebound) = exact(stiffness, damping, exponent, 1.0);
            for closed in [false, true] {
                let error = |parts: f64| {
                    let (t, v) = drop(impact, 1.0, duration / parts, closed);
                    (t / duration - 1.0).abs().max((v / rebound - 1.0).abs())
                };
                let (coarse, fine) = (error(250.0), error(1000.0));
                let order = (coarse / fine).log(4.0);
                let what = format!("{impact:?}, closed {closed}: {coarse:e}, {fine:e}, order {order}");
                assert!(fine <= 1.1e-6 && (1.9..2.1).contains(&order), "{what}");
                assert!(error(2000.0) <= 3e-7, "{what}");
            }
        }
    }
}

#[test]
fn any_stiffness_is_stable_at_any_step() {
    for closed in [false, true] {
        for exponent in 4..=12 {
            for phi in [0.0, 0.1] {
                for h in [1e-3, 1e-5] {
                    let stiffness = 10f64.powi(exponent);
                    let laws = [
                        ImpactLaw::KelvinVoigt { stiffness, damping: 0.0 },
                        ImpactLaw::KelvinVoigt { stiffness, damping: 1e-3 * stiffness.sqrt() },
                        // These let go while they still penetrate.
                        ImpactLaw::KelvinVoigt { stiffness, damping: 100.0 },
                        ImpactLaw::KelvinVoigt { stiffness, damping: 1e4 },
                        ImpactLaw::HuntCrossley { stiffness, damping: 100.0, exponent: 1.5 },
                        ImpactLaw::HuntCrossley { stiffness, damping: 0.3, exponent: 1.5 },
                    ];
                    for impact in laws {
                        let (model, mut state, mut work) = dropped(impact, 0.01, phi, 0.0, h);
                        let mut scheme = scheme(closed);
                        scheme.start(&model, &mut state, &mut work).unwrap();
                        let mut highest = f64::MIN;
                        for _ in 0..2000 {
                            let report = scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
                            assert!(
                                report.outcome().is_none_or(|outcome| outcome.converged()),
                                "{impact:?} {h} {phi} {:?} {}",
                                report.outcome(),
                                state.t
                            );
                            highest = highest.max(state.ledger.current.total());
                        }
                        let (start, scale) = (state.ledger.initial.total(), state.ledger.scale);
                        assert!(
                            highest <= start + 1e-13 * scale,
                            "{impact:?} {h} {phi}: {:e}",
                            (highest - start) / scale
                        );
                        assert!(state.ledger.positive_contact_work.largest <= 1e-12 * scale, "{impact:?} {h} {phi}");
                        assert!(state.ledger.relative_residual() < 1e-12);
                    }
                }
            }
        }
    }
}
