//! Until when the motion of a scene can be told: runs from beside its start and with half its step
//! part from it there.

use crate::pilots::Pilots;
use crate::reference::NUDGE;
use crate::{Failure, Motion, Ruler, Sampling};
use std::sync::atomic::AtomicBool;
use teeter_scenario::scene::Scene;

/// Motions have parted where they differ by this share of the largest angle, of a block's largest
/// side, or of the largest deflection.
pub const PARTED: f64 = 1e-2;

/// Samples of a run.
const SAMPLES: usize = 2048;

/// Until when the motion of a scene can be told.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Parting {
    /// Until when a run from a start [`NUDGE`] beside it stays with the motion, s.
    pub by_start: f64,
    /// Until when a run with half the step does, s.
    pub by_step: f64,
    /// The end of the run, s.
    pub end: f64,
}

impl Parting {
    /// The earlier of the two, s.
    #[must_use]
    pub fn horizon(&self) -> f64 {
        self.by_start.min(self.by_step)
    }

    /// Whether that is the end of the run.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.horizon() >= self.end
    }
}

/// Finds until when the motion of a scene stays within [`PARTED`] of those from a start [`NUDGE`]
/// beside it and with half the step, by three runs.
///
/// # Errors
/// If a run doesn't come to its end, or the user interrupts.
pub fn parting(scene: &Scene, cancel: &AtomicBool) -> Result<Parting, Failure> {
    let end = scene.time.end;
    let sampling = Sampling { every: end / SAMPLES as f64, count: SAMPLES + 1 };
    let mut pilots = Pilots { scene, sampling, cancel, most_seconds: f64::INFINITY, runs: 0 };
    let mut run = |step: f64, nudge: f64| {
        // No run is too long here.
        pilots.run(step, nudge).map(Option::unwrap_or_default)
    };
    let step = scene.time.step;
    let (own, beside, finer) = (run(step, 0.0)?, run(step, NUDGE)?, run(0.5 * step, 0.0)?);
    let ruler = Ruler::new(scene, sampling);
    // Relative to the larger of both: what doesn't turn by itself may where it starts beside
    // itself.
    let agree = |other: &Motion| ruler.agree(other, &own, PARTED).min(ruler.agree(&own, other, PARTED));
    let until = |other: &Motion| match agree(other) {
        all if all >= sampling.count => end,
        samples => sampling.time(samples.saturating_sub(1)),
    };
    Ok(Parting { by_start: until(&beside), by_step: until(&finer), end })
}
