//! Frames in the middle of the motion itself, where an elastic surface comes out under a base.

use super::{ClosedStep, SINKING};
use crate::stage::RESERVED_CONTACTS;
use crate::step_motion::StepMotion;
use crate::{Contact, Mismatch, Model, State, Vector, Workspace};
use teeter_detect::ContactId;

/// Most rounds of an attempt; usually two to eight are enough.
const MOST_ROUNDS: usize = 24;

/// A round leads on where its frames change a gap by less than this part of the least change so far.
const SHRINKS: f64 = 0.5;

/// So many rounds in a row may lead nowhere.
const PATIENCE: usize = 4;

/// A relaxation beyond this comes from two rounds that agree to rounding.
const MOST_RELAXATION: f64 = 8.0;

/// How the frames of summits are found in one attempt: as the fixed point of the map from a guessed motion to the one that is found with the
/// frames in the middle of the guess.
#[derive(Debug)]
pub(super) struct Rounds<const D: usize> {
    count: usize,
    /// The least change of a gap over the step by frames of the motion found, m, and how many rounds since haven't halved it.
    least: f64,
    idle: usize,
    /// How far the next guess goes towards the motion that was found, as a part.
    relaxation: f64,
    /// The mean velocity of the motion that was found.
    mean: Vec<f64>,
    /// How far summits that press are in it, along their bases, from where the guess has them, m; and in the round before.
    ways: Vec<(ContactId, Vector<D>)>,
    ways_before: Vec<(ContactId, Vector<D>)>,
    /// Where one summit presses: the direction of its first way, and its way along it, m.
    direction: Vector<D>,
    way: Option<f64>,
    /// The way that has the other sign, of the guess `across`, m; halved where only the other end of the interval moves.
    way_across: Option<f64>,
    across: Vec<f64>,
    before: Vec<f64>,
    /// The guess whose frames changed least.
    best: Vec<f64>,
    /// Whether rounds have begun again, from the motion without impulses.
    again: bool,
}

impl<const D: usize> Default for Rounds<D> {
    fn default() -> Self {
        Self {
            count: 0,
            least: f64::INFINITY,
            idle: 0,
            relaxation: 1.0,
            mean: Vec::new(),
            ways: Vec::new(),
            ways_before: Vec::new(),
            direction: Vector::zeros(),
            way: None,
            way_across: None,
            across: Vec::new(),
            before: Vec::new(),
            best: Vec::new(),
            again: false,
        }
    }
}

impl<const D: usize> Rounds<D> {
    /// Takes the size of a model; allocates nothing where it is the same.
    pub(super) fn resize(&mut self, velocities: usize) {
        for v in [&mut self.mean, &mut self.across, &mut self.before, &mut self.best] {
            v.resize(velocities, 0.0);
        }
    }

    /// Makes room for so many contacts; of many, few are summits.
    pub(super) fn reserve(&mut self, contacts: usize) {
        let contacts = contacts.min(RESERVED_CONTACTS);
        self.ways.reserve(contacts);
        self.ways_before.reserve(contacts);
    }

    pub(super) fn begin(&mut self) {
        (self.count, self.least, self.again) = (0, f64::INFINITY, false);
        self.forget();
    }

    /// Begins again from another guess; the best of before counts.
    fn begin_again(&mut self) {
        (self.count, self.again) = (1, true);
        self.forget();
    }

    fn forget(&mut self) {
        (self.idle, self.relaxation) = (0, 1.0);
        self.ways_before.clear();
        (self.way, self.way_across) = (None, None);
    }

    /// Judges a guess by what its frames change (m), and makes the next one of it; whether there is one.
    fn guess_anew(&mut self, change: f64, guessed: &mut [f64]) -> bool {
        self.idle = if change <= SHRINKS * self.least { 0 } else { self.idle + 1 };
        if change < self.least {
            self.least = change;
            self.best.copy_from_slice(guessed);
        }
        self.learn(guessed);
        if !self.goes_on() {
            return false;
        }
        match (self.way, self.way_across) {
            // Written so that NaN fails too.
            (None, _) | (_, None) if !(self.relaxation.abs() <= MOST_RELAXATION) => return false,
            (Some(way), Some(way_across)) => {
                let part = way / (way - way_across);
                guessed
                    .iter_mut()
                    .zip(&self.across)
                    .for_each(|(guessed, across)| *guessed += part * (across - *guessed));
            }
            _ => guessed
                .iter_mut()
                .zip(&self.mean)
                .for_each(|(guessed, mean)| *guessed += self.relaxation * (mean - *guessed)),
        }
        true
    }

