//! Scenes damaged at random never crash the reader or the making of a model, and are answered fast.
//!
//! The generator has a fixed seed: a failure comes again. `TEETER_MUTATIONS=100000` looks further
//! than CI does.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use cpu_time::ThreadTime;
use std::path::Path;
use std::time::Duration;
use teeter_scenario::load;
use teeter_scenario::preview::Preview;
use teeter_scenario::simulation::Simulation;

/// Mutated scenes of each seed in CI.
const FEW: usize = 300;

/// For one scene, in an unoptimised build; a release build takes a tenth. Of the thread's own time,
/// so that a busy machine is no failure.
const PATIENCE: Duration = Duration::from_secs(10);

/// Marsaglia's xorshift.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 % u64::try_from(end.max(1)).unwrap()).unwrap()
    }

    fn pick<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[self.below(of.len())]
    }
}

/// What TOML is made of.
const PIECES: &[&str] = &[
    "\"",
    "'",
    "\"\"\"",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "=",
    ".",
    ",",
    "\n",
    "\r\n",
    "#",
    "\\",
    "\\u0000",
    "\0",
    "\u{feff}",
    "µ",
    "\u{1b}",
    "true",
    "1979-05-27",
    "-",
    "e",
    "0x1f",
];

/// Values that are near a limit of some key, or of arithmetic.
const VALUES: &[&str] = &[
    "0",
    "-1",
    "1",
    "10000",
    "10001",
    "9223372036854775807",
    "-9223372036854775808",
    "99999999999999999999",
    "nan",
    "inf",
    "1e308",
    "1e-320",
    "0.5",
    "\"0 m\"",
    "\"1e-12 m\"",
    "\"1e12 m\"",
    "\"1e12 s\"",
    "\"1e-15 s\"",
    "\"1 us\"",
    "\"90 deg\"",
    "\"-90 deg\"",
    "\"1e12 kg/m^3\"",
    "\"1e-12 Pa\"",
    "\"1e18 Pa\"",
    "\"ground\"",
    "\"table\"",
    "\"rocker\"",
    "\"static\"",
    "\"top\"",
    "\"linear\"",
    "[\"free\", \"clamped\"]",
    "[\"clamped\", \"clamped\"]",
    "[\"1e12 m\", \"-1e12 m\"]",
    "[\"0 m/s^2\", \"0 m/s^2\"]",
    "[]",
    "{}",
    "{ mode = 100000, ratio = 1e12 }",
    "\"1e12 rad/s\"",
    "\"1e12 m/s^2\"",
    "true",
];

/// One or more changes of bytes, of pieces, of whole values and lines.
fn mutate(text: &str, random: &mut Random) -> Vec<u8> {
    let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
    for _ in 0..=random.below(3) {
        let at = random.below(lines.len());
        let other = lines[random.below(lines.len())].clone();
        match random.below(6) {
            0..=2 => {
                if let Some((key, _)) = lines[at].split_once('=') {
                    lines[at] = format!("{key}= {}", random.pick(VALUES));
                }
            }
            3 => lines.insert(at, other),
            4 => drop(lines.remove(at)),
            _ => {
                let mut place = random.below(lines[at].len() + 1);
                while !lines[at].is_char_boundary(place) {
                    place -= 1;
                }
                lines[at].insert_str(place, random.pick(PIECES));
            }
        }
        if lines.is_empty() {
            lines.push(String::new());
        }
    }
    let mut bytes = lines.join("\n").into_bytes();
    if random.below(4) == 0 && !bytes.is_empty() {
        let at = random.below(bytes.len());
        match random.below(3) {
            0 => bytes[at] = u8::try_from(random.below(256)).unwrap(),
            1 => bytes.truncate(at),
            _ => drop(bytes.remove(at)),
        }
    }
    bytes
}

fn seeds() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut seeds = Vec::new();
    for folder in ["scenarios", "fuzz/corpus/scene"] {
        for entry in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            // Records beside the scenarios are no scenes.
            if path.extension().is_some_and(|ending| ending == "csv") {
                continue;
            }
            // Of the corpus, what is text.
            if let Ok(text) = std::fs::read_to_string(&path) {
                seeds.push((path.display().to_string(), text));
            }
        }
    }
    seeds.sort();
    seeds
}

/// Whether the scene is accepted; panics and delays are failures of the test.
fn answer(bytes: &[u8]) -> bool {
    let clock = ThreadTime::now();
    let accepted = match load(bytes, "scene.toml", "scene", &[]) {
        Err(found) => {
            assert!(found.has_errors() && !found.to_string().is_empty());
            let text = std::str::from_utf8(bytes).unwrap_or_default();
            for finding in found.iter() {
                assert!(finding.span.clone().is_none_or(|span| text.get(span).is_some()), "{finding}");
            }
            false
        }
        Ok(resolved) => match Simulation::new(&resolved.scene) {
            Err(error) => {
                assert!(!error.diagnostic(&resolved.document).to_string().is_empty());
                false
            }
            Ok(simulation) => {
                let outlook = Preview::new(&resolved, &simulation);
                assert!(outlook.volume.rows >= 1.0);
                let written = resolved.document.to_toml();
                load(written.as_bytes(), "again.toml", "scene", &[])
                    .unwrap_or_else(|found| panic!("{found}\n{written}"));
                true
            }
        },
    };
    assert!(clock.elapsed() < PATIENCE, "{:?} for\n{}", clock.elapsed(), String::from_utf8_lossy(bytes));
    accepted
}

#[test]
fn damaged_scenes_are_answered_fast_and_without_a_crash() {
    let count = std::env::var("TEETER_MUTATIONS").ok().and_then(|text| text.parse().ok()).unwrap_or(FEW);
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut accepted, mut refused) = (0, 0);
    for (name, text) in seeds() {
        for round in 0..count {
            let bytes = mutate(&text, &mut random);
            let outcome = std::panic::catch_unwind(|| answer(&bytes));
            match outcome {
                Ok(true) => accepted += 1,
                Ok(false) => refused += 1,
                Err(_) => panic!("{name}, round {round}:\n{}", String::from_utf8_lossy(&bytes)),
            }
        }
    }
    assert!(accepted > 100 && refused > 100, "{accepted} accepted, {refused} refused: the mutations miss something");
}

#[test]
fn the_corpus_is_answered_fast_and_without_a_crash() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/scene");
    let files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(files.len() >= 5);
    for file in files {
        answer(&std::fs::read(&file).unwrap());
    }
}
