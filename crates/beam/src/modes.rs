//! The frequency equation of the continuous beam.
//!
//! For every pair of supports the equation is divided by cosh β, so that nothing overflows:
//!
//! | supports | equation | root number i is near |
//! |---|---|---|
//! | pinned–pinned | sin β = 0 | iπ, exactly |
//! | clamped–clamped, free–free | cos β − 1/cosh β = 0 | (2i + 1) π/2 |
//! | clamped–free | cos β + 1/cosh β = 0 | (2i − 1) π/2 |
//! | clamped–pinned, pinned–free | sin β − cos β tanh β = 0 | (4i + 1) π/4 |
//! | guided–guided | sin β = 0 | iπ, exactly |
//! | guided–pinned | cos β = 0 | (2i − 1) π/2, exactly |
//! | guided–clamped, guided–free | sin β + cos β tanh β = 0 | (4i − 1) π/4 |

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use crate::error::BeamError;
use crate::support::Support::{self, Clamped, Free, Guided, Pinned};

/// Where β still has twelve digits and sits alone in its bracket of width π/2.
const MAX_MODE: usize = 1_000_000;

/// The value and the derivative of a frequency equation.
type Equation = fn(f64) -> (f64, f64);

/// β = k L of elastic mode `mode`, counted from 1 without the rigid motions.
pub(crate) fn beta(supports: [Support; 2], mode: usize) -> Result<f64, BeamError> {
    if mode == 0 || mode > MAX_MODE {
        return Err(BeamError::Count { field: "mode", value: mode, rule: "1 to 1000000" });
    }
    let i = mode as f64;
    let (equation, near): (Equation, f64) = match supports {
        [Pinned, Pinned] | [Guided, Guided] => return Ok(i * PI),
        [Pinned, Guided] | [Guided, Pinned] => return Ok((2.0 * i - 1.0) * FRAC_PI_2),
        [Guided, Clamped | Free] | [Clamped | Free, Guided] => (tan_is_minus_tanh, (4.0 * i - 1.0) * FRAC_PI_4),
        [Clamped, Clamped] | [Free, Free] => (cos_minus_sech, (2.0 * i + 1.0) * FRAC_PI_2),
        [Clamped, Free] | [Free, Clamped] => (cos_plus_sech, (2.0 * i - 1.0) * FRAC_PI_2),
        [Clamped, Pinned] | [Pinned, Clamped] | [Pinned, Free] | [Free, Pinned] => {
            (tan_is_tanh, (4.0 * i + 1.0) * FRAC_PI_4)
        }
        _ => return Err(BeamError::NoFrequencyEquation),
    };
    Ok(root(equation, near))
}

/// Newton's method inside a bracket of ±π/4 that every step narrows; a step that leaves the bracket
/// is a bisection.
fn root(equation: Equation, near: f64) -> f64 {
    let (mut low, mut high) = (near - FRAC_PI_4, near + FRAC_PI_4);
    let rising = equation(low).0 < 0.0;
    let mut x = near;
    // Bisection alone needs 53 steps.
    for _ in 0..64 {
        let (value, derivative) = equation(x);
        if (value < 0.0) == rising {
            low = x;
        } else {
            high = x;
        }
        let newton = x - value / derivative;
        // Asked before the bracket is: at the root Newton's step may round onto the bracket's own
        // end.
        if (newton - x).abs() <= f64::EPSILON * x {
            return newton;
        }
        x = if newton > low && newton < high { newton } else { low + 0.5 * (high - low) };
    }
    x
}

fn cos_minus_sech(b: f64) -> (f64, f64) {
    let sech = 1.0 / b.cosh();
    (b.cos() - sech, -b.sin() + sech * b.tanh())
}

fn cos_plus_sech(b: f64) -> (f64, f64) {
    let sech = 1.0 / b.cosh();
    (b.cos() + sech, -b.sin() - sech * b.tanh())
}

fn tan_is_tanh(b: f64) -> (f64, f64) {
    let (sech, tanh) = (1.0 / b.cosh(), b.tanh());
    (b.sin() - b.cos() * tanh, b.cos() + b.sin() * tanh - b.cos() * sech * sech)
}

fn tan_is_minus_tanh(b: f64) -> (f64, f64) {
    let (sech, tanh) = (1.0 / b.cosh(), b.tanh());
    (b.sin() + b.cos() * tanh, b.cos() - b.sin() * tanh + b.cos() * sech * sech)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blevins, *Formulas for natural frequency and mode shape*, table 8-1, to the digits of double
    /// precision.
    #[test]
    fn published_roots_of_all_nine_pairs() {
        let cc = [4.730040744862704, 7.853204624095838, 10.99560783800167, 14.137165491257464, 17.278759657399483];
        let cf = [1.8751040687119611, 4.694091132974175, 7.854757438237613, 10.995540734875464, 14.13716839104647];
        let cp = [3.9266023120479185, 7.068582745628732, 10.210176122813031, 13.351768777754093, 16.493361431346415];
        let pp = [1.0, 2.0, 3.0, 4.0, 5.0].map(|i| i * PI);
        let table: [([Support; 2], [f64; 5]); 9] = [
            ([Clamped, Clamped], cc),
            ([Free, Free], cc),
            ([Clamped, Free], cf),
            ([Free, Clamped], cf),
            ([Clamped, Pinned], cp),
            ([Pinned, Clamped], cp),
            ([Pinned, Free], cp),
            ([Free, Pinned], cp),
            ([Pinned, Pinned], pp),
        ];
        for (supports, published) in table {
            for (i, expected) in published.into_iter().enumerate() {
                let found = beta(supports, i + 1).unwrap();
                assert!((found / expected - 1.0).abs() < 4e-16, "{supports:?} {} {found} {expected}", i + 1);
            }
        }
    }

    #[test]
    fn high_modes_do_not_overflow() {
        for supports in [[Clamped, Clamped], [Clamped, Free], [Clamped, Pinned]] {
            let (a, b) = (beta(supports, MAX_MODE - 1).unwrap(), beta(supports, MAX_MODE).unwrap());
            assert!((b - a - PI).abs() < 1e-8, "{supports:?}");
        }
    }

    #[test]
    fn mode_zero_and_absurd_modes_are_refused() {
        for mode in [0, MAX_MODE + 1, usize::MAX] {
            let text = beta([Pinned, Pinned], mode).unwrap_err().to_string();
            assert!(text.contains("mode") && text.contains(&mode.to_string()), "{text}");
        }
    }
}