    /// Makes the next guess where a summit isn't there, or doesn't press, with the last one: halfway back to the best; whether there is one.
    fn guess_nearer(&mut self, guessed: &mut [f64]) -> bool {
        if !self.least.is_finite() {
            return false;
        }
        self.idle += 1;
        self.relaxation *= 0.5;
        guessed.iter_mut().zip(&self.best).for_each(|(guessed, best)| *guessed = 0.5 * (*guessed + best));
        self.goes_on()
    }

    fn goes_on(&mut self) -> bool {
        self.count += 1;
        self.idle <= PATIENCE && self.count <= MOST_ROUNDS
    }

    /// Learns from the ways of two rounds where the fixed point is.
    ///
    /// Over a surface that is nearly flat a summit moves by far more than what made it move: taken as it was found, each guess would be further off
    /// than the one before, to the other side. Where one summit presses, the fixed point is then between two guesses, and is found by the
    /// rule of false position, as amended at Illinois (Dowell and Jarratt 1971, doi 10.1007/BF01934364): however its way bends, as it does at a
    /// support. Else the step towards the motion found is relaxed as by Irons and Tuck (1969, doi 10.1002/nme.1620010306), with the sum
    /// of squares over the ways of all summits: velocities would tell of what trembles elsewhere.
    fn learn(&mut self, guessed: &[f64]) {
        let same = self.ways.iter().map(|(id, _)| id).eq(self.ways_before.iter().map(|(id, _)| id));
        let way = match self.ways[..] {
            [(_, way)] => {
                if !same {
                    (self.direction, self.way, self.way_across) = (way, None, None);
                }
                Some(way.dot(&self.direction))
            }
            _ => None,
        };
        if !same {
            self.relaxation = 1.0;
        } else if self.way_across.is_none() {
            let (mut along, mut square) = (0.0, 0.0);
            for ((_, way), (_, before)) in self.ways.iter().zip(&self.ways_before) {
                let change = way - before;
                along += before.dot(&change);
                square += change.norm_squared();
            }
            if square > 0.0 {
                self.relaxation *= -along / square;
            }
        }
        match (way, self.way) {
            (Some(way), Some(before)) if way * before < 0.0 => {
                std::mem::swap(&mut self.across, &mut self.before);
                self.way_across = Some(before);
            }
            (Some(_), Some(_)) => self.way_across = self.way_across.map(|way| 0.5 * way),
            _ => self.way_across = None,
        }
        self.way = way;
        self.before.copy_from_slice(guessed);
        std::mem::swap(&mut self.ways, &mut self.ways_before);
    }
}

impl<const D: usize, M: StepMotion<D>> ClosedStep<D, M> {
    /// Whether the first frames of a step are those of a motion with the velocities of its start: where a summit is closed. Without impulses a base may
    /// sink in so far beside it that it isn't one any more.
    pub(super) fn follows_summits(&self, model: &Model<D>) -> bool {
        let mut closed = self.closed.iter();
        !self.summits_lost && self.rigid.contains(&false) && closed.any(|id| model.detector().is_summit(*id))
    }

    pub(super) fn move_to_guess(&mut self, model: &Model<D>, from: &State, h: f64) {
        model.move_along(&from.q, &self.guessed, h, &mut self.q_ahead);
        model.move_along(&from.q, &self.guessed, 0.5 * h, &mut self.q_mid);
    }

    /// Guesses ½(v⁰ + v_free), the mean velocity of the free motion.
    pub(super) fn guess_free_motion(&mut self, from: &State) {
        let both = self.v_free.iter().zip(&from.v);
        self.guessed.iter_mut().zip(both).for_each(|(v, (free, v0))| *v = 0.5 * (free + v0));
    }

