//! Moreau's midpoint rule, q½ = q⁰ + h v⁰/2, v¹ = v⁰ + M⁻¹(h f(q½) + Jᵀp), q¹ = q½ + h v¹/2, with a step size of its own: a
//! fall ends where a point touches, and an impact then lasts for a thousandth of a step.

use teeter_integrator::*;

#[derive(Default)]
pub struct Landing {
    middle: Vec<f64>,
    q: Vec<f64>,
    v: Vec<f64>,
    stage: ContactStage<2>,
}

impl Scheme<2> for Landing {
    fn name(&self) -> &'static str {
        "landing"
    }

    fn start(&mut self, model: &Model<2>, state: &mut State, work: &mut Workspace<2>) -> Result<(), StepError> {
        (self.middle, self.q) = (state.q.clone(), state.q.clone());
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
        // A point strikes if it is faster than forces make it in a step, at the time t with gap + u t + a t²/2 = 0.
        let mut h = state.dt;
        work.free_velocity(model, Weights::MASS, &state.q, &state.v, &state.next_step(f64::INFINITY), &mut self.v)?;
        self.stage.find(model, state, &Look::new(&state.q, f64::INFINITY), work)?;
        for (i, contact) in self.stage.contacts().iter().enumerate() {
            let (gap, u) = (contact.gap.max(0.0), self.stage.velocity(i, &state.v)?[0]);
            let a = (self.stage.velocity(i, &self.v)?[0] - u) / state.dt;
            let speed = (u * u - 2.0 * a * gap).sqrt();
            let t = 2.0 * gap / (speed - u);
            if speed > a.abs() * state.dt && (0.0..h).contains(&t) {
                h = t.max(1e-3 * state.dt);
            }
        }

        let span = state.step_of(h, until);
        work.begin(model, state, span)?;
        model.retract(&state.q, &state.v, 0.5 * span.h, &mut self.middle)?;
        work.free_velocity(model, Weights::MASS, &self.middle, &state.v, &span, &mut self.v)?;
        self.stage.find(model, state, &Look::new(&self.middle, 1e-12), work)?;
        let over = Over::Step { h: span.h, weight: 0.5 };
        let outcome = self.stage.resolve(model, state, &mut self.v, over, &Responses::Of(Weights::MASS), work)?;
        model.retract(&self.middle, &self.v, 0.5 * span.h, &mut self.q)?;
        let phase = PhaseEnd::new(PhaseKind::Step, span.end, &self.q, &self.v).with_outcome(outcome);
        work.phase(model, &phase, Some(&mut self.stage))?;
        work.finish(model, state, None, |_, _| true)
    }
}
