//! Section forces and reactions of a beam in a step, from the equilibrium that the step has solved.
//!
//! A phase of a step satisfies, with the means q̄ and v̄ of its [balance](crate::Balance),
//!
//! ```text
//! M (v¹ − v⁰)/τ + C v̄ + K q̄ = P̄ + Jᵀp/τ
//! ```
//!
//! with P̄ the mean of the loads over the phase, and the acceleration of moving supports included
//! in the term of M. Element by element this gives the end forces; so they are means over the
//! phase, and balance to rounding. If a step takes forces and impulses together, the impulse p of
//! an impact is spread over it as p/τ: its peaks grow as the step shrinks.

use super::BEAM_BODIES;
use super::line::{lift_and_turn, section_of};
use crate::{Contact, Phase, State, StepReport, Vector};
use std::ops::Range;
use std::sync::Arc;
use teeter_beam::{Actions, Beam, BeamError, ModalBasis, SectionForces, SpanLoad};
use teeter_detect::{Anchor, BodyId, Frame};

/// Loads on a beam with their places: the same ones that act on its [`BeamBody`](crate::BeamBody),
/// weight included.
pub trait SpanLoads: std::fmt::Debug + Send + Sync {
    /// Adds the loads at time `t` (s) to a list. Must allocate nothing else.
    fn add(&self, t: f64, loads: &mut Vec<SpanLoad>);

    /// Adds the means of the loads over the time from `times[0]` to `times[1]` (s) to a list, as a
    /// step takes them ([`Dynamics::mean_load`](crate::Dynamics::mean_load)). Must allocate nothing
    /// else.
    fn add_mean(&self, times: [f64; 2], loads: &mut Vec<SpanLoad>);
}

/// The section forces of a beam, phase by phase of its steps, whatever the scheme.
#[derive(Debug)]
pub struct BeamForces {
    beam: Arc<Beam>,
    body: BodyId,
    /// Its coordinates in the state.
    range: Range<usize>,
    /// Position of the supports' displacement y in the state, if they move.
    lifted: Option<usize>,
    loads: Option<Box<dyn SpanLoads>>,
    /// The basis of its coordinates, if they are not its dofs.
    basis: Option<Arc<ModalBasis>>,
    /// The dofs before and after the phase, and their rates.
    q: [Vec<f64>; 2],
    v: [Vec<f64>; 2],
    /// q̄, v̄ and the acceleration.
    q_mean: Vec<f64>,
    v_mean: Vec<f64>,
    acceleration: Vec<f64>,
    /// q̄ or v̄ of a phase whose scheme knows it.
    known: Vec<f64>,
    span_loads: Vec<SpanLoad>,
    forces: SectionForces,
}

/// Loads and contacts for which memory is reserved.
const LOADS: usize = 32;

impl BeamForces {
    /// For the beam whose first body is `body`, with its coordinates at `range` of the state.
    #[must_use]
    pub fn new(beam: &Arc<Beam>, body: BodyId, range: Range<usize>) -> Self {
        let none = vec![0.0; beam.dofs()];
        Self {
            body,
            range,
            lifted: None,
            loads: None,
            basis: None,
            q: [none.clone(), none.clone()],
            v: [none.clone(), none.clone()],
            q_mean: none.clone(),
            v_mean: none.clone(),
            acceleration: none.clone(),
            known: none,
            span_loads: Vec::with_capacity(LOADS),
            forces: SectionForces::new(beam),
            beam: Arc::clone(beam),
        }
    }

    /// With moving supports, whose displacement y is at this position of the state.
    #[must_use]
    pub fn with_supports(mut self, y: usize) -> Self {
        self.lifted = Some(y);
        self
    }

    /// With loads.
    #[must_use]
    pub fn with_loads(mut self, loads: Box<dyn SpanLoads>) -> Self {
        self.loads = Some(loads);
        self
    }

    /// For a beam whose coordinates are those of `basis`. The forces then balance up to what the
    /// basis leaves out: loads and contacts act on the elements, while deflections and inertia have
    /// the shapes of the basis only.
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

    /// The section forces of the last phase entered.
    #[must_use]
    pub fn forces(&self) -> &SectionForces {
        &self.forces
    }

    /// The loads of the last phase entered, contacts included, as means over it.
    #[must_use]
    pub fn loads(&self) -> &[SpanLoad] {
        &self.span_loads
    }

    /// The acceleration in the last phase entered, that of the supports included.
    #[must_use]
    pub fn acceleration(&self) -> &[f64] {
        &self.acceleration
    }

    /// The dofs of the beam in the state that was last started from, or at the end of the last
    /// phase entered.
    #[must_use]
    pub fn dofs(&self) -> &[f64] {
        &self.q[1]
    }

