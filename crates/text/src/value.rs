//! Decoded values, and their conversion to TOML.

use std::collections::BTreeMap;

use crate::dimension::Dimension;
use crate::keys::{Key, Kind};
use crate::measure::Measure;
use crate::quantity;

/// A value of a document; all quantities in SI units.
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
    /// Points: each two quantities x, y.
    Points(Vec<[f64; 2]>),
    /// Any number of quantities.
    List(Vec<f64>),
    /// Two texts, names or choices.
    TextPair([String; 2]),
    /// Any number of pairs of texts.
    TextPairs(Vec<[String; 2]>),
    /// Some words.
    Words(Vec<String>),
    /// A quantity in one of the units that its key accepts.
    Measure(Measure),
    /// A word or a table.
    Item(Item),
    /// Two of them.
    ItemPair([Item; 2]),
    /// Any number of tables.
    Items(Vec<Item>),
}

/// A word, or a table of keys if a word is not enough.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// A word.
    Word(String),
    /// The given keys, by name.
    Table(BTreeMap<&'static str, Value>),
}

impl Item {
    fn value(&self, key: &str) -> Option<&Value> {
        match self {
            Self::Table(values) => values.get(key),
            Self::Word(_) => None,
        }
    }

    /// The number or quantity (in SI units) of a key of the table.
    #[must_use]
    pub fn number(&self, key: &str) -> Option<f64> {
        match self.value(key)? {
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// The whole number of a key of the table.
    #[must_use]
    pub fn integer(&self, key: &str) -> Option<i64> {
        match self.value(key)? {
            Value::Integer(number) => Some(*number),
            _ => None,
        }
    }

    /// The text of a key of the table.
    #[must_use]
    pub fn text(&self, key: &str) -> Option<&str> {
        match self.value(key)? {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The vector of a key of the table, in SI units.
    #[must_use]
    pub fn pair(&self, key: &str) -> Option<[f64; 2]> {
        match self.value(key)? {
            Value::Pair(pair) => Some(*pair),
            _ => None,
        }
    }

    /// The points of a key of the table, in SI units.
    #[must_use]
    pub fn points(&self, key: &str) -> Option<&[[f64; 2]]> {
        match self.value(key)? {
            Value::Points(points) => Some(points),
            _ => None,
        }
    }

    /// The table of a key of the table.
    #[must_use]
    pub fn item(&self, key: &str) -> Option<&Self> {
        match self.value(key)? {
            Value::Item(item) => Some(item),
            _ => None,
        }
    }

    fn to_toml(&self, keys: &[Key]) -> String {
        match self {
            Self::Word(word) => quote(word),
            Self::Table(values) => {
                let given = keys.iter().filter_map(|key| Some((key, values.get(key.name)?)));
                let pairs: Vec<String> =
                    given.map(|(key, value)| format!("{} = {}", key.name, value.to_toml(key.kind))).collect();
                if pairs.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", pairs.join(", ")) }
            }
        }
    }
}

impl Value {
    /// Whether it has the type of a kind of key.
    pub(crate) fn fits(&self, kind: Kind) -> bool {
        match self {
            Self::Text(_) => matches!(kind, Kind::Text | Kind::Path | Kind::Name | Kind::Choice(_)),
            Self::Flag(_) => kind == Kind::Flag,
            Self::Integer(_) => matches!(kind, Kind::Integer { .. } | Kind::Version(_)),
            Self::Number(_) => {
                matches!(kind, Kind::Number(_) | Kind::Quantity(..) | Kind::Downward(_))
            }
            Self::Pair(_) => matches!(kind, Kind::Pair(..) | Kind::Downward(_)),
            Self::Points(_) => matches!(kind, Kind::Points(..)),
            Self::List(_) => matches!(kind, Kind::List(..) | Kind::Numbers(_)),
            Self::TextPair(_) => matches!(kind, Kind::ChoicePair(_) | Kind::NamePair | Kind::PatternPair),
            Self::TextPairs(_) => kind == Kind::PatternPairs,
            Self::Words(_) => matches!(kind, Kind::Words(_) | Kind::Names | Kind::Patterns),
            Self::Measure(_) => matches!(kind, Kind::Measure(..)),
            Self::Item(_) => matches!(kind, Kind::WordOrTable(..)),
            Self::ItemPair(_) => matches!(kind, Kind::WordOrTablePair(..)),
            Self::Items(_) => matches!(kind, Kind::Tables(_)),
        }
    }

    /// As a TOML value that decodes to the same value, quantities in SI units.
    pub(crate) fn to_toml(&self, kind: Kind) -> String {
        let quoted = |value: &f64| format!("\"{}\"", quantity::format(*value, dimension_of(kind)));
        match self {
            Self::Text(text) => quote(text),
            Self::Flag(flag) => flag.to_string(),
            Self::Integer(value) => value.to_string(),
            Self::Number(value) if matches!(kind, Kind::Number(_)) => format!("{value:?}"),
            Self::Number(value) => quoted(value),
            Self::Pair([x, y]) => format!("[{}, {}]", quoted(x), quoted(y)),
            Self::Points(points) => {
                let points = points.iter().map(|[x, y]| format!("[{}, {}]", quoted(x), quoted(y)));
                format!("[{}]", points.collect::<Vec<_>>().join(", "))
            }
            Self::List(values) => {
                let bare = matches!(kind, Kind::Numbers(_));
                let show = |value: &f64| if bare { format!("{value:?}") } else { quoted(value) };
                let items: Vec<String> = values.iter().map(show).collect();
                format!("[{}]", items.join(", "))
            }
            Self::TextPair([a, b]) => format!("[{}, {}]", quote(a), quote(b)),
            Self::TextPairs(pairs) => {
                let pairs: Vec<String> = pairs.iter().map(|[a, b]| format!("[{}, {}]", quote(a), quote(b))).collect();
                format!("[{}]", pairs.join(", "))
            }
            Self::Words(words) => {
                let words: Vec<String> = words.iter().map(|word| quote(word)).collect();
                format!("[{}]", words.join(", "))
            }
            Self::Measure(measure) => quote(&measure.to_string()),
            Self::Item(item) => item.to_toml(keys_of(kind)),
            Self::ItemPair([a, b]) => format!("[{}, {}]", a.to_toml(keys_of(kind)), b.to_toml(keys_of(kind))),
            Self::Items(items) => {
                let items: Vec<String> = items.iter().map(|item| item.to_toml(keys_of(kind))).collect();
                format!("[{}]", items.join(", "))
            }
        }
    }
}

fn dimension_of(kind: Kind) -> Dimension {
    match kind {
        Kind::Quantity(dimension, _)
        | Kind::Pair(dimension, _)
        | Kind::Points(dimension, _)
        | Kind::List(dimension, _)
        | Kind::Downward(dimension) => dimension,
        _ => Dimension::NONE,
    }
}

/// The keys of the tables that may replace words.
fn keys_of(kind: Kind) -> &'static [Key] {
    match kind {
        Kind::WordOrTable(_, keys) | Kind::WordOrTablePair(_, keys) | Kind::Tables(keys) => keys,
        _ => &[],
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
