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

    /// `Σ_j ‖H_ij,T‖ ‖p_j‖` over the tangential rows of contact `i`, and how many numbers its sum has: what rounding of the
    /// tangential part of [`Self::row_product`] is measured by. Of an operator that is given by what it does, the product stands for the blocks that
    /// can't be seen.
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

/// A block-sparse matrix by rows (BSR): the columns of a row ascend, the diagonal block is always present.
#[derive(Clone, Debug, Default, PartialEq)]
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

    /// All stored blocks, row by row.
    #[must_use]
    pub fn blocks(&self) -> &[Block<D>] {
        &self.blocks
    }

    /// The column of each block of [`Self::blocks`].
    #[must_use]
    pub fn columns(&self) -> &[usize] {
        &self.columns
    }

    /// Where the blocks of row `i` lie in [`Self::blocks`] and [`Self::columns`].
    #[must_use]
    pub fn range(&self, i: usize) -> std::ops::Range<usize> {
        self.row_start[i]..self.row_start[i + 1]
    }

    /// Whether both matrices have their non-zero blocks at the same places, so that an analysis of one serves the other.
    #[must_use]
    pub fn same_pattern(&self, other: &Self) -> bool {
        self.row_start == other.row_start && self.columns == other.columns
    }

    /// Takes the matrix out of a problem, zero blocks left out, in memory that is kept. Of an operator that is given by
    /// what it does, each column is the product with a unit vector: D n² row products.
    pub fn gather(&mut self, problem: &crate::ContactProblem<'_, D>) {
        let n = problem.contacts();
        self.row_start.clear();
        self.columns.clear();
        self.blocks.clear();
        self.diagonal.clear();
        self.row_start.push(0);
        let mut unit = Vec::new();
        if matches!(problem.delassus(), Delassus::Operator(_)) {
            unit.resize(n, Vector::<D>::zeros());
        }
        for i in 0..n {
            let mut offer = |j: usize, block: &Block<D>| {
                if i == j {
                    self.diagonal.push(self.blocks.len());
                }
                if i == j || block.iter().any(|&c| c != 0.0) {
                    self.columns.push(j);
                    self.blocks.push(*block);
                }
            };
            match problem.delassus() {
                Delassus::Dense(blocks) => {
                    blocks[i * n..(i + 1) * n].iter().enumerate().for_each(|(j, block)| offer(j, block));
                }
                Delassus::Blocks(h) => h.row(i).for_each(|(j, block)| offer(j, block)),
                Delassus::Operator(h) => {
                    for j in 0..n {
                        let mut block = Block::<D>::zeros();
                        for c in 0..D {
                            unit[j][c] = 1.0;
                            block.set_column(c, &h.row_product(i, &unit));
                            unit[j][c] = 0.0;
                        }
                        offer(j, &block);
                    }
                }
            }
            self.row_start.push(self.blocks.len());
        }
    }

    /// Multiplies the matrix by a number.
    pub fn scale(&mut self, factor: f64) {
        self.blocks.iter_mut().for_each(|block| *block *= factor);
    }

    /// Makes room for a matrix of `contacts` rows and `blocks` blocks.
    pub fn reserve(&mut self, contacts: usize, blocks: usize) {
        let more = |len: usize, wanted: usize| wanted.saturating_sub(len);
        self.row_start.reserve(more(self.row_start.len(), contacts + 1));
        self.diagonal.reserve(more(self.diagonal.len(), contacts));
        self.columns.reserve(more(self.columns.len(), blocks));
        self.blocks.reserve(more(self.blocks.len(), blocks));
    }

    /// `‖H − Hᵀ‖ / ‖H‖` in Frobenius' norm; 0 for a symmetric matrix.
    #[must_use]
    pub fn asymmetry(&self) -> f64 {
        let (mut skew, mut all) = (0.0, 0.0);
        for i in 0..self.contacts() {
            for (j, block) in self.row(i) {
                all += block.norm_squared();
                match self.block(j, i) {
                    Some(mirror) => skew += (block - mirror.transpose()).norm_squared(),
                    // Counted for both places, as the other one isn't stored.
                    None => skew += 2.0 * block.norm_squared(),
                }
            }
        }
        if all > 0.0 { (skew / all).sqrt() } else { 0.0 }
    }

    /// The block (i, j), if it is stored.
    #[must_use]
    pub fn block(&self, i: usize, j: usize) -> Option<&Block<D>> {
        let range = self.range(i);
        let at = self.columns[range.clone()].binary_search(&j).ok()?;
        Some(&self.blocks[range.start + at])
    }

    /// The diagonal block of row `i`.
    #[inline]
    #[must_use]
    pub fn diagonal(&self, i: usize) -> Block<D> {
        self.blocks[self.diagonal[i]]
    }

    /// `Σ_j H_ij p_j`.
    #[inline]
    #[must_use]
    pub fn row_product(&self, i: usize, p: &[Vector<D>]) -> Vector<D> {
        self.row(i).fold(Vector::zeros(), |sum, (j, h)| sum + h * p[j])
    }
}
