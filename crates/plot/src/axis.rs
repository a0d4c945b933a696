//! Axes: their range, and the position of a value on them.

use crate::AxisError;
use crate::ticks::Ticks;

/// A labelled axis over a finite, non-empty range.
///
/// The label should name the quantity, its symbol and its unit, as in "Time t (s)".
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub(crate) label: String,
    scale: Scale,
    low: f64,
    high: f64,
    /// What values are multiplied by in labels.
    shown: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scale {
    Linear,
    Logarithmic,
}

/// Larger values are drawn here, so that no width overflows.
const LARGEST: f64 = 1e300;

/// Largest exponent of the ends of a logarithmic axis: that of [`LARGEST`].
const MOST_DECADES: f64 = 300.0;

/// Values that differ by less than this relative amount are drawn as constant.
const CONSTANT: f64 = 1e-9;

/// Above and below a constant value there is room for this part of it.
const ROOM_OF_CONSTANT: f64 = 0.1;

/// About as many round numbers are on an axis that goes out to them.
const ROUND_NUMBERS: usize = 6;

/// Least relative width of a given range; the round numbers in it can still be distinguished.
const NARROWEST: f64 = 1e-12;

impl Axis {
    /// A linear axis over all values with a margin of 5 %. It starts at zero if zero is no farther
    /// away than the range of the values is wide. Without values, it goes from 0 to 1.
    ///
    /// # Errors
    /// [`AxisError::NotFinite`] if a value is not finite.
    pub fn linear(label: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Result<Self, AxisError> {
        let label = label.into();
        let (low, high) = extent(&label, values)?.unwrap_or((0.0, 1.0));
        let margin = 0.05 * (high - low);
        let from_zero = low >= 0.0 && low <= 0.5 * high;
        Ok(Self::between(label, if from_zero { 0.0 } else { low - margin }, high + margin))
    }

    /// A logarithmic axis over all values with a margin of 3 %, extended to the next 1, 2 or 5
    /// times a power of ten. Without values, it goes from 1 to 10. The axis is limited to 1e±300.
    ///
    /// # Errors
    /// [`AxisError::NotFinite`] if a value is not finite, [`AxisError::NotPositive`] if one is zero
    /// or negative.
    pub fn logarithmic(label: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Result<Self, AxisError> {
        let label = label.into();
        let (low, high) = match extent(&label, values)? {
            None => (0.0, 1.0),
            Some((low, _)) if low <= 0.0 => return Err(AxisError::NotPositive { axis: label, value: low }),
            Some((low, high)) => {
                let (low, high) = (low.log10(), high.log10());
                // Half a decade for values that are about equal.
                let margin = (0.03 * (high - low)).max(0.5 * (0.5 - (high - low)));
                (round_down(low - margin).max(-MOST_DECADES), round_up(high + margin).min(MOST_DECADES))
            }
        };
        Ok(Self { label, scale: Scale::Logarithmic, low, high, shown: 1.0 })
    }

    /// A linear axis over the finite values with a margin of 6 %, at least `least` wide in their
    /// unit, so that rounding errors of constant values aren't magnified. Without values, from −1
    /// to 1.
    #[must_use]
    pub fn around(label: impl Into<String>, values: impl IntoIterator<Item = f64>, least: f64) -> Self {
        let (low, high) = range_around(values.into_iter(), least);
        Self { label: label.into(), scale: Scale::Linear, low, high, shown: 1.0 }
    }

    /// A linear axis with given ends. If these aren't a valid range (not finite, not ascending, or
    /// equal up to rounding), the axis is placed [around](Axis::around) them.
    #[must_use]
    pub fn between(label: impl Into<String>, low: f64, high: f64) -> Self {
        if is_drawable(low, high) {
            Self { label: label.into(), scale: Scale::Linear, low, high, shown: 1.0 }
        } else {
            Self::around(label, [low, high], 0.0)
        }
    }

    /// A logarithmic axis with given ends. If these aren't a valid range of positive values, it goes from 1
    /// to 10.
    #[must_use]
    pub fn logarithmic_between(label: impl Into<String>, low: f64, high: f64) -> Self {
        let limited = |x: f64| x.log10().clamp(-MOST_DECADES, MOST_DECADES);
        let (low, high) = match (limited(low), limited(high)) {
            (low, high) if is_drawable(low, high) => (low, high),
            _ => (0.0, 1.0),
        };
        Self { label: label.into(), scale: Scale::Logarithmic, low, high, shown: 1.0 }
    }

    /// Sets the low end, if it is below the high end and, on a logarithmic axis, positive.
    #[must_use]
    pub fn starting_at(mut self, low: f64) -> Self {
        let low = self.scaled(low);
        if is_drawable(low, self.high) {
            self.low = low;
        }
        self
    }

    /// Labels a linear axis in another unit: values times `factor`, which must be positive. Curves and ends stay in theirs.
    #[must_use]
    pub fn shown_in(mut self, factor: f64) -> Self {
        if self.scale == Scale::Linear && factor.is_finite() && factor > 0.0 {
            self.shown = factor;
        }
        self
    }

    /// Moves each end of a linear axis out to the next round number, where that is no farther away than this part of the range: 0 and the
    /// end of a record then have their ticks.
    #[must_use]
    pub fn out_to_round(mut self, part: f64) -> Self {
        let ticks = Ticks::linear(self.shown * self.low, self.shown * self.high, ROUND_NUMBERS).major;
        let (Scale::Linear, [first, second, ..]) = (self.scale, ticks.as_slice()) else { return self };
        let step = (second.0 - first.0) / self.shown;
        let (low, high) = ((self.low / step).floor() * step, (self.high / step).ceil() * step);
        let most = part * (self.high - self.low);
        if self.low - low <= most {
            self.low = low;
        }
        if high - self.high <= most {
            self.high = high;
        }
        self
    }

    /// The ends of the axis, ascending.
    #[must_use]
    pub fn ends(&self) -> (f64, f64) {
        match self.scale {
            Scale::Linear => (self.low, self.high),
            Scale::Logarithmic => (10f64.powf(self.low), 10f64.powf(self.high)),
        }
    }

    /// The distance of a value from the low end of an axis of this length.
    pub(crate) fn above_low(&self, x: f64, length: f64) -> f64 {
        length * (self.scaled(x) - self.low) / (self.high - self.low)
    }

    /// The distance of a value from the high end of an axis of this length.
    pub(crate) fn below_high(&self, x: f64, length: f64) -> f64 {
        length * (self.high - self.scaled(x)) / (self.high - self.low)
    }

    /// Whether a value is within the axis, up to rounding.
    pub(crate) fn contains(&self, x: f64) -> bool {
        let (x, slack) = (self.scaled(x), 1e-9 * (self.high - self.low));
        (self.low - slack..=self.high + slack).contains(&x)
    }

    pub(crate) fn is_logarithmic(&self) -> bool {
        self.scale == Scale::Logarithmic
    }

    /// About `count` round numbers on the axis.
    pub(crate) fn ticks(&self, count: usize) -> Ticks {
        match self.scale {
            Scale::Linear => {
                let mut ticks = Ticks::linear(self.shown * self.low, self.shown * self.high, count);
                if self.shown != 1.0 {
                    ticks.major.iter_mut().for_each(|(at, _)| *at /= self.shown);
                }
                ticks
            }
            Scale::Logarithmic => Ticks::logarithmic(self.low, self.high),
        }
    }

    /// NaN or infinite for a value that isn't on the axis.
    fn scaled(&self, x: f64) -> f64 {
        match self.scale {
            Scale::Linear => x,
            Scale::Logarithmic => x.log10(),
        }
    }
}

/// Whether the range is wide enough and its width finite.
fn is_drawable(low: f64, high: f64) -> bool {
    let width = high - low;
    width.is_finite() && width > f64::MIN_POSITIVE.max(NARROWEST * low.abs().max(high.abs()))
}

/// Least and largest value, if there are any.
fn extent(label: &str, values: impl IntoIterator<Item = f64>) -> Result<Option<(f64, f64)>, AxisError> {
    let mut ends = None;
    for value in values {
        if !value.is_finite() {
            return Err(AxisError::NotFinite { axis: label.to_owned(), value });
        }
        let (low, high) = ends.unwrap_or((value, value));
        ends = Some((value.min(low), value.max(high)));
    }
    Ok(ends)
}

/// Rounds a number down to one of 1, 2, 5, 10 …, with both given by their logarithms. A number
/// equal to one of them up to rounding is kept.
fn round_down(power: f64) -> f64 {
    let decade = power.floor();
    let beside = power - decade + 1e-9;
    let step = [1.0, 5f64.log10(), 2f64.log10()].into_iter().find(|step| *step <= beside);
    decade + step.unwrap_or(0.0)
}

/// The same upwards, as the reciprocals of 1, 2, 5, 10 … belong to the same series.
fn round_up(power: f64) -> f64 {
    -round_down(-power)
}

/// The range of the finite values with a margin, at least `least` wide; never empty.
fn range_around(values: impl Iterator<Item = f64>, least: f64) -> (f64, f64) {
    let finite = values.filter(|x| x.is_finite()).map(|x| x.clamp(-LARGEST, LARGEST));
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        return (-1.0, 1.0);
    }
    let largest = low.abs().max(high.abs());
    let least = if high - low > CONSTANT * largest { least } else { least.max(2.0 * ROOM_OF_CONSTANT * largest) };
    let room = 0.06 * (high - low) + 0.5 * (least - (high - low)).max(0.0);
    // The range of 0 alone, and of numbers too small to be told apart from it.
    let room = if room > f64::MIN_POSITIVE { room } else { 1.0 };
    (low - room, high + room)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_around_values_is_never_empty() {
        let mut sets = vec![vec![], vec![f64::NAN], vec![f64::MIN, f64::MAX], vec![-1.0, 1.0], vec![0.0, 5e-324]];
        sets.extend((-300..=308).step_by(4).flat_map(|power| {
            let x = 10f64.powi(power);
            [vec![x], vec![-x, -x], vec![x, x * (1.0 + f64::EPSILON)], vec![x, 2.0 * x]]
        }));
        for values in sets {
            for least in [0.0, 1e-3] {
                let axis = Axis::around("x", values.iter().copied(), least);
                let (low, high) = axis.ends();
                assert!(low < high && (high - low).is_finite(), "{values:?}: {low} {high}");
                let inside = |x: &f64| !x.is_finite() || (low..=high).contains(&x.clamp(-LARGEST, LARGEST));
                assert!(values.iter().all(inside), "{values:?}: {low} {high}");
                assert!((1..=12).contains(&axis.ticks(6).major.len()), "{values:?}: {:?}", axis.ticks(6));
            }
        }
    }

    #[test]
    fn ends_near_round_numbers_go_out_to_them() {
        let of = |low, high| Axis::between("t", low, high).out_to_round(0.05).ends();
        assert_eq!(of(0.0028, 0.4988), (0.0, 0.5));
        assert_eq!(of(0.0, 0.5), (0.0, 0.5));
        assert_eq!(of(-0.06, 0.46), (-0.06, 0.46), "no farther than a twentieth");
        assert_eq!(
            Axis::logarithmic_between("T", 0.02, 9.0).out_to_round(0.05).ends(),
            Axis::logarithmic_between("T", 0.02, 9.0).ends()
        );
    }

    #[test]
    fn invalid_ends_give_an_axis_around_them() {
        assert_eq!(Axis::between("x", 2.0, 3.0).ends(), (2.0, 3.0));
        for ends in [(1.0, 1.0), (3.0, 2.0), (0.0, 5e-324), (f64::NAN, 1.0), (f64::MIN, f64::MAX), (1e9, 1e9 + 1e-6)] {
            let axis = Axis::between("x", ends.0, ends.1);
            let (low, high) = axis.ends();
            assert!(low < high && (high - low).is_finite(), "{ends:?}: {low} {high}");
            assert!((1..=12).contains(&axis.ticks(6).major.len()), "{ends:?}: {:?}", axis.ticks(6));
        }
    }

    #[test]
    fn a_linear_axis_starts_at_zero_where_that_is_near() {
        let ends = |values: &[f64]| Axis::linear("x", values.iter().copied()).unwrap().ends();
        assert_eq!(ends(&[1.0, 3.0]), (0.0, 3.1));
        assert_eq!(ends(&[2.0, 3.0]), (1.95, 3.05));
        assert_eq!(ends(&[-1.0, 1.0]), (-1.1, 1.1));
        assert_eq!(ends(&[]), (0.0, 1.05));
        assert_eq!(ends(&[4.0]), (3.6, 4.4));
        let refused = Axis::linear("x", [0.0, f64::INFINITY]);
        assert_eq!(refused, Err(AxisError::NotFinite { axis: "x".to_owned(), value: f64::INFINITY }));
    }

    #[test]
    fn a_logarithmic_axis_ends_at_round_numbers() {
        let ends = |values: &[f64]| {
            let (low, high) = Axis::logarithmic("x", values.iter().copied()).unwrap().ends();
            // Without the rounding of the logarithm.
            [low, high].map(|x| format!("{x:.6e}").parse::<f64>().unwrap())
        };
        assert_eq!(ends(&[0.3, 40.0]), [0.2, 50.0]);
        assert_eq!(ends(&[1e-5, 1e-3]), [5e-6, 2e-3]);
        assert_eq!(ends(&[6.0, 11.0]), [2.0, 20.0]);
        assert_eq!(ends(&[2.0, 2.0]), [1.0, 5.0]);
        assert_eq!(ends(&[]), [1.0, 10.0]);
        assert_eq!(ends(&[5e-324, f64::MAX]), [1e-300, 1e300]);
        for value in [0.0, -1.0] {
            let refused = Axis::logarithmic("x", [1.0, value]);
            assert_eq!(refused, Err(AxisError::NotPositive { axis: "x".to_owned(), value }));
        }
        assert!(matches!(Axis::logarithmic("x", [f64::NAN]), Err(AxisError::NotFinite { .. })));
    }

    #[test]
    fn round_numbers_are_kept() {
        for x in [1e-5, 2e-5 * (1.0 - 1e-15), 5e4 * (1.0 + 1e-15), 1.0] {
            let power = f64::log10(x);
            assert!((round_down(power) - power).abs() < 1e-9 && (round_up(power) - power).abs() < 1e-9, "{x}");
        }
        assert_eq!((round_down(7f64.log10()), round_up(7f64.log10())), (5f64.log10(), 1.0));
    }

    #[test]
    fn given_ends_of_a_logarithmic_axis_are_kept_if_they_are_a_range() {
        let (low, high) = Axis::logarithmic_between("x", 0.3, 70.0).ends();
        assert!((low / 0.3 - 1.0).abs() < 1e-12 && (high / 70.0 - 1.0).abs() < 1e-12);
        for (low, high) in [(2.0, 2.0), (-1.0, 3.0), (5.0, 1.0), (f64::NAN, 1.0)] {
            assert_eq!(Axis::logarithmic_between("x", low, high).ends(), (1.0, 10.0));
        }
        let (low, high) = Axis::logarithmic_between("x", 0.0, f64::INFINITY).ends();
        assert!(low > 0.0 && high.is_finite());
    }

    #[test]
    fn positions_on_a_logarithmic_axis() {
        let axis = Axis::logarithmic("x", [0.3, 80.0]).unwrap().starting_at(0.1);
        let (above, below) = (axis.above_low(1.0, 300.0), axis.below_high(1.0, 300.0));
        assert!((above - 100.0).abs() < 1e-9 && (below - 200.0).abs() < 1e-9, "{above} {below}");
        assert!(
            axis.contains(0.1)
                && axis.contains(100.0)
                && !axis.contains(0.09)
                && !axis.contains(0.0)
                && !axis.contains(-1.0)
        );
    }

    #[test]
    fn an_invalid_low_end_is_ignored() {
        let axis = Axis::logarithmic("x", [0.3, 80.0]).unwrap();
        assert!([0.0, -1.0, f64::NAN, 100.0, 1e9].into_iter().all(|low| axis.clone().starting_at(low) == axis));
        assert_eq!(Axis::between("x", 1.0, 2.0).starting_at(0.0).ends(), (0.0, 2.0));
    }
}
