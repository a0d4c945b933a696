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

#[test]
fn files_that_are_not_of_a_run_stay_and_are_told() {
    let folder = folder("foreign");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-ground.toml");
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_teeter"));
        command.arg("run").arg(&scene).args(["--out", "out", "--set", "time.end=10 ms"]).args(more);
        command.current_dir(&folder).output().unwrap()
    };
    std::fs::create_dir(folder.join("out")).unwrap();
    std::fs::write(folder.join("out/thesis.tex"), "mine").unwrap();
    let first = run(&[]);
    assert!(first.status.success(), "{}", stderr(&first));
    assert!(
        stderr(&first).contains("out also holds `thesis.tex`, which is not of a run and stays"),
        "{}",
        stderr(&first)
    );
    std::fs::write(folder.join("out/notes.txt"), "mine").unwrap();
    let again = run(&["--force"]);
    assert!(again.status.success(), "{}", stderr(&again));
    let told = stderr(&again);
    assert!(told.contains("out also holds 2 files and folders that are not of a run, such as `notes.txt`"), "{told}");
    assert_eq!(std::fs::read_to_string(folder.join("out/thesis.tex")).unwrap(), "mine");
}

#[test]
fn a_scene_from_standard_input_finds_its_files_by_base() {
    let folder = folder("base");
    let data = folder.join("data");
    std::fs::create_dir(&data).unwrap();
    std::fs::write(data.join("push.csv"), "0,0\n0.01,1\n1,0\n").unwrap();
    let scenario = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-ground.toml");
    let scene = std::fs::read_to_string(scenario).unwrap()
        + "\n[signal.push]\nshape = \"table\"\nfile = \"push.csv\"\n\n[force.push]\non = \"rocker\"\nforce = [\"10 mN\", \"0 N\"]\nsignal = \"push\"\n";
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_teeter"));
        command.args(["run", "-", "--set", "time.end=10 ms", "--force"]).args(more).current_dir(&folder);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        std::io::Write::write_all(&mut child.stdin.take().unwrap(), scene.as_bytes()).unwrap();
        child.wait_with_output().unwrap()
    };
    let lost = run(&[]);
    assert_eq!(lost.status.code(), Some(2), "{}", stderr(&lost));
    assert!(stderr(&lost).contains("push.csv"), "{}", stderr(&lost));
    let found = run(&["--base", "data"]);
    assert!(found.status.success(), "{}", stderr(&found));
    // Its scene finds the file from where it stands.
    let written = std::fs::read_to_string(folder.join("runs/stdin/scene.toml")).unwrap();
    assert!(written.contains("data/push.csv"), "{written}");
}
