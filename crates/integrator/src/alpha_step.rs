//! The motion of the generalized-α step beside its contacts (`docs/schemes.md`).

use crate::blend::{Term, key_of};
use crate::step_motion::StepMotion;
use crate::subsystem::{all_finite, dot};
use crate::theta_step::ThetaStep;
use crate::{
    Account, ContactError, ContactStage, Keep, Memory, Model, Part, Responses, State, StepEnergy, StepError, StepSpan,
    Weights, Workspace,
};

/// What it can't step.
const FOLLOWERS: &str =
    "matrices that follow their coordinates, as of a beam held along its axis: its forces have to be linear";

/// The coefficients of the recursion, from the spectral radius ρ at infinite frequency (Chung and
/// Hulbert 1993, doi 10.1115/1.2900803).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coefficients {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
}

impl Coefficients {
    pub(crate) fn of(rho: f64) -> Self {
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let gamma = 0.5 + alpha_f - alpha_m;
        Self { alpha_m, alpha_f, beta: 0.25 * (gamma + 0.5) * (gamma + 0.5), gamma }
    }

    /// 1 − γ/2β, the part of a jump that stiffness does not answer within the step: 0 for ρ = 1.
    fn unanswered(&self) -> f64 {
        // Rounding must not leave a negative mass of it.
        (1.0 - 0.5 * self.gamma / self.beta).max(0.0)
    }

    /// κ: the viscous force is that of ṽ¹ + κW. All of W where C = αM; elsewhere γ/2β of it, so that
    /// the response is that of two factors.
    fn damped_jump<const D: usize>(&self, part: &Part<D>) -> f64 {
        if part.free_mass_damping == 0.0 { 1.0 - self.unanswered() } else { 1.0 }
    }

    /// The weights of S = (1−α_m)M + (1−α_f)(hγC + h²βK).
    fn iteration_matrix(&self, h: f64) -> Weights {
        let kept = 1.0 - self.alpha_f;
        Weights { mass: 1.0 - self.alpha_m, damping: kept * h * self.gamma, stiffness: kept * h * h * self.beta }
    }

    /// What an impulse does to the velocities at the end, as c₀ M⁻¹ + c₁ S⁻¹: of
    /// M⁻¹ − hγ(1−α_f) S⁻¹(½hK + κC) M⁻¹.
    fn response<const D: usize>(&self, part: &Part<D>, h: f64) -> [Term; 2] {
        let left = self.unanswered();
        let viscous = h * self.gamma * (1.0 - self.alpha_f) * left * part.free_mass_damping;
        let by_matrix = (1.0 - left) * (1.0 - self.alpha_m) - viscous;
        [(left, Weights::MASS), (by_matrix, self.iteration_matrix(h))]
    }
}

/// The time over which prescribed velocities at the end of a step are means, s: as long as a whole
/// step, also at the end of a part of one.
fn about_end(from: &State, span: &StepSpan) -> [f64; 2] {
    [span.end - 0.5 * from.dt, span.end + 0.5 * from.dt]
}

/// Vectors of a step. What it carries to the next is in the state's memory: accelerations a, and the
/// coordinates and velocities q_a, v_a whose forces they are, M a = F(q_a, v_a).
#[derive(Debug)]
pub(crate) struct AlphaStep {
    spectral_radius: f64,
    coefficients: Coefficients,
    /// Which model it serves, and that everything is of it.
    identity: ThetaStep,
    /// At the start.
    a: Vec<f64>,
    q_a: Vec<f64>,
    v_a: Vec<f64>,
    /// The same at the end; `a_end` with the impulses of contacts once they are known.
    a_end: Vec<f64>,
    q_a_end: Vec<f64>,
    v_a_end: Vec<f64>,
    /// The acceleration at the end without contacts.
    a_free: Vec<f64>,
    /// W of loads and drives; the same with contacts.
    jump_free: Vec<f64>,
    jump: Vec<f64>,
    /// (q¹ − q⁰)/h.
    rate: Vec<f64>,
    q_end: Vec<f64>,
    v_end: Vec<f64>,
    /// P, its mean over the step.
    load: Vec<f64>,
    f: Vec<f64>,
    g: Vec<f64>,
    q_at: Vec<f64>,
    /// As it goes into the memory.
    numbers: Vec<f64>,
}

