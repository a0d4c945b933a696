//! A block at rest on a beam and on an incline, against closed forms.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beam::under_force;
use crate::scene::{FLAT_BLOCK, GRAVITY, PAPER_BLOCK, beam_body, block_over, paper_beam};
use nalgebra::Vector2;
use teeter_beam::Support;
use teeter_integrator::{Equilibrium, Ground, Model, PairLaw, SettlingLimits, SolverSettings, Workspace, settle};
use teeter_solvers::Auto;

pub(crate) struct StaticStart;

/// Relative, of deflections and forces: the forces of one round are solved to 1e-13, and levers magnify it.
const BOUND: f64 = 1e-11;

impl Case for StaticStart {
    fn name(&self) -> &'static str {
        "static_start"
    }

    fn about(&self) -> &'static str {
        "Static equilibria of the quasi-static contact solve. The paper's block stands flat in the middle of the \
         paper's beam (24 elements: its feet are over nodes, where the elements are exact), μ = 0 and 0.5: the \
         deflections are those of two forces mg/2, and the vertical force on each foot is mg/2 (the horizontal \
         components of the inclined normal forces cancel). The flat block on an incline of 20°, μ = 0.5: Σ λ_n = mg \
         cos β, Σ λ_t = mg sin β, and λ_n of the lower foot follows from moment equilibrium."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        for friction in [0.0, 0.5] {
            on_beam(friction, &mut findings)?;
        }
        on_incline(&mut findings)?;
        Ok(findings)
    }
}

fn search(model: &Model<2>, q: &[f64]) -> Result<Equilibrium<2>> {
    let settings = SolverSettings { tolerance: 1e-13, max_iterations: 10_000 };
    let mut work = Workspace::new(model, Box::new(Auto::new()), settings);
    let limits = SettlingLimits { reach: &[0.003], margin: 0.01, tau: SettlingLimits::FIRST_TAU };
    Ok(settle(model, 0.0, q, &limits, &mut work)?)
}

fn on_beam(friction: f64, findings: &mut Findings) -> Result<()> {
    let beam = paper_beam(24, 0.0)?;
    let law = PairLaw::new(friction, 0.0);
    let model = block_over(&PAPER_BLOCK, Vector2::new(0.0, -GRAVITY), law, Box::new(beam_body(&beam)))?;
    let (span, weight) = (beam.spec().span, PAPER_BLOCK.mass() * GRAVITY);
    let mut q = vec![0.0; model.size().q];
    (q[0], q[1]) = (0.5 * span, 0.5 * PAPER_BLOCK.height);
    let found = search(&model, &q)?;
    let feet = [-0.5, 0.5].map(|side| 0.5 * span + side * PAPER_BLOCK.width);
    // 69 GPa on 3 cm by 1.5 mm.
    let stiffness = 69e9 * 0.03 * 0.0015_f64.powi(3) / 12.0;
    for (place, x) in [("midspan", 0.5 * span), ("a foot", feet[0])] {
        let mut exact = 0.0;
        for foot in feet {
            let w = under_force([Support::Pinned; 2], foot / span, x / span).ok_or("supports without a closed form")?;
            exact -= 0.5 * weight * span.powi(3) / stiffness * w;
        }
        let computed = beam.deflection_at(&found.q[3..], x).ok_or("beside the beam")?.w;
        findings.checks.push(Check::relative(
            format!("μ = {friction}: deflection at {place}, m"),
            exact,
            computed,
            BOUND,
        ));
    }
    for (id, force) in &found.forces {
        let foot = feet.get(id.point() as usize).ok_or("a contact that is no foot")?;
        let slope = beam.deflection_at(&found.q[3..], *foot).ok_or("beside the beam")?.slope;
        let upwards = (force[0] + slope * force[1]) / (1.0 + slope * slope).sqrt();
        let quantity = format!("μ = {friction}: foot {} vertical force, N", id.point() + 1);
        findings.checks.push(Check::relative(quantity, 0.5 * weight, upwards, BOUND));
    }
    findings.checks.push(Check::reported(format!("μ = {friction}: rounds"), f64::from(found.rounds)));
    Ok(())
}

fn on_incline(findings: &mut Findings) -> Result<()> {
    let slope = 20.0_f64.to_radians();
    let (sin, cos) = slope.sin_cos();
    let law = PairLaw::new(0.5, 0.0);
    let ground = Box::new(Ground::inclined(slope));
    let model = block_over(&FLAT_BLOCK, Vector2::new(0.0, -GRAVITY), law, ground)?;
    let half = 0.5 * FLAT_BLOCK.height;
    let found = search(&model, &[-half * sin, half * cos, slope])?;
    let weight = FLAT_BLOCK.mass() * GRAVITY;
    let sum = |k: usize| found.forces.iter().map(|(_, force)| force[k]).sum::<f64>();
    let lower = found.forces.first().map_or(0.0, |(_, force)| force[0]);
    let exact = weight * (0.5 * cos + half / FLAT_BLOCK.width * sin);
    findings.checks.extend([
        Check::relative("incline: Σ λ_n, N", weight * cos, sum(0), BOUND),
        Check::relative("incline: Σ λ_t, N", weight * sin, sum(1), BOUND),
        Check::relative("incline: λ_n of the lower foot, N", exact, lower, BOUND),
    ]);
    Ok(())
}
