//! W_be of the source paper: the response of a beam's velocities to the impulses of contacts.
//!
//! The free velocity always takes one substitution with the banded factor. Contacts need little of
//! W, as a contact acts on the dofs of one element. Either each contact's response W Jᵀ is solved
//! for once a step, and kept for the end of the step ([`WBackend::Banded`]); or the columns of W
//! for the dofs that contacts act on are solved for once per factor, and combined
//! ([`WBackend::CachedColumns`]).

use super::{SharedFactors, matrix_weights};
use crate::compliance::{couple_by_solving, respond_by_solving};
use crate::small::{add_outer, add_scaled};
use crate::{Compliance, Coupling, FactorError, PartRows, Vector, Weights};
use nalgebra::Matrix2;
use std::sync::Arc;
use teeter_beam::{Backend, Beam, CholeskyError, Factor};

/// How W of a beam is applied to contacts. The results differ by rounding only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum WBackend {
    /// The faster one for the beam's number of dofs and the step's contacts, by measurement.
    #[default]
    Auto,
    /// A banded substitution for each contact and direction in a step.
    Banded,
    /// The same with a general sparse factor: slower, and an independent way to the same numbers.
    /// Only with the feature `sparse` (default); without it the factor is refused with a
    /// [`FactorError`] that says so.
    Sparse,
    /// Columns of W, each solved for when a contact first acts on its dof, and kept as long as the
    /// factor: at most 64 columns and 16 MiB, but 16 columns of any beam. A step whose contacts act
    /// on more dofs uses substitutions. Which columns are kept changes the time of a step, never
    /// its numbers.
    CachedColumns,
}

/// By default, columns are used in steps whose contacts act on at most the number of dofs divided
/// by this: a single contact on 10 elements takes 40 % fewer instructions by columns than by a
/// substitution (callgrind), and the gain grows with the beam. With many contacts H from columns
/// takes longer.
const TOUCHED: usize = 2;

/// Most columns of W that are kept: the dofs of 16 separate contacts.
const COLUMNS: usize = 64;

/// Most bytes of columns, unless [`FEWEST_COLUMNS`] take more.
const MEMORY: usize = 16 << 20;

/// Columns that are kept for beams of any size: the dofs of a block's four corners.
const FEWEST_COLUMNS: usize = 16;

/// Most responses of contacts that are kept over a step. A substitution takes as long as combining
/// some ten columns, so with more of them one more substitution is faster.
const RESPONSES: usize = 8;

/// W of a beam, zero for its prescribed coordinates.
pub(super) struct BeamCompliance {
    beam: Arc<Beam>,
    weights: Weights,
    /// Its own, or one that others have as well and that nobody changes.
    factor: Arc<Factor>,
    backend: Backend,
    shared: Option<Arc<SharedFactors>>,
    memory: Memory,
}

enum Memory {
    Responses(Responses),
    Columns(Columns),
}

impl BeamCompliance {
    pub(super) fn new(
        beam: &Arc<Beam>,
        w: Weights,
        backend: WBackend,
        shared: Option<&Arc<SharedFactors>>,
    ) -> Result<Self, FactorError> {
        let kind = if backend == WBackend::Sparse { Backend::Sparse } else { Backend::Banded };
        // The factor of a stretched beam follows the coordinates of its model.
        let shared = shared.filter(|_| !beam.is_stretched());
        let found = shared.map_or(Ok(None), |shared| shared.of(w, kind)).map_err(|error| refusal(w, &error))?;
        let factor = match found {
            Some(factor) => factor,
            None => Arc::new(beam.factor_with(matrix_weights(w), kind).map_err(|error| refusal(w, &error))?),
        };
        let dofs = beam.dofs();
        let memory = match backend {
            // The columns of a stretched beam change in every step.
            WBackend::Auto if !beam.is_stretched() => Memory::Columns(Columns::new(dofs, dofs / TOUCHED)),
            WBackend::CachedColumns => Memory::Columns(Columns::new(dofs, dofs)),
            WBackend::Auto | WBackend::Banded | WBackend::Sparse => Memory::Responses(Responses::new(dofs)),
        };
        Ok(Self { beam: Arc::clone(beam), weights: w, factor, backend: kind, shared: shared.cloned(), memory })
    }

