//! What rests must rest: the paper's scene run to its end, and a block on an incline for a hundred seconds.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::scene::{
    FLAT_BLOCK, GRAVITY, PAPER_BLOCK, Runner, Start, Stepping, beam_body, block_over, damped_paper_beam,
};
use nalgebra::{Vector2, Vector3};
use std::ops::ControlFlow;
use teeter_beam::Beam;
use teeter_integrator::{Contact, Ground, PairLaw, State};
use teeter_rigid::{Pose, Rectangle};

pub(crate) struct Resting;

const DT: f64 = 1e-4;
const STEPS: u64 = 1_000_000;

/// Damping ratio of mode 1 and Rayleigh's a₁, s.
const DAMPING: (f64, f64) = (0.1, 1e-5);

/// m/s.
const STILL: f64 = 1e-12;

/// Of the forces, relative to the weight.
const BALANCE: f64 = 1e-9;

/// m; so far a block on an incline may creep.
const CREEP: f64 = 1e-12;

impl Case for Resting {
    fn name(&self) -> &'static str {
        "resting"
    }

    fn about(&self) -> &'static str {
        "**The paper's scene at rest**: the slender block rocks from 5° on the paper's beam (20 elements, static \
         start, μ = 0.5, e = 0, h = 1e-4 s) until it is at rest, 1e6 steps. Then |v| ≤ 1e-12 m/s (the block's \
         velocities, its angular velocity times half its width, ẇ of the nodes, ẇ' times the element length), and \
         the forces are in equilibrium: K q = Σ N(x_c)ᵀ p/h, and Σ p/h = mg on the block, to 1e-9 of the weight \
         (moments divided by the element length). The damping isn't the paper's but ζ = 0.1 in mode 1 and a₁ = 1e-5 \
         s: with ζ = 0.01 the slowest mode of beam and block decays at some 0.15/s, so that 1e-7 of it remains after \
         100 s, and the modes with ωh ≫ 1 hardly decay at all, as the trapezoidal rule reduces their ζ by (ωh/2)². \
         **The incline**: the flat block on 10°, μ = 0.5, h = 1e-3 s, moves by less than 1e-12 m in 100 s, with \
         gravity rotated or the ground inclined, for e = 0 and 0.8."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        for stepping in Stepping::ALL {
            let mut runner = Runner::new(stepping);
            if depth == Depth::Full || stepping == Stepping::MoreauJean {
                on_beam(&mut runner, &mut findings)?;
            }
            for (what, turned) in [("gravity rotated", true), ("ground inclined", false)] {
                for e in [0.0, 0.8] {
                    let quantity = format!("{}, 10° ({what}), e = {e}: displacement in 100 s, m", runner.name());
                    findings.checks.push(Check::worst(quantity, creep(&mut runner, turned, e)?, CREEP));
                }
            }
            findings.checks.extend(runner.account());
        }
        Ok(findings)
    }
}

fn on_beam(runner: &mut Runner, findings: &mut Findings) -> Result<()> {
    let beam = damped_paper_beam(20, DAMPING.0, DAMPING.1)?;
    let law = PairLaw::new(0.5, 0.0);
    let model = block_over(&PAPER_BLOCK, Vector2::new(0.0, -GRAVITY), law, Box::new(beam_body(&beam)))?;
    let weight = PAPER_BLOCK.mass() * GRAVITY;
    let x = 0.5 * beam.spec().span - 0.5 * PAPER_BLOCK.width;
    let mut deflected = vec![0.0; beam.dofs()];
    beam.add_point_load(x, -weight, &mut deflected)?;
    beam.solve_static(&mut deflected)?;
    let w = beam.deflection_at(&deflected, x).ok_or("a corner beside the beam")?.w;
    let mut q = PAPER_BLOCK.on_left_corner(Vector2::new(x, w), 5.0_f64.to_radians()).to_vec();
    q.extend(deflected);
    let start = Start { v: vec![0.0; q.len()], q, dt: DT, theta: 0.5 };
    let mut pressed: Vec<Contact<2>> = Vec::new();
    let end = runner.run(&model, &start, STEPS, |step, _| {
        if step.step == STEPS {
            pressed.extend(step.contacts());
        }
        ControlFlow::Continue(())
    })?;
    let length = beam.spec().span / beam.spec().elements as f64;
    let what = |what: &str| format!("{}, after 1e6 steps: {what}", runner.name());
    let [block, force] = unbalanced(&beam, &end, &pressed, length)?;
    findings.checks.extend([
        Check::worst(what("largest velocity, m/s"), fastest(&beam, &end, length), STILL),
        Check::worst(what("K q − Σ N(x_c)ᵀ p/h, relative"), force / weight, BALANCE),
        Check::worst(what("Σ p/h − mg, relative"), block / weight, BALANCE),
        Check::reported(what("remaining angle, rad"), end.q[2]),
        Check::reported(what("contacts"), pressed.len() as f64),
    ]);
    Ok(())
}

