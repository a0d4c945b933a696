//! What keeps the contacts of a closed step from giving energy.

use crate::contact::tangential;
use crate::laws::{Laws, is_impact};
use crate::stage::{Members, Problem};
use crate::{ContactStage, Mismatch, Model, Rule};

/// Rounding of a contact's work, as a part of ‖p‖ Σ|J_i v|, the larger of v⁰ and v_free.
const WORKLESS: f64 = 1e-13;

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
    /// It is the sum over the contacts of the same two bodies that counts: how two feet that stick
    /// share the friction between them is any solver's choice, so one may seem to gain what the
    /// other one loses.
    ///
    /// Where Poisson's law hands a blow on, what one contact gains another one has lost: there the
    /// sum is over all contacts that feel each other. The law scales what it gives back by it, so
    /// what is left is of contacts that would give energy without any restitution, too.
    pub(crate) fn apply(&self, problem: &mut Problem<D>, guarded: &mut [bool]) -> Result<bool, Mismatch> {
        let laws = self.laws;
        let mut found = false;
        // Usually none does, and then nothing is summed over the neighbours of each.
        let any_phased = problem.rules().any(|rule| matches!(rule, Rule::Poisson { .. }));
        for i in 0..problem.len() {
            let (number, u_before, p) = (self.members.number(i), problem.u_before(i), problem.p[i]);
            // A spring's law sees to it itself.
            if guarded[number] || p[0] <= 0.0 || matches!(problem.rule(i), Rule::Spring(_)) {
                continue;
            }
            // What moves as prescribed gives energy anyway, and a slide that ends there is better
            // stopped where it ends.
            let contact = &self.stage.contacts()[number];
            if contact.persisting && self.stage.feels_drive(self.model, number, self.v_before, self.v_free) {
                continue;
            }
            let rounding = self.rounding(problem, i);
            let gains = if any_phased && laws.handed_on(problem, i) {
                let allowed: f64 = (0..problem.len()).map(|i| self.rounding(problem, i)).sum();
                laws.work_around(problem, i) > allowed && laws.work_unreturned(i) > rounding
            } else {
                problem.work(i) > rounding && self.pair_gains(problem, i)
            };
            if !gains {
                continue;
            }
            let frees = problem.without_own_friction(i).norm() < tangential(&u_before).norm();
            if frees {
                problem.mu[i] = 0.0;
            }
            self.shift_back(problem, i)?;
            guarded[number] = true;
            found = true;
            if frees {
                continue;
            }
            // The feet of one body go along together: were one turned about and the other not, nothing would fit both.
            for j in self.beside(problem.len(), i) {
                let (other, contact) = (self.members.number(j), &self.stage.contacts()[self.members.number(j)]);
                let slides = matches!(problem.rule(j), Rule::Shifted) && contact.persisting && problem.p[j][0] > 0.0;
                if slides && !guarded[other] {
                    self.shift_back(problem, j)?;
                    guarded[other] = true;
                }
            }
        }
        Ok(found || self.stop_handing_on(problem))
    }

    /// The other contacts between the bodies of contact `i`. They follow each other, as contacts are
    /// in order of identity.
    fn beside(&self, contacts: usize, i: usize) -> impl Iterator<Item = usize> {
        let bodies = |j: usize| self.stage.contacts()[self.members.number(j)].sides.map(|side| side.body);
        let beside = move |j: &usize| bodies(*j) == bodies(i);
        (0..i).rev().take_while(beside).chain((i + 1..contacts).take_while(beside))
    }

    /// Whether the contacts between the bodies of contact `i` give energy together.
    fn pair_gains(&self, problem: &Problem<D>, i: usize) -> bool {
        let (mut gain, mut allowed) = (problem.work(i), self.rounding(problem, i));
        for j in self.beside(problem.len(), i).filter(|&j| !matches!(problem.rule(j), Rule::Spring(_))) {
            gain += problem.work(j);
            allowed += self.rounding(problem, j);
        }
        gain > allowed
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
