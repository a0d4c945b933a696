//! What a comparison writes: tables, the same as JSON, figures, a page.

mod figure;
mod json;
mod page;
mod sentences;
mod table;

pub(crate) use figure::motion_figures;
pub use figure::svg_figures;
pub use json::json;
pub use page::page;
pub(crate) use page::{STYLE, fixed, horizon_note};
pub use sentences::sentences_of;
pub(crate) use sentences::{origin_of_side, other_alignments, outliers};
pub use table::{half_cycle_csv, impact_csv, rows_csv};

/// All files that a comparison may write; the figures depend on the table.
pub const FILES: [&str; 11] = [
    "compare.json",
    "compare.csv",
    "half-cycles.csv",
    "impact-pairs.csv",
    "compare.html",
    "figures/phi.svg",
    "figures/omega.svg",
    "figures/x.svg",
    "figures/y.svg",
    "figures/vx.svg",
    "figures/vy.svg",
];
