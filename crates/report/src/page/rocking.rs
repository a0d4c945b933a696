//! The numbers of rocking: what each passage through the upright position leaves of a block's swing.

use super::PageRecorder;
use super::recorder::ImpactMark;
use crate::Summary;
use crate::summary::PeakRow;
use crate::verdict::{Fate, ROCKED};

/// A passage of a block through φ = 0, between two peaks of its swing. φ is its angle against what carries it: on a beam against the line between
/// its feet there.
#[derive(Debug, Clone, PartialEq)]
pub struct HalfCycle {
    /// The block.
    pub body: String,
    /// When φ is 0, s.
    pub t: f64,
    /// ω, relative to what carries the block, right before and right after the impact of the corner that comes
    /// down, rad/s; none where no impact is near the passage, where others of the block follow within three steps, as in a column whose joints
    /// close one after the other, or where there were too many impacts to keep them all.
    ///
    /// The two are those at the ends of the step of that impact, wherever the crossing is: a step of gravity is all that
    /// is between them but for the impact. A beam that gives way spreads the block's loss over the half cycle, so the
    /// ratio of the two is then near 1, and the peaks tell what is lost.
    pub omega: Option<[f64; 2]>,
    /// Housner's ratio for this block on rigid ground, 1 − (3/2) sin²α; none for a block so wide that it would be negative: it doesn't rock on, but
    /// stays on its base. None either for a block that touches others, or another beam than the one it stands on, or stands on a beam without supports,
    /// and where none of its corners landed.
    pub housner: Option<f64>,
    /// The peak before, rad.
    pub peak_before: Option<f64>,
    /// The peak after, rad; none where the run ends before it is complete, or the block overturns.
    pub peak_after: Option<f64>,
    /// The block's critical angle, rad.
    pub alpha: f64,
    /// Of a block on a beam: how high it is lifted at the peak after, in parts of how high it was at the peak before; on rigid ground that would be the
    /// square of Housner's ratio. On a beam that slopes, a block swings farther downhill with the same energy, so that the quotient of the
    /// peaks themselves tells little.
    pub lift: Option<f64>,
    /// Whether the peaks count from the line between its feet on a beam.
    pub on_beam: bool,
}

impl HalfCycle {
    /// ω after the impact in parts of ω before.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        self.omega.filter(|omega| omega[0] != 0.0).map(|omega| omega[1] / omega[0])
    }

    /// The peak after in parts of the peak before; none after a peak so small that the ratio says nothing.
    #[must_use]
    pub fn decay(&self) -> Option<f64> {
        let before = self.peak_before.filter(|peak| peak.abs() >= TELLING * self.alpha)?;
        Some((self.peak_after? / before).abs())
    }
}

/// A peak below this part of the critical angle is no rocking: a passage between two such is left out.
const LEAST: f64 = 1e-3;

/// A peak below this part of the critical angle is no measure for the next one.
const TELLING: f64 = 1e-2;

/// How high the mass centre of a block with this critical angle (rad) is over where it would be if the block stood flat on a base of this slope
/// (rad), from which it is turned by `phi` (rad); in parts of its distance from a corner.
fn lift(phi: f64, slope: f64, alpha: f64) -> f64 {
    let top = alpha - phi.signum() * slope;
    (top - phi.abs()).cos() - top.cos()
}

/// An impact belongs to a passage if it is no further from it than this part of the swing from the peak to the passage.
const NEAR: f64 = 0.25;

/// Where another contact of the block strikes within so many steps after the corner that comes down, the impact goes on.
const CASCADE: f64 = 3.0;

/// Corners that a block stands on while it rocks, to the left (φ > 0) and to the right.
const LEFT: usize = 0;
const RIGHT: usize = 1;

/// Whether a passage without an impact near it, as one over a soft contact, is one of a rocking block: both peaks are known, and
/// within the critical angle. A stone that tumbles passes φ = 0, too.
fn is_swing(before: Option<f64>, after: Option<f64>, alpha: f64) -> bool {
    let within = |peak: f64| (LEAST * alpha..alpha).contains(&peak.abs());
    before.is_some_and(within) && after.is_some_and(within)
}

/// The half cycles of a run, block by block.
#[must_use]
pub fn half_cycles(recorder: &PageRecorder, summary: &Summary) -> Vec<HalfCycle> {
    half_cycles_and_left_out(recorder, summary).0
}

/// Passages of a block that are left out of the half cycles.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LeftOutCycles {
    pub(crate) body: String,
    /// How many crossings of it the summary has.
    pub(crate) count: usize,
    pub(crate) why: WhyLeftOut,
}

/// Why passages of a block are left out of the half cycles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum WhyLeftOut {
    /// A corner landed near so few of them, fewer than half.
    FewLandings(usize),
    /// They are against a beam's undeformed axis: against the line between its feet it hardly swung.
    HardlySwings,
    /// It had not settled yet: a block that bounces turns to and fro, too.
    NotSettled,
}

