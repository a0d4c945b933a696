//! Housner's rocking block: order of convergence of impact times and peaks.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::housner::{Excursion, HousnerBlock};
use crate::figure::{Axes, Figure, Series};
use crate::fit::power_law;
use crate::scene::{GRAVITY, PAPER_BLOCK, Runner, Start, Stepping, block_over};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use teeter_integrator::{Ground, Model, PairLaw, PhaseKind, RockingMonitor};

pub(crate) struct HousnerOrder;

/// Impacts and peaks compared.
const COUNT: usize = 6;
const TILT_DEGREES: f64 = 5.0;
/// Past the sixth impact.
const DURATION: f64 = 1.0;

/// Step sizes a decade. Where in its step an impact falls changes from step size to step size, so errors scatter by a
/// factor of two about the trend: the fit needs many.
const PER_DECADE: u32 = 12;

impl Case for HousnerOrder {
    fn name(&self) -> &'static str {
        "housner_order"
    }

    fn about(&self) -> &'static str {
        "Housner's rocking block (0.03 m × 0.135 m, 2700 kg/m³, released at 5° on rigid ground, μ = 0.5, e = 0, θ = \
         1/2) compared with the quadrature of (4/3) R φ̈ = −g sin(α − φ) with the impacts φ̇⁺ = (1 − (3/2) sin²α) \
         φ̇⁻: the first six impact times (zero crossings of φ, linear between steps) and the first six peaks, \
         including the release. Moreau–Jean is of first order across impacts. Errors of single step sizes are \
         irregular, as impacts fall early or late in a step; the order is the slope of the least-squares line \
         through 37 step sizes from 1e-3 to 1e-6 s, equally spaced logarithmically. moreau-jean-located and \
         event-driven give the impact times themselves."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let exact = HousnerBlock::new(PAPER_BLOCK.width, PAPER_BLOCK.height, GRAVITY)
            .excursions(TILT_DEGREES.to_radians(), COUNT);
        let law = PairLaw::new(0.5, 0.0);
        let model = block_over(&PAPER_BLOCK, Vector2::new(0.0, -GRAVITY), law, Box::new(Ground::flat(0.0)))?;
        let decades = if depth == Depth::Full { 3 } else { 2 };
        let mut runner = Runner::new(Stepping::MoreauJean);
        let (mut times, mut peaks) = (Vec::new(), Vec::new());
        for k in 0..=decades * PER_DECADE {
            let dt = 10_f64.powf(-3.0 - f64::from(k) / f64::from(PER_DECADE));
            let found = excursions(&mut runner, &model, dt)?;
            times.push((dt, worst(&found, &exact, |found, exact| (found.impact - exact.impact).abs())));
            peaks.push((dt, worst(&found, &exact, |found, exact| (found.peak / exact.peak - 1.0).abs())));
        }
        let mut findings = Findings::default();
        let fits = [power_law(&times), power_law(&peaks)];
        for (fit, what) in fits.iter().zip(["six impact times", "six peaks"]) {
            let quantity = format!("order of the worst of {what}");
            findings.checks.push(match depth {
                Depth::Full => Check::between(quantity, 1.0, fit.order, 0.95, 1.1),
                // Two decades of irregular errors don't settle the slope to a tenth.
                Depth::Short => Check::reported(quantity + ", two decades only", fit.order),
            });
        }
        let at = excursions(&mut runner, &model, 1e-5)?;
        findings.checks.extend([
            Check::absolute("h = 1e-5 s: first impact, s", exact[0].impact, at[0].impact, 2e-7),
            Check::worst(
                "h = 1e-5 s: worst of six peaks, relative",
                worst(&at, &exact, |found, exact| (found.peak / exact.peak - 1.0).abs()),
                1.5e-3,
            ),
        ]);
        let mut located = Vec::new();
        for (stepping, steps) in [
            (Stepping::MoreauJeanLocated, &[(1e-3, 2e-5), (1e-4, 2e-7), (1e-5, 2e-9)][..]),
            (Stepping::EventDriven, &[(1e-1, 1e-11), (1e-2, 1e-11), (1e-3, 1e-12), (1e-4, 1e-12)][..]),
        ] {
            let mut runner = Runner::new(stepping);
            let mut errors = Vec::new();
            for &(dt, bound) in steps {
                let times = impacts(&mut runner, &model, dt)?;
                let error = times.iter().zip(&exact).map(|(t, exact)| (t - exact.impact).abs()).fold(0.0, f64::max);
                errors.push((dt, error));
                let quantity = format!("{}, h = {dt:e} s: worst of six impact times, s", runner.name());
                findings.checks.push(Check::worst(quantity, error, bound));
            }
            findings.checks.extend(runner.account());
            located.push(Series::marks(format!("impact times, {}", runner.name()), errors));
        }
        let ends = [times[0].0, times[times.len() - 1].0];
        let line = |fit: usize| ends.map(|dt| (dt, fits[fit].at(dt))).to_vec();
        findings.figures.push(Figure {
            file: "housner_order.svg",
            title: "Housner's block: error over step size",
            x: "Step size h (s)",
            axes: Axes::Logarithmic,
            y: "Error of times (s) and peaks (relative)",
            caption: "Largest error of the first six impact times and of the first six peaks, with fitted lines.",
            series: vec![
                Series::marks("peaks, relative", peaks),
                Series::line(format!("order {:.3}", fits[1].order), line(1)),
                Series::marks("impact times, s", times),
                Series::line(format!("order {:.3}", fits[0].order), line(0)),
            ]
            .into_iter()
            .chain(located)
            .collect(),
        });
        findings.checks.extend(runner.account());
        Ok(findings)
    }
}

