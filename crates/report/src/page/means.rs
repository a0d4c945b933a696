//! A force without its fast vibrations, beside its raw values: a beam that rings makes these a band in which the force that carries is not
//! seen.
//!
//! It is a weighted mean about each time, with the weights of a windowed sinc: what vibrates slower than the period told stays as large as it
//! is, what vibrates faster goes. A mean of equal weights flattens a vibration of twice its window to 64 %, and lets some that are faster through.
//!
//! No mean reaches across an impact, or another jolt: the force would change before what changes it.

mod weights;

use super::curves::{Curves, ForceCurve};
use super::jolts::Jolts;
use crate::with_digits;
use weights::Weights;

/// The longest period is this part of the run, rounded to 1, 2 or 5 times a power of ten.
const PART: f64 = 1.0 / 40.0;

/// Where smoothing twice takes this part of what smoothing once has left, a vibration lies between those kept and those taken, and is made smaller.
const BETWEEN: f64 = 0.05;

/// Where raw values stray from the mean by less than this part of the largest mean, the mean would only cover them.
const STRAY: f64 = 0.02;

/// It has to do so for more than this part of the time in which the contact presses.
const LEAST: f64 = 0.25;

/// The longest period that is taken for the border between fast and slow in a run of these curves, s.
fn longest(curves: &Curves) -> f64 {
    let borders = curves.borders();
    let run = borders.last().copied().unwrap_or(0.0) - borders.first().copied().unwrap_or(0.0);
    if run > 0.0 { rounded_down(run * PART) } else { 0.0 }
}

/// 1, 2 or 5 times a power of ten.
fn rounded_down(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    let digit = [5.0, 2.0, 1.0].into_iter().find(|digit| digit * power <= x * (1.0 + 1e-9)).unwrap_or(1.0);
    digit * power
}

/// What takes the fast vibrations of some quantities away.
#[derive(Debug)]
pub(super) struct Filter {
    /// The border between the fast vibrations and the slow ones, s.
    period: f64,
    /// The borders of buckets before which a mean ends, and after which another begins: before the buckets with jolts.
    cuts: Vec<usize>,
    /// Whether jolts follow each other within a period, so that means reach across all but the first of them.
    reaches_across: bool,
    /// What the jolts are.
    what: &'static str,
}

impl Filter {
    /// A filter for quantities with these means over the buckets, in a run with these jolts: what vibrates slower than the
    /// longest period stays, or than the next shorter one where vibrations lie about the longest, of which they would lose a part.
    pub(super) fn of(curves: &Curves, jolts: &Jolts, quantities: &[Vec<f64>]) -> Self {
        let (longest, borders) = (longest(curves), curves.borders());
        let filter = Self::with(longest, &borders, jolts);
        if !(longest > 0.0) || !is_long(&borders) {
            return filter;
        }
        let shorter = Self::with(rounded_down(0.6 * longest), &borders, jolts);
        let of_longest = filter.between(&borders, quantities);
        let is_between = of_longest > BETWEEN && 2.0 * shorter.between(&borders, quantities) < of_longest;
        if is_between { shorter } else { filter }
    }

    fn with(period: f64, borders: &[f64], jolts: &Jolts) -> Self {
        let mut filter = Self { period, cuts: Vec::new(), reaches_across: false, what: jolts.what };
        for t in &jolts.times {
            let bucket = borders.partition_point(|border| border < t).saturating_sub(1);
            match filter.cuts.last().copied() {
                Some(before) if before == bucket => {}
                Some(before) if borders[bucket] - borders[before] < period => filter.reaches_across = true,
                _ => filter.cuts.push(bucket),
            }
        }
        filter
    }

