//! Quantities with units: reading "36 cm" and writing "0.36 m".
//!
//! A quantity is a decimal number, optional blanks, and a product or quotient of powers of units:
//! `9.81 m/s^2`, `0.4 N s/m^2`, `36cm`, `2700 kg·m⁻³`, `1.5 1/s`, `3 J/(kg K)`. Products and
//! quotients are evaluated from left to right.
//!
//! Powers of ten of the units are added to the exponent in the number's text before it is
//! converted, so that "36 cm" is the double nearest to 0.36, as if it had been written in metres.
//! Multiplying by 0.01 would sometimes be off by one unit in the last place. The other factors
//! (degree, minute, hour, rpm) are multiplied.

use crate::diagnostic::printable;
use crate::dimension::Dimension;
use crate::readable::shortest;
use crate::{unit_expression, units};

/// Why a text is not a quantity, or not of the expected dimension.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QuantityError {
    /// The text does not start with a number.
    #[error("a number is missing")]
    MissingNumber,
    /// The number contains a comma.
    #[error("cannot read the number `{number}`: it contains a comma")]
    DecimalComma {
        /// As written.
        number: String,
        /// The text with a point instead of the comma.
        corrected: String,
    },
    /// `nan` or `inf`.
    #[error("not a finite number")]
    NotFinite,
    /// A number with no unit.
    #[error("the unit is missing")]
    MissingUnit,
    /// An unknown unit symbol.
    #[error("unknown unit `{symbol}`")]
    UnknownUnit {
        /// As written.
        symbol: String,
        /// The unit that was probably meant.
        suggestion: Option<String>,
    },
    /// The unit cannot be read.
    #[error("cannot read the unit `{unit}`: {reason}")]
    Syntax {
        /// The text after the number.
        unit: String,
        /// What is wrong.
        reason: &'static str,
    },
    /// A quantity of another dimension than expected.
    #[error("{wanted} is expected, got {}", got_text(*.got, .unit))]
    WrongDimension {
        /// The expected dimension.
        wanted: Dimension,
        /// The dimension found.
        got: Dimension,
        /// The unit as written.
        unit: String,
    },
    /// An angular velocity where cycles per second are expected.
    #[error("a frequency in cycles per second (Hz) is expected, got an angular velocity ({unit})")]
    AngularFrequency {
        /// The unit as written.
        unit: String,
        /// The same frequency, Hz.
        hertz: f64,
    },
    /// Larger than the largest double.
    #[error("too large to compute with (the limit is 1.8e308 in SI units)")]
    TooLarge,
    /// Not zero, but smaller than the smallest normal double.
    #[error("too small to compute with (the limit is 2.2e-308 in SI units)")]
    TooSmall,
}

fn got_text(got: Dimension, unit: &str) -> String {
    match got.name() {
        "a quantity" => format!("`{unit}`"),
        name => format!("{name} ({unit})"),
    }
}

impl QuantityError {
    /// What is wrong, and after a semicolon what to write instead, if that is known.
    #[must_use]
    pub fn with_remedy(&self) -> String {
        match self.remedy() {
            Some(remedy) => format!("{self}; {remedy}"),
            None => self.to_string(),
        }
    }

    /// What to write instead, if that doesn't depend on the key.
    pub fn remedy(&self) -> Option<String> {
        match self {
            Self::DecimalComma { corrected, .. } => Some(format!("use a decimal point: \"{corrected}\"")),
            Self::AngularFrequency { hertz, .. } => {
                let hertz = shortest(*hertz, 6);
                Some(format!("1 Hz is 2π rad/s: write \"{hertz} Hz\" if the angular velocity is meant"))
            }
            Self::UnknownUnit { .. } => Some(format!("known units are {}", units::known())),
            Self::Syntax { .. } => {
                Some("a unit is a product or quotient of powers, such as N s/m^2 or kg/m^3".to_owned())
            }
            Self::WrongDimension { wanted: Dimension::ACCELERATION, unit, .. } if unit == "g" => {
                Some("g is the gram; standard gravity is gn, as in \"0.4 gn\"".to_owned())
            }
            _ => None,
        }
    }

    /// Suggests only a unit that gives the text the expected dimension.
    fn suggesting(self, text: &str, wanted: Dimension) -> Self {
        let Self::UnknownUnit { symbol, .. } = self else { return self };
        let fits = |unit: &str| {
            Quantity::read(&text.replacen(&symbol, unit, 1)).is_ok_and(|read| wanted.accepts(read.dimension))
        };
        let suggestion = units::suggest(&symbol, fits);
        Self::UnknownUnit { symbol, suggestion }
    }

