//! The values of keys of a scene with which its motion fits a measured one best.

mod beside;
mod confidence;
mod keys;
mod least_squares;
mod matrix;
mod objective;
mod write;

pub use confidence::{Estimate, TradeOff};
pub use keys::FitKey;
pub use write::{FILES, csv, figures, json, page, sentences};

use crate::compare::{AlignmentSettings, CompareSettings, Comparison, ShiftFit, SideFit, alternatives_to, set_zero};
use crate::divergence::finer_step;
use crate::measured::{Measured, Sign};
use crate::sweep::sample::{Method, Sampler};
use crate::{Divergence, Failure, FinerStep, Setting, StudyScene, divergence, runner};
use least_squares::{Point, levenberg_marquardt, nelder_mead};
use objective::{Objective, Trial};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;

/// How a fit is made.
#[derive(Clone, Debug, PartialEq)]
pub struct FitSettings {
    /// What is known of time shift and side; the rest is fitted.
    pub alignment: AlignmentSettings,
    /// What the measured angle shows when the block stands upright, rad; none: it is fitted.
    pub offset: Option<f64>,
    /// Rows of the window of the final comparison.
    pub window: usize,
    /// Number of values tried all over the ranges before the best are improved; none: by the number
    /// of keys.
    pub samples: Option<usize>,
    /// Seed of these values.
    pub seed: u64,
    /// Threads.
    pub threads: usize,
}

/// Values that were tried.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Evaluation {
    /// `samples`, `improvement`, `simplex`, or `beside` the fitted values.
    pub stage: &'static str,
    /// The values in the keys' units.
    pub values: Vec<f64>,
    /// Mean square of the differences over the noise of the samples, or, of the samples over the
    /// ranges, their [mismatch](crate::compare::Alignment::mismatch); infinite if the run failed.
    pub cost: f64,
    /// Up to when the motions were compared, s; `None` for the samples over the ranges.
    pub until: Option<f64>,
}

/// A fit.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Fit {
    /// The keys.
    pub keys: Vec<FitKey>,
    /// Their fitted values, in their units.
    pub values: Vec<f64>,
    /// The setting with them.
    pub setting: Setting,
    /// Confidence of keys, time shift and zero of the angle.
    pub estimates: Vec<Estimate>,
    /// Pairs that trade off.
    pub trade_offs: Vec<TradeOff>,
    /// Correlations of all estimates.
    pub correlation: Vec<Vec<f64>>,
    /// Mean square of the differences over the noise of the samples.
    pub cost: f64,
    /// Correlation of one residual with the next.
    pub residual_correlation: f64,
    /// How improbable the residuals are for noise, in standard deviations of a normal distribution.
    pub misfit: f64,
    /// Up to when the motions were compared for the fit, s.
    pub until: f64,
    /// Number of measured rows that were compared.
    pub rows: usize,
    /// Number of residuals.
    pub residuals: usize,
    /// The different values at which starts ended, best first: with their cost.
    pub restarts: Vec<(Vec<f64>, f64)>,
    /// All that was tried.
    pub evaluations: Vec<Evaluation>,
    /// Up to when the fitted scene is predictable, s. It may be beyond `until`, where values that were fitted to more rows are predictable up to
    /// there only.
    pub horizon: f64,
    /// A shorter step with which more rows would count; none where they all do, or a shorter step doesn't help.
    pub finer_step: Option<FinerStep>,
    /// The measured and the fitted motion.
    pub comparison: Comparison,
    /// Whether the side from which the motion was seen was given: otherwise it was found, or assumed, as
    /// [`Alignment`](crate::compare::Alignment) of the comparison says.
    pub sign_given: bool,
    /// The measured motion and that of the scene before the fit, if it runs.
    pub before: Option<Comparison>,
}

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// No trial values gave a motion.
    #[error("no values in the ranges give a motion that can be compared: {0}")]
    NoMotion(String),
    /// The motions can't be compared.
    #[error(transparent)]
    Compare(#[from] crate::compare::CompareError),
    /// A measured quantity that never changes.
    #[error("{0} is the same in all rows of the table, so that its noise is unknown: leave the column out")]
    Constant(&'static str),
    /// Too few rows, or no trial values that give a motion.
    #[error("up to t = {0:.4} s no values in the ranges give a motion with 8 measured numbers or more to compare")]
    NothingToCompare(f64),
    /// No runs beside the fitted values.
    #[error(
        "the best values are {0}, but runs beside them fail, so that they have no confidence: choose narrower ranges"
    )]
    NoConfidence(String),
    /// Ended by the user.
    #[error("interrupted")]
    Interrupted,
}

