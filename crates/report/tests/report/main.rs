//! The public face of the crate.
#![allow(clippy::unwrap_used, clippy::panic)]

#[cfg(feature = "animation")]
mod animation;
mod beams;
mod carriers;
mod energy;
mod extremes;
mod figures;
mod flights;
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
mod rolling;
mod sections;
mod sides;
mod sizes;
mod slides;
mod slopes;
mod swings;
mod table;
mod unlocated;
