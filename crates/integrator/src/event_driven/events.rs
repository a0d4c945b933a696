//! Events of a smooth phase: what is watched.

use super::instant::{Kind, Known, Watch};
use super::modes::Pressing;
use super::runge_kutta::RungeKutta;
use super::smooth::Correction;
use super::{EventDriven, FLOOR, Stop};
use crate::moreau_jean_located::rate_at;
use crate::{Account, Model, State, StepError, Workspace};
use teeter_detect::{Candidate, ContactId};

/// An open contact at the start of a step of the method.
#[derive(Clone, Copy, Debug)]
pub(super) struct Open {
    pub(super) id: ContactId,
    /// m.
    pub(super) gap: f64,
    /// m/s.
    pub(super) rate: f64,
    /// Whether no force can move it.
    pub(super) is_prescribed: bool,
}

impl Open {
    /// Whether it may touch within `h` (s), and isn't prescribed to.
    pub(super) fn may_touch_within(&self, h: f64) -> bool {
        !self.is_prescribed && self.gap >= 0.0 && self.gap < -FASTER * h * self.rate
    }
}

/// Forces and distances from the friction cone are 0 to this, in parts of their scale.
const FORCE: f64 = 1e-11;

/// How far a contact is from the end of its surface is 0 to this, in parts of what a gap is located to.
const AT_END: f64 = 1e-2;

/// Sliding velocities are 0 to this part of what they consist of.
const SLIDE: f64 = 1e-14;

/// A quantity that begins so far beyond 0 can't be watched.
const WRONG: f64 = 1e-6;

/// Halvings of steps in a phase at whose end contacts are inside that had no gap at the start: a corner that
/// comes from beside a side and into it at once is still so after them.
const MOST_HALVINGS: u32 = 20;

/// A contact that isn't there at the end of a step may have touched if it approached so many times as fast as it did
/// at the start; and no body moves so many times as fast within a step as at its ends.
const FASTER: f64 = 4.0;

/// Searches for an event before the one that was found: one does, where corners follow each other.
const MOST_EARLIER: usize = 20;

/// An error that falls with less than this power of the step is rounding, unless it is more than so
/// many tolerances: then something isn't smooth.
const ROUNDING_ORDER: f64 = 2.5;
const MOST_NOISE: f64 = 1e3;
const LEAST_NOISE: f64 = 0.2;

/// A rest of a step's time that rounding may leave.
const STEP_LEFT: f64 = 1e-9;

/// A contact that pulls by this part of its scale within a step has opened in it; one whose friction is over its limit by as much slides.
const PULLED: f64 = 1e-3;

/// A step of the method is refused where velocities (`JUMP`) or coordinates (`SHIFT`) at its contacts need a larger correction than this part of
/// the largest: accelerations of contacts are known to a millionth ([`super::turning`]), and what that makes of coordinates is far less.
const JUMP: f64 = 1e-6;
const SHIFT: f64 = 1e-9;

/// A phase begins with a step of at least so many of the [shortest](shortest) ones.
const SHORT: f64 = 256.0;

/// The shortest step at time `t` (s) that rounding leaves in a scheme's step of `dt` (s), s.
fn shortest(t: f64, dt: f64) -> f64 {
    4.0 * f64::EPSILON * t.abs().max(dt)
}

