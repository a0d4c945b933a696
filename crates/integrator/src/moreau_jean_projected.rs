//! The Moreau–Jean step with projection of the coordinates: `moreau-jean-projected`
//! (`docs/schemes.md`).

use crate::closed_step::THETA;
use crate::projected_step::ProjectedStep;
use crate::theta_step::ThetaStep;
use crate::{Model, MoreauJeanClosedSettings, Scheme, SettingError, State, StepError, StepReport, Workspace};

/// The settings of [`MoreauJeanProjected`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoreauJeanProjectedSettings {
    /// An open contact closes where the step would end so deep in the surface, and sinking, m: at
    /// least 0, by default 1e-12. The projection has no such tolerance: it ends at rounding.
    pub gap_tolerance: f64,
}

impl Default for MoreauJeanProjectedSettings {
    fn default() -> Self {
        Self { gap_tolerance: 1e-12 }
    }
}

/// The combined scheme (Acary 2013, doi 10.1016/j.cma.2012.12.012) on the step of
/// [`MoreauJeanClosed`](crate::MoreauJeanClosed): no contact is in the surface at the end of a step.
///
/// After the step to q̃ and v¹, coordinates are projected, while velocities stay:
///
/// ```text
/// 0 ≤ g(q¹) ⊥ ν ≥ 0,   q¹ = q̃ + W Jᵀ ν
/// ```
///
/// by Newton's method, to rounding. An open contact that is pushed apart takes part in the step,
/// which is then taken again, until the set of contacts settles. The paper activates contacts by a
/// predicted gap; here they are those of the closed step, as a projected gap of ±1e-17 m can't say
/// whether a contact lasts. The metric is that of W in place of M: with M a beam's highest modes
/// would take the correction, and keep its energy.
///
/// What the projection does to the energy is in the column of its own of the account; it may lift
/// a block that has sunk in at an impact. Contacts with duration are not projected.
#[derive(Debug)]
pub struct MoreauJeanProjected<const D: usize> {
    settings: MoreauJeanProjectedSettings,
    step: ProjectedStep<D, ThetaStep>,
}

impl<const D: usize> MoreauJeanProjected<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "moreau-jean-projected";

    /// A scheme with these settings.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(settings: MoreauJeanProjectedSettings) -> Result<Self, SettingError> {
        let gap_tolerance = settings.gap_tolerance;
        MoreauJeanClosedSettings { gap_tolerance }.check()?;
        Ok(Self { settings, step: ProjectedStep::new(gap_tolerance, ThetaStep::default()) })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &MoreauJeanProjectedSettings {
        &self.settings
    }
}

impl<const D: usize> Scheme<D> for MoreauJeanProjected<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn drives_about(&self) -> Option<f64> {
        Some(THETA)
    }

    fn start(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError> {
        self.step.start(model, state, work)
    }

    fn advance<'w>(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        until: f64,
        work: &'w mut Workspace<D>,
    ) -> Result<StepReport<'w, D>, StepError> {
        self.step.advance(model, state, until, work)
    }
}
