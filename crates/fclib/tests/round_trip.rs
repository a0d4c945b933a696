//! What is written is read back to the bit, and as the same bytes when written again.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use proptest::prelude::*;
use std::path::Path;
use teeter_contact::{Block, BlockSparse, OwnedProblem, Vector};
use teeter_fclib::{FclibError, FclibProblem, Info, LocalProblem, Solution, from_bytes};

fn bits<const D: usize>(local: &LocalProblem<D>) -> Vec<u64> {
    let vectors = |v: &[Vector<D>]| v.iter().flat_map(|v| v.iter().map(|c| c.to_bits())).collect::<Vec<_>>();
    let mut all: Vec<u64> = local.h.blocks().iter().flat_map(|b| b.iter().map(|c| c.to_bits())).collect();
    all.extend(local.h.columns().iter().map(|&c| c as u64));
    all.extend(vectors(&local.q));
    all.extend(local.mu.iter().map(|c| c.to_bits()));
    for s in local.guesses.iter().chain(&local.solution) {
        all.extend(vectors(&s.u));
        all.extend(vectors(&s.r));
        all.extend(s.v.iter().chain(&s.l).map(|c| c.to_bits()));
    }
    all
}

fn back<const D: usize>(local: &LocalProblem<D>, unwrap: fn(FclibProblem) -> LocalProblem<D>) -> LocalProblem<D> {
    let bytes = local.to_bytes().unwrap();
    let read = unwrap(from_bytes(&bytes).unwrap());
    assert_eq!(bits(&read), bits(local));
    assert_eq!((&read.info, read.guesses.len()), (&local.info, local.guesses.len()));
    assert_eq!(read.solution.is_some(), local.solution.is_some());
    assert_eq!(read.to_bytes().unwrap(), bytes, "written twice");
    read
}

fn plane(problem: FclibProblem) -> LocalProblem<2> {
    match problem {
        FclibProblem::Plane(local) => local,
        FclibProblem::Space(_) => panic!("3D"),
    }
}

fn space(problem: FclibProblem) -> LocalProblem<3> {
    match problem {
        FclibProblem::Space(local) => local,
        FclibProblem::Plane(_) => panic!("2D"),
    }
}

#[test]
fn doubles_signs_of_zero_texts_guesses_and_solutions_come_back() {
    let coupling = Matrix2::new(-0.0, f64::MIN_POSITIVE / 4.0, 1e308, 0.1 + 0.2);
    let h = BlockSparse::from_rows(&[
        vec![(0, Matrix2::new(1.0 / 3.0, 0.0, -0.0, 2.0)), (1, coupling)],
        vec![(1, Matrix2::new(5e-324, 1.0, 2.0, 3.0))],
    ])
    .unwrap();
    let some = Solution {
        u: vec![Vector2::new(-0.0, 1e-320), Vector2::new(std::f64::consts::PI, f64::MAX)],
        r: vec![Vector2::new(0.1, -0.2), Vector2::zeros()],
        ..Solution::default()
    };
    let other = Solution { v: vec![1.5, -2.5], l: vec![7.0], ..some.clone() };
    let info = Info {
        title: Some("a title, step 12".to_owned()),
        description: Some("μ varies; trailing blanks  ".to_owned()),
        math_info: Some(String::new()),
    };
    let q = vec![Vector2::new(-1e-300, -0.0), Vector2::new(4.3e-18, 2.0)];
    let guesses = vec![some.clone(), other];
    back(&LocalProblem { h, q, mu: vec![0.0, 1e200], info, guesses, solution: Some(some) }, plane);
}

#[test]
fn a_problem_in_memory_goes_to_a_file_and_back() {
    let h = vec![Matrix2::identity(), Matrix2::zeros(), Matrix2::repeat(0.1), Matrix2::identity() * 2.0];
    let owned = OwnedProblem::dense(h, vec![Vector2::new(-1.0, 0.5), Vector2::new(0.3, -0.0)], vec![0.5, 0.0]).unwrap();
    let read = back(&LocalProblem::of(&owned.problem()), plane);
    assert_eq!(read.h.columns(), [0, 0, 1], "without the zero block");
    let again = read.into_owned().unwrap();
    for i in 0..2 {
        assert_eq!(
            (again.problem().q()[i], again.problem().mu()[i]),
            (owned.problem().q()[i], owned.problem().mu()[i])
        );
        for j in 0..2 {
            assert_eq!(again.problem().block(i, j), owned.problem().block(i, j));
        }
    }
    let bad = LocalProblem { mu: vec![-0.5, 0.0], ..LocalProblem::of(&owned.problem()) };
    assert!(bad.into_owned().is_err());
}

