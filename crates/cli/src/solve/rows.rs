//! The rows of `teeter solve`: as text, JSON and CSV.

use super::inputs::Input;
use super::measure::Measured;
use serde_json::Value;

/// The result of a solver on a file at a tolerance.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) file: String,
    pub(super) solver: &'static str,
    pub(super) dimension: usize,
    pub(super) contacts: usize,
    pub(super) tolerance: f64,
    pub(super) asymmetry: f64,
    pub(super) measured: Measured,
}

/// Asymmetry below this is rounding, and not shown.
const ASYMMETRIC: f64 = 1e-12;

impl Row {
    /// Whether it is solved: the solver reports convergence, and the residual is within the
    /// tolerance.
    pub(super) fn solved(&self) -> bool {
        self.measured.outcome == "converged"
    }

    /// A line with a JSON object; its names are a stable interface.
    pub(super) fn json(&self) -> String {
        let text = |text: &str| Value::from(text).to_string();
        // A number that JSON can't represent is null.
        let number = |x: f64| Value::from(x).to_string();
        let m = &self.measured;
        format!(
            "{{\"file\":{},\"solver\":{},\"used\":{},\"dimension\":{},\"contacts\":{},\"tolerance\":{},\"outcome\":{},\
             \"residual\":{},\"iterations\":{},\"time_ms\":{}}}\n",
            text(&self.file),
            text(self.solver),
            text(m.used),
            self.dimension,
            self.contacts,
            number(self.tolerance),
            text(m.outcome),
            number(m.residual),
            m.iterations,
            number(m.time_ms)
        )
    }

    /// A row of a CSV table with the header [`CSV_HEADER`].
    pub(super) fn csv(&self) -> String {
        let quoted = if self.file.contains([',', '"', '\n']) {
            format!("\"{}\"", self.file.replace('"', "\"\""))
        } else {
            self.file.clone()
        };
        let m = &self.measured;
        format!(
            "{quoted},{},{},{},{},{:e},{},{:e},{},{},{:e}\n",
            self.solver,
            m.used,
            self.dimension,
            self.contacts,
            self.tolerance,
            m.outcome,
            m.residual,
            m.iterations,
            m.time_ms,
            self.asymmetry
        )
    }
}

pub(super) const CSV_HEADER: &str =
    "file,solver,used,dimension,contacts,tolerance,outcome,residual,iterations,time_ms,asymmetry\n";

/// The text table; rows can be printed one by one, as all widths are known in advance.
#[derive(Debug)]
pub(super) struct RowColumns {
    file: usize,
    tolerance: bool,
    asymmetry: bool,
}

/// Largest width of the table, in columns of a terminal.
const WIDTH: usize = 100;

/// Width of the other columns with the gaps between them: solver, contacts, outcome, residual,
/// iterations, time.
const OTHERS: usize = 2 + 18 + 2 + 8 + 2 + 14 + 2 + 8 + 2 + 6 + 2 + 8;

/// Least width of the names of files: they are cut to that, if anything must.
const SHORTEST_FILE: usize = 12;

/// Width of an optional column, tolerance or asymmetry, with the gap before it: powers of ten.
const OPTIONAL: usize = 2 + 5;

impl RowColumns {
    pub(super) fn new(inputs: &[Input], several_tolerances: bool) -> Self {
        let asymmetry = inputs.iter().any(|input| input.asymmetry > ASYMMETRIC);
        let widest = inputs.iter().map(|input| input.file.chars().count()).max().unwrap_or(0);
        Self::of_width(widest, several_tolerances, asymmetry)
    }

    fn of_width(widest: usize, tolerance: bool, asymmetry: bool) -> Self {
        let optional = OPTIONAL * (usize::from(tolerance) + usize::from(asymmetry));
        let room = WIDTH.saturating_sub(OTHERS + optional).max(SHORTEST_FILE);
        Self { file: widest.max("file".len()).min(room), tolerance, asymmetry }
    }

