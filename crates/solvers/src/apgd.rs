//! Accelerated projected gradients (APGD), with De Saxcé's shift in an outer loop.
//!
//! **Solves** the exact Coulomb law, 2D and 3D. With a fixed shift s_i = μ_i ‖u_T,i‖, the law is
//! the optimality condition of a convex problem, `min ½ pᵀHp + (q + s)ᵀp` over the cones ‖p_T‖ ≤ μ
//! p_N (s acts on the normal components). Nesterov's method solves it (Mazhar, Heyn, Negrut and
//! Tasora 2015, doi 10.1145/2735627), and the shift is updated in between.
//!
//! **Departures.**
//! - The paper solves the convex law (s = 0) only; the outer loop is Acary and Cadoux's fixed point
//!   (2011, doi 10.1002/zamm.201000073). The shift is updated as soon as the residual of the convex
//!   problem is half that of the exact law, as solving further with a wrong shift would be wasted
//!   work.
//! - With μ above 100 a sticking contact has no shift, whatever its remaining slip; else the fixed
//!   point couldn't contract.
//! - Restart of the momentum by the sign of gradient times step (O'Donoghue and Candès 2015, doi
//!   10.1007/s10208-013-9150-3), as in the paper.
//! - The step is checked by `dᵀH d ≤ ‖d‖²/τ` instead of differences of the objective, which cancel
//!   near the solution; each contact's step is scaled by the mean diagonal of its block.
//! - H y is a combination of known products, so an iteration takes one product with H, not two.
//!
//! **When to use it**: for large, loosely packed problems at 1e-4 without factorisation, or for the
//! convex law.
//! **Cost**: one product with H per iteration. KaplasTower (570 contacts) takes 550 iterations to
//! 1e-4 and 1300 to 1e-12, spheres-in-a-box 24 000 to 1e-12 (no solver of Siconos gets there within
//! 10 s), RockPile 930 to 1e-4, Capsules-i101 1000 to 1e-8.
//! **How it fails**: it is slow for blocks with a badly scaled diagonal, as normal and tangent have
//! the same step. With large μ the outer loop may not contract, and it ends as `stalled` or out of
//! iterations. A skew part of H isn't part of the objective: a small one does no harm, a large one
//! may.

use crate::ending::unsolved;
use crate::memory::reserve;
use crate::operator::{
    Operator, VERY_LARGE_FRICTION, disk_map, has_very_large_friction, natural_map, own_step, slip_shift,
};
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Status, Stop, Vector, judge, project};

/// Number of iterations between comparisons of the exact and the convex residual.
const CHECK: u32 = 4;
/// The shift is updated once the convex residual is below this fraction of the exact one.
const CONVEX_PART: f64 = 0.5;
/// The factors by which the step shrinks if it was too long, and grows otherwise: the paper's 1/2
/// and 1/0.9.
const SHRINK: f64 = 0.5;
/// See [`SHRINK`].
const GROW: f64 = 1.0 / 0.9;
/// Largest number of step reductions in one iteration.
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

/// The problem, with its operator in the form for many products.
struct ProblemData<'a, const D: usize> {
    problem: &'a ContactProblem<'a, D>,
    h: Operator<'a, D>,
    law: Law,
    rho: f64,
    /// ρ‖q‖, the lower bound of the scale of residuals.
    q_norm: f64,
}

/// The state of the iteration.
#[derive(Clone, Debug, Default)]
struct Iterate<const D: usize> {
    /// The step of each contact in isolation, and the common factor.
    own: Vec<f64>,
    step: f64,
    /// Nesterov's θ, which gives the momentum.
    theta: f64,
    shift: Vec<f64>,
    p: Vec<Vector<D>>,
    u: Vec<Vector<D>>,
    /// The extrapolated point y, and its velocities.
    y: Vec<Vector<D>>,
    u_y: Vec<Vector<D>>,
    /// The next point, from the gradient at y, and its velocities.
    next: Vec<Vector<D>>,
    u_next: Vec<Vector<D>>,
}

