//! Runs that are killed, interrupted, resumed, started from a state: what comes out must be the
//! bytes of a run that was left alone.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A folder with the program's current directory `at` and its results in `at/out`.
struct Place {
    at: PathBuf,
}

impl Place {
    fn new(test: &str) -> Self {
        let at = Path::new(env!("CARGO_TARGET_TMPDIR")).join("resume").join(test);
        let _ = std::fs::remove_dir_all(&at);
        std::fs::create_dir_all(&at).unwrap();
        Self { at }
    }

    fn out(&self) -> PathBuf {
        self.at.join("out")
    }

    fn command(&self, scene: &[&str], more: &[&str]) -> Command {
        self.command_of(Path::new(env!("CARGO_BIN_EXE_teeter")), scene, more)
    }

    /// `scene`: a scenario's name, or the name of a file in the folder, and what is set in it.
    fn command_of(&self, program: &Path, scene: &[&str], more: &[&str]) -> Command {
        let mut command = Command::new(program);
        let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
        let own = scene[0].ends_with(".toml");
        let file = if own { scene[0].into() } else { scenarios.join(format!("{}.toml", scene[0])) };
        command.current_dir(&self.at).arg("run").arg(file).args(["--out", "out"]);
        for set in &scene[1..] {
            command.args(["--set", set]);
        }
        command.args(more).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    fn run(&self, scene: &[&str], more: &[&str]) -> Output {
        self.command(scene, more).output().unwrap()
    }

    fn done(&self, scene: &[&str], more: &[&str]) -> String {
        let output = self.run(scene, more);
        assert!(output.status.success(), "{}", stderr(&output));
        stderr(&output)
    }

    /// Must be refused with the exit code, and change nothing; returns the message.
    fn refused(&self, code: i32, scene: &[&str], more: &[&str]) -> String {
        let before = contents(&self.at);
        let output = self.run(scene, more);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{message}");
        assert!(contents(&self.at) == before, "something was changed: {message}");
        message
    }

    /// Starts the run, and kills it when it has written a checkpoint.
    fn killed_with_checkpoint(&self, scene: &[&str], more: &[&str]) {
        let mut child = self.command(scene, more).spawn().unwrap();
        wait_for(&self.out().join("checkpoint.bin"));
        child.kill().unwrap();
        assert_eq!(child.wait().unwrap().code(), None, "it was to be killed before its end");
    }
}

fn wait_for(path: &Path) {
    for _ in 0..20_000 {
        if path.exists() {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("{} never came", path.display());
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// All files below a folder, hidden ones too.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inner) = folders.pop() {
        for entry in std::fs::read_dir(inner).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let content = std::fs::read(&path).unwrap();
                files.insert(path.strip_prefix(folder).unwrap().to_owned(), content);
            }
        }
    }
    files
}

/// The results of a run, without the two numbers that the clock decides.
fn results(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = contents(folder);
    let summary = files.get_mut(Path::new("summary.json")).unwrap();
    let text = String::from_utf8(summary.clone()).unwrap();
    let timing = |line: &&str| line.contains("\"wall_seconds\"") || line.contains("\"us_per_step\"");
    assert_eq!(text.lines().filter(timing).count(), 2);
    *summary = text.lines().filter(|line| !timing(line)).collect::<Vec<_>>().join("\n").into_bytes();
    files
}

fn assert_same(wanted: &BTreeMap<PathBuf, Vec<u8>>, folder: &Path, what: &str) {
    let found = results(folder);
    assert_eq!(wanted.keys().collect::<Vec<_>>(), found.keys().collect::<Vec<_>>(), "{what}");
    for (name, bytes) in wanted {
        assert!(found[name] == *bytes, "{what}: {} differs", name.display());
    }
}

/// Numbers in [0, 1), always the same ones (Knuth's MMIX generator).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Impacts, thinned rows, warnings of unsolved steps: something for every part of a checkpoint.
const ROCKING: [&str; 3] = ["free-rocking-on-beam", "time.step=25us", "output.every=0.3 ms"];
const SLIDING: [&str; 5] =
    ["sliding", "time.step=40us", "solver.method=pgs", "solver.max_iterations=1", "solver.tolerance=1e-14"];

