//! Where two shapes touch of which one is round: a disc, or a polygon with rounded corners. All is
//! a matter of the cores: a corner of one and the nearest point of the other's outline, less both
//! radii.

use crate::Vector;
use crate::placed::{Outline, PlacedPart};
use crate::touch::{CornerOnSide, Touch, Touches, facing};

/// Finds where two shapes are near each other, if they are at most `margin` (m) apart: at two
/// points where sides lie along each other. Each is given in the world and in its own coordinates.
pub(crate) fn round(places: [&PlacedPart<'_>; 2], outlines: [&Outline<'_>; 2], margin: f64) -> Touches {
    let [a, b] = outlines;
    let of = |owner: usize, corner: usize| {
        let [mine, other] = if owner == 0 { [a, b] } else { [b, a] };
        CornerOnSide { owner, corner: mine.first + corner, side: other.first, round: true }
    };
    let touch = |feature: CornerOnSide| {
        let [owner, other] = if feature.owner == 0 { [a, b] } else { [b, a] };
        near_outline(feature, owner, other)
    };
    let one = |touch: Option<Touch>| Touches([touch, None]);
    match (a.corners.len(), b.corners.len()) {
        (1, _) => return one(touch(of(0, 0))),
        (_, 1) => return one(touch(of(1, 0))),
        _ => {}
    }
    // The corner that is nearest to the other: of those that are as near, the first one's.
    let corners =
        (0..a.corners.len()).map(|corner| of(0, corner)).chain((0..b.corners.len()).map(|corner| of(1, corner)));
    let nearest = corners.filter_map(touch).reduce(|best, other| if other.gap < best.gap { other } else { best });
    let Some(nearest) = nearest.filter(|nearest| nearest.gap <= margin) else { return Touches::default() };
    let lying = facing(places[0], places[1], f64::INFINITY).map(|features| {
        features.map(|CornerOnSide { owner, corner, .. }| {
            let first = if owner == 0 { a.first } else { b.first };
            touch(of(owner, corner - first))
        })
    });
    // Where one of the corners at the ends of what sides share is the nearest, or as near, both of
    // them touch.
    match lying {
        Some([Some(first), Some(second)])
            if first.gap.min(second.gap) <= nearest.gap + EQUAL * (a.radius + b.radius) =>
        {
            Touches([Some(first), Some(second)])
        }
        _ => one(Some(nearest)),
    }
}

/// A corner that is nearer than those at the ends of what two sides share by no more than this part
/// of the radii is none of its own.
const EQUAL: f64 = 1e-9;

/// The contact of a corner of a core with the outline of another shape; `None` where the two have
/// no direction from each other.
pub(crate) fn near_outline(feature: CornerOnSide, owner: &Outline<'_>, other: &Outline<'_>) -> Option<Touch> {
    let corner = owner.corners.get(feature.corner.checked_sub(owner.first)?)?;
    let place = other.frame.local(&owner.frame.point(corner));
    let radii = owner.radius + other.radius;
    let mut near = nearest(other, &place)?;
    if near.distance < radii
        && let Some(along) = overlap(owner, other)
    {
        near = along_overlap(along, owner, other, &place, radii).unwrap_or(near);
    }
    let Nearest { foot, normal, distance, .. } = near;
    let on_other = foot + normal * other.radius;
    let normal = other.frame.turned(&normal);
    let on_owner = corner - owner.frame.unturned(&normal) * owner.radius;
    let (points, normal) = match feature.owner {
        0 => ([on_owner, on_other], normal),
        _ => ([on_other, on_owner], -normal),
    };
    let gap = distance - radii;
    gap.is_finite().then(|| Touch { feature: feature.number(), points, normal, gap, room: f64::INFINITY })
}

/// The number of the side or corner of another shape's core that is nearest to a corner.
pub(crate) fn piece(feature: CornerOnSide, owner: &Outline<'_>, other: &Outline<'_>) -> Option<u32> {
    let corner = owner.corners.get(feature.corner.checked_sub(owner.first)?)?;
    let number = match nearest(other, &other.frame.local(&owner.frame.point(corner)))?.on {
        On::Side(k) => 2 * k,
        On::Corner(k) => 2 * k + 1,
    };
    u32::try_from(number).ok()
}

/// The side along whose normal two cores that overlap are least deep in each other.
#[derive(Clone, Copy)]
enum LeastDeep {
    OfOwner(usize),
    OfOther(usize),
}

/// A side of the owner counts if the overlap along its normal is less than this part of that along one of the other's: sides that lie on
/// each other overlap by as much.
const CLEARLY_LESS: f64 = 0.9;