    /// The unit that was probably meant.
    pub fn did_you_mean(&self) -> Option<&str> {
        match self {
            Self::UnknownUnit { suggestion, .. } => suggestion.as_deref(),
            _ => None,
        }
    }
}

/// Reads a quantity of the expected dimension and returns its value in SI units.
///
/// ```
/// use teeter_text::{dimension::Dimension, quantity};
/// assert_eq!(quantity::parse("36 cm", Dimension::LENGTH), Ok(0.36));
/// assert_eq!(quantity::parse("0.4 N s/m^2", Dimension::DAMPING_PER_LENGTH), Ok(0.4));
/// let error = quantity::parse("36 kg", Dimension::LENGTH).unwrap_err();
/// assert_eq!(error.to_string(), "a length (m) is expected, got a mass (kg)");
/// ```
///
/// # Errors
/// A [`QuantityError`] that says what is wrong with the text.
pub fn parse(text: &str, wanted: Dimension) -> Result<f64, QuantityError> {
    let quantity = Quantity::read(text).map_err(|error| error.suggesting(text, wanted))?;
    if wanted == Dimension::RATE && quantity.dimension == Dimension::ANGULAR_VELOCITY {
        // Revolutions per minute are cycles, radians aren't.
        return match text.trim().strip_suffix("rpm") {
            Some(number) if quantity.unit == "rpm" => parse(&format!("{number} 1/min"), wanted),
            _ => {
                let (unit, hertz) = (printable(quantity.unit), quantity.value / std::f64::consts::TAU);
                Err(QuantityError::AngularFrequency { unit, hertz })
            }
        };
    }
    if !wanted.accepts(quantity.dimension) {
        return Err(if quantity.unit.is_empty() {
            QuantityError::MissingUnit
        } else {
            QuantityError::WrongDimension { wanted, got: quantity.dimension, unit: printable(quantity.unit) }
        });
    }
    Ok(quantity.value)
}

/// So many more digits in the SI unit than in another make the other the one that suits.
const MANY_DIGITS: usize = 8;

/// Writes a value, given in SI units, so that [`parse`] returns the same double, bit for bit: in the
/// SI unit if its size is usual and another doesn't save eight characters or more, else in the usual unit that gives the shortest text. The value should be finite; NaN and infinities are written by
/// name and refused when read.
///
/// ```
/// use teeter_text::{dimension::Dimension, quantity};
/// assert_eq!(quantity::format(0.36, Dimension::LENGTH), "0.36 m");
/// assert_eq!(quantity::format(69e9, Dimension::PRESSURE), "69 GPa");
/// assert_eq!(quantity::format(5_f64.to_radians(), Dimension::ANGLE), "5 deg");
/// ```
pub fn format(value: f64, dimension: Dimension) -> String {
    let unit = dimension.unit();
    if unit.is_empty() {
        return format!("{value:?}");
    }
    let plain = |value: f64| {
        let text = format!("{value:?}");
        text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
    };
    let own = format!("{} {unit}", plain(value));
    if value == 0.0 || !value.is_finite() {
        return own;
    }
    // Within these sizes people read the SI unit as it is, unless it hides a round number: 5 deg.
    let saved = if (1e-2..1e4).contains(&value.abs()) { MANY_DIGITS } else { 0 };
    let longest = own.chars().count().saturating_sub(saved);
    let others = dimension.usual_units().iter().filter_map(|other| {
        let factor = parse(&format!("1 {other}"), dimension).ok()?;
        let text = format!("{} {other}", plain(value / factor));
        // A quotient that was rounded may read back to another double.
        let same = parse(&text, dimension).is_ok_and(|read| read.to_bits() == value.to_bits());
        (same && text.chars().count() <= longest).then_some(text)
    });
    // Of texts of the same length the first, which is in the SI unit.
    std::iter::once(own.clone()).chain(others).min_by_key(|text| text.chars().count()).unwrap_or(own)
}

/// A number with its unit, before its dimension is checked.
#[derive(Debug)]
pub(crate) struct Quantity<'a> {
    /// In SI units.
    pub(crate) value: f64,
    /// Of its unit.
    pub(crate) dimension: Dimension,
    /// The unit as written; may be empty.
    pub(crate) unit: &'a str,
}

