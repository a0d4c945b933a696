//! The contact problems of a run, saved as FCLIB files for solvers to be compared on.
//!
//! Two parts share a shelf: a solver around the run's own one puts each problem on it, with start and result, and an
//! observer, who knows the step, takes it off and writes it if it is wanted. The integrator knows nothing of it.

use crate::ResultsError;
use crate::lock::FolderLock;
use crate::results::check_folder;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Stop, Vector};
use teeter_fclib::{FclibError, Info, LocalProblem, Solution};
use teeter_integrator::{Model, Observer, ObserverError, State, StepReport};

/// Which problems are saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportWhen {
    /// Those that took more than [`HARD`] times the median number of iterations of the problems before, those that another
    /// method than usual solved (usual: the most frequent one so far for that number of contacts), and those not solved.
    Hard,
    /// Those of each Nth step.
    Every(u64),
}

/// A problem is hard from so many times the median number of iterations on.
pub const HARD: u64 = 10;

/// A problem as posed, its start and what came of it.
struct Posed {
    h: BlockSparse<2>,
    q: Vec<Vector<2>>,
    mu: Vec<f64>,
    start: Solution<2>,
    result: Solution<2>,
    outcome: Outcome,
}

type Shelf = Arc<Mutex<Vec<Posed>>>;

fn locked(shelf: &Shelf) -> MutexGuard<'_, Vec<Posed>> {
    // Nobody panics with it in hand.
    shelf.lock().unwrap_or_else(PoisonError::into_inner)
}

/// An eye on the contact problems of a run.
#[derive(Default)]
pub struct Watch {
    shelf: Shelf,
}

impl std::fmt::Debug for Watch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Watch").finish_non_exhaustive()
    }
}

impl Watch {
    /// The run's solver with the eye on it, for the simulation to take.
    #[must_use]
    pub fn around(&self, solver: Box<dyn ContactSolver<2>>) -> Box<dyn ContactSolver<2>> {
        Box::new(Watched { solver, shelf: Arc::clone(&self.shelf) })
    }
}

/// The run's solver, watched.
struct Watched {
    solver: Box<dyn ContactSolver<2>>,
    shelf: Shelf,
}

impl ContactSolver<2> for Watched {
    fn name(&self) -> &'static str {
        self.solver.name()
    }

    fn law(&self) -> Law {
        self.solver.law()
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.solver.reserve(contacts, blocks);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector<2>]) -> Outcome {
        let start = with_velocities(problem, p);
        let outcome = self.solver.solve(problem, stop, p);
        let mut h = BlockSparse::default();
        h.gather(problem);
        let (q, mu) = (problem.q().to_vec(), problem.mu().to_vec());
        let result = with_velocities(problem, p);
        locked(&self.shelf).push(Posed { h, q, mu, start, result, outcome });
        outcome
    }

    /// What another worker solves is no part of this run.
    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        self.solver.fork()
    }
}

fn with_velocities(problem: &ContactProblem<'_, 2>, p: &[Vector<2>]) -> Solution<2> {
    let u = (0..p.len()).map(|i| problem.velocity(i, p)).collect();
    Solution { u, r: p.to_vec(), ..Solution::default() }
}

/// Writes the wanted problems of a run to a folder.
pub struct Exporter {
    shelf: Shelf,
    folder: PathBuf,
    stem: String,
    title: String,
    /// Digits of the last step's number, so that names sort by step.
    digits: usize,
    when: ExportWhen,
    tolerance: f64,
    kept: Kept,
    /// Nobody else writes problems there while this is.
    _lock: FolderLock,
}

/// The lock of a folder for problems: another one than that for results, which may go to the same folder.
const LOCK: &str = ".teeter-problems.lock";

/// What an exporter knows of the run so far.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Kept {
    seen: Seen,
    written: u64,
}

/// What becomes of problems that a folder holds already, of a run of the same name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Former {
    /// They are in the way.
    Refuse,
    /// They go.
    Remove,
    /// They stay: the run goes on from a checkpoint.
    Keep,
}

impl std::fmt::Debug for Exporter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Exporter").field("folder", &self.folder).field("when", &self.when).finish_non_exhaustive()
    }
}

