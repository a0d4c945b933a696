//! Line plots as SVG for a paper: thin lines, nice ticks, units on the axes, colours that the colour-blind tell apart.

use std::fmt::Write;

/// Colours of Okabe and Ito, the light yellow left out: it is too faint for a thin line on white.
pub(crate) const COLOURS: [&str; 7] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"];

/// Dashes that tell lines of one colour apart.
const DASHES: [&str; 3] = ["none", "5 2.5", "1.5 2"];

/// A curve.
pub(crate) struct Line {
    pub(crate) label: String,
    /// Number of the line; it gives colour and dash.
    pub(crate) number: usize,
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
}

/// A row of coloured stretches, such as the states of a contact.
pub(crate) struct Band {
    pub(crate) label: String,
    /// From, to, colour.
    pub(crate) stretches: Vec<(f64, f64, &'static str)>,
}

/// Axes with lines, or rows of bands.
#[derive(Default)]
pub(crate) struct Panel {
    pub(crate) y_label: String,
    pub(crate) lines: Vec<Line>,
    pub(crate) bands: Vec<Band>,
    /// Colours of the bands, with what they mean.
    pub(crate) band_key: Vec<(&'static str, &'static str)>,
    /// The y range if it is not that of the lines; what lies beyond is cut.
    pub(crate) range: Option<(f64, f64)>,
    pub(crate) note: Option<String>,
    /// The least range: what varies by less is still, and its rounding not for the eye.
    pub(crate) least: f64,
    /// Places on the x axis marked at the top; those of the figure if there are none.
    pub(crate) marks: Option<Vec<f64>>,
    /// Places of vertical guide lines.
    pub(crate) guides: Vec<f64>,
}

/// Panels above each other with one x axis.
pub(crate) struct Figure {
    /// Where the figure shares a document with others, its marks must not share their names.
    pub(crate) id: &'static str,
    pub(crate) title: String,
    pub(crate) x_label: String,
    pub(crate) x_range: (f64, f64),
    pub(crate) panels: Vec<Panel>,
    /// Places on the x axis marked above every panel of lines.
    pub(crate) marks: Vec<f64>,
}

/// 4 units are a millimetre: 480 fill a page's column of 12 cm, and type of 11 is 2.75 mm or 7.8 pt.
const WIDTH: f64 = 480.0;
const UNITS_PER_MM: f64 = 4.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 12.0;
const HEADER: f64 = 24.0;
const FOOTER: f64 = 40.0;
const ROW: f64 = 16.0;
/// Height of a panel alone, and of one of several.
const HEIGHTS: [f64; 2] = [210.0, 140.0];

impl Figure {
    pub(crate) fn to_svg(&self) -> String {
        let tall = HEIGHTS[usize::from(self.panels.iter().filter(|panel| !panel.lines.is_empty()).count() > 1)];
        let inner = |panel: &Panel| if panel.lines.is_empty() { ROW * panel.bands.len() as f64 } else { tall };
        let total = self.panels.iter().map(|panel| HEADER + inner(panel)).sum::<f64>() + FOOTER;
        let mut svg = String::new();
        let _ = writeln!(
            svg,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {WIDTH} {total}\" \
             font-family=\"Helvetica, Arial, sans-serif\" font-size=\"11\" fill=\"#000\" role=\"img\">",
            WIDTH / UNITS_PER_MM,
            total / UNITS_PER_MM
        );
        let _ = writeln!(svg, "<title>{}</title>", escaped(&self.title));
        let _ = writeln!(svg, "<rect width=\"{WIDTH}\" height=\"{total}\" fill=\"#fff\"/>");
        let mut top = 0.0;
        for (number, panel) in self.panels.iter().enumerate() {
            top += HEADER;
            let frame = Frame { top, height: inner(panel), x: self.x_range };
            panel.draw(&mut svg, &frame, &format!("{}-{number}", self.id), panel.marks.as_ref().unwrap_or(&self.marks));
            top += frame.height;
        }
        self.x_axis(&mut svg, top);
        svg.push_str("</svg>\n");
        svg
    }