    /// The variance that smoothing once more takes from all of these quantities together, as a part of theirs.
    fn between(&self, borders: &[f64], quantities: &[Vec<f64>]) -> f64 {
        let weights = Weights::new();
        let stretches = self.stretches([0, borders.len() - 1]);
        let (mut taken, mut all) = (0.0, 0.0);
        for values in quantities {
            let once = weights.over(borders, values, self.period, &stretches);
            let inner: Vec<f64> = once.windows(2).map(|ends| 0.5 * (ends[0] + ends[1])).collect();
            let twice = weights.over(borders, &inner, self.period, &stretches);
            let mean = once.iter().sum::<f64>() / once.len() as f64;
            taken += once.iter().zip(&twice).map(|(once, twice)| (once - twice).powi(2)).sum::<f64>();
            all += once.iter().map(|once| (once - mean).powi(2)).sum::<f64>();
        }
        if all > 0.0 { (taken / all).sqrt() } else { 0.0 }
    }

    /// A stretch, given by the borders at its ends, in parts between which jolts lie.
    fn stretches(&self, [first, last]: [usize; 2]) -> Vec<[usize; 2]> {
        let inner = self.cuts.iter().copied().filter(|cut| (first + 1..last).contains(cut));
        let ends: Vec<usize> = std::iter::once(first).chain(inner).chain([last]).collect();
        ends.windows(2).map(|ends| [ends[0], ends[1]]).collect()
    }

    /// The period as it is told, with how far means reach where there are jolts.
    pub(super) fn told(&self) -> String {
        let period = with_digits(self.period, "s", 3);
        match (self.cuts.is_empty(), self.reaches_across) {
            (true, _) => period,
            (_, false) => format!("{period}, not across {}", self.what),
            _ => format!("{period}, not across {} further apart than that", self.what),
        }
    }

    /// The normal force at the borders of the buckets without fast vibrations, N: from what lies between jolts and in the
    /// stretch in which the contact touches; with whether what is drawn strays from it. `None` of what only strikes now and then, of which
    /// a mean would make blocks as wide as the period.
    pub(super) fn normal(&self, curves: &Curves, forces: &ForceCurve) -> Option<(Vec<f64>, bool)> {
        let borders = curves.borders();
        if forces.normal.is_empty() || !is_long(&borders) || self.period <= 0.0 {
            return None;
        }
        // Before it touches and after it has left there is no force, of which a mean beyond would make a ramp.
        let touches = touches(&borders, &forces.normal, self.period);
        let stretches: Vec<[usize; 2]> = touches.into_iter().flat_map(|touch| self.stretches(touch)).collect();
        let mut means = Weights::new().over(&borders, &forces.normal, self.period, &stretches);
        // Beside a jump the weights overshoot, but no contact pulls.
        means.iter_mut().for_each(|mean| *mean = mean.max(0.0));
        let largest = means.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let pressing = || (0..forces.normal.len()).filter(|bucket| forces.normal[*bucket] > 0.0);
        // Where buckets are so long that each holds vibrations, these are in what is drawn of it, not in its mean.
        let drawn = |bucket: usize| match &forces.course {
            Some([normal, _]) => &normal[2 * bucket + 1..2 * bucket + 3],
            None => std::slice::from_ref(&forces.normal[bucket]),
        };
        let strays = |bucket: &usize| drawn(*bucket).iter().any(|y| (y - means[*bucket]).abs() > STRAY * largest);
        let does_stray = pressing().filter(strays).count() as f64 > LEAST * pressing().count() as f64;
        (pressing().count() * 10 > means.len()).then_some((means, does_stray))
    }

    /// A quantity at the borders of the buckets without fast vibrations. `None` unless it rings: strays from what is
    /// left, and crosses it at least once in a period, on average. A slower vibration is seen as it is.
    pub(super) fn ringing(&self, curves: &Curves, column: usize) -> Option<Vec<f64>> {
        self.crossing(curves, column, 1.0)
    }

