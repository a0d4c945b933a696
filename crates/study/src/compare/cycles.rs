//! Half-cycles and impacts of a rocking motion, measured and simulated, as pairs.
//!
//! An impact is where φ crosses zero (theory §9). Both motions are read off the same samples.

use crate::measured::LocalFit;
use std::ops::Range;

/// A crossing of zero that isn't noise: |φ| is above this multiple of the noise on both sides.
const CLEAR: f64 = 4.0;
/// And above this share of the largest |φ|.
const CLEAR_SHARE: f64 = 0.02;
/// Rows on each side of an impact from which the rates before and after it are found.
const SIDE_ROWS: usize = 5;

/// The motion between two crossings.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HalfCycle {
    /// Its begin: a crossing, or the first row.
    pub begin: f64,
    /// The crossing at its end; `None` if the motion ends before.
    pub end: Option<f64>,
    /// The largest |φ|, with its sign, rad.
    pub amplitude: f64,
    /// Its time, s.
    pub amplitude_at: f64,
}

/// A crossing of zero.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Crossing {
    /// Its time, s.
    pub t: f64,
    /// Whether φ increases.
    pub rises: bool,
    /// Rate of φ before and after, extrapolated from the rows of both sides that are not smoothed across
    /// an impact, rad/s; `None` if there are too few.
    pub omega: Option<[f64; 2]>,
}

/// A motion in pieces.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Swing {
    /// Its half-cycles.
    pub half_cycles: Vec<HalfCycle>,
    /// Its crossings.
    pub crossings: Vec<Crossing>,
}

/// A half-cycle of the measured motion and that of the simulated one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HalfCyclePair {
    /// The measured one.
    pub measured: HalfCycle,
    /// The simulated one; `None` if there is none.
    pub simulated: Option<HalfCycle>,
}

impl HalfCyclePair {
    /// Simulated over measured amplitude.
    #[must_use]
    pub fn amplitude_ratio(&self) -> Option<f64> {
        Some(self.simulated?.amplitude / self.measured.amplitude)
    }

    /// How much later the simulated half-cycle ends, s.
    #[must_use]
    pub fn delay(&self) -> Option<f64> {
        Some(self.simulated?.end? - self.measured.end?)
    }

    /// The same as a phase, degrees: a half-cycle is 180°.
    #[must_use]
    pub fn phase(&self) -> Option<f64> {
        Some(180.0 * self.delay()? / (self.measured.end? - self.measured.begin))
    }
}

/// An impact of the measured motion and that of the simulated one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ImpactPair {
    /// The measured one; `None` if only the run has it.
    pub measured: Option<Crossing>,
    /// The simulated one; `None` if only the measured motion has it.
    pub simulated: Option<Crossing>,
}

impl Crossing {
    /// The rate after over that before the impact.
    #[must_use]
    pub fn kept(&self) -> Option<f64> {
        self.omega.map(|[before, after]| after / before)
    }
}

