//! Problems from Jacobians, against sums over all velocities written out.

use crate::random::Random;
use nalgebra::{Matrix2, Vector2};
use teeter_contact::{InverseMass, Jacobian, OwnedProblem, ProblemError};

/// Contacts between two of `bodies` bodies of three velocities each, or a body and the ground.
fn crowd(contacts: usize, bodies: usize, random: &mut Random) -> Jacobian<2> {
    let mut jacobian = Jacobian::new();
    for _ in 0..contacts {
        let first = random.below(bodies);
        let second = random.below(bodies + 1);
        let touched = [Some(first), (second < bodies && second != first).then_some(second)];
        let mut columns = Vec::new();
        for body in touched.into_iter().flatten() {
            columns.extend((0..3).map(|k| (3 * body + k, Vector2::new(random.number(), random.number()))));
        }
        // In any order.
        columns.reverse();
        jacobian.push(columns);
    }
    jacobian
}

#[test]
fn h_and_q_are_the_products_of_the_jacobian() {
    let mut random = Random(21);
    for _ in 0..60 {
        let (n, bodies) = (1 + random.below(12), 1 + random.below(8));
        let jacobian = crowd(n, bodies, &mut random);
        let inverse: Vec<f64> = (0..3 * bodies).map(|_| 1.5 + random.number()).collect();
        let v: Vec<f64> = (0..3 * bodies).map(|_| random.number()).collect();
        let mu: Vec<f64> = (0..n).map(|i| 0.1 * i as f64).collect();
        let of = |mass| OwnedProblem::from_jacobian(&jacobian, mass, &v, mu.clone()).unwrap();
        let diagonal = of(InverseMass::Diagonal(&inverse));
        let mut calls = 0;
        let mut divide = |x: &mut [f64]| {
            calls += 1;
            x.iter_mut().zip(&inverse).for_each(|(x, inverse)| *x *= inverse);
        };
        let solved = of(InverseMass::Solver(&mut divide));
        assert_eq!(calls, 2 * n);
        let dense = |i: usize| {
            let mut row = vec![Vector2::zeros(); 3 * bodies];
            jacobian.row(i).iter().for_each(|(column, entry)| row[*column] += entry);
            row
        };
        for i in 0..n {
            let a = dense(i);
            let q = (0..3 * bodies).fold(Vector2::zeros(), |sum, c| sum + a[c] * v[c]);
            for problem in [diagonal.problem(), solved.problem()] {
                assert!((problem.q()[i] - q).norm() < 1e-14 && problem.mu()[i] == mu[i]);
                for j in 0..n {
                    let b = dense(j);
                    let h = (0..3 * bodies).fold(Matrix2::zeros(), |sum, c| sum + a[c] * b[c].transpose() * inverse[c]);
                    assert!((problem.block(i, j).unwrap() - h).norm() < 1e-13, "{i} {j}");
                }
            }
        }
        assert_eq!(diagonal.problem().asymmetry(), 0.0);
        // Contacts that share no body have no block.
        let blocks = |owned: &OwnedProblem<2>| (0..n).map(|i| owned.problem().row(i).unwrap().len()).sum::<usize>();
        assert_eq!(blocks(&diagonal), blocks(&solved));
        assert_eq!(Some(blocks(&diagonal)), diagonal.problem().nonzero_blocks());
    }
}

