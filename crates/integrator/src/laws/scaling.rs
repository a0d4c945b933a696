//! Restitution that creates no energy: it is scaled by one f for all contacts that are coupled.

use super::{Laws, join};
use crate::stage::{Problem, Rule};
use teeter_contact::{Block, ContactSolver, Outcome, ProblemError, Stop};

/// Bisections of the interval of f.
const HALVINGS: u32 = 40;

/// Work below this fraction of Σ‖U‖‖p‖ is rounding.
pub(super) const WORKLESS: f64 = 1e-14;

impl<const D: usize> Laws<D> {
    /// Finds islands whose contacts added energy in the last pass, possibly by restitution; returns
    /// whether there are any.
    pub(super) fn find_gains(&mut self, set: &Problem<D>) -> bool {
        let n = set.len();
        self.range.clear();
        self.range.resize(n, [1.0, 1.0]);
        for i in 0..n {
            if self.returns(set, i) {
                let first = self.island[i];
                let (work, rounding) = self.work(set, first);
                if work > rounding {
                    self.range[first] = [0.0, 1.0];
                }
            }
        }
        self.range.iter().any(|range| range[0] < 1.0)
    }

    /// Whether a contact had restitution in the last pass that can be scaled.
    fn returns(&self, set: &Problem<D>, i: usize) -> bool {
        match set.rule(i) {
            Rule::Energetic => set.shift(i)[0] != 0.0,
            Rule::Poisson { .. } => self.given[i] > 0.0,
            _ => false,
        }
    }

    /// Finds the largest fraction f of restitution that creates no energy, for each island in which
    /// f = 1 does.
    ///
    /// Beside an impact there can be contacts that add energy by themselves, such as one that has
    /// penetrated and is separating. Restitution isn't the cause of that, so the work with f = 0 is
    /// allowed.
    pub(super) fn scale_restitution(
        &mut self,
        set: &mut Problem<D>,
        theta: f64,
        solver: &mut dyn ContactSolver<D>,
        stop: &Stop<'_>,
    ) -> Result<Outcome, ProblemError> {
        let n = set.len();
        self.shift.clear();
        self.shift.extend(set.posed.iter().map(|posed| posed.shift));
        self.scale(set, |_| 0.0);
        let mut outcome = self.guarded_pass(set, theta, solver, stop)?;
        self.floor.clear();
        for first in 0..n {
            let own = if self.island[first] == first { self.work(set, first).0 } else { 0.0 };
            self.floor.push(own.max(0.0));
        }
        for i in (0..n).filter(|&i| self.range[self.island[i]][0] < 1.0) {
            self.unreturned[i] = set.work(i);
        }
        for halving in 0..=HALVINGS {
            // Finally the largest f that is known to create none.
            let at = move |[low, high]: [f64; 2]| if halving < HALVINGS { 0.5 * (low + high) } else { low };
            self.scale(set, at);
            outcome = join(outcome, self.guarded_pass(set, theta, solver, stop)?);
            for first in (0..n).filter(|&i| self.island[i] == i) {
                let [low, high] = self.range[first];
                if low < 1.0 {
                    let f = at(self.range[first]);
                    let (work, rounding) = self.work(set, first);
                    self.range[first] = if work > self.floor[first] + rounding { [low, f] } else { [f, high] };
                }
            }
        }
        Ok(outcome)
    }

    /// Scales restitution by f of each island's interval; f = 1 where the interval is a point.
    fn scale(&mut self, set: &mut Problem<D>, f: impl Fn([f64; 2]) -> f64) {
        for i in 0..set.len() {
            let range = self.range[self.island[i]];
            if range[0] < 1.0 {
                self.part[i] = f(range);
                if matches!(set.rule(i), Rule::Energetic) {
                    let mut shift = self.shift[i];
                    shift[0] *= self.part[i];
                    set.reshift(i, shift);
                }
            }
        }
    }

    /// Finds the contacts that are coupled by H, directly or through others.
    pub(super) fn find_islands(&mut self, set: &Problem<D>) {
        let n = set.len();
        self.island.clear();
        self.island.extend(0..n);
        let mut changed = true;
        while changed {
            changed = false;
            for i in 0..n {
                for j in 0..n {
                    let first = self.island[i].min(self.island[j]);
                    let couples = set.blocks[i * n + j] != Block::<D>::zeros();
                    if couples && (self.island[i] != first || self.island[j] != first) {
                        (self.island[i], self.island[j]) = (first, first);
                        changed = true;
                    }
                }
            }
        }
    }

    /// Whether contacts coupled with contact `i` had restitution by Poisson's law in the last
    /// solve. Then one of them may have gained what another has passed on, so only the sum of their
    /// work counts.
    pub(crate) fn handed_on(&self, set: &Problem<D>, i: usize) -> bool {
        let given = |j: usize| matches!(set.rule(j), Rule::Poisson { .. }) && self.given[j] > 0.0;
        (0..set.len()).any(|j| given(j) && self.island[j] == self.island[i])
    }

    /// The work Ū·p of contact `i` and those coupled with it, J; only after [`Laws::handed_on`]
    /// returned `true`.
    pub(crate) fn work_around(&self, set: &Problem<D>, i: usize) -> f64 {
        self.work(set, self.island[i]).0
    }

    /// The work Ū·p of contact `i` without restitution in its island, J; 0 where the island added
    /// no energy.
    pub(crate) fn work_unreturned(&self, i: usize) -> f64 {
        self.unreturned[i]
    }

    /// The work Ū·p of an island's contacts, with Ū the mean of U⁰ and U¹ whatever θ is, which is
    /// the change of kinetic energy by an impact; and how much of it may be rounding. Both in J.
    fn work(&self, set: &Problem<D>, first: usize) -> (f64, f64) {
        let (mut work, mut size) = (0.0, 0.0);
        for i in (0..set.len()).filter(|&i| self.island[i] == first) {
            let (before, after) = (set.u_before(i), set.velocity_by_impulses(i));
            work += ((after + before) * 0.5).dot(&set.p[i]);
            size += (after.norm() + before.norm()) * set.p[i].norm();
            if let Rule::Spring(spring) = set.rule(i) {
                work += spring.spring.potential(spring.gap_after(after[0])) - spring.spring.potential(spring.gap);
            }
        }
        (work, WORKLESS * size)
    }
}
