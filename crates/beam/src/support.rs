//! How a node of a beam is held.

use std::fmt;

use crate::error::BeamError;
use crate::section::not_negative;

/// How one of the two motions of a node is held.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum Hold {
    /// Not at all.
    #[default]
    Free,
    /// It can't move.
    Fixed,
    /// By a spring and a dashpot to the ground: N/m and N s/m for the deflection, N m/rad and N m
    /// s/rad for the rotation.
    Spring {
        /// Stiffness.
        stiffness: f64,
        /// Damping.
        damping: f64,
    },
}

/// How a node of the beam is held: at its ends, or anywhere along it.
///
/// A support says nothing of the axis: see [`Axial`](crate::Axial).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Support {
    /// Not held.
    Free,
    /// w = 0, free of moment.
    Pinned,
    /// w = 0 and no rotation.
    Clamped,
    /// No rotation, free of shear.
    Guided,
    /// Each motion in its own way, springs and dashpots among them.
    Elastic {
        /// The deflection w.
        deflection: Hold,
        /// The rotation of the section: w' for Euler–Bernoulli.
        rotation: Hold,
    },
}

/// Its word; of springs and dashpots, both motions.
impl fmt::Display for Support {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Free => f.write_str("free"),
            Self::Pinned => f.write_str("pinned"),
            Self::Clamped => f.write_str("clamped"),
            Self::Guided => f.write_str("guided"),
            Self::Elastic { deflection, rotation } => {
                write!(
                    f,
                    "elastic (deflection {}, rotation {})",
                    Held(*deflection, "N/m", "N s/m"),
                    Held(*rotation, "N m/rad", "N m s/rad")
                )
            }
        }
    }
}

/// How a motion is held, with the units of stiffness and damping.
struct Held(Hold, &'static str, &'static str);

impl fmt::Display for Held {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(hold, stiff, damped) = self;
        match hold {
            Hold::Free => f.write_str("free"),
            Hold::Fixed => f.write_str("fixed"),
            Hold::Spring { stiffness, damping: 0.0 } => write!(f, "{stiffness:?} {stiff}"),
            Hold::Spring { stiffness, damping } => write!(f, "{stiffness:?} {stiff} and {damping:?} {damped}"),
        }
    }
}

impl Support {
    /// How deflection and rotation are held.
    #[must_use]
    pub fn holds(self) -> [Hold; 2] {
        match self {
            Self::Free => [Hold::Free, Hold::Free],
            Self::Pinned => [Hold::Fixed, Hold::Free],
            Self::Clamped => [Hold::Fixed, Hold::Fixed],
            Self::Guided => [Hold::Free, Hold::Fixed],
            Self::Elastic { deflection, rotation } => [deflection, rotation],
        }
    }

    pub(crate) fn validate(self) -> Result<(), BeamError> {
        let names =
            [["support.spring", "support.dashpot"], ["support.rotational_spring", "support.rotational_dashpot"]];
        for (hold, [spring, dashpot]) in self.holds().into_iter().zip(names) {
            if let Hold::Spring { stiffness, damping } = hold {
                not_negative(spring, stiffness)?;
                not_negative(dashpot, damping)?;
            }
        }
        Ok(())
    }
}
