//! Measured motion in SI units.

use super::markers::MarkerResidual;
use teeter_scenario::dimension::Dimension;

/// A quantity of a block's motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Channel {
    /// The angle, rad.
    Phi,
    /// The angular velocity, rad/s.
    Omega,
    /// The position of the mass centre, m.
    X,
    /// As `X`, upwards.
    Y,
    /// Its velocity, m/s.
    Vx,
    /// As `Vx`, upwards.
    Vy,
}

impl Channel {
    /// All of them, each position before its rate.
    pub const ALL: [Self; 6] = [Self::Phi, Self::Omega, Self::X, Self::Vx, Self::Y, Self::Vy];

    /// Its name in tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        ["phi", "omega", "x", "y", "vx", "vy"][self as usize]
    }

    /// Its name in sentences.
    #[must_use]
    pub fn title(self) -> &'static str {
        ["Angle φ", "Angular velocity ω", "Position x", "Position y", "Velocity ẋ", "Velocity ẏ"][self as usize]
    }

    /// Its dimension.
    #[must_use]
    pub fn dimension(self) -> Dimension {
        match self {
            Self::Phi => Dimension::ANGLE,
            Self::Omega => Dimension::ANGULAR_VELOCITY,
            Self::X | Self::Y => Dimension::LENGTH,
            Self::Vx | Self::Vy => Dimension::VELOCITY,
        }
    }

    /// Its rate, for a position or the angle.
    #[must_use]
    pub fn rate(self) -> Option<Self> {
        match self {
            Self::Phi => Some(Self::Omega),
            Self::X => Some(Self::Vx),
            Self::Y => Some(Self::Vy),
            _ => None,
        }
    }

    /// Its unit in figures, and the factor from SI units.
    #[must_use]
    pub fn shown(self) -> (&'static str, f64) {
        let degree = 180.0 / std::f64::consts::PI;
        match self {
            Self::Phi => ("°", degree),
            Self::Omega => ("rad/s", 1.0),
            Self::X | Self::Y => ("mm", 1e3),
            Self::Vx | Self::Vy => ("m/s", 1.0),
        }
    }

    /// Whether its origin is arbitrary in a measured motion: a position in the frame of a camera.
    #[must_use]
    pub fn has_own_origin(self) -> bool {
        matches!(self, Self::X | Self::Y)
    }

    /// Whether a view from behind turns its sign.
    pub(super) fn is_mirrored(self) -> bool {
        !matches!(self, Self::Y | Self::Vy)
    }
}

/// From which side the motion was seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sign {
    /// x to the right and φ counter-clockwise, as in the scene.
    #[default]
    AsIs,
    /// From behind: x, φ and their rates have the opposite sign.
    Reversed,
}

impl Sign {
    /// 1 or −1.
    #[must_use]
    pub fn factor(self) -> f64 {
        match self {
            Self::AsIs => 1.0,
            Self::Reversed => -1.0,
        }
    }
}

/// A measured motion as seen from one side.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredMotion {
    /// Times of the rows as in the table, s.
    pub t: Vec<f64>,
    /// The quantities and their values at these times; NaN where a row has none.
    pub channels: Vec<(Channel, Vec<f64>)>,
    /// How well the markers fit, if there are any.
    pub markers: Option<MarkerResidual>,
    /// Whether the angle is measured from that of the first row.
    pub phi_from_first_row: bool,
}

impl MeasuredMotion {
    /// The values of a quantity.
    #[must_use]
    pub fn values(&self, channel: Channel) -> Option<&[f64]> {
        self.channels.iter().find(|(other, _)| *other == channel).map(|(_, values)| values.as_slice())
    }

    /// The quantity by which the motion is aligned in time: the angle, if there is one.
    #[must_use]
    pub fn leading(&self) -> Channel {
        self.channels.first().map_or(Channel::Phi, |(channel, _)| *channel)
    }

    /// The median time between rows, s.
    #[must_use]
    pub fn interval(&self) -> f64 {
        let mut steps: Vec<f64> = self.t.windows(2).map(|t| t[1] - t[0]).collect();
        steps.sort_by(f64::total_cmp);
        steps.get(steps.len() / 2).copied().unwrap_or(0.0)
    }
}
