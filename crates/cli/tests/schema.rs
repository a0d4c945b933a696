//! The JSON Schema and the reference page, both made from the table of keys.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[allow(dead_code)] // of the rows what the messages say
#[path = "bad_inputs/rows.rs"]
mod rows;

use regex::Regex;
use rows::{Input, PILE, STACKED, rows};
use serde_json::Value;
use std::cell::RefCell;
use std::collections::HashMap;
use std::path::Path;
use std::process::Command;
use teeter_scenario::keys::{Kind, Occurrence, Presence, TABLES};

fn teeter(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_teeter")).args(arguments).output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty());
    String::from_utf8(output.stdout).unwrap()
}

fn schema() -> Value {
    serde_json::from_str(&teeter(&["schema"])).unwrap()
}

/// The schema of the table with this pattern.
fn table<'s>(schema: &'s Value, pattern: &str) -> &'s Value {
    pattern.split('.').filter(|part| !part.is_empty()).fold(schema, |above, part| {
        if part == "*" {
            above["patternProperties"].as_object().unwrap().values().next().unwrap()
        } else {
            &above["properties"][part]
        }
    })
}

#[test]
fn each_key_of_the_table_is_in_the_schema_with_its_default() {
    let schema = schema();
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    for keys in TABLES {
        let object = table(&schema, keys.pattern);
        assert_eq!(object["additionalProperties"], false, "[{}]", keys.pattern);
        for key in keys.keys {
            let property = &object["properties"][key.name];
            let what = format!("{}.{}", keys.pattern, key.name);
            assert!(property["description"].as_str().is_some_and(|text| text.starts_with(key.doc)), "{what}");
            let required = object["required"].as_array().is_some_and(|names| names.iter().any(|name| name == key.name));
            // What is required with some words of another key only, the program asks for.
            assert_eq!(required, key.presence == Presence::Required && key.only_with.is_none(), "{what}");
            if let Some(only) = key.only_with {
                let text = property["description"].as_str().unwrap();
                assert!(text.contains(&format!("Only with {} = {}.", only.sibling, only.words.join(", "))), "{text}");
            }
            assert_eq!(property.get("not").is_some(), key.presence == Presence::NotYet, "{what}");
            assert_eq!(
                property.get("default").is_some(),
                matches!(
                    key.presence,
                    Presence::Default(_) | Presence::DefaultWith { .. } | Presence::DefaultWithout { .. }
                ),
                "{what}"
            );
            // A default that is no JSON would stand there as a text.
            if let (Kind::Number(_) | Kind::Integer { .. }, Some(default)) = (key.kind, property.get("default")) {
                assert!(default.is_number(), "{what}");
            }
        }
    }
    assert_eq!(schema["required"], serde_json::json!(["time"]));
}

/// The part of JSON Schema that this one uses. The whole of it was tried with the `jsonschema`
/// package for Python.
struct Validator<'s> {
    root: &'s Value,
    /// By their source, made once.
    patterns: RefCell<HashMap<String, Regex>>,
}

