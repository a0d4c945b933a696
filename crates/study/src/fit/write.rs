//! What a fit writes.

use super::confidence::correlated;
use super::{Estimate, Fit, SAME_HORIZON};
use crate::axes::in_seconds;
use crate::compare::{
    Alignment, STYLE, fixed, horizon_note, motion_figures, origin_of_side, other_alignments, outliers, sentences_of,
};
use crate::measured::Sign;
use crate::write::{html_list, html_table, percent, power, short};
use serde_json::{Value, json};
use std::fmt::Write;
use teeter_plot::{AxisError, escaped};
use teeter_report::document;

/// All files that a fit may write; the figures depend on the table.
pub const FILES: [&str; 10] = [
    "fit.json",
    "fit.csv",
    "fit.html",
    "figures/phi.svg",
    "figures/omega.svg",
    "figures/x.svg",
    "figures/y.svg",
    "figures/vx.svg",
    "figures/vy.svg",
    "scene.toml",
];

/// A key whose standard error is more than this share of its range is hardly determined.
const HARDLY: f64 = 0.15;

/// Another minimum with a sum of squares up to so many times the least is told.
const HARDLY_WORSE: f64 = 2.0;

/// Not one by so many standard deviations worse, where what is left is noise.
const CLEARLY_WORSE: f64 = 6.0;

/// Residuals of up to this many times the noise are taken to be noise.
const DESCRIBED: f64 = 1.5;

/// An interval whose sides differ by more than this share of its width is told by its ends.
const UNEVEN: f64 = 0.1;

/// `fit.csv`: all values tried: `stage`, a column for each key (in its unit), `cost` (empty if the run failed).
#[must_use]
pub fn csv(fit: &Fit) -> String {
    let mut text = "stage".to_owned();
    for key in &fit.keys {
        let unit = if key.unit().is_empty() { String::new() } else { format!(" [{}]", key.unit()) };
        let _ = write!(text, ",{}", crate::write::quoted(&format!("{}{unit}", key.key())));
    }
    text.push_str(",cost\n");
    for tried in &fit.evaluations {
        text.push_str(tried.stage);
        for value in &tried.values {
            let _ = write!(text, ",{value:?}");
        }
        text.push(',');
        if tried.cost.is_finite() {
            let _ = write!(text, "{:?}", tried.cost);
        }
        text.push('\n');
    }
    text
}

/// `fit.json`.
#[must_use]
pub fn json(fit: &Fit, scene: &str, measured: &str, block: &str) -> String {
    let estimates: Vec<Value> = fit
        .estimates
        .iter()
        .map(|found| {
            let (low, high) = found.interval();
            json!({
                "name": found.name, "unit": found.unit, "value": found.value, "standard_error": found.standard_error,
                "interval_95": [low, high], "as_good": found.as_good, "with_half_step": found.with_half_step, "at_bound": found.at_bound, "standard_error_share_of_range": found.share_of_range,
            })
        })
        .collect();
    let trade_offs: Vec<Value> = fit
        .trade_offs
        .iter()
        .map(|found| {
            let [a, b] = found.pair.map(|k| fit.estimates[k].name.as_str());
            json!({ "between": [a, b], "correlation": found.correlation })
        })
        .collect();
    let restarts: Vec<Value> =
        fit.restarts.iter().map(|(values, cost)| json!({ "values": values, "cost": cost })).collect();
    let value = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "scene": scene,
        "measured": measured,
        "block": block,
        "values": fit.keys.iter().zip(&fit.values).map(|(key, value)| (key.key().to_owned(), Value::from(key.text(*value)))).collect::<serde_json::Map<_, _>>(),
        "sign": fit.comparison.alignment.sign.factor(),
        "estimates": estimates,
        "correlation": fit.correlation,
        "trade_offs": trade_offs,
        "mean_square_over_noise": fit.cost,
        "residuals": fit.residuals,
        "residual_correlation": fit.residual_correlation,
        "misfit": fit.misfit,
        "is_misfit": fit.is_misfit(),
        "minima_hardly_worse": hardly_worse(fit).map(|(values, cost)| json!({ "values": values, "cost": cost })).collect::<Vec<_>>(),
        "horizon": fit.horizon,
        "finer_step": fit.finer_step.map(|finer| json!({ "step": finer.step, "horizon": finer.horizon })),
        "fitted_until": fit.until,
        "fitted_rows": fit.rows,
        "restarts": restarts,
        "evaluations": fit.evaluations.len(),
    });
    // A value of strings, finite numbers and nulls always serialises.
    serde_json::to_string_pretty(&value).unwrap_or_default() + "\n"
}

