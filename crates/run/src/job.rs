//! A run: its scene, the folder of its results, and its options.

use crate::SceneSource;
use std::path::{Path, PathBuf};
use teeter_report::ExportWhen;
use teeter_scenario::Extent;

/// What to do with existing results in the folder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExistingResults {
    /// The run is refused.
    #[default]
    Refuse,
    /// They are replaced, including saved contact problems, the dumped state and the animation.
    Replace,
    /// The run continues from their checkpoint; without one it starts at the beginning.
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
    pub(crate) existing: ExistingResults,
    pub(crate) checkpoint_every: Option<f64>,
    pub(crate) from: Option<PathBuf>,
    pub(crate) export: Option<(PathBuf, ExportWhen)>,
    pub(crate) dump: Option<PathBuf>,
    pub(crate) horizon: bool,
    pub(crate) report: bool,
    pub(crate) vtk: bool,
    #[cfg(feature = "animation")]
    pub(crate) animation: Option<(PathBuf, teeter_report::Animation)>,
    #[cfg(feature = "parallel")]
    pub(crate) threads: usize,
    extent: Extent,
    pub(crate) program: Option<[u8; 32]>,
}

impl RunJob {
    /// A run of the scene as written, to the folder `runs/STEM` of the working directory.
    pub fn new(scene: SceneSource) -> Self {
        Self {
            scene,
            sets: Vec::new(),
            folder: None,
            existing: ExistingResults::default(),
            checkpoint_every: None,
            from: None,
            export: None,
            dump: None,
            horizon: false,
            report: true,
            vtk: false,
            #[cfg(feature = "animation")]
            animation: None,
            #[cfg(feature = "parallel")]
            threads: 1,
            extent: Extent::default(),
            program: None,
        }
    }

    /// Also writes pictures of the run as VTK files, to the subfolder `vtk`; `scene.pvd` there lists
    /// them.
    pub fn with_vtk(mut self) -> Self {
        self.vtk = true;
        self
    }

    /// Also writes the motion as an animation to the file `path`. The default is to write none.
    #[cfg(feature = "animation")]
    pub fn animate(mut self, path: impl Into<PathBuf>, animation: teeter_report::Animation) -> Self {
        self.animation = Some((path.into(), animation));
        self
    }

    /// Overrides the key `path` of the scene, such as `beam.table.thickness`, by `value`, such as
    /// `2 mm`. The default is the value in the scene; of several overrides of a key the last one
    /// counts.
    pub fn set(mut self, path: impl Into<String>, value: impl Into<String>) -> Self {
        self.sets.push((path.into(), value.into()));
        self
    }

    /// The folder for the results, created if it is missing. The default is `runs/STEM`, with the
    /// scene's stem.
    pub fn folder(mut self, folder: impl Into<PathBuf>) -> Self {
        self.folder = Some(folder.into());
        self
    }

    /// What to do with existing results in the folder. The default is
    /// [`ExistingResults::Refuse`].
    pub fn existing(mut self, existing: ExistingResults) -> Self {
        self.existing = existing;
        self
    }

    /// Writes a checkpoint at the first step at or past each multiple of `seconds` of simulated
    /// time, greater than 0, and when the run is cancelled. The default is to write none.
    pub fn checkpoint_every(mut self, seconds: f64) -> Self {
        self.checkpoint_every = Some(seconds);
        self
    }

    /// Starts from the state or checkpoint in the file `path`, of a run with the same bodies. Its
    /// clock continues, up to the end of the scene; the model is the full one. The default is the
    /// initial state of the scene.
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

    /// Finds the horizon, up to which the motion is predictable, by three more runs, among them one
    /// with half the step and one with the initial state perturbed by 1e-12. It is `horizon` of the
    /// summary. Not for runs [from a state](Self::from_state), nor for those whose step was found
    /// for an accuracy, which already have one.
    pub fn horizon(mut self) -> Self {
        self.horizon = true;
        self
    }

    /// Writes the tables and the summary only. The default is to also write `report.html` and its
    /// figures.
    pub fn without_report(mut self) -> Self {
        self.report = false;
        self
    }

    /// On how many threads contacts of bodies that stand apart are solved, at least one, which is the default. The results are
    /// the same to the last byte. Runs that [export contact problems](Self::export_problems) use one.
    #[cfg(feature = "parallel")]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// How much of the scene is modelled. The default is [`Extent::Required`]: what nothing can
    /// touch or move is left out. This is only known for the scene's own initial state: a run [from
    /// a state](Self::from_state) has the full model.
    pub fn extent(mut self, extent: Extent) -> Self {
        self.extent = extent;
        self
    }

    /// The SHA-256 that identifies the program in checkpoints and states: a checkpoint is resumed
    /// only by the same program. The default is the hash of the running program's file
    /// ([`teeter_report::program_hash`]), which is right if this library is linked into that file;
    /// a front end loaded by another program, such as an extension module, must give the hash of
    /// its own file.
    pub fn program(mut self, hash: [u8; 32]) -> Self {
        self.program = Some(hash);
        self
    }

    /// The folder for the results, as given or by default.
    #[must_use]
    pub fn results_folder(&self) -> PathBuf {
        self.folder.clone().unwrap_or_else(|| Path::new("runs").join(self.scene.stem()))
    }

    /// The file for the animation, if there is to be one.
    pub(crate) fn animation_file(&self) -> Option<&Path> {
        #[cfg(feature = "animation")]
        return self.animation.as_ref().map(|(path, _)| path.as_path());
        #[cfg(not(feature = "animation"))]
        None
    }

    /// How much of the scene is modelled, considering the start.
    pub(crate) fn modelled(&self) -> Extent {
        if self.from.is_some() { Extent::Full } else { self.extent }
    }

    /// Whether a file must identify its run.
    pub(crate) fn is_identified(&self) -> bool {
        self.checkpoint_every.is_some() || self.existing == ExistingResults::Resume || self.dump.is_some()
    }
}
