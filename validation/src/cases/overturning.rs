//! Housner's block under one sine of ground acceleration: the amplitudes from which and up to which it overturns.

use crate::case::{Case, Check, Depth, Findings, Result};
use crate::exact::overturning::{Fate, PulsedBlock, RANGES};
use crate::exact::root::boundary as boundary_between;
use crate::figure::{Axes, Figure, Series};
use crate::scene::{BlockSpec, GRAVITY, Runner, Start, Stepping, block_over};
use nalgebra::Vector2;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::ControlFlow;
use std::sync::Arc;
use teeter_integrator::{Formula, Given, Ground, Motion, PairLaw};

pub(crate) struct Overturning;

/// rad; `docs/theory.md` §9.
const ALPHA: f64 = 0.25;

/// Height of the block, m; its size doesn't matter.
const HEIGHT: f64 = 0.4;

/// No slip: the corner's force leans far over in a strong pulse.
const FRICTION: f64 = 100.0;

/// Relative, of every limit.
const BOUND: f64 = 0.01;

/// The same by the event-driven scheme, whose limits are bracketed to the second, in steps of ω_p h as
/// long as the third.
const SHARP_BOUND: f64 = 1e-6;
const SHARP_BRACKET: f64 = 1e-8;
const LONG_STEP: f64 = 0.05;

/// What holds the corners in the event-driven runs: at ω_p/p = 8 a foot needs |T|/N = 1.19.
const SHARP_FRICTION: f64 = 5.0;

/// ω_p h.
const STEP: f64 = 1e-3;

/// Width of the last bracket, relative: well below the errors of the scheme.
const BRACKET: f64 = 1e-4;

/// The bracket starts so far around a limit, or half way to the next where that is nearer.
const AROUND: f64 = 0.04;

impl Case for Overturning {
    fn name(&self) -> &'static str {
        "overturning"
    }

    fn about(&self) -> &'static str {
        "Housner's block (α = 0.25, μ = 100, e = 0) on ground that accelerates by A sin(ω_p t + ψ), ψ = arcsin(g tan \
         α/A), until the sine ends. The amplitudes at which the outcome changes, by bisection to 1e-4, compared with \
         an integration to rounding of the rocking equation (`docs/theory.md` §9). The block has overturned when |φ| \
         ≥ π/2, or when after the pulse |φ| > α and its energy exceeds that of the saddle or it moves outwards; it \
         stays up when after the pulse |φ| < α and its energy is below. Steps of ω_p h = 1e-3; the change with half \
         the step is reported. event-driven in steps of ω_p h = 0.05 with μ = 5, by bisection to 1e-8, must be \
         accurate to 1e-6, also for limits close to others. Limits with another one within 1 % are only reported: at \
         ω_p/p = 1 overturning after three impacts (1.1066 … 1.1130), and the gap between one impact and none \
         (1.4159 … 1.4175)."
    }

    fn run(&self, depth: Depth) -> Result<Findings> {
        let mut findings = Findings::default();
        let (highest, schemes) = match depth {
            Depth::Full => (8.0, &Stepping::ALL[..]),
            Depth::Short => (3.0, &Stepping::ALL[..1]),
        };
        let mut series = curves(depth)?;
        for &stepping in schemes {
            let mut runner = Runner::new(stepping);
            let (mut points, mut change) = (Vec::new(), 0.0_f64);
            for (limit, room) in limits().filter(|(limit, _)| limit.frequency <= highest) {
                let found = limit.computed(&mut runner, room.min(AROUND), STEP, BRACKET)?;
                let quantity = format!("{}, ω_p/p = {}: {}", runner.name(), limit.frequency, limit.what);
                if room * 2.0 > BOUND {
                    points.extend(found.map(|found| (limit.frequency, found)));
                    let found = found.unwrap_or(f64::NAN);
                    if depth == Depth::Full {
                        let fine = limit
                            .computed(&mut runner, room.min(AROUND), 0.5 * STEP, BRACKET)?
                            .unwrap_or(f64::INFINITY);
                        change = change.max((fine / found - 1.0).abs());
                    }
                    findings.checks.push(Check::relative(quantity + ", relative", limit.exact, found, BOUND));
                } else if let Some(found) = found {
                    points.push((limit.frequency, found));
                    findings.checks.push(Check::reported(format!("{quantity}, exactly {:.4}", limit.exact), found));
                } else {
                    let quantity = format!("{quantity}: not found, exactly");
                    findings.checks.push(Check::reported(quantity, limit.exact));
                }
            }
            if depth == Depth::Full {
                let quantity = format!("{}: largest change of a judged limit with h/2, relative", runner.name());
                findings.checks.push(Check::reported(quantity, change));
            }
            series.push(Series::marks(runner.name(), points));
            findings.checks.extend(runner.account_of_drives());
        }
        let mut runner = Runner::new(Stepping::EventDriven);
        let mut points = Vec::new();
        for (limit, room) in limits().filter(|(limit, _)| limit.frequency <= highest) {
            let around = (0.5 * room).min(AROUND);
            let found = limit.computed(&mut runner, around, LONG_STEP, SHARP_BRACKET)?.unwrap_or(f64::NAN);
            points.push((limit.frequency, found));
            let quantity = format!("{}, ω_p/p = {}: {}, relative", runner.name(), limit.frequency, limit.what);
            findings.checks.push(Check::relative(quantity, limit.exact, found, SHARP_BOUND));
        }
        series.push(Series::marks(runner.name(), points));
        findings.checks.extend(runner.account_of_drives());
        findings.figures.push(Figure {
            file: "overturning.svg",
            title: "Overturning of Housner's block by one sine",
            x: "ω_p / p",
            y: "A / (g tan α)",
            axes: Axes::Linear,
            caption: "Amplitudes at which the outcome changes, α = 0.25: it overturns after one impact between the \
                 two lower curves, without impact above the upper one. Curves by integration of the rocking \
                 equation, marks by the program.",
            series,
        });
        Ok(findings)
    }
}

