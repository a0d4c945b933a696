//! Documents of a schema that is nobody's: plants of pipes and tanks.
#![allow(clippy::unwrap_used, reason = "a test that finds nothing fails")]

use teeter_text::decode::{self, parse};
use teeter_text::diagnostic::Diagnostics;
use teeter_text::dimension::Dimension;
use teeter_text::document::{Document, SetError, SettingsRead};
use teeter_text::keys::{Key, Kind, Occurrence, PathTarget, Presence, Range, TableSchema};
use teeter_text::schema::{FileAdvice, NameReference, Namespace, Schema};
use teeter_text::source::Origin;
use teeter_text::value::Value;

const LENGTH: Kind = Kind::Quantity(Dimension::LENGTH, Range::POSITIVE);

static TABLES: &[TableSchema] = &[
    TableSchema {
        pattern: "",
        occurrence: Occurrence::Always,
        doc: "The plant.",
        keys: &[Key::new("title", Kind::Text, Presence::Optional, "\"a plant\"", "What it is called.")],
    },
    TableSchema {
        pattern: "site",
        occurrence: Occurrence::Always,
        doc: "Where it stands.",
        keys: &[
            Key::new("wind", Kind::Downward(Dimension::VELOCITY), Presence::Default("\"1 m/s\""), "\"1 m/s\"", "Wind."),
            Key::new("workers", Kind::Integer { min: 1, max: 100 }, Presence::Default("3"), "3", "Who works there."),
        ],
    },
    TableSchema {
        pattern: "fluid.*",
        occurrence: Occurrence::Named,
        doc: "What flows.",
        keys: &[Key::new(
            "density",
            Kind::Quantity(Dimension::DENSITY, Range::POSITIVE),
            Presence::Required,
            "\"1 t/m^3\"",
            "Its density.",
        )],
    },
    TableSchema {
        pattern: "pipe.*",
        occurrence: Occurrence::Named,
        doc: "A pipe.",
        keys: &[
            Key::new("fluid", Kind::Name, Presence::Required, "\"water\"", "What flows in it."),
            Key::new(
                "wall",
                Kind::Choice(&["smooth", "rough"]),
                Presence::Default("\"smooth\""),
                "\"rough\"",
                "Its wall.",
            ),
            Key::new("grain", LENGTH, Presence::Default("\"1 mm\""), "\"2 mm\"", "Size of the grains.")
                .only_with("wall", &["rough"]),
        ],
    },
    TableSchema {
        pattern: "tank.*",
        occurrence: Occurrence::Named,
        doc: "A tank.",
        keys: &[Key::new("fluid", Kind::Name, Presence::Required, "\"water\"", "What it holds.")],
    },
];

static PLANT: Schema = Schema::new("installation", TABLES)
    .with_namespaces(&[Namespace { groups: &["pipe", "tank"], taken: &["site"] }])
    .with_references(&[NameReference { group: "fluid", from: &["pipe", "tank"], key: "fluid" }])
    .with_advice(FileAdvice { empty: Some("give it a pipe"), other_file: None, too_deep: None });

const TEXT: &str = "[fluid.water]\ndensity = '1 t/m^3'\n[pipe.main]\nfluid = 'water'\nwall = 'rough'\n";

fn read(text: &str) -> Result<Document, Diagnostics> {
    parse(&PLANT, text, "plant.toml", &[])
}

fn rules(found: &Diagnostics) -> Vec<String> {
    found.iter().map(|found| format!("{}: {}", found.path, found.rule)).collect()
}

#[test]
fn values_are_in_si_units_and_defaults_follow_the_words_they_go_with() {
    let plant = read(TEXT).unwrap();
    assert_eq!(plant.quantity("fluid.water.density"), Some(1000.0));
    assert_eq!(plant.quantity("pipe.main.grain"), Some(1e-3));
    assert_eq!(plant.pair("site.wind"), Some([0.0, -1.0]));
    assert_eq!(plant.names("pipe"), ["main"]);
    assert_eq!(plant.line("pipe.main.wall"), Some(5));
}

#[test]
fn what_is_written_out_reads_back_to_the_same() {
    let plant = read(TEXT).unwrap();
    let once = plant.to_toml();
    assert_eq!(read(&once).unwrap().to_toml(), once);
    assert!(once.contains("\n[pipe.main]\nfluid = \"water\"\nwall = \"rough\"\ngrain = \"1 mm\"\n"), "{once}");
}