/// The half cycles of a run, and of which blocks they are left out.
pub(crate) fn half_cycles_and_left_out(
    recorder: &PageRecorder,
    summary: &Summary,
) -> (Vec<HalfCycle>, Vec<LeftOutCycles>) {
    let (mut cycles, mut left_out) = (Vec::new(), Vec::new());
    for (number, block) in recorder.scenery.blocks.iter().enumerate() {
        // A polygon has no base to rock on that would say which of its corners land.
        let Some(alpha) = block.alpha else { continue };
        let verdict = summary.verdict.iter().find(|verdict| verdict.body == block.name);
        // What flies, tumbles or has fallen turns past φ = 0, too, and back, but doesn't rock.
        let stands = verdict.map_or((0.0, f64::INFINITY), |verdict| {
            (verdict.stands_from.unwrap_or(f64::INFINITY), verdict.overturned_at.unwrap_or(f64::INFINITY))
        });
        let stands = |t: f64| (stands.0..=stands.1).contains(&t);
        let stands_alone = recorder.scenery.stands_alone(number);
        let (own, mut hits, mut passed) = (cycles.len(), 0, false);
        let mut peaks = summary.passages.peaks.iter().filter(|peak| peak.body == block.name).peekable();
        for crossing in summary.passages.crossings.iter().filter(|crossing| crossing.body == block.name) {
            let before = peaks.next();
            let size = |peak: Option<&&PeakRow>| peak.map_or(0.0, |peak| peak.phi.abs());
            if !stands(crossing.t) {
                continue;
            }
            passed = true;
            if size(before.as_ref()).max(size(peaks.peek())) < LEAST * alpha {
                continue;
            }
            let nearest = before.and_then(|peak| {
                let landing = if peak.phi > 0.0 { RIGHT } else { LEFT };
                let distance = |t: f64| (t - crossing.t).abs();
                let impacts = recorder.kept.impacts.iter().filter(|i| i.block == number && i.point == landing);
                let nearest = impacts.min_by(|a, b| distance(a.t).total_cmp(&distance(b.t)))?;
                (distance(nearest.t) <= NEAR * (crossing.t - peak.t)).then_some(nearest)
            });
            // Within a cascade of impacts the velocity at the end of a step is none that is left of the swing.
            let goes_on = |impact: &ImpactMark| {
                let pair = |other: &ImpactMark| &recorder.scenery.contacts[other.contact];
                let own = |other: &&ImpactMark| pair(other).block == number || pair(other).other == Some(number);
                let elsewhere = recorder.kept.impacts.iter().filter(own).filter(|of| of.contact != impact.contact);
                elsewhere.map(|other| other.t - impact.t).any(|after| (0.0..=CASCADE * summary.dt).contains(&after))
            };
            // It bounced back, and passed the upright without an impact of its own.
            let hit = nearest.filter(|impact| impact.omega[0] * impact.omega[1] >= 0.0);
            let omega = hit.filter(|impact| !goes_on(impact)).map(|impact| impact.omega);
            // The last one may have turned without a crossing after it.
            let unfinished = || {
                let rocks = verdict.filter(|of| of.what == Fate::Rocks && of.t.is_some_and(|t| t > crossing.t))?;
                rocks.last_peak
            };
            let peak_after = match peaks.peek() {
                Some(peak) => Some(peak.phi).filter(|_| stands(peak.t)),
                // Against another line.
                None if before.is_some_and(|peak| peak.line.is_some()) => None,
                None => unfinished(),
            };
            if hit.is_none() && !is_swing(before.map(|peak| peak.phi), peak_after, alpha) {
                continue;
            }
            hits += usize::from(hit.is_some());
            // A row of dashes.
            if omega.is_none() && peak_after.is_none() {
                continue;
            }
            let lifted = |peak: &PeakRow| Some(lift(peak.phi, peak.line?, alpha));
            let lifts = before.filter(|peak| peak.phi.abs() >= TELLING * alpha).zip(peaks.peek());
            let lift = lifts.filter(|_| peak_after.is_some()).and_then(|(before, after)| {
                let before = lifted(before).filter(|height| *height > 0.0)?;
                Some(lifted(after)? / before)
            });
            let ends = [before.as_ref(), peaks.peek()];
            cycles.push(HalfCycle {
                lift,
                on_beam: ends.into_iter().flatten().any(|peak| peak.line.is_some()),
                body: block.name.clone(),
                t: crossing.t,
                omega,
                housner: Some(1.0 - 1.5 * alpha.sin().powi(2))
                    .filter(|ratio| *ratio > 0.0 && omega.is_some() && stands_alone),
                alpha,
                peak_before: before.map(|peak| peak.phi),
                peak_after,
            });
        }
        // On rigid contacts one corner stands as the other comes down, unless it bounces or tumbles, which is no rocking.
        let all_kept = recorder.kept.impact_count as usize <= recorder.kept.impacts.len();
        let few = 2 * hits < cycles.len() - own && all_kept && recorder.scenery.touches_rigidly(number);
        let swings = || {
            let mut peaks = summary.passages.peaks.iter().filter(|peak| peak.body == block.name);
            peaks.any(|peak| peak.phi.abs() >= ROCKED * alpha)
        };
        let why = match () {
            () if few => Some(WhyLeftOut::FewLandings(hits)),
            () if passed || !recorder.scenery.is_on_beam(number) => None,
            () if swings() => Some(WhyLeftOut::NotSettled),
            () => Some(WhyLeftOut::HardlySwings),
        };
        // All of them, as the terminal and the summary count them.
        let count = summary.crossings.iter().filter(|crossing| crossing.body == block.name).count();
        if let Some(why) = why.filter(|_| count > 0) {
            cycles.truncate(own);
            left_out.push(LeftOutCycles { body: block.name.clone(), count, why });
        }
    }
    (cycles, left_out)
}
