//! Frequencies and shapes of the finite elements: against the continuous beam, against a dense eigen-solve, and their digits.

#[cfg(feature = "faer")]
use crate::frequencies::circular_frequencies;
use crate::{ALL, rigid};
use teeter_beam::{Axial, Beam, BeamSpec, Foundation, Hold, ModesError, Section, Support};

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

#[cfg(feature = "faer")]
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

/// Two equal spans on pins: every mode of one span pinned at both ends, and every mode of one pinned and clamped.
#[test]
fn two_equal_spans_have_the_modes_of_both_symmetries() {
    for elements in [40, 1000] {
        let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap();
        let beam = Beam::new(BeamSpec::new(0.72, elements, section).support_at(0.36, Support::Pinned)).unwrap();
        let found = beam.modes(6).unwrap();
        let one = |supports, mode| super::spec(1, supports).circular_frequency(mode).unwrap();
        let exact =
            (1..=3).flat_map(|mode| [one([Support::Pinned; 2], mode), one([Support::Clamped, Support::Pinned], mode)]);
        for (found, exact) in found.circular_frequencies().iter().zip(exact) {
            let elements = (12.0 / (0.5 * elements as f64)).powi(4) / 1440.0;
            assert!((found / exact - 1.0).abs() < elements + 1e-11, "{found} {exact}");
        }
    }
}

#[test]
fn a_frequency_that_many_modes_share_has_them_all() {
    // Spans between clamps do not know of each other.
    let spans = 14;
    let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap();
    let mut spec = BeamSpec::new(0.36 * spans as f64, 6 * spans, section).supported([Support::Clamped; 2]);
    for span in 1..spans {
        spec = spec.support_at(0.36 * span as f64, Support::Clamped);
    }
    let beam = Beam::new(spec).unwrap();
    let single = super::beam(6, [Support::Clamped; 2]).modes(2).unwrap().circular_frequencies().to_vec();
    for count in [1, 5, 14, 15, 28] {
        let found = beam.modes(count).unwrap();
        for (mode, found) in found.circular_frequencies().iter().enumerate() {
            let exact = single[mode / spans];
            assert!((found / exact - 1.0).abs() < 1e-10, "{count} {mode}: {found} {exact}");
        }
    }
}

#[test]
fn springs_and_axial_dofs_leave_the_rigid_motions_that_they_leave() {
    let section = Section::new(2.0, 3.0).unwrap().with_axial_stiffness(50.0).unwrap();
    let spring =
        |stiffness| Support::Elastic { deflection: Hold::Spring { stiffness, damping: 0.0 }, rotation: Hold::Free };
    let free = BeamSpec::new(1.0, 10, section).supported([Support::Free; 2]);
    for (spec, rigid) in [
        (free.clone(), 2),
        (free.clone().support_at(0.3, spring(20.0)), 1),
        (free.clone().support_at(0.3, spring(20.0)).support_at(0.9, spring(5.0)), 0),
        (free.clone().axial(Axial::elastic([false; 2])), 3),
        (free.clone().axial(Axial::elastic([true, false])), 2),
        (free.clone().foundation(Foundation::new(0.2, 0.4, 1.0)), 0),
    ] {
        let beam = Beam::new(spec).unwrap();
        let modes = beam.modes(6).unwrap();
        assert_eq!(modes.rigid(), rigid, "{:?}", beam.spec());
        #[cfg(feature = "faer")]
        for (found, dense) in modes.circular_frequencies().iter().zip(&circular_frequencies(&beam)).skip(rigid) {
            assert!((found / dense - 1.0).abs() < 1e-7, "{found} {dense}");
        }
        assert!(modes.circular_frequencies()[..rigid].iter().all(|omega| *omega == 0.0));
    }
}

#[cfg(feature = "faer")]
#[test]
fn a_beam_with_everything_has_the_modes_of_a_dense_solve() {
    let plain = Section::new(2.0, 3.0).unwrap().with_axial_stiffness(50.0).unwrap();
    let thick = Section::new(5.0, 4.0).unwrap().with_shear(40.0, 0.02).unwrap().with_axial_stiffness(70.0).unwrap();
    let spring = |stiffness| Hold::Spring { stiffness, damping: 0.0 };
    let end = Support::Elastic { deflection: spring(30.0), rotation: spring(1.5) };
    let spec = BeamSpec::new(1.0, 24, plain)
        .supported([Support::Clamped, end])
        .segment(0.3, 0.5, thick)
        .support_at(0.75, Support::Pinned)
        .lump(0.4, 0.5, 0.01)
        .foundation(Foundation::new(0.1, 0.65, 80.0))
        .axial(Axial::elastic([true, false]))
        .axial_force(3.0);
    let beam = Beam::new(spec).unwrap();
    let dense = circular_frequencies(&beam);
    for count in [4, 12, beam.free_dofs()] {
        let found = beam.modes(count).unwrap();
        for (found, dense) in found.circular_frequencies().iter().zip(&dense) {
            assert!((found / dense - 1.0).abs() < 1e-8, "{count}: {found} {dense}");
        }
    }
}

#[test]
fn a_beam_beyond_its_buckling_load_is_refused() {
    let euler = 0.5821875 * (std::f64::consts::PI / 0.36).powi(2);
    for elements in [20, 2000] {
        let beam = |force: f64| Beam::new(super::spec(elements, [Support::Pinned; 2]).axial_force(force)).unwrap();
        let omega = beam(-0.99 * euler).modes(3).unwrap().circular_frequencies()[0];
        let exact = 0.1 * super::spec(1, [Support::Pinned; 2]).circular_frequency(1).unwrap(); // ω₁ √(1 − N/N_cr)
        assert!((omega / exact - 1.0).abs() < 1e-4, "{omega} {exact}");
        let refused = beam(-1.01 * euler).modes(3);
        assert!(matches!(refused, Err(ModesError::Factor(_) | ModesError::Unstable { .. })), "{refused:?}");
    }
}
