//! Sparse factors of a basis: a square matrix whose columns are exchanged one by one.
//!
//! The factorisation is left-looking, column by column, each with a search for its pattern (Gilbert
//! and Peierls 1988, doi 10.1137/0909058). The caller gives an order of the columns that fills in
//! little with pivots on the diagonal; of the rows, one of the column's own contact is taken unless
//! it is too small. Columns that depend on earlier ones, up to a given part of their largest number, are
//! replaced by unit columns of the rows that are left over, and listed: this is how the null space of
//! a singular basis is found.
//!
//! An exchange of a column multiplies the basis by an elementary matrix from the right; its inverse
//! is applied after the factors (the product form of the inverse, Dantzig and Orchard-Hays 1954,
//! doi 10.1090/S0025-5718-1954-0061469-8). After [`EXCHANGES`] of them the caller factorises again.

use crate::memory::{refill, reserve};

/// A row of the column's own contact is taken if its number is at least this part of the largest.
const PREFERRED: f64 = 0.1;
/// Largest number of exchanges between factorisations.
const EXCHANGES: usize = 50;

const NONE: u32 = u32::MAX;

/// The factors, with memory for them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Basis {
    /// Columns of L below the diagonal, as rows of the matrix; its diagonal is 1.
    lower_start: Vec<usize>,
    lower: Vec<(u32, f64)>,
    /// Columns of U above the diagonal, as the rows that were pivots.
    upper_start: Vec<usize>,
    upper: Vec<(u32, f64)>,
    /// By step: the pivot, its row, and the position of the column in the basis.
    pivot: Vec<f64>,
    row: Vec<u32>,
    position: Vec<u32>,
    /// The step in which a row was the pivot's.
    step: Vec<u32>,
    /// Exchanges: the position, its number in the direction, and the direction's other numbers.
    exchanges: Vec<(u32, f64)>,
    direction_start: Vec<usize>,
    directions: Vec<(u32, f64)>,
    /// Positions of the dependent columns, in the order in which they were met.
    dependent: Vec<u32>,
    column: Vec<(u32, f64)>,
    dense: Vec<f64>,
    /// The last step that met a row, and rows on the way of the search, with where it goes on.
    met: Vec<u32>,
    path: Vec<(u32, usize)>,
    /// Rows that are no pivots yet, and pivots' steps in the order in which the search leaves them.
    candidates: Vec<u32>,
    postorder: Vec<u32>,
}

impl Basis {
    /// Reserves memory for a basis of `n` columns; the fill-in isn't known.
    pub(crate) fn reserve(&mut self, n: usize, nonzeros: usize) {
        for x in [&mut self.lower_start, &mut self.upper_start] {
            reserve(x, n + 1);
        }
        for x in [&mut self.lower, &mut self.upper] {
            reserve(x, nonzeros);
        }
        reserve(&mut self.column, n);
        reserve(&mut self.pivot, n);
        reserve(&mut self.dense, n);
        reserve(&mut self.path, n);
        for x in [
            &mut self.row,
            &mut self.position,
            &mut self.step,
            &mut self.dependent,
            &mut self.met,
            &mut self.candidates,
            &mut self.postorder,
        ] {
            reserve(x, n);
        }
        reserve(&mut self.exchanges, EXCHANGES);
        reserve(&mut self.direction_start, EXCHANGES + 1);
    }

    /// Factorises the matrix whose column at position `s` is appended by `column(s, …)` as (row,
    /// number). `order` lists the positions; the rows 2i and 2i + 1 are column s's own, i =
    /// `owner(s)`. A column of which elimination leaves at most the part `dependent` of its largest
    /// number is replaced.
    pub(crate) fn factorise(
        &mut self,
        order: &[u32],
        dependent: f64,
        owner: impl Fn(u32) -> u32,
        mut column: impl FnMut(u32, &mut Vec<(u32, f64)>),
    ) {
        let n = order.len();
        for x in [&mut self.lower_start, &mut self.upper_start, &mut self.direction_start] {
            x.clear();
            x.push(0);
        }
        self.lower.clear();
        self.upper.clear();
        for x in [&mut self.row, &mut self.position, &mut self.dependent] {
            x.clear();
        }
        self.pivot.clear();
        self.exchanges.clear();
        self.directions.clear();
        refill(&mut self.step, n, NONE);
        refill(&mut self.met, n, NONE);
        refill(&mut self.dense, n, 0.0);
        for (k, &at) in order.iter().enumerate() {
            self.column.clear();
            column(at, &mut self.column);
            let scale = self.eliminate(k as u32);
            self.take_pivot(at, owner(at), dependent * scale);
        }
        // Each dependent column gives its place to a row that is left over.
        let mut free = 0;
        for at in 0..self.dependent.len() {
            while self.step[free] != NONE {
                free += 1;
            }
            self.step[free] = self.row.len() as u32;
            self.row.push(free as u32);
            self.position.push(self.dependent[at]);
            self.pivot.push(1.0);
            self.lower_start.push(self.lower.len());
            self.upper_start.push(self.upper.len());
        }
    }

