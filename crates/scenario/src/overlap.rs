//! Overlaps of blocks by the separating-axis test.

use crate::scene::{BlockPart, BlockScene};
use nalgebra::Vector2;
use std::sync::Arc;

/// The outline of a block, about its mass centre.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Outline {
    /// A rectangle, by its sides.
    Rectangle([f64; 2]),
    /// The parts of another block, and its largest distance across.
    Parts(Arc<[BlockPart]>, f64),
}

impl Outline {
    pub(crate) fn of(block: &BlockScene) -> Self {
        match &block.parts {
            None => Self::Rectangle([block.width, block.height]),
            Some(parts) => Self::Parts(Arc::clone(parts), 2.0 * block.radius()),
        }
    }
}

/// The outline of a block in the plane.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlacedOutline {
    centre: [f64; 2],
    /// Unit vectors along its sides.
    axes: [[f64; 2]; 2],
    /// Half its sides; for other shapes, those of a square around it.
    half: [f64; 2],
    /// The parts of another shape than a rectangle, in the coordinates of its axes.
    parts: Option<Arc<[BlockPart]>>,
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
        let (sides, parts) = match outline {
            Outline::Rectangle(sides) => (*sides, None),
            Outline::Parts(parts, across) => ([*across; 2], Some(Arc::clone(parts))),
        };
        Self { centre, axes: [[cos, sin], [-sin, cos]], half: sides.map(|side| 0.5 * side), parts }
    }

    fn world(&self, corner: &Vector2<f64>) -> [f64; 2] {
        [0, 1].map(|k| self.centre[k] + corner.x * self.axes[0][k] + corner.y * self.axes[1][k])
    }

    /// The sides of a part: its ends, and the outward unit normal.
    fn sides<'a>(&'a self, core: &'a [Vector2<f64>]) -> impl Iterator<Item = ([[f64; 2]; 2], [f64; 2])> + 'a {
        let count = if core.len() > 1 { core.len() } else { 0 };
        core.iter().zip(core.iter().cycle().skip(1)).take(count).map(|(from, to)| {
            let side = (to - from).normalize();
            let normal = [0, 1].map(|k| side.y * self.axes[0][k] - side.x * self.axes[1][k]);
            ([self.world(from), self.world(to)], normal)
        })
    }

    /// How far a point is outside the core of a part, m; negative inside.
    fn outside(&self, core: &[Vector2<f64>], point: [f64; 2]) -> f64 {
        let over = |([on, _], normal): ([[f64; 2]; 2], [f64; 2])| dot([point[0] - on[0], point[1] - on[1]], normal);
        let furthest = self.sides(core).map(over).fold(f64::NEG_INFINITY, f64::max);
        // A segment has no inside.
        if furthest <= 0.0 && core.len() > 2 {
            return furthest;
        }
        let corners = core.iter().map(|corner| distance(self.world(corner), point));
        let sides = self.sides(core).map(|(ends, _)| to_line(ends, point));
        corners.chain(sides).fold(f64::INFINITY, f64::min)
    }

    /// How deep a point is inside, m; negative outside.
    pub(crate) fn depth_of(&self, point: [f64; 2]) -> f64 {
        if let Some(parts) = &self.parts {
            let depth = |part: &BlockPart| part.shape.radius() - self.outside(part.shape.core(), point);
            return parts.iter().map(depth).fold(f64::NEG_INFINITY, f64::max);
        }
        let from = [point[0] - self.centre[0], point[1] - self.centre[1]];
        let room = |k: usize| self.half[k] - dot(from, self.axes[k]).abs();
        room(0).min(room(1))
    }

    /// Its projection on a direction of unit length: from where to where it extends.
    pub(crate) fn projection(&self, direction: [f64; 2]) -> [f64; 2] {
        let Some(parts) = &self.parts else {
            let (centre, reach) = (dot(self.centre, direction), self.reach(direction));
            return [centre - reach, centre + reach];
        };
        let of = |part: &BlockPart| {
            let [low, high] = self.projection_of(part.shape.core(), direction);
            [low - part.shape.radius(), high + part.shape.radius()]
        };
        let all = parts.iter().map(of);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [a, b]| [low.min(a), high.max(b)])
    }

    /// The projection of a core on a direction.
    fn projection_of(&self, core: &[Vector2<f64>], direction: [f64; 2]) -> [f64; 2] {
        let along = core.iter().map(|corner| dot(self.world(corner), direction));
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
    pub(crate) fn depth(&self, other: &Self) -> f64 {
        if self.parts.is_some() || other.parts.is_some() {
            let (mine, others) = (self.cores(), other.cores());
            let pairs = mine.iter().flat_map(|one| others.iter().map(move |other| (one, other)));
            let depth =
                |(one, two): (&Core, &Core)| one.radius + two.radius - self.apart(&one.corners, other, &two.corners);
            return pairs.map(depth).fold(f64::NEG_INFINITY, f64::max);
        }
        let between = [other.centre[0] - self.centre[0], other.centre[1] - self.centre[1]];
        self.axes
            .iter()
            .chain(&other.axes)
            .map(|&axis| self.reach(axis) + other.reach(axis) - dot(between, axis).abs())
            .fold(f64::INFINITY, f64::min)
    }

    /// The cores of its parts.
    fn cores(&self) -> Vec<Core> {
        let [x, y] = self.half;
        match &self.parts {
            None => {
                let corners = [[-x, -y], [x, -y], [x, y], [-x, y]].map(Vector2::from).to_vec();
                vec![Core { corners, radius: 0.0 }]
            }
            Some(parts) => {
                let of = |part: &BlockPart| Core { corners: part.shape.core().to_vec(), radius: part.shape.radius() };
                parts.iter().map(of).collect()
            }
        }
    }

    /// How far the cores of two parts are apart, m; negative by the least displacement that
    /// separates them.
    fn apart(&self, mine: &[Vector2<f64>], other: &Self, theirs: &[Vector2<f64>]) -> f64 {
        let across = |a: &Self, core: &[Vector2<f64>], b: &Self, against: &[Vector2<f64>]| {
            let over =
                |([on, _], normal): ([[f64; 2]; 2], [f64; 2])| b.projection_of(against, normal)[0] - dot(on, normal);
            a.sides(core).map(over).fold(f64::NEG_INFINITY, f64::max)
        };
        let furthest = across(self, mine, other, theirs).max(across(other, theirs, self, mine));
        // What is on the line of a segment isn't on the segment: then it also has to be along it.
        let along = |a: &Self, core: &[Vector2<f64>], b: &Self, against: &[Vector2<f64>]| {
            let &[from, to] = core else { return f64::NEG_INFINITY };
            let way = (to - from).normalize();
            let way = [0, 1].map(|k| way.x * a.axes[0][k] + way.y * a.axes[1][k]);
            let ([low, high], [first, last]) = (a.projection_of(core, way), b.projection_of(against, way));
            (first - high).max(low - last)
        };
        let furthest = furthest.max(along(self, mine, other, theirs)).max(along(other, theirs, self, mine));
        if furthest <= 0.0 && furthest > f64::NEG_INFINITY {
            return furthest;
        }
        // Apart, they are nearest at a corner of one.
        let near = |a: &Self, core: &[Vector2<f64>], b: &Self, against: &[Vector2<f64>]| {
            core.iter().map(|corner| b.outside(against, a.world(corner))).fold(f64::INFINITY, f64::min)
        };
        near(self, mine, other, theirs).min(near(other, theirs, self, mine))
    }
}

