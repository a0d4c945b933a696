//! The step in which contacts that are closed stay so: of the whole step in `moreau-jean-closed`,
//! of its parts in `moreau-jean-located`; with another motion beside the contacts in
//! `generalized-alpha` (`docs/schemes.md`).
//!
//! Its formulas, and why no contact gives energy, are at
//! [`MoreauJeanClosed`](crate::MoreauJeanClosed).

mod guard;
mod summits;
mod together;

pub(crate) use together::moving;

use crate::contact::tangential;
use crate::grazing::Grazing;
use crate::laws::is_impact;
use crate::stage::ContactRows;
use crate::step_motion::StepMotion;
use crate::theta_step::ThetaStep;
use crate::{
    ContactError, ContactStage, ImpactLaw, Mismatch, Model, Over, PairLaw, PhaseEnd, PhaseKind, Rule, SpringStep,
    State, StepError, StepSpan, Vector, WarmStart, Workspace,
};
pub(crate) use guard::{Guard, Guarded};
use teeter_contact::Outcome;
use teeter_detect::{Candidate, Candidates, ContactId};

/// Up to so many contacts an attempt starts from the impulses of the step before; with more, from
/// those of the attempt before. Stacks of fewer blocks take up to a quarter more iterations with
/// the latter, piles of hundreds take fewer.
const FEW: usize = 250;

/// θ: the step's account of work holds for the trapezoidal rule.
pub(crate) const THETA: f64 = 0.5;

/// A step, or a part of one, that is tried until no open contact ends in its surface; and the
/// memory for it.
#[derive(Debug)]
pub(crate) struct ClosedStep<const D: usize, M = ThetaStep> {
    /// An open contact closes where the step would end so deep in the surface, and sinking, m.
    gap_tolerance: f64,
    pub(crate) step: M,
    pub(crate) v_free: Vec<f64>,
    /// q̃.
    q_ahead: Vec<f64>,
    /// q̃_m.
    q_mid: Vec<f64>,
    /// Summits that press; memory.
    summits: Vec<ContactId>,
    /// The mean velocity of the guessed motion, in whose middle frames are taken.
    guessed: Vec<f64>,
    /// How the frames of summits are found.
    rounds: summits::Rounds<D>,
    /// Coordinates in the middle of the motion that was found; memory.
    q_tried: Vec<f64>,
    middle: Candidates<D>,
    /// Of each of these, at q̃_m and at q̃, how far it is to the end of its surface, m.
    rooms: [Vec<f64>; 2],
    /// Whether contacts that pass the end of their surface within the step act as if it went on; if
    /// not, those act that pass it in the second half.
    goes_past_ends: bool,
    ahead: Candidates<D>,
    /// What is near at the start; memory.
    pub(crate) start: Candidates<D>,
    pub(crate) stage: ContactStage<D>,
    /// Rows of one contact elsewhere than the step's.
    row: ContactRows<D>,
    /// The contacts that take part, in order of identity.
    pub(crate) closed: Vec<ContactId>,
    /// Those of them that have been looked at in this step, and those that are new.
    looked: Vec<ContactId>,
    /// Whether this step takes the frames of summits from the motion without impulses: where none presses, or iterating for them failed.
    summits_lost: bool,
    pub(crate) new: Vec<ContactId>,
    /// What was found of the new ones.
    found: Candidates<D>,
    found_rooms: Vec<f64>,
    /// On which piece of its surface a contact is, at q̃_m and at q̃.
    pieces: [Vec<u32>; 2],
    pub(crate) grazing: Grazing<D>,
    /// Of each body: how deep it is in what it was on before, m.
    depths: Vec<f64>,
    /// Of each body: what would land within this time lands together with a contact that has just been closed, s; 0 where there is none.
    landings: Vec<f64>,
    /// Of each part of the model, whether it is known how fast its points are: not of a beam.
    rigid: Vec<bool>,
    /// The impulses of the attempt before, of many contacts: where the solver starts.
    tried: WarmStart,
    /// The part of the step that is taken: an approach that forces make within a whole step is no
    /// impact.
    pub(crate) of_step: f64,
    /// Of each contact of the step: its shift were there no restitution.
    resting_shift: Vec<f64>,
    /// Of each contact of the step: its velocity along the surface at the start, m/s.
    pub(crate) slides: Vec<Vector<D>>,
    /// Which contacts have the shift that can't give energy.
    pub(crate) guarded: Guarded,
    /// Which contacts stay closed.
    pub(crate) stays: Vec<bool>,
}