impl EventDriven {
    /// Moves in smooth motion from `from` to the first event, to where loads aren't smooth, or to `end` (s).
    pub(super) fn go_on(
        &mut self,
        model: &Model<2>,
        from: &mut State,
        end: f64,
        work: &mut Workspace<2>,
    ) -> Result<Stop, StepError> {
        let size = model.size();
        // A break at the start or the end is not seen from the wrong side, nor is it met twice.
        let nudge = 8.0 * f64::EPSILON * from.t.abs().max(end.abs());
        let breaks = model.parts().iter().map(|part| part.system.next_break(self.handled + nudge));
        let next = breaks.fold(f64::INFINITY, f64::min);
        let last = if next < end - nudge { next } else { end };
        self.ends_with_break = next <= end + nudge;
        let middle = 0.5 * (from.t + last);
        self.smooth.between = [(from.t + nudge).min(middle), (last - nudge).max(middle)];
        let n = self.smooth.len(model);
        self.rk.resize(n);
        self.next_slope.resize(n, 0.0);
        self.y.clear();
        self.y.extend_from_slice(&from.q);
        self.y.extend_from_slice(&from.v);
        self.y.resize(n, 0.0);
        self.smooth.project(model, from.t, &mut self.y, work)?;
        self.projected = 0.0;
        if work.account == Account::Kept {
            let (q, v) = self.y[..size.q + size.v].split_at(size.q);
            let [before, after] = [model.energy_at(&from.q, &from.v), model.energy_at(q, v)];
            let taken = self.smooth.energy(model, &self.y);
            self.projected =
                (after.kinetic - before.kinetic) + (after.elastic - before.elastic) + (after.gravity - before.gravity)
                    - (taken.contact + taken.friction);
        }
        self.smooth.slope(model, from.t, &self.y, work, self.rk.first_slope())?;
        for contact in &mut self.smooth.contacts {
            contact.u_before = contact.u;
        }
        self.watch_start();
        if self.smooth.contacts.iter().any(|contact| !(contact.presses() > -WRONG && contact.held > -WRONG)) {
            return Ok(Stop::Stuck);
        }
        let (mut t, mut duration) = (from.t, 0.0);
        // A search for the last event may have shortened it to nothing.
        self.h = self.h.max(SHORT * shortest(t, from.dt));
        let (mut noise, mut noisy, mut flat) = (0.0_f64, f64::INFINITY, 0);
        let (mut before, mut explored, mut halvings) = (None::<(f64, f64)>, false, 0);
        let (mut is_open_known, mut is_refused) = (false, false);
        while self.substeps < Self::MOST_SUBSTEPS {
            self.substeps += 1;
            let rest = last - t;
            // What was refused is tried shorter, however little.
            let enough = if is_refused { 1.0 } else { 0.9 };
            let mut h = if self.h < enough * rest { self.h } else { rest };
            is_refused = true;
            if !(h > shortest(t, from.dt)) {
                // Rounding leaves no time to go on.
                return if rest > STEP_LEFT * from.dt {
                    Ok(Stop::Stuck)
                } else {
                    self.arrive(model, from, last, duration, end, work)
                };
            }
            let estimate = self.try_step(model, t, h, work)?;
            // What is rounding falls with the step only.
            match before {
                Some((longer, error)) if 0.8 * longer > h => {
                    let order = (error / estimate).ln() / (longer / h).ln();
                    let is_flat = estimate > LEAST_NOISE && estimate < MOST_NOISE && order < ROUNDING_ORDER;
                    // Once may be chance, where the step doesn't resolve a load.
                    flat = if is_flat { flat + 1 } else { 0 };
                    if flat > 1 {
                        (noise, noisy) = (1.5 * estimate / h, h);
                    }
                    before = Some((h, estimate));
                }
                Some((longer, _)) if longer > h => {}
                _ => before = Some((h, estimate)),
            }
            // It is that of steps like these.
            if h > 4.0 * noisy {
                (noise, flat) = (0.0, 0);
            }
            let error =
                if estimate.is_nan() { f64::INFINITY } else { (estimate - (noise * h).min(MOST_NOISE)).max(0.0) };
            if !(error <= 1.0) {
                self.h = if error.is_finite() { RungeKutta::better(h, error) } else { 0.1 * h };
                work.counts.refused_attempts += 1;
                continue;
            }
            if let Some(part) = self.smooth.pulled.take()
                && part * h > 1e-3 * self.h.min(rest)
            {
                self.h = part * h;
                work.counts.refused_attempts += 1;
                continue;
            }
            // A shorter step from the same start needs no more.
            if !is_open_known {
                self.find_open(model, h, work)?;
                is_open_known = true;
            }
            if let Some(shorter) = self.dip(model, h, work)? {
                self.h = shorter;
                work.counts.refused_attempts += 1;
                continue;
            }
            let mut stop = None;
            let any = self.find_watches(model, t, h, work)?;
            // Where another side faces a corner by the end, the contact that touched first isn't watched: it is
            // where the step is shorter.
            let is_long = 0.5 * h > 4.0 * shortest(t, from.dt);
            if halvings < MOST_HALVINGS && is_long && self.watched.iter().any(Watch::comes_from_beside) {
                halvings += 1;
                self.h = 0.5 * h;
                work.counts.refused_attempts += 1;
                continue;
            }
            if any {
                match self.locate_first(model, t, h, work)? {
                    Some(tau) => (h, stop) = (tau, Some(Stop::Event)),
                    // Nothing that a shorter step would confirm.
                    None => {
                        self.h = 0.5 * h;
                        continue;
                    }
                }
            } else {
                let better = RungeKutta::better(h, error.max(1e-12));
                self.h = if h < self.h { self.h.max(better) } else { better };
                // Where steps stop growing, a longer one tells whether it is rounding that holds them.
                if estimate > LEAST_NOISE && !explored {
                    (self.h, explored) = (3.0 * h, true);
                }
            }
            if h > 0.0 {
                let mut y = std::mem::take(&mut self.rk.end);
                let correction = self.smooth.project(model, (t + h).min(last), &mut y, work);
                self.rk.end = y;
                let Correction { of_places, of_velocities } = correction?;
                let is_known = crate::subsystem::all_finite(&self.rk.end);
                if !(is_known && of_places <= SHIFT && of_velocities <= JUMP) {
                    // Nothing smooth leads to the contacts that are there: a beam's crest under a base may be another one by now. Or no
                    // forces keep the contacts as they are.
                    if duration > 0.0 {
                        self.end_phase(model, from, t, duration, work)?;
                    }
                    return Ok(Stop::Stuck);
                }
                self.y.copy_from_slice(&self.rk.end);
            }
            t = if stop.is_none() && h == rest { last } else { (t + h).min(last) };
            duration += h;
            if let Some(stop) = stop {
                if duration > 0.0 {
                    self.end_phase(model, from, t, duration, work)?;
                } else if self.y[size.q..size.q + size.v] != from.v {
                    // What the contacts' coming to rest did to the velocities decides what they do.
                    self.end_phase(model, from, t, f64::MIN_POSITIVE, work)?;
                }
                return Ok(stop);
            }
            if t == last {
                return self.arrive(model, from, last, duration, end, work);
            }
            self.smooth.slope(model, t, &self.y, work, self.rk.first_slope())?;
            self.watch_start();
            (is_open_known, is_refused) = (false, false);
        }
        Ok(Stop::Stuck)
    }

