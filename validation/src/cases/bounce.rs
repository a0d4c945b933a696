//! A block that falls flat bounces to e² of its height, each time.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::scene::{FLAT_BLOCK, GRAVITY, Runner, Start, Stepping, block_over};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use teeter_integrator::{Ground, PairLaw};

pub(crate) struct Bounce;

const RESTITUTION: f64 = 0.8;
const HEIGHT: f64 = 0.1;
const APEXES: usize = 6;

impl Case for Bounce {
    fn name(&self) -> &'static str {
        "bounce"
    }

    fn about(&self) -> &'static str {
        "The same block dropped flat from 0.1 m, e = 0.8, θ = 1/2: apex n is at e²ⁿ of the height. Flight is exact. \
         The impact occurs in the step h whose predicted middle reaches the floor, up to hv/2 too high or too low, \
         with v the speed there; then y₁ = y₀ − hv(1 − e)/2 and v₁ = ev. By the energy heights y + v²/(2g), an \
         impact shifts the next apex by at most hv (1 − e)(2 + e)/2, and earlier shifts enter with e²; these are the \
         bounds, plus gh²/8 for an apex between two steps."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let mut runner = Runner::new(Stepping::MoreauJean);
        for dt in [1e-4, 1e-5] {
            let found = apexes(&mut runner, dt)?;
            let (mut exact, mut shift) = (HEIGHT, 0.0);
            for (n, found) in found.iter().enumerate() {
                // The fastest that the impact before this apex can be: from the highest, reached half a step too low.
                let highest = exact + shift;
                let v = (2.0 * GRAVITY * highest).sqrt() + GRAVITY * dt;
                shift = RESTITUTION.powi(2) * shift + 0.5 * dt * v * (1.0 - RESTITUTION) * (2.0 + RESTITUTION);
                exact *= RESTITUTION.powi(2);
                let bound = shift + GRAVITY * dt * dt / 8.0;
                let quantity = format!("h = {dt:e} s: apex {}, m", n + 1);
                findings.checks.push(Check::absolute(quantity, exact, *found, bound));
            }
        }
        findings.checks.extend(runner.account());
        Ok(findings)
    }
}

/// Heights of the first apexes after the first impact, m.
fn apexes(runner: &mut Runner, dt: f64) -> Result<Vec<f64>> {
    let law = PairLaw::new(0.3, RESTITUTION);
    let model = block_over(&FLAT_BLOCK, Vector2::new(0.0, -GRAVITY), law, Box::new(Ground::flat(0.0)))?;
    let floor = 0.5 * FLAT_BLOCK.height;
    let start = Start { q: vec![0.0, floor + HEIGHT, 0.0], v: vec![0.0; 3], dt, theta: 0.5 };
    let mut found = Vec::new();
    let (mut highest, mut rising) = (f64::NEG_INFINITY, false);
    runner.run(&model, &start, (2.0 / dt).round() as u64, |_, state| {
        let goes_up = state.v[1] > 0.0;
        if goes_up {
            rising = true;
        }
        if rising {
            highest = highest.max(state.q[1] - floor);
        }
        if rising && !goes_up {
            found.push(highest);
            (highest, rising) = (f64::NEG_INFINITY, false);
        }
        if found.len() == APEXES { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    if found.len() < APEXES {
        return Err(format!("only {} apexes", found.len()).into());
    }
    Ok(found)
}
