//! Finds the step that reaches an accuracy, by runs that each halve the step of the one before,
//! until two finer runs confirm it; or, if the errors decrease regularly over five steps, by
//! extrapolation, confirmed by one finer run.
//!
//! The error is that of [`Quantity::Accuracy`], the largest of angles, positions and deflections. A
//! step h is accepted if its run agrees with that of h/4 to the accuracy, and that of h/2 is
//! nearer, or all three agree to half the accuracy. Alternatively, if the last five runs show
//! errors of second order, a step down to a sixteenth of the finest is extrapolated, and checked
//! against a run with half of it. Runs that agree because all of them cut the same bounces short
//! before a landing prove nothing: they are compared only up to the landing. Motions that diverge
//! from a run with a perturbed initial state are compared only up to there, the horizon.

use crate::reference::PERTURBATION;
use crate::trial_runs::TrialRuns;
use crate::{ErrorNorms, Failure, Quantity, SampledMotion, Sampling};
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_scenario::scene::Scene;

/// A step that reaches an accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ChosenStep {
    /// The step, s.
    pub step: f64,
    /// Error of its run relative to one with a quarter of the step, or less, before the horizon;
    /// or, by extrapolation, four thirds of the difference from a run with half the step.
    pub error: f64,
    /// Which of the two applies.
    pub basis: ErrorBasis,
    /// The time up to which they were compared, s.
    pub horizon: f64,
    /// Whether that is the end of the run.
    pub whole: bool,
    /// Number of runs needed.
    pub runs: usize,
}

/// How the error of a [`ChosenStep`] is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorBasis {
    /// By runs with a half and a quarter of the step.
    FinerRuns,
    /// By a run with half the step, after longer ones showed errors of second order.
    Order,
}

/// Why there is no such step.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoStep {
    /// The scene can't be run.
    #[error(transparent)]
    Failure(#[from] Failure),
    /// No step was found: the next finer run would take too long, or runs don't converge.
    #[error(
        "accuracy = {accuracy:e} is not reached: runs with steps of {step:e} s and a quarter of that differ by {error:.1e} up to t = {horizon:.3} s, and {}; \
         use a larger accuracy value, or give a step", if *too_expensive { "finer ones would take too long" } else { "finer ones don't converge, as when corners chatter" }
    )]
    NotReached {
        /// The requested accuracy.
        accuracy: f64,
        /// The finest step that could be checked, s.
        step: f64,
        /// Difference of its run from the finest.
        error: f64,
        /// Up to when they were compared, s.
        horizon: f64,
        /// Whether finer runs would take too long; otherwise they don't converge.
        too_expensive: bool,
    },
}

/// Samples of a run, and its least number of steps.
const SAMPLES: usize = 512;
const LEAST_STEPS: f64 = 64.0;

/// Steps per time in which a tilted block's motion changes by a factor of e.
const PER_SWING: f64 = 10.0;

/// Longest time of the finest run, by counted work, s.
const MOST_SECONDS: f64 = 2.0;

/// Largest measured error relative to the accuracy.
const ROOM: f64 = 0.9;

/// The error of the finer run must be smaller by this factor, unless both are below `ALIKE` times
/// the accuracy, where errors may scatter.
const NEARER: f64 = 0.75;
const ALIKE: f64 = 0.5;

/// Number of runs after which those that don't converge are compared only up to a horizon.
const PATIENCE: usize = 5;

/// The same for runs with a landing that depends on bounces cut short: shorter steps cut less.
const PATIENCE_WITH_BOUNCES: usize = 8;

/// If errors haven't decreased to this fraction in five halvings, the search is abandoned.
const STALLED: f64 = 0.5;

/// A horizon before this fraction of the run is too short.
const SHORT: f64 = 0.05;

/// Errors count as second order if three consecutive halvings show orders in the first range, and
/// an average in the second.
const REGULAR: RangeInclusive<f64> = 1.2..=2.8;
const ON_AVERAGE: RangeInclusive<f64> = 1.7..=2.3;

/// Steps are extrapolated down to this fraction of the finest one tried.
const FURTHEST: f64 = 1.0 / 16.0;

/// After a failed extrapolation the next one must be shorter by this factor.
const SHORTER: f64 = 0.7;

