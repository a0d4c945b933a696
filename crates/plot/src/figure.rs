//! A figure: stacked panels with a common x axis, as SVG.

use crate::legend::{Entry, Legend, NOTE_LEFT, ROW, note_lines};
use crate::theme::{Colour, Theme};
use crate::ticks::{Ticks, text_width};
use crate::{Axis, Panel, escaped};
use std::fmt::Write;

/// Stacked panels with a common x axis.
///
/// ```
/// use teeter_plot::{Axis, Figure, Panel, Series};
///
/// let angle: Vec<(f64, f64)> = (0..=100).map(|k| 0.01 * f64::from(k)).map(|t| (t, (9.0 * t).cos())).collect();
/// let x = Axis::between("Time t (s)", 0.0, 1.0);
/// let y = Axis::linear("Angle φ (°)", angle.iter().map(|point| point.1))?;
/// let panel = Panel::new(y).with([Series::line("", angle)]).ticks_at(vec![0.175, 0.524]);
/// let svg = Figure::new("phi", "Angle over time", x).panel(panel).to_svg();
/// assert!(svg.contains("<title>Angle over time</title>"));
/// # Ok::<(), teeter_plot::AxisError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    id: String,
    title: String,
    x: Axis,
    panels: Vec<Panel>,
    legend: Legend,
    theme: Theme,
    headed: bool,
    /// Below the x axis.
    note: Option<String>,
    /// In the units of the drawing.
    width: f64,
}

/// 4 units are a millimetre: a width of 480 is a page column of 12 cm, and a font size of 11 is
/// 2.75 mm or 7.8 pt, whatever the width.
pub(crate) const WIDTH: f64 = 480.0;

/// Widths that a figure can have, mm: in a narrower one the labels of the axes would meet.
pub(crate) const WIDTHS_MM: [f64; 2] = [60.0, 300.0];

/// A width in the units of the drawing.
pub(crate) fn units(width_mm: f64) -> f64 {
    if width_mm.is_finite() { UNITS_PER_MM * width_mm.clamp(WIDTHS_MM[0], WIDTHS_MM[1]) } else { WIDTH }
}

pub(crate) const UNITS_PER_MM: f64 = 4.0;
pub(crate) const LEFT: f64 = 64.0;
pub(crate) const RIGHT: f64 = 12.0;
const HEADING: f64 = 18.0;
const HEADER: f64 = 24.0;
/// Height above a panel without legend or note.
const BARE_HEADER: f64 = 12.0;
const FOOTER: f64 = 40.0;
/// Between labels of the x axis.
const LEAST_SPACE: f64 = 8.0;
/// Height of a single panel, of one of several, and of one of so many that a figure would be taller than [`TALL`] and leave no room for a caption.
const HEIGHTS: [f64; 3] = [210.0, 140.0, 112.0];
const TALL: f64 = 220.0 * UNITS_PER_MM;

/// The position of a panel in the figure.
pub(crate) struct Frame<'a> {
    pub(crate) top: f64,
    pub(crate) height: f64,
    /// Width of the figure without a legend beside it.
    pub(crate) across: f64,
    pub(crate) x: &'a Axis,
}

impl Frame<'_> {
    pub(crate) fn width(&self) -> f64 {
        self.across - LEFT - RIGHT
    }

    pub(crate) fn px(&self, x: f64) -> f64 {
        LEFT + self.x.above_low(x, self.width())
    }

    pub(crate) fn x_ticks(&self) -> Ticks {
        let most = (6.0 * self.across / WIDTH).round() as usize;
        // As many as have room beside each other.
        let crowded = |ticks: &Ticks| {
            let places: Vec<(f64, f64)> =
                ticks.major.iter().map(|(x, label)| (self.px(*x), 0.5 * text_width(label))).collect();
            places.windows(2).any(|pair| pair[1].0 - pair[0].0 < pair[0].1 + pair[1].1 + LEAST_SPACE)
        };
        let counts = (2..most).rev();
        counts.map(|count| self.x.ticks(count)).fold(
            self.x.ticks(most),
            |chosen, fewer| {
                if crowded(&chosen) { fewer } else { chosen }
            },
        )
    }
}

