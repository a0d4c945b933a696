//! Steps in a row, each shown to observers.

use crate::{Model, Scheme, State, StepError, StepReport, Workspace};
use std::error::Error;
use std::ops::ControlFlow;

/// An observer's own error, such as a full disk.
pub type ObserverError = Box<dyn Error + Send + Sync>;

/// Sees every step.
pub trait Observer<const D: usize> {
    /// Called once, before the first step of a run.
    ///
    /// # Errors
    /// The observer's own; it ends the run.
    fn start(&mut self, model: &Model<D>, state: &State) -> Result<(), ObserverError> {
        let _ = (model, state);
        Ok(())
    }

    /// Called after every step with the state at its end; `Break` ends the run.
    ///
    /// # Errors
    /// The observer's own; it ends the run.
    fn observe(
        &mut self,
        model: &Model<D>,
        step: &StepReport<'_, D>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError>;

    /// Called once, after the last step of a run, whatever ended it but an observer's error.
    ///
    /// # Errors
    /// The observer's own.
    fn finish(&mut self, model: &Model<D>, state: &State) -> Result<(), ObserverError> {
        let _ = (model, state);
        Ok(())
    }
}

/// How far a run goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// The number of the last step.
    pub steps: u64,
    /// Whether a contact problem that is not solved to tolerance ends the run.
    pub require_convergence: bool,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[must_use = "a run that failed is an `Ok` too"]
pub enum Ended {
    /// All steps were taken.
    Complete,
    /// An observer wanted it to end.
    Interrupted,
    /// A step was not solved to tolerance, and the plan requires it.
    Unconverged,
    /// A step could not be taken.
    Failed(StepError),
}

/// Why a run could not go on for reasons outside the mechanics.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// An observer failed.
    #[error(transparent)]
    Observer(ObserverError),
}

/// Takes steps up to the plan's last. The state is left at the last step taken, whatever ended the run. A state or a workspace of another model
/// ends it before observers see anything.
///
/// # Errors
/// If an observer fails.
pub fn run<const D: usize>(
    model: &Model<D>,
    scheme: &mut dyn Scheme<D>,
    state: &mut State,
    work: &mut Workspace<D>,
    plan: &Plan,
    observers: &mut [&mut dyn Observer<D>],
) -> Result<Ended, RunError> {
    let checked = state.check(model).map_err(StepError::from).and_then(|()| Ok(work.check(model)?));
    if let Err(error) = checked {
        return Ok(Ended::Failed(error));
    }
    for observer in observers.iter_mut() {
        observer.start(model, state).map_err(RunError::Observer)?;
    }
    let ended = match scheme.start(model, state, work) {
        Ok(()) => take_steps(model, scheme, state, work, plan, observers)?,
        Err(error) => Ended::Failed(error),
    };
    for observer in observers.iter_mut() {
        observer.finish(model, state).map_err(RunError::Observer)?;
    }
    Ok(ended)
}

fn take_steps<const D: usize>(
    model: &Model<D>,
    scheme: &mut dyn Scheme<D>,
    state: &mut State,
    work: &mut Workspace<D>,
    plan: &Plan,
    observers: &mut [&mut dyn Observer<D>],
) -> Result<Ended, RunError> {
    while state.step < plan.steps {
        let step = match scheme.advance(model, state, work) {
            Ok(step) => step,
            Err(error) => return Ok(Ended::Failed(error)),
        };
        let mut goes_on = true;
        for observer in observers.iter_mut() {
            goes_on &= observer.observe(model, &step, state).map_err(RunError::Observer)?.is_continue();
        }
        if plan.require_convergence && step.outcome.is_some_and(|outcome| !outcome.converged()) {
            return Ok(Ended::Unconverged);
        }
        if !goes_on {
            return Ok(Ended::Interrupted);
        }
    }
    Ok(Ended::Complete)
}
