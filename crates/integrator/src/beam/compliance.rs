//! W_be of the source paper: how the impulses of contacts reach the velocities of a beam.
//!
//! The free velocity always takes one substitution with the banded factor. What contacts need of W is little: a contact pushes at
//! the dofs of one element. Either each contact's response W Jᵀ is solved for once a step, and kept for the end of the step
//! ([`WBackend::Banded`]); or the columns of W of the dofs that contacts touch are solved for once a factor, and combined
//! ([`WBackend::CachedColumns`]).

use super::matrix_weights;
use crate::subsystem::{couple_by_solving, respond_by_solving};
use crate::{Compliance, Coupling, FactorError, PartRows, Vector, Weights};
use nalgebra::Matrix2;
use std::sync::Arc;
use teeter_beam::{Beam, Factor};

/// How W answers contacts on a beam. The results differ by rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum WBackend {
    /// The faster one for the beam's dofs, by measurement.
    #[default]
    Auto,
    /// A banded substitution for each contact and direction in a step.
    Banded,
    /// Columns of W, each solved for when a contact first touches its dof and kept until the step size changes: at most
    /// 64 columns and 16 MB, but 16 columns at least; a step that touches more dofs at once goes by substitutions. Which columns are
    /// there changes the time of a step, never its numbers.
    CachedColumns,
}

/// Most columns of W that are kept: the dofs of 16 contacts. (Benches `contacts on a beam`: the combination takes less time than
/// substitutions at every number of contacts, so it is memory that asks for a bound.)
const COLUMNS: usize = 64;

/// Bytes of columns beyond which there are fewer.
const MEMORY: usize = 16 << 20;

/// Columns that are kept of beams of any size: the dofs of a block's four corners.
const FEWEST_COLUMNS: usize = 16;

/// Most responses of contacts that are kept over a step. A substitution takes the time of some ten combinations of a column, so
/// that with more of them one more substitution is the better way.
const RESPONSES: usize = 8;

/// W of a beam, zero for its prescribed coordinates.
pub(super) struct BeamCompliance {
    beam: Arc<Beam>,
    weights: Weights,
    factor: Factor,
    memory: Memory,
}

enum Memory {
    Responses(Responses),
    Columns(Columns),
}

impl BeamCompliance {
    pub(super) fn new(beam: &Arc<Beam>, w: Weights, backend: WBackend) -> Result<Self, FactorError> {
        let factor = beam.factor(matrix_weights(w)).map_err(|error| refusal(w, &error))?;
        let dofs = beam.dofs();
        let memory = match backend {
            // The columns of a matrix that changes with every step aren't worth keeping.
            _ if beam.is_stretched() => Memory::Responses(Responses::new(dofs)),
            WBackend::Banded => Memory::Responses(Responses::new(dofs)),
            WBackend::Auto | WBackend::CachedColumns => Memory::Columns(Columns::new(dofs)),
        };
        Ok(Self { beam: Arc::clone(beam), weights: w, factor, memory })
    }
}

