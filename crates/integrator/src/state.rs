//! All that decides the next step, in one flat struct: clone it to reject a step, store it for a
//! checkpoint.

use crate::clock::Clock;
use crate::{Ledger, Memory, Model, Vector};
use teeter_contact::Outcome;
use teeter_detect::{Candidate, ContactId};

/// The impulses of the last step's contacts, in order of identity, from which the contact solver
/// starts. It is a hint: without it a step ends in the same motion, up to the solver's tolerance.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WarmStart {
    ids: Vec<ContactId>,
    /// D numbers a contact.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored::list"))]
    impulses: Vec<f64>,
}

impl WarmStart {
    /// Makes room for so many contacts in D dimensions.
    pub fn reserve(&mut self, contacts: usize, dimension: usize) {
        self.ids.reserve(contacts);
        self.impulses.reserve(contacts * dimension);
    }

    /// Forgets all contacts.
    pub fn clear(&mut self) {
        self.ids.clear();
        self.impulses.clear();
    }

    /// Adds a contact with its impulse, N·s. Contacts have to come in order of identity.
    pub fn push<const D: usize>(&mut self, id: ContactId, p: &Vector<D>) {
        self.ids.push(id);
        self.impulses.extend_from_slice(p.as_slice());
    }

    /// Becomes equal to `other`; allocates only if `other` holds more than this ever has.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { ids, impulses } = other;
        self.ids.clone_from(ids);
        self.impulses.clone_from(impulses);
    }

    /// The contacts of the last step.
    #[must_use]
    pub fn ids(&self) -> &[ContactId] {
        &self.ids
    }

    /// The impulse of a contact in the last step, N·s; `None` if it was not active.
    #[must_use]
    pub fn impulse<const D: usize>(&self, id: ContactId) -> Option<Vector<D>> {
        self.impulse_at(self.ids.binary_search(&id).ok()?)
    }

    /// The same for a contact that likely has this number.
    #[inline]
    pub(crate) fn impulse_near<const D: usize>(&self, id: ContactId, number: usize) -> Option<Vector<D>> {
        if self.ids.get(number) == Some(&id) { self.impulse_at(number) } else { self.impulse(id) }
    }

    #[inline]
    fn impulse_at<const D: usize>(&self, number: usize) -> Option<Vector<D>> {
        self.impulses.get(number * D..(number + 1) * D).map(Vector::<D>::from_column_slice)
    }
}

/// Counts and extremes over the steps so far.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tally {
    /// Deepest penetration of a contact's point at the end of a step, m; 0 if there was none.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub max_penetration: f64,
    /// Largest global residual of a contact problem.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub max_residual: f64,
    /// Largest residual of a single contact.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub max_contact_residual: f64,
    /// Most iterations of a contact solve.
    pub max_iterations: u32,
    /// Most active contacts.
    pub max_contacts: usize,
    /// Steps with a contact problem.
    pub contact_steps: u64,
    /// Steps whose contact problem was not solved to tolerance.
    pub unconverged_steps: u64,
    /// Steps in which the scheme didn't locate all impacts and ends of slides, or events, counted by the scheme.
    pub unlocated_steps: u64,
}

/// The state of a run.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct State {
    /// Steps taken.
    pub step: u64,
    /// Time, s: `step · dt` as long as dt doesn't change; after a change, steps are counted in the
    /// same way from there.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub t: f64,
    /// Step size, s; may be changed between steps.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored"))]
    pub dt: f64,
    /// Coordinates of all subsystems.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored::list"))]
    pub q: Vec<f64>,
    /// Velocities of all subsystems.
    #[cfg_attr(feature = "serde", serde(with = "crate::stored::list"))]
    pub v: Vec<f64>,
    /// What a scheme remembers from step to step.
    pub memory: Memory,
    /// The impulses from which the contact solver starts.
    pub warm: WarmStart,
    /// The energy account.
    pub ledger: Ledger,
    /// Counts and extremes.
    pub tally: Tally,
    /// How time is counted.
    clock: Clock,
}

/// What is wrong with a state.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StateError {
    /// Too few or too many numbers.
    #[error("{found} numbers given for {what}, but the model needs {expected}")]
    Length {
        /// Coordinates or velocities.
        what: &'static str,
        /// Numbers given.
        found: usize,
        /// Numbers needed.
        expected: usize,
    },
    /// A number that is not finite.
    #[error("{what} number {index} is {value}, but must be finite")]
    NotFinite {
        /// Coordinates or velocities.
        what: &'static str,
        /// Which.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A step size that is not positive and finite.
    #[error("the step size is {0} s, but must be positive and finite")]
    StepSize(f64),
    /// A time that is not finite, or more steps than can be counted.
    #[error("the state is {} s after {step} steps: there is no step after that", crate::scheme::few_digits(*t))]
    Time {
        /// Steps taken.
        step: u64,
        /// Time, s.
        t: f64,
    },
    /// The contacts of the last step have too few or too many numbers for the model's dimension.
    #[error(
        "the state has {impulses} numbers for the impulses of its {contacts} contacts, but needs {dimension} for each"
    )]
    Contacts {
        /// How many there are.
        contacts: usize,
        /// Numbers of their impulses.
        impulses: usize,
        /// Numbers that a contact has.
        dimension: usize,
    },
    /// The contacts of the last step aren't in order of identity.
    #[error("the state's contacts of the last step don't rise in number, or some lack what is to be known of them")]
    ContactOrder,
}

