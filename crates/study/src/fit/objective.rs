//! The difference between a measured motion and that of a scene with trial values.

use super::FitKey;
use crate::axes::in_seconds;
use crate::compare::{FINE, MotionTrace, Tracer, golden, mismatch_and_shift};
use crate::measured::{Channel, MeasuredMotion, Sign, local_fit};
use crate::{Failure, Setting, StudyScene};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Rows of the window by which the noise of the samples is estimated.
const NOISE_WINDOW: usize = 7;
/// Noise below this share of the largest value can't be told from rounding in the table.
const LEAST_NOISE: f64 = 1e-6;

/// What is fitted, and to what.
#[derive(Clone)]
pub(super) struct Objective<'a> {
    pub(super) source: &'a StudyScene,
    pub(super) keys: &'a [FitKey],
    /// The side from which the motion was seen.
    pub(super) sign: Sign,
    /// The block that was measured, by its number.
    pub(super) block: usize,
    pub(super) motion: MeasuredMotion,
    /// The noise of each quantity of the motion.
    pub(super) noise: Vec<f64>,
    /// A given time shift, s.
    pub(super) shift: Option<f64>,
    /// A given zero of the angle, rad.
    pub(super) offset: Option<f64>,
    /// Up to when the run is compared, s.
    pub(super) until: f64,
    /// The time step, s, if not the scene's.
    pub(super) step: Option<f64>,
    pub(super) cancel: &'a Arc<AtomicBool>,
}

/// The run with trial values, and its alignment.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    /// Values of the keys as shares of their ranges.
    pub(super) at: Vec<f64>,
    pub(super) trace: MotionTrace,
    /// Time of the run at t = 0 of the table, s.
    pub(super) shift: f64,
    /// What the measured angle shows when the block stands upright, rad.
    pub(super) offset: f64,
    /// Differences over their noise.
    pub(super) residuals: Vec<f64>,
    /// Their mean square.
    pub(super) cost: f64,
}

impl<'a> Objective<'a> {
    /// The noise of the quantities of a motion.
    pub(super) fn noise_of(motion: &MeasuredMotion) -> Vec<f64> {
        let one = |(_, values): &(Channel, Vec<f64>)| {
            let largest =
                values.iter().filter(|value| value.is_finite()).fold(0.0, |most: f64, value| most.max(value.abs()));
            // The standard deviation of a uniform distribution over a step.
            let rounding = step_of(values, LEAST_NOISE * largest) / 12.0_f64.sqrt();
            let scatter = local_fit(&motion.t, values, NOISE_WINDOW).noise;
            scatter.max(rounding).max(LEAST_NOISE * largest).max(f64::MIN_POSITIVE)
        };
        motion.channels.iter().map(one).collect()
    }

    /// The scene's setting at shares of the ranges.
    pub(super) fn setting(&self, at: &[f64]) -> Setting {
        let step = self.step.map(|step| Setting::none().set("time.step", in_seconds(step)));
        let pairs = self.keys.iter().zip(at);
        pairs.fold(step.unwrap_or_else(Setting::none), |setting, (key, share)| {
            setting.set(key.key(), key.text(key.at(*share)))
        })
    }

