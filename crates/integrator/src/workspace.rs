//! The memory and the contact solver of one worker.

use crate::blend::Term;
use crate::factors::Factors;
use crate::laws::Laws;
use crate::mismatch::{Identity, length};
use crate::phases::Phases;
use crate::stage::{Problem, RESERVED_CONTACTS};
use crate::subsystem::all_finite;
use crate::{
    Compliance, Contact, ContactError, ContactStage, Keep, Mismatch, Model, Part, PhaseEnd, PhaseKind, State,
    StateError, StepError, StepReport, StepSpan, Vector, Weights,
};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Stop};
use teeter_detect::{Candidates, ContactId, DetectorMemory};

/// When the contact solver of a run stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverSettings {
    /// Largest residual that counts as solved.
    pub tolerance: f64,
    /// Most iterations.
    pub max_iterations: u32,
}

impl Default for SolverSettings {
    fn default() -> Self {
        let Stop { tolerance, max_iterations, .. } = Stop::default();
        Self { tolerance, max_iterations }
    }
}

impl SolverSettings {
    pub(crate) fn stop(self, cancel: Option<&AtomicBool>) -> Stop<'_> {
        let stop = Stop::new(self.tolerance, self.max_iterations);
        cancel.map_or(stop, |flag| stop.with_cancel(flag))
    }
}

/// Whether steps keep the account of energies, and look how deep contacts have sunk in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Account {
    /// Every step is entered into the state's ledger.
    #[default]
    Kept,
    /// Nobody reads it: energies, their terms and the penetration are not computed, and ledger and tally don't know of them. The
    /// motion is the same.
    LeftOut,
}

/// How much work steps have taken, by count: the same on every machine, whatever its clock says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct WorkCounts {
    /// Factorisations of a subsystem's matrix.
    pub factorisations: u64,
    /// Looks at all bodies, or at some contacts, in one configuration.
    pub detections: u64,
    /// Contact problems that were handed to the solver.
    pub problems: u64,
    /// The contacts in them, added up.
    pub contacts: u64,
    /// Iterations of the solver over all of them.
    pub iterations: u64,
    /// Problems that were not solved to tolerance.
    pub unsolved: u64,
    /// Attempts at a step that the scheme refused and made anew.
    pub refused_attempts: u64,
}

impl WorkCounts {
    fn solved(&mut self, contacts: usize, outcome: &Outcome) {
        self.problems += 1;
        self.contacts += contacts as u64;
        self.iterations += u64::from(outcome.iterations);
        self.unsolved += u64::from(!outcome.converged());
    }

    /// Adds the solving of another thread.
    #[cfg(feature = "parallel")]
    pub(crate) fn add_solves(&mut self, other: &Self) {
        self.problems += other.problems;
        self.contacts += other.contacts;
        self.iterations += other.iterations;
        self.unsolved += other.unsolved;
    }

    /// Solves a problem whose contacts have the standard law.
    pub(crate) fn solve_standard<const D: usize>(
        &mut self,
        problem: &mut Problem<D>,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ContactError> {
        let (posed, p) = problem.pose()?;
        let outcome = solver.solve(&posed, stop, p);
        self.solved(p.len(), &outcome);
        Ok(outcome)
    }
}

/// A solver whose work is counted.
struct Counted<'a, const D: usize> {
    solver: &'a mut dyn ContactSolver<D>,
    counts: &'a mut WorkCounts,
}

impl<const D: usize> ContactSolver<D> for Counted<'_, D> {
    fn name(&self) -> &'static str {
        self.solver.name()
    }

    fn law(&self) -> Law {
        self.solver.law()
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.solver.reserve(contacts, blocks);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &mut [Vector<D>]) -> Outcome {
        let outcome = self.solver.solve(problem, stop, p);
        self.counts.solved(p.len(), &outcome);
        outcome
    }

    fn fork(&self) -> Box<dyn ContactSolver<D>> {
        self.solver.fork()
    }
}

