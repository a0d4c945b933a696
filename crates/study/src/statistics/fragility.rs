//! Lognormal fragility curves by maximum likelihood.

use super::chi_squared::chi_squared_tail;
use super::normal::{hazard, log_probability, normal_probability};

/// What happened at an intensity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// The intensity, positive.
    pub intensity: f64,
    /// Whether the event came.
    pub event: bool,
}

/// The curve P(event | x) = Φ(ln(x/θ)/β) that makes observations likeliest.
///
/// Each observation is a Bernoulli trial, so that stripes (many records at each intensity), clouds
/// (each record at its own) and mixtures of them are fitted in the same way: the probit regression
/// of J. W. Baker, "Efficient analytical fragility function fitting using dynamic structural
/// analysis", Earthquake Spectra 31 (2015) 579–599, doi 10.1193/021113EQS025M. The log-likelihood
/// is concave in (1/β, ln θ/β), so Newton's method finds its only maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LognormalFit {
    /// θ: the intensity at which the event comes in half of all cases.
    pub median: f64,
    /// β: the standard deviation of the logarithm of the intensity at which it comes.
    pub beta: f64,
    /// The logarithm of the likelihood.
    pub log_likelihood: f64,
}

/// Why observations have no such curve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoFit {
    /// The event came always or never, or there are no observations.
    #[error("{0}")]
    OneSided(&'static str),
    /// The event came at all intensities above and at none below: β would be 0.
    #[error("{}, and the dispersion can't be told", separated(*below, *above))]
    Separated {
        /// The largest intensity without it.
        below: f64,
        /// The smallest intensity with it.
        above: f64,
    },
    /// The event is less likely at larger intensities.
    #[error("the event is not likelier at larger intensities")]
    NotIncreasing,
    /// An intensity that has no logarithm.
    #[error("the intensity {0} is not positive and finite")]
    Intensity(f64),
}

/// Where the event begins, if it comes in no case below and in all above.
fn separated(below: f64, above: f64) -> String {
    let [least, most] = [below, above].map(|x| format!("{x:.3e}").parse().unwrap_or(x));
    if below == above {
        format!("the event comes in no case below {least} and in all above, so the median is there")
    } else {
        format!("the event comes in no case up to {least} and in all from {most} on, so the median is between these")
    }
}

/// Iterations of Newton's method, of which it takes about eight.
const MOST_ITERATIONS: usize = 100;

impl LognormalFit {
    /// Fits a curve.
    ///
    /// ```
    /// use teeter_study::statistics::{LognormalFit, Observation};
    ///
    /// let seen = [(1.0, false), (1.5, true), (2.0, false), (3.0, true)];
    /// let seen = seen.map(|(intensity, event)| Observation { intensity, event });
    /// let fit = LognormalFit::of(&seen)?;
    /// assert!(fit.median > 1.5 && fit.median < 2.0);
    /// assert_eq!(fit.probability(fit.median), 0.5);
    /// # Ok::<(), teeter_study::statistics::NoFit>(())
    /// ```
    ///
    /// # Errors
    /// [`NoFit`] where the likelihood has no maximum.
    pub fn of(observations: &[Observation]) -> Result<Self, NoFit> {
        if let Some(bad) = observations.iter().find(|seen| !(seen.intensity > 0.0 && seen.intensity.is_finite())) {
            return Err(NoFit::Intensity(bad.intensity));
        }
        let of = |event: bool| observations.iter().filter(move |seen| seen.event == event).map(|seen| seen.intensity);
        let extremes = |event: bool| (of(event).reduce(f64::min), of(event).reduce(f64::max));
        let ((without_least, without_most), (with_least, with_most)) = (extremes(false), extremes(true));
        let (Some(below), Some(above)) = (without_most, with_least) else {
            return Err(NoFit::OneSided(match (without_most, with_least) {
                (None, None) => "there are no observations",
                (None, _) => "the event comes in all cases",
                _ => "the event comes in no case",
            }));
        };
        if without_least == with_most && below == above {
            return Err(NoFit::OneSided("all cases have the same intensity"));
        }
        if below <= above {
            return Err(NoFit::Separated { below, above });
        }
        // The same the other way round: the likelihood grows for ever with a falling curve.
        if with_most <= without_least {
            return Err(NoFit::NotIncreasing);
        }
        Self::newton(observations)
    }

