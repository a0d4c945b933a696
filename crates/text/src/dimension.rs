//! Physical dimensions: exponents over kilogram, metre, second, radian and kelvin, and their common
//! names.

use std::fmt;

/// The dimension of a quantity, as exponents of the base units kg, m, s, rad, K.
///
/// The radian is a separate unit, so that an angle can be distinguished from a bare number, but it
/// counts as dimensionless wherever no angle is expected: see [`Dimension::accepts`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dimension {
    /// Exponent of the kilogram.
    pub kg: i8,
    /// Exponent of the metre.
    pub m: i8,
    /// Exponent of the second.
    pub s: i8,
    /// Exponent of the radian.
    pub rad: i8,
    /// Exponent of the kelvin.
    pub kelvin: i8,
}

impl Dimension {
    /// A dimension from its exponents of kg, m, s, rad, K.
    pub const fn new(kg: i8, m: i8, s: i8, rad: i8, kelvin: i8) -> Self {
        Self { kg, m, s, rad, kelvin }
    }

    /// A pure number.
    pub const NONE: Self = Self::new(0, 0, 0, 0, 0);
    /// Length, m.
    pub const LENGTH: Self = Self::new(0, 1, 0, 0, 0);
    /// Mass, kg.
    pub const MASS: Self = Self::new(1, 0, 0, 0, 0);
    /// Time, s.
    pub const TIME: Self = Self::new(0, 0, 1, 0, 0);
    /// Angle, rad.
    pub const ANGLE: Self = Self::new(0, 0, 0, 1, 0);
    /// Temperature, K.
    pub const TEMPERATURE: Self = Self::new(0, 0, 0, 0, 1);
    /// Velocity, m/s.
    pub const VELOCITY: Self = Self::new(0, 1, -1, 0, 0);
    /// One over a velocity, s/m.
    pub const INVERSE_VELOCITY: Self = Self::new(0, -1, 1, 0, 0);
    /// Acceleration, m/s².
    pub const ACCELERATION: Self = Self::new(0, 1, -2, 0, 0);
    /// Angular velocity, rad/s.
    pub const ANGULAR_VELOCITY: Self = Self::new(0, 0, -1, 1, 0);
    /// Angular acceleration, rad/s².
    pub const ANGULAR_ACCELERATION: Self = Self::new(0, 0, -2, 1, 0);
    /// Rate or frequency, 1/s. A hertz is 1/s here; it is not multiplied by 2π, so rad/s is refused.
    pub const RATE: Self = Self::new(0, 0, -1, 0, 0);
    /// Density, kg/m³.
    pub const DENSITY: Self = Self::new(1, -3, 0, 0, 0);
    /// Pressure or elastic modulus, Pa.
    pub const PRESSURE: Self = Self::new(1, -1, -2, 0, 0);
    /// Force, N.
    pub const FORCE: Self = Self::new(1, 1, -2, 0, 0);
    /// Energy or moment, J = N m.
    pub const ENERGY: Self = Self::new(1, 2, -2, 0, 0);
    /// Power, W.
    pub const POWER: Self = Self::new(1, 2, -3, 0, 0);
    /// Impulse, N s.
    pub const IMPULSE: Self = Self::new(1, 1, -1, 0, 0);
    /// Viscous damping per length of a beam, N s/m².
    pub const DAMPING_PER_LENGTH: Self = Self::new(1, -1, -1, 0, 0);
    /// Rotational damping, N m s.
    pub const ROTATIONAL_DAMPING: Self = Self::new(1, 2, -1, 0, 0);
    /// Bending stiffness, N m².
    pub const BENDING_STIFFNESS: Self = Self::new(1, 3, -2, 0, 0);
    /// Mass per length, kg/m.
    pub const MASS_PER_LENGTH: Self = Self::new(1, -1, 0, 0, 0);
    /// Rotatory inertia per length, kg m.
    pub const INERTIA_PER_LENGTH: Self = Self::new(1, 1, 0, 0, 0);
    /// Moment of inertia, kg m².
    pub const INERTIA: Self = Self::new(1, 2, 0, 0, 0);
    /// Stiffness, N/m.
    pub const STIFFNESS: Self = Self::new(1, 0, -2, 0, 0);
    /// Viscous damping, N s/m.
    pub const DAMPING: Self = Self::new(1, 0, -1, 0, 0);

    /// Whether a quantity of dimension `got` is accepted where `self` is expected. An angle needs
    /// the radian; elsewhere the radian counts as dimensionless (N m accepts N m/rad), except in
    /// frequencies: read as cycles, 1 rad/s would be 2π times too high.
    ///
    /// ```
    /// use teeter_text::dimension::Dimension;
    /// assert!(Dimension::ENERGY.accepts(Dimension::new(1, 2, -2, -1, 0)));
    /// assert!(!Dimension::RATE.accepts(Dimension::ANGULAR_VELOCITY));
    /// assert!(!Dimension::ANGULAR_VELOCITY.accepts(Dimension::RATE));
    /// ```
    pub const fn accepts(self, got: Self) -> bool {
        let is_rate = self.kg == 0 && self.m == 0 && self.s == -1 && self.rad == 0 && self.kelvin == 0;
        self.kg == got.kg
            && self.m == got.m
            && self.s == got.s
            && self.kelvin == got.kelvin
            && ((self.rad == 0 && !is_rate) || self.rad == got.rad)
    }

