//! When a slide stops, or turns about, within a step.

use super::MoreauJeanLocated;
use super::locate::is_time;
use crate::closed_step::ClosedStep;
use crate::contact::tangential;
use crate::{ContactState, Mismatch, Model, State, StepError, StepSpan, Vector, Workspace};
use teeter_contact::Outcome;
use teeter_detect::ContactId;

/// A slide of a speed below this part of what forces and friction change in a step isn't looked at, m/s per m/s.
const SLOW: f64 = 1e-3;

/// Forces change the velocities of both sides of a contact alike if they part them by less than this part of what they change each by.
const ALIKE: f64 = 1e-6;

/// A slide has stopped where its speed is below this part of the same.
const STOPPED: f64 = 1e-6;

/// Up to so many times the speed that is rounding a slide isn't looked at, and one that stops has stopped. What is rounding grows with
/// the speed of the fastest contact.
const STILL: f64 = 4.0;

/// A slide that stops is followed to this part of the way that is left: the step must end before it does.
const AIM: f64 = 0.999;

/// Attempts at locating a stop: three or four do, where friction is even.
const ATTEMPTS: usize = 40;

/// A slide that stops within a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slide<const D: usize> {
    id: ContactId,
    /// Its direction at the start.
    direction: Vector<D>,
    /// A speed that counts as none, m/s.
    none: f64,
    /// When it was last seen to slide, s from the start, and how fast, m/s.
    seen: (f64, f64),
}

impl<const D: usize> Slide<D> {
    /// What is left of its speed at the end of an attempt, m/s; not above 0 where it has stopped.
    fn left(&self, step: &ClosedStep<D>) -> f64 {
        let contacts = step.stage.contacts();
        let Some(i) = contacts.iter().position(|contact| contact.id == self.id) else { return f64::INFINITY };
        match contacts[i].state() {
            ContactState::Open => f64::INFINITY,
            // The guard acts where a slide turns about.
            _ if step.guarded.contacts[i] => 0.0,
            ContactState::Stick => 0.0,
            ContactState::Slip => tangential(&contacts[i].u_law).dot(&self.direction),
        }
    }
}

impl<const D: usize> MoreauJeanLocated<D> {
    /// Looks for slides that stop within the part of a step that was attempted, with this outcome. Where there are any, attempts the part
    /// up to where the first of them stops, and returns the outcome of that and its length, s.
    pub(super) fn find_stop(
        &mut self,
        model: &Model<D>,
        from: &State,
        part: &StepSpan,
        outcome: Option<Outcome>,
        work: &mut Workspace<D>,
    ) -> Result<(Option<Outcome>, Option<f64>), StepError> {
        self.find_slides_that_stop(model)?;
        if self.slides.is_empty() {
            return Ok((outcome, None));
        }
        let (mut sliding, mut stopped) = (0.0, part.h);
        let mut tau = 0.5 * part.h;
        for _ in 0..ATTEMPTS {
            if !is_time(tau, part.start) {
                break;
            }
            let outcome = self.attempt_up_to(model, from, part, tau, work)?;
            let step = &self.step;
            let left = |slide: &Slide<D>| slide.left(step);
            if self.slides.iter().any(|slide| left(slide) <= 0.0) {
                stopped = tau;
                tau = 0.5 * (sliding + stopped);
            } else if self.slides.iter().any(|slide| left(slide) <= slide.none) {
                if outcome.is_none_or(|outcome| outcome.converged()) {
                    return Ok((outcome, Some(tau)));
                }
                break;
            } else {
                sliding = tau;
                let mut stops = f64::INFINITY;
                for slide in &mut self.slides {
                    let (before, speed) = slide.seen;
                    slide.seen = (tau, slide.left(step));
                    stops = stops.min(tau + slide.seen.1 * (tau - before) / (speed - slide.seen.1).max(0.0));
                }
                let aimed = tau + AIM * (stops - tau);
                tau = if aimed < stopped { aimed } else { 0.5 * (sliding + stopped) };
            }
            if stopped - sliding <= f64::EPSILON * part.h {
                break;
            }
        }
        // It jumps, as another contact opens or closes on the way, or is too short a part to be solved.
        Ok((self.attempt_up_to(model, from, part, part.h, work)?, None))
    }

    pub(super) fn attempt_up_to(
        &mut self,
        model: &Model<D>,
        from: &State,
        part: &StepSpan,
        tau: f64,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, StepError> {
        let end = if tau == part.h { part.end } else { part.start + tau };
        let shorter = StepSpan { end, h: tau, ..*part };
        self.step.free_velocity(model, from, &shorter, work)?;
        work.counts.refused_attempts += 1;
        self.step.attempt(model, from, &shorter, work)
    }

    /// Finds the contacts that slide at the start of the attempt and not, or not that way, at its end.
    fn find_slides_that_stop(&mut self, model: &Model<D>) -> Result<(), Mismatch> {
        self.slides.clear();
        for (i, contact) in self.step.stage.contacts().iter().enumerate() {
            let law = model.law(contact.law)?;
            if !contact.persisting
                || contact.p[0] <= 0.0
                || law.impact.spring().is_some()
                || self.pressed_lately(contact.id)
            {
                continue;
            }
            let start = self.step.slides[i];
            let speed = start.norm();
            if speed <= STILL * contact.still {
                continue;
            }
            let change = self.step.stage.velocity(i, &self.by_forces)?;
            let change = tangential(&change).norm() + law.friction * change[0].abs();
            // Of two blocks that fall alike forces change nothing; what holds one of them up changes them as much as these change each.
            let each = self.step.stage.speed(i, &self.by_forces);
            let change = if change > ALIKE * each { change } else { 0.5 * law.friction * each };
            if speed <= SLOW * change {
                continue;
            }
            // What is slower than rounding sticks by its state, so that a slide can't be followed down to a lower speed.
            let none = (STOPPED * change).max(STILL * contact.still);
            let slide = Slide { id: contact.id, direction: start / speed, none, seen: (0.0, speed) };
            if slide.left(&self.step) <= 0.0 {
                self.slides.push(slide);
            }
        }
        Ok(())
    }
}
