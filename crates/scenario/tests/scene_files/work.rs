//! What a run costs, by count: the same on every machine, so that work can't grow unseen. The
//! counts that hold are in `work_counts.txt`; after a change that is meant, write them anew and
//! read the difference:
//!
//! ```text
//! TEETER_WRITE_COUNTS=1 cargo test -p teeter-scenario --test scene_files work
//! ```

use super::running::{companion, workspace};
use std::fmt::Write as _;
use std::path::PathBuf;
use teeter_scenario::simulation::Simulation;

/// A count may be above the one that holds by this part, and by this much: a contact that closes a
/// step earlier by another machine's sine is no growth.
const SLACK: (f64, u64) = (0.01, 3);

/// Long enough for what a scene shows: impacts, sliding, rest.
const END: &str = "0.3 s";

const COUNTS: [&str; 7] = ["steps", "factorisations", "detections", "problems", "iterations", "unsolved", "refused"];

/// None where the scheme refuses the scene, or counts mean nothing.
fn counts(name: &str, scheme: &str) -> Option<[u64; 7]> {
    let bytes = std::fs::read(workspace().join("scenarios").join(format!("{name}.toml"))).unwrap();
    let sets = [("time.end", format!("\"{END}\"")), ("time.scheme", format!("\"{scheme}\""))];
    let sets: Vec<(String, String)> = sets.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    let resolved = match teeter_scenario::load_with(&bytes, name, name, &sets, &mut companion) {
        Ok(resolved) => resolved,
        Err(errors) => {
            assert!(errors.to_string().contains("time.scheme"), "{errors}");
            return None;
        }
    };
    // On a beam the number of its steps and events is that of a chatter, which hangs on rounding.
    if resolved.scene.time.scheme.has_own_steps() && !resolved.scene.beams.is_empty() {
        return None;
    }
    let mut simulation = Simulation::new(&resolved.scene).unwrap();
    assert_eq!(simulation.run(&mut []).unwrap(), teeter_integrator::Ended::Complete);
    let work = simulation.work_counts();
    let steps = simulation.state.step;
    Some([
        steps,
        work.factorisations,
        work.detections,
        work.problems,
        work.iterations,
        work.unsolved,
        work.refused_attempts,
    ])
}

#[test]
fn no_scenario_takes_more_work_than_it_did() {
    let mut names: Vec<String> = std::fs::read_dir(workspace().join("scenarios"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/scene_files/work_counts.txt");
    let kept = std::fs::read_to_string(&file).unwrap_or_default();
    let mut text = format!("# scene, scheme, to {END}: {}\n", COUNTS.join(", "));
    let mut grown = Vec::new();
    for name in &names {
        for scheme in teeter_integrator::schemes().iter().map(|scheme| scheme.name) {
            let Some(now) = counts(name, scheme) else { continue };
            let head = format!("{name} {scheme}:");
            writeln!(text, "{head} {}", now.map(|count| count.to_string()).join(" ")).unwrap();
            let Some(held) = kept.lines().find_map(|line| line.strip_prefix(&head)) else {
                grown.push(format!("{head} not among the counts that hold"));
                continue;
            };
            let held: Vec<u64> = held.split_whitespace().map(|count| count.parse().unwrap()).collect();
            assert_eq!(held.len(), COUNTS.len(), "{head}");
            for ((what, held), now) in COUNTS.iter().zip(held).zip(now) {
                if now > held + SLACK.1 + (SLACK.0 * held as f64) as u64 {
                    grown.push(format!("{head} {now} {what}, where there were {held}"));
                }
            }
        }
    }
    if std::env::var_os("TEETER_WRITE_COUNTS").is_some() {
        std::fs::write(&file, text).unwrap();
        return;
    }
    assert!(grown.is_empty(), "more work than before:\n{}", grown.join("\n"));
}
