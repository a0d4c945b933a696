//! `teeter run`: turns arguments into a job, its hooks into console output, and its end into an
//! exit code.

use crate::console::Console;
use crate::interrupt::{self, INTERRUPTED};
use crate::progress::StepBar;
use crate::render::{Presenter, refusal};
use crate::scene;
#[cfg(feature = "parallel")]
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use teeter_report::{ENERGY_MADE, ENERGY_TAKEN, FILES, HORIZON, Results, UNLOCATED, YIELD, with_digits, with_unit};
use teeter_run::{
    EndedWord, ExistingResults, ExportWhen, Extent, FinishedRun, Hooks, LoadError, PrepareError, Prepared, RunError,
    RunJob, RunStart, StateDump, Summary,
};
use teeter_scenario::dimension::Dimension;
use teeter_scenario::quantity;
use teeter_study::ErrorBasis;

/// How the command ended, for the exit code of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    FinishedRun,
    /// The work failed.
    Failed,
    /// Bad input or usage: nothing was written.
    BadInput,
    /// Ended by the user.
    Interrupted,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        match exit {
            Exit::FinishedRun => Self::SUCCESS,
            Exit::Failed => Self::from(1),
            Exit::BadInput => Self::from(2),
            Exit::Interrupted => Self::from(INTERRUPTED),
        }
    }
}

#[derive(Debug)]
pub(crate) struct Options {
    pub(crate) scene: PathBuf,
    /// Folder of the files that the scene names, if it is another than by default.
    pub(crate) base: Option<PathBuf>,
    pub(crate) out: Option<PathBuf>,
    pub(crate) set: Vec<(String, String)>,
    pub(crate) quiet: bool,
    /// Whether to leave out the report and its figures.
    pub(crate) no_report: bool,
    pub(crate) existing: ExistingResults,
    /// Folder for contact problems, and which to save.
    pub(crate) export: Option<(PathBuf, ExportWhen)>,
    /// Simulated time between checkpoints, s.
    pub(crate) checkpoint_every: Option<f64>,
    /// Whether to write pictures as VTK files.
    pub(crate) vtk: bool,
    /// How much of the scene is modelled.
    pub(crate) extent: Extent,
    /// A state to start from.
    pub(crate) from: Option<PathBuf>,
    /// Whether to find up to when the motion is predictable.
    pub(crate) horizon: bool,
    /// File for the state before the first unsolved step.
    pub(crate) dump_unconverged: Option<PathBuf>,
    #[cfg(feature = "animation")]
    pub(crate) animate: crate::animate::Animate,
    /// Threads of the run; none: as many as there are cores.
    #[cfg(feature = "parallel")]
    pub(crate) threads: Option<NonZeroUsize>,
}

impl Options {
    fn job(&self) -> Result<RunJob, LoadError> {
        let mut job =
            RunJob::new(scene::source(&self.scene, self.base.as_deref())?).existing(self.existing).extent(self.extent);
        for (path, value) in &self.set {
            job = job.set(path, value);
        }
        if let Some(folder) = &self.out {
            job = job.folder(folder);
        }
        if let Some((folder, when)) = &self.export {
            job = job.export_problems(folder, *when);
        }
        if let Some(seconds) = self.checkpoint_every {
            job = job.checkpoint_every(seconds);
        }
        if let Some(path) = &self.from {
            job = job.from_state(path);
        }
        if self.no_report {
            job = job.without_report();
        }
        if self.horizon {
            job = job.horizon();
        }
        if self.vtk {
            job = job.with_vtk();
        }
        if let Some(path) = &self.dump_unconverged {
            job = job.dump_unconverged(path);
        }
        #[cfg(feature = "animation")]
        if let Some((path, animation)) = self.animate.file() {
            job = job.animate(path, animation);
        }
        #[cfg(feature = "parallel")]
        {
            let cores = || std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
            job = job.threads(self.threads.unwrap_or_else(cores).get());
        }
        Ok(job)
    }
}

/// The files from which the scene is read, as far as it can be read.
pub(crate) fn inputs(options: &Options) -> Vec<PathBuf> {
    let source = scene::source(&options.scene, options.base.as_deref());
    let named = source.and_then(|source| source.load(&options.set).map(|resolved| source.inputs(&resolved)));
    named.unwrap_or_else(|_| vec![options.scene.clone()])
}

/// Whether the folder for the results holds some already.
pub(crate) fn has_results(options: &Options) -> bool {
    let stem = options.scene.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = options.out.clone().unwrap_or_else(|| Path::new("runs").join(stem));
    Results::replaced(&FILES, &folder, false).is_err()
}

