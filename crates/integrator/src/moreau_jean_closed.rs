//! The Moreau–Jean step with contacts that stay closed: `moreau-jean-closed` (`docs/schemes.md`).
//!
//! The matrices, the free velocity and the contact solver are those of [`MoreauJean`](crate::MoreauJean) at θ = ½. What is
//! different is which contacts take part, and the shift s of the law:
//!
//! ```text
//! q̃_m = q⁰ + ¼h(v⁰ + v_free),   q̃ = q⁰ + ½h(v⁰ + v_free)
//! J = J(q̃_m),   U⁰ = J v⁰,   b = (J(q̃) − J) v⁰
//! s_n = U_n⁰ if |U_n⁰ − b_n| ≤ |b_n|, else max(b_n, U_n⁰)
//! s_t = U_t⁰ if ‖U_t⁰ − b_t‖ ≤ ‖b_t‖, else b_t
//! 0 ≤ U_n¹ + s_n ⊥ p_n ≥ 0,   Coulomb on U_t¹ + s_t
//! ```
//!
//! A contact that pressed in a step is *closed* in the next, whatever its gap. An open contact becomes closed where the step
//! would end in the surface, and deeper than it began: the step is then tried again. If it approaches, s_n = e U_n⁰ for an impact, and 0 for
//! an approach that its free acceleration makes within the step. J at mid-step and b make the closed contact end the step
//! with the velocity that the surface has there, so its gap doesn't drift apart as that of the page's scheme does.
//!
//! **Work**: U_n¹ = −s_n where p_n > 0, so Ū_n p_n = ½(U_n⁰ − s_n) p_n ≤ 0, as s_n ≥ U_n⁰. Friction obeys (U_t¹ + s_t)·p_t ≤ 0; where
//! that leaves a contact with Ū·p > 0 all the same, as where a slide turns within the step, its shift becomes s_n = max(s_n, U_n⁰), and
//! s_t = U_t⁰ or no friction at all, whichever ends nearer to rest; with both Ū·p ≤ 0. The problem is solved once more. So no contact
//! gives energy in any step. (But for closed contacts with what moves as prescribed: there Ū is relative, and they are left as they are.)

use crate::contact::tangential;
use crate::contacts::Rule;
use crate::laws::is_impact;
use crate::spring::SpringStep;
use crate::theta_step::{ThetaStep, weights};
use crate::{
    ContactError, ContactSet, ImpactLaw, Mismatch, Model, PairLaw, Scheme, SettingError, State, StepError, StepReport,
    Vector, Workspace,
};
use teeter_contact::Outcome;
use teeter_detect::{Candidate, Candidates, ContactId};

/// θ: the scheme's account of work holds for the trapezoidal rule.
const THETA: f64 = 0.5;

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

/// The scheme; see the module's page.
#[derive(Debug)]
pub struct MoreauJeanClosed<const D: usize> {
    settings: MoreauJeanClosedSettings,
    step: ThetaStep,
    v_free: Vec<f64>,
    /// q̃.
    q_ahead: Vec<f64>,
    /// q̃_m.
    q_mid: Vec<f64>,
    middle: Candidates<D>,
    ahead: Candidates<D>,
    start: Candidates<D>,
    /// Rows at q̃.
    rows_ahead: ContactSet<D>,
    /// The contacts that take part, in order of identity.
    closed: Vec<ContactId>,
    /// Of each contact of the step: its shift were there no restitution.
    resting_shift: Vec<f64>,
    /// Which contacts have the shift that can't give energy.
    guarded: Vec<bool>,
}

impl<const D: usize> MoreauJeanClosed<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "moreau-jean-closed";

    /// A scheme with these settings.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(settings: MoreauJeanClosedSettings) -> Result<Self, SettingError> {
        let gap = settings.gap_tolerance;
        if !(gap >= 0.0 && gap.is_finite()) {
            return Err(SettingError { what: "gap_tolerance", value: gap, rule: "at least 0 m" });
        }
        Ok(Self {
            settings,
            step: ThetaStep::default(),
            v_free: Vec::new(),
            q_ahead: Vec::new(),
            q_mid: Vec::new(),
            middle: Vec::new(),
            ahead: Vec::new(),
            start: Vec::new(),
            rows_ahead: ContactSet::with_capacity(0, 0),
            closed: Vec::new(),
            resting_shift: Vec::new(),
            guarded: Vec::new(),
        })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &MoreauJeanClosedSettings {
        &self.settings
    }
}

/// Rounding of a contact's work, as a part of ‖p‖ Σ|J_i v|, the larger of v⁰ and v_free.
const WORKLESS: f64 = 1e-13;

