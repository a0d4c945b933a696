//! The data series of a panel.

use crate::theme::SERIES_COLOURS;

/// A named series of points: a line, a staircase, bars, or marks.
///
/// Where a value is not finite (on a logarithmic axis, not positive), a line is broken and a mark
/// omitted. Creating an [`Axis`](crate::Axis) from the same values reports such a value as an
/// error.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    label: String,
    number: Option<usize>,
    points: Vec<(f64, f64)>,
    pub(crate) drawn: Drawn,
    pub(crate) dash: Dash,
    pub(crate) faint: bool,
    /// Of a line on others, by points, where it doesn't lie on any of them, and of one that is dashed in part, where it isn't; empty for nowhere.
    pub(crate) alone: Vec<bool>,
}

/// By what a line is dashed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dash {
    /// Its number.
    ByNumber,
    /// It lies on another line, or on so many that lie on each other.
    Over(u8),
    /// It isn't all along of one quantity.
    InPart,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Drawn {
    Line,
    Marks {
        mark: Mark,
        hollow: bool,
    },
    Area,
    /// Filled rectangles, each between two of the points.
    Cells,
    /// Rectangles like these, from 0 on, which make room for those of other series over the same stretch of x.
    Bars,
}

/// The marker shape of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A circle.
    Circle,
    /// A square.
    Square,
    /// A triangle that points up.
    Triangle,
    /// A diamond.
    Diamond,
}

impl Mark {
    /// Shapes in turn, so that series can be distinguished without colours.
    #[must_use]
    pub fn of(number: usize) -> Self {
        [Self::Circle, Self::Square, Self::Triangle, Self::Diamond][number % 4]
    }
}

impl Series {
    /// A line through points. Without a label it isn't in the legend.
    #[must_use]
    pub fn line(label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self {
            label: label.into(),
            number: None,
            points: points.into_iter().collect(),
            drawn: Drawn::Line,
            dash: Dash::ByNumber,
            faint: false,
            alone: Vec::new(),
        }
    }

    /// Means over stretches, each from its point's x to that of the next, the last to `end`: a line through the middles of these, as what changes slowly
    /// has no steps, with a jump where two neighbours differ by far more than those beside them do.
    #[must_use]
    pub fn means(label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>, end: f64) -> Self {
        let points: Vec<(f64, f64)> = points.into_iter().collect();
        let jumps = jumps(&points.iter().map(|point| point.1).collect::<Vec<_>>());
        let mut line = Vec::with_capacity(points.len() + 2);
        for (k, &(from, y)) in points.iter().enumerate() {
            let to = points.get(k + 1).map_or(end, |next| next.0);
            if k == 0 || jumps[k - 1] {
                line.push((from, y));
            }
            line.push((0.5 * (from + to), y));
            if k + 1 == points.len() || jumps[k] {
                line.push((to, y));
            }
        }
        Self::line(label, line)
    }

    /// A step line: each value is constant up to the x of the next point, the last one up to `end`.
    #[must_use]
    pub fn staircase(label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>, end: f64) -> Self {
        let points: Vec<(f64, f64)> = points.into_iter().collect();
        let ends = points.iter().skip(1).map(|point| point.0).chain([end]);
        let steps = points.iter().zip(ends).flat_map(|(&(x, y), end)| [(x, y), (end, y)]);
        Self::line(label, steps.collect::<Vec<_>>())
    }

    /// The area between a lower and an upper line, as (x, lower, upper), lightly filled and drawn below
    /// all lines.
    #[must_use]
    pub fn area(label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        let points: Vec<(f64, f64, f64)> = points.into_iter().collect();
        let back = points.iter().rev().map(|&(x, _, upper)| (x, upper));
        let outline: Vec<(f64, f64)> = points.iter().map(|&(x, lower, _)| (x, lower)).chain(back).collect();
        Self { drawn: Drawn::Area, ..Self::line(label, outline) }
    }