impl<'a> Quantity<'a> {
    /// Reads a number with its unit, or without one.
    ///
    /// # Errors
    /// As [`parse`], except for the dimension.
    pub(crate) fn read(text: &'a str) -> Result<Self, QuantityError> {
        let text = text.trim();
        let number = Number::read(text)?;
        let unit = text.get(number.length..).unwrap_or_default().trim();
        if unit.is_empty() {
            return Ok(Self { value: number.value(0)?, dimension: Dimension::NONE, unit });
        }
        let product = unit_expression::read(unit)?;
        // Checked again, as the factors can take a normal number out of the normal range.
        let value = number.value(product.shift)? * product.above / product.below;
        if !value.is_finite() {
            return Err(QuantityError::TooLarge);
        }
        if number.nonzero && !value.is_normal() {
            return Err(QuantityError::TooSmall);
        }
        Ok(Self { value, dimension: product.dimension()?, unit })
    }
}

/// The number at the start of a text, with its exponent separate.
struct Number {
    /// Sign, digits, point.
    mantissa: String,
    exponent: i64,
    nonzero: bool,
    /// Its length in bytes of the text.
    length: usize,
}

impl Number {
    fn read(text: &str) -> Result<Self, QuantityError> {
        let mut mantissa = String::new();
        let mut chars = text.char_indices().peekable();
        let sign = chars.next_if(|(_, c)| matches!(c, '+' | '-' | '\u{2212}'));
        if sign.is_some_and(|(_, sign)| sign != '+') {
            mantissa.push('-');
        }
        let start = chars.peek().map_or(text.len(), |(at, _)| *at);
        let rest = text.get(start..).unwrap_or_default();
        for word in ["nan", "inf"] {
            if rest.get(..3).is_some_and(|head| head.eq_ignore_ascii_case(word)) {
                return Err(QuantityError::NotFinite);
            }
        }
        let (mut digits, mut points) = (0, 0);
        while let Some((_, c)) = chars.next_if(|(_, c)| c.is_ascii_digit() || *c == '.') {
            digits += usize::from(c != '.');
            points += usize::from(c == '.');
            mantissa.push(c);
        }
        let mut length = chars.peek().map_or(text.len(), |(at, _)| *at);
        let after = text.get(length..).unwrap_or_default();
        if let Some(decimals) = after.strip_prefix(',')
            && decimals.starts_with(|c: char| c.is_ascii_digit())
        {
            let end = decimals
                .find(|c: char| !(c.is_ascii_digit() || c == ',' || c == '.'))
                .map_or(text.len(), |at| length + 1 + at);
            return Err(QuantityError::DecimalComma {
                number: printable(text.get(..end).unwrap_or_default()),
                corrected: printable(&text.replacen(',', ".", 1)),
            });
        }
        if digits == 0 || points > 1 {
            return Err(QuantityError::MissingNumber);
        }
        let nonzero = mantissa.contains(|c: char| c.is_ascii_digit() && c != '0');
        let mut exponent = 0;
        if let Some((value, bytes)) = decimal_exponent(after) {
            exponent = value;
            length += bytes;
        }
        Ok(Self { mantissa, exponent, nonzero, length })
    }

    /// The double nearest to the number times 10^`shift`.
    fn value(&self, shift: i32) -> Result<f64, QuantityError> {
        let exponent = self.exponent.saturating_add(i64::from(shift));
        let value: f64 = format!("{}e{exponent}", self.mantissa).parse().map_err(|_| QuantityError::MissingNumber)?;
        if !value.is_finite() {
            Err(QuantityError::TooLarge)
        } else if self.nonzero && !value.is_normal() {
            Err(QuantityError::TooSmall)
        } else {
            Ok(value)
        }
    }
}

/// "e-3" at the start of a text: its value and length; `None` if the e belongs to a unit.
fn decimal_exponent(text: &str) -> Option<(i64, usize)> {
    let digits = text.strip_prefix(['e', 'E'])?;
    let unsigned = digits.strip_prefix(['+', '-']).unwrap_or(digits);
    let count = unsigned.bytes().take_while(u8::is_ascii_digit).count();
    if count == 0 {
        return None;
    }
    // Beyond i32 the result is infinite or zero for any mantissa, so saturate.
    let limit = i64::from(i32::MAX);
    let size = unsigned.get(..count)?.parse().map_or(limit, |size: i64| size.min(limit));
    let value = if digits.starts_with('-') { -size } else { size };
    Some((value, text.len() - unsigned.len() + count))
}

#[cfg(test)]
mod tests {
    use super::{QuantityError, format, parse};
    use crate::dimension::Dimension;

    const AREA: Dimension = Dimension::new(0, 2, 0, 0, 0);
    const HEAT: Dimension = Dimension::new(0, 2, -2, 0, -1);

