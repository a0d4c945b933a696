//! Resolves signals: by formula, or from a file.

use std::sync::Arc;

use super::Resolver;
use super::shared::TableKeys;
use crate::scene::{History, SignalScene};
use crate::signal_table;
use crate::words;
use teeter_integrator::{Chirp, Formula, Growth, SignalError, Table};

/// A formula, or what is wrong with its numbers.
type FormulaResult = Result<Formula, SignalError>;

impl Resolver<'_, '_> {
    /// The factor of a signal. It has no default in the table of keys, so that scenes as run say no
    /// more than before.
    pub(super) fn scale(&mut self, name: &str) -> Option<f64> {
        let path = format!("signal.{name}.scale");
        if self.doc.has(&path) { self.number(&path) } else { Some(1.0) }
    }

    pub(super) fn signal(&mut self, name: &str) -> Option<SignalScene> {
        let path = format!("signal.{name}");
        let history = match self.choice(&format!("{path}.shape"))? {
            words::History::Table => History::Table(self.table(&path)?),
            words::History::Constant => self.formula(&path, Self::constant)?,
            words::History::Ramp => self.formula(&path, |this, path| this.with_duration(path, Formula::ramp))?,
            words::History::HalfSine => {
                self.formula(&path, |this, path| this.with_duration(path, Formula::half_sine))?
            }
            words::History::Ricker => self.formula(&path, Self::ricker)?,
            words::History::Chirp => self.chirp(&path)?,
            // Resolved after all others.
            words::History::Sum | words::History::Product => return None,
            words::History::Harmonic => {
                self.formula(&path, |this, path| this.with_frequency(path, Formula::harmonic))?
            }
            words::History::OneSine => {
                self.formula(&path, |this, path| this.with_frequency(path, Formula::one_sine))?
            }
        };
        Some(SignalScene { name: name.to_owned(), history, scale: self.scale(name)? })
    }

    fn chirp(&mut self, path: &str) -> Option<History> {
        let at = |key: &str| format!("{path}.{key}");
        let [start, duration, from, to, phase] =
            ["start", "duration", "from", "to", "phase"].map(|key| self.quantity(&at(key)));
        let growth = match self.choice(&at("growth"))? {
            words::Growth::Linear => Growth::Linear,
            words::Growth::Logarithmic => Growth::Logarithmic,
        };
        match Chirp::new(start?, duration?, [from?, to?], phase?, growth) {
            Ok(chirp) => Some(History::Chirp(chirp)),
            Err(error) => {
                self.error(&at("duration"), error.to_string(), "check its unit and those of from and to");
                None
            }
        }
    }

    fn constant(&mut self, path: &str) -> Option<FormulaResult> {
        Some(Formula::constant(self.quantity(&format!("{path}.start"))?))
    }

    fn with_duration(&mut self, path: &str, of: fn(f64, f64) -> FormulaResult) -> Option<FormulaResult> {
        let at = |key: &str| format!("{path}.{key}");
        let (start, duration) = (self.quantity(&at("start")), self.quantity(&at("duration")));
        Some(of(start?, duration?))
    }

    fn ricker(&mut self, path: &str) -> Option<FormulaResult> {
        let (peak, frequency) = (self.quantity(&format!("{path}.peak")), self.frequency(path));
        Some(Formula::ricker(peak?, frequency?))
    }

    fn with_frequency(&mut self, path: &str, of: fn(f64, f64, f64) -> FormulaResult) -> Option<FormulaResult> {
        let at = |key: &str| format!("{path}.{key}");
        let (start, phase) = (self.quantity(&at("start")), self.quantity(&at("phase")));
        let frequency = self.frequency(path);
        let (start, phase, frequency) = (start?, phase?, frequency?);
        Some(of(start, frequency, phase))
    }

    fn formula(&mut self, path: &str, make: impl Fn(&mut Self, &str) -> Option<FormulaResult>) -> Option<History> {
        let at = |key: &str| format!("{path}.{key}");
        match make(self, path)? {
            Ok(formula) => Some(History::Formula(formula)),
            Err(SignalError::Value { what: "the phase", .. }) => {
                self.error(
                    &at("phase"),
                    "must be at least 0 deg and less than 360 deg",
                    "give an angle such as \"20 deg\"",
                );
                None
            }
            Err(error) => {
                self.error(path, error.to_string(), "check the values of this signal");
                None
            }
        }
    }

