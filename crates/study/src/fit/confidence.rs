//! How well the fitted values are known, and which of them trade off.

use super::objective::{Objective, Trial};
use super::{Evaluation, matrix};
use crate::measured::Channel;
use crate::runner;

/// The confidence in a fitted value.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// The path of the key, or `time shift`, `zero of the angle`.
    pub name: String,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// The value.
    pub value: f64,
    /// Its standard error; infinite if the motion doesn't depend on it.
    pub standard_error: f64,
    /// Whether it is at a bound of its range.
    pub at_bound: bool,
    /// The standard error as a share of its range; `None` for what isn't a key.
    pub share_of_range: Option<f64>,
    /// The least and the largest value that were found to fit as well, if they go beyond what the standard
    /// error says; `None` for what isn't a key.
    pub as_good: Option<(f64, f64)>,
    /// The 95 % interval by the standard error, for a key on the scale of its range: of a logarithmic one it is positive.
    interval: [f64; 2],
}

impl Estimate {
    /// The 95 % interval: by the standard error, and up to the values that fit as well.
    #[must_use]
    pub fn interval(&self) -> (f64, f64) {
        let [low, high] = self.interval;
        self.as_good.map_or((low, high), |as_good| (low.min(as_good.0), high.max(as_good.1)))
    }
}

/// Two estimates of which a change of one makes up for a change of the other.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TradeOff {
    /// Their numbers.
    pub pair: [usize; 2],
    /// Their correlation.
    pub correlation: f64,
}

/// Two-sided 95 % quantile of the normal distribution.
const NORMAL_95: f64 = 1.959_963_985;
/// Correlations from here on are told.
const TRADES: f64 = 0.9;
/// 95 % quantile of χ² with one degree of freedom: values whose sum of squares over the variance is by no more
/// above the least are in the interval of the profile likelihood (Venzon and Moolgavkar 1988, doi 10.2307/2347496).
const CHI_SQUARED_95: f64 = NORMAL_95 * NORMAL_95;
/// Values beside the fitted one are looked at from this share of the range on, each `FARTHER` times as far away.
const NEAREST: f64 = 2e-3;
const FARTHER: f64 = 1.3;
/// Values beside the fitted ones are better where their sum of squares is below this part of the fitted one's.
const BETTER: f64 = 0.99;
/// How often the distance between values that still fit and the next is halved.
const HALVINGS: usize = 4;
/// An interval by the standard error that is passed by less than this factor is confirmed by what is beside it.
const CONFIRMED: f64 = 1.3;
/// Distance of the differences at first, as a share of the range.
const REACH: f64 = 4e-3;

/// Confidence of all estimates.
pub(super) struct Confidence {
    pub(super) estimates: Vec<Estimate>,
    pub(super) correlation: Vec<Vec<f64>>,
    pub(super) trade_offs: Vec<TradeOff>,
    pub(super) residual_correlation: f64,
    /// Values beside the fitted ones that fit better than these.
    pub(super) better: Option<Vec<f64>>,
}

