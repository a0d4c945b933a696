//! Shapes where their bodies are: corners, normals of sides, boxes around them.

use crate::{BodyId, Geometry, Shape, Vector};
use std::ops::Range;

/// The shapes of all bodies, in the order of these.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shapes {
    pub(crate) members: Vec<Member>,
    pub(crate) parts: Vec<Part>,
    /// The corners of all cores, each in the coordinates of its body.
    local: Vec<Vector<2>>,
    /// The unit normals of the sides that begin there, out of the core.
    normals: Vec<Vector<2>>,
    /// Whether anything is round.
    is_round: bool,
}

/// A body that has a shape, of one part or more.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub(crate) body: BodyId,
    pub(crate) parts: Range<usize>,
    /// Where the corners of all its parts are among those of all bodies.
    corners: Range<usize>,
}

/// A convex part of a body's shape.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Where its corners are among those of all bodies.
    corners: Range<usize>,
    /// The number of its first corner within its body.
    pub(crate) first: usize,
    pub(crate) radius: f64,
}

impl Shapes {
    /// The shapes of bodies; several of one body are its parts, in their order.
    pub(crate) fn new(mut shapes: Vec<(BodyId, Shape)>) -> Self {
        shapes.sort_by_key(|(body, _)| *body);
        let mut all = Self::default();
        for (body, shape) in shapes {
            if all.members.last().is_none_or(|last| last.body != body) {
                let (part, corner) = (all.parts.len(), all.local.len());
                all.members.push(Member { body, parts: part..part, corners: corner..corner });
            }
            let start = all.local.len();
            let core = shape.core();
            all.local.extend_from_slice(core);
            all.normals.extend(core.iter().zip(core.iter().cycle().skip(1)).map(|(from, to)| outward(from, to)));
            all.is_round |= shape.radius() > 0.0;
            if let Some(member) = all.members.last_mut() {
                let first = start - member.corners.start;
                all.parts.push(Part { corners: start..all.local.len(), first, radius: shape.radius() });
                member.parts.end = all.parts.len();
                member.corners.end = all.local.len();
            }
        }
        all
    }

    /// The number of the member of a body.
    pub(crate) fn member_of(&self, body: BodyId) -> Option<usize> {
        self.members.binary_search_by_key(&body, |member| member.body).ok()
    }

    /// The part of a member to which a corner of this number belongs.
    pub(crate) fn part_of(&self, member: usize, corner: usize) -> Option<usize> {
        let parts = self.members[member].parts.clone();
        let found = self.parts[parts.clone()].iter().position(|part| part.holds(corner));
        found.map(|k| parts.start + k)
    }

    /// The corners of a part, in the coordinates of its body.
    pub(crate) fn local(&self, part: usize) -> &[Vector<2>] {
        &self.local[self.parts[part].corners.clone()]
    }

    /// A part of a body whose frame is there.
    pub(crate) fn outline(&self, part: usize, frame: BodyFrame) -> Outline<'_> {
        let Part { corners, first, radius } = &self.parts[part];
        let (corners, normals) = (&self.local[corners.clone()], &self.normals[corners.clone()]);
        Outline { first: *first, corners, normals, radius: *radius, frame }
    }

    /// Whether a corner of a member belongs to a part without a radius.
    pub(crate) fn is_sharp_at(&self, member: usize, corner: usize) -> bool {
        self.part_of(member, corner).is_some_and(|part| self.parts[part].radius == 0.0)
    }

    /// How many corners a member has.
    pub(crate) fn corners_of(&self, member: usize) -> usize {
        self.members[member].corners.len()
    }

    /// The body with the most corners, and how many it has.
    pub(crate) fn largest(&self) -> Option<(BodyId, usize)> {
        self.members.iter().map(|member| (member.body, member.corners.len())).max_by_key(|(_, corners)| *corners)
    }
}

/// A part of a shape in the coordinates of its body, and where that is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outline<'a> {
    /// The number of its first corner within its body.
    pub(crate) first: usize,
    pub(crate) corners: &'a [Vector<2>],
    pub(crate) normals: &'a [Vector<2>],
    pub(crate) radius: f64,
    pub(crate) frame: BodyFrame,
}

/// The cosine of the angle, 8°, up to which a side faces a direction.
const TOWARDS: f64 = 0.99;

impl Outline<'_> {
    /// The normals of its sides, in the world, that are within 8° of a direction.
    pub(crate) fn facing(&self, direction: &Vector<2>) -> impl Iterator<Item = Vector<2>> {
        let has_sides = self.corners.len() > 1;
        let normals = self.normals.iter().filter(move |_| has_sides).map(|normal| self.frame.turned(normal));
        normals.filter(move |normal| normal.dot(direction) > TOWARDS)
    }

    /// How far it reaches along a unit direction of the world, m.
    pub(crate) fn extent(&self, direction: &Vector<2>) -> f64 {
        let of = |corner: &Vector<2>| direction.dot(&self.frame.point(corner));
        self.corners.iter().map(of).fold(f64::NEG_INFINITY, f64::max) + self.radius
    }
}