/// Divides a motion at its crossings, of which those within `noise` (rad) don't count; `t` are the
/// times of the `rows` of `fit`.
#[must_use]
pub fn swing(t: &[f64], fit: &LocalFit, rows: Range<usize>, noise: f64) -> Swing {
    let (phi, omega) = (&fit.value[rows.clone()], &fit.rate[rows]);
    let valid: Vec<usize> = (0..t.len()).filter(|&k| phi[k].is_finite()).collect();
    let largest = valid.iter().map(|&k| phi[k].abs()).fold(0.0, f64::max);
    let clear = (CLEAR * noise).max(CLEAR_SHARE * largest);
    if !(largest > 0.0) || clear >= largest {
        return Swing::default();
    }
    // The side on which the motion is for certain; a crossing is the last change of sign before it
    // is certainly on the other one.
    let mut crossings: Vec<Crossing> = Vec::new();
    let (mut side, mut last_change) = (0.0, None);
    for pair in valid.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        if phi[a] * phi[b] <= 0.0 && phi[a] != phi[b] {
            last_change = Some(t[a] + (t[b] - t[a]) * phi[a] / (phi[a] - phi[b]));
        }
        if phi[b].abs() > clear {
            let now = phi[b].signum();
            if side * now < 0.0 {
                crossings.extend(last_change.map(|t| Crossing { t, rises: now > 0.0, omega: None }));
            }
            (side, last_change) = (now, None);
        } else if phi[a].abs() > clear {
            side = phi[a].signum();
        }
    }
    let bounds: Vec<f64> = crossings.iter().map(|crossing| crossing.t).collect();
    for (k, crossing) in crossings.iter_mut().enumerate() {
        let from = k.checked_sub(1).map_or(f64::NEG_INFINITY, |before| bounds[before]);
        let to = bounds.get(k + 1).copied().unwrap_or(f64::INFINITY);
        let before: Vec<usize> = valid.iter().copied().filter(|&row| t[row] > from && t[row] < crossing.t).collect();
        let after: Vec<usize> = valid.iter().copied().filter(|&row| t[row] > crossing.t && t[row] < to).collect();
        // Rows next to the impact are smoothed across it, those at the other end across the one there. One
        // more is left out, as smoothing moves the crossing.
        let rate = |rows: &[usize]| line_at(rows.iter().map(|&row| (t[row] - crossing.t, omega[row])));
        let (next, far) = (fit.window / 2 + 1, fit.window / 2);
        let first = if k == 0 { 0 } else { far };
        let before = before.get(first..before.len().saturating_sub(next)).unwrap_or_default();
        let last = after.len().saturating_sub(if k + 1 == bounds.len() { 0 } else { far });
        let after = after.get(next..last).unwrap_or_default();
        if before.len() >= SIDE_ROWS && after.len() >= SIDE_ROWS {
            let rates = (rate(&before[before.len() - SIDE_ROWS..]), rate(&after[..SIDE_ROWS]));
            crossing.omega = rates.0.zip(rates.1).map(|(before, after)| [before, after]);
        }
    }
    let first = valid.first().map_or(0.0, |&k| t[k]);
    let begins = std::iter::once(first).chain(bounds.iter().copied());
    let ends = bounds.iter().copied().map(Some).chain([None]);
    let half_cycles = begins.zip(ends).filter_map(|(begin, end)| {
        let inside = valid.iter().copied().filter(|&k| t[k] >= begin && end.is_none_or(|end| t[k] <= end));
        let top = inside.max_by(|&a, &b| phi[a].abs().total_cmp(&phi[b].abs()))?;
        let (amplitude_at, amplitude) = summit(t, phi, top);
        // What only begins at the end of the rows has no amplitude yet.
        let complete = end.is_some() || valid.last().is_some_and(|&last| top != last);
        complete.then_some(HalfCycle { begin, end, amplitude, amplitude_at })
    });
    Swing { half_cycles: half_cycles.collect(), crossings }
}

/// The value at 0 of the line through points by least squares.
fn line_at(points: impl Iterator<Item = (f64, f64)> + Clone) -> Option<f64> {
    let n = points.clone().count() as f64;
    let (s, y) = points.clone().fold((0.0, 0.0), |(s, y), point| (s + point.0 / n, y + point.1 / n));
    let (mut ss, mut sy) = (0.0, 0.0);
    for (a, b) in points {
        ss += (a - s) * (a - s);
        sy += (a - s) * (b - y);
    }
    (ss > 0.0).then(|| y - s * sy / ss)
}

/// The top of the parabola through the largest value and its neighbours: time and value.
fn summit(t: &[f64], phi: &[f64], top: usize) -> (f64, f64) {
    let neighbours = top.checked_sub(1).and_then(|before| Some((before, (top + 1 < t.len()).then_some(top + 1)?)));
    let Some((before, after)) = neighbours else { return (t[top], phi[top]) };
    let points = [before, top, after].map(|k| (t[k] - t[top], phi[k]));
    match crate::measured::parabola(points.into_iter()) {
        Some([a, b, c]) if points.iter().all(|point| point.1.is_finite()) && c * a < 0.0 => {
            let s = (-0.5 * b / c).clamp(points[0].0, points[2].0);
            (t[top] + s, a + s * (b + s * c))
        }
        _ => (t[top], phi[top]),
    }
}

