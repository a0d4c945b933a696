//! The legend and its position.

use crate::figure::{Frame, LEFT, RIGHT, WIDTH};
use crate::series::{Dash, Drawn, Mark};
use crate::theme::{Colour, Theme};
use crate::{Series, escaped};
use std::borrow::Cow;
use std::fmt::Write;

/// The position of the legend; always outside the plot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Legend {
    /// In a row above each panel. Names beyond [`LEGEND_WIDTH`] run out of the figure;
    /// [`legend_width`] is the width that a name takes.
    #[default]
    Row,
    /// Above each panel, in as many rows as needed.
    Rows,
    /// In a column at the right of each panel, which widens the figure.
    Beside,
}

/// Width of a legend row above a panel, in the figure's units (a quarter of a millimetre).
pub const LEGEND_WIDTH: f64 = WIDTH - LEFT - RIGHT;

/// Width of an entry within [`LEGEND_WIDTH`], including its symbol and the gap to the next.
#[must_use]
pub fn legend_width(label: &str) -> f64 {
    text_width(label) + SYMBOL + GAP
}

/// The width of a text in label size, in the figure's units (a quarter of a millimetre), in Helvetica or a type as wide; that of letters beyond ASCII
/// is approximate.
#[must_use]
pub fn text_width(text: &str) -> f64 {
    let of = |letter: char| {
        let place = (letter as usize).checked_sub(usize::from(b' '));
        place.and_then(|place| ADVANCES.get(place)).map_or(OTHER_ADVANCE, |advance| f64::from(*advance))
    };
    1e-3 * LABEL_SIZE * text.chars().map(of).sum::<f64>()
}

/// Size of labels, in the figure's units.
const LABEL_SIZE: f64 = 11.0;

/// Widths of the letters of Helvetica from the space on, in thousandths of the size, from its font metrics.
#[rustfmt::skip]
const ADVANCES: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,
    556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,
    1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,
    667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,
    333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
    556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];

/// That of the others: of most Greek letters, signs and letters with accents.
const OTHER_ADVANCE: f64 = 600.0;

/// Distance from the left of a symbol to its name, and from a name to the next symbol.
const SYMBOL: f64 = SAMPLE + AFTER_SAMPLE;
const GAP: f64 = 14.0;

/// Length of a sample of a line.
const SAMPLE: f64 = 14.0;
const AFTER_SAMPLE: f64 = 4.0;

/// Row distance above a panel, and beside it.
pub(crate) const ROW: f64 = 14.0;
const ROW_BESIDE: f64 = 15.0;

/// Distance from the lowest row to the panel below.
const ABOVE: f64 = 8.0;

/// A symbol with its name.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry<'a> {
    pub(crate) symbol: Symbol,
    pub(crate) name: &'a str,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Symbol {
    Line {
        number: usize,
        dash: Dash,
    },
    Marks {
        mark: Mark,
        hollow: bool,
        faint: bool,
        number: usize,
    },
    Swatch(Colour),
    Area(usize),
    Bars(usize),
    /// A dashed line across the panel.
    Guide,
    /// A tick at the top of the panel.
    Tick,
}

impl<'a> Entry<'a> {
    /// The entry of a series; none without a name.
    pub(crate) fn of(series: &'a Series, number: usize) -> Option<Self> {
        let symbol = match series.drawn {
            // A line that is alone somewhere is solid there, and its sample, too.
            Drawn::Line if series.solid_stretches().is_some() => Symbol::Line { number, dash: Dash::ByNumber },
            Drawn::Line => Symbol::Line { number, dash: series.dash },
            Drawn::Marks { mark, hollow } => Symbol::Marks { mark, hollow, faint: series.faint, number },
            Drawn::Area => Symbol::Area(number),
            Drawn::Cells => Symbol::Swatch(Colour::Series(number)),
            Drawn::Bars => Symbol::Bars(number),
        };
        (!series.label().is_empty()).then_some(Self { symbol, name: series.label() })
    }

    /// Whether another one says the same: that lines or bars of a colour have this name, however they are dashed.
    pub(crate) fn says_the_same(&self, other: &Self) -> bool {
        self.has_look_of(other) && self.name == other.name
    }