    /// Ends the phase at `last`.
    fn arrive(
        &mut self,
        model: &Model<2>,
        from: &mut State,
        last: f64,
        duration: f64,
        end: f64,
        work: &mut Workspace<2>,
    ) -> Result<Stop, StepError> {
        if !self.ends_with_break {
            let nq = model.size().q;
            model.drive_at(last, &mut self.y[nq..nq + model.size().v]);
        }
        if duration > 0.0 || last == end {
            self.end_phase(model, from, last, duration.max(f64::MIN_POSITIVE), work)?;
        }
        from.t = last;
        Ok(if last == end { Stop::End } else { Stop::Break })
    }

    /// Takes a step of the method; its error, 1 at most for a good one.
    pub(super) fn try_step(
        &mut self,
        model: &Model<2>,
        t: f64,
        h: f64,
        work: &mut Workspace<2>,
    ) -> Result<f64, StepError> {
        let Self { smooth, rk, y, .. } = self;
        smooth.pulled = None;
        rk.step(h, y, |s, y, slope| {
            smooth.slope(model, t + s * h, y, work, slope)?;
            let fails = |contact: &Pressing| contact.presses().min(contact.held) < -PULLED;
            if smooth.pulled.is_none() && s < 1.0 && smooth.contacts.iter().any(fails) {
                smooth.pulled = Some(s);
            }
            Ok::<_, StepError>(())
        })?;
        if !crate::subsystem::all_finite(&rk.end) {
            return Ok(f64::INFINITY);
        }
        let (nq, nv, tolerance) = (model.size().q, model.size().v, self.settings.tolerance);
        let largest = |range: std::ops::Range<usize>| {
            let pairs = y[range.clone()].iter().zip(&rk.end[range]);
            pairs.fold(FLOOR, |largest, (a, b)| largest.max(a.abs()).max(b.abs()))
        };
        let (of_q, of_v) = (tolerance * largest(0..nq), tolerance * largest(nq..nq + nv));
        self.scale.clear();
        self.scale.resize(nq, of_q);
        self.scale.resize(nq + nv, of_v);
        Ok(rk.error(h, &self.scale))
    }

    /// Finds the gaps at the start of the step of `h` (s) that was tried last, of open contacts that may close within
    /// it.
    fn find_open(&mut self, model: &Model<2>, h: f64, work: &mut Workspace<2>) -> Result<(), StepError> {
        self.open.clear();
        let (nq, nv) = (model.size().q, model.size().v);
        let (q, v) = (&self.y[..nq], &self.y[nq..nq + nv]);
        let fastest = model.fastest(v).max(model.fastest(&self.rk.end[nq..nq + nv]));
        // Two bodies may approach each other.
        self.near = FASTER * h * 2.0 * fastest;
        work.detect(model, q, self.near)?;
        for k in 0..work.candidates.len() {
            let candidate = work.candidates[k];
            if !self.smooth.contacts.iter().any(|contact| contact.id == candidate.id) {
                let rate = rate_at(&mut self.smooth.stage, model, q, &candidate, v)?;
                let is_prescribed = self.smooth.stage.is_empty();
                self.open.push(Open { id: candidate.id, gap: candidate.gap, rate, is_prescribed });
            }
        }
        Ok(())
    }