/// Where a contact is in the surface already, it closes when it sinks by this part of the gap
/// tolerance within a step: more than rounding, and so little that no approach is too slow to be
/// seen.
pub(crate) const SINKING: f64 = 1e-3;

/// A contact that closes from one piece of its surface to another has turned onto that one where the turning of its frame accounts for so much of
/// its approach.
const TURNED: f64 = 0.5;

/// A contact that leaves faster than this part of Σ|J_i v| is open after the step, v the larger of
/// v¹ and v_free: what was stopped has no velocity left to tell its rounding by.
const LEAVING: f64 = 1e-10;

impl<const D: usize> ClosedStep<D> {
    /// With the motion of the θ step.
    pub(crate) fn new(gap_tolerance: f64) -> Self {
        Self::with_motion(gap_tolerance, ThetaStep::default())
    }
}

impl<const D: usize, M: StepMotion<D>> ClosedStep<D, M> {
    pub(crate) fn with_motion(gap_tolerance: f64, step: M) -> Self {
        Self {
            gap_tolerance,
            step,
            v_free: Vec::new(),
            q_ahead: Vec::new(),
            q_mid: Vec::new(),
            summits: Vec::new(),
            guessed: Vec::new(),
            rounds: summits::Rounds::default(),
            q_tried: Vec::new(),
            middle: Vec::new(),
            rooms: [const { Vec::new() }; 2],
            goes_past_ends: false,
            ahead: Vec::new(),
            start: Vec::new(),
            stage: ContactStage::new(),
            row: ContactRows::default(),
            closed: Vec::new(),
            looked: Vec::new(),
            summits_lost: false,
            new: Vec::new(),
            found: Vec::new(),
            found_rooms: Vec::new(),
            pieces: [const { Vec::new() }; 2],
            grazing: Grazing::default(),
            depths: Vec::new(),
            landings: Vec::new(),
            rigid: Vec::new(),
            tried: WarmStart::default(),
            of_step: 1.0,
            resting_shift: Vec::new(),
            slides: Vec::new(),
            guarded: Guarded::default(),
            stays: Vec::new(),
        }
    }

    /// With contacts that act past the end of their surface as if it went on, for a scheme that
    /// ends the step there.
    pub(crate) fn past_ends(self) -> Self {
        Self { goes_past_ends: true, ..self }
    }

    /// Starts to serve a model.
    pub(crate) fn start(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        let contacts = model.contacts_to_expect();
        self.step.start_motion(model, state, work)?;
        self.rigid.clear();
        self.resize(model);
        for candidates in [&mut self.middle, &mut self.ahead, &mut self.start, &mut self.found, &mut work.candidates] {
            candidates.reserve(contacts);
        }
        self.rooms.iter_mut().for_each(|rooms| rooms.reserve(contacts));
        self.stage.reserve(model);
        self.row.reserve(1, model.size().row, model.parts().len());
        self.found_rooms.reserve(contacts);
        self.pieces.iter_mut().for_each(|pieces| pieces.reserve(1));
        self.grazing.reserve(contacts);
        for ids in [&mut self.closed, &mut self.looked, &mut self.new, &mut self.summits] {
            ids.reserve(contacts);
        }
        self.rounds.reserve(contacts);
        for of_bodies in [&mut self.depths, &mut self.landings] {
            of_bodies.reserve(model.body_count().saturating_sub(of_bodies.len()));
        }
        self.resting_shift.reserve(contacts);
        self.slides.reserve(contacts);
        self.guarded.reserve(contacts);
        self.stays.reserve(contacts);
        state.warm.reserve(contacts, D);
        state.memory.reserve(contacts);
        self.step.make_factors(model, state, state.dt, work)
    }