#[test]
fn a_copy_with_another_value_is_what_reading_with_the_setting_gives() {
    let plant = read(TEXT).unwrap();
    let fewer = plant.with("site.workers", 2).unwrap();
    assert_eq!((fewer.integer("site.workers"), plant.integer("site.workers")), (Some(2), Some(3)));
    let both = fewer.with("pipe.main.grain", "3 mm").unwrap();
    assert_eq!((both.integer("site.workers"), both.quantity("pipe.main.grain")), (Some(2), Some(3e-3)));
    assert!(matches!(both.origin("pipe.main.grain"), Origin::Set { index: 1, .. }));
    let sets = [("site.workers", "2"), ("pipe.main.grain", "3 mm")].map(|(key, value)| (key.into(), value.into()));
    assert_eq!(both.to_toml(), parse(&PLANT, TEXT, "plant.toml", &sets).unwrap().to_toml());
    // A text of digits needs no quotes, and a word takes the defaults with it that go with another
    // one.
    assert_eq!(plant.with("title", 7).unwrap().text("title"), Some("7"));
    assert!(!plant.with("pipe.main.wall", "smooth").unwrap().has("pipe.main.grain"));
}

#[test]
fn a_copy_is_checked_as_the_file_is() {
    let plant = read(TEXT).unwrap();
    let refused = |key: &str, value: &str| rules(&plant.with(key, value).unwrap_err());
    assert_eq!(refused("site.workers", "0"), ["site.workers: must be at least 1"]);
    assert_eq!(refused("site.worker", "1"), ["site.worker: unknown key"]);
    let smooth = plant.with("pipe.main.wall", "smooth").unwrap();
    let refused = smooth.with("pipe.main.grain", "1 mm").unwrap_err();
    assert_eq!(rules(&refused), ["pipe.main.grain: grain has no meaning with wall = smooth"]);
    assert_eq!(refused.0[0].set.as_deref(), Some("pipe.main.grain=1 mm"));
}

#[test]
fn a_copy_leaves_out_what_was_derived() {
    let mut plant = read(TEXT).unwrap();
    plant.set("title", Value::Text("derived".to_owned())).unwrap();
    assert_eq!(plant.set("pipe.other.fluid", Value::Text("water".to_owned())).unwrap_err(), {
        SetError::NoSuchKey("pipe.other.fluid".to_owned())
    });
    assert!(plant.has("title") && !plant.with("site.workers", 2).unwrap().has("title"));
}

#[test]
fn names_are_unique_over_a_namespace_and_some_are_taken() {
    let text = format!("{TEXT}[tank.main]\nfluid = 'water'\n[tank.site]\nfluid = 'water'\n");
    let found = read(&text).unwrap_err();
    assert_eq!(
        rules(&found),
        [
            "tank.main: the name `main` is already used by pipe.main on line 3",
            "tank.site: the name `site` is reserved for the site",
        ]
    );
    assert_eq!(found.0[0].remedy.as_deref(), Some("use a different name: names must be unique over pipes and tanks"));
}

#[test]
fn of_a_key_that_is_missing_it_is_said_who_needs_it() {
    let found = read("[fluid.water]\n[pipe.main]\nfluid = 'water'\n[tank.top]\nfluid = 'water'\n").unwrap_err();
    assert_eq!(rules(&found), ["fluid.water.density: missing, used by pipe.main, tank.top"]);
}

#[test]
fn messages_call_a_document_by_its_noun() {
    let told = |found: &Diagnostics| (found.0[0].rule.clone(), found.0[0].remedy.clone().unwrap());
    let (rule, remedy) = told(&read("").unwrap_err());
    assert_eq!((rule.as_str(), remedy.as_str()), ("the file contains no installation: it is empty", "give it a pipe"));
    let (rule, remedy) = told(&decode::text(&PLANT, b"\xff", "plant.toml").unwrap_err());
    assert_eq!(rule, "not a text file in UTF-8: byte 0 cannot be read");
    assert_eq!(remedy, "an installation is a TOML file");
    let (rule, remedy) = told(&read("density = 1").unwrap_err());
    assert_eq!(rule, "unknown key");
    assert_eq!(
        remedy,
        "the keys allowed at the top of an installation are title, site, fluid, pipe, tank; density is a key of [fluid.NAME]"
    );
}

#[test]
fn a_vector_that_points_downwards_is_one_number_that_is_not_negative() {
    let wind = |value: &str| read(TEXT).unwrap().with("site.wind", value);
    assert_eq!(wind("2 m/s").unwrap().pair("site.wind"), Some([0.0, -2.0]));
    assert_eq!(wind("['3 m/s', '1 m/s']").unwrap().pair("site.wind"), Some([3.0, 1.0]));
    let found = wind("-2 m/s").unwrap_err();
    assert_eq!(
        found.0[0].remedy.as_deref(),
        Some("a single number points downwards; for upwards write a vector such as [\"0 m/s\", \"1 m/s\"]")
    );
}

#[test]
fn paths_find_keys_tables_and_groups() {
    assert!(matches!(PLANT.find("pipe.main.grain"), Some(PathTarget::Key(_, key)) if key.name == "grain"));
    assert!(matches!(PLANT.find("pipe.main"), Some(PathTarget::Table(_))));
    assert!(matches!(PLANT.find("pipe"), Some(PathTarget::Group(_))));
    assert!(PLANT.find("pipe.main.colour").is_none() && PLANT.find("site.wind.x").is_none());
}

