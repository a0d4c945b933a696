//! A solver that is kept allocates nothing for problems no larger than those before, or than what
//! was reserved: proved by a counting allocator.

use crate::allocations::so_far;
use teeter_contact::conformance::{Case, body_on_floor, box_on_floor, plane_cases, space_cases};
use teeter_contact::{ContactSolver, Stop, Vector};
use teeter_solvers::{Enumeration, Lemke, Pgs};

fn allocations<const D: usize>(solver: &mut dyn ContactSolver<D>, cases: &[Case<D>]) -> u64 {
    let mut p: Vec<Vector<D>> = Vec::with_capacity(64);
    let mut count = 0;
    for case in cases {
        let problem = case.problem().unwrap();
        p.clear();
        p.resize(case.q.len(), Vector::zeros());
        let before = so_far();
        solver.solve(&problem, &Stop::default(), &mut p);
        count += so_far() - before;
    }
    count
}

fn many_feet() -> Vec<Case<2>> {
    let feet: Vec<(f64, f64)> = (0..12).map(|i| (0.1 * f64::from(i) - 0.5, -1.0)).collect();
    let mut cases = vec![body_on_floor("twelve feet", 0.3, &feet, [0.3, -1.0, 0.2], 0.4)];
    cases.extend(plane_cases());
    cases
}

#[test]
fn the_counter_counts() {
    let before = so_far();
    drop(std::hint::black_box(Box::new(1)));
    assert_eq!(so_far(), before + 1);
    assert!(allocations(&mut Pgs::<2>::new(), &many_feet()) > 0, "from nothing, memory has to come from somewhere");
}

#[test]
fn a_second_problem_of_the_same_size_allocates_nothing() {
    let plane = many_feet();
    for solver in [&mut Pgs::<2>::new() as &mut dyn ContactSolver<2>, &mut Lemke::new(), &mut Enumeration::new()] {
        allocations(solver, &plane[..1]);
        assert_eq!(allocations(solver, &plane), 0, "{}", solver.name());
    }
    let points: Vec<[f64; 3]> = (0..8).map(|i| [f64::from(i % 4), f64::from(i / 4), -1.0]).collect();
    let mut space = vec![box_on_floor("eight", [0.4, 0.5, 0.1], &points, [0.1, 0.2, -1.0, 0.0, 0.1, 0.3], 0.4)];
    space.extend(space_cases());
    let mut solver = Pgs::<3>::new();
    allocations(&mut solver, &space[..1]);
    assert_eq!(allocations(&mut solver, &space), 0);
}

#[test]
fn what_is_reserved_is_enough() {
    let plane = many_feet();
    for solver in [&mut Pgs::<2>::new() as &mut dyn ContactSolver<2>, &mut Lemke::new()] {
        solver.reserve(12, 144);
        assert_eq!(allocations(solver, &plane), 0, "{}", solver.name());
    }
    let mut solver = Pgs::<3>::new();
    solver.reserve(4, 16);
    assert_eq!(allocations(&mut solver, &space_cases()), 0);
}
