//! `compare.html`: a self-contained page in the style of a run's report.

use super::motion_figures;
use crate::compare::{ChannelComparison, Comparison};
use crate::measured::Sign;
use crate::write::{html_list, html_table, percent, short};
use std::fmt::Write;
use teeter_plot::{AxisError, Theme};
use teeter_report::document;

pub(crate) const STYLE: &str = "\
main > section { margin-top: 1.5rem; }\n\
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); gap: 1rem; }\n\
.pictures svg { display: block; width: 100%; height: auto; max-width: 46rem; margin: 0 auto; }\n\
section li { margin: .3rem 0; overflow-wrap: anywhere; }\ncode { font-size: .9em; }\n\
td:first-child { text-align: left; }\n.bar { display: inline-block; height: .6em; background: var(--c0); }\n";

/// A number with so many decimals and a real minus.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}").replace('-', "\u{2212}")
}

fn optional(value: Option<f64>, show: impl Fn(f64) -> String) -> String {
    value.filter(|value| value.is_finite()).map_or("–".to_owned(), show)
}

/// What was found, in sentences.
#[must_use]
pub fn sentences_of(comparison: &Comparison) -> Vec<String> {
    let Comparison { alignment, settings, measured, .. } = comparison;
    let how = |found: bool| if found { "found" } else { "given" };
    let side = match alignment.sign {
        Sign::AsIs => "seen as in the scene",
        Sign::Reversed => "seen from behind: its sign is turned",
    };
    let mut texts = vec![format!(
        "the measured motion at its t = 0 is that of the run at t = {} s ({}), {side} ({})",
        fixed(alignment.shift, 5),
        how(alignment.shift_found),
        how(alignment.sign_found)
    )];
    let rows = &comparison.rows;
    let last = measured.t.get(rows.end.saturating_sub(1)).copied().unwrap_or(0.0);
    let to = format!("{} of {} measured rows are compared, up to t = {} s", rows.len(), measured.t.len(), short(last));
    texts.push(match settings.horizon {
        Some(horizon) if horizon < comparison.trace.end() => {
            format!("{to}: beyond t = {} s the simulated motion isn’t predictable (its horizon)", short(horizon))
        }
        Some(_) => to,
        None => format!("{to}; the horizon of the run is not known: `teeter run --horizon` finds it"),
    });
    texts.push(format!(
        "both motions are sampled at the measured times ({} s apart) and smoothed by parabolas through {} rows; rates are \
         those of the parabolas",
        short(measured.interval()),
        settings.window
    ));
    if let Some(found) = measured.markers {
        texts.push(format!(
            "{} markers fit a rigid body within {} mm (root mean square), at most {} mm at t = {} s of the table",
            found.markers,
            short(1e3 * found.rms),
            short(1e3 * found.max),
            short(found.t)
        ));
    }
    let origins = comparison.channels.iter().filter(|found| found.channel.has_own_origin() && found.is_measured);
    for found in origins {
        let word = found.channel.word();
        texts.push(format!(
            "the origin of {word} is arbitrary: {} mm were added to what was measured",
            fixed(1e3 * found.origin, 2)
        ));
    }
    if alignment.mismatch > 0.1 {
        texts.push(format!(
            "the motions hardly match: with the best alignment their mean square difference is {} of what unrelated motions \
             have",
            percent(alignment.mismatch)
        ));
    }
    texts
}

fn quantity_row(found: &ChannelComparison) -> Vec<String> {
    let (unit, factor) = found.channel.shown();
    let d = found.differences;
    let value = |x: f64| format!("{} {unit}", short(factor * x)).replace('-', "\u{2212}");
    let share = |x: f64| if d.scale > 0.0 { percent(x / d.scale) } else { "–".to_owned() };
    vec![
        found.channel.title().to_owned(),
        value(d.rms),
        share(d.rms),
        value(d.max),
        share(d.max),
        format!("{} s", fixed(d.max_at, 4)),
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
    let mut html = "<section class=\"panel\"><h3>Motion</h3>\n<div class=\"pictures\">\n".to_owned();
    for (_, svg) in motion_figures(comparison, None, Theme::Page)? {
        html.push_str(&svg);
    }
    html.push_str("</div>");
    html.push_str(horizon_note(comparison));
    html.push_str("</section>\n<section class=\"panel\"><h3>Differences</h3>\n");
    html.push_str(&html_table(
        &[
            "Quantity",
            "Root mean square",
            "of the largest",
            "Largest",
            "of the largest",
            "at",
            "Mean",
            "Noise of the samples",
        ],
        comparison.channels.iter().map(quantity_row),
    ));
    html.push_str(
        "<p class=\"note\">Simulated minus measured, over the rows compared; relative to the largest measured value.</p></section>\n",
    );
    html.push_str(&half_cycles(comparison));
    html.push_str(&impacts(comparison));
    let _ = write!(
        html,
        "<section class=\"panel\"><h3>How they are compared</h3>\n{}</section>\n",
        html_list(&sentences_of(comparison))
    );
    Ok(document(&format!("Measured and simulated: {title}"), &subtitle, STYLE, &html))
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
            optional(pair.amplitude_ratio().map(|ratio| 100.0 * (ratio - 1.0)), |value| {
                format!("{} %", fixed(value, 1))
            }),
            optional(pair.measured.end, |value| fixed(value, 4)),
            optional(pair.simulated.and_then(|half| half.end), |value| fixed(value, 4)),
            optional(pair.delay(), |value| format!("{} ms", fixed(1e3 * value, 2))),
            optional(pair.phase(), |value| format!("{}°", fixed(value, 1))),
        ]
    });
    let table = html_table(
        &[
            "No.",
            "Amplitude measured (°)",
            "simulated (°)",
            "Error",
            "Ends measured (s)",
            "simulated (s)",
            "Delay",
            "Phase",
        ],
        rows,
    );
    format!(
        "<section class=\"panel\"><h3>Half-cycles</h3>\n{table}<p class=\"note\">Between the zero crossings of φ. A positive delay: \
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
            optional(delay, |delay| format!("{} ms", fixed(delay, 2))),
            ratio(pair.measured),
            ratio(pair.simulated),
        ]
    });
    let table =
        html_table(&["No.", "Measured (s)", "Simulated (s)", "Delay", "ω⁺/ω⁻ measured", "ω⁺/ω⁻ simulated"], rows);
    format!(
        "<section class=\"panel\"><h3>Impacts</h3>\n{table}<p class=\"note\">Where φ crosses zero. ω before and after by lines \
         through five rows on each side, extrapolated to the crossing, for both motions alike. A dash: only one of the motions \
         has the impact, or there are too few rows.</p></section>\n"
    )
}
