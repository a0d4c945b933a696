//! When the first of the events that are watched happens.

use super::EventDriven;
use crate::gap_cubic::GapCubic;
use crate::moreau_jean_located::rate_at;
use crate::{Model, StepError, Workspace};
use teeter_detect::ContactId;

/// What can happen to a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// It closes.
    Closes,
    /// Its force is gone.
    Opens,
    /// Its surface ends.
    Leaves,
    /// Its friction is at the limit.
    Slips,
    /// Its slide is at rest.
    Stops,
}

/// A gap above its level at a time of the step, and its rate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    /// s.
    pub(super) tau: f64,
    /// m.
    pub(super) value: f64,
    /// m/s.
    pub(super) rate: f64,
}

/// A quantity that is positive up to an event.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch {
    pub(super) kind: Kind,
    pub(super) id: ContactId,
    /// At the start of the step, at its end, and at the time that is looked at.
    start: f64,
    end: f64,
    now: f64,
    /// Where a gap is known best before it is 0, and after.
    between: [Known; 2],
    /// The gap at which a contact closes, m.
    pub(super) level: f64,
    /// Up to here it is 0.
    tolerance: f64,
    /// To which side friction holds the contact.
    pub(super) side: f64,
    /// Whether it happens where the phase ended.
    pub(super) is_now: bool,
}

/// Trials at an event: three do for a contact that closes, six to ten for others.
const TRIALS: usize = 80;

/// Halvings of a step in search of its start's sign.
const HALVINGS: usize = 40;

/// Halvings that find the zero of a cubic to rounding.
const CUBIC_HALVINGS: usize = 60;

impl EventDriven {
    /// Takes what is watched at the end of the step of `tau` (s) from `t` that was tried last: the least in parts of what it was
    /// at the end of the whole step, and whether all of it is 0 or more.
    fn look(&mut self, model: &Model<2>, t: f64, tau: f64, work: &mut Workspace<2>) -> Result<(f64, bool), StepError> {
        let (nq, nv) = (model.size().q, model.size().v);
        let (q, v) = self.rk.end[..nq + nv].split_at(nq);
        if self.watched.iter().any(|watch| watch.kind == Kind::Closes) {
            self.ids.clear();
            self.ids.extend(self.watched.iter().filter(|watch| watch.kind == Kind::Closes).map(|watch| watch.id));
            work.locate(model, q, &self.ids, &mut self.found)?;
        }
        if self.watched.iter().any(|watch| watch.kind != Kind::Closes) {
            self.smooth.accelerate(model, t + tau, q, v, work)?;
        }
        let (mut least, mut clear) = (f64::INFINITY, true);
        for watch in &mut self.watched {
            let contact = self.smooth.contacts.iter().find(|contact| contact.id == watch.id);
            watch.now = match (watch.kind, contact) {
                (Kind::Closes, _) => match self.found.binary_search_by_key(&watch.id, |candidate| candidate.id) {
                    Ok(at) => {
                        let value = self.found[at].gap - watch.level;
                        if watch.has_cubic() {
                            let rate = rate_at(&mut self.smooth.one, model, q, &self.found[at], v)?;
                            watch.learn(Known { tau, value, rate });
                        }
                        value
                    }
                    Err(_) => f64::INFINITY,
                },
                (_, None) => f64::INFINITY,
                (Kind::Leaves, Some(contact)) => {
                    if contact.row.is_some() {
                        contact.room.min(1.0)
                    } else {
                        -1.0
                    }
                }
                (Kind::Opens, Some(contact)) => contact.presses(),
                (Kind::Slips, Some(contact)) => contact.held,
                (Kind::Stops, Some(contact)) => contact.slides(),
            };
            watch.side = contact.map_or(0.0, |contact| contact.force[1].signum());
            least = least.min(watch.now / watch.end.abs());
            clear &= watch.now >= -watch.tolerance;
        }
        Ok((least, clear))
    }