    /// Takes the factor of other weights: one that is shared, or its own in the same memory.
    fn take(&mut self, w: Weights) -> Result<(), CholeskyError> {
        let found = self.shared.as_ref().map_or(Ok(None), |shared| shared.of(w, self.backend))?;
        if let Some(factor) = found {
            self.factor = factor;
        } else if let Some(own) = Arc::get_mut(&mut self.factor) {
            self.beam.refactor(matrix_weights(w), own)?;
        } else {
            self.factor = Arc::new(self.beam.factor_with(matrix_weights(w), self.backend)?);
        }
        Ok(())
    }

    /// Its own factor, which follows the coordinates; only that of a stretched beam does, and isn't shared.
    fn own(&mut self) -> Option<(&Beam, &mut Factor)> {
        Some((&self.beam, Arc::get_mut(&mut self.factor)?))
    }
}

fn refusal(weights: Weights, error: &teeter_beam::CholeskyError) -> FactorError {
    let mut reason = error.to_string();
    if let teeter_beam::CholeskyError::MissingFeature { .. } = error {
        reason += ", which the feature `sparse` of teeter-integrator switches on";
    }
    FactorError { weights, reason }
}

/// `f ← W f`.
fn solve(factor: &Factor, f: &mut [f64]) {
    let (own, driven) = f.split_at_mut(factor.dofs());
    factor.solve(own);
    driven.fill(0.0);
}

impl Compliance<2> for BeamCompliance {
    fn weights(&self) -> Weights {
        self.weights
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        if let Memory::Columns(columns) = &mut self.memory {
            columns.forget();
        }
        self.take(w).map_err(|error| refusal(w, &error))?;
        self.weights = w;
        Ok(())
    }

    fn update(&mut self, q: &[f64]) {
        if let Memory::Columns(columns) = &mut self.memory {
            columns.forget();
        }
        if let Some((beam, factor)) = self.own() {
            beam.follow(&q[..beam.dofs()], factor);
        }
    }

    fn stretch(&mut self, tension: f64, weight: f64, g: &[f64]) {
        if let Memory::Columns(columns) = &mut self.memory {
            columns.forget();
        }
        // A factor that could not be made gives NaN, which ends the step as diverged.
        if let Some((beam, factor)) = self.own() {
            let _ = beam.refactor_stretched(tension, weight, &g[..beam.dofs()], factor);
        }
    }

    fn take_tangent(&mut self, q: &[f64]) -> Result<(), FactorError> {
        if let Memory::Columns(columns) = &mut self.memory {
            columns.forget();
        }
        let weights = self.weights;
        let Some((beam, factor)) = self.own() else { return Ok(()) };
        beam.refactor_tangent(&q[..beam.dofs()], factor).map_err(|error| refusal(weights, &error))
    }

    fn solve(&mut self, f: &mut [f64]) {
        solve(&self.factor, f);
    }

    fn couple(&mut self, rows: &PartRows<'_, 2>, scratch: &mut [f64], h: &mut Coupling<'_, 2>) {
        let Self { factor, memory, .. } = self;
        match memory {
            Memory::Responses(responses) => responses.couple(factor, rows, scratch, h),
            Memory::Columns(columns) => {
                columns.ready = columns.fetch(factor, rows);
                if columns.ready {
                    columns.couple(rows, h);
                } else {
                    couple_by_solving(rows, scratch, h, |f| solve(factor, f), |_, _, _| {});
                }
            }
        }
    }

    fn respond(&mut self, rows: &PartRows<'_, 2>, p: &[Vector<2>], scratch: &mut [f64], v: &mut [f64]) {
        let Self { factor, memory, .. } = self;
        let done = match memory {
            Memory::Responses(responses) => responses.respond(p, v),
            Memory::Columns(columns) => columns.ready && columns.respond(rows, p, scratch, v),
        };
        if !done {
            respond_by_solving(rows, p, scratch, v, |f| solve(factor, f));
        }
    }
}

