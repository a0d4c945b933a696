//! The page itself: text and numbers as HTML here, pictures by the script from the data.

mod beams;
mod model;
mod rocking;
mod tiles;

use super::panels::Panels;
use super::recorder::PageRecorder;
use super::rocking::half_cycles_and_left_out;
use super::{accelerograms, content, data, thrust};
use crate::verdict::SLID;
use crate::{Summary, with_digits};
use std::collections::BTreeMap;
use std::fmt::Write;
use teeter_plot::escaped;
use tiles::Numbers;

const TEMPLATE: &str = include_str!("../../assets/report.html");
/// The style of the pages.
pub const STYLE: &str = include_str!("../../assets/report.css");
const SCRIPTS: [&str; 7] = [
    include_str!("../../assets/model.js"),
    include_str!("../../assets/network.js"),
    include_str!("../../assets/export.js"),
    include_str!("../../assets/spoken.js"),
    include_str!("../../assets/scene.js"),
    include_str!("../../assets/plots.js"),
    include_str!("../../assets/main.js"),
];

/// A self-contained page without scripts in the style of a run's report: `title` and `subtitle` are plain
/// text, `style` is CSS of its own, and `main` the HTML of its main part.
#[must_use]
pub fn document(title: &str, subtitle: &str, style: &str, main: &str) -> String {
    let (title, subtitle) = (escaped(title), escaped(subtitle));
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <title>{title}</title>\n<style>\n{STYLE}main {{ display: block; }}\n{style}</style>\n</head>\n<body>\n<header>\n\
         <h1>{title}</h1>\n<p id=\"subtitle\">{subtitle}</p>\n</header>\n<main>\n{main}</main>\n</body>\n</html>\n"
    )
}

/// The page of a run, `report.html`: one file that loads nothing. `scene_toml` is the text of the scene as run.
///
/// The same run gives the same page: what the clock measured is in `summary.json` only.
#[must_use]
pub fn render(recorder: &PageRecorder, summary: &Summary, scene_toml: &str) -> String {
    let values = Numbers::of(summary);
    let panels = Panels::of(recorder);
    let of_run = accelerograms::OfRun {
        length: recorder.scenery.display.length,
        drawn: accelerograms::are_drawn(recorder, &panels.curves),
    };
    let script = format!("(() => {{\n\"use strict\";\n{}}})();\n", SCRIPTS.concat());
    let parts = BTreeMap::from([
        ("title", escaped(&summary.title)),
        ("style", STYLE.to_owned()),
        ("script", script),
        ("data", data::json(recorder, &panels, summary)),
        ("verdict", verdict(summary)),
        ("subtitle", subtitle(summary)),
        ("warnings", warnings(summary)),
        ("tiles", tiles::tiles(&values, summary, |body| slid_on(recorder, &panels, body))),
        ("residual", scientific(summary.energy.largest_residual)),
        ("notdrawn", not_drawn(&panels)),
        ("shapes", beams::shapes(recorder, &panels.units)),
        ("records", accelerograms::section(&recorder.scenery.records, &summary.records, Some(of_run))),
        ("borne", beams::borne(recorder, &panels.units, summary)),
        ("thrust", thrust::section(recorder, panels.many_at_end())),
        ("rocking", rocking::rocking(&half_cycles_and_left_out(recorder, summary), recorder, summary.dt)),
        ("physical", model::physical(&recorder.scenery.physical)),
        ("model", model::model(summary)),
        ("numbers", tiles::numbers(&values, summary)),
        ("settings", escaped(scene_toml)),
    ]);
    filled(TEMPLATE, &parts)
}

/// What a block slid on by a hundredth of its size or more.
fn slid_on<'r>(recorder: &'r PageRecorder, panels: &Panels, body: &str) -> Vec<&'r str> {
    let scenery = &recorder.scenery;
    let slips = panels.panels.iter().filter(|panel| panel.id.starts_with("slip-"));
    let on = slips.filter_map(|panel| {
        let contact = scenery.contacts.get(panel.of_contact.as_ref()?.0)?;
        let block = &scenery.blocks[contact.block];
        let far = content::largest(panel.lines.iter().flat_map(|line| &line.y));
        (block.name == body && far >= SLID * block.reach).then_some((contact.surface.as_str(), far))
    });
    let on: Vec<(&str, f64)> = on.collect();
    // What it brushed against on its way is not what it slid on.
    let least = 0.1 * on.iter().fold(0.0, |most: f64, (_, far)| most.max(*far));
    let mut on: Vec<&str> = on.into_iter().filter(|(_, far)| *far >= least).map(|(surface, _)| surface).collect();
    on.dedup();
    on
}

