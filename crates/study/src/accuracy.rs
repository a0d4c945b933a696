//! The step that reaches an accuracy: found by runs, each of half the step of the one before, and
//! believed where two finer runs confirm it; or foretold where the errors fall so regularly that
//! five longer steps tell what a shorter one does, and believed where one finer run confirms that.
//!
//! The error is that of [`Quantity::Accuracy`], the largest of angles, places and deflections. A
//! step h is taken when the run with it is within the accuracy of the run with h/4, and that with
//! h/2 is nearer, or all three agree to half the accuracy. Or when the last five runs show errors
//! of second order: that of a step down to a sixteenth of the finest is then foretold, and measured
//! against a run with half the step. Runs that agree as all of them cut bounces short on which a
//! landing hangs prove nothing: they are compared up to there. Motions that part from a start 1e-12
//! beside them are compared up to there, the horizon.

use crate::pilots::Pilots;
use crate::reference::NUDGE;
use crate::{Failure, Motion, Quantity, Ruler, Sampling};
use std::ops::RangeInclusive;
use std::sync::atomic::AtomicBool;
use teeter_scenario::scene::Scene;

/// A step that reaches an accuracy, and how it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ChosenStep {
    /// The step, s.
    pub step: f64,
    /// How far a run with it is from one with a quarter of it, or less, before the horizon; or,
    /// where the errors are of second order, four thirds of how far it is from one with half of it.
    pub error: f64,
    /// Which of both.
    pub basis: Basis,
    /// The time up to which they were compared, s.
    pub horizon: f64,
    /// Whether that is the end of the run.
    pub whole: bool,
    /// How many runs it took.
    pub runs: usize,
}

/// How the error of a [`ChosenStep`] is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Basis {
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

/// The finer run is nearer by this factor at least, where errors don't scatter so far below the
/// accuracy.
const NEARER: f64 = 0.75;
const ALIKE: f64 = 0.5;

/// Runs after which those that don't converge are compared up to a horizon.
const PATIENCE: usize = 5;

/// The same of those in which a landing hangs on bounces that were cut short: shorter steps cut
/// less.
const PATIENCE_WITH_BOUNCES: usize = 8;

/// Errors that have not fallen below this part in five halvings won't.
const STALLED: f64 = 0.5;

/// A horizon before this part of the run shows too little of it.
const SHORT: f64 = 0.05;

/// Errors are of second order where three halvings in a row show such orders, and these on average.
const REGULAR: RangeInclusive<f64> = 1.2..=2.8;
const ON_AVERAGE: RangeInclusive<f64> = 1.7..=2.3;

/// What a step of a regular order does is foretold down to this part of the finest that was tried.
const FURTHEST: f64 = 1.0 / 16.0;

