//! Resolves components of motions that are given by recorded accelerations.

use super::Resolver;
use super::shared::RecordKeys;
use crate::scene::{AxisScene, History, RecordScene};
use crate::words::{Baseline, RecordUnit};
use std::sync::Arc;
use teeter_integrator::Given;
use teeter_record::{IntensityMeasure, ReadSettings, Record, RecordError};

/// The keys that scale a record; at most one is given.
const SCALINGS: [&str; 5] = ["scale", "peak", "peak_velocity", "arias", "spectral_acceleration"];

/// How a record is scaled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Scaling {
    /// By a factor.
    Factor(f64),
    /// To a value of an intensity measure, m/s² or m/s.
    To(IntensityMeasure, f64),
}

impl Resolver<'_, '_> {
    /// The components x and y of a motion that are given by records; `None` on error.
    pub(super) fn recorded(&mut self, motion: &str) -> Option<[Option<AxisScene>; 2]> {
        let [x, y] = ["x", "y"].map(|component| {
            let path = format!("{motion}.{component}");
            self.doc.has_table(&path).then(|| self.record(&path))
        });
        let axis = |record: Arc<RecordScene>| AxisScene {
            given: Given::Acceleration,
            amplitude: 1.0,
            history: History::Record(record),
        };
        // Both are resolved, so that all errors are found.
        match (x, y) {
            (Some(None), _) | (_, Some(None)) => None,
            (x, y) => Some([x.flatten().map(axis), y.flatten().map(axis)]),
        }
    }

    /// A record with its corrections, as it is used.
    fn record(&mut self, path: &str) -> Option<Arc<RecordScene>> {
        let at = |key: &str| format!("{path}.{key}");
        let doc = self.doc;
        let file = self.word(&at("record"));
        let unit = if doc.has(&at("unit")) { Some(self.choice(&at("unit"))?) } else { None };
        let baseline = self.choice(&at("baseline"));
        let taper = self.number(&at("taper"));
        let (file, baseline, taper) = (file?, baseline?, taper?);
        let scaling = self.scaling(path)?;
        // What is wrong with these is told; without them the record would be another one, or seem to lack what was given.
        if ["step", "from", "to", "component"].iter().any(|key| doc.is_refused(&at(key))) {
            return None;
        }
        let keys = RecordKeys {
            file,
            step: doc.quantity(&at("step")),
            unit: unit.map(metres_per_second_squared),
            component: doc.text(&at("component")).map(str::to_owned),
            from: doc.quantity(&at("from")),
            to: doc.quantity(&at("to")),
            baseline: degree(baseline),
            taper,
        };
        let Some(shared) = self.shared else {
            let corrected = self.corrected(path, &keys)?;
            return self.scaled(path, &keys.file, &corrected, scaling).map(Arc::new);
        };
        let used = (keys, (path.to_owned(), scaling));
        shared.used(&used, || {
            let corrected = shared.corrected(&used.0, || self.corrected(path, &used.0))?;
            self.scaled(path, &used.0.file, &corrected, scaling)
        })
    }

    /// A record as read and corrected.
    fn corrected(&mut self, path: &str, keys: &RecordKeys) -> Option<Record> {
        let RecordKeys { file, step, unit, component, from, to, baseline, taper } = keys;
        let bytes = match self.file(file) {
            Ok(bytes) => bytes,
            Err(why) => {
                self.error(&format!("{path}.record"), why, "paths are relative to the scene's file");
                return None;
            }
        };
        let settings = ReadSettings { step: *step, unit: *unit, component: component.as_deref() };
        let read = Record::read_with(bytes, file, &settings);
        let read = self.judged(path, "record", read)?;
        let cut = match (from, to) {
            (None, None) => read,
            (from, to) => {
                let key = if to.is_some() { "to" } else { "from" };
                self.judged(path, key, read.cut(from.unwrap_or(0.0), to.unwrap_or(f64::INFINITY)))?
            }
        };
        let corrected = match baseline {
            None => cut,
            Some(degree) => self.judged(path, "baseline", cut.baseline_corrected(*degree))?,
        };
        if *taper > 0.0 { self.judged(path, "taper", corrected.tapered(*taper)) } else { Some(corrected) }
    }

