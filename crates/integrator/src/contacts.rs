//! The active contacts of a step: their rows, their problem, and what became of them.

use crate::contact::{Contact, STILL, tangential};
use crate::mismatch::{Identity, length};
use crate::model::Model;
use crate::spring::SpringStep;
use crate::subsystem::Span;
use crate::{Compliance, Coupling, Mismatch, PartRows, Rows, Vector, WarmStart};
use teeter_contact::{Block, ContactProblem, Delassus, ProblemError};
use teeter_detect::Candidate;

/// Why contacts can't be solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ContactError {
    /// They don't make a problem.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// What was given doesn't belong to them.
    #[error(transparent)]
    Mismatch(#[from] Mismatch),
    /// A law that goes beyond Signorini's and Coulomb's, of which the scheme that posed the contact knows nothing.
    #[error(
        "pair {pair} has {law}, which the scheme doesn't handle: it must do so and say it ({remedy}), or the pair take another law",
        remedy = "ContactSet::handles_law"
    )]
    Law {
        /// The pair.
        pair: u32,
        /// What its law has beyond the standard one.
        law: &'static str,
    },
}

/// How a contact answers, beyond the standard law on its shifted velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Rule {
    /// Signorini and Coulomb on U¹ + s.
    Shifted,
    /// In two phases; the coefficients of restitution act in the second.
    Poisson { e: f64, tangential: f64 },
    /// As shifted, with the normal shift made smaller where the impact would make energy.
    Energetic,
    /// By a force law.
    Spring(SpringStep),
}

/// The active contacts of a step with their rows and their problem; kept over steps, so that it allocates only where
/// there are more than ever before.
///
/// A scheme fills it in this order: [`clear`](Self::clear), [`activate`](Self::activate) for each contact,
/// [`pose`](Self::pose) for each, [`assemble`](Self::assemble), [`problem`](Self::problem) for a solver,
/// [`add_impulses`](Self::add_impulses), [`complete`](Self::complete). A pair whose law is more than Signorini's and Coulomb's is refused
/// unless the scheme says that it [handles](Self::handles_law) it.
#[derive(Debug)]
pub struct ContactSet<const D: usize> {
    contacts: Vec<Contact<D>>,
    spans: Vec<[Span; 2]>,
    /// Where the rows of each contact end in the arena; they begin where those of the one before end.
    ends: Vec<usize>,
    /// The columns within their subsystems, and among the model's velocities.
    columns: Vec<usize>,
    global: Vec<usize>,
    values: Vec<Vector<D>>,
    pub(crate) blocks: Vec<Block<D>>,
    pub(crate) u_free: Vec<Vector<D>>,
    pub(crate) shift: Vec<Vector<D>>,
    pub(crate) rules: Vec<Rule>,
    q: Vec<Vector<D>>,
    pub(crate) mu: Vec<f64>,
    pub(crate) p: Vec<Vector<D>>,
    /// What the law of each contact has beyond the standard one, as long as the scheme hasn't said that it handles it.
    unhandled: Vec<Option<&'static str>>,
    /// The model that the contacts are of, and the number of its velocities.
    model: Option<(Identity, usize)>,
}

impl<const D: usize> ContactSet<D> {
    /// No contacts, with room for so many, their rows at most `row` columns long on a side.
    #[must_use]
    pub fn with_capacity(contacts: usize, row: usize) -> Self {
        Self {
            contacts: Vec::with_capacity(contacts),
            spans: Vec::with_capacity(contacts),
            ends: Vec::with_capacity(contacts),
            columns: Vec::with_capacity(2 * contacts * row),
            global: Vec::with_capacity(2 * contacts * row),
            values: Vec::with_capacity(2 * contacts * row),
            blocks: Vec::with_capacity(contacts * contacts),
            u_free: Vec::with_capacity(contacts),
            shift: Vec::with_capacity(contacts),
            rules: Vec::with_capacity(contacts),
            q: Vec::with_capacity(contacts),
            mu: Vec::with_capacity(contacts),
            p: Vec::with_capacity(contacts),
            unhandled: Vec::with_capacity(contacts),
            model: None,
        }
    }

    /// The contacts, in the order in which they were activated.
    #[must_use]
    pub fn contacts(&self) -> &[Contact<D>] {
        &self.contacts
    }

