//! How well the fitted values are known, and which of them trade off.

use super::matrix;
use super::objective::{Objective, Trial};
use crate::measured::Channel;

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
}

impl Estimate {
    /// The 95 % interval.
    #[must_use]
    pub fn interval(&self) -> (f64, f64) {
        (self.value - NORMAL_95 * self.standard_error, self.value + NORMAL_95 * self.standard_error)
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
/// Distance of the differences at first, as a share of the range.
const REACH: f64 = 4e-3;

/// Confidence of all estimates.
pub(super) struct Confidence {
    pub(super) estimates: Vec<Estimate>,
    pub(super) correlation: Vec<Vec<f64>>,
    pub(super) trade_offs: Vec<TradeOff>,
    pub(super) residual_correlation: f64,
}

/// From the covariance σ²(JᵀJ)⁻¹ at the fitted values, σ² being the mean square that is left. Where
/// one residual resembles the next, there is less in them than their number: the covariance is
/// multiplied by (1 + ρ)/(1 − ρ).
pub(super) fn of(objective: &Objective<'_>, fitted: &Trial) -> Option<Confidence> {
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
        })
        .collect();
    Some(Confidence { estimates, correlation, trade_offs, residual_correlation: rho })
}

/// The correlation of each value with the next.
fn lag_one(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / (values.len() as f64).max(1.0);
    let all: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let next: f64 = values.windows(2).map(|pair| (pair[0] - mean) * (pair[1] - mean)).sum();
    if all > 0.0 { next / all } else { 0.0 }
}
