//! The records that prescribe motions: their figures, and their section of the page.

use super::content::largest;
use super::curves::Curves;
use super::panels::{Unit, length_unit};
use super::recorder::PageRecorder;
use super::rounded;
use super::widths::{SIDE_BY_SIDE, for_any_width};
use crate::driven::Driven;
use crate::summary::RecordSummary;
use std::fmt::Write;
use std::sync::Arc;
use teeter_plot::{Axis, Figure, Legend, Panel, Series, escaped};
use teeter_record::Record;
use teeter_scenario::scene::{LengthUnit, RecordScene};

/// Damping ratio of the response spectra.
const DAMPING_RATIO: f64 = 0.05;

/// Natural periods of the spectra, s: the ends, and how many, evenly on a logarithmic axis.
const PERIODS: ([f64; 2], usize) = ([0.02, 10.0], 150);

/// Most pieces of time of which a drawn curve has the least and the largest value.
const PIECES: usize = 1200;

/// Units of lengths and velocities in the figures and the table of a record's own page.
const ALONE: [LengthUnit; 2] = [LengthUnit::Millimetre, LengthUnit::Metre];

/// Acceleration, velocity and displacement over time, with lengths in the scene's unit; `None` without records.
pub(super) fn histories(records: &[Arc<RecordScene>], [length, velocity]: [LengthUnit; 2]) -> Option<Figure> {
    let end = records.iter().map(|of| of.record.duration()).reduce(f64::max)?;
    let motions: Vec<_> = records.iter().map(|of| of.record.motion()).collect();
    let (fastest, farthest) = motions
        .iter()
        .fold((0.0_f64, 0.0_f64), |(v, d), (speeds, ways)| (v.max(largest(speeds)), d.max(largest(ways))));
    let ((v, per_v), (d, per_d)) = (readable(velocity, fastest), readable(length, farthest));
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
        .panel(panel(&format!("Velocity v ({v}/s)"), per_v, &|k| motions[k].0.clone()))
        .panel(panel(&format!("Displacement d ({d})"), per_d, &|k| motions[k].1.clone()));
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
    let figures = [("records.svg", histories(records, ALONE)), ("spectra.svg", spectra(records, ALONE[0]))];
    figures
        .into_iter()
        .filter_map(|(name, figure)| Some((name.to_owned(), figure?.width_mm(width_mm).to_svg())))
        .collect()
}

/// A self-contained page of a record in the style of a run's report, headed by its event and station where the file names them, or
/// else by `file`; `corrections` says how it was corrected.
#[must_use]
pub fn record_page(record: &Arc<RecordScene>, file: &str, corrections: &str) -> String {
    let named = event_and_station(record.record.station(), record.record.description());
    let (title, subtitle) = match &named {
        Some(named) => (named.as_str(), format!("{file} · {corrections}")),
        None => (file, corrections.to_owned()),
    };
    let section = section(std::slice::from_ref(record), &[RecordSummary::new(record)], None);
    super::document(title, &subtitle, RECORD_STYLE, &section)
}

/// What the header of a file says of a record; `None` if it says nothing.
fn event_and_station(station: &str, description: &str) -> Option<String> {
    let [station, description] =
        [station, description].map(|text| text.split_whitespace().collect::<Vec<_>>().join(" "));
    match (station.is_empty(), description.is_empty()) {
        (true, true) => None,
        (false, true) => Some(station),
        // PEER's description has the station in it.
        (_, false) if description.contains(&station) => Some(description),
        _ => Some(format!("{station}, {description}")),
    }
}

/// A displacement at the end of more than this part of its peak is told: records are of motions that come to rest.
const DRIFTS: f64 = 0.5;

/// What a reader of a record's own page should know of it.
fn remarks(record: &Record) -> Vec<String> {
    let mut remarks = Vec::new();
    if record.assumes_its_unit() {
        remarks.push("The file names no unit: its values are taken as m/s²; --unit gives another.".to_owned());
    }
    let ([_, last], peak) = (record.at_the_end(), record.displacement_peak().size);
    if last.abs() > DRIFTS * peak {
        remarks.push(format!(
            "The record drifts: its displacement at the end is {:.0} % of its peak. A correction of the baseline takes this out \
             (--baseline linear, or baseline = \"linear\" in a scene), unless the ground itself was displaced for good.",
            100.0 * last.abs() / peak
        ));
    }
    remarks
}

