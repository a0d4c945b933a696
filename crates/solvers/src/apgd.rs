//! Accelerated projected gradients (APGD), with the slip's shift in an outer loop.
//!
//! **Solves** the exact Coulomb law, 2D and 3D. With the shift s_i = μ_i ‖u_T,i‖ held, the law is the optimality of a convex
//! problem, `min ½ pᵀHp + (q + s)ᵀp` over the cones ‖p_T‖ ≤ μ p_N (s acts on the normal components): Nesterov's method solves
//! it (Mazhar, Heyn, Negrut and Tasora 2015, doi 10.1145/2735627), and the shift is renewed in between.
//!
//! **Departures.**
//! - The paper solves the convex law (s = 0) only; the outer loop is Acary and Cadoux's fixed point (2011, doi
//!   10.1002/zamm.201000073). The shift is renewed as soon as the convex problem's residual is half of the exact
//!   law's: solving further for a shift that is wrong is work in vain.
//! - With μ above 100 a contact that sticks has no shift, whatever its remaining slip: the fixed point could not contract else.
//! - Restart of the momentum by the sign of gradient times step (O'Donoghue and Candès 2015, doi 10.1007/s10208-013-9150-3), as in
//!   the paper.
//! - The step is tested by `dᵀH d ≤ ‖d‖²/τ` rather than by differences of the objective, which cancel near the end; each
//!   contact's step is scaled by the mean diagonal of its block.
//! - As H y is a combination of products that are known, an iteration takes one product with H, not two.
//!
//! **Take it** for large loosely packed problems at 1e-4 where nothing is to be factorised, or for the convex law.
//! **Cost**: one product with H an iteration.
//! KaplasTower (570 contacts) takes 550 iterations to 1e-4 and 1300 to 1e-12, spheres-in-a-box 24 000 to 1e-12 (no solver of
//! Siconos gets there within 10 s), RockPile 930 to 1e-4, Capsules-i101 1000 to 1e-8.
//! **Fails**: on blocks whose own diagonal is badly scaled (one step serves a contact's normal and tangent);
//! with large μ the outer loop need not contract, and then it ends as `stalled` or out of iterations; a skew part of
//! H isn't part of any objective: small ones do no harm, large ones may.

use crate::memory::reserve;
use crate::operator::{Operator, STEEP, disk_map, is_steep, natural_map, own_step, slip_shift};
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Status, Stop, Vector, judge, project};

/// The exact residual is compared with the convex one every so many iterations.
const CHECK: u32 = 4;
/// The shift is renewed once the convex residual is below this part of the exact one.
const ENOUGH: f64 = 0.5;
/// How the step shrinks where it was too long, and grows otherwise: the paper's 1/2 and 1/0.9.
const SHRINK: f64 = 0.5;
/// See [`SHRINK`].
const GROW: f64 = 1.0 / 0.9;
/// Most cuts of the step in one iteration.
const MOST_CUTS: u32 = 60;
/// Iterations without a better residual after which the iteration counts as stalled.
const PATIENCE: u32 = 8000;

/// The accelerated gradient solver; see its [page](self). `iterations` counts gradients.
#[derive(Clone, Debug, Default)]
pub struct Apgd<const D: usize> {
    gathered: BlockSparse<D>,
    own: Vec<f64>,
    shift: Vec<f64>,
    p: Vec<Vector<D>>,
    u: Vec<Vector<D>>,
    /// The extrapolated point, and its velocities.
    y: Vec<Vector<D>>,
    u_y: Vec<Vector<D>>,
    next: Vec<Vector<D>>,
    u_next: Vec<Vector<D>>,
    best: Vec<Vector<D>>,
}