    /// Subtracts the earlier columns from the current one, in `dense`; returns its largest number before.
    fn eliminate(&mut self, k: u32) -> f64 {
        let mut scale = 0.0_f64;
        self.candidates.clear();
        self.postorder.clear();
        for at in 0..self.column.len() {
            let (row, x) = self.column[at];
            self.dense[row as usize] = x;
            scale = scale.max(x.abs());
            self.search(row, k);
        }
        for at in (0..self.postorder.len()).rev() {
            let step = self.postorder[at] as usize;
            let row = self.row[step];
            let x = std::mem::take(&mut self.dense[row as usize]);
            if x != 0.0 {
                self.upper.push((row, x));
                for &(r, l) in &self.lower[self.lower_start[step]..self.lower_start[step + 1]] {
                    self.dense[r as usize] -= l * x;
                }
            }
        }
        scale
    }

    /// Depth-first search from a row along the columns of L.
    fn search(&mut self, row: u32, k: u32) {
        if self.met[row as usize] == k {
            return;
        }
        self.met[row as usize] = k;
        if self.step[row as usize] == NONE {
            self.candidates.push(row);
            return;
        }
        let step = self.step[row as usize];
        self.path.push((step, self.lower_start[step as usize]));
        while let Some((step, at)) = self.path.last_mut() {
            if *at == self.lower_start[*step as usize + 1] {
                self.postorder.push(*step);
                self.path.pop();
                continue;
            }
            let row = self.lower[*at].0;
            *at += 1;
            if self.met[row as usize] == k {
                continue;
            }
            self.met[row as usize] = k;
            match self.step[row as usize] {
                NONE => self.candidates.push(row),
                step => self.path.push((step, self.lower_start[step as usize])),
            }
        }
    }

    /// Chooses the pivot among the candidates and closes the column.
    fn take_pivot(&mut self, at: u32, owner: u32, least: f64) {
        let (mut chosen, mut largest) = (NONE, 0.0);
        let (mut own, mut own_largest) = (NONE, 0.0);
        for &row in &self.candidates {
            let x = self.dense[row as usize].abs();
            if x > largest {
                (chosen, largest) = (row, x);
            }
            if row / 2 == owner && x > own_largest {
                (own, own_largest) = (row, x);
            }
        }
        if own_largest >= PREFERRED * largest {
            chosen = own;
        }
        if chosen == NONE || !(largest > least) {
            for &row in &self.candidates {
                self.dense[row as usize] = 0.0;
            }
            self.upper.truncate(self.upper_start[self.row.len()]);
            self.dependent.push(at);
            return;
        }
        let pivot = self.dense[chosen as usize];
        for &row in &self.candidates {
            let x = std::mem::take(&mut self.dense[row as usize]);
            if row != chosen && x != 0.0 {
                self.lower.push((row, x / pivot));
            }
        }
        self.step[chosen as usize] = self.row.len() as u32;
        self.row.push(chosen);
        self.position.push(at);
        self.pivot.push(pivot);
        self.lower_start.push(self.lower.len());
        self.upper_start.push(self.upper.len());
    }

    /// Whether the determinant of the factorised matrix is positive.
    pub(crate) fn determinant_is_positive(&mut self) -> bool {
        let n = self.row.len();
        let mut positive = self.pivot.iter().filter(|&&x| x < 0.0).count() % 2 == 0;
        // The permutation takes rows to positions; each cycle of even length changes the sign.
        refill(&mut self.met, n, NONE);
        for first in 0..n as u32 {
            let (mut at, mut length) = (first, 0);
            while self.met[at as usize] == NONE {
                self.met[at as usize] = 0;
                at = self.position[self.step[at as usize] as usize];
                length += 1;
            }
            positive ^= length > 0 && length % 2 == 0;
        }
        positive
    }

    /// Positions of the columns that were replaced by unit columns.
    pub(crate) fn dependent(&self) -> &[u32] {
        &self.dependent
    }

