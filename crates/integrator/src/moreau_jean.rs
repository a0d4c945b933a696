//! Moreau–Jean's θ scheme (Jean 1999, doi 10.1016/S0045-7825(98)00383-1; `docs/theory.md` §5).
//!
//! ```text
//! W      = (M + hθC + h²θ²K)⁻¹
//! v_free = v⁰ + h W [ f_int(q⁰ + hθ v⁰, v⁰) + θP¹ + (1−θ)P⁰ ]
//! v¹     = v_free + W Jᵀ p,        q¹ = q⁰ + h(θ v¹ + (1−θ) v⁰)
//! ```
//!
//! A contact is active when the gap at the predicted position q⁰ + γh v⁰ is at most `gap_tolerance`; J is taken there.
//! The law is Signorini's at velocity level with Newton's restitution, and Coulomb's.

use crate::contacts::tangential;
use crate::{Model, Scheme, SettingError, State, StepEnergy, StepError, StepReport, Weights, Workspace};
use teeter_contact::{Outcome, Stop};

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
#[derive(Clone, Debug, PartialEq)]
pub struct MoreauJean {
    settings: MoreauJeanSettings,
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
        Ok(Self { settings })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &MoreauJeanSettings {
        &self.settings
    }

    fn weights(&self, h: f64) -> Weights {
        let ht = h * self.settings.theta;
        Weights { mass: 1.0, damping: ht, stiffness: ht * ht }
    }
}

impl<const D: usize> Scheme<D> for MoreauJean {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn start(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError> {
        state.warm.reserve(model.detector().capacity(), D);
        work.factorise(model, self.weights(state.dt), &state.q)?;
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
        let t_end = (state.step + 1) as f64 * h;
        work.factorise(model, self.weights(h), &state.q)?;

        self.free_velocity(model, state, work, t_end);
        predict(model, state, activation_gamma * h, work);
        model.detector().detect(&model.placed(&work.q_at), gap_tolerance, &mut work.candidates);
        let outcome = impact(model, state, work).map_err(|source| StepError::Problem { t: state.t, source })?;

        // From here on `v_free` holds v¹.
        let v_mean = &mut work.v_mean;
        for ((mean, v1), v0) in v_mean.iter_mut().zip(&work.v_free).zip(&state.v) {
            *mean = theta * v1 + (1.0 - theta) * v0;
        }
        for (dq, v) in work.dq.iter_mut().zip(&work.v_mean) {
            *dq = h * v;
        }
        model.retract(&state.q, &work.dq, &mut work.q_at);
        if !(all_finite(&work.v_free) && all_finite(&work.q_at)) {
            return Err(StepError::Diverged { t: state.t });
        }

        let mut energy = self.work_of_forces(model, state, work);
        for contact in &work.contacts.contacts {
            let u_theta = contact.u_after * theta + contact.u_before * (1.0 - theta);
            energy.contact += u_theta[0] * contact.p[0];
            energy.friction += tangential(&u_theta).dot(&contact.p);
            let slip = tangential(&contact.u_after).dot(&contact.p);
            state.ledger.largest_tangential_work = state.ledger.largest_tangential_work.max(slip);
        }

        state.q.copy_from_slice(&work.q_at);
        state.v.copy_from_slice(&work.v_free);
        let t_start = std::mem::replace(&mut state.t, t_end);
        state.step += 1;
        state.ledger.enter(model.energy(&state.q, &state.v), &mut energy);
        state.warm.clear();
        for contact in &work.contacts.contacts {
            state.warm.push(contact.id, &contact.p);
        }
        model.detector().detect(&model.placed(&state.q), 0.0, &mut work.candidates);
        let penetration = work.candidates.iter().map(|c| -c.gap).fold(0.0, f64::max);
        tally(state, outcome.as_ref(), work.contacts.len(), penetration);
        let contacts = &work.contacts.contacts;
        Ok(StepReport { step: state.step, t_start, t_end, contacts, outcome, penetration, energy })
    }
}

impl MoreauJean {
    /// Leaves v_free in `work.v_free` and P_θ in `work.load`.
    fn free_velocity<const D: usize>(&self, model: &Model<D>, state: &State, work: &mut Workspace<D>, t_end: f64) {
        let theta = self.settings.theta;
        let h = state.dt;
        predict(model, state, h * theta, work);
        for (part, factor) in model.parts().iter().zip(&mut work.factors) {
            let (q, v) = (part.q.clone(), part.v.clone());
            if v.is_empty() {
                continue;
            }
            let dv = &mut work.dv[v.clone()];
            dv.fill(0.0);
            part.system.internal_force(&work.q_at[q], &state.v[v.clone()], dv);
            if part.system.is_loaded() {
                let (load, scratch) = (&mut work.load[v.clone()], &mut work.scratch[..v.len()]);
                mean_load(part.system.as_ref(), theta, [state.t, t_end], load, scratch);
                add(dv, load);
            }
            dv.iter_mut().for_each(|f| *f *= h);
            factor.solve(dv);
            for ((free, v0), dv) in work.v_free[v.clone()].iter_mut().zip(&state.v[v]).zip(dv.iter()) {
                *free = v0 + dv;
            }
        }
    }

