//! A drawing to scale: outlines, lines and points in the plane.

use crate::figure::{UNITS_PER_MM, WIDTH, units};
use crate::theme::{Colour, Theme};
use crate::{escaped, text_width};
use std::fmt::Write;

/// Points in a row, m.
type Points = Vec<(f64, f64)>;

/// What stands in a drawing, with lengths in m and line widths in mm.
#[derive(Clone, Debug, PartialEq)]
enum Item {
    Outlines { outlines: Vec<Points>, shade: Colour },
    Lines { lines: Vec<Points>, width_mm: f64, colour: Colour },
    Dot { at: (f64, f64), colour: Colour },
    Ground { points: Points },
}

impl Item {
    fn points(&self) -> Box<dyn Iterator<Item = &(f64, f64)> + '_> {
        match self {
            Self::Outlines { outlines: of, .. } | Self::Lines { lines: of, .. } => Box::new(of.iter().flatten()),
            Self::Ground { points } => Box::new(points.iter()),
            Self::Dot { at, .. } => Box::new(std::iter::once(at)),
        }
    }
}

/// A drawing to scale, with the same unit along both axes: what is added later lies on top.
///
/// ```
/// use teeter_plot::{Colour, Drawing};
///
/// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
/// let svg = Drawing::new("A square with its diagonal")
///     .outlines([square.to_vec()], Colour::Shade)
///     .lines([vec![square[0], square[2]]], 0.8, Colour::Series(1))
///     .note("In the plane")
///     .to_svg();
/// assert!(svg.contains("<title>A square with its diagonal</title>") && svg.contains(">20 cm</text>"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    title: String,
    items: Vec<Item>,
    notes: Vec<String>,
    key: Vec<(Colour, f64, String)>,
    theme: Theme,
    width: f64,
}

/// Margin around what is drawn, and most of its height.
const MARGIN: f64 = 14.0;
const TALLEST: f64 = 560.0;

/// Height of a line of text, and of the row with the scale.
const ROW: f64 = 14.0;
const SCALE: f64 = 22.0;

