//! Parameter studies: a scene, axes along which its keys vary, and the numbers wanted of each case.
//!
//! [`Sweep::read`] reads a sweep file; [`Sweep::case`] gives the settings of a case by its number,
//! so that a study of any size needs no list of its cases. [`run_cases`] runs those that are still
//! to do on all cores and hands on each [`CaseRow`] as it ends. [`Journal`] keeps the rows on disk
//! as they come, in any order, and survives a kill; [`write_results`] sorts them into
//! `results.csv`, and [`write_parquet`] repeats that as `results.parquet`. [`merge`] puts the journals of several shards together, to the same bytes as one
//! run of all cases.

mod axes;
mod case;
mod check;
mod criterion;
mod figures;
mod file;
mod find;
mod identity;
mod journal;
mod listing;
pub(crate) mod number;
mod output;
#[cfg(feature = "parquet")]
mod parquet;
mod rows;
pub(crate) mod sample;
mod shard;
pub(crate) mod spec;
mod tally;

pub use case::{COARSE_ROWS, CaseRow, CaseStatus, run_cases};
pub use figures::{
    Ensemble, FIGURE_FILES, StudyFigure, StudyTable, TableError, incomparable, study_figures, study_page,
};
pub use file::{FilesOf, Sweep};
pub use identity::{IDENTITY, SweepIdentity, SweepIdentityError};
pub use journal::{
    FILES, JOURNAL, Journal, JournalError, Merged, PARQUET, RESULTS, ended_study, merge, write_parquet, write_results,
};
pub use listing::matching_files;
pub use output::Output;
#[cfg(feature = "parquet")]
pub use parquet::{ParquetTableError, parquet_table};
pub(crate) use sample::mixed;
pub use shard::{Shard, ShardError};
pub use tally::{Tally, counted};
