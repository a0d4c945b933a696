//! The projection, splitting and cone-program solvers on published problems; skipped where those
//! aren't at hand.

use crate::allocations::so_far;
use std::path::Path;
use teeter_contact::conformance::check_law;
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Delassus, Stop, Vector, judge};
use teeter_fclib::FclibProblem;
use teeter_solvers::{Apgd, ViEg, plane_solver, space_solver};

/// The problems that lie beside the repository, if they do.
fn read(name: &str) -> Option<FclibProblem> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/problems").join(name);
    if !path.exists() {
        eprintln!("skipped: {} isn't there", path.display());
        return None;
    }
    Some(teeter_fclib::read(path).unwrap())
}

fn solve_one<const D: usize>(
    name: &str,
    problem: &ContactProblem<'_, D>,
    solver: &mut dyn ContactSolver<D>,
    tolerance: f64,
) {
    let mut p = vec![Vector::<D>::zeros(); problem.contacts()];
    let stop = Stop::new(tolerance, 100_000);
    let outcome = solver.solve(problem, &stop, &mut p);
    assert!(outcome.converged() && judge(problem, &p).global <= tolerance, "{name}: {} {outcome:?}", solver.name());
    if tolerance <= 1e-8 {
        check_law(problem, &p, 1e3 * tolerance).unwrap_or_else(|e| panic!("{name}: {} {e}", solver.name()));
    }
}

/// Solves each of the named problems to a tolerance.
fn solve_all(plane: &mut dyn ContactSolver<2>, space: &mut dyn ContactSolver<3>, tolerance: f64, names: &[&str]) {
    for name in names {
        match read(name) {
            Some(FclibProblem::Plane(local)) => solve_one(name, &local.problem().unwrap(), plane, tolerance),
            Some(FclibProblem::Space(local)) => solve_one(name, &local.problem().unwrap(), space, tolerance),
            _ => return,
        }
    }
}

const EASY: &[&str] = &[
    "2d/FrictionContactProblem00031.hdf5",
    "2d/FrictionContactProblem00071.hdf5",
    "2d/FrictionContactProblem00374.hdf5",
    "2d/gfc2d_granularflowonwall_00069_00350.hdf5",
    "3d/Confeti-ex03-Fc3D-SBM.hdf5",
    "3d/Confeti-ex13-4contact-Fc3D-SBM.hdf5",
    "3d/FrictionContact3D_RR_1c.hdf5",
    "3d/LMGC_GlobalFrictionContactProblem00046-symM.hdf5",
    "3d/NESpheres_10_1.hdf5",
    "3d/Rover1041.hdf5",
    "3d/Rover4622.hdf5",
    "3d/Spheres-i099-356-679.hdf5",
];

const HYPERSTATIC: &[&str] = &[
    "3d/BoxesStack1-i100000-32.hdf5",
    "3d/KaplasTower-i1061-4.hdf5",
    "3d/LMGC_100_PR_PerioBox-i00361-60-03000.hdf5",
    "3d/OneObject-i100000-316.hdf5",
    "3d/OneObject-i1028-138.hdf5",
];

const PILES: &[&str] = &["3d/Capsules-i100-889.hdf5", "3d/Capsules-i101-404.hdf5", "3d/Capsules-i103-990.hdf5"];

#[test]
fn projections_solve_piles_and_stacks_roughly_and_easy_problems_well() {
    solve_all(&mut ViEg::new(), &mut ViEg::new(), 1e-4, PILES);
    solve_all(&mut ViEg::new(), &mut ViEg::new(), 1e-4, HYPERSTATIC);
    solve_all(&mut ViEg::new(), &mut ViEg::new(), 1e-8, EASY);
}

#[test]
fn accelerated_gradients_solve_piles_and_stacks() {
    solve_all(&mut Apgd::new(), &mut Apgd::new(), 1e-4, PILES);
    solve_all(&mut Apgd::new(), &mut Apgd::new(), 1e-8, HYPERSTATIC);
    solve_all(&mut Apgd::new(), &mut Apgd::new(), 1e-8, EASY);
}

#[cfg(feature = "sparse")]
#[test]
fn alternating_directions_solve_hyperstatic_problems_to_rounding() {
    use teeter_solvers::Admm;
    solve_all(&mut Admm::new(), &mut Admm::new(), 1e-4, PILES);
    solve_all(&mut Admm::new(), &mut Admm::new(), 1e-12, HYPERSTATIC);
    solve_all(&mut Admm::new(), &mut Admm::new(), 1e-12, EASY);
    // Strongly asymmetric, from a file that holds half a matrix: the skew part lags, and it
    // converges all the same.
    solve_all(&mut Admm::new(), &mut Admm::new(), 1e-12, &["3d/LMGC_GlobalFrictionContactProblem00046.hdf5"]);
}

#[cfg(feature = "sparse")]
#[test]
fn a_tower_takes_few_factorisations() {
    let Some(FclibProblem::Space(local)) = read("3d/KaplasTower-i1061-4.hdf5") else { return };
    let mut solver = teeter_solvers::Admm::new();
    solve_one("tower", &local.problem().unwrap(), &mut solver, 1e-8);
    assert!(solver.factorisations() <= 4, "{}", solver.factorisations());
}

#[cfg(feature = "clarabel")]
#[test]
fn cone_programs_with_a_shift_give_the_exact_law() {
    use teeter_solvers::AcaryCadoux;
    solve_all(&mut AcaryCadoux::new(), &mut AcaryCadoux::new(), 1e-10, &EASY[..11]);
}

