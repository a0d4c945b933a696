//! A block thrown along a floor slides to a stop.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::scene::{FLAT_BLOCK, GRAVITY, Runner, Start, Stepping, block_over};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use teeter_integrator::{Ground, PairLaw};

pub(crate) struct Sliding;

const SPEED: f64 = 1.0;
const FRICTION: f64 = 0.3;

/// A speed below this part of the start's is rest; rounding of a step's velocity is some 1e-16.
const AT_REST: f64 = 1e-12;

impl Case for Sliding {
    fn name(&self) -> &'static str {
        "sliding"
    }

    fn about(&self) -> &'static str {
        "A block of 0.1 m × 0.05 m slides along a floor from v₀ = 1 m/s, μ = 0.3, θ = 1/2, and stops after the time \
         v₀/(μg) and the distance v₀²/(2μg). During sliding the scheme is exact; it stops in the step that contains \
         the exact stop. So the time is late by less than a step h, and the distance, with the mean velocity of that \
         last step, is too long by at most μgh²/8: these are the bounds. The block must not tip: the angle stays at \
         rounding."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let stop = SPEED / (FRICTION * GRAVITY);
        let way = SPEED * SPEED / (2.0 * FRICTION * GRAVITY);
        let mut findings = Findings::default();
        let law = PairLaw::new(FRICTION, 0.0);
        let model = block_over(&FLAT_BLOCK, Vector2::new(0.0, -GRAVITY), law, Box::new(Ground::flat(0.0)))?;
        let mut runner = Runner::new(Stepping::MoreauJean);
        for dt in [1e-2, 1e-3, 1e-4] {
            let q = vec![0.0, 0.5 * FLAT_BLOCK.height, 0.0];
            let start = Start { q, v: vec![SPEED, 0.0, 0.0], dt, theta: 0.5 };
            let (mut stopped, mut angle) = (f64::NAN, 0.0_f64);
            let end = runner.run(&model, &start, (0.5 / dt).round() as u64, |_, state| {
                if stopped.is_nan() && state.v[0].abs() <= AT_REST * SPEED {
                    stopped = state.t;
                }
                angle = angle.max(state.q[2].abs());
                ControlFlow::Continue(())
            })?;
            findings.checks.extend([
                Check::absolute(format!("h = {dt:e} s: time of the stop, s"), stop, stopped, dt),
                // The rounding of some thousand steps on top.
                Check::absolute(
                    format!("h = {dt:e} s: distance, m"),
                    way,
                    end.q[0],
                    FRICTION * GRAVITY * dt * dt / 8.0 + 1e-13,
                ),
                Check::worst(format!("h = {dt:e} s: largest angle, rad"), angle, 1e-12),
            ]);
        }
        findings.checks.extend(runner.account());
        Ok(findings)
    }
}