/// The contact solver, the factors and the memory that any scheme needs. It carries nothing that decides a step.
#[non_exhaustive]
pub struct Workspace<const D: usize> {
    /// The contact solver.
    pub solver: Box<dyn ContactSolver<D>>,
    /// When it stops.
    pub settings: SolverSettings,
    /// A flag that abandons the step being taken when it is set: the step fails with [`ContactError::Cancelled`], which leaves the
    /// state as it was. It reaches into the iterations of the contact solver.
    pub cancel: Option<Arc<AtomicBool>>,
    /// Whether steps keep the account of energies.
    pub account: Account,
    /// What detection found last.
    pub candidates: Candidates<D>,
    /// As long as the model's velocities.
    pub scratch: Vec<f64>,
    /// The work of all steps so far.
    pub counts: WorkCounts,
    pub(crate) factors: Factors<D>,
    pub(crate) laws: Laws<D>,
    /// The solvers of the other threads.
    #[cfg(feature = "parallel")]
    pub(crate) forks: Vec<Box<dyn ContactSolver<D>>>,
    /// A problem with contacts that slide in given directions, as the solver sees it.
    directed: Problem<D>,
    /// Counts what changes the memory of the factors: a response may go by it only where nothing has come in between.
    pub(crate) coupled: u64,
    /// Whether a step was begun and not finished.
    open: bool,
    detection: DetectorMemory,
    phases: Phases<D>,
    /// The model that it was made for.
    model: Identity,
}

impl<const D: usize> std::fmt::Debug for Workspace<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Workspace").field("settings", &self.settings).finish_non_exhaustive()
    }
}

impl<const D: usize> Workspace<D> {
    /// Memory for a model's steps, with the solver to use.
    #[must_use]
    pub fn new(model: &Model<D>, mut solver: Box<dyn ContactSolver<D>>, settings: SolverSettings) -> Self {
        let contacts = model.detector().capacity().min(RESERVED_CONTACTS);
        let mut laws = Laws::default();
        if model.has_laws() {
            laws.reserve(contacts);
            solver.reserve(2 * contacts, 4 * contacts * contacts);
        } else {
            solver.reserve(contacts, contacts * contacts);
        }
        let mut phases = Phases::new();
        phases.reserve(contacts, model.size());
        Self {
            solver,
            settings,
            cancel: None,
            account: Account::Kept,
            candidates: Vec::with_capacity(contacts),
            scratch: vec![0.0; model.size().v],
            counts: WorkCounts::default(),
            factors: Factors::new(),
            laws,
            #[cfg(feature = "parallel")]
            forks: Vec::new(),
            directed: Problem::default(),
            coupled: 0,
            open: false,
            detection: DetectorMemory::default(),
            phases,
            model: model.identity(),
        }
    }

    /// Makes room for steps of so many phases.
    pub(crate) fn reserve_phases(&mut self, model: &Model<D>, phases: usize) {
        let contacts = model.detector().capacity().min(RESERVED_CONTACTS);
        self.phases.reserve_more(phases, contacts, model.size());
    }

    /// Makes room for the mean of the velocities over a step's only phase.
    pub(crate) fn reserve_mean_velocity(&mut self, model: &Model<D>) {
        self.phases.reserve_mean_velocity(model.size());
    }

    /// Makes room for contacts that slide in given directions.
    pub(crate) fn reserve_directed(&mut self, model: &Model<D>) {
        self.directed.reserve(model.detector().capacity().min(RESERVED_CONTACTS));
    }

    /// The contacts of all phases that were ended in this step.
    pub(crate) fn contacts_and_factors(&mut self) -> (impl Iterator<Item = &Contact<D>>, &mut Factors<D>) {
        (self.phases.contacts(), &mut self.factors)
    }

    /// Whether it was made for this model, and its memory still fits it: else steps would take the factors of another.
    ///
    /// # Errors
    /// If it wasn't, or doesn't.
    #[inline]
    pub fn check(&self, model: &Model<D>) -> Result<(), Mismatch> {
        if self.model != model.identity() {
            let remedy = "make one for this model with Workspace::new";
            return Err(Mismatch::OtherModel { what: "the workspace is that", remedy });
        }
        length("the workspace's scratch", &self.scratch, model.size().v)
    }

