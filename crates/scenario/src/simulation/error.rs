//! Why the model of a scene can't be built.

use crate::placement::PlacementError;
use teeter_beam::{BeamError, ModalError};
use teeter_detect::{ShapeError, WiringError};
use teeter_integrator::{Mismatch, ModelError, SettingError, StateError};
use teeter_rigid::RigidError;
use teeter_text::readable::with_digits;

/// Why the model of a scene can't be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// Invalid values of a block.
    #[error("block `{0}`: {1}")]
    Block(String, RigidError),
    /// Invalid values of a beam.
    #[error("beam `{0}`: {1}")]
    Beam(String, BeamError),
    /// The modal basis of a beam can't be found.
    #[error("beam `{0}`: {1}")]
    Modes(String, ModalError),
    /// There is no initial state.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// An invalid contact law.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// An invalid initial state.
    #[error(transparent)]
    State(#[from] StateError),
    /// Parts that don't match.
    #[error(transparent)]
    Mismatch(#[from] Mismatch),
    /// Invalid settings of the scheme.
    #[error(transparent)]
    Scheme(#[from] SettingError),
    /// An unknown solver.
    #[error("there is no solver `{0}`")]
    Solver(String),
    /// A corner that starts below its surface.
    #[error(
        "block `{block}`: {} starts {} {} `{surface}`; up to {} are allowed for rounding",
        touching(*on_side, corner), with_digits(*depth, "m", 2), beyond(*on_side, *lower), with_digits(*tolerance, "m", 2)
    )]
    Penetration {
        /// The block.
        block: String,
        /// The corner, or what of a beam touches a side.
        corner: String,
        /// Whether it is a side that is penetrated.
        on_side: bool,
        /// Whether it is the lower face of a beam.
        lower: bool,
        /// The body that it penetrates.
        surface: String,
        /// Depth, m.
        depth: f64,
        /// Largest allowed depth, m.
        tolerance: f64,
    },
    /// A crest of the ground that starts inside a block.
    #[error("block `{block}`: the ground's crest-{crest} starts inside it")]
    CrestInside {
        /// The block.
        block: String,
        /// The point of the profile, from 1 on.
        crest: usize,
    },
    /// An invalid shape of a block.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// Shapes and pairs that don't match.
    #[error(transparent)]
    Wiring(#[from] WiringError),
    /// Two blocks that start in the same place.
    #[error("block `{second}`: it overlaps `{first}` by {} at the start", with_digits(*depth, "m", 2))]
    Overlap {
        /// The block that comes first in the file.
        first: String,
        /// The other one.
        second: String,
        /// Displacement needed to separate them, m.
        depth: f64,
    },
}

/// What of a block starts inside something, in words.
pub(crate) fn touching(on_side: bool, corner: &str) -> String {
    if on_side { format!("a side ({corner})") } else { format!("the corner {corner}") }
}

/// Where that starts.
pub(crate) fn beyond(on_side: bool, lower: bool) -> &'static str {
    match (on_side, lower) {
        (true, _) => "inside",
        (false, false) => "below the surface of",
        (false, true) => "above the lower face of",
    }
}
