//! `teeter sweep`.

use crate::console::Console;
use crate::interrupt;
use crate::progress::CaseBar;
use crate::render::{Presenter, refusal};
use crate::run::Exit;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use teeter_report::Results;
use teeter_run::SceneSource;
use teeter_scenario::diagnostic::Diagnostics;
use teeter_study::sweep::{
    FILES, IDENTITY, Journal, JournalError, RESULTS, Shard, Sweep, SweepIdentity, matching_files, merge, run_cases,
    write_results,
};
use teeter_study::{StudyScene, runner};

#[derive(Debug)]
pub(crate) struct Options {
    pub(crate) sweep: PathBuf,
    pub(crate) out: Option<PathBuf>,
    pub(crate) jobs: Option<usize>,
    pub(crate) shard: Option<Shard>,
    pub(crate) resume: bool,
    pub(crate) force: bool,
    pub(crate) quiet: bool,
}

/// A study that is ready to run.
struct Study {
    sweep: Sweep,
    source: StudyScene,
    identity: SweepIdentity,
    /// The files that it reads.
    inputs: Vec<PathBuf>,
}

pub(crate) fn sweep(options: &Options) -> Exit {
    let console = Console::new(options.quiet);
    let refused = |text: String| {
        console.error(&text);
        Exit::BadInput
    };
    let shard = options.shard.unwrap_or(Shard::ALL);
    let study = match prepare(&options.sweep, shard) {
        Ok(study) => study,
        Err(text) => return refused(text),
    };
    let stem = options.sweep.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let part = options.shard.map(|shard| format!("-{}-of-{}", shard.number(), shard.of())).unwrap_or_default();
    let folder = options.out.clone().unwrap_or_else(|| Path::new("runs").join(format!("{stem}{part}")));
    let (results, journal) = match open(&study, &folder, options) {
        Ok(opened) => opened,
        Err(error) => return refused(format!("error: {error}")),
    };
    run(console, &study, &results, journal, options.jobs)
}

/// Takes the folder: of a study that continues with its rows.
fn open(study: &Study, folder: &Path, options: &Options) -> Result<(Results, Journal), JournalError> {
    Results::spares(&FILES, folder, &study.inputs)?;
    if options.resume && folder.join(IDENTITY).exists() {
        let results = Results::reopen_of(&FILES, folder)?;
        if let Some(journal) = Journal::reopen(folder, &study.identity, &study.sweep)? {
            return Ok((results, journal));
        }
    }
    let results = Results::create_of(&FILES, folder, options.force)?;
    let journal = Journal::create(&results, &study.identity, &study.sweep)?;
    Ok((results, journal))
}

fn run(console: Console, study: &Study, results: &Results, mut journal: Journal, jobs: Option<usize>) -> Exit {
    let cancel = interrupt::listen();
    let shard = study.identity.shard();
    let (before, total) = (journal.done(), shard.count(study.sweep.cases()));
    let missing = journal.missing(shard.cases(study.sweep.cases()));
    if before > 0 {
        console.note(&format!("{before} of {total} cases are done"));
    }
    let bar = CaseBar::new(console, before, total);
    let (mut incomplete, mut unsolved, mut failure) = (0_u64, 0_u64, None);
    let mut empty = vec![true; study.sweep.outputs().len()];
    let threads = jobs.unwrap_or_else(runner::cores);
    run_cases(&study.sweep, &study.source, missing, threads, cancel, |row| {
        incomplete += u64::from(!row.status.is_complete());
        unsolved += u64::from(row.unsolved_steps > 0);
        empty.iter_mut().zip(&row.outputs).for_each(|(empty, cell)| *empty &= cell.is_empty());
        if let Err(error) = journal.add(row.number, &row.line(&study.sweep)) {
            failure = Some(error);
            return ControlFlow::Break(());
        }
        bar.step();
        ControlFlow::Continue(())
    });
    drop(bar);
    if let Some(error) = failure {
        console.error(&format!("error: {error}\n  help: make room, and continue with --resume"));
        return Exit::Failed;
    }
    if journal.done() < total {
        console.note(&format!("interrupted: {} of {total} cases are done; continue with --resume", journal.done()));
        return Exit::Interrupted;
    }
    if let Err(error) = write_results(results, &study.sweep) {
        console.error(&format!("error: {error}"));
        return Exit::Failed;
    }
    if incomplete > 0 {
        let have = if incomplete == 1 { "case has" } else { "cases have" };
        console.note(&format!("{incomplete} {have} no result: see the columns `status` and `error`"));
    }
    if unsolved > 0 {
        let have = if unsolved == 1 { "case has" } else { "cases have" };
        console.note(&format!("{unsolved} {have} steps that were not solved to tolerance: see `unsolved_steps`"));
    }
    let ran = journal.done() - before > incomplete;
    for (output, _) in study.sweep.outputs().iter().zip(&empty).filter(|(_, empty)| **empty && ran) {
        console.note(&format!("warning: `{}` is empty in all cases: {}", output.name(), why_empty(output)));
    }
    console.note(&format!("{total} cases in {}", results.folder().join(RESULTS).display()));
    Exit::FinishedRun
}

fn why_empty(output: &teeter_study::sweep::Output) -> String {
    match (output.summary_path(), output.column()) {
        (Some(path), _) => format!("summary.json has no value at {path}"),
        (None, Some(column)) => format!("trajectory.csv has no column {column}, or no row at that time"),
        (None, None) => "there is no such value".to_owned(),
    }
}

/// Puts the folders of all shards together.
pub(crate) fn merge_shards(folders: &[PathBuf], out: &Path, force: bool, quiet: bool) -> Exit {
    let console = Console::new(quiet);
    let merged = || -> Result<(), JournalError> {
        let (table, identity) = merge(folders)?;
        let results = Results::create_of(&FILES, out, force)?;
        results.write(IDENTITY, identity)?;
        Ok(results.write(RESULTS, table)?)
    };
    match merged() {
        Ok(()) => {
            console.note(&format!("results in {}", out.join(RESULTS).display()));
            Exit::FinishedRun
        }
        Err(error) => {
            console.error(&format!("error: {error}"));
            Exit::BadInput
        }
    }
}

/// Reads the sweep file and its scene; the text is the error to print.
fn prepare(path: &Path, shard: Shard) -> Result<Study, String> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|error| format!("error: {name}: {error}"))?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let listed = |scene: &str, pattern: &str| {
        let scene = folder.join(scene);
        matching_files(&folder, scene.parent().unwrap_or(&folder), pattern)
    };
    let present = |found: &Diagnostics| Presenter::new(&text).all(found);
    let sweep = Sweep::read(&text, &name, &listed).map_err(|found| present(&found))?;
    let scene = SceneSource::file(folder.join(sweep.scene()));
    let bytes = scene.read().map_err(|error| refusal(&error))?.into_owned();
    let mut companions = scene.companions();
    let settings = sweep.settings_with_files();
    let source = StudyScene::with_files_of(bytes, scene.name(), scene.stem(), settings, &mut companions);
    sweep.check_keys(&source, &name).map_err(|found| present(&found))?;
    let identity = SweepIdentity::new(&text, source.contents(), sweep.cases(), shard);
    let named = source.files().map(|file| scene.place(file));
    let inputs = [path.to_owned(), folder.join(sweep.scene())].into_iter().chain(named).collect();
    Ok(Study { sweep, source, identity, inputs })
}