    /// Drops all contacts.
    pub fn clear(&mut self) {
        self.contacts.clear();
        self.spans.clear();
        self.ends.clear();
        self.u_free.clear();
        self.shift.clear();
        self.rules.clear();
        self.q.clear();
        self.mu.clear();
        self.p.clear();
        self.blocks.clear();
        self.unhandled.clear();
        self.model = None;
    }

    /// Whether the contacts are of this model; those of an empty set are of any.
    pub(crate) fn check(&self, model: &Model<D>) -> Result<(), Mismatch> {
        match self.model {
            Some((identity, _)) if identity != model.identity() => {
                let remedy = "clear the set before contacts of this one are activated";
                Err(Mismatch::OtherModel { what: "the contacts are those", remedy })
            }
            _ => Ok(()),
        }
    }

    fn check_index(&self, i: usize) -> Result<(), Mismatch> {
        let contacts = self.contacts.len();
        if i < contacts { Ok(()) } else { Err(Mismatch::Contact { contact: i, contacts }) }
    }

    /// Takes a candidate in, with its rows at coordinates `q`; side 1 enters with a minus, for u = v_0 − v_1. Its impulse
    /// starts from that of the step before.
    ///
    /// # Errors
    /// If there are too few or too many coordinates, or the candidate is of a pair or a body that the model doesn't have, or the contacts
    /// before it are of another model. The set is as it was, then.
    pub fn activate(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        candidate: &Candidate<D>,
        warm: &WarmStart,
    ) -> Result<(), Mismatch> {
        self.check(model)?;
        length("the coordinates", q, model.size().q)?;
        let law = model.law(candidate.id.pair())?;
        self.enter(model, q, candidate, warm, law.friction)?;
        if let Some(unhandled) = self.unhandled.last_mut() {
            *unhandled = law.beyond_standard();
        }
        Ok(())
    }

    /// The same for a set, a pair and coordinates that are known to fit, and a scheme that handles every law.
    pub(crate) fn enter(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        candidate: &Candidate<D>,
        warm: &WarmStart,
        friction: f64,
    ) -> Result<(), Mismatch> {
        let mut spans = [Span { part: 0, start: 0, len: 0 }; 2];
        let mut start = self.ends.last().copied().unwrap_or(0);
        for (side, anchor) in candidate.sides.iter().enumerate() {
            let Some((index, part, body)) = model.owner(anchor.body) else {
                return Err(Mismatch::Body { body: anchor.body, bodies: model.size().bodies });
            };
            if part.row == 0 {
                continue;
            }
            // Never shorter again, so that a step with known contacts has no entries to make.
            if self.values.len() < start + part.row {
                self.columns.resize(start + part.row, 0);
                self.global.resize(start + part.row, 0);
                self.values.resize(start + part.row, Vector::zeros());
            }
            let room = start..start + part.row;
            let mut rows = Rows { columns: &mut self.columns[room.clone()], values: &mut self.values[room] };
            let q = &q[part.q.clone()];
            let len = part.system.rows(body, q, &anchor.point, &candidate.frame, &mut rows).min(part.row);
            let taken = start..start + len;
            let mut last = 0;
            for (global, &column) in self.global[taken.clone()].iter_mut().zip(&self.columns[taken.clone()]) {
                last = last.max(column);
                *global = part.v.start + column;
            }
            if last >= part.v.len() && len > 0 {
                return Err(Mismatch::Column { body: anchor.body, column: last, velocities: part.v.len() });
            }
            if side == 1 {
                self.values[taken].iter_mut().for_each(|value| *value = -*value);
            }
            spans[side] = Span { part: index, start, len };
            start += len;
        }
        self.spans.push(spans);
        self.ends.push(start);
        let before = warm.impulse::<D>(candidate.id);
        self.p.push(before.unwrap_or_else(Vector::zeros));
        self.u_free.push(Vector::zeros());
        self.shift.push(Vector::zeros());
        self.rules.push(Rule::Shifted);
        self.q.push(Vector::zeros());
        self.mu.push(friction);
        self.unhandled.push(None);
        self.model = Some((model.identity(), model.size().v));
        self.contacts.push(Contact {
            id: candidate.id,
            sides: candidate.sides,
            frame: candidate.frame,
            gap: candidate.gap,
            p: Vector::zeros(),
            u_before: Vector::zeros(),
            u_after: Vector::zeros(),
            u_law: Vector::zeros(),
            persisting: before.is_some(),
            gap_after: None,
            still: 0.0,
        });
        Ok(())
    }