    /// Takes frames and gaps of all closed contacts from a motion nearer to the one that was found, where the frame of a summit that presses
    /// differs there so much that its gap changes over the step by more than rounding. Where such rounds lead nowhere, they begin again from the motion without
    /// impulses: a surface that is straight in the first guess has no summit but by rounding, and shows it where the base would sink in. Where these fail, too, the
    /// frames of the best guess are taken, for the last time; where none presses, those of the motion without impulses. Whether it took any: the step is then to be solved again.
    ///
    /// Were all those of the motion without impulses: where a load presses, a summit is elsewhere there, always to the same side, and as
    /// its frame turns with its place, each tremor of the surface lets the base sink in. That sets free energy, which keeps the tremor alive,
    /// and with it the sinking. With a frame in the middle of the motion itself, what the gap is off by has no sign, and what trembles dies down.
    pub(super) fn takes_frames_of_summits(
        &mut self,
        model: &Model<D>,
        from: &State,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<bool, Mismatch> {
        if !self.follows_summits(model) {
            return Ok(false);
        }
        self.summits.clear();
        // One that is struck in this step is left out.
        let goes_on = |contact: &&Contact<D>| contact.p[0] > 0.0 && (contact.persisting || contact.u_before[0] >= 0.0);
        let pressing = self.stage.contacts().iter().filter(goes_on).map(|contact| contact.id);
        self.summits.extend(pressing.filter(|id| model.detector().is_summit(*id)));
        let change = if self.summits.is_empty() { None } else { self.change_of_frames(model, from, h, work)? };
        let Self { rounds, guessed, .. } = self;
        let goes_on = match change {
            // The first frames are a guess, and what each step left of its error would accumulate.
            Some(0.0) => return Ok(false),
            Some(change) if rounds.count > 0 && change <= SINKING * self.gap_tolerance => return Ok(false),
            // As good as rounding allows.
            Some(change) if change <= self.gap_tolerance && rounds.idle >= 2 && change > SHRINKS * rounds.least => {
                return Ok(false);
            }
            Some(change) => rounds.guess_anew(change, guessed),
            None => rounds.guess_nearer(guessed),
        };
        let is_known = rounds.least.is_finite();
        if is_known && !goes_on && !rounds.again {
            rounds.begin_again();
            self.guess_free_motion(from);
        } else if is_known && !goes_on {
            self.summits_lost = true;
            guessed.copy_from_slice(&rounds.best);
        }
        if is_known {
            self.move_to_guess(model, from, h);
            self.locate_closed(model, work)?;
        } else {
            self.summits_lost = true;
            self.looked.clear();
            self.look_ahead(model, from, h, work)?;
        }
        self.stage.keep_islands_anew();
        Ok(true)
    }

    /// The most by which frames in the middle of the motion that was found change the gap of a summit over the step, m; `None` where one is no
    /// summit there. Leaves in the rounds how far they are from where the guess has them.
    fn change_of_frames(
        &mut self,
        model: &Model<D>,
        from: &State,
        h: f64,
        work: &mut Workspace<D>,
    ) -> Result<Option<f64>, Mismatch> {
        let Self { step, q_tried, rounds, .. } = self;
        rounds.mean.iter_mut().zip(step.v_end()).zip(&from.v).for_each(|((mean, v1), v0)| *mean = 0.5 * (v1 + v0));
        model.move_along(&from.q, &rounds.mean, 0.5 * h, q_tried);
        work.locate(model, q_tried, &self.summits, &mut self.found)?;
        if self.found.len() < self.summits.len() {
            return Ok(None);
        }
        rounds.ways.clear();
        let mut most = 0.0_f64;
        for contact in self.stage.contacts() {
            let Some(candidate) = super::find(&self.found, contact.id) else { continue };
            self.row.clear();
            self.row.push(model, q_tried, candidate)?;
            let taken = 0.5 * (contact.u_before[0] + contact.u_after[0]);
            most = most.max(h * (self.row.velocity(0, &rounds.mean)[0] - taken).abs());
            if let Some(guessed) = super::find(&self.middle, contact.id) {
                rounds.ways.push((contact.id, candidate.sides[0].point - guessed.sides[0].point));
            }
        }
        Ok(Some(most))
    }
}
