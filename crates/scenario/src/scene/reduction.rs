//! A beam in few coordinates, as a scene asks for it.

use teeter_beam::{Beam, ModalBasis, ModalError};

/// In which shapes a beam moves, where these are not those of all its nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Reduction {
    /// So many of its lowest modes, rigid motions included.
    Modes(usize),
    /// As few modes and static corrections as its static flexibility needs.
    Flexibility {
        /// Largest relative error of the flexibility in the region.
        tolerance: f64,
        /// From where to where, m from the left end.
        region: [f64; 2],
    },
}

impl Reduction {
    /// Its tolerance where a scene gives none, over the whole span.
    pub const TOLERANCE: f64 = 1e-4;

    /// The shapes of this beam.
    ///
    /// # Errors
    /// As [`ModalBasis::new`] and [`ModalBasis::for_tolerance`].
    pub fn basis(&self, beam: &Beam) -> Result<ModalBasis, ModalError> {
        match *self {
            Self::Modes(count) => ModalBasis::new(beam, count, &[]),
            Self::Flexibility { tolerance, region } => ModalBasis::for_tolerance(beam, region, tolerance),
        }
    }

    /// The part of a beam of this span (m) whose flexibility counts.
    #[must_use]
    pub fn region(&self, span: f64) -> [f64; 2] {
        match *self {
            Self::Modes(_) => [0.0, span],
            Self::Flexibility { region, .. } => region,
        }
    }
}
