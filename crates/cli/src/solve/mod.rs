//! `teeter solve`: runs solvers on contact problems from files, and measures time and residual.

mod figure;
mod inputs;
mod machine;
mod measure;
mod profile;
mod rows;

use crate::console::{Console, print_all};
use crate::progress::SolveBar;
use crate::run::Exit;
use inputs::{Choice, Input};
use measure::Measured;
use rows::{Row, RowColumns};
use std::path::{Path, PathBuf};
use std::time::Duration;
use teeter_fclib::FclibProblem;
use teeter_report::{Results, ResultsError};
use teeter_scenario::dimension::Dimension;
use teeter_scenario::quantity;
use teeter_solvers::SolverInfo;

#[derive(Debug)]
pub(crate) struct Options {
    pub(crate) paths: Vec<PathBuf>,
    pub(crate) solvers: Vec<String>,
    pub(crate) tolerance: f64,
    pub(crate) time_limit: Duration,
    pub(crate) json: bool,
    pub(crate) solutions: Option<PathBuf>,
    pub(crate) profile: Option<PathBuf>,
    /// Of the profiles, m.
    pub(crate) figure_width: f64,
    pub(crate) force: bool,
}

/// A tolerance of the command line.
pub(crate) fn tolerance(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("write a number greater than 0, such as 1e-10".to_owned()),
    }
}

/// A time of the command line, with its unit.
pub(crate) fn time(text: &str) -> Result<Duration, String> {
    let seconds = quantity::parse(text, Dimension::TIME).map_err(|error| error.to_string())?;
    match Duration::try_from_secs_f64(seconds) {
        Ok(time) if !time.is_zero() => Ok(time),
        _ => Err("write a time greater than 0, such as \"10 s\"".to_owned()),
    }
}

pub(crate) fn solve(options: &Options) -> Exit {
    let console = Console::new(false);
    let (inputs, choice) = match prepare(options) {
        Ok(settled) => settled,
        Err(text) => {
            console.error(&text);
            return Exit::BadInput;
        }
    };
    match solve_all(console, options, &inputs, &choice) {
        Ok(()) => Exit::FinishedRun,
        Err(text) => {
            console.error(&text);
            Exit::Failed
        }
    }
}

/// Finds all errors of the user's input, before anything runs or is written.
fn prepare(options: &Options) -> Result<(Vec<Input>, Choice), String> {
    let mut paths = options.paths.clone();
    let choice = inputs::choose(&options.solvers, &mut paths)?;
    if paths.is_empty() {
        return Err("error: no problem is given; name FCLIB files (*.hdf5) or a folder of them".to_owned());
    }
    let inputs = inputs::read(&inputs::files(&paths)?)?;
    inputs::check_dimensions(&choice, &inputs)?;
    let folder = options.solutions.as_ref().or(options.profile.as_ref());
    if let Some(folder) = folder {
        let files = match options.solutions {
            Some(_) => {
                inputs::check_stems(&inputs)?;
                solution_files(&inputs, &choice)
            }
            None => profile::files(),
        };
        take_folder(folder, &files, &inputs, options.force)?;
    }
    Ok((inputs, choice))
}

/// Creates a folder where these files can be written; existing files are replaced only with
/// `--force`, and inputs never.
fn take_folder(folder: &Path, files: &[String], inputs: &[Input], force: bool) -> Result<(), String> {
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let inputs: Vec<PathBuf> = inputs.iter().map(|input| PathBuf::from(&input.file)).collect();
    let told = |error: ResultsError| format!("error: {error}");
    Results::spares(&files, folder, &inputs).map_err(told)?;
    let old = Results::replaced(&files, folder, force).map_err(told)?;
    std::fs::create_dir_all(folder).map_err(|error| format!("error: {}: {error}", folder.display()))?;
    for path in old {
        std::fs::remove_file(&path).map_err(|error| format!("error: {}: {error}", path.display()))?;
    }
    Ok(())
}

fn solution_files(inputs: &[Input], choice: &Choice) -> Vec<String> {
    let of = |input: &Input| choice.of_dimension(input.problem.dimension());
    inputs.iter().flat_map(|input| of(input).into_iter().map(|info| solution_file(&input.stem, info.name))).collect()
}

fn solution_file(stem: &str, solver: &str) -> String {
    format!("{stem}.{solver}.csv")
}

