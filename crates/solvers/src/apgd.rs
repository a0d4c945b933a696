//! Accelerated projected gradients (APGD), with the slip's shift in an outer loop.
//!
//! **Solves** the exact Coulomb law, 2D and 3D. With the shift s_i = μ_i ‖u_T,i‖ held, the law is
//! the optimality of a convex problem, `min ½ pᵀHp + (q + s)ᵀp` over the cones ‖p_T‖ ≤ μ p_N (s
//! acts on the normal components): Nesterov's method solves it (Mazhar, Heyn, Negrut and Tasora
//! 2015, doi 10.1145/2735627), and the shift is renewed in between.
//!
//! **Departures.**
//! - The paper solves the convex law (s = 0) only; the outer loop is Acary and Cadoux's fixed point
//!   (2011, doi 10.1002/zamm.201000073). The shift is renewed as soon as the convex problem's
//!   residual is half of the exact law's: solving further for a shift that is wrong is work in
//!   vain.
//! - With μ above 100 a contact that sticks has no shift, whatever its remaining slip: the fixed
//!   point could not contract else.
//! - Restart of the momentum by the sign of gradient times step (O'Donoghue and Candès 2015, doi
//!   10.1007/s10208-013-9150-3), as in the paper.
//! - The step is tested by `dᵀH d ≤ ‖d‖²/τ` rather than by differences of the objective, which
//!   cancel near the end; each contact's step is scaled by the mean diagonal of its block.
//! - As H y is a combination of products that are known, an iteration takes one product with H, not
//!   two.
//!
//! **Take it** for large loosely packed problems at 1e-4 where nothing is to be factorised, or for
//! the convex law.
//! **Cost**: one product with H an iteration. KaplasTower (570 contacts) takes 550 iterations to
//! 1e-4 and 1300 to 1e-12, spheres-in-a-box 24 000 to 1e-12 (no solver of Siconos gets there within
//! 10 s), RockPile 930 to 1e-4, Capsules-i101 1000 to 1e-8.
//! **Fails**: on blocks whose own diagonal is badly scaled (one step serves a contact's normal and
//! tangent); with large μ the outer loop need not contract, and then it ends as `stalled` or out of
//! iterations; a skew part of H isn't part of any objective: small ones do no harm, large ones may.

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
    at: Iterate<D>,
    best: Vec<Vector<D>>,
}

/// What is solved: the problem, with its operator in the form for many products.
struct Posed<'a, const D: usize> {
    problem: &'a ContactProblem<'a, D>,
    h: Operator<'a, D>,
    law: Law,
    rho: f64,
    /// ρ‖q‖: what residuals are relative to where the impulses are smaller.
    q_norm: f64,
}

/// Where the iteration is.
#[derive(Clone, Debug, Default)]
struct Iterate<const D: usize> {
    /// The step that suits each contact on its own, and the factor on all of them.
    own: Vec<f64>,
    step: f64,
    /// Nesterov's θ, from which the momentum follows.
    theta: f64,
    shift: Vec<f64>,
    p: Vec<Vector<D>>,
    u: Vec<Vector<D>>,
    /// The extrapolated point, and its velocities.
    y: Vec<Vector<D>>,
    u_y: Vec<Vector<D>>,
    /// The point that the gradient at y leads to, and its velocities.
    next: Vec<Vector<D>>,
    u_next: Vec<Vector<D>>,
}

/// How far the iterate is from the solution, relative to the size of its impulses.
struct Distance {
    size: f64,
    /// From that of the convex problem with the shift held.
    convex: f64,
    /// From that of the law that is solved.
    law: f64,
}

impl<const D: usize> Apgd<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "apgd";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Iterates from `start` and leaves the best in it; with the convex law the shift stays 0 and
    /// the convex residual counts.
    pub(crate) fn iterate(
        &mut self,
        problem: &ContactProblem<'_, D>,
        stop: &Stop<'_>,
        start: &mut [Vector<D>],
        law: Law,
    ) -> (Status, u32) {
        let Self { gathered, at, best } = self;
        let rho = problem.scale();
        let q_norm = rho * problem.q_norm();
        let posed = Posed { problem, h: Operator::new(problem, gathered), law, rho, q_norm };
        at.start(&posed, start);
        best.clear();
        best.extend_from_slice(start);
        let (mut best_residual, mut best_at, mut iterations) = (f64::INFINITY, 0, 0);
        let ended = loop {
            if iterations % CHECK == 0 || iterations >= stop.max_iterations {
                let distance = at.distance(&posed);
                if distance.law < best_residual {
                    (best_residual, best_at) = (distance.law, iterations);
                    best.copy_from_slice(&at.p);
                }
                if at.solves(&posed, &distance, stop.tolerance) {
                    break Status::Converged;
                }
                if !distance.law.is_finite() {
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
                at.renew_shift(&posed, &distance);
            }
            iterations += 1;
            at.descend(&posed);
            at.accelerate();
        };
        if ended != Status::Breakdown || best_residual.is_finite() {
            start.copy_from_slice(if ended == Status::Converged { &at.p } else { best });
        }
        (ended, iterations)
    }
}

impl<const D: usize> Posed<'_, D> {
    fn velocities(&self, p: &[Vector<D>], u: &mut [Vector<D>]) {
        for (i, u) in u.iter_mut().enumerate() {
            *u = self.h.velocity(i, self.problem.q(), p);
        }
    }

    /// De Saxcé's shift of a contact.
    fn slip(&self, p: &Vector<D>, u: &Vector<D>, mu: f64) -> f64 {
        if self.law == Law::Convex { 0.0 } else { slip_shift(p, u, mu) }
    }
}

