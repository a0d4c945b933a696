//! How figures and the page show a run: the width of figures, the units of their axes.

/// How a run is shown; numbers of its tables don't depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Display {
    /// Width of the figures, m.
    pub figure_width: f64,
    /// Unit of lengths on axes.
    pub length: LengthUnit,
    /// Unit of angles on axes.
    pub angle: AngleUnit,
}

impl Default for Display {
    fn default() -> Self {
        Self { figure_width: 0.12, length: LengthUnit::Metre, angle: AngleUnit::Degree }
    }
}

/// A unit of length on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LengthUnit {
    /// mm.
    Millimetre,
    /// cm.
    Centimetre,
    /// m.
    Metre,
}

impl LengthUnit {
    /// All, with what a scene calls them, the smallest first.
    pub const ALL: [(&'static str, Self); 3] = [("mm", Self::Millimetre), ("cm", Self::Centimetre), ("m", Self::Metre)];

    /// What a scene calls it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
        }
    }

    /// How many of it are a metre.
    #[must_use]
    pub fn per_metre(self) -> f64 {
        match self {
            Self::Millimetre => 1e3,
            Self::Centimetre => 1e2,
            Self::Metre => 1.0,
        }
    }
}

/// A unit of angle on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AngleUnit {
    /// °.
    Degree,
    /// mrad.
    Milliradian,
    /// rad.
    Radian,
}

impl AngleUnit {
    /// All, with what a scene calls them.
    pub const ALL: [(&'static str, Self); 3] =
        [("deg", Self::Degree), ("mrad", Self::Milliradian), ("rad", Self::Radian)];

    /// What a scene calls it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Degree => "deg",
            Self::Milliradian => "mrad",
            Self::Radian => "rad",
        }
    }

    /// What an axis calls it.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Degree => "°",
            Self::Milliradian => "mrad",
            Self::Radian => "rad",
        }
    }

    /// How many of it are a radian.
    #[must_use]
    pub fn per_radian(self) -> f64 {
        match self {
            Self::Degree => 1f64.to_degrees(),
            Self::Milliradian => 1e3,
            Self::Radian => 1.0,
        }
    }
}

/// The unit that the quantities in a scene's text use most, of these; `None` where it uses none of them.
pub(crate) fn most_used<U: Copy>(text: &str, all: &[(&'static str, U)]) -> Option<U> {
    let code = text.lines().filter(|line| !line.trim_start().starts_with('#'));
    let quoted = code.flat_map(|line| line.split(['"', '\'']).skip(1).step_by(2));
    let mut counts = vec![0_usize; all.len()];
    for text in quoted {
        let number = text.trim_start().trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE".contains(c));
        // Zero is zero in any unit.
        let zero = text.trim_start().trim_start_matches(['0', '.', '-', '+']).trim_start() == number.trim_start();
        if number.len() == text.trim_start().len() || zero {
            continue;
        }
        if let Some(place) = all.iter().position(|(word, _)| *word == number.trim()) {
            counts[place] += 1;
        }
    }
    // Of units used as often the larger one, which comes later.
    let (place, count) = counts.into_iter().enumerate().max_by_key(|(_, count)| *count)?;
    (count > 0).then(|| all[place].1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_is_the_one_that_the_scene_uses_most() {
        let text = "width = \"36 cm\"\nheight = '2.5cm' # \"3 mm\"\nposition = [\"0 m\", \"0 m\"]\n# \"1 m\" \"2 m\" \"3 m\"\n\
                    stiffness = \"3 N/m\"\nlength = \"1e-3 m\"\ntilt = \"5 deg\"";
        assert_eq!(most_used(text, &LengthUnit::ALL), Some(LengthUnit::Centimetre));
        assert_eq!(most_used(text, &AngleUnit::ALL), Some(AngleUnit::Degree));
        assert_eq!(most_used("title = 'm'\nspin = '2 rad/s'", &LengthUnit::ALL), None);
        assert_eq!(most_used("spin = '2 rad/s'", &AngleUnit::ALL), None);
        assert_eq!(most_used("a = '1 m'\nb = '1 mm'", &LengthUnit::ALL), Some(LengthUnit::Metre));
    }

    #[test]
    fn every_unit_is_found_by_its_word() {
        assert!(LengthUnit::ALL.iter().all(|(word, unit)| unit.word() == *word));
        assert!(AngleUnit::ALL.iter().all(|(word, unit)| unit.word() == *word));
    }
}
