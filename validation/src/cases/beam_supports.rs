//! Deflections, rotations and reactions at the nodes for all pairs of supports, with shear, springs and a third support.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::beams::ends::{self, End, holding_pairs};
use crate::exact::beams::statics::{Bent, Load, Problem};
use crate::exact::beams::two_spans::TwoSpans;
use teeter_beam::{Beam, BeamSpec, Hold, Section, Support};

pub(crate) struct BeamSupports;

/// No round numbers: nothing is exact by luck.
const SPAN: f64 = 0.37;
const STIFFNESS: f64 = 0.58;
/// GA_s such that EI/(GA_s L²) is 0.04: a stubby beam.
const SHEAR: f64 = STIFFNESS / (0.04 * SPAN * SPAN);
/// N, N·m and N/m.
const FORCE: f64 = -3.3;
const COUPLE: f64 = 0.7;
const LOAD: f64 = -21.0;

/// Of w and r L, relative to the largest of both: both elements are exact at their nodes, so this is rounding of the refined solve.
const NODES: f64 = 1e-13;

/// Of reactions, relative to the load. A rounding of w alone changes a force K q by (12 EI/l³) ε w: with 100 elements and the w of a force on a
/// guided–pinned beam, F L³/(3 EI), that is 4 n³ ε = 4.4e-10 of the force.
const REACTIONS: f64 = 5e-10;

impl Case for BeamSupports {
    fn name(&self) -> &'static str {
        "beam_supports"
    }

    fn about(&self) -> &'static str {
        "A beam at rest with all statically admissible pairs of free, pinned, clamped and guided ends, and on \
         springs, under a force at 0.3 of the span, a couple at the right end (inside the span if that end can't \
         rotate) and a uniform load, Euler–Bernoulli and Timoshenko (EI/(GA_s L²) = 0.04): deflection and rotation \
         of every node and the reactions, K q minus the load at fixed dofs, compared with closed forms. Meshes of 2, \
         3, …, 100 elements. Both elements are exact at their nodes; the errors (of w and r L relative to the larger \
         of both, of reactions relative to the load) are rounding: for reactions that of the entries of q, (12 \
         EI/l³) ε w."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let meshes = || (2..=100).step_by(if depth == Depth::Full { 1 } else { 7 });
        let mut findings = Findings::default();
        let springs = End { shift: ends::Hold::Spring(11.0), turn: ends::Hold::Spring(1.9) };
        let mut pairs = holding_pairs();
        pairs.push(("springs–free".to_owned(), [springs, ends::FREE]));
        pairs.push(("guided–springs".to_owned(), [ends::GUIDED, springs]));
        for (name, pair) in pairs {
            for (theory, shear) in [("Euler–Bernoulli", f64::INFINITY), ("Timoshenko", SHEAR)] {
                // At an end that can turn, or else within the span.
                let couple_at = if pair[1].turn == ends::Hold::Held { 0.45 * SPAN } else { SPAN };
                let mut worst = Errors::default();
                for elements in meshes() {
                    for load in [Load::Force(0.3 * SPAN, FORCE), Load::Couple(couple_at, COUPLE), Load::Uniform(LOAD)] {
                        worst.take(errors(pair, shear, load, elements)?);
                    }
                }
                worst.tell(&format!("{name}, {theory}"), &mut findings);
            }
        }
        let mut worst = Errors::default();
        for elements in meshes() {
            worst.take(two_spans(elements)?);
        }
        worst.tell("two spans, Euler–Bernoulli", &mut findings);
        Ok(findings)
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    nodes: f64,
    reactions: f64,
}

impl Errors {
    fn tell(self, beam: &str, findings: &mut Findings) {
        findings.checks.push(Check::worst(format!("{beam}: worst node, relative"), self.nodes, NODES));
        findings.checks.push(Check::worst(format!("{beam}: worst reaction, relative"), self.reactions, REACTIONS));
    }

    fn take(&mut self, other: Self) {
        self.nodes = larger(self.nodes, other.nodes);
        self.reactions = larger(self.reactions, other.reactions);
    }
}

/// The larger of two errors; NaN is larger than all.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}

/// What teeter-beam calls an end.
pub(super) fn support(end: End) -> Support {
    let hold = |hold| match hold {
        ends::Hold::Free => Hold::Free,
        ends::Hold::Spring(stiffness) => Hold::Spring { stiffness, damping: 0.0 },
        ends::Hold::Held => Hold::Fixed,
    };
    Support::Elastic { deflection: hold(end.shift), rotation: hold(end.turn) }
}