/// A longer step is tried if it is longer by at least this factor.
const LONGER: f64 = 1.15;

/// The step that reaches `accuracy` in a scene, with everything else unchanged.
///
/// # Errors
/// If the scene can't be run, no affordable step reaches it, or the user interrupts.
pub fn step_for(scene: &Scene, accuracy: f64, cancel: &Arc<AtomicBool>) -> Result<ChosenStep, NoStep> {
    let mut search = StepSearch::new(scene, accuracy, cancel);
    loop {
        search.run()?;
        if let Some(chosen) = search.judge()? {
            return Ok(chosen);
        }
        search.halve();
    }
}

/// A search that halves the step in each round.
struct StepSearch<'a> {
    scene: &'a Scene,
    accuracy: f64,
    sampling: Sampling,
    trials: TrialRuns<'a>,
    /// The steps (s) and runs so far, from long steps to short ones; `None` for a run that didn't
    /// come to its end, or is no longer compared.
    motions: Vec<(f64, Option<SampledMotion>)>,
    /// Steps of the current run.
    count: f64,
    /// Errors found so far.
    errors: Vec<f64>,
    failed: Option<Failure>,
    /// Step, error and horizon of the last comparison.
    last: (f64, f64, f64),
    /// The step that was extrapolated last, and whose error proved too large.
    refuted: f64,
}

impl<'a> StepSearch<'a> {
    fn new(scene: &'a Scene, accuracy: f64, cancel: &'a Arc<AtomicBool>) -> Self {
        let end = scene.time.end;
        let sampling = Sampling { every: end / SAMPLES as f64, count: SAMPLES + 1 };
        Self {
            scene,
            accuracy,
            sampling,
            trials: TrialRuns { scene, sampling, cancel, most_seconds: MOST_SECONDS, runs: 0 },
            motions: Vec::new(),
            // An odd number of steps, and one more than twice as many in the next run: halves of a
            // run, quarters … would be at ends of steps in all of them, and events there, such as
            // the start of a load, would look more accurate than elsewhere.
            count: 2.0 * (0.5 * end / longest(scene)).ceil() + 1.0,
            errors: Vec::new(),
            failed: None,
            last: (f64::NAN, f64::INFINITY, end),
            refuted: f64::INFINITY,
        }
    }

    fn end(&self) -> f64 {
        self.scene.time.end
    }

    /// The error of a motion against a finer one, over this number of samples.
    fn error(&self, motion: &SampledMotion, fine: &SampledMotion, samples: usize) -> f64 {
        let norms = ErrorNorms::new(self.scene, self.sampling).up_to(samples);
        norms.errors(motion, fine).of(Quantity::Accuracy).unwrap_or(0.0)
    }

    /// Runs the scene with the current step.
    fn run(&mut self) -> Result<(), NoStep> {
        let step = self.end() / self.count;
        let motion = match self.trials.run(step, 0.0) {
            Ok(Some(motion)) => Some(motion),
            Ok(None) => {
                let (step, error, horizon) = self.last;
                // If nothing could be compared because no run came to its end, report that.
                if let Some(failure) = self.failed.take().filter(|_| step.is_nan()) {
                    return Err(NoStep::Failure(failure));
                }
                return Err(NoStep::NotReached { accuracy: self.accuracy, step, error, horizon, too_expensive: true });
            }
            Err(failure @ Failure::Ended(_)) => {
                self.failed = Some(failure);
                None
            }
            Err(failure) => return Err(failure.into()),
        };
        self.motions.push((step, motion));
        Ok(())
    }

    /// Continues with half the step, and drops the run that is no longer compared.
    fn halve(&mut self) {
        let old = self.motions.len().saturating_sub(5);
        if let Some((_, motion)) = self.motions[..old].last_mut() {
            *motion = None;
        }
        self.count = 2.0 * self.count + 1.0;
    }

    /// The chosen step, if the runs so far justify one.
    fn judge(&mut self) -> Result<Option<ChosenStep>, NoStep> {
        let Some(samples) = self.compared_samples()? else { return Ok(None) };
        if samples == self.sampling.count
            && let Some(chosen) = self.extrapolated(samples)?
        {
            return Ok(Some(chosen));
        }
        self.confirmed(samples)
    }

