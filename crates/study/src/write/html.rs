//! Pieces of HTML for the pages of studies.

use std::fmt::Write;
use teeter_plot::escaped;

/// A table of more columns becomes a list for each row in a narrow window.
const MOST_COLUMNS: usize = 6;

/// A table with a heading, which fits a narrow window by smaller type and by cells of several lines; cells are HTML.
pub(crate) fn html_table(heading: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let kind = if heading.len() > MOST_COLUMNS { "fit cards" } else { "fit" };
    let mut html = format!("<div class=\"scroll {kind}\" tabindex=\"0\"><table>\n<thead><tr>");
    for cell in heading {
        let _ = write!(html, "<th scope=\"col\">{cell}</th>");
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        let cells = row.iter().zip(heading).map(|(cell, of)| format!("<td data-of=\"{of}\">{cell}</td>"));
        let cells: String = cells.collect();
        let _ = writeln!(html, "<tr>{cells}</tr>");
    }
    html.push_str("</tbody></table></div>\n");
    html
}

/// Sentences as a list. Those of the terminal begin with a small letter, warnings with their word.
pub(crate) fn html_list(sentences: &[String]) -> String {
    let item = |sentence: &String| match sentence.strip_prefix("warning: ") {
        Some(text) => format!("<li><b class=\"bad\">Warning:</b> {}</li>\n", with_code(text)),
        None => format!("<li>{}</li>\n", with_code(&capitalised(sentence))),
    };
    format!("<ul>\n{}</ul>\n", sentences.iter().map(item).collect::<String>())
}

/// Text for HTML in which what stands between backquotes is code.
pub(crate) fn with_code(text: &str) -> String {
    let mut html = String::new();
    for (number, piece) in text.split('`').enumerate() {
        let piece = escaped(piece);
        html.push_str(&if number % 2 == 1 { format!("<code>{piece}</code>") } else { piece });
    }
    html
}

/// A sentence begins with a capital.
pub(crate) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_cell_says_what_it_is_of() {
        let table = html_table(&["a", "b"], [vec!["1".to_owned(), "2".to_owned()]]);
        assert!(table.contains("class=\"scroll fit\"") && table.contains("<td data-of=\"b\">2</td>"), "{table}");
        assert!(html_table(&["x"; 7], []).contains("class=\"scroll fit cards\""));
    }

    #[test]
    fn sentences_of_the_terminal_are_set_for_a_page() {
        let list = html_list(&["run `teeter run` < now".to_owned(), "warning: widen `k`".to_owned()]);
        assert!(list.contains("<li>Run <code>teeter run</code> &lt; now</li>"), "{list}");
        assert!(list.contains("<li><b class=\"bad\">Warning:</b> widen <code>k</code></li>"), "{list}");
    }
}
