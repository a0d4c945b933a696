//! The contact stage: the way from candidates to impulses, for every scheme.

mod asked;
mod error;
mod islands;
mod kept;
mod posed;
mod resolve;
mod rows;
mod solve;

use crate::contact::{Contact, STILL, tangential};
use crate::mismatch::{Identity, length};
use crate::spring::Springs;
use crate::{ImpactLaw, Memory, Mismatch, Model, PairLaw, SpringStep, State, Vector, WarmStart, Workspace};
pub use asked::{Look, Over, Rule};
use asked::{by_law, newton_shift};
pub use error::ContactError;
use islands::Islands;
pub(crate) use posed::Problem;
pub(crate) use rows::ContactRows;
pub(crate) use solve::Members;
use teeter_contact::Block;
use teeter_detect::Candidate;

/// The contacts of one configuration with their rows, their problem, and what became of it: the only way from candidates to impulses.
/// A scheme owns as many stages as it has use for; each keeps its memory, so that it allocates only where there are more contacts
/// than ever before.
///
/// [`find`](Self::find) takes the candidates in ([`add`](Self::add) takes one); [`pose`](Self::pose) gives each what its pair's law asks
/// for, whatever law that is ([`set`](Self::set) something else); [`solve`](Self::solve) finds the impulses, and
/// [`respond`](Self::respond) turns free velocities into those after them. All of it can be done again: other
/// [rows](Self::rows_at), another rule, one contact more. What doesn't fit is an error, never left out.
#[derive(Debug)]
pub struct ContactStage<const D: usize> {
    contacts: Vec<Contact<D>>,
    pub(crate) rows: ContactRows<D>,
    pub(crate) problem: Problem<D>,
    /// Compliance beside J W Jᵀ of some contacts.
    extra: Vec<(usize, Block<D>)>,
    pub(crate) springs: Springs<D>,
    islands: Islands<D>,
    /// Whether contacts act where the detector found them, also where that is not one place.
    acts_as_found: bool,
    /// Whether the last solve was by islands.
    apart: bool,
    /// Whether the last solve was over accelerations.
    forces: bool,
    /// The workspace's count when the problem was coupled; 0 where rows have changed since.
    coupled: u64,
    model: Option<Identity>,
    velocities: usize,
}

impl<const D: usize> Default for ContactStage<D> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const D: usize> ContactStage<D> {
    /// No contacts.
    #[must_use]
    pub fn new() -> Self {
        Self {
            contacts: Vec::new(),
            rows: ContactRows::default(),
            problem: Problem::default(),
            extra: Vec::new(),
            springs: Springs::default(),
            islands: Islands::default(),
            acts_as_found: false,
            apart: false,
            forces: false,
            coupled: 0,
            model: None,
            velocities: 0,
        }
    }

    /// With contacts that act where the detector found them: for a scheme that leaves no gaps, and takes rows elsewhere only for the
    /// derivatives of velocities.
    pub(crate) fn acting_as_found(self) -> Self {
        Self { acts_as_found: true, ..self }
    }

    /// A candidate with its sides where they act.
    #[inline(always)]
    fn acting(&self, model: &Model<D>, q: &[f64], candidate: &Candidate<D>) -> Candidate<D> {
        if self.acts_as_found { *candidate } else { model.in_one_place(q, candidate) }
    }

    /// Makes room for what a step of the model can need, but for more contacts than some hundred at once.
    pub fn reserve(&mut self, model: &Model<D>) {
        let contacts = model.detector().capacity().min(RESERVED_CONTACTS);
        self.contacts.reserve(contacts.saturating_sub(self.contacts.len()));
        self.rows.reserve(contacts, model.size().row, model.parts().len());
        self.problem.reserve(contacts);
        self.springs.reserve(if model.has_springs() { model.contacts_to_expect() } else { 0 });
    }