    #[test]
    fn quantities_read_to_the_double_of_the_si_literal() {
        let table: &[(&str, Dimension, f64)] = &[
            ("36 cm", Dimension::LENGTH, 0.36),
            ("36cm", Dimension::LENGTH, 0.36),
            ("0.15 cm", Dimension::LENGTH, 0.0015),
            ("13.5 cm", Dimension::LENGTH, 0.135),
            (" +1.5e1 mm ", Dimension::LENGTH, 0.015),
            ("-.5 km", Dimension::LENGTH, -500.0),
            ("\u{2212}5. m", Dimension::LENGTH, -5.0),
            ("10 µm", Dimension::LENGTH, 1e-5),
            ("10 μm", Dimension::LENGTH, 1e-5),
            ("10 um", Dimension::LENGTH, 1e-5),
            ("100 us", Dimension::TIME, 1e-4),
            ("100 µs", Dimension::TIME, 1e-4),
            ("1 ms", Dimension::TIME, 0.001),
            ("2 min", Dimension::TIME, 120.0),
            ("1.5 h", Dimension::TIME, 5400.0),
            ("69 GPa", Dimension::PRESSURE, 69e9),
            ("69e3 N/mm^2", Dimension::PRESSURE, 69e9),
            ("2700 kg/m^3", Dimension::DENSITY, 2700.0),
            ("2.7 g/cm^3", Dimension::DENSITY, 2700.0),
            ("2700 kg/m3", Dimension::DENSITY, 2700.0),
            ("2700 kg·m⁻³", Dimension::DENSITY, 2700.0),
            ("9.81 m/s^2", Dimension::ACCELERATION, 9.81),
            ("9.81 m s^-2", Dimension::ACCELERATION, 9.81),
            ("9.81 m/s/s", Dimension::ACCELERATION, 9.81),
            ("9.81 m / s ^ 2", Dimension::ACCELERATION, 9.81),
            ("0.4 N s/m^2", Dimension::DAMPING_PER_LENGTH, 0.4),
            ("0.4 N*s/m^2", Dimension::DAMPING_PER_LENGTH, 0.4),
            ("0.4 Pa s", Dimension::DAMPING_PER_LENGTH, 0.4),
            ("5 N*m", Dimension::ENERGY, 5.0),
            ("5 N·m", Dimension::ENERGY, 5.0),
            ("3 m²", AREA, 3.0),
            ("3 mm^2", AREA, 3e-6),
            ("3 J/(kg K)", HEAT, 3.0),
            ("0.5 1/s", Dimension::RATE, 0.5),
            ("0.5/s", Dimension::RATE, 0.5),
            ("50 Hz", Dimension::RATE, 50.0),
            ("60 rpm", Dimension::RATE, 1.0),
            ("90 rpm", Dimension::RATE, 1.5),
            ("2 rad/s", Dimension::ANGULAR_VELOCITY, 2.0),
            ("5 deg", Dimension::ANGLE, 0.087_266_462_599_716_47),
            ("5°", Dimension::ANGLE, 0.087_266_462_599_716_47),
            ("0.1 rad", Dimension::ANGLE, 0.1),
            ("90 deg", Dimension::ANGLE, std::f64::consts::FRAC_PI_2),
            ("-0 m", Dimension::LENGTH, -0.0),
            ("1e-300 km", Dimension::LENGTH, 1e-297),
        ];
        for (text, dimension, value) in table {
            let read = parse(text, *dimension);
            assert_eq!(read.as_ref().map(|v| v.to_bits()), Ok(value.to_bits()), "{text}: {read:?}");
        }
        let rpm = parse("60 rpm", Dimension::ANGULAR_VELOCITY).unwrap();
        assert!((rpm - std::f64::consts::TAU).abs() < 1e-14);
    }

