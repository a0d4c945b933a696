//! Cholesky factors of weighted sums of the three matrices: the effective inverse mass of a time step.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::sparse::linalg::cholesky::simplicial::{
    self, SymbolicSimplicialCholesky, factorize_simplicial_numeric_llt, factorize_simplicial_numeric_llt_scratch,
};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};

use crate::band::Band;
use crate::beam::Beam;
use crate::error::FactorError;

/// The weights of `mass M + damping C + stiffness K`.
///
/// A θ step of length h wants `{ mass: 1, damping: hθ, stiffness: h²θ² }` (`docs/theory.md` §5), a static solve
/// `{ 0, 0, 1 }`, an impact `{ 1, 0, 0 }`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatrixWeights {
    /// Weight of M.
    pub mass: f64,
    /// Weight of C.
    pub damping: f64,
    /// Weight of K.
    pub stiffness: f64,
}

impl MatrixWeights {
    fn validate(&self) -> Result<(), FactorError> {
        for (field, value) in [("mass", self.mass), ("damping", self.damping), ("stiffness", self.stiffness)] {
            if !value.is_finite() {
                return Err(FactorError::Weight { field, value });
            }
        }
        Ok(())
    }
}

/// The Cholesky factor of a weighted sum of M, C and K, made by [`Beam::factor`].
///
/// Solving needs no scratch and no `mut`: one factor may serve several threads.
pub struct Factor {
    weights: MatrixWeights,
    symbolic: Arc<SymbolicSimplicialCholesky<usize>>,
    matrix: SparseColMat<usize, f64>,
    values: Vec<f64>,
    band: Band,
    scratch: MemBuffer,
}

impl std::fmt::Debug for Factor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Factor").field("dofs", &self.dofs()).field("weights", &self.weights).finish_non_exhaustive()
    }
}

impl Factor {
    /// The weights that were factorised.
    pub fn weights(&self) -> MatrixWeights {
        self.weights
    }

    /// Length of the vectors that it solves for.
    pub fn dofs(&self) -> usize {
        self.band.dofs()
    }

    /// f ← (mass M + damping C + stiffness K)⁻¹ f, in place, without allocation.
    ///
    /// # Panics
    /// If `f` has not [`Factor::dofs`] entries.
    pub fn solve(&self, f: &mut [f64]) {
        assert_eq!(f.len(), self.dofs(), "a right-hand side must have one entry per degree of freedom");
        self.band.solve(f);
    }

    /// Fills in the numbers of a factor whose memory is there.
    fn update(&mut self, beam: &Beam, weights: MatrixWeights) -> Result<(), FactorError> {
        weights.validate()?;
        self.weights = weights;
        let MatrixWeights { mass, damping, stiffness } = weights;
        let parts = beam.mass().val().iter().zip(beam.damping().val()).zip(beam.stiffness().val());
        for (a, ((m, c), k)) in self.matrix.val_mut().iter_mut().zip(parts) {
            *a = mass * m + damping * c + stiffness * k;
        }
        let outcome = factorize_simplicial_numeric_llt(
            &mut self.values,
            self.matrix.as_ref(),
            LltRegularization::default(),
            &self.symbolic,
            MemStack::new(&mut self.scratch),
        );
        match outcome {
            Ok(_) => {
                self.band.fill(self.symbolic.col_ptr(), &self.values);
                Ok(())
            }
            Err(LltError::NonPositivePivot { index }) => {
                // Half a factor must not pass for one.
                self.band.invalidate();
                Err(FactorError::NotPositiveDefinite { weights, pivot: index })
            }
        }
    }
}

