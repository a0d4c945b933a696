//! How a panel is drawn.

use super::bars::draw_bars;
use super::{Band, Content, NAME_SIZE, Panel, ROW, named_beside, row_height};
use crate::figure::{Frame, LEFT};
use crate::legend::{area_style, mark_path, mark_style, stroke, text_width};
use crate::series::{Dash, Drawn};
use crate::theme::{Colour, Theme};
use crate::{Axis, Series, escaped};
use std::fmt::Write;

/// Length of a tick at the top, px.
const TICK: f64 = 5.0;

impl Panel {
    pub(crate) fn draw(&self, svg: &mut String, frame: &Frame, id: &str, theme: Theme) {
        match &self.content {
            Content::Plot { y, series } => self.draw_plot(svg, frame, id, theme, y, series),
            Content::Bands { bands, .. } => draw_bands(svg, frame, theme, bands),
        }
    }

    fn draw_plot(&self, svg: &mut String, frame: &Frame, id: &str, theme: Theme, y: &Axis, series: &[Series]) {
        let (top, height, width) = (frame.top, frame.height, frame.width());
        // Curves stay below the ticks.
        let room = if self.ticks_at.is_empty() { 0.0 } else { TICK + 2.0 };
        let inner = Frame { top: top + room, height: height - room, across: frame.across, x: frame.x };
        let py = |value: f64| inner.top + y.below_high(value, inner.height);
        if let Some((below, _)) = &self.shaded {
            let depth = (top + height - py(*below)).clamp(0.0, height);
            let _ = writeln!(
                svg,
                "<rect x=\"{LEFT}\" y=\"{:.2}\" width=\"{width}\" height=\"{depth:.2}\" fill=\"{}\"/>",
                top + height - depth,
                Colour::Shade.value(theme)
            );
        }
        let title = draw_grid(svg, &inner, theme, y);
        let _ = writeln!(
            svg,
            "<clipPath id=\"{id}\"><rect x=\"{LEFT}\" y=\"{top:.2}\" width=\"{width}\" height=\"{height}\"/>\
             </clipPath>\n<g clip-path=\"url(#{id})\" fill=\"none\" stroke-linejoin=\"round\">"
        );
        for &x in self.guides.iter().filter(|x| frame.x.contains(**x)) {
            let _ = writeln!(
                svg,
                "<path d=\"M{:.2} {top:.2}v{height}\" stroke=\"{}\" stroke-dasharray=\"4 3\" stroke-width=\".8\"/>",
                frame.px(x),
                Colour::Guide.value(theme)
            );
        }
        for &level in self.levels.iter().filter(|level| y.contains(**level)) {
            let _ = writeln!(
                svg,
                "<path d=\"M{LEFT} {:.2}h{width}\" stroke=\"{}\" stroke-dasharray=\"4 3\" stroke-width=\".8\"/>",
                py(level),
                Colour::Guide.value(theme)
            );
        }
        for (k, area) in series.iter().enumerate().filter(|(_, series)| series.drawn == Drawn::Area) {
            let path = line_path(area.points(), |x| frame.px(x), py);
            let _ = writeln!(svg, "<path d=\"{path}\" {}/>", area_style(area.number_at(k), theme));
        }
        for (k, cells) in series.iter().enumerate().filter(|(_, series)| series.drawn == Drawn::Cells) {
            let colour = Colour::Series(cells.number_at(k)).value(theme);
            let path = cells_path(cells.points(), |x| frame.px(x), py);
            let _ = writeln!(svg, "<path d=\"{path}\" fill=\"{colour}\" stroke=\"none\"/>");
        }
        draw_bars(svg, &inner, theme, y, series);
        Self::draw_marks(svg, &inner, theme, y, series, true);
        // What is alone in its panel hides no other by filling its range.
        let is_alone = series.len() < 2;
        for (k, line) in series.iter().enumerate().filter(|(_, series)| series.drawn == Drawn::Line) {
            let path = line_path(line.points(), |x| frame.px(x), py);
            let dashed = stroke(line.number_at(k), line.dash, theme);
            let weight = match line.faint {
                true => "stroke-width=\".5\" stroke-opacity=\".35\"",
                false if !is_alone && is_dense(line.points(), frame, py) => DENSE,
                false => "stroke-width=\"1.1\"",
            };
            let _ = writeln!(svg, "<path d=\"{path}\" {dashed} {weight}/>");
            if let Some(alone) = line.solid_stretches() {
                let path = line_path(&alone, |x| frame.px(x), py);
                let solid = stroke(line.number_at(k), Dash::ByNumber, theme);
                let _ = writeln!(svg, "<path d=\"{path}\" {solid} {weight}/>");
            }
        }
        svg.push_str("</g>\n");
        Self::draw_marks(svg, &inner, theme, y, series, false);
        self.draw_labels(svg, &inner, theme, y, series);
        let ticks = self.ticks_at.iter().filter(|(x, _)| frame.x.contains(*x));
        let ticks: String = ticks
            .map(|&(x, part)| match part {
                1.0 => format!("M{:.2} {top:.2}v{TICK}", frame.px(x)),
                part => format!("M{:.2} {top:.2}v{:.1}", frame.px(x), TICK * part),
            })
            .collect();
        if !ticks.is_empty() {
            let colour = Colour::Guide.value(theme);
            let _ = writeln!(svg, "<path d=\"{ticks}\" stroke=\"{colour}\" stroke-width=\".8\"/>");
        }
        let ink = Colour::Ink.value(theme);
        let _ = writeln!(
            svg,
            "<rect x=\"{LEFT}\" y=\"{top:.2}\" width=\"{width}\" height=\"{height}\" fill=\"none\" stroke=\"{ink}\" \
             stroke-width=\".8\"/><text transform=\"translate(13 {:.2}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            top + 0.5 * height,
            title
        );
    }
}

