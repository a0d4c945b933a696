//! The event-driven scheme: `event-driven` (`docs/schemes.md`).

mod decide;
mod dips;
mod events;
mod instant;
mod linear;
mod modes;
mod runge_kutta;
mod smooth;
mod turning;

use crate::moreau_jean_located::{MoreauJeanLocated, MoreauJeanLocatedSettings};
use crate::{
    Keep, Model, PhaseEnd, PhaseKind, Scheme, SettingError, State, StepEnergy, StepError, StepReport, StepSpan, Vector,
    Workspace,
};
use events::Open;
use instant::Watch;
use modes::{Mode, Pressing};
use runge_kutta::RungeKutta;
use smooth::{MASSES, Smooth};
use teeter_detect::{Candidate, Candidates, ContactId};

/// The settings of [`EventDriven`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EventDrivenSettings {
    /// Largest error of a step within a smooth phase, as a part of the largest coordinate and the
    /// largest velocity.
    pub tolerance: f64,
}

impl Default for EventDrivenSettings {
    fn default() -> Self {
        Self { tolerance: 1e-12 }
    }
}

/// Gaps are located to this, m, or to rounding where that is more.
const GAP_TOLERANCE: f64 = 1e-14;

/// A place, velocity or acceleration below this (m or rad, per s or s²) has errors measured by this.
const FLOOR: f64 = 1e-3;

/// Bounces that rise by less than so many tolerances of gaps are none.
const LOWEST_BOUNCE: f64 = 100.0;

/// Prescribed velocities that change by this part of the largest don't jump.
const NO_JUMP: f64 = 1e-12;

/// Events one upon the other, without motion in between, after which the modes go round in a circle.
const MOST_IDLE: u32 = 6;

/// Phases of a step for which there is room from the start: a corner that chatters on a beam has dozens.
const USUAL_PHASES: usize = 100;

/// Numbers that the state's memory holds of a contact: pair, point, mode, level.
const REMEMBERED: usize = 4;

/// Of steps one after the other with more events than are located, each may have half as many as the one before, up to so many
/// times: where a beam chatters on its bearings, almost all of them are the located scheme's in the end.
const LEAST_OF_EVENTS: u32 = 4;

/// What it can't step.
const SPRINGS: &str = "contacts with duration, whose forces event-driven doesn't integrate";
const ON_MANIFOLDS: &str = "coordinates that don't move with velocities one by one";
const UNKNOWN_DRIVES: &str = "prescribed velocities whose accelerations aren't known: it needs Dynamics::drive_rate";

