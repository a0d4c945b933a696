//! The law of one contact with all others held, exactly: what a sweep of Gauss–Seidel solves at each contact.
//!
//! What depends on the block and on μ alone is worked out once a solve ([`Local::new`]); what is left for each visit is
//! some tens of multiplications.

use crate::{one_contact, one_contact_space as space};
use nalgebra::{Matrix2, Vector2};
use teeter_contact::{Block, Vector, de_saxce, project};

/// A determinant below this, relative to the product of the diagonal, is taken for zero.
const RANK_TOLERANCE: f64 = 1e-12;

/// How much `H_NN` must exceed `μ‖H_NT‖` for a block to count as regular: rounding, with room.
const MARGIN: f64 = 1.0 + 1e-9;

/// How a block can be solved.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// μ = 0, or there is no tangent.
    Frictionless,
    /// Every sliding direction presses harder the more it is pushed, and sticking has one solution: the first state
    /// that fits is taken.
    Regular,
    /// All states are tried and the smallest impulse is taken.
    Difficult,
}

/// One contact's block, friction coefficient, and what follows from them.
#[derive(Clone, Debug)]
pub(crate) struct Local<const D: usize> {
    h: Block<D>,
    /// `H⁻¹`; zero where the block is singular to rounding.
    inverse: Block<D>,
    mu: f64,
    /// `1/H_NN`; in 2D without friction, `1/(H_NN ∓ μ H_NT)` for sliding to the right and to the left.
    compliance: [f64; 2],
    kind: Kind,
}

impl<const D: usize> Local<D> {
    /// Prepares a contact. `H_NN` > 0, as a problem's check sees to.
    pub(crate) fn new(h: &Block<D>, mu: f64) -> Self {
        let h_nn = h[(0, 0)];
        let mut local = Self {
            h: *h,
            inverse: Block::zeros(),
            mu,
            compliance: [h_nn.recip(); 2],
            kind: if mu == 0.0 || D == 1 { Kind::Frictionless } else { Kind::Difficult },
        };
        if local.kind == Kind::Frictionless {
            return local;
        }
        if D == 2 {
            let determinant = h_nn * h[(1, 1)] - h[(0, 1)] * h[(1, 0)];
            if determinant > RANK_TOLERANCE * (h_nn * h[(1, 1)]).abs() && h_nn > mu * h[(0, 1)].abs() * MARGIN {
                let inverse = determinant.recip();
                local.inverse[(0, 0)] = h[(1, 1)] * inverse;
                local.inverse[(0, 1)] = -h[(0, 1)] * inverse;
                local.inverse[(1, 0)] = -h[(1, 0)] * inverse;
                local.inverse[(1, 1)] = h_nn * inverse;
                local.compliance = [1.0, -1.0].map(|sigma| (h_nn - sigma * mu * h[(0, 1)]).recip());
                local.kind = Kind::Regular;
            }
        }
        if D == 3 {
            let rows = space::rows(h);
            if let Some(inverse) = space::inverse(&rows, RANK_TOLERANCE) {
                local.inverse = Block::from_fn(|r, c| inverse[r][c]);
                if space::positive(&rows) && h_nn > mu * rows[0][1].hypot(rows[0][2]) * MARGIN {
                    local.kind = Kind::Regular;
                }
            }
        }
        local
    }

    /// The impulse of the contact whose velocity would be `q` without it. `slip` is what the last visit left there: a
    /// measure of the sliding speed, from which the next one starts. `None` where no state fits.
    #[inline]
    pub(crate) fn solve(&self, q: &Vector<D>, slip: &mut f64) -> Option<Vector<D>> {
        if q[0] >= 0.0 {
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
                let (h, inverse) = (space::rows(&self.h), space::rows(&self.inverse));
                let q = [q[0], q[1], q[2]];
                let fast = self.kind == Kind::Regular;
                let p = if fast { space::regular(&h, &inverse, &q, self.mu, slip) } else { None };
                let p = p.or_else(|| space::smallest(&h, &inverse, &q, self.mu))?;
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
            let p_n = -(self.inverse[(0, 0)] * q[0] + self.inverse[(0, 1)] * q[1]);
            let p_t = -(self.inverse[(1, 0)] * q[0] + self.inverse[(1, 1)] * q[1]);
            if p_t.abs() <= mu * p_n {
                return Some(of(p_n, p_t));
            }
            // The impulse that would hold the contact points to where friction is at its limit.
            let first = usize::from(p_t > 0.0);
            for side in [first, 1 - first] {
                let p_n = -q[0] * self.compliance[side];
                let p_t = if side == 0 { -mu * p_n } else { mu * p_n };
                let u_t = h[(1, 0)] * p_n + h[(1, 1)] * p_t + q[1];
                if (if side == 0 { u_t >= 0.0 } else { u_t <= 0.0 }) && p_n.is_finite() {
                    return Some(of(p_n, p_t));
                }
            }
        }
        let block = Matrix2::new(h[(0, 0)], h[(0, 1)], h[(1, 0)], h[(1, 1)]);
        one_contact::solve(&block, &Vector2::new(q[0], q[1]), mu).map(|p| of(p[0], p[1]))
    }

    /// A step of the natural map from `p` instead, which has the same fixed points: for a contact that no state fits.
    pub(crate) fn step(&self, q: &Vector<D>, p: &Vector<D>) -> Vector<D> {
        let u = self.h * p + q;
        let trace = self.h.trace();
        let rho = if trace > 0.0 { D as f64 / trace } else { self.h[(0, 0)].recip() };
        project(&(p - de_saxce(&u, self.mu) * rho), self.mu)
    }
}