fn refusal(weights: Weights, error: &teeter_beam::FactorError) -> FactorError {
    FactorError { weights, reason: error.to_string() }
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
        self.beam.refactor(matrix_weights(w), &mut self.factor).map_err(|error| refusal(w, &error))?;
        self.weights = w;
        Ok(())
    }

    fn update(&mut self, q: &[f64]) {
        self.beam.follow(&q[..self.beam.dofs()], &mut self.factor);
    }

    fn solve(&mut self, f: &mut [f64]) {
        solve(&self.factor, f);
    }

    fn couple(&mut self, rows: &PartRows<'_, 2>, scratch: &mut [f64], h: &mut Coupling<'_, 2>) {
        let Self { factor, memory, .. } = self;
        match memory {
            Memory::Responses(responses) => responses.couple(factor, rows, scratch, h),
            Memory::Columns(columns) => {
                if columns.fetch(factor, rows) {
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
            Memory::Columns(columns) => columns.fetch(factor, rows) && columns.respond(rows, p, scratch, v),
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
            // One more than there is room for says that they aren't all there.
            if pushes.len() <= RESPONSES {
                pushes.push((contact, *direction));
            }
        };
        couple_by_solving(rows, scratch, h, |f| solve(factor, f), keep);
    }

    /// Adds W Jᵀ p to `v`; whether it could.
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
    values: Vec<f64>,
    /// Of each place for a column: its dof, and the round in which it was last asked for; 0 for never.
    places: Vec<(usize, u64)>,
    /// Place of the column of each dof.
    place_of: Vec<usize>,
    round: u64,
    /// The dofs asked for in this round.
    touched: Vec<usize>,
}

const NOWHERE: usize = usize::MAX;

impl Columns {
    fn new(dofs: usize) -> Self {
        let room = COLUMNS.min(MEMORY / (size_of::<f64>() * dofs.max(1))).max(FEWEST_COLUMNS).min(dofs);
        Self {
            dofs,
            values: vec![0.0; room * dofs],
            places: vec![(0, 0); room],
            place_of: vec![NOWHERE; dofs],
            round: 0,
            touched: Vec::with_capacity(room),
        }
    }

    /// Drops all columns.
    fn forget(&mut self) {
        self.place_of.fill(NOWHERE);
        self.places.fill((0, 0));
        self.round = 0;
    }

    /// Makes sure that the columns of all dofs that the rows touch are there, in the place of those that were not asked for the
    /// longest; whether there is room for them all.
    fn fetch(&mut self, factor: &Factor, rows: &PartRows<'_, 2>) -> bool {
        self.round += 1;
        self.touched.clear();
        let own = self.dofs;
        for dof in rows.iter().flat_map(|(_, dofs, _)| dofs).copied().filter(|dof| *dof < own) {
            let mut place = self.place_of[dof];
            if place == NOWHERE {
                if self.touched.len() == self.places.len() {
                    return false;
                }
                place = self.renew(factor, dof);
            } else if self.places[place].1 == self.round {
                continue;
            }
            self.places[place].1 = self.round;
            self.touched.push(dof);
        }
        true
    }

    /// Solves for the column of `dof`. Returns its place.
    fn renew(&mut self, factor: &Factor, dof: usize) -> usize {
        let oldest = self.places.iter().enumerate().min_by_key(|(_, (_, round))| *round);
        let place = oldest.map_or(0, |(place, _)| place);
        let (dropped, round) = self.places[place];
        if round > 0 {
            self.place_of[dropped] = NOWHERE;
        }
        self.places[place].0 = dof;
        self.place_of[dof] = place;
        let column = &mut self.values[place * self.dofs..(place + 1) * self.dofs];
        column.fill(0.0);
        column[dof] = 1.0;
        factor.solve(column);
        place
    }

    /// The column of a dof that is there.
    fn column(&self, dof: usize) -> &[f64] {
        let start = self.place_of[dof] * self.dofs;
        &self.values[start..start + self.dofs]
    }

    fn couple(&self, rows: &PartRows<'_, 2>, h: &mut Coupling<'_, 2>) {
        let own = |entries: &(&usize, &Vector<2>)| *entries.0 < self.dofs;
        for (j, dofs_j, values_j) in rows.iter() {
            for (i, dofs_i, values_i) in rows.iter() {
                let mut block = Matrix2::zeros();
                for (&b, value_b) in dofs_j.iter().zip(values_j).filter(own) {
                    let column = self.column(b);
                    let mut u = Vector::<2>::zeros();
                    for (&a, value_a) in dofs_i.iter().zip(values_i).filter(own) {
                        u += value_a * column[a];
                    }
                    block += u * value_b.transpose();
                }
                h.add(i, j, &block);
            }
        }
    }

    /// Adds W Jᵀ p to `v`, the columns being there.
    fn respond(&self, rows: &PartRows<'_, 2>, p: &[Vector<2>], scratch: &mut [f64], v: &mut [f64]) -> bool {
        self.touched.iter().for_each(|dof| scratch[*dof] = 0.0);
        rows.add_generalised_impulse(p, scratch);
        for dof in &self.touched {
            add_multiple(scratch[*dof], self.column(*dof), v);
        }
        true
    }
}
