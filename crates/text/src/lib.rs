//! Configuration in TOML with units, read against a table of keys.
//!
//! A [`schema::Schema`] defines what a document may contain: tables of keys, each with its kind,
//! range, default and meaning. [`decode::parse`] takes the text of a file and overrides of single
//! keys (`--set KEY=VALUE`), and returns a [`document::Document`]: every value by its path, in SI
//! units, with defaults filled in; or all errors at once, as [`diagnostic::Diagnostics`] that point
//! into the file. [`document::Document::to_toml`] converts it back, [`document::Document::with`] is
//! a copy with one key changed. The meaning of the values is not known here.
//!
//! Quantities can be read separately: [`quantity::parse`] reads "36 cm", checked against a
//! [`dimension::Dimension`], to the same double as the number written in SI units.
//!
//! ```
//! use teeter_text::{dimension::Dimension, quantity};
//!
//! assert_eq!(quantity::parse("2.7 g/cm^3", Dimension::DENSITY), Ok(2700.0));
//! let error = quantity::parse("36 metres", Dimension::LENGTH).unwrap_err();
//! assert_eq!(error.did_you_mean(), Some("m"));
//! ```

pub mod decode;
pub mod diagnostic;
pub mod dimension;
pub mod document;
mod judge;
pub mod keys;
pub mod measure;
pub mod quantity;
pub mod readable;
pub mod schema;
mod sets;
pub mod source;
pub mod suggest;
mod syntax;
mod tree;
mod unit_expression;
pub mod units;
pub mod value;
pub mod wording;
