//! What a factorised subsystem answers: its response to forces, and to the impulses of contacts.

use crate::subsystem::Weights;
use crate::{Vector, small};
use std::ops::Range;
use teeter_contact::{Block, BlockSparse};

/// Why a matrix can't be factorised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{mass} M + {damping} C + {stiffness} K can't be factorised: {reason}", mass = weights.mass, damping = weights.damping, stiffness = weights.stiffness)]
pub struct FactorError {
    /// The combination asked for.
    pub weights: Weights,
    /// Why not.
    pub reason: String,
}

/// `W = (mass·M + damping·C + stiffness·K)⁻¹` of one subsystem: W_be of the source paper for a
/// beam, diag(1/m, 1/m, 1/I) for a block.
pub trait Compliance<const D: usize>: Send + Sync {
    /// The combination whose inverse this is.
    fn weights(&self) -> Weights;

    /// Becomes the inverse of another combination; allocates nothing.
    ///
    /// # Errors
    /// If the matrix is not positive definite.
    fn refactor(&mut self, w: Weights, q: &[f64]) -> Result<(), FactorError>;

    /// Becomes the inverse of the same combination at coordinates `q`, whatever earlier updates
    /// there were; allocates nothing. A scheme calls it before it solves, with the coordinates at
    /// which it takes the internal forces, if the subsystem's matrices [follow its
    /// coordinates](crate::Traits). If the matrix is not positive definite there, solutions must be NaN:
    /// the step then ends as diverged.
    fn update(&mut self, q: &[f64]) {
        let _ = q;
    }

    /// Becomes the inverse of `mass·M + damping·C + stiffness·(K + tension·G) + weight·g gᵀ`, with its
    /// own weights, of a subsystem that [stretches](crate::Dynamics::stretching), whatever updates there were
    /// before; `tension` (N) and `weight` are at least 0. Allocates nothing. If the matrix is not
    /// positive definite, solutions must be NaN. The default leaves it as it is: right where nothing
    /// stretches.
    fn stretch(&mut self, tension: f64, weight: f64, g: &[f64]) {
        let _ = (tension, weight, g);
    }

    /// Becomes the inverse with K the tangent at `q`, the derivative of the internal force. The
    /// search for an equilibrium needs this, while [`Compliance::update`] may take another K for
    /// the sake of a step's energy. The default calls that.
    ///
    /// # Errors
    /// If the matrix is not positive definite.
    fn take_tangent(&mut self, q: &[f64]) -> Result<(), FactorError> {
        self.update(q);
        Ok(())
    }

    /// Whether W is diagonal, and [`Compliance::respond`] works without a [`Compliance::couple`] of
    /// the same rows before it. Contacts that share no velocity are then uncoupled, and many of
    /// them are solved island by island. `false`, the default, is always right.
    fn is_diagonal(&self) -> bool {
        false
    }

    /// `f ← W f`; zero for [driven and held](crate::Traits) velocities, as their rows and columns of W are
    /// zero.
    fn solve(&mut self, f: &mut [f64]);

    /// Adds `J_i W J_jᵀ` for all pairs of rows to the Delassus operator. `scratch` is as long as
    /// the subsystem's velocities. The default solves once for each direction in which a contact
    /// can push; override it if W is known in closed form.
    fn couple(&mut self, rows: &PartRows<'_, D>, scratch: &mut [f64], h: &mut Coupling<'_, D>) {
        couple_by_solving(rows, scratch, h, |f| self.solve(f), |_, _, _| {});
    }

    /// Adds `W Jᵀ p` to the subsystem's velocities `v`, where p are the impulses of all contacts of
    /// the model (N·s), and the rows those that were [coupled](Compliance::couple) last. `scratch`
    /// is as long as `v`. The default solves once; override it if `couple` keeps its solutions.
    fn respond(&mut self, rows: &PartRows<'_, D>, p: &[Vector<D>], scratch: &mut [f64], v: &mut [f64]) {
        respond_by_solving(rows, p, scratch, v, |f| self.solve(f));
    }
}

