//! `teeter solve --profile`: a table, performance profiles, and a page about the measurement.
//!
//! A performance profile (Dolan and Moré 2002, doi 10.1007/s101070100263) shows, for each solver,
//! the fraction of the problems that it solves within τ times the time of the best solver for each
//! problem. At τ = 1 this is how often a solver is the fastest, at the right end how many problems
//! it solves at all.

use super::figure::{self, Curve};
use super::machine;
use super::rows::{CSV_HEADER, Row, in_its_unit};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// The compared tolerances.
pub(super) const TOLERANCES: [f64; 3] = [1e-4, 1e-8, 1e-12];

/// Comparison of solvers on the problems of a dimension at a tolerance.
struct SolverComparison<'a> {
    dimension: usize,
    tolerance: f64,
    solvers: Vec<&'static str>,
    files: Vec<&'a str>,
    /// Time of each file (outer) and solver, if solved.
    times: Vec<Vec<Option<f64>>>,
}

impl<'a> SolverComparison<'a> {
    fn new(rows: &'a [Row], dimension: usize, tolerance: f64) -> Self {
        let mut contest = Self { dimension, tolerance, solvers: Vec::new(), files: Vec::new(), times: Vec::new() };
        let ours = || rows.iter().filter(|row| row.dimension == dimension && row.tolerance == tolerance);
        for row in ours() {
            if !contest.solvers.contains(&row.solver) {
                contest.solvers.push(row.solver);
            }
            if contest.files.last() != Some(&row.file.as_str()) {
                contest.files.push(&row.file);
            }
        }
        for file in &contest.files {
            let time = |solver: &&str| {
                let row = ours().find(|row| row.file == *file && row.solver == *solver);
                row.filter(|row| row.solved()).map(|row| row.measured.time_ms)
            };
            contest.times.push(contest.solvers.iter().map(time).collect());
        }
        contest
    }

    /// A solver's times relative to the best solver of each problem that it solved, ascending.
    fn ratios(&self, solver: usize) -> Vec<f64> {
        let mut ratios: Vec<f64> = self
            .times
            .iter()
            .filter_map(|times| {
                let best = times.iter().flatten().copied().fold(f64::INFINITY, f64::min);
                times[solver].map(|time| time / best)
            })
            .collect();
        ratios.sort_unstable_by(f64::total_cmp);
        ratios
    }

    fn solved(&self, solver: usize) -> usize {
        self.times.iter().filter(|times| times[solver].is_some()).count()
    }

    /// Geometric mean of a solver's times over the files selected by `counts`; `None` if there are
    /// none.
    fn mean(&self, solver: usize, counts: impl Fn(&[Option<f64>]) -> bool) -> Option<f64> {
        let logs: Vec<f64> =
            self.times.iter().filter(|times| counts(times)).filter_map(|times| times[solver]).map(f64::ln).collect();
        (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
    }

    fn figure_name(&self) -> String {
        figure_name(self.dimension, self.tolerance)
    }

    fn figure(&self, width: f64) -> Result<String, String> {
        let all = self.files.len() as f64;
        let curves: Vec<Curve> = self
            .solvers
            .iter()
            .enumerate()
            .map(|(k, solver)| Curve {
                name: format!("{solver} ({} of {})", self.solved(k), self.files.len()),
                steps: self.ratios(k).iter().enumerate().map(|(i, &ratio)| (ratio, (i + 1) as f64 / all)).collect(),
            })
            .collect();
        let title = format!("{}D, tolerance {:e}: {} problems", self.dimension, self.tolerance, self.files.len());
        figure::profile(&title, &curves, width)
    }

    fn section(&self, page: &mut String) {
        let _ = writeln!(page, "\n## {}D, tolerance {:e}\n", self.dimension, self.tolerance);
        let _ = writeln!(page, "| solver | solved | fastest | time of those it solved | time of those all solved |");
        let _ = writeln!(page, "|---|---|---|---|---|");
        // Solvers that solve nothing are excluded, as there would be no common problems.
        let able: Vec<usize> = (0..self.solvers.len()).filter(|&k| self.solved(k) > 0).collect();
        let by_all = |times: &[Option<f64>]| able.iter().all(|&k| times[k].is_some());
        let shown = |mean: Option<f64>| mean.map_or("–".to_owned(), in_its_unit);
        for (k, solver) in self.solvers.iter().enumerate() {
            let fastest = self.ratios(k).iter().filter(|&&ratio| ratio == 1.0).count();
            let (own, common) = (shown(self.mean(k, |_| true)), shown(self.mean(k, by_all)));
            let solved = self.solved(k);
            let _ = writeln!(page, "| {solver} | {solved} / {} | {fastest} | {own} | {common} |", self.files.len());
        }
        let common = self.times.iter().filter(|times| by_all(times)).count();
        let total = self.files.len();
        let _ =
            writeln!(page, "\nTimes are geometric means. Solved by all solvers that solve any: {common} of {total}.");
        let unsolved: Vec<_> =
            self.files.iter().zip(&self.times).filter(|(_, times)| times.iter().all(Option::is_none)).collect();
        if !unsolved.is_empty() {
            let names: Vec<_> = unsolved.iter().map(|(file, _)| format!("`{file}`")).collect();
            let _ = writeln!(page, "Solved by none: {}.", names.join(", "));
        }
        let _ = writeln!(page, "\n![Performance profile]({})", self.figure_name());
    }
}

/// `table.csv`, written row by row, so that an interrupted comparison leaves its results.
pub(super) struct ProfileTable {
    path: PathBuf,
    file: File,
}

impl ProfileTable {
    pub(super) fn create(folder: &Path) -> Result<Self, String> {
        let path = folder.join("table.csv");
        let file = File::create(&path).map_err(|error| format!("error: {}: {error}", path.display()))?;
        let mut table = Self { path, file };
        table.write(CSV_HEADER)?;
        Ok(table)
    }

