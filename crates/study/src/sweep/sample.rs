//! Random values of keys, the same on every machine and in every order in which cases run: each
//! number follows from the seed, the key and the sample alone.

/// How samples are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// Each value is drawn by itself.
    Independent,
    /// Latin hypercube: with n samples, each of n equally likely intervals of each key holds one
    /// (McKay, Beckman, Conover 1979, doi 10.1080/00401706.1979.10489755).
    LatinHypercube,
}

/// The distribution of a key's values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Distribution {
    Uniform {
        low: f64,
        high: f64,
    },
    /// The logarithm is uniform.
    LogUniform {
        low: f64,
        high: f64,
    },
    Normal {
        mean: f64,
        deviation: f64,
    },
    /// The logarithm is normal, about that of the median.
    LogNormal {
        median: f64,
        deviation: f64,
    },
}

impl Distribution {
    /// The value that a share `u` of all values (between 0 and 1) is below.
    pub(crate) fn quantile(self, u: f64) -> f64 {
        match self {
            Self::Uniform { low, high } => low + u * (high - low),
            Self::LogUniform { low, high } => low * (u * (high / low).ln()).exp(),
            Self::Normal { mean, deviation } => mean + deviation * normal_quantile(u),
            Self::LogNormal { median, deviation } => median * (deviation * normal_quantile(u)).exp(),
        }
    }
}

/// The quantile of the standard normal distribution by Wichura's rational functions (algorithm AS
/// 241, 1988, doi 10.2307/2347330), with a relative error of about 1e-16.
fn normal_quantile(u: f64) -> f64 {
    const A: [f64; 8] = [
        3.387_132_872_796_366_5,
        1.331_416_678_917_843_8e2,
        1.971_590_950_306_551_3e3,
        1.373_169_376_550_946e4,
        4.592_195_393_154_987e4,
        6.726_577_092_700_87e4,
        3.343_057_558_358_813e4,
        2.509_080_928_730_122_7e3,
    ];
    const B: [f64; 8] = [
        1.0,
        4.231_333_070_160_091e1,
        6.871_870_074_920_579e2,
        5.394_196_021_424_751e3,
        2.121_379_430_158_66e4,
        3.930_789_580_009_271e4,
        2.872_908_573_572_194_3e4,
        5.226_495_278_852_854e3,
    ];
    const C: [f64; 8] = [
        1.423_437_110_749_683_5,
        4.630_337_846_156_546,
        5.769_497_221_460_691,
        3.647_848_324_763_204_5,
        1.270_458_252_452_368_4,
        2.417_807_251_774_506e-1,
        2.272_384_498_926_918_4e-2,
        7.745_450_142_783_414e-4,
    ];
    const D: [f64; 8] = [
        1.0,
        2.053_191_626_637_759,
        1.676_384_830_183_803_8,
        6.897_673_349_851e-1,
        1.481_039_764_274_800_8e-1,
        1.519_866_656_361_645_7e-2,
        5.475_938_084_995_345e-4,
        1.050_750_071_644_416_9e-9,
    ];
    const E: [f64; 8] = [
        6.657_904_643_501_103,
        5.463_784_911_164_114,
        1.784_826_539_917_291_3,
        2.965_605_718_285_048_7e-1,
        2.653_218_952_657_612_4e-2,
        1.242_660_947_388_078_4e-3,
        2.711_555_568_743_487_6e-5,
        2.010_334_399_292_288_1e-7,
    ];
    const F: [f64; 8] = [
        1.0,
        5.998_322_065_558_88e-1,
        1.369_298_809_227_358e-1,
        1.487_536_129_085_061_5e-2,
        7.868_691_311_456_133e-4,
        1.846_318_317_510_054_8e-5,
        1.421_511_758_316_446e-7,
        2.044_263_103_389_939_8e-15,
    ];
    let ratio = |above: &[f64; 8], below: &[f64; 8], x: f64| {
        let sum = |terms: &[f64; 8]| terms.iter().rev().fold(0.0, |sum, term| sum * x + term);
        sum(above) / sum(below)
    };
    let from_middle = u - 0.5;
    if from_middle.abs() <= 0.425 {
        return from_middle * ratio(&A, &B, 0.180_625 - from_middle * from_middle);
    }
    let r = (-u.min(1.0 - u).ln()).sqrt();
    let x = if r <= 5.0 { ratio(&C, &D, r - 1.6) } else { ratio(&E, &F, r - 5.0) };
    x.copysign(from_middle)
}

