//! Ground that moves: a shaken floor on which a block slides and sticks, vertical shaking, and frames that only travel.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::shaken_block::ShakenBlock;
use crate::figure::{Axes, Figure, Series};
use crate::fit::power_law;
use crate::scene::{FLAT_BLOCK, GRAVITY, PAPER_BLOCK, Runner, Start, Stepping, beam_body, block_over, paper_beam};
use nalgebra::Vector2;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;
use teeter_integrator::{Formula, Given, Ground, Model, Motion, PairLaw, Signal};

pub(crate) struct MovingGround;

/// ω of the floor, rad/s, and its largest acceleration, m/s².
const OMEGA: f64 = 10.0;
const ACCELERATION: f64 = 5.0;
/// s; no change of the motion is near.
const DURATION: f64 = 2.7;

/// Friction's share of the floor's largest acceleration: the block sticks in between from 0.537 on; with 0.8 from the first change on.
const SHARES: [f64; 2] = [0.8, 0.4];

const PER_DECADE: u32 = 12;

/// Velocity of the frames that travel, m/s.
const TRAVEL: [f64; 2] = [0.3, 0.2];

/// What rounding makes of the relative coordinates, m and rad: 5000 steps, each off by half a unit in the last place of some 0.3 m, make
/// 1e-13; the rest is for rocking, which makes a difference larger.
const RELATIVE: f64 = 1e-12;

impl Case for MovingGround {
    fn name(&self) -> &'static str {
        "moving_ground"
    }

    fn about(&self) -> &'static str {
        "**Shaken floor**: the flat block on a floor that moves by x = a sin ωt, ω = 10 rad/s, aω² = 5 m/s², 2.7 s, \
         with friction μg of 0.8 and 0.4 of aω², compared with its motion in closed form: with 0.8 it alternately \
         slides and sticks, with 0.4 it never sticks. Largest error of the position over all steps, and times of the \
         changes (the middles of their steps). In the step of a change, friction holds the block to the floor until \
         the end of the step. If it then sticks, its velocity is exact again, and the error is of second order. If \
         the slide reverses, the velocity is off by up to (aω² + μg) h until the next change: first order. In the \
         step of a stop, friction may do work on the block relative to the floor; on driven ground \
         `moreau-jean-closed` allows this, so its gain is only reported. **Vertical shaking**, 0.9 g: the contact \
         stays closed with the force m(g + Δv_g/h). **Moving frames**: with ground or supports at constant velocity, \
         the relative motion is that on ground at rest: the paper's rocking block, 0.5 s, h = 1e-4 s. The \
         coordinates differ by rounding, 1e-12 (m and rad), and the velocities by this over half a step."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let mut series = Vec::new();
        for stepping in Stepping::ALL {
            let mut runner = Runner::new(stepping);
            for (share, order, tolerance) in [(SHARES[0], 2.0, 0.15), (SHARES[1], 1.0, 0.15)] {
                let points = shaken(&mut runner, share, depth, &mut findings)?;
                let fit = power_law(&points);
                let quantity = format!("{}, μg = {share} aω²: order of the position", runner.name());
                findings.checks.push(match depth {
                    Depth::Full => Check::between(quantity, order, fit.order, order - tolerance, order + tolerance),
                    Depth::Short => Check::reported(quantity + ", one decade only", fit.order),
                });
                let ends = [points[0].0, points[points.len() - 1].0];
                series.push(Series::marks(format!("{}, μg = {share} aω²", runner.name()), points));
                let line = ends.map(|dt| (dt, fit.at(dt))).to_vec();
                series.push(Series::line(format!("order {:.3}", fit.order), line));
            }
            vertical(&mut runner, &mut findings)?;
            travelling(&mut runner, &mut findings)?;
            findings.checks.extend(runner.account_of_drives());
        }
        findings.figures.push(Figure {
            file: "shaken_block.svg",
            title: "Block on a shaken floor: error over step size",
            x: "Step size h (s)",
            y: "Largest error of the position (m)",
            axes: Axes::Logarithmic,
            caption: "Largest error of the block's position in 2.7 s, with fitted lines: with more friction (0.8) the \
                 block sticks in between, after which its velocity is exact again; with less (0.4) it never does.",
            series,
        });
        Ok(findings)
    }
}

fn sine(given: Given, amplitude: f64) -> Result<Motion> {
    Ok(Motion::still().with(given, amplitude, Arc::new(Formula::harmonic(0.0, OMEGA / TAU, 0.0)?)))
}

