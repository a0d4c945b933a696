//! The study of one scene: reference, candidates in stages, times, advice.

use crate::axes::Axes;
use crate::plan::{CONFIRMATIONS, STAGES, stage};
use crate::recommend::{Advice, TARGETS, advise};
use crate::reference::{self, Reference};
use crate::row::{Done, Row, front_of};
use crate::simulate::{expect, simulate};
use crate::{Failure, Sampling, Setting, Source, runner, timing};
use std::sync::atomic::AtomicBool;
use teeter_scenario::resolve::Resolved;

/// What a study found.
#[derive(Debug, Clone, PartialEq)]
pub struct Tradeoff {
    /// The scene's title.
    pub title: String,
    /// What the user set beside what is tried.
    pub sets: Vec<(String, String)>,
    /// Simulated time, s.
    pub end: f64,
    /// The scene's own step, s.
    pub step: f64,
    /// The scene's own scheme.
    pub scheme: String,
    /// When motions are compared.
    pub sampling: Sampling,
    /// What can be varied.
    pub axes: Axes,
    /// What errors are against.
    pub reference: Reference,
    /// The candidates, in the order in which they were tried.
    pub rows: Vec<Row>,
    /// The rows on the front of accuracy over counted work, from cheap to dear.
    pub front: Vec<usize>,
    /// Settings that were not run because they are too much work.
    pub too_dear: usize,
    /// What to take for each of [`TARGETS`].
    pub advice: [Advice; TARGETS.len()],
}

/// Modelled work of a candidate, and of all of them, s: the rest is left out, the dear ones of a late stage first.
const MOST_WORK_OF_ONE: f64 = 0.5;
const MOST_WORK: f64 = 3.5;

/// How far a study is: what it is at, and how much of that is done.
pub type Tell<'a> = dyn FnMut(&str, usize, usize) + Send + 'a;

impl Tradeoff {
    /// Studies a scene.
    ///
    /// # Errors
    /// If no scheme comes to the end of the scene, or the user interrupts.
    pub fn of(
        source: &Source,
        resolved: &Resolved,
        threads: usize,
        cancel: &AtomicBool,
        tell: &mut Tell<'_>,
    ) -> Result<Self, Failure> {
        let scene = &resolved.scene;
        let axes = Axes::of(resolved);
        let sampling = Sampling::of(scene);
        let mut done = |k, n| tell("reference", k, n);
        let reference = reference::find(source, resolved, &axes, sampling, threads, cancel, &mut done)?;
        let mut study = Self {
            title: scene.title.clone(),
            sets: source.sets().to_vec(),
            end: scene.time.end,
            step: scene.time.step,
            scheme: scene.time.scheme.word().to_owned(),
            sampling,
            axes,
            reference,
            rows: Vec::new(),
            front: Vec::new(),
            too_dear: 0,
            advice: [Advice::NotReached; TARGETS.len()],
        };
        for number in (1..STAGES).chain(std::iter::repeat_n(STAGES, CONFIRMATIONS)) {
            study.stage(number, source, threads, cancel, tell)?;
        }
        study.time(source, cancel, tell)?;
        study.front = front_of(&study.rows);
        study.advice = TARGETS.map(|target| advise(&study.rows, &study.axes, target, study.bar()));
        Ok(study)
    }

    /// The error bar of the accuracy.
    #[must_use]
    pub fn bar(&self) -> f64 {
        self.reference.bar_of(crate::Quantity::Accuracy)
    }

    /// The row of the scene as it is.
    #[must_use]
    pub fn own(&self) -> Option<&Row> {
        self.rows.iter().find(|row| row.setting.is_none())
    }

    /// The least error of the accuracy among the candidates.
    #[must_use]
    pub fn best(&self) -> Option<f64> {
        self.rows.iter().filter_map(Row::accuracy).reduce(f64::min)
    }

    /// How many settings the full grid of the axes would have.
    #[must_use]
    pub fn grid(&self) -> usize {
        self.axes.iter().map(|axis| axis.options.len()).product()
    }

    fn stage(
        &mut self,
        number: usize,
        source: &Source,
        threads: usize,
        cancel: &AtomicBool,
        tell: &mut Tell<'_>,
    ) -> Result<(), Failure> {
        let takes = |setting: &Setting| source.load(setting).is_ok();
        let wanted = stage(number, &self.axes, &self.rows, self.bar(), &takes);
        let mut left = MOST_WORK - self.rows.iter().filter_map(Row::modelled).sum::<f64>();
        let mut jobs = Vec::new();
        for setting in wanted {
            match expect(source, &setting) {
                Ok(work) if work.seconds() > MOST_WORK_OF_ONE.min(left) => self.too_dear += 1,
                Ok(work) => {
                    left -= work.seconds();
                    jobs.push(setting);
                }
                Err(failure) => {
                    self.rows.push(Row { setting, stage: number, result: Err(failure), cpu: None });
                }
            }
        }
        let name = format!("stage {number}");
        let (mut count, total) = (0, jobs.len());
        let ran = runner::in_order(
            &jobs,
            threads,
            cancel,
            |setting| simulate(source, setting, 0.0, self.sampling, cancel),
            |_| {
                count += 1;
                tell(&name, count, total);
            },
        );
        for (setting, ran) in jobs.into_iter().zip(ran) {
            let result = match ran.unwrap_or(Err(Failure::Interrupted)) {
                Err(Failure::Interrupted) => return Err(Failure::Interrupted),
                Err(failure) => Err(failure),
                Ok(ran) => {
                    let errors = self.reference.ruler.errors(&ran.motion, &self.reference.motion);
                    Ok(Done { errors, work: ran.work, unconverged: ran.unconverged })
                }
            };
            self.rows.push(Row { setting, stage: number, result, cpu: None });
        }
        Ok(())
    }

    fn time(&mut self, source: &Source, cancel: &AtomicBool, tell: &mut Tell<'_>) -> Result<(), Failure> {
        let timed: Vec<usize> = (0..self.rows.len()).filter(|&row| self.rows[row].result.is_ok()).collect();
        let settings: Vec<(&Setting, f64)> =
            timed.iter().map(|&row| (&self.rows[row].setting, self.rows[row].modelled().unwrap_or(0.0))).collect();
        let mut done = |k, n| tell("times", k, n);
        let times = timing::in_turns(source, &settings, cancel, &mut done)?;
        for (row, cpu) in timed.into_iter().zip(times) {
            self.rows[row].cpu = cpu;
        }
        Ok(())
    }
}
