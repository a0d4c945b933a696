//! Signals by a table, linear between its rows.

use super::window::{self, Moments, Pieces};
use super::{Signal, SignalError, from_zero};

/// A time history by rows (time, value): linear between them, the first value before and the last
/// value after, or 0 ([`Table::zero_outside`]).
///
/// ```
/// use teeter_integrator::{Signal, Table};
///
/// let table = Table::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 2.0])?;
/// assert_eq!([0.5, 2.0, 9.0].map(|t| table.value(t)), [1.0, 2.0, 2.0]);
/// assert_eq!(table.integral(2.0), 3.0);
/// assert!(Table::new(vec![0.0, 0.0], vec![1.0, 2.0]).is_err());
/// # Ok::<(), teeter_integrator::SignalError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    times: Vec<f64>,
    values: Vec<f64>,
    /// The integral from the first row to each row, and the integral of that.
    once: Vec<f64>,
    twice: Vec<f64>,
    /// Whether it is 0 before the first row and from the last on.
    zero_outside: bool,
}

impl Table {
    /// The history with these rows; times in s.
    ///
    /// # Errors
    /// If there are fewer than two rows, if a number is not finite, or if a time is not later than
    /// the one before.
    pub fn new(times: Vec<f64>, values: Vec<f64>) -> Result<Self, SignalError> {
        if times.len() != values.len() {
            return Err(SignalError::Lengths { times: times.len(), values: values.len() });
        }
        if times.len() < 2 {
            return Err(SignalError::Rows(times.len()));
        }
        let mut before = None;
        for (index, (t, value)) in times.iter().zip(&values).enumerate() {
            let row = |what| Err(SignalError::Row { row: index + 1, what });
            if !t.is_finite() {
                return row(format!("the time is {t}, but must be finite"));
            }
            if !value.is_finite() {
                return row(format!("the value is {value}, but must be finite"));
            }
            if let Some(before) = before.filter(|before| before >= t) {
                return row(format!("the time {t} s is not later than {before} s of the row before"));
            }
            before = Some(*t);
        }
        let (mut once, mut twice) = (vec![0.0], vec![0.0]);
        let (mut first, mut second) = (0.0, 0.0);
        for (t, y) in times.windows(2).zip(values.windows(2)) {
            let h = t[1] - t[0];
            second += h * first + h * h * (2.0 * y[0] + y[1]) / 6.0;
            first += 0.5 * h * (y[0] + y[1]);
            once.push(first);
            twice.push(second);
        }
        Ok(Self { times, values, once, twice, zero_outside: false })
    }

    /// The same, but 0 before the first row and from the last on: it jumps where their values aren't.
    #[must_use]
    pub fn zero_outside(self) -> Self {
        Self { zero_outside: true, ..self }
    }

    /// Whether it is 0 before the first row and from the last on.
    #[must_use]
    pub fn is_zero_outside(&self) -> bool {
        self.zero_outside
    }

    /// Its first and last row, (time, value).
    #[must_use]
    pub fn ends(&self) -> [(f64, f64); 2] {
        // There are two rows or more.
        let row = |k: usize| (self.times[k], self.values[k]);
        [row(0), row(self.times.len() - 1)]
    }

    /// Its rows, (time, value).
    pub fn rows(&self) -> impl Iterator<Item = (f64, f64)> {
        self.times.iter().copied().zip(self.values.iter().copied())
    }

    /// The row at which the piece with `t` starts, the time since then, and value and slope of the piece
    /// at its start.
    fn piece(&self, t: f64) -> (usize, f64, [f64; 2]) {
        let after = self.times.partition_point(|row| *row <= t);
        let row = after.saturating_sub(1);
        let line = if after > 0 && after < self.times.len() {
            [self.values[row], (self.values[after] - self.values[row]) / (self.times[after] - self.times[row])]
        } else {
            [if self.zero_outside { 0.0 } else { self.values[row] }, 0.0]
        };
        (row, t - self.times[row], line)
    }

    /// Calls `each` for the linear pieces of [from, to], with times and values at their ends.
    fn pieces(&self, from: f64, to: f64, mut each: impl FnMut([f64; 2], [f64; 2])) {
        let mut after = self.times.partition_point(|row| *row <= from);
        let mut begin = from;
        let last = self.times.len() - 1;
        loop {
            let end = self.times.get(after).map_or(to, |row| row.min(to));
            let value = |t: f64| match after {
                _ if self.zero_outside && (after == 0 || after > last) => 0.0,
                0 => self.values[0],
                _ if after > last => self.values[last],
                _ => {
                    let (t0, y0) = (self.times[after - 1], self.values[after - 1]);
                    y0 + (self.values[after] - y0) / (self.times[after] - t0) * (t - t0)
                }
            };
            each([begin, end], [value(begin), value(end)]);
            if end >= to {
                return;
            }
            (begin, after) = (end, after + 1);
        }
    }

    fn antiderivatives(&self, t: f64) -> (f64, f64) {
        let (row, tau, [y, slope]) = self.piece(t);
        let once = self.once[row];
        (once + tau * (y + 0.5 * slope * tau), self.twice[row] + tau * (once + tau * (0.5 * y + slope * tau / 6.0)))
    }
}

