//! What keeps the contacts of a closed step from giving energy.

use crate::contact::tangential;
use crate::laws::{Laws, is_impact};
use crate::stage::{Members, Problem};
use crate::{ContactStage, Mismatch, Model, Rule};

/// Rounding of a contact's work, as a part of ‖p‖ Σ|J_i v|, the larger of v⁰ and v_free.
const WORKLESS: f64 = 1e-13;

/// How much of a contact's gain the loss of others excuses, as a part of the kinetic energy that their velocities carry: feet that land
/// flat stay below 400 at μ = 1000, a block jammed in a beam goes to 10⁷, of which the rounding alone shows in the energy's account.
const EXCUSED: f64 = 1e3;

/// The contacts of a stage that are guarded, by their numbers, and memory for finding those that feel each other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Guarded {
    pub(crate) contacts: Vec<bool>,
    island: Vec<bool>,
    reached: Vec<u32>,
    /// Of each contact of a problem the work that it is excused, J; NaN where it isn't known.
    excused: Vec<f64>,
}

impl Guarded {
    pub(crate) fn reserve(&mut self, contacts: usize) {
        for marks in [&mut self.contacts, &mut self.island] {
            marks.reserve(contacts.saturating_sub(marks.len()));
        }
        self.reached.reserve(contacts.saturating_sub(self.reached.len()));
        self.excused.reserve(contacts.saturating_sub(self.excused.len()));
    }

    /// Those that are guarded in a solved problem of all contacts.
    pub(crate) fn take_over<const D: usize>(&mut self, problem: &Problem<D>) {
        for (guarded, posed) in self.contacts.iter_mut().zip(&problem.posed) {
            *guarded |= posed.guarded;
        }
    }

    /// None is, of so many.
    pub(crate) fn restart(&mut self, contacts: usize) {
        self.contacts.clear();
        self.contacts.resize(contacts, false);
    }
}

/// Sees to it that no contact of a solved problem gives energy.
pub(crate) struct Guard<'a, const D: usize> {
    pub(crate) model: &'a Model<D>,
    pub(crate) stage: &'a ContactStage<D>,
    pub(crate) laws: &'a Laws<D>,
    pub(crate) members: Members<'a>,
    pub(crate) v_before: &'a [f64],
    pub(crate) v_free: &'a [f64],
}

