//! The mean of a force over a window of time, beside its raw values: a beam that rings makes these a band in which the force that
//! carries is not seen.

use super::curves::{Curves, ForceCurve};

/// A window is this part of the run, rounded to 1, 2 or 5 times a power of ten.
const PART: f64 = 1.0 / 40.0;

/// Where raw values stray from the mean by less than this part of the largest mean, the mean would only cover them.
const STRAY: f64 = 0.02;

/// It has to do so for more than this part of the time in which the contact presses.
const LEAST: f64 = 0.25;

/// The window for a run of these curves, s.
pub(super) fn window(curves: &Curves) -> f64 {
    let borders = curves.borders();
    let run = borders.last().copied().unwrap_or(0.0) - borders.first().copied().unwrap_or(0.0);
    if !(run > 0.0) {
        return 0.0;
    }
    let power = 10f64.powf((run * PART).log10().floor());
    let digit = [5.0, 2.0, 1.0].into_iter().find(|digit| digit * power <= run * PART * (1.0 + 1e-9)).unwrap_or(1.0);
    digit * power
}

/// The stretches of time in which a contact presses, s, as indices of the borders at their ends: gaps shorter than the window belong to
/// them.
fn touches(borders: &[f64], normal: &[f64], window: f64) -> Vec<[usize; 2]> {
    let mut touches: Vec<[usize; 2]> = Vec::new();
    for (bucket, _) in normal.iter().enumerate().filter(|(_, force)| **force > 0.0) {
        match touches.last_mut() {
            Some([_, end]) if borders[bucket] - borders[*end] < window => *end = bucket + 1,
            _ => touches.push([bucket, bucket + 1]),
        }
    }
    touches
}

/// The means of the normal force over the window about the borders of the buckets, N: over what of the window lies in the run and in the
/// stretch in which the contact touches. `None` where the raw values are as smooth.
pub(super) fn normal(curves: &Curves, forces: &ForceCurve, window: f64) -> Option<Vec<f64>> {
    let borders = curves.borders();
    if forces.normal.is_empty() || !is_long(&borders) || window <= 0.0 {
        return None;
    }
    // Before it touches and after it has left there is no force, of which a mean beyond would make a ramp.
    let touches = touches(&borders, &forces.normal, window);
    let means = over(&borders, &forces.normal, window, &touches);
    let largest = means.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    // Of the time in which it presses: of one that only strikes now and then, a mean would make blocks as wide as the window.
    let pressing = || means.iter().zip(&forces.normal).filter(|(_, raw)| **raw > 0.0);
    let strays = pressing().filter(|(mean, raw)| (*mean - *raw).abs() > STRAY * largest).count();
    (strays as f64 > LEAST * pressing().count() as f64 && pressing().count() * 10 > means.len()).then_some(means)
}

/// What rings within a bucket has a range larger by this than the change of the means from bucket to bucket.
const RINGS: f64 = 3.0;

/// Whether there are enough buckets for windows of several.
fn is_long(borders: &[f64]) -> bool {
    borders.len() * 2 >= 40
}

/// Means over windows about the borders of buckets, of a quantity with these means over the buckets, in stretches given by the borders at
/// their ends: over as much of the window as the stretch has on both sides. 0 elsewhere.
fn over(borders: &[f64], values: &[f64], window: f64, stretches: &[[usize; 2]]) -> Vec<f64> {
    // The integral up to each border; between two, the quantity is constant.
    let mut integrals = vec![0.0];
    for (ends, value) in borders.windows(2).zip(values) {
        integrals.push(integrals[integrals.len() - 1] + value * (ends[1] - ends[0]));
    }
    let integral = |t: f64| {
        let bucket = borders.partition_point(|border| *border <= t).clamp(1, borders.len() - 1) - 1;
        integrals[bucket] + values[bucket] * (t - borders[bucket])
    };
    let mut means = vec![0.0; borders.len()];
    for [first, last] in stretches {
        for place in *first..=*last {
            let t = borders[place];
            // Of one side alone it would lag or lead: towards an end the window becomes shorter on both sides.
            let half = (0.5 * window).min(t - borders[*first]).min(borders[*last] - t);
            let (from, to) = if half > 0.0 {
                (t - half, t + half)
            } else if place == *first {
                (t, borders[place + 1])
            } else {
                (borders[place - 1], t)
            };
            means[place] = (integral(to) - integral(from)) / (to - from);
        }
    }
    means
}