/// Springs that remember how deep they are, and ground that moves.
const COMPLIANT: [&str; 3] = ["compliant-drop", "time.step=10us", "output.every=0.3 ms"];
const SHAKEN: [&str; 3] = ["shaken-ground", "time.step=40us", "output.every=1 ms"];

/// A run that the scene stops: whether it does is known by what was seen since its start.
const STOPPED: [&str; 4] = ["shaken-ground", "time.step=40us", "output.every=1 ms", "time.stop=[\"overturned\"]"];

/// Stones that begin in flight, and settle at different times.
const FALLING: [&str; 2] = ["pile-of-polygons", "time.end=1.2 s"];

/// Contacts that stay closed by a flag, impacts by another law.
const CLOSED: [&str; 4] =
    ["free-rocking-on-beam", "time.step=10us", "time.scheme=\"moreau-jean-closed\"", "contact.feet.law=\"poisson\""];

/// What a beam bears: columns, extremes over all steps, a warning.
const BORNE: [&str; 8] = [
    "free-rocking-on-beam",
    "time.step=25us",
    "output.every=0.3 ms",
    "beam.table.probes=[\"9 cm\", \"0.18 m\"]",
    "beam.table.record=[\"w\", \"moment\", \"shear\", \"stress\", \"axial_force\"]",
    "beam.table.reactions=true",
    "beam.table.envelope=true",
    "material.aluminium.yield_strength=\"30 MPa\"",
];

/// The state holds modal coordinates; what is written is of the nodes.
const MODES: [&str; 7] = [
    "free-rocking-on-beam",
    "beam.table.model=modes",
    "beam.table.record=['w', 'moment']",
    "beam.table.probes=['9 cm']",
    "beam.table.reactions=true",
    "beam.table.envelope=true",
    "output.every=0.3 ms",
];

/// A run of a second or more.
const LONG: [&str; 3] = ["free-rocking-on-beam", "time.step=2us", "output.every=0.3 ms"];

const EVERY: [&str; 2] = ["--checkpoint-every", "3 ms"];
const AGAIN: [&str; 3] = ["--checkpoint-every", "3 ms", "--resume"];

/// The results of a run that is left alone, and how long it takes.
fn alone(place: &Place, scene: &[&str], more: &[&str]) -> (BTreeMap<PathBuf, Vec<u8>>, Duration) {
    let begin = Instant::now();
    place.done(scene, more);
    let took = begin.elapsed();
    let wanted = results(&place.out());
    std::fs::remove_dir_all(place.out()).unwrap();
    (wanted, took)
}

fn killed_after(mut child: Child, time: Duration) {
    std::thread::sleep(time);
    // It may have ended before.
    let _ = child.kill();
    let _ = child.wait();
}

/// Each scene killed at four random moments. The scenes are shared between two tests, which run at once: one alone would go on after all others of this file are done.
fn killed_at_random_moments(scenes: &[&[&str]], test: &str, seed: u64) {
    let mut random = Random(seed);
    for (number, scene) in scenes.iter().enumerate() {
        let name = scene[0];
        let place = Place::new(&format!("kill-{test}-{number}-{name}"));
        let (wanted, took) = alone(&place, scene, &[]);
        for k in 0..4 {
            let moment = took.mul_f64(random.next());
            killed_after(place.command(scene, &EVERY).spawn().unwrap(), moment);
            place.done(scene, &AGAIN);
            assert_same(&wanted, &place.out(), &format!("{name}, kill {k} after {moment:?}"));
            std::fs::remove_dir_all(place.out()).unwrap();
        }
    }
}

#[test]
fn a_run_killed_at_random_moments_on_a_beam_ends_with_the_same_bytes() {
    killed_at_random_moments(&[&ROCKING, &CLOSED, &BORNE, &MODES], "beam", 20);
}

#[test]
fn a_run_killed_at_random_moments_on_ground_ends_with_the_same_bytes() {
    killed_at_random_moments(&[&SLIDING, &COMPLIANT, &SHAKEN, &STOPPED, &FALLING], "ground", 22);
}

