//! The smooth motion between two events: accelerations under forces, with the contacts that press.

use super::FLOOR;
use super::linear::Linear;
use super::modes::{Mode, Pressing};
use crate::subsystem::dot;
use crate::{
    Account, ContactStage, Memory, Model, Responses, StepEnergy, StepError, Vector, WarmStart, Weights, Workspace,
};
use nalgebra::Matrix4;
use teeter_contact::{Outcome, Residual, Status};
use teeter_detect::{Candidates, ContactId};

/// W at an instant: M⁻¹.
pub(super) const MASSES: Weights = Weights { mass: 1.0, damping: 0.0, stiffness: 0.0 };

/// What the right-hand side has integrated beside places and velocities: work of loads and of
/// dampers, J; then for each contact its impulse (N·s) and the work of its normal and tangential
/// force (J); then the coordinates, for their mean.
const WORKS: usize = 2;
const OF_CONTACT: usize = 4;

/// Where nothing accelerates a contact, its scale is this part of what turning at its velocities would do: what is left is
/// rounding.
const LEAST_SCALE: f64 = 1e-3;

/// Contacts that share friction are at its limit together, up to this part of their scale.
const SHARED: f64 = 1e-6;

/// Rounds in search of forces within all friction cones, and the factor of the weight of what is outside of its own: weights
/// reach a million, as much as the solution of a singular system allows.
const WEIGHTINGS: usize = 12;
const HEAVIER: f64 = 3.0;

/// A determinant below this, of a matrix with 1 on its diagonal, is 0.
const SINGULAR: f64 = 1e-12;

/// A contact has at least this part of the largest normal force where friction is shared.
const LEAST_SHARE: f64 = 1e-6;

/// By how much contacts were corrected, as a part of the largest coordinate and of the largest velocity, at least [`FLOOR`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Correction {
    pub(super) of_places: f64,
    pub(super) of_velocities: f64,
}

fn largest_change(before: &[f64], after: &[f64]) -> f64 {
    let change = before.iter().zip(after).map(|(before, after)| (after - before).abs()).fold(0.0, f64::max);
    change / before.iter().fold(FLOOR, |largest, x| largest.max(x.abs()))
}

/// The right-hand side.
#[derive(Debug)]
pub(super) struct Smooth {
    pub(super) contacts: Vec<Pressing>,
    ids: Vec<ContactId>,
    /// Rows of the contacts where accelerations were taken last.
    pub(super) stage: ContactStage<2>,
    /// Of one contact, beside the stage.
    pub(super) one: ContactStage<2>,
    found: Candidates<2>,
    pub(super) probes: Candidates<2>,
    /// Of those found, how far it is to the end of their surface, m.
    pub(super) rooms: Vec<f64>,
    /// Accelerations without contacts; then those with them.
    pub(super) a: Vec<f64>,
    /// Velocities, prescribed ones at their time.
    pub(super) v: Vec<f64>,
    load: Vec<f64>,
    force: Vec<f64>,
    product: Vec<f64>,
    pub(super) q_probe: Vec<f64>,
    linear: Linear,
    /// Contact and component of each unknown of a system.
    unknowns: Vec<(usize, usize)>,
    /// Of contacts over which the law of accelerations is solved: J̇v, to which side they slide, and
    /// what their accelerations without contacts consist of, in size.
    pub(super) posed: Vec<(Vector<2>, Option<f64>, f64)>,
    /// The part of a step of the method at which a contact was seen to pull, or to be over its friction.
    pub(super) pulled: Option<f64>,
    /// Between these times loads and drives are smooth, s.
    pub(super) between: [f64; 2],
}

