//! A panel: series on axes, or rows of bands.

use crate::figure::{Frame, LEFT};
use crate::legend::{Entry, Legend, Symbol, area_style, mark_path, mark_style, stroke, text_width};
use crate::series::{Dash, Drawn};
use crate::theme::{Colour, Theme};
use crate::{Axis, Series, escaped};
use std::fmt::Write;

/// A row of coloured intervals along the x axis, such as the states of a contact.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Band {
    /// The name, shown at the left, or above the row where one of the panel is too long for that.
    pub label: String,
    /// Intervals: from, to, colour.
    pub stretches: Vec<(f64, f64, Colour)>,
}

impl Band {
    /// A band with its intervals: from, to, colour.
    #[must_use]
    pub fn new(label: impl Into<String>, stretches: Vec<(f64, f64, Colour)>) -> Self {
        Self { label: label.into(), stretches }
    }
}

/// One of the stacked plots of a [`Figure`](crate::Figure), with its common x axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    content: Content,
    note: Option<String>,
    /// How many lines lie on each other that dashes can't tell apart.
    too_many: usize,
    /// Places of ticks, and their length as a part of the longest.
    ticks_at: Vec<(f64, f64)>,
    tick_name: Option<String>,
    guides: Vec<f64>,
    levels: Vec<f64>,
    guide_name: Option<String>,
    shaded: Option<(f64, String)>,
    blank: Option<String>,
    labels: Vec<(f64, f64, String)>,
    height: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
enum Content {
    Plot { y: Axis, series: Vec<Series> },
    Bands { bands: Vec<Band>, key: Vec<(Colour, String)> },
}

/// Height of a band including the gap to the next.
const ROW: f64 = 16.0;
/// What is added for a name above its band.
const NAME: f64 = 12.0;
/// Type size of the names of bands.
const NAME_SIZE: f64 = 10.0;

/// Whether all names have room to the left of their bands; otherwise each stands above its own.
fn named_beside(bands: &[Band]) -> bool {
    // Of Helvetica, in parts of the type size.
    let wide = |c: char| match c {
        'f' | 'i' | 'j' | 'l' | 'r' | 't' | ' ' | '.' | '-' => 0.3,
        'm' | 'w' => 0.85,
        c if c.is_uppercase() => 0.75,
        _ => 0.56,
    };
    bands.iter().all(|band| NAME_SIZE * band.label.chars().map(wide).sum::<f64>() <= LEFT - 6.0)
}

fn row_height(bands: &[Band]) -> f64 {
    if named_beside(bands) { ROW } else { ROW + NAME }
}

/// Length of a tick at the top, px.
const TICK: f64 = 5.0;

impl Panel {
    /// A panel with this y axis.
    #[must_use]
    pub fn new(y: Axis) -> Self {
        Self::with_content(Content::Plot { y, series: Vec::new() })
    }

    /// A panel of bands, with the legend of their colours.
    #[must_use]
    pub fn bands(bands: Vec<Band>, key: impl IntoIterator<Item = (Colour, impl Into<String>)>) -> Self {
        let key = key.into_iter().map(|(colour, word)| (colour, word.into())).collect();
        Self::with_content(Content::Bands { bands, key })
    }

    fn with_content(content: Content) -> Self {
        Self {
            content,
            note: None,
            too_many: 0,
            ticks_at: Vec::new(),
            tick_name: None,
            guides: Vec::new(),
            levels: Vec::new(),
            guide_name: None,
            shaded: None,
            blank: None,
            labels: Vec::new(),
            height: None,
        }
    }

    /// Adds series: later ones are drawn above earlier ones, marks above lines. No effect on a
    /// panel of bands.
    #[must_use]
    pub fn with(mut self, more: impl IntoIterator<Item = Series>) -> Self {
        if let Content::Plot { series, .. } = &mut self.content {
            series.extend(more);
        }
        self
    }

    /// Dashes lines that lie on an earlier one over the whole panel, so that both are seen: within 1 %
    /// of the axis, a line's width. Of the series added so far. Where more lie on each other than dashes can show, the note
    /// says how many.
    #[must_use]
    pub fn telling_apart(mut self) -> Self {
        if let Content::Plot { y, series } = &mut self.content {
            let (low, high) = y.ends();
            self.too_many = Series::tell_apart(series, 0.01 * (high - low));
        }
        self
    }

    /// The note above the right end, without what is said of curves that coincide.
    #[must_use]
    pub fn own_note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// What its y axis is of, without the unit; empty of bands.
    #[must_use]
    pub fn quantity(&self) -> &str {
        match &self.content {
            Content::Plot { y, .. } => y.label.split(" (").next().unwrap_or_default(),
            Content::Bands { .. } => "",
        }
    }

    /// Sets or removes a note above the right end.
    #[must_use]
    pub fn note(mut self, note: impl Into<Option<String>>) -> Self {
        self.note = note.into();
        self
    }

    /// Draws short ticks at the top, for example at the times of impacts.
    #[must_use]
    pub fn ticks_at(mut self, x: Vec<f64>) -> Self {
        self.ticks_at = x.into_iter().map(|x| (x, 1.0)).collect();
        self
    }

    /// Instead of ticks for each of very many: how many there are about each of these x, as ticks whose length grows with the number.
    #[must_use]
    pub fn counts_at(mut self, counts: Vec<(f64, u32)>) -> Self {
        let most = counts.iter().map(|(_, count)| *count).max().unwrap_or(0).max(1);
        // By the root, so that single ones are seen beside many.
        let part = |count: u32| (f64::from(count) / f64::from(most)).sqrt();
        self.ticks_at = counts.into_iter().filter(|(_, count)| *count > 0).map(|(x, count)| (x, part(count))).collect();
        self
    }

