//! The public face of the crate.
#![allow(clippy::unwrap_used, clippy::panic)]

#[cfg(feature = "animation")]
mod animation;
mod beams;
mod energy;
mod extremes;
mod headlines;
mod impacts;
mod lintel;
mod meetings;
mod memory;
mod network;
mod page;
mod palette;
mod plots;
mod records;
mod sections;
mod sizes;
mod slopes;
mod swings;
mod table;
mod unlocated;
