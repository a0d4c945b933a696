//! Runs a setting: its motion and work, or the reason for a failure; and its time.

use crate::sampled_motion::Sampler;
use crate::{SampledMotion, Sampling, Setting, SettingWarning, StudyScene, Work};
use cpu_time::ThreadTime;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use teeter_integrator::{Ended, Model, Observer, ObserverError, State, StepReport};
use teeter_report::{EndedWord, Recorder, Summary};
use teeter_scenario::diagnostic::Diagnostics;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;

/// Why a setting has no motion.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// The scene can't be run with it.
    #[error("refused: {0}")]
    Refused(String),
    /// The run ended before its time.
    #[error("{0}")]
    Ended(String),
    /// The user ended it.
    #[error("interrupted")]
    Interrupted,
}

impl From<Diagnostics> for Failure {
    fn from(found: Diagnostics) -> Self {
        let first = found.iter().find(|found| !found.rule.is_empty());
        Self::Refused(first.map_or_else(|| found.to_string(), |found| format!("{}: {}", found.path, found.rule)))
    }
}

impl Failure {
    /// Returns an error for a run that ended early, at time `t` (s).
    pub(crate) fn unless_complete(ended: Ended, t: f64) -> Result<(), Self> {
        match ended {
            Ended::Complete => Ok(()),
            Ended::Interrupted => Err(Self::Interrupted),
            Ended::Failed(error) => Err(Self::Ended(error.to_string())),
            _ => Err(Self::Ended(format!("a step was not solved to tolerance at t = {t} s"))),
        }
    }
}

/// The result of a run that came to its end.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RunResult {
    pub(crate) motion: SampledMotion,
    pub(crate) work: Work,
    /// Steps whose contact problem was not solved to tolerance.
    pub(crate) unconverged: u64,
    /// What `check` and `run` warn of.
    pub(crate) warned: Vec<SettingWarning>,
}

/// A model of the setting, ready to run.
fn ready(source: &StudyScene, setting: &Setting) -> Result<(Resolved, Simulation), Failure> {
    let resolved = source.load(setting)?;
    let simulation = Simulation::new(&resolved.scene).map_err(|error| Failure::Refused(error.to_string()))?;
    Ok((resolved, simulation))
}

/// Lower bound on the work of a run of the setting.
pub(crate) fn expect(source: &StudyScene, setting: &Setting) -> Result<Work, Failure> {
    Ok(Work::expected(&ready(source, setting)?.1))
}

/// Ends a run whose contact solver has used up its iterations.
struct IterationLimit {
    left: u64,
}

impl Observer<2> for IterationLimit {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        let taken = step.outcome().map_or(0, |outcome| u64::from(outcome.iterations));
        self.left = self.left.saturating_sub(taken);
        Ok(if self.left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }
}

/// Runs a setting as [`simulate`] does, but stops it if its contact solver alone takes so much more
/// than everything else that it can't be the cheapest: a solver that stalls in every step would
/// delay a study by minutes.
pub(crate) fn simulate_within_limit(
    source: &StudyScene,
    setting: &Setting,
    sampling: Sampling,
    cancel: &Arc<AtomicBool>,
) -> Result<RunResult, Failure> {
    run_within(source, setting, 0.0, sampling, cancel, |work| work.most_iterations())
}

/// Runs a setting, with the initial coordinates of the first body increased by the fraction
/// `perturbation`.
pub(crate) fn simulate(
    source: &StudyScene,
    setting: &Setting,
    perturbation: f64,
    sampling: Sampling,
    cancel: &Arc<AtomicBool>,
) -> Result<RunResult, Failure> {
    run_within(source, setting, perturbation, sampling, cancel, |_| u64::MAX)
}

fn run_within(
    source: &StudyScene,
    setting: &Setting,
    perturbation: f64,
    sampling: Sampling,
    cancel: &Arc<AtomicBool>,
    most_iterations: impl Fn(&Work) -> u64,
) -> Result<RunResult, Failure> {
    let (resolved, mut simulation) = ready(source, setting)?;
    let first = match (simulation.layout.blocks.first(), simulation.layout.beams.first()) {
        (Some(block), _) => block.range.clone(),
        (None, Some(beam)) => beam.range.clone(),
        (None, None) => 0..0,
    };
    simulation.state.q[first].iter_mut().for_each(|q| *q *= 1.0 + perturbation);
    simulation.cancelled_by(Arc::clone(cancel));
    let layout = simulation.layout.clone();
    let mut sampler = Sampler::new(sampling, &layout, cancel);
    // The warnings of `teeter run` are only known to the observers of a run.
    let mut tell = |_: &str| {};
    let failed = |error: &dyn std::fmt::Display| Failure::Ended(error.to_string());
    let mut recorder = Recorder::watching(&resolved.scene, &layout, &mut tell).map_err(|error| failed(&error))?;
    let most = most_iterations(&Work::expected(&simulation));
    let mut limit = IterationLimit { left: most };
    let ended = simulation.run(&mut [&mut limit, &mut sampler, &mut recorder]).map_err(|error| failed(&error))?;
    if limit.left == 0 && ended != Ended::Complete {
        let t = simulation.state.t;
        return Err(Failure::Ended(format!(
            "stopped at t = {t} s: its contact solver needed more than {most} iterations, far more work than everything else"
        )));
    }
    let state = &simulation.state;
    Failure::unless_complete(ended, state.t)?;
    let work = Work::of(&simulation);
    let record = recorder.into_record();
    let summary = Summary::new(&resolved.scene, &layout, state, &record, EndedWord::Complete, 0.0);
    let warned = SettingWarning::of(resolved.warnings.iter().chain(&resolved.foreseen), &summary.warnings);
    Ok(RunResult { motion: sampler.finish(state, &record), work, unconverged: state.tally.unconverged_steps, warned })
}

/// CPU time of the steps of a run without output, s: of this thread alone, without building the
/// model.
pub(crate) fn time(source: &StudyScene, setting: &Setting, cancel: &Arc<AtomicBool>) -> Result<f64, Failure> {
    if cancel.load(Ordering::Relaxed) {
        return Err(Failure::Interrupted);
    }
    let (_, mut simulation) = ready(source, setting)?;
    simulation.cancelled_by(Arc::clone(cancel));
    let clock = ThreadTime::now();
    let ended = simulation.run(&mut []).map_err(|error| Failure::Ended(error.to_string()))?;
    let seconds = clock.elapsed().as_secs_f64();
    // The time of an incomplete run is meaningless.
    match ended {
        Ended::Complete => Ok(seconds),
        Ended::Interrupted => Err(Failure::Interrupted),
        Ended::Failed(error) => Err(Failure::Ended(error.to_string())),
        _ => Err(Failure::Ended("the run was incomplete".to_owned())),
    }
}
