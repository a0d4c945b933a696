//! Limit analysis of plane assemblages of rigid blocks whose joints bear no tension and rub by Coulomb's law.
//!
//! *Static theorem*: an assemblage can stand under its weight only if there are forces of the joints that hold every block in
//! equilibrium and lie in the friction cones. Whether there are is a linear programme: a joint is a segment, what it bears is
//! the normal forces N₁, N₂ ≥ 0 at its ends and the tangential force |T| ≤ μ (N₁ + N₂), and equilibrium is linear in these.
//! [`margin`] and [`stands`] ask whether they exist, [`load_factor`] how far a load can be raised until they don't.
//!
//! Where none exist, the blocks move, whatever the friction does. Where some do, the assemblage *can* stand: velocity
//! zero solves the contact problem of every step. With sliding it needn't be the only solution, as Coulomb's law isn't
//! associated (D. C. Drucker, *Coulomb friction, plasticity, and limit loads*, J. Appl. Mech. 21, 1954): λ of
//! [`load_factor`] is then an upper bound. Without sliding in the mechanism of collapse, λ is exact.
//!
//! The literature's t/R = 0.1067 of the semicircle of 27 voussoirs, R to the centre line, is that of polygons
//! ([`VoussoirWeight::Polygon`]: corners on the circles of intrados and extrados, straight chords between, weight at the polygon's
//! centroid), 0.106721; sectors of the ring with their own weight and centroid give 0.106776, weights on the centre line 0.106757.
//!
//! ```
//! # use teeter_validation::limit_analysis::{LimitError, minimum_thickness};
//! let thickness = minimum_thickness(9, std::f64::consts::PI, 0.5)?;
//! assert!(thickness.is_some_and(|t| 0.09 < t && t < 0.11));
//! # Ok::<(), LimitError>(())
//! ```

mod arch;
mod assemblage;
mod program;
mod thrust_line;

pub use arch::{BRACKET, VoussoirWeight, arch, minimum_thickness, minimum_thickness_with, voussoirs};
pub use assemblage::{Assemblage, Block, Joint, Point, Side};
pub use program::{Load, LoadFactor, accelerated, load_factor, margin, stands};
pub use thrust_line::thrust_line_thickness;

use thiserror::Error;

/// Why there is no answer.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum LimitError {
    /// An assemblage without a block.
    #[error("an assemblage needs a block")]
    Empty,
    /// Fewer than three corners, or not convex, or clockwise.
    #[error("the corners of a convex polygon, counter-clockwise, are needed")]
    NoPolygon,
    /// A weight that isn't positive and finite, at a place that is.
    #[error("a block needs a positive weight at a finite place")]
    NoWeight,
    /// Numbers of no arch.
    #[error("an arch needs voussoirs, an angle between 0 and 2π and a thickness between 0 and twice its radius")]
    Arch,
    /// A coefficient of friction that is negative or not finite.
    #[error("friction must not be negative: {0}")]
    Friction(f64),
    /// A load on no block, or not finite.
    #[error("a load must be finite and act on a block")]
    Load,
    /// The solver of the linear programme did not come to an answer that holds.
    #[error("the linear programme was not solved: {0}")]
    Solver(String),
}
