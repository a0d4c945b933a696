//! Settings that were tried, with their results; and their Pareto front.

use crate::errors::{Errors, Quantity};
use crate::{CpuTime, Failure, Setting, SettingWarning, Work};

/// A candidate.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The changes to the scene.
    pub setting: Setting,
    /// The stage of the search that tried it, from 1.
    pub stage: usize,
    /// Its result.
    pub result: Result<CompletedRun, Failure>,
    /// Its time; `None` if it was not measured.
    pub cpu: Option<CpuTime>,
}

/// The results of a candidate that came to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct CompletedRun {
    /// Its errors.
    pub errors: Errors,
    /// Its counted work.
    pub work: Work,
    /// Steps whose contact problem was not solved to tolerance.
    pub unconverged: u64,
    /// Its warnings by `check` and `run`.
    pub warned: Vec<SettingWarning>,
}

impl Row {
    /// Its accuracy, if it has one.
    #[must_use]
    pub fn accuracy(&self) -> Option<f64> {
        self.result.as_ref().ok()?.errors.of(Quantity::Accuracy)
    }

    /// Its warnings by `check` and `run`.
    #[must_use]
    pub fn warned(&self) -> &[SettingWarning] {
        self.result.as_ref().map_or(&[], |done| &done.warned)
    }

    /// Time estimated from its counted work, s.
    #[must_use]
    pub fn modelled(&self) -> Option<f64> {
        Some(self.result.as_ref().ok()?.work.seconds())
    }

    /// Its median CPU time, s.
    #[must_use]
    pub fn measured(&self) -> Option<f64> {
        self.cpu.map(|cpu| cpu.median)
    }
}

/// The indices of the Pareto-optimal points (cost, error), cheapest first: no other point is at
/// most as expensive and at most as inaccurate, and better in one of the two. Among equal points
/// the first counts.
///
/// ```
/// let points = [(1.0, 0.5), (2.0, 0.6), (3.0, 0.1), (3.0, 0.1), (0.5, f64::NAN)];
/// assert_eq!(teeter_study::pareto_front(&points), [0, 2]);
/// ```
#[must_use]
pub fn pareto_front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|&k| !points[k].0.is_nan() && !points[k].1.is_nan()).collect();
    order.sort_by(|&a, &b| {
        points[a].0.total_cmp(&points[b].0).then(points[a].1.total_cmp(&points[b].1)).then(a.cmp(&b))
    });
    let mut least = f64::INFINITY;
    order.retain(|&k| {
        let better = points[k].1 < least;
        least = least.min(points[k].1);
        better
    });
    order
}

/// Costs or errors within this factor of each other count as equal, as a solve more or less doesn't
/// matter.
const SAME: f64 = 1.05;

/// The rows on the Pareto front of accuracy over counted work, both in classes 5 % wide; of each
/// class the row with the fewest changes to the scene, then the first.
#[must_use]
pub fn pareto_front_of(rows: &[Row]) -> Vec<usize> {
    let class = |x: f64| (x.max(f64::MIN_POSITIVE).ln() / SAME.ln()).round();
    let point = |row: &Row| Some((class(row.modelled()?), class(row.accuracy()?)));
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by_key(|&k| (rows[k].setting.len(), k));
    let points: Vec<_> = order.iter().map(|&k| point(&rows[k]).unwrap_or((f64::NAN, f64::NAN))).collect();
    pareto_front(&points).into_iter().map(|k| order[k]).collect()
}

/// A positive number to two significant digits.
fn two_digits(x: f64) -> f64 {
    let unit = 10f64.powf(x.log10().floor() - 1.0);
    if unit > 0.0 { (x / unit).round() * unit } else { x }
}

/// Of the rows on the front those that none of them beats in both time, measured where it was, and error, of which none below `bar` is known, as they are told, to two
/// digits; cheapest first.
pub(crate) fn unbeaten(front: &[usize], rows: &[Row], bar: f64) -> Vec<usize> {
    let point = |number: &usize| {
        let row = &rows[*number];
        Some((two_digits(row.measured().or(row.modelled())?), two_digits(row.accuracy()?.max(bar))))
    };
    let points: Vec<_> = front.iter().map(|number| point(number).unwrap_or((f64::NAN, f64::NAN))).collect();
    pareto_front(&points).into_iter().map(|k| front[k]).collect()
}

/// Whether two rows differ in cost or accuracy by more than 5 %, or in whether they came to their
/// end.
pub(crate) fn differ(a: &Row, b: &Row) -> bool {
    let apart = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => a > SAME * b || b > SAME * a,
        (None, None) => false,
        _ => true,
    };
    apart(a.modelled(), b.modelled()) || apart(a.accuracy(), b.accuracy())
}

/// Whether a cost equals the least one, within 5 %.
pub(crate) fn as_cheap(cost: f64, least: f64) -> bool {
    cost <= SAME * least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_another_row_beats_in_time_and_error_is_not_listed() {
        let row = |time: f64, accuracy: f64| Row {
            setting: Setting::none(),
            stage: 1,
            result: Ok(CompletedRun {
                errors: Errors::of_accuracy(accuracy),
                work: Work::default(),
                unconverged: 0,
                warned: Vec::new(),
            }),
            cpu: CpuTime::of(vec![time]),
        };
        // By counted work the first was the cheapest.
        let rows = [row(420e-6, 1.7), row(300e-6, 0.18), row(9.0, 9.0), row(500e-6, 1e-3), row(600e-6, 1e-4)];
        assert_eq!(unbeaten(&[0, 1, 3, 4], &rows, 1e-5), [1, 3, 4]);
        let equal = [row(84e-6, 2.11e-4), row(100e-6, 2.08e-4)];
        assert_eq!(unbeaten(&[0, 1], &equal, 1e-5), [0], "as they are told");
        assert_eq!(unbeaten(&[0, 1, 3, 4], &rows, 2e-3), [1, 3], "no error below 2e-3 is known");
    }

    #[test]
    fn no_point_of_the_front_is_beaten_and_every_other_one_is() {
        let points: Vec<(f64, f64)> =
            (0..200_u32).map(|k| (f64::from(k * 7919 % 97), f64::from(k * 104_729 % 89))).collect();
        let on = pareto_front(&points);
        let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
        for (k, &point) in points.iter().enumerate() {
            let beaten = points.iter().any(|&other| beats(other, point));
            assert!(!(on.contains(&k) && beaten), "{point:?}");
            assert!(on.contains(&k) || beaten || on.iter().any(|&other| points[other] == point), "{point:?}");
        }
        assert!(on.windows(2).all(|w| points[w[0]].0 < points[w[1]].0 && points[w[0]].1 > points[w[1]].1));
    }
}
