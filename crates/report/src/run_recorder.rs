//! All that a run writes, by one observer: tables, what the page shows, contact problems, checkpoints of all these.

use crate::checkpoint::{CHECKPOINT, Checkpoint, Head, Identity, Moment, Rest, sealed};
use crate::results::write_whole;
use crate::{Exporter, PageRecorder, Record, Recorder, Results, ResultsError, Schedule};
use std::borrow::Cow;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;
use teeter_integrator::{Model, Observer, ObserverError, State, StepReport};
use teeter_scenario::diagnostic::Diagnostic;
use teeter_scenario::scene::Scene;
use teeter_scenario::simulation::Layout;

/// What a file of a run says of its origin.
#[derive(Clone, Copy, Debug)]
pub struct Origin<'a> {
    /// Program, scene and options.
    pub identity: &'a Identity,
    /// The time scheme's name.
    pub scheme: &'a str,
}

/// Writes checkpoints.
#[derive(Debug)]
struct Checkpoints<'a> {
    results: &'a Results,
    origin: Origin<'a>,
    every: f64,
    schedule: Schedule,
    /// Whether the last step is one to go on from.
    may_go_on: bool,
    /// Memory of the last one.
    file: Vec<u8>,
}

/// Writes the state before the first step that is not solved.
#[derive(Debug)]
struct Dump<'a> {
    path: PathBuf,
    origin: Origin<'a>,
    /// The state at the end of the step before; none once it is written.
    before: Option<State>,
}

/// The observer of a run that is to be resumed to the same bytes: each step has been seen by all its parts, or by none.
#[derive(Debug)]
pub struct RunRecorder<'a> {
    layout: &'a Layout,
    recorder: Recorder<'a>,
    page: PageRecorder,
    exporter: Option<Exporter>,
    checkpoints: Option<Checkpoints<'a>>,
    dump: Option<Dump<'a>>,
    end: Option<Arc<AtomicBool>>,
    require_convergence: bool,
    resumed: bool,
    begin: Instant,
    /// Time that the steps took before this part of the run, s.
    seconds_before: f64,
}

impl<'a> RunRecorder<'a> {
    /// The recorder of a run of `scene` that goes on from `checkpoint`, if there is one: then [`Results`] are those reopened, and the
    /// run's state is that of the checkpoint. `tell` hears warnings as they come.
    ///
    /// # Errors
    /// If a table can't be written.
    pub fn new(
        results: &Results,
        scene: &Scene,
        layout: &'a Layout,
        mut exporter: Option<Exporter>,
        checkpoint: Option<Checkpoint>,
        tell: &'a mut dyn FnMut(&str),
    ) -> Result<Self, ResultsError> {
        let mut page = PageRecorder::new(scene, layout);
        let (resumed, mut seconds_before) = (checkpoint.is_some(), 0.0);
        let recorder = match checkpoint {
            None => Recorder::new(results, scene, layout, tell)?,
            Some(Checkpoint { rest }) => {
                seconds_before = rest.seconds;
                page.restore(rest.page.into_owned());
                if let (Some(exporter), Some(kept)) = (&mut exporter, rest.export) {
                    exporter.restore(kept.into_owned());
                }
                Recorder::resume(results, (rest.recorder.into_owned(), rest.tables), scene, layout, tell)?
            }
        };
        Ok(Self {
            layout,
            recorder,
            page,
            exporter,
            checkpoints: None,
            dump: None,
            end: None,
            require_convergence: scene.solver.require_convergence,
            resumed,
            begin: Instant::now(),
            seconds_before,
        })
    }

    /// Notes what looked wrong before the run, if this is its beginning.
    pub fn note(&mut self, findings: &[Diagnostic]) {
        if !self.resumed {
            self.recorder.note(findings);
        }
    }

    /// Writes a checkpoint at the first step at or past each multiple of `every` (s), and at the last step of a run that is
    /// ended by [`until`](Self::until).
    #[must_use]
    pub fn with_checkpoints(mut self, results: &'a Results, origin: Origin<'a>, every: f64) -> Self {
        let schedule = Schedule::new(Some(every), u64::MAX, 0.0);
        self.checkpoints = Some(Checkpoints { results, origin, every, schedule, may_go_on: true, file: Vec::new() });
        self
    }

    /// Writes the state before the first step whose contact problem is not solved to the file `path`.
    #[must_use]
    pub fn with_dump(mut self, path: &Path, origin: Origin<'a>) -> Self {
        self.dump = Some(Dump { path: path.to_owned(), origin, before: None });
        self
    }

    /// Ends the run after the step in which `end` is set, or at the step before it where that
    /// abandons the step ([`Simulation::cancelled_by`](teeter_scenario::simulation::Simulation::cancelled_by)).
    #[must_use]
    pub fn until(mut self, end: Arc<AtomicBool>) -> Self {
        self.end = Some(end);
        self
    }

