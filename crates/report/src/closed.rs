//! The contacts that close in a step: told once, for the tables and for the page.

use teeter_integrator::{Closing, ClosingMonitor, Contact, Mismatch, Model, State, StepReport};
use teeter_scenario::simulation::Layout;

/// A contact that closed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closed {
    /// The end of the phase in which it did, s.
    pub(crate) t: f64,
    pub(crate) contact: Contact<2>,
    pub(crate) closing: Closing,
}

impl Closed {
    /// Puts those of a step into `out`, which is cleared first.
    pub(crate) fn of_step(
        closings: &mut ClosingMonitor<2>,
        model: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
        layout: &Layout,
        out: &mut Vec<Self>,
    ) -> Result<(), Mismatch> {
        out.clear();
        closings.enter(model, step, state, &layout.openings, |t, contact, closing| {
            out.push(Self { t, contact: *contact, closing });
        })
    }
}