impl Signal for Table {
    fn value(&self, t: f64) -> f64 {
        let (_, tau, [y, slope]) = self.piece(t);
        y + slope * tau
    }

    fn rate(&self, t: f64) -> f64 {
        self.piece(t).2[1]
    }

    fn next_break(&self, t: f64) -> f64 {
        self.times.get(self.times.partition_point(|row| *row <= t)).copied().unwrap_or(f64::INFINITY)
    }

    fn jump(&self) -> Option<f64> {
        let jumps = |(t, value): &(f64, f64)| self.zero_outside && *t > 0.0 && *value != 0.0;
        self.ends().into_iter().find(jumps).map(|(t, _)| t)
    }

    fn second_rate(&self, _: f64) -> f64 {
        0.0
    }

    fn integral(&self, t: f64) -> f64 {
        from_zero(t, |t| self.antiderivatives(t)).0
    }

    fn double_integral(&self, t: f64) -> f64 {
        from_zero(t, |t| self.antiderivatives(t)).1
    }

    fn mean(&self, from: f64, to: f64) -> f64 {
        let mut sum = 0.0;
        self.pieces(from, to, |[a, b], [first, last]| sum += (b - a) / (to - from) * (0.5 * (first + last)));
        sum
    }

    fn mean_rate(&self, from: f64, to: f64) -> f64 {
        let (first, last) = (self.piece(from), self.piece(to));
        // Within a single piece avoid the rounding of a difference.
        if first.0 == last.0 && first.2 == last.2 {
            return first.2[1];
        }
        (self.value(to) - self.value(from)) / (to - from)
    }

    fn mean_integral(&self, from: f64, to: f64) -> f64 {
        let moments = self.moments(from, to);
        self.integral(from) + 0.5 * (to - from) * (moments[0] - moments[1])
    }

    fn moments(&self, from: f64, to: f64) -> Moments {
        let mut pieces = Pieces::over(from, to);
        self.pieces(from, to, |[a, b], [first, last]| pieces.add(a, b, &window::of_line(first, last)));
        pieces.moments()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::check;
    use super::*;

    #[test]
    fn integrals_and_rates_are_those_of_the_value() {
        for start in [-1.0, 0.0, 0.4] {
            let times = vec![start, start + 0.3, start + 0.35, start + 1.3];
            check(&Table::new(times.clone(), vec![0.2, -1.0, 3.0, 0.5]).unwrap(), &times, 3.0);
        }
    }

    #[test]
    fn outside_it_is_zero_if_asked_for() {
        let values = vec![0.2, -1.0, 3.0, 0.5];
        for start in [-1.0, 0.0, 0.4] {
            let times = vec![start, start + 0.3, start + 0.35, start + 1.3];
            let table = Table::new(times.clone(), values.clone()).unwrap();
            assert_eq!((table.value(9.0), table.jump()), (0.5, None));
            let table = table.zero_outside();
            check(&table, &times, 3.0);
            assert_eq!([start - 0.1, start, start + 1.3].map(|t| table.value(t)), [0.0, 0.2, 0.0]);
            assert_eq!(table.jump(), Some(if start > 0.0 { start } else { start + 1.3 }));
            // Over the whole: the area of the rows.
            let area = 0.3 * -0.4 + 0.05 * 1.0 + 0.95 * 1.75;
            assert!((table.mean(start - 1.0, start + 3.0) * 4.0 - area).abs() < 1e-15);
        }
        let closed = Table::new(vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 0.0]).unwrap().zero_outside();
        assert_eq!(closed.jump(), None);
    }

    #[test]
    fn a_fine_table_is_the_formula() {
        let sine = crate::Formula::one_sine(0.0, 2.0, 0.0).unwrap();
        let times: Vec<f64> = (0..=2000).map(|k| f64::from(k) * 2.5e-4).collect();
        let table = Table::new(times.clone(), times.iter().map(|t| sine.value(*t)).collect()).unwrap();
        // Between rows it is too low by at most ω²h²/8, its integral by a fraction ω²h²/12.
        let low = (4.0 * std::f64::consts::PI * 2.5e-4_f64).powi(2);
        for t in [0.1, 0.3, 0.45] {
            assert!((table.value(t + 1e-4) - sine.value(t + 1e-4)).abs() < low / 8.0);
            assert!((table.integral(t) / sine.integral(t) - 1.0 + low / 12.0).abs() < 1e-11);
            assert!((table.double_integral(t) / sine.double_integral(t) - 1.0 + low / 12.0).abs() < 1e-8);
        }
    }

    #[test]
    fn bad_rows_are_named() {
        let text = |times: &[f64], values: &[f64]| Table::new(times.to_vec(), values.to_vec()).unwrap_err().to_string();
        assert_eq!(text(&[0.0], &[1.0]), "1 rows, but a table needs two or more");
        assert_eq!(text(&[0.0, 1.0], &[1.0]), "2 times, but 1 values");
        assert_eq!(text(&[0.0, 1.0], &[1.0, f64::NAN]), "row 2: the value is NaN, but must be finite");
        assert_eq!(text(&[0.0, 1.0, 0.5], &[0.0; 3]), "row 3: the time 0.5 s is not later than 1 s of the row before");
    }
}
