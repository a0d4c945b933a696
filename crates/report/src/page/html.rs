//! The page itself: text and numbers as HTML here, pictures by the script from the data.

use super::accelerograms;
use super::content;
use super::panels::Panels;
use super::recorder::PageRecorder;
use super::rocking::{HalfCycle, half_cycles};
use super::{data, rounded, span, thrust};
use crate::summary::{BeamSummary, RemovedSummary};
use crate::{Summary, shortest, with_digits};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use teeter_plot::escaped;

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
    // A summary always serialises: its numbers are finite, or null.
    let values = Numbers(serde_json::to_value(summary).unwrap_or_default());
    let panels = Panels::of(recorder);
    let script = format!("(() => {{\n\"use strict\";\n{}}})();\n", SCRIPTS.concat());
    let parts = BTreeMap::from([
        ("title", escaped(&summary.title)),
        ("style", STYLE.to_owned()),
        ("script", script),
        ("data", data::json(recorder, &panels, summary)),
        ("verdict", verdict(summary)),
        ("subtitle", subtitle(summary)),
        ("warnings", warnings(summary)),
        ("tiles", tiles(&values, summary)),
        ("residual", scientific(summary.energy.largest_residual)),
        ("notdrawn", not_drawn(&panels)),
        ("shapes", shapes(recorder)),
        ("records", accelerograms::section(&recorder.scenery.records, &summary.records)),
        ("borne", borne(recorder, summary)),
        ("thrust", thrust::section(recorder)),
        ("rocking", rocking(&half_cycles(recorder, summary), recorder, summary.dt)),
        ("model", model(summary)),
        ("numbers", numbers(&values)),
        ("settings", escaped(scene_toml)),
    ]);
    filled(TEMPLATE, &parts)
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

/// The values of `summary.json` by path, such as `energy.largest_residual`.
struct Numbers(Value);

/// What the clock measured, which differs from run to run.
const CLOCKED: [&str; 2] = ["wall_seconds", "us_per_step"];

impl Numbers {
    /// The text of a value as the file has it, a word without its quotes.
    fn text(&self, path: &str) -> String {
        match path
            .split('.')
            .try_fold(&self.0, |value, key| value.get(key).or_else(|| value.get(key.parse::<usize>().ok()?)))
        {
            Some(Value::String(word)) => word.clone(),
            Some(value) => value.to_string(),
            None => String::new(),
        }
    }

    /// The paths of all single values that no tile shows.
    fn others(&self) -> Vec<String> {
        fn walk(value: &Value, path: &str, out: &mut Vec<String>) {
            match value {
                Value::Object(map) => {
                    for (key, value) in map {
                        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                        walk(value, &path, out);
                    }
                }
                Value::Array(_) => {}
                _ => out.push(path.to_owned()),
            }
        }
        let mut paths = Vec::new();
        walk(&self.0, "", &mut paths);
        paths.retain(|path| {
            !TILES.contains(&path.as_str()) && !CLOCKED.contains(&path.as_str()) && !path.starts_with("model.")
        });
        paths
    }
}

/// What users want to know first: the numbers of the mechanics, then from [`NUMERIC`] on those of the computation.
const TILES: [&str; 13] = [
    "deflections.0.w",
    "max_phi_over_alpha",
    "overturned_at",
    "rests_from",
    "energy.lost",
    "impact_count",
    "horizon",
    "reclosure_count",
    "max_penetration",
    "energy.largest_residual",
    "contact.unconverged_steps",
    "contact.max_residual",
    "contact.max_iterations",
];

/// The first tile that is of the computation.
const NUMERIC: usize = 7;

/// The sentence at the head of the page.
fn verdict(summary: &Summary) -> String {
    let mut html = String::new();
    for (number, part) in summary.headline.split('`').enumerate() {
        // The terminal has a title before it, the page has not.
        let part = &if number == 0 { capitalised(part) } else { part.to_owned() };
        // A number stays with its name and its unit.
        let part = escaped(part).replace(" = ", "\u{a0}=\u{a0}").replace(" ms", "\u{a0}ms");
        if number % 2 == 1 {
            _ = write!(html, "‘<span class=\"name\">{part}</span>’")
        } else {
            html.push_str(&part)
        }
    }
    if let Some(reason) = summary.stopped_by {
        _ = write!(html, "; the run stopped there ({})", reason.word());
    }
    html
}

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

