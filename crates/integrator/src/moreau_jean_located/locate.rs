//! When the first open contact of a step touches.

use super::MoreauJeanLocated;
use crate::closed_step::{SINKING, find, leaves};
use crate::{ContactStage, Memory, Mismatch, Model, State, StepError, StepSpan, WarmStart, Workspace};
use teeter_contact::Outcome;
use teeter_detect::{Candidate, ContactId};

/// An open contact that the step would end inside of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    pub(super) id: ContactId,
    /// The gap at which it touches: 0, or less where it began in the surface, m.
    level: f64,
    /// Its gap above that level at the start, m: not below 0.
    above: f64,
    /// Its normal velocity there, m/s.
    rate: f64,
    /// Its gap above that level at the end of the attempt, m.
    end: f64,
    /// Its normal velocity there, m/s.
    end_rate: f64,
}

impl Hit {
    /// The first time (s) at which the cubic with these values and rates at both ends of a step of
    /// `h` is 0.
    fn touches(&self, h: f64) -> f64 {
        let Self { above: a, rate, end: b, end_rate, .. } = *self;
        if a == f64::INFINITY {
            return 0.5 * h;
        }
        let (da, db) = (h * rate, h * end_rate);
        let value = |s: f64| {
            let r = 1.0 - s;
            (1.0 + 2.0 * s) * r * r * a + s * s * (3.0 - 2.0 * s) * b + s * r * r * da - s * s * r * db
        };
        let (mut low, mut high) = (0.0, 1.0);
        // It is a first guess.
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            *(if value(middle) > 0.0 { &mut low } else { &mut high }) = middle;
        }
        h * 0.5 * (low + high)
    }
}

/// A gap is known to so much of the largest coordinate.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// What a gap is known to at these coordinates, m.
fn rounding(q: &[f64]) -> f64 {
    ROUNDING * q.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()))
}

/// Whether a part of a step is long enough (s) to move time on from its `start`: times are known no better.
pub(super) fn is_time(tau: f64, start: f64) -> bool {
    tau > 4.0 * f64::EPSILON * start.abs()
}

/// Attempts at locating an impact: two or three do, where no other contact opens or closes on the
/// way.
const ATTEMPTS: usize = 40;

/// A contact touches at the start where its gap is at most so many tolerances above its level.
const AT_START: f64 = 2.0;

impl<const D: usize> MoreauJeanLocated<D> {
    /// What a gap is located to at these coordinates, m.
    pub(crate) fn tolerance(&self, q: &[f64]) -> f64 {
        self.settings.gap_tolerance.max(rounding(q))
    }