/// The residuals of the iterate, relative to the magnitude of its impulses.
struct Residuals {
    size: f64,
    /// Of the convex problem with the current shift.
    convex: f64,
    /// Of the law to be solved.
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

    /// Iterates from `start` and leaves the best impulses in it; with the convex law the shift
    /// stays 0 and the convex residual counts.
    pub(crate) fn iterate(
        &mut self,
        problem: &ContactProblem<'_, D>,
        stop: &Stop<'_>,
        start: &mut [Vector<D>],
        law: Law,
    ) -> (Status, u32) {
        let Self { gathered, at, best } = self;
        let data = ProblemData::new(problem, gathered, law);
        at.start(&data, start);
        best.clear();
        best.extend_from_slice(start);
        let (mut best_residual, mut best_at, mut iterations) = (f64::INFINITY, 0, 0);
        let ended = loop {
            if iterations % CHECK == 0 || iterations >= stop.max_iterations {
                let residuals = at.residuals(&data);
                if residuals.law < best_residual {
                    (best_residual, best_at) = (residuals.law, iterations);
                    best.copy_from_slice(&at.p);
                }
                if at.solves(&data, &residuals, stop.tolerance) {
                    break Status::Converged;
                }
                if let Some(status) = unsolved(stop, iterations, iterations - best_at, PATIENCE, residuals.law) {
                    break status;
                }
                at.update_shift(&data, &residuals);
            }
            iterations += 1;
            at.descend(&data);
            at.accelerate();
        };
        if ended != Status::Breakdown || best_residual.is_finite() {
            start.copy_from_slice(if ended == Status::Converged { &at.p } else { best });
        }
        (ended, iterations)
    }
}

impl<'a, const D: usize> ProblemData<'a, D> {
    fn new(problem: &'a ContactProblem<'a, D>, gathered: &'a mut BlockSparse<D>, law: Law) -> Self {
        let rho = problem.scale();
        Self { problem, h: Operator::new(problem, gathered), law, rho, q_norm: rho * problem.q_norm() }
    }

    fn velocities(&self, p: &[Vector<D>], u: &mut [Vector<D>]) {
        self.h.velocities(self.problem.q(), p, u);
    }

    /// De Saxcé's shift at a contact.
    fn slip(&self, p: &Vector<D>, u: &Vector<D>, mu: f64) -> f64 {
        if self.law == Law::Convex { 0.0 } else { slip_shift(p, u, mu) }
    }
}

impl<const D: usize> Iterate<D> {
    fn vectors(&mut self) -> [&mut Vec<Vector<D>>; 6] {
        [&mut self.p, &mut self.u, &mut self.y, &mut self.u_y, &mut self.next, &mut self.u_next]
    }

    /// Sets all points to `start`, with the shift of its slip.
    fn start(&mut self, data: &ProblemData<'_, D>, start: &[Vector<D>]) {
        let (n, mu) = (start.len(), data.problem.mu());
        self.own.clear();
        self.own.extend((0..n).map(|i| own_step(data.problem, i)));
        for vectors in self.vectors() {
            vectors.clear();
            vectors.extend_from_slice(start);
        }
        data.velocities(&self.p, &mut self.u);
        self.u_y.copy_from_slice(&self.u);
        let (p, u) = (&self.p, &self.u);
        self.shift.clear();
        // A very large μ at a contact without impulse would keep it open; there the shift starts
        // from zero.
        let shift =
            |i: usize| if mu[i] > VERY_LARGE_FRICTION && p[i][0] <= 0.0 { 0.0 } else { data.slip(&p[i], &u[i], mu[i]) };
        self.shift.extend((0..n).map(shift));
        (self.step, self.theta) = (1.0, 1.0);
    }

    fn residuals(&self, data: &ProblemData<'_, D>) -> Residuals {
        let (p, u, mu, rho) = (&self.p, &self.u, data.problem.mu(), data.rho);
        let size = p.iter().map(Vector::norm_squared).sum::<f64>().sqrt().max(data.q_norm).max(f64::MIN_POSITIVE);
        let convex = convex_map(p, u, &self.shift, mu, rho) / size;
        let law = if data.law == Law::Convex { convex } else { natural_map(p, u, mu, rho) / size };
        Residuals { size, convex, law }
    }