/// Smooth motion by a method of order 8 with steps of its own, divided where something happens: a
/// contact closes, opens, begins to slide or stops.
///
/// Between two events each contact that presses either sticks or slides to one side, and
///
/// ```text
/// M a = F(q, v, t) + Jᵀ f,   J_n a + J̇_n v = 0,   sticking: J_t a + J̇_t v = 0,   sliding: f_t = −μ f_n sign(u_t)
/// ```
///
/// is integrated by DOP853 (Hairer, Nørsett, Wanner, doi 10.1007/978-3-540-78862-1), together with
/// impulses and work, to a local error of [`tolerance`](EventDrivenSettings::tolerance). Events are
/// the zeros of gaps, forces, distances from the friction cone and sliding velocities; each is
/// located to rounding by steps that end there, as are the times at which loads and drives have
/// kinks or jumps. Velocities jump by the impact of
/// [`MoreauJeanLocated`](crate::MoreauJeanLocated). Which contacts press, stick and slide afterwards
/// is found from the law over accelerations,
///
/// ```text
/// 0 ≤ a_n ⊥ f_n ≥ 0,   Coulomb's law on a_t where u_t = 0
/// ```
///
/// Where more happens in a step than [`MOST_EVENTS`](Self::MOST_EVENTS), as where bounces pile up, or
/// that law has no solution, the rest of the step is one of `MoreauJeanLocated`; the tally of
/// unlocated steps counts it.
///
/// The step size is only that of the output: the method's own steps end there. Contacts with
/// duration are refused, and beams held along their axis.
#[derive(Debug)]
pub struct EventDriven {
    settings: EventDrivenSettings,
    /// Impacts, and the rest of a step in which too much happens.
    located: MoreauJeanLocated<2>,
    smooth: Smooth,
    rk: RungeKutta,
    from: Option<Box<State>>,
    y: Vec<f64>,
    /// What errors are measured by.
    scale: Vec<f64>,
    /// Coordinates within a step.
    way: Vec<f64>,
    /// Slope at the end of a step.
    next_slope: Vec<f64>,
    mean: Vec<f64>,
    v_before: Vec<f64>,
    open: Vec<Open>,
    /// Contacts that leave at the end of a step.
    leaving: Vec<Open>,
    watched: Vec<Watch>,
    /// The last contacts, where an event changes them.
    touching: Candidates<2>,
    found: Candidates<2>,
    /// Of those that touch: what their normal velocity changes by in half the lowest bounce, m/s.
    in_lowest_bounce: Vec<(ContactId, f64)>,
    /// Accelerations with the contacts that pressed up to an event; empty where there were none.
    a_pressed: Vec<f64>,
    /// J̇v of those that don't part.
    biases: Vec<Vector<2>>,
    /// Those that part, with their normal velocity (m/s) and the normal part of J̇v (m/s²).
    parting: Vec<(Candidate<2>, f64, f64)>,
    /// Those of them that would be back at once.
    returning: Vec<ContactId>,
    ids: Vec<ContactId>,
    numbers: Vec<f64>,
    /// The step that the method would take next, s.
    h: f64,
    /// The last time at which loads and drives may have changed and contacts were decided anew, s.
    handled: f64,
    /// Energy that contacts took as they came to rest at the start of the phase, J.
    projected: f64,
    /// Open contacts with larger gaps than this can't close within the step of the method, m.
    near: f64,
    /// Steps of the method within the present one of the scheme's.
    substeps: usize,
    /// Whether loads or drives aren't smooth where the phase would end.
    ends_with_break: bool,
    /// Whether the step had more events than are located.
    had_too_many: bool,
}

/// Where a smooth phase ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stop {
    /// At the end of the step.
    End,
    /// Where loads or drives aren't smooth.
    Break,
    /// At an event: those that are watched.
    Event,
    /// It can't go on.
    Stuck,
}

impl EventDriven {
    /// The name by which users choose it.
    pub const NAME: &'static str = "event-driven";

    /// Events that are located in a step.
    pub const MOST_EVENTS: usize = 200;

    /// Contacts of which it finds the forces: they are solved all together. Steps in which more touch
    /// are those of the located scheme.
    pub const MOST_CONTACTS: usize = 32;

    /// Steps of the method within one of the scheme's: many fit where a beam has fast modes.
    pub const MOST_SUBSTEPS: usize = 1_000_000;

    /// A scheme with these settings.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(settings: EventDrivenSettings) -> Result<Self, SettingError> {
        let EventDrivenSettings { tolerance } = settings;
        if !(1e-14..=1e-3).contains(&tolerance) {
            return Err(SettingError { what: "tolerance", value: tolerance, rule: "in [1e-14, 1e-3]" });
        }
        Ok(Self {
            settings,
            located: MoreauJeanLocated::new(MoreauJeanLocatedSettings { gap_tolerance: GAP_TOLERANCE })?,
            smooth: Smooth::new(),
            rk: RungeKutta::default(),
            from: None,
            y: Vec::new(),
            scale: Vec::new(),
            way: Vec::new(),
            next_slope: Vec::new(),
            mean: Vec::new(),
            v_before: Vec::new(),
            open: Vec::new(),
            leaving: Vec::new(),
            watched: Vec::new(),
            touching: Vec::new(),
            found: Vec::new(),
            in_lowest_bounce: Vec::new(),
            a_pressed: Vec::new(),
            biases: Vec::new(),
            parting: Vec::new(),
            returning: Vec::new(),
            ids: Vec::new(),
            numbers: Vec::new(),
            h: 0.0,
            handled: 0.0,
            projected: 0.0,
            near: 0.0,
            substeps: 0,
            ends_with_break: false,
            had_too_many: false,
        })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &EventDrivenSettings {
        &self.settings
    }

