//! Small dense matrices.

use nalgebra::{DMatrix, DVector};

/// Solves A x = b by elimination with row pivots; `None` if A is singular.
pub(super) fn solve(a: &[Vec<f64>], b: Vec<f64>) -> Option<Vec<f64>> {
    let a = DMatrix::from_fn(b.len(), b.len(), |i, j| a[i][j]);
    let x = a.lu().solve(&DVector::from_vec(b))?;
    x.iter().all(|x| x.is_finite()).then(|| x.as_slice().to_vec())
}

/// What is added to the unit diagonal of a singular matrix: unknowns of which only a combination
/// matters get large, but finite errors, and a correlation of 1.
const RIDGE: f64 = 1e-9;

/// The inverse of a matrix of normal equations, scaled to a unit diagonal first; `None` if a diagonal
/// element isn't positive.
pub(super) fn inverse(a: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    inverse_with(a, 0.0).filter(|found| (0..a.len()).all(|k| found[k][k] > 0.0)).or_else(|| inverse_with(a, RIDGE))
}

fn inverse_with(a: &[Vec<f64>], ridge: f64) -> Option<Vec<Vec<f64>>> {
    let n = a.len();
    let scale: Vec<f64> = (0..n).map(|k| a[k][k].sqrt()).collect();
    if scale.iter().any(|s| !(*s > 0.0)) {
        return None;
    }
    let entry = |i: usize, j: usize| a[i][j] / (scale[i] * scale[j]) + if i == j { ridge } else { 0.0 };
    let inverse =
        DMatrix::from_fn(n, n, entry).try_inverse().filter(|inverse| inverse.iter().all(|x| x.is_finite()))?;
    Some((0..n).map(|i| (0..n).map(|j| inverse[(i, j)] / (scale[i] * scale[j])).collect()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_times_its_inverse_is_one() {
        let a = vec![vec![4.0, 1e-3, 0.5], vec![1e-3, 1e-6, 1e-4], vec![0.5, 1e-4, 2.0]];
        let inverse = inverse(&a).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = (0..3).map(|k| a[i][k] * inverse[k][j]).sum();
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-9);
            }
        }
        // Only the sum of two unknowns matters: both are unknown, and one makes up for the other.
        let singular = super::inverse(&[vec![1.0, 1.0], vec![1.0, 1.0]]).unwrap();
        assert!(singular[0][0] > 1e8 && singular[0][1] / singular[0][0] < -0.999_999);
        assert!(super::inverse(&[vec![0.0]]).is_none(), "nothing depends on it");
    }
}