    /// Up to which sample the last three runs are compared; `None` if they can't be yet.
    fn compared_samples(&mut self) -> Result<Option<usize>, NoStep> {
        let [.., (_, Some(coarse)), (_, Some(_)), (step, Some(fine))] = self.motions.as_slice() else {
            return Ok(None);
        };
        let mut samples = self.sampling.count;
        if self.motions.len() > PATIENCE && !(self.error(coarse, fine, samples) <= ROOM * self.accuracy) {
            // As expensive as the run that it is compared with, which was affordable.
            if let Some(perturbed) = self.trials.run(*step, PERTURBATION)? {
                let norms = ErrorNorms::new(self.scene, self.sampling);
                samples = norms.agree(&perturbed, fine, self.accuracy).max(1);
            }
        }
        // A scheme with its own steps follows bounces further than these steps suggest.
        if let Some(t) = fine.contested.filter(|_| !self.scene.time.scheme.has_own_steps()) {
            if self.motions.len() <= PATIENCE_WITH_BOUNCES {
                return Ok(None);
            }
            samples = samples.min((t / self.sampling.every).ceil() as usize).max(1);
        }
        Ok(Some(samples))
    }

    /// A step extrapolated from the last five runs, if their errors are of second order and a run
    /// with half of it confirms it.
    fn extrapolated(&mut self, samples: usize) -> Result<Option<ChosenStep>, NoStep> {
        let [.., (_, Some(a)), (_, Some(b)), (_, Some(c)), (_, Some(d)), (step, Some(e))] = self.motions.as_slice()
        else {
            return Ok(None);
        };
        let apart = [(a, b), (b, c), (c, d), (d, e)].map(|(coarse, fine)| self.error(coarse, fine, samples));
        let step = by_order(apart, self.accuracy).map(|factor| factor * step);
        let Some(step) = step.filter(|step| *step < SHORTER * self.refuted) else { return Ok(None) };
        let end = self.end();
        let count = (end / step).ceil();
        let run = self.trials.run(end / count, 0.0)?;
        let finer = self.trials.run(end / (2.0 * count + 1.0), 0.0)?;
        let error = run.zip(finer).map(|(run, finer)| 4.0 / 3.0 * self.error(&run, &finer, samples));
        if let Some(error) = error.filter(|error| *error <= self.accuracy) {
            let (step, runs, basis) = (end / count, self.trials.runs, ErrorBasis::Order);
            return Ok(Some(ChosenStep { step, error, basis, horizon: end, whole: true, runs }));
        }
        self.refuted = step;
        Ok(None)
    }

    /// The step of the coarsest of the last three runs, if the other two confirm it.
    fn confirmed(&mut self, samples: usize) -> Result<Option<ChosenStep>, NoStep> {
        let [.., (step, Some(coarse)), (_, Some(middle)), (_, Some(fine))] = self.motions.as_slice() else {
            return Ok(None);
        };
        let (step, horizon, accuracy) = (*step, self.sampling.time(samples - 1), self.accuracy);
        let [error, nearer] = [coarse, middle].map(|motion| self.error(motion, fine, samples));
        self.last = (step, error, horizon);
        self.errors.push(error);
        if let [.., long_ago, _, _, _, _, last] = self.errors.as_slice()
            && *last > STALLED * long_ago
        {
            return Err(NoStep::NotReached { accuracy, step, error, horizon, too_expensive: false });
        }
        let converges = nearer <= NEARER * error || error.max(nearer) <= ALIKE * accuracy;
        if !(error <= ROOM * accuracy && converges && horizon >= SHORT * self.end()) {
            return Ok(None);
        }
        let (whole, runs) = (samples == self.sampling.count, self.trials.runs);
        let mut chosen = ChosenStep { step, error, basis: ErrorBasis::FinerRuns, horizon, whole, runs };
        let before = self.motions.len().checked_sub(4).and_then(|at| self.motions[at].1.as_ref());
        let twice = before.map(|motion| self.error(motion, fine, samples));
        let end = self.end();
        if let Some(step) = longer(error, twice, accuracy, step).map(|step| end / (end / step).ceil())
            && let Some(motion) = self.trials.run(step, 0.0)?
        {
            chosen.runs = self.trials.runs;
            let error = self.error(&motion, fine, samples);
            if error <= ROOM * accuracy {
                (chosen.step, chosen.error) = (step, error);
            }
        }
        Ok(Some(chosen))
    }
}