fn solve_all(console: Console, options: &Options, inputs: &[Input], choice: &Choice) -> Result<(), String> {
    let one = [options.tolerance];
    let tolerances: &[f64] = if options.profile.is_some() { &profile::TOLERANCES } else { &one };
    let mut rows = Vec::new();
    let mut table = options.profile.as_deref().map(profile::ProfileTable::create).transpose()?;
    let columns = RowColumns::new(inputs, tolerances.len() > 1);
    let taken = |input: &Input| -> (Vec<&SolverInfo>, Vec<&SolverInfo>) {
        choice.of_dimension(input.problem.dimension()).into_iter().partition(|info| choice.can_solve(info, input))
    };
    let count: usize = inputs.iter().map(|input| taken(input).0.len()).sum();
    let progress = SolveBar::new(console, (count * tolerances.len()) as u64);
    if !options.json {
        progress.print(&columns.header())?;
    }
    for input in inputs {
        let (solvers, left_out) = taken(input);
        for info in left_out {
            progress.tell(&format!("note: {}: `{}` is left out: {}", input.file, info.name, too_many(info, input)));
        }
        for info in solvers {
            for &tolerance in tolerances {
                let row = row(input, info, tolerance, options.time_limit)?;
                if let Some(text) = &row.measured.complaint {
                    progress.tell(&format!("warning: {}: {text}", row.file));
                }
                progress.print(&if options.json { row.json() } else { columns.row(&row) })?;
                if let Some(folder) = &options.solutions {
                    write_solution(folder, &input.stem, &row)?;
                }
                progress.step();
                if let Some(table) = &mut table {
                    table.write(&row.csv())?;
                    rows.push(row);
                }
            }
        }
    }
    drop(progress);
    if let Some(folder) = &options.profile {
        profile::write(folder, &rows, options.time_limit, 1e3 * options.figure_width)?;
        console.note(&format!("profile in {}", folder.join("profile.md").display()));
    }
    Ok(())
}

/// Why a solver doesn't support a problem.
fn too_many(info: &SolverInfo, input: &Input) -> String {
    let most = info.most_contacts.unwrap_or(usize::MAX);
    format!("it takes up to {most} contacts, and the problem has {}", input.problem.contacts())
}

fn row(input: &Input, info: &SolverInfo, tolerance: f64, limit: Duration) -> Result<Row, String> {
    let measured = match &input.problem {
        FclibProblem::Plane(local) => {
            let mut solver = teeter_solvers::plane_solver(info.name).ok_or_else(|| no_solver(info, 2))?;
            let problem = local.problem().map_err(|error| format!("error: {}: {error}", input.file))?;
            measure::measure(solver.as_mut(), &problem, tolerance, limit)
        }
        FclibProblem::Space(local) => {
            let mut solver = teeter_solvers::space_solver(info.name).ok_or_else(|| no_solver(info, 3))?;
            let problem = local.problem().map_err(|error| format!("error: {}: {error}", input.file))?;
            measure::measure(solver.as_mut(), &problem, tolerance, limit)
        }
    };
    let mut measured = measured;
    if info.most_contacts.is_some_and(|most| input.problem.contacts() > most) {
        measured.complaint = Some(format!("`{}` breaks down: {}", info.name, too_many(info, input)));
    }
    Ok(Row {
        file: input.file.clone(),
        solver: info.name,
        dimension: input.problem.dimension(),
        contacts: input.problem.contacts(),
        tolerance,
        asymmetry: input.asymmetry,
        measured,
    })
}

/// The catalogue lists a solver that this build doesn't have, as it needs a feature.
fn no_solver(info: &SolverInfo, dimension: usize) -> String {
    format!("error: this build has no solver `{}` for {dimension}D problems", info.name)
}

fn write_solution(folder: &Path, stem: &str, row: &Row) -> Result<(), String> {
    let Measured { impulses, .. } = &row.measured;
    // The fewest digits that give the same double.
    let text: String = impulses.iter().map(|p| format!("{p:?}\n")).collect();
    let path = folder.join(solution_file(stem, row.solver));
    std::fs::write(&path, text).map_err(|error| format!("error: {}: {error}", path.display()))
}

/// `teeter solvers`.
pub(crate) fn list() -> Exit {
    let width = |of: fn(&SolverInfo) -> usize| teeter_solvers::SOLVERS.iter().map(of).max().unwrap_or(0);
    let (name, summary) = (width(|info| info.name.len()).max(4), width(|info| info.summary.chars().count()));
    let mut text = format!("{:name$}  dim    law     {:summary$}  reference\n", "name", "what it does");
    for info in teeter_solvers::SOLVERS {
        let dimensions: Vec<_> = info.dimensions.iter().map(|d| format!("{d}D")).collect();
        let law = match info.law {
            teeter_contact::Law::Exact => "exact",
            teeter_contact::Law::Convex => "convex",
        };
        let line = format!(
            "{:name$}  {:5}  {law:6}  {:summary$}  {}",
            info.name,
            dimensions.join(" "),
            info.summary,
            info.reference
        );
        text.push_str(line.trim_end());
        text.push('\n');
    }
    print_all(&text)
}
