//! What a scene means.

use teeter_scenario::document::Document;
use teeter_scenario::keys::{Key, Kind, OnlyWith, Presence, TABLES, TableSchema};
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
    assert_eq!(scene.text("time.scheme"), Some("auto"));
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

/// A table by its path; where keys have a meaning with some words of another key only, once for
/// each of its words.
struct Variant {
    path: String,
    word: Option<(&'static str, &'static str)>,
}

impl Variant {
    fn all(table: &'static TableSchema) -> Vec<Self> {
        let name = match table.pattern {
            pattern if pattern.starts_with("block") => "b",
            // What belongs to a beam belongs to the one of the first word.
            pattern if pattern.starts_with("beam.*.") => "a-rectangle",
            _ => "a",
        };
        let sibling = table.keys.iter().find_map(|key| key.only_with).map(|only| only.sibling);
        let Some(Key { name: sibling, kind: Kind::Choice(words), .. }) = sibling.and_then(|name| table.key(name))
        else {
            return vec![Self { path: table.pattern.replace('*', name), word: None }];
        };
        let path = |word: &str| match table.pattern.strip_suffix("*") {
            Some(group) => format!("{}{name}-{word}", group.replace('*', name)),
            None => table.pattern.replace('*', &format!("{name}-{word}")),
        };
        words.iter().map(|word| Self { path: path(word), word: Some((sibling, word)) }).collect()
    }

    fn has(&self, key: &Key) -> bool {
        let word = |only: OnlyWith| {
            self.word.is_some_and(|(sibling, word)| only.sibling == sibling && only.words.contains(&word))
        };
        key.only_with.is_none_or(word)
    }

    fn write(&self, key: &Key, source: &mut String) {
        match self.word {
            Some((sibling, word)) if sibling == key.name => source.push_str(&format!("{sibling} = '{word}'\n")),
            _ => source.push_str(&format!("{} = {}\n", key.name, key.example)),
        }
    }
}

/// A scene of the keys of all tables that are `wanted`.
fn scene_of(wanted: impl Fn(&TableSchema, &Key) -> bool) -> Document {
    let mut source = String::new();
    for table in TABLES {
        for variant in Variant::all(table) {
            if let Some(block) = variant.path.strip_suffix(".shape").filter(|path| path.starts_with("block")) {
                // A block for each kind of shape, with what that doesn't give.
                source.push_str(&format!("[{block}]\nmaterial = 'a'\ndepth = '1 m'\n"));
            }
            if !table.pattern.is_empty() {
                source.push_str(&format!("[{}]\n", variant.path));
            }
            for key in table.keys.iter().filter(|key| variant.has(key) && wanted(table, key)) {
                variant.write(key, &mut source);
            }
        }
    }
    read(&source, &[]).unwrap()
}

#[test]
fn the_examples_and_defaults_of_the_table_are_valid() {
    // A scene in which every key that is built in stands with its example.
    let scene = scene_of(|_, key| {
        if let Kind::Choice(words) | Kind::ChoicePair(words) = key.kind {
            assert!(key.reserved.iter().all(|later| !words.contains(&later.value)), "{}", key.name);
        }
        key.presence != Presence::NotYet
    });
    assert_eq!(scene.quantity("beam.a-rectangle.rayleigh.a1"), Some(1e-5));
    // And one with nothing but what is required, so that every default is decoded.
    let scene = scene_of(|table, key| {
        let is_sibling =
            |other: &Key| matches!(other.presence, Presence::DefaultWith { sibling, .. } if sibling == key.name);
        // The words of the variants.
        let first = table.keys.iter().find_map(|key| key.only_with).map(|only| only.sibling);
        matches!(
            key.presence,
            Presence::Required
                | Presence::RequiredWith(_)
                | Presence::RequiredWithout(_)
                | Presence::RequiredWithoutAny(_)
        ) || table.keys.iter().any(is_sibling)
            || first == Some(key.name)
    });
    for table in TABLES {
        for variant in Variant::all(table) {
            for key in table.keys.iter().filter(|key| variant.word.is_none_or(|(sibling, _)| sibling != key.name)) {
                let path = format!("{}.{}", variant.path, key.name);
                let path = path.trim_start_matches('.');
                if !variant.has(key) {
                    assert!(!scene.has(path), "{path}");
                } else if matches!(
                    key.presence,
                    Presence::Default(_) | Presence::DefaultWith { .. } | Presence::DefaultWithout { .. }
                ) {
                    assert_eq!(scene.origin(path), Origin::Default, "{path}");
                    assert!(scene.has(path), "{path}");
                }
            }
        }
    }
}
