//! Figures as PDF: the SVG documents of this crate as vector graphics of one page, with the glyphs of the font that they use embedded.
//!
//! It reads what [`Figure::to_svg`](crate::Figure::to_svg) and [`Drawing::to_svg`](crate::Drawing::to_svg) write, and nothing
//! else: an element that it doesn't know is an error, so that no figure loses a part.

mod content;
mod elements;
mod file;
mod font;
mod path;

use content::Content;
use elements::Element;

/// Why a figure can't be written as PDF.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PdfError {
    /// The text is no SVG document of this crate; what of it isn't.
    NotOurs(String),
}

impl std::fmt::Display for PdfError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self::NotOurs(what) = self;
        write!(f, "this is no figure of this program: {what}")
    }
}

impl std::error::Error for PdfError {}

fn not_ours(what: impl Into<String>) -> PdfError {
    PdfError::NotOurs(what.into())
}

/// A figure as a PDF document.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct PdfFigure {
    /// The file.
    pub bytes: Vec<u8>,
    /// Letters that [`FONT`](crate::FONT) lacks, in alphabetical order: boxes stand for them.
    pub missing: Vec<char>,
}

/// A figure as a PDF document, from its SVG: of the same size, with type of the same size in an embedded font. The bytes depend on the
/// figure only.
///
/// ```
/// use teeter_plot::{Axis, Figure, Panel, Series, svg_to_pdf};
///
/// let panel = Panel::new(Axis::between("φ (°)", 0.0, 1.0)).with([Series::line("", [(0.0, 0.0), (1.0, 1.0)])]);
/// let svg = Figure::new("phi", "Angle", Axis::between("t (s)", 0.0, 1.0)).panel(panel).width_mm(84.0).to_svg();
/// let pdf = svg_to_pdf(&svg)?;
/// assert!(pdf.missing.is_empty() && pdf.bytes.starts_with(b"%PDF-1.7"));
/// # Ok::<(), teeter_plot::PdfError>(())
/// ```
///
/// # Errors
/// If the text is no SVG document of this crate for paper.
pub fn svg_to_pdf(svg: &str) -> Result<PdfFigure, PdfError> {
    let root = Element::document(svg)?;
    let font = font::Font::new().ok_or_else(|| not_ours("its font"))?;
    let [width, height] = root.numbers("viewBox")?.get(2..4).and_then(|size| size.try_into().ok()).unwrap_or([0.0; 2]);
    let millimetres = root.attribute("width")?.trim_end_matches("mm").parse::<f64>();
    let across = millimetres.map_err(|_| not_ours("its width"))?;
    if !(across > 0.0 && width > 0.0 && height > 0.0) {
        return Err(not_ours("its size"));
    }
    let points = across * 72.0 / 25.4 / width;
    let mut content = Content::new(&font, height, points);
    content.draw(&root)?;
    let bytes = file::write(content, &font, [width * points, height * points], &root.title());
    Ok(PdfFigure { bytes: bytes.ok_or_else(|| not_ours("its font"))?, missing: font.missing() })
}
