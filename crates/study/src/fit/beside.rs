//! Values beside the fitted ones: which of them fit as well, and whether one fits better.
//!
//! The motion is a rough function of the keys: each impact is shifted by the time step, and whole impacts come and go. At
//! the bottom of a wide valley the differences then see its stones, and the standard error is far too small.

use super::least_squares::{Point, levenberg_marquardt_within};
use crate::runner;
use std::sync::atomic::AtomicBool;

/// Values beside the fitted one are looked at from this share of the range on, each `FARTHER` times as far away.
const NEAREST: f64 = 2e-3;
const FARTHER: f64 = 1.3;
/// The farthest of the first ones: a key that is hardly determined has its values within the range looked at, too.
const FIRST_WITHIN: f64 = 0.25;
/// Values beside the fitted ones are better where their sum of squares is below this part of the fitted one's.
const BETTER: f64 = 0.99;
/// How often the distance between values that still fit and the next is halved.
const HALVINGS: usize = 4;
/// Of so many places one after the other, at one the other keys are improved. There are several to a change of scale, as
/// an improvement takes many runs.
const IMPROVED_EACH: usize = 3;
/// Iterations of such an improvement, and the distance of its differences as a share of the range.
const ITERATIONS: usize = 4;
const REACH: f64 = 5e-4;

/// The fitted values and what is known about them.
pub(super) struct Fitted<'a> {
    /// As shares of the ranges.
    pub(super) at: &'a [f64],
    /// Mean square of the residuals.
    pub(super) cost: f64,
    /// Of each key: how all keys change with it, as far as the covariance knows.
    pub(super) ways: &'a [Vec<f64>],
    /// Their standard errors; infinite where nothing depends on a key.
    pub(super) errors: &'a [f64],
    /// By how much the mean square may be above the fitted one for values to fit as well.
    pub(super) allowed: f64,
}

/// What is beside the fitted values.
pub(super) struct Beside {
    /// Of each key: the least and the largest share that were found to fit as well.
    pub(super) as_good: Vec<(f64, f64)>,
    /// The best values of all keys, if they are better than the fitted ones.
    pub(super) better: Option<Vec<f64>>,
    /// All that was tried, with its mean square.
    pub(super) tried: Vec<(Vec<f64>, f64)>,
}

/// The residuals with values of the keys and their mean square; none if there is no motion.
pub(super) type Evaluate<'a> = dyn Fn(&[f64]) -> Option<(Vec<f64>, f64)> + Sync + 'a;

/// Looks at values beside the fitted ones, of each key on both sides.
pub(super) fn look(fitted: &Fitted<'_>, evaluate: &Evaluate<'_>, threads: usize, cancel: &AtomicBool) -> Beside {
    let keys = fitted.at.len();
    let walks: Vec<(usize, f64)> = (0..keys).flat_map(|k| [(k, -1.0), (k, 1.0)]).collect();
    let walk = |&(k, side): &(usize, f64)| {
        let mut walk = Walk { fitted, k, side, evaluate, tried: Vec::new() };
        (walk.last_that_fits(), walk.tried)
    };
    let results = runner::in_order(&walks, threads, cancel, walk, |_| {});
    let (mut ends, mut tried) = (Vec::new(), Vec::new());
    for ((k, _), result) in walks.iter().zip(results) {
        let (end, found) = result.unwrap_or((fitted.at[*k], Vec::new()));
        ends.push(end);
        tried.extend(found);
    }
    let least = tried.iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let better = least.filter(|(_, cost)| *cost < BETTER * fitted.cost).map(|(at, _)| at.clone());
    Beside { as_good: ends.chunks(2).map(|ends| (ends[0], ends[1])).collect(), better, tried }
}

/// The way from the fitted values to one end of the range of a key.
struct Walk<'a> {
    fitted: &'a Fitted<'a>,
    k: usize,
    side: f64,
    evaluate: &'a Evaluate<'a>,
    tried: Vec<(Vec<f64>, f64)>,
}

/// Values of all keys, with their mean square.
type Place = (Vec<f64>, f64);

