//! The normal force of a contact with duration over one step, so that its energy account closes at any stiffness.
//!
//! The spring's potential is V(g) = k ⟨−g⟩ⁿ⁺¹/(n+1), with n = 1 for Kelvin–Voigt. Over a step that takes the gap from g⁰ to
//! g¹ = g⁰ + h U_θ the mean force is the discrete gradient
//!
//! ```text
//! F = −(V(g¹) − V(g⁰)) / (g¹ − g⁰)
//! ```
//!
//! so that the spring's part of the work, h F U_θ, is exactly −ΔV (Gonzalez 1996, doi 10.1007/BF02440162). Damping takes from
//! it, and the sum never pulls:
//!
//! ```text
//! Hunt–Crossley   p = h F ⟨1 − d U_θ⟩
//! Kelvin–Voigt    p = h ⟨F + c (⟨−g¹⟩ − ⟨−g⁰⟩)/h⟩
//! ```
//!
//! U_θ p + ΔV ≤ 0 in both, whatever h and k. As a function of U¹ the impulse falls, and is convex: Newton's method from the
//! side of compression converges.

use crate::grazing::Grazing;
use crate::{ImpactLaw, Memory, Mismatch, Model, State, Workspace};
use teeter_detect::{Anchor, BodyId, Candidate, Candidates, ContactId, LawId};

/// A contact's spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spring {
    stiffness: f64,
    damping: f64,
    exponent: f64,
    /// Whether damping goes with the force of the spring (Hunt–Crossley) or with the rate of penetration (Kelvin–Voigt).
    proportional: bool,
}

impl ImpactLaw {
    /// The spring of a law with duration; `None` for impacts of an instant.
    pub(crate) fn spring(&self) -> Option<Spring> {
        match *self {
            Self::KelvinVoigt { stiffness, damping } => {
                Some(Spring { stiffness, damping, exponent: 1.0, proportional: false })
            }
            Self::HuntCrossley { stiffness, damping, exponent } => {
                Some(Spring { stiffness, damping, exponent, proportional: true })
            }
            Self::Newton | Self::Poisson | Self::Energetic => None,
        }
    }

    /// Whether contacts have a duration, as they have springs.
    #[must_use]
    pub fn has_duration(&self) -> bool {
        self.spring().is_some()
    }
}

impl<const D: usize> Model<D> {
    /// The spring of a contact's law; `None` for impacts of an instant.
    pub(crate) fn spring(&self, law: LawId) -> Option<Spring> {
        self.law_of(law).ok()?.impact.spring()
    }
}

impl Spring {
    fn force(&self, depth: f64) -> f64 {
        // powf(x, 1) is not x on every machine, and the linear spring is the usual one.
        if self.exponent == 1.0 { self.stiffness * depth } else { self.stiffness * depth.powf(self.exponent) }
    }

    /// The energy stored at a gap, J.
    pub(crate) fn potential(&self, gap: f64) -> f64 {
        let depth = -gap;
        if depth > 0.0 { self.force(depth) * depth / (self.exponent + 1.0) } else { 0.0 }
    }

    /// The depth at which it holds so much energy (J), m.
    fn depth_of(&self, energy: f64) -> f64 {
        let order = self.exponent + 1.0;
        (order * energy / self.stiffness).powf(1.0 / order)
    }

    /// The discrete gradient between two depths, N, and its slope in the second.
    fn mean_force(&self, before: f64, after: f64) -> (f64, f64) {
        let span = after - before;
        if before <= 0.0 && after <= 0.0 {
            return (0.0, 0.0);
        }
        if before < 0.0 {
            let mean = self.potential(-after) / span;
            return (mean, (self.force(after) - mean) / span);
        }
        if after < 0.0 {
            let mean = self.potential(-before) / -span;
            return (mean, mean / -span);
        }
        let (deep, shallow) = (before.max(after), before.min(after));
        // The mean of k δⁿ between the two: k aⁿ ((1+r)ⁿ⁺¹ − 1)/((n+1) r), in a form that keeps its digits for all r.
        let r = (shallow - deep) / deep;
        let order = self.exponent + 1.0;
        let ratio = if r == 0.0 { 1.0 } else { (order * r.ln_1p()).exp_m1() / (order * r) };
        let mean = self.force(deep) * ratio;
        // Where the two are near each other their quotient would be rounding: its limit is half the tangent's slope.
        let slope = if r.abs() < 1e-5 {
            0.5 * self.exponent * self.force(deep) / deep
        } else {
            (self.force(after) - mean) / span
        };
        (mean, slope)
    }
}