/// An amplitude, in units of g tan α, at which the fate changes.
struct Limit {
    frequency: f64,
    exact: f64,
    what: String,
}

/// All limits, each with half the relative distance to the nearest other.
fn limits() -> impl Iterator<Item = (Limit, f64)> {
    RANGES.iter().flat_map(|&(frequency, from, to, impacts)| {
        let others = move |limit: f64| {
            let same = RANGES.iter().filter(move |range| range.0 == frequency);
            let ends = same.flat_map(|range| [range.1, range.2]).filter(move |other| *other != limit);
            ends.map(move |other| 0.5 * (other / limit - 1.0).abs()).fold(f64::INFINITY, f64::min)
        };
        let after = match impacts {
            0 => "without impact".to_owned(),
            1 => "after one impact".to_owned(),
            n => format!("after {n} impacts"),
        };
        let sharper = move |limit: f64| {
            let block = PulsedBlock { alpha: ALPHA, frequency };
            block.limit(limit - 2e-4, limit + 2e-4)
        };
        [(from, "from"), (to, "up to")].into_iter().filter(|(limit, _)| limit.is_finite()).map(move |(limit, word)| {
            (Limit { frequency, exact: sharper(limit), what: format!("overturns {after} {word}") }, others(limit))
        })
    })
}

impl Limit {
    /// The same by the program; `None` if the fate is the same at both ends of the bracket.
    fn computed(&self, runner: &mut Runner, around: f64, step: f64, bracket: f64) -> Result<Option<f64>> {
        let (mut low, mut high) = (self.exact * (1.0 - around), self.exact * (1.0 + around));
        let at_low = overturns(runner, self.frequency, low, step)?;
        if overturns(runner, self.frequency, high, step)? == at_low {
            return Ok(None);
        }
        while high - low > bracket * low {
            let middle = 0.5 * (low + high);
            if overturns(runner, self.frequency, middle, step)? == at_low { low = middle } else { high = middle }
        }
        Ok(Some(0.5 * (low + high)))
    }
}

