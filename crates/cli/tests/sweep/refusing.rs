//! What is refused, and how it is told.

use super::running::{done, teeter};
use super::{SWEEP, study, table};

#[test]
fn a_case_that_is_refused_is_a_row() {
    let sweep = "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\", \"100 deg\"]\n";
    let folder = study("refused", sweep);
    let told = done(&folder, &["sweep", "sweep.toml", "--out", "out"]);
    assert!(told.contains("1 case has no result"), "{told}");
    let rows = table(&folder.join("out/results.csv"));
    let last = rows[0].len();
    assert_eq!(rows[1][last - 4..], ["complete", "0", "", ""]);
    assert_eq!(rows[2][last - 4], "refused");
    let line = std::fs::read_to_string(folder.join("out/results.csv")).unwrap();
    assert!(line.contains("block.rocker.tilt"), "with the reason: {line}");
}

/// Whatever the values, it can't be run: there is nothing to sweep.
#[test]
fn a_scene_that_no_case_can_be_run_with_is_refused_with_its_place() {
    let grid =
        "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = { from = \"2 deg\", to = \"100 deg\", count = 40 }\n";
    let folder = study("broken", grid);
    let scene = std::fs::read_to_string(folder.join("rocking.toml")).unwrap();
    let line = 1 + scene.lines().position(|line| line.starts_with("width")).unwrap();
    let place = format!("rocking.toml:{line}:");
    let sweep = "scene = \"sweep.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n";
    std::fs::write(folder.join("of-a-sweep.toml"), sweep).unwrap();
    for (file, text, says) in [
        ("sweep.toml", scene.replace("width ", "widht "), [place.as_str(), "did you mean `width`?"]),
        ("sweep.toml", scene.replace("width ", "width = ="), [place.as_str(), "error"]),
        ("of-a-sweep.toml", scene.clone(), ["this is a sweep, not a scene", "error"]),
    ] {
        std::fs::write(folder.join("rocking.toml"), text).unwrap();
        let refused = teeter(&folder, &["sweep", file, "--out", "out"]);
        let told = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(refused.status.code(), Some(2), "{told}");
        assert!(says.iter().all(|words| told.contains(words)), "{told}");
        assert!(!folder.join("out").exists());
    }
    // With one value that is right there are rows.
    std::fs::write(folder.join("rocking.toml"), scene).unwrap();
    assert!(done(&folder, &["sweep", "sweep.toml", "--out", "out"]).contains("cases have no result"));
}

