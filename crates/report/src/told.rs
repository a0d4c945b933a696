//! Words and numbers that the terminal and the page tell alike.

use crate::Summary;
use teeter_scenario::scene::{BlockScene, Scene};

/// A penetration below this part of the largest block is rounding, of positions and of what holds a pile: of a block of a metre less than an atom.
const ROUNDING: f64 = 1e-10;

/// Warnings that steps are too long for the motion to be relied on, beside all that begin with `under-resolved`.
const TOO_COARSE: [&str; 2] = ["deep-penetration", "far-turn"];

/// What of a scene decides how its numbers are told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Told {
    /// What an impact is of.
    strikers: &'static str,
    /// Lengths up to this are told as 0, m.
    rounding: f64,
    /// The deepest penetration at the end, m.
    last_penetration: f64,
}

impl Told {
    pub(crate) fn of(scene: &Scene, last_penetration: f64) -> Self {
        let is_sharp = |block: &BlockScene| match &block.parts {
            None => block.corner_count() > 2,
            Some(parts) => parts.iter().all(|part| part.shape.core().len() > 2 && part.shape.radius() == 0.0),
        };
        let strikers = match () {
            () if scene.blocks.iter().all(is_sharp) => " (each corner counts)",
            () => " (each point counts)",
        };
        let largest = scene.blocks.iter().map(BlockScene::radius).filter(|reach| reach.is_finite()).fold(0.0, f64::max);
        Self { strikers, rounding: ROUNDING * largest, last_penetration }
    }
}

impl Summary {
    /// How impacts are counted, in words after their number: each corner that strikes is one, so that a block that lands flat has two. Other words
    /// where there are round blocks; none where there are no impacts. On springs they are landings, which are counted alike.
    #[must_use]
    pub fn strikers(&self) -> &'static str {
        if self.impact_count > 0 { self.told.strikers } else { "" }
    }

    /// What the sentence on what became of the scene has to be read with, if steps are too long for that to be relied on.
    #[must_use]
    pub fn reserve(&self) -> Option<&'static str> {
        let is_too_coarse = |code: &str| code.starts_with("under-resolved") || TOO_COARSE.contains(&code);
        self.warnings.iter().any(|warning| is_too_coarse(&warning.code)).then_some("see the warnings")
    }

    /// The deepest penetration as it is told, m: 0 where it is no more than rounding.
    #[must_use]
    pub fn told_penetration(&self) -> f64 {
        if self.max_penetration > self.told.rounding { self.max_penetration } else { 0.0 }
    }

    /// What is told beside it of the penetration at the end, in words, with lengths (m) `told` as that is: the deepest one may have been one in passing, or be there for good. Nothing of one
    /// that is gone, or less than a hundredth of the deepest.
    #[must_use]
    pub fn penetration_at_end(&self, told: impl Fn(f64) -> String) -> Option<String> {
        let (deepest, last) = (self.told_penetration(), self.told.last_penetration);
        (last > self.told.rounding.max(0.01 * deepest)).then(|| match told(last) == told(deepest) {
            true => "still there at the end".to_owned(),
            false => format!("{} at the end", told(last)),
        })
    }
}