    /// Names the ticks at the top in the legend, if there are any. Default: no name.
    #[must_use]
    pub fn ticks_named(mut self, name: impl Into<String>) -> Self {
        self.tick_name = Some(name.into());
        self
    }

    /// Whether there are ticks at the top.
    #[must_use]
    pub fn has_ticks(&self) -> bool {
        !self.ticks_at.is_empty()
    }

    /// Draws dashed vertical lines at these x.
    #[must_use]
    pub fn guides(mut self, x: Vec<f64>) -> Self {
        self.guides = x;
        self
    }

    /// Draws dashed horizontal lines at these y.
    #[must_use]
    pub fn levels(mut self, y: Vec<f64>) -> Self {
        self.levels = y;
        self
    }

    /// Names the dashed lines in the legend. Default: no name.
    #[must_use]
    pub fn guides_named(mut self, name: impl Into<String>) -> Self {
        self.guide_name = Some(name.into());
        self
    }

    /// Rings points and writes a text beside each: x, y, text.
    #[must_use]
    pub fn labels(mut self, labels: impl IntoIterator<Item = (f64, f64, String)>) -> Self {
        self.labels.extend(labels);
        self
    }

    /// Shades the region below this y, with a label in the legend, if it isn't empty.
    #[must_use]
    pub fn shaded_below(mut self, y: f64, label: impl Into<String>) -> Self {
        self.shaded = Some((y, label.into()));
        self
    }

    /// Says in the legend what it means where a map has no cells.
    #[must_use]
    pub fn blank_means(mut self, label: impl Into<String>) -> Self {
        self.blank = Some(label.into());
        self
    }

    /// Sets the frame's height, mm. Default: 52.5 mm for a single panel, 35 mm for one of several, 28 mm where the figure would be taller than 220 mm.
    /// No effect on bands.
    #[must_use]
    pub fn height_mm(mut self, height: f64) -> Self {
        self.height = Some(height);
        self
    }

    pub(crate) fn is_plot(&self) -> bool {
        matches!(self.content, Content::Plot { .. })
    }

    /// Height of the frame in mm, if set.
    pub(crate) fn own_height_mm(&self) -> Option<f64> {
        self.height.filter(|height| height.is_finite() && *height > 0.0)
    }

    /// Height of the rows of bands.
    pub(crate) fn bands_height(&self) -> Option<f64> {
        match &self.content {
            Content::Plot { .. } => None,
            Content::Bands { bands, .. } => Some(row_height(bands) * bands.len() as f64),
        }
    }

    pub(crate) fn note_text(&self) -> Option<String> {
        let coincide = (self.too_many > 0).then(|| format!("{} curves coincide, wholly or in part", self.too_many));
        let parts: Vec<String> = [self.note.clone(), coincide].into_iter().flatten().collect();
        (!parts.is_empty()).then(|| parts.join("; "))
    }

    /// The entries of the legend.
    pub(crate) fn entries(&self) -> Vec<Entry<'_>> {
        match &self.content {
            Content::Plot { series, .. } => {
                let named = series.iter().enumerate().filter_map(|(k, series)| Entry::of(series, series.number_at(k)));
                let shaded = self.shaded.iter().filter(|(_, name)| !name.is_empty());
                let shaded = shaded.map(|(_, name)| Entry { symbol: Symbol::Swatch(Colour::Shade), name });
                let blank = self.blank.iter().filter(|name| !name.is_empty());
                let blank = blank.map(|name| Entry { symbol: Symbol::Swatch(Colour::Paper), name });
                let guides = self.guide_name.iter().map(|name| Entry { symbol: Symbol::Guide, name });
                let ticks = self.tick_name.iter().filter(|name| self.has_ticks() && !name.is_empty());
                let ticks = ticks.map(|name| Entry { symbol: Symbol::Tick, name });
                named.chain(guides).chain(ticks).chain(shaded).chain(blank).collect()
            }
            Content::Bands { key, .. } => {
                key.iter().map(|(colour, name)| Entry { symbol: Symbol::Swatch(*colour), name }).collect()
            }
        }
    }

    pub(crate) fn draw(&self, svg: &mut String, frame: &Frame, id: &str, legend: Legend, theme: Theme) {
        legend.draw(svg, theme, frame, &self.entries(), self.note_text().as_deref());
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
        Self::draw_marks(svg, &inner, theme, y, series, true);
        // What is alone in its panel hides no other by filling its range.
        let is_alone = series.len() < 2;
        for (k, line) in series.iter().enumerate().filter(|(_, series)| series.drawn == Drawn::Line) {
            let path = line_path(line.points(), |x| frame.px(x), py);
            let dashed = stroke(line.number_at(k), line.dash, theme);
            let weight = match line.faint {
                true => "stroke-width=\".5\" stroke-opacity=\".2\"",
                false if !is_alone && is_dense(line.points(), frame, py) => {
                    "stroke-width=\"1.1\" stroke-opacity=\".45\""
                }
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
            Drawn::Area | Drawn::Cells => {}
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
    fn what_fills_its_range_is_pale_beside_others() {
        let pale = |count: u32, others: &[f64]| {
            let points = (0..count).map(|k| (f64::from(k) / f64::from(count), f64::from(k % 2)));
            let others = others.iter().map(|y| Series::line("", [(0.0, *y), (1.0, *y)]));
            let panel = Panel::new(Axis::between("y", 0.0, 1.0)).with([Series::line("", points)]).with(others);
            Figure::new("f", "t", Axis::between("x", 0.0, 1.0)).panel(panel).to_svg().contains("stroke-opacity")
        };
        assert!(pale(1000, &[0.5]) && !pale(100, &[0.5]));
        assert!(!pale(1000, &[]), "alone it hides nothing");
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
