//! The scene as run, and what follows from other values.

use teeter_scenario::document::SetError;
use teeter_scenario::document::{Document, Entry};
use teeter_scenario::source::Origin;
use teeter_scenario::value::Value;

use crate::{ROCKING, SHORT, read};

#[test]
fn the_scene_as_run_reads_back_to_the_same_values_and_bytes() {
    let mut scene = read(
        ROCKING,
        &[
            ("world.gravity", "['0.1 m/s^2', '-9.7 m/s^2']"),
            ("beam.table.probes", "['9 cm', '0.1 m']"),
            ("beam.table.rayleigh", "{ a0 = '0.3 1/s' }"),
            ("title", "a \"quoted\" title \\ µ"),
            ("block.z.material", "m"),
            ("block.z.width", "1 mm"),
            ("block.z.height", "0.3 km"),
            ("block.z.depth", "7 um"),
            ("block.z.position", "['-1e-17 m', '1 cm']"),
            ("ground", "{}"),
        ],
    )
    .unwrap();
    scene.set("time.gap_tolerance", Value::Number(1e-12)).unwrap();
    let written = scene.to_toml();
    let again = read(&written, &[]).unwrap();
    assert_eq!(again.to_toml(), written);
    assert_eq!(again.names("block"), scene.names("block"));
    let values = |scene: &Document| -> Vec<(String, String)> {
        // {:?} of a double is exact.
        let show = |(path, entry): (&str, &Entry)| (path.to_owned(), format!("{:?}", entry.value));
        scene.entries().map(show).collect()
    };
    assert_eq!(values(&again), values(&scene));
    assert!(written.contains("\n[ground]\n"));
    assert!(written.contains("rayleigh = { a0 = \"0.3 1/s\", a1 = \"0 s\" }"));
}

#[test]
fn derived_values_go_by_the_table_of_keys() {
    let mut scene = read(SHORT, &[]).unwrap();
    assert_eq!(scene.set("title", Value::Text("scene".to_owned())), Ok(()));
    assert_eq!(scene.origin("title"), Origin::Derived);
    let key = |name: &str| name.to_owned();
    assert_eq!(scene.set("time.titel", Value::Number(1.0)), Err(SetError::NoSuchKey(key("time.titel"))));
    assert_eq!(scene.set("beam.x.span", Value::Number(1.0)), Err(SetError::NoSuchKey(key("beam.x.span"))));
    assert_eq!(scene.set("time.theta", Value::Flag(true)), Err(SetError::WrongType(key("time.theta"))));
    assert_eq!(
        scene.set("time.theta", Value::Number(2.0)),
        Err(SetError::NotAllowed(key("time.theta"), key("must lie in [0, 1]")))
    );
}

#[test]
fn damaged_scenes_never_crash_and_keep_their_spans_inside_the_text() {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut next = move |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        usize::try_from(state % u64::try_from(below).unwrap()).unwrap()
    };
    let pieces =
        ["\"", "'", "[", "]", "{", "}", "=", ".", ",", "\n", "#", "1", "-", "e", "nan", "µ", " ", "\r", "[[", "\"\"\""];
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..3000 {
        let mut source = ROCKING.to_owned();
        for _ in 0..=next(3) {
            let at = next(source.len());
            if source.is_char_boundary(at) {
                if next(2) == 0 {
                    source.insert_str(at, pieces[next(pieces.len())]);
                } else if source.is_char_boundary(at + 1) {
                    source.remove(at);
                }
            }
        }
        match read(&source, &[]) {
            Ok(scene) => {
                accepted += 1;
                let written = scene.to_toml();
                assert_eq!(read(&written, &[]).unwrap().to_toml(), written);
            }
            Err(found) => {
                refused += 1;
                for finding in found.iter() {
                    assert!(finding.span.clone().is_none_or(|span| source.get(span).is_some()), "{finding}");
                }
            }
        }
    }
    assert!(accepted > 100 && refused > 100, "{accepted} {refused}");
}
