//! How well the fitted values are known, and which of them trade off.

use super::beside::{self, Fitted};
use super::least_squares::{Point, levenberg_marquardt, nelder_mead};
use super::objective::{Objective, Trial};
use super::{Evaluation, SIMPLEX, matrix};
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
    /// The least and the largest value that were found to fit as well, if they go beyond what the standard
    /// error says; `None` for what isn't a key.
    pub as_good: Option<(f64, f64)>,
    /// By how much half the time step changes the value: an error that the interval doesn't hold.
    pub with_half_step: f64,
    /// The bounds of its range; `None` for what isn't a key.
    pub bounds: Option<(f64, f64)>,
    /// The 95 % interval by the standard error, for a key on the scale of its range and within it.
    interval: [f64; 2],
}

impl Estimate {
    /// The 95 % interval: by the standard error, but not narrower than the steps of the function allow, and up to the
    /// values that fit as well.
    #[must_use]
    pub fn interval(&self) -> (f64, f64) {
        let [low, high] = self.interval;
        self.as_good.map_or((low, high), |as_good| (low.min(as_good.0), high.max(as_good.1)))
    }

    /// The ends of the interval that are those of values found to fit as well, rather than those by the standard error; `None`
    /// where neither is.
    pub(super) fn beyond_error(&self) -> Option<(Option<f64>, Option<f64>)> {
        let (as_good, [low, high]) = (self.as_good?, self.interval);
        let ends = (Some(as_good.0).filter(|end| *end < low), Some(as_good.1).filter(|end| *end > high));
        (ends != (None, None)).then_some(ends)
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
pub(super) const NORMAL_95: f64 = 1.959_963_985;
/// A key of which the whole range changes the residuals by less than this share of their deviation has no effect.
const NO_EFFECT: f64 = 1e-3;
/// Correlations from here on are told.
const TRADES: f64 = 0.9;
/// 95 % quantile of χ² with one degree of freedom: values whose sum of squares over the variance is by no more
/// above the least are in the interval of the profile likelihood (Venzon and Moolgavkar 1988, doi 10.2307/2347496).
const CHI_SQUARED_95: f64 = NORMAL_95 * NORMAL_95;
/// An interval by the standard error that is passed by less than this factor is confirmed by what is beside it.
const CONFIRMED: f64 = 1.3;
/// The least distance of differences, as a share of the range: within it the steps of the function aren't told from its
/// slope, so no interval is narrower.
const LEAST_REACH: f64 = 2e-4;
/// Distance of the differences at first, as a share of the range.
const REACH: f64 = 4e-3;

/// Confidence of all estimates.
pub(super) struct Confidence {
    pub(super) estimates: Vec<Estimate>,
    pub(super) correlation: Vec<Vec<f64>>,
    pub(super) trade_offs: Vec<TradeOff>,
    pub(super) residual_correlation: f64,
    /// How improbable what is left is for noise, in standard deviations.
    pub(super) misfit: f64,
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
    let fewer = correlated(rho);
    let n = fitted.residuals.len() as f64;
    let freedom = (n - columns.len() as f64).max(1.0);
    let variance = fitted.cost * n / freedom * fewer;
    // What the motion doesn't depend on says nothing of the others, and isn't known: the rest is.
    // So does what the time shift and the origins make up for entirely: a slip before the first row only moves x.
    let fitted_with = columns[keys.len()..].to_vec();
    let matters = |k: usize, column: &[f64]| match k < keys.len() {
        true => norm(&beside_all(column, &fitted_with)) > NO_EFFECT * variance.sqrt(),
        false => norm(column) > 0.0,
    };
    let known: Vec<usize> = (0..columns.len()).filter(|&k| matters(k, &columns[k])).collect();
    // Once more with differences over about a standard error: over a shorter distance they would
    // show the steps of the function, over a longer one its curvature.
    if let Some(first) = inverse_of(&columns, &known) {
        for &k in known.iter().filter(|&&k| k < keys.len()) {
            let reach = (variance * first[k][k]).sqrt().clamp(LEAST_REACH, 5e-2);
            columns[k] = difference(k, reach)?;
        }
    }
    let known: Vec<usize> = known.into_iter().filter(|&k| matters(k, &columns[k])).collect();
    let count = columns.len();
    let covariance = inverse_of(&columns, &known);
    let variance_of = |k: usize| covariance.as_ref().map(|found| found[k][k]).filter(|found| *found > 0.0);
    let error = |k: usize| variance_of(k).map_or(f64::INFINITY, |found| (variance * found).sqrt());
    let correlation: Vec<Vec<f64>> = (0..count)
        .map(|i| {
            let one = |j: usize| match (&covariance, variance_of(i), variance_of(j)) {
                (Some(covariance), Some(a), Some(b)) => covariance[i][j] / (a * b).sqrt(),
                _ => f64::NAN,
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
        let along = |j: usize| match (&covariance, variance_of(k)) {
            (Some(covariance), Some(own)) => covariance[j][k] / own,
            _ => f64::from(u8::from(j == k)),
        };
        (0..keys.len()).map(along).collect()
    };
    let ways: Vec<Vec<f64>> = (0..keys.len()).map(way).collect();
    let errors: Vec<f64> = (0..keys.len()).map(error).collect();
    let allowed = CHI_SQUARED_95 * variance / n;
    let evaluate = |at: &[f64]| objective.trial(at, fitted.shift).ok().map(|trial| (trial.residuals, trial.cost));
    let center = Fitted { at: &fitted.at, cost: fitted.cost, ways: &ways, errors: &errors, allowed };
    let beside = beside::look(&center, &evaluate, threads, objective.cancel);
    evaluations.extend(beside.tried.iter().map(|(at, cost)| Evaluation {
        stage: "beside",
        values: keys.iter().zip(at).map(|(key, share)| key.at(*share)).collect(),
        cost: *cost,
        until: Some(objective.until),
    }));
    let tried = tried_that_fit(evaluations, objective.until, fitted.cost + allowed);
    let as_good = |k: usize| {
        let (low, high) = beside.as_good[k];
        let others = tried.iter().filter_map(|values| keys[k].share(values[k]));
        let (low, high) = others.fold((low, high), |(low, high), share| (low.min(share), high.max(share)));
        let limit = CONFIRMED * NORMAL_95 * errors[k];
        let is_wider = fitted.at[k] - low > limit || high - fitted.at[k] > limit;
        is_wider.then(|| (keys[k].at(low), keys[k].at(high)))
    };
    let as_good: Vec<Option<(f64, f64)>> = (0..keys.len()).map(as_good).collect();
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
                Some(key) => {
                    let half = (NORMAL_95 * error(k)).max(LEAST_REACH);
                    [-1.0, 1.0].map(|side| key.at(fitted.at[k] + side * half))
                }
                None => [-1.0, 1.0].map(|side| value + side * NORMAL_95 * error(k)),
            },
            bounds: keys.get(k).map(super::FitKey::bounds),
            as_good: as_good.get(k).copied().flatten(),
            with_half_step: 0.0,
        })
        .collect();
    Some(Confidence {
        estimates,
        correlation,
        trade_offs,
        residual_correlation: rho,
        misfit: misfit(fitted.cost * n, freedom, rho),
        better: beside.better,
    })
}

/// How many residuals are worth one, where each has this correlation with the next.
pub(super) fn correlated(rho: f64) -> f64 {
    if rho > 0.0 { (1.0 + rho) / (1.0 - rho).max(1e-3) } else { 1.0 }
}

impl Confidence {
    /// Enters what half the time step changes: the fit with it, from the values found. Not to first order: a step shifts each
    /// impact by a part of itself, which the fitted values make up for, and such a function has no slope.
    pub(super) fn with_half_step(mut self, objective: &Objective<'_>, fitted: &Trial, reach: f64) -> Self {
        let Some(finer) = refitted(objective, fitted, reach) else { return self };
        for (k, estimate) in self.estimates.iter_mut().enumerate() {
            estimate.with_half_step = match (objective.keys.get(k), &*estimate.name) {
                (Some(key), _) => key.at(finer.at[k]) - key.at(fitted.at[k]),
                (None, "time shift") => finer.shift - fitted.shift,
                (None, "zero of the angle") => objective.sign.factor() * (finer.offset - fitted.offset),
                (None, _) => 0.0,
            };
        }
        self
    }
}

/// The fit with half the time step, from the values found; none if that has no motion.
fn refitted(objective: &Objective<'_>, fitted: &Trial, reach: f64) -> Option<Trial> {
    let step = objective.source.scene(&objective.setting(&fitted.at)).ok()?.time.step;
    let finer = Objective { step: Some(0.5 * step), ..objective.clone() };
    let evaluate = |at: &[f64], kept: &Trial| {
        let trial = finer.trial(at, kept.shift).ok().filter(|trial| trial.cost.is_finite())?;
        Some(Point { at: trial.at.clone(), residuals: trial.residuals.clone(), cost: trial.cost, kept: trial })
    };
    let start = evaluate(&fitted.at, fitted)?;
    let simplex = nelder_mead(start, SIMPLEX * reach, 30 * objective.keys.len(), &mut &evaluate);
    Some(levenberg_marquardt(simplex, reach, &mut &evaluate).kept)
}

fn norm(column: &[f64]) -> f64 {
    column.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// What is left of a column that no combination of `others` gives, by Gram and Schmidt's method.
fn beside_all(column: &[f64], others: &[Vec<f64>]) -> Vec<f64> {
    let mut orthonormal: Vec<Vec<f64>> = Vec::new();
    let without = |column: &[f64], orthonormal: &[Vec<f64>]| {
        let mut left = column.to_vec();
        for _ in 0..2 {
            // Twice: what rounding leaves of a large part isn't small beside a small rest.
            for unit in orthonormal {
                let part: f64 = unit.iter().zip(&left).map(|(a, b)| a * b).sum();
                left.iter_mut().zip(unit).for_each(|(left, unit)| *left -= part * unit);
            }
        }
        left
    };
    for other in others {
        let left = without(other, &orthonormal);
        let length = norm(&left);
        if length > 1e-12 * norm(other) {
            orthonormal.push(left.iter().map(|x| x / length).collect());
        }
    }
    without(column, &orthonormal)
}

/// The inverse of JᵀJ of the columns with these numbers, in a matrix for all: 0 elsewhere.
fn inverse_of(columns: &[Vec<f64>], known: &[usize]) -> Option<Vec<Vec<f64>>> {
    let product = |a: usize, b: usize| columns[a].iter().zip(&columns[b]).map(|(a, b)| a * b).sum::<f64>();
    let normal: Vec<Vec<f64>> = known.iter().map(|&a| known.iter().map(|&b| product(a, b)).collect()).collect();
    let inverse = matrix::inverse(&normal)?;
    let mut all = vec![vec![0.0; columns.len()]; columns.len()];
    for (row, &a) in inverse.iter().zip(known) {
        known.iter().zip(row).for_each(|(&b, value)| all[a][b] = *value);
    }
    Some(all)
}

/// The values of all that was tried up to the time `until` and leaves no more than `most`: starts that ended elsewhere
/// are among them.
fn tried_that_fit(evaluations: &[Evaluation], until: f64, most: f64) -> Vec<Vec<f64>> {
    let fits = |tried: &&Evaluation| tried.until == Some(until) && tried.cost <= most;
    evaluations.iter().filter(fits).map(|tried| tried.values.clone()).collect()
}

/// By how many standard deviations a sum of squares of residuals over their noise is above what noise leaves (Wilson and
/// Hilferty 1931, doi 10.1073/pnas.17.12.684): residuals of which one resembles the next vary more.
fn misfit(sum: f64, freedom: f64, rho: f64) -> f64 {
    let rho = rho.clamp(0.0, 0.999);
    let spread = 2.0 / (9.0 * freedom * (1.0 - rho * rho) / (1.0 + rho * rho));
    ((sum / freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
}

/// The correlation of each value with the next.
fn lag_one(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / (values.len() as f64).max(1.0);
    let all: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let next: f64 = values.windows(2).map(|pair| (pair[0] - mean) * (pair[1] - mean)).sum();
    if all > 0.0 { next / all } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_effect_leaves_the_others_known() {
        let columns = [vec![1.0, 2.0, 0.0], vec![0.0; 3], vec![0.0, 1.0, 3.0]];
        let all = inverse_of(&columns, &[0, 2]).unwrap();
        let two = inverse_of(&[columns[0].clone(), columns[2].clone()], &[0, 1]).unwrap();
        assert_eq!([all[0][0], all[0][2], all[2][2], all[1][1]], [two[0][0], two[0][1], two[1][1], 0.0]);
        assert!(inverse_of(&columns, &[0, 1, 2]).is_none());
    }

    #[test]
    fn what_an_origin_makes_up_for_has_no_effect() {
        let origin = vec![-2.0; 5];
        let shift = vec![0.1, 0.4, -0.3, 0.2, 0.1];
        let moves: Vec<f64> = shift.iter().map(|x| 500.0 + 3.0 * x).collect();
        assert!(norm(&beside_all(&moves, &[origin.clone(), shift.clone()])) < 1e-11);
        let bends = [1.0, 0.0, 0.0, 0.0, 0.0];
        let left = beside_all(&bends, &[origin.clone(), shift.clone(), origin.clone()]);
        assert!(norm(&left) > 0.5);
        for other in [&origin, &shift] {
            assert!(left.iter().zip(other).map(|(a, b)| a * b).sum::<f64>().abs() < 1e-14);
        }
    }

    #[test]
    fn ends_that_the_standard_error_gives_are_none_of_values_that_fit_as_well() {
        let of = |as_good: Option<(f64, f64)>| Estimate {
            name: "k".to_owned(),
            unit: String::new(),
            value: 2.0,
            standard_error: 0.25,
            at_bound: false,
            share_of_range: Some(0.1),
            as_good,
            with_half_step: 0.0,
            bounds: Some((0.0, 10.0)),
            interval: [1.5, 2.5],
        };
        assert_eq!(of(Some((1.1, 2.1))).beyond_error(), Some((Some(1.1), None)));
        assert_eq!(of(Some((1.7, 3.0))).beyond_error(), Some((None, Some(3.0))));
        assert_eq!(of(Some((1.0, 3.0))).beyond_error(), Some((Some(1.0), Some(3.0))));
        assert_eq!((of(Some((1.7, 2.1))).beyond_error(), of(None).beyond_error()), (None, None));
    }

    #[test]
    fn all_that_was_tried_and_fits_counts() {
        let tried = |stage, until, cost| Evaluation { stage, values: vec![cost], cost, until };
        let all = [
            tried("samples", None, 0.1),
            tried("improvement", Some(0.3), 0.2),
            tried("improvement", Some(1.0), 1.01),
            tried("simplex", Some(1.0), 1.2),
            tried("beside", Some(1.0), 1.03),
        ];
        assert_eq!(tried_that_fit(&all, 1.0, 1.05), [vec![1.01], vec![1.03]]);
    }

    #[test]
    fn what_noise_leaves_is_no_misfit() {
        // χ² with 100 degrees of freedom: quantiles of 0.5, 0.95 and 0.999.
        for (sum, normal) in [(99.33, 0.0), (124.34, 1.645), (149.45, 3.090)] {
            assert!((misfit(sum, 100.0, 0.0) - normal).abs() < 5e-3, "{sum}");
        }
        assert!(misfit(149.45, 100.0, 0.8) < 2.0, "fewer numbers, and less sure");
    }
}
