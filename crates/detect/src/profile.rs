//! Ground that is not flat: a line of straight pieces, solid below, against shapes.

use crate::placed::{BodyFrame, Outline};
use crate::round::{On, nearest};
use crate::touch::{CornerOnSide, Touch};
use crate::{BodyId, LawId, MOST_CORNERS, ShapeError, Vector};
use std::ops::{Range, RangeInclusive};

/// A profile of the ground: straight pieces between points from left to right, level beyond the
/// first and the last. What is below is solid.
///
/// ```
/// use nalgebra::Vector2;
/// use teeter_detect::Profile;
///
/// let step = Profile::new([[0.0, 0.0], [0.1, 0.05], [0.2, 0.05]].map(Vector2::from).to_vec())?;
/// assert_eq!(step.height(0.05), 0.025);
/// assert_eq!(step.height(-3.0), 0.0);
/// # Ok::<(), teeter_detect::ShapeError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// From left to right, a level ray at each end.
    pieces: Vec<Piece>,
    /// Where piece k ends and the next begins.
    joints: Vec<Joint>,
}

/// A straight piece: the points `origin + s·direction` with s in [low, high].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    origin: Vector<2>,
    /// To the right.
    direction: Vector<2>,
    /// Up.
    normal: Vector<2>,
    low: f64,
    high: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Joint {
    place: Vector<2>,
    bend: Bend,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bend {
    /// It goes on straight.
    None,
    /// The ground has a crest.
    Crest,
    /// It has a valley: what lies there touches both pieces.
    Valley,
}

/// A body against ground with a profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProfilePair {
    /// The pair's number, first part of the identity of its contacts.
    pub pair: u32,
    /// The law of its contacts.
    pub law: LawId,
    /// The body that has the shape.
    pub body: BodyId,
    /// The ground.
    pub ground: BodyId,
}

/// Pieces that turn by less than this from one to the next, rad, go on straight.
const STRAIGHT: f64 = 1e-12;

/// In a valley a piece is met past its end as far as this part of its length, on a crest as far as
/// the smaller one.
const PAST_A_VALLEY: f64 = 1e-3;
const PAST_A_CREST: f64 = 1e-9;

/// A corner's distance from a piece is known to this part of the coordinates.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// What lies along a piece beside a crest still touches the crest, up to this angle, rad.
const ALONG: f64 = 1e-9;

/// A corner may strike a piece although the corner beside it reaches further into the ground, if the side between them slopes by less than
/// this against the piece, rad: more than a base turns as it sinks in.
const POINTING: f64 = 0.02;

impl Profile {
    /// The profile through these points, m.
    ///
    /// # Errors
    /// If there are fewer than two, or too many to be numbered, one is not finite, or one is not to
    /// the right of the one before it.
    pub fn new(points: Vec<Vector<2>>) -> Result<Self, ShapeError> {
        if points.len() < 2 || points.len() > MOST_CORNERS - 2 {
            return Err(ShapeError::ProfilePoints { points: points.len() });
        }
        if let Some(corner) = points.iter().position(|x| !x.iter().all(|x| x.is_finite())) {
            return Err(ShapeError::NotFinite { corner });
        }
        if let Some(k) = points.windows(2).position(|two| two[1].x <= two[0].x) {
            return Err(ShapeError::NotRising { point: k + 1 });
        }
        let level = |origin: Vector<2>, low: f64, high: f64| Piece {
            origin,
            direction: Vector::x(),
            normal: Vector::y(),
            low,
            high,
        };
        let mut pieces = vec![level(points[0], f64::NEG_INFINITY, 0.0)];
        for two in points.windows(2) {
            let along = two[1] - two[0];
            let direction = along.normalize();
            let normal = Vector::<2>::new(-direction.y, direction.x);
            pieces.push(Piece { origin: two[0], direction, normal, low: 0.0, high: along.norm() });
        }
        pieces.push(level(points[points.len() - 1], 0.0, f64::INFINITY));
        let joints = points.iter().zip(pieces.windows(2)).map(|(place, two)| {
            let turn = two[0].direction.perp(&two[1].direction);
            let bend = match turn {
                turn if turn < -STRAIGHT => Bend::Crest,
                turn if turn > STRAIGHT => Bend::Valley,
                _ => Bend::None,
            };
            Joint { place: *place, bend }
        });
        let joints = joints.collect();
        Ok(Self { pieces, joints })
    }

