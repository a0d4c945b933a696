//! Signals: by formula, or from a file.

use std::sync::Arc;

use super::Resolver;
use crate::record;
use crate::scene::{History, SignalScene};
use crate::words;
use teeter_integrator::{Formula, SignalError};

/// A formula, or what is wrong with its numbers.
type Made = Result<Formula, SignalError>;

impl Resolver<'_, '_> {
    pub(super) fn signal(&mut self, name: &str) -> Option<SignalScene> {
        let path = format!("signal.{name}");
        let history = match self.choice(&format!("{path}.shape"))? {
            words::History::Table => History::Table(Arc::new(self.table(&path)?)),
            words::History::Constant => self.formula(&path, Self::constant)?,
            words::History::Ramp => self.formula(&path, |this, path| this.lasting(path, Formula::ramp))?,
            words::History::HalfSine => self.formula(&path, |this, path| this.lasting(path, Formula::half_sine))?,
            words::History::Ricker => self.formula(&path, Self::ricker)?,
            words::History::Harmonic => self.formula(&path, |this, path| this.waving(path, Formula::harmonic))?,
            words::History::OneSine => self.formula(&path, |this, path| this.waving(path, Formula::one_sine))?,
        };
        Some(SignalScene { name: name.to_owned(), history })
    }

    fn constant(&mut self, path: &str) -> Option<Made> {
        Some(Formula::constant(self.quantity(&format!("{path}.start"))?))
    }

    fn lasting(&mut self, path: &str, of: fn(f64, f64) -> Made) -> Option<Made> {
        let at = |key: &str| format!("{path}.{key}");
        let (start, duration) = (self.quantity(&at("start")), self.quantity(&at("duration")));
        Some(of(start?, duration?))
    }

    fn ricker(&mut self, path: &str) -> Option<Made> {
        let (peak, frequency) = (self.quantity(&format!("{path}.peak")), self.frequency(path));
        Some(Formula::ricker(peak?, frequency?))
    }

    fn waving(&mut self, path: &str, of: fn(f64, f64, f64) -> Made) -> Option<Made> {
        let at = |key: &str| format!("{path}.{key}");
        let (start, phase) = (self.quantity(&at("start")), self.quantity(&at("phase")));
        let frequency = self.frequency(path);
        let (start, phase, frequency) = (start?, phase?, frequency?);
        Some(of(start, frequency, phase))
    }

    fn formula(&mut self, path: &str, make: impl Fn(&mut Self, &str) -> Option<Made>) -> Option<History> {
        let at = |key: &str| format!("{path}.{key}");
        match make(self, path)? {
            Ok(formula) => Some(History::Formula(formula)),
            Err(SignalError::Value { what: "the phase", .. }) => {
                self.error(&at("phase"), "must be at least 0 deg and less than 360 deg", "an angle such as \"20 deg\"");
                None
            }
            Err(error) => {
                self.error(path, error.to_string(), "check the numbers of this signal");
                None
            }
        }
    }

    /// Given as such, or by the period.
    fn frequency(&mut self, path: &str) -> Option<f64> {
        let at = |key: &str| format!("{path}.{key}");
        let doc = self.doc;
        let given = |key: &str| doc.has(&at(key)) || doc.is_refused(&at(key));
        match (given("frequency"), given("period")) {
            (true, true) => {
                self.error(&at("period"), "frequency and period say the same", "keep one of them");
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

    fn table(&mut self, path: &str) -> Option<teeter_integrator::Table> {
        let (key, start) = (format!("{path}.file"), self.quantity(&format!("{path}.start")));
        let file = self.word(&key)?;
        let bytes = match self.file(&file) {
            Ok(bytes) => bytes,
            Err(why) => {
                self.error(&key, why, "paths are relative to the scene's file");
                return None;
            }
        };
        match record::read(&bytes, start?) {
            Ok(table) => Some(table),
            Err(why) => {
                let remedy = "two columns, t in s and value, one row for each time, later and later";
                self.error(&key, why, remedy);
                None
            }
        }
    }

    /// A table that is over before the run, or begins after it, and is not zero there: what is
    /// assumed is said.
    pub(super) fn covered(&mut self, signals: &[Option<SignalScene>], end: f64) {
        for signal in signals.iter().flatten() {
            let History::Table(table) = &signal.history else { continue };
            let [(first, before), (last, after)] = table.ends();
            let path = format!("signal.{}.file", signal.name);
            let mut warn = |rule: String, remedy: &str| {
                self.warnings.push(self.doc.error(&path, rule, remedy).as_warning());
            };
            if last < end * (1.0 - 1e-9) && after != 0.0 {
                let rule = format!(
                    "the table ends at {last} s, the run lasts {end} s: its last value, {after}, is kept from there on"
                );
                warn(rule, "add rows up to the end of the run; a last value of 0 needs none");
            }
            if first > 0.0 && before != 0.0 {
                let rule = format!("the table begins at {first} s: up to there its first value, {before}, is taken");
                warn(rule, "add rows from 0 s on; a first value of 0 needs none");
            }
        }
    }
}
