//! The least horizon for advice: beyond the first impacts of the scene. Before these there is only
//! free motion, or rest, which any setting gets right.

use crate::{ErrorNorms, SampledMotion};

/// A first impact that must be compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstImpact {
    /// The block's number.
    pub block: usize,
    /// Its time, s.
    pub t: f64,
    /// Time up to which motions must be compared to see its effect, s: the next impact, or half as
    /// long again as until this one.
    pub until: f64,
}

/// How long the motion after an impact is compared, as a fraction of the time until it.
const AFTER: f64 = 0.5;

/// The first impact of a block that must be compared for the longest time; `None` in a scene
/// without impacts.
pub(crate) fn first_impacts(norms: &ErrorNorms, reference: &SampledMotion, end: f64) -> Option<FirstImpact> {
    let of = |block: usize| {
        let (t, next) = norms.first_impacts(reference, block)?;
        let until = next.unwrap_or(f64::INFINITY).min((1.0 + AFTER) * t).min(end);
        Some(FirstImpact { block, t, until })
    };
    (0..norms.blocks()).filter_map(of).reduce(|a, b| if b.until > a.until { b } else { a })
}

impl FirstImpact {
    /// Whether this impact and its effect are before the horizon.
    #[must_use]
    pub fn is_within(&self, horizon: f64) -> bool {
        // The last sample may be just before the end.
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
