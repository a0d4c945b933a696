//! From posed contacts to impulses, and to velocities.

use super::{ContactError, ContactRows, ContactStage, Over, Problem, Rule};
use crate::compliance::Span;
use crate::laws::{Laws, join};
use crate::mismatch::length;
use crate::{Coupling, Model, Responses, Workspace};
use teeter_contact::{Block, Outcome};

/// Which contacts of a stage a problem is of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Members<'a> {
    /// All, in their order.
    All,
    /// These.
    Of(&'a [usize]),
}

impl Members<'_> {
    /// The number in the stage of contact `k` of the problem.
    pub(crate) fn number(&self, k: usize) -> usize {
        match self {
            Self::All => k,
            Self::Of(members) => members[k],
        }
    }
}

impl Over {
    /// The weight of the velocity after in the mean that impulses do work with.
    pub(super) fn weight(self) -> f64 {
        match self {
            Self::Step { weight, .. } => weight,
            Self::Instant | Self::Acceleration => 0.5,
        }
    }
}

/// hV/(2D) of a long beam: its mobility is C s^(−½), so that V goes with √h.
const LONG_BEAM: f64 = 0.75;

impl<const D: usize> ContactStage<D> {
    /// Finds the impulses (forces over [`Over::Acceleration`]) of all contacts, which have been posed. `None` without contacts.
    ///
    /// Contacts of bodies that stand apart are problems of their own where there are many, so that time and memory grow with their number;
    /// the laws that are more than a shift are brought to a few problems of the solver. An unsolved problem is not an error but an outcome.
    ///
    /// # Errors
    /// If the contacts don't make a problem: a number is not finite, a contact can't move; if one was not posed, or the factors weren't
    /// made; or if stage, workspace and model don't belong together.
    pub fn solve(
        &mut self,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        over: Over,
    ) -> Result<Option<Outcome>, ContactError> {
        if !self.is_ready(model, work, responses)? {
            return Ok(None);
        }
        self.solve_all(model, work, responses, over).map(Some)
    }

    /// The same without checks, and with a contact at least.
    #[inline(always)]
    pub(super) fn solve_all(
        &mut self,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        over: Over,
    ) -> Result<Outcome, ContactError> {
        self.forces = over == Over::Acceleration;
        if let Some(outcome) = self.solve_apart(model, work, responses, over, &mut |_, _, _, _| Ok(false))? {
            return Ok(outcome);
        }
        let Self { rows, problem, extra, .. } = self;
        couple(rows, model, work, responses, &rows.spans, problem);
        add_compliances(extra, problem);
        self.coupled = work.coupled;
        work.solve_problem(&mut self.problem, over.weight())
    }

    /// Computes H of all contacts, dense, without solving anything.
    pub(crate) fn couple(
        &mut self,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
    ) -> Result<(), ContactError> {
        if self.is_empty() {
            return Ok(());
        }
        if let Some(part) = work.factors.missing(model, responses) {
            return Err(ContactError::Factors { part });
        }
        let Self { rows, problem, .. } = self;
        couple(rows, model, work, responses, &rows.spans, problem);
        (self.apart, self.forces, self.coupled) = (false, false, work.coupled);
        Ok(())
    }

    /// Checks what is to be solved; whether there is anything.
    #[inline]
    fn is_ready(
        &mut self,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
    ) -> Result<bool, ContactError> {
        self.forget_solution();
        if self.is_empty() {
            return Ok(false);
        }
        if let Some(contact) = self.problem.rules().position(|rule| matches!(rule, Rule::Unposed)) {
            return Err(ContactError::Unposed { contact });
        }
        self.check_factors(model, work, responses)?;
        Ok(true)
    }

    pub(super) fn forget_solution(&mut self) {
        (self.apart, self.forces) = (false, false);
    }

    /// Checks that stage, workspace and model belong together, and that there are factors.
    #[inline(always)]
    pub(super) fn check_factors(
        &self,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
    ) -> Result<(), ContactError> {
        self.check(model)?;
        work.check(model)?;
        match work.factors.missing(model, responses) {
            Some(part) => Err(ContactError::Factors { part }),
            None => Ok(()),
        }
    }