impl Walk<'_> {
    fn fits(&self, place: &Place) -> bool {
        place.1 - self.fitted.cost <= self.fitted.allowed
    }

    fn cost(&mut self, at: &[f64]) -> f64 {
        let cost = (self.evaluate)(at).map_or(f64::INFINITY, |found| found.1);
        self.tried.push((at.to_vec(), cost));
        cost
    }

    /// The distances that are looked at, up to the end of the range.
    fn distances(&self) -> Vec<f64> {
        let here = self.fitted.at[self.k];
        let room = if self.side < 0.0 { here } else { 1.0 - here };
        let first = (super::confidence::NORMAL_95 * self.fitted.errors[self.k]).clamp(NEAREST, FIRST_WITHIN);
        let mut distances: Vec<f64> =
            std::iter::successors(Some(first), |last| Some(FARTHER * last)).take_while(|d| *d < room).collect();
        if room > 0.0 {
            distances.push(room);
        }
        distances
    }

    /// The value farthest away that fits as well.
    fn last_that_fits(&mut self) -> f64 {
        let here = self.fitted.at[self.k];
        let distances = self.distances();
        let mut places: Vec<Place> = Vec::new();
        for (number, distance) in distances.iter().enumerate() {
            let at = here + self.side * distance;
            let mut place = self.best_start(at, places.last());
            let is_turn = number % IMPROVED_EACH == IMPROVED_EACH - 1 || number + 1 == distances.len();
            if is_turn && !self.fits(&place) {
                place = self.improved(place);
            }
            places.push(place);
        }
        let Some(mut last) = places.iter().rposition(|place| self.fits(place)) else { return here };
        let mut inside = places[last].clone();
        // The next ones may not have been improved.
        let mut outside = loop {
            let Some(next) = places.get(last + 1) else { return inside.0[self.k] };
            let at = next.0[self.k];
            let start = self.best_start(at, Some(&inside));
            let next = self.improved(start);
            if !self.fits(&next) {
                break next;
            }
            (inside, last) = (next, last + 1);
        };
        for _ in 0..HALVINGS {
            let at: Vec<f64> = inside.0.iter().zip(&outside.0).map(|(a, b)| 0.5 * (a + b)).collect();
            let cost = self.cost(&at);
            let mut middle = (at, cost);
            if !self.fits(&middle) {
                middle = self.improved(middle);
            }
            if self.fits(&middle) { inside = middle } else { outside = middle }
        }
        inside.0[self.k]
    }

    /// The best of the others at a value of the key: as fitted, as they follow along the covariance, and as they were
    /// at the place before.
    fn best_start(&mut self, value: f64, before: Option<&Place>) -> Place {
        let Fitted { at: here, ways, .. } = *self.fitted;
        let by = value - here[self.k];
        let following = here.iter().zip(&ways[self.k]).map(|(at, way)| (at + by * way).clamp(0.0, 1.0)).collect();
        let others = [Some(here.to_vec()), Some(following), before.map(|place| place.0.clone())];
        let mut starts: Vec<Vec<f64>> = Vec::new();
        for mut at in others.into_iter().flatten() {
            at[self.k] = value;
            if !starts.contains(&at) {
                starts.push(at);
            }
        }
        let mut best = (starts[0].clone(), f64::INFINITY);
        for at in starts {
            let cost = self.cost(&at);
            if cost < best.1 {
                best = (at, cost);
            }
        }
        best
    }

    /// The others improved by a few steps of least squares.
    fn improved(&mut self, place: Place) -> Place {
        let (k, value) = (self.k, place.0[self.k]);
        if place.0.len() < 2 {
            return place;
        }
        let all = |others: &[f64]| {
            let mut at = others.to_vec();
            at.insert(k, value);
            at
        };
        let evaluate = self.evaluate;
        let tried = &mut self.tried;
        let mut of = |others: &[f64], (): &()| {
            let at = all(others);
            let found = evaluate(&at);
            tried.push((at, found.as_ref().map_or(f64::INFINITY, |found| found.1)));
            let (residuals, cost) = found?;
            cost.is_finite().then(|| Point { at: others.to_vec(), residuals, cost, kept: () })
        };
        let mut others = place.0.clone();
        others.remove(k);
        let Some(start) = of(&others, &()) else { return place };
        let found = levenberg_marquardt_within(ITERATIONS, start, REACH, &mut of);
        (all(&found.at), found.cost)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is beside (x, y) = `at` for residuals of both.
    fn beside(at: [f64; 2], way: f64, residuals: fn(f64, f64) -> Vec<f64>) -> Beside {
        let evaluate = |at: &[f64]| {
            let residuals = residuals(at[0], at[1]);
            let cost = residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64;
            Some((residuals, cost))
        };
        let fitted = Fitted {
            at: &at,
            cost: evaluate(&at).unwrap().1,
            ways: &[vec![1.0, way], vec![0.0, 1.0]],
            errors: &[2e-4, 1e-3],
            allowed: 3.84 / 2.0,
        };
        look(&fitted, &evaluate, 2, &AtomicBool::new(false))
    }

    #[test]
    fn others_that_stay_show_that_all_values_fit() {
        // Nothing depends on x beyond 0.1, but the covariance thinks that y changes much with it.
        let found = beside([0.08, 0.5], -5.0, |x, y| vec![1000.0 * (y - 0.5), 30.0 * (x - 0.08).min(0.02)]);
        assert!(found.as_good[0].1 == 1.0 && found.better.is_none(), "{:?}", found.as_good);
        assert!((found.as_good[1].0 - 0.5).abs() < 4e-3 && (found.as_good[1].1 - 0.5).abs() < 4e-3);
    }

    #[test]
    fn others_follow_a_valley_that_curves() {
        // Along y = 0.5 + 0.4 x² up to x = 0.7, where it ends; at x = 0 it is level.
        let curved = |x: f64, y: f64| vec![1000.0 * (y - 0.5 - 0.4 * x * x), 50.0 * (x - 0.7).max(0.0)];
        let found = beside([0.1, 0.504], 0.0, curved);
        let (low, high) = found.as_good[0];
        assert!(low == 0.0 && (high - 0.738).abs() < 0.01, "{low} to {high}");
    }

    #[test]
    fn deeper_minima_are_found_where_only_both_keys_lead() {
        let found = beside([0.1, 0.504], 0.0, |x, y| vec![1000.0 * (y - 0.5 - 0.4 * x * x), 50.0 * (x - 0.7).min(0.0)]);
        assert!(found.better.is_some_and(|at| at[0] > 0.2));
    }
}