    #[inline]
    fn check_at(&self, model: &Model<D>, q: &[f64]) -> Result<(), Mismatch> {
        self.check(model)?;
        length("the coordinates", q, model.size().q)
    }

    /// Sees to it that there are factors of `mass·M + damping·C + stiffness·K` for all subsystems at coordinates `q`. Some combinations are
    /// kept, so that a scheme may alternate them; see [`Keep`]. The factor of a subsystem that [follows its
    /// coordinates](crate::Traits) may be of the coordinates at which it was made: [`Compliance::update`] takes it to others. Allocates nothing once as many have been asked for as are kept.
    ///
    /// # Errors
    /// If a matrix can't be factorised, or the workspace is of another model, or there are too few or too many coordinates.
    #[inline]
    pub fn factors(&mut self, model: &Model<D>, w: Weights, q: &[f64], keep: Keep) -> Result<(), StepError> {
        self.check_at(model, q)?;
        let made = self.factors.made();
        let done = self.factors.make(model, w, q, keep);
        self.counts.factorisations += self.factors.made() - made;
        done.map_err(StepError::Factor)
    }

    /// Sees to it that there are sums of two factors for all subsystems, by a key.
    pub(crate) fn blended_factors(
        &mut self,
        model: &Model<D>,
        key: Weights,
        keep: Keep,
        q: &[f64],
        terms: impl Fn(&Part<D>) -> [Term; 2],
    ) -> Result<(), StepError> {
        self.check_at(model, q)?;
        let made = self.factors.made();
        let done = self.factors.make_blends(model, key, keep, q, terms);
        self.counts.factorisations += self.factors.made() - made;
        done.map_err(StepError::Factor)
    }

    /// The factor of a subsystem, by its number; `None` where [`Workspace::factors`] was not asked for these weights, or too long ago.
    #[inline]
    pub fn factor(&mut self, part: usize, w: Weights) -> Option<&mut dyn Compliance<D>> {
        // Whoever has it may change it, its weights too.
        self.coupled += 1;
        self.factors.lend(part, w)
    }

    /// Puts the candidates with a gap of at most `margin` (m) at coordinates `q` into `candidates`, in order of identity.
    ///
    /// # Errors
    /// If the workspace is of another model, or there are too few or too many coordinates, or the detector finds pairs or bodies that the model
    /// doesn't have.
    #[inline(always)]
    pub fn detect(&mut self, model: &Model<D>, q: &[f64], margin: f64) -> Result<(), Mismatch> {
        self.check_at(model, q)?;
        self.candidates.clear();
        if model.has_contacts() {
            self.counts.detections += 1;
            model.detector().detect(&model.placed_at(q), margin, &mut self.detection, &mut self.candidates);
            self.candidates.sort_unstable_by_key(|candidate| candidate.id);
            model.check_candidates(&self.candidates)?;
        }
        Ok(())
    }

    /// Whether [`Workspace::cancel`] is set.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancel.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// As [`Workspace::detect`], and the contacts `ids`, which rise, are among the candidates however large their gaps, as with an
    /// infinite margin; `found` is memory. An infinite margin would find all pairs of a scene of many bodies.
    pub(crate) fn detect_with(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        margin: f64,
        ids: &[ContactId],
        found: &mut Candidates<D>,
    ) -> Result<(), Mismatch> {
        found.clear();
        if !ids.is_empty() {
            self.locate(model, q, ids, found)?;
        }
        let margin = found.iter().map(|candidate| candidate.gap).fold(margin, f64::max);
        self.detect(model, q, margin)
    }

