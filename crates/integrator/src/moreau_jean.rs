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
use crate::{
    Model, Scheme, SettingError, Size, State, StepEnergy, StepError, StepReport, Subsystem, Weights, Workspace,
};
use teeter_contact::{Outcome, ProblemError};

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
    buffers: Buffers,
}

/// Vectors of a step: they carry nothing from one to the next.
#[derive(Clone, Debug, Default)]
struct Buffers {
    /// Coordinates at which forces or gaps are taken; at last q¹.
    q_at: Vec<f64>,
    /// v_free; once the impulses are known, v¹.
    v_free: Vec<f64>,
    /// v_θ.
    v_mean: Vec<f64>,
    dq: Vec<f64>,
    dv: Vec<f64>,
    /// P_θ.
    load: Vec<f64>,
    product: Vec<f64>,
}

impl Buffers {
    /// Takes the sizes of a model; allocates nothing where they are the same.
    fn resize(&mut self, size: Size) {
        self.q_at.resize(size.q, 0.0);
        for v in [&mut self.v_free, &mut self.v_mean, &mut self.dq, &mut self.dv, &mut self.load, &mut self.product] {
            v.resize(size.v, 0.0);
        }
    }

    /// Leaves q ⊕ τ v in `q_at`.
    fn predict<const D: usize>(&mut self, model: &Model<D>, state: &State, tau: f64) {
        for (dq, v) in self.dq.iter_mut().zip(&state.v) {
            *dq = tau * v;
        }
        model.retract(&state.q, &self.dq, &mut self.q_at);
    }
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
        Ok(Self { settings, buffers: Buffers::default() })
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
        self.buffers.resize(model.size());
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
        self.buffers.resize(model.size());
        work.factorise(model, self.weights(h), &state.q)?;

        self.free_velocity(model, state, work, t_end);
        self.buffers.predict(model, state, activation_gamma * h);
        work.detect(model, &self.buffers.q_at, gap_tolerance);
        let outcome = self.impact(model, state, work).map_err(|source| StepError::Problem { t: state.t, source })?;

        let Buffers { q_at, v_free: v_end, v_mean, dq, .. } = &mut self.buffers;
        for (((mean, dq), v1), v0) in v_mean.iter_mut().zip(dq.iter_mut()).zip(v_end.iter()).zip(&state.v) {
            *mean = theta * v1 + (1.0 - theta) * v0;
            *dq = h * *mean;
        }
        model.retract(&state.q, dq, q_at);
        if !(all_finite(v_end) && all_finite(q_at)) {
            return Err(StepError::Diverged { t: state.t });
        }

        let mut energy = self.work_of_forces(model, state);
        for contact in work.contacts.contacts() {
            let u_theta = contact.u_after * theta + contact.u_before * (1.0 - theta);
            energy.contact += u_theta[0] * contact.p[0];
            energy.friction += tangential(&u_theta).dot(&contact.p);
            let slip = tangential(&contact.u_after).dot(&contact.p);
            state.ledger.largest_tangential_work = state.ledger.largest_tangential_work.max(slip);
        }

        state.q.copy_from_slice(&self.buffers.q_at);
        state.v.copy_from_slice(&self.buffers.v_free);
        let t_start = std::mem::replace(&mut state.t, t_end);
        state.step += 1;
        state.ledger.enter(model.energy(&state.q, &state.v), &mut energy);
        state.warm.clear();
        for contact in work.contacts.contacts() {
            state.warm.push(contact.id, &contact.p);
        }
        let penetration = work.penetration(model, &state.q);
        let contacts = work.contacts.contacts();
        state.tally.count(outcome.as_ref(), contacts.len(), penetration);
        Ok(StepReport { step: state.step, t_start, t_end, contacts, outcome, penetration, energy })
    }
}

impl MoreauJean {
    /// Leaves v_free and P_θ in the buffers.
    fn free_velocity<const D: usize>(&mut self, model: &Model<D>, state: &State, work: &mut Workspace<D>, t_end: f64) {
        let theta = self.settings.theta;
        let h = state.dt;
        let buffers = &mut self.buffers;
        buffers.predict(model, state, h * theta);
        for (part, factor) in model.parts().iter().zip(&mut work.factors) {
            let (q, v) = (part.q.clone(), part.v.clone());
            if v.is_empty() {
                continue;
            }
            let dv = &mut buffers.dv[v.clone()];
            dv.fill(0.0);
            part.system.internal_force(&buffers.q_at[q], &state.v[v.clone()], dv);
            if part.system.is_loaded() {
                let (load, scratch) = (&mut buffers.load[v.clone()], &mut work.scratch[..v.len()]);
                mean_load(part.system.as_ref(), theta, [state.t, t_end], load, scratch);
                add(dv, load);
            }
            dv.iter_mut().for_each(|f| *f *= h);
            factor.solve(dv);
            for ((free, v0), dv) in buffers.v_free[v.clone()].iter_mut().zip(&state.v[v]).zip(dv.iter()) {
                *free = v0 + dv;
            }
        }
    }

    /// Poses and solves the contact problem of the candidates at the predicted position; turns v_free into v¹.
    fn impact<const D: usize>(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, ProblemError> {
        let Buffers { q_at, v_free, .. } = &mut self.buffers;
        let Workspace { contacts, candidates, .. } = work;
        contacts.clear();
        if candidates.is_empty() {
            return Ok(None);
        }
        for (i, candidate) in candidates.iter().enumerate() {
            contacts.activate(model, q_at, candidate, &state.warm);
            let u_before = contacts.velocity(model, i, &state.v);
            let mut q = contacts.velocity(model, i, v_free);
            q[0] += model.law(candidate.id.pair()).restitution * u_before[0].min(0.0);
            contacts.pose(i, u_before, q);
        }
        work.solve_contacts(model, v_free).map(Some)
    }

    /// The terms of the energy identity that aren't contact: loads, damping, the scheme itself.
    fn work_of_forces<const D: usize>(&mut self, model: &Model<D>, state: &State) -> StepEnergy {
        let theta = self.settings.theta;
        let h = state.dt;
        let Buffers { v_free: v_end, v_mean, dq, dv, load, product, .. } = &mut self.buffers;
        let mut energy = StepEnergy::default();
        if theta != 0.5 {
            for ((dv, v1), v0) in dv.iter_mut().zip(v_end.iter()).zip(&state.v) {
                *dv = v1 - v0;
            }
        }
        for part in model.parts() {
            let (q, v) = (&state.q[part.q.clone()], part.v.clone());
            let product = &mut product[v.clone()];
            let mut form = |w: Weights, x: &[f64]| {
                product.fill(0.0);
                part.system.apply(w, q, x, product);
                dot(x, product)
            };
            if part.system.is_damped() {
                let c = Weights { damping: 1.0, ..Weights::default() };
                energy.viscous -= h * form(c, &v_mean[v.clone()]);
            }
            if theta != 0.5 {
                let m = Weights { mass: 1.0, ..Weights::default() };
                let k = Weights { stiffness: 1.0, ..Weights::default() };
                energy.numerical -= (theta - 0.5) * (form(m, &dv[v.clone()]) + form(k, &dq[v.clone()]));
            }
            if part.system.is_loaded() {
                energy.external += h * dot(&v_mean[v.clone()], &load[v]);
            }
        }
        energy
    }
}

/// θP¹ + (1−θ)P⁰ into `load`.
fn mean_load<const D: usize>(
    system: &dyn Subsystem<D>,
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
