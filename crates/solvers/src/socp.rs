//! The convex (associated) law as one second-order cone program, by Clarabel's interior point.
//!
//! **Solves** `min ½ pᵀHp + qᵀp` over the cones ‖p_T‖ ≤ μ p_N (Anitescu 2006, doi
//! 10.1007/s10107-005-0590-7). This is **not** Coulomb's law: the optimality condition is
//! `K ∋ p ⊥ u ∈ K*`, so a contact sliding at ‖u_T‖ separates at μ‖u_T‖. If nothing slides (or μ
//! = 0) the two laws agree. [`AcaryCadoux`](crate::AcaryCadoux) solves the exact law by a sequence of
//! these programs.
//!
//! **Meaning of the outcome**: `converged` refers to the convex law, by the valid_state residual
//! with u in place of û: `‖p − Π(p − ρu)‖ / max(‖p‖, ρ‖q‖) ≤ tolerance`. The reported residual is
//! that of the exact law: on a sliding problem it stays large, which is the difference of the laws,
//! not a failure.
//!
//! **When to use it**: to compare with programs that use the convex law (Project Chrono, Drake's
//! older solvers, MuJoCo's relatives), or for a rough initial guess for any condition of H.
//! **Cost**: 10 to 15 interior-point iterations with one KKT factorisation each; `iterations`
//! counts these and the gradients of the refinement. Clarabel is set up for each problem and
//! allocates in its solve; other solvers don't allocate when reused.
//! **How it fails**: the interior-point method reaches about 1e-8 in 3D. Accelerated gradients
//! ([`Apgd`] with zero shift) refine the result, and may run out of iterations on badly conditioned
//! problems. A skew part of H isn't part of the objective: it is treated explicitly (with at most
//! three programs), and if it is small the refinement corrects the rest.

use crate::apgd::{Apgd, convex_map};
use crate::cone_program::ConeProgram;
use crate::operator::row_product;
use crate::upper::Upper;
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Law, Outcome, Status, Stop, Vector, judge};

/// Largest number of programs for a problem whose H has a skew part.
const PROGRAMS: u32 = 3;

/// The solver of the convex law; see its [page](self).
#[derive(Debug, Default)]
pub struct Socp<const D: usize> {
    h: BlockSparse<D>,
    upper: Upper<D>,
    apgd: Apgd<D>,
    u: Vec<Vector<D>>,
    skew: Vec<Vector<D>>,
    candidate: Vec<Vector<D>>,
    zeros: Vec<f64>,
}

impl<const D: usize> Socp<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "socp";

    /// A solver.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The convex law's residual of `p`.
    fn residual(&mut self, problem: &ContactProblem<'_, D>, p: &[Vector<D>]) -> f64 {
        let (q, rho) = (problem.q(), problem.scale());
        for i in 0..p.len() {
            self.u[i] = row_product(&self.h, i, &q[i], p);
        }
        let size = norm(p).max(rho * norm(q)).max(f64::MIN_POSITIVE);
        convex_map(p, &self.u, &self.zeros, problem.mu(), rho) / size
    }
}

fn norm<const D: usize>(x: &[Vector<D>]) -> f64 {
    x.iter().map(Vector::norm_squared).sum::<f64>().sqrt()
}

