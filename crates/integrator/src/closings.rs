//! Contacts that close: impacts, told from contacts that were lost for a moment and found again
//! (`docs/impacts.md`).

use crate::{Contact, Mismatch, Model, PhaseKind, State, StepReport};
use teeter_detect::{Candidate, ContactId};

/// When a contact counts as truly open: since it last carried, its gap has exceeded `gap` **and**
/// more than `time` has passed. Both are physical and don't depend on the step; [`ClosingMonitor`]
/// adds what the step itself can cause.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Opening {
    /// Least gap, m.
    pub gap: f64,
    /// Least time without an impulse, s.
    pub time: f64,
    /// Acceleration of free fall, m/s².
    pub fall: f64,
}

/// When the contacts of each pair of a model count as truly open.
///
/// ```
/// use teeter_integrator::{Opening, Openings};
///
/// let of_gap = |gap| Opening { gap, ..Opening::default() };
/// // Pair 0 is listed; pairs 1 and up are those of three bodies of groups.
/// let openings = Openings::of_pairs(vec![of_gap(1e-6)]).with_groups(vec![of_gap(2e-6), of_gap(3e-6), of_gap(4e-6)]);
/// assert_eq!(openings.of_pair(0).gap, 1e-6);
/// assert_eq!(openings.of_pair(1 + 3 * 1 + 2).gap, 3e-6, "of the second and the third");
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Openings {
    pairs: Vec<Opening>,
    members: Vec<Opening>,
}

impl Openings {
    /// Those of listed pairs, by their numbers. A pair that is not among them is open with any gap.
    #[must_use]
    pub fn of_pairs(pairs: Vec<Opening>) -> Self {
        Self { pairs, members: Vec::new() }
    }

    /// With those of pairs of groups, whose numbers follow the listed ones
    /// ([`ShapeDetector::with_groups`](teeter_detect::ShapeDetector::with_groups)): for each member
    /// those of the pairs of which it is the first.
    #[must_use]
    pub fn with_groups(mut self, members: Vec<Opening>) -> Self {
        self.members = members;
        self
    }

    /// That of a pair, by its number.
    #[must_use]
    pub fn of_pair(&self, pair: u32) -> Opening {
        let pair = pair as usize;
        let of_members = || self.members.get((pair - self.pairs.len()).checked_div(self.members.len())?);
        self.pairs.get(pair).or_else(of_members).copied().unwrap_or_default()
    }

    /// The largest gap of all, m.
    fn widest(&self) -> f64 {
        self.pairs.iter().chain(&self.members).map(|opening| opening.gap).fold(0.0, f64::max)
    }
}

/// The kind of a contact's closing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closing {
    /// It was truly open and approached.
    Impact,
    /// It was lost for a moment, by the scheme or by chatter too small to count as open, and has
    /// closed again.
    Reclosure,
}

/// A scheme can lose a contact for a step or two: one that carries again within this many steps
/// wasn't open.
const STEPS: f64 = 3.0;

/// A contact that carries, or hasn't been truly open since it last did.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Held {
    id: ContactId,
    /// End of the last step in which it carried, s; the start of the run if it hasn't yet.
    last: f64,
    /// End of the last phase in which it did, s.
    pressed: f64,
    carried: bool,
    /// Whether its gap has been large enough since.
    opened: bool,
    /// Whether it has been, had steps played no part in that.
    lifted: bool,
}

/// Tells impacts from re-closures, step by step.
///
/// A contact *carries* in a step in which it has a normal impulse. It is truly open once, since it
/// last carried, its gap has exceeded both [`Opening::gap`] and the free fall of two steps,
/// 2·`fall`·h², and more than both [`Opening::time`] and three steps have passed. If a truly open
/// contact approaches and then carries, that is an [impact](Closing::Impact). If a contact carries
/// again after at least one step without, but wasn't truly open or doesn't approach, that is a
/// [re-closure](Closing::Reclosure). A contact that starts with a gap of at most [`Opening::gap`]
/// and carries for the first time is neither.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClosingMonitor<const D: usize> {
    /// In order of identity; contacts not listed are truly open.
    held: Vec<Held>,
    impacts: u64,
    reclosures: u64,
    /// Memory of a step.
    #[cfg_attr(feature = "serde", serde(skip))]
    lost: Vec<ContactId>,
    #[cfg_attr(feature = "serde", serde(skip))]
    candidates: Vec<Candidate<D>>,
}

impl<const D: usize> ClosingMonitor<D> {
    /// A monitor that starts at `state`; `openings` are those of the model's pairs.
    ///
    /// # Errors
    /// If the state is not one of the model.
    pub fn new(model: &Model<D>, state: &State, openings: &Openings) -> Result<Self, Mismatch> {
        let mut monitor =
            Self { held: Vec::new(), impacts: 0, reclosures: 0, lost: Vec::new(), candidates: Vec::new() };
        model.candidates(&state.q, openings.widest(), &mut monitor.candidates)?;
        for candidate in &monitor.candidates {
            let carried = state.memory.is_active(candidate.id);
            if carried || candidate.gap <= openings.of_pair(candidate.id.pair()).gap {
                monitor.held.push(Held {
                    id: candidate.id,
                    last: state.t,
                    pressed: state.t,
                    carried,
                    opened: false,
                    lifted: false,
                });
            }
        }
        monitor.held.sort_unstable_by_key(|held| held.id);
        Ok(monitor)
    }

