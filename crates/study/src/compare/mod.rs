//! A simulated motion beside a measured one: aligned in time, passed through the same sampling and
//! smoothing, compared as a whole, by half-cycles and by impacts.

mod align;
mod constant;
mod correlate;
mod cycles;
mod differences;
mod outliers;
mod trace;
mod write;

pub use align::{Aligned, Alignment, AlignmentSettings, Alternative, align};
pub(crate) use align::{FINE, ShiftFit, SideFit, alternatives_to, golden, mismatch_and_shift, mismatch_of, set_zero};
pub use constant::Constant;
pub use cycles::{HalfCycle, HalfCyclePair, ImpactPair, Swing, pair_half_cycles, pair_impacts, swing};
pub use differences::{ChannelComparison, Differences};
pub(crate) use trace::Tracer;
pub use trace::{MotionTrace, TraceError};
pub use write::sentences_of;
pub use write::{FILES, half_cycle_csv, impact_csv, json, page, rows_csv, svg_figures};
pub(crate) use write::{STYLE, fixed, horizon_note, motion_figures, origin_of_side, other_alignments, outliers};

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
        "the measured motion from t = {} s to {} s and the run up to {} s have fewer than {least} rows in common, \
         with the time shift {} s{hint}",
        fixed(*from, 4), fixed(*to, 4), fixed(*end, 4), fixed(*shift, 5)
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
        /// What may be wrong; empty if nothing is known.
        hint: &'static str,
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
    /// The rows in which a quantity is off on its own, as where a tracker lost the block: they don't count for the alignment.
    pub outliers: Vec<usize>,
    /// Other shifts and sides that fit as well as the alignment.
    pub alternatives: Vec<Alternative>,
    /// Whether the measured angle was taken to be in rad for want of a unit.
    pub phi_without_unit: bool,
    /// The rows that are compared where they have values: of the run, from its t = 0 up to the horizon.
    pub rows: std::ops::Range<usize>,
    /// The rows before them in which the block was held, both measured and in the run: they count for the alignment, but into no norm of the motion.
    pub held: std::ops::Range<usize>,
    /// Half-cycles of the angle, measured with simulated.
    pub half_cycles: Vec<HalfCyclePair>,
    /// Impacts of the rocking block, measured with simulated.
    pub impacts: Vec<ImpactPair>,
    /// A constant between the angles, if that is much of their difference.
    pub constant: Option<Constant>,
    /// The settings.
    pub settings: CompareSettings,
}

/// Fewest rows that can be compared.
const FEWEST: usize = 8;

/// Times without a unit that reach over so many times the run are none in seconds.
const LONG: f64 = 20.0;

/// What may be wrong with times that the run, up to `end` (s), doesn't have.
fn hint_of_times(measured: &Measured, end: f64) -> &'static str {
    let t = measured.motion(crate::measured::Sign::AsIs).t;
    let length = t.last().zip(t.first()).map_or(0.0, |(last, first)| last - first);
    match measured.is_without_unit("t") && length > LONG * end {
        true => "; if the times are in milliseconds, say so: --unit t=ms, or the heading `t [ms]`",
        false => "",
    }
}

impl Comparison {
    /// Compares a measured motion with a simulated one.
    ///
    /// # Errors
    /// If they have no time in common.
    pub fn of(measured: &Measured, trace: MotionTrace, settings: CompareSettings) -> Result<Self, CompareError> {
        let mut comparison = Self::without_constant(measured, trace, settings)?;
        let again = |settings| Self::without_constant(measured, comparison.trace.clone(), settings).ok();
        comparison.constant = constant::constant_of(&comparison, again);
        Ok(comparison)
    }

    /// As [`Self::of`], without looking for a constant.
    fn without_constant(
        measured: &Measured,
        trace: MotionTrace,
        settings: CompareSettings,
    ) -> Result<Self, CompareError> {
        let end = settings.horizon.map_or(trace.end(), |horizon| horizon.min(trace.end()));
        let aligned = align(measured, &trace, end, settings.offset, settings.alignment);
        let Aligned { alignment, mut motion, outliers, alternatives } = aligned;
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
        let has_value = |row: &usize| motion.channels.iter().any(|(_, values)| values[*row].is_finite());
        if rows.clone().filter(has_value).count() < FEWEST
            || !(motion.t.get(last.saturating_sub(1)).copied().unwrap_or(0.0) > 0.0)
        {
            let at = |row: Option<&f64>| row.map_or(f64::NAN, |t| t - alignment.shift);
            return Err(CompareError::Apart {
                from: at(motion.t.first()),
                to: at(motion.t.last()),
                end,
                shift: alignment.shift,
                least: FEWEST,
                hint: hint_of_times(measured, trace.end()),
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
        let phi_without_unit = measured.is_without_unit(Channel::Phi.word());
        Ok(Self {
            alignment,
            measured: motion,
            trace,
            channels,
            outliers,
            alternatives,
            phi_without_unit,
            rows,
            held,
            half_cycles,
            impacts,
            constant: None,
            settings,
        })
    }

    /// Whether a row of the measured table has a value that is compared.
    #[must_use]
    pub fn is_compared(&self, row: usize) -> bool {
        self.rows.contains(&row) && self.has_value(row)
    }

    /// Number of rows with a value that is compared. A quantity may be lost in some of them: its
    /// [`Differences`] say in how many it is there.
    #[must_use]
    pub fn compared(&self) -> usize {
        self.rows.clone().filter(|&row| self.has_value(row)).count()
    }

    /// Whether any quantity is there in a row, in both motions.
    fn has_value(&self, row: usize) -> bool {
        self.channels.iter().any(|found| (found.measured.value[row] - found.simulated.value[row]).is_finite())
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