impl<const D: usize> ContactSolver<D> for Socp<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn law(&self) -> Law {
        Law::Convex
    }

    fn reserve(&mut self, contacts: usize, blocks: usize) {
        self.h.reserve(contacts, blocks);
        self.apgd.reserve(contacts, blocks);
    }

    fn solve(&mut self, problem: &ContactProblem<'_, D>, stop: &Stop<'_>, p: &mut [Vector<D>]) -> Outcome {
        self.h.gather(problem);
        for vectors in [&mut self.u, &mut self.skew, &mut self.candidate] {
            vectors.clear();
            vectors.extend_from_slice(p);
        }
        self.zeros.clear();
        self.zeros.resize(p.len(), 0.0);
        let mut residual = self.residual(problem, p);
        let mut iterations = 0;
        let ended = |status, iterations, p: &[Vector<D>]| {
            let judged = judge(problem, p);
            // `converged` refers to the convex law, the residual to Coulomb's.
            let by_own_law = status == Status::Converged && !(judged.global <= stop.tolerance);
            let status = if by_own_law { Status::ConvexLaw } else { status };
            Outcome::new(status, Self::NAME, iterations, judged)
        };
        if residual <= stop.tolerance {
            return ended(Status::Converged, 0, p);
        }
        let Some(mut program) = ConeProgram::new(problem, &self.h, &mut self.upper) else {
            return ended(Status::Breakdown, 0, p);
        };
        let (skewed, q) = (self.h.asymmetry() > f64::EPSILON, problem.q());
        while iterations < PROGRAMS.min(stop.max_iterations) && !stop.cancelled() {
            // H p − S p at the best impulses so far.
            self.skew.fill(Vector::zeros());
            if skewed {
                self.upper.product(p, &mut self.skew);
                for i in 0..p.len() {
                    self.skew[i] = row_product(&self.h, i, &-self.skew[i], p);
                }
            }
            iterations += 1;
            let mut candidate = std::mem::take(&mut self.candidate);
            let usable = program.solve(|i| q[i] + self.skew[i], &mut candidate);
            let reached = if usable { self.residual(problem, &candidate) } else { f64::NAN };
            let better = reached < residual || !residual.is_finite();
            if better {
                residual = reached;
                p.copy_from_slice(&candidate);
            }
            self.candidate = candidate;
            if residual <= stop.tolerance {
                return ended(Status::Converged, iterations, p);
            }
            if !better || !skewed {
                break;
            }
        }
        let rest = stop.with_max_iterations(stop.max_iterations - iterations);
        let (status, more) = self.apgd.iterate(problem, &rest, p, Law::Convex);
        ended(status, iterations + more, p)
    }

    fn fork(&self) -> Box<dyn ContactSolver<D>> {
        Box::new(Self::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Vector2};
    use teeter_contact::Delassus;
    use teeter_contact::conformance::{plane_cases, space_cases};

    fn obeys_the_convex_law<const D: usize>(cases: &[teeter_contact::conformance::Case<D>]) {
        for case in cases {
            let problem = case.problem().unwrap();
            let mut p = vec![Vector::<D>::zeros(); case.q.len()];
            let outcome = Socp::new().solve(&problem, &Stop::default().with_tolerance(1e-9), &mut p);
            assert!(outcome.solved_its_own_law(), "{}: {outcome:?}", case.name);
            assert_eq!(outcome.converged(), judge(&problem, &p).global <= 1e-9, "{}: {outcome:?}", case.name);
            assert!((outcome.residual.global - judge(&problem, &p).global).abs() < 1e-15);
            // The optimality conditions: p in the cone, u in the dual cone, no power.
            let (speed, size) = (norm(problem.q()), norm(&p).max(norm(problem.q()) * problem.scale()));
            for i in 0..p.len() {
                let (u, mu) = (problem.velocity(i, &p), problem.mu()[i]);
                let tangential = |x: &Vector<D>| x.iter().skip(1).map(|c| c * c).sum::<f64>().sqrt();
                let slack = 1e-7 * (1.0 + mu);
                assert!(tangential(&p[i]) <= mu * p[i][0] + slack * size, "{}: {p:?}", case.name);
                assert!(u[0] >= mu * tangential(&u) - slack * speed, "{}: {u}", case.name);
                assert!(p[i].dot(&u).abs() <= slack * size * speed, "{}", case.name);
            }
        }
    }

    #[test]
    fn obeys_the_convex_law_in_plane_and_space() {
        obeys_the_convex_law(&plane_cases());
        obeys_the_convex_law(&space_cases());
    }

    #[test]
    fn a_sliding_contact_separates_at_friction_times_slip() {
        let (h, q, mu) = ([Matrix2::identity()], [Vector2::new(-1.0, 2.0)], [0.5]);
        let problem = ContactProblem::new(Delassus::Dense(&h), &q, &mu).unwrap();
        let mut p = [Vector2::zeros()];
        let outcome = Socp::new().solve(&problem, &Stop::default(), &mut p);
        let u = problem.velocity(0, &p);
        assert!(u[1] > 0.1 && (u[0] - 0.5 * u[1]).abs() < 1e-8, "{u}");
        assert!(outcome.residual.global > 0.1, "the exact law's residual is reported");
        assert!(outcome.solved_its_own_law() && !outcome.converged(), "{outcome:?}");
    }

    #[test]
    fn frictionless_contacts_have_no_tension() {
        // A cone with μ = 0 alone would lose p_N ≥ 0.
        let (h, q, mu) = ([Matrix2::identity()], [Vector2::new(0.5, 2.0)], [0.0]);
        let problem = ContactProblem::new(Delassus::Dense(&h), &q, &mu).unwrap();
        let mut p = [Vector2::new(0.3, 0.1)];
        assert!(Socp::new().solve(&problem, &Stop::default(), &mut p).converged());
        assert!(p[0].norm() < 1e-9, "{p:?}");
    }
}