impl<const D: usize> Iterate<D> {
    fn vectors(&mut self) -> [&mut Vec<Vector<D>>; 6] {
        [&mut self.p, &mut self.u, &mut self.y, &mut self.u_y, &mut self.next, &mut self.u_next]
    }

    /// All points at `start`, with the shift of its slips.
    fn start(&mut self, posed: &Posed<'_, D>, start: &[Vector<D>]) {
        let (n, mu) = (start.len(), posed.problem.mu());
        self.own.clear();
        self.own.extend((0..n).map(|i| own_step(posed.problem, i)));
        for vectors in self.vectors() {
            vectors.clear();
            vectors.extend_from_slice(start);
        }
        posed.velocities(&self.p, &mut self.u);
        self.u_y.copy_from_slice(&self.u);
        let (p, u) = (&self.p, &self.u);
        self.shift.clear();
        // A very large μ on a contact without impulse would hold it open: there the convex law
        // comes first.
        let shift = |i: usize| if mu[i] > STEEP && p[i][0] <= 0.0 { 0.0 } else { posed.slip(&p[i], &u[i], mu[i]) };
        self.shift.extend((0..n).map(shift));
        (self.step, self.theta) = (1.0, 1.0);
    }

    fn distance(&self, posed: &Posed<'_, D>) -> Distance {
        let (p, u, mu, rho) = (&self.p, &self.u, posed.problem.mu(), posed.rho);
        let size = p.iter().map(Vector::norm_squared).sum::<f64>().sqrt().max(posed.q_norm).max(f64::MIN_POSITIVE);
        let convex = convex_map(p, u, &self.shift, mu, rho) / size;
        let law = if posed.law == Law::Convex { convex } else { natural_map(p, u, mu, rho) / size };
        Distance { size, convex, law }
    }

    /// Whether the law is solved to the tolerance; of the exact law the judge has the last word.
    fn solves(&self, posed: &Posed<'_, D>, distance: &Distance, tolerance: f64) -> bool {
        let (mu, exact) = (posed.problem.mu(), posed.law == Law::Exact);
        let small = distance.law <= tolerance
            || (exact && is_steep(mu) && disk_map(&self.p, &self.u, mu, posed.rho) <= tolerance * distance.size);
        small && (!exact || judge(posed.problem, &self.p).global <= tolerance)
    }

    /// Renews the shift where the convex problem is solved as well as is worth while with the one
    /// held.
    fn renew_shift(&mut self, posed: &Posed<'_, D>, distance: &Distance) {
        let mu = posed.problem.mu();
        // A large μ inflates the residual by the smallest slip: there the law taken apart is
        // compared with.
        let exact = if is_steep(mu) { disk_map(&self.p, &self.u, mu, posed.rho) / distance.size } else { distance.law };
        if posed.law == Law::Exact && distance.convex <= ENOUGH * exact {
            for i in 0..self.p.len() {
                self.shift[i] = posed.slip(&self.p[i], &self.u[i], mu[i]);
            }
        }
    }

    /// The gradient of the convex problem at y.
    #[inline]
    fn gradient(&self, i: usize) -> Vector<D> {
        let mut gradient = self.u_y[i];
        gradient[0] += self.shift[i];
        gradient
    }

    /// From y along the gradient onto the cones, by a step that is cut until the curvature on the
    /// way allows it.
    fn descend(&mut self, posed: &Posed<'_, D>) {
        let (q, mu) = (posed.problem.q(), posed.problem.mu());
        for _ in 0..MOST_CUTS {
            for i in 0..self.p.len() {
                self.next[i] = project(&(self.y[i] - self.gradient(i) * (self.step * self.own[i])), mu[i]);
            }
            let (mut curvature, mut way) = (0.0, 0.0);
            for i in 0..self.p.len() {
                self.u_next[i] = posed.h.velocity(i, q, &self.next);
                let d = self.next[i] - self.y[i];
                curvature += d.dot(&(self.u_next[i] - self.u_y[i]));
                way += d.norm_squared() / self.own[i];
            }
            if self.step * curvature <= way {
                break;
            }
            self.step *= SHRINK;
        }
    }

    /// Goes to the point found, and extrapolates beyond it by Nesterov's momentum.
    fn accelerate(&mut self) {
        let n = self.p.len();
        // The gradient at y along the step taken: uphill, the momentum is forgotten.
        let uphill = (0..n).fold(0.0, |sum, i| sum + self.gradient(i).dot(&(self.next[i] - self.p[i])));
        let squared = self.theta * self.theta;
        let mut theta_next = 0.5 * (-squared + self.theta * (squared + 4.0).sqrt());
        let mut momentum = self.theta * (1.0 - self.theta) / (squared + theta_next);
        if uphill > 0.0 {
            (theta_next, momentum) = (1.0, 0.0);
        }
        self.theta = theta_next;
        for i in 0..n {
            self.y[i] = self.next[i] + (self.next[i] - self.p[i]) * momentum;
            self.u_y[i] = self.u_next[i] + (self.u_next[i] - self.u[i]) * momentum;
        }
        std::mem::swap(&mut self.p, &mut self.next);
        std::mem::swap(&mut self.u, &mut self.u_next);
        self.step *= GROW;
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
        reserve(&mut self.at.own, contacts);
        reserve(&mut self.at.shift, contacts);
        for vectors in self.at.vectors() {
            reserve(vectors, contacts);
        }
        reserve(&mut self.best, contacts);
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
