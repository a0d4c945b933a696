//! A body in the fewest lines: a platform on a spring, m q̈ + k q = −m g, with q its height above
//! where the spring is slack.

use nalgebra::Vector2;
use teeter_detect::{Frame, Kinematics, SurfacePoint};
use teeter_integrator::{Bodies, Compliance, ConstantMatrices, Dynamics, Energy, FactorError, Rows, Size, Weights};

/// With a flat top of any width.
#[derive(Clone, Debug)]
pub struct Platform {
    pub matrices: ConstantMatrices<1>,
    /// m g, N.
    pub weight: f64,
}

impl Dynamics<2> for Platform {
    fn size(&self) -> Size {
        Size { q: 1, v: 1, bodies: 1, row: 1 }
    }

    fn internal_force(&self, q: &[f64], _v: &[f64], f: &mut [f64]) {
        self.matrices.apply(Weights { stiffness: -1.0, ..Weights::default() }, q, f);
        f[0] -= self.weight;
    }

    fn apply(&self, w: Weights, _q: &[f64], x: &[f64], y: &mut [f64]) {
        self.matrices.apply(w, x, y);
    }

    fn energy(&self, q: &[f64], v: &[f64]) -> Energy {
        let [kinetic, elastic] = [self.matrices.kinetic_energy(v), self.matrices.elastic_energy(q)];
        Energy { kinetic, elastic, gravity: self.weight * q[0] }
    }

    fn factor(&self, w: Weights, _q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        self.matrices.factor(w)
    }
}

impl Bodies<2> for Platform {
    fn place(&self, _body: u32, q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        out.iter_mut().zip(local).for_each(|(x, local)| *x = local + Vector2::new(0.0, q[0]));
    }

    fn has_surface(&self, _body: u32) -> bool {
        true
    }

    fn surface(&self, _: u32, q: &[f64], _: Kinematics, at: &Vector2<f64>) -> Option<SurfacePoint<2>> {
        let material = Vector2::new(at.x, 0.0);
        Some(SurfacePoint { place: Vector2::new(at.x, q[0]), normal: Vector2::y(), material })
    }

    fn rows(&self, _: u32, _: &[f64], _: &Vector2<f64>, frame: &Frame<2>, out: &mut Rows<'_, 2>) -> usize {
        (out.columns[0], out.values[0]) = (0, frame * Vector2::y());
        1
    }
}
