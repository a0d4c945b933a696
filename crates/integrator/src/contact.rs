//! A contact of a step: what it did, and in which frame.

use crate::Vector;
use teeter_detect::{Anchor, Candidate, ContactId, Frame, LawId};

/// What a contact does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// Who it is.
    pub id: ContactId,
    /// By which law it answers.
    pub law: LawId,
    /// Where it acts on either side, as its rows were taken.
    pub sides: [Anchor<D>; 2],
    /// Its frame as its rows were taken, a direction a row.
    pub frame: Frame<D>,
    /// Gap where the activation was decided, m; of a contact with duration, the gap of its spring at the start of the step.
    pub gap: f64,
    /// Impulse on side 0, N·s.
    pub p: Vector<D>,
    /// Relative velocity before the step, m/s.
    pub u_before: Vector<D>,
    /// Relative velocity after the step, m/s.
    pub u_after: Vector<D>,
    /// The velocity that the law holds for, U¹ + s, m/s: after the step where the law has no shift.
    pub u_law: Vector<D>,
    /// Whether it was active in the step before, too.
    pub persisting: bool,
    /// Of a contact with duration: the gap of its spring at the end of the step, m.
    pub gap_after: Option<f64>,
    /// Speed below which it counts as zero, m/s: a small part of the fastest of the step's contact problem.
    pub still: f64,
}

/// A tangential speed below this part of the problem's largest |q| is sticking: above the default solver tolerance's
/// error, below any slide worth the name.
pub(crate) const STILL: f64 = 1e-8;

impl<const D: usize> Contact<D> {
    /// A candidate that takes part, before anything is known of its impulse.
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
