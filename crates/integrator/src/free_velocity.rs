//! Velocities without contacts, for schemes that take forces as they are.

use crate::mismatch::length;
use crate::{Keep, Model, StepError, StepSpan, Weights, Workspace};

impl<const D: usize> Workspace<D> {
    /// Leaves the velocities that a step without contacts ends with in `out`:
    ///
    /// ```text
    /// out = v + h W [ f_int(q, v) + P̄ ]
    /// ```
    ///
    /// with P̄ the means of the loads over the step, and W the inverse for the weights `w`, made here if there is none yet
    /// ([pinned](Keep::Pinned)): [`Weights::MASS`] for an explicit step. Prescribed velocities stay as they are in `v`.
    ///
    /// # Errors
    /// If a matrix can't be factorised, the workspace is of another model, or there are too few or too many coordinates or
    /// velocities.
    pub fn free_velocity(
        &mut self,
        model: &Model<D>,
        w: Weights,
        q: &[f64],
        v: &[f64],
        span: &StepSpan,
        out: &mut Vec<f64>,
    ) -> Result<(), StepError> {
        self.factors(model, w, q, Keep::Pinned)?;
        length("the velocities", v, model.size().v)?;
        out.clear();
        out.resize(v.len(), 0.0);
        for (index, part) in model.parts().iter().enumerate() {
            let (q, range) = (&q[part.q.clone()], part.v.clone());
            let Some(factor) = self.factors.of(index, w).filter(|_| !range.is_empty()) else { continue };
            let (f, v) = (&mut out[range.clone()], &v[range.clone()]);
            part.system.internal_force(q, v, f);
            if part.traits.loaded {
                part.system.mean_load([span.start, span.end], &mut self.scratch[..v.len()], f);
            }
            if part.traits.follows_coordinates {
                factor.update(q);
            }
            factor.solve(f);
            f.iter_mut().zip(v).for_each(|(f, v)| *f = v + span.h * *f);
        }
        Ok(())
    }
}
