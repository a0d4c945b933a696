//! Many runs of one scene: what accuracy costs.
//!
//! [`Tradeoff::of`] runs a scene in many settings ([`Axes`]: scheme, step, θ, mesh, modes,
//! kinematics, solver, tolerance), each against a verified [`Reference`], measures their time, and
//! recommends one for each accuracy. [`runner`] runs jobs on all cores, with results in order.
//!
//! [`FirstSteps`] measures what a run will cost. [`step_for`] finds the step that reaches an
//! accuracy, for scenes that give an accuracy instead of a step. [`sweep`] runs parameter studies.
//!
//! Candidates and advice are chosen by counted [`Work`], not by the clock, so they are the same in
//! every run. Settings with warnings of `check` or `run` are not advised, and nothing is advised
//! before the first impacts of the scene have been compared.

mod accuracy;
mod axes;
pub mod compare;
mod comparison;
mod divergence;
mod errors;
mod first_steps;
pub mod fit;
mod horizon;
pub mod measured;
mod recommend;
mod reference;
mod row;
pub mod runner;
mod sampled_motion;
mod search;
mod setting;
mod setting_warning;
mod simulate;
mod source;
pub mod statistics;
pub mod sweep;
mod timing;
mod tradeoff;
mod trial_runs;
mod work;
pub mod write;

pub use accuracy::{ChosenStep, ErrorBasis, NoStep, step_for};
pub use axes::{Axes, SettingAxis};
pub use comparison::ReferenceComparison;
pub use divergence::{DIVERGED, Divergence, FinerStep, divergence};
pub use errors::{ErrorNorms, Errors, Quantity};
pub use first_steps::FirstSteps;
pub use horizon::FirstImpact;
pub use recommend::{Advice, ConfirmedErrors, TARGETS, advise};
pub use reference::{PERTURBATION, Reference, SHARES, VerifyingRun};
pub use row::{CompletedRun, Row, pareto_front, pareto_front_of};
pub use sampled_motion::{Impact, SampledMotion, Sampling};
pub use search::SEARCH_STAGES;
pub use setting::Setting;
pub use setting_warning::SettingWarning;
pub use simulate::Failure;
pub use source::StudyScene;
pub use timing::CpuTime;
pub use tradeoff::{ReportProgress, Tradeoff};
pub use work::Work;
