//! Quantities in one of several units, which determines their meaning: coefficients of power laws,
//! whose units contain the exponent.

use std::fmt;

use crate::dimension::Dimension;
use crate::quantity::{self, QuantityError};

/// A unit that a key accepts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AllowedUnit {
    /// Its dimension, without the power of the metre if there is one.
    pub dimension: Dimension,
    /// Whether the metre may have any power: `N/m^1.5`.
    pub any_power: bool,
    /// For messages.
    pub example: &'static str,
}

impl AllowedUnit {
    /// A unit of this dimension.
    #[must_use]
    pub const fn new(dimension: Dimension, example: &'static str) -> Self {
        Self { dimension, any_power: false, example }
    }

    /// A unit of this dimension over any power of the metre.
    #[must_use]
    pub const fn over_powers_of_metre(dimension: Dimension, example: &'static str) -> Self {
        Self { dimension, any_power: true, example }
    }
}

/// A number and its unit: that of `dimension`, over a power of the metre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// The number in SI units.
    pub value: f64,
    /// The dimension, without the power.
    pub dimension: Dimension,
    /// The power of the metre that it is divided by, where it may be any.
    pub power: Option<f64>,
}

impl Measure {
    /// Reads a quantity in one of the units.
    ///
    /// # Errors
    /// What is wrong with the text, relative to the first unit.
    pub fn read(text: &str, units: &[AllowedUnit]) -> Result<Self, QuantityError> {
        for unit in units.iter().filter(|unit| !unit.any_power) {
            if let Ok(value) = quantity::parse(text, unit.dimension) {
                return Ok(Self { value, dimension: unit.dimension, power: None });
            }
        }
        let over = text.rsplit_once("/m^").and_then(|(above, power)| Some((above, power.trim().parse::<f64>().ok()?)));
        if let Some((above, power)) = over.filter(|(_, power)| power.is_finite() && *power > 0.0) {
            for unit in units.iter().filter(|unit| unit.any_power) {
                if let Ok(value) = quantity::parse(above, unit.dimension) {
                    return Ok(Self { value, dimension: unit.dimension, power: Some(power) });
                }
            }
        }
        // The error relative to the first unit.
        let first = units.first().map_or(Dimension::NONE, |unit| unit.dimension);
        quantity::parse(text, first).map(|value| Self { value, dimension: first, power: None })
    }
}

/// In the syntax that can be read.
impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&quantity::format(self.value, self.dimension))?;
        match self.power {
            Some(power) => write!(f, "/m^{power:?}"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STIFFNESS: &[AllowedUnit] =
        &[AllowedUnit::new(Dimension::STIFFNESS, "N/m"), AllowedUnit::over_powers_of_metre(Dimension::FORCE, "N/m^n")];
    const DAMPING: &[AllowedUnit] = &[
        AllowedUnit::new(Dimension::DAMPING, "N s/m"),
        AllowedUnit::new(Dimension::INVERSE_VELOCITY, "s/m"),
        AllowedUnit::over_powers_of_metre(Dimension::IMPULSE, "N s/m^(n+1)"),
    ];

    #[test]
    fn the_unit_tells_what_it_is() {
        let read = |text, units| Measure::read(text, units).map(|m| (m.value, m.power, m.to_string()));
        assert_eq!(read("2 kN/m", STIFFNESS), Ok((2e3, None, "2000 N/m".to_owned())));
        assert_eq!(read("1e8 N/m^1.5", STIFFNESS), Ok((1e8, Some(1.5), "100000 kN/m^1.5".to_owned())));
        assert_eq!(read("3 kN s/m^2.5", DAMPING), Ok((3e3, Some(2.5), "3000 N s/m^2.5".to_owned())));
        assert_eq!(read("0.5 s/m", DAMPING), Ok((0.5, None, "0.5 s/m".to_owned())));
        for text in ["2 kN/m", "1e8 N/m^1.5"] {
            let once = Measure::read(text, STIFFNESS).unwrap();
            assert_eq!(Measure::read(&once.to_string(), STIFFNESS), Ok(once));
        }
        assert!(matches!(
            Measure::read("2 kg", STIFFNESS),
            Err(QuantityError::WrongDimension { got: Dimension::MASS, .. })
        ));
        assert_eq!(Measure::read("2", DAMPING), Err(QuantityError::MissingUnit));
        assert!(Measure::read("2 N/m^-1", STIFFNESS).is_err());
    }
}
