//! Alternating directions (ADMM) with an adaptive penalty and Anderson acceleration.
//!
//! **Solves** the exact Coulomb law, 2D and 3D. The impulses are split into x, for which H is
//! solved, and z, which satisfies the law. With Σ = β diag(h_i), h_i the mean diagonal of contact
//! i's block, and the multiplier w,
//!
//! ```text
//! (H + Σ) x = Σ (z − w) − q,    v = α x + (1 − α) z + w,    z = C(v),    w = v − z        α = 1.6
//! ```
//!
//! (Boyd et al. 2011, doi 10.1561/2200000016; for contact Acary, Brémond and Huber 2018, doi
//! 10.1007/978-3-319-75972-2_10, and Siconos' `ADMM`.) C solves the law of each contact for a
//! multiple of the identity: `z_N = max(v_N, 0)`, and `z_T` is the projection of v_T onto the disk
//! of radius `μ z_N`. At the fixed point `u = −Σ w`.
//!
//! **Departures.**
//! - C solves the exact law, while the papers project onto the cone with De Saxcé's shift as data.
//!   So nothing lags, and μ doesn't affect the conditioning.
//! - Each contact has its own penalty, so heavy and light bodies are balanced alike, and units of
//!   mass and speed cancel.
//! - The step of x is solved as a correction, `(S + Σ)(x − z) = −(H z + q + Σ w)`, with S the
//!   symmetric part of H. One Cholesky factorisation works for asymmetric H too (its skew part lags
//!   by one iteration), and the residual needs `H z + q` anyway.
//! - β is balanced by the ratio of primal to dual residual over rounds of growing length, and only
//!   if it is off by more than 2, as each change requires a factorisation.
//! - The iteration `v → v + α (x − z)` is accelerated by Anderson's method (8 differences); a step
//!   that doubles the residual of the fixed point is undone.
//!
//! **When to use it**: for hyperstatic problems (walls, towers, stacks) of up to some thousand
//! contacts, and for accuracies beyond 1e-4 on problems where projections are slow.
//! **Cost**: a few factorisations ([`Admm::factorisations`]); an iteration is a product with H and
//! two triangular solves. Ordering and analysis are kept for equal patterns; uncoupled contacts
//! cause no fill-in. A matrix-free operator is formed first. To 1e-12, OneObject-i1028 (23
//! contacts) takes 340 iterations, BoxesStack1 (52) 135, LMGC_100_PR_PerioBox (60) 66, KaplasTower
//! (570) 30, Spheres-i099 (356) 72, Capsules-i100 (276) 810; Siconos' `ADMM` 4475, 2242, never, 17,
//! 363, 70 054.
//! **How it fails**: RockPile (463 contacts, 0.1 % skew) stalls at 9e-4; with a strongly skew H it
//! may not converge (with that of LMGC_Global..46, 27 % skew, it does); for a block whose diagonal
//! spans many powers of ten the residual is met when only the stiff direction is solved; packings
//! with many contacts about to slide stall at about 1e-7.

use crate::anderson::Anderson;
use crate::ending::unsolved;
use crate::memory::reserve;
use crate::operator::{disk_map, has_very_large_friction, natural_map, onto_disk, own_step, row_product};
use crate::shifted::Shifted;
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Status, Stop, Vector, judge};

/// Over-relaxation α.
const RELAXATION: f64 = 1.6;
/// Initial β: the best value on published problems is between 0.03 and 0.3.
const PENALTY: f64 = 0.2;
/// β is changed if the ratio of the residuals is off by more than this.
const IMBALANCE: f64 = 2.0;
/// Largest change of β at once.
const CHANGE: f64 = 30.0;
/// Iterations of the first round of balancing; each later round is half as long as all before it.
const ROUND: u32 = 10;
/// An accelerated step that increases the squared residual by this factor is undone.
const WORSE: f64 = 4.0;
/// How often β is raised tenfold if S + Σ isn't positive definite.
const RAISES: u32 = 12;
/// Iterations without a better residual after which the iteration counts as stalled.
const PATIENCE: u32 = 3000;

