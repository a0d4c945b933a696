//! Alternating directions (ADMM) with an adaptive penalty and Anderson acceleration.
//!
//! **Solves** the exact Coulomb law, 2D and 3D. The impulses are split into x, which knows H, and
//! z, which knows the law: with Σ = β diag(h_i), h_i the mean diagonal of contact i's block, and w
//! the multiplier,
//!
//! ```text
//! (H + Σ) x = Σ (z − w) − q,    v = α x + (1 − α) z + w,    z = C(v),    w = v − z        α = 1.6
//! ```
//!
//! (Boyd et al. 2011, doi 10.1561/2200000016; for contact Acary, Brémond and Huber 2018, doi
//! 10.1007/978-3-319-75972-2_10, and Siconos' `ADMM`.) C solves the law of each contact alone for a
//! multiple of the identity: `z_N = max(v_N, 0)`, `z_T` onto the disk of radius `μ z_N`. At the
//! fixed point `u = −Σ w`.
//!
//! **Departures.**
//! - C solves the exact law, where the papers project onto the cone and carry De Saxcé's shift
//!   along as data: nothing lags, and μ doesn't enter the conditioning.
//! - A penalty a contact: heavy and light bodies are balanced alike, and units of mass or speed
//!   cancel.
//! - The step of x is solved for as a correction, `(S + Σ)(x − z) = −(H z + q + Σ w)`, with S the
//!   symmetric part of H: one Cholesky factorisation serves asymmetric H too (its skew part lags by
//!   an iteration), and `H z + q` is what the residual needs anyway.
//! - β is balanced by the ratio of primal to dual residual over rounds of growing length, and only
//!   where it is off by more than 2: each change is a factorisation.
//! - The iteration `v → v + α (x − z)` is accelerated by Anderson's method (8 differences); a step
//!   that doubles the fixed point's residual is taken back.
//!
//! **Take it** for hyperstatic problems (walls, towers, stacks) of up to some thousand contacts,
//! and wherever more than 1e-4 is asked of a problem that projections solve slowly.
//! **Cost**: one factorisation, then a few more (their number is [`Admm::factorisations`]); an
//! iteration is a product with H and two triangular solves. The ordering and analysis are kept for
//! equal patterns; contacts that don't feel each other fill nothing in. An operator given by its
//! product is formed first. To 1e-12 OneObject-i1028 (23 contacts) takes 340 iterations,
//! BoxesStack1 (52) 135, LMGC_100_PR_PerioBox (60) 66, KaplasTower (570) 30, Spheres-i099 (356) 72,
//! Capsules-i100 (276) 810; Siconos' `ADMM` 4475, 2242, never, 17, 363, 70 054.
//! **Fails**: RockPile (463 contacts, 0.1 % skew) stalls at 9e-4; a strongly skew H need not
//! converge (that of LMGC_Global..46, 27 % skew, does); a block whose diagonal spans many powers of
//! ten meets the judge's residual with its stiff direction solved only; packings with many contacts
//! at the brink of sliding stall at about 1e-7.

use crate::anderson::Anderson;
use crate::memory::reserve;
use crate::operator::{disk_map, is_steep, natural_map, onto_disk, own_step, row_product};
use crate::shifted::Shifted;
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Status, Stop, Vector, judge};

/// Over-relaxation α.
const RELAXATION: f64 = 1.6;
/// β at the start: the best on published problems lies between 0.03 and 0.3.
const PENALTY: f64 = 0.2;
/// β is changed where the residuals' ratio is off by more than this.
const IMBALANCE: f64 = 2.0;
/// Largest change of β at once.
const CHANGE: f64 = 30.0;
/// Iterations of the first round of balancing; later rounds are half as long as all before.
const ROUND: u32 = 10;
/// An accelerated step whose squared residual is larger by this is taken back.
const WORSE: f64 = 4.0;
/// Times that β is raised tenfold where H + Σ isn't positive definite.
const RAISES: u32 = 12;
/// Iterations without a better residual after which the iteration counts as stalled.
const PATIENCE: u32 = 3000;

/// The ADMM solver; see its [page](self). `iterations` counts solves with the factor.
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
    /// `x − z`, then α times that: how far v is from being fixed.
    step: Vec<Vector<D>>,
    /// The image of the last v that wasn't accelerated.
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

    /// Factorisations of the last solve.
    #[must_use]
    pub fn factorisations(&self) -> u32 {
        self.factorisations
    }

    /// Factorises `S + Σ` for a β of at least `beta`; the β taken.
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
        // The multiplier that belongs to the start: u = −Σ w.
        for i in 0..p.len() {
            self.v[i] -= row_product(&self.h, i, &problem.q()[i], p) / (beta * self.own[i]);
        }
        Some(beta)
    }
}

