//! Many runs of one scene: what accuracy costs.
//!
//! [`Tradeoff::of`] runs a scene in many settings ([`Axes`]: scheme, step, θ, mesh, modes,
//! kinematics, solver, tolerance), each against a [`Reference`] that is itself verified, measures
//! their time, and says which one to take for which accuracy. [`runner`] does jobs on all cores,
//! with results in order.
//!
//! [`step_for`] finds the step that reaches an accuracy, for scenes that ask for that in place of a
//! step.
//!
//! What is tried and what is advised is decided by counted [`Work`] and not by the clock: it is the
//! same in every run. Nothing is advised that `check` or `run` would warn of, and nothing before
//! the first impacts of the scene have been compared.

mod accuracy;
mod against;
mod axes;
mod errors;
mod horizon;
mod motion;
mod parting;
mod pilots;
mod recommend;
mod reference;
mod row;
pub mod runner;
mod search;
mod setting;
mod simulate;
mod source;
mod timing;
mod tradeoff;
mod warned;
mod work;
pub mod write;

pub use accuracy::{Basis, ChosenStep, NoStep, step_for};
pub use against::Against;
pub use axes::{Axes, Axis};
pub use errors::{Errors, Quantity, Ruler};
pub use horizon::FirstImpact;
pub use motion::{Impact, Motion, Sampling};
pub use parting::{PARTED, Parting, parting};
pub use recommend::{Advice, Held, TARGETS, advise};
pub use reference::{Check, NUDGE, Reference, SHARES};
pub use row::{Done, Row, front, front_of};
pub use search::TOLD as STAGES_TOLD;
pub use setting::Setting;
pub use simulate::Failure;
pub use source::Source;
pub use timing::Cpu;
pub use tradeoff::{Tell, Tradeoff};
pub use warned::Warned;
pub use work::Work;
