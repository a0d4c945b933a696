//! Text with units: quantities such as "36 cm" read to SI, and messages about a file that point into it.
//!
//! [`quantity::parse`] reads a number with its unit, checked against a [`dimension::Dimension`], to the double that the same
//! number in SI units would be. What is wrong with a file is a [`diagnostic::Diagnostic`], with its place in the text, the rule
//! that is broken and what would be right.
//!
//! ```
//! use teeter_text::{dimension::Dimension, quantity};
//!
//! assert_eq!(quantity::parse("2.7 g/cm^3", Dimension::DENSITY), Ok(2700.0));
//! let error = quantity::parse("36 metres", Dimension::LENGTH).unwrap_err();
//! assert_eq!(error.did_you_mean(), Some("m"));
//! ```

pub mod diagnostic;
pub mod dimension;
pub mod measure;
pub mod quantity;
pub mod source;
pub mod suggest;
mod unit_expression;
pub mod units;
