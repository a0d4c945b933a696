//! What a key expects, in words.

use crate::diagnostic::printable;
use crate::dimension::Dimension;
use crate::keys::{Key, Kind};

/// How to give a bare number its unit.
pub(crate) fn with_unit(number: &str, dimension: Dimension) -> String {
    let number = printable(number);
    let unit = dimension.unit();
    match dimension.usual_units() {
        [] | [_] => format!("write \"{number} {unit}\""),
        [_, others @ ..] => format!("write \"{number} {unit}\" if it is in {unit}; also known: {}", others.join(", ")),
    }
}

/// What a key's value is, with its article.
pub(crate) fn noun(key: &Key) -> String {
    match key.kind {
        Kind::Text => "a text in quotes".to_owned(),
        Kind::Name => "a name in quotes".to_owned(),
        Kind::Choice(_) => "a word in quotes".to_owned(),
        Kind::Flag => "true or false".to_owned(),
        Kind::Integer { .. } | Kind::Version(_) => "a whole number".to_owned(),
        Kind::Number(_) => "a bare number".to_owned(),
        Kind::Quantity(dimension, _) => format!("{} with its unit", dimension.name()),
        Kind::Pair(dimension, _) => {
            format!("an array of two, each {} with its unit,", dimension.name())
        }
        Kind::List(dimension, _) => {
            format!("an array, each item {} with its unit,", dimension.name())
        }
        Kind::ChoicePair(_) | Kind::NamePair => "an array of two words in quotes".to_owned(),
        Kind::Gravity => "an acceleration with its unit, or an array of two,".to_owned(),
    }
}

/// What would be right for a key: for `help:` lines.
pub(crate) fn expected(key: &Key) -> String {
    match key.kind {
        Kind::Choice(choices) => format!("built in: {}", choices.join(", ")),
        Kind::ChoicePair(choices) => {
            format!("two of {}, such as {}", choices.join(", "), key.example)
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