impl Smooth {
    pub(super) fn new() -> Self {
        Self {
            contacts: Vec::new(),
            ids: Vec::new(),
            stage: ContactStage::new().acting_as_found(),
            one: ContactStage::new().acting_as_found(),
            found: Vec::new(),
            probes: Vec::new(),
            rooms: Vec::new(),
            a: Vec::new(),
            v: Vec::new(),
            load: Vec::new(),
            force: Vec::new(),
            product: Vec::new(),
            q_probe: Vec::new(),
            linear: Linear::default(),
            unknowns: Vec::new(),
            posed: Vec::new(),
            pulled: None,
            between: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    pub(super) fn reserve(&mut self, model: &Model<2>) {
        let contacts = model.detector().capacity().min(crate::stage::RESERVED_CONTACTS);
        self.contacts.reserve(contacts.saturating_sub(self.contacts.len()));
        self.ids.reserve(contacts);
        self.stage.reserve(model);
        self.one.reserve(model);
        self.found.reserve(contacts);
        self.probes.reserve(contacts);
        self.rooms.reserve(contacts);
        self.linear.reserve(2 * contacts.min(16));
        self.unknowns.reserve(2 * contacts);
        self.posed.reserve(contacts);
        self.resize(model);
    }

    pub(super) fn resize(&mut self, model: &Model<2>) {
        let size = model.size();
        for x in [&mut self.a, &mut self.v, &mut self.load, &mut self.force, &mut self.product] {
            x.resize(size.v, 0.0);
        }
        self.q_probe.resize(size.q, 0.0);
    }

    /// How many numbers can be integrated.
    pub(super) fn most(&self, model: &Model<2>) -> usize {
        let contacts = model.detector().capacity().min(crate::stage::RESERVED_CONTACTS);
        2 * model.size().q + model.size().v + WORKS + OF_CONTACT * contacts
    }

    /// How many numbers are integrated.
    pub(super) fn len(&self, model: &Model<2>) -> usize {
        2 * model.size().q + model.size().v + WORKS + OF_CONTACT * self.contacts.len()
    }

    /// Writes the derivative of y = (q, v, work, impulses, ∫q) at time `t` (s).
    pub(super) fn slope(
        &mut self,
        model: &Model<2>,
        t: f64,
        y: &[f64],
        work: &mut Workspace<2>,
        out: &mut [f64],
    ) -> Result<(), StepError> {
        let (q, rest) = y.split_at(model.size().q);
        self.accelerate(model, t, q, &rest[..model.size().v], work)?;
        let (dq, rest) = out.split_at_mut(model.size().q);
        let (dv, rest) = rest.split_at_mut(model.size().v);
        let (works, rest) = rest.split_at_mut(WORKS);
        let (impulses, sum) = rest.split_at_mut(OF_CONTACT * self.contacts.len());
        dq.copy_from_slice(&self.v);
        dv.copy_from_slice(&self.a);
        sum.copy_from_slice(q);
        if work.account == Account::Kept {
            works.copy_from_slice(&self.powers(model, q, work));
        } else {
            works.fill(0.0);
        }
        for (out, contact) in impulses.chunks_exact_mut(OF_CONTACT).zip(&self.contacts) {
            let (f, u) = (contact.force, contact.u);
            out.copy_from_slice(&[f[0], f[1], f[0] * u[0], f[1] * u[1]]);
        }
        Ok(())
    }

    /// The work of loads and dampers over a phase that ended with `y`, with that of contacts.
    pub(super) fn energy(&self, model: &Model<2>, y: &[f64]) -> StepEnergy {
        let mut energy = StepEnergy::default();
        let first = model.size().q + model.size().v;
        (energy.external, energy.viscous) = (y[first], y[first + 1]);
        for k in 0..self.contacts.len() {
            let [_, _, normal, friction] = self.of_contact(model, y, k);
            energy.contact += normal;
            energy.friction += friction;
        }
        energy
    }

    fn of_contact(&self, model: &Model<2>, y: &[f64], k: usize) -> [f64; OF_CONTACT] {
        let first = model.size().q + model.size().v + WORKS + OF_CONTACT * k;
        std::array::from_fn(|i| y[first + i])
    }

    /// The impulse of contact `k` over a phase that ended with `y`, N·s.
    pub(super) fn impulse(&self, model: &Model<2>, y: &[f64], k: usize) -> Vector<2> {
        let [normal, tangential, ..] = self.of_contact(model, y, k);
        Vector::<2>::new(normal, tangential)
    }

    /// Completes the contacts of a phase that ended with `y`, as the stage hands them over.
    pub(super) fn finish_contacts(
        &mut self,
        model: &Model<2>,
        y: &[f64],
        work: &mut Workspace<2>,
    ) -> Result<Option<Outcome>, StepError> {
        let (nq, nv) = (model.size().q, model.size().v);
        self.v.copy_from_slice(&y[nq..nq + nv]);
        self.take_rows(model, &y[..nq], work)?;
        for (k, contact) in self.contacts.iter().enumerate() {
            let Some(row) = contact.row else { continue };
            let mut u_law = Vector::zeros();
            if let Mode::Slide(_) = contact.mode {
                let [before, after] = [contact.u_before[1], contact.u[1]];
                u_law[1] = if before.abs() > after.abs() { before } else { after };
            }
            let p = self.impulse(model, y, k);
            self.stage.complete_smooth(row, p, [contact.u_before, contact.u], u_law);
        }
        let solved = Outcome::new(Status::Converged, "event-driven", 0, Residual::new(0.0, 0.0, 0));
        Ok((!self.stage.is_empty()).then_some(solved))
    }

    /// ∫q over a phase that ended with `y`.
    pub(super) fn sum_of_places<'y>(&self, model: &Model<2>, y: &'y [f64]) -> &'y [f64] {
        &y[model.size().q + model.size().v + WORKS + OF_CONTACT * self.contacts.len()..]
    }

