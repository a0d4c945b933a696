//! `teeter run`.

use crate::companions;
use crate::console::{Console, clean};
use crate::interrupt::{self, INTERRUPTED};
use crate::progress::Progress;
use crate::render::Presenter;
use crate::start::{self, Start};
use std::error::Error;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use teeter_integrator::{Ended, RunError};
use teeter_report::{
    CHECKPOINT, Checkpoint, ENERGY_MADE, EndedWord, ExportWhen, Exporter, Former, Identity, Origin, PageRecorder,
    Results, ResultsError, RunRecorder, Summary, Watch, envelopes, figures, render,
};
use teeter_scenario::Extent;
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
    /// Simulated time between checkpoints, s.
    pub(crate) checkpoint_every: Option<f64>,
    pub(crate) resume: bool,
    /// How much of the scene is modelled.
    pub(crate) extent: Extent,
    /// A state to start from.
    pub(crate) from: Option<PathBuf>,
    /// Where to write the state before the first step that is not solved.
    pub(crate) dump_unconverged: Option<PathBuf>,
}

impl Options {
    /// How much of the scene is modelled. What a scene can't need is known of its own start only: from another state, all is.
    pub(crate) fn extent(&self) -> Extent {
        if self.from.is_some() { Extent::Full } else { self.extent }
    }
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

pub(crate) fn run(options: &Options) -> Exit {
    let console = Console::new(options.quiet);
    let (name, stem) = named(&options.scene);
    let bytes = match read(&options.scene) {
        Ok(bytes) => bytes,
        Err(why) => return bad_input(console, &format!("error: {name}: {why}")),
    };
    let (mut files, mut inputs) = (Vec::new(), inputs(options));
    let mut companions = companions::reader(&options.scene);
    let mut read_file = |file: &str| {
        let bytes = companions(file)?;
        inputs.push(companions::place(&options.scene, file));
        files.extend(start::is_identified(options).then(|| bytes.clone()));
        Ok(bytes)
    };
    let resolved = match teeter_scenario::load_with(&bytes, &name, &stem, &options.set, &mut read_file) {
        Ok(resolved) => resolved,
        Err(errors) => return bad_input(console, &Presenter::of_bytes(&bytes).all(&errors)),
    };
    let presenter = Presenter::new(resolved.document.source());
    let watch = Watch::default();
    let wrap = |solver| if options.export.is_some() { watch.around(solver) } else { solver };
    let mut simulation = match Simulation::with_extent(&resolved.scene, options.extent(), wrap) {
        Ok(simulation) => simulation,
        Err(error) => return bad_input(console, &presenter.one(&error.diagnostic(&resolved.document))),
    };
    let folder = options.out.clone().unwrap_or_else(|| Path::new("runs").join(&stem));
    let begun = start::spare(&inputs, options, &folder)
        .map_err(Into::into)
        .and_then(|()| begin(options, console, &resolved, &files, &stem, &folder, &watch, &mut simulation));
    match begun {
        Ok(Begun::Ready(job)) => {
            for warning in &resolved.warnings {
                console.note(&presenter.one(warning));
            }
            job.carry_out(console, options, &folder, &resolved, &mut simulation)
        }
        Ok(Begun::Ended(exit)) => exit,
        Err(error) => bad_input(console, &format!("error: {error}")),
    }
}

/// The files that the command line names to be read; those that the scene names come to them.
fn inputs(options: &Options) -> Vec<PathBuf> {
    let scene = Some(&options.scene).filter(|scene| scene.as_path() != Path::new("-"));
    scene.into_iter().chain(&options.from).cloned().collect()
}

/// What is settled before anything is simulated.
struct Job {
    scene_as_run: String,
    identity: Option<Identity>,
    results: Results,
    exporter: Option<Exporter>,
    checkpoint: Option<Checkpoint>,
}

enum Begun {
    Ready(Box<Job>),
    /// There was nothing to do.
    Ended(Exit),
}

/// Finds where to start, and takes the folders: until then, nothing is changed.
fn begin(
    options: &Options,
    console: Console,
    resolved: &Resolved,
    files: &[Vec<u8>],
    stem: &str,
    folder: &Path,
    watch: &Watch,
    simulation: &mut Simulation,
) -> Result<Begun, Box<dyn Error>> {
    // Before its whole content is hashed: it may be of another kind.
    if let Some(path) = &options.from {
        simulation.state = start::state_from(path, &resolved.scene, simulation)?;
    }
    let identity = start::identity(options, stem, &resolved.document.to_toml(), files)?;
    start::check_dump(options)?;
    // Paths in it hold from the folder, which is to be there.
    let scene_as_run =
        || resolved.document.to_toml_elsewhere(|file| companions::seen_from(folder, &options.scene, file));
    let start = Start::find(options, folder, identity.as_ref(), &scene_as_run())?;
    if let Start::Ended { word } = &start {
        let text = start::told_of_ended(word, folder);
        if word == "complete" {
            console.note(&text);
            return Ok(Begun::Ended(Exit::Done));
        }
        console.error(&format!("error: {text}"));
        return Ok(Begun::Ended(Exit::Failed));
    }
    // From here on files are touched: a signal ends the run in order, not the process.
    interrupt::listen();
    let exporter = exporter(options, watch, resolved, stem, start.former())?;
    let results = start.take(folder)?;
    let checkpoint = match start {
        Start::Checkpoint(checkpoint) => {
            simulation.state = checkpoint.state().clone();
            console.note(&format!("going on from t = {} s", simulation.state.t));
            Some(*checkpoint)
        }
        Start::Beginning { note: Some(note), .. } => {
            console.note(&note);
            None
        }
        _ => None,
    };
    let job = Job { scene_as_run: scene_as_run(), identity, results, exporter, checkpoint };
    Ok(Begun::Ready(Box::new(job)))
}

fn exporter(
    options: &Options,
    watch: &Watch,
    resolved: &Resolved,
    stem: &str,
    former: Former,
) -> Result<Option<Exporter>, ResultsError> {
    let Some((folder, when)) = &options.export else { return Ok(None) };
    let scene = &resolved.scene;
    let (steps, tolerance) = (scene.time.steps, scene.solver.tolerance);
    Exporter::create(watch, folder, stem, &scene.title, steps, *when, tolerance, former).map(Some)
}

/// The name of a scene in messages, and that of its results.
pub(crate) fn named(scene: &Path) -> (String, String) {
    if scene == Path::new("-") {
        return ("<stdin>".to_owned(), "stdin".to_owned());
    }
    let stem = scene.file_stem().map_or("scene".into(), |stem| stem.to_string_lossy().into_owned());
    (clean(&scene.display().to_string(), ""), stem)
}

impl Job {
    fn carry_out(
        self,
        console: Console,
        options: &Options,
        folder: &Path,
        resolved: &Resolved,
        simulation: &mut Simulation,
    ) -> Exit {
        match self.simulate(console, options, resolved, simulation) {
            Ok(done) => {
                let exit = conclude(console, &done.summary, folder, options.checkpoint_every.is_some());
                if let (Some(exporter), Some((folder, _))) = (&done.exporter, &options.export) {
                    let count = exporter.written();
                    let problems = if count == 1 { "problem" } else { "problems" };
                    console.note(&format!("  {count} contact {problems} in {}", folder.display()));
                }
                if let Some(path) = &options.dump_unconverged {
                    let unsolved = done.summary.contact.unconverged_steps > 0;
                    let path = path.display();
                    console.note(&if unsolved {
                        format!("  the state before the first step not solved is in {path}; --from {path} starts there")
                    } else {
                        format!("  every step was solved: {path} is not written")
                    });
                }
                exit
            }
            Err(error) => {
                console.error(&format!("error: {error}"));
                Exit::Failed
            }
        }
    }

