//! Where two shapes touch: corners against sides of polygons, the nearest points of discs.

use crate::placed::{BodyFrame, Member, PlacedPolygon, outward};
use crate::{BodyId, Disc, Geometry, Polygon, Shape, Vector};

/// A corner of one shape, and the side of the other that it is over: what makes a contact of two polygons the same from step to step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CornerOnSide {
    /// Which of the pair's two bodies has the corner.
    pub owner: usize,
    /// The corner's number.
    pub corner: usize,
    /// The number of the other body's side: it goes from the corner of this number to the next.
    pub side: usize,
}

impl CornerOnSide {
    /// The number of the feature within its pair, by which a contact's identity names it. Those of two polygons are above that of a
    /// disc, 0.
    #[must_use]
    pub fn number(self) -> u32 {
        ((self.owner as u32) << 31 | (self.corner as u32) << 16 | self.side as u32) + 1
    }

    /// The feature of that number; `None` for that of a disc.
    #[must_use]
    pub fn from_number(number: u32) -> Option<Self> {
        let number = number.checked_sub(1)?;
        let (corner, side) = ((number >> 16) & 0x7fff, number & 0xffff);
        Some(Self { owner: (number >> 31) as usize, corner: corner as usize, side: side as usize })
    }
}

/// The number of the only feature of a pair with a disc.
pub(crate) const OF_DISC: u32 = 0;

/// Two shapes that are near each other at a point of each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub(crate) feature: u32,
    /// The points, in the coordinates of their bodies.
    pub(crate) points: [Vector<2>; 2],
    /// The unit normal, from the second to the first.
    pub(crate) normal: Vector<2>,
    pub(crate) gap: f64,
    /// How far it is to the nearest end of its side, m: negative past it, infinite for a disc.
    pub(crate) room: f64,
}

/// A corner is over a side as far as this part of its length past the side's ends: what is in line there up to rounding stays so.
const BESIDE: f64 = 1e-12;

/// A contact that is known stays over its side as far as this part past its ends, so that none is lost where it is found again, and what
/// touches instead is found where it has left. Joints of an arch slip by some 1e-11 of their length a second, as far as solvers are exact: a corner beside
/// its twin must not be lost by that.
const STILL_BESIDE: f64 = 1e-9;

/// Of two sides that part polygons equally, up to this part of a side's length, the first shape's is taken.
const EQUAL: f64 = 1e-9;

/// The points at which two shapes are near each other, at most two of them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Touches([Option<Touch>; 2]);

impl Touches {
    /// In the order of their features.
    pub(crate) fn into_iter(self) -> impl Iterator<Item = Touch> {
        let [first, second] = self.0;
        let swap = matches!((&first, &second), (Some(a), Some(b)) if a.feature > b.feature);
        let sorted = if swap { [second, first] } else { [first, second] };
        sorted.into_iter().flatten()
    }
}

/// The contact of two shapes of which one is a disc at least; `None` where their centres are in one place.
pub(crate) fn with_disc(at: &dyn Geometry<2>, [a, b]: [&Member; 2]) -> Option<Touch> {
    let frames = [a, b].map(|member| BodyFrame::of(member.body, at));
    match (&a.shape, &b.shape) {
        (Shape::Disc(first), Shape::Disc(second)) => {
            let apart = frames[0].point(first.centre()) - frames[1].point(second.centre());
            let distance = apart.norm();
            // Written so that NaN fails too.
            if !(distance > 0.0) {
                return None;
            }
            let normal = apart / distance;
            let points = [
                first.centre() - frames[0].unturned(&normal) * first.radius(),
                second.centre() + frames[1].unturned(&normal) * second.radius(),
            ];
            Some(Touch {
                feature: OF_DISC,
                points,
                normal,
                gap: distance - first.radius() - second.radius(),
                room: f64::INFINITY,
            })
        }
        (Shape::Disc(disc), Shape::Polygon(polygon)) => {
            let (foot, [on_disc, on_polygon]) = disc_on_polygon(disc, polygon, frames)?;
            let normal = frames[1].turned(&foot.normal);
            Some(Touch {
                feature: OF_DISC,
                points: [on_disc, on_polygon],
                normal,
                gap: foot.distance - disc.radius(),
                room: f64::INFINITY,
            })
        }
        (Shape::Polygon(polygon), Shape::Disc(disc)) => {
            let (foot, [on_disc, on_polygon]) = disc_on_polygon(disc, polygon, [frames[1], frames[0]])?;
            let normal = -frames[0].turned(&foot.normal);
            Some(Touch {
                feature: OF_DISC,
                points: [on_polygon, on_disc],
                normal,
                gap: foot.distance - disc.radius(),
                room: f64::INFINITY,
            })
        }
        (Shape::Polygon(_), Shape::Polygon(_)) => None,
    }
}

