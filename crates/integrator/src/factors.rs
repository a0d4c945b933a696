//! W of every subsystem, for as many combinations of weights as a scheme has use for.

use crate::blend::{Blends, Term, is_blend};
use crate::compliance::respond_by_solving;
use crate::theta_step::weights;
use crate::{Compliance, Coupling, FactorError, Model, Part, PartRows, Propagator, Vector, Weights};

/// How long the factors of a combination are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// Over steps: W of the step size, M⁻¹.
    Pinned,
    /// For now: W of a part of a step. Such factors share one place, and never take that of a pinned one.
    Once,
}

/// Combinations that are kept of each subsystem, the one for now not among them: the one asked for the longest ago makes place.
const PINNED: usize = 8;

struct Entry<const D: usize> {
    factor: Box<dyn Compliance<D>>,
    keep: Keep,
    /// When it was last asked for.
    asked: u64,
}

/// The factors of a model's subsystems by their weights: bounded, and without an allocation once as many combinations have been asked for as
/// are kept.
pub(crate) struct Factors<const D: usize> {
    /// Of each subsystem, the factors that are kept; what was asked for last stands first.
    parts: Vec<Vec<Entry<D>>>,
    /// The weights that stand first in all lists.
    front: Option<Weights>,
    round: u64,
    /// Of each subsystem, its motion in closed form, once somebody has asked for it.
    propagators: Vec<Option<Box<dyn Propagator<D>>>>,
    /// Sums of two of them.
    blends: Blends<D>,
    /// How many matrices were factorised.
    made: u64,
}

/// Which factors to take for each subsystem.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Responses<'a> {
    /// Those of one combination.
    Of(Weights),
    /// What constant forces over h (s) do to the place at its end, as (2/h²) D: that of their
    /// [`Propagator`], where subsystems have one, else the inverse of M + ½hC + ¼h²K.
    Over(f64),
    /// One combination for each subsystem, in the order in which they were added to the model.
    Each(&'a [Weights]),
}

impl Responses<'_> {
    /// The combination of a subsystem, by its number.
    #[must_use]
    pub fn of(&self, part: usize) -> Option<Weights> {
        match self {
            Self::Of(weights) => Some(*weights),
            Self::Over(h) => Some(weights(*h, 0.5)),
            Self::Each(weights) => weights.get(part).copied(),
        }
    }
}

/// How a subsystem responds to contacts.
pub(crate) enum Answer<'a, const D: usize> {
    /// By the inverse of a combination.
    Inverse(&'a mut dyn Compliance<D>),
    /// By its motion under constant forces.
    Motion(&'a mut dyn Propagator<D>),
}

/// The response to rows of which a factor may have kept nothing in coupling.
#[inline(never)]
fn respond_uncoupled<const D: usize>(
    factor: &mut dyn Compliance<D>,
    rows: &PartRows<'_, D>,
    p: &[Vector<D>],
    scratch: &mut [f64],
    v: &mut [f64],
) {
    if factor.is_diagonal() {
        factor.respond(rows, p, scratch, v);
    } else {
        respond_by_solving(rows, p, scratch, v, |f| factor.solve(f));
    }
}

impl<const D: usize> Answer<'_, D> {
    pub(crate) fn is_diagonal(&self) -> bool {
        match self {
            Self::Inverse(factor) => factor.is_diagonal(),
            Self::Motion(_) => false,
        }
    }

    pub(crate) fn couple(&mut self, rows: &PartRows<'_, D>, scratch: &mut [f64], h: &mut Coupling<'_, D>) {
        match self {
            Self::Inverse(factor) => factor.couple(rows, scratch, h),
            Self::Motion(motion) => motion.couple(rows, h),
        }
    }

    /// Whether it is elastic, and its velocity at the end only that of the trapezoidal rule, which rings.
    pub(crate) fn rings(&self) -> bool {
        matches!(self, Self::Inverse(factor) if !factor.is_diagonal())
    }

    /// Adds what impulses over the time do to the velocities at its end.
    pub(crate) fn couple_rates(&mut self, rows: &PartRows<'_, D>, scratch: &mut [f64], h: &mut Coupling<'_, D>) {
        match self {
            Self::Inverse(factor) => factor.couple(rows, scratch, h),
            Self::Motion(motion) => motion.couple_rates(rows, h),
        }
    }

    /// `coupled` says whether these rows were those that were coupled last.
    pub(crate) fn respond(
        &mut self,
        rows: &PartRows<'_, D>,
        p: &[Vector<D>],
        scratch: &mut [f64],
        v: &mut [f64],
        coupled: bool,
    ) {
        match self {
            Self::Inverse(factor) if coupled => factor.respond(rows, p, scratch, v),
            Self::Inverse(factor) => respond_uncoupled(*factor, rows, p, scratch, v),
            Self::Motion(motion) => motion.respond(rows, p, v),
        }
    }
}

