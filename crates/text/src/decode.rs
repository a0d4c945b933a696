//! Decodes the text of a file to a [`Document`]: the whole file against the tables of a schema,
//! with all errors at once.

use crate::diagnostic::MOST_FINDINGS;
use crate::diagnostic::{Diagnostic, Diagnostics, printable};
use crate::document::{Document, Entry};
use crate::judge::{Judge, name_rule};
use crate::keys::{Key, Occurrence, OnlyWith, Presence, TableSchema};
use crate::schema::{Namespace, Schema};
use crate::sets::setting;
use crate::source::{Origin, SourceText};
use crate::tree::{Branch, Node, Raw, TreeEntry, lenient_value};
use crate::wording::expected;

pub use crate::syntax::LARGEST_FILE;
use crate::{sets, suggest, syntax};

/// Reads a document. `file` is its name in messages; each of `sets` is a key's path and a value
/// that takes precedence over the file.
///
/// The text may start with a byte order mark and may have Windows line ends. The value of a setting
/// is parsed as TOML if possible, otherwise taken as text: `("time.step", "50 us")` needs no inner
/// quotes.
///
/// An example is at [`Schema`].
///
/// # Errors
/// Everything wrong in the file and the settings, in the order of the file (some
/// 200 at most; [`Diagnostics`] says how many more).
pub fn parse(
    schema: &'static Schema,
    source: &str,
    file: &str,
    sets: &[(String, String)],
) -> Result<Document, Diagnostics> {
    let Decoded { document, found, .. } = decode(schema, source, file, sets);
    if found.has_errors() { Err(found) } else { Ok(document) }
}

/// A document as far as it could be read.
#[derive(Debug)]
pub struct Decoded {
    /// What could be read.
    pub document: Document,
    /// The findings, in order.
    pub found: Diagnostics,
    /// Whether every table of the file is in the document, so that rules for several keys can be
    /// checked too.
    pub whole: bool,
}

/// The text of a file, parsed once: for a document that is decoded with many settings.
#[derive(Debug, Clone)]
pub struct ParsedText {
    schema: &'static Schema,
    source: SourceText,
    parsed: syntax::Parsed,
}

impl ParsedText {
    /// Parses a text; `file` is its name in messages. What is wrong is found by [`Self::decode`].
    #[must_use]
    pub fn new(schema: &'static Schema, source: &str, file: &str) -> Self {
        let source = SourceText::new(file, source);
        let parsed = syntax::read(schema, &source);
        Self { schema, source, parsed }
    }

    /// Reads it with settings, as [`decode()`] does.
    #[must_use]
    pub fn decode(&self, sets: &[(String, String)]) -> Decoded {
        decode_parsed(self.schema, self.source.clone(), self.parsed.clone(), sets)
    }
}

/// Reads a document as [`parse`] does, going on after errors.
pub fn decode(schema: &'static Schema, source: &str, file: &str, sets: &[(String, String)]) -> Decoded {
    let source = SourceText::new(file, source);
    let parsed = syntax::read(schema, &source);
    decode_parsed(schema, source, parsed, sets)
}

fn decode_parsed(
    schema: &'static Schema,
    source: SourceText,
    parsed: syntax::Parsed,
    sets: &[(String, String)],
) -> Decoded {
    let file = source.file.clone();
    let file: &str = &file;
    let syntax::Parsed { mut root, errors, bad_lines, complete } = parsed;
    let mut found = Diagnostics(errors);
    found.0.extend(sets::apply(schema, &mut root, sets, &source));
    if root.entries.is_empty() && found.0.is_empty() {
        let mut empty = Diagnostic::error(file, format!("the file contains no {}: it is empty", schema.noun));
        empty.remedy = schema.advice.empty.map(str::to_owned);
        return Decoded { document: Document::new(schema, source, sets), found: empty.into(), whole: false };
    }
    let mut decoder = Decoder {
        schema,
        judge: Judge { schema, source: &source, findings: Vec::new() },
        missing: Vec::new(),
        document: Document::new(schema, source.clone(), sets),
    };
    decoder.root(&root);
    let whole = complete && !decoder.is_full();
    let Decoder { judge, missing, document, .. } = decoder;
    // A broken line already has its message, and a key that seems to be missing may be in it.
    found.0.extend(judge.findings.into_iter().filter(|finding| {
        let place = finding.span.as_ref().map(|span| source.line(span.start));
        place.is_none_or(|line| !bad_lines.contains(&line))
    }));
    if complete {
        found.0.extend(missing.into_iter().map(|finding| with_users(schema, finding, &document)));
    }
    in_order(&mut found, sets);
    Decoded { document, found, whole }
}

