//! Means of signals over an interval of time, alone and times Legendre polynomials.
//!
//! The moments of f over [a, b] are the means of f(t) P_k(s) for k = 0 … 3, with s = −1 at a and 1
//! at b. The first is the mean. For any g that is cubic in time they give the exact mean of f g: by
//! the four Gauss points of the interval, with [`weights`] that contain f.

/// The first four moments of a signal over a stretch of time.
pub(crate) type Moments = [f64; 4];

/// Gauss–Legendre's four points on [−1, 1].
const POINTS: [f64; 4] =
    [-0.861_136_311_594_052_6, -0.339_981_043_584_856_3, 0.339_981_043_584_856_3, 0.861_136_311_594_052_6];

/// Their weights, of the mean: they sum to 1.
const SHARES: [f64; 4] =
    [0.173_927_422_568_726_93, 0.326_072_577_431_273_07, 0.326_072_577_431_273_07, 0.173_927_422_568_726_93];

/// P₀ … P₃ at s.
fn legendre(s: f64) -> Moments {
    [1.0, s, 1.5 * s * s - 0.5, (2.5 * s * s - 1.5) * s]
}

/// Times in [from, to], and weights, such that Σ weight g(time) is the mean of f g over the stretch
/// for every cubic g.
pub(crate) fn weights(from: f64, to: f64, moments: &Moments) -> [(f64, f64); 4] {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    std::array::from_fn(|i| {
        let p = legendre(POINTS[i]);
        // The projection of g on cubics is exact from four points.
        let weight = moments[0] * p[0] + 3.0 * moments[1] * p[1] + 5.0 * moments[2] * p[2] + 7.0 * moments[3] * p[3];
        (middle + half * POINTS[i], SHARES[i] * weight)
    })
}

/// The moments over [from, to] of a signal that is 0 outside some pieces, from the moments of the
/// pieces.
#[derive(Debug)]
pub(crate) struct Pieces {
    from: f64,
    to: f64,
    sum: Moments,
}

impl Pieces {
    pub(crate) fn over(from: f64, to: f64) -> Self {
        Self { from, to, sum: [0.0; 4] }
    }

    /// One more piece with its moments over [a, b].
    pub(crate) fn add(&mut self, a: f64, b: f64, moments: &Moments) {
        if a <= self.from && b >= self.to {
            self.sum.iter_mut().zip(moments).for_each(|(sum, moment)| *sum += moment);
            return;
        }
        let (share, scale) = ((b - a) / (self.to - self.from), 2.0 / (self.to - self.from));
        for (t, weight) in weights(a, b, moments) {
            let p = legendre((t - self.from) * scale - 1.0);
            self.sum.iter_mut().zip(p).for_each(|(sum, p)| *sum += share * weight * p);
        }
    }

    pub(crate) fn moments(&self) -> Moments {
        self.sum
    }
}

/// The moments of a line from `first` to `last`.
pub(crate) fn of_line(first: f64, last: f64) -> Moments {
    [0.5 * (first + last), (last - first) / 6.0, 0.0, 0.0]
}

/// Gauss–Legendre's eight points: how far they are from the middle, and their shares of the mean.
const EIGHT: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.181_341_891_689_181),
    (0.525_532_409_916_329, 0.156_853_322_938_943_65),
    (0.796_666_477_413_626_7, 0.111_190_517_226_687_23),
    (0.960_289_856_497_536_3, 0.050_614_268_145_188_13),
];

/// The moments of `f` by Gauss' eight points: exact up to f's twelfth power.
pub(crate) fn by_points(from: f64, to: f64, f: impl Fn(f64) -> f64) -> Moments {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut sum = [0.0; 4];
    for (s, share) in EIGHT.into_iter().flat_map(|(s, share)| [(-s, share), (s, share)]) {
        let value = share * f(middle + half * s);
        sum.iter_mut().zip(legendre(s)).for_each(|(sum, p)| *sum += value * p);
    }
    sum
}

