//! `teeter tradeoff` from outside: what it says, what it writes, how it exits.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tradeoff").join(test);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn tradeoff(folder: &Path, arguments: &[&str]) -> Output {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-ground.toml");
    let mut all = vec!["tradeoff", scene.to_str().unwrap()];
    all.extend(arguments);
    Command::new(env!("CARGO_BIN_EXE_teeter")).current_dir(folder).args(all).output().unwrap()
}

const SHORT: [&str; 4] = ["--set", "time.end=0.2 s", "--set", "time.step=1 ms"];

fn json(folder: &Path, out: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join(out).join("tradeoff.json")).unwrap()).unwrap()
}

#[test]
fn a_study_writes_its_files_and_says_the_same_again() {
    let folder = folder("files");
    let first = tradeoff(&folder, &SHORT);
    let stderr = String::from_utf8_lossy(&first.stderr).into_owned();
    assert!(first.status.success(), "{stderr}");
    let out = "runs/free-rocking-on-ground-tradeoff";
    for file in ["tradeoff.csv", "tradeoff.json", "tradeoff.html", "scene.toml", "figures/accuracy.svg"] {
        assert!(folder.join(out).join(file).is_file(), "{file}");
    }
    assert!(stderr.contains("tradeoff.html"), "{stderr}");
    let stdout = String::from_utf8(first.stdout).unwrap();
    assert!(
        stdout.starts_with("to be within 10 % over the whole 0.2 s use `--set time.end=\"0.2 s\" --set time.")
            && stdout.lines().next().unwrap().matches("time.step=").count() == 1,
        "{stdout}"
    );
    assert!(
        stdout.contains(" of real time (off by at most ") && stdout.contains("error bars of the reference:"),
        "{stdout}"
    );

    let again = tradeoff(&folder, &[&SHORT[..], &["--out", "again", "--quiet"]].concat());
    assert!(again.status.success() && again.stderr.is_empty());
    let advised = |value: &Value| {
        let all = value["recommendations"].as_array().unwrap().iter();
        all.map(|one| (one["outcome"].clone(), one["set"].clone())).collect::<Vec<_>>()
    };
    let (a, b) = (json(&folder, out), json(&folder, "again"));
    assert_eq!(advised(&a), advised(&b));
    assert_eq!((&a["error_bar"], &a["horizon"], &a["candidates"]), (&b["error_bar"], &b["horizon"], &b["candidates"]));
    assert!(a["error_bar"]["accuracy"].as_f64().unwrap() > 0.0);

    // Each cell of its table has the heading of its column, for windows so narrow that rows are lists; no column is all dashes.
    let page = std::fs::read_to_string(folder.join(out).join("tradeoff.html")).unwrap();
    let (_, table) = page.split_once("aria-labelledby=\"candidates-title\"><table>").unwrap();
    let (table, _) = table.split_once("</table>").unwrap();
    let headings: Vec<&str> =
        table.split("<th scope=\"col\">").skip(1).map(|cell| cell.split_once('<').unwrap().0).collect();
    assert!(headings.starts_with(&["Stage"]) && headings.ends_with(&["CPU time", "By counted work"]), "{headings:?}");
    for heading in headings {
        let cells: Vec<&str> = table.split(&format!("<td data-of=\"{heading}\">")).skip(1).collect();
        assert!(cells.iter().any(|cell| !cell.starts_with('–')), "{heading}");
    }

    // What is advised runs as it stands.
    let set = a["recommendations"][0]["set"].as_object().unwrap();
    let sets: Vec<String> = set.iter().map(|(key, value)| format!("{key}={}", value.as_str().unwrap())).collect();
    let scene = folder.join(out).join("scene.toml");
    let mut arguments = vec!["run", scene.to_str().unwrap(), "--out", "advised", "--quiet"];
    sets.iter().for_each(|set| arguments.extend(["--set", set]));
    let ran = Command::new(env!("CARGO_BIN_EXE_teeter")).current_dir(&folder).args(arguments).status().unwrap();
    assert!(ran.success());
    // And neither `check` nor `run` has a word against it.
    let summary = std::fs::read_to_string(folder.join("advised/summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["warnings"], Value::Array(Vec::new()), "{summary}");
    let mut arguments = vec!["check", scene.to_str().unwrap()];
    sets.iter().for_each(|set| arguments.extend(["--set", set]));
    let checked = Command::new(env!("CARGO_BIN_EXE_teeter")).current_dir(&folder).args(arguments).output().unwrap();
    let stderr = String::from_utf8_lossy(&checked.stderr).into_owned();
    assert!(checked.status.success() && !stderr.contains("warning"), "{stderr}");

    // The commands of the page, in a shell.
    let page = std::fs::read_to_string(folder.join("again/tradeoff.html")).unwrap();
    let commands: Vec<String> = page
        .split("<code>teeter run ")
        .skip(1)
        .map(|piece| {
            let command = piece.split("</code>").next().unwrap();
            let copied = command.replace("<span class=\"word\">", "").replace("</span>", "");
            copied.replace("&quot;", "\"").replace("&#39;", "'").replace("&amp;", "&")
        })
        .collect();
    assert!(commands.len() > 10, "advice, front and table: {}", commands.len());
    #[cfg(unix)]
    for command in &commands[..2] {
        let line = format!("\"$TEETER\" run {command} --out from-the-page --force --quiet");
        let mut ran = Command::new("sh");
        ran.current_dir(&folder).env("TEETER", env!("CARGO_BIN_EXE_teeter")).args(["-c", &line]);
        assert!(ran.status().unwrap().success(), "{line}");
        let scene = std::fs::read_to_string(folder.join("from-the-page/scene.toml")).unwrap();
        assert!(scene.contains("0.2 s"), "the user's own settings are in it: {scene}");
    }

    let blocked = tradeoff(&folder, &[&SHORT[..], &["--out", "again"]].concat());
    assert_eq!(blocked.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&blocked.stderr).contains("--force"));
}

#[test]
fn bad_input_exits_with_2_and_writes_nothing() {
    let folder = folder("bad");
    let output = tradeoff(&folder, &["--set", "time.stepp=1 ms"]);
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("time.stepp") && stderr.contains("did you mean"), "{stderr}");
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn a_study_leaves_the_results_of_a_run_alone_and_says_so_before_its_work() {
    let folder = folder("of-a-run");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-ground.toml");
    let run = |out: &str, more: &[&str]| {
        let mut arguments = vec!["run", scene.to_str().unwrap(), "--out", out, "--quiet", "--set", "time.end=20 ms"];
        arguments.extend(more);
        Command::new(env!("CARGO_BIN_EXE_teeter")).current_dir(&folder).args(arguments).output().unwrap()
    };
    assert!(run("out", &[]).status.success());
    let before = std::fs::read(folder.join("out/scene.toml")).unwrap();
    let refused = tradeoff(&folder, &[&SHORT[..], &["--out", "out", "--force"]].concat());
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.status.code() == Some(2) && told.contains("holds the results of `teeter run`"), "{told}");
    // At once: no progress, no reference was looked for.
    assert!(refused.stdout.is_empty() && std::fs::read(folder.join("out/scene.toml")).unwrap() == before);
    // The other way round too.
    std::fs::create_dir(folder.join("study")).unwrap();
    std::fs::write(folder.join("study/tradeoff.json"), "{}").unwrap();
    let refused = run("study", &["--force"]);
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.status.code() == Some(2) && told.contains("of `teeter tradeoff`"), "{told}");
    // Nothing is left where nothing came of it.
    let bad = tradeoff(&folder, &["--out", "new", "--set", "block.rocker.width=-1 m"]);
    assert!(!bad.status.success() && !folder.join("new").exists());
}
