//! Parses the text of a file to a tree, reporting all TOML errors at once.

use std::collections::BTreeSet;
use std::ops::Range;

use toml::de::DeTable;

use crate::diagnostic::Diagnostic;
use crate::quantity::Quantity;
use crate::schema::Schema;
use crate::source::{Origin, SourceText};
use crate::tree::{Branch, TreeBuilder};

/// Largest file that is read, in bytes.
pub const LARGEST_FILE: usize = 4 << 20;

/// An error about a file of another kind.
pub(crate) fn other_file(schema: &Schema, file: &str, rule: impl Into<String>) -> Diagnostic {
    let default = || format!("{} is a TOML file", schema.a_document());
    Diagnostic::error(file, rule).with_remedy(schema.advice.other_file.map_or_else(default, str::to_owned))
}

pub(crate) fn too_large(schema: &Schema, file: &str) -> Diagnostic {
    let rule = format!("the file is larger than {} MB, the limit for {}", LARGEST_FILE >> 20, schema.a_document());
    other_file(schema, file, rule)
}

/// Largest number of syntax errors reported; with more, the file is probably of another kind.
const MOST_ERRORS: usize = 50;

/// A file as a tree, as far as it could be read.
#[derive(Debug, Clone)]
pub(crate) struct Parsed {
    pub(crate) root: Branch,
    pub(crate) errors: Vec<Diagnostic>,
    /// Lines (from 0) with syntax errors: keys recovered from them should not be checked again.
    pub(crate) bad_lines: BTreeSet<usize>,
    /// Whether no part of the file was lost, so that a key missing from the tree is missing from
    /// the file.
    pub(crate) complete: bool,
}

/// Parses the TOML of a file, continuing after errors.
pub(crate) fn read(schema: &Schema, source: &SourceText) -> Parsed {
    let mut parsed =
        Parsed { root: Branch::default(), errors: Vec::new(), bad_lines: BTreeSet::new(), complete: false };
    if source.text.len() > LARGEST_FILE {
        parsed.errors.push(too_large(schema, &source.file));
        return parsed;
    }
    if let Some(at) = source.text.find('\0') {
        let rule = format!("not a text file: byte {at} is zero");
        parsed.errors.push(other_file(schema, &source.file, rule));
        return parsed;
    }
    // At a key without value the parser gives up on the rest of the file: blank such lines and
    // parse again. After an unclosed header the table of the keys is unknown: what follows is left
    // out.
    let mut text = source.text.to_string();
    let mut seen = BTreeSet::new();
    for round in 1.. {
        let (table, errors) = DeTable::parse_recoverable(&text);
        let (mut blank, mut cut) = (BTreeSet::new(), None);
        for error in errors.iter().take(MOST_ERRORS) {
            let span = span_within(error.span(), source);
            let fresh = seen.insert((span.start, error.message().to_owned()));
            if fresh && parsed.errors.len() < MOST_ERRORS {
                let found = finding(schema, source, &span, error.message());
                // The parser reports a missing value twice.
                let same_place = |other: &Diagnostic| other.span.as_ref() == Some(&span);
                if !parsed.errors.iter().any(same_place) {
                    parsed.errors.push(found);
                }
                if error.message() != DUPLICATE {
                    parsed.bad_lines.insert(source.line(span.start));
                }
                if error.message().starts_with(NO_VALUE) {
                    blank.insert(source.line(span.start));
                } else if error.message().starts_with("unclosed table") {
                    cut.get_or_insert(source.line(span.start));
                }
            }
        }
        let again = round < MOST_ROUNDS && errors.len() <= MOST_ERRORS;
        if let (Some(line), true) = (cut, again) {
            text.truncate(source.line_range(line).start);
        } else if again && !blank.is_empty() {
            for line in blank {
                let range = source.line_range(line);
                let blanks = " ".repeat(range.len());
                text.replace_range(range, &blanks);
            }
        } else {
            let builder = TreeBuilder { source, origin: None };
            parsed.root = builder.branch(table.get_ref());
            break;
        }
    }
    parsed.complete = parsed.bad_lines.is_empty();
    parsed
}

// Messages of the TOML parser that are replaced by better ones.
const DUPLICATE: &str = "duplicate key";
const NO_VALUE: &str = "key with no value";
const TOO_DEEP: &str = "recursion limit";
const UNQUOTED: &str = "string values must be quoted";
/// Largest number of parses of one file, each of which gets past lines that stop the parser.
const MOST_ROUNDS: u32 = 3;

