//! Projection (extragradient) method with a step that adapts itself.
//!
//! **Solves** the exact Coulomb law, 2D and 3D, any Delassus operator (an operator that is only a
//! product stays one). It takes the law as a (quasi-)variational inequality: `p = Π(p − τ u(p))`
//! for any step τ > 0. An iteration is a predictor `p̄ = Π(p − τ u(p))` and a corrector; the step
//! is cut by 2/3 until `τ ‖u(p̄) − u(p)‖ ≤ 0.9 ‖p̄ − p‖` (Khobotov 1987, doi
//! 10.1016/0041-5553(87)90058-9) and grown by 3/2 where that ratio is below 0.3. The method and its
//! constants are those of Siconos' `VI_EG` (Acary, Brémond and Huber 2018, doi
//! 10.1007/978-3-319-75972-2_10).
//!
//! **Departures.**
//! - The projection is Alart and Curnier's, normal and tangential part apart, not De Saxcé's shift
//!   with a projection onto the cone. Both have the same fixed points; the shift's slope grows with
//!   μ, and the step would have to shrink with it.
//! - Each contact has a step of its own, τ over the mean diagonal of its block, and norms are taken
//!   in that metric: contacts of light and heavy bodies then move alike.
//! - The corrector starts from the predictor, `Π(p̄ − τ u(p̄))`: two projection steps for one test.
//!   That is what Siconos' code does, and takes half the products of Khobotov's `Π(p − τ u(p̄))`,
//!   which is what converges for strongly asymmetric H. So if the residual doesn't fall for some
//!   time, Khobotov's corrector takes over.
//! - Stops by the judge's residual. The best impulses met are kept.
//!
//! **Take it** for low accuracy (1e-4) on many contacts, where nothing is to be factorised.
//! **Cost**: two products with H an iteration. Capsules-i100 (276 contacts) takes 25 iterations to
//! 1e-4, Spheres-i099 (356) 114 to 1e-4 and 700 to 1e-12, KaplasTower (570) 275 to 1e-4,
//! OneObject-i1028 (23) 190 and 5100; Siconos' `VI_EG` 110, 206 and 1011, 805, 1263 and 30 270.
//! **Fails** slowly: the number of iterations grows with the condition of H. Stacks and packings at
//! 1e-8 can take 10⁵: BoxesStack1 and Capsules-i100 aren't solved to 1e-8. A block whose own
//! diagonal is badly scaled is not preconditioned: one step serves a contact's normal and tangent.

use crate::memory::reserve;
use crate::operator::{Operator, is_steep, natural_map, onto_disk, own_step};
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Status, Stop, Vector, judge};

/// Largest ratio τ‖Δu‖/‖Δp‖ of a step that is taken; one that is below [`SMALL`] lets the step
/// grow.
const LARGE: f64 = 0.9;
/// See [`LARGE`].
const SMALL: f64 = 0.3;
/// The factor by which the step shrinks, and its inverse by which it grows.
const SHRINK: f64 = 2.0 / 3.0;
/// Most cuts of the step in one iteration; 2/3 to this power is below the rounding of any ratio.
const MOST_CUTS: u32 = 100;
/// The residual is computed every so many iterations, and where the step itself is small enough.
const CHECK: u32 = 16;
/// Iterations without a better residual after which Khobotov's corrector takes over, and after
/// which, with it, the iteration counts as stalled.
const PATIENCE: u32 = 4000;

