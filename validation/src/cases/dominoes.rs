//! The speed of the wave along a row of dominoes, scheme by scheme and step by step.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::root::boundary;
use crate::fit::power_law;
use teeter_integrator::Ended;
use teeter_scenario::simulation::Simulation;

pub(crate) struct Dominoes;

const SCENE: &str = include_str!("../../../scenarios/domino.toml");

/// From one domino to the next, m.
const SPACING: f64 = 0.024;

/// From which domino to which, by their numbers from 0, the wave is timed: before, it still depends on the push; after, on the end of the row.
const TIMED: (usize, usize) = (5, 13);

/// A domino has fallen when it leans by this, rad.
const FALLEN: f64 = 0.2;

/// By then the last of those that are timed has fallen, s.
const END: f64 = 0.62;

impl Case for Dominoes {
    fn name(&self) -> &'static str {
        "dominoes"
    }

    fn about(&self) -> &'static str {
        "`scenarios/domino.toml`: 16 dominoes of 8 × 48 mm, 24 mm apart, μ = 0.2 between them and 0.5 on the floor. The \
         speed of the wave, 8 spacings over the time from when the sixth leans by 0.2 rad until the fourteenth does. \
         Between steps the lean is the cubic with its values and spins there. `event-driven` locates every contact; the \
         others must come to its speed as their step is made shorter."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let reference = speed("event-driven", 1e-3)?;
        findings.checks.push(Check::reported("event-driven: m/s", reference));
        let finer = speed("event-driven", 5e-4)?;
        findings.checks.push(Check::relative("event-driven, output twice as often: m/s", reference, finer, 2e-7));
        for (step, bound) in [(1e-3, 1e-4), (1e-4, 1e-5)] {
            let quantity = format!("moreau-jean-located, h = {step:.0e} s: m/s");
            let found = speed("moreau-jean-located", step)?;
            findings.checks.push(Check::relative(quantity, reference, found, bound));
        }
        let steps: &[f64] = if depth == Depth::Short { &[1e-3, 2e-4] } else { &[1e-3, 2e-4, 4e-5, 8e-6] };
        for scheme in ["moreau-jean", "moreau-jean-closed"] {
            let mut points = Vec::new();
            for &step in steps {
                let found = speed(scheme, step)?;
                let quantity = format!("{scheme}, h = {step:.0e} s: m/s");
                // Schemes of first order: 2 % at 1 ms.
                findings.checks.push(Check::relative(quantity, reference, found, 20.0 * step));
                points.push((step, (found - reference).abs()));
            }
            // Of first order; faster over a few steps where errors of either sign cancel.
            if depth == Depth::Full {
                let order = power_law(&points).order;
                findings.checks.push(Check::between(format!("{scheme}: order of the speed"), 1.0, order, 0.8, 1.6));
            }
        }
        Ok(findings)
    }
}

/// The wave's speed, m/s.
fn speed(scheme: &str, step: f64) -> Result<f64> {
    let sets = [
        ("time.scheme".to_owned(), scheme.to_owned()),
        ("time.step".to_owned(), format!("{step:e} s")),
        ("time.end".to_owned(), format!("{END} s")),
    ];
    let resolved =
        teeter_scenario::load(SCENE.as_bytes(), "domino.toml", "domino", &sets).map_err(|e| e.to_string())?;
    let mut simulation = Simulation::new(&resolved.scene)?;
    let places = [TIMED.0, TIMED.1].map(|k| simulation.layout.blocks[k].range.start + 2);
    let mut fallen = [None; 2];
    let mut before = simulation.state.clone();
    while simulation.state.t < END && fallen[1].is_none() {
        match simulation.run_until(simulation.state.t + step, &mut [])? {
            Ended::Complete => {}
            ended => return Err(format!("{scheme}: {ended:?}").into()),
        }
        let now = &simulation.state;
        for (place, fallen) in places.iter().zip(&mut fallen).filter(|(_, fallen)| fallen.is_none()) {
            let [was, is] = [before.q[*place].abs(), now.q[*place].abs()];
            if is >= FALLEN {
                let h = now.t - before.t;
                let rates = [&before, now].map(|state| h * state.v[*place].abs());
                *fallen = Some(before.t + h * crossing([was - FALLEN, is - FALLEN], rates));
            }
        }
        before.clone_from(now);
    }
    let [Some(first), Some(last)] = fallen else { return Err(format!("{scheme}, {step} s: the wave stops").into()) };
    Ok((TIMED.1 - TIMED.0) as f64 * SPACING / (last - first))
}

/// Where in [0, 1] the cubic with these values and slopes at 0 and 1 rises through 0.
fn crossing([a, b]: [f64; 2], [da, db]: [f64; 2]) -> f64 {
    let (c2, c3) = (3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db);
    boundary(0.0, 1.0, |s| ((c3 * s + c2) * s + da) * s + a >= 0.0)
}
