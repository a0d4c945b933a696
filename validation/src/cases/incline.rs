//! A block on an incline rests, or slides with constant acceleration.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::scene::{FLAT_BLOCK, GRAVITY, Runner, Start, Stepping, block_over};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use teeter_integrator::{Ground, PairLaw};

pub(crate) struct Incline;

const FRICTION: f64 = 0.3;

/// Rounding of a thousand steps.
const BOUND: f64 = 1e-10;

impl Case for Incline {
    fn name(&self) -> &'static str {
        "incline"
    }

    fn about(&self) -> &'static str {
        "The same block on an incline (gravity rotated by β, h = 1e-3 s, 1 s), μ = 0.3. At 20° it slides with a = g \
         (sin β − μ cos β) for every θ: the scheme is exact for a constant force, so the bounds are rounding. At 16° \
         (tan β = 0.287 < μ) it rests."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let mut runner = Runner::new(Stepping::MoreauJean);
        for theta in [0.5, 1.0] {
            let beta = 20.0_f64.to_radians();
            let [vx, _] = after_a_second(&mut runner, beta, theta)?;
            let exact = GRAVITY * (beta.sin() - FRICTION * beta.cos());
            let quantity = format!("20°, θ = {theta}: acceleration, m/s²");
            findings.checks.push(Check::absolute(quantity, exact, vx, BOUND));
        }
        let [_, moved] = after_a_second(&mut runner, 16.0_f64.to_radians(), 0.5)?;
        findings.checks.push(Check::absolute("16°, θ = 0.5: distance, m", 0.0, moved, BOUND));
        findings.checks.extend(runner.account());
        Ok(findings)
    }
}

/// Velocity and way after one second.
fn after_a_second(runner: &mut Runner, beta: f64, theta: f64) -> Result<[f64; 2]> {
    let gravity = Vector2::new(GRAVITY * beta.sin(), -GRAVITY * beta.cos());
    let law = PairLaw::new(FRICTION, 0.0);
    let model = block_over(&FLAT_BLOCK, gravity, law, Box::new(Ground::flat(0.0)))?;
    let start = Start { q: vec![0.0, 0.5 * FLAT_BLOCK.height, 0.0], v: vec![0.0; 3], dt: 1e-3, theta };
    let end = runner.run(&model, &start, 1000, |_, _| ControlFlow::Continue(()))?;
    Ok([end.v[0], end.q[0]])
}
