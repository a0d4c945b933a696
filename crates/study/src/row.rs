//! A setting that was tried, with what came of it; and the front of those.

use crate::errors::{Errors, Quantity};
use crate::{Cpu, Failure, Setting, Warned, Work};

/// A candidate.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What is changed of the scene.
    pub setting: Setting,
    /// The stage that brought it in, from 1.
    pub stage: usize,
    /// What came of it.
    pub result: Result<Done, Failure>,
    /// Its time; `None` where it was not measured.
    pub cpu: Option<Cpu>,
}

/// A candidate that came to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Done {
    /// Its errors.
    pub errors: Errors,
    /// Its counted work.
    pub work: Work,
    /// Steps whose contact problem was not solved to tolerance.
    pub unconverged: u64,
    /// What `check` and `run` warn of.
    pub warned: Vec<Warned>,
}

impl Row {
    /// Its accuracy, where it has one.
    #[must_use]
    pub fn accuracy(&self) -> Option<f64> {
        self.result.as_ref().ok()?.errors.of(Quantity::Accuracy)
    }

    /// What `check` and `run` warn of in it.
    #[must_use]
    pub fn warned(&self) -> &[Warned] {
        self.result.as_ref().map_or(&[], |done| &done.warned)
    }

    /// What its counted work should cost, s.
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

/// The numbers of the points (cost, error) that no other one beats: none is at most as dear and at
/// most as wrong, and less in one of the two. Of equal points the first counts. From cheap to dear.
///
/// ```
/// let points = [(1.0, 0.5), (2.0, 0.6), (3.0, 0.1), (3.0, 0.1), (0.5, f64::NAN)];
/// assert_eq!(teeter_study::front(&points), [0, 2]);
/// ```
#[must_use]
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
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

/// Two costs or two errors nearer to each other than this factor are the same: a solve more or less
/// is no reason to choose.
const SAME: f64 = 1.05;

/// The rows on the front of accuracy over counted work, both in classes 5 % wide; of a class the
/// row that changes least of the scene, then the first.
#[must_use]
pub fn front_of(rows: &[Row]) -> Vec<usize> {
    let class = |x: f64| (x.max(f64::MIN_POSITIVE).ln() / SAME.ln()).round();
    let point = |row: &Row| Some((class(row.modelled()?), class(row.accuracy()?)));
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by_key(|&k| (rows[k].setting.len(), k));
    let points: Vec<_> = order.iter().map(|&k| point(&rows[k]).unwrap_or((f64::NAN, f64::NAN))).collect();
    front(&points).into_iter().map(|k| order[k]).collect()
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

/// Whether a cost is as good as the least: within the same 5 %.
pub(crate) fn as_cheap(cost: f64, least: f64) -> bool {
    cost <= SAME * least
}

#[cfg(test)]
mod tests {
    use super::front;

    #[test]
    fn no_point_of_the_front_is_beaten_and_every_other_one_is() {
        let points: Vec<(f64, f64)> =
            (0..200_u32).map(|k| (f64::from(k * 7919 % 97), f64::from(k * 104_729 % 89))).collect();
        let on = front(&points);
        let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
        for (k, &point) in points.iter().enumerate() {
            let beaten = points.iter().any(|&other| beats(other, point));
            assert!(!(on.contains(&k) && beaten), "{point:?}");
            assert!(on.contains(&k) || beaten || on.iter().any(|&other| points[other] == point), "{point:?}");
        }
        assert!(on.windows(2).all(|w| points[w[0]].0 < points[w[1]].0 && points[w[0]].1 > points[w[1]].1));
    }
}
