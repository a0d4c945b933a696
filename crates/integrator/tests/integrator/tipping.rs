//! A flat drop on springs is an unstable motion: a tilt grows twentyfold from bounce to bounce, by the model, not by the scheme.

use crate::scenes::{BlockSpec, model, workspace};
use nalgebra::Vector2;
use teeter_detect::Kinematics;
use teeter_integrator::*;

// The block and the contact of `scenarios/compliant-drop.toml`.
const BLOCK: BlockSpec = BlockSpec { width: 0.2, height: 0.1, depth: 0.1, density: 700.0 };
const MASS: f64 = 1.4;
const INERTIA: f64 = MASS * (0.2 * 0.2 + 0.1 * 0.1) / 12.0;
const GRAVITY: f64 = 9.81;
const STIFFNESS: f64 = 1e7;
const DAMPING: f64 = 1.0;
const EXPONENT: f64 = 1.5;
const FALL: f64 = 0.05;

/// The rates of base height y, its velocity, tilt and its velocity, linear in the tilt: both corners stick in contact, so the block turns
/// about its base.
fn rates([y, v, tilt, spin]: [f64; 4]) -> [f64; 4] {
    let depth = (-y).max(0.0);
    let lossy = 1.0 - DAMPING * v;
    if depth == 0.0 || lossy <= 0.0 {
        return [v, -GRAVITY, spin, 0.0];
    }
    let force = STIFFNESS * depth.powf(EXPONENT) * lossy;
    let by_depth = STIFFNESS * EXPONENT * depth.powf(EXPONENT - 1.0) * lossy;
    let by_rate = STIFFNESS * depth.powf(EXPONENT) * DAMPING;
    let (half, arm) = (0.5 * BLOCK.width, 0.5 * BLOCK.height);
    let couple = -2.0 * half * half * (by_depth * tilt + by_rate * spin) + 2.0 * force * arm * tilt;
    [v, 2.0 * force / MASS - GRAVITY, spin, couple / (INERTIA + MASS * arm * arm)]
}

/// By how much a tilt has grown at the top of each of the first bounces: Runge and Kutta's method.
fn growth(tops: usize) -> Vec<f64> {
    let h = 5e-6;
    let along = |s: [f64; 4], k: [f64; 4], by: f64| [0, 1, 2, 3].map(|i| s[i] + by * k[i]);
    let (mut s, mut grown) = ([FALL, 0.0, 1.0, 0.0], Vec::new());
    while grown.len() < tops {
        let k1 = rates(s);
        let k2 = rates(along(s, k1, 0.5 * h));
        let k3 = rates(along(s, k2, 0.5 * h));
        let k4 = rates(along(s, k3, h));
        let next = [0, 1, 2, 3].map(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        if s[1] > 0.0 && next[1] <= 0.0 {
            grown.push(next[2] - next[3] * -next[1] / GRAVITY);
        }
        s = next;
    }
    grown
}

fn grown_in_a_run(tilt: f64, h: f64, closed: bool, tops: usize) -> Vec<f64> {
    let law = PairLaw::new(0.5, 0.0).with_impact(ImpactLaw::HuntCrossley {
        stiffness: STIFFNESS,
        damping: DAMPING,
        exponent: EXPONENT,
    });
    let gravity = Vector2::new(0.0, -GRAVITY);
    let model = model(&BLOCK, gravity, law, Kinematics::Deformed, Box::new(Ground::flat(0.0)));
    let mut state = State::new(&model, &[0.0, FALL + 0.05, tilt], &[0.0; 3], h).unwrap();
    let mut work = workspace(&model);
    let mut scheme: Box<dyn Scheme<2>> = if closed {
        Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default()).unwrap())
    } else {
        Box::new(MoreauJean::new(MoreauJeanSettings::default()).unwrap())
    };
    scheme.start(&model, &mut state, &mut work).unwrap();
    let (mut rising, mut grown) = (false, Vec::new());
    while grown.len() < tops {
        scheme.advance(&model, &mut state, f64::INFINITY, &mut work).unwrap();
        if rising && state.v[1] <= 0.0 {
            // Back to the top, which was within the step.
            grown.push((state.q[2] - state.v[2] * -state.v[1] / GRAVITY) / tilt);
        }
        rising = state.v[1] > 0.0;
    }
    grown
}

/// So a block that is dropped flat tips by itself to what its shape allows, some 0.1°, as soon as rounding has grown to it: half
/// a second here. Finer steps don't change the growth, so it is no fault of theirs.
#[test]
fn a_tilt_grows_as_the_linearised_model_has_it() {
    let exact = growth(5);
    assert!(exact.windows(2).all(|two| two[1] / two[0] > 10.0), "{exact:?}");
    for closed in [false, true] {
        for (h, near) in [(1e-4, 2e-2), (2.5e-5, 5e-3)] {
            for (found, exact) in grown_in_a_run(1e-12, h, closed, 5).iter().zip(&exact) {
                assert!((found / exact - 1.0).abs() < near, "{closed} {h}: {found:e} {exact:e}");
            }
        }
    }
}
