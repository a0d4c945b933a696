//! Pieces of HTML for the pages of studies.

use std::fmt::Write;
use teeter_plot::escaped;
use teeter_report::unbroken;

/// Characters beside each other that a table has room for on a telephone.
const NARROW: usize = 43;

/// Of the first column, whose words may be broken, more characters are not counted.
const FIRST: usize = 10;

/// The text of HTML without its tags.
fn without_tags(html: &str) -> String {
    html.split('<')
        .enumerate()
        .map(|(k, part)| if k == 0 { part } else { part.split_once('>').map_or("", |(_, text)| text) })
        .collect()
}

/// The longest word of a text of HTML, in characters.
fn longest_word(html: &str) -> usize {
    without_tags(html).split(' ').map(|word| word.chars().count()).max().unwrap_or(0)
}

/// Whether a table fits a narrow window if lines are broken between words.
fn is_narrow(heading: &[&str], rows: &[Vec<String>]) -> bool {
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column)).map(|cell| longest_word(cell));
        let width = cells.fold(longest_word(heading[column]), usize::max);
        if column == 0 { width.min(FIRST) } else { width }
    };
    (0..heading.len()).map(width).sum::<usize>() <= NARROW
}

/// A table with a heading; cells are HTML. In a narrow window its type is smaller and its cells have several lines; where that
/// isn't enough, each row becomes a list.
pub(crate) fn html_table(heading: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let rows: Vec<Vec<String>> = rows.into_iter().collect();
    let kind = if is_narrow(heading, &rows) { "fit" } else { "fit cards" };
    let mut html = format!("<div class=\"scroll {kind}\" tabindex=\"0\"><table>\n<thead><tr>");
    for cell in heading {
        let _ = write!(html, "<th scope=\"col\">{cell}</th>");
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for row in rows {
        let cells = row.iter().zip(heading);
        let cells = cells.map(|(cell, of)| format!("<td data-of=\"{}\">{cell}</td>", without_tags(of)));
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

/// A command for HTML, which lines break between words only: a browser breaks them after hyphens, too. A word longer than a line is broken
/// all the same.
pub(crate) fn command_words(command: &str) -> String {
    let word = |word: &str| {
        let text = escaped(word);
        if word.contains('-') { format!("<span class=\"word\">{text}</span>") } else { text }
    };
    command.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// Text for HTML in which what stands between backquotes is code.
pub(crate) fn with_code(text: &str) -> String {
    let mut html = String::new();
    for (number, piece) in text.split('`').enumerate() {
        html.push_str(&if number % 2 == 1 {
            format!("<code>{}</code>", command_words(piece))
        } else {
            unbroken(&escaped(piece))
        });
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
    }

    #[test]
    fn a_table_too_wide_for_a_telephone_becomes_a_list_there() {
        let kind = |columns: usize, cell: &str| {
            let table = html_table(&vec!["x"; columns], [vec![cell.to_owned(); columns]]);
            if table.contains("class=\"scroll fit cards\"") { "list" } else { "table" }
        };
        assert_eq!((kind(4, "0.123456789"), kind(5, "0.123456789")), ("table", "list"));
        let impacts = ["No.", "Measured (s)", "Simulated (s)", "Delay", "ω⁺/ω⁻ measured", "ω⁺/ω⁻ simulated"];
        let row = ["1", "0.1062", "0.1063", "0.07\u{a0}ms", "0.968", "0.993"].map(str::to_owned).to_vec();
        assert!(!is_narrow(&impacts, &[row]), "a few pixels of it were out of view at 390 px");
        // Lines are broken between words; tags take no room.
        assert_eq!((kind(5, "0.1234 to 0.2345"), kind(5, "<code class=\"key\">0.1234</code>")), ("table", "table"));
    }

    #[test]
    fn lines_of_commands_break_between_words_only() {
        let words = command_words("teeter run a&b.toml --set time.scheme=moreau-jean");
        let whole = ["--set", "time.scheme=moreau-jean"].map(|word| format!("<span class=\"word\">{word}</span>"));
        assert_eq!(words, format!("teeter run a&amp;b.toml {} {}", whole[0], whole[1]));
    }

    #[test]
    fn sentences_of_the_terminal_are_set_for_a_page() {
        let list = html_list(&["run `teeter run` < now".to_owned(), "warning: widen `k`".to_owned()]);
        assert!(list.contains("<li>Run <code>teeter run</code> &lt; now</li>"), "{list}");
        assert!(list.contains("<li><b class=\"bad\">Warning:</b> widen <code>k</code></li>"), "{list}");
    }
}