    /// The height of the ground at x, m.
    #[must_use]
    pub fn height(&self, x: f64) -> f64 {
        let piece = &self.pieces[self.piece_at(x)];
        piece.origin.y + (x - piece.origin.x) / piece.direction.x * piece.direction.y
    }

    /// The points between the pieces, m.
    pub fn points(&self) -> impl Iterator<Item = Vector<2>> + '_ {
        self.joints.iter().map(|joint| joint.place)
    }

    /// The number of the piece that is at x.
    fn piece_at(&self, x: f64) -> usize {
        self.joints.partition_point(|joint| joint.place.x <= x)
    }

    /// The numbers of the pieces over some of what is between two places, m.
    fn pieces_between(&self, low: f64, high: f64) -> RangeInclusive<usize> {
        self.piece_at(low)..=self.piece_at(high)
    }

    /// The numbers of the joints between two places, m.
    fn joints_between(&self, low: f64, high: f64) -> Range<usize> {
        let first = self.joints.partition_point(|joint| joint.place.x < low);
        first..self.joints.partition_point(|joint| joint.place.x <= high).max(first)
    }

    /// How far a point at s along piece k is from the ends of what the piece is met along, m:
    /// negative past them.
    fn room(&self, k: usize, s: f64) -> f64 {
        let Piece { low, high, .. } = self.pieces[k];
        // A ray has no length of its own.
        let length = if (high - low).is_finite() { high - low } else { 0.0 };
        let past = |joint: &Joint| {
            length
                * match joint.bend {
                    Bend::Valley => PAST_A_VALLEY,
                    Bend::Crest | Bend::None => PAST_A_CREST,
                }
        };
        let before = k.checked_sub(1).and_then(|joint| self.joints.get(joint));
        let left = before.map_or(f64::INFINITY, |joint| s - low + past(joint));
        let right = self.joints.get(k).map_or(f64::INFINITY, |joint| high - s + past(joint));
        left.min(right)
    }
}

impl Piece {
    fn along(&self, place: &Vector<2>) -> f64 {
        (place - self.origin).dot(&self.direction)
    }

    fn height(&self, place: &Vector<2>) -> f64 {
        self.normal.dot(&(place - self.origin))
    }
}

/// A shape's outline over a profile, and the frame of the ground.
struct Over<'a> {
    profile: &'a Profile,
    outline: &'a Outline<'a>,
    ground: &'a BodyFrame,
}

/// Hands the contacts of a part of a shape with the ground that are at most `margin` (m) apart to
/// `each`.
pub(crate) fn each(
    profile: &Profile,
    outline: &Outline<'_>,
    ground: &BodyFrame,
    margin: f64,
    mut each: impl FnMut(&Touch),
) {
    let over = Over { profile, outline, ground };
    let mut near = |touch: Option<Touch>| {
        if let Some(touch) = touch.filter(|touch| touch.gap <= margin) {
            each(&touch);
        }
    };
    let (mut low, mut high, mut depth) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
    for (k, corner) in outline.corners.iter().enumerate() {
        let place = ground.local(&outline.frame.point(corner));
        let below = profile.height(place.x) - place.y;
        (low, high, depth) = (low.min(place.x), high.max(place.x), depth.max(below));
        let reach = (margin + outline.radius).max(below);
        over.pieces_of(k, &place, reach, below, |piece| near(over.corner_on_piece(k, piece)));
    }
    let reach = outline.radius + margin.max(depth);
    for joint in profile.joints_between(low - reach, high + reach) {
        near(over.crest(joint));
    }
}

/// The contact of a part with the ground that is known by its feature; past the ends of what it is
/// met along too.
pub(crate) fn located(
    profile: &Profile,
    outline: &Outline<'_>,
    ground: &BodyFrame,
    feature: CornerOnSide,
) -> Option<Touch> {
    let over = Over { profile, outline, ground };
    match (feature.owner, feature.round) {
        (0, false) => over.corner_on_piece(feature.corner.checked_sub(outline.first)?, feature.side),
        // What of the outline a crest is nearest to may have changed since.
        (0, true) => over.crest(feature.side).filter(|touch| touch.feature == feature.number()),
        _ => over.crest_on_side(feature.corner, feature.side.checked_sub(outline.first)?),
    }
}

