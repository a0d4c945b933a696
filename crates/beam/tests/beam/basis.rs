//! Modal bases: what static corrections add, and what the error of truncation says.

use crate::{ALL, rigid};
use teeter_beam::{Beam, BeamSpec, Damping, MatrixWeights, ModalBasis, ModalError, Support};

const REGION: [f64; 2] = [0.15, 0.21];

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

fn all_supports() -> impl Iterator<Item = [Support; 2]> {
    ALL.iter().flat_map(|a| ALL.map(|b| [*a, b]))
}

#[test]
fn modes_and_corrections_are_uncoupled_and_the_modes_are_the_beams() {
    for supports in all_supports() {
        let beam = super::beam(40, supports);
        let basis = ModalBasis::new(&beam, 6, &[0.15, 0.17, 0.2, 0.17]).unwrap();
        assert_eq!((basis.modes(), basis.len(), basis.rigid()), (6, 9, rigid(supports)), "a point twice is one");
        assert_eq!(basis.circular_frequencies()[..6], *beam.modes(16).unwrap().circular_frequencies().split_at(6).0);
        let omega = basis.circular_frequencies();
        assert!(omega.is_sorted());
        for i in 0..9 {
            let (mut momentum, mut force) = (vec![0.0; beam.dofs()], vec![0.0; beam.dofs()]);
            beam.add_mass_product(1.0, basis.shape(i), &mut momentum);
            beam.add_stiffness_product(1.0, basis.shape(i), &mut force);
            for j in i..9 {
                let unit = f64::from(u8::from(i == j));
                let stiffness = unit * omega[i] * omega[i];
                assert!((dot(&momentum, basis.shape(j)) - unit).abs() < 1e-13, "{supports:?} {i} {j}");
                let error = (dot(&force, basis.shape(j)) - stiffness).abs();
                assert!(error <= 1e-9 * omega[i].max(1.0) * omega[j].max(1.0), "{supports:?} {i} {j}: {error:e}");
            }
        }
    }
}

#[test]
fn under_a_force_at_a_corrected_point_the_deflection_is_the_static_one() {
    for supports in all_supports().filter(|supports| rigid(*supports) == 0) {
        let beam = super::beam(300, supports);
        let basis = ModalBasis::new(&beam, 2, &[0.17]).unwrap();
        let mut exact = vec![0.0; beam.dofs()];
        beam.add_point_load(0.17, -3.0, &mut exact).unwrap();
        let work = (0..3).map(|i| dot(basis.shape(i), &exact) / basis.circular_frequencies()[i].powi(2));
        let found = basis.dofs(&work.collect::<Vec<_>>());
        beam.solve_static(&mut exact).unwrap();
        let largest = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let error = found.iter().zip(&exact).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(error < 1e-9 * largest, "{supports:?}: {error:e} of {largest:e}");
    }
}

/// F(x, x) by the static solve, which knows nothing of modes.
#[test]
fn the_error_is_that_of_the_static_flexibility() {
    for supports in all_supports().filter(|supports| rigid(*supports) == 0) {
        let beam = super::beam(24, supports);
        for (modes, points) in [(1, vec![]), (5, vec![]), (3, vec![0.16, 0.2])] {
            let basis = ModalBasis::new(&beam, modes, &points).unwrap();
            let error = |x: f64| {
                let mut q = vec![0.0; beam.dofs()];
                beam.add_point_load(x, 1.0, &mut q).unwrap();
                beam.solve_static(&mut q).unwrap();
                let full = beam.deflection_at(&q, x).unwrap().w;
                let contained: f64 = (0..basis.len())
                    .map(|i| {
                        (beam.deflection_at(basis.shape(i), x).unwrap().w / basis.circular_frequencies()[i]).powi(2)
                    })
                    .sum();
                (full - contained) / full
            };
            let exact = (0..=64).map(|s| error(0.15 + 0.06 * f64::from(s) / 64.0)).fold(0.0, f64::max);
            let found = basis.truncation_error(&beam, REGION).unwrap();
            assert!((found / exact - 1.0).abs() < 1e-5, "{supports:?} {modes}: {found:e} {exact:e}");
        }
    }
}