/// The fastest that anything moves, m/s.
fn fastest(beam: &Beam, end: &State, length: f64) -> f64 {
    let [x, y, spin] = [0, 1, 2].map(|i| end.v[i].abs());
    let block = x.max(y).max(spin * 0.5 * PAPER_BLOCK.width);
    let nodes = beam.to_nodes(&end.v[3..]);
    nodes.iter().fold(block, |most, [w, slope]| most.max(w.abs()).max(slope.abs() * length))
}

/// What the forces on the block and on the beam lack to balance, N.
fn unbalanced(beam: &Beam, end: &State, pressed: &[Contact<2>], length: f64) -> Result<[f64; 2]> {
    let corners = Rectangle::new(PAPER_BLOCK.width, PAPER_BLOCK.height)?.corners();
    let pose = Pose::new(&Vector3::new(end.q[0], end.q[1], end.q[2]));
    let q = &end.q[3..];
    let mut beam_lacks = vec![0.0; beam.dofs()];
    beam.add_stiffness_product(-1.0, q, &mut beam_lacks);
    let mut block_lacks = Vector2::new(0.0, -PAPER_BLOCK.mass() * GRAVITY);
    for contact in pressed {
        let corner = corners.get(contact.id.point() as usize).ok_or("a contact that is no corner")?;
        let x = pose.point(corner).x;
        let slope = beam.deflection_at(q, x).ok_or("a corner beside the beam")?.slope;
        let normal = Vector2::new(-slope, 1.0).normalize();
        let force = (normal * contact.p[0] + Vector2::new(normal.y, -normal.x) * contact.p[1]) / DT;
        block_lacks += force;
        beam.add_point_load(x, -force.y, &mut beam_lacks)?;
    }
    // What a support bears is no lack.
    beam_lacks.iter_mut().enumerate().filter(|(dof, _)| beam.is_held(*dof)).for_each(|(_, lack)| *lack = 0.0);
    let nodes = beam.to_nodes(&beam_lacks);
    Ok([block_lacks.norm(), nodes.iter().fold(0.0, |most, [f, couple]| f.abs().max(couple.abs() / length).max(most))])
}

/// How far the flat block moves on an incline, m.
fn creep(runner: &mut Runner, turned: bool, e: f64) -> Result<f64> {
    let slope = 10.0_f64.to_radians();
    let (sin, cos) = slope.sin_cos();
    let law = PairLaw::new(0.5, e);
    let half = 0.5 * FLAT_BLOCK.height;
    let (model, q) = if turned {
        let gravity = Vector2::new(GRAVITY * sin, -GRAVITY * cos);
        (block_over(&FLAT_BLOCK, gravity, law, Box::new(Ground::flat(0.0)))?, vec![0.0, half, 0.0])
    } else {
        let gravity = Vector2::new(0.0, -GRAVITY);
        let ground = Box::new(Ground::inclined(slope));
        (block_over(&FLAT_BLOCK, gravity, law, ground)?, vec![-half * sin, half * cos, slope])
    };
    let start = Start { q, v: vec![0.0; 3], dt: 1e-3, theta: 0.5 };
    let end = runner.run(&model, &start, 100_000, |_, _| ControlFlow::Continue(()))?;
    Ok((end.q[0] - start.q[0]).hypot(end.q[1] - start.q[1]))
}
