//! The scheme that resolves contact with a beam as a force: `resolved` (`docs/schemes.md`).

mod attempt;
mod pose;

use crate::closed_step::Guarded;
use crate::closed_step::THETA;
use crate::moreau_jean_closed::deepest;
use crate::moreau_jean_located::is_elastic;
use crate::theta_step::{ThetaStep, weights};
use crate::{ContactStage, Keep, Model, Scheme, SettingError, State, StepError, StepReport, StepSpan, Workspace};
use teeter_contact::Outcome;
use teeter_detect::{Candidates, ContactId};

/// The settings of [`Resolved`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResolvedSettings {
    /// Gaps are closed to this, m, or to rounding where that is more.
    pub gap_tolerance: f64,
    /// Where contacts close, steps are halved up to so many times.
    pub levels: u32,
}

impl Default for ResolvedSettings {
    fn default() -> Self {
        Self { gap_tolerance: 1e-12, levels: 6 }
    }
}

/// Most halvings that can be asked for.
const MOST_LEVELS: u32 = 12;

/// A part of a step is taken anew, with half its length, where a contact closes from further away than
/// this part of the way that weight makes in a whole step, a h².
const APPROACH: f64 = 0.1;

/// Parts of a step without a contact that closes, after which they become longer.
const QUIET: u32 = 8;

/// χ: oscillations that turn by more than this angle in a step, rad, follow their forces as if they had no mass.
const CUTOFF: f64 = 4.0;

/// Parts of a step for which there is room from the start, in a model of so many contacts.
const USUAL_PARTS: usize = 64;
const FEW_CONTACTS: usize = 128;

/// What it can't step.
const FOLLOWERS: &str =
    "matrices that follow their coordinates, as of a beam held along its axis: it has no modes that stay";

/// Contact with a beam as a force that holds the gap closed, in steps that are halved where contacts
/// close.
///
/// ```text
/// 0 ≤ (2/h)(g(q¹) − ℓ) ⊥ p_n ≥ 0,   Coulomb on U_t¹ + s_t,   H = (2/h²) J D Jᵀ,   p = hF,   ℓ = min(0, g(q⁰))
/// ```
///
/// D is what a constant force F does to the place at the end of a step: of a beam in its modes by its
/// [`Propagator`](crate::Propagator), else by the trapezoidal rule. Rows are those in the middle of the
/// motion, made a discrete gradient of the gap, so that a contact's work is −F (g(q⁰) − ℓ) ≤ 0; the
/// step is solved again until places stand still. Contacts between bodies obey the rule of
/// [`MoreauJeanClosed`](crate::MoreauJeanClosed).
///
/// A step is taken in parts, h/2ʲ with j up to [`levels`](ResolvedSettings::levels): a part in which a
/// contact closes from afar is taken anew with half its length.
///
/// Restitution and laws with duration at a beam are refused: what a beam gives back is its own
/// elasticity. So are subsystems whose matrices follow their coordinates, such as beams held along
/// their axis: they have no modes that stay.
#[derive(Debug)]
pub struct Resolved<const D: usize> {
    settings: ResolvedSettings,
    step: ThetaStep,
    /// The state at the start of the part of the step that is taken.
    from: Option<Box<State>>,
    stage: ContactStage<D>,
    /// Rows of one contact.
    one: ContactStage<D>,
    v_free: Vec<f64>,
    q_mid: Vec<f64>,
    q_end: Vec<f64>,
    /// Mean velocities of the motion that is known.
    mean: Vec<f64>,
    /// MΔq/h of what has mass.
    momentum: Vec<f64>,
    /// The contacts that take part, in order of identity.
    ids: Vec<ContactId>,
    start: Candidates<D>,
    middle: Candidates<D>,
    ahead: Candidates<D>,
    /// Of each contact of the stage: how it is posed.
    posed: Vec<Posed>,
    /// Of each velocity: whether it is of something elastic.
    elastic: Vec<bool>,
    /// The contacts that were looked at, and whether their gaps are held.
    holds: Vec<(ContactId, bool)>,
    guarded: Guarded,
    stays: Vec<bool>,
    /// The part of the step that is taken.
    of_step: f64,
}

