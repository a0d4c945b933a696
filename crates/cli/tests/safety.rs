//! What is on disk, and what is said, when a run doesn't end as planned.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// A run of some ten million steps: far longer than the test lets it go on.
fn long_run(out: &Path) -> Command {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-ground.toml");
    let mut command = Command::new(env!("CARGO_BIN_EXE_teeter"));
    command.arg("run").arg(scene).arg("--out").arg(out);
    command.args(["--set", "time.step=100 ns", "--set", "output.every=20 us"]);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Every table ends with a whole row, as wide as its header.
fn rows_are_whole(out: &Path) -> usize {
    count_rows(out, |file, text| assert!(text.ends_with('\n'), "{file} ends in half a row"))
}

/// The rows of all tables, as wide as their headers; `end` judges what comes after the last line
/// end.
fn count_rows(out: &Path, end: impl Fn(&str, &str)) -> usize {
    let mut rows = 0;
    for file in ["trajectory.csv", "contacts.csv", "impacts.csv", "energy.csv"] {
        let text = std::fs::read_to_string(out.join(file)).unwrap();
        end(file, &text);
        let text = &text[..text.rfind('\n').map_or(0, |at| at + 1)];
        let width = text.lines().next().unwrap().split(',').count();
        assert!(text.lines().all(|line| line.split(',').count() == width), "{file}");
        rows += text.lines().count() - 1;
    }
    rows
}

/// Waits until a run has written rows, and signals it.
fn signalled(out: &Path, signal: &str) -> Output {
    let child = long_run(out).spawn().unwrap();
    let table = out.join("trajectory.csv");
    for _ in 0..2000 {
        if std::fs::metadata(&table).is_ok_and(|data| data.len() > 1000) {
            break;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    let id = child.id().to_string();
    assert!(Command::new("kill").args([signal, &id]).status().unwrap().success());
    child.wait_with_output().unwrap()
}

/// Ctrl-C; what a batch system sends; what a terminal sends that closes.
#[test]
fn a_signal_ends_a_run_with_whole_rows_and_a_summary_that_says_so() {
    for signal in ["-INT", "-TERM", "-HUP"] {
        let out = folder(&format!("signal{signal}"));
        let output = signalled(&out, signal);
        assert_eq!(output.status.code(), Some(130), "{signal}: {}", stderr(&output));
        assert!(stderr(&output).contains("interrupted"), "{signal}: {}", stderr(&output));
        assert!(rows_are_whole(&out) > 0);
        let summary: Value = serde_json::from_str(&std::fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
        assert_eq!(summary["ended"], "interrupted");
        // The last row is the last step.
        let trajectory = std::fs::read_to_string(out.join("trajectory.csv")).unwrap();
        let t: f64 = trajectory.lines().last().unwrap().split(',').next().unwrap().parse().unwrap();
        assert_eq!(Some(t), summary["t"].as_f64());
        assert_eq!(hidden(&out), [""; 0], "{signal}");
    }
}

/// Files that are there until something is complete.
fn hidden(out: &Path) -> Vec<String> {
    let names = std::fs::read_dir(out).unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
    names.filter(|name| name.starts_with('.')).collect()
}

/// Who starts a program with `nohup` wants it to outlive the terminal.
#[test]
#[cfg(target_os = "linux")]
fn a_signal_that_was_ignored_at_the_start_stays_ignored() {
    let out = folder("nohup");
    let mut inner = long_run(&out);
    inner.args(["--set", "time.end=20 ms"]);
    let mut child = Command::new("sh");
    child.args(["-c", "trap '' HUP; exec \"$0\" \"$@\""]).arg(inner.get_program()).args(inner.get_args());
    let child = child.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    for _ in 0..2000 {
        if out.join("energy.csv").exists() {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-HUP", &id]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
}

#[test]
fn a_killed_run_leaves_whole_rows_and_nothing_that_looks_complete() {
    let out = folder("kill-9");
    let output = signalled(&out, "-KILL");
    assert_eq!(output.status.code(), None);
    // The system may cut the write that a kill falls into: then, and only then, there is half a row
    // at the end.
    assert!(count_rows(&out, |_, _| ()) > 0);
    assert!(!out.join("summary.json").exists());
    // The lock is the next run's to take over.
    assert_eq!(hidden(&out), [".teeter.lock"]);
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let out = folder("pipe");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/sliding.toml");
    // Many warnings for a reader that takes one.
    let script = r#""$0" run "$1" --out "$2/out" --set solver.method=pgs --set solver.max_iterations=1 \
        --set solver.tolerance=1e-15 2>&1 >/dev/null | head -n 1; test "${PIPESTATUS[0]}" -eq 0"#;
    let output =
        Command::new("bash").args(["-c", script, env!("CARGO_BIN_EXE_teeter")]).arg(&scene).arg(&out).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 1);
    assert!(stderr(&output).is_empty(), "{}", stderr(&output));
    assert!(out.join("out/summary.json").exists());
}

#[test]
#[cfg(target_os = "linux")]
fn a_folder_that_cant_be_made_is_bad_input_before_the_run() {
    // One that can't be made, and one that is there but can't be written.
    for out in ["/proc/teeter/out", "/proc"] {
        let output = long_run(Path::new(out)).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains(out), "{}", stderr(&output));
    }
}

/// A file system of 64 kB, while this lives.
#[cfg(target_os = "linux")]
struct SmallDisk(PathBuf);

#[cfg(target_os = "linux")]
impl SmallDisk {
    fn mount(at: PathBuf) -> Option<Self> {
        let mounted = Command::new("mount").args(["-t", "tmpfs", "-o", "size=64k", "tmpfs"]).arg(&at).output();
        mounted.is_ok_and(|output| output.status.success()).then_some(Self(at))
    }
}

#[cfg(target_os = "linux")]
impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).output();
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_ends_a_run_with_the_reason_and_whole_rows() {
    let Some(disk) = SmallDisk::mount(folder("disk")) else {
        eprintln!("skipped: a small file system can't be mounted here (it takes root)");
        return;
    };
    let out = disk.0.join("out");
    let output = long_run(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("No space left"), "{}", stderr(&output));
    assert!(stderr(&output).contains("the tables contain the rows for which there was space"), "{}", stderr(&output));
    rows_are_whole(&out);
    // There may be room for a summary; it must not look like that of a complete run.
    if let Ok(text) = std::fs::read_to_string(out.join("summary.json")) {
        let summary: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(summary["ended"], "disk-full");
    }
}