impl Figure {
    /// A figure without panels. The `id` must be unique in the document. The title is the text for
    /// screen readers and, if requested, a [heading](Figure::headed).
    #[must_use]
    pub fn new(id: &str, title: impl Into<String>, x: Axis) -> Self {
        let id = id.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' }).collect();
        let (legend, theme) = (Legend::default(), Theme::default());
        Self { id, title: title.into(), x, panels: Vec::new(), legend, theme, headed: false, note: None, width: WIDTH }
    }

    /// Adds to the id, for the same figure once more in a document.
    #[must_use]
    pub fn extend_id(mut self, suffix: &str) -> Self {
        self.id = format!("{}-{suffix}", self.id);
        self
    }

    /// Adds a panel below the others.
    #[must_use]
    pub fn panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// Sets the position of the legend. Default: in a row above each panel.
    #[must_use]
    pub fn legend(mut self, legend: Legend) -> Self {
        self.legend = legend;
        self
    }

    /// Sets the colours. Default: those for paper.
    #[must_use]
    pub fn theme(mut self, theme: Theme) -> Self {
        self.theme = theme;
        self
    }

    /// Shows the title above the figure. Default: not shown, as papers and pages have captions.
    #[must_use]
    pub fn headed(mut self) -> Self {
        self.headed = true;
        self
    }

    /// Sets a note on all panels, below the x axis.
    #[must_use]
    pub fn note(mut self, note: impl Into<Option<String>>) -> Self {
        self.note = note.into();
        self
    }

    /// Sets the width, mm, from 60 to 300: type and lines keep their size, so that a figure fits the
    /// column of a journal as it is. Default: 120 mm.
    #[must_use]
    pub fn width_mm(mut self, width: f64) -> Self {
        self.width = units(width);
        self
    }

    /// How tall the figure is, mm.
    #[must_use]
    pub fn height_mm(&self) -> f64 {
        self.height() / UNITS_PER_MM
    }

    /// The height in the units of the drawing.
    fn height(&self) -> f64 {
        let panels = self.heights(&self.legends()).into_iter();
        self.above() + panels.map(|(header, inner)| header + inner).sum::<f64>() + self.below()
    }

