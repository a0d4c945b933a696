//! Decoded values, and their way back to TOML.

use crate::dimension::Dimension;
use crate::keys::Kind;
use crate::measure::Measure;
use crate::quantity;

/// A value of a scene; all quantities in SI units.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Value {
    /// A text, name or choice.
    Text(String),
    /// True or false.
    Flag(bool),
    /// A whole number.
    Integer(i64),
    /// A bare number or a quantity.
    Number(f64),
    /// Two quantities: x, y.
    Pair([f64; 2]),
    /// Any number of quantities.
    List(Vec<f64>),
    /// Two texts, names or choices.
    TextPair([String; 2]),
    /// A quantity by one of the units that its key takes.
    Measure(Measure),
}

impl Value {
    /// Whether it is of the type that a kind of key holds.
    pub(crate) fn fits(&self, kind: Kind) -> bool {
        match self {
            Self::Text(_) => matches!(kind, Kind::Text | Kind::Path | Kind::Name | Kind::Choice(_)),
            Self::Flag(_) => kind == Kind::Flag,
            Self::Integer(_) => matches!(kind, Kind::Integer { .. } | Kind::Version(_)),
            Self::Number(_) => {
                matches!(kind, Kind::Number(_) | Kind::Quantity(..) | Kind::Gravity)
            }
            Self::Pair(_) => matches!(kind, Kind::Pair(..) | Kind::Gravity),
            Self::List(_) => matches!(kind, Kind::List(..)),
            Self::TextPair(_) => matches!(kind, Kind::ChoicePair(_) | Kind::NamePair),
            Self::Measure(_) => matches!(kind, Kind::Measure(..)),
        }
    }

    /// As a TOML value that reads back to the same value, quantities in SI units.
    pub(crate) fn to_toml(&self, kind: Kind) -> String {
        let quoted = |value: &f64| format!("\"{}\"", quantity::format_si(*value, dimension_of(kind)));
        match self {
            Self::Text(text) => quote(text),
            Self::Flag(flag) => flag.to_string(),
            Self::Integer(value) => value.to_string(),
            Self::Number(value) if matches!(kind, Kind::Number(_)) => format!("{value:?}"),
            Self::Number(value) => quoted(value),
            Self::Pair([x, y]) => format!("[{}, {}]", quoted(x), quoted(y)),
            Self::List(values) => {
                let items: Vec<String> = values.iter().map(quoted).collect();
                format!("[{}]", items.join(", "))
            }
            Self::TextPair([a, b]) => format!("[{}, {}]", quote(a), quote(b)),
            Self::Measure(measure) => quote(&measure.to_string()),
        }
    }
}

fn dimension_of(kind: Kind) -> Dimension {
    match kind {
        Kind::Quantity(dimension, _) | Kind::Pair(dimension, _) | Kind::List(dimension, _) => dimension,
        Kind::Gravity => Dimension::ACCELERATION,
        _ => Dimension::NONE,
    }
}

/// A TOML basic string.
fn quote(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '\r' => out.push_str("\\r"),
            c if c.is_control() => out.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
