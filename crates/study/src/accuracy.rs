//! The step that reaches an accuracy: found by runs, each of half the step of the one before, and
//! believed only where two finer runs confirm it.
//!
//! The error is that of [`Quantity::Accuracy`], the largest of angles, places and deflections. A
//! step h is taken when the run with it is within the accuracy of the run with h/4, and that with
//! h/2 is nearer: so it converges. Motions that part from a start 1e-12 beside them are compared up
//! to there, the horizon.

use crate::pilots::Pilots;
use crate::reference::NUDGE;
use crate::{Failure, Motion, Quantity, Ruler, Sampling};
use std::sync::atomic::AtomicBool;
use teeter_scenario::scene::Scene;

/// A step that reaches an accuracy, and how it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ChosenStep {
    /// The step, s.
    pub step: f64,
    /// How far a run with it is from one with a quarter of it, or less, before the horizon.
    pub error: f64,
    /// The time up to which they were compared, s.
    pub horizon: f64,
    /// Whether that is the end of the run.
    pub whole: bool,
    /// How many runs it took.
    pub runs: usize,
}

/// Why there is no such step.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoStep {
    /// The scene can't be run.
    #[error(transparent)]
    Failure(#[from] Failure),
    /// The next finer run would take longer than is spent on finding a step.
    #[error(
        "accuracy = {accuracy:e} is not reached: runs with steps of {step:e} s and of a quarter of it are {error:.1e} apart up to t = {horizon:.3} s, and {}; \
         ask for less, or give a step", if *dear { "finer ones would take too long" } else { "finer ones come no nearer, as where corners chatter" }
    )]
    NotReached {
        /// The accuracy asked for.
        accuracy: f64,
        /// The finest step that could be judged, s.
        step: f64,
        /// How far its run was from the finest.
        error: f64,
        /// Up to when they were compared, s.
        horizon: f64,
        /// Whether it ended as finer runs would take too long, rather than as they come no nearer.
        dear: bool,
    },
}

/// Samples of a run, and the least number of its steps.
const SAMPLES: usize = 512;
const LEAST_STEPS: f64 = 64.0;

/// Steps for the time in which a tilted block's motion changes by a factor of e.
const PER_SWING: f64 = 10.0;

/// The finest run takes no longer than this by counted work, s.
const MOST_SECONDS: f64 = 2.0;

/// Of the accuracy, what the error may take up by what is measured.
const ROOM: f64 = 0.9;

/// The finer run is nearer by this factor at least, where both are not near enough anyway.
const NEARER: f64 = 0.75;
const NEAR: f64 = 1e-3;

/// Runs after which those that don't converge are compared up to a horizon.
const PATIENCE: usize = 5;

/// Errors that have not fallen below this part in five halvings won't.
const STALLED: f64 = 0.5;

/// A horizon before this part of the run shows too little of it.
const SHORT: f64 = 0.05;

/// A longer step than the one that was halved to is worth a run of its own from this factor on.
const LONGER: f64 = 1.15;