impl Exporter {
    /// Takes a folder for the problems that `watch` sees in a run of `steps` steps; their files are named after `stem` and the
    /// step. `former` says what becomes of problems of that stem in the folder.
    ///
    /// # Errors
    /// If there are problems that are refused, or the folder can't be made or written.
    pub fn create(
        watch: &Watch,
        folder: &Path,
        stem: &str,
        title: &str,
        steps: u64,
        when: ExportWhen,
        tolerance: f64,
        former: Former,
    ) -> Result<Self, ResultsError> {
        let io = |source| ResultsError::Io { path: folder.to_owned(), source };
        check_folder(folder)?;
        std::fs::create_dir_all(folder).map_err(io)?;
        let lock = FolderLock::take(folder, LOCK)?;
        let begin = format!("{stem}-step");
        let mut old = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(io)? {
            let entry = entry.map_err(io)?;
            let name = entry.file_name().to_string_lossy().into_owned();
            let number = name.strip_prefix(&begin).and_then(|rest| rest.strip_suffix(".hdf5"));
            // `beam-stepped-step01.hdf5` is another scene's.
            if number.is_some_and(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit() || b == b'-')) {
                old.push(entry.path());
            }
        }
        if former == Former::Keep {
            old.clear();
        }
        if !old.is_empty() && former == Former::Refuse {
            return Err(ResultsError::Exists(folder.to_owned()));
        }
        for path in old {
            std::fs::remove_file(&path).map_err(|source| ResultsError::Io { path, source })?;
        }
        Ok(Self {
            shelf: Arc::clone(&watch.shelf),
            folder: folder.to_owned(),
            stem: stem.to_owned(),
            title: title.to_owned(),
            digits: steps.to_string().len(),
            when,
            tolerance,
            kept: Kept::default(),
            _lock: lock,
        })
    }

    pub(crate) fn keep(&self) -> &Kept {
        &self.kept
    }

    pub(crate) fn restore(&mut self, kept: Kept) {
        self.kept = kept;
    }

    /// Problems written so far.
    #[must_use]
    pub fn written(&self) -> u64 {
        self.kept.written
    }

    fn write(&mut self, posed: Posed, nth: usize, step: &StepReport<'_, 2>) -> Result<(), ResultsError> {
        let again = if nth == 0 { String::new() } else { format!("-{}", nth + 1) };
        let name = format!("{}-step{:02$}{again}.hdf5", self.stem, step.step, self.digits);
        let path = self.folder.join(name);
        let outcome = posed.outcome;
        let info = Info {
            title: Some(format!("{}, step {}, t = {} s", self.title, step.step, step.t_end)),
            description: Some(format!(
                "written by teeter {}; the guess is the run's start; its solver: {}, {} after {} iterations to {:e}, residual {:e}",
                env!("CARGO_PKG_VERSION"),
                outcome.used,
                outcome.status,
                outcome.iterations,
                self.tolerance,
                outcome.residual.global
            )),
            math_info: Some(
                "u = W r + q, K* contains u + (mu ||u_T||, 0), perpendicular to r in K; SI units".to_owned(),
            ),
        };
        let problem = LocalProblem {
            h: posed.h,
            q: posed.q,
            mu: posed.mu,
            info,
            guesses: vec![posed.start],
            solution: outcome.converged().then_some(posed.result),
        };
        problem.write(&path).map_err(|error| {
            let source = match error {
                FclibError::Io(source) => source,
                other => std::io::Error::other(other.to_string()),
            };
            ResultsError::Io { path, source }
        })?;
        self.kept.written += 1;
        Ok(())
    }
}

impl Observer<2> for Exporter {
    fn observe(&mut self, _: &Model<2>, step: &StepReport<'_, 2>, _: &State) -> Result<ControlFlow<()>, ObserverError> {
        let posed = std::mem::take(&mut *locked(&self.shelf));
        for (nth, posed) in posed.into_iter().enumerate() {
            let hard = self.kept.seen.is_hard(&posed.outcome, posed.mu.len());
            self.kept.seen.enter(&posed.outcome, posed.mu.len());
            let wanted = match self.when {
                ExportWhen::Hard => hard,
                ExportWhen::Every(n) => step.step.is_multiple_of(n.max(1)),
            };
            if wanted {
                self.write(posed, nth, step)?;
            }
        }
        Ok(ControlFlow::Continue(()))
    }
}

/// What the run's problems took so far.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Seen {
    /// How many took how many iterations.
    iterations: BTreeMap<u32, u64>,
    count: u64,
    /// How often which method solved problems of which number of contacts.
    used: BTreeMap<usize, BTreeMap<Cow<'static, str>, u64>>,
}

impl Seen {
    /// The lower median of the iterations; none at first.
    fn median(&self) -> Option<u32> {
        let mut left = self.count.div_ceil(2);
        self.iterations.iter().find_map(|(&iterations, &count)| {
            let here = count >= left;
            left = left.saturating_sub(count);
            here.then_some(iterations)
        })
    }

    fn usual(&self, contacts: usize) -> Option<&str> {
        let used = self.used.get(&contacts)?;
        used.iter().max_by_key(|(_, count)| **count).map(|(used, _)| used.as_ref())
    }

    fn is_hard(&self, outcome: &Outcome, contacts: usize) -> bool {
        let slow = self.median().is_some_and(|median| u64::from(outcome.iterations) > HARD * u64::from(median.max(1)));
        let fallback = self.usual(contacts).is_some_and(|usual| usual != outcome.used);
        slow || fallback || !outcome.converged()
    }

    fn enter(&mut self, outcome: &Outcome, contacts: usize) {
        *self.iterations.entry(outcome.iterations).or_default() += 1;
        self.count += 1;
        *self.used.entry(contacts).or_default().entry(outcome.used.into()).or_default() += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::{Residual, Status};

    #[test]
    fn hard_is_ten_times_the_median_a_fallback_or_a_failure() {
        let outcome = |status, used, iterations| Outcome::new(status, used, iterations, Residual::new(0.0, 0.0, 0));
        let solved = |used, iterations| outcome(Status::Converged, used, iterations);
        let mut seen = Seen::default();
        assert_eq!(seen.median(), None);
        assert!(!seen.is_hard(&solved("a", 1_000_000), 2), "the first has nothing to be compared with");
        assert!(seen.is_hard(&outcome(Status::Stalled, "a", 1), 2));
        for iterations in [3, 5, 100, 4] {
            seen.enter(&solved("a", iterations), 2);
        }
        assert_eq!(seen.median(), Some(4));
        assert!(!seen.is_hard(&solved("a", 40), 2) && seen.is_hard(&solved("a", 41), 2));
        assert!(seen.is_hard(&solved("b", 1), 2) && !seen.is_hard(&solved("b", 1), 3), "another size, another usual");
    }
}
