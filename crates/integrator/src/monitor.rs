//! Rocking: zero crossings of an angle and the peaks between them (`docs/theory.md` §9,
//! `docs/impacts.md`). The caller gives the angle: that of a block relative to what carries it.

/// A zero crossing of an angle: on a rigid base, the impact of a rocking block.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Crossing {
    /// Time, s, linear between steps.
    pub t: f64,
}

/// The largest |φ| of a step between two crossings.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Peak {
    /// Time of the step, s.
    pub t: f64,
    /// The angle, rad, signed.
    pub phi: f64,
}

/// A smaller excursion is rounding, not rocking; rad.
const STILL: f64 = 1e-12;

/// An angle that is no more than this part of its largest has turned.
const TURNED: f64 = 0.99;

/// Most crossings that a monitor lists, and as many peaks: some 2 MB, however long the run is.
pub const LISTED_CROSSINGS: usize = 100_000;

/// Finds the crossings and peaks of one angle, step by step. It lists the first
/// [`LISTED_CROSSINGS`] and counts all.
///
/// ```
/// use teeter_integrator::RockingMonitor;
///
/// let mut monitor = RockingMonitor::new(0.0, 0.1);
/// for (t, phi) in [(1.0, 0.2), (2.0, -0.2), (3.0, -0.3), (4.0, 0.1)] {
///     monitor.enter(t, phi);
/// }
/// let times: Vec<f64> = monitor.crossings().iter().map(|c| c.t).collect();
/// assert_eq!(times, [1.5, 3.75]);
/// let peaks: Vec<f64> = monitor.peaks().iter().map(|p| p.phi).collect();
/// assert_eq!(peaks, [0.2, -0.3]); // the unfinished one at the end is none
/// assert_eq!(monitor.turned(), None);
/// monitor.enter(5.0, 0.05);
/// assert_eq!(monitor.turned().map(|peak| peak.phi), Some(0.1));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RockingMonitor {
    /// Excursions up to this are ignored, rad.
    least: f64,
    last: (f64, f64),
    /// Time of the last change of sign, until the excursion after it shows that it was more than
    /// rounding.
    pending: Option<f64>,
    extreme: Peak,
    crossings: Vec<Crossing>,
    peaks: Vec<Peak>,
    /// All crossings, listed or not.
    count: u64,
}

impl RockingMonitor {
    /// Starts at time `t` with angle `phi`.
    #[must_use]
    pub fn new(t: f64, phi: f64) -> Self {
        let extreme = Peak { t, phi };
        Self {
            least: STILL,
            last: (t, phi),
            pending: None,
            extreme,
            crossings: Vec::new(),
            peaks: Vec::new(),
            count: 0,
        }
    }

    /// Ignores excursions up to `least` (rad); without this, up to 1e-12, which is rounding.
    #[must_use]
    pub fn with_least(mut self, least: f64) -> Self {
        self.least = least.max(STILL);
        self
    }

    /// Enters the end of a step.
    pub fn enter(&mut self, t: f64, phi: f64) {
        let (t0, phi0) = self.last;
        self.last = (t, phi);
        // The sign of the current excursion; 0 until the angle has left zero for the first time.
        let side = if self.extreme.phi.abs() > self.least { self.extreme.phi.signum() } else { 0.0 };
        if side == 0.0 {
            if phi.abs() > self.extreme.phi.abs() {
                self.extreme = Peak { t, phi };
            }
            return;
        }
        if phi * side > 0.0 {
            self.pending = None;
            if phi.abs() > self.extreme.phi.abs() {
                self.extreme = Peak { t, phi };
            }
            return;
        }
        if phi0 * side > 0.0 {
            self.pending = Some(t0 + (t - t0) * (phi0 / (phi0 - phi)));
        }
        if phi.abs() > self.least
            && let Some(t_zero) = self.pending.take()
        {
            self.count += 1;
            if self.crossings.len() < LISTED_CROSSINGS {
                self.crossings.push(Crossing { t: t_zero });
                self.peaks.push(self.extreme);
            }
            self.extreme = Peak { t, phi };
        }
    }

    /// How many crossings there were so far.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The largest |φ| since the last crossing.
    #[must_use]
    pub fn extreme(&self) -> Peak {
        self.extreme
    }

    /// The largest |φ| since the last crossing, if the angle has turned there: it is back by a hundredth of it, which ringing beside
    /// a peak isn't.
    #[must_use]
    pub fn turned(&self) -> Option<Peak> {
        let (_, phi) = self.last;
        let peak = self.extreme;
        (peak.phi.abs() > self.least && phi.abs() <= TURNED * peak.phi.abs()).then_some(peak)
    }

    /// The crossings so far, the first [`LISTED_CROSSINGS`] of them.
    #[must_use]
    pub fn crossings(&self) -> &[Crossing] {
        &self.crossings
    }

    /// The peaks so far, the first being the release; there is one before each crossing listed.
    #[must_use]
    pub fn peaks(&self) -> &[Peak] {
        &self.peaks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossings(phi: &[f64]) -> Vec<f64> {
        let mut monitor = RockingMonitor::new(0.0, phi[0]);
        for (k, &phi) in phi.iter().enumerate().skip(1) {
            monitor.enter(k as f64, phi);
        }
        monitor.crossings().iter().map(|c| c.t).collect()
    }

    #[test]
    fn rounding_about_zero_is_no_rocking() {
        assert!(crossings(&[0.0, 1e-17, -1e-17, 2e-16, -3e-16]).is_empty());
        assert!(crossings(&[0.1, 1e-17, -1e-17, 2e-16, 0.1]).is_empty());
    }

    #[test]
    fn a_crossing_that_pauses_at_zero_counts_once_where_it_began() {
        assert_eq!(crossings(&[0.1, 0.0, -1e-17, -0.1]), [1.0]);
    }

    #[test]
    fn a_body_that_never_stops_is_counted_on_in_bounded_memory() {
        let mut monitor = RockingMonitor::new(0.0, 0.1);
        let steps = LISTED_CROSSINGS + 50;
        for k in 1..=steps {
            monitor.enter(k as f64, if k % 2 == 0 { 0.1 } else { -0.1 });
        }
        assert_eq!(monitor.count(), steps as u64);
        assert_eq!((monitor.crossings().len(), monitor.peaks().len()), (LISTED_CROSSINGS, LISTED_CROSSINGS));
        assert_eq!(monitor.crossings().last(), Some(&Crossing { t: LISTED_CROSSINGS as f64 - 0.5 }));
    }

    #[test]
    fn a_body_that_starts_upright_crosses_first_when_it_comes_back() {
        assert_eq!(crossings(&[0.0, 0.1, 0.2, -0.2]), [2.5]);
    }
}
