//! Colours by role, on paper and in a web page.

/// The medium in which a figure is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// A file or print: black on white, fixed colours.
    #[default]
    Paper,
    /// An HTML page in the style of the report. The page's CSS variables (`--bg`, `--fg`,
    /// `--muted`, `--grid`, `--c0` … `--c6`) set the colours, so that the figure follows its dark
    /// mode; without them, the colours are those for paper.
    Page,
}

/// A colour by its role.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Colour {
    /// Colour of the series with this number, from the palette of Okabe and Ito without its yellow,
    /// which is too faint for thin lines on white. The seven colours repeat.
    Series(usize),
    /// Text and frames.
    Ink,
    /// The background.
    Paper,
    /// Secondary text.
    Muted,
    /// The zero line and guides.
    Guide,
    /// Lines of the grid.
    Grid,
    /// Lines of the grid between the labelled ones.
    FineGrid,
    /// Shaded regions.
    Shade,
}

/// Number of different series colours.
pub(crate) const SERIES_COLOURS: usize = 7;

impl Colour {
    /// The colour as an SVG attribute value.
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
