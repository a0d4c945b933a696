//! Accelerograms: reading files of strong-motion databases, correcting records, and computing
//! intensity measures.
//!
//! | format | what is read | unit |
//! |---|---|---|
//! | PEER `.AT2` | new header (`NPTS=  5437, DT=   .0050 SEC`) and old header (`5437   .0050   NPTS, DT`) | g |
//! | ESM ASCII | header lines `KEY: value` (`DYNA` 1.0 to 1.2), one value per line | from `UNITS` |
//! | COSMOS v1.20 | text, integer and real headers, comments, the acceleration block | from the code in the integer header |
//! | table | time and acceleration, or acceleration alone; commas, semicolons or blanks between columns; `#` starts a comment | m/s², or from the heading: `t [ms], a [g]` |
//!
//! [`Record::read`] recognises the format by its content. Accelerations are converted to m/s², with
//! one g being [`STANDARD_GRAVITY`].
//!
//! Between two values the acceleration is linear. Velocities and displacements (including peaks
//! between the values), Arias intensity, significant duration and response spectrum are exact for
//! this function, up to rounding.
//!
//! ```
//! use teeter_record::Record;
//!
//! let file = "PEER STRONG MOTION DATABASE RECORD\nSomewhere, 01/01/70, A STATION, 090\n\
//!             ACCELERATION TIME HISTORY IN UNITS OF G\nNPTS=    4, DT= .01000 SEC\n\
//!             .1000000E+00-.2000000E+00 .1000000E+00 .0000000E+00\n";
//! let record = Record::read(file, "SOME090")?;
//! assert_eq!((record.dt(), record.len()), (0.01, 4));
//! assert_eq!(record.peak_acceleration(), 0.2 * teeter_record::STANDARD_GRAVITY);
//! let twice = record.scaled(2.0)?.baseline_corrected(1)?;
//! let spectrum = twice.spectrum(0.05, &[0.1, 1.0])?;
//! assert!(spectrum[0].pseudo_acceleration() > 0.0);
//! # Ok::<(), teeter_record::RecordError>(())
//! ```

mod corrections;
mod cosmos;
mod cut;
mod decimal;
mod error;
mod esm;
mod format;
mod measures;
mod numbers;
mod peer;
mod record;
mod spectrum;
mod table;
mod units;

pub use decimal::has_decimal_commas;
pub use error::RecordError;
pub use format::Format;
pub use measures::{IntensityMeasure, Peak};
pub use record::{ReadSettings, Record, binary_byte};
pub use spectrum::Response;

/// Standard gravity, m/s²: the unit g of records.
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Largest file size accepted, bytes.
pub const LARGEST_FILE: usize = 64_000_000;

/// Largest number of values of a record.
pub const MOST_VALUES: usize = 2_000_000;

/// Largest magnitude of an acceleration, m/s².
pub const LARGEST_ACCELERATION: f64 = 1e12;
