//! The memory and the contact solver of one worker.

use crate::contacts::ContactSet;
use crate::{Compliance, FactorError, Model, Weights};
use teeter_contact::{ContactSolver, Stop};
use teeter_detect::Candidates;

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

/// All memory that steps need, and the contact solver. It carries nothing that decides a step.
pub struct Workspace<const D: usize> {
    pub(crate) solver: Box<dyn ContactSolver<D>>,
    pub(crate) settings: SolverSettings,
    pub(crate) factors: Vec<Box<dyn Compliance<D>>>,
    pub(crate) candidates: Candidates<D>,
    pub(crate) contacts: ContactSet<D>,
    /// Coordinates at which forces or gaps are taken.
    pub(crate) q_at: Vec<f64>,
    /// Velocities, or their increments.
    pub(crate) v_free: Vec<f64>,
    pub(crate) v_mean: Vec<f64>,
    pub(crate) dq: Vec<f64>,
    pub(crate) dv: Vec<f64>,
    pub(crate) load: Vec<f64>,
    pub(crate) product: Vec<f64>,
    pub(crate) scratch: Vec<f64>,
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
        solver.reserve(contacts, contacts * contacts);
        let size = model.size();
        let v = || vec![0.0; size.v];
        Self {
            solver,
            settings,
            factors: Vec::with_capacity(model.subsystems()),
            candidates: Vec::with_capacity(contacts),
            contacts: ContactSet::with_capacity(contacts, size.row),
            q_at: vec![0.0; size.q],
            v_free: v(),
            v_mean: v(),
            dq: v(),
            dv: v(),
            load: v(),
            product: v(),
            scratch: v(),
        }
    }

    /// Makes `factors` the inverses of these weights: once for a given step size.
    pub(crate) fn factorise(&mut self, model: &Model<D>, w: Weights, q: &[f64]) -> Result<(), FactorError> {
        if self.factors.is_empty() {
            for part in model.parts() {
                self.factors.push(part.system.factor(w, &q[part.q.clone()])?);
            }
            return Ok(());
        }
        for (factor, part) in self.factors.iter_mut().zip(model.parts()) {
            if factor.weights() != w {
                factor.refactor(w, &q[part.q.clone()])?;
            }
        }
        Ok(())
    }
}
