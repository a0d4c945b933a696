//! Rectangles that overlap: the separating-axis test.

/// A rectangle in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Box2 {
    centre: [f64; 2],
    /// Unit vectors along its sides.
    axes: [[f64; 2]; 2],
    /// Halves of its sides.
    half: [f64; 2],
}

/// Two rectangles that overlap, by their numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Overlap {
    pub(crate) first: usize,
    pub(crate) second: usize,
    /// The shortest way out.
    pub(crate) depth: f64,
}

impl Box2 {
    pub(crate) fn new(centre: [f64; 2], angle: f64, sides: [f64; 2]) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { centre, axes: [[cos, sin], [-sin, cos]], half: sides.map(|side| 0.5 * side) }
    }

    /// How deep a point is inside, m; negative outside.
    pub(crate) fn depth_of(&self, point: [f64; 2]) -> f64 {
        let from = [point[0] - self.centre[0], point[1] - self.centre[1]];
        let room = |k: usize| self.half[k] - dot(from, self.axes[k]).abs();
        room(0).min(room(1))
    }

    /// The centre along a direction, and how far it reaches to either side of that.
    pub(crate) fn shadow(&self, direction: [f64; 2]) -> (f64, f64) {
        (dot(self.centre, direction), self.reach(direction))
    }

    /// Half of its shadow on a direction.
    fn reach(&self, direction: [f64; 2]) -> f64 {
        self.half[0] * dot(self.axes[0], direction).abs() + self.half[1] * dot(self.axes[1], direction).abs()
    }

    fn largest_side(&self) -> f64 {
        2.0 * self.half[0].max(self.half[1])
    }

    /// The shortest way out of each other; at most 0 where some side's direction separates the two.
    fn depth(&self, other: &Self) -> f64 {
        let between = [other.centre[0] - self.centre[0], other.centre[1] - self.centre[1]];
        self.axes
            .iter()
            .chain(&other.axes)
            .map(|&axis| self.reach(axis) + other.reach(axis) - dot(between, axis).abs())
            .fold(f64::INFINITY, f64::min)
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Pairs that are looked at; past it a heap of blocks is judged by what was found.
const MOST_PAIRS: usize = 1_000_000;

/// Hands all that overlap by more than both allow, m, to `each`, as far as `most` pairs of neighbours along x tell; `order` is memory.
pub(crate) fn each_overlap(
    boxes: &[Box2],
    allowed: impl Fn(usize) -> f64,
    most: usize,
    order: &mut Vec<usize>,
    mut each: impl FnMut(Overlap),
) {
    // By their left ends: only neighbours along x can overlap.
    let left = |k: usize| boxes[k].centre[0] - boxes[k].reach([1.0, 0.0]);
    let right = |k: usize| boxes[k].centre[0] + boxes[k].reach([1.0, 0.0]);
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

/// The two that overlap the most, of all that do by more than `tolerance` of the smaller one's larger side.
pub(crate) fn deepest_overlap(boxes: &[Box2], tolerance: f64) -> Option<Overlap> {
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

    fn square(x: f64, y: f64, angle: f64) -> Box2 {
        Box2::new([x, y], angle, [2.0, 2.0])
    }

    #[test]
    fn the_depth_is_the_shortest_way_out() {
        let found = deepest_overlap(&[square(0.0, 0.0, 0.0), square(5.0, 0.0, 0.0), square(1.5, 1.0, 0.0)], 1e-9);
        assert_eq!(found, Some(Overlap { first: 0, second: 2, depth: 0.5 }));
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
