//! From contacts that were found to the velocities after them, in one call.

use super::{ContactStage, Over};
use crate::mismatch::length;
use crate::{Model, Responses, State, StepError, Workspace};
use teeter_contact::Outcome;

impl<const D: usize> ContactStage<D> {
    /// [Poses](Self::pose), [solves](Self::solve), [responds](Self::respond) and [completes](Self::complete) the contacts
    /// that were found, each by its pair's law: `v`, the free velocities, become those after the impulses. Velocities before
    /// are those of `state`; over [`Over::Instant`], which leaves no time for forces, they are `v` itself. A scheme that does
    /// more in between takes the four one by one.
    ///
    /// # Errors
    /// As these four; what is wrong with the contact problem is said to be so at the time of `state`.
    #[inline]
    pub fn resolve(
        &mut self,
        model: &Model<D>,
        state: &State,
        v: &mut [f64],
        over: Over,
        responses: &Responses<'_>,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, StepError> {
        self.forget_solution();
        if self.is_empty() {
            return Ok(None);
        }
        let problem = |source| StepError::Problem { t: state.t, source };
        // What the four check is checked once.
        self.check_factors(model, work, responses).map_err(problem)?;
        model.fits(&state.q, &state.v)?;
        length("the velocities", v, model.size().v)?;
        let before = if over == Over::Instant { &*v } else { &state.v };
        self.pose_all(model, state, before, v, over).map_err(problem)?;
        let outcome = self.solve_all(model, work, responses, over).map_err(problem)?;
        self.respond_all(model, work, responses, v).map_err(problem)?;
        self.complete_all(v);
        Ok(Some(outcome))
    }
}