    /// As [`ContactStage::solve`]; after each solve `guard` may change the problem, and says whether it is to be solved again.
    #[inline]
    pub(crate) fn solve_guarded(
        &mut self,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        over: Over,
        mut guard: impl FnMut(&Self, &mut Problem<D>, &Laws<D>, Members<'_>) -> Result<bool, ContactError>,
    ) -> Result<Option<Outcome>, ContactError> {
        if !self.is_ready(model, work, responses)? {
            return Ok(None);
        }
        if let Some(outcome) = self.solve_apart(model, work, responses, over, &mut guard)? {
            return Ok(Some(outcome));
        }
        let mut problem = std::mem::take(&mut self.problem);
        let outcome = self.solve_whole(model, &mut problem, work, responses, over, guard);
        self.problem = problem;
        self.coupled = work.coupled;
        outcome.map(Some)
    }

    fn solve_whole(
        &self,
        model: &Model<D>,
        problem: &mut Problem<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        over: Over,
        mut guard: impl FnMut(&Self, &mut Problem<D>, &Laws<D>, Members<'_>) -> Result<bool, ContactError>,
    ) -> Result<Outcome, ContactError> {
        couple(&self.rows, model, work, responses, &self.rows.spans, problem);
        add_compliances(&self.extra, problem);
        let mut outcome = work.solve_problem(problem, over.weight())?;
        // Whoever guards guards one contact more each time, so it ends.
        while guard(self, problem, &work.laws, Members::All)? {
            outcome = join(outcome, work.solve_problem(problem, over.weight())?);
        }
        Ok(outcome)
    }

    /// What a unit impulse along the normal of contact `i` does by way of one part, 1/kg: to its normal velocity as its responses have it,
    /// and to the true one at the end.
    pub(crate) fn own_response(
        &mut self,
        i: usize,
        index: usize,
        model: &Model<D>,
        responses: &Responses<'_>,
        work: &mut Workspace<D>,
    ) -> [f64; 2] {
        let part = &model.parts()[index];
        let Some(mut answer) = work.factors.answer(index, responses) else { return [0.0; 2] };
        let mut blocks = [[Block::<D>::zeros()]; 2];
        let scratch = &mut work.scratch[..part.v.len()];
        let rows = self.rows.of_island(index, &self.rows.spans[i..=i]);
        answer.couple(&rows, scratch, &mut Coupling::dense(1, &mut blocks[0]));
        answer.couple_rates(&rows, scratch, &mut Coupling::dense(1, &mut blocks[1]));
        if answer.rings() && !part.is_prescribed() {
            blocks[1][0] *= LONG_BEAM;
        }
        work.coupled += 1;
        blocks.map(|block| block[0][(0, 0)])
    }

    /// Adds W Jᵀ p to velocities `v`, after [`solve`](Self::solve) with the same responses; `v` become those after the impulses (added accelerations over
    /// [`Over::Acceleration`]).
    ///
    /// # Errors
    /// If stage, workspace, model and velocities don't belong together.
    #[inline]
    pub fn respond(
        &self,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        v: &mut [f64],
    ) -> Result<(), ContactError> {
        if self.is_empty() {
            return Ok(());
        }
        self.check(model)?;
        work.check(model)?;
        length("the velocities", v, model.size().v)?;
        self.respond_all(model, work, responses, v)
    }

    /// The same without checks.
    #[inline(always)]
    pub(super) fn respond_all(
        &self,
        model: &Model<D>,
        work: &mut Workspace<D>,
        responses: &Responses<'_>,
        v: &mut [f64],
    ) -> Result<(), ContactError> {
        // What a factor keeps of coupling is of the contacts that were coupled last, and of an island numbered within it.
        let kept = !self.apart && self.coupled == work.coupled;
        let Workspace { factors, scratch, .. } = work;
        let (mut answers, mut rows) = (factors.answers(responses), self.rows.of_part(0));
        for (index, part) in model.parts().iter().enumerate() {
            if !self.rows.may_act_on(index) {
                continue;
            }
            rows.part = index;
            let Some(mut answer) = answers.of(index) else {
                return Err(ContactError::Factors { part: index });
            };
            let (scratch, v) = (&mut scratch[part.v.clone()], &mut v[part.v.clone()]);
            answer.respond(&rows, &self.problem.p, scratch, v, kept);
        }
        Ok(())
    }
}

/// H = Σ J W Jᵀ over the subsystems, of the contacts with these rows.
#[inline(always)]
pub(super) fn couple<const D: usize>(
    rows: &ContactRows<D>,
    model: &Model<D>,
    work: &mut Workspace<D>,
    responses: &Responses<'_>,
    spans: &[[Span; 2]],
    problem: &mut Problem<D>,
) {
    let mut coupling = problem.coupling();
    work.coupled += 1;
    couple_into(&mut coupling, rows, model, work, responses, spans);
}

/// The same, added to an H that is there.
#[inline(always)]
pub(super) fn couple_into<const D: usize>(
    coupling: &mut Coupling<'_, D>,
    rows: &ContactRows<D>,
    model: &Model<D>,
    work: &mut Workspace<D>,
    responses: &Responses<'_>,
    spans: &[[Span; 2]],
) {
    let Workspace { factors, scratch, .. } = work;
    let (mut answers, mut of_part) = (factors.answers(responses), rows.of_island(0, spans));
    for (index, part) in model.parts().iter().enumerate() {
        if !rows.may_act_on(index) {
            continue;
        }
        of_part.part = index;
        if let Some(mut answer) = answers.of(index) {
            answer.couple(&of_part, &mut scratch[..part.v.len()], coupling);
        }
    }
}

/// κ beside H.
fn add_compliances<const D: usize>(extra: &[(usize, Block<D>)], problem: &mut Problem<D>) {
    for (i, kappa) in extra {
        problem.add_own(*i, kappa);
    }
}

impl<const D: usize> Problem<D> {
    /// Leaves the problem in which contacts that slide in a given direction d have one unknown, p_n: p = p_n (n − μ d).
    pub(crate) fn with_directions(&self, reduced: &mut Self) -> Result<(), ContactError> {
        let n = self.len();
        reduced.copy_from(self);
        for (j, posed) in self.posed.iter().enumerate() {
            let Rule::SlidesAlong(d) = posed.rule else {
                if matches!(posed.rule, Rule::Shifted | Rule::Frictionless) {
                    continue;
                }
                let slides = |rule: &Rule<D>| matches!(rule, Rule::SlidesAlong(_));
                return Err(ContactError::Rules { contact: self.rules().position(slides).unwrap_or(j) });
            };
            let direction = Self::direction(&d, self.mu[j]);
            for i in 0..n {
                let block = &mut reduced.blocks[i * n + j];
                let normal = *block * direction;
                block.fill(0.0);
                block.set_column(0, &normal);
            }
            for i in 0..n {
                let block = &mut reduced.blocks[j * n + i];
                (1..D).for_each(|k| block.row_mut(k).fill(0.0));
            }
            // Tangents that nothing pushes, and that push nothing.
            let own = self.blocks[j * n + j].trace();
            (1..D).for_each(|k| reduced.blocks[j * n + j][(k, k)] = own);
            let normal = self.q[j][0];
            reduced.q[j].fill(0.0);
            reduced.q[j][0] = normal;
            reduced.mu[j] = 0.0;
        }
        Ok(())
    }

    /// n − μ d.
    fn direction(d: &crate::Vector<D>, mu: f64) -> crate::Vector<D> {
        let mut direction = -crate::contact::tangential(d) * mu;
        direction[0] = 1.0;
        direction
    }

    /// Takes the impulses of [`Problem::with_directions`].
    pub(crate) fn take_directed(&mut self, reduced: &Self) {
        for (i, posed) in self.posed.iter().enumerate() {
            self.p[i] = match posed.rule {
                Rule::SlidesAlong(d) => Self::direction(&d, self.mu[i]) * reduced.p[i][0],
                _ => reduced.p[i],
            };
        }
    }
}
