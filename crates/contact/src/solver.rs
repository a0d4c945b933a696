//! The interface of contact solvers, and how a solve ends.

use crate::{ContactProblem, Residual, Vector};
use std::sync::atomic::{AtomicBool, Ordering};

/// The law that a solver's result obeys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// Signorini's condition with Coulomb's friction, exactly.
    Exact,
    /// The associated (convex) law: a sliding contact separates at μ‖u_T‖. Never counted as exact.
    Convex,
}

/// When a solver stops.
///
/// ```
/// use teeter_contact::Stop;
///
/// let stop = Stop::default().with_tolerance(1e-12);
/// assert_eq!((stop.tolerance, stop.max_iterations), (1e-12, 10_000));
/// ```
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Stop<'a> {
    /// Largest global residual of [`judge()`](crate::judge()) that counts as solved; without unit.
    pub tolerance: f64,
    /// Most iterations; each solver's page says what it counts as one.
    pub max_iterations: u32,
    /// A flag by which another thread or a signal handler ends the solve early.
    pub cancel: Option<&'a AtomicBool>,
}

impl<'a> Stop<'a> {
    /// Stops at this global residual or after this many iterations, whichever comes first.
    #[must_use]
    pub fn new(tolerance: f64, max_iterations: u32) -> Self {
        Self { tolerance, max_iterations, cancel: None }
    }

    /// The same with another tolerance.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// The same with another number of iterations.
    #[must_use]
    pub fn with_max_iterations(self, max_iterations: u32) -> Self {
        Self { max_iterations, ..self }
    }

    /// The same with a flag that ends the solve early when it is set.
    #[must_use]
    pub fn with_cancel(self, cancel: &'a AtomicBool) -> Self {
        Self { cancel: Some(cancel), ..self }
    }

    /// Whether the caller wants the solve to end.
    #[must_use]
    pub fn cancelled(&self) -> bool {
        self.cancel.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }
}

impl Default for Stop<'_> {
    /// The program's defaults: 1e-10 and 10 000 iterations.
    fn default() -> Self {
        Self::new(1e-10, 10_000)
    }
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Status {
    /// The residual is within the tolerance.
    Converged,
    /// A method for the convex law has solved that law to the tolerance, but the impulses violate
    /// Coulomb's, to which the residual refers.
    ConvexLaw,
    /// The iteration limit was reached.
    MaxIterations,
    /// The residual no longer falls.
    Stalled,
    /// The method can't continue: a singular system, no contact state that fits, too many contacts.
    Breakdown,
    /// The caller cancelled.
    Cancelled,
}

impl Status {
    /// The word for it in tables and files.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::ConvexLaw => "convex-law",
            Self::MaxIterations => "max-iterations",
            Self::Stalled => "stalled",
            Self::Breakdown => "breakdown",
            Self::Cancelled => "cancelled",
        }
    }
}

impl std::fmt::Display for Status {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}

/// The result of a solve, apart from the impulses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outcome {
    /// How it ended.
    pub status: Status,
    /// Name of the method that gave the impulses; a chain of methods names the one that succeeded.
    pub used: &'static str,
    /// Iterations taken; each solver's page says what it counts as one.
    pub iterations: u32,
    /// The residual of the returned impulses by [`judge()`](crate::judge()); `converged` refers to
    /// the global one.
    pub residual: Residual,
}

impl Outcome {
    /// An outcome; `status` is taken as given.
    #[must_use]
    pub fn new(status: Status, used: &'static str, iterations: u32, residual: Residual) -> Self {
        Self { status, used, iterations, residual }
    }

    /// Whether the impulses obey Coulomb's law to the tolerance. A method for the convex law
    /// doesn't achieve that where a contact slides, however well it solved its own program; for
    /// that, see [`Self::solved_its_own_law`].
    #[must_use]
    pub fn converged(&self) -> bool {
        self.status == Status::Converged
    }

    /// Whether the method solved the law that it is for, Coulomb's or the convex one
    /// ([`ContactSolver::law`]).
    #[must_use]
    pub fn solved_its_own_law(&self) -> bool {
        matches!(self.status, Status::Converged | Status::ConvexLaw)
    }
}

/// A solver of frictional contact problems in D dimensions.
///
/// ```
/// use teeter_contact::nalgebra::{Matrix2, Vector2};
/// use teeter_contact::{ContactProblem, ContactSolver, Delassus, Law, Outcome, Status, Stop, judge};
///
/// /// One plane contact without friction.
/// struct Single;
///
/// impl ContactSolver<2> for Single {
///     fn name(&self) -> &'static str {
///         "single"
///     }
///     fn law(&self) -> Law {
///         Law::Exact
///     }
///     fn reserve(&mut self, _contacts: usize, _blocks: usize) {}
///     fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
///         if let [p] = p {
///             *p = Vector2::new((-problem.q()[0][0] / problem.diagonal(0)[(0, 0)]).max(0.0), 0.0);
///         }
///         let residual = judge(problem, p);
///         let status = if residual.global <= stop.tolerance { Status::Converged } else { Status::Breakdown };
///         Outcome::new(status, self.name(), 1, residual)
///     }
///     fn fork(&self) -> Box<dyn ContactSolver<2>> {
///         Box::new(Single)
///     }
/// }
///
/// let (h, q) = ([Matrix2::identity()], [Vector2::new(-1.0, 2.0)]);
/// let mut p = [Vector2::zeros()];
/// let problem = ContactProblem::new(Delassus::Dense(&h), &q, &[0.0])?;
/// assert!(Single.solve(&problem, &Stop::default(), &mut p).converged());
/// let problem = ContactProblem::new(Delassus::Dense(&h), &q, &[0.5])?;
/// assert!(!Single.solve(&problem, &Stop::default(), &mut p).converged());
/// # Ok::<(), teeter_contact::ProblemError>(())
/// ```
///
/// A solver may keep memory and analyses between calls, but its result must depend on the problem
/// and the start only, so that equal runs give equal bytes.
pub trait ContactSolver<const D: usize>: Send + Sync {
    /// The name by which users choose it.
    fn name(&self) -> &'static str;
    /// The law of its results.
    fn law(&self) -> Law;
    /// Prepares for problems of up to `contacts` contacts and `blocks` non-zero blocks, so that no
    /// later solve within them allocates.
    fn reserve(&mut self, contacts: usize, blocks: usize);
    /// Starts from `p` (warm start) and leaves the impulses in it. `p` holds one impulse a contact.
    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &mut [Vector<D>]) -> Outcome;
    /// A solver of the same kind and settings for another worker.
    fn fork(&self) -> Box<dyn ContactSolver<D>>;
}
