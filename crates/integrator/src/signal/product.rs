//! Products of signals, such as an envelope times a sine.

use super::compensated::Compensated;
use super::formula::{finite, positive};
use super::window::{self, Moments, Pieces};
use super::{Signal, SignalError};
use std::sync::Arc;

/// A product of signals and a number. Value and rates are those of the product rule. Its integrals have no closed
/// form in general: they are computed by Gauss' eight points over panels between the breaks of the
/// factors, of at most a quarter of the shortest period, where the rule is exact to rounding, and
/// summed once, when the product is made. So value, rates and integrals are those of the same
/// function, whatever the step.
///
/// ```
/// use std::sync::Arc;
/// use teeter_integrator::{Formula, Product, Signal};
///
/// let (envelope, sine) = (Formula::half_sine(0.0, 2.0)?, Formula::harmonic(0.0, 7.0, 0.0)?);
/// let burst = Product::new(0.5, vec![Arc::new(envelope), Arc::new(sine)], 3.0)?;
/// assert_eq!(burst.value(0.9), 0.5 * envelope.value(0.9) * sine.value(0.9));
/// assert_eq!(burst.integral(2.5), burst.integral(2.0));
/// # Ok::<(), teeter_integrator::SignalError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Product {
    scale: f64,
    factors: Vec<Arc<dyn Signal>>,
    /// Longest panel, s.
    panel: f64,
    /// Where panels end, s, from 0 on.
    ends: Arc<[f64]>,
    /// There: the integral from 0, and the integral of that.
    integrals: Arc<[[f64; 2]]>,
}

/// Panels per shortest period, as for chirps.
const PER_PERIOD: f64 = 4.0;

/// Most panels, of 24 bytes each.
const MOST: usize = 4_000_000;

/// Most factors: eight points are exact for a product of fifteen lines.
const MOST_FACTORS: usize = 15;

/// Over this many panels a mean is a difference of integrals, which loses no digits there.
const MANY: f64 = 16.0;

/// A jump is larger than this fraction of the values on either side, which have rounding errors.
const JUMP: f64 = 1e-9;

impl Product {
    /// The product of `scale` and these signals. Its integrals are tabulated from 0 to `until`
    /// (s), the end of the run; beyond that they take time, but are right too.
    ///
    /// # Errors
    /// If there are more than 15 factors, if `scale` is not finite or `until` not positive and finite, or if the factors
    /// have so many breaks or periods up to then that more than four million panels are needed.
    pub fn new(scale: f64, factors: Vec<Arc<dyn Signal>>, until: f64) -> Result<Self, SignalError> {
        let (scale, until) = (finite("the scale", scale)?, positive("the end", until)?);
        if factors.len() > MOST_FACTORS {
            let (what, value) = ("the number of factors", factors.len() as f64);
            return Err(SignalError::Value { what, value, rule: "at most 15" });
        }
        // The frequencies of factors add.
        let panel = factors.iter().map(|factor| PER_PERIOD / factor.shortest_period()).sum::<f64>().recip();
        let mut product = Self { scale, factors, panel, ends: Arc::new([]), integrals: Arc::new([]) };
        let (mut ends, mut integrals) = (vec![0.0], vec![[0.0; 2]]);
        let (mut once, mut twice) = (Compensated::default(), Compensated::default());
        let mut from = 0.0;
        while from < until {
            let to = product.next_break(from).min(until);
            let parts = product.parts(from, to);
            if parts + ends.len() as f64 > MOST as f64 {
                let (what, rule) = ("the number of quarter periods and rows", "at most 4000000 in a run");
                return Err(SignalError::Value { what, value: parts + ends.len() as f64, rule });
            }
            for k in 0..parts as u32 {
                let [a, b] = part_of(from, to, parts, k);
                let [first, second] = product.within(a, b);
                twice.add((b - a) * once.total());
                twice.add(second);
                once.add(first);
                ends.push(b);
                integrals.push([once.total(), twice.total()]);
            }
            from = to;
        }
        (product.ends, product.integrals) = (ends.into(), integrals.into());
        Ok(product)
    }

