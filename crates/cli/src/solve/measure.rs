//! Measures a solve: its residual, its time, with a time limit.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};
use teeter_contact::{ContactProblem, ContactSolver, Delassus, Status, Stop, Vector, judge};

/// Iterations don't limit a solve here; the time limit does.
const MAX_ITERATIONS: u32 = 1_000_000_000;

/// A shorter solve is repeated, until this much time has been spent …
const WORTH: Duration = Duration::from_millis(100);
/// … or this many times have been measured.
const SAMPLES: usize = 51;
/// A sample repeats the solve until it takes at least this long, so that the cost of reading the
/// clock is negligible.
const SAMPLE: Duration = Duration::from_micros(20);

/// The result of a solve.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    pub(super) used: &'static str,
    /// The outcome in output: `converged`, `time-limit` …
    pub(super) outcome: &'static str,
    /// The global residual of the impulses.
    pub(super) residual: f64,
    pub(super) iterations: u32,
    pub(super) time_ms: f64,
    /// The impulses, contact by contact, the normal one first.
    pub(super) impulses: Vec<f64>,
    /// A warning about the solver.
    pub(super) complaint: Option<String>,
}

/// Solves from p = 0, with a solver that has allocated its memory. A short solve is repeated from
/// the same start with the same solver, and the median taken; the first one is a warm-up.
pub(super) fn measure<const D: usize>(
    solver: &mut dyn ContactSolver<D>,
    problem: &ContactProblem<'_, D>,
    tolerance: f64,
    limit: Duration,
) -> Measured {
    let contacts = problem.contacts();
    let blocks = match problem.delassus() {
        Delassus::Blocks(h) => h.blocks().len(),
        _ => contacts * contacts,
    };
    solver.reserve(contacts, blocks);
    let mut p = vec![Vector::<D>::zeros(); contacts];
    let cancel = AtomicBool::new(false);
    let stop = Stop::new(tolerance, MAX_ITERATIONS).with_cancel(&cancel);

    let (outcome, first) = within(limit, &cancel, || {
        let begin = Instant::now();
        let outcome = solver.solve(problem, &stop, &mut p);
        (outcome, begin.elapsed())
    });
    let residual = judge(problem, &p).global;
    let impulses = p.iter().flat_map(|p| p.iter().copied()).collect();
    let mut complaint = None;
    let word = match outcome.status {
        Status::Cancelled if cancel.load(Ordering::Relaxed) => "time-limit",
        Status::Converged if !(residual <= tolerance) => {
            complaint = Some(format!("`{}` reports convergence, but the residual is {residual:.1e}", outcome.used));
            Status::Stalled.as_str()
        }
        Status::ConvexLaw => {
            let told = "has solved the convex law; the residual is for Coulomb's law, in which a sliding contact doesn't separate";
            complaint = Some(format!("`{}` {told}", outcome.used));
            Status::Stalled.as_str()
        }
        other => other.as_str(),
    };

    let mut time = first;
    if first < WORTH && !cancel.load(Ordering::Relaxed) {
        // The time limit also applies to repetitions.
        let median = within(limit + 10 * WORTH, &cancel, || {
            median_time(first, || {
                p.fill(Vector::zeros());
                let _ = solver.solve(problem, &stop, &mut p);
            })
        });
        // Solves that were cut short are not counted.
        if !cancel.load(Ordering::Relaxed) {
            time = median;
        }
    }
    Measured {
        used: outcome.used,
        outcome: word,
        residual,
        iterations: outcome.iterations,
        time_ms: time.as_secs_f64() * 1e3,
        impulses,
        complaint,
    }
}

