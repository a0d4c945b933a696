//! Bending moment, transverse force and reactions: at rest against closed forms, in motion against equilibrium.

use super::beam_supports::support;
use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beams::ends::{self, End, holding_pairs};
use crate::exact::beams::statics::{Load, Problem};
use crate::scene::{GRAVITY, PAPER_BLOCK, Runner, Start, Stepping, beam_body, block_over, paper_beam};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use teeter_beam::{Actions, Beam, BeamSpec, Section, SectionForces, SpanLoad};
use teeter_detect::BodyId;
use teeter_integrator::{BeamForces, PairLaw, State};

pub(crate) struct SectionForcesCase;

/// No round numbers: nothing is exact by luck.
const SPAN: f64 = 0.37;
const STIFFNESS: f64 = 0.58;
/// GA_s such that EI/(GA_s L²) is 0.04.
const SHEAR: f64 = STIFFNESS / (0.04 * SPAN * SPAN);
/// N, N·m and N/m.
const FORCE: f64 = -3.3;
const COUPLE: f64 = 0.7;
const LOAD: f64 = -21.0;

/// Probes along the span: none is a node of a mesh, or where a load acts.
const PROBES: u32 = 101;

/// Of moments relative to the load times L, of forces to the load. The rounding ε w of both ends of an element changes its transverse force
/// by 2 (12 EI/l³) ε w: with 50 elements and the w of a couple at the end of a guided–pinned beam, C L²/(2 EI), that is 12 n³ ε = 1.7e-10 of C/L.
const AT_REST: f64 = 1.7e-10;

/// Of sums over the beam, relative to the largest force of the step.
const BALANCE: f64 = 1e-11;

/// Of V just left and right of nodes where nothing acts. Rounding of q as above, with w of static size and the smallest of the forces that are
/// largest in a step: 0.1 N.
const CONTINUITY: f64 = 1e-10;

impl Case for SectionForcesCase {
    fn name(&self) -> &'static str {
        "section_forces"
    }

    fn about(&self) -> &'static str {
        "Bending moment, transverse force and reactions. **At rest**: the loads and pairs of supports of \
         `beam_supports`, meshes of 7, 20 and 50 elements, at 100 probes inside the elements, compared with closed \
         forms: computed from equilibrium they are exact everywhere, not only at nodes. **In motion**: the paper's \
         scene from a static start (20 elements, μ = 0.5, e = 0.2, h = 1e-4 s, 0.5 s with impacts): in every step \
         the reactions, the contact forces p/h, the rate of the beam's momentum and its viscous damping add up to \
         zero, and so do their moments about the left end, relative to the largest force of the step; and V is \
         continuous at unloaded nodes. Also shown: the peak of the left reaction for h = 1e-4 s and 1e-5 s. It is a \
         mean over a step, which during an impact grows as h decreases."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        for (name, pair) in holding_pairs() {
            for (theory, shear) in [("Euler–Bernoulli", f64::INFINITY), ("Timoshenko", SHEAR)] {
                let couple_at = if pair[1].turn == ends::Hold::Held { 0.45 * SPAN } else { SPAN };
                let mut worst = [0.0_f64; 3];
                for elements in [7, 20, 50] {
                    for load in [Load::Force(0.3 * SPAN, FORCE), Load::Couple(couple_at, COUPLE), Load::Uniform(LOAD)] {
                        let found = at_rest(pair, shear, load, elements)?;
                        worst.iter_mut().zip(found).for_each(|(worst, found)| *worst = larger(*worst, found));
                    }
                }
                for (what, error) in ["moment", "transverse force", "reaction"].into_iter().zip(worst) {
                    let quantity = format!("{name}, {theory}: worst {what}, relative");
                    findings.checks.push(Check::worst(quantity, error, AT_REST));
                }
            }
        }
        for stepping in Stepping::ALL {
            let mut runner = Runner::new(stepping);
            let coarse = in_motion(&mut runner, 1e-4)?;
            let fine = in_motion(&mut runner, 1e-5)?;
            let what = |what: &str| format!("{}, in motion: {what}", runner.name());
            findings.checks.extend([
                Check::worst(what("sum of forces, relative"), coarse.force, BALANCE),
                Check::worst(what("sum of moments, relative"), coarse.couple, BALANCE),
                Check::worst(what("jump of V at nodes, relative"), coarse.jump, CONTINUITY),
                Check::reported(what("most contacts"), coarse.contacts as f64),
                Check::reported(what("largest left reaction, N, h = 1e-4 s"), coarse.peak),
                Check::reported(what("largest left reaction, N, h = 1e-5 s"), fine.peak),
            ]);
            findings.checks.extend(runner.account());
        }
        Ok(findings)
    }
}

/// The larger of two errors; NaN is larger than all.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}

