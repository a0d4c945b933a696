//! The program from outside: what it writes, what it says, how it exits.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod running;

use running::teeter;
use serde_json::Value;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn scenario(name: &str) -> PathBuf {
    workspace().join("scenarios").join(format!("{name}.toml"))
}

/// An empty folder of this test's own.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn run(folder: &Path, name: &str, arguments: &[&str]) -> Output {
    let file = scenario(name);
    let mut all = vec!["run", file.to_str().unwrap(), "--out", "out"];
    all.extend(arguments);
    teeter(folder, &all)
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn table(path: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    (lines.next().unwrap(), lines.collect())
}

fn summary(folder: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join("out/summary.json")).unwrap()).unwrap()
}

const FILES: [&str; 9] = [
    "columns.json",
    "contacts.csv",
    "energy.csv",
    "figures",
    "impacts.csv",
    "report.html",
    "scene.toml",
    "summary.json",
    "trajectory.csv",
];

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_run_writes_its_files_with_the_columns_of_the_contract() {
    let folder = folder("files");
    let sets = ["--set", "beam.table.probes=['9 cm']", "--set", "time.scheme=moreau-jean"];
    let output = run(&folder, "free-rocking-on-beam", &sets);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(output.stdout.is_empty(), "results go to files");
    assert_eq!(files(&folder.join("out")), FILES);
    let header = |file: &str| table(&folder.join("out").join(file)).0.join(",");
    assert_eq!(
        header("trajectory.csv"),
        "t,rocker.x,rocker.y,rocker.phi,rocker.vx,rocker.vy,rocker.omega,table.w_mid,table.v_mid,table.w@0.09"
    );
    assert_eq!(header("contacts.csv"), "t,contact,a,b,point,gap,p_n,p_t,u_n,u_t,state,slip");
    assert_eq!(header("impacts.csv"), "t,contact,a,b,point,impulse_n,impulse_t,u_n_before,u_n_after");
    assert_eq!(
        header("energy.csv"),
        "t,kinetic,elastic,gravity,external,contact,friction,viscous,numerical,projection,residual"
    );
    let rows = table(&folder.join("out/trajectory.csv")).1;
    assert_eq!(rows.len(), 501, "t = 0 and every millisecond");
    assert_eq!((rows[0][0].as_str(), rows[500][0].as_str()), ("0.0", "0.5"));

    let summary = summary(&folder);
    for key in [
        "title",
        "version",
        "scheme",
        "dt",
        "steps",
        "wall_seconds",
        "us_per_step",
        "contact",
        "max_penetration",
        "energy",
        "impacts",
        "crossings",
        "peaks",
        "horizon",
        "ended",
        "model",
        "warnings",
    ] {
        assert!(summary.get(key).is_some(), "{key}");
    }
    assert_eq!((summary["ended"].as_str(), summary["steps"].as_u64()), (Some("complete"), Some(5000)));
    assert!(summary["energy"]["largest_residual"].as_f64().unwrap() <= 1e-12);
    assert_eq!(summary["contact"]["unconverged_steps"], 0);
    let peaks: Vec<f64> = summary["peaks"].as_array().unwrap().iter().map(|p| p["phi"].as_f64().unwrap()).collect();
    let crossings = summary["crossings"].as_array().unwrap();
    assert_eq!((peaks.len(), crossings.len()), (3, 3), "the release is the first peak, the last is unfinished");
    assert!((peaks[0] - 5_f64.to_radians()).abs() < 1e-15);
    // From the independent implementation.
    assert!((crossings[0]["t"].as_f64().unwrap() - 0.10629444291395758).abs() < 1e-11);
}

