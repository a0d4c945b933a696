//! Measured motion in SI units.

use super::markers::MarkerResidual;
use super::smooth::local_fit;
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

    /// That unit as it stands after a number: the sign of degrees follows at once, others after `blank`.
    #[must_use]
    pub fn shown_after(self, blank: &str) -> String {
        match self.shown() {
            ("°", _) => "°".to_owned(),
            (unit, _) => format!("{blank}{unit}"),
        }
    }

    /// Whether its origin is arbitrary in a measured motion: a position in the frame of a camera.
    #[must_use]
    pub fn has_own_origin(self) -> bool {
        matches!(self, Self::X | Self::Y)
    }

    /// Whether a view from behind turns its sign.
    pub(crate) fn is_mirrored(self) -> bool {
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

/// An angle that spreads over so many standard deviations of its noise aligns a motion.
const CLEAR_SIGNAL: f64 = 10.0;
/// What spreads over less than so many shows nothing.
const LEAST_SIGNAL: f64 = 3.0;
/// Rows of the window by which noise is estimated.
const NOISE_WINDOW: usize = 7;

/// A measured motion as seen from one side.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredMotion {
    /// Times of the rows as in the table, s.
    pub t: Vec<f64>,
    /// The lines of the table that hold them.
    pub lines: Vec<usize>,
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

    /// The quantity by which the motion is aligned in time: the angle, if it rises clearly above its
    /// noise, else the quantity that does so most. Of a block that falls flat, the angle is noise.
    #[must_use]
    pub fn leading(&self) -> Channel {
        let angle = self.channels.iter().find(|(channel, _)| *channel == Channel::Phi);
        match angle {
            Some((_, values)) if self.channels.len() == 1 || self.signal(values) >= CLEAR_SIGNAL => Channel::Phi,
            // Of too few rows the noise isn't known.
            _ => self
                .clearest(|_| true, 0.0)
                .or(self.channels.first().map(|(channel, _)| *channel))
                .unwrap_or(Channel::Phi),
        }
    }

    /// The quantity that tells best from which side the motion was seen; `None` if all that would are noise.
    pub(crate) fn telling_side(&self) -> Option<Channel> {
        self.clearest(Channel::is_mirrored, LEAST_SIGNAL)
    }

    /// Of some quantities, that which rises most above its noise, if any does by this factor.
    fn clearest(&self, of: impl Fn(Channel) -> bool, least: f64) -> Option<Channel> {
        let candidates = self.channels.iter().filter(|(channel, _)| of(*channel));
        let mut best: Option<(f64, Channel)> = None;
        for (channel, values) in candidates {
            let signal = self.signal(values);
            if signal >= least && best.is_none_or(|(most, _)| signal > most) {
                best = Some((signal, *channel));
            }
        }
        best.map(|(_, channel)| channel)
    }

    /// The standard deviation of values over that of their noise; 0 if they are all the same.
    fn signal(&self, values: &[f64]) -> f64 {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let n = (finite().count() as f64).max(1.0);
        let mean = finite().sum::<f64>() / n;
        let spread = (finite().map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt();
        if spread > 0.0 { spread / local_fit(&self.t, values, NOISE_WINDOW).noise } else { 0.0 }
    }

    /// The median time between rows, s.
    #[must_use]
    pub fn interval(&self) -> f64 {
        let mut steps: Vec<f64> = self.t.windows(2).map(|t| t[1] - t[0]).collect();
        steps.sort_by(f64::total_cmp);
        steps.get(steps.len() / 2).copied().unwrap_or(0.0)
    }
}