/// The ADMM solver; see its [page](self). `iterations` counts triangular solves.
#[derive(Debug, Default)]
pub struct Admm<const D: usize> {
    h: BlockSparse<D>,
    shifted: Shifted<D>,
    anderson: Anderson<D>,
    /// The mean diagonal of each contact's block.
    own: Vec<f64>,
    v: Vec<Vector<D>>,
    z: Vec<Vector<D>>,
    u: Vec<Vector<D>>,
    /// `x − z`, then α times that: the residual of the fixed point.
    step: Vec<Vector<D>>,
    /// The image of the last v without acceleration.
    plain: Vec<Vector<D>>,
    factorisations: u32,
}

impl<const D: usize> Admm<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "admm";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of factorisations in the last solve.
    #[must_use]
    pub fn factorisations(&self) -> u32 {
        self.factorisations
    }

    /// Factorises `S + Σ` for a β of at least `beta`, and returns this β.
    fn factorise(&mut self, beta: f64) -> Option<f64> {
        let mut beta = beta;
        for _ in 0..RAISES {
            self.factorisations += 1;
            if self.shifted.factorise(|i| beta * self.own[i]) {
                return Some(beta);
            }
            beta *= 10.0;
        }
        None
    }

    fn prepare(&mut self, problem: &ContactProblem<'_, D>, p: &[Vector<D>]) -> Option<f64> {
        self.factorisations = 0;
        self.h.gather(problem);
        self.own.clear();
        self.own.extend((0..p.len()).map(|i| own_step(problem, i).recip()));
        self.anderson.clear();
        for vectors in [&mut self.v, &mut self.z, &mut self.u, &mut self.step, &mut self.plain] {
            vectors.clear();
            vectors.extend_from_slice(p);
        }
        if !self.shifted.load(&self.h) {
            return None;
        }
        let beta = self.factorise(PENALTY)?;
        // The multiplier for the initial impulses: u = −Σ w.
        for i in 0..p.len() {
            self.v[i] -= row_product(&self.h, i, &problem.q()[i], p) / (beta * self.own[i]);
        }
        Some(beta)
    }

    /// Sets `z = C(v)` and its velocities. Returns the residual and the scale that it is relative
    /// to.
    fn project(&mut self, problem: &ContactProblem<'_, D>, q_norm: f64) -> (f64, f64) {
        let (n, q, mu) = (problem.contacts(), problem.q(), problem.mu());
        let mut size = 0.0;
        for i in 0..n {
            self.z[i] = onto_disk(&self.v[i], mu[i]);
            size += self.z[i].norm_squared();
        }
        for i in 0..n {
            self.u[i] = row_product(&self.h, i, &q[i], &self.z);
        }
        let size = size.sqrt().max(q_norm).max(f64::MIN_POSITIVE);
        (natural_map(&self.z, &self.u, mu, problem.scale()) / size, size)
    }

    /// Whether z solves the problem to the tolerance.
    fn solves(&self, problem: &ContactProblem<'_, D>, residual: f64, size: f64, tolerance: f64) -> bool {
        let (mu, rho) = (problem.mu(), problem.scale());
        let small = residual <= tolerance
            || (has_very_large_friction(mu) && disk_map(&self.z, &self.u, mu, rho) <= tolerance * size);
        small && judge(problem, &self.z).global <= tolerance
    }

    /// Solves for x and sets `step` to α (x − z), the step of v.
    fn solve_for_x(&mut self, mu: &[f64], beta: f64) -> Changes {
        let n = mu.len();
        for i in 0..n {
            self.step[i] = -self.u[i] - (self.v[i] - self.z[i]) * (beta * self.own[i]);
        }
        self.shifted.solve(&mut self.step);
        let mut changes = Changes { step: 0.0, primal: 0.0, dual: 0.0 };
        for i in 0..n {
            let (x, z) = (self.z[i] + self.step[i], self.z[i]);
            self.step[i] *= RELAXATION;
            let next = onto_disk(&(self.v[i] + self.step[i]), mu[i]);
            changes.step += self.own[i] * self.step[i].norm_squared();
            changes.primal += self.own[i] * (x - next).norm_squared();
            changes.dual += self.own[i] * (next - z).norm_squared();
        }
        changes
    }

    /// Takes the step of v, accelerated.
    fn accelerate(&mut self) {
        for (v, step) in self.v.iter_mut().zip(&self.step) {
            *v += step;
        }
        self.plain.copy_from_slice(&self.v);
        self.anderson.accelerate(&mut self.v, &self.step, &self.own);
    }

    /// Multiplies β by `factor`, and scales the multiplier `w = v − z` accordingly. Returns the new
    /// β.
    fn change_penalty(&mut self, beta: f64, factor: f64, mu: &[f64]) -> Option<f64> {
        let changed = self.factorise(beta * factor)?;
        for i in 0..mu.len() {
            let z = onto_disk(&self.v[i], mu[i]);
            self.v[i] = z + (self.v[i] - z) * (beta / changed);
        }
        self.anderson.clear();
        Some(changed)
    }
}

