//! Frequencies and shapes of the finite elements: against the continuous beam, against a dense eigen-solve, and their digits.

use crate::frequencies::{ALL, circular_frequencies, rigid};
use teeter_beam::{Beam, ModesError, Support};

fn all_supports() -> impl Iterator<Item = [Support; 2]> {
    ALL.iter().flat_map(|a| ALL.map(|b| [*a, b]))
}

/// Meshes of so many elements with all pairs of supports that leave a motion.
fn beams(elements: usize) -> impl Iterator<Item = ([Support; 2], Beam)> {
    all_supports()
        .filter(move |supports| elements > 1 || *supports != [Support::Clamped; 2])
        .map(move |supports| (supports, super::beam(elements, supports)))
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

#[test]
fn all_modes_are_those_of_a_dense_solve() {
    for elements in [1, 2, 3, 4, 7, 12] {
        for (supports, beam) in beams(elements) {
            let dense = circular_frequencies(&beam);
            let modes = beam.modes(dense.len()).unwrap();
            assert_eq!(modes.rigid(), rigid(supports), "{supports:?} {elements}");
            let highest = dense[dense.len() - 1];
            for (i, (found, dense)) in modes.circular_frequencies().iter().zip(&dense).enumerate() {
                if i < modes.rigid() {
                    assert_eq!(*found, 0.0, "{supports:?} {elements}");
                    continue;
                }
                // The dense solve's error in ω² is some rounding of the highest.
                let error = (found * found - dense * dense).abs();
                assert!(error < 1e-13 * highest * highest, "{supports:?} {elements} mode {i}: {error:e}");
            }
        }
    }
}

#[test]
fn a_few_modes_are_the_first_of_all_modes() {
    for elements in [6, 15, 40] {
        for (supports, beam) in beams(elements) {
            let all = beam.modes(beam.free_dofs()).unwrap();
            for count in [1, 2, 3, 5, 10] {
                let few = beam.modes(count).unwrap();
                assert_eq!(few.count(), count);
                assert_eq!(few.rigid(), rigid(supports).min(count));
                for (few, all) in few.circular_frequencies().iter().zip(all.circular_frequencies()) {
                    assert!((few - all).abs() <= 1e-12 * all, "{supports:?} {elements}: {few} {all}");
                }
            }
        }
    }
}

#[test]
fn shapes_are_orthonormal_in_mass_and_orthogonal_in_stiffness() {
    for elements in [1, 2, 10, 100, 1000] {
        for (supports, beam) in beams(elements) {
            let count = beam.free_dofs().min(12);
            let modes = beam.modes(count).unwrap();
            let omega = modes.circular_frequencies();
            for i in 0..count {
                let (mut momentum, mut force) = (vec![0.0; beam.dofs()], vec![0.0; beam.dofs()]);
                beam.add_mass_product(1.0, modes.shape(i), &mut momentum);
                beam.add_stiffness_product(1.0, modes.shape(i), &mut force);
                for j in i..count {
                    let unit = f64::from(u8::from(i == j));
                    let error = (dot(&momentum, modes.shape(j)) - unit).abs();
                    // A sum over the beam's entries, so rounding that grows with them.
                    assert!(error < 1e-15 * (elements + 4) as f64, "{supports:?} {elements} {i} {j}: {error:e}");
                    if i >= modes.rigid() && i != j {
                        let error = dot(&force, modes.shape(j)).abs() / (omega[i] * omega[j]);
                        assert!(error < 1e-11, "{supports:?} {elements} {i} {j}: {error:e}");
                    }
                }
            }
            assert!(modes.residuals().iter().all(|residual| *residual <= 1e-10), "{:?}", modes.residuals());
        }
    }
}

#[test]
fn frequencies_converge_from_above_with_order_four() {
    for supports in all_supports() {
        let error = |elements: usize, mode: usize| {
            let beam = super::beam(elements, supports);
            let found = beam.modes(rigid(supports) + mode).unwrap();
            found.circular_frequencies()[rigid(supports) + mode - 1] / beam.circular_frequency(mode).unwrap() - 1.0
        };
        for mode in [1, 4, 8] {
            let (coarse, fine) = (error(24 * mode, mode), error(48 * mode, mode));
            let order = (coarse / fine).log2();
            assert!(fine > 0.0 && (order - 4.0).abs() < 0.01, "{supports:?} mode {mode}: order {order}");
        }
    }
}

/// The elements' own error is (β/n)⁴/1440, β the wave number times the span: below rounding here for the first modes. ε·cond
/// would leave three digits.
#[test]
fn a_thousand_elements_keep_twelve_digits_of_the_first_frequencies() {
    for (supports, beam) in beams(1000) {
        let modes = beam.modes(rigid(supports) + 5).unwrap();
        for mode in 1..=5 {
            let exact = beam.circular_frequency(mode).unwrap();
            let error = modes.circular_frequencies()[rigid(supports) + mode - 1] / exact - 1.0;
            let wave = (mode as f64 + 0.5) * std::f64::consts::PI;
            let elements = (wave / 1000.0).powi(4) / 1440.0;
            assert!(error > -1e-12 && error < 1.1 * elements + 1e-12, "{supports:?} mode {mode}: {error:e}");
        }
    }
}

#[test]
fn a_mesh_as_fine_as_can_be_has_its_modes() {
    for supports in [[Support::Free; 2], [Support::Clamped, Support::Free]] {
        let beam = super::beam(teeter_beam::MAX_ELEMENTS, supports);
        let modes = beam.modes(rigid(supports) + 2).unwrap();
        for mode in 1..=2 {
            let found = modes.circular_frequencies()[rigid(supports) + mode - 1];
            assert!((found / beam.circular_frequency(mode).unwrap() - 1.0).abs() < 1e-11, "{supports:?} {mode}");
        }
    }
}

#[test]
fn rigid_motions_of_a_free_beam_are_a_translation_and_a_rotation_about_the_middle() {
    let beam = super::beam(30, [Support::Free; 2]);
    let modes = beam.modes(2).unwrap();
    let mass = 0.1215 * 0.36;
    let (moved, turned) = (beam.to_nodes(modes.shape(0)), beam.to_nodes(modes.shape(1)));
    let slope = (12.0_f64 / (mass * 0.36 * 0.36)).sqrt();
    for (node, (moved, turned)) in moved.iter().zip(&turned).enumerate() {
        assert!((moved[0] * f64::sqrt(mass) - 1.0).abs() < 1e-14 && moved[1].abs() < 1e-13, "{node}: {moved:?}");
        let w = slope * (0.012 * node as f64 - 0.18);
        assert!((turned[0] - w).abs() < 1e-13 * slope && (turned[1] / slope - 1.0).abs() < 1e-13, "{node}: {turned:?}");
    }
}

#[test]
fn a_count_that_the_beam_has_not_is_refused() {
    let beam = super::beam(3, [Support::Pinned; 2]);
    for count in [0, 7, usize::MAX] {
        assert_eq!(beam.modes(count), Err(ModesError::Count { count, unknowns: 6 }));
    }
    assert!(beam.modes(7).unwrap_err().to_string().contains("1 to 6"));
}

#[test]
fn the_same_beam_has_the_same_modes_to_the_bit() {
    let modes = || super::beam(50, [Support::Clamped, Support::Pinned]).modes(9).unwrap();
    assert_eq!(modes(), modes());
}
