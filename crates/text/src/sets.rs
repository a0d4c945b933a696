//! `--set KEY=VALUE`: put into the tree before it is decoded, so that it goes by the same rules as
//! the file.

use crate::diagnostic::Diagnostic;
use crate::keys::{Found, Kind, Occurrence};
use crate::schema::Schema;
use crate::source::{Origin, Source};
use crate::suggest;
use crate::tree::{Branch, Node, Raw, Twig, lenient_value};

/// Paths that are compared for a suggestion.
const MOST_COMPARED: usize = 20_000;

/// Applies the settings in their order; a later one wins.
pub(crate) fn apply(schema: &Schema, root: &mut Branch, sets: &[(String, String)], source: &Source) -> Vec<Diagnostic> {
    let mut findings = Vec::new();
    for (index, (path, value)) in sets.iter().enumerate() {
        let path = path.trim();
        let origin = Origin::Set { index, text: setting(path, value) };
        match node(schema, path, value, &origin) {
            Ok(node) => {
                let segments: Vec<&str> = path.split('.').collect();
                insert(root, &segments, node, &origin);
            }
            Err(Wrong::Unknown) => findings.push(unknown(schema, root, path, &origin, source)),
            Err(Wrong::Rule(rule, remedy)) => {
                findings.push(source.error(&origin, path, rule).with_remedy(remedy));
            }
        }
    }
    findings
}

/// `KEY=VALUE`, as messages cite it.
pub(crate) fn setting(path: &str, value: &str) -> String {
    format!("{}={value}", path.trim())
}

enum Wrong {
    Unknown,
    Rule(String, String),
}

/// The value as a node, if the path addresses something that can take it.
fn node(schema: &Schema, path: &str, value: &str, origin: &Origin) -> Result<Node, Wrong> {
    let mut node = lenient_value(value.trim(), origin.clone());
    match schema.find(path).ok_or(Wrong::Unknown)? {
        Found::Key(_, key) => {
            // A title of digits, a material called true: a text needs no quotes here.
            let textual = matches!(key.kind, Kind::Text | Kind::Path | Kind::Name | Kind::Choice(_));
            if textual && !matches!(node.raw, Raw::Text(_)) {
                node.raw = Raw::Text(value.trim().to_owned());
            }
            Ok(node)
        }
        Found::Table(table) => match node.raw {
            Raw::Branch(_) => Ok(node),
            _ => Err(Wrong::Rule(
                format!("this is a table, got {}", node.raw.what()),
                format!("set one of its keys: {}", schema.allowed(table).join(", ")),
            )),
        },
        Found::Group(table) => Err(Wrong::Rule(
            "a name and a key are missing".to_owned(),
            format!("write {0}.NAME.KEY; the keys are {1}", table.name(), schema.allowed(table).join(", ")),
        )),
    }
}

/// Puts the node at the path; makes the tables on the way. Where something else than a table is in
/// the way, that is an error of the file which decoding reports.
fn insert(branch: &mut Branch, segments: &[&str], node: Node, origin: &Origin) {
    let Some((first, rest)) = segments.split_first() else {
        return;
    };
    let at = branch.twigs.iter().position(|twig| twig.key == *first);
    let fresh = |node: Node| Twig { key: (*first).to_owned(), key_origin: origin.clone(), node };
    if rest.is_empty() {
        match at.and_then(|at| branch.twigs.get_mut(at)) {
            Some(twig) => *twig = fresh(node),
            None => branch.twigs.push(fresh(node)),
        }
        return;
    }
    if at.is_none() {
        branch.twigs.push(fresh(Node {
            raw: Raw::Branch(Branch::default()),
            origin: origin.clone(),
            written: String::new(),
        }));
    }
    let at = at.unwrap_or(branch.twigs.len() - 1);
    if let Some(Twig { node: Node { raw: Raw::Branch(inner), .. }, .. }) = branch.twigs.get_mut(at) {
        insert(inner, rest, node, origin);
    }
}

fn unknown(schema: &Schema, root: &Branch, path: &str, origin: &Origin, source: &Source) -> Diagnostic {
    let known = paths(schema, root);
    let found = source
        .error(origin, path, "unknown key")
        .with_suggestion(suggest::nearest(path, known.iter().map(String::as_str)));
    // The keys of the table that the path does reach.
    let above = path.match_indices('.').rev().find_map(|(at, _)| match schema.find(path.get(..at)?)? {
        Found::Table(table) => Some((path.get(..at)?, table)),
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
            found.with_remedy(format!("a key is in one of {}", tables.join(", ")))
        }
    }
}

/// The paths that a pattern stands for, each with a dot at its end: a star is every name that the
/// document has there.
fn named_paths(branch: &Branch, pattern: &str, above: &str, all: &mut Vec<String>) {
    let Some((group, below)) = pattern.split_once(".*") else {
        all.push(if pattern.is_empty() { above.to_owned() } else { format!("{above}{pattern}.") });
        return;
    };
    let Some(Raw::Branch(named)) = branch.get(group).map(|node| &node.raw) else { return };
    for twig in &named.twigs {
        if let Raw::Branch(inner) = &twig.node.raw {
            let above = format!("{above}{group}.{}.", twig.key);
            named_paths(inner, below.trim_start_matches('.'), &above, all);
        }
    }
}

/// The paths of all keys that a document with these names can have.
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
