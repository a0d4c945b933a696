//! Substitution with a Cholesky factor of half bandwidth three.
//!
//! The factorisation is faer's. Its sparse substitution, made for any pattern, spends its time in divisions and indices:
//! the same numbers as unit columns and reciprocal pivots, four to a column, take less than half of that.

/// L D Lᵀ by columns: `[1/d, l₁, l₂, l₃]`, the l below the unit diagonal, 0 where the band ends.
#[derive(Debug, Clone)]
pub(crate) struct Band(Vec<[f64; 4]>);

impl Band {
    pub(crate) fn new(dofs: usize) -> Self {
        Self(vec![[f64::NAN; 4]; dofs])
    }

    pub(crate) fn dofs(&self) -> usize {
        self.0.len()
    }

    /// Takes over a Cholesky factor L Lᵀ, its lower columns one after another in `values`, none longer than four.
    pub(crate) fn fill(&mut self, column_start: &[usize], values: &[f64]) {
        for (j, packed) in self.0.iter_mut().enumerate() {
            let column = &values[column_start[j]..column_start[j + 1]];
            let reciprocal = 1.0 / column[0];
            *packed = [reciprocal * reciprocal, 0.0, 0.0, 0.0];
            for (l, value) in packed[1..].iter_mut().zip(&column[1..]) {
                *l = value * reciprocal;
            }
        }
    }

    /// Makes every solution NaN.
    pub(crate) fn invalidate(&mut self) {
        self.0.fill([f64::NAN; 4]);
    }

    /// f ← (L D Lᵀ)⁻¹ f.
    pub(crate) fn solve(&self, f: &mut [f64]) {
        // What earlier columns take from this row and the next two. The latest column is kept apart, so that only one
        // product and one difference stand between an unknown and the next.
        let (mut latest, mut this, mut next, mut after) = (0.0, 0.0, 0.0, 0.0);
        for (x, [_, l1, l2, l3]) in f.iter_mut().zip(&self.0) {
            *x = (*x - this) - latest;
            latest = l1 * *x;
            (this, next, after) = (next, after + l2 * *x, l3 * *x);
        }
        let (mut x1, mut x2, mut x3) = (0.0, 0.0, 0.0);
        for (x, [reciprocal, l1, l2, l3]) in f.iter_mut().zip(&self.0).rev() {
            *x = (*x * reciprocal - (l3 * x3 + l2 * x2)) - l1 * x1;
            (x1, x2, x3) = (*x, x1, x2);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn substitution_undoes_a_product_with_the_factor() {
        // Lower columns of L, the band cut off at the end; A = L Lᵀ.
        let columns: [&[f64]; 5] =
            [&[2.0, 0.5, -1.0, 0.25], &[1.5, -0.3, 0.7, 0.2], &[3.0, 1.0, -0.5], &[0.5, 0.1], &[4.0]];
        let mut start = vec![0];
        for column in columns {
            start.push(start[start.len() - 1] + column.len());
        }
        let mut band = Band::new(5);
        band.fill(&start, &columns.concat());
        let x = [1.0, -2.0, 0.5, 3.0, -0.75];
        let mut upper_x = [0.0; 5];
        for j in 0..5 {
            upper_x[j] = columns[j].iter().zip(&x[j..]).map(|(l, x)| l * x).sum();
        }
        let mut f = [0.0; 5];
        for j in 0..5 {
            columns[j].iter().zip(&mut f[j..]).for_each(|(l, f)| *f += l * upper_x[j]);
        }
        band.solve(&mut f);
        assert!(f.iter().zip(&x).all(|(f, x)| (f - x).abs() < 1e-14), "{f:?}");
    }
}
