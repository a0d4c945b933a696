//! Patterns and islands against what can be seen without lists and union-find.

use crate::random::{Random, operator, vectors};
use nalgebra::Matrix2;
use std::collections::BTreeSet;
use teeter_contact::{Block, BlockSparse, BlockSparseError, ContactProblem, Delassus, Incidence, Islands};

/// The islands by Warshall's closure of a relation, each an ascending list, in the order of their first contacts.
fn islands_of(n: usize, coupled: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut reach: Vec<Vec<bool>> =
        (0..n).map(|i| (0..n).map(|j| i == j || coupled(i, j) || coupled(j, i)).collect()).collect();
    for k in 0..n {
        for i in 0..n {
            for j in 0..n {
                reach[i][j] |= reach[i][k] && reach[k][j];
            }
        }
    }
    let mut found: Vec<Vec<usize>> = Vec::new();
    for row in &reach {
        let island: Vec<usize> = (0..n).filter(|&j| row[j]).collect();
        if !found.contains(&island) {
            found.push(island);
        }
    }
    found
}

/// The islands as found, after a check that all that is said of them agrees.
fn listed(islands: &Islands) -> Vec<Vec<usize>> {
    assert_eq!(islands.is_empty(), islands.contacts() == 0);
    assert_eq!(islands.iter().len(), islands.len());
    for (island, members) in islands.iter().enumerate() {
        assert_eq!(islands.members(island), members);
        for (place, &contact) in members.iter().enumerate() {
            assert_eq!((islands.island_of(contact), islands.place_of(contact)), (island, place));
        }
    }
    islands.iter().map(<[usize]>::to_vec).collect()
}

/// All places with a block of a row, the zero ones too for every third: stored zeros must join nothing.
fn sparse(n: usize, h: &[Block<2>], zeros: bool) -> BlockSparse<2> {
    let stored =
        |i: usize, j: usize| i == j || h[i * n + j] != Matrix2::zeros() || (zeros && (i + j).is_multiple_of(3));
    let row = |i: usize| (0..n).filter(move |&j| stored(i, j)).map(move |j| (j, h[i * n + j]));
    let mut sparse = BlockSparse::default();
    sparse.set_rows(n, row).unwrap();
    sparse
}

#[test]
fn islands_are_the_connected_components_whatever_the_storage() {
    let mut random = Random(7);
    let mut islands = Islands::default();
    let mut counts = BTreeSet::new();
    for _ in 0..400 {
        let n = 1 + random.below(24);
        let coupled = random.below(2 * n);
        let h = operator(n, coupled, &mut random);
        let expected = islands_of(n, |i, j| h[i * n + j] != Matrix2::zeros());
        let (q, mu) = (vectors(n, &mut random), vec![0.3; n]);
        islands.find(&ContactProblem::new(Delassus::Dense(&h), &q, &mu).unwrap());
        assert_eq!(listed(&islands), expected);
        assert_eq!(islands.contacts(), n);
        for zeros in [false, true] {
            let sparse = sparse(n, &h, zeros);
            islands.find(&ContactProblem::new(Delassus::Blocks(&sparse), &q, &mu).unwrap());
            assert_eq!(listed(&islands), expected);
        }
        counts.insert(expected.len());
    }
    assert!(counts.len() > 10, "problems of few and of many islands: {counts:?}");
}

#[test]
fn what_shares_keys_has_blocks_and_is_one_island() {
    let mut random = Random(99);
    let (mut incidence, mut islands) = (Incidence::default(), Islands::default());
    let mut h = BlockSparse::<2>::default();
    for _ in 0..400 {
        let (n, keys) = (1 + random.below(24), 1 + random.below(40));
        // Contacts of the ground touch nothing, and some name a key twice.
        let touched: Vec<Vec<usize>> =
            (0..n).map(|_| (0..random.below(4)).map(|_| random.below(keys)).collect()).collect();
        let share = |i: usize, j: usize| i == j || touched[i].iter().any(|key| touched[j].contains(key));
        incidence.load(n, |i| touched[i].iter().copied());
        h.set_pattern(&incidence);
        assert_eq!(h.contacts(), n);
        for i in 0..n {
            assert!(h.row(i).map(|(j, _)| j).eq((0..n).filter(|&j| share(i, j))), "row {i}");
            assert_eq!(h.diagonal(i), Matrix2::zeros());
            let own = Matrix2::repeat(1.0 + i as f64);
            h.add(i, i, &own).unwrap();
            assert_eq!(h.diagonal(i), own);
        }
        islands.find_shared(&incidence);
        assert_eq!(listed(&islands), islands_of(n, share));
    }
}

#[test]
fn blocks_are_added_where_the_pattern_has_them() {
    let touched = [vec![0, 1], vec![5], vec![1, 4], vec![]];
    let mut incidence = Incidence::default();
    incidence.load(4, |i| touched[i].iter().copied());
    let mut h = BlockSparse::default();
    h.set_pattern(&incidence);
    for _ in 0..2 {
        h.zero();
        for i in 0..4 {
            for j in 0..4 {
                let block = Matrix2::repeat((10 * i + j) as f64);
                match h.add(i, j, &block).and_then(|()| h.add(i, j, &block)) {
                    Ok(()) => assert_eq!(h.block(i, j), Some(&(block * 2.0))),
                    Err(error) => {
                        assert_eq!(error, BlockSparseError::NotInPattern { row: i, column: j });
                        assert!(h.block(i, j).is_none() && h.block_mut(i, j).is_none());
                        assert!(i != j && [i, j] != [0, 2] && [i, j] != [2, 0]);
                    }
                }
            }
        }
        assert_eq!(h.blocks().len(), 6);
        assert_eq!(h.diagonal(2), Matrix2::repeat(44.0));
        assert_eq!(h.block_mut(0, 2).copied(), Some(Matrix2::repeat(4.0)));
    }
    assert!(h.add(4, 0, &Matrix2::zeros()).is_err());
}

#[test]
fn rows_that_make_no_matrix_are_refused() {
    let one = Matrix2::<f64>::identity();
    let error = |rows: &[Vec<usize>]| {
        let mut h = BlockSparse::default();
        let error = h.set_rows(rows.len(), |i| rows[i].iter().map(move |&j| (j, one))).unwrap_err();
        assert_eq!(h, BlockSparse::default());
        error
    };
    assert_eq!(error(&[vec![0, 2], vec![1]]), BlockSparseError::ColumnOutOfRange { row: 0, column: 2, contacts: 2 });
    assert_eq!(error(&[vec![0], vec![1, 1]]), BlockSparseError::ColumnsNotAscending { row: 1 });
    assert_eq!(error(&[vec![0], vec![1, 0]]), BlockSparseError::ColumnsNotAscending { row: 1 });
    assert_eq!(error(&[vec![0, 1], vec![0]]), BlockSparseError::MissingDiagonal { row: 1 });
}
