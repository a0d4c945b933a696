//! Error over time, both logarithmic, as SVG: a figure a quantity, thin and plain, for a paper.

use super::short;
use crate::{Quantity, Tradeoff, front};
use std::fmt::Write;

/// Colours of Okabe and Ito, which the colour-blind tell apart; one a scheme.
const COLOURS: [&str; 6] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"];

/// 4 units are a millimetre.
const WIDTH: f64 = 480.0;
const HEIGHT: f64 = 300.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 44.0;
/// Errors below this are rounding: drawn at the bottom.
const LEAST: f64 = 1e-15;

/// A candidate in the figure.
struct Point {
    time: f64,
    error: f64,
    scheme: usize,
    /// Whether scheme and step alone are changed of the scene.
    plain: bool,
}

/// The figures, with their names: one for each quantity that the scene has.
#[must_use]
pub fn figures(study: &Tradeoff) -> Vec<(String, String)> {
    let figure = |quantity: Quantity| {
        let points = points(study, quantity);
        (!points.is_empty()).then(|| (format!("{}.svg", quantity.word()), draw(study, quantity, &points)))
    };
    Quantity::ALL.into_iter().filter_map(figure).collect()
}

fn points(study: &Tradeoff, quantity: Quantity) -> Vec<Point> {
    let axes = &study.axes;
    let point = |row: &crate::Row| {
        let error = row.result.as_ref().ok()?.errors.of(quantity).filter(|error| error.is_finite())?;
        let scheme = axes.scheme.part_of(&row.setting);
        Some(Point {
            time: row.measured()?,
            error: error.max(LEAST),
            scheme: axes.scheme.options.iter().position(|option| *option == scheme)?,
            plain: axes.grid.iter().chain(&axes.others).all(|axis| axis.part_of(&row.setting).is_none()),
        })
    };
    study.rows.iter().filter_map(point).collect()
}

/// A logarithmic axis over whole decades.
struct Decades {
    low: i32,
    high: i32,
    from: f64,
    to: f64,
}

impl Decades {
    fn over(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for power in values.filter(|x| *x > 0.0).map(f64::log10) {
            (low, high) = (low.min(power), high.max(power));
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        let low = low.floor() as i32;
        Self { low, high: (high.ceil() as i32).max(low + 1), from, to }
    }

    fn at(&self, x: f64) -> f64 {
        let share = (x.log10() - f64::from(self.low)) / f64::from(self.high - self.low);
        self.from + share.clamp(0.0, 1.0) * (self.to - self.from)
    }

    /// Every decade, or every other one of many.
    fn ticks(&self) -> impl Iterator<Item = (f64, String)> {
        let every = 1 + (self.high - self.low) as usize / 9;
        (self.low..=self.high).step_by(every).map(|power| {
            let x = 10_f64.powi(power);
            (x, if (-3..=3).contains(&power) { short(x) } else { format!("1e{power}") })
        })
    }
}

fn draw(study: &Tradeoff, quantity: Quantity, points: &[Point]) -> String {
    let bar = study.reference.bar_of(quantity);
    let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
    let x = Decades::over(points.iter().map(|point| 1e3 * point.time), LEFT, right);
    let y = Decades::over(points.iter().map(|point| point.error).chain([bar]), bottom, TOP);
    let mut svg = String::new();
    let _ = writeln!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         font-family=\"Helvetica, Arial, sans-serif\" font-size=\"11\" fill=\"#000\" role=\"img\">\n\
         <title>{}: error over CPU time</title>\n<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#fff\"/>",
        WIDTH / 4.0,
        HEIGHT / 4.0,
        quantity.title()
    );
    if bar > 0.0 {
        let at = y.at(bar);
        let _ = writeln!(
            svg,
            "<rect x=\"{LEFT}\" y=\"{at:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"#e6e6e6\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#555\">the reference is known to {}</text>",
            right - LEFT,
            bottom - at,
            right - 5.0,
            // Above the line where there is no room below it.
            if bottom - at > 16.0 { at + 13.0 } else { at - 4.0 },
            short(bar)
        );
    }
    grid(&mut svg, &x, &y, quantity);
    staircase(&mut svg, &x, &y, points);
    for point in points {
        let colour = COLOURS[point.scheme % COLOURS.len()];
        let fill = if point.plain { colour } else { "#fff" };
        let _ = writeln!(
            svg,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"2.6\" fill=\"{fill}\" stroke=\"{colour}\"/>",
            x.at(1e3 * point.time),
            y.at(point.error)
        );
    }
    key(&mut svg, study);
    svg.push_str("</svg>\n");
    svg
}