impl Panel {
    /// The marks that are faint, or those that aren't.
    fn draw_marks(svg: &mut String, frame: &Frame, theme: Theme, y: &Axis, series: &[Series], faint: bool) {
        for (k, marks) in series.iter().enumerate().filter(|(_, marks)| marks.faint == faint) {
            let Drawn::Marks { mark, hollow } = marks.drawn else { continue };
            let shown = marks.points().iter().filter(|point| frame.x.contains(point.0) && y.contains(point.1));
            let py = |value: f64| frame.top + y.below_high(value, frame.height);
            let path: String = shown.map(|&(x, y)| mark_path(mark, frame.px(x), py(y))).collect();
            if !path.is_empty() {
                let style = mark_style(marks.number_at(k), hollow, faint, theme);
                let _ = writeln!(svg, "<path d=\"{path}\" {style}/>");
            }
        }
    }

    fn draw_labels(&self, svg: &mut String, frame: &Frame, theme: Theme, y: &Axis, series: &[Series]) {
        let ink = Colour::Ink.value(theme);
        let drawn = places(frame, y, series);
        let mut taken: Vec<Text> = Vec::new();
        for (x, value, text) in self.labels.iter().filter(|(x, value, _)| frame.x.contains(*x) && y.contains(*value)) {
            let (px, py) = (frame.px(*x), frame.top + y.below_high(*value, frame.height));
            let width = text_width(text);
            // Towards the middle, above before below; of these the one that hides least.
            let sides = if px > LEFT + 0.6 * frame.width() { [true, false] } else { [false, true] };
            let all = sides.into_iter().flat_map(|before| [-6.0, 14.0].map(|raised| (before, raised)));
            let text_at = |(before, raised): (bool, f64)| Text {
                left: if before { px - 8.0 - width } else { px + 8.0 },
                width,
                base: py + raised,
            };
            let cost = |at: &(bool, f64)| {
                let text = text_at(*at);
                let hidden = drawn.iter().filter(|place| text.covers(**place)).count();
                let over = taken.iter().filter(|other| text.meets(other)).count();
                hidden + 1_000 * over + 100_000 * usize::from(!text.is_within(frame))
            };
            let Some(at) = all.min_by_key(cost) else { continue };
            let place = text_at(at);
            let (anchor_x, anchor) = if at.0 { (px - 8.0, "end") } else { (px + 8.0, "start") };
            let _ = writeln!(
                svg,
                "<circle cx=\"{px:.2}\" cy=\"{py:.2}\" r=\"5.5\" fill=\"none\" stroke=\"{ink}\" stroke-width=\"1\"/>\
                 <text x=\"{anchor_x:.2}\" y=\"{:.2}\" text-anchor=\"{anchor}\" fill=\"{ink}\" stroke=\"{}\" stroke-width=\"3\" \
                 paint-order=\"stroke\">{}</text>",
                place.base,
                Colour::Paper.value(theme),
                escaped(text)
            );
            taken.push(place);
        }
    }
}