/// Along which side two cores overlap least; `None` where they don't overlap, or one of them has no sides. From a corner alone it can't be
/// told: of two flush blocks one above the other, one that has sunk in is as near to the flank of the other as to its top.
fn overlap(owner: &Outline<'_>, other: &Outline<'_>) -> Option<LeastDeep> {
    if owner.corners.len() < 2 || other.corners.len() < 2 {
        return None;
    }
    let (side, of_other) = least_deep(other, owner)?;
    let (own_side, of_owner) = least_deep(owner, other)?;
    // Heights below a side, so that the greater is the less deep.
    Some(if of_owner > CLEARLY_LESS * of_other { LeastDeep::OfOwner(own_side) } else { LeastDeep::OfOther(side) })
}

/// The side of one core beyond which another one reaches least, and how far that is, m, negative; `None` if that is beyond a side
/// altogether.
fn least_deep(of: &Outline<'_>, another: &Outline<'_>) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    for (side, (corner, normal)) in of.corners.iter().zip(of.normals).enumerate() {
        let height = |other: &Vector<2>| normal.dot(&(of.frame.local(&another.frame.point(other)) - corner));
        let lowest = another.corners.iter().map(height).fold(f64::INFINITY, f64::min);
        // Written so that NaN is apart.
        if !(lowest < 0.0) {
            return None;
        }
        if best.is_none_or(|(_, known)| lowest > known) {
            best = Some((side, lowest));
        }
    }
    best
}

/// What of the other core is nearest to a corner, at `place` in its coordinates, along the normal of the side by which the cores overlap
/// least; `None` for a corner that isn't beside that side.
fn along_overlap(
    least: LeastDeep,
    owner: &Outline<'_>,
    other: &Outline<'_>,
    place: &Vector<2>,
    radii: f64,
) -> Option<Nearest> {
    match least {
        LeastDeep::OfOther(k) => {
            let (start, end) = (other.corners[k], other.corners[(k + 1) % other.corners.len()]);
            let (side, normal) = (end - start, other.normals[k]);
            let along = (place - start).dot(&side) / side.norm_squared();
            let beyond = radii / side.norm();
            if !(-beyond..=1.0 + beyond).contains(&along) {
                return None;
            }
            let foot = start + side * along.clamp(0.0, 1.0);
            Some(Nearest { foot, normal, distance: normal.dot(&(place - start)), on: On::Side(k) })
        }
        LeastDeep::OfOwner(k) => {
            let normal = -other.frame.unturned(&owner.frame.turned(&owner.normals[k]));
            // What of the other core is over the corner along that normal.
            let n = other.corners.len();
            let crossed = (0..n).filter_map(|side| {
                let (start, end) = (other.corners[side], other.corners[(side + 1) % n]);
                let along = end - start;
                let across = normal.perp(&along);
                let share = normal.perp(&(place - start)) / across;
                (0.0..=1.0).contains(&share).then(|| (side, normal.dot(&(start + along * share))))
            });
            let (side, height) = crossed.max_by(|a, b| a.1.total_cmp(&b.1))?;
            let distance = normal.dot(place) - height;
            Some(Nearest { foot: place - normal * distance, normal, distance, on: On::Side(side) })
        }
    }
}

/// The point of a core's outline that is nearest to a point, the way from there, and the distance,
/// negative inside; in the coordinates of the body.
pub(crate) struct Nearest {
    pub(crate) foot: Vector<2>,
    pub(crate) normal: Vector<2>,
    pub(crate) distance: f64,
    pub(crate) on: On,
}

/// What of an outline is nearest, by its number within its part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum On {
    Side(usize),
    Corner(usize),
}

/// What of an outline's core is nearest to a point of its body; `None` if the core is one point,
/// and that the same.
pub(crate) fn nearest(of: &Outline<'_>, to: &Vector<2>) -> Option<Nearest> {
    let from = |corner: usize| {
        let foot = of.corners[corner];
        let beside = to - foot;
        let distance = beside.norm();
        // Written so that NaN fails too.
        (distance > 0.0).then(|| Nearest { foot, normal: beside / distance, distance, on: On::Corner(corner) })
    };
    if of.corners.len() == 1 {
        return from(0);
    }
    let mut best: Option<(usize, f64)> = None;
    for (k, (corner, normal)) in of.corners.iter().zip(of.normals).enumerate() {
        let height = normal.dot(&(to - corner));
        if best.is_none_or(|(_, known)| height > known) {
            best = Some((k, height));
        }
    }
    let (k, distance) = best?;
    let next = if k + 1 < of.corners.len() { k + 1 } else { 0 };
    let side = of.corners[next] - of.corners[k];
    let along = (to - of.corners[k]).dot(&side) / side.norm_squared();
    // From outside, what is nearest is on the side that the point is furthest out of, or at the end
    // of that.
    if distance > 0.0 && !(0.0..=1.0).contains(&along) {
        return from(if along < 0.0 { k } else { next });
    }
    let foot = of.corners[k] + side * along.clamp(0.0, 1.0);
    Some(Nearest { foot, normal: of.normals[k], distance, on: On::Side(k) })
}