impl AlphaStep {
    pub(crate) fn new(spectral_radius: f64) -> Self {
        let none = Vec::new;
        Self {
            spectral_radius,
            coefficients: Coefficients::of(spectral_radius),
            identity: ThetaStep::default(),
            a: none(),
            q_a: none(),
            v_a: none(),
            a_end: none(),
            q_a_end: none(),
            v_a_end: none(),
            a_free: none(),
            jump_free: none(),
            jump: none(),
            rate: none(),
            q_end: none(),
            v_end: none(),
            load: none(),
            f: none(),
            g: none(),
            q_at: none(),
            numbers: none(),
        }
    }

    fn key(&self, h: f64) -> Weights {
        key_of(self.coefficients.iteration_matrix(h))
    }

    /// Takes the sizes of a model.
    fn resize<const D: usize>(&mut self, model: &Model<D>) {
        let size = model.size();
        for q in [&mut self.q_a, &mut self.q_a_end, &mut self.q_end, &mut self.q_at] {
            q.resize(size.q, 0.0);
        }
        let Self { a, v_a, a_end, v_a_end, a_free, jump_free, jump, rate, v_end, load, f, g, .. } = self;
        for v in [a, v_a, a_end, v_a_end, a_free, jump_free, jump, rate, v_end, load, f, g] {
            v.resize(size.v, 0.0);
        }
    }

    /// Takes what the step before has left, or begins with the accelerations of the state's forces.
    fn recall<const D: usize>(&mut self, model: &Model<D>, from: &State, key: Weights, work: &mut Workspace<D>) {
        let n = model.size().v;
        // Those of another scheme, or of this one with another radius, are none.
        if let [rho, numbers @ ..] = from.memory.all_numbers()
            && *rho == self.spectral_radius
            && numbers.len() == 2 * n + model.size().q
        {
            self.a.copy_from_slice(&numbers[..n]);
            self.v_a.copy_from_slice(&numbers[n..2 * n]);
            self.q_a.copy_from_slice(&numbers[2 * n..]);
            return;
        }
        self.q_a.copy_from_slice(&from.q);
        self.v_a.copy_from_slice(&from.v);
        self.a.fill(0.0);
        for (index, part) in model.parts().iter().enumerate() {
            let (q, v) = (part.q.clone(), part.v.clone());
            let Some([masses, _]) = work.factors.terms(index, key).filter(|_| !v.is_empty()) else { continue };
            let a = &mut self.a[v.clone()];
            part.system.internal_force(&from.q[q], &from.v[v], a);
            masses.solve(a);
        }
    }

    /// W of loads and drives of a part.
    fn take_jump<const D: usize>(
        &mut self,
        part: &Part<D>,
        from: &State,
        span: &StepSpan,
        masses: &mut dyn crate::Compliance<D>,
        scratch: &mut [f64],
    ) {
        let (q, v) = (&from.q[part.q.clone()], part.v.clone());
        let (jump, load, f) = (&mut self.jump_free[v.clone()], &mut self.load[v.clone()], &mut self.f[v.clone()]);
        jump.fill(0.0);
        load.fill(0.0);
        if !part.traits.loaded && !part.is_driven() {
            return;
        }
        f.fill(0.0);
        if part.traits.loaded {
            part.system.mean_load([span.start, span.end], scratch, load);
            f.iter_mut().zip(load.iter()).for_each(|(f, load)| *f += span.h * load);
        }
        if part.is_driven() {
            // Prescribed velocities jump to those about the end (`docs/signals.md`); by their
            // masses they pull the others along.
            let given = &mut self.v_end[v.clone()];
            given.copy_from_slice(&from.v[v.clone()]);
            part.system.drive_mean(about_end(from, span), given);
            for ((jump, v1), v0) in jump.iter_mut().zip(given.iter()).zip(&from.v[v.clone()]) {
                *jump = v1 - v0;
            }
            let pull = &mut self.g[v];
            pull.fill(0.0);
            part.system.apply(Weights::MASS, q, jump, pull);
            f.iter_mut().zip(pull.iter()).for_each(|(f, pull)| *f -= pull);
        }
        masses.solve(f);
        jump.iter_mut().zip(f.iter()).for_each(|(jump, f)| *jump += f);
    }
}