/// Reports progress: phase, how many of how many are done.
pub type ReportFit<'a> = dyn FnMut(&str, usize, usize) + Send + 'a;

/// A sum of squares so many of its standard deviations above that of noise isn't noise.
const IMPROBABLE: f64 = 3.0;
/// How many times as many values are tried at first where a fit leaves more than noise.
const MORE: usize = 4;
/// Samples that are improved, and besides the scene's own values.
const STARTS: usize = 4;
/// How much of the motion is fitted one after the other, with the distance of differences, as a share
/// of the range.
const EXTENSIONS: [(f64, f64); 4] = [(0.3, 4e-3), (0.55, 2e-3), (0.8, 1e-3), (1.0, 5e-4)];
/// Size of the simplex in such distances.
const SIMPLEX: f64 = 5.0;
/// Most rounds, each up to the horizon of the values fitted in the one before.
const ROUNDS: usize = 4;
/// How often better values beside the fitted ones take their place.
const MOVES: usize = 6;
/// A horizon that moves by less than this share cuts nothing off.
pub(super) const SAME_HORIZON: f64 = 0.02;

/// What is fitted to what.
#[derive(Clone, Copy)]
struct Inputs<'a> {
    source: &'a StudyScene,
    resolved: &'a Resolved,
    block: usize,
    measured: &'a Measured,
    keys: &'a [FitKey],
    cancel: &'a Arc<AtomicBool>,
}

impl Fit {
    /// Fits `keys` of a scene to the measured motion of its block with the number `block`.
    ///
    /// Values all over the ranges (a Latin hypercube) are tried first, as a rocking motion has many
    /// local minima: a wrong number of impacts. The best of them, and the scene's own, are improved
    /// by Levenberg and Marquardt's method, and the best result of that by a simplex, which needs no
    /// derivatives. Rows beyond the horizon of the best values don't count. Where what is left is more than noise, and the number of values
    /// to try first isn't given, all is done once more with four times as many: the least minimum may be narrow.
    ///
    /// # Errors
    /// If nothing can be compared, or the user interrupts.
    pub fn of(
        source: &StudyScene,
        resolved: &Resolved,
        block: usize,
        measured: &Measured,
        keys: &[FitKey],
        settings: &FitSettings,
        cancel: &Arc<AtomicBool>,
        report: &mut ReportFit<'_>,
    ) -> Result<Self, FitError> {
        let inputs = Inputs { source, resolved, block, measured, keys, cancel };
        let first = Self::once(inputs, settings, report)?;
        if settings.samples.is_some() || !first.is_misfit() {
            return Ok(first);
        }
        let seed = settings.seed.wrapping_add(1);
        let more = FitSettings { samples: Some(MORE * samples(keys)), seed, ..settings.clone() };
        // Interrupted, or without a better end, the first fit stands.
        let Ok(second) = Self::once(inputs, &more, report) else { return Ok(first) };
        // The right values may have a shorter horizon than wrong ones; of two that are wrong, the one that says less of the motion isn't better.
        let comparable = second.until >= (1.0 - SAME_HORIZON) * first.until || !second.is_misfit();
        let better = comparable && second.cost < first.cost;
        let (mut better, other) = if better { (second, first) } else { (first, second) };
        better.evaluations.extend(other.evaluations);
        Ok(better)
    }

    /// Whether more is left than noise explains.
    #[must_use]
    pub fn is_misfit(&self) -> bool {
        self.misfit > IMPROBABLE
    }

