//! Escaping text for XML.

/// Replaces the special characters of XML; for content and quoted attributes.
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
            // Control characters aren't allowed in XML.
            c if c < ' ' && !matches!(c, '\n' | '\t') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// By how much subscripts are lowered and how large they are, in the figure's units.
const LOWERED: f64 = 3.0;
const SUBSCRIPT: f64 = 10.0;

/// Text as SVG in which the subscripts of symbols are lowered: a symbol is one letter, its subscript the letters and
/// digits after `_`. Words with an underscore, such as names of keys, stay as they are. `rest` follows, as SVG.
pub(crate) fn with_subscripts(text: &str, rest: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let word = |k: usize| letters.get(k).is_some_and(|c| c.is_alphanumeric());
    let part_of_name = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    let is_symbol = |k: usize| letters[k].is_alphabetic() && (k == 0 || !part_of_name(letters[k - 1]));
    let Some(at) = (1..letters.len()).find(|&k| letters[k] == '_' && is_symbol(k - 1) && word(k + 1)) else {
        return escaped(text) + rest;
    };
    let end = (at + 1..letters.len()).find(|&k| !word(k)).unwrap_or(letters.len());
    let [before, below, after] = [0..at, at + 1..end, end..letters.len()].map(|part| letters[part].iter().collect());
    let [before, below, after]: [String; 3] = [before, below, after];
    let after = match with_subscripts(&after, rest) {
        nothing if nothing.is_empty() => nothing,
        raised => format!("<tspan dy=\"-{LOWERED}\">{raised}</tspan>"),
    };
    format!("{}<tspan dy=\"{LOWERED}\" font-size=\"{SUBSCRIPT}\">{}</tspan>{after}", escaped(&before), escaped(&below))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subscripts_of_symbols_are_lowered_and_names_of_keys_are_not() {
        let lowered = |text: &str| format!("<tspan dy=\"3\" font-size=\"10\">{text}</tspan>");
        assert_eq!(
            with_subscripts("Frequency ω_p/p & more", ""),
            format!("Frequency ω{}<tspan dy=\"-3\">/p &amp; more</tspan>", lowered("p"))
        );
        assert_eq!(with_subscripts("S_a", ""), format!("S{}", lowered("a")));
        let unit = format!("S{}<tspan dy=\"-3\"> (m/s²)</tspan>", lowered("a"));
        assert_eq!(with_subscripts("S_a", " (m/s²)"), unit, "what follows isn't lowered");
        let two = with_subscripts("u_n/u_t", "");
        assert!(two.contains(&lowered("n")) && two.contains(&lowered("t")) && two.matches("dy=\"-3\"").count() == 1);
        for name in ["max_phi_over_alpha", "table.w_mid", "block.a_b", "_p", "ω_", "no symbol"] {
            assert_eq!(with_subscripts(name, ""), name);
        }
    }
}
