//! `teeter run`.

use crate::companions;
use crate::console::Console;
use crate::interrupt::{INTERRUPTED, Interrupt};
use crate::progress::Progress;
use crate::render::Presenter;
use std::error::Error;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use teeter_integrator::{Ended, Observer, RunError};
use teeter_report::{
    EndedWord, ExportWhen, Exporter, PageRecorder, Recorder, Results, ResultsError, Summary, Watch, figures, render,
};
use teeter_scenario::decode::LARGEST_FILE;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;

/// How the command ended; the exit code of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    Done,
    /// The work failed.
    Failed,
    /// Bad input or usage: nothing was written.
    BadInput,
    /// The user ended it.
    Interrupted,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        match exit {
            Exit::Done => Self::SUCCESS,
            Exit::Failed => Self::from(1),
            Exit::BadInput => Self::from(2),
            Exit::Interrupted => Self::from(INTERRUPTED),
        }
    }
}

#[derive(Debug)]
pub(crate) struct Options {
    pub(crate) scene: PathBuf,
    pub(crate) out: Option<PathBuf>,
    pub(crate) set: Vec<(String, String)>,
    pub(crate) quiet: bool,
    pub(crate) force: bool,
    /// Where to save contact problems, and which.
    pub(crate) export: Option<(PathBuf, ExportWhen)>,
}

/// `hard` or `every:N`.
pub(crate) fn export_when(text: &str) -> Result<ExportWhen, String> {
    let every = text.strip_prefix("every:").and_then(|n| n.parse().ok()).filter(|&n: &u64| n > 0);
    match (text, every) {
        ("hard", _) => Ok(ExportWhen::Hard),
        (_, Some(n)) => Ok(ExportWhen::Every(n)),
        _ => Err("write hard, or every:N with N from 1, such as every:100".to_owned()),
    }
}

pub(crate) fn run(options: &Options) -> Exit {
    let console = Console::new(options.quiet);
    let (name, stem) = named(&options.scene);
    let bytes = match read(&options.scene) {
        Ok(bytes) => bytes,
        Err(why) => return bad_input(console, &format!("error: {name}: {why}")),
    };
    let mut companions = companions::reader(&options.scene);
    let resolved = match teeter_scenario::load_with(&bytes, &name, &stem, &options.set, &mut companions) {
        Ok(resolved) => resolved,
        Err(errors) => return bad_input(console, &Presenter::of_bytes(&bytes).all(&errors)),
    };
    let presenter = Presenter::new(resolved.document.source());
    let watch = Watch::default();
    let wrap = |solver| if options.export.is_some() { watch.around(solver) } else { solver };
    let mut simulation = match Simulation::with_solver(&resolved.scene, wrap) {
        Ok(simulation) => simulation,
        Err(error) => return bad_input(console, &presenter.one(&error.diagnostic(&resolved.document))),
    };
    let mut exporter = match exporter(options, &watch, &resolved, &stem) {
        Ok(exporter) => exporter,
        Err(error) => return bad_input(console, &format!("error: {error}")),
    };
    let folder = options.out.clone().unwrap_or_else(|| Path::new("runs").join(&stem));
    let results = match Results::create(&folder, options.force) {
        Ok(results) => results,
        Err(error) => return bad_input(console, &format!("error: {error}")),
    };
    for warning in &resolved.warnings {
        console.note(&presenter.one(warning));
    }
    let scene_as_run = resolved.document.to_toml_elsewhere(|file| companions::seen_from(&folder, &options.scene, file));
    match simulate(console, &resolved, &mut simulation, &results, &scene_as_run, exporter.as_mut()) {
        Ok(summary) => {
            let exit = conclude(console, &summary, &folder);
            if let (Some(exporter), Some((folder, _))) = (&exporter, &options.export) {
                let count = exporter.written();
                let problems = if count == 1 { "problem" } else { "problems" };
                console.note(&format!("  {count} contact {problems} in {}", folder.display()));
            }
            exit
        }
        Err(error) => {
            console.error(&format!("error: {error}"));
            Exit::Failed
        }
    }
}

fn exporter(
    options: &Options,
    watch: &Watch,
    resolved: &Resolved,
    stem: &str,
) -> Result<Option<Exporter>, ResultsError> {
    let Some((folder, when)) = &options.export else { return Ok(None) };
    let scene = &resolved.scene;
    let (steps, tolerance) = (scene.time.steps, scene.solver.tolerance);
    Exporter::create(watch, folder, stem, &scene.title, steps, *when, tolerance, options.force).map(Some)
}

/// The name of a scene in messages, and that of its results.
pub(crate) fn named(scene: &Path) -> (String, String) {
    if scene == Path::new("-") {
        return ("<stdin>".to_owned(), "stdin".to_owned());
    }
    let stem = scene.file_stem().map_or("scene".into(), |stem| stem.to_string_lossy().into_owned());
    (scene.display().to_string(), stem)
}

