//! `teeter schema`: the JSON Schema of scene files, from the table of keys.

mod patterns;
mod rules;

use crate::console::print_all;
use crate::run::Exit;
use crate::scene_page;
use serde_json::{Map, Value, json};
use teeter_scenario::dimension::Dimension;
use teeter_scenario::keys::{
    self, Bound, Key, Kind, LONGEST_TITLE, Occurrence, OnlyWith, Presence, Range, TABLES, TableSchema,
};

/// Output format of the schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Format {
    Json,
    Markdown,
}

pub(crate) fn print(format: Format) -> Exit {
    let text = match format {
        Format::Json => format!("{:#}\n", schema()),
        Format::Markdown => scene_page::page(),
    };
    print_all(&text)
}

/// The schema of a scene file read as JSON, draft 2020-12.
///
/// It is more lenient than the program where a schema can't check: see `docs/schema.md`.
fn schema() -> Value {
    let mut schema = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "teeter scene",
        "$defs": { "name": { "type": "string", "pattern": NAME } },
    });
    if let (Some(root), Some(schema)) = (TABLES.iter().find(|table| table.pattern.is_empty()), schema.as_object_mut()) {
        schema.extend(object(root));
    }
    schema
}

/// The names that the program accepts.
const NAME: &str = "^[A-Za-z0-9_-]{1,64}$";

/// The same with `*` for any characters.
const PATTERN: &str = "^[A-Za-z0-9_*?-]{1,}$";

fn object(table: &TableSchema) -> Map<String, Value> {
    let mut properties = Map::new();
    for key in table.keys {
        properties.insert(key.name.to_owned(), property(key));
    }
    let mut required: Vec<&str> = table.keys.iter().filter(|key| is_required(key)).map(|key| key.name).collect();
    for child in keys::children(table) {
        let inner = Value::Object(object(child));
        let value = match child.occurrence {
            Occurrence::Named => json!({
                "type": "object",
                "description": format!("{} Each has its own name.", child.doc),
                "patternProperties": { NAME: inner },
                "additionalProperties": false,
                // Names are unique, and this one is reserved for the ground.
                "propertyNames": { "not": { "const": taken(child) } },
            }),
            _ => inner,
        };
        properties.insert(child.name().to_owned(), value);
        if child.occurrence == Occurrence::Always && child.keys.iter().any(is_required) {
            required.push(child.name());
        }
    }
    let mut object = Map::new();
    object.insert("type".to_owned(), json!("object"));
    object.insert("description".to_owned(), json!(table.doc));
    object.insert("properties".to_owned(), Value::Object(properties));
    object.insert("additionalProperties".to_owned(), json!(false));
    if !required.is_empty() {
        object.insert("required".to_owned(), json!(required));
    }
    let siblings: Map<String, Value> = table
        .keys
        .iter()
        .filter_map(|key| match key.presence {
            Presence::DefaultWith { sibling, .. } => Some((key.name.to_owned(), json!([sibling]))),
            _ => None,
        })
        .collect();
    if !siblings.is_empty() {
        object.insert("dependentRequired".to_owned(), Value::Object(siblings));
    }
    let rules = rules::of(table);
    if !rules.is_empty() {
        object.insert("allOf".to_owned(), Value::Array(rules));
    }
    object
}

/// The name that a body can't have; empty for other tables, as names are never empty.
fn taken(table: &TableSchema) -> &'static str {
    if ["beam.*", "block.*"].contains(&table.pattern) { "ground" } else { "" }
}

/// Whether a key is required independent of the others.
fn is_required(key: &Key) -> bool {
    key.presence == Presence::Required && key.only_with.is_none()
}

/// The words of another key with which a key applies.
fn only_with(key: &Key) -> String {
    let Some(OnlyWith { sibling, words }) = key.only_with else { return String::new() };
    let required = match key.presence {
        Presence::Required => " Required there.".to_owned(),
        Presence::RequiredWith(words) => format!(" Required with {}.", words.join(", ")),
        _ => String::new(),
    };
    format!(" Only with {sibling} = {}.{required}", words.join(", "))
}

fn property(key: &Key) -> Value {
    if key.presence == Presence::NotYet {
        return json!({ "not": {}, "description": format!("{} Reserved, not implemented yet.", key.doc) });
    }
    let mut value = of_kind(key);
    if let Some(value) = value.as_object_mut() {
        value.insert("description".to_owned(), json!(format!("{}{}{}", key.doc, range_of(key), only_with(key))));
        value.insert("examples".to_owned(), json!([as_json(key.example)]));
        if let Presence::Default(default)
        | Presence::DefaultWith { value: default, .. }
        | Presence::DefaultWithout { value: default, .. } = key.presence
        {
            value.insert("default".to_owned(), as_json(default));
        }
    }
    value
}

/// A value of the table of keys; all of them are the same in TOML and JSON.
fn as_json(toml: &str) -> Value {
    serde_json::from_str(toml).unwrap_or_else(|_| json!(toml))
}