#[cfg(feature = "conformance")]
#[test]
fn a_box_on_a_floor_is_that_of_the_conformance_cases() {
    use nalgebra::Vector3;
    let corners = [[-0.5, -0.3, -1.0], [0.5, -0.3, -1.0], [0.5, 0.3, -1.0]];
    let (inertia, velocity) = ([0.4, 0.5, 0.1], [0.2, 0.1, -1.0, 0.3, 0.0, 0.5]);
    let case = teeter_contact::conformance::box_on_floor("box", inertia, &corners, velocity, 0.4);
    let mut jacobian = Jacobian::new();
    for [x, y, z] in corners {
        // Rows: normal z, tangents x and y; columns: velocity, then rotation.
        jacobian.push([
            (0, Vector3::new(0.0, 1.0, 0.0)),
            (1, Vector3::new(0.0, 0.0, 1.0)),
            (2, Vector3::new(1.0, 0.0, 0.0)),
            (3, Vector3::new(y, 0.0, -z)),
            (4, Vector3::new(-x, z, 0.0)),
            (5, Vector3::new(0.0, -y, x)),
        ]);
    }
    let inverse: Vec<f64> = [1.0; 3].into_iter().chain(inertia.map(f64::recip)).collect();
    let owned = OwnedProblem::from_jacobian(&jacobian, InverseMass::Diagonal(&inverse), &velocity, case.mu.clone());
    let owned = owned.unwrap();
    for i in 0..3 {
        assert!((owned.problem().q()[i] - case.q[i]).norm() < 1e-15);
        for j in 0..3 {
            assert!((owned.problem().block(i, j).unwrap() - case.h[3 * i + j]).norm() < 1e-14);
        }
    }
}

#[test]
fn a_shift_is_added_to_q() {
    let jacobian = crowd(3, 2, &mut Random(4));
    let (v, inverse) = ([0.1, -0.2, 0.3, 0.4, -0.5, 0.6], [1.0; 6]);
    let owned = OwnedProblem::from_jacobian(&jacobian, InverseMass::Diagonal(&inverse), &v, vec![0.2; 3]).unwrap();
    let bounce: Vec<_> = (0..3).map(|i| Vector2::new(-0.5 * f64::from(i), 0.0)).collect();
    let shifted = owned.clone().shifted(&bounce).unwrap();
    for i in 0..3 {
        assert_eq!(shifted.problem().q()[i], owned.problem().q()[i] + bounce[i]);
    }
    assert!(matches!(owned.clone().shifted(&bounce[..1]), Err(ProblemError::Size { what: "the shift", found: 1, .. })));
    let infinite = vec![Vector2::repeat(f64::INFINITY); 3];
    assert!(matches!(owned.shifted(&infinite), Err(ProblemError::NotFinite { what: "q", contact: 0, .. })));
}

#[test]
fn wrong_data_is_refused_with_the_place_and_the_number() {
    let of = |column: usize, entry: Vector2<f64>, inverse: &[f64], mu: &[f64]| {
        let mut jacobian = Jacobian::new();
        jacobian.push([(0, Vector2::new(1.0, 0.0))]);
        jacobian.push([(column, entry)]);
        let made = OwnedProblem::from_jacobian(&jacobian, InverseMass::Diagonal(inverse), &[0.0, 1.0], mu.to_vec());
        made.map(|_| ()).map_err(|error| error.to_string())
    };
    let normal = Vector2::new(1.0, 0.0);
    assert_eq!(of(1, normal, &[1.0, 2.0], &[0.1, 0.2]), Ok(()));
    let refused =
        |found: Result<(), String>, words: &str| assert!(found.as_ref().is_err_and(|e| e.contains(words)), "{found:?}");
    refused(
        of(2, normal, &[1.0, 2.0], &[0.1, 0.2]),
        "the Jacobian of contact 1 has column 2, but there are 2 velocities",
    );
    refused(of(1, normal * f64::NAN, &[1.0, 2.0], &[0.1, 0.2]), "the Jacobian of contact 1 is NaN");
    refused(of(1, normal, &[1.0], &[0.1, 0.2]), "the inverse mass has 1 entries, but there are 2 velocities");
    refused(of(1, normal, &[1.0, 2.0], &[0.1]), "mu has 1 entries");
    refused(of(1, normal, &[1.0, -2.0], &[0.1, 0.2]), "H_NN of contact 1 is -2");
    refused(of(1, normal * 0.0, &[1.0, 2.0], &[0.1, 0.2]), "H_NN of contact 1 is 0");
}