/// v += a x, for the entries that x has.
fn add_multiple(a: f64, x: &[f64], v: &mut [f64]) {
    for (v, x) in v.iter_mut().zip(x) {
        *v += a * x;
    }
}

/// v += Σ f_k x_k, for the entries that all x have.
fn add_four(f: [f64; 4], [a, b, c, d]: [&[f64]; 4], v: &mut [f64]) {
    for ((((v, a), b), c), d) in v.iter_mut().zip(a).zip(b).zip(c).zip(d) {
        *v += (f[0] * a + f[1] * b) + (f[2] * c + f[3] * d);
    }
}

/// W Jᵀ of the contacts that were coupled last.
struct Responses {
    /// Contact and direction of each response.
    pushes: Vec<(usize, Vector<2>)>,
    values: Vec<f64>,
    dofs: usize,
}

impl Responses {
    fn new(dofs: usize) -> Self {
        Self { pushes: Vec::with_capacity(RESPONSES + 1), values: vec![0.0; RESPONSES * dofs], dofs }
    }

    fn couple(&mut self, factor: &Factor, rows: &PartRows<'_, 2>, scratch: &mut [f64], h: &mut Coupling<'_, 2>) {
        let Self { pushes, values, dofs } = self;
        pushes.clear();
        let keep = |contact, direction: &Vector<2>, response: &[f64]| {
            if let Some(kept) = values.chunks_exact_mut(*dofs).nth(pushes.len()) {
                kept.copy_from_slice(&response[..*dofs]);
            }
            // One more than there is room for marks that not all are kept.
            if pushes.len() <= RESPONSES {
                pushes.push((contact, *direction));
            }
        };
        couple_by_solving(rows, scratch, h, |f| solve(factor, f), keep);
    }

    /// Adds W Jᵀ p to `v`; returns whether it could.
    fn respond(&self, p: &[Vector<2>], v: &mut [f64]) -> bool {
        if self.pushes.len() > RESPONSES {
            return false;
        }
        for ((contact, direction), response) in self.pushes.iter().zip(self.values.chunks_exact(self.dofs)) {
            add_multiple(direction.dot(&p[*contact]), response, v);
        }
        true
    }
}

/// Columns of W, kept from step to step.
struct Columns {
    dofs: usize,
    /// Most dofs that the contacts of a step may act on.
    most: usize,
    values: Vec<f64>,
    /// The dof that each place holds the column of.
    places: Vec<Option<usize>>,
    /// Place of the column of each dof.
    place_of: Vec<usize>,
    /// When the column of each dof was last asked for, in rounds.
    asked: Vec<u64>,
    round: u64,
    /// The dofs asked for in this round.
    touched: Vec<usize>,
    /// Whether the columns of all dofs asked for last are there.
    ready: bool,
}

const NOWHERE: usize = usize::MAX;

impl Columns {
    /// How many columns of a beam are kept.
    fn room(dofs: usize) -> usize {
        COLUMNS.min(MEMORY / (size_of::<f64>() * dofs.max(1))).max(FEWEST_COLUMNS).min(dofs)
    }

    /// For steps whose contacts act on at most this many dofs.
    fn new(dofs: usize, most: usize) -> Self {
        let room = Self::room(dofs);
        Self {
            most: most.min(room),
            dofs,
            values: vec![0.0; room * dofs],
            places: vec![None; room],
            place_of: vec![NOWHERE; dofs],
            asked: vec![0; dofs],
            round: 0,
            touched: Vec::with_capacity(room),
            ready: false,
        }
    }

    /// Drops all columns.
    fn forget(&mut self) {
        self.place_of.fill(NOWHERE);
        self.places.fill(None);
    }