/// Pairs each measured half-cycle with one simulated one of the same side: that whose impact at the end is the pair of its own impact there
/// ([`pair_impacts`]), else that of the impact at the begin; else the two that have most of their time in common.
#[must_use]
pub fn pair_half_cycles(measured: &Swing, simulated: &Swing) -> Vec<HalfCyclePair> {
    let (ours, theirs) = (&measured.half_cycles, &simulated.half_cycles);
    let mut partners = vec![None; ours.len()];
    let mut is_taken = vec![false; theirs.len()];
    let mut join = |k: usize, j: usize| {
        if partners[k].is_none() && !is_taken[j] && ours[k].amplitude * theirs[j].amplitude > 0.0 {
            (partners[k], is_taken[j]) = (Some(j), true);
        }
    };
    let impacts: Vec<(f64, f64)> = pair_impacts(measured, simulated)
        .iter()
        .filter_map(|pair| Some((pair.measured?.t, pair.simulated?.t)))
        .collect();
    let bounds: [fn(&HalfCycle) -> Option<f64>; 2] = [|half| half.end, |half| Some(half.begin)];
    for bound in bounds {
        for (t, other) in &impacts {
            let at = |halves: &[HalfCycle], t: f64| halves.iter().position(|half| bound(half) == Some(t));
            if let (Some(k), Some(j)) = (at(ours, *t), at(theirs, *other)) {
                join(k, j);
            }
        }
    }
    let last = |half: &HalfCycle| half.end.unwrap_or(f64::INFINITY).min(1e12);
    let common = |a: &HalfCycle, b: &HalfCycle| last(a).min(last(b)) - a.begin.max(b.begin);
    let all = (0..ours.len()).flat_map(|k| (0..theirs.len()).map(move |j| (k, j)));
    let mut overlaps: Vec<(f64, usize, usize)> =
        all.map(|(k, j)| (common(&ours[k], &theirs[j]), k, j)).filter(|(time, ..)| *time > 0.0).collect();
    overlaps.sort_by(|a, b| b.0.total_cmp(&a.0));
    overlaps.into_iter().for_each(|(_, k, j)| join(k, j));
    let pairs = ours.iter().zip(partners);
    pairs
        .map(|(half, partner)| HalfCyclePair { measured: *half, simulated: partner.map(|j: usize| theirs[j]) })
        .collect()
}

