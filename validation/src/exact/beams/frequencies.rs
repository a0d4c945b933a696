//! Wave numbers of a uniform Euler–Bernoulli beam whose ends are free, pinned, clamped or guided: ω_i = (β_i/L)² √(EI/ρA).
//!
//! The frequency equations (Blevins, *Formulas for Natural Frequency and Mode Shape*, table 8-1), divided by cosh β where they would
//! grow with it, each with one root in the interval of its mode:
//!
//! | ends | equation | i-th root, i = 1, 2, … |
//! |---|---|---|
//! | clamped–clamped, free–free | cos β − 1/cosh β = 0 | in (iπ, iπ + π) |
//! | clamped–free | cos β + 1/cosh β = 0 | in (iπ − π, iπ) |
//! | clamped–pinned, free–pinned | sin β − tanh β cos β = 0 | in (iπ, iπ + π/2) |
//! | clamped–guided, free–guided | sin β + tanh β cos β = 0 | in (iπ − π/2, iπ) |
//! | pinned–pinned, guided–guided | | iπ |
//! | pinned–guided | | iπ − π/2 |
//!
//! Motions of the rigid beam (ω = 0) are not counted.

use super::super::root::boundary;
use super::ends::{CLAMPED, End, FREE, GUIDED, PINNED};
use std::f64::consts::PI;

/// β_1 … β_count; `None` for ends with springs.
pub(crate) fn wave_numbers(ends: [End; 2], count: usize) -> Option<Vec<f64>> {
    let is = |a: End, b: End| ends == [a, b] || ends == [b, a];
    let near = |x: f64| (x.cos(), 1.0 / x.cosh());
    let tangent = |x: f64, sign: f64| x.sin() + sign * x.tanh() * x.cos();
    let root = |i: f64| {
        let middle = i * PI;
        if is(CLAMPED, CLAMPED) || is(FREE, FREE) {
            Some(crossing(middle, middle + PI, |x| near(x).0 - near(x).1))
        } else if is(CLAMPED, FREE) {
            Some(crossing(middle - PI, middle, |x| near(x).0 + near(x).1))
        } else if is(CLAMPED, PINNED) || is(FREE, PINNED) {
            Some(crossing(middle, middle + 0.5 * PI, |x| tangent(x, -1.0)))
        } else if is(CLAMPED, GUIDED) || is(FREE, GUIDED) {
            Some(crossing(middle - 0.5 * PI, middle, |x| tangent(x, 1.0)))
        } else if is(PINNED, PINNED) || is(GUIDED, GUIDED) {
            Some(middle)
        } else if is(PINNED, GUIDED) {
            Some(middle - 0.5 * PI)
        } else {
            None
        }
    };
    (1..=count).map(|i| root(i as f64)).collect()
}

/// Where `f` changes its sign.
fn crossing(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let rises = f(high) > 0.0;
    boundary(low, high, |x| (f(x) > 0.0) == rises)
}

#[cfg(test)]
mod tests {
    use super::super::tests::agree;
    use super::*;

    /// Roots by mpmath with 40 digits; the first five of each are in Blevins' table 8-1 too.
    #[test]
    fn ten_roots_of_each() {
        let known = [
            (
                [[CLAMPED, CLAMPED], [FREE, FREE]],
                [
                    4.730_040_744_862_704,
                    7.853_204_624_095_838,
                    10.995_607_838_001_671,
                    14.137_165_491_257_464,
                    17.278_759_657_399_48,
                    20.420_352_245_626_06,
                    23.561_944_902_040_455,
                    26.703_537_555_508_188,
                    29.845_130_209_103_253,
                    32.986_722_862_692_82,
                ],
            ),
            (
                [[CLAMPED, FREE], [FREE, CLAMPED]],
                [
                    1.875_104_068_711_961_1,
                    4.694_091_132_974_175,
                    7.854_757_438_237_613,
                    10.995_540_734_875_467,
                    14.137_168_391_046_47,
                    17.278_759_532_088_237,
                    20.420_352_251_041_25,
                    23.561_944_901_806_445,
                    26.703_537_555_518_3,
                    29.845_130_209_102_816,
                ],
            ),
            (
                [[CLAMPED, PINNED], [PINNED, FREE]],
                [
                    3.926_602_312_047_919,
                    7.068_582_745_628_732,
                    10.210_176_122_813_031,
                    13.351_768_777_754_094,
                    16.493_361_431_346_41,
                    19.634_954_084_936_208,
                    22.776_546_738_526,
                    25.918_139_392_115_794,
                    29.059_732_045_705_587,
                    32.201_324_699_295_384,
                ],
            ),
            (
                [[CLAMPED, GUIDED], [GUIDED, FREE]],
                [
                    2.365_020_372_431_352,
                    5.497_803_919_000_836,
                    8.639_379_828_699_74,
                    11.780_972_451_020_228,
                    14.922_565_104_551_627,
                    18.064_157_758_141_31,
                    21.205_750_411_731_103,
                    24.347_343_065_320_9,
                    27.488_935_718_910_692,
                    30.630_528_372_500_486,
                ],
            ),
        ];
        for (pairs, roots) in known {
            for ends in pairs {
                for (found, root) in wave_numbers(ends, 10).unwrap().iter().zip(roots) {
                    agree(*found, root, 4e-16);
                }
            }
        }
        assert_eq!(wave_numbers([PINNED, PINNED], 2), Some(vec![PI, 2.0 * PI]));
        assert_eq!(wave_numbers([PINNED, GUIDED], 2), Some(vec![0.5 * PI, 1.5 * PI]));
    }
}
