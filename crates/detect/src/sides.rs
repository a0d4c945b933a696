//! Sides of shapes against a surface that bends: where it comes out between their corners, and
//! where it ends under them.

use crate::placed::{BodyFrame, Outline, Shapes};
use crate::touch::Touch;
use crate::{BodyId, Geometry, Kinematics, LawId, Summit, SurfacePoint, Vector};

/// The sides of a body's shape against a surface that bends, or ends: a beam that comes up between
/// the feet of a block, or ends under its base. Its corners on the surface are those of a
/// [`PointPair`](crate::PointPair).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SidePair {
    /// The pair's number, first part of the identity of its contacts. It may be that of the pair of
    /// the body's corners with the same surface.
    pub pair: u32,
    /// The law of its contacts.
    pub law: LawId,
    /// The body that has the shape.
    pub body: BodyId,
    /// The body that has the surface, as one by whose points others are touched.
    pub surface: BodyId,
    /// How the surface's deformation enters.
    pub kinematics: Kinematics,
}

/// What of a surface touches a side, as the second part of a contact's identity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnSide {
    /// An end of the surface: 0 the left one, 1 the right one.
    End(usize),
    /// Where the surface comes out or is supported between the ends of the side, counted from the left.
    Summit(usize),
    /// An end of the surface at the rounding about the side's first corner, or at a disc.
    EndAtRounding(usize),
}

/// Bits of a feature's number.
const END: u32 = 1 << 30;
const SUMMIT: u32 = 1 << 31;
const SHIFT: u32 = 15;

impl OnSide {
    /// The number of the feature within its pair; `side` is the number of its first corner among
    /// those of all parts of the body.
    #[must_use]
    pub fn number(self, side: usize) -> u32 {
        let (kind, which) = match self {
            Self::End(which) => (END, which),
            Self::Summit(which) => (SUMMIT, which),
            Self::EndAtRounding(which) => (END | SUMMIT, which),
        };
        kind | (which as u32) << SHIFT | side as u32
    }

    /// The feature of a number, and the side; `None` for that of a point.
    #[must_use]
    pub fn from_number(number: u32) -> Option<(Self, usize)> {
        let side = (number & ((1 << SHIFT) - 1)) as usize;
        let which = ((number & !(END | SUMMIT)) >> SHIFT) as usize;
        match (number & END != 0, number & SUMMIT != 0) {
            (true, false) => Some((Self::End(which), side)),
            (false, true) => Some((Self::Summit(which), side)),
            (true, true) => Some((Self::EndAtRounding(which), side)),
            (false, false) => None,
        }
    }
}

/// What comes out between the corners of a side by less than this part of its length is none: feet
/// stand on both sides of it.
const FLAT: f64 = 1e-9;

/// A support within this part of the side's length of an end of it is under the corner there, which touches it.
const UNDER_A_CORNER: f64 = 1e-6;

/// A side whose normal has more than this of the surface's does not lie over it but stands beside
/// it.
const FACING: f64 = -0.25;

/// Depths below two sides that differ by less than this part of the size of the shape are alike.
const ALIKE: f64 = 1e-3;

/// A point is on the boundary of a shape if it is outside by no more than this part of its distance from the origin and the shape's size:
/// the rounding of a place in the body's coordinates.
const ON_BOUNDARY: f64 = 8.0 * f64::EPSILON;

/// Summits under one side that are told apart.
pub const MOST_SUMMITS: usize = 8;

/// A side of a part in the world.
struct PlacedSide<'a> {
    outline: Outline<'a>,
    /// Its number.
    side: usize,
    local: [Vector<2>; 2],
    ends: [Vector<2>; 2],
    /// Out of the shape.
    normal: Vector<2>,
    local_normal: Vector<2>,
    radius: f64,
}

