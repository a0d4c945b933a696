//! Shapes where their bodies are: corners, normals of sides, boxes around them.

use crate::{BodyId, Geometry, Polygon, Shape, Vector};
use std::ops::Range;

/// A shape of a body, and where its corners are among those of all polygons. A disc has none.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub(crate) body: BodyId,
    pub(crate) shape: Shape,
    pub(crate) corners: Range<usize>,
}

/// All shapes in one configuration.
#[derive(Clone, Debug, Default)]
pub(crate) struct Places {
    /// The corners of all shapes in the world.
    corners: Vec<Vector<2>>,
    /// The unit normals of the sides that begin there, out of the shape.
    normals: Vec<Vector<2>>,
    /// The smallest box around each shape, with sides along the axes.
    pub(crate) boxes: Vec<Bounds>,
}

/// A box with sides along the axes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bounds {
    pub(crate) low: Vector<2>,
    pub(crate) high: Vector<2>,
}

impl Bounds {
    /// Whether two boxes are at most `margin` (m) from each other along either axis.
    #[inline]
    pub(crate) fn near(&self, other: &Self, margin: f64) -> bool {
        (0..2).all(|k| self.low[k] - other.high[k] <= margin && other.low[k] - self.high[k] <= margin)
    }
}

/// A polygon in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedPolygon<'a> {
    pub(crate) local: &'a [Vector<2>],
    pub(crate) corners: &'a [Vector<2>],
    pub(crate) normals: &'a [Vector<2>],
}

impl Places {
    /// Places all shapes; allocates only if there are more corners than ever before.
    pub(crate) fn place(&mut self, members: &[Member], at: &dyn Geometry<2>) {
        let corners = members.last().map_or(0, |member| member.corners.end);
        self.corners.resize(corners, Vector::zeros());
        self.normals.resize(corners, Vector::zeros());
        self.boxes.resize(members.len(), Bounds::default());
        for (member, bounds) in members.iter().zip(&mut self.boxes) {
            match &member.shape {
                Shape::Polygon(polygon) => {
                    let corners = &mut self.corners[member.corners.clone()];
                    at.place(member.body, polygon.corners(), corners);
                    let normals = &mut self.normals[member.corners.clone()];
                    let (mut low, mut high) = (corners[0], corners[0]);
                    for (k, normal) in normals.iter_mut().enumerate() {
                        *normal = outward(&corners[k], &corners[if k + 1 < corners.len() { k + 1 } else { 0 }]);
                        low = low.inf(&corners[k]);
                        high = high.sup(&corners[k]);
                    }
                    *bounds = Bounds { low, high };
                }
                Shape::Disc(disc) => {
                    let mut centre = [Vector::zeros()];
                    at.place(member.body, &[*disc.centre()], &mut centre);
                    let reach = Vector::<2>::repeat(disc.radius());
                    *bounds = Bounds { low: centre[0] - reach, high: centre[0] + reach };
                }
            }
        }
    }

    /// The polygon of a member.
    pub(crate) fn polygon<'a>(&'a self, member: &Member, polygon: &'a Polygon) -> PlacedPolygon<'a> {
        let range = member.corners.clone();
        let (corners, normals) = (&self.corners[range.clone()], &self.normals[range]);
        PlacedPolygon { local: polygon.corners(), corners, normals }
    }
}

/// Where a body's frame is: its origin, and its x axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyFrame {
    origin: Vector<2>,
    axis: Vector<2>,
}

impl BodyFrame {
    pub(crate) fn of(body: BodyId, at: &dyn Geometry<2>) -> Self {
        let mut places = [Vector::zeros(); 2];
        at.place(body, &[Vector::zeros(), Vector::x()], &mut places);
        let [origin, along] = places;
        Self { origin, axis: (along - origin).normalize() }
    }

    /// A point of the body in the world.
    pub(crate) fn point(&self, local: &Vector<2>) -> Vector<2> {
        self.origin + self.turned(local)
    }

    /// A direction of the body in the world.
    pub(crate) fn turned(&self, local: &Vector<2>) -> Vector<2> {
        self.axis * local.x + Vector::<2>::new(-self.axis.y, self.axis.x) * local.y
    }

    /// A point of the world in the body.
    pub(crate) fn local(&self, place: &Vector<2>) -> Vector<2> {
        self.unturned(&(place - self.origin))
    }

    /// A direction of the world in the body.
    pub(crate) fn unturned(&self, direction: &Vector<2>) -> Vector<2> {
        Vector::<2>::new(self.axis.dot(direction), self.axis.perp(direction))
    }
}

/// The unit normal of a side of a polygon whose corners go round counter-clockwise, out of it.
#[inline]
pub(crate) fn outward(from: &Vector<2>, to: &Vector<2>) -> Vector<2> {
    let side = to - from;
    Vector::<2>::new(side.y, -side.x) / side.norm()
}
