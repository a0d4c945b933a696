//! What a beam bears in a step: its section forces and reactions, from the equilibrium that the step solved.
//!
//! A θ step satisfies, with q_θ = θq¹ + (1−θ)q⁰ and v_θ alike,
//!
//! ```text
//! M (v¹ − v⁰)/h + C v_θ + K q_θ = P̄ + Jᵀp/h
//! ```
//!
//! with P̄ the mean of the loads over the step, and the supports' acceleration in M's share where they move. Element by element that gives the end forces, so what is read
//! from them is the mean over the step, and balances to rounding. An impact's impulse p is spread over the step as p/h: its
//! peaks grow as h shrinks.

use super::line::lift_and_turn;
use crate::{Contact, State, StepReport, Vector};
use std::ops::Range;
use std::sync::Arc;
use teeter_beam::{Actions, Beam, BeamError, ModalBasis, SectionForces, SpanLoad};
use teeter_detect::{Anchor, BodyId, Frame};

/// Loads on a beam by their places: the same that its [`BeamBody`](crate::BeamBody) is under, weight included.
pub trait SpanLoads: std::fmt::Debug + Send + Sync {
    /// Adds the loads at time `t` (s) to a list. Allocates nothing else.
    fn add(&self, t: f64, loads: &mut Vec<SpanLoad>);

    /// Adds the means of the loads over the time from `times[0]` to `times[1]` (s) to a list, as a step takes them
    /// ([`Subsystem::mean_load`](crate::Subsystem::mean_load)). Allocates nothing else.
    fn add_mean(&self, times: [f64; 2], loads: &mut Vec<SpanLoad>);
}

/// The section forces of a beam, step by step. Between [`start`](Self::start) and the end of a run every step has to be
/// [entered](Self::enter), as they follow from the change of the state.
#[derive(Debug)]
pub struct BeamForces {
    beam: Arc<Beam>,
    body: BodyId,
    /// Its coordinates in the state.
    range: Range<usize>,
    /// Where in the state the supports' displacement y is, if they move.
    lifted: Option<usize>,
    theta: f64,
    loads: Option<Box<dyn SpanLoads>>,
    /// What its coordinates are, where they are not its dofs.
    basis: Option<Arc<ModalBasis>>,
    /// The dofs of the state before the step, and their rates.
    q: Vec<f64>,
    v: Vec<f64>,
    lift: f64,
    /// Those of the state after it.
    q_next: Vec<f64>,
    v_next: Vec<f64>,
    /// q_θ, v_θ, the acceleration, and q⁰ + hθv⁰.
    q_mean: Vec<f64>,
    v_mean: Vec<f64>,
    acceleration: Vec<f64>,
    predicted: Vec<f64>,
    span_loads: Vec<SpanLoad>,
    forces: SectionForces,
}

/// Room for loads and contacts before a list has to grow.
const LOADS: usize = 32;

impl BeamForces {
    /// Of the beam that is `body`, with its coordinates at `range` of the state, in steps with this θ.
    #[must_use]
    pub fn new(beam: &Arc<Beam>, body: BodyId, range: Range<usize>, theta: f64) -> Self {
        let none = vec![0.0; beam.dofs()];
        Self {
            body,
            range,
            lifted: None,
            theta,
            loads: None,
            basis: None,
            q: none.clone(),
            v: none.clone(),
            lift: 0.0,
            q_next: none.clone(),
            v_next: none.clone(),
            q_mean: none.clone(),
            v_mean: none.clone(),
            acceleration: none.clone(),
            predicted: if beam.is_stretched() { none } else { Vec::new() },
            span_loads: Vec::with_capacity(LOADS),
            forces: SectionForces::new(beam),
            beam: Arc::clone(beam),
        }
    }

    /// The same for supports that move, their displacement y at this place of the state.
    #[must_use]
    pub fn with_supports(mut self, y: usize) -> Self {
        self.lifted = Some(y);
        self
    }

    /// The same under loads.
    #[must_use]
    pub fn with_loads(mut self, loads: Box<dyn SpanLoads>) -> Self {
        self.loads = Some(loads);
        self
    }

    /// The same for a beam whose coordinates are those of `basis`. What is read balances up to what the basis leaves out: loads
    /// and contacts act on the elements, while deflections and inertia have the basis' shapes only.
    #[must_use]
    pub fn in_modes(mut self, basis: Arc<ModalBasis>) -> Self {
        self.basis = Some(basis);
        self
    }

    /// The beam.
    #[must_use]
    pub fn beam(&self) -> &Arc<Beam> {
        &self.beam
    }

    /// The section forces of the last step entered.
    #[must_use]
    pub fn forces(&self) -> &SectionForces {
        &self.forces
    }

    /// The loads of the last step entered, contacts among them, as means over the step.
    #[must_use]
    pub fn loads(&self) -> &[SpanLoad] {
        &self.span_loads
    }

    /// The acceleration of the last step entered, that of the supports in it.
    #[must_use]
    pub fn acceleration(&self) -> &[f64] {
        &self.acceleration
    }

    /// The dofs of the beam in the last state started from or entered.
    #[must_use]
    pub fn dofs(&self) -> &[f64] {
        &self.q
    }

    /// The velocity v_θ of the last step entered, relative to the supports.
    #[must_use]
    pub fn velocity(&self) -> &[f64] {
        &self.v_mean
    }

