//! A decoded document: values by path, with defaults and origins, and its conversion back to TOML.

mod other_numbers;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::Bound;

use crate::decode;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::judge::Judge;
use crate::keys::{Key, Kind, Occurrence, PathTarget, TableSchema};
use crate::measure::Measure;
use crate::schema::Schema;
use crate::source::{Origin, SourceText};
use crate::tree::lenient_value;
use crate::value::{Item, Value};

use other_numbers::ReadCounts;
pub use other_numbers::SettingsRead;

/// A value of a document with its key and origin.
#[derive(Debug, Clone)]
pub struct Entry {
    /// Its entry in the table of keys.
    pub key: &'static Key,
    /// In SI units.
    pub value: Value,
    /// Where it came from.
    pub origin: Origin,
    /// As written there, shortened.
    pub written: String,
}

/// A document as decoded by [`crate::decode::parse`]: each value by its path, such as
/// `beam.table.thickness`.
///
/// All values have the kind and range given by the table of keys; its defaults are filled in. Rules
/// for several keys are not checked here: references to names, damping given twice, geometry.
///
/// The getters return `None` for a path that is absent or holds another kind of value.
#[derive(Debug, Clone)]
pub struct Document {
    schema: &'static Schema,
    source: SourceText,
    /// The overrides that it was read with.
    sets: Vec<(String, String)>,
    reads: ReadCounts,
    entries: BTreeMap<String, Entry>,
    tables: BTreeMap<String, Origin>,
    /// By the path of the group.
    names: BTreeMap<String, Vec<String>>,
    /// Paths that were given an invalid value.
    refused: BTreeSet<String>,
}

/// Why [`Document::set`] refused a value.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SetError {
    /// The path is no key of the table of keys, or its table is not in the document.
    #[error("there is no key {0} in this document")]
    NoSuchKey(String),
    /// The key holds another type of value.
    #[error("the value doesn't have the type of the key {0}")]
    WrongType(String),
    /// The key does not take this value.
    #[error("{0}: {1}")]
    NotAllowed(String, String),
}

impl Document {
    pub(crate) fn new(schema: &'static Schema, source: SourceText, sets: &[(String, String)]) -> Self {
        Self {
            schema,
            source,
            sets: sets.to_vec(),
            reads: ReadCounts::new(sets.len()),
            entries: BTreeMap::new(),
            tables: BTreeMap::new(),
            names: BTreeMap::new(),
            refused: BTreeSet::new(),
        }
    }

    pub(crate) fn add(&mut self, path: &str, entry: Entry) {
        self.entries.insert(path.to_owned(), entry);
    }

    pub(crate) fn add_table(&mut self, path: &str, origin: Origin) {
        self.tables.insert(path.to_owned(), origin);
    }

    pub(crate) fn add_name(&mut self, group: &str, name: &str) {
        self.names.entry(group.to_owned()).or_default().push(name.to_owned());
    }

    pub(crate) fn refuse(&mut self, path: &str) {
        self.refused.insert(path.to_owned());
    }

    /// Whether the path was given an invalid value, so that there is already a message about it.
    pub fn is_refused(&self, path: &str) -> bool {
        self.refused.contains(path)
    }

    /// The file's name as given.
    pub fn file(&self) -> &str {
        &self.source.file
    }

    /// The text of the file; spans of diagnostics refer to it.
    pub fn source(&self) -> &str {
        &self.source.text
    }

    /// The value at a path with its key and origin.
    pub fn entry(&self, path: &str) -> Option<&Entry> {
        self.entries.get(path).inspect(|entry| self.count_read(entry))
    }

    fn count_read(&self, entry: &Entry) {
        if let Origin::Set { index, .. } = entry.origin {
            self.reads.count(index);
        }
    }

