//! The plane law of a single contact, exactly: four states, each a closed form.

use nalgebra::{Matrix2, Vector2};

/// The impulse of one contact with Delassus block `h`, constant vector `q` and friction `mu`; of several that obey the
/// law (H_NN ≤ μ|H_NT| can have them) the smallest. `None` where none of the four states fits.
///
/// - open: `p = 0`, needs `q_N ≥ 0`;
/// - stick: `H p = −q`, needs `|p_T| ≤ μ p_N`;
/// - slide to the right (σ = 1) or left (σ = −1): `p_T = −σμ p_N`, `u_N = 0`, needs `σ u_T ≥ 0`.
#[inline]
pub(crate) fn solve(h: &Matrix2<f64>, q: &Vector2<f64>, mu: f64) -> Option<Vector2<f64>> {
    if q[0] >= 0.0 {
        return Some(Vector2::zeros());
    }
    let mut best: Option<Vector2<f64>> = None;
    let mut offer = |p: Vector2<f64>| {
        if best.is_none_or(|b| p.norm_squared() < b.norm_squared()) {
            best = Some(p);
        }
    };
    let determinant = h[(0, 0)] * h[(1, 1)] - h[(0, 1)] * h[(1, 0)];
    if determinant != 0.0 && mu > 0.0 {
        let p = Vector2::new(
            (h[(0, 1)] * q[1] - h[(1, 1)] * q[0]) / determinant,
            (h[(1, 0)] * q[0] - h[(0, 0)] * q[1]) / determinant,
        );
        if p[1].abs() <= mu * p[0] {
            offer(p);
        }
    }
    for sigma in [1.0, -1.0] {
        let compliance = h[(0, 0)] - sigma * mu * h[(0, 1)];
        if compliance > 0.0 {
            let p_n = -q[0] / compliance;
            let p = Vector2::new(p_n, -sigma * mu * p_n);
            let u_t = h[(1, 0)] * p[0] + h[(1, 1)] * p[1] + q[1];
            if sigma * u_t >= 0.0 || mu == 0.0 {
                offer(p);
            }
        }
    }
    best.filter(|p| p.iter().all(|c| c.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_friction_the_impulse_is_normal() {
        let h = Matrix2::new(2.0, 0.5, 0.5, 1.0);
        assert_eq!(solve(&h, &Vector2::new(-1.0, 3.0), 0.0), Some(Vector2::new(0.5, 0.0)));
    }

    #[test]
    fn of_several_solutions_the_smallest_is_taken() {
        // H_NN < μ H_NT: with q_T > 0 the state "slide right" is not available, "slide left" and "stick" compete.
        let h = Matrix2::new(1.0, 2.0, 2.0, 5.0);
        let q = Vector2::new(-1.0, -3.0);
        let p = solve(&h, &q, 1.0).unwrap();
        let u = h * p + q;
        assert!(u[0].abs() < 1e-15 && p[1].abs() <= p[0] && u[1] * p[1] <= 1e-15);
    }
}
