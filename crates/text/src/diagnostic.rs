//! Findings about a file: what is wrong, where, and how to correct it.

use std::fmt;
use std::ops::Range;

/// Severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Severity {
    /// The file cannot be used.
    Error,
    /// The file can be used, but probably doesn't say what was meant.
    Warning,
    /// Information; nothing is wrong.
    Note,
}

/// One finding about a file.
///
/// Printed as
/// ```text
/// error: scene.toml:12:13: beam.table.thickness = "-0.0015 m": must be greater than 0 m
///   help: a length with its unit, such as "1.5 mm"
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// Error, warning or note.
    pub severity: Severity,
    /// The file's name as given.
    pub file: String,
    /// Line and column (both from 1; the column in characters), if the finding has a position in
    /// the file.
    pub position: Option<(usize, usize)>,
    /// Range of bytes of the source that it concerns.
    pub span: Option<Range<usize>>,
    /// `KEY=VALUE`, if it concerns an option of the command line instead of the file.
    pub set: Option<String>,
    /// That option: `--set`, or what the user wrote instead.
    pub option: &'static str,
    /// Full path of the key, such as `beam.table.thickness`; empty if it concerns no key.
    pub path: String,
    /// The value as written, shortened if long.
    pub written: Option<String>,
    /// The violated rule.
    pub rule: String,
    /// How to correct it.
    pub remedy: Option<String>,
    /// The word that was probably meant.
    pub did_you_mean: Option<String>,
}

impl Diagnostic {
    /// An error about a file as a whole.
    pub fn error(file: &str, rule: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            file: file.to_owned(),
            position: None,
            span: None,
            set: None,
            option: "--set",
            path: String::new(),
            written: None,
            rule: rule.into(),
            remedy: None,
            did_you_mean: None,
        }
    }

    /// The same finding with a remedy.
    #[must_use]
    pub fn with_remedy(mut self, remedy: impl Into<String>) -> Self {
        self.remedy = Some(remedy.into());
        self
    }

    /// The same finding with a suggestion.
    #[must_use]
    pub fn with_suggestion(mut self, word: Option<impl Into<String>>) -> Self {
        self.did_you_mean = word.map(Into::into);
        self
    }

    /// The same finding as a warning.
    #[must_use]
    pub fn as_warning(mut self) -> Self {
        self.severity = Severity::Warning;
        self
    }

    /// The same finding as a note.
    #[must_use]
    pub fn as_note(mut self) -> Self {
        self.severity = Severity::Note;
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.severity {
            Severity::Error => "error: ",
            Severity::Warning => "warning: ",
            Severity::Note => "note: ",
        })?;
        match (&self.set, self.position) {
            (Some(set), _) => write!(f, "{} {}: ", self.option, printable(set))?,
            (None, Some((line, column))) => write!(f, "{}:{line}:{column}: ", self.file)?,
            (None, None) => write!(f, "{}: ", self.file)?,
        }
        if !self.path.is_empty() {
            f.write_str(&printable(&self.path))?;
            if let Some(written) = &self.written {
                write!(f, " = {}", printable(written))?;
            }
            f.write_str(": ")?;
        }
        f.write_str(&escaped(&self.rule))?;
        if let Some(word) = &self.did_you_mean {
            write!(f, "\n  help: did you mean `{}`?", escaped(word))?;
        }
        if let Some(remedy) = &self.remedy {
            write!(f, "\n  help: {}", escaped(remedy))?;
        }
        Ok(())
    }
}

/// All findings about a file, in the order of the file, those about `--set` last.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Diagnostics(pub Vec<Diagnostic>);

/// Largest number of findings that are printed; the rest is counted.
pub const MOST_PRINTED: usize = 50;

/// Number of findings after which reading stops.
pub(crate) const MOST_FINDINGS: usize = 200;

impl Diagnostics {
    /// Sorts by position: findings about the whole file, then by position in it, then those about
    /// `--set` in the order given. What is said twice, as of blocks that a table repeats, stays once.
    pub fn sort(&mut self) {
        let place = |found: &Diagnostic| (found.set.is_some(), found.span.as_ref().map(|s| s.start));
        self.0.sort_by_key(place);
        let mut once: Vec<Diagnostic> = Vec::with_capacity(self.0.len());
        for found in self.0.drain(..) {
            let here = |other: &&Diagnostic| place(other) == place(&found);
            if !once.iter().rev().take_while(here).any(|other| *other == found) {
                once.push(found);
            }
        }
        self.0 = once;
    }