/// The point of a polygon's outline that is nearest to a point, the way there, out of the polygon, and the distance, negative inside.
struct Nearest {
    place: Vector<2>,
    normal: Vector<2>,
    distance: f64,
}

/// The nearest points of disc and polygon, each in its own body.
fn disc_on_polygon(
    disc: &Disc,
    polygon: &Polygon,
    [of_disc, of_polygon]: [BodyFrame; 2],
) -> Option<(Nearest, [Vector<2>; 2])> {
    let foot = nearest(polygon.corners(), &of_polygon.local(&of_disc.point(disc.centre())))?;
    let to_polygon = of_disc.unturned(&of_polygon.turned(&foot.normal));
    let points = [disc.centre() - to_polygon * disc.radius(), foot.place];
    Some((foot, points))
}

fn nearest(corners: &[Vector<2>], to: &Vector<2>) -> Option<Nearest> {
    let mut best: Option<(usize, Vector<2>, f64)> = None;
    for (k, corner) in corners.iter().enumerate() {
        let normal = outward(corner, &corners[(k + 1) % corners.len()]);
        let height = normal.dot(&(to - corner));
        if best.is_none_or(|(_, _, known)| height > known) {
            best = Some((k, normal, height));
        }
    }
    let (k, normal, distance) = best?;
    let side = corners[(k + 1) % corners.len()] - corners[k];
    let along = (to - corners[k]).dot(&side) / side.norm_squared();
    let place = corners[k] + side * along.clamp(0.0, 1.0);
    let beside = to - place;
    if distance > 0.0 && !(0.0..=1.0).contains(&along) {
        let distance = beside.norm();
        return Some(Nearest { place, normal: beside / distance, distance });
    }
    Some(Nearest { place, normal, distance })
}

/// The contact of two polygons that is known by its feature, past the ends of the side as well; `None` where there is no such feature.
pub(crate) fn feature_of(at: &dyn Geometry<2>, bodies: [(BodyId, &Polygon); 2], feature: u32) -> Option<Touch> {
    let feature = CornerOnSide::from_number(feature)?;
    let [(body, mine), (other_body, other)] = if feature.owner == 0 { bodies } else { [bodies[1], bodies[0]] };
    let corner = *mine.corners().get(feature.corner)?;
    let side = [*other.corners().get(feature.side)?, other.corners()[(feature.side + 1) % other.corners().len()]];
    let (mut place, mut ends) = ([Vector::zeros()], [Vector::zeros(); 2]);
    at.place(body, &[corner], &mut place);
    at.place(other_body, &side, &mut ends);
    let side = Side { local: side, ends, normal: outward(&ends[0], &ends[1]) };
    corner_on_side(feature, (corner, place[0]), &side)
}

/// The side of a polygon that parts it best from another, and how far they are apart along its normal; a side by which that is more
/// than `enough` (m) ends the search.
fn best_side(of: &PlacedPolygon<'_>, other: &PlacedPolygon<'_>, enough: f64) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    for (k, (corner, normal)) in of.corners.iter().zip(of.normals).enumerate() {
        let apart = other.corners.iter().map(|x| normal.dot(&(x - corner))).fold(f64::INFINITY, f64::min);
        if best.is_none_or(|(_, known)| apart > known) {
            best = Some((k, apart));
        }
        if apart > enough {
            break;
        }
    }
    best
}