/// Sorts findings for output: by position in the file, then those about settings in the order of
/// the settings.
pub fn in_order(found: &mut Diagnostics, sets: &[(String, String)]) {
    found.0.sort_by_key(|finding| {
        let text = finding.set.as_ref()?;
        sets.iter().position(|(path, value)| *text == setting(path, value))
    });
    found.sort();
}

fn uncapitalised(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map(|first| first.to_lowercase().chain(letters).collect()).unwrap_or_default()
}

/// Adds to a finding about a missing key the tables that refer to its table.
fn with_users(schema: &Schema, mut finding: Diagnostic, document: &Document) -> Diagnostic {
    for reference in schema.references {
        let below = finding.path.strip_prefix(reference.group).and_then(|rest| rest.strip_prefix('.'));
        let Some(name) = below.and_then(|rest| rest.split('.').next()).map(str::to_owned) else { continue };
        let tables = reference
            .from
            .iter()
            .flat_map(|group| document.names(group).into_iter().map(move |name| format!("{group}.{name}")));
        let uses = |table: &String| document.text(&format!("{table}.{}", reference.key)) == Some(&name);
        let users: Vec<String> = tables.filter(uses).take(3).collect();
        if !users.is_empty() {
            finding.rule.push_str(&format!(", used by {}", users.join(", ")));
        }
    }
    finding
}

/// The text of a file's bytes.
///
/// # Errors
/// There are too many bytes, or they are not UTF-8; the message names the first wrong one.
pub fn text<'a>(schema: &Schema, bytes: &'a [u8], file: &str) -> Result<&'a str, Diagnostics> {
    if bytes.len() > LARGEST_FILE {
        return Err(syntax::too_large(schema, file).into());
    }
    std::str::from_utf8(bytes).map_err(|error| {
        let rule = format!("not a text file in UTF-8: byte {} cannot be read", error.valid_up_to());
        syntax::other_file(schema, file, rule).into()
    })
}

/// Walks over the tree and the table of keys together.
struct Decoder<'a> {
    schema: &'static Schema,
    judge: Judge<'a>,
    /// Separate, as they are not reported if a syntax error may have swallowed the key.
    missing: Vec<Diagnostic>,
    document: Document,
}

/// A path with one more key, quoted unless it is a bare key.
fn join(path: &str, key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-');
    match (path, bare) {
        ("", true) => key.to_owned(),
        ("", false) => format!("{key:?}"),
        (path, true) => format!("{path}.{key}"),
        (path, false) => format!("{path}.{key:?}"),
    }
}