fn errors(pair: [End; 2], shear: f64, load: Load, elements: usize) -> Result<Errors> {
    let section = Section::new(STIFFNESS, 0.12)?.with_shear(shear, 0.0)?;
    let beam = Beam::new(BeamSpec::new(SPAN, elements, section).supported(pair.map(support)))?;
    let problem = Problem { span: SPAN, bending: STIFFNESS, shear, ends: pair, loads: vec![load] };
    let exact = problem.solve().ok_or("a pair that doesn't hold the beam")?;
    let (q, left_over) = equilibrium(&beam, &[load])?;
    let last = 2 * beam.nodes() - 2;
    let (force_scale, couple_scale) = match load {
        Load::Force(_, p) => (p.abs(), p.abs() * SPAN),
        Load::Couple(_, c) => (c.abs() / SPAN, c.abs()),
        Load::Uniform(p) => (p.abs() * SPAN, p.abs() * SPAN * SPAN),
    };
    let mut reactions = 0.0;
    for (end, (known, dof)) in exact.reactions().into_iter().zip([0, last]).enumerate() {
        // A held dof's reaction is what K q lacks of the load; a spring's, its force.
        let found = |hold, dof: usize| match hold {
            ends::Hold::Free => 0.0,
            ends::Hold::Spring(k) => -k * q[dof],
            ends::Hold::Held => left_over[dof],
        };
        reactions = larger(reactions, (found(pair[end].shift, dof) - known.force).abs() / force_scale);
        reactions = larger(reactions, (found(pair[end].turn, dof + 1) - known.couple).abs() / couple_scale);
    }
    Ok(Errors { nodes: worst_node(&beam, &q, &exact), reactions })
}

fn two_spans(elements: usize) -> Result<Errors> {
    let known = TwoSpans { span: SPAN, place: 0.6 * SPAN, uniform: LOAD, force: (0.3 * SPAN, FORCE) };
    let exact = known.bent(STIFFNESS).ok_or("three supports hold a beam")?;
    let spec = BeamSpec::new(SPAN, elements, Section::new(STIFFNESS, 0.12)?).support_at(known.place, Support::Pinned);
    let beam = Beam::new(spec)?;
    let (q, left_over) = equilibrium(&beam, &[Load::Uniform(LOAD), Load::Force(known.force.0, FORCE)])?;
    let held: Vec<f64> = (0..beam.dofs()).filter(|dof| beam.is_held(*dof)).map(|dof| left_over[dof]).collect();
    if held.len() != 3 {
        return Err(format!("three reactions, not {}", held.len()).into());
    }
    let scale = FORCE.abs() + LOAD.abs() * SPAN;
    let reactions = held.iter().zip(known.reactions()).fold(0.0, |e, (a, b)| larger(e, (a - b).abs() / scale));
    Ok(Errors { nodes: worst_node(&beam, &q, &exact), reactions })
}

/// q, and K q less the load.
fn equilibrium(beam: &Beam, loads: &[Load]) -> Result<(Vec<f64>, Vec<f64>)> {
    let mut load = vec![0.0; beam.dofs()];
    for part in loads {
        match *part {
            Load::Force(x, p) => beam.add_point_load(x, p, &mut load)?,
            Load::Couple(x, c) => beam.add_point_couple(x, c, &mut load)?,
            Load::Uniform(p) => beam.add_uniform_load(p, &mut load)?,
        }
    }
    let mut q = load.clone();
    beam.solve_static(&mut q)?;
    let mut left_over: Vec<f64> = load.iter().map(|f| -f).collect();
    beam.add_stiffness_product(1.0, &q, &mut left_over);
    Ok((q, left_over))
}

/// The worst error of w or r L, relative to the largest of both.
fn worst_node(beam: &Beam, q: &[f64], exact: &Bent) -> f64 {
    let (mut largest, mut error) = (0.0_f64, 0.0_f64);
    for (found, x) in beam.to_nodes(q).iter().zip(beam.node_positions()) {
        let known = exact.at(*x);
        for (found, known) in [(found[0], known.deflection), (found[1] * SPAN, known.rotation * SPAN)] {
            largest = largest.max(known.abs());
            error = larger(error, (found - known).abs());
        }
    }
    error / largest
}
