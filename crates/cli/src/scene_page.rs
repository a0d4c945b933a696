//! The reference page of scene files, `docs/scene.md`, from the table of keys.

use std::fmt::Write;
use teeter_scenario::dimension::Dimension;
use teeter_scenario::keys::{Key, Kind, Occurrence, OnlyWith, Presence, Range, TABLES, TableSchema};
use teeter_scenario::units;

/// A scene that uses most of what there is.
const EXAMPLE: &str = include_str!("../../../scenarios/free-rocking-on-beam.toml");

const HEAD: &str = "\
<!-- Made by `teeter schema --format markdown`; to change it, change the table of keys in crates/scenario/src/table.rs. -->

# The scene file

A scene is a TOML file: a time span, bodies, the contacts between them, and what to write. `teeter check SCENE.toml` says
what it models and what looks wrong; `teeter run SCENE.toml` simulates it; `--set KEY=VALUE` overrides a key by its path, such as
`--set beam.table.thickness=\"2 mm\"`. `teeter schema` prints a JSON Schema for editors.

A value with a dimension is a string with its unit: `\"36 cm\"`, `\"69 GPa\"`, `\"9.81 m/s^2\"`, `\"0.4 N s/m^2\"`. A bare number there is an
error, so that no unit is ever guessed. Numbers are computed with from 1e-12 to 1e12 in SI units unless the table says otherwise.
Names (of materials, beams, blocks, contacts, signals, loads) hold letters, digits, `_`, `-`, at most 64 of them; no two bodies share one, and
`ground` is the ground's. A file is at most 4 MB; all that is wrong in it is told at once. Files that a scene names (tables of signals, at
most 64 MB and 2 million rows) are found from its folder.
";

const PLACES: &str = "\
## Where a block starts

Either on something: `on` names a beam or `\"ground\"`, `at` is the place x of the middle of its base before it is tilted, and `tilt`
turns it about the corner that it stays on, the left one if positive, the right one if negative. A contact must join the two.
On inclined ground its base lies along the incline, and `tilt` counts from there; ground and supports that start displaced are where the
block is put. Or anywhere: `position` is the place of its mass centre and `angle` its turn about it. A corner may not start below a surface that it is
in contact with, and no block inside another.
";

const WARNINGS: &str = "\
## What is warned of

A scene with a warning runs all the same. `teeter check` and `teeter run` warn of

