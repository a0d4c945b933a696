//! What contacts do from an event on.

use super::instant::Kind;
use super::modes::{Mode, Pressing};
use super::smooth::{MASSES, Smooth};
use super::{EventDriven, LOWEST_BOUNCE, after, still};
use crate::{
    ContactStage, Memory, Mismatch, Model, Over, Responses, Rule, State, StepError, Vector, WarmStart, Workspace,
};
use teeter_detect::Candidate;

/// What [`EventDriven::touching_gap`] is in tolerances of a gap.
const TOUCHING: f64 = 10.0;

/// Impacts at an instant at most: between contacts that send a body to and fro each is weaker than the one before by a tenth to a half.
const MOST_BLOWS: usize = 200;

/// What turns back within so many tolerances of a gap doesn't strike: the time of a touch is known to that.
const GRAZING: f64 = 4.0;

/// A tangential acceleration below this part of what it consists of is none.
const NONE: f64 = 1e-8;

/// A force or distance from the friction cone above this, in parts of its scale, still holds.
const HOLDS: f64 = -1e-7;

/// A normal acceleration is known to this part of what it consists of.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl EventDriven {
    /// Changes what the watched contacts do, after an event; whether a motion was found that goes on.
    pub(super) fn change_modes(
        &mut self,
        model: &Model<2>,
        from: &mut State,
        work: &mut Workspace<2>,
    ) -> Result<bool, StepError> {
        let mut simple = true;
        for k in 0..self.watched.len() {
            let watch = self.watched[k];
            if !watch.is_now {
                continue;
            }
            let contacts = &mut self.smooth.contacts;
            let at = contacts.iter().position(|contact| contact.id == watch.id);
            match (watch.kind, at) {
                (Kind::Opens | Kind::Leaves, Some(at)) => {
                    contacts.remove(at);
                }
                (Kind::Slips, Some(at)) => {
                    contacts[at].mode = Mode::Slide(-watch.side);
                }
                _ => simple = false,
            }
        }
        if simple {
            let t = after(from.t);
            self.smooth.between = [t, t];
            self.smooth.accelerate(model, t, &from.q, &from.v, work)?;
            if self.smooth.contacts.iter().all(|contact| contact.presses() >= HOLDS && contact.held >= HOLDS) {
                return Ok(true);
            }
        }
        self.decide(model, from, work)
    }

    /// Contacts with a gap of up to this touch, m.
    pub(super) fn touching_gap(&self, q: &[f64]) -> f64 {
        TOUCHING * self.located.tolerance(q)
    }

    /// Finds which of the contacts that touch press, and which of them stick; first lets those that
    /// approach strike. Whether there is a motion that goes on.
    pub(super) fn decide(
        &mut self,
        model: &Model<2>,
        from: &mut State,
        work: &mut Workspace<2>,
    ) -> Result<bool, StepError> {
        // Loads and drives are those from now on.
        let t = after(from.t);
        self.smooth.between = [t, t];
        self.v_before.copy_from_slice(&from.v);
        work.detect(model, &from.q, self.touching_gap(&from.q))?;
        if work.candidates.len() > EventDriven::MOST_CONTACTS {
            return Ok(false);
        }
        self.find_touching(model, from, work)?;
        if self.touching.is_empty() {
            self.smooth.contacts.clear();
            return Ok(true);
        }
        if self.touching.len() > EventDriven::MOST_CONTACTS {
            return Ok(false);
        }
        self.a_pressed.clear();
        if !self.smooth.contacts.is_empty() {
            self.smooth.accelerate(model, t, &from.q, &from.v, work)?;
            self.a_pressed.extend_from_slice(&self.smooth.a);
        }
        self.smooth.accelerate_freely(model, t, &from.q, &from.v, work)?;
        if !self.let_strike(model, from, work)? {
            return Ok(false);
        }
        self.returning.clear();
        // Each round holds one contact more, so it ends.
        loop {
            let found = self.find_who_presses(model, from, work)?;
            if !found || !self.find_who_returns(model, from)? {
                return Ok(found);
            }
            self.smooth.accelerate_freely(model, t, &from.q, &from.v, work)?;
        }
    }

    /// Lets the contacts that approach strike; then those that approach after that impact, as where a body is sent to and fro between two
    /// contacts over less than the resolution of gaps. Whether that ends.
    fn let_strike(&mut self, model: &Model<2>, from: &mut State, work: &mut Workspace<2>) -> Result<bool, StepError> {
        let t = self.smooth.between[0];
        for blow in 0..MOST_BLOWS {
            let Some(fastest) = self.approach(model, from, work)? else { return Ok(true) };
            // U²/2a is the height of a bounce.
            let height = LOWEST_BOUNCE * self.located.tolerance(&from.q);
            let time = (2.0 * height / fastest).sqrt();
            self.ids.clear();
            if blow == 0 {
                self.ids.extend(self.smooth.contacts.iter().map(|contact| contact.id));
                from.memory.forget_contacts();
                self.ids.iter().for_each(|id| from.memory.activate(*id));
                // Where several impulses satisfy the law, contacts go on as they did.
                from.warm.clear();
                self.smooth.contacts.iter().for_each(|contact| from.warm.push(contact.id, &(contact.force * time)));
            } else {
                self.ids.extend_from_slice(from.memory.active());
            }
            let by_forces = self.smooth.a.iter().map(|a| time * a);
            self.located.strike_by(model, from, &self.ids, by_forces, &self.in_lowest_bounce, work)?;
            from.warm.clear();
            self.smooth.accelerate_freely(model, t, &from.q, &from.v, work)?;
        }
        Ok(false)
    }

    /// The contacts that press and the candidates, which are as near.
    fn find_touching(&mut self, model: &Model<2>, from: &State, work: &mut Workspace<2>) -> Result<(), StepError> {
        self.ids.clear();
        self.ids.extend(self.smooth.contacts.iter().map(|contact| contact.id));
        work.locate(model, &from.q, &self.ids, &mut self.found)?;
        self.touching.clear();
        self.touching.extend_from_slice(&self.found);
        let is_new = |candidate: &&Candidate<2>| self.ids.binary_search(&candidate.id).is_err();
        self.touching.extend(work.candidates.iter().filter(is_new));
        self.touching.sort_unstable_by_key(|candidate| candidate.id);
        Ok(())
    }

    /// Where a contact that was open approaches: the largest normal acceleration of those that touch,
    /// m/s².
    fn approach(&mut self, model: &Model<2>, from: &State, work: &mut Workspace<2>) -> Result<Option<f64>, StepError> {
        let (mut approaches, mut fastest) = (false, f64::MIN_POSITIVE);
        let instant = self.instant(from);
        let height = LOWEST_BOUNCE * self.located.tolerance(&from.q);
        let grazing = GRAZING * self.located.tolerance(&from.q);
        self.in_lowest_bounce.clear();
        let smooth = &mut self.smooth;
        for candidate in &self.touching {
            smooth.stage.clear();
            if !smooth.stage.add(model, &from.q, candidate, &WarmStart::default(), &Memory::default())? {
                continue;
            }
            // Bodies that fall beside each other have none, to rounding, but where they turn.
            let rounding = ROUNDING * smooth.stage.speed(0, &smooth.a);
            let turning = smooth.turning(model, &from.q, work, 0, candidate)?;
            let a = towards(&smooth.stage, 0, [&smooth.a, &self.a_pressed])? + turning[0];
            fastest = a.abs().max(rounding).max(fastest);
            self.in_lowest_bounce.push((candidate.id, -velocity_after(height, -a)));
            let slow = still(smooth.stage.speed(0, &from.v), smooth.stage.speed(0, &smooth.a), instant);
            // What turns back before it is inside only grazes, as a rounded corner does when the flat side next to it has slid past.
            let slow = slow.max(velocity_after(grazing, a));
            approaches |= smooth.stage.velocity(0, &from.v)?[0] < -slow;
        }
        Ok(approaches.then_some(fastest))
    }

    /// Adds the contacts that part, but that those which press now would close again from less than the lowest bounce, to
    /// those that don't: two bodies that fall alike, one of which another foot of it pushes. Whether there are any.
    fn find_who_returns(&mut self, model: &Model<2>, from: &State) -> Result<bool, StepError> {
        let height = LOWEST_BOUNCE * self.located.tolerance(&from.q);
        let Smooth { one, a, contacts, .. } = &mut self.smooth;
        let before = self.returning.len();
        for (candidate, u, bias) in self.parting.iter().filter(|_| !contacts.is_empty()) {
            one.clear();
            if one.add(model, &from.q, candidate, &WarmStart::default(), &Memory::default())? {
                let acceleration = one.velocity(0, a)?[0] + bias;
                if *u <= velocity_after(height, -acceleration) {
                    self.returning.push(candidate.id);
                }
            }
        }
        Ok(self.returning.len() > before)
    }

    /// Solves the law over accelerations for the contacts that touch and don't part.
    fn find_who_presses(
        &mut self,
        model: &Model<2>,
        from: &mut State,
        work: &mut Workspace<2>,
    ) -> Result<bool, StepError> {
        let problem = |source| StepError::Problem { t: from.t, source };
        let height = LOWEST_BOUNCE * self.located.tolerance(&from.q);
        let instant = self.instant(from);
        let smooth = &mut self.smooth;
        smooth.stage.clear();
        self.found.clear();
        self.biases.clear();
        self.parting.clear();
        for candidate in &self.touching {
            let row = smooth.stage.len();
            if !smooth.stage.add(model, &from.q, candidate, &WarmStart::default(), &Memory::default())? {
                continue;
            }
            let u = smooth.stage.velocity(row, &from.v)?;
            let speed = smooth.stage.speed(row, &from.v).max(smooth.stage.speed(row, &self.v_before));
            let slow = still(speed, smooth.stage.speed(row, &smooth.a), instant);
            let bias = smooth.turning(model, &from.q, work, row, candidate)?;
            let free = towards(&smooth.stage, row, [&smooth.a, &self.a_pressed])? + bias[0];
            // What would come back from less than the lowest bounce stays.
            let returns = self.returning.contains(&candidate.id);
            if !returns && u[0] > slow.max(velocity_after(height, -free)) {
                self.parting.push((*candidate, u[0], bias[0]));
                smooth.stage.drop_last();
                continue;
            }
            self.found.push(*candidate);
            self.biases.push(bias);
        }
        smooth.contacts.clear();
        from.memory.forget_contacts();
        if self.found.is_empty() {
            return Ok(true);
        }
        smooth.posed.clear();
        for (row, &bias) in self.biases.iter().enumerate() {
            let stage = &smooth.stage;
            let u = stage.velocity(row, &from.v)?;
            let speed = stage.speed(row, &from.v).max(stage.speed(row, &self.v_before));
            let slow = still(speed, stage.speed(row, &smooth.a), instant);
            let slides = (u[1].abs() > slow).then(|| u[1].signum());
            let free = smooth.stage.velocity(row, &smooth.a)? + bias;
            let rule = slides.map_or(Rule::Shifted, |sign| Rule::SlidesAlong(Vector::<2>::new(0.0, sign)));
            smooth.stage.set(row, u, free, Vector::zeros(), rule)?;
            let size = smooth.stage.speed(row, &smooth.a) + bias.norm();
            smooth.posed.push((bias, slides, size));
        }
        let responses = Responses::Of(MASSES);
        smooth.stage.couple(model, work, &responses).map_err(problem)?;
        for (row, (candidate, (_, slides, _))) in self.found.iter().zip(&smooth.posed).enumerate() {
            let own = smooth.stage.block(row, row);
            let along = slides.map_or(0.0, |sign| sign * own[(0, 1)]);
            // Painlevé's paradox: a push with the friction that belongs to it pulls the contact together. No acceleration, or several, fit the law.
            if own[(0, 0)] - model.law(candidate.law)?.friction * along <= 0.0 {
                return Ok(false);
            }
        }
        let outcome = smooth.stage.solve(model, work, &responses, Over::Acceleration).map_err(problem)?;
        if outcome.is_none_or(|outcome| !outcome.converged()) {
            return Ok(false);
        }
        smooth.stage.respond(model, work, &responses, &mut smooth.a).map_err(problem)?;
        let force = |row: usize| smooth.stage.impulse(row).map_or(0.0, |f| f[0]);
        let largest = (0..self.found.len()).map(force).fold(0.0, f64::max);
        smooth.contacts.reserve(self.found.len());
        for (row, (candidate, (bias, slides, size))) in self.found.iter().zip(&smooth.posed).enumerate() {
            if force(row) <= 1e-11 * largest {
                continue;
            }
            let friction = model.law(candidate.law)?.friction;
            let a = smooth.stage.velocity(row, &smooth.a)? + bias;
            let mode = match slides {
                Some(sign) => Mode::Slide(*sign),
                None if friction == 0.0 => Mode::Slide(1.0),
                None if a[1].abs() <= NONE * size => Mode::Stick,
                None => Mode::Slide(a[1].signum()),
            };
            let level = candidate.gap.min(0.0);
            smooth.contacts.push(Pressing::new(candidate.id, mode, level, friction));
            from.memory.activate(candidate.id);
        }
        Ok(true)
    }
}

/// The velocity after a fall from a height (m) with this acceleration (m/s²), m/s; 0 where it doesn't fall.
fn velocity_after(height: f64, acceleration: f64) -> f64 {
    (2.0 * height * acceleration.max(0.0)).sqrt()
}

/// The normal acceleration of a contact by forces, without those of contacts or with those of the ones that pressed so far, if any are
/// known: the one that closes it more, m/s².
fn towards(stage: &ContactStage<2>, row: usize, [free, pressed]: [&[f64]; 2]) -> Result<f64, Mismatch> {
    let free = stage.velocity(row, free)?[0];
    // Without a solution they aren't numbers.
    Ok(if pressed.is_empty() { free } else { free.min(stage.velocity(row, pressed)?[0]) })
}