    /// Whether one of them is an error.
    pub fn has_errors(&self) -> bool {
        self.0.iter().any(|found| found.severity == Severity::Error)
    }

    /// A line about the findings beyond [`MOST_PRINTED`]; `None` if there are none. Reading stops
    /// after many findings, so their number may be a lower bound.
    #[must_use]
    pub fn rest(&self) -> Option<String> {
        match self.0.len().saturating_sub(MOST_PRINTED) {
            0 => None,
            more if self.0.len() >= MOST_FINDINGS => Some(format!("… and at least {more} more")),
            more => Some(format!("… and {more} more")),
        }
    }

    /// Iterates over the findings.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.0.iter()
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(found: Diagnostic) -> Self {
        Self(vec![found])
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, found) in self.0.iter().take(MOST_PRINTED).enumerate() {
            if index > 0 {
                f.write_str("\n")?;
            }
            write!(f, "{found}")?;
        }
        self.rest().map_or(Ok(()), |rest| write!(f, "\n{rest}"))
    }
}

impl std::error::Error for Diagnostics {}

/// Longest piece of the user's text quoted in a message, in characters.
const LONGEST_PIECE: usize = 80;

/// A piece of the user's text, safe for a terminal: shortened, control characters escaped.
#[must_use]
pub fn printable(text: &str) -> String {
    match text.char_indices().nth(LONGEST_PIECE) {
        Some((end, _)) => escaped(text.get(..end).unwrap_or_default()) + "…",
        None => escaped(text),
    }
}

/// Whether `c` is a control character, or one that changes the direction of writing: characters
/// that a terminal interprets instead of showing.
#[must_use]
pub fn is_display_control(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || c.is_control()
}

/// Makes such characters visible, so that a file can't control the terminal.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if is_display_control(c) {
            out.extend(c.escape_unicode());
        } else {
            out.push(c);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{Diagnostic, Diagnostics, MOST_FINDINGS, printable};

    #[test]
    fn what_is_found_of_each_copy_is_said_once() {
        let found = |start: usize, rule: &str| {
            let mut found = Diagnostic::error("scene.toml", rule);
            found.span = Some(start..start + 1);
            found
        };
        // Two findings about a table, for each of two copies of it; one of them about another table, too.
        let mut all =
            Diagnostics(vec![found(7, "tall"), found(7, "old"), found(7, "tall"), found(7, "old"), found(3, "tall")]);
        all.sort();
        assert_eq!(all.0, [found(3, "tall"), found(7, "tall"), found(7, "old")]);
    }

    #[test]
    fn a_diagnostic_prints_place_path_value_rule_and_help() {
        let mut found = Diagnostic::error("scene.toml", "must be greater than 0 m")
            .with_remedy("a length with its unit")
            .with_suggestion(Some("thickness"));
        found.position = Some((12, 13));
        found.path = "beam.table.thickness".to_owned();
        found.written = Some("\"-0.0015 m\"".to_owned());
        assert_eq!(
            found.to_string(),
            "error: scene.toml:12:13: beam.table.thickness = \"-0.0015 m\": must be greater than 0 m\n  \
             help: did you mean `thickness`?\n  help: a length with its unit"
        );
        found.set = Some("beam.table.thickness=-0.0015 m".to_owned());
        let text = found.as_warning().to_string();
        assert!(text.starts_with("warning: --set beam.table.thickness=-0.0015 m: beam"));
    }

    #[test]
    fn long_lists_are_cut_and_control_characters_escaped() {
        let many = Diagnostics(vec![Diagnostic::error("f", "x"); 52]);
        assert!(many.to_string().ends_with("\n… and 2 more"));
        let very_many = Diagnostics(vec![Diagnostic::error("f", "x"); MOST_FINDINGS]);
        assert!(very_many.to_string().ends_with("\n… and at least 150 more"));
        assert_eq!(printable("a\u{1b}[0m"), "a\\u{1b}[0m");
        assert_eq!(printable("a\u{202e}b"), "a\\u{202e}b");
        assert_eq!(printable(&"é".repeat(1000)).chars().count(), 81);
    }
}
