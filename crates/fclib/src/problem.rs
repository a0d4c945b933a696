//! A local problem in memory.

use teeter_contact::{BlockSparse, ContactProblem, Delassus, OwnedProblem, ProblemError, Vector};

/// A problem of either dimension.
#[derive(Clone, Debug, PartialEq)]
pub enum FclibProblem {
    /// Contacts in the plane: a normal and a tangent.
    Plane(LocalProblem<2>),
    /// Contacts in space: a normal and two tangents.
    Space(LocalProblem<3>),
}

impl FclibProblem {
    /// 2 or 3.
    #[must_use]
    pub fn dimension(&self) -> usize {
        match self {
            Self::Plane(_) => 2,
            Self::Space(_) => 3,
        }
    }

    /// Number of contacts.
    #[must_use]
    pub fn contacts(&self) -> usize {
        match self {
            Self::Plane(local) => local.q.len(),
            Self::Space(local) => local.q.len(),
        }
    }

    /// The description of the problem.
    #[must_use]
    pub fn info(&self) -> &Info {
        match self {
            Self::Plane(local) => &local.info,
            Self::Space(local) => &local.info,
        }
    }
}

/// A contact problem that owns its data, with FCLIB's additional information.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LocalProblem<const D: usize> {
    /// The Delassus operator W, 1/kg (or its inverse stiffness, for a quasi-static problem).
    pub h: BlockSparse<D>,
    /// The constant vector, one for each contact, normal component first.
    pub q: Vec<Vector<D>>,
    /// The friction coefficient of each contact.
    pub mu: Vec<f64>,
    /// Title and description.
    pub info: Info,
    /// Initial guesses for a solver.
    pub guesses: Vec<Solution<D>>,
    /// A solution.
    pub solution: Option<Solution<D>>,
}

impl<const D: usize> LocalProblem<D> {
    /// A problem as it is written to a file, without additional information. Zero blocks are left
    /// out.
    #[must_use]
    pub fn of(problem: &ContactProblem<'_, D>) -> Self {
        let mut local = Self { q: problem.q().to_vec(), mu: problem.mu().to_vec(), ..Self::default() };
        local.h.gather(problem);
        local
    }

    /// The contact problem with this data, without FCLIB's additional information.
    ///
    /// # Errors
    /// As [`ContactProblem::new`]; never for a problem read from a file.
    pub fn into_owned(self) -> Result<OwnedProblem<D>, ProblemError> {
        OwnedProblem::sparse(self.h, self.q, self.mu)
    }

    /// The contact problem borrowing this data.
    ///
    /// # Errors
    /// As [`ContactProblem::new`]; never for a problem read from a file.
    pub fn problem(&self) -> Result<ContactProblem<'_, D>, ProblemError> {
        ContactProblem::new(Delassus::Blocks(&self.h), &self.q, &self.mu)
    }
}

/// A file's description of its problem; `None` where it has none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Info {
    /// A short title.
    pub title: Option<String>,
    /// A description.
    pub description: Option<String>,
    /// The mathematics: conventions, properties.
    pub math_info: Option<String>,
}

/// A solution of a problem, or an initial guess.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solution<const D: usize> {
    /// The relative velocities.
    pub u: Vec<Vector<D>>,
    /// The impulses.
    pub r: Vec<Vector<D>>,
    /// Global velocities; usually empty for local problems.
    pub v: Vec<f64>,
    /// Multipliers of equality constraints; usually empty for problems without such constraints.
    pub l: Vec<f64>,
}
