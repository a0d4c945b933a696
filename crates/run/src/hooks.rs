//! Hooks with which a front end follows and cancels a run.

use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_integrator::{Model, Observer, ObserverError, State, StepReport};

/// Progress of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// The number of the last step taken, counted from t = 0.
    pub step: u64,
    /// The number of the last step of the run.
    pub of: u64,
    /// The time reached, s.
    pub t: f64,
}

/// Number of steps between calls of the progress hook.
pub const PROGRESS_STEPS: u64 = 256;

type OnStart<'a> = Box<dyn FnOnce() + 'a>;
type OnProgress<'a> = Box<dyn FnMut(Progress) + 'a>;
type OnWarning<'a> = Box<dyn FnMut(&str) + 'a>;

/// Callbacks during a run, all on the thread of [`Prepared::run`](crate::Prepared::run); none by
/// default.
#[derive(Default)]
pub struct Hooks<'a> {
    pub(crate) start: Option<OnStart<'a>>,
    pub(crate) progress: Option<OnProgress<'a>>,
    pub(crate) warning: Option<OnWarning<'a>>,
    pub(crate) cancel: Option<Arc<AtomicBool>>,
}

impl<'a> Hooks<'a> {
    /// No hooks.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Called once, after the folders for the results are locked and before anything is simulated.
    #[must_use]
    pub fn on_start(mut self, hook: impl FnOnce() + 'a) -> Self {
        self.start = Some(Box::new(hook));
        self
    }

    /// Called before the first step, after each step whose number is a multiple of
    /// [`PROGRESS_STEPS`], and after the last step, however the run ended. Step numbers increase
    /// from call to call.
    #[must_use]
    pub fn on_progress(mut self, hook: impl FnMut(Progress) + 'a) -> Self {
        self.progress = Some(Box::new(hook));
        self
    }

    /// Called with the text of each warning when it occurs; only for the first few of each kind.
    /// All are counted in [`Summary::warnings`](crate::Summary::warnings).
    #[must_use]
    pub fn on_warning(mut self, hook: impl FnMut(&str) + 'a) -> Self {
        self.warning = Some(Box::new(hook));
        self
    }

    /// Ends the run when `flag` is set, with the rows of all whole steps, a summary that says so,
    /// and a checkpoint if checkpoints are written. A step whose contact problems are being solved
    /// is abandoned, however long it would take: the run ends with the step before it. Any thread or
    /// signal handler may set the flag.
    #[must_use]
    pub fn cancelled_by(mut self, flag: &Arc<AtomicBool>) -> Self {
        self.cancel = Some(Arc::clone(flag));
        self
    }
}

impl fmt::Debug for Hooks<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Hooks")
            .field("start", &self.start.is_some())
            .field("progress", &self.progress.is_some())
            .field("warning", &self.warning.is_some())
            .field("cancel", &self.cancel)
            .finish()
    }
}

/// The observer that calls the progress hook.
pub(crate) struct ProgressObserver<'a> {
    hook: Option<OnProgress<'a>>,
    of: u64,
    /// The last reported step.
    told: Option<u64>,
}

impl<'a> ProgressObserver<'a> {
    pub(crate) fn new(hook: Option<OnProgress<'a>>, of: u64) -> Self {
        Self { hook, of, told: None }
    }

    /// Reports this state, unless it was already reported.
    pub(crate) fn tell(&mut self, state: &State) {
        let Some(hook) = self.hook.as_mut().filter(|_| self.told != Some(state.step)) else { return };
        self.told = Some(state.step);
        hook(Progress { step: state.step, of: self.of, t: state.t });
    }
}

impl Observer<2> for ProgressObserver<'_> {
    fn start(&mut self, _: &Model<2>, state: &State) -> Result<(), ObserverError> {
        self.tell(state);
        Ok(())
    }

    fn observe(
        &mut self,
        _: &Model<2>,
        _: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        if state.step.is_multiple_of(PROGRESS_STEPS) {
            self.tell(state);
        }
        Ok(ControlFlow::Continue(()))
    }
}
