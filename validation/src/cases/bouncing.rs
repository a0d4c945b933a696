//! A block that bounces to rest, and one that bounces for ever: impact times, the Zeno limit, a thousand apexes.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::bouncing_point::BouncingPoint;
use crate::figure::{Axes, Figure, Series};
use crate::fit::power_law;
use crate::scene::{FLAT_BLOCK, GRAVITY, Runner, Start, Stepping, block_over, points_over};
use nalgebra::Vector2;
use std::ops::ControlFlow;
use teeter_integrator::{Ground, Model, PairLaw, PhaseKind};

pub(crate) struct Bouncing;

/// e = 0.8, dropped from 0.1 m: lies after 1.285 s.
const POINT: BouncingPoint = BouncingPoint { height: 0.1, gravity: GRAVITY, restitution: 0.8 };
const IMPACTS: i32 = 10;

/// Step sizes a decade, as many as the scatter of the errors needs.
const PER_DECADE: u32 = 12;

/// e = 1 by the event-driven scheme: height and time of the apex after very many bounces. The block
/// touches by the middle of its base: on two corners its upright fall is unstable, and rounding turns it
/// over after some ten thousand bounces, in nature as here.
fn very_many(depth: Depth, findings: &mut Findings) -> Result<()> {
    let mut runner = Runner::new(Stepping::EventDriven);
    let bounces: u64 = if depth == Depth::Full { 100_000 } else { 10_000 };
    let floor = 0.5 * FLAT_BLOCK.height;
    let (law, middle) = (PairLaw::new(0.3, 1.0), vec![Vector2::new(0.0, -floor)]);
    let model = points_over(&FLAT_BLOCK, middle, Vector2::new(0.0, -GRAVITY), law, Box::new(Ground::flat(0.0)))?;
    let flight = 2.0 * (2.0 * LOW / GRAVITY).sqrt();
    let (exact, dt) = (flight * bounces as f64, 0.5 * flight);
    let start = Start { q: vec![0.0, floor + LOW, 0.0], v: vec![0.0; 3], dt, theta: 0.5 };
    let mut struck = 0;
    let end = runner.run(&model, &start, 2 * bounces, |step, _| {
        struck += step.phases().filter(|phase| phase.kind == PhaseKind::Impact).count() as u64;
        ControlFlow::Continue(())
    })?;
    let (height, rate) = (end.q[1] - floor + 0.5 * end.v[1] * end.v[1] / GRAVITY, end.v[1]);
    let what = |what: &str| format!("{}, e = 1, {bounces} bounces on a point: {what}", runner.name());
    findings.checks.extend([
        Check::absolute(what("how many"), bounces as f64, struck as f64, 0.0),
        Check::relative(what("height of the apex, m, relative"), LOW, height, 1e-9),
        Check::relative(what("its time, s, relative"), exact, end.t + rate / GRAVITY, 1e-9),
    ]);
    findings.checks.extend(runner.account());
    Ok(())
}

/// The drop whose bounces never end, m: 1000 of them in 90 s.
const LOW: f64 = 0.01;
const BOUNCES: usize = 1000;

