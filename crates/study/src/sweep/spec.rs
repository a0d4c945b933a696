//! The tree of a TOML file, such as a sweep file, with findings that point into it.

use std::ops::Range;
use teeter_scenario::diagnostic::{Diagnostic, Diagnostics};
use teeter_scenario::suggest::nearest;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The text of a file and what was found wrong in it.
pub(crate) struct Reader<'a> {
    pub(crate) file: &'a str,
    pub(crate) text: &'a str,
    pub(crate) found: Diagnostics,
}

/// A value with its place and its name, such as `grid.time.step`.
#[derive(Clone, Copy)]
pub(crate) struct Node<'a, 't> {
    pub(crate) value: &'a DeValue<'t>,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

impl<'a, 't> Node<'a, 't> {
    pub(crate) fn of(value: &'a Spanned<DeValue<'t>>) -> Self {
        let span = value.span();
        Self { value: value.get_ref(), start: span.start, end: span.end }
    }

    fn span(&self) -> Range<usize> {
        self.start..self.end
    }

    pub(crate) fn table(&self) -> Option<&'a DeTable<'t>> {
        match self.value {
            DeValue::Table(table) => Some(table),
            _ => None,
        }
    }

    pub(crate) fn array(&self) -> Option<Vec<Node<'a, 't>>> {
        match self.value {
            DeValue::Array(items) => Some(items.iter().map(Node::of).collect()),
            _ => None,
        }
    }

    pub(crate) fn text(&self) -> Option<&'a str> {
        match self.value {
            DeValue::String(text) => Some(text),
            _ => None,
        }
    }

    pub(crate) fn whole(&self) -> Option<u64> {
        match self.value {
            DeValue::Integer(digits) => u64::from_str_radix(digits.as_str(), digits.radix()).ok(),
            _ => None,
        }
    }
}

/// The entries of a table in the order of the file.
pub(crate) fn entries<'a, 't>(table: &'a DeTable<'t>) -> Vec<(&'a str, Node<'a, 't>)> {
    let mut all: Vec<_> =
        table.iter().map(|(key, value)| (key.span().start, key.get_ref().as_ref(), Node::of(value))).collect();
    all.sort_by_key(|(start, ..)| *start);
    all.into_iter().map(|(_, key, node)| (key, node)).collect()
}

/// The entry that a path names: one of the file, such as `fragility.intensity`, or the last that varies or searches this key of the scene.
fn named<'a, 't>(root: &'a DeTable<'t>, path: &str) -> Option<Node<'a, 't>> {
    let varied = ["grid", "zip", "random"].map(|table| at(root, table).and_then(|node| at(node.table()?, path)));
    let searched = at(root, "find.key").filter(|node| node.text().is_some_and(|key| key.trim() == path));
    varied.into_iter().chain([at(root, path), searched]).flatten().max_by_key(|node| node.start)
}

/// The entry of a table at a path, whose parts may be keys of their own or stand in one quoted key.
fn at<'a, 't>(table: &'a DeTable<'t>, path: &str) -> Option<Node<'a, 't>> {
    entries(table).into_iter().find_map(|(name, node)| match path.strip_prefix(name)? {
        "" => Some(node),
        rest => at(node.table()?, rest.strip_prefix('.')?),
    })
}

impl<'a> Reader<'a> {
    pub(crate) fn new(file: &'a str, text: &'a str) -> Self {
        Self { file, text, found: Diagnostics::default() }
    }

    /// The root of the tree.
    ///
    /// # Errors
    /// Where the text isn't TOML.
    pub(crate) fn root(&self) -> Result<Spanned<DeTable<'a>>, Diagnostics> {
        DeTable::parse(self.text).map_err(|error| {
            let mut finding = Diagnostic::error(self.file, format!("not valid TOML: {}", error.message()));
            if let Some(span) = error.span() {
                self.place(&mut finding, span);
            }
            finding.into()
        })
    }

    /// The text of a value as it is written.
    pub(crate) fn written(&self, node: &Node<'_, '_>) -> &'a str {
        self.text.get(node.span()).unwrap_or_default()
    }

    /// The value as `--set` takes it: a string by its content, anything else as written.
    pub(crate) fn setting(&self, node: &Node<'_, '_>) -> String {
        node.text().map_or_else(|| self.written(node).to_owned(), str::to_owned)
    }

    /// Adds a finding about a value.
    pub(crate) fn wrong(&mut self, path: &str, node: Option<&Node<'_, '_>>, rule: &str, remedy: &str) {
        let mut finding = Diagnostic::error(self.file, rule).with_remedy(remedy);
        finding.path = path.to_owned();
        if let Some(node) = node {
            self.point(&mut finding, node);
        }
        self.found.0.push(finding);
    }

    /// Gives a finding the place and the text of a value.
    fn point(&self, finding: &mut Diagnostic, node: &Node<'_, '_>) {
        let written = self.written(node);
        let short = written.len() <= 60 && !written.contains('\n');
        finding.written = (short && node.table().is_none()).then(|| written.to_owned());
        self.place(finding, node.span());
    }

    /// Adds a finding about a key that isn't known.
    pub(crate) fn unknown(&mut self, path: &str, node: &Node<'_, '_>, name: &str, known: &[&str]) {
        let rule = format!("unknown key; here are allowed: {}", known.join(", "));
        let mut finding = Diagnostic::error(self.file, rule).with_suggestion(nearest(name, known.iter().copied()));
        finding.path = path.to_owned();
        self.place(&mut finding, node.span());
        self.found.0.push(finding);
    }

    pub(crate) fn place(&self, finding: &mut Diagnostic, span: Range<usize>) {
        let before = self.text.get(..span.start).unwrap_or_default();
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        finding.position = Some((line, column));
        finding.span = Some(span);
    }

    /// The findings, in the order of the file; those without a place get that of the entry of `root` that their path names.
    pub(crate) fn placed_in(mut self, root: &DeTable<'_>) -> Diagnostics {
        let mut found = std::mem::take(&mut self.found);
        for finding in found.0.iter_mut().filter(|finding| finding.position.is_none()) {
            if let Some(node) = named(root, &finding.path) {
                self.point(finding, &node);
            }
        }
        found.sort();
        found
    }

    /// The findings, in the order of the file.
    pub(crate) fn into_findings(mut self) -> Diagnostics {
        self.found.sort();
        self.found
    }
}