impl<const D: usize> StepMotion<D> for AlphaStep {
    fn start_motion(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError> {
        if model.parts().iter().any(|part| part.traits.follows_coordinates) {
            return Err(StepError::Unsupported { what: FOLLOWERS });
        }
        self.identity.start(model, state, work)?;
        self.resize(model);
        let numbers = 1 + 2 * model.size().v + model.size().q;
        self.numbers.reserve(numbers);
        state.memory.reserve_numbers(numbers);
        Ok(())
    }

    fn check_motion(&mut self, model: &Model<D>) -> Result<(), StepError> {
        self.identity.check(model)?;
        self.resize(model);
        Ok(())
    }

    fn make_factors(
        &mut self,
        model: &Model<D>,
        from: &State,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        let keep = if h == from.dt { Keep::Pinned } else { Keep::Once };
        let coefficients = self.coefficients;
        work.factors(model, coefficients.iteration_matrix(h), &from.q, keep)?;
        work.blended_factors(model, self.key(h), keep, &from.q, |part| coefficients.response(part, h))
    }

    fn move_without_impulses(&mut self, model: &Model<D>, from: &State, span: &StepSpan, work: &mut Workspace<D>) {
        let (h, key) = (span.h, self.key(span.h));
        let Coefficients { alpha_m, alpha_f, beta, gamma } = self.coefficients;
        self.recall(model, from, key, work);
        for (index, part) in model.parts().iter().enumerate() {
            let (q, v) = (part.q.clone(), part.v.clone());
            let Workspace { factors, scratch, .. } = work;
            let Some([masses, matrix]) = factors.terms(index, key).filter(|_| !v.is_empty()) else { continue };
            let scratch = &mut scratch[..v.len()];
            self.take_jump(part, from, span, masses, scratch);
            let (q0, v0) = (&from.q[q.clone()], &from.v[v.clone()]);
            let (a, jump) = (&self.a[v.clone()], &self.jump_free[v.clone()]);
            // (1−α_f) F(q* + ½hW, v* + κW) + α_f F⁰ − α_m M a⁰
            let (kappa, q_at) = (self.coefficients.damped_jump(part), &mut self.q_at[q.clone()]);
            let at = &mut self.g[v.clone()];
            for (k, at) in at.iter_mut().enumerate() {
                *at = v0[k] + h * (0.5 - beta) * a[k] + 0.5 * jump[k];
            }
            part.system.retract(q0, at, h, q_at);
            for (k, at) in at.iter_mut().enumerate() {
                *at = v0[k] + h * (1.0 - gamma) * a[k] + kappa * jump[k];
            }
            let f = &mut self.f[v.clone()];
            f.fill(0.0);
            part.system.internal_force(q_at, at, f);
            f.iter_mut().for_each(|f| *f *= 1.0 - alpha_f);
            scratch.fill(0.0);
            part.system.internal_force(q0, v0, scratch);
            f.iter_mut().zip(scratch.iter()).for_each(|(f, before)| *f += alpha_f * before);
            part.system.apply(Weights { mass: -alpha_m, ..Weights::default() }, q0, a, f);
            matrix.solve(f);
            self.a_free[v.clone()].copy_from_slice(f);
            let v_end = &mut self.v_end[v];
            for (k, v1) in v_end.iter_mut().enumerate() {
                *v1 = v0[k] + h * ((1.0 - gamma) * a[k] + gamma * f[k]) + jump[k];
            }
            if part.is_driven() {
                // As given, without the rounding of the jump.
                part.system.drive_mean(about_end(from, span), v_end);
            }
        }
        self.a_end.copy_from_slice(&self.a_free);
        self.jump.copy_from_slice(&self.jump_free);
    }

    fn restart(&mut self, v_free: &[f64]) {
        self.v_end.copy_from_slice(v_free);
        self.a_end.copy_from_slice(&self.a_free);
        self.jump.copy_from_slice(&self.jump_free);
    }

    fn responses(&self, h: f64) -> Responses<'static> {
        Responses::Of(self.key(h))
    }

