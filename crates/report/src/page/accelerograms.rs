//! The records that prescribe motions: their figures, and their section of the page.

use super::rounded;
use super::widths::{SIDE_BY_SIDE, for_any_width};
use crate::summary::RecordSummary;
use std::fmt::Write;
use std::sync::Arc;
use teeter_plot::{Axis, Figure, Legend, Panel, Series, escaped};
use teeter_scenario::scene::RecordScene;

/// Damping ratio of the response spectra.
const DAMPING_RATIO: f64 = 0.05;

/// Natural periods of the spectra, s: the ends, and how many, evenly on a logarithmic axis.
const PERIODS: ([f64; 2], usize) = ([0.02, 10.0], 150);

/// Most pieces of time of which a drawn curve has the least and the largest value.
const PIECES: usize = 1200;

/// Acceleration, velocity and displacement over time; `None` without records.
pub(super) fn histories(records: &[Arc<RecordScene>]) -> Option<Figure> {
    let end = records.iter().map(|of| of.record.duration()).reduce(f64::max)?;
    let motions: Vec<_> = records.iter().map(|of| of.record.motion()).collect();
    let panel = |label: &str, factor: f64, values: &dyn Fn(usize) -> Vec<f64>| {
        let line = |(k, of): (usize, &Arc<RecordScene>)| {
            let values = values(k).into_iter().map(|y| factor * y).collect::<Vec<_>>();
            Series::line(name(records, k), thinned(of.record.dt(), &values)).number(k)
        };
        let lines: Vec<Series> = records.iter().enumerate().map(line).collect();
        let heights = lines.iter().flat_map(Series::points).map(|point| point.1);
        let axis = Axis::around(label, heights.collect::<Vec<_>>(), 1e-9);
        Panel::new(axis).with(lines)
    };
    let x = Axis::between("Time since the start of the record t (s)", 0.0, end);
    let figure = Figure::new("records", "Recorded acceleration, with the velocity and displacement from rest", x)
        .panel(panel("Acceleration a (m/s²)", 1.0, &|k| records[k].record.accelerations().to_vec()))
        .panel(panel("Velocity v (m/s)", 1.0, &|k| motions[k].0.clone()))
        .panel(panel("Displacement d (mm)", 1e3, &|k| motions[k].1.clone()));
    Some(figure)
}

/// Natural periods of the spectra, s: from 0.02 to 10, evenly on a logarithmic axis.
#[must_use]
pub fn spectrum_periods() -> Vec<f64> {
    let ([low, high], count) = PERIODS;
    (0..count).map(|k| low * (high / low).powf(k as f64 / (count - 1) as f64)).collect()
}

/// The figures of a record for files, of this width (mm, from 60 to 300): `records.svg`, its motion over time, and
/// `spectra.svg`, its response spectrum.
#[must_use]
pub fn record_figures(record: &Arc<RecordScene>, width_mm: f64) -> Vec<(String, String)> {
    let records = std::slice::from_ref(record);
    let figures = [("records.svg", histories(records)), ("spectra.svg", spectra(records))];
    figures
        .into_iter()
        .filter_map(|(name, figure)| Some((name.to_owned(), figure?.width_mm(width_mm).to_svg())))
        .collect()
}

/// A self-contained page of a record in the style of a run's report; `subtitle` says how it was
/// corrected.
#[must_use]
pub fn record_page(record: &Arc<RecordScene>, title: &str, subtitle: &str) -> String {
    let section = section(std::slice::from_ref(record), &[RecordSummary::new(record)], false);
    super::document(title, subtitle, RECORD_STYLE, &section)
}

/// Histories and spectra side by side where there is room.
const RECORD_STYLE: &str = "#records { margin-top: 1.25rem; }\n\
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); gap: 1rem; align-items: start; }\n";

/// Response spectra over the natural period; `None` without records.
pub(super) fn spectra(records: &[Arc<RecordScene>]) -> Option<Figure> {
    let [low, high] = PERIODS.0;
    let periods = spectrum_periods();
    // A spectrum at periods of a thousandth of the record's step is refused: the ground's own.
    let responses: Vec<_> = records.iter().filter_map(|of| of.record.spectrum(DAMPING_RATIO, &periods).ok()).collect();
    if responses.is_empty() || responses.len() < records.len() {
        return None;
    }
    let panel = |label: &str, of: &dyn Fn(&teeter_record::Response) -> f64| {
        let line = |k: usize| {
            let points = responses[k].iter().map(|response| (response.period, of(response)));
            Series::line(name(records, k), points.collect::<Vec<_>>()).number(k)
        };
        let lines: Vec<Series> = (0..records.len()).map(line).collect();
        let heights = lines.iter().flat_map(Series::points).map(|point| point.1);
        let axis = Axis::around(label, heights.chain([0.0]).collect::<Vec<_>>(), 1e-9);
        Panel::new(axis).with(lines).note(format!("damping ratio {} %", 100.0 * DAMPING_RATIO))
    };
    // From end to end: the range is chosen, not found in values.
    let x = Axis::logarithmic_between("Natural period T (s)", low, high);
    let title = "Response spectra of the records, damping ratio 5 %: pseudo-acceleration and relative displacement";
    let figure = Figure::new("spectra", title, x)
        .panel(panel("Pseudo-acceleration S_a (m/s²)", &teeter_record::Response::pseudo_acceleration))
        .panel(panel("Displacement S_d (mm)", &|response| 1e3 * response.displacement));
    Some(figure)
}