/// The flat block on level ground that moves.
fn on_moving(motion: [Motion; 3], friction: f64, v: [f64; 2], dt: f64) -> Result<(Model<2>, Start)> {
    let ground = Ground::moving(0.0, motion);
    let mut q = vec![0.0, 0.5 * FLAT_BLOCK.height, 0.0];
    q.extend(ground.coordinates(0.0));
    let law = PairLaw::new(friction, 0.0);
    let model = block_over(&FLAT_BLOCK, Vector2::new(0.0, -GRAVITY), law, Box::new(ground))?;
    Ok((model, Start { q, v: vec![v[0], v[1], 0.0, 0.0, 0.0, 0.0], dt, theta: 0.5 }))
}

/// Largest errors of the position over step sizes; judges the times of the changes.
fn shaken(runner: &mut Runner, share: f64, depth: Depth, findings: &mut Findings) -> Result<Vec<(f64, f64)>> {
    let friction = share * ACCELERATION / GRAVITY;
    let block = ShakenBlock { amplitude: ACCELERATION / (OMEGA * OMEGA), frequency: OMEGA, friction, gravity: GRAVITY };
    let phases = block.phases(DURATION);
    let mut points = Vec::new();
    let sizes = if depth == Depth::Full { 5 * PER_DECADE / 2 } else { PER_DECADE };
    for k in 0..=sizes {
        // A step that no event of the motion falls on by itself.
        let dt = 10_f64.powf(-2.5 - f64::from(k) / f64::from(PER_DECADE));
        let motion = [sine(Given::Displacement, block.amplitude)?, Motion::still(), Motion::still()];
        let (model, start) = on_moving(motion, friction, [0.0; 2], dt)?;
        let (mut error, mut at) = (0.0_f64, 0);
        // Ways of moving, each with its first step's middle: sign of the slide, 0 for a stick.
        let mut ways: Vec<(f64, f64)> = Vec::new();
        runner.run(&model, &start, (DURATION / dt) as u64, |_, state| {
            while phases.get(at + 1).is_some_and(|next| next.start <= state.t) {
                at += 1;
            }
            error = error.max((state.q[0] - block.at(&phases[at], state.t)[0]).abs());
            let slide = state.v[3] - state.v[0];
            let way = if slide.abs() <= 1e-9 { 0.0 } else { slide.signum() };
            if ways.last().is_none_or(|last| last.0 != way) {
                ways.push((way, state.t - 0.5 * dt));
            }
            ControlFlow::Continue(())
        })?;
        points.push((dt, error));
        if k % PER_DECADE == 0 && k / PER_DECADE <= 1 {
            // Where a slide turns round, the step of the change ends on the floor: no stick.
            let turns: Vec<f64> = changes(&ways, dt);
            let exact: Vec<f64> = phases[1..].iter().map(|phase| phase.start).collect();
            let late = if turns.len() == exact.len() {
                turns.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            } else {
                f64::NAN
            };
            let what = format!("{}, μg = {share} aω², h = {dt:.2e} s", runner.name());
            let (exact, found) = (exact.len() as f64, turns.len() as f64);
            let count = format!("{what}: changes between slide and stick or slide");
            let times = format!("{what}: worst of their times, s");
            findings.checks.extend([Check::absolute(count, exact, found, 0.0), Check::worst(times, late, 2.0 * dt)]);
        }
    }
    Ok(points)
}

/// Times of the changes, without sticks of a single step.
fn changes(ways: &[(f64, f64)], dt: f64) -> Vec<f64> {
    let mut times = Vec::new();
    for i in 1..ways.len() {
        let of_a_turn = |i: usize| {
            ways[i].0 == 0.0
                && ways.get(i + 1).is_some_and(|next| next.1 - ways[i].1 < 1.5 * dt && next.0 != ways[i - 1].0)
        };
        if i >= 2 && of_a_turn(i - 1) {
            continue;
        }
        times.push(ways[i].1);
    }
    times
}

