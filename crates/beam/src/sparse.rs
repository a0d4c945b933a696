//! What faer brings: the assembled matrices in its format, and their factorisation by its sparse
//! Cholesky method.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::sparse::linalg::cholesky::simplicial::{
    self, SymbolicSimplicialCholesky, factorize_simplicial_numeric_llt, factorize_simplicial_numeric_llt_scratch,
};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};

use crate::beam::Beam;
use crate::blocks::Blocks;
use crate::error::CholeskyError;
use crate::factor::MatrixWeights;
use crate::matrix::Upper;

impl Beam {
    /// The consistent mass matrix of the free dofs, upper triangle: those of which
    /// [`Beam::is_held`] is false, in their order. M, C and K have one pattern; entries that are 0
    /// are kept.
    ///
    /// ```
    /// use teeter_beam::faer::{Mat, Side, prelude::Solve};
    /// # use teeter_beam::{Beam, BeamSpec, Section};
    /// # let beam = Beam::new(BeamSpec::new(2.0, 4, Section::new(5.0, 3.0)?))?;
    /// let mass = beam.mass_matrix();
    /// assert_eq!(mass.nrows(), beam.free_dofs());
    /// let acceleration = mass.sp_cholesky(Side::Upper)?.solve(Mat::<f64>::ones(mass.nrows(), 1));
    /// assert!(acceleration[(0, 0)].is_finite());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn mass_matrix(&self) -> SparseColMat<usize, f64> {
        self.matrix(MatrixWeights::MASS)
    }

    /// The damping matrix of the free dofs, upper triangle, on the pattern of
    /// [`Beam::mass_matrix`]; without the damping ratios of single modes
    /// ([`Damping::modal`](crate::Damping::modal)), which would fill it.
    pub fn damping_matrix(&self) -> SparseColMat<usize, f64> {
        self.matrix(MatrixWeights::DAMPING)
    }

    /// The stiffness matrix of the free dofs, upper triangle, on the pattern of
    /// [`Beam::mass_matrix`]: of the straight beam, with its given axial force.
    pub fn stiffness_matrix(&self) -> SparseColMat<usize, f64> {
        self.matrix(MatrixWeights::STIFFNESS)
    }

    fn matrix(&self, weights: MatrixWeights) -> SparseColMat<usize, f64> {
        let Upper { starts, rows, values } = self.upper(weights);
        let free = starts.len() - 1;
        SparseColMat::new(SymbolicSparseColMat::new_checked(free, free, starts, None, rows), values)
    }
}

/// L Lᵀ by faer, in the order of the dofs: nothing fills in outside the band.
pub(crate) struct SparseFactor {
    symbolic: SymbolicSimplicialCholesky<usize>,
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
    pub(crate) fn new(beam: &Beam) -> Result<Self, CholeskyError> {
        let matrix = beam.stiffness_matrix();
        // The analysis of a valid pattern can only fail for want of memory.
        let symbolic = analyse(matrix.symbolic().to_owned().ok().as_ref()).ok_or(CholeskyError::Memory)?;
        Ok(Self {
            values: vec![0.0; symbolic.len_val()],
            gathered: matrix.val().to_vec(),
            matrix,
            symbolic,
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

    /// By substitution along the columns of L: faer's own needs scratch, and a vector of the free
    /// dofs alone.
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
