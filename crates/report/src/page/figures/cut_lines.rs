//! Panels whose axes end before the largest values.

use super::values;
use crate::page::notes::Note;
use crate::page::panels::Cut;
use teeter_plot::{Axis, Series};

/// The range of an axis that ends at a limit.
pub(super) fn range_of(cut: &Cut, lines: &[Series]) -> (f64, f64) {
    let negative = values(lines).any(|y| y < -0.01 * cut.limit);
    (if negative { -cut.limit } else { -0.06 * cut.limit }, cut.limit)
}

/// The lines of an axis that ends at a limit, without those that would be an even grey; whether any of them is pale; and what is said of what is cut.
pub(super) fn cut_lines(
    lines: Vec<Series>,
    cut: Option<Cut>,
    range: Option<(f64, f64)>,
    unit: &str,
) -> (Vec<Series>, bool, Option<Note>) {
    let was_pale = lines.iter().any(Series::is_faint);
    let lines = without_filled(lines, range);
    let is_pale = lines.iter().any(Series::is_faint);
    // Of what rings the pale band is cut, not single peaks.
    let told = cut.map(|cut| match (was_pale, is_pale) {
        (true, true) => format!("pale curves cut, {}", cut.reach(unit)),
        (true, false) => format!("vibrations left out, {}", cut.whole_reach(unit)),
        (false, _) => format!("peaks cut, {}", cut.reach(unit)),
    });
    (lines, is_pale, told.map(Note::of_plot))
}

/// Of what rings so much that it would be an even grey, the strong curve tells all: lines without what is pale and cut, to both ends of the range, in most
/// of the time in which it is anything.
fn without_filled(mut lines: Vec<Series>, range: Option<(f64, f64)>) -> Vec<Series> {
    let Some((low, high)) = range else { return lines };
    // Where the axis ends for what is below 0: there, or just below 0, for what has one sign.
    let bottom = if low > -high { low.max(0.0) } else { low };
    let fills = |line: &Series| {
        let (mut filled, mut all) = (0_usize, 0_usize);
        let y: Vec<f64> = line.points().iter().map(|point| point.1).collect();
        for part in y.chunks(STRETCH) {
            let least = part.iter().copied().fold(f64::INFINITY, f64::min);
            let most = part.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            all += usize::from(least.abs().max(most.abs()) > 0.01 * high);
            filled += usize::from(most >= high && least <= bottom);
        }
        2 * filled > all && all > 0
    };
    lines.retain(|line| !(line.is_faint() && fills(line)));
    lines
}

/// So many points of a curve are a vertical stroke of its figure.
const STRETCH: usize = 16;

/// The y axis of these values, which may have been cut to a range.
pub(super) fn cut_axis(label: &str, range: Option<(f64, f64)>, values: impl Iterator<Item = f64>, least: f64) -> Axis {
    match range {
        Some((low, high)) => Axis::between(label, low, high),
        None => Axis::around(label, values, least),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_be_an_even_grey_is_left_out() {
        let of = |size: f64| {
            let ringing = (0..400).map(|k| (f64::from(k), if k % 2 == 0 { size } else { -size }));
            let strong = Series::line("mean", (0..400).map(|k| (f64::from(k), 1.0)));
            vec![Series::line("", ringing).faint(), strong]
        };
        let told = |size: f64, range: Option<(f64, f64)>| {
            let cut = Cut { limit: 1.5, low: -size, high: 2.0 * size };
            let (lines, is_pale, told) = cut_lines(of(size), Some(cut), range, "N");
            (lines.len(), is_pale, told.unwrap().text)
        };
        let range = Some((-1.5, 1.5));
        assert_eq!(told(40.0, range), (1, false, "vibrations left out, from \u{2212}40 to 80 N".to_owned()));
        // What stays within the range, or has no end that cuts it, is drawn.
        assert_eq!(told(1.2, range), (2, true, "pale curves cut, up to 2.4 N".to_owned()));
        assert!(told(40.0, None).1);
    }
}