/// Energy that is lost; what is rounding beside the scene's energy isn't shown as a loss.
fn lost(energy: &crate::summary::EnergySummary) -> String {
    let counts = content::holds(energy.lost.abs(), energy.scale);
    with_prefix(if counts { energy.lost } else { 0.0 }, "J")
}

fn tiles(values: &Numbers, summary: &Summary) -> String {
    let mut html = String::new();
    let seconds = |t: Option<f64>| t.map(|t| with_prefix(t, "s"));
    // Without contacts their numbers would all be 0.
    let touches = !summary.model.contacts.is_empty() || summary.contact.max_contacts > 0;
    let of_contacts = ["impact_count", "reclosure_count", "max_penetration"];
    for (number, path) in TILES.into_iter().enumerate() {
        if !touches && (of_contacts.contains(&path) || path.starts_with("contact.")) {
            continue;
        }
        let (label, shown) = match path {
            "deflections.0.w" => ("Largest deflection", summary.deflections.first().map(|of| with_prefix(of.w, "m"))),
            "max_phi_over_alpha" => ("Largest φ/α", summary.max_phi_over_alpha.map(share_of_critical_angle)),
            "overturned_at" => ("First overturned at", seconds(summary.overturned_at)),
            "rests_from" => ("All at rest from", seconds(summary.rests_from)),
            "energy.lost" => ("Energy lost", Some(lost(&summary.energy))),
            "impact_count" => ("Impacts", Some(summary.impact_count.to_string())),
            "horizon" => ("Predictable up to", seconds(summary.horizon)),
            "reclosure_count" => ("Contacts lost and found again", Some(summary.reclosure_count.to_string())),
            "max_penetration" => ("Deepest penetration of a corner", Some(with_prefix(summary.max_penetration, "m"))),
            "energy.largest_residual" => ("Energy residual", Some(scientific(summary.energy.largest_residual))),
            "contact.unconverged_steps" => ("Steps not solved", Some(summary.contact.unconverged_steps.to_string())),
            "contact.max_residual" => ("Contact residual", Some(scientific(summary.contact.max_residual))),
            _ => ("Most iterations", Some(summary.contact.max_iterations.to_string())),
        };
        // What has no meaning for this scene, or wasn't measured.
        let Some(shown) = shown else { continue };
        let bad = path == "contact.unconverged_steps" && summary.contact.unconverged_steps > 0;
        let _ = writeln!(
            html,
            "<div class=\"tile{}{}\"><dt>{label}</dt><dd data-summary=\"{path}\" data-value=\"{}\">{shown}</dd></div>",
            if number >= NUMERIC { " numeric" } else { "" },
            if bad { " bad" } else { "" },
            escaped(&values.text(path))
        );
    }
    html
}

fn numbers(values: &Numbers) -> String {
    let mut html = String::new();
    for path in values.others() {
        let text = values.text(&path);
        // For people; the file, and `data-value`, have all digits.
        let shown = match (text.parse::<f64>(), unit_of(&path)) {
            (Ok(x), Some(unit)) => with_digits(x, unit, 6).replace('-', "\u{2212}"),
            (Ok(x), None) if text.contains(['.', 'e']) && path != "version" => shortest(x, 3).replace('-', "\u{2212}"),
            _ => with_code(&text),
        };
        let text = escaped(&text);
        let _ = writeln!(
            html,
            "<tr><th scope=\"row\">{path}</th><td data-summary=\"{path}\" data-value=\"{text}\">{shown}</td></tr>"
        );
    }
    html
}

/// The unit of a number of the summary, of those that have one.
fn unit_of(path: &str) -> Option<&'static str> {
    match path {
        "dt" | "t" => Some("s"),
        "energy.largest_residual" | "energy.positive_contact_work.steps" => None,
        _ => path.starts_with("energy.").then_some("J"),
    }
}

fn subtitle(summary: &Summary) -> String {
    let ended = serde_json::to_value(summary.ended).unwrap_or_default();
    let ended = ended.as_str().unwrap_or_default().to_owned();
    let class = if ["complete", "stopped"].contains(&ended.as_str()) { "" } else { " class=\"bad\"" };
    format!(
        "{} · {} steps of {} · t = {} · <span{class}>{ended}</span> · teeter {}",
        escaped(summary.scheme),
        summary.steps,
        with_prefix(summary.dt, "s"),
        with_digits(summary.steps as f64 * summary.dt, "s", 6),
        escaped(summary.version)
    )
}

