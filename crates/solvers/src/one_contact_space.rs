//! Exact solution of the law of a single contact in space.
//!
//! A contact with `q_N < 0` sticks, `H p = −q` inside the cone, or slides along a direction d
//! (‖d‖ = 1) with `p = p_N (1, −μ d)`, `u_N = 0` and `u_T = s d`, s ≥ 0. With `w = H_NN − μ H_NT·d` and
//! λ = s w, eliminating p_N by `u_N = 0` gives
//!
//! ```text
//! (A + λ I) d = g,   ‖d‖ = 1,   λ ≥ 0,   w > 0
//! A = μ (q_T H_NT − q_N H_TT),   g = H_NN q_T − q_N H_TN
//! ```
//!
//! the form of a trust-region subproblem with a single unknown λ. Usually the roots of the quartic
//! `det(A + λI)² = ‖adj(A + λI) g‖²` (Bonnefon and Daviet 2011, INRIA RT-0417, hal-00553859)are
//! computed, but their closed form fails for coinciding roots, as for `H = c I`. Here, as in Moré
//! and Sorensen's method (1983, doi 10.1137/0904038), Newton's method starts from the last visit's
//! λ, or from ‖g‖ − ½ tr A (the exact root for `H = c I`), and takes one to three steps. If it
//! fails, all roots of the quartic in the admissible interval are isolated between the roots of its
//! derivatives, and the smallest impulse that satisfies the law is taken.

use teeter_contact::Block;

type Vector = [f64; 3];
/// A matrix by rows. D is 3; the functions are generic so that generic callers can pass their
/// blocks.
type Matrix<const D: usize> = [[f64; D]; D];

/// Largest number of Newton steps before the slow, safe method.
const STEPS: u32 = 12;

/// Below this residual of the equation, the next step counts as the last, as a step squares it.
const NEARLY: f64 = 1e-8;

/// The same when starting from the last visit's λ. A constant number of steps is worth more than
/// digits that the next sweep changes, and the error decreases from visit to visit.
const WARM: f64 = 1e-2;

/// Tolerance of the law for a candidate of the slow method, relative to the terms of its velocity:
/// the square root of rounding, the accuracy of coinciding roots. The residual is checked
/// afterwards.
const MISS: f64 = 1e-8;

/// The rows of a block.
pub(crate) fn rows<const D: usize>(h: &Block<D>) -> Matrix<D> {
    std::array::from_fn(|r| std::array::from_fn(|c| h[(r, c)]))
}

/// The inverse by cofactors, which is insensitive to scaling of rows and columns; `None` for a
/// matrix singular to `tolerance`.
pub(crate) fn inverse<const D: usize>(h: &Matrix<D>, tolerance: f64) -> Option<Matrix<D>> {
    let cofactor = |r: usize, c: usize| {
        let ((r1, r2), (c1, c2)) = (((r + 1) % 3, (r + 2) % 3), ((c + 1) % 3, (c + 2) % 3));
        h[r1][c1] * h[r2][c2] - h[r1][c2] * h[r2][c1]
    };
    let determinant = h[0][0] * cofactor(0, 0) + h[0][1] * cofactor(0, 1) + h[0][2] * cofactor(0, 2);
    let size = (h[0][0] * h[1][1] * h[2][2]).abs();
    let reciprocal = determinant.recip();
    if !(determinant.abs() > tolerance * size && reciprocal.is_finite()) {
        return None;
    }
    let mut inverse = [[0.0; D]; D];
    for r in 0..3 {
        for c in 0..3 {
            inverse[c][r] = cofactor(r, c) * reciprocal;
        }
    }
    Some(inverse)
}