    /// Whether another one gives the same look another name.
    pub(crate) fn says_another(&self, other: &Self) -> bool {
        self.has_look_of(other) && self.name != other.name
    }

    fn has_look_of(&self, other: &Self) -> bool {
        let number = |symbol: Symbol| match symbol {
            Symbol::Line { number, .. } | Symbol::Bars(number) => Some(number),
            _ => None,
        };
        match (number(self.symbol), number(other.symbol)) {
            (None, None) => self.symbol == other.symbol,
            (own, others) => own == others,
        }
    }

    fn draw(&self, svg: &mut String, theme: Theme, x: f64, y: f64) {
        let _ = match self.symbol {
            Symbol::Line { number, dash } => write!(
                svg,
                "<path d=\"M{x:.2} {:.2}h{SAMPLE}\" {} stroke-width=\"1.6\"/>",
                y - 3.5,
                sample_stroke(number, dash, theme)
            ),
            Symbol::Marks { mark, hollow, faint, number } => {
                let place = mark_path(mark, x + 0.5 * SAMPLE, y - 3.5);
                write!(svg, "<path d=\"{place}\" {}/>", mark_style(number, hollow, faint, theme))
            }
            Symbol::Area(number) => write!(
                svg,
                "<rect x=\"{x:.2}\" y=\"{:.2}\" width=\"{SAMPLE}\" height=\"8\" {}/>",
                y - 8.0,
                area_style(number, theme)
            ),
            Symbol::Bars(number) => write!(
                svg,
                "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{}\" height=\"8\" fill=\"{}\"/>",
                x + 0.25 * SAMPLE,
                y - 8.0,
                0.5 * SAMPLE,
                Colour::Series(number).value(theme)
            ),
            Symbol::Guide => write!(
                svg,
                "<path d=\"M{x:.2} {:.2}h{SAMPLE}\" stroke=\"{}\" stroke-dasharray=\"4 3\" stroke-width=\".8\"/>",
                y - 3.5,
                Colour::Guide.value(theme)
            ),
            Symbol::Tick => write!(
                svg,
                "<path d=\"M{:.2} {:.2}v6\" stroke=\"{}\" stroke-width=\".8\"/>",
                x + 0.5 * SAMPLE,
                y - 7.0,
                Colour::Guide.value(theme)
            ),
            Symbol::Swatch(colour) => write!(
                svg,
                "<rect x=\"{x:.2}\" y=\"{:.2}\" width=\"{SAMPLE}\" height=\"8\" fill=\"{}\" stroke=\"{}\" stroke-width=\".4\"/>",
                y - 8.0,
                colour.value(theme),
                Colour::Ink.value(theme)
            ),
        };
        let _ =
            writeln!(svg, "<text x=\"{:.2}\" y=\"{y:.2}\">{}</text>", x + SAMPLE + AFTER_SAMPLE, escaped(self.name));
    }
}

/// Colour and dash of the sample of a line: of a line on others from the middle of a dash on, as its gap would not be seen at an end.
fn sample_stroke(number: usize, dash: Dash, theme: Theme) -> String {
    match dash {
        Dash::ByNumber | Dash::InPart => stroke(number, dash, theme),
        Dash::Over(lines) => {
            format!("{} stroke-dashoffset=\"{}\"", stroke(number, dash, theme), 0.5 * over(lines)[0])
        }
    }
}

impl Legend {
    /// Row and left end of each entry above a panel; a note takes up the right of the first row, or rows of its own above the entries if it is longer
    /// than the figure is wide.
    fn rows(self, entries: &[Entry], note: Option<&str>, across: f64) -> Vec<(usize, f64)> {
        let lines = note_lines(note, across);
        let (mut row, mut x) = (if lines.len() > 1 { lines.len() } else { 0 }, LEFT);
        let noted = note.filter(|_| lines.len() == 1).map_or(0.0, |note| text_width(note) + GAP);
        let place = |entry: &Entry| {
            let right = across - RIGHT - if row == 0 { noted } else { 0.0 };
            let name = text_width(&fitting(entry.name, across));
            let full = x + SYMBOL + name > right;
            if self == Self::Rows && full && (x > LEFT || noted > 0.0) {
                (row, x) = (row + 1, LEFT);
            }
            let place = (row, x);
            x += SYMBOL + name + GAP;
            place
        };
        entries.iter().map(place).collect()
    }