    /// The frequency, given directly or by the period.
    fn frequency(&mut self, path: &str) -> Option<f64> {
        let at = |key: &str| format!("{path}.{key}");
        let doc = self.doc;
        let given = |key: &str| doc.has(&at(key)) || doc.is_refused(&at(key));
        match (given("frequency"), given("period")) {
            (true, true) => {
                self.error(&at("period"), "frequency and period are equivalent", "keep one of them");
                None
            }
            (true, false) => doc.quantity(&at("frequency")),
            (false, true) => doc.quantity(&at("period")).map(f64::recip),
            (false, false) => {
                self.error(path, "neither frequency nor period is given", "add one, such as frequency = \"2 Hz\"");
                None
            }
        }
    }

    fn table(&mut self, path: &str) -> Option<Arc<Table>> {
        let at = |key: &str| format!("{path}.{key}");
        let doc = self.doc;
        let start = self.quantity(&at("start"));
        let file = self.word(&at("file"));
        let given = |key: &str| doc.is_given(&at(key)) || doc.is_refused(&at(key));
        let unit: Option<words::TimeUnit> =
            if given("time_unit") { Some(self.choice(&at("time_unit"))?) } else { None };
        if let Some(key) = ["columns", "time_unit"].into_iter().find(|key| given("step") && given(key)) {
            self.error(&at(key), "with step the file has one column, of values alone", "leave out this key or step");
            return None;
        }
        let (start, file) = (start?, file?);
        let Some(shared) = self.shared else { return self.read_table(path, start, &file, unit).map(Arc::new) };
        let text = |key: &str| doc.text(&at(key)).map(str::to_owned);
        let keys = TableKeys {
            file,
            start: start.to_bits(),
            step: doc.quantity(&at("step")).map(f64::to_bits),
            columns: doc.text_pair(&at("columns")).map(|pair| pair.map(str::to_owned)),
            time_unit: text("time_unit"),
            outside: text("outside"),
        };
        shared.table(&keys, || self.read_table(path, start, &keys.file, unit))
    }

    /// The table in a file.
    fn read_table(&mut self, path: &str, start: f64, file: &str, unit: Option<words::TimeUnit>) -> Option<Table> {
        let at = |key: &str| format!("{path}.{key}");
        let doc = self.doc;
        let given = |key: &str| doc.is_given(&at(key)) || doc.is_refused(&at(key));
        let bytes = match self.file(file) {
            Ok(bytes) => bytes,
            Err(why) => {
                self.error(&at("file"), why, "paths are relative to the scene's file");
                return None;
            }
        };
        let read = match doc.quantity(&at("step")) {
            Some(step) => signal_table::of_values(&bytes, start, step),
            None if given("step") => return None,
            None => {
                let unit = unit.and_then(|unit| Some((doc.text(&at("time_unit"))?, unit.per_second())));
                signal_table::of_columns(&bytes, start, doc.text_pair(&at("columns")), unit)
            }
        };
        match read {
            Ok(table) => Some(match self.choice(&at("outside"))? {
                words::Outside::Hold => table,
                words::Outside::Zero => table.zero_outside(),
            }),
            Err(why) if given("step") => {
                let remedy = "give one column of values, with one row for each step";
                self.error(&at("file"), why, remedy);
                None
            }
            Err(why) => {
                let remedy = "give two columns, t in s and value, with one row for each time, in ascending order";
                self.error(&at("file"), why, remedy);
                None
            }
        }
    }

    /// Warns of a table that ends before the run, or begins after its start, with a nonzero value:
    /// that value is kept.
    pub(super) fn check_table_covers_run(&mut self, signals: &[Option<SignalScene>], end: f64) {
        for signal in signals.iter().flatten() {
            let History::Table(table) = &signal.history else { continue };
            if table.is_zero_outside() {
                continue;
            }
            let [(first, before), (last, after)] = table.ends();
            let path = format!("signal.{}.file", signal.name);
            let mut warn = |rule: String, remedy: &str| {
                self.warnings.push(self.doc.error(&path, rule, remedy).as_warning());
            };
            if last < end * (1.0 - 1e-9) && after != 0.0 {
                let rule = format!(
                    "the table ends at {last} s, but the run at {end} s: its last value, {after}, is kept until then"
                );
                warn(rule, "add rows up to the end of the run, or let the last value be 0");
            }
            if first > 0.0 && before != 0.0 {
                let rule = format!("the table begins at {first} s: its first value, {before}, is used before that");
                warn(rule, "add rows from 0 s on, or let the first value be 0");
            }
        }
    }
}

impl words::TimeUnit {
    /// How many make a second.
    const fn per_second(self) -> f64 {
        match self {
            Self::Second => 1.0,
            Self::Millisecond => 1e3,
            Self::Microsecond => 1e6,
            Self::Minute => 1.0 / 60.0,
        }
    }
}