/// Worst moment, transverse force and reaction.
fn at_rest(pair: [End; 2], shear: f64, load: Load, elements: usize) -> Result<[f64; 3]> {
    let section = Section::new(STIFFNESS, 0.12)?.with_shear(shear, 0.0)?;
    let beam = Beam::new(BeamSpec::new(SPAN, elements, section).supported(pair.map(support)))?;
    let problem = Problem { span: SPAN, bending: STIFFNESS, shear, ends: pair, loads: vec![load] };
    let exact = problem.solve().ok_or("a pair that doesn't hold the beam")?;
    let mut q = vec![0.0; beam.dofs()];
    let (on_span, scale) = match load {
        Load::Force(x, force) => {
            beam.add_point_load(x, force, &mut q)?;
            (SpanLoad::Point { x, force, couple: 0.0 }, force.abs())
        }
        Load::Couple(x, couple) => {
            beam.add_point_couple(x, couple, &mut q)?;
            (SpanLoad::Point { x, force: 0.0, couple }, couple.abs() / SPAN)
        }
        Load::Uniform(load) => {
            beam.add_uniform_load(load, &mut q)?;
            (SpanLoad::Uniform { from: 0.0, to: SPAN, load }, load.abs() * SPAN)
        }
    };
    beam.solve_static(&mut q)?;
    let forces = beam.section_forces(&Actions::at(&q).with_loads(&[on_span]))?;
    let mut worst = [0.0_f64; 3];
    for k in 1..PROBES {
        let x = SPAN * f64::from(k) / f64::from(PROBES);
        let (found, known) = (forces.at(&beam, x)?, exact.at(x));
        worst[0] = larger(worst[0], (found.moment - known.moment).abs() / (scale * SPAN));
        // Theirs is what the right part does to the left one.
        worst[1] = larger(worst[1], (found.shear + known.shear_force).abs() / scale);
    }
    for (known, x) in exact.reactions().into_iter().zip([0.0, SPAN]) {
        let found = forces.reactions().iter().find(|reaction| reaction.x == x);
        let (force, couple) = found.map_or((0.0, 0.0), |reaction| (reaction.force, reaction.couple));
        worst[2] = larger(worst[2], (force - known.force).abs() / scale);
        worst[2] = larger(worst[2], (couple - known.couple).abs() / (scale * SPAN));
    }
    Ok(worst)
}

/// What a run in motion leaves over.
#[derive(Clone, Copy, Debug, Default)]
struct Leftover {
    force: f64,
    couple: f64,
    jump: f64,
    contacts: usize,
    /// Largest left reaction, N.
    peak: f64,
}

fn in_motion(runner: &mut Runner, dt: f64) -> Result<Leftover> {
    let beam = paper_beam(20, 0.01)?;
    let law = PairLaw::new(0.5, 0.2);
    let model = block_over(&PAPER_BLOCK, Vector2::new(0.0, -GRAVITY), law, Box::new(beam_body(&beam)))?;
    let x = 0.5 * beam.spec().span - 0.5 * PAPER_BLOCK.width;
    let mut deflected = vec![0.0; beam.dofs()];
    beam.add_point_load(x, -PAPER_BLOCK.mass() * GRAVITY, &mut deflected)?;
    beam.solve_static(&mut deflected)?;
    let w = beam.deflection_at(&deflected, x).ok_or("a corner beside the beam")?.w;
    let mut q = PAPER_BLOCK.on_left_corner(Vector2::new(x, w), 5.0_f64.to_radians()).to_vec();
    q.extend(deflected);
    let start = Start { v: vec![0.0; q.len()], q, dt, theta: 0.5 };
    let mut forces = BeamForces::new(&beam, BodyId(1), 3..start.q.len());
    forces.start(&State::new(&model, &start.q, &start.v, dt)?, None)?;
    let mut left = Leftover::default();
    let mut failed = None;
    runner.run(&model, &start, (0.5 / dt).round() as u64, |step, _| {
        left.contacts = left.contacts.max(step.contacts().count());
        for phase in step.phases() {
            match forces.enter(&phase) {
                Ok(None) => continue,
                Ok(Some(found)) => left.take(found),
                Err(error) => {
                    failed = Some(error);
                    return ControlFlow::Break(());
                }
            }
            left.balance(&beam, &forces);
        }
        ControlFlow::Continue(())
    })?;
    failed.map_or(Ok(left), |error| Err(error.into()))
}

impl Leftover {
    fn take(&mut self, found: &SectionForces) {
        self.peak = found.reactions().first().map_or(f64::NAN, |reaction| self.peak.max(reaction.force));
    }

    fn balance(&mut self, beam: &Beam, forces: &BeamForces) {
        let found = forces.forces();
        let span = beam.spec().span;
        let mut most = found.reactions().iter().fold(0.1, |most: f64, reaction| most.max(reaction.force.abs()));
        let mut force: f64 = found.reactions().iter().map(|reaction| reaction.force).sum();
        let mut couple: f64 =
            found.reactions().iter().map(|reaction| reaction.couple + reaction.x * reaction.force).sum();
        for load in forces.loads() {
            // Nothing but contacts acts on this beam.
            let SpanLoad::Point { x, force: push, couple: turn } = *load else { continue };
            most = most.max(push.abs());
            (force, couple) = (force + push, couple + turn + x * push);
        }
        let mut inertia = vec![0.0; beam.dofs()];
        beam.add_mass_product(1.0, forces.acceleration(), &mut inertia);
        beam.add_damping_product(1.0, forces.velocity(), &mut inertia);
        for (node, x) in inertia.chunks_exact(2).zip(beam.node_positions()) {
            (force, couple) = (force - node[0], couple - node[1] - x * node[0]);
        }
        self.force = larger(self.force, force.abs() / most);
        self.couple = larger(self.couple, couple.abs() / (most * span));
        for e in 1..beam.elements() {
            let jump = found.ends(e)[0].shear - found.ends(e - 1)[1].shear;
            self.jump = larger(self.jump, jump.abs() / most);
        }
    }
}
