//! What a step may take past each other, so that no contact is seen at either end of it.

use super::Shapes;
use crate::simulation::{BlockPlace, Layout};
use teeter_detect::Vector;

/// A block went through the ground where the path of its mass centre comes closer to it than this part of its shorter side. What lies on the
/// ground is farther away: a rectangle by a half, a triangle by a third.
const THROUGH: f64 = 0.25;

impl Shapes {
    /// Two blocks with a contact between them that moved past each other in a step of `dt` (s) that
    /// ended with these coordinates and velocities, by more than half the sum of their shorter
    /// sides, so that the contact may not have been seen; and by how much, m. As they turn, they move
    /// past each other, too.
    #[must_use]
    pub fn passing(&self, layout: &Layout, q: &[f64], v: &[f64], dt: f64) -> Option<(usize, usize, f64)> {
        let passes = |a: usize, b: usize| {
            let (first, second) = (&layout.blocks[a], &layout.blocks[b]);
            let between = |k: usize, of: &[f64]| of[first.range.start + k] - of[second.range.start + k];
            let (x, y) = (between(0, q), between(1, q));
            let (dx, dy) = (dt * between(0, v), dt * between(1, v));
            let straight = dx.hypot(dy);
            // Where they were nearest on their way here.
            let back = if straight > 0.0 { ((x * dx + y * dy) / (straight * straight)).clamp(0.0, 1.0) } else { 0.0 };
            let nearest = (x - back * dx).hypot(y - back * dy);
            let swept = |of: &BlockPlace, other: &BlockPlace| swept_by_turning(of, v, dt, nearest + other.reach);
            let far = straight + swept(first, second) + swept(second, first);
            let passes = far > 0.5 * (first.side + second.side) && nearest < first.reach + second.reach;
            passes.then_some((a, b, far))
        };
        if let Some(found) = self.blocks.iter().find_map(|&(a, b)| passes(a, b)) {
            return Some(found);
        }
        let crowd = self.crowd.as_ref()?;
        // Of two that come so far past each other one comes at least half as far.
        let is_fast = |k: &usize| {
            let (place, at) = (&layout.blocks[*k], layout.blocks[*k].range.start);
            dt * v[at].hypot(v[at + 1]) + swept_by_turning(place, v, dt, f64::INFINITY) > 0.5 * self.shortest
        };
        let is_fast: Vec<bool> = (0..layout.blocks.len()).map(|k| is_fast(&k)).collect();
        if !is_fast.contains(&true) {
            return None;
        }
        // From where each was at the start of the step to where it is, along x: only those whose
        // reaches overlap there can have passed each other.
        let mut spans: Vec<(f64, f64, usize)> = Vec::with_capacity(is_fast.len());
        for (k, place) in layout.blocks.iter().enumerate() {
            let (now, back) = (q[place.range.start], dt * v[place.range.start]);
            let (low, high) = (now.min(now - back) - place.reach, now.max(now - back) + place.reach);
            if low.is_nan() || high.is_nan() {
                return None;
            }
            spans.push((low, high, k));
        }
        spans.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        // Of several the one is told that comes first by a fast block's number.
        let mut first: Option<([usize; 2], (usize, usize, f64))> = None;
        for (at, &(_, high, a)) in spans.iter().enumerate() {
            for &(_, _, b) in spans[at + 1..].iter().take_while(|(low, ..)| *low <= high) {
                let orders = [[a, b], [b, a]];
                let order = orders.into_iter().filter(|[fast, _]| is_fast[*fast]).min();
                let Some(order) = order.filter(|order| first.is_none_or(|(least, _)| *order < least)) else { continue };
                let (low, high) = (a.min(b), a.max(b));
                if let Some(found) = passes(low, high).filter(|_| crowd.contact_of(low, high).is_some()) {
                    first = Some((order, found));
                }
            }
        }
        first.map(|(_, found)| found)
    }

    /// A block with a contact with the ground that went through it in a step of `dt` (s) that ended with these coordinates and velocities, and
    /// how far it moved, m: by more than half its shorter side, so that it may have passed a crest of the ground's profile within the step.
    #[must_use]
    pub fn passing_ground(&self, layout: &Layout, q: &[f64], v: &[f64], dt: f64) -> Option<(usize, f64)> {
        let profile = self.profile.as_ref()?;
        let ground = layout.ground.as_ref().map_or([0.0; 3], |range| [0, 1, 2].map(|k| q[range.start + k]));
        let (sin, cos) = ground[2].sin_cos();
        let on_profile = |x: f64, y: f64| {
            let [x, y] = [x - ground[0], y - ground[1]];
            Vector::<2>::new(cos * x + sin * y, cos * y - sin * x)
        };
        layout.blocks.iter().zip(&self.on_ground).enumerate().filter(|(_, (_, joined))| **joined).find_map(
            |(block, (place, _))| {
                let at = place.range.start;
                let [dx, dy] = [dt * v[at], dt * v[at + 1]];
                let far = dx.hypot(dy);
                if far <= 0.5 * place.side {
                    return None;
                }
                let way = [on_profile(q[at] - dx, q[at + 1] - dy), on_profile(q[at], q[at + 1])];
                let through = profile
                    .points()
                    .zip(profile.points().skip(1))
                    .any(|(a, b)| apart(way, [a, b]) < THROUGH * place.side);
                through.then_some((block, far))
            },
        )
    }
}

/// How far the points of a block that are at most `within` (m) from its mass centre moved past their surroundings by its turning in a step
/// of `dt` (s), m. A disc moves past nothing as it turns.
fn swept_by_turning(place: &BlockPlace, v: &[f64], dt: f64, within: f64) -> f64 {
    let is_round = place.side >= 2.0 * place.reach * (1.0 - 1e-9);
    if is_round { 0.0 } else { dt * v[place.range.start + 2].abs() * place.reach.min(within) }
}

/// The least distance of two segments, m.
fn apart(a: [Vector<2>; 2], b: [Vector<2>; 2]) -> f64 {
    let beside = |[from, to]: [Vector<2>; 2], x: Vector<2>| (to - from).perp(&(x - from));
    let parted = |line, ends: [Vector<2>; 2]| beside(line, ends[0]) * beside(line, ends[1]) > 0.0;
    if !parted(a, b) && !parted(b, a) && (a[1] - a[0]).perp(&(b[1] - b[0])) != 0.0 {
        return 0.0;
    }
    let to_segment = |[from, to]: [Vector<2>; 2], x: Vector<2>| {
        let along = to - from;
        let part = ((x - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        (x - from - along * part).norm()
    };
    let distances = [to_segment(a, b[0]), to_segment(a, b[1]), to_segment(b, a[0]), to_segment(b, a[1])];
    distances.into_iter().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_are_as_far_apart_as_their_nearest_points() {
        let segment = |[a, b, c, d]: [f64; 4]| [Vector::<2>::new(a, b), Vector::<2>::new(c, d)];
        let base = segment([0.0, 0.0, 4.0, 0.0]);
        for (other, exact) in [
            ([1.0, -1.0, 1.0, 1.0], 0.0),
            ([1.0, 2.0, 1.0, 1.0], 1.0),
            ([7.0, 4.0, 9.0, 4.0], 5.0),
            ([1.0, 3.0, 2.0, 3.0], 3.0),
            ([5.0, 0.0, 6.0, 0.0], 1.0),
        ] {
            assert_eq!(apart(base, segment(other)), exact, "{other:?}");
            assert_eq!(apart(segment(other), base), exact, "{other:?}");
        }
    }
}