/// The samples of a study.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sampler {
    seed: u64,
    /// For Latin hypercubes the interval of each sample, by keys.
    strata: Vec<Vec<u32>>,
    count: u64,
}

impl Sampler {
    /// Samples of so many keys.
    pub(crate) fn new(seed: u64, method: Method, keys: usize, count: u32) -> Self {
        let strata = match method {
            Method::Independent => Vec::new(),
            Method::LatinHypercube => (0..keys as u64).map(|key| permutation(seed, key, count)).collect(),
        };
        Self { seed, strata, count: u64::from(count) }
    }

    /// The share, between 0 and 1, at which a key's distribution is evaluated for a sample.
    pub(crate) fn share(&self, key: usize, sample: u64) -> f64 {
        let within = unit(mixed(self.seed, key as u64, 2 * sample));
        let stratum = usize::try_from(sample).ok().and_then(|sample| self.strata.get(key)?.get(sample));
        stratum.map_or(within, |&stratum| (f64::from(stratum) + within) / self.count as f64)
    }
}

/// The numbers 0 to `count − 1` in random order.
fn permutation(seed: u64, key: u64, count: u32) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count).collect();
    for k in (1..order.len()).rev() {
        let random = mixed(seed, key, 2 * k as u64 + 1);
        // The bias of the remainder is below 1e-9 for any count that fits in memory.
        order.swap(k, (random % (k as u64 + 1)) as usize);
    }
    order
}

/// A number in (0, 1), neither end included.
fn unit(bits: u64) -> f64 {
    ((bits >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
}

/// Mixes three numbers to one that looks random: SplitMix64 (Steele, Lea, Flood 2014, doi
/// 10.1145/2714064.2660195), applied to each in turn.
pub(crate) fn mixed(seed: u64, key: u64, sample: u64) -> u64 {
    [seed, key, sample].into_iter().fold(0, |state: u64, next| {
        let mut z = (state ^ next).wrapping_add(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_quantiles_are_those_of_the_tables() {
        for (u, x) in [
            (0.5, 0.0),
            (0.841_344_746_068_542_9, 1.0),
            (0.977_249_868_051_820_8, 2.0),
            (0.025, -1.959_963_984_540_054),
            (1e-10, -6.361_340_902_404_056),
        ] {
            assert!((normal_quantile(u) - x).abs() < 4e-15 * x.abs().max(1.0), "{u}: {}", normal_quantile(u));
        }
    }

    #[test]
    fn a_latin_hypercube_has_one_sample_in_each_interval_of_each_key() {
        let sampler = Sampler::new(7, Method::LatinHypercube, 3, 50);
        for key in 0..3 {
            let mut hit: Vec<usize> = (0..50).map(|sample| (sampler.share(key, sample) * 50.0) as usize).collect();
            assert_ne!(hit, (0..50).collect::<Vec<_>>(), "in random order");
            hit.sort_unstable();
            assert_eq!(hit, (0..50).collect::<Vec<_>>());
        }
    }

    #[test]
    fn independent_samples_have_the_moments_of_their_distribution() {
        let sampler = Sampler::new(1, Method::Independent, 2, 20_000);
        let normal = Distribution::Normal { mean: 3.0, deviation: 2.0 };
        let values: Vec<f64> = (0..20_000).map(|sample| normal.quantile(sampler.share(1, sample))).collect();
        let mean = values.iter().sum::<f64>() / 2e4;
        let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 2e4;
        // Five standard errors.
        assert!((mean - 3.0).abs() < 5.0 * 2.0 / 2e4_f64.sqrt(), "{mean}");
        assert!((variance - 4.0).abs() < 5.0 * 4.0 * (2.0_f64 / 2e4).sqrt(), "{variance}");
        assert_ne!(sampler.share(0, 5), sampler.share(1, 5));
        assert_ne!(sampler.share(0, 5), Sampler::new(2, Method::Independent, 2, 20_000).share(0, 5));
    }

    #[test]
    fn log_distributions_have_their_median_in_the_middle() {
        let log = Distribution::LogUniform { low: 1.0, high: 100.0 };
        assert!((log.quantile(0.5) - 10.0).abs() < 1e-13);
        let normal = Distribution::LogNormal { median: 0.3, deviation: 0.5 };
        assert_eq!(normal.quantile(0.5), 0.3);
    }
}