/// A line of text where it may stand, in the units of the figure.
struct Text {
    left: f64,
    width: f64,
    /// Of its letters.
    base: f64,
}

/// How far letters and marks reach up and down.
const UP: f64 = 9.0;
const DOWN: f64 = 3.0;

impl Text {
    fn covers(&self, (x, y): (f64, f64)) -> bool {
        (self.left - DOWN..=self.left + self.width + DOWN).contains(&x)
            && (self.base - UP - DOWN..=self.base + DOWN + DOWN).contains(&y)
    }

    fn meets(&self, other: &Self) -> bool {
        (self.base - other.base).abs() < UP + DOWN
            && self.left < other.left + other.width
            && other.left < self.left + self.width
    }

    fn is_within(&self, frame: &Frame) -> bool {
        let across = self.left >= LEFT && self.left + self.width <= LEFT + frame.width();
        across && self.base - UP >= frame.top && self.base + DOWN <= frame.top + frame.height
    }
}

/// Distance of the points on lines that a text is to leave free.
const APART: f64 = 4.0;

/// Where marks are, and points along lines.
fn places(frame: &Frame, y: &Axis, series: &[Series]) -> Vec<(f64, f64)> {
    let at = |&(px, value): &(f64, f64)| (frame.px(px), frame.top + y.below_high(value, frame.height));
    let mut all = Vec::new();
    for one in series {
        let points: Vec<(f64, f64)> =
            one.points().iter().map(at).filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
        match one.drawn {
            Drawn::Marks { .. } => all.extend(points),
            Drawn::Line => {
                for ends in points.windows(2) {
                    let [(a, b), (c, d)] = [ends[0], ends[1]];
                    let parts = ((c - a).hypot(d - b) / APART).ceil().clamp(1.0, 500.0);
                    all.extend(
                        (0..=parts as usize)
                            .map(|k| k as f64 / parts)
                            .map(|part| (a + part * (c - a), b + part * (d - b))),
                    );
                }
            }
            Drawn::Area | Drawn::Cells | Drawn::Bars => {}
        }
    }
    all
}

/// Grid lines at the ticks of both axes (of x only if it is logarithmic), and the labels of y; returns what the title of y says with them.
fn draw_grid(svg: &mut String, frame: &Frame, theme: Theme, y: &Axis) -> String {
    let (top, height, width) = (frame.top, frame.height, frame.width());
    let y_ticks = y.ticks(if height > 180.0 { 6 } else { 4 });
    let py = |value: f64| top + y.below_high(value, height);
    let [grid, fine] = [Colour::Grid, Colour::FineGrid].map(|colour| colour.value(theme));
    let x_ticks = frame.x.is_logarithmic().then(|| frame.x_ticks());
    let vertical = |x: f64| format!("M{:.2} {top:.2}v{height}", frame.px(x));
    let across = x_ticks.iter().flat_map(|ticks| &ticks.minor).map(|&x| vertical(x));
    let lines: String = across.chain(y_ticks.minor.iter().map(|&y| format!("M{LEFT} {:.2}h{width}", py(y)))).collect();
    if !lines.is_empty() {
        let _ = writeln!(svg, "<path d=\"{lines}\" stroke=\"{fine}\" stroke-width=\".4\"/>");
    }
    let lines: String = x_ticks.iter().flat_map(|ticks| &ticks.major).map(|(x, _)| vertical(*x)).collect();
    if !lines.is_empty() {
        let _ = writeln!(svg, "<path d=\"{lines}\" stroke=\"{grid}\" stroke-width=\".6\"/>");
    }
    for (value, label) in &y_ticks.major {
        let at = py(*value);
        let _ = writeln!(
            svg,
            "<path d=\"M{LEFT} {at:.2}h{width}\" stroke=\"{}\" stroke-width=\".6\"/><text x=\"{:.2}\" y=\"{:.2}\" \
             text-anchor=\"end\">{label}</text>",
            if *value == 0.0 { Colour::Guide.value(theme) } else { grid },
            LEFT - 6.0,
            at + 4.0
        );
    }
    y_ticks.reading.title(&y.label)
}