/// The moments of sin(middle + kappa s): those of a plane wave, by spherical Bessel functions.
pub(crate) fn of_sine(middle: f64, kappa: f64) -> Moments {
    let ((sin, cos), [j0, j1, j2, j3]) = (middle.sin_cos(), spherical_bessel(kappa));
    [sin * j0, cos * j1, -sin * j2, -cos * j3]
}

/// sin(x)/x for x ≥ 0.
pub(crate) fn sinc(x: f64) -> f64 {
    // The next term is x⁴/120.
    if x < 1e-4 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}

/// Below it j_k are summed by their series; above by recurrence from j₀ and j₁.
const SERIES: f64 = 2.0;

/// Terms after which the series is exact to rounding: the last is 2²⁴/(24! …).
const TERMS: u32 = 14;

/// j₀ … j₃ at x ≥ 0.
fn spherical_bessel(x: f64) -> Moments {
    if x >= SERIES {
        let (sin, cos) = x.sin_cos();
        let j0 = sin / x;
        let j1 = (j0 - cos) / x;
        let j2 = 3.0 * j1 / x - j0;
        return [j0, j1, j2, 5.0 * j2 / x - j1];
    }
    let z = -0.5 * x * x;
    let mut first = 1.0;
    let mut j = [0.0; 4];
    for (k, j) in (0_u32..).zip(&mut j) {
        // x^k/(2k + 1)!! (1 + z/(2k + 3) (1 + z/(2 (2k + 5)) (1 + …)))
        let sum = (1..=TERMS).rev().fold(1.0, |sum, n| 1.0 + z / f64::from(n * (2 * (k + n) + 1)) * sum);
        *j = first * sum;
        first *= x / f64::from(2 * k + 3);
    }
    j
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bessel_functions_are_those_of_the_tables() {
        // Abramowitz and Stegun 10.1.11, by 40 digits.
        let known = [
            (
                0.5,
                [0.958_851_077_208_406, 0.162_537_030_636_066_57, 0.016_371_106_607_993_412, 0.001_174_035_443_867_55],
            ),
            (1.999, [0.455_065_8, 0.435_306_8, 0.198_229_8, 0.060_519_3]),
            (
                5.0,
                [-0.191_784_854_932_627_7, -0.095_089_408_079_170_8, 0.134_731_210_085_125_2, 0.229_820_618_164_295_98],
            ),
        ];
        for (x, j) in known {
            let digits = if x == 1.999 { 2e-4 } else { 1e-15 };
            assert!(spherical_bessel(x).iter().zip(j).all(|(found, j)| (found - j).abs() < digits), "{x}");
        }
        assert_eq!(spherical_bessel(0.0), [1.0, 0.0, 0.0, 0.0]);
        let (below, above) = (spherical_bessel(SERIES.next_down()), spherical_bessel(SERIES));
        assert!(below.iter().zip(above).all(|(below, above)| (below - above).abs() < 2e-15), "{below:?} {above:?}");
    }

    #[test]
    fn four_points_with_a_signal_in_their_weights_are_exact_for_cubics() {
        // f = e^t by its exact moments against g = 1 … t³ on [0.2, 1.7].
        let (from, to) = (0.2_f64, 1.7);
        let powers = |t: f64| {
            let e = t.exp();
            [e, e * (t - 1.0), e * (t * t - 2.0 * t + 2.0), e * (t * t * t - 3.0 * t * t + 6.0 * t - 6.0)]
        };
        let (high, low) = (powers(to), powers(from));
        let exact: Vec<f64> = high.iter().zip(low).map(|(high, low)| (high - low) / (to - from)).collect();
        let mut pieces = Pieces::over(from, to);
        let parts = 64;
        for k in 0..parts {
            let at = |k: i32| from + (to - from) * f64::from(k) / f64::from(parts);
            pieces.add(at(k), at(k + 1), &by_points(at(k), at(k + 1), f64::exp));
        }
        for (k, exact) in (0..).zip(exact) {
            let found: f64 = weights(from, to, &pieces.moments()).iter().map(|(t, w)| w * t.powi(k)).sum();
            assert!((found / exact - 1.0).abs() < 2e-14, "t^{k}: {found} {exact}");
        }
    }
}
