//! The data series of a panel.

/// A named series of points: a line, a staircase, or marks.
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
}

/// By what a line is dashed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dash {
    /// Its number.
    ByNumber,
    /// It lies on another line, or on so many (the first number) that lie on each other; the most that any line of the panel does (the second).
    Over(u8, u8),
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
        }
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

    /// Whether a line stays within `tolerance` (in y) of another one at all of its points, which are
    /// at the same x, or hides it at half of them: there within the tolerance, and away from 0.
    fn lies_on(&self, other: &Self, tolerance: f64) -> bool {
        let pairs = || self.points.iter().zip(&other.points);
        let near = |a: &(f64, f64), b: &(f64, f64)| (a.1 - b.1).abs() <= tolerance;
        let hidden = || pairs().filter(|(a, b)| near(a, b) && a.1.abs() > tolerance).count();
        self.drawn == Drawn::Line
            && other.drawn == Drawn::Line
            && self.faint == other.faint
            && self.points.len() == other.points.len()
            && pairs().all(|(a, b)| a.0 == b.0)
            && (pairs().all(|(a, b)| near(a, b)) || 2 * hidden() > self.points.len())
    }

    /// Dashes each line that lies within `tolerance` of an earlier one, or does so for half of its length away from 0: that one shows in the
    /// gaps. Of several on each other each later
    /// one has shorter dashes.
    pub(crate) fn tell_apart(lines: &mut [Self], tolerance: f64) {
        for k in 1..lines.len() {
            let (before, rest) = lines.split_at_mut(k);
            let below =
                before.iter().filter(|earlier| rest[0].lies_on(earlier, tolerance)).map(|earlier| match earlier.dash {
                    Dash::ByNumber => 0,
                    Dash::Over(lines, _) => lines,
                });
            if let Some(lines) = below.max() {
                rest[0].dash = Dash::Over(lines.saturating_add(1), 0);
            }
        }
        let lines_below = |line: &Self| if let Dash::Over(lines, _) = line.dash { lines } else { 0 };
        let most = lines.iter().map(lines_below).max().unwrap_or(0);
        for line in lines {
            if let Dash::Over(_, of) = &mut line.dash {
                *of = most;
            }
        }
    }

    /// The name in the legend.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.label
    }

    /// The points; for a staircase, its corners, for an area, its outline, for cells, two corners of each.
    #[must_use]
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// The number for colour and dash of the series with this index in its panel.
    pub(crate) fn number_at(&self, place: usize) -> usize {
        self.number.unwrap_or(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_line_on_an_earlier_one_is_dashed() {
        let line = |shift: f64| Series::line("", (0..9).map(|k| (f64::from(k), f64::from(k * k) + shift)));
        let mut lines = [line(0.0), line(0.2), line(0.4), line(9.0)];
        Series::tell_apart(&mut lines, 0.3);
        // The third lies on the second alone, which has dashes already.
        let dashes = [Dash::ByNumber, Dash::Over(1, 2), Dash::Over(2, 2), Dash::ByNumber];
        assert_eq!(lines.each_ref().map(|line| line.dash), dashes);
    }

    #[test]
    fn a_line_that_leaves_another_one_is_dashed_if_it_lies_on_it_for_half_of_its_length() {
        let leaves = |at: i32, level: f64| {
            let line = |way: f64| {
                (0..10).map(move |k| (f64::from(k), level + if k < at { 0.0 } else { way * f64::from(k - at + 1) }))
            };
            let mut lines = [Series::line("", line(1.0)), Series::line("", line(-1.0))];
            Series::tell_apart(&mut lines, 0.1);
            lines[1].dash
        };
        assert_eq!((leaves(7, 5.0), leaves(3, 5.0)), (Dash::Over(1, 1), Dash::ByNumber));
        // At 0 both are often, and hide nothing that matters.
        assert_eq!(leaves(7, 0.0), Dash::ByNumber);
    }

    #[test]
    fn a_staircase_keeps_each_value_until_the_next() {
        let series = Series::staircase("", [(0.0, 1.0), (2.0, 3.0)], 5.0);
        assert_eq!(series.points(), [(0.0, 1.0), (2.0, 1.0), (2.0, 3.0), (5.0, 3.0)]);
        assert!(Series::staircase("", [], 5.0).points().is_empty());
    }
}
