//! Runs a prepared job and writes its results.

use crate::hooks::ProgressObserver;
use crate::{Hooks, Prepared, RunError, start};
use std::path::PathBuf;
use std::sync::Arc;
use teeter_integrator::{Ended, State};
use teeter_report::{
    CHECKPOINT, EndedWord, Exporter, Former, Origin, PageRecorder, Record, Results, ResultsError, RunRecorder, Summary,
    VtkRecorder, columns, envelopes, figures, render,
};
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// A run that has ended, with its results.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FinishedRun {
    /// The contents of `summary.json`.
    pub summary: Summary,
    /// The folder of the results.
    pub folder: PathBuf,
    /// The saved contact problems; `None` if they were not requested.
    pub exported: Option<Exported>,
    /// The file for the state before the first unsolved step; `None` if it was not requested.
    pub dump: Option<StateDump>,
    /// The animation; `None` if it was not requested, or there was no room for it.
    #[cfg(feature = "animation")]
    pub animation: Option<teeter_report::AnimationInfo>,
}

/// Contact problems saved by a run.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Exported {
    /// Their folder.
    pub folder: PathBuf,
    /// Their number.
    pub count: u64,
}

/// The file for the state before the first unsolved step.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum StateDump {
    /// Some steps were not solved: the state before the first of them is in this file. In a resumed
    /// run with unsolved steps before the checkpoint, the file is as the earlier part of the run
    /// left it.
    Written(PathBuf),
    /// Every step was solved: this file was not written.
    NotNeeded(PathBuf),
}

impl FinishedRun {
    /// How the run ended.
    #[must_use]
    pub fn ended(&self) -> EndedWord {
        self.summary.ended
    }
}

/// The data that a run leaves in memory.
struct RecordedRun {
    record: Record,
    page: PageRecorder,
    exporter: Option<Exporter>,
    ended: EndedWord,
    /// Time of its steps, s.
    seconds: f64,
}

impl Prepared {
    /// Locks the folders, runs to the end of the scene, and writes the results. The summary is
    /// written last: a folder without one contains an unfinished run. A run that is cancelled,
    /// diverges, or finds the disk full also ends, with everything that it could write.
    ///
    /// # Errors
    /// If a folder can't be locked, or a file can't be written for a reason other than a full disk.
    pub fn run(mut self, hooks: Hooks<'_>) -> Result<FinishedRun, RunError> {
        let former = self.start.former(self.job.existing);
        let exporter = self.exporter(former).map_err(RunError::Folder)?;
        let results = start::take(&self.folder, former).map_err(RunError::Folder)?;
        // From here on the folder exists: paths in the scene are relative to it.
        let scene_as_run = self.job.scene_as_run(&self.folder, &self.resolved);
        let layout = self.simulation.layout.clone();
        let cancel = hooks.cancel.clone().unwrap_or_default();
        let mut recorded = self.simulate(&results, &scene_as_run, exporter, &layout, hooks)?;
        recorded.record.horizon = self.chosen.map(|chosen| chosen.horizon);
        let wanted = self.job.horizon && self.chosen.is_none() && self.job.from.is_none();
        let mut watched = self.resolved.scene.clone();
        if recorded.ended == EndedWord::Stopped {
            // Of what was run only.
            watched.time.end = self.simulation.state.t;
        }
        if wanted
            && matches!(recorded.ended, EndedWord::Complete | EndedWord::Stopped)
            && !crate::horizon::find(&watched, &cancel, &mut recorded.record)
        {
            // The horizon is missing: a resumed run repeats the end, and finds it.
            recorded.ended = EndedWord::Interrupted;
        }
        let exporter = recorded.exporter.as_ref().map(Exporter::written);
        let (scene, state) = (&self.resolved.scene, &self.simulation.state);
        let summary = write(&results, &recorded, scene, &layout, state, &scene_as_run, self.job.report)?;
        #[cfg(feature = "animation")]
        let animation = self.animate(&recorded)?;
        let unsolved = summary.contact.unconverged_steps > 0;
        Ok(FinishedRun {
            exported: exporter.zip(self.job.export).map(|(count, (folder, _))| Exported { folder, count }),
            dump: self
                .job
                .dump
                .map(|path| if unsolved { StateDump::Written(path) } else { StateDump::NotNeeded(path) }),
            folder: self.folder,
            summary,
            #[cfg(feature = "animation")]
            animation,
        })
    }

    /// Writes the animation, if there is to be one.
    #[cfg(feature = "animation")]
    fn animate(&self, recorded: &RecordedRun) -> Result<Option<teeter_report::AnimationInfo>, RunError> {
        let Some((path, animation)) = &self.job.animation else { return Ok(None) };
        let (file, info) = teeter_report::animate(&recorded.page, animation).map_err(RunError::Animation)?;
        match teeter_report::write_whole(path, &file) {
            Ok(()) => Ok(Some(info)),
            Err(error) if recorded.ended == EndedWord::DiskFull && error.is_disk_full() => Ok(None),
            Err(error) => Err(RunError::Write(error)),
        }
    }

