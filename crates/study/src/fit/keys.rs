//! The keys that are varied, with their bounds.

use crate::sweep::number::WrittenNumber;

/// A key and the range in which its value is sought.
#[derive(Clone, Debug, PartialEq)]
pub struct FitKey {
    key: String,
    /// Bounds in the unit as written.
    low: f64,
    high: f64,
    unit: WrittenNumber,
    logarithmic: bool,
    /// As it was read.
    typed: String,
}

/// From this ratio of the bounds on, a positive range is searched on a logarithmic scale.
const LOGARITHMIC_FROM: f64 = 20.0;

impl FitKey {
    /// Reads `KEY=LOW..HIGH`, such as `contact.feet.restitution=0..0.8` or
    /// `beam.table.thickness=1..2 mm`.
    ///
    /// # Errors
    /// What is wrong with it.
    ///
    /// ```
    /// use teeter_study::fit::FitKey;
    /// assert_eq!(FitKey::read("beam.table.thickness=1..2 mm").unwrap().text(1.5), "1.5 mm");
    /// assert!(FitKey::read("contact.feet.restitution=0.8..0").is_err());
    /// assert!(FitKey::read("time.step=1..5 ms").is_err() && FitKey::read("title=0..1").is_err());
    /// ```
    pub fn read(text: &str) -> Result<Self, String> {
        const EXAMPLE: &str =
            "write KEY=LOW..HIGH, such as contact.feet.restitution=0..0.8 or beam.table.thickness=\"1 mm..2 mm\"";
        let parts = text.split_once('=').and_then(|(key, range)| Some((key.trim(), range.split_once("..")?)));
        let Some((key, (low, high))) = parts.filter(|(key, _)| !key.is_empty()) else {
            return Err(format!("{EXAMPLE}; files come before --vary"));
        };
        if key == "title" || ["output.", "time.", "solver."].iter().any(|table| key.starts_with(table)) {
            return Err(format!(
                "{key} is no property of what was measured: vary keys of blocks, contacts, beams or loads"
            ));
        }
        let number = |text: &str| {
            WrittenNumber::read(text)
                .ok_or_else(|| format!("`{}` is not a number with its unit; {EXAMPLE}", text.trim()))
        };
        let (low, high) = (number(low)?, number(high)?);
        if !low.unit.is_empty() && low.unit != high.unit {
            return Err(format!(
                "the bounds of {key} have the units `{}` and `{}`: give both in the same",
                low.unit, high.unit
            ));
        }
        if !(low.value < high.value) {
            return Err(format!("the lower bound of {key} must be below the upper one"));
        }
        let logarithmic = low.value > 0.0 && high.value / low.value >= LOGARITHMIC_FROM;
        Ok(Self {
            key: key.to_owned(),
            low: low.value,
            high: high.value,
            unit: high,
            logarithmic,
            typed: text.trim().to_owned(),
        })
    }

    /// The path of the key.
    #[must_use]
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Key and range as they were read.
    #[must_use]
    pub fn typed(&self) -> &str {
        &self.typed
    }

    /// The unit of its values, as written; empty for a pure number.
    #[must_use]
    pub fn unit(&self) -> &str {
        &self.unit.unit
    }

    /// Its bounds, in its unit.
    #[must_use]
    pub fn bounds(&self) -> (f64, f64) {
        (self.low, self.high)
    }

    /// A value with its unit, for `--set`.
    #[must_use]
    pub fn text(&self, value: f64) -> String {
        self.unit.text_of(value)
    }

    /// The value at a share of the range from 0 to 1, in its unit.
    pub(super) fn at(&self, share: f64) -> f64 {
        self.beyond(share).clamp(self.low, self.high)
    }

    /// The same beyond the bounds, too.
    pub(super) fn beyond(&self, share: f64) -> f64 {
        if self.logarithmic {
            self.low * (share * (self.high / self.low).ln()).exp()
        } else {
            self.low + share * (self.high - self.low)
        }
    }

    /// The share of the range at a value in its unit; `None` outside it.
    pub(super) fn share(&self, value: f64) -> Option<f64> {
        let inside = value >= self.low && value <= self.high;
        let share = || match self.logarithmic {
            true => (value / self.low).ln() / (self.high / self.low).ln(),
            false => (value - self.low) / (self.high - self.low),
        };
        inside.then(share)
    }

    /// How fast the value changes with the share, in its unit.
    pub(super) fn slope(&self, share: f64) -> f64 {
        if self.logarithmic { self.at(share) * (self.high / self.low).ln() } else { self.high - self.low }
    }
}