/// `required` or `full`.
pub(crate) fn extent(text: &str) -> Result<Extent, String> {
    let known = [Extent::Required, Extent::Full].into_iter().find(|extent| extent.word() == text);
    known.ok_or_else(|| "write full, or required, which is the default".to_owned())
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

/// `0.1 s` and the like.
pub(crate) fn interval(text: &str) -> Result<f64, String> {
    match quantity::parse(text, Dimension::TIME) {
        Ok(seconds) if seconds > 0.0 => Ok(seconds),
        Ok(_) => Err("write a time greater than 0, such as \"0.1 s\"".to_owned()),
        Err(error) => Err(error.to_string()),
    }
}

pub(crate) fn run(options: &Options) -> Exit {
    let console = Console::new(options.quiet);
    let prepared = match options.job().map_err(PrepareError::Load).and_then(RunJob::prepare) {
        Ok(prepared) => prepared,
        Err(error) => return refuse(console, &error),
    };
    let start_notes = start_notes(&prepared);
    let progress = StepBar::new(console, prepared.first_step(), prepared.steps());
    let tell = progress.tell();
    let hooks = Hooks::new()
        .on_start(|| start_notes.iter().for_each(|note| console.note(note)))
        .on_progress(|at| progress.at(at.step))
        .on_warning(|text| tell(&format!("warning: {text}")))
        // From here on files are written: a signal ends the run, not the process.
        .cancelled_by(interrupt::listen());
    let ran = prepared.run(hooks);
    drop(progress);
    match ran {
        Ok(done) => conclude(console, options, &done),
        Err(error) => {
            console.error(&format!("error: {error}"));
            if matches!(error, RunError::Folder(_)) { Exit::BadInput } else { Exit::Failed }
        }
    }
}

fn refuse(console: Console, error: &PrepareError) -> Exit {
    match error {
        PrepareError::AlreadyEnded { ended: EndedWord::Complete | EndedWord::Stopped, .. } => {
            console.note(&error.to_string());
            return Exit::FinishedRun;
        }
        PrepareError::AlreadyEnded { .. } => {
            console.error(&format!("error: {error}"));
            return Exit::Failed;
        }
        PrepareError::Load(error) => console.error(&refusal(error)),
        PrepareError::Resume(_) => {
            console.error(&format!("error: {error}\nhelp: --force instead of --resume starts over"));
        }
        PrepareError::FileExists(_) => console.error(&format!("error: {error}; --force replaces it")),
        error => console.error(&format!("error: {error}")),
    }
    Exit::BadInput
}

/// Notes before a run: where it starts, unless at the beginning, and warnings about the scene.
fn start_notes(prepared: &Prepared) -> Vec<String> {
    let place = prepared.folder().display();
    let start = match prepared.start() {
        RunStart::Checkpoint { t } => Some(format!("continuing from t = {}", with_unit(t, "s"))),
        RunStart::NoCheckpoint => Some(format!("{place} has no checkpoint: the run starts again from the beginning")),
        RunStart::NothingToResume => Some(format!("{place} has no run to resume: it starts from the beginning")),
        _ => None,
    };
    let presenter = Presenter::new(prepared.resolved().document.source());
    let chosen = prepared.chosen_step().map(|chosen| {
        let until =
            if chosen.whole { String::new() } else { format!(" up to t = {:.4} s, the horizon", chosen.horizon) };
        let off = match chosen.basis {
            ErrorBasis::Order => "by a run with half of it",
            _ => "from finer ones",
        };
        let step = with_unit(chosen.step, "s");
        format!("steps of {step}, found by {} runs: off by {:.1e} {off}{until}", chosen.runs, chosen.error)
    });
    // What was chosen for the tables, and how to get more.
    let rows = prepared.resolved().notes.iter().filter(|note| note.path == "output.every");
    let rows = rows.map(|note| presenter.one(note));
    // It may be a folder that was meant for something else.
    let foreign = Results::foreign(&FILES, prepared.folder()).map(|(count, first)| {
        let others = match count {
            1 => format!("`{first}`, which is not of a run and stays"),
            _ => format!("{count} files and folders that are not of a run, such as `{first}`; they stay"),
        };
        format!("note: {place} also holds {others}")
    });
    start
        .into_iter()
        .chain(foreign)
        .chain(chosen)
        .chain(rows)
        .chain(prepared.warnings().iter().map(|warning| presenter.one(warning)))
        .collect()
}

/// Reports how a run ended and what it wrote besides its results.
fn conclude(console: Console, options: &Options, done: &FinishedRun) -> Exit {
    let exit = report_end(console, options, &done.summary, &done.folder);
    if let Some(exported) = &done.exported {
        let count = exported.count;
        let problems = if count == 1 { "problem" } else { "problems" };
        console.note(&format!("  {count} contact {problems} in {}", exported.folder.display()));
    }
    #[cfg(feature = "animation")]
    if let (Some((path, asked)), Some(made)) = (options.animate.file(), &done.animation) {
        console.note(&crate::animate::describe(path, &asked, made));
    }
    match &done.dump {
        Some(StateDump::Written(path)) => {
            let path = path.display();
            console
                .note(&format!("  the state before the first unsolved step is in {path}; --from {path} starts there"));
        }
        Some(StateDump::NotNeeded(path)) => {
            console.note(&format!("  every step was solved, so {} is not written", path.display()));
        }
        _ => {}
    }
    exit
}

fn report_end(console: Console, options: &Options, summary: &Summary, folder: &Path) -> Exit {
    // All others have been printed when they occurred.
    for warning in summary
        .warnings
        .iter()
        .filter(|warning| [ENERGY_MADE, ENERGY_TAKEN, HORIZON, UNLOCATED, YIELD].contains(&warning.code.as_ref()))
    {
        console.note(&format!("warning: {}", warning.text));
    }
    match summary.ended {
        EndedWord::Complete | EndedWord::Stopped => {
            console.note(&format_summary(summary, folder, options.horizon, !options.no_report));
            Exit::FinishedRun
        }
        EndedWord::Interrupted => {
            let mut text = how_it_ended(summary, "interrupted");
            text.push_str(if options.checkpoint_every.is_some() { "; --resume continues from there" } else { "" });
            console.note(&text);
            Exit::Interrupted
        }
        _ => {
            let reason = summary.warnings.iter().find(|w| matches!(w.code.as_ref(), "ended" | "unconverged"));
            let why = reason.map_or("it could not continue", |warning| warning.text.as_str());
            console.error(&format!("error: {}", how_it_ended(summary, why)));
            Exit::Failed
        }
    }
}

fn how_it_ended(summary: &Summary, why: &str) -> String {
    let t = with_unit(summary.t, "s");
    let rows = match summary.ended {
        EndedWord::DiskFull => "the tables contain the rows for which there was space",
        _ => "the rows up to there are written",
    };
    format!("the run ended at t = {t} after {} steps: {why}; {rows}", summary.steps)
}

/// The summary for the user.
fn format_summary(summary: &Summary, folder: &Path, horizon: bool, report: bool) -> String {
    let reserve = summary.reserve().map_or_else(String::new, |reserve| format!("; {reserve}"));
    let mut text = format!("{}: {}{reserve}\n", summary.title, summary.headline);
    if let Some(reason) = summary.stopped_by {
        text.push_str(&format!("  stopped at t = {} by `{}` of time.stop\n", with_unit(summary.t, "s"), reason.word()));
    }
    text.push_str(&format!(
        "  {} steps of {} in {:.2} s ({:.2} µs per step)\n",
        summary.steps,
        with_unit(summary.dt, "s"),
        summary.wall_seconds,
        summary.us_per_step
    ));
    let count = |n: u64, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let identity = format!("energy identity to {:.0e}", summary.energy.largest_residual);
    if summary.model.blocks.is_empty() {
        // Nothing touches or rocks.
        text.push_str(&format!("  {identity}\n"));
    } else {
        text.push_str(&format!(
            "  {}{}{}, {}, deepest penetration {}, {identity}\n",
            count(summary.impact_count, "impact"),
            // A block that lands flat has one at each of its corners.
            summary.strikers(),
            if summary.reclosure_count > 0 {
                format!(" and {}", count(summary.reclosure_count, "re-closure"))
            } else {
                String::new()
            },
            count(summary.crossing_count.unwrap_or(summary.crossings.len() as u64), "zero crossing"),
            with_digits(summary.told_penetration(), "m", 2),
        ));
    }
    if summary.contact.unconverged_steps > 0 {
        text.push_str(&format!("  {} not solved to tolerance\n", count(summary.contact.unconverged_steps, "step")));
    }
    // If it is earlier, there was a warning.
    if horizon && summary.warnings.iter().all(|warning| warning.code != HORIZON) {
        text.push_str("  horizon: with half the step, and with the initial state perturbed by 1e-12, the motion agrees within 1 % to the end\n");
    }
    text.push_str(&format!("  results in {0}", folder.display()));
    if report {
        text.push_str(&format!(", report in {}/report.html", folder.display()));
    }
    text
}
