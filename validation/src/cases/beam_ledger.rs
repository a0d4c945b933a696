//! The energy account of everything that a beam can have, over a million steps.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::scene::{Runner, Start, Stepping, beam_body};
use std::ops::ControlFlow;
use std::sync::Arc;
use teeter_beam::{
    Axial, Beam, BeamSpec, Damping, DistributedLoad, Foundation, Hold, Load, MovingLoad, Section, Support,
};
use teeter_detect::PointDetector;
use teeter_integrator::{ModelBuilder, State};

pub(crate) struct BeamLedger;

const STEPS: u64 = 1_000_000;
const SHORT: u64 = 20_000;
const DT: f64 = 1e-4;

/// Rounding of one step, relative to the energy scale.
const IDENTITY: f64 = 1e-13;

/// The energy of an undamped beam after a million steps, each off by some units in the last place in either direction.
const DRIFT: f64 = 1e-9;

impl Case for BeamLedger {
    fn name(&self) -> &'static str {
        "beam_ledger"
    }

    fn about(&self) -> &'static str {
        "The energy identity of a step, worst of 1e6 steps (2e4 when short) of h = 1e-4 s with θ = 1/2, relative to \
         the energy scale: an axially held beam that vibrates with all modes at four times its thickness, and a beam \
         with all other features: shear and rotatory inertia, segments, an inner support, springs and dashpots, a \
         foundation, a mass, tension, axial dofs, all kinds of damping, distributed and moving loads. Without \
         damping, the energy of the held beam is conserved."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let steps = if matches!(depth, Depth::Short) { SHORT } else { STEPS };
        let mut findings = Findings::default();
        let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?;
        let held = BeamSpec::new(0.36, 20, section).axial(Axial::Held);

        let beam = Arc::new(Beam::new(held.clone())?);
        let start = rough(&beam)?;
        let initial = beam.kinetic_energy(&start.v) + beam.elastic_energy(&start.q);
        let kept = |state: &State| (state.ledger.current.total() / initial - 1.0).abs();
        let (end, drift) = swing(&beam, start, steps, Vec::new(), kept)?;
        findings.checks.push(Check::worst("axially held: identity", end.ledger.relative_residual(), IDENTITY));
        findings.checks.push(Check::worst("axially held: drift of the energy", drift, DRIFT));

        let damping = Damping::none()
            .with_viscous(0.4)
            .with_rayleigh_mass(0.1)
            .with_rayleigh_stiffness(1e-7)
            .with_modal(vec![0.002, 0.01]);
        let beam = Arc::new(Beam::new(held.damped(damping.clone()))?);
        let (end, _) = swing(&beam, rough(&beam)?, steps, Vec::new(), |_| 0.0)?;
        let quantity = "axially held, damped in every way: identity";
        findings.checks.push(Check::worst(quantity, end.ledger.relative_residual(), IDENTITY));

        let beam = Arc::new(Beam::new(furnished(section, damping)?)?);
        let loads: Vec<Box<dyn Load>> = vec![
            Box::new(MovingLoad::new(-10.0, 0.02, 0.0)?),
            Box::new(DistributedLoad::new(|t: f64| 5.0 * (170.0 * t).sin())),
        ];
        let (end, _) = swing(&beam, rough(&beam)?, steps, loads, |_| 0.0)?;
        findings.checks.push(Check::worst("all features: identity", end.ledger.relative_residual(), IDENTITY));
        findings.checks.push(Check::reported("all features: work of the loads, J", end.ledger.sum.external));
        Ok(findings)
    }
}

/// All that a beam can have at once but held ends.
fn furnished(section: Section, damping: Damping) -> Result<BeamSpec> {
    let thick = section.with_shear(2e5, 1e-7)?;
    let spring = |stiffness, damping| Hold::Spring { stiffness, damping };
    let end = Support::Elastic { deflection: spring(2e3, 0.5), rotation: spring(0.7, 1e-3) };
    Ok(BeamSpec::new(0.36, 20, section)
        .supported([Support::Clamped, end])
        .segment(0.1, 0.2, thick)
        .support_at(0.24, Support::Pinned)
        .lump(0.15, 0.02, 1e-6)
        .foundation(Foundation::new(0.05, 0.3, 2e3).with_damping(0.2))
        .axial(Axial::elastic([true, false]))
        .axial_force(40.0)
        .damped(damping))
}

/// Bent and moving in every mode.
fn rough(beam: &Beam) -> Result<Start> {
    let value = |k: usize, size: f64, factor: f64| if beam.is_held(k) { 0.0 } else { size * (factor * k as f64).sin() };
    let mut q = vec![0.0; beam.dofs()];
    beam.add_point_load(0.3 * beam.spec().span, -30.0, &mut q)?;
    beam.solve_static(&mut q)?;
    let v = (0..beam.dofs()).map(|k| value(k, 0.5, 1.7)).collect();
    Ok(Start { q, v, dt: DT, theta: 0.5 })
}

/// Runs a beam alone; the end, and the largest of what `watch` returns.
fn swing(
    beam: &Arc<Beam>,
    start: Start,
    steps: u64,
    loads: Vec<Box<dyn Load>>,
    watch: impl Fn(&State) -> f64,
) -> Result<(State, f64)> {
    let mut parts = ModelBuilder::new();
    let body = loads.into_iter().fold(beam_body(beam), teeter_integrator::BeamBody::with_load);
    parts.add(body);
    let model = parts.build(Box::new(PointDetector::new(Vec::new())))?;
    let mut largest = 0.0_f64;
    let mut runner = Runner::new(Stepping::MoreauJean);
    let end = runner.run(&model, &start, steps, |_, state| {
        largest = largest.max(watch(state));
        ControlFlow::Continue(())
    })?;
    Ok((end, largest))
}
