//! LU factorisation of sparse block matrices, for Newton's method on contact problems.
//!
//! The pattern is that of the Delassus operator, made symmetric. It is ordered by approximate
//! minimum degree (with feature `sparse`, else in the given order) and analysed once. The values
//! change in every Newton step, and so does the set of active contacts: an open contact is left out
//! by a flag, without a new analysis. Pivots are chosen only inside the D × D diagonal blocks. This
//! is safe for regularised matrices of contact problems; the caller checks the residual of its
//! step.
//!
//! A general sparse LU isn't used because it pivots between rows, for which it needs the pattern of
//! AᵀA although these matrices are structurally symmetric, and because leaving out contacts would
//! need a new analysis in every step. Factorising H + 1e-3 I of published problems (best of
//! several, one run): Capsules-i100 0.047 ms to 0.53 of faer's sparse LU, spheres-in-a-box 0.15 to
//! 9.1, RockPile 0.17 to 9.7, KaplasTower 3.5 to 18.7.

use crate::memory::{refill, reserve};
use crate::ordering::{Ordering, UNORDERED};
use teeter_contact::{Block, BlockSparse, Vector};

/// The analysis and the factors `A = L U` in elimination order; L has unit diagonal blocks.
#[derive(Debug, Default)]
pub(crate) struct BlockLu<const D: usize> {
    /// The analysed pattern: start of each row, and columns.
    known_start: Vec<usize>,
    known_columns: Vec<usize>,
    ordering: Ordering,
    /// `order[k]` is the contact eliminated at step k, `place` its inverse.
    order: Vec<usize>,
    place: Vec<usize>,
    /// Structure of column k of L below the diagonal (and, mirrored, of row k of U):
    /// `below[start[k]..start[k + 1]]`.
    start: Vec<usize>,
    below: Vec<usize>,
    /// Whether the next column has the structure of this one below its own row, as two contacts of the same
    /// bodies do: such columns are used together.
    twin: Vec<bool>,
    /// The elimination tree as lists: the first child of each column, and the next child of the
    /// same parent.
    first_child: Vec<usize>,
    sibling: Vec<usize>,
    /// For each step j, the earlier columns k with an entry in row j: (k, index of j in `below`).
    reach_start: Vec<usize>,
    reach: Vec<(usize, usize)>,
    /// Entry (row, k) of L and entry (k, row) of U for each entry of `below`: together, as they are always used
    /// together.
    factors: Vec<Mirrored<D>>,
    pivot: Vec<Block<D>>,
    pivot_inverse: Vec<Block<D>>,
    active: Vec<bool>,
    /// The position of a row in the current column.
    map: Vec<usize>,
    rhs: Vec<Vector<D>>,
}

/// An entry of L below the diagonal, and the one of U at its mirror image.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mirrored<const D: usize> {
    lower: Block<D>,
    upper: Block<D>,
}

impl<const D: usize> Mirrored<D> {
    fn zeros() -> Self {
        Self { lower: Block::zeros(), upper: Block::zeros() }
    }
}

/// A clone starts empty: analysis and factors belong to the problems solved.
impl<const D: usize> Clone for BlockLu<D> {
    fn clone(&self) -> Self {
        Self::default()
    }
}

const NONE: usize = usize::MAX;

impl<const D: usize> BlockLu<D> {
    /// Reserves memory for `contacts` contacts; the fill-in is known only for few contacts.
    pub(crate) fn reserve(&mut self, contacts: usize, blocks: usize) {
        let filled = if contacts <= UNORDERED { contacts * contacts / 2 } else { blocks };
        for x in [&mut self.known_start, &mut self.start, &mut self.reach_start] {
            reserve(x, contacts + 1);
        }
        for x in [&mut self.order, &mut self.place, &mut self.first_child, &mut self.sibling, &mut self.map] {
            reserve(x, contacts);
        }
        reserve(&mut self.known_columns, blocks);
        reserve(&mut self.below, filled);
        reserve(&mut self.reach, filled);
        reserve(&mut self.factors, filled);
        reserve(&mut self.pivot, contacts);
        reserve(&mut self.pivot_inverse, contacts);
        reserve(&mut self.active, contacts);
        reserve(&mut self.twin, contacts);
        reserve(&mut self.rhs, contacts);
        self.ordering.reserve(contacts, blocks);
    }

