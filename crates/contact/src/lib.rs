//! The border between those who pose frictional contact problems and those who solve them.
//!
//! This crate holds the problem, the law, the judge and the trait of solvers; it knows nothing of
//! bodies, of time steps or of any particular solver.
//!
//! # The problem
//!
//! Unknown are the impulses `p = (p¹, …, pⁿ)`, each in `R^D` (D = 2 or 3), normal component first.
//! With the Delassus operator `H`, the constant vector `q` and the friction coefficients `μ`,
//!
//! ```text
//! u = H p + q        û = u + (μ‖u_T‖, 0[, 0])
//! K_μ ∋ p ⊥ û ∈ K_μ*          K_μ = { p : ‖p_T‖ ≤ μ p_N },   K_μ* = { u : u_N ≥ μ‖u_T‖ }
//! ```
//!
//! which is the exact Signorini–Coulomb law (De Saxcé and Feng 1998, doi
//! 10.1016/S0895-7177(98)00119-8). Every solution, whatever solver found it, is judged by the same
//! scaled natural-map residual: see [`judge()`].
//!
//! # Storage
//!
//! A [`Delassus`] operator is dense by blocks, block-sparse ([`BlockSparse`]), or matrix-free
//! ([`DelassusOperator`]); a problem borrows it. A solver that needs the blocks, whatever the
//! storage, collects them by [`BlockSparse::gather`] in memory that it keeps. H may be singular, as
//! with two corners of one body, and asymmetric: [`ContactProblem::asymmetry`] reports it, nothing
//! refuses it.
//!
//! # Many contacts
//!
//! Contacts are coupled through the bodies that they share. To assemble H for many of them, name
//! the bodies or velocities that each acts on ([`Incidence`]), take the pattern from that
//! ([`BlockSparse::set_pattern`]) and add blocks to it, in memory that is kept from step to step.
//! [`Islands`] are the parts that are not coupled. An [`OwnedProblem`] owns its data: it is made
//! from a [`Jacobian`], masses and velocities, or is an island of another problem.
//!
//! A solver implements [`ContactSolver`]. Iterative ones that have the velocities at hand call
//! [`judge_velocities`], which saves a product with H. The feature `conformance` brings a harness
//! that any solver can be run through.
//!
//! # Example
//!
//! A contact that is pressed and pushed sideways, harder than friction can hold:
//!
//! ```
//! use nalgebra::{Matrix2, Vector2};
//! use teeter_contact::{ContactProblem, Delassus, judge};
//!
//! let h = [Matrix2::identity()];
//! let q = [Vector2::new(-1.0, 2.0)];
//! let mu = [0.5];
//! let problem = ContactProblem::new(Delassus::Dense(&h), &q, &mu)?;
//! // It slides to the right, so friction is at its limit, to the left.
//! let p = [Vector2::new(1.0, -0.5)];
//! assert!(judge(&problem, &p).global < 1e-15);
//! # Ok::<(), teeter_contact::ProblemError>(())
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]

mod block_sparse;
mod cone;
#[cfg(feature = "conformance")]
pub mod conformance;
mod delassus;
mod incidence;
mod islands;
mod jacobian;
mod judge;
mod owned;
mod problem;
mod solver;

pub use block_sparse::{BlockSparse, BlockSparseError};
pub use cone::{de_saxce, project};
pub use delassus::{Delassus, DelassusOperator};
pub use incidence::Incidence;
pub use islands::Islands;
pub use jacobian::{InverseMass, Jacobian};
pub use judge::{Residual, judge, judge_velocities};
pub use owned::OwnedProblem;
pub use problem::{ContactProblem, ProblemError};
pub use solver::{ContactSolver, Law, Outcome, Status, Stop};

/// The linear algebra that [`Vector`] and [`Block`] are types of. Its version is part of this
/// crate's interface; use this re-export to have the same one.
pub use nalgebra;

/// One contact's impulse or relative velocity: normal component first. N·s or m/s.
pub type Vector<const D: usize> = nalgebra::SVector<f64, D>;

/// One D × D block of a Delassus operator, in 1/kg.
pub type Block<const D: usize> = nalgebra::SMatrix<f64, D, D>;
