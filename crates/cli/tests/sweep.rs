//! `teeter sweep`: its table, its shards, and what is left after a kill.

#![allow(clippy::unwrap_used)] // a test

mod running;

use running::{done, teeter};
use std::path::{Path, PathBuf};

/// A folder with Housner's block and a sweep file.
fn study(name: &str, sweep: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("sweep-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-ground.toml");
    let scene = std::fs::read_to_string(scene).unwrap().replace("end  = \"1 s\"", "end = \"0.2 s\"");
    std::fs::write(folder.join("rocking.toml"), scene).unwrap();
    std::fs::write(folder.join("sweep.toml"), sweep).unwrap();
    folder
}

/// The rows of a table, each as its cells; the first is the header.
fn table(path: &Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

const SWEEP: &str = "scene = \"rocking.toml\"\n\
    [grid]\ncontact.feet.friction = [0.4, 0.6]\nblock.rocker.tilt = { from = \"2 deg\", to = \"6 deg\", count = 3 }\n\
    [random]\ncount = 2\nseed = 5\nmethod = \"latin-hypercube\"\nblock.rocker.height = { uniform = [\"12 cm\", \"15 cm\"] }\n\
    [outputs]\nlargest = { max_abs = \"rocker.phi\" }\nlast = { final = \"rocker.omega\" }\n\
    early = { at = \"50 ms\", of = \"rocker.phi\" }\nimpacts = \"impact_count\"\n";

#[test]
fn a_case_has_the_numbers_of_a_run_with_its_values() {
    let folder = study("values", SWEEP);
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let rows = table(&folder.join("all/results.csv"));
    let header = "case,contact.feet.friction,block.rocker.tilt,block.rocker.height,largest,last,early,impacts,status,\
        unsolved_steps,warnings,error";
    assert_eq!(rows[0].join(","), header);
    assert_eq!(rows.len(), 1 + 2 * 3 * 2);
    let numbers: Vec<&str> = rows[1..].iter().map(|row| row[0].as_str()).collect();
    assert_eq!(numbers, (0..12).map(|k| k.to_string()).collect::<Vec<_>>());
    for row in [&rows[1], &rows[8], &rows[12]] {
        let sets = [
            format!("contact.feet.friction={}", row[1]),
            format!("block.rocker.tilt={} rad", row[2]),
            format!("block.rocker.height={} m", row[3]),
        ];
        let out = format!("case-{}", row[0]);
        let mut arguments = vec!["run", "rocking.toml", "--out", &out, "--quiet"];
        sets.iter().for_each(|set| arguments.extend(["--set", set]));
        done(&folder, &arguments);
        let motion = table(&folder.join(&out).join("trajectory.csv"));
        let column = |name: &str| {
            let place = motion[0].iter().position(|column| column == name).unwrap();
            motion[1..].iter().map(|cells| cells[place].parse::<f64>().unwrap()).collect::<Vec<_>>()
        };
        let cell = |place: usize| row[place].parse::<f64>().unwrap();
        // The values of the keys in the table are converted, so the last digit may differ.
        let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-9 * b.abs(), "case {}: {a} {b}", row[0]);
        close(cell(4), column("rocker.phi").iter().fold(0.0, |most: f64, x| most.max(x.abs())));
        close(cell(5), *column("rocker.omega").last().unwrap());
        let at = column("t").iter().position(|t| (t - 0.05).abs() < 1e-9).unwrap();
        close(cell(6), column("rocker.phi")[at]);
        let summary: serde_json::Value =
            serde_json::from_slice(&std::fs::read(folder.join(&out).join("summary.json")).unwrap()).unwrap();
        assert_eq!(row[7], summary["impact_count"].to_string());
        let warned = summary["warnings"].as_array().unwrap();
        let codes: Vec<&str> = warned.iter().map(|warning| warning["code"].as_str().unwrap()).collect();
        assert_eq!(row[8..], ["complete", "0", &codes.join(" "), ""]);
    }
    let heights: Vec<f64> = rows[1..3].iter().map(|row| row[3].parse().unwrap()).collect();
    assert!(heights.iter().any(|h| *h < 0.135) && heights.iter().any(|h| *h > 0.135), "one in each half: {heights:?}");
}

