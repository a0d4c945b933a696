//! The one judge of a solution: the scaled residual of the natural map.

use crate::cone::{de_saxce, project, tangential_norm};
use crate::{ContactProblem, Vector};

/// How far impulses are from solving a contact problem; 0 is exact. Both numbers are without unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Residual {
    /// `‖p − Π(p − ρû)‖ / max(‖p‖, ρ‖q‖)` over all contacts together, ρ = 1/mean(diag H).
    pub global: f64,
    /// The largest residual of a single contact, each in its own scale, so that a light contact
    /// can't hide beside a heavy one: `max(‖p_c‖, ρ_c‖q_c‖, ρ_c‖u_c − q_c‖)`, with what the impulses
    /// of all contacts change in its velocity. It is at most 3 + 2μ, however small the contact's
    /// impulse and free velocity are.
    pub worst: f64,
    /// The contact with that residual (0 if there is none).
    pub worst_contact: usize,
}

impl Residual {
    /// A residual with these values.
    #[must_use]
    pub fn new(global: f64, worst: f64, worst_contact: usize) -> Self {
        Self { global, worst, worst_contact }
    }
}

/// Smallest scale, so that the residual of a problem in which nothing moves or presses is 0, not
/// 0/0.
const SCALE_FLOOR: f64 = 1e-300;

/// Above this friction coefficient, rounding of a sticking contact's velocity is not taken for
/// slip. Below it that isn't needed: 1e3 rounding errors are less than any sensible tolerance.
const MUCH_FRICTION: f64 = 1e3;

/// Bound on the rounding of a velocity, per term of its sum and relative to that term: that of the
/// sum itself and of a solver's elimination.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Judges `p` against the exact Coulomb law, whatever a solver minimised inside (`docs/theory.md`
/// §6):
///
/// ```text
/// err(p) = ‖p − Π_{K_μ}(p − ρ û)‖ / max(‖p‖, ρ‖q‖, 1e-300),   ρ = 1/mean(diag H)
/// ```
///
/// For μ > 1e3 the shift μ‖u_T‖ of û would magnify the rounding of a sticking contact's velocity
/// (to a residual of 1e-9 at μ = 1e7). There the part of ‖u_T‖ that rounding can explain is left
/// out of the shift: of all velocities within rounding of H p + q, the one that slips least is
/// judged. A slip beyond rounding counts in full.
///
/// # Panics
/// If `p` doesn't hold one impulse a contact: a mistake of the calling code.
#[inline]
#[must_use]
pub fn judge<const D: usize>(problem: &ContactProblem<'_, D>, p: &[Vector<D>]) -> Residual {
    assert_eq!(p.len(), problem.contacts(), "one impulse a contact");
    match p {
        [only] => judge_single(problem, only, &problem.velocity(0, p)),
        _ => judge_several(problem, p, |i| problem.velocity(i, p)),
    }
}

/// As [`judge()`], for a caller that already has the velocities `u = H p + q`: this saves the
/// product with H.
///
/// # Panics
/// If `p` or `u` doesn't hold one vector a contact: a mistake of the calling code.
#[must_use]
pub fn judge_velocities<const D: usize>(problem: &ContactProblem<'_, D>, p: &[Vector<D>], u: &[Vector<D>]) -> Residual {
    assert!(p.len() == problem.contacts() && u.len() == p.len(), "one impulse and one velocity a contact");
    match p {
        [only] => judge_single(problem, only, &u[0]),
        _ => judge_several(problem, p, |i| u[i]),
    }
}

