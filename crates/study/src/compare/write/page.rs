//! `compare.html`: a self-contained page in the style of a run's report.

use super::{motion_figures, sentences_of};
use crate::compare::differences::MOST_SHARE;
use crate::compare::{ChannelComparison, Comparison, ImpactPair};
use crate::measured::Channel;
use crate::write::{html_list, html_table, percent, power, short};
use std::fmt::Write;
use teeter_plot::{AxisError, escaped};
use teeter_report::document;

pub(crate) const STYLE: &str = "\
main > section { margin-top: 1.5rem; }\n\
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); gap: 1rem; }\n\
p.headline { margin: .25rem 0 0; font-size: 1.125rem; font-weight: 600; max-width: 62rem; }\n\
section li { margin: .3rem 0; overflow-wrap: anywhere; }\ncode { font-size: .9em; }\n\
td:first-child { text-align: left; }\n";

/// A number with so many decimals and a real minus.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    // Rounded to zero, it has no sign.
    let text = if text.parse() == Ok(0.0) { text.trim_start_matches('-') } else { &text };
    text.replace('-', "\u{2212}")
}

fn optional(value: Option<f64>, show: impl Fn(f64) -> String) -> String {
    value.filter(|value| value.is_finite()).map_or("–".to_owned(), show)
}

/// The columns of the table of differences.
const QUANTITY_HEADING: [&str; 8] = [
    "Quantity",
    "Root mean square",
    "its share",
    "Largest difference",
    "its share",
    "its time",
    "Mean",
    "Noise of the samples",
];

fn quantity_row(found: &ChannelComparison) -> Vec<String> {
    let ((_, factor), unit) = (found.channel.shown(), found.channel.shown_after("\u{a0}"));
    let d = found.differences;
    if d.rows == 0 {
        let mut cells = vec!["–".to_owned(); QUANTITY_HEADING.len()];
        found.channel.title().clone_into(&mut cells[0]);
        return cells;
    }
    let value = |x: f64| format!("{}{unit}", power(factor * x).replace('-', "\u{2212}"));
    let share = |x: f64| d.share(x).map_or("–".to_owned(), percent);
    vec![
        found.channel.title().to_owned(),
        value(d.rms),
        share(d.rms),
        value(d.max),
        share(d.max),
        format!("{}\u{a0}s", fixed(d.max_at, 4)),
        value(d.mean),
        if found.is_measured { value(found.measured.noise) } else { "–".to_owned() },
    ]
}

/// The page; `names` are the run, the measured table and the block.
///
/// # Errors
/// As [`svg_figures`](super::svg_figures).
pub fn page(comparison: &Comparison, title: &str, names: [&str; 3]) -> Result<String, AxisError> {
    let [run, measured, block] = names;
    let subtitle = format!("{run} · {measured} · block {block} · teeter {}", env!("CARGO_PKG_VERSION"));
    let mut html = format!("<p class=\"headline\">{}</p>\n", escaped(&headline(comparison)));
    html.push_str("<section class=\"panel\"><h2>Motion</h2>\n<div class=\"pictures\">\n");
    for (_, figure) in motion_figures(comparison, None, None)? {
        let _ = writeln!(html, "<div>{figure}</div>");
    }
    html.push_str("</div>");
    html.push_str(horizon_note(comparison));
    html.push_str("</section>\n<section class=\"panel\"><h2>Differences</h2>\n");
    html.push_str(&html_table(&QUANTITY_HEADING, comparison.channels.iter().map(quantity_row)));
    html.push_str(
        "<p class=\"note\">Simulated minus measured, over the rows compared; shares are of the largest measured value, of a position from its \
         mean. Times are those of the run. Rows before its t = 0, in which the block is held, are drawn but don’t count: a difference there is noise, or \
         a start that isn’t that of the scene.</p></section>\n",
    );
    html.push_str(&half_cycles(comparison));
    html.push_str(&impacts(comparison));
    let _ = write!(
        html,
        "<section class=\"panel\"><h2>How they are compared</h2>\n{}</section>\n",
        html_list(&sentences_of(comparison))
    );
    Ok(document(&format!("Measured and simulated: {title}"), &subtitle, STYLE, &html))
}

