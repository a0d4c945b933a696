//! `teeter sweep`.

use crate::console::{Console, print};
use crate::interrupt;
use crate::progress::CaseBar;
use crate::render::Presenter;
use crate::run::Exit;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::error::Error;
use std::io::ErrorKind;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use teeter_report::Results;
use teeter_run::{LoadError, SceneSource};
use teeter_scenario::diagnostic::Diagnostics;
use teeter_study::sweep::{
    COARSE_ROWS, Ensemble, FIGURE_FILES, FILES, IDENTITY, JOURNAL, Journal, JournalError, RESULTS, Shard, Sweep,
    SweepIdentity, Tally, counted, ended_study, incomparable, matching_files, merge, run_cases, study_figures,
    study_page, write_parquet, write_results,
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
    /// Width of the figures, m.
    pub(crate) figure_width: f64,
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
    let exit = run(console, &study, &results, journal, options.jobs);
    // Of a shard they would be of a part of the cases.
    if exit == Exit::FinishedRun && study.sweep.wants_figures() && shard == Shard::ALL {
        return draw(console, &results, study.identity.title(), options.figure_width);
    }
    exit
}

/// Makes the figures of a study that has ended.
fn draw(console: Console, results: &Results, title: &str, figure_width: f64) -> Exit {
    let drawn = || -> Result<(), Box<dyn Error>> {
        let study = ended_study(results.folder(), "")?;
        write_figures(console, results, title, &[study], figure_width)
    };
    match drawn() {
        Ok(()) => {
            console.note(&format!("figures in {}", results.folder().join("study.html").display()));
            Exit::FinishedRun
        }
        Err(error) => {
            console.error(&format!("error: the figures can't be made: {error}"));
            Exit::Failed
        }
    }
}

/// Writes the figures of studies, their tables and their page, and prints their notes.
fn write_figures(
    console: Console,
    results: &Results,
    title: &str,
    studies: &[Ensemble],
    figure_width: f64,
) -> Result<(), Box<dyn Error>> {
    let figures = study_figures(studies)?;
    for figure in &figures {
        for (name, svg) in figure.svgs(1e3 * figure_width) {
            results.write(&name, svg)?;
        }
        for (name, table) in &figure.tables {
            results.write(name, table)?;
        }
    }
    results.write("study.html", study_page(title, studies, &figures))?;
    if console.is_quiet() {
        return Ok(());
    }
    let notes: String = figures.iter().flat_map(|figure| &figure.notes).map(|note| format!("{note}\n")).collect();
    Ok(print(&notes)?)
}

/// Puts the figures of studies side by side.
pub(crate) fn compare(folders: &[PathBuf], out: &Path, figure_width: f64, force: bool, quiet: bool) -> Exit {
    let console = Console::new(quiet);
    let refused = |text: String| {
        console.error(&text);
        Exit::BadInput
    };
    let studies: Result<Vec<Ensemble>, JournalError> =
        folders.iter().zip(distinct_names(folders)).map(|(folder, name)| ended_study(folder, &name)).collect();
    let studies = match studies {
        Ok(studies) => studies,
        Err(error) => return refused(format!("error: {error}")),
    };
    match study_figures(&studies) {
        Ok(figures) if figures.is_empty() => {
            let help = "give all of them [fragility], [distribution] or [bands]";
            return refused(format!("error: the sweep files ask for no figure in common\n  help: {help}"));
        }
        Ok(_) => {}
        Err(error) => return refused(format!("error: {error}")),
    }
    if let Some(why) = incomparable(&studies) {
        let help = "compare studies that ask for the same quantities";
        return refused(format!("error: the figures can't be put side by side: {why}\n  help: {help}"));
    }
    let results = match Results::create_of(&FIGURE_FILES, out, force) {
        Ok(results) => results,
        Err(error) => return refused(format!("error: {error}")),
    };
    let title = studies.iter().map(|study| study.name.as_str()).collect::<Vec<_>>().join(" and ");
    match write_figures(console, &results, &title, &studies, figure_width) {
        Ok(()) => {
            console.note(&format!("figures in {}", out.join("study.html").display()));
            Exit::FinishedRun
        }
        Err(error) => {
            console.error(&format!("error: {error}"));
            Exit::Failed
        }
    }
}

/// The names of folders, each with as many of the folders above it as tell it from the others.
fn distinct_names(folders: &[PathBuf]) -> Vec<String> {
    let real: Vec<PathBuf> =
        folders.iter().map(|folder| folder.canonicalize().unwrap_or_else(|_| folder.clone())).collect();
    let parts = |folder: &Path, count: usize| {
        let all: Vec<_> = folder.iter().collect();
        all[all.len().saturating_sub(count)..].iter().collect::<PathBuf>().display().to_string()
    };
    let name = |folder: &PathBuf| {
        let others = || real.iter().filter(|other| *other != folder);
        let is_distinct = |count: &usize| others().all(|other| parts(other, *count) != parts(folder, *count));
        // A folder that stands there twice is the same study.
        let count = (1..=folder.iter().count()).find(is_distinct).unwrap_or(1);
        parts(folder, count)
    };
    real.iter().map(name).collect()
}