    /// The same where it has to cross what is left so many times in a period.
    fn crossing(&self, curves: &Curves, column: usize, times: f64) -> Option<Vec<f64>> {
        let borders = curves.borders();
        if !is_long(&borders) || self.period <= 0.0 {
            return None;
        }
        let stretches = self.stretches([0, borders.len() - 1]);
        let means = Weights::new().over(&borders, &curves.means(column), self.period, &stretches);
        let largest = means.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let own = curves.means(column);
        // Two points of the curve lie in each bucket, after the one at the start.
        let values = curves.curve(column);
        let points = values[1..].chunks_exact(2).map(|pair| [pair[0], pair[1]]);
        let (mut far, mut crossings, mut above) = (0, 0, None);
        for (k, (pair, ends)) in points.zip(means.windows(2)).enumerate() {
            let mean = 0.5 * (ends[0] + ends[1]);
            far += usize::from(pair.iter().any(|x| (x - mean).abs() > STRAY * largest));
            let now = own[k] > mean;
            crossings += usize::from(above.is_some_and(|before: bool| before != now));
            above = Some(now);
            // A bucket of many steps: what moves through it has about the change of its means as range, what rings in it more.
            let change = |other: Option<&f64>| other.map_or(0.0_f64, |other| (other - own[k]).abs());
            let drift = change(own.get(k + 1)).max(change(k.checked_sub(1).and_then(|before| own.get(before))));
            crossings += 2 * usize::from((pair[1] - pair[0]).abs() > RINGS * drift.max(STRAY * largest));
        }
        let periods = (borders[borders.len() - 1] - borders[0]) / self.period;
        (far as f64 > LEAST * own.len() as f64 && crossings as f64 >= times * periods).then_some(means)
    }

    /// Through the largest values of a quantity that rings in every period, but not across jolts, in straight lines from one to the next, at the borders
    /// of the buckets: what stays of one without a sign, as a stress, of which a mean would say nothing. It rises from a jolt to the largest
    /// value after it, as what is held there would look like a load that jumps. In a period in which it goes up and down no more than a slow vibration
    /// does, it is the curve itself. `None` unless what it is the size of rings: as `rings` says, or, where
    /// that isn't known, if it crosses its mean twice in a period, as the size of what swings about zero does so twice as often as that.
    pub(super) fn through_the_largest(&self, curves: &Curves, column: usize, rings: Option<bool>) -> Option<Largest> {
        if !is_long(&curves.borders()) || !rings.unwrap_or_else(|| self.crossing(curves, column, 2.0).is_some()) {
            return None;
        }
        let borders = curves.borders();
        let values = curves.curve(column);
        let most = values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let highest: Vec<f64> = values[1..].chunks_exact(2).map(|pair| pair[0].max(pair[1])).collect();
        let (mut largest, mut itself) = (vec![0.0; borders.len()], vec![false; borders.len()]);
        for [begin, end] in self.stretches([0, borders.len() - 1]) {
            let begins = begin + usize::from(begin > 0);
            // What rang before a jolt rings on.
            let mut nodes: Vec<(f64, f64)> =
                (begin > 0).then(|| (borders[begins], highest[begin].max(largest[begin]))).into_iter().collect();
            let mut first = begin;
            while first < end {
                let after = borders.partition_point(|border| *border < borders[first] + self.period);
                // A short rest, which may hold no peak, belongs to the period before it.
                let is_rest = borders[end] - borders[after.min(end)] < 0.5 * self.period;
                let after = if is_rest { end } else { after.clamp(first + 1, end) };
                if turns(&values[2 * first..=2 * after], STRAY * most) <= SLOW_TURNS {
                    // What doesn't ring after a jolt is the curve from its first point on.
                    let is_after_jolt = first == begin && begin > 0;
                    if is_after_jolt {
                        nodes.clear();
                    }
                    nodes.extend((first..after).map(|k| (borders[k + 1], values[2 * k + 2])));
                    itself[first + usize::from(is_after_jolt)..=after].fill(true);
                    first = after;
                    continue;
                }
                let (at, most) = (first..after)
                    .map(|k| (k, highest[k]))
                    .fold((first, f64::NEG_INFINITY), |a, b| if b.1 > a.1 { b } else { a });
                if nodes.last().is_none_or(|last| borders[at + 1] > last.0) {
                    nodes.push((borders[at + 1], most));
                }
                first = after;
            }
            for place in begins..=end {
                largest[place] = interpolated(&nodes, borders[place]);
            }
        }
        itself.contains(&false).then_some(Largest { values: largest, itself })
    }
}

