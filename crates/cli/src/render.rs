//! Shows findings about a scene in the style of rustc: the line of the file, the position
//! underlined, the rule beside it, the remedy below.

use crate::console::clean;
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use std::io::IsTerminal;
use std::ops::Range;
use teeter_run::LoadError;
use teeter_scenario::diagnostic::{Diagnostic, Diagnostics, MOST_PRINTED, Severity};

/// The messages about a scene that can't be loaded.
pub(crate) fn refusal(error: &LoadError) -> String {
    match error {
        LoadError::Invalid { text, found } => Presenter::new(text).all(found),
        error => format!("error: {error}"),
    }
}

/// Shows findings about one scene.
#[derive(Debug)]
pub(crate) struct Presenter<'a> {
    source: &'a str,
    renderer: Renderer,
}

impl<'a> Presenter<'a> {
    /// For findings whose spans refer to `source`, with colours if standard error is a terminal.
    pub(crate) fn new(source: &'a str) -> Self {
        Self::with_colours(source, wants_colours())
    }

    fn with_colours(source: &'a str, colours: bool) -> Self {
        let renderer = if colours { Renderer::styled() } else { Renderer::plain() };
        // Lines are cut here, where the relevant position is known.
        Self { source, renderer: renderer.term_width(usize::MAX / 4) }
    }

    /// All findings, one after the other.
    pub(crate) fn all(&self, findings: &Diagnostics) -> String {
        let mut shown: Vec<String> = findings.iter().take(MOST_PRINTED).map(|found| self.one(found)).collect();
        shown.extend(findings.rest());
        shown.join("\n\n")
    }

    /// A single finding.
    pub(crate) fn one(&self, found: &Diagnostic) -> String {
        let level = match found.severity {
            Severity::Warning => Level::WARNING,
            Severity::Note => Level::NOTE,
            _ => Level::ERROR,
        };
        let excerpt = self.excerpt(found);
        // With a value, the title reads as in the file and the rule is beside the value; otherwise
        // the rule is part of the title.
        let path = cut(&found.path, PATH);
        let (title, label) = match (&found.written, &excerpt) {
            _ if path.is_empty() => (found.rule.clone(), None),
            (Some(written), Some(_)) => (format!("{path} = {written}"), Some(found.rule.clone())),
            (Some(written), None) => (format!("{path} = {written}: {}", found.rule), None),
            (None, _) => (format!("{path}: {}", found.rule), None),
        };
        let mut group = Group::with_title(level.primary_title(clean(&title, "")));
        let file = clean(&found.file, "");
        let Excerpt { text, span, is_cut } = excerpt.unwrap_or_default();
        let snippet = |text| {
            Snippet::source(text)
                .line_start(found.position.map_or(1, |(line, _)| line))
                .annotation(AnnotationKind::Primary.span(span).label(label.map(|label| clean(&label, ""))))
        };
        group = match (&found.set, found.position) {
            (Some(_), _) => group
                .element(snippet(text).line_numbering(false))
                .element(Level::NOTE.message(format!("set on the command line, for {file}"))),
            // The column in the whole line; the snippet would use the excerpt.
            (None, Some((line, column))) if is_cut => {
                group.element(Origin::path(file).line(line).char_column(column)).element(snippet(text))
            }
            (None, Some(_)) => group.element(snippet(text).path(file)),
            (None, None) => group.element(Origin::path(file)),
        };
        if let Some(word) = &found.did_you_mean {
            group = group.element(Level::HELP.message(format!("did you mean `{}`?", clean(word, ""))));
        }
        if let Some(remedy) = &found.remedy {
            group = group.element(Level::HELP.message(clean(remedy, "")));
        }
        self.renderer.render(&[group])
    }

    /// The line of a finding, and its position in it.
    fn excerpt(&self, found: &Diagnostic) -> Option<Excerpt> {
        if let Some(set) = &found.set {
            let line = format!("{} {set}", found.option);
            // In a setting either the value or the key is wrong.
            let equals = line.find('=').unwrap_or(line.len());
            let span = if found.written.is_some() {
                (equals + 1).min(line.len())..line.len()
            } else {
                found.option.len() + 1..equals
            };
            return Some(Excerpt::new(&line, span));
        }
        let span = found.span.clone()?;
        self.source.get(span.clone())?;
        let start = self.source[..span.start].rfind('\n').map_or(0, |at| at + 1);
        let end = self.source[span.start..].find('\n').map_or(self.source.len(), |at| span.start + at);
        let line = &self.source[start..end];
        Some(Excerpt::new(line, span.start - start..span.end.min(end) - start))
    }
}

