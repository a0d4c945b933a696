//! Many bodies in one plot: at each time the least, the largest, and the values below which a tenth, half
//! and nine tenths of the bodies are.

/// Columns of a band.
pub(crate) const BAND_COLUMNS: usize = 5;

/// What the columns are called.
pub(crate) const BAND_NAMES: [&str; BAND_COLUMNS] = ["least", "10 %", "median", "90 %", "largest"];

/// Memory for sorting.
#[derive(Debug, Clone, Default)]
pub(crate) struct Bands(Vec<f64>);

impl Bands {
    /// Writes the columns of these values, one a body: quantiles by the nearest rank, so each is the value of
    /// a body. NaN without values.
    pub(crate) fn fill(&mut self, values: impl Iterator<Item = f64>, out: &mut [f64]) {
        self.0.clear();
        self.0.extend(values);
        let Some(last) = self.0.len().checked_sub(1) else {
            out.fill(f64::NAN);
            return;
        };
        let mut below = 0;
        for (out, tenths) in out.iter_mut().zip([0, 1, 5, 9, 10]) {
            let rank = (tenths * last + 5) / 10;
            // What is smaller lies before, as of the rank before.
            let (_, value, _) = self.0[below..].select_nth_unstable_by(rank - below, f64::total_cmp);
            *out = *value;
            below = rank;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_sorted_values() {
        let mut out = [0.0; BAND_COLUMNS];
        // 0 to 100 in an order that isn't theirs.
        Bands::default().fill((0..101).map(|k| f64::from(37 * k % 101)), &mut out);
        assert_eq!(out, [0.0, 10.0, 50.0, 90.0, 100.0]);
        Bands::default().fill([3.0].into_iter(), &mut out);
        assert_eq!(out, [3.0; BAND_COLUMNS]);
        Bands::default().fill([2.0, -1.0].into_iter(), &mut out);
        assert_eq!((out[0], out[4]), (-1.0, 2.0));
        Bands::default().fill(std::iter::empty(), &mut out);
        assert!(out.iter().all(|x| x.is_nan()));
    }
}
