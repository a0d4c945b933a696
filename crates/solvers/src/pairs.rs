//! Gauss–Seidel over pairs of contacts that constrain one body twice.
//!
//! If two corners of a rigid block both stick, opposite tangential impulses at them leave the
//! velocities unchanged: H is singular. If the surface under the block bends, their velocities
//! can't both be exactly zero; they differ by the change of slope times the height of the surface
//! under the block, perhaps 1e-10 of the problem's speed. The opposite impulses must then grow
//! until one corner slides. Sweeps over single contacts add 1e-10 of them each time, and the
//! residual stays at 1e-10 on the way, so methods that follow the residual don't get there. Solving
//! the pair exactly, by its states, gets there at once, and pairs are coupled as weakly as bodies
//! are.

use crate::Pgs;
use crate::ending::ended;
use crate::memory::{refill, reserve};
use teeter_contact::{ContactProblem, Delassus, Outcome, Stop, Vector, judge};

/// An exact method for a few contacts; returns the outcome if it converged.
pub(crate) type Small<const D: usize> = fn(&ContactProblem<'_, D>, &Stop<'_>, &mut [Vector<D>]) -> Option<Outcome>;

/// Two contacts are a pair if fixing one leaves at most this part of the other's tangential
/// compliance.
const HELD_TWICE: f64 = 1e-3;
/// Largest number of sweeps, and the factor by which the residual must decrease per `BATCH` sweeps.
const SWEEPS: u32 = 60;
const BATCH: u32 = 4;
const PROGRESS: f64 = 0.5;
/// The residual to which a pair is solved.
const EXACT: f64 = 1e-13;

/// Memory for the sweeps.
#[derive(Debug, Default)]
pub(crate) struct Pairs<const D: usize> {
    /// The partner of each contact; the contact itself if it has none.
    partner: Vec<usize>,
    best: Vec<Vector<D>>,
}

impl<const D: usize> Pairs<D> {
    pub(crate) fn reserve(&mut self, contacts: usize) {
        reserve(&mut self.partner, contacts);
        reserve(&mut self.best, contacts);
    }

    /// Finds the pairs; returns whether there are any.
    fn find(&mut self, problem: &ContactProblem<'_, D>) -> bool {
        let n = problem.contacts();
        refill(&mut self.partner, n, 0);
        let own = |i: usize| problem.diagonal(i)[(1, 1)];
        for i in 0..n {
            let (mut least, mut partner) = (HELD_TWICE, i);
            for (j, h) in problem.row(i).into_iter().flatten() {
                let left = 1.0 - h[(1, 1)] * h[(1, 1)] / (own(i) * own(j));
                if j != i && left < least {
                    (least, partner) = (left, j);
                }
            }
            self.partner[i] = partner;
        }
        let mut any = false;
        for i in 0..n {
            let partner = self.partner[i];
            if self.partner[partner] != i {
                self.partner[i] = i;
            } else {
                any |= partner != i;
            }
        }
        any
    }

    /// Sweeps from `p` until it converges or no longer improves. `None` if there are no pairs or
    /// `small` doesn't support them; `p` contains the best impulses.
    pub(crate) fn solve(
        &mut self,
        problem: &ContactProblem<'_, D>,
        small: Small<D>,
        stop: &Stop<'_>,
        p: &mut [Vector<D>],
    ) -> Option<Outcome> {
        if D != 2 || matches!(problem.delassus(), Delassus::Operator(_)) || !self.find(problem) {
            return None;
        }
        self.best.clear();
        self.best.extend_from_slice(p);
        let mut best = judge(problem, p);
        let (mut sweeps, mut batch) = (0, best.global);
        while best.global > stop.tolerance && sweeps < SWEEPS.min(stop.max_iterations) && !stop.cancelled() {
            self.sweep(problem, small, p);
            sweeps += 1;
            let residual = judge(problem, p);
            if residual.global < best.global {
                best = residual;
                self.best.copy_from_slice(p);
            }
            if sweeps % BATCH == 0 {
                if !(best.global < PROGRESS * batch) {
                    break;
                }
                batch = best.global;
            }
        }
        p.copy_from_slice(&self.best);
        Some(Outcome::new(ended(stop, sweeps, &best), Pgs::<D>::NAME, sweeps, best))
    }

    fn sweep(&self, problem: &ContactProblem<'_, D>, small: Small<D>, p: &mut [Vector<D>]) {
        let exact = Stop::default().with_tolerance(EXACT);
        for (i, &j) in self.partner.iter().enumerate().filter(|(i, j)| i <= *j) {
            let (Some(h_ij), Some(h_ji)) = (problem.block(i, j), problem.block(j, i)) else { return };
            let h = [problem.diagonal(i), h_ij, h_ji, problem.diagonal(j)];
            let (u_i, u_j) = (problem.velocity(i, p), problem.velocity(j, p));
            let mu = [problem.mu()[i], problem.mu()[j]];
            let mut own = [p[i], p[j]];
            if i == j {
                let q = [u_i - h[0] * own[0]];
                if let Ok(single) = ContactProblem::new(Delassus::Dense(&h[..1]), &q, &mu[..1])
                    && small(&single, &exact, &mut own[..1]).is_some()
                {
                    p[i] = own[0];
                }
                continue;
            }
            let q = [u_i - h[0] * own[0] - h[1] * own[1], u_j - h[2] * own[0] - h[3] * own[1]];
            if let Ok(pair) = ContactProblem::new(Delassus::Dense(&h), &q, &mu)
                && small(&pair, &exact, &mut own).is_some()
            {
                (p[i], p[j]) = (own[0], own[1]);
            }
        }
    }
}