/// The spring of a contact with duration over a step, with what doesn't depend on the velocity after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringStep {
    pub(crate) spring: Spring,
    /// Gap at the start of the step, m.
    pub(crate) gap: f64,
    /// Normal velocity at the start of the step, m/s.
    pub(crate) u_before: f64,
    /// Step size, s.
    pub(crate) h: f64,
    /// θ of the step's mean velocity.
    pub(crate) theta: f64,
}

impl SpringStep {
    /// The spring of a law over a step of size `h` (s) that starts at `gap` (m) with normal velocity `u_before` (m/s), θ that of the step's
    /// mean velocity, at least ½; `None` for impacts of an instant.
    #[must_use]
    pub fn new(law: &ImpactLaw, gap: f64, u_before: f64, h: f64, theta: f64) -> Option<Self> {
        Some(Self { spring: law.spring()?, gap, u_before, h, theta: theta.max(0.5) })
    }

    fn mean_velocity(&self, u_after: f64) -> f64 {
        self.theta * u_after + (1.0 - self.theta) * self.u_before
    }

    /// g¹ for a velocity after the step, m.
    pub(crate) fn gap_after(&self, u_after: f64) -> f64 {
        self.gap + self.h * self.mean_velocity(u_after)
    }

    /// The velocity after the step with which it ends at zero gap, m/s.
    pub(crate) fn touching(&self) -> f64 {
        (-self.gap / self.h - (1.0 - self.theta) * self.u_before) / self.theta
    }

    /// The impulse for a velocity after the step, N·s, and its slope in that velocity, kg; neither is of the wrong sign.
    pub(crate) fn impulse(&self, u_after: f64) -> (f64, f64) {
        let Self { spring, gap, h, theta, .. } = *self;
        let mean = self.mean_velocity(u_after);
        let (before, after) = (-gap, -self.gap_after(u_after));
        let (force, slope) = spring.mean_force(before, after);
        let sink = -h * theta;
        if spring.proportional {
            let damped = 1.0 - spring.damping * mean;
            if damped <= 0.0 {
                return (0.0, 0.0);
            }
            return (h * force * damped, h * (slope * sink * damped - force * spring.damping * theta));
        }
        let rate = (after.max(0.0) - before.max(0.0)) / h;
        let rate_slope = if after > 0.0 { sink / h } else { 0.0 };
        let sum = force + spring.damping * rate;
        if sum <= 0.0 || (before <= 0.0 && after <= 0.0) {
            return (0.0, 0.0);
        }
        (h * sum, h * (slope * sink + spring.damping * rate_slope))
    }
}

/// The contacts with duration that a step may touch.
#[derive(Clone, Debug, Default)]
pub(crate) struct Springs<const D: usize> {
    /// Those that the free motion brings into contact, with their gaps at the start of the step, in order of identity.
    touched: Vec<(ContactId, f64)>,
    /// Those that take over the spring of a contact which has ended, with the gaps that they start from, in order of identity.
    heirs: Vec<(ContactId, f64)>,
    /// Those that take no part.
    left_out: Vec<ContactId>,
    /// Of new contacts that are inside at the start of the step, and of pressed ones: where they are then, and how far it is to the end of
    /// their surface, m. Memory of a search.
    inside: Vec<(Candidate<D>, f64)>,
    pressed: Vec<(Candidate<D>, f64)>,
    /// Memory for contacts to look for.
    ids: Vec<ContactId>,
    located: Candidates<D>,
    rooms: Vec<f64>,
    grazing: Grazing<D>,
}

/// A new contact takes over the spring of one that has ended if it is at least this part of that one's depth inside: where a pressed
/// point goes over to another contact, the two depths are equal but for the way of a step.
const AS_DEEP: f64 = 0.5;

/// Contacts that are apart by less than this part of their depth act at one point.
const ONE_POINT: f64 = 1e-2;

/// So many times its depth a corner is at most beside the end of a body when it is found to be over that: up to its depth the end is nearer.
const BESIDE: f64 = 2.0;

/// How well a new contact can go on for a pressed one; less is better, the first difference decides.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Fit {
    /// Whether the two are of different corners, or not at one point.
    is_another: bool,
    is_present: bool,
    /// How far the two are apart, m; 0 where that is one point.
    beyond_one_point: f64,
    /// Gap of the spring, m.
    gap: f64,
    apart: f64,
}