    /// A fit from one set of values to try first.
    fn once(inputs: Inputs<'_>, settings: &FitSettings, report: &mut ReportFit<'_>) -> Result<Self, FitError> {
        let Inputs { source, resolved, measured, keys, cancel, .. } = inputs;
        let mut evaluations = Vec::new();
        let own = own_values(resolved, keys);
        let (mut objective, side_found, starts) = search(inputs, settings, own.as_deref(), &mut evaluations, report)?;
        // The rows that count end at the horizon of the best values so far, and then at that of the
        // fitted ones.
        let mut until = objective.until;
        let mut best: Vec<Trial> = starts;
        let mut horizon = until;
        let mut predictable: Option<Divergence> = None;
        let (mut lengthened, mut turned) = (false, false);
        for round in 0..ROUNDS {
            let setting = objective.setting(&best[0].at);
            let scene = source.load(&setting).map_err(|found| FitError::NoMotion(Failure::from(found).to_string()))?;
            predictable = match divergence(&scene.scene, cancel) {
                Err(Failure::Interrupted) => return Err(FitError::Interrupted),
                found => found.ok(),
            };
            horizon = predictable.map_or(until, |found| found.horizon());
            let cut = horizon.min(resolved.scene.time.end);
            // The first values may be predictable for less time than the fitted ones: what these can be
            // compared with counts, too. Rows that come, go and would come again stay away.
            let (same, longer) = ((cut - until).abs() <= SAME_HORIZON * until, cut > until);
            if round > 0 && (same || (longer && turned)) {
                break;
            }
            turned |= lengthened && !longer;
            lengthened |= round > 0 && longer;
            until = cut;
            // From the beginning of the motion to all of it: after many impacts the difference is
            // small only very near the right values, and the way there leads through the beginning.
            for (share, reach) in EXTENSIONS {
                objective.until = share * until;
                let polish = share == 1.0;
                match improve(&objective, &best, reach, polish, settings.threads, &mut evaluations, report) {
                    Ok(found) => best = distinct(found, reach),
                    // So few rows that the beginning has hardly any.
                    Err(FitError::NothingToCompare(_)) if !polish => {}
                    Err(error) => return Err(error),
                }
            }
        }
        let examined = best[0].at.clone();
        let found = confidence_of_best(&objective, &mut best, settings.threads, &mut evaluations, report)?;
        if best[0].at != examined
            && let Ok(scene) = source.load(&objective.setting(&best[0].at))
            && let Ok(divergence) = divergence(&scene.scene, cancel)
        {
            horizon = divergence.horizon();
            predictable = Some(divergence);
        }
        let last = objective.motion.t.last().map_or(f64::INFINITY, |last| last + best[0].shift);
        let finer_step = predictable.and_then(|own| {
            let scene = source.scene(&objective.setting(&best[0].at)).ok()?;
            finer_step(&scene, &own, last.min(own.end), cancel).ok().flatten()
        });
        if objective.cancel.load(std::sync::atomic::Ordering::Relaxed) {
            return Err(FitError::Interrupted);
        }
        let fitted = &best[0];
        let (fitted_until, fitted_rows) = (objective.until, objective.rows(&fitted.trace, fitted.shift).len());
        let setting = objective.setting(&fitted.at);
        let Some(found) = found else {
            let values =
                keys.iter().zip(&fitted.at).map(|(key, share)| format!("{} = {}", key.key(), key.text(key.at(*share))));
            return Err(FitError::NoConfidence(values.collect::<Vec<_>>().join(", ")));
        };
        let compared = |trace, shift, offset| {
            let alignment = AlignmentSettings { shift: Some(shift), sign: Some(objective.sign) };
            // The zero of the angle was taken in the turned motion.
            let offset = objective.sign.factor() * offset;
            let compare = CompareSettings { alignment, window: settings.window, offset, horizon: Some(horizon) };
            Comparison::of(measured, trace, compare).map(|mut comparison| {
                // For the comparison they are given; here they were fitted unless the user gave them.
                comparison.alignment.shift_found = settings.alignment.shift.is_none();
                comparison.alignment.sign_found = side_found;
                comparison
            })
        };
        let whole = Objective {
            until: resolved.scene.time.end,
            motion: objective.motion.clone(),
            noise: Vec::new(),
            ..objective
        };
        let trace = whole.trace(&setting).map_err(|failure| FitError::NoMotion(failure.to_string()))?;
        let offset = objective.sign.factor() * fitted.offset;
        let chosen = (fitted.shift, objective.sign);
        let alternatives = alternatives_to(chosen, measured, &trace, fitted_until, offset, settings.alignment);
        let mut comparison = compared(trace, fitted.shift, fitted.offset)?;
        comparison.alternatives = alternatives;
        let before = own.as_ref().and_then(|_| whole.trace(&Setting::none()).ok());
        let before = before.and_then(|trace| compared(trace, fitted.shift, fitted.offset).ok());
        let value = |trial: &Trial| keys.iter().zip(&trial.at).map(|(key, share)| key.at(*share)).collect::<Vec<f64>>();
        Ok(Self {
            keys: keys.to_vec(),
            values: value(fitted),
            setting,
            estimates: found.estimates,
            trade_offs: found.trade_offs,
            correlation: found.correlation,
            cost: fitted.cost,
            residual_correlation: found.residual_correlation,
            misfit: found.misfit,
            until: fitted_until,
            rows: fitted_rows,
            residuals: fitted.residuals.len(),
            restarts: best.iter().map(|trial| (value(trial), trial.cost)).collect(),
            evaluations,
            horizon,
            finer_step,
            comparison,
            sign_given: settings.alignment.sign.is_some(),
            before,
        })
    }
}