    fn refuse(model: &Model<2>) -> Result<(), StepError> {
        let unsupported = |what| Err(StepError::Unsupported { what });
        if model.has_springs() {
            return unsupported(SPRINGS);
        }
        for part in model.parts() {
            if part.q.len() != part.v.len() {
                return unsupported(ON_MANIFOLDS);
            }
            if part.is_driven() && !part.system.drive_rate(0.0, &mut vec![0.0; part.v.len()]) {
                return unsupported(UNKNOWN_DRIVES);
            }
        }
        Ok(())
    }
}

impl Scheme<2> for EventDriven {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn start(&mut self, model: &Model<2>, state: &mut State, work: &mut Workspace<2>) -> Result<(), StepError> {
        Self::refuse(model)?;
        self.located.start(model, state, work)?;
        self.smooth.reserve(model);
        let (size, contacts) = (model.size(), model.contacts_to_expect().min(crate::stage::RESERVED_CONTACTS));
        let numbers = 1 + REMEMBERED * contacts;
        self.open.reserve(contacts);
        self.leaving.reserve(contacts);
        self.watched.reserve(4 * contacts);
        self.ids.reserve(contacts);
        self.touching.reserve(2 * contacts);
        self.found.reserve(contacts);
        self.way.reserve(size.q);
        self.in_lowest_bounce.reserve(contacts);
        self.biases.reserve(contacts);
        self.parting.reserve(contacts);
        self.returning.reserve(contacts);
        self.a_pressed.reserve(size.v);
        self.numbers.reserve(numbers);
        self.mean.resize(size.q, 0.0);
        self.v_before.resize(size.v, 0.0);
        let most = self.smooth.most(model);
        self.rk.resize(most);
        for list in [&mut self.y, &mut self.next_slope, &mut self.scale] {
            list.resize(most, 0.0);
        }
        state.memory.reserve_numbers(numbers);
        let mut from = state.clone();
        from.memory.reserve_numbers(numbers);
        from.memory.reserve(contacts);
        from.warm.reserve(contacts, 2);
        self.from = Some(Box::new(from));
        work.reserve_directed(model);
        // Many contacts are the located scheme's.
        if model.detector().capacity() <= 4 * Self::MOST_CONTACTS {
            work.reserve_phases(model, USUAL_PHASES);
        }
        work.factors(model, MASSES, &state.q, Keep::Pinned)
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
        self.located.check(model)?;
        self.smooth.resize(model);
        self.mean.resize(model.size().q, 0.0);
        self.v_before.resize(model.size().v, 0.0);
        let mut from = self.from.take().unwrap_or_else(|| Box::new(state.clone()));
        from.copy_motion(state);
        let took = self.take_phases(model, &mut from, &span, work);
        self.from = Some(from);
        let located = took?;
        let contacts = &self.smooth.contacts;
        let report = work.finish(model, state, None, |_, contact| {
            if located { contacts.iter().any(|own| own.id == contact.id) } else { contact.p[0] > 0.0 }
        })?;
        self.numbers.clear();
        // Without a step the next one begins anew.
        self.numbers.extend(located.then_some(self.h));
        if self.had_too_many {
            self.numbers.push(-f64::from(had_too_many(state).saturating_add(1)));
        }
        for contact in self.smooth.contacts.iter().filter(|_| located) {
            let Pressing { id, mode, level, .. } = contact;
            self.numbers.extend([f64::from(id.pair()), f64::from(id.point()), mode.number(), *level]);
        }
        state.memory.set_numbers(&self.numbers);
        state.tally.unlocated_steps += u64::from(!located);
        Ok(report)
    }
}

