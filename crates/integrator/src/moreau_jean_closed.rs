//! The Moreau–Jean step with contacts that stay closed: `moreau-jean-closed` (`docs/schemes.md`).

use crate::closed_step::ClosedStep;
use crate::{Model, Scheme, SettingError, State, StepError, StepReport, Workspace};

/// The settings of [`MoreauJeanClosed`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoreauJeanClosedSettings {
    /// An open contact closes where the step would end so deep in the surface, and sinking, m.
    pub gap_tolerance: f64,
}

impl Default for MoreauJeanClosedSettings {
    fn default() -> Self {
        Self { gap_tolerance: 1e-12 }
    }
}

impl MoreauJeanClosedSettings {
    /// What is out of its range.
    pub(crate) fn check(&self) -> Result<(), SettingError> {
        let gap = self.gap_tolerance;
        let good = gap >= 0.0 && gap.is_finite();
        if good { Ok(()) } else { Err(SettingError { what: "gap_tolerance", value: gap, rule: "at least 0 m" }) }
    }
}

/// The Moreau–Jean step at θ = ½ with contacts that stay closed from step to step: no contact gives
/// energy, gaps don't drift apart, and restitution tells impacts from contacts that press.
///
/// The matrices, the free velocity and the contact solver are those of
/// [`MoreauJean`](crate::MoreauJean) at θ = ½. What is different is which contacts take part, and
/// the shift s of the law:
///
/// ```text
/// q̃_m = q⁰ + ¼h(v⁰ + v_free),   q̃ = q⁰ + ½h(v⁰ + v_free)
/// J = J(q̃_m),   U⁰ = J v⁰,   b = (J(q̃) − J) v⁰
/// s_n = U_n⁰ if |U_n⁰ − b_n| ≤ |b_n|, else max(b_n, U_n⁰)
/// s_t = U_t⁰ if ‖U_t⁰ − b_t‖ ≤ ‖b_t‖, else b_t
/// 0 ≤ U_n¹ + s_n ⊥ p_n ≥ 0,   Coulomb on U_t¹ + s_t
/// ```
///
/// Where an elastic surface comes out under a base and carries it, v¹ of the motion that was found takes the place of v_free in q̃_m and q̃
/// (`docs/schemes.md`).
///
/// A contact that pressed in a step is *closed* in the next, whatever its gap. An open contact
/// becomes closed where the step would end in the surface, and deeper than it began: the step is
/// then tried again. If it approaches, s_n = e U_n⁰ for an impact, and 0 for an approach that its
/// free acceleration makes within the step. J at mid-step and b make the closed contact end the
/// step with the velocity that the surface has there, so its gap doesn't drift apart as that of the
/// page's scheme does.
///
/// **Work**: U_n¹ = −s_n where p_n > 0, so Ū_n p_n = ½(U_n⁰ − s_n) p_n ≤ 0, as s_n ≥ U_n⁰. Friction obeys (U_t¹ + s_t)·p_t ≤ 0; where
/// that leaves a contact with Ū·p > 0 all the same, as where a slide turns within the step, its
/// shift becomes s_n = max(s_n, U_n⁰), and s_t = U_t⁰ or no friction at all, whichever ends nearer
/// to rest; with both Ū·p ≤ 0. The problem is solved once more. So no contact gives energy in any
/// step. (But for closed contacts with what moves as prescribed: there Ū is relative, and they are
/// left as they are.)
#[derive(Debug)]
pub struct MoreauJeanClosed<const D: usize> {
    settings: MoreauJeanClosedSettings,
    step: ClosedStep<D>,
}

impl<const D: usize> MoreauJeanClosed<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "moreau-jean-closed";

    /// A scheme with these settings.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(settings: MoreauJeanClosedSettings) -> Result<Self, SettingError> {
        settings.check()?;
        Ok(Self { settings, step: ClosedStep::new(settings.gap_tolerance) })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &MoreauJeanClosedSettings {
        &self.settings
    }
}

impl<const D: usize> Scheme<D> for MoreauJeanClosed<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn drives_about(&self) -> Option<f64> {
        Some(crate::closed_step::THETA)
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
        let span = state.next_step(until);
        work.begin(model, state, span)?;
        self.step.check(model)?;
        self.step.begin(model, state, &span, work)?;
        let outcome = self.step.settle(model, state, &span, work)?;
        let penetration = deepest(work);
        self.step.find_what_stays();
        self.step.end_phase(model, state, &span, outcome, work)?;
        let stays = &self.step.stays;
        work.finish(model, state, Some(penetration), |i, _| stays[i])
    }
}

/// The deepest penetration of the candidates that were found last, m.
pub(crate) fn deepest<const D: usize>(work: &Workspace<D>) -> f64 {
    work.candidates.iter().map(|candidate| -candidate.gap).fold(0.0, f64::max)
}