fn grid(svg: &mut String, x: &Decades, y: &Decades, quantity: Quantity) {
    let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
    for (value, label) in x.ticks() {
        let at = x.at(value);
        let _ = writeln!(
            svg,
            "<path d=\"M{at:.1} {TOP}V{bottom}\" stroke=\"#ddd\" stroke-width=\".6\"/>\
             <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>",
            bottom + 15.0
        );
    }
    for (value, label) in y.ticks() {
        let at = y.at(value);
        let _ = writeln!(
            svg,
            "<path d=\"M{LEFT} {at:.1}H{right}\" stroke=\"#ddd\" stroke-width=\".6\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
            LEFT - 6.0,
            at + 4.0
        );
    }
    let _ = writeln!(
        svg,
        "<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"none\" stroke=\"#000\" stroke-width=\".8\"/>\n\
         <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">CPU time of the run / ms</text>\n\
         <text transform=\"translate(13 {:.1}) rotate(-90)\" text-anchor=\"middle\">{}, relative error</text>",
        right - LEFT,
        bottom - TOP,
        0.5 * (LEFT + right),
        bottom + 33.0,
        0.5 * (TOP + bottom),
        quantity.title()
    );
}

/// The least error that can be had within each time.
fn staircase(svg: &mut String, x: &Decades, y: &Decades, points: &[Point]) {
    let on: Vec<(f64, f64)> = points.iter().map(|point| (point.time, point.error)).collect();
    let mut path = String::new();
    for (number, k) in front(&on).into_iter().enumerate() {
        let (px, py) = (x.at(1e3 * on[k].0), y.at(on[k].1));
        let _ = if number == 0 { write!(path, "M{px:.1} {py:.1}") } else { write!(path, "H{px:.1}V{py:.1}") };
    }
    let _ = writeln!(svg, "<path d=\"{path}H{}\" fill=\"none\" stroke=\"#000\" stroke-width=\"1\"/>", WIDTH - RIGHT);
}

/// The schemes by colour, above the plot.
fn key(svg: &mut String, study: &Tradeoff) {
    let axis = &study.axes.scheme;
    let own = study.scheme.as_str();
    let mut at = LEFT;
    for (number, option) in axis.options.iter().enumerate() {
        let name = axis.keys.first().and_then(|key| option.get(key)).unwrap_or(own);
        let colour = COLOURS[number % COLOURS.len()];
        let _ = writeln!(
            svg,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"2.6\" fill=\"{colour}\"/><text x=\"{:.1}\" y=\"{:.1}\">{name}</text>",
            at + 4.0,
            TOP - 13.0,
            at + 11.0,
            TOP - 9.0
        );
        at += 26.0 + 5.6 * name.len() as f64;
    }
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#555\">hollow: other keys too</text>",
        WIDTH - RIGHT,
        TOP - 9.0
    );
}

#[cfg(test)]
mod tests {
    use super::Decades;

    #[test]
    fn an_axis_spans_whole_decades_and_marks_each() {
        let axis = Decades::over([0.3, 40.0].into_iter(), 0.0, 300.0);
        assert_eq!((axis.low, axis.high), (-1, 2));
        assert!((axis.at(1.0) - 100.0).abs() < 1e-9);
        let labels: Vec<_> = axis.ticks().map(|tick| tick.1).collect();
        assert_eq!(labels, ["0.1", "1", "10", "100"]);
        let one = Decades::over([1.0].into_iter(), 0.0, 1.0);
        assert!(one.high > one.low);
        assert_eq!(Decades::over(std::iter::empty(), 0.0, 1.0).ticks().count(), 2);
    }
}
