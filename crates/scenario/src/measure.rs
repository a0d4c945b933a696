//! Quantities that may have one of several units, by which they are understood: stiffness and damping of contacts with
//! duration, whose units hold the exponent of the force.

use std::fmt;

use crate::dimension::Dimension;
use crate::quantity::{self, QuantityError};

/// A unit that a key may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Its dimension; of one with a power of the metre, that without the power.
    pub dimension: Dimension,
    /// Whether the metre may have any power: `N/m^1.5`.
    pub any_power: bool,
    /// For messages.
    pub example: &'static str,
}

const fn unit(dimension: Dimension, any_power: bool, example: &'static str) -> Unit {
    Unit { dimension, any_power, example }
}

const INVERSE_VELOCITY: Dimension = Dimension::new(0, -1, 1, 0, 0);

/// Units of the stiffness of a contact.
pub(crate) const CONTACT_STIFFNESS: &[Unit] =
    &[unit(Dimension::STIFFNESS, false, "N/m"), unit(Dimension::FORCE, true, "N/m^n")];

/// Units of the damping of a contact.
pub(crate) const CONTACT_DAMPING: &[Unit] = &[
    unit(Dimension::DAMPING, false, "N s/m"),
    unit(INVERSE_VELOCITY, false, "s/m"),
    unit(Dimension::IMPULSE, true, "N s/m^(n+1)"),
];

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
    /// Whether it is in s/m.
    #[must_use]
    pub fn is_inverse_velocity(&self) -> bool {
        self.dimension == INVERSE_VELOCITY
    }

    /// Reads a quantity in one of the units.
    pub(crate) fn read(text: &str, units: &[Unit]) -> Result<Self, QuantityError> {
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
        // What is wrong with it, seen from the first unit.
        let first = units.first().map_or(Dimension::NONE, |unit| unit.dimension);
        quantity::parse(text, first).map(|value| Self { value, dimension: first, power: None })
    }
}

/// As it is read.
impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&quantity::format_si(self.value, self.dimension))?;
        match self.power {
            Some(power) => write!(f, "/m^{power:?}"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_tells_what_it_is() {
        let read = |text, units| Measure::read(text, units).map(|m| (m.value, m.power, m.to_string()));
        assert_eq!(read("2 kN/m", CONTACT_STIFFNESS), Ok((2e3, None, "2000.0 N/m".to_owned())));
        assert_eq!(read("1e8 N/m^1.5", CONTACT_STIFFNESS), Ok((1e8, Some(1.5), "100000000.0 N/m^1.5".to_owned())));
        assert_eq!(read("3 kN s/m^2.5", CONTACT_DAMPING), Ok((3e3, Some(2.5), "3000.0 N s/m^2.5".to_owned())));
        assert_eq!(read("0.5 s/m", CONTACT_DAMPING), Ok((0.5, None, "0.5 s/m".to_owned())));
        for text in ["2 kN/m", "1e8 N/m^1.5"] {
            let once = Measure::read(text, CONTACT_STIFFNESS).unwrap();
            assert_eq!(Measure::read(&once.to_string(), CONTACT_STIFFNESS), Ok(once));
        }
        assert!(matches!(
            Measure::read("2 kg", CONTACT_STIFFNESS),
            Err(QuantityError::WrongDimension { got: Dimension::MASS, .. })
        ));
        assert_eq!(Measure::read("2", CONTACT_DAMPING), Err(QuantityError::MissingUnit));
        assert!(Measure::read("2 N/m^-1", CONTACT_STIFFNESS).is_err());
    }
}
