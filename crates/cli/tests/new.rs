//! `teeter new`, `teeter run --watch`, completions and man pages.

#![allow(clippy::unwrap_used)] // a test

mod running;

use running::teeter;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("new-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn every_listed_scene_can_be_written_and_passes_the_check() {
    let folder = folder("all");
    let list = text(&teeter(&folder, &["new", "--list"]).stdout);
    let names: Vec<&str> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let of_scenes = |entry: std::io::Result<std::fs::DirEntry>| {
        let file = entry.unwrap().file_name().into_string().unwrap();
        file.strip_suffix(".toml").map(str::to_owned)
    };
    let mut all: Vec<String> = std::fs::read_dir(scenarios).unwrap().filter_map(of_scenes).collect();
    all.sort();
    assert_eq!(names, all);
    for name in names {
        let file = format!("{name}.toml");
        assert!(teeter(&folder, &["new", &file, "--from", name]).status.success(), "{name}");
        let written = std::fs::read_to_string(folder.join(&file)).unwrap();
        assert!(written.starts_with('#'), "{name} begins with what it shows");
        let checked = teeter(&folder, &["check", &file]);
        assert!(checked.status.success(), "{name}: {}", text(&checked.stderr));
    }
}

#[test]
fn a_scene_with_a_table_brings_it() {
    let folder = folder("table");
    let write = |file: &str, more: &[&str]| {
        teeter(&folder, &[&["new", file, "--from", "rocking-under-earthquake"], more].concat())
    };
    let table = folder.join("rocking-under-earthquake.csv");
    // Neither is lost where one of them is there.
    std::fs::write(&table, "mine").unwrap();
    let refused = write("quake.toml", &[]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("rocking-under-earthquake.csv exists already"));
    assert!(!folder.join("quake.toml").exists() && std::fs::read_to_string(&table).unwrap() == "mine");
    assert!(write("quake.toml", &["--force"]).status.success());
    // The table of the first copy serves the second.
    let second = write("second.toml", &[]);
    assert!(second.status.success() && text(&second.stderr).contains("with its table"), "{second:?}");
    assert!(teeter(&folder, &["check", "second.toml"]).status.success());
    let alone = write("-", &[]);
    assert_eq!(alone.status.code(), Some(2));
    assert!(text(&alone.stderr).contains("needs its table"), "{alone:?}");
}

#[test]
fn a_file_that_exists_is_not_replaced() {
    let folder = folder("exists");
    std::fs::write(folder.join("mine.toml"), "mine").unwrap();
    let refused = teeter(&folder, &["new", "mine.toml"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("exists already; --force replaces it"));
    assert_eq!(std::fs::read_to_string(folder.join("mine.toml")).unwrap(), "mine");
    let unknown = teeter(&folder, &["new", "x.toml", "--from", "dropp"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(text(&unknown.stderr).contains("did you mean `drop`?"));
    assert!(!folder.join("x.toml").exists());
    // Written beside and renamed: what the old file's second name leads to is as it was.
    std::fs::hard_link(folder.join("mine.toml"), folder.join("second.toml")).unwrap();
    assert!(teeter(&folder, &["new", "mine.toml", "--force"]).status.success());
    assert_eq!(std::fs::read_to_string(folder.join("second.toml")).unwrap(), "mine");
    let names: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names.len(), 2, "{names:?}");
    assert!(std::fs::read_to_string(folder.join("mine.toml")).unwrap().contains("[block.rocker]"));
}

#[test]
fn shells_and_man_know_every_command() {
    let folder = folder("shell");
    let commands = ["run", "check", "new", "compare", "fit", "sweep", "tradeoff", "solve", "solvers", "schema"];
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = text(&teeter(&folder, &["completions", shell]).stdout);
        assert!(commands.iter().all(|command| script.contains(command)) && script.contains("vary"), "{shell}");
    }
    assert!(teeter(&folder, &["man", "pages"]).status.success());
    for command in commands {
        let page = std::fs::read_to_string(folder.join(format!("pages/teeter-{command}.1"))).unwrap();
        assert!(page.contains(".SH NAME") && page.contains(".SH OPTIONS"), "{command}");
    }
}

/// Waits for a condition.
fn within(limit: Duration, mut condition: impl FnMut() -> bool) -> bool {
    let begin = Instant::now();
    while begin.elapsed() < limit {
        if condition() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    false
}

#[cfg(unix)]
#[test]
fn a_watched_scene_runs_again_when_it_changes() {
    let folder = folder("watch");
    let scene = folder.join("drop.toml");
    assert!(teeter(&folder, &["new", "drop.toml", "--from", "drop"]).status.success());
    let mut child = Command::new(env!("CARGO_BIN_EXE_teeter"))
        .current_dir(&folder)
        .args(["run", "drop.toml", "--out", "out", "--watch", "--no-report"])
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let as_run = || std::fs::read_to_string(folder.join("out/scene.toml")).unwrap_or_default();
    let ended = || folder.join("out/summary.json").exists();
    let limit = Duration::from_secs(60);
    assert!(within(limit, || ended() && as_run().contains("restitution = 0.8")), "the first run");
    let text = std::fs::read_to_string(&scene).unwrap();
    // A mistake is told, and waited for to be mended.
    std::fs::write(&scene, text.replace("restitution = 0.8", "restitution = 8")).unwrap();
    std::thread::sleep(Duration::from_millis(700));
    assert!(child.try_wait().unwrap().is_none(), "it goes on after a mistake");
    std::fs::write(&scene, text.replace("restitution = 0.8", "restitution = 0.75")).unwrap();
    assert!(within(limit, || ended() && as_run().contains("restitution = 0.75")), "the second run");
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    // A shell that starts tests in the background may have them ignore the signal.
    let ended = within(limit, || child.try_wait().unwrap().is_some());
    child.kill().unwrap();
    assert!(ended, "it ends by SIGINT, unless this is ignored here");
    assert_eq!(child.wait().unwrap().code(), Some(130));
}
