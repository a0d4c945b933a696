//! Where a run starts: at the beginning of its scene, from its own checkpoint, or from a state of another run.

use crate::run::Options;
use std::error::Error;
use std::path::{Path, PathBuf};
use teeter_integrator::State;
use teeter_report::{
    CHECKPOINT, Checkpoint, ExportWhen, FILES, Former, Found, Identity, Moment, Results, ResultsError, program_hash,
};
use teeter_scenario::Extent;
use teeter_scenario::dimension::Dimension;
use teeter_scenario::quantity;
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Simulation;

/// `0.1 s` and the like.
pub(crate) fn interval(text: &str) -> Result<f64, String> {
    match quantity::parse(text, Dimension::TIME) {
        Ok(seconds) if seconds > 0.0 => Ok(seconds),
        Ok(_) => Err("a time greater than 0 is wanted, such as \"0.1 s\"".to_owned()),
        Err(error) => Err(error.to_string()),
    }
}

/// What there is to do.
#[derive(Debug)]
pub(crate) enum Start {
    /// To start at the beginning; with what is to be told of it.
    Beginning { former: Former, note: Option<String> },
    /// To go on from a checkpoint.
    Checkpoint(Box<Checkpoint>),
    /// Nothing: the run has ended, for good or for bad.
    Ended { word: String },
}

impl Start {
    /// Looks where to start; changes nothing.
    pub(crate) fn find(
        options: &Options,
        folder: &Path,
        identity: Option<&Identity>,
        scene_as_run: &str,
    ) -> Result<Self, Box<dyn Error>> {
        let Some(identity) = identity.filter(|_| options.resume) else {
            let former = if options.force { Former::Remove } else { Former::Refuse };
            return Ok(Self::Beginning { former, note: None });
        };
        let found = Found::look(folder, identity, scene_as_run)
            .map_err(|error| format!("{error}\nhelp: --force in place of --resume starts over"))?;
        let place = folder.display();
        Ok(match found {
            Found::Ended(word) => Self::Ended { word },
            Found::Checkpoint(checkpoint) => Self::Checkpoint(checkpoint),
            Found::Unfinished => Self::Beginning {
                former: Former::Remove,
                note: Some(format!("{place} holds no checkpoint: the run starts again from its beginning")),
            },
            Found::Nothing => Self::Beginning {
                former: Former::Refuse,
                note: Some(format!("{place} holds no run to resume: it starts from its beginning")),
            },
        })
    }

    /// What becomes of an earlier run's contact problems.
    pub(crate) fn former(&self) -> Former {
        match self {
            Self::Beginning { former, .. } => *former,
            Self::Checkpoint(_) | Self::Ended { .. } => Former::Keep,
        }
    }

    /// Takes the folder for results.
    pub(crate) fn take(&self, folder: &Path) -> Result<Results, teeter_report::ResultsError> {
        match self.former() {
            Former::Keep => Results::reopen(folder),
            former => Results::create(folder, former == Former::Remove),
        }
    }
}

/// Whether a file has to know of which run it is.
pub(crate) fn is_identified(options: &Options) -> bool {
    options.checkpoint_every.is_some() || options.resume || options.dump_unconverged.is_some()
}

/// Program, scene with the contents of its files, and options of this run; `None` where no file has to know them.
pub(crate) fn identity(
    options: &Options,
    stem: &str,
    scene: &str,
    files: &[Vec<u8>],
) -> Result<Option<Identity>, Box<dyn Error>> {
    if !is_identified(options) {
        return Ok(None);
    }
    let program = program_hash().map_err(|error| format!("the program's own file can't be read: {error}"))?;
    let mut deciding = Vec::new();
    if let Some((_, when)) = &options.export {
        let when = match when {
            ExportWhen::Hard => "hard".to_owned(),
            ExportWhen::Every(n) => format!("every:{n}"),
        };
        deciding.push(format!("--export-problems of {stem}, --export-when {when}"));
    }
    if options.extent == Extent::Full {
        deciding.push("--model full".to_owned());
    }
    let from = match &options.from {
        None => Vec::new(),
        Some(path) => {
            deciding.push("--from".to_owned());
            std::fs::read(path).map_err(|error| format!("can't read {}: {error}", path.display()))?
        }
    };
    let files: Vec<&[u8]> = files.iter().chain([&from]).map(Vec::as_slice).collect();
    Ok(Some(Identity::new(program, scene, &files, &deciding.join(", "))))
}

/// The state that `--from` asks for.
pub(crate) fn state_from(
    path: &Path,
    scene: &Scene,
    simulation: &Simulation,
) -> Result<State, teeter_report::CheckpointError> {
    Moment::read(path)?.start(path, scene, &simulation.layout, &simulation.model, simulation.scheme())
}

/// Refuses a file for a state where there is one, or no folder for it.
pub(crate) fn check_dump(options: &Options) -> Result<(), Box<dyn Error>> {
    let Some(path) = &options.dump_unconverged else { return Ok(()) };
    if path.is_dir() {
        return Err(format!("{} is a folder, not a file for a state", path.display()).into());
    }
    if path.exists() && !options.force && !options.resume {
        return Err(format!("{} is there already; --force replaces it", path.display()).into());
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(format!("there is no folder {}", folder.display()).into());
    }
    Ok(())
}

/// Refuses to replace what the run reads: scene, files that it names, a state to start from.
pub(crate) fn spare(inputs: &[PathBuf], options: &Options, folder: &Path) -> Result<(), ResultsError> {
    Results::spares(&FILES, folder, inputs)?;
    if let Some(dump) = options.dump_unconverged.as_ref().and_then(|path| path.to_str()) {
        Results::spares(&[dump], Path::new(""), inputs)?;
    }
    Ok(())
}

/// What is said of a run that has ended.
pub(crate) fn told_of_ended(word: &str, folder: &Path) -> String {
    // It may have been killed between its summary and the end of its checkpoint.
    let _ = std::fs::remove_file(folder.join(CHECKPOINT));
    let folder = folder.display();
    match word {
        "complete" => format!("the run in {folder} is complete: there is nothing to resume"),
        word => format!("the run in {folder} {word}: it would end the same way again"),
    }
}
