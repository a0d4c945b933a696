//! A coordinate and its velocity over time for phase portraits: thinned by shape, not by count, in bounded memory.
//!
//! Of all steps those are kept between which both go along straight lines in time, to [`TOLERANCE`] of how far each of them goes in
//! the run. So a portrait is as smooth as the motion wherever that turns or jumps, and a long flight or rest is two points. A run of
//! hundreds of impacts has more turns than points are kept: between them it is drawn by the cubics that a coordinate and its velocity
//! at both ends determine.

use serde::{Deserialize, Serialize};

/// How far straight lines may be off, in parts of the extent: a quarter of a pixel in a plot of 500.
const TOLERANCE: f64 = 5e-4;

/// Where straight lines are off by more than this part of the extent they are no picture of the motion.
const COARSEST: f64 = 0.1;

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
    /// By how much the lines may be off so far, of coordinate and velocity.
    off: [f64; 2],
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
            off: [0.0; 2],
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
            *self = self.thinned(2.0 * self.tolerance);
        }
    }

    /// Goes further out than before: what was allowed so far is too little from here on.
    #[cold]
    fn widen(&mut self, first: Point, point: Point) {
        // A tremor before a large motion doesn't make that coarse.
        self.tolerance = TOLERANCE;
        for k in 0..2 {
            let far = (point[k + 1] - first[k + 1]).abs();
            if far > self.extents[k] {
                self.extents[k] = far.log2().ceil().exp2().max(far);
            }
            self.tolerance = self.tolerance.max(self.off[k] / self.extents[k]);
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
        let off = self.extents.map(|extent| tolerance * extent);
        let mut thinned = Self { extents: self.extents, tolerance, off, ..Self::default() };
        for point in self.points.iter().chain(&self.last) {
            match thinned.points.is_empty() {
                true => thinned.points.push(*point),
                false => thinned.follow(*point),
            }
        }
        thinned
    }

    /// The curve, in so many points or fewer, three at least; none where these are too few to show it, as of a tremor of thousands of turns.
    pub(crate) fn points(&self, most: usize) -> Option<Vec<Point>> {
        let (points, tolerance, extents) = self.corners(most);
        let points = if tolerance <= TOLERANCE { points } else { rounded(&points, tolerance, extents, most) };
        (tolerance <= COARSEST).then_some(points)
    }

    /// The points that are kept, to which tolerance, and how far they go.
    fn corners(&self, most: usize) -> (Vec<Point>, f64, [f64; 2]) {
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
        (thinned.points.into_iter().chain(thinned.last).collect(), tolerance, exact.extents)
    }
}

/// Most pieces between two points.
const PIECES: f64 = 8.0;

/// The points with more between them where the motion turns, so many in all or fewer: those of cubics of the coordinate over time,
/// which have its velocities at both ends. Where both go along straight lines in time but for `tolerance`, that is a smooth motion; a
/// jump isn't, and stays.
fn rounded(points: &[Point], tolerance: f64, extents: [f64; 2], most: usize) -> Vec<Point> {
    let arcs = || points.iter().zip(points.iter().skip(1)).map(|(a, b)| Arc::between(*a, *b));
    // To how many pieces, if chords may be so far off.
    let pieces = |arc: &Arc, off: f64| {
        // As the motion itself is, so is an arc near the line between its ends.
        let smooth = arc.off(extents) <= 3.0 * tolerance;
        if smooth { (arc.off(extents) / off).sqrt().ceil().clamp(1.0, PIECES) } else { 1.0 }
    };
    let mut off = TOLERANCE;
    while off < tolerance && arcs().map(|arc| pieces(&arc, off)).sum::<f64>() >= most as f64 {
        off *= 1.2;
    }
    let within = |arc: Arc| {
        let pieces = pieces(&arc, off);
        (1..pieces as usize).map(move |k| arc.at(k as f64 / pieces))
    };
    let ends = points.iter().skip(1);
    points.iter().take(1).copied().chain(arcs().zip(ends).flat_map(|(arc, end)| within(arc).chain([*end]))).collect()
}

/// A motion between two points: the cubic over time with their coordinates and velocities.
struct Arc {
    start: Point,
    /// How long it takes.
    h: f64,
    /// How much the velocity changes.
    dv: f64,
    /// How much faster it is in the mean than the mean of both velocities.
    beyond: f64,
}

