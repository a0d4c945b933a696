//! The contacts of many bodies that stand apart, solved island by island: the dense operator of all of them together is never made.
//!
//! Contacts feel each other through the bodies that they share. Where every subsystem that they push has a diagonal W, as blocks do,
//! those that share no velocity are problems of their own; memory and time then grow with the number of islands, not with its square.

use crate::contacts::{ContactSet, Rule};
use crate::subsystem::Span;
use crate::{Compliance, Coupling, Model, PartRows, Vector};
use teeter_contact::{Block, ContactProblem, Delassus, Outcome, ProblemError};

/// From so many contacts on. Below it the dense operator of all costs next to nothing, and the solver finds the islands in it.
pub(crate) const MANY: usize = 64;

const NONE: usize = usize::MAX;

/// Memory for the islands.
#[derive(Debug, Default)]
pub(crate) struct Apart<const D: usize> {
    /// Of each velocity, the first contact that pushes it.
    first: Vec<usize>,
    /// Of each contact, one before it of the same island, or itself.
    parent: Vec<usize>,
    /// The contacts, island by island: the island's first contact, and the contact.
    order: Vec<(usize, usize)>,
    spans: Vec<[Span; 2]>,
    blocks: Vec<Block<D>>,
    q: Vec<Vector<D>>,
    mu: Vec<f64>,
    p: Vec<Vector<D>>,
}

impl<const D: usize> Apart<D> {
    fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    /// Finds the islands of the set's contacts; `false` where there is one only.
    fn find(&mut self, set: &ContactSet<D>, velocities: usize) -> bool {
        let n = set.contacts().len();
        self.first.clear();
        self.first.resize(velocities, NONE);
        self.parent.clear();
        self.parent.extend(0..n);
        for i in 0..n {
            for column in set.pushed(i) {
                match self.first[column] {
                    NONE => self.first[column] = i,
                    other => {
                        let (a, b) = (self.root(i), self.root(other));
                        self.parent[a.max(b)] = a.min(b);
                    }
                }
            }
        }
        self.order.clear();
        for i in 0..n {
            let root = self.root(i);
            self.order.push((root, i));
        }
        self.order.sort_unstable();
        self.order.iter().any(|(root, _)| *root != 0)
    }

    /// Solves the set's problem island by island, each by `solve`, and leaves the impulses in the set. `None` where that is not worth
    /// while, or not so: few contacts, laws of several problems, a subsystem whose W isn't diagonal.
    ///
    /// The outcome is that of all islands: converged if all are; residuals are the largest, each in its island's own scale; iterations the
    /// most of an island.
    pub(crate) fn solve(
        &mut self,
        set: &mut ContactSet<D>,
        model: &Model<D>,
        factors: &mut [Box<dyn Compliance<D>>],
        scratch: &mut [f64],
        mut solve: impl FnMut(&ContactProblem<'_, D>, &mut [Vector<D>]) -> Outcome,
    ) -> Result<Option<Outcome>, ProblemError> {
        if set.contacts().len() < MANY || set.rules.iter().any(|rule| *rule != Rule::Shifted) {
            return Ok(None);
        }
        // A subsystem that none of them pushes doesn't matter.
        let diagonal =
            model.parts().iter().zip(factors.iter()).enumerate().all(|(index, (part, factor))| {
                part.v.is_empty() || factor.is_diagonal() || set.rows_of(index).is_empty()
            });
        if !diagonal || !self.find(set, model.size().v) {
            return Ok(None);
        }
        let mut all: Option<Outcome> = None;
        let mut start = 0;
        while let Some(&(root, _)) = self.order.get(start) {
            let len = self.order[start..].iter().take_while(|(other, _)| *other == root).count();
            let island = start..start + len;
            start += len;
            self.blocks.clear();
            self.blocks.resize(len * len, Block::zeros());
            self.spans.clear();
            self.q.clear();
            self.mu.clear();
            self.p.clear();
            for &(_, i) in &self.order[island.clone()] {
                let (spans, q, mu, p) = set.posed(i);
                self.spans.push(spans);
                self.q.push(q);
                self.mu.push(mu);
                self.p.push(p);
            }
            let mut coupling = Coupling { contacts: len, blocks: &mut self.blocks };
            for (index, (part, factor)) in model.parts().iter().zip(factors.iter_mut()).enumerate() {
                let rows = PartRows { spans: &self.spans, ..set.rows_of(index) };
                if !part.v.is_empty() && !rows.is_empty() {
                    factor.couple(&rows, &mut scratch[..part.v.len()], &mut coupling);
                }
            }
            let problem = ContactProblem::new(Delassus::Dense(&self.blocks), &self.q, &self.mu)?;
            let mut outcome = solve(&problem, &mut self.p);
            let members = &self.order[island];
            outcome.residual.worst_contact = members.get(outcome.residual.worst_contact).map_or(0, |(_, i)| *i);
            for ((_, i), p) in members.iter().zip(&self.p) {
                set.p[*i] = *p;
            }
            all = Some(all.map_or(outcome, |all| together(all, outcome)));
        }
        Ok(all)
    }
}

/// The outcome of two islands.
fn together(a: Outcome, b: Outcome) -> Outcome {
    // The worse one says how it ended, and by which method.
    let (mut all, other) = if !(b.residual.global <= a.residual.global) { (b, a) } else { (a, b) };
    if all.converged() && !other.converged() {
        all.status = other.status;
    }
    if !(other.residual.worst <= all.residual.worst) {
        (all.residual.worst, all.residual.worst_contact) = (other.residual.worst, other.residual.worst_contact);
    }
    all.iterations = all.iterations.max(other.iterations);
    all
}
