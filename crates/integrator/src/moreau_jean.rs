//! Moreau–Jean's θ scheme (Jean 1999, doi 10.1016/S0045-7825(98)00383-1; `docs/theory.md` §5).
//!
//! ```text
//! W      = (M + hθC + h²θ²K)⁻¹
//! v_free = v⁰ + h W [ f_int(q⁰ + hθ v⁰, v⁰) + P̄ ]                P̄ the mean of the loads over the step
//! v¹     = v_free + W Jᵀ p,        q¹ = q⁰ + h(θ v¹ + (1−θ) v⁰)
//! ```
//!
//! A contact is active when the gap at the predicted position q⁰ + γh v⁰ is at most `gap_tolerance`; J is taken there.
//! The law is Signorini's at velocity level with Newton's restitution, and Coulomb's.

use crate::contact::tangential;
use crate::contacts::Rule;
use crate::laws::is_impact;
use crate::spring::{SpringStep, Springs};
use crate::theta_step::{ThetaStep, weights};
use crate::{
    ContactError, ContactSet, ImpactLaw, Model, PairLaw, Scheme, SettingError, State, StepError, StepReport, Vector,
    Workspace,
};
use teeter_contact::Outcome;

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

/// The scheme; see the module's page.
#[derive(Clone, Debug)]
pub struct MoreauJean {
    settings: MoreauJeanSettings,
    step: ThetaStep,
    springs: Springs,
}

impl MoreauJean {
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
        Ok(Self { settings, step: ThetaStep::default(), springs: Springs::default() })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &MoreauJeanSettings {
        &self.settings
    }
}

impl<const D: usize> Scheme<D> for MoreauJean {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn start(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError> {
        self.step.start(model, state, work)?;
        self.springs.reserve(model.detector().capacity());
        state.warm.reserve(model.detector().capacity(), D);
        work.factorise(model, weights(state.dt, self.settings.theta), &state.q)?;
        Ok(())
    }

    fn advance<'w>(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        work: &'w mut Workspace<D>,
    ) -> Result<StepReport<'w, D>, StepError> {
        let MoreauJeanSettings { theta, activation_gamma, gap_tolerance } = self.settings;
        let h = state.dt;
        self.step.check(model, state, work)?;
        let t_end = state.end_of_step();
        work.factorise_all(model, weights(h, theta), &state.q)?;

        self.step.free_velocity(model, state, work, theta, t_end);
        let margin = if model.has_springs() {
            self.step.close(model, state, theta)?;
            self.springs.look(model, &state.q, &self.step.q_at, work)?;
            f64::INFINITY
        } else {
            gap_tolerance
        };
        if model.has_contacts() {
            self.step.predict(model, &state.q, &state.v, activation_gamma * h);
        }
        work.detect_at(model, &self.step.q_at, margin)?;
        let outcome = self.impact(model, state, work).map_err(|source| StepError::Problem { t: state.t, source })?;
        self.step.close(model, state, theta)?;
        let now = self.step.energy_at_end(model, state.t)?;
        let penetration = work.penetration_at(model, &self.step.q_at);
        let energy = self.step.work_of_forces(model, state, work, theta);
        state.warm.clear();
        for contact in work.contacts.contacts() {
            state.warm.keep(contact);
        }
        Ok(self.step.finish(model, state, work, theta, t_end, outcome, penetration, now, energy))
    }
}

impl MoreauJean {
    /// Poses and solves the contact problem of the candidates in `work`; turns v_free into v¹.
    fn impact<const D: usize>(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, ContactError> {
        let ThetaStep { q_at, v_end: v_free, .. } = &mut self.step;
        let theta = self.settings.theta;
        let Workspace { contacts, candidates, .. } = work;
        contacts.clear();
        for candidate in candidates.iter() {
            let law = model.law(candidate.id.pair())?;
            let spring = law.impact.spring();
            if !self.springs.admit(spring.is_some(), candidate, &state.warm, self.settings.gap_tolerance) {
                continue;
            }
            let i = contacts.contacts().len();
            contacts.enter(model, q_at, candidate, &state.warm, law.friction)?;
            if contacts.leave_if_prescribed(model) {
                continue;
            }
            let u_before = contacts.velocity_of(i, &state.v);
            let u_free = contacts.velocity_of(i, v_free);
            let shift = shift(contacts, i, &law, &u_before, &u_free);
            contacts.set(i, u_before, u_free, shift);
            if let Some(spring) = spring {
                let gap = self.springs.gap(candidate.id, &state.warm);
                // With θ < ½ the force at the end of the step would count for less than half, or nothing, of the work.
                let theta = theta.max(0.5);
                let step = SpringStep { spring, gap, u_before: u_before[0], h: state.dt, theta };
                contacts.follow(i, Rule::Spring(step));
            }
        }
        if contacts.contacts().is_empty() {
            return Ok(None);
        }
        work.solve_entered(model, theta, v_free).map(Some)
    }
}

/// The shift of a contact by its law (`docs/laws.md`). Newton's restitution acts on every active contact; the other laws
/// tell impacts from contacts that press.
fn shift<const D: usize>(
    contacts: &mut ContactSet<D>,
    i: usize,
    law: &PairLaw,
    u_before: &Vector<D>,
    u_free: &Vector<D>,
) -> Vector<D> {
    let (e, approaches) = (law.restitution, !contacts.contacts()[i].persisting && u_before[0] < 0.0);
    let tangential_restitution = if approaches { law.tangential_restitution } else { 0.0 };
    let mut shift = tangential(u_before) * tangential_restitution;
    match law.impact {
        ImpactLaw::Newton => shift[0] = e * u_before[0].min(0.0),
        ImpactLaw::Poisson => {
            contacts.follow(i, Rule::Poisson { e, tangential: tangential_restitution });
            shift = Vector::zeros();
        }
        ImpactLaw::Energetic => {
            contacts.follow(i, Rule::Energetic);
            shift[0] = if is_impact(e, u_before, u_free) { e * u_before[0] } else { 0.0 };
        }
        ImpactLaw::KelvinVoigt { .. } | ImpactLaw::HuntCrossley { .. } => shift = Vector::zeros(),
    }
    shift
}
