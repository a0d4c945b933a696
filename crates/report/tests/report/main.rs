//! The public face of the crate.
#![allow(clippy::unwrap_used, clippy::panic)]

mod memory;
mod page;
mod sections;
