//! Many runs of one scene: what accuracy costs.
//!
//! [`Tradeoff::of`] runs a scene in many settings ([`Axes`]: scheme, step, θ, mesh, modes, kinematics, solver, tolerance), each against a
//! [`Reference`] that is itself verified, measures their time, and says which one to take for which accuracy. [`runner`] does jobs on all cores,
//! with results in order.
//!
//! What is tried and what is advised is decided by counted [`Work`] and not by the clock: it is the same in every run.

mod axes;
mod errors;
mod motion;
mod plan;
mod recommend;
mod reference;
mod row;
pub mod runner;
mod setting;
mod simulate;
mod source;
mod timing;
mod tradeoff;
mod work;
pub mod write;

pub use axes::{Axes, Axis};
pub use errors::{Errors, Quantity, Ruler};
pub use motion::{Impact, Motion, Sampling};
pub use plan::TOLD as STAGES_TOLD;
pub use recommend::{Advice, TARGETS, advise, meets};
pub use reference::{Check, NUDGE, Reference, SHARE};
pub use row::{Done, Row, front, front_of};
pub use setting::Setting;
pub use simulate::Failure;
pub use source::Source;
pub use timing::Cpu;
pub use tradeoff::{Tell, Tradeoff};
pub use work::Work;