/// Where a contact is in the surface already, it closes when it sinks by this part of the gap tolerance within a step: more than
/// rounding, and so little that no approach is too slow to be seen.
const SINKING: f64 = 1e-3;

/// A contact that leaves faster than this part of Σ|J_i v| is open after the step, v the larger of v¹ and v_free: what was stopped has no
/// velocity left to tell its rounding by.
const LEAVING: f64 = 1e-10;

impl<const D: usize> Scheme<D> for MoreauJeanClosed<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn start(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError> {
        let (contacts, row) = (model.detector().capacity(), model.size().row);
        self.step.start(model, state, work)?;
        self.resize(model);
        for candidates in [&mut self.middle, &mut self.ahead, &mut self.start, &mut work.candidates] {
            candidates.reserve(contacts);
        }
        self.rows_ahead = ContactSet::with_capacity(1, row);
        self.closed.reserve(contacts);
        self.resting_shift.reserve(contacts);
        self.guarded.reserve(contacts);
        state.warm.reserve(contacts, D);
        work.factorise(model, weights(state.dt, THETA), &state.q)?;
        Ok(())
    }

    fn advance<'w>(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        work: &'w mut Workspace<D>,
    ) -> Result<StepReport<'w, D>, StepError> {
        let h = state.dt;
        self.step.check(model, state, work)?;
        self.resize(model);
        let t_end = state.end_of_step();
        work.factorise_all(model, weights(h, THETA), &state.q)?;
        self.step.free_velocity(model, state, work, THETA, t_end);
        self.v_free.clear();
        self.v_free.extend_from_slice(&self.step.v_end);
        self.closed.clear();
        self.closed.extend_from_slice(state.warm.ids());
        let mut looked_for = 0;
        let (outcome, penetration) = loop {
            // In flight there is nothing to look at.
            if looked_for < self.closed.len() {
                self.look_ahead(model, state, work);
                looked_for = self.closed.len();
            }
            let outcome =
                self.attempt(model, state, work).map_err(|source| StepError::Problem { t: state.t, source })?;
            self.step.close(model, state, THETA)?;
            work.detect_at(model, &self.step.q_at, 0.0)?;
            let penetration = work.candidates.iter().map(|candidate| -candidate.gap).fold(0.0, f64::max);
            if !self.close_what_sinks(model, state, work)? {
                break (outcome, penetration);
            }
            work.counts.refused_attempts += 1;
        };
        let now = self.step.energy_at_end(model, state.t)?;
        let energy = self.step.work_of_forces(model, state, work, THETA);
        state.warm.clear();
        for (i, contact) in work.contacts.contacts().iter().enumerate() {
            let stays = match contact.gap_after {
                Some(gap) => gap < 0.0,
                None => {
                    let leaves = match work.contacts.rules[i] {
                        // What comes back is found in expansion.
                        Rule::Poisson { .. } => contact.u_after[0] + self.resting_shift[i],
                        // U_n¹ = −s_n where it presses: by s_n itself, as at rest a velocity is all rounding and solver's error.
                        _ => self.resting_shift[i] - work.contacts.shift[i][0],
                    };
                    let speed = |v: &[f64]| work.contacts.speed(i, v);
                    let still = || LEAVING * speed(&self.step.v_end).max(speed(&self.v_free));
                    contact.p[0] > 0.0 && (leaves <= 0.0 || leaves <= still())
                }
            };
            if stays {
                state.warm.keep(contact);
            }
        }
        Ok(self.step.finish(model, state, work, THETA, t_end, outcome, penetration, now, energy))
    }
}

impl<const D: usize> MoreauJeanClosed<D> {
    /// Takes the sizes of a model; allocates nothing where they are the same.
    fn resize(&mut self, model: &Model<D>) {
        self.v_free.resize(model.size().v, 0.0);
        self.q_mid.resize(model.size().q, 0.0);
        self.q_ahead.resize(model.size().q, 0.0);
    }

    /// Finds frames and gaps of the closed contacts at q̃_m and q̃.
    fn look_ahead(&mut self, model: &Model<D>, state: &State, work: &mut Workspace<D>) {
        // ½(v⁰ + v_free), the mean velocity of the free motion.
        let mean = &mut self.step.v_end;
        mean.iter_mut().zip(&self.v_free).zip(&state.v).for_each(|((v, free), v0)| *v = 0.5 * (free + v0));
        let places =
            [(0.5 * state.dt, &mut self.q_mid, &mut self.middle), (state.dt, &mut self.q_ahead, &mut self.ahead)];
        for (tau, q, candidates) in places {
            model.move_along(&state.q, mean, tau, q);
            work.locate_at(model, q, &self.closed, candidates);
        }
    }