impl Tally {
    /// Counts a step: how the contact problems of its phases were solved, its number of contacts,
    /// the penetration (m) at its end.
    #[inline(always)]
    pub fn count<'a>(&mut self, outcomes: impl Iterator<Item = &'a Outcome>, contacts: usize, penetration: f64) {
        self.max_penetration = self.max_penetration.max(penetration);
        self.max_contacts = self.max_contacts.max(contacts);
        let (mut any, mut solved) = (false, true);
        for outcome in outcomes {
            any = true;
            solved &= outcome.converged();
            self.max_residual = self.max_residual.max(outcome.residual.global);
            self.max_contact_residual = self.max_contact_residual.max(outcome.residual.worst);
            self.max_iterations = self.max_iterations.max(outcome.iterations);
        }
        self.contact_steps += u64::from(any);
        self.unconverged_steps += u64::from(!solved);
    }
}

/// A step that ends within this fraction of its size of a given time counts as ending at that time.
pub const STEP_ROUNDING: f64 = 1e-9;

/// Start, end and size of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepSpan {
    /// Its start, s.
    pub start: f64,
    /// Its end, s.
    pub end: f64,
    /// Its size, s, by which matrices are made: `end − start` without the rounding of times.
    pub h: f64,
}

/// A prescribed velocity at the start is taken as it is unless it exceeds its mean over the first
/// half step by this factor: a motion that the step resolves doesn't change as much in half a step.
const OVERSHOOT: f64 = 1.25;

impl State {
    /// The state at t = 0, with step size `dt` (s). Prescribed velocities are those of t = 0,
    /// whatever `v` says.
    ///
    /// # Errors
    /// If a length doesn't fit the model, a number is not finite, or `dt` is not positive.
    pub fn new<const D: usize>(model: &Model<D>, q: &[f64], v: &[f64], dt: f64) -> Result<Self, StateError> {
        Self::at(model, 0, q, v, dt)
    }