fn judge_several<const D: usize>(
    problem: &ContactProblem<'_, D>,
    p: &[Vector<D>],
    velocity: impl Fn(usize) -> Vector<D>,
) -> Residual {
    let mut residual = Residual { global: 0.0, worst: 0.0, worst_contact: 0 };
    if p.is_empty() {
        return residual;
    }
    let rho = problem.scale();
    let (mut p_norm, mut q_norm, mut map_norm) = (0.0, 0.0, 0.0);
    for i in 0..p.len() {
        let (mu, q) = (problem.mu()[i], problem.q()[i]);
        let u = velocity(i);
        let u_hat = if mu > MUCH_FRICTION { shifted_beyond_rounding(problem, i, p, &u) } else { de_saxce(&u, mu) };
        let map = |rho: f64| p[i] - project(&(p[i] - u_hat * rho), mu);
        p_norm += p[i].norm_squared();
        q_norm += q.norm_squared();
        let squared = map(rho).norm_squared();
        map_norm += squared;

        let rho_i = D as f64 / problem.diagonal(i).trace();
        // Squared norms: one division a contact, and no root.
        // The velocity that impulses change belongs to it: a contact whose own impulse and free
        // velocity are nearly 0, as of a block at rest between others, has no other scale.
        let speed = q.norm_squared().max((u - q).norm_squared());
        let scale = p[i].norm_squared().max(rho_i * rho_i * speed).max(SCALE_FLOOR);
        // With a single contact both scales are the same.
        let own = if rho_i == rho { squared } else { map(rho_i).norm_squared() } / scale;
        // NaN counts as worst: `!(own <= worst)` is true for it.
        if !(own <= residual.worst) {
            residual.worst = own;
            residual.worst_contact = i;
        }
    }
    residual.worst = residual.worst.sqrt();
    residual.global = map_norm.sqrt() / p_norm.sqrt().max(rho * q_norm.sqrt()).max(SCALE_FLOOR);
    residual
}

/// The residual of a single contact, whose two scales are one.
#[inline(always)]
fn judge_single<const D: usize>(problem: &ContactProblem<'_, D>, p: &Vector<D>, u: &Vector<D>) -> Residual {
    let (mu, q, trace) = (problem.mu()[0], problem.q()[0], problem.diagonal(0).trace());
    let rho = if trace > 0.0 { D as f64 / trace } else { 1.0 };
    let u_hat = if mu > MUCH_FRICTION {
        shifted_beyond_rounding(problem, 0, std::slice::from_ref(p), u)
    } else {
        de_saxce(u, mu)
    };
    let squared = (p - project(&(p - u_hat * rho), mu)).norm_squared();
    let (p_squared, q_squared) = (p.norm_squared(), q.norm_squared());
    let worst = squared / p_squared.max(rho * rho * q_squared).max(SCALE_FLOOR);
    let global = squared.sqrt() / p_squared.sqrt().max(rho * q_squared.sqrt()).max(SCALE_FLOOR);
    // NaN counts as worst.
    Residual { global, worst: if worst <= 0.0 { 0.0 } else { worst.sqrt() }, worst_contact: 0 }
}

