//! How the line between a block's feet on its beam slopes at the peaks of its rocking, which count from that line: downhill a block swings farther with
//! the same energy.

use serde::{Deserialize, Serialize};
use teeter_integrator::RockingMonitor;

/// The slopes of a block's line, rad; none where no beam carries it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FeetLine {
    /// At the largest angle since the last crossing.
    now: Option<f64>,
    /// At the peaks of the block's monitor.
    peaks: Vec<Option<f64>>,
}

impl FeetLine {
    /// At the start, where the monitor has only the angle of that time.
    pub(crate) fn new(slope: Option<f64>) -> Self {
        Self { now: slope, peaks: Vec::new() }
    }

    /// Takes in the slope at the end of a step, at the time `t` (s), once the monitor has that step.
    pub(crate) fn enter(&mut self, monitor: &RockingMonitor, t: f64, slope: Option<f64>) {
        if slope.is_none() && self.now.is_none() {
            return;
        }
        if monitor.peaks().len() > self.peaks.len() {
            self.peaks.push(self.now);
        }
        if monitor.extreme().t == t {
            self.now = slope;
        }
    }

    /// At the peaks of the monitor, then at the largest angle since.
    pub(crate) fn slopes(&self) -> impl Iterator<Item = Option<f64>> {
        self.peaks.iter().copied().chain(std::iter::once(self.now))
    }
}
