//! y' = f(t, y) to rounding: Gragg's midpoint rule, extrapolated (Bulirsch and Stoer 1966, doi 10.1007/BF02165234; Hairer, Nørsett,
//! Wanner, *Solving Ordinary Differential Equations I*, II.9), with step size control and located events.
//!
//! Gragg's rule has an error in even powers of its small step; six of them, H/2, H/4, …, H/12, make a step of order 12. The sums are
//! taken of y − y⁰, which is small, so that they lose no digits of y.

use super::root::boundary;

/// Small steps of the midpoint rule in a step.
const DIVISIONS: [u32; 6] = [2, 4, 6, 8, 10, 12];

/// Largest error of a step, by the difference of the two highest orders, relative to max(|y_i|, 1): callers scale to order 1.
const TOLERANCE: f64 = 1e-14;

/// Where an integration ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Arrival<const N: usize> {
    pub(crate) t: f64,
    pub(crate) y: [f64; N],
    /// Whether it was the event that ended it.
    pub(crate) event: bool,
}

/// Integrates from `start` to time `end`, or to where `event`, which is positive just after the start, first becomes negative. No step
/// is longer than `longest`: an event that comes and goes within one is missed.
pub(crate) fn integrate<const N: usize>(
    f: impl Fn(f64, &[f64; N]) -> [f64; N],
    start: (f64, [f64; N]),
    end: f64,
    longest: f64,
    event: impl Fn(&[f64; N]) -> f64,
) -> Arrival<N> {
    let (mut t, mut y) = start;
    let mut h = 0.1 * longest;
    while t < end {
        h = h.min(longest).min(end - t);
        let (next, error) = step(&f, t, &y, h);
        let factor = 0.9 * (TOLERANCE / error.max(1e-300)).powf(1.0 / (2 * DIVISIONS.len() - 1) as f64);
        // Below this, what is left is rounding, and shorter steps don't help.
        if error > TOLERANCE && h > 1e-9 * longest {
            h *= factor.clamp(0.1, 0.9);
            continue;
        }
        if event(&next) < 0.0 {
            let tau = boundary(0.0, h, |tau| event(&step(&f, t, &y, tau).0) < 0.0);
            return Arrival { t: t + tau, y: step(&f, t, &y, tau).0, event: true };
        }
        t = if h == end - t { end } else { t + h };
        y = next;
        h *= factor.clamp(0.2, 4.0);
    }
    Arrival { t, y, event: false }
}

/// One step of length `h`: its end, and the estimate of its error.
fn step<const N: usize>(f: &impl Fn(f64, &[f64; N]) -> [f64; N], t: f64, y: &[f64; N], h: f64) -> ([f64; N], f64) {
    // The last row of Neville's scheme so far; `previous` is the entry one order below the last one.
    let mut row = [[0.0; N]; DIVISIONS.len()];
    let mut previous = [0.0; N];
    for (j, &n) in DIVISIONS.iter().enumerate() {
        let mut entry = midpoint(f, t, y, h, n);
        for k in 0..=j {
            std::mem::swap(&mut row[k], &mut entry);
            if k < j {
                // `entry` is now T_{j−1,k}; it becomes T_{j,k+1}.
                let ratio = f64::from(n) / f64::from(DIVISIONS[j - k - 1]);
                for i in 0..N {
                    entry[i] = row[k][i] + (row[k][i] - entry[i]) / (ratio * ratio - 1.0);
                }
                previous = row[k];
            }
        }
    }
    let last = row[DIVISIONS.len() - 1];
    let mut error = 0.0_f64;
    let mut end = *y;
    for i in 0..N {
        error = error.max((last[i] - previous[i]).abs() / y[i].abs().max(1.0));
        end[i] += last[i];
    }
    (end, error)
}

/// y(t + h) − y by Gragg's rule of `n` small steps.
fn midpoint<const N: usize>(f: &impl Fn(f64, &[f64; N]) -> [f64; N], t: f64, y: &[f64; N], h: f64, n: u32) -> [f64; N] {
    let small = h / f64::from(n);
    let plus = |z: &[f64; N], by: f64, slope: &[f64; N]| std::array::from_fn::<f64, N, _>(|i| z[i] + by * slope[i]);
    let mut before = [0.0; N];
    let mut now = plus(&before, small, &f(t, y));
    for k in 1..n {
        let slope = f(t + f64::from(k) * small, &plus(y, 1.0, &now));
        (before, now) = (now, plus(&before, 2.0 * small, &slope));
    }
    now
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_of_order_twelve() {
        let error = |h: f64| (step(&|_, y: &[f64; 1]| [y[0]], 0.0, &[1.0], h).0[0] - h.exp()).abs() / h;
        let order = (error(4.0) / error(2.0)).log2();
        assert!((11.0..14.0).contains(&order), "{order}");
    }

    #[test]
    fn an_oscillator_keeps_thirteen_digits_over_ten_periods() {
        let end = integrate(|_, y: &[f64; 2]| [y[1], -y[0]], (0.0, [1.0, 0.0]), 62.0, 1.0, |_| 1.0);
        assert!(!end.event && end.t == 62.0);
        assert!((end.y[0] - 62.0_f64.cos()).abs() < 1e-13 && (end.y[1] + 62.0_f64.sin()).abs() < 1e-13, "{end:?}");
    }

    #[test]
    fn time_is_the_time_of_the_stages() {
        let end = integrate(|t, _: &[f64; 1]| [t.powi(5)], (1.0, [0.0]), 2.0, 1.0, |_| 1.0);
        assert!((end.y[0] - 63.0 / 6.0).abs() < 1e-13, "{end:?}");
    }

    #[test]
    fn an_event_is_located_to_rounding() {
        let end = integrate(|_, y: &[f64; 2]| [y[1], -y[0]], (0.0, [0.0, 1.0]), 9.0, 0.5, |y| y[0]);
        assert!(end.event && (end.t - std::f64::consts::PI).abs() < 1e-14, "{end:?}");
    }
}
