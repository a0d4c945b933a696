//! Mean square differences of two motions for all shifts at once, by fast Fourier transforms.
//!
//! A recording of many periods fits nearly as well a period off, so that no shift may be left out and
//! no row either: one by one that would be rows times shifts.

use super::align::Window;
use std::f64::consts::TAU;

/// Most points of the common grid of times. The grid reaches over both motions and the longer one
/// again; that of a recording as long as its run still has 80 000 points.
const MOST_POINTS: usize = 1 << 18;
/// Points of the grid between two rows: as many shifts are told apart.
const POINTS_PER_ROW: f64 = 4.0;

/// A shift that fits better than those beside it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) shift: f64,
    /// About what is left at the best shift next to it.
    pub(super) mismatch: f64,
    /// Rows that it has within the run.
    pub(super) rows: usize,
}

/// The local minima of the mismatch over all shifts, best first, and the distance (s) within which
/// the exact minimum lies. `rows` are times and values of a motion, `interval` the time between two
/// of them, `simulated` the values of the other motion.
pub(super) fn candidates(
    rows: &[(f64, f64)],
    interval: f64,
    window: &Window,
    simulated: impl Fn(f64, &mut usize) -> f64,
) -> (Vec<Candidate>, f64) {
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return (Vec::new(), 0.0) };
    let length = last.0 - first.0;
    let reach = 2.0 * length + window.end;
    let step = (interval / POINTS_PER_ROW).max(reach / MOST_POINTS as f64);
    if !(step > 0.0 && step.is_finite()) {
        return (Vec::new(), 0.0);
    }
    // The zero of the run's time is a point of the grid, and there are as many points before it as
    // the recording has.
    let before = (length / step).ceil() as usize;
    let count = before + (window.end / step).floor() as usize + 1;
    let held = if window.begin < 0.0 { 0 } else { before };
    let mut hint = 0;
    let mut other: Vec<f64> = (0..count)
        .map(|j| if j < held { 0.0 } else { simulated((j as f64 - before as f64) * step, &mut hint) })
        .collect();
    let places: Vec<usize> = rows.iter().map(|(t, _)| ((t - first.0) / step).round() as usize).collect();
    let mut values: Vec<f64> = rows.iter().map(|(_, value)| *value).collect();
    if window.centred {
        // Means over the common rows are taken out below; these keep sums small.
        for part in [&mut values, &mut other[held..]] {
            let mean = part.iter().sum::<f64>() / part.len().max(1) as f64;
            part.iter_mut().for_each(|value| *value -= mean);
        }
    }
    let longest = places.last().copied().unwrap_or(0) + 1;
    let sums = Sums::new(&places, &values, &other, (count + longest).next_power_of_two(), window.centred);
    // The rows whose times are within the run, and those after its start.
    let rows_at = |lag: usize| {
        let from = |point: usize| places.partition_point(|place| place + lag < point);
        (from(held), from(before), from(count))
    };
    let mismatch: Vec<f64> = (0..count)
        .map(|lag| {
            let (a, moving, b) = rows_at(lag);
            if window.enough(b - moving) { sums.mismatch(lag, a, b) } else { f64::INFINITY }
        })
        .collect();
    let at = |lag: f64| (lag - before as f64) * step - first.0;
    let value = |lag: usize| mismatch.get(lag).copied().unwrap_or(f64::INFINITY);
    let mut found: Vec<Candidate> = (0..count)
        .filter_map(|lag| {
            let [a, b, c] = [lag.checked_sub(1).map_or(f64::INFINITY, value), value(lag), value(lag + 1)];
            if !(b.is_finite() && b <= a && b <= c) {
                return None;
            }
            // The vertex of the parabola through the three.
            let (slope, bend) = (0.5 * (c - a), a - 2.0 * b + c);
            let (off, less) =
                if bend > 0.0 && bend.is_finite() { (-slope / bend, 0.5 * slope * slope / bend) } else { (0.0, 0.0) };
            let (from, _, to) = rows_at(lag);
            Some(Candidate { shift: at(lag as f64 + off), mismatch: b - less, rows: to - from })
        })
        .collect();
    found.sort_by(|a, b| a.mismatch.total_cmp(&b.mismatch));
    (found, step.max(interval))
}