/// Width of a stretch too short to be seen, px.
const THINNEST: f64 = 0.8;

fn draw_bands(svg: &mut String, frame: &Frame, theme: Theme, bands: &[Band]) {
    let (height, beside) = (row_height(bands), named_beside(bands));
    for (k, band) in bands.iter().enumerate() {
        let top = frame.top + height * k as f64;
        let (x, anchor) = if beside { (LEFT - 5.0, "end") } else { (LEFT, "start") };
        let _ = writeln!(
            svg,
            "<text x=\"{x:.2}\" y=\"{:.2}\" text-anchor=\"{anchor}\" font-size=\"{NAME_SIZE}\">{}</text>",
            top + 11.0,
            escaped(&band.label)
        );
        let top = top + height - ROW;
        for (from, to, colour) in &band.stretches {
            let (a, b) = (frame.px(*from), frame.px(*to));
            if !(a.is_finite() && b >= a) {
                continue;
            }
            // The axis may show a part of them.
            let (a, b) = (a.max(LEFT), b.min(LEFT + frame.width()));
            if b < a {
                continue;
            }
            let _ = writeln!(
                svg,
                "<rect x=\"{a:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"10\" fill=\"{}\"/>",
                top + 2.0,
                (b - a).max(THINNEST),
                colour.value(theme)
            );
        }
        let _ = writeln!(
            svg,
            "<rect x=\"{LEFT}\" y=\"{:.2}\" width=\"{}\" height=\"10\" fill=\"none\" stroke=\"{}\" stroke-width=\".6\"/>",
            top + 2.0,
            frame.width(),
            Colour::Ink.value(theme)
        );
    }
}

/// Rectangles between pairs of corners; neighbours in a row are joined, which saves most of the text of
/// a map.
fn cells_path(corners: &[(f64, f64)], px: impl Fn(f64) -> f64, py: impl Fn(f64) -> f64) -> String {
    // Left, right, bottom, top on the page.
    let placed = corners.chunks_exact(2).map(|pair| [px(pair[0].0), px(pair[1].0), py(pair[0].1), py(pair[1].1)]);
    let mut cells: Vec<[f64; 4]> = placed.filter(|cell| cell.iter().all(|side| side.is_finite())).collect();
    cells.sort_by(|a, b| b[2].total_cmp(&a[2]).then(a[0].total_cmp(&b[0])));
    let joined = |a: &[f64; 4], b: &[f64; 4]| a[2..] == b[2..] && b[0] - a[1] < 0.01;
    let mut path = String::new();
    for row in cells.chunk_by(joined) {
        let ([left, _, bottom, top], [_, right, ..]) = (row[0], row[row.len() - 1]);
        let _ = write!(path, "M{left:.2} {top:.2}H{right:.2}V{bottom:.2}H{left:.2}z");
    }
    path
}

/// A curve that fills its range, beside others: thin, as wide as the thinnest line that journals print, so that it hides less of them, and hardly
/// paler than the others, as it is no background.
const DENSE: &str = "stroke-width=\".7\" stroke-opacity=\".85\"";

/// Whether a curve over ascending x goes up and down more often than once a unit of the width, by more than two units: it fills its range, as vibrations
/// of a long run do.
fn is_dense(points: &[(f64, f64)], frame: &Frame, py: impl Fn(f64) -> f64) -> bool {
    let (mut turns, mut before) = (0.0, 0.0);
    for ends in points.windows(2) {
        let step = py(ends[1].1) - py(ends[0].1);
        if ends[1].0 < ends[0].0 {
            return false;
        }
        if step.abs() > 2.0 && frame.x.contains(ends[1].0) {
            turns += f64::from(step * before < 0.0);
            before = step;
        }
    }
    turns > frame.width()
}

