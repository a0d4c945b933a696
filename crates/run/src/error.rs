//! Errors of loading a scene, preparing a run, and running it.

use std::io;
use std::path::PathBuf;
use teeter_integrator::ObserverError;
use teeter_report::{CheckpointError, EndedWord, ResultsError};
use teeter_scenario::diagnostic::Diagnostics;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::BuildError;
use teeter_study::NoStep;

/// Why a scene file can't be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneFileError {
    /// The path is a folder.
    #[error("is a folder, not a scene file")]
    Folder,
    /// There is no file.
    #[error("no such file")]
    Missing,
    /// There is no permission.
    #[error("no permission to read it")]
    Permission,
    /// Another error.
    #[error("can't be read: {0}")]
    Io(#[source] io::Error),
}

impl From<io::Error> for SceneFileError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => Self::Missing,
            io::ErrorKind::PermissionDenied => Self::Permission,
            _ => Self::Io(error),
        }
    }
}

/// Why a scene can't be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// Its file can't be read.
    #[error("{name}: {error}")]
    Unreadable {
        /// The scene's name.
        name: String,
        /// The error.
        #[source]
        error: SceneFileError,
    },
    /// The scene has errors.
    #[error("{found}")]
    Invalid {
        /// The text to which the spans of the findings refer; empty for a file that is not text.
        text: String,
        /// All errors.
        found: Diagnostics,
    },
}

impl LoadError {
    /// A valid scene whose model can't be built.
    pub(crate) fn of_build(error: &BuildError, resolved: &Resolved) -> Self {
        let document = &resolved.document;
        Self::Invalid { text: document.source().to_owned(), found: error.diagnostic(document).into() }
    }
}

/// Why a run can't be prepared. Nothing was written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PrepareError {
    /// There is no scene to run.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// No step reaches the accuracy of the scene.
    #[error(transparent)]
    Step(#[from] NoStep),
    /// The time between checkpoints is invalid, s.
    #[error("the time between checkpoints must be greater than 0 s, got {0} s")]
    Interval(f64),
    /// The folder can't be used for the results, or a file that the run reads would be replaced.
    #[error(transparent)]
    Folder(#[from] ResultsError),
    /// The state to start from can't be used.
    #[error(transparent)]
    State(CheckpointError),
    /// The run in the folder can't be resumed.
    #[error(transparent)]
    Resume(CheckpointError),
    /// The run to be resumed has ended: it is complete, or would end in the same way again.
    #[error("the run in {} {}", folder.display(), ended_how(*.ended))]
    AlreadyEnded {
        /// The folder.
        folder: PathBuf,
        /// How it ended.
        ended: EndedWord,
    },
    /// The file of the running program, whose hash identifies it in checkpoints, can't be read.
    #[error("the program's own file can't be read: {0}")]
    Program(#[source] io::Error),
    /// The file for a state or an animation is a folder.
    #[error("{} is a folder, not a file for {} {what}", path.display(), if *what == "animation" { "an" } else { "a" })]
    FileIsFolder {
        /// The path.
        path: PathBuf,
        /// What the file is for: `state` or `animation`.
        what: &'static str,
    },
    /// The file for a state or an animation already exists.
    #[error("{} already exists", .0.display())]
    FileExists(PathBuf),
    /// The folder of that file doesn't exist.
    #[error("there is no folder {}", .0.display())]
    NoFolder(PathBuf),
}

fn ended_how(ended: EndedWord) -> String {
    match ended {
        EndedWord::Complete => "is complete: there is nothing to resume".to_owned(),
        ended => format!("{ended}: it would end in the same way again"),
    }
}

/// Why a run has no results, or not all of them. How its motion ended is not an error, but
/// [`FinishedRun::ended`](crate::FinishedRun::ended).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// A folder can't be used for results or contact problems, for example because another run is
    /// writing to it. Nothing was simulated.
    #[error(transparent)]
    Folder(ResultsError),
    /// A file can't be written, for a reason other than a full disk.
    #[error(transparent)]
    Write(ResultsError),
    /// The state of a run can't be stored.
    #[error(transparent)]
    Observer(ObserverError),
    /// The steps could not continue, for a reason outside the mechanics.
    #[error(transparent)]
    Steps(teeter_integrator::RunError),
    /// The summary can't be written as JSON: a number in it is not finite.
    #[error(transparent)]
    Summary(serde_json::Error),
    /// There is no animation; all other results are written.
    #[cfg(feature = "animation")]
    #[error(transparent)]
    Animation(teeter_report::AnimationError),
}
