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
    solver: usize,
    used: usize,
    tolerance: bool,
    asymmetry: bool,
}

impl RowColumns {
    pub(super) fn new(inputs: &[Input], several_tolerances: bool) -> Self {
        let widest = |names: &mut dyn Iterator<Item = usize>, title: &str| names.max().unwrap_or(0).max(title.len());
        let solver = widest(&mut teeter_solvers::SOLVERS.iter().map(|info| info.name.len()), "solver");
        Self {
            file: widest(&mut inputs.iter().map(|input| input.file.chars().count()), "file"),
            solver,
            // The method used by a chain is also a solver name.
            used: solver,
            tolerance: several_tolerances,
            asymmetry: inputs.iter().any(|input| input.asymmetry > ASYMMETRIC),
        }
    }

    pub(super) fn header(&self) -> String {
        let tolerance = self.tolerance.then_some("tolerance");
        let asymmetry = self.asymmetry.then_some("asymmetry");
        self.line(
            ["file", "solver", "used", "dim", "contacts", "outcome", "residual", "iterations", "time / ms"],
            tolerance,
            asymmetry,
        )
    }

    pub(super) fn row(&self, row: &Row) -> String {
        let m = &row.measured;
        let [dimension, contacts] = [row.dimension, row.contacts].map(|n| n.to_string());
        let (residual, iterations, time) =
            (format!("{:.1e}", m.residual), m.iterations.to_string(), significant(m.time_ms));
        let tolerance = self.tolerance.then(|| format!("{:e}", row.tolerance));
        let asymmetry = self.asymmetry.then(|| match row.asymmetry {
            some if some > ASYMMETRIC => format!("{some:.1e}"),
            _ => String::new(),
        });
        self.line(
            [&row.file, row.solver, m.used, &dimension, &contacts, m.outcome, &residual, &iterations, &time],
            tolerance.as_deref(),
            asymmetry.as_deref(),
        )
    }

    fn line(&self, cells: [&str; 9], tolerance: Option<&str>, asymmetry: Option<&str>) -> String {
        let [file, solver, used, dimension, contacts, outcome, residual, iterations, time] = cells;
        let (a, b, c) = (self.file, self.solver, self.used);
        let tolerance = tolerance.map(|text| format!("  {text:>9}")).unwrap_or_default();
        let asymmetry = asymmetry.map(|text| format!("  {text:>9}")).unwrap_or_default();
        let line = format!(
            "{file:a$}  {solver:b$}  {used:c$}  {dimension:>3}  {contacts:>8}{tolerance}  {outcome:14}  {residual:>8}  \
             {iterations:>10}  {time:>9}{asymmetry}"
        );
        format!("{}\n", line.trim_end())
    }
}

/// A number with three significant digits.
pub(super) fn significant(x: f64) -> String {
    let decimals = if x > 0.0 && x.is_finite() { (2.0 - x.log10().floor()).clamp(0.0, 7.0) } else { 0.0 };
    format!("{x:.0$}", decimals as usize)
}

#[cfg(test)]
mod tests {
    use super::significant;

    #[test]
    fn times_show_three_digits() {
        let shown = [1234.5, 12.345, 0.12345, 0.00012345, 0.0, f64::NAN].map(significant);
        assert_eq!(shown, ["1234", "12.3", "0.123", "0.000123", "0", "NaN"]);
    }
}
