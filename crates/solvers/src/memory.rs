//! Vectors that a solver keeps from solve to solve.

/// Makes room for `n` entries in all: no more than that, however full the vector is.
pub(crate) fn reserve<T>(x: &mut Vec<T>, n: usize) {
    x.reserve(n.saturating_sub(x.len()));
}

/// Sets a vector to `n` times `value`.
pub(crate) fn refill<T: Clone>(x: &mut Vec<T>, n: usize, value: T) {
    x.clear();
    x.resize(n, value);
}
