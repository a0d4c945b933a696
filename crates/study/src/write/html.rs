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
    fn sentences_of_the_terminal_are_set_for_a_page() {
        let list = html_list(&["run `teeter run` < now".to_owned(), "warning: widen `k`".to_owned()]);
        assert!(list.contains("<li>Run <code>teeter run</code> &lt; now</li>"), "{list}");
        assert!(list.contains("<li><b class=\"bad\">Warning:</b> widen <code>k</code></li>"), "{list}");
    }
}