    /// Finds velocities and accelerations at time `t` (s), and the contacts' forces.
    pub(super) fn accelerate(
        &mut self,
        model: &Model<2>,
        t: f64,
        q: &[f64],
        v: &[f64],
        work: &mut Workspace<2>,
    ) -> Result<(), StepError> {
        self.accelerate_freely(model, t, q, v, work)?;
        self.take_rows(model, q, work)?;
        if self.stage.is_empty() {
            return Ok(());
        }
        let problem = |source| StepError::Problem { t, source };
        let responses = Responses::Of(MASSES);
        self.stage.couple(model, work, &responses).map_err(problem)?;
        self.find_forces(model, q, work)?;
        for contact in &self.contacts {
            if let Some(row) = contact.row {
                self.stage.push_with(row, contact.force);
            }
        }
        self.stage.respond(model, work, &responses, &mut self.a).map_err(problem)
    }

    /// Leaves velocities, and accelerations without contacts.
    pub(super) fn accelerate_freely(
        &mut self,
        model: &Model<2>,
        t: f64,
        q: &[f64],
        v: &[f64],
        work: &mut Workspace<2>,
    ) -> Result<(), StepError> {
        let t = t.clamp(self.between[0], self.between[1]);
        self.v.copy_from_slice(v);
        model.drive_at(t, &mut self.v);
        self.load.fill(0.0);
        for (index, part) in model.parts().iter().enumerate().filter(|(_, part)| !part.v.is_empty()) {
            let (q, v, a) = (&q[part.q.clone()], &self.v[part.v.clone()], &mut self.a[part.v.clone()]);
            let Some(factor) = work.factors.of(index, MASSES) else { continue };
            if part.traits.follows_coordinates {
                factor.update(q);
            }
            a.fill(0.0);
            part.system.internal_force(q, v, a);
            let load = &mut self.load[part.v.clone()];
            if part.traits.loaded {
                part.system.load(t, load);
                a.iter_mut().zip(load.iter()).for_each(|(a, load)| *a += load);
            }
            self.force[part.v.clone()].copy_from_slice(a);
            if !part.is_driven() {
                factor.solve(a);
                continue;
            }
            let (drives, pull) = (&mut work.scratch[..v.len()], &mut self.product[part.v.clone()]);
            drives.fill(0.0);
            pull.fill(0.0);
            part.system.drive_rate(t, drives);
            part.system.apply(MASSES, q, drives, pull);
            a.iter_mut().zip(pull.iter()).for_each(|(a, pull)| *a -= pull);
            factor.solve(a);
            a.iter_mut().zip(drives.iter()).for_each(|(a, drive)| *a += drive);
        }
        Ok(())
    }

