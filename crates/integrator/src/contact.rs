//! A contact of a step: its frame, velocities and impulse.

use crate::Vector;
use teeter_detect::{Anchor, Candidate, ContactId, Frame, LawId};

/// What a contact does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ContactState {
    /// No impulse.
    Open,
    /// No tangential velocity.
    Stick,
    /// Slides, friction at its limit.
    Slip,
}

impl ContactState {
    /// The word for it in tables.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::Stick => "stick",
            Self::Slip => "slip",
        }
    }
}

/// A contact that was active in a step, in its frame (normal first), with the step's Jacobian.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Contact<const D: usize> {
    /// Its identity.
    pub id: ContactId,
    /// Its law.
    pub law: LawId,
    /// Its points on either side, as they were found where its Jacobian rows were taken.
    pub sides: [Anchor<D>; 2],
    /// Its frame where its rows were taken, one direction a row.
    pub frame: Frame<D>,
    /// Gap at the position where its activation was decided, m; for a contact with duration, the
    /// gap of its spring at the start of the step.
    pub gap: f64,
    /// Impulse on side 0, N·s.
    pub p: Vector<D>,
    /// Relative velocity before the step, m/s.
    pub u_before: Vector<D>,
    /// Relative velocity after the step, m/s.
    pub u_after: Vector<D>,
    /// The velocity for which the law holds, U¹ + s, m/s: that after the step if the law has no
    /// shift.
    pub u_law: Vector<D>,
    /// Whether it was active in the step before, too.
    pub persisting: bool,
    /// For a contact with duration: the gap of its spring at the end of the step, m.
    pub gap_after: Option<f64>,
    /// Speed that counts as zero, m/s: a small fraction of the largest in the step's contact
    /// problem.
    pub still: f64,
}

/// A tangential speed below this fraction of the problem's largest |q| counts as sticking: above
/// the error at the default solver tolerance, below any real slide.
pub(crate) const STILL: f64 = 1e-8;

impl<const D: usize> Contact<D> {
    /// A candidate that takes part, before its impulse is known.
    #[inline]
    pub(crate) fn of(candidate: &Candidate<D>, persisting: bool) -> Self {
        Self {
            id: candidate.id,
            law: candidate.law,
            sides: candidate.sides,
            frame: candidate.frame,
            gap: candidate.gap,
            p: Vector::zeros(),
            u_before: Vector::zeros(),
            u_after: Vector::zeros(),
            u_law: Vector::zeros(),
            persisting,
            gap_after: None,
            still: 0.0,
        }
    }

    /// What the contact does in this step.
    #[must_use]
    pub fn state(&self) -> ContactState {
        if self.p[0] <= 0.0 {
            ContactState::Open
        } else if tangential(&self.u_law).norm() <= self.still {
            ContactState::Stick
        } else {
            ContactState::Slip
        }
    }
}

/// The tangential part of a vector in a contact's frame: its normal component set to zero.
#[must_use]
pub fn tangential<const D: usize>(u: &Vector<D>) -> Vector<D> {
    let mut t = *u;
    t[0] = 0.0;
    t
}
