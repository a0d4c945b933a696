//! The contacts of many bodies that stand apart, solved island by island: the dense operator of all of them together is never made.
//!
//! Contacts feel each other through the bodies that they share. Where W of a subsystem is diagonal, as that of blocks, those that share a velocity
//! do; of any other subsystem all that push it. Memory and time then grow with the number of islands, not with its square.

use super::solve::couple;
use super::{ContactError, ContactStage, Members, Over, Problem};
use crate::laws::{Laws, join};
use crate::subsystem::Span;
use crate::{Model, Responses, Workspace};
use teeter_contact::Outcome;

/// From so many contacts on. Below it the dense operator of all costs next to nothing, and the solver finds the islands in it.
const MANY: usize = 64;

const NONE: usize = usize::MAX;

/// Memory for the islands.
#[derive(Debug, Default)]
pub(super) struct Islands<const D: usize> {
    /// Of each velocity, the first contact that pushes it.
    first: Vec<usize>,
    /// Of each contact, one before it of the same island, or itself.
    parent: Vec<usize>,
    /// The contacts, island by island, and the numbers of their islands' first.
    order: Vec<(usize, usize)>,
    members: Vec<usize>,
    spans: Vec<[Span; 2]>,
    problem: Problem<D>,
}

impl<const D: usize> Islands<D> {
    fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    /// Finds the islands of the stage's contacts; `false` where there is one only.
    fn find(&mut self, stage: &ContactStage<D>, model: &Model<D>, mut is_diagonal: impl FnMut(usize) -> bool) -> bool {
        let n = stage.len();
        self.first.clear();
        self.first.resize(model.size().v, NONE);
        self.parent.clear();
        self.parent.extend(0..n);
        for (i, sides) in stage.rows.spans.iter().enumerate() {
            let mut join = |key: usize| match self.first[key] {
                NONE => self.first[key] = i,
                other => {
                    let (a, b) = (self.root(i), self.root(other));
                    self.parent[a.max(b)] = a.min(b);
                }
            };
            for side in sides.iter().filter(|side| side.len > 0) {
                if is_diagonal(side.part) {
                    stage.rows.columns_of(side).for_each(&mut join);
                } else {
                    join(model.parts()[side.part].v.start);
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
}

impl<const D: usize> ContactStage<D> {
    /// Solves the stage's problem island by island, and leaves the impulses in it. `None` where that is not worth while: few contacts, or
    /// one island only.
    ///
    /// The outcome is that of all islands: converged if all are; residuals are the largest, each in its island's own scale; iterations the
    /// most of an island.
    #[inline]
    pub(super) fn solve_apart(
        &mut self,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        over: Over,
        guard: &mut impl FnMut(&Self, &mut Problem<D>, &Laws<D>, Members<'_>) -> Result<bool, ContactError>,
    ) -> Result<Option<Outcome>, ContactError> {
        if self.len() < MANY {
            return Ok(None);
        }
        let mut islands = std::mem::take(&mut self.islands);
        let outcome = self.solve_islands(&mut islands, model, work, responses, over, guard);
        self.islands = islands;
        self.apart = matches!(outcome, Ok(Some(_)));
        outcome
    }

    #[inline(never)]
    fn solve_islands(
        &mut self,
        islands: &mut Islands<D>,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        over: Over,
        guard: &mut impl FnMut(&Self, &mut Problem<D>, &Laws<D>, Members<'_>) -> Result<bool, ContactError>,
    ) -> Result<Option<Outcome>, ContactError> {
        let factors = &mut work.factors;
        let mut is_diagonal = |part: usize| {
            responses.of(part).and_then(|w| factors.of(part, w)).is_some_and(|factor| factor.is_diagonal())
        };
        if !islands.find(self, model, &mut is_diagonal) {
            return Ok(None);
        }
        self.extra.sort_by_key(|(i, _)| *i);
        let mut all: Option<Outcome> = None;
        let mut start = 0;
        while let Some(&(root, _)) = islands.order.get(start) {
            let island = islands.order[start..].iter().take_while(|(other, _)| *other == root);
            islands.members.clear();
            islands.members.extend(island.map(|(_, i)| *i));
            start += islands.members.len();
            let Islands { members, spans, problem, .. } = islands;
            spans.clear();
            spans.extend(members.iter().map(|i| self.rows.spans[*i]));
            problem.take_part(&self.problem, members);
            couple(&self.rows, model, work, responses, spans, problem);
            for (k, i) in members.iter().enumerate() {
                let from = self.extra.partition_point(|(other, _)| other < i);
                for (_, kappa) in self.extra[from..].iter().take_while(|(other, _)| other == i) {
                    problem.blocks[k * members.len() + k] += kappa;
                }
            }
            let mut outcome = work.solve_problem(problem, over.weight())?;
            while guard(self, problem, &work.laws, Members::Of(members))? {
                outcome = join(outcome, work.solve_problem(problem, over.weight())?);
            }
            outcome.residual.worst_contact = members.get(outcome.residual.worst_contact).copied().unwrap_or(0);
            self.problem.put_part(problem, members);
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