#[test]
fn a_problem_of_no_contacts_comes_back() {
    let read = back(&LocalProblem::<3>::default(), space);
    assert_eq!(read.problem().unwrap().contacts(), 0);
}

#[test]
fn a_problem_in_space_keeps_its_rows_and_columns() {
    let block = |k: f64| Matrix3::from_fn(|r, c| k + 10.0 * r as f64 + c as f64);
    let h = BlockSparse::from_rows(&[
        vec![(0, block(100.0)), (2, block(200.0))],
        vec![(1, block(300.0))],
        vec![(0, block(400.0)), (1, block(500.0)), (2, block(600.0))],
    ])
    .unwrap();
    let local =
        LocalProblem { h, q: vec![Vector3::new(1.0, 2.0, 3.0); 3], mu: vec![0.5; 3], ..LocalProblem::default() };
    assert_eq!(back(&local, space), local);
}

#[test]
fn what_the_format_cannot_hold_is_refused() {
    let one = || LocalProblem {
        h: BlockSparse::from_rows(&[vec![(0, Matrix2::identity())]]).unwrap(),
        q: vec![Vector2::zeros()],
        mu: vec![0.5],
        ..LocalProblem::default()
    };
    let refused = |local: LocalProblem<2>, words: &str| {
        let error = local.to_bytes().unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    let title = Some("a\0b".to_owned());
    refused(LocalProblem { info: Info { title, ..Info::default() }, ..one() }, "NUL");
    refused(LocalProblem { mu: vec![-0.5], ..one() }, "contact 0 is -0.5");
    refused(LocalProblem { mu: vec![], ..one() }, "mu has 0 entries");
    refused(LocalProblem { solution: Some(Solution::default()), ..one() }, "/solution/u has 0 entries, but needs 2");
    let nan = Solution { u: vec![Vector2::zeros()], r: vec![Vector2::new(0.0, f64::NAN)], ..Solution::default() };
    refused(LocalProblem { guesses: vec![nan], ..one() }, "/guesses/1/r of contact 0 is NaN");
    let four = LocalProblem::<4>::default().to_bytes();
    assert!(matches!(four, Err(FclibError::SpaceDimension(4))), "{four:?}");
}

#[test]
fn every_published_problem_comes_back() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/problems");
    if !root.is_dir() {
        println!("skipped: {} is missing", root.display());
        return;
    }
    for folder in ["2d", "3d"] {
        for file in std::fs::read_dir(root.join(folder)).unwrap() {
            match teeter_fclib::read(file.unwrap().path()).unwrap() {
                FclibProblem::Plane(local) => assert_eq!(back(&local, plane), local),
                FclibProblem::Space(local) => assert_eq!(back(&local, space), local),
            }
        }
    }
}

/// Any finite double, all exponents and signs.
fn double() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite())
}

prop_compose! {
    fn problem(contacts: usize)(
        blocks in prop::collection::vec((any::<bool>(), prop::collection::vec(double(), 9)), contacts * contacts),
        q in prop::collection::vec(double(), 3 * contacts),
        mu in prop::collection::vec(double(), contacts),
        title in ".{0,20}",
    ) -> LocalProblem<3> {
        let mut rows = vec![Vec::new(); contacts];
        for (k, (stored, values)) in blocks.iter().enumerate() {
            let (i, j) = (k / contacts, k % contacts);
            let mut block = Block::<3>::from_row_slice(values);
            if i == j {
                for k in 0..3 {
                    block[(k, k)] = block[(k, k)].abs();
                }
                block[(0, 0)] = block[(0, 0)].max(f64::MIN_POSITIVE);
            }
            if i == j || *stored {
                rows[i].push((j, block));
            }
        }
        LocalProblem {
            h: BlockSparse::from_rows(&rows).unwrap(),
            q: q.chunks(3).map(Vector3::from_column_slice).collect(),
            mu: mu.iter().map(|x| x.abs()).collect(),
            info: Info { title: Some(title.replace('\0', "")), ..Info::default() },
            ..LocalProblem::default()
        }
    }
}

proptest! {
    #[test]
    fn random_problems_come_back_to_the_bit(local in (0..6_usize).prop_flat_map(problem)) {
        back(&local, space);
    }
}