impl Drawing {
    /// An empty drawing; the title is the text for screen readers.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            items: Vec::new(),
            notes: Vec::new(),
            key: Vec::new(),
            theme: Theme::default(),
            width: WIDTH,
        }
    }

    /// Sets the width, mm, from 60 to 300, at which type keeps its size. Default: 120 mm.
    #[must_use]
    pub fn width_mm(mut self, width: f64) -> Self {
        self.width = units(width);
        self
    }

    /// Closed outlines, each through its points, filled with a light shade.
    #[must_use]
    pub fn outlines(mut self, outlines: impl IntoIterator<Item = Vec<(f64, f64)>>, shade: Colour) -> Self {
        self.items.push(Item::Outlines { outlines: finite(outlines), shade });
        self
    }

    /// Lines, each through its points, of a width in mm.
    #[must_use]
    pub fn lines(mut self, lines: impl IntoIterator<Item = Vec<(f64, f64)>>, width_mm: f64, colour: Colour) -> Self {
        self.items.push(Item::Lines { lines: finite(lines), width_mm, colour });
        self
    }

    /// A dot.
    #[must_use]
    pub fn dot(mut self, at: (f64, f64), colour: Colour) -> Self {
        if at.0.is_finite() && at.1.is_finite() {
            self.items.push(Item::Dot { at, colour });
        }
        self
    }

    /// The surface of ground, hatched below.
    #[must_use]
    pub fn ground(mut self, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        self.items.extend(finite([points.into_iter().collect()]).into_iter().map(|points| Item::Ground { points }));
        self
    }

    /// A line of text below the drawing.
    #[must_use]
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// An entry of the key: a line of this colour and width (mm), and what it is.
    #[must_use]
    pub fn key(mut self, colour: Colour, width_mm: f64, text: impl Into<String>) -> Self {
        self.key.push((colour, width_mm, text.into()));
        self
    }

    /// Sets the colours. Default: those for paper.
    #[must_use]
    pub fn theme(mut self, theme: Theme) -> Self {
        self.theme = theme;
        self
    }

    /// The drawing as an SVG document, 120 mm wide, which can also be embedded in an HTML page.
    #[must_use]
    pub fn to_svg(&self) -> String {
        let width = self.width;
        let all = || self.items.iter().flat_map(Item::points);
        let ends = |pick: &dyn Fn(&(f64, f64)) -> f64| {
            all().map(pick).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
        };
        let ((left, right), (low, high)) = (ends(&|at| at.0), ends(&|at| at.1));
        let (left, right, low, high) = if left <= right { (left, right, low, high) } else { (0.0, 1.0, 0.0, 1.0) };
        let least = f64::MIN_POSITIVE.max(1e-12 * (left.abs() + low.abs()));
        let (across, up) = ((right - left).max(least), (high - low).max(least));
        let scale = ((width - 2.0 * MARGIN) / across).min((TALLEST - 2.0 * MARGIN) / up);
        let height = 2.0 * MARGIN + scale * up;
        let (middle, top) = (0.5 * (left + right), MARGIN);
        let px = |x: f64| 0.5 * width + scale * (x - middle);
        let py = |y: f64| top + scale * (high - y);
        let notes: Vec<String> = self.notes.iter().flat_map(|note| wrapped(note, width - 2.0 * MARGIN)).collect();
        let total = height + SCALE + ROW * (self.key.len() + notes.len()) as f64 + 4.0;
        let colour = |colour: Colour| colour.value(self.theme);
        let mut svg = String::new();
        let _ = writeln!(
            svg,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{:.2}mm\" viewBox=\"0 0 {width} {total:.2}\" \
             font-family=\"Helvetica, Arial, sans-serif\" font-size=\"11\" fill=\"{}\" role=\"img\">\n<title>{}</title>\n\
             <rect width=\"{width}\" height=\"{total:.2}\" fill=\"{}\"/>",
            width / UNITS_PER_MM,
            total / UNITS_PER_MM,
            colour(Colour::Ink),
            escaped(&self.title),
            colour(Colour::Paper)
        );
        let path = |points: &[(f64, f64)]| {
            let mut path = String::new();
            for (k, (x, y)) in points.iter().enumerate() {
                let _ = write!(path, "{}{:.2} {:.2}", if k == 0 { 'M' } else { 'L' }, px(*x), py(*y));
            }
            path
        };
        for item in &self.items {
            let _ = match item {
                Item::Outlines { outlines, shade } => writeln!(
                    svg,
                    "<path d=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\".6\" stroke-linejoin=\"round\"/>",
                    outlines.iter().map(|points| path(points) + "Z").collect::<String>(),
                    colour(*shade),
                    colour(Colour::Guide)
                ),
                Item::Lines { lines, width_mm, colour: of } => writeln!(
                    svg,
                    "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:.2}\" stroke-linejoin=\"round\" \
                     stroke-linecap=\"round\"/>",
                    lines.iter().map(|points| path(points)).collect::<String>(),
                    colour(*of),
                    width_mm * UNITS_PER_MM
                ),
                Item::Dot { at, colour: of } => writeln!(
                    svg,
                    "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"2.2\" fill=\"{}\"/>",
                    px(at.0),
                    py(at.1),
                    colour(*of)
                ),
                Item::Ground { points } => writeln!(
                    svg,
                    "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\".6\"/>\n<path d=\"{}\" fill=\"none\" \
                     stroke=\"{}\" stroke-width=\"1.2\"/>",
                    hatch(&points.iter().map(|(x, y)| (px(*x), py(*y))).collect::<Vec<_>>()),
                    colour(Colour::Muted),
                    path(points),
                    colour(Colour::Ink)
                ),
            };
        }
        let (length, label) = bar(0.25 * (width - 2.0 * MARGIN) / scale);
        let y = height + 12.0;
        let _ = writeln!(
            svg,
            "<path d=\"M{MARGIN} {:.2}v8m0 -4h{:.2}m0 -4v8\" fill=\"none\" stroke=\"{}\"/><text x=\"{:.2}\" \
             y=\"{:.2}\">{label}</text>",
            y - 8.0,
            scale * length,
            colour(Colour::Ink),
            MARGIN + scale * length + 8.0,
            y
        );
        let mut y = height + SCALE;
        for (of, width_mm, text) in &self.key {
            y += ROW;
            let _ = writeln!(
                svg,
                "<path d=\"M{MARGIN} {:.2}h18\" stroke=\"{}\" stroke-width=\"{:.2}\"/><text x=\"{:.2}\" y=\"{y:.2}\">{}</text>",
                y - 4.0,
                colour(*of),
                width_mm * UNITS_PER_MM,
                MARGIN + 26.0,
                escaped(text)
            );
        }
        for text in &notes {
            y += ROW;
            let _ = writeln!(
                svg,
                "<text x=\"{MARGIN}\" y=\"{y:.2}\" fill=\"{}\">{}</text>",
                colour(Colour::Muted),
                escaped(text)
            );
        }
        svg.push_str("</svg>\n");
        svg
    }
}

