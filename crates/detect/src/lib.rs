//! Contact detection: which points of bodies are near which surfaces, at what gap, in what frame,
//! and with an identity that lasts from step to step.
//!
//! A detector sees bodies through [`Geometry`] only, so it knows nothing of blocks, beams or
//! states. It finds [`Candidate`]s: all points within a margin. Which of them are contacts, the
//! time scheme decides.
//!
//! Conventions (`docs/theory.md` §3): a point of one body, side 0, against the surface of another,
//! side 1. The normal `n` points out of the surface; in the plane `t = (n_y, −n_x)`, so `t` points
//! to the right where `n` points up. The gap is `n · (x_point − x_foot)`, negative in penetration.
//! `u = v_0 − v_1`, and an impulse `p` acts on side 0.
//!
//! ```
//! use nalgebra::Vector2;
//! use teeter_detect::*;
//!
//! /// One body whose pose is a height, above a floor.
//! struct Scene(f64);
//! impl Geometry<2> for Scene {
//!     fn place(&self, _: BodyId, local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
//!         for (x, l) in out.iter_mut().zip(local) {
//!             *x = l + Vector2::new(0.0, self.0);
//!         }
//!     }
//!     fn surface(&self, _: BodyId, _: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
//!         let foot = Vector2::new(at.x, 0.0);
//!         Some(SurfacePoint { place: foot, normal: Vector2::y(), material: foot })
//!     }
//! }
//!
//! let detector = PointDetector::new(vec![PointPair {
//!     pair: 0,
//!     law: LawId(0),
//!     points: vec![Vector2::new(-1.0, 0.0), Vector2::new(1.0, 0.5)],
//!     body: BodyId(0),
//!     surface: BodyId(1),
//!     kinematics: Kinematics::Deformed,
//! }]);
//! let mut found = Candidates::new();
//! detector.detect(&Scene(0.1), 0.2, &mut DetectorMemory::default(), &mut found);
//! assert_eq!(found.len(), 1);
//! assert_eq!((found[0].gap, found[0].id.point()), (0.1, 0));
//! ```

mod broad;
mod candidate;
#[cfg(feature = "conformance")]
pub mod conformance;
mod feet;
mod memory;
mod placed;
mod points;
mod profile;
mod round;
mod shape;
mod shapes;
mod sides;
mod touch;
mod wiring_error;

pub use broad::Groups;
pub use candidate::{Anchor, BodyId, Candidate, Candidates, ContactId, Frame, LawId, plane_frame};
pub use feet::SurfacePair;
pub use memory::DetectorMemory;
pub use points::{PointDetector, PointPair};
pub use profile::{Profile, ProfilePair};
pub use shape::{Disc, MOST_CORNERS, Polygon, Rounded, Shape, ShapeError};
pub use shapes::{ShapeDetector, ShapePair};
pub use sides::{MOST_SUMMITS, OnSide, SidePair};
pub use touch::CornerOnSide;
pub use wiring_error::WiringError;

/// A point or direction of the world, or of a body.
pub type Vector<const D: usize> = nalgebra::SVector<f64, D>;

/// How the motion of a deformable surface enters gap and frame (`docs/theory.md` §3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kinematics {
    /// Normal and gap of the deflected surface.
    #[default]
    Deformed,
    /// Normal and gap as if the surface stayed level: cheaper, for small slopes.
    Linear,
}

/// The point of a surface that belongs to a point of the world: its foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint<const D: usize> {
    /// The foot point, in the world.
    pub place: Vector<D>,
    /// The unit normal there, out of the body.
    pub normal: Vector<D>,
    /// The foot in coordinates fixed in the body, by which the body's owner can find it again.
    pub material: Vector<D>,
}

/// A point at which a surface may touch a side that lies over it, though it isn't under a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summit<const D: usize> {
    /// The point.
    pub point: SurfacePoint<D>,
    /// Where it is one because the surface is supported there, and bears even where it doesn't come out: within this distance (m) of it, a summit
    /// at which the surface does come out takes its place.
    pub support: Option<f64>,
}

