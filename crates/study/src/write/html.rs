//! Pieces of HTML for the pages of studies.

use std::fmt::Write;
use teeter_plot::escaped;

/// A table with a heading; cells are HTML.
pub(crate) fn html_table(heading: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut html = "<div class=\"scroll\" tabindex=\"0\"><table>\n<thead><tr>".to_owned();
    for cell in heading {
        let _ = write!(html, "<th scope=\"col\">{cell}</th>");
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        let cells: String = row.iter().map(|cell| format!("<td>{cell}</td>")).collect();
        let _ = writeln!(html, "<tr>{cells}</tr>");
    }
    html.push_str("</tbody></table></div>\n");
    html
}

/// Sentences as a list.
pub(crate) fn html_list(sentences: &[String]) -> String {
    let items: String = sentences.iter().map(|sentence| format!("<li>{}</li>\n", escaped(sentence))).collect();
    format!("<ul>\n{items}</ul>\n")
}