fn warnings(summary: &Summary) -> String {
    if summary.warnings.is_empty() {
        return String::new();
    }
    let mut html = "<section id=\"warnings\" aria-labelledby=\"warnings-title\">\n\
                    <h2 id=\"warnings-title\">Warnings</h2>\n<ul>\n"
        .to_owned();
    for warning in &summary.warnings {
        let count = if warning.count > 1 { format!(" <b>({} times)</b>", warning.count) } else { String::new() };
        let _ = writeln!(
            html,
            "<li data-warning=\"{}\"><span>{}</span>{count}</li>",
            escaped(&warning.code),
            with_code(&warning.text)
        );
    }
    html.push_str("</ul>\n</section>");
    html
}

/// Rows of the table; the rest is in `summary.json`.
const ROWS: usize = 300;

/// Rows that are seen without unfolding the others.
const UNFOLDED: usize = 20;

/// Decimals with which the largest of the values of a column has so many digits.
fn decimals(values: impl Iterator<Item = f64>, digits: i32) -> usize {
    let largest = values.fold(0.0, |most: f64, x| most.max(x.abs()));
    if largest > 0.0 { (digits - 1 - largest.log10().floor() as i32).clamp(0, 12) as usize } else { 0 }
}

fn rocking(cycles: &[HalfCycle], recorder: &PageRecorder, dt: f64) -> String {
    if cycles.is_empty() {
        return String::new();
    }
    let mut html = "<section id=\"rocking\" class=\"panel\" aria-labelledby=\"rocking-title\">\n\
        <h3 id=\"rocking-title\">Rocking, half cycle by half cycle</h3>\n"
        .to_owned();
    let scenery = &recorder.scenery;
    // With one block its name would be a column of repetitions.
    let several = scenery.blocks.len() > 1;
    let (angle_unit, per_radian) = (scenery.display.angle.symbol(), scenery.display.angle.per_radian());
    // A step is told from the next.
    let of_times = decimals(std::iter::once(dt), 2).max(5);
    let of_rates = decimals(cycles.iter().filter_map(|cycle| cycle.omega).flatten(), 5);
    let of_peaks = decimals(cycles.iter().filter_map(|cycle| cycle.peak_after).map(|peak| peak * per_radian), 4);
    let mut head =
        "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-labelledby=\"rocking-title\"><table>\n<thead><tr>"
            .to_owned();
    head.push_str(if several { "<th scope=\"col\">Block</th>" } else { "" });
    head.push_str(
        &"<th scope=\"col\">φ = 0 at<br><small>s</small></th><th scope=\"col\">φ̇⁻<br><small>rad/s</small></th>\
        <th scope=\"col\">φ̇⁺<br><small>rad/s</small></th><th scope=\"col\">φ̇⁺/φ̇⁻</th>\
        <th scope=\"col\">Housner</th><th scope=\"col\">Next peak<br><small>{angle}</small></th>\
        <th scope=\"col\">Peak to peak</th></tr></thead>\n<tbody>\n"
            .replace("{angle}", angle_unit),
    );
    let fixed = |x: Option<f64>, digits: usize| {
        // No negative zero.
        x.map_or("–".to_owned(), |x| {
            let text = format!("{x:.digits$}");
            if text.trim_start_matches('-').trim_matches(['0', '.']).is_empty() {
                text.trim_start_matches('-').to_owned()
            } else {
                text.replace('-', "\u{2212}")
            }
        })
    };
    html.push_str(&head);
    for (number, cycle) in cycles.iter().take(ROWS).enumerate() {
        if number == UNFOLDED {
            let more = cycles.len().min(ROWS) - UNFOLDED;
            let rows = if more == 1 { "row" } else { "rows" };
            let _ = write!(html, "</tbody></table></div>\n<details><summary>{more} more {rows}</summary>\n{head}");
        }
        let name = escaped(&cycle.body);
        let row_head = if several { format!("<th scope=\"row\">{name}</th>") } else { String::new() };
        let _ = writeln!(
            html,
            "<tr data-body=\"{name}\" data-t=\"{}\">{row_head}<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>\
             <td>{}</td><td>{}</td></tr>",
            cycle.t,
            fixed(Some(cycle.t), of_times),
            fixed(cycle.omega.map(|omega| omega[0]), of_rates),
            fixed(cycle.omega.map(|omega| omega[1]), of_rates),
            fixed(cycle.ratio(), 4),
            fixed(cycle.housner, 4),
            fixed(cycle.peak_after.map(|peak| peak * per_radian), of_peaks),
            fixed(cycle.decay(), 4),
        );
    }
    html.push_str("</tbody></table></div>\n");
    html.push_str(if cycles.len() > UNFOLDED { "</details>\n" } else { "" });
    if cycles.len() > ROWS {
        let _ = writeln!(html, "<p>… and {} more; all are in summary.json.</p>", cycles.len() - ROWS);
    }
    html.push_str(
        "<p class=\"note\">φ̇⁻ and φ̇⁺ are the angular velocities right before and right after the step in which the \
         corner that comes down hits; a step of gravity is in them, too. Housner: 1 − (3/2) sin²α, for rigid ground without slip or bounce. A base that \
         gives way spreads the loss over the half cycle: the ratio is then nearer to 1, and the decay from peak to peak \
         tells what is lost.</p>\n</section>",
    );
    html
}

