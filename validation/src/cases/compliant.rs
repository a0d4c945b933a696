//! Contacts with duration: a flat drop against the exact impact, and stiffness far too high for the step.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::compliant_impact::{HuntCrossley, KelvinVoigt};
use crate::figure::{Axes, Figure, Series};
use crate::fit::power_law;
use crate::scene::{GAIN, GRAVITY, PAPER_BLOCK, Runner, Start, Stepping, block_over};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use teeter_integrator::{Ground, ImpactLaw, Model, PairLaw};

pub(crate) struct Compliant;

/// Speed of the impacts, m/s.
const SPEED: f64 = 1.0;

/// Steps in the contact that the fits go over, and those that the errors are judged at.
const PARTS: [u32; 9] = [250, 354, 500, 707, 1000, 1414, 2000, 2828, 4000];
const JUDGED: u32 = 2000;
const ACCURACY: f64 = 1e-6;

/// Hunt and Crossley's d, s/m.
const DAMPING: f64 = 0.3;

/// Kelvin and Voigt's c/(2√(km)).
const RATIO: f64 = 0.2;

impl Case for Compliant {
    fn name(&self) -> &'static str {
        "compliant"
    }

    fn about(&self) -> &'static str {
        "The slender block falls flat, at 1 m/s, on two corners that are springs. *Hunt–Crossley*, d = 0.3 s/m, k = \
         1e4 … 1e12 N/mⁿ: duration and rebound speed compared with an integration to rounding; order 2 in the step, \
         relative errors below 1e-6 with 2000 steps per contact (orders are fitted over 250 to 4000 steps, for the \
         larger of both errors). *Kelvin–Voigt*, c/(2√(km)) = 0.2, closed form; its force ends before the surfaces \
         separate, so time and speed are taken at separation. Its force jumps at first touch, but the scheme is \
         still of second order, as the impulse of that step uses the change of penetration, not the time. \
         **Stability**: dropped from 1 cm, flat and tilted by 0.1, at h = 1e-4 s, 2000 steps: no step gains energy, \
         for any stiffness."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        for stepping in Stepping::ALL {
            let mut runner = Runner::new(stepping);
            let stiffnesses: &[f64] =
                if depth == Depth::Full { &[1e4, 1e6, 1e8, 1e10, 1e12] } else { &[1e4, 1e8, 1e12] };
            for (exponent, stiffness) in stiffnesses.iter().map(|k| (1.5, *k)).chain([(1.0, 1e6), (2.0, 1e6)]) {
                let what = format!("{}, Hunt–Crossley, n = {exponent}, k = {stiffness:.0e}", runner.name());
                judge(&mut runner, &Drop::hunt_crossley(exponent, stiffness)?, &what, &mut findings)?;
            }
            let what = format!("{}, Kelvin–Voigt, k = 1e6", runner.name());
            judge(&mut runner, &Drop::kelvin_voigt(1e6)?, &what, &mut findings)?;
            stability(&mut runner, &mut findings)?;
            findings.checks.extend(runner.account());
        }
        findings.figures.push(loops()?);
        Ok(findings)
    }
}

/// A flat drop and what becomes of it.
struct Drop {
    impact: ImpactLaw,
    /// From first touch to where the surfaces part, s.
    duration: f64,
    /// Upward speed then, m/s.
    rebound: f64,
}

impl Drop {
    fn hunt_crossley(exponent: f64, stiffness: f64) -> Result<Self> {
        let impact = ImpactLaw::HuntCrossley { stiffness, damping: DAMPING, exponent };
        let mass = PAPER_BLOCK.mass();
        let law = HuntCrossley { mass, stiffness: 2.0 * stiffness, damping: DAMPING, exponent, gravity: GRAVITY };
        let end = law.release(SPEED).ok_or("it stays on the spring")?;
        Ok(Self { impact, duration: end.duration, rebound: end.speed })
    }

    fn kelvin_voigt(stiffness: f64) -> Result<Self> {
        let mass = PAPER_BLOCK.mass();
        let damping = 2.0 * RATIO * (2.0 * stiffness * mass).sqrt();
        let impact = ImpactLaw::KelvinVoigt { stiffness, damping: 0.5 * damping };
        let law = KelvinVoigt { mass, stiffness: 2.0 * stiffness, damping, gravity: GRAVITY };
        let end = law.release(SPEED).ok_or("it stays on the spring")?;
        // From the end of the force it flies, up to where the surfaces part.
        let rebound = (end.speed * end.speed - 2.0 * GRAVITY * end.penetration).sqrt();
        Ok(Self { impact, duration: end.duration + (end.speed - rebound) / GRAVITY, rebound })
    }

