//! `study.html`: a self-contained page in the style of a run's report.

use super::{Ensemble, StudyFigure};
use std::fmt::Write;
use teeter_plot::escaped;
use teeter_report::STYLE;

const OWN_STYLE: &str = "\
main { display: block; }\nmain > section { margin-top: 1.5rem; }\n\
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(26rem, 100%), 1fr)); gap: 1rem; }\n\
.figures svg { display: block; width: 100%; height: auto; max-width: 44rem; margin: 0 auto; }\n\
li { margin: .3rem 0; overflow-wrap: anywhere; }\ntd:first-child { text-align: left; }\n";

/// The page of the figures of a study, or of several side by side.
#[must_use]
pub fn study_page(title: &str, studies: &[Ensemble], figures: &[StudyFigure]) -> String {
    let title = escaped(title);
    let told = |study: &Ensemble| {
        let failed = match study.table.incomplete() {
            0 => String::new(),
            some => format!(", {some} without a result"),
        };
        let name = if studies.len() > 1 { format!("{}: ", study.name) } else { String::new() };
        format!("{name}{} cases{failed}", study.table.len())
    };
    let subtitle = studies.iter().map(told).collect::<Vec<_>>().join(" · ");
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <title>{title}</title>\n<style>\n{STYLE}{OWN_STYLE}</style>\n</head>\n<body>\n<header>\n<h1>{title}</h1>\n\
         <p id=\"subtitle\">{} · teeter {}</p>\n</header>\n<main>\n",
        escaped(&subtitle),
        env!("CARGO_PKG_VERSION")
    );
    for figure in figures {
        section(&mut html, figure);
    }
    html.push_str("</main>\n</body>\n</html>\n");
    html
}

fn section(html: &mut String, figure: &StudyFigure) {
    let _ = writeln!(
        html,
        "<section id=\"{}\" class=\"panel\"><h3>{}</h3>\n<div class=\"figures\">\n{}</div>",
        figure.name,
        escaped(&figure.title),
        figure.themed()
    );
    let (header, rows) = &figure.summary;
    // Of a single study its name stands in the heading, and a column without an entry says nothing.
    let shown: Vec<usize> =
        (0..header.len()).filter(|k| rows.iter().any(|row| row.get(*k).is_some_and(|cell| !cell.is_empty()))).collect();
    html.push_str("<div class=\"scroll\" tabindex=\"0\"><table>\n<thead><tr>");
    for cell in shown.iter().filter_map(|k| header.get(*k)) {
        let _ = write!(html, "<th scope=\"col\">{}</th>", escaped(cell));
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        html.push_str("<tr>");
        for cell in shown.iter().filter_map(|k| row.get(*k)) {
            let _ = write!(html, "<td>{}</td>", escaped(cell));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody></table></div>\n<ul>\n");
    for note in &figure.notes {
        let _ = writeln!(html, "<li>{}</li>", escaped(note));
    }
    let tables = figure.tables.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    let _ = writeln!(html, "</ul>\n<p class=\"note\">Numbers: {tables}.</p></section>");
}