/// What isn't drawn, and why; empty if all is.
fn not_drawn(panels: &Panels) -> String {
    let text = content::told(&panels.left_out);
    if text.is_empty() { text } else { format!("<p id=\"not-drawn\" class=\"note\">{}</p>", escaped(&text)) }
}

/// The deflected shapes at chosen times.
fn shapes(recorder: &PageRecorder) -> String {
    let figure = span::on_page("shapes", |id| span::shapes(recorder, id));
    figure.map_or_else(String::new, |figure| {
        format!(
            "<section id=\"shapes\" class=\"panel\" aria-labelledby=\"shapes-title\">\n\
             <h3 id=\"shapes-title\">Deflected shape at chosen times</h3>\n{figure}</section>"
        )
    })
}

/// What beams bore: largest stress, reactions, envelopes.
fn borne(recorder: &PageRecorder, summary: &Summary) -> String {
    let mut html = String::new();
    let several = summary.beams.len() > 1;
    let stresses = summary.beams.iter().filter_map(|borne| {
        let largest = borne.largest_stress?;
        let part = borne.part_of_yield_strength.map(|part| {
            let class = if part > 1.0 { " class=\"bad\"" } else { "" };
            format!(", <span{class}>{} % of the yield strength</span>", rounded(100.0 * part, 3))
        });
        let name = if several { format!("{}: ", escaped(&borne.beam)) } else { String::new() };
        Some(format!(
            "<p data-beam=\"{}\" data-stress=\"{}\">{name}largest normal stress {} at x = {}, t = {}{}</p>\n",
            escaped(&borne.beam),
            largest.stress,
            with_digits(largest.stress, "Pa", 4),
            with_digits(largest.x, "m", 4),
            with_digits(largest.t, "s", 6),
            part.unwrap_or_default()
        ))
    });
    let stresses: String = stresses.collect();
    if !stresses.is_empty() {
        let _ = writeln!(
            html,
            "<section id=\"stress\" class=\"panel\" aria-labelledby=\"stress-title\">\n<h3 id=\"stress-title\">Stress</h3>\n\
             {stresses}</section>"
        );
    }
    if let Some(figure) = span::on_page("envelopes", |id| span::envelopes(recorder, id)) {
        let _ = writeln!(
            html,
            "<section id=\"envelopes\" class=\"panel\" aria-labelledby=\"envelopes-title\">\n<h3 id=\"envelopes-title\">Moment \
             and transverse force over the span, least and largest of all steps</h3>\n{figure}</section>"
        );
    }
    html.push_str(&reactions(summary));
    html
}