/// From the covariance σ²(JᵀJ)⁻¹ at the fitted values, σ² being the mean square that is left. Where
/// one residual resembles the next, there is less in them than their number: the covariance is
/// multiplied by (1 + ρ)/(1 − ρ).
pub(super) fn of(
    objective: &Objective<'_>,
    fitted: &Trial,
    threads: usize,
    evaluations: &mut Vec<Evaluation>,
) -> Option<Confidence> {
    let keys = objective.keys;
    let near = fitted.shift;
    let of_channel = objective.channel_of_residuals(&fitted.trace, near);
    let run = |at: &[f64]| {
        let trace = objective.trace(&objective.setting(at)).ok()?;
        let values = objective.fixed(&trace, fitted.shift, near);
        (values.len() == of_channel.len()).then_some(values)
    };
    let difference = |k: usize, reach: f64| -> Option<Vec<f64>> {
        let ends = [(fitted.at[k] - reach).max(0.0), (fitted.at[k] + reach).min(1.0)];
        let [a, b] = ends.map(|end| {
            let mut at = fitted.at.clone();
            at[k] = end;
            run(&at)
        });
        let width = ends[1] - ends[0];
        Some(b?.iter().zip(&a?).map(|(b, a)| (b - a) / width).collect())
    };
    let mut columns: Vec<Vec<f64>> = (0..keys.len()).map(|k| difference(k, REACH)).collect::<Option<_>>()?;
    let mut names: Vec<(String, String, f64, f64)> = keys
        .iter()
        .zip(&fitted.at)
        .map(|(key, share)| (key.key().to_owned(), key.unit().to_owned(), key.at(*share), key.slope(*share)))
        .collect();
    if objective.shift.is_none() {
        let step = 0.1 * objective.motion.interval();
        let [a, b] = [-step, step].map(|by| objective.fixed(&fitted.trace, fitted.shift + by, near));
        columns.push(b.iter().zip(&a).map(|(b, a)| (b - a) / (2.0 * step)).collect());
        names.push(("time shift".to_owned(), "s".to_owned(), fitted.shift, 1.0));
    }
    // The zeros of angle and positions.
    for channel in [Channel::Phi, Channel::X, Channel::Y] {
        let is_free =
            objective.motion.values(channel).is_some() && !(channel == Channel::Phi && objective.offset.is_some());
        if !is_free {
            continue;
        }
        columns
            .push(of_channel.iter().map(|(other, noise)| if *other == channel { -1.0 / noise } else { 0.0 }).collect());
        let (name, unit, value) = match channel {
            Channel::Phi => ("zero of the angle", "rad", objective.sign.factor() * fitted.offset),
            Channel::X => ("origin of x", "m", f64::NAN),
            _ => ("origin of y", "m", f64::NAN),
        };
        names.push((name.to_owned(), unit.to_owned(), value, 1.0));
    }
    let rho = lag_one(&fitted.residuals);
    let fewer = if rho > 0.0 { (1.0 + rho) / (1.0 - rho).max(1e-3) } else { 1.0 };
    let n = fitted.residuals.len() as f64;
    let freedom = (n - columns.len() as f64).max(1.0);
    let variance = fitted.cost * n / freedom * fewer;
    let inverse = |columns: &[Vec<f64>]| {
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let normal: Vec<Vec<f64>> = columns.iter().map(|a| columns.iter().map(|b| product(a, b)).collect()).collect();
        matrix::inverse(&normal)
    };
    // Once more with differences over about a standard error: over a shorter distance they would
    // show the steps of the function, over a longer one its curvature.
    if let Some(first) = inverse(&columns) {
        for k in 0..keys.len() {
            let reach = (variance * first[k][k]).sqrt().clamp(2e-4, 5e-2);
            columns[k] = difference(k, reach)?;
        }
    }
    let count = columns.len();
    let (covariance, is_known) = match inverse(&columns) {
        Some(inverse) => (inverse, true),
        None => (vec![vec![0.0; count]; count], false),
    };
    let error = |k: usize| if is_known { (variance * covariance[k][k]).sqrt() } else { f64::INFINITY };
    let correlation: Vec<Vec<f64>> = (0..count)
        .map(|i| {
            let one = |j: usize| match is_known {
                true => covariance[i][j] / (covariance[i][i] * covariance[j][j]).sqrt(),
                false => f64::NAN,
            };
            (0..count).map(one).collect()
        })
        .collect();
    let trade_offs = (0..count)
        .flat_map(|i| (0..i).map(move |j| [j, i]))
        .filter(|[j, i]| *j < keys.len() && correlation[*i][*j].abs() >= TRADES)
        .map(|pair| TradeOff { pair, correlation: correlation[pair[1]][pair[0]] })
        .collect();
    let way = |k: usize| -> Vec<f64> {
        let along = |j: usize| if is_known { covariance[j][k] / covariance[k][k] } else { f64::from(u8::from(j == k)) };
        (0..keys.len()).map(along).collect()
    };
    let ways: Vec<Vec<f64>> = (0..keys.len()).map(way).collect();
    let errors: Vec<f64> = (0..keys.len()).map(error).collect();
    let Beside { as_good, better } = look_beside(objective, fitted, &ways, &errors, variance, threads, evaluations);
    let estimates = names
        .into_iter()
        .enumerate()
        .map(|(k, (name, unit, value, slope))| Estimate {
            name,
            unit,
            value,
            standard_error: slope * error(k),
            at_bound: k < keys.len() && (fitted.at[k] <= 1e-6 || fitted.at[k] >= 1.0 - 1e-6),
            share_of_range: (k < keys.len()).then(|| error(k)),
            interval: match keys.get(k) {
                Some(key) => [-1.0, 1.0].map(|side| key.beyond(fitted.at[k] + side * NORMAL_95 * error(k))),
                None => [-1.0, 1.0].map(|side| value + side * NORMAL_95 * error(k)),
            },
            as_good: as_good.get(k).copied().flatten(),
        })
        .collect();
    Some(Confidence { estimates, correlation, trade_offs, residual_correlation: rho, better })
}

