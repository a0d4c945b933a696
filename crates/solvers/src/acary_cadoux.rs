//! Acary and Cadoux's fixed point: the exact law from a sequence of cone programs.
//!
//! **Solves** the exact Coulomb law, 2D and 3D. With the shift s_i = μ_i‖u_T,i‖ held, the law is
//! the optimality of `min ½ pᵀHp + (q + s)ᵀp` over the cones; Clarabel solves that, s is renewed
//! from its velocities, and so on until s stands still (Acary, Cadoux, Lemaréchal and Malick 2011,
//! doi 10.1002/zamm.201000073). Where that map has a fixed point the law has a solution: this is
//! also how existence is proved.
//!
//! **Departures.**
//! - The shift starts from that of the impulses given, not from 0.
//! - The interior point floors at some 1e-8 in 3D, and the fixed point converges linearly (a factor
//!   of about 0.4 a program). So once the residual is below 1e-5, or a program no longer halves it,
//!   another solver polishes from there (ADMM where the crate has it, else Gauss–Seidel), and the
//!   fixed point goes on only if that fails.
//! - With μ above 100 a contact that sticks has no shift, whatever slip the interior point leaves
//!   it: μ would make much of it.
//! - A skew part of H lags like the shift.
//!
//! **Take it** where robustness counts more than time: each program is solved whatever the
//! condition of H.
//! **Cost**: that of a cone program (a KKT factorisation an interior-point iteration, 10 to 15 of
//! them) times about ten. `iterations` counts programs and the polish's own. Clarabel is set up
//! anew for each problem, and allocates in its solve: an exception to "kept over steps it allocates
//! nothing". With its polish it takes spheres-in-a-box (256 contacts) to 1e-12 and Capsules-i103
//! (275) too, where no solver of Siconos gets within 10 s.
//! **Fails**: with large μ the fixed point may cycle (μ = 0.9 of FrictionContactProblem00727, 367
//! contacts in 2D, stalls); then the polish decides. `stalled` says that neither helped.

use crate::cone_program::ConeProgram;
use crate::operator::{row_product, slip_shift};
use crate::upper::Upper;
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Residual, Status, Stop, Vector, judge};

/// The solver that polishes.
#[cfg(feature = "sparse")]
type Polisher<const D: usize> = crate::Admm<D>;
/// The solver that polishes.
#[cfg(not(feature = "sparse"))]
type Polisher<const D: usize> = crate::Pgs<D>;

/// Most programs.
const PROGRAMS: u32 = 60;
/// The residual below which polishing is cheaper than another program.
const CLOSE: f64 = 1e-5;
/// A program that leaves more of the residual than this is a poor one; after so many of them in a
/// row polishing is tried.
const POOR: f64 = 0.5;
/// See [`POOR`].
const PATIENCE: u32 = 3;
/// Most iterations of one polish.
const POLISH: u32 = 5000;

/// The fixed-point solver; see its [page](self).
#[derive(Debug, Default)]
pub struct AcaryCadoux<const D: usize> {
    h: BlockSparse<D>,
    upper: Upper<D>,
    polisher: Polisher<D>,
    shift: Vec<f64>,
    skew: Vec<Vector<D>>,
    candidate: Vec<Vector<D>>,
    polished: Vec<Vector<D>>,
}

impl<const D: usize> AcaryCadoux<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "acary-cadoux";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Renews shift and skew part from impulses.
    fn renew(&mut self, problem: &ContactProblem<'_, D>, p: &[Vector<D>], skewed: bool) {
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

    /// Iterates another method from `p`, and takes what it finds if that is better. Returns the
    /// iterations.
    fn polish(
        &mut self,
        problem: &ContactProblem<'_, D>,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
        residual: &mut Residual,
    ) -> u32 {
        self.polished.clear();
        self.polished.extend_from_slice(p);
        let outcome = self.polisher.solve(problem, stop, &mut self.polished);
        if outcome.residual.global < residual.global {
            *residual = outcome.residual;
            p.copy_from_slice(&self.polished);
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
        self.polisher.reserve(contacts, blocks);
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
        self.renew(problem, p, skewed);
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
                self.renew(problem, &candidate, skewed);
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
            let close = residual.global <= CLOSE && residual.global > stop.tolerance;
            if (close || poor >= PATIENCE) && iterations < stop.max_iterations {
                poor = 0;
                let rest = stop.with_max_iterations(POLISH.min(stop.max_iterations - iterations));
                iterations += self.polish(problem, &rest, p, &mut residual);
                if close && residual.global > stop.tolerance {
                    // Neither the fixed point, so near, nor the polish gets there.
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
