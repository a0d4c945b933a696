//! What every time scheme offers.

use crate::{Contact, ContactError, FactorError, Mismatch, Model, State, StateError, StepEnergy, Workspace};
use teeter_contact::Outcome;

/// What happened in a step.
#[derive(Clone, Copy, Debug)]
pub struct StepReport<'w, const D: usize> {
    /// Number of the step, from 1.
    pub step: u64,
    /// Its start, s.
    pub t_start: f64,
    /// Its end, s.
    pub t_end: f64,
    /// The contacts that were active in it, in order of identity.
    pub contacts: &'w [Contact<D>],
    /// How their problem was solved; `None` without contacts.
    pub outcome: Option<Outcome>,
    /// Deepest penetration of a contact's point at its end, m; 0 if there is none.
    pub penetration: f64,
    /// Its energy account.
    pub energy: StepEnergy,
}

/// Why a step can't be taken.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// The effective mass matrix can't be factorised.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// The contact problem is not one, or not one that the scheme can pose.
    #[error("at t = {t} s: {source}")]
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
    /// A coordinate, a velocity or an energy is no longer finite.
    #[error("the motion diverged in the step from t = {t} s")]
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
            Self::Factor(_) | Self::State(_) | Self::Mismatch(_) => None,
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
pub trait Scheme<const D: usize>: Send {
    /// The name by which users choose it.
    fn name(&self) -> &'static str;

    /// Prepares for steps from this state: factorises, reserves; afterwards a step of the same size allocates nothing. From then on the
    /// scheme serves this model, until it is started with another.
    ///
    /// # Errors
    /// If a matrix can't be factorised, or state or workspace are of another model.
    fn start(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError>;

    /// Takes one step. After an error the state is as it was before the step.
    ///
    /// # Errors
    /// If the step can't be taken, or scheme, state or workspace are of another model; an unsolved contact problem is not an error here but a
    /// report.
    fn advance<'w>(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        work: &'w mut Workspace<D>,
    ) -> Result<StepReport<'w, D>, StepError>;
}
