//! Preparation of a run, before anything is written.

use crate::start::{self, RunStart};
use crate::{ExistingResults, LoadError, PrepareError, RunJob};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use teeter_integrator::State;
use teeter_report::{Checkpoint, FILES, Former, Identity, Moment, Results, Watch};
use teeter_scenario::diagnostic::Diagnostic;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Simulation;
use teeter_study::ChosenStep;

/// A job with its scene read, its model built and its start found. Nothing has been written, and
/// dropping it leaves no trace. Its folder is locked only by [`run`](Self::run): until then nothing
/// else should write there.
#[derive(Debug)]
pub struct Prepared {
    pub(crate) job: RunJob,
    pub(crate) folder: PathBuf,
    pub(crate) resolved: Resolved,
    pub(crate) simulation: Simulation,
    /// Records the contact problems, if they are to be saved.
    pub(crate) watch: Option<Watch>,
    pub(crate) identity: Option<Identity>,
    pub(crate) start: RunStart,
    pub(crate) checkpoint: Option<Checkpoint>,
    pub(crate) chosen: Option<ChosenStep>,
}

impl RunJob {
    /// Reads the scene and the files that it names, builds the model, finds where to start, and
    /// checks that the folder can be used. Writes nothing, except that
    /// [`PrepareError::AlreadyEnded`] may clean up after a run that was killed at its very end.
    ///
    /// # Errors
    /// Any error in the job and its scene. What is only found when the folders are locked, such as
    /// another run that is writing there, is a [`RunError::Folder`](crate::RunError::Folder).
    pub fn prepare(self) -> Result<Prepared, PrepareError> {
        if let Some(every) = self.checkpoint_every.filter(|every| !(*every > 0.0 && every.is_finite())) {
            return Err(PrepareError::Interval(every));
        }
        let (resolved, chosen) = with_step(self.scene.load(&self.sets)?)?;
        let watch = self.export.is_some().then(Watch::default);
        let mut simulation = Simulation::with_extent(&resolved.scene, self.modelled(), |solver| match &watch {
            Some(watch) => watch.around(solver),
            None => solver,
        })
        .map_err(|error| LoadError::of_build(&error, &resolved))?;
        // Problems are exported in the order in which they are solved.
        #[cfg(feature = "parallel")]
        if watch.is_none() {
            simulation.set_threads(self.threads);
        }
        let folder = self.results_folder();
        self.check_inputs_kept(&folder, &resolved)?;
        // Before its whole content is hashed, as it may be a device.
        if let Some(path) = &self.from {
            simulation.state = state_from(path, &resolved.scene, &simulation)?;
        }
        let identity = start::identity(&self, &resolved)?;
        self.check_files(&folder)?;
        let scene = self.scene_as_run(&folder, &resolved);
        let (start, checkpoint) = RunStart::find(&self, &folder, identity.as_ref(), &scene)?;
        let former = start.former(self.existing);
        if former != Former::Keep {
            Results::replaced(&FILES, &folder, former == Former::Remove)?;
        }
        if let Some(checkpoint) = &checkpoint {
            simulation.state = checkpoint.state().clone();
        }
        Ok(Prepared { job: self, folder, resolved, simulation, watch, identity, start, checkpoint, chosen })
    }

    /// The scene with every override and default, with the paths of files relative to the folder,
    /// if that exists.
    pub(crate) fn scene_as_run(&self, folder: &Path, resolved: &Resolved) -> String {
        resolved.document.to_toml_elsewhere(|file| self.scene.seen_from(folder, file))
    }

    /// Refuses to replace files that the run reads: the scene, files that it names, a state to
    /// start from.
    fn check_inputs_kept(&self, folder: &Path, resolved: &Resolved) -> Result<(), PrepareError> {
        let mut inputs = self.scene.inputs(resolved);
        inputs.extend(self.from.clone());
        Results::spares(&FILES, folder, &inputs)?;
        for path in [self.dump.as_deref(), self.animation_file()].into_iter().flatten().filter_map(Path::to_str) {
            Results::spares(&[path], Path::new(""), &inputs)?;
        }
        Ok(())
    }

    /// Refuses files for the state and the animation that exist, or whose folder doesn't: an animation may stand in that of
    /// the results.
    fn check_files(&self, results: &Path) -> Result<(), PrepareError> {
        for (path, what) in [(self.dump.as_deref(), "state"), (self.animation_file(), "animation")] {
            let Some(path) = path else { continue };
            if path.is_dir() {
                return Err(PrepareError::FileIsFolder { path: path.to_owned(), what });
            }
            let replaces = match self.existing {
                ExistingResults::Refuse => false,
                ExistingResults::Replace | ExistingResults::Resume => true,
            };
            if path.exists() && !replaces {
                return Err(PrepareError::FileExists(path.to_owned()));
            }
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            let is_made = what == "animation" && folder == results;
            if !(folder.is_dir() || is_made) {
                return Err(PrepareError::NoFolder(folder.to_owned()));
            }
        }
        Ok(())
    }
}

/// A scene with an accuracy, with the step that reaches it.
fn with_step(resolved: Resolved) -> Result<(Resolved, Option<ChosenStep>), PrepareError> {
    let Some(accuracy) = resolved.scene.time.accuracy else { return Ok((resolved, None)) };
    let chosen = teeter_study::step_for(&resolved.scene, accuracy, &Arc::default())?;
    let text = resolved.document.source().to_owned();
    match resolved.with_step(chosen.step) {
        Ok(resolved) => Ok((resolved, Some(chosen))),
        Err(found) => Err(LoadError::Invalid { text, found }.into()),
    }
}

fn state_from(path: &Path, scene: &Scene, simulation: &Simulation) -> Result<State, PrepareError> {
    let moment = Moment::read(path).map_err(PrepareError::State)?;
    let state = moment.start(path, scene, &simulation.layout, &simulation.model, simulation.scheme());
    state.map_err(PrepareError::State)
}

impl Prepared {
    /// The folder for the results.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The scene, with its document and findings.
    #[must_use]
    pub fn resolved(&self) -> &Resolved {
        &self.resolved
    }

    /// Warnings about the scene; the spans refer to the source of
    /// [`resolved`](Self::resolved)'s document.
    #[must_use]
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.resolved.warnings
    }

    /// The model, with the state from which the run starts.
    #[must_use]
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The step found for the accuracy of the scene; `None` if it gives a step.
    #[must_use]
    pub fn chosen_step(&self) -> Option<&ChosenStep> {
        self.chosen.as_ref()
    }

    /// Where the run starts.
    #[must_use]
    pub fn start(&self) -> RunStart {
        self.start
    }

    /// The number of the step at which the run starts, counted from t = 0.
    #[must_use]
    pub fn first_step(&self) -> u64 {
        self.simulation.state.step
    }

    /// The number of the last step of the run.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.resolved.scene.time.steps()
    }
}
