//! Exact solution of the law of one contact with all others fixed, the local solve of Gauss–Seidel.
//!
//! What depends only on the block and μ is computed once per solve ([`Local::new`]); each visit
//! then takes some tens of multiplications.

use crate::{one_contact, one_contact_space as space};
use nalgebra::{Matrix2, Vector2};
use teeter_contact::{Block, Vector, de_saxce, project};

/// A determinant below this, relative to the product of the diagonal, counts as zero.
const RANK_TOLERANCE: f64 = 1e-12;

/// Above this, the solution loses at most two digits.
const WELL_CONDITIONED: f64 = 1e-2;

/// Above this friction coefficient, the shift μ‖u_T‖ amplifies the rounding of a sticking contact's
/// velocity noticeably.
const LARGE_FRICTION: f64 = 10.0;

/// Factor by which `H_NN` must exceed `μ‖H_NT‖` for a block to count as regular: a margin for
/// rounding.
const MARGIN: f64 = 1.0 + 1e-9;

/// The kind of a block's local solve.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// μ = 0, or no tangent.
    Frictionless,
    /// The first valid state is taken: in the plane because it is unique, in space for speed.
    Regular,
    /// All states are tried and the smallest impulse is taken.
    Difficult,
}

/// One contact's block, friction coefficient, and derived quantities. The order of the fields lets
/// a sliding contact avoid loading the inverse, which it doesn't need.
#[derive(Clone, Debug)]
#[repr(C)]
pub(crate) struct Local<const D: usize> {
    mu: f64,
    kind: Kind,
    /// Whether the inverse loses so many digits that its product needs a correction.
    refine: bool,
    /// The block, by rows.
    h: [[f64; D]; D],
    /// `1/H_NN`; in 2D with friction, `1/(H_NN ∓ μ H_NT)` for sliding to the right and left.
    compliance: [f64; 2],
    /// `H⁻¹` by rows; zero where the block is singular to rounding.
    inverse: [[f64; D]; D],
}

impl<const D: usize> Local<D> {
    /// Prepares a contact. `H_NN` > 0, as checked by the problem.
    pub(crate) fn new(h: &Block<D>, mu: f64) -> Self {
        let h_nn = h[(0, 0)];
        let mut local = Self {
            h: space::rows(h),
            inverse: [[0.0; D]; D],
            mu,
            compliance: [h_nn.recip(); 2],
            kind: if mu == 0.0 || D == 1 { Kind::Frictionless } else { Kind::Difficult },
            refine: true,
        };
        if local.kind == Kind::Frictionless {
            return local;
        }
        if D == 2 {
            let determinant = h_nn * h[(1, 1)] - h[(0, 1)] * h[(1, 0)];
            if determinant > RANK_TOLERANCE * (h_nn * h[(1, 1)]).abs() && h_nn > mu * h[(0, 1)].abs() * MARGIN {
                let inverse = determinant.recip();
                local.inverse[0][0] = h[(1, 1)] * inverse;
                local.inverse[0][1] = -h[(0, 1)] * inverse;
                local.inverse[1][0] = -h[(1, 0)] * inverse;
                local.inverse[1][1] = h_nn * inverse;
                local.compliance = [1.0, -1.0].map(|sigma| (h_nn - sigma * mu * h[(0, 1)]).recip());
                local.kind = Kind::Regular;
            }
        }
        if D == 3
            && let Some(inverse) = space::inverse(&local.h, RANK_TOLERANCE)
        {
            local.inverse = inverse;
            local.refine = mu > LARGE_FRICTION || space::inverse(&local.h, WELL_CONDITIONED).is_none();
            local.kind = Kind::Regular;
        }
        local
    }

    /// The velocity due to the contact's own impulse.
    #[inline]
    pub(crate) fn velocity(&self, p: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|r, _| self.h[r].iter().zip(p.iter()).fold(0.0, |sum, (h, p)| sum + h * p))
    }

    /// The impulse of the contact whose velocity would be `q` without it. `slip` carries the state
    /// from one visit to the next: a measure of the sliding speed, 0 for a sticking contact (and
    /// initially), −1 for an open one. `None` if no state is valid.
    #[inline(always)]
    pub(crate) fn solve(&self, q: &Vector<D>, slip: &mut f64) -> Option<Vector<D>> {
        if q[0] >= 0.0 {
            *slip = -1.0;
            return Some(Vector::zeros());
        }
        if self.kind == Kind::Frictionless {
            let mut p = Vector::zeros();
            p[0] = -q[0] * self.compliance[0];
            return p[0].is_finite().then_some(p);
        }
        match D {
            2 => self.plane(q),
            3 => {
                let q = [q[0], q[1], q[2]];
                let valid_state = match self.kind {
                    Kind::Regular => space::valid_state(&self.h, &self.inverse, &q, self.mu, self.refine, slip),
                    _ => None,
                };
                let p = match valid_state {
                    Some(p) => p,
                    None => space::smallest(&self.h, &self.inverse, &q, self.mu)?,
                };
                Some(Vector::from_fn(|i, _| p[i]))
            }
            _ => None,
        }
    }

    #[inline]
    fn plane(&self, q: &Vector<D>) -> Option<Vector<D>> {
        let (h, mu) = (&self.h, self.mu);
        let of = |n: f64, t: f64| Vector::<D>::from_fn(|i, _| if i == 0 { n } else { t });
        if self.kind == Kind::Regular {
            let p_n = -(self.inverse[0][0] * q[0] + self.inverse[0][1] * q[1]);
            let p_t = -(self.inverse[1][0] * q[0] + self.inverse[1][1] * q[1]);
            if p_t.abs() <= mu * p_n {
                return Some(of(p_n, p_t));
            }
            // p_T of the sticking impulse exceeds the limit on one side, which is tried first.
            let first = usize::from(p_t > 0.0);
            for side in [first, 1 - first] {
                let p_n = -q[0] * self.compliance[side];
                let p_t = if side == 0 { -mu * p_n } else { mu * p_n };
                let u_t = h[1][0] * p_n + h[1][1] * p_t + q[1];
                if (if side == 0 { u_t >= 0.0 } else { u_t <= 0.0 }) && p_n.is_finite() {
                    return Some(of(p_n, p_t));
                }
            }
        }
        let block = Matrix2::new(h[0][0], h[0][1], h[1][0], h[1][1]);
        one_contact::solve(&block, &Vector2::new(q[0], q[1]), mu).map(|p| of(p[0], p[1]))
    }

    /// A step of the natural map from `p`, which has the same fixed points, for a contact without a
    /// valid state.
    pub(crate) fn step(&self, q: &Vector<D>, p: &Vector<D>) -> Vector<D> {
        let u = self.velocity(p) + q;
        let trace: f64 = (0..D).map(|i| self.h[i][i]).sum();
        let rho = if trace > 0.0 { D as f64 / trace } else { self.h[0][0].recip() };
        project(&(p - de_saxce(&u, self.mu) * rho), self.mu)
    }
}
