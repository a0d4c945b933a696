//! Solvers for the frictional contact problems of [`teeter_contact`]: one file each, one trait for all.
//!
//! | name | solves | take it when |
//! |---|---|---|
//! | [`Enumeration`] | 2D, up to three contacts, exactly | always, where it fits |
//! | [`Pgs`] | 2D and 3D, any number of contacts | there are more than three contacts, and 1e-4 or so is enough or they couple weakly |
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

mod auto;
mod catalogue;
mod enumeration;
mod least_norm;
mod local;
mod one_contact;
mod one_contact_space;
mod pgs;

pub use auto::Auto;
pub use catalogue::{SOLVERS, SolverInfo, plane_solver, space_solver};
pub use enumeration::Enumeration;
pub use pgs::Pgs;
