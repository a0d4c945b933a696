//! `teeter fit`.

use crate::console::{Console, print};
use crate::interrupt;
use crate::measured::MeasuredOptions;
use crate::progress::PhaseBar;
use crate::render::{Presenter, refusal};
use crate::run::Exit;
use crate::scene;
use std::error::Error;
use std::path::{Path, PathBuf};
use teeter_report::{Reserved, Results};
use teeter_run::{LoadError, SceneSource};
use teeter_scenario::diagnostic::{Diagnostic, Diagnostics};
use teeter_scenario::keys::{self, PathTarget};
use teeter_scenario::resolve::Resolved;
use teeter_study::fit::{self, FILES, Fit, FitError, FitKey, FitSettings};
use teeter_study::{Setting, StudyScene, runner};

#[derive(Debug)]
pub(crate) struct Options {
    pub(crate) scene: PathBuf,
    pub(crate) base: Option<PathBuf>,
    pub(crate) set: Vec<(String, String)>,
    pub(crate) measured: MeasuredOptions,
    pub(crate) vary: Vec<FitKey>,
    pub(crate) offset: Option<f64>,
    pub(crate) samples: Option<usize>,
    pub(crate) seed: u64,
    pub(crate) jobs: Option<usize>,
    pub(crate) out: Option<PathBuf>,
    /// Width of the figures, m.
    pub(crate) figure_width: f64,
    pub(crate) quiet: bool,
    pub(crate) force: bool,
}

/// A scene that is ready to be fitted.
struct Loaded {
    scene: SceneSource,
    source: StudyScene,
    resolved: Resolved,
}

pub(crate) fn fit(options: &Options) -> Exit {
    let console = Console::new(options.quiet);
    let bad_input = |text: &str| {
        console.error(text);
        Exit::BadInput
    };
    let loaded = match load(options) {
        Ok(loaded) => loaded,
        Err(text) => return bad_input(&text),
    };
    let Loaded { scene, source, resolved } = &loaded;
    let (number, block) = match block(resolved, options.measured.block.as_deref()) {
        Ok(found) => found,
        Err(why) => return bad_input(&format!("error: {}: {why}", scene.name())),
    };
    let measured = match options.measured.read(&block) {
        Ok(measured) => measured,
        Err(text) => return bad_input(&text),
    };
    options.measured.tell_unread(&measured, console);
    let folder = options.out.clone().unwrap_or_else(|| Path::new("runs").join(format!("{}-fit", scene.stem())));
    let inputs: Vec<PathBuf> = scene.inputs(resolved).into_iter().chain(options.measured.inputs()).collect();
    let reserved =
        Results::spares(&FILES, &folder, &inputs).and_then(|()| Results::reserve(&FILES, &folder, options.force));
    let reserved = match reserved {
        Ok(reserved) => reserved,
        Err(error) => return bad_input(&format!("error: {error}")),
    };
    let settings = FitSettings {
        alignment: options.measured.alignment(),
        offset: options.offset,
        window: options.measured.window,
        samples: options.samples,
        seed: options.seed,
        threads: options.jobs.unwrap_or_else(runner::cores),
    };
    let cancel = interrupt::listen();
    let progress = PhaseBar::new(console);
    let fitted =
        Fit::of(source, resolved, number, &measured, &options.vary, &settings, cancel, &mut |phase, done, of| {
            progress.at(phase, done, of);
        });
    drop(progress);
    let fitted = match fitted {
        Ok(fitted) => fitted,
        Err(FitError::Interrupted) => {
            console.note("interrupted: nothing was written");
            return Exit::Interrupted;
        }
        Err(error) => {
            console.error(&format!("error: {error}"));
            return if matches!(error, FitError::Constant(_)) { Exit::BadInput } else { Exit::Failed };
        }
    };
    match write_all(&fitted, reserved, &loaded, options, &block) {
        Ok(()) => {
            console.note(&format!(
                "results in {0}, report in {0}/fit.html, fitted scene in {0}/scene.toml",
                folder.display()
            ));
            Exit::FinishedRun
        }
        Err(error) => {
            console.error(&format!("error: {error}"));
            Exit::Failed
        }
    }
}

