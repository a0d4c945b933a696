//! Problems of many islands: dense and block-sparse are solved alike, and memory grows with the
//! contacts, not with their square.

use crate::allocations::{bytes_so_far, so_far};
use proptest::prelude::*;
use teeter_contact::conformance::{Case, body_on_floor, box_on_floor, check_law};
use teeter_contact::{
    BlockSparse, ContactProblem, ContactSolver, Delassus, Incidence, Islands, Outcome, Stop, Vector, judge,
};
use teeter_solvers::{Auto, SOLVERS, plane_solver, space_solver};

/// The problem of several bodies that stand apart, its contacts in any order: contact k of the
/// result is `order[k]` of those in a row.
fn together<const D: usize>(bodies: &[Case<D>], order: &[usize]) -> Case<D> {
    let n = order.len();
    let of: Vec<(usize, usize)> =
        bodies.iter().enumerate().flat_map(|(b, body)| (0..body.q.len()).map(move |k| (b, k))).collect();
    let mut whole = Case { name: "apart", h: Vec::new(), q: Vec::new(), mu: Vec::new() };
    for &i in order {
        let (a, row) = of[i];
        whole.q.push(bodies[a].q[row]);
        whole.mu.push(bodies[a].mu[row]);
        for &j in order {
            let (b, column) = of[j];
            let zero = nalgebra::SMatrix::zeros();
            whole.h.push(if a == b { bodies[a].h[row * bodies[a].q.len() + column] } else { zero });
        }
    }
    assert_eq!(whole.h.len(), n * n);
    whole
}

/// The same operator block-sparse, some of its zero blocks stored.
fn sparse<const D: usize>(case: &Case<D>) -> BlockSparse<D> {
    let n = case.q.len();
    let stored =
        |i: usize, j: usize| i == j || (i + 2 * j).is_multiple_of(7) || case.h[i * n + j].iter().any(|&x| x != 0.0);
    let mut h = BlockSparse::default();
    h.set_rows(n, |i| (0..n).filter(move |&j| stored(i, j)).map(move |j| (j, case.h[i * n + j]))).unwrap();
    h
}

