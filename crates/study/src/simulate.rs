//! One run of a setting: its motion and its work, or why there is none; and its time.

use crate::motion::Sampler;
use crate::{Motion, Sampling, Setting, Source, Warned, Work};
use cpu_time::ThreadTime;
use std::ops::ControlFlow;
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
    /// With it the scene can't be run.
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
    /// Refuses a run that ended at time `t` (s), but for one that came to its end.
    pub(crate) fn unless_complete(ended: Ended, t: f64) -> Result<(), Self> {
        match ended {
            Ended::Complete => Ok(()),
            Ended::Interrupted => Err(Self::Interrupted),
            Ended::Failed(error) => Err(Self::Ended(error.to_string())),
            _ => Err(Self::Ended(format!("a step was not solved to tolerance at t = {t} s"))),
        }
    }
}

/// A run that came to its end.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ran {
    pub(crate) motion: Motion,
    pub(crate) work: Work,
    /// Steps whose contact problem was not solved to tolerance.
    pub(crate) unconverged: u64,
    /// What `check` and `run` warn of.
    pub(crate) warned: Vec<Warned>,
}

/// A model of the setting, ready to run.
fn ready(source: &Source, setting: &Setting) -> Result<(Resolved, Simulation), Failure> {
    let resolved = source.load(setting)?;
    let simulation = Simulation::new(&resolved.scene).map_err(|error| Failure::Refused(error.to_string()))?;
    Ok((resolved, simulation))
}

/// What a run of the setting will do at least.
pub(crate) fn expect(source: &Source, setting: &Setting) -> Result<Work, Failure> {
    Ok(Work::expected(&ready(source, setting)?.1))
}

/// Ends a run whose contact solver has used up its iterations.
struct Limit {
    left: u64,
}

impl Observer<2> for Limit {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        let taken = step.outcome().map_or(0, |outcome| u64::from(outcome.iterations));
        self.left = self.left.saturating_sub(taken);
        Ok(if self.left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }
}

/// Runs a setting as [`simulate`] does, but gives it up where its contact solver alone takes so
/// much more than all else that it can't be the cheapest: a solver that stalls in every step would
/// keep a study for minutes.
pub(crate) fn simulate_unless_dear(
    source: &Source,
    setting: &Setting,
    sampling: Sampling,
    cancel: &AtomicBool,
) -> Result<Ran, Failure> {
    run_within(source, setting, 0.0, sampling, cancel, |work| work.most_iterations())
}

/// Runs a setting; the coordinates of the first body start greater by the share `nudge` of
/// themselves.
pub(crate) fn simulate(
    source: &Source,
    setting: &Setting,
    nudge: f64,
    sampling: Sampling,
    cancel: &AtomicBool,
) -> Result<Ran, Failure> {
    run_within(source, setting, nudge, sampling, cancel, |_| u64::MAX)
}

fn run_within(
    source: &Source,
    setting: &Setting,
    nudge: f64,
    sampling: Sampling,
    cancel: &AtomicBool,
    most_iterations: impl Fn(&Work) -> u64,
) -> Result<Ran, Failure> {
    let (resolved, mut simulation) = ready(source, setting)?;
    let first = match (simulation.layout.blocks.first(), simulation.layout.beams.first()) {
        (Some(block), _) => block.range.clone(),
        (None, Some(beam)) => beam.range.clone(),
        (None, None) => 0..0,
    };
    simulation.state.q[first].iter_mut().for_each(|q| *q *= 1.0 + nudge);
    let layout = simulation.layout.clone();
    let mut sampler = Sampler::new(sampling, &layout, cancel);
    // What `teeter run` would warn of is known to what watches a run of it, and to nothing else.
    let mut tell = |_: &str| {};
    let failed = |error: &dyn std::fmt::Display| Failure::Ended(error.to_string());
    let mut recorder = Recorder::watching(&resolved.scene, &layout, &mut tell).map_err(|error| failed(&error))?;
    let most = most_iterations(&Work::expected(&simulation));
    let mut limit = Limit { left: most };
    let ended = simulation.run(&mut [&mut limit, &mut sampler, &mut recorder]).map_err(|error| failed(&error))?;
    if limit.left == 0 && ended != Ended::Complete {
        let t = simulation.state.t;
        return Err(Failure::Ended(format!(
            "stopped at t = {t} s: its contact solver needed more than {most} iterations, far more work than all else"
        )));
    }
    let state = &simulation.state;
    Failure::unless_complete(ended, state.t)?;
    let work = Work::of(&simulation);
    let record = recorder.into_record();
    let summary = Summary::new(&resolved.scene, &layout, state, &record, EndedWord::Complete, 0.0);
    let warned = Warned::of(resolved.warnings.iter().chain(&resolved.foreseen), &summary.warnings);
    Ok(Ran { motion: sampler.finish(state, &record), work, unconverged: state.tally.unconverged_steps, warned })
}

/// CPU time of the steps of a run without output, s: of this thread alone, whatever else the
/// machine does. Making the model is not in it.
pub(crate) fn time(source: &Source, setting: &Setting, cancel: &AtomicBool) -> Result<f64, Failure> {
    if cancel.load(Ordering::Relaxed) {
        return Err(Failure::Interrupted);
    }
    let (_, mut simulation) = ready(source, setting)?;
    let clock = ThreadTime::now();
    let ended = simulation.run(&mut []).map_err(|error| Failure::Ended(error.to_string()))?;
    let seconds = clock.elapsed().as_secs_f64();
    // A run that broke off says nothing about the time of a whole one.
    match ended {
        Ended::Complete => Ok(seconds),
        Ended::Failed(error) => Err(Failure::Ended(error.to_string())),
        _ => Err(Failure::Ended("the run broke off".to_owned())),
    }
}