    /// Analyses the pattern of `h` if it has changed, and returns whether it has.
    pub(crate) fn analyse(&mut self, h: &BlockSparse<D>) -> bool {
        let n = h.contacts();
        let same_start = self.known_start.len() == n && (0..n).all(|i| h.range(i).end == self.known_start[i]);
        if same_start && self.known_columns == h.columns() {
            return false;
        }
        self.known_start.clear();
        self.known_start.extend((0..n).map(|i| h.range(i).end));
        self.known_columns.clear();
        self.known_columns.extend_from_slice(h.columns());
        self.ordering.neighbours_of(h);
        self.ordering.order(&mut self.order, &mut self.place);
        self.eliminate_symbolically();
        let filled = self.below.len();
        refill(&mut self.factors, filled, Mirrored::zeros());
        refill(&mut self.pivot, n, Block::zeros());
        refill(&mut self.pivot_inverse, n, Block::zeros());
        refill(&mut self.active, n, false);
        refill(&mut self.map, n, 0);
        refill(&mut self.rhs, n, Vector::zeros());
        true
    }

    /// Number of blocks of L and U together, including the diagonal.
    pub(crate) fn filled_blocks(&self) -> usize {
        2 * self.below.len() + self.order.len()
    }

    /// Block products of one factorisation with all contacts active.
    pub(crate) fn block_products(&self) -> usize {
        self.start.windows(2).map(|w| (w[1] - w[0]) * (w[1] - w[0] + 1)).sum()
    }

    /// The structure of each column is the pattern below its diagonal and the structures of its
    /// children in the elimination tree.
    fn eliminate_symbolically(&mut self) {
        let n = self.order.len();
        refill(&mut self.first_child, n, NONE);
        refill(&mut self.sibling, n, NONE);
        // The last column that included a row.
        refill(&mut self.map, n, NONE);
        self.start.clear();
        self.start.push(0);
        self.below.clear();
        for k in 0..n {
            let first = self.below.len();
            for &j in self.ordering.neighbours(self.order[k]) {
                let j = self.place[j];
                if j > k && self.map[j] != k {
                    self.map[j] = k;
                    self.below.push(j);
                }
            }
            let mut child = self.first_child[k];
            while child != NONE {
                for at in self.start[child]..self.start[child + 1] {
                    let j = self.below[at];
                    if j > k && self.map[j] != k {
                        self.map[j] = k;
                        self.below.push(j);
                    }
                }
                child = self.sibling[child];
            }
            self.below[first..].sort_unstable();
            if let Some(&parent) = self.below.get(first) {
                self.sibling[k] = self.first_child[parent];
                self.first_child[parent] = k;
            }
            self.start.push(self.below.len());
        }
        self.twin.clear();
        // A parent's structure holds all of its child's but itself, so that equal numbers mean equal structures.
        let below = |k: usize| &self.below[self.start[k]..self.start[k + 1]];
        self.twin
            .extend((0..n).map(|k| below(k).first() == Some(&(k + 1)) && below(k + 1).len() + 1 == below(k).len()));
        refill(&mut self.reach_start, n + 1, 0);
        for &j in &self.below {
            self.reach_start[j + 1] += 1;
        }
        for j in 0..n {
            self.reach_start[j + 1] += self.reach_start[j];
        }
        refill(&mut self.reach, self.below.len(), (0, 0));
        // `map` counts the entries so far.
        self.map.copy_from_slice(&self.reach_start[..n]);
        for k in 0..n {
            for at in self.start[k]..self.start[k + 1] {
                let entered = &mut self.map[self.below[at]];
                self.reach[*entered] = (k, at);
                *entered += 1;
            }
        }
    }