#[test]
fn shards_merge_to_the_bytes_of_one_run_on_any_number_of_threads() {
    let folder = study("shards", SWEEP);
    done(&folder, &["sweep", "sweep.toml", "--out", "all", "--jobs", "1"]);
    for shard in ["1", "2", "3"] {
        let (part, number) = (format!("part-{shard}"), format!("{shard}/3"));
        done(&folder, &["sweep", "sweep.toml", "--out", &part, "--shard", &number, "--jobs", "2"]);
    }
    let missing = teeter(&folder, &["sweep", "--merge", "part-1", "part-3", "--out", "merged"]);
    assert_eq!(String::from_utf8(missing.stderr).unwrap(), "error: shards are missing: 2/3\n");
    let twice = teeter(&folder, &["sweep", "--merge", "part-1", "part-1", "part-2", "part-3", "--out", "merged"]);
    assert_eq!(String::from_utf8(twice.stderr).unwrap(), "error: shard 1/3 is in part-1 and in part-1\n");
    let nowhere = teeter(&folder, &["sweep", "--merge", "part-4", "--out", "merged"]);
    assert_eq!(
        String::from_utf8(nowhere.stderr).unwrap(),
        "error: part-4: there is no such folder; a folder that `teeter sweep` has written is expected\n"
    );
    let onto = teeter(&folder, &["sweep", "--merge", "part-1", "part-2", "part-3", "--out", "part-1", "--force"]);
    let told = String::from_utf8(onto.stderr).unwrap();
    assert!(told.contains("part-1 is one of the shards and stays as it is"), "{told}");
    done(&folder, &["sweep", "--merge", "part-3", "part-1", "part-2", "--out", "merged"]);
    let files = ["results.csv", "sweep.json"].into_iter().chain(cfg!(feature = "parquet").then_some("results.parquet"));
    for file in files {
        let bytes = |name: &str| std::fs::read(folder.join(name).join(file)).unwrap();
        assert!(bytes("all").len() > 100 && bytes("merged") == bytes("all"), "{file}");
    }
}

#[test]
fn cases_that_warn_are_counted_by_the_kinds_of_warnings() {
    let sweep = "scene = \"rocking.toml\"\n[grid]\ntime.step = [\"100 us\", \"5 ms\", \"9 ms\"]\n";
    let folder = study("warnings", sweep);
    let told = done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    // The column before the last, `error`.
    let codes: Vec<String> =
        table(&folder.join("all/results.csv")).iter().map(|row| row[row.len() - 2].clone()).collect();
    assert_eq!((codes[0].as_str(), codes[1].as_str()), ("warnings", ""), "{codes:?}");
    assert!(codes[2..].iter().all(|codes| codes.split(' ').any(|code| code == "scene")), "{codes:?}");
    assert!(told.contains("warning: 2 of 3 cases warn: ") && told.contains("scene (2)"), "{told}");
}

/// Those that only the end of a run shows are among them, too: the column has what `summary.json` has.
#[test]
fn the_warnings_of_a_case_are_those_of_its_summary() {
    let lintel = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/lintel.toml");
    let grid = "[grid]\ntime.scheme = [\"moreau-jean-located\"]\ntime.end = [\"0.3 s\"]\n";
    let folder = study("end-warnings", &format!("scene = {lintel:?}\n{grid}"));
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let row = &table(&folder.join("all/results.csv"))[1];
    assert!(row[row.len() - 2].split(' ').any(|code| code == "unlocated"), "{row:?}");
}

#[test]
fn notes_are_of_all_cases_also_of_those_that_ran_before() {
    let sweep = "scene = \"rocking.toml\"\n[grid]\ncontact.feet.friction = [0.3, -1, 0.5]\n[outputs]\nnothing = \"peaks.90000.phi\"\n";
    let folder = study("notes", sweep);
    let first = done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let again = done(&folder, &["sweep", "sweep.toml", "--out", "all", "--resume"]);
    for told in [first, again] {
        assert!(told.contains("1 case has no result"), "{told}");
        assert!(told.contains("warning: `nothing` is empty in all cases"), "{told}");
    }
}