impl EventDriven {
    /// Takes the step from event to event, from `from`, which moves on; whether all events were
    /// located.
    fn take_phases(
        &mut self,
        model: &Model<2>,
        from: &mut State,
        span: &StepSpan,
        work: &mut Workspace<2>,
    ) -> Result<bool, StepError> {
        work.factors(model, MASSES, &from.q, Keep::Pinned)?;
        (self.handled, self.substeps) = (from.t, 0);
        let before = had_too_many(from);
        self.had_too_many = false;
        let jumped = self.jump(model, from, work)?;
        if from.memory.active().len() > Self::MOST_CONTACTS {
            self.smooth.contacts.clear();
            return self.take_rest(model, from, span, work);
        }
        let early = from.t - (after(from.t) - from.t);
        let breaks = model.parts().iter().map(|part| part.system.next_break(early));
        let broken = breaks.fold(f64::INFINITY, f64::min) <= after(from.t);
        let known = self.restore(model, from, work)?;
        let is_settled = known && !jumped && !broken;
        if !is_settled && !self.decide(model, from, work)? {
            return self.give_up(model, from, span, work);
        }
        let (mut at, mut idle) = (from.t, 0);
        let (mut events, most) = (0, Self::MOST_EVENTS >> before.min(LEAST_OF_EVENTS));
        while events <= most {
            let stop = self.go_on(model, from, span.end, work)?;
            idle = if from.t == at { idle + 1 } else { 0 };
            at = from.t;
            if idle > MOST_IDLE {
                break;
            }
            match stop {
                Stop::End => return Ok(true),
                Stop::Stuck => break,
                Stop::Event => {
                    events += 1;
                    if !self.change_modes(model, from, work)? {
                        break;
                    }
                }
                Stop::Break => {
                    self.handled = from.t;
                    self.jump(model, from, work)?;
                    if !self.decide(model, from, work)? {
                        break;
                    }
                }
            }
        }
        self.had_too_many = events > most;
        self.give_up(model, from, span, work)
    }

    /// Takes the rest of the step as the located scheme does, which finds anew what the contacts do.
    fn give_up(
        &mut self,
        model: &Model<2>,
        from: &mut State,
        span: &StepSpan,
        work: &mut Workspace<2>,
    ) -> Result<bool, StepError> {
        from.memory.forget_contacts();
        for contact in &self.smooth.contacts {
            from.memory.activate(contact.id);
        }
        self.smooth.contacts.clear();
        self.take_rest(model, from, span, work)
    }

    fn take_rest(
        &mut self,
        model: &Model<2>,
        from: &mut State,
        span: &StepSpan,
        work: &mut Workspace<2>,
    ) -> Result<bool, StepError> {
        let rest = StepSpan { start: from.t, end: span.end, h: span.end - from.t };
        if rest.h > 0.0 {
            self.located.take_rest(model, from, &rest, work)?;
            // Prescribed velocities are means there, and those of their time here.
            self.jump(model, from, work)?;
        }
        Ok(false)
    }

    /// Takes contacts with their modes from the state's memory; whether they are there.
    fn restore(&mut self, model: &Model<2>, from: &State, work: &mut Workspace<2>) -> Result<bool, StepError> {
        self.smooth.contacts.clear();
        let (active, numbers) = (from.memory.active(), from.memory.all_numbers());
        self.h = from.dt;
        work.locate(model, &from.q, active, &mut self.found)?;
        let (h, contacts) = numbers.split_first().map_or((0.0, numbers), |(h, contacts)| (*h, contacts));
        if contacts.len() != REMEMBERED * active.len() || !(h > 0.0 && h.is_finite()) {
            // Those that touch are closed, whatever else they do. The located scheme may have left others
            // pressing above their surface: they fall, and are not pulled down to it.
            let near = self.touching_gap(&from.q);
            let touching = self.found.iter().filter(|candidate| candidate.gap <= near);
            let closed = touching.map(|candidate| Pressing::new(candidate.id, Mode::Stick, 0.0, 0.0));
            self.smooth.contacts.extend(closed);
            return Ok(false);
        }
        let mut known = self.found.len() == active.len();
        for (candidate, held) in self.found.iter().zip(contacts.chunks_exact(REMEMBERED)) {
            known &= held[0] == f64::from(candidate.id.pair()) && held[1] == f64::from(candidate.id.point());
            let friction = model.law(candidate.law)?.friction;
            let (mode, level) = (Mode::of(held[2]), held[3]);
            self.smooth.contacts.push(Pressing::new(candidate.id, mode, level, friction));
        }
        if known {
            self.h = h;
        }
        Ok(known)
    }