/// The problem in other units, all powers of two so that nothing is rounded.
fn in_other_units<const D: usize>(
    h: &BlockSparse<D>,
    q: &[Vector<D>],
    mass: f64,
    speed: f64,
) -> (BlockSparse<D>, Vec<Vector<D>>) {
    let rows: Vec<Vec<_>> = (0..h.contacts()).map(|i| h.row(i).map(|(j, block)| (j, block / mass)).collect()).collect();
    (BlockSparse::from_rows(&rows).unwrap(), q.iter().map(|q| q * speed).collect())
}

#[test]
fn units_of_mass_and_speed_change_nothing() {
    let Some(FclibProblem::Space(local)) = read("3d/Confeti-ex03-Fc3D-SBM.hdf5") else { return };
    let (mass, speed) = (1024.0, 1.0 / 4096.0);
    let (h, q) = in_other_units(&local.h, &local.q, mass, speed);
    let other = ContactProblem::new(Delassus::Blocks(&h), &q, &local.mu).unwrap();
    let mut solvers: Vec<Box<dyn ContactSolver<3>>> = vec![Box::new(ViEg::new()), Box::new(Apgd::new())];
    #[cfg(feature = "sparse")]
    solvers.push(Box::new(teeter_solvers::Admm::new()));
    #[cfg(feature = "clarabel")]
    solvers.push(Box::new(teeter_solvers::AcaryCadoux::new()));
    for solver in &mut solvers {
        let mut p = vec![Vector::<3>::zeros(); q.len()];
        let mut r = p.clone();
        let one = solver.solve(&local.problem().unwrap(), &Stop::default(), &mut p);
        let two = solver.solve(&other, &Stop::default(), &mut r);
        assert_eq!((one.status, one.iterations), (two.status, two.iterations), "{}", solver.name());
        for (p, r) in p.iter().zip(&r) {
            assert_eq!(p * (mass * speed), *r, "{}", solver.name());
        }
    }
}

#[test]
fn a_solver_kept_over_steps_allocates_nothing() {
    let Some(FclibProblem::Space(local)) = read("3d/Capsules-i100-889.hdf5") else { return };
    let problem = local.problem().unwrap();
    let mut solvers: Vec<Box<dyn ContactSolver<3>>> = vec![Box::new(ViEg::new()), Box::new(Apgd::new())];
    #[cfg(feature = "sparse")]
    solvers.push(Box::new(teeter_solvers::Admm::new()));
    for solver in &mut solvers {
        let stop = Stop::default().with_tolerance(1e-4);
        let mut p = vec![Vector::<3>::zeros(); problem.contacts()];
        assert!(solver.solve(&problem, &stop, &mut p).converged());
        p.fill(Vector::zeros());
        let before = so_far();
        let outcome = solver.solve(&problem, &stop, &mut p);
        assert_eq!(so_far() - before, 0, "{}", solver.name());
        assert!(outcome.converged() && outcome.iterations > 5);
    }
}

/// The problems that any of Siconos' solvers solves to a tolerance, by the results that lie with
/// them.
fn solved_by_siconos(tolerance: &str) -> Vec<String> {
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/problems/siconos_baseline.csv");
    let Ok(text) = std::fs::read_to_string(&table) else {
        eprintln!("skipped: {} isn't there", table.display());
        return Vec::new();
    };
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let at = |name: &str| header.iter().position(|column| *column == name).unwrap();
    let (file, of, solved) = (at("file"), at("tolerance"), at("solved"));
    let rows = lines.map(|line| line.split(',').collect::<Vec<_>>());
    let mut names: Vec<String> =
        rows.filter(|row| row[of] == tolerance && row[solved] == "1").map(|row| row[file].to_owned()).collect();
    names.sort();
    names.dedup();
    names
}

/// With the default iterations, and with the law checked contact by contact on what is solved
/// tightly.
#[test]
fn auto_solves_what_any_siconos_solver_solves() {
    let (mut plane, mut space) = (plane_solver("auto").unwrap(), space_solver("auto").unwrap());
    for (written, tolerance) in [("1e-04", 1e-4), ("1e-08", 1e-8), ("1e-12", 1e-12)] {
        for name in solved_by_siconos(written) {
            let stop = Stop::default().with_tolerance(tolerance);
            let outcome = match read(&name) {
                Some(FclibProblem::Plane(local)) => {
                    let mut p = vec![Vector::zeros(); local.q.len()];
                    plane.solve(&local.problem().unwrap(), &stop, &mut p)
                }
                Some(FclibProblem::Space(local)) => {
                    let mut p = vec![Vector::zeros(); local.q.len()];
                    space.solve(&local.problem().unwrap(), &stop, &mut p)
                }
                _ => continue,
            };
            assert!(outcome.converged(), "{name} at {written}: {outcome:?}");
        }
    }
}

/// Nobody is known to have solved these as tightly.
#[test]
fn auto_solves_some_that_none_of_siconos_solvers_does() {
    let mut plane = plane_solver("auto").unwrap();
    let mut space = space_solver("auto").unwrap();
    for (name, tolerance) in [
        ("2d/fc2d_granularflowonwall_02020_00213.hdf5", 1e-12),
        ("2d/fc2d_granularflowonwall_07002_00801.hdf5", 1e-12),
        ("3d/RockPile_tob1.hdf5", 1e-12),
        ("3d/spheres-in-a-box-98-i10000-256-10.hdf5", 1e-12),
    ] {
        solve_all(plane.as_mut(), space.as_mut(), tolerance, &[name]);
    }
}