/// What stays of a quantity without a sign, at the borders of the buckets.
#[derive(Debug, PartialEq)]
pub(super) struct Largest {
    pub(super) values: Vec<f64>,
    /// Where it is the quantity itself; elsewhere it goes through the largest values of every period.
    pub(super) itself: Vec<bool>,
}

/// How often a slow vibration turns in a period at most, as a size at its largest and at 0.
const SLOW_TURNS: usize = 2;

/// How often a curve turns round, by more than this.
fn turns(values: &[f64], by: f64) -> usize {
    let (mut turns, mut rises) = (0, None);
    let mut last = values.first().copied().unwrap_or(0.0);
    for value in values {
        match rises {
            // Further on the same way.
            Some(up) if (*value > last) == up => last = *value,
            _ if (value - last).abs() > by => {
                turns += usize::from(rises.is_some());
                (rises, last) = (Some(*value > last), *value);
            }
            _ => {}
        }
    }
    turns
}

/// Between two of these points, in the order of x, on a straight line; before the first and after the last one their values.
fn interpolated(nodes: &[(f64, f64)], x: f64) -> f64 {
    let after = nodes.partition_point(|node| node.0 < x);
    match (after.checked_sub(1).and_then(|before| nodes.get(before)), nodes.get(after)) {
        (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0),
        (Some(only), None) | (None, Some(only)) => only.1,
        (None, None) => 0.0,
    }
}

/// The stretches of time in which a contact presses, s, as indices of the borders at their ends: gaps shorter than the period belong to
/// them, but for those between two stretches in which it presses for long, as that of a block that stands on its feet by turns.
fn touches(borders: &[f64], normal: &[f64], period: f64) -> Vec<[usize; 2]> {
    let long = LONG * period;
    let pressing = normal.iter().enumerate().filter(|(_, force)| **force > 0.0);
    let pressing = joined(pressing.map(|(bucket, _)| [bucket, bucket + 1]), |[_, end], [begin, _]| {
        borders[begin] - borders[end] < long
    });
    let lasts = |[begin, end]: [usize; 2]| borders[end] - borders[begin] >= long;
    joined(pressing, |before, after| {
        borders[after[0]] - borders[before[1]] < period && !(lasts(before) && lasts(after))
    })
}

/// A contact is open, or presses, for long in this part of a period: so much of it that a mean across both would be a force that there never is.
const LONG: f64 = 0.125;

/// Stretches in their order, of which each belongs to the one before it if these say so.
fn joined(
    stretches: impl IntoIterator<Item = [usize; 2]>,
    belongs: impl Fn([usize; 2], [usize; 2]) -> bool,
) -> Vec<[usize; 2]> {
    let mut all: Vec<[usize; 2]> = Vec::new();
    for stretch in stretches {
        match all.last_mut() {
            Some(last) if belongs(*last, stretch) => last[1] = stretch[1],
            _ => all.push(stretch),
        }
    }
    all
}

/// What rings within a bucket has a range larger by this than the change of the means from bucket to bucket.
const RINGS: f64 = 3.0;