    fn x_axis(&self, svg: &mut String, y: f64) {
        let frame = Frame { top: y, height: 0.0, x: self.x_range };
        let ticks = Ticks::new(self.x_range, 6);
        for &x in &ticks.at {
            let px = frame.px(x);
            let _ = writeln!(
                svg,
                "<path d=\"M{px:.2} {y:.2}v4\" stroke=\"#000\" stroke-width=\".8\"/><text x=\"{px:.2}\" y=\"{:.2}\" \
                 text-anchor=\"middle\">{}</text>",
                y + 15.0,
                ticks.label(x)
            );
        }
        let _ = writeln!(
            svg,
            "<text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"middle\">{}</text>",
            0.5 * (LEFT + WIDTH - RIGHT),
            y + 31.0,
            escaped(&self.x_label)
        );
    }
}

/// Where a panel is on the page.
struct Frame {
    top: f64,
    height: f64,
    x: (f64, f64),
}

impl Frame {
    fn px(&self, x: f64) -> f64 {
        LEFT + (WIDTH - LEFT - RIGHT) * (x - self.x.0) / (self.x.1 - self.x.0)
    }
}

impl Panel {
    fn draw(&self, svg: &mut String, frame: &Frame, id: &str, marks: &[f64]) {
        let (top, height, right) = (frame.top, frame.height, WIDTH - RIGHT);
        let width = right - LEFT;
        self.key(svg, top - 8.0);
        if self.lines.is_empty() {
            self.draw_bands(svg, frame);
            return;
        }
        let (low, high) =
            self.range.unwrap_or_else(|| range_of(self.lines.iter().flat_map(|line| &line.y).copied(), self.least));
        let py = |y: f64| top + height * (high - y) / (high - low);
        let ticks = Ticks::new((low, high), if height > 180.0 { 6 } else { 4 });
        for &y in &ticks.at {
            let at = py(y);
            let _ = writeln!(
                svg,
                "<path d=\"M{LEFT} {at:.2}h{width}\" stroke=\"{}\" stroke-width=\".6\"/><text x=\"{:.2}\" y=\"{:.2}\" \
                 text-anchor=\"end\">{}</text>",
                if y == 0.0 { "#888" } else { "#ddd" },
                LEFT - 6.0,
                at + 4.0,
                ticks.label(y)
            );
        }
        let _ = writeln!(
            svg,
            "<clipPath id=\"{id}\"><rect x=\"{LEFT}\" y=\"{top:.2}\" width=\"{width}\" height=\"{height}\"/>\
             </clipPath>\n<g clip-path=\"url(#{id})\" fill=\"none\" stroke-linejoin=\"round\">"
        );
        for &x in self.guides.iter().filter(|x| (frame.x.0..=frame.x.1).contains(*x)) {
            let _ = writeln!(
                svg,
                "<path d=\"M{:.2} {top:.2}v{height}\" stroke=\"#888\" stroke-dasharray=\"4 3\" stroke-width=\".8\"/>",
                frame.px(x)
            );
        }
        for line in &self.lines {
            let path = path(&line.x, &line.y, |x| frame.px(x), py);
            let _ = writeln!(svg, "<path d=\"{path}\" {} stroke-width=\"1.1\"/>", stroke(line.number));
        }
        svg.push_str("</g>\n");
        if !marks.is_empty() {
            let ticks: String = marks.iter().map(|&t| format!("M{:.2} {top:.2}v5", frame.px(t))).collect();
            let _ = writeln!(svg, "<path d=\"{ticks}\" stroke=\"#000\" stroke-width=\".8\"/>");
        }
        let _ = writeln!(
            svg,
            "<rect x=\"{LEFT}\" y=\"{top:.2}\" width=\"{width}\" height=\"{height}\" fill=\"none\" stroke=\"#000\" \
             stroke-width=\".8\"/><text transform=\"translate(13 {:.2}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            top + 0.5 * height,
            escaped(&self.y_label)
        );
    }