/// A unit with the space before it; nothing where there is none.
fn spaced(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}

/// Values outside the intervals at which other starts ended, with hardly more left: where that is noise, hardly more than that can account for.
fn hardly_worse(fit: &Fit) -> impl Iterator<Item = &(Vec<f64>, f64)> {
    let outside = |values: &[f64]| {
        values.iter().zip(&fit.estimates).any(|(value, found)| {
            let (low, high) = found.interval();
            *value < low || *value > high
        })
    };
    let noise = (!fit.is_misfit()).then(|| fit.residuals as f64 / correlated(fit.residual_correlation));
    fit.restarts.iter().skip(1).filter(move |(values, cost)| is_hardly_worse(cost / fit.cost, noise) && outside(values))
}

/// Whether a sum of squares of so many times the least is told, with the number of independent residuals where what is left is noise.
fn is_hardly_worse(times: f64, noise: Option<f64>) -> bool {
    // A difference of χ².
    let clearly = noise.is_some_and(|residuals| (times - 1.0) * residuals > CLEARLY_WORSE * CLEARLY_WORSE);
    times <= HARDLY_WORSE && !clearly
}

/// A value with half of its 95 % interval, to two digits of the standard error; ends that are bounds are named.
fn with_error(found: &Estimate) -> String {
    let Shown { value, error, interval: (low, high), unit } = Shown::of(found);
    let (below, above) = (value - low, high - value);
    let bounds = found.bounds.map(|(least, most)| (low <= least, high >= most)).unwrap_or_default();
    let is_uneven = (above - below).abs() > UNEVEN * (above + below) && (above + below).is_finite();
    if is_uneven || bounds.0 || bounds.1 {
        let decimals = decimals_of(0.25 * (above + below)).unwrap_or(5);
        let [value, from, to] = [value, low, high].map(|value| format!("{value:.decimals$}"));
        return match bounds {
            (true, true) => format!("{value}{unit} (all of its range, {} to {}, 95 %)", power(low), power(high)),
            (true, false) => format!("{value}{unit} (from its bound, {}, to {to}, 95 %)", power(low)),
            (false, true) => format!("{value}{unit} ({from} to its bound, {}, 95 %)", power(high)),
            (false, false) => format!("{value}{unit} ({from} to {to}, 95 %)"),
        };
    }
    let Some(decimals) = decimals_of(error).and(decimals_of(0.25 * (above + below))) else {
        return format!("{}{unit}", short(value));
    };
    format!("{value:.decimals$} ± {:.decimals$}{unit} (95 %)", 0.5 * (above + below))
}

/// An estimate as people read it: angles in degrees, as in the figures.
struct Shown {
    value: f64,
    error: f64,
    interval: (f64, f64),
    /// With the space before it; empty for a pure number.
    unit: String,
}

impl Shown {
    fn of(found: &Estimate) -> Self {
        // Keys have the unit that the user gave.
        let (factor, unit) = match found.unit.as_str() {
            "rad" if found.share_of_range.is_none() => (1f64.to_degrees(), "°".to_owned()),
            "" => (1.0, String::new()),
            unit => (1.0, format!(" {unit}")),
        };
        let (low, high) = found.interval();
        let interval = (factor * low, factor * high);
        Self { value: factor * found.value, error: factor * found.standard_error, interval, unit }
    }

    /// Value, standard error and 95 % interval as cells, each with the unit and to two digits of the error; `range` is that of a key, beyond
    /// which nothing was sought.
    fn cells(&self, range: Option<(f64, f64)>) -> [String; 3] {
        let Self { value, error, interval: (low, high), unit } = self;
        // A standard error beyond the range tells no digits of the value.
        let width = range.map_or(f64::INFINITY, |(least, most)| most - least);
        // Nor do digits of an error that is far within the interval.
        let decimals = decimals_of(error.max(0.25 * (high - low)).min(0.25 * width)).unwrap_or(5);
        let unit = escaped(unit).replace(' ', "\u{a0}");
        let number = |value: f64| fixed(value, decimals);
        let error = match *error {
            error if !error.is_finite() => "–".to_owned(),
            error if error > width => "more than the range".to_owned(),
            // Far smaller than the interval, as where distant values fit as well: its digits would all be zeros.
            error if number(error).parse() == Ok(0.0) => "–".to_owned(),
            error => format!("{}{unit}", number(error)),
        };
        let interval = match range {
            Some((least, most)) if !(*low > least || *high < most) => {
                format!("all of the range, {} to {}{unit}", power(least), power(most))
            }
            _ => format!("{} to {}{unit}", number(*low), number(*high)),
        };
        [format!("{}{unit}", number(*value)), error, interval]
    }
}