    /// Makes sure that the columns of all dofs that the rows act on are there, in place of those
    /// asked for least recently; returns `false` if they are too many.
    fn fetch(&mut self, factor: &Factor, rows: &PartRows<'_, 2>) -> bool {
        self.round += 1;
        self.touched.clear();
        for (_, dofs, _) in rows.iter() {
            for &dof in self.own(dofs) {
                if self.asked[dof] == self.round {
                    continue;
                }
                if self.touched.len() == self.most {
                    return false;
                }
                self.asked[dof] = self.round;
                self.touched.push(dof);
            }
        }
        for k in 0..self.touched.len() {
            if self.place_of[self.touched[k]] == NOWHERE {
                self.renew(factor, self.touched[k]);
            }
        }
        true
    }

    /// Solves for the column of `dof`.
    fn renew(&mut self, factor: &Factor, dof: usize) {
        let asked = |held: &Option<usize>| held.map_or(0, |dof| self.asked[dof]);
        let Some(place) = (0..self.places.len()).min_by_key(|&place| asked(&self.places[place])) else { return };
        if let Some(dropped) = self.places[place].replace(dof) {
            self.place_of[dropped] = NOWHERE;
        }
        self.place_of[dof] = place;
        let column = &mut self.values[place * self.dofs..(place + 1) * self.dofs];
        column.fill(0.0);
        column[dof] = 1.0;
        factor.solve(column);
    }

    /// The column of a dof that is there.
    fn column(&self, dof: usize) -> &[f64] {
        let start = self.place_of[dof] * self.dofs;
        &self.values[start..start + self.dofs]
    }

    fn couple(&self, rows: &PartRows<'_, 2>, h: &mut Coupling<'_, 2>) {
        if let Some(row) = rows.only() {
            return h.add(0, 0, &self.felt(row, row));
        }
        for (number, (j, dofs_j, values_j)) in rows.iter().enumerate() {
            for (other, (i, dofs_i, values_i)) in rows.iter().take(number + 1).enumerate() {
                let block = self.felt((dofs_i, values_i), (dofs_j, values_j));
                h.add(i, j, &block);
                if other < number {
                    h.add(j, i, &block.transpose());
                }
            }
        }
    }

    /// What one row feels of another, J_i W J_jᵀ.
    #[inline]
    fn felt(
        &self,
        (dofs_i, values_i): (&[usize], &[Vector<2>]),
        (dofs_j, values_j): (&[usize], &[Vector<2>]),
    ) -> Matrix2<f64> {
        let (own_i, own_j) = (self.own(dofs_i), self.own(dofs_j));
        let mut block = Matrix2::zeros();
        for (&b, value_b) in own_j.iter().zip(values_j) {
            let column = self.column(b);
            let mut u = Vector::<2>::zeros();
            for (&a, value_a) in own_i.iter().zip(values_i) {
                add_scaled(&mut u, value_a, column[a]);
            }
            add_outer(&mut block, &u, value_b, 1.0);
        }
        block
    }