    /// A record as used.
    fn scaled(
        &mut self,
        path: &str,
        file: &str,
        corrected: &Record,
        scaling: Option<(&'static str, Scaling)>,
    ) -> Option<RecordScene> {
        let scaled = match scaling {
            Some((key, Scaling::Factor(factor))) => self.judged(path, key, corrected.scaled(factor))?,
            Some((key, Scaling::To(measure, value))) => self.judged(path, key, corrected.scaled_to(measure, value))?,
            None => corrected.clone(),
        };
        match RecordScene::new(path, file, scaled) {
            Ok(record) => Some(record),
            Err(error) => {
                let remedy = "check the step and the unit of the record";
                self.error(&format!("{path}.record"), error.to_string(), remedy);
                None
            }
        }
    }

    /// How the record is scaled, and the key that says so; `None` on error.
    fn scaling(&mut self, path: &str) -> Option<Option<(&'static str, Scaling)>> {
        let at = |key: &str| format!("{path}.{key}");
        let doc = self.doc;
        let given: Vec<&'static str> = SCALINGS.into_iter().filter(|key| doc.has(&at(key))).collect();
        if let [first, second, ..] = given[..] {
            self.error(&at(second), format!("{first} and {second} both scale the record"), "keep one of them");
            return None;
        }
        let spectral = given.contains(&"spectral_acceleration");
        let period = doc.quantity(&at("period"));
        if !spectral && doc.has(&at("period")) {
            self.error(&at("period"), "no spectral_acceleration is given", "leave it out, or give both");
            return None;
        }
        if spectral && period.is_none() {
            if !doc.is_refused(&at("period")) {
                let remedy = "add period, such as period = \"0.5 s\"";
                self.error(&at("spectral_acceleration"), "of which natural period?", remedy);
            }
            return None;
        }
        let Some(key) = given.first().copied() else { return Some(None) };
        let measure = match key {
            "scale" => return Some(Some((key, Scaling::Factor(doc.number(&at(key))?)))),
            "peak" => IntensityMeasure::PeakAcceleration,
            "peak_velocity" => IntensityMeasure::PeakVelocity,
            "arias" => IntensityMeasure::Arias,
            _ => IntensityMeasure::SpectralAcceleration { period: period? },
        };
        Some(Some((key, Scaling::To(measure, doc.quantity(&at(key))?))))
    }

    /// What a step of reading or correcting gives; its error is reported at a key.
    fn judged(&mut self, path: &str, key: &str, result: Result<Record, RecordError>) -> Option<Record> {
        match result {
            Ok(record) => Some(record),
            Err(error) => {
                let key = blamed(&error, key);
                self.error(&format!("{path}.{key}"), error.to_string(), remedy(&error));
                None
            }
        }
    }
}

/// The key that an error is about, `key` unless another is.
fn blamed<'k>(error: &RecordError, key: &'k str) -> &'k str {
    match error {
        RecordError::StepTwice { .. } | RecordError::Step(_) => "step",
        RecordError::UnitTwice { .. } | RecordError::NotForFormat { what: "a unit", .. } => "unit",
        RecordError::NotForFormat { .. } | RecordError::Component { .. } => "component",
        RecordError::Parameter { what: "the period", .. } => "period",
        _ => key,
    }
}

/// What to do about an error.
fn remedy(error: &RecordError) -> &'static str {
    match error {
        RecordError::NotText { .. } => {
            "give a record of acceleration: PEER .AT2, ESM or COSMOS ASCII, or a table of time and acceleration"
        }
        RecordError::StepNeeded => "add step, such as step = \"10 ms\"",
        RecordError::StepTwice { .. } | RecordError::UnitTwice { .. } | RecordError::NotForFormat { .. } => {
            "leave this key out"
        }
        RecordError::Component { .. } => "name one of these, or give the number of its column",
        RecordError::SeveralColumns { .. } => {
            "choose one, such as component = \"NAME\", by its heading or by the number of its column"
        }
        RecordError::RowsOfValues { .. } => {
            "put its header back (a line with NPTS and DT), or write one value in each line and add step, such as step = \"10 ms\""
        }
        RecordError::UnitWithoutBrackets { .. } => {
            "put it in brackets if it is one, or say which unit it is, such as unit = \"m/s^2\""
        }
        RecordError::Descending { .. } => "sort the rows by time",
        RecordError::Columns { .. } => "give all rows of the table the same columns",
        RecordError::Cut { .. } => "give times within the record, from before to",
        RecordError::Still => "leave out this key, or use another record",
        RecordError::Parameter { .. } => "choose a value in that range",
        RecordError::Uneven { .. } => {
            "a record must have a uniform step; for other tables use a signal of shape = \"table\""
        }
        _ => "give a record of acceleration: PEER .AT2, ESM or COSMOS ASCII, or a table of time and acceleration",
    }
}

/// The degree of a baseline; `None` for none.
fn degree(baseline: Baseline) -> Option<usize> {
    match baseline {
        Baseline::None => None,
        Baseline::Mean => Some(0),
        Baseline::Linear => Some(1),
        Baseline::Quadratic => Some(2),
        Baseline::Cubic => Some(3),
        Baseline::Quartic => Some(4),
        Baseline::Quintic => Some(5),
    }
}

fn metres_per_second_squared(unit: RecordUnit) -> f64 {
    match unit {
        RecordUnit::MetrePerSecondSquared => 1.0,
        RecordUnit::CentimetrePerSecondSquared | RecordUnit::Gal => 0.01,
        RecordUnit::MillimetrePerSecondSquared => 0.001,
        RecordUnit::StandardGravity | RecordUnit::G => teeter_record::STANDARD_GRAVITY,
    }
}