    /// Value, rate and second rate.
    fn derivatives(&self, t: f64) -> [f64; 3] {
        self.factors.iter().fold([self.scale, 0.0, 0.0], |[f, f1, f2], factor| {
            let (g, g1, g2) = (factor.value(t), factor.rate(t), factor.second_rate(t));
            [f * g, f1 * g + f * g1, f2 * g + 2.0 * f1 * g1 + f * g2]
        })
    }

    /// How many panels a smooth piece takes.
    fn parts(&self, from: f64, to: f64) -> f64 {
        ((to - from) / self.panel).ceil().max(1.0)
    }

    /// Calls `each` for the panels of [from, to], with their ends.
    fn panels(&self, from: f64, to: f64, mut each: impl FnMut(f64, f64)) {
        let mut begin = from;
        while begin < to {
            let end = self.next_break(begin).min(to);
            let parts = self.parts(begin, end);
            for k in 0..parts as u32 {
                let [a, b] = part_of(begin, end, parts, k);
                each(a, b);
            }
            begin = end;
        }
    }

    fn by_points(&self, from: f64, to: f64) -> Moments {
        window::by_points(from, to, |t| self.value(t))
    }

    /// The integral over a panel, and the integral of that.
    fn within(&self, from: f64, to: f64) -> [f64; 2] {
        let [first, second, ..] = self.by_points(from, to);
        // The mean of (to − t) f, with to − t = ½(to − from)(1 − s).
        [(to - from) * first, 0.5 * (to - from) * (to - from) * (first - second)]
    }

    /// The last tabulated time.
    fn until(&self) -> f64 {
        self.ends.last().copied().unwrap_or(0.0)
    }

    /// The integral from 0, and the integral of that.
    fn integrals(&self, t: f64) -> [f64; 2] {
        if t <= 0.0 {
            if t == 0.0 {
                return [0.0; 2];
            }
            let [first, second, ..] = self.moments(t, 0.0);
            return [t * first, 0.5 * t * t * (first + second)];
        }
        let k = self.ends.partition_point(|end| *end <= t).saturating_sub(1);
        let (from, [once, twice]) = (self.ends[k], self.integrals[k]);
        let mut sum = [once, twice];
        self.panels(from, t, |a, b| {
            let [first, second] = self.within(a, b);
            sum = [sum[0] + first, sum[1] + (b - a) * sum[0] + second];
        });
        sum
    }

    /// Whether a mean over this time is a difference of tabulated integrals.
    fn is_long(&self, from: f64, to: f64) -> bool {
        let panels = |t: f64| self.ends.partition_point(|end| *end <= t) as f64;
        from >= 0.0 && to <= self.until() && panels(to) - panels(from) > MANY
    }
}

/// The ends of one of several equal parts; the last ends exactly at the end.
fn part_of(from: f64, to: f64, parts: f64, k: u32) -> [f64; 2] {
    [k, k + 1].map(|k| if f64::from(k) == parts { to } else { from + (to - from) * (f64::from(k) / parts) })
}

impl Signal for Product {
    fn value(&self, t: f64) -> f64 {
        self.factors.iter().fold(self.scale, |product, factor| product * factor.value(t))
    }

    fn rate(&self, t: f64) -> f64 {
        self.derivatives(t)[1]
    }

    fn second_rate(&self, t: f64) -> f64 {
        self.derivatives(t)[2]
    }

    fn integral(&self, t: f64) -> f64 {
        self.integrals(t)[0]
    }

    fn double_integral(&self, t: f64) -> f64 {
        self.integrals(t)[1]
    }

    fn mean(&self, from: f64, to: f64) -> f64 {
        if self.is_long(from, to) {
            return (self.integral(to) - self.integral(from)) / (to - from);
        }
        let mut sum = 0.0;
        self.panels(from, to, |a, b| sum += (b - a) / (to - from) * self.by_points(a, b)[0]);
        sum
    }

    fn mean_rate(&self, from: f64, to: f64) -> f64 {
        // Within a panel the rate has no jumps, and its mean loses no digits over short times.
        if self.next_break(from) >= to && to - from <= self.panel {
            return window::by_points(from, to, |t| self.rate(t))[0];
        }
        (self.value(to) - self.value(from)) / (to - from)
    }

