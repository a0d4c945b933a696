//! The law of one contact as equations, linearised at an iterate.
//!
//! With `a = p_N − ρ_N u_N` and `y = p_T − ρ_T u_T` (Alart and Curnier 1991) a contact is
//!
//! ```text
//! open     a ≤ 0:             p = 0
//! stick    ‖y‖ ≤ μ a:         u = 0
//! slide    otherwise:         u_N = 0,  p_T = μ p_N y/‖y‖
//! ```

use nalgebra::SMatrix;
use teeter_contact::{Block, Vector};

/// The equations of one contact in a Newton step: `of_p δp + of_u δu = right`, or `p + δp = 0` if
/// it is open.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<const D: usize> {
    pub(crate) open: bool,
    pub(crate) of_p: Block<D>,
    pub(crate) of_u: Block<D>,
    pub(crate) right: Vector<D>,
}

impl<const D: usize> Default for Row<D> {
    fn default() -> Self {
        Self { open: true, of_p: Block::zeros(), of_u: Block::zeros(), right: Vector::zeros() }
    }
}

/// Linearises the law of a contact with impulse `p`, velocity `u` and Delassus block `h`, in the
/// problem's scale.
#[inline]
pub(crate) fn linearise<const D: usize>(p: &Vector<D>, u: &Vector<D>, mu: f64, h: Block<D>) -> Row<D> {
    let h_nn = h[(0, 0)];
    let mean_tt = (h.trace() - h_nn) / (D - 1).max(1) as f64;
    // A tangential compliance below rounding is replaced by the normal one.
    let rho_t = if mean_tt > 0.0 { mean_tt.recip() } else { h_nn.recip() };
    let pressing = p[0] - u[0] / h_nn;
    if !(pressing > 0.0) {
        return Row::default();
    }
    let mut y = p - u * rho_t;
    y[0] = 0.0;
    let (length, bound) = (y.norm(), mu * pressing);
    if mu > 0.0 && length <= bound {
        return Row { open: false, of_p: Block::zeros(), of_u: Block::identity(), right: -u };
    }
    let (direction, kappa) = if length > 0.0 { (y / length, bound / length) } else { (y, 0.0) };
    let mut across = SMatrix::<f64, D, D>::identity() - direction * direction.transpose();
    across[(0, 0)] = 0.0;
    let mut row = Row { open: false, of_p: -across * kappa, of_u: across * (kappa * rho_t), right: -u };
    row.of_u[(0, 0)] = 1.0;
    for k in 1..D {
        row.of_p[(k, k)] += 1.0;
        row.of_p[(k, 0)] -= mu * direction[k];
        row.right[k] = mu * p[0] * direction[k] - p[k];
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn each_state_has_its_equations() {
        let h = Matrix3::new(2.0, 0.1, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0, 1.0);
        assert!(linearise(&Vector3::zeros(), &Vector3::new(0.1, 0.3, 0.0), 0.5, h).open);
        let row = linearise(&Vector3::new(1.0, 0.1, 0.0), &Vector3::zeros(), 0.5, h);
        assert!(!row.open && row.of_p == Matrix3::zeros() && row.of_u == Matrix3::identity());
        // At a sliding solution the right side is zero.
        let slides = linearise(&Vector3::new(1.0, -0.3, -0.4), &Vector3::new(0.0, 3.0, 4.0), 0.5, h);
        assert!(!slides.open && slides.right.norm() < 1e-15);
        // Without friction the tangential impulse is driven to zero.
        let smooth = linearise(&Vector3::new(1.0, 0.2, 0.0), &Vector3::zeros(), 0.0, h);
        assert!((smooth.right - Vector3::new(0.0, -0.2, 0.0)).norm() < 1e-15 && smooth.of_p[(1, 1)] == 1.0);
    }

    #[test]
    fn the_linearised_slide_matches_its_equations() {
        let h = Matrix3::new(2.0, 0.1, 0.0, 0.1, 1.0, 0.2, 0.0, 0.2, 1.0);
        let (p, u, mu) = (Vector3::new(1.0, -0.3, 0.5), Vector3::new(0.1, 2.0, -1.0), 0.4);
        let rho_t = 1.0;
        // p_T − μ p_N y/‖y‖ as linearised: scaled by a, with R = μ(p_N − ρ_N u_N) in place of μ
        // p_N.
        let equations = |p: Vector3<f64>, u: Vector3<f64>| {
            let y = (p - u * rho_t).yz();
            let bound = mu * (p[0] - u[0] / h[(0, 0)]);
            let t = p.yz() - y.normalize() * bound;
            Vector3::new(u[0], t[0], t[1])
        };
        let row = linearise(&p, &u, mu, h);
        let y = (p - u * rho_t).yz().normalize();
        for k in 0..3 {
            let e = 1e-6;
            let mut d = Vector3::zeros();
            d[k] = e;
            // The part of u_N in the friction bound is eliminated with the first equation, which
            // adds μ ρ_N u_N y to the rows of p_T.
            let share = |u: Vector3<f64>| Vector3::new(0.0, y[0], y[1]) * (mu / h[(0, 0)] * u[0]);
            let of_p = (equations(p + d, u) - equations(p - d, u)) / (2.0 * e);
            let of_u = (equations(p, u + d) - equations(p, u - d) - share(u + d) + share(u - d)) / (2.0 * e);
            assert!((row.of_p.column(k) - of_p).norm() < 1e-8, "p {k}: {} {of_p}", row.of_p.column(k));
            assert!((row.of_u.column(k) - of_u).norm() < 1e-8, "u {k}: {} {of_u}", row.of_u.column(k));
        }
    }
}