    /// The state after `step` steps of size `dt` (s), at t = step · dt, without the history of a
    /// run: its energy account and its counts begin here, no contact was active, and the scheme's
    /// memory is empty. Prescribed velocities are those of that time, whatever `v` says.
    ///
    /// # Errors
    /// As [`State::new`].
    pub fn at<const D: usize>(model: &Model<D>, step: u64, q: &[f64], v: &[f64], dt: f64) -> Result<Self, StateError> {
        let check = |what, x: &[f64], expected| {
            if x.len() != expected {
                return Err(StateError::Length { what, found: x.len(), expected });
            }
            match x.iter().position(|x| !x.is_finite()) {
                Some(index) => Err(StateError::NotFinite { what, index, value: x[index] }),
                None => Ok(()),
            }
        };
        check("the coordinates", q, model.size().q)?;
        check("the velocities", v, model.size().v)?;
        // Written so that NaN fails too.
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(StateError::StepSize(dt));
        }
        let mut v = v.to_vec();
        let t = Clock::new(dt).at(step);
        let mut means = v.clone();
        model.drive_at(t, &mut v);
        // A velocity that lasts for less than half a step would carry the first step past the
        // prescribed position (`docs/signals.md`).
        model.drive_mean_at([t, t + 0.5 * dt], &mut means);
        for (v, mean) in v.iter_mut().zip(means) {
            if v.abs() > OVERSHOOT * mean.abs() {
                *v = mean;
            }
        }
        Ok(Self {
            step,
            t,
            dt,
            q: q.to_vec(),
            memory: Memory::default(),
            warm: WarmStart::default(),
            ledger: Ledger::new(model.energy_at(q, &v), model.energy_scale()),
            v,
            tally: Tally::default(),
            clock: Clock::new(dt),
        })
    }

    /// Takes over which contacts were active, what their springs hold, and where the contact solver
    /// starts. What springs hold counts as energy of the start.
    pub fn take_contacts<const D: usize>(&mut self, model: &Model<D>, memory: &Memory, warm: &WarmStart) {
        self.memory.copy_from(memory);
        self.warm.copy_from(warm);
        let mut candidates = Vec::new();
        if model.has_springs() && self.q.len() == model.size().q {
            model.detector().locate(&model.placed_at(&self.q), memory.active(), &mut candidates);
        }
        let stored =
            |candidate: &Candidate<D>| Some(model.spring(candidate.law)?.potential(memory.spring_gap(candidate.id)?));
        let stored: f64 = candidates.iter().filter_map(stored).sum();
        self.ledger.take_stored(stored);
    }

    /// Takes prescribed velocities as a step of a θ scheme that ended here has left them: as means
    /// about this time (`docs/signals.md`). A run that goes on from a step's end then moves as that
    /// step's run does.
    ///
    /// # Errors
    /// If there are too few or too many velocities.
    pub fn drive_about<const D: usize>(&mut self, model: &Model<D>, theta: f64) -> Result<(), StateError> {
        let (found, expected) = (self.v.len(), model.size().v);
        if found != expected {
            return Err(StateError::Length { what: "the velocities", found, expected });
        }
        let Self { t, dt, .. } = *self;
        model.drive_mean_at([t - theta * dt, t + (1.0 - theta) * dt], &mut self.v);
        Ok(())
    }

    /// Whether steps of this model can start from it: it has as many numbers as the model needs,
    /// there is a next time, and its contacts are in order. (Numbers that are not finite show at
    /// the end of a step.)
    ///
    /// # Errors
    /// If not.
    #[inline]
    pub fn check<const D: usize>(&self, model: &Model<D>) -> Result<(), StateError> {
        let Self { step, t, dt, q, v, warm, memory, .. } = self;
        let (size, contacts) = (model.size(), warm.ids.len());
        let lengths = q.len() == size.q && v.len() == size.v;
        let time = *dt > 0.0 && *dt + t.abs() < f64::INFINITY && *step < u64::MAX;
        let ordered = warm.ids.is_sorted_by(|a, b| a < b) && memory.is_in_order();
        if lengths && time && ordered && warm.impulses.len() == contacts * D {
            return Ok(());
        }
        Err(self.what_is_wrong(model))
    }

    #[cold]
    fn what_is_wrong<const D: usize>(&self, model: &Model<D>) -> StateError {
        let Self { step, t, dt, q, v, warm, .. } = self;
        for (what, found, expected) in
            [("the coordinates", q.len(), model.size().q), ("the velocities", v.len(), model.size().v)]
        {
            if found != expected {
                return StateError::Length { what, found, expected };
            }
        }
        // Written so that NaN is wrong too.
        if !(*dt > 0.0 && dt.is_finite()) {
            return StateError::StepSize(*dt);
        }
        if *step == u64::MAX || !(*dt + t.abs() < f64::INFINITY) {
            return StateError::Time { step: *step, t: *t };
        }
        let (contacts, impulses) = (warm.ids.len(), warm.impulses.len());
        if impulses != contacts * D {
            return StateError::Contacts { contacts, impulses, dimension: D };
        }
        StateError::ContactOrder
    }

    /// The step that begins now: of size `dt`, but never past `until` (s; infinity for no end). A
    /// step that would end within [`STEP_ROUNDING`] times its size of `until` keeps its full size,
    /// so that times which are multiples of the step up to rounding take whole steps.
    #[must_use]
    pub fn next_step(&self, until: f64) -> StepSpan {
        self.step_of(self.dt, until)
    }

    /// As [`State::next_step`], for a step of size `h` (s) in place of `dt`.
    #[must_use]
    pub fn step_of(&self, h: f64, until: f64) -> StepSpan {
        let end = self.clock.going_on(self.step, self.t, h).at(self.step.saturating_add(1));
        // Written so that NaN is no end.
        if !(end - until > STEP_ROUNDING * h) {
            return StepSpan { start: self.t, end, h };
        }
        StepSpan { start: self.t, end: until, h: until - self.t }
    }

    /// Whether time `t` (s) is reached, up to the rounding that [`State::next_step`] allows for.
    #[must_use]
    pub fn has_reached(&self, t: f64) -> bool {
        // Written so that NaN is reached: it is no time to go to.
        !(t - self.t > STEP_ROUNDING * self.dt)
    }

    /// Moves time and the number of steps to the end of a step.
    pub(crate) fn count_step(&mut self, span: &StepSpan) {
        self.clock = self.clock.going_on(self.step, self.t, span.h);
        self.step = self.step.saturating_add(1);
        // By the clock, or where the step was cut short.
        self.t = span.end;
    }

    /// Becomes equal to `other`; allocates only if `other` holds more than this ever has.
    pub fn copy_from(&mut self, other: &Self) {
        self.copy_motion(other);
        self.ledger.clone_from(&other.ledger);
        self.tally.clone_from(&other.tally);
    }

    /// Becomes equal to `other` but for the account of energies and the counts of steps.
    pub(crate) fn copy_motion(&mut self, other: &Self) {
        let Self { step, t, dt, q, v, memory, warm, ledger: _, tally: _, clock } = other;
        (self.step, self.t, self.dt, self.clock) = (*step, *t, *dt, *clock);
        for (mine, other) in [(&mut self.q, q), (&mut self.v, v)] {
            mine.clone_from(other);
        }
        self.memory.copy_from(memory);
        self.warm.copy_from(warm);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_warm_start_knows_who_was_active() {
        let mut warm = WarmStart::default();
        warm.push(ContactId::new(0, 1), &Vector::<2>::new(1.0, 2.0));
        warm.push(ContactId::new(0, 3), &Vector::<2>::new(3.0, 4.0));
        assert_eq!(warm.impulse::<2>(ContactId::new(0, 3)), Some(Vector::<2>::new(3.0, 4.0)));
        assert_eq!(warm.impulse::<2>(ContactId::new(0, 2)), None);
    }
}
