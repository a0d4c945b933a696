//! Orders of convergence.

/// error ≈ factor · stepᵒʳᵈᵉʳ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PowerLaw {
    /// The exponent.
    pub(crate) order: f64,
    /// The factor.
    pub(crate) factor: f64,
}

impl PowerLaw {
    /// Its value.
    pub(crate) fn at(&self, step: f64) -> f64 {
        self.factor * step.powf(self.order)
    }
}

/// The least-squares line through (ln step, ln error). NaN for fewer than two different steps, or an error of zero.
pub(crate) fn power_law(points: &[(f64, f64)]) -> PowerLaw {
    let n = points.len() as f64;
    let logs = || points.iter().map(|&(x, y)| (x.ln(), y.ln()));
    let (mean_x, mean_y) = logs().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (xx, xy) = logs()
        .fold((0.0, 0.0), |(xx, xy), (x, y)| (xx + (x - mean_x) * (x - mean_x), xy + (x - mean_x) * (y - mean_y)));
    let order = xy / xx;
    PowerLaw { order, factor: (mean_y - order * mean_x).exp() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_found_again() {
        let points: Vec<(f64, f64)> = (1..9).map(f64::from).map(|x| (x, 3.0 * x.powf(1.5))).collect();
        let law = power_law(&points);
        assert!((law.order - 1.5).abs() < 1e-14 && (law.factor - 3.0).abs() < 1e-13);
        assert!((law.at(4.0) - 24.0).abs() < 1e-12);
    }

    #[test]
    fn the_line_is_that_of_least_squares() {
        // Residuals +1, −2, +1 in ln error about slope 2: orthogonal to the line, so the slope stays.
        let points = [(0.0, 1.0), (1.0, 0.0), (2.0, 5.0)].map(|(x, y): (f64, f64)| (x.exp(), y.exp()));
        assert!((power_law(&points).order - 2.0).abs() < 1e-14);
    }

    #[test]
    fn one_point_has_no_order() {
        assert!(power_law(&[(1.0, 1.0)]).order.is_nan());
    }
}
