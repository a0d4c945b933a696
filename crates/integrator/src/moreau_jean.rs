//! Moreau–Jean's θ scheme, `moreau-jean` (`docs/theory.md` §5).

use crate::theta_step::{ThetaStep, weights};
use crate::{
    Balance, ContactStage, Keep, Look, Model, Over, PhaseEnd, PhaseKind, Responses, Scheme, SettingError, State,
    StepError, StepReport, Workspace,
};

/// The settings of [`MoreauJean`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoreauJeanSettings {
    /// θ in [0, 1]. From ½ on the linear part is unconditionally stable, and ½ dissipates nothing; below ½ an undamped
    /// mode grows at every step size.
    pub theta: f64,
    /// γ ≥ 0: the activation looks γ h v⁰ ahead.
    pub activation_gamma: f64,
    /// Largest predicted gap of an active contact, m. With 0 the first step of a body at rest is decided by rounding.
    pub gap_tolerance: f64,
}

impl Default for MoreauJeanSettings {
    fn default() -> Self {
        Self { theta: 0.5, activation_gamma: 0.5, gap_tolerance: 1e-12 }
    }
}

/// Moreau and Jean's θ scheme (Jean 1999, doi 10.1016/S0045-7825(98)00383-1).
///
/// ```text
/// W      = (M + hθC + h²θ²K)⁻¹
/// v_free = v⁰ + h W [ f_int(q⁰ + hθ v⁰, v⁰) + P̄ ]                P̄ the mean of the loads over the step
/// v¹     = v_free + W Jᵀ p,        q¹ = q⁰ + h(θ v¹ + (1−θ) v⁰)
/// ```
///
/// A contact is active when the gap at the predicted position q⁰ + γh v⁰ is at most `gap_tolerance`; J is taken there. The law is Signorini's
/// at velocity level with Newton's restitution, and Coulomb's; the others are brought to it.
#[derive(Debug)]
pub struct MoreauJean<const D: usize = 2> {
    settings: MoreauJeanSettings,
    step: ThetaStep,
    stage: ContactStage<D>,
}

impl<const D: usize> MoreauJean<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "moreau-jean";

    /// A scheme with these settings.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(settings: MoreauJeanSettings) -> Result<Self, SettingError> {
        let check = |what, value: f64, good, rule| {
            if good { Ok(()) } else { Err(SettingError { what, value, rule }) }
        };
        let MoreauJeanSettings { theta, activation_gamma, gap_tolerance } = settings;
        check("theta", theta, (0.0..=1.0).contains(&theta), "in [0, 1]")?;
        check(
            "activation_gamma",
            activation_gamma,
            activation_gamma >= 0.0 && activation_gamma.is_finite(),
            "at least 0",
        )?;
        check("gap_tolerance", gap_tolerance, gap_tolerance >= 0.0 && gap_tolerance.is_finite(), "at least 0 m")?;
        Ok(Self { settings, step: ThetaStep::default(), stage: ContactStage::new() })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &MoreauJeanSettings {
        &self.settings
    }
}

impl<const D: usize> Scheme<D> for MoreauJean<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn drives_about(&self) -> Option<f64> {
        Some(self.settings.theta)
    }

    fn start(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError> {
        self.step.start(model, state, work)?;
        let contacts = model.contacts_to_expect();
        self.stage.reserve(model);
        state.warm.reserve(contacts, D);
        state.memory.reserve(contacts);
        work.factors(model, weights(state.dt, self.settings.theta), &state.q, Keep::Pinned)
    }

    fn advance<'w>(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        until: f64,
        work: &'w mut Workspace<D>,
    ) -> Result<StepReport<'w, D>, StepError> {
        let MoreauJeanSettings { theta, activation_gamma, gap_tolerance } = self.settings;
        let span = state.next_step(until);
        let h = span.h;
        work.begin(model, state, span)?;
        self.step.check(model)?;
        let w = weights(h, theta);
        work.factors(model, w, &state.q, if h == state.dt { Keep::Pinned } else { Keep::Once })?;

        self.step.free_velocity(model, state, work, theta, &span);
        let (over, responses) = (Over::Step { h, weight: theta }, Responses::Of(w));
        let outcome = loop {
            if model.has_springs() {
                self.step.move_freely(model, state, h, theta)?;
            }
            if model.has_contacts() {
                self.step.predict(model, &state.q, &state.v, activation_gamma * h);
            }
            let ThetaStep { q_at, q_free, v_end: v_free, .. } = &mut self.step;
            self.stage.find(model, state, &Look::new(q_at, gap_tolerance).with_free_end(q_free), work)?;
            let outcome = self.stage.resolve(model, state, v_free, over, &responses, work)?;
            if !self.step.takes_another_round(model, state, work, theta, h) {
                break self.step.judge(outcome, work.settings.tolerance);
            }
        };
        self.step.move_to_end(model, state, h, theta);

        let energy = self.step.work_of_forces(model, state, work, &self.stage, h, theta);
        let phase = PhaseEnd {
            balance: Balance::Weighted(theta),
            energy,
            outcome,
            ..PhaseEnd::new(PhaseKind::Step, span.end, &self.step.q_at, &self.step.v_end)
        };
        work.phase(model, &phase, Some(&mut self.stage))?;
        work.finish(model, state, None, |_, _| true)
    }
}
