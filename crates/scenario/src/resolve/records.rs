//! Resolves components of motions that are given by recorded accelerations.

use super::Resolver;
use crate::scene::{AxisScene, History, RecordScene};
use crate::words::{Baseline, RecordUnit};
use std::sync::Arc;
use teeter_integrator::Given;
use teeter_record::{ReadSettings, Record, RecordError};

impl Resolver<'_, '_> {
    /// The components x and y of a motion that are given by records; `None` on error.
    pub(super) fn recorded(&mut self, motion: &str) -> Option<[Option<AxisScene>; 2]> {
        let [x, y] = ["x", "y"].map(|component| {
            let path = format!("{motion}.{component}");
            self.doc.has_table(&path).then(|| self.record(&path))
        });
        let axis = |record: RecordScene| AxisScene {
            given: Given::Acceleration,
            amplitude: 1.0,
            history: History::Record(Arc::new(record)),
        };
        // Both are resolved, so that all errors are found.
        match (x, y) {
            (Some(None), _) | (_, Some(None)) => None,
            (x, y) => Some([x.flatten().map(axis), y.flatten().map(axis)]),
        }
    }

    /// A record with its corrections.
    fn record(&mut self, path: &str) -> Option<RecordScene> {
        let at = |key: &str| format!("{path}.{key}");
        let doc = self.doc;
        let file = self.word(&at("record"));
        let unit = if doc.has(&at("unit")) { Some(self.choice(&at("unit"))?) } else { None };
        let baseline = self.choice(&at("baseline"));
        let taper = self.number(&at("taper"));
        let (file, baseline, taper) = (file?, baseline?, taper?);
        if doc.has(&at("scale")) && doc.has(&at("peak")) {
            self.error(&at("peak"), "scale and peak both scale the record", "keep one of them");
            return None;
        }
        let settings = ReadSettings {
            step: doc.quantity(&at("step")),
            unit: unit.map(metres_per_second_squared),
            component: doc.text(&at("component")),
        };
        let bytes = match self.file(&file) {
            Ok(bytes) => bytes,
            Err(why) => {
                self.error(&at("record"), why, "paths are relative to the scene's file");
                return None;
            }
        };
        let read = Record::read_with(bytes, &file, &settings);
        let read = self.judged(path, "record", read)?;
        let (from, to) = (doc.quantity(&at("from")), doc.quantity(&at("to")));
        let cut = match (from, to) {
            (None, None) => read,
            (from, to) => {
                let key = if to.is_some() { "to" } else { "from" };
                self.judged(path, key, read.cut(from.unwrap_or(0.0), to.unwrap_or(f64::INFINITY)))?
            }
        };
        let corrected = match degree(baseline) {
            None => cut,
            Some(degree) => self.judged(path, "baseline", cut.baseline_corrected(degree))?,
        };
        let tapered = if taper > 0.0 { self.judged(path, "taper", corrected.tapered(taper))? } else { corrected };
        let scaled = match (doc.number(&at("scale")), doc.quantity(&at("peak"))) {
            (Some(factor), _) => self.judged(path, "scale", tapered.scaled(factor))?,
            (None, Some(peak)) => self.judged(path, "peak", tapered.scaled_to_peak(peak))?,
            (None, None) => tapered,
        };
        match RecordScene::new(path, &file, scaled) {
            Ok(record) => Some(record),
            Err(error) => {
                self.error(&at("record"), error.to_string(), "check the step and the unit of the record");
                None
            }
        }
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
        _ => key,
    }
}

/// What to do about an error.
fn remedy(error: &RecordError) -> &'static str {
    match error {
        RecordError::StepNeeded => "add step, such as step = \"10 ms\"",
        RecordError::StepTwice { .. } | RecordError::UnitTwice { .. } | RecordError::NotForFormat { .. } => {
            "leave this key out"
        }
        RecordError::Component { .. } => "name one of these",
        RecordError::Columns { .. } => "choose one of several accelerations by component = \"NAME\", or by its number",
        RecordError::Cut { .. } => "give times within the record, from before to",
        RecordError::Still => "leave out peak, or use another record",
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