    /// Height of the legend above a panel beyond the first row.
    pub(crate) fn more_height(self, entries: &[Entry], note: Option<&str>, across: f64) -> f64 {
        ROW * self.last_row(entries, note, across) as f64
    }

    fn last_row(self, entries: &[Entry], note: Option<&str>, across: f64) -> usize {
        let of_note = note_lines(note, across).len().saturating_sub(1);
        match self {
            Self::Beside => of_note,
            Self::Row | Self::Rows => self.rows(entries, note, across).last().map_or(of_note, |last| last.0),
        }
    }

    /// Width and height of the legend at the right of a panel.
    pub(crate) fn beside(self, entries: &[Entry]) -> (f64, f64) {
        if self != Self::Beside || entries.is_empty() {
            return (0.0, 0.0);
        }
        let widest = entries.iter().map(|entry| text_width(entry.name)).fold(0.0, f64::max);
        (SYMBOL + widest + RIGHT, ROW_BESIDE * entries.len() as f64)
    }

    /// Draws the entries and a note for the panel with this frame.
    pub(crate) fn draw(self, svg: &mut String, theme: Theme, frame: &Frame, entries: &[Entry], note: Option<&str>) {
        let (top, across) = (frame.top, frame.across);
        let first = top - ABOVE - self.more_height(entries, note, across);
        for (k, line) in note_lines(note, across).iter().enumerate() {
            let _ = writeln!(
                svg,
                "<text x=\"{}\" y=\"{:.2}\" text-anchor=\"end\" fill=\"{}\">{}</text>",
                across - RIGHT,
                first + ROW * k as f64,
                Colour::Muted.value(theme),
                escaped(line)
            );
        }
        if self == Self::Beside {
            for (k, entry) in entries.iter().enumerate() {
                entry.draw(svg, theme, across, top + 9.0 + ROW_BESIDE * k as f64);
            }
            return;
        }
        for (entry, (row, x)) in entries.iter().zip(self.rows(entries, note, across)) {
            let name = fitting(entry.name, across);
            Entry { symbol: entry.symbol, name: &name }.draw(svg, theme, x, first + ROW * row as f64);
        }
    }
}

/// Room at the left of a note as long as the figure is wide.
pub(crate) const NOTE_LEFT: f64 = 4.0;

/// A note in as few lines as are as wide as the figure, about equally long, broken between words but not before a unit; a word longer than that has a
/// line of its own.
pub(crate) fn note_lines(note: Option<&str>, across: f64) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in note.into_iter().flat_map(|note| note.split(' ')) {
        match words.last_mut() {
            Some(number) if number.ends_with(|c: char| c.is_ascii_digit()) => *number = format!("{number} {word}"),
            _ => words.push(word.to_owned()),
        }
    }
    let widest = across - RIGHT - NOTE_LEFT;
    let lines = filled(&words, widest);
    if lines.len() < 2 {
        return lines;
    }
    // As narrow as they may be without a line more: greedy lines leave one word for the last.
    let narrower = (1..).map(|k| filled(&words, widest - NARROWER * f64::from(k)));
    let narrowest = narrower.take_while(|fewer| fewer.len() == lines.len()).take(MOST_NARROWER).last();
    narrowest.unwrap_or(lines)
}

/// By how much lines are made narrower at a time, and how often at most.
const NARROWER: f64 = 6.0;
const MOST_NARROWER: usize = 100;

/// Words in lines of this width.
fn filled(words: &[String], widest: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words {
        match lines.last_mut() {
            Some(line) if text_width(line) + text_width(word) + 6.0 <= widest => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.clone()),
        }
    }
    lines
}