    fn newton(observations: &[Observation]) -> Result<Self, NoFit> {
        let n = observations.len() as f64;
        let logs = || observations.iter().map(|seen| seen.intensity.ln());
        let mean = logs().sum::<f64>() / n;
        let deviation = (logs().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt();
        // In units of the spread, z = c + d u, so that both unknowns are of order 1.
        let u = |seen: &Observation| (seen.intensity.ln() - mean) / deviation;
        let likelihood = |[c, d]: [f64; 2]| {
            let one = |seen: &Observation| {
                let z = c + d * u(seen);
                log_probability(if seen.event { z } else { -z })
            };
            observations.iter().map(one).sum::<f64>()
        };
        let (mut at, mut value) = ([0.0, 1.0], likelihood([0.0, 1.0]));
        // Near the maximum the likelihood doesn't tell steps apart, but its slope does: a decrease by
        // rounding is none.
        let grown = |reached: f64, value: f64| reached >= value - 1e-12 * value.abs();
        for _ in 0..MOST_ITERATIONS {
            let (mut slope, mut curvature) = ([0.0; 2], [0.0; 3]);
            for seen in observations {
                let x = u(seen);
                let z = at[0] + at[1] * x;
                let sign = if seen.event { 1.0 } else { -1.0 };
                let rate = hazard(sign * z);
                let weight = rate * (rate + sign * z);
                slope = [slope[0] + sign * rate, slope[1] + sign * rate * x];
                curvature = [curvature[0] + weight, curvature[1] + weight * x, curvature[2] + weight * x * x];
            }
            let determinant = curvature[0] * curvature[2] - curvature[1] * curvature[1];
            let step = [
                (curvature[2] * slope[0] - curvature[1] * slope[1]) / determinant,
                (curvature[0] * slope[1] - curvature[1] * slope[0]) / determinant,
            ];
            if !step.iter().all(|part| part.is_finite()) {
                break;
            }
            let mut part = 1.0;
            let (next, reached) = loop {
                let next = [at[0] + part * step[0], at[1] + part * step[1]];
                let reached = likelihood(next);
                if grown(reached, value) || part < 1e-9 {
                    break (next, reached);
                }
                part *= 0.5;
            };
            let moved = (next[0] - at[0]).abs().max((next[1] - at[1]).abs());
            if grown(reached, value) {
                (at, value) = (next, reached);
            }
            if moved < 1e-12 * (1.0 + at[0].abs() + at[1].abs()) {
                break;
            }
        }
        let [c, d] = at;
        if !(d > 0.0) {
            return Err(NoFit::NotIncreasing);
        }
        Ok(Self { median: (mean - c / d * deviation).exp(), beta: deviation / d, log_likelihood: value })
    }

    /// The probability of the event at an intensity.
    #[must_use]
    pub fn probability(&self, intensity: f64) -> f64 {
        normal_probability((intensity / self.median).ln() / self.beta)
    }

    /// How well the curve describes observations: χ² of the numbers of events in groups of neighbouring intensities, in each of which
    /// at least five events and as many cases without one are expected (D. W. Hosmer, S. Lemeshow, doi 10.1080/03610928008827941).
    /// `None` with fewer than three such groups.
    #[must_use]
    pub fn misfit(&self, observations: &[Observation]) -> Option<Misfit> {
        let mut sorted = observations.to_vec();
        sorted.sort_by(|a, b| a.intensity.total_cmp(&b.intensity));
        let mut groups: Vec<ObservedGroup> = Vec::new();
        let mut open = ObservedGroup::default();
        for same in sorted.chunk_by(|a, b| a.intensity == b.intensity) {
            open.take(same, self.probability(same[0].intensity));
            if open.is_large() {
                groups.push(std::mem::take(&mut open));
            }
        }
        // What is left at the end belongs to the last group.
        if let Some(last) = groups.last_mut() {
            last.join(&open);
        }
        let degrees = groups.len().checked_sub(2).filter(|degrees| *degrees > 0)?;
        let square = |group: &ObservedGroup| (group.events as f64 - group.expected).powi(2) / group.variance;
        let worst = groups.iter().max_by(|a, b| square(a).total_cmp(&square(b)))?;
        Some(Misfit {
            p: chi_squared_tail(groups.iter().map(square).sum(), degrees),
            range: worst.range,
            cases: worst.cases,
            events: worst.events,
            expected: worst.expected,
        })
    }
}

/// How badly a curve describes observations.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Misfit {
    /// The probability of a χ² as large or larger if the curve were right.
    pub p: f64,
    /// The intensities of the group that differs most.
    pub range: [f64; 2],
    /// Its cases.
    pub cases: usize,
    /// Its events.
    pub events: usize,
    /// How many the curve lets one expect.
    pub expected: f64,
}

/// Least number of events, and of cases without one, to be expected in a group.
const LEAST_EXPECTED: f64 = 5.0;

#[derive(Default)]
struct ObservedGroup {
    range: [f64; 2],
    cases: usize,
    events: usize,
    expected: f64,
    variance: f64,
}

impl ObservedGroup {
    /// Takes cases of one intensity in.
    fn take(&mut self, same: &[Observation], probability: f64) {
        let cases = same.len();
        self.join(&Self {
            range: [same[0].intensity; 2],
            cases,
            events: same.iter().filter(|seen| seen.event).count(),
            expected: cases as f64 * probability,
            variance: cases as f64 * probability * (1.0 - probability),
        });
    }