#[test]
fn a_study_continues_after_a_kill_to_the_same_bytes() {
    let folder = study("resume", SWEEP);
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let whole = std::fs::read_to_string(folder.join("all/results.csv")).unwrap();
    // What a kill leaves: rows in any order, the last one cut, and no results.
    let lines: Vec<&str> = whole.split_inclusive('\n').collect();
    for kept in [0, 1, 5, 12] {
        let left = folder.join(format!("left-{kept}"));
        std::fs::create_dir_all(&left).unwrap();
        std::fs::copy(folder.join("all/sweep.json"), left.join("sweep.json")).unwrap();
        let mut journal = lines[0].to_owned();
        (0..kept).for_each(|k| journal.push_str(lines[1 + (5 * k) % 12]));
        journal.push_str(&lines[1 + (5 * kept) % 12][..9]);
        std::fs::write(left.join("journal.csv"), &journal).unwrap();
        let anew = teeter(&folder, &["sweep", "sweep.toml", "--out", &format!("left-{kept}")]);
        assert!(String::from_utf8(anew.stderr).unwrap().contains("--resume goes on with it"));
        assert_eq!(std::fs::read_to_string(left.join("journal.csv")).unwrap(), journal);
        let out = format!("left-{kept}");
        let told = done(&folder, &["sweep", "sweep.toml", "--out", &out, "--resume"]);
        let are = if kept == 1 { "is" } else { "are" };
        assert!(kept == 0 || told.contains(&format!("{kept} of 12 cases {are} done")), "{told}");
        assert_eq!(std::fs::read_to_string(left.join("results.csv")).unwrap(), whole);
        let typed = |folder: &Path| std::fs::read(folder.join("results.parquet")).ok();
        assert_eq!(typed(&left), typed(&folder.join("all")));
        assert!(!left.join("journal.csv").exists());
    }
    // A study that has ended is continued by doing nothing; another one isn't.
    done(&folder, &["sweep", "sweep.toml", "--out", "all", "--resume"]);
    assert_eq!(std::fs::read_to_string(folder.join("all/results.csv")).unwrap(), whole);
    std::fs::write(folder.join("sweep.toml"), SWEEP.replace("seed = 5", "seed = 6")).unwrap();
    let other = teeter(&folder, &["sweep", "sweep.toml", "--out", "all", "--resume"]);
    assert_eq!(String::from_utf8(other.stderr).unwrap(), "error: all: the sweep file has changed since\n");
    let again = teeter(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    assert_eq!(again.status.code(), Some(2));
    assert_eq!(std::fs::read_to_string(folder.join("all/results.csv")).unwrap(), whole);
}

#[test]
fn lines_of_a_journal_that_are_no_rows_are_counted_and_run_again() {
    let folder = study("garbage", SWEEP);
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let whole = std::fs::read_to_string(folder.join("all/results.csv")).unwrap();
    let lines: Vec<&str> = whole.split_inclusive('\n').collect();
    let left = folder.join("left");
    std::fs::create_dir_all(&left).unwrap();
    std::fs::copy(folder.join("all/sweep.json"), left.join("sweep.json")).unwrap();
    // Another program's line, a row without its end, one of no case, and what a broken disk leaves.
    let journal = [lines[0], lines[3], "hello\n", "4,0.4\n", &lines[1].replacen('0', "99", 1), lines[9]].concat();
    std::fs::write(left.join("journal.csv"), [journal.as_bytes(), b"\xff\xfe\n"].concat()).unwrap();
    let told = done(&folder, &["sweep", "sweep.toml", "--out", "left", "--resume"]);
    assert!(told.contains("warning: 4 lines of the journal were removed, being no whole row of this study"), "{told}");
    assert!(told.contains("2 of 12 cases are done"), "{told}");
    assert_eq!(std::fs::read_to_string(left.join("results.csv")).unwrap(), whole);
}

#[test]
fn rows_that_are_too_far_apart_for_an_output_are_told_once() {
    let sweep = |every: &str| {
        format!(
            "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\", \"4 deg\"]\noutput.every = [\"{every}\"]\n\
             [outputs]\nearly = {{ at = \"90 ms\", of = \"rocker.phi\" }}\nlast = {{ final = \"rocker.phi\" }}\n"
        )
    };
    let folder = study("coarse", &sweep("60 ms"));
    let told = done(&folder, &["sweep", "sweep.toml", "--out", "coarse"]);
    assert!(told.contains("warning: 2 of 2 cases warn: coarse-rows (2)"), "{told}");
    assert_eq!(told.matches("outputs such as `early` may be off").count(), 1, "{told}");
    std::fs::write(folder.join("sweep.toml"), sweep("1 ms")).unwrap();
    assert!(!done(&folder, &["sweep", "sweep.toml", "--out", "fine"]).contains("coarse"));
}

#[test]
fn bands_say_of_how_many_cases_they_are_past_the_end_of_some() {
    let sweep = "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = { from = \"8 deg\", to = \"14 deg\", count = 4 }\n\
        time.end = [\"1 s\"]\ntime.stop = ['[\"overturned\"]']\n[bands]\nof = \"rocker.phi\"\nuntil = \"1 s\"\ntimes = 90\n";
    let folder = study("survivors", sweep);
    let output = teeter(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let said = String::from_utf8(output.stdout).unwrap();
    let bands = table(&folder.join("all/bands.csv"));
    // 90 times after t = 0.
    let cases: Vec<&str> = bands[1..].iter().map(|row| row[2].as_str()).collect();
    assert_eq!((cases.len(), cases[0]), (91, "4"));
    let last = cases[90];
    assert!(last != "4", "some case overturns: {cases:?}");
    let told = format!("fewer than all 4 cases, {last} at the end");
    let figure = std::fs::read_to_string(folder.join("all/figures/bands.svg")).unwrap();
    assert!(said.contains(&told) && figure.contains(&told), "{said}");
}

#[test]
fn the_example_of_the_page_can_be_run() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let read = |path: &str| std::fs::read_to_string(repository.join(path)).unwrap();
    let page = read("docs/sweep.md");
    let example = page.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    let folder = study("page", example);
    let scene = read("sweeps/block-on-ground.toml").replace("66 s", "0.5 s");
    let scene = scene.replace("../scenarios/rocking-under-earthquake.csv", "records/one.AT2");
    std::fs::write(folder.join("rocking.toml"), scene).unwrap();
    std::fs::create_dir(folder.join("records")).unwrap();
    std::fs::copy(repository.join("fuzz/corpus/record/peer-new"), folder.join("records/one.AT2")).unwrap();
    done(&folder, &["sweep", "sweep.toml", "--out", "part", "--shard", "1/5000"]);
    let rows = std::fs::read_to_string(folder.join("part/results.csv")).unwrap();
    let complete = rows.lines().filter(|row| row.contains(",false,complete,0,")).count();
    assert_eq!((rows.lines().count(), complete), (1 + 3, 3), "of 10800 cases: {rows}");
}

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

/// Two records as the values of one key, listed by a pattern relative to the sweep file.
#[test]
fn files_are_an_axis() {
    let sweep = "scene = \"scenes/shaken.toml\"\n[grid]\nground.motion.x.record = { files = \"records/*.csv\" }\n\
        [outputs]\nlargest = { max_abs = \"b.x\" }\nsa = { spectral_acceleration = \"0.5 s\" }\n\
        same = { spectral_acceleration = \"500 ms\", of = \"ground.motion.x\" }\n\
        none = { spectral_acceleration = \"0.5 s\", of = \"ground.motion.y\" }\n";
    let folder = study("files", sweep);
    std::fs::create_dir_all(folder.join("records")).unwrap();
    std::fs::create_dir_all(folder.join("scenes")).unwrap();
    for (name, size) in [("a.csv", 1.0), ("b.csv", 2.0)] {
        let rows: String = (0..=20)
            .map(|k| format!("{},{}\n", 0.01 * f64::from(k), size * (std::f64::consts::PI * 0.1 * f64::from(k)).sin()))
            .collect();
        std::fs::write(folder.join("records").join(name), rows).unwrap();
    }
    let scene = "[time]\nend = '0.2 s'\nstep = '1 ms'\n[material.m]\ndensity = '1000 kg/m^3'\n[ground]\n\
        [ground.motion.x]\nrecord = '../records/a.csv'\nunit = 'm/s^2'\n\
        [block.b]\nmaterial = 'm'\nwidth = '20 cm'\nheight = '5 cm'\ndepth = '5 cm'\non = 'ground'\nat = '0 m'\n\
        [contact.f]\nbetween = ['b', 'ground']\nfriction = 0.9\n";
    std::fs::write(folder.join("scenes/shaken.toml"), scene).unwrap();
    let output = teeter(&folder, &["sweep", "sweep.toml", "--out", "out"]);
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{told}");
    let rows = table(&folder.join("out/results.csv"));
    assert_eq!(rows.len(), 3, "{told}");
    assert!(rows[1][1].ends_with("records/a.csv") && rows[2][1].ends_with("records/b.csv"), "{rows:?}");
    let moved = |row: &[String]| row[2].parse::<f64>().unwrap();
    assert!((moved(&rows[2]) / moved(&rows[1]) - 2.0).abs() < 1e-6, "it moves with the ground: {rows:?}");
    for (row, size) in [(&rows[1], 1.0), (&rows[2], 2.0)] {
        let found: f64 = row[3].parse().unwrap();
        let exact = size * oscillator(0.5);
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
        assert_eq!((&row[4], row[5].as_str()), (&row[3], ""));
    }
    let none = "`none` is empty in all cases: the scene has no record at ground.motion.y";
    assert!(told.contains(none), "{told}");
    // One more file matches the pattern.
    std::fs::copy(folder.join("records/a.csv"), folder.join("records/c.csv")).unwrap();
    let output = teeter(&folder, &["sweep", "sweep.toml", "--out", "out", "--resume"]);
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.ends_with("files that the scene reads have changed since: `../records/c.csv` is new\n"), "{told}");
}

