//! From the text of a file to a [`Document`]: the whole file against the tables of a schema, all
//! errors at once.

use crate::diagnostic::MOST_FINDINGS;
use crate::diagnostic::{Diagnostic, Diagnostics, printable};
use crate::document::{Document, Entry};
use crate::judge::{Judge, name_rule};
use crate::keys::{Key, Occurrence, OnlyWith, Presence, Table};
use crate::schema::{Namespace, Schema};
use crate::sets::setting;
use crate::source::{Origin, Source};
use crate::tree::{Branch, Node, Raw, Twig, lenient_value};
use crate::wording::expected;

pub use crate::syntax::LARGEST_FILE;
use crate::{sets, suggest, syntax};

/// Reads a document. `file` is its name for messages; each of `sets` is a key's path and a value
/// that take precedence over the file.
///
/// The text may start with a byte order mark and may have Windows line ends. The value of a setting
/// is taken as TOML if it is TOML, else as a text: `("time.step", "50 us")` needs no inner quotes.
///
/// An example is at [`Schema`].
///
/// # Errors
/// All that is wrong in the file and the settings, in the order of the file (of a hopeless file,
/// the first hundreds).
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
    /// What is wrong, in order.
    pub found: Diagnostics,
    /// Whether every table of the file is in the document, so that what takes several keys can be
    /// judged as well.
    pub whole: bool,
}

/// Reads a document as [`parse`] does, going on after errors.
pub fn decode(schema: &'static Schema, source: &str, file: &str, sets: &[(String, String)]) -> Decoded {
    let source = Source::new(file, source);
    let syntax::Parsed { mut root, errors, bad_lines, complete } = syntax::read(schema, &source);
    let mut found = Diagnostics(errors);
    found.0.extend(sets::apply(schema, &mut root, sets, &source));
    if root.twigs.is_empty() && found.0.is_empty() {
        let mut empty = Diagnostic::error(file, format!("the file holds no {}: it is empty", schema.noun));
        empty.remedy = schema.advice.empty.map(str::to_owned);
        return Decoded { document: Document::new(schema, source, sets), found: empty.into(), whole: false };
    }
    let mut walk = Walk {
        schema,
        judge: Judge { schema, source: &source, findings: Vec::new() },
        missing: Vec::new(),
        document: Document::new(schema, source.clone(), sets),
    };
    walk.root(&root);
    let whole = complete && !walk.is_full();
    let Walk { judge, missing, document, .. } = walk;
    // What was recovered from a broken line has its message already; and what seems to be missing
    // may stand in it.
    found.0.extend(judge.findings.into_iter().filter(|finding| {
        let place = finding.span.as_ref().map(|span| source.line(span.start));
        place.is_none_or(|line| !bad_lines.contains(&line))
    }));
    if complete {
        found.0.extend(missing.into_iter().map(|finding| used_by(schema, finding, &document)));
    }
    in_order(&mut found, sets);
    Decoded { document, found, whole }
}

/// Sorts findings as they are told: by their place in the file, then those about settings in the
/// order of the settings.
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

/// Says of a key that is missing in a table which others refer to it.
fn used_by(schema: &Schema, mut finding: Diagnostic, document: &Document) -> Diagnostic {
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

/// The walk over the tree beside the table of keys.
struct Walk<'a> {
    schema: &'static Schema,
    judge: Judge<'a>,
    /// Kept apart: not to be told where a syntax error may have swallowed the key.
    missing: Vec<Diagnostic>,
    document: Document,
}

/// A path one step longer; quoted where the key is no bare one.
fn join(path: &str, key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-');
    match (path, bare) {
        ("", true) => key.to_owned(),
        ("", false) => format!("{key:?}"),
        (path, true) => format!("{path}.{key}"),
        (path, false) => format!("{path}.{key:?}"),
    }
}

