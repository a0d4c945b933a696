//! The nonsmooth generalized-α scheme: `generalized-alpha` (`docs/schemes.md`).

use crate::alpha_step::AlphaStep;
use crate::closed_step::THETA;
use crate::projected_step::ProjectedStep;
use crate::{Model, MoreauJeanClosedSettings, Scheme, SettingError, State, StepError, StepReport, Workspace};

/// The settings of [`GeneralizedAlpha`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneralizedAlphaSettings {
    /// ρ∞ in [0, 1], by default 0.8: the part of a motion of infinite frequency that is left after a
    /// step. 1 damps nothing, 0 takes such motions away in a step.
    pub spectral_radius: f64,
    /// An open contact closes where the step would end so deep in the surface, and sinking, m: at
    /// least 0, by default 1e-12. The correction of positions has no such tolerance.
    pub gap_tolerance: f64,
}

impl Default for GeneralizedAlphaSettings {
    fn default() -> Self {
        Self { spectral_radius: 0.8, gap_tolerance: 1e-12 }
    }
}

/// The generalized-α scheme with impacts (Brüls, Acary, Cardona 2014, doi
/// 10.1016/j.cma.2014.07.025), and friction at velocity level (Galvez and others 2020, doi
/// 10.1002/nme.6371): a smooth motion, jumps of velocities, and a correction of positions.
///
/// ```text
/// M ã = F(q, v)                                            F without loads and contacts
/// (1−α_m) a¹ + α_m a⁰ = (1−α_f) ã¹ + α_f ã⁰
/// v¹ = v⁰ + h[(1−γ) a⁰ + γ a¹] + W,                        M W = Jᵀp + hP̄
/// q̃  = q⁰ + h v⁰ + h²[(½−β) a⁰ + β a¹] + ½hW
/// 0 ≤ g(q¹) ⊥ ν ≥ 0,   q¹ = q̃ + A Jᵀν
/// ```
///
/// with ã¹ taken at q̃ and v¹, so that forces answer the jump within the step: v¹ − v_free = A Jᵀp,
/// A = (1 − γ/2β) M⁻¹ + (γ/2β)(1−α_m) S⁻¹ for C = 0. The law of contacts, which of them are active and what keeps
/// them from giving energy are those of [`MoreauJeanClosed`](crate::MoreauJeanClosed).
///
/// **Where it differs from the paper**: positions move with ½hW, as friction that holds a block
/// must hold its place too, and as a correction by ν along normals can't do that. Loads act by
/// their impulses, as contacts do, so that none is lost however short it is. The correction has the
/// metric of A in place of M. Contacts are active by flags of the closed step.
#[derive(Debug)]
pub struct GeneralizedAlpha<const D: usize> {
    settings: GeneralizedAlphaSettings,
    step: ProjectedStep<D, AlphaStep>,
}

impl<const D: usize> GeneralizedAlpha<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "generalized-alpha";

    /// A scheme with these settings.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(settings: GeneralizedAlphaSettings) -> Result<Self, SettingError> {
        let GeneralizedAlphaSettings { spectral_radius, gap_tolerance } = settings;
        if !(0.0..=1.0).contains(&spectral_radius) {
            return Err(SettingError { what: "spectral_radius", value: spectral_radius, rule: "in [0, 1]" });
        }
        MoreauJeanClosedSettings { gap_tolerance }.check()?;
        Ok(Self { settings, step: ProjectedStep::new(gap_tolerance, AlphaStep::new(spectral_radius)) })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &GeneralizedAlphaSettings {
        &self.settings
    }
}

impl<const D: usize> Scheme<D> for GeneralizedAlpha<D> {
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
