//! SVG plots for papers and web pages: thin lines, round numbers on the axes, colours suitable for
//! colour-blind readers.
//!
//! A [`Figure`] is one or more stacked [`Panel`]s that share an x [`Axis`]. A panel has a y axis
//! with [`Series`] (lines, staircases, marks), or rows of [`Band`]s such as the states of a
//! contact. A [`Drawing`] shows outlines and lines to scale. Both are 120 mm wide unless set otherwise, without scripts or
//! external resources. Output is deterministic.
//!
//! Axes are created first, from the values to be shown: [`Axis::linear`] and [`Axis::logarithmic`]
//! return an [`AxisError`] for values that are not finite or have no logarithm. Drawing can't fail
//! afterwards: lines are broken where a value is not finite and clipped at the axes.
//!
//! ```
//! use teeter_plot::{Axis, Figure, Mark, Panel, Series};
//!
//! // An error that decreases with the square of the step.
//! let steps = [1e-3, 1e-2, 1e-1];
//! let measured = [1.1e-6, 0.9e-4, 1.0e-2];
//! let x = Axis::logarithmic("Step size h (s)", steps)?;
//! let y = Axis::logarithmic("Error (m)", measured)?;
//! let panel = Panel::new(y).with([
//!     Series::marks("measured", steps.into_iter().zip(measured), Mark::Circle),
//!     Series::line("order 2", steps.map(|h| (h, h * h))).number(0),
//! ]);
//! let svg = Figure::new("order", "Error over step size", x).panel(panel).to_svg();
//! assert!(svg.starts_with("<svg") && svg.contains("Step size h (s)"));
//!
//! // Zero can't be shown on a logarithmic axis.
//! assert!(Axis::logarithmic("Error (m)", [1e-3, 0.0]).is_err());
//! # Ok::<(), teeter_plot::AxisError>(())
//! ```

mod axis;
mod drawing;
mod error;
mod escape;
mod figure;
mod legend;
mod panel;
#[cfg(feature = "pdf")]
mod pdf;
mod series;
mod theme;
mod ticks;

/// The font of figures, as a TrueType file: a subset of Arimo, which has the widths of Arial and Helvetica, with Latin,
/// Greek, Cyrillic, superscripts and the signs of formulas: `assets/README.md` says which letters. Its licence is the SIL Open Font License 1.1 (`assets/OFL.txt`).
#[cfg(feature = "font")]
pub const FONT: &[u8] = include_bytes!("../assets/Arimo-subset.ttf");

pub use axis::Axis;
pub use drawing::Drawing;
pub use error::AxisError;
pub use escape::escaped;
pub use figure::Figure;
pub use legend::{LEGEND_WIDTH, Legend, legend_width, text_width};
pub use panel::{Band, Panel};
#[cfg(feature = "pdf")]
pub use pdf::{PdfError, PdfFigure, svg_to_pdf};
pub use series::{Coincident, MOST_OVER, Mark, Series, coincident, most_over};
pub use theme::{Colour, Theme};
