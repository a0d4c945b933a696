//! Damped projected Jacobi: every contact takes, at once and from the same impulses, a step against its velocity and is
//! projected onto the law, p_N ← max(p_N − τ_i u_N, 0), p_T ← the nearest number to p_T − τ_i u_T in [−μ p_N, μ p_N].
//! Its fixed points are the solutions of the exact law (Alart and Curnier 1991, doi 10.1016/0045-7825(91)90022-X). With
//! 1/τ_i = Σ_j ‖H_ij‖, Gershgorin's bound, contacts don't overshoot together; it still takes up to thousands of iterations.

use teeter_contact::{ContactProblem, ContactSolver, Delassus, Law, Outcome, Status, Stop, Vector, judge_velocities};

#[derive(Debug, Default)]
pub struct Jacobi {
    u: Vec<Vector<2>>,
    tau: Vec<f64>,
}

impl ContactSolver<2> for Jacobi {
    fn name(&self) -> &'static str {
        "jacobi"
    }

    fn law(&self) -> Law {
        Law::Exact
    }

    fn reserve(&mut self, contacts: usize, _blocks: usize) {
        self.u.reserve(contacts.saturating_sub(self.u.len()));
        self.tau.reserve(contacts.saturating_sub(self.tau.len()));
    }

    fn solve(&mut self, problem: &ContactProblem<'_, 2>, stop: &Stop<'_>, p: &mut [Vector<2>]) -> Outcome {
        let (Self { u, tau }, n) = (self, p.len());
        tau.clear();
        tau.extend((0..n).map(|i| match problem.delassus() {
            Delassus::Dense(blocks) => blocks[i * n..(i + 1) * n].iter().map(|block| block.norm()).sum::<f64>().recip(),
            _ => (problem.diagonal(i).norm() * n as f64).recip(), // a guess for other shapes
        }));
        let mut iterations = 0;
        loop {
            u.clear();
            u.extend((0..n).map(|i| problem.velocity(i, p)));
            let residual = judge_velocities(problem, p, u);
            let ended = |status| Outcome::new(status, "jacobi", iterations, residual);
            match residual.global {
                r if r <= stop.tolerance => return ended(Status::Converged),
                _ if stop.cancelled() => return ended(Status::Cancelled),
                r if !r.is_finite() => return ended(Status::Breakdown),
                _ if iterations >= stop.max_iterations => return ended(Status::MaxIterations),
                _ => iterations += 1,
            }
            for (i, p) in p.iter_mut().enumerate() {
                let normal = (p[0] - tau[i] * u[i][0]).max(0.0);
                let limit = problem.mu()[i] * normal;
                *p = Vector::<2>::new(normal, (p[1] - tau[i] * u[i][1]).clamp(-limit, limit));
            }
        }
    }

    fn fork(&self) -> Box<dyn ContactSolver<2>> {
        Box::new(Self::default())
    }
}
