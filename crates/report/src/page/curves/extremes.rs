//! What a bucket of steps keeps of a quantity.

use serde::{Deserialize, Serialize};

/// The lowest and the highest value, each with its time, the last one, and the integral over time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Extremes {
    pub(super) low: (f64, f64),
    pub(super) high: (f64, f64),
    pub(super) end: f64,
    /// By the trapezoid rule: what the mean over a window follows from, which extremes alone don't tell.
    pub(super) integral: f64,
}

impl Extremes {
    /// Those of a step: its end and the value there, the value at its start, and how long it is, s.
    #[inline]
    pub(super) fn of_step(end: (f64, f64), before: f64, lasting: f64) -> Self {
        // Some quantities aren't known before the first step.
        let before = if before.is_finite() { before } else { end.1 };
        Self { low: end, high: end, end: end.1, integral: 0.5 * lasting * (before + end.1) }
    }

    /// Takes later extremes in.
    #[inline]
    pub(super) fn take(&mut self, later: Self) {
        // A NaN loses no comparison, so a curve that stops being finite shows its gap only where nothing else is.
        if later.low.1 < self.low.1 {
            self.low = later.low;
        }
        if later.high.1 > self.high.1 {
            self.high = later.high;
        }
        self.end = later.end;
        self.integral += later.integral;
    }

    pub(super) fn in_order(self) -> [f64; 2] {
        if self.low.0 <= self.high.0 { [self.low.1, self.high.1] } else { [self.high.1, self.low.1] }
    }
}