/// ω² times the largest displacement of an oscillator of this period and 5 % damping, whose support is
/// accelerated by one sine of 0.2 s, linear between 20 values, then and in the free vibration of 0.5 s after it: by the
/// classical Runge–Kutta method.
fn oscillator(period: f64) -> f64 {
    let value = |k: u32| (std::f64::consts::PI * 0.1 * f64::from(k)).sin();
    let ground = |t: f64| {
        let k = ((t / 0.01).floor() as u32).min(19);
        let part = t / 0.01 - f64::from(k);
        if t < 0.2 { value(k) + (value(k + 1) - value(k)) * part } else { 0.0 }
    };
    let omega = std::f64::consts::TAU / period;
    let rate = |t: f64, [x, v]: [f64; 2]| [v, -ground(t) - 2.0 * 0.05 * omega * v - omega * omega * x];
    let (h, mut state, mut largest) = (1e-5, [0.0, 0.0], 0.0_f64);
    for k in 0..70_000_u32 {
        let t = h * f64::from(k);
        let after = |slope: [f64; 2], h: f64| [state[0] + h * slope[0], state[1] + h * slope[1]];
        let a = rate(t, state);
        let b = rate(t + 0.5 * h, after(a, 0.5 * h));
        let c = rate(t + 0.5 * h, after(b, 0.5 * h));
        let d = rate(t + h, after(c, h));
        let mean = [0, 1].map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0);
        state = after(mean, h);
        largest = largest.max(state[0].abs());
    }
    omega * omega * largest
}