    /// The mean velocity of the last phase entered, relative to the supports.
    #[must_use]
    pub fn velocity(&self) -> &[f64] {
        &self.v_mean
    }

    /// A force on a point of a beam's upper surface, in a contact's frame (N), as a load on the
    /// axis of a beam of this span (m).
    #[must_use]
    pub fn surface_load(side: &Anchor<2>, frame: &Frame<2>, force: &Vector<2>, span: f64) -> SpanLoad {
        load_on_axis(&side.point, frame, &frame.row(0).transpose(), force, span)
    }

    /// Whether a body is one of the beam's.
    fn is_own(&self, body: BodyId) -> bool {
        (body.0.wrapping_sub(self.body.0) as usize) < BEAM_BODIES
    }

    /// The section forces of a state: those of a beam at rest in equilibrium under its loads and
    /// the contact forces `pressing`; with `None`, those of the deflection alone.
    ///
    /// # Errors
    /// As [`SectionForces::update`]; and if the state doesn't have the beam's coordinates.
    pub fn start(&mut self, state: &State, pressing: Option<&[SpanLoad]>) -> Result<&SectionForces, BeamError> {
        self.read(1, &state.q, &state.v)?;
        self.span_loads.clear();
        if let Some(pressing) = pressing {
            if let Some(loads) = &self.loads {
                loads.add(state.t, &mut self.span_loads);
            }
            self.span_loads.extend_from_slice(pressing);
        }
        let actions = Actions::at(&self.q[1]).with_loads(&self.span_loads);
        self.forces.update(&self.beam, &actions)?;
        Ok(&self.forces)
    }

    /// The section forces of a phase, as means over it; `None` for an impact, which takes no time.
    /// Allocates only if there are more loads than ever before.
    ///
    /// # Errors
    /// As [`SectionForces::update`], such as for a state that is not finite; and if the phase
    /// doesn't have the beam's coordinates.
    pub fn enter(&mut self, phase: &Phase<'_, 2>) -> Result<Option<&SectionForces>, BeamError> {
        for end in 0..2 {
            self.read(end, phase.q[end], phase.v[end])?;
        }
        if phase.duration <= 0.0 {
            return Ok(None);
        }
        self.take_means(std::iter::once(*phase), phase.duration, [phase.start, phase.end])?;
        Ok(Some(&self.forces))
    }

    /// The section forces of a step, as means over all of its phases that take time: of a step in
    /// several parts, the mean of theirs by their durations. Impacts, which take no time, are not
    /// in it. `None` for a step without such a phase. Of a step in one phase it is what
    /// [`enter`](Self::enter) gives.
    ///
    /// # Errors
    /// As [`BeamForces::enter`].
    pub fn enter_step(&mut self, step: &StepReport<'_, 2>) -> Result<Option<&SectionForces>, BeamError> {
        let lasting = || step.phases().filter(|phase| phase.duration > 0.0);
        let whole: f64 = lasting().map(|phase| phase.duration).sum();
        if whole <= 0.0 {
            return Ok(None);
        }
        self.take_means(lasting(), whole, [step.t_start, step.t_end])?;
        Ok(Some(&self.forces))
    }