/// Whether the block overturns at amplitude `amplitude` · g tan α and frequency `frequency` · p, with steps of `step`/ω_p.
fn overturns(runner: &mut Runner, frequency: f64, amplitude: f64, step: f64) -> Result<bool> {
    let spec = BlockSpec { width: HEIGHT * ALPHA.tan(), height: HEIGHT, depth: 0.1, density: 1000.0 };
    let p = (1.5 * GRAVITY / spec.width.hypot(spec.height)).sqrt();
    let (omega, psi) = (frequency * p, amplitude.recip().asin());
    let pulse = Arc::new(Formula::one_sine(0.0, omega / TAU, psi)?);
    let shake = Motion::still().with(Given::Acceleration, amplitude * GRAVITY * ALPHA.tan(), pulse);
    let ground = Ground::moving(0.0, [shake, Motion::still(), Motion::still()]);
    let mut q = vec![0.0, 0.5 * HEIGHT, 0.0];
    q.extend(ground.coordinates(0.0));
    let friction = if runner.stepping() == Stepping::EventDriven { SHARP_FRICTION } else { FRICTION };
    let law = PairLaw::new(friction, 0.0);
    let model = block_over(&spec, Vector2::new(0.0, -GRAVITY), law, Box::new(ground))?;
    let start = Start { q, v: vec![0.0; 6], dt: step / omega, theta: 0.5 };
    let end = (2.0 * PI - psi) / omega;
    let mut fate = None;
    // Long after the pulse; near a limit it dwells at the saddle for some 1/p times the logarithm of the distance.
    runner.run(&model, &start, ((end + 100.0 / p) * omega / step) as u64, |_, state| {
        let (phi, rate) = (state.q[2], state.v[2]);
        let (side, angle) = (phi.signum(), phi.abs());
        // Counted from the saddle.
        let energy = 0.5 * rate * rate - 2.0 * (p * (0.5 * (ALPHA - angle)).sin()).powi(2);
        fate = if angle >= FRAC_PI_2 || state.t >= end && angle > ALPHA && (energy <= 0.0 || side * rate > 0.0) {
            Some(true)
        } else if state.t >= end && angle < ALPHA && energy < 0.0 {
            Some(false)
        } else {
            None
        };
        if fate.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    fate.ok_or_else(|| "neither overturned nor standing long after the pulse".into())
}

/// The limits of one impact and of none as curves over ω_p/p: each tracked from the one before.
fn curves(depth: Depth) -> Result<Vec<Series>> {
    let per_unit = if depth == Depth::Full { 8 } else { 2 };
    let one = Fate::Overturns { impacts: 1 };
    let none = Fate::Overturns { impacts: 0 };
    let (mut from, mut to, mut free) = (Vec::new(), Vec::new(), Vec::new());
    for k in per_unit..=8 * per_unit {
        let frequency = f64::from(k) / f64::from(per_unit);
        let block = PulsedBlock { alpha: ALPHA, frequency };
        // A grid fine enough for the narrowest range of one impact, near ω_p/p = 8.
        let grid: Vec<f64> = (0..400).map(|i| 1.005 * 1.0075_f64.powi(i)).collect();
        let fates: Vec<Fate> = grid.iter().map(|amplitude| block.fate(*amplitude)).collect();
        let last = |fate: Fate| fates.iter().rposition(|other| *other == fate);
        let Some(lowest) = fates.iter().position(|fate| *fate == none) else { continue };
        let boundary = |i: usize, of: Fate| {
            // Where `of` begins or ends between i − 1 and i.
            boundary_between(grid[i - 1], grid[i], |a| (block.fate(a) == of) == (fates[i] == of))
        };
        free.push((frequency, boundary(lowest, none)));
        if let (Some(first), Some(end)) = (fates.iter().position(|fate| *fate == one), last(one)) {
            from.push((frequency, boundary(first, one)));
            to.push((frequency, boundary(end + 1, one)));
        }
    }
    Ok(vec![
        Series::curve("no impact: from here", free),
        Series::curve("one impact: up to here", to),
        Series::curve("one impact: from here", from),
    ])
}