#[test]
fn what_is_wrong_in_a_sweep_file_is_told_with_its_place_and_a_remedy() {
    for (name, text, says) in [
        ("nothing", "", &["scene: missing: which scene varies?"][..]),
        (
            "scene",
            "scene = \"none.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n",
            &["none.toml", "no such file", "sweep.toml:1", "relative to the sweep file"],
        ),
        ("varies", "scene = \"rocking.toml\"\n", &["nothing varies", "[grid]"]),
        ("table", "scene = \"rocking.toml\"\n[gird]\na = [1]\n", &["sweep.toml:2", "did you mean `grid`?"]),
        ("toml", "scene = \n", &["not valid TOML", "sweep.toml:1"]),
        (
            "key",
            "scene = \"rocking.toml\"\n[grid]\ncontact.feet.frictoin = [1]\n",
            &["sweep.toml:3", "contact.feet.frictoin", "did you mean `contact.feet.friction`?"],
        ),
        (
            "units",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = { from = \"1 deg\", to = \"1 rad\", count = 3 }\n",
            &["the units differ: `deg` and `rad`", "in one unit"],
        ),
        (
            "range",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = { from = \"1 deg\", count = 3 }\n",
            &["from, to and count belong together"],
        ),
        (
            "zip",
            "scene = \"rocking.toml\"\n[zip]\nblock.rocker.width = [\"1 cm\"]\nblock.rocker.height = [\"1 cm\", \"2 cm\"]\n",
            &["lists of one length", "block.rocker.width has 1", "move a key to [grid]"],
        ),
        (
            "files",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = { files = \"*.AT2\" }\n",
            &["no file matches", "relative to the sweep file"],
        ),
        (
            "random",
            "scene = \"rocking.toml\"\n[random]\nblock.rocker.tilt = { uniform = [\"2 deg\", \"1 deg\"] }\n",
            &["random.count", "the lower end comes first"],
        ),
        (
            "output",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n[outputs]\nx = { mx = \"rocker.phi\" }\n",
            &["outputs.x.mx", "did you mean `max`?"],
        ),
        (
            "name",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n[outputs]\n\"a\\nb\" = \"t\"\n",
            &["the name of a column is one line of text", "take another name"],
        ),
        (
            "spectrum",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n[outputs]\nx = { spectral_acceleration = \"0 s\" }\n\
                y = { spectral_acceleration = \"2 m\" }\nz = { spectral_acceleration = \"1 s\", max = \"rocker.phi\" }\n",
            &["outputs.x.spectral_acceleration", "not a period", "outputs.y", "a time (s) is expected", "outputs.z"],
        ),
        (
            "twice",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n[zip]\nblock.rocker.tilt = [\"1 deg\"]\n",
            &["varies twice", "sweep.toml:5"],
        ),
        (
            "many",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = { from = \"1 deg\", to = \"2 deg\", count = 20000 }\n\
                contact.feet.friction = { from = 0.1, to = 0.5, count = 10000 }\n",
            &["block.rocker.tilt: more than 100000000 cases", "sweep.toml:3"],
        ),
        (
            "searched",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"1 deg\"]\n[find]\nkey = \"block.rocker.tilt\"\nlow = \"1 deg\"\n\
                high = \"2 deg\"\ntolerance = \"0.1 deg\"\nuntil = \"overturned\"\n",
            &["varies and is searched", "sweep.toml:5"],
        ),
        (
            "no-unit",
            "scene = \"rocking.toml\"\n[grid]\ncontact.feet.friction = [0.3]\nblock.rocker.tilt = [1, 2]\n",
            &["block.rocker.tilt = [1, 2]", "sweep.toml:4", "an angle needs its unit"],
        ),
        (
            "no-number",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"3 deg\"]\n[zip]\ncontact.feet.friction = [nan, -1]\n",
            &["contact.feet.friction = [nan, -1]", "sweep.toml:5"],
        ),
        (
            "random-unit",
            "scene = \"rocking.toml\"\n[random]\ncount = 3\nblock.rocker.tilt = { uniform = [\"1 m\", \"2 m\"] }\n",
            &["block.rocker.tilt", "sweep.toml:4"],
        ),
        (
            "find-unit-of-key",
            "scene = \"rocking.toml\"\n[find]\nkey = \"block.rocker.tilt\"\nlow = 1\nhigh = 2\ntolerance = 0.1\nuntil = \"overturned\"\n",
            &["block.rocker.tilt", "sweep.toml:3"],
        ),
        (
            "find",
            "scene = \"rocking.toml\"\n[find]\nkey = \"block.rocker.tilt\"\nlow = \"1 deg\"\n",
            &["find", "key, low, high, tolerance and until belong together"],
        ),
        (
            "find-unit",
            "scene = \"rocking.toml\"\n[find]\nkey = \"block.rocker.tilt\"\nlow = \"1 deg\"\nhigh = \"2 deg\"\n\
                tolerance = 0.1\nuntil = \"overturned\"\n",
            &["the units differ: `deg` and none"],
        ),
        (
            "find-order",
            "scene = \"rocking.toml\"\n[find]\nkey = \"block.rocker.tilt\"\nlow = \"3 deg\"\nhigh = \"2 deg\"\n\
                tolerance = \"0.1 deg\"\nuntil = \"overturned\"\n",
            &["low must be below high"],
        ),
        (
            "find-until",
            "scene = \"rocking.toml\"\n[find]\nkey = \"block.rocker.tilt\"\nlow = \"1 deg\"\nhigh = \"2 deg\"\n\
                tolerance = \"0.1 deg\"\nuntil = { output = \"none\", above = 2 }\n",
            &["find.until", "there is no output `none`", "sweep.toml:7"],
        ),
        (
            "find-key",
            "scene = \"rocking.toml\"\n[find]\nkey = \"block.rocker.titl\"\nlow = \"1 deg\"\nhigh = \"2 deg\"\n\
                tolerance = \"0.1 deg\"\nuntil = \"overturned\"\n",
            &["block.rocker.titl", "did you mean", "sweep.toml:3"],
        ),
        (
            "fragility",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n[fragility]\nevent = \"fell\"\nintensity = \"x\"\n",
            &["fragility.event", "write \"overturned\""],
        ),
        (
            "fragility-column",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n[fragility]\nevent = \"overturned\"\nintensity = \"x\"\n",
            &["fragility.intensity", "sweep.toml:6", "no column `x`", "block.rocker.tilt, overturned_at"],
        ),
        (
            "distribution-column",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n[distribution]\nof = \"x\"\n",
            &["distribution.of", "no column `x`", "sweep.toml:5"],
        ),
        (
            "distribution",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n[distribution]\nat_most = \"1\"\n",
            &["distribution.at_most", "a number is expected"],
        ),
        (
            "overturning",
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n[overturning]\nevent = \"overturned\"\nx = \"block.rocker.tilt\"\n",
            &["overturning", "event, x and y belong together"],
        ),
    ] {
        let folder = study(name, text);
        let output = teeter(&folder, &["sweep", "sweep.toml", "--out", "out"]);
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{name}: {told}");
        says.iter().for_each(|part| assert!(told.contains(part), "{name}: «{part}» is missing in\n{told}"));
        assert!(!folder.join("out").exists(), "{name}: nothing is written");
    }
    let folder = study("shard", SWEEP);
    for (shard, says) in [("0/3", "there is no shard 0 of 3"), ("two", "write I/N"), ("1/0", "at least one shard")] {
        let output = teeter(&folder, &["sweep", "sweep.toml", "--shard", shard]);
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8(output.stderr).unwrap().contains(says), "{shard}");
    }
}

#[test]
fn a_scene_is_no_sweep_and_a_sweep_no_scene() {
    let folder = study("confused", SWEEP);
    let told = |arguments: &[&str]| {
        let output = teeter(&folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    let scene = told(&["sweep", "rocking.toml"]);
    assert!(scene.contains("this is a scene, not a sweep") && scene.contains("`teeter run`"), "{scene}");
    for command in ["run", "check"] {
        let sweep = told(&[command, "sweep.toml"]);
        assert!(sweep.contains("this is a sweep, not a scene") && sweep.contains("`teeter sweep`"), "{sweep}");
        assert!(!sweep.contains("did you mean") && sweep.matches("error:").count() == 1, "{sweep}");
    }
    assert!(!scene.contains("did you mean") && scene.matches("error:").count() == 1, "{scene}");
}

#[test]
fn an_output_that_no_run_can_have_is_refused_before_the_first() {
    for (output, says) in [
        ("\"no.such.key\"", "summary.json has no value at no.such.key"),
        ("\"impactcount\"", "did you mean `impact_count`?"),
        ("\"energy.largest_residul\"", "did you mean `energy.largest_residual`?"),
        ("\"energy.final.value\"", "summary.json has no value at energy.final.value"),
        ("{ max = \"rocker.psi\" }", "did you mean `rocker.phi`?"),
        ("{ at = \"1 ms\", of = \"roker.x\" }", "trajectory.csv has no column roker.x; it has t, rocker.x, rocker.y"),
    ] {
        let folder = study("refused-output", &format!("{SWEEP}nothing = {output}\n"));
        let refused = teeter(&folder, &["sweep", "sweep.toml", "--out", "out"]);
        let told = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(refused.status.code(), Some(2), "{output}: {told}");
        assert!(
            told.contains("outputs.nothing") && told.contains("sweep.toml:15:11") && told.contains(says),
            "{output}: {told}"
        );
        assert!(!folder.join("out").exists());
    }
}

#[test]
fn an_output_that_no_case_has_is_told() {
    let sweep = format!("{SWEEP}nothing = \"peaks.90000.phi\"\nwork = \"energy.positive_contact_work.largest\"\n");
    let folder = study("empty", &sweep);
    let told = done(&folder, &["sweep", "sweep.toml", "--out", "out"]);
    assert!(told.contains("`nothing` is empty in all cases: summary.json has no value at peaks.90000.phi"), "{told}");
    let late = format!("{SWEEP}nowhere = {{ at = \"7 min\", of = \"rocker.phi\" }}\n");
    std::fs::write(folder.join("late.toml"), &late).unwrap();
    let output = teeter(&folder, &["sweep", "late.toml", "--out", "late"]);
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("outputs.nowhere: t = 420 s is after the end of the runs, t = 0.2 s"), "{told}");
    // Where the end varies, some case may have it.
    let ends = late.replace("[grid]\n", "[grid]\ntime.end = [\"0.1 s\", \"0.15 s\"]\n");
    std::fs::write(folder.join("ends.toml"), ends).unwrap();
    let told = done(&folder, &["sweep", "ends.toml", "--out", "ends"]);
    assert!(
        told.contains("`nowhere` is empty in all cases: trajectory.csv has no row at t = 420 s or later"),
        "{told}"
    );
}
