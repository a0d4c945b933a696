//! The page of a run, `report.html`, and its plots as figures for a paper.
//!
//! [`PageRecorder`] watches a run and keeps what the page shows, in memory that doesn't grow with the run;
//! [`render`] makes the page, one file that loads nothing; [`figures`] makes the plots as SVG.

mod accelerograms;
#[cfg(feature = "animation")]
mod animation;
mod bands;
mod chain;
mod content;
mod crowd;
mod curves;
mod data;
mod drawings;
mod figures;
mod frames;
mod html;
mod jolts;
mod means;
mod network;
mod notes;
mod opening;
mod orbit;
mod outline;
mod packed;
mod panels;
mod placed;
mod recorder;
mod redundant;
mod rocking;
mod scenery;
mod span;
mod thrust;
mod vtk;
mod widths;

pub use accelerograms::{record_figures, record_page, spectrum_periods};
#[cfg(feature = "animation")]
pub use animation::{Animation, AnimationError, AnimationFormat, AnimationInfo, animate};
pub use chain::{Joint, ThrustLine, thrust_lines};
pub use figures::figures;
pub(crate) use figures::is_pair_figure;
pub use html::{STYLE, document, render, unbroken};
pub(crate) use recorder::Kept;
pub use recorder::PageRecorder;
pub use rocking::{HalfCycle, half_cycles};
pub use teeter_plot::escaped;
pub(crate) use vtk::is_vtk_picture;
pub use vtk::{VTK_SERIES, VtkRecorder};
pub use widths::{SIDE_BY_SIDE, for_any_width};

/// A number with so many significant digits: what the page shows needs no more, and a shorter page loads faster.
fn rounded(x: f64, digits: usize) -> f64 {
    // A formatted number always parses; NaN and infinities come back as they are.
    format!("{x:.*e}", digits - 1).parse().unwrap_or(x)
}

/// Significant digits of the quantities on the page.
const DIGITS: usize = 7;

/// Significant digits of its times: enough to tell the steps of any run apart.
const TIME_DIGITS: usize = 12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_keeps_the_digits_asked_for() {
        assert_eq!(rounded(0.1 + 0.2, 7), 0.3);
        assert_eq!(rounded(-1.234_567_89e-12, 7), -1.234_568e-12);
        assert_eq!(rounded(0.0, 7), 0.0);
        assert!(rounded(f64::NAN, 7).is_nan());
        assert_eq!(rounded(f64::INFINITY, 7), f64::INFINITY);
    }
}