#[test]
fn the_impulses_of_the_contact_table_add_up_to_the_change_of_momentum() {
    let folder = folder("momentum");
    assert!(run(&folder, "free-rocking-on-ground", &[]).status.success());
    let (_, motion) = table(&folder.join("out/trajectory.csv"));
    let (_, contacts) = table(&folder.join("out/contacts.csv"));
    let number = |text: &String| text.parse::<f64>().unwrap();
    let (mut p_n, mut p_t) = (0.0, 0.0);
    for row in &contacts {
        p_n += number(&row[6]);
        p_t += number(&row[7]);
    }
    let last = motion.last().unwrap();
    let (t, m) = (number(&last[0]), 0.32805);
    assert!((m * number(&last[4]) - p_t).abs() < 1e-12);
    assert!((m * number(&last[5]) - (p_n - m * 9.81 * t)).abs() < 1e-11);
    assert!(contacts.iter().all(|row| row[10] == "stick" || row[10] == "open"), "it never slides on µ = 0.5");
}

#[test]
fn the_scene_as_run_gives_the_same_bytes() {
    let restitution = "contact.base.restitution=0.5";
    same_bytes(&folder("again"), "drop", &["--set", "time.end=0.3 s", "--set", restitution]);
    let modes = ["--set", "beam.table.model=modes", "--set", "beam.table.modes={ from = '10 cm', to = '26 cm' }"];
    same_bytes(
        &folder("again-in-modes"),
        "free-rocking-on-beam",
        &[&modes[..], &["--set", "time.end=0.15 s"]].concat(),
    );
}

/// Runs a scenario, and the scene as run again.
fn same_bytes(folder: &Path, scenario: &str, sets: &[&str]) {
    assert!(run(folder, scenario, sets).status.success());
    let again = teeter(folder, &["run", "out/scene.toml", "--out", "again", "--quiet"]);
    assert!(again.status.success() && again.stderr.is_empty(), "{}", stderr(&again));
    for file in FILES.iter().filter(|file| !["summary.json", "figures"].contains(file)) {
        let read = |run: &str| std::fs::read(folder.join(run).join(file)).unwrap();
        assert_eq!(read("out"), read("again"), "{file}");
    }
    let stable = |run: &str| {
        let text = std::fs::read_to_string(folder.join(run).join("summary.json")).unwrap();
        let timing = |line: &&str| !line.contains("wall_seconds") && !line.contains("us_per_step");
        text.lines().filter(timing).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(stable("out"), stable("again"));
}

#[test]
fn bad_scenes_exit_with_2_and_write_nothing() {
    let folder = folder("bad");
    let cases: [(&[&str], &[&str]); 4] = [
        (&["--set", "beam.table.thicknes=2 mm"], &["beam.table.thicknes", "did you mean", "thickness"]),
        (&["--set", "beam.table.span=36 kg"], &["beam.table.span", "length", "mass"]),
        (&["--set", "time.step=0 s"], &["time.step", "greater than 0 s"]),
        (&["--set", "solver.method=magic"], &["solver.method", "auto", "pgs", "enumeration"]),
    ];
    for (arguments, parts) in cases {
        let output = run(&folder, "free-rocking-on-beam", arguments);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        for part in parts {
            assert!(message.contains(part), "«{part}» is missing in:\n{message}");
        }
        assert!(files(&folder).is_empty(), "{:?}", files(&folder));
    }
    for (file, part) in [("nowhere.toml", "no such file"), (".", "is a folder")] {
        let output = teeter(&folder, &["run", file]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(part), "{}", stderr(&output));
    }
    assert_eq!(teeter(&folder, &["run"]).status.code(), Some(2), "usage");
    assert_eq!(teeter(&folder, &["rum", "x.toml"]).status.code(), Some(2), "usage");
}

#[test]
fn results_are_not_replaced_without_force() {
    let folder = folder("force");
    let short = ["--set", "time.end=10 ms"];
    assert!(run(&folder, "sliding", &short).status.success());
    let again = run(&folder, "sliding", &short);
    assert_eq!(again.status.code(), Some(2));
    assert!(stderr(&again).contains("--force"), "{}", stderr(&again));
    assert!(run(&folder, "sliding", &["--set", "time.end=10 ms", "--force"]).status.success());
    std::fs::write(folder.join("file"), "").unwrap();
    let file = teeter(&folder, &["run", scenario("sliding").to_str().unwrap(), "--out", "file"]);
    assert_eq!(file.status.code(), Some(2));
    assert!(stderr(&file).contains("not a folder"));
}

#[test]
fn an_unsolved_step_is_warned_of_and_with_require_convergence_ends_the_run() {
    let folder = folder("unconverged");
    // One sweep of Gauss–Seidel can't solve two coupled contacts.
    let hard = ["--set", "solver.method=pgs", "--set", "solver.max_iterations=1", "--set", "solver.tolerance=1e-14"];
    let output = run(&folder, "sliding", &hard);
    assert!(output.status.success(), "{}", stderr(&output));
    let message = stderr(&output);
    assert!(message.contains("2 contacts") && message.contains("residual") && message.contains("t = "), "{message}");
    assert!(message.matches("was not solved").count() <= 6, "rate-limited:\n{message}");
    let unconverged = summary(&folder)["contact"]["unconverged_steps"].as_u64().unwrap();
    assert!(unconverged > 10);
    let warning = &summary(&folder)["warnings"][0];
    assert_eq!((warning["code"].as_str(), warning["count"].as_u64()), (Some("unconverged"), Some(unconverged)));

    let single = run(&folder, "sliding", &[&hard[..], &["--force", "--set", "time.end=1 ms"]].concat());
    assert!(stderr(&single).contains("  1 step not solved to tolerance\n"), "{}", stderr(&single));

    let strict = [&hard[..], &["--force", "--set", "solver.require_convergence=true"]].concat();
    let output = run(&folder, "sliding", &strict);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("the run ended at t = "), "{}", stderr(&output));
    let summary = summary(&folder);
    assert_eq!(summary["ended"], "unconverged");
    let (_, rows) = table(&folder.join("out/trajectory.csv"));
    assert_eq!(rows.len() as u64, summary["steps"].as_u64().unwrap() + 1, "all rows so far");

    // With few rows, the step that was not solved is one all the same.
    let sparse = [&strict[..], &["--set", "output.every=0.1 s"]].concat();
    assert_eq!(run(&folder, "sliding", &sparse).status.code(), Some(1));
    let (_, rows) = table(&folder.join("out/trajectory.csv"));
    let (_, contacts) = table(&folder.join("out/contacts.csv"));
    let t = summary["t"].as_f64().unwrap().to_string();
    assert_eq!((&rows.last().unwrap()[0], &contacts.last().unwrap()[0]), (&t, &t));
}