    /// Refuses another model than that which the scheme serves.
    #[inline]
    pub(crate) fn check(&mut self, model: &Model<D>) -> Result<(), StepError> {
        self.step.check_motion(model)?;
        self.resize(model);
        Ok(())
    }

    /// Begins a step, or a part of one, from a state: the free velocity, and the contacts that are
    /// closed there.
    pub(crate) fn begin(
        &mut self,
        model: &Model<D>,
        from: &State,
        span: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        self.free_velocity(model, from, span, work)?;
        self.closed.clear();
        self.closed.extend_from_slice(from.memory.active());
        Ok(())
    }

    /// Takes the free velocity of a step from a state.
    pub(crate) fn free_velocity(
        &mut self,
        model: &Model<D>,
        from: &State,
        span: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        self.step.make_factors(model, from, span.h, work)?;
        self.step.move_without_impulses(model, from, span, work);
        self.v_free.clear();
        self.v_free.extend_from_slice(self.step.v_end());
        self.looked.clear();
        self.summits_lost = false;
        self.tried.clear();
        self.stage.keep_islands_anew();
        Ok(())
    }

    /// Takes the step with the contacts that are closed: leaves q¹ and v¹, and the candidates in
    /// their surface there in the workspace.
    pub(crate) fn attempt(
        &mut self,
        model: &Model<D>,
        from: &State,
        span: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, StepError> {
        // In flight there is nothing to look at.
        if self.looked.len() < self.closed.len() {
            self.look_ahead(model, from, span.h, work)?;
        }
        self.rounds.begin();
        let outcome = loop {
            let outcome = self.solve_to_its_end(model, from, span, work)?;
            if !self.takes_frames_of_summits(model, from, span.h, work)? {
                break outcome;
            }
        };
        self.step.end(model, from, span.h)?;
        work.detect(model, self.step.q_end(), 0.0)?;
        Ok(outcome)
    }

    /// Solves the step until its motion beside the contacts is found, too.
    fn solve_to_its_end(
        &mut self,
        model: &Model<D>,
        from: &State,
        span: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, StepError> {
        loop {
            let outcome =
                self.solve(model, from, span, work).map_err(|source| StepError::Problem { t: from.t, source })?;
            // Frames and gaps stay the same in these rounds: their fixed point is then that of one
            // problem.
            if !self.step.takes_another_round(model, from, span.h, work) {
                return Ok(self.step.judge(outcome, work.settings.tolerance));
            }
            self.v_free.copy_from_slice(self.step.v_end());
            self.stage.keep_islands_anew();
        }
    }

    /// Attempts until no open contact sinks in.
    pub(crate) fn settle(
        &mut self,
        model: &Model<D>,
        from: &State,
        span: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, StepError> {
        loop {
            let outcome = self.attempt(model, from, span, work)?;
            if !self.close_what_sinks(model, from, work)? {
                return Ok(outcome);
            }
            self.close_what_lands_too(model, span.h, work)?;
            work.counts.refused_attempts += 1;
        }
    }

    /// Closes contacts beside those that are, which rise; whether any is new.
    pub(crate) fn close_too(&mut self, ids: &[ContactId]) -> bool {
        let before = self.closed.len();
        for id in ids {
            if let Err(at) = self.closed.binary_search(id) {
                self.closed.insert(at, *id);
            }
        }
        self.closed.len() > before
    }

    /// Ends the phase that was attempted.
    pub(crate) fn end_phase(
        &mut self,
        model: &Model<D>,
        from: &State,
        span: &StepSpan,
        outcome: Option<Outcome>,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        let energy = self.step.work(model, from, span, &self.stage, work);
        let phase = PhaseEnd::new(PhaseKind::Step, span.end, self.step.q_end(), self.step.v_end())
            .lasting(span.h)
            .with_energy(energy)
            .with_outcome(outcome);
        work.phase(model, &phase, Some(&mut self.stage))
    }

    /// Takes the sizes of a model; allocates nothing where they are the same.
    fn resize(&mut self, model: &Model<D>) {
        self.v_free.resize(model.size().v, 0.0);
        self.q_mid.resize(model.size().q, 0.0);
        self.guessed.resize(model.size().v, 0.0);
        self.q_tried.resize(model.size().q, 0.0);
        self.q_ahead.resize(model.size().q, 0.0);
        if self.rigid.len() != model.parts().len() {
            self.find_what_is_rigid(model);
        }
        // Only elastic surfaces have summits that move.
        if self.rigid.contains(&false) {
            self.rounds.resize(model.size().v);
        }
    }

    /// Finds frames and gaps at q̃_m and q̃ of the closed contacts that haven't been looked at in this step. q̃ is the end of the free motion;
    /// with a closed summit that of a motion with the velocities of the start, and later of the guess that was made. Contacts that close later
    /// in the step take the same.
    fn look_ahead(&mut self, model: &Model<D>, state: &State, h: f64, work: &mut Workspace<D>) -> Result<(), Mismatch> {
        let follows = self.follows_summits(model);
        // With the first summit all are looked at anew.
        if self.looked.is_empty() || (follows && !self.looked.iter().any(|id| model.detector().is_summit(*id))) {
            match follows {
                true => self.guessed.copy_from_slice(&state.v),
                false => self.guess_free_motion(state),
            }
            self.move_to_guess(model, state, h);
            self.locate_closed(model, work)?;
        } else {
            let Self { closed, looked, new, found, found_rooms, .. } = self;
            new.clear();
            new.extend(closed.iter().filter(|id| looked.binary_search(id).is_err()));
            let [middle, ahead] = &mut self.rooms;
            for (q, known, rooms) in [(&self.q_ahead, &mut self.ahead, ahead), (&self.q_mid, &mut self.middle, middle)]
            {
                work.locate_past_ends(model, q, new, found, found_rooms)?;
                merge(known, rooms, found, found_rooms);
            }
        }
        self.looked.clone_from(&self.closed);
        Ok(())
    }

    /// Finds frames and gaps of all closed contacts at q̃_m and q̃.
    fn locate_closed(&mut self, model: &Model<D>, work: &mut Workspace<D>) -> Result<(), Mismatch> {
        work.locate_past_ends(model, &self.q_ahead, &self.closed, &mut self.ahead, &mut self.rooms[1])?;
        work.locate_past_ends(model, &self.q_mid, &self.closed, &mut self.middle, &mut self.rooms[0])
    }

    /// Whether contact `i` of an attempt of `h` (s) may be past the end of its surface after it. It
    /// is if it was at q̃, unless impulses have moved it since, from the free motion or from the guess: by
    /// no more than the slides that are summed here, so that twice their sum leaves room for turns.
    pub(crate) fn may_leave(&self, i: usize, h: f64) -> bool {
        let Ok(at) = self.ahead.binary_search_by_key(&self.stage.contacts()[i].id, |ahead| ahead.id) else {
            return true;
        };
        if self.rooms[1][at] == f64::INFINITY {
            return false;
        }
        let slide = |v: &[f64]| {
            self.stage.velocity(i, v).map_or(f64::INFINITY, |u| u.iter().skip(1).map(|u_t| u_t.abs()).sum::<f64>())
        };
        self.rooms[1][at] <= 2.0 * h * (slide(self.step.v_end()) + slide(&self.v_free) + slide(&self.guessed))
    }

    /// Finds which of the step's contacts are closed in the next.
    pub(crate) fn find_what_stays(&mut self) {
        self.stays.clear();
        for (i, contact) in self.stage.contacts().iter().enumerate() {
            let stays = match contact.gap_after {
                Some(gap) => gap < 0.0,
                None => {
                    let leaves = match self.stage.problem.rule(i) {
                        // What comes back is found in expansion.
                        Rule::Poisson { .. } => contact.u_after[0] + self.resting_shift[i],
                        // U_n¹ = −s_n where it presses: by s_n itself, as at rest a velocity is all
                        // rounding and solver's error.
                        _ => self.resting_shift[i] - self.stage.problem.shift(i)[0],
                    };
                    let speed = |v: &[f64]| self.stage.speed(i, v);
                    let still = || LEAVING * speed(self.step.v_end()).max(speed(&self.v_free));
                    contact.p[0] > 0.0 && (leaves <= 0.0 || leaves <= still())
                }
            };
            self.stays.push(stays);
        }
    }

    /// Whether a contact of the last solve has opened by the end of the step, beyond rounding.
    pub(crate) fn has_opened(&self, i: usize) -> bool {
        let contact = &self.stage.contacts()[i];
        !self.stays[i] && leaves(contact.u_after[0], || self.stage.speed(i, self.step.v_end()))
    }

    /// Finds the impulses of the closed contacts: leaves v¹ in the step.
    fn solve(
        &mut self,
        model: &Model<D>,
        state: &State,
        span: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<Option<Outcome>, ContactError> {
        self.step.restart(&self.v_free);
        self.stage.clear();
        self.resting_shift.clear();
        self.slides.clear();
        if self.closed.is_empty() {
            return Ok(None);
        }
        self.stage.make_room(self.middle.len());
        self.stage.belong_to(model);
        let middle = std::mem::take(&mut self.middle);
        let rooms = std::mem::take(&mut self.rooms[0]);
        let past = self.goes_past_ends;
        let present =
            middle.iter().zip(&rooms).filter(|(_, room)| past || **room >= 0.0).map(|(candidate, _)| candidate);
        let some_past = past && rooms.iter().any(|room| *room < 0.0);
        let posed = self.stage.springs.hand_over(model, state, present.clone(), some_past, work).and_then(|()| {
            present.into_iter().try_for_each(|candidate| match self.stage.springs.leaves_out(candidate.id) {
                true => Ok(()),
                false => self.pose(model, state, span.h, work, candidate),
            })
        });
        (self.middle, self.rooms[0]) = (middle, rooms);
        posed?;
        let (over, responses) = (Over::Step { h: span.h, weight: THETA }, self.step.responses(span.h));
        self.guarded.restart(self.stage.len());
        self.stage.start_from(&self.tried);
        let (guarded, v_free) = (&mut self.guarded, &self.v_free);
        // Each round guards one contact more at least, so it ends.
        let outcome = self.stage.solve_guarded(model, work, &responses, over, |stage, problem, laws, members| {
            let guard = Guard { model, stage, laws, members, v_before: &state.v, v_free };
            Ok(guard.apply(problem, guarded)?)
        })?;
        // Of islands that were solved in an attempt before, too.
        self.guarded.take_over(&self.stage.problem);
        self.step.respond(model, &self.stage, span.h, work)?;
        self.stage.complete(self.step.v_end())?;
        self.tried.clear();
        if self.stage.len() > FEW {
            for (contact, p) in self.stage.contacts().iter().zip(&self.stage.problem.p) {
                self.tried.push(contact.id, p);
            }
        }
        Ok(outcome)
    }

    fn pose(
        &mut self,
        model: &Model<D>,
        state: &State,
        h: f64,
        work: &mut Workspace<D>,
        candidate: &Candidate<D>,
    ) -> Result<(), Mismatch> {
        let law = model.law_of(candidate.law)?;
        let i = self.stage.len();
        if !self.stage.take_in(model, &self.q_mid, candidate, &state.warm, &state.memory)? {
            return Ok(());
        }
        let [u_before, u_free] = self.stage.rows.velocities(i, [&state.v, &self.v_free]);
        // Off the end of its surface by then, it has no frame there.
        let b = match find(&self.ahead, candidate.id) {
            Some(ahead) => {
                self.row.clear();
                self.row.push(model, &self.q_ahead, &model.in_one_place(&self.q_ahead, ahead))?;
                match self.row.last_is_prescribed(model) {
                    true => Vector::zeros(),
                    false => self.row.velocity(0, &state.v) - u_before,
                }
            }
            None => Vector::zeros(),
        };
        let (before_t, b_t) = (tangential(&u_before), tangential(&b));
        let mut shift = if (before_t - b_t).norm() <= b_t.norm() { before_t } else { b_t };
        shift[0] = if (u_before[0] - b[0]).abs() <= b[0].abs() { u_before[0] } else { b[0].max(u_before[0]) };
        let mut persisting = self.stage.contacts()[i].persisting;
        if !persisting && u_before[0] < 0.0 {
            let turned = self.turns_onto_a_side(model, candidate.id, u_before[0], b[0]);
            // It goes along the side then, as if it had been there before.
            (shift[0], persisting) = if turned { (b[0], true) } else { (0.0, false) };
        }
        self.resting_shift.push(shift[0]);
        self.slides.push(before_t - tangential(&shift));
        let rule = if law.impact.spring().is_some() {
            let gap = match self.stage.springs.kept_gap(candidate.id, &state.memory) {
                Some(gap) => gap,
                None => self.gap_at_start(model, state, work, candidate.id)?.max(0.0),
            };
            shift[0] = 0.0;
            SpringStep::new(&law.impact, gap, u_before[0], h, THETA).map_or(Rule::Shifted, Rule::Spring)
        } else {
            let whole = match self.of_step {
                1.0 => u_free,
                part => u_before + (u_free - u_before) / part,
            };
            restitute(persisting, law, &u_before, &whole, &mut shift)
        };
        self.stage.set(i, u_before, u_free, shift, rule)
    }

    /// Whether a contact that closes, with normal velocity `u` at q̃_m, does so by the turning of its frame up to q̃ alone, by which its normal
    /// velocity changes by `b` (m/s): as of a disc that rolls from one block onto the next, flush with it, over whose corner it is at
    /// q̃_m, and over whose side at q̃. When it touched, it was just there, and there was no impact.
    fn turns_onto_a_side(&mut self, model: &Model<D>, id: ContactId, u: f64, b: f64) -> bool {
        if !(b >= TURNED * -u) {
            return false;
        }
        let [middle, ahead] = &mut self.pieces;
        for (q, pieces) in [(&self.q_mid, &mut *middle), (&self.q_ahead, &mut *ahead)] {
            model.detector().pieces(&model.placed_at(q), &[id], pieces);
        }
        middle != ahead
    }

    /// The gap of a contact at q⁰, m; 0 where it has none. Only a step with a new contact pays for
    /// looking there.
    fn gap_at_start(
        &mut self,
        model: &Model<D>,
        state: &State,
        work: &mut Workspace<D>,
        id: ContactId,
    ) -> Result<f64, Mismatch> {
        work.locate(model, &state.q, &[id], &mut self.start)?;
        Ok(self.start.first().map_or(0.0, |candidate| candidate.gap))
    }

    /// Finds the open contacts that the attempt ends with deeper in their surface than a tolerance (m), without those that graze; they are the
    /// workspace's candidates.
    pub(crate) fn find_new(
        &mut self,
        model: &Model<D>,
        tolerance: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        self.new.clear();
        let deep = work.candidates.iter().filter(|candidate| candidate.gap < -tolerance).map(|deep| deep.id);
        self.new.extend(deep.filter(|id| self.closed.binary_search(id).is_err()));
        self.grazing.leave_out(model, self.step.q_end(), tolerance, &mut self.new, work)
    }

    /// Closes the open contacts that the attempt ends with in their surface (they are the
    /// workspace's candidates), deeper than they began; whether there are any.
    fn close_what_sinks(&mut self, model: &Model<D>, state: &State, work: &mut Workspace<D>) -> Result<bool, Mismatch> {
        let before = self.closed.len();
        self.find_new(model, self.gap_tolerance, work)?;
        if self.new.is_empty() {
            return Ok(false);
        }
        work.locate(model, &state.q, &self.new, &mut self.start)?;
        for id in &self.new {
            let gap = |candidates: &[Candidate<D>]| find(candidates, *id).map_or(0.0, |candidate| candidate.gap);
            // A spring may have to go on for another one that rebounds.
            let has_spring = find(&work.candidates, *id).is_some_and(|deep| model.spring(deep.law).is_some());
            let began = if has_spring { 0.0 } else { gap(&self.start).min(0.0) };
            if gap(&work.candidates) < began - SINKING * self.gap_tolerance {
                self.closed.push(*id);
            }
        }
        let found = self.closed.len() > before;
        self.closed.sort_unstable();
        Ok(found)
    }
}

/// Whether a contact with this normal velocity (m/s) leaves, beyond the rounding of a velocity of
/// this size.
pub(crate) fn leaves(u: f64, speed: impl Fn() -> f64) -> bool {
    u > 0.0 && u > LEAVING * speed()
}

/// Puts restitution into the shift of a contact that closes with an impact; returns its rule.
pub(crate) fn restitute<const D: usize>(
    persisting: bool,
    law: &PairLaw,
    u_before: &Vector<D>,
    u_free: &Vector<D>,
    shift: &mut Vector<D>,
) -> Rule<D> {
    let e = law.restitution;
    let closing = !persisting && u_before[0] < 0.0;
    let tangential_restitution =
        if closing && is_impact(1.0, u_before, u_free) { law.tangential_restitution } else { 0.0 };
    if law.impact == ImpactLaw::Poisson {
        return Rule::Poisson { e, tangential: tangential_restitution };
    }
    let mut rule = Rule::Shifted;
    if closing && is_impact(e, u_before, u_free) {
        // Newton's law too: where it would make energy, less of it, before the guard has to bend
        // friction.
        rule = Rule::Energetic;
        shift[0] = e * u_before[0];
    }
    if tangential_restitution > 0.0 {
        let normal = shift[0];
        *shift = tangential(u_before) * tangential_restitution;
        shift[0] = normal;
    }
    rule
}

/// Puts what was found, none of which is known, among the `known`; both rise by identity.
fn merge<const D: usize>(known: &mut Candidates<D>, rooms: &mut Vec<f64>, found: &[Candidate<D>], found_rooms: &[f64]) {
    let (mut from, mut new) = (known.len(), found.len());
    known.extend_from_slice(found);
    rooms.extend_from_slice(found_rooms);
    // From the end: what is written over has been moved already.
    for to in (0..known.len()).rev() {
        if new == 0 {
            break;
        }
        if from > 0 && known[from - 1].id > found[new - 1].id {
            from -= 1;
            (known[to], rooms[to]) = (known[from], rooms[from]);
        } else {
            new -= 1;
            (known[to], rooms[to]) = (found[new], found_rooms[new]);
        }
    }
}

pub(crate) fn find<const D: usize>(candidates: &[Candidate<D>], id: ContactId) -> Option<&Candidate<D>> {
    candidates.binary_search_by_key(&id, |candidate| candidate.id).ok().map(|at| &candidates[at])
}