/// Sums over the rows of a motion at each lag, x being its values and y those of the other motion.
struct Sums {
    /// Of x and x², up to each row.
    x: Vec<[f64; 2]>,
    /// Of x y, y² and y at each lag.
    xy: Vec<f64>,
    yy: Vec<f64>,
    y: Option<Vec<f64>>,
}

impl Sums {
    /// `size` is a power of two with room for all lags.
    fn new(places: &[usize], values: &[f64], other: &[f64], size: usize, centred: bool) -> Self {
        let mut x = vec![[0.0; 2]];
        let mut sum = [0.0; 2];
        let mut ones_and_values = vec![[0.0; 2]; size];
        for (place, value) in places.iter().zip(values) {
            sum = [sum[0] + value, sum[1] + value * value];
            x.push(sum);
            let point = &mut ones_and_values[*place];
            *point = [point[0] + 1.0, point[1] + value];
        }
        let mut others: Vec<[f64; 2]> = other.iter().map(|y| [*y, y * y]).collect();
        others.resize(size, [0.0; 2]);
        // Two real sequences in one transform each: the first as real part, the second as imaginary.
        let factors = factors(size);
        transform(&mut ones_and_values, &factors);
        transform(&mut others, &factors);
        let mut products = vec![[0.0; 2]; size];
        let mut third = if centred { vec![[0.0; 2]; size] } else { Vec::new() };
        for k in 0..size {
            let (one, x) = parts(&ones_and_values, k);
            let (y, yy) = parts(&others, k);
            let [a, b] = conjugate_product(x, y);
            let [c, d] = conjugate_product(one, yy);
            products[k] = [a - d, b + c];
            if centred {
                third[k] = conjugate_product(one, y);
            }
        }
        inverse(&mut products, &factors);
        let y = centred.then(|| {
            inverse(&mut third, &factors);
            third.iter().map(|point| point[0]).collect()
        });
        let (xy, yy) = products.into_iter().map(|[xy, yy]| (xy, yy)).unzip();
        Self { x, xy, yy, y }
    }

    /// The mean square difference at a lag over that of both, of the rows `from` to `to`.
    fn mismatch(&self, lag: usize, from: usize, to: usize) -> f64 {
        let ([sx0, sxx0], [sx1, sxx1]) = (self.x[from], self.x[to]);
        let (mut xx, mut xy, mut yy) = (sxx1 - sxx0, self.xy[lag], self.yy[lag]);
        if let Some(y) = &self.y {
            let (sx, sy, n) = (sx1 - sx0, y[lag], (to - from) as f64);
            (xx, xy, yy) = (xx - sx * sx / n, xy - sx * sy / n, yy - sy * sy / n);
        }
        let all = xx + yy;
        if all > 0.0 { (all - 2.0 * xy) / all } else { f64::INFINITY }
    }
}

/// The transforms of the real and of the imaginary part of a sequence, from that of the whole.
fn parts(whole: &[[f64; 2]], k: usize) -> ([f64; 2], [f64; 2]) {
    let ([a, b], [c, d]) = (whole[k], whole[(whole.len() - k) % whole.len()]);
    ([0.5 * (a + c), 0.5 * (b - d)], [0.5 * (b + d), 0.5 * (c - a)])
}

/// The product of the conjugate of `a` with `b`.
fn conjugate_product(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] + a[1] * b[1], a[0] * b[1] - a[1] * b[0]]
}

/// The first half of the roots of one.
fn factors(size: usize) -> Vec<[f64; 2]> {
    (0..size / 2)
        .map(|k| {
            let (sin, cos) = (TAU * k as f64 / size as f64).sin_cos();
            [cos, -sin]
        })
        .collect()
}