/// The means of a quantity over the window about the borders of the buckets. `None` unless it rings: strays from its mean, and crosses
/// it at least once in a window, on average. A slower vibration is seen as it is, and a mean would only flatten it.
pub(super) fn ringing(curves: &Curves, column: usize, window: f64) -> Option<Vec<f64>> {
    let borders = curves.borders();
    if !is_long(&borders) || window <= 0.0 {
        return None;
    }
    let means = over(&borders, &curves.means(column), window, &[[0, borders.len() - 1]]);
    let largest = means.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let own = curves.means(column);
    // Two points of the curve lie in each bucket, after the one at the start.
    let values = curves.curve(column);
    let points = values[1..].chunks_exact(2).map(|pair| [pair[0], pair[1]]);
    let (mut far, mut crossings, mut above) = (0, 0, None);
    for (k, (pair, windows)) in points.zip(means.windows(2)).enumerate() {
        let mean = 0.5 * (windows[0] + windows[1]);
        far += usize::from(pair.iter().any(|x| (x - mean).abs() > STRAY * largest));
        let now = own[k] > mean;
        crossings += usize::from(above.is_some_and(|before: bool| before != now));
        above = Some(now);
        // A bucket of many steps: what moves through it has about the change of its means as range, what rings in it more.
        let change = |other: Option<&f64>| other.map_or(0.0_f64, |other| (other - own[k]).abs());
        let drift = change(own.get(k + 1)).max(change(k.checked_sub(1).and_then(|before| own.get(before))));
        crossings += 2 * usize::from((pair[1] - pair[0]).abs() > RINGS * drift.max(STRAY * largest));
    }
    let windows = (borders[borders.len() - 1] - borders[0]) / window;
    (far as f64 > LEAST * own.len() as f64 && crossings as f64 >= windows).then_some(means)
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

    #[test]
    fn the_mean_is_the_force_that_carries() {
        // 3.1 N with 1 N of ringing at 400 Hz.
        let (curves, forces) = run(|t| 3.1 + (2.0 * std::f64::consts::PI * 400.0 * t).sin());
        let window = window(&curves);
        assert!((window - 0.02).abs() < 1e-12, "{window}");
        let means = normal(&curves, &forces, window).unwrap();
        assert!(means.iter().skip(20).rev().skip(20).all(|mean| (mean - 3.1).abs() < 0.1));
        assert_eq!(means.len(), curves.borders().len());
    }

    #[test]
    fn there_is_no_mean_before_a_contact_touches_or_after_it_has_left() {
        let ringing = |t: f64| 3.1 + (2.0 * std::f64::consts::PI * 400.0 * t).sin();
        let (curves, forces) = run(|t| if (0.3..0.7).contains(&t) { ringing(t) } else { 0.0 });
        let means = normal(&curves, &forces, window(&curves)).unwrap();
        for (mean, t) in means.iter().zip(curves.borders()) {
            // To a bucket of two steps.
            let expected = if (0.296..=0.704).contains(&t) { 2.5..=3.7 } else { 0.0..=0.0 };
            let edge = (t - 0.3).abs() < 0.005 || (t - 0.7).abs() < 0.005;
            assert!(edge || expected.contains(mean), "{mean} at {t}");
        }
    }

    #[test]
    fn strikes_are_not_smeared() {
        // It rests in the end, after 20 strikes.
        let (curves, forces) = run(|t| match (t * 1e3).round() as u64 {
            k if k > 700 => 3.0,
            k if k % 35 == 0 => 500.0,
            _ => 0.0,
        });
        assert_eq!(normal(&curves, &forces, window(&curves)), None);
    }

    #[test]
    fn what_rings_has_a_mean_and_what_swings_has_none() {
        let of = |frequency: f64, capacity: usize| {
            let reaction = |t: f64| 75.0 + 500.0 * (2.0 * std::f64::consts::PI * frequency * t).sin();
            let mut curves = Curves::new(capacity, 0.0, vec![reaction(0.0)], 0);
            (1..=20_000).map(|k| 5e-5 * f64::from(k)).for_each(|t| curves.enter(t, &[reaction(t)]));
            let window = window(&curves);
            ringing(&curves, 0, window)
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

    #[test]
    fn at_the_ends_of_a_run_the_mean_neither_leads_nor_lags() {
        let rising = |t: f64| 100.0 * t + 20.0 * (2.0 * std::f64::consts::PI * 400.0 * t).sin();
        let mut curves = Curves::new(10_000, 0.0, vec![rising(0.0)], 0);
        (1..=20_000).map(|k| 5e-5 * f64::from(k)).for_each(|t| curves.enter(t, &[rising(t)]));
        let means = ringing(&curves, 0, window(&curves)).unwrap();
        assert!(means[0].abs() < 4.0, "{}", means[0]);
    }

    #[test]
    fn a_smooth_force_has_no_mean_beside_it() {
        let (curves, forces) = run(|t| 3.0 + t);
        assert_eq!(normal(&curves, &forces, window(&curves)), None);
    }
}
