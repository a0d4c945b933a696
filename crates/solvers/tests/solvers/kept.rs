//! A solver that is kept over steps allocates nothing for a problem of a size that it has met.

use crate::allocations::so_far;
use teeter_contact::conformance::{Case, body_on_floor, box_on_floor};
use teeter_contact::{ContactSolver, Stop, Vector};
use teeter_solvers::{SOLVERS, plane_solver, space_solver};

/// Clarabel builds its own problem at each update: the exception that those solvers' pages name.
const ALLOCATING: [&str; 2] = ["socp", "acary-cadoux"];

fn plane(feet: usize, slide: f64) -> Case<2> {
    let points: Vec<_> = (0..feet).map(|k| (k as f64 / feet as f64 - 0.5, -1.0)).collect();
    body_on_floor("feet", 0.3, &points, [slide, -1.0, 0.2], 0.4)
}

fn space(corners: usize, slide: f64) -> Case<3> {
    let angle = |k: usize| k as f64 * 2.4;
    let points: Vec<_> = (0..corners).map(|k| [angle(k).cos(), angle(k).sin(), -1.0]).collect();
    box_on_floor("corners", [0.4, 0.5, 0.6], &points, [slide, 0.2, -1.0, 0.1, 0.2, 0.3], 0.4)
}

/// Solves the first case, then all of them, and counts what the latter allocate.
fn allocations<const D: usize>(solver: &mut dyn ContactSolver<D>, cases: &[Case<D>]) -> u64 {
    let largest = cases.iter().map(|case| case.q.len()).max().unwrap();
    let mut p = vec![Vector::<D>::zeros(); largest];
    let mut count = 0;
    for (k, case) in cases.iter().enumerate() {
        let problem = case.problem().unwrap();
        let p = &mut p[..case.q.len()];
        p.fill(Vector::zeros());
        let before = so_far();
        solver.solve(&problem, &Stop::new(1e-9, 2000), p);
        if k > 0 {
            count += so_far() - before;
        }
    }
    count
}

#[test]
fn at_equal_size_no_solver_allocates() {
    for info in SOLVERS.iter().filter(|info| !ALLOCATING.contains(&info.name)) {
        if let Some(mut solver) = plane_solver(info.name) {
            let feet = if info.name == "enumeration" { 3 } else { 6 };
            let cases: Vec<_> = [0.3, 2.0, -0.1].map(|slide| plane(feet, slide)).to_vec();
            assert_eq!(allocations(solver.as_mut(), &cases), 0, "{}", info.name);
        }
        if let Some(mut solver) = space_solver(info.name) {
            let cases: Vec<_> = [0.3, 2.0, -0.1].map(|slide| space(6, slide)).to_vec();
            assert_eq!(allocations(solver.as_mut(), &cases), 0, "{}", info.name);
        }
    }
}

#[test]
fn auto_with_room_made_allocates_nothing_as_contacts_come_and_go() {
    let mut solver = plane_solver("auto").unwrap();
    assert!(allocations(solver.fork().as_mut(), &[plane(4, 0.3), plane(12, 0.3)]) > 0, "the count counts");
    solver.reserve(12, 144);
    let sizes = [12, 4, 7, 2, 12, 9, 5];
    let cases: Vec<_> = sizes.iter().map(|&feet| plane(feet, 0.3 + 0.1 * feet as f64)).collect();
    assert_eq!(allocations(solver.as_mut(), &cases), 0);
}
