//! `--set KEY=VALUE`: inserted into the tree before it is decoded, so that it obeys the same rules
//! as the file.

use crate::diagnostic::Diagnostic;
use crate::keys::{Kind, Occurrence, PathTarget};
use crate::schema::Schema;
use crate::source::{Origin, SourceText};
use crate::suggest;
use crate::tree::{Branch, Node, Raw, TreeEntry, lenient_value};

/// Largest number of paths compared for a suggestion.
const MOST_COMPARED: usize = 20_000;

/// Applies the settings in their order; a later one wins.
pub(crate) fn apply(
    schema: &Schema,
    root: &mut Branch,
    sets: &[(String, String)],
    source: &SourceText,
) -> Vec<Diagnostic> {
    let mut findings = Vec::new();
    for (index, (path, value)) in sets.iter().enumerate() {
        let path = path.trim();
        let origin = Origin::Set { index, text: setting(path, value) };
        match node(schema, path, value, &origin) {
            Ok(node) => {
                let segments: Vec<&str> = path.split('.').collect();
                insert(root, &segments, node, &origin);
            }
            Err(SetProblem::Unknown) => findings.push(unknown(schema, root, path, &origin, source)),
            Err(SetProblem::Rule(rule, remedy)) => {
                findings.push(source.error(&origin, path, rule).with_remedy(remedy));
            }
        }
    }
    findings
}

/// `KEY=VALUE`, as quoted in messages.
pub(crate) fn setting(path: &str, value: &str) -> String {
    format!("{}={value}", path.trim())
}

enum SetProblem {
    Unknown,
    Rule(String, String),
}

/// The value as a node, if the path can have a value of its type.
fn node(schema: &Schema, path: &str, value: &str, origin: &Origin) -> Result<Node, SetProblem> {
    let mut node = lenient_value(value.trim(), origin.clone());
    match schema.find(path).ok_or(SetProblem::Unknown)? {
        PathTarget::Key(_, key) => {
            // A text needs no quotes here, even a title of digits or a material called true.
            let textual = matches!(key.kind, Kind::Text | Kind::Path | Kind::Name | Kind::Choice(_));
            if textual && !matches!(node.raw, Raw::Text(_)) {
                node.raw = Raw::Text(value.trim().to_owned());
            }
            Ok(node)
        }
        PathTarget::Table(table) => match node.raw {
            Raw::Branch(_) => Ok(node),
            _ => Err(SetProblem::Rule(
                format!("this is a table, got {}", node.raw.what()),
                format!("set one of its keys: {}", schema.allowed(table).join(", ")),
            )),
        },
        PathTarget::Group(table) => Err(SetProblem::Rule(
            "a name and a key are missing".to_owned(),
            format!("write {0}.NAME.KEY; the keys are {1}", table.name(), schema.allowed(table).join(", ")),
        )),
    }
}

/// Inserts the node at the path, creating tables as needed. If something other than a table is in
/// the way, decoding reports it as an error of the file.
fn insert(branch: &mut Branch, segments: &[&str], node: Node, origin: &Origin) {
    let Some((first, rest)) = segments.split_first() else {
        return;
    };
    let at = branch.entries.iter().position(|entry| entry.key == *first);
    let fresh = |node: Node| TreeEntry { key: (*first).to_owned(), key_origin: origin.clone(), node };
    if rest.is_empty() {
        match at.and_then(|at| branch.entries.get_mut(at)) {
            Some(entry) => *entry = fresh(node),
            None => branch.entries.push(fresh(node)),
        }
        return;
    }
    if at.is_none() {
        branch.entries.push(fresh(Node {
            raw: Raw::Branch(Branch::default()),
            origin: origin.clone(),
            written: String::new(),
        }));
    }
    let at = at.unwrap_or(branch.entries.len() - 1);
    if let Some(TreeEntry { node: Node { raw: Raw::Branch(inner), .. }, .. }) = branch.entries.get_mut(at) {
        insert(inner, rest, node, origin);
    }
}

fn unknown(schema: &Schema, root: &Branch, path: &str, origin: &Origin, source: &SourceText) -> Diagnostic {
    let known = paths(schema, root);
    let found = source
        .error(origin, path, "unknown key")
        .with_suggestion(suggest::nearest(path, known.iter().map(String::as_str)));
    // The keys of the longest part of the path that is a table.
    let above = path.match_indices('.').rev().find_map(|(at, _)| match schema.find(path.get(..at)?)? {
        PathTarget::Table(table) => Some((path.get(..at)?, table)),
        _ => None,
    });
    match above {
        Some((above, table)) => {
            found.with_remedy(format!("the keys of {above} are {}", schema.allowed(table).join(", ")))
        }
        None => {
            let tables: Vec<String> = schema
                .tables
                .iter()
                .filter(|table| table.occurrence != Occurrence::Inline && !table.pattern.is_empty())
                .map(|table| table.pattern.replace('*', "NAME"))
                .collect();
            found.with_remedy(format!("a key belongs to one of the tables {}", tables.join(", ")))
        }
    }
}

/// The paths that match a pattern, each with a dot at its end: a star matches every name in the
/// document.
fn named_paths(branch: &Branch, pattern: &str, above: &str, all: &mut Vec<String>) {
    let Some((group, below)) = pattern.split_once(".*") else {
        all.push(if pattern.is_empty() { above.to_owned() } else { format!("{above}{pattern}.") });
        return;
    };
    let Some(Raw::Branch(named)) = branch.get(group).map(|node| &node.raw) else { return };
    for entry in &named.entries {
        if let Raw::Branch(inner) = &entry.node.raw {
            let above = format!("{above}{group}.{}.", entry.key);
            named_paths(inner, below.trim_start_matches('.'), &above, all);
        }
    }
}

/// The paths of all possible keys of a document with these names.
fn paths(schema: &Schema, root: &Branch) -> Vec<String> {
    let mut all = Vec::new();
    for table in schema.tables {
        let mut prefixes = Vec::new();
        named_paths(root, table.pattern, "", &mut prefixes);
        for prefix in prefixes {
            all.extend(table.keys.iter().map(|key| format!("{prefix}{}", key.name)));
            if all.len() > MOST_COMPARED {
                return all;
            }
        }
    }
    all
}