    /// Takes the step with the closed contacts: leaves v¹ in the step.
    fn attempt(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, ContactError> {
        self.step.v_end.copy_from_slice(&self.v_free);
        work.contacts.clear();
        self.resting_shift.clear();
        if self.closed.is_empty() {
            return Ok(None);
        }
        for k in 0..self.middle.len() {
            let candidate = self.middle[k];
            self.pose(model, state, work, &candidate)?;
        }
        let n = work.contacts.contacts().len();
        if n == 0 {
            return Ok(None);
        }
        work.assemble_contacts(model);
        let mut outcome = work.solve_assembled(THETA)?;
        self.guarded.clear();
        self.guarded.resize(n, false);
        // Each round guards one contact more at least, so it ends.
        while self.guard(model, state, work)? {
            outcome = crate::laws::join(outcome, work.solve_assembled(THETA)?);
        }
        work.apply_impulses(model, &mut self.step.v_end);
        Ok(Some(outcome))
    }

    fn pose(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &mut Workspace<D>,
        candidate: &Candidate<D>,
    ) -> Result<(), Mismatch> {
        let law = model.law(candidate.id.pair())?;
        let contacts = &mut work.contacts;
        let i = contacts.contacts().len();
        contacts.enter(model, &self.q_mid, candidate, &state.warm, law.friction)?;
        if contacts.leave_if_prescribed(model) {
            return Ok(());
        }
        let u_before = contacts.velocity_of(i, &state.v);
        let u_free = contacts.velocity_of(i, &self.v_free);
        // Off the end of its surface by then, it has no frame there.
        let b = match find(&self.ahead, candidate.id) {
            Some(ahead) => {
                self.rows_ahead.clear();
                self.rows_ahead.enter(model, &self.q_ahead, ahead, &state.warm, law.friction)?;
                self.rows_ahead.velocity_of(0, &state.v) - u_before
            }
            None => Vector::zeros(),
        };
        let (before_t, b_t) = (tangential(&u_before), tangential(&b));
        let mut shift = if (before_t - b_t).norm() <= b_t.norm() { before_t } else { b_t };
        shift[0] = if (u_before[0] - b[0]).abs() <= b[0].abs() { u_before[0] } else { b[0].max(u_before[0]) };
        if !contacts.contacts()[i].persisting && u_before[0] < 0.0 {
            shift[0] = 0.0;
        }
        self.resting_shift.push(shift[0]);
        if let Some(spring) = law.impact.spring() {
            let gap = match state.warm.gap(candidate.id) {
                Some(gap) if gap < 0.0 => gap,
                _ => self.gap_at_start(model, state, work, candidate.id).max(0.0),
            };
            shift[0] = 0.0;
            work.contacts.set(i, u_before, u_free, shift);
            let step = SpringStep { spring, gap, u_before: u_before[0], h: state.dt, theta: THETA };
            work.contacts.follow(i, Rule::Spring(step));
        } else {
            restitute(contacts, i, &law, &u_before, &u_free, &mut shift);
            contacts.set(i, u_before, u_free, shift);
        }
        Ok(())
    }

    /// The gap of a contact at q⁰, m; 0 where it has none. Only a step with a new contact pays for looking there.
    fn gap_at_start(&mut self, model: &Model<D>, state: &State, work: &mut Workspace<D>, id: ContactId) -> f64 {
        work.locate_at(model, &state.q, &[id], &mut self.start);
        self.start.first().map_or(0.0, |candidate| candidate.gap)
    }

    /// Changes what holds for contacts whose work is positive, so that it can't be; whether there are any.
    ///
    /// The usual case is a slide that turns within the step: sticking at its end would take an impulse along the slide that
    /// was. Then either no friction, or the velocity turned about, whichever ends nearer to rest; it sticks in the next step.
    ///
    /// Where Poisson's law hands a blow on, what one contact gains another one has lost: there it is the sum over contacts that feel
    /// each other that counts. The law scales what it gives back by it, so what is left is of contacts that would give energy without
    /// any restitution, too.
    fn guard(&mut self, model: &Model<D>, state: &State, work: &mut Workspace<D>) -> Result<bool, Mismatch> {
        let n = self.guarded.len();
        let mut found = false;
        for i in 0..n {
            let (contacts, laws) = (&work.contacts, &work.laws);
            let (u_before, p) = (contacts.contacts()[i].u_before, contacts.p[i]);
            // A spring's law sees to it itself.
            if self.guarded[i] || p[0] <= 0.0 || matches!(contacts.rules[i], Rule::Spring(_)) {
                continue;
            }
            // What moves as prescribed gives energy anyway, and a slide that ends there is better stopped where it ends.
            if contacts.contacts()[i].persisting && contacts.feels_drive(model, i, &state.v, &self.v_free) {
                continue;
            }
            // At rest it is the free velocity whose digits are lost.
            let rounding = |i: usize| {
                let speed = contacts.speed(i, &state.v).max(contacts.speed(i, &self.v_free));
                WORKLESS * contacts.p[i].norm() * speed
            };
            let gain = if laws.handed_on(contacts, i) {
                let allowed: f64 = (0..n).map(rounding).sum();
                if laws.work_around(contacts, i) > allowed { laws.work_unreturned(i) } else { 0.0 }
            } else {
                contacts.work(i)
            };
            if gain <= rounding(i) {
                continue;
            }
            let contacts = &mut work.contacts;
            let without = contacts.without_own_friction(i);
            let mut shift = tangential(&u_before);
            if without.norm() < shift.norm() {
                contacts.mu[i] = 0.0;
            }
            let e = model.law(contacts.contacts()[i].id.pair())?.restitution;
            let back = match contacts.rules[i] {
                Rule::Poisson { .. } if is_impact(e, &u_before, &contacts.u_free[i]) => e * u_before[0],
                _ => contacts.shift[i][0],
            };
            shift[0] = back.max(u_before[0]);
            contacts.follow(i, Rule::Shifted);
            contacts.reshift(i, shift);
            self.guarded[i] = true;
            found = true;
        }
        Ok(found || self.stop_handing_on(state, work))
    }

    /// The last resort where contacts that hand a blow on give energy though none does by itself, as the solver finds another one of
    /// several solutions each time: nothing is given back there. Whether it changed anything.
    fn stop_handing_on(&self, state: &State, work: &mut Workspace<D>) -> bool {
        let (contacts, laws) = (&work.contacts, &work.laws);
        let n = contacts.contacts().len();
        let allowed = |i: usize| {
            let speed = contacts.speed(i, &state.v).max(contacts.speed(i, &self.v_free));
            WORKLESS * contacts.p[i].norm() * speed + laws.work_unreturned(i).max(0.0)
        };
        let gives = |i: usize| {
            let phased = matches!(contacts.rules[i], Rule::Poisson { .. }) && laws.handed_on(contacts, i);
            phased && laws.work_around(contacts, i) > (0..n).map(allowed).sum::<f64>()
        };
        let Some(first) = (0..n).find(|&i| gives(i)) else { return false };
        work.contacts.follow(first, Rule::Shifted);
        true
    }

    /// Closes the open contacts that the attempt ends with in their surface (they are the workspace's candidates), deeper
    /// than they began; whether there are any.
    fn close_what_sinks(&mut self, model: &Model<D>, state: &State, work: &mut Workspace<D>) -> Result<bool, Mismatch> {
        let before = self.closed.len();
        for k in 0..work.candidates.len() {
            let Candidate { id, gap, .. } = work.candidates[k];
            if gap >= -self.settings.gap_tolerance || self.closed[..before].binary_search(&id).is_ok() {
                continue;
            }
            let level = self.gap_at_start(model, state, work, id).min(0.0);
            if gap < level - SINKING * self.settings.gap_tolerance {
                self.closed.push(id);
            }
        }
        let found = self.closed.len() > before;
        self.closed.sort_unstable();
        Ok(found)
    }
}

/// Puts restitution into the shift of a contact that closes with an impact.
fn restitute<const D: usize>(
    contacts: &mut ContactSet<D>,
    i: usize,
    law: &PairLaw,
    u_before: &Vector<D>,
    u_free: &Vector<D>,
    shift: &mut Vector<D>,
) {
    let e = law.restitution;
    let closing = !contacts.contacts()[i].persisting && u_before[0] < 0.0;
    let tangential_restitution =
        if closing && is_impact(1.0, u_before, u_free) { law.tangential_restitution } else { 0.0 };
    if law.impact == ImpactLaw::Poisson {
        contacts.follow(i, Rule::Poisson { e, tangential: tangential_restitution });
        return;
    }
    if closing && is_impact(e, u_before, u_free) {
        // Newton's law too: where it would make energy, less of it, before the guard has to bend friction.
        contacts.follow(i, Rule::Energetic);
        shift[0] = e * u_before[0];
    }
    if tangential_restitution > 0.0 {
        let normal = shift[0];
        *shift = tangential(u_before) * tangential_restitution;
        shift[0] = normal;
    }
}

fn find<const D: usize>(candidates: &[Candidate<D>], id: ContactId) -> Option<&Candidate<D>> {
    candidates.binary_search_by_key(&id, |candidate| candidate.id).ok().map(|at| &candidates[at])
}
