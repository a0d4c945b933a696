//! Mistakes of all kinds told in one go: wrong values beside wrong references, and nothing twice.

use crate::ROCKING;
use teeter_scenario::load;
use teeter_scenario::simulation::Simulation;

/// "path: rule" of each finding about the interface's scene with pieces replaced.
fn told(changes: &[(&str, &str)], sets: &[(&str, &str)]) -> Vec<String> {
    let mut text = ROCKING.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let Err(found) = load(text.as_bytes(), "scene.toml", "scene", &crate::sets(sets)) else {
        return Vec::new();
    };
    found.iter().map(|found| format!("{}: {}", found.path, found.rule)).collect()
}

#[test]
fn a_wrong_value_does_not_hide_a_wrong_reference() {
    let found = told(
        &[
            ("[block.rocker]\nmaterial = \"aluminium\"", "[block.rocker]\nmaterial = \"steel\""),
            ("\"36 cm\"", "36"),
            ("[\"rocker\", \"table\"]", "[\"rocker\", \"tabel\"]"),
        ],
        &[("time.theta", "3"), ("time.theta", "2"), ("block.rocker.velocity", "1")],
    );
    assert_eq!(
        found,
        [
            "beam.table.span: a length needs its unit, got a bare number",
            "block.rocker.material: the material `steel` is not defined",
            "contact.feet.between: there is no body `tabel`",
            "time.theta: must lie in [0, 1]",
            "block.rocker.velocity: an array of two, each a velocity with its unit, is expected, got an integer",
        ]
    );
}

#[test]
fn what_was_refused_is_not_missing_as_well() {
    for (from, to) in [
        ("on       = \"table\"", "on = 3"),
        ("at       = \"18 cm\"", "at = 3"),
        ("tilt     = \"5 deg\"", "tilt = 3"),
        ("youngs_modulus = \"69 GPa\"", "youngs_modulus = 69"),
        ("density        = \"2700 kg/m^3\"", "density = 2700"),
        ("between     = [\"rocker\", \"table\"]", "between = 3"),
        ("friction    = 0.5", "friction = -1"),
        ("damping_ratio = { mode = 1, ratio = 0.01 }", "damping_ratio = 3"),
        ("end    =", "ende ="),
        ("[time]", "[tiem]"),
        ("[material.aluminium]", "[materials.aluminium]"),
        ("[beam.table]", "[beams.table]"),
        ("[block.rocker]", "[blok.rocker]"),
        ("[block.rocker]", "[block.\"rock er\"]"),
        ("[contact.feet]", "[contacts.feet]"),
    ] {
        let found = told(&[(from, to)], &[]);
        assert_eq!(found.len(), 1, "{from} → {to}: {found:#?}");
    }
}

#[test]
fn a_place_is_asked_for_where_a_block_stands_on_something() {
    let found = told(&[("at       = \"18 cm\"", "")], &[]);
    assert_eq!(found, ["block.rocker.at: required with on"]);
}

#[test]
fn meshes_are_bounded_in_sum() {
    let beam = "material = 'aluminium'\nspan = '1 m'\nwidth = '1 cm'\nthickness = '1 cm'\nelements = 10000\n";
    let beams: String = (0..3).map(|k| format!("[beam.b{k}]\n{beam}")).collect();
    let found = told(&[("[block.rocker]", &format!("{beams}[block.rocker]"))], &[]);
    assert_eq!(found, ["beam.b1.elements: with this beam the scene has 20020 elements, over the limit of 20000"]);
}

#[test]
fn what_the_assembled_beam_refuses_is_told_at_its_key() {
    let sets = crate::sets(&[("beam.table.elements", "1"), ("beam.table.supports", "['clamped', 'clamped']")]);
    let found = load(ROCKING.as_bytes(), "scene.toml", "scene", &sets).unwrap_err();
    let clamped = found.iter().next().unwrap();
    assert_eq!((clamped.path.as_str(), clamped.written.as_deref()), ("beam.table.elements", Some("1")));
    assert!(clamped.rule.contains("at least 2") && clamped.remedy.is_some());
}

#[test]
fn what_building_refuses_is_told_at_its_key() {
    let built = |sets: &[(&str, &str)]| {
        let resolved = load(ROCKING.as_bytes(), "scene.toml", "scene", &crate::sets(sets)).unwrap();
        let error = Simulation::new(&resolved.scene).unwrap_err();
        error.diagnostic(&resolved.document)
    };
    let tiny =
        built(&[("beam.table.span", "0.04 m"), ("beam.table.thickness", "1e-12 m"), ("block.rocker.at", "2 cm")]);
    assert!(tiny.path.starts_with("beam.table.") || tiny.path.starts_with("block.rocker."), "{tiny}");
    assert!(tiny.set.is_some() || tiny.position.is_some(), "{tiny}");
}
