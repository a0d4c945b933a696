//! Answers that don't come from the program under test.

pub(crate) mod beam;
pub(crate) mod beams;
pub(crate) mod bouncing_point;
pub(crate) mod compliant_impact;
mod extrapolation;
pub(crate) mod housner;
pub(crate) mod overturning;
pub(crate) mod root;
pub(crate) mod shaken_block;
pub(crate) mod three_balls;
