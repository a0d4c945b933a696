//! Random problems of several contacts, in the plane and in space: the law contact by contact,
//! units, order, solvers that agree, starts that are no numbers.

use proptest::prelude::*;
use teeter_contact::conformance::{Case, check_law};
use teeter_contact::{
    Block, BlockSparse, ContactProblem, ContactSolver, Delassus, DelassusOperator, Status, Stop, Vector, judge,
};
use teeter_solvers::{Enumeration, Lemke, Pgs};

/// H = J Jᵀ, J of D n rows and `m` columns: singular where m < D n. `lift` on the diagonal.
fn problem<const D: usize>(n: usize, m: usize, rows: &[f64], v: &[f64], mu: &[f64], lift: f64) -> Case<D> {
    let row = |i: usize, a: usize| &rows[(D * i + a) * m..(D * i + a + 1) * m];
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let mut h = Vec::new();
    for i in 0..n {
        for j in 0..n {
            h.push(Block::<D>::from_fn(|a, b| dot(row(i, a), row(j, b)) + if i == j && a == b { lift } else { 0.0 }));
        }
    }
    let q = (0..n).map(|i| Vector::<D>::from_fn(|a, _| dot(row(i, a), v))).collect();
    Case { name: "random", h, q, mu: mu[..n].to_vec() }
}

fn cases<const D: usize>(most: usize, mu: f64, lift: f64) -> impl Strategy<Value = Case<D>> {
    (1..=most).prop_flat_map(move |n| {
        let m = D * n + 1;
        (
            prop::collection::vec(-1.0..1.0f64, D * n * m),
            prop::collection::vec(-1.0..1.0f64, m),
            prop::collection::vec(prop_oneof![Just(0.0), 0.0..mu], n),
        )
            .prop_map(move |(rows, v, mu)| problem(n, m, &rows, &v, &mu, lift))
    })
}

fn solve<const D: usize>(
    solver: &mut dyn ContactSolver<D>,
    case: &Case<D>,
    tolerance: f64,
) -> (Status, u32, Vec<Vector<D>>) {
    let mut p = vec![Vector::<D>::zeros(); case.q.len()];
    let problem = case.problem().unwrap();
    let outcome = solver.solve(&problem, &Stop::default().with_tolerance(tolerance), &mut p);
    let residual = judge(&problem, &p).global;
    assert_eq!(outcome.converged(), residual <= tolerance, "{outcome:?} {residual:e}");
    (outcome.status, outcome.iterations, p)
}

/// Lengths and masses in other units: H by 1/mass, q by speed. Powers of two, so that rounding is
/// the same and all that can differ is a threshold that has a unit.
pub(crate) fn in_other_units<const D: usize>(case: &Case<D>, mass: f64, speed: f64) -> Case<D> {
    Case {
        name: case.name,
        h: case.h.iter().map(|h| h / mass).collect(),
        q: case.q.iter().map(|q| q * speed).collect(),
        mu: case.mu.clone(),
    }
}

/// The contacts in another order: contact k of the result is contact k + 1 of the case.
pub(crate) fn turned<const D: usize>(case: &Case<D>) -> Case<D> {
    let n = case.q.len();
    let at = |k: usize| (k + 1) % n;
    Case {
        name: case.name,
        h: (0..n * n).map(|k| case.h[at(k / n) * n + at(k % n)]).collect(),
        q: (0..n).map(|i| case.q[at(i)]).collect(),
        mu: (0..n).map(|i| case.mu[at(i)]).collect(),
    }
}

fn velocity_difference<const D: usize>(case: &Case<D>, p: &[Vector<D>], r: &[Vector<D>]) -> f64 {
    let problem = case.problem().unwrap();
    let size = case.q.iter().map(Vector::norm).fold(1e-300, f64::max);
    (0..p.len()).map(|i| (problem.velocity(i, p) - problem.velocity(i, r)).norm()).fold(0.0, f64::max) / size
}

/// The product only.
struct Product<'a, const D: usize>(&'a Case<D>);