fn decimals_of(error: f64) -> Option<usize> {
    (error > 0.0 && error.is_finite()).then(|| (1 - error.log10().floor() as i32).clamp(0, 12) as usize)
}

/// The results in sentences; the first ones are those of the keys.
#[must_use]
pub fn sentences(fit: &Fit) -> Vec<String> {
    let mut texts: Vec<String> = fit
        .estimates
        .iter()
        .filter(|found| found.value.is_finite())
        .map(|found| format!("{} = {}", found.name, with_error(found)))
        .collect();
    for found in &fit.estimates {
        if found.at_bound {
            // Where the motion says nothing, a wider range wouldn't help.
            let remedy = match found.share_of_range {
                Some(share) if !(share <= HARDLY) => "",
                _ => ": widen it",
            };
            texts.push(format!("warning: {} is at the bound of its range{remedy}", found.name));
        }
        if let Some(beyond) = found.beyond_error() {
            let (low, high) = found.interval();
            let decimals = decimals_of(0.25 * (high - low)).unwrap_or(5);
            let text = |value: f64| format!("{value:.decimals$}");
            let (low, high) = beyond;
            let ends =
                [low.map(|end| format!("down to {}", text(end))), high.map(|end| format!("up to {}", text(end)))];
            let (value, range) = (text(found.value), ends.into_iter().flatten().collect::<Vec<_>>().join(" and "));
            texts.push(format!(
                "warning: values of {} {range}{} fit about as well as {value}: the differences are a rough function of it, of which the standard error knows only the neighbourhood",
                found.name,
                spaced(&found.unit),
            ));
        }
        let (low, high) = found.interval();
        if found.share_of_range.is_some() && found.with_half_step.abs() > 0.5 * (high - low) {
            texts.push(format!(
                "warning: half the step would change {} by about {}{}, more than its interval holds: the step is too long for what was \
                 measured",
                found.name,
                short(found.with_half_step),
                spaced(&found.unit)
            ));
        }
        if found.share_of_range.is_some_and(|share| !share.is_finite()) {
            texts.push(format!(
                "warning: near the fitted values the motion doesn’t depend on {}, or only by what the time shift and the origins that are \
                 fitted with it make up for: it isn’t determined",
                found.name
            ));
        } else if found.share_of_range.is_some_and(|share| !(share <= HARDLY)) {
            texts.push(format!(
                "warning: the motion hardly determines {}: its standard error is {} of its range",
                found.name,
                percent(found.share_of_range.unwrap_or(1.0))
            ));
        }
    }
    for found in &fit.trade_offs {
        let [a, b] = found.pair.map(|k| fit.estimates[k].name.as_str());
        let way = if found.correlation > 0.0 { "larger" } else { "smaller" };
        texts.push(format!(
            "warning: {a} and {b} trade off (correlation {:.3}): a larger {a} is made up for by a {way} {b}; the errors of both allow for that",
            found.correlation
        ));
    }
    for (values, cost) in hardly_worse(fit) {
        let pairs = fit.estimates.iter().zip(values).map(|(found, value)| {
            let (low, high) = found.interval();
            let decimals = decimals_of(0.25 * (high - low)).unwrap_or(5);
            format!("{} = {value:.decimals$}{}", found.name, spaced(&found.unit))
        });
        texts.push(format!(
            "warning: there is another minimum that fits hardly worse, {}: it leaves {} times the noise",
            pairs.collect::<Vec<_>>().join(", "),
            short(cost.sqrt())
        ));
    }
    texts.extend(outliers(&fit.comparison));
    let left = fit.cost.sqrt();
    let told = format!("the residuals are {} times the noise of the samples", short(left));
    texts.push(if left > DESCRIBED {
        format!("warning: {told}: the model doesn’t describe all of the motion, and the errors are only as good as the model")
    } else {
        told
    });
    if fit.is_misfit() {
        texts.push(format!(
            "warning: what is left is more than noise ({} standard deviations above it): this is another minimum, or a key that was held has a wrong value; don’t trust the intervals (`--samples` tries more values, `--seed` others)",
            short(fit.misfit)
        ));
    }
    let short_horizon = fit.until < 0.5 * fit.comparison.trace.end();
    let t = &fit.comparison.measured.t;
    let (first, last) = t.first().zip(t.last()).map_or((0.0, f64::INFINITY), |(first, last)| (*first, *last));
    let ends_before = last + (last - first) / t.len() as f64 <= fit.until;
    let cut = match fit.until {
        _ if ends_before => "the last row".to_owned(),
        until if until < fit.comparison.trace.end() => origin_of_end(until, fit.horizon),
        _ => "the end of the run".to_owned(),
    };
    texts.push(format!(
        "{}fitted up to t = {:.3} s ({cut}), {} of {} rows{}",
        if short_horizon || fit.finer_step.is_some() { "warning: " } else { "" },
        if ends_before { last } else { fit.until },
        fit.rows,
        t.len(),
        remedy(fit, short_horizon, ends_before)
    ));
    let Alignment { sign, sign_found, .. } = fit.comparison.alignment;
    texts.push(format!(
        "the measured motion was {} ({})",
        match sign {
            Sign::AsIs => "seen as in the scene: its sign is that of the run",
            Sign::Reversed => "seen from behind: its sign is turned (--sign -1)",
        },
        origin_of_side(sign_found, fit.sign_given)
    ));
    texts.extend(other_alignments(&fit.comparison));
    texts.push("the 95 % intervals hold if the keys that were not varied have the right values".to_owned());
    texts.push(match fit.restarts.get(1) {
        None => format!("all searches ended at these values; {} runs were made", fit.evaluations.len()),
        Some((_, cost)) => format!(
            "the searches ended at {} different sets of values; the second best leaves {} times the noise; {} runs were made",
            fit.restarts.len(),
            short(cost.sqrt()),
            fit.evaluations.len()
        ),
    });
    if fit.residual_correlation > 0.1 {
        texts.push(format!(
            "the residual at one row resembles that at the next (correlation {:.2}): the errors allow for that",
            fit.residual_correlation
        ));
    }
    texts
}

