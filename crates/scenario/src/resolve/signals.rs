//! Resolves signals: by formula, or from a file.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Resolver;
use crate::number_table;
use crate::scene::{History, SignalScene};
use crate::words;
use teeter_integrator::{Chirp, Formula, Growth, SignalError};

/// A formula, or what is wrong with its numbers.
type FormulaResult = Result<Formula, SignalError>;

/// How deep sums may be nested.
const DEEPEST: usize = 32;

/// Most signals in a sum, those of its sums included.
const MOST_TERMS: usize = 500;

/// Largest factor of a signal in a sum, as of all numbers in scenes.
const LARGEST_FACTOR: f64 = 1e12;

/// How far the sums of a scene are resolved.
struct Sums {
    /// The signals by number: all but the sums, then the sums as well.
    signals: Vec<Option<SignalScene>>,
    /// The terms of each sum.
    terms: BTreeMap<usize, Vec<String>>,
    /// The factors of the signals in each sum that is resolved; `None` if it is wrong.
    flat: BTreeMap<usize, Option<BTreeMap<usize, f64>>>,
    /// The sums that are being resolved, each a term of the one before.
    open: Vec<usize>,
}

impl Resolver<'_, '_> {
    /// All signals, in the order of the scene; sums are resolved last.
    pub(super) fn all_signals(&mut self) -> Vec<Option<SignalScene>> {
        let names = self.doc.names("signal");
        let mut terms = BTreeMap::new();
        let mut signals = Vec::new();
        for (number, name) in names.iter().enumerate() {
            let path = format!("signal.{name}.terms");
            if self.doc.text(&format!("signal.{name}.shape")) != Some("sum") {
                signals.push(self.signal(name));
                continue;
            }
            signals.push(None);
            if let Some(given) = self.required(&path, self.doc.words(&path)) {
                terms.insert(number, given.to_vec());
            }
        }
        let mut sums = Sums { signals, terms, flat: BTreeMap::new(), open: Vec::new() };
        let numbers: Vec<usize> = sums.terms.keys().copied().collect();
        for number in &numbers {
            self.sum(*number, &names, &mut sums);
        }
        for number in numbers {
            let Some(Some(flat)) = sums.flat.remove(&number) else { continue };
            let history = flat.iter().map(|(term, factor)| {
                let signal = sums.signals.get(*term)?.as_ref()?;
                Some((*factor, signal.history.clone()))
            });
            // A term that is wrong has its own message.
            let Some(history) = history.collect::<Option<Arc<[_]>>>() else { continue };
            if let Some(scale) = self.scale(names[number]) {
                let name = names[number].to_owned();
                sums.signals[number] = Some(SignalScene { name, history: History::Sum(history), scale });
            }
        }
        sums.signals
    }

    /// The factors of the signals in a sum.
    fn sum(&mut self, number: usize, names: &[&str], sums: &mut Sums) -> Option<BTreeMap<usize, f64>> {
        if let Some(known) = sums.flat.get(&number) {
            return known.clone();
        }
        sums.open.push(number);
        let flat = self.factors(number, names, sums);
        sums.open.pop();
        sums.flat.insert(number, flat.clone());
        flat
    }

    fn factors(&mut self, number: usize, names: &[&str], sums: &mut Sums) -> Option<BTreeMap<usize, f64>> {
        let path = format!("signal.{}.terms", names[number]);
        let mut factors = BTreeMap::new();
        let mut good = true;
        for name in sums.terms.get(&number)?.clone() {
            let Some(term) = self.signals.get(name.as_str()).copied() else {
                self.not_defined(&path, &name);
                good = false;
                continue;
            };
            if let Some(at) = sums.open.iter().position(|open| *open == term) {
                let around: Vec<String> = sums.open[at..].iter().map(|k| format!("`{}`", names[*k])).collect();
                let rule = format!("the sums add each other: {} → `{name}`", around.join(" → "));
                self.error(&path, rule, format!("leave `{name}` out, or add signals that don't contain this one"));
                good = false;
                continue;
            }
            if sums.open.len() >= DEEPEST && sums.terms.contains_key(&term) {
                let rule = format!("sums of sums, {} deep, but {DEEPEST} is the limit", DEEPEST + 1);
                self.error(&path, rule, "add the signals themselves instead of their sums");
                return None;
            }
            let (inner, scale) = if sums.terms.contains_key(&term) {
                (self.sum(term, names, sums), self.scale(&name))
            } else {
                let known = sums.signals.get(term).and_then(Option::as_ref);
                (known.map(|_| BTreeMap::from([(term, 1.0)])), known.map(|signal| signal.scale))
            };
            // What is wrong with a term is reported there.
            let (Some(inner), Some(scale)) = (inner, scale) else {
                good = false;
                continue;
            };
            for (leaf, factor) in inner {
                *factors.entry(leaf).or_insert(0.0) += scale * factor;
            }
        }
        if factors.len() > MOST_TERMS {
            let rule = format!("it adds {} signals, but {MOST_TERMS} is the limit", factors.len());
            self.error(&path, rule, "put the smaller ones into a table of their values (shape = \"table\")");
            return None;
        }
        if let Some((leaf, factor)) = factors.iter().find(|(_, factor)| factor.abs() > LARGEST_FACTOR) {
            let rule = format!("its factor of `{}` is {factor:e}, over {LARGEST_FACTOR:e}", names[*leaf]);
            self.error(&path, rule, "use smaller scales, and larger amplitudes where the sum is used");
            return None;
        }
        good.then_some(factors)
    }

    /// The factor of a signal. It has no default in the table of keys, so that scenes as run say no
    /// more than before.
    fn scale(&mut self, name: &str) -> Option<f64> {
        let path = format!("signal.{name}.scale");
        if self.doc.has(&path) { self.number(&path) } else { Some(1.0) }
    }

    fn signal(&mut self, name: &str) -> Option<SignalScene> {
        let path = format!("signal.{name}");
        let history = match self.choice(&format!("{path}.shape"))? {
            words::History::Table => History::Table(Arc::new(self.table(&path)?)),
            words::History::Constant => self.formula(&path, Self::constant)?,
            words::History::Ramp => self.formula(&path, |this, path| this.with_duration(path, Formula::ramp))?,
            words::History::HalfSine => {
                self.formula(&path, |this, path| this.with_duration(path, Formula::half_sine))?
            }
            words::History::Ricker => self.formula(&path, Self::ricker)?,
            words::History::Chirp => self.chirp(&path)?,
            // Resolved after all others.
            words::History::Sum => return None,
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
        match number_table::read(&bytes, start?) {
            Ok(table) => Some(table),
            Err(why) => {
                let remedy = "give two columns, t in s and value, with one row for each time, in ascending order";
                self.error(&key, why, remedy);
                None
            }
        }
    }

    /// Warns of a table that ends before the run, or begins after its start, with a nonzero value:
    /// that value is kept.
    pub(super) fn check_table_covers_run(&mut self, signals: &[Option<SignalScene>], end: f64) {
        for signal in signals.iter().flatten() {
            let History::Table(table) = &signal.history else { continue };
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
