//! Small dense matrices.

/// Solves A x = b by elimination with row pivots; `None` if A is singular.
pub(super) fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&p, &q| a[p][i].abs().total_cmp(&a[q][i].abs()))?;
        if !(a[pivot][i].abs() > 0.0) {
            return None;
        }
        a.swap(i, pivot);
        b.swap(i, pivot);
        for j in i + 1..n {
            let factor = a[j][i] / a[i][i];
            for k in i..n {
                a[j][k] -= factor * a[i][k];
            }
            b[j] -= factor * b[i];
        }
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| a[i][k] * b[k]).sum();
        b[i] = (b[i] - known) / a[i][i];
    }
    b.iter().all(|x| x.is_finite()).then_some(b)
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
    let scaled: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
    let column = |k: usize| solve(scaled.clone(), (0..n).map(|i| f64::from(u8::from(i == k))).collect());
    let columns: Option<Vec<Vec<f64>>> = (0..n).map(column).collect();
    let columns = columns?;
    Some((0..n).map(|i| (0..n).map(|j| columns[j][i] / (scale[i] * scale[j])).collect()).collect())
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
