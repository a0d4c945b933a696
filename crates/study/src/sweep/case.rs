//! Runs the cases of a study.

use super::Sweep;
use super::find::Found;
use super::number::in_table;
use super::output::{Columns, Output, quoted};
use crate::{Failure, StudyScene, runner};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_report::{EndedWord, Recorder, Summary};

/// The code of the warning that rows are too far apart for an output.
pub const COARSE_ROWS: &str = "coarse-rows";

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CaseStatus {
    /// It ran; the word of its summary.
    Ran(EndedWord),
    /// The scene can't be run with its values.
    Refused,
    /// Its run broke off without a result.
    Failed,
    /// The limit that is searched isn't between the ends.
    NoLimit,
}

impl CaseStatus {
    /// The word in the table.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Ran(ended) => ended.word(),
            Self::Refused => "refused",
            Self::Failed => "failed",
            Self::NoLimit => "no-limit",
        }
    }

    /// Whether the case ran to its end.
    #[must_use]
    pub fn is_complete(self) -> bool {
        !matches!(
            self,
            Self::Refused | Self::Failed | Self::NoLimit | Self::Ran(EndedWord::Diverged | EndedWord::Unconverged)
        )
    }
}

/// A row of the results.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseRow {
    /// The case, from 0.
    pub number: u64,
    /// How it ended.
    pub status: CaseStatus,
    /// The limit that was searched.
    pub(crate) found: Option<Found>,
    /// The outputs, as texts; empty where a case has none.
    pub outputs: Vec<String>,
    /// Steps whose contact problem was not solved to tolerance.
    pub unsolved_steps: u64,
    /// The codes of the warnings about its scene and its run, each once.
    pub warnings: Vec<String>,
    /// Why it didn't come to its end, in one line.
    pub error: String,
}

impl CaseRow {
    /// The line of the table, with its end. Numbers are in SI units and read back to the same
    /// doubles.
    #[must_use]
    pub fn line(&self, sweep: &Sweep) -> String {
        let mut line = self.number.to_string();
        for (key, value) in sweep.case(self.number) {
            line.push(',');
            line.push_str(&quoted(&in_table(&key, &value)));
        }
        if let Some(find) = sweep.find() {
            for cell in self.found.as_ref().map(|found| found.cells(&find.key)).unwrap_or_default() {
                line.push(',');
                line.push_str(&quoted(&cell));
            }
        }
        for output in &self.outputs {
            line.push(',');
            line.push_str(output);
        }
        let Self { status, unsolved_steps, warnings, error, .. } = self;
        let warnings = warnings.join(" ");
        line.push_str(&format!(",{},{unsolved_steps},{},{}\n", status.word(), quoted(&warnings), quoted(error)));
        line
    }

    fn without_outputs(number: u64, sweep: &Sweep, status: CaseStatus, error: String) -> Self {
        let outputs = vec![String::new(); sweep.outputs().len()];
        Self { number, status, found: None, outputs, unsolved_steps: 0, warnings: Vec::new(), error }
    }

    /// How often the criterion of a search changed between the values scanned.
    #[must_use]
    pub fn changes(&self) -> u64 {
        self.found.as_ref().map_or(0, |found| found.changes)
    }
}

/// Runs cases on up to `threads` threads, in the order in which `cases` gives them, and hands each
/// row to `done` as it ends, one at a time. Once `cancel` is set none is started, and those that
/// run break off without a row. `done` returns whether to go on.
pub fn run_cases(
    sweep: &Sweep,
    source: &StudyScene,
    cases: impl Iterator<Item = u64> + Send,
    threads: usize,
    cancel: &Arc<AtomicBool>,
    mut done: impl FnMut(CaseRow) -> ControlFlow<()> + Send,
) {
    let work = |number: &u64| run_case(sweep, source, *number, cancel);
    runner::as_they_end(cases, threads, cancel, work, |_, row| row.map_or(ControlFlow::Continue(()), &mut done));
}

