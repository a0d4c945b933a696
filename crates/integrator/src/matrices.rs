//! Constant matrices of a subsystem with few velocities: its products and its factor, ready made.

use crate::{Compliance, FactorError, Weights};
use nalgebra::{Cholesky, Const, SMatrix, SVector};

/// M, C and K of a subsystem with N velocities, where they are constant:
/// [`Dynamics::apply`](crate::Dynamics::apply) and [`Dynamics::factor`](crate::Dynamics::factor) in
/// a line each. No velocity may be [driven or held](crate::Traits).
///
/// ```
/// use teeter_integrator::{ConstantMatrices, Weights};
///
/// // A mass of 2 kg on a spring of 800 N/m, with a dashpot of 3 N s/m.
/// let mass = ConstantMatrices::mass([[2.0]]).with_damping([[3.0]]).with_stiffness([[800.0]]);
/// let mut y = [0.0];
/// mass.apply(Weights { mass: 1.0, damping: 0.0, stiffness: 0.01 }, &[1.0], &mut y);
/// assert_eq!(y, [10.0]);
/// let mut w = mass.factor::<2>(Weights::MASS)?;
/// w.solve(&mut y);
/// assert!((y[0] - 5.0).abs() < 1e-15);
/// # Ok::<(), teeter_integrator::FactorError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantMatrices<const N: usize> {
    mass: SMatrix<f64, N, N>,
    damping: SMatrix<f64, N, N>,
    stiffness: SMatrix<f64, N, N>,
}

impl<const N: usize> ConstantMatrices<N> {
    /// M by its rows; C and K are 0. Symmetric, in kg, kg·m or kg·m² by the velocities' units.
    #[must_use]
    pub fn mass(rows: [[f64; N]; N]) -> Self {
        Self { mass: of_rows(rows), damping: SMatrix::zeros(), stiffness: SMatrix::zeros() }
    }

    /// With C by its rows: symmetric and positive semidefinite; as M, but by the second.
    #[must_use]
    pub fn with_damping(self, rows: [[f64; N]; N]) -> Self {
        Self { damping: of_rows(rows), ..self }
    }

    /// With K by its rows: symmetric; as M, but by the square of the second.
    #[must_use]
    pub fn with_stiffness(self, rows: [[f64; N]; N]) -> Self {
        Self { stiffness: of_rows(rows), ..self }
    }

    /// Adds `(mass·M + damping·C + stiffness·K) x` to `y`; both have N numbers.
    pub fn apply(&self, w: Weights, x: &[f64], y: &mut [f64]) {
        let matrix = self.weighted(w);
        for (i, y) in y.iter_mut().enumerate().take(N) {
            *y += x.iter().take(N).enumerate().map(|(j, x)| matrix[(i, j)] * x).sum::<f64>();
        }
    }

    /// ½ vᵀM v, J.
    #[must_use]
    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        self.form(&self.mass, v)
    }

    /// ½ xᵀK x, J, with x the way from the place without force.
    #[must_use]
    pub fn elastic_energy(&self, x: &[f64]) -> f64 {
        self.form(&self.stiffness, x)
    }

    fn form(&self, matrix: &SMatrix<f64, N, N>, x: &[f64]) -> f64 {
        let x = SVector::<f64, N>::from_fn(|i, _| x.get(i).copied().unwrap_or_default());
        0.5 * x.dot(&(matrix * x))
    }

    fn weighted(&self, w: Weights) -> SMatrix<f64, N, N> {
        self.mass * w.mass + self.damping * w.damping + self.stiffness * w.stiffness
    }

    /// The inverse of `mass·M + damping·C + stiffness·K`, by Cholesky.
    ///
    /// # Errors
    /// If the matrix is not positive definite.
    pub fn factor<const D: usize>(&self, w: Weights) -> Result<Box<dyn Compliance<D>>, FactorError> {
        Ok(Box::new(Factor { matrices: *self, weights: w, cholesky: self.cholesky(w)? }))
    }

    fn cholesky(&self, w: Weights) -> Result<Cholesky<f64, Const<N>>, FactorError> {
        let not_definite = || FactorError { weights: w, reason: "the matrix is not positive definite".to_owned() };
        self.weighted(w).cholesky().ok_or_else(not_definite)
    }
}

fn of_rows<const N: usize>(rows: [[f64; N]; N]) -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|i, j| rows[i][j])
}

struct Factor<const N: usize> {
    matrices: ConstantMatrices<N>,
    weights: Weights,
    cholesky: Cholesky<f64, Const<N>>,
}

impl<const N: usize, const D: usize> Compliance<D> for Factor<N> {
    fn weights(&self) -> Weights {
        self.weights
    }

    fn refactor(&mut self, w: Weights, _q: &[f64]) -> Result<(), FactorError> {
        (self.cholesky, self.weights) = (self.matrices.cholesky(w)?, w);
        Ok(())
    }

    fn solve(&mut self, f: &mut [f64]) {
        let mut x = SVector::<f64, N>::from_fn(|i, _| f[i]);
        self.cholesky.solve_mut(&mut x);
        f[..N].copy_from_slice(x.as_slice());
    }
}
