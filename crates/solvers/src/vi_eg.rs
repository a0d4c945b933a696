//! Projection (extragradient) method with an adaptive step.
//!
//! **Solves** the exact Coulomb law, 2D and 3D, for any Delassus operator; a matrix-free one isn't
//! formed. The law is written as a (quasi-)variational inequality: `p = Π(p − τ u(p))` for any step
//! τ > 0. An iteration is a predictor `p̄ = Π(p − τ u(p))` and a corrector; the step is reduced by
//! 2/3 until `τ ‖u(p̄) − u(p)‖ ≤ 0.9 ‖p̄ − p‖` (Khobotov 1987, doi 10.1016/0041-5553(87)90058-9)
//! and increased by 3/2 if this ratio is below 0.3. The method and its constants are those of
//! Siconos' `VI_EG` (Acary, Brémond and Huber 2018, doi 10.1007/978-3-319-75972-2_10).
//!
//! **Departures.**
//! - The projection is Alart and Curnier's, with separate normal and tangential parts, instead of
//!   De Saxcé's shift with a projection onto the cone. Both have the same fixed points, but the
//!   slope of the shift grows with μ, and the step would have to shrink with it.
//! - Each contact has its own step, τ over the mean diagonal of its block, and norms use this
//!   metric, so contacts of light and heavy bodies move alike.
//! - The corrector starts from the predictor, `Π(p̄ − τ u(p̄))`: two projection steps per check.
//!   Siconos does the same. It takes half the products of Khobotov's `Π(p − τ u(p̄))`, but only the
//!   latter converges for strongly asymmetric H. So if the residual doesn't decrease for some time,
//!   the method switches to Khobotov's corrector.
//! - The iteration stops by the common residual and returns the best impulses found.
//!
//! **When to use it**: for low accuracy (1e-4) on many contacts without factorisation.
//! **Cost**: two products with H per iteration. Capsules-i100 (276 contacts) takes 25 iterations to
//! 1e-4, Spheres-i099 (356) 114 to 1e-4 and 700 to 1e-12, KaplasTower (570) 275 to 1e-4,
//! OneObject-i1028 (23) 190 and 5100; Siconos' `VI_EG` 110, 206 and 1011, 805, 1263 and 30 270.
//! **How it fails**: the number of iterations grows with the condition of H. Stacks and packings at
//! 1e-8 can take 10⁵: BoxesStack1 and Capsules-i100 aren't solved to 1e-8. A block with a badly
//! scaled diagonal isn't preconditioned, as normal and tangent have the same step.

use crate::ending::unsolved;
use crate::memory::reserve;
use crate::operator::{Operator, has_very_large_friction, natural_map, onto_disk, own_step};
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Status, Stop, Vector, judge};

/// Largest ratio τ‖Δu‖/‖Δp‖ of an accepted step; below [`SMALL`] the step grows.
const LARGE: f64 = 0.9;
/// See [`LARGE`].
const SMALL: f64 = 0.3;
/// The factor by which the step shrinks, and its inverse by which it grows.
const SHRINK: f64 = 2.0 / 3.0;
/// Largest number of step reductions in one iteration; 2/3 to this power is below the rounding of
/// any ratio.
const MOST_CUTS: u32 = 100;
/// Number of iterations between residuals; a residual is also computed if the step itself is small
/// enough.
const CHECK: u32 = 16;
/// Iterations without a better residual after which the method switches to Khobotov's corrector,
/// and with it counts as stalled.
const PATIENCE: u32 = 4000;

/// The projection solver; see its [page](self). `iterations` counts predictor–corrector pairs.
#[derive(Clone, Debug, Default)]
pub struct ViEg<const D: usize> {
    gathered: BlockSparse<D>,
    at: Extragradient<D>,
    best: Vec<Vector<D>>,
}

/// The state of the iteration.
#[derive(Clone, Debug, Default)]
struct Extragradient<const D: usize> {
    /// The step of each contact in isolation, its inverse, and the common factor τ.
    own: Vec<f64>,
    compliance: Vec<f64>,
    step: f64,
    /// Whether Khobotov's corrector is used.
    khobotov: bool,
    p: Vec<Vector<D>>,
    u: Vec<Vector<D>>,
    predicted: Vec<Vector<D>>,
    corrected: Vec<Vector<D>>,
}

impl<const D: usize> ViEg<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "vi-eg";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
}

