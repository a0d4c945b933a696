//! How an iteration ended, from what is left when it has.

use teeter_contact::{Residual, Status, Stop};

/// The status of a solve that took `iterations` and whose impulses are judged with `residual`, and
/// that had no other reason to end than those that `stop` gives.
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;

    #[test]
    fn each_end_has_its_word() {
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