    fn join(&mut self, other: &Self) {
        if self.cases == 0 {
            self.range[0] = other.range[0];
        }
        if other.cases > 0 {
            self.range[1] = other.range[1];
        }
        self.cases += other.cases;
        self.events += other.events;
        self.expected += other.expected;
        self.variance += other.variance;
    }

    fn is_large(&self) -> bool {
        self.expected >= LEAST_EXPECTED && self.cases as f64 - self.expected >= LEAST_EXPECTED
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(pairs: &[(f64, bool)]) -> Vec<Observation> {
        pairs.iter().map(|&(intensity, event)| Observation { intensity, event }).collect()
    }

    /// Stripes: intensity, number of cases, number of events.
    fn stripes(rows: &[(f64, usize, usize)]) -> Vec<Observation> {
        rows.iter().flat_map(|&(x, n, k)| (0..n).map(move |i| Observation { intensity: x, event: i < k })).collect()
    }

    #[test]
    fn the_fit_is_that_of_another_optimiser() {
        // scipy.optimize.minimize (Nelder–Mead, then BFGS with gtol = 1e-12) on the same likelihood.
        let rows =
            [(0.1, 40, 0), (0.2, 40, 2), (0.3, 40, 9), (0.4, 40, 15), (0.5, 40, 24), (0.7, 40, 33), (1.0, 40, 39)];
        let fit = LognormalFit::of(&stripes(&rows)).unwrap();
        assert!((fit.median - STRIPES[0]).abs() < 1e-8, "{fit:?}");
        assert!((fit.beta - STRIPES[1]).abs() < 1e-8, "{fit:?}");
        assert!((fit.log_likelihood - STRIPES[2]).abs() < 1e-9, "{fit:?}");
    }

    #[test]
    fn intensities_in_other_units_give_the_same_curve() {
        let rows = [(0.1, 10, 0), (0.2, 10, 3), (0.4, 10, 2), (0.8, 10, 9)];
        let a = LognormalFit::of(&stripes(&rows)).unwrap();
        let b = LognormalFit::of(&stripes(&rows.map(|(x, n, k)| (9.81 * x, n, k)))).unwrap();
        assert!((b.median / a.median / 9.81 - 1.0).abs() < 1e-12 && (b.beta / a.beta - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_curve_that_does_not_describe_the_cases_is_told() {
        // A likelihood of events by a lognormal curve, to whole numbers of cases.
        let good = [(0.1, 100, 1), (0.2, 100, 16), (0.3, 100, 38), (0.4, 100, 58), (0.6, 100, 82), (0.9, 100, 95)];
        let seen = stripes(&good);
        let fit = LognormalFit::of(&seen).unwrap().misfit(&seen).unwrap();
        assert!(fit.p > 0.5, "{fit:?}");
        // Half of the cases whatever the intensity, up to a threshold.
        let bad = [(0.1, 100, 50), (0.2, 100, 50), (0.3, 100, 50), (0.4, 100, 50), (0.6, 100, 100), (0.9, 100, 100)];
        let seen = stripes(&bad);
        let fit = LognormalFit::of(&seen).unwrap().misfit(&seen).unwrap();
        assert!(fit.p < 1e-6 && fit.cases >= 100, "{fit:?}");
        assert_eq!(
            LognormalFit { median: 1.0, beta: 0.5, log_likelihood: 0.0 }.misfit(&stripes(&[(1.0, 20, 10)])),
            None
        );
    }

    #[test]
    fn observations_without_a_maximum_are_told() {
        let of = |pairs: &[(f64, bool)]| LognormalFit::of(&seen(pairs)).unwrap_err();
        assert_eq!(of(&[(1.0, false), (2.0, true)]), NoFit::Separated { below: 1.0, above: 2.0 });
        assert_eq!(
            of(&[(1.0, false), (2.0, false), (2.0, true), (3.0, true)]),
            NoFit::Separated { below: 2.0, above: 2.0 }
        );
        assert_eq!(of(&[(1.0, true), (2.0, true)]), NoFit::OneSided("the event comes in all cases"));
        assert_eq!(of(&[(1.0, false)]), NoFit::OneSided("the event comes in no case"));
        assert_eq!(of(&[]), NoFit::OneSided("there are no observations"));
        assert_eq!(of(&[(1.0, true), (2.0, false)]), NoFit::NotIncreasing);
        assert_eq!(of(&[(1.0, true), (2.0, false), (3.0, true), (4.0, false), (5.0, false)]), NoFit::NotIncreasing);
        assert_eq!(of(&[(0.0, true), (2.0, false)]), NoFit::Intensity(0.0));
    }

    const STRIPES: [f64; 3] = [0.443_040_206_9, 0.465_604_408_5, -106.269_689_166_575_45];
}
