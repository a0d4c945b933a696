//! What a run of teeter writes: CSV tables, the summary, the scene as run.
//!
//! [`Results`] is a folder; [`Recorder`] is the observer that fills its tables step by step; [`Summary`] is what
//! `summary.json` holds. Numbers are written so that they read back to the same double.

mod contacts;
mod export;
mod number;
mod page;
mod recorder;
mod results;
mod schedule;
mod summary;
mod table;
mod warnings;

pub use export::{ExportWhen, Exporter, HARD, Watch};
pub use page::{HalfCycle, PageRecorder, figures, half_cycles, render};
pub use recorder::{ImpactRow, Record, Recorder};
pub use results::{FILES, Results, ResultsError};
pub use schedule::Schedule;
pub use summary::{EndedWord, Summary};
pub use warnings::{Warning, WarningLog};

/// A contact that was open in the step before and closes faster than this speed (m/s) is an impact.
///
/// A resting contact that drops out for one step falls for that step, so it comes back with some g·dt; twice that keeps
/// it out of the list of impacts, and goes to zero with the step.
#[must_use]
pub fn impact_threshold(gravity: [f64; 2], dt: f64) -> f64 {
    2.0 * gravity[0].hypot(gravity[1]) * dt
}
