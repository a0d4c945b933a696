//! Why a scene can't be loaded, a run not be prepared, or not come to its end.

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
    /// The path leads to a folder.
    #[error("is a folder, not a scene file")]
    Folder,
    /// There is no file.
    #[error("no such file")]
    Missing,
    /// The system forbids it.
    #[error("no permission to read it")]
    Permission,
    /// Anything else.
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

/// Why there is no scene to run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// Its file can't be read.
    #[error("{name}: {error}")]
    Unreadable {
        /// The scene's name.
        name: String,
        /// Why.
        #[source]
        error: SceneFileError,
    },
    /// The scene is wrong.
    #[error("{found}")]
    Invalid {
        /// The text that the spans of the findings count in; empty for a file that is no text.
        text: String,
        /// All that is wrong.
        found: Diagnostics,
    },
}

impl LoadError {
    /// A scene that reads well, but has no model.
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
    /// There is no step for the accuracy that the scene asks for.
    #[error(transparent)]
    Step(#[from] NoStep),
    /// The time between checkpoints is no time, s.
    #[error("the time between checkpoints must be greater than 0 s, and is {0} s")]
    Interval(f64),
    /// The results can't go to that folder, or would replace a file that the run reads.
    #[error(transparent)]
    Folder(#[from] ResultsError),
    /// The state to start from can't be used.
    #[error(transparent)]
    State(CheckpointError),
    /// What the folder holds can't be resumed.
    #[error(transparent)]
    Resume(CheckpointError),
    /// The run to be resumed has ended: it is complete, or would end the same way again.
    #[error("the run in {} {}", folder.display(), ended_how(*.ended))]
    AlreadyEnded {
        /// The folder.
        folder: PathBuf,
        /// How it ended.
        ended: EndedWord,
    },
    /// The file of the running program, by which a checkpoint knows its program, can't be read.
    #[error("the program's own file can't be read: {0}")]
    Program(#[source] io::Error),
    /// The file for the state before the first unsolved step is a folder.
    #[error("{} is a folder, not a file for a state", .0.display())]
    DumpIsFolder(PathBuf),
    /// That file is there already.
    #[error("{} is there already", .0.display())]
    DumpExists(PathBuf),
    /// There is no folder for that file.
    #[error("there is no folder {}", .0.display())]
    NoDumpFolder(PathBuf),
}

fn ended_how(ended: EndedWord) -> String {
    match ended {
        EndedWord::Complete => "is complete: there is nothing to resume".to_owned(),
        ended => format!("{ended}: it would end the same way again"),
    }
}

/// Why a run has no results, or not all of them. How its motion ended is no error, but
/// [`Done::ended`](crate::Done::ended).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// A folder can't be taken for results or contact problems, such as one that another run is
    /// writing to. Nothing was simulated.
    #[error(transparent)]
    Folder(ResultsError),
    /// A file can't be written, for another reason than a full disk.
    #[error(transparent)]
    Write(ResultsError),
    /// What a run remembers can't be stored.
    #[error(transparent)]
    Observer(ObserverError),
    /// The steps could not go on for a reason outside the mechanics.
    #[error(transparent)]
    Steps(teeter_integrator::RunError),
    /// The summary can't be written as JSON: a number in it is not finite.
    #[error(transparent)]
    Summary(serde_json::Error),
}
