//! Sparse factorisation of the symmetric part of H with a positive number added to each contact's
//! diagonal.

use crate::ordering::Ordering;
use crate::upper::Upper;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::Perm;
use faer::sparse::linalg::cholesky::{LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};
use teeter_contact::{BlockSparse, Vector};

/// `S + Σ` with S = (H + Hᵀ)/2 and Σ one number per contact. A pattern is analysed once;
/// factorising doesn't allocate.
#[derive(Default)]
pub(crate) struct Shifted<const D: usize> {
    symmetric: Upper<D>,
    ordering: Ordering,
    analysis: Option<Analysis>,
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
        write!(f, "Shifted({} rows)", self.rhs.len())
    }
}

impl<const D: usize> Shifted<D> {
    /// Sets the values of `h`, and analyses its pattern if it has changed. False if the analysis
    /// fails (out of memory or index range).
    pub(crate) fn load(&mut self, h: &BlockSparse<D>) -> bool {
        if self.symmetric.load(h) || self.analysis.is_none() {
            self.ordering.neighbours_of(h);
            self.analysis = self.analyse();
        }
        self.analysis.is_some()
    }

    fn analyse(&mut self) -> Option<Analysis> {
        let rows = self.symmetric.starts.len() - 1;
        let order = block_order::<D>(&mut self.ordering, rows / D);
        let upper = SymbolicSparseColMat::new_checked(
            rows,
            rows,
            self.symmetric.starts.clone(),
            None,
            self.symmetric.rows.clone(),
        );
        let ordering = SymmetricOrdering::Custom(order.as_ref());
        let cholesky = factorize_symbolic_cholesky(upper.as_ref(), Side::Upper, ordering, Default::default()).ok()?;
        let scratch = cholesky
            .factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default())
            .or(cholesky.solve_in_place_scratch::<f64>(1, Par::Seq));
        self.factor.clear();
        self.factor.resize(cholesky.len_val(), 0.0);
        self.rhs.clear();
        self.rhs.resize(rows, 0.0);
        Some(Analysis { upper, cholesky, buffer: MemBuffer::try_new(scratch).ok()? })
    }

    /// Factorises with `shift(i)` added to the diagonal of contact i. False if the matrix isn't
    /// positive definite.
    pub(crate) fn factorise(&mut self, shift: impl Fn(usize) -> f64) -> bool {
        let Some(analysis) = &mut self.analysis else { return false };
        self.values.clear();
        self.values.extend_from_slice(&self.symmetric.values);
        for (k, &at) in self.symmetric.diagonal.iter().enumerate() {
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

    /// Solves in place for the right-hand side in `x`.
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

/// The fill-reducing order of the blocks, expanded to their rows: D² times less to order, and
/// blocks stay contiguous.
fn block_order<const D: usize>(ordering: &mut Ordering, n: usize) -> Perm<usize> {
    let (mut order, mut place): (Vec<_>, Vec<_>) = ((0..n).collect(), (0..n).collect());
    ordering.minimum_degree(&mut order, &mut place);
    let spelt = |blocks: &[usize]| blocks.iter().flat_map(|i| (0..D).map(move |r| i * D + r)).collect();
    Perm::new_checked(spelt(&order), spelt(&place), n * D)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::upper::tests::one_sided;
    use nalgebra::Vector2;

    #[test]
    fn solves_with_the_symmetric_part() {
        let h = one_sided();
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
