//! The assembled matrices of the free dofs, and their factorisation by a general sparse Cholesky method.
//!
//! M, C and K have one pattern, that of the mesh and not of the values: they share one symbolic factorisation, and their
//! values can be combined entry by entry.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::sparse::linalg::cholesky::simplicial::{
    self, SymbolicSimplicialCholesky, factorize_simplicial_numeric_llt, factorize_simplicial_numeric_llt_scratch,
};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};

use crate::bar::Tridiagonal;
use crate::beam::Beam;
use crate::blocks::Blocks;
use crate::error::FactorError;
use crate::factor::MatrixWeights;

/// An entry of the upper triangle in all dofs: row, column.
type Entry = (usize, usize);

impl Beam {
    /// The consistent mass matrix of the free dofs, upper triangle; M, C and K have one pattern, entries that are 0 are kept.
    pub fn mass_matrix(&self) -> SparseColMat<usize, f64> {
        self.matrix(MatrixWeights { mass: 1.0, damping: 0.0, stiffness: 0.0 })
    }

    /// The damping matrix of the free dofs, upper triangle, on the pattern of [`Beam::mass_matrix`].
    pub fn damping_matrix(&self) -> SparseColMat<usize, f64> {
        self.matrix(MatrixWeights { mass: 0.0, damping: 1.0, stiffness: 0.0 })
    }

    /// The stiffness matrix of the free dofs, upper triangle, on the pattern of [`Beam::mass_matrix`].
    pub fn stiffness_matrix(&self) -> SparseColMat<usize, f64> {
        self.matrix(MatrixWeights { mass: 0.0, damping: 0.0, stiffness: 1.0 })
    }

    fn matrix(&self, weights: MatrixWeights) -> SparseColMat<usize, f64> {
        let mut values = Vec::new();
        self.values(weights, &mut values);
        SparseColMat::new(self.pattern(), values)
    }

    /// The upper triangle by columns, in all dofs. A column's rows are its node's and those of the node before.
    fn entries(&self) -> impl Iterator<Item = Entry> {
        let bending = 2 * self.nodes();
        let bend = (0..bending).flat_map(|column| {
            let first = (column / 2).saturating_sub(1) * 2;
            (first..=column).map(move |row| (row, column))
        });
        let axial = (bending..self.dofs()).flat_map(move |column| {
            let first = if column > bending { column - 1 } else { column };
            (first..=column).map(move |row| (row, column))
        });
        bend.chain(axial).filter(|(row, column)| !self.is_held(*row) && !self.is_held(*column))
    }

    fn pattern(&self) -> SymbolicSparseColMat<usize> {
        let mut number = vec![0; self.dofs()];
        let mut free = 0;
        for (dof, number) in number.iter_mut().enumerate() {
            *number = free;
            free += usize::from(!self.is_held(dof));
        }
        let mut column_start = vec![0; free + 1];
        let mut rows = Vec::new();
        for (row, column) in self.entries() {
            rows.push(number[row]);
            column_start[number[column] + 1] = rows.len();
        }
        SymbolicSparseColMat::new_checked(free, free, column_start, None, rows)
    }

    /// The values of `mass M + damping C + stiffness K` on the pattern.
    fn values(&self, weights: MatrixWeights, out: &mut Vec<f64>) {
        let mut sum = Blocks::zero(self.nodes());
        self.combine(weights, 0.0, &mut sum);
        self.gather(weights, &sum, out);
    }

    fn gather(&self, weights: MatrixWeights, sum: &Blocks, out: &mut Vec<f64>) {
        let bending = 2 * self.nodes();
        let (mass, stiffness) = self.axial_weights(weights);
        let tri = |t: &Tridiagonal, row: usize, column: usize| t.0[row - bending][column - row];
        out.clear();
        out.extend(self.entries().map(|(row, column)| match &self.bar {
            Some(bar) if column >= bending => mass * tri(&bar.m, row, column) + stiffness * tri(&bar.k, row, column),
            _ if row / 2 == column / 2 => sum.0[row / 2].own[row % 2 + column % 2],
            _ => sum.0[row / 2].next[row % 2][column % 2],
        }));
    }
}

