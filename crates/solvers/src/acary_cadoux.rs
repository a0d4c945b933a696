//! Acary and Cadoux's fixed point: the exact law by a sequence of cone programs.
//!
//! **Solves** the exact Coulomb law, 2D and 3D. With a fixed shift s_i = μ_i‖u_T,i‖, the law is the
//! optimality condition of `min ½ pᵀHp + (q + s)ᵀp` over the cones. Clarabel solves this, s is
//! updated from the velocities, and so on until s is stationary (Acary, Cadoux, Lemaréchal and
//! Malick 2011, doi 10.1002/zamm.201000073). A fixed point of this map is a solution of the law,
//! which is also how existence is proved.
//!
//! **Departures.**
//! - The initial shift is that of the given impulses, not 0.
//! - The interior-point method reaches about 1e-8 in 3D, and the fixed point converges linearly (a
//!   factor of about 0.4 per program). So once the residual is below 1e-5, or a program no longer
//!   halves it, another solver refines the result (ADMM if the crate is built with it, else
//!   Gauss–Seidel), and the fixed point continues only if this fails.
//! - With μ above 100 a sticking contact has no shift, as μ would amplify the slip that the
//!   interior point leaves.
//! - A skew part of H lags like the shift.
//!
//! **When to use it**: where robustness matters more than time, as each program is solved for any
//! condition of H.
//! **Cost**: about ten cone programs, each of 10 to 15 interior-point iterations with one KKT
//! factorisation. `iterations` counts programs and iterations of the refinement. Clarabel is set up
//! for each problem and allocates in its solve; other solvers don't allocate when reused. With the
//! refinement, spheres-in-a-box (256 contacts) and Capsules-i103 (275) are solved to 1e-12, which
//! no solver of Siconos reaches within 10 s.
//! **How it fails**: with large μ the fixed point may cycle (FrictionContactProblem00727, 367
//! contacts in 2D, stalls with μ = 0.9); then the result depends on the refinement. `stalled` means
//! that neither succeeded.

use crate::cone_program::ConeProgram;
use crate::operator::{row_product, slip_shift};
use crate::upper::Upper;
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Residual, Status, Stop, Vector, judge};

/// The solver for the refinement.
#[cfg(feature = "sparse")]
type Refiner<const D: usize> = crate::Admm<D>;
/// The solver for the refinement.
#[cfg(not(feature = "sparse"))]
type Refiner<const D: usize> = crate::Pgs<D>;

/// Largest number of programs.
const PROGRAMS: u32 = 60;
/// The residual below which refinement is cheaper than another program.
const REFINABLE: f64 = 1e-5;
/// A program that leaves more than this part of the residual counts as poor; after `PATIENCE` poor
/// ones in a row refinement is tried.
const POOR: f64 = 0.5;
/// See [`POOR`].
const PATIENCE: u32 = 3;
/// Largest number of iterations of one refinement.
const REFINEMENT_ITERATIONS: u32 = 5000;

/// The fixed-point solver; see its [page](self).
#[derive(Debug, Default)]
pub struct AcaryCadoux<const D: usize> {
    h: BlockSparse<D>,
    upper: Upper<D>,
    refiner: Refiner<D>,
    shift: Vec<f64>,
    skew: Vec<Vector<D>>,
    candidate: Vec<Vector<D>>,
    refined: Vec<Vector<D>>,
}

impl<const D: usize> AcaryCadoux<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "acary-cadoux";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Updates shift and skew part from impulses.
    fn update_shift(&mut self, problem: &ContactProblem<'_, D>, p: &[Vector<D>], skewed: bool) {
        self.skew.fill(Vector::zeros());
        if skewed {
            self.upper.product(p, &mut self.skew);
        }
        for i in 0..p.len() {
            let u = row_product(&self.h, i, &problem.q()[i], p);
            self.shift[i] = slip_shift(&p[i], &u, problem.mu()[i]);
            if skewed {
                self.skew[i] = row_product(&self.h, i, &-self.skew[i], p);
            }
        }
    }

    /// Iterates another method from `p` and takes its result if that is better. Returns the
    /// iterations.
    fn refine(
        &mut self,
        problem: &ContactProblem<'_, D>,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
        residual: &mut Residual,
    ) -> u32 {
        self.refined.clear();
        self.refined.extend_from_slice(p);
        let outcome = self.refiner.solve(problem, stop, &mut self.refined);
        if outcome.residual.global < residual.global {
            *residual = outcome.residual;
            p.copy_from_slice(&self.refined);
        }
        outcome.iterations
    }
}

impl<const D: usize> ContactSolver<D> for AcaryCadoux<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.h.reserve(contacts, blocks);
        self.refiner.reserve(contacts, blocks);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &mut [Vector<D>]) -> Outcome {
        let mut residual = judge(problem, p);
        if residual.global <= stop.tolerance {
            return Outcome::new(Status::Converged, Self::NAME, 0, residual);
        }
        self.h.gather(problem);
        for vectors in [&mut self.skew, &mut self.candidate] {
            vectors.clear();
            vectors.resize(p.len(), Vector::zeros());
        }
        self.shift.clear();
        self.shift.resize(p.len(), 0.0);
        let Some(mut program) = ConeProgram::new(problem, &self.h, &mut self.upper) else {
            return Outcome::new(Status::Breakdown, Self::NAME, 0, residual);
        };
        let (skewed, q) = (self.h.asymmetry() > f64::EPSILON, problem.q());
        self.update_shift(problem, p, skewed);
        let (mut iterations, mut programs, mut poor, mut before) = (0, 0, 0, f64::INFINITY);
        let status = loop {
            if residual.global <= stop.tolerance {
                break Status::Converged;
            }
            if stop.cancelled() {
                break Status::Cancelled;
            }
            if iterations >= stop.max_iterations {
                break Status::MaxIterations;
            }
            if programs >= PROGRAMS {
                break Status::Stalled;
            }
            programs += 1;
            iterations += 1;
            let mut candidate = std::mem::take(&mut self.candidate);
            let usable = program.solve(
                |i| {
                    let mut term = q[i] + self.skew[i];
                    term[0] += self.shift[i];
                    term
                },
                &mut candidate,
            );
            let reached = judge(problem, &candidate);
            if usable && reached.global.is_finite() {
                self.update_shift(problem, &candidate, skewed);
                if reached.global < residual.global || !residual.global.is_finite() {
                    residual = reached;
                    p.copy_from_slice(&candidate);
                }
            }
            self.candidate = candidate;
            if !usable {
                break Status::Breakdown;
            }
            poor = if reached.global <= POOR * before { 0 } else { poor + 1 };
            before = reached.global;
            let close = residual.global <= REFINABLE && residual.global > stop.tolerance;
            if (close || poor >= PATIENCE) && iterations < stop.max_iterations {
                poor = 0;
                let rest = stop.with_max_iterations(REFINEMENT_ITERATIONS.min(stop.max_iterations - iterations));
                iterations += self.refine(problem, &rest, p, &mut residual);
                if close && residual.global > stop.tolerance {
                    // Neither the fixed point, though close, nor the refinement converges.
                    break if stop.cancelled() { Status::Cancelled } else { Status::Stalled };
                }
            }
        };
        Outcome::new(status, Self::NAME, iterations, residual)
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
        conforms_but_for_uneven_scales(&mut AcaryCadoux::new(), &mut AcaryCadoux::new());
    }
}
