//! What is wrong with shapes and pairs.

use crate::{BodyId, MOST_CORNERS};

/// What is wrong with shapes and pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WiringError {
    /// A body whose parts have more corners together than a contact's identity can number.
    Corners {
        /// The body.
        body: BodyId,
        /// How many there are.
        corners: usize,
    },
    /// More bodies in groups than pairs of them can be numbered.
    Members {
        /// How many there are.
        members: usize,
        /// How many there can be.
        most: usize,
    },
    /// A body that is in groups twice.
    ListedTwice {
        /// The body.
        body: BodyId,
    },
    /// A body whose class has no entry in the table of laws.
    NoClass {
        /// The body.
        body: BodyId,
        /// Its class.
        class: usize,
    },
    /// A body of groups that has no shape.
    Shapeless {
        /// The body.
        body: BodyId,
    },
    /// A pair of a body that has no shape.
    NoShape {
        /// The pair's number.
        pair: u32,
        /// The body.
        body: BodyId,
    },
}

impl std::fmt::Display for WiringError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Corners { body, corners } => {
                write!(
                    f,
                    "the parts of body {} have {corners} corners together, but at most {MOST_CORNERS} can be told apart",
                    body.0
                )
            }
            Self::Members { members, most } => {
                write!(f, "there are {members} bodies of which any two can touch, but at most {most} can be told apart")
            }
            Self::ListedTwice { body } => write!(f, "body {} is listed twice: give each body one class", body.0),
            Self::NoClass { body, class } => {
                write!(f, "body {} is of class {class}, for which the table of laws has no entry", body.0)
            }
            Self::Shapeless { body } => write!(f, "body {} has no shape: give it one", body.0),
            Self::NoShape { pair, body } => {
                write!(f, "pair {pair} is of body {}, which has no shape: give it one", body.0)
            }
        }
    }
}

impl std::error::Error for WiringError {}
