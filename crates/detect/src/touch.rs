//! Where two shapes touch: corners against sides of polygons.

use crate::Vector;
use crate::placed::PlacedPart;

/// What makes a contact of two shapes the same from step to step: a corner of one, and the side of
/// the other that it is over. Where either is round, the corner is one of its core (the centre of a
/// disc), and what it is near is the other's outline as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CornerOnSide {
    /// Which of the pair's two bodies has the corner.
    pub owner: usize,
    /// The corner's number among those of all parts of its body.
    pub corner: usize,
    /// The number of the other body's side: it goes from the corner of this number to the next. Of
    /// an outline that of its first corner.
    pub side: usize,
    /// Whether either of the two is round.
    pub round: bool,
}

/// The bit of a feature's number that says that it is of something round.
const ROUND: u32 = 1 << 15;

impl CornerOnSide {
    /// The number of the feature within its pair, by which a contact's identity names it.
    #[must_use]
    pub fn number(self) -> u32 {
        let round = if self.round { ROUND } else { 0 };
        (self.owner as u32) << 31 | (self.corner as u32) << 16 | round | self.side as u32
    }

    /// The feature of that number.
    #[must_use]
    pub fn from_number(number: u32) -> Self {
        Self {
            owner: (number >> 31) as usize,
            corner: ((number >> 16) & 0x7fff) as usize,
            side: (number & (ROUND - 1)) as usize,
            round: number & ROUND != 0,
        }
    }
}

/// Two shapes that are near each other at a point of each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub(crate) feature: u32,
    /// The points, in the coordinates of their bodies.
    pub(crate) points: [Vector<2>; 2],
    /// The unit normal, from the second to the first.
    pub(crate) normal: Vector<2>,
    pub(crate) gap: f64,
    /// How far it is to the nearest end of its side, m: negative past it, infinite where the
    /// surface goes on.
    pub(crate) room: f64,
}

/// A corner is over a side as far as this part of its length past the side's ends: what is in line
/// there up to rounding stays so. The event-driven scheme holds heights to some 1e-13: where a corner
/// slides from one flush brick to the next, it must not strike the end of that one by so little.
const BESIDE: f64 = 1e-10;

/// A contact that is known stays over its side as far as this part past its ends, so that none is
/// lost where it is found again, and what touches instead is found where it has left. Joints of an
/// arch slip by some 1e-11 of their length a second, as far as solvers are exact: a corner beside
/// its twin must not be lost by that.
const STILL_BESIDE: f64 = 1e-9;

/// Of two sides that part polygons equally, up to this part of a side's length, the first shape's
/// is taken.
const EQUAL: f64 = 1e-9;

/// The points at which two shapes are near each other, at most two of them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Touches(pub(crate) [Option<Touch>; 2]);

impl Touches {
    /// In the order of their features.
    pub(crate) fn into_iter(self) -> impl Iterator<Item = Touch> {
        let [first, second] = self.0;
        let swap = matches!((&first, &second), (Some(a), Some(b)) if a.feature > b.feature);
        let sorted = if swap { [second, first] } else { [first, second] };
        sorted.into_iter().flatten()
    }
}

/// The side of a polygon that parts it best from another, and how far they are apart along its
/// normal; a side by which that is more than `enough` (m) ends the search.
fn best_side(of: &PlacedPart<'_>, other: &PlacedPart<'_>, enough: f64) -> Option<(usize, f64)> {
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
pub(crate) fn polygons(a: &PlacedPart<'_>, b: &PlacedPart<'_>, margin: f64) -> Touches {
    let Some(features) = facing(a, b, margin) else { return Touches::default() };
    Touches(features.map(|feature| {
        let [owner, other] = if feature.owner == 0 { [a, b] } else { [b, a] };
        let corner = feature.corner - owner.first;
        let corner = (owner.local[corner], owner.corners[corner]);
        corner_on_side(feature, corner, &other.side(feature.side - other.first)).filter(|touch| touch.room >= 0.0)
    }))
}

/// The corners at both ends of what two polygons share along the side that parts them best, which
/// are at most `margin` (m) apart; `None` where they are corner beside corner, or further apart.
pub(crate) fn facing(a: &PlacedPart<'_>, b: &PlacedPart<'_>, margin: f64) -> Option<[CornerOnSide; 2]> {
    let ((side_a, apart_a), (side_b, apart_b)) = (best_side(a, b, margin)?, best_side(b, a, margin)?);
    if apart_a > margin || apart_b > margin {
        return None;
    }
    let first = apart_a + EQUAL * a.length(side_a).min(b.length(side_b)) >= apart_b;
    let (owner, side) = if first { (0, side_a) } else { (1, side_b) };
    let [mine, other] = if first { [a, b] } else { [b, a] };
    // The side of the other that faces it.
    let normal = mine.normals[side];
    let facing = |i: &usize, j: &usize| normal.dot(&other.normals[*i]).total_cmp(&normal.dot(&other.normals[*j]));
    let facing = (0..other.corners.len()).min_by(|i, j| facing(i, j).then(i.cmp(j)))?;
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
        return None;
    }
    // At each end the corner that is further in; of two in line, the first shape's, whichever side
    // it is that parts them best.
    let over_mine = |corner: usize| CornerOnSide {
        owner: 1 - owner,
        corner: other.first + corner,
        side: mine.first + side,
        round: false,
    };
    let over_other =
        |corner: usize| CornerOnSide { owner, corner: mine.first + corner, side: other.first + facing, round: false };
    let further_in = |[corner, own]: [usize; 2], in_by: f64| {
        let is_over_mine = if in_by.abs() <= tolerance { owner == 1 } else { in_by > 0.0 };
        if is_over_mine { over_mine(corner) } else { over_other(own) }
    };
    Some([further_in([ends[0].0, side], ends[0].1), further_in([ends[1].0, next], end - ends[1].1)])
}

/// A side of a polygon: its ends in the body and in the world, and its normal out of the polygon.
pub(crate) struct Side {
    pub(crate) local: [Vector<2>; 2],
    pub(crate) ends: [Vector<2>; 2],
    pub(crate) normal: Vector<2>,
}

impl PlacedPart<'_> {
    pub(crate) fn next(&self, k: usize) -> usize {
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

/// The contact of a corner, in its body and in the world, with a side of the other polygon, or with
/// its line; `None` where that isn't finite.
pub(crate) fn corner_on_side(
    feature: CornerOnSide,
    (local, place): (Vector<2>, Vector<2>),
    side: &Side,
) -> Option<Touch> {
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
