//! Convex blocks on a ground, and the joints between them.

use super::LimitError;
use nalgebra::Vector2;

/// A point or a vector of the plane.
pub type Point = Vector2<f64>;

/// Edges count as touching within this share of the assemblage's extent: a corner computed by sines is off by a few
/// roundings only, and a gap of a thousandth of a millimetre in a metre is open.
const TOUCHING: f64 = 1e-9;

/// A rigid block.
#[derive(Clone, Debug)]
pub struct Block {
    /// Corners of a convex polygon, counter-clockwise.
    pub polygon: Vec<Point>,
    /// Its weight, in any unit that all blocks share.
    pub weight: f64,
    /// Where the weight acts.
    pub centroid: Point,
}

impl Block {
    /// A block of uniform density: `weight_per_area` times its area, at its centroid.
    ///
    /// # Errors
    ///
    /// [`LimitError::NoPolygon`] where the corners aren't those of a convex polygon, counter-clockwise.
    pub fn uniform(polygon: Vec<Point>, weight_per_area: f64) -> Result<Self, LimitError> {
        check_polygon(&polygon)?;
        let first = polygon[0];
        let (mut area, mut moment) = (0.0, Point::zeros());
        for pair in polygon[1..].windows(2) {
            let (a, b) = (pair[0] - first, pair[1] - first);
            let part = 0.5 * a.perp(&b);
            area += part;
            moment += (a + b) * (part / 3.0);
        }
        Self::with_weight(polygon, weight_per_area * area, first + moment / area)
    }

    /// A block whose weight isn't that of its polygon.
    ///
    /// # Errors
    ///
    /// [`LimitError::NoPolygon`] as [`Block::uniform`]; [`LimitError::NoWeight`] where the weight isn't positive.
    pub fn with_weight(polygon: Vec<Point>, weight: f64, centroid: Point) -> Result<Self, LimitError> {
        check_polygon(&polygon)?;
        if !(weight > 0.0 && weight.is_finite() && centroid.iter().all(|c| c.is_finite())) {
            return Err(LimitError::NoWeight);
        }
        Ok(Self { polygon, weight, centroid })
    }
}

/// What a joint presses on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// A block, by its index.
    Block(usize),
    /// What doesn't move.
    Ground,
}

/// A segment that two polygons share.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// The two sides. At most one is the ground, and then it is the second.
    pub sides: [Side; 2],
    /// The ends of the segment.
    pub ends: [Point; 2],
    /// Unit normal from the second side into the first.
    pub normal: Point,
}

/// Blocks at rest on a ground, with all joints where edges lie on one another.
///
/// Blocks that touch by a corner only have no joint.
#[derive(Clone, Debug)]
pub struct Assemblage {
    blocks: Vec<Block>,
    joints: Vec<Joint>,
    down: Point,
}

impl Assemblage {
    /// Finds the joints of `blocks` among each other and with the polygons of the ground. Weight acts along −y.
    ///
    /// # Errors
    ///
    /// [`LimitError::Empty`] without a block, [`LimitError::NoPolygon`] where a polygon of the ground isn't one.
    pub fn new(blocks: Vec<Block>, ground: &[Vec<Point>]) -> Result<Self, LimitError> {
        if blocks.is_empty() {
            return Err(LimitError::Empty);
        }
        ground.iter().try_for_each(|polygon| check_polygon(polygon))?;
        let extent = extent(blocks.iter().flat_map(|block| &block.polygon));
        let mut joints = Vec::new();
        for (i, block) in blocks.iter().enumerate() {
            for (j, other) in blocks.iter().enumerate().skip(i + 1) {
                let sides = [Side::Block(i), Side::Block(j)];
                joints.extend(shared(&block.polygon, &other.polygon, sides, TOUCHING * extent));
            }
            for polygon in ground {
                let sides = [Side::Block(i), Side::Ground];
                joints.extend(shared(&block.polygon, polygon, sides, TOUCHING * extent));
            }
        }
        Ok(Self { blocks, joints, down: Point::new(0.0, -1.0) })
    }

    /// The same with all of it turned by `angle` (rad) against gravity: its −x side goes down.
    #[must_use]
    pub fn tilted(mut self, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        self.down = Point::new(cos * self.down.x + sin * self.down.y, cos * self.down.y - sin * self.down.x);
        self
    }

    /// Its blocks.
    #[must_use]
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Its joints.
    #[must_use]
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Unit vector along which weight acts.
    #[must_use]
    pub fn down(&self) -> Point {
        self.down
    }

    /// The larger side of the box around the blocks.
    #[must_use]
    pub fn extent(&self) -> f64 {
        extent(self.blocks.iter().flat_map(|block| &block.polygon))
    }
}

fn extent<'a>(points: impl Iterator<Item = &'a Point>) -> f64 {
    let start = (Point::repeat(f64::INFINITY), Point::repeat(f64::NEG_INFINITY));
    let (low, high) = points.fold(start, |(low, high), p| (low.inf(p), high.sup(p)));
    (high - low).max()
}