#[inline]
fn dot<const D: usize>(a: &[f64; D], b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `p = −H⁻¹ q` if it lies in the cone, optionally refined once, so that the remaining velocity is
/// at rounding even for ill-conditioned blocks.
#[inline(always)]
fn stick<const D: usize>(h: &Matrix<D>, inverse: &Matrix<D>, q: &Vector, mu: f64, refine: bool) -> Option<Vector> {
    let solve = |q: &Vector| [-dot(&inverse[0], q), -dot(&inverse[1], q), -dot(&inverse[2], q)];
    let mut p = solve(q);
    let limit = mu * p[0];
    let inside = p[0] > 0.0 && p[1] * p[1] + p[2] * p[2] <= limit * limit;
    if !inside {
        return None;
    }
    if !refine {
        return Some(p);
    }
    let left = [dot(&h[0], &p) + q[0], dot(&h[1], &p) + q[1], dot(&h[2], &p) + q[2]];
    let correction = solve(&left);
    for i in 0..3 {
        p[i] += correction[i];
    }
    Some(p)
}

/// The equation for λ; see the module page.
struct SlideEquation {
    a: [[f64; 2]; 2],
    g: [f64; 2],
    /// adj(A) g, so that adj(A + λI) g = `back` + λ g.
    back: [f64; 2],
    trace: f64,
    determinant: f64,
}

impl SlideEquation {
    #[inline(always)]
    fn new<const D: usize>(h: &Matrix<D>, q: &Vector, mu: f64) -> Self {
        let entry = |i: usize, j: usize| mu * (q[i] * h[0][j] - q[0] * h[i][j]);
        let a = [[entry(1, 1), entry(1, 2)], [entry(2, 1), entry(2, 2)]];
        let g = [h[0][0] * q[1] - q[0] * h[1][0], h[0][0] * q[2] - q[0] * h[2][0]];
        Self {
            a,
            g,
            back: [a[1][1] * g[0] - a[0][1] * g[1], a[0][0] * g[1] - a[1][0] * g[0]],
            trace: a[0][0] + a[1][1],
            determinant: a[0][0] * a[1][1] - a[0][1] * a[1][0],
        }
    }

    /// The impulse after one Newton step from `slip`, which is updated too; after several steps if
    /// one isn't accurate enough.
    #[inline(always)]
    fn warm_start<const D: usize>(&self, h: &Matrix<D>, q: &Vector, mu: f64, slip: &mut f64) -> Option<Vector> {
        let lambda = *slip;
        let v = [self.back[0] + lambda * self.g[0], self.back[1] + lambda * self.g[1]];
        let determinant = (lambda + self.trace) * lambda + self.determinant;
        let slope = 2.0 * lambda + self.trace;
        let square_of_det = determinant * determinant;
        let half_miss = 0.5 * (square_of_det - (v[0] * v[0] + v[1] * v[1]));
        if half_miss.abs() <= WARM * square_of_det {
            // As `newton` and `impulse`, but multiplied by the denominator of the step, which saves
            // a division.
            let denominator = slope * determinant - (v[0] * self.g[0] + v[1] * self.g[1]);
            let v = [v[0] * denominator - half_miss * self.g[0], v[1] * denominator - half_miss * self.g[1]];
            let determinant = determinant * denominator - half_miss * slope;
            let size = -q[0] / (h[0][0] * determinant - mu * (h[0][1] * v[0] + h[0][2] * v[1]));
            let p = [size * determinant, -mu * size * v[0], -mu * size * v[1]];
            *slip = lambda - half_miss / denominator;
            if *slip > 0.0 && p[0] > 0.0 && p[0] < f64::INFINITY {
                return Some(p);
            }
        }
        self.several_steps(h, q, mu, lambda, slip)
    }

    #[inline(never)]
    fn several_steps<const D: usize>(
        &self,
        h: &Matrix<D>,
        q: &Vector,
        mu: f64,
        from: f64,
        slip: &mut f64,
    ) -> Option<Vector> {
        *slip = self.newton(from, NEARLY, STEPS).filter(|&lambda| lambda > 0.0)?;
        self.impulse(h, q, mu, *slip)
    }

    /// The root found by Newton's method from `start`, or 0 if it would be negative: the contact
    /// sticks.
    #[inline]
    fn newton(&self, start: f64, nearly: f64, steps: u32) -> Option<f64> {
        let mut lambda = start;
        for _ in 0..steps {
            let v = [self.back[0] + lambda * self.g[0], self.back[1] + lambda * self.g[1]];
            let square = v[0] * v[0] + v[1] * v[1];
            let half_slope = v[0] * self.g[0] + v[1] * self.g[1];
            let determinant = (lambda + self.trace) * lambda + self.determinant;
            let slope = 2.0 * lambda + self.trace;
            // F = det² − v²;  F' = 2 (det det' − v·v').
            let square_of_det = determinant * determinant;
            let miss = square_of_det - square;
            let step = 0.5 * miss / (slope * determinant - half_slope);
            // A NaN becomes 0 and ends the iteration.
            lambda = (lambda - step).max(0.0);
            if miss.abs() <= nearly * square_of_det {
                return Some(lambda);
            }
        }
        None
    }

    /// Roots without a last visit: the one found from the solution for A = ½ tr A times the
    /// identity; if that is missing or 0, the largest one, found from an upper bound.
    fn find_without_guess(&self, nearly: f64) -> [Option<f64>; 2] {
        let size = |x: &[f64; 2]| (x[0] * x[0] + x[1] * x[1]).sqrt();
        let g = size(&self.g);
        let near = self.newton((g - 0.5 * self.trace).max(0.0), nearly, STEPS);
        // ‖(A + λI) d‖ = ‖g‖ bounds λ.
        let above = || self.newton(g + size(&self.a[0]) + size(&self.a[1]), nearly, 4 * STEPS);
        [near, if near.is_none_or(|lambda| lambda == 0.0) { above() } else { None }]
    }

    /// The impulse for a root, if it is compressive. There ‖v‖ = |det|, so d = v/det; multiplying
    /// by det leaves one division.
    #[inline]
    fn impulse<const D: usize>(&self, h: &Matrix<D>, q: &Vector, mu: f64, lambda: f64) -> Option<Vector> {
        let v = [self.back[0] + lambda * self.g[0], self.back[1] + lambda * self.g[1]];
        let determinant = (lambda + self.trace) * lambda + self.determinant;
        let size = -q[0] / (h[0][0] * determinant - mu * (h[0][1] * v[0] + h[0][2] * v[1]));
        let p = [size * determinant, -mu * size * v[0], -mu * size * v[1]];
        (p[0] > 0.0 && p[0] < f64::INFINITY && p[1].is_finite() && p[2].is_finite()).then_some(p)
    }

    /// The slip direction for a root.
    #[inline]
    fn direction(&self, lambda: f64) -> [f64; 2] {
        let v = [self.back[0] + lambda * self.g[0], self.back[1] + lambda * self.g[1]];
        let inverse = 1.0 / (v[0] * v[0] + v[1] * v[1]).sqrt();
        [v[0] * inverse, v[1] * inverse]
    }
}

/// The impulse on the boundary of the cone against direction `d`, if it is compressive.
#[inline]
fn slide<const D: usize>(h: &Matrix<D>, q: &Vector, mu: f64, d: &[f64; 2]) -> Option<Vector> {
    let w = h[0][0] - mu * (h[0][1] * d[0] + h[0][2] * d[1]);
    let p_n = -q[0] / w;
    (w > 0.0 && p_n.is_finite()).then(|| [p_n, -mu * p_n * d[0], -mu * p_n * d[1]])
}

/// The valid state: the last visit's if it still is, else sticking, else sliding as found by
/// Newton's method from generic starting values. `slip` is λ of the last visit, 0 for a sticking
/// contact. `None` if no state is valid or Newton's method fails.
#[inline(always)]
pub(crate) fn valid_state<const D: usize>(
    h: &Matrix<D>,
    inverse: &Matrix<D>,
    q: &Vector,
    mu: f64,
    refine: bool,
    slip: &mut f64,
) -> Option<Vector> {
    if *slip > 0.0 {
        let equation = SlideEquation::new(h, q, mu);
        if let Some(p) = equation.warm_start(h, q, mu, slip) {
            return Some(p);
        }
    }
    if let Some(p) = stick(h, inverse, q, mu, refine) {
        *slip = 0.0;
        return Some(p);
    }
    start_sliding(h, q, mu, slip)
}

/// The sliding impulse of a contact that was sticking or open before.
#[inline(never)]
fn start_sliding<const D: usize>(h: &Matrix<D>, q: &Vector, mu: f64, slip: &mut f64) -> Option<Vector> {
    let equation = SlideEquation::new(h, q, mu);
    for lambda in equation.find_without_guess(NEARLY).into_iter().flatten() {
        if let Some(p) = equation.impulse(h, q, mu, lambda) {
            *slip = lambda;
            return Some(p);
        }
    }
    None
}

/// The smallest impulse of all valid states of a contact with `q_N < 0`, μ > 0.
#[cold]
pub(crate) fn smallest<const D: usize>(h: &Matrix<D>, inverse: &Matrix<D>, q: &Vector, mu: f64) -> Option<Vector> {
    let mut best: Option<(f64, Vector)> = None;
    let mut offer = |p: Vector| {
        let norm = dot(&p, &p);
        if norm.is_finite() && best.is_none_or(|(least, _)| norm < least) {
            best = Some((norm, p));
        }
    };
    let regular = inverse[0][0] != 0.0 || inverse[1][1] != 0.0;
    if let Some(p) = stick(h, inverse, q, mu, true).filter(|_| regular) {
        offer(p);
    }
    let equation = SlideEquation::new(h, q, mu);
    // ‖(A + λI) d‖ = ‖g‖ bounds λ. Scaling by the bound makes the coefficients of order 1.
    let size = |x: &[f64; 2]| x[0].hypot(x[1]);
    let unit = size(&equation.g) + size(&equation.a[0]).hypot(size(&equation.a[1]));
    let (trace, determinant) = (equation.trace / unit, equation.determinant / (unit * unit));
    let g = equation.g.map(|x| x / unit);
    let back = equation.back.map(|x| x / (unit * unit));
    let coefficients = [
        determinant * determinant - back[0] * back[0] - back[1] * back[1],
        2.0 * (trace * determinant - back[0] * g[0] - back[1] * g[1]),
        trace * trace + 2.0 * determinant - g[0] * g[0] - g[1] * g[1],
        2.0 * trace,
        1.0,
    ];
    let mut candidates = Roots::default();
    roots(&coefficients, 1.0, &mut candidates);
    candidates.push(0.0);
    for &root in candidates.as_slice() {
        // Both signs of the determinant, as the quartic is an equation of squares.
        for root in [equation.newton(root * unit, NEARLY, STEPS), Some(root * unit)].into_iter().flatten() {
            let d = equation.direction(root);
            for d in [d, [-d[0], -d[1]]] {
                if let Some(p) = slide(h, q, mu, &d).filter(|p| slides(h, q, p, &d)) {
                    offer(p);
                }
            }
        }
    }
    best.map(|(_, p)| p)
}

/// Whether the velocity lies along `d`.
fn slides<const D: usize>(h: &Matrix<D>, q: &Vector, p: &Vector, d: &[f64; 2]) -> bool {
    let u = [dot(&h[1], p) + q[1], dot(&h[2], p) + q[2]];
    let size = |i: usize| (0..3).map(|j| (h[i][j] * p[j]).abs()).fold(q[i].abs(), f64::max);
    let slack = MISS * size(1).max(size(2));
    u[0] * d[0] + u[1] * d[1] >= -slack && (u[0] * d[1] - u[1] * d[0]).abs() <= slack
}

/// Up to four roots and three stationary points.
#[derive(Default)]
struct Roots {
    values: [f64; 8],
    count: usize,
}

impl Roots {
    fn push(&mut self, x: f64) {
        if self.count < self.values.len() {
            self.values[self.count] = x;
            self.count += 1;
        }
    }

    fn as_slice(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

fn value(c: &[f64], x: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The roots of a polynomial (ascending coefficients, up to degree four) in [0, end], isolated
/// between the roots of its derivative. For the quartic the stationary points are included, as a
/// double root doesn't change the sign.
fn roots(c: &[f64], end: f64, found: &mut Roots) {
    let degree = c.len() - 1;
    if degree == 0 {
        return;
    }
    let mut derivative = [0.0; 4];
    for k in 1..=degree {
        derivative[k - 1] = k as f64 * c[k];
    }
    let mut turning = Roots::default();
    roots(&derivative[..degree], end, &mut turning);
    let mut low = 0.0;
    for &high in turning.as_slice().iter().chain([&end]) {
        if let Some(root) = bisect(c, low, high) {
            found.push(root);
        }
        low = high;
    }
    if degree == 4 {
        turning.as_slice().iter().for_each(|&x| found.push(x));
    }
}

/// The root of a polynomial that is monotone in [low, high], by bisection to the last digit.
fn bisect(c: &[f64], mut low: f64, mut high: f64) -> Option<f64> {
    let (at_low, at_high) = (value(c, low), value(c, high));
    if at_low == 0.0 {
        return Some(low);
    }
    if !(at_low * at_high.signum() < 0.0) {
        return None;
    }
    loop {
        let middle = 0.5 * (low + high);
        // Two neighbouring numbers, or a NaN.
        if !(low < middle && middle < high) {
            return Some(middle);
        }
        if value(c, middle) * at_low.signum() > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solve(h: Matrix<3>, q: Vector, mu: f64) -> [Option<Vector>; 2] {
        let inverse = inverse(&h, 1e-12).unwrap();
        [valid_state(&h, &inverse, &q, mu, true, &mut 0.0), smallest(&h, &inverse, &q, mu)]
    }

    fn assert_obeys(h: &Matrix<3>, q: &Vector, mu: f64, p: &Vector, slack: f64) {
        let u = [0, 1, 2].map(|i| dot(&h[i], p) + q[i]);
        let (speed, impulse) = (dot(q, q).sqrt(), dot(p, p).sqrt());
        assert!(u[0].abs() <= slack * speed && p[0] > 0.0, "u {u:?} p {p:?}");
        let (u_t, p_t) = (u[1].hypot(u[2]), p[1].hypot(p[2]));
        assert!(p_t <= mu * p[0] + slack * impulse, "u {u:?} p {p:?}");
        if u_t > slack * speed {
            let along = (p[1] * u[1] + p[2] * u[2]) / u_t;
            assert!((along + mu * p[0]).abs() <= slack * impulse, "u {u:?} p {p:?}");
        }
    }

    #[test]
    fn both_ways_agree_at_every_angle() {
        let h = [[2.0, 0.3, -0.2], [0.3, 1.5, 0.4], [-0.2, 0.4, 1.0]];
        for k in 0..48 {
            let angle = f64::from(k) * 0.1309;
            for speed in [0.1, 0.6, 3.0, 1e4] {
                let q = [-1.0, speed * angle.cos(), speed * angle.sin()];
                let [fast, sure] = solve(h, q, 0.4);
                let (fast, sure) = (fast.unwrap(), sure.unwrap());
                assert_obeys(&h, &q, 0.4, &fast, 1e-12);
                for i in 0..3 {
                    assert!((fast[i] - sure[i]).abs() < 1e-10 * fast[0], "{fast:?} {sure:?}");
                }
            }
        }
    }

    #[test]
    fn multiples_of_the_identity_are_solved() {
        let c = 3.7;
        let h = [[c, 0.0, 0.0], [0.0, c, 0.0], [0.0, 0.0, c]];
        let q = [-1.0, 0.3, -0.4];
        for p in solve(h, q, 0.2).into_iter().flatten() {
            // Friction reduces the sliding speed by μ|q_N|.
            assert!((p[0] - 1.0 / c).abs() < 1e-15);
            assert!((p[1] + 0.2 / c * 0.6).abs() < 1e-15 && (p[2] - 0.2 / c * 0.8).abs() < 1e-15, "{p:?}");
        }
        assert!(solve(h, q, 0.2).iter().all(Option::is_some));
    }

    #[test]
    fn stationary_points_and_roots_of_a_quartic_are_found() {
        // (x − 0.2)(x − 0.5)²(x − 0.9)
        let mut c = vec![1.0];
        for root in [0.2, 0.5, 0.5, 0.9] {
            let mut next = vec![0.0; c.len() + 1];
            for (k, x) in c.iter().enumerate() {
                next[k + 1] += x;
                next[k] -= root * x;
            }
            c = next;
        }
        let mut found = Roots::default();
        roots(&c, 1.0, &mut found);
        for root in [0.2, 0.5, 0.9] {
            assert!(found.as_slice().iter().any(|x| (x - root).abs() < 1e-7), "{:?}", found.as_slice());
        }
    }
}