    fn mean_integral(&self, from: f64, to: f64) -> f64 {
        if self.is_long(from, to) {
            return (self.double_integral(to) - self.double_integral(from)) / (to - from);
        }
        let moments = self.moments(from, to);
        self.integral(from) + 0.5 * (to - from) * (moments[0] - moments[1])
    }

    fn moments(&self, from: f64, to: f64) -> Moments {
        let mut pieces = Pieces::over(from, to);
        self.panels(from, to, |a, b| pieces.add(a, b, &self.by_points(a, b)));
        pieces.moments()
    }

    /// Within the tabulated time. A factor may jump where another is 0: then the product doesn't.
    fn jump(&self) -> Option<f64> {
        if self.factors.iter().all(|factor| factor.jump().is_none()) {
            return None;
        }
        let mut t = self.next_break(0.0);
        while t <= self.until() {
            // Ends of factors have the rounding of their sums.
            let [before, after] = [-4.0, 4.0].map(|ulps| self.value(t * (1.0 + ulps * f64::EPSILON)));
            if (after - before).abs() > JUMP * (1.0 + before.abs().max(after.abs())) {
                return Some(t);
            }
            t = self.next_break(t);
        }
        None
    }

    fn next_break(&self, t: f64) -> f64 {
        self.factors.iter().map(|factor| factor.next_break(t)).fold(f64::INFINITY, f64::min)
    }

