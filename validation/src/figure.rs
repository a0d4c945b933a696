//! Figures as SVG: the only file that knows the plotting crate.

use crate::case::Result;
use plotters::coord::combinators::IntoLogRange;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

/// A figure of the page.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// Its file's name.
    pub(crate) file: &'static str,
    /// The line above it.
    pub(crate) title: &'static str,
    /// The axes, with units.
    pub(crate) x: &'static str,
    /// See `x`.
    pub(crate) y: &'static str,
    /// How both axes go.
    pub(crate) axes: Axes,
    /// Where nothing is drawn.
    pub(crate) legend: Corner,
    /// The sentence below it on the page.
    pub(crate) caption: &'static str,
    /// What it shows; a line takes the colour of the marks before it.
    pub(crate) series: Vec<Series>,
}

/// How the axes of a figure go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axes {
    /// Both by powers of ten.
    Logarithmic,
    /// Both evenly, with zero where it is near.
    Linear,
    /// x by powers of ten, y evenly.
    LogarithmicX,
}

/// The corner that the legend takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Corner {
    LowerLeft,
    LowerRight,
    UpperLeft,
}

/// Points of one kind.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    name: String,
    points: Vec<(f64, f64)>,
    drawn: Drawn,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Drawn {
    Marks,
    /// A line that takes the colour of the marks before it.
    Line,
    /// A line with a colour of its own.
    Curve,
}

impl Series {
    /// Measured points.
    pub(crate) fn marks(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, drawn: Drawn::Marks }
    }

    /// A curve with a colour of its own.
    pub(crate) fn curve(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, drawn: Drawn::Curve }
    }

    /// A curve in the colour of the marks before it; without a name, it isn't in the legend.
    pub(crate) fn line(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, drawn: Drawn::Line }
    }
}

/// Colours that differ in print and for the colour-blind (Okabe and Ito).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Pixels.
const SIZE: (u32, u32) = (760, 520);

/// The figure as SVG.
pub(crate) fn svg(figure: &Figure) -> Result<String> {
    let xs = || figure.series.iter().flat_map(|series| &series.points).map(|p| p.0);
    let ys = || figure.series.iter().flat_map(|series| &series.points).map(|p| p.1);
    match figure.axes {
        Axes::Logarithmic => {
            let [x, y] = [decades(figure, xs())?, decades(figure, ys())?];
            draw(figure, (x.0..x.1).log_scale(), (y.0..y.1).log_scale(), [&decade, &decade])
        }
        Axes::Linear => {
            let [x, y] = [evenly(figure, xs())?, evenly(figure, ys())?];
            draw(figure, x.0..x.1, y.0..y.1, [&plain, &plain])
        }
        Axes::LogarithmicX => {
            let (x, y) = (decades(figure, xs())?, evenly(figure, ys())?);
            draw(figure, (x.0..x.1).log_scale(), y.0..y.1, [&decade, &plain])
        }
    }
}

fn draw<X, Y>(figure: &Figure, x: X, y: Y, labels: [&dyn Fn(&f64) -> String; 2]) -> Result<String>
where
    X: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
    Y: AsRangedCoord<Value = f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&root)
            .caption(figure.title, ("sans-serif", 20))
            .margin(12)
            .x_label_area_size(52)
            .y_label_area_size(72)
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .x_desc(figure.x)
            .y_desc(figure.y)
            .x_labels(10)
            .y_labels(10)
            .x_label_formatter(&labels[0])
            .y_label_formatter(&labels[1])
            .axis_desc_style(("sans-serif", 16))
            .label_style(("sans-serif", 14))
            .bold_line_style(BLACK.mix(0.18))
            .light_line_style(BLACK.mix(0.06))
            .draw()?;
        let mut kind = 0;
        for series in &figure.series {
            let points = series.points.iter().copied();
            if series.drawn != Drawn::Line {
                kind += 1;
            }
            let colour = COLOURS[(kind.max(1) - 1) % COLOURS.len()];
            if series.drawn == Drawn::Marks {
                chart
                    .draw_series(points.map(|point| Circle::new(point, 3, colour.filled())))?
                    .label(series.name.as_str())
                    .legend(move |(x, y)| Circle::new((x + 10, y), 3, colour.filled()));
            } else if series.name.is_empty() {
                chart.draw_series(LineSeries::new(points, colour.stroke_width(1)))?;
            } else {
                chart
                    .draw_series(LineSeries::new(points, colour.stroke_width(1)))?
                    .label(series.name.as_str())
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], colour));
            }
        }
        chart
            .configure_series_labels()
            .position(match figure.legend {
                Corner::LowerLeft => SeriesLabelPosition::LowerLeft,
                Corner::LowerRight => SeriesLabelPosition::LowerRight,
                Corner::UpperLeft => SeriesLabelPosition::UpperLeft,
            })
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 14))
            .draw()?;
        root.present()?;
    }
    Ok(text)
}

