//! The Delassus operator `H = J W Jᵀ`, in the shapes in which it comes.

use crate::{Block, Vector};

/// A Delassus operator given by what it does, for those who never form it.
pub trait DelassusOperator<const D: usize>: Send + Sync {
    /// Number of contacts.
    fn contacts(&self) -> usize;
    /// The diagonal block `H_ii`.
    fn diagonal(&self, i: usize) -> Block<D>;
    /// The velocity `Σ_j H_ij p_j` at contact `i`.
    fn row_product(&self, i: usize, p: &[Vector<D>]) -> Vector<D>;
}

/// The Delassus operator of a problem; borrowed, so that posing a problem copies nothing.
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
            Self::Blocks(h) => write!(f, "Blocks({} contacts, {} blocks)", h.contacts(), h.blocks.len()),
            Self::Operator(h) => write!(f, "Operator({} contacts)", h.contacts()),
        }
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
    #[inline]
    pub(crate) fn row_product(&self, i: usize, p: &[Vector<D>]) -> Vector<D> {
        match self {
            Self::Dense(blocks) => {
                let n = p.len();
                let row = &blocks[i * n..(i + 1) * n];
                row.iter().zip(p).fold(Vector::zeros(), |sum, (h, p_j)| sum + h * p_j)
            }
            Self::Blocks(h) => h.row_product(i, p),
            Self::Operator(h) => h.row_product(i, p),
        }
    }
}

/// A block-sparse matrix by rows (BSR): the columns of a row ascend, the diagonal block is always present.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockSparse<const D: usize> {
    row_start: Vec<usize>,
    columns: Vec<usize>,
    blocks: Vec<Block<D>>,
    diagonal: Vec<usize>,
}

/// Why a block-sparse matrix can't be made of the given rows.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BlockSparseError {
    /// A column index outside the matrix.
    #[error("block ({row}, {column}) lies outside a matrix of {contacts} contacts")]
    ColumnOutOfRange {
        /// Row of the block.
        row: usize,
        /// Column of the block.
        column: usize,
        /// Number of contacts.
        contacts: usize,
    },
    /// Columns of a row that don't ascend.
    #[error("the columns of row {row} must ascend without repetition")]
    ColumnsNotAscending {
        /// Row with the disorder.
        row: usize,
    },
    /// A row without its diagonal block.
    #[error("row {row} has no diagonal block")]
    MissingDiagonal {
        /// Row without the block.
        row: usize,
    },
}

impl<const D: usize> BlockSparse<D> {
    /// Makes the matrix from its rows, each a list of (column, block).
    ///
    /// # Errors
    /// If a column lies outside the matrix or columns don't ascend, or a diagonal block is missing.
    pub fn from_rows(rows: &[Vec<(usize, Block<D>)>]) -> Result<Self, BlockSparseError> {
        let contacts = rows.len();
        let mut h = Self {
            row_start: Vec::with_capacity(contacts + 1),
            columns: Vec::new(),
            blocks: Vec::new(),
            diagonal: Vec::with_capacity(contacts),
        };
        h.row_start.push(0);
        for (row, entries) in rows.iter().enumerate() {
            let mut diagonal = None;
            for (k, &(column, block)) in entries.iter().enumerate() {
                if column >= contacts {
                    return Err(BlockSparseError::ColumnOutOfRange { row, column, contacts });
                }
                if k > 0 && entries[k - 1].0 >= column {
                    return Err(BlockSparseError::ColumnsNotAscending { row });
                }
                if column == row {
                    diagonal = Some(h.blocks.len());
                }
                h.columns.push(column);
                h.blocks.push(block);
            }
            h.diagonal.push(diagonal.ok_or(BlockSparseError::MissingDiagonal { row })?);
            h.row_start.push(h.blocks.len());
        }
        Ok(h)
    }

    /// Number of contacts.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.diagonal.len()
    }

    /// The stored blocks of row `i`: (column, block), ascending.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, &Block<D>)> {
        let range = self.row_start[i]..self.row_start[i + 1];
        self.columns[range.clone()].iter().copied().zip(&self.blocks[range])
    }

    pub(crate) fn all_blocks(&self) -> &[Block<D>] {
        &self.blocks
    }

    fn diagonal(&self, i: usize) -> Block<D> {
        self.blocks[self.diagonal[i]]
    }

    fn row_product(&self, i: usize, p: &[Vector<D>]) -> Vector<D> {
        self.row(i).fold(Vector::zeros(), |sum, (j, h)| sum + h * p[j])
    }
}