/// The name of a record in a legend; empty for a single one.
fn name(records: &[Arc<RecordScene>], k: usize) -> String {
    if records.len() > 1 { in_words(&records[k].path) } else { String::new() }
}

/// What a record moves, of a table of the scene such as `ground.motion.x`: ground x, as in other legends.
fn in_words(path: &str) -> String {
    match path.strip_prefix("beam.").unwrap_or(path).rsplit_once(".motion.") {
        Some((of, axis)) => format!("{of} {axis}"),
        None => path.to_owned(),
    }
}

/// The points of a curve, evenly spaced by `dt` (s): of a long one the least and the largest value
/// of each piece, in their order.
fn thinned(dt: f64, values: &[f64]) -> Vec<(f64, f64)> {
    let point = |k: usize| (k as f64 * dt, values[k]);
    if values.len() <= 2 * PIECES {
        return (0..values.len()).map(point).collect();
    }
    let mut points = Vec::with_capacity(2 * PIECES + 2);
    let length = values.len().div_ceil(PIECES);
    for start in (0..values.len()).step_by(length) {
        let piece = start..(start + length).min(values.len());
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        if let (Some(low), Some(high)) = (piece.clone().min_by(by_value), piece.max_by(by_value)) {
            points.push(point(low.min(high)));
            if low != high {
                points.push(point(low.max(high)));
            }
        }
    }
    points
}

/// A measure of a record: its name and unit.
type Measure = (&'static str, &'static str, fn(&RecordSummary) -> f64);

/// What the table says of a record.
const MEASURES: [Measure; 6] = [
    ("Duration", "s", |of| of.duration),
    ("Peak acceleration (PGA)", "m/s²", |of| of.peak_acceleration),
    ("Peak velocity (PGV)", "m/s", |of| of.peak_velocity),
    ("Peak displacement (PGD)", "m", |of| of.peak_displacement),
    ("Arias intensity", "m/s", |of| of.arias_intensity),
    ("Significant duration, 5–95 %", "s", |of| of.significant_duration),
];

/// The section of the page with a table of measures and both figures; empty without records. `named`: each with the motion that it
/// drives and its file, which a page of one record has in its title.
pub(super) fn section(records: &[Arc<RecordScene>], summaries: &[RecordSummary], named: bool) -> String {
    let mut html = String::new();
    let Some(histories) = histories(records) else { return html };
    // The only section of a page, or one beside the plots.
    let level = if named { "h3" } else { "h2" };
    let _ = write!(
        html,
        "<section id=\"records\" class=\"panel\" aria-labelledby=\"records-title\">\n<{level} id=\"records-title\">Recorded \
         accelerations</{level}>\n<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-labelledby=\"records-title\"><table>\n",
    );
    // A column for each: of the few that a scene has, this is narrow enough for a telephone.
    if named {
        html.push_str("<thead><tr><th scope=\"col\">Record</th>");
        for of in summaries {
            let (motion, name, file) = (escaped(&of.motion), escaped(&in_words(&of.motion)), escaped(&of.file));
            let _ = write!(html, "<th scope=\"col\" data-record=\"{motion}\">{name}<br><small>{file}</small></th>");
        }
        html.push_str("</tr></thead>\n");
    }
    html.push_str("<tbody>\n");
    for (what, unit, value) in MEASURES {
        let _ = write!(html, "<tr><th scope=\"row\">{what} <span class=\"unit\">({unit})</span></th>");
        for of in summaries {
            let _ = write!(html, "<td>{}</td>", rounded(value(of), 4));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody></table></div>\n");
    for of in summaries.iter().filter(|of| named && !of.description.is_empty()) {
        let _ = writeln!(html, "<p class=\"note\">{}: {}</p>", escaped(&of.file), escaped(&of.description));
    }
    html.push_str("<div class=\"pictures\">\n");
    for figure in [Some(histories), spectra(records)].into_iter().flatten() {
        let _ = writeln!(html, "<div>{}</div>", for_any_width(&figure.legend(Legend::Rows), SIDE_BY_SIDE));
    }
    html.push_str("</div></section>\n");
    html
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_named_by_what_it_moves() {
        assert_eq!(in_words("ground.motion.x"), "ground x");
        assert_eq!(in_words("beam.table.motion.y"), "table y");
    }

    #[test]
    fn a_long_curve_is_thinned_without_losing_its_extremes() {
        let mut values: Vec<f64> = (0..50_000).map(|k| f64::from(k % 7)).collect();
        (values[31_234], values[41_001]) = (99.0, -99.0);
        let points = thinned(0.01, &values);
        assert!(points.len() <= 2 * PIECES + 2, "{}", points.len());
        assert!(points.contains(&(31_234.0 * 0.01, 99.0)) && points.contains(&(41_001.0 * 0.01, -99.0)));
        assert!(points.windows(2).all(|two| two[0].0 < two[1].0));
        assert_eq!(thinned(0.5, &[1.0, 2.0]), [(0.0, 1.0), (0.5, 2.0)]);
    }
}