impl Arc {
    fn between(a: Point, b: Point) -> Self {
        let h = b[0] - a[0];
        Self { start: a, h, dv: b[2] - a[2], beyond: (b[1] - a[1]) / h - 0.5 * (a[2] + b[2]) }
    }

    /// The distance from the chord, in parts of the extents.
    fn off(&self, extents: [f64; 2]) -> f64 {
        (1.5 * self.beyond.abs() / extents[1]).max(0.125 * (self.h * self.dv).abs() / extents[0])
    }

    /// The point after a part of the time.
    fn at(&self, part: f64) -> Point {
        let Self { start: [t, x, v], h, dv, beyond } = *self;
        let mean = v + 0.5 * dv * part + beyond * part * (3.0 - 2.0 * part);
        [t + part * h, x + h * part * mean, v + dv * part + 6.0 * beyond * part * (1.0 - part)]
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
        let points = orbit(100_000, 1e-3, swing).points(usize::MAX).unwrap();
        assert!(points.len() < 2500, "{}", points.len());
        let off = error(&points, 100_000, 1e-3, swing, [2.0; 2]);
        assert!(off <= 2.0 * TOLERANCE, "{off}");
        assert_eq!((points[0], points[points.len() - 1][0]), ([0.0, 1.0, -0.0], 100.0));
    }

    #[test]
    fn a_jump_stays_sharp_and_rest_is_two_points() {
        let impact = |t: f64| if t < 50.0 { [t, 1.0] } else { [50.0, 0.0] };
        let points = orbit(100, 1.0, impact).points(usize::MAX).unwrap();
        assert!(points.contains(&[49.0, 49.0, 1.0]) && points.contains(&[50.0, 50.0, 0.0]), "{points:?}");
        assert!(points.len() <= 5, "{points:?}");
        assert_eq!(orbit(1000, 1.0, |_| [3.0, 0.0]).points(usize::MAX).unwrap().len(), 2);
    }

    /// Hops of a block that turns to and fro, lower from one to the next: more arcs than points are kept for.
    #[test]
    fn hundreds_of_impacts_are_joined_by_arcs() {
        const HOPS: f64 = 600.0;
        let hop = |t: f64| {
            let (number, s) = (t.floor(), t.fract());
            let v = 1.0 - 0.9 * number / HOPS;
            [v * s * (1.0 - s), v * (1.0 - 2.0 * s)]
        };
        let (steps, dt) = (600_000 - 1, 1e-3);
        let orbit = orbit(steps, dt, hop);
        let (corners, tolerance, _) = orbit.corners(8000);
        let points = orbit.points(8000).unwrap();
        assert!(tolerance > TOLERANCE && points.len() <= 8000, "{}", points.len());
        let [chords, arcs] = [&corners, &points].map(|points| error(points, steps, dt, hop, [0.25, 2.0]));
        assert!(arcs < 0.3 * chords, "{arcs} {chords} {tolerance} {} {}", corners.len(), points.len());
    }

    #[test]
    fn a_tremor_of_more_turns_than_points_is_no_curve_and_spoils_no_later_one() {
        let tremor = |t: f64| [1e-6 * (2.0 * t).sin(), 1e-3 * (1.7 * t).cos()];
        assert_eq!(orbit(100_000, 1.0, tremor).points(8000), None);
        // After it the block falls over.
        let falls = |t: f64| {
            let (s, [x, v]) = ((t - 1e5).max(0.0) / 1e3, tremor(t));
            [x + s * s, v + 2.0 * s]
        };
        let points = orbit(101_000, 1.0, falls).points(8000).unwrap();
        let off = error(&points, 101_000, 1.0, falls, [1.0, 2.0]);
        assert!(off < 5e-3, "{off}");
    }

    #[test]
    fn a_long_run_is_bounded_and_loses_accuracy_as_it_must() {
        let swing = |t: f64| [(1.0 - t / 2e4) * t.cos(), -(1.0 - t / 2e4) * t.sin()];
        let orbit = orbit(400_000, 0.025, swing);
        assert!(orbit.points.len() <= POINTS);
        // Of 1592 swings these can be no curve, unlike those of 160.
        assert_eq!(orbit.points(1000), None);
        let points = self::orbit(40_000, 0.025, swing).points(1000).unwrap();
        assert!(points.len() <= 1000 && points[points.len() - 1][0] == 1000.0);
    }
}
