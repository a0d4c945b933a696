//! Housner's rocking block (Housner 1963, Bull. Seism. Soc. Am. 53; `docs/theory.md` §9), by quadrature.
//!
//! Between impacts (4/3) R φ̈ = −g sin(α − φ) for φ > 0, mirrored for φ < 0. With k = 3g/(4R) and the angle φ_m where
//! the block turns round, the energy integral is φ̇² = 2k (cos(α − φ_m) − cos(α − φ)), and an impact takes φ̇⁺ = r φ̇⁻.

/// A block that rocks on a rigid base without slip or bounce.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HousnerBlock {
    /// The angle at which it overturns, rad.
    alpha: f64,
    /// k = 3g/(4R), 1/s².
    k: f64,
    /// φ̇⁺/φ̇⁻ at an impact.
    r: f64,
}

/// One excursion: from the turning point at `peak` to the impact that ends it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Excursion {
    /// Angle of the turning point, rad, signed; the release for the first.
    pub(crate) peak: f64,
    /// Time of the impact, s.
    pub(crate) impact: f64,
}

impl HousnerBlock {
    /// A block `width` by `height` (m) under `gravity` (m/s²).
    pub(crate) fn new(width: f64, height: f64, gravity: f64) -> Self {
        let alpha = (width / height).atan();
        let radius = 0.5 * width.hypot(height);
        Self { alpha, k: 0.75 * gravity / radius, r: 1.0 - 1.5 * alpha.sin().powi(2) }
    }

    /// The first excursions after a release at rest from `tilt` > 0 (rad, below α).
    pub(crate) fn excursions(&self, tilt: f64, count: usize) -> Vec<Excursion> {
        let mut excursions = Vec::with_capacity(count);
        let (mut peak, mut side) = (tilt, 1.0);
        let mut impact = self.fall_time(peak);
        while excursions.len() < count {
            excursions.push(Excursion { peak: side * peak, impact });
            peak = self.next_peak(peak);
            side = -side;
            impact += 2.0 * self.fall_time(peak);
        }
        excursions
    }

    /// Where the block turns round after the impact that ends an excursion to `peak`.
    fn next_peak(&self, peak: f64) -> f64 {
        // Half of cos(α − φ_m) − cos α, as a product that doesn't cancel, and the angle back from it by half angles:
        // an arc cosine near 1 would lose digits.
        let half = (self.alpha - 0.5 * peak).sin() * (0.5 * peak).sin();
        let rest = (0.5 * self.alpha).sin().powi(2) - self.r * self.r * half;
        self.alpha - 2.0 * rest.sqrt().asin()
    }

    /// ∫ dφ/φ̇ from 0 to `peak`. With φ_m − φ = s² the integrand is smooth at the turning point, where φ̇ = 0.
    fn fall_time(&self, peak: f64) -> f64 {
        let rest = self.alpha - peak;
        integrate(peak.sqrt(), |s| {
            let half = 0.5 * s * s;
            let sinc = if half == 0.0 { 1.0 } else { half.sin() / half };
            2.0 / (2.0 * self.k * (rest + half).sin() * sinc).sqrt()
        })
    }
}

/// Abscissas on [−1, 1] and weights of the five-point Gauss–Legendre rule; the rest by symmetry.
const GAUSS: [(f64, f64); 3] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Panels of the composite rule: its error, of order 10, is far below rounding for the smooth integrands here.
const PANELS: usize = 64;

/// ∫ f from 0 to `end`.
fn integrate(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    let half = 0.5 * end / PANELS as f64;
    let mut sum = 0.0;
    for panel in 0..PANELS {
        let centre = (2 * panel + 1) as f64 * half;
        let [(_, w0), (x1, w1), (x2, w2)] = GAUSS;
        let pair = |x: f64| f(centre - half * x) + f(centre + half * x);
        sum += half * (w0 * f(centre) + w1 * pair(x1) + w2 * pair(x2));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computed elsewhere with 30 digits: the source paper's block, released at 5°.
    const IMPACTS: [f64; 6] = [
        0.106_510_249_425_778_7,
        0.292_488_378_620_958_94,
        0.457_536_961_379_415_3,
        0.605_580_582_437_135_2,
        0.739_364_808_550_095_8,
        0.860_926_179_351_288_6,
    ];
    const PEAKS: [f64; 6] = [
        0.087_266_462_599_716_47,
        -0.072_319_679_631_115_32,
        0.060_534_471_094_240_82,
        -0.051_014_749_494_455_97,
        0.043_203_146_385_498_7,
        -0.036_722_558_931_958_936,
    ];

    #[test]
    fn the_quadrature_gives_the_published_digits() {
        let excursions = HousnerBlock::new(0.03, 0.135, 9.81).excursions(5.0_f64.to_radians(), 6);
        for ((found, impact), peak) in excursions.iter().zip(IMPACTS).zip(PEAKS) {
            assert!((found.impact - impact).abs() < 2e-15, "{found:?}");
            assert!((found.peak - peak).abs() < 2e-16, "{found:?}");
        }
    }

    #[test]
    fn small_angles_fall_as_the_linear_equation_says() {
        // t = arcosh(1/(1 − φ₀/α))/p for small α; the next term is of relative order α².
        let block = HousnerBlock::new(1e-3, 1.0, 9.81);
        let (p, ratio) = (block.k.sqrt(), 0.4);
        let linear = (1.0_f64 / (1.0 - ratio)).acosh() / p;
        assert!((block.fall_time(ratio * block.alpha) / linear - 1.0).abs() < 1e-6);
    }
}