/// The folder of sweeps of the project.
fn sweeps() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sweeps")
}

/// Theory §9: the amplitudes A/(g tan α) from which one sine overturns the block after one impact.
#[test]
fn the_limit_of_overturning_is_that_of_the_formula() {
    let sweep = "scene = \"block-under-one-sine.toml\"\n[grid]\nsignal.shake.frequency = [\"2 Hz\", \"3 Hz\"]\n\
        [find]\nkey = \"signal.shake.scale\"\nlow = 1.01\nhigh = 2.2\ntolerance = 1e-4\nuntil = \"overturned\"\n";
    let folder = study("limits", sweep);
    std::fs::copy(sweeps().join("block-under-one-sine.toml"), folder.join("block-under-one-sine.toml")).unwrap();
    let told = done(&folder, &["sweep", "sweep.toml", "--out", "out"]);
    assert!(told.contains("a bisection sees one limit of several"), "{told}");
    let rows = table(&folder.join("out/results.csv"));
    let header = "case,signal.shake.frequency,signal.shake.scale,find.beside,find.at_low,find.at_high,find.changes,find.runs,\
        overturned_at,status,unsolved_steps,warnings,error";
    assert_eq!(rows[0].join(","), header);
    for (row, limit) in rows[1..].iter().zip([1.2237, 1.4019]) {
        let cell = |k: usize| row[k].parse::<f64>().unwrap();
        // The bracket, and four digits of the table.
        assert!(cell(2) - cell(3) <= 1e-4 && cell(2) > cell(3), "{row:?}");
        assert!((cell(2) - limit).abs() < 3e-4, "{row:?}");
        assert_eq!(row[4..8], ["no", "yes", "1", "16"], "{row:?}");
        assert!(cell(8) > 0.0 && row[9] == "stopped", "the run at the limit overturns: {row:?}");
    }
    // Both sides of the window in which it overturns after one impact are safe.
    let sweep = sweep.replace("high = 2.2", "high = 2.34").replace("\"2 Hz\", \"3 Hz\"", "\"2 Hz\"");
    std::fs::write(folder.join("sweep.toml"), &sweep).unwrap();
    done(&folder, &["sweep", "sweep.toml", "--out", "blind"]);
    let rows = table(&folder.join("blind/results.csv"));
    assert_eq!(rows[1][9], "no-limit", "{rows:?}");
    assert_eq!(rows[1][2], "", "{rows:?}");
    std::fs::write(folder.join("sweep.toml"), sweep.replace("[find]\n", "[find]\nscan = 4\n")).unwrap();
    let told = done(&folder, &["sweep", "sweep.toml", "--out", "seen"]);
    assert!(told.contains("in 1 of 1 case there are several limits"), "{told}");
    let rows = table(&folder.join("seen/results.csv"));
    assert_eq!(rows[1][4..7], ["no", "no", "2"], "{rows:?}");
    assert!((rows[1][2].parse::<f64>().unwrap() - 1.2237).abs() < 3e-4, "{rows:?}");
}