impl Decoder<'_> {
    fn is_full(&self) -> bool {
        self.judge.is_full() || self.missing.len() >= MOST_FINDINGS
    }

    fn root(&mut self, branch: &Branch) {
        let Some(root) = self.schema.root() else {
            return;
        };
        self.table(root, "", branch, &Origin::Default);
        for table in self.schema.children(root) {
            if table.occurrence == Occurrence::Always && branch.get(table.pattern).is_none() {
                self.table(table, table.pattern, &Branch::default(), &Origin::Default);
            }
        }
        for namespace in self.schema.namespaces {
            self.unique_names(namespace, branch);
        }
    }

    /// Names are unique over all groups of a namespace, and some are reserved.
    fn unique_names(&mut self, namespace: &Namespace, root: &Branch) {
        let mut seen: Vec<(&str, &str, &TreeEntry)> = Vec::new();
        for group in namespace.groups {
            let Some(Raw::Branch(branch)) = root.get(group).map(|node| &node.raw) else {
                continue;
            };
            seen.extend(branch.entries.iter().map(|entry| (entry.key.as_str(), *group, entry)));
        }
        seen.sort_by(|a, b| a.0.cmp(b.0));
        for twins in seen.windows(2) {
            if let [(name, group_1, twig_1), (other, group_2, twig_2)] = twins
                && name == other
            {
                if self.is_full() {
                    return;
                }
                let line = match &twig_1.key_origin {
                    Origin::File(span) => {
                        format!(" on line {}", self.judge.source.position(span.start).0)
                    }
                    _ => String::new(),
                };
                let rule = format!("the name `{name}` is already used by {group_1}.{name}{line}");
                let found = self.judge.source.error(&twig_2.key_origin, &format!("{group_2}.{name}"), rule);
                let groups: Vec<String> = namespace.groups.iter().map(|group| format!("{group}s")).collect();
                self.judge.push(found).remedy =
                    Some(format!("use a different name: names must be unique over {}", groups.join(" and ")));
                self.document.refuse(group_2);
            }
        }
        for (name, group, entry) in seen.iter().filter(|(name, ..)| namespace.taken.contains(name)) {
            let rule = format!("the name `{name}` is reserved for the {name}");
            let found = self.judge.source.error(&entry.key_origin, &format!("{group}.{name}"), rule);
            self.judge.push(found);
        }
    }

    fn table(&mut self, table: &'static TableSchema, path: &str, branch: &Branch, origin: &Origin) {
        if !path.is_empty() {
            self.document.add_table(path, origin.clone());
        }
        for entry in &branch.entries {
            if self.is_full() {
                return;
            }
            let inner = join(path, &entry.key);
            if let Some(key) = table.key(&entry.key) {
                self.key(table, key, &inner, entry);
            } else if let Some(child) = self.schema.children(table).find(|child| child.name() == entry.key) {
                if child.occurrence == Occurrence::Named {
                    self.group(child, &inner, &entry.node);
                } else if let Some(branch) = self.branch_of(child, &inner, &entry.node) {
                    self.table(child, &inner, branch, &entry.node.origin);
                }
            } else {
                self.unknown(table, path, &inner, entry);
            }
        }
        self.absent(table, path, branch, origin);
    }

    fn key(&mut self, table: &TableSchema, key: &'static Key, path: &str, entry: &TreeEntry) {
        if key.presence == Presence::NotYet {
            let found = self.judge.blame(&entry.node, path, "not implemented yet");
            let allowed = self.schema.allowed(table);
            found.remedy = Some(match allowed.as_slice() {
                [] => "leave it out".to_owned(),
                built_in => format!("leave it out; available: {}", built_in.join(", ")),
            });
            return;
        }
        if let (Some(word), Raw::Text(text)) = (key.left_out_as, &entry.node.raw)
            && text == word
        {
            return;
        }
        if let Some(value) = self.judge.value(key, path, &entry.node) {
            let entry = Entry { key, value, origin: entry.node.origin.clone(), written: entry.node.written.clone() };
            self.document.add(path, entry);
        } else {
            self.document.refuse(path);
        }
    }

    /// The tables of a group, one for each name.
    fn group(&mut self, table: &'static TableSchema, path: &str, node: &Node) {
        let Some(group) = self.branch_of(table, path, node) else {
            return;
        };
        for entry in &group.entries {
            if self.is_full() {
                return;
            }
            let inner = join(path, &entry.key);
            if let Raw::Branch(branch) = &entry.node.raw {
                if let Some(rule) = name_rule(&entry.key) {
                    let found = self.judge.source.error(&entry.key_origin, &inner, rule);
                    self.judge.push(found);
                    self.document.refuse(path);
                } else {
                    self.document.add_name(path, &entry.key);
                }
                self.table(table, &inner, branch, &entry.node.origin);
            } else {
                // `[beam]` with the keys directly below it: report it once.
                self.document.refuse(path);
                let rule = format!("each {} has a name and a table of its own", table.name());
                self.judge.blame(&entry.node, &inner, rule).remedy =
                    Some(format!("write its keys under [{path}.NAME]"));
                return;
            }
        }
    }

    fn branch_of<'n>(&mut self, table: &TableSchema, path: &str, node: &'n Node) -> Option<&'n Branch> {
        if let Raw::Branch(branch) = &node.raw {
            return Some(branch);
        }
        self.document.refuse(path);
        let rule = format!("a table is expected, got {}", node.raw.what());
        let remedy = match table.occurrence {
            Occurrence::Named => format!("write its keys under [{path}.NAME]"),
            Occurrence::Inline => {
                let elsewhere = table.keys.iter().map(|key| key.elsewhere).find(|text| !text.is_empty());
                let elsewhere = elsewhere.map(|text| format!("; {text}")).unwrap_or_default();
                format!("write {} = {{ … }} with {}{elsewhere}", table.name(), self.schema.allowed(table).join(", "))
            }
            _ => format!("write its keys under [{path}]"),
        };
        self.judge.blame(node, path, rule).remedy = Some(remedy);
        None
    }

    fn unknown(&mut self, table: &TableSchema, path: &str, inner: &str, entry: &TreeEntry) {
        let allowed = self.schema.allowed(table);
        let mut found = self.judge.source.error(&entry.key_origin, inner, "unknown key");
        found.did_you_mean = suggest::nearest(&entry.key, allowed.iter().copied()).map(str::to_owned);
        let place = match path {
            "" => format!("at the top of {}", self.schema.a_document()),
            path => format!("in [{}]", printable(path)),
        };
        if let Some(meant) = &found.did_you_mean {
            // The key that was probably meant is not reported as missing too.
            self.document.refuse(&join(path, meant));
        }
        let mut remedy = format!("the keys allowed {place} are {}", allowed.join(", "));
        let elsewhere = self.schema.table_with(&entry.key);
        if let Some(other) = elsewhere
            && found.did_you_mean.is_none()
        {
            let name = match other.pattern {
                "" => format!("the top of the {}", self.schema.noun),
                pattern => format!("[{}]", pattern.replace('*', "NAME")),
            };
            remedy.push_str(&format!("; {} is a key of {name}", entry.key));
        }
        found.remedy = Some(remedy);
        self.judge.push(found);
    }

    /// Defaults of absent keys, and messages for absent required keys.
    fn absent(&mut self, table: &'static TableSchema, path: &str, branch: &Branch, origin: &Origin) {
        let mut required = Vec::new();
        // First those that others depend on.
        let (free, bound): (Vec<&Key>, Vec<&Key>) = table.keys.iter().partition(|key| key.only_with.is_none());
        for key in free.into_iter().chain(bound) {
            let meant = self.has_meaning(key, path);
            if let Some(node) = branch.get(key.name) {
                if meant == Some(false) {
                    self.without_meaning(key, path, node);
                }
                continue;
            }
            if meant != Some(true) {
                continue;
            }
            match key.presence {
                Presence::Required
                | Presence::RequiredWith(_)
                | Presence::RequiredWithout(_)
                | Presence::RequiredWithoutAny(_)
                    if self.document.is_refused(&join(path, key.name)) => {}
                Presence::Required => required.push(key),
                Presence::RequiredWith(words) if self.goes_with(key, words, path) => required.push(key),
                Presence::RequiredWithout(sibling) if branch.get(sibling).is_none() => required.push(key),
                Presence::RequiredWithoutAny(others) if others.iter().all(|other| branch.get(other).is_none()) => {
                    required.push(key);
                }
                Presence::Default(text) => self.default(key, text, path),
                Presence::DefaultWithout { sibling, value } if branch.get(sibling).is_none() => {
                    self.default(key, value, path);
                }
                Presence::DefaultWith { sibling, value } if branch.get(sibling).is_some() => {
                    self.default(key, value, path);
                }
                _ => {}
            }
        }
        if required.is_empty() || self.document.is_refused(path) {
            return;
        }
        // In the order of the table.
        required.sort_by_key(|key| table.keys.iter().position(|of| std::ptr::eq(of, *key)));
        let names: Vec<&str> = required.iter().map(|key| key.name).collect();
        let names = names.join(", ");
        match origin {
            Origin::Default => {
                let rule = format!("the table [{path}] is missing");
                self.missing.push(self.judge.source.error(origin, path, rule).with_remedy(format!("add {names}")));
            }
            // Created by a --set, and incomplete: most likely a misspelt name.
            Origin::Set { .. } if table.occurrence == Occurrence::Named => {
                let rule = format!("this table is not in the file, and as a new table it lacks {names}");
                let (group, name) = path.rsplit_once('.').unwrap_or(("", path));
                let known = self.document.names(group);
                let near = suggest::nearest(name, known);
                let near = near.map(|near| format!("{group}.{near}"));
                self.missing.push(self.judge.source.error(origin, path, rule).with_suggestion(near));
            }
            _ => {
                for key in required {
                    let instead = match key.presence {
                        Presence::RequiredWithoutAny(others) => format!("; or, instead, {}", others.join(", ")),
                        _ => String::new(),
                    };
                    let found = self.judge.source.error(origin, &join(path, key.name), "missing").with_remedy(format!(
                        "{}: {}{instead}",
                        expected(key),
                        uncapitalised(key.doc.trim_end_matches('.'))
                    ));
                    self.missing.push(found);
                }
            }
        }
    }

    /// Whether a key applies, given the others of its table; `None` if that is unknown.
    fn has_meaning(&self, key: &Key, path: &str) -> Option<bool> {
        let Some(OnlyWith { sibling, words }) = key.only_with else { return Some(true) };
        self.document.text(&join(path, sibling)).map(|word| words.contains(&word))
    }

    /// Whether the key that `key` goes with has one of these words.
    fn goes_with(&self, key: &Key, words: &[&str], path: &str) -> bool {
        let word = key.only_with.and_then(|only| self.document.text(&join(path, only.sibling)));
        word.is_some_and(|word| words.contains(&word))
    }

    fn without_meaning(&mut self, key: &Key, path: &str, node: &Node) {
        let Some(OnlyWith { sibling, words }) = key.only_with else { return };
        let word = self.document.text(&join(path, sibling)).unwrap_or_default();
        let rule = format!("{} has no meaning with {sibling} = {word}", key.name);
        let path = join(path, key.name);
        self.judge.blame(node, &path, rule).remedy =
            Some(format!("leave it out; it goes with {sibling} = {}", words.join(", ")));
        self.document.refuse(&path);
    }

    fn default(&mut self, key: &'static Key, text: &str, path: &str) {
        let path = join(path, key.name);
        let node = lenient_value(text, Origin::Default);
        if let Some(value) = self.judge.value(key, &path, &node) {
            let entry = Entry { key, value, origin: Origin::Default, written: node.written };
            self.document.add(&path, entry);
        }
    }
}