    /// Puts those of the contacts `ids`, which rise, into `out`, however large their gaps at coordinates `q`.
    ///
    /// # Errors
    /// As [`Workspace::detect`].
    pub fn locate(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        ids: &[ContactId],
        out: &mut Candidates<D>,
    ) -> Result<(), Mismatch> {
        self.check_at(model, q)?;
        self.counts.detections += 1;
        model.detector().locate(&model.placed_at(q), ids, out);
        Ok(())
    }

    /// The same, but past the ends of surfaces, too, with the room that is left to the nearest end, m
    /// ([`ContactDetector::locate_past_ends`](teeter_detect::ContactDetector::locate_past_ends)).
    ///
    /// # Errors
    /// As [`Workspace::detect`].
    pub fn locate_past_ends(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        ids: &[ContactId],
        out: &mut Candidates<D>,
        room: &mut Vec<f64>,
    ) -> Result<(), Mismatch> {
        self.check_at(model, q)?;
        self.counts.detections += 1;
        model.detector().locate_past_ends(&model.placed_at(q), ids, out, room);
        Ok(())
    }

    /// Deepest penetration at coordinates `q`, m; 0 if there is none. May change `candidates`.
    ///
    /// # Errors
    /// As [`Workspace::detect`].
    #[inline]
    pub fn penetration(&mut self, model: &Model<D>, q: &[f64]) -> Result<f64, Mismatch> {
        self.check_at(model, q)?;
        if !model.has_contacts() {
            return Ok(0.0);
        }
        self.counts.detections += 1;
        Ok(model.detector().deepest(&model.placed_at(q), &mut self.detection, &mut self.candidates))
    }

    /// Solves a problem, whose H is there, by its rules; `weight` is that of the velocity after in the mean that impulses do work with.
    #[inline]
    pub(crate) fn solve_problem(&mut self, problem: &mut Problem<D>, weight: f64) -> Result<Outcome, ContactError> {
        let cancel = self.cancel.clone();
        let stop = self.settings.stop(cancel.as_deref());
        let outcome = if problem.is_standard() {
            self.counts.solve_standard(problem, self.solver.as_mut(), &stop)?
        } else {
            self.solve_by_rules(problem, weight, &stop)?
        };
        // Even where it converged: a refinement may have been cut short, so that the step would
        // depend on the moment of the flag.
        if stop.cancelled() { Err(ContactError::Cancelled) } else { Ok(outcome) }
    }

