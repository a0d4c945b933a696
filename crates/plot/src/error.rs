//! Errors of creating an axis.

use std::error::Error;
use std::fmt;

/// A value that can't be shown on an axis.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum AxisError {
    /// A value is infinite or not a number.
    NotFinite {
        /// Label of the axis.
        axis: String,
        /// The value.
        value: f64,
    },
    /// A value on a logarithmic axis is zero or negative.
    NotPositive {
        /// Label of the axis.
        axis: String,
        /// The value.
        value: f64,
    },
}

impl fmt::Display for AxisError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { axis, value } => write!(f, "axis «{axis}»: {value} is not a finite number"),
            Self::NotPositive { axis, value } => {
                write!(f, "axis «{axis}»: {value} has no logarithm, but the axis is logarithmic")
            }
        }
    }
}

impl Error for AxisError {}