/// As in the list below it.
#[test]
fn names_in_the_heading_of_warnings_are_code() {
    let folder = folder("warned-of-a-jolt");
    let motion = "ground.motion={ displacement = ['15 mm', '0 m'], signal = 's' }";
    let signal = "signal.s={ shape = 'harmonic', frequency = '4 Hz' }";
    let output = run(&folder, "free-rocking-on-ground", &["--set", "time.end=10 ms", "--set", motion, "--set", signal]);
    assert!(output.status.success(), "{}", stderr(&output));
    let page = std::fs::read_to_string(folder.join("out/report.html")).unwrap();
    let heading = page.split_once("<summary><b>Warning</b>: ").unwrap().1.split_once("</summary>").unwrap().0;
    assert!(heading.contains("but <code>rocker</code> on it starts at rest") && !heading.contains('`'), "{heading}");
}

#[test]
fn a_scene_from_standard_input() {
    let folder = folder("stdin");
    let mut child = Command::new(env!("CARGO_BIN_EXE_teeter"))
        .current_dir(&folder)
        .args(["run", "-", "--quiet"])
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(&std::fs::read(scenario("sliding")).unwrap()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(files(&folder.join("runs/stdin")), FILES);
}

#[test]
fn a_scene_that_names_a_file_runs_again_from_its_results_to_the_same_bytes() {
    let folder = folder("record");
    std::fs::create_dir_all(folder.join("scenes/records")).unwrap();
    std::fs::write(folder.join("scenes/records/quake.csv"), "t,a\n0,0\n0.05,2\n0.1,-2\n0.2,0\n").unwrap();
    let shaken = "[ground]\nmotion = { acceleration = [\"1 m/s^2\", \"0 m/s^2\"], signal = \"quake\" }\n\
                  [signal.quake]\nshape = \"table\"\nfile = \"records/quake.csv\"\n";
    let text = std::fs::read_to_string(scenario("free-rocking-on-ground")).unwrap().replacen("[ground]\n", shaken, 1);
    std::fs::write(folder.join("scenes/scene.toml"), text).unwrap();
    let output = teeter(&folder, &["run", "scenes/scene.toml", "--out", "deep/down/first", "--set", "time.end=0.3 s"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let written = std::fs::read_to_string(folder.join("deep/down/first/scene.toml")).unwrap();
    assert!(written.contains("file = \"../../../scenes/records/quake.csv\""), "{written}");
    let output = teeter(&folder, &["run", "deep/down/first/scene.toml", "--out", "deep/down/second"]);
    assert!(output.status.success(), "{}", stderr(&output));
    for file in ["scene.toml", "trajectory.csv", "energy.csv", "contacts.csv", "impacts.csv"] {
        let read = |run: &str| std::fs::read(folder.join("deep/down").join(run).join(file)).unwrap();
        assert!(read("first") == read("second"), "{file}");
    }
    let (header, rows) = table(&folder.join("deep/down/first/energy.csv"));
    let external = header.iter().position(|name| name == "external").unwrap();
    assert_ne!(rows.last().unwrap()[external], "0.0", "the ground works");
}

#[test]
fn the_full_model_writes_the_same_bytes_and_the_summary_tells_what_the_other_does_without() {
    let folder = folder("full-model");
    let scene = folder.join("scene.toml");
    let text = std::fs::read_to_string(scenario("free-rocking-on-beam")).unwrap();
    // A second beam that nothing touches, in all tables but unmoved.
    let beam = text[text.find("[beam.table]").unwrap()..text.find("[block").unwrap()].replace("table", "shelf");
    let beam = beam
        .replace("\"static\"", "\"undeformed\"\nrecord = [\"w\", \"moment\"]\nreactions = true\nprobes = [\"9 cm\"]");
    std::fs::write(&scene, format!("{text}\n{beam}")).unwrap();
    let end = |out: &str, more: &[&str]| {
        let output = teeter(&folder, &[&["run", "scene.toml", "--out", out, "--set", "time.end=0.3 s"], more].concat());
        assert!(output.status.success(), "{}", stderr(&output));
    };
    end("out", &[]);
    let removed = summary(&folder)["model"].clone();
    assert_eq!(
        (&removed["extent"], &removed["dofs"], &removed["possible_contacts"]),
        (&"required".into(), &43.into(), &2.into())
    );
    let listed = removed["removed"].as_array().unwrap();
    let whats: Vec<&str> = listed.iter().map(|removed| removed["what"].as_str().unwrap()).collect();
    assert_eq!(whats, ["beam `shelf`: its motion", "contact `feet`: the upper corners of `rocker`"]);
    assert!(listed.iter().all(|removed| removed["exact"] == true && removed["why"].as_str().unwrap().len() > 40));
    std::fs::rename(folder.join("out"), folder.join("required")).unwrap();
    end("out", &["--model", "full"]);
    let full = summary(&folder)["model"].clone();
    assert_eq!((&full["extent"], &full["dofs"], &full["possible_contacts"]), (&"full".into(), &83.into(), &4.into()));
    assert_eq!(full["removed"], Value::Array(Vec::new()));
    for table in FILES.iter().filter(|file| file.ends_with(".csv") || file.ends_with(".toml")) {
        let bytes = |run: &str| std::fs::read(folder.join(run).join(table)).unwrap();
        assert!(bytes("out") == bytes("required"), "{table}");
    }
    assert!(table(&folder.join("out/trajectory.csv")).0.iter().any(|column| column == "shelf.w_mid"));
}

/// What no check of the scene can see: a drive that winds a block up, and places so far off that
/// the energy of weight has no digits left.
#[test]
fn a_run_warns_of_far_turns_and_of_an_account_that_does_not_hold() {
    let scene = |block: &str| {
        format!(
            "[time]\nend = \"0.5 s\"\nstep = \"1 ms\"\n[material.m]\ndensity = \"1000 kg/m^3\"\n[block.b]\nmaterial = \"m\"\n\
             width = \"10 cm\"\nheight = \"10 cm\"\ndepth = \"10 cm\"\n{block}\n"
        )
    };
    for (what, block, code, says) in [
        (
            "wound-up",
            "position = [\"0 m\", \"1 m\"]\nmotion = { angular_acceleration = \"1000 rad/s^2\" }",
            "far-turn",
            "`b` turns by 0.10 rad in the step to t = 100 ms",
        ),
        ("far-off", "position = [\"0 m\", \"1e9 m\"]", "energy-account", "far more than rounding"),
    ] {
        let folder = folder(what);
        std::fs::write(folder.join("scene.toml"), scene(block)).unwrap();
        let output = teeter(&folder, &["run", "scene.toml", "--out", "out"]);
        assert!(output.status.success(), "{what}: {}", stderr(&output));
        let said = stderr(&output);
        assert_eq!(said.matches(says).count(), 1, "{what}, told once: {said}");
        let warnings = summary(&folder)["warnings"].clone();
        assert_eq!(warnings.as_array().unwrap().len(), 1, "{what}: {warnings}");
        assert_eq!(warnings[0]["code"], code, "{what}");
    }
}

/// Two corners of a flat block on a slope: one has ended its bounces, e = 0.8, when the other
/// lands.
#[test]
fn a_run_warns_of_a_landing_that_hangs_on_bounces_that_were_cut_short() {
    let scene = "[time]\nend = \"0.1 s\"\nstep = \"0.25 ms\"\n[ground]\nincline = \"10 deg\"\n[material.m]\ndensity = \"2700 kg/m^3\"\n\
         [block.b]\nmaterial = \"m\"\nwidth = \"30 cm\"\nheight = \"3 cm\"\ndepth = \"5 cm\"\n\
         position = [\"-0.0026048963131816215 m\", \"0.01477310110293613 m\"]\nangle = \"10 deg\"\nspin = \"2.491835145336937 rad/s\"\n\
         [contact.c]\nbetween = [\"b\", \"ground\"]\nfriction = 2\nrestitution = 0.8\n\
         [force.push]\non = \"b\"\nforce = [\"-7.144254350426844 N\", \"0 N\"]\nsignal = \"p\"\n\
         [signal.p]\nshape = \"half-sine\"\nstart = \"0 s\"\nduration = \"0.0517 s\"\n";
    let folder = folder("bounces");
    std::fs::write(folder.join("scene.toml"), scene).unwrap();
    for (scheme, told) in [("moreau-jean-located", true), ("event-driven", false)] {
        let sets = format!("time.scheme={scheme}");
        let output = teeter(&folder, &["run", "scene.toml", "--out", scheme, "--set", &sets]);
        assert!(output.status.success(), "{}", stderr(&output));
        let said = stderr(&output);
        assert_eq!(said.contains("contact `c`: bottom-left landed at t = 45.8"), told, "{scheme}: {said}");
    }
}

#[test]
fn help_of_help_is_the_help() {
    let printed = |words: &[&str]| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_teeter")).args(words).output().unwrap();
        assert!(output.status.success(), "{words:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let help = printed(&["help"]);
    assert!(help.contains("Usage: teeter"), "{help}");
    assert_eq!([printed(&["help", "--help"]), printed(&["help", "-h"])], [help.clone(), help]);
}