    /// The motion of the block with trial values.
    pub(super) fn trace(&self, setting: &Setting) -> Result<MotionTrace, Failure> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(Failure::Interrupted);
        }
        let scene = self.source.scene(setting)?;
        let refused = |error: &dyn std::fmt::Display| Failure::Refused(error.to_string());
        let mut simulation = self.source.simulation(&scene).map_err(|error| refused(&error))?;
        simulation.cancelled_by(Arc::clone(self.cancel));
        let place = simulation.layout.blocks.get(self.block).ok_or_else(|| refused(&"the block isn't in the scene"))?;
        // A quarter of the time between rows: what lies between is a cubic.
        let mut tracer = Tracer::new(place.range.clone(), 0.25 * self.motion.interval());
        let until = self.until.min(scene.time.end);
        let ended =
            simulation.run_until(until, &mut [&mut tracer]).map_err(|error| Failure::Ended(error.to_string()))?;
        Failure::unless_complete(ended, simulation.state.t)?;
        Ok(tracer.trace)
    }

    /// Runs trial values and aligns them in time, wherever that may be.
    pub(super) fn trial_anywhere(&self, at: &[f64]) -> Result<Trial, Failure> {
        let trace = self.trace(&self.setting(at))?;
        let shift = match self.shift {
            Some(shift) => shift,
            None => mismatch_and_shift(&self.motion, &trace, self.until).0,
        };
        Ok(self.aligned(at, trace, shift))
    }

    /// Runs trial values, with a time shift near `near` (s).
    pub(super) fn trial(&self, at: &[f64], near: f64) -> Result<Trial, Failure> {
        let trace = self.trace(&self.setting(at))?;
        Ok(self.aligned(at, trace, near))
    }

    fn aligned(&self, at: &[f64], trace: MotionTrace, near: f64) -> Trial {
        let shift = match self.shift {
            Some(shift) => shift,
            None => {
                let reach = 1.5 * self.motion.interval();
                golden(near - reach, near + reach, FINE, |shift| self.residuals(&trace, shift, near).2)
            }
        };
        let (residuals, offset, cost) = self.residuals(&trace, shift, near);
        Trial { at: at.to_vec(), trace, shift, offset, residuals, cost }
    }

    /// The rows that are compared with a time shift.
    pub(super) fn rows(&self, trace: &MotionTrace, shift: f64) -> std::ops::Range<usize> {
        let begin = if trace.is_held() { f64::NEG_INFINITY } else { 0.0 };
        let first = self.motion.t.partition_point(|t| t + shift < begin);
        let last = self.motion.t.partition_point(|t| t + shift <= self.until);
        first..last.max(first)
    }

    /// Differences over noise, the zero of the angle, and the mean square. The rows are those of the
    /// shift `near`, so that they are the same for all shifts about it.
    fn residuals(&self, trace: &MotionTrace, shift: f64, near: f64) -> (Vec<f64>, f64, f64) {
        let rows = self.rows(trace, near);
        let mut all = Vec::new();
        let mut zero = 0.0;
        for ((channel, values), noise) in self.motion.channels.iter().zip(&self.noise) {
            let at = |t: f64| {
                trace.at(t.min(trace.end())).or_else(|| trace.at(0.0)).map_or(f64::NAN, |motion| motion.of(*channel))
            };
            let off = rows
                .clone()
                .filter(|&row| values[row].is_finite())
                .map(|row| values[row] - at(self.motion.t[row] + shift));
            let off: Vec<f64> = off.collect();
            let mean = off.iter().sum::<f64>() / (off.len() as f64).max(1.0);
            // Unknowns that enter linearly are eliminated.
            let constant = match (channel, self.offset) {
                (Channel::Phi, Some(given)) => given,
                (Channel::Phi, None) | (Channel::X | Channel::Y, _) => mean,
                _ => 0.0,
            };
            if *channel == Channel::Phi {
                zero = constant;
            }
            all.extend(off.iter().map(|off| (off - constant) / noise));
        }
        let n = (all.len() as f64).max(1.0);
        let cost = all.iter().map(|r| r * r).sum::<f64>() / n;
        let cost = if all.len() < 8 || !cost.is_finite() { f64::INFINITY } else { cost };
        (all, zero, cost)
    }

    /// Differences over noise with everything fixed: for derivatives.
    pub(super) fn fixed(&self, trace: &MotionTrace, shift: f64, near: f64) -> Vec<f64> {
        let rows = self.rows(trace, near);
        let mut all = Vec::new();
        for ((channel, values), noise) in self.motion.channels.iter().zip(&self.noise) {
            for row in rows.clone().filter(|&row| values[row].is_finite()) {
                let t = (self.motion.t[row] + shift).min(trace.end());
                let value = trace.at(t).or_else(|| trace.at(0.0)).map_or(f64::NAN, |motion| motion.of(*channel));
                all.push((values[row] - value) / noise);
            }
        }
        all
    }

    /// Which of the residuals belong to which quantity.
    pub(super) fn channel_of_residuals(&self, trace: &MotionTrace, near: f64) -> Vec<(Channel, f64)> {
        let rows = self.rows(trace, near);
        let mut all = Vec::new();
        for ((channel, values), noise) in self.motion.channels.iter().zip(&self.noise) {
            let count = rows.clone().filter(|&row| values[row].is_finite()).count();
            all.extend(std::iter::repeat_n((*channel, *noise), count));
        }
        all
    }
}