    /// Attempts the step; if open contacts would end in their surface, only up to where the first
    /// of them touches. Returns that time beside the outcome of the attempt, which is left in the
    /// step. Contacts that are inside only on the way aren't seen.
    pub(super) fn locate_by_end(
        &mut self,
        model: &Model<D>,
        from: &State,
        rest: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<(Option<Outcome>, Option<f64>), StepError> {
        let tolerance = self.tolerance(&from.q);
        loop {
            let outcome = self.step.attempt(model, from, rest, work)?;
            self.step.find_new(model, tolerance, work)?;
            if model.has_springs() && self.close_springs_within(model, from, tolerance, work)? {
                work.counts.refused_attempts += 1;
                continue;
            }
            self.hits.clear();
            self.find_hits(model, from, tolerance, 0.0, work)?;
            if self.hits.is_empty() {
                return Ok((outcome, None));
            }
            work.counts.refused_attempts += 1;
            let closed = self.step.closed.len();
            for k in 0..self.hits.len() {
                let Hit { id, above, .. } = self.hits[k];
                let lately = self.pressed_lately(id);
                if above > AT_START * tolerance && !lately {
                    continue;
                }
                if !lately && self.strikes_at_start(model, from, id, work)? {
                    return Ok((outcome, Some(0.0)));
                }
                // It chatters; or a flight shorter than the step, or a spring that is pressed from
                // now on.
                if let Err(at) = self.step.closed.binary_search(&id) {
                    self.step.closed.insert(at, id);
                }
            }
            if self.step.closed.len() == closed {
                return self.close_in(model, from, rest, tolerance, work);
            }
        }
    }

    /// Closes those of the attempt's new contacts that have springs and are inside at its start, too: they may go on for others, whichever way
    /// they move. Whether there are any.
    fn close_springs_within(
        &mut self,
        model: &Model<D>,
        from: &State,
        tolerance: f64,
        work: &mut Workspace<D>,
    ) -> Result<bool, Mismatch> {
        let closed = self.step.closed.len();
        for k in 0..self.step.new.len() {
            let id = self.step.new[k];
            let has_spring = find(&work.candidates, id).is_some_and(|deep| model.spring(deep.law).is_some());
            let Some(at) = self.step.closed.binary_search(&id).err().filter(|_| has_spring) else { continue };
            work.locate(model, &from.q, &[id], &mut self.near)?;
            if self.near.first().is_some_and(|start| start.gap < -tolerance) {
                self.step.closed.insert(at, id);
            }
        }
        Ok(self.step.closed.len() > closed)
    }

    /// Finds the time at which the first of the hits touches: Newton's method on the gap at the end
    /// of a step up to there, kept between a time at which all are clear and one at which some are
    /// inside.
    fn close_in(
        &mut self,
        model: &Model<D>,
        from: &State,
        rest: &StepSpan,
        tolerance: f64,
        work: &mut Workspace<D>,
    ) -> Result<(Option<Outcome>, Option<f64>), StepError> {
        let (mut clear, mut inside) = (0.0, rest.h);
        let mut tau = self.hits.iter().map(|hit| hit.touches(rest.h)).fold(rest.h, f64::min);
        let mut outcome = None;
        for attempt in 1..=ATTEMPTS {
            if !is_time(tau, rest.start) {
                break;
            }
            let part = StepSpan { start: rest.start, end: rest.start + tau, h: tau };
            self.step.free_velocity(model, from, &part, work)?;
            outcome = self.step.attempt(model, from, &part, work)?;
            self.step.find_new(model, tolerance, work)?;
            work.counts.refused_attempts += 1;
            self.find_hits(model, from, tolerance, AT_START * tolerance, work)?;
            let first = self.first(model, work)?;
            let narrow = inside - clear <= f64::EPSILON * rest.h || attempt == ATTEMPTS;
            if first.end.abs() <= tolerance || (first.end > 0.0 && narrow) {
                return Ok((outcome, Some(tau)));
            }
            *(if first.end > 0.0 { &mut clear } else { &mut inside }) = tau;
            let by_rate = tau - first.end / first.end_rate;
            let between = by_rate > clear && by_rate < inside && attempt % 5 != 0;
            tau = if between { by_rate } else { 0.5 * (clear + inside) };
            if attempt + 1 == ATTEMPTS {
                // The gap jumps, as another contact closes or opens on the way: before the jump.
                tau = clear;
            }
        }
        Ok((outcome, Some(0.0)))
    }

    /// Adds those of the attempt's new contacts that are deeper than they began to the hits; only
    /// those that began at least so far above.
    fn find_hits(
        &mut self,
        model: &Model<D>,
        from: &State,
        tolerance: f64,
        least: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        for k in 0..self.step.new.len() {
            let id = self.step.new[k];
            let known = self.hits.iter().any(|hit| hit.id == id);
            if known || (least > 0.0 && self.pressed_lately(id)) {
                continue;
            }
            let Some(&candidate) = find(&work.candidates, id) else { continue };
            if model.spring(candidate.law).is_some() {
                // Inside beyond the end of its surface already, it goes on for another one from there on.
                work.locate_past_ends(model, &from.q, &[id], &mut self.near, &mut self.rooms)?;
                if self.near.first().is_some_and(|start| start.gap < -tolerance) {
                    continue;
                }
            }
            work.locate(model, &from.q, &[id], &mut self.near)?;
            // A whole tolerance in each of many short steps would let it sink by any depth.
            let sinking = (SINKING * tolerance).max(rounding(&from.q));
            let Self { hits, near, one, step, .. } = self;
            // One that comes from beyond the end of its surface has no gap there.
            let start = near.first();
            let gap = start.map_or(f64::INFINITY, |start| start.gap);
            let level = gap.min(0.0);
            if candidate.gap < level - sinking && gap - level >= least {
                let rate = start.map_or(Ok(0.0), |start| rate_at(one, model, &from.q, start, &from.v))?;
                let end_rate = rate_at(one, model, &step.step.q_at, &candidate, &step.step.v_end)?;
                hits.push(Hit { id, level, above: gap - level, rate, end: candidate.gap - level, end_rate });
            }
        }
        Ok(())
    }

    /// The hit that is lowest at the end of the attempt, with its gap and rate there.
    fn first(&mut self, model: &Model<D>, work: &mut Workspace<D>) -> Result<Hit, Mismatch> {
        let Self { hits, ids, near, one, step, .. } = self;
        ids.clear();
        ids.extend(hits.iter().map(|hit| hit.id));
        ids.sort_unstable();
        let q = &step.step.q_at;
        work.locate(model, q, ids, near)?;
        let mut first = (f64::INFINITY, 0, None);
        for (number, hit) in hits.iter().enumerate() {
            let Ok(at) = near.binary_search_by_key(&hit.id, |candidate| candidate.id) else { continue };
            let end = near[at].gap - hit.level;
            if end < first.0 {
                first = (end, number, Some(&near[at]));
            }
        }
        let (end, number, candidate) = first;
        // Without a surface below it there is no rate, and no hurry.
        let end_rate = candidate.map_or(Ok(-1.0), |candidate| rate_at(one, model, q, candidate, &step.step.v_end))?;
        Ok(Hit { end, end_rate, ..hits[number] })
    }

    /// Whether an open contact that touches at the start strikes there: it approaches, and has no
    /// duration.
    fn strikes_at_start(
        &mut self,
        model: &Model<D>,
        from: &State,
        id: ContactId,
        work: &mut Workspace<D>,
    ) -> Result<bool, Mismatch> {
        work.locate(model, &from.q, &[id], &mut self.near)?;
        let Some(candidate) = self.near.first() else { return Ok(false) };
        if model.spring(candidate.law).is_some() {
            return Ok(false);
        }
        let rate = rate_at(&mut self.one, model, &from.q, candidate, &from.v)?;
        Ok(leaves(-rate, || self.one.speed(0, &from.v)))
    }
}

/// The normal velocity of a candidate at coordinates `q`, m/s; its rows are left in `one`.
pub(crate) fn rate_at<const D: usize>(
    one: &mut ContactStage<D>,
    model: &Model<D>,
    q: &[f64],
    candidate: &Candidate<D>,
    v: &[f64],
) -> Result<f64, Mismatch> {
    one.clear();
    let moves = one.add(model, q, candidate, &WarmStart::default(), &Memory::default())?;
    if moves { Ok(one.velocity(0, v)?[0]) } else { Ok(0.0) }
}
