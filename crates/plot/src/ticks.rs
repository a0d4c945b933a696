//! Round numbers along an axis, with their labels.

use crate::escape::with_subscripts;
use crate::escaped;

/// The ticks of an axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ticks {
    /// Labelled values, with the label as SVG text.
    pub(crate) major: Vec<(f64, String)>,
    /// Values between them, without labels.
    pub(crate) minor: Vec<f64>,
    /// What the labels leave out.
    pub(crate) reading: Reading,
}

/// How labels are to be read: the value is the offset plus the label times 10ⁿ.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Reading {
    /// Without its sign, and whether that is negative.
    offset: Option<(String, bool)>,
    power: i32,
}

/// Labels of values that aren't wider than this stand beside an axis without touching its title.
const WIDEST: f64 = 42.0;

/// Values this many times the range share their leading digits, which then are an offset.
const SHARED: f64 = 100.0;

/// With at least this many powers of ten on a logarithmic axis, only these are labelled.
const ENOUGH_DECADES: usize = 3;

/// Largest number of labelled powers of ten.
const MOST_LABELS: i32 = 9;

/// Range in which the labels of a logarithmic axis are plain decimals.
const PLAIN_DECIMALS: [f64; 2] = [0.999e-3, 1.001e5];

impl Ticks {
    /// About `count` multiples of 1, 2 or 5 · 10ⁿ in a range, at most 1.5 times as many. Digits that the values share,
    /// and powers of ten, are left to the axis' title where the labels would be too wide.
    pub(crate) fn linear(low: f64, high: f64, count: usize) -> Self {
        let raw = (high - low) / count as f64;
        let power = 10f64.powf(raw.log10().floor());
        let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * power >= 0.7 * raw).unwrap_or(10.0);
        let step = factor * power;
        let first = (low / step - 1e-9).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        let labels = |from: i64, power: i32| -> Vec<String> {
            let unit = 10f64.powi(power);
            (first..=last).map(|k| plain((k - from) as f64 * step / unit, step / unit)).collect()
        };
        let fit = |labels: &[String], step: f64| {
            (1e-4..1e5).contains(&step) && labels.iter().all(|label| text_width(label) <= WIDEST)
        };
        let largest = low.abs().max(high.abs());
        let (mut texts, mut reading) = (labels(0, 0), Reading::default());
        if !fit(&texts, step) {
            let mut from = 0;
            if largest > SHARED * (high - low) {
                let round = 10f64.powf((high - low).log10().ceil());
                let digits = (0.5 * (low + high) / round).round();
                from = (digits * round / step).round() as i64;
                reading.offset = Some((shared(digits.abs(), round), digits < 0.0));
                texts = labels(from, 0);
            }
            if !fit(&texts, step) {
                let most = (first - from).abs().max((last - from).abs()).max(1) as f64 * step;
                reading.power = 3 * (most.log10() / 3.0 + 1e-9).floor() as i32;
                texts = labels(from, reading.power);
            }
        }
        let major = (first..=last).map(|k| k as f64 * step).zip(texts).collect();
        Self { major, minor: Vec::new(), reading }
    }

    /// Powers of ten in a range, given by the logarithms of its ends; if there are few, also 2 and
    /// 5 times each.
    pub(crate) fn logarithmic(low: f64, high: f64) -> Self {
        let (first, last) = ((low - 1e-9).ceil() as i32, (high + 1e-9).floor() as i32);
        let enough = last - first + 1 >= ENOUGH_DECADES as i32;
        let every = 1 + (last - first).max(0) / MOST_LABELS;
        let written_out = low >= PLAIN_DECIMALS[0].log10() && high <= PLAIN_DECIMALS[1].log10();
        let mut ticks = Self { major: Vec::new(), minor: Vec::new(), reading: Reading::default() };
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

impl Reading {
    /// The title of an axis, as SVG text, with what its labels leave out: the offset after the name, the power of ten
    /// before the unit, which is expected in brackets at the end. Subscripts of its symbols are lowered: ω_p.
    pub(crate) fn title(&self, title: &str) -> String {
        let (name, unit) = match title.rsplit_once(" (") {
            Some((name, unit)) if unit.ends_with(')') => (name, unit.trim_end_matches(')')),
            _ => (title, ""),
        };
        let offset = self.offset.as_ref().map_or(String::new(), |(offset, negative)| {
            format!(" {} {offset}", if *negative { '+' } else { '\u{2212}' })
        });
        let power = if self.power == 0 { String::new() } else { power_of_ten(self.power) };
        let unit = match (power.is_empty(), unit.is_empty()) {
            (true, true) => String::new(),
            (true, false) => format!(" ({})", escaped(unit)),
            (false, true) => format!(" ({power})"),
            (false, false) => format!(" ({power} {})", escaped(unit)),
        };
        with_subscripts(name, &format!("{offset}{unit}"))
    }
}

/// A number with as many decimals as its step asks for.
fn plain(x: f64, step: f64) -> String {
    let decimals = (-(step.log10() + 1e-9).floor()).clamp(0.0, 12.0) as usize;
    format!("{x:.decimals$}").replace('-', "\u{2212}")
}

/// Digits that values share, times the power of ten that they are counted in.
fn shared(digits: f64, round: f64) -> String {
    let value = digits * round;
    if (1e-4..1e7).contains(&value) {
        return plain(value, round);
    }
    let text = format!("{value:.*e}", (digits.log10() + 1e-9).floor().max(0.0) as usize);
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{mantissa}·{}", power_of_ten(power.parse().unwrap_or(0)))
}

/// 10ⁿ, after which the text goes on at its own height.
fn power_of_ten(power: i32) -> String {
    let exponent = power.to_string().replace('-', "\u{2212}");
    format!("10<tspan dy=\"-4\" font-size=\"10\">{exponent}</tspan><tspan dy=\"4\">\u{200b}</tspan>")
}

/// About how wide a number is in the type of the labels, which is Helvetica of 11 units.
pub(crate) fn text_width(text: &str) -> f64 {
    let mut inside_tag = false;
    let wide = |c: char| match c {
        '.' | ',' | ' ' | '·' => 3.1,
        '\u{2212}' | '+' => 6.4,
        _ => 6.1,
    };
    let mut width = 0.0;
    for c in text.chars() {
        match c {
            '<' => inside_tag = true,
            '>' => inside_tag = false,
            c if !inside_tag => width += wide(c),
            _ => {}
        }
    }
    width
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
        assert_eq!(labels(&Ticks::linear(-4.2, 5.1, 6)), ["\u{2212}4", "\u{2212}2", "0", "2", "4"]);
    }

    #[test]
    fn powers_of_ten_are_in_the_title() {
        let title = |ticks: &Ticks| ticks.reading.title("Energy <E> (J)").replace('\u{200b}', "");
        let small = Ticks::linear(0.0, 2.1e-6, 4);
        assert_eq!(labels(&small), ["0.0", "0.5", "1.0", "1.5", "2.0"]);
        let power = |n: &str| format!("10<tspan dy=\"-4\" font-size=\"10\">{n}</tspan><tspan dy=\"4\"></tspan>");
        assert_eq!(title(&small), format!("Energy &lt;E&gt; ({} J)", power("\u{2212}6")));
        assert_eq!(labels(&Ticks::linear(-2e-13, 4.2e-13, 3)), ["\u{2212}200", "0", "200", "400"]);
        let large = Ticks::linear(0.0, 6e5, 6);
        assert_eq!(
            (labels(&large).last(), title(&large)),
            (Some(&"600"), format!("Energy &lt;E&gt; ({} J)", power("3")))
        );
        assert_eq!(large.reading.title("Share"), format!("Share ({})", power("3")).replace("\"4\">", "\"4\">\u{200b}"));
        assert_eq!(Ticks::linear(0.0, 5.0, 5).reading.title("Share of a (b) c"), "Share of a (b) c");
    }

    #[test]
    fn digits_that_all_share_are_an_offset() {
        let ticks = Ticks::linear(123_450.0, 123_450.003, 6);
        assert_eq!(labels(&ticks)[..3], ["0.0000", "0.0005", "0.0010"]);
        assert_eq!(ticks.reading.title("Position x (cm)"), "Position x \u{2212} 123450.00 (cm)");
        let ticks = Ticks::linear(-5.318_53e-1 - 4e-6, -5.318_53e-1 + 4e-6, 4);
        assert_eq!(labels(&ticks), ["\u{2212}6", "\u{2212}4", "\u{2212}2", "0"]);
        assert!(
            ticks.reading.title("w (cm)").starts_with("w + 0.53185 (10<tspan"),
            "{}",
            ticks.reading.title("w (cm)")
        );
        // What a label says and where it stands are the same value.
        for (low, high) in
            [(3.082_687, 3.082_689), (1.170_05e-11, 1.170_06e-11), (29_999.999_5, 30_000.000_5), (-1e9, -1e9 + 0.1)]
        {
            let ticks = Ticks::linear(low, high, 5);
            let offset = ticks.reading.offset.clone().map_or(0.0, |(text, negative)| {
                let text = text.replace("·10<tspan dy=\"-4\" font-size=\"10\">", "e").replace('\u{2212}', "-");
                let value: f64 = text.split('<').next().unwrap().parse().unwrap();
                if negative { -value } else { value }
            });
            for (value, label) in &ticks.major {
                let read =
                    label.replace('\u{2212}', "-").parse::<f64>().unwrap() * 10f64.powi(ticks.reading.power) + offset;
                assert!((read - value).abs() < 1e-3 * (high - low), "{value}: {label} {:?}", ticks.reading);
                assert!(text_width(label) <= WIDEST, "{label}");
            }
        }
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