/// The points x with n·x ≤ offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace<const D: usize> {
    /// The unit normal n, out of it.
    pub normal: Vector<D>,
    /// m.
    pub offset: f64,
}

impl<const D: usize> HalfSpace<D> {
    /// Whether a point is outside by more than rounding.
    #[inline]
    #[must_use]
    pub fn excludes(&self, x: &Vector<D>) -> bool {
        let mut size = self.offset.abs();
        for x in x.iter() {
            size += x.abs();
        }
        self.normal.dot(x) - self.offset > 8.0 * f64::EPSILON * size
    }
}

/// A pair of bodies that a detector looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wiring {
    /// The number of their pair. Two may have the same one if they are of the same body with two bodies
    /// of one part, such as corners on a beam and sides against its fibre, or of the same bodies with another law, such as that of
    /// one foot.
    pub pair: u32,
    /// The law of its contacts.
    pub law: LawId,
    /// The bodies of side 0 and of side 1.
    pub bodies: [BodyId; 2],
    /// Whether the detector needs the [surface](Geometry::surface) of the body of side 1.
    pub on_surface: bool,
    /// How many contacts the pair can have.
    pub contacts: usize,
    /// The first of its points that is not finite.
    pub not_finite: Option<usize>,
}

/// What a detector may ask of the bodies in one configuration.
pub trait Geometry<const D: usize> {
    /// Places points fixed in a body: `out[k]` is where `local[k]` is in the world. Both have the
    /// same length.
    fn place(&self, body: BodyId, local: &[Vector<D>], out: &mut [Vector<D>]);
    /// The point of the body's surface that belongs to the world's point `at`, its foot; `None`
    /// where the surface doesn't extend that far.
    fn surface(&self, body: BodyId, kinematics: Kinematics, at: &Vector<D>) -> Option<SurfacePoint<D>>;
    /// A half space that contains all points whose gap to the body's surface is at most `margin`
    /// (m), so that a detector can skip all others. `None`, the default, if there is no such bound.
    fn reach(&self, body: BodyId, margin: f64) -> Option<HalfSpace<D>> {
        let _ = (body, margin);
        None
    }
    /// Hands the points of the body's surface to `each`, from the left, at which it comes out
    /// furthest in a direction, more so than beside them, and whose feet lie between those of two
    /// places: the humps of a beam under a base. The points over its supports belong to them, too, as a surface bears there without
    /// coming out. None, the default, for a surface that is flat and has no supports.
    fn summits(
        &self,
        body: BodyId,
        kinematics: Kinematics,
        direction: &Vector<D>,
        between: &[Vector<D>; 2],
        each: &mut dyn FnMut(Summit<D>),
    ) {
        let _ = (body, kinematics, direction, between, each);
    }
    /// The points at which the body's surface ends, left and right; `None`, the default, where it
    /// doesn't.
    fn ends(&self, body: BodyId, kinematics: Kinematics) -> [Option<SurfacePoint<D>>; 2] {
        let _ = (body, kinematics);
        [None, None]
    }
}