/// Hands the contacts of a pair that are at most `margin` (m) apart to `each`; `member` is the
/// number of its body among the shapes.
pub(crate) fn each(
    shapes: &Shapes,
    member: usize,
    pair: &SidePair,
    at: &dyn Geometry<2>,
    margin: f64,
    mut each: impl FnMut(&Touch),
) {
    let frame = BodyFrame::of(pair.body, at);
    let reach = if margin < f64::INFINITY { at.reach(pair.surface, margin) } else { None };
    let ends = at.ends(pair.surface, pair.kinematics);
    for part in shapes.members[member].parts.clone() {
        let outline = shapes.outline(part, frame);
        let corners = if outline.radius > 0.0 { outline.corners.len() } else { 0 };
        for (k, which) in (0..corners).flat_map(|k| [(k, 0), (k, 1)]) {
            if let Some(touch) = end_at_rounding(&outline, k, which, &ends) {
                push(&touch, margin, &mut each);
            }
        }
    }
    for side in sides(shapes, member, &frame) {
        if reach.is_some_and(|reach| side.ends.iter().all(|end| reach.excludes(&(end + side.normal * side.radius)))) {
            continue;
        }
        for (which, end) in ends.iter().enumerate().filter_map(|(which, end)| Some((which, (*end)?))) {
            let touch = side.touch(OnSide::End(which), &end).filter(|touch| touch.room >= 0.0);
            if let Some(touch) = touch.filter(|touch| touch.gap >= 0.0 || side.is_entered_by(&end)) {
                push(&touch, margin, &mut each);
            }
        }
        for (which, summit) in Summits::of(&side, pair, at).iter().enumerate() {
            let touch = side.touch(OnSide::Summit(which), summit);
            if let Some(touch) = touch.filter(|touch| touch.gap >= 0.0 || side.holds(&summit.place)) {
                push(&touch, margin, &mut each);
            }
        }
    }
}

fn push(touch: &Touch, margin: f64, each: &mut impl FnMut(&Touch)) {
    if touch.gap <= margin {
        each(touch);
    }
}

/// The contact that is known by its number, wherever the surface comes out by now; `None` where
/// there is none of the kind.
pub(crate) fn located(
    shapes: &Shapes,
    member: usize,
    pair: &SidePair,
    at: &dyn Geometry<2>,
    (feature, side): (OnSide, usize),
) -> Option<Touch> {
    let frame = BodyFrame::of(pair.body, at);
    if let OnSide::EndAtRounding(which) = feature {
        let outline = shapes.outline(shapes.part_of(member, side)?, frame);
        let ends = at.ends(pair.surface, pair.kinematics);
        return end_at_rounding(&outline, side.checked_sub(outline.first)?, which, &ends);
    }
    let side = sides(shapes, member, &frame).find(|placed| placed.side == side)?;
    match feature {
        OnSide::EndAtRounding(_) => None,
        OnSide::End(which) => side.touch(feature, &at.ends(pair.surface, pair.kinematics).get(which).copied()??),
        OnSide::Summit(which) => {
            let found = Summits::of(&side, pair, at);
            let direction = -side.normal;
            let height = |point: &SurfacePoint<2>| direction.dot(&point.place);
            // Where it doesn't come out any more, what is highest is at an end of the side.
            let highest = || {
                let feet = side.ends.iter().filter_map(|end| at.surface(pair.surface, pair.kinematics, end));
                feet.max_by(|a, b| height(a).total_cmp(&height(b))).filter(|_| which == 0)
            };
            let summit = match found.iter().next() {
                Some(_) => found.iter().nth(which).copied()?,
                None => highest()?,
            };
            side.touch(feature, &summit)
        }
    }
}

/// The contact of an end of a surface with the rounding about a corner that is past it; `None` if
/// that is not past it.
fn end_at_rounding(
    outline: &Outline<'_>,
    corner: usize,
    which: usize,
    ends: &[Option<SurfacePoint<2>>; 2],
) -> Option<Touch> {
    let (local, end) = (outline.corners.get(corner)?, (*ends.get(which)?)?);
    let beside = outline.frame.point(local) - end.place;
    let distance = beside.norm();
    let normal = beside / distance;
    // To the right of the right end, to the left of the left one.
    let past = end.normal.perp(&normal) * if which == 0 { 1.0 } else { -1.0 };
    // Written so that NaN fails too.
    if !(outline.radius > 0.0 && past >= 0.0 && normal.dot(&end.normal) > -FACING) {
        return None;
    }
    let on_rounding = local - outline.frame.unturned(&normal) * outline.radius;
    let feature = OnSide::EndAtRounding(which).number(outline.first + corner);
    let (points, gap) = ([on_rounding, end.material], distance - outline.radius);
    Some(Touch { feature, points, normal, gap, room: f64::INFINITY })
}

