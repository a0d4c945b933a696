//! The friction cone and the shift that makes Coulomb's law a complementarity.

use crate::Vector;

/// Euclidean norm of the tangential part. For D = 2 this is an absolute value, exact and free of a
/// square root.
#[inline]
pub(crate) fn tangential_norm<const D: usize>(x: &Vector<D>) -> f64 {
    if D == 2 {
        return x[1].abs();
    }
    let square: f64 = x.iter().skip(1).map(|c| c * c).sum();
    if square > 1e-280 && square < 1e280 {
        square.sqrt()
    } else {
        // `hypot` neither overflows nor underflows where the plain square does; it is slow.
        x.iter().skip(1).fold(0.0, |norm: f64, &c| norm.hypot(c))
    }
}

/// Euclidean projection of `x` onto the cone `K_μ = { p : ‖p_T‖ ≤ μ p_N }`.
///
/// `mu` ≥ 0; for `mu` = 0 the cone is the half line `p_N ≥ 0, p_T = 0`. Large `mu` is safe: the
/// formulas divide by 1 + μ² in a form that doesn't overflow.
///
/// ```
/// use nalgebra::Vector2;
/// use teeter_contact::project;
///
/// assert_eq!(project(&Vector2::new(2.0, 0.5), 0.5), Vector2::new(2.0, 0.5)); // inside
/// assert_eq!(project(&Vector2::new(-2.0, 0.5), 0.5), Vector2::zeros()); // in the polar cone
/// assert_eq!(project(&Vector2::new(0.0, 1.0), 1.0), Vector2::new(0.5, 0.5)); // on the border
/// ```
#[inline]
#[must_use]
pub fn project<const D: usize>(x: &Vector<D>, mu: f64) -> Vector<D> {
    let x_n = x[0];
    let x_t = tangential_norm(x);
    // The polar cone first: for mu = 0 the other test would take p_N < 0 for inside.
    if mu * x_t <= -x_n {
        return Vector::zeros();
    }
    if x_t <= mu * x_n {
        return *x;
    }
    // Onto the ray along (1, μ d), d = x_T/‖x_T‖, with the foot at (x_N + μ‖x_T‖)/(1 + μ²).
    let foot = if mu <= 1.0 {
        (x_n + mu * x_t) / (1.0 + mu * mu)
    } else {
        let inverse = mu.recip();
        let foot = (x_n * inverse + x_t) * inverse / (1.0 + inverse * inverse);
        // Next to the polar cone rounding can make this negative. Not `max`, which would take a NaN
        // for zero.
        if foot < 0.0 { 0.0 } else { foot }
    };
    let mut p = *x;
    p[0] = foot;
    let scale = if x_t > 0.0 { mu * foot / x_t } else { 0.0 };
    for i in 1..D {
        p[i] *= scale;
    }
    p
}

/// The relative velocity with De Saxcé's shift: `û = u + (μ‖u_T‖, 0[, 0])`.
#[inline]
#[must_use]
pub fn de_saxce<const D: usize>(u: &Vector<D>, mu: f64) -> Vector<D> {
    let mut shifted = *u;
    shifted[0] += mu * tangential_norm(u);
    shifted
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector2, Vector3};

    #[test]
    fn projection_is_the_nearest_point_of_the_cone() {
        // Variational characterisation: ⟨x − Πx, y − Πx⟩ ≤ 0 for every y in the cone.
        for &mu in &[0.0, 0.3, 1.0, 40.0, 1e12] {
            for i in -8..=8 {
                for j in -8..=8 {
                    for k in -2..=2 {
                        let x = Vector3::new(f64::from(i), f64::from(j) * 0.7, f64::from(k) * 1.3);
                        let p = project(&x, mu);
                        assert!(p[0] >= 0.0);
                        assert!(tangential_norm(&p) <= mu * p[0] * (1.0 + 1e-15) + 1e-15);
                        for angle in 0..12 {
                            let a = f64::from(angle) * std::f64::consts::FRAC_PI_6;
                            let y = Vector3::new(1.0, mu * a.cos(), mu * a.sin());
                            let scale = (x.norm() + p.norm()) * (y.norm() + p.norm()) + 1.0;
                            assert!((x - p).dot(&(y - p)) <= 1e-13 * scale, "mu {mu} x {x} p {p}");
                        }
                        assert!((x - p).dot(&p).abs() <= 1e-13 * (1.0 + x.norm_squared()));
                    }
                }
            }
        }
    }

    #[test]
    fn projection_of_2d_agrees_with_3d_in_a_plane() {
        for &(n, t, mu) in &[(1.0, 3.0, 0.4), (-1.0, 3.0, 0.4), (-3.0, 0.2, 2.0), (0.0, 0.0, 0.0)] {
            let p2 = project(&Vector2::new(n, t), mu);
            let p3 = project(&Vector3::new(n, t, 0.0), mu);
            assert!((p2[0] - p3[0]).abs() < 1e-15 && (p2[1] - p3[1]).abs() < 1e-15);
        }
    }

    #[test]
    fn a_huge_friction_coefficient_does_not_overflow() {
        let p = project(&Vector2::new(-1.0, 1.0), 1e200);
        assert!(p.iter().all(|c| c.is_finite()));
        assert!((p[1] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_number_stays_none() {
        for mu in [0.0, 0.5, 2.0] {
            assert!(project(&Vector2::new(f64::NAN, 1.0), mu).iter().any(|c| c.is_nan()), "{mu}");
        }
    }

    #[test]
    fn the_shift_acts_on_the_normal_component_only() {
        let u = Vector3::new(0.5, 3.0, -4.0);
        assert_eq!(de_saxce(&u, 0.2), Vector3::new(1.5, 3.0, -4.0));
    }
}
