//! How far two motions are apart, quantity by quantity.

use super::{MotionTrace, sampled, unsmoothed};
use crate::measured::{Channel, LocalFit, MeasuredMotion, local_fit};
use std::ops::Range;

/// Norms of a difference over the rows compared.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Differences {
    /// Root mean square.
    pub rms: f64,
    /// The largest magnitude.
    pub max: f64,
    /// Its time, in that of the run, s.
    pub max_at: f64,
    /// Mean of simulated minus measured.
    pub mean: f64,
    /// The largest measured magnitude, to which relative numbers refer; for a position, from its
    /// mean.
    pub scale: f64,
    /// Number of rows; of a rate that was not measured itself, those with complete windows.
    pub rows: usize,
}

/// Larger shares of the largest measured value than this say only that it hardly moves.
pub(super) const MOST_SHARE: f64 = 100.0;

impl Differences {
    /// A difference as a share of the largest measured magnitude; `None` where what was measured hardly moves beside it.
    #[must_use]
    pub fn share(&self, difference: f64) -> Option<f64> {
        (difference < MOST_SHARE * self.scale).then(|| difference / self.scale)
    }
}

/// A quantity, measured and simulated, both sampled and smoothed in the same way.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelComparison {
    /// The quantity.
    pub channel: Channel,
    /// Whether it was measured itself; otherwise it is the rate of one that was.
    pub is_measured: bool,
    /// Measured values.
    pub measured: LocalFit,
    /// Simulated values at the same times.
    pub simulated: LocalFit,
    /// What was added to measured positions, whose origin is arbitrary, m.
    pub origin: f64,
    /// How far they are apart.
    pub differences: Differences,
    /// How far they are apart in the rows in which the block was held, if there are any.
    pub held: Option<Differences>,
}

/// Compares all quantities that a table holds, and their rates.
pub(super) fn of(
    motion: &MeasuredMotion,
    trace: &MotionTrace,
    [rows, held]: [&Range<usize>; 2],
    window: usize,
) -> Vec<ChannelComparison> {
    let mut found = Vec::new();
    let t = &motion.t;
    for (channel, values) in &motion.channels {
        // Rows after the horizon are shown, but don't count.
        let simulated = sampled(trace, *channel, t, values, window);
        let origin = if channel.has_own_origin() { offset_of(values, &simulated.value, rows.clone()) } else { 0.0 };
        let moved: Vec<f64> = values.iter().map(|value| value + origin).collect();
        let measured = if channel.rate().is_some() { local_fit(t, &moved, window) } else { unsmoothed(moved) };
        let [differences, held_differences] =
            [rows, held].map(|rows| differences(*channel, t, &measured.value, &simulated.value, rows.clone()));
        let some = |found: Differences| Some(found).filter(|found| found.rows > 0);
        let rate = channel.rate().filter(|rate| motion.values(*rate).is_none());
        let rates = rate.map(|rate| {
            // At an end of either motion a one-sided window makes the largest difference of noise alone: such rows have no rate.
            let [a, b] = [&measured, &simulated].map(in_complete_windows);
            let [differences, held] = [rows, held].map(|rows| {
                let rows = overlap(rows, &overlap(&measured.complete, &simulated.complete));
                self::differences(rate, t, &a.value, &b.value, rows)
            });
            let held = some(held);
            ChannelComparison {
                channel: rate,
                is_measured: false,
                measured: a,
                simulated: b,
                origin: 0.0,
                differences,
                held,
            }
        });
        found.push(ChannelComparison {
            channel: *channel,
            is_measured: true,
            measured,
            simulated,
            origin,
            differences,
            held: some(held_differences),
        });
        found.extend(rates);
    }
    found.sort_by_key(|comparison| Channel::ALL.iter().position(|channel| *channel == comparison.channel));
    found
}

/// The rates of a motion, NaN where their window reaches past an end of it.
fn in_complete_windows(fit: &LocalFit) -> LocalFit {
    let rates = fit.rate.iter().enumerate();
    unsmoothed(rates.map(|(row, rate)| if fit.complete.contains(&row) { *rate } else { f64::NAN }).collect())
}

fn overlap(a: &Range<usize>, b: &Range<usize>) -> Range<usize> {
    a.start.max(b.start)..a.end.min(b.end)
}

/// The mean of simulated minus measured values.
fn offset_of(measured: &[f64], simulated: &[f64], rows: Range<usize>) -> f64 {
    let off: Vec<f64> = rows.map(|row| simulated[row] - measured[row]).filter(|off| off.is_finite()).collect();
    off.iter().sum::<f64>() / (off.len() as f64).max(1.0)
}

fn differences(channel: Channel, t: &[f64], measured: &[f64], simulated: &[f64], rows: Range<usize>) -> Differences {
    let valid: Vec<usize> = rows.filter(|&row| (simulated[row] - measured[row]).is_finite()).collect();
    let n = (valid.len() as f64).max(1.0);
    let middle = if channel.has_own_origin() { valid.iter().map(|&row| measured[row]).sum::<f64>() / n } else { 0.0 };
    let mut found = Differences { rows: valid.len(), ..Differences::default() };
    for row in valid {
        let off = simulated[row] - measured[row];
        found.rms += off * off / n;
        found.mean += off / n;
        found.scale = found.scale.max((measured[row] - middle).abs());
        if off.abs() > found.max {
            (found.max, found.max_at) = (off.abs(), t[row]);
        }
    }
    found.rms = found.rms.sqrt();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_whose_window_reaches_past_an_end_have_no_rate() {
        let t: Vec<f64> = (0..20).map(|row| 0.1 * f64::from(row)).collect();
        let y: Vec<f64> = t.iter().map(|t| 3.0 * t).collect();
        let rates = in_complete_windows(&local_fit(&t, &y, 5)).value;
        for (row, rate) in rates.iter().enumerate() {
            assert_eq!(rate.is_finite(), (2..18).contains(&row), "{row}: {rate}");
            assert!(!rate.is_finite() || (rate - 3.0).abs() < 1e-9, "{row}: {rate}");
        }
    }
}