fn reactions(summary: &Summary) -> String {
    let supports: Vec<_> =
        summary.beams.iter().flat_map(|borne| borne.reactions.iter().map(|range| (&borne.beam, range))).collect();
    if supports.is_empty() {
        return String::new();
    }
    let several = summary.beams.len() > 1;
    let mut html = "<section id=\"reactions\" class=\"panel\" aria-labelledby=\"reactions-title\">\n\
        <h3 id=\"reactions-title\">Reactions of the supports</h3>\n<div class=\"scroll\" tabindex=\"0\" role=\"group\" \
        aria-labelledby=\"reactions-title\"><table>\n<thead><tr>"
        .to_owned();
    html.push_str(if several { "<th scope=\"col\">Beam</th>" } else { "" });
    html.push_str("<th scope=\"col\">x<br><small>m</small></th>");
    // Pinned ends have none.
    let turned = supports.iter().any(|(_, range)| range.couple != [0.0; 2]);
    let columns = [("Force", "N"), ("Couple", "N m")];
    for (what, unit) in &columns[..if turned { 2 } else { 1 }] {
        for when in ["at the start", "least", "largest"] {
            let _ = write!(html, "<th scope=\"col\">{what} {when}<br><small>{unit}</small></th>");
        }
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    let cell = |x: f64| format!("<td>{}</td>", rounded(x, 4).to_string().replace('-', "\u{2212}"));
    for (beam, range) in supports {
        let name = escaped(beam);
        let head = if several { format!("<th scope=\"row\">{name}</th>") } else { String::new() };
        let ([force, couple], [low, high], [least, most]) = (range.start, range.force, range.couple);
        let cells = [range.x, force, low, high, couple, least, most];
        let cells: String = cells[..if turned { 7 } else { 4 }].iter().copied().map(cell).collect();
        let _ = writeln!(html, "<tr data-beam=\"{name}\" data-x=\"{}\">{head}{cells}</tr>", range.x);
    }
    html.push_str(
        "</tbody></table></div>\n<p class=\"note\">Of the support on the beam: force upwards, couple counter-clockwise. Means over a \
         step: an impact\u{2019}s peak grows as the step shrinks.</p>\n</section>",
    );
    html
}

fn model(summary: &Summary) -> String {
    let model = &summary.model;
    let list = |words: &[String]| {
        if words.is_empty() { "none".to_owned() } else { escaped(&words.join(", ")) }
    };
    let beams: Vec<String> = model
        .beams
        .iter()
        .map(|beam| {
            let BeamSummary { name, elements, dofs, theory, backend, shapes } = beam;
            let shapes = shapes.map_or_else(String::new, |shapes| {
                let corrections = match shapes.corrections {
                    0 => String::new(),
                    n => format!(" and {n} static corrections"),
                };
                format!(" in {} modes{corrections}", shapes.modes)
            });
            format!("{name} ({theory}, {elements} elements{shapes}, {dofs} dofs, {backend})")
        })
        .collect();
    let mut html = String::new();
    let mut row = |name: &str, text: &str| _ = writeln!(html, "<div><dt>{name}</dt><dd>{text}</dd></div>");
    row("Blocks", &list(&model.blocks));
    row("Beams", &list(&beams));
    row("Ground", if model.ground { "rigid" } else { "none" });
    row("Contacts", &format!("{}; {} possible contacts", list(&model.contacts), model.possible_contacts));
    row("Degrees of freedom", &model.dofs.to_string());
    if !model.left_out.is_empty() {
        row("Left out", &model.left_out.iter().map(|text| escaped(text)).collect::<Vec<_>>().join("<br>"));
    }
    if !model.removed.is_empty() {
        let told = |removed: &RemovedSummary| format!("{}: {}", with_code(&removed.what), with_code(&removed.why));
        row("Not needed", &model.removed.iter().map(told).collect::<Vec<_>>().join("<br>"));
    }
    html
}

/// A number with three digits and the prefix that suits it, such as `9.04 µm`.
fn with_prefix(x: f64, unit: &str) -> String {
    match with_digits(x, unit, 3) {
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
            format!("{} × 10<sup>{}</sup>", digits.replace('-', "\u{2212}"), power.replace('-', "\u{2212}"))
        }
        None => text,
    }
}

/// φ/α for people: what is below a thousandth is rounding or hardly seen.
fn share_of_critical_angle(share: f64) -> String {
    if share < 1e-3 { "< 0.001".to_owned() } else { rounded(share, 3).to_string() }
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
                    || ["borne", "model", "notdrawn", "numbers", "records", "settings", "shapes", "thrust"]
                        .contains(&name),
                "{name}"
            );
        }
    }

    #[test]
    fn numbers_are_shown_with_the_prefix_that_suits() {
        assert_eq!(with_prefix(9.043e-6, "m"), "9.04 µm");
        assert_eq!(with_prefix(1e-4, "s"), "100 µs");
        assert_eq!(with_prefix(0.0, "m"), "0 m");
        assert_eq!(with_prefix(1e-3, "s"), "1 ms");
        assert_eq!(with_prefix(3e-20, "m"), "3.0 × 10<sup>\u{2212}20</sup> m");
        assert_eq!(scientific(2.5), "2.5");
    }
}
