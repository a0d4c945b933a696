//! The loop over steps, each reported to observers.

use crate::{ContactError, Model, STEP_ROUNDING, Scheme, State, StepError, StepReport, Workspace};
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

    /// Called once, after the last step of a run, unless an observer's error ended it.
    ///
    /// # Errors
    /// The observer's own.
    fn finish(&mut self, model: &Model<D>, state: &State) -> Result<(), ObserverError> {
        let _ = (model, state);
        Ok(())
    }
}

/// Where a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Until {
    /// With the step of this number.
    Step(u64),
    /// At this time, s.
    Time(f64),
}

/// How far a run goes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Plan {
    /// Where it ends.
    pub until: Until,
    /// What happens if a contact problem is not solved to tolerance.
    pub unsolved: Unsolved,
}

/// What happens to a run if a contact problem is not solved to tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unsolved {
    /// It continues with the best impulses found.
    #[default]
    GoOn,
    /// It ends.
    End,
}

impl Plan {
    /// To the step of this number.
    #[must_use]
    pub const fn steps(number: u64) -> Self {
        Self { until: Until::Step(number), unsolved: Unsolved::GoOn }
    }

    /// To this time, s: the last step is cut short where it would go past.
    #[must_use]
    pub const fn time(t: f64) -> Self {
        Self { until: Until::Time(t), unsolved: Unsolved::GoOn }
    }

    /// The same, with this choice for contact problems that are not solved to tolerance.
    #[must_use]
    pub const fn when_unsolved(mut self, unsolved: Unsolved) -> Self {
        self.unsolved = unsolved;
        self
    }

    /// Whether a state has reached the plan's end.
    #[must_use]
    pub fn is_done(&self, state: &State) -> bool {
        match self.until {
            Until::Step(number) => state.step >= number,
            Until::Time(t) => state.has_reached(t),
        }
    }

    /// How many steps of the state's size are left; 0 if it is done.
    #[must_use]
    pub fn steps_from(&self, state: &State) -> u64 {
        match self.until {
            Until::Step(number) => number.saturating_sub(state.step),
            Until::Time(_) if self.is_done(state) => 0,
            Until::Time(t) => ((t - state.t) / state.dt - STEP_ROUNDING).ceil() as u64,
        }
    }

    /// The time that no step goes past, s.
    #[must_use]
    pub fn end(&self) -> f64 {
        match self.until {
            Until::Step(_) => f64::INFINITY,
            Until::Time(t) => t,
        }
    }
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[must_use = "a run that failed is an `Ok` too"]
pub enum Ended {
    /// All steps were taken.
    Complete,
    /// An observer wanted it to end, or [`Workspace::cancel`] was set.
    Interrupted,
    /// A step was not solved to tolerance, and the plan ends the run there.
    Unconverged,
    /// A step could not be taken.
    Failed(StepError),
}

impl StepError {
    /// How a run ends whose step failed by this.
    fn ends(self) -> Ended {
        match self {
            Self::Problem { source: ContactError::Cancelled, .. } => Ended::Interrupted,
            error => Ended::Failed(error),
        }
    }
}

/// Why a run could not go on for reasons outside the mechanics.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// An observer failed.
    #[error(transparent)]
    Observer(ObserverError),
}

/// Takes steps up to the end of the plan. The state is left at the last step taken, whatever ended
/// the run. If the state or the workspace is of another model, the run fails before observers are
/// called.
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
        Err(error) => error.ends(),
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
    while !plan.is_done(state) {
        // A step without contacts solves no problem in which the flag is looked at.
        if work.is_cancelled() {
            return Ok(Ended::Interrupted);
        }
        let step = match scheme.advance(model, state, plan.end(), work) {
            Ok(step) => step,
            Err(error) => return Ok(error.ends()),
        };
        let mut goes_on = true;
        for observer in observers.iter_mut() {
            goes_on &= observer.observe(model, &step, state).map_err(RunError::Observer)?.is_continue();
        }
        if plan.unsolved == Unsolved::End && step.outcome().is_some_and(|outcome| !outcome.converged()) {
            return Ok(Ended::Unconverged);
        }
        if !goes_on {
            return Ok(Ended::Interrupted);
        }
    }
    Ok(Ended::Complete)
}
