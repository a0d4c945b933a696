//! Answers that don't come from the program under test.

pub(crate) mod beam;
pub(crate) mod housner;