/// L Lᵀ by faer, in the order of the dofs: nothing fills in outside the band.
pub(crate) struct SparseFactor {
    symbolic: Arc<SymbolicSimplicialCholesky<usize>>,
    matrix: SparseColMat<usize, f64>,
    gathered: Vec<f64>,
    sum: Blocks,
    values: Vec<f64>,
    /// The free dofs.
    free: Vec<usize>,
    scratch: MemBuffer,
}

impl std::fmt::Debug for SparseFactor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SparseFactor").field("free", &self.free.len()).finish_non_exhaustive()
    }
}

impl SparseFactor {
    pub(crate) fn new(beam: &Beam) -> Result<Self, FactorError> {
        let matrix = beam.stiffness_matrix();
        // The analysis of a valid pattern can only fail for want of memory.
        let symbolic = analyse(matrix.symbolic().to_owned().ok().as_ref()).ok_or(FactorError::Memory)?;
        Ok(Self {
            values: vec![0.0; symbolic.len_val()],
            gathered: matrix.val().to_vec(),
            matrix,
            symbolic: Arc::new(symbolic),
            sum: Blocks::zero(beam.nodes()),
            scratch: MemBuffer::new(factorize_simplicial_numeric_llt_scratch::<usize, f64>(beam.free_dofs())),
            free: (0..beam.dofs()).filter(|dof| !beam.is_held(*dof)).collect(),
        })
    }

    /// Factorises; the error is the dof whose pivot is not positive.
    pub(crate) fn update(&mut self, beam: &Beam, weights: MatrixWeights, tension: f64) -> Result<(), usize> {
        beam.combine(weights, tension, &mut self.sum);
        beam.gather(weights, &self.sum, &mut self.gathered);
        self.matrix.val_mut().copy_from_slice(&self.gathered);
        let outcome = factorize_simplicial_numeric_llt(
            &mut self.values,
            self.matrix.as_ref(),
            LltRegularization::default(),
            &self.symbolic,
            MemStack::new(&mut self.scratch),
        );
        outcome.map(drop).map_err(|LltError::NonPositivePivot { index }| {
            self.values.fill(f64::NAN);
            self.free[index.clamp(1, self.free.len()) - 1]
        })
    }

    /// By substitution along the columns of L: faer's own needs scratch, and a vector of the free dofs alone.
    pub(crate) fn solve(&self, f: &mut [f64]) {
        let (start, rows) = (self.symbolic.col_ptr(), self.symbolic.row_idx());
        let n = self.free.len();
        for j in 0..n {
            let (pivot, below) = (start[j], start[j] + 1..start[j + 1]);
            let x = f[self.free[j]] / self.values[pivot];
            f[self.free[j]] = x;
            for k in below {
                f[self.free[rows[k]]] -= self.values[k] * x;
            }
        }
        for j in (0..n).rev() {
            let (pivot, below) = (start[j], start[j] + 1..start[j + 1]);
            let known: f64 = below.map(|k| self.values[k] * f[self.free[rows[k]]]).sum();
            f[self.free[j]] = (f[self.free[j]] - known) / self.values[pivot];
        }
        let mut free = self.free.iter().peekable();
        for (dof, f) in f.iter_mut().enumerate() {
            if free.next_if(|next| **next == dof).is_none() {
                *f = 0.0;
            }
        }
    }
}

/// The symbolic factorisation of a pattern in its own order.
fn analyse(pattern: Option<&SymbolicSparseColMat<usize>>) -> Option<SymbolicSimplicialCholesky<usize>> {
    let pattern = pattern?;
    let n = pattern.ncols();
    let mut tree = vec![0_isize; n];
    let mut counts = vec![0_usize; n];
    let request = simplicial::prefactorize_symbolic_cholesky_scratch::<usize>(n, pattern.row_idx().len())
        .or(simplicial::factorize_simplicial_symbolic_cholesky_scratch::<usize>(n));
    let mut buffer = MemBuffer::new(request);
    let stack = MemStack::new(&mut buffer);
    let tree = simplicial::prefactorize_symbolic_cholesky(&mut tree, &mut counts, pattern.as_ref(), stack);
    simplicial::factorize_simplicial_symbolic_cholesky(pattern.as_ref(), tree, &counts, stack).ok()
}
