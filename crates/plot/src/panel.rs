//! A panel: series on axes, or rows of bands.

mod bars;
mod drawing;

use crate::figure::LEFT;
use crate::legend::{Entry, Symbol};
use crate::theme::Colour;
use crate::{Axis, Series};

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
}
