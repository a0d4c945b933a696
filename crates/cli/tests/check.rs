//! `teeter check`: what it says of the scenarios, what it leaves untouched.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn scenarios() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    assert!(files.len() >= 5);
    files
}

fn scenario(name: &str) -> String {
    let file = scenarios().into_iter().find(|file| file.file_stem().is_some_and(|stem| stem == name));
    file.unwrap().to_str().unwrap().to_owned()
}

fn check(arguments: &[&str]) -> (Output, String, String) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("check");
    std::fs::create_dir_all(&folder).unwrap();
    let output =
        Command::new(env!("CARGO_BIN_EXE_teeter")).current_dir(&folder).arg("check").args(arguments).output().unwrap();
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0, "a check writes nothing");
    let (stdout, stderr) =
        (String::from_utf8(output.stdout.clone()).unwrap(), String::from_utf8(output.stderr.clone()).unwrap());
    (output, stdout, stderr)
}

#[test]
fn no_scenario_is_warned_of() {
    for file in scenarios() {
        let (output, stdout, stderr) = check(&[file.to_str().unwrap()]);
        assert!(output.status.success(), "{stderr}");
        assert!(!stderr.contains("warning"), "{}:\n{stderr}", file.display());
        assert!(stdout.contains("steps of") && !stdout.contains("the scene has none"), "{stdout}");
    }
}

#[test]
fn the_paper_s_beam_is_noted_to_be_soft() {
    let (_, stdout, stderr) = check(&[&scenario("free-rocking-on-beam")]);
    assert!(
        stderr.contains("note: beam.table.thickness = \"0.15 cm\"") && stderr.contains("1/68 of its span"),
        "{stderr}"
    );
    for line in [
        "Free rocking of a rigid block on an elastic beam",
        "  block rocker: 328.1 g, on table, tilted by 5 deg; overturns beyond 12.53 deg (critical angle)",
        "  beam table: 20 elements, 40 degrees of freedom, banded Cholesky, factorised once",
        "    first frequency 26.53 Hz (period 37.69 ms)",
        "  2 possible contacts, 43 degrees of freedom",
        "  5000 steps of 0.0001 s to 0.5 s, theta = 0.5, by moreau-jean-located",
        "  axial motion of beams: their supports are axially free",
    ] {
        assert!(stdout.lines().any(|told| told == line), "«{line}» is missing in\n{stdout}");
    }
    assert!(!stdout.contains("counts as closed"), "the usual gap tolerance is not worth a line");
}

#[test]
fn a_doubtful_scene_is_warned_of_and_exits_with_0() {
    let file = scenario("free-rocking-on-beam");
    for (set, path, says) in [
        ("beam.table.thickness=1.3 mm", "beam.table.thickness", "beyond 1/50"),
        ("time.step=4 ms", "time.step", "a tenth of the first period of `table`"),
        ("block.rocker.tilt=12 deg", "block.rocker.tilt", "within 10 %"),
        ("block.rocker.tilt=-13 deg", "block.rocker.tilt", "overturns"),
        ("time.end=0.12345 s", "time.end", "continues to 0.1235"),
    ] {
        let (output, _, stderr) = check(&[&file, "--set", set]);
        assert_eq!(output.status.code(), Some(0), "{stderr}");
        let warned = stderr.lines().any(|line| line.starts_with(&format!("warning: {path}")));
        assert!(warned && stderr.contains(says), "{set}:\n{stderr}");
    }
    let (_, _, stderr) = check(&[&scenario("free-rocking-on-ground"), "--set", "time.step=10 ms"]);
    assert!(stderr.contains("a tenth of the rocking time sqrt(4R/3g) of `rocker`, 96.94 ms"), "{stderr}");
}

#[test]
fn with_few_elements_the_model_s_numbers_stand_beside_the_beam_s() {
    let file = scenario("free-rocking-on-beam");
    for elements in ["1", "2"] {
        let sets = [format!("beam.table.elements={elements}"), "beam.table.thickness=1 mm".to_owned()];
        let (_, stdout, stderr) = check(&[&file, "--set", &sets[0], "--set", &sets[1]]);
        assert!(stderr.contains("warning: beam.table.thickness"), "{elements}: {stderr}");
        assert!(stderr.contains("1/20 of its span"), "{elements}: {stderr}");
        let parted = stdout.contains("% above the 17.69 Hz of the continuous beam");
        assert_eq!(parted, elements == "1", "{stdout}");
    }
    let (_, stdout, _) = check(&[&file, "--set", "beam.table.elements=1"]);
    for part in [
        "first frequency 29.45 Hz",
        "of the model, 11 % above the 26.53 Hz of the continuous beam",
        "% below the 5.324 mm",
    ] {
        assert!(stdout.contains(part), "«{part}» is missing in\n{stdout}");
    }
    // In one mode the beam is as much too stiff; a mesh of spans has no formula, but a finer one.
    let (_, stdout, _) = check(&[&file, "--set", "beam.table.model=modes", "--set", "beam.table.modes={ count = 1 }"]);
    assert!(stdout.contains("% below the 5."), "{stdout}");
    let pier = "[beam.table.support.pier]\nat = \"20 cm\"\nkind = \"pinned\"\n[block.rocker]";
    let text = std::fs::read_to_string(&file).unwrap().replace("[block.rocker]", pier).replace("= 20\n", "= 1\n");
    let scene = Path::new(env!("CARGO_TARGET_TMPDIR")).join("spans.toml");
    std::fs::write(&scene, text.replace("18 cm", "10 cm")).unwrap();
    let (_, stdout, stderr) = check(&[scene.to_str().unwrap()]);
    assert!(stdout.contains("Hz of a mesh eight times as fine"), "{stdout}{stderr}");
}