    /// Its common name with the article: "a length", or "a quantity" if it has none.
    pub fn name(self) -> &'static str {
        NAMED
            .iter()
            .find(|dimension_row| dimension_row.dimension == self)
            .map_or("a quantity", |dimension_row| dimension_row.name)
    }

    /// Its SI unit in the syntax that can be read: `m`, `Pa`, `N s/m^2`; in base units if there is
    /// no usual one, and empty for a pure number.
    ///
    /// ```
    /// use teeter_text::dimension::Dimension;
    /// assert_eq!(Dimension::DENSITY.unit(), "kg/m^3");
    /// assert_eq!(Dimension::new(1, 2, 0, 0, -1).unit(), "kg m^2/K");
    /// ```
    pub fn unit(self) -> String {
        if let Some(dimension_row) = NAMED.iter().find(|dimension_row| dimension_row.dimension == self) {
            return dimension_row.unit.to_owned();
        }
        let base = [("kg", self.kg), ("m", self.m), ("s", self.s), ("rad", self.rad), ("K", self.kelvin)];
        let power = |symbol: &str, exponent: i32| match exponent {
            1 => symbol.to_owned(),
            _ => format!("{symbol}^{exponent}"),
        };
        let above: Vec<String> = base
            .iter()
            .filter(|(_, exponent)| *exponent > 0)
            .map(|(symbol, exponent)| power(symbol, i32::from(*exponent)))
            .collect();
        let mut text = if above.is_empty() { "1".to_owned() } else { above.join(" ") };
        for (symbol, exponent) in base.iter().filter(|(_, exponent)| *exponent < 0) {
            text.push('/');
            text.push_str(&power(symbol, -i32::from(*exponent)));
        }
        text
    }

    /// Its most common units, the SI one first; for messages.
    pub fn usual_units(self) -> &'static [&'static str] {
        NAMED
            .iter()
            .find(|dimension_row| dimension_row.dimension == self)
            .map_or(&[], |dimension_row| dimension_row.usual)
    }
}

/// "a length (m)".
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::NONE { f.write_str("a pure number") } else { write!(f, "{} ({})", self.name(), self.unit()) }
    }
}

struct NamedDimension {
    dimension: Dimension,
    name: &'static str,
    unit: &'static str,
    usual: &'static [&'static str],
}

const fn dimension_row(
    dimension: Dimension,
    name: &'static str,
    unit: &'static str,
    usual: &'static [&'static str],
) -> NamedDimension {
    NamedDimension { dimension, name, unit, usual }
}

static NAMED: &[NamedDimension] = &[
    dimension_row(Dimension::NONE, "a pure number", "", &[]),
    dimension_row(Dimension::LENGTH, "a length", "m", &["m", "cm", "mm", "um", "km"]),
    dimension_row(Dimension::MASS, "a mass", "kg", &["kg", "g", "t"]),
    dimension_row(Dimension::TIME, "a time", "s", &["s", "ms", "us", "min", "h"]),
    dimension_row(Dimension::ANGLE, "an angle", "rad", &["rad", "deg", "mrad"]),
    dimension_row(Dimension::TEMPERATURE, "a temperature", "K", &["K"]),
    dimension_row(Dimension::VELOCITY, "a velocity", "m/s", &["m/s", "mm/s", "km/h"]),
    dimension_row(Dimension::ACCELERATION, "an acceleration", "m/s^2", &["m/s^2", "mm/s^2", "gn"]),
    dimension_row(Dimension::ANGULAR_VELOCITY, "an angular velocity", "rad/s", &["rad/s", "deg/s", "rpm"]),
    dimension_row(Dimension::ANGULAR_ACCELERATION, "an angular acceleration", "rad/s^2", &["rad/s^2", "deg/s^2"]),
    dimension_row(Dimension::RATE, "a rate", "1/s", &["1/s", "Hz", "kHz"]),
    dimension_row(Dimension::DENSITY, "a density", "kg/m^3", &["kg/m^3", "g/cm^3", "t/m^3"]),
    dimension_row(Dimension::PRESSURE, "a pressure or elastic modulus", "Pa", &["Pa", "kPa", "MPa", "GPa", "N/mm^2"]),
    dimension_row(Dimension::FORCE, "a force", "N", &["N", "kN", "mN"]),
    dimension_row(Dimension::ENERGY, "an energy or moment", "J", &["J", "N m", "kJ"]),
    dimension_row(Dimension::POWER, "a power", "W", &["W", "kW"]),
    dimension_row(Dimension::IMPULSE, "an impulse", "N s", &["N s"]),
    dimension_row(Dimension::DAMPING_PER_LENGTH, "a viscous damping per length", "N s/m^2", &["N s/m^2", "kg/m/s"]),
    dimension_row(Dimension::STIFFNESS, "a stiffness or force per length", "N/m", &["N/m", "kN/m", "N/mm"]),
    dimension_row(Dimension::DAMPING, "a viscous damping", "N s/m", &["N s/m", "kg/s"]),
    dimension_row(Dimension::ROTATIONAL_DAMPING, "a rotational damping", "N m s", &["N m s"]),
    dimension_row(Dimension::BENDING_STIFFNESS, "a bending stiffness", "N m^2", &["N m^2", "kN m^2"]),
    dimension_row(Dimension::MASS_PER_LENGTH, "a mass per length", "kg/m", &["kg/m", "g/m"]),
    dimension_row(Dimension::INERTIA_PER_LENGTH, "a rotatory inertia per length", "kg m", &["kg m"]),
    dimension_row(Dimension::INERTIA, "a moment of inertia", "kg m^2", &["kg m^2", "g cm^2"]),
    dimension_row(Dimension::new(0, 2, 0, 0, 0), "an area", "m^2", &["m^2", "cm^2", "mm^2"]),
    dimension_row(Dimension::new(0, 3, 0, 0, 0), "a volume", "m^3", &["m^3", "cm^3", "mm^3"]),
];