/// The first excursions with step `dt`.
fn excursions(runner: &mut Runner, model: &Model<2>, dt: f64) -> Result<Vec<Excursion>> {
    let q = PAPER_BLOCK.on_left_corner(Vector2::zeros(), TILT_DEGREES.to_radians());
    let start = Start { q: q.to_vec(), v: vec![0.0; 3], dt, theta: 0.5 };
    let mut monitor = RockingMonitor::new(0.0, q[2]);
    runner.run(model, &start, (DURATION / dt).ceil() as u64, |_, state| {
        monitor.enter(state.t, state.q[2]);
        if monitor.crossings().len() == COUNT { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    if monitor.crossings().len() < COUNT {
        return Err(format!("only {} impacts with a step of {dt:e} s", monitor.crossings().len()).into());
    }
    let pairs = monitor.peaks().iter().zip(monitor.crossings());
    Ok(pairs.map(|(peak, crossing)| Excursion { peak: peak.phi, impact: crossing.t }).collect())
}

/// The times of the first impacts that the scheme itself has located.
fn impacts(runner: &mut Runner, model: &Model<2>, dt: f64) -> Result<Vec<f64>> {
    let q = PAPER_BLOCK.on_left_corner(Vector2::zeros(), TILT_DEGREES.to_radians());
    let start = Start { q: q.to_vec(), v: vec![0.0; 3], dt, theta: 0.5 };
    let mut times = Vec::new();
    runner.run(model, &start, (DURATION / dt).ceil() as u64, |step, _| {
        let impacts = step.phases().filter(|phase| phase.kind == PhaseKind::Impact);
        times.extend(impacts.map(|phase| phase.end));
        if times.len() >= COUNT { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    times.truncate(COUNT);
    if times.len() < COUNT {
        return Err(format!("only {} impacts with a step of {dt:e} s", times.len()).into());
    }
    Ok(times)
}

/// The largest error over all excursions.
fn worst(found: &[Excursion], exact: &[Excursion], error: impl Fn(&Excursion, &Excursion) -> f64) -> f64 {
    found.iter().zip(exact).map(|(found, exact)| error(found, exact)).fold(0.0, f64::max)
}
