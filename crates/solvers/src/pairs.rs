//! Gauss–Seidel over pairs of contacts that hold one body twice.
//!
//! Two corners of a rigid block that both stick can press against each other along the surface as
//! they like: H has nothing to say against it. Where the surface bends under the block, their
//! velocities can't quite both be zero, by the surface's change of slope times its height under the
//! block, which may be 1e-10 of the problem's speed. The pressure must then grow until one of the
//! corners slides. Sweeps over single contacts add 1e-10 of it each time, and the residual of all
//! those impulses is the same 1e-10: nothing that goes by the residual gets there either. A pair
//! solved exactly, by its states, is at the end at once; and pairs feel each other as weakly as
//! bodies do.

use crate::Pgs;
use crate::ending::ended;
use crate::memory::{refill, reserve};
use teeter_contact::{ContactProblem, Delassus, Outcome, Stop, Vector, judge};

/// An exact method for a few contacts: what it found, if the judge is satisfied.
pub(crate) type Small<const D: usize> = fn(&ContactProblem<'_, D>, &Stop<'_>, &mut [Vector<D>]) -> Option<Outcome>;

/// Two contacts are a pair if so little of one's tangential compliance is left where the other one
/// is held.
const HELD_TWICE: f64 = 1e-3;
/// Sweeps at the most, and sweeps in which the residual must fall to this part of it.
const SWEEPS: u32 = 60;
const BATCH: u32 = 4;
const PROGRESS: f64 = 0.5;
/// A pair is solved to this residual.
const EXACT: f64 = 1e-13;

/// Memory for the sweeps.
#[derive(Debug, Default)]
pub(crate) struct Pairs<const D: usize> {
    /// The other one of each contact's pair; itself for one that has none.
    partner: Vec<usize>,
    best: Vec<Vector<D>>,
}

impl<const D: usize> Pairs<D> {
    pub(crate) fn reserve(&mut self, contacts: usize) {
        reserve(&mut self.partner, contacts);
        reserve(&mut self.best, contacts);
    }

    /// Finds the pairs; whether there are any.
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

    /// Sweeps from `p` until the judge is satisfied, or it no longer gets better. `None` where
    /// there are no pairs, or `small` doesn't take them; `p` holds the best impulses of all.
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