/// Couples the rows by one solve for each direction in which a contact can push, and passes each
/// solution to `keep`, with contact and direction.
pub(crate) fn couple_by_solving<const D: usize>(
    rows: &PartRows<'_, D>,
    scratch: &mut [f64],
    h: &mut Coupling<'_, D>,
    mut solve: impl FnMut(&mut [f64]),
    mut keep: impl FnMut(usize, &Vector<D>, &[f64]),
) {
    for (j, columns_j, values_j) in rows.iter() {
        let mut column = |direction: &Vector<D>| {
            scratch.fill(0.0);
            for (&c, value) in columns_j.iter().zip(values_j) {
                scratch[c] += value.dot(direction);
            }
            solve(scratch);
            keep(j, direction, scratch);
            for (i, columns_i, values_i) in rows.iter() {
                let mut u = Vector::<D>::zeros();
                for (&c, value) in columns_i.iter().zip(values_i) {
                    u += value * scratch[c];
                }
                h.add(i, j, &(u * direction.transpose()));
            }
        };
        match common_direction(values_j) {
            Some(direction) => column(&direction),
            None => (0..D).for_each(|d| column(&Vector::<D>::from_fn(|r, _| f64::from(u8::from(r == d))))),
        }
    }
}

/// Adds W Jᵀ p to `v` by one solve.
pub(crate) fn respond_by_solving<const D: usize>(
    rows: &PartRows<'_, D>,
    p: &[Vector<D>],
    scratch: &mut [f64],
    v: &mut [f64],
    solve: impl FnOnce(&mut [f64]),
) {
    scratch.fill(0.0);
    rows.add_generalised_impulse(p, scratch);
    solve(scratch);
    v.iter_mut().zip(scratch.iter()).for_each(|(v, dv)| *v += dv);
}

/// The only direction in which a point can be pushed, if all its entries are parallel. So it is for
/// a beam touched on its axis, which moves up and down only, whatever the contact's frame.
fn common_direction<const D: usize>(values: &[Vector<D>]) -> Option<Vector<D>> {
    let longest = values.iter().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?;
    let direction = longest.try_normalize(0.0)?;
    let rounding = 4.0 * f64::EPSILON * longest.norm();
    values.iter().all(|value| (value - direction * value.dot(&direction)).norm() <= rounding).then_some(direction)
}

/// Where the rows of one side of a contact are stored; empty for a side that no impulse moves.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Span {
    pub(crate) part: usize,
    /// The first velocity of the part among those of the model.
    pub(crate) first: usize,
    pub(crate) start: usize,
    pub(crate) len: usize,
}

impl Span {
    /// Its places in the arena of rows.
    #[inline]
    pub(crate) fn range(&self) -> Range<usize> {
        self.start..self.start + self.len
    }
}

/// The rows of all active contacts that act on one subsystem.
#[derive(Clone, Copy, Debug)]
pub struct PartRows<'a, const D: usize> {
    pub(crate) part: usize,
    pub(crate) spans: &'a [[Span; 2]],
    pub(crate) columns: &'a [usize],
    pub(crate) values: &'a [Vector<D>],
}

impl<'a, const D: usize> PartRows<'a, D> {
    /// The rows: (contact, columns within the subsystem, entries). A contact between two bodies of
    /// the subsystem comes twice. Entries have the sign of their side.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = (usize, &'a [usize], &'a [Vector<D>])> + use<'a, D> {
        let PartRows { part, spans, columns, values } = *self;
        // All sides in a row, as `flat_map` over contacts and sides took a tenth of a step's time.
        let sides = spans.as_flattened().iter().enumerate();
        sides
            .filter(move |(_, side)| side.part == part && side.len > 0)
            .map(move |(number, side)| (number / 2, &columns[side.range()], &values[side.range()]))
    }
}

