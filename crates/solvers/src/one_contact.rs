//! Exact solution of the plane law of a single contact: four states, each in closed form.

use nalgebra::{Matrix2, Vector2};

/// Rounding of a closed form, relative to its summed terms.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A friction impulse above this fraction of its limit counts as sliding, as impulses have rounding errors.
pub(crate) const AT_LIMIT: f64 = 1.0 - 1e-9;

/// The impulse of one contact with Delassus block `h`, constant vector `q` and friction `mu`; the
/// smallest one if several satisfy the law (possible for H_NN ≤ μ|H_NT|). `None` if no state is
/// valid.
///
/// - open: `p = 0`, needs `q_N ≥ 0`;
/// - stick: `H p = −q`, needs `|p_T| ≤ μ p_N`;
/// - slide to the right (σ = 1) or left (σ = −1): `p_T = −σμ p_N`, `u_N = 0`, needs `σ u_T ≥ 0`.
///
/// On the boundary between sticking and sliding both inequalities hold only up to rounding, so both
/// have this tolerance.
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
    let determinant = h.determinant();
    if determinant != 0.0 && mu > 0.0 {
        let p = sticking(h, q) / determinant;
        let (h, q) = (h.abs(), q.abs());
        let size = h[(1, 0)] * q[0] + h[(0, 0)] * q[1] + mu * (h[(0, 1)] * q[1] + h[(1, 1)] * q[0]);
        let limit = mu * p[0];
        if p[0] >= 0.0 && p[1].abs() <= limit + ROUNDING * size / determinant.abs() {
            offer(Vector2::new(p[0], p[1].clamp(-limit, limit)));
        }
    }
    for sigma in [1.0, -1.0] {
        let compliance = h[(0, 0)] - sigma * mu * h[(0, 1)];
        if compliance > 0.0 {
            let p_n = -q[0] / compliance;
            let p = Vector2::new(p_n, -sigma * mu * p_n);
            let terms = [h[(1, 0)] * p[0], h[(1, 1)] * p[1], q[1]];
            let slack = ROUNDING * terms.iter().map(|term| term.abs()).sum::<f64>();
            if sigma * terms.iter().sum::<f64>() >= -slack || mu == 0.0 {
                offer(p);
            }
        }
    }
    best.filter(|p| p.iter().all(|c| c.is_finite()))
}

/// The same, near the impulse `start`: where several impulses may satisfy the law, a contact that stuck goes on sticking while it can. The
/// smallest one would let go of what is pressed against its surface as soon as nothing but friction presses it.
#[inline]
pub(crate) fn solve_near(h: &Matrix2<f64>, q: &Vector2<f64>, mu: f64, start: &Vector2<f64>) -> Option<Vector2<f64>> {
    let has_several = h[(0, 0)] <= mu * h[(0, 1)].abs();
    if has_several && start[1].abs() < mu * start[0] * AT_LIMIT {
        let determinant = h.determinant();
        let p = sticking(h, q) / determinant;
        if determinant > 0.0 && p[1].abs() < mu * p[0] * AT_LIMIT {
            return Some(p);
        }
    }
    solve(h, q, mu)
}

/// The impulse −H⁻¹ q with which a contact sticks, times the determinant of H.
#[inline]
pub(crate) fn sticking(h: &Matrix2<f64>, q: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(h[(0, 1)] * q[1] - h[(1, 1)] * q[0], h[(1, 0)] * q[0] - h[(0, 0)] * q[1])
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
    fn a_state_is_valid_between_sticking_and_sliding() {
        // |p_T| exceeds μ p_N in the last digit, and u_T of the slide has the wrong sign in its last.
        let h = Matrix2::new(5.150733870361124, 6.94588824968614, 6.94588824968614, 11.535917081603149);
        let p = solve(&h, &Vector2::new(-0.08123220389856224, -0.11976024561611948), 0.5).unwrap();
        assert!((p - Vector2::new(0.009419670347586858, 0.004709835173793429)).norm() < 1e-14);
    }

    #[test]
    fn of_several_solutions_the_one_that_sticks_on_is_taken() {
        // H_NN < μ H_NT, and nothing but friction presses the contact.
        let h = Matrix2::new(1.0, 2.0, 2.0, 5.0);
        let (q, mu) = (Vector2::new(0.1, 0.5), 3.0);
        let stuck = Vector2::new(1.0, -0.5);
        assert_eq!(solve_near(&h, &q, mu, &Vector2::zeros()), Some(Vector2::zeros()));
        let p = solve_near(&h, &q, mu, &stuck).unwrap();
        assert!((h * p + q).norm() < 1e-15 && p[0] > 0.0 && p[1].abs() < mu * p[0], "{p}");
        // What slid, or would have to pull, opens.
        assert_eq!(solve_near(&h, &q, mu, &Vector2::new(1.0, -3.0)), Some(Vector2::zeros()));
        assert_eq!(solve_near(&h, &Vector2::new(0.1, 0.0), mu, &stuck), Some(Vector2::zeros()));
    }

    #[test]
    fn of_several_solutions_the_smallest_is_taken() {
        // H_NN < μ H_NT: with q_T > 0 the state "slide right" is not available, "slide left" and
        // "stick" compete.
        let h = Matrix2::new(1.0, 2.0, 2.0, 5.0);
        let q = Vector2::new(-1.0, -3.0);
        let p = solve(&h, &q, 1.0).unwrap();
        let u = h * p + q;
        assert!(u[0].abs() < 1e-15 && p[1].abs() <= p[0] && u[1] * p[1] <= 1e-15);
    }
}