    /// Takes the rows of the contacts at `q`, and their velocities.
    fn take_rows(&mut self, model: &Model<2>, q: &[f64], work: &mut Workspace<2>) -> Result<(), StepError> {
        self.stage.clear();
        if self.contacts.is_empty() {
            return Ok(());
        }
        self.ids.clear();
        self.ids.extend(self.contacts.iter().map(|contact| contact.id));
        work.locate_past_ends(model, q, &self.ids, &mut self.found, &mut self.rooms)?;
        let mut found = self.found.iter().zip(&self.rooms).peekable();
        for contact in &mut self.contacts {
            contact.row = None;
            contact.force = Vector::zeros();
            let Some((candidate, room)) = found.next_if(|(candidate, _)| candidate.id == contact.id) else { continue };
            contact.room = *room;
            let row = self.stage.len();
            if self.stage.add(model, q, candidate, &WarmStart::default(), &Memory::default())? {
                contact.row = Some(row);
                contact.u = self.stage.velocity(row, &self.v)?;
                contact.speed = self.stage.speed(row, &self.v);
            }
        }
        Ok(())
    }

    /// Finds the forces that keep every contact in its mode.
    fn find_forces(&mut self, model: &Model<2>, q: &[f64], work: &mut Workspace<2>) -> Result<(), StepError> {
        let mut found = 0;
        let fastest = self.v.iter().fold(0.0_f64, |fastest, v| fastest.max(v.abs()));
        for i in 0..self.contacts.len() {
            let Pressing { id, row, .. } = self.contacts[i];
            let Some(row) = row else { continue };
            while self.found[found].id != id {
                found += 1;
            }
            let candidate = self.found[found];
            let bias = self.turning(model, q, work, row, &candidate)?;
            let (own, scale) = (self.stage.block(row, row), self.stage.speed(row, &self.a));
            let contact = &mut self.contacts[i];
            contact.own = [own[(0, 0)], own[(1, 1)]];
            contact.scale = (scale + bias.norm()).max(LEAST_SCALE * contact.speed * fastest) + f64::MIN_POSITIVE;
            contact.free = self.stage.velocity(row, &self.a)? + bias;
        }
        self.solve_forces(|_| 1.0);
        self.share_friction();
        self.keep_within_friction();
        self.find_held();
        Ok(())
    }

    /// The same where all is known of the contacts. Of several distributions that with the least sum
    /// of squares is taken, tangential ones by the given weights.
    fn solve_forces(&mut self, weight: impl Fn(&Pressing) -> f64) {
        // Where a load cancels a weight, what is left of accelerations is rounding.
        let solved =
            self.solve(FLOOR, |contact| contact.mode == Mode::Stick, Pressing::slope, |contact| -contact.free, weight);
        self.contacts.iter_mut().for_each(|contact| contact.force = Vector::zeros());
        for (&(k, r), x) in self.unknowns.iter().zip(self.linear.solution()) {
            // Without a solution no step is right: what isn't a number is refused.
            self.contacts[k].force[r] = if solved { *x } else { f64::NAN };
        }
        for contact in &mut self.contacts {
            if contact.mode != Mode::Stick {
                contact.force[1] = contact.slope() * contact.force[0];
            }
        }
    }

    /// Solves J M⁻¹ Jᵀ x = b for the normal and, of contacts with `both`, the tangential components; a
    /// contact without has a tangential one in proportion to the normal one. Whether there is a solution, up to
    /// the rounding of right sides of `least`; it is in the order of `unknowns`.
    fn solve(
        &mut self,
        least: f64,
        both: impl Fn(&Pressing) -> bool,
        slope: impl Fn(&Pressing) -> f64,
        right: impl Fn(&Pressing) -> Vector<2>,
        weight: impl Fn(&Pressing) -> f64,
    ) -> bool {
        let Self { contacts, unknowns, linear, stage, .. } = self;
        unknowns.clear();
        for (k, contact) in contacts.iter().enumerate().filter(|(_, contact)| contact.row.is_some()) {
            unknowns.extend((0..if both(contact) { 2 } else { 1 }).map(|r| (k, r)));
        }
        linear.clear(unknowns.len());
        for (i, &(of, r)) in unknowns.iter().enumerate() {
            linear.right(i, right(&contacts[of])[r]);
            for (j, &(by, c)) in unknowns.iter().enumerate() {
                let (Some(row), Some(column)) = (contacts[of].row, contacts[by].row) else { continue };
                let block = stage.block(row, column);
                let own = if both(&contacts[by]) { 0.0 } else { slope(&contacts[by]) * block[(r, 1)] };
                linear.set(i, j, block[(r, c)] + own);
            }
        }
        linear.solve(least, |i| {
            let (k, r) = unknowns[i];
            if r == 0 { 1.0 } else { weight(&contacts[k]) }
        })
    }