impl Validator<'_> {
    fn matches(&self, pattern: &str, text: &str) -> bool {
        let mut patterns = self.patterns.borrow_mut();
        // Blanks without the tables of Unicode.
        let make = || Regex::new(&pattern.replace("\\s", "[ \\t\\r\\n]")).unwrap();
        patterns.entry(pattern.to_owned()).or_insert_with(make).is_match(text)
    }

    fn valid(&self, schema: &Value, value: &Value) -> bool {
        if let Some(any) = schema.as_bool() {
            return any;
        }
        if let Some(reference) = schema["$ref"].as_str() {
            let target = reference.trim_start_matches("#/").split('/').fold(self.root, |at, part| &at[part]);
            return self.valid(target, value);
        }
        let is = |kind: &str| match kind {
            "object" => value.is_object(),
            "array" => value.is_array(),
            "string" => value.is_string(),
            "boolean" => value.is_boolean(),
            "integer" => value.is_i64() || value.is_u64(),
            "number" => value.is_number(),
            _ => panic!("{kind}"),
        };
        let ways = |name: &str| schema[name].as_array().into_iter().flatten().map(|way| self.valid(way, value));
        let mut good = schema["type"].as_str().is_none_or(is);
        good &= schema["enum"].as_array().is_none_or(|words| words.contains(value));
        good &= schema.get("const").is_none_or(|only| only == value);
        good &= schema.get("not").is_none_or(|not| !self.valid(not, value));
        good &= schema.get("anyOf").is_none() || ways("anyOf").any(|valid| valid);
        good &= schema.get("oneOf").is_none() || ways("oneOf").filter(|valid| *valid).count() == 1;
        good &= ways("allOf").all(|valid| valid);
        if let Some(condition) = schema.get("if") {
            let branch = if self.valid(condition, value) { "then" } else { "else" };
            good &= schema.get(branch).is_none_or(|branch| self.valid(branch, value));
        }
        if let Some(number) = value.as_f64() {
            good &= schema["minimum"].as_f64().is_none_or(|end| number >= end);
            good &= schema["maximum"].as_f64().is_none_or(|end| number <= end);
            good &= schema["exclusiveMinimum"].as_f64().is_none_or(|end| number > end);
            good &= schema["exclusiveMaximum"].as_f64().is_none_or(|end| number < end);
        }
        if let Some(text) = value.as_str() {
            good &= schema["pattern"].as_str().is_none_or(|pattern| self.matches(pattern, text));
            good &= schema["maxLength"].as_u64().is_none_or(|most| text.chars().count() as u64 <= most);
            good &= schema["minLength"].as_u64().is_none_or(|least| text.chars().count() as u64 >= least);
        }
        if let Some(items) = value.as_array() {
            good &= schema["minItems"].as_u64().is_none_or(|least| items.len() as u64 >= least);
            good &= schema["maxItems"].as_u64().is_none_or(|most| items.len() as u64 <= most);
            good &= schema.get("items").is_none_or(|item| items.iter().all(|value| self.valid(item, value)));
            good &= schema.get("contains").is_none_or(|item| items.iter().any(|value| self.valid(item, value)));
            let twice = (1..items.len()).any(|k| items[..k].contains(&items[k]));
            good &= schema["uniqueItems"] != true || !twice;
        }
        if let Some(object) = value.as_object() {
            let names = |list: &Value| {
                list.as_array().into_iter().flatten().all(|name| object.contains_key(name.as_str().unwrap()))
            };
            good &= names(&schema["required"]);
            for (key, needs) in schema["dependentRequired"].as_object().into_iter().flatten() {
                good &= !object.contains_key(key) || names(needs);
            }
            for (key, value) in object {
                good &= schema.get("propertyNames").is_none_or(|names| self.valid(names, &Value::from(key.as_str())));
                let by_pattern = schema["patternProperties"].as_object().and_then(|patterns| {
                    patterns.iter().find(|(pattern, _)| self.matches(pattern, key)).map(|(_, inner)| inner)
                });
                good &= match schema["properties"].get(key).or(by_pattern) {
                    Some(inner) => self.valid(inner, value),
                    None => schema["additionalProperties"] != false,
                };
            }
        }
        good
    }
}

fn as_json(toml: &toml::Value) -> Value {
    match toml {
        toml::Value::String(text) => Value::from(text.as_str()),
        toml::Value::Integer(number) => Value::from(*number),
        toml::Value::Float(number) => Value::from(*number),
        toml::Value::Boolean(flag) => Value::from(*flag),
        toml::Value::Datetime(_) => panic!("no scene has a date"),
        toml::Value::Array(items) => items.iter().map(as_json).collect(),
        toml::Value::Table(table) => table.iter().map(|(key, value)| (key.clone(), as_json(value))).collect(),
    }
}

fn scene(name: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(name)).unwrap()
}

fn accepts(schema: &Value, text: &str) -> bool {
    let table: toml::Table = text.parse().unwrap();
    let validator = Validator { root: schema, patterns: RefCell::default() };
    validator.valid(schema, &as_json(&toml::Value::Table(table)))
}

#[test]
fn the_scenarios_are_valid_and_broken_ones_are_not() {
    let schema = schema();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let scenes: Vec<_> = files.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect();
    assert!(scenes.len() >= 11, "{scenes:?}");
    for path in scenes {
        assert!(accepts(&schema, &std::fs::read_to_string(&path).unwrap()), "{path:?}");
    }
    let text = scene("free-rocking-on-beam.toml");
    for (from, to) in [
        ("thickness ", "thicknes "),
        ("elements      = 20", "elements = 0"),
        ("friction = 0.5", ""),
        ("friction = 0.5", "friction = -1"),
        ("\"static\"", "\"moving\""),
        ("[\"pinned\", \"pinned\"]", "[\"pinned\"]"),
        ("on       = \"table\"", ""),
        ("[output]", "[ground]\nprofile = \"hills.csv\"\n[output]"),
    ] {
        assert!(text.contains(from) && !accepts(&schema, &text.replacen(from, to, 1)), "{from} → {to}");
    }
}