    /// Factorises the matrix with blocks `block(i, t)`, t the index in the pattern's blocks, over
    /// the contacts with `active(i)`. The pattern must be the analysed one. `false` where a pivot
    /// block is singular or not finite.
    pub(crate) fn factorise(
        &mut self,
        h: &BlockSparse<D>,
        active: impl Fn(usize) -> bool,
        block: impl Fn(usize, usize) -> Block<D>,
    ) -> bool {
        let n = self.order.len();
        for k in 0..n {
            self.active[k] = active(self.order[k]);
        }
        self.factors.fill(Mirrored::zeros());
        self.scatter(h, block);
        for j in 0..n {
            if !self.active[j] {
                continue;
            }
            let (first, end) = (self.start[j], self.start[j + 1]);
            for (at, &row) in self.below[first..end].iter().enumerate() {
                self.map[row] = at;
            }
            let mut pivot = self.pivot[j];
            // Columns before j are finished.
            let (finished, own) = self.factors.split_at_mut(first);
            let own = &mut own[..end - first];
            let mut reach = &self.reach[self.reach_start[j]..self.reach_start[j + 1]];
            while let Some((&(k, at), others)) = reach.split_first() {
                reach = others;
                if !self.active[k] {
                    continue;
                }
                let one = finished[at];
                subtract_product(&mut pivot, &one.lower, &one.upper);
                let rest = at + 1..self.start[k + 1];
                let rows = &self.below[rest.clone()];
                // Entries of contacts that are left out go to places that nobody reads.
                match others.split_first() {
                    Some((&(twin, at), others)) if self.twin[k] && twin == k + 1 && self.active[twin] => {
                        reach = others;
                        let two = finished[at];
                        subtract_product(&mut pivot, &two.lower, &two.upper);
                        let entries = finished[rest].iter().zip(&finished[at + 1..self.start[twin + 1]]);
                        for (row, (first, second)) in rows.iter().zip(entries) {
                            let target = &mut own[self.map[*row]];
                            subtract_product(&mut target.lower, &first.lower, &one.upper);
                            subtract_product(&mut target.lower, &second.lower, &two.upper);
                            subtract_product(&mut target.upper, &one.lower, &first.upper);
                            subtract_product(&mut target.upper, &two.lower, &second.upper);
                        }
                    }
                    _ => {
                        for (row, entry) in rows.iter().zip(&finished[rest]) {
                            let target = &mut own[self.map[*row]];
                            subtract_product(&mut target.lower, &entry.lower, &one.upper);
                            subtract_product(&mut target.upper, &one.lower, &entry.upper);
                        }
                    }
                }
            }
            let Some(inverse) = invert(&pivot) else { return false };
            self.pivot_inverse[j] = inverse;
            for entry in own {
                entry.lower *= inverse;
            }
        }
        true
    }

    /// Copies the matrix into the storage of its factors.
    fn scatter(&mut self, h: &BlockSparse<D>, block: impl Fn(usize, usize) -> Block<D>) {
        for k in 0..self.order.len() {
            if !self.active[k] {
                continue;
            }
            let i = self.order[k];
            for at in self.start[k]..self.start[k + 1] {
                self.map[self.below[at]] = at;
            }
            let range = h.range(i);
            for t in range {
                let j = h.columns()[t];
                let m = self.place[j];
                if !self.active[m] {
                    continue;
                }
                if m == k {
                    self.pivot[k] = block(i, t);
                } else if m > k {
                    self.factors[self.map[m]].upper = block(i, t);
                } else {
                    // Row k of column m of L, found by bisection in its structure.
                    let column = &self.below[self.start[m]..self.start[m + 1]];
                    if let Ok(at) = column.binary_search(&k) {
                        self.factors[self.start[m] + at].lower = block(i, t);
                    }
                }
            }
        }
    }

    /// Solves `A x = b` in place over the active contacts; the others are unchanged.
    pub(crate) fn solve(&mut self, x: &mut [Vector<D>]) {
        let n = self.order.len();
        for k in 0..n {
            self.rhs[k] = if self.active[k] { x[self.order[k]] } else { Vector::zeros() };
        }
        for k in 0..n {
            if self.active[k] {
                let b = self.rhs[k];
                for at in self.start[k]..self.start[k + 1] {
                    self.rhs[self.below[at]] -= self.factors[at].lower * b;
                }
            }
        }
        for k in (0..n).rev() {
            if self.active[k] {
                let mut b = self.rhs[k];
                for at in self.start[k]..self.start[k + 1] {
                    let j = self.below[at];
                    if self.active[j] {
                        b -= self.factors[at].upper * self.rhs[j];
                    }
                }
                self.rhs[k] = self.pivot_inverse[k] * b;
                x[self.order[k]] = self.rhs[k];
            }
        }
    }
}

/// `target −= l u`: the sums of nalgebra's product in its order, but in plain loops, which the compiler inlines without optimisation
/// across crates, too.
#[inline]
fn subtract_product<const D: usize>(target: &mut Block<D>, l: &Block<D>, u: &Block<D>) {
    let (target, l, u) = (&mut target.data.0, &l.data.0, &u.data.0);
    for c in 0..D {
        let mut sum = [0.0; D];
        for r in 0..D {
            sum[r] = l[0][r] * u[c][0];
        }
        for k in 1..D {
            for r in 0..D {
                sum[r] += l[k][r] * u[c][k];
            }
        }
        for r in 0..D {
            target[c][r] -= sum[r];
        }
    }
}

