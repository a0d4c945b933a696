//! What is drawn on the axes of a panel.

/// Points with a name: a line, a staircase, or marks.
///
/// A line is broken where a value is not finite (on a logarithmic axis, not positive), and marks
/// are left out there: an [`Axis`](crate::Axis) made from the same values says so beforehand.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    label: String,
    number: Option<usize>,
    points: Vec<(f64, f64)>,
    pub(crate) drawn: Drawn,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Drawn {
    Line,
    Marks { mark: Mark, hollow: bool },
}

/// Shape of the marks of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A circle.
    Circle,
    /// A square.
    Square,
    /// A triangle that points up.
    Triangle,
    /// A square on its corner.
    Diamond,
}

impl Mark {
    /// Shapes in turn, so that series can be told apart without their colours.
    #[must_use]
    pub fn of(number: usize) -> Self {
        [Self::Circle, Self::Square, Self::Triangle, Self::Diamond][number % 4]
    }
}

impl Series {
    /// A line through points. Without a label, it is not in the legend.
    #[must_use]
    pub fn line(label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self { label: label.into(), number: None, points: points.into_iter().collect(), drawn: Drawn::Line }
    }

    /// A line of steps: each value holds from its x to the x of the next point, the last one up to
    /// `end`.
    #[must_use]
    pub fn staircase(label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>, end: f64) -> Self {
        let points: Vec<(f64, f64)> = points.into_iter().collect();
        let ends = points.iter().skip(1).map(|point| point.0).chain([end]);
        let steps = points.iter().zip(ends).flat_map(|(&(x, y), end)| [(x, y), (end, y)]);
        Self::line(label, steps.collect::<Vec<_>>())
    }

    /// Marks at points, filled. Without a label, they are not in the legend.
    #[must_use]
    pub fn marks(label: impl Into<String>, points: impl IntoIterator<Item = (f64, f64)>, mark: Mark) -> Self {
        Self { drawn: Drawn::Marks { mark, hollow: false }, ..Self::line(label, points) }
    }

    /// With the colour of this number; of lines, seven numbers on the colours repeat with dashes,
    /// then dots. Default: the place of the series in its panel, from 0.
    #[must_use]
    pub fn number(mut self, number: usize) -> Self {
        self.number = Some(number);
        self
    }

    /// With hollow marks instead of filled ones, through which others can be seen; a line stays as
    /// it is.
    #[must_use]
    pub fn hollow(mut self) -> Self {
        if let Drawn::Marks { hollow, .. } = &mut self.drawn {
            *hollow = true;
        }
        self
    }

    /// What the legend calls it.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.label
    }

    /// Its points; of a staircase, its corners.
    #[must_use]
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// The number that gives colour and dash, for the series at this place in its panel.
    pub(crate) fn number_at(&self, place: usize) -> usize {
        self.number.unwrap_or(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_of_a_staircase_holds_until_the_next_and_the_last_to_the_end() {
        let series = Series::staircase("", [(0.0, 1.0), (2.0, 3.0)], 5.0);
        assert_eq!(series.points(), [(0.0, 1.0), (2.0, 1.0), (2.0, 3.0), (5.0, 3.0)]);
        assert!(Series::staircase("", [], 5.0).points().is_empty());
    }
}