#[test]
fn other_numbers_give_the_document_that_reading_gives() {
    let sets = |density: &str, workers: &str, wall: &str| {
        [("fluid.water.density", density), ("site.workers", workers), ("pipe.main.wall", wall)]
            .map(|(key, value)| (key.to_owned(), value.to_owned()))
    };
    let read = |sets: &[(String, String)]| parse(&PLANT, TEXT, "plant.toml", sets);
    let entries = |document: &Document| {
        let of = document
            .entries()
            .map(|(path, of)| (path.to_owned(), of.value.clone(), of.origin.clone(), of.written.clone(), of.key.name));
        of.collect::<Vec<_>>()
    };
    let with_numbers = |document: &Document, sets: &[(String, String)]| {
        let mut changed = document.clone();
        changed.take_numbers(sets).then_some(changed)
    };
    let first = read(&sets("900 kg/m^3", "7", "rough")).unwrap();
    let other = sets("1.1 t/m^3", "8", "rough");
    let quick = with_numbers(&first, &other).unwrap();
    assert_eq!(entries(&quick), entries(&read(&other).unwrap()));
    let mut in_place = first.clone();
    assert!(in_place.take_numbers(&other) && entries(&in_place) == entries(&quick));
    // From one change to the next nothing of those before is left.
    assert!(in_place.take_numbers(&sets("900 kg/m^3", "7", "rough")) && entries(&in_place) == entries(&first));
    assert_eq!(quick.quantity("fluid.water.density"), Some(1100.0));
    assert_eq!(quick.to_toml(), read(&other).unwrap().to_toml());
    // As if it had been read so: it can be changed on.
    assert_eq!(
        entries(&quick.with("site.workers", 9).unwrap()),
        entries(&read(&other).unwrap().with("site.workers", 9).unwrap())
    );

    // Reading has to tell what a word changes, what is wrong, and what other keys do.
    for told in [
        sets("900 kg/m^3", "7", "smooth"),
        sets("-1 kg/m^3", "7", "rough"),
        sets("900 kg", "7", "rough"),
        sets("900 kg/m^3", "200", "rough"),
    ] {
        assert!(with_numbers(&first, &told).is_none(), "{told:?}");
        let mut unchanged = first.clone();
        assert!(!unchanged.take_numbers(&told) && entries(&unchanged) == entries(&first), "{told:?}");
    }
    assert!(with_numbers(&first, &sets("900 kg/m^3", "7", "rough")[..2]).is_none());
    // The last setting of a key counts.
    let twice = |last: &str| {
        [("site.workers", "5"), ("site.workers", last)].map(|(key, value)| (key.to_owned(), value.to_owned()))
    };
    let of_two = read(&twice("6")).unwrap();
    assert_eq!(with_numbers(&of_two, &twice("4")).unwrap().integer("site.workers"), Some(4));
    let mut first_of_two = twice("6");
    first_of_two[0].1 = "3".to_owned();
    assert!(with_numbers(&of_two, &first_of_two).is_none(), "not by the first of two");
}

#[test]
fn what_is_made_of_a_document_tells_which_settings_were_read() {
    let sets = |density: &str, workers: &str| {
        [("fluid.water.density", density), ("site.workers", workers)].map(|(key, of)| (key.to_owned(), of.to_owned()))
    };
    let mut document = parse(&PLANT, TEXT, "plant.toml", &sets("900 kg/m^3", "7")).unwrap();
    let of_density = document.settings_read(|| document.quantity("fluid.water.density"));
    assert_eq!(of_density.0, Some(900.0));
    let of_workers = document.settings_read(|| document.integer("site.workers")).1;
    // Whether a key has a value is the same with other numbers; keys of the file don't change.
    let of_none = document.settings_read(|| (document.has("site.workers"), document.text("pipe.main.wall").is_some()));
    // By whichever way a value is read: a message quotes it.
    let ways: [&dyn Fn() -> bool; 5] = [
        &|| document.entry("site.workers").is_some(),
        &|| document.entries_from("site.w").count() > 0,
        &|| document.entries().count() > 0,
        &|| document.error("site.workers", "", "").written.is_some(),
        &|| document.settings_read(|| document.integer("site.workers")).0.is_some(),
    ];
    let ways: Vec<SettingsRead> = ways.iter().map(|way| document.settings_read(way).1).collect();
    for (density, workers) in [("900 kg/m^3", "7"), ("900 kg/m^3", "8"), ("950 kg/m^3", "7"), ("950 kg/m^3", "8")] {
        assert!(document.take_numbers(&sets(density, workers)));
        let same = [density == "900 kg/m^3", workers == "7"];
        let read = [&of_density.1, &of_workers, &of_none.1].map(|read| document.has_settings(read));
        assert_eq!(read, [same[0], same[1], true]);
        assert_eq!(document.has_settings(&of_density.1.and(&of_workers)), same == [true; 2]);
        assert!(ways.iter().all(|read| same[1] || !document.has_settings(read)), "{density}, {workers}");
    }
}