/// Histories and spectra side by side where there is room.
const RECORD_STYLE: &str = "#records { margin-top: 1.25rem; }\n\
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); gap: 1rem; align-items: start; }\n";

/// Response spectra over the natural period, with lengths in the scene's unit; `None` without records.
pub(super) fn spectra(records: &[Arc<RecordScene>], length: LengthUnit) -> Option<Figure> {
    let [low, high] = PERIODS.0;
    let periods = spectrum_periods();
    // A spectrum at periods of a thousandth of the record's step is refused: the ground's own.
    let responses: Vec<_> = records.iter().filter_map(|of| of.record.spectrum(DAMPING_RATIO, &periods).ok()).collect();
    if responses.is_empty() || responses.len() < records.len() {
        return None;
    }
    let farthest = responses.iter().flatten().fold(0.0, |most: f64, response| most.max(response.displacement));
    let (unit, per_metre) = readable(length, farthest);
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
        .panel(panel(&format!("Displacement S_d ({unit})"), &|response| per_metre * response.displacement));
    Some(figure)
}

/// The scene's unit of length with its number to a metre, or one that makes readable numbers where that would begin with zeros.
fn readable(unit: LengthUnit, size: f64) -> Unit {
    let own = (unit.word(), unit.per_metre());
    if size * own.1 >= 0.01 { own } else { length_unit(unit, size) }
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

/// A measure of a record.
struct Measure {
    name: &'static str,
    unit: &'static str,
    value: fn(&RecordSummary, &Record) -> f64,
    /// Whether the page of a run has it, too, and not only that of the record alone.
    in_report: bool,
}

impl Measure {
    const fn of(name: &'static str, unit: &'static str, value: fn(&RecordSummary, &Record) -> f64) -> Self {
        Self { name, unit, value, in_report: true }
    }

    const fn alone(name: &'static str, unit: &'static str, value: fn(&RecordSummary, &Record) -> f64) -> Self {
        Self { name, unit, value, in_report: false }
    }
}

/// The unit of Arias intensities, by which they are known.
const ARIAS: &str = "m/s";

/// The unit of velocities, whose length is chosen as that of lengths is.
const VELOCITY: &str = "/s";

/// The measure that only a run shorter than a record has.
const IN_RUN: &str = "PGA of the part that was run";

/// What the table says of a record.
const MEASURES: [Measure; 13] = [
    Measure::of("Duration", "s", |of, _| of.duration),
    Measure::of("Peak acceleration (PGA)", "m/s²", |of, _| of.peak_acceleration),
    Measure::of(IN_RUN, "m/s²", |of, _| of.peak_acceleration_in_run.unwrap_or(of.peak_acceleration)),
    Measure::alone("Time of the peak acceleration", "s", |_, record| record.acceleration_peak().time),
    Measure::of("Peak velocity (PGV)", VELOCITY, |of, _| of.peak_velocity),
    Measure::alone("Time of the peak velocity", "s", |_, record| record.velocity_peak().time),
    Measure::of("Peak displacement (PGD)", "m", |of, _| of.peak_displacement),
    Measure::alone("Time of the peak displacement", "s", |_, record| record.displacement_peak().time),
    Measure::of("Arias intensity", ARIAS, |of, _| of.arias_intensity),
    Measure::alone("Arias intensity by the plain sum over the values", ARIAS, |_, record| record.arias_sum()),
    Measure::of("Significant duration, 5–95 %", "s", |of, _| of.significant_duration),
    Measure::alone("Velocity at the end", VELOCITY, |_, record| record.at_the_end()[0]),
    Measure::alone("Displacement at the end", "m", |_, record| record.at_the_end()[1]),
];

/// What the page of a run has around its records.
pub(super) struct OfRun {
    /// The scene's unit of length.
    pub(super) length: LengthUnit,
    /// Whether its plots of what moves the ground and supports already show the records over time.
    pub(super) drawn: bool,
}

/// Records differ from what they drive by less than this part of their peaks, or it isn't all of them.
const SAME: f64 = 0.02;

/// Whether the plots of prescribed motions, over the run, show all records: their whole lengths and peaks.
pub(super) fn are_drawn(recorder: &PageRecorder, curves: &Curves) -> bool {
    let end = curves.borders().last().copied().unwrap_or(0.0);
    let is_drawn = |of: &Arc<RecordScene>| {
        let (speeds, ways) = of.record.motion();
        let peaks = [largest(&ways), largest(&speeds), largest(of.record.accelerations())];
        let shows = |(which, driven): (usize, &Driven)| {
            let first = recorder.scenery.driven_column(which);
            let axis = ["x", "y", "rotation"][driven.component];
            let is_named = in_words(&of.path) == format!("{} {axis}", driven.name.trim_end_matches(".support"));
            let near = |(k, peak): (usize, &f64)| (largest(&curves.curve(first + k)) - peak).abs() <= SAME * peak;
            is_named && peaks.iter().enumerate().all(near)
        };
        end >= of.record.duration() && recorder.scenery.driven.iter().enumerate().any(shows)
    };
    recorder.scenery.records.iter().all(is_drawn)
}

/// The section of the page with a table of measures and the figures; empty without records. The page of a run names each with the motion that
/// it drives and its file, which a page of one record has in its title.
pub(super) fn section(records: &[Arc<RecordScene>], summaries: &[RecordSummary], of_run: Option<OfRun>) -> String {
    let named = of_run.is_some();
    let units = of_run.as_ref().map_or(ALONE, |of_run| [of_run.length; 2]);
    let mut html = String::new();
    let Some(histories) = histories(records, units) else { return html };
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
    let is_cut = summaries.iter().any(|of| of.peak_acceleration_in_run.is_some());
    let measures = MEASURES.iter().filter(|of| (of.in_report || !named) && (of.name != IN_RUN || is_cut));
    for Measure { name, unit, value, .. } in measures {
        let values: Vec<f64> = summaries.iter().zip(records).map(|(of, record)| value(of, &record.record)).collect();
        let ((unit, factor), per) = match *unit {
            "m" => (readable(units[0], largest(&values)), ""),
            VELOCITY => (readable(units[1], largest(&values)), VELOCITY),
            unit => ((unit, 1.0), ""),
        };
        let _ = write!(html, "<tr><th scope=\"row\">{name} <span class=\"unit\">({unit}{per})</span></th>");
        for value in values {
            let shown = rounded(factor * value, 4).to_string().replace('-', "\u{2212}");
            let _ = write!(html, "<td>{shown}</td>");
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody></table></div>\n");
    for of in summaries.iter().filter(|of| named && !of.description.is_empty()) {
        let _ = writeln!(html, "<p class=\"note\">{}: {}</p>", escaped(&of.file), escaped(&of.description));
    }
    for remark in records.iter().filter(|_| !named).flat_map(|of| remarks(&of.record)) {
        let _ = writeln!(html, "<p class=\"note\">{}</p>", escaped(&remark));
    }
    html.push_str("<div class=\"pictures\">\n");
    let histories = Some(histories).filter(|_| !of_run.as_ref().is_some_and(|of_run| of_run.drawn));
    for figure in [histories, spectra(records, units[0])].into_iter().flatten() {
        let _ = writeln!(html, "<div>{}</div>", for_any_width(&figure.legend(Legend::Rows), SIDE_BY_SIDE));
    }
    html.push_str("</div></section>\n");
    html
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_headed_by_what_its_header_says() {
        let head = |station, description| event_and_station(station, description);
        assert_eq!(head("El Somewhere", "Event, 1979,  El Somewhere, 230").unwrap(), "Event, 1979, El Somewhere, 230");
        assert_eq!(head("Here", "None, 2000").unwrap(), "Here, None, 2000");
        assert_eq!((head("Here", ""), head("", " ")), (Some("Here".to_owned()), None));
    }

    #[test]
    fn a_record_that_drifts_is_told() {
        let drift = Record::new("", 0.01, vec![1.0; 100]).unwrap();
        assert!(remarks(&drift).iter().any(|text| text.contains("100 % of its peak")));
        // There and back again.
        let wave = (0..=400).map(|k| (0.1 * std::f64::consts::PI * f64::from(k)).sin() * f64::from(200 - k).signum());
        let still = Record::new("", 0.01, wave.collect()).unwrap();
        let [_, last] = still.at_the_end();
        assert!(last.abs() < 0.1 * still.displacement_peak().size && remarks(&still).is_empty(), "{last}");
    }

    #[test]
    fn lengths_are_in_the_unit_of_the_scene_unless_that_makes_zeros_alone() {
        assert_eq!(readable(LengthUnit::Metre, 0.3686), ("m", 1.0));
        assert_eq!(readable(LengthUnit::Metre, 1.67e-6), ("µm", 1e6));
        assert_eq!(readable(LengthUnit::Millimetre, 0.1954), ("mm", 1e3));
    }

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
