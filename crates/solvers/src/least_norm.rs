//! Least-norm solution of small linear systems, including singular ones.

/// Number of unknowns of a small problem: a normal and a tangential impulse for each of three
/// contacts.
pub(crate) const MAX: usize = 2 * crate::enumeration::TREE_CONTACTS;

/// A pivot below this, relative to the compliances of its row and column, counts as zero.
/// Hyperstatic contacts leave pivots of about 1e-16, two corners on a beam with the slope w' at
/// least w'².
pub(crate) const RANK_TOLERANCE: f64 = 1e-12;

/// A square system `a x = b` of order `m` ≤ `M`.
pub(crate) struct System<const M: usize = MAX> {
    m: usize,
    pub(crate) a: [[f64; M]; M],
    pub(crate) b: [f64; M],
    /// Scales of rows and columns: pivots are compared with `scale[r] scale[c]`.
    pub(crate) scale: [f64; M],
    /// Weights of the norm, which is that of `length[k] x[k]`.
    pub(crate) length: [f64; M],
}

impl<const M: usize> System<M> {
    pub(crate) fn new(m: usize) -> Self {
        Self { m, a: [[0.0; M]; M], b: [0.0; M], scale: [1.0; M], length: [1.0; M] }
    }

    /// The solution of least norm, by Gaussian elimination with complete pivoting; `None` if a
    /// number overflows. Whether a singular system was consistent, the caller must check by the
    /// residual.
    pub(crate) fn solve(mut self) -> Option<[f64; M]> {
        let m = self.m;
        let mut column: [usize; M] = std::array::from_fn(|k| k);
        let mut row_scale = self.scale;
        let mut rank = m;
        for k in 0..m {
            let (mut best, mut at) = (0.0, (k, k));
            for r in k..m {
                for c in k..m {
                    let size = self.a[r][column[c]].abs() / (row_scale[r] * self.scale[column[c]]);
                    if size > best {
                        (best, at) = (size, (r, c));
                    }
                }
            }
            if best <= RANK_TOLERANCE {
                rank = k;
                break;
            }
            self.a.swap(k, at.0);
            self.b.swap(k, at.0);
            row_scale.swap(k, at.0);
            column.swap(k, at.1);
            let pivot = self.a[k];
            for r in k + 1..m {
                let factor = self.a[r][column[k]] / pivot[column[k]];
                if factor != 0.0 {
                    for c in k + 1..m {
                        self.a[r][column[c]] -= factor * pivot[column[c]];
                    }
                    self.b[r] -= factor * self.b[k];
                }
            }
        }
        // Back substitution with the free unknowns at zero …
        let mut solution = self.back_substitute(rank, &column, &self.b);
        // … then remove the part in the null space, so that the norm is least.
        let mut basis = [[0.0; M]; M];
        for free in rank..m {
            let mut b = [0.0; M];
            for r in 0..rank {
                b[r] = -self.a[r][column[free]];
            }
            let mut null = self.back_substitute(rank, &column, &b);
            null[column[free]] = 1.0;
            for earlier in &basis[..free - rank] {
                self.subtract_projection(&mut null, earlier);
            }
            let norm = self.inner(&null, &null).sqrt();
            null.iter_mut().for_each(|c| *c /= norm);
            self.subtract_projection(&mut solution, &null);
            basis[free - rank] = null;
        }
        solution.iter().all(|c| c.is_finite()).then_some(solution)
    }

    fn back_substitute(&self, rank: usize, column: &[usize; M], b: &[f64; M]) -> [f64; M] {
        let mut x = [0.0; M];
        for r in (0..rank).rev() {
            let mut sum = b[r];
            for c in r + 1..rank {
                sum -= self.a[r][column[c]] * x[column[c]];
            }
            x[column[r]] = sum / self.a[r][column[r]];
        }
        x
    }

    fn inner(&self, x: &[f64; M], y: &[f64; M]) -> f64 {
        (0..self.m).map(|k| self.length[k] * self.length[k] * x[k] * y[k]).sum()
    }

    /// Removes from `x` its component along the unit vector `e`.
    fn subtract_projection(&self, x: &mut [f64; M], e: &[f64; M]) {
        let along = self.inner(x, e);
        for (a, b) in x.iter_mut().zip(e) {
            *a -= along * b;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_singular_system_gets_the_least_norm_solution() {
        // x + y = 2 twice, and z = 3.
        let mut system = System::<MAX>::new(3);
        system.a[0][0] = 1.0;
        system.a[0][1] = 1.0;
        system.a[1] = system.a[0];
        system.a[2][2] = 1.0;
        system.b = [2.0, 2.0, 3.0, 0.0, 0.0, 0.0];
        let x = system.solve().unwrap();
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 1.0).abs() < 1e-15 && x[2] == 3.0);
    }

    #[test]
    fn the_norm_is_weighted() {
        // x + y = 5 with the weight 2 for y: x = 4, y = 1 has the least norm.
        let mut system = System::<MAX>::new(2);
        system.a[0][..2].fill(1.0);
        system.a[1][..2].fill(1.0);
        system.b = [5.0, 5.0, 0.0, 0.0, 0.0, 0.0];
        system.length[1] = 2.0;
        let x = system.solve().unwrap();
        assert!((x[0] - 4.0).abs() < 1e-15 && (x[1] - 1.0).abs() < 1e-15);
    }
}
