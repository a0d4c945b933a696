//! Decoding of one TOML value against one entry of the table of keys.

use crate::diagnostic::{Diagnostic, MOST_FINDINGS, is_display_control};
use crate::dimension::Dimension;
use crate::keys::{Key, Kind, LONGEST_TITLE, Range};
use crate::measure::{AllowedUnit, Measure};
use crate::quantity::{self, QuantityError};
use crate::schema::Schema;
use crate::source::SourceText;
use crate::suggest;
use crate::tree::{Branch, Node, Raw};
use crate::value::{Item, Value};
use crate::wording::{self, expected, names, noun, with_unit};
use std::collections::BTreeMap;

/// Decodes nodes and collects what is wrong with them.
pub(crate) struct Judge<'a> {
    pub(crate) schema: &'static Schema,
    pub(crate) source: &'a SourceText,
    pub(crate) findings: Vec<Diagnostic>,
}

/// Longer names make tables of results unreadable.
const LONGEST_NAME: usize = 64;

/// Why a name is invalid; `None` if it is valid.
pub(crate) fn name_rule(name: &str) -> Option<String> {
    let letter = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if name.is_empty() || !name.chars().all(letter) {
        Some("a name may contain only letters (a-z, A-Z), digits, `_` and `-`".to_owned())
    } else if name.len() > LONGEST_NAME {
        Some(format!("a name may have at most {LONGEST_NAME} characters"))
    } else {
        None
    }
}

/// The memory that an absurd count would take, for a message.
fn memory(key: &Key, count: Option<i64>) -> String {
    match (key.bytes_each, count) {
        (0, _) | (_, None) => String::new(),
        // For a message: two digits are enough.
        #[expect(clippy::cast_precision_loss)]
        (bytes, Some(count)) => {
            format!("; {count} would take about {} of memory", wording::bytes(count as f64 * bytes as f64))
        }
    }
}