/// A name as it has room in a row of its own: of one that is longer, its beginning and its end.
fn fitting(name: &str, across: f64) -> Cow<'_, str> {
    let widest = across - RIGHT - LEFT - SYMBOL;
    if text_width(name) <= widest {
        return Cow::Borrowed(name);
    }
    let letters: Vec<char> = name.chars().collect();
    let shortened = |room: usize| -> String {
        let (head, tail) = (room / 2, room - 1 - room / 2);
        let end = &letters[letters.len() - tail..];
        letters[..head].iter().chain(&['…']).chain(end).collect()
    };
    let fits = |shown: &String| text_width(shown) <= widest;
    Cow::Owned((6..letters.len()).rev().map(shortened).find(fits).unwrap_or_else(|| shortened(5.min(letters.len()))))
}

/// Dash and gap of a line that lies on others, which show in its gaps: all have the same period, and each later one has dashes half as long as those of the
/// one below.
fn over(lines: u8) -> [f64; 2] {
    let dash = 8.0 / f64::from(1_u32 << lines);
    [dash, 8.0 - dash]
}

/// Dash patterns that distinguish lines of the same colour.
const DASHES: [&str; 3] = ["none", "5 2.5", "1.5 2"];

/// Colour and dash of a line.
pub(crate) fn stroke(number: usize, dash: Dash, theme: Theme) -> String {
    let by_number = DASHES[number / crate::theme::SERIES_COLOURS % DASHES.len()];
    let dash = match dash {
        Dash::ByNumber => by_number.to_owned(),
        Dash::Over(lines) => {
            let [dash, gap] = over(lines);
            format!("{dash} {gap}")
        }
        Dash::InPart => "3 2".to_owned(),
    };
    let colour = Colour::Series(number);
    format!("stroke=\"{}\" stroke-dasharray=\"{dash}\"", colour.value(theme))
}

/// The style of an area: light, so that several can be told apart where they overlap.
pub(crate) fn area_style(number: usize, theme: Theme) -> String {
    format!("fill=\"{}\" fill-opacity=\".22\" stroke=\"none\"", Colour::Series(number).value(theme))
}

/// Colours of marks: hollow ones are open, filled ones have a thin edge in the background colour,
/// so that overlapping marks remain visible; faint ones are pale.
pub(crate) fn mark_style(number: usize, hollow: bool, faint: bool, theme: Theme) -> String {
    let colour = Colour::Series(number).value(theme);
    let pale = match (faint, hollow) {
        (false, _) => "",
        (true, true) => " stroke-opacity=\".5\" stroke-width=\".8\"",
        (true, false) => " fill-opacity=\".3\"",
    };
    if hollow {
        format!("fill=\"none\" stroke=\"{colour}\"{pale}")
    } else {
        format!("fill=\"{colour}\" stroke=\"{}\" stroke-width=\".4\"{pale}", Colour::Paper.value(theme))
    }
}