    /// Takes the means of phases that last for `whole` (s) together, between these times, and the
    /// forces of them.
    fn take_means<'p>(
        &mut self,
        phases: impl Iterator<Item = Phase<'p, 2>>,
        whole: f64,
        times: [f64; 2],
    ) -> Result<(), BeamError> {
        for mean in [&mut self.q_mean, &mut self.v_mean, &mut self.acceleration] {
            mean.fill(0.0);
        }
        self.span_loads.clear();
        if let Some(loads) = &self.loads {
            loads.add_mean(times, &mut self.span_loads);
        }
        let mut tension = 0.0;
        for phase in phases {
            let (part, weight) = (phase.duration / whole, phase.balance.weight());
            for end in 0..2 {
                self.read(end, phase.q[end], phase.v[end])?;
            }
            if let Some(mean) = phase.mean.and_then(|mean| mean.get(self.range.clone())) {
                match &self.basis {
                    Some(basis) => basis.expand(mean, &mut self.known),
                    None => self.known.copy_from_slice(mean),
                }
                self.q_mean.iter_mut().zip(&self.known).for_each(|(sum, mean)| *sum += part * mean);
                tension += part * self.tension_towards_known(weight);
                if let Some(mean) = phase.mean_velocity.and_then(|mean| mean.get(self.range.clone())) {
                    match &self.basis {
                        Some(basis) => basis.expand(mean, &mut self.known),
                        None => self.known.copy_from_slice(mean),
                    }
                    self.v_mean.iter_mut().zip(&self.known).for_each(|(sum, mean)| *sum += part * mean);
                } else {
                    for (mean, (q0, q1)) in self.v_mean.iter_mut().zip(self.q[0].iter().zip(&self.q[1])) {
                        *mean += (q1 - q0) / whole;
                    }
                }
            } else {
                tension += part * self.tension_between(&self.q[1]);
                for (mean, [x0, x1]) in [(&mut self.q_mean, &self.q), (&mut self.v_mean, &self.v)] {
                    for (mean, (x0, x1)) in mean.iter_mut().zip(x0.iter().zip(x1)) {
                        *mean += part * (weight * x1 + (1.0 - weight) * x0);
                    }
                }
            }
            for (a, (v0, v1)) in self.acceleration.iter_mut().zip(self.v[0].iter().zip(&self.v[1])) {
                *a += (v1 - v0) / whole;
            }
            if let Some(y) = self.lifted {
                let lift = (phase.v[1][y] - phase.v[0][y]) / whole;
                self.acceleration[..2 * self.beam.nodes()].iter_mut().step_by(2).for_each(|a| *a += lift);
            }
            let mut loads = std::mem::take(&mut self.span_loads);
            loads.extend(phase.contacts.iter().flat_map(|contact| self.pushes(contact, whole)));
            self.span_loads = loads;
        }
        let actions = Actions::at(&self.q_mean)
            .with_velocity(&self.v_mean)
            .with_acceleration(&self.acceleration)
            .with_loads(&self.span_loads)
            .with_tension(self.beam.is_stretched().then_some(tension));
        self.forces.update(&self.beam, &actions)
    }

    /// What the deflection adds to the axial force of a beam held along its axis in a phase from
    /// the dofs that were read to `end`, N: the mean of both, EA/(4L) (s⁰ + s¹).
    fn tension_between(&self, end: &[f64]) -> f64 {
        let ends = [&self.q[0], end].map(|q| self.beam.slope_form(q, q));
        0.5 * self.beam.stretching_stiffness() * (ends[0] + ends[1])
    }

    /// The same where the scheme knows the mean of the coordinates, which is in `known` and becomes
    /// the end that it is the mean towards, q̄ = w q¹ + (1 − w) q⁰: the coordinates at the end of
    /// the phase may have been projected to elsewhere.
    fn tension_towards_known(&mut self, weight: f64) -> f64 {
        if !self.beam.is_stretched() || weight <= 0.0 {
            return 0.0;
        }
        for (mean, q0) in self.known.iter_mut().zip(&self.q[0]) {
            *mean = q0 + (*mean - q0) / weight;
        }
        self.tension_between(&self.known)
    }

    /// Reads the dofs at one end of a phase.
    fn read(&mut self, end: usize, q: &[f64], v: &[f64]) -> Result<(), BeamError> {
        let coordinates = self.basis.as_ref().map_or(self.beam.dofs(), |basis| basis.len());
        let last = self.lifted.map_or(0, |y| y + 1).max(self.range.end);
        for (field, expected, found) in [
            ("the range of the beam's coordinates", coordinates, self.range.len()),
            ("the shapes of the beam's basis", self.beam.dofs(), self.basis_dofs()),
            ("the coordinates of the state, at the least", last, q.len().min(last)),
            ("the velocities of the state, at the least", last, v.len().min(last)),
        ] {
            if expected != found {
                return Err(BeamError::Length { field, expected, found });
            }
        }
        for (dofs, of) in [(&mut self.q[end], q), (&mut self.v[end], v)] {
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

    /// The loads on the beam by a contact's impulse, spread over h: one for each side that is the
    /// beam's.
    fn pushes(&self, contact: &Contact<2>, h: f64) -> impl Iterator<Item = SpanLoad> + use<'_> {
        let Contact { sides, frame, p, .. } = *contact;
        sides.into_iter().zip([1.0, -1.0]).filter(|(side, _)| self.is_own(side.body)).map(move |(side, sign)| {
            let number = side.body.0.wrapping_sub(self.body.0);
            let section = section_of(&*self.beam, (number, &self.q[1]), &side.point, &frame);
            load_on_axis(&side.point, &frame, &section, &(p * (sign / h)), self.beam.spec().span)
        })
    }
}

/// A force in a contact's frame (N) on a point of a beam whose section there has this normal, as a
/// load on the axis.
fn load_on_axis(point: &Vector<2>, frame: &Frame<2>, section: &Vector<2>, force: &Vector<2>, span: f64) -> SpanLoad {
    let [up, turn] = lift_and_turn(point, frame, section);
    SpanLoad::Point { x: point.x.clamp(0.0, span), force: up.dot(force), couple: turn.dot(force) }
}
