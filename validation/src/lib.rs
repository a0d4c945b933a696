//! Answers for assemblages of blocks that don't come from the program under test.
//!
//! The validation ladder itself is the program of this package.

pub mod limit_analysis;
