//! Measured motion of a block: a table of any layout, read, turned into SI units, and, where it
//! holds coordinates of markers, into the motion of the block by a rigid fit.

mod columns;
mod layout;
mod markers;
mod motion;
mod read;
mod smooth;
mod table;

pub use layout::{ColumnLayout, ColumnSpec, MarkerSpec, line_ranges};
pub use markers::MarkerResidual;
pub use motion::{Channel, MeasuredMotion, Sign};
pub use read::{Measured, MeasuredError};
pub(crate) use smooth::parabola;
pub use smooth::{LEAST_WINDOW, LocalFit, local_fit};

/// Largest file accepted, bytes.
pub const LARGEST_FILE: usize = 64_000_000;
