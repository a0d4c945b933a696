//! What the figures of the pages show, and their SVG.

use crate::case::Result;
use teeter_plot::{Axis, Legend, Mark, Panel};

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

/// Height of the plot, mm.
const HEIGHT: f64 = 65.0;

/// The figure as SVG.
pub(crate) fn svg(figure: &Figure) -> Result<String> {
    let points = || figure.series.iter().flat_map(|series| &series.points);
    let (xs, ys) = (points().map(|point| point.0), points().map(|point| point.1));
    let x = match figure.axes {
        Axes::Logarithmic | Axes::LogarithmicX => Axis::logarithmic(figure.x, xs)?,
        Axes::Linear => Axis::linear(figure.x, xs)?,
    };
    let y = match figure.axes {
        Axes::Logarithmic => Axis::logarithmic(figure.y, ys)?,
        Axes::Linear | Axes::LogarithmicX => Axis::linear(figure.y, ys)?,
    };
    let panel = Panel::new(y).with(numbered(&figure.series)).height_mm(HEIGHT);
    let id = figure.file.trim_end_matches(".svg");
    Ok(teeter_plot::Figure::new(id, figure.title, x).headed().legend(Legend::Rows).panel(panel).to_svg())
}

/// The series in the colours that they are to have.
fn numbered(series: &[Series]) -> Vec<teeter_plot::Series> {
    let mut kinds = 0_usize;
    let numbered = |series: &Series| {
        if series.drawn != Drawn::Line {
            kinds += 1;
        }
        let number = kinds.saturating_sub(1);
        let points = series.points.iter().copied();
        let drawn = match series.drawn {
            Drawn::Marks => teeter_plot::Series::marks(&series.name, points, Mark::of(number)),
            Drawn::Line | Drawn::Curve => teeter_plot::Series::line(&series.name, points),
        };
        // Where the marks of several kinds coincide, all can be seen.
        if number > 0 { drawn.number(number).hollow() } else { drawn.number(number) }
    };
    series.iter().map(numbered).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_is_drawn_the_same_twice_and_refuses_what_has_no_logarithm() {
        let figure = |axes: Axes, y: f64| Figure {
            axes,
            file: "f.svg",
            title: "t",
            x: "x (m)",
            y: "y (s)",
            caption: "",
            series: vec![Series::marks("a", vec![(1e-3, 1e-4), (1e-2, y)])],
        };
        for axes in [Axes::Logarithmic, Axes::Linear, Axes::LogarithmicX] {
            assert_eq!(svg(&figure(axes, 1e-3)).ok(), svg(&figure(axes, 1e-3)).ok());
            assert!(svg(&figure(axes, 1e-3)).is_ok_and(|text| text.starts_with("<svg") && text.contains("x (m)")));
            assert!(svg(&figure(axes, f64::NAN)).is_err());
        }
        assert!(svg(&figure(Axes::Logarithmic, 0.0)).is_err());
        assert!(svg(&figure(Axes::Linear, 0.0)).is_ok() && svg(&figure(Axes::LogarithmicX, 0.0)).is_ok());
    }

    #[test]
    fn a_line_has_the_colour_of_the_marks_before_it() {
        let point = vec![(1.0, 1.0)];
        let series = [
            Series::marks("a", point.clone()),
            Series::line("its fit", point.clone()),
            Series::curve("b", point.clone()),
            Series::marks("c", point.clone()),
        ];
        let number = |k: usize, marks: bool| {
            let drawn = teeter_plot::Series::line("", point.clone()).number(k);
            let series =
                if marks { teeter_plot::Series::marks("", point.clone(), Mark::of(k)).number(k) } else { drawn };
            if k > 0 { series.hollow() } else { series }
        };
        let expected = [number(0, true), number(0, false), number(1, false), number(2, true)];
        let unnamed = series.map(|series| Series { name: String::new(), ..series });
        assert_eq!(numbered(&unnamed), expected);
    }
}
