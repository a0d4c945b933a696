//! Scenes of many blocks: what they are told to cost, and when they are too many.

use teeter_scenario::load;
use teeter_scenario::volume::{MOST_OPERATOR_BYTES, accuracy_of_seconds, expected_seconds, operator_bytes};

/// So many blocks of 1 cm beside each other, on the ground or on a beam.
fn row_of_blocks(blocks: usize, on: &str) -> String {
    let mut text = String::from(
        "[time]\nend = '20 ms'\nstep = '100 us'\n[ground]\n[material.m]\ndensity = '2700 kg/m^3'\nyoungs_modulus = '69 GPa'\n\
         [beam.b]\nmaterial = 'm'\nspan = '50 m'\nwidth = '3 cm'\nthickness = '1 m'\nelements = 200\n\
         supports = ['pinned', 'pinned']\nposition = ['0 m', '-9 m']\n",
    );
    for k in 0..blocks {
        let at = 0.1 + 0.02 * k as f64;
        text.push_str(&format!(
            "[block.b{k}]\nmaterial = 'm'\nwidth = '1 cm'\nheight = '1 cm'\ndepth = '1 cm'\non = '{on}'\nat = '{at} m'\n\
             [contact.c{k}]\nbetween = ['b{k}', '{on}']\nfriction = 0.3\n",
        ));
    }
    text
}

#[test]
fn many_contacts_are_told_to_cost_more_than_their_number() {
    // Times of a trial: 20 cubes on a beam 0.12 s, 3000 blocks on the ground 0.7 s a step; either was told as less than a tenth.
    let told = |blocks, on, dofs| {
        let scene = load(row_of_blocks(blocks, on).as_bytes(), "f", "f", &[]).unwrap().scene;
        assert!(accuracy_of_seconds(&scene).contains("order of magnitude"));
        expected_seconds(&scene, dofs)
    };
    let cubes = told(20, "b", 400);
    assert!(cubes > 0.04 && cubes < 0.4, "{cubes}");
    let (few, many) = (told(30, "ground", 0), told(300, "ground", 0));
    assert!(many > 30.0 * few, "{few} {many}");
    let one = load(row_of_blocks(1, "b").as_bytes(), "f", "f", &[]).unwrap().scene;
    assert!(accuracy_of_seconds(&one).contains("three") && expected_seconds(&one, 400) < 0.01);
}

#[test]
fn more_contacts_than_memory_holds_are_refused_before_anything_is_made() {
    assert_eq!(operator_bytes(40_000), 51.2e9);
    assert!(operator_bytes(2 * 3000) < MOST_OPERATOR_BYTES);
    let refused = load(row_of_blocks(6000, "ground").as_bytes(), "f", "f", &[]).expect_err("taken").to_string();
    assert!(
        refused.contains("6000 contacts") && refused.contains("4.6 GB") && refused.contains("limit of 4.0 GB"),
        "{refused}"
    );
}
