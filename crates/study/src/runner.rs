//! Runs jobs on all cores.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// More threads than any machine has a use for here; a request for more may be refused by the system.
const MOST_THREADS: usize = 512;

/// Number of hardware threads.
#[must_use]
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Does `work` for every job, on up to `threads` threads, and returns the results in the order of
/// the jobs, whatever the order in which they end. Jobs are started in order. Once `cancel` is set
/// no more are started: their result is `None`. `done` is called after each job, from the threads,
/// one at a time.
///
/// ```
/// use std::sync::atomic::AtomicBool;
/// let squares = teeter_study::runner::in_order(&[3, 1, 2], 2, &AtomicBool::new(false), |n| n * n, |_| {});
/// assert_eq!(squares, [Some(9), Some(1), Some(4)]);
/// ```
pub fn in_order<J: Sync, R: Send>(
    jobs: &[J],
    threads: usize,
    cancel: &AtomicBool,
    work: impl Fn(&J) -> R + Sync,
    done: impl FnMut(usize) + Send,
) -> Vec<Option<R>> {
    let mut results: Vec<Option<R>> = jobs.iter().map(|_| None).collect();
    let mut done = done;
    as_they_end(
        jobs.iter().enumerate(),
        threads.min(jobs.len()),
        cancel,
        |(_, job)| work(job),
        |(number, _), result| {
            results[number] = Some(result);
            done(number);
            ControlFlow::Continue(())
        },
    );
    results
}

/// Does `work` for every job, on up to `threads` threads, and hands on each result as it comes, one
/// at a time. Jobs are started in order; none once `cancel` is set or `done` breaks off.
pub fn as_they_end<J: Send, R: Send>(
    jobs: impl Iterator<Item = J> + Send,
    threads: usize,
    cancel: &AtomicBool,
    work: impl Fn(&J) -> R + Sync,
    done: impl FnMut(J, R) -> ControlFlow<()> + Send,
) {
    let (jobs, done, broken) = (Mutex::new(jobs), Mutex::new(done), AtomicBool::new(false));
    let next = || {
        let ended = cancel.load(Ordering::Relaxed) || broken.load(Ordering::Relaxed);
        if ended { None } else { jobs.lock().unwrap_or_else(PoisonError::into_inner).next() }
    };
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, MOST_THREADS) {
            scope.spawn(|| {
                while let Some(job) = next() {
                    let result = work(&job);
                    if (done.lock().unwrap_or_else(PoisonError::into_inner))(job, result).is_break() {
                        broken.store(true, Ordering::Relaxed);
                    }
                }
            });
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_jobs_whatever_ends_first() {
        let jobs: Vec<u64> = (0..50).collect();
        for threads in [1, 2, 7] {
            let mut ended = 0;
            let results = in_order(
                &jobs,
                threads,
                &AtomicBool::new(false),
                |&n| (0..(50 - n) * 1000).fold(n, |sum, k| sum ^ k) ^ (0..(50 - n) * 1000).fold(0, |sum, k| sum ^ k),
                |_| ended += 1,
            );
            assert_eq!(results, jobs.iter().map(|&n| Some(n)).collect::<Vec<_>>());
            assert_eq!(ended, 50);
        }
    }

    #[test]
    fn once_cancelled_no_job_is_begun() {
        let cancel = AtomicBool::new(false);
        let results = in_order(
            &[1, 2, 3, 4],
            1,
            &cancel,
            |&n| {
                cancel.fetch_or(n == 2, Ordering::Relaxed);
                n
            },
            |_| {},
        );
        assert_eq!(results, [Some(1), Some(2), None, None]);
        assert!(in_order(&[0_u8; 0], 4, &cancel, |_| (), |_| {}).is_empty());
    }
}
