//! The contacts of many bodies that stand apart, solved island by island: the dense operator of all
//! of them together is never made.
//!
//! Contacts feel each other through the bodies that they share. Where W of a subsystem is diagonal,
//! as that of blocks, those that share a velocity do; of any other subsystem all that push it. A
//! prescribed velocity yields to nobody, so that nobody feels another through it: blocks on ground
//! that shakes stand apart as those on ground at rest. Memory and time then grow with the number of
//! islands, not with its square.

use super::kept::Kept;
use super::solve::{couple, couple_into};
use super::{ContactError, ContactRows, ContactStage, Members, Over, Problem};
use crate::compliance::Span;
use crate::laws::{Laws, join};
use crate::{Model, Responses, Workspace};
use teeter_contact::{Incidence, Outcome};

/// From so many contacts on. Below it the dense operator of all costs next to nothing, and the
/// solver finds the islands in it. An island of so many is coupled by neighbours, if most of its
/// contacts are none.
const MANY: usize = 64;

/// Memory for the islands.
#[derive(Debug, Default)]
pub(super) struct Islands<const D: usize> {
    coupler: Coupler,
    /// What each contact shares with others.
    shared: Incidence,
    found: teeter_contact::Islands,
    problem: Problem<D>,
    /// What is known of the attempt before, if it is to be kept.
    kept: Option<Kept<D>>,
    /// Of each island, once it is solved.
    outcomes: Vec<Option<Outcome>>,
    #[cfg(feature = "parallel")]
    batch: crate::threads::Batch<D>,
}

/// Memory for coupling the contacts of an island.
#[derive(Debug, Default)]
struct Coupler {
    /// Whether W of each subsystem is diagonal.
    diagonal: Vec<bool>,
    /// What each contact of the island shares with others.
    own: Incidence,
    spans: Vec<[Span; 2]>,
}

impl<const D: usize> Islands<D> {
    pub(super) fn keep_anew(&mut self) {
        self.kept.get_or_insert_default().forget();
    }
}

/// What a contact shares with others: the velocities that it pushes where W is diagonal, else the
/// subsystem; prescribed ones not.
fn keys<'a, const D: usize>(
    rows: &'a ContactRows<D>,
    model: &'a Model<D>,
    diagonal: &'a [bool],
    sides: &'a [Span; 2],
) -> impl Iterator<Item = usize> + 'a {
    let moves = |side: &&Span| side.len > 0 && !model.parts()[side.part].is_prescribed();
    sides.iter().filter(moves).flat_map(move |side| {
        let apart = diagonal[side.part];
        let (all, driven) = (model.parts()[side.part].v.start, &model.parts()[side.part].traits.driven);
        let columns =
            rows.columns_of(side).filter(move |column| !apart || driven.binary_search(&(column - all)).is_err());
        columns.take(if apart { side.len } else { 1 }).map(move |column| if apart { column } else { all })
    })
}