/// How the subsystems respond to contacts, one by one.
pub(crate) struct Answers<'f, const D: usize> {
    factors: &'f mut Factors<D>,
    responses: &'f Responses<'f>,
    /// Whether it is the factors that were asked for last, as nearly always.
    in_front: bool,
}

impl<const D: usize> Answers<'_, D> {
    /// How a subsystem responds.
    #[inline]
    pub(crate) fn of(&mut self, part: usize) -> Option<Answer<'_, D>> {
        match self.in_front {
            true => Some(Answer::Inverse(self.factors.first(part)?)),
            false => self.factors.answer(part, self.responses),
        }
    }
}

impl<const D: usize> Factors<D> {
    pub(crate) fn new() -> Self {
        let (propagators, blends) = (Vec::new(), Blends::new());
        Self { parts: Vec::new(), front: None, round: 0, propagators, blends, made: 0 }
    }

    pub(crate) fn made(&self) -> u64 {
        self.made
    }

    /// Sees to it that there are factors of these weights for all subsystems.
    #[inline]
    pub(crate) fn make(&mut self, model: &Model<D>, w: Weights, q: &[f64], keep: Keep) -> Result<(), FactorError> {
        if self.front == Some(w) { Ok(()) } else { self.bring_to_front(model, w, q, keep) }
    }

    #[cold]
    fn bring_to_front(&mut self, model: &Model<D>, w: Weights, q: &[f64], keep: Keep) -> Result<(), FactorError> {
        self.front = None;
        if self.parts.len() != model.parts().len() {
            self.parts.clear();
            self.parts.resize_with(model.parts().len(), Vec::new);
        }
        self.round += 1;
        for index in 0..self.parts.len() {
            self.fetch(model, index, w, q, keep)?;
        }
        self.front = Some(w);
        Ok(())
    }

    /// Brings the factor of a subsystem to the front of its list.
    fn fetch(&mut self, model: &Model<D>, index: usize, w: Weights, q: &[f64], keep: Keep) -> Result<(), FactorError> {
        let (part, entries, asked) = (&model.parts()[index], &mut self.parts[index], self.round);
        let q = &q[part.q.clone()];
        if let Some(at) = entries.iter().position(|entry| entry.factor.weights() == w) {
            entries[at].asked = asked;
            if keep == Keep::Pinned {
                entries[at].keep = keep;
            }
            entries.swap(0, at);
            // One that was for now is pinned: another goes.
            let pinned = entries.iter().enumerate().filter(|(_, entry)| entry.keep == Keep::Pinned);
            if pinned.clone().count() > PINNED
                && let Some((oldest, _)) = pinned.min_by_key(|(_, entry)| entry.asked)
            {
                entries.remove(oldest);
            }
            return Ok(());
        }
        self.made += 1;
        let of_kind = || entries.iter().enumerate().filter(|(_, entry)| entry.keep == keep);
        let room = if keep == Keep::Pinned { PINNED } else { 1 };
        let longest_ago = of_kind().min_by_key(|(_, entry)| entry.asked).map(|(at, _)| at);
        match longest_ago.filter(|_| of_kind().count() >= room) {
            None => {
                let factor = part.system.factor(w, q)?;
                entries.insert(0, Entry { factor, keep, asked });
            }
            Some(at) => {
                if let Err(error) = entries[at].factor.refactor(w, q) {
                    // It may hold neither these weights nor those before.
                    entries.remove(at);
                    return Err(error);
                }
                entries[at].asked = asked;
                entries.swap(0, at);
            }
        }
        Ok(())
    }