impl<'a, const D: usize> PartRows<'a, D> {
    /// The row of the only contact, if there is one contact, and one of its sides acts on the
    /// subsystem: columns and entries.
    #[inline]
    pub fn only(&self) -> Option<(&'a [usize], &'a [Vector<D>])> {
        let [sides] = self.spans else { return None };
        let side = match sides.each_ref().map(|side| side.part == self.part && side.len > 0) {
            [true, false] => &sides[0],
            [false, true] => &sides[1],
            _ => return None,
        };
        Some((&self.columns[side.range()], &self.values[side.range()]))
    }
}

impl<const D: usize> PartRows<'_, D> {
    /// The row of a side of a contact, if it acts on the subsystem: columns and entries.
    #[must_use]
    pub fn get(&self, contact: usize, side: usize) -> Option<(&[usize], &[Vector<D>])> {
        let span = self.spans.get(contact)?.get(side)?;
        (span.part == self.part && span.len > 0).then(|| (&self.columns[span.range()], &self.values[span.range()]))
    }

    /// How many contacts there are, those that don't act on the subsystem among them: numbers of
    /// contacts are below it.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.spans.len()
    }

    /// Whether no contact acts on the subsystem.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.iter().next().is_none()
    }

    /// Adds W Jᵀ p to `v` for a diagonal W with entries `inverse`, and 0 beyond them:
    /// [`Compliance::respond`] of such a W.
    pub fn add_diagonal_response(&self, inverse: &[f64], p: &[Vector<D>], v: &mut [f64]) {
        for (contact, columns, values) in self.iter() {
            let p = &p[contact];
            for (&c, value) in columns.iter().zip(values) {
                if let Some(inverse) = inverse.get(c) {
                    v[c] += inverse * small::dot(value, p);
                }
            }
        }
    }

    /// Adds Jᵀ p to `f`, as long as the subsystem's velocities, with p the impulses of all contacts
    /// of the model, N·s.
    pub fn add_generalised_impulse(&self, p: &[Vector<D>], f: &mut [f64]) {
        for (contact, columns, values) in self.iter() {
            let p = &p[contact];
            for (&c, value) in columns.iter().zip(values) {
                f[c] += small::dot(value, p);
            }
        }
    }
}

/// The Delassus operator while subsystems add to it.
#[derive(Debug)]
pub struct Coupling<'a, const D: usize> {
    blocks: Blocks<'a, D>,
    /// Factor of what is added.
    scale: f64,
}

#[derive(Debug)]
enum Blocks<'a, const D: usize> {
    Dense { contacts: usize, blocks: &'a mut [Block<D>] },
    Sparse(&'a mut BlockSparse<D>),
}

impl<'a, const D: usize> Coupling<'a, D> {
    /// All blocks of so many contacts, by rows.
    pub(crate) fn dense(contacts: usize, blocks: &'a mut [Block<D>]) -> Self {
        Self { blocks: Blocks::Dense { contacts, blocks }, scale: 1.0 }
    }

    /// The blocks of contacts that share a body.
    pub(crate) fn sparse(blocks: &'a mut BlockSparse<D>) -> Self {
        Self { blocks: Blocks::Sparse(blocks), scale: 1.0 }
    }
}

impl<const D: usize> Coupling<'_, D> {
    /// Lets someone add with this factor.
    pub(crate) fn scaled(&mut self, factor: f64, add: impl FnOnce(&mut Self)) {
        let scale = self.scale;
        self.scale *= factor;
        add(self);
        self.scale = scale;
    }

    /// Adds to the block of contacts (i, j).
    #[inline(always)] // It is a few additions.
    pub fn add(&mut self, i: usize, j: usize, block: &Block<D>) {
        let block = block * self.scale;
        match &mut self.blocks {
            Blocks::Dense { contacts, blocks } => blocks[i * *contacts + j] += block,
            // Contacts that share nothing have no place in the pattern, and what they feel of each
            // other is 0.
            Blocks::Sparse(sparse) => {
                if let Some(sum) = sparse.block_mut(i, j) {
                    *sum += block;
                }
            }
        }
    }
}