impl Part {
    fn holds(&self, corner: usize) -> bool {
        (self.first..self.first + self.corners.len()).contains(&corner)
    }
}

/// All shapes in one configuration.
#[derive(Clone, Debug, Default)]
pub(crate) struct Places {
    /// The corners of all cores in the world.
    corners: Vec<Vector<2>>,
    /// The unit normals of the sides that begin there, out of the shape.
    normals: Vec<Vector<2>>,
    /// Of each member: the smallest box around it, with sides along the axes.
    pub(crate) boxes: Vec<Bounds>,
    /// Of each member, where anything is round: its frame.
    frames: Vec<BodyFrame>,
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

    /// Larger by `margin` (m) all around.
    pub(crate) fn grown(&self, margin: f64) -> Self {
        let margin = Vector::<2>::repeat(margin);
        Self { low: self.low - margin, high: self.high + margin }
    }

    /// Whether another box is within this one.
    pub(crate) fn holds(&self, other: &Self) -> bool {
        (0..2).all(|k| self.low[k] <= other.low[k] && other.high[k] <= self.high[k])
    }
}

/// A part of a shape in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedPart<'a> {
    /// The number of its first corner within its body.
    pub(crate) first: usize,
    pub(crate) local: &'a [Vector<2>],
    pub(crate) corners: &'a [Vector<2>],
    pub(crate) normals: &'a [Vector<2>],
}

impl Places {
    /// Places all shapes; allocates only if there are more corners than ever before.
    pub(crate) fn place(&mut self, shapes: &Shapes, at: &dyn Geometry<2>) {
        self.resize(shapes);
        for number in 0..shapes.members.len() {
            self.place_one(shapes, at, number);
        }
    }

    /// Makes room for all shapes.
    pub(crate) fn resize(&mut self, shapes: &Shapes) {
        self.corners.resize(shapes.local.len(), Vector::zeros());
        self.normals.resize(shapes.local.len(), Vector::zeros());
        self.boxes.resize(shapes.members.len(), Bounds::default());
        self.frames.resize(shapes.members.len(), BodyFrame::default());
    }

    /// Places the shape of one member, for which there is room.
    pub(crate) fn place_one(&mut self, shapes: &Shapes, at: &dyn Geometry<2>, number: usize) {
        let member = &shapes.members[number];
        let all = member.corners.clone();
        at.place(member.body, &shapes.local[all.clone()], &mut self.corners[all]);
        if shapes.is_round {
            self.frames[number] = BodyFrame::of(member.body, at);
        }
        let mut bounds = Bounds { low: Vector::repeat(f64::INFINITY), high: Vector::repeat(f64::NEG_INFINITY) };
        for part in &shapes.parts[member.parts.clone()] {
            let corners = &self.corners[part.corners.clone()];
            let normals = &mut self.normals[part.corners.clone()];
            let (mut low, mut high) = (corners[0], corners[0]);
            for (k, normal) in normals.iter_mut().enumerate() {
                *normal = outward(&corners[k], &corners[if k + 1 < corners.len() { k + 1 } else { 0 }]);
                low = low.inf(&corners[k]);
                high = high.sup(&corners[k]);
            }
            let reach = Vector::<2>::repeat(part.radius);
            bounds = Bounds { low: bounds.low.inf(&(low - reach)), high: bounds.high.sup(&(high + reach)) };
        }
        self.boxes[number] = bounds;
    }

    /// A part in the world.
    pub(crate) fn part<'a>(&'a self, shapes: &'a Shapes, part: usize) -> PlacedPart<'a> {
        let Part { corners: range, first, .. } = &shapes.parts[part];
        PlacedPart {
            first: *first,
            local: &shapes.local[range.clone()],
            corners: &self.corners[range.clone()],
            normals: &self.normals[range.clone()],
        }
    }

    /// A part in the coordinates of its member.
    pub(crate) fn outline<'a>(&self, shapes: &'a Shapes, member: usize, part: usize) -> Outline<'a> {
        shapes.outline(part, self.frames[member])
    }
}

/// Where a body's frame is: its origin, and its x axis.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BodyFrame {
    origin: Vector<2>,
    axis: Vector<2>,
}

impl BodyFrame {
    /// A frame at a place, turned by an angle (rad).
    #[cfg(test)]
    pub(crate) fn at(origin: Vector<2>, angle: f64) -> Self {
        Self { origin, axis: Vector::<2>::new(angle.cos(), angle.sin()) }
    }

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
