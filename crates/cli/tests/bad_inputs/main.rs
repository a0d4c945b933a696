//! Inputs that must be refused, each with a message that helps: the rows of the table in `rows.rs`.
//!
//! All messages stand in `messages.txt`, compared byte for byte. After a change on purpose, write
//! it anew and read it as a user would:
//!
//! ```text
//! TEETER_WRITE_MESSAGES=1 cargo test -p teeter --test bad_inputs
//! ```
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod odd_files;
mod rows;

use rows::{Input, PILE, Row, STACKED, rows};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

/// What the table asks for is one second of a release build; this is a debug build beside other
/// tests.
const PATIENCE: Duration = Duration::from_secs(10);

/// The scene that most rows break.
fn base() -> String {
    std::fs::read_to_string(workspace().join("scenarios/free-rocking-on-beam.toml")).unwrap()
}

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// An empty folder of this test's own.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bad-inputs").join(test);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn teeter(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_teeter")).current_dir(folder).args(arguments).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Ground that is shaken by a record.
const SHAKEN: &str = "
[ground]
motion = { acceleration = [\"1 m/s^2\", \"0 m/s^2\"], signal = \"quake\" }

[signal.quake]
shape = \"table\"
file  = \"quake.csv\"
";

/// What every refusal has to be, whatever its words.
fn check_refusal(what: &str, folder: &Path, output: &Output, took: Duration) -> String {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(2), "{what}: {message}");
    assert!(took < PATIENCE, "{what} took {took:?}");
    assert!(!message.contains("panicked") && !message.contains("stack backtrace"), "{what}: {message}");
    assert!(!message.contains(|c: char| c.is_control() && c != '\n'), "{what}: {message:?}");
    // As Rust shows what a type holds.
    let internal = regex::Regex::new("[A-Z][A-Za-z0-9]+ \\{ [a-z_]+: ").unwrap();
    assert!(!internal.is_match(&message), "{what} shows internals: {message}");
    assert!(message.len() < 20_000, "{what}: {} bytes flood the terminal", message.len());
    let given = ["scene.toml", "quake.csv", "shape.csv", "measured.csv"];
    let left: Vec<_> = files(folder).into_iter().filter(|name| !given.contains(&name.as_str())).collect();
    assert!(left.is_empty(), "{what} left {left:?}");
    message
}

/// A scene with pieces replaced.
fn edited(what: &str, mut text: String, changes: &[(&str, &str)]) -> String {
    for (from, to) in changes {
        assert!(text.contains(from), "{what}: no «{from}» in the base scene");
        text = text.replacen(from, to, 1);
    }
    text
}

/// Runs a row; adds to `missing` what its message should have said.
fn run_row(row: &Row, missing: &mut String) -> String {
    let what = format!("row {} ({})", row.number, row.what);
    let folder = folder(&format!("row-{}-{}", row.number, row.what.replace(|c: char| !c.is_ascii_alphanumeric(), "-")));
    let (text, sets): (String, &[&str]) = match &row.input {
        Input::Set(sets) => (base(), sets),
        Input::Edit(changes) => (edited(&what, base(), changes), &[]),
        Input::Stack(changes) => (edited(&what, STACKED.to_owned(), changes), &[]),
        Input::Pile(changes) => (edited(&what, PILE.to_owned(), changes), &[]),
        Input::Text(text) => ((*text).to_owned(), &[]),
        Input::Measured(_) => (base(), &[]),
        Input::Record(record) => {
            if let Some(record) = record {
                std::fs::write(folder.join("quake.csv"), record).unwrap();
            }
            (base() + SHAKEN, &[])
        }
        Input::Shape(shape) => {
            std::fs::write(folder.join("shape.csv"), shape).unwrap();
            let text = base().replace("elements      = 20", "elements = 2");
            (text.replace("\"static\"", "{ file = \"shape.csv\" }"), &[])
        }
    };
    std::fs::write(folder.join("scene.toml"), text).unwrap();
    let mut named = "scene.toml";
    let mut arguments = vec![if row.warns { "check" } else { "run" }, "scene.toml"];
    for set in sets {
        arguments.extend(["--set", set]);
    }
    if let Input::Measured(table) = &row.input {
        std::fs::write(folder.join("measured.csv"), table).unwrap();
        arguments = vec!["fit", "scene.toml", "measured.csv", "--vary", "contact.feet.friction=0.2..0.9"];
        named = "measured.csv";
    }
    let clock = Instant::now();
    let output = teeter(&folder, &arguments);
    let message = if row.warns {
        assert!(output.status.success(), "{what}: {}", stderr(&output));
        stderr(&output)
    } else {
        check_refusal(&what, &folder, &output, clock.elapsed())
    };
    for part in row.says.iter().chain(&[named]) {
        if !message.contains(part) {
            let _ = writeln!(missing, "{what}: «{part}» is missing in\n{message}");
        }
    }
    message
}

#[test]
fn each_row_is_refused_with_a_message_that_helps() {
    let (mut all, mut missing) = (String::new(), String::new());
    for row in rows() {
        let message = run_row(&row, &mut missing);
        let _ = write!(all, "===== {}: {}\n{}\n\n", row.number, row.what, message.trim());
    }
    assert!(missing.is_empty(), "{missing}");
    compare(&all);
}

/// Compares with the messages kept beside this file, or writes them.
fn compare(all: &str) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad_inputs/messages.txt");
    if std::env::var_os("TEETER_WRITE_MESSAGES").is_some() {
        std::fs::write(&file, all).unwrap();
        return;
    }
    let kept = std::fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
    if let Some((number, (new, old))) =
        all.lines().zip(kept.lines().chain(std::iter::repeat(""))).enumerate().find(|(_, (new, old))| new != old)
    {
        panic!(
            "messages.txt differs at line {}:\n  kept: {old}\n  now:  {new}\nIf the change is on purpose: \
             TEETER_WRITE_MESSAGES=1 cargo test -p teeter --test bad_inputs, and read the difference",
            number + 1
        );
    }
    assert_eq!(all.lines().count(), kept.lines().count(), "messages.txt has lines that are no longer told");
}

