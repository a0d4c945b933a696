//! The law of one contact with all others held, exactly: what a sweep of Gauss–Seidel solves at
//! each contact.
//!
//! What depends on the block and on μ alone is worked out once a solve ([`Local::new`]); what is
//! left for each visit is some tens of multiplications.

use crate::{one_contact, one_contact_space as space};
use nalgebra::{Matrix2, Vector2};
use teeter_contact::{Block, Vector, de_saxce, project};

/// A determinant below this, relative to the product of the diagonal, is taken for zero.
const RANK_TOLERANCE: f64 = 1e-12;

/// Above this, it costs its solution two digits at most.
const WELL_CONDITIONED: f64 = 1e-2;

/// With more friction than that, the shift μ‖u_T‖ makes rounding of a sticking contact's velocity
/// felt.
const MUCH: f64 = 10.0;

/// How much `H_NN` must exceed `μ‖H_NT‖` for a block to count as regular: rounding, with room.
const MARGIN: f64 = 1.0 + 1e-9;

/// How a block can be solved.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// μ = 0, or there is no tangent.
    Frictionless,
    /// The first state that fits is taken: in the plane because there is one only, in space for
    /// speed.
    Regular,
    /// All states are tried and the smallest impulse is taken.
    Difficult,
}

/// One contact's block, friction coefficient, and what follows from them. In this order, as a
/// sliding contact then doesn't fetch the inverse, which it doesn't need.
#[derive(Clone, Debug)]
#[repr(C)]
pub(crate) struct Local<const D: usize> {
    mu: f64,
    kind: Kind,
    /// Whether the inverse loses so many digits that its product wants a correction.
    refine: bool,
    /// Its block, by rows.
    h: [[f64; D]; D],
    /// `1/H_NN`; in 2D with friction, `1/(H_NN ∓ μ H_NT)` for sliding to the right and to the left.
    compliance: [f64; 2],
    /// `H⁻¹` by rows; zero where the block is singular to rounding.
    inverse: [[f64; D]; D],
}

impl<const D: usize> Local<D> {
    /// Prepares a contact. `H_NN` > 0, as a problem's check sees to.
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
            local.refine = mu > MUCH || space::inverse(&local.h, WELL_CONDITIONED).is_none();
            local.kind = Kind::Regular;
        }
        local
    }

    /// The velocity that its own impulse gives it.
    #[inline]
    pub(crate) fn velocity(&self, p: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|r, _| self.h[r].iter().zip(p.iter()).fold(0.0, |sum, (h, p)| sum + h * p))
    }

    /// The impulse of the contact whose velocity would be `q` without it. `slip` is what the last
    /// visit left there, from which the next one starts: a measure of the sliding speed, 0 for a
    /// contact that stuck (and at first), −1 for an open one. `None` where no state fits.
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
                let usual = match self.kind {
                    Kind::Regular => space::usual(&self.h, &self.inverse, &q, self.mu, self.refine, slip),
                    _ => None,
                };
                let p = match usual {
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
            // The impulse that would hold the contact points to where friction is at its limit.
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

    /// A step of the natural map from `p` instead, which has the same fixed points: for a contact
    /// that no state fits.
    pub(crate) fn step(&self, q: &Vector<D>, p: &Vector<D>) -> Vector<D> {
        let u = self.velocity(p) + q;
        let trace: f64 = (0..D).map(|i| self.h[i][i]).sum();
        let rho = if trace > 0.0 { D as f64 / trace } else { self.h[0][0].recip() };
        project(&(p - de_saxce(&u, self.mu) * rho), self.mu)
    }
}