/// The extrapolated step, as a multiple of the finest of five steps that each halve the one before,
/// from the differences `apart` of successive runs. `None` if these don't decrease regularly, or if
/// the step is too short to extrapolate.
fn by_order(apart: [f64; 4], accuracy: f64) -> Option<f64> {
    let orders = [0, 1, 2].map(|k| (apart[k] / apart[k + 1]).log2());
    let mean = orders.iter().sum::<f64>() / 3.0;
    if !(orders.iter().all(|order| REGULAR.contains(order)) && ON_AVERAGE.contains(&mean)) {
        return None;
    }
    // The error of the finest step, with the largest factor of h² found: the factor depends on the
    // positions of events within their steps.
    let found = [0, 1, 2, 3].map(|k| apart[k] * 0.25_f64.powi(3 - k as i32) / 3.0);
    let (least, most) = found.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), e| (least.min(*e), most.max(*e)));
    // If the factors differ much, there may be larger ones.
    let error = most * (most / least).sqrt();
    // No longer than the longest step.
    let factor = (ROOM * accuracy / error).sqrt().min(16.0);
    (factor >= FURTHEST).then_some(factor)
}

/// A step between h and 2h that should reach the accuracy, by the errors of both; `None` if it is
/// hardly longer than h.
fn longer(error: f64, twice: Option<f64>, accuracy: f64, step: f64) -> Option<f64> {
    let order = (twice? / error).log2();
    let factor = (0.8 * accuracy / error).powf(order.recip()).min(1.9);
    // Also false for NaN.
    (order > 0.5 && factor > LONGER).then_some(factor * step)
}

