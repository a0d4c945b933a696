//! The study of one scene: reference, candidates in stages, times, advice.

use crate::axes::Axes;
use crate::recommend::{Advice, ConfirmedErrors, TARGETS, advise, eligible};
use crate::reference::{self, Reference};
use crate::row::{CompletedRun, Row, pareto_front_of};
use crate::search::{self, PlannedSetting, SearchState};
use crate::setting_warning::of_the_scene;
use crate::simulate::{expect, simulate_within_limit};
use crate::{Failure, Sampling, Setting, StudyScene, runner, timing};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_scenario::resolve::Resolved;

/// The results of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Tradeoff {
    /// The scene's title.
    pub title: String,
    /// The user's own settings, applied to every candidate.
    pub sets: Vec<(String, String)>,
    /// Simulated time, s.
    pub end: f64,
    /// The scene's own step, s.
    pub step: f64,
    /// The scene's own scheme.
    pub scheme: String,
    /// The sampling times of motions.
    pub sampling: Sampling,
    /// The axes that are varied.
    pub axes: Axes,
    /// The reference for errors.
    pub reference: Reference,
    /// The candidates, in the order in which they were tried.
    pub rows: Vec<Row>,
    /// The rows on the Pareto front of accuracy over counted work, cheapest first.
    pub front: Vec<usize>,
    /// Settings not run because they are too much work.
    pub too_expensive: BTreeSet<Setting>,
    /// The advice for each of [`TARGETS`].
    pub advice: [Advice; TARGETS.len()],
}

/// Largest modelled work of a candidate, and of all of them, s: more expensive settings are left
/// out.
const MOST_WORK_OF_ONE: f64 = 1.5;
const MOST_WORK: f64 = 24.0;
/// The part of that for the first stages.
const MOST_WORK_OF_PLAIN: f64 = 6.0;
/// Most rounds of descent.
const DESCENTS: usize = 6;

/// Number of settings nearly as cheap as the advised one whose time is measured.
const TIMED_BESIDE: usize = 6;
/// Factor of counted work that counts as nearly as cheap: the estimate is accurate to some 30 %.
const NEARLY_AS_CHEAP: f64 = 1.6;

/// Callback for the progress of a study: current activity, number done, total.
pub type ReportProgress<'a> = dyn FnMut(&str, usize, usize) + Send + 'a;

/// Parameters of runs.
struct Run<'a> {
    source: &'a StudyScene,
    threads: usize,
    cancel: &'a Arc<AtomicBool>,
}

