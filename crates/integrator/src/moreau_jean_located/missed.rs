//! Open contacts that touch within a step without being in their surface at its end: a corner that strikes
//! just before it is past the edge of a table, or one that dips in as its block turns.

use super::MoreauJeanLocated;
use super::locate::rate_at;
use crate::closed_step::find;
use crate::gap_cubic::GapCubic;
use crate::{Mismatch, Model, State, StepError, StepSpan, Workspace};
use teeter_contact::Outcome;
use teeter_detect::{BodyId, Candidate, ContactId};

/// Searches for a touch before the one that was found: one or two do, where corners follow each other.
const MOST_EARLIER: usize = 8;

/// A contact that goes into its surface and past the end of it is looked at this part of the rest after its touch; if
/// it isn't inside there, closer to its touch, so many times.
const SOON_AFTER: f64 = 0.05;
const CLOSER: usize = 4;

/// Halvings that find a touch: it is a first guess.
const HALVINGS: usize = 30;

impl<const D: usize> MoreauJeanLocated<D> {
    /// Attempts the step; if open contacts touch within it, only up to where the first of them does. Returns that time
    /// beside the outcome of the attempt, which is left in the step.
    pub(super) fn locate(
        &mut self,
        model: &Model<D>,
        from: &State,
        rest: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<(Option<Outcome>, Option<f64>), StepError> {
        let mut part = *rest;
        for _ in 0..MOST_EARLIER {
            let (outcome, found) = self.locate_by_end(model, from, &part, work)?;
            let h = found.unwrap_or(part.h);
            let missed = if h > 0.0 { self.find_missed(model, from, h, work)? } else { None };
            let Some(shorter) = missed else {
                if found.is_none() && part.h < rest.h {
                    // Nothing touches in the shorter step: the guess was wrong.
                    break;
                }
                return Ok((outcome, found));
            };
            work.counts.refused_attempts += 1;
            part = StepSpan { start: rest.start, end: rest.start + shorter, h: shorter };
            self.step.free_velocity(model, from, &part, work)?;
        }
        self.step.free_velocity(model, from, rest, work)?;
        self.locate_by_end(model, from, rest, work)
    }

    /// A time within the attempt of `h` (s) at which an open contact is inside its surface that isn't so at the end;
    /// the first of those that are found.
    fn find_missed(
        &mut self,
        model: &Model<D>,
        from: &State,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<Option<f64>, StepError> {
        if !(model.has_contacts() && self.has_rigid_pairs) {
            return Ok(None);
        }
        let fastest = self.fastest(model, &from.v).max(self.fastest(model, &self.step.step.v_end));
        if fastest == 0.0 {
            return Ok(None);
        }
        let tolerance = self.tolerance(&from.q);
        // Two bodies may approach each other.
        let margin = 2.0 * h * fastest;
        std::mem::swap(&mut work.candidates, &mut self.step.start);
        let detected = work.detect(model, &from.q, margin);
        std::mem::swap(&mut work.candidates, &mut self.step.start);
        detected?;
        self.ids.clear();
        for k in 0..self.step.start.len() {
            let candidate = self.step.start[k];
            let is_open = candidate.gap >= -tolerance && self.step.closed.binary_search(&candidate.id).is_err();
            if is_open && !self.is_with_elastic(model, &candidate.sides.map(|side| side.body)) {
                self.ids.push(candidate.id);
            }
        }
        if self.ids.is_empty() {
            return Ok(None);
        }
        work.locate_past_ends(model, &self.step.step.q_at, &self.ids, &mut self.near, &mut self.rooms)?;
        let mut first = None::<f64>;
        for k in 0..self.near.len() {
            let end = self.near[k];
            let Some(&start) = find(&self.step.start, end.id) else { continue };
            let tolerance = tolerance + self.depth_of_pair(&start);
            let known_inside = |candidate: &Candidate<D>| candidate.gap < -tolerance;
            if find(&work.candidates, end.id).is_some_and(known_inside) {
                continue;
            }
            let rate = rate_at(&mut self.one, model, &from.q, &start, &from.v)?;
            if self.one.is_empty() {
                // No force can move it.
                continue;
            }
            let end_rate = rate_at(&mut self.one, model, &self.step.step.q_at, &end, &self.step.step.v_end)?;
            let cubic = GapCubic::new([start.gap.max(0.0), end.gap], [rate, end_rate], h);
            let inside = if end.gap < -tolerance {
                let touches = cubic.zero(HALVINGS);
                self.inside_after(model, from, (end.id, tolerance), [h, touches], work)?
            } else {
                let mut inside = None;
                for (s, low) in cubic.lows() {
                    let dips = low < -tolerance && s > 0.0 && s < 1.0;
                    if dips && self.is_inside_at(model, from, (end.id, tolerance), [h, s * h], work)? {
                        inside = Some(s * h);
                        break;
                    }
                }
                inside
            };
            first = match (first, inside) {
                (Some(first), Some(tau)) => Some(first.min(tau)),
                (known, new) => known.or(new),
            };
        }
        Ok(first)
    }

    /// How deep the closed contacts between the bodies of a candidate are at the start, m: as deep, another one isn't in the surface any
    /// further. Where a corner that has sunk in by nanometres slides off a side, the end of that side would strike what it carries.
    fn depth_of_pair(&self, candidate: &Candidate<D>) -> f64 {
        let bodies = |of: &Candidate<D>| of.sides.map(|side| side.body);
        let [a, b] = bodies(candidate);
        let is_of_pair = |of: &&Candidate<D>| bodies(of) == [a, b] || bodies(of) == [b, a];
        let closed = |of: &&Candidate<D>| self.step.closed.binary_search(&of.id).is_ok();
        let pressed = self.step.start.iter().filter(is_of_pair).filter(closed);
        pressed.fold(0.0, |deepest, of| deepest.max(-of.gap))
    }

    /// A time soon after a contact touches, at the part `touches` of the attempt of `h` (s), at which it is inside its
    /// surface; `None` where it has come past the end by then.
    fn inside_after(
        &mut self,
        model: &Model<D>,
        from: &State,
        contact: (ContactId, f64),
        [h, touches]: [f64; 2],
        work: &mut Workspace<D>,
    ) -> Result<Option<f64>, Mismatch> {
        let mut rest = 1.0 - touches;
        for _ in 0..CLOSER {
            rest *= SOON_AFTER;
            let tau = h * (touches + rest);
            if self.is_inside_at(model, from, contact, [h, tau], work)? {
                return Ok(Some(tau));
            }
        }
        Ok(None)
    }

    /// Whether a contact is inside its surface by more than a tolerance (m), and doesn't graze, at the time `tau` of the attempt of `h`
    /// (s), in which velocities change evenly.
    fn is_inside_at(
        &mut self,
        model: &Model<D>,
        from: &State,
        (id, tolerance): (ContactId, f64),
        [h, tau]: [f64; 2],
        work: &mut Workspace<D>,
    ) -> Result<bool, Mismatch> {
        self.place_at(model, from, h, tau);
        std::mem::swap(&mut work.candidates, &mut self.on_the_way);
        let detected = work.detect(model, &self.place, 0.0);
        std::mem::swap(&mut work.candidates, &mut self.on_the_way);
        detected?;
        let Self { step, place, on_the_way, .. } = self;
        step.grazing.is_inside(model, place, (id, tolerance), on_the_way, work)
    }

    /// Takes the coordinates at the time `tau` of an attempt that lasted `h` (s), in which velocities change evenly.
    pub(super) fn place_at(&mut self, model: &Model<D>, from: &State, h: f64, tau: f64) {
        let part = 0.5 * tau / h;
        let ends = from.v.iter().zip(&self.step.step.v_end);
        self.v.iter_mut().zip(ends).for_each(|(v, (start, end))| *v = start + part * (end - start));
        model.move_along(&from.q, &self.v, tau, &mut self.place);
    }

    /// A speed that no point of what isn't elastic exceeds, m/s.
    pub(super) fn fastest(&self, model: &Model<D>, v: &[f64]) -> f64 {
        let speeds = model.speeds(v).zip(&self.elastic).filter(|(_, elastic)| !**elastic);
        speeds.map(|(speed, _)| speed).fold(0.0, f64::max)
    }

    /// Whether one side of a contact is elastic: steps don't follow its vibrations, so that nothing is known of gaps
    /// within them.
    pub(super) fn is_with_elastic(&self, model: &Model<D>, bodies: &[BodyId; 2]) -> bool {
        let is_elastic = |(index, _, _)| self.elastic.get(index).copied().unwrap_or(true);
        bodies.iter().any(|body| model.owner(*body).is_some_and(is_elastic))
    }
}