/// The confidence of the best trial. Where values beside it are better, these are improved and take its place: a rough function has many
/// minima, and a deeper one may be near.
fn confidence_of_best(
    objective: &Objective<'_>,
    best: &mut Vec<Trial>,
    threads: usize,
    evaluations: &mut Vec<Evaluation>,
    report: &mut ReportFit<'_>,
) -> Result<Option<confidence::Confidence>, FitError> {
    let reach = EXTENSIONS[EXTENSIONS.len() - 1].1;
    let mut moves = 0;
    loop {
        let found = confidence::of(objective, &best[0], threads, evaluations);
        let better = found.as_ref().and_then(|found| found.better.as_ref()).filter(|_| moves < MOVES);
        let start = better.and_then(|at| objective.trial(at, best[0].shift).ok());
        let Some(start) = start else {
            return Ok(found.map(|found| found.with_half_step(objective, &best[0], reach)));
        };
        moves += 1;
        let mut all = improve(objective, &[start], reach, true, threads, evaluations, report)?;
        all.append(best);
        all.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        *best = distinct(all, reach);
    }
}

/// How many values are tried at first.
fn samples(keys: &[FitKey]) -> usize {
    16 * (keys.len() + 1)
}

/// The scene's own values as shares of the ranges, if all are numbers in them.
fn own_values(resolved: &Resolved, keys: &[FitKey]) -> Option<Vec<f64>> {
    let one = |key: &FitKey| {
        let si = resolved.document.quantity(key.key()).or_else(|| resolved.document.number(key.key()))?;
        // The value of one unit in SI units.
        let unit = if key.unit().is_empty() { 1.0 } else { si_of(key) };
        key.share(si / unit)
    };
    keys.iter().map(one).collect()
}

/// One unit of a key in SI units; NaN if it isn't a quantity.
fn si_of(key: &FitKey) -> f64 {
    use teeter_scenario::keys::{Kind, PathTarget};
    match teeter_scenario::keys::find(key.key()) {
        Some(PathTarget::Key(_, found)) => match found.kind {
            Kind::Quantity(dimension, _) => {
                teeter_scenario::quantity::parse(&key.text(1.0), dimension).unwrap_or(f64::NAN)
            }
            _ => f64::NAN,
        },
        _ => f64::NAN,
    }
}

