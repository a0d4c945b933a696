//! How far a reference is to be trusted before anything is advised by it: past the first impacts of
//! the scene. What comes before them is free motion, or rest, which any setting gets right.

use crate::{Motion, Ruler};

/// A first impact that is to be compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstImpact {
    /// The block's number.
    pub block: usize,
    /// When, s.
    pub t: f64,
    /// How far motions must be compared for it to count, s: to the next impact, or half as long
    /// again as until this one, so that its effect shows.
    pub until: f64,
}

/// How long the motion after an impact is looked at, as a part of the time until it.
const AFTER: f64 = 0.5;

/// The first impact of a block that is the last to be compared; `None` in a scene without impacts.
pub(crate) fn first_impacts(ruler: &Ruler, reference: &Motion, end: f64) -> Option<FirstImpact> {
    let of = |block: usize| {
        let (t, next) = ruler.first_impacts(reference, block)?;
        let until = next.unwrap_or(f64::INFINITY).min((1.0 + AFTER) * t).min(end);
        Some(FirstImpact { block, t, until })
    };
    (0..ruler.blocks()).filter_map(of).reduce(|a, b| if b.until > a.until { b } else { a })
}

impl FirstImpact {
    /// Whether motions that are compared up to the horizon have this impact in them, and what it
    /// did.
    #[must_use]
    pub fn is_within(&self, horizon: f64) -> bool {
        // A sample may fall just short of the end.
        horizon >= self.until * (1.0 - 1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_impact_counts_once_its_effect_has_been_compared() {
        let impact = FirstImpact { block: 0, t: 0.194, until: 0.291 };
        assert!(!impact.is_within(0.2), "6 ms after it the motion is what it was before");
        assert!(impact.is_within(0.291));
    }
}
