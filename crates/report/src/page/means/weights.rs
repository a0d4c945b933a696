//! The weights of a mean that takes fast vibrations away.

/// The weights reach over this many periods on both sides: periods of 1.6 times the one told keep 99 % of their amplitude, those of 0.7 times lose 99 %.
const REACH: f64 = 2.0;

/// Of less than this part of a period there is nothing but the mean.
const SHORT: f64 = 0.25;

/// Weights of a windowed sinc: their integral from the start of their reach, at equally spaced places of it.
pub(super) struct Weights(Vec<f64>);

/// Places at which the integral is known.
const PLACES: usize = 1024;

impl Weights {
    pub(super) fn new() -> Self {
        use std::f64::consts::PI;
        let weight = |u: f64| {
            let x = 2.0 * PI * REACH * u;
            let sinc = if x == 0.0 { 1.0 } else { x.sin() / x };
            sinc * 0.5 * (1.0 + (PI * u).cos())
        };
        let mut integrals = vec![0.0];
        for place in 0..PLACES {
            let middle = 2.0 * (place as f64 + 0.5) / PLACES as f64 - 1.0;
            integrals.push(integrals[place] + weight(middle));
        }
        let all = integrals[PLACES];
        integrals.iter_mut().for_each(|integral| *integral /= all);
        Self(integrals)
    }

    /// The integral from the start of their reach to `u`, −1 at this start and 1 at the end.
    fn up_to(&self, u: f64) -> f64 {
        let at = (0.5 * (u + 1.0) * PLACES as f64).clamp(0.0, PLACES as f64);
        let place = (at as usize).min(PLACES - 1);
        self.0[place] + (at - place as f64) * (self.0[place + 1] - self.0[place])
    }

    /// Weighted means about the borders of buckets, of a quantity with these means over the buckets, in stretches given by the borders at
    /// their ends, in ascending order. Nothing outside of a stretch has a part in them. 0 elsewhere.
    ///
    /// The border at which a stretch begins, unless all does there, has what was before: the quantity jumps in the bucket that follows.
    pub(super) fn over(&self, borders: &[f64], values: &[f64], period: f64, stretches: &[[usize; 2]]) -> Vec<f64> {
        let mut means = vec![0.0; borders.len()];
        for &[first, last] in stretches {
            let (own, values) = (&borders[first..=last], &values[first..last]);
            let places = first + usize::from(first > 0)..=last;
            if own[own.len() - 1] - own[0] < SHORT * period {
                let sum: f64 = values.iter().zip(own.windows(2)).map(|(x, ends)| x * (ends[1] - ends[0])).sum();
                means[places].fill(sum / (own[own.len() - 1] - own[0]));
                continue;
            }
            let half = REACH * period;
            let (edges, values) = mirrored(own, values, half);
            for place in places {
                let t = borders[place];
                let mut bucket = edges.partition_point(|edge| *edge <= t - half).max(1) - 1;
                let (mut sum, mut before) = (0.0, 0.0);
                while bucket < values.len() && edges[bucket] < t + half {
                    let up_to = self.up_to((edges[bucket + 1] - t) / half);
                    sum += values[bucket] * (up_to - before);
                    (before, bucket) = (up_to, bucket + 1);
                }
                means[place] = sum;
            }
        }
        means
    }
}

/// Buckets with their mirror images beyond both ends, for at least `beyond` (s), over and over if need be: their edges and values. Of what is on one
/// side of an end alone a mean would lead or lag, or let pass what is fast.
fn mirrored(borders: &[f64], values: &[f64], beyond: f64) -> (Vec<f64>, Vec<f64>) {
    let count = values.len();
    // From the left end on to the right one, back, and so on.
    let bucket = |k: usize| if k % (2 * count) < count { k % (2 * count) } else { 2 * count - 1 - k % (2 * count) };
    let outwards = |from_left: bool| {
        let own = move |k: usize| if from_left { bucket(k) } else { count - 1 - bucket(k) };
        let mut covered = 0.0;
        let mut images = Vec::new();
        while covered < beyond {
            let image = own(images.len());
            covered += borders[image + 1] - borders[image];
            images.push((covered, values[image]));
        }
        images
    };
    let (left, right) = (outwards(true), outwards(false));
    let (start, end) = (borders[0], borders[count]);
    let before = left.iter().rev().map(|(beyond, _)| start - beyond);
    let edges = before.chain(borders.iter().copied()).chain(right.iter().map(|(beyond, _)| end + beyond));
    let all = left.iter().rev().map(|(_, x)| *x).chain(values.iter().copied()).chain(right.iter().map(|(_, x)| *x));
    (edges.collect(), all.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_are_mirrored_at_both_ends_as_often_as_need_be() {
        let (edges, values) = mirrored(&[1.0, 2.0, 4.0], &[5.0, 7.0], 4.0);
        assert_eq!(values, [7.0, 7.0, 5.0, 5.0, 7.0, 7.0, 5.0, 5.0]);
        assert_eq!(edges, [-4.0, -2.0, 0.0, 1.0, 2.0, 4.0, 6.0, 7.0, 8.0]);
    }

    #[test]
    fn what_is_constant_in_a_stretch_stays_so_to_its_ends() {
        let borders: Vec<f64> = (0..=100).map(f64::from).collect();
        let values: Vec<f64> = (0..100).map(|k| if k < 50 { 0.0 } else { 3.0 }).collect();
        let means = Weights::new().over(&borders, &values, 10.0, &[[0, 50], [50, 52], [52, 100]]);
        for (place, mean) in means.iter().enumerate() {
            let expected = if place <= 50 { 0.0 } else { 3.0 };
            assert!((mean - expected).abs() < 1e-12, "{mean} at {place}");
        }
    }
}
