//! `--set`, and errors placed where a value came from.

use teeter_scenario::resolve::resolve;
use teeter_scenario::source::Origin;

use crate::{ROCKING, findings, read};

#[test]
fn settings_take_precedence_and_need_no_inner_quotes() {
    let scene = read(
        ROCKING,
        &[
            ("time.step", "50 us"),
            ("time.step", "\"20 us\""),
            ("beam.table.elements", "40"),
            ("beam.table.rayleigh", "{ a1 = '1 us' }"),
            ("block.rocker.velocity", "['1 m/s', '0 m/s']"),
            ("title", "2024"),
            ("ground", "{}"),
            ("material.steel.density", "7850 kg/m^3"),
        ],
    )
    .unwrap();
    assert_eq!(scene.quantity("time.step"), Some(2e-5));
    assert_eq!(scene.integer("beam.table.elements"), Some(40));
    assert_eq!(scene.quantity("beam.table.rayleigh.a0"), Some(0.0));
    assert_eq!(scene.quantity("beam.table.rayleigh.a1"), Some(1e-6));
    assert_eq!(scene.pair("block.rocker.velocity"), Some([1.0, 0.0]));
    assert_eq!(scene.text("title"), Some("2024"));
    assert!(scene.has_table("ground"));
    assert_eq!(scene.names("material"), ["aluminium", "steel"]);
    let origin = scene.origin("beam.table.elements");
    assert!(matches!(origin, Origin::Set { index: 2, text } if text == "beam.table.elements=40"));
}

#[test]
fn wrong_settings_cite_themselves() {
    let pairs = [
        ("time.end", "2"),
        ("beam.table.thicknes", "1 mm"),
        ("beam.tabel.width", "1 cm"),
        ("beam", "2"),
        ("beam.table", "2"),
        ("contact.feet.friction", "-1"),
    ];
    assert_eq!(
        findings(ROCKING, &pairs),
        [
            "--set time.end=2 time.end: a time needs its unit, got a bare number",
            "--set beam.table.thicknes=1 mm beam.table.thicknes: unknown key",
            "--set beam.tabel.width=1 cm beam.tabel: this table is not in the file, and as a new table it lacks material, span, thickness, elements",
            "--set beam=2 beam: a name and a key are missing",
            "--set beam.table=2 beam.table: this is a table, got an integer",
            "--set contact.feet.friction=-1 contact.feet.friction: must be at least 0",
        ]
    );
    let found = read(ROCKING, &pairs).unwrap_err();
    let words: Vec<_> = found.iter().map(|f| f.did_you_mean.as_deref()).collect();
    assert_eq!(words[1..3], [Some("beam.table.thickness"), Some("beam.table")]);
}

#[test]
fn rules_over_several_keys_are_placed_where_the_value_was_written() {
    let scene = read(ROCKING, &[("time.end", "1 s")]).unwrap();
    let place = |path: &str| scene.error(path, "no", "yes").to_string();
    assert!(place("block.rocker.on").starts_with("error: scene.toml:34:12: block.rocker.on = \"table\": no"));
    assert!(place("block.rocker.spin").starts_with("error: scene.toml:29:1: block.rocker.spin = "));
    assert!(place("time.end").starts_with("error: --set time.end=1 s: time.end = \"1 s\": no"));
    assert!(place("beam.table").starts_with("error: scene.toml:18:1: beam.table: no"));
    let warning = scene.error("beam.table.span", "no", "yes").as_warning();
    assert!(warning.to_string().starts_with("warning: "));
}

#[test]
fn a_scene_edited_by_its_document_is_the_scene_read_with_the_setting() {
    let load = |sets: &[(&str, &str)]| {
        let sets: Vec<_> = sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        teeter_scenario::load(ROCKING.as_bytes(), "scene.toml", "scene", &sets).unwrap()
    };
    let edited = load(&[]).document.with("time.step", "50 us").unwrap();
    let edited = resolve(edited, "scene", &mut |_| Err("there is none".to_owned())).unwrap();
    let read = load(&[("time.step", "50 us")]);
    assert_eq!(edited.scene, read.scene);
    assert_eq!(edited.document.to_toml(), read.document.to_toml());
    assert_eq!((edited.scene.time.steps(), load(&[]).scene.time.steps()), (10_000, 5_000));
    // The gap tolerance follows from sizes: it is derived anew, not kept from the scene before.
    let large = edited.document.with("block.rocker.height", "20 m").unwrap();
    assert!(edited.document.has("time.gap_tolerance") && !large.has("time.gap_tolerance"));
}
