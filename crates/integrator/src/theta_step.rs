//! The θ step that the schemes share: free velocities, the end of the step, the account of its
//! forces.

use crate::mismatch::Identity;
use crate::owed::Owed;
use crate::stretching::{Taken, Tensions};
use crate::subsystem::{all_finite, dot};
use crate::{
    Account, Compliance, ContactStage, Mismatch, Model, Part, Propagator, Size, State, StepEnergy, StepError, StepSpan,
    Stretching, Weights, Workspace,
};
use teeter_contact::Outcome;

/// Vectors of a step: they carry nothing from one to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct ThetaStep {
    /// q⁰ + hθv⁰: where forces and matrices are taken.
    q_forces: Vec<f64>,
    /// Coordinates at which gaps are taken; at last q¹.
    pub(crate) q_at: Vec<f64>,
    /// Coordinates at the end of the step without impulses, where a scheme asks for them.
    pub(crate) q_free: Vec<f64>,
    /// v_free; once the impulses are known, v¹.
    pub(crate) v_end: Vec<f64>,
    /// v_θ.
    v_mean: Vec<f64>,
    dv: Vec<f64>,
    /// P, its mean over the step.
    load: Vec<f64>,
    product: Vec<f64>,
    /// h times the forces at the start of the step, of parts with prescribed velocities.
    impulse: Vec<f64>,
    /// The tension of the parts that stretch.
    tensions: Tensions,
    /// The cutoff with which subsystems that have a motion in closed form take it; `None`: none does.
    pub(crate) cutoff: Option<f64>,
    /// For a scheme that divides its steps.
    pub(crate) owed: Owed,
    /// The model that the scheme was started with.
    model: Option<Identity>,
}

/// The combination whose inverse is W.
pub(crate) fn weights(h: f64, theta: f64) -> Weights {
    let ht = h * theta;
    Weights { mass: 1.0, damping: ht, stiffness: ht * ht }
}

impl ThetaStep {
    /// A step in which subsystems that have a motion in closed form take it, with this cutoff.
    pub(crate) fn in_closed_form(cutoff: f64) -> Self {
        Self { cutoff: Some(cutoff), ..Self::default() }
    }

    /// Starts to serve a model.
    pub(crate) fn start<const D: usize>(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &Workspace<D>,
    ) -> Result<(), StepError> {
        self.model = None;
        state.check(model)?;
        work.check(model)?;
        self.check(model)?;
        self.tensions.reserve(model);
        Ok(())
    }

    /// Refuses another model than that which the scheme was started with; a scheme that never was
    /// starts with this one. [`Workspace::begin`] looks at state and workspace.
    #[inline]
    pub(crate) fn check<const D: usize>(&mut self, model: &Model<D>) -> Result<(), Mismatch> {
        if self.model.is_some_and(|own| own != model.identity()) {
            let remedy = "start it with this one before its first step";
            return Err(Mismatch::OtherModel { what: "the scheme was started with that", remedy });
        }
        self.model = Some(model.identity());
        let size = model.size();
        if (self.q_at.len(), self.v_end.len()) != (size.q, size.v) {
            self.resize(size);
        }
        Ok(())
    }

    /// Takes the sizes of a model.
    fn resize(&mut self, size: Size) {
        let Self { q_forces, q_at, q_free, v_end, v_mean, dv, load, product, impulse, .. } = self;
        for q in [q_forces, q_at, q_free] {
            q.resize(size.q, 0.0);
        }
        for v in [v_end, v_mean, dv, load, product, impulse] {
            v.resize(size.v, 0.0);
        }
    }

    /// Leaves q ⊕ τ v in `q_at`.
    pub(crate) fn predict<const D: usize>(&mut self, model: &Model<D>, q: &[f64], v: &[f64], tau: f64) {
        model.move_along(q, v, tau, &mut self.q_at);
    }

    /// Leaves the end of the step without impulses in `q_free`.
    pub(crate) fn move_freely<const D: usize>(
        &mut self,
        model: &Model<D>,
        state: &State,
        h: f64,
        theta: f64,
    ) -> Result<(), StepError> {
        self.close(model, state, h, theta)?;
        self.q_free.clear();
        self.q_free.extend_from_slice(&self.q_at);
        Ok(())
    }

