//! Columns of numbers on the page: whole multiples of a unit that is finer than a reader sees, packed as their differences.

use crate::page::packed::Packed;
use crate::page::rounded;
use serde::Serialize;

/// Numbers in a row; what isn't finite is null.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(super) enum Column {
    /// So few that packing saves nothing.
    Plain(Vec<f64>),
    /// Whole multiples of `unit`: differences from the one before, or with `order` 2 differences of these, before which all are
    /// 0. Each is sent as 1, 2, 3, 4 … for 0, −1, 1, −2 …; 0 is null, which differences pass over.
    Packed { unit: f64, order: u8, packed: String },
}

/// Fewer numbers are sent as they are.
const FEW: usize = 12;

/// A curve that varies by a smaller part of its size is constant: less is rounding, which digits would only show.
const CONSTANT: f64 = 1e-9;

/// Steps into which the range of a curve is divided: finer than a plot and its readout show.
pub(super) const SEEN: f64 = 1e5;

/// The same for curves whose peaks may be cut.
pub(super) const SEEN_BELOW_PEAKS: f64 = 1e6;

impl Column {
    /// The values of a curve, with so many steps between its least and its largest that its course is seen, however far from zero it
    /// is.
    pub(super) fn of(values: &[f64], steps: f64) -> Self {
        let (low, high) = ends(values);
        let size = low.abs().max(high.abs());
        let range = high - low;
        Self::in_units(values, if range > CONSTANT * size { range / steps } else { 1e-7 * size })
    }

    /// Coordinates of a pose, m or rad, which the page tells to a millionth.
    pub(super) fn of_pose(values: &[f64]) -> Self {
        let (low, high) = ends(values);
        let range = high - low;
        Self::in_units(values, if range > CONSTANT * low.abs().max(high.abs()) { 1e-6 * range.min(1.0) } else { 1e-6 })
    }

    /// Whole numbers.
    pub(super) fn counts(values: &[f64]) -> Self {
        Self::in_units(values, 1.0)
    }

    fn in_units(values: &[f64], unit: f64) -> Self {
        let unit = rounded(unit, 3);
        let unit = if unit > 0.0 && unit.is_finite() { unit } else { 1.0 };
        // Beyond this whole numbers have no place in a double.
        let fits = |x: &f64| !x.is_finite() || (x / unit).abs() < 1e15;
        if values.len() < FEW || !values.iter().all(fits) {
            // With so many digits that the unit is among them, however far from zero the values are.
            let (low, high) = ends(values);
            let digits = (low.abs().max(high.abs()) / unit).log10().ceil().clamp(0.0, 16.0) as usize + 1;
            return Self::Plain(values.iter().map(|x| rounded(*x, digits.max(super::DIGITS))).collect());
        }
        let [first, second] = [false, true].map(|second| packed(values, unit, second));
        let (order, packed) = if second.len() < first.len() { (2, second) } else { (1, first) };
        Self::Packed { unit, order, packed }
    }
}

/// The least and the largest of the finite values; 0 without any.
fn ends(values: &[f64]) -> (f64, f64) {
    let finite = values.iter().filter(|x| x.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &x| (a.min(x), b.max(x)));
    if low <= high { (low, high) } else { (0.0, 0.0) }
}

fn packed(values: &[f64], unit: f64, second: bool) -> String {
    let mut packed = Packed::default();
    let mut before = [0_i64; 2];
    for x in values {
        if !x.is_finite() {
            packed.push(0);
            continue;
        }
        let now = (x / unit).round() as i64;
        let expected = if second { 2 * before[1] - before[0] } else { before[1] };
        packed.push_after_null(now - expected);
        before = [before[1], now];
    }
    packed.text()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::packed::tests::unpacked;

    /// The values again, as the page's script has them.
    fn read(column: &Column) -> Vec<f64> {
        let Column::Packed { unit, order, packed } = column else { panic!("plain") };
        let mut before = [0_i64; 2];
        let numbers = unpacked(packed).into_iter().map(|n| {
            let Some(n) = n.checked_sub(1) else { return f64::NAN };
            let difference = if n % 2 == 1 { -((n / 2) as i64) - 1 } else { (n / 2) as i64 };
            let now = difference + if *order == 2 { 2 * before[1] - before[0] } else { before[1] };
            before = [before[1], now];
            now as f64 * unit
        });
        numbers.collect()
    }

    #[test]
    fn a_curve_is_read_back_to_the_step_in_which_it_is_seen() {
        let smooth = |k: u32| 1234.5 + 1e-3 * (f64::from(k) / 40.0).sin();
        let noisy = |k: u32| f64::from(k.wrapping_mul(2_654_435_761) % 1000) - 500.0;
        for (values, range) in [((0..500).map(smooth).collect::<Vec<_>>(), 2e-3), ((0..500).map(noisy).collect(), 1e3)]
        {
            let found = read(&Column::of(&values, SEEN));
            assert_eq!(found.len(), values.len());
            assert!(found.iter().zip(&values).all(|(a, b)| (a - b).abs() <= 0.51 * range / SEEN));
        }
        let poses: Vec<f64> = (0..100).map(|k| 20.0 * (f64::from(k) / 9.0).cos()).collect();
        assert!(read(&Column::of_pose(&poses)).iter().zip(&poses).all(|(a, b)| (a - b).abs() <= 0.51e-6));
    }

    #[test]
    fn smooth_curves_take_second_differences_and_fewer_letters() {
        let values: Vec<f64> = (0..1000).map(|k| (f64::from(k) / 100.0).sin()).collect();
        let Column::Packed { order, packed, .. } = Column::of(&values, SEEN) else { panic!("plain") };
        assert!(order == 2 && packed.len() < 1400, "{order} {}", packed.len());
    }

    #[test]
    fn gaps_constants_and_extremes_are_kept() {
        let mut values = vec![2.5; 20];
        values[7] = f64::NAN;
        let found = read(&Column::of(&values, SEEN));
        assert!(found[7].is_nan() && found.iter().filter(|x| (**x - 2.5).abs() < 1e-6).count() == 19, "{found:?}");
        assert_eq!(read(&Column::of(&[0.0; 20], SEEN)), [0.0; 20]);
        assert!(read(&Column::of(&[f64::NAN; 20], SEEN)).iter().all(|x| x.is_nan()));
        // Too far for whole numbers of this unit.
        let mut far = vec![0.0; 20];
        far[3] = 1e300;
        assert!(matches!(Column::of_pose(&far), Column::Plain(_)));
        // A few values far from zero keep their course.
        let Column::Plain(few) = Column::of(&[1_234.5, 1_234.500_03], SEEN) else { panic!("packed") };
        assert!((few[1] - few[0] - 3e-5).abs() < 1e-9, "{few:?}");
    }
}
