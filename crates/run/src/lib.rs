//! Runs a scene of teeter to a folder: tables, summary, page and figures, with checkpoints from
//! which a run continues to the same bytes, and hooks with which a front end shows its progress or
//! cancels it.
//!
//! A [`RunJob`] describes the run. [`RunJob::prepare`] finds all bad input before anything is
//! written; [`Prepared::run`] runs it and returns the results. Nothing here prints, listens to
//! signals or decides by a clock.
//!
//! ```
//! use teeter_run::{EndedWord, Hooks, RunJob, SceneSource};
//!
//! let scene = r#"
//!     time = { end = "0.1 s", step = "1 ms" }
//!     ground = {}
//!     material.wood = { density = "600 kg/m^3" }
//!     block.cube = { material = "wood", width = "10 cm", height = "10 cm", depth = "10 cm", position = ["0 m", "6 cm"] }
//!     contact.floor = { between = ["cube", "ground"], friction = 0.4 }
//! "#;
//! let folder = std::env::temp_dir().join(format!("teeter-cube-{}", std::process::id()));
//! let job = RunJob::new(SceneSource::bytes(scene, "cube.toml", "cube")).set("time.end", "0.2 s").folder(&folder);
//! let done = job.prepare()?.run(Hooks::new().on_progress(|progress| assert!(progress.step <= progress.of)))?;
//! assert_eq!((done.ended(), done.summary.steps), (EndedWord::Complete, 200));
//! assert!(folder.join("trajectory.csv").exists() && folder.join("report.html").exists());
//! # std::fs::remove_dir_all(folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A cancelled run can be continued later, to the same files byte for byte (except for the times
//! that the steps took):
//!
//! ```
//! use std::sync::Arc;
//! use std::sync::atomic::{AtomicBool, Ordering};
//! use teeter_run::{EndedWord, ExistingResults, Hooks, RunJob, SceneSource, RunStart};
//!
//! # let scene = r#"
//! #     time = { end = "1 s", step = "1 ms" }
//! #     ground = {}
//! #     material.wood = { density = "600 kg/m^3" }
//! #     block.cube = { material = "wood", width = "10 cm", height = "10 cm", depth = "10 cm", position = ["0 m", "6 cm"] }
//! #     contact.floor = { between = ["cube", "ground"], friction = 0.4 }
//! # "#;
//! # let folder = std::env::temp_dir().join(format!("teeter-cancel-{}", std::process::id()));
//! let job = RunJob::new(SceneSource::bytes(scene, "cube.toml", "cube"))
//!     .folder(&folder)
//!     .checkpoint_every(0.1)
//!     .existing(ExistingResults::Resume);
//! let cancel = Arc::new(AtomicBool::new(false));
//! let hooks = Hooks::new().cancelled_by(&cancel).on_progress(|progress| cancel.store(progress.step > 0, Ordering::Relaxed));
//! assert_eq!(job.clone().prepare()?.run(hooks)?.ended(), EndedWord::Interrupted);
//!
//! let prepared = job.prepare()?;
//! assert!(matches!(prepared.start(), RunStart::Checkpoint { t } if t > 0.0));
//! assert_eq!(prepared.run(Hooks::new())?.ended(), EndedWord::Complete);
//! # std::fs::remove_dir_all(folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod hooks;
mod horizon;
mod job;
mod prepare;
mod run;
mod source;
mod start;

pub use error::{LoadError, PrepareError, RunError, SceneFileError};
pub use hooks::{Hooks, PROGRESS_STEPS, Progress};
pub use job::{ExistingResults, RunJob};
pub use prepare::Prepared;
pub use run::{Exported, FinishedRun, StateDump};
pub use source::{SceneSource, read_regular};
pub use start::RunStart;
pub use teeter_report::{EndedWord, ExportWhen, Summary};
pub use teeter_scenario::Extent;