    /// Says that the scheme handles the law of contact `i`, whatever it is: restitution is in the shift, say.
    ///
    /// # Errors
    /// For a contact that isn't there.
    pub fn handles_law(&mut self, i: usize) -> Result<(), Mismatch> {
        self.check_index(i)?;
        self.unhandled[i] = None;
        Ok(())
    }

    /// Refuses contacts whose law nobody handles.
    pub(crate) fn check_laws(&self) -> Result<(), ContactError> {
        match self.unhandled.iter().zip(&self.contacts).find_map(|(law, contact)| law.map(|law| (law, contact.id))) {
            Some((law, id)) => Err(ContactError::Law { pair: id.pair(), law }),
            None => Ok(()),
        }
    }

    /// Takes the last contact out again if all that could part its sides is prescribed: no impulse changes its normal velocity,
    /// so there is none to be found. Returns whether it did.
    ///
    /// # Errors
    /// If the contacts are of another model.
    pub fn withdraw_if_prescribed(&mut self, model: &Model<D>) -> Result<bool, Mismatch> {
        self.check(model)?;
        Ok(self.leave_if_prescribed(model))
    }

    /// The same for a set that is known to fit.
    #[inline]
    pub(crate) fn leave_if_prescribed(&mut self, model: &Model<D>) -> bool {
        let fixed = self.spans.last().is_some_and(|sides| sides.iter().all(|side| side.len == 0));
        (fixed || model.is_driven()) && self.leave_if_its_sides_are(model)
    }

    fn leave_if_its_sides_are(&mut self, model: &Model<D>) -> bool {
        let Some(sides) = self.spans.last() else { return false };
        let prescribed = sides.iter().filter(|side| side.len > 0).all(|side| {
            let part = &model.parts()[side.part];
            if !part.traits.driven {
                return false;
            }
            let driven = part.system.driven();
            let range = side.start..side.start + side.len;
            self.columns[range.clone()]
                .iter()
                .zip(&self.values[range])
                .all(|(c, value)| value[0] == 0.0 || driven.contains(c))
        });
        if prescribed {
            self.ends.pop();
            self.spans.pop();
            self.p.pop();
            self.u_free.pop();
            self.shift.pop();
            self.rules.pop();
            self.q.pop();
            self.mu.pop();
            self.unhandled.pop();
            self.contacts.pop();
            if self.contacts.is_empty() {
                self.model = None;
            }
        }
        prescribed
    }

    /// The entries of contact `i`, with their columns among the model's velocities.
    #[inline]
    fn entries(&self, i: usize) -> impl Iterator<Item = (usize, &Vector<D>)> {
        let start = if i == 0 { 0 } else { self.ends[i - 1] };
        let range = start..self.ends[i];
        self.global[range.clone()].iter().copied().zip(&self.values[range])
    }

    /// The relative velocity J_i v of contact `i`, for velocities of the whole model.
    ///
    /// # Errors
    /// For a contact that isn't there, or too few or too many velocities.
    pub fn velocity(&self, i: usize, v: &[f64]) -> Result<Vector<D>, Mismatch> {
        self.check_index(i)?;
        self.check_velocities(v)?;
        Ok(self.velocity_of(i, v))
    }

    fn check_velocities(&self, v: &[f64]) -> Result<(), Mismatch> {
        self.model.map_or(Ok(()), |(_, expected)| length("the velocities", v, expected))
    }

    /// The same for what is known to fit.
    pub(crate) fn velocity_of(&self, i: usize, v: &[f64]) -> Vector<D> {
        let mut u = Vector::zeros();
        for (column, value) in self.entries(i) {
            u += value * v[column];
        }
        u
    }