#[test]
fn five_mistakes_get_five_messages_in_the_order_of_the_file() {
    let folder = folder("five");
    let text = base()
        .replace("step = \"100 us\"", "step = 1e-4")
        .replace("span          = \"36 cm\"", "span = \"36 kg\"")
        .replace("thickness     =", "thicknes =")
        .replace("[block.rocker]\nmaterial = \"aluminium\"", "[block.rocker]\nmaterial = \"steel\"")
        .replace("friction = 0.5", "friction = -0.5");
    std::fs::write(folder.join("scene.toml"), text).unwrap();
    let message = stderr(&teeter(&folder, &["run", "scene.toml"]));
    let titles: Vec<&str> = message.lines().filter(|line| line.starts_with("error")).collect();
    assert_eq!(
        titles,
        [
            "error: time.step = 1e-4",
            "error: beam.table.span = \"36 kg\"",
            "error: beam.table.thicknes: unknown key",
            "error: block.rocker.material = \"steel\"",
            "error: contact.feet.friction = -0.5",
        ]
    );
}

#[test]
fn what_looks_odd_but_is_right_is_accepted() {
    let folder = folder("accepted");
    std::fs::write(folder.join("scene.toml"), base()).unwrap();
    for set in [
        "contact.feet.friction=0",
        "contact.feet.restitution=0",
        "time.theta=1",
        "beam.table.elements=40",
        "block.rocker.tilt=0 deg",
        "block.rocker.height=3 cm",
        "beam.table.damping_ratio.ratio=0",
    ] {
        let output = teeter(&folder, &["check", "scene.toml", "--set", set]);
        assert!(output.status.success(), "{set}: {}", stderr(&output));
        assert!(!stderr(&output).contains("warning"), "{set}: {}", stderr(&output));
    }
    // Right too, but not what one would trust: told, and accepted.
    let set = "beam.table.elements=1";
    let output = teeter(&folder, &["check", "scene.toml", "--set", set]);
    assert!(output.status.success(), "{set}: {}", stderr(&output));
    assert_eq!(stderr(&output).matches("warning").count(), 1, "{set}: {}", stderr(&output));
    assert!(stderr(&output).contains("under-resolved"), "{set}: {}", stderr(&output));
}