/// A block on ground shaken by three pulses of different length, each scaled to six peaks.
fn shaken_study(name: &str) -> PathBuf {
    let sweep = "scene = \"shaken.toml\"\n[grid]\nground.motion.x.record = { files = \"pulse-*.csv\" }\n\
        ground.motion.x.peak = [\"2.5 m/s^2\", \"3.2 m/s^2\", \"3.8 m/s^2\", \"5 m/s^2\", \"7 m/s^2\", \"10 m/s^2\"]\n\
        [outputs]\nlargest = \"max_phi_over_alpha\"\n\
        [fragility]\nevent = \"overturned\"\nintensity = \"ground.motion.x.peak\"\n\
        [distribution]\nof = \"largest\"\nat_most = 1\n";
    let folder = study(name, sweep);
    for (k, frequency) in [2.0, 4.0, 6.0].into_iter().enumerate() {
        let value = |t: f64| if t * frequency <= 1.0 { (std::f64::consts::TAU * frequency * t).sin() } else { 0.0 };
        let rows: String = (0..=200).map(|k| 0.01 * f64::from(k)).map(|t| format!("{t:.2},{}\n", value(t))).collect();
        std::fs::write(folder.join(format!("pulse-{k}.csv")), rows).unwrap();
    }
    let scene = "[time]\nend = '2 s'\nstep = '1 ms'\nstop = ['overturned']\n[material.m]\ndensity = '1000 kg/m^3'\n[ground]\n\
        [ground.motion.x]\nrecord = 'pulse-0.csv'\n\
        [block.b]\nmaterial = 'm'\nwidth = '5 cm'\nheight = '20 cm'\ndepth = '5 cm'\non = 'ground'\nat = '0 m'\n\
        [contact.f]\nbetween = ['b', 'ground']\nfriction = 2\n";
    std::fs::write(folder.join("shaken.toml"), scene).unwrap();
    folder
}

