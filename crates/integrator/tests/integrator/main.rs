//! The integrator's public face.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stderr, unsafe_code)]

mod allocations;
mod beam_forces;
mod beams;
mod closed;
mod conforming;
mod coupled_modes;
mod discs;
mod driven;
mod equilibrium;
mod following;
mod going_on;
mod impulses;
mod laws;
mod lengths;
mod misuse;
mod modal;
mod own_parts;
mod projected;
mod reference;
mod scenes;
mod sides;
mod springs;
mod stored;
mod stretched;
mod tension;
mod time;
mod tipping;
