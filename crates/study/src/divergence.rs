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
    let mut runs = runs_of(scene, cancel);
    let step = scene.time.step;
    let (own, beside, finer) =
        (run(&mut runs, step, 0.0)?, run(&mut runs, step, PERTURBATION)?, run(&mut runs, 0.5 * step, 0.0)?);
    let norms = ErrorNorms::new(scene, runs.sampling);
    let until = |other: &SampledMotion| agree_until(&norms, runs.sampling, end, other, &own);
    Ok(Divergence { by_start: until(&beside), by_step: until(&finer), end })
}

/// A shorter step, and up to when the motion is predictable with it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FinerStep {
    /// The step, s.
    pub step: f64,
    /// Up to when the motion is predictable, s.
    pub horizon: f64,
}

/// How often the step is halved to find one with a longer horizon.
const HALVINGS: usize = 3;
/// A horizon longer by less than this factor isn't worth a shorter step.
const LONGER: f64 = 1.2;

/// The longest of a few shorter steps with which the motion of a scene is predictable up to `enough` (s), or else that which
/// is predictable for longest; `None` if that is hardly longer than with the scene's own step, or isn't limited by it.
///
/// # Errors
/// As [`divergence`].
pub(crate) fn finer_step(
    scene: &Scene,
    own: &Divergence,
    enough: f64,
    cancel: &Arc<AtomicBool>,
) -> Result<Option<FinerStep>, Failure> {
    let wanted = enough.min(own.by_start);
    if own.by_step >= wanted {
        return Ok(None);
    }
    let mut runs = runs_of(scene, cancel);
    let norms = ErrorNorms::new(scene, runs.sampling);
    let mut step = 0.5 * scene.time.step;
    let mut motion = run(&mut runs, step, 0.0)?;
    let mut best: Option<FinerStep> = None;
    for _ in 0..HALVINGS {
        let finer = run(&mut runs, 0.5 * step, 0.0)?;
        let horizon = agree_until(&norms, runs.sampling, own.end, &finer, &motion).min(own.by_start);
        if best.is_none_or(|best| horizon > best.horizon) {
            best = Some(FinerStep { step, horizon });
        }
        if horizon >= wanted {
            break;
        }
        (step, motion) = (0.5 * step, finer);
    }
    Ok(best.filter(|best| best.horizon >= LONGER * own.horizon()))
}

fn runs_of<'a>(scene: &'a Scene, cancel: &'a Arc<AtomicBool>) -> TrialRuns<'a> {
    let sampling = Sampling { every: scene.time.end / SAMPLES as f64, count: SAMPLES + 1 };
    // The length of runs is not limited here.
    TrialRuns { scene, sampling, cancel, most_seconds: f64::INFINITY, runs: 0 }
}

fn run(runs: &mut TrialRuns<'_>, step: f64, perturbation: f64) -> Result<SampledMotion, Failure> {
    runs.run(step, perturbation).map(Option::unwrap_or_default)
}

/// Up to when two motions agree within [`DIVERGED`], s. It is relative to the larger of the two: a body that doesn't turn by
/// itself may turn when perturbed.
fn agree_until(norms: &ErrorNorms, sampling: Sampling, end: f64, a: &SampledMotion, b: &SampledMotion) -> f64 {
    match norms.agree(a, b, DIVERGED).min(norms.agree(b, a, DIVERGED)) {
        all if all >= sampling.count => end,
        samples => sampling.time(samples.saturating_sub(1)),
    }
}
