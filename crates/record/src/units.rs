//! Units as files write them.

use crate::STANDARD_GRAVITY;
use crate::error::{RecordError, shown};

const ACCELERATIONS: &str = "m/s^2, cm/s^2, mm/s^2, gal, g";
const TIMES: &str = "s, ms";

/// m/s² in a unit of acceleration.
pub(crate) fn acceleration(line: usize, unit: &str) -> Result<f64, RecordError> {
    match simple(unit).as_str() {
        "m/s2" | "m/s/s" | "m/sec2" | "m/sec/sec" | "ms-2" => Ok(1.0),
        "cm/s2" | "cm/s/s" | "cm/sec2" | "cm/sec/sec" | "gal" => Ok(0.01),
        "mm/s2" | "mm/s/s" => Ok(0.001),
        "g" => Ok(STANDARD_GRAVITY),
        "mg" => Ok(STANDARD_GRAVITY / 1000.0),
        _ => Err(RecordError::Unit { line, found: shown(unit), quantity: "an acceleration", known: ACCELERATIONS }),
    }
}

/// Seconds in a unit of time.
pub(crate) fn time(line: usize, unit: &str) -> Result<f64, RecordError> {
    match simple(unit).as_str() {
        "s" | "sec" | "seconds" => Ok(1.0),
        "ms" | "msec" => Ok(0.001),
        _ => Err(RecordError::Unit { line, found: shown(unit), quantity: "a time", known: TIMES }),
    }
}

/// A unit without the signs by which its power may be written.
fn simple(unit: &str) -> String {
    let unit = unit.trim().to_lowercase().replace('²', "2");
    unit.chars().filter(|c| !matches!(c, '^' | '*' | ' ' | '(' | ')')).collect()
}
