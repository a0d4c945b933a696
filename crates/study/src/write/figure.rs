//! Error over time, both logarithmic, as SVG: one figure per quantity.

use super::short;
use crate::{Quantity, Tradeoff, pareto_front};
use teeter_plot::{Axis, AxisError, Figure, Legend, Mark, Panel, Series, Theme};

/// Errors below this are rounding: drawn at the bottom.
const LEAST: f64 = 1e-15;

/// Times below the resolution of clocks, drawn at the left, s.
const SHORTEST: f64 = 1e-9;

/// Height of the plot, mm.
const HEIGHT: f64 = 57.0;

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
}

/// The figures for files, with their names: one for each quantity of the scene.
///
/// # Errors
/// [`AxisError`] if a measured time or error can't be shown on a logarithmic axis.
pub fn figures(study: &Tradeoff) -> Result<Vec<(String, String)>, AxisError> {
    themed(study, Theme::Paper)
}

/// The figures in the colours of files or of pages.
pub(super) fn themed(study: &Tradeoff, theme: Theme) -> Result<Vec<(String, String)>, AxisError> {
    let shown = Quantity::ALL.into_iter().map(|quantity| (quantity, points(study, quantity)));
    let figure = |(quantity, points): (Quantity, Vec<Point>)| {
        Ok((format!("{}.svg", quantity.word()), figure(study, quantity, &points)?.theme(theme).to_svg()))
    };
    shown.filter(|(_, points)| !points.is_empty()).map(figure).collect()
}

fn points(study: &Tradeoff, quantity: Quantity) -> Vec<Point> {
    let axes = &study.axes;
    let point = |row: &crate::Row| {
        let error = row.result.as_ref().ok()?.errors.of(quantity).filter(|error| error.is_finite())?;
        let scheme = axes.scheme.part_of(&row.setting);
        Some(Point {
            time: row.measured()?.max(SHORTEST),
            error: error.max(LEAST),
            scheme: axes.scheme.options.iter().position(|option| *option == scheme)?,
            plain: axes.grid.iter().chain(&axes.others).all(|axis| axis.part_of(&row.setting).is_none()),
        })
    };
    study.rows.iter().filter_map(point).collect()
}

fn figure(study: &Tradeoff, quantity: Quantity, points: &[Point]) -> Result<Figure, AxisError> {
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
    let mut series = vec![Series::staircase("least error within the time", steps, x.ends().1).number(BLACK)];
    let axis = &study.axes.scheme;
    for (number, option) in axis.options.iter().enumerate() {
        let name = axis.keys.first().and_then(|key| option.get(key)).unwrap_or(study.scheme.as_str());
        let of = |plain: bool| {
            let ours = points.iter().filter(move |point| point.scheme == number && point.plain == plain);
            ours.map(move |point| (ms(point), point.error))
        };
        let mark = Mark::of(number);
        series.push(Series::marks(name, of(true), mark).number(number));
        series.push(Series::marks("", of(false), mark).number(number).hollow());
    }
    series.push(Series::marks("hollow: other keys changed too", [], Mark::Circle).number(BLACK).hollow());
    let mut panel = Panel::new(y).with(series).height_mm(HEIGHT);
    if let Some(bar) = bar {
        panel = panel.shaded_below(bar, format!("the reference is known to {}", short(bar)));
    }
    let title = format!("{}: error over CPU time", quantity.title());
    Ok(Figure::new(quantity.word(), title, x).legend(Legend::Rows).panel(panel))
}
