//! Closed forms of Euler–Bernoulli beams, as in any handbook of structural mechanics.

use teeter_beam::Support::{self, Clamped, Free, Pinned};

/// The ways to hold a beam that have closed forms here.
pub(crate) const SUPPORTS: [(&str, [Support; 2]); 4] = [
    ("pinned–pinned", [Pinned, Pinned]),
    ("clamped–clamped", [Clamped, Clamped]),
    ("clamped–free", [Clamped, Free]),
    ("clamped–pinned", [Clamped, Pinned]),
];

/// Deflection at `x` of a beam of unit length and unit EI under a unit force at `a`; `None` for other supports than
/// those of [`SUPPORTS`].
pub(crate) fn under_force(supports: [Support; 2], a: f64, x: f64) -> Option<f64> {
    match supports {
        // Symmetric supports: right of the force is left of it seen from the other end.
        [Pinned, Pinned] | [Clamped, Clamped] if x > a => under_force(supports, 1.0 - a, 1.0 - x),
        [Pinned, Pinned] => {
            let b = 1.0 - a;
            Some(b * x * (1.0 - b * b - x * x) / 6.0)
        }
        [Clamped, Clamped] => {
            let b = 1.0 - a;
            Some(b * b * x * x * (3.0 * a - 3.0 * a * x - b * x) / 6.0)
        }
        [Clamped, Free] => {
            let (near, far) = (x.min(a), x.max(a));
            Some(near * near * (3.0 * far - near) / 6.0)
        }
        // A cantilever and the force of its far support.
        [Clamped, Pinned] => {
            let reaction = a * a * (3.0 - a) / 2.0;
            Some(under_force([Clamped, Free], a, x)? - reaction * under_force([Clamped, Free], 1.0, x)?)
        }
        _ => None,
    }
}

/// Deflection at `x` of a beam of unit length and unit EI under a unit load per length; `None` as in [`under_force`].
pub(crate) fn under_uniform_load(supports: [Support; 2], x: f64) -> Option<f64> {
    match supports {
        [Pinned, Pinned] => Some(x * (1.0 - 2.0 * x * x + x * x * x) / 24.0),
        [Clamped, Clamped] => Some((x * (1.0 - x)).powi(2) / 24.0),
        [Clamped, Free] => Some(x * x * (6.0 - 4.0 * x + x * x) / 24.0),
        [Clamped, Pinned] => Some(x * x * (1.0 - x) * (3.0 - 2.0 * x) / 48.0),
        _ => None,
    }
}

/// β_i of the first three modes, ω_i = (β_i/L)² √(EI/ρA): the roots of sin β, cos β cosh β − 1, cos β cosh β + 1 and
/// tan β − tanh β, computed with 25 digits; `None` as in [`under_force`].
pub(crate) fn wave_numbers(supports: [Support; 2]) -> Option<[f64; 3]> {
    use std::f64::consts::PI;
    match supports {
        [Pinned, Pinned] => Some([PI, 2.0 * PI, 3.0 * PI]),
        [Clamped, Clamped] => Some([4.730_040_744_862_704, 7.853_204_624_095_838, 10.995_607_838_001_671]),
        [Clamped, Free] => Some([1.875_104_068_711_961_2, 4.694_091_132_974_175, 7.854_757_438_237_613]),
        [Clamped, Pinned] => Some([3.926_602_312_047_919, 7.068_582_745_628_732, 10.210_176_122_813_031]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn handbook_maxima() {
        let close = |a: Option<f64>, b: f64| assert!(a.is_some_and(|a| (a / b - 1.0).abs() < 1e-14), "{a:?} {b}");
        close(under_force([Pinned, Pinned], 0.5, 0.5), 1.0 / 48.0);
        close(under_force([Clamped, Clamped], 0.5, 0.5), 1.0 / 192.0);
        close(under_force([Clamped, Free], 1.0, 1.0), 1.0 / 3.0);
        close(under_force([Clamped, Pinned], 0.5, 0.5), 7.0 / 768.0);
        close(under_uniform_load([Pinned, Pinned], 0.5), 5.0 / 384.0);
        close(under_uniform_load([Clamped, Clamped], 0.5), 1.0 / 384.0);
        close(under_uniform_load([Clamped, Free], 1.0), 1.0 / 8.0);
        close(under_uniform_load([Clamped, Pinned], 0.5), 1.0 / 192.0);
    }

    /// Maxwell and Betti: the deflection at x under a force at a is that at a under a force at x.
    #[test]
    fn forces_and_places_can_be_exchanged() {
        for (name, supports) in SUPPORTS {
            for (a, x) in [(0.3, 0.45), (0.2, 0.9), (0.61, 0.64)] {
                let pair = (under_force(supports, a, x), under_force(supports, x, a));
                assert!(matches!(pair, (Some(p), Some(q)) if (p - q).abs() < 1e-16), "{name} {pair:?}");
            }
        }
    }

    #[test]
    fn a_uniform_load_is_the_sum_of_forces() {
        for (name, supports) in SUPPORTS {
            let n = 2000;
            let at = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
            let sum: f64 = (0..n).filter_map(|i| under_force(supports, at(i), 0.7)).sum::<f64>() / f64::from(n);
            let load = under_uniform_load(supports, 0.7);
            assert!(load.is_some_and(|load| (sum / load - 1.0).abs() < 1e-6), "{name} {sum} {load:?}");
        }
    }
}
