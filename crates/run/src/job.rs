//! What is to be run, where its results go, and how.

use crate::SceneSource;
use std::path::{Path, PathBuf};
use teeter_report::ExportWhen;
use teeter_scenario::Extent;

/// What becomes of the results that a folder holds already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Existing {
    /// The run is refused.
    #[default]
    Refuse,
    /// They are replaced, with the contact problems and the state that go beside them.
    Replace,
    /// The run goes on from the checkpoint that they hold; without one it starts at the beginning.
    Resume,
}

/// A run of a scene to a folder. [`prepare`](Self::prepare) finds all bad input before anything is
/// written; [`Prepared::run`](crate::Prepared::run) runs.
#[derive(Clone, Debug)]
#[must_use = "a job does nothing before it is prepared and run"]
pub struct RunJob {
    pub(crate) scene: SceneSource,
    pub(crate) sets: Vec<(String, String)>,
    folder: Option<PathBuf>,
    pub(crate) existing: Existing,
    pub(crate) checkpoint_every: Option<f64>,
    pub(crate) from: Option<PathBuf>,
    pub(crate) export: Option<(PathBuf, ExportWhen)>,
    pub(crate) dump: Option<PathBuf>,
    pub(crate) horizon: bool,
    extent: Extent,
    pub(crate) program: Option<[u8; 32]>,
}

impl RunJob {
    /// A run of the scene as it is written, to the folder `runs/STEM` of the working directory.
    pub fn new(scene: SceneSource) -> Self {
        Self {
            scene,
            sets: Vec::new(),
            folder: None,
            existing: Existing::default(),
            checkpoint_every: None,
            from: None,
            export: None,
            dump: None,
            horizon: false,
            extent: Extent::default(),
            program: None,
        }
    }

    /// Overrides the key `path` of the scene, such as `beam.table.thickness`, by `value`, such as
    /// `2 mm`. The default is what the scene says; of several overrides of a key the last one
    /// counts.
    pub fn set(mut self, path: impl Into<String>, value: impl Into<String>) -> Self {
        self.sets.push((path.into(), value.into()));
        self
    }

    /// The folder for the results, made if it is missing. The default is `runs/STEM`, with the
    /// scene's stem.
    pub fn folder(mut self, folder: impl Into<PathBuf>) -> Self {
        self.folder = Some(folder.into());
        self
    }

    /// What becomes of the results that the folder holds already. The default is
    /// [`Existing::Refuse`].
    pub fn existing(mut self, existing: Existing) -> Self {
        self.existing = existing;
        self
    }

    /// Writes a checkpoint at the first step at or past each multiple of `seconds` of simulated
    /// time, greater than 0, and at the step after which the run is cancelled. The default is to
    /// write none.
    pub fn checkpoint_every(mut self, seconds: f64) -> Self {
        self.checkpoint_every = Some(seconds);
        self
    }

    /// Starts from the state or checkpoint in the file `path`, of a run with the same bodies. Its
    /// clock goes on, up to the end of the scene; the model is the full one. The default is the
    /// start that the scene describes.
    pub fn from_state(mut self, path: impl Into<PathBuf>) -> Self {
        self.from = Some(path.into());
        self
    }

    /// Saves contact problems of the run to `folder`, as FCLIB files named by the scene's stem and
    /// the step: those that `when` says. The default is to save none.
    pub fn export_problems(mut self, folder: impl Into<PathBuf>, when: ExportWhen) -> Self {
        self.export = Some((folder.into(), when));
        self
    }

    /// Writes the state before the first step whose contact problem is not solved to the file
    /// `path`, for [`from_state`](Self::from_state). The default is to write none.
    pub fn dump_unconverged(mut self, path: impl Into<PathBuf>) -> Self {
        self.dump = Some(path.into());
        self
    }

    /// Finds until when the motion can be told, by three more runs after this one: with half the
    /// step, and from 1e-12 beside the start. It is `horizon` of the summary. Not for runs [from a
    /// state](Self::from_state), nor for those whose step was found for an accuracy, which have
    /// one.
    pub fn horizon(mut self) -> Self {
        self.horizon = true;
        self
    }

    /// How much of the scene is modelled. The default is [`Extent::Required`]: what nothing can
    /// touch or move is left out. What that is, is known of the scene's own start only: a run [from
    /// a state](Self::from_state) has the full model.
    pub fn extent(mut self, extent: Extent) -> Self {
        self.extent = extent;
        self
    }

    /// The SHA-256 by which checkpoints and states know the program that wrote them: a checkpoint
    /// is resumed by the same program only. The default is that of the file of the running program
    /// ([`teeter_report::program_hash`]), which is right where this library is linked into that
    /// file; a front end that is loaded by another program, such as an extension module, gives that
    /// of its own file.
    pub fn program(mut self, hash: [u8; 32]) -> Self {
        self.program = Some(hash);
        self
    }

    /// The folder for the results, as given or by default.
    #[must_use]
    pub fn results_folder(&self) -> PathBuf {
        self.folder.clone().unwrap_or_else(|| Path::new("runs").join(self.scene.stem()))
    }

    /// How much of the scene is modelled, with what the start has to say in it.
    pub(crate) fn modelled(&self) -> Extent {
        if self.from.is_some() { Extent::Full } else { self.extent }
    }

    /// Whether a file has to know of which run it is.
    pub(crate) fn is_identified(&self) -> bool {
        self.checkpoint_every.is_some() || self.existing == Existing::Resume || self.dump.is_some()
    }
}