/// What would let more rows count, after a colon; nothing where nothing is known to.
fn remedy(fit: &Fit, short_horizon: bool, ends_before: bool) -> String {
    let at_end = fit.until >= fit.comparison.trace.end() && !ends_before;
    match fit.finer_step {
        Some(finer) => format!(
            ": with a shorter step the motion is predictable up to t = {:.3} s, and late rows narrow the intervals most: fit again with \
             --set time.step=\"{}\" (where the table is itself of a run, that needs this step, too)",
            finer.horizon,
            in_seconds(finer.step)
        ),
        None if short_horizon && fit.horizon <= (1.0 + SAME_HORIZON) * fit.until => {
            ": steps of down to an eighth make hardly more of the motion predictable".to_owned()
        }
        None if short_horizon => {
            ": a shorter step may make more of the motion predictable, as `teeter run --horizon` tells".to_owned()
        }
        None if at_end && (fit.rows as f64) < MOST_ROWS * fit.comparison.measured.t.len() as f64 => {
            ": a run of all rows (--set time.end) takes in the rest".to_owned()
        }
        None => String::new(),
    }
}

/// Why the rows that are fitted end at `until`, s.
fn origin_of_end(until: f64, horizon: f64) -> String {
    if (horizon - until).abs() <= SAME_HORIZON * until {
        "its horizon".to_owned()
    } else if horizon > until {
        format!("the horizon of values fitted to more rows; that of these values is t = {horizon:.3} s")
    } else {
        format!("beyond its horizon, t = {horizon:.3} s, where rows don’t tell much")
    }
}

/// The name of an estimate as HTML: keys as code, broken where their parts end, what is fitted with them in words.
fn name_of(fit: &Fit, number: usize) -> String {
    let name = escaped(&fit.estimates[number].name);
    if number < fit.keys.len() {
        format!("<code>{}</code>", name.replace('.', ".<wbr>").replace('_', "_<wbr>"))
    } else {
        name
    }
}

/// Fewer rows than this part of all are told.
const MOST_ROWS: f64 = 0.9;