- a `tilt`, with the incline of the ground, within 10 % of the critical angle α = atan(width/height), or beyond it: standing still the block overturns;
- a beam that sags by more than 1/50 of its span under the weight of the blocks on it: deflections are no longer small (`check` notes a
  sag from 1/250 on: linear theory leaves out the shortening of the axis, at 1/68 some per cent of the block's angle);
- a signal that nothing uses (`check` notes as well an incline that is steeper than the friction of a block on it holds);
- a contact with duration that a block of its mass on its stiffness leaves again in less than 20 steps;
- the table of a signal that ends before the run or begins after 0 s with a value other than 0: that value is kept;
- a `step` coarser than a tenth of the shortest time scale of a contact: the rocking time √(4R/3g) of a block, R half its diagonal, and
  for a block on a beam the beam's first period as well;
- an `end` that is no multiple of the step: the run goes on to the first step past it;
- a `gap_tolerance` over 1e-6 of the shortest side of a block, as blocks hover that high (over 1e-3 it is refused), and a `tolerance` of the solver over 1e-4;
- `theta` below 0.5, with the largest stable step;
- signals, and displacements of prescribed motions, that are faster than the step; supports, or ground under a block at rest, that begin with a velocity
  ([signals.md](signals.md));
- a mesh, or modes, that lack flexibility where a block or a load presses; a key that has no effect.

What a run measures it says at its end, on the terminal, on the page and among the `warnings` of `summary.json`:

| code | what it says |
|---|---|
| `under-resolved`, `under-resolved-swings`, `under-resolved-flight` | steps too long for the impacts of a block, for the swings of a beam, for a flight with θ other than ½: motions are likely off by more than 10 % ([resolution.md](resolution.md)) |
| `unconverged` | steps whose contact problem was not solved to tolerance |
| `unlocated` | steps of `event-driven` in which not every event was located ([schemes.md](schemes.md)) |
| `energy-made` | contacts, or the scheme, made 1 % or more of the energy scale, or of the energy lost ([schemes.md](schemes.md)) |
| `energy-taken` | the scheme's own rule took 1 % or more of the energy scale ([schemes.md](schemes.md)) |
| `horizon` | until when the motion can be told, where `--horizon` finds that it is before the end ([accuracy.md](accuracy.md)) |
| `energy-account` | the identity of energy is off by more than rounding |
| `deep-penetration`, `far-turn` | corners over a tenth of a block's shorter side deep; turns of more than 0.1 rad a step |
| `contested-landing` | a block landed while bounces of another of its contacts had been cut short by the steps of `moreau-jean-located` ([accuracy.md](accuracy.md)) |
| `passes-through`, `between-corners`, `past-the-end` | bodies inside each other where no contact is modelled ([impacts.md](impacts.md)) |
| `large-deflection`, `yield` | a beam out of linear theory, or over its yield strength |
| `model-limits` | energy or penetration over what was taken for granted where parts were left out ([required.md](required.md)) |
";

/// The page.
pub(crate) fn page() -> String {
    let mut page = HEAD.to_owned();
    let _ = write!(page, "\n```toml\n{EXAMPLE}```\n");
    let _ = write!(page, "\nKnown units are {}; `µ` may be written for `u`.\n", units::known());
    for table in TABLES {
        section(&mut page, table);
        if table.pattern == "block.*" {
            let _ = write!(page, "\n{PLACES}");
        }
    }
    let _ = write!(page, "\n{WARNINGS}");
    page
}

fn section(page: &mut String, table: &TableSchema) {
    let path = table.pattern.replace('*', "NAME");
    let heading = match table.occurrence {
        _ if path.is_empty() => "Top of the file".to_owned(),
        Occurrence::Inline => match path.rsplit_once('.') {
            Some((above, key)) => format!("`{key} = {{ … }}` in `[{above}]`"),
            None => path,
        },
        _ => format!("`[{path}]`"),
    };
    let _ = write!(page, "\n## {heading}\n\n{}", table.doc);
    page.push_str(match table.occurrence {
        Occurrence::Named => " As many as wanted, each under a name of its own.\n",
        Occurrence::Optional | Occurrence::Inline => " May be left out.\n",
        _ => "\n",
    });
    let built: Vec<&Key> = table.keys.iter().filter(|key| key.presence != Presence::NotYet).collect();
    if !built.is_empty() {
        page.push_str("\n| key | value | default | meaning |\n|---|---|---|---|\n");
    }
    for key in built {
        let meaning = key.doc.replace('|', "\\|");
        let _ = writeln!(page, "| `{}` | {} | {} | {meaning} |", key.name, value(key), default(key));
    }
    let later = later(table);
    if !later.is_empty() {
        let _ = write!(page, "\nReserved, not implemented yet: {}.\n", later.join(", "));
    }
}

/// Keys and words that are refused for now.
fn later(table: &TableSchema) -> Vec<String> {
    let keys = table.keys.iter().filter(|key| key.presence == Presence::NotYet).map(|key| format!("`{}`", key.name));
    let words = table.keys.iter().flat_map(|key| {
        key.reserved.iter().map(|reserved| match key.kind {
            Kind::Flag => format!("`{} = {}`", key.name, reserved.value),
            _ => format!("`{} = \"{}\"`", key.name, reserved.value),
        })
    });
    keys.chain(words).collect()
}

fn default(key: &Key) -> String {
    let default = default_alone(key);
    match key.only_with {
        Some(OnlyWith { sibling, words }) => {
            let words: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
            format!("{default}; only with `{sibling}` {}", words.join(", ")).trim_start_matches("–; ").to_owned()
        }
        None => default,
    }
}

fn default_alone(key: &Key) -> String {
    match key.presence {
        Presence::Required => "**required**".to_owned(),
        Presence::RequiredWith(words) => format!("**required** with {}", quoted(words)),
        Presence::RequiredWithout(sibling) => format!("**required** without `{sibling}`"),
        Presence::DefaultWithout { sibling, value } => format!("`{value}`, without `{sibling}`"),
        Presence::Default(value) => format!("`{value}`"),
        Presence::DefaultWith { sibling, value } => format!("`{value}`, with `{sibling}`"),
        _ => "–".to_owned(),
    }
}

/// Words of a key as they are written.
fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("`\"{word}\"`")).collect::<Vec<_>>().join(", ")
}