/// How a contact of the stage was posed.
#[derive(Clone, Copy, Debug)]
struct Posed {
    /// Whether its gap is held, not its velocity.
    held: bool,
    /// Its shift were there no restitution.
    resting_shift: f64,
    /// How far it was from its surface at the start of the step, where it was open, m.
    approach: f64,
    /// What weight and loads do to the gap in a whole step, m.
    way: f64,
}

impl<const D: usize> Resolved<D> {
    /// The name by which users choose it.
    pub const NAME: &'static str = "resolved";

    /// A scheme with these settings.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(settings: ResolvedSettings) -> Result<Self, SettingError> {
        let ResolvedSettings { gap_tolerance: gap, levels } = settings;
        if !(gap >= 0.0 && gap.is_finite()) {
            return Err(SettingError { what: "gap_tolerance", value: gap, rule: "at least 0 m" });
        }
        if levels > MOST_LEVELS {
            return Err(SettingError { what: "levels", value: f64::from(levels), rule: "at most 12" });
        }
        Ok(Self {
            settings,
            step: ThetaStep::in_closed_form(CUTOFF),
            from: None,
            stage: ContactStage::new(),
            one: ContactStage::new(),
            v_free: Vec::new(),
            q_mid: Vec::new(),
            q_end: Vec::new(),
            mean: Vec::new(),
            momentum: Vec::new(),
            ids: Vec::new(),
            start: Vec::new(),
            middle: Vec::new(),
            ahead: Vec::new(),
            posed: Vec::new(),
            elastic: Vec::new(),
            holds: Vec::new(),
            guarded: Guarded::default(),
            stays: Vec::new(),
            of_step: 1.0,
        })
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &ResolvedSettings {
        &self.settings
    }

    fn find_what_is_elastic(&mut self, model: &Model<D>, h: f64, work: &mut Workspace<D>) {
        self.elastic.clear();
        for (index, part) in model.parts().iter().enumerate() {
            let is_elastic = is_elastic(part, index, weights(h, THETA), &mut work.factors);
            self.elastic.extend(part.v.clone().map(|_| is_elastic));
        }
    }

    fn resize(&mut self, model: &Model<D>) {
        let size = model.size();
        for v in [&mut self.v_free, &mut self.mean, &mut self.momentum] {
            v.resize(size.v, 0.0);
        }
        for q in [&mut self.q_mid, &mut self.q_end] {
            q.resize(size.q, 0.0);
        }
    }
}

impl<const D: usize> Scheme<D> for Resolved<D> {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn drives_about(&self) -> Option<f64> {
        Some(THETA)
    }

    fn start(&mut self, model: &Model<D>, state: &mut State, work: &mut Workspace<D>) -> Result<(), StepError> {
        if model.parts().iter().any(|part| part.traits.follows_coordinates) {
            return Err(StepError::Unsupported { what: FOLLOWERS });
        }
        self.step.start(model, state, work)?;
        self.resize(model);
        let contacts = model.contacts_to_expect();
        for candidates in [&mut self.start, &mut self.middle, &mut self.ahead, &mut work.candidates] {
            candidates.reserve(contacts);
        }
        self.stage.reserve(model);
        self.one.reserve(model);
        self.ids.reserve(contacts);
        self.posed.reserve(contacts);
        self.holds.reserve(contacts);
        self.guarded.reserve(contacts);
        self.stays.reserve(contacts);
        state.warm.reserve(contacts, D);
        state.memory.reserve(contacts);
        state.memory.reserve_numbers(2);
        let mut from = state.clone();
        from.memory.reserve_numbers(2);
        from.warm.reserve(contacts, D);
        from.memory.reserve(contacts);
        self.from = Some(Box::new(from));
        work.factors.make_propagators(model);
        if contacts <= FEW_CONTACTS {
            work.reserve_phases(model, USUAL_PARTS);
        }
        for level in (0..=self.settings.levels).rev() {
            let h = state.dt / f64::from(1_u32 << level);
            work.factors(model, weights(h, THETA), &state.q, Keep::Pinned)?;
        }
        self.find_what_is_elastic(model, state.dt, work);
        Ok(())
    }