    /// Gives contact `i` its velocity before the step, its free velocity and the shift s of the law, m/s: the law holds for
    /// U¹ + s, so the problem's constant vector is q = U_free + s.
    ///
    /// # Errors
    /// For a contact that isn't there.
    pub fn pose(&mut self, i: usize, u_before: Vector<D>, u_free: Vector<D>, shift: Vector<D>) -> Result<(), Mismatch> {
        self.check_index(i)?;
        self.set(i, u_before, u_free, shift);
        Ok(())
    }

    /// The same for a contact that is known to be there.
    pub(crate) fn set(&mut self, i: usize, u_before: Vector<D>, u_free: Vector<D>, shift: Vector<D>) {
        self.contacts[i].u_before = u_before;
        self.u_free[i] = u_free;
        self.reshift(i, shift);
    }

    /// The model's velocities that contact `i` pushes.
    pub(crate) fn pushed(&self, i: usize) -> impl Iterator<Item = usize> {
        self.entries(i).map(|(column, _)| column)
    }

    /// What a problem holds of contact `i` beside H, and where its rows lie.
    pub(crate) fn posed(&self, i: usize) -> ([Span; 2], Vector<D>, f64, Vector<D>) {
        (self.spans[i], self.q[i], self.mu[i], self.p[i])
    }

    /// Gives contact `i` another shift.
    pub(crate) fn reshift(&mut self, i: usize, shift: Vector<D>) {
        self.shift[i] = shift;
        self.q[i] = self.u_free[i] + shift;
    }

    /// Makes contact `i` follow a rule of its own.
    pub(crate) fn follow(&mut self, i: usize, rule: Rule) {
        self.rules[i] = rule;
        if let Rule::Spring(spring) = rule {
            self.contacts[i].gap = spring.gap;
        }
    }

    /// Whether one of the bodies of contact `i` is accelerated as prescribed, in full or in part, between velocities `v0` and `v1`: a frame
    /// that only travels must change nothing.
    pub(crate) fn feels_drive(&self, model: &Model<D>, i: usize, v0: &[f64], v1: &[f64]) -> bool {
        self.spans[i].iter().filter(|side| side.len > 0).any(|side| {
            let part = &model.parts()[side.part];
            let (v0, v1) = (&v0[part.v.clone()], &v1[part.v.clone()]);
            part.system.driven().iter().any(|&k| v0[k] != v1[k])
        })
    }

    /// U_t¹ of contact `i` had it no friction of its own, m/s; the others' impulses as they are.
    pub(crate) fn without_own_friction(&self, i: usize) -> Vector<D> {
        let own = &self.blocks[i * self.contacts.len() + i];
        tangential(&(self.velocity_by_impulses(i) - own * tangential(&self.p[i])))
    }

    /// Σ |J_i v| of contact `i`, m/s: what rounding of its velocity is measured by.
    pub(crate) fn speed(&self, i: usize, v: &[f64]) -> f64 {
        self.entries(i).map(|(column, value)| value.norm() * v[column].abs()).sum()
    }

    /// U¹ of contact `i` by the impulses, m/s.
    pub(crate) fn velocity_by_impulses(&self, i: usize) -> Vector<D> {
        let n = self.contacts.len();
        let row = &self.blocks[i * n..(i + 1) * n];
        row.iter().zip(&self.p).fold(self.u_free[i], |u, (block, p)| u + block * p)
    }

    /// The work Ū·p of contact `i` by the impulses, Ū the mean of U⁰ and U¹, J.
    pub(crate) fn work(&self, i: usize) -> f64 {
        ((self.velocity_by_impulses(i) + self.contacts[i].u_before) * 0.5).dot(&self.p[i])
    }

    /// H = Σ J W Jᵀ over the subsystems; `scratch` is as long as the model's velocities.
    ///
    /// # Errors
    /// If the contacts are of another model, or factors or scratch don't fit it.
    pub fn assemble(
        &mut self,
        model: &Model<D>,
        factors: &mut [Box<dyn Compliance<D>>],
        scratch: &mut [f64],
    ) -> Result<(), Mismatch> {
        self.check(model)?;
        length("the factors", factors, model.parts().len())?;
        length("the scratch", scratch, model.size().v)?;
        self.couple(model, factors, scratch);
        Ok(())
    }

