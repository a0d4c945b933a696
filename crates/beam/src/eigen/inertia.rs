//! How many eigenvalues lie below a bound: Sylvester's law of inertia.

use crate::beam::Beam;
use crate::factor::MatrixWeights;

/// Degrees of freedom that can move, so modes.
pub(crate) fn unknowns(beam: &Beam) -> usize {
    beam.free_dofs()
}

/// The number of eigenvalues of (K, M) below `bound` (1/s²): that of the negative pivots of L D
/// Lᵀ = K − bound·M.
///
/// Column by column within the envelope, without pivoting. The rounding of K's entries alone moves
/// an eigenvalue by up to ε ω²_max, so nearer to the bound than that it may fall on either side.
pub(crate) fn eigenvalues_below(beam: &Beam, bound: f64) -> usize {
    let shifted = beam.upper(MatrixWeights { mass: -bound, damping: 0.0, stiffness: 1.0 });
    let n = shifted.starts.len() - 1;
    // Of each column its first row, and L D above the diagonal, which in the end is L.
    let mut first = Vec::with_capacity(n);
    let mut columns: Vec<Vec<f64>> = Vec::with_capacity(n);
    let mut pivots: Vec<f64> = Vec::with_capacity(n);
    for j in 0..n {
        let places = shifted.starts[j]..shifted.starts[j + 1];
        let rows = &shifted.rows[places.clone()];
        // Rows ascend.
        let top = rows.first().copied().unwrap_or(j);
        let mut column = vec![0.0; j - top + 1];
        for (row, value) in rows.iter().zip(&shifted.values[places]) {
            column[row - top] = *value;
        }
        for i in top..j {
            let start = top.max(first[i]);
            let above: f64 = (start..i).map(|k| columns[i][k - first[i]] * column[k - top]).sum();
            column[i - top] -= above;
        }
        let mut pivot = column[j - top];
        for i in top..j {
            let l = column[i - top] / pivots[i];
            pivot -= l * column[i - top];
            column[i - top] = l;
        }
        // A pivot of 0 has either sign, by the smallest change of the bound.
        pivots.push(if pivot == 0.0 { f64::MIN_POSITIVE } else { pivot });
        first.push(top);
        columns.push(column);
    }
    pivots.iter().filter(|pivot| **pivot < 0.0).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::tests::{all_supports, beam};

    #[test]
    fn between_two_frequencies_all_below_are_counted() {
        for elements in [20, 100, 1000] {
            for supports in all_supports() {
                let beam = beam(elements, supports);
                let held = |component| supports.iter().filter(|s| s.holds()[component] == crate::Hold::Fixed).count();
                let rigid = usize::from(held(0) == 0) + usize::from(held(0) < 2 && held(1) == 0);
                for mode in 1..=8 {
                    // ω² in the middle between this one and the next; the finite elements' are less
                    // than 1 % above.
                    let [below, above] = [mode, mode + 1].map(|mode| beam.circular_frequency(mode).unwrap());
                    let count = eigenvalues_below(&beam, below * above);
                    assert_eq!(count, rigid + mode, "{supports:?} {elements}");
                }
                assert_eq!(eigenvalues_below(&beam, f64::MAX.sqrt()), unknowns(&beam));
            }
        }
    }
}