#[test]
fn what_a_beam_rests_on_is_told_once_and_counted_beyond_twenty() {
    let piers = |n: usize| {
        let pier = |k: usize| format!("[beam.table.support.p{k}]\nat = \"{}.5 cm\"\nkind = \"pinned\"\n", k + 1);
        let all = (0..n).map(pier).collect::<String>() + "[block.rocker]";
        let text = std::fs::read_to_string(scenario("free-rocking-on-beam")).unwrap().replace("[block.rocker]", &all);
        let scene = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("piers-{n}.toml"));
        std::fs::write(&scene, text).unwrap();
        let (_, stdout, stderr) = check(&[scene.to_str().unwrap()]);
        assert!(stdout.contains("    with pinned at 15 mm\n"), "{stdout}{stderr}");
        stdout
    };
    let few = piers(2);
    assert!(!few.contains("supports between") && !few.contains("    and "), "{few}");
    let many = piers(23);
    assert!(many.contains("    with pinned at 205 mm\n    and 3 more\n") && !many.contains("at 215 mm"), "{many}");
}

/// What is still in the air when the ground starts to move is left alone by it.
#[test]
fn a_ground_that_starts_to_move_at_once_jolts_what_stands_on_it() {
    let warning = "the ground starts with 377 mm/s, but `b` on it starts at rest";
    let told = |name: &str, profile: &str, block: &str| {
        let text = format!(
            "[time]\nend = '1 s'\nstep = '200 us'\n[ground]\n{profile}motion = {{ displacement = ['15 mm', '0 m'], signal = 's' }}\n\
             [signal.s]\nshape = 'harmonic'\nfrequency = '4 Hz'\n[block.b]\ndensity = '1000 kg/m^3'\ndepth = '10 cm'\n{block}\n\
             [contact.a]\nbetween = ['b', 'ground']\nfriction = 0.3\n"
        );
        let scene = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("jolt-{name}.toml"));
        std::fs::write(&scene, text).unwrap();
        let (output, _, stderr) = check(&[scene.to_str().unwrap()]);
        assert!(output.status.success(), "{stderr}");
        stderr.contains(warning)
    };
    let bin =
        "profile = { points = [['-60 cm', '40 cm'], ['-50 cm', '0 cm'], ['50 cm', '0 cm'], ['60 cm', '40 cm']] }\n";
    let box_ = "width = '10 cm'\nheight = '20 cm'\n";
    for (name, profile, block, is_jolted) in [
        ("dropped-ball", bin, "radius = '4 cm'\nposition = ['-30 cm', '40 cm']".to_owned(), false),
        ("lying-ball", bin, "radius = '4 cm'\nposition = ['-30 cm', '4 cm']".to_owned(), true),
        ("standing-box", "", format!("{box_}on = 'ground'\nat = '0 m'"), true),
        ("dropped-box", "", format!("{box_}position = ['0 m', '11 cm']"), false),
        ("placed-box", "", format!("{box_}position = ['0 m', '10 cm']"), true),
    ] {
        assert_eq!(told(name, profile, &block), is_jolted, "{name}");
    }
}

#[test]
fn an_unusual_gap_tolerance_is_told() {
    let (_, stdout, _) = check(&[&scenario("free-rocking-on-ground"), "--set", "block.rocker.height=2 m"]);
    assert!(stdout.contains("a gap below 20 pm counts as closed"), "{stdout}");
}

#[test]
fn a_bad_scene_exits_with_2_and_says_nothing_on_standard_output() {
    let (output, stdout, stderr) = check(&[&scenario("drop"), "--set", "time.step=0 s"]);
    assert_eq!((output.status.code(), stdout.as_str()), (Some(2), ""));
    assert!(stderr.contains("must be greater than 0 s"), "{stderr}");
}

#[test]
fn a_scene_from_standard_input_and_a_reader_that_goes_away() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_teeter"))
        .args(["check", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    child.stdin.take().unwrap().write_all(&std::fs::read(scenario("sliding")).unwrap()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn what_is_not_needed_is_listed_with_its_reason_and_the_full_model_has_it() {
    let scene = scenario("free-rocking-on-beam");
    let (_, stdout, _) = check(&[&scene]);
    for part in
        ["not required", "the upper corners of `rocker`", "would be needed to tilt `rocker`", "exact: every number"]
    {
        assert!(stdout.contains(part), "«{part}» is missing in\n{stdout}");
    }
    let (_, full, _) = check(&[&scene, "--model", "full"]);
    assert!(!full.contains("not required") && full.contains("  4 possible contacts, 43 degrees of freedom"), "{full}");
    let (output, _, stderr) = check(&[&scene, "--model", "some"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr.contains("write full, or required"), "{stderr}");
}