/// The step that reaches `accuracy` in a scene, with all else as it is.
///
/// # Errors
/// If the scene can't be run, no step that can be afforded reaches it, or the user interrupts.
pub fn step_for(scene: &Scene, accuracy: f64, cancel: &AtomicBool) -> Result<ChosenStep, NoStep> {
    let end = scene.time.end;
    let sampling = Sampling { every: end / SAMPLES as f64, count: SAMPLES + 1 };
    let mut pilots = Pilots { scene, sampling, cancel, most_seconds: MOST_SECONDS, runs: 0 };
    // The runs so far, from long steps to short ones; none where a run didn't come to its end.
    let mut motions: Vec<(f64, Option<Motion>)> = Vec::new();
    let mut step = end / 2_f64.powf((end / longest(scene)).log2().ceil());
    let (mut errors, mut failed) = (Vec::new(), None);
    let mut best = (f64::NAN, f64::INFINITY, end);
    loop {
        let fine = match pilots.run(step, 0.0) {
            Ok(Some(motion)) => Some(motion),
            Ok(None) => {
                let (step, error, horizon) = best;
                // Where nothing could be compared, as no run came to its end, that is what there is
                // to say.
                if let Some(failure) = failed.filter(|_| step.is_nan()) {
                    return Err(NoStep::Failure(failure));
                }
                return Err(NoStep::NotReached { accuracy, step, error, horizon, dear: true });
            }
            Err(failure @ Failure::Ended(_)) => {
                failed = Some(failure);
                None
            }
            Err(failure) => return Err(failure.into()),
        };
        motions.push((step, fine));
        if let [.., (coarse_step, Some(coarse)), (_, Some(middle)), (_, Some(fine))] = motions.as_slice() {
            let mut samples = sampling.count;
            let ruler = Ruler::new(scene, sampling);
            let of = |motion: &Motion, fine: &Motion, samples: usize| {
                ruler.clone().up_to(samples).errors(motion, fine).of(Quantity::Accuracy).unwrap_or(0.0)
            };
            if motions.len() > PATIENCE && !(of(coarse, fine, samples) <= ROOM * accuracy) {
                // As dear as the run beside it, which was not too dear.
                if let Some(nudged) = pilots.run(step, NUDGE)? {
                    samples = ruler.agree(&nudged, fine, accuracy).max(1);
                }
            }
            let horizon = sampling.time(samples - 1);
            let [error, nearer] = [coarse, middle].map(|motion| of(motion, fine, samples));
            best = (*coarse_step, error, horizon);
            errors.push(error);
            if let [.., long_ago, _, _, _, _, last] = errors.as_slice()
                && *last > STALLED * long_ago
            {
                return Err(NoStep::NotReached { accuracy, step: *coarse_step, error, horizon, dear: false });
            }
            let converges = nearer <= NEARER * error || error <= NEAR * accuracy;
            if error <= ROOM * accuracy && converges && horizon >= SHORT * end {
                let before = motions.len().checked_sub(4).and_then(|at| motions[at].1.as_ref());
                let longer = longer(error, before.map(|motion| of(motion, fine, samples)), accuracy, *coarse_step);
                let mut chosen = ChosenStep {
                    step: *coarse_step,
                    error,
                    horizon,
                    whole: samples == sampling.count,
                    runs: pilots.runs,
                };
                if let Some(step) = longer.map(|step| end / (end / step).ceil())
                    && let Some(motion) = pilots.run(step, 0.0)?
                {
                    chosen.runs = pilots.runs;
                    let error = of(&motion, fine, samples);
                    if error <= ROOM * accuracy {
                        (chosen.step, chosen.error) = (step, error);
                    }
                }
                return Ok(chosen);
            }
        }
        // What is not compared any more.
        let old = motions.len().saturating_sub(4);
        if let Some((_, motion)) = motions[..old].last_mut() {
            *motion = None;
        }
        step *= 0.5;
    }
}

/// A step between h and 2h that should do, by the errors of both; `None` if it is hardly longer
/// than h.
fn longer(error: f64, twice: Option<f64>, accuracy: f64, step: f64) -> Option<f64> {
    let order = (twice? / error).log2();
    let factor = (0.8 * accuracy / error).powf(order.recip()).min(1.9);
    // Also false for NaN.
    (order > 0.5 && factor > LONGER).then_some(factor * step)
}

/// The step that a search begins with, s: the motion of a block in it, and some tens of steps in
/// all.
fn longest(scene: &Scene) -> f64 {
    let [x, y] = scene.gravity;
    let gravity = x.hypot(y);
    let swing = |radius: f64| (4.0 * radius / (3.0 * gravity)).sqrt() / PER_SWING;
    let blocks = scene.blocks.iter().map(|block| swing(0.5 * block.width.hypot(block.height)));
    blocks.filter(|step| *step > 0.0).fold(scene.time.end / LEAST_STEPS, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_longer_step_goes_by_the_order() {
        // Second order: an error four times smaller than allowed lets the step double, nearly.
        let step = longer(1e-4, Some(4e-4), 4e-4, 1.0).unwrap();
        assert!((step - 3.2_f64.sqrt()).abs() < 1e-12, "{step}");
        assert_eq!(longer(3.9e-4, Some(1.6e-3), 4e-4, 1.0), None, "hardly longer");
        assert_eq!(longer(1e-4, None, 4e-4, 1.0), None);
        assert_eq!(longer(1e-4, Some(1e-4), 4e-4, 1.0), None, "no order to go by");
    }
}
