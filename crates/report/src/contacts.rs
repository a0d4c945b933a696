//! The rows of `contacts.csv`: impulses of each contact added up since the last written row.

use crate::number::{push, push_next};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use teeter_detect::{Candidate, ContactId};
use teeter_integrator::{Balance, Contact, ContactState, Model, State, Vector};
use teeter_scenario::simulation::{ContactNames, Layout};

pub(crate) const HEADER: &str = "t,contact,a,b,point,gap,p_n,p_t,u_n,u_t,state,slip\n";

/// By how much a contact slips in a phase of this duration (s), m: the mean of its tangential velocity, as the phase takes
/// means, times the duration, while it presses. What sticks slips by nothing but rounding.
#[inline]
pub(crate) fn slip(contact: &Contact<2>, duration: f64, balance: Balance) -> f64 {
    if contact.p[0] <= 0.0 {
        return 0.0;
    }
    let weight = balance.weight();
    duration * (weight * contact.u_after[1] + (1.0 - weight) * contact.u_before[1])
}

/// Impulses since the last row, by contact.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Impulses {
    /// In order of identity.
    sums: Vec<(ContactId, Vector<2>)>,
    /// How far each contact has slipped since the start, m, in order of identity. A point has several where it goes from side to side.
    slips: Vec<(ContactId, f64)>,
    /// Memory of a row.
    #[serde(skip)]
    candidates: Vec<Candidate<2>>,
    /// The contacts of the last step and their places in it, in order.
    #[serde(skip)]
    now: Vec<(ContactId, usize)>,
    #[serde(skip)]
    ids: Vec<ContactId>,
}

/// What a contact does at the end of a step.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct AtEnd {
    id: ContactId,
    /// Its relative velocity, m/s.
    u: Vector<2>,
    does: ContactState,
}

impl AtEnd {
    #[inline]
    pub(crate) fn of(contact: &Contact<2>) -> Self {
        Self { id: contact.id, u: contact.u_after, does: contact.state() }
    }
}

impl Impulses {
    /// Adds the contacts of a phase of this duration, s.
    #[inline]
    pub(crate) fn add(&mut self, contacts: &[Contact<2>], duration: f64, balance: Balance) {
        for (number, contact) in contacts.iter().enumerate() {
            let slip = slip(contact, duration, balance);
            if let Some((_, sum)) = self.slips.get_mut(number).filter(|(id, _)| *id == contact.id) {
                *sum += slip;
                continue;
            }
            match self.slips.binary_search_by_key(&contact.id, |(id, _)| *id) {
                Ok(at) => self.slips[at].1 += slip,
                // Of the many that only come near there is nothing to keep.
                Err(at) if slip != 0.0 => self.slips.insert(at, (contact.id, slip)),
                Err(_) => {}
            }
        }
        for (number, contact) in contacts.iter().enumerate() {
            // Usually it has the place that it had in the step before.
            if let Some((_, sum)) = self.sums.get_mut(number).filter(|(id, _)| *id == contact.id) {
                *sum += contact.p;
                continue;
            }
            match self.sums.binary_search_by_key(&contact.id, |(id, _)| *id) {
                Ok(at) => self.sums[at].1 += contact.p,
                Err(at) => self.sums.insert(at, (contact.id, Vector::zeros() + contact.p)),
            }
        }
    }

    /// Finds the contacts again, in the order of their identity: in a crowd only these, as all with
    /// all would be too many.
    fn find(&mut self, layout: &Layout, model: &Model<2>, state: &State) -> Option<()> {
        if layout.crowd.is_none() {
            model.candidates(&state.q, f64::INFINITY, &mut self.candidates).ok()?;
            self.candidates.sort_unstable_by_key(|candidate| candidate.id);
            return Some(());
        }
        self.ids.clear();
        self.ids.extend(self.sums.iter().map(|(id, _)| *id));
        model.detector().locate(&model.placed(&state.q).ok()?, &self.ids, &mut self.candidates);
        Some(())
    }

    /// How far a contact's point has slipped since the start, m, on whatever pieces and sides of the other body.
    fn slipped(&self, layout: &Layout, id: ContactId) -> f64 {
        let first = self.slips.partition_point(|(of, _)| of.pair() < id.pair());
        let of_pair = self.slips[first..].iter().take_while(|(of, _)| of.pair() == id.pair());
        of_pair.filter(|(of, _)| layout.is_one_point(*of, id)).fold(0.0, |sum, (_, slip)| sum + slip)
    }

    /// Appends the rows at the state's time, and starts over.
    pub(crate) fn rows(
        &mut self,
        layout: &Layout,
        model: &Model<2>,
        state: &State,
        contacts: &[AtEnd],
        out: &mut String,
    ) {
        if self.sums.is_empty() {
            return;
        }
        if self.find(layout, model, state).is_none() {
            return;
        }
        // Of several with one identity the last counts.
        self.now.clear();
        self.now.extend(contacts.iter().enumerate().map(|(place, contact)| (contact.id, place)));
        self.now.sort_unstable();
        // In a crowd most contacts only come near: those without an impulse are left out.
        let silent = |p: &Vector<2>| layout.crowd.is_some() && *p == Vector::<2>::zeros();
        for (id, p) in self.sums.iter().filter(|(_, p)| !silent(p)) {
            let Some(names) = layout.names_of(*id) else { continue };
            let place = self.candidates.partition_point(|candidate| candidate.id < *id);
            let now = self.candidates.get(place).filter(|candidate| candidate.id == *id);
            let place = self.now.partition_point(|(of, _)| of <= id);
            let active = self.now[..place].last().filter(|(of, _)| of == id).map(|(_, place)| &contacts[*place]);
            push(out, state.t);
            push_names(&names, out);
            // A point that has left the surface has no gap to it, and no frame for a velocity.
            match now {
                Some(candidate) => push_next(out, candidate.gap),
                None => out.push(','),
            }
            push_next(out, p[0]);
            push_next(out, p[1]);
            let u = active
                .map(|contact| contact.u)
                .or_else(|| now.and_then(|candidate| model.relative_velocity(candidate, &state.q, &state.v).ok()));
            match u {
                Some(u) => {
                    push_next(out, u[0]);
                    push_next(out, u[1]);
                }
                None => out.push_str(",,"),
            }
            out.push(',');
            out.push_str(active.map_or("open", |contact| contact.does.as_str()));
            push_next(out, self.slipped(layout, *id));
            out.push('\n');
        }
        self.sums.clear();
    }
}

/// Appends `,contact,a,b,point`.
pub(crate) fn push_names(names: &ContactNames<'_>, out: &mut String) {
    for name in [names.contact, names.between[0], names.between[1]] {
        out.push(',');
        out.push_str(name);
    }
    let _ = write!(out, ",{}", names.point);
}