/// Runs and writes. The summary comes last: a folder without one holds a run that didn't end.
fn simulate(
    console: Console,
    resolved: &Resolved,
    simulation: &mut Simulation,
    results: &Results,
    scene_as_run: &str,
    exporter: Option<&mut Exporter>,
) -> Result<Summary, Box<dyn Error>> {
    let scene = &resolved.scene;
    let layout = simulation.layout.clone();
    let mut progress = Progress::new(console, scene.time.steps);
    let tell = progress.tell();
    let mut tell_warning = |text: &str| tell(&format!("warning: {text}"));
    let mut recorder = Recorder::new(results, scene, &layout, &mut tell_warning)?;
    recorder.note(&resolved.warnings);
    let mut page = PageRecorder::new(scene, &layout);
    results.write("scene.toml", scene_as_run)?;

    let clock = Instant::now();
    let mut interrupt = Interrupt::listen();
    let mut observers: Vec<&mut dyn Observer<2>> = vec![&mut recorder, &mut page, &mut progress, &mut interrupt];
    if let Some(exporter) = exporter {
        observers.push(exporter);
    }
    let ran = simulation.run(&mut observers);
    drop(progress);
    let seconds = clock.elapsed().as_secs_f64();

    let mut record = recorder.into_record();
    let ended = match ran {
        Ok(ended) => {
            if let Ended::Failed(error) = &ended {
                record.warnings.enter("ended", error.t(), || error.to_string());
            }
            EndedWord::from(&ended)
        }
        Err(RunError::Observer(error)) => {
            if !is_disk_full(error.as_ref()) {
                return Err(error);
            }
            record.warnings.enter("ended", Some(simulation.state.t), || error.to_string());
            EndedWord::DiskFull
        }
        Err(error) => return Err(error.into()),
    };
    let summary = Summary::new(scene, &layout, &simulation.state, &record, ended, seconds);
    let written = write_pages(results, &page, &summary, scene_as_run);
    let written = written.and_then(|()| Ok(results.write("summary.json", &summary.to_json()?)?));
    match written {
        // No room for these either; the reason is told all the same.
        Err(error) if ended == EndedWord::DiskFull && is_disk_full(error.as_ref()) => {}
        written => written?,
    }
    Ok(summary)
}

fn write_pages(
    results: &Results,
    page: &PageRecorder,
    summary: &Summary,
    scene_as_run: &str,
) -> Result<(), Box<dyn Error>> {
    results.write("report.html", &render(page, summary, scene_as_run))?;
    for (name, svg) in figures(page) {
        results.write(&format!("figures/{name}"), &svg)?;
    }
    Ok(())
}

fn is_disk_full(error: &(dyn Error + 'static)) -> bool {
    error.downcast_ref::<ResultsError>().is_some_and(ResultsError::is_disk_full)
}

fn conclude(console: Console, summary: &Summary, folder: &Path) -> Exit {
    match summary.ended {
        EndedWord::Complete => {
            console.note(&told(summary, folder));
            Exit::Done
        }
        EndedWord::Interrupted => {
            console.note(&how_it_ended(summary, "interrupted"));
            Exit::Interrupted
        }
        _ => {
            let reason = summary.warnings.iter().find(|w| matches!(w.code, "ended" | "unconverged"));
            let why = reason.map_or("it could not go on", |warning| warning.text.as_str());
            console.error(&format!("error: {}", how_it_ended(summary, why)));
            Exit::Failed
        }
    }
}

/// A scene's bytes; of a file too large for one, no more than shows that.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, String> {
    let most = LARGEST_FILE as u64 + 1;
    if path == Path::new("-") {
        let mut bytes = Vec::new();
        std::io::stdin().take(most).read_to_end(&mut bytes).map_err(|error| format!("can't be read: {error}"))?;
        return Ok(bytes);
    }
    if path.is_dir() {
        return Err("is a folder, not a scene file".to_owned());
    }
    let mut bytes = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(most).read_to_end(&mut bytes));
    read.map(|_| bytes).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => "no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "no permission to read it".to_owned(),
        _ => format!("can't be read: {error}"),
    })
}

fn bad_input(console: Console, text: &str) -> Exit {
    console.error(text);
    Exit::BadInput
}

fn how_it_ended(summary: &Summary, why: &str) -> String {
    let t = summary.t;
    format!("the run ended at t = {t} s after {} steps: {why}; the rows up to there are written", summary.steps)
}

/// What a user wants to know first.
fn told(summary: &Summary, folder: &Path) -> String {
    let mut text = format!(
        "{}: {} steps of {} s in {:.2} s ({:.2} µs a step)\n",
        summary.title, summary.steps, summary.dt, summary.wall_seconds, summary.us_per_step
    );
    let count = |n: u64, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    text.push_str(&format!(
        "  {}, {}, deepest penetration {:.1e} m, energy identity to {:.0e}\n",
        count(summary.impact_count, "impact"),
        count(summary.crossings.len() as u64, "zero crossing"),
        summary.max_penetration,
        summary.energy.largest_residual
    ));
    if summary.contact.unconverged_steps > 0 {
        text.push_str(&format!("  {} steps not solved to tolerance\n", summary.contact.unconverged_steps));
    }
    text.push_str(&format!("  results in {0}, to be looked at in {0}/report.html", folder.display()));
    text
}