impl<const D: usize> ContactStage<D> {
    /// Solves the stage's problem island by island, and leaves the impulses in it. `None` where
    /// that is not worth while: few contacts, or one island only.
    ///
    /// The outcome is that of all islands: converged if all are; residuals are the largest, each in
    /// its island's own scale; iterations the most of an island.
    #[inline(always)]
    pub(super) fn solve_apart(
        &mut self,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        over: Over,
        guard: &mut impl FnMut(&Self, &mut Problem<D>, &Laws<D>, Members<'_>) -> Result<bool, ContactError>,
    ) -> Result<Option<Outcome>, ContactError> {
        if self.len() < MANY { Ok(None) } else { self.solve_many_apart(model, work, responses, over, guard) }
    }

    #[inline(never)]
    fn solve_many_apart(
        &mut self,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        over: Over,
        guard: &mut impl FnMut(&Self, &mut Problem<D>, &Laws<D>, Members<'_>) -> Result<bool, ContactError>,
    ) -> Result<Option<Outcome>, ContactError> {
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
        let Islands { coupler, shared, found, problem, kept, outcomes, .. } = islands;
        coupler.diagonal.clear();
        for part in 0..model.parts().len() {
            let answer = work.factors.answer(part, responses);
            coupler.diagonal.push(answer.is_some_and(|answer| answer.is_diagonal()));
        }
        shared.load(self.len(), |i| keys(&self.rows, model, &coupler.diagonal, &self.rows.spans[i]));
        found.find_shared(shared);
        if found.len() == 1 && !self.problem.is_standard() {
            return Ok(None);
        }
        self.extra.sort_by_key(|(i, _)| *i);
        // What is known is of contacts without more compliance than their rows have.
        let mut kept = kept.as_mut().filter(|_| self.extra.is_empty());
        if let Some(kept) = &mut kept {
            kept.recognise(&self.contacts, &self.problem);
        }
        outcomes.clear();
        #[cfg(feature = "parallel")]
        let by_threads = work.solves_on_threads() && found.len() > 1;
        #[cfg(not(feature = "parallel"))]
        let by_threads = false;
        for members in found.iter() {
            if let Some(outcome) = kept.as_ref().and_then(|kept| kept.restore(&mut self.problem, members)) {
                outcomes.push(Some(outcome));
                continue;
            }
            if by_threads {
                outcomes.push(None);
                continue;
            }
            if !self.couple_island(members, found.len() == 1, model, work, responses, coupler, problem) {
                return Ok(None);
            }
            let outcome = work.solve_problem(problem, over.weight())?;
            outcomes.push(Some(self.finish_island(members, outcome, work, over, problem, guard)?));
        }
        #[cfg(feature = "parallel")]
        if by_threads {
            self.solve_on_threads(islands, model, work, responses, over, guard)?;
        }
        let Islands { found, kept, outcomes, .. } = islands;
        if let Some(kept) = kept.as_mut().filter(|_| self.extra.is_empty()) {
            kept.keep(&self.contacts, &self.problem, found, outcomes);
        }
        Ok(outcomes.iter().copied().flatten().reduce(together))
    }

    /// Solves the islands that have no outcome yet, on the threads of the workspace, and adds theirs.
    #[cfg(feature = "parallel")]
    fn solve_on_threads(
        &mut self,
        islands: &mut Islands<D>,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        over: Over,
        guard: &mut impl FnMut(&Self, &mut Problem<D>, &Laws<D>, Members<'_>) -> Result<bool, ContactError>,
    ) -> Result<(), ContactError> {
        let Islands { coupler, found, outcomes, batch, .. } = islands;
        let unsolved = (0..found.len()).filter(|island| outcomes[*island].is_none());
        for job in batch.begin(unsolved, |island| found.members(island).len()) {
            self.couple_island(found.members(job.island), false, model, work, responses, coupler, &mut job.problem);
        }
        work.solve_batch(batch, over.weight());
        for job in batch.jobs() {
            let (members, outcome) = (found.members(job.island), job.take_outcome()?);
            let outcome = self.finish_island(members, outcome, work, over, &mut job.problem, guard)?;
            outcomes[job.island] = Some(outcome);
        }
        Ok(())
    }

    /// Puts the problem of an island's contacts, with H, into `problem`. `false` if it is the only one and its H is better
    /// dense: the stage's own problem is that already.
    #[expect(clippy::too_many_arguments, reason = "an island, what answers for its bodies, and memory")]
    fn couple_island(
        &self,
        members: &[usize],
        alone: bool,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        coupler: &mut Coupler,
        problem: &mut Problem<D>,
    ) -> bool {
        let Coupler { diagonal, own, spans } = coupler;
        spans.clear();
        spans.extend(members.iter().map(|i| self.rows.spans[*i]));
        problem.take_part(&self.problem, members);
        own.load(if members.len() < MANY || !problem.is_standard() { 0 } else { members.len() }, |k| {
            keys(&self.rows, model, diagonal, &spans[k])
        });
        let sparse = own.contacts() > 0 && {
            let coupling = problem.sparse_coupling(own);
            coupling.map(|mut h| couple_into(&mut h, &self.rows, model, work, responses, spans)).is_some()
        };
        if !sparse {
            if alone {
                return false;
            }
            couple(&self.rows, model, work, responses, spans, problem);
        }
        for (k, i) in members.iter().enumerate() {
            let from = self.extra.partition_point(|(other, _)| other < i);
            for (_, kappa) in self.extra[from..].iter().take_while(|(other, _)| other == i) {
                problem.add_own(k, kappa);
            }
        }
        true
    }

    /// Solves a solved island again as often as `guard` wants, and takes its impulses into the stage.
    fn finish_island(
        &mut self,
        members: &[usize],
        mut outcome: Outcome,
        work: &mut Workspace<D>,
        over: Over,
        problem: &mut Problem<D>,
        guard: &mut impl FnMut(&Self, &mut Problem<D>, &Laws<D>, Members<'_>) -> Result<bool, ContactError>,
    ) -> Result<Outcome, ContactError> {
        while guard(self, problem, &work.laws, Members::Of(members))? {
            outcome = join(outcome, work.solve_problem(problem, over.weight())?);
        }
        outcome.residual.worst_contact = members.get(outcome.residual.worst_contact).copied().unwrap_or(0);
        self.problem.put_part(problem, members);
        Ok(outcome)
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
