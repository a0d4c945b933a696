//! Solvers for the frictional contact problems of [`teeter_contact`], with a common trait.
//!
//! Use [`Auto`] by default. It tries cheap methods first, then robust ones, until one converges,
//! and names the method that did. The others are for known problems and for comparisons; the page
//! of each describes its cost and how it fails.
//!
//! | name | dim. | law | method | use it when |
//! |---|---|---|---|---|
//! | [`Auto`] | 2D, 3D | exact | a sequence of the others | by default |
//! | [`Enumeration`] | 2D | exact | all contact states, up to five contacts | always for up to three contacts; four or five for a sure result |
//! | [`Pgs`] | 2D, 3D | exact | Gauss–Seidel over contacts | 1e-4 or so is enough, or contacts are weakly coupled |
//! | [`Newton`] | 2D, 3D | exact | semi-smooth Newton, sparse LU | the initial guess is good, or pgs is slow |
//! | [`Smoothing`] | 2D, 3D | exact | Newton along the central path | the problem is degenerate: packings, hundreds of hyperstatic contacts |
//! | [`Prox`] | 2D, 3D | exact | proximal point around Newton | H is singular and Newton fails |
//! | [`Admm`] | 2D, 3D | exact | alternating directions, one Cholesky factorisation | walls, towers, stacks of up to some thousand contacts |
//! | [`Lemke`] | 2D | exact | pivoting, up to 1000 contacts | some tens of plane contacts for which pgs is slow |
//! | [`AcaryCadoux`] | 2D, 3D | exact | a fixed point over cone programs | robustness matters more than time |
//! | [`ViEg`] | 2D, 3D | exact | projections with an adaptive step | 1e-4 for many contacts without factorisation |
//! | [`Apgd`] | 2D, 3D | exact | accelerated projected gradients | the same, for loose packings |
//! | [`Socp`] | 2D, 3D | **convex** | one cone program | you compare with programs that use this law |
//!
//! The convex law isn't Coulomb's: a sliding contact separates at μ‖u_T‖
//! ([`Law`](teeter_contact::Law)). [`SOLVERS`] lists all solvers with their papers;
//! [`plane_solver`] and [`space_solver`] create one by its name.
//!
//! # Features
//!
//! - `sparse` (default): faer. Brings [`Admm`], and the fill-reducing order for the factorisations
//!   of [`Newton`], [`Smoothing`], [`Prox`] and [`Auto`], which are slow on large problems without
//!   it.
//! - `clarabel` (default): Clarabel. Brings [`Socp`] and [`AcaryCadoux`].
//!
//! Without both the crate depends only on nalgebra.
//!
//! # Example
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

#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "clarabel")]
pub mod acary_cadoux;
#[cfg(feature = "sparse")]
pub mod admm;
#[cfg(feature = "sparse")]
mod anderson;
pub mod apgd;
pub mod auto;
mod basis;
mod block_lu;
mod catalogue;
mod cells;
mod chain;
#[cfg(feature = "clarabel")]
mod cone_program;
#[cfg(test)]
mod conforming;
mod crossover;
mod ending;
pub mod enumeration;
mod least_norm;
pub mod lemke;
mod likely;
mod linearised;
mod local;
mod memory;
pub mod newton;
mod one_contact;
mod one_contact_space;
mod operator;
mod ordering;
mod pairs;
mod parametric;
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