/// Finds candidates for contact. The feature `conformance` brings a harness that holds a detector
/// to this page.
pub trait ContactDetector<const D: usize>: Send + Sync {
    /// Puts all candidates with a gap of at most `margin` (m) into `out`, which is cleared first,
    /// in an order that depends on the detector only. Allocates only if there are more than ever
    /// before.
    ///
    /// `memory` is what the detector has kept from earlier configurations for its own use. It is a
    /// hint: with an empty one the detector finds the same candidates, with the same identities, in
    /// the same order.
    fn detect(&self, at: &dyn Geometry<D>, margin: f64, memory: &mut DetectorMemory, out: &mut Candidates<D>);
    /// The deepest penetration of any candidate, m; 0 if there is none. `memory` is that of
    /// [`detect`](Self::detect), and `scratch` is memory for candidates; its content is lost. The
    /// default detects with a margin of 0.
    fn deepest(&self, at: &dyn Geometry<D>, memory: &mut DetectorMemory, scratch: &mut Candidates<D>) -> f64 {
        self.detect(at, 0.0, memory, scratch);
        scratch.iter().map(|candidate| -candidate.gap).fold(0.0, f64::max)
    }
    /// Puts those of the contacts `ids` that have a foot now into `out`, which is cleared first,
    /// however large their gaps. `ids` must ascend, and `out` ascends by identity. All are among
    /// them that [`detect`](Self::detect) finds with an infinite margin; there may be others, such
    /// as a corner that is over a side yet where other features of the two bodies are nearer by
    /// now. The default detects everything and keeps these.
    fn locate(&self, at: &dyn Geometry<D>, ids: &[ContactId], out: &mut Candidates<D>) {
        self.detect(at, f64::INFINITY, &mut DetectorMemory::default(), out);
        out.retain(|candidate| ids.binary_search(&candidate.id).is_ok());
        out.sort_unstable_by_key(|candidate| candidate.id);
    }
    /// The same, but with those contacts, too, that have been followed past the end of their
    /// surface, as if it went straight on: `room` tells of each in `out` how far it is to the
    /// nearest end, m, negative past it. A detector whose surfaces have no ends, or that doesn't
    /// follow past them, leaves this to the default, by which there is room without end.
    fn locate_past_ends(&self, at: &dyn Geometry<D>, ids: &[ContactId], out: &mut Candidates<D>, room: &mut Vec<f64>) {
        self.locate(at, ids, out);
        room.clear();
        room.resize(out.len(), f64::INFINITY);
    }
    /// Puts the number of the smooth piece of a surface on which each of the contacts `ids` is now into `pieces`,
    /// which is cleared first. Where it changes the curvature jumps, and the force with it, though the contact stays
    /// the same one: a disc that rolls from a side over the corner at its end. `pieces` stays empty where no contact
    /// can change its piece; this is the default.
    fn pieces(&self, at: &dyn Geometry<D>, ids: &[ContactId], pieces: &mut Vec<u32>) {
        let _ = (at, ids);
        pieces.clear();
    }
    /// Moves the sides of a contact that was found in this configuration to one place in the world. As found they are its gap apart, so that
    /// friction and its reaction make a couple, which no third body balances. Two bodies that are wedged can press each other with any
    /// force, and the couple would then move them. The default leaves the sides where they are, as is right where only one of the bodies
    /// can turn.
    fn bring_together(&self, at: &dyn Geometry<D>, contact: &mut Candidate<D>) {
        let _ = (at, contact);
    }
    /// How far the first body of a contact is beyond the second one along a unit direction, m: negative
    /// where they overlap along it. Along the normal of a side of either, if that is within 8° of the
    /// direction and they are further apart along it. Of bodies of several parts those count that touch.
    /// The default, `None`, is of a detector that doesn't know.
    fn beyond(&self, at: &dyn Geometry<D>, id: ContactId, direction: &Vector<D>) -> Option<f64> {
        let _ = (at, id, direction);
        None
    }
    /// Which side of a contact, 0 or 1, touches by one and the same point of its body as long as the contact lasts, as a
    /// sharp corner does and a disc doesn't. The default, `None`, is always right: a scheme that needs accelerations then
    /// takes the derivative of the rows along the motion, which costs more.
    fn fixed_side(&self, id: ContactId) -> Option<usize> {
        let _ = id;
        None
    }
    /// Whether a contact is with a surface where that [comes out](Geometry::summits) beside a base: its place on both
    /// bodies, and its number among several, follow the surface's shape. The default is `false`.
    fn is_summit(&self, id: ContactId) -> bool {
        let _ = id;
        false
    }
    /// The pairs that it looks at, as far as they are known before anything moves, so that a model
    /// can refuse what can't work when it is built. By default none are listed, and candidates are
    /// checked as they come.
    fn wiring(&self) -> Vec<Wiring> {
        Vec::new()
    }
    /// The largest number of candidates that there can ever be.
    fn capacity(&self) -> usize;
}
