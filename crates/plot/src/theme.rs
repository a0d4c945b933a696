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
    /// Colour of the series with this number. Each of the seven has a contrast of 3:1 and more against
    /// white, which thin lines need, and each two are told apart by those who can't see red, green or
    /// blue. They repeat.
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
                0 => ("#0050b0", "var(--c0, #0050b0)"),
                1 => ("#e05206", "var(--c1, #e05206)"),
                2 => ("#00a078", "var(--c2, #00a078)"),
                3 => ("#a8618c", "var(--c3, #a8618c)"),
                4 => ("#6a3200", "var(--c4, #6a3200)"),
                5 => ("#3d90e8", "var(--c5, #3d90e8)"),
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

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Relative luminance of a colour as `#rrggbb` (WCAG 2.2).
    pub(crate) fn luminance(colour: &str) -> f64 {
        let part = |at: usize| {
            let x = f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap()) / 255.0;
            if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5)
    }

    #[test]
    fn lines_on_paper_reach_a_contrast_of_3_to_1() {
        for number in 0..SERIES_COLOURS {
            let colour = Colour::Series(number).value(Theme::Paper);
            let contrast = 1.05 / (luminance(colour) + 0.05);
            assert!(contrast >= 3.0, "{colour} has {contrast}");
        }
    }
}
