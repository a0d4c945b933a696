//! A uniform Euler–Bernoulli beam under an axial force N (tension positive): EI w″″ − N w″ + ρA ẅ = f.

use super::Uniform;
use super::ends::{CLAMPED, End, FREE, GUIDED, PINNED};
use std::f64::consts::PI;

/// ω_i, rad/s, of a pinned–pinned beam: ω_i² = (iπ/L)⁴ (EI/ρA) (1 + N L²/(EI i²π²)), whose modes stay sines (Blevins, table 8-1;
/// Bokaian 1988, J. Sound Vib. 126); NaN beyond buckling.
pub(crate) fn pinned_frequency(beam: Uniform, axial_force: f64, mode: u32) -> f64 {
    let k = f64::from(mode) * PI;
    beam.frequency(k) * (1.0 + axial_force * (beam.span / k).powi(2) / beam.bending).sqrt()
}

/// The least compression under which the beam buckles, N (Euler 1744; Timoshenko and Gere, *Theory of Elastic Stability*):
/// (π/2)², π², 4.4934…² (tan x = x) or 4π² times EI/L². The force keeps its direction. `None` for ends not listed there.
pub(crate) fn buckling_load(span: f64, bending: f64, ends: [End; 2]) -> Option<f64> {
    let is = |a: End, b: End| ends == [a, b] || ends == [b, a];
    let factor = if is(CLAMPED, FREE) || is(PINNED, GUIDED) {
        0.25 * PI * PI
    } else if is(PINNED, PINNED) || is(CLAMPED, GUIDED) {
        PI * PI
    } else if is(CLAMPED, PINNED) {
        CLAMPED_PINNED
    } else if is(CLAMPED, CLAMPED) {
        4.0 * PI * PI
    } else {
        return None;
    };
    Some(factor * bending / (span * span))
}

/// Of the first positive root of tan x = x, its square; by mpmath with 40 digits.
const CLAMPED_PINNED: f64 = 20.190_728_556_426_63;

#[cfg(test)]
mod tests {
    use super::super::tests::agree;
    use super::*;

    const BEAM: Uniform = Uniform { span: 1.3, bending: 2.1, mass: 0.4 };

    #[test]
    fn the_clamped_pinned_column() {
        let x = CLAMPED_PINNED.sqrt();
        agree(x.tan(), x, 1e-14);
        // Timoshenko and Gere: 2.046 π² EI/L².
        agree(buckling_load(1.0, 1.0, [PINNED, CLAMPED]).unwrap() / (PI * PI), 2.046, 2e-4);
    }

    /// The four columns are one: 1/2, 1, 0.699, 2 half waves a span.
    #[test]
    fn the_first_frequency_vanishes_at_buckling() {
        let load = buckling_load(BEAM.span, BEAM.bending, [PINNED, PINNED]).unwrap();
        assert!(pinned_frequency(BEAM, -load * (1.0 - 1e-12), 1) < 2e-6 * BEAM.frequency(PI));
        assert!(pinned_frequency(BEAM, -load * (1.0 + 1e-12), 1).is_nan());
        // Half of it takes half of ω².
        agree(pinned_frequency(BEAM, -0.5 * load, 1).powi(2), 0.5 * BEAM.frequency(PI).powi(2), 1e-14);
        agree(buckling_load(1.0, 1.0, [CLAMPED, CLAMPED]).unwrap(), 39.478_417_604_357_43, 1e-15);
        agree(buckling_load(1.0, 1.0, [CLAMPED, FREE]).unwrap(), 2.467_401_100_272_34, 1e-14);
        assert_eq!(buckling_load(1.0, 1.0, [FREE, FREE]), None);
    }

    /// Without bending stiffness it is a string: ω = iπ/L √(N/ρA).
    #[test]
    fn a_limp_beam_is_a_string() {
        let limp = Uniform { bending: 1e-9, ..BEAM };
        agree(pinned_frequency(limp, 5.0, 2), 2.0 * PI / 1.3 * (5.0_f64 / 0.4).sqrt(), 1e-8);
    }
}
