//! A problem is the same however its operator is stored.

use crate::random::{Random, operator, vectors};
use nalgebra::{Matrix2, Vector2};
use teeter_contact::{
    Block, BlockSparse, ContactProblem, Delassus, DelassusOperator, Islands, OwnedProblem, ProblemError, judge,
};

/// The product only.
struct Product<'a>(&'a [Block<2>], usize);

impl DelassusOperator<2> for Product<'_> {
    fn contacts(&self) -> usize {
        self.1
    }

    fn diagonal(&self, i: usize) -> Block<2> {
        self.0[i * self.1 + i]
    }

    fn row_product(&self, i: usize, p: &[Vector2<f64>]) -> Vector2<f64> {
        (0..p.len()).fold(Vector2::zeros(), |sum, j| sum + self.0[i * self.1 + j] * p[j])
    }
}

/// The non-zero blocks and the diagonal.
fn sparse(n: usize, h: &[Block<2>]) -> BlockSparse<2> {
    let mut sparse = BlockSparse::default();
    let stored = |i: usize, j: usize| i == j || h[i * n + j] != Matrix2::zeros();
    sparse.set_rows(n, |i| (0..n).filter(move |&j| stored(i, j)).map(move |j| (j, h[i * n + j]))).unwrap();
    sparse
}

#[test]
fn all_storages_answer_alike() {
    let mut random = Random(3);
    for _ in 0..50 {
        let n = 1 + random.below(12);
        let h = operator(n, 2 * n, &mut random);
        let (q, p, mu) = (vectors(n, &mut random), vectors(n, &mut random), vec![0.3; n]);
        let (sparse, product) = (sparse(n, &h), Product(&h, n));
        let of = |h| ContactProblem::new(h, &q, &mu).unwrap();
        let (dense, blocks, operator) =
            (of(Delassus::Dense(&h)), of(Delassus::Blocks(&sparse)), of(Delassus::Operator(&product)));
        for i in 0..n {
            assert!(dense.row(i).unwrap().map(|(j, block)| (j, *block)).eq((0..n).map(|j| (j, h[i * n + j]))));
            assert!(blocks.row(i).unwrap().eq(sparse.row(i)) && operator.row(i).is_none());
            for j in 0..n {
                assert_eq!(dense.block(i, j), Some(h[i * n + j]));
                assert_eq!(blocks.block(i, j), dense.block(i, j));
                assert!(operator.block(i, j).is_none());
            }
        }
        let velocities = |problem: ContactProblem<'_, 2>| {
            let mut u = vec![Vector2::zeros(); n];
            problem.velocities(&p, &mut u);
            assert!((0..n).all(|i| u[i] == problem.velocity(i, &p)));
            u
        };
        assert_eq!(velocities(dense), velocities(blocks));
        assert_eq!(velocities(dense), velocities(operator));
        assert_eq!(judge(&dense, &p), judge(&blocks, &p));
        assert_eq!(judge(&dense, &p), judge(&operator, &p));
        assert_eq!(dense.nonzero_blocks(), Some(sparse.blocks().len()));
        assert_eq!(dense.nonzero_blocks(), blocks.nonzero_blocks());
        let squares: f64 = h.iter().flat_map(|block| block.iter()).map(|x| x * x).sum();
        assert!((dense.h_norm().unwrap() - squares.sqrt()).abs() <= 1e-14 * squares.sqrt());
        assert!((blocks.h_norm().unwrap() - squares.sqrt()).abs() <= 1e-14 * squares.sqrt());
        assert!(operator.nonzero_blocks().is_none() && operator.h_norm().is_none());
        assert_eq!(dense.q_norm(), q.iter().map(Vector2::norm_squared).sum::<f64>().sqrt());
    }
}