    fn projection_responses(&self, h: f64) -> Responses<'static> {
        Responses::Of(self.coefficients.iteration_matrix(h))
    }

    /// v¹ += A Jᵀp, W += M⁻¹Jᵀp, and what the forces of the positions ½hW and velocities κW do to a¹.
    fn respond(
        &mut self,
        model: &Model<D>,
        stage: &ContactStage<D>,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), ContactError> {
        let key = self.key(h);
        let Coefficients { alpha_f, .. } = self.coefficients;
        for (index, part) in model.parts().iter().enumerate().filter(|(_, part)| !part.v.is_empty()) {
            if !stage.acts_on(index) {
                continue;
            }
            let Workspace { factors, scratch, .. } = work;
            let Some([masses, matrix]) = factors.terms(index, key) else {
                return Err(ContactError::Factors { part: index });
            };
            let [(left, _), (by_matrix, _)] = self.coefficients.response(part, h);
            let (jump, pulled) = (&mut self.f[part.v.clone()], &mut self.g[part.v.clone()]);
            let answer = &mut scratch[..jump.len()];
            jump.fill(0.0);
            stage.add_generalised_impulse(index, jump);
            answer.copy_from_slice(jump);
            masses.solve(jump);
            matrix.solve(answer);
            // −(1−α_f)(½hK + κC)W, which is exactly 0 for what has neither.
            let kept = 1.0 - alpha_f;
            let damping = -kept * self.coefficients.damped_jump(part);
            let pull = Weights { mass: 0.0, damping, stiffness: -0.5 * h * kept };
            pulled.fill(0.0);
            part.system.apply(pull, &self.q_a[part.q.clone()], jump, pulled);
            matrix.solve(pulled);
            for (k, at) in part.v.clone().enumerate() {
                self.jump[at] += jump[k];
                self.a_end[at] += pulled[k];
                // W + hγ Δa¹ as the sum of two small terms: where the step is long, W is far larger
                // than what stiffness leaves of it.
                self.v_end[at] += left * jump[k] + by_matrix * answer[k];
            }
        }
        Ok(())
    }

    fn end(&mut self, model: &Model<D>, from: &State, h: f64) -> Result<(), StepError> {
        let Coefficients { beta, .. } = self.coefficients;
        for (k, rate) in self.rate.iter_mut().enumerate() {
            *rate = from.v[k] + h * ((0.5 - beta) * self.a[k] + beta * self.a_end[k]) + 0.5 * self.jump[k];
        }
        model.move_along(&from.q, &self.rate, h, &mut self.q_end);
        // A velocity that is not finite leaves a coordinate that isn't.
        if all_finite(&self.q_end) { Ok(()) } else { Err(StepError::Diverged { t: from.t }) }
    }

    fn q_end(&self) -> &[f64] {
        &self.q_end
    }

    fn v_end(&self) -> &[f64] {
        &self.v_end
    }

    fn v_end_mut(&mut self) -> &mut [f64] {
        &mut self.v_end
    }

    fn settle(&mut self, model: &Model<D>, from: &State) {
        let Coefficients { alpha_m, alpha_f, .. } = self.coefficients;
        let filtered = |end: f64, start: f64, before: f64| {
            ((1.0 - alpha_f) * end + alpha_f * start - alpha_m * before) / (1.0 - alpha_m)
        };
        for k in 0..self.q_a.len() {
            self.q_a_end[k] = filtered(self.q_end[k], from.q[k], self.q_a[k]);
        }
        for part in model.parts() {
            let left = 1.0 - self.coefficients.damped_jump(part);
            for k in part.v.clone() {
                self.v_a_end[k] = filtered(self.v_end[k] - left * self.jump[k], from.v[k], self.v_a[k]);
            }
        }
        self.numbers.clear();
        self.numbers.push(self.spectral_radius);
        for numbers in [&self.a_end, &self.v_a_end, &self.q_a_end] {
            self.numbers.extend_from_slice(numbers);
        }
    }

    fn remember(&self, memory: &mut Memory) {
        memory.set_numbers(&self.numbers);
    }

    fn work(
        &mut self,
        model: &Model<D>,
        from: &State,
        span: &StepSpan,
        stage: &ContactStage<D>,
        work: &mut Workspace<D>,
    ) -> StepEnergy {
        let mut energy = StepEnergy::default();
        if work.account == Account::LeftOut {
            return energy;
        }
        let h = span.h;
        // q̄ and v̄, by which forces were taken; the mean of the velocities, by which they do work.
        let (mut q_mean, mut v_bar) = (std::mem::take(&mut self.q_at), std::mem::take(&mut self.rate));
        StepMotion::<D>::take_means(self, from, &mut q_mean, &mut v_bar);
        let Self { load, f, g, q_end, v_end, .. } = self;
        for (index, part) in model.parts().iter().enumerate().filter(|(_, part)| !part.v.is_empty()) {
            let (q, v) = (part.q.clone(), part.v.clone());
            let (force, mean, load) = (&mut f[v.clone()], &mut g[v.clone()], &load[v.clone()]);
            for ((mean, v0), v1) in mean.iter_mut().zip(&from.v[v.clone()]).zip(&v_end[v.clone()]) {
                *mean = 0.5 * (v0 + v1);
            }
            force.fill(0.0);
            part.system.internal_force(&q_mean[q.clone()], &v_bar[v.clone()], force);
            let scratch = &mut work.scratch[..v.len()];
            let before = part.system.energy(&from.q[q.clone()], &from.v[v.clone()]);
            let after = part.system.energy(&q_end[q.clone()], &v_end[v.clone()]);
            energy.numerical += h * dot(mean, force) + (after.elastic - before.elastic);
            energy.numerical += after.gravity - before.gravity;
            if part.traits.damped {
                let lost = h * part.system.damping_power(&q_mean[q.clone()], mean, scratch);
                energy.viscous -= lost;
                energy.numerical += lost;
            }
            if part.traits.loaded {
                energy.external += h * dot(mean, load);
            }
            if part.is_driven() {
                // What the drives give: momentum gained less the impulses of all other forces.
                for ((change, v1), v0) in scratch.iter_mut().zip(&v_end[v.clone()]).zip(&from.v[v.clone()]) {
                    *change = v1 - v0;
                }
                for (force, load) in force.iter_mut().zip(load) {
                    *force = -h * (*force + load);
                }
                part.system.apply(Weights::MASS, &from.q[q], scratch, force);
                scratch.fill(0.0);
                stage.add_generalised_impulse(index, scratch);
                for &k in &part.traits.driven {
                    energy.external += mean[k] * (force[k] - scratch[k]);
                }
            }
        }
        (self.q_at, self.rate) = (q_mean, v_bar);
        energy
    }

    fn has_own_means(&self) -> bool {
        true
    }

    fn take_means(&self, _from: &State, q: &mut [f64], v: &mut [f64]) {
        let gamma = self.coefficients.gamma;
        for (mean, x0, x1) in [(q, &self.q_a, &self.q_a_end), (v, &self.v_a, &self.v_a_end)] {
            for (mean, (x0, x1)) in mean.iter_mut().zip(x0.iter().zip(x1)) {
                *mean = (1.0 - gamma) * x0 + gamma * x1;
            }
        }
    }
}
