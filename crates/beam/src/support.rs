//! How a node of a beam is held.

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
    /// By a spring and a dashpot to the ground: N/m and N s/m for the deflection, N m/rad and N m s/rad for the rotation.
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
