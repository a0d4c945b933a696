//! The study of one scene: reference, candidates in stages, times, advice.

use crate::axes::Axes;
use crate::recommend::{Advice, Held, TARGETS, advise, eligible};
use crate::reference::{self, Reference};
use crate::row::{Done, Row, front_of};
use crate::search::{self, Known, Planned};
use crate::simulate::{expect, simulate_unless_dear};
use crate::{Failure, Sampling, Setting, Source, runner, timing};
use std::collections::BTreeSet;
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
    pub too_dear: BTreeSet<Setting>,
    /// What to take for each of [`TARGETS`].
    pub advice: [Advice; TARGETS.len()],
}

/// Modelled work of a candidate, and of all of them, s: what is dearer is left out.
const MOST_WORK_OF_ONE: f64 = 1.5;
const MOST_WORK: f64 = 24.0;
/// Of that, what the first looks at the scene may take.
const MOST_WORK_OF_PLAIN: f64 = 6.0;
/// Rounds of descent at the most.
const DESCENTS: usize = 6;

/// Settings whose time is measured, of those that are nearly as cheap as what is advised.
const TIMED_BESIDE: usize = 6;
/// How near, as a factor of counted work: that is good to some 30 %.
const NEARLY_AS_CHEAP: f64 = 1.6;

/// How far a study is: what it is at, and how much of that is done.
pub type Tell<'a> = dyn FnMut(&str, usize, usize) + Send + 'a;

/// What runs need.
struct Run<'a> {
    source: &'a Source,
    threads: usize,
    cancel: &'a AtomicBool,
}

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
            too_dear: BTreeSet::new(),
            advice: [Advice::NotReached; TARGETS.len()],
        };
        let run = Run { source, threads, cancel };
        study.search(&run, tell)?;
        study.time(source, cancel, tell)?;
        study.front = front_of(&study.rows);
        study.advise_all();
        Ok(study)
    }

    /// Advises anew by the rows, the bar and the horizon as they are.
    pub fn advise_all(&mut self) {
        self.advice = TARGETS.map(|target| self.advise(target));
    }

    fn advise(&self, target: f64) -> Advice {
        if !self.reference.has_first_impacts() {
            return Advice::BeforeImpact;
        }
        advise(&self.rows, &self.axes, target, self.bar(), &self.reference.warned)
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

    fn known(&self) -> Known<'_> {
        Known::new(&self.axes, &self.rows, self.bar(), &self.reference.warned)
    }

    /// Tries settings, as [`search::TOLD`] says.
    fn search(&mut self, run: &Run<'_>, tell: &mut Tell<'_>) -> Result<(), Failure> {
        let plain = self.known().plain();
        self.stage(1, plain, MOST_WORK_OF_PLAIN, run, tell)?;
        let single = self.known().one_at_a_time();
        self.stage(2, single, MOST_WORK, run, tell)?;
        // Without the first impacts, or without motion, nothing will be advised.
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
        let grid: Vec<Planned> = search::grid(&self.axes, &steps, &expect);
        loop {
            let next = self.known().next_of_grid(&grid, &self.too_dear);
            if next.is_empty() {
                break;
            }
            self.stage(4, next, MOST_WORK, run, tell)?;
            self.confirm(run, tell)?;
        }
        // What the grid found, with what is tried one at a time.
        self.descend(run, tell)?;
        Ok(())
    }

    /// Tries what is beside the cheapest so far and could be cheaper; whether there was anything.
    fn descend(&mut self, run: &Run<'_>, tell: &mut Tell<'_>) -> Result<bool, Failure> {
        let known = self.known();
        let mut near = known.beside_the_cheapest();
        near.retain(|one| expect(run.source, one).is_ok_and(|work| known.could_be_cheapest(work.seconds())));
        let tried = self.rows.len();
        self.stage(3, near, MOST_WORK, run, tell)?;
        self.confirm(run, tell)?;
        Ok(self.rows.len() > tried)
    }

    /// Confirms what is the cheapest for an accuracy, until nothing is left to be confirmed.
    fn confirm(&mut self, run: &Run<'_>, tell: &mut Tell<'_>) -> Result<(), Failure> {
        loop {
            let finer = self.known().unconfirmed();
            let tried = self.rows.len();
            self.stage(5, finer, MOST_WORK, run, tell)?;
            if self.rows.len() == tried {
                return Ok(());
            }
        }
    }

    /// How many steps a run has with each step of the ladder.
    fn steps(&self, source: &Source) -> Vec<f64> {
        let ladder = self.axes.ladder(&Setting::none());
        let of = |setting: &Setting| source.load(setting).map_or(0.0, |resolved| resolved.scene.time.steps() as f64);
        ladder.iter().map(of).collect()
    }

    /// Runs settings against the reference, one after the other as long as they are not too much
    /// work; all of them together up to `most`, with those that were run before.
    fn stage(
        &mut self,
        number: usize,
        wanted: Vec<Setting>,
        most: f64,
        run: &Run<'_>,
        tell: &mut Tell<'_>,
    ) -> Result<(), Failure> {
        let mut left = most - self.rows.iter().filter_map(Row::modelled).sum::<f64>();
        let mut jobs = Vec::new();
        for setting in wanted {
            match expect(run.source, &setting) {
                Ok(work) if work.seconds() > MOST_WORK_OF_ONE.min(left) => {
                    // What a first look leaves out may have its turn.
                    if most >= MOST_WORK {
                        self.too_dear.insert(setting);
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

    /// What came of settings, against the reference.
    fn tried(
        &self,
        jobs: Vec<Setting>,
        stage: usize,
        run: &Run<'_>,
        done: impl FnMut(usize) + Send,
    ) -> Result<Vec<Row>, Failure> {
        let one = |setting: &Setting| {
            let ran = simulate_unless_dear(run.source, setting, self.sampling, run.cancel)?;
            let errors = self.reference.ruler.errors(&ran.motion, &self.reference.motion);
            Ok(Done { errors, work: ran.work, unconverged: ran.unconverged, warned: ran.warned })
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

    /// Runs settings against the reference of this study, beside those that it has tried: for who
    /// wants to know what it passed over.
    ///
    /// # Errors
    /// If the user interrupts.
    pub fn beside(
        &self,
        settings: Vec<Setting>,
        source: &Source,
        threads: usize,
        cancel: &AtomicBool,
    ) -> Result<Vec<Row>, Failure> {
        self.tried(settings, 0, &Run { source, threads, cancel }, |_| {})
    }

    /// The rows whose time is worth measuring: the scene as it is and with other schemes and steps,
    /// the front, and for each accuracy those that are nearly as cheap as what is advised.
    fn to_time(&self) -> Vec<usize> {
        let mut timed = front_of(&self.rows);
        timed.extend((0..self.rows.len()).filter(|&row| self.rows[row].stage == 1));
        let held = Held::of(&self.rows, &self.axes);
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

    fn time(&mut self, source: &Source, cancel: &AtomicBool, tell: &mut Tell<'_>) -> Result<(), Failure> {
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
