//! The memory and the contact solver of one worker.

use crate::apart::{Apart, MANY};
use crate::contacts::{ContactError, ContactSet, Rule};
use crate::laws::Laws;
use crate::mismatch::{Identity, length};
use crate::{Compliance, FactorError, Mismatch, Model, StepError, Vector, Weights};
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Stop};
use teeter_detect::{Candidates, ContactId};

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

/// Contacts that are reserved for at the most; beyond it, a step with more contacts than ever before allocates. The
/// dense operator of this many takes 2 MB in the plane.
const RESERVED_CONTACTS: usize = 256;

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
    /// The inverses of the effective mass matrices, one a subsystem.
    pub factors: Vec<Box<dyn Compliance<D>>>,
    /// What detection found last.
    pub candidates: Candidates<D>,
    /// The contacts of the step.
    pub contacts: ContactSet<D>,
    /// As long as the model's velocities.
    pub scratch: Vec<f64>,
    /// The work of all steps so far.
    pub counts: WorkCounts,
    pub(crate) laws: Laws<D>,
    apart: Apart<D>,
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
        Self {
            solver,
            settings,
            factors: Vec::with_capacity(model.parts().len()),
            candidates: Vec::with_capacity(contacts),
            contacts: ContactSet::with_capacity(contacts, model.size().row),
            scratch: vec![0.0; model.size().v],
            counts: WorkCounts::default(),
            laws,
            apart: Apart::default(),
            model: model.identity(),
        }
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
        length("the workspace's scratch", &self.scratch, model.size().v)?;
        let expected = if self.factors.is_empty() { 0 } else { model.parts().len() };
        length("the workspace's factors", &self.factors, expected)
    }

    fn check_at(&self, model: &Model<D>, q: &[f64]) -> Result<(), Mismatch> {
        self.check(model)?;
        length("the coordinates", q, model.size().q)
    }

    /// Makes `factors` the inverses of these weights: once for a given step size.
    ///
    /// # Errors
    /// If a matrix can't be factorised, or the workspace is of another model, or there are too few or too many coordinates.
    pub fn factorise(&mut self, model: &Model<D>, w: Weights, q: &[f64]) -> Result<(), StepError> {
        self.check_at(model, q)?;
        Ok(self.factorise_all(model, w, q)?)
    }

    /// The same for what is known to fit.
    #[inline]
    pub(crate) fn factorise_all(&mut self, model: &Model<D>, w: Weights, q: &[f64]) -> Result<(), FactorError> {
        if self.factors.is_empty() {
            for part in model.parts() {
                match part.system.factor(w, &q[part.q.clone()]) {
                    Ok(factor) => self.factors.push(factor),
                    Err(error) => {
                        // All or none: some would look like those of another model.
                        self.factors.clear();
                        return Err(error);
                    }
                }
                self.counts.factorisations += 1;
            }
            return Ok(());
        }
        for (factor, part) in self.factors.iter_mut().zip(model.parts()) {
            if factor.weights() != w {
                if let Err(error) = factor.refactor(w, &q[part.q.clone()]) {
                    // It may hold neither these weights nor those before.
                    self.factors.clear();
                    return Err(error);
                }
                self.counts.factorisations += 1;
            }
        }
        Ok(())
    }

    /// Puts the candidates with a gap of at most `margin` (m) at coordinates `q` into `candidates`, in order of identity.
    ///
    /// # Errors
    /// If the workspace is of another model, or there are too few or too many coordinates, or the detector finds pairs or bodies that the model
    /// doesn't have.
    pub fn detect(&mut self, model: &Model<D>, q: &[f64], margin: f64) -> Result<(), Mismatch> {
        self.check_at(model, q)?;
        self.detect_at(model, q, margin)
    }

    /// The same for what is known to fit.
    #[inline]
    pub(crate) fn detect_at(&mut self, model: &Model<D>, q: &[f64], margin: f64) -> Result<(), Mismatch> {
        self.candidates.clear();
        if model.has_contacts() {
            self.counts.detections += 1;
            model.detector().detect(&model.placed_at(q), margin, &mut self.candidates);
            self.candidates.sort_unstable_by_key(|candidate| candidate.id);
            model.check_candidates(&self.candidates)?;
        }
        Ok(())
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
        self.locate_at(model, q, ids, out);
        Ok(())
    }

    /// The same for what is known to fit.
    pub(crate) fn locate_at(&mut self, model: &Model<D>, q: &[f64], ids: &[ContactId], out: &mut Candidates<D>) {
        self.counts.detections += 1;
        model.detector().locate(&model.placed_at(q), ids, out);
    }

    /// Deepest penetration at coordinates `q`, m; 0 if there is none. May change `candidates`.
    ///
    /// # Errors
    /// As [`Workspace::detect`].
    pub fn penetration(&mut self, model: &Model<D>, q: &[f64]) -> Result<f64, Mismatch> {
        self.check_at(model, q)?;
        Ok(self.penetration_at(model, q))
    }

    /// The same for what is known to fit.
    #[inline]
    pub(crate) fn penetration_at(&mut self, model: &Model<D>, q: &[f64]) -> f64 {
        if !model.has_contacts() {
            return 0.0;
        }
        self.counts.detections += 1;
        model.detector().deepest(&model.placed_at(q), &mut self.candidates)
    }

    /// Assembles and solves the problem of `contacts`, and adds W Jᵀ p to `v`, which becomes the velocity after the step. θ is
    /// that of the step's mean velocity: by it a law knows the work of its impulses.
    ///
    /// # Errors
    /// If the contacts don't make a problem: a number is not finite, a contact can't move, or the scheme that posed them knows nothing of
    /// a contact's law; or if workspace, contacts or velocities are of another model.
    pub fn solve_contacts(&mut self, model: &Model<D>, theta: f64, v: &mut [f64]) -> Result<Outcome, ContactError> {
        self.check(model)?;
        length("the velocities", v, model.size().v)?;
        length("the factors", &self.factors, model.parts().len())?;
        self.contacts.check(model)?;
        self.contacts.check_laws()?;
        self.solve_entered(model, theta, v)
    }

    /// The same for what is known to fit, by a scheme that handles every law.
    #[inline]
    pub(crate) fn solve_entered(
        &mut self,
        model: &Model<D>,
        theta: f64,
        v: &mut [f64],
    ) -> Result<Outcome, ContactError> {
        let apart = if self.contacts.contacts().len() < MANY { None } else { self.solve_apart(model)? };
        let outcome = match apart {
            Some(outcome) => outcome,
            None => {
                self.assemble_contacts(model);
                self.solve_assembled(theta)?
            }
        };
        self.apply_impulses(model, v);
        Ok(outcome)
    }

    /// Solves the problem of `contacts`, which are many, by islands, if they stand apart.
    fn solve_apart(&mut self, model: &Model<D>) -> Result<Option<Outcome>, ContactError> {
        let contacts = self.contacts.contacts().len();
        let SolverSettings { tolerance, max_iterations } = self.settings;
        let stop = Stop::new(tolerance, max_iterations);
        let Self { apart, solver, factors, scratch, contacts: set, .. } = self;
        let outcome = apart.solve(set, model, factors, scratch, |problem, p| solver.solve(problem, &stop, p))?;
        if let Some(outcome) = &outcome {
            self.counts.solved(contacts, outcome);
        }
        Ok(outcome)
    }

    /// H of `contacts`.
    pub(crate) fn assemble_contacts(&mut self, model: &Model<D>) {
        self.contacts.couple(model, &mut self.factors, &mut self.scratch);
    }

    /// Solves the problem of `contacts`, whose H is there, by their rules.
    pub(crate) fn solve_assembled(&mut self, theta: f64) -> Result<Outcome, ContactError> {
        let SolverSettings { tolerance, max_iterations } = self.settings;
        let stop = Stop::new(tolerance, max_iterations);
        if self.contacts.rules.iter().any(|rule| *rule != Rule::Shifted) {
            let mut solver = Counted { solver: self.solver.as_mut(), counts: &mut self.counts };
            return Ok(self.laws.solve(&mut self.contacts, theta, &mut solver, &stop)?);
        }
        let (problem, p) = self.contacts.posed_problem()?;
        let outcome = self.solver.solve(&problem, &stop, p);
        self.counts.solved(p.len(), &outcome);
        Ok(outcome)
    }

    /// Adds W Jᵀ p to `v`, and completes `contacts` with the velocities after the step.
    pub(crate) fn apply_impulses(&mut self, model: &Model<D>, v: &mut [f64]) {
        self.contacts.respond(model, &mut self.factors, &mut self.scratch, v);
        self.contacts.settle(v);
    }
}