impl<const D: usize> Guard<'_, D> {
    /// Changes what holds for contacts whose work is positive, so that it can't be; whether there
    /// are any.
    ///
    /// The usual case is a slide that turns within the step: sticking at its end would take an
    /// impulse along the slide that was. Then either no friction, or the velocity turned about,
    /// whichever ends nearer to rest; it sticks in the next step.
    ///
    /// It is the sum over contacts that feel each other that counts. How feet that stick share the friction between them, and bodies
    /// that lean on each other, is any solver's choice: one may seem to gain what another one loses. And where Poisson's law hands a
    /// blow on, one does. That law scales what it gives back by the sum, so what is left there is of contacts that would give energy
    /// without any restitution, too.
    pub(crate) fn apply(&self, problem: &mut Problem<D>, guarded: &mut Guarded) -> Result<bool, Mismatch> {
        let laws = self.laws;
        let mut found = false;
        guarded.excused.clear();
        guarded.excused.resize(problem.len(), f64::NAN);
        // Usually none does, and then nothing is summed over the neighbours of each.
        let any_phased = problem.rules().any(|rule| matches!(rule, Rule::Poisson { .. }));
        for i in 0..problem.len() {
            let (number, u_before, p) = (self.members.number(i), problem.u_before(i), problem.p[i]);
            // A spring's law sees to it itself.
            if guarded.contacts[number] || p[0] <= 0.0 || matches!(problem.rule(i), Rule::Spring(_)) {
                continue;
            }
            // What moves as prescribed gives energy anyway, and a slide that ends there is better
            // stopped where it ends.
            let contact = &self.stage.contacts()[number];
            if contact.persisting && self.stage.feels_drive(self.model, number, self.v_before, self.v_free) {
                continue;
            }
            let gains = if any_phased && laws.handed_on(problem, i) {
                let allowed: f64 = (0..problem.len()).map(|i| self.rounding(problem, i)).sum();
                laws.work_around(problem, i) > allowed && laws.work_unreturned(i) > self.rounding(problem, i)
            } else {
                let gain = problem.work(i);
                // Usually none, and then nobody asks for its rounding.
                gain > 0.0 && gain > self.rounding(problem, i) && gain > self.excused(problem, i, guarded)
            };
            if !gains {
                continue;
            }
            let frees = problem.without_own_friction(i).norm() < tangential(&u_before).norm();
            if frees {
                problem.mu[i] = 0.0;
            }
            self.shift_back(problem, i)?;
            (guarded.contacts[number], problem.posed[i].guarded) = (true, true);
            found = true;
            if frees {
                continue;
            }
            // The feet of one body go along together: were one turned about and the other not, nothing would fit both.
            for j in self.beside(problem.len(), i) {
                let (other, contact) = (self.members.number(j), &self.stage.contacts()[self.members.number(j)]);
                let slides = matches!(problem.rule(j), Rule::Shifted) && contact.persisting && problem.p[j][0] > 0.0;
                if slides && !guarded.contacts[other] {
                    self.shift_back(problem, j)?;
                    (guarded.contacts[other], problem.posed[j].guarded) = (true, true);
                }
            }
        }
        Ok(found || self.stop_handing_on(problem))
    }

    /// The other contacts between the bodies of contact `i`. They follow each other, as contacts are in order of identity.
    fn beside(&self, contacts: usize, i: usize) -> impl Iterator<Item = usize> {
        let bodies = |j: usize| self.stage.contacts()[self.members.number(j)].sides.map(|side| side.body);
        let beside = move |j: &usize| bodies(*j) == bodies(i);
        (0..i).rev().take_while(beside).chain((i + 1..contacts).take_while(beside))
    }

    /// Up to which work a contact may give, as others that feel it lose as much, J: none if they give energy together, else what the
    /// motion there accounts for; more is a jam, as in a wedge. Found once for each island.
    fn excused(&self, problem: &Problem<D>, i: usize, guarded: &mut Guarded) -> f64 {
        if guarded.excused[i].is_nan() {
            problem.mark_island(i, &mut guarded.island, &mut guarded.reached);
            let (mut gain, mut allowed, mut carried) = (0.0, 0.0, 0.0);
            let members = || (0..problem.len()).filter(|&j| guarded.island[j]);
            for j in members().filter(|&j| !matches!(problem.rule(j), Rule::Spring(_))) {
                gain += problem.work(j);
                allowed += self.rounding(problem, j);
                carried += problem.carried(j);
            }
            let excused = if gain > allowed { 0.0 } else { EXCUSED * carried };
            for j in members() {
                guarded.excused[j] = excused;
            }
        }
        guarded.excused[i]
    }

    /// Gives contact `i` the shift with which no sticking can be along its slide.
    fn shift_back(&self, problem: &mut Problem<D>, i: usize) -> Result<(), Mismatch> {
        let (u_before, contact) = (problem.u_before(i), &self.stage.contacts()[self.members.number(i)]);
        let e = self.model.law(contact.law)?.restitution;
        let back = match problem.rule(i) {
            Rule::Poisson { .. } if is_impact(e, &u_before, &problem.u_free(i)) => e * u_before[0],
            _ => problem.shift(i)[0],
        };
        let mut shift = tangential(&u_before);
        shift[0] = back.max(u_before[0]);
        problem.posed[i].rule = Rule::Shifted;
        problem.reshift(i, shift);
        Ok(())
    }

    /// What may be rounding of a contact's work, J: at rest it is the free velocity whose digits
    /// are lost.
    fn rounding(&self, problem: &Problem<D>, i: usize) -> f64 {
        let number = self.members.number(i);
        let speed = self.stage.speed(number, self.v_before).max(self.stage.speed(number, self.v_free));
        WORKLESS * problem.p[i].norm() * speed
    }

    /// The last resort where contacts that hand a blow on give energy though none does by itself,
    /// as the solver finds another one of several solutions each time: nothing is given back there.
    /// Whether it changed anything.
    fn stop_handing_on(&self, problem: &mut Problem<D>) -> bool {
        let (laws, n) = (self.laws, problem.len());
        let allowed = |i: usize| self.rounding(problem, i) + laws.work_unreturned(i).max(0.0);
        let gives = |i: usize| {
            let phased = matches!(problem.rule(i), Rule::Poisson { .. }) && laws.handed_on(problem, i);
            phased && laws.work_around(problem, i) > (0..n).map(allowed).sum::<f64>()
        };
        let Some(first) = (0..n).find(|&i| gives(i)) else { return false };
        problem.posed[first].rule = Rule::Shifted;
        true
    }
}
