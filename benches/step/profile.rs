//! The time of a step of a scene, output off, and what it did: for a profiler to look at.
//!
//! ```text
//! cargo run --release -p teeter-benches --example step_profile -- 30 scenarios/free-rocking-on-beam.toml beam.table.elements=10
//! ```
//!
//! (with `BARE=1` before it, without the account of energies and the look at penetrations that nobody reads) runs the scene 30 times, warm, and prints the least and the median time of a step. With 1 run under `valgrind --tool=callgrind` the same program
//! tells the instructions of each function: `benches/results/2026-11-22-where-a-step-goes.md`.
#![allow(clippy::expect_used, clippy::print_stdout)] // a measurement that can't be set up has nothing to go on with

use std::time::Instant;
use teeter_integrator::Account;
use teeter_scenario::simulation::Simulation;

fn main() {
    let mut words = std::env::args().skip(1);
    let runs: usize = words.next().and_then(|word| word.parse().ok()).expect("the number of runs");
    let file = words.next().expect("a scene file");
    let bare = std::env::var_os("BARE").is_some();
    let sets: Vec<(String, String)> = words
        .map(|word| word.split_once('=').map(|(key, value)| (key.to_owned(), value.to_owned())).expect("KEY=VALUE"))
        .collect();
    let bytes = std::fs::read(&file).expect("a scene file that can be read");
    let resolved = teeter_scenario::load(&bytes, &file, &file, &sets).expect("a scene");
    let mut times = Vec::with_capacity(runs);
    for _ in 0..runs.max(1) {
        let mut simulation = Simulation::new(&resolved.scene).expect("a model");
        if bare {
            simulation.keep_account(Account::LeftOut);
        }
        let start = Instant::now();
        let _ = simulation.run(&mut []).expect("a run without observers");
        let steps = simulation.state.step;
        times.push(1e9 * start.elapsed().as_secs_f64() / steps as f64);
        if times.len() == runs.max(1) {
            println!("{steps} steps, {:?}", simulation.work_counts());
        }
    }
    times.sort_by(f64::total_cmp);
    println!(
        "{:.0} ns a step at the least, {:.0} in the median of {} runs",
        times[0],
        times[times.len() / 2],
        times.len()
    );
}