    /// A force on a point of a beam's surface, in a contact's frame (N), as a load on the axis of a beam of this span (m).
    #[must_use]
    pub fn surface_load(side: &Anchor<2>, frame: &Frame<2>, force: &Vector<2>, span: f64) -> SpanLoad {
        let [up, turn] = lift_and_turn(&side.point, frame);
        SpanLoad::Point { x: side.point.x.clamp(0.0, span), force: up.dot(force), couple: turn.dot(force) }
    }

    /// Takes the state from which the next step starts. Its own section forces are those of a beam at rest in equilibrium under its
    /// loads and the forces `pressing` of contacts; without these, of the deflection alone.
    ///
    /// # Errors
    /// As [`SectionForces::update`]; and for a state without the coordinates that these are of.
    pub fn start(&mut self, state: &State, pressing: Option<&[SpanLoad]>) -> Result<&SectionForces, BeamError> {
        self.read(state)?;
        self.keep(state);
        self.span_loads.clear();
        if let Some(pressing) = pressing {
            if let Some(loads) = &self.loads {
                loads.add(state.t, &mut self.span_loads);
            }
            self.span_loads.extend_from_slice(pressing);
        }
        let actions = Actions { q: &self.q, loads: &self.span_loads, ..Actions::default() };
        self.forces.update(&self.beam, &actions)?;
        Ok(&self.forces)
    }

    /// The section forces of a step that led to `state`; allocates nothing unless there are more loads than ever before.
    ///
    /// # Errors
    /// As [`SectionForces::update`], such as for a state that is not finite; and for a state without the coordinates that these are of.
    pub fn enter(&mut self, step: &StepReport<'_, 2>, state: &State) -> Result<&SectionForces, BeamError> {
        let (h, theta) = (state.dt, self.theta);
        self.read(state)?;
        let (q1, v1) = (&self.q_next, &self.v_next);
        let mean = |out: &mut [f64], x0: &[f64], x1: &[f64]| {
            out.iter_mut().zip(x0.iter().zip(x1)).for_each(|(out, (x0, x1))| *out = theta * x1 + (1.0 - theta) * x0);
        };
        mean(&mut self.q_mean, &self.q, q1);
        mean(&mut self.v_mean, &self.v, v1);
        for (a, (v0, v1)) in self.acceleration.iter_mut().zip(self.v.iter().zip(v1)) {
            *a = (v1 - v0) / h;
        }
        if let Some(y) = self.lifted {
            let lift = (state.v[y] - self.lift) / h;
            self.acceleration[..2 * self.beam.nodes()].iter_mut().step_by(2).for_each(|a| *a += lift);
        }
        for (predicted, (q0, v0)) in self.predicted.iter_mut().zip(self.q.iter().zip(&self.v)) {
            *predicted = q0 + h * theta * v0;
        }
        self.span_loads.clear();
        if let Some(loads) = &self.loads {
            loads.add_mean([step.t_start, step.t_end], &mut self.span_loads);
        }
        let span = self.beam.spec().span;
        self.span_loads.extend(step.contacts.iter().flat_map(|contact| pushes(contact, self.body, span, h)));
        self.keep(state);
        let actions = Actions {
            q: &self.q_mean,
            velocity: &self.v_mean,
            acceleration: &self.acceleration,
            loads: &self.span_loads,
            stretched_at: &self.predicted,
        };
        self.forces.update(&self.beam, &actions)?;
        Ok(&self.forces)
    }

    /// The dofs of the state.
    fn read(&mut self, state: &State) -> Result<(), BeamError> {
        let coordinates = self.basis.as_ref().map_or(self.beam.dofs(), |basis| basis.len());
        let last = self.lifted.map_or(0, |y| y + 1).max(self.range.end);
        for (field, expected, found) in [
            ("the range of the beam's coordinates", coordinates, self.range.len()),
            ("the shapes of the beam's basis", self.beam.dofs(), self.basis_dofs()),
            ("the coordinates of the state, at the least", last, state.q.len().min(last)),
            ("the velocities of the state, at the least", last, state.v.len().min(last)),
        ] {
            if expected != found {
                return Err(BeamError::Length { field, expected, found });
            }
        }
        for (dofs, of) in [(&mut self.q_next, &state.q), (&mut self.v_next, &state.v)] {
            let own = &of[self.range.clone()];
            match &self.basis {
                Some(basis) => basis.expand(own, dofs),
                None => dofs.copy_from_slice(own),
            }
        }
        Ok(())
    }

    fn basis_dofs(&self) -> usize {
        self.basis.as_ref().map_or(self.beam.dofs(), |basis| basis.shape(0).len())
    }

    fn keep(&mut self, state: &State) {
        std::mem::swap(&mut self.q, &mut self.q_next);
        std::mem::swap(&mut self.v, &mut self.v_next);
        self.lift = self.lifted.map_or(0.0, |y| state.v[y]);
    }
}

/// What a contact's impulse, spread over h, is on a beam: on either side if both are the beam's.
fn pushes(contact: &Contact<2>, body: BodyId, span: f64, h: f64) -> impl Iterator<Item = SpanLoad> {
    let Contact { sides, frame, p, .. } = *contact;
    sides
        .into_iter()
        .zip([1.0, -1.0])
        .filter(move |(side, _)| side.body == body)
        .map(move |(side, sign)| BeamForces::surface_load(&side, &frame, &(p * (sign / h)), span))
}