/// Finds where two polygons are near each other, if they are at most `margin` (m) apart.
pub(crate) fn polygons(a: &PlacedPolygon<'_>, b: &PlacedPolygon<'_>, margin: f64) -> Touches {
    let none = Touches::default();
    let (Some((side_a, apart_a)), Some((side_b, apart_b))) = (best_side(a, b, margin), best_side(b, a, margin)) else {
        return none;
    };
    if apart_a > margin || apart_b > margin {
        return none;
    }
    let first = apart_a + EQUAL * a.length(side_a).min(b.length(side_b)) >= apart_b;
    let (owner, side) = if first { (0, side_a) } else { (1, side_b) };
    let [mine, other] = if first { [a, b] } else { [b, a] };
    // The side of the other that faces it.
    let normal = mine.normals[side];
    let facing = |i: &usize, j: &usize| normal.dot(&other.normals[*i]).total_cmp(&normal.dot(&other.normals[*j]));
    let Some(facing) = (0..other.corners.len()).min_by(|i, j| facing(i, j).then(i.cmp(j))) else {
        return none;
    };
    let (next, facing_next) = (mine.next(side), other.next(facing));
    let along = Vector::<2>::new(-normal.y, normal.x);
    let place = |x: &Vector<2>| along.dot(&(x - mine.corners[side]));
    let (end, tolerance) = (place(&mine.corners[next]), BESIDE * mine.length(side).min(other.length(facing)));
    // As they face each other, one begins where the other ends.
    let ends = [(facing_next, place(&other.corners[facing_next])), (facing, place(&other.corners[facing]))];
    let ends = if ends[0].1 <= ends[1].1 { ends } else { [ends[1], ends[0]] };
    let (from, to) = (ends[0].1.max(0.0), ends[1].1.min(end));
    // Corner beside corner: nothing is over anything. Written so that NaN fails too.
    if !(to - from > tolerance) {
        return none;
    }
    // At each end the corner that is further in; of two in line, the first shape's, whichever side it is that parts them best.
    let over_mine = |corner: usize| CornerOnSide { owner: 1 - owner, corner, side };
    let over_other = |corner: usize| CornerOnSide { owner, corner, side: facing };
    let further_in = |[corner, own]: [usize; 2], in_by: f64| {
        let is_over_mine = if in_by.abs() <= tolerance { owner == 1 } else { in_by > 0.0 };
        if is_over_mine { over_mine(corner) } else { over_other(own) }
    };
    let features = [further_in([ends[0].0, side], ends[0].1), further_in([ends[1].0, next], end - ends[1].1)];
    Touches(features.map(|feature| {
        let [owner, other] = if feature.owner == 0 { [a, b] } else { [b, a] };
        let corner = (owner.local[feature.corner], owner.corners[feature.corner]);
        corner_on_side(feature, corner, &other.side(feature.side)).filter(|touch| touch.room >= 0.0)
    }))
}

/// A side of a polygon: its ends in the body and in the world, and its normal out of the polygon.
struct Side {
    local: [Vector<2>; 2],
    ends: [Vector<2>; 2],
    normal: Vector<2>,
}

impl PlacedPolygon<'_> {
    fn next(&self, k: usize) -> usize {
        if k + 1 < self.corners.len() { k + 1 } else { 0 }
    }

    fn length(&self, k: usize) -> f64 {
        (self.corners[self.next(k)] - self.corners[k]).norm()
    }

    fn side(&self, k: usize) -> Side {
        let next = self.next(k);
        let [local, ends] = [self.local, self.corners].map(|corners| [corners[k], corners[next]]);
        Side { local, ends, normal: self.normals[k] }
    }
}

/// The contact of a corner, in its body and in the world, with a side of the other polygon, or with its line; `None` where that isn't
/// finite.
fn corner_on_side(feature: CornerOnSide, (local, place): (Vector<2>, Vector<2>), side: &Side) -> Option<Touch> {
    let [begin, end] = side.ends;
    let direction = end - begin;
    let along = (place - begin).dot(&direction) / direction.norm_squared();
    if !along.is_finite() {
        return None;
    }
    let foot = side.local[0] + (side.local[1] - side.local[0]) * along;
    let gap = side.normal.dot(&(place - begin));
    let (points, normal) = match feature.owner {
        0 => ([local, foot], side.normal),
        _ => ([foot, local], -side.normal),
    };
    let room = (along.min(1.0 - along) + STILL_BESIDE) * direction.norm();
    Some(Touch { feature: feature.number(), points, normal, gap, room })
}
