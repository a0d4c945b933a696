//! Frequencies of a pinned–pinned Timoshenko beam (Timoshenko 1921, doi 10.1080/14786442108636264; Han, Benaroya and Wei 1999, doi
//! 10.1006/jsvi.1999.2257).
//!
//! w = W sin kx, r = R cos kx with k = nπ/L make ρA ẅ = GA_s (w″ − r′) and ρI r̈ = EI r″ + GA_s (w′ − r) into
//!
//! ```text
//! ρA ρI ω⁴ − [ρA (EI k² + GA_s) + ρI GA_s k²] ω² + EI GA_s k⁴ = 0
//! ```
//!
//! with two roots: mostly bending, and mostly shear. For n = 0 there is w = 0, r uniform: ω² = GA_s/ρI.

use std::f64::consts::PI;

/// A uniform Timoshenko beam, pinned at both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PinnedTimoshenko {
    /// L, m.
    pub(crate) span: f64,
    /// EI, N·m².
    pub(crate) bending: f64,
    /// GA_s, N.
    pub(crate) shear: f64,
    /// ρA, kg/m.
    pub(crate) mass: f64,
    /// ρI, kg·m; 0 leaves the bending branch only.
    pub(crate) rotary_inertia: f64,
}

impl PinnedTimoshenko {
    /// ω of the branch that is mostly bending, rad/s, with `n` half waves, n ≥ 1.
    pub(crate) fn bending_branch(&self, n: u32) -> f64 {
        let (b, c, root) = self.coefficients(n);
        // 2c/(b + √(b² − 4ac)): no difference of near numbers.
        (2.0 * c / (b + root)).sqrt()
    }

    /// ω of the branch that is mostly shear, rad/s, with `n` half waves, n ≥ 0; infinite without rotary inertia.
    pub(crate) fn shear_branch(&self, n: u32) -> f64 {
        let (b, _, root) = self.coefficients(n);
        ((b + root) / (2.0 * self.mass * self.rotary_inertia)).sqrt()
    }

    /// The lowest frequencies of both branches, in order.
    pub(crate) fn frequencies(&self, count: usize) -> Vec<f64> {
        let waves = u32::try_from(count).unwrap_or(u32::MAX);
        let mut all: Vec<f64> = (1..=waves).map(|n| self.bending_branch(n)).collect();
        all.extend((0..waves).map(|n| self.shear_branch(n)));
        all.sort_by(f64::total_cmp);
        all.truncate(count);
        all
    }

    /// b, c and √(b² − 4ac) of a ω⁴ − b ω² + c.
    fn coefficients(&self, n: u32) -> (f64, f64, f64) {
        let k2 = (f64::from(n) * PI / self.span).powi(2);
        let (translating, turning) =
            (self.mass * (self.bending * k2 + self.shear), self.rotary_inertia * self.shear * k2);
        let (b, c) = (translating + turning, self.bending * self.shear * k2 * k2);
        (b, c, (b * b - 4.0 * self.mass * self.rotary_inertia * c).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::agree;
    use super::*;

    /// A rectangle of height h, unit span, EI and ρA, ν = 0.3, shear factor 5/6: √ω is then the λ of the tables.
    fn rectangle(h: f64) -> PinnedTimoshenko {
        let shear = 5.0 / 6.0 / 2.6 * 12.0 / (h * h);
        PinnedTimoshenko { span: 1.0, bending: 1.0, shear, mass: 1.0, rotary_inertia: h * h / 12.0 }
    }

    /// Lee and Schultz 2004 (doi 10.1016/S0022-460X(03)00047-6), table of the pinned–pinned beam, h/L = 0.1: six digits; the further
    /// digits, and h/L = 0.2, by mpmath with 40.
    #[test]
    fn bending_branch_as_published() {
        let known = [
            3.115_682_466_951_462,
            6.090_661_610_013_878,
            8.840_516_743_370_017,
            11.343_103_799_909_915,
            13.613_165_881_865_918,
            15.679_038_657_287_437,
            17.570_496_194_406_914,
            19.314_183_214_754_504,
            20.932_548_811_411_824,
            22.444_080_777_807_74,
        ];
        for (found, known) in rectangle(0.1).frequencies(10).iter().zip(known) {
            agree(found.sqrt(), known, 1e-15);
        }
    }

    #[test]
    fn both_branches_in_order() {
        let found = rectangle(0.2).frequencies(10);
        let (shear, next, seventh) = (13.032_327_310_257_726, 13.444_274_648_182_272, 13.843_285_670_677_284);
        for (k, known) in [(0, 3.045_330_805_006_939), (5, 12.602_210_985_660_706), (6, shear), (7, next), (8, seventh)]
        {
            agree(found[k].sqrt(), known, 1e-15);
        }
    }

    #[test]
    fn slender_beams_are_those_of_euler_and_bernoulli() {
        agree(rectangle(1e-5).bending_branch(1), PI * PI, 1e-9);
        let no_inertia = PinnedTimoshenko { rotary_inertia: 0.0, ..rectangle(0.1) };
        assert!(no_inertia.shear_branch(1).is_infinite());
        // Without rotary inertia ω² = EI k⁴/ρA / (1 + EI k²/GA_s).
        let k2 = PI * PI;
        agree(no_inertia.bending_branch(1).powi(2), k2 * k2 / (1.0 + k2 / no_inertia.shear), 1e-15);
    }
}
