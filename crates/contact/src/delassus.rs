//! The Delassus operator `H = J W Jᵀ`: dense, block-sparse or matrix-free.

use crate::{Block, BlockSparse, Vector};

/// A matrix-free Delassus operator: one that is never formed.
pub trait DelassusOperator<const D: usize>: Send + Sync {
    /// Number of contacts.
    fn contacts(&self) -> usize;
    /// The diagonal block `H_ii`.
    fn diagonal(&self, i: usize) -> Block<D>;
    /// The velocity `Σ_j H_ij p_j` at contact `i`.
    fn row_product(&self, i: usize, p: &[Vector<D>]) -> Vector<D>;
}

/// The Delassus operator of a problem; borrowed, so that nothing is copied to pose one.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub enum Delassus<'a, const D: usize> {
    /// All n × n blocks, by rows: block (i, j) at `i * n + j`.
    Dense(&'a [Block<D>]),
    /// The non-zero blocks only.
    Blocks(&'a BlockSparse<D>),
    /// A product, never formed.
    Operator(&'a dyn DelassusOperator<D>),
}

impl<const D: usize> std::fmt::Debug for Delassus<'_, D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Dense(blocks) => write!(f, "Dense({} blocks)", blocks.len()),
            Self::Blocks(h) => write!(f, "Blocks({} contacts, {} blocks)", h.contacts(), h.blocks().len()),
            Self::Operator(h) => write!(f, "Operator({} contacts)", h.contacts()),
        }
    }
}

/// sum += h p, written out: the loops of the general matrix type take several times as many
/// instructions for two or three numbers.
#[inline]
pub(crate) fn add_product<const D: usize>(sum: &mut Vector<D>, h: &Block<D>, p: &Vector<D>) {
    let mut product = [0.0; D];
    for (k, (column, x)) in h.data.0.iter().zip(&p.data.0[0]).enumerate() {
        for r in 0..D {
            product[r] = if k == 0 { column[r] * x } else { product[r] + column[r] * x };
        }
    }
    for (sum, x) in sum.data.0[0].iter_mut().zip(product) {
        *sum += x;
    }
}

impl<const D: usize> Delassus<'_, D> {
    /// The diagonal block `H_ii` of a problem of `n` contacts.
    #[inline]
    pub(crate) fn diagonal(&self, i: usize, n: usize) -> Block<D> {
        match self {
            Self::Dense(blocks) => blocks[i * n + i],
            Self::Blocks(h) => h.diagonal(i),
            Self::Operator(h) => h.diagonal(i),
        }
    }

    /// `Σ_j H_ij p_j`; `n` is the number of contacts.
    #[inline(always)]
    pub(crate) fn row_product(&self, i: usize, p: &[Vector<D>]) -> Vector<D> {
        match self {
            Self::Dense(blocks) => {
                let n = p.len();
                let row = &blocks[i * n..(i + 1) * n];
                let mut sum = Vector::zeros();
                for (h, p) in row.iter().zip(p) {
                    add_product(&mut sum, h, p);
                }
                sum
            }
            Self::Blocks(h) => h.row_product(i, p),
            Self::Operator(h) => h.row_product(i, p),
        }
    }

    /// `Σ_j ‖H_ij,T‖ ‖p_j‖` over the tangential rows of contact `i`, and its number of terms: a
    /// measure for the rounding of the tangential part of [`Self::row_product`]. For a matrix-free
    /// operator the norm of the product is used, as its blocks aren't known.
    pub(crate) fn tangential_size(&self, i: usize, p: &[Vector<D>]) -> (f64, usize) {
        let of = |h: &Block<D>, p: &Vector<D>| {
            let rows: f64 = (1..D).map(|r| (0..D).map(|c| (h[(r, c)] * p[c]).abs()).sum::<f64>()).sum();
            rows
        };
        match self {
            Self::Dense(blocks) => {
                let row = &blocks[i * p.len()..(i + 1) * p.len()];
                (row.iter().zip(p).map(|(h, p)| of(h, p)).sum(), D * p.len())
            }
            Self::Blocks(h) => (h.row(i).map(|(j, h)| of(h, &p[j])).sum(), D * h.range(i).len()),
            Self::Operator(h) => {
                let others = h.row_product(i, p) - h.diagonal(i) * p[i];
                (of(&h.diagonal(i), &p[i]) + others.iter().skip(1).map(|c| c.abs()).sum::<f64>(), D * p.len())
            }
        }
    }
}