    /// Locks the folder for contact problems, if they are to be saved.
    fn exporter(&self, former: Former) -> Result<Option<Exporter>, ResultsError> {
        let (Some((folder, when)), Some(watch)) = (&self.job.export, &self.watch) else { return Ok(None) };
        let (scene, stem) = (&self.resolved.scene, self.job.scene.stem());
        let (steps, tolerance) = (scene.time.steps(), scene.solver.tolerance);
        Exporter::create(watch, folder, stem, &scene.title, steps, *when, tolerance, former).map(Some)
    }

    /// Runs, writing the tables meanwhile.
    fn simulate(
        &mut self,
        results: &Results,
        scene_as_run: &str,
        exporter: Option<Exporter>,
        layout: &Layout,
        hooks: Hooks<'_>,
    ) -> Result<RecordedRun, RunError> {
        let Hooks { start, progress, warning, cancel } = hooks;
        if let Some(start) = start {
            start();
        }
        let mut warning = warning.unwrap_or_else(|| Box::new(|_| ()));
        let mut teller = ProgressObserver::new(progress, self.steps());
        // Before the tables, as it identifies them.
        results.write("scene.toml", scene_as_run).map_err(RunError::Write)?;
        let scene = &self.resolved.scene;
        let mut recorder = RunRecorder::new(results, scene, layout, exporter, self.checkpoint.take(), warning.as_mut())
            .map_err(RunError::Write)?;
        recorder.note(&self.resolved.warnings);
        if let Some(identity) = &self.identity {
            let origin = Origin { identity, scheme: self.simulation.scheme() };
            if let Some(every) = self.job.checkpoint_every {
                recorder = recorder.with_checkpoints(results, origin, every);
            }
            if let Some(path) = &self.job.dump {
                recorder = recorder.with_dump(path, origin);
            }
        }
        if let Some(cancel) = cancel {
            recorder = recorder.until(Arc::clone(&cancel));
            self.simulation.cancelled_by(cancel);
        }
        let mut vtk = self.job.vtk.then(|| VtkRecorder::new(results, scene, layout, scene.every));
        let ran = match &mut vtk {
            None => self.simulation.run(&mut [&mut recorder, &mut teller]),
            Some(vtk) => self.simulation.run(&mut [&mut recorder, &mut teller, vtk]),
        };
        teller.tell(&self.simulation.state);
        let seconds = recorder.seconds();
        let (mut record, page, exporter) = recorder.into_parts();
        // The list of the pictures that there are, however the run ended.
        let listed = vtk.map_or(Ok(()), |vtk| vtk.finish());
        let ended = match ran {
            Ok(ended) => {
                if let Ended::Failed(error) = &ended {
                    record.warnings.enter("ended", error.t(), || error.to_string());
                }
                record.ended(&ended)
            }
            Err(teeter_integrator::RunError::Observer(error)) => match error.downcast::<ResultsError>() {
                Ok(error) if error.is_disk_full() => {
                    record.warnings.enter("ended", Some(self.simulation.state.t), || error.to_string());
                    EndedWord::DiskFull
                }
                Ok(error) => return Err(RunError::Write(*error)),
                Err(error) => return Err(RunError::Observer(error)),
            },
            Err(error) => return Err(RunError::Steps(error)),
        };
        match listed {
            Err(error) if ended == EndedWord::DiskFull && error.is_disk_full() => {}
            listed => listed.map_err(RunError::Write)?,
        }
        Ok(RecordedRun { record, page, exporter, ended, seconds })
    }
}

/// Writes the files at the end of a run, the summary last.
fn write(
    results: &Results,
    recorded: &RecordedRun,
    scene: &Scene,
    layout: &Layout,
    state: &State,
    scene_as_run: &str,
    report: bool,
) -> Result<Summary, RunError> {
    let RecordedRun { record, page, ended, seconds, .. } = recorded;
    let (ended, seconds) = (*ended, *seconds);
    let summary = Summary::new(scene, layout, state, record, ended, seconds);
    let written = write_files(results, record, scene, layout, page, &summary, report.then_some(scene_as_run));
    match written {
        // There is no room for these either; the summary still has the reason.
        Err(RunError::Write(error)) if ended == EndedWord::DiskFull && error.is_disk_full() => {}
        written => written?,
    }
    if !matches!(ended, EndedWord::Interrupted | EndedWord::DiskFull) {
        results.remove(CHECKPOINT).map_err(RunError::Write)?;
    }
    Ok(summary)
}

fn write_files(
    results: &Results,
    record: &Record,
    scene: &Scene,
    layout: &Layout,
    page: &PageRecorder,
    summary: &Summary,
    scene_of_report: Option<&str>,
) -> Result<(), RunError> {
    let file = |name: &str, text: &str| results.write(name, text).map_err(RunError::Write);
    if let Some(text) = envelopes(layout, &record.beams) {
        file("envelopes.csv", &text)?;
    }
    file("columns.json", &columns(scene, layout).map_err(RunError::Summary)?)?;
    if let Some(scene_as_run) = scene_of_report {
        file("report.html", &render(page, summary, scene_as_run))?;
        for (name, svg) in figures(page) {
            file(&format!("figures/{name}"), &svg)?;
        }
    }
    file("summary.json", &summary.to_json().map_err(RunError::Summary)?)
}
