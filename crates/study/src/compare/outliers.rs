//! Rows of a measured motion that are off on their own, as where a tracker took something else for
//! the block in one frame.
//!
//! A few of them outweigh all other rows in a sum of squares, so that the time shift found by it
//! would be wrong.

use crate::measured::{MeasuredMotion, parabola};

/// So many rows before and after a row foretell its value, by the parabola through them.
const SIDE: usize = 3;
/// A value is off if it misses what both sides foretell by more than so many standard deviations.
const DEVIATIONS: f64 = 6.0;
/// The standard deviation of a normal distribution over its median absolute deviation.
const OF_MEDIAN: f64 = 1.4826;
/// And by more than this share of the spread of the motion: what is less moves no alignment.
const LEAST: f64 = 0.1;
/// And by more than this share of the largest value, which is rounding.
const ROUNDING: f64 = 1e-12;
/// The spread is that of the middle of the values, without this share at both ends.
const ENDS: f64 = 0.05;

/// The rows in which a quantity seems to be off, each with the place of the quantity in the motion.
pub(super) fn suspects(motion: &MeasuredMotion) -> Vec<(usize, usize)> {
    let each = motion.channels.iter().enumerate();
    each.flat_map(|(channel, (_, values))| suspects_of(&motion.t, values).into_iter().map(move |row| (row, channel)))
        .collect()
}

/// The motion without these values.
pub(super) fn without(motion: &MeasuredMotion, rows: &[(usize, usize)]) -> MeasuredMotion {
    let mut motion = motion.clone();
    for &(row, channel) in rows {
        motion.channels[channel].1[row] = f64::NAN;
    }
    motion
}

/// Whether values that were suspected are off from those of a run, too: in a motion that is fast for
/// the rows, a row may be far from its neighbours and right. `apart` are all differences from the
/// run, NaN where there is none.
pub(super) fn confirmed(apart: &[f64], rows: &[usize]) -> Vec<usize> {
    let middle = median(apart.iter().copied());
    let off = |row: usize| (apart[row] - middle).abs();
    let limit = DEVIATIONS * OF_MEDIAN * median((0..apart.len()).map(off));
    // What the run has no value for is off by the table alone.
    rows.iter().copied().filter(|&row| !(off(row) <= limit)).collect()
}

/// A value is suspect if it isn't where the rows before it lead, nor where those after it come from:
/// at an impact one of both still holds.
fn suspects_of(t: &[f64], y: &[f64]) -> Vec<usize> {
    let present: Vec<usize> = (0..t.len()).filter(|&row| y[row].is_finite()).collect();
    let misses: Vec<f64> = (0..present.len()).map(|place| miss(t, y, &present, place)).collect();
    let mut sorted: Vec<f64> = present.iter().map(|&row| y[row]).collect();
    sorted.sort_by(f64::total_cmp);
    let end = (ENDS * sorted.len() as f64) as usize;
    let spread = match (sorted.get(end), sorted.len().checked_sub(1 + end).and_then(|last| sorted.get(last))) {
        (Some(low), Some(high)) => high - low,
        _ => return Vec::new(),
    };
    let largest = present.iter().map(|&row| y[row].abs()).fold(0.0, f64::max);
    let limit = (DEVIATIONS * OF_MEDIAN * median(misses.iter().copied())).max(LEAST * spread).max(ROUNDING * largest);
    let is_off = |place: &usize| misses[*place] > limit;
    let suspected: Vec<usize> = (0..present.len()).filter(is_off).map(|place| present[place]).collect();
    if suspected.is_empty() {
        return suspected;
    }
    // A good row between two wrong ones is off by these alone.
    let good: Vec<usize> = present.iter().copied().filter(|row| suspected.binary_search(row).is_err()).collect();
    let still_off = |row: &usize| {
        let place = good.partition_point(|other| other < row);
        let (before, after) = (place.saturating_sub(SIDE)..place, place..(place + SIDE).min(good.len()));
        let rows = [&good[before.clone()], &[*row], &good[after]].concat();
        miss(t, y, &rows, before.len()) > limit
    };
    suspected.into_iter().filter(still_off).collect()
}

/// How far the value of a row is from the parabola through the rows before it or, if that is nearer,
/// from that through the rows after it; 0 where there are too few of both.
fn miss(t: &[f64], y: &[f64], rows: &[usize], place: usize) -> f64 {
    let row = rows[place];
    let by = |side: &[usize]| {
        let [led, ..] = parabola(side.iter().map(|&other| (t[other] - t[row], y[other])))?;
        Some((y[row] - led).abs())
    };
    let before = place.checked_sub(SIDE).and_then(|first| by(&rows[first..place]));
    let after = rows.get(place + 1..place + 1 + SIDE).and_then(by);
    match (before, after) {
        (Some(before), Some(after)) => before.min(after),
        (one, other) => one.or(other).unwrap_or(0.0),
    }
}

/// The median of the numbers among values; 0 without any.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(of: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let t: Vec<f64> = (0..200).map(|k| f64::from(k) / 165.0).collect();
        let noise = |k: usize| 1e-4 * ((k * 7919 % 13) as f64 - 6.0);
        let y = t.iter().enumerate().map(|(k, t)| of(*t) + noise(k)).collect();
        (t, y)
    }

    #[test]
    fn single_rows_and_pairs_are_found_and_those_between_them_are_not() {
        let (t, mut y) = table(|t| 0.1 * (-t).exp() * (9.0 * t).cos());
        assert_eq!(suspects_of(&t, &y), [0; 0]);
        for row in [0, 60, 62, 90, 91, 130] {
            y[row] += 0.3;
        }
        assert_eq!(suspects_of(&t, &y), [0, 60, 62, 90, 91, 130]);
        // An empty cell is no value.
        y[61] = f64::NAN;
        assert_eq!(suspects_of(&t, &y), [0, 60, 62, 90, 91, 130]);
    }

    #[test]
    fn the_rounding_of_a_value_that_stands_still_is_no_outlier() {
        // Times that sums have rounded make parabolas miss a constant by its last digits.
        let t: Vec<f64> = (0..200).scan(0.0, |t, _| Some(std::mem::replace(t, *t + 1.0 / 165.0))).collect();
        assert_eq!(suspects_of(&t, &[0.3; 200]), [0; 0]);
    }

    #[test]
    fn impacts_are_no_outliers() {
        // A ball that bounces: at each impact its velocity jumps.
        let bounce = |t: f64| {
            let (mut begin, mut v) = (0.0, 1.5);
            while t > begin + 2.0 * v / 9.81 && v > 1e-3 {
                begin += 2.0 * v / 9.81;
                v *= 0.7;
            }
            let s = t - begin;
            (s * (v - 0.5 * 9.81 * s)).max(0.0)
        };
        let (t, y) = table(bounce);
        assert_eq!(suspects_of(&t, &y), [0; 0]);
    }

    #[test]
    fn what_the_run_has_too_is_no_outlier() {
        let mut apart: Vec<f64> = (0..50).map(|k| 1e-3 * f64::from(k * 7 % 11)).collect();
        (apart[7], apart[9], apart[11]) = (0.5, 0.011, f64::NAN);
        assert_eq!(confirmed(&apart, &[7, 9, 11]), [7, 11]);
    }
}