    /// The lines' names above the panel, from the left; a note at the right.
    fn key(&self, svg: &mut String, y: f64) {
        let mut x = LEFT;
        if let Some(note) = &self.note {
            let _ = writeln!(
                svg,
                "<text x=\"{}\" y=\"{y:.2}\" text-anchor=\"end\" fill=\"#555\">{}</text>",
                WIDTH - RIGHT,
                escaped(note)
            );
        }
        for line in self.lines.iter().filter(|line| !line.label.is_empty()) {
            let _ = writeln!(
                svg,
                "<path d=\"M{x:.2} {:.2}h14\" {} stroke-width=\"1.6\"/><text x=\"{:.2}\" y=\"{y:.2}\">{}</text>",
                y - 3.5,
                stroke(line.number),
                x + 18.0,
                escaped(&line.label)
            );
            x += key_width(&line.label);
        }
        for (colour, word) in &self.band_key {
            let _ = writeln!(
                svg,
                "<rect x=\"{x:.2}\" y=\"{:.2}\" width=\"14\" height=\"8\" fill=\"{colour}\" stroke=\"#000\" \
                 stroke-width=\".4\"/><text x=\"{:.2}\" y=\"{y:.2}\">{word}</text>",
                y - 8.0,
                x + 18.0
            );
            x += text_width(word) + 32.0;
        }
    }

    fn draw_bands(&self, svg: &mut String, frame: &Frame) {
        for (k, band) in self.bands.iter().enumerate() {
            let top = frame.top + ROW * k as f64;
            let _ = writeln!(
                svg,
                "<text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"end\" font-size=\"9\">{}</text>",
                LEFT - 5.0,
                top + 11.0,
                escaped(&band.label)
            );
            for (from, to, colour) in &band.stretches {
                let (a, b) = (frame.px(*from), frame.px(*to));
                let _ = writeln!(
                    svg,
                    "<rect x=\"{a:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"10\" fill=\"{colour}\"/>",
                    top + 2.0,
                    b - a
                );
            }
            let _ = writeln!(
                svg,
                "<rect x=\"{LEFT}\" y=\"{:.2}\" width=\"{}\" height=\"10\" fill=\"none\" stroke=\"#000\" \
                 stroke-width=\".6\"/>",
                top + 2.0,
                WIDTH - LEFT - RIGHT
            );
        }
    }
}

fn stroke(number: usize) -> String {
    let (colour, dash) = (COLOURS[number % COLOURS.len()], DASHES[number / COLOURS.len() % DASHES.len()]);
    format!("stroke=\"{colour}\" stroke-dasharray=\"{dash}\"")
}

/// Room for the names of lines above a panel.
pub(crate) const KEY_WIDTH: f64 = WIDTH - LEFT - RIGHT;

/// What a line's name takes of it.
pub(crate) fn key_width(label: &str) -> f64 {
    text_width(label) + 32.0
}

/// About the width of Helvetica at the size of the labels.
pub(crate) fn text_width(text: &str) -> f64 {
    5.6 * text.chars().count() as f64
}

/// A line through all points that are finite, broken where one isn't; steps that no printer resolves are left out.
fn path(x: &[f64], y: &[f64], px: impl Fn(f64) -> f64, py: impl Fn(f64) -> f64) -> String {
    let mut path = String::new();
    let mut last: Option<(f64, f64)> = None;
    for (&x, &y) in x.iter().zip(y) {
        // Far beyond the panel a coordinate would only cost digits.
        let (a, b) = (px(x), py(y).clamp(-1e4, 1e4));
        if !(a.is_finite() && b.is_finite()) {
            last = None;
            continue;
        }
        match last {
            Some((c, d)) if (a - c).abs() < 0.02 && (b - d).abs() < 0.02 => continue,
            Some(_) => _ = write!(path, "L{a:.2} {b:.2}"),
            None => _ = write!(path, "M{a:.2} {b:.2}"),
        }
        last = Some((a, b));
    }
    path
}

/// The range of the values with a little room, at least `least` wide; never empty.
pub(crate) fn range_of(values: impl Iterator<Item = f64>, least: f64) -> (f64, f64) {
    // So that no width overflows.
    let finite = values.filter(|x| x.is_finite()).map(|x| x.clamp(-LARGEST, LARGEST));
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        return (-1.0, 1.0);
    }
    let room = 0.06 * (high - low) + 0.5 * (least - (high - low)).max(0.0);
    // Of constant values, wide enough for the ends to be other numbers than the values, however large these are.
    let least = CONSTANT * low.abs().max(high.abs());
    if room > least {
        (low - room, high + room)
    } else {
        let room = least.max(1.0);
        (low - room, high + room)
    }
}