/// Where a surface may bear a side between its ends.
#[derive(Clone, Copy)]
struct Bearing {
    point: SurfacePoint<2>,
    /// How far along the side, as a part of its length.
    along: f64,
    /// Along the direction in which the surface comes out, m.
    height: f64,
    /// As [`Summit::support`], as a part of the side's length.
    support: Option<f64>,
}

/// Where a surface comes out or is supported between the ends of a side, from the left.
struct Summits {
    /// The last place is for one too many.
    places: [Option<Bearing>; MOST_SUMMITS + 1],
    count: usize,
}

impl Summits {
    fn of(side: &PlacedSide<'_>, pair: &SidePair, at: &dyn Geometry<2>) -> Self {
        let direction = -side.normal;
        let along_side = side.ends[1] - side.ends[0];
        let length = along_side.norm();
        // How far the surface comes out beside the ends of the side; found once it is asked for.
        let mut chord = None;
        let mut summits = Self { places: [None; MOST_SUMMITS + 1], count: 0 };
        at.summits(pair.surface, pair.kinematics, &direction, &side.ends, &mut |Summit { point, support }| {
            let along = (point.place - side.ends[0]).dot(&along_side) / (length * length);
            let height = direction.dot(&point.place);
            let bears = if support.is_some() {
                along.min(1.0 - along) > UNDER_A_CORNER
            } else {
                let chord = *chord.get_or_insert_with(|| {
                    let feet = side.ends.map(|end| at.surface(pair.surface, pair.kinematics, &end));
                    feet.map(|foot| foot.map(|foot| direction.dot(&foot.place)))
                });
                let beside = match chord {
                    [Some(a), Some(b)] => a + (b - a) * along,
                    // Past its end there is nothing beside it.
                    [Some(one), None] | [None, Some(one)] => one,
                    [None, None] => f64::NEG_INFINITY,
                };
                height - beside > FLAT * length && (0.0..=1.0).contains(&along)
            };
            if bears {
                let reach = support.map(|reach| reach / length);
                summits.add(Bearing { point, along, height, support: reach }, FLAT * length);
            }
        });
        summits
    }

    /// Adds the next one to the right. A summit takes the place of a support that it is near to. Of too many the lowest
    /// goes; of those that are as low but for `flat` (m), the one in the middle, as a base that is level rests on the outer ones.
    fn add(&mut self, bearing: Bearing, flat: f64) {
        let is_near = |a: &Bearing, reach: f64| (a.along - bearing.along).abs() <= reach;
        match bearing.support {
            Some(reach) if self.bearings().any(|summit| summit.support.is_none() && is_near(summit, reach)) => return,
            Some(_) => {}
            None => {
                let replaced = |support: &Bearing| support.support.is_some_and(|reach| is_near(support, reach));
                let find = |of: &Self| of.bearings().position(replaced);
                while let Some(k) = find(self) {
                    self.remove(k);
                }
            }
        }
        self.places[self.count] = Some(bearing);
        self.count += 1;
        if self.count > MOST_SUMMITS {
            let lowest = self.bearings().map(|bearing| bearing.height).fold(f64::INFINITY, f64::min);
            let low = self.bearings().enumerate().filter(|(_, bearing)| bearing.height <= lowest + flat);
            let last = self.count - 1;
            let innermost = low.map(|(k, _)| k).max_by_key(|&k| k.min(last - k));
            if let Some(k) = innermost {
                self.remove(k);
            }
        }
    }

    fn remove(&mut self, k: usize) {
        self.places.copy_within(k + 1..self.count, k);
        self.count -= 1;
        self.places[self.count] = None;
    }

    fn bearings(&self) -> impl Iterator<Item = &Bearing> {
        self.places.iter().flatten()
    }

    fn iter(&self) -> impl Iterator<Item = &SurfacePoint<2>> {
        self.bearings().map(|bearing| &bearing.point)
    }
}

