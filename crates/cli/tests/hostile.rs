//! What a run must not do to other files, and what it must not take from them.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

const SCENE: &str = "# a comment of the user\n[time]\nend = '10 ms'\nstep = '1 ms'\n[ground]\n[material.oak]\n\
    density = '700 kg/m^3'\n[block.cube]\nmaterial = 'oak'\nwidth = '1 m'\nheight = '1 m'\ndepth = '1 m'\non = 'ground'\n\
    at = '0 m'\n[contact.floor]\nbetween = ['cube', 'ground']\nfriction = 0.5\n";

/// The same with a force from a table.
const PUSHED: &str = "[signal.push]\nshape = 'table'\nfile = 'results/impacts.csv'\n[force.hand]\non = 'cube'\n\
    signal = 'push'\nforce = ['1 N', '0 N']\n";

fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hostile").join(test);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("scene.toml"), SCENE).unwrap();
    folder
}

fn teeter(at: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_teeter")).current_dir(at).args(arguments).stdin(Stdio::null()).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn refused(at: &Path, arguments: &[&str], reason: &str) {
    let output = teeter(at, arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(message.contains(reason), "{arguments:?}: {message}");
}

fn done(at: &Path, arguments: &[&str]) {
    let output = teeter(at, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", stderr(&output));
}

#[test]
fn a_folder_that_a_run_writes_to_is_refused_to_a_second_one() {
    let at = folder("two-runs");
    let long = ["--set", "time.end=100 s", "--set", "time.step=1 us", "--set", "output.every=10 ms"];
    let mut first = Command::new(env!("CARGO_BIN_EXE_teeter"))
        .current_dir(&at)
        .args(["run", "scene.toml", "--out", "out"])
        .args(long)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    for _ in 0..2000 {
        if at.join("out/energy.csv").exists() {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let holder = format!("process {} is writing results to out", first.id());
    refused(&at, &["run", "scene.toml", "--out", "out", "--force"], &holder);
    // Neither --force nor --resume would be a way.
    refused(&at, &["run", "scene.toml", "--out", "out"], &holder);
    first.kill().unwrap();
    first.wait().unwrap();
    // What it left is no reason to wait for ever.
    done(&at, &["run", "scene.toml", "--out", "out", "--force"]);
    assert!(!at.join("out/.teeter.lock").exists());
}

#[test]
fn a_folder_that_a_study_writes_to_is_refused_to_a_second_one() {
    let at = folder("two-studies");
    let sweep = "scene = \"scene.toml\"\n[grid]\ntime.end = [\"100 s\", \"101 s\"]\ntime.step = [\"1 us\"]\n";
    std::fs::write(at.join("sweep.toml"), sweep).unwrap();
    let mut first = Command::new(env!("CARGO_BIN_EXE_teeter"))
        .current_dir(&at)
        .args(["sweep", "sweep.toml", "--out", "out"])
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    for _ in 0..2000 {
        if at.join("out/journal.csv").exists() {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let holder = format!("process {} is writing results to out", first.id());
    for options in [&[][..], &["--resume"], &["--force"]] {
        let arguments = [&["sweep", "sweep.toml", "--out", "out"], options].concat();
        refused(&at, &arguments, &holder);
    }
    first.kill().unwrap();
    first.wait().unwrap();
    refused(&at, &["sweep", "sweep.toml", "--out", "out"], "--resume goes on with it");
}

#[test]
fn a_run_never_replaces_what_it_reads() {
    let at = folder("own-input");
    std::fs::create_dir(at.join("sc")).unwrap();
    std::fs::rename(at.join("scene.toml"), at.join("sc/scene.toml")).unwrap();
    refused(&at, &["run", "sc/scene.toml", "--out", "sc", "--force"], "is read by this command");
    // By another name, through a link to the folder, and through one to the file.
    symlink("sc", at.join("link")).unwrap();
    refused(&at, &["run", "sc/scene.toml", "--out", "link/../link", "--force"], "is read by this command");
    symlink("sc/scene.toml", at.join("other.toml")).unwrap();
    refused(&at, &["run", "other.toml", "--out", "sc", "--force"], "is read by this command");
    refused(&at, &["tradeoff", "sc/scene.toml", "--out", "sc", "--force"], "is read by this command");
    refused(
        &at,
        &["run", "sc/scene.toml", "--out", "out", "--dump-unconverged", "sc/scene.toml", "--force"],
        "is read by this command",
    );
    assert_eq!(std::fs::read_to_string(at.join("sc/scene.toml")).unwrap(), SCENE);
    // A file that the scene names.
    std::fs::write(at.join("pushed.toml"), format!("{SCENE}{PUSHED}")).unwrap();
    std::fs::create_dir(at.join("results")).unwrap();
    std::fs::write(at.join("results/impacts.csv"), "t,f\n0,1\n1,2\n").unwrap();
    refused(&at, &["run", "pushed.toml", "--out", "results", "--force"], "is read by this command");
    assert_eq!(std::fs::read_to_string(at.join("results/impacts.csv")).unwrap(), "t,f\n0,1\n1,2\n");
}

#[test]
fn results_are_not_written_through_links() {
    let at = folder("links");
    std::fs::create_dir_all(at.join("out")).unwrap();
    std::fs::create_dir_all(at.join("mine")).unwrap();
    std::fs::write(at.join("mine/phi.svg"), "mine").unwrap();
    symlink("../mine", at.join("out/figures")).unwrap();
    refused(&at, &["run", "scene.toml", "--out", "out", "--force"], "is a link");
    assert_eq!(std::fs::read_to_string(at.join("mine/phi.svg")).unwrap(), "mine");
    std::fs::remove_file(at.join("out/figures")).unwrap();
    // A link in the place of a file is replaced, not followed, wherever it leads.
    for (name, target) in
        [("energy.csv", "../mine/kept"), ("summary.json", "../mine/kept"), ("impacts.csv", "../mine/new")]
    {
        symlink(target, at.join("out").join(name)).unwrap();
    }
    std::fs::write(at.join("mine/kept"), "mine").unwrap();
    refused(&at, &["run", "scene.toml", "--out", "out"], "holds results already");
    done(&at, &["run", "scene.toml", "--out", "out", "--force"]);
    assert_eq!(std::fs::read_to_string(at.join("mine/kept")).unwrap(), "mine");
    assert!(!at.join("mine/new").exists());
    assert!(at.join("out/energy.csv").symlink_metadata().unwrap().is_file());
    symlink("nowhere", at.join("dangling")).unwrap();
    refused(&at, &["run", "scene.toml", "--out", "dangling"], "is a link to nowhere, which is not there");
}

/// A device that is always full.
#[test]
#[cfg(target_os = "linux")]
fn results_that_standard_output_does_not_take_are_a_failure() {
    let at = folder("full-output");
    let problem = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benches/problems/row");
    let problem = problem.to_str().unwrap();
    for arguments in [
        &["schema"][..],
        &["schema", "--format", "markdown"],
        &["check", "scene.toml"],
        &["solvers"],
        &["solve", problem],
        &["solve", problem, "--json"],
        &["--help"],
        &["run", "--help"],
        &["--version"],
    ] {
        let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_teeter"))
            .current_dir(&at)
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(full)
            .stderr(Stdio::piped())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains("can't write to standard output"), "{arguments:?}: {}", stderr(&output));
    }
}

#[test]
fn what_is_no_state_is_refused_before_it_is_read_or_waited_for() {
    let at = folder("no-state");
    // Sparse: no room on disk, but more than there is of memory.
    std::fs::File::create(at.join("zeros")).unwrap().set_len(200_000_000_000).unwrap();
    for more in [&[][..], &["--checkpoint-every", "1 ms"]] {
        let arguments = [&["run", "scene.toml", "--out", "out", "--from", "zeros"], more].concat();
        refused(&at, &arguments, "zeros is not a state or checkpoint of teeter");
    }
    assert!(Command::new("mkfifo").arg(at.join("pipe")).status().unwrap().success());
    refused(
        &at,
        &["run", "scene.toml", "--out", "out", "--from", "pipe"],
        "pipe is not a state or checkpoint of teeter",
    );
    refused(&at, &["run", "scene.toml", "--out", "out", "--from", "."], "can't read .:");
}

#[test]
fn solutions_and_profiles_are_replaced_by_force_only() {
    let at = folder("solve-force");
    let problem = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benches/problems/row");
    let problem = problem.to_str().unwrap();
    done(&at, &["solve", problem, "--solutions", "impulses"]);
    let of = |name: &str| std::fs::read(at.join(name)).unwrap();
    let file = std::fs::read_dir(at.join("impulses")).unwrap().next().unwrap().unwrap().path();
    std::fs::write(&file, "mine").unwrap();
    refused(&at, &["solve", problem, "--solutions", "impulses"], "--force replaces them");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "mine");
    // Those of another solver are other files.
    done(&at, &["solve", problem, "--solver", "pgs", "--solutions", "impulses"]);
    done(&at, &["solve", problem, "--solutions", "impulses", "--force"]);
    assert_ne!(std::fs::read_to_string(&file).unwrap(), "mine");
    let profile = ["solve", problem, "--solver", "auto", "--profile", "profile"];
    done(&at, &profile);
    std::fs::write(at.join("profile/profile.md"), "mine").unwrap();
    refused(&at, &profile, "--force replaces them");
    assert_eq!(of("profile/profile.md"), b"mine");
    done(&at, &[&profile[..], &["--force"]].concat());
    assert_ne!(of("profile/profile.md"), b"mine");
}

#[test]
fn titles_are_lines_that_people_can_read() {
    let at = folder("titles");
    let with = |title: &str| std::fs::write(at.join("scene.toml"), format!("title = \"{title}\"\n{SCENE}")).unwrap();
    for (title, reason) in [
        ("\\u001b[2J gone", "U+001B"),
        ("a \\u202e b", "U+202E"),
        ("nul \\u0000", "U+0000"),
        ("two\\nlines", "U+000A"),
        (&"x".repeat(1_000_000)[..], "has 1000000 characters"),
    ] {
        with(title);
        for command in ["check", "run"] {
            refused(&at, &[command, "scene.toml"], reason);
            let message = stderr(&teeter(&at, &[command, "scene.toml"]));
            assert!(message.len() < 2000 && !message.contains(['\u{1b}', '\u{202e}', '\0']), "{message:?}");
        }
    }
    with(&"x".repeat(200));
    done(&at, &["check", "scene.toml"]);
}

#[test]
fn so_many_errors_that_reading_ends_are_a_lower_bound() {
    let at = folder("many-errors");
    let keys: String = (0..100_000).map(|k| format!("unknown{k} = 1\n")).collect();
    std::fs::write(at.join("scene.toml"), keys).unwrap();
    refused(&at, &["check", "scene.toml"], "and at least 1");
}

/// The files of a folder, by their paths in it.
fn files_of(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { folders.push(path) } else { files.push(path.strip_prefix(folder).unwrap().to_owned()) }
        }
    }
    files.sort();
    files
}

#[test]
fn force_leaves_nothing_of_an_earlier_run_but_what_others_put_there() {
    let at = folder("stale");
    // It slides, falls and turns on ground that moves: figures of each.
    let moving = SCENE.replace(
        "on = 'ground'\nat = '0 m'",
        "position = ['0 m', '2 m']\nangle = '10 deg'\nvelocity = ['1 m/s', '0 m/s']",
    );
    std::fs::write(at.join("moving.toml"), moving).unwrap();
    done(&at, &["run", "moving.toml", "--out", "out", "--vtk"]);
    let before = files_of(&at.join("out"));
    for figure in ["figures/vx.svg", "figures/phase_x.svg", "vtk/picture-0000.vtu"] {
        assert!(before.contains(&figure.into()), "{figure} is not among {before:?}");
    }
    std::fs::write(at.join("out/figures/mine.svg"), "mine").unwrap();
    done(&at, &["run", "scene.toml", "--out", "out", "--force"]);
    done(&at, &["run", "scene.toml", "--out", "fresh"]);
    let mut wanted = files_of(&at.join("fresh"));
    wanted.push("figures/mine.svg".into());
    wanted.sort();
    assert_eq!(files_of(&at.join("out")), wanted);
}