    /// Leaves v_free and P. Prescribed velocities are those about the end of the step; what their
    /// change does to the others goes to the right-hand side.
    pub(crate) fn free_velocity<const D: usize>(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &mut Workspace<D>,
        theta: f64,
        span: &StepSpan,
    ) {
        let (h, w) = (span.h, weights(span.h, theta));
        let Workspace { factors, scratch, counts, .. } = work;
        self.tensions.clear();
        for (index, part) in model.parts().iter().enumerate().filter(|(_, part)| !part.v.is_empty()) {
            let scratch = &mut scratch[..part.v.len()];
            if self.cutoff.is_some() && self.begin_in_closed_form(part, state, factors.propagator(index), scratch, span)
            {
                continue;
            }
            // The factors have been made.
            let Some(factor) = factors.of(index, w) else { continue };
            let (v_start, dv) = (&state.v[part.v.clone()], &mut self.dv[part.v.clone()]);
            let kept = beside_mass_damping(part.mass_damping, h, theta);
            let ahead = h * theta * (1.0 - kept * theta);
            let q = &mut self.q_forces[part.q.clone()];
            part.system.retract(&state.q[part.q.clone()], v_start, ahead, q);
            dv.fill(0.0);
            if let Some(stretching) = part.stretching() {
                stretching.force_beside(q, v_start, dv);
            } else {
                if part.traits.follows_coordinates {
                    factor.update(q);
                }
                match if part.mass_damping != 0.0 { part.system.linearised() } else { None } {
                    Some(linearised) => linearised.conservative_force(q, dv),
                    None => part.system.internal_force(q, v_start, dv),
                }
            }
            if part.traits.loaded {
                add_mean_load(part, &mut self.load[part.v.clone()], dv, scratch, span);
            }
            dv.iter_mut().for_each(|f| *f *= h);
            if part.is_driven() || part.stretching().is_some() {
                self.end_beside_drives(index, part, state, factor, scratch, theta, span);
            } else {
                factor.solve(dv);
                mix(1.0 - kept, v_start, 1.0, dv, &mut self.v_end[part.v.clone()]);
            }
        }
        if !self.tensions.is_empty() {
            self.tensions.keep(&self.v_end);
            counts.factorisations += self.tensions.len();
        }
    }

    // What few parts have is apart, so that the others don't carry its variables along.