/// The first step of a search, s: short enough for the motion of a block, and for some tens of
/// steps in the run.
fn longest(scene: &Scene) -> f64 {
    let [x, y] = scene.gravity;
    let gravity = x.hypot(y);
    let swing = |radius: f64| (4.0 * radius / (3.0 * gravity)).sqrt() / PER_SWING;
    let blocks = scene.blocks.iter().map(|block| swing(block.radius()));
    blocks.filter(|step| *step > 0.0).fold(scene.time.end / LEAST_STEPS, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_runs_of_second_order_tell_what_a_shorter_step_does() {
        // e = h² for h = 16, 8, 4, 2, 1: apart by 192, 48, 12, 3.
        let factor = by_order([192.0, 48.0, 12.0, 3.0], 1e-2 / ROOM).unwrap();
        assert!((factor - 0.1).abs() < 1e-12, "{factor}");
        assert_eq!(by_order([192.0, 48.0, 24.0, 3.0], 2e-2), None, "of no order from one halving to the next");
        // The worst of them counts, and more than that.
        let factor = by_order([192.0, 48.0, 18.0, 3.0], 1e-2 * 1.5_f64.powf(1.5) / ROOM).unwrap();
        assert!((factor - 0.1).abs() < 1e-12, "{factor}");
        assert_eq!(by_order([192.0, 48.0, 12.0, 3.0], 1e-3), None, "too far from what was tried");
        assert_eq!(by_order([16.0, 8.0, 4.0, 2.0], 1e-2), None, "of first order, which scatters");
        assert_eq!(by_order([0.0; 4], 1e-2), None, "nothing depends on the step");
    }

    #[test]
    fn a_longer_step_goes_by_the_order() {
        // Second order: an error four times smaller than allowed lets the step double, nearly.
        let step = longer(1e-4, Some(4e-4), 4e-4, 1.0).unwrap();
        assert!((step - 3.2_f64.sqrt()).abs() < 1e-12, "{step}");
        assert_eq!(longer(3.9e-4, Some(1.6e-3), 4e-4, 1.0), None, "hardly longer");
        assert_eq!(longer(1e-4, None, 4e-4, 1.0), None);
        assert_eq!(longer(1e-4, Some(1e-4), 4e-4, 1.0), None, "no order to go by");
    }

    /// The step for an accuracy, and how far the run with it is from one with an eighth of it.
    fn tried(scene: &Scene, accuracy: f64) -> (ChosenStep, f64) {
        let cancel = Arc::new(AtomicBool::new(false));
        let chosen = step_for(scene, accuracy, &cancel).unwrap();
        let end = scene.time.end;
        let sampling = Sampling { every: end / SAMPLES as f64, count: SAMPLES + 1 };
        let mut trials = TrialRuns { scene, sampling, cancel: &cancel, most_seconds: 100.0, runs: 0 };
        let [run, fine] = [1.0, 8.0].map(|by| trials.run(end / (by * end / chosen.step).ceil(), 0.0).unwrap().unwrap());
        (chosen, ErrorNorms::new(scene, sampling).errors(&run, &fine).of(Quantity::Accuracy).unwrap())
    }

    #[test]
    fn a_step_foretold_reaches_its_accuracy() {
        // Half a sine pushes it into sliding, and begins and ends where steps that halve the run
        // would all end; Housner's block.
        let path = |name| format!("{}/../../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        for (name, accuracy) in [("free-rocking-on-ground", 1e-5), ("shaken-ground", 1e-5), ("pushed-block", 1e-6)] {
            let step = ("time.step".to_owned(), "1 ms".to_owned());
            let text = std::fs::read(path(name)).unwrap();
            let scene = teeter_scenario::load(&text, &path(name), name, &[step]).unwrap().scene;
            let (chosen, error) = tried(&scene, accuracy);
            assert!(error > 0.1 * accuracy && error <= accuracy, "{name}: {error:e} for {accuracy:e}, {chosen:?}");
            assert!(
                name == "pushed-block" || chosen.basis == ErrorBasis::Order && chosen.runs == 7,
                "{name}: {chosen:?}"
            );
        }
    }

    /// A slender block slides, and a push topples it: five runs look to be of second order, but
    /// what they foretell is 3, 5 and 20 times too good.
    #[test]
    fn what_is_foretold_wrongly_is_found_out() {
        let text = "time = { end = '0.6 s', step = '1 ms' }\nground = {}\nmaterial.m = { density = '2700 kg/m^3' }\n\
             block.b = { material = 'm', width = '3 cm', height = '15 cm', depth = '5 cm', on = 'ground', at = '0 m', \
             velocity = ['0.4825184856256568 m/s', '0 m/s'] }\n\
             contact.c = { between = ['b', 'ground'], friction = 0.3, restitution = 0.3 }\n\
             force.push = { on = 'b', force = ['-0.544293682609749 N', '0 N'], couple = '0.05952416277711885 N m', signal = 'p' }\n\
             signal.p = { shape = 'half-sine', start = '0.0503717 s', duration = '0.11 s' }\n";
        let scene = teeter_scenario::load(text.as_bytes(), "topple", "topple", &[]).unwrap().scene;
        for accuracy in [1e-4, 1e-5] {
            let (chosen, error) = tried(&scene, accuracy);
            assert!(error <= accuracy, "{error:e} for {accuracy:e}, {chosen:?}");
        }
    }

    /// A flat block bounces on one corner, e = 0.8, and has just ended that when it lands on the
    /// other one: runs that cut the last bounces agree to 1e-5, and are 7 % off.
    #[test]
    fn runs_that_cut_the_same_bounces_prove_nothing() {
        let text = "time = { end = '0.3 s', step = '1 ms' }\nground = { incline = '10 deg' }\nmaterial.m = { density = '2700 kg/m^3' }\n\
             block.b = { material = 'm', width = '30 cm', height = '3 cm', depth = '5 cm', \
             position = ['-0.0026048963131816215 m', '0.01477310110293613 m'], angle = '10 deg', spin = '2.491835145336937 rad/s' }\n\
             contact.c = { between = ['b', 'ground'], friction = 2, restitution = 0.8 }\n\
             force.push = { on = 'b', force = ['-7.144254350426844 N', '0 N'], couple = '-0.0007310276802040853 N m', signal = 'p' }\n\
             signal.p = { shape = 'half-sine', start = '0 s', duration = '0.0517 s' }\n";
        let scene = teeter_scenario::load(text.as_bytes(), "bounces", "bounces", &[]).unwrap().scene;
        let chosen = step_for(&scene, 1e-5, &Arc::default()).unwrap();
        // It lands on the other corner at 0.045852 s.
        assert!(!chosen.whole && chosen.horizon <= 0.0459 && chosen.horizon > 0.045, "{chosen:?}");
    }
}
