//! A plane pendulum as a subsystem of one's own: a rigid rod that turns about a fixed pivot and can
//! be hit on both faces.
//!
//! One coordinate θ, counter-clockwise from hanging straight down; I the moment of inertia about
//! the pivot, l the distance of the mass centre from it:
//!
//! ```text
//! I θ̈ = −m g l sin θ,      T = ½ I θ̇²,      V = m g (y_pivot − l cos θ)
//! ```
//!
//! # What the energy account says of it
//!
//! The θ step takes the force at q⁰ + hθv⁰ and corrects it by the stiffness K. Its energy identity
//! is exact where −∂V/∂q is linear with that K: for blocks and beams. Here K is the constant m g l,
//! the stiffness of hanging, because a factor is kept as long as the step size is; so the identity
//! is exact without gravity only. Otherwise, with θ = ½ and F = −m g l sin θ, a step leaves
//!
//! ```text
//! residual = −(K + F'(θ)) h² a Δθ/4 − F''(θ) Δθ³/24 + …,       a = Δv/h
//! ```
//!
//! which is O(h³) a step. Both terms are, to this order, a function of θ times dθ (v² is one, by
//! the energy), so that they add up to O(h²) and come back after each full swing instead of
//! drifting. Nothing is dissipated: it is the price of a force that isn't linear, and it goes with
//! the square of h and with the fourth power of the swing.

use nalgebra::Vector2;
use teeter_detect::{Frame, Kinematics, SurfacePoint};
use teeter_integrator::{Bodies, Compliance, Dynamics, Energy, FactorError, Rows, Size, Traits, Weights};

/// A homogeneous rod that hangs from its upper end.
#[derive(Clone, Debug)]
pub struct Pendulum {
    pub pivot: Vector2<f64>,
    /// m, from the pivot to the tip.
    pub length: f64,
    /// Half of the rod's thickness, m. A point is on the side of the nearer face, so this is how
    /// deep it may go.
    pub half_thickness: f64,
    /// kg.
    pub mass: f64,
    /// Downwards, m/s².
    pub gravity: f64,
}

impl Pendulum {
    /// I about the pivot, kg·m²: that of a thin rod.
    pub fn inertia(&self) -> f64 {
        self.mass * self.length * self.length / 3.0
    }

    /// K = m g l, N·m.
    pub fn stiffness(&self) -> f64 {
        0.5 * self.mass * self.gravity * self.length
    }

    /// A vector of the rod's frame (pivot at the origin, tip at (0, −length)) in the world's.
    fn rotate(q: &[f64], local: &Vector2<f64>) -> Vector2<f64> {
        let (sin, cos) = q[0].sin_cos();
        Vector2::new(cos * local.x - sin * local.y, sin * local.x + cos * local.y)
    }
}

impl Dynamics<2> for Pendulum {
    fn size(&self) -> Size {
        Size { q: 1, v: 1, bodies: 1, row: 1 }
    }

    fn traits(&self) -> Traits {
        Traits::free().energy_scale(self.stiffness())
    }

    fn internal_force(&self, q: &[f64], _v: &[f64], f: &mut [f64]) {
        f[0] -= self.stiffness() * q[0].sin();
    }

    fn apply(&self, w: Weights, _q: &[f64], x: &[f64], y: &mut [f64]) {
        y[0] += (w.mass * self.inertia() + w.stiffness * self.stiffness()) * x[0];
    }

    fn energy(&self, q: &[f64], v: &[f64]) -> Energy {
        let gravity = self.mass * self.gravity * self.pivot.y - self.stiffness() * q[0].cos();
        Energy { kinetic: 0.5 * self.inertia() * v[0] * v[0], elastic: 0.0, gravity }
    }

    fn factor(&self, w: Weights, q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        let (inertia, stiffness) = (self.inertia(), self.stiffness());
        let mut compliance = PendulumCompliance { inertia, stiffness, weights: w, inverse: 0.0 };
        compliance.refactor(w, q)?;
        Ok(Box::new(compliance))
    }
}

impl Bodies<2> for Pendulum {
    fn place(&self, _body: u32, q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        for (x, local) in out.iter_mut().zip(local) {
            *x = self.pivot + Self::rotate(q, local);
        }
    }

    fn has_surface(&self, _body: u32) -> bool {
        true
    }

    /// The foot of the perpendicular from `at` on the nearer face; none beyond the pivot or the
    /// tip.
    fn surface(&self, _body: u32, q: &[f64], _: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        let local = Self::rotate(&[-q[0]], &(at - self.pivot));
        if !(-self.length..=0.0).contains(&local.y) {
            return None;
        }
        let side = local.x.signum();
        let material = Vector2::new(side * self.half_thickness, local.y);
        let normal = Self::rotate(q, &Vector2::new(side, 0.0));
        Some(SurfacePoint { place: self.pivot + Self::rotate(q, &material), normal, material })
    }

    /// The velocity of the point at r from the pivot is θ̇ k × r.
    fn rows(&self, _: u32, q: &[f64], point: &Vector2<f64>, frame: &Frame<2>, out: &mut Rows<'_, 2>) -> usize {
        let r = Self::rotate(q, point);
        out.columns[0] = 0;
        out.values[0] = frame * Vector2::new(-r.y, r.x);
        1
    }
}

/// The 1 × 1 inverse. How contacts feel each other through it, the trait's default finds out by
/// solving.
struct PendulumCompliance {
    inertia: f64,
    stiffness: f64,
    weights: Weights,
    inverse: f64,
}

impl Compliance<2> for PendulumCompliance {
    fn weights(&self) -> Weights {
        self.weights
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        let matrix = w.mass * self.inertia + w.stiffness * self.stiffness;
        if matrix.is_nan() || matrix <= 0.0 {
            return Err(FactorError { weights: w, reason: format!("a pendulum's only entry would be {matrix}") });
        }
        (self.weights, self.inverse) = (w, matrix.recip());
        Ok(())
    }

    fn solve(&mut self, f: &mut [f64]) {
        f[0] *= self.inverse;
    }
}
