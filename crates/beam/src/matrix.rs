//! The assembled matrices of the free dofs, entry by entry.
//!
//! M, C and K have one pattern, that of the mesh and not of the values: their values can be
//! combined entry by entry, and a symbolic factorisation of one serves them all.

use crate::bar::Tridiagonal;
use crate::beam::Beam;
use crate::blocks::Blocks;
use crate::factor::MatrixWeights;

/// An entry of an assembled matrix, from [`Beam::matrix_entries`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MatrixEntry {
    /// Row, counted in free dofs; never below the diagonal.
    pub row: usize,
    /// Column, counted in free dofs.
    pub column: usize,
    /// Value: N/m, N or N m for forces per displacement, by the units of row and column; for M and
    /// C per acceleration and velocity.
    pub value: f64,
}

/// The upper triangle of a matrix of the free dofs, in compressed columns with ascending rows.
pub(crate) struct Upper {
    /// Where in `rows` each column begins; one more entry than columns.
    pub(crate) starts: Vec<usize>,
    pub(crate) rows: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

impl Beam {
    /// The upper triangle of `mass M + damping C + stiffness K` in the free dofs, column by column
    /// with ascending rows: for linear algebra of one's own. Rows and columns are counted in free
    /// dofs, those of which [`Beam::is_held`] is false, in their order. All weights give the same
    /// places; entries that are 0 are among them.
    ///
    /// C is without the damping ratios of single modes ([`Damping::modal`](crate::Damping::modal)),
    /// which would fill it. K is that of the straight beam, with its given axial force.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, MatrixWeights, Section, Support};
    /// let spec = BeamSpec::new(2.0, 1, Section::new(5.0, 1.0)?).supported([Support::Clamped, Support::Free]);
    /// let beam = Beam::new(spec)?;
    /// let found: Vec<_> = beam.matrix_entries(MatrixWeights::STIFFNESS).map(|e| (e.row, e.column, e.value)).collect();
    /// assert_eq!(found, [(0, 0, 7.5), (0, 1, -7.5), (1, 1, 10.0)]); // 12 EI/l³, −6 EI/l², 4 EI/l
    /// # Ok::<(), teeter_beam::BeamError>(())
    /// ```
    pub fn matrix_entries(&self, weights: MatrixWeights) -> impl Iterator<Item = MatrixEntry> {
        let Upper { starts, rows, values } = self.upper(weights);
        let columns = starts.windows(2).enumerate().flat_map(|(column, range)| vec![column; range[1] - range[0]]);
        let columns: Vec<usize> = columns.collect();
        let places = rows.into_iter().zip(columns);
        places.zip(values).map(|((row, column), value)| MatrixEntry { row, column, value })
    }

    /// The upper triangle of `mass M + damping C + stiffness K`.
    pub(crate) fn upper(&self, weights: MatrixWeights) -> Upper {
        let mut number = vec![0; self.dofs()];
        let mut free = 0;
        for (dof, number) in number.iter_mut().enumerate() {
            *number = free;
            free += usize::from(!self.is_held(dof));
        }
        let mut starts = vec![0; free + 1];
        let mut rows = Vec::new();
        for (row, column) in self.places() {
            rows.push(number[row]);
            starts[number[column] + 1] = rows.len();
        }
        let mut sum = Blocks::zero(self.nodes());
        self.combine(weights, 0.0, &mut sum);
        let mut values = Vec::with_capacity(rows.len());
        self.gather(weights, &sum, &mut values);
        Upper { starts, rows, values }
    }

    /// Row and column of all entries between free dofs, in all dofs, column by column. A column's
    /// rows are its node's and those of the node before.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> {
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

    /// The values of `mass M + damping C + stiffness K` at its places, where `sum` is its bending
    /// part.
    pub(crate) fn gather(&self, weights: MatrixWeights, sum: &Blocks, out: &mut Vec<f64>) {
        let bending = 2 * self.nodes();
        let (mass, stiffness) = self.axial_weights(weights);
        let tri = |t: &Tridiagonal, row: usize, column: usize| t.0[row - bending][column - row];
        out.clear();
        out.extend(self.places().map(|(row, column)| match &self.bar {
            Some(bar) if column >= bending => mass * tri(&bar.m, row, column) + stiffness * tri(&bar.k, row, column),
            _ if row / 2 == column / 2 => sum.0[row / 2].own[row % 2 + column % 2],
            _ => sum.0[row / 2].next[row % 2][column % 2],
        }));
    }
}