impl Judge<'_> {
    /// An error about a node.
    pub(crate) fn blame(&mut self, node: &Node, path: &str, rule: impl Into<String>) -> &mut Diagnostic {
        let mut found = self.source.error(&node.origin, path, rule);
        found.written = Some(node.written.clone());
        self.push(found)
    }

    /// Whether there are so many findings that more would not help.
    pub(crate) fn is_full(&self) -> bool {
        self.findings.len() >= MOST_FINDINGS
    }

    /// Adds a finding and returns it for details.
    pub(crate) fn push(&mut self, found: Diagnostic) -> &mut Diagnostic {
        let at = self.findings.len();
        self.findings.push(found);
        &mut self.findings[at]
    }

    /// The value of `key`, or `None` after reporting what is wrong.
    pub(crate) fn value(&mut self, key: &Key, path: &str, node: &Node) -> Option<Value> {
        if self.is_reserved(key, path, node) {
            return None;
        }
        match key.kind {
            Kind::Text => self.title(key, path, node).map(Value::Text),
            Kind::Path => self.file(key, path, node).map(Value::Text),
            Kind::Measure(units, range) => self.measure(key, units, &range, path, node).map(Value::Measure),
            Kind::Name => self.name(key, path, node).map(Value::Text),
            Kind::Choice(choices) => self.choice(key, choices, path, node).map(Value::Text),
            Kind::Flag => self.flag(key, path, node).map(Value::Flag),
            Kind::Integer { min, max } => self.integer(key, (min, max), path, node).map(Value::Integer),
            Kind::Version(known) => self.version(key, known, path, node).map(Value::Integer),
            Kind::Number(range) => self.number(key, &range, path, node).map(Value::Number),
            Kind::Quantity(dimension, range) => self.quantity(key, dimension, &range, path, node).map(Value::Number),
            Kind::Pair(dimension, range) => {
                let read = |judge: &mut Self, item: &Node| judge.quantity(key, dimension, &range, path, item);
                self.pair_of(key, path, node, read).map(Value::Pair)
            }
            Kind::Points(dimension, range) => {
                let read = |judge: &mut Self, item: &Node| judge.quantity(key, dimension, &range, path, item);
                let point = |judge: &mut Self, item: &Node| judge.pair_of(key, path, item, read);
                self.list_of(key, path, node, point).map(Value::Points)
            }
            Kind::List(dimension, range) => {
                let read = |judge: &mut Self, item: &Node| judge.quantity(key, dimension, &range, path, item);
                self.list_of(key, path, node, read).map(Value::List)
            }
            Kind::Numbers(range) => {
                let read = |judge: &mut Self, item: &Node| judge.number(key, &range, path, item);
                self.list_of(key, path, node, read).map(Value::List)
            }
            Kind::Words(choices) => self.words(key, choices, path, node).map(Value::Words),
            Kind::WordOrTable(words, keys) => self.item(key, (words, keys), path, node).map(Value::Item),
            Kind::Tables(keys) => {
                let read = |judge: &mut Self, item: &Node| judge.item(key, (&[], keys), path, item);
                self.list_of(key, path, node, read).map(Value::Items)
            }
            Kind::WordOrTablePair(words, keys) => {
                let read = |judge: &mut Self, item: &Node| {
                    let reserved = judge.is_reserved(key, path, item);
                    if reserved { None } else { judge.item(key, (words, keys), path, item) }
                };
                self.pair_of(key, path, node, read).map(Value::ItemPair)
            }
            Kind::ChoicePair(choices) => {
                let read = |judge: &mut Self, item: &Node| {
                    if judge.is_reserved(key, path, item) { None } else { judge.choice(key, choices, path, item) }
                };
                self.pair_of(key, path, node, read).map(Value::TextPair)
            }
            Kind::Names | Kind::Patterns => {
                let read = |judge: &mut Self, item: &Node| match key.kind {
                    Kind::Names => judge.name(key, path, item),
                    _ => judge.pattern(key, path, item),
                };
                let names = self.list_of(key, path, node, read)?;
                if names.is_empty() {
                    self.blame(node, path, "must have one name or more").remedy = Some(expected(key));
                    return None;
                }
                Some(Value::Words(names))
            }
            Kind::NamePair => {
                let read = |judge: &mut Self, item: &Node| judge.name(key, path, item);
                self.pair_of(key, path, node, read).map(Value::TextPair)
            }
            Kind::PatternPair => {
                let read = |judge: &mut Self, item: &Node| judge.pattern(key, path, item);
                self.pair_of(key, path, node, read).map(Value::TextPair)
            }
            Kind::PatternPairs => {
                let read = |judge: &mut Self, item: &Node| judge.pattern(key, path, item);
                let pair = |judge: &mut Self, item: &Node| judge.pair_of(key, path, item, read);
                self.list_of(key, path, node, pair).map(Value::TextPairs)
            }
            Kind::Downward(dimension) if matches!(node.raw, Raw::Array(_)) => {
                let read = |judge: &mut Self, item: &Node| judge.quantity(key, dimension, &Range::ANY, path, item);
                self.pair_of(key, path, node, read).map(Value::Pair)
            }
            Kind::Downward(dimension) => self.downward(key, dimension, path, node).map(Value::Number),
        }
    }

    /// An array of two items, each read by `read`.
    fn pair_of<T>(
        &mut self,
        key: &Key,
        path: &str,
        node: &Node,
        read: impl FnMut(&mut Self, &Node) -> Option<T>,
    ) -> Option<[T; 2]> {
        let items = self.items(key, path, node, Some(2))?;
        self.pair(items, read)
    }

    /// An array of any length, each item read by `read`; `None` if an item is invalid.
    fn list_of<T>(
        &mut self,
        key: &Key,
        path: &str,
        node: &Node,
        mut read: impl FnMut(&mut Self, &Node) -> Option<T>,
    ) -> Option<Vec<T>> {
        let items = self.items(key, path, node, None)?;
        let mut values = Vec::new();
        for item in items {
            values.extend(read(self, item));
            if self.is_full() {
                return None;
            }
        }
        (values.len() == items.len()).then_some(values)
    }

    fn words(&mut self, key: &Key, choices: &[&str], path: &str, node: &Node) -> Option<Vec<String>> {
        let items = self.items(key, path, node, None)?;
        let mut words: Vec<String> = Vec::new();
        for item in items {
            let word = self.choice(key, choices, path, item)?;
            if words.contains(&word) {
                self.blame(item, path, format!("`{word}` is given twice")).remedy = Some(expected(key));
                return None;
            }
            words.push(word);
        }
        Some(words)
    }

    /// Reports a value that is not implemented yet.
    fn is_reserved(&mut self, key: &Key, path: &str, node: &Node) -> bool {
        let reserved = key.reserved.iter().find(|reserved| match &node.raw {
            Raw::Text(text) => text == reserved.value,
            Raw::Flag(flag) => reserved.value == if *flag { "true" } else { "false" },
            Raw::Branch(branch) => branch.get(reserved.value).is_some(),
            _ => false,
        });
        let Some(reserved) = reserved else {
            return false;
        };
        let rule = format!("`{}` is not implemented yet", reserved.value);
        let remedy = match reserved.instead {
            "" => expected(key),
            instead => instead.to_owned(),
        };
        self.blame(node, path, rule).remedy = Some(remedy);
        true
    }

    /// The value is of another type than the key's.
    fn mistyped(&mut self, key: &Key, path: &str, node: &Node) {
        // "true" or a number in quotes: only the quotes are wrong.
        let unquoted = match (&node.raw, key.kind) {
            (Raw::Text(text), Kind::Flag) => matches!(text.as_str(), "true" | "false").then_some(text),
            (Raw::Text(text), Kind::Number(_)) => text.parse::<f64>().is_ok().then_some(text),
            (Raw::Text(text), Kind::Integer { .. } | Kind::Version(_)) => text.parse::<i64>().is_ok().then_some(text),
            _ => None,
        };
        let remedy = match unquoted {
            Some(text) => format!("write {} without quotes", text.trim()),
            None => expected(key),
        };
        let rule = format!("{} is expected, got {}", noun(key), node.raw.what());
        self.blame(node, path, rule).remedy = Some(remedy);
    }

    fn text(&mut self, key: &Key, path: &str, node: &Node) -> Option<String> {
        if let Raw::Text(text) = &node.raw {
            return Some(text.clone());
        }
        self.mistyped(key, path, node);
        None
    }

    /// A line of text that is shown to users.
    fn title(&mut self, key: &Key, path: &str, node: &Node) -> Option<String> {
        let text = self.text(key, path, node)?;
        let rule = if let Some(c) = text.chars().find(|&c| is_display_control(c)) {
            format!(
                "contains the character U+{:04X}, which is not shown but is_display_control how a line is shown",
                u32::from(c)
            )
        } else if text.chars().nth(LONGEST_TITLE).is_some() {
            format!("has {} characters, more than the limit of {LONGEST_TITLE}", text.chars().count())
        } else {
            return Some(text);
        };
        self.blame(node, path, rule).remedy = Some("give a line of text that fits above a figure".to_owned());
        None
    }

    fn file(&mut self, key: &Key, path: &str, node: &Node) -> Option<String> {
        let text = self.text(key, path, node)?;
        if text.is_empty() || text.contains('\0') {
            self.blame(node, path, "not a valid file name").remedy = Some(expected(key));
            return None;
        }
        Some(text)
    }

    fn measure(&mut self, key: &Key, units: &[AllowedUnit], range: &Range, path: &str, node: &Node) -> Option<Measure> {
        let Raw::Text(text) = &node.raw else {
            self.mistyped(key, path, node);
            return None;
        };
        match Measure::read(text, units) {
            // Its range is one of the number alone.
            Ok(measure) => self.within(range, measure.value, Dimension::NONE, key, path, node).map(|_| measure),
            Err(error) => {
                let rule = match &error {
                    QuantityError::WrongDimension { got, unit, .. } => match got.name() {
                        "a quantity" => format!("`{unit}` is not a unit of this key"),
                        name => format!("{name} ({unit}) is not what is expected"),
                    },
                    _ => error.to_string(),
                };
                let found = self.blame(node, path, rule);
                found.did_you_mean = error.did_you_mean().map(str::to_owned);
                found.remedy = Some(expected(key));
                None
            }
        }
    }

    fn name(&mut self, key: &Key, path: &str, node: &Node) -> Option<String> {
        let text = self.text(key, path, node)?;
        match name_rule(&text) {
            Some(rule) => {
                let found = self.blame(node, path, rule);
                if text.contains(['*', '?']) {
                    found.remedy = Some("give one name: no patterns are possible here".to_owned());
                }
                None
            }
            None => Some(text),
        }
    }

    /// A name, or one with `*` or `?` in it.
    fn pattern(&mut self, key: &Key, path: &str, node: &Node) -> Option<String> {
        let text = self.text(key, path, node)?;
        let plain: String = text.chars().filter(|c| !matches!(c, '*' | '?')).collect();
        let only_stars = plain.is_empty() && !text.is_empty();
        match name_rule(&plain) {
            Some(rule) if !only_stars => {
                self.blame(node, path, format!("{rule}; `*` stands for any characters of a name, `?` for one"));
                None
            }
            _ => Some(text),
        }
    }

    fn choice(&mut self, key: &Key, choices: &[&str], path: &str, node: &Node) -> Option<String> {
        let text = self.text(key, path, node)?;
        if choices.contains(&text.as_str()) {
            return Some(text);
        }
        let nearest = suggest::nearest(&text, choices.iter().copied());
        let found = self.blame(node, path, format!("unknown {}", key.name));
        found.remedy = Some(expected(key));
        found.did_you_mean = nearest.map(str::to_owned);
        None
    }

    /// A word, or a table of keys, each checked like a key of a document's table.
    fn item(&mut self, key: &Key, (words, keys): (&[&str], &'static [Key]), path: &str, node: &Node) -> Option<Item> {
        match &node.raw {
            Raw::Branch(branch) => self.item_table(keys, path, branch).map(Item::Table),
            Raw::Text(_) if !words.is_empty() => self.choice(key, words, path, node).map(Item::Word),
            _ => {
                self.mistyped(key, path, node);
                None
            }
        }
    }

    fn item_table(
        &mut self,
        keys: &'static [Key],
        path: &str,
        branch: &Branch,
    ) -> Option<BTreeMap<&'static str, Value>> {
        let mut values = BTreeMap::new();
        let mut whole = true;
        for entry in &branch.entries {
            let inner = format!("{path}.{}", entry.key);
            let Some(key) = keys.iter().find(|key| key.name == entry.key) else {
                let mut found = self.source.error(&entry.key_origin, &inner, "unknown key");
                found.did_you_mean = suggest::nearest(&entry.key, keys.iter().map(|key| key.name)).map(str::to_owned);
                found.remedy = Some(format!("the keys allowed there are {}", names(keys)));
                self.push(found);
                whole = false;
                continue;
            };
            match self.value(key, &inner, &entry.node) {
                Some(value) => {
                    values.insert(key.name, value);
                }
                None => whole = false,
            }
        }
        whole.then_some(values)
    }

    fn flag(&mut self, key: &Key, path: &str, node: &Node) -> Option<bool> {
        if let Raw::Flag(flag) = node.raw {
            return Some(flag);
        }
        self.mistyped(key, path, node);
        None
    }

    fn integer(&mut self, key: &Key, (min, max): (i64, i64), path: &str, node: &Node) -> Option<i64> {
        let rule = match node.raw {
            Raw::Integer(Some(value)) if (min..=max).contains(&value) => return Some(value),
            Raw::Integer(Some(value)) if value < min => format!("must be at least {min}"),
            Raw::Integer(value) => format!("must lie in [{min}, {max}]{}", memory(key, value)),
            Raw::Float(_) => "a whole number is expected".to_owned(),
            _ => {
                self.mistyped(key, path, node);
                return None;
            }
        };
        self.blame(node, path, rule).remedy = Some(expected(key));
        None
    }

    fn version(&mut self, key: &Key, known: &[i64], path: &str, node: &Node) -> Option<i64> {
        let value = self.integer(key, (i64::MIN, i64::MAX), path, node)?;
        if known.contains(&value) {
            return Some(value);
        }
        let known: Vec<String> = known.iter().map(i64::to_string).collect();
        let rule =
            format!("this program reads version {} of {} files, got {value}", known.join(", "), self.schema.noun);
        self.blame(node, path, rule).remedy = Some(format!("write {} = {}", key.name, key.example));
        None
    }

    fn number(&mut self, key: &Key, range: &Range, path: &str, node: &Node) -> Option<f64> {
        let value = match node.raw {
            Raw::Float(value) => value,
            // Whole numbers with a physical meaning are far below 2^53.
            #[expect(clippy::cast_precision_loss)]
            Raw::Integer(Some(value)) => value as f64,
            Raw::Integer(None) => f64::INFINITY,
            _ => {
                self.mistyped(key, path, node);
                return None;
            }
        };
        self.within(range, value, Dimension::NONE, key, path, node)
    }

    fn quantity(&mut self, key: &Key, dimension: Dimension, range: &Range, path: &str, node: &Node) -> Option<f64> {
        let text = match &node.raw {
            Raw::Text(text) => text,
            Raw::Float(value) if !value.is_finite() => {
                self.blame(node, path, "not a finite number").remedy = Some(expected(key));
                return None;
            }
            Raw::Float(_) | Raw::Integer(_) => {
                let rule = format!("{} needs its unit, got a bare number", dimension.name());
                self.blame(node, path, rule).remedy = Some(with_unit(&node.written, dimension, range));
                return None;
            }
            other => {
                let (wanted, got) = (dimension.name(), other.what());
                let rule = format!("{wanted} with its unit is expected, got {got}");
                self.blame(node, path, rule).remedy = Some(expected(key));
                return None;
            }
        };
        match quantity::parse(text, dimension) {
            Ok(value) => self.within(range, value, dimension, key, path, node),
            Err(error) => {
                let remedy = match &error {
                    QuantityError::MissingUnit => Some(with_unit(text.trim(), dimension, range)),
                    _ => error.remedy(),
                };
                let rule = match &error {
                    QuantityError::TooLarge | QuantityError::TooSmall => range.sizes_rule(dimension),
                    QuantityError::MissingNumber => {
                        format!(
                            "{} with its unit is expected, got a text that doesn't start with a number",
                            dimension.name()
                        )
                    }
                    _ => error.to_string(),
                };
                let found = self.blame(node, path, rule);
                found.did_you_mean = error.did_you_mean().map(str::to_owned);
                found.remedy = remedy.or_else(|| Some(expected(key)));
                None
            }
        }
    }

    fn downward(&mut self, key: &Key, dimension: Dimension, path: &str, node: &Node) -> Option<f64> {
        let range = Range::ANY;
        let value = self.quantity(key, dimension, &range, path, node)?;
        if let Some(rule) = Range::NOT_NEGATIVE.check(value, dimension) {
            let unit = dimension.unit();
            let remedy = format!(
                "a single number points downwards; for upwards write a vector such as [\"0 {unit}\", \"1 {unit}\"]"
            );
            self.blame(node, path, rule).remedy = Some(remedy);
            return None;
        }
        Some(value)
    }

    fn within(
        &mut self,
        range: &Range,
        value: f64,
        dimension: Dimension,
        key: &Key,
        path: &str,
        node: &Node,
    ) -> Option<f64> {
        match range.check(value, dimension) {
            None => Some(value),
            Some(rule) => {
                self.blame(node, path, rule).remedy = Some(expected(key));
                None
            }
        }
    }

    fn items<'n>(&mut self, key: &Key, path: &str, node: &'n Node, count: Option<usize>) -> Option<&'n [Node]> {
        match &node.raw {
            Raw::Array(items) if count.is_none_or(|count| items.len() == count) => Some(items),
            Raw::Array(items) => {
                let rule = format!("an array of two is expected, got {}", items.len());
                self.blame(node, path, rule).remedy = Some(expected(key));
                None
            }
            _ => {
                self.mistyped(key, path, node);
                None
            }
        }
    }

    /// Both items, each with its own message if it is wrong.
    fn pair<T>(&mut self, items: &[Node], mut read: impl FnMut(&mut Self, &Node) -> Option<T>) -> Option<[T; 2]> {
        let [first, second] = items else {
            return None;
        };
        match (read(self, first), read(self, second)) {
            (Some(first), Some(second)) => Some([first, second]),
            _ => None,
        }
    }
}
