//! Wording of messages: what a key expects, sizes, durations.

use crate::diagnostic::printable;
use crate::dimension::Dimension;
use crate::keys::{Key, Kind, Range};
use crate::quantity;

/// How to add the unit to a bare number: one that takes it into the range, if one does.
pub(crate) fn with_unit(number: &str, dimension: Dimension, range: &Range) -> String {
    let number = printable(number);
    let mut units: Vec<String> = dimension.usual_units().iter().map(|unit| (*unit).to_owned()).collect();
    if units.is_empty() {
        units.push(dimension.unit());
    }
    let fits = |unit: &String| {
        let value = quantity::parse(&format!("{number} {unit}"), dimension);
        value.is_ok_and(|value| range.check(value, dimension).is_none())
    };
    if units.iter().any(fits) {
        units.retain(fits);
    }
    match units.as_slice() {
        [unit, others @ ..] if !others.is_empty() => {
            format!("write \"{number} {unit}\" if it is in {unit}; also known: {}", others.join(", "))
        }
        only => format!("write \"{number} {}\"", only.concat()),
    }
}

/// The kind of a key's value, with the article.
pub(crate) fn noun(key: &Key) -> String {
    match key.kind {
        Kind::Text => "a text in quotes".to_owned(),
        Kind::Path => "the name of a file in quotes".to_owned(),
        Kind::Measure(units, _) => {
            let units: Vec<&str> = units.iter().map(|unit| unit.example).collect();
            format!("a quantity in {}", units.join(" or "))
        }
        Kind::Name => "a name in quotes".to_owned(),
        Kind::Choice(_) => "a word in quotes".to_owned(),
        Kind::Flag => "true or false".to_owned(),
        Kind::Integer { .. } | Kind::Version(_) => "a whole number".to_owned(),
        Kind::Number(_) => "a bare number".to_owned(),
        Kind::Quantity(dimension, _) => format!("{} with its unit", dimension.name()),
        Kind::Pair(dimension, _) => {
            format!("an array of two, each {} with its unit,", dimension.name())
        }
        Kind::Points(dimension, _) => {
            format!("an array of points, each an array of two, {} with its unit,", dimension.name())
        }
        Kind::List(dimension, _) => {
            format!("an array, each item {} with its unit,", dimension.name())
        }
        Kind::Numbers(_) => "an array of bare numbers".to_owned(),
        Kind::Words(_) | Kind::Names | Kind::Patterns => "an array of words in quotes".to_owned(),
        Kind::WordOrTable([], _) => "a table".to_owned(),
        Kind::Tables(_) => "an array of tables".to_owned(),
        Kind::WordOrTable(..) => "a word in quotes or a table".to_owned(),
        Kind::WordOrTablePair(..) => "an array of two, each a word in quotes or a table,".to_owned(),
        Kind::PatternPairs => "an array of pairs, each an array of two words in quotes,".to_owned(),
        Kind::ChoicePair(_) | Kind::NamePair | Kind::PatternPair => "an array of two words in quotes".to_owned(),
        Kind::Downward(dimension) => format!("{} with its unit, or an array of two,", dimension.name()),
    }
}

/// The names of some keys.
pub(crate) fn names(keys: &[Key]) -> String {
    let names: Vec<&str> = keys.iter().map(|key| key.name).collect();
    names.join(", ")
}

/// What a key expects: for `help:` lines.
#[must_use]
pub fn expected(key: &Key) -> String {
    match key.kind {
        Kind::Choice(choices) if key.elsewhere.is_empty() => format!("choose one of {}", choices.join(", ")),
        Kind::Choice(choices) => format!("choose one of {}; {}", choices.join(", "), key.elsewhere),
        Kind::ChoicePair(choices) => {
            format!("two of {}, such as {}", choices.join(", "), key.example)
        }
        Kind::Words(words) => format!("some of {}, each once, such as {}", words.join(", "), key.example),
        Kind::WordOrTable([], keys) => format!("a table of {}, such as {}", names(keys), key.example),
        Kind::Tables(keys) => format!("an array of tables of {}, such as {}", names(keys), key.example),
        Kind::WordOrTable(words, keys) => {
            format!("available: {}, or a table of {}", words.join(", "), names(keys))
        }
        Kind::WordOrTablePair(words, keys) => {
            format!("two of {}, or tables of {}; such as {}", words.join(", "), names(keys), key.example)
        }
        Kind::Flag => "write true or false".to_owned(),
        Kind::Integer { min, max } => {
            format!("a whole number from {min} to {max}, such as {}", key.example)
        }
        _ => {
            let noun = noun(key);
            format!("{}, such as {}", noun.trim_end_matches(','), key.example)
        }
    }
}

/// A size of memory or files, with two digits.
#[must_use]
pub fn bytes(count: f64) -> String {
    let units = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    match units.into_iter().find(|(size, _)| count >= *size) {
        Some((size, unit)) if count < 9.95 * size => format!("{:.1} {unit}", count / size),
        Some((size, unit)) => format!("{:.0} {unit}", count / size),
        None => format!("{count:.0} bytes"),
    }
}

/// The time of a computation.
#[must_use]
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.095 => "less than 0.1 s".to_owned(),
        s if s < 9.95 => format!("{s:.1} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} minutes", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} hours", s / 3600.0),
        s if s < 6.3e7 => format!("{:.0} days", s / 86_400.0),
        s => format!("{:.0} years", s / 3.156e7),
    }
}
