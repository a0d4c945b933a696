//! Eigenvalues of the assembled pair (K, M) against the continuous beam.

use super::{ALL, rigid};
use teeter_beam::faer::sparse::SparseColMat;
use teeter_beam::faer::{Mat, Side};
use teeter_beam::{Beam, Support};

fn dense(upper: &SparseColMat<usize, f64>) -> Mat<f64> {
    let mut full = Mat::zeros(upper.nrows(), upper.ncols());
    for entry in upper.triplet_iter() {
        full[(entry.row, entry.col)] = *entry.val;
        full[(entry.col, entry.row)] = *entry.val;
    }
    full
}

/// Circular frequencies of the finite elements, ascending: the square roots of the eigenvalues of L⁻¹K L⁻ᵀ, M = L Lᵀ.
pub(crate) fn circular_frequencies(beam: &Beam) -> Vec<f64> {
    let factor = dense(&beam.mass_matrix()).llt(Side::Lower).unwrap();
    let lower = factor.L();
    let mut a = dense(&beam.stiffness_matrix());
    for _ in 0..2 {
        lower.solve_lower_triangular_in_place(a.as_mut());
        a = a.transpose().to_owned();
    }
    let values = a.self_adjoint_eigenvalues(Side::Lower).unwrap();
    values.into_iter().map(|value| value.max(0.0).sqrt()).collect()
}

#[test]
fn finite_elements_converge_from_above_with_order_four_for_every_pair_of_supports() {
    for supports in ALL.iter().flat_map(|a| ALL.map(|b| [*a, b])) {
        for mode in 1..=3 {
            let error = |n: usize| {
                let beam = super::beam(n, supports);
                let exact = beam.circular_frequency(mode).unwrap();
                circular_frequencies(&beam)[rigid(supports) + mode - 1] / exact - 1.0
            };
            // Fine enough for the asymptotic range, coarse enough to stay above the eigenvalues' rounding.
            let (coarse, fine) = (error(4 + 2 * mode), error(8 + 4 * mode));
            let order = (coarse / fine).log2();
            assert!(fine > 0.0 && (order - 4.0).abs() < 0.12, "{supports:?} mode {mode}: order {order}");
        }
    }
}

#[test]
fn a_beam_without_enough_supports_has_its_rigid_motions_at_zero() {
    for supports in [[Support::Free; 2], [Support::Pinned, Support::Free]] {
        let found = circular_frequencies(&super::beam(10, supports));
        for omega in &found[..rigid(supports)] {
            assert!(*omega < 1e-4 * found[rigid(supports)], "{supports:?}: {omega}");
        }
    }
}

/// Ten elements, mode 1, correct to all digits (30-digit inverse iteration; `F1_frequencies` of the reference cases).
#[test]
fn first_frequencies_of_ten_elements_are_those_of_an_independent_program() {
    for (supports, expected) in [
        ([Support::Pinned, Support::Pinned], 166.7020623403105),
        ([Support::Clamped, Support::Clamped], 377.90540653138964),
        ([Support::Clamped, Support::Free], 59.386731237108584),
    ] {
        let found = circular_frequencies(&super::beam(10, supports))[0];
        // The eigen-solver's error is about eps of the largest eigenvalue: eps n⁴ on mode 1.
        assert!((found / expected - 1.0).abs() < 1e-9, "{supports:?}: {found}");
    }
}
