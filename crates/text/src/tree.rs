//! A document as a tree of TOML values in the order of the file, each with its origin, and its
//! construction from TOML.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::diagnostic::printable;
use crate::source::{Origin, SourceText};

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
    /// `None` if it doesn't fit into 64 bits.
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
    pub(crate) entries: Vec<TreeEntry>,
}

/// A key and its value.
#[derive(Debug, Clone)]
pub(crate) struct TreeEntry {
    pub(crate) key: String,
    pub(crate) key_origin: Origin,
    pub(crate) node: Node,
}

impl Branch {
    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        let entry = self.entries.iter().find(|entry| entry.key == key)?;
        Some(&entry.node)
    }
}

impl Raw {
    /// Its type in words, with the article.
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

/// Builds nodes from parsed TOML: of the file, of a `--set`, or of a default.
pub(crate) struct TreeBuilder<'a> {
    /// The text to which spans refer.
    pub(crate) source: &'a SourceText,
    /// The origin of all nodes; `None`: their spans in the source.
    pub(crate) origin: Option<Origin>,
}

impl TreeBuilder<'_> {
    fn origin(&self, span: std::ops::Range<usize>) -> Origin {
        self.origin.clone().unwrap_or(Origin::File(span))
    }

    /// The parser limits the depth of tables, so the recursion is bounded.
    pub(crate) fn branch(&self, table: &DeTable<'_>) -> Branch {
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let entries = entries
            .into_iter()
            .map(|(key, value)| TreeEntry {
                key: key.get_ref().to_string(),
                key_origin: self.origin(key.span()),
                node: self.node(value),
            })
            .collect();
        Branch { entries }
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

/// The value of a text: parsed as TOML if possible, otherwise a string.
pub(crate) fn lenient_value(text: &str, origin: Origin) -> Node {
    if let Some(raw) = plain(text) {
        return Node { raw, origin, written: printable(text) };
    }
    if has_unit(text) { untyped(text, origin) } else { parsed_leniently(text, origin) }
}

/// Whether a text is a plain number with a unit behind a space, which is no value in TOML without quotes.
fn has_unit(text: &str) -> bool {
    let number = text.strip_prefix('-').unwrap_or(text);
    let rest = number.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    rest.len() < number.len()
        && rest.strip_prefix(' ').is_some_and(|unit| unit.starts_with(|c: char| c.is_ascii_alphabetic()))
}

/// A string without quotes.
fn untyped(text: &str, origin: Origin) -> Node {
    Node { raw: Raw::Text(text.to_owned()), origin, written: printable(&format!("\"{text}\"")) }
}

/// A value whose TOML is what it looks like: every case of a study has dozens of them, derived and by
/// default, for which the parser would take most of the time of reading a scene.
fn plain(text: &str) -> Option<Raw> {
    match text.as_bytes() {
        b"true" => Some(Raw::Flag(true)),
        b"false" => Some(Raw::Flag(false)),
        [b'"', inner @ .., b'"'] => {
            let literal = inner.iter().all(|byte| matches!(byte, b' '..=b'~') && !matches!(byte, b'"' | b'\\'));
            literal.then(|| Raw::Text(text[1..text.len() - 1].to_owned()))
        }
        digits => {
            let digits = digits.strip_prefix(b"-").unwrap_or(digits);
            let (whole, fraction) = match digits.iter().position(|byte| *byte == b'.') {
                Some(point) => (&digits[..point], Some(&digits[point + 1..])),
                None => (digits, None),
            };
            let number = |part: &[u8]| !part.is_empty() && part.iter().all(u8::is_ascii_digit);
            let leading_zero = whole.len() > 1 && whole[0] == b'0';
            match fraction {
                _ if !number(whole) || leading_zero => None,
                Some(fraction) => number(fraction).then(|| text.parse().ok().map(Raw::Float))?,
                None => Some(Raw::Integer(text.parse().ok())),
            }
        }
    }
}

fn parsed_leniently(text: &str, origin: Origin) -> Node {
    let source = SourceText::new("", text);
    match DeValue::parse(text) {
        Ok(value) => TreeBuilder { source: &source, origin: Some(origin) }.node(&value),
        Err(_) => untyped(text, origin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_values_are_those_of_the_parser() {
        let mut texts: Vec<String> = [
            "true",
            "false",
            "True",
            "\"\"",
            "\"50 us\"",
            "\"a\\n\"",
            "\"a\"b\"",
            "\"",
            "\"\"\"",
            "\"\"\"\"",
            "\"\"\"\"\"\"",
            "\"ü\"",
            "\"a\tb\"",
            "\"a\u{7f}\"",
            "'a'",
            "0",
            "-0",
            "00",
            "-01",
            "12",
            "+3",
            "1_000",
            "99999999999999999999",
            "-9223372036854775808",
            "0.5",
            "-0.0",
            "-0.5",
            ".5",
            "5.",
            "00.5",
            "1.5e3",
            "1e5",
            "-",
            "",
            ".",
            "-.",
            "inf",
            "nan",
            "0x1f",
            "50 us",
            "-0.5 rad/s",
            "1.2.3 m",
            "1 e5",
            "1 t07:32:00Z",
            "1 m # long",
            "1 m\n",
            "1 \"m\"",
            "1 # m",
            "- m",
            " m",
            " 1",
            "1 ",
            "1.2.3",
            "[1, 2]",
            "2020-01-01",
            "1979-05-27T07:32:00Z",
            "12:30:00",
            "123456789.123456789",
            "0.1",
            "1.7976931348623157",
        ]
        .map(str::to_owned)
        .into();
        texts.push(format!("\"{}\"", "x".repeat(300)));
        for text in texts {
            let [fast, whole] =
                [lenient_value, parsed_leniently].map(|read| format!("{:?}", read(&text, Origin::Default)));
            assert_eq!(fast, whole, "{text:?}");
        }
        // And they do take the short way.
        assert!(["true", "\"50 us\"", "0.5", "-12"].iter().all(|text| plain(text).is_some()));
        assert!(has_unit("50 us") && has_unit("-0.5 rad/s") && !has_unit("1 # m") && !has_unit("- m"));
    }
}