/// The core of a part.
struct Core {
    corners: Vec<Vector2<f64>>,
    radius: f64,
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The distance of a point from the line between two, m; infinite past its ends.
fn to_line([from, to]: [[f64; 2]; 2], point: [f64; 2]) -> f64 {
    let (side, off) = ([to[0] - from[0], to[1] - from[1]], [point[0] - from[0], point[1] - from[1]]);
    let along = dot(side, off) / dot(side, side);
    if !(0.0..=1.0).contains(&along) {
        return f64::INFINITY;
    }
    distance(point, [from[0] + along * side[0], from[1] + along * side[1]])
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Most pairs that are checked; in a larger heap of blocks only what was found counts.
const MOST_PAIRS: usize = 1_000_000;

/// Memory for [`each_overlap`].
#[derive(Debug, Clone, Default)]
pub(crate) struct Sweep {
    /// Of each outline, from where to where it extends along x and y.
    spans: Vec<[[f64; 2]; 2]>,
    order: Vec<usize>,
}

/// From so many outlines on the sweep is along y where they are spread further along that: in a
/// tower all are neighbours along x.
const CHOOSES: usize = 200;

impl Sweep {
    pub(crate) fn with_capacity(outlines: usize) -> Self {
        Self { spans: Vec::with_capacity(outlines), order: Vec::with_capacity(outlines) }
    }

    /// Places the outlines, in the order in which they begin along an axis, which is returned.
    fn prepare(&mut self, boxes: &[PlacedOutline]) -> usize {
        let Self { spans, order } = self;
        spans.clear();
        spans.extend(boxes.iter().map(|of| [of.projection([1.0, 0.0]), of.projection([0.0, 1.0])]));
        let extent = |axis: usize| {
            let low = spans.iter().map(|span| span[axis][0]).fold(f64::INFINITY, f64::min);
            let high = spans.iter().map(|span| span[axis][1]).fold(f64::NEG_INFINITY, f64::max);
            high - low
        };
        let axis = usize::from(boxes.len() > CHOOSES && extent(1) > extent(0));
        order.clear();
        order.extend(0..boxes.len());
        order.sort_unstable_by(|&a, &b| spans[a][axis][0].total_cmp(&spans[b][axis][0]).then(a.cmp(&b)));
        axis
    }
}

/// Passes all pairs that overlap by more than both allow, m, to `each`, checking at most `most`
/// pairs of neighbours; `sweep` is a buffer.
pub(crate) fn each_overlap(
    boxes: &[PlacedOutline],
    allowed: impl Fn(usize) -> f64,
    most: usize,
    sweep: &mut Sweep,
    mut each: impl FnMut(Overlap),
) {
    // Sorted by their beginnings, as only neighbours can overlap.
    let axis = sweep.prepare(boxes);
    let Sweep { spans, order } = sweep;
    let begins = |k: usize, axis: usize| spans[k][axis][0];
    let ends = |k: usize, axis: usize| spans[k][axis][1];
    let across = 1 - axis;
    let mut pairs = 0;
    for (place, &a) in order.iter().enumerate() {
        for &b in order[place + 1..].iter().take_while(|&&b| begins(b, axis) < ends(a, axis)) {
            if begins(b, across) > ends(a, across) || begins(a, across) > ends(b, across) {
                continue;
            }
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
        &mut Sweep::default(),
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
    use teeter_detect::{Disc, Polygon, Rounded, Shape};

    fn square(x: f64, y: f64, angle: f64) -> PlacedOutline {
        PlacedOutline::new([x, y], angle, &Outline::Rectangle([2.0, 2.0]))
    }

    fn outline(shape: Shape) -> Outline {
        Outline::Parts(Arc::new([BlockPart { shape, is_rectangle: false }]), 4.0)
    }

    #[test]
    fn discs_and_roundings_are_as_far_apart_as_their_circles() {
        let disc = outline(Disc::new(Vector2::new(0.0, 0.5), 1.0).unwrap().into());
        let at = |x: f64, y: f64| PlacedOutline::new([x, y], 0.0, &disc);
        assert!((at(0.0, 0.0).depth(&at(1.2, 1.6)) - 0.0).abs() < 1e-15, "3, 4, 5");
        assert!((at(0.0, 0.0).depth(&at(0.6, 0.8)) - 1.0).abs() < 1e-15);
        // Beside the corner of a square: by the distance from that, not from its sides.
        let off = square(0.0, 0.0, 0.0).depth(&at(1.0 + 0.6, 0.5 + 0.8));
        assert!(off.abs() < 1e-15, "{off:e}");
        assert!((square(0.0, 0.0, 0.0).depth(&at(0.0, -0.5)) - 2.0).abs() < 1e-15, "as far out as a side and a radius");
        let square = Polygon::new([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Vector2::from).to_vec());
        let rounded = outline(Rounded::inside(&square.unwrap(), 0.5).unwrap().into());
        let rounded = PlacedOutline::new([0.0, 0.0], 0.0, &rounded);
        assert!((rounded.depth_of([0.5 + 0.3, 0.5 + 0.4])).abs() < 1e-15);
        assert!((rounded.depth_of([0.0, 0.75]) - 0.25).abs() < 1e-15);
        assert_eq!(rounded.projection([0.0, 1.0]), [-1.0, 1.0]);
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
        let polygon = outline(Polygon::new(corners.to_vec()).unwrap().into());
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

    /// So many that the sweep may be along either axis: the same pairs are found.
    #[test]
    fn a_tower_has_the_overlaps_of_a_row() {
        let (mut row, mut tower) = (Vec::new(), Vec::new());
        for k in 0..2 * CHOOSES {
            // Every third one is too near to the one before.
            let along = 2.0 * k as f64 - if k % 3 == 2 { 0.1 } else { 0.0 };
            row.push(square(along, 0.0, 0.0));
            tower.push(square(0.0, along, 0.0));
        }
        let found = |boxes: &[PlacedOutline]| {
            let mut found = Vec::new();
            each_overlap(boxes, |_| 1e-9, MOST_PAIRS, &mut Sweep::default(), |of| found.push((of.first, of.second)));
            found
        };
        let pairs: Vec<_> = (0..2 * CHOOSES).filter(|k| k % 3 == 2).map(|k| (k - 1, k)).collect();
        assert_eq!(found(&row), pairs);
        assert_eq!(found(&tower), pairs);
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
