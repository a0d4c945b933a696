//! A possible contact, its frame and its identity.

use crate::Vector;

/// A body of the scene, by a number that the model gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyId(pub u32);

/// The law of a contact, by a number that the model gives. It is apart from the contact's identity:
/// many pairs can have the same law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LawId(pub u32);

/// The identity of a contact, the same from step to step: the pair, and the feature that touches,
/// such as a point of the first side. A detector numbers features such that they keep their numbers
/// as bodies move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactId(u64);

impl ContactId {
    /// The contact of a pair's `point`-th point.
    #[must_use]
    pub fn new(pair: u32, point: u32) -> Self {
        Self(u64::from(pair) << 32 | u64::from(point))
    }

    /// The pair that the contact belongs to.
    #[must_use]
    pub fn pair(self) -> u32 {
        (self.0 >> 32) as u32
    }

    /// The point within the pair.
    #[must_use]
    pub fn point(self) -> u32 {
        (self.0 & u64::from(u32::MAX)) as u32
    }
}

/// A point fixed in a body: where one side of a contact acts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Anchor<const D: usize> {
    /// The body.
    pub body: BodyId,
    /// The point in the body's own coordinates.
    pub point: Vector<D>,
}

/// The contact's frame, a direction a row: normal first, then the tangents.
pub type Frame<const D: usize> = nalgebra::SMatrix<f64, D, D>;

/// The frame of a plane contact with unit normal `n`: rows n and t = (n_y, −n_x).
///
/// ```
/// let frame = teeter_detect::plane_frame(&nalgebra::Vector2::y());
/// assert_eq!(frame.row(1), nalgebra::RowVector2::new(1.0, 0.0)); // t to the right
/// ```
#[inline]
#[must_use]
pub fn plane_frame(n: &Vector<2>) -> Frame<2> {
    Frame::<2>::new(n.x, n.y, n.y, -n.x)
}

/// Two bodies that are near each other at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate<const D: usize> {
    /// Its identity over time.
    pub id: ContactId,
    /// The law of the contact.
    pub law: LawId,
    /// The point, and the foot on the surface.
    pub sides: [Anchor<D>; 2],
    /// Normal and tangents, rows.
    pub frame: Frame<D>,
    /// Distance along the normal, m; negative in penetration.
    pub gap: f64,
}

/// The candidates of one configuration.
pub type Candidates<const D: usize> = Vec<Candidate<D>>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_identity_keeps_its_parts() {
        let id = ContactId::new(7, u32::MAX);
        assert_eq!((id.pair(), id.point()), (7, u32::MAX));
        assert!(ContactId::new(1, 3) < ContactId::new(2, 0));
    }
}
