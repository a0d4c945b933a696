//! Scenes of one text with other numbers, made one after the other of parts that they share.

use std::path::Path;
use teeter_scenario::ParsedScene;
use teeter_scenario::resolve::SharedParts;
use teeter_scenario::source::Origin;
use teeter_scenario::value::Value;

/// A value as written, with another number in the place of its own.
fn other(written: &str) -> String {
    let unit = written.find(|c: char| !c.is_ascii_digit() && !".-+eE".contains(c)).unwrap_or(written.len());
    // Units follow a space, so the `e` here is that of an exponent.
    let (number, unit) = written.split_at(unit);
    match (number.parse::<i64>(), number.parse::<f64>()) {
        (Ok(whole), _) if unit.is_empty() => (whole + 1).to_string(),
        (_, Ok(number)) => format!("{:?}{unit}", 1.125 * number),
        _ => panic!("{written} has no number"),
    }
}

/// Each number of each scene, one after the other: it reaches some parts, and the others stay.
#[test]
fn whichever_number_changes_the_scene_is_that_of_the_text_alone() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let mut changed = 0;
    for file in std::fs::read_dir(&folder).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let mut read = |file: &str| std::fs::read(folder.join(file)).map_err(|error| error.to_string());
        let parsed = ParsedScene::new(&std::fs::read(&path).unwrap(), &name).unwrap();
        let of_file = parsed.load("s", &[], &mut read).unwrap().document;
        let numbers: Vec<(String, String)> = of_file
            .entries()
            .filter(|(_, entry)| matches!(entry.value, Value::Number(_) | Value::Integer(_)))
            .filter(|(_, entry)| matches!(entry.origin, Origin::File(_)))
            .map(|(path, entry)| (path.to_owned(), entry.written.trim_matches(['"', '\'']).to_owned()))
            .collect();
        let shared = SharedParts::default();
        let mut compare = |sets: &[(String, String)], what: &str| {
            let alone = parsed.load("s", sets, &mut read);
            let alone = alone.map(|found| (format!("{:?}", found.scene), found.warnings)).map_err(|e| e.to_string());
            let with_parts = parsed.scene_with_warnings("s", sets, &shared, &mut read);
            let with_parts =
                with_parts.map(|(scene, warned)| (format!("{scene:?}"), warned)).map_err(|e| e.to_string());
            assert!(alone == with_parts, "{name}, {what}: {:?} {:?}", alone.err(), with_parts.err());
        };
        compare(&numbers, "as it is");
        for number in 0..numbers.len() {
            let mut sets = numbers.clone();
            sets[number].1 = other(&sets[number].1);
            compare(&sets, &sets[number].0);
            // And one that lies elsewhere in the text beside it.
            let second = (number + numbers.len() / 2) % numbers.len();
            if second != number {
                sets[second].1 = other(&sets[second].1);
                compare(&sets, &format!("{} and {}", sets[number].0, sets[second].0));
            }
            changed += 1;
        }
        compare(&numbers, "again as it is");
    }
    assert!(changed > 200, "{changed} numbers");
}
