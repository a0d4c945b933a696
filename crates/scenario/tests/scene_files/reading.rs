//! What a scene means.

use teeter_scenario::keys::{Kind, Presence, TABLES};
use teeter_scenario::source::Origin;

use crate::{ROCKING, findings, read};

#[test]
fn the_scene_of_the_interface_reads_to_si_values() {
    let scene = read(ROCKING, &[]).unwrap();
    assert_eq!(scene.quantity("time.step"), Some(1e-4));
    assert_eq!(scene.quantity("beam.table.span"), Some(0.36));
    assert_eq!(scene.quantity("beam.table.thickness"), Some(0.0015));
    assert_eq!(scene.quantity("material.aluminium.youngs_modulus"), Some(69e9));
    assert_eq!(scene.quantity("block.rocker.tilt"), Some(0.087_266_462_599_716_47));
    assert_eq!(scene.integer("beam.table.elements"), Some(20));
    assert_eq!(scene.number("beam.table.damping_ratio.ratio"), Some(0.01));
    assert_eq!(scene.pair("world.gravity"), Some([0.0, -9.81]));
    assert_eq!(scene.text_pair("contact.feet.between"), Some(["rocker", "table"]));
    assert_eq!(scene.flag("solver.require_convergence"), Some(false));
    assert_eq!(scene.names("block"), ["rocker"]);
    assert_eq!(scene.line("beam.table.span"), Some(20));
    assert!(scene.has_table("beam.table.damping_ratio") && !scene.has_table("ground"));
}

#[test]
fn what_is_left_out_has_its_default() {
    let scene = read(
        "[time]\nend = '1 s'\nstep = '1 ms'\n\
         [block.b]\nmaterial = 'm'\nwidth = '1 m'\nheight = '1 m'\ndepth = '1 m'\non = 'ground'\n",
        &[],
    )
    .unwrap();
    assert_eq!(scene.text("time.scheme"), Some("moreau-jean"));
    assert_eq!(scene.number("time.theta"), Some(0.5));
    assert_eq!(scene.integer("solver.max_iterations"), Some(10_000));
    assert_eq!(scene.pair("block.b.velocity"), Some([0.0, 0.0]));
    assert_eq!(scene.origin("time.theta"), Origin::Default);
    assert!(!scene.is_given("time.theta") && scene.is_given("time.end"));
    // Of the two ways to place a block only the one that is used has its default.
    assert_eq!(scene.quantity("block.b.tilt"), Some(0.0));
    assert!(!scene.has("block.b.angle"));
    // Left to whoever resolves the scene.
    assert!(!scene.has("title") && !scene.has("time.gap_tolerance") && !scene.has("output.every"));
}

#[test]
fn a_getter_of_another_kind_gives_nothing() {
    let scene = read(ROCKING, &[]).unwrap();
    assert_eq!(scene.number("time.end"), None);
    assert_eq!(scene.quantity("time.theta"), None);
    assert_eq!(scene.text("time.end"), None);
    assert_eq!(scene.integer("nowhere.at.all"), None);
    assert_eq!(scene.pair("world"), None);
    assert_eq!(scene.list(""), None);
    assert!(scene.names("nobody").is_empty());
}

#[test]
fn byte_order_mark_and_windows_line_ends_are_no_mistake() {
    let windows = format!("\u{feff}{}", ROCKING.replace('\n', "\r\n"));
    let scene = read(&windows, &[]).unwrap();
    assert_eq!(scene.to_toml(), read(ROCKING, &[]).unwrap().to_toml());
    let broken = windows.replace("0.15 cm", "-1 cm");
    assert_eq!(findings(&broken, &[]), ["22:13 beam.table.thickness: must be greater than 0 m"]);
    assert_eq!(findings("\u{feff}titel = 'x'\r\n", &[])[1], "1:1 titel: unknown key");
}

#[test]
fn the_examples_and_defaults_of_the_table_are_valid() {
    // A scene in which every key that is built in stands with its example.
    let mut source = String::new();
    for table in TABLES {
        let name = if table.pattern.starts_with("block") { "b" } else { "a" };
        if !table.pattern.is_empty() {
            source.push_str(&format!("[{}]\n", table.pattern.replace('*', name)));
        }
        for key in table.keys.iter().filter(|key| key.presence != Presence::NotYet) {
            source.push_str(&format!("{} = {}\n", key.name, key.example));
            if let Kind::Choice(words) | Kind::ChoicePair(words) = key.kind {
                assert!(key.reserved.iter().all(|later| !words.contains(&later.value)), "{}", key.name);
            }
        }
    }
    let scene = read(&source, &[]).unwrap();
    assert_eq!(scene.quantity("beam.a.rayleigh.a1"), Some(1e-5));
    // And one with nothing but what is required, so that every default is decoded.
    let mut source = String::new();
    for table in TABLES {
        let name = if table.pattern.starts_with("block") { "b" } else { "a" };
        if !table.pattern.is_empty() {
            source.push_str(&format!("[{}]\n", table.pattern.replace('*', name)));
        }
        for key in table.keys {
            let sibling = table
                .keys
                .iter()
                .any(|other| matches!(other.presence, Presence::DefaultWith { sibling, .. } if sibling == key.name));
            if key.presence == Presence::Required || sibling {
                source.push_str(&format!("{} = {}\n", key.name, key.example));
            }
        }
    }
    let scene = read(&source, &[]).unwrap();
    for table in TABLES {
        let name = if table.pattern.starts_with("block") { "b" } else { "a" };
        for key in table.keys {
            let path = format!("{}.{}", table.pattern.replace('*', name), key.name);
            let path = path.trim_start_matches('.');
            if matches!(key.presence, Presence::Default(_) | Presence::DefaultWith { .. }) {
                assert_eq!(scene.origin(path), Origin::Default, "{path}");
                assert!(scene.has(path), "{path}");
            }
        }
    }
}
