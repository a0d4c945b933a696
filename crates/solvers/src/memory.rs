//! Vectors kept from solve to solve.

/// Reserves memory for exactly `n` entries in total.
pub(crate) fn reserve<T>(x: &mut Vec<T>, n: usize) {
    x.reserve(n.saturating_sub(x.len()));
}

/// Fills a vector with `n` copies of `value`.
pub(crate) fn refill<T: Clone>(x: &mut Vec<T>, n: usize, value: T) {
    x.clear();
    x.resize(n, value);
}