#[test]
fn a_run_killed_again_and_again_ends_with_the_same_bytes() {
    let place = Place::new("kills");
    let (wanted, took) = alone(&place, &ROCKING, &[]);
    let mut random = Random(21);
    // Each time with another interval, or none.
    for every in [&AGAIN[..], &["--checkpoint-every", "0.7 ms", "--resume"], &["--resume"], &AGAIN, &AGAIN, &AGAIN] {
        killed_after(place.command(&ROCKING, every).spawn().unwrap(), took.mul_f64(0.6 * random.next()));
    }
    place.done(&ROCKING, &["--resume"]);
    assert_same(&wanted, &place.out(), "after six kills");
}

#[test]
fn saved_problems_are_those_of_a_run_left_alone() {
    let place = Place::new("export");
    let export = ["--export-problems", "problems", "--export-when", "every:500"];
    let long = ["free-rocking-on-beam", "time.step=5us"];
    let with = |more: &[&'static str]| [&export[..], more].concat();
    place.done(&long, &export);
    let wanted = (results(&place.out()), contents(&place.at.join("problems")));
    std::fs::remove_dir_all(&place.at).unwrap();
    let place = Place::new("export");
    place.killed_with_checkpoint(&long, &with(&EVERY));
    let message = place.refused(2, &long, &AGAIN);
    assert!(message.contains("other options") && message.contains("every:500"), "{message}");
    place.done(&long, &with(&AGAIN));
    assert_same(&wanted.0, &place.out(), "with problems");
    assert!(contents(&place.at.join("problems")) == wanted.1);
}

#[test]
fn an_interrupted_run_goes_on_to_the_same_bytes() {
    let place = Place::new("interrupt");
    let (wanted, _) = alone(&place, &LONG, &[]);
    // No checkpoint would be due before the end: there is one of the moment all the same.
    for times in 1..=2 {
        let child = place.command(&LONG, &["--checkpoint-every", "1 h", "--resume"]).spawn().unwrap();
        let table = place.out().join("trajectory.csv");
        let length = || std::fs::metadata(&table).map_or(0, |data| data.len());
        let begin = length();
        while length() < begin + 1000 {
            std::thread::sleep(Duration::from_millis(1));
        }
        assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
        assert!(stderr(&output).contains("--resume continues from there"), "{}", stderr(&output));
        let summary = std::fs::read_to_string(place.out().join("summary.json")).unwrap();
        assert!(summary.contains("\"ended\": \"interrupted\""), "time {times}");
    }
    let said = place.done(&LONG, &["--resume"]);
    assert!(said.contains("continuing from t = "), "{said}");
    assert_same(&wanted, &place.out(), "after two interrupts");
}

/// A tower whose first step takes hundreds of contact problems, one after another.
const TOWER: &str = "[time]\nend = '20 ms'\nstep = '1 ms'\n[ground]\n[material.m]\ndensity = '700 kg/m^3'\n[block.box]\n\
    material = 'm'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\non = 'ground'\nat = '0 m'\n\
    repeat = { count = 300, stacked = true }\n[contact.floor]\nbetween = ['*', 'ground']\nfriction = 0.5\n\
    [contact.joints]\nbetween = ['*', '*']\nfriction = 0.5\n";

#[test]
fn a_run_interrupted_within_a_long_step_goes_on_to_the_same_bytes() {
    let place = Place::new("long-step");
    std::fs::write(place.at.join("tower.toml"), TOWER).unwrap();
    let tower = ["tower.toml"];
    let (wanted, _) = alone(&place, &tower, &[]);
    let child = place.command(&tower, &["--checkpoint-every", "1 h", "--resume"]).spawn().unwrap();
    wait_for(&place.out().join("energy.csv"));
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    let summary = std::fs::read_to_string(place.out().join("summary.json")).unwrap();
    assert!(summary.contains("\"ended\": \"interrupted\"") && summary.contains("\"steps\": 0"), "{summary}");
    place.done(&tower, &["--resume"]);
    assert_same(&wanted, &place.out(), "after an interrupt in the first step");
}

#[test]
fn where_nothing_was_begun_or_no_checkpoint_written_a_run_starts_at_its_beginning() {
    let place = Place::new("beginning");
    let (wanted, _) = alone(&place, &LONG, &[]);
    let said = place.done(&LONG, &["--resume"]);
    assert!(said.contains("no run to resume: it starts from the beginning"), "{said}");
    assert_same(&wanted, &place.out(), "without a folder");
    std::fs::remove_dir_all(place.out()).unwrap();

    let mut child = place.command(&LONG, &["--checkpoint-every", "1 h"]).spawn().unwrap();
    wait_for(&place.out().join("energy.csv"));
    child.kill().unwrap();
    child.wait().unwrap();
    // Another scene must not take its place.
    let message = place.refused(2, &[LONG[0], LONG[1], "output.every=0.4 ms"], &["--resume"]);
    assert!(message.contains("another scene") && message.contains("0.3 ms"), "{message}");
    let said = place.done(&LONG, &["--resume"]);
    assert!(said.contains("no checkpoint: the run starts again"), "{said}");
    assert_same(&wanted, &place.out(), "without a checkpoint");
}

#[test]
fn a_run_that_has_ended_is_left_as_it_is() {
    let place = Place::new("ended");
    let short = ["sliding", "time.end=10 ms"];
    place.done(&short, &EVERY);
    assert!(!place.out().join("checkpoint.bin").exists(), "a complete run needs none");
    let message = place.refused(0, &short, &AGAIN);
    assert!(message.contains("complete: there is nothing to resume"), "{message}");
    let message = place.refused(2, &["sliding", "time.end=11 ms"], &AGAIN);
    assert!(message.contains("time") && message.contains("0.011 s"), "{message}");

    let place = Place::new("unconverged");
    let strict = [&SLIDING[..], &["solver.require_convergence=true"]].concat();
    assert_eq!(place.run(&strict, &["--checkpoint-every", "40 us"]).status.code(), Some(1));
    let message = place.refused(1, &strict, &AGAIN);
    assert!(message.contains("unconverged") && message.contains("same way again"), "{message}");
}

#[test]
fn what_does_not_fit_is_refused_and_nothing_changed() {
    let place = Place::new("mismatch");
    let long = |more: &[&'static str]| [&LONG[..], more].concat();
    place.killed_with_checkpoint(&LONG, &EVERY);

    let message = place.refused(2, &long(&["contact.feet.friction=0.4"]), &AGAIN);
    for part in ["another scene", "`friction = 0.5` there, `friction = 0.4` here in [contact.feet]", "--force"] {
        assert!(message.contains(part), "{message}");
    }
    let message = place.refused(2, &LONG, &["--resume", "--export-problems", "problems"]);
    assert!(message.contains("other options (none, now --export-problems"), "{message}");
    let message = place.refused(2, &LONG, &["--resume", "--model", "full"]);
    assert!(message.contains("other options (none, now --model full)"), "{message}");
    let message = place.refused(2, &LONG, &EVERY);
    assert!(message.contains("holds results already"), "{message}");
    assert!(place.refused(2, &LONG, &["--resume", "--force"]).contains("cannot be used with"));
    assert!(place.refused(2, &LONG, &["--resume", "--checkpoint-every", "0.1"]).contains("unit"));
    assert!(place.refused(2, &LONG, &["--resume", "--checkpoint-every", "0 s"]).contains("greater than 0"));
    assert!(place.refused(2, &LONG, &["--resume", "--checkpoint-every", "2 kg"]).contains("mass"));

    // A byte more behind its end: the program does the same, but it isn't the same file.
    let other = place.at.join("other-teeter");
    std::fs::copy(env!("CARGO_BIN_EXE_teeter"), &other).unwrap();
    let mut file = std::fs::File::options().append(true).open(&other).unwrap();
    std::io::Write::write_all(&mut file, b"x").unwrap();
    drop(file);
    let output = place.command_of(&other, &LONG, &AGAIN).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("another program"), "{}", stderr(&output));
    std::fs::remove_file(&other).unwrap();

    // A table that was cut, and one that is gone.
    let table = place.out().join("energy.csv");
    let rows = std::fs::read(&table).unwrap();
    std::fs::write(&table, &rows[..50]).unwrap();
    let message = place.refused(2, &LONG, &AGAIN);
    assert!(message.contains("energy.csv holds 50 bytes, but"), "{message}");
    std::fs::remove_file(&table).unwrap();
    assert!(place.refused(2, &LONG, &AGAIN).contains("can't read"));
    std::fs::write(&table, &rows).unwrap();

    place.done(&LONG, &AGAIN);
}

#[test]
fn a_file_that_the_scene_refers_to_is_part_of_it() {
    let by_signal = "
ground.motion = { acceleration = [\"1 m/s^2\", \"0 m/s^2\"], signal = \"quake\" }
signal.quake = { shape = \"table\", file = \"quake.csv\" }
";
    let by_record = "ground.motion.x = { record = \"quake.csv\" }\n";
    let cases = [
        ("signal", by_signal, "t,a\n0,0\n0.1,1\n0.3,-1\n0.5,0\n"),
        ("record", by_record, "t,a\n0,0\n0.1,1\n0.2,0\n0.3,-1\n0.4,0\n"),
    ];
    for (name, motion, quake) in cases {
        let place = Place::new(name);
        let scene = format!(
            "
time = {{ end = \"1 s\", step = \"5 us\" }}
output.every = \"1 ms\"
{motion}
material.wood.density = \"600 kg/m^3\"
block.box = {{ material = \"wood\", width = \"10 cm\", height = \"10 cm\", depth = \"10 cm\", on = \"ground\", at = \"0 m\" }}
contact.base = {{ between = [\"box\", \"ground\"], friction = 0.05 }}
"
        );
        std::fs::write(place.at.join("scene.toml"), scene).unwrap();
        std::fs::write(place.at.join("quake.csv"), quake).unwrap();
        let (wanted, _) = alone(&place, &["scene.toml"], &[]);
        place.killed_with_checkpoint(&["scene.toml"], &EVERY);
        std::fs::write(place.at.join("quake.csv"), quake.replace("-1", "-2")).unwrap();
        let message = place.refused(2, &["scene.toml"], &AGAIN);
        assert!(message.contains("a file that it refers to has changed"), "{message}");
        std::fs::write(place.at.join("quake.csv"), quake).unwrap();
        place.done(&["scene.toml"], &AGAIN);
        assert_same(&wanted, &place.out(), name);
        assert!(place.refused(0, &["scene.toml"], &AGAIN).contains("nothing to resume"));
    }
}

#[test]
fn a_checkpoint_that_is_not_whole_is_refused() {
    let place = Place::new("damaged");
    place.killed_with_checkpoint(&LONG, &EVERY);
    let path = place.out().join("checkpoint.bin");
    let whole = std::fs::read(&path).unwrap();
    let refused = |bytes: &[u8], part: &str| {
        std::fs::write(&path, bytes).unwrap();
        let message = place.refused(2, &LONG, &AGAIN);
        assert!(message.contains(part) && message.contains("--force"), "{message}");
    };
    // `checkpoint::file` tries every length and every bit of a small one.
    for length in [0, 7, 8, 23, 24, 25, whole.len() / 2, whole.len() - 1] {
        refused(&whole[..length], "damaged");
    }
    let mut random = Random(22);
    for _ in 0..10 {
        let mut flipped = whole.clone();
        flipped[24 + (random.next() * (whole.len() - 24) as f64) as usize] ^= 1 << (8.0 * random.next()) as u8;
        refused(&flipped, "check sum");
    }
    let mut other = whole.clone();
    other[8] = 99;
    refused(&other, "version 99");
    refused(b"t,x\n0.0,1.0\n", "not a checkpoint");

    std::fs::write(&path, &whole).unwrap();
    place.done(&LONG, &AGAIN);
}

/// The rows of a table from a time on.
fn rows_from(folder: &Path, table: &str, t: f64) -> Vec<String> {
    let text = std::fs::read_to_string(folder.join(table)).unwrap();
    let time = |line: &&str| line.split(',').next().unwrap().parse::<f64>().unwrap() >= t;
    text.lines().skip(1).filter(time).map(str::to_owned).collect()
}

#[test]
fn a_run_from_a_checkpoint_moves_as_the_one_that_went_on() {
    let place = Place::new("from");
    place.killed_with_checkpoint(&LONG, &EVERY);
    let state = place.at.join("state.bin");
    std::fs::copy(place.out().join("checkpoint.bin"), &state).unwrap();
    place.done(&LONG, &AGAIN);
    let whole = place.at.join("whole");
    std::fs::rename(place.out(), &whole).unwrap();

    place.done(&LONG, &["--from", "state.bin"]);
    let part = rows_from(&place.out(), "trajectory.csv", 0.0);
    let t: f64 = part[0].split(',').next().unwrap().parse().unwrap();
    assert!(t > 0.0 && part.len() > 10);
    for table in ["trajectory.csv", "impacts.csv"] {
        assert_eq!(rows_from(&place.out(), table, t), rows_from(&whole, table, t), "{table}");
    }
    let summary = |folder: &Path| -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(folder.join("summary.json")).unwrap()).unwrap()
    };
    let (part, whole) = (summary(&place.out()), summary(&whole));
    assert_eq!((&part["t"], &part["steps"]), (&whole["t"], &whole["steps"]), "the clock goes on");
    assert_eq!(part["energy"]["final"], whole["energy"]["final"]);
    // The account begins with the run: its largest residual is the identity's, checked from there
    // on.
    assert!(part["energy"]["largest_residual"].as_f64().unwrap() <= 1e-12);
    assert!(part["energy"]["initial"] != whole["energy"]["initial"]);

    let from = ["--from", "state.bin", "--force"];
    let with = |set: &'static str| [LONG[0], LONG[2], set];
    place.done(
        &with("time.step=1us"),
        &[&from[..], &["--set", "time.end=10 ms", "--set", "solver.method=pgs"]].concat(),
    );
    assert!(place.refused(2, &["sliding"], &from).contains("is a state of `rocker` (3 coordinates), `table`"));
    assert!(place.refused(2, &with("beam.table.elements=10"), &from).contains("but the scene has `rocker` (3"));
    let message = place.refused(2, &with("beam.table.model=modes"), &from);
    assert!(
        message.contains("but the scene has `rocker` (3 coordinates), `table in modes` (20 coordinates)"),
        "{message}"
    );
    let message = place.refused(2, &with("time.step=7.77 us"), &from);
    assert!(message.contains("no whole number of steps of 0.00000777 s"), "{message}");
    assert!(place.refused(2, &with("time.end=2 ms"), &from).contains("give a later end"));
    assert!(place.refused(2, &LONG, &["--force", "--from", "out/energy.csv"]).contains("is read by this command"));
    std::fs::copy(place.out().join("energy.csv"), place.at.join("rows.csv")).unwrap();
    assert!(place.refused(2, &LONG, &["--force", "--from", "rows.csv"]).contains("not a state or checkpoint"));
    assert!(place.refused(2, &LONG, &["--force", "--from", "nowhere.bin"]).contains("nowhere.bin"));
}

#[test]
fn the_state_before_the_first_unsolved_step_can_be_run_from() {
    let place = Place::new("dump");
    let said = place.done(&SLIDING, &["--dump-unconverged", "hard.bin"]);
    assert!(said.contains("hard.bin starts there"), "{said}");
    let first = |said: &str| said.lines().find(|line| line.contains("was not solved")).unwrap().to_owned();
    let again = place.done(&SLIDING, &["--from", "hard.bin", "--force", "--dump-unconverged", "again.bin"]);
    assert_eq!(first(&said), first(&again), "the first step is the one that was not solved, to the last digit");

    let strict = ["sliding", "time.step=40us", "solver.require_convergence=true"];
    let said = place.done(&strict, &["--from", "hard.bin", "--force", "--dump-unconverged", "none.bin"]);
    assert!(said.contains("none.bin is not written") && !place.at.join("none.bin").exists(), "{said}");

    let message = place.refused(2, &SLIDING, &["--dump-unconverged", "hard.bin"]);
    assert!(message.contains("hard.bin already exists"), "{message}");
    let message = place.refused(2, &SLIDING, &["--dump-unconverged", "nowhere/hard.bin"]);
    assert!(message.contains("no folder nowhere"), "{message}");
    let message = place.refused(2, &SLIDING, &["--force", "--from", "hard.bin", "--checkpoint-every", "x"]);
    assert!(message.contains("checkpoint-every"), "{message}");
    // A state is no checkpoint of a run.
    std::fs::remove_dir_all(place.out()).unwrap();
    std::fs::create_dir(place.out()).unwrap();
    std::fs::copy(place.at.join("hard.bin"), place.out().join("checkpoint.bin")).unwrap();
    let message = place.refused(2, &SLIDING, &AGAIN);
    assert!(message.contains("not a checkpoint of teeter"), "{message}");
}