/// A text in lines of this width.
fn wrapped(text: &str, width: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line =
            lines.last_mut().filter(|line| line.is_empty() || text_width(line) + text_width(word) + 6.0 <= width);
        match line {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) => _ = write!(line, " {word}"),
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Those whose places are all finite: others can't be drawn.
fn finite(all: impl IntoIterator<Item = Points>) -> Vec<Points> {
    let known = |points: &Points| !points.is_empty() && points.iter().all(|(x, y)| x.is_finite() && y.is_finite());
    all.into_iter().filter(known).collect()
}

/// Short strokes below a line, in the figure's units.
fn hatch(points: &[(f64, f64)]) -> String {
    const STEP: f64 = 7.0;
    let mut path = String::new();
    for ends in points.windows(2) {
        let ((x0, y0), (x1, y1)) = (ends[0], ends[1]);
        let count = ((x1 - x0).hypot(y1 - y0) / STEP).ceil().min(1000.0);
        for k in 0..count as usize {
            let part = k as f64 / count;
            let _ = write!(path, "M{:.2} {:.2}l-4 6", x0 + part * (x1 - x0), y0 + part * (y1 - y0));
        }
    }
    path
}

/// A length of 1, 2 or 5 times a power of ten, at most `most` (m), and its text.
fn bar(most: f64) -> (f64, String) {
    let power = 10f64.powf(most.log10().floor());
    let length = power * [5.0, 2.0, 1.0].into_iter().find(|factor| factor * power <= most).unwrap_or(1.0);
    let (unit, factor) = match length {
        _ if length < 0.0099 => ("mm", 1e3),
        _ if length < 0.99 => ("cm", 100.0),
        _ => ("m", 1.0),
    };
    let shown = length * factor;
    // Two digits below the unit's own are enough: the length has one.
    let decimals = (-shown.log10().floor()).clamp(0.0, 12.0) as usize;
    (length, format!("{shown:.decimals$} {unit}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_is_a_round_length() {
        for (most, text) in
            [(1.3, "1 m"), (0.72, "50 cm"), (0.051, "5 cm"), (0.009, "5 mm"), (4e-5, "0.02 mm"), (70.0, "50 m")]
        {
            let (length, label) = bar(most);
            assert!(length <= most && length > 0.3 * most, "{length}");
            assert_eq!(label, text);
        }
    }

    #[test]
    fn a_length_is_drawn_as_long_in_both_directions() {
        let svg = Drawing::new("cross")
            .lines([vec![(0.0, 0.0), (2.0, 0.0)], vec![(1.0, -0.5), (1.0, 0.5)]], 0.5, Colour::Ink)
            .to_svg();
        assert!(svg.contains("M14.00 127.00L466.00 127.00M240.00 240.00L240.00 14.00"), "{svg}");
    }

    #[test]
    fn a_note_is_wrapped_to_the_width() {
        let lines = |width_mm: f64| {
            let drawing = Drawing::new("t").dot((0.0, 0.0), Colour::Ink).note("a word and another ".repeat(4).trim());
            drawing.width_mm(width_mm).to_svg().matches("another").count() == 4
                && drawing_rows(&Drawing::new("t").note("a word and another ".repeat(4).trim()).width_mm(width_mm)) > 1
        };
        assert!(lines(84.0) && !lines(174.0));
    }

    fn drawing_rows(drawing: &Drawing) -> usize {
        drawing.to_svg().matches("<text").count() - 1
    }

    #[test]
    fn what_is_nowhere_is_left_out() {
        let svg = Drawing::new("nothing").dot((f64::NAN, 0.0), Colour::Ink).to_svg();
        assert!(!svg.contains("NaN") && !svg.contains("circle"), "{svg}");
    }
}
