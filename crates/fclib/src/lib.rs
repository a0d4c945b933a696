//! Reads and writes frictional contact problems in FCLIB's form, an HDF5 layout that other programs
//! of the field share (Acary, Brémond, Koziara, Pérignon 2014, hal-00945820).
//!
//! Of FCLIB's problems this crate knows the *local* ones: given W, q and μ, find the impulses r
//! with u = W r + q and Coulomb's law between u and r. That is [`teeter_contact`]'s problem with
//! H = W and p = r.
//!
//! ```text
//! /fclib_local/spacedim                        int32 [1]      2 or 3
//! /fclib_local/W/m, n, nzmax, nz               int32 [1]      nz: -1 compressed columns, -2 compressed rows, ≥ 0 triplets
//! /fclib_local/W/p, i, x                       int32, int32, float64
//! /fclib_local/vectors/q, mu                   float64
//! /fclib_local/info/title, description, math_info   strings
//! /guesses/number_of_guesses, /guesses/1/u, r …     starts, as many as given
//! /solution/u, r                               a solution
//! ```
//!
//! Optional are `info`, `guesses` and `solution`. A file of an older fclib that names q `vectors/a`
//! is read too. Triplets are read as CSparse has them, and as Siconos writes them: `i` are rows,
//! `p` are columns. Entries that name the same place twice are added up. Refused, with an error
//! that says so: equality constraints (V, R, s) and global problems. Not kept: attributes, and the
//! matrix information (`W/rank`, `W/conditioning` …) that some files hold.
//!
//! What is read is checked, so that a file from elsewhere can't do harm: sizes before memory is
//! taken, indices, finiteness, μ ≥ 0 and H_NN > 0 for each contact.
//!
//! ```no_run
//! use teeter_fclib::FclibProblem;
//!
//! match teeter_fclib::read("problem.hdf5")? {
//!     FclibProblem::Plane(local) => println!("{} contacts in the plane", local.problem()?.contacts()),
//!     FclibProblem::Space(local) => println!("{} contacts in space", local.problem()?.contacts()),
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod matrix;
mod problem;
mod read;
mod store;
mod write;

pub use error::FclibError;
pub use problem::{FclibProblem, Info, LocalProblem, Solution};
pub use read::{from_bytes, read};