    /// The same for rules that are more than a shift.
    #[inline(never)]
    fn solve_by_rules(
        &mut self,
        problem: &mut Problem<D>,
        weight: f64,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ContactError> {
        let mut solver = Counted { solver: self.solver.as_mut(), counts: &mut self.counts };
        if problem.has_directions() {
            problem.with_directions(&mut self.directed)?;
            let (posed, p) = self.directed.pose()?;
            let outcome = solver.solve(&posed, stop, p);
            problem.take_directed(&self.directed);
            return Ok(outcome);
        }
        Ok(self.laws.solve(problem, weight, &mut solver, stop)?)
    }

    /// Begins a step of `span` from `state`. What a scheme does in every step is this, one [`phase`](Self::phase) or more, and
    /// [`finish`](Self::finish), which alone changes the state: after an error in between it is as it was.
    ///
    /// # Errors
    /// If state or workspace are of another model, or the step has no time.
    #[inline]
    pub fn begin(&mut self, model: &Model<D>, state: &State, span: StepSpan) -> Result<(), StepError> {
        state.check(model)?;
        self.check(model)?;
        // Written so that NaN fails too.
        if !(span.h > 0.0 && span.h <= f64::MAX && span.start == state.t && span.end >= span.start) {
            return Err(StateError::StepSize(span.h).into());
        }
        self.phases.begin(span);
        self.open = true;
        Ok(())
    }

    /// Ends a phase of the step that was begun: kind, end, places and velocities there, and the contacts of `stage`, which is solved and
    /// [complete](ContactStage::complete), and empty after it. Their work is added to the phase's energy terms.
    ///
    /// # Errors
    /// If coordinates, velocities or energies are not finite, or as many as the model needs.
    #[inline(always)]
    pub fn phase(
        &mut self,
        model: &Model<D>,
        phase: &PhaseEnd<'_>,
        stage: Option<&mut ContactStage<D>>,
    ) -> Result<(), StepError> {
        if !self.open {
            return Err(StepError::NotBegun);
        }
        model.fits(phase.q, phase.v)?;
        if let Some(stage) = &stage {
            stage.check(model)?;
            if let Some(contact) = stage.out_of_order() {
                return Err(Mismatch::ContactOrder { contact }.into());
            }
            if stage.holds_forces() {
                return Err(StepError::Problem { t: self.phases.span.start, source: ContactError::Forces });
            }
        }
        let t = self.phases.span.start;
        let now = match self.account {
            Account::Kept => {
                let now = model.energy_at(phase.q, phase.v);
                if !now.total().is_finite() {
                    return Err(StepError::Diverged { t });
                }
                Some(now)
            }
            Account::LeftOut => {
                // Over any time, velocities that are not finite leave coordinates that aren't.
                if phase.kind == PhaseKind::Impact && !all_finite(phase.v) {
                    return Err(StepError::Diverged { t });
                }
                None
            }
        };
        if !all_finite(phase.q) {
            return Err(StepError::Diverged { t });
        }
        self.phases.enter(model, phase, stage, now);
        Ok(())
    }

    /// Ends the step: the state moves to the end of the last phase and of the step's time, phases are entered into ledger and tally, the
    /// solver's next start is kept, and those contacts of the last phase of which `stays` says so, by number and contact, count as
    /// active from now on; springs that were pressed before an impact at the end stay pressed. `penetration` (m) is that at the end, if the scheme has looked; else it is looked for where an
    /// [account](Account) is kept.
    ///
    /// # Errors
    /// If there was no phase.
    #[inline(always)]
    pub fn finish(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        penetration: Option<f64>,
        mut stays: impl FnMut(usize, &Contact<D>) -> bool,
    ) -> Result<StepReport<'_, D>, StepError> {
        if !self.open {
            return Err(StepError::NotBegun);
        }
        if !self.phases.has_any() {
            return Err(StepError::NoPhase);
        }
        self.check(model)?;
        model.fits(&state.q, &state.v)?;
        self.open = false;
        let account = self.account == Account::Kept;
        self.phases.settle(state, account);
        let penetration = match penetration {
            Some(penetration) => penetration,
            None if account && model.has_contacts() => {
                self.counts.detections += 1;
                model.detector().deepest(&model.placed_at(&state.q), &mut self.detection, &mut self.candidates)
            }
            None => 0.0,
        };
        state.count_step(&self.phases.span);
        state.warm.clear();
        state.memory.forget_contacts();
        if model.has_springs() {
            self.remember_with_springs(state, stays);
        } else {
            for (_, contact) in self.phases.last_contacts().iter().enumerate().filter(|(i, contact)| stays(*i, contact))
            {
                remember(state, contact);
            }
        }
        state.tally.count(self.phases.outcomes(), self.phases.most_contacts(), penetration);
        Ok(self.phases.report(state.step, penetration))
    }

    /// Keeps the contacts of the last phase that stay, and springs that were pressed before an
    /// impact at its end.
    #[inline(never)]
    fn remember_with_springs(&self, state: &mut State, mut stays: impl FnMut(usize, &Contact<D>) -> bool) {
        let mut springs = self.phases.springs_before_impact().peekable();
        for (i, contact) in self.phases.last_contacts().iter().enumerate() {
            while let Some(spring) = springs.next_if(|spring| spring.id < contact.id) {
                remember(state, spring);
            }
            if stays(i, contact) {
                remember(state, contact);
            }
        }
        springs.for_each(|spring| remember(state, spring));
    }
}

/// Keeps a contact as active, and its impulse as the solver's next start.
#[inline]
fn remember<const D: usize>(state: &mut State, contact: &Contact<D>) {
    state.warm.push(contact.id, &contact.p);
    state.memory.remember(contact);
}