/// Squared norms of an iteration in the metric of the contacts.
struct Changes {
    /// Of the step of v.
    step: f64,
    /// Of the primal residual x − z.
    primal: f64,
    /// Of the change of z, which is proportional to the dual residual.
    dual: f64,
}

/// The penalty, with the residuals of the current round of balancing.
struct Penalty {
    beta: f64,
    primal: f64,
    dual: f64,
    balance_at: u32,
}

impl Penalty {
    /// Adds the residuals of an iteration. At the end of a round, returns the factor by which β
    /// should change, if it is off.
    fn balance(&mut self, changes: &Changes, iterations: u32) -> Option<f64> {
        self.primal += changes.primal;
        self.dual += changes.dual;
        if iterations < self.balance_at {
            return None;
        }
        let factor = (self.primal / self.dual).sqrt().clamp(CHANGE.recip(), CHANGE);
        (self.primal, self.dual) = (0.0, 0.0);
        self.balance_at = iterations + (iterations / 2).max(ROUND);
        (!(IMBALANCE.recip()..=IMBALANCE).contains(&factor) && factor.is_finite()).then_some(factor)
    }
}

impl<const D: usize> ContactSolver<D> for Admm<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    /// Reserves memory for the iteration. The memory of the factor depends on the pattern and is
    /// allocated with its first problem.
    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.h.reserve(contacts, blocks);
        self.anderson.reserve(contacts);
        reserve(&mut self.own, contacts);
        for vectors in [&mut self.v, &mut self.z, &mut self.u, &mut self.step, &mut self.plain] {
            reserve(vectors, contacts);
        }
    }

    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &mut [Vector<D>]) -> Outcome {
        let start = judge(problem, p);
        if start.global <= stop.tolerance {
            return Outcome::new(Status::Converged, Self::NAME, 0, start);
        }
        let Some(beta) = self.prepare(problem, p) else {
            return Outcome::new(Status::Breakdown, Self::NAME, 0, start);
        };
        let q_norm = problem.scale() * problem.q().iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        let (mut best, mut best_at, mut iterations) = (start.global, 0, 0);
        let mut penalty = Penalty { beta, primal: 0.0, dual: 0.0, balance_at: ROUND };
        let mut last = f64::INFINITY;
        let ended = loop {
            let (residual, size) = self.project(problem, q_norm);
            // The comparison is false if the initial residual is NaN, so that zero is used instead.
            if residual < best || (residual.is_finite() && !best.is_finite()) {
                (best, best_at) = (residual, iterations);
                p.copy_from_slice(&self.z);
            }
            if self.solves(problem, residual, size, stop.tolerance) {
                p.copy_from_slice(&self.z);
                break Status::Converged;
            }
            if let Some(status) = unsolved(stop, iterations, iterations - best_at, PATIENCE, residual) {
                break status;
            }
            iterations += 1;
            let changes = self.solve_for_x(problem.mu(), penalty.beta);
            if changes.step > WORSE * last {
                self.v.copy_from_slice(&self.plain);
                self.anderson.clear();
                last = f64::INFINITY;
                continue;
            }
            last = changes.step;
            self.accelerate();
            if let Some(factor) = penalty.balance(&changes, iterations) {
                let Some(beta) = self.change_penalty(penalty.beta, factor, problem.mu()) else {
                    break Status::Breakdown;
                };
                penalty.beta = beta;
                last = f64::INFINITY;
            }
        };
        Outcome::new(ended, Self::NAME, iterations, judge(problem, p))
    }

    fn fork(&self) -> Box<dyn ContactSolver<D>> {
        Box::new(Self::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conforming::conforms_but_for_uneven_scales;

    #[test]
    fn conforms_to_its_tolerance() {
        conforms_but_for_uneven_scales(&mut Admm::new(), &mut Admm::new());
    }
}
