//! Bounded least squares for functions that are a little rough: Levenberg–Marquardt with
//! differences over a chosen distance, and Nelder–Mead.
//!
//! Variables lie in [0, 1]. A rocking motion depends smoothly on its parameters but for steps of the
//! size of what a time step shifts an impact by; derivatives are central differences over a distance
//! that is large against them.

use super::matrix;

/// The result of an evaluation: a list of residuals, and what the caller wants to keep with it.
pub(super) struct Point<T> {
    pub(super) at: Vec<f64>,
    pub(super) residuals: Vec<f64>,
    pub(super) cost: f64,
    pub(super) kept: T,
}

/// Largest number of iterations.
const ITERATIONS: usize = 25;
/// Ended when the cost decreases by less than this share.
const STALLED: f64 = 1e-7;

/// Levenberg and Marquardt's method from `start`, with differences over `reach`. `of` returns `None`
/// where there is no value; `count` residuals may vary.
pub(super) fn levenberg_marquardt<T>(
    start: Point<T>,
    reach: f64,
    of: &mut impl FnMut(&[f64], &T) -> Option<Point<T>>,
) -> Point<T> {
    levenberg_marquardt_within(ITERATIONS, start, reach, of)
}

/// The same with at most so many iterations.
pub(super) fn levenberg_marquardt_within<T>(
    iterations: usize,
    start: Point<T>,
    reach: f64,
    of: &mut impl FnMut(&[f64], &T) -> Option<Point<T>>,
) -> Point<T> {
    let mut best = start;
    let mut damping = 1e-2;
    let n = best.at.len();
    for _ in 0..iterations {
        let Some(jacobian) = jacobian(&best, reach, of) else { break };
        let rows = best.residuals.len();
        if jacobian.iter().any(|column| column.len() != rows) {
            break;
        }
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let gradient: Vec<f64> = jacobian.iter().map(|column| product(column, &best.residuals)).collect();
        // A variable at a bound that would leave it stays there.
        let free: Vec<usize> = (0..n)
            .filter(|&k| !(best.at[k] <= 0.0 && gradient[k] > 0.0 || best.at[k] >= 1.0 && gradient[k] < 0.0))
            .collect();
        if free.is_empty() {
            break;
        }
        let before = best.cost;
        let mut improved = false;
        while damping < 1e8 {
            let mut normal: Vec<Vec<f64>> =
                free.iter().map(|&i| free.iter().map(|&j| product(&jacobian[i], &jacobian[j])).collect()).collect();
            for k in 0..free.len() {
                normal[k][k] += damping * normal[k][k].max(1e-12);
            }
            let right: Vec<f64> = free.iter().map(|&k| -gradient[k]).collect();
            let Some(step) = matrix::solve(&normal, right) else { break };
            let mut at = best.at.clone();
            free.iter().zip(&step).for_each(|(&k, step)| at[k] = (at[k] + step).clamp(0.0, 1.0));
            match of(&at, &best.kept) {
                Some(point) if point.cost < best.cost => {
                    best = point;
                    damping = (0.2 * damping).max(1e-9);
                    improved = true;
                    break;
                }
                _ => damping *= 5.0,
            }
        }
        if !improved || before - best.cost <= STALLED * before {
            break;
        }
    }
    best
}

/// Derivatives of the residuals by columns: central differences, one-sided at a bound.
pub(super) fn jacobian<T>(
    point: &Point<T>,
    reach: f64,
    of: &mut impl FnMut(&[f64], &T) -> Option<Point<T>>,
) -> Option<Vec<Vec<f64>>> {
    let mut columns = Vec::new();
    for k in 0..point.at.len() {
        let ends = [(point.at[k] - reach).max(0.0), (point.at[k] + reach).min(1.0)];
        let mut values = Vec::new();
        for end in ends {
            let mut at = point.at.clone();
            at[k] = end;
            values.push(of(&at, &point.kept)?.residuals);
        }
        if values[0].len() != values[1].len() {
            return None;
        }
        let width = ends[1] - ends[0];
        columns.push(values[1].iter().zip(&values[0]).map(|(b, a)| (b - a) / width).collect());
    }
    Some(columns)
}