/// The parser's span, or the start of the file if it gives none; never past the end.
fn span_within(span: Option<Range<usize>>, source: &SourceText) -> Range<usize> {
    let end = source.text.len();
    let span = span.unwrap_or(0..0);
    span.start.min(end)..span.end.min(end)
}

/// The header of the table to which a line belongs, as a dotted path; empty above the first header.
fn table_of(source: &SourceText, line: usize) -> String {
    (0..=line).rev().find_map(|line| header_of(source, line)).unwrap_or_default()
}

/// The path in a line that is a table's header.
fn header_of(source: &SourceText, line: usize) -> Option<String> {
    let text = source.line_text(line).trim_start();
    let text = text.split('#').next().unwrap_or_default();
    text.starts_with('[').then(|| text.trim_matches(['[', ']', ' ', '\t']).to_owned())
}

/// The key before the `=` of a line.
fn key_of(source: &SourceText, line: usize) -> &str {
    let text = source.line_text(line);
    text.split('=').next().unwrap_or_default().trim()
}

fn finding(schema: &Schema, source: &SourceText, span: &Range<usize>, message: &str) -> Diagnostic {
    if message == DUPLICATE {
        return duplicate(source, span);
    }
    let origin = Origin::File(span.clone());
    let line = source.line(span.start);
    let text = source.line_text(line);
    let key = join(&table_of(source, line), key_of(source, line));
    if message.starts_with(NO_VALUE) {
        let remedy = format!("write {} = and its value", key_of(source, line));
        let rule = "a key without a value";
        return source.error(&origin, &key, rule).with_remedy(remedy);
    }
    if let (true, Some((name, value))) = (message.starts_with(UNQUOTED), text.split_once('=')) {
        let value = value.split('#').next().unwrap_or_default().trim();
        if value.is_empty() {
            return source.error(&origin, &key, "a value is missing after the `=`");
        }
        if Quantity::read(value).is_ok() {
            let rule = format!("a value with a unit is written in quotes, got {value}");
            let remedy = format!("write {} = \"{value}\"", name.trim());
            return source.error(&origin, &key, rule).with_remedy(remedy);
        }
    }
    if message == TOO_DEEP {
        return too_deep(schema, source);
    }
    let rule = message
        .replace("invalid basic string, expected", "the text in quotes does not end, expected")
        .replace("invalid literal string, expected", "the text in quotes does not end, expected")
        .replace("literal string", "a text in quotes");
    // In an assignment, the key before the sign is at fault.
    let bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    let is_key = text.contains('=') && !key.is_empty() && key.chars().all(bare);
    source.error(&origin, if is_key { &key } else { "" }, rule)
}

/// The parser gives no position: take the first line with the deepest nesting.
fn too_deep(schema: &Schema, source: &SourceText) -> Diagnostic {
    let depth = |line: &str| line.matches(['.', '[', '{']).count();
    let (mut start, mut deepest, mut most) = (0, 0, 0);
    for line in source.text.split_inclusive('\n') {
        if depth(line) > most {
            (deepest, most) = (start, depth(line));
        }
        start += line.len();
    }
    let origin = Origin::File(deepest..deepest);
    let rule = "nested too deeply: a key with too many parts, or too many nested tables or arrays";
    let mut found = source.error(&origin, "", rule);
    found.remedy = schema.advice.too_deep.map(str::to_owned);
    found
}

fn join(table: &str, key: &str) -> String {
    if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") }
}

fn duplicate(source: &SourceText, span: &Range<usize>) -> Diagnostic {
    let line = source.line(span.start);
    let (path, first) = if let Some(header) = header_of(source, line) {
        let first = (0..line).find(|earlier| header_of(source, *earlier).as_ref() == Some(&header));
        (header, first)
    } else {
        let table = table_of(source, line);
        let whole = key_of(source, line);
        let key = source.text.get(span.clone()).unwrap_or_default();
        let before = source.line_text(line).get(..span.end.saturating_sub(source.line_range(line).start));
        if let Some(given) = before.filter(|before| !before.contains('=')) {
            // For a dotted key, the part up to the duplicate, which is the same key or a table of
            // that name.
            let path = join(&table, given.trim());
            let same = |earlier: &usize| match header_of(source, *earlier) {
                Some(header) => header == path,
                None => join(&table_of(source, *earlier), key_of(source, *earlier)) == path,
            };
            let first = (0..line).find(same);
            (path, first)
        } else {
            // Within { … }.
            (join(&join(&table, whole), key), None)
        }
    };
    let rule = match first {
        Some(first) => format!("given twice, first on line {}", first + 1),
        None => "given twice".to_owned(),
    };
    source.error(&Origin::File(span.clone()), &path, rule).with_remedy("keep one of the two")
}
