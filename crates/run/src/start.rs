//! Where a run starts: at its beginning, or from its own checkpoint.

use crate::{ExistingResults, PrepareError, RunJob};
use std::path::Path;
use teeter_report::{
    CHECKPOINT, Checkpoint, CheckpointError, ExportWhen, Former, Found, Identity, Results, ResultsError, program_hash,
};
use teeter_scenario::Extent;
use teeter_scenario::resolve::Resolved;

/// Where a run starts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RunStart {
    /// At the beginning: of the scene, or at the given state.
    Beginning,
    /// At the beginning, as there is no run in the folder to resume.
    NothingToResume,
    /// At the beginning, as the run in the folder was ended before its first checkpoint; its files
    /// are replaced.
    NoCheckpoint,
    /// At the checkpoint in the folder.
    Checkpoint {
        /// Its time, s.
        t: f64,
    },
}

impl RunStart {
    /// Finds where the job starts, without changes except that a checkpoint beside the summary of a
    /// finished run is removed, as that run was killed just before doing so.
    pub(crate) fn find(
        job: &RunJob,
        folder: &Path,
        identity: Option<&Identity>,
        scene_as_run: &str,
    ) -> Result<(Self, Option<Checkpoint>), PrepareError> {
        let Some(identity) = identity.filter(|_| job.existing == ExistingResults::Resume) else {
            return Ok((Self::Beginning, None));
        };
        match Found::look(folder, identity, scene_as_run).map_err(PrepareError::Resume)? {
            Found::Nothing => Ok((Self::NothingToResume, None)),
            Found::Unfinished => Ok((Self::NoCheckpoint, None)),
            Found::Checkpoint(checkpoint) => Ok((Self::Checkpoint { t: checkpoint.state().t }, Some(*checkpoint))),
            Found::Ended(ended) => {
                let _ = std::fs::remove_file(folder.join(CHECKPOINT));
                Err(PrepareError::AlreadyEnded { folder: folder.to_owned(), ended })
            }
        }
    }

    /// What to do with the files of an earlier run.
    pub(crate) fn former(self, existing: ExistingResults) -> Former {
        match self {
            Self::Checkpoint { .. } => Former::Keep,
            Self::NoCheckpoint => Former::Remove,
            Self::NothingToResume => Former::Refuse,
            Self::Beginning if existing == ExistingResults::Replace => Former::Remove,
            Self::Beginning => Former::Refuse,
        }
    }
}

/// Locks the folder for results.
pub(crate) fn take(folder: &Path, former: Former) -> Result<Results, ResultsError> {
    match former {
        Former::Keep => Results::reopen(folder),
        Former::Remove => Results::create(folder, true),
        Former::Refuse => Results::create(folder, false),
    }
}

/// Program, scene with the contents of its files, and options of the run; `None` if no file needs
/// them.
pub(crate) fn identity(job: &RunJob, resolved: &Resolved) -> Result<Option<Identity>, PrepareError> {
    if !job.is_identified() {
        return Ok(None);
    }
    let program = job.program.map_or_else(program_hash, Ok).map_err(PrepareError::Program)?;
    // The options that distinguish runs, as a run must not be resumed with other options.
    let mut deciding = Vec::new();
    if let Some((_, when)) = &job.export {
        let when = match when {
            ExportWhen::Hard => "hard".to_owned(),
            ExportWhen::Every(n) => format!("every:{n}"),
        };
        deciding.push(format!("--export-problems of {}, --export-when {when}", job.scene.stem()));
    }
    if job.modelled() == Extent::Full {
        deciding.push("--model full".to_owned());
    }
    let mut files: Vec<&[u8]> = resolved.files.iter().map(|(_, bytes)| bytes.as_slice()).collect();
    let from = match &job.from {
        None => Vec::new(),
        Some(path) => {
            deciding.push("--from".to_owned());
            let failed = |source| PrepareError::State(CheckpointError::Read { path: path.clone(), source });
            std::fs::read(path).map_err(failed)?
        }
    };
    files.push(&from);
    let scene = resolved.document.to_toml();
    Ok(Some(Identity::new(program, &scene, &files, &deciding.join(", "))))
}
