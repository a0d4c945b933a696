//! The law of one contact as a smooth equation, with a parameter τ that is driven to zero.
//!
//! In the variables `x = (√μ p_N, p_T/√μ)` and `z = (û_N/√μ, √μ u_T)` the law is
//! `x, z ∈ L, xᵀz = 0` with the standard second-order cone L, and `xᵀz = pᵀû`. With
//! `[λ]_τ = (λ + √(λ² + 4τ²))/2` in place of the positive part of the two spectral values
//! `w_N ± ‖w_T‖` of `w = x − z`,
//!
//! ```text
//! F_τ = x − Π_τ(x − z) = 0      ⟺      x, z ∈ int L,  x ∘ z = τ² e
//! ```
//!
//! (Fukushima, Luo, Tseng 2002, doi 10.1137/S1052623400380365): the points of the central path. The
//! norm ‖u_T‖ in û is smoothed too, as √(‖u_T‖² + τ²) − τ. Without friction only the normal
//! equation remains, and p_T = 0.

use teeter_contact::{Block, Vector};

/// `F_τ` and its derivatives with respect to p and u.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slope<const D: usize> {
    pub(crate) value: Vector<D>,
    pub(crate) of_p: Block<D>,
    pub(crate) of_u: Block<D>,
}

/// The spectral decomposition of `w = x − z`, with the quantities that both evaluations need.
struct Spectrum<const D: usize> {
    /// √μ.
    root: f64,
    /// √(‖u_T‖² + τ²).
    speed: f64,
    direction: Vector<D>,
    length: f64,
    /// The two spectral values and √(λ² + 4τ²) of each: upper, lower.
    lambda: [f64; 2],
    width: [f64; 2],
    x: Vector<D>,
}

impl<const D: usize> Spectrum<D> {
    #[inline]
    fn new(p: &Vector<D>, u: &Vector<D>, mu: f64, tau: f64) -> Self {
        let root = mu.sqrt();
        let mut u_t = *u;
        u_t[0] = 0.0;
        let speed = (u_t.norm_squared() + tau * tau).sqrt();
        let mut x = p / root;
        x[0] = root * p[0];
        let z_n = (u[0] + mu * (speed - tau)) / root;
        let mut w_t = x - u_t * root;
        w_t[0] = 0.0;
        let w_n = x[0] - z_n;
        let length = w_t.norm();
        let direction =
            if length > 0.0 { w_t / length } else { Vector::from_fn(|i, _| if i == 1 { 1.0 } else { 0.0 }) };
        let lambda = [w_n + length, w_n - length];
        let width = lambda.map(|l| (l * l + 4.0 * tau * tau).sqrt());
        Self { root, speed, direction, length, lambda, width, x }
    }

    /// `[λ]_τ` of both, without cancellation for λ < 0.
    #[inline]
    fn positive(&self, tau: f64) -> [f64; 2] {
        [0, 1].map(|k| {
            let (l, w) = (self.lambda[k], self.width[k]);
            if l >= 0.0 { 0.5 * (l + w) } else { 2.0 * tau * tau / (w - l) }
        })
    }

    #[inline]
    fn value(&self, tau: f64) -> Vector<D> {
        let [upper, lower] = self.positive(tau);
        let mut f = self.x - self.direction * (0.5 * (upper - lower));
        f[0] = self.x[0] - 0.5 * (upper + lower);
        f
    }
}

/// `F_τ`; with `tau` > 0.
#[inline]
pub(crate) fn value<const D: usize>(p: &Vector<D>, u: &Vector<D>, mu: f64, tau: f64) -> Vector<D> {
    if mu == 0.0 { frictionless(p, u, tau).value } else { Spectrum::new(p, u, mu, tau).value(tau) }
}

