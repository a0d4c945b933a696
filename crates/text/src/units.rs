//! The table of unit symbols.
//!
//! A unit is a power of ten times a factor times base units. The power of ten is stored separately
//! because it is added to the exponent of the number's text before conversion (see
//! [`crate::quantity`]): "36 cm" is then exactly the double 0.36.

use std::f64::consts::PI;

use crate::dimension::Dimension;
use crate::suggest;

/// One unit: its symbol and its size in SI, 10^`shift` × `factor`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// As written.
    pub symbol: &'static str,
    /// What it measures.
    pub dimension: Dimension,
    /// Power of ten of its size.
    pub shift: i32,
    /// The rest of its size; 1 for all decimal units.
    pub factor: f64,
}

const fn ten(symbol: &'static str, dimension: Dimension, shift: i32) -> Unit {
    Unit { symbol, dimension, shift, factor: 1.0 }
}

const fn odd(symbol: &'static str, dimension: Dimension, factor: f64) -> Unit {
    Unit { symbol, dimension, shift: 0, factor }
}

/// All known units.
pub static UNITS: &[Unit] = &[
    ten("m", Dimension::LENGTH, 0),
    ten("dm", Dimension::LENGTH, -1),
    ten("cm", Dimension::LENGTH, -2),
    ten("mm", Dimension::LENGTH, -3),
    ten("um", Dimension::LENGTH, -6),
    ten("nm", Dimension::LENGTH, -9),
    ten("km", Dimension::LENGTH, 3),
    ten("kg", Dimension::MASS, 0),
    ten("g", Dimension::MASS, -3),
    ten("mg", Dimension::MASS, -6),
    ten("t", Dimension::MASS, 3),
    ten("s", Dimension::TIME, 0),
    ten("ms", Dimension::TIME, -3),
    ten("us", Dimension::TIME, -6),
    ten("ns", Dimension::TIME, -9),
    odd("min", Dimension::TIME, 60.0),
    odd("h", Dimension::TIME, 3600.0),
    ten("rad", Dimension::ANGLE, 0),
    ten("mrad", Dimension::ANGLE, -3),
    odd("deg", Dimension::ANGLE, PI / 180.0),
    odd("°", Dimension::ANGLE, PI / 180.0),
    ten("N", Dimension::FORCE, 0),
    ten("mN", Dimension::FORCE, -3),
    ten("kN", Dimension::FORCE, 3),
    ten("MN", Dimension::FORCE, 6),
    ten("GN", Dimension::FORCE, 9),
    ten("Pa", Dimension::PRESSURE, 0),
    ten("hPa", Dimension::PRESSURE, 2),
    ten("kPa", Dimension::PRESSURE, 3),
    ten("MPa", Dimension::PRESSURE, 6),
    ten("GPa", Dimension::PRESSURE, 9),
    ten("bar", Dimension::PRESSURE, 5),
    ten("J", Dimension::ENERGY, 0),
    ten("mJ", Dimension::ENERGY, -3),
    ten("kJ", Dimension::ENERGY, 3),
    ten("W", Dimension::POWER, 0),
    ten("mW", Dimension::POWER, -3),
    ten("kW", Dimension::POWER, 3),
    ten("Hz", Dimension::RATE, 0),
    ten("kHz", Dimension::RATE, 3),
    odd("rpm", Dimension::ANGULAR_VELOCITY, PI / 30.0),
    ten("K", Dimension::TEMPERATURE, 0),
    // Standard gravity; g is the gram.
    odd("gn", Dimension::ACCELERATION, 9.806_65),
    ten("gal", Dimension::ACCELERATION, -2),
    ten("Gal", Dimension::ACCELERATION, -2),
];

/// Names of units in words, and their symbols.
static WORDS: &[(&str, &str)] = &[
    ("metre", "m"),
    ("meter", "m"),
    ("micron", "um"),
    ("gram", "g"),
    ("kilogram", "kg"),
    ("kgs", "kg"),
    ("tonne", "t"),
    ("ton", "t"),
    ("sec", "s"),
    ("second", "s"),
    ("minute", "min"),
    ("hour", "h"),
    ("hr", "h"),
    ("radian", "rad"),
    ("degree", "deg"),
    ("newton", "N"),
    ("pascal", "Pa"),
    ("joule", "J"),
    ("watt", "W"),
    ("hertz", "Hz"),
];

/// The unit of this symbol. Both Unicode letters for micro (µ U+00B5 and μ U+03BC) stand for `u`.
///
/// ```
/// use teeter_text::units;
/// assert_eq!(units::find("GPa").unwrap().shift, 9);
/// assert_eq!(units::find("µs"), units::find("us"));
/// assert!(units::find("furlong").is_none());
/// ```
pub fn find(symbol: &str) -> Option<&'static Unit> {
    let plain = symbol.replace(['\u{b5}', '\u{3bc}'], "u");
    UNITS.iter().find(|unit| unit.symbol == plain)
}

/// Longest symbol, in bytes, for which a suggestion is searched.
const LONGEST: usize = 32;

/// What was probably meant by an unknown symbol: a unit in words, two units run together, or a
/// typing error; of the units that `fits` accepts.
pub(crate) fn suggest(symbol: &str, fits: impl Fn(&str) -> bool) -> Option<String> {
    if symbol.len() > LONGEST {
        return None;
    }
    let lower = symbol.to_lowercase();
    let singular = lower.strip_suffix('s').unwrap_or(&lower);
    let in_words = WORDS.iter().find(|(word, unit)| (*word == lower || *word == singular) && fits(unit));
    if let Some((_, unit)) = in_words {
        return Some((*unit).to_owned());
    }
    if symbol.len() <= 8 {
        for (at, _) in symbol.char_indices().skip(1) {
            let (first, second) = symbol.split_at(at);
            let both = format!("{first} {second}");
            if find(first).is_some() && find(second).is_some() && fits(&both) {
                return Some(both);
            }
        }
    }
    let fitting = || UNITS.iter().map(|unit| unit.symbol).filter(|symbol| fits(symbol));
    if let Some(unit) = fitting().find(|symbol| symbol.to_lowercase() == lower) {
        return Some(unit.to_owned());
    }
    suggest::nearest(symbol, fitting()).map(str::to_owned)
}

/// The symbols, for a message.
#[must_use]
pub fn known() -> String {
    let symbols: Vec<&str> = UNITS.iter().map(|unit| unit.symbol).collect();
    symbols.join(", ")
}

#[cfg(test)]
mod tests {
    use super::{UNITS, find, suggest};

    #[test]
    fn symbols_are_unique_and_found() {
        for unit in UNITS {
            assert_eq!(find(unit.symbol), Some(unit), "{}", unit.symbol);
        }
    }

    #[test]
    fn words_run_together_units_and_wrong_capitals_are_understood() {
        let suggest = |symbol: &str| suggest(symbol, |_| true);
        assert_eq!(suggest("seconds").as_deref(), Some("s"));
        assert_eq!(suggest("Nm").as_deref(), Some("N m"));
        assert_eq!(suggest("Gpa").as_deref(), Some("GPa"));
        assert_eq!(suggest("radd").as_deref(), Some("rad"));
        assert_eq!(suggest("furlong"), None);
    }
}
