//! The reference page of scene files, `docs/scene.md`, from the table of keys.

use std::fmt::Write;
use teeter_scenario::dimension::Dimension;
use teeter_scenario::keys::{Key, Kind, Occurrence, OnlyWith, Presence, Range, TABLES, TableSchema};
use teeter_scenario::units;

/// A scene as an example.
const EXAMPLE: &str = include_str!("../scenes/free-rocking-on-beam.toml");

const HEAD: &str = "\
<!-- Made by `teeter schema --format markdown`; to change it, change the table of keys in crates/scenario/src/table.rs. -->

# The scene file

A scene is a TOML file: a time span, bodies, the contacts between them, and output. `teeter check SCENE.toml` shows its
model and what looks wrong; `teeter run SCENE.toml` simulates it; `--set KEY=VALUE` overrides a key by its path, such as
`--set beam.table.thickness=\"2 mm\"`. `teeter schema` prints a JSON Schema for editors.

A value with a dimension is a string with its unit: `\"36 cm\"`, `\"69 GPa\"`, `\"9.81 m/s^2\"`, `\"0.4 N s/m^2\"`. A bare number
is an error there, so that no unit is ever guessed. Numbers may have absolute values from 1e-12 to 1e12 in SI units unless the
table says otherwise. Names (of materials, beams, blocks, contacts, signals, loads) may contain letters, digits, `_` and `-`, at
most 64 of them; no two bodies may share a name, and `ground` is reserved for the ground. A file may have at most 4 MB; all its
errors are reported at once. Paths of files named in a scene (tables of signals, at most 64 MB and 2 million rows) are relative to
its folder.
";

const PLACES: &str = "\
## Where a block starts

Either on a body: `on` names a beam, another block or `\"ground\"`, `at` is the position x of the midpoint of its base before it
is tilted, and `tilt` rotates it about the corner on which it then stands, the left one if positive, the right one if negative. A
contact between the two is required. On inclined ground the base lies along the incline, and `tilt` is relative to it. On ground
with a profile the base lies on the lowest line that is nowhere below the ground under it: along a piece, on two crests, or on a
crest and a corner; `tilt` is relative to that line. Ground and
supports with an initial displacement are displaced when the block is placed. Or anywhere: `position` is the position of its mass
centre and `angle` its rotation about it. A corner may not start below a surface with which it has a contact, and no block inside
another.
";

const WARNINGS: &str = "\
## Warnings

A scene with a warning still runs. `teeter check` and `teeter run` warn of

- a `tilt`, including the incline of the ground, within 10 % of the critical angle α = atan(width/height), or beyond it: released
  at rest the block overturns; or, of a block that stands on something, an `angle` beyond that of the side on which it lies,
  atan(height/width) on its side: in flight it has no foot about which to overturn;
- a force on a block that can't follow it, as it is fixed or its motion is prescribed;
- a beam that sags by more than 1/50 of its span under the weight of the blocks on it: deflections are no longer small (`check`
  notes a sag from 1/250 on: linear theory neglects the shortening of the axis, at 1/68 some per cent of the block's angle);
- a signal that is not used (`check` also notes an incline too steep for the friction of a block on it);
- a compliant contact whose duration, for the mass of the block and its stiffness, is less than 20 steps;
- the table of a signal that ends before the run or begins after 0 s with a value other than 0: that value is kept;
- a `step` longer than a tenth of the shortest time scale of a contact: the rocking time √(4R/3g) of a block, R half its diagonal,
  and for a block on a beam also the beam's first period;
- an `end` that is not a multiple of the step: the run continues to the first step past it;
- a `gap_tolerance` over 1e-6 of the shortest side of a block, as blocks may float that high (over 1e-3 it is refused), and a
  solver `tolerance` over 1e-4;
- `theta` below 0.5, with the largest stable step;
- a record that ends with more than 1 % of its largest velocity before the run does ([signals.md](signals.md));
- signals, and displacements of prescribed motions, that are faster than the step; supports, or ground under a block at rest, that
  start with a velocity ([signals.md](signals.md));
- a mesh, or modes, that lack flexibility where a block or a load acts; a key that has no effect.

A run gives warnings about what it has measured at its end, on the terminal, on the page and among the `warnings` of `summary.json`:

| code | meaning |
|---|---|
| `under-resolved`, `under-resolved-swings`, `under-resolved-flight` | steps too long for the impacts of a block, for the vibration of a beam, for a flight with θ other than ½: motions are likely off by more than 10 % ([resolution.md](resolution.md)) |
| `unconverged` | steps whose contact problem was not solved to tolerance |
| `unlocated` | steps of `moreau-jean-located` in which not all impacts and ends of slides were located, or of `event-driven` not all events ([schemes.md](schemes.md)) |
| `energy-made` | contacts, or the scheme, generated 1 % or more of the energy scale, or of the energy lost ([schemes.md](schemes.md)) |
| `energy-taken` | the scheme itself dissipated 1 % or more of the energy scale ([schemes.md](schemes.md)) |
| `horizon` | up to when the motion is predictable, if `--horizon` finds that this is before the end ([accuracy.md](accuracy.md)) |
| `energy-account` | the energy identity is off by more than rounding |
| `deep-penetration`, `far-turn` | penetrations of more than a tenth of a block's shorter side; rotations of more than 0.1 rad per step |
| `contested-landing` | a block landed while bounces of another of its contacts had been cut short by the steps of `moreau-jean-located` ([accuracy.md](accuracy.md)) |
| `crest-impact` | a hump of a beam struck a base that came down on it: what a step makes of such a landing depends on its size ([schemes.md](schemes.md)) |
| `fast-pass` | two blocks so fast, or turning so fast, that a step may miss their contact; a block that a step took through the ground |
| `passes-through`, `between-corners`, `past-the-end` | overlapping bodies where no contact is modelled ([impacts.md](impacts.md)) |
| `large-deflection`, `yield` | a beam beyond linear theory, or over its yield strength |
| `model-limits` | energy or penetration over the limits on which a reduced model relies ([required.md](required.md)) |
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
        Occurrence::Named => " Any number, each with its own name.\n",
        Occurrence::Optional | Occurrence::Inline => " Optional.\n",
        _ => "\n",
    });
    // Recorded components of motions have the same keys everywhere.
    let same = TABLES.iter().find(|other| other.keys == table.keys && !table.keys.is_empty());
    if let Some(first) = same.filter(|first| first.pattern != table.pattern) {
        let _ = writeln!(page, "Keys: those of `{}`.", first.pattern.replace('*', "NAME"));
        return;
    }
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
        Presence::RequiredWithoutAny(others) => {
            let others: Vec<String> = others.iter().map(|other| format!("`{other}`")).collect();
            format!("**required** without {}", others.join(", "))
        }
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
        Kind::WordOrTable([], keys) => table_of(keys),
        Kind::Tables(keys) => format!("array, each item {}", table_of(keys)),
        Kind::WordOrTable(words, keys) => format!("{}, or {}", quoted(words), table_of(keys)),
        Kind::WordOrTablePair(words, keys) => format!("two of {}, or {}", quoted(words), table_of(keys)),
        Kind::ChoicePair(choices) => format!("two of {}", quoted(choices)),
        Kind::PatternPairs => format!("array of two names each, {such_as}"),
        Kind::Names => format!("array of names, {such_as}"),
        Kind::Patterns => format!("array of names or patterns, {such_as}"),
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
