//! The lowest modes of a beam by subspace iteration (Bathe and Wilson), with nothing but the beam's products and one factor.

use crate::case::Result;
use nalgebra::{Cholesky, DMatrix, SymmetricEigen};
use teeter_beam::{Beam, MatrixWeights};

/// Vectors beyond those asked for: mode k gains (ω_k/ω_{k+EXTRA})² a round, and its frequency twice as many digits.
const EXTRA: usize = 8;

/// Enough for the tenth of a beam's frequencies, whose gain is the least, (10/18)⁴ a round for the vector.
const ROUNDS: usize = 16;

/// The lowest circular frequencies, rad/s, with their shapes, those of rigid motions (0, but for rounding) first. `scale` is a frequency of the
/// order of the lowest: its square shifts K, so that a free beam has a factor too.
pub(crate) fn lowest_modes(beam: &Beam, scale: f64, count: usize) -> Result<Vec<(f64, Vec<f64>)>> {
    let (n, shift) = (beam.dofs(), scale * scale);
    let factor = beam.factor(MatrixWeights { mass: shift, damping: 0.0, stiffness: 1.0 })?;
    let columns = (count + EXTRA).min(beam.free_dofs());
    // Any start that is orthogonal to no mode; `solve` takes what supports hold out.
    let mut x = DMatrix::from_fn(n, columns, |i, j| (1.0 + i as f64 * (1.3 + j as f64)).sin());
    for _ in 0..ROUNDS {
        let mut y = product(&x, |x, y| beam.add_mass_product(1.0, x, y));
        y.column_iter_mut().for_each(|mut column| factor.solve(column.as_mut_slice()));
        // All columns tend to the first mode: without this the small matrices lose the others.
        y = y.qr().q();
        let m = y.tr_mul(&product(&y, |x, y| beam.add_mass_product(1.0, x, y)));
        let k = y.tr_mul(&product(&y, |x, y| beam.add_stiffness_product(1.0, x, y)));
        let lower = Cholesky::new(m).ok_or("the vectors of the subspace depend on each other")?.l();
        let inverse = lower.try_inverse().ok_or("a factor without an inverse")?;
        let small = &inverse * k * inverse.transpose();
        let eigen = SymmetricEigen::new(0.5 * (&small + small.transpose()));
        x = y * inverse.transpose() * eigen.eigenvectors;
    }
    // Rayleigh's quotient of the energies, which are sums of squares: the eigenvalues of the small matrix lose the digits of the low modes.
    let quotient = |x: &[f64]| (beam.elastic_energy(x) / beam.kinetic_energy(x)).sqrt();
    let mode = |shape: &[f64]| (quotient(shape), shape.to_vec());
    let mut found: Vec<_> = x.column_iter().map(|column| mode(column.as_slice())).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.truncate(count);
    Ok(found)
}

/// A product with every column.
fn product(x: &DMatrix<f64>, add: impl Fn(&[f64], &mut [f64])) -> DMatrix<f64> {
    let mut y = DMatrix::zeros(x.nrows(), x.ncols());
    for (x, mut y) in x.column_iter().zip(y.column_iter_mut()) {
        add(x.as_slice(), y.as_mut_slice());
    }
    y
}
