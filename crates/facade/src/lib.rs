//! Rigid blocks that rock, slide and bounce on elastic beams and on rigid ground, from Rust code: the crates of teeter as one dependency, and a
//! short way to a motion.
//!
//! A [`World`] takes blocks, beams and ground, and gives out a handle for each, so that only what can touch is joined; a
//! [`Simulation`] takes its steps. SI units throughout.
//!
//! # A block that rocks on a beam
//!
//! ```
//! use teeter_sim::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut world = World::new(Vector2::new(0.0, -9.81));
//! let ruler = Section::rectangle(0.03, 0.0015, 69e9, 2700.0)?; // width, thickness, Young's modulus, density
//! let table = world.beam(Beam::new(BeamSpec::new(0.36, 20, ruler))?, Vector2::zeros()); // span, elements; pinned ends
//! let shape = Rectangle::new(0.03, 0.135)?;
//! let mass = MassProperties::rectangle(&shape, 0.03, 2700.0)?; // depth, density
//! let block = world.block(&shape, mass, At::standing(0.18, 0.0).tilted(0.02)); // midspan, on its left corner
//! world.contact(block, table, PairLaw::new(0.5, 0.0)); // friction, restitution
//!
//! let mut run = world.simulate(1e-4)?;
//! run.until(0.2)?;
//! println!("{} steps, block at {:?}", run.state().step, run.position(block)?);
//!
//! assert_eq!(run.state().step, 2000);
//! assert!(run.position(block)?.z.abs() < shape.critical_angle(), "not overturned");
//! assert!(run.ledger().relative_residual() < 1e-12, "every joule is accounted for");
//! # Ok(())
//! # }
//! ```
//!
//! # More of it
//!
//! - **Every step**: [`Simulation::step`] returns a [`StepReport`](integrator::StepReport) with contacts, impulses, residuals and energies;
//!   [`Simulation::watch`] shows all steps to [`Observer`](integrator::Observer)s.
//! - **Another scheme**: [`World::use_scheme`] takes one of [`integrator::schemes`] or your own.
//! - **Another solver**: [`World::use_solver`] takes one of [`solvers::SOLVERS`], by [`solvers::plane_solver`], or your own.
//! - **Another body**: [`World::subsystem`] takes whatever implements [`integrator::Subsystem`].
//! - **Loads and prescribed motion**: [`World::load`], [`World::drive`], [`World::beam_body`], [`integrator::Ground::moving`].
//!
//! ```
//! use teeter_sim::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut world = World::new(Vector2::new(0.0, -9.81));
//! let ground = world.ground(Ground::flat(0.0));
//! let shape = Rectangle::new(0.1, 0.05)?;
//! let mass = MassProperties::rectangle(&shape, 0.1, 2700.0)?;
//! let block = world.block(&shape, mass, At::standing(0.0, 0.0).moving(Vector3::new(1.0, 0.0, 0.0)));
//! world.contact(block, ground, PairLaw::new(0.5, 0.0));
//! world.use_scheme(Box::new(MoreauJeanClosed::new(MoreauJeanClosedSettings::default())?));
//! world.use_solver(plane_solver("pgs").ok_or("no such solver")?, SolverSettings::default());
//!
//! let mut run = world.simulate(1e-3)?;
//! let mut friction = 0.0;
//! while run.time() < 0.3 {
//!     friction += run.step()?.energy().friction;
//! }
//! assert!((friction + 0.5 * mass.mass).abs() < 1e-10, "friction takes ½mv²");
//! # Ok(())
//! # }
//! ```
//!
//! # What stands behind it
//!
//! Nothing here moves anything: a world is built with [`integrator::ModelBuilder`] and stepped by [`integrator::run`], and its motion is that of the
//! same model built by hand, to the last bit. Each crate is here as a module: [`beam`], [`rigid`], [`contact`], [`detect`], [`solvers`], [`integrator`];
//! and [`nalgebra`], for vectors of the version that they take.
//!
//! # Features
//!
//! - `sparse` (default): sparse factorisations by faer, for the solvers of large contact problems (`admm`, and `newton` and its kin), and for beams
//!   that ask for them.
//! - `clarabel`: the contact solvers `socp` and `acary-cadoux`.
//! - `serde`: states can be serialised, for checkpoints.

#![cfg_attr(docsrs, feature(doc_cfg))]

mod at;
mod error;
mod handles;
pub mod prelude;
mod simulation;
mod world;

pub use at::At;
pub use error::SimError;
pub use handles::{BeamHandle, BlockHandle, SurfaceHandle};
pub use simulation::Simulation;
pub use world::World;

pub use nalgebra;
pub use teeter_beam as beam;
pub use teeter_contact as contact;
pub use teeter_detect as detect;
pub use teeter_integrator as integrator;
pub use teeter_rigid as rigid;
pub use teeter_solvers as solvers;
