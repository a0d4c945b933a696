//! The status of a finished iteration.

use teeter_contact::{Residual, Status, Stop};

/// The status of a solve after `iterations` with the given residual, if it ended only for the
/// reasons in `stop`.
pub(crate) fn ended(stop: &Stop<'_>, iterations: u32, residual: &Residual) -> Status {
    if residual.global <= stop.tolerance {
        Status::Converged
    } else if !residual.global.is_finite() {
        Status::Breakdown
    } else if stop.cancelled() {
        Status::Cancelled
    } else if iterations >= stop.max_iterations {
        Status::MaxIterations
    } else {
        Status::Stalled
    }
}

/// The status of an iteration that has to end without a solution; `None` if it may continue.
/// `since_best` is the number of iterations since the best residual.
pub(crate) fn unsolved(
    stop: &Stop<'_>,
    iterations: u32,
    since_best: u32,
    patience: u32,
    residual: f64,
) -> Option<Status> {
    if !residual.is_finite() {
        Some(Status::Breakdown)
    } else if iterations >= stop.max_iterations {
        Some(Status::MaxIterations)
    } else if since_best >= patience {
        Some(Status::Stalled)
    } else {
        stop.cancelled().then_some(Status::Cancelled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;

    #[test]
    fn each_end_has_its_status() {
        let flag = AtomicBool::new(false);
        let stop = Stop::new(1e-8, 10).with_cancel(&flag);
        let of = |iterations, global| ended(&stop, iterations, &Residual::new(global, global, 0));
        assert_eq!(of(10, 1e-9), Status::Converged);
        assert_eq!(of(3, f64::NAN), Status::Breakdown);
        assert_eq!(of(10, 1e-7), Status::MaxIterations);
        assert_eq!(of(3, 1e-7), Status::Stalled);
        flag.store(true, std::sync::atomic::Ordering::Relaxed);
        assert_eq!(of(3, 1e-7), Status::Cancelled);
    }
}