/// The keys of a table that stands for a word.
fn table_of(keys: &[Key]) -> String {
    let keys: Vec<String> = keys.iter().map(|key| format!("`{}` ({}): {}", key.name, value(key), key.doc)).collect();
    format!("a table of {}", keys.join(" "))
}

fn value(key: &Key) -> String {
    let value = value_alone(key);
    match key.left_out_as {
        Some(word) => format!("{value}; `\"{word}\"`"),
        None => value,
    }
}

fn value_alone(key: &Key) -> String {
    let such_as = format!("such as `{}`", key.example);
    match key.kind {
        Kind::Text => "text".to_owned(),
        Kind::Path => format!("path, {such_as}"),
        Kind::Measure(units, range) => {
            let units: Vec<&str> = units.iter().map(|unit| unit.example).collect();
            format!("quantity in {}{}, {such_as}", units.join(" or "), limits(&range, Dimension::NONE))
        }
        Kind::Name => format!("name, {such_as}"),
        Kind::Choice(choices) => quoted(choices),
        Kind::Flag => {
            let built_in = |word: &&str| key.reserved.iter().all(|reserved| reserved.value != *word);
            let words: Vec<_> =
                ["true", "false"].into_iter().filter(built_in).map(|word| format!("`{word}`")).collect();
            words.join(", ")
        }
        Kind::Integer { min, max } => format!("whole number, {min} to {max}"),
        Kind::Version(known) => known.iter().map(|version| format!("`{version}`")).collect::<Vec<_>>().join(", "),
        Kind::Number(range) => format!("number{}", limits(&range, Dimension::NONE)),
        Kind::Quantity(dimension, range) => {
            format!("{}{}, {such_as}", bare(dimension), limits(&range, dimension))
        }
        Kind::Pair(dimension, _) => format!("`[x, y]`, each {}, {such_as}", dimension.name()),
        Kind::Points(dimension, _) => format!("array of `[x, y]`, each {}, {such_as}", dimension.name()),
        Kind::List(dimension, range) => {
            format!("array, each {}{}, {such_as}", dimension.name(), limits(&range, dimension))
        }
        Kind::Numbers(range) => format!("array of numbers, each {}, {such_as}", limits(&range, Dimension::NONE).trim()),
        Kind::Words(words) => format!("array of some of {}", quoted(words)),
        Kind::WordOrTable(words, keys) => format!("{}, or {}", quoted(words), table_of(keys)),
        Kind::WordOrTablePair(words, keys) => format!("two of {}, or {}", quoted(words), table_of(keys)),
        Kind::ChoicePair(choices) => format!("two of {}", quoted(choices)),
        Kind::NamePair | Kind::PatternPair => format!("two names, {such_as}"),
        Kind::Downward(dimension) => format!("{}, {such_as}, or `[x, y]`", bare(dimension)),
        _ => such_as,
    }
}

/// A dimension without its article.
fn bare(dimension: Dimension) -> &'static str {
    let name = dimension.name();
    name.strip_prefix("a ").or_else(|| name.strip_prefix("an ")).unwrap_or(name)
}

/// ", greater than 0 m".
fn limits(range: &Range, dimension: Dimension) -> String {
    let rule = range.rule(dimension);
    match rule.strip_prefix("must be ").or_else(|| rule.strip_prefix("must lie ")) {
        Some(limits) => format!(" {limits}"),
        None => String::new(),
    }
}