impl<const D: usize> Apgd<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "apgd";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Iterates from `p` and leaves the best in it; with the convex law the shift stays 0 and the convex residual counts.
    pub(crate) fn iterate(
        &mut self,
        problem: &ContactProblem<'_, D>,
        stop: &Stop<'_>,
        start: &mut [Vector<D>],
        law: Law,
    ) -> (Status, u32) {
        let Self { gathered, own, shift, p, u, y, u_y, next, u_next, best } = self;
        let h = Operator::new(problem, gathered);
        let (n, q, mu, rho) = (problem.contacts(), problem.q(), problem.mu(), problem.scale());
        own.clear();
        own.extend((0..n).map(|i| own_step(problem, i)));
        for vectors in [&mut *p, u, y, u_y, next, u_next, best] {
            vectors.clear();
            vectors.extend_from_slice(start);
        }
        for i in 0..n {
            u[i] = h.velocity(i, q, p);
        }
        u_y.copy_from_slice(u);
        let slip = |p: &Vector<D>, u: &Vector<D>, mu: f64| {
            if law == Law::Convex { 0.0 } else { slip_shift(p, u, mu) }
        };
        shift.clear();
        // A very large μ on a contact without impulse would hold it open: there the convex law comes first.
        shift.extend((0..n).map(|i| if mu[i] > STEEP && p[i][0] <= 0.0 { 0.0 } else { slip(&p[i], &u[i], mu[i]) }));
        let q_norm = rho * q.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        let (mut step, mut theta) = (1.0, 1.0_f64);
        let (mut best_residual, mut best_at, mut iterations) = (f64::INFINITY, 0, 0);
        let ended = loop {
            if iterations % CHECK == 0 || iterations >= stop.max_iterations {
                let size = p.iter().map(Vector::norm_squared).sum::<f64>().sqrt().max(q_norm).max(f64::MIN_POSITIVE);
                let convex = convex_map(p, u, shift, mu, rho) / size;
                let residual = if law == Law::Convex { convex } else { natural_map(p, u, mu, rho) / size };
                if residual < best_residual {
                    (best_residual, best_at) = (residual, iterations);
                    best.copy_from_slice(p);
                }
                let small = residual <= stop.tolerance
                    || (law == Law::Exact && is_steep(mu) && disk_map(p, u, mu, rho) <= stop.tolerance * size);
                if small && (law == Law::Convex || judge(problem, p).global <= stop.tolerance) {
                    break Status::Converged;
                }
                if !residual.is_finite() {
                    break Status::Breakdown;
                }
                if iterations >= stop.max_iterations {
                    break Status::MaxIterations;
                }
                if iterations - best_at >= PATIENCE {
                    break Status::Stalled;
                }
                if stop.cancelled() {
                    break Status::Cancelled;
                }
                // A large μ inflates the residual by the smallest slip: there the law taken apart is compared with.
                let exact = if is_steep(mu) { disk_map(p, u, mu, rho) / size } else { residual };
                if law == Law::Exact && convex <= ENOUGH * exact {
                    for i in 0..n {
                        shift[i] = slip(&p[i], &u[i], mu[i]);
                    }
                }
            }
            iterations += 1;
            for _ in 0..MOST_CUTS {
                let (mut curvature, mut way) = (0.0, 0.0);
                for i in 0..n {
                    let mut gradient = u_y[i];
                    gradient[0] += shift[i];
                    next[i] = project(&(y[i] - gradient * (step * own[i])), mu[i]);
                }
                for i in 0..n {
                    u_next[i] = h.velocity(i, q, next);
                    let d = next[i] - y[i];
                    curvature += d.dot(&(u_next[i] - u_y[i]));
                    way += d.norm_squared() / own[i];
                }
                if step * curvature <= way {
                    break;
                }
                step *= SHRINK;
            }
            // The gradient at y along the step taken: uphill, the momentum is forgotten.
            let mut uphill = 0.0;
            for i in 0..n {
                let mut gradient = u_y[i];
                gradient[0] += shift[i];
                uphill += gradient.dot(&(next[i] - p[i]));
            }
            let squared = theta * theta;
            let mut theta_next = 0.5 * (-squared + theta * (squared + 4.0).sqrt());
            let mut momentum = theta * (1.0 - theta) / (squared + theta_next);
            if uphill > 0.0 {
                (theta_next, momentum) = (1.0, 0.0);
            }
            theta = theta_next;
            for i in 0..n {
                y[i] = next[i] + (next[i] - p[i]) * momentum;
                u_y[i] = u_next[i] + (u_next[i] - u[i]) * momentum;
            }
            std::mem::swap(p, next);
            std::mem::swap(u, u_next);
            step *= GROW;
        };
        if ended != Status::Breakdown || best_residual.is_finite() {
            start.copy_from_slice(if ended == Status::Converged { p } else { best });
        }
        (ended, iterations)
    }
}

impl<const D: usize> ContactSolver<D> for Apgd<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.gathered.reserve(contacts, blocks);
        reserve(&mut self.own, contacts);
        reserve(&mut self.shift, contacts);
        let Self { p, u, y, u_y, next, u_next, best, .. } = self;
        for vectors in [p, u, y, u_y, next, u_next, best] {
            reserve(vectors, contacts);
        }
    }

    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &mut [Vector<D>]) -> Outcome {
        let (status, iterations) = self.iterate(problem, stop, p, Law::Exact);
        Outcome::new(status, Self::NAME, iterations, judge(problem, p))
    }

    fn fork(&self) -> Box<dyn ContactSolver<D>> {
        Box::new(Self::new())
    }
}

/// The natural map of the convex problem with the shift held.
pub(crate) fn convex_map<const D: usize>(p: &[Vector<D>], u: &[Vector<D>], shift: &[f64], mu: &[f64], rho: f64) -> f64 {
    let map = |i: usize| {
        let mut gradient = u[i];
        gradient[0] += shift[i];
        p[i] - project(&(p[i] - gradient * rho), mu[i])
    };
    (0..p.len()).map(|i| map(i).norm_squared()).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conforming::conforms_but_for_uneven_scales;

    #[test]
    fn conforms_to_its_tolerance() {
        conforms_but_for_uneven_scales(&mut Apgd::new(), &mut Apgd::new());
    }
}