    /// Shares friction among contacts of which more than needed stick by what presses them: then one
    /// of them is at its limit only where all are.
    fn share_friction(&mut self) {
        let sticking = self.contacts.iter().filter(|contact| contact.mode == Mode::Stick && contact.row.is_some());
        let largest = self.contacts.iter().map(|contact| contact.force[0]).fold(0.0, f64::max);
        if sticking.count() < 2 || !(largest > 0.0 && largest.is_finite()) {
            return;
        }
        for contact in &mut self.contacts {
            contact.alone = contact.force;
        }
        self.solve_forces(|contact| (largest / contact.alone[0].max(LEAST_SHARE * largest)).max(1.0));
        if self.contacts.iter().any(|contact| contact.force.iter().any(|f| f.is_nan())) {
            self.contacts.iter_mut().for_each(|contact| contact.force = contact.alone);
        }
    }

    /// Of several distributions of forces, looks for one in which no contact is over its friction: what is over it gets a larger
    /// weight, round by round. Where there is none the first one stays.
    fn keep_within_friction(&mut self) {
        let is_over = |contact: &Pressing| contact.holds() < -SHARED;
        if !self.contacts.iter().any(is_over) {
            return;
        }
        for contact in &mut self.contacts {
            (contact.alone, contact.weight) = (contact.force, 1.0);
        }
        for _ in 0..WEIGHTINGS {
            for contact in self.contacts.iter_mut().filter(|contact| is_over(contact)) {
                contact.weight *= HEAVIER;
            }
            self.solve_forces(|contact| contact.weight);
            // Also true for NaN.
            if !self.contacts.iter().all(|contact| contact.presses() >= -SHARED) {
                break;
            }
            if !self.contacts.iter().any(is_over) {
                return;
            }
        }
        self.contacts.iter_mut().for_each(|contact| contact.force = contact.alone);
    }

    /// Finds how far contacts are from sliding. Where a body can't move along one of them while another sticks, as two feet of a block on
    /// the same ground, none can slide alone: they do so together, when the last is at its limit. Others that share friction do so to some
    /// 1e-8 only: where one of them reached its limit before the others, it could not slide, and would stick again at once.
    fn find_held(&mut self) {
        let Self { contacts, stage, .. } = self;
        for k in 0..contacts.len() {
            let Pressing { mode, row, .. } = contacts[k];
            let own = contacts[k].holds();
            let together = |other: &Pressing| {
                let rows = row.zip(other.row).filter(|_| mode == Mode::Stick && other.mode == Mode::Stick);
                let rows = rows.filter(|(row, other)| row != other && stage.block(*row, *other)[(1, 1)] != 0.0);
                rows.is_some_and(|(row, beside)| {
                    (other.holds() - own).abs() <= SHARED || slide_together(stage, [row, beside])
                })
            };
            let held = contacts.iter().filter(|other| together(other)).map(Pressing::holds).fold(own, f64::max);
            contacts[k].held = held;
        }
    }

    /// Powers of loads and drives, and of dampers, W.
    fn powers(&mut self, model: &Model<2>, q: &[f64], work: &mut Workspace<2>) -> [f64; WORKS] {
        let [mut external, mut viscous] = [0.0; WORKS];
        for (index, part) in model.parts().iter().enumerate().filter(|(_, part)| !part.v.is_empty()) {
            let (q, v) = (&q[part.q.clone()], &self.v[part.v.clone()]);
            let product = &mut self.product[part.v.clone()];
            if part.traits.loaded {
                external += dot(v, &self.load[part.v.clone()]);
            }
            if part.traits.damped {
                viscous -= part.system.damping_power(q, v, product);
            }
            if part.is_driven() {
                // What the drives give: momentum gained less all other forces.
                product.fill(0.0);
                part.system.apply(MASSES, q, &self.a[part.v.clone()], product);
                let pushed = &mut work.scratch[..v.len()];
                pushed.fill(0.0);
                self.stage.add_generalised_impulse(index, pushed);
                for &k in &part.traits.driven {
                    external += v[k] * (product[k] - self.force[part.v.start + k] - pushed[k]);
                }
            }
        }
        [external, viscous]
    }

