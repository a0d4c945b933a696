//! Figures with two logarithmic axes, as SVG: the only file that knows the plotting crate.

use crate::case::Result;
use plotters::coord::combinators::IntoLogRange;
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
    /// The sentence below it on the page.
    pub(crate) caption: &'static str,
    /// What it shows; a line takes the colour of the marks before it.
    pub(crate) series: Vec<Series>,
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
    Line,
}

impl Series {
    /// Measured points.
    pub(crate) fn marks(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, drawn: Drawn::Marks }
    }

    /// A curve.
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
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let [x, y] = [range(figure, |p| p.0)?, range(figure, |p| p.1)?];
        let mut chart = ChartBuilder::on(&root)
            .caption(figure.title, ("sans-serif", 20))
            .margin(12)
            .x_label_area_size(52)
            .y_label_area_size(72)
            .build_cartesian_2d((x.0..x.1).log_scale(), (y.0..y.1).log_scale())?;
        chart
            .configure_mesh()
            .x_desc(figure.x)
            .y_desc(figure.y)
            .x_labels(10)
            .y_labels(10)
            .x_label_formatter(&|x| decade(*x))
            .y_label_formatter(&|y| decade(*y))
            .axis_desc_style(("sans-serif", 16))
            .label_style(("sans-serif", 14))
            .bold_line_style(BLACK.mix(0.18))
            .light_line_style(BLACK.mix(0.06))
            .draw()?;
        let mut kind = 0;
        for series in &figure.series {
            let points = series.points.iter().copied();
            if series.drawn == Drawn::Marks {
                kind += 1;
                let colour = COLOURS[(kind - 1) % COLOURS.len()];
                chart
                    .draw_series(points.map(|point| Circle::new(point, 3, colour.filled())))?
                    .label(series.name.as_str())
                    .legend(move |(x, y)| Circle::new((x + 10, y), 3, colour.filled()));
            } else {
                let colour = COLOURS[(kind.max(1) - 1) % COLOURS.len()];
                chart
                    .draw_series(LineSeries::new(points, colour.stroke_width(1)))?
                    .label(series.name.as_str())
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], colour));
            }
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 14))
            .draw()?;
        root.present()?;
    }
    Ok(text)
}

/// Whole decades around what is shown; an axis of a logarithm has no place for other numbers than positive ones.
fn range(figure: &Figure, of: impl Fn(&(f64, f64)) -> f64) -> Result<(f64, f64)> {
    let values = || figure.series.iter().flat_map(|series| &series.points).map(&of);
    if !values().all(|value| value > 0.0 && value.is_finite()) {
        return Err(format!("{}: a value that has no logarithm", figure.file).into());
    }
    let (low, high) = values().fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), x| (low.min(x), high.max(x)));
    // A point that is meant to lie on a decade may lie beside it by rounding.
    let exponents = ((low.log10() + 1e-9).floor(), (high.log10() - 1e-9).ceil());
    Ok((10_f64.powf(exponents.0) * 0.9, 10_f64.powf(exponents.1) * 1.1))
}

/// 10ⁿ for a power of ten, nothing for what lies between.
fn decade(value: f64) -> String {
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
        assert_eq!(decade(1e-12), "10⁻¹²");
        assert_eq!(decade(1.0), "10⁰");
        assert_eq!(decade(2e-3), "");
    }

    #[test]
    fn a_figure_is_drawn_the_same_twice_and_refuses_what_has_no_logarithm() {
        let figure = |y: f64| Figure {
            file: "f.svg",
            title: "t",
            x: "x / m",
            y: "y / s",
            caption: "",
            series: vec![Series::marks("a", vec![(1e-3, 1e-4), (1e-2, y)])],
        };
        assert_eq!(svg(&figure(1e-3)).ok(), svg(&figure(1e-3)).ok());
        assert!(svg(&figure(1e-3)).is_ok_and(|text| text.starts_with("<svg") && text.contains("x / m")));
        assert!(svg(&figure(0.0)).is_err());
    }
}
