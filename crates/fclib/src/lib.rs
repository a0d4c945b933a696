//! Reads and writes frictional contact problems in the FCLIB format, an HDF5 layout shared by
//! other contact codes (Acary, Brémond, Koziara, Pérignon 2014, hal-00945820).
//!
//! The crate supports FCLIB's *local* problems: given W, q and μ, find the impulses r with u = W
//! r + q and Coulomb's law between u and r. That is [`teeter_contact`]'s problem with H = W and p =
//! r.
//!
//! ```text
//! /fclib_local/spacedim                        int32 [1]      2 or 3
//! /fclib_local/W/m, n, nzmax, nz               int32 [1]      nz: -1 compressed columns, -2 compressed rows, ≥ 0 triplets
//! /fclib_local/W/p, i, x                       int32, int32, float64
//! /fclib_local/vectors/q, mu                   float64
//! /fclib_local/info/title, description, math_info   strings
//! /guesses/number_of_guesses, /guesses/1/u, r …     initial guesses, as many as given
//! /solution/u, r                               a solution
//! ```
//!
//! The groups `info`, `guesses` and `solution` are optional. Files of older fclib versions, which
//! name q `vectors/a`, are read too. Triplets are read as CSparse and Siconos write them: `i` are
//! rows, `p` are columns. Duplicate entries are added up. Equality constraints (V, R, s) and global
//! problems are refused with an error that says so. Attributes and the matrix information
//! (`W/rank`, `W/conditioning` …) of some files are ignored.
//!
//! Files from untrusted sources are safe to read: sizes are checked before memory is allocated,
//! then indices, finiteness, and μ ≥ 0 and H_NN > 0 for each contact.
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