/// The outline of a mark. All shapes have similar areas.
pub(crate) fn mark_path(mark: Mark, x: f64, y: f64) -> String {
    match mark {
        Mark::Circle => format!("M{:.2} {y:.2}a2.6 2.6 0 1 0 5.2 0a2.6 2.6 0 1 0 -5.2 0z", x - 2.6),
        Mark::Square => format!("M{:.2} {:.2}h4.6v4.6h-4.6z", x - 2.3, y - 2.3),
        Mark::Triangle => format!("M{x:.2} {:.2}l3.4 5.9h-6.8z", y - 3.7),
        Mark::Diamond => format!("M{x:.2} {:.2}l3.3 3.3l-3.3 3.3l-3.3 -3.3z", y - 3.3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries<'a>(names: &[&'a str]) -> Vec<Entry<'a>> {
        names.iter().map(|name| Entry { symbol: Symbol::Line { number: 0, dash: Dash::ByNumber }, name }).collect()
    }

    #[test]
    fn each_line_on_others_has_dashes_half_as_long() {
        assert_eq!([1, 2, 3].map(over), [[4.0, 4.0], [2.0, 6.0], [1.0, 7.0]]);
        // A sample holds a whole period.
        assert!(over(3).iter().sum::<f64>() <= SAMPLE);
    }

    #[cfg(feature = "pdf")]
    #[test]
    fn a_text_is_as_wide_as_in_the_font_of_pdf_files() {
        let font = ttf_parser::Face::parse(crate::FONT, 0).unwrap();
        for text in
            ["pale: the least and the largest of every 1.6 ms, of means over 100 us", "WEST on MIDDLE", "0.25 (kN)"]
        {
            let advance = |letter| font.glyph_hor_advance(font.glyph_index(letter).unwrap()).unwrap();
            let units: f64 = text.chars().map(|letter| f64::from(advance(letter))).sum();
            let width = LABEL_SIZE * units / f64::from(font.units_per_em());
            assert!((text_width(text) / width - 1.0).abs() < 0.01, "{text}: {} of {width}", text_width(text));
        }
    }

    #[test]
    fn names_wrap_to_the_next_row() {
        let long = "n".repeat(27);
        let entries = entries(&["a", &long, &long, "b"]);
        let rows =
            |legend: Legend, note| legend.rows(&entries, note, WIDTH).iter().map(|place| place.0).collect::<Vec<_>>();
        assert_eq!(rows(Legend::Rows, None), [0, 0, 1, 1]);
        assert_eq!(rows(Legend::Rows, Some("a note that takes about half of the row")), [0, 1, 1, 2]);
        assert_eq!(rows(Legend::Row, None), [0; 4]);
        assert!(
            Legend::Rows.more_height(&entries, None, WIDTH) > 0.0
                && Legend::Row.more_height(&entries, None, WIDTH) == 0.0
        );
    }

    #[test]
    fn a_note_longer_than_the_figure_has_rows_of_its_own() {
        let note = "second on first; pale: raw; mean over 20 ms; peaks cut, up to 300 N over 2 ms; one of many";
        let narrow = 4.0 * 84.0;
        let lines = note_lines(Some(note), narrow);
        assert_eq!((lines.len(), lines.join(" ").as_str()), (2, note), "{lines:?}");
        assert!(lines.iter().all(|line| text_width(line) <= narrow - RIGHT - NOTE_LEFT));
        let entries = entries(&["a", "b"]);
        assert_eq!(
            Legend::Rows.rows(&entries, Some(note), narrow).iter().map(|place| place.0).collect::<Vec<_>>(),
            [2, 2]
        );
        assert_eq!(Legend::Rows.more_height(&entries, Some(note), narrow), 2.0 * ROW);
        assert_eq!(Legend::Row.more_height(&[], Some(note), narrow), ROW);
        assert_eq!(Legend::Row.more_height(&entries, Some("short"), narrow), 0.0);
    }

    #[test]
    fn a_note_leaves_no_unit_alone_in_its_last_line() {
        let note = "plate on table; pale: means over 800 µs; strong: over 10 ms";
        for width in [60.0, 70.0, 84.0, 90.0] {
            let lines = note_lines(Some(note), 4.0 * width);
            assert_eq!(lines.join(" "), note);
            let widths: Vec<f64> = lines.iter().map(|line| text_width(line)).collect();
            let longest = widths.iter().copied().fold(0.0, f64::max);
            assert!(widths.len() == 1 || widths[widths.len() - 1] > 0.4 * longest, "{width}: {lines:?}");
        }
    }

    #[test]
    fn a_name_too_long_for_the_figure_keeps_its_beginning_and_its_end() {
        let name = "the-left-column-of-the-southern-portal: bottom left corner on the second course";
        let shown = fitting(name, 4.0 * 84.0);
        assert!(text_width(&shown) <= 4.0 * 84.0 - LEFT - RIGHT - SYMBOL, "{shown}");
        assert!(
            shown.starts_with("the-left-column") && shown.ends_with("second course") && shown.contains('…'),
            "{shown}"
        );
        assert_eq!(fitting("short", 4.0 * 84.0), "short");
    }

    #[test]
    fn a_name_too_long_for_a_row_gets_its_own() {
        let endless = "n".repeat(300);
        let places = Legend::Rows.rows(&entries(&[&endless, &endless]), None, WIDTH);
        assert_eq!(places, [(0, LEFT), (1, LEFT)]);
    }
}
