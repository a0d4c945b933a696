//! A uniform Euler–Bernoulli beam on three pinned supports, at 0, αL and L.
//!
//! *Frequencies.* A span of length l that is pinned at its outer end turns at the inner one by M/(2EI β) (coth βl − cot βl); both
//! spans must turn alike under opposite moments. Times sin βa sin βb, with a + b = 1:
//!
//! ```text
//! sin βa sin βb (coth βa + coth βb) − sin β = 0
//! ```
//!
//! which has no pole, and among its roots the modes without a moment at the support (Karnovsky and Lebed, *Formulas for Structural
//! Dynamics*).
//!
//! *Statics.* Clapeyron's equation of three moments (1857; Timoshenko and Young, *Theory of Structures*) for the moment M over the
//! middle support, spans a and b, load q and a force P at c from the outer end of its span l, all upwards:
//!
//! ```text
//! 2 M (a + b) = q (a³ + b³)/4 + P c (l² − c²)/l
//! ```

use super::ends::PINNED;
use super::roots;
use super::statics::{Bent, Load, Problem};

/// β_1 … β_count with the middle support at `place` (a part of the span): ω_i = (β_i/L)² √(EI/ρA).
pub(crate) fn wave_numbers(place: f64, count: usize) -> Vec<f64> {
    let (a, b) = (place, 1.0 - place);
    let coth = |x: f64| 1.0 / x.tanh();
    let equation = |x: f64| (a * x).sin() * (b * x).sin() * (coth(a * x) + coth(b * x)) - x.sin();
    roots(equation, 0.05, 0.005, count)
}

/// A beam at rest on three supports.
#[derive(Clone, Debug)]
pub(crate) struct TwoSpans {
    /// L, m.
    pub(crate) span: f64,
    /// Of the middle support, m.
    pub(crate) place: f64,
    /// q, N/m.
    pub(crate) uniform: f64,
    /// (place, force), m and N.
    pub(crate) force: (f64, f64),
}

impl TwoSpans {
    /// M over the middle support, N·m.
    pub(crate) fn middle_moment(&self) -> f64 {
        let (a, b) = self.spans();
        let (at, p) = self.force;
        let (c, l) = if at <= self.place { (at, a) } else { (self.span - at, b) };
        (self.uniform * (a.powi(3) + b.powi(3)) / 4.0 + p * c * (l * l - c * c) / l) / (2.0 * (a + b))
    }

    /// What the supports do to the beam, N, upwards, from left to right.
    pub(crate) fn reactions(&self) -> [f64; 3] {
        let (a, b) = self.spans();
        let (m, q) = (self.middle_moment(), self.uniform);
        let (at, p) = self.force;
        // The part of the force that its span's outer support carries.
        let part = |l: f64, from_outer: f64| if from_outer < l { p * (l - from_outer) / l } else { 0.0 };
        let left = m / a - q * a / 2.0 - part(a, at);
        let right = m / b - q * b / 2.0 - part(b, self.span - at);
        [left, -q * self.span - p - left - right, right]
    }

    /// Its shape: the beam on the outer supports alone, with the middle one's reaction as a force.
    pub(crate) fn bent(&self, bending: f64) -> Option<Bent> {
        let loads = vec![
            Load::Uniform(self.uniform),
            Load::Force(self.force.0, self.force.1),
            Load::Force(self.place, self.reactions()[1]),
        ];
        Problem { span: self.span, bending, shear: f64::INFINITY, ends: [PINNED, PINNED], loads }.solve()
    }

    fn spans(&self) -> (f64, f64) {
        (self.place, self.span - self.place)
    }
}

#[cfg(test)]
mod tests {
    use super::super::ends::CLAMPED;
    use super::super::frequencies;
    use super::super::tests::agree;
    use super::*;

    /// By mpmath with 40 digits, from the determinant of the four conditions at the middle support.
    #[test]
    fn unequal_spans() {
        let known = [
            5.782_605_734_251_116,
            8.767_856_133_331_179,
            11.312_915_418_178_166,
            15.707_963_267_948_966,
            17.329_623_482_982_914,
            21.493_917_778_882_288,
            24.476_288_282_598_222,
            27.020_958_267_464_298,
            31.415_926_535_897_93,
            33.037_587_717_288_346,
        ];
        for (found, known) in wave_numbers(0.4, 10).iter().zip(known) {
            agree(*found, known, 1e-14);
        }
        agree(wave_numbers(0.35, 10)[9], 34.256_370_513_984_656, 1e-14);
    }

    /// Equal spans swing against each other as pinned–pinned, or with each other as pinned–clamped.
    #[test]
    fn equal_spans_take_turns() {
        let found = wave_numbers(0.5, 10);
        let halves = [[PINNED, PINNED], [PINNED, CLAMPED]].map(|ends| frequencies::wave_numbers(ends, 5).unwrap());
        for i in 0..5 {
            agree(found[2 * i], 2.0 * halves[0][i], 1e-14);
            agree(found[2 * i + 1], 2.0 * halves[1][i], 1e-14);
        }
    }

    /// 3/8, 10/8, 3/8 of q l and q l²/8 (any handbook).
    #[test]
    fn equal_spans_under_a_uniform_load() {
        let beam = TwoSpans { span: 2.0, place: 1.0, uniform: -1.0, force: (0.3, 0.0) };
        for (found, known) in beam.reactions().iter().zip([0.375, 1.25, 0.375]) {
            agree(*found, known, 1e-14);
        }
        agree(beam.middle_moment(), -0.125, 1e-15);
    }

    /// The beam doesn't move at its middle support, whatever acts.
    #[test]
    fn the_middle_stays() {
        for at in [0.2, 0.7, 0.9, 1.6] {
            let beam = TwoSpans { span: 1.7, place: 0.7, uniform: -1.3, force: (at, 3.0) };
            let bent = beam.bent(2.0).unwrap();
            assert!(bent.at(0.7).deflection.abs() < 1e-16, "{:?}", bent.at(0.7));
            assert!(bent.at(0.35).deflection.abs() + bent.at(1.2).deflection.abs() > 1e-3);
            agree(bent.at(0.7).moment, beam.middle_moment(), 1e-13);
            let [left, _, right] = beam.reactions();
            agree(bent.reactions()[0].force, left, 1e-13);
            agree(bent.reactions()[1].force, right, 1e-13);
        }
    }
}
