//! Contact problems of a jammed pile of 300 polygons (`benches/pile`), with the last step's impulses as
//! the start. H is singular in tens of directions and nearly so in some more. Without pivots from a
//! near-solution `auto` ended at residuals of 2e-7 and 1e-9 after some 6000 iterations.

use nalgebra::{Matrix2, Vector2};
use teeter_contact::{BlockSparse, ContactSolver, OwnedProblem, Stop, judge};
use teeter_solvers::{Auto, Newton};

/// A problem and initial impulses from the text of a file in `jammed/`, whose first line describes it.
fn read(text: &str) -> (OwnedProblem<2>, Vec<Vector2<f64>>) {
    let mut lines = text.lines().skip(1).map(|line| line.split(' ').map(|x| x.parse::<f64>().unwrap()));
    let n = lines.next().unwrap().next().unwrap() as usize;
    let (mut mu, mut q, mut start, mut rows) = (Vec::new(), Vec::new(), Vec::new(), vec![Vec::new(); n]);
    for line in lines.by_ref().take(n) {
        let x: Vec<f64> = line.collect();
        mu.push(x[0]);
        q.push(Vector2::new(x[1], x[2]));
        start.push(Vector2::new(x[3], x[4]));
    }
    for line in lines {
        let x: Vec<f64> = line.collect();
        let (i, j, block) = (x[0] as usize, x[1] as usize, Matrix2::new(x[2], x[3], x[4], x[5]));
        rows[i].push((j, block));
        if i != j {
            rows[j].push((i, block.transpose()));
        }
    }
    for row in &mut rows {
        row.sort_by_key(|(j, _)| *j);
    }
    (OwnedProblem::sparse(BlockSparse::from_rows(&rows).unwrap(), q, mu).unwrap(), start)
}

#[test]
fn jammed_piles_are_solved_to_the_tolerance() {
    for text in [include_str!("jammed/pile-346.txt"), include_str!("jammed/pile-435.txt")] {
        let (owned, start) = read(text);
        let problem = owned.problem();
        let mut p = start.clone();
        let outcome = Auto::<2>::new().solve(&problem, &Stop::default(), &mut p);
        assert!(outcome.converged() && outcome.used == "crossover", "{outcome:?}");
        assert!(judge(&problem, &p).global <= 1e-10);
        // Otherwise the problem says nothing about pivots.
        let alone = Newton::<2>::new().solve(&problem, &Stop::default(), &mut start.clone());
        assert!(!alone.converged(), "{alone:?}");
    }
}

#[test]
fn a_solver_that_is_used_again_gives_the_same_impulses() {
    let (owned, start) = read(include_str!("jammed/pile-346.txt"));
    let mut solver = Auto::<2>::new();
    let mut solve = || {
        let mut p = start.clone();
        solver.solve(&owned.problem(), &Stop::default(), &mut p);
        p
    };
    assert_eq!(solve(), solve());
}