    /// Keeps what contacts that press have at the start of a step.
    fn watch_start(&mut self) {
        for contact in &mut self.smooth.contacts {
            contact.start = [contact.presses(), contact.held, contact.slides()];
            contact.start_room = contact.room;
        }
    }

    /// Lists what has happened by the end of a step of `h` (s) from `t`; whether anything has.
    fn find_watches(&mut self, model: &Model<2>, t: f64, h: f64, work: &mut Workspace<2>) -> Result<bool, StepError> {
        self.watched.clear();
        let (nq, nv) = (model.size().q, model.size().v);
        let tolerance = self.located.tolerance(&self.y[..nq]);
        work.detect(model, &self.rk.end[..nq], 0.0)?;
        for candidate in &work.candidates {
            let Some([start, rate, level]) = self.closes(candidate, tolerance) else { continue };
            let (q, v) = self.rk.end[..nq + nv].split_at(nq);
            let end_rate = rate_at(&mut self.smooth.one, model, q, candidate, v)?;
            let start = Known { tau: 0.0, value: start - level, rate };
            let end = Known { tau: h, value: candidate.gap - level, rate: end_rate };
            self.watched.push(Watch::closing(candidate.id, level, [start, end], tolerance));
        }
        if !self.smooth.contacts.is_empty() {
            let (q, v) = self.rk.end[..nq + nv].split_at(nq);
            self.smooth.accelerate(model, t + h, q, v, work)?;
            for contact in &self.smooth.contacts {
                let mut watch = |kind, start, end: f64, tolerance: f64| {
                    if end < -tolerance {
                        self.watched.push(Watch::new(kind, contact.id, start, end, tolerance));
                    }
                };
                if contact.row.is_none() {
                    watch(Kind::Leaves, 1.0, -1.0, 0.0);
                    continue;
                }
                let [presses, holds, slides] = contact.start;
                watch(Kind::Leaves, contact.start_room, contact.room, AT_END * tolerance);
                watch(Kind::Opens, presses, contact.presses(), FORCE);
                watch(Kind::Slips, holds, contact.held, FORCE);
                watch(Kind::Stops, slides, contact.slides(), SLIDE * contact.speed);
            }
        }
        Ok(!self.watched.is_empty())
    }
    /// Of a contact that was open at the start of the step and is inside its surface where the step ends: its gap (m)
    /// and rate (m/s) at the start, and the gap at which it closes (m).
    pub(super) fn closes(&self, candidate: &Candidate<2>, tolerance: f64) -> Option<[f64; 3]> {
        if candidate.gap >= -tolerance || self.smooth.contacts.iter().any(|contact| contact.id == candidate.id) {
            return None;
        }
        let at = self.open.binary_search_by_key(&candidate.id, |open| open.id);
        // One that comes from beyond the end of its surface has no gap there.
        let (start, rate) = at.map_or((f64::INFINITY, f64::NAN), |at| (self.open[at].gap, self.open[at].rate));
        let level = start.min(0.0);
        let is_prescribed = at.is_ok_and(|at| self.open[at].is_prescribed);
        (candidate.gap < level - tolerance && !is_prescribed).then_some([start, rate, level])
    }

    /// The time (s) of the first event within a step of `h` (s) from `t`, as [`Self::locate_event`] finds that of what
    /// is watched. What is inside a surface at that time without being so at the end of the step, as a corner that
    /// another one of its body has followed, came before it.
    fn locate_first(
        &mut self,
        model: &Model<2>,
        t: f64,
        h: f64,
        work: &mut Workspace<2>,
    ) -> Result<Option<f64>, StepError> {
        let nq = model.size().q;
        let mut tau = self.locate_event(model, t, h, work)?;
        for _ in 0..MOST_EARLIER {
            let Some(later) = tau.filter(|tau| *tau > 0.0) else { break };
            let tolerance = self.located.tolerance(&self.y[..nq]);
            work.detect(model, &self.rk.end[..nq], 0.0)?;
            let is_watched = |id| self.watched.iter().any(|watch| watch.id == id);
            let is_missed = |c: &&Candidate<2>| !is_watched(c.id) && self.closes(c, tolerance).is_some();
            if work.candidates.iter().find(is_missed).is_none() {
                break;
            }
            self.find_watches(model, t, later, work)?;
            tau = self.locate_event(model, t, later, work)?;
        }
        Ok(tau)
    }
}