impl Walk<'_> {
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

    /// Names are unique over all groups of a namespace, and some are taken.
    fn unique_names(&mut self, namespace: &Namespace, root: &Branch) {
        let mut seen: Vec<(&str, &str, &Twig)> = Vec::new();
        for group in namespace.groups {
            let Some(Raw::Branch(branch)) = root.get(group).map(|node| &node.raw) else {
                continue;
            };
            seen.extend(branch.twigs.iter().map(|twig| (twig.key.as_str(), *group, twig)));
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
                let rule = format!("the name `{name}` is taken by {group_1}.{name}{line}");
                let found = self.judge.source.error(&twig_2.key_origin, &format!("{group_2}.{name}"), rule);
                let groups: Vec<String> = namespace.groups.iter().map(|group| format!("{group}s")).collect();
                self.judge.push(found).remedy = Some(format!("names are unique over {}", groups.join(" and ")));
                self.document.refuse(group_2);
            }
        }
        for (name, group, twig) in seen.iter().filter(|(name, ..)| namespace.taken.contains(name)) {
            let rule = format!("the name `{name}` is taken by the {name}");
            let found = self.judge.source.error(&twig.key_origin, &format!("{group}.{name}"), rule);
            self.judge.push(found);
        }
    }

    fn table(&mut self, table: &'static Table, path: &str, branch: &Branch, origin: &Origin) {
        if !path.is_empty() {
            self.document.add_table(path, origin.clone());
        }
        for twig in &branch.twigs {
            if self.is_full() {
                return;
            }
            let inner = join(path, &twig.key);
            if let Some(key) = table.key(&twig.key) {
                self.key(table, key, &inner, twig);
            } else if let Some(child) = self.schema.children(table).find(|child| child.name() == twig.key) {
                if child.occurrence == Occurrence::Named {
                    self.group(child, &inner, &twig.node);
                } else if let Some(branch) = self.branch_of(child, &inner, &twig.node) {
                    self.table(child, &inner, branch, &twig.node.origin);
                }
            } else {
                self.unknown(table, path, &inner, twig);
            }
        }
        self.absent(table, path, branch, origin);
    }

    fn key(&mut self, table: &Table, key: &'static Key, path: &str, twig: &Twig) {
        if key.presence == Presence::NotYet {
            let found = self.judge.blame(&twig.node, path, "known, but not built in yet");
            let allowed = self.schema.allowed(table);
            found.remedy = Some(match allowed.as_slice() {
                [] => "leave it out".to_owned(),
                built_in => format!("leave it out; built in: {}", built_in.join(", ")),
            });
            return;
        }
        if let (Some(word), Raw::Text(text)) = (key.left_out_as, &twig.node.raw)
            && text == word
        {
            return;
        }
        if let Some(value) = self.judge.value(key, path, &twig.node) {
            let entry = Entry { key, value, origin: twig.node.origin.clone(), written: twig.node.written.clone() };
            self.document.add(path, entry);
        } else {
            self.document.refuse(path);
        }
    }

    /// The tables of a group, one for each name.
    fn group(&mut self, table: &'static Table, path: &str, node: &Node) {
        let Some(group) = self.branch_of(table, path, node) else {
            return;
        };
        for twig in &group.twigs {
            if self.is_full() {
                return;
            }
            let inner = join(path, &twig.key);
            if let Raw::Branch(branch) = &twig.node.raw {
                if let Some(rule) = name_rule(&twig.key) {
                    let found = self.judge.source.error(&twig.key_origin, &inner, rule);
                    self.judge.push(found);
                    self.document.refuse(path);
                } else {
                    self.document.add_name(path, &twig.key);
                }
                self.table(table, &inner, branch, &twig.node.origin);
            } else {
                // `[beam]` with the keys right below it: say so once.
                self.document.refuse(path);
                let rule = format!("each {} has a name and a table of its own", table.name());
                self.judge.blame(&twig.node, &inner, rule).remedy = Some(format!("write its keys under [{path}.NAME]"));
                return;
            }
        }
    }

    fn branch_of<'n>(&mut self, table: &Table, path: &str, node: &'n Node) -> Option<&'n Branch> {
        if let Raw::Branch(branch) = &node.raw {
            return Some(branch);
        }
        self.document.refuse(path);
        let rule = format!("a table is expected, got {}", node.raw.what());
        let remedy = match table.occurrence {
            Occurrence::Named => format!("write its keys under [{path}.NAME]"),
            Occurrence::Inline => {
                format!("write {} = {{ … }} with {}", table.name(), self.schema.allowed(table).join(", "))
            }
            _ => format!("write its keys under [{path}]"),
        };
        self.judge.blame(node, path, rule).remedy = Some(remedy);
        None
    }

    fn unknown(&mut self, table: &Table, path: &str, inner: &str, twig: &Twig) {
        let allowed = self.schema.allowed(table);
        let mut found = self.judge.source.error(&twig.key_origin, inner, "unknown key");
        found.did_you_mean = suggest::nearest(&twig.key, allowed.iter().copied()).map(str::to_owned);
        let place = match path {
            "" => format!("at the top of {}", self.schema.a_document()),
            path => format!("in [{}]", printable(path)),
        };
        if let Some(meant) = &found.did_you_mean {
            // What was meant is not missing as well.
            self.document.refuse(&join(path, meant));
        }
        let mut remedy = format!("the keys allowed {place} are {}", allowed.join(", "));
        let elsewhere = self.schema.table_with(&twig.key);
        if let Some(other) = elsewhere
            && found.did_you_mean.is_none()
        {
            let name = match other.pattern {
                "" => format!("the top of the {}", self.schema.noun),
                pattern => format!("[{}]", pattern.replace('*', "NAME")),
            };
            remedy.push_str(&format!("; {} is a key of {name}", twig.key));
        }
        found.remedy = Some(remedy);
        self.judge.push(found);
    }

    /// Defaults of the keys that are not there, and messages for those that must be.
    fn absent(&mut self, table: &'static Table, path: &str, branch: &Branch, origin: &Origin) {
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
                Presence::Required | Presence::RequiredWith(_) | Presence::RequiredWithout(_)
                    if self.document.is_refused(&join(path, key.name)) => {}
                Presence::Required => required.push(key),
                Presence::RequiredWith(words) if self.goes_with(key, words, path) => required.push(key),
                Presence::RequiredWithout(sibling) if branch.get(sibling).is_none() => required.push(key),
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
                self.missing
                    .push(self.judge.source.error(origin, path, rule).with_remedy(format!("it must give {names}")));
            }
            // Made by a --set, and not whole: most likely a slip in the name.
            Origin::Set { .. } if table.occurrence == Occurrence::Named => {
                let rule = format!("not in the file, and as a new table it lacks {names}");
                let (group, name) = path.rsplit_once('.').unwrap_or(("", path));
                let known = self.document.names(group);
                let near = suggest::nearest(name, known);
                let near = near.map(|near| format!("{group}.{near}"));
                self.missing.push(self.judge.source.error(origin, path, rule).with_suggestion(near));
            }
            _ => {
                for key in required {
                    let found = self.judge.source.error(origin, &join(path, key.name), "missing").with_remedy(format!(
                        "{}: {}",
                        expected(key),
                        uncapitalised(key.doc.trim_end_matches('.'))
                    ));
                    self.missing.push(found);
                }
            }
        }
    }

    /// Whether a key has a meaning beside the others of its table; `None` where that can't be said.
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