/// What is foretold after that proved wrong is to be shorter by this factor.
const SHORTER: f64 = 0.7;

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
    // An odd number of steps, and one more than twice as many in the next run: halves of a run,
    // quarters … would fall on ends of steps in all of them, and what happens there, as where a
    // load begins, would look better than it is elsewhere.
    let mut count = 2.0 * (0.5 * end / longest(scene)).ceil() + 1.0;
    let (mut errors, mut failed) = (Vec::new(), None);
    let mut best = (f64::NAN, f64::INFINITY, end);
    // The step that was foretold last, and whose error proved too large.
    let mut refuted = f64::INFINITY;
    loop {
        let step = end / count;
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
            // By steps of its own it follows bounces further than these say.
            let contested = fine.contested.filter(|_| !scene.time.scheme.has_own_steps());
            if let Some(t) = contested {
                if motions.len() <= PATIENCE_WITH_BOUNCES {
                    halve(&mut motions, &mut count);
                    continue;
                }
                samples = samples.min((t / sampling.every).ceil() as usize).max(1);
            }
            if let [.., (_, Some(first)), (_, Some(second)), _, _, _] = motions.as_slice()
                && samples == sampling.count
            {
                let neighbours = [(first, second), (second, coarse), (coarse, middle), (middle, fine)];
                let apart = neighbours.map(|(a, b)| of(a, b, samples));
                let foretold = by_order(apart, accuracy).map(|factor| factor * step);
                if let Some(step) = foretold.filter(|step| *step < SHORTER * refuted) {
                    let count = (end / step).ceil();
                    let [run, finer] = [pilots.run(end / count, 0.0)?, pilots.run(end / (2.0 * count + 1.0), 0.0)?];
                    let error = run.zip(finer).map(|(run, finer)| 4.0 / 3.0 * of(&run, &finer, samples));
                    if let Some(error) = error.filter(|error| *error <= accuracy) {
                        let (step, runs, basis) = (end / count, pilots.runs, Basis::Order);
                        return Ok(ChosenStep { step, error, basis, horizon: end, whole: true, runs });
                    }
                    refuted = step;
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
            let converges = nearer <= NEARER * error || error.max(nearer) <= ALIKE * accuracy;
            if error <= ROOM * accuracy && converges && horizon >= SHORT * end {
                let before = motions.len().checked_sub(4).and_then(|at| motions[at].1.as_ref());
                let longer = longer(error, before.map(|motion| of(motion, fine, samples)), accuracy, *coarse_step);
                let mut chosen = ChosenStep {
                    step: *coarse_step,
                    error,
                    basis: Basis::FinerRuns,
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
        halve(&mut motions, &mut count);
    }
}

/// Goes on to half the step, and drops what is not compared any more.
fn halve(motions: &mut [(f64, Option<Motion>)], count: &mut f64) {
    let old = motions.len().saturating_sub(5);
    if let Some((_, motion)) = motions[..old].last_mut() {
        *motion = None;
    }
    *count = 2.0 * *count + 1.0;
}

/// The step that should do, as a multiple of the finest of five that were each half of the one
/// before, by how far the motions of neighbours are `apart`. `None` where these don't fall
/// regularly, or where that step is out of their reach.
fn by_order(apart: [f64; 4], accuracy: f64) -> Option<f64> {
    let orders = [0, 1, 2].map(|k| (apart[k] / apart[k + 1]).log2());
    let mean = orders.iter().sum::<f64>() / 3.0;
    if !(orders.iter().all(|order| REGULAR.contains(order)) && ON_AVERAGE.contains(&mean)) {
        return None;
    }
    // Of the finest step, were the errors h² times the largest factor that was seen: how large it
    // is goes by where in their steps the events are.
    let found = [0, 1, 2, 3].map(|k| apart[k] * 0.25_f64.powi(3 - k as i32) / 3.0);
    let (least, most) = found.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), e| (least.min(*e), most.max(*e)));
    // Where they differ much, there may be larger ones.
    let error = most * (most / least).sqrt();
    // Longer than the longest of them it would be told by none.
    let factor = (ROOM * accuracy / error).sqrt().min(16.0);
    (factor >= FURTHEST).then_some(factor)
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
        let cancel = AtomicBool::new(false);
        let chosen = step_for(scene, accuracy, &cancel).unwrap();
        let end = scene.time.end;
        let sampling = Sampling { every: end / SAMPLES as f64, count: SAMPLES + 1 };
        let mut pilots = Pilots { scene, sampling, cancel: &cancel, most_seconds: 100.0, runs: 0 };
        let [run, fine] = [1.0, 8.0].map(|by| pilots.run(end / (by * end / chosen.step).ceil(), 0.0).unwrap().unwrap());
        (chosen, Ruler::new(scene, sampling).errors(&run, &fine).of(Quantity::Accuracy).unwrap())
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
            assert!(name == "pushed-block" || chosen.basis == Basis::Order && chosen.runs == 7, "{name}: {chosen:?}");
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
        let chosen = step_for(&scene, 1e-5, &AtomicBool::new(false)).unwrap();
        // It lands on the other corner at 0.045852 s.
        assert!(!chosen.whole && chosen.horizon <= 0.0459 && chosen.horizon > 0.045, "{chosen:?}");
    }
}
