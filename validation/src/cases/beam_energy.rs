//! Free vibration of an undamped beam: its energy is kept with θ = 1/2, and lost at the known rate above.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::scene::{Runner, Start, Stepping, beam_body, paper_beam};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;
use teeter_beam::Beam;
use teeter_detect::PointDetector;
use teeter_integrator::ModelBuilder;

pub(crate) struct BeamEnergy;

const STEPS: u64 = 100_000;
const DISSIPATING: u64 = 1000;
const DT: f64 = 1e-4;

/// (π/L)² √(EI/ρA) of the paper's beam, rad/s.
const OMEGA: f64 = 166.700_937_859_116_52;

/// 1e5 steps, at worst each off by half a unit in the last place and all with one sign.
const DRIFT: f64 = 1e-11;

/// 1000 steps with ω too high by 4e-7, and a start that is the mode only as exactly as that.
const LOSS: f64 = 1e-6;

impl Case for BeamEnergy {
    fn name(&self) -> &'static str {
        "beam_energy"
    }

    fn about(&self) -> &'static str {
        "The paper's beam (20 elements, no damping, h = 1e-4 s). Released from its shape under 3 N at 0.3 of the \
         span, with θ = 1/2: 1e5 steps, some 265 periods of the first mode; the energy is conserved to rounding. \
         Released in its first mode with θ > 1/2: a step leaves (1 + (1−θ)²ω²h²)/(1 + θ²ω²h²) of a mode's energy, \
         here with the continuous beam's ω₁, from which that of 20 elements differs by 4e-7."
    }

    fn run(&self, _: Depth) -> Result<Findings> {
        let beam = paper_beam(20, 0.0)?;
        let mut runner = Runner::new(Stepping::MoreauJean);
        let mut q = vec![0.0; beam.dofs()];
        beam.add_point_load(0.3 * beam.spec().span, -3.0, &mut q)?;
        beam.solve_static(&mut q)?;
        let [drift, _] = energies(&mut runner, &beam, q, 0.5, STEPS)?;
        let quantity = "θ = 1/2: largest drift of the energy in 1e5 steps, relative";
        let mut checks = vec![Check::worst(quantity, drift, DRIFT)];

        let span = beam.spec().span;
        let nodes: Vec<[f64; 2]> = (0..beam.nodes())
            .map(|node| PI * node as f64 / (beam.nodes() - 1) as f64)
            .map(|x| [0.005 * x.sin(), 0.005 * PI / span * x.cos()])
            .collect();
        for theta in [0.75, 1.0] {
            let [_, left] = energies(&mut runner, &beam, beam.from_nodes(&nodes)?, theta, DISSIPATING)?;
            let turn = (OMEGA * DT).powi(2);
            let step = (1.0 + (1.0 - theta).powi(2) * turn) / (1.0 + theta * theta * turn);
            let exact = step.powf(DISSIPATING as f64);
            let quantity = format!("θ = {theta}: energy of mode 1 left after 1000 steps, relative");
            checks.push(Check::relative(quantity, exact, left, LOSS));
        }
        checks.extend(runner.account());
        Ok(Findings { checks, ..Findings::default() })
    }
}

/// The largest drift of the energy, and what is left of it at the end, relative to the start.
fn energies(runner: &mut Runner, beam: &Arc<Beam>, q: Vec<f64>, theta: f64, steps: u64) -> Result<[f64; 2]> {
    let mut parts = ModelBuilder::new();
    parts.add(beam_body(beam));
    let model = parts.build(Box::new(PointDetector::new(Vec::new())))?;
    let start = Start { v: vec![0.0; beam.dofs()], q, dt: DT, theta };
    let initial = model.energy(&start.q, &start.v)?.total();
    let mut drift = 0.0_f64;
    let end = runner.run(&model, &start, steps, |_, state| {
        drift = drift.max((state.ledger.current.total() - initial).abs());
        ControlFlow::Continue(())
    })?;
    Ok([drift / initial, end.ledger.current.total() / initial])
}
