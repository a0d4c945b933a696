//! A response that is the sum of two: c₀ W₀ + c₁ W₁, by the factors of both.

use crate::{Compliance, Coupling, FactorError, Keep, Model, Part, PartRows, Vector, Weights};

/// A term of the sum: its coefficient and the weights of its factor.
pub(crate) type Term = (f64, Weights);

/// The key of a sum of which one term has these weights: a mass below 0, as no combination that
/// is factorised has.
pub(crate) fn key_of(w: Weights) -> Weights {
    Weights { mass: -w.mass, ..w }
}

/// Whether weights are the key of a sum.
#[inline]
pub(crate) fn is_blend(w: Weights) -> bool {
    w.mass < 0.0
}

/// c₀ W₀ + c₁ W₁ of one subsystem.
struct Blend<const D: usize> {
    key: Weights,
    terms: [(f64, Box<dyn Compliance<D>>); 2],
    one: Vec<f64>,
    sum: Vec<f64>,
}

/// The blends of all subsystems: those of the step size, and those for now.
pub(crate) struct Blends<const D: usize> {
    pinned: Vec<Blend<D>>,
    once: Vec<Blend<D>>,
}

impl<const D: usize> Blends<D> {
    pub(crate) fn new() -> Self {
        Self { pinned: Vec::new(), once: Vec::new() }
    }

    /// Sees to it that there are the blends that `terms` gives for each subsystem, by a key that is
    /// no combination of weights; returns how many matrices were factorised.
    ///
    /// # Errors
    /// If a matrix can't be factorised.
    pub(crate) fn make(
        &mut self,
        model: &Model<D>,
        key: Weights,
        keep: Keep,
        q: &[f64],
        terms: impl Fn(&Part<D>) -> [Term; 2],
    ) -> Result<u64, FactorError> {
        let own = if keep == Keep::Pinned { &mut self.pinned } else { &mut self.once };
        let parts = model.parts();
        if own.len() == parts.len() && own.iter().all(|blend| blend.key == key) {
            return Ok(0);
        }
        // What fails halfway is none.
        let mut old = std::mem::take(own);
        if old.len() != parts.len() {
            old.clear();
            for part in parts {
                let q = &q[part.q.clone()];
                let [(c0, w0), (c1, w1)] = terms(part);
                let terms = [(c0, part.system.factor(w0, q)?), (c1, part.system.factor(w1, q)?)];
                old.push(Blend { key, terms, one: vec![0.0; part.v.len()], sum: vec![0.0; part.v.len()] });
            }
        } else {
            for (blend, part) in old.iter_mut().zip(parts) {
                let q = &q[part.q.clone()];
                for (own, (c, w)) in blend.terms.iter_mut().zip(terms(part)) {
                    own.0 = c;
                    if own.1.weights() != w {
                        own.1.refactor(w, q)?;
                    }
                }
                blend.key = key;
            }
        }
        *own = old;
        Ok(2 * parts.len() as u64)
    }

    fn find(&mut self, part: usize, key: Weights) -> Option<&mut Blend<D>> {
        let own = |blends: &[Blend<D>]| blends.get(part).is_some_and(|blend| blend.key == key);
        let from = if own(&self.pinned) { &mut self.pinned } else { &mut self.once };
        from.get_mut(part).filter(|blend| blend.key == key)
    }

    /// The blend of a subsystem, by its key.
    pub(crate) fn of(&mut self, part: usize, key: Weights) -> Option<&mut dyn Compliance<D>> {
        self.find(part, key).map(|blend| -> &mut dyn Compliance<D> { blend })
    }

    /// The factors of a subsystem's two terms.
    pub(crate) fn terms(&mut self, part: usize, key: Weights) -> Option<[&mut dyn Compliance<D>; 2]> {
        let [(_, first), (_, second)] = &mut self.find(part, key)?.terms;
        Some([first.as_mut(), second.as_mut()])
    }
}

impl<const D: usize> Compliance<D> for Blend<D> {
    fn weights(&self) -> Weights {
        self.key
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        Err(FactorError { weights: w, reason: "a sum of two responses has no other weights".to_owned() })
    }

    fn update(&mut self, q: &[f64]) {
        self.terms.iter_mut().for_each(|(_, factor)| factor.update(q));
    }

    fn is_diagonal(&self) -> bool {
        self.terms.iter().all(|(_, factor)| factor.is_diagonal())
    }

    fn solve(&mut self, f: &mut [f64]) {
        self.sum.fill(0.0);
        for (c, factor) in self.terms.iter_mut().filter(|(c, _)| *c != 0.0) {
            self.one.copy_from_slice(f);
            factor.solve(&mut self.one);
            self.sum.iter_mut().zip(&self.one).for_each(|(sum, x)| *sum += *c * x);
        }
        f.copy_from_slice(&self.sum);
    }

    fn couple(&mut self, rows: &PartRows<'_, D>, scratch: &mut [f64], h: &mut Coupling<'_, D>) {
        for (c, factor) in self.terms.iter_mut().filter(|(c, _)| *c != 0.0) {
            h.scaled(*c, |h| factor.couple(rows, scratch, h));
        }
    }

    fn respond(&mut self, rows: &PartRows<'_, D>, p: &[Vector<D>], scratch: &mut [f64], v: &mut [f64]) {
        for (c, factor) in self.terms.iter_mut().filter(|(c, _)| *c != 0.0) {
            self.one.fill(0.0);
            factor.respond(rows, p, scratch, &mut self.one);
            v.iter_mut().zip(&self.one).for_each(|(v, x)| *v += *c * x);
        }
    }
}