#[test]
fn a_study_has_its_figures_and_shards_lead_to_the_same() {
    let folder = shaken_study("figures");
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let rows = table(&folder.join("all/fragility.csv"));
    let column = |name: &str| rows[1][rows[0].iter().position(|cell| cell == name).unwrap()].as_str();
    let number = |name: &str| column(name).parse::<f64>().unwrap();
    assert_eq!([column("cases"), column("groups"), column("error")], ["18", "3", ""]);
    assert!(number("median") > 2.5 && number("median") < 10.0 && number("beta") > 0.0, "{rows:?}");
    assert!(number("median_low") <= number("median") && number("median") <= number("median_high"), "{rows:?}");
    // What is observed is what the table of results has.
    let results = table(&folder.join("all/results.csv"));
    let overturned = results[0].iter().position(|cell| cell == "overturned_at").unwrap();
    let seen = results[1..].iter().filter(|row| !row[overturned].is_empty()).count();
    assert_eq!(number("events"), seen as f64);
    let data = table(&folder.join("all/fragility_data.csv"));
    assert_eq!(data[1..].iter().map(|row| row[4].parse::<usize>().unwrap()).sum::<usize>(), seen);
    let page = std::fs::read_to_string(folder.join("all/study.html")).unwrap();
    assert!(
        page.contains("id=\"fragility\"")
            && page.contains("id=\"distribution\"")
            && !page.contains("http-equiv=\"refresh")
    );
    // Columns are named as one would say them.
    assert!(page.contains("Peak acceleration of ground x (m/s²)") && !page.contains(">ground.motion.x.peak"), "{page}");
    let shares = table(&folder.join("all/distribution.csv"));
    assert_eq!(shares.last().unwrap()[3], "1.0");
    for shard in ["1", "2"] {
        let (part, number) = (format!("part-{shard}"), format!("{shard}/2"));
        done(&folder, &["sweep", "sweep.toml", "--out", &part, "--shard", &number]);
        assert!(!folder.join(&part).join("study.html").exists(), "a part of the cases has no figures");
    }
    done(&folder, &["sweep", "--merge", "part-1", "part-2", "--out", "merged"]);
    for file in ["results.csv", "fragility.csv", "fragility_curves.csv", "distribution.csv", "figures/fragility.svg"] {
        let bytes = |name: &str| std::fs::read(folder.join(name).join(file)).unwrap();
        assert_eq!(bytes("merged"), bytes("all"), "{file}");
    }
}

#[test]
fn studies_are_compared_and_a_study_does_not_differ_from_itself() {
    let folder = shaken_study("compared");
    done(&folder, &["sweep", "sweep.toml", "--out", "one"]);
    let scene = std::fs::read_to_string(folder.join("shaken.toml")).unwrap();
    std::fs::write(folder.join("shaken.toml"), scene.replace("'20 cm'", "'17 cm'")).unwrap();
    done(&folder, &["sweep", "sweep.toml", "--out", "squat"]);
    let told = teeter(&folder, &["sweep", "--compare", "one", "one", "--out", "same"]);
    let said = String::from_utf8(told.stdout).unwrap();
    assert!(
        said.contains(
            "the median of `one` is 1 times that of `one`, 95 % from 1 to 1 (the same records drawn for both)"
        ),
        "{said}"
    );
    assert!(said.contains("(largest distance 0, Kolmogorov–Smirnov p = 1)"), "{said}");
    done(&folder, &["sweep", "--compare", "one", "squat", "--out", "both"]);
    let rows = table(&folder.join("both/fragility.csv"));
    let median = |row: &[String]| row[2].parse::<f64>().unwrap();
    assert_eq!((rows[1][0].as_str(), rows[2][0].as_str()), ("one", "squat"));
    assert!(median(&rows[2]) > 1.05 * median(&rows[1]), "a squatter block takes more: {rows:?}");
    // Of the same name, studies are told apart by the folders that they are in.
    for (study, above) in [("one", "a"), ("squat", "b")] {
        std::fs::create_dir_all(folder.join(above)).unwrap();
        std::fs::rename(folder.join(study), folder.join(above).join("s")).unwrap();
    }
    done(&folder, &["sweep", "--compare", "a/s", "b/s", "--out", "named"]);
    let named = table(&folder.join("named/fragility.csv"));
    assert_eq!((named[1][0].as_str(), named[2][0].as_str()), ("a/s", "b/s"));
    for (study, above) in [("one", "a"), ("squat", "b")] {
        std::fs::rename(folder.join(above).join("s"), folder.join(study)).unwrap();
    }
    let tests = table(&folder.join("both/distribution_tests.csv"));
    assert_eq!((tests.len(), tests[1][0].as_str(), tests[1][1].as_str()), (2, "squat", "one"));
    let refused = teeter(&folder, &["sweep", "--compare", "one", "none", "--out", "x"]);
    assert_eq!(refused.status.code(), Some(2));
    let again = teeter(&folder, &["sweep", "--compare", "one", "squat", "--out", "both"]);
    assert_eq!(again.status.code(), Some(2), "results are not overwritten");
}