/// An excerpt of a line around a position, without characters that control the terminal.
#[derive(Default)]
struct Excerpt {
    text: String,
    span: Range<usize>,
    /// Whether its start is missing.
    is_cut: bool,
}

/// Characters of a line that are shown before, in and after the position.
const BEFORE: usize = 48;
const WITHIN: usize = 60;
const AFTER: usize = 60;
/// Characters of a key's path.
const PATH: usize = 120;

impl Excerpt {
    fn new(line: &str, span: Range<usize>) -> Self {
        let line_end = line.trim_end_matches('\r').len();
        let span = span.start.min(line_end)..span.end.min(line_end);
        let (before, within, after) = (&line[..span.start], &line[span.clone()], &line[span.end..line_end]);
        let before = before.trim_start_matches('\u{feff}');
        let skipped = before.char_indices().rev().nth(BEFORE - 1).map_or(0, |(at, _)| at);
        let mut text = String::new();
        if skipped > 0 {
            text.push('…');
        }
        text.push_str(&clean(&before[skipped..], "\t"));
        let start = text.len();
        text.push_str(&clean(&cut(within, WITHIN), "\t"));
        let end = text.len();
        // Text after a shortened position is left out.
        if within.chars().nth(WITHIN).is_none() {
            text.push_str(&clean(&cut(after, AFTER), "\t"));
        }
        Self { text, span: start..end, is_cut: skipped > 0 }
    }
}

/// The first characters of a text.
fn cut(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((at, _)) => format!("{}…", &text[..at]),
        None => text.to_owned(),
    }
}

/// The custom of <https://no-color.org>.
fn wants_colours() -> bool {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    std::io::stderr().is_terminal() && set("NO_COLOR").is_none() && set("TERM").is_none_or(|term| term != "dumb")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(line: &str, span: Range<usize>) -> (String, String) {
        let Excerpt { text, span, .. } = Excerpt::new(line, span);
        let place = text[span].to_owned();
        (text, place)
    }

    #[test]
    fn a_short_line_is_shown_whole() {
        assert_eq!(shown("a = 1 # µ\r", 4..5), ("a = 1 # µ".to_owned(), "1".to_owned()));
        assert_eq!(shown("\u{feff}a = 1", 3..4), ("a = 1".to_owned(), "a".to_owned()));
        assert_eq!(shown("", 0..0).1, "");
    }

    #[test]
    fn a_long_line_is_cut_around_the_place() {
        let line = format!("{}WRONG{}", "µ".repeat(100_000), "z".repeat(100_000));
        let (text, place) = shown(&line, 200_000..200_005);
        assert_eq!(place, "WRONG");
        assert!(text.starts_with("…µ") && text.ends_with("z…"));
        assert_eq!(text.chars().count(), 1 + BEFORE + 5 + AFTER + 1);
        let (text, place) = shown(&"k".repeat(1_000_000), 0..1_000_000);
        assert_eq!((text.chars().count(), place.chars().count()), (WITHIN + 1, WITHIN + 1));
    }

    #[test]
    fn nothing_in_a_scene_steers_the_terminal() {
        let source = "[time]\nend = \"\u{1b}[2J\u{9b}2\u{202e}\"\n";
        let found = Diagnostic::error("a.toml", "bell \u{7}").with_remedy("\u{1b}c");
        let mut placed = found.clone();
        (placed.span, placed.position) = (Some(13..24), Some((2, 7)));
        placed.path = "time.\u{1b}".to_owned();
        placed.written = Some("\u{1b}".to_owned());
        let mut set = found.clone();
        set.set = Some("k\u{1b}=\u{7}\nv".to_owned());
        for finding in [found, placed, set] {
            let text = Presenter::with_colours(source, false).one(&finding);
            assert!(!text.contains(|c: char| (c.is_control() && c != '\n') || c == '\u{202e}'), "{text:?}");
        }
    }

    #[test]
    fn colours_are_those_of_the_severity() {
        let found = Diagnostic::error("a.toml", "no");
        assert!(Presenter::with_colours("", true).one(&found).contains("\u{1b}["));
        assert!(!Presenter::with_colours("", false).one(&found).contains('\u{1b}'));
    }
}
