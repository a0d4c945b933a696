//! Overlaps of rectangles and polygons by the separating-axis test.

use crate::scene::BlockScene;
use nalgebra::Vector2;
use std::sync::Arc;

/// The outline of a block, about its mass centre.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Outline {
    /// A rectangle, by its sides.
    Rectangle([f64; 2]),
    /// The corners of a convex polygon, counter-clockwise, and its largest distance across.
    Polygon(Arc<[Vector2<f64>]>, f64),
}

impl Outline {
    pub(crate) fn of(block: &BlockScene) -> Self {
        match &block.polygon {
            None => Self::Rectangle([block.width, block.height]),
            Some(corners) => Self::Polygon(Arc::clone(corners), 2.0 * block.radius()),
        }
    }
}

/// A rectangle or a polygon in the plane.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlacedOutline {
    centre: [f64; 2],
    /// Unit vectors along its sides.
    axes: [[f64; 2]; 2],
    /// Half its sides; for a polygon, those of a square around it.
    half: [f64; 2],
    /// The corners of a polygon about its centre, in the coordinates of its axes.
    corners: Option<Arc<[Vector2<f64>]>>,
}

/// Two overlapping outlines, by their numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Overlap {
    pub(crate) first: usize,
    pub(crate) second: usize,
    /// The least displacement that separates them, m.
    pub(crate) depth: f64,
}

impl PlacedOutline {
    pub(crate) fn new(centre: [f64; 2], angle: f64, outline: &Outline) -> Self {
        let (sin, cos) = angle.sin_cos();
        let (sides, corners) = match outline {
            Outline::Rectangle(sides) => (*sides, None),
            Outline::Polygon(corners, across) => ([*across; 2], Some(Arc::clone(corners))),
        };
        Self { centre, axes: [[cos, sin], [-sin, cos]], half: sides.map(|side| 0.5 * side), corners }
    }

    fn world(&self, corner: &Vector2<f64>) -> [f64; 2] {
        [0, 1].map(|k| self.centre[k] + corner.x * self.axes[0][k] + corner.y * self.axes[1][k])
    }

    /// The sides of a polygon: a corner, and the outward unit normal of the side that starts there.
    fn sides<'a>(&'a self, corners: &'a [Vector2<f64>]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + 'a {
        corners.iter().zip(corners.iter().cycle().skip(1)).map(|(from, to)| {
            let side = (to - from).normalize();
            let normal = [0, 1].map(|k| side.y * self.axes[0][k] - side.x * self.axes[1][k]);
            (self.world(from), normal)
        })
    }

    /// How deep a point is inside, m; negative outside.
    pub(crate) fn depth_of(&self, point: [f64; 2]) -> f64 {
        if let Some(corners) = &self.corners {
            let depth = |(on, normal): ([f64; 2], [f64; 2])| dot([on[0] - point[0], on[1] - point[1]], normal);
            return self.sides(corners).map(depth).fold(f64::INFINITY, f64::min);
        }
        let from = [point[0] - self.centre[0], point[1] - self.centre[1]];
        let room = |k: usize| self.half[k] - dot(from, self.axes[k]).abs();
        room(0).min(room(1))
    }

    /// Its projection on a direction: from where to where it extends.
    pub(crate) fn projection(&self, direction: [f64; 2]) -> [f64; 2] {
        let Some(corners) = &self.corners else {
            let (centre, reach) = (dot(self.centre, direction), self.reach(direction));
            return [centre - reach, centre + reach];
        };
        let along = corners.iter().map(|corner| dot(self.world(corner), direction));
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }

    /// Half the projection of a rectangle on a direction.
    fn reach(&self, direction: [f64; 2]) -> f64 {
        self.half[0] * dot(self.axes[0], direction).abs() + self.half[1] * dot(self.axes[1], direction).abs()
    }

    fn largest_side(&self) -> f64 {
        2.0 * self.half[0].max(self.half[1])
    }

    /// The least displacement that separates the two; at most 0 if they are separate.
    fn depth(&self, other: &Self) -> f64 {
        if self.corners.is_some() || other.corners.is_some() {
            return self.depth_across_sides(other).min(other.depth_across_sides(self));
        }
        let between = [other.centre[0] - self.centre[0], other.centre[1] - self.centre[1]];
        self.axes
            .iter()
            .chain(&other.axes)
            .map(|&axis| self.reach(axis) + other.reach(axis) - dot(between, axis).abs())
            .fold(f64::INFINITY, f64::min)
    }

