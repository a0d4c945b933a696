//! Wording of messages: that of every document, and of beams.

use crate::scene::BeamScene;
use teeter_beam::Support;
use teeter_integrator::WBackend;

pub use teeter_text::wording::{bytes, duration, expected};

/// The word of a beam support.
#[must_use]
pub fn support(support: Support) -> &'static str {
    match support {
        Support::Pinned => "pinned",
        Support::Clamped => "clamped",
        Support::Guided => "guided",
        Support::Elastic { .. } => "elastic",
        _ => "free",
    }
}

/// How the matrices of a beam are factorised, in words.
#[must_use]
pub fn backend(beam: &BeamScene) -> &'static str {
    match beam.backend {
        _ if beam.reduction.is_some() => "diagonal",
        WBackend::Sparse => "sparse Cholesky, factorised once",
        WBackend::CachedColumns => "banded Cholesky, factorised once, with stored columns of W",
        _ => "banded Cholesky, factorised once",
    }
}

/// The theory of a beam, as in a scene.
#[must_use]
pub fn theory(beam: &BeamScene) -> &'static str {
    if beam.is_sheared() { "timoshenko" } else { "euler-bernoulli" }
}

/// "1/68 of its span".
#[must_use]
pub fn part_of(sag: f64, span: f64) -> String {
    match span / sag {
        f64::INFINITY => "nothing of its span".to_owned(),
        ratio if ratio >= 9.5 => format!("1/{ratio:.0} of its span"),
        ratio if ratio >= 1.0 => format!("1/{ratio:.1} of its span"),
        _ => format!("{:.1e} times its span", sag / span),
    }
}