    pub(super) fn header(&self) -> String {
        let tolerance = self.tolerance.then_some("tol.");
        let asymmetry = self.asymmetry.then_some("asym.");
        self.line(["file", "solver", "contacts", "outcome", "residual", "iter.", "time"], tolerance, asymmetry)
    }

    pub(super) fn row(&self, row: &Row) -> String {
        let m = &row.measured;
        // A chain of solvers, with the one that it took.
        let solver = if m.used == row.solver { row.solver.to_owned() } else { format!("{}: {}", row.solver, m.used) };
        let contacts = format!("{} {}D", row.contacts, row.dimension);
        // One word a column, for what reads columns.
        let (residual, iterations, time) =
            (format!("{:.1e}", m.residual), m.iterations.to_string(), in_its_unit(m.time_ms).replace(' ', ""));
        let tolerance = self.tolerance.then(|| format!("{:e}", row.tolerance));
        let asymmetry = self.asymmetry.then(|| match row.asymmetry {
            some if some > ASYMMETRIC => format!("{some:.0e}"),
            _ => String::new(),
        });
        self.line(
            [&self.shortened(&row.file), &solver, &contacts, m.outcome, &residual, &iterations, &time],
            tolerance.as_deref(),
            asymmetry.as_deref(),
        )
    }

    /// The end of a file's name, where it is too long: it is what tells files apart.
    fn shortened(&self, file: &str) -> String {
        let length = file.chars().count();
        if length <= self.file {
            return file.to_owned();
        }
        let rest: String = file.chars().skip(length + 1 - self.file).collect();
        format!("…{rest}")
    }

    fn line(&self, cells: [&str; 7], tolerance: Option<&str>, asymmetry: Option<&str>) -> String {
        let [file, solver, contacts, outcome, residual, iterations, time] = cells;
        let width = self.file;
        let tolerance = tolerance.map(|text| format!("  {text:>5}")).unwrap_or_default();
        let asymmetry = asymmetry.map(|text| format!("  {text:>5}")).unwrap_or_default();
        let line = format!(
            "{file:width$}  {solver:18}  {contacts:>8}{tolerance}  {outcome:14}  {residual:>8}  {iterations:>6}  \
             {time:>8}{asymmetry}"
        );
        format!("{}\n", line.trim_end())
    }
}

/// A time, ms, with three significant digits in the unit that suits it.
pub(super) fn in_its_unit(ms: f64) -> String {
    if ms.is_finite() { teeter_scenario::readable::with_digits(1e-3 * ms, "s", 3) } else { "–".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_fits_a_terminal_and_shows_the_ends_of_long_names() {
        let measured = Measured {
            outcome: "max-iterations",
            used: "acary-cadoux",
            residual: 1.25e-100,
            iterations: 100_000,
            time_ms: 0.000_123,
            impulses: Vec::new(),
            complaint: None,
        };
        let file = "benches/problems/scenarios/two-blocks-on-beam/two-blocks-on-beam-step000123.hdf5".to_owned();
        let row =
            Row { file, solver: "auto", dimension: 3, contacts: 1234, tolerance: 1e-10, asymmetry: 1e-9, measured };
        for (tolerance, asymmetry) in [(false, false), (true, false), (false, true), (true, true)] {
            let columns = RowColumns::of_width(row.file.chars().count(), tolerance, asymmetry);
            for line in [columns.header(), columns.row(&row)] {
                assert!(line.trim_end().chars().count() <= WIDTH, "{line}");
            }
            assert!(columns.row(&row).contains("000123.hdf5  auto: acary-cadoux   1234 3D"), "{}", columns.row(&row));
        }
        assert!(RowColumns::of_width(6, false, false).header().starts_with("file    solver"));
    }

    #[test]
    fn times_are_in_units_that_suit_them() {
        let shown = [1234.5, 12.345, 0.12345, 0.00012345, 0.0, f64::NAN].map(in_its_unit);
        assert_eq!(shown, ["1.23 s", "12.3 ms", "123 µs", "123 ns", "0 s", "–"]);
    }
}