    /// Leaves the end without impulses of a part that has its motion in closed form; whether it
    /// has.
    #[inline(never)]
    fn begin_in_closed_form<const D: usize>(
        &mut self,
        part: &Part<D>,
        state: &State,
        motion: Option<&mut (dyn Propagator<D> + 'static)>,
        scratch: &mut [f64],
        span: &StepSpan,
    ) -> bool {
        let (Some(cutoff), Some(motion)) = (self.cutoff, motion) else { return false };
        let (q, v) = (part.q.clone(), part.v.clone());
        let load = &mut self.load[v.clone()];
        load.fill(0.0);
        if part.traits.loaded {
            part.system.mean_load([span.start, span.end], scratch, load);
        }
        motion.take(span.h, cutoff);
        motion.begin(&state.q[q], &state.v[v.clone()], load, &mut self.v_end[v]);
        true
    }

    /// Leaves v_free of a part with prescribed velocities, or one that stretches; h times its other
    /// forces are in `dv`.
    #[inline(never)]
    fn end_beside_drives<const D: usize>(
        &mut self,
        index: usize,
        part: &Part<D>,
        state: &State,
        factor: &mut dyn Compliance<D>,
        scratch: &mut [f64],
        theta: f64,
        span: &StepSpan,
    ) {
        let (h, v) = (span.h, part.v.clone());
        let (q, dv, v_start) = (&self.q_forces[part.q.clone()], &mut self.dv[v.clone()], &state.v[v.clone()]);
        let v_end = &mut self.v_end[v.clone()];
        v_end.copy_from_slice(v_start);
        if part.is_driven() {
            self.impulse[v.clone()].copy_from_slice(dv);
            // The part θ of the mean lies before the end, so that q = θ d(t + (1 − θ)h) + (1 − θ)
            // d(t − θh). Over a part of a step it is the mean over as long a time: that over a
            // short one would jump from it, and push with what the jump takes.
            let dt = state.dt;
            part.system.drive_mean([span.end - theta * dt, span.end + (1.0 - theta) * dt], v_end);
            self.owed.catch_up(part, dt, h, v_end);
            let (jump, pull) = (scratch, &mut self.product[v]);
            for ((jump, v1), v0) in jump.iter_mut().zip(v_end.iter()).zip(v_start) {
                *jump = v1 - v0;
            }
            pull.fill(0.0);
            part.system.apply(weights(h, theta), q, jump, pull);
            dv.iter_mut().zip(pull.iter()).for_each(|(dv, pull)| *dv -= pull);
        }
        match part.stretching() {
            Some(stretching) => {
                let step = taken(stretching, part, state, h, theta);
                self.tensions.enter(index, &step, [q, dv], factor, v_end);
            }
            None => {
                factor.solve(dv);
                add(v_end, dv);
            }
        }
    }

    /// Whether the end that was tried asks for another tension in parts that stretch: the velocities
    /// without impulses are then those of the next round, to be given impulses anew. At most some
    /// tens of rounds.
    #[inline]
    pub(crate) fn takes_another_round<const D: usize>(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &mut Workspace<D>,
        theta: f64,
        h: f64,
    ) -> bool {
        !self.tensions.is_empty() && self.look_at_tensions(model, state, work, theta, h)
    }

    fn look_at_tensions<const D: usize>(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &mut Workspace<D>,
        theta: f64,
        h: f64,
    ) -> bool {
        let step = |index: usize| {
            let part = &model.parts()[index];
            let stretching = part.stretching()?;
            Some((taken(stretching, part, state, h, theta), part.v.clone()))
        };
        if !self.tensions.look(&self.v_end, step) {
            return false;
        }
        self.tensions.take_next(&mut self.v_end, step, &mut work.factors, weights(h, theta));
        work.counts.factorisations += self.tensions.len();
        true
    }

    /// The outcome of a step, which is unsolved where a tension was not found to `tolerance`.
    #[inline]
    pub(crate) fn judge(&self, outcome: Option<Outcome>, tolerance: f64) -> Option<Outcome> {
        self.tensions.judge(outcome, tolerance)
    }

    /// Leaves v_θ, and q¹ in `q_at`, for a phase, which refuses what is not finite.
    pub(crate) fn move_to_end<const D: usize>(&mut self, model: &Model<D>, state: &State, h: f64, theta: f64) {
        let Self { q_at, v_end, v_mean, .. } = self;
        mix(theta, v_end, 1.0 - theta, &state.v, v_mean);
        model.move_along(&state.q, v_mean, h, q_at);
    }

    /// The same for a scheme that goes on from there.
    pub(crate) fn close<const D: usize>(
        &mut self,
        model: &Model<D>,
        state: &State,
        h: f64,
        theta: f64,
    ) -> Result<(), StepError> {
        self.move_to_end(model, state, h, theta);
        // A velocity that is not finite leaves a coordinate that isn't.
        if all_finite(&self.q_at) { Ok(()) } else { Err(StepError::Diverged { t: state.t }) }
    }

    /// The same at an impact, after which velocities are `v`: what drives give.
    pub(crate) fn work_of_impact<const D: usize>(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &mut Workspace<D>,
        stage: &ContactStage<D>,
        v: &[f64],
    ) -> Result<StepEnergy, StepError> {
        if !model.is_driven() {
            return Ok(StepEnergy::default());
        }
        self.v_end.copy_from_slice(v);
        self.q_forces.copy_from_slice(&state.q);
        self.impulse.fill(0.0);
        self.close(model, state, 0.0, 0.5)?;
        Ok(self.work_of_forces(model, state, work, stage, 0.0, 0.5))
    }

    /// The terms of the energy identity that aren't contact: loads, drives, damping, the scheme
    /// itself. The impulses of the step's contacts are in `stage`.
    pub(crate) fn work_of_forces<const D: usize>(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &mut Workspace<D>,
        stage: &ContactStage<D>,
        h: f64,
        theta: f64,
    ) -> StepEnergy {
        if work.account == Account::LeftOut {
            return StepEnergy::default();
        }
        let Self { q_forces, q_at, v_end, v_mean, dv, load, product, impulse, cutoff, tensions, .. } = self;
        let mut energy = StepEnergy::default();
        if theta != 0.5 || model.is_driven() {
            for ((dv, v1), v0) in dv.iter_mut().zip(v_end.iter()).zip(&state.v) {
                *dv = v1 - v0;
            }
        }
        for (index, part) in model.parts().iter().enumerate().filter(|(_, part)| !part.v.is_empty()) {
            let (q, v) = (&q_forces[part.q.clone()], part.v.clone());
            if let Some(numerical) = tensions.numerical(index).filter(|_| h > 0.0) {
                energy.numerical += numerical;
            } else if let Some(linearised) = part.system.linearised() {
                let modified = |q: &[f64], velocity: &[f64]| {
                    linearised.modified_energy(h, &q[part.q.clone()], &velocity[part.v.clone()])
                };
                energy.numerical -= modified(q_at, v_end) - modified(&state.q, &state.v);
            }
            let product = &mut product[v.clone()];
            let in_closed_form = cutoff.is_some() && work.factors.propagator(index).is_some();
            if part.traits.damped && !in_closed_form {
                energy.viscous -= h * part.system.damping_power(q, &v_mean[v.clone()], product);
            }
            let mut form = |w: Weights, x: &[f64]| {
                product.fill(0.0);
                part.system.apply(w, q, x, product);
                dot(x, product)
            };
            if theta != 0.5 {
                let m = Weights { mass: 1.0, ..Weights::default() };
                let k = Weights { stiffness: 1.0, ..Weights::default() };
                energy.numerical -= (theta - 0.5) * (form(m, &dv[v.clone()]) + h * h * form(k, &v_mean[v.clone()]));
            }
            if part.traits.loaded {
                energy.external += h * dot(&v_mean[v.clone()], &load[v.clone()]);
            }
            if part.is_driven() {
                // What the drives give: momentum gained less the impulses of all other forces.
                product.fill(0.0);
                part.system.apply(weights(h, theta), q, &dv[v.clone()], product);
                let pushed = &mut work.scratch[..v.len()];
                pushed.fill(0.0);
                stage.add_generalised_impulse(index, pushed);
                let (impulse, mean) = (&impulse[v.clone()], &v_mean[v]);
                for &k in &part.traits.driven {
                    energy.external += mean[k] * (product[k] - impulse[k] - pushed[k]);
                }
            }
        }
        energy
    }
}

/// The step from a state, as one of its parts that stretch has it.
fn taken<'a, const D: usize>(
    stretching: &'a dyn Stretching,
    part: &Part<D>,
    state: &'a State,
    h: f64,
    theta: f64,
) -> Taken<'a> {
    Taken { stretching, h, theta, q: &state.q[part.q.clone()], v: &state.v[part.v.clone()] }
}