/// Pairs impacts in their order: each measured one with the nearest simulated one of the same
/// direction, if no other measured one is nearer to that.
#[must_use]
pub fn pair_impacts(measured: &Swing, simulated: &Swing) -> Vec<ImpactPair> {
    let nearest = |crossing: &Crossing, among: &[Crossing]| {
        let same = among.iter().enumerate().filter(|(_, other)| other.rises == crossing.rises);
        same.min_by(|a, b| (a.1.t - crossing.t).abs().total_cmp(&(b.1.t - crossing.t).abs())).map(|(k, _)| k)
    };
    let mut pairs = Vec::new();
    let mut taken = vec![false; simulated.crossings.len()];
    for (k, crossing) in measured.crossings.iter().enumerate() {
        let partner = nearest(crossing, &simulated.crossings)
            .filter(|&other| nearest(&simulated.crossings[other], &measured.crossings) == Some(k));
        if let Some(partner) = partner {
            taken[partner] = true;
        }
        let simulated = partner.map(|partner| simulated.crossings[partner]);
        pairs.push(ImpactPair { measured: Some(*crossing), simulated });
    }
    let alone = simulated.crossings.iter().zip(&taken).filter(|(_, taken)| !**taken);
    pairs.extend(alone.map(|(crossing, _)| ImpactPair { measured: None, simulated: Some(*crossing) }));
    let time = |pair: &ImpactPair| pair.measured.or(pair.simulated).map_or(0.0, |crossing| crossing.t);
    pairs.sort_by(|a, b| time(a).total_cmp(&time(b)));
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured::local_fit;

    /// A sampled motion of half-sines, each with a part of the speed of the one before.
    fn halves(kept: f64, begin: f64, noise: f64) -> Swing {
        let (period, rate) = (0.2, 165.0);
        let phi = |t: f64| {
            let half = (t / period).floor();
            0.1 * kept.powf(half) * (std::f64::consts::PI * t / period).sin()
        };
        let t: Vec<f64> = (0..200).map(|k| begin + f64::from(k) / rate).collect();
        let y: Vec<f64> =
            t.iter().enumerate().map(|(k, t)| phi(*t) + noise * ((k * 7919 % 13) as f64 / 6.0 - 1.0)).collect();
        let fit = local_fit(&t, &y, 5);
        swing(&t, &fit, 0..t.len(), fit.noise)
    }

    #[test]
    fn amplitudes_crossings_and_what_impacts_keep_are_found() {
        for (noise, slack) in [(0.0, 1.0), (3e-4, 8.0)] {
            let found = halves(0.9, 0.003, noise);
            assert_eq!(found.crossings.len(), 6, "{found:?}");
            for (k, crossing) in found.crossings.iter().enumerate() {
                let exact = 0.2 * (k + 1) as f64;
                assert!((crossing.t - exact).abs() < slack * 3e-4, "{crossing:?}");
                // There are too few rows after the last one.
                let kept = crossing.kept();
                assert!(k == 5 || (kept.unwrap() - 0.9).abs() < slack * 0.01, "{crossing:?}");
            }
            for (k, half) in found.half_cycles.iter().enumerate().take(5) {
                let exact = 0.1 * 0.9_f64.powi(k as i32) * if k % 2 == 0 { 1.0 } else { -1.0 };
                assert!((half.amplitude - exact).abs() < slack * 1e-4, "{half:?} {exact}");
            }
        }
    }

    #[test]
    fn no_window_reaches_across_the_impact_whose_rates_are_found() {
        // Parabolas, as of a slender block between impacts: exact but for the time of the crossing.
        for (window, period) in [(5, 0.2), (7, 0.2), (9, 0.2), (11, 0.2), (15, 0.2), (5, 0.07), (5, 0.055), (9, 0.1)] {
            let size = |n: f64| 0.9_f64.powf(n) * if n % 2.0 == 0.0 { 0.1 } else { -0.1 };
            let phi = |t: f64| {
                let (n, s) = ((t / period).floor(), (t / period).fract());
                4.0 * size(n) * s * (1.0 - s)
            };
            let t: Vec<f64> = (0..200).map(|k| 0.003 + f64::from(k) / 165.0).collect();
            let y: Vec<f64> = t.iter().map(|t| phi(*t)).collect();
            let found = swing(&t, &local_fit(&t, &y, window), 0..t.len(), 0.0);
            let mut with_rates = 0;
            for crossing in &found.crossings {
                let n = (crossing.t / period).round();
                let Some(rates) = crossing.omega else { continue };
                with_rates += 1;
                let off = (crossing.t - n * period).abs();
                for (rate, size) in rates.into_iter().zip([-size(n - 1.0), size(n)]) {
                    let exact = 4.0 * size / period;
                    let slope = 2.0 * exact.abs() / period;
                    assert!(
                        (rate - exact).abs() < slope * off + 1e-9,
                        "window {window}, {period} s: {crossing:?} {exact}"
                    );
                }
            }
            // Half-cycles of 33 rows have enough of them; of 9 rows, four on each side are smoothed
            // across an impact.
            assert!(with_rates >= 4 || period < 0.2, "window {window}: {with_rates}");
            assert!(with_rates == 0 || period != 0.055);
        }
    }

    #[test]
    fn noise_about_zero_is_no_impact() {
        let t: Vec<f64> = (0..100).map(|k| 0.01 * f64::from(k)).collect();
        let y: Vec<f64> =
            (0..100).map(|k| (0.1 * (1.0 - 0.02 * f64::from(k))).max(0.0) + 1e-4 * f64::from(k % 3 - 1)).collect();
        assert!(swing(&t, &local_fit(&t, &y, 5), 0..100, 1e-4).crossings.is_empty());
    }

    #[test]
    fn no_half_cycle_is_paired_twice() {
        // The simulated swings are longer: in the end they are out of step by a whole swing.
        let motion = |half: f64| {
            let t: Vec<f64> = (0..200).map(|k| f64::from(k) / 165.0).collect();
            let y: Vec<f64> = t.iter().map(|t| 0.1 * (std::f64::consts::PI * t / half).sin()).collect();
            swing(&t, &local_fit(&t, &y, 5), 0..t.len(), 0.0)
        };
        let (measured, simulated) = (motion(0.1), motion(0.12));
        let pairs = pair_half_cycles(&measured, &simulated);
        let begins: Vec<f64> = pairs.iter().filter_map(|pair| Some(pair.simulated?.begin)).collect();
        assert!(begins.len() >= 8 && begins.windows(2).all(|pair| pair[0] < pair[1]), "{begins:?}");
        // Each ends with the impact that its own is paired with.
        let impacts = pair_impacts(&measured, &simulated);
        for pair in &pairs {
            let partner = impacts.iter().find(|impact| impact.measured.map(|c| c.t) == pair.measured.end);
            if let Some(end) = partner.and_then(|impact| impact.simulated) {
                assert_eq!(pair.simulated.and_then(|half| half.end), Some(end.t), "{pair:?}");
            }
        }
    }

    #[test]
    fn a_missing_impact_stays_alone() {
        let crossing = |t: f64, rises: bool| Crossing { t, rises, omega: None };
        let measured = Swing { crossings: vec![crossing(0.1, false), crossing(0.3, true)], ..Swing::default() };
        let simulated = Swing {
            crossings: vec![crossing(0.11, false), crossing(0.29, true), crossing(0.4, false)],
            ..Swing::default()
        };
        let pairs = pair_impacts(&measured, &simulated);
        let times: Vec<_> =
            pairs.iter().map(|pair| (pair.measured.map(|c| c.t), pair.simulated.map(|c| c.t))).collect();
        assert_eq!(times, [(Some(0.1), Some(0.11)), (Some(0.3), Some(0.29)), (None, Some(0.4))]);
    }
}