#[test]
fn a_tolerance_is_kept_with_the_fewest_modes_and_with_fewer_shapes_than_modes_alone_would_take() {
    let check = |elements: usize, supports: [Support; 2], tolerance: f64| {
        let beam = super::beam(elements, supports);
        let basis = ModalBasis::for_tolerance(&beam, REGION, tolerance).unwrap();
        let error = basis.truncation_error(&beam, REGION).unwrap();
        assert!(error <= 1.001 * tolerance, "{supports:?} {elements} {tolerance:e}: {error:e}");
        let one_less = basis.len() - 1;
        if one_less > rigid(supports) {
            let fewer = ModalBasis::new(&beam, one_less, &[]).unwrap();
            assert!(fewer.truncation_error(&beam, REGION).unwrap() > tolerance, "{supports:?} {tolerance:e}");
        }
    };
    for supports in all_supports() {
        for tolerance in [1e-1, 1e-2, 1e-4, 1e-6] {
            check(30, supports, tolerance);
        }
    }
    check(400, [Support::Pinned; 2], 1e-4);
    check(400, [Support::Free; 2], 1e-4);
}

#[test]
fn all_modes_are_the_beam_itself() {
    for supports in all_supports() {
        let beam = super::beam(8, supports);
        let basis = ModalBasis::new(&beam, beam.free_dofs(), &[]).unwrap();
        assert!(basis.truncation_error(&beam, [0.0, 0.36]).unwrap() < 1e-12);
        let weights = MatrixWeights { mass: 1.0, damping: 0.5e-4, stiffness: 0.25e-8 };
        assert!(basis.impact_error(&beam, [0.0, 0.36], weights).unwrap() < 1e-12);
        let mut q: Vec<f64> = (0..beam.dofs()).map(|i| (1.3 * i as f64 + 0.4).sin()).collect();
        q.iter_mut().enumerate().filter(|(i, _)| beam.is_held(*i)).for_each(|(_, q)| *q = 0.0);
        let back = basis.dofs(&basis.coordinates(&beam, &q));
        assert!(q.iter().zip(&back).all(|(a, b)| (a - b).abs() < 1e-11), "{supports:?}");
    }
}

#[test]
fn more_modes_leave_less_out() {
    let beam = super::beam(60, [Support::Clamped, Support::Free]);
    let weights = MatrixWeights { mass: 1.0, damping: 0.5e-4, stiffness: 0.25e-8 };
    let errors = |modes| {
        let basis = ModalBasis::new(&beam, modes, &[]).unwrap();
        [basis.truncation_error(&beam, REGION).unwrap(), basis.impact_error(&beam, REGION, weights).unwrap()]
    };
    let all: Vec<_> = [1, 2, 4, 8, 16, 32].map(errors).to_vec();
    assert!(all.windows(2).all(|pair| pair[1][0] < pair[0][0] && pair[1][1] < pair[0][1]), "{all:?}");
    // An impact feels the modes that a lasting force does not.
    assert!(all.iter().all(|[lasting, impact]| impact > lasting), "{all:?}");
}

#[test]
fn viscous_and_rayleigh_damping_stay_diagonal() {
    let mut spec: BeamSpec = super::spec(30, [Support::Pinned; 2]);
    spec.damping = Damping::none().with_viscous(0.4).with_rayleigh_mass(0.7).with_rayleigh_stiffness(1e-5);
    let beam = Beam::new(spec).unwrap();
    let basis = ModalBasis::new(&beam, 5, &[0.1, 0.18]).unwrap();
    for (d, omega) in basis.damping(&beam).unwrap().iter().zip(basis.circular_frequencies()) {
        let exact = 0.4 / 0.1215 + 0.7 + 1e-5 * omega * omega;
        assert!((d / exact - 1.0).abs() < 1e-12, "{d} {exact}");
    }
}

#[test]
fn what_is_no_basis_is_refused_with_what_would_be() {
    let beam = super::beam(4, [Support::Pinned; 2]);
    let text = |error: Result<ModalBasis, ModalError>| error.unwrap_err().to_string();
    assert!(text(ModalBasis::new(&beam, 0, &[])).contains("1 to 8"));
    assert!(text(ModalBasis::new(&beam, 9, &[])).contains("1 to 8"));
    assert!(text(ModalBasis::new(&beam, 2, &[0.37])).contains("[0, 0.36]"));
    for region in [[0.2, 0.1], [-0.1, 0.2], [0.1, 0.4], [f64::NAN, 0.2]] {
        assert!(text(ModalBasis::for_tolerance(&beam, region, 1e-3)).contains("contact region"), "{region:?}");
    }
    for tolerance in [0.0, 1.0, -1.0, f64::NAN] {
        assert!(text(ModalBasis::for_tolerance(&beam, REGION, tolerance)).contains("tolerance"), "{tolerance}");
    }
}