/// The page in a sentence: how far the angle is off, or else the first quantity, and whether the impacts are the same.
fn headline(comparison: &Comparison) -> String {
    let Some(found) =
        comparison.channels.iter().find(|found| found.channel == Channel::Phi).or(comparison.channels.first())
    else {
        return String::new();
    };
    let d = found.differences;
    let ((_, factor), unit) = (found.channel.shown(), found.channel.shown_after("\u{a0}"));
    let share = d.share(d.rms).map(|share| format!(", {} of the largest", percent(share))).unwrap_or_default();
    let last = comparison.measured.t.get(comparison.rows.end.saturating_sub(1)).copied().unwrap_or(0.0);
    let mut text = format!(
        "{}: root mean square difference {}{unit}{share}, up to t = {}\u{a0}s",
        found.channel.title(),
        power(factor * d.rms),
        short(last)
    );
    let [measured, simulated] =
        [|pair: &ImpactPair| pair.measured.is_some(), |pair: &ImpactPair| pair.simulated.is_some()]
            .map(|has| comparison.impacts.iter().filter(|pair| has(pair)).count());
    if measured + simulated > 0 {
        let _ = write!(text, "; {measured} impacts measured, {simulated} simulated");
    }
    text
}

/// What a ratio above 1 means, if there is one.
fn above_one(comparison: &Comparison) -> &'static str {
    let crossings = comparison.impacts.iter().flat_map(|pair| [pair.measured, pair.simulated]).flatten();
    if crossings.filter_map(|crossing| crossing.kept()).any(|kept| kept > 1.0) {
        " A ratio above 1 is no gain of energy: on a base that gives way the impact takes time and rates swing on \
         with the base, and of few or noisy rows it is the error of the extrapolation."
    } else {
        ""
    }
}

/// What the dashed line in the figures is, if there is one.
pub(crate) fn horizon_note(comparison: &Comparison) -> &'static str {
    match comparison.settings.horizon {
        Some(horizon) if horizon < comparison.trace.end() => {
            "<p class=\"note\">Dashed: the horizon; rows after it aren’t compared.</p>"
        }
        _ => "",
    }
}

fn half_cycles(comparison: &Comparison) -> String {
    if comparison.half_cycles.is_empty() {
        return String::new();
    }
    let degree = 180.0 / std::f64::consts::PI;
    let rows = comparison.half_cycles.iter().enumerate().map(|(number, pair)| {
        let simulated = pair.simulated.map(|half| degree * half.amplitude);
        vec![
            (number + 1).to_string(),
            fixed(degree * pair.measured.amplitude, 3),
            optional(simulated, |value| fixed(value, 3)),
            optional(pair.amplitude_ratio().map(|ratio| ratio - 1.0).filter(|of| of.abs() < MOST_SHARE), |of| {
                format!("{}\u{a0}%", fixed(100.0 * of, 1))
            }),
            optional(pair.measured.end, |value| fixed(value, 4)),
            optional(pair.simulated.and_then(|half| half.end), |value| fixed(value, 4)),
            optional(pair.delay(), |value| format!("{}\u{a0}ms", fixed(1e3 * value, 2))),
            optional(pair.phase(), |value| format!("{}°", fixed(value, 1))),
        ]
    });
    let table = html_table(
        &[
            "No.",
            "Amplitude measured (°)",
            "Amplitude simulated (°)",
            "Error",
            "Ends measured (s)",
            "Ends simulated (s)",
            "Delay",
            "Phase",
        ],
        rows,
    );
    format!(
        "<section class=\"panel\"><h2>Half-cycles</h2>\n{table}<p class=\"note\">Between the zero crossings of φ. A positive delay: \
         the simulated half-cycle ends later; 180° are a half-cycle.</p></section>\n"
    )
}

fn impacts(comparison: &Comparison) -> String {
    if comparison.impacts.is_empty() {
        return String::new();
    }
    let rows = comparison.impacts.iter().enumerate().map(|(number, pair)| {
        let time =
            |crossing: Option<crate::compare::cycles::Crossing>| optional(crossing.map(|c| c.t), |t| fixed(t, 4));
        let ratio = |crossing: Option<crate::compare::cycles::Crossing>| {
            optional(crossing.and_then(|c| c.kept()), |kept| fixed(kept, 3))
        };
        let delay = pair.measured.zip(pair.simulated).map(|(a, b)| 1e3 * (b.t - a.t));
        vec![
            (number + 1).to_string(),
            time(pair.measured),
            time(pair.simulated),
            optional(delay, |delay| format!("{}\u{a0}ms", fixed(delay, 2))),
            ratio(pair.measured),
            ratio(pair.simulated),
        ]
    });
    let table =
        html_table(&["No.", "Measured (s)", "Simulated (s)", "Delay", "ω⁺/ω⁻ measured", "ω⁺/ω⁻ simulated"], rows);
    format!(
        "<section class=\"panel\"><h2>Impacts</h2>\n{table}<p class=\"note\">Where φ crosses zero. ω before and after by lines \
         through five rows on each side, extrapolated to the crossing, for both motions alike. A dash: only one of the motions \
         has the impact, or there are too few rows.{}</p></section>\n",
        above_one(comparison)
    )
}
