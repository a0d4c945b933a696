//! What was found for the islands of one attempt at a step, for the next attempt at it.
//!
//! A step is attempted anew where an open contact has to close. That changes the islands that the
//! contact joins and no other: the rest would be solved to the same impulses again. In a pile, where
//! a blow takes ten attempts to go through, that is most of the work.

use super::Problem;
use super::posed::Posed;
use crate::{Contact, Vector};
use teeter_contact::{Islands, Outcome};
use teeter_detect::ContactId;

/// A contact that wasn't there.
const NEW: usize = usize::MAX;

/// The contacts of the last attempt that was solved island by island, with what was found.
#[derive(Debug, Default)]
pub(super) struct Kept<const D: usize> {
    ids: Vec<ContactId>,
    /// Of each contact, its island.
    island: Vec<usize>,
    /// What each was posed with, before its island was solved; and those of the current attempt.
    given: Vec<(Posed<D>, f64)>,
    posed: Vec<(Posed<D>, f64)>,
    found: Vec<(Posed<D>, f64, Vector<D>)>,
    /// Of each island, its size and outcome.
    ended: Vec<(usize, Option<Outcome>)>,
    /// Of each contact of the current attempt, which of these it is.
    was: Vec<usize>,
}

impl<const D: usize> Kept<D> {
    /// Forgets everything: other motion, other rows.
    pub(super) fn forget(&mut self) {
        self.ids.clear();
        self.island.clear();
        self.given.clear();
        self.found.clear();
        self.ended.clear();
    }

    /// Finds the contacts of an attempt among those that are known, both of which rise, and keeps
    /// what they are posed with.
    pub(super) fn recognise(&mut self, contacts: &[Contact<D>], problem: &Problem<D>) {
        self.posed.clear();
        self.posed.extend(problem.posed.iter().copied().zip(problem.mu.iter().copied()));
        self.was.clear();
        let mut at = 0;
        for contact in contacts {
            while self.ids.get(at).is_some_and(|id| *id < contact.id) {
                at += 1;
            }
            self.was.push(if self.ids.get(at) == Some(&contact.id) { at } else { NEW });
        }
    }

    /// Puts into `problem`, of all contacts, what is known of an island with these members, and returns how it ended. `None` if
    /// it isn't an island of the last attempt, contact by contact, posed as it was there.
    pub(super) fn restore(&self, problem: &mut Problem<D>, members: &[usize]) -> Option<Outcome> {
        let of = |i: usize| self.island.get(*self.was.get(i)?).copied();
        let island = of(*members.first()?)?;
        let (size, outcome) = *self.ended.get(island)?;
        let same = |i: usize| of(i) == Some(island) && self.given[self.was[i]] == (problem.posed[i], problem.mu[i]);
        if size != members.len() || !members.iter().all(|&i| same(i)) {
            return None;
        }
        for &i in members {
            let (posed, mu, p) = self.found[self.was[i]];
            (problem.posed[i], problem.mu[i], problem.p[i]) = (posed, mu, p);
            problem.q[i] = posed.u_free + posed.shift;
        }
        outcome
    }

    /// Keeps what was found of the attempt that was [recognised](Self::recognise), in place of the one before.
    pub(super) fn keep(
        &mut self,
        contacts: &[Contact<D>],
        problem: &Problem<D>,
        islands: &Islands,
        ended: &[Option<Outcome>],
    ) {
        std::mem::swap(&mut self.given, &mut self.posed);
        self.ids.clear();
        self.ids.extend(contacts.iter().map(|contact| contact.id));
        self.found.clear();
        self.found.extend((0..problem.len()).map(|i| (problem.posed[i], problem.mu[i], problem.p[i])));
        self.island.clear();
        self.island.resize(problem.len(), 0);
        self.ended.clear();
        for (k, (members, outcome)) in islands.iter().zip(ended).enumerate() {
            members.iter().for_each(|&i| self.island[i] = k);
            self.ended.push((members.len(), *outcome));
        }
    }
}