    /// The beam's own dofs in a row: the prescribed ones of its supports come last.
    fn own<'r>(&self, mut dofs: &'r [usize]) -> &'r [usize] {
        while let [rest @ .., last] = dofs
            && *last >= self.dofs
        {
            dofs = rest;
        }
        dofs
    }

    /// Adds W Jᵀ p to `v`, the columns being there.
    fn respond(&self, rows: &PartRows<'_, 2>, p: &[Vector<2>], scratch: &mut [f64], v: &mut [f64]) -> bool {
        self.touched.iter().for_each(|dof| scratch[*dof] = 0.0);
        rows.add_generalised_impulse(p, scratch);
        // Four at a time: memory limits the speed, and v is then read once for four columns.
        let (fours, rest) = self.touched.as_chunks::<4>();
        for dofs in fours {
            let f = dofs.map(|dof| scratch[dof]);
            let [a, b, c, d] = dofs.map(|dof| self.column(dof));
            add_four(f, [a, b, c, d], v);
        }
        for dof in rest {
            add_multiple(scratch[*dof], self.column(*dof), v);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compliance::Span;
    use teeter_beam::{BeamSpec, Section, Support};
    use teeter_contact::Block;

    const WEIGHTS: Weights = Weights { mass: 1.0, damping: 0.5e-4, stiffness: 0.25e-8 };

    fn columns() -> (Arc<Beam>, BeamCompliance) {
        let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap();
        let supports = [Support::Clamped, Support::Free];
        let beam = Arc::new(Beam::new(BeamSpec::new(0.36, 50, section).supported(supports)).unwrap());
        let compliance = BeamCompliance::new(&beam, WEIGHTS, WBackend::CachedColumns, None).unwrap();
        (beam, compliance)
    }

    /// H and W Jᵀ p of contacts that touch four dofs each, from these on.
    fn answer(compliance: &mut BeamCompliance, first: &[usize]) -> (Vec<Block<2>>, Vec<f64>) {
        let columns: Vec<usize> = first.iter().flat_map(|dof| *dof..dof + 4).collect();
        let values: Vec<_> = (0..columns.len()).map(|k| Vector::<2>::new(1.0, 0.1) * (k as f64).cos()).collect();
        let span = |part, start| Span { part, first: 0, start, len: 4 * (1 - part) };
        let spans: Vec<_> = (0..first.len()).map(|k| [span(0, 4 * k), span(1, 0)]).collect();
        let rows = PartRows { part: 0, spans: &spans, columns: &columns, values: &values };
        let n = compliance.factor.dofs();
        let mut blocks = vec![Block::zeros(); first.len() * first.len()];
        let (mut scratch, mut v) = (vec![f64::NAN; n], vec![0.0; n]);
        compliance.couple(&rows, &mut scratch, &mut Coupling::dense(first.len(), &mut blocks));
        compliance.respond(&rows, &vec![Vector::<2>::new(1.0, 0.5); first.len()], &mut scratch, &mut v);
        (blocks, v)
    }

    fn kept(compliance: &BeamCompliance) -> usize {
        let Memory::Columns(columns) = &compliance.memory else { return 0 };
        columns.places.iter().flatten().count()
    }

    #[test]
    fn which_columns_are_kept_changes_no_bit() {
        let (_, mut used) = columns();
        // Along the whole beam, so that columns have to make room for others; then a step with too
        // many dofs at once.
        for first in 2..98 {
            answer(&mut used, &[first]);
            assert_eq!(kept(&used), (first + 2).min(COLUMNS));
        }
        let many: Vec<usize> = (0..24).map(|k| 2 + 4 * k).collect();
        for contacts in [&[2, 40, 90][..], &[41], &many, &[2, 3, 40]] {
            let (_, mut fresh) = columns();
            assert_eq!(answer(&mut used, contacts), answer(&mut fresh, contacts), "{contacts:?}");
        }
    }

    #[test]
    fn another_step_size_drops_the_columns() {
        let (beam, mut used) = columns();
        let half = Weights { mass: 1.0, damping: 0.25e-4, stiffness: 0.25e-8 / 4.0 };
        let before = answer(&mut used, &[10]);
        used.refactor(half, &[]).unwrap();
        assert_eq!(kept(&used), 0);
        let mut fresh = BeamCompliance::new(&beam, half, WBackend::CachedColumns, None).unwrap();
        let after = answer(&mut used, &[10]);
        assert!(after == answer(&mut fresh, &[10]) && after != before);
    }

    /// The tests have the feature, so the error is that of a beam without.
    #[test]
    fn a_missing_backend_is_refused_with_the_feature_that_brings_it() {
        let error = teeter_beam::CholeskyError::MissingFeature { backend: Backend::Sparse, feature: "faer" };
        let text = refusal(WEIGHTS, &error).to_string();
        assert!(["Sparse", "`faer` of teeter-beam", "`sparse` of teeter-integrator"].iter().all(|s| text.contains(s)));
    }

    #[test]
    fn columns_are_bounded_for_every_beam() {
        for (dofs, room) in [(20, 20), (80, 64), (4000, 64), (80_000, 26), (1_000_000, 16)] {
            assert_eq!(Columns::room(dofs), room, "{dofs}");
        }
    }
}