impl Case for Bouncing {
    fn name(&self) -> &'static str {
        "bouncing"
    }

    fn about(&self) -> &'static str {
        "The block of `bounce` with both schemes. **e = 0.8**, dropped from 0.1 m: ten impact times (the middles of \
         their steps) and the Zeno time t₁(1 + e)/(1 − e). Let the step of an impact start σhv above the floor, v \
         the speed there: `moreau-jean` looks half a step ahead, so σ is in ±½; `moreau-jean-closed` closes contacts \
         that would penetrate within the step, so σ is in 0 … 1. To leading order in h the block leaves the floor \
         late by h(1 + e)(1 − 2σ)/(2e) and too fast by gh(1 − e)(2σ(1 + e) − 1)/(2e), and an error of the speed \
         makes the flight longer by 2/g of it. The bounds are those for the worst σ of every impact, plus a tenth \
         for the next order. Then it rests: with `moreau-jean` a resting block with e > 0 may hop, with |v| ≤ gh; \
         with `moreau-jean-closed` an approach slower than the velocity gained by gravity in a step isn't an impact, \
         so the block lies still. **e = 1**, from 0.01 m: an impact reverses the velocity in place, so that with \
         both schemes the apex after 1000 bounces (y + v²/(2g) at the nearest step) is the initial height, to \
         rounding. Only the time drifts, by (1 − 2σ)h per bounce; all bounces take the same number of steps, so σ \
         stays the same and the drift doesn't average out: up to 2h late per bounce with `moreau-jean`, up to h late \
         or early with `moreau-jean-closed`, depending on the step. The bound is 1000 times this, at h = 1e-5 s 2e-4 \
         and 1e-4 of the time: neither scheme gives the time of the thousandth apex to 1e-6. event-driven locates \
         impacts: its apex after 100 000 bounces on a point must be accurate to 1e-9, in place and time."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let mut series = Vec::new();
        let decades = if depth == Depth::Full { 2 } else { 1 };
        for stepping in Stepping::ALL {
            let mut runner = Runner::new(stepping);
            let points = times(&mut runner, decades, &mut findings)?;
            let fit = power_law(&points);
            let order = format!("{}, e = 0.8: order of the worst of ten impact times", runner.name());
            findings.checks.push(match depth {
                Depth::Full => Check::between(order, 1.0, fit.order, 0.9, 1.1),
                Depth::Short => Check::reported(order + ", one decade only", fit.order),
            });
            let ends = [points[0].0, points[points.len() - 1].0];
            series.push(Series::marks(runner.name(), points));
            series.push(Series::line(format!("order {:.3}", fit.order), ends.map(|dt| (dt, fit.at(dt))).to_vec()));
            for dt in [1e-3, 1e-4] {
                settle(&mut runner, dt, &mut findings)?;
            }
            for dt in if depth == Depth::Full { &[1e-3, 1e-4, 1e-5][..] } else { &[1e-3, 1e-4][..] } {
                thousand(&mut runner, *dt, &mut findings)?;
            }
            findings.checks.extend(runner.account());
        }
        very_many(depth, &mut findings)?;
        findings.figures.push(Figure {
            file: "bouncing.svg",
            title: "Bouncing block, e = 0.8: error over step size",
            x: "Step size h (s)",
            y: "Error of the impact times (s)",
            axes: Axes::Logarithmic,
            caption: "Largest error of the first ten impact times, with fitted lines.",
            series,
        });
        Ok(findings)
    }
}

fn dropped(restitution: f64, height: f64, dt: f64) -> Result<(Model<2>, Start)> {
    let law = PairLaw::new(0.3, restitution);
    let model = block_over(&FLAT_BLOCK, Vector2::new(0.0, -GRAVITY), law, Box::new(Ground::flat(0.0)))?;
    let q = vec![0.0, 0.5 * FLAT_BLOCK.height + height, 0.0];
    Ok((model, Start { q, v: vec![0.0; 3], dt, theta: 0.5 }))
}