/// Whole decades around what is shown; an axis of a logarithm has no place for other numbers than positive ones.
fn decades(figure: &Figure, values: impl Iterator<Item = f64> + Clone) -> Result<(f64, f64)> {
    if !values.clone().all(|value| value > 0.0 && value.is_finite()) {
        return Err(format!("{}: a value that has no logarithm", figure.file).into());
    }
    let (low, high) = values.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), x| (low.min(x), high.max(x)));
    // A point that is meant to lie on a decade may lie beside it by rounding.
    let exponents = ((low.log10() + 1e-9).floor(), (high.log10() - 1e-9).ceil());
    Ok((10_f64.powf(exponents.0) * 0.9, 10_f64.powf(exponents.1) * 1.1))
}

/// All that is shown with a margin; from zero where that is little farther.
fn evenly(figure: &Figure, values: impl Iterator<Item = f64> + Clone) -> Result<(f64, f64)> {
    if !values.clone().all(f64::is_finite) {
        return Err(format!("{}: a value that is not a number", figure.file).into());
    }
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let margin = 0.05 * (high - low);
    let low = if low >= 0.0 && low <= 0.5 * high { 0.0 } else { low - margin };
    Ok((low, high + margin))
}

/// A number as it is read, without the digits of its rounding.
fn plain(value: &f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded })
}

/// 10ⁿ for a power of ten, nothing for what lies between.
fn decade(value: &f64) -> String {
    let exponent = value.log10();
    if (exponent - exponent.round()).abs() > 1e-6 {
        return String::new();
    }
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = format!("{}", exponent.round());
    let raised = raised.chars().map(|c| c.to_digit(10).map_or('⁻', |digit| digits[digit as usize]));
    format!("10{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_are_labelled_and_nothing_else() {
        assert_eq!(decade(&1e-12), "10⁻¹²");
        assert_eq!(decade(&1.0), "10⁰");
        assert_eq!(decade(&2e-3), "");
    }

    #[test]
    fn a_figure_is_drawn_the_same_twice_and_refuses_what_has_no_logarithm() {
        let figure = |axes: Axes, y: f64| Figure {
            axes,
            legend: Corner::LowerRight,
            file: "f.svg",
            title: "t",
            x: "x / m",
            y: "y / s",
            caption: "",
            series: vec![Series::marks("a", vec![(1e-3, 1e-4), (1e-2, y)])],
        };
        for axes in [Axes::Logarithmic, Axes::Linear, Axes::LogarithmicX] {
            assert_eq!(svg(&figure(axes, 1e-3)).ok(), svg(&figure(axes, 1e-3)).ok());
            assert!(svg(&figure(axes, 1e-3)).is_ok_and(|text| text.starts_with("<svg") && text.contains("x / m")));
            assert!(svg(&figure(axes, f64::NAN)).is_err());
        }
        assert!(svg(&figure(Axes::Logarithmic, 0.0)).is_err());
        assert!(svg(&figure(Axes::Linear, 0.0)).is_ok() && svg(&figure(Axes::LogarithmicX, 0.0)).is_ok());
    }
}
