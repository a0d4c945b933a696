//! Rules for several keys of a table: exclusive keys, keys that need each other, keys that apply
//! only with some words of another one.

use serde_json::{Map, Value, json};
use teeter_scenario::keys::{Key, OnlyWith, Presence, TableSchema};

/// The conditions on a table, for its `allOf`.
pub(super) fn of(table: &TableSchema) -> Vec<Value> {
    let mut all: Vec<Value> = table.keys.iter().flat_map(|key| of_key(table, key)).collect();
    all.extend(of_pattern(table.pattern));
    all
}

/// The rules that follow from the row of a key.
fn of_key(table: &TableSchema, key: &Key) -> Vec<Value> {
    let mut all = Vec::new();
    if let Presence::RequiredWithout(other) = key.presence {
        all.push(at_least_one(&[key.name, other]));
    }
    if let Presence::RequiredWithoutAny(others) = key.presence {
        all.push(at_least_one(&[&[key.name], others].concat()));
    }
    if let Some(OnlyWith { sibling, words }) = key.only_with {
        let needed = match key.presence {
            Presence::Required => words,
            Presence::RequiredWith(some) => some,
            _ => &[],
        };
        all.push(json!({ "if": is_one_of(table, sibling, words), "else": without(&[key.name]) }));
        if !needed.is_empty() {
            all.push(json!({ "if": is_one_of(table, sibling, needed), "then": { "required": [key.name] } }));
        }
    }
    all
}

/// That a key is one of some words, by its default too.
fn is_one_of(table: &TableSchema, name: &str, words: &[&str]) -> Value {
    let by_default = table.key(name).is_some_and(|key| match key.presence {
        Presence::Default(default) => words.iter().any(|word| default == format!("\"{word}\"")),
        _ => false,
    });
    let is = properties([(name, json!({ "enum": words }))]);
    if by_default { is } else { json!({ "allOf": [is, { "required": [name] }] }) }
}

fn properties<'k>(of: impl IntoIterator<Item = (&'k str, Value)>) -> Value {
    let map: Map<String, Value> = of.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
    json!({ "properties": map })
}

/// None of these keys.
fn without(keys: &[&str]) -> Value {
    properties(keys.iter().map(|key| (*key, json!(false))))
}

fn at_least_one(keys: &[&str]) -> Value {
    json!({ "anyOf": keys.iter().map(|key| json!({ "required": [key] })).collect::<Vec<_>>() })
}

/// Not both of any two of these.
fn at_most_one(keys: &[&str]) -> Vec<Value> {
    let pairs = keys.iter().enumerate().flat_map(|(k, first)| keys[k + 1..].iter().map(move |second| (first, second)));
    pairs.map(|(first, second)| json!({ "not": { "required": [first, second] } })).collect()
}

/// The first key excludes the others.
fn excludes(key: &str, others: &[&str]) -> Value {
    json!({ "if": { "required": [key] }, "then": without(others) })
}

/// If the key has this value, `then` applies to the others.
fn where_is(key: &str, value: &Value, then: &Value) -> Value {
    json!({ "if": { "required": [key], "properties": { key: { "const": value } } }, "then": then })
}

const SHIFTS: [&str; 3] = ["displacement", "velocity", "acceleration"];
/// Components given by records.
const RECORDED: [&str; 2] = ["x", "y"];
const TURNS: [&str; 3] = ["angle", "angular_velocity", "angular_acceleration"];
/// Keys for the two motions of a node: a word, or the others.
const HELD: [[&str; 3]; 2] =
    [["deflection", "spring", "dashpot"], ["rotation", "rotational_spring", "rotational_dashpot"]];

/// A support by springs: the word of a motion excludes its numbers.
pub(super) fn of_support() -> Vec<Value> {
    HELD.iter().map(|[word, numbers @ ..]| excludes(word, numbers)).collect()
}

/// The initial shape of a beam: a mode and its amplitude, or a file.
pub(super) fn of_start() -> Vec<Value> {
    vec![
        json!({ "oneOf": [{ "required": ["mode", "amplitude"] }, { "required": ["file"] }] }),
        excludes("file", &["mode", "amplitude"]),
    ]
}

fn motion(turns: bool) -> Vec<Value> {
    let mut all = at_most_one(&SHIFTS);
    let mut moved = [SHIFTS.as_slice(), &RECORDED].concat();
    // A recorded component excludes the others, and no signal multiplies it.
    all.extend(RECORDED.map(|component| excludes(component, &[SHIFTS.as_slice(), &["signals", "only"]].concat())));
    if turns {
        all.extend(at_most_one(&TURNS));
        moved.extend(TURNS);
    }
    all.push(at_least_one(&moved));
    let signal = if turns { at_least_one(&TURNS) } else { json!(false) };
    all.extend(RECORDED.map(|component| json!({ "if": { "required": [component, "signal"] }, "then": signal })));
    // `signal` is that of the rotation, in addition to those of x and y.
    let turned = if turns { at_least_one(&TURNS) } else { json!(false) };
    all.push(json!({ "if": { "required": ["signal", "signals"] }, "then": turned }));
    all
}

/// An array with this word.
fn contains(word: &str) -> Value {
    json!({ "contains": { "const": word } })
}

/// The rules of `[time]`.
fn of_time() -> Vec<Value> {
    vec![
        where_is("scheme", &json!("moreau-jean-closed"), &properties([("theta", json!({ "const": 0.5 }))])),
        where_is("scheme", &json!("moreau-jean-located"), &properties([("theta", json!({ "const": 0.5 }))])),
        where_is("scheme", &json!("moreau-jean-projected"), &properties([("theta", json!({ "const": 0.5 }))])),
        json!({
            "if": { "required": ["spectral_radius"] },
            "then": { "required": ["scheme"], "properties": { "scheme": { "const": "generalized-alpha" } } },
        }),
        json!({
            "if": { "required": ["theta"], "properties": { "theta": { "exclusiveMaximum": 0.5 } } },
            "then": { "required": ["allow_conditional_stability"], "properties": { "allow_conditional_stability": { "const": true } } },
        }),
    ]
}