/// The template with every `{{name}}` replaced; what is put in is not looked at again.
fn filled(template: &str, parts: &BTreeMap<&str, String>) -> String {
    let mut pieces = template.split("{{");
    let mut page = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (name, rest) = piece.split_once("}}").unwrap_or((piece, ""));
        page.push_str(parts.get(name).map_or("", String::as_str));
        page.push_str(rest);
    }
    page
}

/// The sentence at the head of the page.
fn verdict(summary: &Summary) -> String {
    let mut html = String::new();
    for (number, part) in summary.headline.split('`').enumerate() {
        // The terminal has a title before it, the page has not.
        let part = &if number == 0 { capitalised(part) } else { part.to_owned() };
        // A number stays with its name and its unit.
        let part = unbroken(&escaped(part));
        if number % 2 == 1 {
            _ = write!(html, "‘<span class=\"name\">{part}</span>’")
        } else {
            html.push_str(&part)
        }
    }
    if let Some(reason) = summary.stopped_by {
        _ = write!(html, "; the run stopped there ({})", reason.word());
    }
    // The sentence stands above what says how little it can be relied on.
    if let Some(reserve) = summary.reserve() {
        _ = write!(html, "<span class=\"reserve\">; {reserve}</span>");
    }
    html
}

/// With a number kept in one line with its name and its unit.
#[must_use]
pub fn unbroken(text: &str) -> String {
    let mut joined = String::with_capacity(text.len());
    let mut words = text.split(' ').peekable();
    while let Some(word) = words.next() {
        joined.push_str(word);
        let Some(next) = words.peek() else { break };
        let number = word.chars().last().is_some_and(|last| last.is_ascii_digit() || SUPERSCRIPTS.contains(last));
        let unit = next.trim_end_matches([';', ',', '.', ':', ')']);
        let keep = word == "=" || *next == "=" || word == "×" || *next == "×" || (number && UNITS.contains(&unit));
        joined.push(if keep { '\u{a0}' } else { ' ' });
    }
    joined
}

const SUPERSCRIPTS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/// Units that stand alone behind a number in sentences.
const UNITS: [&str; 22] = [
    "%", "s", "ms", "µs", "ns", "km", "m", "cm", "mm", "µm", "nm", "pm", "m/s", "rad", "N", "kN", "mN", "J", "kJ",
    "mJ", "Pa", "MPa",
];

/// With a capital letter at the start.
fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Text for HTML in which what stands between backquotes is code.
fn with_code(text: &str) -> String {
    let parts = text.split('`').enumerate();
    let code = |(number, part)| {
        let part = escaped(part);
        if number % 2 == 1 { format!("<code>{part}</code>") } else { part }
    };
    parts.map(code).collect()
}

fn subtitle(summary: &Summary) -> String {
    let ended = serde_json::to_value(summary.ended).unwrap_or_default();
    let ended = ended.as_str().unwrap_or_default().to_owned();
    let class = if ["complete", "stopped"].contains(&ended.as_str()) { "" } else { " class=\"bad\"" };
    let text = format!(
        "{} · {} steps of {} · t = {} · <span{class}>{ended}</span> · teeter {}",
        escaped(summary.scheme),
        summary.steps,
        with_prefix(summary.dt, "s"),
        with_digits(summary.steps as f64 * summary.dt, "s", 6),
        escaped(summary.version)
    );
    unbroken(&text).replace(" steps of ", "\u{a0}steps of ")
}

fn warnings(summary: &Summary) -> String {
    if summary.warnings.is_empty() {
        return String::new();
    }
    // What they say at length is folded: it would stand between the verdict and the picture.
    let mut subjects = Vec::new();
    for warning in &summary.warnings {
        if !subjects.contains(&warning.subject()) {
            subjects.push(warning.subject());
        }
    }
    let title = if summary.warnings.len() == 1 { "Warning" } else { "Warnings" };
    let mut html = format!(
        "<section id=\"warnings\" aria-labelledby=\"warnings-title\">\n<h2 class=\"unseen\" id=\"warnings-title\">Warnings</h2>\n\
         <details>\n<summary><b>{title}</b>: {}</summary>\n<ul>\n",
        with_code(&subjects.join("; "))
    );
    for warning in &summary.warnings {
        // Some texts tell how often.
        let count = if warning.count > 1 && warning.code != crate::UNLOCATED {
            format!(" <b>({} times)</b>", warning.count)
        } else {
            String::new()
        };
        let _ = writeln!(
            html,
            "<li data-warning=\"{}\"><span>{}</span>{count}</li>",
            escaped(&warning.code),
            with_code(warning.text.strip_prefix("warning: ").unwrap_or(&warning.text))
        );
    }
    html.push_str("</ul>\n</details>\n</section>");
    html
}