/// Errors of impact times over step sizes; judges those at 1e-3 and 1e-4 s.
fn times(runner: &mut Runner, decades: u32, findings: &mut Findings) -> Result<Vec<(f64, f64)>> {
    let mut points = Vec::new();
    for k in 0..=decades * PER_DECADE {
        let dt = 10_f64.powf(-3.0 - f64::from(k) / f64::from(PER_DECADE));
        let (model, start) = dropped(POINT.restitution, POINT.height, dt)?;
        let (mut found, mut before) = (Vec::new(), 0.0);
        runner.run(&model, &start, (POINT.rest() / dt) as u64, |_, state| {
            if before < 0.0 && state.v[1] > 0.0 {
                found.push(state.t - 0.5 * dt);
            }
            before = state.v[1];
            if found.len() == IMPACTS as usize { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        if found.len() < IMPACTS as usize {
            return Err(format!("only {} impacts with a step of {dt:e} s", found.len()).into());
        }
        let error = found.iter().zip(1..).map(|(t, n)| (t - POINT.impact(n)).abs()).fold(0.0, f64::max);
        if k % PER_DECADE == 0 && k / PER_DECADE <= 1 {
            let quantity = format!("{}, e = 0.8, h = {dt:.0e} s: worst of ten impact times, s", runner.name());
            findings.checks.push(Check::worst(quantity, error, 1.1 * worst_times(runner.stepping()) * dt));
        }
        points.push((dt, error));
    }
    Ok(points)
}

/// The bound of the error of ten impact times, in steps.
fn worst_times(stepping: Stepping) -> f64 {
    let e = POINT.restitution;
    let sigmas = if stepping == Stepping::MoreauJean { [-0.5, 0.5] } else { [0.0, 1.0] };
    let most = |f: &dyn Fn(f64) -> f64| sigmas.iter().map(|s| f(*s).abs()).fold(0.0, f64::max);
    let late = most(&|s| (1.0 + e) * (1.0 - 2.0 * s) / (2.0 * e));
    let fast = most(&|s| (1.0 - e) * (2.0 * s * (1.0 + e) - 1.0) / (2.0 * e));
    // The step's middle is ½ − σ steps after the impact; the speed's error is in units of gh.
    let (mut time, mut speed) = (most(&|s| 0.5 - s), 0.0);
    for _ in 1..IMPACTS {
        speed = e * speed + fast;
        time += late + 2.0 * speed;
    }
    time
}

/// When the bounces end, and what is left of them.
fn settle(runner: &mut Runner, dt: f64, findings: &mut Findings) -> Result<()> {
    let (model, start) = dropped(POINT.restitution, POINT.height, dt)?;
    let (mut last, mut before, mut fastest) = (0.0, 0.0, 0.0_f64);
    let until = POINT.rest() + 1.0;
    let end = runner.run(&model, &start, (until / dt).round() as u64, |_, state| {
        let v = state.v[1];
        // What is above gravity's work in two steps is a bounce, not a hop at rest.
        if before < 0.0 && v > 2.0 * GRAVITY * dt {
            last = state.t;
        }
        before = v;
        if state.t > until - 0.5 {
            fastest = fastest.max(state.v.iter().fold(0.0, |most, v| most.max(v.abs())));
        }
        ControlFlow::Continue(())
    })?;
    let what = |what: &str| format!("{}, e = 0.8, h = {dt:e} s: {what}", runner.name());
    findings.checks.push(Check::absolute(
        what("last bounce faster than 2gh, s"),
        POINT.rest(),
        last,
        settled_within(runner.stepping(), dt),
    ));
    let rest = what("largest velocity in the last half second, m/s");
    findings.checks.push(match runner.stepping() {
        Stepping::MoreauJean => Check::worst(rest, fastest, GRAVITY * dt),
        _ => Check::worst(rest, fastest, 1e-15),
    });
    // It rests as deep as its last step went.
    let depth = end.q[1] - 0.5 * FLAT_BLOCK.height;
    findings.checks.push(Check::absolute(what("height at the end, m"), 0.0, depth, 2.0 * GRAVITY * dt * dt));
    Ok(())
}

/// How far the last bounce may be from the Zeno time, s: what is left after it, 2v/(g(1 − e)) for v = 2gh, and the lateness of all bounces
/// before.
fn settled_within(stepping: Stepping, dt: f64) -> f64 {
    let e = POINT.restitution;
    let bounces = (2.0 * GRAVITY * dt / (2.0 * GRAVITY * POINT.height).sqrt()).ln() / e.ln();
    dt * (4.0 / (1.0 - e) + bounces * worst_times(stepping) / f64::from(IMPACTS))
}

/// e = 1: height and time of the apex after a thousand bounces.
fn thousand(runner: &mut Runner, dt: f64, findings: &mut Findings) -> Result<()> {
    let (model, start) = dropped(1.0, LOW, dt)?;
    let floor = 0.5 * FLAT_BLOCK.height;
    let flight = 2.0 * (2.0 * LOW / GRAVITY).sqrt();
    let (mut before, mut bounces, mut apex) = (0.0, 0, None);
    runner.run(&model, &start, (1.1 * flight * BOUNCES as f64 / dt) as u64, |_, state| {
        let v = state.v[1];
        if before < 0.0 && v > 0.0 {
            bounces += 1;
        }
        if bounces == BOUNCES && v <= 0.0 {
            apex = Some((state.t + v / GRAVITY, state.q[1] - floor + 0.5 * v * v / GRAVITY));
        }
        before = v;
        if apex.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    let (t, height) = apex.ok_or_else(|| format!("{bounces} bounces only with a step of {dt:e} s"))?;
    let exact = flight * BOUNCES as f64;
    let what = |what: &str| format!("{}, e = 1, h = {dt:e} s: {what}", runner.name());
    let worst = if runner.stepping() == Stepping::MoreauJean { 2.0 } else { 1.0 };
    findings.checks.extend([
        Check::relative(what("apex after 1000 bounces, m, relative"), LOW, height, 1e-6),
        Check::absolute(what("its time, s"), exact, t, 1.01 * worst * BOUNCES as f64 * dt),
        Check::reported(what("its delay, steps per bounce"), (t - exact) / (dt * BOUNCES as f64)),
    ]);
    Ok(())
}