impl Tradeoff {
    /// Studies a scene.
    ///
    /// # Errors
    /// If no scheme comes to the end of the scene, or the user interrupts.
    pub fn of(
        source: &StudyScene,
        resolved: &Resolved,
        threads: usize,
        cancel: &Arc<AtomicBool>,
        tell: &mut ReportProgress<'_>,
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
            too_expensive: BTreeSet::new(),
            advice: [Advice::NotReached; TARGETS.len()],
        };
        let run = Run { source, threads, cancel };
        study.search(&run, tell)?;
        study.time(source, cancel, tell)?;
        study.front = pareto_front_of(&study.rows);
        study.advise_all();
        Ok(study)
    }

    /// Updates the advice from the current rows, error bar and horizon.
    pub fn advise_all(&mut self) {
        self.advice = TARGETS.map(|target| self.advise(target));
    }

    fn advise(&self, target: f64) -> Advice {
        if !self.reference.has_first_impacts() {
            return Advice::BeforeImpact;
        }
        advise(&self.rows, &self.axes, target, self.bar(), &self.reference.warned)
    }

    /// Whether `check` or `run` warns of a row's setting, of more than they warn of in any setting of the scene.
    #[must_use]
    pub fn is_warned(&self, row: &Row) -> bool {
        let done = self.rows.iter().filter(|row| row.result.is_ok()).map(Row::warned);
        let of_the_scene = of_the_scene(&self.reference.warned, done);
        row.warned().iter().any(|warned| !of_the_scene.contains(&warned.kind))
    }

    /// The error bar of the accuracy.
    #[must_use]
    pub fn bar(&self) -> f64 {
        self.reference.bar_of(crate::Quantity::Accuracy)
    }

    /// The row of the unchanged scene.
    #[must_use]
    pub fn own(&self) -> Option<&Row> {
        self.rows.iter().find(|row| row.setting.is_none())
    }

    /// The smallest error of the accuracy among the candidates.
    #[must_use]
    pub fn best(&self) -> Option<f64> {
        self.rows.iter().filter_map(Row::accuracy).reduce(f64::min)
    }

    /// Number of settings of the full grid of the axes.
    #[must_use]
    pub fn grid(&self) -> usize {
        self.axes.iter().map(|axis| axis.options.len()).product()
    }

    fn known(&self) -> SearchState<'_> {
        SearchState::new(&self.axes, &self.rows, self.bar(), &self.reference.warned)
    }

    /// Tries settings in the stages of [`search::SEARCH_STAGES`].
    fn search(&mut self, run: &Run<'_>, tell: &mut ReportProgress<'_>) -> Result<(), Failure> {
        let plain = self.known().plain();
        self.stage(1, plain, MOST_WORK_OF_PLAIN, run, tell)?;
        let single = self.known().one_at_a_time();
        self.stage(2, single, MOST_WORK, run, tell)?;
        // Without the first impacts, or without motion, nothing can be advised.
        if !self.reference.has_first_impacts() || self.best().is_none() {
            return Ok(());
        }
        self.confirm(run, tell)?;
        for _ in 0..DESCENTS {
            if !self.descend(run, tell)? {
                break;
            }
        }
        let expect = |setting: &Setting| expect(run.source, setting).ok();
        let steps = self.steps(run.source);
        let grid: Vec<PlannedSetting> = search::grid(&self.axes, &steps, &expect);
        loop {
            let next = self.known().next_of_grid(&grid, &self.too_expensive);
            if next.is_empty() {
                break;
            }
            self.stage(4, next, MOST_WORK, run, tell)?;
            self.confirm(run, tell)?;
        }
        // The results of the grid, combined with the axes that are tried one at a time.
        self.descend(run, tell)?;
        Ok(())
    }

    /// Tries neighbours of the cheapest settings so far that could be cheaper; returns whether
    /// there were any.
    fn descend(&mut self, run: &Run<'_>, tell: &mut ReportProgress<'_>) -> Result<bool, Failure> {
        let known = self.known();
        let mut near = known.beside_the_cheapest();
        near.retain(|one| expect(run.source, one).is_ok_and(|work| known.could_be_cheapest(work.seconds())));
        let tried = self.rows.len();
        self.stage(3, near, MOST_WORK, run, tell)?;
        self.confirm(run, tell)?;
        Ok(self.rows.len() > tried)
    }

    /// Confirms the cheapest setting for each accuracy, until all are confirmed.
    fn confirm(&mut self, run: &Run<'_>, tell: &mut ReportProgress<'_>) -> Result<(), Failure> {
        loop {
            let finer = self.known().unconfirmed();
            let tried = self.rows.len();
            self.stage(5, finer, MOST_WORK, run, tell)?;
            if self.rows.len() == tried {
                return Ok(());
            }
        }
    }

    /// Number of steps of a run for each step of the ladder.
    fn steps(&self, source: &StudyScene) -> Vec<f64> {
        let ladder = self.axes.ladder(&Setting::none());
        let of = |setting: &Setting| source.load(setting).map_or(0.0, |resolved| resolved.scene.time.steps() as f64);
        ladder.iter().map(of).collect()
    }

    /// Compares settings with the reference, except those that are too much work; limits the total
    /// work, including earlier runs, to `most`.
    fn stage(
        &mut self,
        number: usize,
        wanted: Vec<Setting>,
        most: f64,
        run: &Run<'_>,
        tell: &mut ReportProgress<'_>,
    ) -> Result<(), Failure> {
        let mut left = most - self.rows.iter().filter_map(Row::modelled).sum::<f64>();
        let mut jobs = Vec::new();
        for setting in wanted {
            match expect(run.source, &setting) {
                Ok(work) if work.seconds() > MOST_WORK_OF_ONE.min(left) => {
                    // Settings left out in the first stages may be tried later.
                    if most >= MOST_WORK {
                        self.too_expensive.insert(setting);
                    }
                }
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
        let done = |_| {
            count += 1;
            tell(&name, count, total);
        };
        let rows = self.tried(jobs, number, run, done)?;
        self.rows.extend(rows);
        Ok(())
    }

    /// The results of settings, compared with the reference.
    fn tried(
        &self,
        jobs: Vec<Setting>,
        stage: usize,
        run: &Run<'_>,
        done: impl FnMut(usize) + Send,
    ) -> Result<Vec<Row>, Failure> {
        let one = |setting: &Setting| {
            let ran = simulate_within_limit(run.source, setting, self.sampling, run.cancel)?;
            let errors = self.reference.norms.errors(&ran.motion, &self.reference.motion);
            Ok(CompletedRun { errors, work: ran.work, unconverged: ran.unconverged, warned: ran.warned })
        };
        let ran = runner::in_order(&jobs, run.threads, run.cancel, one, done);
        let mut rows = Vec::with_capacity(jobs.len());
        for (setting, ran) in jobs.into_iter().zip(ran) {
            let result = ran.unwrap_or(Err(Failure::Interrupted));
            if result == Err(Failure::Interrupted) {
                return Err(Failure::Interrupted);
            }
            rows.push(Row { setting, stage, result, cpu: None });
        }
        Ok(rows)
    }

    /// Compares further settings with the reference of this study, for example to check what the
    /// search left out.
    ///
    /// # Errors
    /// If the user interrupts.
    pub fn beside(
        &self,
        settings: Vec<Setting>,
        source: &StudyScene,
        threads: usize,
        cancel: &Arc<AtomicBool>,
    ) -> Result<Vec<Row>, Failure> {
        self.tried(settings, 0, &Run { source, threads, cancel }, |_| {})
    }

    /// The rows whose time is measured: the unchanged scene and other schemes and steps, the Pareto
    /// front, and for each accuracy those nearly as cheap as the advised one.
    fn to_time(&self) -> Vec<usize> {
        let mut timed = pareto_front_of(&self.rows);
        timed.extend((0..self.rows.len()).filter(|&row| self.rows[row].stage == 1));
        let held = ConfirmedErrors::of(&self.rows, &self.axes);
        for target in TARGETS {
            let mut among = eligible(&self.rows, &held, target, self.bar(), &self.reference.warned);
            let cost = |row: usize| self.rows[row].modelled().unwrap_or(f64::INFINITY);
            among.sort_by(|&a, &b| cost(a).total_cmp(&cost(b)).then(a.cmp(&b)));
            let least = among.first().map_or(0.0, |&row| cost(row));
            among.retain(|&row| cost(row) <= NEARLY_AS_CHEAP * least);
            timed.extend(among.into_iter().take(TIMED_BESIDE));
        }
        timed.sort_unstable();
        timed.dedup();
        timed.retain(|&row| self.rows[row].result.is_ok());
        timed
    }

    fn time(
        &mut self,
        source: &StudyScene,
        cancel: &Arc<AtomicBool>,
        tell: &mut ReportProgress<'_>,
    ) -> Result<(), Failure> {
        let timed = self.to_time();
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
