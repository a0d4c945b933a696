//! Rows of a study: what decides them, and what is done where somebody has changed them.

#![allow(clippy::unwrap_used)] // a test

mod running;

use running::{done, teeter};
use std::path::{Path, PathBuf};

/// A folder with a scenario and a sweep file.
fn study(name: &str, scenario: &str, sweep: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("sweep-rows-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(scenario);
    std::fs::copy(scene, folder.join("scene.toml")).unwrap();
    std::fs::write(folder.join("sweep.toml"), sweep).unwrap();
    folder
}

fn refused(folder: &Path, arguments: &[&str]) -> String {
    let output = teeter(folder, arguments);
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
    told
}

fn text(path: PathBuf) -> String {
    std::fs::read_to_string(path).unwrap()
}

const GROUND: &str = "free-rocking-on-ground.toml";
const SWEEP: &str =
    "scene = \"scene.toml\"\n[grid]\ncontact.feet.friction = [0.4, 0.5]\ntime.end = [\"1 ms\", \"2 ms\"]\n";

#[test]
fn a_row_whose_key_was_altered_is_refused_wherever_it_is_read() {
    let folder = study("altered", GROUND, SWEEP);
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    for shard in ["1/2", "2/2"] {
        let part = format!("part-{}", &shard[..1]);
        done(&folder, &["sweep", "sweep.toml", "--out", &part, "--shard", shard]);
    }
    let merge = ["sweep", "--merge", "part-1", "part-2", "--out", "merged"];
    let resume = ["sweep", "sweep.toml", "--out", "all", "--resume"];
    let says = "the row of case 3 has contact.feet.friction = 0.9, but the study gives it 0.5: delete that line";
    for (table, arguments) in [("all/results.csv", &resume[..]), ("part-2/results.csv", &merge)] {
        let whole = text(folder.join(table));
        let altered = whole.replace("\n3,0.5,", "\n3,0.9,");
        assert!(altered != whole);
        std::fs::write(folder.join(table), &altered).unwrap();
        let told = refused(&folder, arguments);
        assert!(told.contains(table) && told.contains(says), "{told}");
        assert_eq!(text(folder.join(table)), altered, "nothing is changed");
        assert!(!folder.join("merged").exists() && !folder.join("all/journal.csv").exists());
        std::fs::write(folder.join(table), whole).unwrap();
    }
    // As the message says.
    let whole = text(folder.join("all/results.csv"));
    std::fs::write(folder.join("all/results.csv"), &whole[..whole.find("\n3,").unwrap() + 1]).unwrap();
    assert!(done(&folder, &resume).contains("3 of 4 cases are done"));
    done(&folder, &merge);
    assert_eq!((text(folder.join("all/results.csv")), text(folder.join("merged/results.csv"))), (whole.clone(), whole));
}

#[test]
fn rows_of_which_nobody_knows_the_study_are_left_alone() {
    let folder = study("unknown", GROUND, SWEEP);
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let (rows, identity) = (text(folder.join("all/results.csv")), text(folder.join("all/sweep.json")));
    let resume = ["sweep", "sweep.toml", "--out", "all", "--resume"];
    std::fs::remove_file(folder.join("all/sweep.json")).unwrap();
    let told = refused(&folder, &resume);
    assert!(told.contains("all: there are rows in it, but no sweep.json") && told.contains("--force"), "{told}");
    for damaged in ["", "{}", &identity[..identity.len() / 2]] {
        std::fs::write(folder.join("all/sweep.json"), damaged).unwrap();
        let told = refused(&folder, &resume);
        assert!(told.contains("all: its sweep.json") && told.contains("isn't as `teeter sweep` wrote it"), "{told}");
    }
    assert_eq!(text(folder.join("all/results.csv")), rows);
    std::fs::write(folder.join("all/sweep.json"), identity).unwrap();
    done(&folder, &resume);
}

#[test]
fn whole_numbers_of_a_row_can_be_set_again() {
    let sweep = "scene = \"scene.toml\"\n[grid]\nbeam.table.elements = [10, 20]\ntime.end = [\"1 ms\"]\n";
    let folder = study("whole", "free-rocking-on-beam.toml", sweep);
    done(&folder, &["sweep", "sweep.toml", "--out", "all"]);
    let rows = text(folder.join("all/results.csv"));
    let cells: Vec<&str> = rows.lines().skip(1).map(|row| row.split(',').nth(1).unwrap()).collect();
    assert_eq!(cells, ["10", "20"]);
    let set = format!("beam.table.elements={}", cells[1]);
    done(&folder, &["check", "scene.toml", "--set", &set]);
}

#[test]
fn what_depends_on_the_machine_or_has_no_numbers_is_refused() {
    let clock = "depends on the machine, and rows that are continued or merged must not";
    let words = "numbers are expected, but";
    let fragility = |of: &str| {
        format!(
            "time.scheme = [\"moreau-jean\", \"theta\"]\n[outputs]\nhow = \"headline\"\nover = \"overturned\"\nt = \"t\"\n[fragility]\n\
             event = \"overturned\"\nintensity = [{of}]\n"
        )
    };
    for (more, says) in [
        (
            "[outputs]\nw = \"wall_seconds\"\n".to_owned(),
            [&format!("wall_seconds {clock}"), "outputs.w = \"wall_seconds\""],
        ),
        ("[outputs]\nu = \"us_per_step\"\n".to_owned(), [&format!("us_per_step {clock}"), "outputs.u"]),
        (fragility("\"t\", \"how\""), [&format!("{words} the output `how` is a text"), "fragility.intensity"]),
        (fragility("\"over\""), [&format!("{words} the output `over` is true or false"), "fragility.intensity"]),
        (
            fragility("\"time.scheme\""),
            [&format!("{words} the values of `time.scheme` are words, such as moreau-jean"), "fragility.intensity"],
        ),
        ("[outputs]\nhow = \"ended\"\n[distribution]\nof = \"how\"\n".to_owned(), [words, "distribution.of"]),
    ] {
        let folder = study("refused", GROUND, &(SWEEP.to_owned() + &more));
        let told = refused(&folder, &["sweep", "sweep.toml", "--out", "out"]);
        assert!(says.iter().all(|part| told.contains(part)), "{more}\n{told}");
        assert_eq!(told.matches("error:").count(), 1, "{told}");
        assert!(!folder.join("out").exists());
    }
}
