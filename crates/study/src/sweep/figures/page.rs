//! `study.html`: a self-contained page in the style of a run's report.

use super::super::counted;
use super::label::label;
use super::{Ensemble, StudyFigure};
use crate::write::{html_list, html_table};
use std::fmt::Write;
use teeter_plot::escaped;
use teeter_report::document;

const OWN_STYLE: &str = "\
main > section { margin-top: 1.5rem; }\n\
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(26rem, 100%), 1fr)); gap: 1rem; }\n\
li { margin: .3rem 0; overflow-wrap: anywhere; }\ntd:first-child { text-align: left; }\n";

/// The page of the figures of a study, or of several side by side.
#[must_use]
pub fn study_page(title: &str, studies: &[Ensemble], figures: &[StudyFigure]) -> String {
    let told = |study: &Ensemble| {
        let failed = match study.table.incomplete() {
            0 => String::new(),
            some => format!(", {some} without a result"),
        };
        let warned = match study.table.warned() {
            0 => String::new(),
            some => format!(", {some} with warnings"),
        };
        let name = if studies.len() > 1 { format!("{}: ", study.name) } else { String::new() };
        format!("{name}{}{failed}{warned}", counted(study.table.len() as u64))
    };
    let subtitle = studies.iter().map(told).collect::<Vec<_>>().join(" · ");
    let subtitle = format!("{subtitle} · teeter {}", env!("CARGO_PKG_VERSION"));
    let mut html = String::new();
    for study in studies {
        let name = if studies.len() > 1 { format!("{}: ", study.name) } else { String::new() };
        let varied: Vec<String> = study.sweep.keys().into_iter().map(|key| label(&study.sweep, key)).collect();
        let text = format!("{name}{}, varied: {}", study.sweep.scene(), varied.join(", "));
        let _ = writeln!(html, "<p class=\"note\">{}</p>", escaped(&text));
    }
    for figure in figures {
        section(&mut html, figure);
    }
    document(title, &subtitle, OWN_STYLE, &html)
}

fn section(html: &mut String, figure: &StudyFigure) {
    let _ = writeln!(
        html,
        "<section id=\"{}\" class=\"panel\"><h2>{}</h2>\n<div class=\"figures\">\n{}</div>",
        figure.name,
        escaped(&figure.title),
        figure.on_page()
    );
    let (header, rows) = &figure.summary;
    // Of a single study its name stands in the heading, and a column without an entry says nothing.
    let shown: Vec<usize> =
        (0..header.len()).filter(|k| rows.iter().any(|row| row.get(*k).is_some_and(|cell| !cell.is_empty()))).collect();
    let heading: Vec<String> = shown.iter().filter_map(|k| header.get(*k)).map(|cell| escaped(cell)).collect();
    let heading: Vec<&str> = heading.iter().map(String::as_str).collect();
    let rows = rows.iter().map(|row| shown.iter().filter_map(|k| row.get(*k)).map(|cell| escaped(cell)).collect());
    html.push_str(&html_table(&heading, rows));
    html.push_str(&html_list(&figure.notes));
    let tables = figure.tables.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    let _ = writeln!(html, "<p class=\"note\">Numbers: {tables}.</p></section>");
}