/// Takes the folder: of a study that continues with its rows.
fn open(study: &Study, folder: &Path, options: &Options) -> Result<(Results, Journal), JournalError> {
    Results::spares(&FILES, folder, &study.inputs)?;
    let has = |file: &str| folder.join(file).exists();
    if options.resume && !has(IDENTITY) && (has(JOURNAL) || has(RESULTS)) {
        return Err(JournalError::NoIdentity(folder.to_owned()));
    }
    if options.resume && has(IDENTITY) {
        let results = Results::reopen_of(&FILES, folder)?;
        if let Some(journal) = Journal::reopen(&results, &study.identity, &study.sweep)? {
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
    let missing = journal.missing(shard.spread(study.sweep.cases()));
    if journal.rejected() > 0 {
        let (lines, are) = if journal.rejected() == 1 { ("line", "was") } else { ("lines", "were") };
        console.note(&format!(
            "warning: {} {lines} of the journal {are} removed, being no whole row of this study; their cases run again",
            journal.rejected()
        ));
    }
    if before > 0 {
        console.note(&format!("{before} of {} {} done", counted(total), if before == 1 { "is" } else { "are" }));
    }
    let bar = CaseBar::new(console, before, total);
    let mut failure = None;
    let threads = jobs.unwrap_or_else(runner::cores);
    run_cases(&study.sweep, &study.source, missing, threads, cancel, |row| {
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
        let (done, of) = (journal.done(), counted(total));
        let are = if done == 1 { "is" } else { "are" };
        console.note(&format!("interrupted: {done} of {of} {are} done; continue with --resume"));
        return Exit::Interrupted;
    }
    // Of all rows, those of sessions before this one as well.
    let written = write_results(results, &study.sweep, shard)
        .and_then(|()| write_parquet(results, &study.sweep))
        .and_then(|()| Tally::of(results.folder(), &study.sweep));
    match written {
        // A mistake that concerns all cases is told in quiet runs, too.
        Ok(tally) if tally.incomplete == tally.cases && shard == Shard::ALL => {
            let none = if total == 1 {
                "the only case has no result".to_owned()
            } else {
                format!("none of {total} cases has a result; the first one")
            };
            console.error(&format!("warning: {none}: {}", tally.first_error));
        }
        Ok(tally) => notes(console, &study.sweep, &tally),
        Err(error) => {
            console.error(&format!("error: {error}"));
            return Exit::Failed;
        }
    }
    console.note(&format!("{} in {}", counted(total), results.folder().join(RESULTS).display()));
    Exit::FinishedRun
}

/// How many outputs a warning names.
const MOST_NAMED: usize = 3;

/// What the user should know of the rows.
fn notes(console: Console, sweep: &Sweep, tally: &Tally) {
    let Tally { cases, incomplete, unsolved, several_limits, empty, .. } = tally;
    let have = |count: u64| if count == 1 { "case has" } else { "cases have" };
    if *incomplete > 0 {
        console.note(&format!("{incomplete} {} no result: see the columns `status` and `error`", have(*incomplete)));
    }
    if *unsolved > 0 {
        let text = "steps that were not solved to tolerance: see `unsolved_steps`";
        console.note(&format!("{unsolved} {} {text}", have(*unsolved)));
    }
    if tally.warned > 0 {
        let warn = if tally.warned == 1 { "warns" } else { "warn" };
        let codes: Vec<String> = tally.warnings.iter().map(|(code, count)| format!("{code} ({count})")).collect();
        let see = "see the column `warnings`; `teeter run` of such a case tells more";
        let of = counted(*cases);
        console.note(&format!("warning: {} of {of} {warn}: {}; {see}", tally.warned, codes.join(", ")));
    }
    if tally.warnings.iter().any(|(code, _)| code == COARSE_ROWS) {
        let of_columns: Vec<String> = sweep
            .outputs()
            .iter()
            .filter(|output| output.is_between_rows())
            .take(MOST_NAMED)
            .map(|output| format!("`{}`", output.name()))
            .collect();
        console.note(&format!(
            "warning: {COARSE_ROWS}: between two rows of trajectory.csv, outputs such as {} may be off by more than 1 % of the largest value: \
             `at` is interpolated linearly there, and what is larger than in both rows is missed; make `output.every` shorter",
            of_columns.join(", ")
        ));
    }
    if *several_limits > 0 {
        let text = "there are several limits: the lowest one seen is in the table, their number in `find.changes`";
        console.note(&format!("in {several_limits} of {} {text}", counted(*cases)));
    } else if sweep.bisects_blindly() && cases > incomplete {
        console.note("a bisection sees one limit of several: `scan` under [find] also runs values in between");
    }
    for output in
        sweep.outputs().iter().filter(|output| cases > incomplete && empty.iter().any(|name| name == output.name()))
    {
        console.note(&format!("warning: `{}` is empty in all cases: {}", output.name(), why_empty(output)));
    }
}

fn why_empty(output: &teeter_study::sweep::Output) -> String {
    match (output.summary_path(), output.column()) {
        (Some(path), _) => format!("summary.json has no value at {path}"),
        (None, Some(column)) => match output.time() {
            Some(t) => format!("trajectory.csv has no row at t = {t} s or later, or no column {column}"),
            None => format!("trajectory.csv has no column {column}"),
        },
        (None, None) => match output.spectrum_of() {
            Some("") => "the scene has no record".to_owned(),
            Some(of) => format!("the scene has no record at {of}, such as ground.motion.x"),
            None => "there is no such value".to_owned(),
        },
    }
}

/// Puts the folders of all shards together.
pub(crate) fn merge_shards(folders: &[PathBuf], out: &Path, figure_width: f64, force: bool, quiet: bool) -> Exit {
    let console = Console::new(quiet);
    let replaced =
        |folder: &&PathBuf| Results::spares(&FILES, out, &[folder.join(RESULTS), folder.join(IDENTITY)]).is_err();
    if let Some(shard) = folders.iter().find(replaced) {
        console.error(&format!(
            "error: {} is one of the shards and stays as it is; give --out another folder",
            shard.display()
        ));
        return Exit::BadInput;
    }
    let merged = || -> Result<(bool, Results, String), JournalError> {
        let mut shards = merge(folders)?;
        let results = Results::create_of(&FILES, out, force)?;
        shards.write(&results)?;
        Ok((shards.sweep().wants_figures(), results, shards.title().to_owned()))
    };
    match merged() {
        Ok((figures, results, title)) => {
            console.note(&format!("results in {}", out.join(RESULTS).display()));
            if figures { draw(console, &results, &title, figure_width) } else { Exit::FinishedRun }
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
    let text = std::fs::read_to_string(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => format!("error: {name}: there is no such file"),
        ErrorKind::IsADirectory => format!("error: {name}: is a folder, not a file"),
        ErrorKind::InvalidData => format!("error: {name}: not a text file in UTF-8"),
        _ => format!("error: {name}: {error}"),
    })?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let matches = RefCell::new(BTreeMap::new());
    let listed = |scene: &str, pattern: &str| {
        let scene = folder.join(scene);
        let files = matching_files(&folder, scene.parent().unwrap_or(&folder), pattern)?;
        matches.borrow_mut().insert(pattern.to_owned(), files.clone());
        Ok(files)
    };
    let present = |found: &Diagnostics| Presenter::new(&text).all(found);
    let sweep = Sweep::read(&text, &name, &listed).map_err(|found| present(&found))?;
    let scene = SceneSource::file(folder.join(sweep.scene()));
    let unreadable = |error: LoadError| present(&Sweep::unreadable_scene(&text, &name, &error.to_string()));
    let bytes = scene.read().map_err(unreadable)?.into_owned();
    let scene_text = String::from_utf8_lossy(&bytes).into_owned();
    let mut companions = scene.companions();
    let settings = sweep.settings_with_files();
    let source = StudyScene::with_files_of(bytes, scene.name(), scene.stem(), settings, &mut companions);
    sweep.check_keys(&source, &text, &name).map_err(|found| present(&found))?;
    sweep.check_scene(&source).map_err(|found| Presenter::new(&scene_text).all(&found))?;
    sweep.check_outputs(&source, &text, &name).map_err(|found| present(&found))?;
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let identity = SweepIdentity::new(&text, source.contents(), sweep.cases(), shard)
        .reading(source.named_contents())
        .matching(matches.take())
        .titled(&stem);
    let named = source.files().map(|file| scene.place(file));
    let inputs = [path.to_owned(), folder.join(sweep.scene())].into_iter().chain(named).collect();
    Ok(Study { sweep, source, identity, inputs })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_the_same_name_are_told_apart() {
        let names = |folders: &[&str]| distinct_names(&folders.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(names(&["a/s", "b/s", "c/t"]), ["a/s", "b/s", "t"]);
        assert_eq!(names(&["x/a/s", "y/a/s", "b/s"]), ["x/a/s", "y/a/s", "b/s"]);
        assert_eq!(names(&["a/s", "a/s"]), ["s", "s"]);
    }
}