/// The rules of a beam.
fn of_beam() -> Vec<Value> {
    vec![
        excludes("nodes", &["elements", "mesh"]),
        json!({ "not": { "required": ["damping_ratio", "viscous_damping"] } }),
        json!({ "if": { "required": ["modes"] }, "then": { "required": ["model"], "properties": { "model": { "const": "modes" } } } }),
        where_is(
            "model",
            &json!("modes"),
            &properties([("axial", json!({ "enum": ["free", "elastic"] })), ("backend", json!({ "const": "auto" }))]),
        ),
        json!({
            "if": { "required": ["surface", "section"], "properties": { "surface": { "const": "top" }, "section": { "const": "direct" } } },
            "then": { "required": ["thickness"] },
        }),
        where_is(
            "axial",
            &json!("held"),
            &properties([("supports", json!({ "items": { "not": { "const": "free" } } }))]),
        ),
        where_is("axial", &json!("elastic"), &without(&["motion"])),
        // A free beam has no equilibrium, and no supports to move.
        json!({
            "if": { "required": ["supports"], "properties": { "supports": { "const": ["free", "free"] } } },
            "then": { "anyOf": [
                { "required": ["support"] },
                { "required": ["foundation"] },
                { "properties": { "start": { "not": { "const": "static" } }, "motion": false } },
            ] },
        }),
        json!({
            "if": { "required": ["record"], "properties": { "record": { "anyOf": [contains("moment"), contains("shear"), contains("stress")] } } },
            "then": { "required": ["probes"], "properties": { "probes": { "minItems": 1 } } },
        }),
    ]
}

/// The rules that the resolver checks for a table, beyond the rows of its keys.
fn of_pattern(pattern: &str) -> Vec<Value> {
    match pattern {
        "time" => of_time(),
        "ground.motion" => motion(true),
        "block.*.motion" => {
            let mut all = motion(true);
            all.push(json!({ "if": { "required": ["only"] }, "then": at_least_one(&SHIFTS) }));
            all
        }
        "beam.*.motion" => motion(false),
        // A written scene has incline = "0.0 rad" beside a profile.
        "ground" => vec![json!({
            "if": { "required": ["incline", "profile"] },
            "then": { "properties": { "incline": { "pattern": "^[-+]?0*\\.?0* " } } }
        })],
        "ground.profile" => vec![
            json!({ "oneOf": [{ "required": ["points"] }, { "required": ["file"] }] }),
            json!({ "dependentRequired": { "columns": ["file"], "unit": ["file"] } }),
            properties([("points", json!({ "minItems": 2 }))]),
        ],
        "beam.*" => of_beam(),
        "ground.motion.x" | "ground.motion.y" | "beam.*.motion.x" | "beam.*.motion.y" | "block.*.motion.x"
        | "block.*.motion.y" => vec![json!({ "not": { "required": ["scale", "peak"] } })],
        "beam.*.rayleigh" => vec![
            at_least_one(&["a0", "a1", "frequencies"]),
            excludes("frequencies", &["a0", "a1"]),
            json!({ "dependentRequired": { "frequencies": ["ratios"], "ratios": ["frequencies"] } }),
            properties([("ratios", json!({ "minItems": 2, "maxItems": 2 }))]),
        ],
        "beam.*.modes" => vec![excludes("count", &["tolerance", "from", "to"])],
        "beam.*.support.*" => {
            let mut all = of_support();
            all.push(excludes("kind", &HELD.concat()));
            all.push(at_least_one(&[&["kind"], HELD.concat().as_slice()].concat()));
            all
        }
        "block.*" => vec![
            at_least_one(&["position", "centre", "on", "points", "parts"]),
            excludes("points", &["width", "height", "radius", "shape", "parts"]),
            excludes("radius", &["width", "height", "shape", "parts", "rounding", "chamfer"]),
            excludes("shape", &["width", "height", "parts"]),
            excludes("parts", &["width", "height", "rounding", "chamfer"]),
            excludes("rounding", &["chamfer"]),
            excludes("mass", &["density", "depth"]),
            excludes("material", &["density"]),
            excludes("position", &["centre", "on", "at", "tilt"]),
            excludes("centre", &["on", "at", "tilt"]),
            json!({ "dependentRequired": { "on": ["at"], "mass": ["inertia"], "inertia": ["mass"] } }),
        ],
        // A pattern may be paired with itself.
        "contact.*" => {
            let pattern = json!({ "contains": { "pattern": "[*?]" } });
            vec![
                excludes("between", &["materials"]),
                properties([("between", json!({ "anyOf": [{ "uniqueItems": true }, pattern] }))]),
            ]
        }
        "signal.*" => vec![
            json!({ "not": { "required": ["frequency", "period"] } }),
            json!({
                "if": { "required": ["shape"], "properties": { "shape": { "enum": ["harmonic", "one-sine", "ricker"] } } },
                "then": at_least_one(&["frequency", "period"]),
            }),
        ],
        "force.*" => vec![at_least_one(&["force", "couple"])],
        "load.*" => vec![
            at_least_one(&["force", "couple", "distributed"]),
            excludes("distributed", &["at", "force", "couple", "speed"]),
            json!({ "dependentRequired": { "from": ["distributed"], "to": ["distributed"], "force": ["at"], "couple": ["at"], "speed": ["force"] } }),
            excludes("speed", &["couple"]),
        ],
        _ => Vec::new(),
    }
}
