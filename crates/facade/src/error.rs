//! What can go wrong, from wiring to the last step.

use teeter_integrator::{ModelError, ObserverError, SettingError, StateError, StepError};

/// Why a world can't be simulated, or a simulation can't go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    /// A handle that another world gave out.
    #[error("{what} of another world: use the handles that this world gave out")]
    OtherWorld {
        /// What the handle is of.
        what: &'static str,
    },
    /// A law, load or wiring that can't work.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A start or a step size that can't work.
    #[error(transparent)]
    State(#[from] StateError),
    /// A setting of the scheme out of its range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A step that can't be taken. The simulation is as it was before the step.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A contact problem that was not solved to tolerance. The step was taken with the best impulses found.
    #[error("the contact problem of the step that ends at t = {t} s was not solved to tolerance")]
    Unsolved {
        /// End of the step, s.
        t: f64,
    },
    /// An observer's own error.
    #[error(transparent)]
    Observer(ObserverError),
}
