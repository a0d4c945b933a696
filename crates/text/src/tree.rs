//! A document as a tree of TOML values in the order of the file, each with its origin; and the
//! reading of TOML into it.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::diagnostic::printable;
use crate::source::{Origin, Source};

/// A value and where it came from.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) raw: Raw,
    pub(crate) origin: Origin,
    /// As written, shortened.
    pub(crate) written: String,
}

/// A TOML value.
#[derive(Debug, Clone)]
pub(crate) enum Raw {
    Text(String),
    /// `None` where it does not fit into 64 bits.
    Integer(Option<i64>),
    Float(f64),
    Flag(bool),
    Date,
    Array(Vec<Node>),
    Branch(Branch),
}

/// A TOML table in the order of the file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Branch {
    pub(crate) twigs: Vec<Twig>,
}

/// A key and its value.
#[derive(Debug, Clone)]
pub(crate) struct Twig {
    pub(crate) key: String,
    pub(crate) key_origin: Origin,
    pub(crate) node: Node,
}

impl Branch {
    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        let twig = self.twigs.iter().find(|twig| twig.key == key)?;
        Some(&twig.node)
    }
}

impl Raw {
    /// What it is, with its article.
    pub(crate) fn what(&self) -> &'static str {
        match self {
            Self::Text(_) => "a text",
            Self::Integer(_) => "an integer",
            Self::Float(_) => "a bare number",
            Self::Flag(_) => "true or false",
            Self::Date => "a date",
            Self::Array(_) => "an array",
            Self::Branch(_) => "a table",
        }
    }
}

/// Makes nodes out of parsed TOML: from the file, from a `--set`, or from a default.
pub(crate) struct Planter<'a> {
    /// The text that the spans count in.
    pub(crate) source: &'a Source,
    /// The origin of all nodes; `None`: their spans in the source.
    pub(crate) origin: Option<Origin>,
}

impl Planter<'_> {
    fn origin(&self, span: std::ops::Range<usize>) -> Origin {
        self.origin.clone().unwrap_or(Origin::File(span))
    }

    /// The parser bounds the depth of its tables, so the recursion is bounded as well.
    pub(crate) fn branch(&self, table: &DeTable<'_>) -> Branch {
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let twigs = entries
            .into_iter()
            .map(|(key, value)| Twig {
                key: key.get_ref().to_string(),
                key_origin: self.origin(key.span()),
                node: self.node(value),
            })
            .collect();
        Branch { twigs }
    }

    pub(crate) fn node(&self, value: &Spanned<DeValue<'_>>) -> Node {
        let raw = match value.get_ref() {
            DeValue::String(text) => Raw::Text(text.to_string()),
            DeValue::Integer(digits) => Raw::Integer(i64::from_str_radix(digits.as_str(), digits.radix()).ok()),
            DeValue::Float(digits) => Raw::Float(digits.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(flag) => Raw::Flag(*flag),
            DeValue::Datetime(_) => Raw::Date,
            DeValue::Array(items) => Raw::Array(self.items(items)),
            DeValue::Table(table) => Raw::Branch(self.branch(table)),
        };
        Node { raw, origin: self.origin(value.span()), written: self.source.written(&value.span()) }
    }

    fn items(&self, items: &DeArray<'_>) -> Vec<Node> {
        items.iter().map(|item| self.node(item)).collect()
    }
}

/// The value of a text: as TOML if it is TOML, else as a string.
pub(crate) fn lenient_value(text: &str, origin: Origin) -> Node {
    let source = Source::new("", text);
    match DeValue::parse(text) {
        Ok(value) => Planter { source: &source, origin: Some(origin) }.node(&value),
        Err(_) => Node { raw: Raw::Text(text.to_owned()), origin, written: printable(&format!("\"{text}\"")) },
    }
}
