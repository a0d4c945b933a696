//! A coordinate and its velocity over time for phase portraits: thinned by shape, not by count, in bounded memory.
//!
//! Of all steps those are kept between which both go along straight lines in time, to [`TOLERANCE`] of how far each of them goes in
//! the run. So a portrait is as smooth as the motion wherever that turns or jumps, and a long flight or rest is two points.

use serde::{Deserialize, Serialize};

/// How far straight lines may be off, in parts of the extent: a quarter of a pixel in a plot of 500.
const TOLERANCE: f64 = 5e-4;

/// Most points kept; a longer curve is thinned more, to twice the tolerance and so on.
const POINTS: usize = 4000;

/// Time, coordinate, velocity.
pub(crate) type Point = [f64; 3];

/// A curve of a coordinate and its velocity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Orbit {
    points: Vec<Point>,
    /// The point entered last, which is kept only if the curve turns there.
    last: Option<Point>,
    /// By which rates a line from the last of `points` on may go, of coordinate and velocity: least and largest.
    rates: [[f64; 2]; 2],
    /// The largest distances from the first point, rounded up to powers of two, as what they give has to last.
    extents: [f64; 2],
    tolerance: f64,
}

impl Default for Orbit {
    fn default() -> Self {
        // All at once: memory doesn't grow with the run.
        Self {
            points: Vec::with_capacity(POINTS + 1),
            last: None,
            rates: [ANY; 2],
            extents: [0.0; 2],
            tolerance: TOLERANCE,
        }
    }
}

const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

impl Orbit {
    /// Takes the values at the end of a step, or at the start.
    #[inline]
    pub(crate) fn enter(&mut self, point: Point) {
        if !point.iter().all(|x| x.is_finite()) {
            return;
        }
        let Some(&first) = self.points.first() else {
            self.points.push(point);
            return;
        };
        if (0..2).any(|k| (point[k + 1] - first[k + 1]).abs() > self.extents[k]) {
            self.widen(first, point);
        }
        self.follow(point);
        if self.points.len() > POINTS {
            self.tolerance *= 2.0;
            *self = self.thinned(self.tolerance);
        }
    }

    /// Goes further out than before: what was allowed so far is too little from here on.
    #[cold]
    fn widen(&mut self, first: Point, point: Point) {
        for k in 0..2 {
            let far = (point[k + 1] - first[k + 1]).abs();
            if far > self.extents[k] {
                self.extents[k] = far.log2().ceil().exp2().max(far);
            }
        }
        if let Some(last) = self.last.take() {
            self.turn(last);
        }
    }

    fn turn(&mut self, at: Point) {
        self.points.push(at);
        self.rates = [ANY; 2];
    }

    fn follow(&mut self, point: Point) {
        let rate = |from: Point, k: usize, off: f64| (point[k + 1] + off - from[k + 1]) / (point[0] - from[0]);
        let mut from = self.points[self.points.len() - 1];
        if let Some(last) = self.last
            && (0..2).any(|k| !(self.rates[k][0]..=self.rates[k][1]).contains(&rate(from, k, 0.0)))
        {
            self.turn(last);
            from = last;
        }
        for k in 0..2 {
            let off = self.tolerance * self.extents[k];
            let [least, largest] = self.rates[k];
            self.rates[k] = [least.max(rate(from, k, -off)), largest.min(rate(from, k, off))];
        }
        self.last = Some(point);
    }

    fn thinned(&self, tolerance: f64) -> Self {
        let mut thinned = Self { extents: self.extents, tolerance, ..Self::default() };
        for point in self.points.iter().chain(&self.last) {
            match thinned.points.is_empty() {
                true => thinned.points.push(*point),
                false => thinned.follow(*point),
            }
        }
        thinned
    }

    /// The curve, in so many points or fewer, three at least.
    pub(crate) fn points(&self, most: usize) -> Vec<Point> {
        // Known only now: how far it went, without rounding up.
        let mut exact = self.clone();
        for k in 0..2 {
            let all = || self.points.iter().chain(&self.last).map(|point| point[k + 1]);
            let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            exact.extents[k] = (high - low).max(0.0);
        }
        let mut tolerance = self.tolerance;
        let mut thinned = exact.thinned(tolerance);
        while thinned.points.len() + 1 > most.max(3) && tolerance < 1.0 {
            tolerance *= 1.5;
            thinned = exact.thinned(tolerance);
        }
        thinned.points.into_iter().chain(thinned.last).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit(steps: u32, dt: f64, of: impl Fn(f64) -> [f64; 2]) -> Orbit {
        let mut orbit = Orbit::default();
        for step in 0..=steps {
            let t = f64::from(step) * dt;
            let [x, v] = of(t);
            orbit.enter([t, x, v]);
        }
        orbit
    }

    /// The largest error of straight lines between the points, in parts of the extent.
    fn error(points: &[Point], steps: u32, dt: f64, of: impl Fn(f64) -> [f64; 2], extents: [f64; 2]) -> f64 {
        let mut most = 0.0_f64;
        for step in 0..=steps {
            let t = f64::from(step) * dt;
            let after = points.partition_point(|point| point[0] < t).clamp(1, points.len() - 1);
            let ([a, b], x) = ([points[after - 1], points[after]], of(t));
            for k in 0..2 {
                let line = a[k + 1] + (t - a[0]) / (b[0] - a[0]) * (b[k + 1] - a[k + 1]);
                most = most.max((line - x[k]).abs() / extents[k]);
            }
        }
        most
    }

    #[test]
    fn a_swing_of_many_steps_is_smooth_in_few_points() {
        let swing = |t: f64| [t.cos(), -t.sin()];
        let points = orbit(100_000, 1e-3, swing).points(usize::MAX);
        assert!(points.len() < 2500, "{}", points.len());
        let off = error(&points, 100_000, 1e-3, swing, [2.0; 2]);
        assert!(off <= 2.0 * TOLERANCE, "{off}");
        assert_eq!((points[0], points[points.len() - 1][0]), ([0.0, 1.0, -0.0], 100.0));
    }

    #[test]
    fn a_jump_stays_sharp_and_rest_is_two_points() {
        let impact = |t: f64| if t < 50.0 { [t, 1.0] } else { [50.0, 0.0] };
        let points = orbit(100, 1.0, impact).points(usize::MAX);
        assert!(points.contains(&[49.0, 49.0, 1.0]) && points.contains(&[50.0, 50.0, 0.0]), "{points:?}");
        assert!(points.len() <= 5, "{points:?}");
        assert_eq!(orbit(1000, 1.0, |_| [3.0, 0.0]).points(usize::MAX).len(), 2);
    }

    #[test]
    fn a_long_run_is_bounded_and_loses_accuracy_as_it_must() {
        let swing = |t: f64| [(1.0 - t / 2e4) * t.cos(), -(1.0 - t / 2e4) * t.sin()];
        let orbit = orbit(400_000, 0.025, swing);
        assert!(orbit.points.len() <= POINTS);
        let points = orbit.points(1000);
        assert!(points.len() <= 1000 && points[points.len() - 1][0] == 10_000.0);
    }
}
