//! What a case of a study costs beside its steps: `cargo bench -p teeter-benches --bench cases`.
//!
//! Each study varies one key of a scene of `sweeps/`, over so short a time that a case's steps are few; no row goes to
//! disk. The overhead is the time of all cases with their rows, on one thread, less that of the same cases' bare steps
//! (`Simulation::run` without observers), over the number of cases. Both are measured in turn; the table has the medians
//! of processor time, and the difference of the least times: what else a machine does only adds to a time, so that the least
//! ones are nearest to those of an idle machine.
#![allow(clippy::print_stdout)]

use cpu_time::ProcessTime;
use std::error::Error;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use teeter_integrator::Ended;
use teeter_scenario::simulation::Simulation;
use teeter_study::sweep::{Sweep, run_cases};
use teeter_study::{Setting, StudyScene};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Rounds of a study, after a first one for the caches.
const ROUNDS: usize = 60;

/// Cases of a round.
const CASES: u64 = 200;

/// A study: its name, scene, run time, the key that varies with both ends of its values, and the outputs.
type Study = (&'static str, &'static str, &'static str, [&'static str; 3], &'static str);

const SUMMARY: &str = "overturned_at = 'overturned_at'\nlargest = 'max_phi_over_alpha'";
const COLUMN: &str = "largest = { max_abs = 'rocker.phi' }";

const STUDIES: [Study; 7] = [
    ("ground, friction", "block-on-ground", "10 ms", ["contact.feet.friction", "0.3", "0.6"], SUMMARY),
    ("ground, friction; a column", "block-on-ground", "10 ms", ["contact.feet.friction", "0.3", "0.6"], COLUMN),
    ("ground, height", "block-on-ground", "10 ms", ["block.rocker.height", "'12 cm'", "'15 cm'"], SUMMARY),
    ("one sine, scale", "block-under-one-sine", "40 ms", ["signal.shake.scale", "0.5", "0.9"], SUMMARY),
    ("beam, spin", "block-on-beam", "10 ms", ["block.rocker.spin", "'0 rad/s'", "'0.1 rad/s'"], SUMMARY),
    ("beam, friction", "block-on-beam", "10 ms", ["contact.feet.friction", "0.3", "0.6"], SUMMARY),
    ("beam, thickness", "block-on-beam", "10 ms", ["beam.table.thickness", "'0.15 cm'", "'0.2 cm'"], SUMMARY),
];

fn main() -> Result<()> {
    let rounds = if std::env::args().any(|arg| arg == "--test") { 1 } else { ROUNDS };
    println!(
        "| study | steps | case, µs | steps, µs | overhead, µs | least case | least steps | overhead of the least |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|");
    // A name, or part of one, chooses studies.
    let parts: Vec<String> = std::env::args().skip(1).filter(|arg| !arg.starts_with('-')).collect();
    for study in STUDIES.into_iter().filter(|(name, ..)| parts.iter().all(|part| name.contains(part.as_str()))) {
        println!("{}", row(study, rounds)?);
    }
    Ok(())
}

fn row((name, scene, end, [key, from, to], outputs): Study, rounds: usize) -> Result<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../sweeps");
    let text = format!(
        "scene = '{scene}.toml'\n[grid]\ntime.end = ['{end}']\n{key} = {{ from = {from}, to = {to}, count = {CASES} }}\n\
         [outputs]\n{outputs}\n"
    );
    let sweep = Sweep::read(&text, name, &|_, _| Err("no files vary".to_owned()))?;
    let bytes = std::fs::read(folder.join(sweep.scene()))?;
    let mut read = |path: &str| std::fs::read(folder.join(path)).map_err(|error| error.to_string());
    let source = StudyScene::with_files_of(bytes, scene, scene, sweep.settings_with_files(), &mut read);
    let (mut cases, mut bare, mut overhead) = (Vec::new(), Vec::new(), Vec::new());
    let mut steps = 0;
    for round in 0..=rounds {
        let case = time_of_cases(&sweep, &source)?;
        let seconds;
        (seconds, steps) = time_of_steps(&sweep, &source)?;
        if round > 0 {
            cases.push(case);
            bare.push(seconds);
            overhead.push(case - seconds);
        }
    }
    let [[least_case, case], [least_bare, bare], [_, overhead]] = [cases, bare, overhead].map(least_and_median);
    let least = least_case - least_bare;
    Ok(format!(
        "| {name} | {steps} | {case:.1} | {bare:.1} | {overhead:.1} | {least_case:.1} | {least_bare:.1} | {least:.1} |"
    ))
}

/// Processor time of a case with its row, µs.
fn time_of_cases(sweep: &Sweep, source: &StudyScene) -> Result<f64> {
    let cancel = Arc::new(AtomicBool::new(false));
    let mut incomplete = 0;
    let clock = ProcessTime::now();
    run_cases(sweep, source, 0..sweep.cases(), 1, &cancel, |row| {
        incomplete += u64::from(!row.status.is_complete());
        black_box(row.line(sweep));
        ControlFlow::Continue(())
    });
    let seconds = clock.elapsed().as_secs_f64();
    if incomplete > 0 {
        return Err(format!("{incomplete} cases have no result").into());
    }
    Ok(1e6 * seconds / sweep.cases() as f64)
}

/// Processor time of the steps of a case, µs, and their number.
fn time_of_steps(sweep: &Sweep, source: &StudyScene) -> Result<(f64, u64)> {
    let (mut seconds, mut steps) = (0.0, 0);
    for number in 0..sweep.cases() {
        let pairs = sweep.case(number).into_iter();
        let setting = pairs.fold(Setting::none(), |setting, (key, value)| setting.set(key, value));
        let resolved = source.load(&setting).map_err(|found| found.to_string())?;
        let mut simulation = Simulation::new(&resolved.scene)?;
        let clock = ProcessTime::now();
        let ended = simulation.run(&mut [])?;
        seconds += clock.elapsed().as_secs_f64();
        if ended != Ended::Complete {
            return Err(format!("case {number}: {ended:?}").into());
        }
        steps = simulation.state.step;
    }
    Ok((1e6 * seconds / sweep.cases() as f64, steps))
}

/// The least value and the median.
fn least_and_median(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    [0, values.len() / 2].map(|k| values[k])
}