    /// The same for what is known to fit.
    pub(crate) fn couple(&mut self, model: &Model<D>, factors: &mut [Box<dyn Compliance<D>>], scratch: &mut [f64]) {
        let n = self.contacts.len();
        self.blocks.clear();
        self.blocks.resize(n * n, Block::zeros());
        let mut coupling = Coupling { contacts: n, blocks: &mut self.blocks };
        for (index, (part, factor)) in model.parts().iter().zip(factors).enumerate() {
            if part.v.is_empty() {
                continue;
            }
            let rows = PartRows { part: index, spans: &self.spans, columns: &self.columns, values: &self.values };
            factor.couple(&rows, &mut scratch[..part.v.len()], &mut coupling);
        }
    }

    /// The problem, and the impulses to start from and to leave the solution in.
    ///
    /// # Errors
    /// As [`ContactProblem::new`], which tells of a set that isn't [assembled](Self::assemble), too; and for a law that nobody handles.
    pub fn problem(&mut self) -> Result<(ContactProblem<'_, D>, &mut [Vector<D>]), ContactError> {
        self.check_laws()?;
        Ok(self.posed_problem()?)
    }

    /// The same where the scheme handles every law.
    pub(crate) fn posed_problem(&mut self) -> Result<(ContactProblem<'_, D>, &mut [Vector<D>]), ProblemError> {
        let problem = ContactProblem::new(Delassus::Dense(&self.blocks), &self.q, &self.mu)?;
        Ok((problem, &mut self.p))
    }

    /// The rows of the contacts that act on one part.
    pub(crate) fn rows_of(&self, part: usize) -> PartRows<'_, D> {
        PartRows { part, spans: &self.spans, columns: &self.columns, values: &self.values }
    }

    /// Adds Jᵀ p of one part to `f`, as long as its velocities, N·s.
    pub(crate) fn add_generalised_impulse(&self, part: usize, f: &mut [f64]) {
        self.rows_of(part).add_generalised_impulse(&self.p, f);
    }

    /// Adds W Jᵀ p to `v`, after [`assemble`](Self::assemble); `scratch` is as long as the model's velocities.
    ///
    /// # Errors
    /// If the contacts are of another model, or factors, scratch or velocities don't fit it.
    pub fn add_impulses(
        &self,
        model: &Model<D>,
        factors: &mut [Box<dyn Compliance<D>>],
        scratch: &mut [f64],
        v: &mut [f64],
    ) -> Result<(), Mismatch> {
        self.check(model)?;
        length("the factors", factors, model.parts().len())?;
        length("the scratch", scratch, model.size().v)?;
        length("the velocities", v, model.size().v)?;
        self.respond(model, factors, scratch, v);
        Ok(())
    }

    /// The same for what is known to fit.
    pub(crate) fn respond(
        &self,
        model: &Model<D>,
        factors: &mut [Box<dyn Compliance<D>>],
        scratch: &mut [f64],
        v: &mut [f64],
    ) {
        for (index, (part, factor)) in model.parts().iter().zip(factors).enumerate() {
            if part.v.is_empty() {
                continue;
            }
            let rows = self.rows_of(index);
            if !rows.is_empty() {
                factor.respond(&rows, &self.p, &mut scratch[part.v.clone()], &mut v[part.v.clone()]);
            }
        }
    }

    /// Completes the contacts after a solve, with velocities after the step.
    ///
    /// # Errors
    /// For too few or too many velocities.
    pub fn complete(&mut self, v: &[f64]) -> Result<(), Mismatch> {
        self.check_velocities(v)?;
        self.settle(v);
        Ok(())
    }

    /// The same for what is known to fit.
    pub(crate) fn settle(&mut self, v: &[f64]) {
        let fastest = self.q.iter().map(Vector::norm_squared).fold(0.0, f64::max).sqrt();
        for i in 0..self.contacts.len() {
            let u_after = self.velocity_of(i, v);
            let contact = &mut self.contacts[i];
            (contact.p, contact.u_after, contact.still) = (self.p[i], u_after, STILL * fastest);
            contact.u_law = u_after + self.shift[i];
            match self.rules[i] {
                Rule::Spring(spring) => contact.gap_after = Some(spring.gap_after(u_after[0])),
                Rule::Poisson { tangential: e, .. } => contact.u_law += tangential(&contact.u_before) * e,
                Rule::Shifted | Rule::Energetic => {}
            }
        }
    }
}
