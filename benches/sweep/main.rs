//! A sweep of `pgs` against the memory's bandwidth: `cargo bench -p teeter-benches --bench sweep`.
//!
//! The bound: a sweep has to read every block of H once, 72 bytes each in space. How fast this machine reads that much is
//! measured on the same array, by a sum over its numbers (eight partial sums, so that additions don't wait for each
//! other), repeated like the sweeps are: a problem that fits a cache is compared with the cache. Columns, impulses and
//! what is known of each contact are read too, but not counted.
//!
//! A sweep's time is the difference of two solves of 1 and 9 sweeps from impulses that 40 sweeps have settled, over 8, so
//! that what is done once a solve drops out. The longer one computes one residual more: "bare" is the sweep alone, the
//! residual's time as measured by itself taken off; "sweep" has a sixteenth of a residual in it, which is how often the
//! solver computes one in a long solve at most. The best of many short runs is taken, as other processes share the machine.
#![allow(clippy::print_stdout, clippy::expect_used)]

use nalgebra::{Matrix3, Vector3};
use std::hint::black_box;
use std::time::Instant;
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Delassus, Stop, judge};
use teeter_solvers::Pgs;

/// A small generator of numbers in −1..1 (xorshift), so that every run measures the same problems.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.next() + 1.0) * 0.5 * n as f64) as usize % n
    }
}

/// Contacts between bodies at places on a line, each between two neighbours: `contacts/bodies` decides how many blocks a
/// row has. H = Σ J M⁻¹ Jᵀ over six velocities a body.
fn problem(contacts: usize, bodies: usize, random: &mut Random) -> (BlockSparse<3>, Vec<Vector3<f64>>, Vec<f64>) {
    type Rows = nalgebra::SMatrix<f64, 3, 6>;
    let mut touching: Vec<[usize; 2]> = Vec::new();
    let mut of_body: Vec<Vec<usize>> = vec![Vec::new(); bodies];
    let mut rows: Vec<[Rows; 2]> = Vec::new();
    for i in 0..contacts {
        let a = random.below(bodies);
        let b = (a + 1 + random.below(6)) % bodies;
        touching.push([a, b]);
        of_body[a].push(i);
        of_body[b].push(i);
        let mut side =
            |sign: f64| Rows::from_fn(|r, c| if c < 3 { sign * f64::from(u8::from(r == c)) } else { random.next() });
        rows.push([side(1.0), side(-1.0)]);
    }
    let mut h = Vec::new();
    for i in 0..contacts {
        let mut columns: Vec<usize> = touching[i].iter().flat_map(|&body| of_body[body].iter().copied()).collect();
        columns.sort_unstable();
        columns.dedup();
        let block = |j: usize| {
            let mut block = if i == j { Matrix3::identity() * 0.05 } else { Matrix3::zeros() };
            for (a, &body) in touching[i].iter().enumerate() {
                for (b, &other) in touching[j].iter().enumerate() {
                    if body == other {
                        block += rows[i][a] * rows[j][b].transpose();
                    }
                }
            }
            block
        };
        h.push(columns.into_iter().map(|j| (j, block(j))).collect());
    }
    let q = (0..contacts).map(|_| Vector3::new(random.next() - 0.6, random.next(), random.next())).collect();
    let mu = (0..contacts).map(|_| 0.3 + 0.2 * random.next()).collect();
    (BlockSparse::from_rows(&h).expect("sorted rows with diagonals"), q, mu)
}

/// The best of some runs, in seconds: what other processes took from us is not the program's.
fn best(runs: usize, mut run: impl FnMut()) -> f64 {
    (0..runs)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

/// Reads all numbers: two blocks at a time, each number into a sum of its own.
fn sum(blocks: &[Matrix3<f64>]) -> f64 {
    let mut sums = [[0.0; 9]; 2];
    for pair in blocks.chunks(2) {
        for (sums, block) in sums.iter_mut().zip(pair) {
            for (sum, x) in sums.iter_mut().zip(block.as_slice()) {
                *sum += x;
            }
        }
    }
    sums.iter().flatten().sum()
}

fn main() {
    const MORE: u32 = 8;
    let runs = if std::env::args().any(|arg| arg == "--test") { 1 } else { 300 };
    println!(
        "| contacts | blocks | a row | MB | read, GB/s | bound, us | sweep, us | bare, us | sweep/bound | ns a block |"
    );
    println!("|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for (contacts, bodies) in
        [(500, 180), (500, 120), (1000, 240), (2000, 480), (2000, 400), (5000, 1200), (5000, 1000)]
    {
        let (h, q, mu) = problem(contacts, bodies, &mut Random(0x9e37_79b9_7f4a_7c15));
        let posed = ContactProblem::new(Delassus::Blocks(&h), &q, &mu).expect("a problem");
        let blocks = h.blocks().len();
        let bytes = 72.0 * blocks as f64;
        let read = best(runs, || {
            black_box(sum(black_box(h.blocks())));
        });
        let mut solver = Pgs::new();
        let mut sweeps = |max_iterations, p: &mut [Vector3<f64>]| {
            let outcome = solver.solve(&posed, &Stop::new(0.0, max_iterations), p);
            assert_eq!(outcome.iterations, max_iterations, "{outcome:?}");
        };
        let mut settled = vec![Vector3::zeros(); contacts];
        sweeps(40, &mut settled);
        let mut p = settled.clone();
        let mut time = |sweep_count| {
            best(runs, || {
                p.copy_from_slice(&settled);
                sweeps(sweep_count, &mut p);
            })
        };
        let (short, long) = (time(1), time(1 + MORE));
        let residual = best(runs, || {
            black_box(judge(&posed, &settled));
        });
        let bare = (long - short - residual) / f64::from(MORE);
        let sweep = bare + residual / 16.0;
        println!(
            "| {contacts} | {blocks} | {:.1} | {:.2} | {:.1} | {:.1} | {:.1} | {:.1} | {:.2} | {:.2} |",
            blocks as f64 / contacts as f64,
            bytes * 1e-6,
            bytes / read * 1e-9,
            read * 1e6,
            sweep * 1e6,
            bare * 1e6,
            sweep / read,
            sweep * 1e9 / blocks as f64
        );
    }
}
