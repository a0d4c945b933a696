//! The public face of the crate: one binary for all integration tests.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

mod allocations;
mod islands;
mod jammed;
mod kept;
mod laws;
mod many;
mod published;
mod random;
mod reserved;
mod wedged;
