//! The public face of the crate: one binary for all integration tests.
#![allow(clippy::unwrap_used, clippy::panic)]

mod jacobians;
mod patterns;
mod random;
mod storages;