    /// How deep the other is inside, measured across the side with the least depth.
    fn depth_across_sides(&self, other: &Self) -> f64 {
        let over = |(on, normal): ([f64; 2], [f64; 2])| dot(on, normal) - other.projection(normal)[0];
        let [[ax, ay], up] = self.axes;
        match &self.corners {
            Some(corners) => self.sides(corners).map(over).fold(f64::INFINITY, f64::min),
            None => [[ax, ay], up, [-ax, -ay], [-up[0], -up[1]]]
                .into_iter()
                .map(|normal| self.projection(normal)[1] - other.projection(normal)[0])
                .fold(f64::INFINITY, f64::min),
        }
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Most pairs that are checked; in a larger heap of blocks only what was found counts.
const MOST_PAIRS: usize = 1_000_000;

/// Passes all pairs that overlap by more than both allow, m, to `each`, checking at most `most`
/// pairs of neighbours along x; `order` is a buffer.
pub(crate) fn each_overlap(
    boxes: &[PlacedOutline],
    allowed: impl Fn(usize) -> f64,
    most: usize,
    order: &mut Vec<usize>,
    mut each: impl FnMut(Overlap),
) {
    // Sorted by their left ends, as only neighbours along x can overlap.
    let left = |k: usize| boxes[k].projection([1.0, 0.0])[0];
    let right = |k: usize| boxes[k].projection([1.0, 0.0])[1];
    order.clear();
    order.extend(0..boxes.len());
    order.sort_unstable_by(|&a, &b| left(a).total_cmp(&left(b)).then(a.cmp(&b)));
    let mut pairs = 0;
    for (place, &a) in order.iter().enumerate() {
        for &b in order[place + 1..].iter().take_while(|&&b| left(b) < right(a)) {
            pairs += 1;
            let depth = boxes[a].depth(&boxes[b]);
            if depth > allowed(a).min(allowed(b)) {
                each(Overlap { first: a.min(b), second: a.max(b), depth });
            }
            if pairs > most {
                return;
            }
        }
    }
}

/// The pair with the largest overlap, if it is more than `tolerance` times the smaller one's larger
/// side.
pub(crate) fn deepest_overlap(boxes: &[PlacedOutline], tolerance: f64) -> Option<Overlap> {
    let mut deepest: Option<Overlap> = None;
    each_overlap(
        boxes,
        |k| tolerance * boxes[k].largest_side(),
        MOST_PAIRS,
        &mut Vec::new(),
        |overlap| {
            if deepest.is_none_or(|known| overlap.depth > known.depth) {
                deepest = Some(overlap);
            }
        },
    );
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_4;

    fn square(x: f64, y: f64, angle: f64) -> PlacedOutline {
        PlacedOutline::new([x, y], angle, &Outline::Rectangle([2.0, 2.0]))
    }

    #[test]
    fn the_depth_is_the_shortest_way_out() {
        let found = deepest_overlap(&[square(0.0, 0.0, 0.0), square(5.0, 0.0, 0.0), square(1.5, 1.0, 0.0)], 1e-9);
        assert_eq!(found, Some(Overlap { first: 0, second: 2, depth: 0.5 }));
    }

    /// A square by its corners, its centre elsewhere.
    #[test]
    fn a_polygon_is_as_deep_as_the_rectangle_that_it_is() {
        let corners = [[-1.5, -0.5], [0.5, -0.5], [0.5, 1.5], [-1.5, 1.5]].map(Vector2::from);
        let polygon = Outline::Polygon(Arc::from(corners.as_slice()), 4.0);
        for (x, y, angle) in [(1.5, 1.0, 0.0_f64), (0.3, 1.2, 0.4), (1.8, -0.6, 2.1), (2.4, 0.9, 5.0)] {
            let (sin, cos) = angle.sin_cos();
            let off = [x + 0.5 * cos + 0.5 * sin, y + 0.5 * sin - 0.5 * cos];
            let (by_corners, by_sides) = (PlacedOutline::new(off, angle, &polygon), square(x, y, angle));
            let still = square(0.0, 0.0, 0.0);
            assert!((still.depth(&by_corners) - still.depth(&by_sides)).abs() < 1e-14);
            assert!((by_corners.depth(&still) - still.depth(&by_sides)).abs() < 1e-14);
            assert!((by_corners.depth_of([0.9, 0.8]) - by_sides.depth_of([0.9, 0.8])).abs() < 1e-14);
        }
    }

    #[test]
    fn side_by_side_is_no_overlap() {
        assert_eq!(deepest_overlap(&[square(0.0, 0.0, 0.0), square(2.0, 0.3, 0.0)], 1e-9), None);
        assert_eq!(deepest_overlap(&[square(0.0, 0.0, 0.0), square(2.0 - 1e-10, 0.0, 0.0)], 1e-9), None);
    }

    #[test]
    fn turned_squares_are_separated_by_a_side_of_either() {
        // The bounding boxes of these overlap, corner against corner.
        let (reach, near) = (2.0_f64.sqrt(), 1.0 + 0.5 * 2.0_f64.sqrt());
        let corner = |gap: f64| [square(0.0, 0.0, 0.0), square(near + gap, near + gap, FRAC_PI_4)];
        assert_eq!(deepest_overlap(&corner(0.01), 1e-9), None);
        assert!(deepest_overlap(&corner(-0.01), 1e-9).is_some());
        let pointing = deepest_overlap(&[square(0.0, 0.0, 0.0), square(1.0 + reach - 0.1, 0.0, FRAC_PI_4)], 1e-9);
        assert!(pointing.is_some_and(|o| (o.depth - 0.1).abs() < 1e-12));
    }
}