    /// The terms of the energy identity that aren't contact: loads, damping, the scheme itself.
    fn work_of_forces<const D: usize>(&self, model: &Model<D>, state: &State, work: &mut Workspace<D>) -> StepEnergy {
        let theta = self.settings.theta;
        let h = state.dt;
        let mut energy = StepEnergy::default();
        if theta != 0.5 {
            for ((dv, v1), v0) in work.dv.iter_mut().zip(&work.v_free).zip(&state.v) {
                *dv = v1 - v0;
            }
        }
        for part in model.parts() {
            let (q, v) = (&state.q[part.q.clone()], part.v.clone());
            let product = &mut work.product[v.clone()];
            let mut form = |w: Weights, x: &[f64]| {
                product.fill(0.0);
                part.system.apply(w, q, x, product);
                dot(x, product)
            };
            if part.system.is_damped() {
                let c = Weights { damping: 1.0, ..Weights::default() };
                energy.viscous -= h * form(c, &work.v_mean[v.clone()]);
            }
            if theta != 0.5 {
                let m = Weights { mass: 1.0, ..Weights::default() };
                let k = Weights { stiffness: 1.0, ..Weights::default() };
                energy.numerical -= (theta - 0.5) * (form(m, &work.dv[v.clone()]) + form(k, &work.dq[v.clone()]));
            }
            if part.system.is_loaded() {
                energy.external += h * dot(&work.v_mean[v.clone()], &work.load[v]);
            }
        }
        energy
    }
}

/// Leaves q⁰ ⊕ τ v⁰ in `work.q_at`.
fn predict<const D: usize>(model: &Model<D>, state: &State, tau: f64, work: &mut Workspace<D>) {
    for (dq, v) in work.dq.iter_mut().zip(&state.v) {
        *dq = tau * v;
    }
    model.retract(&state.q, &work.dq, &mut work.q_at);
}

/// θP¹ + (1−θ)P⁰ into `load`.
fn mean_load<const D: usize>(
    system: &dyn crate::Subsystem<D>,
    theta: f64,
    t: [f64; 2],
    load: &mut [f64],
    scratch: &mut [f64],
) {
    load.fill(0.0);
    for (t, weight) in [(t[0], 1.0 - theta), (t[1], theta)] {
        scratch.fill(0.0);
        system.load(t, scratch);
        for (sum, p) in load.iter_mut().zip(scratch.iter()) {
            *sum += weight * p;
        }
    }
}

/// Poses and solves the contact problem of the candidates at `work.q_at`; turns v_free into v¹.
fn impact<const D: usize>(
    model: &Model<D>,
    state: &State,
    work: &mut Workspace<D>,
) -> Result<Option<Outcome>, teeter_contact::ProblemError> {
    let parts = model.parts();
    let set = &mut work.contacts;
    set.clear();
    if work.candidates.is_empty() {
        return Ok(None);
    }
    work.candidates.sort_unstable_by_key(|candidate| candidate.id);
    for candidate in &work.candidates {
        set.activate(model, &work.q_at, candidate, &state.warm);
    }
    for i in 0..set.len() {
        let u_before = set.velocity(parts, i, &state.v);
        let mut q = set.velocity(parts, i, &work.v_free);
        q[0] += model.law(set.contacts[i].id.pair()).restitution * u_before[0].min(0.0);
        set.contacts[i].u_before = u_before;
        set.q.push(q);
    }
    set.assemble(parts, &mut work.factors, &mut work.scratch);
    let stop = Stop { tolerance: work.settings.tolerance, max_iterations: work.settings.max_iterations, cancel: None };
    let (problem, p) = set.problem()?;
    let outcome = work.solver.solve(&problem, &stop, p);

    // v¹ = v_free + W Jᵀ p
    work.dv.fill(0.0);
    set.scatter_impulses(parts, &mut work.dv);
    for (index, (part, factor)) in parts.iter().zip(&mut work.factors).enumerate() {
        if set.acts_on(index) {
            let dv = &mut work.dv[part.v.clone()];
            factor.solve(dv);
            add(&mut work.v_free[part.v.clone()], dv);
        }
    }
    set.complete(parts, &work.v_free);
    Ok(Some(outcome))
}

fn tally(state: &mut State, outcome: Option<&Outcome>, contacts: usize, penetration: f64) {
    let tally = &mut state.tally;
    tally.max_penetration = tally.max_penetration.max(penetration);
    tally.max_contacts = tally.max_contacts.max(contacts);
    if let Some(outcome) = outcome {
        tally.contact_steps += 1;
        tally.max_residual = tally.max_residual.max(outcome.residual.global);
        tally.max_contact_residual = tally.max_contact_residual.max(outcome.residual.worst);
        tally.max_iterations = tally.max_iterations.max(outcome.iterations);
        tally.unconverged_steps += u64::from(!outcome.converged());
    }
}

fn add(x: &mut [f64], y: &[f64]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x += y;
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

fn all_finite(x: &[f64]) -> bool {
    // Without an early exit, so that it takes several numbers at once.
    x.iter().fold(true, |finite, x| finite & x.is_finite())
}