    /// Whether the columns have been exchanged so often that it is time to factorise again.
    pub(crate) fn is_worn(&self) -> bool {
        self.exchanges.len() >= EXCHANGES
    }

    /// Solves `B x = b`; `b`, by rows, is spoilt, and `x` is by positions.
    pub(crate) fn solve(&self, b: &mut [f64], x: &mut [f64]) {
        let n = self.row.len();
        for k in 0..n {
            let value = b[self.row[k] as usize];
            if value != 0.0 {
                for &(r, l) in &self.lower[self.lower_start[k]..self.lower_start[k + 1]] {
                    b[r as usize] -= l * value;
                }
            }
        }
        for k in (0..n).rev() {
            let value = b[self.row[k] as usize] / self.pivot[k];
            x[self.position[k] as usize] = value;
            if value != 0.0 {
                for &(r, u) in &self.upper[self.upper_start[k]..self.upper_start[k + 1]] {
                    b[r as usize] -= u * value;
                }
            }
        }
        for (k, &(at, pivot)) in self.exchanges.iter().enumerate() {
            let value = x[at as usize] / pivot;
            x[at as usize] = value;
            if value != 0.0 {
                for &(s, w) in &self.directions[self.direction_start[k]..self.direction_start[k + 1]] {
                    x[s as usize] -= w * value;
                }
            }
        }
    }

    /// Replaces the column at a position by that with `B⁻¹ c = w`.
    pub(crate) fn exchange(&mut self, at: usize, w: &[f64]) {
        self.exchanges.push((at as u32, w[at]));
        let others = w.iter().enumerate().filter(|&(s, &x)| s != at && x != 0.0);
        self.directions.extend(others.map(|(s, &x)| (s as u32, x)));
        self.direction_start.push(self.directions.len());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    /// A sparse matrix, by columns.
    fn matrix(n: usize) -> DMatrix<f64> {
        let value = |i: usize, j: usize| ((i * 31 + j * 17 + 5) as f64).sin();
        DMatrix::from_fn(n, n, |i, j| if i / 2 == j / 2 || (i * 7 + j * 3) % 11 == 4 { value(i, j) } else { 0.0 })
    }

    fn factorise(basis: &mut Basis, a: &DMatrix<f64>) {
        let order: Vec<u32> = (0..a.ncols() as u32).rev().collect();
        basis.factorise(
            &order,
            1e-9,
            |at| at / 2,
            |at, column| {
                let numbers = a.column(at as usize);
                column.extend(numbers.iter().enumerate().filter(|(_, x)| **x != 0.0).map(|(r, &x)| (r as u32, x)));
            },
        );
    }

    fn solve(basis: &Basis, b: &DVector<f64>) -> DVector<f64> {
        let mut x = DVector::zeros(b.len());
        basis.solve(b.clone().as_mut_slice(), x.as_mut_slice());
        x
    }

    #[test]
    fn solutions_and_signs_match_a_dense_factorisation() {
        for n in [2, 6, 40] {
            let mut a = matrix(n);
            let mut basis = Basis::default();
            factorise(&mut basis, &a);
            assert!(basis.dependent().is_empty());
            assert_eq!(basis.determinant_is_positive(), a.determinant() > 0.0, "{n}");
            let b = DVector::from_fn(n, |i, _| 1.0 + i as f64);
            assert!((&a * solve(&basis, &b) - &b).norm() < 1e-9 * b.norm());
            // Two columns are exchanged, one of them twice.
            for (k, at) in [0, n - 1, 0].into_iter().enumerate() {
                let column = DVector::from_fn(n, |i, _| ((3 * i + k) as f64).cos());
                let w = solve(&basis, &column);
                basis.exchange(at, w.as_slice());
                a.set_column(at, &column);
                assert!((&a * solve(&basis, &b) - &b).norm() < 1e-8 * b.norm(), "{n} {k}");
            }
        }
    }

    #[test]
    fn dependent_columns_give_null_vectors() {
        let n = 20;
        let mut a = matrix(n);
        let sum = a.column(19) * 2.0 - a.column(12);
        a.set_column(3, &sum);
        let mut basis = Basis::default();
        factorise(&mut basis, &a);
        // Columns are eliminated from the last to the first.
        assert_eq!(basis.dependent(), [3]);
        let w = solve(&basis, &sum);
        let expected = DVector::from_fn(n, |i, _| match i {
            19 => 2.0,
            12 => -1.0,
            _ => 0.0,
        });
        assert!((w - expected).norm() < 1e-9);
    }
}
