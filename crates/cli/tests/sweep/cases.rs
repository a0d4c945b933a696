//! Cases, rows and shards.

use super::running::{done, teeter};
use super::studies::oscillator;
use super::{SWEEP, study, table};
use std::path::Path;

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
