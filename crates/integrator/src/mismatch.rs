//! Errors for parts that don't belong together.

use std::sync::atomic::{AtomicU64, Ordering};
use teeter_detect::{BodyId, ContactId, LawId};

/// Things that don't belong together: slices of another length, a workspace of another model, a
/// pair that isn't there.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Mismatch {
    /// Too few or too many numbers.
    #[error("{found} numbers given for {what}, but the model needs {expected}")]
    Length {
        /// What they are.
        what: &'static str,
        /// Numbers given.
        found: usize,
        /// Numbers needed.
        expected: usize,
    },
    /// A workspace, a scheme or contacts of another model, even one of the same sizes.
    #[error("{what} of another model: {remedy}")]
    OtherModel {
        /// What is used.
        what: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A law that the model doesn't have.
    #[error("there is no law {}: the model has {laws}, numbered from 0", law.0)]
    Law {
        /// Its number.
        law: LawId,
        /// How many there are.
        laws: usize,
    },
    /// A body that the model doesn't have.
    #[error("there is no body {}: the model has {bodies}, numbered from 0", body.0)]
    Body {
        /// The body.
        body: BodyId,
        /// How many there are.
        bodies: usize,
    },
    /// A contact that isn't there.
    #[error("there is no contact {contact}: there are {contacts}, numbered from 0")]
    Contact {
        /// Its number.
        contact: usize,
        /// How many there are.
        contacts: usize,
    },
    /// A contact whose point has no foot on the surface.
    #[error("point {} of pair {} touches nothing at these coordinates", id.point(), id.pair())]
    NotThere {
        /// The contact.
        id: ContactId,
    },
    /// Contacts of a step that don't rise in identity.
    #[error(
        "contact {contact} comes after one of a higher number, or twice: contacts are added to a stage in order of identity"
    )]
    ContactOrder {
        /// Its number in the stage.
        contact: usize,
    },
    /// A candidate of another contact.
    #[error("contact {contact} is another one than the candidate")]
    OtherContact {
        /// Its number in the stage.
        contact: usize,
    },
    /// A subsystem whose row names a velocity that it doesn't have.
    #[error("a row of body {} has an entry in column {column}, but its subsystem has {velocities} velocities", body.0)]
    Column {
        /// The body whose point the row is of.
        body: BodyId,
        /// The column.
        column: usize,
        /// How many velocities there are.
        velocities: usize,
    },
}

/// Whether a slice is as long as it must be.
#[inline]
pub(crate) fn length<T>(what: &'static str, x: &[T], expected: usize) -> Result<(), Mismatch> {
    if x.len() == expected { Ok(()) } else { Err(other_length(what, x.len(), expected)) }
}

#[cold]
fn other_length(what: &'static str, found: usize, expected: usize) -> Mismatch {
    Mismatch::Length { what, found, expected }
}

/// Identity of a model: no two models built in one process have the same. It is compared for
/// equality only and never stored, so that no result depends on how many models were built before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Identity(u64);

impl Identity {
    pub(crate) fn new() -> Self {
        static BUILT: AtomicU64 = AtomicU64::new(0);
        Self(BUILT.fetch_add(1, Ordering::Relaxed))
    }
}