/// A floor that shakes up and down with 0.9 g.
fn vertical(runner: &mut Runner, findings: &mut Findings) -> Result<()> {
    let amplitude = 0.9 * GRAVITY / (OMEGA * OMEGA);
    let motion = [Motion::still(), sine(Given::Displacement, amplitude)?, Motion::still()];
    let dt = 1e-3;
    let (model, start) = on_moving(motion.clone(), 0.5, [0.0, motion[1].velocity(0.0)], dt)?;
    let (mut gap, mut force, mut open) = (0.0_f64, 0.0_f64, 0);
    runner.run(&model, &start, 3000, |step, state| {
        gap = gap.max((state.q[1] - state.q[4] - 0.5 * FLAT_BLOCK.height).abs());
        let pressed: f64 = step.contacts().map(|contact| contact.p[0]).sum();
        if pressed <= 0.0 {
            open += 1;
        }
        // A step ends with the mean velocity over the time about its end; the start has its own.
        let drive = |t: f64| {
            if t == 0.0 { motion[1].velocity(t) } else { motion[1].mean_velocity(t - 0.5 * dt, t + 0.5 * dt) }
        };
        let rise = drive(step.t_end) - drive(step.t_start);
        force = force.max((pressed / (FLAT_BLOCK.mass() * (GRAVITY * dt + rise)) - 1.0).abs());
        ControlFlow::Continue(())
    })?;
    let what = |what: &str| format!("{}, vertical shaking: {what}", runner.name());
    findings.checks.extend([
        Check::absolute(what("steps without contact"), 0.0, f64::from(open), 0.0),
        Check::worst(what("largest gap, m"), gap, 1e-12),
        Check::worst(what("largest error of the force, relative"), force, 1e-9),
    ]);
    Ok(())
}

/// The paper's rocking block on ground and on a beam that travel, against those at rest.
fn travelling(runner: &mut Runner, findings: &mut Findings) -> Result<()> {
    let (dt, steps) = (1e-4, 5000);
    let law = PairLaw::new(0.5, 0.0);
    let gravity = Vector2::new(0.0, -GRAVITY);
    let uniform = || -> Result<[Motion; 2]> {
        let one: Arc<dyn Signal> = Arc::new(Formula::constant(0.0)?);
        Ok(TRAVEL.map(|v| Motion::still().with(Given::Velocity, v, Arc::clone(&one))))
    };
    let [x, y] = uniform()?;
    let tilted = |x: f64| PAPER_BLOCK.on_left_corner(Vector2::new(x, 0.0), 5.0_f64.to_radians()).to_vec();
    let beam = paper_beam(20, 0.01)?;
    let dofs = beam.dofs();
    let scenes: [(&str, f64, usize, Model<2>, Model<2>); 2] = [
        (
            "ground",
            0.0,
            0,
            block_over(&PAPER_BLOCK, gravity, law, Box::new(Ground::flat(0.0)))?,
            block_over(&PAPER_BLOCK, gravity, law, Box::new(Ground::moving(0.0, [x, y, Motion::still()])))?,
        ),
        (
            "beam",
            0.165,
            dofs,
            block_over(&PAPER_BLOCK, gravity, law, Box::new(beam_body(&beam)))?,
            block_over(&PAPER_BLOCK, gravity, law, Box::new(beam_body(&beam).with_motion(uniform()?)))?,
        ),
    ];
    for (on, at, dofs, still, moving) in scenes {
        let mut q = tilted(at);
        q.resize(still.size().q, 0.0);
        let start = Start { v: vec![0.0; q.len()], q, dt, theta: 0.5 };
        let mut path = Vec::new();
        runner.run(&still, &start, steps, |_, state| {
            path.push((state.q.clone(), state.v.clone()));
            ControlFlow::Continue(())
        })?;
        let mut travelling = start;
        travelling.q.resize(moving.size().q, 0.0);
        travelling.v.resize(moving.size().v, 0.0);
        (travelling.v[0], travelling.v[1]) = (TRAVEL[0], TRAVEL[1]);
        let mut off = [0.0_f64; 2];
        runner.run(&moving, &travelling, steps, |step, state| {
            let (q, v) = &path[step.step as usize - 1];
            for i in 0..3 + dofs {
                let frame = if i < 2 { TRAVEL[i] } else { 0.0 };
                off[0] = off[0].max((state.q[i] - frame * state.t - q[i]).abs());
                off[1] = off[1].max((state.v[i] - frame - v[i]).abs());
            }
            ControlFlow::Continue(())
        })?;
        let what = |what: &str| format!("{}, travelling {on}: {what}", runner.name());
        findings.checks.extend([
            Check::worst(what("coordinates, m and rad"), off[0], RELATIVE),
            Check::worst(what("velocities, m/s and rad/s"), off[1], 2.0 * RELATIVE / dt),
        ]);
    }
    Ok(())
}