    /// The same by the program, with so many steps in the contact.
    fn computed(&self, runner: &mut Runner, parts: u32) -> Result<[f64; 2]> {
        let h = self.duration / f64::from(parts);
        // Off the grid of steps, so that first touch falls within one.
        let (model, start) = dropped(self.impact, 0.37 * SPEED * h, 0.0, SPEED, h)?;
        let (mut touch, mut last, mut found) = (None, f64::NAN, None);
        runner.run(&model, &start, 2 * u64::from(parts), |_, state| {
            let gap = state.q[1] - 0.5 * PAPER_BLOCK.height;
            let zero = state.t - h * gap / (gap - last);
            match touch {
                None if gap < 0.0 => touch = Some(if last.is_nan() { 0.37 * h } else { zero }),
                // Back from the end of the step to the crossing.
                Some(touch) if gap >= 0.0 => found = Some([zero - touch, state.v[1] + GRAVITY * (state.t - zero)]),
                _ => {}
            }
            last = gap;
            if found.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        found.ok_or_else(|| "it doesn't come off".into())
    }
}

/// The block above its springs, falling so fast that it touches at `speed`, m/s.
fn dropped(impact: ImpactLaw, height: f64, tilt: f64, speed: f64, dt: f64) -> Result<(Model<2>, Start)> {
    let law = PairLaw::new(0.5, 0.0).with_impact(impact);
    let model = block_over(&PAPER_BLOCK, Vector2::new(0.0, -GRAVITY), law, Box::new(Ground::flat(0.0)))?;
    let low = 0.5 * (PAPER_BLOCK.height * tilt.cos() + PAPER_BLOCK.width * tilt.sin().abs());
    let v = -(speed * speed - 2.0 * GRAVITY * height).max(0.0).sqrt();
    Ok((model, Start { q: vec![0.0, low + height, tilt], v: vec![0.0, v, 0.0], dt, theta: 0.5 }))
}

/// Order and errors of a drop.
fn judge(runner: &mut Runner, drop: &Drop, what: &str, findings: &mut Findings) -> Result<()> {
    let mut points = Vec::new();
    for parts in PARTS {
        let [duration, rebound] = drop.computed(runner, parts)?;
        let error = (duration / drop.duration - 1.0).abs().max((rebound / drop.rebound - 1.0).abs());
        points.push((drop.duration / f64::from(parts), error));
        if parts == JUDGED {
            findings.checks.extend([
                Check::relative(format!("{what}: duration, s, relative"), drop.duration, duration, ACCURACY),
                Check::relative(format!("{what}: rebound, m/s, relative"), drop.rebound, rebound, ACCURACY),
            ]);
        }
    }
    findings.checks.push(Check::between(format!("{what}: order"), 2.0, power_law(&points).order, 1.9, 2.1));
    Ok(())
}

/// Energy with springs that the step is far too long for.
fn stability(runner: &mut Runner, findings: &mut Findings) -> Result<()> {
    let mut all = Runner::new(runner.stepping());
    for exponent in 4..=12 {
        let stiffness = 10_f64.powi(exponent);
        for impact in [
            ImpactLaw::KelvinVoigt { stiffness, damping: 0.0 },
            ImpactLaw::KelvinVoigt { stiffness, damping: 1e-3 * stiffness.sqrt() },
            ImpactLaw::HuntCrossley { stiffness, damping: DAMPING, exponent: 1.5 },
        ] {
            for tilt in [0.0, 0.1] {
                let height = 0.01;
                let (model, mut start) = dropped(impact, height, tilt, 0.0, 1e-4)?;
                start.v.fill(0.0);
                all.run(&model, &start, 2000, |_, _| ControlFlow::Continue(()))?;
            }
        }
    }
    let quantity = format!("{}, k = 1e4 … 1e12, h = 1e-4 s: largest gain of energy in a step, relative", runner.name());
    findings.checks.push(Check::worst(quantity, all.gain(), GAIN));
    Ok(())
}

/// Force over penetration.
fn loops() -> Result<Figure> {
    let mut series = Vec::new();
    let stiffness = 1e6;
    let critical = (2.0 * stiffness * PAPER_BLOCK.mass()).sqrt();
    let drops = [
        ("Hunt–Crossley, n = 1, d = 0.3 s/m", ImpactLaw::HuntCrossley { stiffness, damping: 0.3, exponent: 1.0 }),
        ("Hunt–Crossley, n = 1, d = 1 s/m", ImpactLaw::HuntCrossley { stiffness, damping: 1.0, exponent: 1.0 }),
        ("Kelvin–Voigt, c/(2√(km)) = 0.2", ImpactLaw::KelvinVoigt { stiffness, damping: RATIO * critical }),
    ];
    for (name, impact) in drops {
        let (model, start) = dropped(impact, 0.0, 0.0, SPEED, 1e-5)?;
        let mut points = vec![(0.0, 0.0)];
        Runner::new(Stepping::MoreauJean).run(&model, &start, 400, |step, _| {
            let gaps = step.contacts().next().and_then(|contact| Some((contact.gap, contact.gap_after?)));
            let Some((before, after)) = gaps else { return ControlFlow::Break(()) };
            let force: f64 = step.contacts().map(|contact| contact.p[0]).sum::<f64>() / 1e-5;
            points.push((-0.5e3 * (before + after), 1e-3 * force));
            if after >= 0.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        series.push(Series::curve(name, points));
    }
    Ok(Figure {
        file: "compliant_loops.svg",
        title: "Contacts with duration: force over penetration",
        x: "Penetration (mm)",
        y: "Force of both corners (kN)",
        axes: Axes::Linear,
        caption: "The slender block falls flat at 1 m/s on two springs of 1e6 N/m, steps of 1e-5 s; the area of the \
             loop is the energy lost. The Kelvin–Voigt force jumps at first touch and ends before the surfaces \
             separate; the Hunt–Crossley force starts and ends at zero.",
        series,
    })
}
