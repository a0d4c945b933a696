//! Sparse factorisation of the symmetric part of H with a positive number added to each contact's diagonal.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};
use teeter_contact::{BlockSparse, Vector};

/// `S + Σ`, S = (H + Hᵀ)/2, Σ one number a contact: analysed once a pattern, factorised without allocating.
#[derive(Default)]
pub(crate) struct Shifted<const D: usize> {
    /// The matrix whose pattern was analysed.
    pattern: BlockSparse<D>,
    analysis: Option<Analysis>,
    /// Of each block of H: how far down its column of the upper triangle its first row is stored.
    down: Vec<usize>,
    /// Where each scalar diagonal entry is stored.
    diagonal: Vec<usize>,
    /// The upper triangle of S by columns, and the same with Σ added.
    symmetric: Vec<f64>,
    values: Vec<f64>,
    factor: Vec<f64>,
    rhs: Vec<f64>,
}

struct Analysis {
    upper: SymbolicSparseColMat<usize>,
    cholesky: SymbolicCholesky<usize>,
    buffer: MemBuffer,
}

impl<const D: usize> std::fmt::Debug for Shifted<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Shifted({} contacts)", self.pattern.contacts())
    }
}

impl<const D: usize> Shifted<D> {
    /// Takes the values of `h`, and analyses its pattern unless that of the last one serves. False where the analysis
    /// fails (it runs out of memory, or of indices).
    pub(crate) fn load(&mut self, h: &BlockSparse<D>) -> bool {
        if self.analysis.is_none() || !self.pattern.same_pattern(h) {
            self.analysis = self.analyse(h);
            self.pattern.clone_from(h);
        }
        let Some(analysis) = &self.analysis else { return false };
        let starts = analysis.upper.col_ptr();
        self.symmetric.clear();
        self.symmetric.resize(analysis.upper.row_idx().len(), 0.0);
        for i in 0..h.contacts() {
            for (k, (j, block)) in h.range(i).zip(h.row(i)) {
                let column = i.max(j);
                for c in 0..D {
                    let at = starts[column * D + c] + self.down[k];
                    if i == j {
                        for r in 0..=c {
                            self.symmetric[at + r] = 0.5 * (block[(r, c)] + block[(c, r)]);
                        }
                    } else {
                        // A block right of the diagonal lies in the upper triangle as it is, one left of it transposed.
                        for r in 0..D {
                            self.symmetric[at + r] += 0.5 * if i < j { block[(r, c)] } else { block[(c, r)] };
                        }
                    }
                }
            }
        }
        true
    }

    fn analyse(&mut self, h: &BlockSparse<D>) -> Option<Analysis> {
        let n = h.contacts();
        // The upper triangle's blocks, by columns; a block may be stored on one side of the diagonal only.
        let mut upper: Vec<_> = (0..n).flat_map(|i| h.row(i).map(move |(j, _)| (i.max(j), i.min(j)))).collect();
        upper.sort_unstable();
        upper.dedup();
        let (mut starts, mut rows) = (Vec::with_capacity(n * D + 1), Vec::with_capacity(upper.len() * D * D));
        let mut first = Vec::with_capacity(n + 1);
        starts.push(0);
        first.push(0);
        self.diagonal.clear();
        for column in upper.chunk_by(|a, b| a.0 == b.0) {
            for c in 0..D {
                for &(j, i) in column {
                    rows.extend((0..if i == j { c + 1 } else { D }).map(|r| i * D + r));
                }
                self.diagonal.push(rows.len() - 1);
                starts.push(rows.len());
            }
            first.push(first.last().copied().unwrap_or(0) + column.len());
        }
        self.down.clear();
        for i in 0..n {
            for (j, _) in h.row(i) {
                let pair = (i.max(j), i.min(j));
                let column = &upper[first[pair.0]..first[pair.0 + 1]];
                self.down.push(D * column.partition_point(|other| *other < pair));
            }
        }
        let upper = SymbolicSparseColMat::new_checked(n * D, n * D, starts, None, rows);
        let (side, ordering) = (Side::Upper, SymmetricOrdering::Amd);
        let cholesky = factorize_symbolic_cholesky(upper.as_ref(), side, ordering, Default::default()).ok()?;
        let scratch = cholesky
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default())
            .or(cholesky.solve_in_place_scratch::<f64>(1, Par::Seq));
        self.factor.clear();
        self.factor.resize(cholesky.len_val(), 0.0);
        self.rhs.clear();
        self.rhs.resize(n * D, 0.0);
        Some(Analysis { upper, cholesky, buffer: MemBuffer::try_new(scratch).ok()? })
    }

    /// Factorises with `shift(i)` added to the diagonal of contact i. False where that isn't positive definite.
    pub(crate) fn factorise(&mut self, shift: impl Fn(usize) -> f64) -> bool {
        let Some(analysis) = &mut self.analysis else { return false };
        self.values.clear();
        self.values.extend_from_slice(&self.symmetric);
        for (k, &at) in self.diagonal.iter().enumerate() {
            self.values[at] += shift(k / D);
        }
        let matrix = SparseColMatRef::new(analysis.upper.as_ref(), &self.values);
        analysis
            .cholesky
            .factorize_numeric_llt(
                &mut self.factor,
                matrix,
                Side::Upper,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut analysis.buffer),
                Default::default(),
            )
            .is_ok()
    }

    /// Solves for the right-hand side in `x`, in place.
    pub(crate) fn solve(&mut self, x: &mut [Vector<D>]) {
        let Some(analysis) = &mut self.analysis else { return };
        for (to, from) in self.rhs.iter_mut().zip(x.iter().flatten()) {
            *to = *from;
        }
        let n = self.rhs.len();
        LltRef::<usize, f64>::new(&analysis.cholesky, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut self.rhs, n, 1),
            Par::Seq,
            MemStack::new(&mut analysis.buffer),
        );
        for (to, from) in x.iter_mut().flatten().zip(&self.rhs) {
            *to = *from;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Vector2};

    #[test]
    fn solves_with_the_symmetric_part_of_a_matrix_stored_on_one_side() {
        let block = |a: f64| Matrix2::new(a, 0.3, -0.1, a + 1.0);
        // (0, 2) is stored above the diagonal only, (1, 0) below only, (1, 2) on both sides, and not symmetric.
        let rows = [
            vec![(0, block(9.0)), (2, block(0.5))],
            vec![(0, block(-0.7)), (1, block(8.0)), (2, block(1.0))],
            vec![(1, block(0.2)), (2, block(7.0))],
        ];
        let h = BlockSparse::from_rows(&rows).unwrap();
        let x: Vec<_> = (0..3).map(|i| Vector2::new(f64::from(i) - 0.5, 2.0 - f64::from(i))).collect();
        let shift = [0.5, 1.5, 2.5];
        let entry = |i: usize, j: usize| h.block(i, j).copied().unwrap_or_default();
        let mut b: Vec<_> = (0..3)
            .map(|i| {
                let product = (0..3).map(|j| (entry(i, j) + entry(j, i).transpose()) * x[j] * 0.5);
                product.sum::<Vector2<f64>>() + x[i] * shift[i]
            })
            .collect();
        let mut shifted = Shifted::default();
        assert!(shifted.load(&h) && shifted.factorise(|i| shift[i]));
        shifted.solve(&mut b);
        for i in 0..3 {
            assert!((b[i] - x[i]).norm() < 1e-14, "{b:?}");
        }
        assert!(!shifted.factorise(|_| -20.0), "not positive definite");
    }
}
