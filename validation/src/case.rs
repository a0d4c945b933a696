//! What a case is, and what it finds.

use crate::figure::Figure;
use std::error::Error;

/// A result of this program's parts.
pub(crate) type Result<T> = std::result::Result<T, Box<dyn Error + Send + Sync>>;

/// How much of a case to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Depth {
    /// Seconds: what a continuous build can afford.
    Short,
    /// Everything.
    Full,
}

/// A case with a known answer.
pub(crate) trait Case {
    /// Its name in the table.
    fn name(&self) -> &'static str;
    /// A paragraph of Markdown: what is run, what it is compared with, and where the bounds come from.
    fn about(&self) -> &'static str;
    /// Runs it. An error counts as a missed bound.
    fn run(&self, depth: Depth) -> Result<Findings>;
}

/// What a case found.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    /// The rows of the table.
    pub(crate) checks: Vec<Check>,
    /// The figures of the page.
    pub(crate) figures: Vec<Figure>,
    /// Why the case could not run, if so.
    pub(crate) failure: Option<String>,
}

impl Findings {
    /// Of a case that could not run.
    pub(crate) fn broken(error: &(dyn Error + Send + Sync)) -> Self {
        Self { failure: Some(error.to_string()), ..Self::default() }
    }

    /// How many bounds are missed.
    pub(crate) fn missed(&self) -> usize {
        self.checks.iter().filter(|check| check.holds() == Some(false)).count()
    }
}

/// What must hold for a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Bound {
    /// |error| ≤ this.
    Error(f64),
    /// The computed number lies between these.
    Between(f64, f64),
    /// Nothing: the number is told, not judged.
    Reported,
}

/// One row of the table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Check {
    /// What was computed, with its unit.
    pub(crate) quantity: String,
    /// The known answer; `None` where the error itself is the quantity.
    pub(crate) exact: Option<f64>,
    /// The program's answer.
    pub(crate) computed: Option<f64>,
    /// The difference, absolute or relative as `quantity` says.
    pub(crate) error: Option<f64>,
    /// What must hold.
    pub(crate) bound: Bound,
}

impl Check {
    /// |computed − exact| ≤ bound.
    pub(crate) fn absolute(quantity: impl Into<String>, exact: f64, computed: f64, bound: f64) -> Self {
        Self {
            quantity: quantity.into(),
            exact: Some(exact),
            computed: Some(computed),
            error: Some((computed - exact).abs()),
            bound: Bound::Error(bound),
        }
    }

    /// |computed/exact − 1| ≤ bound.
    pub(crate) fn relative(quantity: impl Into<String>, exact: f64, computed: f64, bound: f64) -> Self {
        let error = ((computed - exact) / exact).abs();
        Self { error: Some(error), ..Self::absolute(quantity, exact, computed, bound) }
    }

    /// An error, the worst of many, that must not exceed a bound.
    pub(crate) fn worst(quantity: impl Into<String>, error: f64, bound: f64) -> Self {
        let quantity = quantity.into();
        Self { quantity, exact: None, computed: None, error: Some(error), bound: Bound::Error(bound) }
    }

    /// A number that must lie in a range around its exact value.
    pub(crate) fn between(quantity: impl Into<String>, exact: f64, computed: f64, low: f64, high: f64) -> Self {
        Self { bound: Bound::Between(low, high), ..Self::absolute(quantity, exact, computed, 0.0) }
    }

    /// A number that is told, not judged.
    pub(crate) fn reported(quantity: impl Into<String>, computed: f64) -> Self {
        let (quantity, computed) = (quantity.into(), Some(computed));
        Self { quantity, exact: None, computed, error: None, bound: Bound::Reported }
    }

    /// Whether the bound holds; `None` where there is none. Not a number never holds.
    pub(crate) fn holds(&self) -> Option<bool> {
        match self.bound {
            Bound::Error(bound) => Some(self.error.is_some_and(|error| error.abs() <= bound)),
            Bound::Between(low, high) => Some(self.computed.is_some_and(|x| low <= x && x <= high)),
            Bound::Reported => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_can_be_missed_and_nan_misses_it() {
        assert_eq!(Check::absolute("a", 1.0, 1.25, 0.25).holds(), Some(true));
        assert_eq!(Check::absolute("a", 1.0, 1.5, 0.25).holds(), Some(false));
        assert_eq!(Check::relative("a", -4.0, -5.0, 0.25).holds(), Some(true));
        assert_eq!(Check::relative("a", -4.0, -6.0, 0.25).holds(), Some(false));
        assert_eq!(Check::worst("a", f64::NAN, 1.0).holds(), Some(false));
        assert_eq!(Check::between("a", 1.0, f64::NAN, 0.0, 2.0).holds(), Some(false));
        assert_eq!(Check::between("a", 1.0, 2.5, 0.0, 2.0).holds(), Some(false));
        assert_eq!(Check::reported("a", 1.0).holds(), None);
    }
}