/// Tries values all over the ranges, seen from both sides if that isn't given; returns the best,
/// best first, and whether the side was found.
fn search<'a>(
    inputs: Inputs<'a>,
    settings: &FitSettings,
    own: Option<&[f64]>,
    evaluations: &mut Vec<Evaluation>,
    report: &mut ReportFit<'_>,
) -> Result<(Objective<'a>, bool, Vec<Trial>), FitError> {
    let Inputs { source, resolved, block, measured, keys, cancel } = inputs;
    let start = initial_angle(resolved, block);
    let objective = |sign: Sign| {
        let mut motion = measured.motion(sign);
        set_zero(&mut motion, 0.0, start);
        let noise = Objective::noise_of(&motion);
        let offset = settings.offset.map(|offset| sign.factor() * offset);
        let until = resolved.scene.time.end;
        Objective {
            source,
            keys,
            sign,
            block,
            motion,
            noise,
            shift: settings.alignment.shift,
            offset,
            until,
            step: None,
            cancel,
        }
    };
    let signs = settings.alignment.sign.map_or(vec![Sign::AsIs, Sign::Reversed], |sign| vec![sign]);
    let objectives: Vec<Objective<'_>> = signs.into_iter().map(objective).collect();
    let still = |values: &[f64]| {
        let mut seen = values.iter().filter(|value| value.is_finite());
        let first = seen.next();
        seen.all(|value| Some(value) == first)
    };
    if let Some((channel, _)) = objectives[0].motion.channels.iter().find(|(_, values)| still(values)) {
        return Err(FitError::Constant(channel.title()));
    }
    let count = settings.samples.unwrap_or(samples(keys)).clamp(1, 10_000);
    let sampler =
        Sampler::new(settings.seed, Method::LatinHypercube, keys.len(), u32::try_from(count).unwrap_or(u32::MAX));
    let mut places: Vec<Vec<f64>> = own.into_iter().map(<[f64]>::to_vec).collect();
    places.extend((0..count as u64).map(|sample| (0..keys.len()).map(|key| sampler.share(key, sample)).collect()));
    let total = places.len();
    let mut done = 0;
    let work = |at: &Vec<f64>| {
        // One run serves both sides.
        let trace = objectives[0].trace(&objectives[0].setting(at))?;
        let of_side = |of: &Objective<'_>| SideFit::of(&of.motion, &trace, of.until, settings.alignment.shift);
        Ok::<Vec<SideFit>, Failure>(objectives.iter().map(of_side).collect())
    };
    // A given side needs no quantity that tells it.
    let fit = |of: &SideFit| if settings.alignment.sign.is_some() { of.fit } else { of.whole() };
    let mismatch = |of: &SideFit| fit(of).mismatch;
    let results = runner::in_order(&places, settings.threads, cancel, work, |_| {
        done += 1;
        report("values all over the ranges", done, total);
    });
    // The side, how it fits, whether anything tells it, and the number of the values.
    let mut ranked: Vec<(usize, ShiftFit, bool, usize)> = Vec::new();
    let mut why = "no run came to its end".to_owned();
    for (number, result) in results.into_iter().enumerate() {
        let cost = match result {
            None | Some(Err(Failure::Interrupted)) => return Err(FitError::Interrupted),
            Some(Err(failure)) => {
                why = failure.to_string();
                f64::INFINITY
            }
            Some(Ok(sides)) => {
                ranked.extend(sides.iter().enumerate().map(|(side, of)| (side, fit(of), of.tells_side, number)));
                sides.iter().map(mismatch).fold(f64::INFINITY, f64::min)
            }
        };
        let values = keys.iter().zip(&places[number]).map(|(key, share)| key.at(*share)).collect();
        evaluations.push(Evaluation { stage: "samples", values, cost, until: None });
    }
    ranked.retain(|(_, fit, ..)| fit.mismatch.is_finite());
    ranked.sort_by(|a, b| a.1.mismatch.total_cmp(&b.1.mismatch));
    let Some(&(first, best, ..)) = ranked.first() else { return Err(FitError::NoMotion(why)) };
    // The other side may fit as well, with more rows.
    let other = ranked.iter().find(|(side, ..)| *side != first).filter(|(_, other, ..)| other.is_better_than(&best));
    let Some(&(side, _, tells_side, _)) = other.or(ranked.first()) else { return Err(FitError::NoMotion(why)) };
    let chosen = objectives.into_iter().nth(side).ok_or(FitError::Interrupted)?;
    let near = ranked.iter().filter(|(other, ..)| *other == side).map(|(.., number)| *number);
    let is_own = |number: usize| own.is_some() && number == 0;
    let starts: Vec<Trial> =
        started_from(near, is_own).filter_map(|n| chosen.trial_anywhere(&places[n]).ok()).collect();
    let side_found = settings.alignment.sign.is_none() && tells_side;
    if starts.is_empty() { Err(FitError::NoMotion(why)) } else { Ok((chosen, side_found, starts)) }
}

/// The first of the ranked numbers, and the scene's own: far off at the end of the motion they may be ranked behind
/// values with another number of impacts, and are near the right ones all the same.
fn started_from(ranked: impl Iterator<Item = usize>, is_own: impl Fn(usize) -> bool) -> impl Iterator<Item = usize> {
    ranked.enumerate().filter(move |(rank, number)| *rank < STARTS || is_own(*number)).map(|(_, number)| number)
}