fn solve<const D: usize>(problem: &ContactProblem<'_, D>) -> (Outcome, Vec<Vector<D>>)
where
    Auto<D>: ContactSolver<D>,
{
    let mut p = vec![Vector::zeros(); problem.contacts()];
    let outcome = Auto::new().solve(problem, &Stop::default(), &mut p);
    // As in `conformance::run`: methods of a chain judge by velocities that they have summed
    // themselves.
    let judged = judge(problem, &p).global;
    assert!((outcome.residual.global - judged).abs() <= 1e-3 * judged + 1e-16, "{outcome:?} {judged:e}");
    (outcome, p)
}

/// Outcomes and impulses of both storages.
type Both<const D: usize> = [(Outcome, Vec<Vector<D>>); 2];

fn both<const D: usize>(case: &Case<D>) -> Both<D>
where
    Auto<D>: ContactSolver<D>,
{
    let h = sparse(case);
    let blocks = ContactProblem::new(Delassus::Blocks(&h), &case.q, &case.mu).unwrap();
    [solve(&case.problem().unwrap()), solve(&blocks)]
}

fn feet(count: usize, velocity: [f64; 3], mu: f64) -> Case<2> {
    let points: Vec<_> = (0..count).map(|k| (k as f64 / count as f64 - 0.4, -1.0)).collect();
    body_on_floor("feet", 0.3, &points, velocity, mu)
}

/// Bodies of up to `most` feet, and an order of their contacts.
fn crowds(most: usize) -> impl Strategy<Value = (Vec<Case<2>>, Vec<usize>)> {
    let body = (1..=most, prop::array::uniform3(-1.0..1.0f64), prop_oneof![Just(0.0), 0.0..0.8f64])
        .prop_map(|(count, velocity, mu)| feet(count, velocity, mu));
    prop::collection::vec(body, 1..6).prop_flat_map(|bodies| {
        let contacts: usize = bodies.iter().map(|body| body.q.len()).sum();
        (Just(bodies), Just((0..contacts).collect::<Vec<_>>()).prop_shuffle())
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn small_islands_are_solved_to_the_byte_as_in_a_dense_problem((bodies, order) in crowds(3)) {
        let [dense, sparse] = both(&together(&bodies, &order));
        // Also the residual, the method named, and the counts.
        prop_assert_eq!(dense, sparse);
    }

    #[test]
    fn islands_of_any_size_obey_the_law((bodies, order) in crowds(24)) {
        let case = together(&bodies, &order);
        for (outcome, p) in both(&case) {
            prop_assert!(outcome.converged(), "{:?}", outcome);
            prop_assert_eq!(check_law(&case.problem().unwrap(), &p, 1e-7), Ok(()));
        }
    }
}

#[test]
fn islands_in_space_obey_the_law() {
    let corners = [[-0.5, -0.3, -1.0], [0.5, -0.3, -1.0], [0.5, 0.3, -1.0], [-0.5, 0.3, -1.0]];
    let body = |count: usize, slide: f64| {
        box_on_floor("box", [0.4, 0.5, 0.1], &corners[..count], [slide, 0.2, -1.0, 0.1, 0.0, 0.3], 0.4)
    };
    let bodies = [body(4, 0.1), body(1, 2.0), body(3, -0.2), body(4, 3.0), body(2, 0.0)];
    let order: Vec<usize> = (0..14).map(|k| k * 5 % 14).collect();
    let case = together(&bodies, &order);
    for (outcome, p) in both(&case) {
        assert!(outcome.converged(), "{outcome:?}");
        assert_eq!(check_law(&case.problem().unwrap(), &p, 1e-7), Ok(()));
    }
}

/// A row of blocks that stand apart on two corners each, posed as an integrator does: the pattern
/// from the bodies that contacts touch, then the blocks.
struct Row {
    incidence: Incidence,
    h: BlockSparse<2>,
    q: Vec<Vector<2>>,
    mu: Vec<f64>,
    auto: Auto<2>,
    islands: Islands,
    p: Vec<Vector<2>>,
}

impl Row {
    fn new() -> Self {
        let (incidence, h, islands) = (Incidence::default(), BlockSparse::default(), Islands::default());
        Self { incidence, h, q: Vec::new(), mu: Vec::new(), auto: Auto::new(), islands, p: Vec::new() }
    }

    /// Poses and solves the problem of `bodies` bodies.
    fn solve(&mut self, bodies: usize, block: &Case<2>) -> Outcome {
        let n = 2 * bodies;
        self.incidence.load(n, |contact| (3 * (contact / 2)..).take(3));
        self.h.set_pattern(&self.incidence);
        for i in 0..n {
            for j in [i - i % 2, i - i % 2 + 1] {
                self.h.add(i, j, &block.h[i % 2 * 2 + j % 2]).unwrap();
            }
        }
        self.q.clear();
        self.q.extend((0..n).map(|i| block.q[i % 2]));
        self.mu.clear();
        self.mu.resize(n, block.mu[0]);
        self.islands.find_shared(&self.incidence);
        assert_eq!((self.islands.len(), self.h.blocks().len()), (bodies, 4 * bodies));
        let problem = ContactProblem::new(Delassus::Blocks(&self.h), &self.q, &self.mu).unwrap();
        self.p.clear();
        self.p.resize(n, Vector::<2>::zeros());
        self.auto.solve(&problem, &Stop::default(), &mut self.p)
    }
}

#[test]
fn ten_thousand_contacts_in_islands_of_two_take_memory_that_grows_with_them() {
    let block = feet(2, [0.3, -1.0, 0.2], 0.4);
    let bytes = |bodies: usize| {
        let before = bytes_so_far();
        let mut row = Row::new();
        let outcome = row.solve(bodies, &block);
        let bytes = bytes_so_far() - before;
        assert!(outcome.converged() && outcome.used == "enumeration", "{outcome:?}");
        assert_eq!(&row.p[..2], &row.p[2 * bodies - 2..], "blocks alike have impulses alike");
        bytes
    };
    let (half, all) = (bytes(2500), bytes(5000));
    assert!(all as f64 <= 2.2 * half as f64, "{half} bytes for 5000 contacts, {all} for 10 000");
    assert!(all < 50_000_000, "{all} bytes");
}

/// Bytes that a solver allocates for a block-sparse problem of many boxes that stand apart.
fn bytes_of<const D: usize>(solver: &mut dyn ContactSolver<D>, boxes: usize, one: &Case<D>) -> u64 {
    let m = one.q.len();
    let mut h = BlockSparse::default();
    h.set_rows(boxes * m, |i| (0..m).map(move |j| (i / m * m + j, one.h[i % m * m + j]))).unwrap();
    let q: Vec<_> = (0..boxes).flat_map(|_| one.q.iter().copied()).collect();
    let mu = vec![one.mu[0]; boxes * m];
    let problem = ContactProblem::new(Delassus::Blocks(&h), &q, &mu).unwrap();
    let mut p = vec![Vector::zeros(); boxes * m];
    let before = bytes_so_far();
    solver.solve(&problem, &Stop::default().with_max_iterations(12), &mut p);
    bytes_so_far() - before
}

#[test]
fn no_solver_makes_room_for_zero_blocks() {
    let plane = feet(4, [0.3, -1.0, 0.2], 0.4);
    let corners = [[-0.5, -0.3, -1.0], [0.5, -0.3, -1.0], [0.5, 0.3, -1.0], [-0.5, 0.3, -1.0]];
    let space = box_on_floor("box", [0.4, 0.5, 0.1], &corners, [0.3, 0.2, -1.0, 0.1, 0.0, 0.3], 0.4);
    let check = |name: &str, bytes: &dyn Fn(usize) -> u64| {
        let (half, all) = (bytes(400), bytes(800));
        assert!(all as f64 <= 2.2 * half as f64, "{name}: {half} bytes for 1600 contacts, {all} for 3200");
    };
    let mut checked = 0;
    // Those that take some contacts only have no use for a block-sparse problem.
    for info in SOLVERS.iter().filter(|info| !["enumeration", "lemke"].contains(&info.name)) {
        if plane_solver(info.name).is_some() {
            check(info.name, &|boxes| bytes_of(plane_solver(info.name).unwrap().as_mut(), boxes, &plane));
            checked += 1;
        }
        if space_solver(info.name).is_some() {
            check(info.name, &|boxes| bytes_of(space_solver(info.name).unwrap().as_mut(), boxes, &space));
            checked += 1;
        }
    }
    assert!(checked >= 14, "{checked} solvers");
}

#[test]
fn ten_thousand_contacts_have_the_iterations_of_two() {
    // Iterations of an island are states tried: those of all islands together are those of each.
    let block = feet(2, [0.3, -1.0, 0.2], 0.4);
    let (one, _) = solve(&block.problem().unwrap());
    let many = Row::new().solve(5000, &block);
    assert_eq!((many.iterations, many.used, many.status), (one.iterations, one.used, one.status));
}

#[test]
fn a_warm_row_of_blocks_is_posed_and_solved_without_allocating() {
    let mut row = Row::new();
    let (slides, sticks) = (feet(2, [2.0, -1.0, 0.1], 0.2), feet(2, [0.1, -1.0, 0.0], 0.5));
    row.solve(300, &slides);
    let before = so_far();
    for (bodies, block) in [(300, &sticks), (120, &slides), (7, &sticks), (300, &slides)] {
        assert!(row.solve(bodies, block).converged());
    }
    assert_eq!(so_far(), before);
}

#[test]
fn large_islands_of_a_warm_solver_allocate_nothing() {
    // Islands of more contacts than are copied densely, beside small ones.
    let bodies = [feet(24, [0.3, -1.0, 0.2], 0.4), feet(2, [2.0, -1.0, 0.1], 0.2), feet(20, [0.0, -1.0, 0.1], 0.6)];
    let case = together(&bodies, &(0..46).collect::<Vec<_>>());
    let h = sparse(&case);
    let problem = ContactProblem::new(Delassus::Blocks(&h), &case.q, &case.mu).unwrap();
    let (mut auto, mut p) = (Auto::<2>::new(), vec![Vector::<2>::zeros(); 46]);
    assert!(auto.solve(&problem, &Stop::default(), &mut p).converged());
    p.fill(Vector::<2>::zeros());
    let before = so_far();
    assert!(auto.solve(&problem, &Stop::default(), &mut p).converged());
    assert_eq!(so_far(), before);
}
