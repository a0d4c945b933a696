//! The text of a file: positions in it, and where each value came from.

use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Severity, printable};

/// Where a value came from.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Origin {
    /// The file: bytes of its text.
    File(Range<usize>),
    /// A `--set KEY=VALUE`: its index among them, and its text.
    Set {
        /// Counted from 0 in the order given.
        index: usize,
        /// `KEY=VALUE`.
        text: String,
    },
    /// The default of the table of keys.
    Default,
    /// A default that depends on other values, set by the code that interprets the document.
    Derived,
}

/// A file in memory, shared by all documents that are read from it.
#[derive(Debug, Clone)]
pub(crate) struct SourceText {
    /// As given; for messages.
    pub(crate) file: Arc<str>,
    /// All of it.
    pub(crate) text: Arc<str>,
    /// Byte at which each line starts.
    lines: Arc<[usize]>,
}

const BOM: char = '\u{feff}';

impl SourceText {
    /// A file of this name and text.
    pub(crate) fn new(file: &str, text: &str) -> Self {
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Self { file: file.into(), text: text.into(), lines }
    }

    /// Line of a byte, from 0.
    pub(crate) fn line(&self, at: usize) -> usize {
        self.lines.partition_point(|start| *start <= at).saturating_sub(1)
    }

    /// Bytes of a line, without its end.
    pub(crate) fn line_range(&self, line: usize) -> Range<usize> {
        let start = self.lines.get(line).copied().unwrap_or(self.text.len());
        let end = self.lines.get(line + 1).map_or(self.text.len(), |next| next - 1);
        start..end
    }

    /// The text of a line, without its end.
    pub(crate) fn line_text(&self, line: usize) -> &str {
        let text = self.text.get(self.line_range(line)).unwrap_or_default();
        text.trim_start_matches(BOM).trim_end_matches('\r')
    }

    /// Line and column, both from 1, the column in characters. A byte order mark takes no column.
    pub(crate) fn position(&self, at: usize) -> (usize, usize) {
        let line = self.line(at);
        let start = self.line_range(line).start;
        let before = self.text.get(start..at).unwrap_or_default();
        (line + 1, before.trim_start_matches(BOM).chars().count() + 1)
    }

    /// A piece of the text as written, shortened.
    pub(crate) fn written(&self, span: &Range<usize>) -> String {
        printable(self.text.get(span.clone()).unwrap_or_default())
    }

    /// An error about `path`, placed at `origin`.
    pub(crate) fn error(&self, origin: &Origin, path: &str, rule: impl Into<String>) -> Diagnostic {
        let mut found =
            Diagnostic { severity: Severity::Error, path: path.to_owned(), ..Diagnostic::error(&self.file, rule) };
        match origin {
            Origin::File(span) => {
                found.position = Some(self.position(span.start));
                found.span = Some(span.clone());
            }
            Origin::Set { text, .. } => found.set = Some(text.clone()),
            Origin::Default | Origin::Derived => {}
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::SourceText;

    #[test]
    fn positions_count_characters_and_skip_the_byte_order_mark() {
        let source = SourceText::new("f", "\u{feff}a = 1\r\nµ = \"ü\"\n");
        assert_eq!(source.position(3), (1, 1));
        assert_eq!(source.position(10), (2, 1));
        assert_eq!(source.position(12), (2, 2));
        assert_eq!(source.position(1_000_000), (3, 1));
        assert_eq!(source.line_text(0), "a = 1");
    }
}