fn median_time(first: Duration, mut solve: impl FnMut()) -> Duration {
    let begin = Instant::now();
    let mut sample = |times: u32| {
        let clock = Instant::now();
        (0..times).for_each(|_| solve());
        clock.elapsed().div_f64(f64::from(times))
    };
    // The first solve of a solver may be slower than the others, so the number of solves per sample
    // is determined from a second one.
    let second = sample(1).min(first).max(Duration::from_nanos(20));
    let times = u32::try_from(SAMPLE.as_nanos() / second.as_nanos() + 1).unwrap_or(1);
    let mut samples = Vec::with_capacity(SAMPLES);
    while samples.len() < SAMPLES && (samples.len() < 3 || begin.elapsed() < WORTH) {
        samples.push(sample(times));
    }
    samples.sort_unstable();
    samples[samples.len() / 2]
}

/// Does the work; sets `cancel` after `limit`, unless the work is done before.
fn within<T>(limit: Duration, cancel: &AtomicBool, work: impl FnOnce() -> T) -> T {
    let (done, bell) = (Mutex::new(false), Condvar::new());
    std::thread::scope(|scope| {
        scope.spawn(|| {
            // The lock can't be poisoned, as no thread panics while holding it.
            let guard = done.lock().unwrap_or_else(PoisonError::into_inner);
            let waited = bell.wait_timeout_while(guard, limit, |done| !*done);
            if !*waited.unwrap_or_else(PoisonError::into_inner).0 {
                cancel.store(true, Ordering::Relaxed);
            }
        });
        let result = work();
        *done.lock().unwrap_or_else(PoisonError::into_inner) = true;
        bell.notify_all();
        result
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_contact::{Law, Outcome, Residual};

    /// A solver that runs until it is cancelled.
    struct Endless;

    impl ContactSolver<2> for Endless {
        fn name(&self) -> &'static str {
            "endless"
        }
        fn law(&self) -> Law {
            Law::Exact
        }
        fn reserve(&mut self, _: usize, _: usize) {}
        fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector<2>]) -> Outcome {
            let mut iterations = 0;
            while !stop.cancelled() {
                std::thread::yield_now();
                iterations += 1;
            }
            Outcome::new(Status::Cancelled, "endless", iterations, judge(problem, p))
        }
        fn fork(&self) -> Box<dyn ContactSolver<2>> {
            Box::new(Self)
        }
    }

    /// A solver that always reports convergence.
    struct FalselyConverged;

    impl ContactSolver<2> for FalselyConverged {
        fn name(&self) -> &'static str {
            "boaster"
        }
        fn law(&self) -> Law {
            Law::Exact
        }
        fn reserve(&mut self, _: usize, _: usize) {}
        fn solve(&mut self, _: &ContactProblem<'_, 2>, _: &Stop<'_>, _: &mut [Vector<2>]) -> Outcome {
            Outcome::new(Status::Converged, "boaster", 1, Residual::new(0.0, 0.0, 0))
        }
        fn fork(&self) -> Box<dyn ContactSolver<2>> {
            Box::new(Self)
        }
    }

    fn pressed(mut solver: impl ContactSolver<2>, limit: Duration) -> Measured {
        let (h, q) = ([nalgebra_identity()], [Vector::<2>::new(-1.0, 0.0)]);
        let problem = ContactProblem::new(Delassus::Dense(&h), &q, &[0.5]).unwrap();
        measure(&mut solver, &problem, 1e-10, limit)
    }

    fn nalgebra_identity() -> teeter_contact::Block<2> {
        teeter_contact::Block::<2>::identity()
    }

    #[test]
    fn the_time_limit_ends_a_solve_that_would_go_on() {
        let measured = pressed(Endless, Duration::from_millis(30));
        assert_eq!(measured.outcome, "time-limit");
        assert!(measured.time_ms >= 29.0 && measured.iterations > 0, "{measured:?}");
    }

    #[test]
    fn a_solver_that_boasts_is_not_believed() {
        let measured = pressed(FalselyConverged, Duration::from_secs(10));
        assert_eq!((measured.outcome, measured.residual), ("stalled", 1.0));
        assert!(measured.complaint.is_some_and(|text| text.contains("boaster")));
    }
}