    /// Runs and writes. The summary comes last: a folder without one holds a run that didn't end.
    fn simulate(
        self,
        console: Console,
        options: &Options,
        resolved: &Resolved,
        simulation: &mut Simulation,
    ) -> Result<Done, Box<dyn Error>> {
        let Self { scene_as_run, identity, results, exporter, checkpoint } = self;
        let scene = &resolved.scene;
        let layout = simulation.layout.clone();
        let mut progress = Progress::new(console, simulation.state.step, scene.time.steps);
        let tell = progress.tell();
        let mut tell_warning = |text: &str| tell(&format!("warning: {text}"));
        // Before the tables: it says whose they are.
        results.write("scene.toml", &scene_as_run)?;
        let mut recorder = RunRecorder::new(&results, scene, &layout, exporter, checkpoint, &mut tell_warning)?;
        recorder.note(&resolved.warnings);
        if let Some(identity) = &identity {
            let origin = Origin { identity, scheme: simulation.scheme() };
            if let Some(every) = options.checkpoint_every {
                recorder = recorder.with_checkpoints(&results, origin, every);
            }
            if let Some(path) = &options.dump_unconverged {
                recorder = recorder.with_dump(path, origin);
            }
        }
        let mut recorder = recorder.until(interrupt::listen());
        let ran = simulation.run(&mut [&mut recorder, &mut progress]);
        drop(progress);
        let seconds = recorder.seconds();

        let (mut record, page, exporter) = recorder.into_parts();
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
        let envelopes = envelopes(&layout, &record.beams);
        let written = envelopes.map_or(Ok(()), |text| results.write("envelopes.csv", text).map_err(Into::into));
        let written = written.and_then(|()| write_pages(&results, &page, &summary, &scene_as_run));
        let written = written.and_then(|()| Ok(results.write("summary.json", summary.to_json()?)?));
        match written {
            // No room for these either; the reason is told all the same.
            Err(error) if ended == EndedWord::DiskFull && is_disk_full(error.as_ref()) => {}
            written => written?,
        }
        if !matches!(ended, EndedWord::Interrupted | EndedWord::DiskFull) {
            results.remove(CHECKPOINT)?;
        }
        Ok(Done { summary, exporter })
    }
}

struct Done {
    summary: Summary,
    exporter: Option<Exporter>,
}

fn write_pages(
    results: &Results,
    page: &PageRecorder,
    summary: &Summary,
    scene_as_run: &str,
) -> Result<(), Box<dyn Error>> {
    results.write("report.html", render(page, summary, scene_as_run))?;
    for (name, svg) in figures(page) {
        results.write(&format!("figures/{name}"), &svg)?;
    }
    Ok(())
}

fn is_disk_full(error: &(dyn Error + 'static)) -> bool {
    error.downcast_ref::<ResultsError>().is_some_and(ResultsError::is_disk_full)
}

fn conclude(console: Console, summary: &Summary, folder: &Path, resumable: bool) -> Exit {
    // All others have been told as they came.
    for warning in summary.warnings.iter().filter(|warning| warning.code == ENERGY_MADE) {
        console.note(&format!("warning: {}", warning.text));
    }
    match summary.ended {
        EndedWord::Complete => {
            console.note(&told(summary, folder));
            Exit::Done
        }
        EndedWord::Interrupted => {
            let mut text = how_it_ended(summary, "interrupted");
            text.push_str(if resumable { "; --resume goes on from there" } else { "" });
            console.note(&text);
            Exit::Interrupted
        }
        _ => {
            let reason = summary.warnings.iter().find(|w| matches!(w.code.as_ref(), "ended" | "unconverged"));
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
    let rows = match summary.ended {
        EndedWord::DiskFull => "the tables hold the rows that there was room for",
        _ => "the rows up to there are written",
    };
    format!("the run ended at t = {t} s after {} steps: {why}; {rows}", summary.steps)
}

/// What a user wants to know first.
fn told(summary: &Summary, folder: &Path) -> String {
    let mut text = format!(
        "{}: {} steps of {} s in {:.2} s ({:.2} µs a step)\n",
        summary.title, summary.steps, summary.dt, summary.wall_seconds, summary.us_per_step
    );
    let count = |n: u64, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    text.push_str(&format!(
        "  {}{}, {}, deepest penetration of a corner {:.1e} m, energy identity to {:.0e}\n",
        count(summary.impact_count, "impact"),
        if summary.reclosure_count > 0 {
            format!(" and {}", count(summary.reclosure_count, "re-closure"))
        } else {
            String::new()
        },
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