impl<const D: usize> DelassusOperator<D> for Product<'_, D> {
    fn contacts(&self) -> usize {
        self.0.q.len()
    }

    fn diagonal(&self, i: usize) -> Block<D> {
        self.0.h[i * self.contacts() + i]
    }

    fn row_product(&self, i: usize, p: &[Vector<D>]) -> Vector<D> {
        (0..p.len()).fold(Vector::zeros(), |sum, j| sum + self.0.h[i * p.len() + j] * p[j])
    }
}

fn same_for_every_shape<const D: usize>(case: &Case<D>) {
    let n = case.q.len();
    let (_, iterations, p) = solve(&mut Pgs::<D>::new(), case, 1e-10);
    let rows: Vec<Vec<_>> = (0..n).map(|i| (0..n).map(|j| (j, case.h[i * n + j])).collect()).collect();
    let sparse = BlockSparse::from_rows(&rows).unwrap();
    let product = Product(case);
    for (shape, slack) in [(Delassus::Blocks(&sparse), 0.0), (Delassus::Operator(&product), 1e-7)] {
        let problem = ContactProblem::new(shape, &case.q, &case.mu).unwrap();
        let mut r = vec![Vector::<D>::zeros(); n];
        let outcome = Pgs::<D>::new().solve(&problem, &Stop::default(), &mut r);
        if outcome.converged() {
            assert!(velocity_difference(case, &p, &r) <= slack);
            assert!(slack > 0.0 || outcome.iterations == iterations);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn pgs_in_space_obeys_the_law(case in cases::<3>(8, 0.8, 0.05)) {
        let (status, _, p) = solve(&mut Pgs::new(), &case, 1e-10);
        if status == Status::Converged {
            prop_assert_eq!(check_law(&case.problem().unwrap(), &p, 1e-6), Ok(()));
        }
    }

    #[test]
    fn a_single_contact_in_space_is_solved_at_once(case in cases::<3>(1, 3.0, 0.05)) {
        let (status, sweeps, p) = solve(&mut Pgs::new(), &case, 1e-11);
        // What has H_NN > μ‖H_NT‖ has a solution, and the local solver finds it without a second
        // visit.
        let h = case.h[0];
        if h[(0, 0)] > case.mu[0] * h[(0, 1)].hypot(h[(0, 2)]) {
            prop_assert!(status == Status::Converged && sweeps <= 1, "{:?} {}", status, sweeps);
            prop_assert_eq!(check_law(&case.problem().unwrap(), &p, 1e-8), Ok(()));
        }
    }

    #[test]
    fn units_change_nothing(
        plane in cases::<2>(6, 0.6, 0.05), space in cases::<3>(6, 0.6, 0.05), mass in -30i32..30, speed in -30i32..30,
    ) {
        fn same<const D: usize>(solver: &mut dyn ContactSolver<D>, case: &Case<D>, mass: f64, speed: f64) {
            let (status, iterations, p) = solve(solver, case, 1e-10);
            let (again, count, r) = solve(solver, &in_other_units(case, mass, speed), 1e-10);
            assert_eq!((status, iterations), (again, count), "{}", solver.name());
            let impulse = mass * speed;
            let size = p.iter().map(Vector::norm).fold(1e-300, f64::max);
            assert!(p.iter().zip(&r).all(|(p, r)| (p - r / impulse).norm() <= 1e-9 * size), "{}", solver.name());
        }
        let (mass, speed) = (f64::from(mass).exp2(), f64::from(speed).exp2());
        same(&mut Pgs::<2>::new(), &plane, mass, speed);
        same(&mut Pgs::<3>::new(), &space, mass, speed);
        same(&mut Lemke::new(), &plane, mass, speed);
        if plane.q.len() <= 3 {
            same(&mut Enumeration::new(), &plane, mass, speed);
        }
    }

    #[test]
    fn the_order_of_contacts_leaves_velocities_alone(plane in cases::<2>(6, 0.1, 0.3), space in cases::<3>(6, 0.1, 0.3)) {
        fn check<const D: usize>(solver: &mut dyn ContactSolver<D>, case: &Case<D>) {
            let n = case.q.len();
            let (status, _, p) = solve(solver, case, 1e-11);
            let (again, _, r) = solve(solver, &turned(case), 1e-11);
            if status == Status::Converged && again == Status::Converged {
                let mut back = p.clone();
                (0..n).for_each(|i| back[(i + 1) % n] = r[i]);
                let difference = velocity_difference(case, &p, &back);
                assert!(difference < 1e-7, "{}: {difference:e}", solver.name());
            }
        }
        check(&mut Pgs::<2>::new(), &plane);
        check(&mut Lemke::new(), &plane);
        check(&mut Pgs::<3>::new(), &space);
    }

    #[test]
    fn pivoting_obeys_the_law_and_agrees_with_sweeps(case in cases::<2>(10, 0.1, 0.3)) {
        let (status, _, p) = solve(&mut Lemke::new(), &case, 1e-11);
        prop_assert_eq!(status, Status::Converged);
        prop_assert_eq!(check_law(&case.problem().unwrap(), &p, 1e-8), Ok(()));
        let (swept, _, r) = solve(&mut Pgs::new(), &case, 1e-11);
        if swept == Status::Converged {
            prop_assert!(velocity_difference(&case, &p, &r) < 1e-8);
        }
    }

    #[test]
    fn every_shape_of_the_operator_gives_the_same(plane in cases::<2>(6, 0.3, 0.3), space in cases::<3>(6, 0.3, 0.3)) {
        same_for_every_shape(&plane);
        same_for_every_shape(&space);
    }

    #[test]
    fn matrices_of_any_kind_end_honestly(
        entries in prop::collection::vec(-1.0..1.0f64, 9 * 9), q in prop::collection::vec(-1.0..1.0f64, 9),
        mu in prop::collection::vec(prop_oneof![Just(0.0), 0.0..2.0f64, Just(1e6)], 3),
    ) {
        // Neither symmetric nor definite, but for a diagonal that pushes back nowhere; `solve`
        // checks that converged is what the judge says.
        let mut space = Case::<3> { name: "any", h: vec![], q: vec![], mu: mu.clone() };
        let mut plane = Case::<2> { name: "any", h: vec![], q: vec![], mu };
        for i in 0..3 {
            space.q.push(Vector::<3>::from_fn(|a, _| q[3 * i + a]));
            plane.q.push(Vector::<2>::from_fn(|a, _| q[3 * i + a]));
            for j in 0..3 {
                let entry = |a: usize, b: usize| {
                    let x = entries[(3 * i + a) * 9 + 3 * j + b];
                    if i == j && a == b { x.abs() + 1e-3 } else { x }
                };
                space.h.push(Block::<3>::from_fn(entry));
                plane.h.push(Block::<2>::from_fn(entry));
            }
        }
        solve(&mut Pgs::<3>::new(), &space, 1e-10);
        solve(&mut Pgs::<2>::new(), &plane, 1e-10);
        solve(&mut Lemke::new(), &plane, 1e-10);
        solve(&mut Enumeration::new(), &plane, 1e-10);
    }
}

#[test]
fn a_start_of_nonsense_does_no_harm() {
    let case =
        teeter_contact::conformance::body_on_floor("feet", 0.3, &[(-0.5, -1.0), (0.5, -1.0)], [0.3, -1.0, 0.2], 0.5);
    let problem = case.problem().unwrap();
    for x in [f64::NAN, f64::INFINITY, -1e300] {
        for solver in [&mut Pgs::<2>::new() as &mut dyn ContactSolver<2>, &mut Lemke::new(), &mut Enumeration::new()] {
            let mut p = vec![Vector::<2>::new(x, x); 2];
            let outcome = solver.solve(&problem, &Stop::default(), &mut p);
            assert!(outcome.converged(), "{} from {x}: {outcome:?}", solver.name());
        }
    }
}

#[test]
fn no_contact_is_no_problem() {
    let problem = ContactProblem::new(Delassus::Dense(&[]), &[], &[]).unwrap();
    assert!(Pgs::<2>::new().solve(&problem, &Stop::default(), &mut []).converged());
    assert!(Lemke::new().solve(&problem, &Stop::default(), &mut []).converged());
    assert!(Enumeration::new().solve(&problem, &Stop::default(), &mut []).converged());
    let problem = ContactProblem::<3>::new(Delassus::Dense(&[]), &[], &[]).unwrap();
    assert!(Pgs::<3>::new().solve(&problem, &Stop::default(), &mut []).converged());
}
