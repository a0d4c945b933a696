//! What every time scheme offers.

use crate::{ContactError, FactorError, Mismatch, Model, State, StateError, StepReport, Workspace};

/// A time for a message: sums of steps end in digits that say nothing.
pub(crate) fn few_digits(t: f64) -> f64 {
    format!("{t:.8e}").parse().unwrap_or(t)
}

/// Why a step can't be taken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// The effective mass matrix can't be factorised.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// The contact problem is not one, or not one that the scheme can pose.
    #[error("at t = {} s: {source}", few_digits(*t))]
    Problem {
        /// Start of the step, s.
        t: f64,
        /// What is wrong with it.
        source: ContactError,
    },
    /// The state is not one of the model, or not one to step from.
    #[error(transparent)]
    State(#[from] StateError),
    /// Scheme, workspace or numbers are of another model.
    #[error(transparent)]
    Mismatch(#[from] Mismatch),
    /// The model has something that the scheme can't do, such as prescribed velocities.
    #[error("the scheme can't take steps of a model with {what}")]
    Unsupported {
        /// What it has.
        what: &'static str,
    },
    /// A scheme that ends a phase or a step that it hasn't begun.
    #[error("the scheme ended what it has not begun: Workspace::begin comes before each step")]
    NotBegun,
    /// A scheme that ended a step without a phase in it.
    #[error("the scheme ended a step without a phase: Workspace::phase comes before Workspace::finish")]
    NoPhase,
    /// A coordinate, a velocity or an energy is no longer finite.
    #[error("the motion diverged in the step from t = {} s", few_digits(*t))]
    Diverged {
        /// Start of the step, s.
        t: f64,
    },
}

impl StepError {
    /// The start of the step that can't be taken, s; `None` where it is not about a time.
    #[must_use]
    pub fn t(&self) -> Option<f64> {
        match self {
            Self::Problem { t, .. } | Self::Diverged { t } => Some(*t),
            Self::Factor(_)
            | Self::State(_)
            | Self::Mismatch(_)
            | Self::Unsupported { .. }
            | Self::NoPhase
            | Self::NotBegun => None,
        }
    }
}

/// A setting of a scheme out of its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what} is {value}, but must be {rule}")]
pub struct SettingError {
    /// Which setting.
    pub what: &'static str,
    /// Its value.
    pub value: f64,
    /// The range.
    pub rule: &'static str,
}

/// A time scheme: it owns every formula of time integration, and decides which candidates are contacts.
///
/// # What a scheme owes
///
/// One call of [`advance`](Self::advance) is one step: it is [begun](Workspace::begin) with a span of time, has one
/// [phase](Workspace::phase) or more (forces and impulses together, or smooth motion and impacts apart), and is
/// [finished](Workspace::finish), which moves time, places, velocities, ledger, tally and what is remembered of contacts. A scheme changes
/// the state by nothing else, but for numbers of its own in [`State::memory`](crate::State).
///
/// - **Time**: a step never ends past `until`, and loads and drives are taken at its true times: [`State::next_step`] says from when to when it
///   goes. A scheme with a step size of its own asks [`State::step_of`].
/// - **Contacts** come from candidates to impulses by a [`ContactStage`](crate::ContactStage), which knows every law: what can't be honoured is an
///   error there.
/// - **Energy**: each phase says what loads, dampers and the scheme itself did; with the work of contacts that has to explain the change of
///   energy, and what is left over is reported as the residual.
/// - **Memory**: what decides the next step is in the state. A scheme that is started with a state from elsewhere goes on to the same bytes;
///   [`WarmStart`](crate::WarmStart) is a hint that may be lost.
/// - **Errors** leave the state as it was. A contact problem that is not solved is not an error but an
///   [outcome](crate::StepReport::outcome).
/// - **Allocations**: none, in a step that meets no new maximum of contacts, phases or step sizes.
///
/// The feature `conformance` brings a harness that holds a scheme to this.
pub trait Scheme<const D: usize>: Send + Sync {
    /// The name by which users choose it.
    fn name(&self) -> &'static str;

    /// The θ with which prescribed velocities at the end of a step are means about it, as
    /// [`State::drive_about`] takes them; `None`, the default, where they are those of that time.
    fn drives_about(&self) -> Option<f64> {
        None
    }

    /// Prepares for steps from this state: factorises, reserves; afterwards a step of the same size allocates nothing. From then on the
    /// scheme serves this model, until it is started with another.
    ///
    /// # Errors
    /// If a matrix can't be factorised, or state or workspace are of another model.
    fn start(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError>;

    /// Takes one step, never past `until` (s; infinity for no end). After an error the state is as it was before the step.
    ///
    /// # Errors
    /// If the step can't be taken, or scheme, state or workspace are of another model; an unsolved contact problem is not an error here but a
    /// report.
    fn advance<'w>(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        until: f64,
        work: &'w mut Workspace<D>,
    ) -> Result<StepReport<'w, D>, StepError>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_messages_have_few_digits() {
        assert_eq!(StepError::Diverged { t: 0.1 + 0.2 }.to_string(), "the motion diverged in the step from t = 0.3 s");
        assert_eq!((few_digits(12.000_1), few_digits(f64::NAN).is_nan()), (12.000_1, true));
    }
}