/// Whether there are enough buckets for means over several.
fn is_long(borders: &[f64]) -> bool {
    borders.len() * 2 >= 40
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::curves::Of;
    use teeter_integrator::ContactState;

    fn run(force: impl Fn(f64) -> f64) -> (Curves, ForceCurve) {
        let mut curves = Curves::new(1000, 0.0, vec![], 1);
        for k in 1..=1000 {
            let t = 1e-3 * f64::from(k);
            curves.enter(t, &[]);
            curves.add(0, [1e-3 * force(t), 0.0], Of::Force, ContactState::Stick, 0.0);
        }
        let forces = curves.forces(0).unwrap();
        (curves, forces)
    }

    /// Without impacts, and with the longest period.
    fn plain(curves: &Curves) -> Filter {
        Filter::with(longest(curves), &curves.borders(), &Jolts::default())
    }

    #[test]
    fn the_mean_is_the_force_that_carries() {
        // 3.1 N with 1 N of ringing at 400 Hz.
        let (curves, forces) = run(|t| 3.1 + (2.0 * std::f64::consts::PI * 400.0 * t).sin());
        let filter = Filter::of(&curves, &Jolts::default(), std::slice::from_ref(&forces.normal));
        assert!((filter.period - 0.02).abs() < 1e-12, "{filter:?}");
        let (means, strays) = filter.normal(&curves, &forces).unwrap();
        assert!(strays);
        // To the ends of the run.
        assert!(means.iter().all(|mean| (mean - 3.1).abs() < 0.1), "{means:?}");
        assert_eq!(means.len(), curves.borders().len());
    }

    #[test]
    fn there_is_no_mean_before_a_contact_touches_or_after_it_has_left() {
        let ringing = |t: f64| 3.1 + (2.0 * std::f64::consts::PI * 400.0 * t).sin();
        let (curves, forces) = run(|t| if (0.3..0.7).contains(&t) { ringing(t) } else { 0.0 });
        let (means, _) = plain(&curves).normal(&curves, &forces).unwrap();
        for (mean, t) in means.iter().zip(curves.borders()) {
            // To a bucket of two steps.
            let expected = if (0.296..=0.704).contains(&t) { 2.5..=3.7 } else { 0.0..=0.0 };
            let edge = (t - 0.3).abs() < 0.005 || (t - 0.7).abs() < 0.005;
            assert!(edge || expected.contains(mean), "{mean} at {t}");
        }
    }

    #[test]
    fn a_foot_in_the_air_bears_nothing_however_long_the_run() {
        // In buckets of 0.2 ms, with a longest period of 20 ms.
        let means = |force: &dyn Fn(f64) -> f64| {
            let mut curves = Curves::new(5000, 0.0, vec![], 1);
            for t in (1..=10_000).map(|k| 1e-4 * f64::from(k)) {
                curves.enter(t, &[]);
                curves.add(0, [1e-4 * force(t), 0.0], Of::Force, ContactState::Stick, 0.0);
            }
            let (means, _) = plain(&curves).normal(&curves, &curves.forces(0).unwrap()).unwrap();
            curves.borders().into_iter().zip(means).collect::<Vec<_>>()
        };
        // Feet bear by turns, for 12 ms each, and ring.
        let lifted = |t: f64| (t / 0.012) as u64 % 2 == 1;
        for (t, mean) in means(&|t| if lifted(t) { 0.0 } else { 3.1 + 2.0 * (2e3 * t).sin() }) {
            let is_inside = lifted(t - 5e-4) && lifted(t) && lifted(t + 5e-4);
            assert!(!is_inside || mean == 0.0, "{mean} at {t}");
        }
        // What only chatters has one mean across.
        let chatters = means(&|t| if ((t / 1e-3) as u64).is_multiple_of(2) { 6.0 } else { 0.0 });
        assert!(chatters.iter().all(|(_, mean)| (mean - 3.0).abs() < 0.5), "{chatters:?}");
    }

    #[test]
    fn strikes_are_not_smeared() {
        // It rests in the end, after 20 strikes.
        let (curves, forces) = run(|t| match (t * 1e3).round() as u64 {
            k if k > 700 => 3.0,
            k if k % 35 == 0 => 500.0,
            _ => 0.0,
        });
        assert!(!plain(&curves).normal(&curves, &forces).unwrap().1);
    }

    #[test]
    fn of_what_has_no_sign_the_largest_of_each_period_is_left() {
        let stress = |t: f64| (1.0 - 0.5 * t) * (2.0 * std::f64::consts::PI * 400.0 * t).sin().abs();
        let mut curves = Curves::new(400, 0.0, vec![0.0], 0);
        (1..=20_000).map(|k| 5e-5 * f64::from(k)).for_each(|t| curves.enter(t, &[stress(t)]));
        let largest = plain(&curves).through_the_largest(&curves, 0, None).unwrap().values;
        assert_eq!(largest.len(), curves.borders().len());
        for (largest, t) in largest.iter().zip(curves.borders()) {
            assert!((largest - (1.0 - 0.5 * t)).abs() < 0.02, "{largest} at {t}");
        }
    }

    #[test]
    fn a_stress_is_a_curve_where_its_moment_is_one() {
        // 9 and 60 Hz in 1 s, with a longest period of 20 ms: the size has twice the frequency.
        for (frequency, rings) in [(9.0, false), (20.0, false), (60.0, true)] {
            let mut curves = Curves::new(10_000, 0.0, vec![0.0, 0.0], 0);
            (1..=20_000).map(|k| 5e-5 * f64::from(k)).for_each(|t| {
                let moment = (2.0 * std::f64::consts::PI * frequency * t).sin();
                curves.enter(t, &[moment, moment.abs()]);
            });
            let filter = plain(&curves);
            assert_eq!(filter.ringing(&curves, 0).is_some(), rings, "{frequency}");
            assert_eq!(filter.through_the_largest(&curves, 1, None).is_some(), rings, "{frequency}");
            assert_eq!(filter.through_the_largest(&curves, 1, Some(false)), None, "{frequency}");
        }
    }

    #[test]
    fn a_stress_is_drawn_through_its_largest_values_only_while_it_rings() {
        let tau = 2.0 * std::f64::consts::PI;
        let stress = |t: f64| {
            let rings = if t < 0.6 { 3.0 * (tau * 400.0 * t).sin() } else { 0.0 };
            (4.0 + 4.0 * (tau * 3.0 * t).sin() + rings).abs()
        };
        let mut curves = Curves::new(10_000, 0.0, vec![stress(0.0)], 0);
        (1..=20_000).map(|k| 5e-5 * f64::from(k)).for_each(|t| curves.enter(t, &[stress(t)]));
        let Largest { values, itself } = plain(&curves).through_the_largest(&curves, 0, Some(true)).unwrap();
        for ((largest, itself), t) in values.iter().zip(itself).zip(curves.borders()) {
            // The period in which it stops ringing may be of either kind.
            assert!(itself == (t >= 0.6) || (t - 0.6).abs() < 0.021, "told apart, at {t}");
            let slow = 4.0 + 4.0 * (tau * 3.0 * t).sin();
            match t {
                // Two of its values are 20 ms apart, in which what is slow changes by 1.5.
                t if t < 0.58 => assert!((largest - slow - 3.0).abs() < 2.0, "{largest} at {t}"),
                t if t > 0.62 => assert!((largest - slow).abs() < 1e-3, "{largest}, not {slow} at {t}"),
                _ => {}
            }
        }
    }

    /// It rings up to a jolt, and not from then on: no point behind that is of what rang before.
    #[test]
    fn right_after_a_jolt_a_stress_that_does_not_ring_is_itself() {
        let tau = 2.0 * std::f64::consts::PI;
        let stress = |t: f64| if t < 0.5 { 6.0 + 3.0 * (tau * 400.0 * t).sin() } else { 1.0 + t };
        let mut curves = Curves::new(10_000, 0.0, vec![stress(0.0)], 0);
        (1..=20_000).map(|k| 5e-5 * f64::from(k)).for_each(|t| curves.enter(t, &[stress(t)]));
        let filter = Filter::with(longest(&curves), &curves.borders(), &jolts(&[0.5]));
        let Largest { values, itself } = filter.through_the_largest(&curves, 0, Some(true)).unwrap();
        for ((largest, itself), t) in values.iter().zip(itself).zip(curves.borders()) {
            // A bucket has two steps.
            assert_eq!(itself, t > 0.5 - 1e-9, "at {t}");
            assert!(!itself || (largest - stress(t)).abs() < 1e-3, "{largest}, not {} at {t}", stress(t));
        }
    }

    #[test]
    fn what_rings_has_a_mean_and_what_swings_has_none() {
        let of = |frequency: f64, capacity: usize| {
            let reaction = |t: f64| 75.0 + 500.0 * (2.0 * std::f64::consts::PI * frequency * t).sin();
            let mut curves = Curves::new(capacity, 0.0, vec![reaction(0.0)], 0);
            (1..=20_000).map(|k| 5e-5 * f64::from(k)).for_each(|t| curves.enter(t, &[reaction(t)]));
            plain(&curves).ringing(&curves, 0)
        };
        // In buckets of two steps, and of 64.
        for capacity in [10_000, 400] {
            let means = of(400.0, capacity).unwrap();
            let inner = &means[means.len() / 20..means.len() * 19 / 20];
            assert!(inner.iter().all(|mean| (mean - 75.0).abs() < 25.0), "{capacity}: {inner:?}");
            // Five periods of it are seen without a mean.
            assert_eq!(of(5.0, capacity), None);
        }
    }

    /// The amplitude that is left of a slow vibration of this frequency, of 5 under 4 of 400 Hz in 1 s, without the ends of the run; and the period.
    fn left_of(slow: f64) -> (f64, f64) {
        let tau = 2.0 * std::f64::consts::PI;
        let moment = |t: f64| 9.0 + 5.0 * (tau * slow * t).sin() + 4.0 * (tau * 400.0 * t).sin();
        let mut curves = Curves::new(10_000, 0.0, vec![moment(0.0)], 0);
        (1..=20_000).map(|k| 5e-5 * f64::from(k)).for_each(|t| curves.enter(t, &[moment(t)]));
        let filter = Filter::of(&curves, &Jolts::default(), &[curves.means(0)]);
        let means = filter.ringing(&curves, 0).unwrap();
        let inner = &means[means.len() / 8..means.len() * 7 / 8];
        let (low, high) = inner.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
        (0.5 * (high - low) / 5.0, filter.period)
    }

    #[test]
    fn a_slow_vibration_under_what_rings_keeps_its_size() {
        // A running mean over 20 ms leaves 86, 64 and 0 % of those of 15, 25 and 50 Hz.
        for slow in [2.0, 15.0, 25.0, 40.0, 50.0, 60.0] {
            let (left, period) = left_of(slow);
            assert!((left - 1.0).abs() < 0.03, "{slow} Hz: {left} at {period} s");
        }
        assert_eq!([left_of(15.0).1, left_of(50.0).1], [0.02, 0.01], "about the border of fast and slow it moves");
    }

    #[test]
    fn what_rings_in_many_frequencies_has_a_mean() {
        let tau = 2.0 * std::f64::consts::PI;
        let reaction = |t: f64| {
            75.0 + (1..40).map(|k| 20.0 * (tau * 13.7 * f64::from(k) * t + f64::from(k * k)).sin()).sum::<f64>()
        };
        let mut curves = Curves::new(10_000, 0.0, vec![reaction(0.0)], 0);
        (1..=20_000).map(|k| 5e-5 * f64::from(k)).for_each(|t| curves.enter(t, &[reaction(t)]));
        assert!(Filter::of(&curves, &Jolts::default(), &[curves.means(0)]).ringing(&curves, 0).is_some());
    }

    #[test]
    fn at_the_ends_of_a_run_the_mean_neither_leads_nor_lags() {
        let rising = |t: f64| 100.0 * t + 20.0 * (2.0 * std::f64::consts::PI * 400.0 * t).sin();
        let mut curves = Curves::new(10_000, 0.0, vec![rising(0.0)], 0);
        (1..=20_000).map(|k| 5e-5 * f64::from(k)).for_each(|t| curves.enter(t, &[rising(t)]));
        let means = plain(&curves).ringing(&curves, 0).unwrap();
        assert!(means[0].abs() < 4.0, "{}", means[0]);
    }

    #[test]
    fn a_smooth_force_has_no_mean_beside_it() {
        let (curves, forces) = run(|t| 3.0 + t);
        assert!(!plain(&curves).normal(&curves, &forces).unwrap().1);
    }

    fn jolts(impacts: &[f64]) -> Jolts {
        Jolts { times: impacts.to_vec(), what: "impacts" }
    }

    /// A beam without load that rings from impacts on, by as much as `force` says, in 1 s.
    fn struck(impacts: &[f64], force: impl Fn(f64) -> f64) -> Curves {
        let raw = |t: f64| if impacts.iter().any(|impact| t >= impact - 1e-9) { force(t) } else { 0.0 };
        let mut curves = Curves::new(2000, 0.0, vec![0.0], 0);
        (1..=20_000).map(|k| 5e-5 * f64::from(k)).for_each(|t| curves.enter(t, &[raw(t)]));
        curves
    }

    #[test]
    fn nothing_changes_before_the_impact_that_causes_it() {
        let tau = 2.0 * std::f64::consts::PI;
        let ringing = |t: f64| 60.0 + 100.0 * (tau * 400.0 * t).sin() + 20.0 * (tau * 20.0 * t).cos();
        let impacts = [0.2165, 0.6];
        let curves = struck(&impacts, ringing);
        let filter = Filter::of(&curves, &jolts(&impacts), &[curves.means(0)]);
        let means = filter.ringing(&curves, 0).unwrap();
        let largest = filter.through_the_largest(&curves, 0, None).unwrap().values;
        for ((t, mean), largest) in curves.borders().into_iter().zip(means).zip(largest) {
            if t < impacts[0] {
                assert_eq!([mean, largest], [0.0; 2], "at {t}");
            } else if t > impacts[0] + 1e-3 {
                // Right before and after an impact, and at the end, a part of a fast period has a mean of its own.
                let is_near = impacts.iter().chain(&[1.0]).any(|impact| (t - impact).abs() < 0.02);
                let slow = 60.0 + 20.0 * (tau * 20.0 * t).cos();
                assert!((mean - slow).abs() < if is_near { 15.0 } else { 2.0 }, "{mean}, not {slow} at {t}");
            }
        }
        assert_eq!(filter.told(), "20 ms, not across impacts");
    }

    /// A slow vibration that grows from an impact on is largest 10 ms after it. The strong line has to follow it there, neither reaching the largest value
    /// early nor staying at one value, even though fast vibrations ring in other periods.
    #[test]
    fn the_largest_values_after_an_impact_are_no_step() {
        let tau = 2.0 * std::f64::consts::PI;
        let slow = |t: f64| (157.0 * (tau * 25.0 * (t - 0.2)).sin()).abs();
        let rings = |t: f64| if t > 0.6 { 30.0 } else { 3.0 } * (tau * 900.0 * t).sin().abs();
        let curves = struck(&[0.2], |t| slow(t) + rings(t));
        let filter = Filter::of(&curves, &jolts(&[0.2]), &[]);
        let largest = filter.through_the_largest(&curves, 0, Some(true)).unwrap().values;
        for t in [0.2005, 0.205, 0.21] {
            let place = curves.borders().partition_point(|border| *border < t);
            let exact = slow(curves.borders()[place]);
            // A bucket has sixteen steps, of which the curve has the extremes.
            assert!((largest[place] - exact).abs() < 0.1 * 157.0, "{}, not {exact} at {t}", largest[place]);
        }
    }

    #[test]
    fn means_reach_across_impacts_that_follow_each_other_closely() {
        let impacts = [0.2, 0.205, 0.21, 0.5];
        let filter = Filter::of(&struck(&impacts, |_| 1.0), &jolts(&impacts), &[]);
        assert_eq!(filter.cuts.len(), 2);
        assert_eq!(filter.told(), "20 ms, not across impacts further apart than that");
        assert_eq!(plain(&struck(&[], |_| 1.0)).told(), "20 ms");
    }
}
