//! A constant between the measured and the simulated angle, as of a camera that stood tilted.

use super::{ChannelComparison, CompareSettings, Comparison, FEWEST, mismatch_of};
use crate::measured::Channel;

/// A constant by which the angles are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Constant {
    /// Simulated minus measured angle, rad.
    pub angle: f64,
    /// By what they are apart in the held rows instead, rad, if that is another constant.
    pub held: Option<f64>,
    /// What the measured angle shows when the block stands upright, if that is the reason, rad.
    pub offset: f64,
    /// The root mean square difference of the angles with this offset, rad.
    pub rms: f64,
}

/// Motions with a larger share of the mean square difference that unrelated ones have hardly match.
pub(super) const UNLIKE: f64 = 0.1;
/// The least part of the mean square difference of the angle that is told when a constant explains it.
const CONSTANT_FROM: f64 = 0.25;
/// Constants of the held and the free motion that differ by up to this share are one.
const SAME_CONSTANT: f64 = 0.25;
/// How often an offset is found again, as the time shift changes with it.
const ROUNDS: usize = 4;

/// The constant by which the angles are apart, if that is much of their difference; `again` is the comparison with other settings.
///
/// A constant pulls the time shift that is found along, so the mean difference isn't quite the offset
/// without which the motions would be alike: each offset that comes into question is tried.
pub(super) fn constant_of(
    comparison: &Comparison,
    again: impl Fn(CompareSettings) -> Option<Comparison>,
) -> Option<Constant> {
    let found = comparison.channel(Channel::Phi).filter(|found| found.is_measured)?;
    let d = found.differences;
    let uncertain = |rows: usize| 5.0 * found.measured.noise / (rows as f64).sqrt();
    let constant = d.mean.powi(2) >= CONSTANT_FROM * d.rms.powi(2) && d.mean.abs() > uncertain(d.rows);
    // Of motions that hardly match a constant says nothing, and one that is within their rounding isn't seen.
    let matches =
        mismatch(comparison) <= UNLIKE && mismatch_in(comparison, found).is_none_or(|angles| angles <= UNLIKE);
    if !constant || d.mean.abs() < 1e-3 * d.scale || !matches {
        return None;
    }
    let (settings, sign) = (comparison.settings, comparison.alignment.sign.factor());
    let held = found.held.filter(|held| held.rows >= FEWEST);
    // While the block is held, nothing else sets them apart.
    let starts = std::iter::once(d.mean).chain(held.map(|held| held.mean));
    let mut best: Option<(f64, f64)> = None;
    for start in starts {
        let mut offset = settings.offset - sign * start;
        for _ in 0..ROUNDS {
            let Some(tried) = again(CompareSettings { offset, ..settings }) else { break };
            let Some(phi) = tried.channel(Channel::Phi).map(|phi| phi.differences) else { break };
            // What has turned the motion around was no constant.
            if tried.alignment.sign != comparison.alignment.sign {
                break;
            }
            if best.is_none_or(|(rms, _)| phi.rms < rms) {
                best = Some((phi.rms, offset));
            }
            offset -= sign * phi.mean;
        }
    }
    let (rms, offset) = best.filter(|(rms, _)| *rms < d.rms)?;
    let angle = sign * (settings.offset - offset);
    let another = held
        .filter(|held| (held.mean - angle).abs() > (SAME_CONSTANT * angle.abs()).max(uncertain(held.rows.min(d.rows))));
    Some(Constant { angle, held: another.map(|held| held.mean), offset, rms })
}

/// The mean square difference as a share of that of unrelated motions: of the rows by which the motions were aligned or, if that is more,
/// of those that are compared, from the release to the horizon. A block that is held for long before its release matches there whatever it
/// does later. Outliers, which are told by themselves, and the rows into which they are smoothed are left out.
pub(super) fn mismatch(comparison: &Comparison) -> f64 {
    let aligned = comparison.alignment.mismatch;
    let compared = comparison.channel(comparison.alignment.by).and_then(|found| mismatch_in(comparison, found));
    compared.map_or(aligned, |compared| aligned.max(compared))
}

/// That of a quantity over the rows compared.
fn mismatch_in(comparison: &Comparison, found: &ChannelComparison) -> Option<f64> {
    let Comparison { outliers, settings, rows, .. } = comparison;
    let reach = settings.window / 2;
    let is_clear = |row: &usize| {
        let next = outliers.partition_point(|outlier| outlier + reach < *row);
        outliers.get(next).is_none_or(|outlier| *outlier > row + reach)
    };
    let pairs: Vec<(f64, f64)> = rows
        .clone()
        .filter(is_clear)
        .map(|row| (found.measured.value[row], found.simulated.value[row]))
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .collect();
    mismatch_of(&pairs, found.channel.has_own_origin())
}
