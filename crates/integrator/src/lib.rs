//! Non-smooth time integration: subsystems that contacts can act on, schemes that step them, and an
//! energy ledger that checks every step.
//!
//! The layers below know nothing of each other; this crate composes them behind traits:
//!
//! - a [`Subsystem`] is a mechanical model with velocities: [`Blocks`], a [`BeamBody`], a
//!   [`ModalBeam`], the [`Ground`], or yours; it offers forces, products, Jacobian rows and a
//!   [`Compliance`], and owns no state;
//! - a [`Model`] is subsystems, contact laws and a detector, and immutable;
//! - a [`State`] holds all that decides the next step; it is flat, so that it can be cloned and
//!   stored;
//! - a [`Scheme`] owns every formula of time integration and decides which candidates are contacts:
//!   [`MoreauJean`];
//! - a [`Workspace`] holds the memory, the factors and the contact solver of one worker;
//! - [`run`] takes steps and reports each to [`Observer`]s.
//!
//! # Features
//!
//! `bodies` (default) brings [`Blocks`] and [`Ground`], `beam` (default) [`BeamBody`] and
//! [`ModalBeam`], `sparse` (default) a general sparse factor for beams; without them this crate
//! needs neither `teeter-rigid` nor `teeter-beam`, and still serves schemes and bodies of your own.
//! `serde` makes states serialisable; `conformance` brings harnesses for subsystems and schemes of
//! your own.
//!
//! # Example: a block dropped on the ground
//!
//! ```
//! # #[cfg(feature = "bodies")] {
//! use nalgebra::{Vector2, Vector3};
//! use teeter_detect::{Kinematics, PointDetector, PointPair};
//! use teeter_integrator::*;
//! use teeter_rigid::{MassProperties, Rectangle};
//!
//! let shape = Rectangle::new(0.1, 0.05)?;
//! let mass = MassProperties::rectangle(&shape, 0.1, 2700.0)?;
//! let mut parts = ModelBuilder::new();
//! let block = parts.add(Blocks::new(vec![Block::new(mass, &shape)], Vector2::new(0.0, -9.81))).body();
//! let ground = parts.add(Ground::flat(0.0)).body();
//! let law = parts.law(PairLaw::new(0.5, 0.0));
//! let model = parts.build(Box::new(PointDetector::new(vec![PointPair {
//!     pair: 0,
//!     law,
//!     points: shape.corners().to_vec(),
//!     body: block,
//!     surface: ground,
//!     kinematics: Kinematics::Deformed,
//! }])))?;
//!
//! let mut state = State::new(&model, &[0.0, 0.03, 0.0], &[0.0, 0.0, 0.0], 1e-3)?;
//! let mut work = Workspace::new(&model, Box::new(teeter_solvers::Auto::new()), SolverSettings::default());
//! let mut scheme = MoreauJean::new(MoreauJeanSettings::default())?;
//! let ended = run(&model, &mut scheme, &mut state, &mut work, &Plan::steps(100).when_unsolved(Unsolved::End), &mut [])?;
//! assert_eq!(ended, Ended::Complete);
//! assert!(state.v.iter().all(|v| v.abs() < 1e-12), "at rest");
//! assert!((state.q[1] - 0.025).abs() < 1e-3, "on the ground");
//! # }
//! # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]

mod adapters;
mod alpha_step;
mod blend;
mod clock;
mod closed_step;
mod closings;
mod compliance;
#[cfg(feature = "conformance")]
pub mod conformance;
mod contact;
mod coupled_modes;
mod equilibrium;
mod event_driven;
mod factors;
mod free_velocity;
mod gap_cubic;
mod generalized_alpha;
mod grazing;
mod laws;
mod ledger;
mod matrices;
mod memory;
mod mismatch;
mod model;
mod monitor;
mod moreau_jean;
mod moreau_jean_closed;
mod moreau_jean_located;
mod moreau_jean_projected;
mod owed;
mod pair_law;
mod phases;
mod projected_step;
mod projection;
mod propagator;
mod registry;
mod resolved;
mod run;
mod scheme;
mod signal;
mod small;
mod spring;
mod stage;
mod state;
mod step_motion;
#[cfg(feature = "serde")]
mod stored;
mod stretching;
mod subsystem;
mod theta_step;
#[cfg(feature = "parallel")]
mod threads;
mod workspace;

#[cfg(feature = "beam")]
pub use adapters::beam::forces::{BeamForces, SpanLoads};
#[cfg(feature = "beam")]
pub use adapters::beam::{BeamBody, BeamFace, BeamSurface, MovingForce, SharedFactors, SignalLoad, WBackend};
#[cfg(feature = "bodies")]
pub use adapters::blocks::{Block, BlockCoordinate, BlockLoad, Blocks};
#[cfg(feature = "bodies")]
pub use adapters::ground::Ground;
#[cfg(feature = "beam")]
pub use adapters::modal_beam::ModalBeam;
pub use closings::{Closing, ClosingMonitor, Opening, Openings};
pub use compliance::{Compliance, Coupling, FactorError, PartRows};
pub use contact::{Contact, ContactState, tangential};
pub use coupled_modes::{CoupledModes, CoupledModesError, MOST_VELOCITIES, coupled_modes};
pub use equilibrium::{Equilibrium, EquilibriumError, SettlingLimits, settle};
pub use event_driven::{EventDriven, EventDrivenSettings};
pub use factors::{Keep, Responses};
pub use generalized_alpha::{GeneralizedAlpha, GeneralizedAlphaSettings};
pub use ledger::{Ledger, PositiveWork, StepEnergy};
pub use matrices::ConstantMatrices;
pub use memory::Memory;
pub use mismatch::Mismatch;
pub use model::{Model, ModelBuilder, ModelError, Part, PartPlace, Placed};
pub use monitor::{Crossing, LISTED_CROSSINGS, Peak, RockingMonitor};
pub use moreau_jean::{MoreauJean, MoreauJeanSettings};
pub use moreau_jean_closed::{MoreauJeanClosed, MoreauJeanClosedSettings};
pub use moreau_jean_located::{MoreauJeanLocated, MoreauJeanLocatedSettings};
pub use moreau_jean_projected::{MoreauJeanProjected, MoreauJeanProjectedSettings};
pub use pair_law::{ImpactLaw, PairLaw};
pub use phases::{Active, Balance, Phase, PhaseEnd, PhaseKind, StepReport};
pub use propagator::{Dissipated, Propagator};
pub use registry::{SchemeEntry, schemes};
pub use resolved::{Resolved, ResolvedSettings};
pub use run::{Ended, Observer, ObserverError, Plan, RunError, Unsolved, Until, run};
pub use scheme::{Scheme, SettingError, StepError};
pub use signal::{Chirp, Formula, Given, Growth, Motion, Product, Signal, SignalError, Sum, Table};
pub use spring::SpringStep;
pub use stage::{ContactError, ContactStage, Look, Over, Rule};
pub use state::{STEP_ROUNDING, State, StateError, StepSpan, Tally, WarmStart};
pub use stretching::Stretching;
pub use subsystem::{Bodies, Dynamics, Energy, Linearised, Rows, Size, Subsystem, Traits, Weights};
pub use workspace::{Account, SolverSettings, WorkCounts, Workspace};

/// A point, direction, impulse or relative velocity in D dimensions.
pub type Vector<const D: usize> = nalgebra::SVector<f64, D>;