impl<const D: usize> Springs<D> {
    /// Makes room for so many contacts.
    pub(crate) fn reserve(&mut self, contacts: usize) {
        self.touched.reserve(contacts);
        self.ids.reserve(contacts);
        self.heirs.reserve(contacts);
        self.inside.reserve(contacts);
        self.pressed.reserve(contacts);
        self.left_out.reserve(2 * contacts);
        self.located.reserve(contacts);
        self.rooms.reserve(contacts);
        self.grazing.reserve(contacts);
    }

    /// Forgets what was found.
    pub(crate) fn forget(&mut self) {
        self.touched.clear();
        self.heirs.clear();
        self.left_out.clear();
    }

    /// Finds which of the step's contacts, `present` in order of identity, take over the spring of one that has ended: where a disc rolls
    /// over a point of a profile or on to the next beam, or a corner passes an edge, another contact goes on at the depth that the first has
    /// reached, and holds the energy that it held. Both are followed to the start of the step, past their ends. One that is inside there
    /// already, but not over its surface yet, waits while the one before it is present. `some_past`: contacts may be followed past their
    /// ends; those that are past them at the start of the step have ended.
    pub(crate) fn hand_over<'a>(
        &mut self,
        model: &Model<D>,
        state: &State,
        present: impl Iterator<Item = &'a Candidate<D>> + Clone,
        some_past: bool,
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        self.heirs.clear();
        self.left_out.clear();
        let memory = &state.memory;
        let is_pressed = |id: &ContactId| memory.pressed_gap(*id).is_some();
        if !model.has_springs() || !memory.active().iter().any(is_pressed) {
            return Ok(());
        }
        let is_new = |of: &&Candidate<D>| !is_pressed(&of.id) && model.spring(of.law).is_some();
        self.ids.clear();
        self.ids.extend(present.clone().filter(is_new).map(|of| of.id));
        self.inside.clear();
        if !self.ids.is_empty() {
            work.locate_past_ends(model, &state.q, &self.ids, &mut self.located, &mut self.rooms)?;
            // A beam has no foot past its end: what comes over it within the step is known by where it is then.
            for of in present.clone().filter(is_new) {
                let found = self.located.binary_search_by_key(&of.id, |at| at.id);
                self.inside.push(found.map_or((*of, f64::NEG_INFINITY), |k| (self.located[k], self.rooms[k])));
            }
            self.inside.retain(|(new, _)| new.gap < 0.0);
        }
        if self.inside.is_empty() && !some_past {
            return Ok(());
        }
        self.ids.clear();
        self.ids.extend(memory.active().iter().filter(|id| is_pressed(id)));
        work.locate_past_ends(model, &state.q, &self.ids, &mut self.located, &mut self.rooms)?;
        self.pressed.clear();
        self.pressed.extend(self.located.iter().copied().zip(self.rooms.iter().copied()));
        if some_past {
            self.left_out.extend(self.pressed.iter().filter(|(_, room)| *room < 0.0).map(|(ended, _)| ended.id));
        }
        let is_present =
            |(before, room): &(Candidate<D>, f64)| *room >= 0.0 && present.clone().any(|of| of.id == before.id);
        while let Some((k, j, fit)) = self.nearest(model, memory, is_present) {
            let (heir, room) = self.inside.remove(k);
            if fit.is_present && !comes_back(model, &heir, &self.pressed[j].0, fit.apart) {
                // Surfaces that meet overlap by rounding: there both are over theirs, at one point.
                if room < 0.0 || fit.beyond_one_point == 0.0 {
                    self.left_out.push(heir.id);
                }
                continue;
            }
            let (before, _) = self.pressed.remove(j);
            if let (Some(spring), Some(gap)) = (model.spring(heir.law), memory.pressed_gap(before.id)) {
                let gap = match model.spring(before.law) {
                    Some(other) if other != spring => -spring.depth_of(other.potential(gap)),
                    _ => gap,
                };
                self.heirs.push((heir.id, gap));
                self.left_out.push(before.id);
            }
        }
        self.heirs.sort_unstable_by_key(|(id, _)| *id);
        Ok(())
    }

    /// A new contact and a pressed one that it can go on for, by their numbers, with how they fit: those of one corner before all others, those that
    /// have ended before those that are present, and of these the two that are nearest to each other, so that a spring goes to the contact at
    /// its place; at one place first the deepest.
    fn nearest(
        &self,
        model: &Model<D>,
        memory: &Memory,
        is_present: impl Fn(&(Candidate<D>, f64)) -> bool,
    ) -> Option<(usize, usize, Fit)> {
        let mut nearest: Option<(usize, usize, Fit)> = None;
        for (k, (heir, _)) in self.inside.iter().enumerate() {
            for (j, before) in self.pressed.iter().enumerate() {
                let gap = memory.pressed_gap(before.0.id).filter(|gap| heir.gap <= AS_DEEP * gap);
                let (Some(gap), Some(apart)) = (gap, apart(&heir.sides, &before.0.sides)) else { continue };
                let corner = owner(model, heir);
                let beyond_one_point = if apart <= ONE_POINT * -heir.gap { 0.0 } else { apart };
                let is_same = corner.is_some() && corner == owner(model, &before.0) && beyond_one_point == 0.0;
                let fit = Fit { is_another: !is_same, is_present: is_present(before), beyond_one_point, gap, apart };
                if nearest.is_none_or(|(.., known)| fit < known) {
                    nearest = Some((k, j, fit));
                }
            }
        }
        nearest
    }

    /// Whether a contact takes no part in the step, as it has ended or waits for another to end.
    pub(crate) fn leaves_out(&self, id: ContactId) -> bool {
        self.left_out.contains(&id)
    }

    /// The gap that a spring starts the step with which was pressed before, or takes over from one that has ended, m; `None` of others.
    pub(crate) fn kept_gap(&self, id: ContactId, memory: &Memory) -> Option<f64> {
        let inherited = || Some(self.heirs[self.heirs.binary_search_by_key(&id, |(id, _)| *id).ok()?].1);
        memory.pressed_gap(id).or_else(inherited)
    }

    /// Finds the contacts that the free motion from `q` to `q_free` brings into contact.
    pub(crate) fn look(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        q_free: &[f64],
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        work.detect(model, q_free, 0.0)?;
        self.touched.clear();
        self.ids.clear();
        self.ids.extend(work.candidates.iter().filter(|c| model.spring(c.law).is_some()).map(|candidate| candidate.id));
        self.grazing.leave_out(model, q_free, 0.0, &mut self.ids, work)?;
        if self.ids.is_empty() {
            return Ok(());
        }
        self.touched.extend(self.ids.iter().map(|id| (*id, 0.0)));
        work.detect_with(model, q, 0.0, &self.ids, &mut self.located)?;
        for (id, gap) in &mut self.touched {
            if let Ok(at) = work.candidates.binary_search_by_key(id, |candidate| candidate.id) {
                *gap = work.candidates[at].gap;
            }
        }
        Ok(())
    }

    /// Finds the candidates at the predicted coordinates `q` that may be contacts of the step: all within a gap of `within` (m), and all
    /// that were active or are touched.
    pub(crate) fn detect(
        &mut self,
        model: &Model<D>,
        q: &[f64],
        memory: &Memory,
        within: f64,
        work: &mut Workspace<D>,
    ) -> Result<(), Mismatch> {
        self.ids.clear();
        self.ids.extend(self.touched.iter().map(|(id, _)| *id).chain(memory.active().iter().copied()));
        self.ids.sort_unstable();
        self.ids.dedup();
        work.detect_with(model, q, within, &self.ids, &mut self.located)
    }

    /// Whether a candidate at the predicted position is a contact of the step.
    pub(crate) fn admit(&self, spring: bool, candidate: &Candidate<D>, memory: &Memory, gap_tolerance: f64) -> bool {
        if spring {
            memory.pressed_gap(candidate.id).is_some() || self.touches(candidate.id).is_some()
        } else {
            candidate.gap <= gap_tolerance
        }
    }

    fn touches(&self, id: ContactId) -> Option<f64> {
        let at = self.touched.binary_search_by_key(&id, |(id, _)| *id).ok()?;
        Some(self.touched[at].1)
    }

    /// The gap that a contact's spring starts the step with. One that was not touched before holds no energy, so it starts
    /// from zero at the deepest, wherever its point may be.
    pub(crate) fn gap(&self, id: ContactId, memory: &Memory) -> f64 {
        self.kept_gap(id, memory).unwrap_or_else(|| self.touches(id).unwrap_or(0.0).max(0.0))
    }
}

