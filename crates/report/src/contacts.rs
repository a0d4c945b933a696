//! The rows of `contacts.csv`: impulses of each contact added up since the last written row.

use crate::number::{push, push_next};
use serde::{Deserialize, Serialize};
use teeter_detect::{Candidate, ContactId};
use teeter_integrator::{Contact, ContactState, Model, State, Vector};
use teeter_scenario::simulation::Layout;

pub(crate) const HEADER: &str = "t,contact,a,b,point,gap,p_n,p_t,u_n,u_t,state\n";

/// Impulses since the last row, by contact.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Impulses {
    /// In order of identity.
    sums: Vec<(ContactId, Vector<2>)>,
    /// Memory of a row.
    #[serde(skip)]
    candidates: Vec<Candidate<2>>,
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
    #[inline]
    pub(crate) fn add(&mut self, contacts: &[Contact<2>]) {
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
        if model.candidates(&state.q, f64::INFINITY, &mut self.candidates).is_err() {
            return;
        }
        for (id, p) in &self.sums {
            let Some(names) = Names::of(layout, *id) else { continue };
            let now = self.candidates.iter().find(|candidate| candidate.id == *id);
            let active = contacts.iter().rev().find(|contact| contact.id == *id);
            push(out, state.t);
            names.push(out);
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
            out.push('\n');
        }
        self.sums.clear();
    }
}

/// The names of a contact in tables.
pub(crate) struct Names<'a> {
    pub(crate) contact: &'a str,
    between: &'a [String; 2],
    pub(crate) point: &'a str,
}

impl<'a> Names<'a> {
    pub(crate) fn of(layout: &'a Layout, id: ContactId) -> Option<Self> {
        let pair = layout.pairs.get(id.pair() as usize)?;
        let point = &pair.points[pair.point(id)?].name;
        Some(Self { contact: &pair.name, between: &pair.between, point })
    }

    /// `,contact,a,b,point`.
    pub(crate) fn push(&self, out: &mut String) {
        for name in [self.contact, &self.between[0], &self.between[1], self.point] {
            out.push(',');
            out.push_str(name);
        }
    }
}
