//! The rocking of a block about the line between its feet: on a bent beam it rocks about that, and not about the beam's undeformed axis, from which the
//! summary's peaks and crossings count.

use serde::{Deserialize, Serialize};
use teeter_integrator::RockingMonitor;

/// The rocking of a block about the line between its feet on its beam; about what carries it where that is no beam.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FeetLine {
    monitor: RockingMonitor,
    /// The line's slope at the largest angle since the last crossing, rad; none where no beam carries the block. Downhill a block swings
    /// farther with the same energy.
    now: Option<f64>,
    /// At the peaks of the monitor.
    peaks: Vec<Option<f64>>,
}

impl FeetLine {
    /// At the start, with a monitor that has only the angle of that time.
    pub(crate) fn new(monitor: RockingMonitor, slope: Option<f64>) -> Self {
        Self { monitor, now: slope, peaks: Vec::new() }
    }

    /// Takes in the angle from the line and the line's slope (rad) at the end of a step, at the time `t` (s).
    pub(crate) fn enter(&mut self, t: f64, tilt: f64, slope: Option<f64>) {
        self.monitor.enter(t, tilt);
        if slope.is_none() && self.now.is_none() {
            return;
        }
        if self.monitor.peaks().len() > self.peaks.len() {
            self.peaks.push(self.now);
        }
        if self.monitor.extreme().t == t {
            self.now = slope;
        }
    }

    /// Its crossings and peaks.
    #[must_use]
    pub fn monitor(&self) -> &RockingMonitor {
        &self.monitor
    }

    /// The line's slopes at the peaks of the monitor, then at the largest angle since, rad.
    pub(crate) fn slopes(&self) -> impl Iterator<Item = Option<f64>> {
        self.peaks.iter().copied().chain(std::iter::once(self.now))
    }
}