    /// Finds the time from `t` (s) at which the first of what is watched is 0, within a step of `h` (s), and
    /// leaves the step up to there; returns that time, s.
    pub(super) fn locate_event(
        &mut self,
        model: &Model<2>,
        t: f64,
        h: f64,
        work: &mut Workspace<2>,
    ) -> Result<Option<f64>, StepError> {
        let (mut low, mut high) = (0.0, h);
        let mut at_low = self.watched.iter().map(|watch| watch.start / watch.end.abs()).fold(f64::INFINITY, f64::min);
        let mut at_high = -1.0;
        if self.watched.iter().any(|watch| watch.start <= watch.tolerance) {
            // What is 0 at the start may become positive first.
            let mut tau = h;
            let mut found = false;
            for _ in 0..HALVINGS {
                tau *= 0.5;
                self.try_step(model, t, tau, work)?;
                work.counts.refused_attempts += 1;
                let (value, clear) = self.look(model, t, tau, work)?;
                if clear {
                    (low, at_low, found) = (tau, value.max(f64::MIN_POSITIVE), true);
                    break;
                }
                (high, at_high) = (tau, value);
            }
            if !found {
                for watch in &mut self.watched {
                    watch.is_now = watch.start <= watch.tolerance;
                }
                return Ok(Some(0.0));
            }
        }
        let mut tau = h;
        let mut same = 0;
        for trial in 0..TRIALS {
            let width = high - low;
            let narrow = width <= 2.0 * f64::EPSILON * t.abs().max(h);
            let guess = if self.watched.iter().all(Watch::has_cubic) {
                self.watched.iter().map(Watch::cubic_zero).fold(f64::INFINITY, f64::min)
            } else {
                (low * at_high - high * at_low) / (at_high - at_low)
            };
            let inside = guess > low && guess < high;
            tau = if narrow {
                high
            } else if inside && trial % 8 != 7 {
                guess
            } else {
                0.5 * (low + high)
            };
            self.try_step(model, t, tau, work)?;
            work.counts.refused_attempts += 1;
            let (value, clear) = self.look(model, t, tau, work)?;
            let is_zero = self.watched.iter().any(|watch| watch.now.abs() <= watch.tolerance);
            if narrow || (clear && is_zero) {
                break;
            }
            // Illinois: the end that stays twice counts for half.
            if value > 0.0 || clear {
                (low, at_low) = (tau, value.max(f64::MIN_POSITIVE));
                if same == 1 {
                    at_high *= 0.5;
                }
                same = 1;
            } else {
                (high, at_high) = (tau, value);
                if same == -1 {
                    at_low *= 0.5;
                }
                same = -1;
            }
        }
        let mut any = false;
        for watch in &mut self.watched {
            watch.is_now = watch.now <= watch.tolerance;
            any |= watch.is_now;
        }
        // Where a surface that doesn't go on past its end has left a contact without rows, the phase ends before.
        let has_left = |watch: &Watch| watch.is_now && watch.kind == Kind::Leaves && watch.now == -1.0;
        if low > 0.0 && self.watched.iter().any(has_left) {
            tau = low;
            self.try_step(model, t, tau, work)?;
        }
        Ok(any.then_some(tau))
    }
}

impl Watch {
    pub(super) fn new(kind: Kind, id: ContactId, start: f64, end: f64, tolerance: f64) -> Self {
        let unknown = Known { tau: f64::NAN, value: f64::NAN, rate: f64::NAN };
        Self { kind, id, start, end, now: end, between: [unknown; 2], level: 0.0, tolerance, side: 0.0, is_now: false }
    }

    /// A contact that closes between two times at which its gap and rate are known.
    pub(super) fn closing(id: ContactId, level: f64, between: [Known; 2], tolerance: f64) -> Self {
        let [start, end] = between;
        Self { between, level, ..Self::new(Kind::Closes, id, start.value, end.value, tolerance) }
    }

    /// Whether it is a contact that had no gap at the start of the step.
    pub(super) fn comes_from_beside(&self) -> bool {
        self.kind == Kind::Closes && self.start == f64::INFINITY
    }

    /// Whether its gap, above 0 at the start, is known there with its rate: then the cubic through what
    /// is known finds the zero in fewer trials.
    fn has_cubic(&self) -> bool {
        let [start, end] = &self.between;
        self.kind == Kind::Closes && self.start > self.tolerance && start.rate.is_finite() && end.rate.is_finite()
    }

    /// The time at which the cubic with the known gaps and rates is 0, s.
    pub(super) fn cubic_zero(&self) -> f64 {
        let [a, b] = self.between;
        let h = b.tau - a.tau;
        a.tau + h * GapCubic::new([a.value, b.value], [a.rate, b.rate], h).zero(CUBIC_HALVINGS)
    }

    fn learn(&mut self, known: Known) {
        self.between[usize::from(known.value < 0.0)] = known;
    }
}
