//! A simulated motion beside a measured one: aligned in time, passed through the same sampling and
//! smoothing, compared as a whole, by half-cycles and by impacts.

mod align;
mod correlate;
mod cycles;
mod differences;
mod trace;
mod write;

pub use align::{Alignment, AlignmentSettings, align};
pub(crate) use align::{FINE, golden, mismatch_and_shift, mismatch_of, set_zero};
pub use cycles::{HalfCycle, HalfCyclePair, ImpactPair, Swing, pair_half_cycles, pair_impacts, swing};
pub use differences::{ChannelComparison, Differences};
pub(crate) use trace::Tracer;
pub use trace::{MotionTrace, TraceError};
pub use write::sentences_of;
pub use write::{FILES, half_cycle_csv, impact_csv, json, page, rows_csv, svg_figures};
pub(crate) use write::{STYLE, fixed, horizon_note, motion_figures};

use crate::measured::{Channel, LocalFit, Measured, MeasuredMotion, local_fit};

/// How a comparison is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompareSettings {
    /// How the motions are brought to the same time and side.
    pub alignment: AlignmentSettings,
    /// Rows of the window through which values are smoothed and rates found.
    pub window: usize,
    /// What the measured angle shows when the block stands upright, rad.
    pub offset: f64,
    /// Up to when the simulated motion is predictable, s.
    pub horizon: Option<f64>,
}

/// Why motions can't be compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// They don't overlap in time.
    #[error(
        "the measured motion from t = {from} s to {to} s and the run up to {end} s have fewer than {least} rows in common, \
         with the time shift {shift} s"
    )]
    Apart {
        /// Begin of the measured motion, in its own time, s.
        from: f64,
        /// Its end, s.
        to: f64,
        /// End of the run or its horizon, s.
        end: f64,
        /// The shift, s.
        shift: f64,
        /// The fewest rows that can be compared.
        least: usize,
    },
}

/// A comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// How the motions were aligned.
    pub alignment: Alignment,
    /// The measured motion, as seen from the side of the scene; its times are those of the run.
    pub measured: MeasuredMotion,
    /// The run, without sampling.
    pub trace: MotionTrace,
    /// The quantities that both have, measured ones first, each before its rate.
    pub channels: Vec<ChannelComparison>,
    /// The rows that are compared: of the run, from its t = 0 up to the horizon.
    pub rows: std::ops::Range<usize>,
    /// The rows before them in which the block was held, both measured and in the run: they count for the alignment, but into no norm of the motion.
    pub held: std::ops::Range<usize>,
    /// Half-cycles of the angle, measured with simulated.
    pub half_cycles: Vec<HalfCyclePair>,
    /// Impacts of the rocking block, measured with simulated.
    pub impacts: Vec<ImpactPair>,
    /// The settings.
    pub settings: CompareSettings,
}

/// Fewest rows that can be compared.
const FEWEST: usize = 8;

impl Comparison {
    /// Compares a measured motion with a simulated one.
    ///
    /// # Errors
    /// If they have no time in common.
    pub fn of(measured: &Measured, trace: MotionTrace, settings: CompareSettings) -> Result<Self, CompareError> {
        let end = settings.horizon.map_or(trace.end(), |horizon| horizon.min(trace.end()));
        let (alignment, mut motion) = align(measured, &trace, end, settings.offset, settings.alignment);
        motion.t.iter_mut().for_each(|t| *t += alignment.shift);
        let begin = if trace.is_held() { f64::NEG_INFINITY } else { 0.0 };
        // A row that rounding puts beyond the end belongs to the run.
        let slack = 1e-9 * trace.end();
        let first = motion.t.partition_point(|t| *t < begin - slack);
        let released = motion.t.partition_point(|t| *t < -slack);
        let last = motion.t.partition_point(|t| *t <= end + slack);
        // What moves in the rows that are compared, not how long the camera ran before.
        let rows = first.max(released)..last;
        let held = first..rows.start.max(first);
        if rows.len() < FEWEST || !(motion.t.get(last.saturating_sub(1)).copied().unwrap_or(0.0) > 0.0) {
            let at = |row: Option<&f64>| row.map_or(f64::NAN, |t| t - alignment.shift);
            return Err(CompareError::Apart {
                from: at(motion.t.first()),
                to: at(motion.t.last()),
                end,
                shift: alignment.shift,
                least: FEWEST,
            });
        }
        let channels = differences::of(&motion, &trace, [&rows, &held], settings.window);
        let fit = |channel: Channel, pick: fn(&ChannelComparison) -> &LocalFit| {
            channels.iter().find(|found| found.channel == channel).map(pick)
        };
        let (mut half_cycles, mut impacts) = (Vec::new(), Vec::new());
        if let (Some(seen), Some(run)) = (fit(Channel::Phi, |c| &c.measured), fit(Channel::Phi, |c| &c.simulated)) {
            // The first half-cycle begins while the block is held.
            let seen_rows = held.start..rows.end;
            let t = &motion.t[seen_rows.clone()];
            // What may be noise of the measurement is no crossing, in neither of the motions.
            let [a, b] = [seen, run].map(|fit| swing(t, fit, seen_rows.clone(), seen.noise));
            half_cycles = pair_half_cycles(&a, &b);
            impacts = pair_impacts(&a, &b);
        }
        Ok(Self { alignment, measured: motion, trace, channels, rows, held, half_cycles, impacts, settings })
    }

    /// The comparison of a quantity.
    #[must_use]
    pub fn channel(&self, channel: Channel) -> Option<&ChannelComparison> {
        self.channels.iter().find(|found| found.channel == channel)
    }
}

/// Values of the run at the times of a measured motion, NaN where that has none or the run is over;
/// then smoothed as the measured ones are.
pub(crate) fn sampled(trace: &MotionTrace, channel: Channel, t: &[f64], like: &[f64], window: usize) -> LocalFit {
    let value = |(t, like): (&f64, &f64)| match trace.at(*t) {
        Some(motion) if like.is_finite() => motion.of(channel),
        _ => f64::NAN,
    };
    let values: Vec<f64> = t.iter().zip(like).map(value).collect();
    if channel.rate().is_some() { local_fit(t, &values, window) } else { unsmoothed(values) }
}

/// Samples of a rate that was measured itself.
pub(crate) fn unsmoothed(value: Vec<f64>) -> LocalFit {
    let rate = vec![f64::NAN; value.len()];
    let complete = 0..value.len();
    LocalFit { value, rate, noise: 0.0, window: 1, complete }
}
