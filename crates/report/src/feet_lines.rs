//! The rocking of a block about the line between its feet: on a bent beam it rocks about that, and not about the beam's undeformed axis, from which the
//! summary's peaks and crossings count.

use serde::{Deserialize, Serialize};
use teeter_integrator::{Peak, RockingMonitor};

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

    /// The peak that no crossing has followed yet. A beam that vibrates turns the line to and fro: the block has turned where it has against what carries
    /// it (`about`), too.
    pub(crate) fn turned(&self, about: &RockingMonitor) -> Option<Peak> {
        let with = |turned: &Peak| about.turned().is_some_and(|of| of.phi * turned.phi > 0.0);
        self.monitor.turned().filter(|turned| self.now.is_none() || with(turned))
    }

    /// The last peak, if it counts from a line on a beam.
    pub(crate) fn last_peak(&self, about: &RockingMonitor) -> Option<Peak> {
        match self.turned(about) {
            Some(turned) => self.now.map(|_| turned),
            None => self.monitor.peaks().last().copied().zip(*self.peaks.last()?).map(|(peak, _)| peak),
        }
    }

    /// Whether a beam carries the block.
    pub(crate) fn is_on_beam(&self) -> bool {
        self.now.is_some()
    }

    /// The last peak that is told of a block on a beam which has stood since then, s: of one that has not turned since its last crossing, or not by enough,
    /// the largest angle after that.
    pub(crate) fn told_peak(&self, about: &RockingMonitor, since: f64) -> Option<Peak> {
        let largest = || Some(self.monitor.extreme()).filter(|peak| peak.phi != 0.0);
        self.last_peak(about).filter(|peak| peak.t >= since).or_else(largest).filter(|peak| peak.t >= since)
    }

    /// The line's slopes at the peaks of the monitor, then at the largest angle since, rad.
    pub(crate) fn slopes(&self) -> impl Iterator<Item = Option<f64>> {
        self.peaks.iter().copied().chain(std::iter::once(self.now))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Its last swing is told from the line, or none, never one from before it settled, or from the beam's axis.
    #[test]
    fn of_a_block_on_a_beam_the_largest_angle_since_it_settled_stands_for_a_peak() {
        let start = || RockingMonitor::new(0.0, 0.0);
        let (mut line, about) = (FeetLine::new(start(), Some(0.0)), start());
        for (t, tilt) in [(0.1, 0.02), (0.2, -0.01), (0.3, 0.004), (0.4, 0.006)] {
            line.enter(t, tilt, Some(0.001));
        }
        let told = |since: f64| line.told_peak(&about, since).map(|peak| (peak.t, peak.phi));
        assert_eq!(told(0.0), Some((0.2, -0.01)));
        assert_eq!(told(0.25), Some((0.4, 0.006)), "not the peak before it settled");
        assert_eq!(told(0.45), None);
        assert!(line.is_on_beam() && !FeetLine::new(start(), None).is_on_beam());
    }
}
