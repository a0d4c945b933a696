//! Wave numbers of a pinned–pinned Euler–Bernoulli beam with a point mass.
//!
//! A harmonic force at a = αL gives the deflection F L³/(2 EI β³) · [sin αβ sin(1−α)β / sin β − sinh αβ sinh(1−α)β / sinh β] there. The mass
//! μρAL presses with its inertia, F = ω² m w, ω² = β⁴ EI/(ρA L⁴), so (times sin β, which has a node at the mass too among the roots)
//!
//! ```text
//! (μβ/2) [sin αβ sin(1−α)β − sin β · sinh αβ sinh(1−α)β / sinh β] = sin β
//! ```
//!
//! (Karnovsky and Lebed, *Formulas for Structural Dynamics*, for α = 1/2.)

use super::{roots, sinh_ratio};

/// β_1 … β_count with a mass of `ratio` times the beam's at `place` (a part of the span): ω_i = (β_i/L)² √(EI/ρA).
pub(crate) fn wave_numbers(ratio: f64, place: f64, count: usize) -> Vec<f64> {
    let (a, b) = (place, 1.0 - place);
    let equation =
        |x: f64| 0.5 * ratio * x * ((a * x).sin() * (b * x).sin() - x.sin() * sinh_ratio(a * x, b * x, x)) - x.sin();
    roots(equation, 0.05, 0.005, count)
}

#[cfg(test)]
mod tests {
    use super::super::end_conditions::{self, LoadedEnd};
    use super::super::ends::{GUIDED, PINNED};
    use super::super::tests::agree;
    use super::*;
    use std::f64::consts::PI;

    /// By mpmath with 40 digits from another equation: the sum of the receptances of all modes, Σ 2 sin²(jπα)/((jπ)⁴ − β⁴) = 1/(μβ⁴).
    #[test]
    fn roots_of_the_modal_sum() {
        let found = wave_numbers(1.0, 0.5, 3);
        agree(found[0], 2.383_190_693_697_139, 1e-14);
        agree(found[1], 2.0 * PI, 1e-14);
        agree(found[2], 8.239_441_432_472_892, 1e-14);
        let found = wave_numbers(0.5, 0.3, 3);
        for (found, known) in found.iter().zip([2.759_336_757_358_901, 5.638_946_346_297_961, 9.334_902_048_311_616]) {
            agree(*found, known, 1e-14);
        }
    }

    /// Half the beam and half the mass at a guided end have the symmetric modes.
    #[test]
    fn symmetric_modes_are_those_of_the_half() {
        let middle = LoadedEnd { end: GUIDED, mass: 0.7, inertia: 0.0 };
        let half = end_conditions::wave_numbers([LoadedEnd::massless(PINNED), middle], 5);
        let whole = wave_numbers(0.7, 0.5, 10);
        for (half, whole) in half.iter().zip(whole.iter().step_by(2)) {
            agree(2.0 * half, *whole, 1e-13);
        }
    }

    #[test]
    fn no_mass_no_change() {
        for (k, found) in (1..).zip(wave_numbers(0.0, 0.37, 10)) {
            agree(found, f64::from(k) * PI, 1e-15);
        }
    }
}