    /// Filled rectangles from left to right and from bottom to top, in the units of the axes: the cells of
    /// a map. Drawn below all lines.
    #[must_use]
    pub fn cells(label: impl Into<String>, cells: impl IntoIterator<Item = ((f64, f64), (f64, f64))>) -> Self {
        let corners = cells.into_iter().flat_map(|((left, right), (bottom, top))| [(left, bottom), (right, top)]);
        Self { drawn: Drawn::Cells, ..Self::line(label, corners) }
    }

    /// Bars from 0 on over stretches of x: from, to, height. Those of several series over the same stretch stand beside each other; each is wide enough
    /// to be seen. Those without a height aren't drawn.
    #[must_use]
    pub fn bars(label: impl Into<String>, bars: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        let corners = bars.into_iter().filter(|bar| bar.2 != 0.0).flat_map(|(from, to, y)| [(from, 0.0), (to, y)]);
        Self { drawn: Drawn::Bars, ..Self::line(label, corners.collect::<Vec<_>>()) }
    }

    /// Filled marks at points. Without a label they aren't in the legend.
    #[must_use]
    pub fn marks(label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>, mark: Mark) -> Self {
        Self { drawn: Drawn::Marks { mark, hollow: false }, ..Self::line(label, points) }
    }

    /// Sets the number of the series' colour. There are seven colours; lines with higher numbers
    /// are dashed, then dotted. Default: the index of the series in its panel, from 0.
    #[must_use]
    pub fn number(mut self, number: usize) -> Self {
        self.number = Some(number);
        self
    }

    /// Draws hollow marks instead of filled ones, so that others remain visible; no effect on a
    /// line.
    #[must_use]
    pub fn hollow(mut self) -> Self {
        if let Drawn::Marks { hollow, .. } = &mut self.drawn {
            *hollow = true;
        }
        self
    }

    /// Draws a line thin and pale, as the raw values behind a mean, and marks pale and below the lines, as
    /// the measured values that a curve goes through; no effect on areas.
    #[must_use]
    pub fn faint(mut self) -> Self {
        self.faint = true;
        self
    }

    /// Whether it is drawn thin and pale.
    #[must_use]
    pub fn is_faint(&self) -> bool {
        self.faint
    }

    /// Whether a line stays within `tolerance` (in y) of another one at all of its points, which are
    /// at the same x, or hides it at half of those that are away from 0, if these are more than a few.
    fn lies_on(&self, other: &Self, tolerance: f64) -> bool {
        let pairs = || self.points.iter().zip(&other.points);
        let near = |a: &(f64, f64), b: &(f64, f64)| (a.1 - b.1).abs() <= tolerance;
        let away = || pairs().filter(|(a, _)| a.1.abs() > tolerance);
        let hidden = || away().filter(|(a, b)| near(a, b)).count();
        let hides = || 20 * away().count() > self.points.len() && 2 * hidden() > away().count();
        self.drawn == Drawn::Line
            && other.drawn == Drawn::Line
            && self.dash != Dash::InPart
            && self.faint == other.faint
            && self.points.len() == other.points.len()
            && pairs().all(|(a, b)| a.0 == b.0)
            && (pairs().all(|(a, b)| near(a, b)) || hides())
    }

    /// Dashes a line that lies on so many others that lie on each other, at most [`MOST_OVER`]: they show in its gaps. Panels
    /// [find such lines](crate::Panel::telling_apart) themselves where these have their points at the same x.
    #[must_use]
    pub fn over(mut self, lines: u8) -> Self {
        self.dash = if lines == 0 { Dash::ByNumber } else { Dash::Over(lines.min(MOST_OVER)) };
        self
    }

    /// Draws a line on others solid about the points for which this is true, as it lies on none of them there.
    #[must_use]
    pub fn alone_at(mut self, points: impl IntoIterator<Item = bool>) -> Self {
        self.alone = points.into_iter().collect();
        self
    }

    /// Dashes a line but about the points for which this is true, as it is of another quantity there. No effect without such points.
    #[must_use]
    pub fn dashed_but_at(self, points: Vec<bool>) -> Self {
        let dash = if points.contains(&true) { Dash::InPart } else { self.dash };
        Self { dash, alone: points, ..self }
    }