#[test]
fn the_reference_page_is_the_one_of_the_table() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene.md");
    let kept = std::fs::read_to_string(file).unwrap_or_default();
    let now = teeter(&["schema", "--format", "markdown"]);
    assert!(
        kept.replace("\r\n", "\n") == now,
        "docs/scene.md is not the page of the table of keys; write it anew: cargo run -- schema --format markdown > docs/scene.md"
    );
    for table in TABLES.iter().filter(|table| table.occurrence != Occurrence::Inline) {
        for key in table.keys {
            assert!(now.contains(&format!("`{}`", key.name)), "{}", key.name);
        }
    }
}

/// Puts the value of a `--set` into a scene.
fn set(table: &mut toml::Table, path: &str, value: &str) {
    let (above, key) = path.rsplit_once('.').unwrap();
    let inner = above.split('.').fold(table, |table, part| {
        table.entry(part).or_insert_with(|| toml::Table::new().into()).as_table_mut().unwrap()
    });
    let value = format!("v = {value}").parse::<toml::Table>().map_or_else(|_| value.into(), |table| table["v"].clone());
    inner.insert(key.to_owned(), value);
}

/// The bad inputs that are no matter of one file, or that only arithmetic, names, files or an
/// assembled model can tell: what docs/schema.md says is beyond a schema.
const BEYOND: &[&str] = &[
    "denormal height",
    "tiny height",
    "huge height",
    "friction of feet of a disc",
    "friction of feet between blocks",
    "step longer than the run",
    "too many steps",
    "tilt over a quarter turn",
    "block wider than the beam",
    "corner off the beam",
    "corner below the surface",
    "two blocks in one place",
    "block on a block without a contact",
    "block on itself",
    "blocks on each other",
    "block beside the block that it stands on",
    "blocks joined twice",
    "kinematics between blocks",
    "two blocks that are prescribed",
    "static start of a beam on one pin",
    "static start on a slope without friction",
    "static start that tips",
    "static start on the other foot",
    "probe off the beam",
    "one element clamped at both ends",
    "two bodies of one name",
    "unknown material",
    "beam of a material without modulus",
    "contact with nobody",
    "too much output",
    "accelerogram that is not there",
    "product of a signal that is not there",
    "signal that is not defined",
    "a displacement that jumps",
    "force on a beam",
    "load off the beam",
    "a velocity given twice",
    "a wall for ground",
    "stiffness of another exponent",
    "linear damping by the exponent",
    "shape that is not there",
    "nodes that go back",
    "wall of a tube beyond its radius",
    "support at the end",
    "segment beyond the beam",
    "shear without Poisson's ratio",
    "theta of a beam held along its axis",
    "compression beyond buckling",
    "compression beyond buckling, in modes and a shape",
    "free beam under compression, in a mode",
    "springs that hold nothing",
    "more modes than there are",
    "region of modes beyond the beam",
    "dashpot under a beam in modes",
    "points on one line",
    "lower face of a block above",
    "face of the ground",
    "crest deep inside a block",
    "disc on a sloping beam in equilibrium",
    "two patterns that say as much",
    "stones that are all prescribed",
    "contact of a pair that is kept apart",
    "more stones than pairs can be numbered of",
    "stones that start inside each other",
    "a crowd on a beam in equilibrium",
    "jitter into each other",
    "jitter that lifts off the ground",
    "random angles on the ground",
];

