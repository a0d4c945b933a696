//! Output of a study: a table, the same as JSON, figures, a page, and sentences for users.

mod csv;
mod figure;
mod front;
mod html;
mod json;
mod page;
mod sentences;

pub use csv::csv;
pub(crate) use csv::quoted;
pub use figure::figures;
pub(crate) use html::{capitalised, html_list, html_table};
pub use json::json;
pub use page::page;
pub use sentences::{advice, findings, pruning};

/// All files that a study may write; the figures depend on its scene.
pub const FILES: [&str; 13] = [
    "tradeoff.json",
    "tradeoff.csv",
    "tradeoff.html",
    "figures/accuracy.svg",
    "figures/angle.svg",
    "figures/position.svg",
    "figures/deflection.svg",
    "figures/impact_times.svg",
    "figures/peaks.svg",
    "figures/forces.svg",
    "figures/energy.svg",
    "figures/penetration.svg",
    "scene.toml",
];

/// A number with two significant digits.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let rounded: f64 = format!("{x:.1e}").parse().unwrap_or(x);
    if (1e-3..1e4).contains(&rounded.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// A fraction as a percentage with two significant digits.
pub(crate) fn percent(x: f64) -> String {
    format!("{} %", power(100.0 * x))
}

/// A number with two significant digits, for sentences: `5.3 × 10⁻⁵`.
pub(crate) fn power(x: f64) -> String {
    typeset(&short(x))
}

/// A number such as `5.3e-5` as people write it.
pub(crate) fn typeset(text: &str) -> String {
    let Some((digits, exponent)) = text.split_once('e') else { return text.to_owned() };
    let raised = exponent.chars().map(|c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        // U+2070 and U+2074 to U+2079.
        digit => digit.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)).unwrap_or(digit),
    });
    let times = if digits == "1" { String::new() } else { format!("{digits} × ") };
    format!("{times}10{}", raised.collect::<String>())
}

/// A time with two significant digits and a suitable unit.
pub(crate) fn duration(seconds: f64) -> String {
    const UNITS: [(f64, &str); 3] = [(1.0, "s"), (1e3, "ms"), (1e6, "µs")];
    let (factor, unit) = UNITS.into_iter().find(|(factor, _)| seconds * factor >= 0.9995).unwrap_or(UNITS[2]);
    format!("{} {unit}", short(seconds * factor))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            (short(0.001_234), short(1.96), short(3e-7), short(0.0)),
            ("0.0012".into(), "2".into(), "3e-7".into(), "0".into())
        );
        assert_eq!((percent(1e-4), percent(0.1)), ("0.01 %".into(), "10 %".into()));
        assert_eq!(
            (percent(5.3e-7), power(1e-12), power(4e20)),
            ("5.3 × 10⁻⁵ %".into(), "10⁻¹²".into(), "4 × 10²⁰".into())
        );
        assert_eq!(
            (duration(0.004_21), duration(2.0), duration(1.3e-5)),
            ("4.2 ms".into(), "2 s".into(), "13 µs".into())
        );
    }
}