    /// Lets prescribed velocities jump to what they are from now on; what hangs on them by mass jumps
    /// too. Whether there was a jump.
    fn jump(&mut self, model: &Model<2>, from: &mut State, work: &mut Workspace<2>) -> Result<bool, StepError> {
        if !model.is_driven() {
            return Ok(false);
        }
        self.v_before.copy_from_slice(&from.v);
        model.drive_at(after(from.t), &mut from.v);
        let fastest = from.v.iter().chain(&self.v_before).fold(0.0_f64, |fastest, v| fastest.max(v.abs()));
        let moved = from.v.iter().zip(&self.v_before).fold(0.0_f64, |moved, (v, old)| moved.max((v - old).abs()));
        if moved <= NO_JUMP * fastest {
            from.v.copy_from_slice(&self.v_before);
            model.drive_at(from.t, &mut from.v);
            return Ok(false);
        }
        for (index, part) in model.parts().iter().enumerate().filter(|(_, part)| part.is_driven()) {
            let (v, old) = (&mut from.v[part.v.clone()], &self.v_before[part.v.clone()]);
            let Some(factor) = work.factors.of(index, MASSES) else { continue };
            let (jumps, pull) = (&mut work.scratch[..v.len()], &mut self.smooth.a[part.v.clone()]);
            jumps.fill(0.0);
            pull.fill(0.0);
            for &k in &part.traits.driven {
                jumps[k] = v[k] - old[k];
            }
            part.system.apply(MASSES, &from.q[part.q.clone()], jumps, pull);
            factor.solve(pull);
            v.iter_mut().zip(pull.iter()).for_each(|(v, dv)| *v -= dv);
        }
        let gained = model.energy_at(&from.q, &from.v).kinetic - model.energy_at(&from.q, &self.v_before).kinetic;
        let energy = StepEnergy { external: gained, ..StepEnergy::default() };
        work.phase(model, &PhaseEnd::new(PhaseKind::Impact, from.t, &from.q, &from.v).with_energy(energy), None)?;
        Ok(true)
    }

    /// The time in which free accelerations make no velocity that counts, s: that of rounding.
    fn instant(&self, from: &State) -> f64 {
        1e3 * f64::EPSILON * (from.t.abs() + self.h)
    }

    /// Ends the smooth phase that was integrated from `from` to time `end` (s), and moves on.
    fn end_phase(
        &mut self,
        model: &Model<2>,
        from: &mut State,
        end: f64,
        duration: f64,
        work: &mut Workspace<2>,
    ) -> Result<(), StepError> {
        let (nq, nv) = (model.size().q, model.size().v);
        let (q, v) = (&self.y[..nq], &self.y[nq..nq + nv]);
        let mut energy = self.smooth.energy(model, &self.y);
        energy.projection = self.projected;
        for (mean, sum) in self.mean.iter_mut().zip(self.smooth.sum_of_places(model, &self.y)) {
            *mean = sum / duration;
        }
        if duration <= f64::MIN_POSITIVE {
            self.mean.copy_from_slice(q);
        }
        let outcome = self.smooth.finish_contacts(model, &self.y, work)?;
        let phase = PhaseEnd::new(PhaseKind::Smooth, end, q, v)
            .lasting(duration)
            .with_all_energy(energy)
            .with_mean(&self.mean)
            .with_outcome(outcome);
        work.phase(model, &phase, Some(&mut self.smooth.stage))?;
        from.q.copy_from_slice(q);
        from.v.copy_from_slice(v);
        from.t = end;
        Ok(())
    }
}

/// In how many steps, one after the other, there were more events than are located.
fn had_too_many(state: &State) -> u32 {
    state.memory.all_numbers().first().map_or(0, |number| if *number < 0.0 { -number as u32 } else { 0 })
}

/// Just after time `t` (s): there loads and drives have the values from now on, whatever rounding of
/// times says.
fn after(t: f64) -> f64 {
    t + 8.0 * f64::EPSILON * t.abs()
}

/// The velocity below which a contact counts as still, m/s: what solvers leave of these speeds (m/s),
/// or what free accelerations (m/s²) make in an `instant` (s).
fn still(speed: f64, acceleration: f64, instant: f64) -> f64 {
    (1e-10 * speed).max(instant * acceleration)
}
