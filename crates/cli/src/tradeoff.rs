//! `teeter tradeoff`.

use crate::console::{Console, print};
use crate::interrupt;
use crate::progress::PhaseBar;
use crate::render::{Presenter, refusal};
use crate::run::Exit;
use crate::scene;
use std::error::Error;
use std::path::{Path, PathBuf};
use teeter_report::{Reserved, Results};
use teeter_run::{LoadError, SceneSource};
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;
use teeter_study::{Failure, StudyScene, Tradeoff, runner, write};

#[derive(Debug)]
pub(crate) struct Options {
    pub(crate) scene: PathBuf,
    /// Folder of the files that the scene names, if it is another than by default.
    pub(crate) base: Option<PathBuf>,
    pub(crate) out: Option<PathBuf>,
    pub(crate) set: Vec<(String, String)>,
    /// Width of the figures, m.
    pub(crate) figure_width: f64,
    pub(crate) quiet: bool,
    pub(crate) force: bool,
}

pub(crate) fn tradeoff(options: &Options) -> Exit {
    let console = Console::new(options.quiet);
    let bad_input = |text: &str| {
        console.error(text);
        Exit::BadInput
    };
    let (scene, source, resolved) = match load(options) {
        Ok(loaded) => loaded,
        Err(error) => return bad_input(&refusal(&error)),
    };
    let presenter = Presenter::new(resolved.document.source());
    if resolved.scene.time.accuracy.is_some() {
        let rule = "a study varies the step of the scene, so it needs one";
        let found =
            resolved.document.error("time.accuracy", rule, "give a step instead, such as --set time.step=\"100 us\"");
        return bad_input(&presenter.one(&found));
    }
    if let Err(error) = Simulation::new(&resolved.scene) {
        return bad_input(&presenter.one(&error.diagnostic(&resolved.document)));
    }
    let folder = options.out.clone().unwrap_or_else(|| Path::new("runs").join(format!("{}-tradeoff", scene.stem())));
    // An earlier study stays until there is a new one; the folder is locked from now on.
    let free = Results::spares(&write::FILES, &folder, &scene.inputs(&resolved))
        .and_then(|()| Results::reserve(&write::FILES, &folder, options.force));
    let reserved = match free {
        Ok(reserved) => reserved,
        Err(error) => return bad_input(&format!("error: {error}")),
    };
    for warning in resolved.warnings.iter().chain(&resolved.foreseen) {
        console.note(&presenter.one(warning));
    }
    let cancel = interrupt::listen();
    let progress = PhaseBar::new(console);
    let study = Tradeoff::of(&source, &resolved, runner::cores(), cancel, &mut |phase, done, of| {
        progress.at(phase, done, of);
    });
    drop(progress);
    match study {
        Ok(study) => match write_all(&study, reserved, &resolved, &scene, options) {
            Ok(()) => {
                console.note(&format!("results in {0}, report in {0}/tradeoff.html", folder.display()));
                Exit::FinishedRun
            }
            Err(error) => {
                console.error(&format!("error: {error}"));
                Exit::Failed
            }
        },
        Err(Failure::Interrupted) => {
            console.note("interrupted: there is no advice before everything is compared, and nothing was written");
            Exit::Interrupted
        }
        Err(failure) => {
            console.error(&format!("error: the scene has no reference: {failure}"));
            Exit::Failed
        }
    }
}

/// The scene named on the command line: its source, for the study, and resolved.
fn load(options: &Options) -> Result<(SceneSource, StudyScene, Resolved), LoadError> {
    let scene = scene::source(&options.scene, options.base.as_deref())?;
    let bytes = scene.read()?.into_owned();
    let text = String::from_utf8(bytes.clone()).unwrap_or_default();
    let (source, resolved) = StudyScene::new(bytes, scene.name(), scene.stem(), &options.set, &mut scene.companions())
        .map_err(|found| LoadError::Invalid { text, found })?;
    Ok((scene, source, resolved))
}

/// What names the scene on a command line; one from standard input is the one that was written.
fn words_of(options: &Options, folder: &Path) -> Vec<String> {
    if options.scene == Path::new("-") {
        return vec![folder.join("scene.toml").display().to_string()];
    }
    let base = options.base.iter().flat_map(|base| ["--base".to_owned(), base.display().to_string()]);
    std::iter::once(options.scene.display().to_string()).chain(base).collect()
}

/// Writes the files, and the sentences to standard output.
fn write_all(
    study: &Tradeoff,
    reserved: Reserved,
    resolved: &Resolved,
    scene: &SceneSource,
    options: &Options,
) -> Result<(), Box<dyn Error>> {
    let results = reserved.create()?;
    let file = |file: &str| scene.seen_from(results.folder(), file);
    results.write("scene.toml", resolved.document.to_toml_elsewhere(file))?;
    results.write("tradeoff.csv", write::csv(study))?;
    for (name, svg) in write::figures(study, 1e3 * options.figure_width)? {
        results.write(&format!("figures/{name}"), svg)?;
    }
    let words = words_of(options, results.folder());
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    results.write("tradeoff.html", write::page(study, &words)?)?;
    results.write("tradeoff.json", write::json(study))?;
    let findings = write::findings(study);
    let lines = write::advice(study).into_iter().chain(findings.iter().map(|line| format!("  {line}")));
    let text: String = lines.map(|line| format!("{line}\n")).collect();
    Ok(print(&text)?)
}
