//! What colours are called by role, and what they look like on paper and on a page.

/// Where a figure is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// On its own, in a file or in print: black on white, plain colours.
    #[default]
    Paper,
    /// Inside an HTML page that has the style of the report: its CSS variables (`--bg`, `--fg`,
    /// `--muted`, `--grid`, `--c0` … `--c6`) decide, so that the figure turns dark with the page;
    /// without them, the colours of paper.
    Page,
}

/// A colour by what it is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Colour {
    /// Colour of the series of this number: those of Okabe and Ito, the light yellow left out, as
    /// it is too faint for a thin line on white. After seven they repeat.
    Series(usize),
    /// Text and frames.
    Ink,
    /// The background.
    Paper,
    /// Text that matters less.
    Muted,
    /// The line of zero, and guides.
    Guide,
    /// Lines of the grid.
    Grid,
    /// Lines of the grid between the labelled ones.
    FineGrid,
    /// Shaded regions.
    Shade,
}

/// How many series have colours of their own.
pub(crate) const SERIES_COLOURS: usize = 7;

impl Colour {
    /// The colour as a value of an SVG attribute.
    #[must_use]
    pub fn value(self, theme: Theme) -> &'static str {
        let (paper, page) = self.values();
        match theme {
            Theme::Paper => paper,
            Theme::Page => page,
        }
    }

    fn values(self) -> (&'static str, &'static str) {
        match self {
            Self::Series(number) => match number % SERIES_COLOURS {
                0 => ("#0072B2", "var(--c0, #0072B2)"),
                1 => ("#D55E00", "var(--c1, #D55E00)"),
                2 => ("#009E73", "var(--c2, #009E73)"),
                3 => ("#CC79A7", "var(--c3, #CC79A7)"),
                4 => ("#E69F00", "var(--c4, #E69F00)"),
                5 => ("#56B4E9", "var(--c5, #56B4E9)"),
                _ => ("#000000", "var(--c6, #000000)"),
            },
            Self::Ink => ("#000", "var(--fg, #000)"),
            Self::Paper => ("#fff", "var(--bg, #fff)"),
            Self::Muted => ("#555", "var(--muted, #555)"),
            Self::Guide => ("#888", "var(--muted, #888)"),
            Self::Grid => ("#ddd", "var(--line, #ddd)"),
            Self::FineGrid => ("#eee", "var(--grid, #eee)"),
            Self::Shade => ("#e6e6e6", "var(--grid, #e6e6e6)"),
        }
    }
}
