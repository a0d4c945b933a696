//! Why contacts can't be solved.

use crate::Mismatch;
use teeter_contact::ProblemError;
use teeter_detect::BodyId;

/// Why contacts can't be solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ContactError {
    /// They don't make a problem.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// What was given doesn't belong to them.
    #[error(transparent)]
    Mismatch(#[from] Mismatch),
    /// The step was abandoned by [`Workspace::cancel`](crate::Workspace::cancel).
    #[error("the step was abandoned, as its caller wanted")]
    Cancelled,
    /// A law that has no meaning over such a time.
    #[error("pair {pair} has {law}, which has no meaning {over}: leave its contacts out of this stage")]
    Law {
        /// The pair.
        pair: u32,
        /// The law.
        law: &'static str,
        /// Over what time.
        over: &'static str,
    },
    /// A contact that was not posed.
    #[error(
        "contact {contact} of the stage was not posed: ContactStage::pose does that for all, ContactStage::set for one"
    )]
    Unposed {
        /// Its number.
        contact: usize,
    },
    /// Rules that can't be solved together.
    #[error("contact {contact} slides in a given direction, which goes with contacts of the standard law only")]
    Rules {
        /// The contact that slides.
        contact: usize,
    },
    /// A body whose points' accelerations aren't known.
    #[error("body {} doesn't say how its points are accelerated by their velocities: it needs Bodies::bias for contacts over accelerations", body.0)]
    Bias {
        /// The body.
        body: BodyId,
    },
    /// Forces where impulses belong.
    #[error(
        "the stage holds forces, solved over accelerations, but a phase takes impulses: solve it over the phase's time, or hand the phase in without it"
    )]
    Forces,
    /// No factors of the weights asked for.
    #[error("subsystem {part} has no factors of these weights: ask Workspace::factors for them first")]
    Factors {
        /// Number of the subsystem.
        part: usize,
    },
}