/// The discrete Fourier transform in place, of a power of two of points (Cooley and Tukey 1965,
/// doi 10.1090/S0025-5718-1965-0178586-1).
fn transform(data: &mut [[f64; 2]], factors: &[[f64; 2]]) {
    let size = data.len();
    if size < 2 {
        return;
    }
    let unused = usize::BITS - size.trailing_zeros();
    for k in 0..size {
        let mirrored = k.reverse_bits() >> unused;
        if k < mirrored {
            data.swap(k, mirrored);
        }
    }
    let mut half = 1;
    while half < size {
        let stride = size / (2 * half);
        for block in data.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for ((a, b), [cos, sin]) in low.iter_mut().zip(high).zip(factors.iter().step_by(stride)) {
                let turned = [b[0] * cos - b[1] * sin, b[0] * sin + b[1] * cos];
                (*a, *b) = ([a[0] + turned[0], a[1] + turned[1]], [a[0] - turned[0], a[1] - turned[1]]);
            }
        }
        half *= 2;
    }
}

/// The inverse of [`transform`].
fn inverse(data: &mut [[f64; 2]], factors: &[[f64; 2]]) {
    data.iter_mut().for_each(|point| point[1] = -point[1]);
    transform(data, factors);
    let share = 1.0 / data.len() as f64;
    data.iter_mut().for_each(|point| *point = [share * point[0], -share * point[1]]);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(k: usize) -> f64 {
        (0.3 * k as f64).sin() + 0.2 * (k * 7919 % 101) as f64 / 101.0
    }

    #[test]
    fn the_transform_is_that_of_its_definition_and_is_undone() {
        let size = 32;
        let data: Vec<[f64; 2]> = (0..size).map(|k| [wave(k), wave(k + 50)]).collect();
        let factors = factors(size);
        let mut fast = data.clone();
        transform(&mut fast, &factors);
        for (k, fast) in fast.iter().enumerate() {
            let exact = data.iter().enumerate().fold([0.0; 2], |sum, (n, [a, b])| {
                let (sin, cos) = (-TAU * (k * n % size) as f64 / size as f64).sin_cos();
                [sum[0] + a * cos - b * sin, sum[1] + a * sin + b * cos]
            });
            assert!((0..2).all(|part| (fast[part] - exact[part]).abs() < 1e-13), "{k}");
        }
        inverse(&mut fast, &factors);
        assert!(fast.iter().zip(&data).all(|(a, b)| (0..2).all(|part| (a[part] - b[part]).abs() < 1e-15)));
    }

    #[test]
    fn sums_at_each_lag_are_those_of_their_definition() {
        let places: Vec<usize> = (0..20).map(|k| 3 * k + k % 2).collect();
        let values: Vec<f64> = (0..20).map(wave).collect();
        let other: Vec<f64> = (0..100).map(|k| wave(2 * k + 5)).collect();
        for centred in [false, true] {
            let sums = Sums::new(&places, &values, &other, 256, centred);
            for lag in 0..100 {
                let inside: Vec<usize> = (0..20).filter(|&k| places[k] + lag < 100).collect();
                if inside.len() < 2 {
                    continue;
                }
                let mean = |of: &dyn Fn(usize) -> f64| inside.iter().map(|&k| of(k)).sum::<f64>() / inside.len() as f64;
                let (x, y) = (|k: usize| values[k], |k: usize| other[places[k] + lag]);
                let (mx, my) = if centred { (mean(&x), mean(&y)) } else { (0.0, 0.0) };
                let off = mean(&|k| (x(k) - mx - y(k) + my).powi(2));
                let exact = off / mean(&|k| (x(k) - mx).powi(2) + (y(k) - my).powi(2));
                let found = sums.mismatch(lag, 0, inside.len());
                assert!((found - exact).abs() < 1e-12, "lag {lag}: {found}, not {exact}");
            }
        }
    }
}