/// What isn't drawn, and why; empty if all is.
fn not_drawn(panels: &Panels) -> String {
    let mut text = content::told(&panels.left_out);
    if !panels.negligible.is_empty() {
        let space = if text.is_empty() { "" } else { " " };
        let each: Vec<String> = panels
            .negligible
            .iter()
            .map(|(what, size)| format!("{what} (at most {})", with_prefix(*size, "J")))
            .collect();
        let _ = write!(text, "{space}Too small beside the energies for a plot: {}.", each.join(", "));
    }
    if !panels.untraced.is_empty() {
        let space = if text.is_empty() { "" } else { " " };
        let _ = write!(
            text,
            "{space}No phase portrait of {}: the velocity turns more often than a curve of the points that a page has room for can show.",
            panels.untraced.join(", ")
        );
    }
    if text.is_empty() { text } else { format!("<p id=\"not-drawn\" class=\"note\">{}</p>", unbroken(&escaped(&text))) }
}

/// A number with three digits and the prefix that suits it, such as `9.04 µm`.
fn with_prefix(x: f64, unit: &str) -> String {
    with_prefix_of(x, 3, unit)
}

/// The same with so many digits.
fn with_prefix_of(x: f64, digits: usize, unit: &str) -> String {
    match with_digits(x, unit, digits) {
        // Beyond the prefixes' range, powers of ten.
        text if text.contains('e') => format!("{} {unit}", scientific(x)),
        text => text.replace('-', "\u{2212}"),
    }
}

/// A number with two digits as a power of ten.
fn scientific(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let text = format!("{x:.1e}");
    match text.split_once('e') {
        Some((digits, "0")) => digits.replace('-', "\u{2212}"),
        Some((digits, power)) => {
            format!("{}\u{a0}×\u{a0}10<sup>{}</sup>", digits.replace('-', "\u{2212}"), power.replace('-', "\u{2212}"))
        }
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_put_in_is_not_filled_again() {
        let parts = BTreeMap::from([("a", "{{b}}".to_owned()), ("b", "x".to_owned())]);
        assert_eq!(filled("<{{a}}|{{b}}>", &parts), "<{{b}}|x>");
    }

    #[test]
    fn the_template_asks_for_nothing_unknown() {
        for piece in TEMPLATE.split("{{").skip(1) {
            let name = piece.split_once("}}").unwrap().0;
            let known =
                ["title", "style", "script", "data", "verdict", "subtitle", "warnings", "tiles", "residual", "rocking"];
            assert!(
                known.contains(&name)
                    || ["borne", "model", "notdrawn", "numbers", "physical", "records", "settings", "shapes", "thrust"]
                        .contains(&name),
                "{name}"
            );
        }
    }

    #[test]
    fn a_number_stays_in_one_line_with_its_name_and_its_unit() {
        let text = "rests at t = 1.2 ms; off by 3 % (4 × 10⁻⁵ m), 5 steps of 1 s";
        assert_eq!(
            unbroken(text).replace('\u{a0}', "~"),
            "rests at t~=~1.2~ms; off by 3~% (4~×~10⁻⁵~m), 5 steps of 1~s"
        );
    }

    #[test]
    fn numbers_are_shown_with_the_prefix_that_suits() {
        assert_eq!(with_prefix(9.043e-6, "m"), "9.04 µm");
        assert_eq!(with_prefix(1e-4, "s"), "100 µs");
        assert_eq!(with_prefix(0.0, "m"), "0 m");
        assert_eq!(with_prefix(1e-3, "s"), "1 ms");
        assert_eq!(with_prefix(3e-20, "m"), "3.0\u{a0}×\u{a0}10<sup>\u{2212}20</sup> m");
        assert_eq!(scientific(2.5), "2.5");
    }
}
