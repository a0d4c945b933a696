//! Corners of shapes on surfaces: sharp ones, and roundings.

use crate::placed::{BodyFrame, Outline, Shapes};
use crate::touch::Touch;
use crate::{BodyId, Geometry, Kinematics, LawId, SurfacePoint, Vector};

/// A body with a shape on a surface: each corner of its parts can touch it, by its rounding where
/// it has one; a disc at one point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfacePair {
    /// The pair's number, first part of the identity of its contacts; the second is the corner's
    /// number among those of all parts of the body.
    pub pair: u32,
    /// The law of its contacts.
    pub law: LawId,
    /// The body that has the shape.
    pub body: BodyId,
    /// The body that has the surface.
    pub surface: BodyId,
    /// How the surface's deformation enters.
    pub kinematics: Kinematics,
}

/// Most rounds in which the point of a rounding that has the surface's direction is found. Each
/// gains a factor radius · curvature.
const ROUNDS: usize = 50;

/// Directions that change by less than this have been found.
const SETTLED: f64 = 2.0 * f64::EPSILON;

/// Hands the contacts of a pair that are at most `margin` (m) apart to `each`; `member` is the
/// number of its body among the shapes.
pub(crate) fn each(
    shapes: &Shapes,
    member: usize,
    pair: &SurfacePair,
    at: &dyn Geometry<2>,
    margin: f64,
    mut each: impl FnMut(&Touch),
) {
    let frame = BodyFrame::of(pair.body, at);
    let reach = |radius: f64| if margin < f64::INFINITY { at.reach(pair.surface, margin + radius) } else { None };
    for part in shapes.members[member].parts.clone() {
        let outline = shapes.outline(part, frame);
        let reach = reach(outline.radius);
        for corner in 0..outline.corners.len() {
            let place = frame.point(&outline.corners[corner]);
            if reach.is_some_and(|reach| reach.excludes(&place)) {
                continue;
            }
            if let Some(touch) = foot(&outline, corner, pair, at).filter(|touch| touch.gap <= margin) {
                each(&touch);
            }
        }
    }
}

/// The contact of a corner by its number; `None` where the surface doesn't extend that far.
pub(crate) fn located(
    shapes: &Shapes,
    member: usize,
    pair: &SurfacePair,
    at: &dyn Geometry<2>,
    corner: usize,
) -> Option<Touch> {
    let outline = shapes.outline(shapes.part_of(member, corner)?, BodyFrame::of(pair.body, at));
    foot(&outline, corner - outline.first, pair, at)
}

/// The contact of a corner. A rounding touches where it has the direction of the surface under that
/// point.
fn foot(outline: &Outline<'_>, corner: usize, pair: &SurfacePair, at: &dyn Geometry<2>) -> Option<Touch> {
    let local = outline.corners[corner];
    let centre = outline.frame.point(&local);
    let under = |place: &Vector<2>| at.surface(pair.surface, pair.kinematics, place);
    let mut lowest = centre;
    let mut point: SurfacePoint<2> = under(&lowest)?;
    if outline.radius > 0.0 {
        for _ in 0..ROUNDS {
            let normal = point.normal;
            lowest = centre - normal * outline.radius;
            point = under(&lowest)?;
            if (point.normal - normal).norm() <= SETTLED {
                break;
            }
        }
    }
    let gap = point.normal.dot(&(lowest - point.place));
    let on_body = local - outline.frame.unturned(&point.normal) * outline.radius;
    let feature = (outline.first + corner) as u32;
    let (points, normal) = ([on_body, point.material], point.normal);
    // Written so that NaN fails too.
    (gap < f64::INFINITY).then_some(Touch { feature, points, normal, gap, room: f64::INFINITY })
}
