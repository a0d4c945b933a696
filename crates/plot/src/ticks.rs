//! Round numbers along an axis, with their labels.

/// The ticks of an axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ticks {
    /// Labelled values, with the label as SVG text.
    pub(crate) major: Vec<(f64, String)>,
    /// Values between them, without labels.
    pub(crate) minor: Vec<f64>,
}

/// With at least this many powers of ten on a logarithmic axis, only these are labelled.
const ENOUGH_DECADES: usize = 3;

/// Largest number of labelled powers of ten.
const MOST_LABELS: i32 = 9;

/// Range in which the labels of a logarithmic axis are plain decimals.
const PLAIN_DECIMALS: [f64; 2] = [0.999e-3, 1.001e5];

impl Ticks {
    /// About `count` multiples of 1, 2 or 5 · 10ⁿ in a range, at most 1.5 times as many.
    pub(crate) fn linear(low: f64, high: f64, count: usize) -> Self {
        let raw = (high - low) / count as f64;
        let power = 10f64.powf(raw.log10().floor());
        let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * power >= 0.7 * raw).unwrap_or(10.0);
        let step = factor * power;
        let first = (low / step - 1e-9).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        // Very small or large numbers as powers of ten.
        let powers = !(1e-4..1e5).contains(&step);
        let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
        let label = |x: f64| {
            let text = match powers {
                true if x == 0.0 => "0".to_owned(),
                // As many digits as the step has, however large the number.
                true => {
                    let digits = (x.abs().log10() + 1e-9).floor() - (step.log10() + 1e-9).floor();
                    format!("{x:.*e}", digits.max(0.0) as usize)
                }
                false => format!("{x:.decimals$}"),
            };
            text.replace('-', "\u{2212}")
        };
        let major = (first..=last).map(|k| k as f64 * step).map(|x| (x, label(x))).collect();
        Self { major, minor: Vec::new() }
    }

    /// Powers of ten in a range, given by the logarithms of its ends; if there are few, also 2 and
    /// 5 times each.
    pub(crate) fn logarithmic(low: f64, high: f64) -> Self {
        let (first, last) = ((low - 1e-9).ceil() as i32, (high + 1e-9).floor() as i32);
        let enough = last - first + 1 >= ENOUGH_DECADES as i32;
        let every = 1 + (last - first).max(0) / MOST_LABELS;
        let written_out = low >= PLAIN_DECIMALS[0].log10() && high <= PLAIN_DECIMALS[1].log10();
        let mut ticks = Self { major: Vec::new(), minor: Vec::new() };
        for power in first - 1..=last {
            for factor in 1..=9 {
                let at = f64::from(power) + f64::from(factor).log10();
                if at < low - 1e-9 || at > high + 1e-9 {
                    continue;
                }
                let labelled = match factor {
                    1 => (power - first) % every == 0,
                    2 | 5 => !enough,
                    _ => false,
                };
                let value = 10f64.powf(at);
                if labelled {
                    let label = if written_out { written(factor, power) } else { raised(factor, power) };
                    ticks.major.push((value, label));
                } else if factor == 1 || every == 1 {
                    ticks.minor.push(value);
                }
            }
        }
        ticks
    }
}

/// The digits of factor · 10ⁿ.
fn written(factor: u32, power: i32) -> String {
    let zeros = "0".repeat(power.unsigned_abs() as usize);
    match zeros.split_at_checked(1) {
        Some((zero, others)) if power < 0 => format!("{zero}.{others}{factor}"),
        _ => format!("{factor}{zeros}"),
    }
}

/// factor · 10ⁿ with a superscript exponent.
fn raised(factor: u32, power: i32) -> String {
    let times = if factor == 1 { String::new() } else { format!("{factor}·") };
    let exponent = power.to_string().replace('-', "\u{2212}");
    format!("{times}10<tspan dy=\"-4\" font-size=\"10\">{exponent}</tspan>")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks.major.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn linear_ticks_are_round_and_inside() {
        assert_eq!(labels(&Ticks::linear(-0.031, 0.52, 6)), ["0.0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
        assert_eq!(labels(&Ticks::linear(0.0, 2.1e-6, 4)), ["0", "5e−7", "1.0e−6", "1.5e−6", "2.0e−6"]);
        assert_eq!(labels(&Ticks::linear(0.0, 1.3e-5, 6)).last(), Some(&"1.2e−5"));
        assert_eq!(labels(&Ticks::linear(-4.2, 5.1, 6)), ["\u{2212}4", "\u{2212}2", "0", "2", "4"]);
    }

    #[test]
    fn only_decades_are_labelled() {
        let ticks = Ticks::logarithmic(-2.0, 1.0);
        assert_eq!(labels(&ticks), ["0.01", "0.1", "1", "10"]);
        assert_eq!(ticks.minor.len(), 3 * 8);
        let ticks = Ticks::logarithmic(-12.0, -10.0);
        let exponents: Vec<_> =
            ticks.major.iter().map(|(_, label)| label.replace("10<tspan dy=\"-4\" font-size=\"10\">", "^")).collect();
        assert_eq!(exponents, ["^−12</tspan>", "^−11</tspan>", "^−10</tspan>"]);
    }

    #[test]
    fn few_decades_are_subdivided_and_many_thinned() {
        assert_eq!(labels(&Ticks::logarithmic(5f64.log10(), 200f64.log10())), ["5", "10", "20", "50", "100", "200"]);
        assert_eq!(labels(&Ticks::logarithmic(2f64.log10(), 5f64.log10())), ["2", "5"]);
        let wide = Ticks::logarithmic(-300.0, 300.0);
        assert!((9..=11).contains(&wide.major.len()), "{:?}", wide.major);
        assert!(wide.minor.len() < 600);
        assert!(wide.major.iter().chain(&[]).all(|(x, _)| x.is_finite() && *x > 0.0));
    }
}