    /// The stretches of a dashed line that are solid: the points at which it lies on no other one and their neighbours, with gaps between.
    pub(crate) fn solid_stretches(&self) -> Option<Vec<(f64, f64)>> {
        let is_alone = |k: usize| self.alone.get(k).copied().unwrap_or(false);
        let of_dashed = self.dash != Dash::ByNumber && self.alone.contains(&true);
        of_dashed.then(|| {
            let points = self.points.iter().enumerate();
            let solid = |k: usize| is_alone(k) || is_alone(k + 1) || k.checked_sub(1).is_some_and(is_alone);
            points.map(|(k, &(x, y))| (x, if solid(k) { y } else { f64::NAN })).collect()
        })
    }

    /// Dashes each line that lies within `tolerance` of an earlier one, or does so for half of its length away from 0, where it does: that one
    /// shows in the gaps. Of several on each other each later one has shorter dashes. Returns how many lie on each other where these are too many for that.
    pub(crate) fn tell_apart(lines: &mut [Self], tolerance: f64) -> usize {
        let numbers = lines.iter().enumerate().filter(|(_, line)| line.drawn == Drawn::Line);
        let most_over = most_over(numbers.map(|(k, line)| line.number_at(k)));
        let found = coincident(lines.len(), most_over, |k, earlier| lines[k].lies_on(&lines[earlier], tolerance));
        for k in (0..lines.len()).filter(|k| found.over[*k] > 0) {
            let (earlier, later) = lines.split_at_mut(k);
            let line = &mut later[0];
            let below: Vec<&Self> = earlier.iter().filter(|other| line.lies_on(other, tolerance)).collect();
            let near = |i: usize, y: f64| below.iter().any(|other| (y - other.points[i].1).abs() <= tolerance);
            // Where it has no value there is nothing to draw.
            let points = line.points.iter().enumerate();
            line.alone = points.map(|(i, &(_, y))| y.is_finite() && !near(i, y)).collect();
            line.dash = Dash::Over(found.over[k]);
        }
        found.too_many
    }

    /// The name in the legend.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.label
    }

    /// The points; for a staircase, its corners, for an area, its outline, for cells and bars, two corners of each.
    #[must_use]
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// The number for colour and dash of the series with this index in its panel.
    pub(crate) fn number_at(&self, place: usize) -> usize {
        self.number.unwrap_or(place)
    }
}

/// On so many others a line may lie for each to show in the gaps of those above it.
pub const MOST_OVER: u8 = 3;

/// On so many others a line of a plot with these numbers may lie and be dashed for it: on none where some numbers are told apart by dashes, which would
/// then mean either.
#[must_use]
pub fn most_over(mut numbers: impl Iterator<Item = usize>) -> u8 {
    if numbers.any(|number| number >= SERIES_COLOURS) { 0 } else { MOST_OVER }
}

/// Which lines lie on others.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Coincident {
    /// On how many others that lie on each other each line lies; 0 too where these are more than may be dashed.
    pub over: Vec<u8>,
    /// How many lines lie on each other where these are that many; 0 if nowhere.
    pub too_many: usize,
}

/// Finds out of `count` lines, drawn in their order, those that lie on others, where the first number of `lies_on` is that of the later one. Of
/// those that lie on more than `most` others (see [`most_over`]) none is dashed.
///
/// ```
/// // Line 1 lies on line 0.
/// let lies_on = |line, earlier| (line, earlier) == (1, 0);
/// let found = teeter_plot::coincident(3, teeter_plot::most_over(0..3), lies_on);
/// assert_eq!((found.over, found.too_many), (vec![0, 1, 0], 0));
/// // The eighth line has the colour of the first one, and dashes of its own.
/// let found = teeter_plot::coincident(8, teeter_plot::most_over(0..8), lies_on);
/// assert_eq!((found.over, found.too_many), (vec![0; 8], 2));
/// ```
#[must_use]
pub fn coincident(count: usize, most: u8, lies_on: impl Fn(usize, usize) -> bool) -> Coincident {
    let mut over = vec![0_usize; count];
    // The lines of each group have the number of its first one.
    let mut group: Vec<usize> = (0..count).collect();
    for line in 0..count {
        for earlier in (0..line).filter(|earlier| lies_on(line, *earlier)) {
            over[line] = over[line].max(over[earlier] + 1);
            let (from, to) = (group[line].max(group[earlier]), group[line].min(group[earlier]));
            group.iter_mut().filter(|number| **number == from).for_each(|number| *number = to);
        }
    }
    let mut too_many = 0;
    for number in 0..count {
        let own = || (0..count).filter(|line| group[*line] == number);
        if own().any(|line| over[line] > usize::from(most)) {
            too_many = too_many.max(own().count());
            let lines: Vec<usize> = own().collect();
            lines.into_iter().for_each(|line| over[line] = 0);
        }
    }
    let over = over.into_iter().map(|lines| u8::try_from(lines).unwrap_or(most));
    Coincident { over: over.collect(), too_many }
}