#[test]
fn bad_inputs_are_refused_but_those_beyond_a_schema() {
    let schema = schema();
    let validator = Validator { root: &schema, patterns: RefCell::default() };
    let mut beyond = Vec::new();
    for row in rows().iter().filter(|row| !row.warns) {
        let mut text = scene("free-rocking-on-beam.toml");
        let mut sets: &[&str] = &[];
        match &row.input {
            Input::Set(values) => sets = values,
            Input::Edit(changes) => changes.iter().for_each(|(from, to)| text = text.replacen(from, to, 1)),
            Input::Text(own) => text = (*own).to_owned(),
            Input::Stack(changes) => {
                text = changes.iter().fold(STACKED.to_owned(), |text, (from, to)| text.replacen(from, to, 1));
            }
            Input::Pile(changes) => {
                text = changes.iter().fold(PILE.to_owned(), |text, (from, to)| text.replacen(from, to, 1));
            }
            // What is in another file no schema of this one tells.
            Input::Record(_) | Input::Shape(_) | Input::Measured(_) => continue,
        }
        // What is no TOML is no scene.
        let Ok(mut table) = text.parse::<toml::Table>() else { continue };
        for (path, value) in sets.iter().map(|set| set.split_once('=').unwrap()) {
            set(&mut table, path, value);
        }
        if validator.valid(&schema, &as_json(&toml::Value::Table(table))) {
            beyond.push(row.what);
        }
    }
    assert_eq!(beyond, BEYOND, "the inputs that the schema lets through");
}

/// A schema must not be stricter than the program.
#[test]
fn what_the_program_takes_is_valid() {
    let schema = schema();
    let text = scene("free-rocking-on-beam.toml");
    for (from, to) in [
        ("\"36 cm\"", "\"36cm\""),
        ("\"36 cm\"", "\" +360. mm \""),
        ("\"36 cm\"", "\"0.36 m^2/m\""),
        ("\"36 cm\"", "\"36e4 µm\""),
        ("\"2700 kg/m^3\"", "\"2700 kg·m⁻³\""),
        ("\"2700 kg/m^3\"", "\"2.7 g / (cm cm^2)\""),
        ("\"2700 kg/m^3\"", "\"2700 kg m^-3\""),
        ("\"5 deg\"", "\"−5°\""),
        ("\"5 deg\"", "\"-0.087 rad\""),
        ("step = \"100 us\"", "step = \"1e-4 s\""),
        ("friction = 0.5", "friction = 1\nrestitution = 0"),
    ] {
        assert!(text.contains(from), "{from}");
        let changed = text.replacen(from, to, 1);
        let loaded = teeter_scenario::load(changed.as_bytes(), "scene", "scene", &[]);
        assert!(loaded.is_ok(), "{to}: {}", loaded.unwrap_err());
        assert!(accepts(&schema, &changed), "{to}");
    }
    // The example of each key of the table has its pattern.
    let validator = Validator { root: &schema, patterns: RefCell::default() };
    for keys in TABLES {
        for key in keys.keys.iter().filter(|key| key.presence != Presence::NotYet) {
            let property = &table(&schema, keys.pattern)["properties"][key.name];
            for example in property["examples"].as_array().unwrap().iter().chain(property.get("default")) {
                // Inline tables in TOML's own writing are no JSON.
                let toml = format!("v = {}", key.example);
                let value = if example.is_string() {
                    as_json(&toml.parse::<toml::Table>().unwrap()["v"])
                } else {
                    example.clone()
                };
                assert!(validator.valid(property, &value), "{}.{}: {value}", keys.pattern, key.name);
            }
        }
    }
}

/// All files of Rust below `folder`.
fn sources(folder: &Path, out: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, out);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            out.push(path);
        }
    }
}

/// A line of a text that goes on in the next line without a backslash carries the indentation of
/// the source with it.
#[test]
fn no_text_has_a_run_of_spaces_within_a_sentence() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = Vec::new();
    for entry in std::fs::read_dir(crates).unwrap() {
        let source = entry.unwrap().path().join("src");
        if source.is_dir() {
            sources(&source, &mut files);
        }
    }
    assert!(files.len() > 100, "{}", files.len());
    let in_sentence =
        |byte: Option<&u8>| byte.is_some_and(|byte| byte.is_ascii_alphanumeric() || b",;:.`".contains(byte));
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        for (number, line) in text.lines().enumerate() {
            let line = line.trim();
            for (at, _) in line.match_indices("      ").filter(|_| line.contains('"') && !line.starts_with("//")) {
                let (before, after) = (line[..at].trim_end(), line[at..].trim_start());
                assert!(
                    !in_sentence(before.as_bytes().last()) || !in_sentence(after.as_bytes().first()),
                    "{}:{}: {line}",
                    file.display(),
                    number + 1
                );
            }
        }
    }
}