/// The symbolic factorisation of a banded pattern in its own order (nothing fills in outside the band).
pub(crate) fn analyse(pattern: &SymbolicSparseColMat<usize>) -> Option<SymbolicSimplicialCholesky<usize>> {
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

impl Beam {
    /// The Cholesky factor of `mass M + damping C + stiffness K`.
    ///
    /// # Errors
    /// [`FactorError`] for weights that are not finite, or whose sum is not positive definite.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Damping, MatrixWeights, Section, Support};
    /// # let beam = Beam::new(BeamSpec {
    /// #     span: 0.36, elements: 20, section: Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?,
    /// #     supports: [Support::Pinned; 2], damping: Damping::default() })?;
    /// let h = 1e-4;
    /// let w = beam.factor(MatrixWeights { mass: 1.0, damping: 0.5 * h, stiffness: 0.25 * h * h })?;
    /// let mut jump = vec![0.0; beam.dofs()];
    /// beam.add_point_load(0.18, -1e-3, &mut jump)?; // here an impulse, N s
    /// w.solve(&mut jump); // and the velocity that it gives
    /// assert!(beam.deflection_at(&jump, 0.18).is_some_and(|d| d.w < 0.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn factor(&self, weights: MatrixWeights) -> Result<Factor, FactorError> {
        let symbolic = Arc::clone(&self.symbolic);
        let scratch = MemBuffer::new(factorize_simplicial_numeric_llt_scratch::<usize, f64>(self.dofs()));
        let values = vec![0.0; symbolic.len_val()];
        let mut factor = Factor {
            weights,
            symbolic,
            matrix: self.stiffness().clone(),
            values,
            band: Band::new(self.dofs()),
            scratch,
        };
        factor.update(self, weights)?;
        Ok(factor)
    }

    /// Makes `factor` that of other weights, in its own memory: no symbolic work, no allocation.
    ///
    /// # Errors
    /// As [`Beam::factor`], and [`FactorError::OtherBeam`] for the factor of a beam whose matrices have another pattern.
    /// After [`FactorError::NotPositiveDefinite`] the factor's solutions are NaN until it is renewed with success.
    ///
    /// ```
    /// # use teeter_beam::{Beam, BeamSpec, Damping, MatrixWeights, Section, Support};
    /// # let beam = Beam::new(BeamSpec {
    /// #     span: 0.36, elements: 20, section: Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?,
    /// #     supports: [Support::Pinned; 2], damping: Damping::default() })?;
    /// let mut w = beam.factor(MatrixWeights { mass: 1.0, damping: 0.0, stiffness: 0.0 })?;
    /// beam.refactor(MatrixWeights { mass: 1.0, damping: 0.0, stiffness: 2.5e-9 }, &mut w)?;
    /// assert_eq!(w.weights().stiffness, 2.5e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn refactor(&self, weights: MatrixWeights, factor: &mut Factor) -> Result<(), FactorError> {
        // By pattern, not by identity: a beam of another section or span may take over the memory.
        let (ours, theirs) = (self.stiffness().symbolic(), factor.matrix.symbolic());
        if ours.col_ptr() != theirs.col_ptr() {
            return Err(FactorError::OtherBeam { expected: self.dofs(), found: factor.dofs() });
        }
        factor.update(self, weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Support::{Clamped, Free, Pinned};
    use crate::beam::tests::{all_supports, beam, damped, wave};

    const STEP: MatrixWeights = MatrixWeights { mass: 1.0, damping: 5e-3, stiffness: 2.5e-5 };

    #[test]
    fn solving_undoes_the_products_for_all_supports() {
        for supports in all_supports() {
            for elements in [2, 3, 20] {
                let beam = damped(elements, supports);
                let x = wave(beam.dofs());
                let mut f = vec![0.0; beam.dofs()];
                beam.add_mass_product(STEP.mass, &x, &mut f);
                beam.add_damping_product(STEP.damping, &x, &mut f);
                beam.add_stiffness_product(STEP.stiffness, &x, &mut f);
                beam.factor(STEP).unwrap().solve(&mut f);
                for (f, x) in f.iter().zip(&x) {
                    assert!((f - x).abs() < 1e-9, "{supports:?} {elements}: {f} {x}");
                }
            }
        }
    }

    #[test]
    fn a_renewed_factor_is_bitwise_a_new_one() {
        let beam = damped(12, [Pinned, Pinned]);
        let mut renewed = beam.factor(MatrixWeights { mass: 1.0, damping: 0.0, stiffness: 0.0 }).unwrap();
        beam.refactor(STEP, &mut renewed).unwrap();
        let fresh = beam.factor(STEP).unwrap();
        let (mut a, mut b) = (wave(beam.dofs()), wave(beam.dofs()));
        renewed.solve(&mut a);
        fresh.solve(&mut b);
        assert_eq!(a, b);
        assert_eq!(renewed.weights(), STEP);
    }

    #[test]
    fn bad_weights_are_refused_and_leave_no_half_factor() {
        let beam = beam(6, [Clamped, Free]);
        let mut factor = beam.factor(STEP).unwrap();
        let negative = MatrixWeights { mass: -1.0, ..STEP };
        assert!(matches!(beam.refactor(negative, &mut factor), Err(FactorError::NotPositiveDefinite { pivot: 1, .. })));
        let mut x = vec![1.0; beam.dofs()];
        factor.solve(&mut x);
        assert!(x.iter().all(|x| x.is_nan()));
        beam.refactor(STEP, &mut factor).unwrap();
        let mut x = vec![1.0; beam.dofs()];
        factor.solve(&mut x);
        assert!(x.iter().all(|x| x.is_finite()));
        for (field, weights) in [
            ("mass", MatrixWeights { mass: f64::NAN, ..STEP }),
            ("damping", MatrixWeights { damping: f64::INFINITY, ..STEP }),
            ("stiffness", MatrixWeights { stiffness: f64::NEG_INFINITY, ..STEP }),
        ] {
            let text = beam.factor(weights).unwrap_err().to_string();
            assert!(text.contains(field), "{text}");
        }
    }

    #[test]
    fn the_factor_of_another_beam_is_refused() {
        let mut factor = beam(6, [Clamped, Free]).factor(STEP).unwrap();
        for other in [beam(7, [Clamped, Free]), beam(6, [Pinned, Pinned]), beam(6, [Free, Free])] {
            assert!(matches!(other.refactor(STEP, &mut factor), Err(FactorError::OtherBeam { .. })));
        }
    }
}
