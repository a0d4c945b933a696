//! `teeter run`.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use teeter_report::{EndedWord, Recorder, Results, Summary};
use teeter_scenario::simulation::Simulation;

/// How the command ended; the exit code of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    Done,
    /// The work failed.
    Failed,
    /// Bad input or usage: nothing was written.
    BadInput,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        match exit {
            Exit::Done => Self::SUCCESS,
            Exit::Failed => Self::from(1),
            Exit::BadInput => Self::from(2),
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
}

pub(crate) fn run(options: &Options) -> Exit {
    let (name, stem) = if options.scene == Path::new("-") {
        ("<stdin>".to_owned(), "stdin".to_owned())
    } else {
        let stem = options.scene.file_stem().map_or("scene".into(), |stem| stem.to_string_lossy().into_owned());
        (options.scene.display().to_string(), stem)
    };
    let bytes = match read(&options.scene) {
        Ok(bytes) => bytes,
        Err(why) => return bad_input(&format!("error: {name}: {why}")),
    };
    let resolved = match teeter_scenario::load(&bytes, &name, &stem, &options.set) {
        Ok(resolved) => resolved,
        Err(errors) => return bad_input(&errors.to_string()),
    };
    let scene = &resolved.scene;
    let mut simulation = match Simulation::new(scene) {
        Ok(simulation) => simulation,
        Err(error) => return bad_input(&format!("error: {name}: {error}")),
    };
    let folder = options.out.clone().unwrap_or_else(|| Path::new("runs").join(&stem));
    let results = match Results::create(&folder, options.force) {
        Ok(results) => results,
        Err(error) => return bad_input(&format!("error: {error}")),
    };
    let tell = |text: &str| {
        if !options.quiet {
            eprintln!("{text}");
        }
    };
    for warning in &resolved.warnings {
        tell(&warning.to_string());
    }

    let layout = simulation.layout.clone();
    let mut tell_warning = |text: &str| tell(&format!("warning: {text}"));
    let mut recorder = match Recorder::new(&results, scene, &layout, &mut tell_warning) {
        Ok(recorder) => recorder,
        Err(error) => return failed(&error),
    };
    recorder.note(&resolved.warnings);
    let clock = Instant::now();
    let ended = match simulation.run(&mut [&mut recorder]) {
        Ok(ended) => ended,
        Err(error) => return failed(&format!("{}: {error}", folder.display())),
    };
    let record = match recorder.finish() {
        Ok(record) => record,
        Err(error) => return failed(&format!("{}: {error}", folder.display())),
    };
    let seconds = clock.elapsed().as_secs_f64();
    let summary = Summary::new(scene, &layout, &simulation.state, &record, &ended, seconds);
    let json = match summary.to_json() {
        Ok(json) => json,
        Err(error) => return failed(&format!("summary.json: {error}")),
    };
    for (file, text) in [("scene.toml", resolved.document.to_toml()), ("summary.json", json)] {
        if let Err(error) = results.write(file, &text) {
            return failed(&error);
        }
    }
    if summary.ended != EndedWord::Complete {
        return failed(&how_it_ended(&summary));
    }
    tell(&told(&summary, &folder));
    Exit::Done
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    if path == Path::new("-") {
        let mut bytes = Vec::new();
        std::io::stdin().read_to_end(&mut bytes).map_err(|error| format!("can't be read: {error}"))?;
        return Ok(bytes);
    }
    if path.is_dir() {
        return Err("is a folder, not a scene file".to_owned());
    }
    std::fs::read(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => "no such file".to_owned(),
        std::io::ErrorKind::PermissionDenied => "no permission to read it".to_owned(),
        _ => format!("can't be read: {error}"),
    })
}

fn bad_input(text: &str) -> Exit {
    eprintln!("{}", text.trim_end());
    Exit::BadInput
}

fn failed(error: &dyn std::fmt::Display) -> Exit {
    eprintln!("error: {error}");
    Exit::Failed
}

fn how_it_ended(summary: &Summary) -> String {
    let t = summary.steps as f64 * summary.dt;
    let why = summary.warnings.iter().find(|w| matches!(w.code, "ended" | "unconverged"));
    let why = why.map_or("", |warning| warning.text.as_str());
    format!("the run ended at t = {t} s after {} steps: {why}; the rows so far are written", summary.steps)
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
    text.push_str(&format!("  results in {}", folder.display()));
    text
}