/// The angle at which the block starts, rad, from which angles of markers without places are
/// measured.
fn initial_angle(resolved: &Resolved, block: usize) -> f64 {
    Simulation::new(&resolved.scene).ok().map_or(0.0, |simulation| {
        simulation.layout.blocks.get(block).map_or(0.0, |place| simulation.state.q[place.range.start + 2])
    })
}

/// The trials, best first, without those that ended where a better one did.
fn distinct(trials: Vec<Trial>, reach: f64) -> Vec<Trial> {
    let mut kept: Vec<Trial> = Vec::new();
    for trial in trials {
        let same = |other: &Trial| other.at.iter().zip(&trial.at).all(|(a, b)| (a - b).abs() <= reach);
        if !kept.iter().any(same) {
            kept.push(trial);
        }
    }
    kept.truncate(STARTS + 1);
    kept
}

type Start = Point<(f64, Option<Trial>)>;

/// Improves the starts; returns the results, best first.
fn improve(
    objective: &Objective<'_>,
    starts: &[Trial],
    reach: f64,
    polish: bool,
    threads: usize,
    evaluations: &mut Vec<Evaluation>,
    report: &mut ReportFit<'_>,
) -> Result<Vec<Trial>, FitError> {
    let point = |trial: Trial| {
        let residuals = trial.residuals.clone();
        Point { at: trial.at.clone(), residuals, cost: trial.cost, kept: (trial.shift, Some(trial)) }
    };
    let tried = std::sync::Mutex::new(Vec::new());
    let until = Some(objective.until);
    let evaluate = |stage: &'static str| {
        let tried = &tried;
        move |at: &[f64], kept: &(f64, Option<Trial>)| -> Option<Start> {
            let trial = objective.trial(at, kept.0).ok();
            let values = objective.keys.iter().zip(at).map(|(key, share)| key.at(*share)).collect();
            let cost = trial.as_ref().map_or(f64::INFINITY, |trial| trial.cost);
            tried.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(Evaluation {
                stage,
                values,
                cost,
                until,
            });
            trial.filter(|trial| trial.cost.is_finite()).map(point)
        }
    };
    let mut done = 0;
    let work = |start: &Trial| {
        // At the rows up to the horizon the cost is another one.
        let start = objective.trial(&start.at, start.shift).ok()?;
        let found = levenberg_marquardt(point(start), reach, &mut evaluate("improvement"));
        found.kept.1
    };
    let total = starts.len() + 1;
    let results = runner::in_order(starts, threads, objective.cancel, work, |_| {
        done += 1;
        report("improved starts", done, total);
    });
    let mut best: Vec<Trial> = results.into_iter().flatten().flatten().filter(|trial| trial.cost.is_finite()).collect();
    best.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let Some(first) = best.first().cloned().filter(|_| polish) else {
        evaluations.extend(tried.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner));
        return if objective.cancel.load(std::sync::atomic::Ordering::Relaxed) {
            Err(FitError::Interrupted)
        } else if best.is_empty() {
            Err(FitError::NothingToCompare(objective.until))
        } else {
            Ok(best)
        };
    };
    // A rough function may stop a method that needs derivatives.
    let dimensions = objective.keys.len();
    let simplex = nelder_mead(point(first), SIMPLEX * reach, 30 * dimensions, &mut evaluate("simplex"));
    let last = levenberg_marquardt(simplex, 0.5 * reach, &mut evaluate("improvement"));
    report("improved starts", total, total);
    best.extend(last.kept.1);
    best.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    evaluations.extend(tried.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner));
    if objective.cancel.load(std::sync::atomic::Ordering::Relaxed) { Err(FitError::Interrupted) } else { Ok(best) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scenes_own_values_are_always_improved() {
        let started = |own: usize| started_from([7, 3, 9, 1, 5, 0, 4].into_iter(), move |number| number == own);
        assert_eq!(started(0).collect::<Vec<_>>(), [7, 3, 9, 1, 0]);
        assert_eq!(started(3).collect::<Vec<_>>(), [7, 3, 9, 1]);
    }
}