    /// Whether the law is solved to the tolerance, for the exact law by the judge.
    fn solves(&self, data: &ProblemData<'_, D>, residuals: &Residuals, tolerance: f64) -> bool {
        let (mu, exact) = (data.problem.mu(), data.law == Law::Exact);
        let small = residuals.law <= tolerance
            || (exact
                && has_very_large_friction(mu)
                && disk_map(&self.p, &self.u, mu, data.rho) <= tolerance * residuals.size);
        small && (!exact || judge(data.problem, &self.p).global <= tolerance)
    }

    /// Updates the shift if the convex problem is solved well enough with the current one.
    fn update_shift(&mut self, data: &ProblemData<'_, D>, residuals: &Residuals) {
        let mu = data.problem.mu();
        // A large μ inflates the residual by the smallest slip; then the map with separate normal
        // and tangential parts is used for the comparison.
        let exact = if has_very_large_friction(mu) {
            disk_map(&self.p, &self.u, mu, data.rho) / residuals.size
        } else {
            residuals.law
        };
        if data.law == Law::Exact && residuals.convex <= CONVEX_PART * exact {
            for i in 0..self.p.len() {
                self.shift[i] = data.slip(&self.p[i], &self.u[i], mu[i]);
            }
        }
    }

    /// Steps from y along the gradient and projects onto the cones; the step is reduced until the
    /// curvature allows it.
    fn descend(&mut self, data: &ProblemData<'_, D>) {
        for _ in 0..MOST_CUTS {
            let Self { own, step, shift, y, u_y, next, .. } = self;
            let at = y.iter().zip(&*u_y).zip(&*shift).zip(&*own).zip(data.problem.mu());
            for (next, ((((y, u_y), shift), own), mu)) in next.iter_mut().zip(at) {
                let mut gradient = *u_y;
                gradient[0] += shift;
                *next = project(&(y - gradient * (*step * own)), *mu);
            }
            data.velocities(&self.next, &mut self.u_next);
            let (mut curvature, mut way) = (0.0, 0.0);
            let steps = self.next.iter().zip(&self.y).zip(self.u_next.iter().zip(&self.u_y)).zip(&self.own);
            for (((next, y), (u_next, u_y)), own) in steps {
                let d = next - y;
                curvature += d.dot(&(u_next - u_y));
                way += d.norm_squared() / own;
            }
            if self.step * curvature <= way {
                break;
            }
            self.step *= SHRINK;
        }
    }

    /// Moves to the next point, and extrapolates by Nesterov's momentum.
    fn accelerate(&mut self) {
        // If the step goes uphill by the gradient at y, the momentum is reset.
        let mut uphill = 0.0;
        for (((next, p), u_y), shift) in self.next.iter().zip(&self.p).zip(&self.u_y).zip(&self.shift) {
            let mut gradient = *u_y;
            gradient[0] += shift;
            uphill += gradient.dot(&(next - p));
        }
        let squared = self.theta * self.theta;
        let mut theta_next = 0.5 * (-squared + self.theta * (squared + 4.0).sqrt());
        let mut momentum = self.theta * (1.0 - self.theta) / (squared + theta_next);
        if uphill > 0.0 {
            (theta_next, momentum) = (1.0, 0.0);
        }
        self.theta = theta_next;
        let extrapolate = |ahead: &mut [Vector<D>], next: &[Vector<D>], last: &[Vector<D>]| {
            for (ahead, (next, last)) in ahead.iter_mut().zip(next.iter().zip(last)) {
                *ahead = next + (next - last) * momentum;
            }
        };
        extrapolate(&mut self.y, &self.next, &self.p);
        extrapolate(&mut self.u_y, &self.u_next, &self.u);
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

/// The natural map of the convex problem with a fixed shift.
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