/// The range of a quantity in words, as a pattern can't express it.
fn range_of(key: &Key) -> String {
    let (dimension, range) = match key.kind {
        Kind::Quantity(dimension, range)
        | Kind::Pair(dimension, range)
        | Kind::Points(dimension, range)
        | Kind::List(dimension, range) => (dimension, range),
        _ => return String::new(),
    };
    format!(" {dimension}; {}.", range.rule(dimension))
}

fn of_kind(key: &Key) -> Value {
    let value = of_kind_alone(key);
    match key.left_out_as {
        Some(word) => json!({ "anyOf": [value, { "const": word }] }),
        None => value,
    }
}

fn of_kind_alone(key: &Key) -> Value {
    let quantity =
        |dimension, range: &Range| json!({ "type": "string", "pattern": patterns::quantity(dimension, range) });
    let pair = |item: Value| json!({ "type": "array", "items": item, "minItems": 2, "maxItems": 2 });
    match key.kind {
        Kind::Text => {
            json!({ "type": "string", "maxLength": LONGEST_TITLE, "pattern": "^[^\\u0000-\\u001f\\u007f-\\u009f]*$" })
        }
        Kind::Path => json!({ "type": "string", "minLength": 1 }),
        Kind::Measure(units, range) => json!({ "type": "string", "pattern": patterns::measure(units, &range) }),
        Kind::Name => json!({ "$ref": "#/$defs/name" }),
        Kind::Choice(words) => json!({ "enum": words }),
        Kind::Flag if key.reserved.is_empty() => json!({ "type": "boolean" }),
        Kind::Flag => {
            let refused = |flag: bool| key.reserved.iter().any(|reserved| reserved.value == flag.to_string());
            let allowed: Vec<bool> = [false, true].into_iter().filter(|flag| !refused(*flag)).collect();
            json!({ "enum": allowed })
        }
        Kind::Integer { min, max } => json!({ "type": "integer", "minimum": min, "maximum": max }),
        Kind::Version(known) => json!({ "enum": known }),
        Kind::Number(range) => number(&range),
        Kind::Quantity(Dimension::NONE, range) => number(&range),
        Kind::Quantity(dimension, range) => quantity(dimension, &range),
        Kind::Pair(dimension, range) => pair(quantity(dimension, &range)),
        Kind::Points(dimension, range) => json!({ "type": "array", "items": pair(quantity(dimension, &range)) }),
        Kind::List(dimension, range) => json!({ "type": "array", "items": quantity(dimension, &range) }),
        Kind::Numbers(range) => json!({ "type": "array", "items": number(&range) }),
        Kind::Words(words) => json!({ "type": "array", "items": { "enum": words }, "uniqueItems": true }),
        Kind::WordOrTable([], keys) => table_of(keys, Vec::new()),
        Kind::Tables(keys) => json!({ "type": "array", "items": table_of(keys, Vec::new()), "minItems": 1 }),
        Kind::WordOrTable(words, keys) => word_or_table(words, keys, rules::of_start()),
        Kind::WordOrTablePair(words, keys) => pair(word_or_table(words, keys, rules::of_support())),
        Kind::ChoicePair(words) => pair(json!({ "enum": words })),
        Kind::Names => json!({ "type": "array", "items": { "$ref": "#/$defs/name" }, "minItems": 1 }),
        Kind::NamePair => pair(json!({ "$ref": "#/$defs/name" })),
        Kind::Patterns => json!({ "type": "array", "items": { "type": "string", "pattern": PATTERN }, "minItems": 1 }),
        Kind::PatternPair => pair(json!({ "type": "string", "pattern": PATTERN })),
        Kind::PatternPairs => {
            json!({ "type": "array", "items": pair(json!({ "type": "string", "pattern": PATTERN })) })
        }
        Kind::Downward(dimension) => {
            let of = |range| quantity(dimension, range);
            json!({ "anyOf": [of(&Range::NOT_NEGATIVE), pair(of(&Range::ANY))] })
        }
        // An unknown kind: anything is allowed here, and the program decides.
        _ => json!({}),
    }
}

fn word_or_table(words: &[&str], keys: &[Key], rules: Vec<Value>) -> Value {
    json!({ "anyOf": [{ "enum": words }, table_of(keys, rules)] })
}

fn table_of(keys: &[Key], rules: Vec<Value>) -> Value {
    let properties: Map<String, Value> = keys.iter().map(|key| (key.name.to_owned(), property(key))).collect();
    let table = json!({ "type": "object", "properties": properties, "additionalProperties": false });
    // An empty list of rules is no valid schema.
    if rules.is_empty() { table } else { with(table, "allOf", json!(rules)) }
}

fn with(mut table: Value, key: &str, value: Value) -> Value {
    table[key] = value;
    table
}

fn number(range: &Range) -> Value {
    let mut number = json!({ "type": "number" });
    let ends = [(range.low, "minimum", "exclusiveMinimum"), (range.high, "maximum", "exclusiveMaximum")];
    for (bound, closed, open) in ends {
        match bound {
            Bound::Closed(end) => number[closed] = json!(end),
            Bound::Open(end) => number[open] = json!(end),
            _ => {}
        }
    }
    // The limits of the absolute value.
    let most = range.largest;
    if range.high == Bound::None {
        number["maximum"] = json!(most);
    }
    if range.low == Bound::None {
        number["minimum"] = json!(-most);
    }
    number
}