/// Values beside the fitted ones: of key `k` on one side, at growing distances. The other keys follow along `way`, by
/// which they make up for a change of this one as far as the covariance knows.
fn beside(fitted: &Trial, k: usize, side: f64, way: &[f64], error: f64) -> Vec<Vec<f64>> {
    let mut places: Vec<Vec<f64>> = Vec::new();
    let mut distance = (NORMAL_95 * error).max(NEAREST);
    while distance < 1.0 {
        let moved = |(at, way): (&f64, &f64)| (at + side * distance * way).clamp(0.0, 1.0);
        let at: Vec<f64> = fitted.at.iter().zip(way).map(moved).collect();
        let is_end = (at[k] - fitted.at[k]).abs() < distance * (1.0 - 1e-9);
        if places.last().is_none_or(|last| last[k] != at[k]) && at[k] != fitted.at[k] {
            places.push(at);
        }
        if is_end {
            break;
        }
        distance *= FARTHER;
    }
    places
}

/// What is beside the fitted values.
struct Beside {
    /// Of each key: the values that fit as well as the fitted one, on both sides of it, if they go beyond what its standard error says.
    as_good: Vec<Option<(f64, f64)>>,
    /// The best values of all keys, if they are better than the fitted ones.
    better: Option<Vec<f64>>,
}

/// Evaluates values beside the fitted ones.
///
/// The motion is a rough function of the keys: each impact is shifted by the time step, and whole impacts come and go. At
/// the bottom of a wide valley the differences then see its stones, and the standard error is far too small.
fn look_beside(
    objective: &Objective<'_>,
    fitted: &Trial,
    ways: &[Vec<f64>],
    errors: &[f64],
    variance: f64,
    threads: usize,
    evaluations: &mut Vec<Evaluation>,
) -> Beside {
    let keys = objective.keys.len();
    let places: Vec<(usize, Vec<f64>)> = (0..keys)
        .flat_map(|k| [-1.0, 1.0].map(|side| (k, side)))
        .flat_map(|(k, side)| beside(fitted, k, side, &ways[k], errors[k]).into_iter().map(move |at| (k, at)))
        .collect();
    let rows = fitted.residuals.len() as f64;
    let cost =
        |(_, at): &(usize, Vec<f64>)| objective.trial(at, fitted.shift).map_or(f64::INFINITY, |trial| trial.cost);
    let costs = runner::in_order(&places, threads, objective.cancel, cost, |_| {});
    let tried = |at: &[f64], cost: f64| {
        let values = objective.keys.iter().zip(at).map(|(key, share)| key.at(*share)).collect();
        Evaluation { stage: "beside", values, cost }
    };
    evaluations.extend(places.iter().zip(&costs).map(|((_, at), cost)| tried(at, cost.unwrap_or(f64::INFINITY))));
    let least = places.iter().zip(&costs).filter_map(|((_, at), cost)| Some((at, (*cost)?)));
    let least = least.min_by(|a, b| a.1.total_cmp(&b.1));
    let better = least.filter(|(_, cost)| *cost < BETTER * fitted.cost).map(|(at, _)| at.clone());
    let fits = |cost: f64| (cost - fitted.cost) * rows <= CHI_SQUARED_95 * variance;
    let fit = |number: usize| costs.get(number).is_some_and(|cost| cost.is_some_and(fits));
    let mut end = |k: usize, side: f64| -> f64 {
        let mine: Vec<usize> = (0..places.len())
            .filter(|&number| places[number].0 == k && side * (places[number].1[k] - fitted.at[k]) > 0.0)
            .collect();
        let Some(last) = mine.iter().rposition(|&number| fit(number)) else { return fitted.at[k] };
        let mut inside = places[mine[last]].1.clone();
        let Some(&beyond) = mine.get(last + 1) else { return inside[k] };
        let mut outside = places[beyond].1.clone();
        for _ in 0..HALVINGS {
            let middle: Vec<f64> = inside.iter().zip(&outside).map(|(a, b)| 0.5 * (a + b)).collect();
            let place = (k, middle);
            let found = cost(&place);
            evaluations.push(tried(&place.1, found));
            if fits(found) { inside = place.1 } else { outside = place.1 }
        }
        inside[k]
    };
    let of = |k: usize| {
        let [low, high] = [-1.0, 1.0].map(|side| end(k, side));
        let limit = CONFIRMED * NORMAL_95 * errors[k];
        let is_wider = fitted.at[k] - low > limit || high - fitted.at[k] > limit;
        is_wider.then(|| (objective.keys[k].at(low), objective.keys[k].at(high)))
    };
    Beside { as_good: (0..keys).map(of).collect(), better }
}

/// The correlation of each value with the next.
fn lag_one(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / (values.len() as f64).max(1.0);
    let all: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let next: f64 = values.windows(2).map(|pair| (pair[0] - mean) * (pair[1] - mean)).sum();
    if all > 0.0 { next / all } else { 0.0 }
}
