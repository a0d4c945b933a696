//! What the removals of `docs/required.md` are worth: every scenario, and scenes made for them, with the full model and with the required one; a
//! table in Markdown on standard output.
//!
//! Points looked at and degrees of freedom are counts. Times are of the processor, not of the clock; runs of both models in turn, medians;
//! no output.

use cpu_time::ThreadTime;
use std::error::Error;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use teeter_scenario::Extent;
use teeter_scenario::resolve::Resolved;
use teeter_scenario::simulation::Simulation;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Runs of each model.
const ROUNDS: usize = 11;

/// Steps of a run, at least: short scenes are run again.
const STEPS: u64 = 20_000;

/// A second beam, beside the first, that nothing touches.
const SHELF: &str = "[beam.shelf]\nmaterial = 'aluminium'\nspan = '36 cm'\nwidth = '3 cm'\nthickness = '0.15 cm'\nelements = 20\n\
    position = ['1 m', '0 m']\n";

/// The floor below, that the block never falls on.
const FLOOR: &str = "[ground]\n[contact.floor]\nbetween = ['rocker', 'ground']\nfriction = 0.5\n";

fn main() -> Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
    let mut scenes = Vec::new();
    let mut files: Vec<_> = std::fs::read_dir(&folder)?.collect::<std::result::Result<_, _>>()?;
    files.sort_by_key(std::fs::DirEntry::file_name);
    for file in files {
        let name = file.path().file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        scenes.push((name, std::fs::read_to_string(file.path())?, Vec::new()));
    }
    let paper = std::fs::read_to_string(folder.join("free-rocking-on-beam.toml"))?;
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    let fine = vec![set("beam.table.elements", "40")];
    scenes.push(("free-rocking-on-beam, 40 elements".to_owned(), paper.clone(), fine));
    let modes = vec![set("beam.table.model", "modes")];
    scenes.push(("free-rocking-on-beam, in modes".to_owned(), paper.clone(), modes));
    let high = vec![set("beam.table.position", "['0 m', '50 cm']")];
    scenes.push(("free-rocking-on-beam over a floor".to_owned(), format!("{paper}\n{FLOOR}"), high));
    scenes.push(("free-rocking-on-beam beside a shelf".to_owned(), format!("{paper}\n{SHELF}"), Vec::new()));

    let mut out = std::io::stdout().lock();
    writeln!(out, "| scene | points | dofs | ns a step, full | required | saved | set-up µs, full | required |")?;
    writeln!(out, "|---|---|---|---|---|---|---|---|")?;
    for (name, text, sets) in scenes {
        let resolved =
            teeter_scenario::load(text.as_bytes(), &name, &name, &sets).map_err(|errors| errors.to_string())?;
        writeln!(out, "{}", row(&name, &resolved)?)?;
    }
    Ok(())
}

fn row(name: &str, resolved: &Resolved) -> Result<String> {
    let mut times: [[Vec<f64>; 2]; 2] = Default::default();
    let extents = [Extent::Full, Extent::Required];
    for round in 0..=ROUNDS {
        for (times, extent) in times.iter_mut().zip(extents) {
            let [set_up, step] = measure(resolved, extent)?;
            // The first is for the caches.
            if round > 0 {
                times[0].push(set_up);
                times[1].push(step);
            }
        }
    }
    let models = extents.map(|extent| Simulation::with_extent(&resolved.scene, extent, |solver| solver));
    let [full, required] = models;
    let (full, required) = (full?, required?);
    let [[full_set_up, full_step], [set_up, step]] = times.map(|times| times.map(median));
    let points = |simulation: &Simulation| simulation.model.detector().capacity();
    let mut row = format!("| {name} | ");
    let counts = [(points(&full), points(&required)), (full.dofs(), required.dofs())];
    for (full, required) in counts {
        let _ = match full == required {
            true => write!(row, "{full} | "),
            false => write!(row, "{full} → {required} | "),
        };
    }
    let saved = match required.layout.required.removed.is_empty() {
        true => "–".to_owned(),
        false => format!("{:.0} %", 100.0 * (1.0 - step / full_step)),
    };
    let _ = write!(
        row,
        "{:.0} | {:.0} | {saved} | {:.0} | {:.0} |",
        1e9 * full_step,
        1e9 * step,
        1e6 * full_set_up,
        1e6 * set_up
    );
    Ok(row)
}

/// Set-up, and a step, s.
fn measure(resolved: &Resolved, extent: Extent) -> Result<[f64; 2]> {
    let (mut set_up, mut stepping, mut steps, mut runs) = (0.0, 0.0, 0, 0.0);
    while steps < STEPS {
        let begin = ThreadTime::now();
        let mut simulation = Simulation::with_extent(&resolved.scene, extent, |solver| solver)?;
        set_up += begin.elapsed().as_secs_f64();
        let begin = ThreadTime::now();
        let _ = simulation.run(&mut [])?;
        stepping += begin.elapsed().as_secs_f64();
        (steps, runs) = (steps + simulation.state.step, runs + 1.0);
    }
    Ok([set_up / runs, stepping / steps as f64])
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