    /// Enters a step with the state at its end, and calls `each` for every contact that closes in
    /// it, with the end of the phase in which it does (s).
    ///
    /// # Errors
    /// If the state is not one of the model.
    pub fn enter(
        &mut self,
        model: &Model<D>,
        step: &StepReport<'_, D>,
        state: &State,
        openings: &Openings,
        mut each: impl FnMut(f64, &Contact<D>, Closing),
    ) -> Result<(), Mismatch> {
        for phase in step.active() {
            for (number, contact) in phase.contacts.iter().enumerate().filter(|(_, contact)| contact.p[0] > 0.0) {
                // Usually it is one that went on pressing, in the place that it had.
                let near = self.held.get(number).is_some_and(|held| held.id == contact.id).then_some(number);
                let found = near.ok_or(()).or_else(|()| self.held.binary_search_by_key(&contact.id, |held| held.id));
                let now = Held {
                    id: contact.id,
                    last: step.t_end,
                    pressed: phase.end,
                    carried: true,
                    opened: false,
                    lifted: false,
                };
                match found {
                    Ok(at) => {
                        let held = std::mem::replace(&mut self.held[at], now);
                        let was_lost = held.carried && held.last < step.t_start;
                        if phase.kind == PhaseKind::Impact && self.strikes(step, &held, phase.end, contact, openings) {
                            self.impacts += 1;
                            each(phase.end, contact, Closing::Impact);
                        } else if was_lost {
                            self.reclosures += 1;
                            each(phase.end, contact, Closing::Reclosure);
                        }
                    }
                    Err(at) => {
                        self.held.insert(at, now);
                        // A contact that closes without approaching is no impact.
                        let approaches = contact.u_before[0] < 0.0;
                        *if approaches { &mut self.impacts } else { &mut self.reclosures } += 1;
                        each(phase.end, contact, if approaches { Closing::Impact } else { Closing::Reclosure });
                    }
                }
            }
        }
        if self.held.iter().all(|held| held.last >= step.t_end) {
            return Ok(());
        }
        self.follow_lost(model, step, state, openings)
    }

    /// Whether a contact that was held strikes at an impact at time `t` (s). Such an impact has a
    /// time of its own and is no work of the step.
    fn strikes(
        &self,
        step: &StepReport<'_, D>,
        held: &Held,
        t: f64,
        contact: &Contact<D>,
        openings: &Openings,
    ) -> bool {
        let opening = openings.of_pair(contact.id.pair());
        // A fall as fast as it comes, where nobody looked at its gap within the step.
        let fell = contact.u_before[0].powi(2) > 2.0 * opening.fall * opening.gap && opening.fall > 0.0;
        let lifted = held.lifted || (fell && held.pressed > step.t_start);
        contact.u_before[0] < 0.0 && lifted && t - held.pressed > opening.time
    }

    /// Looks how far contacts have opened that don't carry any more, and forgets those that are
    /// truly open.
    fn follow_lost(
        &mut self,
        model: &Model<D>,
        step: &StepReport<'_, D>,
        state: &State,
        openings: &Openings,
    ) -> Result<(), Mismatch> {
        let (t, h) = (step.t_end, step.t_end - step.t_start);
        self.lost.clear();
        self.lost.extend(self.held.iter().filter(|held| held.last < t && !held.opened).map(|held| held.id));
        if !self.lost.is_empty() {
            model.detector().locate(&model.placed(&state.q)?, &self.lost, &mut self.candidates);
        }
        let candidates = &self.candidates;
        self.held.retain_mut(|held| {
            if held.last >= t {
                return true;
            }
            let opening = openings.of_pair(held.id.pair());
            if !held.opened {
                let found = candidates.binary_search_by_key(&held.id, |candidate| candidate.id);
                // Beyond the end of the surface there is nothing to touch.
                let gap = found.map_or(f64::INFINITY, |at| candidates[at].gap);
                held.opened = gap > opening.gap.max(2.0 * opening.fall * h * h);
                held.lifted |= gap > opening.gap;
            }
            // Half a step of margin for the rounding of times.
            !(held.opened && t - held.last > opening.time.max((STEPS - 0.5) * h))
        });
        Ok(())
    }

    /// The impacts so far.
    #[must_use]
    pub fn impacts(&self) -> u64 {
        self.impacts
    }

    /// How often a contact was lost for a moment and closed again so far.
    #[must_use]
    pub fn reclosures(&self) -> u64 {
        self.reclosures
    }
}