    /// Makes room for so many contacts more, so that adding them moves none.
    pub(crate) fn make_room(&mut self, contacts: usize) {
        self.contacts.reserve(contacts);
    }

    /// The contacts, in the order in which they were added.
    #[must_use]
    pub fn contacts(&self) -> &[Contact<D>] {
        &self.contacts
    }

    /// How many contacts there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.contacts.len()
    }

    /// Whether there are no contacts.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// Drops all contacts.
    pub fn clear(&mut self) {
        self.contacts.clear();
        self.rows.clear();
        self.problem.clear();
        self.extra.clear();
        self.springs.forget();
        self.coupled = 0;
        self.model = None;
        self.apart = false;
        self.forces = false;
    }

    /// Forgets what was found for the islands of the last attempt, and from now on keeps that of each
    /// solve for the next: the contacts of both must have the same rows and the same factors.
    pub(crate) fn keep_islands_anew(&mut self) {
        self.islands.keep_anew();
    }

    /// Whether it holds forces in place of impulses.
    pub(crate) fn holds_forces(&self) -> bool {
        self.forces
    }

    pub(crate) fn check(&self, model: &Model<D>) -> Result<(), Mismatch> {
        match self.model {
            Some(identity) if identity != model.identity() => {
                let remedy = "clear the stage before contacts of this one are added";
                Err(Mismatch::OtherModel { what: "the contacts are those", remedy })
            }
            _ => Ok(()),
        }
    }

    fn check_index(&self, i: usize) -> Result<(), Mismatch> {
        let contacts = self.contacts.len();
        if i < contacts { Ok(()) } else { Err(Mismatch::Contact { contact: i, contacts }) }
    }

    fn check_velocities(&self, v: &[f64]) -> Result<(), Mismatch> {
        if self.model.is_some() { length("the velocities", v, self.velocities) } else { Ok(()) }
    }

    /// Finds the contacts that take part in a step from `state`, in place of those before. Impulses start from those of the state's warm
    /// start, and what was active before is known from its memory.
    ///
    /// # Errors
    /// If coordinates don't fit the model, the workspace is of another one, or the detector finds pairs or bodies that the model doesn't
    /// have.
    #[inline]
    pub fn find(
        &mut self,
        model: &Model<D>,
        state: &State,
        look: &Look<'_>,
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        self.clear();
        if !model.has_contacts() {
            return Ok(());
        }
        if !model.has_springs() {
            work.detect(model, look.at, look.within)?;
            self.belong_to(model);
            for candidate in &work.candidates {
                self.take_in(model, look.at, candidate, &state.warm, &state.memory)?;
            }
            return Ok(());
        }
        self.find_with_springs(model, state, look, work)
    }

    #[inline(never)]
    fn find_with_springs(
        &mut self,
        model: &Model<D>,
        state: &State,
        look: &Look<'_>,
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        self.springs.look(model, &state.q, look.free.unwrap_or(look.at), work)?;
        self.springs.detect(model, look.at, &state.memory, look.within, work)?;
        self.belong_to(model);
        let mut admitted = std::mem::take(&mut work.candidates);
        admitted.retain(|candidate| {
            let spring = model.spring(candidate.law).is_some();
            self.springs.admit(spring, candidate, &state.memory, look.within)
        });
        let taken = self.springs.hand_over(model, state, admitted.iter(), false, work).and_then(|()| {
            let mut all = admitted.iter();
            all.try_for_each(|candidate| match self.springs.leaves_out(candidate.id) {
                true => Ok(()),
                false => self.take_in(model, look.at, candidate, &state.warm, &state.memory).map(|_| ()),
            })
        });
        work.candidates = admitted;
        taken
    }

    /// Marks that what is taken in from now on is of this model.
    pub(crate) fn belong_to(&mut self, model: &Model<D>) {
        self.model = Some(model.identity());
        self.velocities = model.size().v;
    }

    /// Takes a candidate in, with its rows at coordinates `q`; side 1 enters with a minus, for u = v_0 − v_1. Its impulse starts from that
    /// in `warm`, and `memory` says whether it was active before. Returns whether it is a contact: not if all that could part its sides is prescribed, for then no impulse changes
    /// its normal velocity, and there is none to be found.
    ///
    /// # Errors
    /// If there are too few or too many coordinates, or the candidate is of a pair or a body that the model doesn't have, or the contacts
    /// before it are of another model. The stage is as it was, then.
    #[inline]
    pub fn add(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        candidate: &Candidate<D>,
        warm: &WarmStart,
        memory: &Memory,
    ) -> Result<bool, Mismatch> {
        self.check(model)?;
        length("the coordinates", q, model.size().q)?;
        let taken = self.take_in(model, q, candidate, warm, memory)?;
        if taken {
            self.belong_to(model);
        }
        Ok(taken)
    }

    /// The same without checks of model and lengths.
    #[inline(always)]
    pub(crate) fn take_in(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        candidate: &Candidate<D>,
        warm: &WarmStart,
        memory: &Memory,
    ) -> Result<bool, Mismatch> {
        let law = model.law_of(candidate.law)?;
        self.rows.push(model, q, &self.acting(model, q, candidate))?;
        if self.rows.last_is_prescribed(model) {
            self.rows.pop();
            return Ok(false);
        }
        // Usually the contacts are those of the step before.
        let (id, number) = (candidate.id, self.contacts.len());
        let before = warm.impulse_near::<D>(id, number);
        self.problem.push(law.friction, before.unwrap_or_else(Vector::zeros));
        self.contacts.push(Contact::of(candidate, memory.is_active_near(id, number)));
        Ok(true)
    }

    /// The relative velocity J_i v of contact `i`, m/s, for velocities of the whole model.
    ///
    /// # Errors
    /// For a contact that isn't there, or too few or too many velocities.
    pub fn velocity(&self, i: usize, v: &[f64]) -> Result<Vector<D>, Mismatch> {
        self.check_index(i)?;
        self.check_velocities(v)?;
        Ok(self.rows.velocity(i, v))
    }

    /// Gives every contact what the law of its pair asks for (`docs/laws.md`): velocity before `v_before` (m/s), free velocity `v_free`,
    /// shift and rule. Newton's restitution acts on every contact; the other laws tell impacts from contacts that press. Over
    /// accelerations `v_free` are the free ones (m/s²), and J̇v at the state's velocities is added.
    ///
    /// # Errors
    /// For too few or too many velocities, a law that has no meaning over such a time, or a body that doesn't know J̇v where that is
    /// needed.
    #[inline]
    pub fn pose(
        &mut self,
        model: &Model<D>,
        state: &State,
        v_before: &[f64],
        v_free: &[f64],
        over: Over,
    ) -> Result<(), ContactError> {
        self.check_velocities(v_before)?;
        self.check_velocities(v_free)?;
        self.pose_all(model, state, v_before, v_free, over)
    }

    /// The same without checks of lengths.
    #[inline]
    fn pose_all(
        &mut self,
        model: &Model<D>,
        state: &State,
        v_before: &[f64],
        v_free: &[f64],
        over: Over,
    ) -> Result<(), ContactError> {
        for i in 0..self.contacts.len() {
            let law = model.law_of(self.contacts[i].law)?;
            let u = self.rows.velocities(i, [v_before, v_free]);
            if law.impact == ImpactLaw::Newton && over != Over::Acceleration {
                let shift = newton_shift(law, &self.contacts[i], &u[0]);
                self.put(i, u, shift, Rule::Shifted);
            } else {
                self.pose_otherwise(i, model, state, law, u, over)?;
            }
        }
        Ok(())
    }

    /// Poses a contact of another law than Newton's, or over accelerations.
    #[inline(never)]
    fn pose_otherwise(
        &mut self,
        i: usize,
        model: &Model<D>,
        state: &State,
        law: &PairLaw,
        [u_before, mut u_free]: [Vector<D>; 2],
        over: Over,
    ) -> Result<(), ContactError> {
        let (shift, rule) = match over {
            Over::Acceleration => {
                self.without_duration(i, law, over)?;
                u_free += self.bias(i, model, state)?;
                (Vector::zeros(), Rule::Shifted)
            }
            Over::Instant => {
                self.without_duration(i, law, over)?;
                by_law(law, &self.contacts[i], &u_before, &u_free)
            }
            Over::Step { h, weight } => match law.impact.spring() {
                None => by_law(law, &self.contacts[i], &u_before, &u_free),
                Some(spring) => {
                    let gap = self.springs.gap(self.contacts[i].id, &state.memory);
                    // With w < ½ the force at the end of the step would count for less than half,
                    // or nothing, of the work.
                    let step = SpringStep { spring, gap, u_before: u_before[0], h, theta: weight.max(0.5) };
                    (Vector::zeros(), Rule::Spring(step))
                }
            },
        };
        self.put(i, [u_before, u_free], shift, rule);
        Ok(())
    }

    /// J̇v of contact `i` at the state, with its points and frame as they were found, m/s².
    fn bias(&self, i: usize, model: &Model<D>, state: &State) -> Result<Vector<D>, ContactError> {
        model.fits(&state.q, &state.v)?;
        self.bias_at(i, model, &state.q, &state.v)
    }

    /// The same at coordinates `q` and velocities `v`, whose lengths are right.
    pub(crate) fn bias_at(&self, i: usize, model: &Model<D>, q: &[f64], v: &[f64]) -> Result<Vector<D>, ContactError> {
        let (contact, mut sum) = (&self.contacts[i], Vector::zeros());
        for (anchor, sign) in contact.sides.iter().zip([1.0, -1.0]) {
            let Some((_, part, body)) = model.owner(anchor.body) else { continue };
            let (q, v) = (&q[part.q.clone()], &v[part.v.clone()]);
            let bias = part.system.bias(body, q, v, &anchor.point, &contact.frame);
            sum += bias.ok_or(ContactError::Bias { body: anchor.body })? * sign;
        }
        Ok(sum)
    }

    fn without_duration(&self, i: usize, law: &PairLaw, over: Over) -> Result<(), ContactError> {
        let over = if over == Over::Instant { "in an instant" } else { "for accelerations" };
        match law.impact {
            ImpactLaw::KelvinVoigt { .. } | ImpactLaw::HuntCrossley { .. } => {
                Err(ContactError::Law { pair: self.contacts[i].id.pair(), law: "a law with duration", over })
            }
            ImpactLaw::Newton | ImpactLaw::Poisson | ImpactLaw::Energetic => Ok(()),
        }
    }

    /// Gives contact `i` its velocity before, its free velocity (m/s), the shift s of its law, which then holds for U¹ + s, and its rule,
    /// in place of what [`pose`](Self::pose) gives: the scheme answers for its law, then.
    ///
    /// # Errors
    /// For a contact that isn't there.
    pub fn set(
        &mut self,
        i: usize,
        u_before: Vector<D>,
        u_free: Vector<D>,
        shift: Vector<D>,
        rule: Rule<D>,
    ) -> Result<(), Mismatch> {
        self.check_index(i)?;
        self.put(i, [u_before, u_free], shift, rule);
        Ok(())
    }

    /// Velocities before and free, shift and rule of contact `i`.
    #[inline(always)] // The usual rule has no data to be copied.
    fn put(&mut self, i: usize, [u_before, u_free]: [Vector<D>; 2], shift: Vector<D>, rule: Rule<D>) {
        let (contact, posed) = (&mut self.contacts[i], &mut self.problem.posed[i]);
        (posed.u_before, posed.u_free, posed.shift, posed.rule) = (u_before, u_free, shift, rule);
        self.problem.q[i] = u_free + shift;
        self.problem.mu[i] = if matches!(rule, Rule::Frictionless) { 0.0 } else { posed.friction };
        (contact.u_before, contact.gap_after) = (u_before, None);
        if let Rule::Spring(spring) = rule {
            contact.gap = spring.gap;
        }
    }

    /// Takes the rows of contact `i`, and its frame and gap, anew from a candidate of the same contact at coordinates `q`: the same contact
    /// at another place.
    ///
    /// # Errors
    /// For a contact that isn't there, another contact's candidate, or coordinates that don't fit.
    pub fn rows_at(&mut self, i: usize, model: &Model<D>, q: &[f64], candidate: &Candidate<D>) -> Result<(), Mismatch> {
        self.check(model)?;
        self.check_index(i)?;
        length("the coordinates", q, model.size().q)?;
        let acting = self.acting(model, q, candidate);
        let contact = &mut self.contacts[i];
        if contact.id != candidate.id {
            return Err(Mismatch::OtherContact { contact: i });
        }
        self.coupled = 0;
        self.rows.renew(model, q, &acting, i)?;
        (contact.sides, contact.frame, contact.gap) = (candidate.sides, candidate.frame, candidate.gap);
        Ok(())
    }

    /// Adds `normal` · xᵀ to the normal rows of contact `i` where these have entries: J_n += a xᵀ, x as long as the model's velocities. With
    /// x = MΔq this makes J a discrete gradient of its gap.
    ///
    /// # Errors
    /// For a contact that isn't there, or too few or too many entries.
    pub fn update_row(&mut self, i: usize, a: f64, x: &[f64]) -> Result<(), Mismatch> {
        self.check_index(i)?;
        self.check_velocities(x)?;
        self.coupled = 0;
        self.rows.add_to_normal(i, a, x);
        Ok(())
    }

    /// Adds a compliance κ (1/kg) beside J W Jᵀ to contact `i`: what the model's W leaves out.
    ///
    /// # Errors
    /// For a contact that isn't there.
    pub fn add_compliance(&mut self, i: usize, kappa: Block<D>) -> Result<(), Mismatch> {
        self.check_index(i)?;
        self.extra.push((i, kappa));
        Ok(())
    }

    /// The impulse of contact `i` after [`solve`](Self::solve), N·s; before it, where the solver starts.
    #[must_use]
    pub fn impulse(&self, i: usize) -> Option<Vector<D>> {
        self.problem.p.get(i).copied()
    }

    /// Lets the solver start from these impulses, of the contacts that have one there.
    pub(crate) fn start_from(&mut self, impulses: &WarmStart) {
        for (contact, p) in self.contacts.iter().zip(&mut self.problem.p) {
            if let Some(known) = impulses.impulse(contact.id) {
                *p = known;
            }
        }
    }

    /// Completes the contacts after [`respond`](Self::respond), with velocities `v` at the end (m/s).
    ///
    /// # Errors
    /// For too few or too many velocities.
    #[inline]
    pub fn complete(&mut self, v: &[f64]) -> Result<(), Mismatch> {
        self.check_velocities(v)?;
        self.complete_all(v);
        Ok(())
    }

    /// The same without a check of lengths.
    #[inline(always)]
    fn complete_all(&mut self, v: &[f64]) {
        let Self { contacts, rows, problem, .. } = self;
        let fastest = problem.q.iter().map(Vector::norm_squared).fold(0.0, f64::max).sqrt();
        for (i, (contact, posed)) in contacts.iter_mut().zip(&problem.posed).enumerate() {
            let u_after = rows.velocity(i, v);
            (contact.p, contact.u_after, contact.still) = (problem.p[i], u_after, STILL * fastest);
            contact.u_law = u_after + posed.shift;
            match &posed.rule {
                Rule::Spring(spring) => contact.gap_after = Some(spring.gap_after(u_after[0])),
                Rule::Poisson { tangential: e, .. } => contact.u_law += tangential(&contact.u_before) * *e,
                Rule::Unposed | Rule::Shifted | Rule::Frictionless | Rule::SlidesAlong(_) | Rule::Energetic => {}
            }
        }
    }

    /// Drops the contact that was added last.
    pub(crate) fn drop_last(&mut self) {
        self.contacts.pop();
        self.rows.pop();
        self.problem.pop();
    }

    /// Completes contact `i` of a smooth motion with its impulse over it, N·s, its relative velocities
    /// at the ends (m/s) and that for which its law holds.
    pub(crate) fn complete_smooth(&mut self, i: usize, p: Vector<D>, u: [Vector<D>; 2], u_law: Vector<D>) {
        self.problem.p[i] = p;
        let contact = &mut self.contacts[i];
        (contact.p, contact.u_law) = (p, u_law);
        // What presses doesn't part.
        [contact.u_before, contact.u_after] = u.map(|u| tangential(&u));
        contact.persisting = true;
    }

    /// Gives contact `i` an impulse, N·s, for [`respond`](Self::respond).
    pub(crate) fn push_with(&mut self, i: usize, p: Vector<D>) {
        self.problem.p[i] = p;
    }

    /// Block (i, j) of H, dense, after [`couple`](Self::couple).
    pub(crate) fn block(&self, i: usize, j: usize) -> &Block<D> {
        &self.problem.blocks[i * self.contacts.len() + j]
    }

    /// The first contact whose identity isn't higher than that of the one before.
    pub(crate) fn out_of_order(&self) -> Option<usize> {
        self.contacts.windows(2).position(|pair| pair[0].id >= pair[1].id).map(|at| at + 1)
    }

    /// The contacts go over to a phase; the stage is empty then.
    pub(crate) fn hand_over(&mut self, to: &mut Vec<Contact<D>>) {
        std::mem::swap(&mut self.contacts, to);
        self.clear();
    }

    /// Whether one of the bodies of contact `i` is accelerated as prescribed, in full or in part, between velocities `v0` and `v1`: a frame
    /// that only travels must change nothing.
    pub(crate) fn feels_drive(&self, model: &Model<D>, i: usize, v0: &[f64], v1: &[f64]) -> bool {
        self.rows.spans[i].iter().filter(|side| side.len > 0).any(|side| {
            let part = &model.parts()[side.part];
            let (v0, v1) = (&v0[part.v.clone()], &v1[part.v.clone()]);
            part.traits.driven.iter().any(|&k| v0[k] != v1[k])
        })
    }

    /// The parts that contact `i` acts on.
    pub(crate) fn parts_of(&self, i: usize) -> impl Iterator<Item = usize> + use<D> {
        let [a, b] = self.rows.spans[i];
        let again = b.part == a.part;
        [(a, true), (b, !again || a.len == 0)]
            .into_iter()
            .filter(|(side, once)| side.len > 0 && *once)
            .map(|(side, _)| side.part)
    }

    /// Σ |J_i v| of contact `i`, m/s: what rounding of its velocity is measured by.
    pub(crate) fn speed(&self, i: usize, v: &[f64]) -> f64 {
        self.rows.speed(i, v)
    }

    /// Whether a contact acts on a part.
    pub(crate) fn acts_on(&self, part: usize) -> bool {
        !self.rows.of_part(part).is_empty()
    }

    /// Adds Jᵀ p of one part to `f`, as long as its velocities, N·s.
    pub(crate) fn add_generalised_impulse(&self, part: usize, f: &mut [f64]) {
        self.rows.of_part(part).add_generalised_impulse(&self.problem.p, f);
    }
}

/// Contacts that are reserved for at the most; beyond it, a step with more contacts than ever before allocates. The
/// dense operator of this many takes 2 MB in the plane.
pub(crate) const RESERVED_CONTACTS: usize = 256;