/// β = hα/(1 + hθα): with C = αM the damping needs no product.
///
/// A Δv = h[−K(q⁰ + hθv⁰) − αM v⁰ + P] with A = (1 + hθα)M + h²θ²K, so αM v⁰ = α/(1 + hθα) (A −
/// h²θ²K) v⁰ and
///
/// ```text
/// v_free = (1 − β) v⁰ + h W [ −K(q⁰ + hθ(1 − βθ) v⁰) + P ]
/// ```
fn beside_mass_damping(alpha: f64, h: f64, theta: f64) -> f64 {
    h * alpha / (1.0 + h * theta * alpha)
}

/// Leaves the mean load of a part in `load`, and adds it to its forces.
#[inline(never)]
fn add_mean_load<const D: usize>(
    part: &Part<D>,
    load: &mut [f64],
    forces: &mut [f64],
    scratch: &mut [f64],
    span: &StepSpan,
) {
    load.fill(0.0);
    part.system.mean_load([span.start, span.end], scratch, load);
    add(forces, load);
}

/// out = a x + b y. (A function of its own, so that the compiler knows that they don't overlap.)
fn mix(a: f64, x: &[f64], b: f64, y: &[f64], out: &mut [f64]) {
    for ((out, x), y) in out.iter_mut().zip(x).zip(y) {
        *out = a * x + b * y;
    }
}

fn add(x: &mut [f64], y: &[f64]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x += y;
    }
}