impl<const D: usize> ContactSolver<D> for Admm<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    /// Makes room for the iteration; the factor's room depends on the pattern, and comes with the
    /// first problem of it.
    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.h.reserve(contacts, blocks);
        self.anderson.reserve(contacts);
        reserve(&mut self.own, contacts);
        for vectors in [&mut self.v, &mut self.z, &mut self.u, &mut self.step, &mut self.plain] {
            reserve(vectors, contacts);
        }
    }

    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &mut [Vector<D>]) -> Outcome {
        let (n, q, mu, rho) = (problem.contacts(), problem.q(), problem.mu(), problem.scale());
        let start = judge(problem, p);
        if start.global <= stop.tolerance {
            return Outcome::new(Status::Converged, Self::NAME, 0, start);
        }
        let Some(mut beta) = self.prepare(problem, p) else {
            return Outcome::new(Status::Breakdown, Self::NAME, 0, start);
        };
        let q_norm = rho * q.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        let (mut best, mut best_at, mut iterations) = (start.global, 0, 0);
        let (mut primal, mut dual, mut balance_at) = (0.0, 0.0, ROUND);
        let mut last = f64::INFINITY;
        let ended = loop {
            let mut size = 0.0;
            for i in 0..n {
                self.z[i] = onto_disk(&self.v[i], mu[i]);
                size += self.z[i].norm_squared();
            }
            for i in 0..n {
                self.u[i] = row_product(&self.h, i, &q[i], &self.z);
            }
            let size = size.sqrt().max(q_norm).max(f64::MIN_POSITIVE);
            let residual = natural_map(&self.z, &self.u, mu, rho) / size;
            // Written so that a start that isn't a number is better than nothing, and nothing is
            // better than it.
            if residual < best || (residual.is_finite() && !best.is_finite()) {
                (best, best_at) = (residual, iterations);
                p.copy_from_slice(&self.z);
            }
            let small = residual <= stop.tolerance
                || (is_steep(mu) && disk_map(&self.z, &self.u, mu, rho) <= stop.tolerance * size);
            if small && judge(problem, &self.z).global <= stop.tolerance {
                p.copy_from_slice(&self.z);
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
            iterations += 1;
            for i in 0..n {
                self.step[i] = -self.u[i] - (self.v[i] - self.z[i]) * (beta * self.own[i]);
            }
            self.shifted.solve(&mut self.step);
            let (mut of_step, mut of_x, mut of_z) = (0.0, 0.0, 0.0);
            for i in 0..n {
                let (x, z) = (self.z[i] + self.step[i], self.z[i]);
                self.step[i] *= RELAXATION;
                let next = onto_disk(&(self.v[i] + self.step[i]), mu[i]);
                of_step += self.own[i] * self.step[i].norm_squared();
                of_x += self.own[i] * (x - next).norm_squared();
                of_z += self.own[i] * (next - z).norm_squared();
            }
            if of_step > WORSE * last {
                self.v.copy_from_slice(&self.plain);
                self.anderson.clear();
                last = f64::INFINITY;
                continue;
            }
            last = of_step;
            for (v, step) in self.v.iter_mut().zip(&self.step) {
                *v += step;
            }
            self.plain.copy_from_slice(&self.v);
            self.anderson.accelerate(&mut self.v, &self.step, &self.own);
            primal += of_x;
            dual += of_z;
            if iterations >= balance_at {
                let factor = (primal / dual).sqrt().clamp(CHANGE.recip(), CHANGE);
                (primal, dual) = (0.0, 0.0);
                balance_at = iterations + (iterations / 2).max(ROUND);
                if !(IMBALANCE.recip()..=IMBALANCE).contains(&factor) && factor.is_finite() {
                    let Some(changed) = self.factorise(beta * factor) else { break Status::Breakdown };
                    for i in 0..n {
                        let z = onto_disk(&self.v[i], mu[i]);
                        self.v[i] = z + (self.v[i] - z) * (beta / changed);
                    }
                    beta = changed;
                    self.anderson.clear();
                    last = f64::INFINITY;
                }
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