/// Values beyond are drawn there.
const LARGEST: f64 = 1e300;

/// What differs by less than this part of its size is drawn as constant.
const CONSTANT: f64 = 1e-9;

/// Round numbers along an axis.
struct Ticks {
    at: Vec<f64>,
    decimals: usize,
    /// The step, if labels are to be powers of ten.
    power_of: Option<f64>,
}

impl Ticks {
    /// About `count` multiples of 1, 2 or 5 · 10ⁿ in a range, at most half as many again.
    fn new(range: (f64, f64), count: usize) -> Self {
        let raw = (range.1 - range.0) / count as f64;
        let power = 10f64.powf(raw.log10().floor());
        let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * power >= 0.7 * raw).unwrap_or(10.0);
        let step = factor * power;
        let first = (range.0 / step - 1e-9).ceil() as i64;
        let last = (range.1 / step + 1e-9).floor() as i64;
        // Very small or large numbers as powers of ten.
        let powers = !(1e-4..1e5).contains(&step);
        let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
        Self { at: (first..=last).map(|k| k as f64 * step).collect(), decimals, power_of: powers.then_some(step) }
    }

    fn label(&self, x: f64) -> String {
        let text = match self.power_of {
            Some(_) if x == 0.0 => "0".to_owned(),
            Some(step) => format!("{x:.*e}", ((x.abs() / step).log10() + 1e-9).max(0.0) as usize),
            None => format!("{x:.*}", self.decimals),
        };
        text.replace('-', "\u{2212}")
    }
}

/// Text with the characters that XML takes for its own replaced.
#[must_use]
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // Control characters, which XML can't hold.
            c if c < ' ' && !matches!(c, '\n' | '\t') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let ticks = Ticks::new((-0.031, 0.52), 6);
        let labels: Vec<String> = ticks.at.iter().map(|&x| ticks.label(x)).collect();
        assert_eq!(labels, ["0.0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
        let ticks = Ticks::new((-4.2, 5.1), 6);
        let labels: Vec<String> = ticks.at.iter().map(|&x| ticks.label(x)).collect();
        assert_eq!(labels, ["\u{2212}4", "\u{2212}2", "0", "2", "4"]);
    }

    #[test]
    fn a_range_is_never_empty() {
        let mut sets = vec![vec![], vec![f64::NAN], vec![f64::MIN, f64::MAX], vec![-1.0, 1.0], vec![0.0, 5e-324]];
        sets.extend((-300..=308).step_by(4).flat_map(|power| {
            let x = 10f64.powi(power);
            [vec![x], vec![-x, -x], vec![x, x * (1.0 + f64::EPSILON)], vec![x, 2.0 * x]]
        }));
        for values in sets {
            for least in [0.0, 1e-3] {
                let (low, high) = range_of(values.iter().copied(), least);
                assert!(low < high && (high - low).is_finite(), "{values:?}: {low} {high}");
                let inside = |x: &f64| !x.is_finite() || (low..=high).contains(&x.clamp(-LARGEST, LARGEST));
                assert!(values.iter().all(inside), "{values:?}: {low} {high}");
                let ticks = Ticks::new((low, high), 6);
                assert!((1..=12).contains(&ticks.at.len()), "{values:?}: {:?}", ticks.at);
            }
        }
    }

    #[test]
    fn a_line_breaks_where_it_is_not_finite() {
        let path = path(&[0.0, 1.0, 2.0, 3.0], &[0.0, 1.0, f64::NAN, 2.0], |x| x, |y| y);
        assert_eq!(path, "M0.00 0.00L1.00 1.00M3.00 2.00");
    }
}