    /// Takes what rounding and the error of a step left off places and velocities: gaps go to their
    /// levels, and contacts don't part or, where they stick, slide. `y` has the impulses it took, and their work.
    pub(super) fn project(
        &mut self,
        model: &Model<2>,
        t: f64,
        y: &mut [f64],
        work: &mut Workspace<2>,
    ) -> Result<Correction, StepError> {
        let (nq, nv, responses) = (model.size().q, model.size().v, Responses::Of(MASSES));
        model.drive_at(t.clamp(self.between[0], self.between[1]), &mut y[nq..nq + nv]);
        self.v.copy_from_slice(&y[nq..nq + nv]);
        self.take_rows(model, &y[..nq], work)?;
        let problem = |source| StepError::Problem { t, source };
        self.stage.couple(model, work, &responses).map_err(problem)?;
        for contact in &mut self.contacts {
            let at = self.found.binary_search_by_key(&contact.id, |candidate| candidate.id);
            contact.free[0] = at.map_or(0.0, |at| contact.level - self.found[at].gap);
        }
        let mut correction = Correction::default();
        if self.contacts.iter().any(|contact| contact.free[0] != 0.0)
            && self.solve(0.0, |_| false, |_| 0.0, |contact| contact.free, |_| 1.0)
        {
            self.push_with_solution(|_| 0.0);
            self.a.fill(0.0);
            self.stage.respond(model, work, &responses, &mut self.a).map_err(problem)?;
            self.q_probe.copy_from_slice(&y[..nq]);
            model.move_along(&self.q_probe, &self.a, 1.0, &mut y[..nq]);
            correction.of_places = largest_change(&self.q_probe, &y[..nq]);
        }
        // Friction belongs to it: a bounce that was too low to count may be all of it.
        if self.solve(0.0, |contact| contact.mode == Mode::Stick, Pressing::slope, |contact| -contact.u, |_| 1.0) {
            self.push_with_solution(Pressing::slope);
            self.v.copy_from_slice(&y[nq..nq + nv]);
            self.stage.respond(model, work, &responses, &mut y[nq..nq + nv]).map_err(problem)?;
            for k in 0..self.contacts.len() {
                let Some(row) = self.contacts[k].row else { continue };
                let p = self.stage.impulse(row).unwrap_or_else(Vector::zeros);
                let first = nq + nv + WORKS + OF_CONTACT * k;
                let mean = 0.5 * (self.contacts[k].u + self.stage.velocity(row, &y[nq..nq + nv])?);
                let took = [p[0], p[1], p[0] * mean[0], p[1] * mean[1]];
                y[first..first + OF_CONTACT].iter_mut().zip(took).for_each(|(y, took)| *y += took);
            }
            correction.of_velocities = largest_change(&self.v, &y[nq..nq + nv]);
        }
        Ok(correction)
    }

    /// Gives the stage what was solved for with these slopes.
    fn push_with_solution(&mut self, slope: impl Fn(&Pressing) -> f64) {
        let Self { contacts, unknowns, linear, stage, .. } = self;
        contacts.iter().filter_map(|contact| contact.row).for_each(|row| stage.push_with(row, Vector::zeros()));
        for (&(k, r), x) in unknowns.iter().zip(linear.solution()) {
            if let Some(row) = contacts[k].row {
                let mut p = stage.impulse(row).unwrap_or_else(Vector::zeros);
                p[r] = *x;
                if r == 0 {
                    p[1] = slope(&contacts[k]) * x;
                }
                stage.push_with(row, p);
            }
        }
    }
}

/// Whether two contacts that keep their gaps either both slide or both stick: J M⁻¹ Jᵀ of their four components is singular.
fn slide_together(stage: &ContactStage<2>, rows: [usize; 2]) -> bool {
    let entry = |i: usize, j: usize| stage.block(rows[i / 2], rows[j / 2])[(i % 2, j % 2)];
    let gram = Matrix4::from_fn(|i, j| entry(i, j) / (entry(i, i) * entry(j, j)).sqrt());
    gram.determinant().abs() <= SINGULAR
}