    /// Sees to it that there are sums of two factors, as [`Blends::make`].
    pub(crate) fn make_blends(
        &mut self,
        model: &Model<D>,
        key: Weights,
        keep: Keep,
        q: &[f64],
        terms: impl Fn(&Part<D>) -> [Term; 2],
    ) -> Result<(), FactorError> {
        self.made += self.blends.make(model, key, keep, q, terms)?;
        Ok(())
    }

    /// The two factors of a sum; `None` where it was not made.
    pub(crate) fn terms(&mut self, part: usize, key: Weights) -> Option<[&mut dyn Compliance<D>; 2]> {
        self.blends.terms(part, key)
    }

    /// The factor of a subsystem; `None` where it was not made.
    #[inline]
    pub(crate) fn of(&mut self, part: usize, w: Weights) -> Option<&mut dyn Compliance<D>> {
        if self.front == Some(w) { Some(self.first(part)?) } else { self.of_further_back(part, w) }
    }

    #[inline]
    fn first(&mut self, part: usize) -> Option<&mut (dyn Compliance<D> + 'static)> {
        Some(self.parts.get_mut(part)?.first_mut()?.factor.as_mut())
    }

    #[inline(never)]
    fn of_further_back(&mut self, part: usize, w: Weights) -> Option<&mut dyn Compliance<D>> {
        if is_blend(w) {
            return self.blends.of(part, w);
        }
        let entry = self.parts.get_mut(part)?.iter_mut().find(|entry| entry.factor.weights() == w)?;
        Some(entry.factor.as_mut())
    }

    /// Sees to it that subsystems have their motion in closed form, where there is one.
    pub(crate) fn make_propagators(&mut self, model: &Model<D>) {
        if self.propagators.len() != model.parts().len() {
            self.propagators = model.parts().iter().map(|part| part.system.propagator()).collect();
        }
    }

    /// The motion of a subsystem in closed form.
    pub(crate) fn propagator(&mut self, part: usize) -> Option<&mut (dyn Propagator<D> + 'static)> {
        self.propagators.get_mut(part)?.as_deref_mut()
    }

    /// How the subsystems respond.
    #[inline]
    pub(crate) fn answers<'f>(&'f mut self, responses: &'f Responses<'f>) -> Answers<'f, D> {
        let in_front = self.has_in_front(responses);
        Answers { factors: self, responses, in_front }
    }

    /// How a subsystem responds.
    #[inline(never)]
    pub(crate) fn answer(&mut self, part: usize, responses: &Responses<'_>) -> Option<Answer<'_, D>> {
        let w = match responses {
            Responses::Of(w) => *w,
            Responses::Over(_) if self.propagators.get(part).is_some_and(Option::is_some) => {
                return Some(Answer::Motion(self.propagator(part)?));
            }
            Responses::Over(_) | Responses::Each(_) => responses.of(part)?,
        };
        self.of(part, w).map(Answer::Inverse)
    }

    /// As [`Factors::of`], for someone who may give it other weights.
    pub(crate) fn lend(&mut self, part: usize, w: Weights) -> Option<&mut dyn Compliance<D>> {
        let first = self.front.take() == Some(w);
        let entries = self.parts.get_mut(part)?;
        let at = if first { 0 } else { entries.iter().position(|entry| entry.factor.weights() == w)? };
        Some(entries.get_mut(at)?.factor.as_mut())
    }

    /// The first subsystem that lacks the factor asked for.
    #[inline]
    pub(crate) fn missing(&mut self, model: &Model<D>, responses: &Responses<'_>) -> Option<usize> {
        if self.has_in_front(responses) { None } else { self.missing_further_back(model, responses) }
    }

    #[inline(never)]
    fn missing_further_back(&mut self, model: &Model<D>, responses: &Responses<'_>) -> Option<usize> {
        (0..model.parts().len()).find(|part| responses.of(*part).is_none_or(|w| self.of(*part, w).is_none()))
    }

    /// Whether these are the factors that were asked for last.
    #[inline]
    fn has_in_front(&self, responses: &Responses<'_>) -> bool {
        matches!((responses, self.front), (Responses::Of(w), Some(front)) if *w == front)
    }
}
