//! Symplectic Euler with impacts at the end: bodies first move without contacts, q¹ = q⁰ + h v⁰, v* = v⁰ + h M⁻¹ f(q¹), then
//! what touches strikes in an instant, v¹ = v* + M⁻¹ Jᵀp. Between them a contact that lasts is a sequence of small impacts,
//! and a body that rests on a surface with restitution e hops with up to 2 e g h.

use teeter_integrator::*;

#[derive(Default)]
pub struct TwoPhases {
    q: Vec<f64>,
    v: Vec<f64>,
    change: Vec<f64>,
    stage: ContactStage<2>,
}

impl Scheme<2> for TwoPhases {
    fn name(&self) -> &'static str {
        "two-phases"
    }

    fn start(&mut self, model: &Model<2>, state: &mut State, work: &mut Workspace<2>) -> Result<(), StepError> {
        self.q.clone_from(&state.q);
        self.stage.reserve(model);
        work.factors(crate::unforced(model)?, Weights::MASS, &state.q, Keep::Pinned)
    }

    fn advance<'w>(
        &mut self,
        model: &Model<2>,
        state: &mut State,
        until: f64,
        work: &'w mut Workspace<2>,
    ) -> Result<StepReport<'w, 2>, StepError> {
        let span = state.next_step(until);
        work.begin(model, state, span)?;
        model.retract(&state.q, &state.v, span.h, &mut self.q)?;
        work.free_velocity(model, Weights::MASS, &self.q, &state.v, &span, &mut self.v)?;
        // Weight did its work at the velocity v⁰, and not at the mean, which makes ΔvᵀM Δv/2.
        self.change.clear();
        self.change.extend(self.v.iter().zip(&state.v).map(|(v1, v0)| v1 - v0));
        let numerical = model.energy(&self.q, &self.change)?.kinetic;
        let energy = StepEnergy { numerical, ..StepEnergy::default() };
        let smooth = PhaseEnd::new(PhaseKind::Smooth, span.end, &self.q, &self.v).with_energy(energy);
        work.phase(model, &smooth, None)?;

        self.stage.find(model, state, &Look::new(&self.q, 0.0), work)?;
        if !self.stage.is_empty() {
            let responses = Responses::Of(Weights::MASS);
            let outcome = self.stage.resolve(model, state, &mut self.v, Over::Instant, &responses, work)?;
            let impact = PhaseEnd::new(PhaseKind::Impact, span.end, &self.q, &self.v).with_outcome(outcome);
            work.phase(model, &impact, Some(&mut self.stage))?;
        }
        work.finish(model, state, None, |_, _| true)
    }
}