/// Until the block has turned back, larger tilts lie farther out: the bands are those of the runs with the tilts at these shares.
#[test]
fn bands_are_quantiles_of_the_motions() {
    let sweep = "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = { from = \"1 deg\", to = \"9 deg\", count = 41 }\n\
        [bands]\nof = \"rocker.phi\"\nuntil = \"50 ms\"\ntimes = 5\n";
    let folder = study("bands", sweep);
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let (bands, results) = (table(&folder.join("all/bands.csv")), table(&folder.join("all/results.csv")));
    assert_eq!(bands[0].join(","), "study,t,cases,p2.5,p16,median,p84,p97.5");
    assert_eq!((bands.len(), results.len()), (7, 42));
    let place = results[0].iter().position(|name| name == "rocker.phi@0.05").unwrap();
    let number = |cell: &String| cell.parse::<f64>().unwrap();
    let of_case = |case: usize| number(&results[1 + case][place]).abs();
    let last: Vec<f64> = bands[6][3..].iter().map(|cell| number(cell).abs()).collect();
    let mut shown = [last[0], last[2], last[4]];
    shown.sort_by(f64::total_cmp);
    // A share of 2.5 % of 41 cases is the second, and 97.5 % the last but one.
    for (found, case) in shown.iter().zip([1, 20, 39]) {
        assert!((found - of_case(case)).abs() < 1e-12, "{case}: {found} {}", of_case(case));
    }
    let page = std::fs::read_to_string(folder.join("all/study.html")).unwrap();
    assert!(page.contains("id=\"bands\"") && page.contains("φ of rocker (rad)"), "no figure");
    for (text, told) in [
        ("of = \"rocker.phy\"\nuntil = \"50 ms\"", "rocker.phy"),
        ("of = \"rocker.phi\"\nuntil = \"5 s\"", "after the end of the runs"),
        ("of = \"rocker.phi\"\nuntil = 5", "with its unit"),
        ("of = \"rocker.phi\"\nuntil = \"5 kg\"", "bands.until"),
        ("until = \"5 s\"", "bands.of"),
        ("of = \"rocker.phi\"\nuntil = \"50 s\"", "bands.until = \"50 s\""),
        ("of = \"rocker.phi\"\nuntil = \"50 s\"", "after the end of the runs, t = "),
        ("of = \"rocker.phi\"\nuntil = \"50 ms\"\ntimes = 0", "bands.times"),
    ] {
        let sweep = format!("scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\"]\n[bands]\n{text}\n");
        std::fs::write(folder.join("wrong.toml"), sweep).unwrap();
        let output = teeter(&folder, &["sweep", "wrong.toml", "--out", "wrong"]);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && error.contains(told), "{text}: {error}");
        assert_eq!(error.matches("error: ").count(), 1, "{text}: {error}");
    }
}

#[test]
fn whether_a_block_overturned_is_an_output() {
    let sweep = "scene = \"rocking.toml\"\n[grid]\nblock.rocker.tilt = [\"2 deg\", \"14 deg\"]\ntime.end = [\"1 s\"]\n\
        [outputs]\nover = \"overturned\"\n";
    let folder = study("overturned", sweep);
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let rows = table(&folder.join("all/results.csv"));
    let place = rows[0].iter().position(|name| name == "over").unwrap();
    assert_eq!([rows[1][place].as_str(), rows[2][place].as_str()], ["false", "true"]);
}
