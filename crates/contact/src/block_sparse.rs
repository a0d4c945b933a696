//! A block-sparse Delassus operator; its pattern can be kept while its blocks change.

use crate::{Block, Delassus, Incidence, Vector};

/// A block-sparse matrix by rows (BSR): the columns of a row ascend, the diagonal block is always
/// present.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlockSparse<const D: usize> {
    /// Where each row ends in `columns` and `blocks`; it starts where the one before it ends.
    row_end: Vec<usize>,
    columns: Vec<usize>,
    blocks: Vec<Block<D>>,
    /// Where the diagonal block of each row lies.
    diagonal: Vec<usize>,
}

/// Why a block-sparse matrix can't be made or filled.
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
    /// A block outside the pattern.
    #[error("the pattern has no block ({row}, {column})")]
    NotInPattern {
        /// Row of the block.
        row: usize,
        /// Column of the block.
        column: usize,
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
        let mut h = Self::default();
        h.set_rows(rows.len(), |i| rows[i].iter().copied())?;
        Ok(h)
    }

    /// Makes this the matrix of `contacts` rows, each a list of (column, block), in memory that is
    /// kept.
    ///
    /// # Errors
    /// As [`Self::from_rows`]; the matrix is then that of no contacts.
    pub fn set_rows<I: IntoIterator<Item = (usize, Block<D>)>>(
        &mut self,
        contacts: usize,
        mut entries: impl FnMut(usize) -> I,
    ) -> Result<(), BlockSparseError> {
        self.clear();
        for row in 0..contacts {
            if let Err(error) = self.push_row(row, contacts, entries(row)) {
                self.clear();
                return Err(error);
            }
        }
        Ok(())
    }

    fn push_row(
        &mut self,
        row: usize,
        contacts: usize,
        entries: impl IntoIterator<Item = (usize, Block<D>)>,
    ) -> Result<(), BlockSparseError> {
        let start = self.columns.len();
        for (column, block) in entries {
            if column >= contacts {
                return Err(BlockSparseError::ColumnOutOfRange { row, column, contacts });
            }
            if self.columns[start..].last().is_some_and(|last| *last >= column) {
                return Err(BlockSparseError::ColumnsNotAscending { row });
            }
            self.columns.push(column);
            self.blocks.push(block);
        }
        match self.columns[start..].binary_search(&row) {
            Ok(at) => self.diagonal.push(start + at),
            Err(_) => return Err(BlockSparseError::MissingDiagonal { row }),
        }
        self.row_end.push(self.columns.len());
        Ok(())
    }

    /// Makes this a matrix of zero blocks between all contacts that share a key, to be filled by
    /// [`Self::add`]. Memory is kept; time grows with the number of pairs that share a key.
    ///
    /// ```
    /// use nalgebra::Matrix2;
    /// use teeter_contact::{BlockSparse, Incidence};
    ///
    /// // Contacts 0 and 2 are corners of body 0, contact 1 is one of body 1.
    /// let body = [0, 1, 0];
    /// let mut incidence = Incidence::default();
    /// incidence.load(3, |contact| [body[contact]]);
    /// let mut h = BlockSparse::<2>::default();
    /// h.set_pattern(&incidence);
    /// assert_eq!(h.columns(), [0, 2, 1, 0, 2]);
    ///
    /// // Each step: the same pattern, other blocks.
    /// h.zero();
    /// h.add(0, 2, &Matrix2::identity())?;
    /// assert!(h.add(0, 1, &Matrix2::identity()).is_err());
    /// # Ok::<(), teeter_contact::BlockSparseError>(())
    /// ```
    pub fn set_pattern(&mut self, incidence: &Incidence) {
        self.clear();
        let n = incidence.contacts();
        // Until all columns are known, `diagonal` holds the last row in which each contact was
        // seen.
        self.diagonal.resize(n, usize::MAX);
        for i in 0..n {
            let start = self.columns.len();
            self.diagonal[i] = i;
            self.columns.push(i);
            for j in incidence.keys_of(i).flat_map(|key| incidence.sharing(key)) {
                if self.diagonal[j] != i {
                    self.diagonal[j] = i;
                    self.columns.push(j);
                }
            }
            self.columns[start..].sort_unstable();
            self.row_end.push(self.columns.len());
        }
        for i in 0..n {
            let range = self.range(i);
            self.diagonal[i] = range.start + self.columns[range].partition_point(|&j| j < i);
        }
        self.blocks.resize(self.columns.len(), Block::zeros());
    }

    /// Makes this the matrix of an island of another one: its rows and columns `members`, in that
    /// order. `place` gives the position of a contact in `members`; blocks of contacts for which it
    /// is `None` are left out.
    pub(crate) fn take_island(&mut self, of: &Self, members: &[usize], place: impl Fn(usize) -> Option<usize>) {
        self.clear();
        for &i in members {
            for (j, block) in of.row(i) {
                let Some(column) = place(j) else { continue };
                if i == j {
                    self.diagonal.push(self.columns.len());
                }
                self.columns.push(column);
                self.blocks.push(*block);
            }
            self.row_end.push(self.columns.len());
        }
    }

    /// Removes all contacts; memory is kept.
    pub fn clear(&mut self) {
        self.row_end.clear();
        self.columns.clear();
        self.blocks.clear();
        self.diagonal.clear();
    }

    /// Sets all stored blocks to zero; the pattern stays.
    pub fn zero(&mut self) {
        self.blocks.fill(Block::zeros());
    }

    /// Adds to the block (i, j).
    ///
    /// # Errors
    /// If the pattern has no such block.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, block: &Block<D>) -> Result<(), BlockSparseError> {
        match self.block_mut(i, j) {
            Some(sum) => *sum += block,
            None => return Err(BlockSparseError::NotInPattern { row: i, column: j }),
        }
        Ok(())
    }

    /// Number of contacts.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.diagonal.len()
    }

    /// The stored blocks of row `i`: (column, block), ascending.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, &Block<D>)> {
        let range = self.range(i);
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
        let start = if i == 0 { 0 } else { self.row_end[i - 1] };
        start..self.row_end[i]
    }

    /// The row that block `k` of [`Self::blocks`] belongs to.
    pub(crate) fn row_of(&self, k: usize) -> usize {
        self.row_end.partition_point(|&end| end <= k)
    }

    /// Whether both matrices have their non-zero blocks at the same places, so that an analysis of
    /// one serves the other.
    #[must_use]
    pub fn same_pattern(&self, other: &Self) -> bool {
        self.row_end == other.row_end && self.columns == other.columns
    }

    /// Copies the non-zero blocks of a problem's operator, in memory that is kept. The columns of a
    /// matrix-free operator are found as products with unit vectors: D n² row products.
    pub fn gather(&mut self, problem: &crate::ContactProblem<'_, D>) {
        let n = problem.contacts();
        self.clear();
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
            self.row_end.push(self.blocks.len());
        }
    }

    /// Multiplies the matrix by a number.
    pub fn scale(&mut self, factor: f64) {
        self.blocks.iter_mut().for_each(|block| *block *= factor);
    }

    /// Makes room for a matrix of `contacts` rows and `blocks` blocks.
    pub fn reserve(&mut self, contacts: usize, blocks: usize) {
        let more = |len: usize, wanted: usize| wanted.saturating_sub(len);
        self.row_end.reserve(more(self.row_end.len(), contacts));
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
                    // Counted twice, as the mirrored block isn't stored.
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

    /// The block (i, j), to be changed, if it is stored.
    #[inline]
    #[must_use]
    pub fn block_mut(&mut self, i: usize, j: usize) -> Option<&mut Block<D>> {
        if i >= self.contacts() {
            return None;
        }
        let range = self.range(i);
        let at = self.columns[range.clone()].binary_search(&j).ok()?;
        self.blocks.get_mut(range.start + at)
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
