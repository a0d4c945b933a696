//! Answers that don't come from the program under test.

pub(crate) mod beam;
pub(crate) mod housner;

// References whose cases come with the laws and drives that they judge.
pub(crate) mod bouncing_point;
#[cfg_attr(not(test), expect(dead_code, reason = "its case comes with the new laws"))]
pub(crate) mod compliant_impact;
mod extrapolation;
#[cfg_attr(not(test), expect(dead_code, reason = "its case comes with moving ground"))]
pub(crate) mod overturning;
mod root;
#[cfg_attr(not(test), expect(dead_code, reason = "its case comes with moving ground"))]
pub(crate) mod shaken_block;
#[cfg_attr(not(test), expect(dead_code, reason = "its case comes with the new laws"))]
pub(crate) mod three_balls;