/// The row of a case; `None` if it was cancelled.
fn run_case(sweep: &Sweep, source: &StudyScene, number: u64, cancel: &Arc<AtomicBool>) -> Option<CaseRow> {
    let Some(find) = sweep.find() else { return run_once(sweep, source, number, None, cancel) };
    let column = find.until.column(sweep.outputs());
    let decides = sweep.outputs().iter().position(|output| Some(output.name()) == column);
    let (mut unsolved_steps, mut warnings) = (0, Vec::new());
    let searched = find.search(|value| {
        let Some(row) = run_once(sweep, source, number, Some(&value), cancel).map(Box::new) else { return Err(None) };
        unsolved_steps += row.unsolved_steps;
        for code in &row.warnings {
            if !warnings.contains(code) {
                warnings.push(code.clone());
            }
        }
        let at = |why: &str| Box::new(CaseRow { error: format!("at {value}: {why}"), ..CaseRow::clone(&row) });
        if !row.status.is_complete() {
            return Err(Some(at(&row.error)));
        }
        let cell = decides.and_then(|place| row.outputs.get(place));
        match cell.and_then(|cell| find.until.holds(cell, sweep.outputs())) {
            Some(holds) => Ok((holds, Some(row))),
            None => {
                let row = at("the output that decides has no value");
                Err(Some(Box::new(CaseRow { status: CaseStatus::Failed, ..*row })))
            }
        }
    });
    match searched {
        Ok((found, row)) => row.map(|row| {
            let (status, error) = match found.no_limit(find) {
                Some(why) => (CaseStatus::NoLimit, why),
                None => (row.status, row.error.clone()),
            };
            CaseRow { status, error, found: Some(found), unsolved_steps, warnings, ..*row }
        }),
        Err(row) => row.map(|row| {
            let outputs = vec![String::new(); row.outputs.len()];
            CaseRow { outputs, unsolved_steps, warnings, ..*row }
        }),
    }
}

/// The row of a run of a case, with this value of the key that is searched, if one is; `None` if it
/// was cancelled.
fn run_once(
    sweep: &Sweep,
    source: &StudyScene,
    number: u64,
    searched: Option<&str>,
    cancel: &Arc<AtomicBool>,
) -> Option<CaseRow> {
    let refused = |why: String| Some(CaseRow::without_outputs(number, sweep, CaseStatus::Refused, why));
    let failed = |why: String| Some(CaseRow::without_outputs(number, sweep, CaseStatus::Failed, why));
    let (scene, warned) = match source.scene_with_warnings(&sweep.setting(number, searched)) {
        Ok(found) => found,
        Err(found) => return refused(Failure::from(found).to_string()),
    };
    let mut simulation = match source.simulation(&scene) {
        Ok(simulation) => simulation,
        Err(error) => return refused(error.to_string()),
    };
    simulation.cancelled_by(Arc::clone(cancel));
    let layout = simulation.layout.clone();
    let wanted: Vec<&str> = sweep.outputs().iter().filter_map(Output::column).collect();
    let mut tell = |_: &str| {};
    let recorder = if wanted.is_empty() {
        Recorder::watching(&scene, &layout, &mut tell)
    } else {
        Recorder::in_memory(&scene, &layout, &mut tell)
    };
    let mut recorder = match recorder {
        Ok(recorder) => recorder.sharing(source.stances()),
        Err(error) => return failed(error.to_string()),
    };
    recorder.note(&warned);
    let ended = match simulation.run(&mut [&mut recorder]) {
        Ok(ended) => ended,
        Err(error) => return failed(error.to_string()),
    };
    let (header, rows) = if wanted.is_empty() { Default::default() } else { recorder.trajectory() };
    let columns = Columns::read(&header, rows, &wanted);
    let record = recorder.into_record();
    let state = &simulation.state;
    let word = record.ended(&ended);
    let error = match word {
        EndedWord::Interrupted => return None,
        EndedWord::Complete | EndedWord::Stopped => String::new(),
        _ => Failure::unless_complete(ended, state.t).err().map_or_else(String::new, |error| error.to_string()),
    };
    let summary = sweep.outputs().iter().any(Output::needs_summary).then(|| {
        let paths = sweep.outputs().iter().filter_map(Output::summary_path);
        let keys: Vec<&str> = paths.filter_map(|path| path.split('.').next()).collect();
        Summary::of_keys(&keys, &scene, &layout, state, &record, word, 0.0)
    });
    let outputs = sweep.outputs().iter().map(|output| output.cell(summary.as_ref(), &columns, &scene)).collect();
    // A scene may have several findings of one kind.
    let mut warnings: Vec<String> = Vec::new();
    for warning in Summary::warnings(&scene, state, &record) {
        if warnings.iter().all(|code| *code != warning.code) {
            warnings.push(warning.code.to_string());
        }
    }
    // Rows of all steps are as close as they can be.
    let is_thinned = (columns.rows() as u64) < state.step;
    if is_thinned && sweep.outputs().iter().any(|output| output.is_coarse(&columns)) {
        warnings.push(COARSE_ROWS.to_owned());
    }
    Some(CaseRow {
        number,
        status: CaseStatus::Ran(word),
        found: None,
        outputs,
        unsolved_steps: state.tally.unconverged_steps,
        warnings,
        error,
    })
}
