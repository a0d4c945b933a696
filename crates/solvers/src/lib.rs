//! Solvers for the frictional contact problems of [`teeter_contact`]: one file each, one trait for all.
//!
//! | name | solves | take it when |
//! |---|---|---|
//! | [`Enumeration`] | 2D, up to three contacts, exactly | always, where it fits |
//! | [`Pgs`] | 2D and 3D, any number of contacts | there are more than three contacts, and 1e-4 or so is enough or they couple weakly |
//! | [`Lemke`] | 2D, up to 1000 contacts, by pivoting | some tens of contacts in the plane on which pgs crawls |
//! | [`Auto`] | 2D | you don't want to choose: contacts that couple are enumerated up to three, else (or if that fails) pgs |
//!
//! ```
//! use nalgebra::{Matrix2, Vector2};
//! use teeter_contact::{ContactProblem, ContactSolver, Delassus, Stop};
//! use teeter_solvers::Auto;
//!
//! let (h, q, mu) = ([Matrix2::identity()], [Vector2::new(-1.0, 2.0)], [0.5]);
//! let problem = ContactProblem::new(Delassus::Dense(&h), &q, &mu)?;
//! let mut p = [Vector2::zeros()];
//! let outcome = Auto::new().solve(&problem, &Stop::default(), &mut p);
//! assert!(outcome.converged() && outcome.used == "enumeration");
//! assert_eq!(p[0], Vector2::new(1.0, -0.5));
//! # Ok::<(), teeter_contact::ProblemError>(())
//! ```

#[cfg(feature = "clarabel")]
pub mod acary_cadoux;
#[cfg(feature = "sparse")]
pub mod admm;
#[cfg(feature = "sparse")]
mod anderson;
pub mod apgd;
pub mod auto;
mod block_lu;
mod catalogue;
mod chain;
#[cfg(feature = "clarabel")]
mod cone_program;
pub mod enumeration;
mod least_norm;
pub mod lemke;
mod likely;
mod linearised;
mod local;
pub mod newton;
mod one_contact;
mod one_contact_space;
mod operator;
mod ordering;
pub mod pgs;
pub mod prox;
mod rows;
mod scaled;
#[cfg(feature = "sparse")]
mod shifted;
mod smooth_map;
pub mod smoothing;
#[cfg(feature = "clarabel")]
pub mod socp;
#[cfg(any(feature = "sparse", feature = "clarabel"))]
mod upper;
pub mod vi_eg;

#[cfg(feature = "clarabel")]
pub use acary_cadoux::AcaryCadoux;
#[cfg(feature = "sparse")]
pub use admm::Admm;
pub use apgd::Apgd;
pub use auto::Auto;
pub use catalogue::{SOLVERS, SolverInfo, plane_solver, space_solver};
pub use enumeration::Enumeration;
pub use lemke::Lemke;
pub use newton::Newton;
pub use pgs::Pgs;
pub use prox::Prox;
pub use smoothing::Smoothing;
#[cfg(feature = "clarabel")]
pub use socp::Socp;
pub use vi_eg::ViEg;