impl Over<'_> {
    /// Hands the pieces to `each` that a corner at `place`, `below` the ground by so much (m), can
    /// touch: those that it is over; of those that it is in the nearest, and what meets that in a
    /// valley. A piece that it doesn't point into doesn't count: a base that has sunk a little into one flank of a crest, and slides down,
    /// passes the crest with a corner that is inside the ground and nearer to the other flank. There the crest touches a side.
    fn pieces_of(&self, corner: usize, place: &Vector<2>, reach: f64, below: f64, mut each: impl FnMut(usize)) {
        let profile = self.profile;
        let pieces = profile.pieces_between(place.x - reach, place.x + reach);
        let height = |piece: usize| profile.pieces[piece].height(place);
        let over = |piece: &usize| profile.room(*piece, profile.pieces[*piece].along(place)) >= 0.0;
        // A corner on a piece may be above the ground by its coordinates and below the piece by its distance.
        let rounding =
            ROUNDING * pieces.clone().fold(place.amax(), |most, piece| most.max(profile.pieces[piece].origin.amax()));
        let nearest = if below > 0.0 {
            let struck = pieces.clone().filter(over).filter(|piece| self.points_into(corner, *piece));
            let Some(nearest) = struck.max_by(|a, b| height(*a).total_cmp(&height(*b))) else { return };
            Some(nearest)
        } else {
            None
        };
        for piece in pieces.filter(over) {
            let counts = match nearest {
                None => height(piece) >= -rounding,
                Some(nearest) => {
                    let meet = nearest.abs_diff(piece) == 1 && profile.joints[nearest.min(piece)].bend == Bend::Valley;
                    piece == nearest || meet
                }
            };
            if counts {
                each(piece);
            }
        }
    }

    /// Whether neither of the corners beside this one reaches further into the ground below a piece.
    fn points_into(&self, corner: usize, piece: usize) -> bool {
        let Outline { corners, frame, .. } = self.outline;
        let inward = -frame.unturned(&self.ground.turned(&self.profile.pieces[piece].normal));
        let n = corners.len();
        [(corner + 1) % n, (corner + n - 1) % n].iter().all(|beside| {
            let side = corners[*beside] - corners[corner];
            inward.dot(&side) <= POINTING * side.norm()
        })
    }

    /// The contact of a corner, or of the rounding about it, with a piece or its line.
    fn corner_on_piece(&self, corner: usize, number: usize) -> Option<Touch> {
        let Outline { first, corners, radius, frame, .. } = self.outline;
        let (local, piece) = (corners.get(corner)?, self.profile.pieces.get(number)?);
        let place = self.ground.local(&frame.point(local));
        let along = piece.along(&place);
        let normal = self.ground.turned(&piece.normal);
        let feature = CornerOnSide { owner: 0, corner: first + corner, side: number, round: false };
        let points = [local - frame.unturned(&normal) * *radius, piece.origin + piece.direction * along];
        let (gap, room) = (piece.height(&place) - radius, self.profile.room(number, along));
        gap.is_finite().then(|| Touch { feature: feature.number(), points, normal, gap, room })
    }

    /// The contact of a crest with what of the outline is nearest to it: a side, or a rounding.
    fn crest(&self, joint: usize) -> Option<Touch> {
        let Joint { place, bend } = *self.profile.joints.get(joint)?;
        if bend != Bend::Crest {
            return None;
        }
        let Outline { first, radius, frame, .. } = self.outline;
        let near = nearest(self.outline, &frame.local(&self.ground.point(&place)))?;
        let corner = match near.on {
            On::Side(side) => {
                let on = |side: usize| self.crest_on_side(joint, side).filter(|touch| touch.room >= 0.0);
                let n = self.outline.corners.len();
                let beside = || [side + 1, side + n - 1].into_iter().filter_map(|beside| on(beside % n));
                // A crest that is further inside than it is from a corner is nearer to the side that doesn't lie on it.
                let inside = near.distance < *radius;
                return on(side).or_else(|| beside().filter(|_| inside).max_by(|a, b| a.gap.total_cmp(&b.gap)));
            }
            On::Corner(corner) if *radius > 0.0 => corner,
            On::Corner(_) => return None,
        };
        let normal = -frame.turned(&near.normal);
        let feature = CornerOnSide { owner: 0, corner: first + corner, side: joint, round: true };
        let points = [near.foot + near.normal * *radius, place];
        self.faces(joint, &normal).then(|| Touch {
            feature: feature.number(),
            points,
            normal,
            gap: near.distance - radius,
            room: f64::INFINITY,
        })
    }

    /// The contact of a crest with a side, or its line.
    fn crest_on_side(&self, joint: usize, side: usize) -> Option<Touch> {
        let Joint { place, bend } = *self.profile.joints.get(joint)?;
        let Outline { first, corners, normals, radius, frame } = self.outline;
        if bend != Bend::Crest || corners.len() < 2 || side >= corners.len() {
            return None;
        }
        let [begin, end] = [corners[side], corners[(side + 1) % corners.len()]];
        let along_side = end - begin;
        let local = frame.local(&self.ground.point(&place));
        let along = (local - begin).dot(&along_side) / along_side.norm_squared();
        let gap = normals[side].dot(&(local - begin)) - radius;
        let normal = -frame.turned(&normals[side]);
        let feature = CornerOnSide { owner: 1, corner: joint, side: first + side, round: false };
        let points = [begin + along_side * along + normals[side] * *radius, place];
        let room = (along.min(1.0 - along) + PAST_A_CREST) * along_side.norm();
        (gap.is_finite() && self.faces(joint, &normal)).then(|| Touch {
            feature: feature.number(),
            points,
            normal,
            gap,
            room,
        })
    }

    /// Whether a direction (in the world) leads out of a crest between the normals of its two
    /// pieces.
    fn faces(&self, joint: usize, normal: &Vector<2>) -> bool {
        let out = self.ground.unturned(normal);
        let [left, right] = [joint, joint + 1].map(|piece| out.dot(&self.profile.pieces[piece].direction));
        left >= -ALONG && right <= ALONG
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(points: &[[f64; 2]]) -> Result<Profile, ShapeError> {
        Profile::new(points.iter().map(|x| Vector::<2>::new(x[0], x[1])).collect())
    }

    #[test]
    fn a_profile_rises_along_x() {
        assert_eq!(profile(&[[0.0, 0.0]]), Err(ShapeError::ProfilePoints { points: 1 }));
        assert_eq!(profile(&[[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]]), Err(ShapeError::NotRising { point: 2 }));
        assert_eq!(profile(&[[0.0, 0.0], [f64::NAN, 0.0]]), Err(ShapeError::NotFinite { corner: 1 }));
    }

    #[test]
    fn the_height_is_that_of_the_pieces_and_level_beyond_them() {
        let profile = profile(&[[0.0, 1.0], [1.0, 3.0], [4.0, 0.0]]).unwrap();
        for (x, height) in [(-5.0, 1.0), (0.0, 1.0), (0.5, 2.0), (1.0, 3.0), (3.0, 1.0), (4.0, 0.0), (9.0, 0.0)] {
            assert!((profile.height(x) - height).abs() < 1e-15, "{x}: {}", profile.height(x));
        }
        let bends: Vec<_> = profile.joints.iter().map(|joint| joint.bend).collect();
        assert_eq!(bends, [Bend::Valley, Bend::Crest, Bend::Valley]);
    }

    /// A square that lies on the right flank of a ridge, sunk in by a micrometre, with a corner just before the ridge or behind it: it is in
    /// the left flank's ground there, but can only strike it with another corner.
    #[test]
    fn a_corner_strikes_no_flank_into_which_it_does_not_point() {
        let depth = 1e-6;
        let corners = [[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]].map(Vector::<2>::from);
        let normals = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]].map(Vector::<2>::from);
        for height in [0.2, 0.5, 1.0] {
            let profile = profile(&[[-1.0, -height], [0.0, 0.0], [1.0, -height]]).unwrap();
            let slope = f64::atan(height);
            let normal = Vector::<2>::new(slope.sin(), slope.cos());
            for along in [-3e-6, -0.5e-6, 0.5e-6, 3e-6] {
                let place = Vector::<2>::new(slope.cos(), -slope.sin()) * along - normal * depth;
                let frame = BodyFrame::at(place, -slope);
                let outline = Outline { first: 0, corners: &corners, normals: &normals, radius: 0.0, frame };
                let mut found = Vec::new();
                each(&profile, &outline, &BodyFrame::at(Vector::zeros(), 0.0), 0.0, |touch| {
                    found.push((touch.normal, touch.gap));
                });
                // The corner in front, and the ridge or the corner behind it.
                assert_eq!(found.len(), 2, "{height}, {along}: {found:?}");
                for (n, gap) in found {
                    assert!((n - normal).norm() < 1e-12 && (gap + depth).abs() < 1e-12, "{height}, {along}: {n} {gap}");
                }
            }
        }
    }
}