/// What came of the fit, at the head of the page.
fn headline(fit: &Fit) -> String {
    let left = fit.cost.sqrt();
    let told = if left > DESCRIBED {
        "The scene doesn’t describe all of the measured motion: what is left is".to_owned()
    } else if fit.is_misfit() {
        format!(
            "The scene is near the measured motion, but what is left is more than noise ({} standard deviations above it), as of another \
             minimum or a wrong value that was held: it is",
            short(fit.misfit)
        )
    } else {
        "The fitted scene describes the measured motion: what is left is".to_owned()
    };
    let rows = fit.comparison.measured.t.len();
    let of_rows = if (fit.rows as f64) < MOST_ROWS * rows as f64 {
        format!(", over {} of {rows} rows", fit.rows)
    } else {
        String::new()
    };
    format!("{told} {} times the noise of the samples{of_rows}", short(left))
}

/// The page.
///
/// # Errors
/// [`AxisError`] if a value can't be shown.
pub fn page(fit: &Fit, title: &str, names: [&str; 3]) -> Result<String, AxisError> {
    let [scene, measured, block] = names;
    let subtitle = format!("{scene} · {measured} · block {block} · teeter {}", env!("CARGO_PKG_VERSION"));
    let mut html = String::new();
    let rows = fit.estimates.iter().enumerate().filter(|(_, found)| found.value.is_finite()).map(|(number, found)| {
        let key = fit.keys.get(number);
        let cells = Shown::of(found).cells(key.map(|key| key.bounds()));
        std::iter::once(name_of(fit, number)).chain(cells).collect()
    });
    let _ = write!(
        html,
        "<p class=\"headline\">{}</p>\n<section class=\"panel\"><h2>Fitted values</h2>\n{}{}</section>\n",
        headline(fit),
        html_table(&["Fitted", "Value", "Standard error", "95 % interval"], rows),
        html_list(&sentences(fit)[fit.estimates.iter().filter(|found| found.value.is_finite()).count()..])
    );
    html.push_str("<section class=\"panel\"><h2>Motion</h2>\n<div class=\"pictures\">\n");
    for (_, figure) in motion_figures(&fit.comparison, fit.before.as_ref(), None)? {
        let _ = writeln!(html, "<div>{figure}</div>");
    }
    html.push_str("</div>");
    html.push_str(horizon_note(&fit.comparison));
    html.push_str("</section>\n<section class=\"panel\"><h2>Correlation of the estimates</h2>\n");
    let heads: Vec<String> = (0..fit.estimates.len()).map(|number| name_of(fit, number)).collect();
    let heading: Vec<&str> = std::iter::once("").chain(heads.iter().map(String::as_str)).collect();
    let rows = fit.correlation.iter().zip(&heads).map(|(row, name)| {
        std::iter::once(name.clone()).chain(row.iter().map(|value| fixed(*value, 3))).collect::<Vec<_>>()
    });
    let _ = write!(
        html,
        "{}<p class=\"note\">Near 1 or −1: the motion determines a combination of the two, not each by itself.</p></section>\n\
         <section class=\"panel\"><h2>How they are compared</h2>\n{}</section>\n",
        html_table(&heading, rows),
        html_list(&sentences_of(&fit.comparison))
    );
    Ok(document(&format!("Fitted to a measured motion: {title}"), &subtitle, STYLE, &html))
}

/// The figures for files, of a width in mm from 60 to 300, with their names.
///
/// # Errors
/// [`AxisError`] if a value can't be shown.
pub fn figures(fit: &Fit, width: f64) -> Result<Vec<(String, String)>, AxisError> {
    motion_figures(&fit.comparison, fit.before.as_ref(), Some(width))
}

#[cfg(test)]
mod tests {
    use super::{Shown, is_hardly_worse};

    #[test]
    fn a_standard_error_that_the_interval_dwarfs_is_no_zero() {
        let cells = |error: f64| {
            Shown { value: 0.658, error, interval: (0.0, 0.8), unit: String::new() }.cells(Some((0.0, 0.8)))
        };
        assert_eq!(cells(0.0011), ["0.66", "–", "all of the range, 0 to 0.8"]);
        assert_eq!(cells(0.02)[1], "0.02");
    }

    #[test]
    fn a_minimum_that_noise_cannot_account_for_is_clearly_worse() {
        // 0.95 against 0.88 of the noise: nothing with 100 residuals, eleven standard deviations with 990.
        let times = (0.95_f64 / 0.88).powi(2);
        assert!(is_hardly_worse(times, Some(100.0)) && !is_hardly_worse(times, Some(990.0)));
        // What a model doesn't describe isn't noise.
        assert!(is_hardly_worse(times, None) && !is_hardly_worse(2.5, None));
    }
}