    /// Time since the start of the run, in all its parts, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.seconds_before + self.begin.elapsed().as_secs_f64()
    }

    /// What was seen, for summary and page.
    #[must_use]
    pub fn into_parts(self) -> (Record, PageRecorder, Option<Exporter>) {
        let mut page = self.page;
        page.points_of_no_return = self.recorder.points_of_no_return();
        let record = self.recorder.into_record();
        page.beams.clone_from(&record.beams);
        (record, page, self.exporter)
    }

    /// Whether the run is to end.
    fn ends(&self) -> bool {
        self.end.as_ref().is_some_and(|end| end.load(Ordering::Relaxed))
    }

    fn write_checkpoint(&mut self, state: &State) -> Result<(), ObserverError> {
        let seconds = self.seconds();
        let Some(checkpoints) = &mut self.checkpoints else { return Ok(()) };
        let Origin { identity, scheme } = checkpoints.origin;
        let (recorder, tables) = self.recorder.keep()?;
        let moment = Moment::of(state, self.layout, scheme);
        let rest = Rest {
            state: Cow::Borrowed(state),
            seconds,
            tables,
            recorder: Cow::Borrowed(recorder),
            page: Cow::Borrowed(self.page.keep()),
            export: self.exporter.as_ref().map(|exporter| Cow::Borrowed(exporter.keep())),
        };
        let head = Head { identity: Cow::Borrowed(identity), moment, whole: true };
        let file = &mut checkpoints.file;
        let room = file.capacity();
        *file = sealed(std::mem::take(file), &head, Some(&rest))?;
        // What a run keeps varies between the most and half of it, as full curves are halved: with room for twice as much
        // as once was too much, it doesn't grow again.
        if file.capacity() > room {
            file.reserve_exact(file.len());
        }
        Ok(checkpoints.results.write(CHECKPOINT, &checkpoints.file)?)
    }
}

impl Dump<'_> {
    fn see(&mut self, layout: &Layout, state: &State, solved: bool) -> Result<(), ObserverError> {
        let Some(before) = &mut self.before else { return Ok(()) };
        if solved {
            before.copy_from(state);
            return Ok(());
        }
        let Origin { identity, scheme } = self.origin;
        let moment = Moment::of(before, layout, scheme);
        let file = sealed(Vec::new(), &Head { identity: Cow::Borrowed(identity), moment, whole: false }, None)?;
        write_whole(&self.path, &file)?;
        self.before = None;
        Ok(())
    }
}

impl Observer<2> for RunRecorder<'_> {
    fn start(&mut self, model: &Model<2>, state: &State) -> Result<(), ObserverError> {
        self.begin = Instant::now();
        if let Some(checkpoints) = &mut self.checkpoints {
            let schedule = Schedule::new(Some(checkpoints.every), u64::MAX, state.dt);
            checkpoints.schedule = schedule.starting_at(state.step);
        }
        if let Some(dump) = &mut self.dump {
            dump.before = (state.tally.unconverged_steps == 0).then(|| state.clone());
        }
        if self.resumed {
            return Ok(());
        }
        self.recorder.start(model, state)?;
        self.page.see_sections(self.recorder.section_values());
        self.page.start(model, state)
    }

    fn observe(
        &mut self,
        model: &Model<2>,
        step: &StepReport<'_, 2>,
        state: &State,
    ) -> Result<ControlFlow<()>, ObserverError> {
        let stops = self.recorder.observe(model, step, state)?.is_break();
        self.page.see_sections(self.recorder.section_values());
        self.page.see_step(step, state, self.recorder.closed());
        if let Some(exporter) = &mut self.exporter {
            let _ = exporter.observe(model, step, state)?;
        }
        if let Some(dump) = &mut self.dump {
            dump.see(self.layout, state, step.is_solved())?;
        }
        let ends = self.ends();
        if let Some(checkpoints) = &mut self.checkpoints {
            let due = checkpoints.schedule.takes(state.step, state.t);
            // A run that ends here for good must not go on from here.
            checkpoints.may_go_on = !stops && (step.is_solved() || !self.require_convergence);
            if due && checkpoints.may_go_on {
                self.write_checkpoint(state)?;
            }
        }
        Ok(if ends || stops { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    fn finish(&mut self, model: &Model<2>, state: &State) -> Result<(), ObserverError> {
        // Before the tables are ended, as they go on from it.
        if self.ends() && self.checkpoints.as_ref().is_some_and(|checkpoints| checkpoints.may_go_on) {
            self.write_checkpoint(state)?;
        }
        self.recorder.finish(model, state)?;
        self.page.finish(model, state)
    }
}