/// Reads the scene and checks the keys; the text is the error to print.
fn load(options: &Options) -> Result<Loaded, String> {
    let scene = scene::source(&options.scene, options.base.as_deref()).map_err(|error| refusal(&error))?;
    let bytes = scene.read().map_err(|error| refusal(&error))?.into_owned();
    let text = String::from_utf8(bytes.clone()).unwrap_or_default();
    let invalid = |found: Diagnostics| refusal(&LoadError::Invalid { text: text.clone(), found });
    let (source, resolved) =
        StudyScene::new(bytes, scene.name(), scene.stem(), &options.set, &mut scene.companions()).map_err(invalid)?;
    if resolved.scene.time.accuracy.is_some() {
        let rule = "a fit runs the scene with one step";
        let found =
            resolved.document.error("time.accuracy", rule, "give a step instead, such as --set time.step=\"100 us\"");
        return Err(Presenter::new(resolved.document.source()).one(&found));
    }
    for (place, key) in options.vary.iter().enumerate() {
        if options.vary[..place].iter().any(|other| other.key() == key.key()) {
            return Err(format!("error: --vary: {} varies twice", key.key()));
        }
        // Both bounds have to be values of the key; rules between keys may refuse one of them.
        let (low, high) = key.bounds();
        let mut wrong = Vec::new();
        for bound in [low, high] {
            let Err(found) = source.load(&Setting::none().set(key.key(), key.text(bound))) else { continue };
            let about = found.iter().find(|found| found.set.as_ref().is_some_and(|set| set.starts_with(key.key())));
            wrong.extend(about.cloned());
        }
        let is_key = matches!(keys::find(key.key()), Some(PathTarget::Key(..)));
        if wrong.len() == 2 || (wrong.len() == 1 && is_key) {
            // Found in a bound that was set, but the user wrote both.
            let finding: Diagnostic = wrong.swap_remove(0);
            let finding = Diagnostic { set: Some(key.typed().to_owned()), option: "--vary", ..finding };
            return Err(Presenter::new(&text).one(&finding));
        }
    }
    Ok(Loaded { scene, source, resolved })
}

/// The block that was measured: its number and name.
fn block(resolved: &Resolved, wanted: Option<&str>) -> Result<(usize, String), String> {
    let names: Vec<&str> = resolved.scene.blocks.iter().map(|block| block.name.as_str()).collect();
    let known = || names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    match (wanted, names.as_slice()) {
        (_, []) => Err("the scene has no block".to_owned()),
        (None, [block]) => Ok((0, (*block).to_owned())),
        (None, _) => {
            Err(format!("the scene has several blocks, {}: say which one was measured, with --block NAME", known()))
        }
        (Some(wanted), names) => match names.iter().position(|name| *name == wanted) {
            Some(number) => Ok((number, wanted.to_owned())),
            None => Err(format!("no block `{wanted}`; the scene has {}", known())),
        },
    }
}

/// Writes the files, and the sentences to standard output.
fn write_all(
    fitted: &Fit,
    reserved: Reserved,
    loaded: &Loaded,
    options: &Options,
    block: &str,
) -> Result<(), Box<dyn Error>> {
    let Loaded { scene, source, resolved } = loaded;
    let measured = options.measured.measured.display().to_string();
    let names = [scene.name(), measured.as_str(), block];
    let with_fit = source.load(&fitted.setting).map_err(|found| found.to_string())?;
    let figures = fit::figures(fitted, 1e3 * options.figure_width)?;
    let page = fit::page(fitted, &resolved.scene.title, names)?;
    let results = reserved.create()?;
    let file = |file: &str| scene.seen_from(results.folder(), file);
    results.write("scene.toml", with_fit.document.to_toml_elsewhere(file))?;
    results.write("fit.csv", fit::csv(fitted))?;
    for (name, svg) in figures {
        results.write(&format!("figures/{name}"), svg)?;
    }
    results.write("fit.html", page)?;
    results.write("fit.json", fit::json(fitted, names[0], names[1], names[2]))?;
    let text: String = fit::sentences(fitted).into_iter().map(|line| format!("{line}\n")).collect();
    Ok(print(&text)?)
}