impl PlacedSide<'_> {
    /// Whether a point lies inside the part. One that is behind this side's line may still be outside, past another side: when a block tips
    /// over the end of a beam, the end is behind the line of its far side. On the boundary it lies inside, whatever rounding says: what
    /// carries a base would be lost there.
    fn holds(&self, place: &Vector<2>) -> bool {
        let Outline { corners, normals, radius, frame, .. } = &self.outline;
        let local = frame.local(place);
        let within = *radius + ON_BOUNDARY * (place.norm() + self.size());
        corners.iter().zip(*normals).all(|(corner, normal)| normal.dot(&(local - corner)) <= within)
    }

    /// Of the outline, from the mass centre, m.
    fn size(&self) -> f64 {
        self.outline.corners.iter().map(|corner| corner.norm()).fold(0.0, f64::max)
    }

    /// Whether a point of the surface that lies inside the part came in through this side. An end that carries a base is on the boundary,
    /// so that rounding decides whether it lies inside: then it is as deep below the far side as the part is thick, and belongs to the side
    /// that it is least deep below; of sides that are alike in that, as at a corner, to the one that lies most squarely over the surface.
    fn is_entered_by(&self, end: &SurfacePoint<2>) -> bool {
        let Outline { corners, normals, frame, .. } = &self.outline;
        let (local, up) = (frame.local(&end.place), frame.unturned(&end.normal));
        let lies_over = || corners.iter().zip(*normals).filter(|(_, normal)| normal.dot(&up) < FACING);
        let height = |(corner, normal): (&Vector<2>, &Vector<2>)| normal.dot(&(local - corner));
        let least = lies_over().map(height).fold(f64::NEG_INFINITY, f64::max) - ALIKE * self.size();
        let squarest = lies_over().filter(|side| height(*side) >= least).map(|(_, normal)| normal.dot(&up));
        let own = self.local_normal.dot(&up);
        self.holds(&end.place)
            && height((&self.local[0], &self.local_normal)) >= least
            && squarest.fold(f64::INFINITY, f64::min) >= own
    }

    /// The contact of a point of the surface with the side's line; `None` if the side faces away
    /// from it, or it isn't finite.
    fn touch(&self, feature: OnSide, point: &SurfacePoint<2>) -> Option<Touch> {
        let [begin, end] = self.ends;
        let direction = end - begin;
        let along = (point.place - begin).dot(&direction) / direction.norm_squared();
        let gap = self.normal.dot(&(point.place - begin)) - self.radius;
        // Written so that NaN fails too.
        if !(along.is_finite() && gap.is_finite() && self.normal.dot(&point.normal) < FACING) {
            return None;
        }
        let on_side = self.local[0] + (self.local[1] - self.local[0]) * along + self.local_normal * self.radius;
        let room = along.min(1.0 - along) * direction.norm();
        let points = [on_side, point.material];
        Some(Touch { feature: feature.number(self.side), points, normal: -self.normal, gap, room })
    }
}

/// The sides of all parts of a member that have any.
fn sides<'a>(shapes: &'a Shapes, member: usize, frame: &'a BodyFrame) -> impl Iterator<Item = PlacedSide<'a>> + 'a {
    shapes.members[member].parts.clone().flat_map(move |part| {
        let outline = shapes.outline(part, *frame);
        let corners = outline.corners;
        let count = if corners.len() > 1 { corners.len() } else { 0 };
        (0..count).map(move |k| {
            let local = [corners[k], corners[(k + 1) % corners.len()]];
            let normal = outline.normals[k];
            PlacedSide {
                outline,
                side: outline.first + k,
                local,
                ends: local.map(|corner| frame.point(&corner)),
                normal: frame.turned(&normal),
                local_normal: normal,
                radius: outline.radius,
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_feature_keeps_its_parts() {
        for feature in [OnSide::End(1), OnSide::Summit(0), OnSide::Summit(7), OnSide::EndAtRounding(1)] {
            for side in [0, 3, crate::MOST_CORNERS - 1] {
                assert_eq!(OnSide::from_number(feature.number(side)), Some((feature, side)));
            }
        }
        assert_eq!(OnSide::from_number(17), None);
    }
}
