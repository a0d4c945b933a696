//! Up to when the motion of a scene is predictable: until runs with a perturbed initial state or
//! half the step diverge from it.

use crate::reference::PERTURBATION;
use crate::trial_runs::TrialRuns;
use crate::{ErrorNorms, Failure, SampledMotion, Sampling};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_scenario::scene::Scene;

/// Motions have diverged when they differ by this share of the largest angle, of a block's largest
/// side, or of the largest deflection.
pub const DIVERGED: f64 = 1e-2;

/// Samples of a run.
const SAMPLES: usize = 2048;

/// Up to when the motion of a scene is predictable.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Divergence {
    /// Up to when a run with an initial state perturbed by [`PERTURBATION`] agrees, s.
    pub by_start: f64,
    /// Up to when a run with half the step agrees, s.
    pub by_step: f64,
    /// The end of the run, s.
    pub end: f64,
}

impl Divergence {
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

/// Finds, by three runs, up to when the motion of a scene stays within [`DIVERGED`] of that with an
/// initial state perturbed by [`PERTURBATION`], and of that with half the step.
///
/// # Errors
/// If a run doesn't come to its end, or the user interrupts.
pub fn divergence(scene: &Scene, cancel: &Arc<AtomicBool>) -> Result<Divergence, Failure> {
    let end = scene.time.end;
    let sampling = Sampling { every: end / SAMPLES as f64, count: SAMPLES + 1 };
    let mut trials = TrialRuns { scene, sampling, cancel, most_seconds: f64::INFINITY, runs: 0 };
    let mut run = |step: f64, perturbation: f64| {
        // The length of runs is not limited here.
        trials.run(step, perturbation).map(Option::unwrap_or_default)
    };
    let step = scene.time.step;
    let (own, beside, finer) = (run(step, 0.0)?, run(step, PERTURBATION)?, run(0.5 * step, 0.0)?);
    let norms = ErrorNorms::new(scene, sampling);
    // Relative to the larger of the two motions: a body that doesn't turn by itself may turn when
    // perturbed.
    let agree = |other: &SampledMotion| norms.agree(other, &own, DIVERGED).min(norms.agree(&own, other, DIVERGED));
    let until = |other: &SampledMotion| match agree(other) {
        all if all >= sampling.count => end,
        samples => sampling.time(samples.saturating_sub(1)),
    };
    Ok(Divergence { by_start: until(&beside), by_step: until(&finer), end })
}