#[test]
fn an_island_is_the_part_of_the_problem_between_its_contacts() {
    let mut random = Random(11);
    let mut islands = Islands::default();
    let (mut of_dense, mut of_sparse) = (OwnedProblem::default(), OwnedProblem::default());
    let mut largest = 0;
    for _ in 0..60 {
        let n = 2 + random.below(60);
        let h = operator(n, n, &mut random);
        let (q, mu) = (vectors(n, &mut random), (0..n).map(|i| 0.01 * i as f64).collect::<Vec<_>>());
        let sparse = sparse(n, &h);
        let dense = ContactProblem::new(Delassus::Dense(&h), &q, &mu).unwrap();
        let blocks = ContactProblem::new(Delassus::Blocks(&sparse), &q, &mu).unwrap();
        islands.find(&dense);
        for (island, members) in islands.iter().enumerate() {
            assert!(of_dense.take_island(&dense, &islands, island));
            assert!(of_sparse.take_island(&blocks, &islands, island));
            for own in [of_dense.problem(), of_sparse.problem()] {
                // What was taken is a problem: no check that a problem has to pass fails.
                assert!(ContactProblem::new(own.delassus(), own.q(), own.mu()).is_ok());
                assert_eq!(own.contacts(), members.len());
                for (a, &i) in members.iter().enumerate() {
                    assert_eq!((own.q()[a], own.mu()[a]), (q[i], mu[i]));
                    assert_eq!(own.diagonal(a), h[i * n + i]);
                    for (b, &j) in members.iter().enumerate() {
                        assert_eq!(own.block(a, b), Some(h[i * n + j]));
                    }
                }
            }
            largest = largest.max(members.len());
        }
    }
    assert!(largest > 16, "islands that are taken block-sparse are among them: {largest}");
    let h = [Matrix2::identity()];
    let product = Product(&h, 1);
    let (q, mu) = ([Vector2::zeros()], [0.0]);
    let operator = ContactProblem::new(Delassus::Operator(&product), &q, &mu).unwrap();
    islands.find(&operator);
    assert!(islands.len() == 1 && !of_dense.take_island(&operator, &islands, 0));
}

#[test]
fn an_owned_problem_refuses_what_a_borrowed_one_does() {
    let h = vec![Matrix2::identity(), Matrix2::zeros(), Matrix2::zeros(), Matrix2::identity()];
    let q = vec![Vector2::new(-1.0, 0.0); 2];
    let owned = OwnedProblem::dense(h.clone(), q.clone(), vec![0.1, 0.2]).unwrap();
    assert_eq!((owned.contacts(), owned.problem().mu()), (2, &[0.1, 0.2][..]));
    assert!(matches!(
        OwnedProblem::dense(h.clone(), q.clone(), vec![0.1, -0.2]),
        Err(ProblemError::NegativeFriction { contact: 1, .. })
    ));
    let sparse = sparse(2, &h);
    let owned = OwnedProblem::sparse(sparse.clone(), q.clone(), vec![0.1, 0.2]).unwrap();
    assert!(matches!(owned.problem().delassus(), Delassus::Blocks(_)));
    assert!(matches!(OwnedProblem::sparse(sparse, q, vec![0.1]), Err(ProblemError::Size { what: "mu", .. })));
    assert_eq!(OwnedProblem::<2>::default().problem().contacts(), 0);
    assert_eq!(judge(&OwnedProblem::<3>::default().problem(), &[]).global, 0.0);
}

#[test]
fn a_bad_number_of_a_block_is_found_in_its_row() {
    let n = 5;
    let mut h = operator(n, 12, &mut Random(5));
    let row = 3;
    h[row * n + row][(1, 0)] = f64::NAN;
    let sparse = sparse(n, &h);
    let (q, mu) = (vec![Vector2::zeros(); n], vec![0.3; n]);
    for delassus in [Delassus::Dense(&h), Delassus::Blocks(&sparse)] {
        let error = ContactProblem::new(delassus, &q, &mu).unwrap_err();
        assert!(error.to_string().contains("the Delassus operator of contact 3 is NaN"), "{error}");
    }
}