    #[test]
    fn wrong_texts_say_what_is_wrong() {
        let table: &[(&str, Dimension, &str)] = &[
            ("", Dimension::LENGTH, "a number is missing"),
            ("cm", Dimension::LENGTH, "a number is missing"),
            ("1.2.3 m", Dimension::LENGTH, "a number is missing"),
            ("36", Dimension::LENGTH, "the unit is missing"),
            ("5", Dimension::ANGLE, "the unit is missing"),
            ("36 kg", Dimension::LENGTH, "a length (m) is expected, got a mass (kg)"),
            ("36 m/K", Dimension::LENGTH, "a length (m) is expected, got `m/K`"),
            ("1 1/s", Dimension::ANGULAR_VELOCITY, "an angular velocity (rad/s) is expected, got a rate (1/s)"),
            ("36 furlong", Dimension::LENGTH, "unknown unit `furlong`"),
            ("36 %", Dimension::LENGTH, "unknown unit `%`"),
            ("1,5 mm", Dimension::LENGTH, "cannot read the number `1,5`: it contains a comma"),
            ("nan m", Dimension::LENGTH, "not a finite number"),
            ("-inf m", Dimension::LENGTH, "not a finite number"),
            ("1e999 m", Dimension::LENGTH, "too large to compute with (the limit is 1.8e308 in SI units)"),
            (
                "1e99999999999999999999 m",
                Dimension::LENGTH,
                "too large to compute with (the limit is 1.8e308 in SI units)",
            ),
            ("1e-320 m", Dimension::LENGTH, "too small to compute with (the limit is 2.2e-308 in SI units)"),
            ("5 m^0.5", Dimension::LENGTH, "cannot read the unit `m^0.5`: a unit is missing or a sign is misplaced"),
            ("5 m^", Dimension::LENGTH, "cannot read the unit `m^`: an exponent must be a whole number"),
            ("5 m 2", Dimension::LENGTH, "cannot read the unit `m 2`: a unit is missing or a sign is misplaced"),
            ("5 m/", Dimension::LENGTH, "cannot read the unit `m/`: a unit is missing or a sign is misplaced"),
            ("5 (m", Dimension::LENGTH, "cannot read the unit `(m`: a closing parenthesis is missing"),
            ("5 m)", Dimension::LENGTH, "cannot read the unit `m)`: there is an extra closing parenthesis"),
            ("5 m^999", Dimension::LENGTH, "cannot read the unit `m^999`: the exponents are too large"),
        ];
        for (text, dimension, message) in table {
            let error = parse(text, *dimension).unwrap_err();
            assert_eq!(error.to_string(), *message, "{text}");
        }
        let nested = format!("1 {}m{}", "(".repeat(100_000), ")".repeat(100_000));
        assert!(matches!(parse(&nested, Dimension::LENGTH), Err(QuantityError::Syntax { .. })));
        let powers = "1 (((m^99)^99)^99)^99 (((m^99)^99)^99)^99";
        assert!(parse(powers, Dimension::LENGTH).is_err());
        let angular = parse("7 rad/s", Dimension::RATE).unwrap_err();
        let expected = "a frequency in cycles per second (Hz) is expected, got an angular velocity (rad/s)";
        assert_eq!(angular.to_string(), expected);
        assert!(angular.remedy().is_some_and(|remedy| remedy.contains("\"1.11408 Hz\"")), "{angular:?}");
        let comma = parse("1,5 mm", Dimension::LENGTH).unwrap_err();
        assert_eq!(comma.remedy().as_deref(), Some("use a decimal point: \"1.5 mm\""));
    }

    #[test]
    fn a_suggested_unit_has_the_expected_dimension() {
        let suggested = |text: &str, wanted| parse(text, wanted).unwrap_err().did_you_mean().map(str::to_owned);
        assert_eq!(suggested("4 dg", Dimension::ANGLE).as_deref(), Some("deg"));
        assert_eq!(suggested("36 in", Dimension::LENGTH), None);
        assert_eq!(suggested("69 Gpa", Dimension::PRESSURE).as_deref(), Some("GPa"));
        assert_eq!(suggested("3 newton/m", Dimension::STIFFNESS).as_deref(), Some("N"));
        assert_eq!(suggested("3 newton/m", Dimension::LENGTH), None);
        assert_eq!(parse("69 GN/m^2", Dimension::PRESSURE), Ok(69e9));
    }

    #[test]
    fn what_is_written_in_si_reads_back_to_the_same_bits() {
        let dimensions = [
            Dimension::LENGTH,
            Dimension::PRESSURE,
            Dimension::ANGLE,
            Dimension::DAMPING_PER_LENGTH,
            Dimension::ANGULAR_VELOCITY,
            Dimension::RATE,
            HEAT,
        ];
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let mut tried = 0;
        while tried < 20_000 {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            let value = f64::from_bits(bits);
            if value.is_normal() {
                let dimension = dimensions[tried % dimensions.len()];
                let text = format(value, dimension);
                let read = parse(&text, dimension).map(f64::to_bits);
                assert_eq!(read, Ok(bits), "{text}");
                tried += 1;
            }
        }
    }

    #[test]
    fn a_shift_in_the_text_equals_the_decimal_literal() {
        for thousandths in 0..4000 {
            let literal: f64 = format!("0.{thousandths:04}").parse().unwrap();
            let read = parse(&format!("{}.{} mm", thousandths / 10, thousandths % 10), Dimension::LENGTH);
            assert_eq!(read, Ok(literal));
        }
    }
}