    fn shortest_period(&self) -> f64 {
        PER_PERIOD * self.panel
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{check, quadrature};
    use super::super::{Chirp, Formula, Growth, Sum, Table};
    use super::*;

    type Factors = Vec<Arc<dyn Signal>>;

    fn signal(formula: Result<Formula, SignalError>) -> Arc<dyn Signal> {
        Arc::new(formula.unwrap())
    }

    #[test]
    fn integrals_and_rates_are_those_of_the_value() {
        let table = || Arc::new(Table::new(vec![0.2, 0.7, 1.3], vec![0.1, 2.0, -1.0]).unwrap());
        let chirp = || Arc::new(Chirp::new(0.5, 1.0, [1.0, 5.0], 0.4, Growth::Logarithmic).unwrap());
        let harmonic = || signal(Formula::harmonic(0.1, 3.3, 0.4));
        let sum = Sum::new(vec![(0.3, table() as Arc<dyn Signal>), (-2.0, harmonic())]);
        let products: [(Factors, &[f64]); 6] = [
            (vec![table(), harmonic()], &[0.1, 0.2, 0.7, 1.3]),
            (vec![signal(Formula::half_sine(-0.3, 1.5)), harmonic()], &[0.1, 1.2]),
            (vec![signal(Formula::ricker(0.9, 1.0)), signal(Formula::ramp(0.3, 0.6))], &[0.3, 0.9]),
            (vec![chirp(), table(), harmonic()], &[0.1, 0.2, 0.5, 0.7, 1.3, 1.5]),
            (vec![Arc::new(sum), chirp()], &[0.1, 0.2, 0.5, 0.7, 1.3, 1.5]),
            (vec![table(), table(), signal(Formula::constant(0.4))], &[0.2, 0.4, 0.7, 1.3]),
        ];
        for (factors, kinks) in products {
            check(&Product::new(1.0, factors, 2.0).unwrap(), kinks, 2.0);
        }
    }

    #[test]
    fn integrals_go_on_after_the_tabulated_time() {
        let factors = vec![signal(Formula::half_sine(0.3, 1.5)), signal(Formula::harmonic(0.1, 3.3, 0.4))];
        let [long, short] = [4.0, 0.8].map(|until| Product::new(1.0, factors.clone(), until).unwrap());
        for t in [0.5, 0.8, 0.9, 1.8, 2.5] {
            assert!((long.integral(t) - short.integral(t)).abs() < 1e-15, "{t}");
            assert!((long.double_integral(t) - short.double_integral(t)).abs() < 1e-15, "{t}");
        }
    }

    #[test]
    fn two_sines_are_a_sum_of_two() {
        // sin a sin b = ½ (cos(a − b) − cos(a + b)), from −1 s on, so before 0 as well.
        let (slow, fast) = (signal(Formula::harmonic(-1.0, 1.3, 0.0)), signal(Formula::harmonic(-1.0, 11.0, 0.0)));
        let product = Product::new(1.0, vec![slow, fast], 40.0).unwrap();
        let cosine = |f: f64| signal(Formula::harmonic(-1.0, f, std::f64::consts::FRAC_PI_2));
        let sum = Sum::new(vec![(0.5, cosine(9.7)), (-0.5, cosine(12.3))]);
        for t in [-0.7, 0.3, 7.77, 39.9, 41.0] {
            let near = |a: f64, b: f64, size: f64| assert!((a - b).abs() < 1e-13 * size, "at {t}: {a} {b}");
            near(product.value(t), sum.value(t), 30.0);
            near(product.rate(t), sum.rate(t), 4000.0);
            near(product.integral(t), sum.integral(t), 1.0);
            near(product.double_integral(t), sum.double_integral(t), 2.0);
            for h in [1e-6, 0.01, 0.3, 3.0] {
                near(product.mean(t, t + h), sum.mean(t, t + h), 30.0);
                near(product.mean_rate(t, t + h), sum.mean_rate(t, t + h), 4000.0);
                near(product.mean_integral(t, t + h), sum.mean_integral(t, t + h), 2.0);
            }
            // Those of the sum are closed, by spherical Bessel functions.
            for (a, b) in product.moments(t, t + 0.4).into_iter().zip(sum.moments(t, t + 0.4)) {
                near(a, b, 30.0);
            }
        }
    }

    #[test]
    fn means_over_steps_add_up_to_the_integral() {
        let envelope = Table::new(vec![0.0, 1.0, 4.0, 5.0], vec![0.0, 1.0, 1.0, 0.0]).unwrap();
        let product =
            Product::new(1.0, vec![Arc::new(envelope.clone()), signal(Formula::harmonic(0.0, 20.0, 0.3))], 6.0)
                .unwrap();
        let steps = 1000;
        let at = |k: i32| 6.0 * f64::from(k) / f64::from(steps);
        let sum: f64 = (0..steps).map(|k| product.mean(at(k), at(k + 1)) * (at(k + 1) - at(k))).sum();
        let value = |t: f64| envelope.value(t) * (40.0 * std::f64::consts::PI * t + 0.3).sin();
        let exact: f64 = [[0.0, 1.0], [1.0, 4.0], [4.0, 5.0]].iter().map(|[a, b]| quadrature(value, *a, *b, 600)).sum();
        assert!((sum - exact).abs() < 1e-13 && (product.integral(6.0) - exact).abs() < 1e-13, "{sum} {exact}");
    }

    #[test]
    fn it_jumps_where_a_factor_does_unless_another_is_zero_there() {
        let window = signal(Formula::constant(0.5));
        let product = |factor: Arc<dyn Signal>| Product::new(1.0, vec![Arc::clone(&window), factor], 2.0).unwrap();
        assert_eq!(product(signal(Formula::harmonic(0.0, 1.0, 1.0))).jump(), Some(0.5));
        assert_eq!(product(signal(Formula::harmonic(0.0, 1.0, 0.0))).jump(), None, "sin π = 0");
        assert_eq!(product(signal(Formula::half_sine(0.5, 0.7))).jump(), None);
        assert_eq!(product(signal(Formula::half_sine(0.3, 0.7))).jump(), Some(0.5));
    }

    #[test]
    fn what_takes_too_many_panels_is_refused() {
        let fast = || signal(Formula::harmonic(0.0, 1e6, 0.0));
        let error = |factors, until| Product::new(1.0, factors, until).unwrap_err().to_string();
        let text = error(vec![fast(), fast()], 1.0);
        assert_eq!(text, "the number of quarter periods and rows is 8000001, but must be at most 4000000 in a run");
        assert!(error(vec![fast(); 16], 1e-3).contains("the number of factors is 16, but must be at most 15"));
        let infinite = Product::new(f64::INFINITY, vec![fast()], 1.0).unwrap_err().to_string();
        assert!(infinite.contains("the scale is inf"), "{infinite}");
        assert!(error(vec![fast()], 0.0).contains("the end is 0"));
        let two = Product::new(2.0, Vec::new(), 1.0).unwrap();
        assert_eq!((two.value(0.3), two.integral(2.0), two.rate(0.1)), (2.0, 4.0, 0.0));
    }
}