/// The step to which values are rounded: the greatest common divisor of their differences; 0 if it is
/// below `least`, or they are all the same.
fn step_of(values: &[f64], least: f64) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    // What is left of a difference by the rounding of doubles.
    let nothing = 1e-3 * least;
    let mut step = 0.0;
    for difference in sorted.windows(2).map(|pair| pair[1] - pair[0]) {
        let mut rest = difference;
        while rest > nothing {
            let left = step % rest;
            // A little less than a multiple is one, too.
            (step, rest) = (rest, if rest - left <= nothing { 0.0 } else { left });
        }
        if step > 0.0 && step < least {
            return 0.0;
        }
    }
    step
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The noise that is found in values of an angle at 165 rows per second.
    fn noise_of(values: Vec<f64>) -> f64 {
        let t = (0..values.len()).map(|k| k as f64 / 165.0).collect();
        let channels = vec![(Channel::Phi, values)];
        let motion = MeasuredMotion { t, lines: Vec::new(), channels, markers: None, phi_from_first_row: false };
        Objective::noise_of(&motion)[0]
    }

    #[test]
    fn the_step_of_rounded_values_is_found() {
        let values = |step: f64| (0..50).map(|k| step * f64::from(6 + 4 * k * k)).collect::<Vec<f64>>();
        // Differences 4, 12, 20, ... have 4 in common.
        for step in [1e-4, 0.01_f64.to_radians(), 3.0] {
            assert!((step_of(&values(step), 1e-6 * 1e4 * step) / (4.0 * step) - 1.0).abs() < 1e-9);
        }
        let unrounded: Vec<f64> = (0..50).map(|k| f64::from(k).sin()).collect();
        assert_eq!((step_of(&unrounded, 1e-6), step_of(&[0.3; 4], 1e-6), step_of(&[], 1e-6)), (0.0, 0.0, 0.0));
    }

    #[test]
    fn rounding_is_noise_also_where_most_rows_rest() {
        // A second of motion, then rest; a step of 0.01 degrees.
        let step = 0.01_f64.to_radians();
        let phi = |t: f64| if t < 1.0 { 0.1 * (1.0 - t) * (6.0 * t).cos() } else { 0.0013 };
        for rows in [165, 300, 400, 3000] {
            let values = (0..rows).map(|k| (phi(f64::from(k) / 165.0) / step).round() * step).collect();
            let share = noise_of(values) / (step / 12.0_f64.sqrt());
            // An estimate from 160 rows is good to about a tenth; rounding is never less.
            assert!((0.999..1.2).contains(&share), "{rows} rows: {share} of the noise of rounding");
        }
        // Also where values are no multiples of a step, as angles from coordinates of markers.
        let rounded = |x: f64| (x / 1e-4).round() * 1e-4;
        let angle = |phi: f64| rounded(0.1 * phi.sin()).atan2(rounded(0.1 * phi.cos()));
        let noise = [165, 3000].map(|rows| noise_of((0..rows).map(|k| angle(phi(f64::from(k) / 165.0))).collect()));
        assert!((noise[1] / noise[0] - 1.0).abs() < 0.1, "{noise:?}");
    }
}