/// A change from one mean to the next is a jump if it is this many times as large as those before and after it.
const JUMPS: f64 = 4.0;

/// A change by less than this part of the range of all means is seen as a kink at most.
const SEEN: f64 = 0.02;

/// Whether each of these means jumps to the next one.
fn jumps(means: &[f64]) -> Vec<bool> {
    let finite = || means.iter().copied().filter(|y| y.is_finite());
    let range = finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min);
    let change = |k: usize| means.get(k + 1).map_or(0.0, |next| (next - means[k]).abs());
    let is_jump = |k: usize| {
        let beside = change(k + 1).max(k.checked_sub(1).map_or(0.0, change));
        // What is not finite is no neighbour to draw a line to.
        !change(k).is_finite() || (change(k) > SEEN * range && change(k) > JUMPS * beside)
    };
    (0..means.len().saturating_sub(1)).map(is_jump).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_of_what_changes_slowly_have_no_steps_and_what_jumps_does() {
        let ramp = Series::means("", [(0.0, 0.0), (1.0, 0.1), (2.0, 0.2), (3.0, 0.3)], 4.0);
        assert_eq!(ramp.points(), [(0.0, 0.0), (0.5, 0.0), (1.5, 0.1), (2.5, 0.2), (3.5, 0.3), (4.0, 0.3)]);
        let jump = Series::means("", [(0.0, 1.0), (1.0, 1.0), (2.0, 5.0), (3.0, 5.1)], 4.0);
        assert_eq!(jump.points()[2..5], [(1.5, 1.0), (2.0, 1.0), (2.0, 5.0)]);
        let missing = Series::means("", [(0.0, 1.0), (1.0, f64::NAN), (2.0, 2.0)], 3.0);
        assert!(missing.points().contains(&(1.0, 1.0)) && missing.points().contains(&(2.0, 2.0)));
    }

    #[test]
    fn only_a_line_on_an_earlier_one_is_dashed() {
        let line = |shift: f64| Series::line("", (0..9).map(|k| (f64::from(k), f64::from(k * k) + shift)));
        let mut lines = [line(0.0), line(0.2), line(0.4), line(9.0)];
        let _ = Series::tell_apart(&mut lines, 0.3);
        // The third lies on the second alone, which has dashes already.
        let dashes = [Dash::ByNumber, Dash::Over(1), Dash::Over(2), Dash::ByNumber];
        assert_eq!(lines.each_ref().map(|line| line.dash), dashes);
    }

    #[test]
    fn of_more_lines_on_each_other_than_dashes_can_show_none_is_dashed() {
        let line = |shift: f64| Series::line("", (0..9).map(|k| (f64::from(k), 5.0 + shift))).number(0);
        let pair = [7.0, 7.0].map(line);
        let mut lines: Vec<Series> = (0..16).map(|_| line(0.0)).chain(pair).collect();
        assert_eq!(Series::tell_apart(&mut lines, 0.1), 16);
        assert!(lines[..17].iter().all(|line| line.dash == Dash::ByNumber));
        assert_eq!(lines[17].dash, Dash::Over(1));
        let mut four: Vec<Series> = (0..4).map(|_| line(0.0)).collect();
        assert_eq!((Series::tell_apart(&mut four, 0.1), four[3].dash), (0, Dash::Over(3)));
    }

    #[test]
    fn a_line_told_by_its_dashes_keeps_them_and_no_other_has_any() {
        let line = |number: usize, shift: f64| {
            Series::line("", (0..9).map(|k| (f64::from(k), f64::from(k) + if k < 7 { 0.0 } else { shift })))
                .number(number)
        };
        // The eighth and the ninth on the first one, and two of one colour beside each other.
        let mut lines = [line(0, 0.0), line(7, 5.0), line(8, -5.0), line(1, 9.0)];
        assert_eq!(Series::tell_apart(&mut lines, 0.1), 4);
        assert!(lines.iter().all(|line| line.dash == Dash::ByNumber && line.solid_stretches().is_none()));
    }

    #[test]
    fn a_line_that_rests_at_0_for_most_of_the_time_is_dashed_if_it_moves_with_another() {
        let pulse = |y: f64| Series::line("", (0..90).map(|k| (f64::from(k), if k < 10 { y } else { 0.0 })));
        let mut lines = [pulse(5.0), pulse(5.05), pulse(3.0)];
        let _ = Series::tell_apart(&mut lines, 0.1);
        assert_eq!(lines.map(|line| line.dash), [Dash::ByNumber, Dash::Over(1), Dash::ByNumber]);
    }

    #[test]
    fn a_line_that_leaves_another_one_is_dashed_if_it_lies_on_it_for_half_of_its_length() {
        let leaves = |at: i32, level: f64| {
            let line = |way: f64| {
                (0..10).map(move |k| (f64::from(k), level + if k < at { 0.0 } else { way * f64::from(k - at + 1) }))
            };
            let mut lines = [Series::line("", line(1.0)), Series::line("", line(-1.0))];
            let _ = Series::tell_apart(&mut lines, 0.1);
            lines[1].dash
        };
        assert_eq!((leaves(7, 5.0), leaves(3, 5.0)), (Dash::Over(1), Dash::ByNumber));
        // At 0 both are often, and hide nothing that matters.
        assert_eq!(leaves(7, 0.0), Dash::ByNumber);
    }

    #[test]
    fn a_line_of_two_quantities_is_dashed_where_it_is_of_the_other() {
        let line = || Series::line("", (0..9).map(|k| (f64::from(k), 5.0)));
        let mut lines = [line(), line().dashed_but_at((0..9).map(|k| k < 3).collect())];
        assert_eq!(Series::tell_apart(&mut lines, 0.1), 0);
        assert_eq!(lines[1].dash, Dash::InPart, "also where it lies on another one");
        let solid = lines[1].solid_stretches().unwrap();
        assert_eq!(solid.iter().filter(|(_, y)| y.is_finite()).count(), 4);
        assert_eq!(line().dashed_but_at(vec![false; 9]), Series { alone: vec![false; 9], ..line() });
    }

    #[test]
    fn a_line_is_alone_only_where_it_has_a_value() {
        let line = |gap: usize, away: usize| {
            let y = move |k| if k == gap { f64::NAN } else { 5.0 + if k == away { 2.0 } else { 0.0 } };
            Series::line("", (0..9).map(|k| (k as f64, y(k))))
        };
        let mut lines = [line(9, 9), line(3, 6)];
        let _ = Series::tell_apart(&mut lines, 0.1);
        let alone = lines[1].alone.iter().enumerate().filter(|(_, alone)| **alone).map(|(k, _)| k);
        assert_eq!((lines[1].dash, alone.collect::<Vec<_>>()), (Dash::Over(1), vec![6]));
    }

    #[test]
    fn a_staircase_keeps_each_value_until_the_next() {
        let series = Series::staircase("", [(0.0, 1.0), (2.0, 3.0)], 5.0);
        assert_eq!(series.points(), [(0.0, 1.0), (2.0, 1.0), (2.0, 3.0), (5.0, 3.0)]);
        assert!(Series::staircase("", [], 5.0).points().is_empty());
    }
}
