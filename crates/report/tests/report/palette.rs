//! The colours of the pages: read well on their backgrounds, and told apart by those who can't see
//! red or green.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use teeter_report::STYLE;

type Rgb = [f64; 3];

/// Colours by name, in the light and dark scheme, and in print.
fn schemes() -> [(&'static str, BTreeMap<String, Rgb>); 3] {
    let block = |from: &str| {
        let text = STYLE.split_once(from).unwrap().1;
        let text = text.split_once(":root {").unwrap().1.split_once('}').unwrap().0;
        let colours = text.split(';').filter_map(|pair| pair.trim().split_once(':'));
        let colours = colours.filter_map(|(name, value)| Some((name.trim().to_owned(), read(value.trim())?)));
        colours.collect::<BTreeMap<_, _>>()
    };
    [("light", block("")), ("dark", block("prefers-color-scheme: dark")), ("print", block("@media print"))]
}

/// `#fff` or `#a1b2c3` as linear RGB.
fn read(text: &str) -> Option<Rgb> {
    let digits = text.strip_prefix('#')?;
    let of = |from: usize| match digits.len() {
        3 => u8::from_str_radix(&digits[from..=from].repeat(2), 16).ok(),
        _ => u8::from_str_radix(digits.get(2 * from..2 * from + 2)?, 16).ok(),
    };
    let linear = |byte: u8| match f64::from(byte) / 255.0 {
        c if c <= 0.040_45 => c / 12.92,
        c => ((c + 0.055) / 1.055).powf(2.4),
    };
    Some([linear(of(0)?), linear(of(1)?), linear(of(2)?)])
}

/// What a reader without one kind of cones sees: Machado, Oliveira and Fernandes 2009 (doi
/// 10.1109/TVCG.2009.113), severity 1.
const PROTANOPIA: [Rgb; 3] =
    [[0.152_286, 1.052_583, -0.204_868], [0.114_503, 0.786_281, 0.099_216], [-0.003_882, -0.048_116, 1.051_998]];
const DEUTERANOPIA: [Rgb; 3] =
    [[0.367_322, 0.860_646, -0.227_968], [0.280_085, 0.672_501, 0.047_413], [-0.011_820, 0.042_940, 0.968_881]];
const ALL_CONES: [Rgb; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn seen(matrix: &[Rgb; 3], colour: Rgb) -> Rgb {
    matrix.map(|row| row.iter().zip(colour).map(|(m, c)| m * c).sum::<f64>().clamp(0.0, 1.0))
}

fn luminance([r, g, b]: Rgb) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Contrast ratio of WCAG 2.
fn contrast(a: Rgb, b: Rgb) -> f64 {
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

/// CIELAB for the white of sRGB.
fn lab([r, g, b]: Rgb) -> Rgb {
    let f = |t: f64| if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 };
    let x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.950_47);
    let y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
    let z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.088_83);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// CIEDE2000 (Sharma, Wu and Dalal 2005, doi 10.1002/col.20070).
fn difference([l1, a1, b1]: Rgb, [l2, a2, b2]: Rgb) -> f64 {
    let far = 25.0_f64.powi(7);
    let mean = 0.5 * (a1.hypot(b1) + a2.hypot(b2));
    let stretch = 1.0 + 0.5 * (1.0 - (mean.powi(7) / (mean.powi(7) + far)).sqrt());
    let (a1, a2) = (stretch * a1, stretch * a2);
    let (c1, c2) = (a1.hypot(b1), a2.hypot(b2));
    let hue = |a: f64, b: f64| b.atan2(a).to_degrees().rem_euclid(360.0);
    let (h1, h2) = (hue(a1, b1), hue(a2, b2));
    let turn = if c1 * c2 == 0.0 { 0.0 } else { (h2 - h1 + 180.0).rem_euclid(360.0) - 180.0 };
    let across = 2.0 * (c1 * c2).sqrt() * (0.5 * turn).to_radians().sin();
    let (l, c) = (0.5 * (l1 + l2), 0.5 * (c1 + c2));
    let h = match (c1 * c2 == 0.0, (h1 - h2).abs() <= 180.0, h1 + h2 < 360.0) {
        (true, ..) => h1 + h2,
        (_, true, _) => 0.5 * (h1 + h2),
        (_, _, true) => 0.5 * (h1 + h2 + 360.0),
        _ => 0.5 * (h1 + h2 - 360.0),
    };
    let cos = |degrees: f64| degrees.to_radians().cos();
    let t = 1.0 - 0.17 * cos(h - 30.0) + 0.24 * cos(2.0 * h) + 0.32 * cos(3.0 * h + 6.0) - 0.2 * cos(4.0 * h - 63.0);
    let above = (l - 50.0).powi(2);
    let (s_l, s_c, s_h) = (1.0 + 0.015 * above / (20.0 + above).sqrt(), 1.0 + 0.045 * c, 1.0 + 0.015 * c * t);
    let rotation = (60.0 * (-((h - 275.0) / 25.0).powi(2)).exp()).to_radians().sin();
    let rotation = -2.0 * (c.powi(7) / (c.powi(7) + far)).sqrt() * rotation;
    let (dl, dc, dh) = ((l2 - l1) / s_l, (c2 - c1) / s_c, across / s_h);
    (dl * dl + dc * dc + dh * dh + rotation * dc * dh).sqrt()
}

#[test]
fn the_difference_is_that_of_the_standard() {
    // Pairs 1, 7, 17 and 25 of the data of Sharma, Wu and Dalal.
    for (a, b, wanted) in [
        ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
        ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
        ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
        ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
    ] {
        assert!((difference(a, b) - wanted).abs() < 1e-4, "{}", difference(a, b));
    }
}

/// Least CIEDE2000 of two curves. 2.3 is just noticeable side by side; thin lines need several
/// times as much. Before there was a test, two colours of the light page were 0.7 apart for readers
/// without green cones.
const APART: f64 = 14.0;

/// And for those with all cones, who have more to tell them by: two pale ones of the dark page were 18 apart.
const APART_IN_COLOUR: f64 = 20.0;

#[test]
fn curves_are_told_apart_without_red_or_green_cones() {
    for (scheme, colours) in schemes() {
        let curves: Vec<_> = (0..7).map(|k| (k, colours[&format!("--c{k}")])).collect();
        for (eyes, matrix) in [("all cones", ALL_CONES), ("protanopia", PROTANOPIA), ("deuteranopia", DEUTERANOPIA)] {
            for (number, &(i, a)) in curves.iter().enumerate() {
                for &(j, b) in &curves[number + 1..] {
                    let apart = difference(lab(seen(&matrix, a)), lab(seen(&matrix, b)));
                    let least = if eyes == "all cones" { APART_IN_COLOUR } else { APART };
                    assert!(apart >= least, "{scheme}, {eyes}: --c{i} and --c{j} are {apart:.1} apart");
                }
            }
            let apart = |a: &str, b: &str| difference(lab(seen(&matrix, colours[a])), lab(seen(&matrix, colours[b])));
            for (a, b) in
                [("--stick", "--slip"), ("--force", "--impact"), ("--force", "--load"), ("--impact", "--load")]
            {
                assert!(apart(a, b) >= APART, "{scheme}, {eyes}: {a} and {b} are {:.1} apart", apart(a, b));
            }
        }
    }
}

/// WCAG 2.2 AA: text 4.5 (success criterion 1.4.3), what must be seen of graphics and controls 3
/// (1.4.11).
#[test]
fn text_and_graphics_have_the_contrast_of_wcag_aa() {
    for (scheme, colours) in schemes() {
        for background in ["--bg", "--soft"] {
            let on = |name: &str| contrast(colours[name], colours[background]);
            // Print has some of the light colours, under the same names in the first block.
            for text in ["--fg", "--muted", "--bad", "--focus"].into_iter().filter(|name| colours.contains_key(*name)) {
                assert!(on(text) >= 4.5, "{scheme}: {text} on {background} has {:.2}", on(text));
            }
            let curves: Vec<String> = (0..7).map(|k| format!("--c{k}")).collect();
            let others = ["--beam", "--force", "--impact", "--load", "--stick", "--slip"];
            for graphic in curves.iter().map(String::as_str).chain(others) {
                assert!(on(graphic) >= 3.0, "{scheme}: {graphic} on {background} has {:.2}", on(graphic));
            }
        }
    }
}
