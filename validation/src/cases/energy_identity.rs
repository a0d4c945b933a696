//! The energy identity of every step, and the sign of friction's work.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::scene::{GRAVITY, PAPER_BLOCK, Runner, Start, Stepping, beam_body, block_over, paper_beam};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use teeter_integrator::{Ground, PairLaw, State};

pub(crate) struct EnergyIdentity;

const DT: f64 = 1e-4;
const DURATION: f64 = 1.0;
const TILT_DEGREES: f64 = 5.0;

/// Largest residual of a step, relative to the scene's energy scale.
const RESIDUAL: f64 = 1e-12;

/// Largest U¹_t·p_t of a step, relative to the scene's energy scale.
const TANGENTIAL: f64 = 1e-15;

impl Case for EnergyIdentity {
    fn name(&self) -> &'static str {
        "energy_identity"
    }

    fn about(&self) -> &'static str {
        "The slender block of the source paper rocks from 5° on rigid ground, and on the paper's beam (20 elements, 1 \
         % damping, started from the static deflection), μ = 0.5, e = 0, h = 1e-4 s, 1 s. The change of energy of \
         every step is the sum of viscous loss, loads, contact, friction and numerical dissipation (`docs/theory.md` \
         §7): the residual is rounding. Friction never gains energy: U¹_t·p_t ≤ 0. The contact work can be positive \
         in single steps; this is an error of the scheme, not of the program, so its sum is only reported. All \
         relative to the scene's energy scale."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        for theta in [0.5, 0.75, 1.0] {
            for (surface, end) in [("ground", on_ground(theta)?), ("beam", on_beam(theta)?)] {
                let (ledger, on) = (&end.ledger, format!("{surface}, θ = {theta}"));
                let gains = ledger.positive_contact_work;
                findings.checks.extend([
                    Check::worst(format!("{on}: largest residual of a step"), ledger.relative_residual(), RESIDUAL),
                    Check::worst(
                        format!("{on}: largest U¹_t·p_t of a step"),
                        ledger.largest_tangential_work.max(0.0) / ledger.scale,
                        TANGENTIAL,
                    ),
                    Check::reported(format!("{on}: steps with positive contact work"), gains.steps as f64),
                    Check::reported(format!("{on}: their sum"), gains.sum / ledger.scale),
                ]);
            }
        }
        Ok(findings)
    }
}

fn rock(model: &teeter_integrator::Model<2>, q: Vec<f64>, theta: f64) -> Result<State> {
    let start = Start { v: vec![0.0; q.len()], q, dt: DT, theta };
    Runner::new(Stepping::MoreauJean)
        .run(model, &start, (DURATION / DT).round() as u64, |_, _| ControlFlow::Continue(()))
}

const LAW: PairLaw = PairLaw::new(0.5, 0.0);

fn on_ground(theta: f64) -> Result<State> {
    let model = block_over(&PAPER_BLOCK, Vector2::new(0.0, -GRAVITY), LAW, Box::new(Ground::flat(0.0)))?;
    let q = PAPER_BLOCK.on_left_corner(Vector2::zeros(), TILT_DEGREES.to_radians());
    rock(&model, q.to_vec(), theta)
}

fn on_beam(theta: f64) -> Result<State> {
    let beam = paper_beam(20, 0.01)?;
    let model = block_over(&PAPER_BLOCK, Vector2::new(0.0, -GRAVITY), LAW, Box::new(beam_body(&beam)))?;
    // The block's weight at the corner it stands on, half a width left of midspan.
    let x = 0.5 * beam.spec().span - 0.5 * PAPER_BLOCK.width;
    let mut deflected = vec![0.0; beam.dofs()];
    beam.add_point_load(x, -PAPER_BLOCK.mass() * GRAVITY, &mut deflected)?;
    beam.solve_static(&mut deflected)?;
    let w = beam.deflection_at(&deflected, x).ok_or("a corner beside the beam")?.w;
    let mut q = PAPER_BLOCK.on_left_corner(Vector2::new(x, w), TILT_DEGREES.to_radians()).to_vec();
    q.extend(deflected);
    rock(&model, q, theta)
}