/// Whether a corner takes its spring back from another body's corner below it. Where a block slides from one flush brick to the next, its
/// corner has left the first some steps before it is over the next: beside that by less than it has sunk in, it is nearer to the brick's
/// end. The first brick's corner holds the spring meanwhile; if it kept it, the block would sink in once more at each joint.
fn comes_back<const D: usize>(model: &Model<D>, corner: &Candidate<D>, holder: &Candidate<D>, apart: f64) -> bool {
    let Some(body) = owner(model, corner) else { return false };
    let is_below = holder.sides.iter().any(|side| side.body == body) && owner(model, holder) != Some(body);
    // Not from its own brick's.
    is_below && corner.id.pair() != holder.id.pair() && apart <= BESIDE * -corner.gap
}

/// The body whose corner makes a contact, if a sharp one does.
fn owner<const D: usize>(model: &Model<D>, contact: &Candidate<D>) -> Option<BodyId> {
    Some(contact.sides[model.detector().fixed_side(contact.id)?].body)
}

/// How far apart two contacts are on a body that they share, in its coordinates, m; `None` if they share none.
fn apart<const D: usize>(one: &[Anchor<D>; 2], other: &[Anchor<D>; 2]) -> Option<f64> {
    let pairs = one.iter().flat_map(|one| other.iter().map(move |other| (one, other)));
    let shared = pairs.filter(|(one, other)| one.body == other.body);
    shared.map(|(one, other)| (one.point - other.point).norm()).min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> Vec<Spring> {
        let mut laws = Vec::new();
        for stiffness in [1e4, 1e12] {
            for damping in [0.0, 0.3, 40.0] {
                laws.extend(ImpactLaw::KelvinVoigt { stiffness, damping }.spring());
                for exponent in [1.0, 1.5, 2.0] {
                    laws.extend(ImpactLaw::HuntCrossley { stiffness, damping, exponent }.spring());
                }
            }
        }
        laws
    }

    fn steps() -> impl Iterator<Item = (SpringStep, f64)> {
        let gaps = [-1e-3, -1e-6, -1e-12, 0.0, 1e-9, 1e-4];
        let speeds = [-2.0, -1e-3, -1e-9, 0.0, 1e-6, 0.5];
        laws().into_iter().flat_map(move |spring| {
            gaps.into_iter().flat_map(move |gap| {
                speeds.into_iter().flat_map(move |u_before| {
                    speeds.into_iter().flat_map(move |u_after| {
                        [1e-6, 1e-3].into_iter().flat_map(move |h| {
                            [0.5, 1.0].map(|theta| (SpringStep { spring, gap, u_before, h, theta }, u_after))
                        })
                    })
                })
            })
        })
    }

    #[test]
    fn the_work_of_a_step_is_what_leaves_the_spring_less_a_loss() {
        for (step, u) in steps() {
            let (p, slope) = step.impulse(u);
            assert!(p >= 0.0 && slope <= 0.0 && p.is_finite() && slope.is_finite(), "{step:?} {u} {p} {slope}");
            let (v0, v1) = (step.spring.potential(step.gap), step.spring.potential(step.gap_after(u)));
            let work = p * step.mean_velocity(u) + v1 - v0;
            assert!(work <= 1e-11 * (v0 + v1) + 1e-300, "{step:?} {u} {work}");
            if step.spring.damping == 0.0 {
                assert!(work.abs() <= 1e-11 * (v0 + v1), "{step:?} {u} {work}");
            }
        }
    }

    #[test]
    fn the_slope_is_that_of_the_impulse() {
        for spring in laws() {
            let (mut judged, mut kinks) = (0, 0);
            for (step, u) in steps().filter(|(step, u)| step.spring == spring && u.abs() > 1e-3) {
                let d = 1e-5 * u.abs();
                let (low, high) = (step.impulse(u - d), step.impulse(u + d));
                let (p, slope) = step.impulse(u);
                // At the ends of contact it has a kink, and beyond them there is nothing.
                if low.1 == 0.0 || high.1 == 0.0 || (low.1 / high.1 - 1.0).abs() > 1e-3 {
                    kinks += u32::from(low.1 != 0.0);
                    continue;
                }
                let difference = (high.0 - low.0) / (2.0 * d);
                // Twelve digits of an impulse are right; where that leaves two of the difference, it decides nothing.
                let rounding = 1e-12 * p / d;
                if rounding < 0.01 * slope.abs() {
                    judged += 1;
                    let off = (difference - slope).abs();
                    assert!(off <= 1e-3 * slope.abs() + rounding, "{step:?} {u}: {difference} {slope}");
                }
            }
            assert!(judged >= 100, "{spring:?}: only {judged} judged, {kinks} at a kink");
        }
    }

    #[test]
    fn the_impulse_is_convex_and_falls() {
        for (step, _) in steps() {
            let p = |k: i32| step.impulse(f64::from(k) * 0.01).0;
            for k in -200..200 {
                let bend = p(k - 1) - 2.0 * p(k) + p(k + 1);
                assert!(p(k) <= p(k - 1) && bend >= -1e-9 * p(k - 1), "{step:?} {k} {bend}");
            }
        }
    }
}
