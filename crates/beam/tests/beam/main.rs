//! The public face of `teeter-beam`: against closed forms, against an independent implementation, and what it allocates.

// The counting allocator of `allocation` implements an unsafe trait; nothing else here is unsafe.
#![allow(unsafe_code)]
// A helper of a test is a test.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

mod allocation;
mod bad_input;
mod basis;
mod digits;
mod double_double;
mod extremes;
#[cfg(feature = "faer")]
mod frequencies;
mod modes;
mod reference;
mod statics;
mod stepping;
mod under_load;

use teeter_beam::{Beam, BeamSpec, Section, Support};

/// The beam of `docs/theory.md` §8, undamped.
fn spec(elements: usize, supports: [Support; 2]) -> BeamSpec {
    let section = Section::rectangle(0.03, 0.0015, 69e9, 2700.0).unwrap();
    BeamSpec::new(0.36, elements, section).supported(supports)
}

fn beam(elements: usize, supports: [Support; 2]) -> Beam {
    Beam::new(spec(elements, supports)).unwrap()
}

const ALL: [Support; 3] = [Support::Free, Support::Pinned, Support::Clamped];

/// How many rigid motions the supports leave.
fn rigid(supports: [Support; 2]) -> usize {
    let held: usize = supports
        .iter()
        .map(|support| match support {
            Support::Free => 0,
            Support::Pinned => 1,
            _ => 2,
        })
        .sum();
    2_usize.saturating_sub(held)
}
