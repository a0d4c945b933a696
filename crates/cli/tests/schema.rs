//! The JSON Schema and the reference page, both made from the table of keys.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use serde_json::Value;
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

/// A small part of JSON Schema: what this one uses, without the patterns. The whole of it was tried with the `jsonschema`
/// package for Python.
fn valid(schema: &Value, value: &Value, root: &Value) -> bool {
    if let Some(reference) = schema["$ref"].as_str() {
        let target = reference.trim_start_matches("#/").split('/').fold(root, |at, part| &at[part]);
        return valid(target, value, root);
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
    let mut good = schema.get("not").is_none() && schema["type"].as_str().is_none_or(is);
    good &= schema["enum"].as_array().is_none_or(|words| words.contains(value));
    good &= schema["anyOf"].as_array().is_none_or(|ways| ways.iter().any(|way| valid(way, value, root)));
    if let Some(number) = value.as_f64() {
        good &= schema["minimum"].as_f64().is_none_or(|end| number >= end);
        good &= schema["maximum"].as_f64().is_none_or(|end| number <= end);
        good &= schema["exclusiveMinimum"].as_f64().is_none_or(|end| number > end);
        good &= schema["exclusiveMaximum"].as_f64().is_none_or(|end| number < end);
    }
    if let Some(items) = value.as_array() {
        good &= schema["minItems"].as_u64().is_none_or(|least| items.len() as u64 >= least);
        good &= schema["maxItems"].as_u64().is_none_or(|most| items.len() as u64 <= most);
        good &= schema.get("items").is_none_or(|item| items.iter().all(|value| valid(item, value, root)));
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
            let pattern = schema["patternProperties"].as_object().and_then(|patterns| patterns.values().next());
            good &= schema["properties"].get(key).or(pattern).is_some_and(|inner| valid(inner, value, root));
        }
    }
    good
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
    valid(schema, &as_json(&toml::Value::Table(table)), schema)
}

#[test]
fn the_scenarios_are_valid_and_broken_ones_are_not() {
    let schema = schema();
    for name in [
        "compliant-drop",
        "drop",
        "free-rocking-on-beam",
        "free-rocking-on-beam-undeformed-start",
        "free-rocking-on-ground",
        "held-beam",
        "incline",
        "pushed-block",
        "shaken-ground",
        "sliding",
        "two-span-beam",
    ] {
        assert!(accepts(&schema, &scene(&format!("{name}.toml"))), "{name}");
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