/// `F_τ` with its derivatives; with `tau` > 0.
#[inline]
pub(crate) fn slope<const D: usize>(p: &Vector<D>, u: &Vector<D>, mu: f64, tau: f64) -> Slope<D> {
    if mu == 0.0 {
        return frictionless(p, u, tau);
    }
    let s = Spectrum::new(p, u, mu, tau);
    let [upper, lower] = s.positive(tau);
    let rate = [0, 1].map(|k| 0.5 * (1.0 + s.lambda[k] / s.width[k]));
    let (mean, half) = (0.5 * (rate[0] + rate[1]), 0.5 * (rate[0] - rate[1]));
    // The divided difference; for equal spectral values it is the derivative.
    let across = if s.length > 1e-9 * s.width[0] { (upper - lower) / (2.0 * s.length) } else { mean };
    let d = &s.direction;
    let mut of_w = Block::<D>::zeros();
    of_w[(0, 0)] = mean;
    for i in 1..D {
        of_w[(0, i)] = half * d[i];
        of_w[(i, 0)] = half * d[i];
        for j in 1..D {
            of_w[(i, j)] = (mean - across) * d[i] * d[j];
        }
        of_w[(i, i)] += across;
    }
    let mut of_p = Block::<D>::identity() - of_w;
    let mut z_of_u = Block::<D>::zeros();
    z_of_u[(0, 0)] = s.root.recip();
    for i in 0..D {
        of_p[(i, 0)] *= s.root;
        for j in 1..D {
            of_p[(i, j)] /= s.root;
        }
    }
    for j in 1..D {
        z_of_u[(j, j)] = s.root;
        z_of_u[(0, j)] = s.root * u[j] / s.speed;
    }
    Slope { value: s.value(tau), of_p, of_u: of_w * z_of_u }
}

fn frictionless<const D: usize>(p: &Vector<D>, u: &Vector<D>, tau: f64) -> Slope<D> {
    let w = p[0] - u[0];
    let width = (w * w + 4.0 * tau * tau).sqrt();
    let rate = 0.5 * (1.0 + w / width);
    let mut slope = Slope { value: *p, of_p: Block::identity(), of_u: Block::zeros() };
    slope.value[0] = p[0] - if w >= 0.0 { 0.5 * (w + width) } else { 2.0 * tau * tau / (width - w) };
    slope.of_p[(0, 0)] = 1.0 - rate;
    slope.of_u[(0, 0)] = rate;
    slope
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn points() -> Vec<(Vector3<f64>, Vector3<f64>, f64)> {
        let mut points = Vec::new();
        for mu in [0.0, 0.2, 1.0, 7.0] {
            for k in 0..40 {
                let t = f64::from(k);
                let p = Vector3::new((1.3 * t).sin(), (2.1 * t).cos(), (0.7 * t).sin());
                points.push((p, Vector3::new((0.9 * t).cos(), (1.7 * t).sin(), (3.1 * t).cos()), mu));
            }
        }
        points
    }

    #[test]
    fn derivatives_match_differences() {
        for (p, u, mu) in points() {
            let (tau, e) = (0.3, 1e-6);
            let slope = slope(&p, &u, mu, tau);
            assert!((slope.value - value(&p, &u, mu, tau)).norm() < 1e-15);
            for k in 0..3 {
                let mut d = Vector3::zeros();
                d[k] = e;
                let of_p = (value(&(p + d), &u, mu, tau) - value(&(p - d), &u, mu, tau)) / (2.0 * e);
                let of_u = (value(&p, &(u + d), mu, tau) - value(&p, &(u - d), mu, tau)) / (2.0 * e);
                assert!((slope.of_p.column(k) - of_p).norm() < 1e-7);
                assert!((slope.of_u.column(k) - of_u).norm() < 1e-7);
            }
        }
    }

    #[test]
    fn zeros_lie_on_the_central_path() {
        // x ∘ z = τ² e: for p on the axis and u on the axis, p_N û_N = τ².
        let f = value(&Vector3::new(2.0, 0.0, 0.0), &Vector3::new(0.02, 0.0, 0.0), 0.5, 0.2);
        assert!(f.norm() < 1e-15);
        let f = value(&Vector3::new(2.0, 0.0, 0.0), &Vector3::new(0.02, 0.0, 0.0), 0.0, 0.2);
        assert!(f.norm() < 1e-15);
    }

    #[test]
    fn a_vanishing_parameter_gives_the_law() {
        // Sticks, slides, open.
        for (p, u) in [
            (Vector3::new(1.0, 0.1, 0.2), Vector3::zeros()),
            (Vector3::new(1.0, -0.3, -0.4), Vector3::new(0.0, 3.0, 4.0)),
            (Vector3::zeros(), Vector3::new(1.0, 0.3, 0.0)),
        ] {
            assert!(value(&p, &u, 0.5, 1e-12).norm() < 1e-10);
        }
        assert!(value(&Vector3::new(1.0, 0.3, 0.4), &Vector3::new(0.0, 3.0, 4.0), 0.5, 1e-12).norm() > 0.1);
    }
}
