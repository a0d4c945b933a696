//! Contact solvers that one simulation after another takes: making one, with the memory of all its methods, takes as long as a few
//! steps.

use nalgebra::Vector2;
use std::sync::{Arc, Mutex, PoisonError};
use teeter_contact::{ContactProblem, ContactSolver, Law, Outcome, Stop};
use teeter_solvers::Enumeration;

/// Solvers that nobody uses, by the names under which they were asked for.
type Idle = Arc<Mutex<Vec<(String, Box<dyn ContactSolver<2>>)>>>;

/// Most idle solvers.
const MOST_IDLE: usize = 64;

/// The idle solvers. What a solver keeps between calls changes no result: see [`ContactSolver`].
#[derive(Default)]
pub(crate) struct SolverPool(Idle);

impl std::fmt::Debug for SolverPool {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SolverPool").finish_non_exhaustive()
    }
}

impl SolverPool {
    /// A solver with this name, which comes back when it is dropped; `None` if there is none with it.
    pub(crate) fn take(&self, name: &str) -> Option<Box<dyn ContactSolver<2>>> {
        let found = {
            let mut idle = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let at = idle.iter().position(|(known, _)| known == name);
            at.map(|at| idle.swap_remove(at))
        };
        let (name, solver) = match found {
            Some(found) => found,
            None => (name.to_owned(), teeter_solvers::plane_solver(name)?),
        };
        Some(Box::new(Lent { name, solver, idle: Arc::clone(&self.0) }))
    }
}

/// A solver of a pool, with its name there.
struct Lent {
    name: String,
    solver: Box<dyn ContactSolver<2>>,
    idle: Idle,
}

impl ContactSolver<2> for Lent {
    fn name(&self) -> &'static str {
        self.solver.name()
    }

    fn law(&self) -> Law {
        self.solver.law()
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.solver.reserve(contacts, blocks);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector2<f64>]) -> Outcome {
        self.solver.solve(problem, stop, p)
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        self.solver.fork()
    }
}

impl Drop for Lent {
    fn drop(&mut self) {
        // What a solver that panicked has left could be anything.
        if std::thread::panicking() {
            return;
        }
        let mut idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        if idle.len() < MOST_IDLE {
            // One without memory stands in for it.
            let solver = std::mem::replace(&mut self.solver, Box::new(Enumeration));
            idle.push((std::mem::take(&mut self.name), solver));
        }
    }
}
