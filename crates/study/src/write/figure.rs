//! Error over time, both logarithmic, as SVG: one figure per quantity.

use super::{percent, short};
use crate::{Advice, Quantity, TARGETS, Tradeoff, pareto_front};
use teeter_plot::{Axis, AxisError, Figure, Legend, Mark, Panel, Series};
use teeter_report::for_any_width;

/// Errors below this are rounding: drawn at the bottom.
const LEAST: f64 = 1e-15;

/// Times below the resolution of clocks, drawn at the left, s.
const SHORTEST: f64 = 1e-9;

/// Height of the plot in files and on the page, mm.
const HEIGHTS: [f64; 2] = [57.0, 84.0];

/// Width of the figures on the page where there is room, mm.
const ON_PAGE: f64 = 174.0;

/// Index of the colour black, for series that belong to no scheme.
const BLACK: usize = 6;

/// A candidate in the figure.
struct Point {
    /// CPU time, s.
    time: f64,
    error: f64,
    scheme: usize,
    /// Whether only scheme and step are changed.
    plain: bool,
    /// Whether it has warnings, and so isn't advised.
    warned: bool,
    /// Number of its row.
    row: usize,
}

/// The figures for files, of a width in mm from 60 to 300, with their names: one for each quantity of the scene.
///
/// # Errors
/// [`AxisError`] if a measured time or error can't be shown on a logarithmic axis.
pub fn figures(study: &Tradeoff, width: f64) -> Result<Vec<(String, String)>, AxisError> {
    let named = themed(study, Some(width))?.into_iter();
    Ok(named.map(|(quantity, svg)| (format!("{}.svg", quantity.word()), svg)).collect())
}

/// The figures for files of a width, mm, or without one as HTML for pages, which have a legend of their own.
pub(super) fn themed(study: &Tradeoff, width: Option<f64>) -> Result<Vec<(Quantity, String)>, AxisError> {
    let shown = Quantity::ALL.into_iter().map(|quantity| (quantity, points(study, quantity)));
    let figure = |(quantity, points): (Quantity, Vec<Point>)| {
        let figure = figure(study, quantity, &points, width.is_some())?;
        let svg = match width {
            Some(width) => figure.width_mm(width).to_svg(),
            None => for_any_width(&figure, ON_PAGE),
        };
        Ok((quantity, svg))
    };
    shown.filter(|(_, points)| !points.is_empty()).map(figure).collect()
}

/// The names of the schemes, in the order of their colours and marks.
pub(super) fn schemes(study: &Tradeoff) -> Vec<&str> {
    let axis = &study.axes.scheme;
    axis.options
        .iter()
        .map(|option| axis.keys.first().and_then(|key| option.get(key)).unwrap_or(study.scheme.as_str()))
        .collect()
}

fn points(study: &Tradeoff, quantity: Quantity) -> Vec<Point> {
    let axes = &study.axes;
    let point = |(number, row): (usize, &crate::Row)| {
        let error = row.result.as_ref().ok()?.errors.of(quantity).filter(|error| error.is_finite())?;
        let scheme = axes.scheme.part_of(&row.setting);
        Some(Point {
            time: row.measured()?.max(SHORTEST),
            error: error.max(LEAST),
            scheme: axes.scheme.options.iter().position(|option| *option == scheme)?,
            plain: axes.grid.iter().chain(&axes.others).all(|axis| axis.part_of(&row.setting).is_none()),
            warned: study.is_warned(row),
            row: number,
        })
    };
    study.rows.iter().enumerate().filter_map(point).collect()
}

/// The points that are advised, each with the accuracies it is advised for.
fn advised(study: &Tradeoff, points: &[Point]) -> Vec<(f64, f64, String)> {
    let targets_of = |row: usize| {
        let takes = |advice: &Advice| matches!(advice, Advice::Take { row: taken, .. } if *taken == row);
        let targets = TARGETS.iter().zip(&study.advice).filter(|(_, advice)| takes(advice));
        targets.map(|(target, _)| percent(*target)).collect::<Vec<_>>()
    };
    let label = |point: &Point| {
        let targets = targets_of(point.row);
        (!targets.is_empty()).then(|| (1e3 * point.time, point.error, format!("for {}", targets.join(", "))))
    };
    points.iter().filter_map(label).collect()
}

fn figure(study: &Tradeoff, quantity: Quantity, points: &[Point], has_legend: bool) -> Result<Figure, AxisError> {
    let named = |text: &str| if has_legend { text.to_owned() } else { String::new() };
    let ms = |point: &Point| 1e3 * point.time;
    let bar = Some(study.reference.bar_of(quantity)).filter(|bar| *bar > 0.0);
    let x = Axis::logarithmic("CPU time of the run (ms)", points.iter().map(ms))?;
    let y = Axis::logarithmic(
        format!("{}, relative error", quantity.title()),
        points.iter().map(|point| point.error).chain(bar),
    )?;
    // The smallest error achievable within each time.
    let all: Vec<(f64, f64)> = points.iter().map(|point| (ms(point), point.error)).collect();
    let steps = pareto_front(&all).into_iter().map(|k| all[k]);
    let mut series = vec![Series::staircase(named("least error within the time"), steps, x.ends().1).number(BLACK)];
    for (number, name) in schemes(study).into_iter().enumerate() {
        let of = |plain: bool, warned: bool| {
            let ours =
                points.iter().filter(move |point| (point.scheme, point.plain, point.warned) == (number, plain, warned));
            ours.map(move |point| (ms(point), point.error))
        };
        let mark = Mark::of(number);
        series.push(Series::marks(named(name), of(true, false), mark).number(number));
        series.push(Series::marks("", of(false, false), mark).number(number).hollow());
        series.push(Series::marks("", of(true, true), mark).number(number).faint());
        series.push(Series::marks("", of(false, true), mark).number(number).hollow().faint());
    }
    if points.iter().any(|point| point.warned) {
        series.push(Series::marks(named("pale: with warnings, not advised"), [], Mark::Circle).number(BLACK).faint());
    }
    series.push(Series::marks(named("hollow: other keys changed too"), [], Mark::Circle).number(BLACK).hollow());
    let mut panel =
        Panel::new(y).with(series).labels(advised(study, points)).height_mm(HEIGHTS[usize::from(!has_legend)]);
    if let Some(bar) = bar {
        panel = panel.shaded_below(bar, named(&format!("the reference is known to {}", short(bar))));
    }
    let title = format!("{}: error over CPU time", quantity.title());
    Ok(Figure::new(quantity.word(), title, x).legend(Legend::Rows).panel(panel))
}
