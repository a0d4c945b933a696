//! What a run of teeter writes: CSV tables, the summary, the scene as run.
//!
//! [`Results`] is a folder; [`Recorder`] is the observer that fills its tables step by step; [`Summary`] is what
//! `summary.json` holds. [`RunRecorder`] has all that a run of the program writes, and checkpoints from which it goes on to
//! the same bytes. Numbers are written so that they read back to the same double.

mod all_digits;
mod bounces;
mod checkpoint;
mod closed;
mod columns;
mod contacts;
mod deflections;
mod driven;
mod export;
mod feet_lines;
mod first;
mod lock;
mod made_energy;
mod meetings;
mod number;
mod own_weight;
mod page;
mod probe;
mod recorder;
mod resolution;
mod results;
mod run_recorder;
mod schedule;
mod sections;
mod summary;
mod swings;
mod table;
mod taken_energy;
mod told;
mod unlocated;
mod verdict;
mod warnings;

pub use bounces::{Bounces, CONTESTED, Contested};
pub use checkpoint::{
    CHECKPOINT, Checkpoint, CheckpointError, Found, Identity, Moment, VERSION as CHECKPOINT_VERSION, content_hash,
    program_hash,
};
pub use columns::{columns, unit as column_unit};
pub use deflections::LargestDeflection;
pub use export::{ExportWhen, Exporter, Former, HARD, Watch};
pub use feet_lines::FeetLine;
pub use made_energy::ENERGY_MADE;
#[cfg(feature = "animation")]
pub use page::{Animation, AnimationError, AnimationFormat, AnimationInfo, animate};
pub use page::{
    HalfCycle, Joint, PageRecorder, SIDE_BY_SIDE, STYLE, ThrustLine, VTK_SERIES, VtkRecorder, document, escaped,
    figures, for_any_width, half_cycles, record_figures, record_page, render, spectrum_periods, thrust_lines, unbroken,
};
pub use recorder::{ImpactRow, Record, Recorder};
pub use results::{FILES, Reserved, Results, ResultsError, write_whole};
pub use run_recorder::{Origin, RunRecorder};
pub use schedule::Schedule;
pub use sections::{BeamRecord, LargestStress, ReactionRange, envelopes};
pub use summary::{EndedWord, RecordSummary, Summary};
pub use taken_energy::ENERGY_TAKEN;
pub use teeter_scenario::readable::{shortest, with_digits, with_unit};
pub use unlocated::UNLOCATED;
pub use verdict::{BodyVerdict, Fate, Fates, SharedStances, Side, StopReason, Way};
pub use warnings::{HORIZON, Warning, WarningLog, YIELD};
