//! The toy: a sleeve that loosely encloses a pole, and a bird on a spring from it. F. Pfeiffer's model, as in C. Glocker and C. Studer,
//! Multibody System Dynamics 13 (2005) 447–463, doi 10.1007/s11044-005-2519-6.
//!
//! Coordinates q = (y, φ_M, φ_S): height of the sleeve, angles of sleeve and bird, small. What touches the pole are the beak and both
//! edges of the sleeve; to first order a gap and a way along the pole are linear in q,
//!
//! ```text
//! g_k = g_k⁰ + w_Nk · q,      s_k = w_Tk · q
//! ```
//!
//! so each of the three is a body here, a single point at (s_k, g_k), over flat ground: the pole.

use nalgebra::{Matrix3, Vector2, Vector3};
use teeter_detect::Frame;
use teeter_integrator::{Bodies, Compliance, Dynamics, Energy, FactorError, Rows, Size, Traits, Weights};

/// kg.
const SLEEVE: f64 = 0.0003;
const BIRD: f64 = 0.0045;
/// About their mass centres, kg·m².
const INERTIAS: [f64; 2] = [5.0e-9, 7.0e-7];
/// c_φ, N·m.
const SPRING: f64 = 0.0056;
const GRAVITY: f64 = 9.81;
/// Of the pole and the sleeve, m.
const RADII: [f64; 2] = [0.0025, 0.0031];
/// Half of the sleeve's height, h_M, and that of the beak over the bird's mass centre, h_S, m.
const HEIGHTS: [f64; 2] = [0.0058, 0.02];
/// From the pole to the spring, l_M, from there to the bird's mass centre, l_G, and from there to the tip of the beak, l_S, m.
const ARMS: [f64; 3] = [0.010, 0.015, 0.0201];

/// The bodies, in their order.
pub const BEAK: u32 = 0;
pub const LOWER_EDGE: u32 = 1;
pub const UPPER_EDGE: u32 = 2;

/// The toy. It has no numbers of its own.
#[derive(Clone, Copy, Debug)]
pub struct Toy;

/// What touches the pole.
struct Tip {
    /// Its gap where all coordinates are 0, m.
    gap: f64,
    /// w_N and w_T.
    rows: [Vector3<f64>; 2],
}

fn tip(body: u32) -> Tip {
    let ([pole, sleeve], [edge, beak], [arm, neck, bill]) = (RADII, HEIGHTS, ARMS);
    match body {
        BEAK => Tip {
            gap: arm + neck - bill - pole,
            rows: [Vector3::new(0.0, 0.0, -beak), Vector3::new(1.0, arm, neck - bill)],
        },
        _ => Tip {
            gap: sleeve - pole,
            rows: [
                Vector3::new(0.0, if body == LOWER_EDGE { edge } else { -edge }, 0.0),
                Vector3::new(1.0, sleeve, 0.0),
            ],
        },
    }
}

/// M.
fn mass() -> Matrix3<f64> {
    let [arm, neck, _] = ARMS;
    let levers = Vector3::new(1.0, arm, neck);
    BIRD * levers * levers.transpose() + Matrix3::from_diagonal(&Vector3::new(SLEEVE, INERTIAS[0], INERTIAS[1]))
}

/// K.
fn stiffness() -> Matrix3<f64> {
    let turn = Vector3::new(0.0, 1.0, -1.0);
    SPRING * turn * turn.transpose()
}

/// Minus the force of weight, N and N·m.
fn weight() -> Vector3<f64> {
    let [arm, neck, _] = ARMS;
    GRAVITY * Vector3::new(SLEEVE + BIRD, BIRD * arm, BIRD * neck)
}

impl Dynamics<2> for Toy {
    fn size(&self) -> Size {
        Size { q: 3, v: 3, bodies: 3, row: 3 }
    }

    /// Its energy is some times what the spring holds at a tenth of a radian.
    fn traits(&self) -> Traits {
        Traits::free().energy_scale(SPRING * 0.01)
    }

    fn internal_force(&self, q: &[f64], _v: &[f64], f: &mut [f64]) {
        let force = -stiffness() * Vector3::from_column_slice(q) - weight();
        f.iter_mut().zip(&force).for_each(|(f, own)| *f += own);
    }

    fn apply(&self, w: Weights, _q: &[f64], x: &[f64], y: &mut [f64]) {
        let product = (w.mass * mass() + w.stiffness * stiffness()) * Vector3::from_column_slice(x);
        y.iter_mut().zip(&product).for_each(|(y, own)| *y += own);
    }

    fn energy(&self, q: &[f64], v: &[f64]) -> Energy {
        let (q, v) = (Vector3::from_column_slice(q), Vector3::from_column_slice(v));
        Energy {
            kinetic: 0.5 * v.dot(&(mass() * v)),
            elastic: 0.5 * q.dot(&(stiffness() * q)),
            gravity: weight().dot(&q),
        }
    }

    fn factor(&self, w: Weights, q: &[f64]) -> Result<Box<dyn Compliance<2>>, FactorError> {
        let mut inverse = Inverse { weights: w, matrix: Matrix3::zeros() };
        inverse.refactor(w, q)?;
        Ok(Box::new(inverse))
    }
}

impl Bodies<2> for Toy {
    fn place(&self, body: u32, q: &[f64], local: &[Vector2<f64>], out: &mut [Vector2<f64>]) {
        let Tip { gap, rows: [normal, along] } = tip(body);
        let q = Vector3::from_column_slice(q);
        for (x, local) in out.iter_mut().zip(local) {
            *x = local + Vector2::new(along.dot(&q), gap + normal.dot(&q));
        }
    }

    fn rows(&self, body: u32, _: &[f64], _: &Vector2<f64>, frame: &Frame<2>, out: &mut Rows<'_, 2>) -> usize {
        let [normal, along] = tip(body).rows;
        for k in 0..3 {
            out.columns[k] = k;
            out.values[k] = frame * Vector2::new(along[k], normal[k]);
        }
        3
    }

    /// The rows don't change.
    fn bias(&self, _: u32, _: &[f64], _: &[f64], _: &Vector2<f64>, _: &Frame<2>) -> Option<Vector2<f64>> {
        Some(Vector2::zeros())
    }
}

struct Inverse {
    weights: Weights,
    matrix: Matrix3<f64>,
}

impl Compliance<2> for Inverse {
    fn weights(&self) -> Weights {
        self.weights
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        let inverse = (w.mass * mass() + w.stiffness * stiffness()).cholesky().map(|factor| factor.inverse());
        let reason = || "it is not positive definite".to_owned();
        (self.weights, self.matrix) = (w, inverse.ok_or_else(|| FactorError { weights: w, reason: reason() })?);
        Ok(())
    }

    fn solve(&mut self, f: &mut [f64]) {
        let solved = self.matrix * Vector3::from_column_slice(f);
        f.copy_from_slice(solved.as_slice());
    }
}