/// The projection solver; see its [page](self). `iterations` counts predictor–corrector pairs.
#[derive(Clone, Debug, Default)]
pub struct ViEg<const D: usize> {
    gathered: BlockSparse<D>,
    /// Each contact's own step, and its inverse.
    own: Vec<f64>,
    compliance: Vec<f64>,
    p: Vec<Vector<D>>,
    predicted: Vec<Vector<D>>,
    corrected: Vec<Vector<D>>,
    u: Vec<Vector<D>>,
    best: Vec<Vector<D>>,
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
        reserve(&mut self.own, contacts);
        reserve(&mut self.compliance, contacts);
        for vectors in [&mut self.p, &mut self.predicted, &mut self.corrected, &mut self.u, &mut self.best] {
            reserve(vectors, contacts);
        }
    }

    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, start: &mut [Vector<D>]) -> Outcome {
        let Self { gathered, own, compliance, p, predicted, corrected, u, best } = self;
        let h = Operator::new(problem, gathered);
        let (n, q, mu, rho) = (problem.contacts(), problem.q(), problem.mu(), problem.scale());
        own.clear();
        own.extend((0..n).map(|i| own_step(problem, i)));
        compliance.clear();
        compliance.extend(own.iter().map(|step| step.recip()));
        for vectors in [&mut *p, predicted, corrected, u, best] {
            vectors.clear();
            vectors.extend_from_slice(start);
        }
        let q_norm = rho * q.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        for i in 0..n {
            u[i] = h.velocity(i, q, p);
        }
        let (mut step, mut khobotov) = (1.0, false);
        let (mut best_residual, mut best_at, mut iterations) = (f64::INFINITY, 0, 0);
        let ended = loop {
            let mut predictor = predict(p, u, own, compliance, mu, step, predicted);
            let size = predictor.p_norm.max(q_norm).max(f64::MIN_POSITIVE);
            let near = rho * predictor.velocity_like <= 2.0 * stop.tolerance * size;
            if near || iterations % CHECK == 0 || iterations >= stop.max_iterations {
                let residual = natural_map(p, u, mu, rho) / size;
                if residual < best_residual {
                    (best_residual, best_at) = (residual, iterations);
                    best.copy_from_slice(p);
                }
                let small = residual <= stop.tolerance || (near && is_steep(mu));
                if small && judge(problem, p).global <= stop.tolerance {
                    break Status::Converged;
                }
                if !residual.is_finite() {
                    break Status::Breakdown;
                }
                if iterations >= stop.max_iterations {
                    break Status::MaxIterations;
                }
                if stop.cancelled() {
                    break Status::Cancelled;
                }
                if iterations - best_at >= PATIENCE {
                    if khobotov {
                        break Status::Stalled;
                    }
                    khobotov = true;
                    best_at = iterations;
                }
            }
            iterations += 1;
            for _ in 0..MOST_CUTS {
                let mut change = 0.0;
                for i in 0..n {
                    let u_predicted = h.velocity(i, q, predicted);
                    change += own[i] * (u_predicted - u[i]).norm_squared();
                    let from = if khobotov { &p[i] } else { &predicted[i] };
                    corrected[i] = onto_disk(&(from - u_predicted * (step * own[i])), mu[i]);
                }
                let ratio = step * (change / predictor.way.max(f64::MIN_POSITIVE)).sqrt();
                if ratio > LARGE {
                    step *= SHRINK;
                    predictor = predict(p, u, own, compliance, mu, step, predicted);
                } else {
                    if ratio < SMALL {
                        step /= SHRINK;
                    }
                    break;
                }
            }
            std::mem::swap(p, corrected);
            for i in 0..n {
                u[i] = h.velocity(i, q, p);
            }
        };
        if ended != Status::Breakdown || best_residual.is_finite() {
            start.copy_from_slice(if ended == Status::Converged { p } else { best });
        }
        Outcome::new(ended, Self::NAME, iterations, judge(problem, start))
    }

    fn fork(&self) -> Box<dyn ContactSolver<D>> {
        Box::new(Self::new())
    }
}

/// What is measured on the way of a predictor.
struct Predictor {
    /// ‖p̄ − p‖² in the contacts' metric.
    way: f64,
    /// ‖p‖.
    p_norm: f64,
    /// ‖(p̄ − p)/τ‖, τ contact by contact: what is left of the velocities.
    velocity_like: f64,
}

fn predict<const D: usize>(
    p: &[Vector<D>],
    u: &[Vector<D>],
    own: &[f64],
    compliance: &[f64],
    mu: &[f64],
    step: f64,
    predicted: &mut [Vector<D>],
) -> Predictor {
    let (mut way, mut p_norm, mut velocity_like) = (0.0, 0.0, 0.0);
    for i in 0..predicted.len() {
        predicted[i] = onto_disk(&(p[i] - u[i] * (step * own[i])), mu[i]);
        let share = (predicted[i] - p[i]).norm_squared() * compliance[i];
        way += share;
        velocity_like += share * compliance[i];
        p_norm += p[i].norm_squared();
    }
    Predictor { way, p_norm: p_norm.sqrt(), velocity_like: velocity_like.sqrt() / step }
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
