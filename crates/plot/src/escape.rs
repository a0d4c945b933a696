//! Text inside XML.

/// Text with the characters that XML takes for its own replaced; fit for content and for quoted
/// attributes.
///
/// ```
/// assert_eq!(teeter_plot::escaped("a < b & c"), "a &lt; b &amp; c");
/// ```
#[must_use]
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // Control characters, which XML can't hold.
            c if c < ' ' && !matches!(c, '\n' | '\t') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}
