//! Wave numbers of a uniform Euler–Bernoulli beam with springs, a mass and a rotary inertia at its ends.
//!
//! With L = EI = ρA = 1 and ω² = β⁴, w is a sum of cos βx, sin βx, e^{−βx} and e^{−β(1−x)} (no function grows, so that the determinant
//! keeps its digits for high modes), and the ends say
//!
//! ```text
//! left:   −w‴ = (k − m β⁴) w,    w″ = (κ − J β⁴) w′
//! right:   w‴ = (k − m β⁴) w,   −w″ = (κ − J β⁴) w′
//! ```
//!
//! Four equations whose determinant vanishes at β (Blevins, *Formulas for Natural Frequency and Mode Shape*, 8.1; Karnovsky and Lebed,
//! *Formulas for Structural Dynamics*, have the equations written out).

use super::ends::{End, Hold};
use super::roots;
use nalgebra::{Matrix4, RowVector4};

/// An end of the beam of unit length, EI and ρA: springs in EI/L³ and EI/L, the mass in ρAL, the inertia in ρAL³.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LoadedEnd {
    pub(crate) end: End,
    pub(crate) mass: f64,
    pub(crate) inertia: f64,
}

impl LoadedEnd {
    /// Without a mass.
    pub(crate) fn massless(end: End) -> Self {
        Self { end, mass: 0.0, inertia: 0.0 }
    }
}

/// The grid of β on which roots are looked for starts here, so that rigid motions (β = 0) are left out; a beam on springs softer than
/// 1e-7 EI/L³ would lose its first modes.
const START: f64 = 0.05;

/// Width of that grid. The roots of one beam are about π apart, but the first two on soft springs about a third of the first.
const STEP: f64 = 0.02;

/// β_1 … β_count, ω_i = (β_i/L)² √(EI/ρA).
pub(crate) fn wave_numbers(ends: [LoadedEnd; 2], count: usize) -> Vec<f64> {
    roots(|beta| determinant(ends, beta), START, STEP, count)
}

fn determinant(ends: [LoadedEnd; 2], beta: f64) -> f64 {
    let mut matrix = Matrix4::zeros();
    for (e, (end, x)) in ends.iter().zip([0.0, 1.0]).enumerate() {
        // w, w′/β, w″/β², w‴/β³ of the four functions.
        let (sin, cos) = (beta * x).sin_cos();
        let (left, right) = ((-beta * x).exp(), (-beta * (1.0 - x)).exp());
        let w = RowVector4::new(cos, sin, left, right);
        let slope = RowVector4::new(-sin, cos, -left, right);
        let moment = RowVector4::new(-cos, -sin, left, right);
        let shear = RowVector4::new(sin, -cos, -left, right);
        let sign = if e == 0 { 1.0 } else { -1.0 };
        matrix.set_row(2 * e, &condition(end.end.shift, end.mass, beta, 3, w, sign * shear));
        matrix.set_row(2 * e + 1, &condition(end.end.turn, end.inertia, beta, 1, slope, -sign * moment));
    }
    matrix.determinant()
}

/// (k/βⁿ − m β⁴⁻ⁿ)·place + answer, divided by 1 + |k/βⁿ − m β⁴⁻ⁿ|; `place` alone where it is held.
fn condition(
    hold: Hold,
    mass: f64,
    beta: f64,
    n: i32,
    place: RowVector4<f64>,
    answer: RowVector4<f64>,
) -> RowVector4<f64> {
    let spring = match hold {
        Hold::Held => return place,
        Hold::Spring(k) => k,
        Hold::Free => 0.0,
    };
    let stiffness = spring / beta.powi(n) - mass * beta.powi(4 - n);
    (stiffness * place + answer) / (1.0 + stiffness.abs())
}

#[cfg(test)]
mod tests {
    use super::super::ends::{CLAMPED, ENDS, FREE, PINNED};
    use super::super::frequencies;
    use super::super::tests::agree;
    use super::*;

    fn compare(ends: [LoadedEnd; 2], known: &[f64], within: f64) {
        let found = wave_numbers(ends, known.len());
        assert_eq!(found.len(), known.len());
        for (found, known) in found.iter().zip(known) {
            agree(*found, *known, within);
        }
    }

    #[test]
    fn without_springs_it_is_the_handbook_again() {
        for (_, left) in ENDS {
            for (_, right) in ENDS {
                let known = frequencies::wave_numbers([left, right], 10).unwrap();
                compare([left, right].map(LoadedEnd::massless), &known, 1e-13);
            }
        }
    }

    /// By mpmath with 40 digits from the determinant of cos, sin, cosh, sinh.
    #[test]
    fn free_beam_on_end_springs() {
        let on = |k| LoadedEnd::massless(End { shift: Hold::Spring(k), turn: Hold::Free });
        let known = [
            2.808_875_065_354_188,
            4.504_946_729_275_996,
            6.293_136_515_203_834,
            8.412_978_022_567_112,
            11.197_150_954_489_612,
            14.229_285_031_040_837,
            17.328_414_501_657_27,
            20.450_173_300_504_9,
            23.581_259_565_359_673,
            26.716_764_770_636_736,
        ];
        compare([on(50.0), on(200.0)], &known, 1e-13);
        compare([on(200.0), on(50.0)], &known, 1e-13);
        // Soft springs: the rigid beam's ω² = 2k/m and 6k/m, nearly.
        let known = [0.447_176_332_605_262_9, 0.588_559_184_547_552_1, 4.730_418_701_404_055];
        compare([on(0.02), on(0.02)], &known, 1e-12);
        agree(known[0].powi(4), 2.0 * 0.02, 1e-3);
        agree(known[1].powi(4), 6.0 * 0.02, 1e-3);
    }

    /// As above.
    #[test]
    fn cantilever_on_a_root_spring_and_a_tip_spring() {
        let root = End { shift: Hold::Held, turn: Hold::Spring(3.0) };
        let tip = End { shift: Hold::Spring(20.0), turn: Hold::Free };
        let known = [
            2.734_095_371_115_919_3,
            4.449_509_112_608_389,
            7.292_229_763_368_616,
            10.354_375_713_054_306,
            13.459_971_961_384_92,
            16.580_540_960_873_286,
            19.708_183_460_782_642,
            22.839_777_858_945_894,
            25.973_825_322_878_59,
            29.109_508_734_849_555,
        ];
        compare([root, tip].map(LoadedEnd::massless), &known, 1e-13);
    }

    /// As above; the first of a tip mass as heavy as the beam is 1.2479 in Blevins' table 8-8.
    #[test]
    fn cantilever_with_a_tip_mass() {
        let root = LoadedEnd::massless(CLAMPED);
        let known = [1.247_917_409_606_469_6, 4.031_139_436_714_96, 7.134_132_240_939_746];
        compare([root, LoadedEnd { end: FREE, mass: 1.0, inertia: 0.0 }], &known, 1e-13);
        let known = [
            1.409_796_288_506_927_5,
            3.661_071_146_263_698_7,
            5.687_271_480_872_221,
            8.244_648_414_027_399,
            11.219_292_957_953_533,
        ];
        compare([root, LoadedEnd { end: FREE, mass: 0.5, inertia: 0.01 }], &known, 1e-13);
    }

    /// An inertia at a pinned end that is very large clamps it.
    #[test]
    fn a_large_inertia_clamps() {
        let heavy = LoadedEnd { end: PINNED, mass: 0.0, inertia: 1e9 };
        let found = wave_numbers([LoadedEnd::massless(PINNED), heavy], 2);
        agree(found[0], 3.926_602_312_047_919, 1e-8);
    }
}