/// The simplex method of Nelder and Mead (1965, doi 10.1093/comjnl/7.4.308) from `start`, with a
/// simplex of that size and at most so many evaluations.
pub(super) fn nelder_mead<T: Clone>(
    start: Point<T>,
    size: f64,
    evaluations: usize,
    of: &mut impl FnMut(&[f64], &T) -> Option<Point<T>>,
) -> Point<T> {
    let n = start.at.len();
    let kept = start.kept.clone();
    let mut simplex = vec![start];
    let mut count = 0;
    let mut value = |at: Vec<f64>, count: &mut usize| {
        *count += 1;
        of(&at, &kept)
    };
    for k in 0..n {
        let mut at = simplex[0].at.clone();
        at[k] += if at[k] + size <= 1.0 { size } else { -size };
        simplex.extend(value(at, &mut count));
    }
    while simplex.len() == n + 1 && count < evaluations {
        simplex.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let spread = simplex
            .iter()
            .flat_map(|p| p.at.iter().zip(&simplex[0].at).map(|(a, b)| (a - b).abs()))
            .fold(0.0, f64::max);
        if spread < 1e-5 {
            break;
        }
        let centre: Vec<f64> =
            (0..n).map(|k| simplex[..n].iter().map(|point| point.at[k]).sum::<f64>() / n as f64).collect();
        let along = |by: f64| -> Vec<f64> {
            centre.iter().zip(&simplex[n].at).map(|(c, w)| (c + by * (c - w)).clamp(0.0, 1.0)).collect()
        };
        let (worst, second) = (simplex[n].cost, simplex[n - 1].cost);
        let reflected = value(along(1.0), &mut count);
        let better = match reflected {
            Some(point) if point.cost < simplex[0].cost => {
                let expanded = value(along(2.0), &mut count).filter(|far| far.cost < point.cost);
                Some(expanded.unwrap_or(point))
            }
            Some(point) if point.cost < second => Some(point),
            other => {
                let by = if other.is_some_and(|point| point.cost < worst) { 0.5 } else { -0.5 };
                value(along(by), &mut count).filter(|point| point.cost < worst)
            }
        };
        match better {
            Some(point) => simplex[n] = point,
            None => {
                let towards: Vec<Vec<f64>> = simplex[1..]
                    .iter()
                    .map(|point| point.at.iter().zip(&simplex[0].at).map(|(a, b)| b + 0.5 * (a - b)).collect())
                    .collect();
                simplex.truncate(1);
                for at in towards {
                    simplex.extend(value(at, &mut count));
                }
            }
        }
    }
    simplex.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    simplex.swap_remove(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rosenbrock(at: &[f64], (): &()) -> Option<Point<()>> {
        // Its minimum (1, 1) is at 0.75 of [−2, 2].
        let [x, y] = [4.0 * at[0] - 2.0, 4.0 * at[1] - 2.0];
        let residuals = vec![10.0 * (y - x * x), 1.0 - x];
        let cost = residuals.iter().map(|r| r * r).sum::<f64>() / 2.0;
        Some(Point { at: at.to_vec(), residuals, cost, kept: () })
    }

    #[test]
    fn a_curved_valley_is_followed() {
        let start = || rosenbrock(&[0.2, 0.75], &()).unwrap();
        let found = levenberg_marquardt(start(), 1e-5, &mut rosenbrock);
        assert!((found.at[0] - 0.75).abs() < 1e-4 && (found.at[1] - 0.75).abs() < 1e-4, "{:?}", found.at);
        let found = nelder_mead(start(), 0.1, 400, &mut rosenbrock);
        assert!((found.at[0] - 0.75).abs() < 1e-2 && (found.at[1] - 0.75).abs() < 1e-2, "{:?}", found.at);
    }

    #[test]
    fn steps_of_the_function_are_ridden_over_and_bounds_held() {
        // The minimum of the second variable is beyond its bound; the first has steps of 1e-4.
        let mut of = |at: &[f64], (): &()| {
            let rough = 1e-4 * (at[0] / 1e-4).floor();
            let residuals = vec![rough - 0.3, 2.0 * at[1] - 2.6, 0.5 * (rough - 0.3) * at[1]];
            let cost = residuals.iter().map(|r| r * r).sum::<f64>() / 3.0;
            Some(Point { at: at.to_vec(), residuals, cost, kept: () })
        };
        let start = of(&[0.9, 0.1], &()).unwrap();
        let found = levenberg_marquardt(start, 5e-3, &mut of);
        assert!((found.at[0] - 0.3).abs() < 1e-3 && found.at[1] == 1.0, "{:?}", found.at);
    }
}