    pub(super) fn write(&mut self, text: &str) -> Result<(), String> {
        self.file.write_all(text.as_bytes()).map_err(|error| format!("error: {}: {error}", self.path.display()))
    }
}

/// All files that a comparison may write.
pub(super) fn files() -> Vec<String> {
    let figures =
        [2, 3].into_iter().flat_map(|dimension| TOLERANCES.map(|tolerance| figure_name(dimension, tolerance)));
    ["table.csv", "profile.md"].map(str::to_owned).into_iter().chain(figures).collect()
}

fn figure_name(dimension: usize, tolerance: f64) -> String {
    format!("profile-{dimension}d-{}.svg", power(tolerance))
}

/// Writes profile.md and the figures, of a width in mm.
pub(super) fn write(folder: &Path, rows: &[Row], limit: std::time::Duration, width: f64) -> Result<(), String> {
    let put = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|error| format!("error: {}: {error}", path.display()))
    };
    let mut page = heading(rows, limit);
    let dimensions: BTreeSet<usize> = rows.iter().map(|row| row.dimension).collect();
    for dimension in dimensions {
        for tolerance in TOLERANCES {
            let contest = SolverComparison::new(rows, dimension, tolerance);
            contest.section(&mut page);
            put(&contest.figure_name(), &contest.figure(width)?)?;
        }
    }
    put("profile.md", &page)
}

fn heading(rows: &[Row], limit: std::time::Duration) -> String {
    let files: BTreeSet<&str> = rows.iter().map(|row| row.file.as_str()).collect();
    format!(
        "# Contact solvers compared\n\n\
         {} problems, each solved from p = 0. Solved: the solver reports convergence, and the residual is within the tolerance.\n\
         Times are of the solver alone (after reading the problem and allocating memory), medians of repetitions if one solve takes under 0.1 s.\n\
         Each solve has a limit of {} s, after which it counts as not solved. All numbers: [table.csv](table.csv).\n\n\
         | | |\n|---|---|\n\
         | date | {} |\n| command | `{}` |\n| teeter | {} |\n| rustc | {} |\n| processor | {} |\n| cores | {} |\n| system | {} |\n",
        files.len(),
        limit.as_secs_f64(),
        machine::date(),
        machine::command(),
        env!("CARGO_PKG_VERSION"),
        env!("TEETER_RUSTC"),
        machine::processor(),
        machine::cores(),
        std::env::consts::OS.to_owned() + " " + std::env::consts::ARCH,
    )
}

/// A power of ten as in names of files: 1e-04.
fn power(tolerance: f64) -> String {
    format!("1e-{:02}", -tolerance.log10().round() as i32)
}

#[cfg(test)]
mod tests {
    use super::super::measure::Measured;
    use super::*;

    fn row(file: &str, solver: &'static str, outcome: &'static str, time_ms: f64) -> Row {
        let measured = Measured {
            used: solver,
            outcome,
            residual: 0.0,
            iterations: 1,
            time_ms,
            impulses: Vec::new(),
            complaint: None,
        };
        Row { file: file.to_owned(), solver, dimension: 2, contacts: 1, tolerance: 1e-8, asymmetry: 0.0, measured }
    }

    #[test]
    fn a_profile_counts_what_is_solved_within_a_multiple_of_the_best_time() {
        let rows = [
            row("a", "x", "converged", 1.0),
            row("a", "y", "converged", 4.0),
            row("b", "x", "stalled", 0.1),
            row("b", "y", "converged", 2.0),
            row("c", "x", "time-limit", 9.0),
            row("c", "y", "breakdown", 0.1),
        ];
        let contest = SolverComparison::new(&rows, 2, 1e-8);
        // A failure is no time to beat, and counts in the whole all the same.
        assert_eq!((contest.ratios(0), contest.ratios(1)), (vec![1.0], vec![1.0, 4.0]));
        assert_eq!((contest.solved(0), contest.solved(1), contest.files.len()), (1, 2, 3));
        assert!((contest.mean(1, |_| true).unwrap() - 8.0_f64.sqrt()).abs() < 1e-14);
        let mut page = String::new();
        contest.section(&mut page);
        assert!(page.contains("| x | 1 / 3 | 1 | 1 ms | 1 ms |"), "{page}");
        assert!(page.contains("| y | 2 / 3 | 1 | 2.83 ms | 4 ms |"), "{page}");
        assert!(page.contains("Solved by none: `c`"), "{page}");
    }
}
