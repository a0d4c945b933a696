//! Figures on pages: one for wide windows, one for telephones.

use teeter_plot::{Drawing, Figure, Theme};

/// Width of a figure in a narrow window, mm: about that of a telephone, so that its text is as large as the page's.
const NARROW: f64 = 88.0;

/// Width of a figure where there is room, of those that stand side by side on a page, mm.
pub const SIDE_BY_SIDE: f64 = 120.0;

/// A figure as HTML, in the colours of the page: `wide` mm wide, and once more for windows so narrow that its text would be too
/// small to read there. The style of [`document`](super::document) shows one of the two.
#[must_use]
pub fn for_any_width(figure: &Figure, wide: f64) -> String {
    let svg = |figure: Figure, width: f64| figure.theme(Theme::Page).width_mm(width).to_svg();
    format!(
        "<div class=\"themed wide\">{}</div>\n<div class=\"themed narrow\">{}</div>\n",
        svg(figure.clone(), wide),
        svg(figure.clone().extend_id("narrow"), NARROW)
    )
}

/// The same of a drawing.
pub(super) fn drawing_for_any_width(drawing: &Drawing) -> String {
    let drawing = drawing.clone().theme(Theme::Page);
    format!(
        "<div class=\"page-drawing wide\">{}</div>\n<div class=\"page-drawing narrow\">{}</div>\n",
        drawing.to_svg(),
        drawing.clone().width_mm(NARROW).to_svg()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use teeter_plot::{Axis, Panel, Series};

    #[test]
    fn both_widths_have_clips_of_their_own() {
        let panel = Panel::new(Axis::between("y", 0.0, 1.0)).with([Series::line("", [(0.0, 0.0), (1.0, 1.0)])]);
        let html = for_any_width(&Figure::new("f", "t", Axis::between("x", 0.0, 1.0)).panel(panel), 120.0);
        for clip in ["f-0", "f-narrow-0"] {
            assert_eq!(html.matches(&format!("id=\"{clip}\"")).count(), 1, "{html}");
            assert_eq!(html.matches(&format!("url(#{clip})")).count(), 1, "{html}");
        }
        assert!(html.contains("width=\"120mm\"") && html.contains("width=\"88mm\""), "{html}");
    }
}