/// A line through the finite points, broken where one isn't finite; points too close for print
/// resolution are omitted.
fn line_path(points: &[(f64, f64)], px: impl Fn(f64) -> f64, py: impl Fn(f64) -> f64) -> String {
    let mut path = String::new();
    let mut last: Option<(f64, f64)> = None;
    for &(x, y) in points {
        // Coordinates far outside the panel are clamped to save digits.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theme::tests::luminance;
    use crate::{Figure, Mark};

    #[test]
    fn labelled_points_are_ringed_and_their_text_stays_in_the_frame() {
        let axis = || Axis::between("", 0.0, 1.0);
        let labels = [(0.2, 0.5, "a<b".to_owned()), (0.95, 0.2, "right".to_owned()), (2.0, 0.5, "outside".to_owned())];
        let panel = Panel::new(axis()).labels(labels).shaded_below(0.1, "");
        assert!(panel.entries().is_empty(), "a shade without a name is not in the legend");
        let svg = crate::Figure::new("f", "f", axis()).panel(panel).to_svg();
        assert_eq!(svg.matches("<circle").count(), 2);
        assert!(svg.contains(">a&lt;b</text>") && !svg.contains("outside"));
        let right = svg.split("<text").find(|piece| piece.contains(">right<")).unwrap();
        assert!(right.contains("text-anchor=\"end\""), "{right}");
    }

    #[test]
    fn a_label_leaves_the_data_free() {
        let axis = || Axis::between("", 0.0, 1.0);
        // Data to the right of the point, above and below.
        let cloud = (0..40).map(|k| (0.42 + 0.01 * f64::from(k), if k % 2 == 0 { 0.53 } else { 0.45 }));
        let panel = Panel::new(axis()).with([Series::marks("", cloud, Mark::Circle)]);
        let label = |panel: Panel| {
            let svg = Figure::new("f", "f", axis()).panel(panel.labels([(0.4, 0.5, "for 1 %".to_owned())])).to_svg();
            svg.split("<text").find(|piece| piece.contains(">for 1 %<")).unwrap().to_owned()
        };
        assert!(label(panel).contains("text-anchor=\"end\""), "to the left, where nothing is");
        assert!(label(Panel::new(axis())).contains("text-anchor=\"start\""));
    }

    #[test]
    fn a_touch_too_short_to_be_seen_is_a_tick_all_the_same() {
        let short = Band::new("a", vec![(0.5, 0.500_001, Colour::Series(0))]);
        let svg = Figure::new("f", "f", Axis::between("", 0.0, 1.0))
            .panel(Panel::bands(vec![short], [(Colour::Series(0), "stick")]))
            .to_svg();
        assert!(svg.contains(&format!("width=\"{THINNEST:.2}\" height=\"10\"")), "{svg}");
    }

    #[test]
    fn cells_of_a_row_are_one_rectangle_where_they_touch() {
        let cell = |x: f64, y: f64| [(x - 0.5, y - 0.5), (x + 0.5, y + 0.5)];
        let cells = [cell(1.0, 0.0), cell(2.0, 0.0), cell(4.0, 0.0), cell(1.0, 1.0), cell(f64::NAN, 1.0)];
        let path = cells_path(&cells.concat(), |x| x, |y| -y);
        assert_eq!(path, "M0.50 -0.50H2.50V0.50H0.50zM3.50 -0.50H4.50V0.50H3.50zM0.50 -1.50H1.50V-0.50H0.50z");
    }

    #[test]
    fn what_fills_its_range_is_thin_beside_others() {
        let thin = |count: u32, others: &[f64]| {
            let points = (0..count).map(|k| (f64::from(k) / f64::from(count), f64::from(k % 2)));
            let others = others.iter().map(|y| Series::line("", [(0.0, *y), (1.0, *y)]));
            let panel = Panel::new(Axis::between("y", 0.0, 1.0)).with([Series::line("", points)]).with(others);
            Figure::new("f", "t", Axis::between("x", 0.0, 1.0)).panel(panel).to_svg().contains("stroke-opacity")
        };
        assert!(thin(1000, &[0.5]) && !thin(100, &[0.5]));
        assert!(!thin(1000, &[]), "alone it hides nothing");
    }

    /// 3:1 is what all colours have at full strength.
    #[test]
    fn what_fills_its_range_is_seen_on_paper() {
        let opacity: f64 = DENSE.split("stroke-opacity=\"").nth(1).unwrap().trim_end_matches('"').parse().unwrap();
        let over_white = |colour: &str| {
            let part = |at: usize| f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap());
            let [r, g, b] = [1, 3, 5].map(|at| (255.0 + opacity * (part(at) - 255.0)).round() as u8);
            1.05 / (luminance(&format!("#{r:02x}{g:02x}{b:02x}")) + 0.05)
        };
        for number in 0..7 {
            let colour = Colour::Series(number).value(Theme::Paper);
            assert!(over_white(colour) > 2.4, "{colour} {}", over_white(colour));
        }
    }

    #[test]
    fn a_line_breaks_where_it_is_not_finite() {
        let points = [(0.0, 0.0), (1.0, 1.0), (2.0, f64::NAN), (3.0, 2.0)];
        assert_eq!(line_path(&points, |x| x, |y| y), "M0.00 0.00L1.00 1.00M3.00 2.00");
    }

    #[test]
    fn a_name_too_long_for_the_margin_stands_above_its_band() {
        let places = |names: [&str; 2]| -> Vec<(f64, String)> {
            let bands = names.map(|name| Band::new(name, vec![(0.0, 1.0, Colour::Series(0))]));
            let panel = Panel::bands(bands.to_vec(), [(Colour::Series(0), "stick")]);
            let svg = Figure::new("f", "t", Axis::between("x", 0.0, 1.0)).panel(panel).to_svg();
            let named = |name: &&str| {
                let text = svg.split("<text ").find(|text| text.contains(&format!(">{name}</text>"))).unwrap();
                let part = |key: &str| text.split(&format!("{key}=\"")).nth(1).unwrap().split('"').next().unwrap();
                (part("x").parse().unwrap(), part("text-anchor").to_owned())
            };
            names.iter().map(named).collect()
        };
        assert_eq!(
            places(["bottom left", "bottom right"]),
            [(LEFT - 5.0, "end".to_owned()), (LEFT - 5.0, "end".to_owned())]
        );
        let long = places(["hexagon 2 corner 1", "right"]);
        assert_eq!(long, [(LEFT, "start".to_owned()), (LEFT, "start".to_owned())]);
    }

    #[test]
    fn what_needs_a_name_has_one_and_faint_marks_are_below_the_lines() {
        let axis = || Axis::between("y", 0.0, 10.0);
        let cells = Series::cells("yes", [((0.0, 1.0), (0.0, 1.0))]);
        let named = Panel::new(axis()).with([cells]).blank_means("no").levels(vec![5.0, 50.0]).guides_named("limit");
        let named = named.ticks_named("strikes");
        let without = Figure::new("f", "t", Axis::between("x", 0.0, 10.0)).panel(named.clone()).to_svg();
        assert!(!without.contains(">strikes<"));
        let named = named.ticks_at(vec![3.0]);
        let svg = Figure::new("f", "t", Axis::between("x", 0.0, 10.0)).panel(named).to_svg();
        for name in [">yes<", ">no<", ">limit<", ">strikes<"] {
            assert!(svg.contains(name), "{name}: {svg}");
        }
        // In the legend and at 5, not at 50.
        assert_eq!(svg.matches("stroke-dasharray=\"4 3\"").count(), 2, "{svg}");
        let points = [(1.0, 1.0), (2.0, 2.0)];
        let draw = |marks: Series| {
            let panel = Panel::new(axis()).with([marks.number(0), Series::line("", points).number(1)]);
            Figure::new("f", "t", Axis::between("x", 0.0, 10.0)).panel(panel).to_svg()
        };
        let marks = || Series::marks("", points, Mark::Circle).hollow();
        let order = |svg: &str| {
            let [mark, line] = ["#0050b0", "#e05206"].map(|colour| svg.find(&format!("stroke=\"{colour}")).unwrap());
            mark < line
        };
        assert!(order(&draw(marks().faint())) && !order(&draw(marks())));
    }
}