    fn advance<'w>(
        &mut self,
        model: &Model<D>,
        state: &mut State,
        until: f64,
        work: &'w mut Workspace<D>,
    ) -> Result<StepReport<'w, D>, StepError> {
        let span = state.next_step(until);
        work.begin(model, state, span)?;
        self.step.check(model)?;
        self.resize(model);
        work.factors.make_propagators(model);
        let mut from = self.from.take().unwrap_or_else(|| Box::new(state.clone()));
        from.copy_motion(state);
        let taken = self.take_parts(model, &mut from, &span, work);
        self.from = Some(from);
        let grading = taken?;
        let stays = &self.stays;
        let report = work.finish(model, state, Some(grading.penetration), |i, _| stays[i])?;
        state.memory.set_numbers(&[f64::from(grading.level), f64::from(grading.quiet)]);
        Ok(report)
    }
}

/// The size of the parts of a step, h/2^level.
#[derive(Clone, Copy, Debug)]
struct Grading {
    level: u32,
    /// Parts in a row in which nothing closed.
    quiet: u32,
    /// At the end, m.
    penetration: f64,
}

impl<const D: usize> Resolved<D> {
    /// Takes the step in parts, from `from`, which moves on.
    fn take_parts(
        &mut self,
        model: &Model<D>,
        from: &mut State,
        span: &StepSpan,
        work: &mut Workspace<D>,
    ) -> Result<Grading, StepError> {
        let levels = self.settings.levels;
        let [level, quiet] = from.memory.numbers().unwrap_or_default();
        let mut grading = Grading { level: (level as u32).min(levels), quiet: quiet as u32, penetration: 0.0 };
        let all = 1_u32 << levels;
        let mut done = 0;
        while done < all {
            let size = all >> grading.level;
            self.of_step = f64::from(size) / f64::from(all);
            let h = span.h * self.of_step;
            let end = if done + size == all {
                span.end
            } else {
                span.start + span.h * (f64::from(done + size) / f64::from(all))
            };
            let part = StepSpan { start: from.t, end, h };
            let outcome = self.attempt(model, from, &part, work)?;
            let closes = self.posed.iter().any(|posed| posed.approach > APPROACH * posed.way);
            if closes && grading.level < levels {
                (grading.level, grading.quiet) = (grading.level + 1, 0);
                work.counts.refused_attempts += 1;
                continue;
            }
            grading.penetration = deepest(work);
            self.take_part(model, from, &part, outcome, work)?;
            done += size;
            grading.quiet = if closes { 0 } else { grading.quiet.saturating_add(1) };
            if grading.quiet >= QUIET && grading.level > 0 && done % (2 * size) == 0 {
                (grading.level, grading.quiet) = (grading.level - 1, 0);
            }
        }
        Ok(grading)
    }

    /// Ends the part of the step that was attempted, and moves on to its end.
    fn take_part(
        &mut self,
        model: &Model<D>,
        from: &mut State,
        part: &StepSpan,
        outcome: Option<Outcome>,
        work: &mut Workspace<D>,
    ) -> Result<(), StepError> {
        self.find_what_stays();
        from.warm.clear();
        from.memory.forget_contacts();
        for (contact, stays) in self.stage.contacts().iter().zip(&self.stays) {
            if *stays {
                from.warm.push(contact.id, &contact.p);
                from.memory.remember(contact);
            }
        }
        self.end_phase(model, from, part, outcome, work)?;
        from.q.copy_from_slice(&self.step.q_at);
        from.v.copy_from_slice(&self.step.v_end);
        from.t = part.end;
        Ok(())
    }
}