    /// The legend of each panel: none where those above it, of curves or of bands, say all of it, and none between gave one of its colours another name.
    fn legends(&self) -> Vec<Vec<Entry<'_>>> {
        let (mut of_curves, mut of_bands) = (Vec::new(), Vec::new());
        let mut legends = Vec::new();
        for panel in &self.panels {
            let entries = panel.entries();
            let above = if panel.is_plot() { &mut of_curves } else { &mut of_bands };
            let is_said = |entry: &Entry| above.iter().any(|known: &Entry| known.says_the_same(entry));
            if entries.iter().all(is_said) {
                legends.push(Vec::new());
            } else {
                above.retain(|known| !entries.iter().any(|entry| entry.says_another(known)));
                above.extend(&entries);
                legends.push(entries);
            }
        }
        legends
    }

    /// Height of the heading above the panels.
    fn above(&self) -> f64 {
        if self.headed { HEADING } else { 0.0 }
    }

    /// Height of the axis and the note below the panels.
    fn below(&self) -> f64 {
        FOOTER + self.note_lines().len() as f64 * ROW
    }

    fn note_lines(&self) -> Vec<String> {
        note_lines(self.note.as_deref(), self.width)
    }

    /// The figure as an SVG document, which can also be embedded in an HTML page.
    #[must_use]
    pub fn to_svg(&self) -> String {
        let legends = self.legends();
        let heights = self.heights(&legends);
        let total = self.height();
        let beside = legends.iter().map(|entries| self.legend.beside(entries).0).fold(0.0, f64::max);
        let width = self.width + beside;
        let mut svg = String::new();
        let _ = writeln!(
            svg,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {width} {total}\" \
             font-family=\"Helvetica, Arial, sans-serif\" font-size=\"11\" fill=\"{}\" role=\"img\">",
            width / UNITS_PER_MM,
            total / UNITS_PER_MM,
            Colour::Ink.value(self.theme)
        );
        let title = escaped(&self.title);
        let _ = writeln!(svg, "<title>{title}</title>");
        let paper = Colour::Paper.value(self.theme);
        let _ = writeln!(svg, "<rect width=\"{width}\" height=\"{total}\" fill=\"{paper}\"/>");
        if self.headed {
            let _ = writeln!(svg, "<text x=\"{LEFT}\" y=\"16\" font-size=\"13\">{title}</text>");
        }
        let mut top = self.above();
        let panels = self.panels.iter().zip(&legends).zip(heights).enumerate();
        for (number, ((panel, entries), (header, height))) in panels {
            top += header;
            let frame = Frame { top, height, across: self.width, x: &self.x };
            self.legend.draw(&mut svg, self.theme, &frame, entries, panel.note_text().as_deref());
            panel.draw(&mut svg, &frame, &format!("{}-{number}", self.id), self.theme);
            top += height;
        }
        self.draw_x_axis(&mut svg, top);
        for (k, line) in self.note_lines().iter().enumerate() {
            let _ = writeln!(
                svg,
                "<text x=\"{NOTE_LEFT}\" y=\"{:.2}\" fill=\"{}\">{}</text>",
                top + FOOTER + ROW * (k as f64 + 0.5),
                Colour::Muted.value(self.theme),
                escaped(line)
            );
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// Heights of the space above each panel's frame and of the frame, with these legends.
    fn heights(&self, legends: &[Vec<Entry>]) -> Vec<(f64, f64)> {
        let with = |usual: f64| -> Vec<(f64, f64)> {
            self.panels.iter().zip(legends).map(|(panel, entries)| self.heights_with(panel, entries, usual)).collect()
        };
        if self.panels.iter().filter(|panel| panel.is_plot()).count() < 2 {
            return with(HEIGHTS[0]);
        }
        let usual = with(HEIGHTS[1]);
        let all = usual.iter().map(|(header, inner)| header + inner).sum::<f64>() + self.above() + self.below();
        if all > TALL { with(HEIGHTS[2]) } else { usual }
    }

    fn heights_with(&self, panel: &Panel, entries: &[Entry], usual: f64) -> (f64, f64) {
        let note = panel.note_text();
        let named =
            self.legend != Legend::Beside && (!entries.is_empty() || (panel.entries().is_empty() && !self.headed));
        let bare = !named && note.is_none();
        let header =
            if bare { BARE_HEADER } else { HEADER + self.legend.more_height(entries, note.as_deref(), self.width) };
        let own = panel.own_height_mm().map_or(usual, |height| UNITS_PER_MM * height);
        let inner = panel.bands_height().unwrap_or(own);
        (header, inner.max(self.legend.beside(entries).1))
    }

    fn draw_x_axis(&self, svg: &mut String, y: f64) {
        let frame = Frame { top: y, height: 0.0, across: self.width, x: &self.x };
        let ticks = frame.x_ticks();
        for (x, label) in &ticks.major {
            let px = frame.px(*x);
            // A wide label at the end of the axis stays in the figure.
            let middle = px.min(self.width - 0.5 * text_width(label) - 1.0);
            let _ = writeln!(
                svg,
                "<path d=\"M{px:.2} {y:.2}v4\" stroke=\"{}\" stroke-width=\".8\"/><text x=\"{middle:.2}\" \
                 y=\"{:.2}\" text-anchor=\"middle\">{label}</text>",
                Colour::Ink.value(self.theme),
                y + 15.0
            );
        }
        let _ = writeln!(
            svg,
            "<text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"middle\">{}</text>",
            0.5 * (LEFT + self.width - RIGHT),
            y + 31.0,
            ticks.reading.title(&self.x.label)
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Series;

    #[test]
    fn a_note_on_all_panels_is_below_the_axis_and_makes_the_figure_taller() {
        let panel = Panel::new(Axis::between("y", 0.0, 1.0)).with([Series::line("", [(0.0, 0.0), (1.0, 1.0)])]);
        let figure = Figure::new("f", "t", Axis::between("x", 0.0, 1.0)).panel(panel).width_mm(84.0);
        let noted = figure
            .clone()
            .note("pale: all steps; strong: without vibrations of periods below 20 ms, not across impacts".to_owned());
        let lines = noted.note_lines();
        assert_eq!(lines.len(), 2);
        assert!((noted.height_mm() - figure.height_mm() - 2.0 * ROW / UNITS_PER_MM).abs() < 1e-9);
        let svg = noted.to_svg();
        assert!(lines.iter().all(|line| svg.contains(&format!(">{line}</text>"))), "{svg}");
    }

    #[test]
    fn a_legend_that_the_one_above_says_is_not_repeated() {
        let axis = || Axis::between("y", 0.0, 1.0);
        let lines = |names: &[(&str, usize)]| {
            let line = |(name, number): &(&str, usize)| Series::line(*name, [(0.0, 0.0), (1.0, 1.0)]).number(*number);
            Panel::new(axis()).with(names.iter().map(line).collect::<Vec<_>>())
        };
        let key = [(Colour::Series(5), "stick")];
        let bands = || Panel::bands(vec![crate::Band::new("a", Vec::new())], key);
        let left = [("left", 0), ("right", 1)];
        let bars = Panel::new(axis()).with([Series::bars("right", [(0.2, 0.4, 1.0)]).number(1)]);
        let dashed = lines(&left).telling_apart();
        let figure =
            [lines(&left).ticks_at(vec![0.5]).ticks_named("impact"), dashed, bars, bands(), lines(&[("kinetic", 0)])]
                .into_iter()
                .fold(Figure::new("f", "t", Axis::between("x", 0.0, 1.0)), Figure::panel);
        let names = |figure: &Figure| -> Vec<Vec<String>> {
            figure.legends().iter().map(|of| of.iter().map(|entry| entry.name.to_owned()).collect()).collect()
        };
        assert_eq!(names(&figure), [vec!["left", "right", "impact"], vec![], vec![], vec!["stick"], vec!["kinetic"]]);
        // Another name for a colour stands between; and part of a legend would look like all of it.
        let more = figure.panel(lines(&left)).panel(lines(&[("left", 0), ("top", 2)])).panel(bands());
        assert_eq!(names(&more)[5..], [vec!["left", "right"], vec!["left", "top"], vec![]]);
        let svg = more.to_svg();
        assert_eq!(svg.matches(">right</text>").count(), 2);
        // A further colour leaves the others theirs.
        let sum = [lines(&left), lines(&[("sum", 2)]), lines(&left)];
        let sum = sum.into_iter().fold(Figure::new("f", "t", Axis::between("x", 0.0, 1.0)), Figure::panel);
        assert_eq!(names(&sum), [vec!["left", "right"], vec!["sum"], vec![]]);
    }

    #[test]
    fn many_panels_leave_room_for_a_caption() {
        let figure = |count: usize| {
            let panel = || Panel::new(Axis::between("y", 0.0, 1.0)).with([Series::line("", [(0.0, 0.0), (1.0, 1.0)])]);
            (0..count).fold(Figure::new("f", "t", Axis::between("x", 0.0, 1.0)), |figure, _| figure.panel(panel()))
        };
        let lower = figure(4).height_mm() / 4.0 - figure(6).height_mm() / 6.0;
        assert!(lower > 7.0, "{lower} mm a panel");
        assert!(figure(6).height_mm() < 220.0);
    }

    #[test]
    fn a_heading_counts_for_how_tall_a_figure_is() {
        let panel = || Panel::new(Axis::between("y", 0.0, 1.0)).with([Series::line("", [(0.0, 0.0), (1.0, 1.0)])]);
        let figure =
            || (0..5).fold(Figure::new("f", "t", Axis::between("x", 0.0, 1.0)).headed(), |of, _| of.panel(panel()));
        let bare = figure().height_mm();
        assert!(bare > 180.0, "{bare}");
        for lines in 1..12 {
            let note = "a word and one more ".repeat(5 * lines);
            let tall = figure().note(note).height_mm();
            assert!(tall <= 220.0, "{tall} mm with {lines} lines");
        }
    }

    #[test]
    fn at_any_width_type_keeps_its_size() {
        for (asked, width) in [(84.0, 84.0), (174.0, 174.0), (1.0, 60.0), (f64::NAN, 120.0)] {
            let panel = Panel::new(Axis::between("y", 0.0, 1.0)).with([Series::line("", [(0.0, 0.0), (1.0, 1.0)])]);
            let svg = Figure::new("f", "t", Axis::between("x", 0.0, 1.0)).panel(panel).width_mm(asked).to_svg();
            // Four units a millimetre, so that type of 11 units is 7.8 pt.
            let start = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\"");
            assert!(svg.starts_with(&start) && svg.contains(&format!("viewBox=\"0 0 {} ", 4.0 * width)), "{svg}");
            assert!(svg.contains("font-size=\"11\""));
            // The curve ends at the right end of the frame.
            assert!(svg.contains(&format!("L{:.2} ", 4.0 * width - RIGHT)), "{svg}");
        }
    }
}