    /// All values, sorted by path.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &Entry)> {
        self.entries.iter().map(|(path, entry)| (path.as_str(), entry)).inspect(|(_, entry)| self.count_read(entry))
    }

    /// The values whose paths begin with `start`, sorted by path.
    pub fn entries_from<'d>(&'d self, start: &'d str) -> impl Iterator<Item = (&'d str, &'d Entry)> {
        let after = self.entries.range::<str, _>((Bound::Included(start), Bound::Unbounded));
        let from =
            after.map(|(path, entry)| (path.as_str(), entry)).take_while(move |(path, _)| path.starts_with(start));
        from.inspect(|(_, entry)| self.count_read(entry))
    }

    /// Whether there is a value at the path, given or by default.
    pub fn has(&self, path: &str) -> bool {
        self.entries.contains_key(path)
    }

    /// Whether the value at the path was given by the file or a `--set`, not by default.
    pub fn is_given(&self, path: &str) -> bool {
        self.entries.get(path).is_some_and(|entry| matches!(entry.origin, Origin::File(_) | Origin::Set { .. }))
    }

    /// Whether the document has this table: `ground`, `beam.table`, `beam.table.rayleigh`. Tables
    /// that always exist are included even if the file doesn't name them.
    pub fn has_table(&self, path: &str) -> bool {
        self.tables.contains_key(path)
    }

    /// The names in a group (`material`, `beam`, `beam.table.support`) in the order of the file.
    pub fn names(&self, group: &str) -> Vec<&str> {
        self.names.get(group).map(|names| names.iter().map(String::as_str).collect()).unwrap_or_default()
    }

    /// A quantity in SI units.
    pub fn quantity(&self, path: &str) -> Option<f64> {
        match self.entry(path)? {
            Entry { key: Key { kind: Kind::Quantity(..), .. }, value: Value::Number(value), .. } => Some(*value),
            _ => None,
        }
    }

    /// A bare number.
    pub fn number(&self, path: &str) -> Option<f64> {
        match self.entry(path)? {
            Entry { key: Key { kind: Kind::Number(_), .. }, value: Value::Number(value), .. } => Some(*value),
            _ => None,
        }
    }

    /// A whole number.
    pub fn integer(&self, path: &str) -> Option<i64> {
        match self.entry(path)?.value {
            Value::Integer(value) => Some(value),
            _ => None,
        }
    }

    /// A text, name or choice, or the word given instead of a table.
    pub fn text(&self, path: &str) -> Option<&str> {
        match &self.entry(path)?.value {
            Value::Text(text) | Value::Item(Item::Word(text)) => Some(text),
            _ => None,
        }
    }

    /// A flag.
    pub fn flag(&self, path: &str) -> Option<bool> {
        match self.entry(path)?.value {
            Value::Flag(flag) => Some(flag),
            _ => None,
        }
    }

    /// A vector x, y in SI units. One number g where the kind is [`Kind::Downward`] is (0, −g).
    pub fn pair(&self, path: &str) -> Option<[f64; 2]> {
        let entry = self.entry(path)?;
        match (&entry.value, entry.key.kind) {
            (Value::Pair(pair), _) => Some(*pair),
            (Value::Number(down), Kind::Downward(_)) => Some([0.0, 0.0 - down]),
            _ => None,
        }
    }

    /// A word or a table.
    pub fn item(&self, path: &str) -> Option<&Item> {
        match &self.entry(path)?.value {
            Value::Item(item) => Some(item),
            _ => None,
        }
    }

    /// An array of pairs of texts.
    pub fn text_pairs(&self, path: &str) -> Option<&[[String; 2]]> {
        match &self.entry(path)?.value {
            Value::TextPairs(pairs) => Some(pairs),
            _ => None,
        }
    }

    /// An array of tables.
    pub fn items(&self, path: &str) -> Option<&[Item]> {
        match &self.entry(path)?.value {
            Value::Items(items) => Some(items),
            _ => None,
        }
    }

    /// Two, each a word or a table: the supports of a beam.
    pub fn item_pair(&self, path: &str) -> Option<&[Item; 2]> {
        match &self.entry(path)?.value {
            Value::ItemPair(items) => Some(items),
            _ => None,
        }
    }

    /// Points x, y in SI units.
    pub fn points(&self, path: &str) -> Option<&[[f64; 2]]> {
        match &self.entry(path)?.value {
            Value::Points(points) => Some(points),
            _ => None,
        }
    }

    /// A list of numbers, or of quantities in SI units.
    pub fn list(&self, path: &str) -> Option<&[f64]> {
        match &self.entry(path)?.value {
            Value::List(values) => Some(values),
            _ => None,
        }
    }

    /// Some words.
    pub fn words(&self, path: &str) -> Option<&[String]> {
        match &self.entry(path)?.value {
            Value::Words(words) => Some(words),
            _ => None,
        }
    }

    /// Two words: the bodies of a contact.
    pub fn text_pair(&self, path: &str) -> Option<[&str; 2]> {
        match &self.entry(path)?.value {
            Value::TextPair([first, second]) => Some([first, second]),
            _ => None,
        }
    }

    /// A quantity by one of several units.
    pub fn measure(&self, path: &str) -> Option<Measure> {
        match self.entry(path)?.value {
            Value::Measure(measure) => Some(measure),
            _ => None,
        }
    }

    /// Where the value at a path came from; for a path without a value, where its table came from.
    pub fn origin(&self, path: &str) -> Origin {
        if let Some(entry) = self.entry(path) {
            return entry.origin.clone();
        }
        self.table_origin(path)
    }

    fn table_origin(&self, path: &str) -> Origin {
        let mut above = path;
        loop {
            if let Some(origin) = self.tables.get(above) {
                return origin.clone();
            }
            match above.rsplit_once('.') {
                Some((parent, _)) => above = parent,
                None => return Origin::Default,
            }
        }
    }

    /// An error about the value or table at a path, at its position in the file; for a value that
    /// was not written, at the header of its table. For rules about several keys; make it a warning
    /// with [`Diagnostic::as_warning`].
    pub fn error(&self, path: &str, rule: impl Into<String>, remedy: impl Into<String>) -> Diagnostic {
        let entry = self.entry(path);
        let given = entry.filter(|_| self.is_given(path));
        let origin = given.map_or_else(|| self.table_origin(path), |entry| entry.origin.clone());
        let mut found = self.source.error(&origin, path, rule).with_remedy(remedy);
        found.written = entry.map(|entry| entry.written.clone());
        found
    }

    /// Line (from 1) of the value or table at a path, if the file has it.
    pub fn line(&self, path: &str) -> Option<usize> {
        match self.origin(path) {
            Origin::File(span) => Some(self.source.position(span.start).0),
            _ => None,
        }
    }

    /// A copy with one key changed, as if it had been read with an additional `--set key=value`:
    /// checked in the same way, with everything that depends on the key (defaults, keys that go
    /// with a word of it) decoded again. `value` is parsed as TOML if possible, otherwise taken as
    /// text. Values set by [`Document::set`] are left out, as they must be derived again.
    ///
    /// ```
    /// # use teeter_text::keys::{Key, Kind, Occurrence, Presence, Range, TableSchema};
    /// # use teeter_text::{decode, dimension::Dimension, schema::Schema};
    /// # const TIME: Kind = Kind::Quantity(Dimension::TIME, Range::POSITIVE);
    /// # static TABLES: &[TableSchema] = &[
    /// #     TableSchema { pattern: "", occurrence: Occurrence::Always, doc: "", keys: &[] },
    /// #     TableSchema { pattern: "time", occurrence: Occurrence::Always, doc: "", keys: &[
    /// #         Key::new("end", TIME, Presence::Required, "\"1 s\"", "When it ends."),
    /// #         Key::new("step", TIME, Presence::Default("\"1 ms\""), "\"1 ms\"", "Step."),
    /// #     ] },
    /// # ];
    /// # static SCHEMA: Schema = Schema::new("run", TABLES);
    /// let run = decode::parse(&SCHEMA, "[time]\nend = '1 s'", "run.toml", &[])?;
    /// let finer = run.with("time.step", "50 us")?;
    /// assert_eq!((run.quantity("time.step"), finer.quantity("time.step")), (Some(1e-3), Some(5e-5)));
    ///
    /// let errors = finer.with("time.step", "50 kg").unwrap_err();
    /// assert_eq!(errors.0[0].rule, "a time (s) is expected, got a mass (kg)");
    /// # Ok::<(), teeter_text::diagnostic::Diagnostics>(())
    /// ```
    ///
    /// # Errors
    /// Everything wrong in the document with this value: the path is not a key, or the key doesn't
    /// accept the value.
    pub fn with(&self, key: &str, value: impl fmt::Display) -> Result<Self, Diagnostics> {
        let mut sets = self.sets.clone();
        sets.push((key.to_owned(), value.to_string()));
        decode::parse(self.schema, &self.source.text, &self.source.file, &sets)
    }

    /// Sets a value that follows from others, so that [`Document::to_toml`] writes it.
    ///
    /// # Errors
    /// If the path is not a key, its table is not in the document, or the key doesn't accept the
    /// value.
    pub fn set(&mut self, path: &str, value: Value) -> Result<(), SetError> {
        let no_such_key = || SetError::NoSuchKey(path.to_owned());
        let Some(PathTarget::Key(_, key)) = self.schema.find(path) else {
            return Err(no_such_key());
        };
        if let Some((table, _)) = path.rsplit_once('.')
            && !self.tables.contains_key(table)
        {
            return Err(no_such_key());
        }
        if !value.fits(key.kind) {
            return Err(SetError::WrongType(path.to_owned()));
        }
        // Checked by the same code as the file, so that the output can be read again.
        let written = value.to_toml(key.kind);
        let mut judge = Judge { schema: self.schema, source: &self.source, findings: Vec::new() };
        let judged = judge.value(key, path, &lenient_value(&written, Origin::Derived));
        if judged.is_none() {
            let rule = judge.findings.pop().map(|found| found.rule);
            return Err(SetError::NotAllowed(path.to_owned(), rule.unwrap_or_default()));
        }
        let entry = Entry { key, value, origin: Origin::Derived, written };
        self.add(path, entry);
        Ok(())
    }

    /// Removes a value that was not given, so that [`Document::to_toml`] doesn't write it.
    pub fn forget_default(&mut self, path: &str) {
        if !self.is_given(path) {
            self.leave_out(path);
        }
    }

    /// Removes a value, given or not.
    pub fn leave_out(&mut self, path: &str) {
        self.entries.remove(path);
    }

    /// The document as TOML: every value in the order of the table of keys, including defaults,
    /// quantities in SI units. It parses to the same values bit for bit, and writing these again
    /// gives the same bytes.
    pub fn to_toml(&self) -> String {
        let mut out = String::new();
        if let Some(root) = self.schema.root() {
            self.write_table(root, "", &mut out);
        }
        out
    }

    /// As [`Document::to_toml`], with the names of files rewritten by `path`: for a document that
    /// is written to another folder.
    pub fn to_toml_elsewhere(&self, path: impl Fn(&str) -> String) -> String {
        let mut moved = self.clone();
        for entry in moved.entries.values_mut() {
            match (&mut entry.value, entry.key.kind) {
                (Value::Text(file), Kind::Path) => *file = path(file),
                (Value::Item(Item::Table(values)), Kind::WordOrTable(_, keys)) => {
                    for key in keys.iter().filter(|key| key.kind == Kind::Path) {
                        if let Some(Value::Text(file)) = values.get_mut(key.name) {
                            *file = path(file);
                        }
                    }
                }
                _ => {}
            }
        }
        moved.to_toml()
    }

    fn write_table(&self, table: &TableSchema, path: &str, out: &mut String) {
        let lines = self.lines(table, path);
        // An empty table that always exists means nothing; [ground] does.
        let say = !lines.is_empty() || (table.occurrence != Occurrence::Always && self.has_table(path));
        if say && !path.is_empty() {
            out.push_str(&format!("\n[{path}]\n"));
        }
        for line in lines {
            out.push_str(&line);
            out.push('\n');
        }
        for child in self.schema.children(table) {
            let inner = if path.is_empty() { child.name().to_owned() } else { format!("{path}.{}", child.name()) };
            match child.occurrence {
                Occurrence::Inline => {}
                Occurrence::Named => {
                    for name in self.names(&inner) {
                        self.write_table(child, &format!("{inner}.{name}"), out);
                    }
                }
                _ => self.write_table(child, &inner, out),
            }
        }
    }

    /// The keys of a table with their values, then its inline tables.
    fn lines(&self, table: &TableSchema, path: &str) -> Vec<String> {
        let line = |key: &Key| {
            let full = match path {
                "" => key.name.to_owned(),
                path => format!("{path}.{}", key.name),
            };
            let entry = self.entries.get(&full)?;
            Some(format!("{} = {}", key.name, entry.value.to_toml(key.kind)))
        };
        let mut lines: Vec<String> = table.keys.iter().filter_map(line).collect();
        for inline in self.schema.children(table).filter(|child| child.occurrence == Occurrence::Inline) {
            let path = format!("{path}.{}", inline.name());
            if self.has_table(&path) {
                lines.push(format!("{} = {{ {} }}", inline.name(), self.lines(inline, &path).join(", ")));
            }
        }
        lines
    }
}