fn check_polygon(polygon: &[Point]) -> Result<(), LimitError> {
    let n = polygon.len();
    let turns_left = |i: usize| {
        let [a, b, c] = [0, 1, 2].map(|k| polygon[(i + k) % n]);
        (b - a).perp(&(c - b)) > 0.0
    };
    let finite = polygon.iter().flatten().all(|c| c.is_finite());
    if n >= 3 && finite && (0..n).all(turns_left) { Ok(()) } else { Err(LimitError::NoPolygon) }
}

/// The joints of two polygons: the overlaps of edges that run against each other on one line.
fn shared(first: &[Point], second: &[Point], sides: [Side; 2], tolerance: f64) -> Vec<Joint> {
    let mut joints = Vec::new();
    for [a, b] in edges(first) {
        let length = (b - a).norm();
        let along = (b - a) / length;
        let inwards = Point::new(-along.y, along.x);
        for [c, d] in edges(second) {
            // In the first edge's frame the second runs from `from` down to `to`.
            let [from, to] = [c, d].map(|p| (p - a).dot(&along));
            let (low, high) = (to.max(0.0), from.min(length));
            if high - low <= tolerance {
                continue;
            }
            let off = |x: f64| {
                let share = (x - from) / (to - from);
                (c + (d - c) * share - a).dot(&inwards).abs()
            };
            if off(low) <= tolerance && off(high) <= tolerance {
                joints.push(Joint { sides, ends: [a + along * low, a + along * high], normal: inwards });
            }
        }
    }
    joints
}

fn edges(polygon: &[Point]) -> impl Iterator<Item = [Point; 2]> + '_ {
    (0..polygon.len()).map(|i| [polygon[i], polygon[(i + 1) % polygon.len()]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64) -> Vec<Point> {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(a, b)| Point::new(x + a, y + b)).to_vec()
    }

    #[test]
    fn a_joint_is_where_edges_overlap() -> Result<(), LimitError> {
        let blocks = vec![Block::uniform(square(0.0, 0.0), 1.0)?, Block::uniform(square(0.25, 1.0), 1.0)?];
        let table = vec![Point::new(-1.0, -1.0), Point::new(0.75, -1.0), Point::new(0.75, 0.0), Point::new(-1.0, 0.0)];
        let assemblage = Assemblage::new(blocks, &[table])?;
        let [lower, upper] = assemblage.joints() else { panic!("{:?}", assemblage.joints()) };
        let (lower, upper) = if lower.sides[1] == Side::Ground { (lower, upper) } else { (upper, lower) };
        assert_eq!(lower.ends, [Point::new(0.0, 0.0), Point::new(0.75, 0.0)]);
        assert_eq!((lower.sides, lower.normal), ([Side::Block(0), Side::Ground], Point::new(0.0, 1.0)));
        assert_eq!(upper.ends, [Point::new(1.0, 1.0), Point::new(0.25, 1.0)]);
        assert_eq!((upper.sides, upper.normal), ([Side::Block(0), Side::Block(1)], Point::new(0.0, -1.0)));
        Ok(())
    }

    #[test]
    fn corners_alone_and_gaps_make_no_joint() -> Result<(), LimitError> {
        for place in [(1.0, 1.0), (0.5, 1.0 + 1e-6), (1.0 + 1e-6, 0.5)] {
            let blocks = vec![Block::uniform(square(0.0, 0.0), 1.0)?, Block::uniform(square(place.0, place.1), 1.0)?];
            assert!(Assemblage::new(blocks, &[])?.joints().is_empty(), "{place:?}");
        }
        Ok(())
    }

    #[test]
    fn weight_acts_at_the_centroid() -> Result<(), LimitError> {
        let triangle = [(1.0, 0.0), (4.0, 0.0), (1.0, 6.0)].map(|(x, y)| Point::new(x, y)).to_vec();
        let block = Block::uniform(triangle, 2.0)?;
        assert!((block.weight - 18.0).abs() < 1e-14 && (block.centroid - Point::new(2.0, 2.0)).norm() < 1e-14);
        Ok(())
    }

    #[test]
    fn clockwise_or_hollow_polygons_are_refused() {
        let mut clockwise = square(0.0, 0.0);
        clockwise.reverse();
        assert_eq!(Block::uniform(clockwise, 1.0).err(), Some(LimitError::NoPolygon));
        let mut hollow = square(0.0, 0.0);
        hollow[2] = Point::new(0.1, 0.1);
        assert_eq!(Block::uniform(hollow, 1.0).err(), Some(LimitError::NoPolygon));
        assert_eq!(Block::uniform(square(0.0, 0.0), 0.0).err(), Some(LimitError::NoWeight));
        assert_eq!(Assemblage::new(Vec::new(), &[]).err(), Some(LimitError::Empty));
    }
}
