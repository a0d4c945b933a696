//! Ctrl-C: the run ends after the step at hand, with its rows complete; a second one ends the program at once.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use teeter_integrator::{Model, Observer, ObserverError, State, StepReport};

/// Exit code of a program that a user ended.
pub(crate) const INTERRUPTED: u8 = 130;

static WANTED: AtomicBool = AtomicBool::new(false);

/// Ends a run when the user wants it to.
#[derive(Debug)]
pub(crate) struct Interrupt;

impl Interrupt {
    /// Listens for Ctrl-C from now on. Where that is impossible the signal ends the program as it always did.
    pub(crate) fn listen() -> Self {
        let _ = ctrlc::set_handler(|| {
            if WANTED.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(INTERRUPTED));
            }
        });
        Self
    }
}

impl Observer<2> for Interrupt {
    fn observe(&mut self, _: &Model<2>, _: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        Ok(if WANTED.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }
}