/// The inverse by Gauss–Jordan elimination with row pivoting; `None` if it is singular or not
/// finite. Cofactors over the determinant would be faster, but lose twice as many digits for the
/// nearly singular pivots of hyperstatic contacts.
#[inline]
fn invert<const D: usize>(a: &Block<D>) -> Option<Block<D>> {
    let (mut a, mut inverse) = (*a, Block::<D>::identity());
    for k in 0..D {
        let mut row = k;
        for r in k + 1..D {
            if a[(r, k)].abs() > a[(row, k)].abs() {
                row = r;
            }
        }
        a.swap_rows(k, row);
        inverse.swap_rows(k, row);
        let pivot = a[(k, k)].recip();
        if !pivot.is_finite() {
            return None;
        }
        for c in 0..D {
            a[(k, c)] *= pivot;
            inverse[(k, c)] *= pivot;
        }
        for r in (0..D).filter(|&r| r != k) {
            let factor = a[(r, k)];
            for c in 0..D {
                a[(r, c)] -= factor * a[(k, c)];
                inverse[(r, c)] -= factor * inverse[(k, c)];
            }
        }
    }
    inverse.iter().all(|c| c.is_finite()).then_some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    /// A ring of contacts with some chords and a few one-sided blocks; diagonally dominant.
    fn matrix(n: usize) -> BlockSparse<3> {
        let value = |i: usize, j: usize, k: usize| ((i * 31 + j * 17 + k * 7) as f64).sin();
        let coupled = |i: usize, j: usize| i.abs_diff(j) <= 1 || i.abs_diff(j) == n - 1 || (i * j) % 11 == 5;
        let block = |i: usize, j: usize| {
            let b = Block::<3>::from_fn(|r, c| value(i, j, 3 * r + c));
            if i == j { b + Block::identity() * 12.0 } else { b }
        };
        let row = |i: usize| (0..n).filter(|&j| j == i || coupled(i, j)).map(|j| (j, block(i, j))).collect();
        BlockSparse::from_rows(&(0..n).map(row).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn solutions_match_a_dense_factorisation() {
        for n in [1, 2, 7, 60] {
            let h = matrix(n);
            let mut lu = BlockLu::default();
            assert!(lu.analyse(&h) && !lu.analyse(&h));
            // Every third contact is left out.
            for active in [|_: usize| true, |i: usize| i % 3 != 2] {
                assert!(lu.factorise(&h, active, |_, t| h.blocks()[t]));
                let b: Vec<_> = (0..n).map(|i| Vector::<3>::new(1.0, i as f64, -0.5)).collect();
                let mut x = b.clone();
                lu.solve(&mut x);
                let dense = DMatrix::from_fn(3 * n, 3 * n, |r, c| match h.block(r / 3, c / 3) {
                    Some(block) if active(r / 3) && active(c / 3) => block[(r % 3, c % 3)],
                    _ => f64::from(u8::from(r == c)),
                });
                let right = nalgebra::DVector::from_fn(3 * n, |r, _| b[r / 3][r % 3]);
                let expected = dense.lu().solve(&right).unwrap();
                for r in 0..3 * n {
                    assert!((x[r / 3][r % 3] - expected[r]).abs() < 1e-12 * expected.norm());
                }
            }
        }
    }

    #[test]
    fn nearly_singular_pivots_keep_their_digits() {
        // One stiff direction of three, rotated, like the third corner of a box after the first two
        // are eliminated.
        for (k, epsilon) in [1e-5, 1e-7, 1e-9].into_iter().enumerate() {
            let axis = nalgebra::Vector3::new(0.3 + k as f64, -0.7, 0.5).normalize();
            let a = axis * axis.transpose() * (1.0 - epsilon) + Block::<3>::identity() * epsilon;
            let off = (invert(&a).unwrap() * a - Block::<3>::identity()).norm();
            assert!(off < 1e-15 / epsilon, "{epsilon:e}: {off:e}");
        }
    }

    #[test]
    fn a_singular_pivot_is_reported() {
        let h = BlockSparse::from_rows(&[vec![(0, Block::<2>::zeros())]]).unwrap();
        let mut lu = BlockLu::default();
        lu.analyse(&h);
        assert!(!lu.factorise(&h, |_| true, |_, t| h.blocks()[t]));
    }

    #[test]
    fn fill_in_is_minimal_for_a_chain() {
        // A chain has no fill-in with a good ordering.
        let n = 100;
        let row = |i: usize| {
            let near = |j: &usize| j.abs_diff(i) <= 1;
            (0..n).filter(near).map(|j| (j, Block::<3>::identity())).collect()
        };
        let h = BlockSparse::from_rows(&(0..n).map(row).collect::<Vec<_>>()).unwrap();
        let mut lu = BlockLu::default();
        lu.analyse(&h);
        assert_eq!(lu.filled_blocks(), h.blocks().len());
    }
}
