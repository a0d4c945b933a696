//! Units of the files.

use crate::STANDARD_GRAVITY;
use crate::error::{RecordError, shown};

const ACCELERATIONS: &str = "m/s^2, cm/s^2, mm/s^2, gal, g, gn";
const TIMES: &str = "s, ms";

/// A unit of acceleration in m/s².
pub(crate) fn acceleration(line: usize, unit: &str) -> Result<f64, RecordError> {
    match simple(unit).as_str() {
        "m/s2" | "m/s/s" | "m/sec2" | "m/sec/sec" | "ms-2" => Ok(1.0),
        "cm/s2" | "cm/s/s" | "cm/sec2" | "cm/sec/sec" | "gal" => Ok(0.01),
        "mm/s2" | "mm/s/s" => Ok(0.001),
        "g" | "gn" => Ok(STANDARD_GRAVITY),
        "mg" => Ok(STANDARD_GRAVITY / 1000.0),
        _ => Err(RecordError::Unit { line, found: shown(unit), quantity: "acceleration", known: ACCELERATIONS }),
    }
}

/// A unit of time in s.
pub(crate) fn time(line: usize, unit: &str) -> Result<f64, RecordError> {
    match simple(unit).as_str() {
        "s" | "sec" | "seconds" => Ok(1.0),
        "ms" | "msec" => Ok(0.001),
        _ => Err(RecordError::Unit { line, found: shown(unit), quantity: "time", known: TIMES }),
    }
}

/// A unit without the characters that mark a power.
fn simple(unit: &str) -> String {
    let unit = unit.trim().to_lowercase().replace('²', "2");
    unit.chars().filter(|c| !matches!(c, '^' | '*' | ' ' | '(' | ')')).collect()
}
