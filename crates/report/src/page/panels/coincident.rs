//! Phase portraits that lie on each other, as those of drums that rock as one column.

use super::PortraitLine;

/// Curves that are nearer than this part of what the axis shows look like one: a line's width.
const NEAR: f64 = 0.01;

/// Says of each curve on how many others it lies, and returns how many lie on each other where these are too many to be told apart.
pub(super) fn tell_apart(lines: &mut [PortraitLine]) -> usize {
    let range = |of: fn(&PortraitLine) -> &[f64]| {
        let all = lines.iter().flat_map(of).filter(|value| value.is_finite());
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
        high - low
    };
    let within = [range(|line| &line.x), range(|line| &line.v)].map(|range| NEAR * range);
    let most = teeter_plot::most_over(lines.iter().map(|line| line.number));
    let found = teeter_plot::coincident(lines.len(), most, |k, earlier| lies_on(&lines[k], &lines[earlier], within));
    for k in (0..lines.len()).filter(|k| found.over[*k] > 0) {
        let (earlier, later) = lines.split_at_mut(k);
        let line = &mut later[0];
        let below = earlier.iter().filter(|other| lies_on(line, other, within));
        let mut alone = vec![true; line.t.len()];
        for other in below {
            alone.iter_mut().zip(near(line, other, within)).for_each(|(alone, near)| *alone &= !near);
        }
        (line.over, line.alone) = (found.over[k], alone);
    }
    found.too_many
}

/// Whether a curve is where another one is at the same times, at all of its points or at half of those that are away from where it rests.
fn lies_on(line: &PortraitLine, other: &PortraitLine, within: [f64; 2]) -> bool {
    let [x, v] = within;
    let (mut away, mut hidden, mut apart) = (0, 0, 0);
    for (k, near) in near(line, other, within).enumerate() {
        let is_away = (line.x[k] - line.x[0]).abs() > x || line.v[k].abs() > v;
        away += usize::from(is_away);
        hidden += usize::from(is_away && near);
        apart += usize::from(!near);
    }
    !other.t.is_empty() && (apart == 0 || 2 * hidden > away)
}

/// Of each point of a curve, whether another one is there at the same time.
fn near(line: &PortraitLine, other: &PortraitLine, [x, v]: [f64; 2]) -> impl Iterator<Item = bool> {
    let mut after = 0;
    line.t.iter().enumerate().map(move |(k, t)| {
        if other.t.is_empty() {
            return false;
        }
        while after + 1 < other.t.len() && other.t[after] < *t {
            after += 1;
        }
        let before = after.saturating_sub(1);
        let lasting = other.t[after] - other.t[before];
        let part = if lasting > 0.0 { ((t - other.t[before]) / lasting).clamp(0.0, 1.0) } else { 0.0 };
        let between = |values: &[f64]| values[before] + part * (values[after] - values[before]);
        (line.x[k] - between(&other.x)).abs() <= x && (line.v[k] - between(&other.v)).abs() <= v
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A vibration of this amplitude, with its points at multiples of `step`.
    fn line(amplitude: f64, step: f64) -> PortraitLine {
        let t: Vec<f64> = (0..).map(|k| step * f64::from(k)).take_while(|t| *t < 6.0).collect();
        PortraitLine {
            label: String::new(),
            number: 0,
            x: t.iter().map(|t| amplitude * t.sin()).collect(),
            v: t.iter().map(|t| amplitude * t.cos()).collect(),
            strong: 0..t.len(),
            over: 0,
            alone: Vec::new(),
            t,
        }
    }

    #[test]
    fn portraits_on_each_other_are_found_whatever_points_they_have() {
        let mut lines = [line(1.0, 0.05), line(1.003, 0.07), line(0.6, 0.05), line(1.0, 0.03)];
        assert_eq!(tell_apart(&mut lines), 0);
        assert_eq!(lines.map(|line| line.over), [0, 1, 0, 2]);
        let mut drums: Vec<PortraitLine> = (0..5).map(|_| line(1.0, 0.05)).collect();
        assert_eq!(tell_apart(&mut drums), 5);
        assert!(drums.iter().all(|line| line.over == 0));
        // The eighth block is told from the first one by its dashes.
        let mut of_eight = [line(1.0, 0.05), PortraitLine { number: 7, ..line(1.0, 0.05) }];
        assert_eq!((tell_apart(&mut of_eight), of_eight[1].over), (2, 0));
    }
}