/// û, shifted by the part of ‖u_T‖ that rounding can't explain.
#[cold]
fn shifted_beyond_rounding<const D: usize>(
    problem: &ContactProblem<'_, D>,
    i: usize,
    p: &[Vector<D>],
    u: &Vector<D>,
) -> Vector<D> {
    let (size, terms) = problem.delassus().tangential_size(i, p);
    let rounding = ROUNDING * (terms + 1) as f64 * (size + tangential_norm(&problem.q()[i]));
    let slip = tangential_norm(u) - rounding;
    let mut shifted = *u;
    // Written so that NaN stays NaN.
    if !(slip <= 0.0) {
        shifted[0] += problem.mu()[i] * slip;
    }
    shifted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Delassus;
    use nalgebra::{Matrix2, Vector2};

    fn residual(q: Vector2<f64>, p: Vector2<f64>, mu: f64) -> f64 {
        let h = [Matrix2::new(2.0, 0.3, 0.3, 1.0)];
        judge(&ContactProblem::new(Delassus::Dense(&h), &[q], &[mu]).unwrap(), &[p]).global
    }

    #[test]
    fn exact_solutions_have_no_residual() {
        assert_eq!(residual(Vector2::new(1.0, 5.0), Vector2::zeros(), 0.4), 0.0);
        assert_eq!(residual(Vector2::zeros(), Vector2::zeros(), 0.4), 0.0);
        // Sticking: H p + q = 0 with p inside the cone.
        let p = Vector2::new(1.0, 0.1);
        assert!(residual(-(Matrix2::new(2.0, 0.3, 0.3, 1.0) * p), p, 0.4) < 1e-15);
    }

    #[test]
    fn violations_of_each_part_of_the_law_are_seen() {
        assert!(residual(Vector2::new(-1.0, 0.0), Vector2::zeros(), 0.4) > 0.5, "penetrates");
        assert!(residual(Vector2::new(1.0, 0.0), Vector2::new(0.2, 0.0), 0.4) > 0.1, "pulls while open");
        let p = Vector2::new(1.0, 0.9);
        assert!(residual(-(Matrix2::new(2.0, 0.3, 0.3, 1.0) * p), p, 0.4) > 0.1, "beyond the cone");
        // Slides to the right with friction to the right.
        let p = Vector2::new(1.0, 0.4);
        let q = Vector2::new(0.0, 2.0) - Matrix2::new(2.0, 0.3, 0.3, 1.0) * p;
        assert!(residual(q, p, 0.4) > 0.1, "friction drives");
    }

    #[test]
    fn the_residual_does_not_depend_on_units() {
        let h = Matrix2::new(2.0, 0.3, 0.3, 1.0);
        let (q, p) = (Vector2::new(-1.0, 0.7), Vector2::new(0.4, -0.1));
        let err = |mass: f64, speed: f64| {
            let (h, q, p) = ([h / mass], [q * speed], [p * (mass * speed)]);
            judge(&ContactProblem::new(Delassus::Dense(&h), &q, &[0.3]).unwrap(), &p).global
        };
        assert!((err(1.0, 1.0) - err(1e-6, 1e3)).abs() < 1e-14 * err(1.0, 1.0));
    }

    #[test]
    fn a_light_contact_beside_a_heavy_one_shows_in_the_worst_only() {
        let h = [Matrix2::identity(), Matrix2::zeros(), Matrix2::zeros(), Matrix2::identity() * 1e3];
        let q = [Vector2::new(-1e6, 0.0), Vector2::new(-1e-3, 0.0)];
        let p = [Vector2::new(1e6, 0.0), Vector2::zeros()];
        let r = judge(&ContactProblem::new(Delassus::Dense(&h), &q, &[0.3, 0.3]).unwrap(), &p);
        assert!(r.global < 1e-9 && r.worst > 0.9 && r.worst_contact == 1);
    }

    #[test]
    fn a_contact_without_a_scale_of_its_own_is_judged_by_what_others_do_to_it() {
        // The first impulse moves the second contact by rounding only; it has hardly any impulse.
        let off = Matrix2::new(-1e-12, 0.0, 0.0, 0.0);
        let h = [Matrix2::identity(), off, off, Matrix2::identity()];
        let q = [Vector2::new(-1.0, 0.0), Vector2::new(1e-200, 0.0)];
        let p = [Vector2::new(1.0, 0.0), Vector2::new(1e-150, 0.0)];
        let r = judge(&ContactProblem::new(Delassus::Dense(&h), &q, &[0.3, 0.3]).unwrap(), &p);
        assert!(r.global < 1e-11, "{r:?}");
        assert!(r.worst > 0.5 && r.worst <= 3.6 && r.worst_contact == 1, "{r:?}");
    }

    #[test]
    fn rounding_of_a_sticking_contact_is_no_slip_however_much_friction() {
        // One third is no double, so neither is the velocity quite zero.
        let h = [Matrix2::new(2.0, 0.3, 0.3, 1.0 / 3.0)];
        let q = [Vector2::new(-1.0, 0.7)];
        let p = h[0].lu().solve(&-q[0]).unwrap();
        for mu in [1e2, 1e4, 1e7, 1e12, 1e300] {
            let residual = |q: Vector2<f64>, p: Vector2<f64>| {
                judge(&ContactProblem::new(Delassus::Dense(&h), &[q], &[mu]).unwrap(), &[p]).global
            };
            // Wherever the last digits lie.
            for k in -8..8 {
                let near = Vector2::new(p[0], p[1] * (1.0 + f64::from(k) * 0.5 * f64::EPSILON));
                assert!(residual(q[0], near) < 1e-10, "{mu:e}: {:e}", residual(q[0], near));
            }
            // A slip of 1e-9 of the problem's speed is one, as ever; and so are the other faults.
            let slips = residual(q[0] + Vector2::new(0.0, 1e-9), p);
            assert!(slips > 1e-10 && slips > 1e-10 * mu.min(1e8), "{mu:e}: {slips:e}");
            assert!(residual(q[0] - Vector2::new(1e-3, 0.0), p) > 1e-4, "{mu:e}: penetrates");
            assert!(residual(Vector2::new(1.0, 0.0), Vector2::new(0.2, 0.0)) > 0.1, "{mu:e}: pulls while open");
        }
    }
}