impl<const D: usize> ContactSolver<D> for ViEg<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.gathered.reserve(contacts, blocks);
        reserve(&mut self.at.own, contacts);
        reserve(&mut self.at.compliance, contacts);
        for vectors in self.at.vectors() {
            reserve(vectors, contacts);
        }
        reserve(&mut self.best, contacts);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, start: &mut [Vector<D>]) -> Outcome {
        let Self { gathered, at, best } = self;
        let h = Operator::new(problem, gathered);
        let (q, mu, rho) = (problem.q(), problem.mu(), problem.scale());
        at.start(problem, &h, start);
        best.clear();
        best.extend_from_slice(start);
        let q_norm = rho * q.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        let (mut best_residual, mut best_at, mut iterations) = (f64::INFINITY, 0, 0);
        let ended = loop {
            let predictor = at.predict(mu);
            let size = predictor.p_norm.max(q_norm).max(f64::MIN_POSITIVE);
            let near = rho * predictor.velocity_like <= 2.0 * stop.tolerance * size;
            if near || iterations % CHECK == 0 || iterations >= stop.max_iterations {
                let residual = natural_map(&at.p, &at.u, mu, rho) / size;
                if residual < best_residual {
                    (best_residual, best_at) = (residual, iterations);
                    best.copy_from_slice(&at.p);
                }
                let small = residual <= stop.tolerance || (near && has_very_large_friction(mu));
                if small && judge(problem, &at.p).global <= stop.tolerance {
                    break Status::Converged;
                }
                if let Some(status) = unsolved(stop, iterations, 0, PATIENCE, residual) {
                    break status;
                }
                if iterations - best_at >= PATIENCE {
                    if at.khobotov {
                        break Status::Stalled;
                    }
                    at.khobotov = true;
                    best_at = iterations;
                }
            }
            iterations += 1;
            at.correct(&h, q, mu, predictor);
        };
        if ended != Status::Breakdown || best_residual.is_finite() {
            start.copy_from_slice(if ended == Status::Converged { &at.p } else { best });
        }
        Outcome::new(ended, Self::NAME, iterations, judge(problem, start))
    }

    fn fork(&self) -> Box<dyn ContactSolver<D>> {
        Box::new(Self::new())
    }
}

/// Quantities computed with a predictor.
struct Predictor {
    /// ‖p̄ − p‖² in the contacts' metric.
    way: f64,
    /// ‖p‖.
    p_norm: f64,
    /// ‖(p̄ − p)/τ‖ with the τ of each contact: the residual velocities.
    velocity_like: f64,
}

impl<const D: usize> Extragradient<D> {
    fn vectors(&mut self) -> [&mut Vec<Vector<D>>; 4] {
        [&mut self.p, &mut self.u, &mut self.predicted, &mut self.corrected]
    }

    /// Sets all points to `start`.
    fn start(&mut self, problem: &ContactProblem<'_, D>, h: &Operator<'_, D>, start: &[Vector<D>]) {
        self.own.clear();
        self.own.extend((0..start.len()).map(|i| own_step(problem, i)));
        self.compliance.clear();
        self.compliance.extend(self.own.iter().map(|step| step.recip()));
        for vectors in self.vectors() {
            vectors.clear();
            vectors.extend_from_slice(start);
        }
        self.update_velocities(h, problem.q());
        (self.step, self.khobotov) = (1.0, false);
    }

    fn update_velocities(&mut self, h: &Operator<'_, D>, q: &[Vector<D>]) {
        for i in 0..self.p.len() {
            self.u[i] = h.velocity(i, q, &self.p);
        }
    }

    /// The predictor p̄ = Π(p − τ u(p)).
    fn predict(&mut self, mu: &[f64]) -> Predictor {
        let (mut way, mut p_norm, mut velocity_like) = (0.0, 0.0, 0.0);
        for i in 0..self.predicted.len() {
            self.predicted[i] = onto_disk(&(self.p[i] - self.u[i] * (self.step * self.own[i])), mu[i]);
            let share = (self.predicted[i] - self.p[i]).norm_squared() * self.compliance[i];
            way += share;
            velocity_like += share * self.compliance[i];
            p_norm += self.p[i].norm_squared();
        }
        Predictor { way, p_norm: p_norm.sqrt(), velocity_like: velocity_like.sqrt() / self.step }
    }

    /// The corrector; the step is reduced, with a new predictor, until τ‖Δu‖/‖Δp‖ is small enough.
    fn correct(&mut self, h: &Operator<'_, D>, q: &[Vector<D>], mu: &[f64], mut predictor: Predictor) {
        for _ in 0..MOST_CUTS {
            let mut change = 0.0;
            for i in 0..self.p.len() {
                let u_predicted = h.velocity(i, q, &self.predicted);
                change += self.own[i] * (u_predicted - self.u[i]).norm_squared();
                let from = if self.khobotov { &self.p[i] } else { &self.predicted[i] };
                self.corrected[i] = onto_disk(&(from - u_predicted * (self.step * self.own[i])), mu[i]);
            }
            let ratio = self.step * (change / predictor.way.max(f64::MIN_POSITIVE)).sqrt();
            if ratio > LARGE {
                self.step *= SHRINK;
                predictor = self.predict(mu);
            } else {
                if ratio < SMALL {
                    self.step /= SHRINK;
                }
                break;
            }
        }
        std::mem::swap(&mut self.p, &mut self.corrected);
        self.update_velocities(h, q);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conforming::conforms_but_for_uneven_scales;

    #[test]
    fn conforms_to_its_tolerance() {
        conforms_but_for_uneven_scales(&mut ViEg::new(), &mut ViEg::new());
    }
}
