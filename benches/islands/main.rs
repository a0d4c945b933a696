//! Many contacts in islands of two: `cargo bench -p teeter-benches --bench islands`.
//!
//! Blocks that stand apart on two corners each, as a contact problem: the pattern from the velocities that contacts push, the
//! blocks, the solve by `auto`, in memory that is kept. Time a contact should not depend on how many there are; what is left of a
//! dependence is the caches'. Medians of CPU times, as other processes share the machine.
#![allow(clippy::print_stdout, clippy::expect_used)]

use cpu_time::ProcessTime;
use std::hint::black_box;
use teeter_contact::conformance::{Case, body_on_floor};
use teeter_contact::{BlockSparse, ContactProblem, ContactSolver, Delassus, Incidence, Stop, Vector};
use teeter_solvers::Auto;

/// Contacts that are timed in one run at least, so that the clock's own time doesn't show.
const CONTACTS: usize = 100_000;
const RUNS: usize = 31;

#[derive(Default)]
struct Row {
    incidence: Incidence,
    h: BlockSparse<2>,
    q: Vec<Vector<2>>,
    mu: Vec<f64>,
    p: Vec<Vector<2>>,
    auto: Auto<2>,
}

impl Row {
    fn pattern(&mut self, contacts: usize) {
        self.incidence.load(contacts, |contact| (3 * (contact / 2)..).take(3));
        self.h.set_pattern(&self.incidence);
    }

    fn blocks(&mut self, contacts: usize, block: &Case<2>) {
        self.h.zero();
        for i in 0..contacts {
            for j in [i - i % 2, i - i % 2 + 1] {
                self.h.add(i, j, &block.h[i % 2 * 2 + j % 2]).expect("a corner of the same block");
            }
        }
    }

    fn solve(&mut self) {
        let problem = ContactProblem::new(Delassus::Blocks(&self.h), &self.q, &self.mu).expect("a problem");
        self.p.fill(Vector::<2>::zeros());
        let outcome = self.auto.solve(&problem, &Stop::default(), &mut self.p);
        assert!(black_box(outcome).converged());
    }
}

/// The median time of a contact, ns.
fn median(contacts: usize, mut work: impl FnMut()) -> f64 {
    let repeats = CONTACTS.div_ceil(contacts);
    let mut times: Vec<f64> = (0..RUNS)
        .map(|_| {
            let start = ProcessTime::now();
            (0..repeats).for_each(|_| work());
            start.elapsed().as_secs_f64() * 1e9 / (repeats * contacts) as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[RUNS / 2]
}

fn main() {
    let block = body_on_floor("feet", 0.3, &[(-0.5, -1.0), (0.5, -1.0)], [0.3, -1.0, 0.2], 0.4);
    println!("| contacts | pattern | blocks | solve | all |\n|---:|---:|---:|---:|---:|");
    for contacts in [100, 1_000, 10_000, 100_000] {
        let mut row = Row::default();
        row.q.extend((0..contacts).map(|i| block.q[i % 2]));
        row.mu.resize(contacts, block.mu[0]);
        row.p.resize(contacts, Vector::<2>::zeros());
        let pattern = median(contacts, || row.pattern(contacts));
        let blocks = median(contacts, || row.blocks(contacts, &block));
        let solve = median(contacts, || row.solve());
        let all = pattern + blocks + solve;
        println!("| {contacts} | {pattern:.1} ns | {blocks:.1} ns | {solve:.1} ns | {all:.1} ns |");
    }
}
