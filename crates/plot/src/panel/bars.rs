//! Bars of several series.

use crate::figure::Frame;
use crate::series::Drawn;
use crate::theme::{Colour, Theme};
use crate::{Axis, Series};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Width of a bar of a stretch too short for its colour to be seen, px.
const THINNEST: f64 = 1.5;

/// Bars of series, without outlines, which would be wider than the bars of short stretches.
pub(super) fn draw_bars(svg: &mut String, frame: &Frame, theme: Theme, y: &Axis, series: &[Series]) {
    let drawn = || series.iter().enumerate().filter(|(_, one)| one.drawn == Drawn::Bars);
    let corners = |one: &Series| one.points().chunks_exact(2).map(|bar| [bar[0], bar[1]]).collect::<Vec<_>>();
    // Which of them have a bar that begins there.
    let mut beside: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
    for (k, one) in drawn() {
        corners(one).iter().for_each(|[(from, _), _]| beside.entry(from.to_bits()).or_default().push(k));
    }
    let py = |value: f64| frame.top + y.below_high(value, frame.height).clamp(0.0, frame.height);
    for (k, one) in drawn() {
        let mut path = String::new();
        let shown = |[(from, _), (to, _)]: &[(f64, f64); 2]| frame.x.contains(*from) || frame.x.contains(*to);
        for [(from, _), (to, value)] in corners(one).into_iter().filter(shown) {
            let sharing = &beside[&from.to_bits()];
            let place = sharing.iter().position(|other| *other == k).unwrap_or(0) as f64;
            let (a, b, count) = (frame.px(from), frame.px(to), sharing.len() as f64);
            let wide = ((b - a) / count).max(THINNEST);
            let left = 0.5 * (a + b) + (place - 0.5 * count) * wide;
            if left.is_finite() && value.is_finite() {
                let _ = write!(path, "M{left:.2} {:.2}V{:.2}h{wide:.2}V{:.2}z", py(0.0), py(value), py(0.0));
            }
        }
        if !path.is_empty() {
            let colour = Colour::Series(one.number_at(k)).value(theme);
            let _ = writeln!(svg, "<path d=\"{path}\" fill=\"{colour}\" stroke=\"none\"/>");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Figure, Panel};

    /// Left end, bottom, top and width of each bar of a path.
    fn bars_of(path: &str) -> Vec<[f64; 4]> {
        let numbers = |bar: &str| -> Vec<f64> {
            bar.split(|c: char| !(c.is_ascii_digit() || c == '.')).filter_map(|word| word.parse().ok()).collect()
        };
        let bar = |bar: &str| match numbers(bar)[..] {
            [left, bottom, top, wide, _] => [left, bottom, top, wide],
            ref other => panic!("{other:?} in {path}"),
        };
        path.split('M').skip(1).map(bar).collect()
    }

    #[test]
    fn bars_over_one_stretch_stand_beside_each_other_without_outlines() {
        let one = Series::bars("one", [(0.0, 0.1, 0.0), (0.1, 0.2, 1.0), (0.5, 0.500_001, 0.5)]);
        let two = Series::bars("two", [(0.1, 0.2, 0.75), (0.7, 0.8, 1.0)]);
        let panel = Panel::new(Axis::between("y", 0.0, 1.0)).with([one, two]);
        let svg = Figure::new("f", "f", Axis::between("x", 0.0, 1.0)).panel(panel).width_mm(119.0).to_svg();
        // 400 units across.
        let drawn = svg.lines().filter(|line| line.contains("stroke=\"none\"") && line.starts_with("<path"));
        let drawn: Vec<Vec<[f64; 4]>> = drawn.map(|line| bars_of(line.split('"').nth(1).unwrap())).collect();
        let [one, two] = &drawn[..] else { panic!("{svg}") };
        assert_eq!((one.len(), two.len()), (2, 2), "what has no height isn't drawn");
        assert_eq!([one[0][0], one[0][3]], [104.0, 20.0]);
        assert_eq!([two[0][0], two[0][3]], [124.0, 20.0]);
        assert_eq!([two[1][0], two[1][3]], [344.0, 40.0], "alone over its stretch");
        assert_eq!(one[1][3], THINNEST, "wide enough to be seen");
        assert!(one[0][1] == two[0][1] && one[0][2] < two[0][2], "from 0 on: {one:?} {two:?}");
        assert!(svg.contains(">one</text>"), "named");
    }
}
